"""How far the force of a linearised mesh falls below zero: what contact loss would take away."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.dynamics.spectra import mesh_force_spectrum

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.arrays import Array
    from fegear.dynamics.gear_train import GearTrain


class Pull(NamedTuple):
    """Smallest linearised force of a mesh over some speeds.

    Attributes
    ----------
    mesh : str
    force : float
        Below zero [N].
    share : float
        Its size over the mean force: the amplitude of the dynamic mesh deflection exceeds the static one by as much.
    speed : float
        Of the body that speeds refer to, where it is smallest [rad/s].
    speed_of : str
        That body.
    """

    mesh: str
    force: float
    share: float
    speed: float
    speed_of: str


def mesh_force_range(data: GearTrain, i: int, speed: float, harmonics: int) -> tuple[float, float]:
    """Smallest and largest force of mesh `i` at a speed of the first body [rad/s], others at their worst phase."""
    found = mesh_force_spectrum(data.train, data.errors, [speed], harmonics, rotational=True)
    size = 16 * found.orders.size
    spectra = [np.concatenate([[0.0], found.coefficients[i, j, :, 0]]) for j in range(len(data.names))]
    parts = [size * np.fft.irfft(np.pad(row, (0, size // 2 + 1 - row.size)), size) for row in spectra]
    mean = float(data.forces[i])
    return mean + sum(float(p.min()) for p in parts), mean + sum(float(p.max()) for p in parts)


def largest_pull(data: GearTrain, i: int, speeds: Sequence[float] | Array, harmonics: int) -> Pull | None:
    """Where the linearised force of mesh `i` falls furthest below zero over speeds; None where it never does.

    Parameters
    ----------
    data : GearTrain
    i : int
        Number of the mesh.
    speeds : sequence of float
        Of the first body [rad/s].
    harmonics : int
    """
    least = [mesh_force_range(data, i, float(speed), harmonics)[0] for speed in speeds]
    mean, worst = float(data.forces[i]), int(np.argmin(least))
    if not mean > 0.0 > least[worst]:
        return None
    return Pull(
        data.names[i], least[worst], -least[worst] / mean, float(speeds[worst]) * data.speed_ratio, data.speed_of
    )
