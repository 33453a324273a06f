"""Loads, transmission error and root stress over the stroke of a pinion and a rack with their width, spur or helical.

As of the plane section (`over_stroke`): in base pitch c pair 0 is on tooth c of the rack, pair j on tooth c - j, and
base pitches whose teeth stand alike are solved once. Contact lines of teeth that the rack does not have are left out;
along tip edges lines go on as those of two gears do.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from fegear.contact.rack.over_stroke import AS_GENERATED
from fegear.contact.rack.stroke import BasePitches, OnPitch, Stroke
from fegear.contact.wide.compliance import flank_compliance, places_of
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import ContactLines, contact_lines
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
from fegear.contact.wide.root_stress import SIGN, RootedLines, places_along, rooted_lines
from fegear.contact.wide.tip_edges import TipEdges, usual_gap

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Mask
    from fegear.contact.rack.rack_flanks import RackFlanks
    from fegear.contact.rack.rack_in_mesh import RackInMesh
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.rack.solid_rack import SolidRack
    from fegear.fem.solid.solution import SolidSolution
    from fegear.geometry.pair import GearPair, Member
    from fegear.geometry.relief import Relief

#: How far within the stroke its outermost positions stand [base pitches].
_BESIDE = 1e-7
#: Panels of contact lines along the face [modules].
_PANEL = 0.5


@dataclass(frozen=True)
class WideRackFlanks:
    """A pinion and a rack with their width, ready to be loaded.

    Parameters
    ----------
    pair : RackInMesh
    pinion : SolidSolution
    rack : SolidRack
    flanks : RackFlanks
        Reliefs of both.
    positions : int
        In a base pitch.
    """

    pair: RackInMesh
    pinion: SolidSolution
    rack: SolidRack
    flanks: RackFlanks = AS_GENERATED
    positions: int = 16

    def loaded_by(self, load: float) -> FlankPair:
        """With lines along tip edges as far as a load may close gaps there [N, along the transverse line of action]."""
        return replace(self._of_gears, most_gap=usual_gap_on_rack(self.pair, load))

    @cached_property
    def _of_gears(self) -> FlankPair:
        # Contact over the flank asks nothing of a pair of gears that a rack in mesh does not answer.
        pair, bodies = cast("GearPair", self.pair), cast("Mapping[Member, SolidSolution]", self.bodies)
        return FlankPair(pair, bodies, panel=_PANEL, positions=self.positions)

    @property
    def bodies(self) -> dict[str, SolidSolution | SolidRack]:
        """By the names of a pair's members."""
        return {"driver": self.pinion, "driven": self.rack}

    def gaps(self) -> FlankGaps:
        """What keeps the flanks apart."""
        if self.flanks.rack is None:
            return FlankGaps(self.flanks.pinion)
        return FlankGaps(self.flanks.pinion, cast("Relief", self.flanks.rack))  # over the height, as the rack's lengths

    def _of_stroke(self, roll: Array, cycle: int) -> Mask:
        """Positions between the first contact of the first tooth at mid-face and the last one of the last there."""
        pitch, start, end = self.pair.base_pitch, self.pair.x_start, self.pair.x_end
        way = cycle * pitch + roll - start
        slack = 1e-6 * pitch
        return np.asarray((way >= -slack) & (way <= (self.rack.teeth - 1) * pitch + end - start + slack))

    def roll(self, load: float) -> Array:
        """Roll positions of a base pitch from the start of the path at mid-face on, both ends of the stroke among them.

        The load is along the transverse line of action [N].
        """
        pitch, start = self.pair.base_pitch, self.pair.x_start
        ends = np.array([_BESIDE * pitch, math.fmod(self.pair.x_end - start, pitch) - _BESIDE * pitch])
        usual = np.mod(self.loaded_by(load).points.x - start, pitch)
        apart = np.abs(np.subtract.outer(ends, usual)).min(axis=1) > 2.0 * _BESIDE * pitch
        return np.asarray(start + np.unique(np.concatenate([usual, np.mod(ends[apart], pitch)])))

    def base_pitch(self, load: float, cycle: int, roll: Array) -> LoadedFlanks | None:
        """Share a load [N, along the transverse line of action] with pair 0 on a tooth of the rack.

        Roll positions [m] beyond the stroke are left out; None where all are.
        """
        whole = self.loaded_by(load)
        pair = whole.pair
        lines = contact_lines(pair, roll, _PANEL * pair.driver.module, most_gap=whole.most_gap)
        lines = on_rack(lines, cycle, self.rack.teeth, self._of_stroke(lines.roll, cycle))
        if not lines.roll.size:
            return None
        known = flank_compliance(pair, whole.gears, lines, load, cache=whole.cache, cycle=cycle)
        return whole.solve(load, replace(self.gaps(), base_pitch=cycle), known)


