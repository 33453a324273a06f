"""A gear as an atlas answers for it: what a solved gear says to contact, from one row of numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.atlas.tables import over_contacts, shares_of_fillet, under_pressure
from fegear.base.arrays import ReadOnlyArrays
from fegear.contact.plane.fe_compliance import NOMINAL_HALF_WIDTH, chebyshev_over, own_lengths, roll_length
from fegear.contact.plane.spline import Spline, spline
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH, log_slope
from fegear.fem.plane.root_stress import FilletCurve

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from fegear.atlas.tables import Layout
    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side
    from fegear.geometry.gear import Gear


@dataclass(frozen=True, eq=False)
class AtlasGear(ReadOnlyArrays):
    """Compliance and root-stress influence of one gear, per unit face width, in SI; asked as `GearInfluence` is.

    Parameters
    ----------
    gear : Gear
    layout : Layout
    row : ndarray
        Its dimensionless tables.
    errors : mapping of str to float
        Estimated errors by quantity, those of the interpolation and of the solved gears (`Layout.quantities`).

    Notes
    -----
    c_0 at other half-widths than the nominal one follows by its logarithm. Stress along fillets is that of contacts
    0.02 modules wide to either side, and nearer to the contact than the largest stress is looked for it is that at the
    end of the search.
    """

    gear: Gear
    layout: Layout
    row: Array
    errors: Mapping[str, float]

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside the loaded one are known."""
        return self.layout.reach

    @property
    def lowest_radius(self) -> float:
        """Radius at which the flank starts [m]."""
        return self.gear.involute_radii[0]

    @property
    def highest_radius(self) -> float:
        """Radius at which the flank ends [m]."""
        return self.gear.involute_radii[1]

    @property
    def reference_half_width(self) -> float:
        """A contact's usual half-width, 0.02 modules [m]."""
        return REFERENCE_HALF_WIDTH * self.gear.module

    @property
    def log_slope(self) -> float:
        """2 (1 - nu^2) / (pi E) (no nu in plane stress) [1/Pa]."""
        material = self.gear.material
        return log_slope(material.poisson_ratio, self.gear.plane_assumption) / material.young_modulus

    @cached_property
    def tabulated(self) -> dict[str, Any]:
        """What has been tabulated of it, by name."""
        return {}

    @cached_property
    def _ends(self) -> tuple[float, float]:
        """Roll lengths of the ends of the flank [m]."""
        rb = self.gear.base_radius
        low, high = (math.sqrt(max((r - rb) * (r + rb), 0.0)) for r in self.gear.involute_radii)
        return low, high

    @cached_property
    def _own(self) -> Spline:
        own = self.layout.own(self.row) / self.gear.material.young_modulus
        return spline(own_lengths(self.gear, *self._ends), own)

    def _length(self, radius: ArrayLike) -> Array:
        return roll_length(self.gear, np.atleast_1d(np.asarray(radius, dtype=float)), *self._ends)

    def self_compliance(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0 of contacts of a half-width [m], shape (P,) [m^2/N]."""
        nominal = NOMINAL_HALF_WIDTH * self.gear.module
        return np.asarray(self._own(self._length(radius)) + self.log_slope * np.log(nominal / np.asarray(half_width)))

    @property
    def longest_edge(self) -> float:
        """Infinite: what is interpolated between gears is smooth along the flank."""
        return math.inf

    @property
    def states_error(self) -> bool:
        """They are."""
        return True

    def describe(self) -> str:
        """Return how its numbers were found."""
        return "FE of the full gear, interpolated from an atlas"

    def self_error(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `self_compliance` [m^2/N]."""
        return self.errors["c_self"] * self.self_compliance(radius, half_width)

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k(p, q): deflection at p of tooth k per unit line load at q of tooth 0, shape (P, Q) [m^2/N]."""
        p, q = self._length(radius_p)[:, None], self._length(radius_q)
        coefficients = self.layout.neighbour(self.row, abs(k))
        found = chebyshev_over(*self._ends, p, q, coefficients if k > 0 else coefficients.T)
        return np.asarray(found / self.gear.material.young_modulus)

    def neighbour_error(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:  # noqa: ARG002  (of all)
        """Estimated error of `neighbour` [m^2/N], shape (P, Q)."""
        smallest = self.layout.own(self.row).min() / self.gear.material.young_modulus
        return np.full((np.size(radius_p), np.size(radius_q)), self.errors["c_neighbour"] * smallest)

    def common_errors(self) -> tuple[float, float]:
        """None: what the errors of all teeth have in common is not told apart."""
        return 0.0, 0.0

    def fillet_stress(self, k: int, side: Side, radius: ArrayLike) -> Array:
        """Tangential stress along a fillet of tooth k per unit line load on tooth 0, shape (points, P) [1/m]."""
        weights = self._weights(np.atleast_1d(np.asarray(radius, dtype=float)), pressed=(k, side) == (0, "tension"))
        return np.ascontiguousarray((weights @ self.layout.stress(self.row, (k, side))).T) / self.gear.module

    def _weights(self, radius: Array, *, pressed: bool) -> Array:
        """Weights of the kept contacts for those at radii, (P, 27); all teeth are asked about at the same ones."""
        place = radius.tobytes(), pressed
        if place not in self._last:
            (low, high), length = self._ends, self._length(radius)
            while len(self._last) >= _KEPT:
                del self._last[next(iter(self._last))]
            shares = (length - low) / (high - low)
            self._last[place] = under_pressure(self.gear, self._ends, length) if pressed else over_contacts(shares)
        return self._last[place]

    @cached_property
    def _last(self) -> dict[tuple[bytes, bool], Array]:
        return {}

    def fillet_curve(self, side: Side) -> FilletCurve:
        """Where the largest stress of a fillet is looked for, radii and places [m]."""
        tooth, length = self.gear.tooth, self._fillet
        ends = float(tooth.roll(tooth.involute_radii[0]) ** 2), float(tooth.roll(tooth.involute_radii[1]) ** 2)
        return FilletCurve(side, length * shares_of_fillet(), length, tooth.base_radius, ends, self.gear.module)

    @cached_property
    def _fillet(self) -> float:
        """Length of a fillet [modules]."""
        return float(self.layout.ends(self.row)[1])

    def largest_root_stress(self, k: int, side: Side, radius: ArrayLike) -> tuple[Array, Array]:
        """Largest root tension or compression per unit line load [1/m] and its arc length from the root land [m]."""
        stress, touched = self.fillet_stress(k, side, radius), math.inf if k else np.atleast_1d(radius)
        return self.fillet_curve(side).largest(stress, touched)

    def root_stress_error(self, k: int, side: Side, radius: ArrayLike) -> Array:
        """Estimated error of `largest_root_stress` [1/m], shape (P,): in proportion to the largest over the flank."""
        return np.full(np.size(radius), self.errors[f"{side} {k}"] * self._largest_stress[side])

    @cached_property
    def _largest_stress(self) -> dict[Side, float]:
        radii = np.linspace(self.lowest_radius, self.highest_radius, 9)
        sides: tuple[Side, Side] = ("tension", "compression")
        return {side: float(np.abs(self.largest_root_stress(0, side, radii)[0]).max()) for side in sides}

    def largest_errors(self) -> Mapping[str, float]:
        """Estimated relative errors of c_self, c_neighbour (over c_self), root_tension and root_compression."""
        of = {"c_self": "c_self", "c_neighbour": "c_neighbour"} if self.reach else {"c_self": "c_self"}
        return {key: self.errors[one] for key, one in {**of, **_ROOT}.items()}


#: Of so many sets of contacts the weights are kept.
_KEPT = 4
_ROOT = {"root_tension": "tension 0", "root_compression": "compression 0"}
