"""A closed form of `fegear.formulas` as a compliance source: one tooth on its own, tabulated over its flank.

A closed form of `fegear.formulas` as a source of root stress: one tooth on its own, tabulated over its flank.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError, InputError, RangeError
from fegear.contact.plane.compliance import OneTooth, Rigid, Side
from fegear.contact.plane.fe_compliance import Spline, spline
from fegear.fem.plane.root_stress import FilletCurve
from fegear.formulas.outcome import ComplianceSource, RootStressSource
from fegear.formulas.sources import ROOT_STRESS_SOURCES
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
    """

    gear: Gear
    formula: ComplianceSource
    own_spline: Spline
    half_width: float
    log_slope: float
    power: float

    reach = 0
    kinks = ()

    def own(self, radius: ArrayLike) -> Array:
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

    def own(self, radius: ArrayLike) -> Array:
        """The same everywhere [m^2/N]."""
        return np.full(np.shape(radius), self.compliance)

    def describe(self) -> str:
        """Return source and limits."""
        return f"{self.source}; the same at every position, no coupling to the neighbouring teeth"


def closed_form_compliance(gear: Gear, name: str) -> ClosedFormCompliance:
    """Tabulate the closed form `name` for a gear.

    Parameters
    ----------
    gear : Gear
    name : str
        "cornell", "weber-banaschek" or "potential-energy".

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
    power = 0.0
    if abs(exponent - 1.0) < 1e-9:
        own += here / w
    elif abs(exponent - 0.9) < 1e-9:
        power = float(here[0] / w**0.9)
    else:
        raise InputError("compliance.source", f'"{name}"', f"has a contact that grows with the power {exponent:.4f}")
    return ClosedFormCompliance(gear, formula, spline(lengths, own), b, max(slope, 0.0), power)


#: Loads over the flank at which a formula is evaluated; between them a cubic spline is within 1e-5 of it (tested).
_STRESS_POINTS = 65


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

    def fillet_curve(self, side: Side) -> FilletCurve | None:  # noqa: ARG002  (the interface)
        """None: a formula knows the largest stress alone."""
        return None

    def root_stress_error(self, radius_q: ArrayLike, side: Side = "tension") -> Array:  # noqa: ARG002  (the interface)
        """Not a number [1/m]: a formula does not know how far it is off."""
        return np.full(np.shape(np.atleast_1d(radius_q)), math.nan)

    def describe(self) -> str:
        """Return source and limits."""
        return f"{self.formula.citation}: {self.formula.compared}; neighbouring teeth's loads do not count"


def formula_root_stress(
    gear: Gear, name: str, lowest: float, highest: float, points: int = _STRESS_POINTS
) -> FormulaRootStress:
    """Tabulate a root-stress formula for loads on a part of a gear's flank.

    Parameters
    ----------
    gear : Gear
        Its generated tooth; the fillet is the rack's, whatever mesh its finite elements may have.
    name : str
        A key of `fegear.formulas.sources.ROOT_STRESS_SOURCES`.
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
            found = source.formula(gear.external_tooth, float(radius) / gear.module)
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
