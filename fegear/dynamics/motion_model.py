"""A gear train at one speed with what its gear pairs do to it: what moves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.matrices import static_forces
from fegear.errors import InputError, RangeError

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.train import Train


@dataclass(frozen=True)
class MotionModel:
    """A gear train at one speed with what its gear pairs do to it.

    Parameters
    ----------
    train : Train
        The train; its torques set the mean load.
    excitations : tuple of MeshExcitation
        One for each gear pair.
    speed : float
        Speed of the first body [rad/s], positive.
    loss_taken_by : str
        Body whose torque makes up for the mean friction loss (by default the one of the train's last torque).
    """

    train: Train
    excitations: tuple[MeshExcitation, ...]
    speed: float
    loss_taken_by: str = ""

    def __post_init__(self) -> None:
        if len(self.excitations) != len(self.train.meshes):
            raise InputError(
                "excitations", len(self.excitations), f"must be {len(self.train.meshes)}, one per gear pair"
            )
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise RangeError("speed", self.speed, "must be positive", "at standstill the static answer holds")
        for index, mesh in enumerate(self.train.meshes):
            if self.static[index] < -1e-9 * float(np.max(np.abs(self.static))):
                raise InputError(
                    f"mesh.{mesh.name}", f"{self.static[index]:.6g} N", "is a mean force that parts the teeth",
                    "turn the torques round, or the signs of both base radii",
                )  # fmt: skip

    def at_speed(self, speed: float) -> MotionModel:
        """The same train at another speed [rad/s]."""
        return replace(self, speed=speed)

    @cached_property
    def static(self) -> Array:
        """Mean mesh forces [N]."""
        return static_forces(self.train)

    @cached_property
    def mesh_periods(self) -> tuple[Fraction, ...]:
        """Period of each gear pair's excitation in turns of the first body."""
        return tuple(
            Fraction(math.lcm(*(f.pitches for f in (*e.stiffness, *e.separation)))) / order
            for e, order in zip(self.excitations, self.train.mesh_orders, strict=True)
        )

    @cached_property
    def period(self) -> float:
        """Common period of all excitations [s]."""
        parts = self.mesh_periods
        turns = Fraction(math.lcm(*(p.numerator for p in parts)), math.gcd(*(p.denominator for p in parts)))
        return float(turns) * 2.0 * math.pi / self.speed


def friction_loss_torque(model: MotionModel) -> Array:
    """Torque that makes up for the mean tooth friction under static tooth loads [N m], shape (size,).

    Raises
    ------
    InputError
        If the friction of a gear pair would drive the train: it was made for the other body driving.
    """
    train = model.train
    extra = np.zeros(train.size)
    loss = 0.0
    for m, (mesh, excitation) in enumerate(zip(train.meshes, model.excitations, strict=True)):
        if not excitation.friction:
            continue
        s = (np.arange(512) + 0.5) / 512
        error = excitation.approach(model.static[m], s)
        ratio_a, ratio_b = train.ratios[train.dof[mesh.a]], train.ratios[train.dof[mesh.b]]
        own = 0.0
        for slot, (on_a, on_b) in enumerate(excitation.friction):
            force = excitation.tooth_force(slot, s, error)
            own += float(np.mean(force * (ratio_a * on_a(s) + ratio_b * on_b(s))))
        if own > 0.0:
            raise InputError(
                f"mesh.{mesh.name}.friction", f"{own:.6g} W per rad/s", "feeds power into the train: the torques make "
                "the other body drive", "give with_friction the side that train_mesh.a_drives returns",
            )  # fmt: skip
        loss += own
    if loss != 0.0:
        body = model.loss_taken_by or train.torques[-1].body
        if body not in train.dof:
            raise InputError("loss_taken_by", body, "is no body of this train")
        extra[train.dof[body]] = -loss / train.ratios[train.dof[body]]
    return extra
