"""A formula as a compliance source of a gear some of whose teeth are cracked: the ordinary one, and a curve for each.

The potential-energy method only has a cracked tooth (Chen and Shao 2011); all else of an odd tooth is its flank.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.contact.plane.closed_form_compliance import ClosedFormCompliance, closed_form_compliance
from fegear.contact.plane.compliance import OneTooth
from fegear.contact.plane.spline import Spline, spline
from fegear.formulas import potential_energy_crack, potential_energy_simplified

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.formulas.outcome import ToothCompliance
    from fegear.geometry.gear import Gear

    Tip = tuple[float, float]

#: Formulas that have a cracked tooth, by their names as sources.
CRACKED: Mapping[str, Callable[[Gear, ArrayLike, Tip], ToothCompliance]] = {
    "potential-energy": potential_energy_crack.cracked_tooth_compliance,
    "potential-energy-simplified": potential_energy_simplified.tooth_compliance,
}


@dataclass(frozen=True)
class OddFormulaCompliance(OneTooth):
    """One gear's tooth compliance by a formula, some of its teeth cracked.

    Parameters
    ----------
    ordinary : ClosedFormCompliance
    own_splines : mapping of int to Spline
        Of cracked teeth [m^2/N] over the roll length [m], by the tooth's own number (`fegear.fem.alike_teeth`).
    """

    ordinary: ClosedFormCompliance
    own_splines: Mapping[int, Spline]

    reach = 0
    kinks = ()

    @property
    def gear(self) -> Gear:
        """Whose teeth they are."""
        return self.ordinary.gear

    @property
    def log_slope(self) -> float:
        """As of the ordinary teeth [m^2/N]."""
        return self.ordinary.log_slope

    @property
    def power(self) -> float:
        """As of the ordinary teeth."""
        return self.ordinary.power

    @property
    def linear_contact(self) -> float:
        """As of the ordinary teeth [m^2/N]."""
        return self.ordinary.linear_contact

    @property
    def period(self) -> int:  # type: ignore[override]  # of alike teeth it is one
        """The gear's teeth."""
        return self.gear.teeth

    def same_as(self, first: int, count: int) -> int:
        """Those from `first` on by themselves where one of them is cracked; else the first that are ordinary."""
        z = self.period
        free = (start for start in range(z) if not any((start + n) % z in self.own_splines for n in range(count)))
        if any((first + n) % z in self.own_splines for n in range(count)):
            return first % z
        return next(free)

    def own(self, i: int, radius: ArrayLike) -> Array:
        """Tooth, foundation and the contact's part that is linear in the load [m^2/N]."""
        curve = self.own_splines.get(i % self.period)
        if curve is None:
            return self.ordinary.own(i, radius)
        r, rb = np.asarray(radius, dtype=float), self.gear.base_radius
        return np.asarray(curve(np.clip(np.sqrt(np.maximum((r - rb) * (r + rb), 0.0)), curve.x[0], curve.x[-1])))

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """As of the ordinary teeth [m]."""
        return self.ordinary.reference_half_width(radius)

    def describe(self) -> str:
        """Return source and limits."""
        z, teeth = self.period, ", ".join(map(str, sorted(self.own_splines)))
        return f"{self.ordinary.describe()}; of {z} teeth cracked: {teeth}, crack after Chen and Shao 2011"


def odd_formula_compliance(gear: Gear, name: str, tips: Mapping[int, Tip]) -> GearByFormula:
    """Tabulate a closed form for a gear with cracked teeth.

    Parameters
    ----------
    gear : Gear
    name : str
        One of `CRACKED` where any tooth is cracked.
    tips : mapping of int to (float, float)
        Tips of the cracks by the tooth's own number, in the frame of `potential_energy_crack`: cracks begin in the
        fillet at x > 0 [modules].

    Returns
    -------
    ClosedFormCompliance or OddFormulaCompliance

    Raises
    ------
    InputError
        If the formula has no cracked tooth, does not cover the gear, or a crack leaves nothing of a section.
    """
    ordinary = closed_form_compliance(gear, name)
    if not tips:
        return ordinary
    if name not in CRACKED:
        raise InputError(
            "compliance.source", f'"{name}"', "has no formula for a cracked tooth",
            "use " + ", ".join(f'"{one}"' for one in CRACKED) + ' or "fe"',
        )  # fmt: skip
    whole = ordinary.own_spline
    radii = np.clip(np.hypot(gear.base_radius, whole.x), gear.form_radius, gear.involute_tip_radius)
    softer = {
        number: np.array(CRACKED[name](gear, radii, tip).total) - np.array(ordinary.formula.tooth(gear, radii).total)
        for number, tip in tips.items()
    }
    return OddFormulaCompliance(
        ordinary, {number % gear.teeth: spline(whole.x, whole.y + more) for number, more in softer.items()}
    )


GearByFormula = ClosedFormCompliance | OddFormulaCompliance
