"""What the page asks of the computing process, and what comes back: plain data that travel between processes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple


class Asked(NamedTuple):
    """A case as it is asked for.

    Attributes
    ----------
    text, name, folder : str
        Its text, its name, and where relative file names in it start.
    loosened : float
        Factor of its tolerance: 1 computes it as it is written.
    """

    text: str
    name: str
    folder: str
    loosened: float = 1.0


@dataclass(frozen=True, slots=True)
class Compute:
    """Compute a case for the page; a later one of these makes it unwanted."""

    number: int
    asked: Asked


@dataclass(frozen=True, slots=True)
class Export:
    """Write what ``fegear run`` (``report``) or ``fegear export`` (``drawings``) writes into a folder."""

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


Job = Compute | Export | Compare


@dataclass(frozen=True, slots=True)
class Said:
    """What the computing process says of a job.

    Parameters
    ----------
    number : int
        The job's.
    what : str
        ``plan`` (tasks and their titles, in order), ``begin`` (a task), ``found`` (a task's results), ``done``,
        ``refused``, ``exported``, ``compared`` or ``dropped`` (another is wanted).
    content : dict
        Plain data for the page.
    """

    number: int
    what: str
    content: dict[str, Any] = field(default_factory=dict)
