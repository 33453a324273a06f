"""Influence functions of a real gear in SI, with their own error estimate and the seconds that they took."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.influence import SIDES, Influence, Side

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.fem.plane.settings import MeshSettings
    from fegear.fem.plane.solution import Round
    from fegear.geometry.gear import Gear

#: Part of the difference from the coarser solution of the error estimate that is taken for the error of the finer one:
#: of c_0, of neighbours, of stresses, learned from random gears (docs/numerics.md). Smooth errors of order four
#: leave a third; but gmsh draws every mesh anew, positions differ, pressures narrow less than edges, and a neighbour's
#: deflection, a small error anyway, differs least regularly.
_SHARE, _NEIGHBOUR_SHARE, _STRESS_SHARE = 2.1, 2.4, 1.0
#: What is modelled nearer to an end of the flank than the mesh resolves is wrong by the first power of the edges'
#: length, of which neighbouring levels differ by two fifths.
_END_SHARE = 3.0
#: A difference between two solutions may vanish by chance at one position: the estimate is no smaller than so many
#: times what the difference usually is over the flank.
_USUAL = 1.5
#: Positions over the flank, evenly in roll angle, at which usual errors are looked for; for the largest, twice as many
#: and these distances from its ends [modules].
_SAMPLES = 17
_BESIDE_ENDS = (0.005, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1)


@dataclass(frozen=True)
class GearInfluence:
    """Compliance and root-stress influence of one gear, per unit face width, in SI.

    Parameters
    ----------
    gear : Gear
    fine : Influence
        The solution that every number comes from.
    coarse : Influence
        A cheaper (or, on a user's own mesh, a higher-order) one whose difference shows the error of `fine`.
    settings : MeshSettings
    coarse_patch : float
        Half-width of the wider pressure of `coarse` [modules].
    seconds : mapping of str to float
    rounds : tuple of Round
        What was solved on the way to a tolerance, the last of them kept; empty where settings were given.
    """

    gear: Gear
    fine: Influence
    coarse: Influence | None
    settings: MeshSettings
    coarse_patch: float
    seconds: Mapping[str, float]
    rounds: tuple[Round, ...] = ()

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
        """c_k(p, q): deflection at p of tooth k per unit line load at q of tooth 0, shape (P, Q) [m^2/N]."""
        a = self.settings.patch_half_width
        c = self.fine.neighbour(k, self._modules(radius_p), self._modules(radius_q), a)
        return c / self.gear.material.young_modulus

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

    def largest_root_stress(
        self, k: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Largest root tension or compression per unit line load [1/m] and its arc length from the root land [m].

        Half-widths [m] are 0.02 modules unless given.
        """
        m = self.gear.module
        value, arc = self.fine.largest_root_stress(k, side, self._modules(radius), self._half_width(half_width))
        return value / m, arc * m

    def self_error(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `self_compliance` [m^2/N]: what a coarser mesh with wider pressures changes."""
        r, b = self._modules(radius), np.asarray(half_width, dtype=float) / self.gear.module
        found = self._self_estimate(r, b, self._self_difference(r, b)[1])
        return self._known(found) / self.gear.material.young_modulus

    def contact_error(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `self_compliance` as the approach of a true contact [m^2/N].

        That of the mesh, and beside the tip by how much a contact gives way less than under Hertz's pressure
        (`Influence.tip_shift`).
        """
        r, b = self._modules(radius), np.asarray(half_width, dtype=float) / self.gear.module
        shift = self.fine.tip_shift(r, self.settings.patch_half_width, b)
        return self.self_error(radius, half_width) + shift / self.gear.material.young_modulus

    def _self_estimate(self, radius: Array, half_width: Array, difference: Array) -> Array:
        share = np.where(self._at_an_end(radius, half_width), _END_SHARE, _SHARE)
        return np.maximum(share * difference, _SHARE * _USUAL * _root_mean_square(self._self_at_samples[1]))

    def _self_difference(self, radius: Array, half_width: Array) -> tuple[Array, Array]:
        """Value, and its difference from the other solution's."""
        fine = self.fine.self_compliance(radius, self.settings.patch_half_width, half_width)
        return fine, np.abs(fine - self._other.self_compliance(radius, self.coarse_patch, half_width))

    @functools.cached_property
    def _self_at_samples(self) -> tuple[Array, Array]:
        return self._self_difference(self._samples, np.asarray(REFERENCE_HALF_WIDTH))

    def neighbour_error(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """Estimated error of `neighbour` [m^2/N], shape (P, Q)."""
        own = self._neighbour_difference(k, self._modules(radius_p), self._modules(radius_q))
        return self._known(self._neighbour_estimate(k, own)) / self.gear.material.young_modulus

    def _neighbour_estimate(self, k: int, difference: Array) -> Array:
        if k not in self._usual:
            self._usual[k] = _root_mean_square(self._neighbour_difference(k, self._samples, self._samples))
        return _NEIGHBOUR_SHARE * np.maximum(difference, _USUAL * self._usual[k])

    def _neighbour_difference(self, k: int, p: Array, q: Array) -> Array:
        fine = self.fine.neighbour(k, p, q, self.settings.patch_half_width)
        return np.abs(fine - self._other.neighbour(k, p, q, self.coarse_patch))

    def root_stress_error(self, k: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None) -> Array:
        """Estimated error of `largest_root_stress` [1/m], shape (P,)."""
        r, b = self._modules(radius), self._half_width(half_width)
        return (
            self._known(self._stress_estimate(k, side, r, b, *self._stress_difference(k, side, r, b)))
            / self.gear.module
        )

    def _stress_estimate(
        self, k: int, side: Side, radius: Array, half_width: Array, value: Array, difference: Array
    ) -> Array:
        # The back fillet has the loaded one's shape and no shorter edges: it errs no less, should
        # its difference vanish by chance.
        least = _USUAL * max(self._usual_stress(k, at) for at in (SIDES if side == "compression" else (side,)))
        # The loaded fillet feels a contact at its upper end; the back one is as far from it as from any.
        near = self._at_an_end(radius, half_width) & (k == 0 and side == "tension")
        share = np.where(near, _END_SHARE, _STRESS_SHARE)
        return np.maximum(share * difference, _STRESS_SHARE * least * np.abs(value))

    def _stress_difference(self, k: int, side: Side, r: Array, b: ArrayLike) -> tuple[Array, Array]:
        """Value, and its difference from the other solution's."""
        fine = self.fine.largest_root_stress(k, side, r, b)[0]
        return fine, np.abs(fine - self._other.largest_root_stress(k, side, r, b)[0])

    def _usual_stress(self, k: int, side: Side) -> float:
        """Of the value."""
        if (k, side) not in self._usual:
            value, difference = self._stress_at_samples(k, side)
            self._usual[k, side] = _root_mean_square(difference / value)
        return self._usual[k, side]

    def _stress_at_samples(self, k: int, side: Side) -> tuple[Array, Array]:
        if (k, side) not in self._sampled:
            self._sampled[k, side] = self._stress_difference(k, side, self._samples, REFERENCE_HALF_WIDTH)
        return self._sampled[k, side]

    @functools.cached_property
    def _sampled(self) -> dict[tuple[int, Side], tuple[Array, Array]]:
        return {}

    @functools.cached_property
    def _usual(self) -> dict[object, float]:
        """Root mean squares of differences over the flank: asked for with every table, found once."""
        return {}

    @functools.cached_property
    def tabulated(self) -> dict[str, Any]:
        """What has been tabulated of it, by name: for every load and relief the same, and kept as long as it is."""
        return {}

    def largest_errors(self) -> dict[str, float]:
        """Largest estimated relative error over the flank of each quantity.

        Returns
        -------
        dict of str to float
            c_self (of a contact 0.02 modules wide to either side), c_neighbour (over c_self), root_tension and
            root_compression.
        """
        between, b = self._between_samples, np.asarray(REFERENCE_HALF_WIDTH)
        r = np.concatenate([self._samples, between])
        own, difference = np.hstack([self._self_at_samples, self._self_difference(between, b)])
        errors = {"c_self": self._self_estimate(r, b, difference) / own}
        if self.reach:
            difference = np.diagonal(self._neighbour_difference(1, r, r))
            errors["c_neighbour"] = self._neighbour_estimate(1, difference) / own
        for side in SIDES:
            value, difference = np.hstack(
                [self._stress_at_samples(0, side), self._stress_difference(0, side, between, b)]
            )
            errors[f"root_{side}"] = self._stress_estimate(0, side, r, b, value, difference) / np.abs(value)
        return {key: float(np.max(self._known(values))) for key, values in errors.items()}

    def _known(self, estimate: Array) -> Array:
        """The estimate, if there is a second solution to derive it from."""
        return np.full(np.shape(estimate), np.nan) if self.coarse is None else estimate

    @property
    def _other(self) -> Influence:
        return self.fine if self.coarse is None else self.coarse

    def _at_an_end(self, radius: Array, half_width: Array) -> NDArray[np.bool_]:
        """Whether contacts [modules] are narrower than pressures that the mesh resolves, and have no room for these."""
        flank = self.fine.flank
        arc, resolved = flank.arc_of_radius(radius), 2.0 * max(self.fine.corner_distance, self._other.corner_distance)
        room = np.minimum(arc - flank.flank_start, flank.flank_end - arc)
        return np.asarray((room < resolved) & (half_width < resolved))

    @functools.cached_property
    def _samples(self) -> Array:
        """Radii over the flank, evenly in roll angle, at which usual errors are looked for [modules]."""
        low, high = self._flank_ends
        first, last = self.gear.tooth.roll(np.array([max(low, self.gear.tooth.base_radius), high])).tolist()
        return np.clip(self.gear.tooth.radius_of_roll(np.linspace(first, last, _SAMPLES)), low, high)

    @functools.cached_property
    def _between_samples(self) -> Array:
        """Radii at which largest errors are looked for, too: between the samples, and near the ends [modules]."""
        (low, high), rb = self._flank_ends, self.gear.tooth.base_radius
        between = np.sqrt(0.5 * (self._samples[1:] ** 2 + self._samples[:-1] ** 2))
        # On an involute the squared radius grows by twice the base radius times the arc length.
        near = 2.0 * rb * np.array(_BESIDE_ENDS)
        ends = np.sqrt(np.concatenate([low**2 + near, high**2 - near]))
        return np.concatenate([between, ends[(ends > low) & (ends < high)]])

    @property
    def _flank_ends(self) -> tuple[float, float]:
        flank, tooth = self.fine.flank, self.gear.tooth
        return max(flank.lowest_radius, tooth.form_radius), min(flank.highest_radius, tooth.involute_tip_radius)


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
