"""How far two solutions of one tooth shape are apart, and what error of the finer one follows; dimensionless."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.plain import read_only
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.edge_curves import beyond_the_fillet, moved_by_edges
from fegear.fem.plane.influence import MOSTLY_TURNED, ROOM_SHARE, SIDES, Influence, Side
from fegear.fem.plane.own_stress_error import own_stress_error
from fegear.fem.plane.stress_apart import apart_beside_contacts, apart_beside_ends

#: What errors are estimated of.
QUANTITIES = ("c_self", "c_neighbour", "root_tension", "root_compression")
#: Part of the difference from elements one order lower, on the same mesh with wider pressures, that is taken for the
#: error of c_0, for elements of each order; learned from random gears and rings (docs/numerics.md).
_SHARE = {2: 0.1, 3: 0.25, 4: 1.3}
#: The fewer edges a pressure covers, the farther the lower order lags behind the higher one: of fourth order the part
#: falls with this power of the number of edges below the wider half-width where that is smaller than this number.
_RESOLVED, _RESOLVED_POWER = 3.3, 0.9
#: Where the room beside a flank's end leaves both solutions the same pressures, what the corner does to these shows in
#: no difference: so many times the error elsewhere (24 rings at a tolerance of 1e-4 need 1.8, at 0.001 0.7).
_NARROWED = 1.3
#: Neighbours err by the width of the pressures, which both orders share: this times what pressures half as wide change,
#: those that are narrowed beside the flank's ends, too (it goes with the sixth power, so hardly more than the change is
#: error; where edges are as long as the pressures it is scatter); and by a part of what elements one order lower do:
#: for a half-width of so much, growing with this power of wider ones, which go with the root of the edges' length, and
#: falling with this one of narrower ones. Of 24 gears and 24 rings a tenth at most was error at tolerances of 0.01 and
#: 0.001, in the median a twentieth; where edges are few, and of lower orders, which were not looked at, more counts.
_WIDTH_SHARE, _NEIGHBOUR_SHARE = {2: 1.5, 3: 1.5, 4: 1.3}, {2: 0.5, 3: 0.5, 4: 0.1}
_NEIGHBOUR_WIDTH, _WIDER_POWER, _NARROWER_POWER, _NEIGHBOUR_OF_FEW_EDGES = 0.25, 1.0, 2.5, 0.25
#: On external gears the difference between the orders at the start of the flank, where teeth shift, and what it changes
#: by from there, where their feet bend, have opposite signs, and the sum may vanish where neither error does: of fourth
#: order each counts by its size (46 gears, docs/numerics.md). On rings, whose sum errs by less than is stated, neither.
#: On a ring whose outer circle is held most of what the order changes is how the rim gives way, smoothly: the thinner
#: the rim, the more of that there is and the less of it is error. Up to so many modules of rim the share goes with them
#: (68 rings with 1.7 to 8 modules, docs/numerics.md).
_THICK_RIM = 6.5
#: Of what all teeth have in common, as a gear turns as a whole, that part is, and grows so.
_COMMON_SHARE, _COMMON_POWER = {2: 0.5, 3: 0.5, 4: 0.15}, 2.5
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
#: A gear on a small bore turns as a whole by far more than its teeth give way, and of all teeth two solutions differ by
#: the same: by the mean over the flanks of both neighbours less so many times its scatter. That is no load's error. It
#: is looked at where that is most of what gives way.
_SCATTERS = 3.0
#: A difference between two solutions may vanish by chance at one position: the estimate is no smaller than so many
#: times what the difference usually is over the flank.
_USUAL = 1.5
#: Of neighbours, of which no position errs by less than they usually differ by, times this.
_USUAL_NEIGHBOUR = 1.0
#: Where the wider half-width covers fewer edges than these, longer ones than those of a tolerance of 0.01.
_FEWEST_KNOWN = 1.25
#: By how much the gear turns on its bore both orders may agree by chance: so much of the smallest deflection of its
#: neighbours is error at least.
_OF_TURNING = 1e-7
#: Relative errors of root stress are of no less than this share of its largest over the flank: on a rim that bends as a
#: whole the tension of a tooth may pass through zero.
_LEAST_STRESS = 0.1
#: Positions over the flank, evenly in roll angle, at which usual errors are looked for; for the largest, twice as many
#: and these distances from its ends [modules].
_SAMPLES = 17
_BESIDE_ENDS = (0.005, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1)


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
class Estimate:
    """Values of a solution with their errors, from what another one of the same shape gives; module 1, E = 1.

    Parameters
    ----------
    fine : Influence
        The solution that every number comes from.
    coarse : Influence
        On the same mesh, of elements one order lower.
    patch, coarse_patch : float
        Half-width of the wider pressure that loads each of them [modules].

    Notes
    -----
    What is usual over the flank is looked for once, at all positions together: a tolerance and a table both need it.
    """

    fine: Influence
    coarse: Influence
    patch: float
    coarse_patch: float

    def contact(self, radius: Array, half_width: Array) -> tuple[Array, Array, Array]:
        """c_0, its error, and how much less a true contact gives way (`Influence.contact`), shape (P,) each."""
        value, shift = self.fine.contact(radius, self.patch, half_width)
        difference = self._self_difference(value, radius, half_width)
        return value, self._self_estimate(difference, radius, self._narrowed(radius)), shift

    def self_error(self, radius: Array, half_width: Array) -> Array:
        """Error of c_0, shape (P,)."""
        value = self.fine.self_compliance(radius, self.patch, half_width)
        difference = self._self_difference(value, radius, half_width)
        return self._self_estimate(difference, radius, self._narrowed(radius))

    def _narrowed(self, radius: Array) -> Array:
        """How much more c_0 errs beside the ends of the flank, shape (P,)."""
        flank = self.fine.flank
        arc = flank.arc_of_radius(radius)
        room = np.minimum(arc - flank.flank_start, flank.flank_end - arc)
        return np.where((ROOM_SHARE * room < self.patch) & (flank.order == 4), _NARROWED, 1.0)

    def neighbour(self, k: int, p: Array, q: Array) -> tuple[Array, Array]:
        """c_k(p, q) and its error, shape (P, Q) each."""
        self._neighbour_at_samples(k)  # first: at the same positions tooth after tooth is asked for
        value, difference = self._neighbour_difference(k, p, q)
        return value, self._neighbour_estimate(k, difference)

    def root_stress(self, k: int, side: Side, radius: Array, half_width: Array) -> tuple[Array, Array, Array]:
        """Largest root stress, where it sits, and its error, shape (P,) each."""
        self._stress_at_samples(k)  # first: at the same positions side after side is asked for
        value, place, difference, scatter, beside = self._stress_of(k, side, radius, half_width)
        off = np.maximum(difference, beside)
        up = self._up(radius) if k == 0 else 0.0
        return value, place, self._stress_estimate(k, side, value, off, 0.0 if k < 0 else scatter, up)

    @cached_property
    def largest(self) -> Mapping[str, float]:
        """Largest relative error over the flank of c_self, c_neighbour (over c_self), root_tension, root_compression.

        Of contacts .02 modules wide to either side.
        """
        own, difference = self._self_at_samples
        errors = {"c_self": self._self_estimate(difference, self._samples) / own}
        if self.fine.reach:
            difference = np.diagonal(self._neighbour_at_samples(1))
            errors["c_neighbour"] = self._neighbour_estimate(1, difference) / own
        for side in SIDES:
            value, difference = self._stress_at_samples(0)[side]
            errors[f"root_{side}"] = self._judged_stress(side, value, difference) / _stress_scale(value)
        return read_only({key: float(np.max(values)) for key, values in errors.items()})

    @cached_property
    def common_errors(self) -> tuple[float, float]:
        """What of the errors of c_0, and of neighbours, all teeth have in common: the gear turns as a whole."""
        share = self._for_width(_COMMON_SHARE[self.fine.flank.order], _COMMON_POWER)
        return self._self_share * abs(self._turned), share * abs(self._turned)

    @cached_property
    def _turned(self) -> float:
        """By how much all teeth of the other solution give way less; nothing where that is no more than scatter."""
        if not self.fine.reach:
            return 0.0
        r = self._samples[:_SAMPLES]
        beside = np.stack([self.fine.neighbour(k, r, r, self.patch) for k in (1, -1)])
        own = self.fine.self_compliance(r, self.patch, np.asarray(REFERENCE_HALF_WIDTH))
        if beside.mean() < MOSTLY_TURNED * own.mean():
            return 0.0
        off = beside - np.stack([self.coarse.neighbour(k, r, r, self.patch) for k in (1, -1)])
        mean = float(off.mean())
        return float(np.copysign(max(abs(mean) - _SCATTERS * float(off.std()), 0.0), mean))

    def _self_difference(self, value: Array, radius: Array, half_width: Array) -> Array:
        coarse = self.coarse.self_compliance(radius, self.coarse_patch, half_width)
        return np.abs(value - coarse - self._turned)

    @cached_property
    def _self_at_samples(self) -> tuple[Array, Array]:
        """Value, and its difference from the other solution's."""
        r, b = self._samples, np.asarray(REFERENCE_HALF_WIDTH)
        value = self.fine.self_compliance(r, self.patch, b)
        return value, self._self_difference(value, r, b)

    def _self_estimate(self, difference: Array, radius: Array, times: Array | float = 1.0) -> Array:
        """Of differences at some places, so many times what it is elsewhere."""
        samples, known = self._samples, self._self_at_samples[1]
        usual = _USUAL * _root_mean_square(known[:_SAMPLES])
        # A difference that changes its sign along the flank vanishes on its way from one place to the next. At the ends
        # it is that of corners.
        order = np.argsort(samples[: 2 * _SAMPLES - 1])[1:-1]
        padded = np.pad(known[order], 1, mode="edge")
        beside = np.maximum(np.maximum(padded[:-2], padded[2:]), padded[1:-1])
        floor = np.maximum(usual, np.interp(radius, samples[order], beside, left=0.0, right=0.0))
        return np.asarray(times * self._self_share * np.maximum(difference, floor) + self.common_errors[0])

    def place_error(self, value: Array, other: Array) -> Array:
        """Error of the stress at places of a fillet under loads at several positions, shape (places, P).

        Parameters
        ----------
        value, other : ndarray, shape (places, P)
            Of both solutions; where they agree by chance, what they differ by over all positions counts.
        """
        off = np.abs(value - other)
        usual = np.sqrt(np.mean(off**2, axis=1, keepdims=True))
        return np.asarray(self._stress_share * np.maximum(off, _USUAL * usual))

    @property
    def _self_share(self) -> float:
        share = _SHARE[self.fine.flank.order]
        if self.fine.flank.order < 4:
            return share
        return share * min(self._edges_below / _RESOLVED, 1.0) ** _RESOLVED_POWER

    @cached_property
    def _edges_below(self) -> float:
        """How many of the flank's longest edges the wider half-width covers."""
        return self.patch / float(np.diff(self.fine.flank.arc).max())

    def _neighbour_difference(self, k: int, p: Array, q: Array) -> tuple[Array, Array]:
        value = self.fine.neighbour(k, p, q, self.patch)
        of_width = np.abs(value - self.fine.neighbour(k, p, q, self.patch, 0.5))
        of_order = value - self.coarse.neighbour(k, p, q, self.patch) - self._turned
        start = self._order_at_start(k)
        of_order = np.abs(start) + np.abs(of_order - start)
        of_width *= _WIDTH_SHARE[self.fine.flank.order]
        return value, of_width + self._neighbour_share * self._share_of_rim * of_order + self._of_edges(k, p, q)

    def _order_at_start(self, k: int) -> float:
        """What both orders differ by at the start of the flank, where that counts by itself; else 0."""
        if self.fine.tooth.internal or self.fine.flank.order < 4:
            return 0.0
        if k not in self._starts:
            first = self._samples[:1]
            both = (one.neighbour(k, first, first, self.patch).item() for one in (self.fine, self.coarse))
            self._starts[k] = next(both) - next(both) - self._turned
        return self._starts[k]

    def _of_edges(self, k: int, p: Array, q: Array) -> Array:
        """What both solutions have in common: fillets' edges that leave the exact curves."""
        at_p, at_q = (self.fine.remote(one, self.patch) for one in (p, q))
        return np.abs(moved_by_edges(self.fine, k, at_p, at_q, self._outside))

    @cached_property
    def _outside(self) -> dict[Side, Array]:
        return {side: beyond_the_fillet(self.fine, side) for side in SIDES}

    @property
    def _neighbour_share(self) -> float:
        share = _NEIGHBOUR_SHARE[self.fine.flank.order]
        if self.fine.flank.order < 4:
            return share
        if self._edges_below < _FEWEST_KNOWN:
            share = _NEIGHBOUR_OF_FEW_EDGES
        narrow = min(self.patch / _NEIGHBOUR_WIDTH, 1.0) ** _NARROWER_POWER
        return self._for_width(share, _WIDER_POWER) * narrow

    @cached_property
    def _share_of_rim(self) -> float:
        """What the share is multiplied by on a ring with a thin rim; 1 of other gears and orders, and of few edges."""
        fine = self.fine
        few = self._edges_below < _FEWEST_KNOWN
        if not fine.tooth.internal or fine.flank.order < 4 or fine.support is not None or few:
            return 1.0
        outer = np.hypot(*fine.mesh.points[:, fine.mesh.edges["bore"][0]]).max()
        return min(float(outer - fine.tooth.root_radius) / _THICK_RIM, 1.0)

    def _for_width(self, share: float, power: float) -> float:
        """A share, more of fourth order where pressures are wide."""
        return share if self.fine.flank.order < 4 else share * max(self.patch / _NEIGHBOUR_WIDTH, 1.0) ** power

    def _neighbour_at_samples(self, k: int) -> Array:
        if k not in self._neighbours:
            self._neighbours[k] = self._neighbour_difference(k, self._samples, self._samples)[1]
        return self._neighbours[k]

    def _neighbour_estimate(self, k: int, difference: Array) -> Array:
        """Of differences at some places; no less than part of what is usual over the flank."""
        usual = _root_mean_square(self._neighbour_at_samples(k)[:_SAMPLES, :_SAMPLES])
        found = np.maximum(difference, _USUAL_NEIGHBOUR * usual) + self.common_errors[1]
        return np.asarray(np.maximum(found, _OF_TURNING * self._least_beside))

    @cached_property
    def _least_beside(self) -> float:
        """Smallest deflection of both neighbours: the gear turns as a whole by no more."""
        r = self._samples[:_SAMPLES]
        return max(float(min(np.abs(self.fine.neighbour(k, r, r, self.patch)).min() for k in (1, -1))), 0.0)

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
            r, b, teeth = self._samples, np.asarray(REFERENCE_HALF_WIDTH), self._beside if k else (0,)
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
            usual = {one: _root_mean_square(off[:_SAMPLES]) for one, (_, off) in self._stress_at_samples(k).items()}
            beside = max(usual[side], _OTHER_FILLET * max(usual.values()))
            scattered = _SCATTERED * _root_mean_square(self._scatter[k, side][:_SAMPLES])
            if k > 0 and side == "compression":
                share, beside = max(_NEIGHBOUR_STRESS * share, _LEAST_NEIGHBOUR_STRESS), _USUAL * beside
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
            least = _USUAL * max(self._usual_stress.values())
            return np.asarray(np.maximum(error, part * least * np.abs(value)))
        least = _OWN_USUAL * self._usual_stress[side]
        of_order, size = self._of_stress_order(side, value, difference, least)
        of_scatter = np.maximum(_OWN_SCATTERED_HERE * scatter, _OWN_SCATTERED * self._usual_scatter(side) * size)
        if self.fine.flank.order < 4:
            return np.asarray(np.hypot(of_order, of_scatter))
        return own_stress_error(side, share, of_order, of_scatter, up)

    def _judged_stress(self, side: Side, value: Array, difference: Array) -> Array:
        """All that the loaded tooth's own stress may err by at the samples: by this it is judged if a tolerance is met.

        Both fillets have one shape and edges as long: one errs by no less than the other usually does.
        """
        of_order, size = self._of_stress_order(side, value, difference, _USUAL * max(self._usual_stress.values()))
        scattered = np.maximum(_SCATTERED_HERE * self._scatter[0, side], _SCATTERED * self._usual_scatter(side) * size)
        return np.asarray(np.maximum(of_order, scattered))

    def _of_stress_order(self, side: Side, value: Array, difference: Array, least: float) -> tuple[Array, Array]:
        """What the order changes of the loaded tooth's own stress, relatively no less than so much, and of what."""
        size = np.maximum(np.abs(value), _LEAST_STRESS * np.abs(self._stress_at_samples(0)[side][0]).max())
        share = self._stress_share * (_COMPRESSED if side == "compression" else 1.0)
        return share * np.maximum(difference, least * size), size

    def _usual_scatter(self, side: Side) -> float:
        """What scatters of the loaded tooth's own stress over the flank, relatively."""
        scale = _stress_scale(self._stress_at_samples(0)[side][0])
        return _root_mean_square((self._scatter[0, side] / scale)[:_SAMPLES])

    def _up(self, radius: Array) -> Array:
        """How far contacts are from the start of the flank to its end, shape (P,)."""
        samples = self._samples[:_SAMPLES]
        first, last = (samples[-1], samples[0]) if self.fine.tooth.internal else (samples[0], samples[-1])
        return np.clip((np.asarray(radius) - first) / (last - first), 0.0, 1.0)

    @property
    def _usual_stress(self) -> dict[Side, float]:
        """What each fillet of the loaded tooth usually differs by over the flank, relatively."""
        stresses = self._stress_at_samples(0)
        return {
            side: _root_mean_square((off / _stress_scale(largest))[:_SAMPLES])
            for side, (largest, off) in stresses.items()
        }

    @cached_property
    def _stress_share(self) -> float:
        edges = np.diff(self.fine.fillets["tension"].arc[:: self.fine.flank.order])
        alike = edges.sum() ** 2 / (edges**2).sum()
        share = max(float(_STRESS_EDGES / alike) ** _STRESS_POWER, _LEAST_STRESS_SHARE)
        return min(share if self.fine.flank.order == 4 else _LOWER_ORDERS * share, 1.0)

    @cached_property
    def _neighbours(self) -> dict[int, Array]:
        return {}

    @cached_property
    def _starts(self) -> dict[int, float]:
        return {}

    @cached_property
    def _stresses(self) -> dict[int, dict[Side, tuple[Array, Array]]]:
        return {}

    @cached_property
    def _neighbours_asked(self) -> dict[tuple[Side, bytes, bytes], dict[int, _Stress]]:
        return {}

    @cached_property
    def _scatter(self) -> dict[tuple[int, Side], Array]:
        return {}

    @cached_property
    def _samples(self) -> Array:
        """Radii at which errors are looked for: `_SAMPLES` evenly in roll angle, those between, and near the ends."""
        flank, tooth = self.fine.flank, self.fine.tooth
        least, most = tooth.involute_radii
        low, high = max(flank.lowest_radius, least), min(flank.highest_radius, most)
        first, last = tooth.roll(np.array([max(low, tooth.base_radius), high])).tolist()
        evenly = np.clip(tooth.radius_of_roll(np.linspace(first, last, _SAMPLES)), low, high)
        between = np.sqrt(0.5 * (evenly[1:] ** 2 + evenly[:-1] ** 2))
        # On an involute the squared radius grows by twice the base radius times the arc length.
        near = 2.0 * tooth.base_radius * np.array(_BESIDE_ENDS)
        ends = np.sqrt(np.concatenate([low**2 + near, high**2 - near]))
        return np.concatenate([evenly, between, ends[(ends > low) & (ends < high)]])


def _stress_scale(value: Array) -> Array:
    """What relative errors of root stress over the flank are of."""
    size = np.abs(value)
    return np.maximum(size, _LEAST_STRESS * size.max())


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
