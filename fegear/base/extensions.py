"""What other installed distributions add: results, export formats and importers, by entry points.

They are looked for where fegear itself knows nothing of a name, and where all names are listed: reading what is
installed takes longer than a small plan.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Literal, TypeVar

from fegear.base.errors import InputError

Group = Literal["results", "formats", "importers"]
T = TypeVar("T")


@functools.cache
def _points(group: Group) -> tuple[Any, ...]:
    from importlib.metadata import entry_points

    return tuple(entry_points(group=f"fegear.{group}"))


def added(group: Group, kind: type[T], known: Mapping[str, object]) -> Mapping[str, T]:
    """What distributions add to a group, by the names of their entry points.

    Parameters
    ----------
    group : {"results", "formats", "importers"}
        Of entry points, behind `fegear` and a point.
    kind : type
        That each of them must be.
    known : mapping of str
        Names that fegear itself has.

    Raises
    ------
    InputError
        If one cannot be imported, is something else, or has a name that fegear or another distribution has.
    """
    found: dict[str, T] = {}
    for point in _points(group):
        whose = f"{point.name} of {point.dist.name} {point.dist.version}" if point.dist else point.name
        remedy = "correct or uninstall that distribution"
        if point.name in known or point.name in found:
            raise InputError(f"fegear.{group}", whose, "has a name that is taken", "give the entry point another name")
        try:
            one = point.load()
        except Exception as error:  # noqa: BLE001  (whatever a stranger's module does as it is imported)
            rule = f"cannot be imported: {type(error).__name__}: {error}"
            raise InputError(f"fegear.{group}", whose, rule, remedy) from None
        if not isinstance(one, kind):
            rule = f"is a {type(one).__name__}, and must be a {kind.__module__}.{kind.__qualname__}"
            raise InputError(f"fegear.{group}", whose, rule, remedy)
        found[point.name] = one
    return MappingProxyType(found)
