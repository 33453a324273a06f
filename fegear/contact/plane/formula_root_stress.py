"""A closed form of `fegear.formulas` as a source of root stress: one tooth on its own, tabulated over its flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.compliance import Side
from fegear.contact.plane.spline import Spline, spline
from fegear.fem.alike_teeth import AlikeTeeth
from fegear.fem.plane.root_stress import FilletCurve
from fegear.formulas.outcome import Outcome, RootStress, RootStressSource, attempt
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.geometry.gear import Gear

if TYPE_CHECKING:
    from collections.abc import Callable


#: Loads over the flank at which a formula is evaluated; between them a cubic spline is within 1e-5 of it (tested).
_STRESS_POINTS = 65

#: Fewest points of a spline; round-off of a roll length; halvings that find where a formula begins to hold.
_FEWEST, _ROUND_OFF, _HALVINGS = 4, 1e-9, 30


@dataclass(frozen=True)
class FormulaRootStress(AlikeTeeth):
    """Root tension of a tooth under its own load by a closed form; loads on its neighbours leave it alone.

    Parameters
    ----------
    gear : Gear
    formula : RootStressSource
    over_length : tuple of Spline
        Root tension per unit line load [1/m] over the roll length [m], one for each part of the flank on which the
        formula holds.
    own_remarks : tuple of str
        What the formula says of its own values somewhere on the flank.
    missing : tuple of str
        Where on the flank it gives no value, and why.
    """

    gear: Gear
    formula: RootStressSource
    over_length: tuple[Spline, ...]
    own_remarks: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()

    reach = 0

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is to be said of it."""
        others = "; left blank, extremes are from the other loads" if self.over_length else ""
        return (*self.own_remarks, *(f"{one}{others}" for one in self.missing))

    @property
    def silent(self) -> bool:
        """Whether it gives no value for any load on the flank."""
        return not self.over_length

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Largest root tension per unit line load [1/m], shape (1, Q), NaN where the formula gives none.

        No formula knows the other fillet.
        """
        if side == "compression":
            return None
        r, rb = np.atleast_1d(np.asarray(radius_q, dtype=float)), self.gear.base_radius
        if i != j:
            return np.zeros((1, r.size))
        length = np.sqrt(np.maximum((r - rb) * (r + rb), 0.0))
        if not self.missing:
            (whole,) = self.over_length
            return np.asarray(whole(np.clip(length, whole.x[0], whole.x[-1])))[None]
        found = np.full(r.size, math.nan)
        for part in self.over_length:
            slack = _ROUND_OFF * part.x[-1]
            on = (length >= part.x[0] - slack) & (length <= part.x[-1] + slack)
            found[on] = part(np.clip(length[on], part.x[0], part.x[-1]))
        return found[None]

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | None:  # noqa: ARG002  (the interface)
        """None: a formula knows the largest stress alone."""
        return None

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:  # noqa: ARG002  (unknown anywhere)
        """Not a number [1/m]: a formula does not know how far it is off."""
        return np.full(np.shape(np.atleast_1d(radius_q)), math.nan)

    def describe(self) -> str:
        """Return source and limits."""
        return f"{self.formula.citation}: {self.formula.compared}; loads on neighbouring teeth not included"


def formula_root_stress(
    gear: Gear, name: str, lowest: float, highest: float, points: int = _STRESS_POINTS
) -> FormulaRootStress:
    """Tabulate a root-stress formula for loads on a part of a gear's flank.

    Parameters
    ----------
    gear : Gear
        Its generated tooth; the fillet is the rack's, whatever mesh its finite elements may have.
    name : str
        A key of `fegear.formulas.root_stress_formulas.ROOT_STRESS_SOURCES`.
    lowest, highest : float
        Radii between which loads act [m].
    points : int
        Loads at which the formula is evaluated; four at least.

    Returns
    -------
    FormulaRootStress
        Without a value for loads at which the formula does not hold; `missing` says where, and why.

    Raises
    ------
    InputError
        If there is no such formula; key "source".
    """
    if name not in ROOT_STRESS_SOURCES:
        raise InputError(
            "source", f'"{name}"', f"is an unknown root-stress formula; available: {', '.join(ROOT_STRESS_SOURCES)}"
        )
    source, rb = ROOT_STRESS_SOURCES[name], gear.base_radius
    low, high = (math.sqrt(max((r - rb) * (r + rb), 0.0)) for r in (lowest, highest))
    remarks: list[str] = []

    def at(length: float) -> Outcome[float]:
        """Root tension per unit line load [1/m] under a load at a roll length [m], or why there is none."""
        radius = float(np.clip(math.hypot(rb, length), lowest, highest))
        found = attempt(partial(_root_tension, source, gear, radius / gear.module))
        if found.value is None:
            return Outcome(None, found.reason)
        remarks.extend([found.value.remark] if found.value.remark else [])
        return Outcome(found.value.stress / gear.module)

    parts, missing = [], []
    lengths = np.linspace(low, high, points)
    outcomes = [at(length) for length in lengths.tolist()]
    for holds, run in groupby(range(points), key=lambda n: outcomes[n].ok):
        numbers = list(run)
        first, last = numbers[0], numbers[-1]
        if not holds:
            missing.append(_silent(rb, lengths[first], lengths[last], outcomes[first].reason))
            continue
        begin = _edge(at, lengths[first], lengths[first - 1]) if first else low
        end = _edge(at, lengths[last], lengths[last + 1]) if last < points - 1 else high
        nodes, values = lengths[first : last + 1], [outcomes[n].value for n in numbers]
        if len(numbers) < points:
            again = np.linspace(begin, end, points)
            tried = [at(length) for length in again.tolist()]
            if all(one.ok for one in tried):
                nodes, values = again, [one.value for one in tried]
        if len(values) >= _FEWEST and nodes[-1] > nodes[0]:
            parts.append(spline(nodes, np.array(values, dtype=float)))
    return FormulaRootStress(gear, source, tuple(parts), tuple(dict.fromkeys(remarks)), tuple(missing))


def _root_tension(source: RootStressSource, gear: Gear, radius: float) -> RootStress:
    """What a formula gives for a load at a radius [modules]; compression is no root tension."""
    found = source.formula(gear.external_tooth, radius)
    if not found.stress > 0.0:
        raise RangeError("root tension", f"{found.stress:.3g}", "is not positive: radial compression exceeds bending")
    return found


def _edge(at: Callable[[float], Outcome[float]], holds: float, fails: float) -> float:
    """The last roll length at which a formula holds, between one at which it does and one at which it does not [m]."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (holds + fails)
        holds, fails = (middle, fails) if at(middle).ok else (holds, middle)
    return holds


def _silent(base_radius: float, first: float, last: float, reason: str) -> str:
    """Where a formula gives nothing, by radii of the load, and why at the first of them."""
    ends = [f"{math.hypot(base_radius, length) * 1e3:.6g}" for length in (first, last)]
    where = f"radii {ends[0]} to {ends[1]} mm" if last > first else f"radius {ends[0]} mm"
    return f"no value for loads at {where} ({reason.rstrip('.')})"
