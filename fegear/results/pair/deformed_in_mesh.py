"""Stages ``outline-motion`` and ``deformed-in-mesh``: deformed teeth of two gears in mesh, for their moving picture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.case.built.pair_checks import check_relief
from fegear.case.reading import Scene
from fegear.contact.plane.moved_outlines import MovedOutline
from fegear.engine.citation import citing
from fegear.engine.sheet.sheet import UNSHOWN
from fegear.engine.stage import Stage, Task, Upstream, Work
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.outline_motion import OutlineMotion
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results import forecasts
from fegear.results.forecasts import RING
from fegear.results.gear.drawing import placed_in_mesh
from fegear.results.gear.solved_gear import of_solved_gear, solution_of
from fegear.results.pair.loaded_teeth import loaded_pair, needs_gears, plane_pairs
from fegear.results.pair.stress_in_mesh import MeshInputs, mesh_inputs

#: Teeth behind the one whose pair touches first and ahead of it that a picture shows.
_BEHIND, _AHEAD = 3, 4
#: Neighbours whose motion under a load is known: all that a picture shows beside the pairs that carry.
_REACH = _AHEAD + 1
#: Even steps over the base pitch; what lies between is seldom seen for longer than a frame.
_STEPS = 50


def _motion(fine: Influence, reach: int) -> OutlineMotion:
    from fegear.fem.plane.outline_motion import outline_motion

    return outline_motion(fine, reach)


OUTLINE_MOTION = of_solved_gear(_motion, _REACH, seconds=0.25)


@dataclass(frozen=True)
class DeformedInMeshData:
    """Outlines of both gears in mesh and how they move, at P roll positions.

    Parameters
    ----------
    pair : GearPair
    roll : ndarray, shape (P,)
        x of pair 0 [m].
    pairs : ndarray of int, shape (T,)
        Pairs that the teeth belong to.
    transmission_error : ndarray, shape (P,)
        By which the driver is ahead, along the line of action [m].
    places : mapping of str to ndarray, shape (T, 2, N)
        By member: outlines of teeth at rest, where they stand while pair 0 touches at the pitch point [m].
    moved : mapping of str to ndarray, shape (P, T, 2, N)
        Their displacements in the frame of their gear [m]: by the loads, and what is removed from the flanks.
    largest : float
        Largest displacement [m].
    """

    pair: GearPair
    roll: Array
    pairs: Array
    transmission_error: Array
    places: Mapping[Member, Array]
    moved: Mapping[Member, Array]
    largest: float


def _deformed(asked: MeshInputs, upstream: Upstream, _work: Work) -> DeformedInMeshData:
    from fegear.contact.plane.base_pitch import roll_positions
    from fegear.contact.plane.moved_outlines import moved_outline

    found = loaded_pair(upstream, asked.name)
    e, pair = found.engagement, found.engagement.pair
    state = e.solve(e.grid(roll_positions(e, _STEPS)), [found.nominal])
    most = (min(pair.driver.teeth, pair.driven.teeth) - 1) // 2  # no tooth is drawn twice
    teeth = range(-min(_BEHIND, most), min(_AHEAD, most) + 1)
    places, moved, largest = {}, {}, 0.0
    for member in MEMBERS:
        gear = asked.gears[member]
        patch = solution_of(upstream, gear).settings.patch_half_width
        motion = cast("OutlineMotion", upstream[Task("outline-motion", gear)])
        one = moved_outline(e, state, member, motion, patch, teeth)
        places[member] = np.stack([placed_in_mesh(pair, member, one.points, j) for j in teeth])
        moved[member] = _in_gear(pair, member, one)
        largest = max(largest, one.largest)
    return DeformedInMeshData(pair, state.x, np.array(teeth), state.transmission_error[:, 0], places, moved, largest)


def _in_gear(pair: GearPair, member: Member, one: MovedOutline) -> Array:
    """Displacements from the frames of the teeth to that of their gear, shape (P, T, 2, N) [m]."""
    parts = [
        placed_in_mesh(pair, member, one.displacement[:, t].transpose(1, 0, 2), j, moved=True).transpose(1, 0, 2)
        for t, j in enumerate(one.pairs.tolist())
    ]
    return np.stack(parts, axis=1).astype(np.float32)


def _needs_motion(scene: Scene, name: str) -> tuple[Task, ...]:
    part = scene.case.pair[name]
    gears = dict.fromkeys((part.driver, part.driven))
    return (*needs_gears(scene, name), *(Task("outline-motion", gear) for gear in gears))


def _check_compliance(scene: Scene, name: str) -> None:
    check_relief(scene, name)
    source = scene.case.pair[name].compliance.source
    if source != "fe":
        raise InputError(
            f"pair.{name}.compliance.source", f'"{source}"',
            "gives flank deflections, not the deformed tooth shape",
            'set source = "fe", or remove the deformed teeth',
        )  # fmt: skip


DEFORMED_IN_MESH = Stage(
    subjects=plane_pairs,
    needs=_needs_motion,
    inputs=mesh_inputs,
    compute=_deformed,
    present=UNSHOWN.present,
    check=_check_compliance,
    cites=citing(*RING),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
)
