"""A finite-element source shifted by its own estimated error: what is left of the digits further down the chain."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import Side
    from fegear.contact.plane.fe_compliance import FiniteElementCompliance
    from fegear.fem.plane.root_stress import CutFillet, FilletCurve


_POINTS = 25
#: What the pressure's middle, which `edge_law` takes no notice of, changes at a tip corner, as a factor of the distance
#: from it that c_0 is taken at: solved tips of finite elements are softer by up to 1.4 times that.
_TIP = 1.6


@dataclass(frozen=True)
class ShiftedCompliance:
    """A source whose own compliance, or whose neighbours', is off by the estimated error.

    Parameters
    ----------
    base : FiniteElementCompliance
    radii, own_error : ndarray
        Added to c_0 over the radius [m], [m^2/N]; straight between the points.
    neighbour_error : float
        Added to every c_k [m^2/N].
    farther : float
        By which the distance from the tip's corner is larger that c_0 is taken at.
    edge : float
        Length of the flank's longest edges of finite elements, from one to the next of which the error of c_0 may
        alternate [m]; infinite where it does not.
    """

    base: FiniteElementCompliance
    radii: Array
    own_error: Array
    neighbour_error: float = 0.0
    farther: float = 1.0
    edge: float = math.inf

    def waves(self, pitch: float) -> float:
        """How often the error may alternate while a contact goes so far along the line of action [m].

        Where it goes fastest along the flank: at its largest distance from the axis.
        """
        roll = math.sqrt(max((float(self.radii[-1]) / self.base.influence.gear.base_radius) ** 2 - 1.0, 0.0))
        return pitch * roll / self.edge

    @property
    def reach(self) -> int:
        """As the base."""
        return self.base.reach

    @property
    def period(self) -> int:
        """As the base."""
        return self.base.period

    def same_as(self, first: int, count: int) -> int:
        """As the base."""
        return self.base.same_as(first, count)

    @property
    def log_slope(self) -> float:
        """As the base."""
        return self.base.log_slope

    power = 0.0
    kinks = ()
    remarks = ()

    @property
    def tip_wedge(self) -> tuple[float, float]:
        """As the base, shifted."""
        softer, room = self.base.tip_wedge
        return softer, room * self.farther

    def own(self, i: int, radius: ArrayLike) -> Array:
        """c_0 and its error [m^2/N]."""
        return np.asarray(
            self.base.own(i, radius) + np.interp(np.asarray(radius, dtype=float), self.radii, self.own_error)
        )

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """As the base."""
        return self.base.reference_half_width(radius)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_ij and its error [m^2/N]."""
        return np.asarray(self.base.between(i, j, radius_p, radius_q) + self.neighbour_error)

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """As the base."""
        return self.base.root_stress(i, j, radius_q, side)

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet | None:
        """As the base."""
        return self.base.fillet_curve(i, side)

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:
        """As the base."""
        return self.base.root_stress_error(i, j, radius_q, side)

    def describe(self) -> str:
        """As the base, shifted."""
        return f"{self.base.describe()}, shifted by its estimated error"


def shifted_by_error(base: FiniteElementCompliance) -> ShiftedCompliance:
    """The source with its loaded tooth softer by the estimated error, its neighbours by what they have of it."""
    known = base.influence
    low, high = _flank(base)
    radii = np.linspace(low, high, _POINTS)
    error = known.self_error(radii, base.reference_half_width(radii))
    return ShiftedCompliance(base, radii, error, known.common_errors()[0], farther=_TIP, edge=known.longest_edge)


def neighbours_shifted_by_error(base: FiniteElementCompliance) -> ShiftedCompliance:
    """The source with its neighbours softer by their estimated error, its loaded tooth by what it has of it."""
    few = np.linspace(*_flank(base), 4)
    errors = (float(np.nanmax(base.influence.neighbour_error(k, few, few))) for k in range(1, base.reach + 1))
    common = base.influence.common_errors()[1] if base.reach else 0.0
    return ShiftedCompliance(base, few, np.full_like(few, common), max(errors, default=0.0))


def _flank(base: FiniteElementCompliance) -> tuple[float, float]:
    """Radii between which the flank is in use [m]."""
    known = base.influence
    low, high = known.gear.involute_radii
    return max(known.lowest_radius, low), min(known.highest_radius, high)
