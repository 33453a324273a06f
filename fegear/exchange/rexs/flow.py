"""What passes through the stages of a REXS model: torques and speeds of its gears under one load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.exchange.rexs.drive import Mesh
from fegear.exchange.rexs.teeth import module_of, teeth_of

if TYPE_CHECKING:
    from fegear.exchange.rexs.drive import Driven, PlanetSet
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.said import Said


@dataclass(frozen=True)
class Flow:
    """What flows through a gearbox.

    Parameters
    ----------
    driven : Driven
    bodies : dict
        The body of every shaft.
    held : set of int
        Bodies that the casing holds.
    sets : tuple of PlanetSet
    meshes : tuple of Mesh
    assumed_torque, assumed_speed : frozenset of int
        Meshes whose torque or speed comes from an assumption.
    """

    driven: Driven
    bodies: dict[int, int]
    held: set[int]
    sets: tuple[PlanetSet, ...]
    meshes: tuple[Mesh, ...]
    assumed_torque: frozenset[int] = frozenset()
    assumed_speed: frozenset[int] = frozenset()

    def into(self, n: int) -> tuple[bool, float, float]:
        """Whether the first gear of a mesh drives, torque on the gear that does [N m] and its speed [rad/s]."""
        mesh, torque = self.meshes[n], self.driven.mesh_torque[n]
        speeds = [self.driven.speed[body] for body in mesh.bodies]
        drives = not torque * speeds[0] > 0.0  # the mate takes power from a gear that drives
        on_driver = abs(torque) * (1.0 if drives else abs(mesh.teeth[1] / mesh.teeth[0]))
        return drives, on_driver, speeds[0] if drives else speeds[1]

    def on_gear(self, stages: list[Stage], gear: Component) -> list[float]:
        """Torques on a gear by its mates about +u [N m]; bevel stages, behind the cylindrical ones, have none here."""
        return [
            torque * (teeth / mesh.teeth[0])
            for stage, mesh, torque in zip(stages, self.meshes, self.driven.mesh_torque, strict=False)
            for one, teeth in zip(stage.gears, mesh.teeth, strict=True)
            if one.id == gear.id
        ]

    def left_by(self, stages: list[Stage], gears: list[Component]) -> bool:
        """Whether some gears, those on one shaft, leave a torque about its axis."""
        parts = [torque for gear in gears for torque in self.on_gear(stages, gear)]
        return abs(sum(parts)) > 1e-9 * max(map(abs, parts), default=0.0)

    def push(self, said: Said, stages: list[Stage], gears: list[Component]) -> float:
        """Force of the meshes of some gears along +u [N]: normal to teeth that wind right-handed about it."""
        force = 0.0
        for gear in gears:
            helix = said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
            # tan of the helix over the reference radius
            lead = 2.0 * math.sin(helix) / (module_of(said, gear) * abs(teeth_of(said, gear)))
            force -= sum(self.on_gear(stages, gear)) * lead
        return force
