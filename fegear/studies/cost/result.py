"""What a cost study found.

Which configurations nothing beats in both time and error, and the cheapest for a tolerance.

The order at which an error falls with a knob: a straight line through the asymptotic part of a log-log plot.

Processor seconds of one core, honestly: one thread, repeated when short.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from statistics import median
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.ladder import Configuration
    from fegear.studies.cost.quantities import Miss, Quantity


#: Tolerances for which the cheapest settings are reported.
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)


#: Stands for every quantity at once.
ALL = "all"


class Seconds(NamedTuple):
    """What some work took: processor seconds of this process, and seconds on the wall."""

    cpu: float
    wall: float

    def plus(self, other: Seconds) -> Seconds:
        """Both after one another."""
        return Seconds(self.cpu + other.cpu, self.wall + other.wall)


NOTHING = Seconds(0.0, 0.0)


@dataclass(frozen=True)
class Measured:
    """One quantity by one configuration.

    Parameters
    ----------
    configuration : Configuration
    quantity : str
    value : float
        The answer, or of many the one of largest size; SI; NaN without an answer.
    miss : Miss
        Against the reference.
    solve, own : Seconds
        For the gears' solutions that the quantity needs, and for the quantity from them.
    reason : str
        Why there is no answer; empty where there is one.
    compliance_error : float
        Largest relative error of the pair's c_0 that a pair's quantity stands on; 0 for others.
    fixed : Seconds
        Part of `own` that every configuration takes alike: load sharing and dynamics of a pair.
    """

    configuration: Configuration
    quantity: str
    value: float
    miss: Miss
    solve: Seconds = NOTHING
    own: Seconds = NOTHING
    reason: str = ""
    compliance_error: float = 0.0
    fixed: Seconds = NOTHING

    @property
    def compared(self) -> float:
        """Processor seconds that the choice of configuration decides about: without those common to all [s]."""
        return self.seconds.cpu - self.fixed.cpu

    @property
    def seconds(self) -> Seconds:
        """From nothing to the answer."""
        return self.solve.plus(self.own)


@dataclass(frozen=True)
class Knob:
    """One setting varied alone.

    Parameters
    ----------
    quantity, name : str
        Of what, and which setting.
    at : str
        What the others were, and what the error is against.
    settings, step : ndarray, shape (n,)
        The setting, and the length (or its inverse) that goes to zero.
    error : ndarray, shape (n,)
        Relative.
    seconds : ndarray, shape (n,)
        Processor seconds; NaN where the setting takes no time of its own.
    floor : float
    order : Order
    """

    quantity: str
    name: str
    at: str
    settings: Array
    step: Array
    error: Array
    seconds: Array
    floor: float
    order: Order


def make_knob(
    quantity: str, name: str, at: str, settings: ArrayLike, step: ArrayLike, error: ArrayLike,
    floor: float = 0.0, seconds: ArrayLike | None = None,
) -> Knob:  # fmt: skip
    """A knob with the order that its errors show."""
    s, h, e = (np.asarray(v, dtype=float) for v in (settings, step, error))
    t = np.full(s.shape, math.nan) if seconds is None else np.asarray(seconds, dtype=float)
    return Knob(quantity, name, at, s, h, e, t, floor, observed_order(h, e, floor))


@dataclass(frozen=True)
class Front:
    """Configurations of one quantity in arrays, shape (n,): what pictures and tables draw on.

    Parameters
    ----------
    rows : tuple of Measured
        Those that a user may choose from: tolerances, whose time includes their own error estimate, stand apart.
    seconds, error : ndarray
        Errors no smaller than the floor.
    front : ndarray of int
        Indices that nothing beats, in rising time without the seconds common to all.
    """

    rows: tuple[Measured, ...]
    seconds: Array
    error: Array
    front: NDArray[np.intp]


@dataclass(frozen=True)
class CostResults:
    """Errors and seconds of every configuration, the orders of the knobs, the cheapest settings.

    Parameters
    ----------
    asked : Asked
    reference : Configuration
    reference_values : mapping of str to float
        As `Measured.value`.
    floors : mapping of str to float
        Relative error of the reference for each quantity, estimated from a coarser one.
    rows : tuple of Measured
    knobs : tuple of Knob
    planned : int
        Configurations that were to be tried.
    seconds : float
        On the wall, for all.
    remarks : tuple of str
    solvers : str
        How many times as long `accuracy.solver = "scikit-fem"` takes, as measured; empty without plane gears.
    """

    asked: Asked
    reference: Configuration
    reference_values: Mapping[str, float]
    floors: Mapping[str, float]
    rows: tuple[Measured, ...]
    knobs: tuple[Knob, ...]
    planned: int
    seconds: float
    remarks: tuple[str, ...] = field(default=())
    solvers: str = ""

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """What was studied."""
        return self.asked.quantities

    @property
    def finished(self) -> int:
        """Configurations that were tried."""
        return len(dict.fromkeys(row.configuration for row in self.rows))

    @property
    def complete(self) -> bool:
        """Whether nothing interrupted it."""
        return self.finished == self.planned

    def shown_error(self, row: Measured) -> float:
        """Relative error, no smaller than what the reference itself knows; NaN without an answer everywhere."""
        return self.error_where_answered(row) if row.miss.answered == 1.0 else math.nan

    def error_where_answered(self, row: Measured) -> float:
        """The same over the positions that a formula answers; NaN without any."""
        return math.nan if row.reason else max(row.miss.largest, self.floors[row.quantity])

    def of(self, quantity: str) -> tuple[Measured, ...]:
        """All configurations of a quantity."""
        return tuple(row for row in self.rows if row.quantity == quantity)

    def front(self, quantity: str) -> Front:
        """Time, error and Pareto front of one quantity, or of `ALL` at once."""
        rows = self.at_once() if quantity == ALL else self.of(quantity)
        chosen = tuple(row for row in rows if row.configuration.family != "tolerance")
        seconds = np.array([row.seconds.cpu for row in chosen])
        error = np.array([row.miss.largest if quantity == ALL else self.shown_error(row) for row in chosen])
        return Front(chosen, seconds, error, pareto_front([row.compared for row in chosen], error))

    @property
    def named(self) -> tuple[str, ...]:
        """Names of the quantities, and of all at once where there are several and one configuration answers all."""
        names = tuple(q.name for q in self.quantities)
        return (*names, ALL) if len(names) > 1 and self.at_once() else names

    def at_once(self) -> tuple[Measured, ...]:
        """Configurations that answer every quantity: the worst error of any, the gears solved once."""
        from fegear.studies.cost.quantities import Miss

        names, found = [q.name for q in self.quantities], []
        for configuration in dict.fromkeys(row.configuration for row in self.rows):
            rows = [row for row in self.rows if row.configuration == configuration]
            errors = [self.shown_error(row) for row in rows]
            if [row.quantity for row in rows] != names or not np.isfinite(errors).all():
                continue
            solve = max((row.solve for row in rows), key=lambda s: s.cpu)
            own = fixed = NOTHING
            for row in rows[-1:] if self.asked.over_face else rows:  # one load over the face answers all quantities
                own, fixed = own.plus(row.own), fixed.plus(row.fixed)
            worst, stands_on = Miss(max(errors), math.nan, 1.0), max(row.compliance_error for row in rows)
            found.append(Measured(configuration, ALL, math.nan, worst, solve, own, "", stands_on, fixed))
        return tuple(found)

    def cheapest(self, quantity: str, tolerance: float) -> Measured | None:
        """The cheapest configuration within a tolerance; None if none is.

        The seconds that every configuration takes are not compared, for their noise would decide; and what is right
        with a compliance that is not has met the tolerance by luck.
        """
        front = self.front(quantity)
        errors = np.maximum(front.error, [row.compliance_error for row in front.rows])
        i = cheapest(tolerance, [row.compared for row in front.rows], errors)
        return None if i is None else front.rows[i]


def pareto_front(seconds: ArrayLike, error: ArrayLike) -> NDArray[np.intp]:
    """Indices of the configurations that no other configuration beats, from quick and rough to slow and accurate.

    Parameters
    ----------
    seconds, error : array_like, shape (n,)
        NaN where a configuration has no answer; such configurations are never on the front.

    Returns
    -------
    ndarray of int
        Errors fall strictly along it, seconds rise strictly.
    """
    t, e = np.asarray(seconds, dtype=float), np.asarray(error, dtype=float)
    front: list[int] = []
    best = np.inf
    for i in np.lexsort((e, t)):
        if np.isfinite(t[i]) and e[i] < best:
            front.append(int(i))
            best = e[i]
    return np.array(front, dtype=np.intp)


def cheapest(tolerance: float, seconds: ArrayLike, error: ArrayLike) -> int | None:
    """Index of the cheapest configuration whose error is within a tolerance, of equally cheap ones the best; or None.

    Parameters
    ----------
    tolerance : float
    seconds, error : array_like, shape (n,)
        NaN where a configuration has no answer.
    """
    t, e = np.asarray(seconds, dtype=float), np.asarray(error, dtype=float)
    good = np.flatnonzero(np.isfinite(t) & (e <= tolerance))
    return int(good[np.lexsort((e[good], t[good]))[0]]) if good.size else None


#: Errors below this many floors are too near to what the reference itself does not know.
ABOVE_FLOOR = 3.0


#: Configurations that lie farther than this factor off the line are not asymptotic yet.
_SCATTER = 1.6


#: A slope below this is none.
_FLAT = 0.1


#: A line through two points says nothing about itself.
_FEWEST = 3


@dataclass(frozen=True, slots=True)
class Order:
    """Observed order of convergence.

    Parameters
    ----------
    slope : float
        p of error ~ step^p; NaN where none is observed.
    used : int
        Configurations on the line, counted from the finest that lies above the floor.
    scatter : float
        Largest factor between a used error and the line; NaN without a line.
    words : str
        What the slope rests on, or why there is none.
    """

    slope: float
    used: int
    scatter: float
    words: str


def observed_order(step: ArrayLike, error: ArrayLike, floor: float = 0.0) -> Order:
    """Least-squares slope of log error over log step.

    Starts with every configuration above the floor and drops the coarsest, one by one, until those that remain lie on a
    line.

    Parameters
    ----------
    step, error : array_like, shape (n,)
        Positive steps and errors.
    floor : float
        Error of the reference: configurations below three times it say nothing.

    Returns
    -------
    Order
    """
    h, e = np.asarray(step, dtype=float), np.asarray(error, dtype=float)
    order = np.argsort(h)
    h, e = h[order], e[order]
    clear = np.isfinite(e) & (e > ABOVE_FLOOR * floor) & (e > 0.0)
    count = int(clear.sum())
    if count < _FEWEST:
        at = "are above the error of the reference" if floor > 0.0 else "have an error"
        return Order(math.nan, 0, math.nan, f"none: only {count} of {h.size} configurations {at}")
    x, y = np.log(h[clear]), np.log(e[clear])
    for used in range(count, _FEWEST - 1, -1):
        line = np.polyfit(x[:used], y[:used], 1)
        scatter = float(np.exp(np.abs(np.polyval(line, x[:used]) - y[:used]).max()))
        if scatter <= _SCATTER:
            if line[0] < _FLAT:
                return Order(math.nan, 0, math.nan, "none: the error does not decrease with the setting")
            basis = f"{used} of {h.size} configurations, within a factor of {scatter:.2f} of the line"
            return Order(float(line[0]), used, scatter, basis)
    return Order(math.nan, 0, math.nan, f"none: no {_FEWEST} adjacent configurations within {_SCATTER} of a line")


T = TypeVar("T")


#: What takes less than this is done again, three times in all, and the median counts [s].
_SHORT = 0.1


_TIMES = 3


def timed(work: Callable[[], T], *, repeat: bool = True) -> tuple[T, Seconds]:
    """Do some work and measure its seconds.

    Parameters
    ----------
    work : callable
        Must do everything anew each time it is called.
    repeat : bool
        Whether short work is done again for a median.
    """
    cpu, wall = [], []
    while True:
        started, clock = time.process_time(), time.perf_counter()
        found = work()
        cpu.append(time.process_time() - started)
        wall.append(time.perf_counter() - clock)
        if not repeat or cpu[0] > _SHORT or len(cpu) == _TIMES:
            return found, Seconds(median(cpu), median(wall))
