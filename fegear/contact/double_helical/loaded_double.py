"""A double helical pair under all its loads: two pairs with a width, and the balance between them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index, Mask
from fegear.base.one_thread import one_thread
from fegear.base.shown import shows
from fegear.base.solution_cache import SolutionCache
from fegear.contact.double_helical.balance import Balance, balance
from fegear.contact.wide.complementarity import Contact, averaged_gaps
from fegear.contact.wide.lines import base_twist
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.contact.wide.maker import load_flanks
from fegear.contact.wide.roll_points import line_breaks, roll_points
from fegear.contact.wide.spots import solve_spots
from fegear.contact.wide.tip_edges import edge_reach
from fegear.fem.solid.slice_laws import missed_by_slices
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.double_helical.double_error import DoubleError
    from fegear.contact.double_helical.double_spec import DoubleHelicalSpec
    from fegear.contact.fourier import Panels
    from fegear.contact.wide.compliance import FlankCompliance
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import FlankPair
    from fegear.fem.solid.influence import SolidInfluence

#: Breaks of both halves nearer to each other than this share of a base pitch are the same.
_SAME = 1e-9


@dataclass(frozen=True)
class _LoadedHalf:
    """One half at the mesh positions of the pair.

    Parameters
    ----------
    flanks : FlankPair
    known : FlankCompliance
        At its own roll positions, ascending.
    gap : ndarray, shape (P, M)
        At its own roll positions [m].
    constant : float
        Gap all over the half [m].
    order : ndarray, shape (P,)
        Mesh positions of the pair in the order of its own roll positions.
    """

    flanks: FlankPair
    known: FlankCompliance
    gap: Array
    constant: float
    order: Index

    @property
    def _back(self) -> Index:
        return np.argsort(self.order)

    @cached_property
    def touch(self) -> Array:
        """See `fegear.contact.double_helical.balance.Half`."""
        averaged = averaged_gaps(self.known.lines, self.gap, 1)[:, :, 0]
        nearest = np.where(self.known.lines.present, averaged, np.inf).min(axis=1)
        return np.asarray(nearest[self._back, None] + self.constant)

    def under(self, load: Array) -> tuple[Array, Array]:
        """See `fegear.contact.double_helical.balance.Half`."""
        with one_thread(with_scipy=False):
            _, contact = solve_spots(self.known, self.gap, load[self.order])
        return contact.approach[self._back] + self.constant, contact.stiffness[self._back]

    def loaded(self, load: Array, approach: Array) -> LoadedFlanks:
        """Flanks under loads of their own, which may be none, shape (P, L) [N]; their `load` is the mean of these."""
        own, carries = load[self.order], load[self.order] > 0.0
        with one_thread(with_scipy=False):
            known, contact = solve_spots(self.known, self.gap, np.where(carries, own, max(1e-3 * own.max(), 1.0)))
        contact = Contact(
            np.where(carries[:, None], contact.force, 0.0),
            np.where(carries, contact.approach, approach[self.order] - self.constant),
            np.where(carries, contact.stiffness, 0.0), np.where(carries, contact.residual, 0.0), contact.steps,
        )  # fmt: skip
        mean = np.where(np.ptp(own, axis=0) == 0.0, own[0], known.lines.mean(own))
        return LoadedFlanks(self.flanks.pair, known, contact, mean, {})


@dataclass(frozen=True)
class LoadedDoublePair:
    """A double helical pair at P mesh positions of one base pitch, under L loads.

    Parameters
    ----------
    spec : DoubleHelicalSpec
    points : Panels
        Mesh positions: roll positions of the half at end I [m].
    halves : (LoadedFlanks, LoadedFlanks)
        Under what each carries; the `load` of either is the mean of that over the base pitch [N], and their roll
        positions are their own, ascending.
    balance : Balance
    error : DoubleError or None
        Estimated, if that was asked for.
    """

    spec: DoubleHelicalSpec
    points: Panels
    halves: tuple[LoadedFlanks, LoadedFlanks]
    balance: Balance
    error: DoubleError | None = None

    @property
    def load(self) -> Array:
        """Of both halves together, shape (L,) [N]."""
        return np.array(self.spec.loads)

    def mean(self, values: Array) -> Array:
        """Mean over the base pitch of what is known at the mesh positions, shape (P, ...)."""
        return np.asarray(np.tensordot(self.points.weights / self.points.period, values, axes=1))

    @property
    @shows("um", "loaded transmission error along the line of action", name="te")
    def transmission_error(self) -> Array:
        """zeta [m], shape (P, L)."""
        return self.balance.approach

    @property
    def mean_transmission_error(self) -> Array:
        """Mean over a base pitch [m], shape (L,)."""
        return self.mean(self.transmission_error)

    @property
    def peak_to_peak(self) -> Array:
        """Of the transmission error at the mesh positions [m], shape (L,)."""
        return np.asarray(np.ptp(self.transmission_error, axis=0))

    @property
    def share_of_first(self) -> Array:
        """Of the half at end I, shape (P, L)."""
        return self.balance.share

    @property
    @shows("", "load of each half over the total load")
    def share(self) -> Array:
        """Of the halves at end I and II, shape (2, P, L)."""
        return np.stack([self.balance.share, 1.0 - self.balance.share])

    @property
    @shows("um", "axial displacement of the floating member towards end II")
    def axial_motion(self) -> Array:
        """From the middle of its play, shape (P, L) [m]; 0 of located members."""
        if self.spec.floating is None:
            return np.zeros_like(self.balance.position)
        sign = 1.0 if self.spec.floating == "driver" else -1.0
        return np.asarray(sign * (self.balance.position - self.spec.apex_offset))

    @property
    @shows("N", "axial force of both halves on the driver towards end II")
    def axial_force(self) -> Array:
        """Shape (P, L) [N]; the driven feels the opposite."""
        share = self.share
        first, second = self.spec.seat.twist
        return np.asarray(-self.load * (share[0] * first + share[1] * second))

    @property
    @shows("", "mean load of each half over its part of the face width", name="K_gamma")
    def load_factors(self) -> Array:
        """Mean share over the base pitch over that of an even load, shape (2, L)."""
        return np.stack([self.mean(one) / part for one, part in zip(self.share, self.spec.nominal_parts, strict=True)])

    @property
    def load_factor(self) -> Array:
        """K_gamma, shape (L,): of the half that carries more for its width."""
        return np.asarray(self.load_factors.max(axis=0))

    @property
    def face_load_factors(self) -> Array:
        """K_Hbeta of either half with its own mean load, shape (2, L); NaN of one that carries nothing."""
        carried = [half.load > 0.0 for half in self.halves]
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.stack([
                np.where(some, half.face_load_factor, np.nan) for half, some in zip(self.halves, carried, strict=True)
            ])  # fmt: skip

    @property
    def touches_back(self) -> Mask:
        """Whether a half that carries nothing is farther apart than its backlash, shape (L,): no answer holds then.

        Its other flanks touch there and carry load, which is not counted.
        """
        room = [half.placed.free_backlash for half in self.spec.halves]
        return np.asarray((self.balance.separation > np.array(room)[:, None, None]).any(axis=(0, 1)))

    def answer(self, case: int = -1) -> str:
        """What the sharing comes to under one load, in a sentence."""
        ends, motion = self.share[:, :, case], self.axial_motion[:, case]
        most = int(np.argmax(self.load_factors[:, case]))
        where = (
            f"the {self.spec.floating} moves {np.ptp(motion) * 1e6:.3g} µm along its axis over the base pitch"
            if self.spec.floating
            else "both members located"
        )
        limits = (
            "" if self.balance.free[:, case].all() or self.spec.floating is None else ", touching a stop of its play"
        )
        idle = [f"the half at end {end} carries nothing at some mesh positions" for end, half in
                zip(("I", "II"), ends, strict=True) if (half == 0.0).any()]  # fmt: skip
        back = "; its other flanks touch, which is not included" if self.touches_back[case] else ""
        alone = f" At this load {idle[0]}{back}." if idle else ""
        return (
            f"Double helical pair: the half at end {('I', 'II')[most]} carries "
            f"{float(self.mean(ends[most])) * 100.0:.3g} % of {self.load[case]:.5g} N "
            f"(K_gamma = {float(self.load_factor[case]):.3f}); {where}{limits}; transmission error "
            f"{float(self.peak_to_peak[case]) * 1e6:.3g} µm peak-to-peak.{alone}"
        )


def load_double(
    spec: DoubleHelicalSpec,
    gears: Sequence[Sequence[SolidInfluence]],
    *,
    cache: SolutionCache | None = None,
    estimates: bool = True,
) -> LoadedDoublePair:
    """Load both halves of a double helical pair together.

    Parameters
    ----------
    spec : DoubleHelicalSpec
    gears : sequence of (SolidInfluence, SolidInfluence)
        Solved driver and driven of the halves at end I and II.
    cache : SolutionCache, optional
        Of compliances.
    estimates : bool
        Whether errors are estimated, for twice or three times the work.

    Returns
    -------
    LoadedDoublePair
    """
    cache = SolutionCache() if cache is None else cache
    made = [_made(spec, number, own, cache) for number, own in enumerate(gears)]
    common = _common_positions(spec, [flanks for flanks, _ in made])
    found = _balanced(spec, made, common)
    if not estimates:
        return found
    from fegear.contact.double_helical.double_error import LONGER, double_error

    longer = [(replace(flanks, panel=LONGER * flanks.panel), gaps) for flanks, gaps in made]
    steps = [found, _balanced(spec, longer, common)]
    if any(one.coarse for own in gears for one in own):
        softer = [
            (replace(flanks, gears={member: one.coarse or one.fine for member, one in zip(MEMBERS, own, strict=True)}),
             gaps)
            for (flanks, gaps), own in zip(longer, gears, strict=True)
        ]  # fmt: skip
        steps.append(_balanced(spec, softer, common))
    sliced = [half for half in spec.halves if half.width == "slices"]
    missed = max((missed_by_slices(half.pair.driver.twist)["contact"] for half in sliced), default=0.0)
    return replace(found, error=double_error(steps, missed))


def _balanced(
    spec: DoubleHelicalSpec,
    made: Sequence[tuple[FlankPair, FlankGaps]],
    common: tuple[Panels, tuple[Panels | None, Panels | None]],
) -> LoadedDoublePair:
    """Both halves in balance at mesh positions that they have in common."""
    points, rolls = common
    halves = [_half(spec, number, *one, roll) for number, (one, roll) in enumerate(zip(made, rolls, strict=True))]
    found = balance(halves[0], halves[1], spec.loads, spec.seat)
    loads = np.array(spec.loads)
    first, second = (
        half.loaded(share * loads, found.approach + twist * found.position)
        for half, share, twist in zip(halves, (found.share, 1.0 - found.share), spec.seat.twist, strict=True)
    )
    return LoadedDoublePair(spec, points, (first, second), found)


def _made(
    spec: DoubleHelicalSpec, number: int, gears: Sequence[SolidInfluence], cache: SolutionCache
) -> tuple[FlankPair, FlankGaps]:
    """Flanks of a half, along tip edges as far as these carry any of its loads, and what keeps them apart."""
    bodies = {member: one.fine for member, one in zip(MEMBERS, gears, strict=True)}
    flanks, gaps, _ = load_flanks(spec.of_half(number), bodies, cache)
    return flanks, gaps


def _common_positions(
    spec: DoubleHelicalSpec, flanks: Sequence[FlankPair]
) -> tuple[Panels, tuple[Panels | None, Panels | None]]:
    """Mesh positions of both halves, as roll positions of the first, and those of either; None: its own.

    Helices that are continued meet in the middle of the gap, and the teeth at end II are ahead by the stagger.
    """
    pairs = [one.pair for one in flanks]
    pitch = pairs[0].base_pitch
    narrower = 0.5 * (pairs[1].face_width - pairs[0].face_width)
    ahead = spec.stagger * pitch + narrower * base_twist(pairs[0])
    own = [line_breaks(pair, edge_reach(pair, one.most_gap)) for pair, one in zip(pairs, flanks, strict=True)]
    others = np.mod(own[1] - ahead - pairs[0].x_start, pitch) + pairs[0].x_start
    points = flanks[0].points
    alike = flanks[0].positions == flanks[1].positions and own[0].size == own[1].size
    if alike and np.abs(np.sort(others) - own[0]).max() < _SAME * pitch:
        same = abs(ahead) < _SAME * pitch
        return points, (None, None if same else _moved(points, ahead, pairs[1].x_start))
    reach = edge_reach(pairs[0], flanks[0].most_gap)
    points = roll_points(pairs[0], max(one.positions for one in flanks), reach, others)
    return points, (points, _moved(points, ahead, pairs[1].x_start))


def _moved(points: Panels, ahead: float, start: float) -> Panels:
    """Points farther on by a length, within the base pitch from `start` on, still in the order of the first ones."""
    return replace(points, x=np.mod(points.x + ahead - start, points.period) + start)


def _half(
    spec: DoubleHelicalSpec, number: int, flanks: FlankPair, gaps: FlankGaps, points: Panels | None
) -> _LoadedHalf:
    about = spec.of_half(number).nominal
    if points is None:
        known, order = flanks.compliance(about), np.arange(flanks.roll.size)
    else:
        order = np.argsort(points.x, kind="stable")
        known = flanks.compliance(about, points.x[order])
        known = replace(known, lines=replace(known.lines, weight=points.weights[order] / points.period))
    constant = spec.constant_gaps[number]
    return _LoadedHalf(flanks, known, gaps.at(flanks.pair, known.lines), constant, order)
