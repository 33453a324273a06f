"""Resonance of a mesh: the natural mode in which its teeth deform, and the speed at which its harmonics meet it.

The main resonance range is that of ISO 6336-1, within 15 % of the resonance speed; higher harmonics, which excite less,
are near within 5 %, or within the half-power band of the mode, whose half width is its damping ratio, up to 15 %.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown
from fegear.dynamics.train.matrices import damping_matrix
from fegear.dynamics.train.modes import modes

if TYPE_CHECKING:
    from fegear.dynamics.train.gear_train import GearTrain

#: How near a speed is to a resonance of the first harmonic, and of higher ones; how many of these are looked at.
_MAIN, _HIGHER, _HARMONICS = 0.15, 0.05, 10
#: A mode with less of its strain energy in the mesh is none of it.
_LEAST_SHARE = 0.1


@dataclass(frozen=True)
class MeshResonance:
    """Resonance of a mesh, and how near a speed is to one of its harmonics.

    Parameters
    ----------
    harmonic : int
        Of the mesh frequency, the nearest to a mode of the mesh at the given speed.
    at : float
        Speed at which it meets that mode [rad/s].
    off : float
        By how much the given speed is above that, as a share.
    frequency : float
        Of the mode with the largest share of its strain energy in the mesh [Hz].
    speed : float
        At which the mesh frequency meets it [rad/s], of the body that speeds refer to.
    damping : float, default 0
        Damping ratio of the mode that the harmonic is nearest to.
    doubt : float, optional
        Relative error of the compliance of the mesh.
    """

    harmonic: int
    at: float
    off: float
    frequency: float = shown(
        "Hz", "natural frequency of the mesh (undamped, mean stiffness)", name="mesh_natural_frequency"
    )
    speed: float = shown("rpm", "speed at which the mesh frequency meets it", name="resonance_speed")
    damping: float = 0.0
    doubt: float | None = None

    @property
    def frequency_error(self) -> float | None:
        """Estimated [Hz]: half of the error of the compliance."""
        return None if self.doubt is None else 0.5 * self.doubt * self.frequency

    @property
    def speed_error(self) -> float | None:
        """Estimated [rad/s]."""
        return None if self.doubt is None else 0.5 * self.doubt * self.speed

    @property
    def near(self) -> bool:
        """Whether the speed is near to a resonance."""
        band = _MAIN if self.harmonic == 1 else max(_HIGHER, min(self.damping, _MAIN))
        return abs(self.off) <= band


def mesh_resonance(data: GearTrain, mesh: int, speed: float) -> MeshResonance | None:
    """Resonance of a mesh and what a speed of the body that speeds refer to [rad/s] has to do with it.

    None where no mode has a tenth of its strain energy in the mesh.
    """
    found = modes(data.train)
    share = found.mesh_energy[:, mesh]
    own = np.flatnonzero(share >= _LEAST_SHARE)
    if not own.size:
        return None
    order = float(data.train.mesh_orders[mesh])
    first = 2.0 * math.pi * found.frequencies / order * data.speed_ratio
    main = int(np.argmax(share))
    harmonic, mode = min(
        ((h, k) for k in own for h in range(1, _HARMONICS + 1)),
        key=lambda one: abs(speed * one[0] / first[one[1]] - 1.0),
    )
    at, shape = float(first[mode] / harmonic), found.shapes[:, mode]
    damping = float(shape @ damping_matrix(data.train) @ shape) / (4.0 * math.pi * float(found.frequencies[mode]))
    frequency, meets = float(found.frequencies[main]), float(first[main])
    return MeshResonance(harmonic, at, speed / at - 1.0, frequency, meets, damping)
