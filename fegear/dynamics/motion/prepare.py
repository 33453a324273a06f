"""Equations of motion, compiled ahead of runs: ``python -m fegear.dynamics.motion.prepare`` in the set-up."""

from __future__ import annotations

import math

from fegear.dynamics.motion.motion import propagate, static_state
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Torque, Train


def prepare() -> None:
    """Move two discs in mesh for an instant: machine code is made for all trains, and kept on disk."""
    radius, stiffness = 0.05, 2e8
    train = Train(
        (Body("1", 2e-3), Body("2", 2e-3)),
        meshes=(Mesh("g", "1", "2", radius, radius, 30, 30, stiffness, 100.0, math.inf),),
        torques=(Torque("1", 25.0), Torque("2", 25.0)),
    )
    constant = MeshExcitation.from_mesh(Periodic.constant(stiffness), Periodic.constant(0.0))
    packed = pack(MotionModel(train, (constant,), 100.0))
    propagate(packed, *static_state(packed), 1e-3)


if __name__ == "__main__":
    prepare()
