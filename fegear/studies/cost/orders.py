"""The order at which an error falls with a knob: a straight line through the asymptotic part of a log-log plot."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

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
        at = "lie above the reference's own error" if floor > 0.0 else "have an error"
        return Order(math.nan, 0, math.nan, f"none: only {count} of {h.size} configurations {at}")
    x, y = np.log(h[clear]), np.log(e[clear])
    for used in range(count, _FEWEST - 1, -1):
        line = np.polyfit(x[:used], y[:used], 1)
        scatter = float(np.exp(np.abs(np.polyval(line, x[:used]) - y[:used]).max()))
        if scatter <= _SCATTER:
            if line[0] < _FLAT:
                return Order(math.nan, 0, math.nan, "none: the error does not fall with the knob")
            basis = f"{used} of {h.size} configurations, within a factor of {scatter:.2f} of the line"
            return Order(float(line[0]), used, scatter, basis)
    return Order(
        math.nan, 0, math.nan, f"none: no {_FEWEST} neighbouring configurations lie within {_SCATTER} of a line"
    )
