"""A formula's answer at one point of a study: a value, or the reason in words why there is none.

What every compliance formula returns, and the sources that a load-sharing calculation can choose from.

All of them treat one tooth on its own: there is **no coupling to the neighbouring teeth** (c_k = 0 for k != 0), which
the finite elements have, and the gear body below the foundation is rigid (Weber and Banaschek, Cornell) or an elastic
ring (Sainsot).

What every root-stress formula returns: the stress and where it sits.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import ConvergenceError, FegearError, InputError, RangeError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Outcome(Generic[T]):
    """Either a value or a reason.

    Parameters
    ----------
    value : T or None
        What the formula gives; None when it gives nothing.
    reason : str
        Why there is no value; empty when there is one.
    """

    value: T | None
    reason: str = ""

    def __post_init__(self) -> None:
        """Refuse outcomes that say both or nothing."""
        if (self.value is None) != bool(self.reason):
            raise InputError("outcome", self, "must hold either a value or a reason")

    @property
    def ok(self) -> bool:
        """Whether there is a value."""
        return self.value is not None

    def unwrap(self) -> T:
        """Return the value, or raise a `RangeError` that carries the reason."""
        if self.value is None:
            raise RangeError("outcome", "none", self.reason)
        return self.value


def attempt(formula: Callable[[], T]) -> Outcome[T]:
    """Evaluate a formula; an argument outside its range becomes an outcome with a reason.

    Only the errors that a formula raises about its arguments are caught; a programming error still surfaces.
    """
    try:
        return Outcome(formula())
    except (InputError, ConvergenceError) as problem:
        return Outcome(None, _words(problem))


def _words(problem: FegearError) -> str:
    return str(problem) or type(problem).__name__


@dataclass(frozen=True, slots=True)
class ToothCompliance(ReadOnlyArrays):
    """Deflection of one tooth along the line of action per unit line load, without the contact; shape (N,) [m^2/N].

    Parameters
    ----------
    radius : ndarray
        Load radii [m].
    bending, shear, axial : ndarray
        The tooth as a cantilever.
    foundation : ndarray
        The body below it.
    """

    radius: Array
    bending: Array
    shear: Array
    axial: Array
    foundation: Array

    @property
    def total(self) -> Array:
        """Sum of the parts [m^2/N]."""
        return self.bending + self.shear + self.axial + self.foundation


class ComplianceFormula(Protocol):
    """Tooth compliance as a function of the load radius."""

    def __call__(self, gear: Gear, radius: ArrayLike) -> ToothCompliance:
        """Compliance of a tooth of `gear` under loads at `radius` [m]."""


class ContactFormula(Protocol):
    """Approach of one body of a loaded contact."""

    def __call__(self, gear: Gear, radius: ArrayLike, line_load: ArrayLike, half_width: ArrayLike) -> Array:
        """Contact deflection [m] of the tooth of `gear` loaded at `radius` [m] by `line_load` [N/m].

        `half_width` [m] is that of the Hertzian contact with the mating flank; formulas that know no radius of
        curvature ignore it.
        """


@dataclass(frozen=True, slots=True)
class ComplianceSource:
    """A closed form as a source of compliance for load sharing.

    Parameters
    ----------
    name : str
        As a case file writes it.
    tooth : ComplianceFormula
        Tooth and foundation, linear in the load.
    contact : ContactFormula
        Contact approach of one body, in general not linear in the load.
    citation : str
        Where it comes from.
    remark : str
        What it neglects.
    """

    name: str
    tooth: ComplianceFormula
    contact: ContactFormula
    citation: str
    remark: str = "single tooth, no coupling to neighbouring teeth"


@dataclass(frozen=True, slots=True)
class RootStress:
    """Largest tensile stress in the fillet on the loaded side, and its place, for a tooth of module 1.

    Parameters
    ----------
    stress : float
        Stress x module / line load, dimensionless: multiply by w/m, with w [N/m] the load normal to the flank per unit
        face width and m [m] the module, to get Pa.
    half_thickness : float
        Distance of the place from the tooth's centre line [modules].
    height : float
        Its height above the gear's centre along the centre line [modules].
    fillet_radius : float
        The fillet radius that the formula used [modules].
    tangent_angle : float
        Angle between the fillet's tangent there and the tooth's centre line [rad].
    remark : str
        What the reader must know about this value; empty when nothing.
    """

    stress: float
    half_thickness: float
    height: float
    fillet_radius: float
    tangent_angle: float
    remark: str = ""

    @property
    def radius(self) -> float:
        """Distance of the place from the gear's centre [modules]."""
        return math.hypot(self.half_thickness, self.height)


class RootStressFormula(Protocol):
    """A root-stress formula applied to a generated tooth."""

    def __call__(self, tooth: Tooth, radius: float) -> RootStress:
        """Root stress under a load normal to the flank at `radius` [modules]; raises `RangeError` out of range."""


@dataclass(frozen=True, slots=True)
class RootStressSource:
    """A root-stress formula with what a comparison must say about it.

    Parameters
    ----------
    name : str
        As tables and pictures write it.
    formula : RootStressFormula
    citation : str
    compared : str
        Which section, which fillet radius, and whether the radial compression is subtracted.
    """

    name: str
    formula: RootStressFormula
    citation: str
    compared: str
