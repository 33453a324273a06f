"""A row of the page "Verification": a capability, what it is compared with, and the function that compares.

A row is a function whose name is the row's and whose first sentence says what is compared; it gives `Compared` numbers.
Nothing of a row's other side may come from fegear: it is printed, another program's, or computed by the row itself.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

#: What a number can be compared with, in the order of the page.
AGAINST = {
    "printed": "published values: standards, papers, books, reports",
    "program": "results of other programs",
    "own": "closed-form solutions and independent code of the project",
}


@dataclass(frozen=True)
class Compared:
    """A number of fegear's and what it is compared with.

    Attributes
    ----------
    found, wanted : float
    scale : float
        The difference is relative to it.
    allowed : float
        Largest difference, relative to `scale`, with which the row holds.
    stated : float or None
        Error that fegear states of the number, relative to `scale`.
    because : str
        Why it is known to differ; such a number is counted by itself.
    """

    found: float
    wanted: float
    scale: float
    allowed: float
    stated: float | None = None
    because: str = ""

    @property
    def deviation(self) -> float:
        """Difference relative to `scale`; not a number counts as infinite."""
        apart = abs(self.found - self.wanted) / self.scale
        return apart if apart == apart else float("inf")

    @property
    def holds(self) -> bool:
        """Whether the difference is allowed."""
        return self.deviation <= self.allowed * (1.0 + 1e-9)

    def known(self, because: str) -> Compared:
        """The same, known to differ."""
        return replace(self, because=because)


def printed(found: float, text: str, input_moves: float = 0.0) -> Compared:
    """A number in print: it holds within half a unit of its last digit.

    Parameters
    ----------
    found : float
    text : str
        As printed.
    input_moves : float, optional
        What the rounding of the printed inputs may move it by, in its own unit.
    """
    wanted = float(text)
    half = 0.5 * 10.0 ** -len(text.partition(".")[2]) + input_moves
    scale = abs(wanted) or 1.0
    return Compared(float(found), wanted, scale, half / scale)


def near(
    found: ArrayLike, wanted: ArrayLike, allowed: float, scale: float | None = None, stated: ArrayLike | None = None
) -> Iterator[Compared]:
    """Arrays compared number by number.

    Parameters
    ----------
    found, wanted : array_like
        Of shapes that go together.
    allowed : float
        Largest relative difference.
    scale : float, optional
        What differences are relative to; each number's own size by default.
    stated : array_like, optional
        Errors that fegear states, in the unit of `found`.
    """
    mine, other, error = np.broadcast_arrays(
        np.asarray(found, dtype=float),
        np.asarray(wanted, dtype=float),
        np.nan if stated is None else np.asarray(stated),
    )
    for one, two, three in zip(mine.ravel(), other.ravel(), error.ravel(), strict=True):
        size = float(scale or abs(two) or 1.0)
        yield Compared(float(one), float(two), size, allowed, None if stated is None else float(three) / size)


@dataclass(frozen=True)
class Row:
    """A row before it is run.

    Attributes
    ----------
    name : str
        As ``fegear verify`` takes it.
    capability : str
        What of fegear is compared.
    against : str
        One of `AGAINST`.
    source : str
        Of the other side: paper, program with its version or mesh, equation.
    what : str
        What is compared, a sentence.
    compare : callable
        Gives the compared numbers.
    """

    name: str
    capability: str
    against: str
    source: str
    what: str
    compare: Callable[[], Iterable[Compared]]


@dataclass(frozen=True)
class Outcome:
    """What a row found.

    Attributes
    ----------
    row : Row
    compared : tuple of Compared
    seconds : float
        Of processor.
    """

    row: Row
    compared: tuple[Compared, ...]
    seconds: float

    @property
    def held(self) -> tuple[Compared, ...]:
        """The numbers that are not known to differ."""
        return tuple(one for one in self.compared if not one.because)

    @property
    def largest(self) -> Compared:
        """The number with the largest difference, of those that are not known to differ."""
        return max(self.held, key=lambda one: one.deviation)

    @property
    def wrong(self) -> tuple[Compared, ...]:
        """Numbers that do not hold, and those that hold though they are known to differ."""
        return tuple(one for one in self.compared if one.holds is bool(one.because))

    def plain(self) -> dict[str, object]:
        """What programs read."""
        largest = self.largest
        return {
            "name": self.row.name, "against": self.row.against, "capability": self.row.capability,
            "source": self.row.source, "what": self.row.what, "numbers": len(self.compared),
            "known_to_differ": len(self.compared) - len(self.held), "largest_difference": largest.deviation,
            "stated_error": largest.stated, "allowed": largest.allowed, "holds": self.holds, "seconds": self.seconds,
        }  # fmt: skip

    @property
    def holds(self) -> bool:
        """Whether every number does, or is known to differ and does; a row without numbers does not."""
        return bool(self.held) and not self.wrong


def run(row: Row) -> Outcome:
    """Compare now."""
    start = time.process_time()
    return Outcome(row, tuple(row.compare()), time.process_time() - start)


class Rows:
    """Rows of one module, in the order in which they are written down."""

    def __init__(self) -> None:
        self.all: list[Row] = []

    def add(
        self, capability: str, against: str, source: str
    ) -> Callable[[Callable[[], Iterable[Compared]]], Callable[[], Iterable[Compared]]]:
        """Make a function a row: its name, and what it compares as its docstring says."""

        def added(compare: Callable[[], Iterable[Compared]]) -> Callable[[], Iterable[Compared]]:
            name, what = compare.__name__.replace("_", "-"), (compare.__doc__ or "").strip()
            self.all.append(Row(name, capability, against, source, what, compare))
            return compare

        return added
