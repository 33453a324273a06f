"""Stage ``flank-stress-in-mesh``: root stress along the fillets of two gears with a width, in sections along the face.

In the section at z the flanks of a helical pair touch where those of its middle section do when the gears have turned
back by z tan(beta_b) on the line of action: so one picture of the teeth serves all sections.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage
from fegear.geometry.pair import MEMBERS
from fegear.models.loaded_flanks import FLANK_EFFECTS
from fegear.results import forecasts
from fegear.results.drawn_pair import placed_in_mesh
from fegear.results.flank_root_stress import needs_flank_roots, places_along
from fegear.results.gears_in_mesh import mesh_inputs
from fegear.results.loaded_flanks import loaded_flanks, wide_pairs
from fegear.results.solid_solution import solid_solution_of
from fegear.results.sources import RING
from fegear.results.stress_in_mesh import FilletStress, LargestStress, StressInMeshData

if TYPE_CHECKING:
    from fegear.arrays import Array, Index
    from fegear.contact.flank.root_stress import RootedLines
    from fegear.engine.stage import Upstream, Work
    from fegear.fem.influence import Side
    from fegear.results.gears_in_mesh import MeshInputs

_SIDES: tuple[Side, ...] = ("tension", "compression")
#: Sections along the face that a picture has, at most, and how many of the places at which stress is looked for make
#: one step between them.
_SECTIONS, _EVERY = 25, 2


class _Moments(NamedTuple):
    """Roll positions of a moving picture, from one end of a base pitch to the other: which, and how many pitches on."""

    roll: Array
    position: Index
    on: Index


def _moments(roll: Array, start: float, pitch: float) -> _Moments:
    """The roll positions that a picture from `start` over a base pitch needs, both ends enclosed, ascending."""
    first = int(np.floor((start - roll.max()) / pitch))
    turns = range(first, first + 4)
    at = np.concatenate([roll + on * pitch for on in turns])
    position, on = np.tile(np.arange(roll.size), len(turns)), np.repeat(list(turns), roll.size)
    low, high = at[at <= start].max(), at[at >= start + pitch].min()
    order = np.argsort(at, kind="stable")
    order = order[(at[order] >= low) & (at[order] <= high)]
    return _Moments(at[order], position[order], on[order])


def _sections(places: Array, largest: float) -> Array:
    """Places along the face that are shown, that of the largest stress among them."""
    step = max(_EVERY, -(-(places.size - 1) // (_SECTIONS - 1)))
    count = max(2, -(-(places.size - 1) // step) + 1)
    return np.unique(np.append(places[np.round(np.linspace(0, places.size - 1, count)).astype(int)], largest))


def _stress(asked: MeshInputs, upstream: Upstream, _work: Work) -> StressInMeshData:
    from fegear.contact.flank.root_stress import rooted_lines

    loaded = loaded_flanks(upstream, asked.name)
    found, pair = loaded.found, loaded.found.pair
    force, coupling = found.contact.force[:, :, loaded.nominal], loaded.asked.effects.neighbour_coupling
    rooted = {
        member: rooted_lines(
            pair, member, found.lines, solid_solution_of(upstream, asked.gears[member]).fine, coupling=coupling
        )
        for member in MEMBERS
    }
    moments = _moments(found.lines.roll, pair.x_start, pair.base_pitch)
    largest = max((_largest(one, force, places_along(loaded), moments) for one in rooted.values()), key=_value)
    z = _sections(places_along(loaded), largest.z)
    numbers = np.unique([one.teeth[:, 1] for one in rooted.values()])
    pairs = np.arange(numbers[0] - moments.on.max(), numbers[-1] - moments.on.min() + 1)
    gears = {member: _along(one, force, z, moments, pairs) for member, one in rooted.items()}
    shown = np.zeros(pairs.size, dtype=bool)
    for gear in gears.values():
        shown |= (np.nan_to_num(gear.stress["tension"], nan=1.0) != 0.0).any(axis=(0, 1, 3))
    gears = {
        member: FilletStress(
            {side: one.places[side][shown] for side in _SIDES}, {side: one.stress[side][:, :, shown] for side in _SIDES}
        )
        for member, one in gears.items()
    }
    return StressInMeshData(pair, moments.roll, pairs[shown], gears, largest, z)


def _value(largest: LargestStress) -> float:
    return largest.value


def _along(rooted: RootedLines, force: Array, z: Array, moments: _Moments, pairs: Index) -> FilletStress:
    """One gear's fillets in all sections at all moments; teeth that are not followed feel nothing."""
    pair, member = rooted.pair, rooted.member
    places, stress = {}, {}
    row = {(p, j): t for t, (p, j) in enumerate(rooted.teeth.tolist())}
    tooth = np.array([[row.get((p, j + on), -1) for j in pairs.tolist()] for p, on in zip(*moments[1:], strict=True)])
    for side in _SIDES:
        felt = rooted.along_fillets(side, force, z)
        felt = np.concatenate([felt, np.zeros((*felt.shape[:2], 1))], axis=2)  # the last is of no tooth
        stress[side] = np.ascontiguousarray(felt[:, :, tooth].transpose(1, 2, 3, 0))
        own = rooted.solution.fillets[side].place * pair.driver.module
        places[side] = np.stack([placed_in_mesh(pair, member, own, j) for j in pairs.tolist()])
    return FilletStress(places, stress)


def _largest(rooted: RootedLines, force: Array, z: Array, moments: _Moments) -> LargestStress:
    """As ``root-stress-history`` finds it, and where it stands in the picture."""
    pair, member, fillet = rooted.pair, rooted.member, rooted.solution.fillets["tension"]
    one = rooted.stress("tension", force, z)
    tooth, place = (int(i) for i in np.unravel_index(int(one.value.argmax()), one.value.shape))
    position, number = rooted.teeth[tooth].tolist()
    shown = int(np.flatnonzero(moments.position == position)[0])
    number -= int(moments.on[shown])
    radius = float(one.radius[tooth, place])
    up = np.hypot(*fillet.place) * pair.driver.module
    at = np.array([np.interp(radius, up, line * pair.driver.module) for line in fillet.place])
    return LargestStress(
        float(one.value[tooth, place]), member, number, float(moments.roll[shown]),
        placed_in_mesh(pair, member, at, number), radius, float(z[place]),
    )  # fmt: skip


FLANK_STRESS_IN_MESH = Stage(
    subjects=wide_pairs,
    needs=needs_flank_roots,
    inputs=mesh_inputs,
    compute=_stress,
    present=lambda data, _inputs: Outcome(data),
    effects=FLANK_EFFECTS,
    cites=citing(*RING),
    forecast=lambda _scene, _name: forecasts.constant(0.15),
)
