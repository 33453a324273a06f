"""Nominal stresses of a shaft: what forces and moments beyond a section make of bending, torsion and tension there.

Statics alone: the resultants of all that acts to the right of a section, over the section moduli of a hollow circle,

    sigma_b = |M_b| d / (2 I),    tau_t = |M_t| d / (4 I),    sigma_a = F_a / A,    I = pi/64 (d^4 - h^4),
    sigma_v = sqrt((|sigma_a| + sigma_b)^2 + 3 tau_t^2)      (von Mises)

at the outer fibre that is pulled or pressed most. Shear of transverse forces is zero there and left out, as are
notches, fits and what bodies of gears carry with the shaft. Forces and moments act at places, so that resultants jump
there: both sides of every place and step are looked at. Between two places of a cylinder the stress has no maximum, for
its resultants run straight; on cones further places are looked at.

Source: J. E. Shigley, Mechanical Engineering Design (R. G. Budynas, J. K. Nisbett, 9th edition, 2011), Section 7-4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays, distinct
from fegear.base.shown import shown
from fegear.shafts.beam import Shaft
from fegear.shafts.deflection import Deflection

#: Places along a shaft that are looked at besides its steps, bearings and forces.
_PLACES = 101
#: Both sides of a place that differ by less of the largest value are one.
_SAME = 1e-9


@dataclass(frozen=True)
class ShaftStress(ReadOnlyArrays):
    """Nominal stresses along a shaft; arrays of shape (n,), of places where something jumps both sides."""

    z: Array = shown("mm", "axial position from the left shaft end")
    diameter: Array = shown("mm", "outer diameter of the shaft", name="outer")
    bending: Array = shown("MPa", "nominal bending stress; alternating on a rotating shaft", label="bending")
    torsion: Array = shown("MPa", "nominal torsional stress", label="torsion")
    axial: Array = shown("MPa", "nominal axial stress, positive in tension", label="tension")
    equivalent: Array = shown("MPa", "nominal equivalent stress (von Mises)", label="equivalent stress")

    @property
    def most(self) -> int:
        """Number of the place with the largest equivalent stress; of equal ones the first."""
        return int(np.argmax(self.equivalent >= self.equivalent.max() * (1.0 - 1e-9)))


def nominal_stress(bent: Deflection, drawn: Shaft | None = None) -> ShaftStress:
    """Stresses of a shaft in equilibrium.

    Parameters
    ----------
    bent : Deflection
    drawn : Shaft, optional
        Its sections as they are; by default those that bend, which bodies of gears on it begin inside of.
    """
    shaft, (at, loads) = drawn or bent.loaded.shaft, bent.acting
    cuts = distinct(shaft.steps, at, np.linspace(0.0, shaft.length, _PLACES))
    middle = np.repeat(0.5 * (cuts[:-1] + cuts[1:]), 2)
    z = np.column_stack([cuts[:-1], cuts[1:]]).ravel()
    beyond = (at[None, :] > middle[:, None]).astype(float)
    arm = (at[None, :] - z[:, None]) * beyond
    resultant = beyond @ loads
    resultant[:, 3] -= arm @ loads[:, 1]
    resultant[:, 4] += arm @ loads[:, 0]
    outer, inner = shaft.diameters(z, middle)
    area, second = 0.25 * math.pi * (outer - inner) * (outer + inner), math.pi / 64.0 * (outer**4 - inner**4)
    bending = np.hypot(resultant[:, 3], resultant[:, 4]) * outer / (2.0 * second)
    torsion = np.abs(resultant[:, 5]) * outer / (4.0 * second)
    axial = resultant[:, 2] / area
    equivalent = np.sqrt((np.abs(axial) + bending) ** 2 + 3.0 * torsion**2)
    found = np.column_stack([outer, bending, torsion, axial, equivalent])
    found[np.abs(found) < _SAME * np.abs(found).max(axis=0)] = 0.0  # round-off of what balances
    return ShaftStress(*np.column_stack([z, found])[_jumps(found)].T)


def _jumps(found: Array) -> Index:
    """Rows of both sides of places where something jumps, of the others one, shape (k,)."""
    sizes = np.abs(found).max(axis=0)
    kept = np.ones(len(found), dtype=bool)
    kept[2::2] = (np.abs(found[2::2] - found[1:-1:2]) > _SAME * sizes).any(axis=1)
    return np.flatnonzero(kept)


def diameter_for(stress: ShaftStress, safety: float, required: float) -> float:
    """Outer diameter with which the weakest place would have the required safety [m], its bore in proportion.

    Parameters
    ----------
    stress : ShaftStress
    safety, required : float
    """
    return float(stress.diameter[stress.most]) * (required / safety) ** (1.0 / 3.0)
