"""Loads a double helical pair: both halves at mesh positions that they have in common, and the balance of both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.one_thread import one_thread
from fegear.base.solution_cache import SolutionCache
from fegear.contact.double_helical.balance import balance
from fegear.contact.double_helical.double_error import LONGER, double_error
from fegear.contact.double_helical.loaded_double import LoadedDoublePair
from fegear.contact.wide.lines import base_twist
from fegear.contact.wide.load_sharing import Contact, averaged_gaps
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.contact.wide.maker import load_flanks
from fegear.contact.wide.roll_points import line_breaks, roll_points
from fegear.contact.wide.spots import solve_spots
from fegear.contact.wide.tip_edges import edge_reach
from fegear.fem.solid.slice_laws import missed_by_slices
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Sequence

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
    lag : float
        Of its approach per its own load, by shafts that twist between the halves [m/N].
    order : ndarray, shape (P,)
        Mesh positions of the pair in the order of its own roll positions.
    """

    flanks: FlankPair
    known: FlankCompliance
    gap: Array
    constant: float
    lag: float
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
        stiffness = contact.stiffness[self._back]
        return contact.approach[self._back] + self.constant + self.lag * load, stiffness / (1.0 + self.lag * stiffness)

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
    constant, lag = spec.constant_gaps[number], spec.twist_compliance[number]
    return _LoadedHalf(flanks, known, gaps.at(flanks.pair, known.lines), constant, lag, order)