def usual_gap_on_rack(pair: RackInMesh, load: float) -> float:
    """As `usual_gap` of two gears [m]."""

    class _Softer:
        driver, driven, face_width = pair.driver, pair.meshing.rack, pair.face_width

    return usual_gap(cast("GearPair", _Softer), load)


def on_rack(lines: ContactLines, cycle: int, teeth: int, at: Mask) -> ContactLines:
    """Contact lines on teeth that a rack has, at some positions, where one of them is on the path of contact.

    Parameters
    ----------
    lines : ContactLines
    cycle : int
        Tooth of pair 0.
    teeth : int
        Of the rack.
    at : ndarray of bool, shape (P,)
        Which positions.
    """
    tooth = cycle - lines.pair
    there = lines.present & (tooth >= 0) & (tooth < teeth)
    on_path = there if lines.edges is None else there & (lines.edges.gap == 0.0)
    rows = np.flatnonzero(on_path.any(axis=1) & at)
    order = np.argsort(~there[rows], axis=1, kind="stable")[:, : int(there[rows].sum(axis=1).max(initial=0))]

    def some(values: NDArray[Any]) -> NDArray[Any]:
        return np.take_along_axis(values[rows], order, axis=1)

    edges = lines.edges
    if edges is not None:
        edges = TipEdges(*(some(getattr(edges, name)) for name in TipEdges.__dataclass_fields__))
    return ContactLines(
        lines.roll[rows], np.where(some(there), some(lines.pair), 0), some(there), some(lines.x), some(lines.z),
        lines.low, lines.high, some(lines.at_edge), edges=edges,
    )  # fmt: skip


@dataclass(frozen=True)
class RackRoots(RootedLines):
    """Roots of a rack, each tooth of which answers by its number.

    Parameters
    ----------
    rack : SolidRack
    cycle : int
        Tooth of pair 0.
    """

    rack: SolidRack
    cycle: int

    def surface(self, side: Side, force: Array, z: Array) -> Array:
        """As of gears; see `RootedLines.surface`."""
        places, spans = places_of(self.lines)
        on = force[self.lines.present]
        loads = [own @ on[s] for own, s in zip(self.loads, spans, strict=True)]
        loaded = np.array([self.rack.alike[self.cycle - int(self.lines.pair[p, s.start])] for p, s in places])
        moved: Array | float = 0.0
        for k, felt in self.sources.items():
            for tooth in np.unique(loaded[felt[:, 1]]).tolist():
                mine = felt[loaded[felt[:, 1]] == tooth]
                there = np.stack([loads[line] for line in mine[:, 1]], axis=1)
                under = np.zeros((there.shape[0], len(self.teeth)))
                under[:, mine[:, 0]] = there
                moved = moved + self.rack.loaded(tooth).moved(k, side, under)
        return self.rack.usual.surface_stress(side, np.asarray(moved), z / self.pair.driver.module)

    @property
    def numbers(self) -> Array:
        """Of the teeth that are followed, shape (T,); some the rack may not have."""
        return np.asarray(self.cycle - self.teeth[:, 1])


def rack_roots(found: LoadedFlanks, rack: SolidRack, cycle: int) -> RackRoots:
    """The roots of a rack under the contact lines of a base pitch."""
    usual = cast("SolidSolution", rack.usual)
    one = rooted_lines(found.pair, "driven", found.lines, usual, coupling=True)
    return RackRoots(
        one.pair, one.member, one.lines, one.solution, one.bands, one.loads, one.teeth, one.sources, rack, cycle
    )


