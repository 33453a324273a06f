"""What other installed distributions add: results, export formats and importers, by entry points.

They are looked for where fegear itself knows nothing of a name, and where all names are listed: reading what is
installed takes longer than a small plan. One that is wrong is refused where it is asked for; the others work.
"""

from __future__ import annotations

import functools
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Literal, TypeVar

from fegear.base.errors import FegearError, InputError

Group = Literal["results", "formats", "importers"]
T = TypeVar("T")
_REMEDY = "correct or uninstall that distribution"


@dataclass(frozen=True)
class Added(Generic[T]):
    """What distributions add to a group, by the names of their entry points.

    Parameters
    ----------
    found : mapping of str
        What can be used.
    whose : mapping of str to str
        What each of these is called in messages: its name and its distribution.
    broken : mapping of str to InputError
        What is wrong with the others.
    """

    found: Mapping[str, T]
    whose: Mapping[str, str]
    broken: Mapping[str, InputError]

    def refuse_broken(self, name: str) -> None:
        """Refuse a name of what cannot be used."""
        if name in self.broken:
            raise self.broken[name]


@functools.cache
def _points(group: Group) -> tuple[Any, ...]:
    from importlib.metadata import entry_points

    return tuple(entry_points(group=f"fegear.{group}"))


def added(group: Group, kind: type[T], known: Mapping[str, object]) -> Added[T]:
    """What distributions add to a group.

    Parameters
    ----------
    group : {"results", "formats", "importers"}
        Of entry points, behind `fegear` and a point.
    kind : type
        That each of them must be.
    known : mapping of str
        Names that fegear itself has.

    Returns
    -------
    Added
        Broken are those that cannot be imported, are something else, or have a name that fegear or another
        distribution has.
    """
    found: dict[str, T] = {}
    whose: dict[str, str] = {}
    broken: dict[str, InputError] = {}
    points = sorted(_points(group), key=lambda point: (point.name, str(point.dist.name) if point.dist else ""))
    names = [point.name for point in points]
    for point in points:
        name = point.name
        whose[name] = f"{name} of {point.dist.name} {point.dist.version}" if point.dist else name
        if name in known or names.count(name) > 1:
            rule = "has a name that is already used" if name in known else "has the name of another one"
            broken[name] = InputError(f"fegear.{group}", whose[name], rule, "rename the entry point")
            continue
        try:
            with held_to_words(group, whose[name], "cannot be imported"):
                one = point.load()
        except InputError as error:
            broken[name] = error
            continue
        if isinstance(one, kind):
            found[name] = one
        else:
            rule = f"is a {type(one).__name__}; must be a {kind.__module__}.{kind.__qualname__}"
            broken[name] = InputError(f"fegear.{group}", whose[name], rule, _REMEDY)
    return Added(found, whose, broken)


@contextmanager
def held_to_words(group: Group, whose: str, what: str = "cannot be used") -> Iterator[None]:
    """Whatever a stranger's code raises becomes a sentence with its distribution and its line.

    Refusals of fegear's own kind pass, and so do Ctrl-C and a lack of memory.

    Raises
    ------
    InputError
        In place of what was raised, which stays its cause.
    """
    try:
        yield
    except (FegearError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        rule = f"{what}: {said} ({Path(last.filename).name}, line {last.lineno})"
        raise InputError(f"fegear.{group}", whose, rule, _REMEDY) from error


@dataclass(frozen=True)
class Guarded:
    """A stranger's function, whose failures are sentences.

    Parameters
    ----------
    function : callable
    group : {"results", "formats", "importers"}
    whose : str
        See `Added`.
    right : callable, optional
        Raises where an answer is none; by default any answer is.
    """

    function: Callable[..., Any]
    group: Group
    whose: str
    right: Callable[[Any], object] | None = None

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Answer, or refuse."""
        with held_to_words(self.group, self.whose):
            answer = self.function(*args, **options)
            if self.right is not None:
                self.right(answer)
            return answer
