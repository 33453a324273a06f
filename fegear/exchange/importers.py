"""Models that ``fegear import`` reads, each kind a row: fegear's own, and those that other distributions add."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fegear.base.errors import InputError, shown
from fegear.base.extensions import Guarded, added


@dataclass(frozen=True)
class Importer:
    """A kind of model.

    Parameters
    ----------
    suffixes : tuple of str
        Of its files, in small letters, with their dots; none for a kind that is known by what is in its files.
    about : str
        What it is, for lists.
    read : callable or str
        ``read(path)`` -> the text of a case, or its place, ``"module:function"``. What it cannot read it refuses by an
        `InputError`.
    options : tuple of str
        Names of what `read` takes besides, of those that the command has; given by name where the user does.
    """

    suffixes: tuple[str, ...]
    about: str
    read: Callable[..., str] | str
    options: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse suffixes that no file has: a text in place of a tuple of them fits any part of itself."""
        given: object = self.suffixes
        wrong = isinstance(given, str) or [one for one in self.suffixes if one != one.lower() or one[:1] != "."]
        if wrong:
            raise ValueError(f"suffixes must be a tuple such as ('.teeth',), in small letters, and is {self.suffixes}")

    def case_of(self, path: Path, given: Mapping[str, Any]) -> str:
        """The text of the case that a model makes.

        Parameters
        ----------
        path : Path
            Of the model.
        given : mapping of str
            Options by their names; those that are None were not given.

        Raises
        ------
        InputError
            If an option is given that models of this kind do not take, or the model cannot be read.
        """
        wanted = {name: value for name, value in given.items() if value is not None}
        for name in sorted(wanted.keys() - set(self.options)):
            flag, rule = f"--{name.replace('_', '-')}", f"is not known to models of this kind ({self.about})"
            raise InputError(flag, shown(wanted[name]), rule, f"remove {flag}")
        return self.called(path, **wanted)

    def called(self, path: Path, **options: Any) -> str:
        """What `read` answers, wherever it stands."""
        read = self.read
        if isinstance(read, str):
            module, _, function = read.partition(":")
            read = getattr(import_module(module), function)
        text: str = read(path, **options)
        return text


#: What models of the first kind end in.
_SUFFIXES = (".rexs", ".rexsj", ".rexsz", ".zip", ".xml", ".json")
#: Kinds of fegear itself; the first reads what no other kind claims by its suffix.
IMPORTERS: Mapping[str, Importer] = MappingProxyType({
    "rexs": Importer(
        (), "REXS 1.0 to 1.7: XML, JSON or archive", "fegear.exchange.rexs.model_to_case:read_case",
        ("load_case", "spectrum"),
    ),
})  # fmt: skip


def _text(found: object) -> None:
    if not isinstance(found, str):
        raise TypeError(f"read() must answer the text of a case, and answered a {type(found).__name__}")
    found.encode()


def importer_for(path: Path, name: str | None) -> Importer:
    """What reads a model: the kind that is named, else the one of its suffix, else the first.

    Other distributions add theirs by entry points of ``fegear.importers``.

    Raises
    ------
    InputError
        If there is none of that name, it cannot be used, or two read files of that suffix.
    """
    if name is not None and name in IMPORTERS:
        return IMPORTERS[name]
    others = added("importers", Importer, IMPORTERS)
    if name is not None:
        others.refuse_broken(name)
        if name not in others.found:
            remedy = f"choose from {', '.join((*IMPORTERS, *others.found))}"
            raise InputError("--as", shown(name), "is not a supported model format", remedy)
    suffix = path.suffix.lower()
    fitting = [one for one, kind in others.found.items() if (suffix in kind.suffixes if name is None else one == name)]
    if len(fitting) > 1:
        rule = f"can be read as {' or '.join(fitting)}"
        raise InputError("MODEL", shown(path.name), rule, f"specify one: --as {fitting[0]}")
    if not fitting:
        if others.broken and suffix not in _SUFFIXES:  # one of them may be meant
            raise next(iter(others.broken.values()))
        return next(iter(IMPORTERS.values()))
    kind = others.found[fitting[0]]
    return replace(kind, read=Guarded(kind.called, "importers", others.whose[fitting[0]], _text))
