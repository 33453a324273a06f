"""Lines of torque ripple in the spectrum of a mesh force as they are tabulated and drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Complex
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.torque_response import RippleSpectrum


@dataclass(frozen=True)
class DrawnLines:
    """Lines of one exciter: uprights over frequency at one speed, points over frequency and speed at several."""

    name: str
    role: str
    notes: tuple[str, ...]
    frequency: Array = shown("kHz", "frequency")
    amplitude: Array = shown("N", "force amplitude")
    speed: Array = shown("rpm", "speed", default_factory=lambda: np.empty(0))
    numbers: tuple[str, ...] = field(default=())


@dataclass(frozen=True)
class Strongest:
    """Largest line and root mean square of what one exciter does to a mesh at one speed."""

    source: str
    where: str
    largest: float = shown("N", "amplitude of the largest line")
    rms: float = shown("N", "root mean square of all spectral lines")


@dataclass(frozen=True)
class RippleLines:
    """Lines of torque ripple in one mesh, a row for each line and speed, the speed fastest."""

    found: RippleSpectrum
    train: GearTrain
    mesh: int

    @cached_property
    def whose(self) -> NDArray[np.int64]:
        """Number of the ripple of every row."""
        return np.repeat(self.found.of, self.found.speeds.size)

    @property
    def n(self) -> NDArray[np.int64]:
        """Harmonic of the ripple."""
        return np.repeat(self.found.harmonics, self.found.speeds.size)

    @property
    @shows("", "exciting torque ripple")
    def ripple(self) -> NDArray[np.str_]:
        """Names."""
        return np.array([self.found.ripple[k].name for k in self.whose], dtype=str)

    @property
    @shows("", "body on which it acts")
    def body(self) -> NDArray[np.str_]:
        """Names."""
        return np.array([self.found.ripple[k].body for k in self.whose], dtype=str)

    @property
    @shows("rpm", "speed")
    def speed(self) -> Array:
        """Of the body that speeds refer to [rad/s]."""
        return np.tile(self.found.speeds * self.train.speed_ratio, len(self.found.of))

    @property
    def frequency(self) -> Array:
        """[Hz]."""
        return self.found.frequencies.ravel()

    @property
    @shows("N.m", "0-peak")
    def torque(self) -> Array:
        """[N m]."""
        return np.repeat(np.abs(self.found.torques), self.found.speeds.size)

    @property
    @shows("deg", "phase of the torque (cosine) at time zero", name="phase")
    def torque_phase(self) -> Array:
        """[rad]."""
        return np.repeat(np.angle(self.found.torques), self.found.speeds.size)

    @property
    def _carried(self) -> Complex:
        return self.found.forces[self.mesh].ravel()

    @property
    @shows("N", "0-peak")
    def force(self) -> Array:
        """[N]."""
        return np.abs(self._carried)

    @property
    @shows("deg", "phase of the force (cosine) at time zero")
    def phase(self) -> Array:
        """[rad]."""
        return np.angle(self._carried)

    @property
    def power(self) -> Array:
        """[N^2]."""
        return self.found.power_lines[self.mesh].ravel()

    @property
    def strongest(self) -> list[Strongest]:
        """Of each ripple."""
        found = []
        for k, one in enumerate(self.found.ripple):
            own = self.force[self.whose == k]
            harmonic = f", its harmonic {one.harmonics[int(np.argmax(own))]}" if own.size > 1 else ""
            rms = math.sqrt(0.5 * float(np.sum(own**2)))
            found.append(Strongest(one.name, f"torque ripple {one.name}{harmonic}", float(own.max()), rms))
        return found

    def _drawn(self, k: int, name: str, notes: list[str], which: NDArray[np.bool_]) -> DrawnLines:
        role, kept = f"series:{len(self.train.names) + k}", np.flatnonzero(which)
        return DrawnLines(
            name, role, tuple(notes[i] for i in kept), self.frequency[kept], self.force[kept], self.speed[kept]
        )  # fmt: skip

    @property
    def stems(self) -> list[DrawnLines]:
        """Lines at the one speed, each ripple a series of its own after those of the meshes."""
        notes = [f"harmonic {n}" for n in self.n]
        return [
            self._drawn(k, f"from torque ripple {one.name}", notes, (self.whose == k) & (self.force > 0.0))
            for k, one in enumerate(self.found.ripple)
        ]

    @property
    def points(self) -> list[DrawnLines]:
        """Lines over speed."""
        notes = [f"{force:.4g} N" for force in self.force]
        return [
            self._drawn(k, f"torque ripple {one.name}", notes, self.whose == k)
            for k, one in enumerate(self.found.ripple)
        ]
