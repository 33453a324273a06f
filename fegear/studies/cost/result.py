"""What a cost study found."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.studies.cost.orders import Order, observed_order
from fegear.studies.cost.pareto import cheapest, pareto_front
from fegear.studies.cost.timing import NOTHING, Seconds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from fegear.arrays import Array
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.configuration import Configuration
    from fegear.studies.cost.quantities import Miss, Quantity


#: Tolerances for which the cheapest settings are reported.
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
#: Stands for every quantity at once.
ALL = "all"


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
