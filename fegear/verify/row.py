"""A row of the page "How right is it?": a capability, what it is compared with, and the function that compares.

A row is a function whose name is the row's and whose first sentence says what is compared; it gives `Compared` numbers.
Nothing of a row's other side may come from fegear: it is printed, another program's, or computed by the row itself.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from fegear.base.arrays import ArrayLike

#: What a number can be compared with, in the order of the page.
AGAINST = {
    "printed": "numbers that others printed: standards, papers, books, reports",
    "program": "numbers of other programs",
    "own": "closed forms and independent code of our own",
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
    """

    found: float
    wanted: float
    scale: float
    allowed: float
    stated: float | None = None

    @property
    def deviation(self) -> float:
        """Difference relative to `scale`; not a number counts as infinite."""
        apart = abs(self.found - self.wanted) / self.scale
        return apart if apart == apart else float("inf")

    @property
    def holds(self) -> bool:
        """Whether the difference is allowed."""
        return self.deviation <= self.allowed * (1.0 + 1e-9)


def printed(found: float, text: str, digits_of_input: float = 0.0) -> Compared:
    """A number in print: it holds within half a unit of its last digit.

    Parameters
    ----------
    found : float
    text : str
        As printed.
    digits_of_input : float, optional
        What the rounding of the printed inputs may move it by, in its own unit.
    """
    wanted = float(text)
    half = 0.5 * 10.0 ** -len(text.partition(".")[2]) + digits_of_input
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
        np.asarray(found, dtype=float), np.asarray(wanted, dtype=float), np.nan if stated is None else np.asarray(stated)
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
    compare : callable
        Gives the compared numbers.
    """

    name: str
    capability: str
    against: str
    source: str
    compare: Callable[[], Iterable[Compared]]

    @property
    def what(self) -> str:
        """First sentence of the function's docstring."""
        return (self.compare.__doc__ or "").strip().partition("\n\n")[0].replace("\n    ", " ").rstrip(".")


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
    def worst(self) -> Compared:
        """The number that comes nearest to what is allowed, or goes furthest beyond."""
        return max(self.compared, key=lambda one: one.deviation / one.allowed if one.allowed else one.deviation)

    @property
    def largest(self) -> Compared:
        """The number with the largest difference."""
        return max(self.compared, key=lambda one: one.deviation)

    @property
    def holds(self) -> bool:
        """Whether every number does; a row without numbers does not."""
        return bool(self.compared) and all(one.holds for one in self.compared)


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
        """Make a function a row."""

        def added(compare: Callable[[], Iterable[Compared]]) -> Callable[[], Iterable[Compared]]:
            self.all.append(Row(compare.__name__.replace("_", "-"), capability, against, source, compare))
            return compare

        return added
