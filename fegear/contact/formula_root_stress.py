"""A closed form of `fegear.formulas` as a source of root stress: one tooth on its own, tabulated over its flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.spline import Spline, spline
from fegear.errors import ConvergenceError, InputError, RangeError
from fegear.formulas.root_stress_sources import ROOT_STRESS_SOURCES

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.contact.compliance import Side
    from fegear.formulas.root_stress import RootStressSource
    from fegear.geometry.gear import Gear

#: Loads over the flank at which a formula is evaluated; between them a cubic spline is within 1e-5 of it (tested).
_POINTS = 65


@dataclass(frozen=True)
class FormulaRootStress:
    """Root tension of a tooth under its own load by a closed form; loads on its neighbours leave it alone.

    Parameters
    ----------
    gear : Gear
    formula : RootStressSource
    over_length : Spline
        Root tension per unit line load [1/m] over the roll length [m].
    remarks : tuple of str
        What the formula says of its own values somewhere on the flank.
    """

    gear: Gear
    formula: RootStressSource
    over_length: Spline
    remarks: tuple[str, ...] = ()

    reach = 0

    def root_stress(self, k: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Largest root tension per unit line load [1/m], shape (1, Q); no formula knows the other fillet."""
        if side == "compression":
            return None
        r, rb = np.atleast_1d(np.asarray(radius_q, dtype=float)), self.gear.base_radius
        if k:
            return np.zeros((1, r.size))
        length, at = np.sqrt(np.maximum((r - rb) * (r + rb), 0.0)), self.over_length
        return np.asarray(at(np.clip(length, at.x[0], at.x[-1])))[None]

    def root_stress_error(self, radius_q: ArrayLike) -> Array:
        """Not a number [1/m]: a formula does not know how far it is off."""
        return np.full(np.shape(np.atleast_1d(radius_q)), math.nan)

    def describe(self) -> str:
        """Return source and limits."""
        return f"{self.formula.citation}: {self.formula.compared}; neighbouring teeth's loads do not count"


def formula_root_stress(
    gear: Gear, name: str, lowest: float, highest: float, points: int = _POINTS
) -> FormulaRootStress:
    """Tabulate a root-stress formula for loads on a part of a gear's flank.

    Parameters
    ----------
    gear : Gear
        Its generated tooth; the fillet is the rack's, whatever mesh its finite elements may have.
    name : str
        A key of `fegear.formulas.root_stress_sources.ROOT_STRESS_SOURCES`.
    lowest, highest : float
        Radii between which loads act [m].
    points : int
        Loads at which the formula is evaluated; four at least.

    Raises
    ------
    RangeError
        If the formula does not hold for a load there; key "source".
    """
    if name not in ROOT_STRESS_SOURCES:
        raise InputError(
            "source", f'"{name}"', f"is no root-stress formula; known are {', '.join(ROOT_STRESS_SOURCES)}"
        )
    source, rb = ROOT_STRESS_SOURCES[name], gear.base_radius
    low, high = (math.sqrt(max((r - rb) * (r + rb), 0.0)) for r in (lowest, highest))
    lengths = np.linspace(low, high, points)
    stress, remarks = [], []
    for radius in np.clip(np.hypot(rb, lengths), lowest, highest):
        try:
            found = source.formula(gear.tooth, float(radius) / gear.module)
            if not found.stress > 0.0:
                raise RangeError(
                    "root tension", f"{found.stress:.3g}", "is none: its compression outweighs its bending"
                )
        except (InputError, ConvergenceError) as error:
            why = f"{error.key} {error.value} {error.rule}" if isinstance(error, InputError) else str(error)
            others = ", ".join(f'"{other}"' for other in ROOT_STRESS_SOURCES if other != name)
            raise RangeError(
                "source", f'"{name}"', f"does not hold for a load at radius {radius * 1e3:.6g} mm: {why}",
                f'choose "fe" or another formula ({others})',
            ) from None  # fmt: skip
        stress.append(found.stress / gear.module)
        remarks += [found.remark] if found.remark else []
    return FormulaRootStress(gear, source, spline(lengths, stress), tuple(dict.fromkeys(remarks)))