@dataclass(frozen=True)
class WideStroke:
    """A loaded rack and pinion with their width over the stroke.

    Parameters
    ----------
    stroke : Stroke
    middle : LoadedFlanks
        In the base pitch in the middle of the rack.
    cycle : int
        Tooth of pair 0 there.
    travel : ndarray, shape (P,)
        Of the rack there [m].
    """

    stroke: Stroke
    middle: LoadedFlanks
    cycle: int
    travel: Array


def wide_over_stroke(
    ready: WideRackFlanks, force: float, progress: Callable[[float], None] | None = None,
    added: Mapping[int, Array] | None = None,
) -> WideStroke:  # fmt: skip
    """Roll the pinion along the rack.

    Parameters
    ----------
    ready : WideRackFlanks
    force : float
        Along the rack [N].
    progress : callable, optional
        Receives the fraction that is done.
    added : mapping of int to ndarray, optional
        Positions besides those of a base pitch, as in `BasePitches.stroke`.
    """
    meshing, rack = ready.pair.meshing, ready.rack
    cos, load = math.cos(meshing.rack.pressure_angle), force / math.cos(meshing.rack.pressure_angle)
    pitch, start = meshing.rack.base_pitch, ready.pair.x_start
    solved: dict[int, LoadedFlanks] = {}  # at the usual positions, which come first

    def solve(c: int, roll: Array) -> OnPitch:
        found = ready.base_pitch(load, c, roll)
        if found is None:
            none = np.empty(0)
            sides: dict[Side, Array] = dict.fromkeys(SIGN, none)
            return OnPitch(none, none, none.astype(np.int64), none, sides, {side: {} for side in SIGN})
        solved.setdefault(c, found)
        pairs, share = (found.pair_load[:, :, 0] > 0.0).sum(axis=0), found.share[:, :, 0].max(axis=0)
        return OnPitch(found.lines.roll, found.transmission_error[:, 0] / cos, pairs, share, *_roots(ready, found, c))

    around = math.ceil(meshing.total_contact_ratio) + rack.reach + 1
    kinds = tuple(
        tuple(rack.alike[t] if rack.exists(t) else -1 for t in range(c - around, c + around + 1))
        for c in range(rack.teeth + math.ceil(meshing.contact_ratio))
    )
    every = BasePitches(kinds, solve, ready.roll(load), rack.teeth, start, pitch, cos)
    stroke = every.stroke(added, progress)
    cycle = int(stroke.tooth[stroke.middle])
    middle = solved[kinds.index(kinds[cycle])]
    return WideStroke(stroke, middle, cycle, (cycle * pitch + middle.lines.roll - start) / cos)


def _roots(
    ready: WideRackFlanks, found: LoadedFlanks, cycle: int
) -> tuple[dict[Side, Array], dict[Side, dict[int, Array]]]:
    """Largest root stress of the pinion, and of the rack's teeth by their number less `cycle`, each of (P,) [Pa]."""
    force, places = found.contact.force[:, :, 0], places_along(found.lines, found.pair.driver.module)
    of_pinion = rooted_lines(found.pair, "driver", found.lines, ready.pinion, coupling=True)
    of_rack = rack_roots(found, ready.rack, cycle)
    pinion: dict[Side, Array] = {}
    teeth: dict[Side, dict[int, Array]] = {}
    for side, sign in SIGN.items():
        highest = (sign * of_pinion.stress(side, force, places).value).max(axis=1)
        pinion[side] = np.full(found.lines.roll.size, -np.inf)
        np.maximum.at(pinion[side], of_pinion.teeth[:, 0], highest)
        pinion[side] *= sign
        highest = (sign * of_rack.stress(side, force, places).value).max(axis=1)
        teeth[side] = {}
        for t in np.unique(of_rack.numbers).tolist():
            if ready.rack.exists(t):
                rows = of_rack.numbers == t
                teeth[side][t - cycle] = np.zeros(found.lines.roll.size)
                teeth[side][t - cycle][of_rack.teeth[rows, 0]] = sign * highest[rows]
    return pinion, teeth
