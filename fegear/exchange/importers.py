"""Models that ``fegear import`` reads: REXS, and the kinds that other distributions add, each a row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from fegear.base.errors import InputError, shown
from fegear.base.extensions import added

#: Name of the kind that fegear itself reads.
REXS = "rexs"


@dataclass(frozen=True)
class Importer:
    """A kind of model.

    Parameters
    ----------
    suffixes : tuple of str
        Of its files, in small letters, with their dots.
    about : str
        What it is, for lists.
    read : callable
        ``read(path)`` -> the text of a case. What it cannot read it refuses by an `InputError`.
    """

    suffixes: tuple[str, ...]
    about: str
    read: Callable[[Path], str]


def importers() -> Mapping[str, Importer]:
    """Those that other distributions add, by entry points of ``fegear.importers``.

    Raises
    ------
    InputError
        See `fegear.base.extensions.added`.
    """
    return added("importers", Importer, {REXS: None})


def importer_for(path: Path, name: str | None) -> Importer | None:
    """Which of other distributions reads a model: the one that is named, else one of its suffix; None for REXS.

    Raises
    ------
    InputError
        If there is none of that name, or two read files of that suffix.
    """
    if name == REXS:
        return None
    known = importers()
    if name is not None:
        if name not in known:
            remedy = f"choose from {', '.join((REXS, *known))}"
            raise InputError("--as", shown(name), "is no kind of model that fegear reads", remedy)
        return known[name]
    fitting = [one for one, importer in known.items() if path.suffix.lower() in importer.suffixes]
    if len(fitting) > 1:
        rule = f"may be read as {' or '.join(fitting)}"
        raise InputError("MODEL", shown(path.name), rule, f"say which: --as {fitting[0]}")
    return known[fitting[0]] if fitting else None
