"""What the page asks of the computing process, and what comes back: plain data that travel between processes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple


class Asked(NamedTuple):
    """A case as it is asked for.

    Attributes
    ----------
    text, name, folder : str
        Its text, its name, and where relative file names in it start.
    loosened : float
        Factor of its tolerance: 1 computes it as it is written.
    moving : bool
        Whether a value of it is being moved: its numbers are wanted at once, their errors when it stands still.
    sight : tuple of str
        Tasks whose results are in sight on a page: they are wanted before those that are not.
    shows : tuple of (str, str)
        Pair and kind of what is switched on at the gears in mesh.
    laid : int
        How many cases have lain on the desk before it: what was told of those is forgotten.
    """

    text: str
    name: str
    folder: str
    loosened: float = 1.0
    moving: bool = False
    sight: tuple[str, ...] = ()
    shows: tuple[tuple[str, str], ...] = ()
    laid: int = 0


@dataclass(frozen=True, slots=True)
class Compute:
    """Compute a case for the page; a later one of these makes it unwanted."""

    number: int
    asked: Asked


@dataclass(frozen=True, slots=True)
class Export:
    """Write into a folder what a command writes.

    ``report``: all that ``fegear run`` writes; ``tables``: its tables alone; ``drawings`` and ``relief``: what
    ``fegear export`` writes as DXF and as tables for who grinds the relief.
    """

    number: int
    asked: Asked
    what: str
    target: str


@dataclass(frozen=True, slots=True)
class Compare:
    """Hold a pinned case against another, as ``fegear compare`` does."""

    number: int
    first: Asked
    second: Asked


@dataclass(frozen=True, slots=True)
class Design:
    """Find reliefs of a pair by theory, as the result ``relief`` does.

    ``exact``: those that remove its transmission error (Mark, Eq. 4.6); ``ground``: the tip reliefs to grind that leave
    the least.
    """

    number: int
    asked: Asked
    pair: str
    how: Literal["exact", "ground"] = "exact"


Job = Compute | Export | Compare | Design


@dataclass(frozen=True, slots=True)
class Said:
    """What the computing process says of a job.

    Parameters
    ----------
    number : int
        The job's.
    what : str
        ``plan`` (tasks, in order), ``hands`` (gears in mesh, reliefs and loads that are changed by hand), ``begin`` (a
        task), ``found`` (a task's results), ``meshed`` (what is shown on the gears in mesh), ``picture``, ``done``,
        ``refused``, ``exported``, ``compared``, ``designed`` or ``dropped`` (another is wanted).
    content : dict
        Plain data for the page.
    """

    number: int
    what: str
    content: dict[str, Any] = field(default_factory=dict)
