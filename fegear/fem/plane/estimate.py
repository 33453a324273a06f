"""How far two solutions of one tooth shape are apart, and what error of the finer one follows; dimensionless."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array
from fegear.base.plain import read_only
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.edge_curves import beyond_the_fillet, moved_by_edges
from fegear.fem.plane.flank_samples import SAMPLES, USUAL, flank_samples, root_mean_square
from fegear.fem.plane.influence import MOSTLY_TURNED, ROOM_SHARE, SIDES, Influence, Side
from fegear.fem.plane.stress_estimate import StressEstimate

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
#: A gear on a small bore turns as a whole by far more than its teeth give way, and of all teeth two solutions differ by
#: the same: by the mean over the flanks of both neighbours less so many times its scatter. That is no load's error. It
#: is looked at where that is most of what gives way.
_SCATTERS = 3.0
#: Of neighbours, of which no position errs by less than they usually differ by, times this.
_USUAL_NEIGHBOUR = 1.0
#: Where the wider half-width covers fewer edges than these, longer ones than those of a tolerance of 0.01.
_FEWEST_KNOWN = 1.25
#: By how much the gear turns on its bore both orders may agree by chance: so much of the smallest deflection of its
#: neighbours is error at least.
_OF_TURNING = 1e-7


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
        return self._of_stress.root_stress(k, side, radius, half_width)

    def place_error(self, value: Array, other: Array) -> Array:
        """Error of the stress at places of a fillet (`StressEstimate.place_error`)."""
        return self._of_stress.place_error(value, other)

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
            errors[f"root_{side}"] = self._of_stress.judged(side)
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
        r = self._samples[:SAMPLES]
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
        usual = USUAL * root_mean_square(known[:SAMPLES])
        # A difference that changes its sign along the flank vanishes on its way from one place to the next. At the ends
        # it is that of corners.
        order = np.argsort(samples[: 2 * SAMPLES - 1])[1:-1]
        padded = np.pad(known[order], 1, mode="edge")
        beside = np.maximum(np.maximum(padded[:-2], padded[2:]), padded[1:-1])
        floor = np.maximum(usual, np.interp(radius, samples[order], beside, left=0.0, right=0.0))
        return np.asarray(times * self._self_share * np.maximum(difference, floor) + self.common_errors[0])

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
        usual = root_mean_square(self._neighbour_at_samples(k)[:SAMPLES, :SAMPLES])
        found = np.maximum(difference, _USUAL_NEIGHBOUR * usual) + self.common_errors[1]
        return np.asarray(np.maximum(found, _OF_TURNING * self._least_beside))

    @cached_property
    def _least_beside(self) -> float:
        """Smallest deflection of both neighbours: the gear turns as a whole by no more."""
        r = self._samples[:SAMPLES]
        return max(float(min(np.abs(self.fine.neighbour(k, r, r, self.patch)).min() for k in (1, -1))), 0.0)

    @cached_property
    def _neighbours(self) -> dict[int, Array]:
        return {}

    @cached_property
    def _starts(self) -> dict[int, float]:
        return {}

    @cached_property
    def _samples(self) -> Array:
        return flank_samples(self.fine)

    @cached_property
    def _of_stress(self) -> StressEstimate:
        return StressEstimate(self.fine, self.coarse, self._samples)
