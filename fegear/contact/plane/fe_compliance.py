"""The finite-element influence functions as a compliance source: tabulated once, then cheap anywhere on the flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np

from fegear.base.errors import RangeError
from fegear.contact.plane.spline import Spline, spline
from fegear.fem.alike_teeth import AlikeTeeth
from fegear.fem.plane.contact_width import corner_angles, wedge_slope

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import Side
    from fegear.contact.plane.stress_rows import StressRows
    from fegear.fem.plane.root_stress import FilletCurve
    from fegear.geometry.gear import Gear


#: Interpolation points over the flank: splines for the loaded tooth, Chebyshev polynomials for its smooth neighbours.
_OWN_POINTS = 97


_NEIGHBOUR_POINTS = 14


#: Half-width that c_0 is given for [modules], and that a contact keeps whose width does not follow its load.
NOMINAL_HALF_WIDTH = 0.08


@runtime_checkable
class SolvedTeeth(Protocol):
    """What a gear answers whose teeth have been solved, or interpolated from solved ones; SI, as `GearInfluence`."""

    @property
    def gear(self) -> Gear:
        """Which gear it is."""

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside the loaded one are known."""

    @property
    def log_slope(self) -> float:
        """Slope of c_0 over the logarithm of the contact's half-width [m^2/N]."""

    @property
    def reference_half_width(self) -> float:
        """A contact's usual half-width [m]."""

    @property
    def lowest_radius(self) -> float:
        """Minimum radius of the flank [m]."""

    @property
    def highest_radius(self) -> float:
        """Maximum radius of the flank [m]."""

    @property
    def longest_edge(self) -> float:
        """Of finite elements on the flank [m]; infinite where they leave nothing of themselves in compliances."""

    @property
    def tabulated(self) -> dict[str, Any]:
        """What has been tabulated of it, by name."""

    def self_compliance(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0 of contacts of a half-width [m], (P,) [m^2/N]."""

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k(p, q), (P, Q) [m^2/N]."""

    @property
    def states_error(self) -> bool:
        """Whether its errors are estimated."""

    def describe(self) -> str:
        """Return how its numbers were found."""

    def self_error(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `self_compliance` [m^2/N]."""

    def neighbour_error(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """Estimated error of `neighbour` [m^2/N]."""

    def common_errors(self) -> tuple[float, float]:
        """What of the errors of compliance all teeth have in common [m^2/N]."""

    def fillet_stress(self, k: int, side: Side, radius: ArrayLike) -> Array:
        """Stress along a fillet of tooth k per unit line load on tooth 0, (points, P) [1/m]."""

    def fillet_curve(self, side: Side) -> FilletCurve:
        """How the largest stress between those points is found."""

    def root_stress_error(self, k: int, side: Side, radius: ArrayLike) -> Array:
        """Estimated error of the largest stress [1/m], (P,)."""


@dataclass(frozen=True)
class FiniteElementCompliance(AlikeTeeth):
    """One gear's influence functions over its flank, interpolated in the roll length.

    Parameters
    ----------
    influence : SolvedTeeth
    own_spline : Spline
        c_0 at the reference half-width [m^2/N] over the roll length [m].
    lowest, highest : float
        Roll lengths of the ends of the flank [m], rising toward the tip: those of internal gears are negative.
    """

    influence: SolvedTeeth
    own_spline: Spline
    lowest: float
    highest: float

    kinks = ()
    power = 0.0
    remarks = ()

    @cached_property
    def stress_rows(self) -> dict[tuple[Side, int, int], StressRows]:
        """Root stress at the contacts asked for last, by fillet, by how many neighbours count, and by the teeth."""
        return {}

    @property
    def reach(self) -> int:
        """K of the finite-element solution."""
        return self.influence.reach

    @property
    def states_error(self) -> bool:
        """Whether its errors are estimated."""
        return self.influence.states_error

    @property
    def log_slope(self) -> float:
        """kappa [m^2/N]."""
        return self.influence.log_slope

    @property
    def tip_wedge(self) -> tuple[float, float]:
        """Of the tip's angle, and the usual half-width."""
        angle = corner_angles(self.influence.gear.tooth)[1]
        return 0.5 * math.pi * wedge_slope(angle) - 1.0, self.influence.reference_half_width

    @property
    def neighbours(self) -> Mapping[int, Array]:
        """Chebyshev coefficients of c_k(p, q), shape (m, m) each; made when a neighbour is first asked for."""
        kept, ends = self.influence.tabulated, f"neighbours {self.lowest.hex()} {self.highest.hex()}"
        if ends not in kept:
            kept[ends] = self._tabulated_neighbours()
        found: Mapping[int, Array] = kept[ends]
        return found

    def _tabulated_neighbours(self) -> dict[int, Array]:
        nodes, to_coefficients = chebyshev_nodes(self.influence.gear, self.lowest, self.highest)
        found = {}
        for k in range(1, self.reach + 1):
            found[k] = to_coefficients @ self.influence.neighbour(k, nodes, nodes) @ to_coefficients.T
            found[-k] = found[k].T  # reciprocity, exact for pressure-weighted deflections
        return found

    def _roll_length(self, radius: ArrayLike) -> Array:
        return roll_length(self.influence.gear, radius, self.lowest, self.highest)

    def own(self, i: int, radius: ArrayLike) -> Array:  # noqa: ARG002  (all alike)
        """c_0 at the reference half-width [m^2/N]."""
        return np.asarray(self.own_spline(self._roll_length(radius)))

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """The half-width that `own` is for [m]; others follow by their logarithm."""
        return np.full(np.shape(radius), NOMINAL_HALF_WIDTH * self.influence.gear.module)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k(p, q), k = i - j, zero beyond the reach."""
        if abs(k := i - j) > self.reach:
            return np.zeros(np.broadcast_shapes(np.shape(radius_p), np.shape(radius_q)))
        p, q = (self._roll_length(r) for r in (radius_p, radius_q))
        return chebyshev_over(self.lowest, self.highest, p, q, self.neighbours[k])

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Tangential stress along the fillet of tooth k = i - j [1/m], shape (points, Q); zero beyond the reach."""
        if abs(k := i - j) > self.reach:
            return np.zeros_like(self.influence.fillet_stress(0, side, radius_q))
        return self.influence.fillet_stress(k, side, radius_q)

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | None:  # noqa: ARG002  (all alike)
        """That of the solution."""
        return self.influence.fillet_curve(side)

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:
        """Estimated error of the largest stress of a fillet of tooth k = i - j under a load on tooth 0 [1/m]."""
        known = self.influence
        return known.root_stress_error(i - j, side, np.clip(radius_q, known.lowest_radius, known.highest_radius))

    def describe(self) -> str:
        """Return what it includes."""
        coupled = f"coupling to neighbours up to {self.reach} teeth away" if self.reach else "no neighbour coupling"
        return f"{self.influence.describe()}, {coupled}, contact with Hertzian half-width"


def roll_length(gear: Gear, radius: ArrayLike, lowest: float, highest: float) -> Array:
    """Roll lengths [m] of radii [m] on a flank between two roll lengths [m]; negative on internal gears.

    Raises
    ------
    RangeError
        If a radius is off the flank.
    """
    r, rb = np.asarray(radius, dtype=float), gear.base_radius
    length = gear.tooth.side * np.sqrt(np.maximum((r - rb) * (r + rb), 0.0))
    slack = 1e-6 * gear.module
    off = (length < lowest - slack) | (length > highest + slack)
    if off.any():
        raise RangeError(
            "radius",
            f"{float(r[off].flat[0]) * 1e3:.6g} mm",
            f"is outside the flank, {math.hypot(rb, lowest) * 1e3:.6g} mm to {math.hypot(rb, highest) * 1e3:.6g} mm",
        )
    return np.clip(length, lowest, highest)


def chebyshev_nodes(gear: Gear, lowest: float, highest: float) -> tuple[Array, Array]:
    """Radii [m] at which functions over a flank between two roll lengths [m] are taken; the matrix to their series."""
    m = _NEIGHBOUR_POINTS
    t = np.cos(math.pi * (np.arange(m) + 0.5) / m)
    radii = np.hypot(gear.base_radius, 0.5 * (lowest + highest) + 0.5 * (highest - lowest) * t)
    return radii, np.asarray(np.linalg.inv(np.polynomial.chebyshev.chebvander(t, m - 1)))


def chebyshev_over(lowest: float, highest: float, p: Array, q: Array, coefficients: Array) -> Array:
    """A Chebyshev series in two roll lengths [m] between the same ends, shape of p and q broadcast."""
    middle, half = 0.5 * (lowest + highest), 0.5 * (highest - lowest)
    first, second = np.broadcast_arrays((p - middle) / half, (q - middle) / half)
    at = np.stack([first.ravel(), second.ravel()])
    if first.size == 1:  # one place alone would be summed in another order than in company
        at = np.repeat(at, 2, axis=1)
    waves = np.empty((coefficients.shape[0], *at.shape))
    waves[0], waves[1] = 1.0, at
    for n in range(2, waves.shape[0]):
        np.multiply(2.0 * at, waves[n - 1], out=waves[n])
        waves[n] -= waves[n - 2]
    along = np.einsum("ij,jp->ip", coefficients, waves[:, 1])
    along *= waves[:, 0]
    return np.asarray(along.sum(axis=0)[: first.size].reshape(first.shape))


def finite_element_compliance(influence: SolvedTeeth) -> FiniteElementCompliance:
    """Tabulate the influence functions of a solved gear, once for each solution."""
    # Kept are the tables alone: what holds the solution itself would keep it alive in a circle, and with it its memory.
    if "own" not in influence.tabulated:
        influence.tabulated["own"] = tabulated_own(influence)
    return FiniteElementCompliance(influence, *influence.tabulated["own"])


def tabulated_own(influence: SolvedTeeth) -> tuple[Spline, float, float]:
    """c_0 at the nominal half-width [m^2/N] over the roll length [m], and the ends of the flank [m]."""
    gear = influence.gear
    rb, (lowest, highest) = gear.base_radius, gear.involute_radii
    bottom, top = max(influence.lowest_radius, lowest), min(influence.highest_radius, highest)
    low, high = sorted(gear.tooth.side * math.sqrt(max((r - rb) * (r + rb), 0.0)) for r in (bottom, top))
    lengths = own_lengths(gear, low, high)
    radii = np.clip(np.hypot(rb, lengths), bottom, top)
    # Taken at a usual width, where what goes with the width itself is right, and given for the nominal one.
    usual, nominal = influence.reference_half_width, NOMINAL_HALF_WIDTH * gear.module
    own = influence.self_compliance(radii, usual) - influence.log_slope * math.log(nominal / usual)
    return spline(lengths, own), low, high


def own_lengths(gear: Gear, lowest: float, highest: float) -> Array:
    """Roll lengths [m] at which c_0 is tabulated on a flank between two roll lengths [m].

    The compliance bends most where the patch has to shrink, within its own width of the tip corner: points crowd
    there, half of them in the last tenth of a module, and a little where the flank starts.
    """
    corner = 0.1 * gear.module * gear.base_radius / max(abs(highest), 1e-9 * gear.base_radius)
    corner = min(corner, 0.3 * (highest - lowest))
    s = np.linspace(0.0, 1.0, _OWN_POINTS // 2)
    below = lowest + (highest - corner - lowest) * (s * s * (3.0 - 2.0 * s))
    return np.concatenate([below[:-1], highest - corner * (1.0 - s)])
