"""The finite-element solution of a gear, once for every stage that needs it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import RangeError
from fegear.scene.case.part import at
from fegear.scene.settings import mesh_settings
from fegear.scene.tooth_mesh import own_sector_mesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.fem import GearInfluence
    from fegear.scene.load import Scene


def needed_reach(scene: Scene, name: str) -> int:
    """How many neighbours on either side a gear's solution must know: as many as share the load in any of its pairs.

    All stages ask for the same number, so that they find the same solution. Without neighbour coupling it is one, which
    comes with the solution: the size of what is left out is told from it.
    """
    reach = 1
    if not scene.case.effects.neighbour_coupling:
        return reach
    for key, part in scene.case.pair.items():
        if key in scene.pairs and name in (part.driver, part.driven):
            ratio = scene.pairs[key].contact_ratio
            # A corner in contact before and after the path adds a pair at either end.
            extra = 1 if scene.case.effects.corner_contact else 0
            # A root's stress is followed from a base pitch before contact to one after it.
            extra += 1 if "root-stress-history" in scene.case.results else 0
            reach = max(reach, min(math.ceil(ratio * (1.0 - 1e-12)) - 1 + extra, scene.gears[name].teeth // 2 - 1))
    return reach


def gear_influence(scene: Scene, name: str, progress: Callable[[str], None] | None = None) -> GearInfluence:
    """Solve a gear of the scene; equal shapes with equal settings are solved once in a process.

    Parameters
    ----------
    scene : Scene
    name : str
        Name of the gear.
    progress : callable, optional
        Called with the name of each step as it starts.

    Raises
    ------
    RangeError
        If the gear's bore cannot be meshed, under its key in the case.
    """
    from fegear.fem import solve_gear

    mesh = own_sector_mesh(scene, name)
    try:
        return solve_gear(
            scene.gears[name],
            mesh_settings(scene.case.accuracy),
            reach=needed_reach(scene, name),
            mesh=mesh,
            progress=progress,
        )
    except RangeError as error:
        raise at(f"gear.{name}", error) from None
