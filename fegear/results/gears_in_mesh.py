"""What the stages of the moving picture of a pair read: its loads, and both gears solved by finite elements."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.pair import MEMBERS
from fegear.models.pair_inputs import gear_name
from fegear.results.gear_solution import needs_solution
from fegear.results.loaded_pair import needs_pair

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array, Index
    from fegear.case.reading import Scene
    from fegear.engine.stage import Task
    from fegear.geometry.pair import Member

#: Roll positions of a moving picture stand so far apart at least [base pitches].
_STEP = 0.019


@dataclass(frozen=True)
class MeshInputs:
    """What these stages read of the case beside the loaded pair.

    Parameters
    ----------
    tips : bool
        Whether tip corners touch beyond the path of contact.
    name : str
        Of the pair.
    gears : mapping of str to str
        Names of the gears by member.
    """

    tips: bool
    name: str = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


def mesh_inputs(scene: Scene, name: str) -> MeshInputs:
    """Read them."""
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    return MeshInputs(scene.case.effects.corner_contact, name, gears)


def needs_mesh(scene: Scene, name: str) -> tuple[Task, ...]:
    """The tasks of the loaded pair and of both gears' solutions."""
    part = scene.case.pair[name]
    return (*needs_pair(scene, name), *needs_solution(part.driver, part.driven))


def picture_positions(roll: Array, pitch: float, kept: float) -> Index:
    """Numbers of the roll positions that a moving picture needs: evenly many, both sides of every jump, and one more.

    Parameters
    ----------
    roll : ndarray, shape (P,)
        Ascending [m].
    pitch : float
        Base pitch [m].
    kept : float
        Roll position that is needed in any case [m].
    """
    chosen, jump = [0], np.diff(roll) < 1e-5 * pitch
    for i in range(1, roll.size):
        beside = jump[i - 1] or (i < roll.size - 1 and jump[i])
        if beside or i == roll.size - 1 or roll[i] == kept or roll[i] - roll[chosen[-1]] >= _STEP * pitch:
            chosen.append(i)
    return np.array(chosen)
