"""Influence functions of a real gear with odd teeth (cracked, shorter, missing) in SI, with their own error estimate.

All is per unit face width. Teeth have the numbers of the gear (`fegear.fem.alike_teeth`). Those around the odd ones are
known by number; farther away teeth are as on the ordinary gear, whose solution this one is made from, on the same mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import InputError
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.odd.odd_influence import OddInfluence
from fegear.fem.plane.root_stress import CutFillet
from fegear.fem.plane.settings import LEVEL_RATIO

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.root_stress import FilletCurve
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Gear


#: Teeth on either side of the outermost odd ones that answer otherwise than ordinary ones. A crack half of the way
#: through changes c_ii of the next ones by up to 5e-3, of the second by 1.2e-3, of the third by 5e-4 (the transmission
#: error by up to 3.5e-4): these count as ordinary.
TOUCHED = 2
#: Part of the difference from elements one order lower that is taken for the error of c_ij and of root stress: no less
#: than the true one where meshes of all levels were compared, with cracks of .1 to .7 of the way through; one of 200
#: random gears with a crack has 1.4 times that of root stress.
_COUPLING_SHARE, _STRESS_SHARE = 1.0, 1.7
#: Part of the estimated error of one mode of stress intensity that the other one has at least.
_OTHER_MODE = 0.5
#: A difference may vanish by chance at one position: the estimate is no smaller than so many times what it usually is.
_USUAL = 1.5
#: Positions over the flank at which usual differences are looked for.
_SAMPLES = 17


@dataclass(frozen=True)
class OddGearInfluence:
    """Compliance, root-stress and stress-intensity influence of a gear with odd teeth, per unit face width, in SI.

    Parameters
    ----------
    ordinary : GearInfluence
        The same gear, all its teeth alike.
    fine : OddInfluence
        The solution that every number comes from; its tooth 0 is tooth `middle` of the gear.
    middle : int
    seconds : mapping of str to float
    """

    ordinary: GearInfluence
    fine: OddInfluence
    middle: int = 0
    seconds: Mapping[str, float] = field(default_factory=dict, compare=False)

    @property
    def gear(self) -> Gear:
        """The gear, all its teeth alike."""
        return self.ordinary.gear

    @property
    def settings(self) -> MeshSettings:
        """Of its mesh."""
        return self.ordinary.settings

    def alone(self, near: int) -> GearInfluence:
        """A tooth under loads on itself, by its number from the middle one, as of a gear of such teeth."""
        return GearInfluence(self.gear, self.fine.tooth(near), None, self.settings, self.seconds)

    @property
    def known(self) -> range:
        """Teeth that are known by number, from the middle one."""
        return range(-self.fine.reach, self.fine.reach + 1)

    @property
    def touched(self) -> range:
        """Teeth from the middle one that answer otherwise than ordinary ones: odd, between odd ones or next to one.

        All that are known beside a keyway, which is felt farther than a crack.
        """
        if self.fine.patch is not None:
            return self.known
        odd, reach = self.fine.unlike, self.fine.reach
        return range(max(min(odd) - TOUCHED, -reach), min(max(odd) + TOUCHED, reach) + 1)

    def from_middle(self, tooth: int) -> int:
        """Number of a tooth from the middle one, within half a turn to either side."""
        z = self.gear.teeth
        return (tooth - self.middle + z // 2) % z - z // 2

    def _near(self, *teeth: int) -> list[int]:
        """Numbers from the middle tooth.

        Raises
        ------
        InputError
            If a tooth is not known by number.
        """
        found = [self.from_middle(tooth) for tooth in teeth]
        for tooth, near in zip(teeth, found, strict=True):
            if near not in self.known:
                first, last = (self.middle + self.known[at] for at in (0, -1))
                raise InputError("tooth", tooth, f"must be one of those near the odd teeth, {first} to {last}")
        return found

    def ends(self, near: int) -> tuple[float, float]:
        """Radii between which the flank of a tooth lies [m], by its number from the middle one."""
        flank = self.fine.kind(near).flank
        return flank.lowest_radius * self.gear.module, flank.highest_radius * self.gear.module

    def _on_flank(self, near: int, radius: ArrayLike) -> Array:
        """Radii [modules], the nearest ones on a shorter tooth's flank."""
        r = self._modules(radius)
        return np.minimum(r, self.fine.kind(near).flank.highest_radius) if near in self.fine.odd else r

    def _modules(self, radius: ArrayLike) -> Array:
        return np.atleast_1d(np.asarray(radius, dtype=float)) / self.gear.module

    @property
    def _modulus(self) -> float:
        return self.gear.material.young_modulus

    @property
    def _patch(self) -> float:
        return self.settings.patch_half_width

    def own(self, i: int, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_ii(p, p) of a contact with a given half-width [m], shape (P,) [m^2/N]."""
        (near,) = self._near(i)
        b = np.asarray(half_width, dtype=float) / self.gear.module
        return self.fine.own(near, self._modules(radius), self._patch, b) / self._modulus

    def own_error(self, i: int, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `own`, shape (P,) [m^2/N]; NaN without a solution of lower order."""
        (near,) = self._near(i)
        r, b = self._on_flank(near, radius), np.asarray(half_width, dtype=float) / self.gear.module
        if self.fine.lower is None:
            return np.full(np.broadcast_shapes(r.shape, b.shape), np.nan)
        return self._estimate(near).self_error(r, b) / self._modulus

    def by_closing(self, near: int, radius: ArrayLike) -> Array:
        """What the faces of cracks change of c_ii(p, p) by pressing on each other, shape (P,) [m^2/N].

        By the tooth's number from the middle one.
        """
        return self.fine.by_closing(near, self._on_flank(near, radius), self._patch) / self._modulus

    @cached_property
    def faces_compliance(self) -> Array:
        """Opening of the faces of all cracks that may close per pair of line forces on them, shape (N, N) [m^2/N]."""
        return np.asarray(self.fine.faces_compliance / self._modulus)

    def openings(self, near: int, radius: ArrayLike) -> Array:
        """Opening of these faces, free, per unit line load on a tooth, by its number from the middle one, (N, P)."""
        loads = self.fine.tooth(near).remote(self._on_flank(near, radius), self._patch)
        return np.asarray(self.fine.openings(near, loads) / self._modulus)

    def stress_by_faces(self, i: int, side: Side) -> Array:
        """Stress along a fillet of tooth i per pair of line forces on these faces, shape (points, N) [1/m]."""
        (near,) = self._near(i)
        return np.asarray(self.fine.stress_by_faces(near, side) / self.gear.module)

    def faces_under(self, i: int, loads: Mapping[int, tuple[Array, Array]]) -> Array:
        """Share of the nodes of the crack of tooth i that press on each other under loads on several teeth, (P,).

        Parameters
        ----------
        i : int
        loads : mapping of int to (ndarray, ndarray), shape (P,) each
            Radii [m] and line loads [N/m], by tooth.
        """
        near, here = self._by_number(i, loads)
        forces = self.fine.faces_under(here, self._patch)[self.fine.faces_at[near]]
        return np.asarray((forces > 0.0).mean(axis=0))

    def _by_number(
        self, i: int, loads: Mapping[int, tuple[Array, Array]]
    ) -> tuple[int, dict[int, tuple[Array, Array]]]:
        """A tooth, and loads with their radii in modules, by their numbers from the middle tooth."""
        near, *others = self._near(i, *loads)
        each = zip(others, loads.values(), strict=True)
        return near, {other: (self._modules(radius), load) for other, (radius, load) in each}

    def closed_intensity(self, i: int, loads: Mapping[int, tuple[Array, Array]]) -> tuple[Array, Array]:
        """What the faces of cracks add to K_I and K_II of that of tooth i by pressing on each other, and the error.

        Of a crack that may close, under loads on several teeth at once, as of `faces_under`; shape (2, P) each, beside
        the sums of `stress_intensity`, which has open faces [Pa sqrt(m)].
        """
        (near, here), root = self._by_number(i, loads), np.sqrt(self.gear.module)
        value, other = self.fine.closed_intensity(near, self.fine.faces_under(here, self._patch))
        error, lower = np.abs(value - other), self.fine.lower
        if lower is None:
            return value / root, np.full(value.shape, np.nan)
        below = lower.closed_intensity(near, lower.faces_under(here, self._patch))[0]
        return value / root, (error + np.abs(value - below)) / root

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike, *, free: bool = False) -> Array:
        """c_ij(p, q): deflection at p of tooth i per unit line load at q of tooth j, shape (P, Q) [m^2/N].

        With the faces of cracks that may close as of `OddInfluence.between`.
        """
        p, q = self._modules(radius_p), self._modules(radius_q)
        near, other = self._near(i, j)
        return self.fine.between(near, other, p, q, self._patch, free=free) / self._modulus

    def between_error(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """Estimated error of `between`, shape (P, Q) [m^2/N]."""
        near, other = self._near(i, j)
        p, q = self._on_flank(near, radius_p), self._on_flank(other, radius_q)
        if self.fine.lower is None:
            return np.full((p.size, q.size), np.nan)
        usual = self._usual_between(near, other)
        error = np.maximum(self._off_between(near, other, p, q), _USUAL * usual) / self._modulus
        k = near - other
        if 0 < abs(k) <= self.ordinary.reach:
            # What both orders share, edges that leave the fillets' curves, ordinary teeth know of.
            there, here = self._ordinary(radius_p), self._ordinary(radius_q)
            error = np.maximum(error, self.ordinary.neighbour_error(k, there, here))
        return error

    def _off_between(self, i: int, j: int, p: Array, q: Array) -> Array:
        """What half the width of the pressures, and elements one order lower, change of c_ij."""
        assert self.fine.lower is not None  # noqa: S101  (for mypy: errors are asked for where two orders were solved)
        value = self.fine.between(i, j, p, q, self._patch)
        width = np.abs(value - self.fine.between(i, j, p, q, 0.5 * self._patch))
        return np.asarray(width + _COUPLING_SHARE * np.abs(value - self.fine.lower.between(i, j, p, q, self._patch)))

    def _usual_between(self, i: int, j: int) -> float:
        key = "c", i, j
        if key not in self._kept:
            off = self._off_between(i, j, self._samples(i), self._samples(j))
            self._kept[key] = float(np.sqrt(np.mean(off**2)))
        return self._kept[key]

    def fillet_stress(
        self, i: int, j: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None, *, free: bool = False
    ) -> Array:
        """Tangential stress along a fillet of tooth i per unit line load on tooth j, shape (points, P) [1/m].

        With the faces of cracks that may close as of `OddInfluence.fillet_stress`.
        """
        near, other = self._near(i, j)
        r, b = self._modules(radius), self._half_width(half_width)
        found = self.fine.fillet_stress(near, other, side, r, b, free=free)
        return found / self.gear.module

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet:
        """How the largest stress of a fillet of tooth i is found between its points."""
        (near,) = self._near(i)
        pieces = tuple(
            (start, replace(curve, module=self.gear.module), points)
            for start, curve, points in self.fine.kind(near).pieces(side)
        )
        return pieces[0][1] if len(pieces) == 1 else CutFillet(pieces)

    def largest_root_stress(
        self, i: int, j: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Largest root stress of tooth i per unit line load on tooth j [1/m], and its arc length [m], shape (P,)."""
        near, other = self._near(i, j)
        r, b, m = self._modules(radius), self._half_width(half_width), self.gear.module
        value, arc = self.fine.largest_root_stress(near, other, side, r, b)
        return value / m, arc * m

    def root_stress_error(
        self, i: int, j: int, side: Side, radius: ArrayLike, half_width: ArrayLike | None = None
    ) -> Array:
        """Estimated error of `largest_root_stress`, shape (P,) [1/m]."""
        near, other = self._near(i, j)
        r, b = self._on_flank(other, radius), self._half_width(half_width)
        if self.fine.lower is None:
            return np.full(r.shape, np.nan)
        key = side, near, other
        if key not in self._kept:
            off = self._off_stress(near, other, side, self._samples(other), np.asarray(REFERENCE_HALF_WIDTH))
            self._kept[key] = float(np.sqrt(np.mean(off**2)))
        error = _STRESS_SHARE * np.maximum(self._off_stress(near, other, side, r, b), _USUAL * self._kept[key])
        error, k = np.asarray(error / self.gear.module), near - other
        if abs(k) <= self.ordinary.reach:
            # Both orders have one fillet of the same edges: no less than on an ordinary tooth.
            width = None if half_width is None else np.asarray(half_width, dtype=float)
            error = np.maximum(error, self.ordinary.root_stress_error(k, side, self._ordinary(radius), width))
        if k or near in self.fine.odd:
            # The largest tension of a fillet that a load compresses nearly vanishes; its error is that of the fillet.
            size = np.abs(self.fine.fillet_stress(near, other, side, r, b)).max(axis=0) / self.gear.module
            error = np.maximum(error, self.ordinary.largest_errors()[f"root_{side}"] * size)
        return error

    def _ordinary(self, radius: ArrayLike) -> Array:
        """Radii on an ordinary flank, the nearest ones [m]."""
        return np.clip(
            np.atleast_1d(np.asarray(radius, dtype=float)), self.ordinary.lowest_radius, self.ordinary.highest_radius
        )

    def _off_stress(self, i: int, j: int, side: Side, r: Array, b: Array) -> Array:
        assert self.fine.lower is not None  # noqa: S101  (for mypy: errors are asked for where two orders were solved)
        value, other = (one.largest_root_stress(i, j, side, r, b)[0] for one in (self.fine, self.fine.lower))
        return np.asarray(np.abs(value - other))

    def stress_intensity(self, i: int, j: int, radius: ArrayLike) -> tuple[Array, Array]:
        """K_I and K_II of the crack of tooth i per unit line load on tooth j, and their error, (2, P) each [1/sqrt m].

        Raises
        ------
        InputError
            If the tooth has no crack.
        """
        near, other = self._near(i, j)
        r, root = self._modules(radius), np.sqrt(self.gear.module)
        value, error = self._intensity(near, other, r)
        if self.fine.lower is not None:
            at_samples = self._intensity_at_samples(near, other)
            own, of_own = self._intensity_at_samples(near, near)
            usual = np.sqrt(np.mean(at_samples[1] ** 2, axis=1, keepdims=True))
            # Loads on other teeth bend the crack less; relatively they err no less than those on its own.
            share = float(np.sqrt(np.sum(of_own**2) / np.sum(own**2)))
            error = np.maximum(error, np.maximum(_USUAL * usual, share * np.hypot(*value)))
        return value / root, error / root

    def _intensity(self, i: int, j: int, r: Array) -> tuple[Array, Array]:
        """K_I and K_II under loads at radii [modules], and what orders, rings and pressures leave of them."""
        value, error = self.fine.stress_intensity(i, j, r, self._patch)
        if self.fine.lower is not None:
            # Loads next to a mouth act by how wide they are pressed; one mode may be right by chance.
            error = error + np.abs(value - self.fine.by_ring(i, j, r, 0.5 * self._patch)[0])
            error = np.maximum(error, _OTHER_MODE * error[::-1])
        return value, error

    def _intensity_at_samples(self, i: int, j: int) -> tuple[Array, Array]:
        if (i, j) not in self._intensities:
            self._intensities[i, j] = self._intensity(i, j, self._samples(j))
        return self._intensities[i, j]

    @cached_property
    def _intensities(self) -> dict[tuple[int, int], tuple[Array, Array]]:
        return {}

    def _half_width(self, half_width: ArrayLike | None) -> Array:
        if half_width is None:
            return np.asarray(REFERENCE_HALF_WIDTH)
        return np.asarray(half_width, dtype=float) / self.gear.module

    def _estimate(self, i: int) -> Estimate:
        """Of a tooth under its own load."""
        if i not in self._estimates:
            assert self.fine.lower is not None  # noqa: S101  (for mypy: errors are asked for where two orders were solved)
            coarser = self.settings.refined(LEVEL_RATIO)
            other = replace(self.fine.lower.shut_tooth(i), corner_distance=coarser.corner_distance)
            self._estimates[i] = Estimate(self.fine.shut_tooth(i), other, self._patch, coarser.patch_half_width)
        return self._estimates[i]

    @cached_property
    def _estimates(self) -> dict[int, Estimate]:
        return {}

    @cached_property
    def _kept(self) -> dict[tuple[str, int, int], float]:
        return {}

    def _samples(self, near: int) -> Array:
        """Radii over the flank of a tooth, evenly in roll angle [modules]."""
        tooth, flank = self.fine.kind(near).tooth, self.fine.kind(near).flank
        least, most = tooth.involute_radii
        low, high = max(flank.lowest_radius, least), min(flank.highest_radius, most)
        first, last = tooth.roll(np.array([max(low, tooth.base_radius), high])).tolist()
        return np.clip(tooth.radius_of_roll(np.linspace(first, last, _SAMPLES)), low, high)

    @cached_property
    def tabulated(self) -> dict[str, Any]:
        """What has been tabulated of it, by name, as of `GearInfluence`."""
        return {}
