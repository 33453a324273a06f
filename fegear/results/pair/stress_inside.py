"""Stages ``inner-stress`` and ``stress-inside``: stress in the teeth of two gears in mesh, for their moving picture.

It is tabulated for unit loads at places along the flanks: stress under the loads of the tooth pairs follows by
superposition where it is drawn, so that a load or a relief that is moved asks for no new solution of the gears.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.case.reading import Scene
from fegear.engine.citation import citing
from fegear.engine.sheet.sheet import UNSHOWN
from fegear.engine.stage import Stage, Task, Upstream, Work
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.inner_stress import InnerStress
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results import forecasts
from fegear.results.forecasts import RING
from fegear.results.gear.drawing import placed_in_mesh
from fegear.results.gear.solved_gear import of_solved_gear
from fegear.results.pair.loaded_teeth import gears_of, plane_pairs

#: Neighbours whose stress under a load is known.
_REACH = 3


@dataclass(frozen=True)
class PairInputs:
    """What stress inside the teeth of a pair depends on besides that of its gears."""

    pair: GearPair
    face_width: float
    gears: Mapping[Member, str]


@dataclass(frozen=True)
class ToothStress(ReadOnlyArrays):
    """Stress inside one gear's teeth under unit loads, and where the points stand.

    Parameters
    ----------
    table : InnerStress
        In modules.
    places : ndarray, shape (2, N)
        Points of tooth 0 while pair 0 touches at the pitch point, which is the origin [m].
    roll : ndarray, shape (R,)
        Where contacts of the table stand: distance from the base circle along the line of action, ascending [m].
    per_load : float
        Stress for 1 N on the tooth, per unit of the table [Pa/N].
    """

    table: InnerStress
    places: Array
    roll: Array
    per_load: float


@dataclass(frozen=True)
class StressInsideData:
    """Stress inside the teeth of both gears of a pair.

    Parameters
    ----------
    pair : GearPair
    gears : mapping of str to ToothStress
        By member.
    """

    pair: GearPair
    gears: Mapping[Member, ToothStress]


def _inner(fine: Influence, reach: int) -> InnerStress:
    from fegear.fem.plane.inner_stress import inner_stress

    return inner_stress(fine, reach)


INNER_STRESS = of_solved_gear(_inner, _REACH, seconds=0.35)


def _inputs(scene: Scene, name: str) -> PairInputs:
    pair = scene.pairs[name]
    return PairInputs(pair, pair.face_width, gears_of(scene, name))


def _inside(asked: PairInputs, upstream: Upstream, _work: Work) -> StressInsideData:
    gears = {}
    for member in MEMBERS:
        gear = asked.pair.gear(member)
        table = cast("InnerStress", upstream[Task("inner-stress", asked.gears[member])])
        roll = gear.tooth.side * np.sqrt(np.maximum((table.radius * gear.module) ** 2 - gear.base_radius**2, 0.0))
        places = placed_in_mesh(asked.pair, member, table.points * gear.module, 0)
        gears[member] = ToothStress(table, places, roll, 1.0 / (asked.face_width * gear.module))
    return StressInsideData(asked.pair, gears)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return tuple(Task("inner-stress", gear) for gear in dict.fromkeys(gears_of(scene, name).values()))


STRESS_INSIDE = Stage(
    subjects=plane_pairs,
    needs=_needs,
    inputs=_inputs,
    compute=_inside,
    present=UNSHOWN.present,
    cites=citing(*RING),
    forecast=lambda _scene, _name: forecasts.constant(0.01),
)
