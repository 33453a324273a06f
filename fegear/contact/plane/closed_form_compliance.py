"""A closed form of `fegear.formulas` as a compliance source: one tooth on its own, tabulated over its flank."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.contact.plane.compliance import OneTooth, Rigid
from fegear.contact.plane.spline import Spline, spline
from fegear.formulas.outcome import ComplianceSource
from fegear.formulas.palmgren import EXPONENT
from fegear.formulas.sources import source as formula_source
from fegear.geometry.gear import Gear

_POINTS = 81


@dataclass(frozen=True)
class ClosedFormCompliance(OneTooth):
    """Tooth compliance by a formula, its contact split into what the load-sharing solver knows.

    Parameters
    ----------
    gear : Gear
    formula : ComplianceSource
    own_spline : Spline
        Over the roll length [m].
    half_width : float
        Reference half-width [m].
    log_slope, power : float
        Of the contact formula: Hertz-like or Palmgren-like.
    linear_contact : float
        Part of `own` that is the contact's, of a formula that is linear in the load; else zero [m^2/N].
    """

    gear: Gear
    formula: ComplianceSource
    own_spline: Spline
    half_width: float
    log_slope: float
    power: float
    linear_contact: float = 0.0

    reach = 0
    kinks = ()

    def own(self, i: int, radius: ArrayLike) -> Array:  # noqa: ARG002  (all alike)
        """Tooth, foundation and the contact's part that is linear in the load [m^2/N]."""
        r, rb = np.asarray(radius, dtype=float), self.gear.base_radius
        length = np.sqrt(np.maximum((r - rb) * (r + rb), 0.0))
        return np.asarray(self.own_spline(np.clip(length, self.own_spline.x[0], self.own_spline.x[-1])))

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """The same everywhere [m]."""
        return np.full(np.shape(radius), self.half_width)

    def describe(self) -> str:
        """Return source and limits."""
        return f"{self.formula.citation}; {self.formula.remark}"


@dataclass(frozen=True, slots=True)
class ConstantCompliance(Rigid):
    """One number for all positions and loads, contact included: what the stiffness c' of ISO 6336-1 amounts to.

    Parameters
    ----------
    compliance : float
        Of one tooth [m^2/N].
    source : str
        Where it comes from.
    """

    compliance: float = 0.0
    source: str = "a constant"

    def own(self, i: int, radius: ArrayLike) -> Array:  # noqa: ARG002  (all alike)
        """The same everywhere [m^2/N]."""
        return np.full(np.shape(radius), self.compliance)

    def describe(self) -> str:
        """Return source and limits."""
        return f"{self.source}; constant over the mesh, no coupling of neighbouring teeth"


def closed_form_compliance(gear: Gear, name: str) -> ClosedFormCompliance:
    """Tabulate the closed form `name` for a gear.

    Parameters
    ----------
    gear : Gear
    name : str
        One of `fegear.formulas.sources.SOURCES`.

    Raises
    ------
    InputError
        If the name is unknown or the contact formula is neither linear, nor Hertz's, nor Palmgren's in the load.
    """
    formula = formula_source(name)
    rb = gear.base_radius
    low, high = (math.sqrt(max((r - rb) * (r + rb), 0.0)) for r in (gear.form_radius, gear.involute_tip_radius))
    lengths = np.linspace(low, high, _POINTS)
    radii = np.clip(np.hypot(rb, lengths), gear.form_radius, gear.involute_tip_radius)
    own = np.array(formula.tooth(gear, radii).total)
    # Probe the contact: how it grows with the load, and how it shrinks with the width.
    w, b = 1e5, 0.02 * gear.module
    here = formula.contact(gear, radii, w, b)
    exponent = math.log2(float(formula.contact(gear, radii[:1], 2.0 * w, b)[0] / here[0]))
    slope = float((here[0] - formula.contact(gear, radii[:1], w, 1.001 * b)[0]) / w / math.log(1.001))
    power = linear = 0.0
    if abs(exponent - 1.0) < 1e-9:
        own += here / w
        linear = float(here[0] / w)
    elif abs(exponent - EXPONENT) < 1e-9:
        power = float(here[0] / w**EXPONENT)
    else:
        raise InputError("compliance.source", f'"{name}"', f"has a contact deformation of exponent {exponent:.4f}")
    return ClosedFormCompliance(gear, formula, spline(lengths, own), b, max(slope, 0.0), power, linear)
