"""Speeds of the shafts of a gearbox, and of the rings of its bearings against each other."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.case.built.pair_surface import pair_speed
from fegear.case.built.shafts import mesh_places

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def speeds_of_shafts(scene: Scene) -> dict[str, float]:
    """Speeds of the shafts, positive about z, from those of the pairs [rad/s]; NaN where unknown.

    Parameters
    ----------
    scene : Scene
    """
    found = dict.fromkeys(scene.case.shaft, math.nan)
    meshes = mesh_places(scene)
    for mesh in meshes:
        speed = pair_speed(scene, mesh.pair)
        if speed > 0.0 and math.isnan(found[mesh.shafts[0]]):
            found[mesh.shafts[0]] = mesh.sense * speed
            for _ in meshes:
                for one in meshes:
                    ratio = -one.found.side * abs(one.found.driver.teeth / one.found.driven.teeth)
                    first, second = one.shafts
                    if math.isnan(found[second]):
                        found[second] = found[first] * ratio
                    elif math.isnan(found[first]):
                        found[first] = found[second] / ratio
    return found


def against(spins: dict[str, float], shaft: str, around: str | None) -> float:
    """Speed of the rings of a bearing against each other [rad/s].

    Parameters
    ----------
    spins : dict
        Of all shafts [rad/s].
    shaft : str
        Inside the bearing.
    around : str or None
        Shaft outside it; the housing without one.
    """
    return abs(spins[shaft] - (spins[around] if around else 0.0))
