"""What results of a train say of the resonance of a mesh: the nearest one, and whether a speed is near to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.printed import figures, percent
from fegear.engine.answered import Deciding
from fegear.results.train.gear_train import RPM

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.dynamics.train.mesh_resonance import MeshResonance


def resonance_said(mesh: str, found: MeshResonance | None, speed: float, what: str = "") -> Iterator[str]:
    """The resonance that is nearest to a speed, and whether the speed is near to it.

    Parameters
    ----------
    mesh : str
    found : MeshResonance or None
        Nothing is said of a mesh without one.
    speed : float
        That it is nearest to [rad/s].
    what : str
        What occurs at that speed: "maximum".
    """
    if found is None:
        return
    at = f"{what}, at {figures(speed * RPM, 4)} rpm," if what else f"{speed * RPM:.6g} rpm"
    which = "the mesh frequency" if found.harmonic == 1 else f"harmonic {found.harmonic} of the mesh frequency"
    away = percent(1.0 / (1.0 + found.off) - 1.0, signed=True)
    begin = f"{at} is near a resonance" if found.near else f"resonance nearest to {at.removesuffix(',')}"
    yield Deciding(
        f"Mesh {mesh}: {begin}: {which} meets a natural frequency at {figures(found.at * RPM, 4)} rpm ({away}); "
        f"the mesh frequency meets {figures(found.frequency, 4)} Hz at {figures(found.speed * RPM, 4)} rpm."
    )
