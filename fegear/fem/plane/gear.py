"""Influence functions of a real gear in SI, with their own error estimate and the seconds that they took."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import RangeError
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.estimate import QUANTITIES, Estimate
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_on_pins import over_the_teeth
from fegear.geometry.gear import Gear

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Influence, Side
    from fegear.fem.plane.root_stress import FilletCurve
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Gear


@dataclass(frozen=True)
class Round:
    """One solution on the way to a tolerance.

    Attributes
    ----------
    settings : MeshSettings
    unknowns : int
        Of one sector.
    errors : mapping of str to float
        Largest estimated relative error over the flank of c_self, c_neighbour (over c_self), root_tension and
        root_compression.
    seconds : float
    """

    settings: MeshSettings
    unknowns: int
    errors: Mapping[str, float]
    seconds: float

    @property
    def error(self) -> float:
        """The largest of them."""
        return max(self.errors.values())


@dataclass(frozen=True)
class GearInfluence:
    """Compliance and root-stress influence of one gear, per unit face width, in SI.

    Parameters
    ----------
    gear : Gear
    fine : Influence
        The solution that every number comes from.
    estimate : Estimate or None
        Its error, from a second solution; without one errors are not numbers.
    settings : MeshSettings
    seconds : mapping of str to float
    rounds : tuple of Round
        What was solved on the way to a tolerance, the last of them kept; empty where settings were given.
    """

    gear: Gear
    fine: Influence
    estimate: Estimate | None
    settings: MeshSettings
    seconds: Mapping[str, float] = field(compare=False)
    rounds: tuple[Round, ...] = field(default=(), compare=False)

    @property
    def coarse(self) -> Influence | None:
        """The second solution."""
        return None if self.estimate is None else self.estimate.coarse

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside the loaded one are known."""
        return self.fine.reach

    @property
    def lowest_radius(self) -> float:
        """Radius at which the flank starts [m]."""
        return self.fine.flank.lowest_radius * self.gear.module

    @property
    def highest_radius(self) -> float:
        """Radius at which the flank ends [m]."""
        return self.fine.flank.highest_radius * self.gear.module

    @property
    def reference_half_width(self) -> float:
        """A contact's usual half-width, 0.02 modules [m]."""
        return REFERENCE_HALF_WIDTH * self.gear.module

    @property
    def log_slope(self) -> float:
        """2 (1 - nu^2) / (pi E) (no nu in plane stress) [1/Pa]: d c_0 / d ln(1 / half-width)."""
        return self.fine.log_slope / self.gear.material.young_modulus

    @property
    def longest_edge(self) -> float:
        """Of the flank's elements [m]."""
        return float(np.diff(self.fine.flank.arc).max()) * self.gear.module

    def _modules(self, radius: ArrayLike) -> Array:
        return np.atleast_1d(np.asarray(radius, dtype=float)) / self.gear.module

    def self_compliance(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0(p, p) of a contact with a given half-width.

        Parameters
        ----------
        radius : array_like, shape (P,)
            Contact radius [m].
        half_width : array_like
            Half-width of the contact [m], broadcast against `radius`.

        Returns
        -------
        ndarray, shape (P,)
            [m^2/N].
        """
        b = np.asarray(half_width, dtype=float) / self.gear.module
        c = self.fine.self_compliance(self._modules(radius), self.settings.patch_half_width, b)
        return c / self.gear.material.young_modulus

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k(p, q): deflection at p of tooth k per unit line load at q of tooth 0, shape (P, Q) [m^2/N].

        Raises
        ------
        RangeError
            If the gear was solved for fewer neighbours.
        """
        self._check_reach(k)
        a = self.settings.patch_half_width
        c = self.fine.neighbour(k, self._modules(radius_p), self._modules(radius_q), a)
        return c / self.gear.material.young_modulus

    def _check_reach(self, k: int) -> None:
        if abs(k) > self.reach:
            known = f"was not solved: teeth {-self.reach} to {self.reach} are known" if self.reach else "was not solved"
            raise RangeError("k", f"{k}", known, f"set reach={abs(k)} in solve_gear")

    def _half_width(self, half_width: ArrayLike | None) -> Array:
        if half_width is None:
            return np.asarray(REFERENCE_HALF_WIDTH)
        return np.asarray(half_width, dtype=float) / self.gear.module

    def fillet_stress(self, k: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None) -> Array:
        """Tangential stress along a fillet of tooth k per unit line load on tooth 0, shape (points, P) [1/m].

        Half-widths [m] are 0.02 modules unless given.
        """
        r, b = self._modules(radius), self._half_width(half_width)
        return self.fine.fillet_stress(k, side, r, b) / self.gear.module

    def fillet_curve(self, side: Side) -> FilletCurve:
        """Where the largest stress of a fillet is looked for, radii and places [m]."""
        return self.fine.fillet_curve(side, self.gear.module)

    def largest_root_stress(
        self, k: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Largest root tension or compression per unit line load [1/m] and its arc length from the root land [m].

        Half-widths [m] are 0.02 modules unless given.
        """
        m = self.gear.module
        value, arc = self.fine.largest_root_stress(k, side, self._modules(radius), self._half_width(half_width))
        return value / m, arc * m

    def over_the_teeth(self, radius: ArrayLike, half_width: ArrayLike) -> dict[str, Array]:
        """c_self [m^2/N], root_tension and root_compression [1/m] of all teeth that stand differently to pins, (T, P).

        Tooth 0 first; of a rim without pins all teeth are alike.
        """
        r, b = self._modules(radius), np.asarray(half_width, dtype=float) / self.gear.module
        found = over_the_teeth(self.fine, r, self.settings.patch_half_width, b)
        modulus, m = self.gear.material.young_modulus, self.gear.module
        return {key: value / (modulus if key == "c_self" else m) for key, value in found.items()}

    def contact(self, radius: ArrayLike, half_width: ArrayLike) -> tuple[Array, Array, Array]:
        """`self_compliance`, its estimated error, and how much less a true contact gives way, shape (P,) each [m^2/N].

        The error is that of the mesh (`self_error`). Beside the tip a contact gives way less than under Hertz's
        pressure, which c_0 is for (`Influence.contact`); how much depends on the mating flank.
        """
        r, b = self._modules(radius), np.asarray(half_width, dtype=float) / self.gear.module
        if self.estimate is None:
            value, less = self.fine.contact(r, self.settings.patch_half_width, b)
            error = np.full(value.shape, np.nan)
        else:
            value, error, less = self.estimate.contact(r, b)
        modulus = self.gear.material.young_modulus
        return value / modulus, error / modulus, less / modulus

    @property
    def states_error(self) -> bool:
        """Whether its errors are estimated."""
        return self.estimate is not None

    def describe(self) -> str:
        """Return how its numbers were found."""
        return "FE of the full gear"

    def self_error(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `self_compliance` [m^2/N]: what the elements' last order and wider pressures change."""
        r, b = self._modules(radius), np.asarray(half_width, dtype=float) / self.gear.module
        if self.estimate is None:
            return np.full(np.broadcast_shapes(r.shape, b.shape), np.nan)
        return self.estimate.self_error(r, b) / self.gear.material.young_modulus

    def neighbour_with_error(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> tuple[Array, Array]:
        """`neighbour` and its estimated error [m^2/N], shape (P, Q) each."""
        self._check_reach(k)
        if self.estimate is None:
            value = self.neighbour(k, radius_p, radius_q)
            return value, np.full(value.shape, np.nan)
        value, error = self.estimate.neighbour(k, self._modules(radius_p), self._modules(radius_q))
        return value / self.gear.material.young_modulus, error / self.gear.material.young_modulus

    def root_stress_with_error(
        self, k: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None
    ) -> tuple[Array, Array, Array]:
        """`largest_root_stress`, where it sits [m], and its estimated error [1/m], shape (P,) each."""
        if self.estimate is None:
            value, arc = self.largest_root_stress(k, side, radius, half_width)
            return value, arc, np.full(value.shape, np.nan)
        m = self.gear.module
        value, arc, error = self.estimate.root_stress(k, side, self._modules(radius), self._half_width(half_width))
        return value / m, arc * m, error / m

    def root_stress_error(self, k: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None) -> Array:
        """Estimated error of `largest_root_stress` [1/m], shape (P,)."""
        return self.root_stress_with_error(k, side, radius, half_width)[2]

    def neighbour_error(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """Estimated error of `neighbour` [m^2/N], shape (P, Q)."""
        return self.neighbour_with_error(k, radius_p, radius_q)[1]

    def common_errors(self) -> tuple[float, float]:
        """What of `self_error` and `neighbour_error` all teeth have in common: rotation of the gear [m^2/N]."""
        own, beside = (0.0, 0.0) if self.estimate is None else self.estimate.common_errors
        return own / self.gear.material.young_modulus, beside / self.gear.material.young_modulus

    @functools.cached_property
    def tabulated(self) -> dict[str, Any]:
        """What has been tabulated of it, by name: for every load and relief the same, and kept as long as it is."""
        return {}

    def largest_errors(self) -> Mapping[str, float]:
        """Largest estimated relative error over the flank of each quantity (`Estimate.largest`)."""
        return dict.fromkeys(QUANTITIES, math.nan) if self.estimate is None else self.estimate.largest
