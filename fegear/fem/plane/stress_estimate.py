"""Error of the root stress of a tooth and of its neighbours, from two orders of elements; dimensionless."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.flank_samples import SAMPLES, USUAL, root_mean_square
from fegear.fem.plane.influence import SIDES, Influence, Side
from fegear.fem.plane.own_stress_error import own_stress_error
from fegear.fem.plane.stress_apart import apart_beside_contacts, apart_beside_ends

#: Root stress of fourth order errs the less beside that of third, the shorter the edges: the part is this power of this
#: number over the number of edges that the fillet would have if all were as long as along most of it (those that are
#: graded toward its ends say nothing about where stress is largest), no more than all of it, and no less than the
#: other, for both orders have the edges' own curves. Elements of lower orders were not looked at, and count twice.
_STRESS_EDGES, _STRESS_POWER, _LEAST_STRESS_SHARE, _LOWER_ORDERS = 3.7, 1.2, 0.16, 2.0
#: What both orders have, edges that are few and their own curves, shows as scatter of stress about the smooth curve
#: along a fillet. Of what is usual beside the largest stress so much counts, of that at one contact on the tooth itself
#: so much, and on the next tooth so much. It counts on long fillets of long edges, and below contacts beside a fillet.
_SCATTERED, _SCATTERED_HERE, _SCATTERED_NEXT = 0.65, 0.85, 1.2
#: Of scatter below a loaded tooth's own contact, and of the usual one, less is error than counts where a tolerance is
#: judged; of what its stress usually differs by over the flank so many times is at least (`own_stress_error`).
_OWN_SCATTERED, _OWN_SCATTERED_HERE, _OWN_USUAL = 0.5, 0.65, 1.4
#: Compression, which is largest nearer to the root land where edges are graded, has so much more of the part.
_COMPRESSED = 1.15
#: The compressed fillet of the next tooth lies beside the loaded flank, and its error is that of the edges' own curves,
#: which both orders have: so many times the part of a tooth's own and no less than the other part, and so many times
#: the usual scatter.
_NEIGHBOUR_STRESS, _LEAST_NEIGHBOUR_STRESS, _NEIGHBOUR_SCATTER = 1.15, 0.75, 1.5
#: A neighbour's other fillets are smooth: so many times a tooth's own part. Where edges are long the order tells more
#: than the error is: of elements of fourth order no more than so much counts on the tooth ahead of the loaded one, and
#: on that behind it (64 gears and rings, docs/numerics.md).
_SMOOTH_STRESS: dict[Side, float] = {"tension": 1.4, "compression": 1.8}
_MOST_SMOOTH: dict[Side, tuple[float, float]] = {"tension": (0.55, 0.3), "compression": (0.7, 0.7)}
#: On the tension side of the tooth behind, edges that are ever shorter leave a greater part of ever smaller
#: differences, of what both orders have in common: from this part at the first of these shares of a tooth's own to the
#: usual one at the second.
_SHORT, _OF_SHORT_BEHIND = (0.16, 0.28), 0.9
#: Relatively no neighbour errs by less than so much of what a tooth's own stress usually differs by: on the tooth ahead
#: and on that behind, and the same where edges are short; behind it on the tension side less where they are long,
#: between these shares. What short edges leave of its own stress is of the contact and of their curves, which smooth
#: fillets do not feel (64 gears and rings, docs/numerics.md); of scatter less counts on the tension side ahead there.
_OF_OWN_STRESS: dict[Side, tuple[float, float]] = {"tension": (0.6, 0.35), "compression": (0.9, 0.9)}
_OF_OWN_SHORT: dict[Side, tuple[float, float]] = {"tension": (0.1, 0.1), "compression": (0.9, 0.3)}
_OF_OWN_LONG_BEHIND, _LONG_BEHIND = 0.2, (0.36, 0.55)
_SCATTERED_SHORT_AHEAD = 0.5
#: What differences usually are on a neighbour's fillet are no less than this part of those on its other fillet.
_OTHER_FILLET = 0.1
#: Relative errors of root stress are of no less than this share of its largest over the flank: on a rim that bends as a
#: whole the tension of a tooth may pass through zero.
_LEAST_STRESS = 0.1


class _Stress(NamedTuple):
    """Largest stress of a fillet, where it sits, its difference from the other solution's, and its scatter, (P,).

    Beside narrowed contacts, how far both solutions' curves are apart about that place; elsewhere 0.
    """

    value: Array
    place: Array
    difference: Array
    scatter: Array
    beside: Array


@dataclass(frozen=True)
class StressEstimate:
    """Root stress of a solution with its error, from what another one of the same shape gives; module 1, E = 1.

    Parameters
    ----------
    fine, coarse : Influence
        The solution that every number comes from, and that of elements one order lower on the same mesh.
    samples : ndarray
        Radii at which usual errors are looked for (`flank_samples`).
    """

    fine: Influence
    coarse: Influence
    samples: Array

    def root_stress(self, k: int, side: Side, radius: Array, half_width: Array) -> tuple[Array, Array, Array]:
        """Largest root stress, where it sits, and its error, shape (P,) each."""
        self._stress_at_samples(k)  # first: at the same positions side after side is asked for
        value, place, difference, scatter, beside = self._stress_of(k, side, radius, half_width)
        off = np.maximum(difference, beside)
        up = self._up(radius) if k == 0 else 0.0
        return value, place, self._stress_estimate(k, side, value, off, 0.0 if k < 0 else scatter, up)

    def place_error(self, value: Array, other: Array) -> Array:
        """Error of the stress at places of a fillet under loads at several positions, shape (places, P).

        Parameters
        ----------
        value, other : ndarray, shape (places, P)
            Of both solutions; where they agree by chance, what they differ by over all positions counts.
        """
        off = np.abs(value - other)
        usual = np.sqrt(np.mean(off**2, axis=1, keepdims=True))
        return np.asarray(self._stress_share * np.maximum(off, USUAL * usual))

    def _stress_of(self, k: int, side: Side, radius: Array, half_width: Array) -> _Stress:
        """The loaded tooth by itself; neighbours all at once, for whoever asks for one asks for the others."""
        if k == 0:
            return self._stresses_of((0,), side, radius, half_width)[0]
        key = side, radius.tobytes(), np.asarray(half_width).tobytes()
        if key not in self._neighbours_asked:
            self._neighbours_asked.clear()
            self._neighbours_asked[key] = self._stresses_of(self._beside, side, radius, half_width)
        return self._neighbours_asked[key][k]

    def _stresses_of(self, teeth: Sequence[int], side: Side, radius: Array, half_width: Array) -> dict[int, _Stress]:
        both = self.fine, self.coarse
        fine, coarse = (one.stress_below(teeth, side, radius, half_width) for one in both)
        curve = self.fine.fillet_curve(side)
        value, place = curve.largest_below(*fine)
        difference = np.abs(value - self.coarse.fillet_curve(side).largest_below(*coarse)[0])
        beside = np.zeros_like(place)
        if 0 in teeth:
            beside = apart_beside_contacts(both, (fine[0], coarse[0]), place, *fine[1:], half_width)
        else:
            difference = np.maximum(difference, apart_beside_ends(both, side, (fine[0], coarse[0]), place))
        found = _Stress(value, place, difference, curve.scatter_below(fine[0], place, *fine[1:]), beside)
        each = (one.reshape(len(teeth), -1) for one in found)
        return {k: _Stress(*one) for k, one in zip(teeth, zip(*each, strict=True), strict=True)}

    def _stress_at_samples(self, k: int) -> dict[Side, tuple[Array, Array]]:
        """Value of each side, and its difference from the other solution's."""
        if k not in self._stresses:
            r, b, teeth = self.samples, np.asarray(REFERENCE_HALF_WIDTH), self._beside if k else (0,)
            sides = {side: self._stresses_of(teeth, side, r, b) for side in SIDES}
            self._scatter.update({(tooth, side): of[tooth].scatter for side, of in sides.items() for tooth in teeth})
            for tooth in teeth:
                self._stresses[tooth] = {side: (of[tooth].value, of[tooth].difference) for side, of in sides.items()}
        return self._stresses[k]

    @property
    def _beside(self) -> tuple[int, ...]:
        """The neighbours of the loaded tooth that are known."""
        return tuple(k for k, side in self.fine.stress if k and side == "tension")

    def _stress_estimate(
        self,
        k: int,
        side: Side,
        value: Array,
        difference: Array,
        scatter: Array | float = 0.0,
        up: Array | float = 0.0,
    ) -> Array:
        share = self._stress_share
        if k:
            # Stress of a neighbour passes through zero along the flank and on one of its fillets nearly vanishes; its
            # error does neither.
            usual = {one: root_mean_square(off[:SAMPLES]) for one, (_, off) in self._stress_at_samples(k).items()}
            beside = max(usual[side], _OTHER_FILLET * max(usual.values()))
            scattered = _SCATTERED * root_mean_square(self._scatter[k, side][:SAMPLES])
            if k > 0 and side == "compression":
                share, beside = max(_NEIGHBOUR_STRESS * share, _LEAST_NEIGHBOUR_STRESS), USUAL * beside
                scattered *= _NEIGHBOUR_SCATTER
            else:
                share *= _SMOOTH_STRESS[side]
                share = min(share, _MOST_SMOOTH[side][k < 0]) if self.fine.flank.order == 4 else share
            part, of_scatter = _OF_OWN_STRESS[side][k < 0], np.maximum(scattered, _SCATTERED_NEXT * scatter)
            if self.fine.flank.order == 4:
                places, own = [*_SHORT], [_OF_OWN_SHORT[side][k < 0], part]
                if k < 0 and side == "tension":
                    share = np.interp(self._stress_share, _SHORT, (_OF_SHORT_BEHIND, _MOST_SMOOTH[side][k < 0]))
                    places, own = [*places, *_LONG_BEHIND], [*own, part, _OF_OWN_LONG_BEHIND]
                part = np.interp(self._stress_share, places, own)
                if k > 0 and side == "tension":
                    of_scatter *= np.interp(self._stress_share, _SHORT, (_SCATTERED_SHORT_AHEAD, 1.0))
            error = np.maximum(share * np.maximum(difference, beside), of_scatter)
            least = USUAL * max(self._usual_stress.values())
            return np.asarray(np.maximum(error, part * least * np.abs(value)))
        least = _OWN_USUAL * self._usual_stress[side]
        of_order, size = self._of_stress_order(side, value, difference, least)
        of_scatter = np.maximum(_OWN_SCATTERED_HERE * scatter, _OWN_SCATTERED * self._usual_scatter(side) * size)
        if self.fine.flank.order < 4:
            return np.asarray(np.hypot(of_order, of_scatter))
        return own_stress_error(side, share, of_order, of_scatter, up)

    def judged(self, side: Side) -> Array:
        """All that the loaded tooth's own stress may err by at the samples, relatively: if a tolerance is met by this.

        Both fillets have one shape and edges as long: one errs by no less than the other usually does.
        """
        value, difference = self._stress_at_samples(0)[side]
        of_order, size = self._of_stress_order(side, value, difference, USUAL * max(self._usual_stress.values()))
        scattered = np.maximum(_SCATTERED_HERE * self._scatter[0, side], _SCATTERED * self._usual_scatter(side) * size)
        return np.asarray(np.maximum(of_order, scattered) / _stress_scale(value))

    def _of_stress_order(self, side: Side, value: Array, difference: Array, least: float) -> tuple[Array, Array]:
        """What the order changes of the loaded tooth's own stress, relatively no less than so much, and of what."""
        size = np.maximum(np.abs(value), _LEAST_STRESS * np.abs(self._stress_at_samples(0)[side][0]).max())
        share = self._stress_share * (_COMPRESSED if side == "compression" else 1.0)
        return share * np.maximum(difference, least * size), size

    def _usual_scatter(self, side: Side) -> float:
        """What scatters of the loaded tooth's own stress over the flank, relatively."""
        scale = _stress_scale(self._stress_at_samples(0)[side][0])
        return root_mean_square((self._scatter[0, side] / scale)[:SAMPLES])

    def _up(self, radius: Array) -> Array:
        """How far contacts are from the start of the flank to its end, shape (P,)."""
        samples = self.samples[:SAMPLES]
        first, last = (samples[-1], samples[0]) if self.fine.tooth.internal else (samples[0], samples[-1])
        return np.clip((np.asarray(radius) - first) / (last - first), 0.0, 1.0)

    @property
    def _usual_stress(self) -> dict[Side, float]:
        """What each fillet of the loaded tooth usually differs by over the flank, relatively."""
        stresses = self._stress_at_samples(0)
        return {
            side: root_mean_square((off / _stress_scale(largest))[:SAMPLES])
            for side, (largest, off) in stresses.items()
        }

    @cached_property
    def _stress_share(self) -> float:
        edges = np.diff(self.fine.fillets["tension"].arc[:: self.fine.flank.order])
        alike = edges.sum() ** 2 / (edges**2).sum()
        share = max(float(_STRESS_EDGES / alike) ** _STRESS_POWER, _LEAST_STRESS_SHARE)
        return min(share if self.fine.flank.order == 4 else _LOWER_ORDERS * share, 1.0)

    @cached_property
    def _stresses(self) -> dict[int, dict[Side, tuple[Array, Array]]]:
        return {}

    @cached_property
    def _neighbours_asked(self) -> dict[tuple[Side, bytes, bytes], dict[int, _Stress]]:
        return {}

    @cached_property
    def _scatter(self) -> dict[tuple[int, Side], Array]:
        return {}


def _stress_scale(value: Array) -> Array:
    """What relative errors of root stress over the flank are of."""
    size = np.abs(value)
    return np.maximum(size, _LEAST_STRESS * size.max())
