"""Force and root stress of one tooth: static part, own increment, increments of other meshes (Mark, 3.12 to 3.37).

The dynamic transmission error is summed as (1 + Q) alpha (3.26), which falls like n^-3 and has no jumps, and the
static one is kept exact; the paper's other form (3.29), exact statics plus a truncated increment, rings at every jump.

How far the force of a linearised mesh falls below zero: what contact loss would take away.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.dynamics.train.gear_train import GearTrain
from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.mesh_force_spectrum import mesh_force_spectrum
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.torque_response import ripple_increment
from fegear.dynamics.train.torque_ripple import TorqueRipple
from fegear.dynamics.train.train import Train

#: Harmonics summed at once.
_BLOCK = 256


@dataclass(frozen=True)
class ToothForce:
    """Force on one tooth pair of a mesh through its engagement, shapes (n,) and (meshes + ripple, n) of others' parts.

    Time is zero when the mesh is at phase zero: when tooth pair number 0 is at the pitch point. Numbers of equations
    are those of Mark.
    """

    x: Array = shown("mm", "position of the tooth pair on the line of action")
    time: Array = shown("s", "time from phase zero of the mesh", name="t")
    static: Array = shown("N", "static part")  # (3.30)
    own: Array = shown("N", "from this mesh's transmission error", name="own_increment", label="increment")  # (5.14)
    #: At the phases given (5.15); zero for this mesh itself.
    cross: Array = shown("N", "from the other mesh, at the phases of the case", name="increment")
    cross_reach: Array = shown("N", "maximum increment from the other mesh over all relative phases")
    cross_least: Array = shown("N", "minimum increment from the other mesh over all relative phases")

    @property
    @shows(
        "N", "force on one tooth pair, without the contribution of the other meshes", name="force", label="tooth force"
    )
    def total(self) -> Array:
        """Static force and own increment [N]: what Figs. 22 and 23 of the paper show."""
        return self.static + self.own

    @property
    @shows("N", "including the other meshes, at the phases of the case", name="force_with_others")
    def with_others(self) -> Array:
        """Static force and the increments from all meshes at the phases given [N]."""
        return self.total + np.asarray(self.cross.sum(axis=0))

    @property
    def at_worst_phases(self) -> Array:
        """What the force does not exceed at any relative phases of the other meshes [N]."""
        return self.total + np.asarray(self.cross_reach.sum(axis=0))

    @property
    def cross_peak(self) -> Array:
        """Largest modulus of the increment from each other mesh over the engagement and all relative phases [N]."""
        return np.asarray(np.max(np.maximum(self.cross_reach, -self.cross_least), axis=1))


def dynamic_error(
    train: Train, errors: Sequence[Periodic], i: int, j: int, speed: float, phase: ArrayLike, harmonics: int
) -> Array:
    """Part of the dynamic transmission error [m] of mesh i that mesh j excites, without its mean, at phases of mesh j.

    For i = j the sum of (1 + Q_ii) alpha_n (3.26), for i != j that of Q_ij alpha_n (3.27).
    """
    s = np.asarray(phase, dtype=float) / errors[j].pitches
    n, terms = _terms(train, errors, i, j, speed, harmonics)
    total = np.zeros(s.shape)
    for start in range(0, n.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        total += 2.0 * np.real(np.exp(2j * math.pi * s[..., None] * n[part]) @ terms[part])
    return total


def _terms(
    train: Train, errors: Sequence[Periodic], i: int, j: int, speed: float, harmonics: int
) -> tuple[NDArray[np.integer], NDArray[np.complexfloating]]:
    """Harmonic numbers and complex coefficients of `dynamic_error`."""
    n = np.arange(1, harmonics * errors[j].pitches + 1)
    omega = 2.0 * math.pi * n * float(train.mesh_frequencies(speed)[j]) / errors[j].pitches
    transfer = dynamic_increments(train, omega, [j])[i, 0]
    return n, (1.0 + transfer if i == j else transfer) * errors[j].fourier(n)


def tooth_force(
    train: Train,
    errors: Sequence[Periodic],
    mesh: int,
    speed: float,
    x: ArrayLike,
    stiffness: ArrayLike,
    modification: ArrayLike,
    base_pitch: float,
    *,
    number: int = 0,
    harmonics: int = 256,
    other_phases: int = 64,
    phases: ArrayLike = 0.0,
    ripple: Sequence[TorqueRipple] = (),
) -> ToothForce:
    """Force on one tooth pair of mesh `mesh` over its engagement.

    Parameters
    ----------
    train, errors : Train, sequence of Periodic
        The train and the static transmission error [m] of each mesh, means included, over the phase x/base_pitch.
    mesh : int
        Number of the mesh looked at.
    speed : float
        Speed of the first body [rad/s].
    x, stiffness, modification : array_like, shape (n,)
        Positions of the tooth pair [m]; its local stiffness K_Sj = dW_j/dzeta there [N/m] (Appendix A), zero where it
        carries nothing; the transmission error at which a spring so stiff begins to carry [m]: for a pair that stands
        alone the profile modification of both teeth, positive for material removed.
    base_pitch : float
        Base pitch of this mesh [m].
    number : int
        Which tooth pair: number j is at the pitch point j base pitches after number 0.
    harmonics : int
        Harmonics of the mesh frequency that are summed, with the rotational ones below where teeth are uneven.
    other_phases : int
        Relative phases of the other meshes tried for `cross_reach` and `cross_least`.
    phases : array_like, shape () or (meshes,)
        Phase of each mesh at one and the same moment [its base pitches]; only differences between meshes matter, and
        the moment is the time zero of torque ripple.
    ripple : sequence of TorqueRipple
        Torques that fluctuate: each adds a part as another mesh does.
    """
    place, k, m = (np.array(v, dtype=float) for v in (x, stiffness, modification))
    if not place.shape == k.shape == m.shape or place.ndim != 1:
        raise InputError("tooth_force", (place.shape, k.shape, m.shape), "x, stiffness and modification must match")
    phase = place / base_pitch + number
    frequency = train.mesh_frequencies(speed)
    if not frequency[mesh] > 0.0:
        raise InputError("speed", speed, "must not be zero")
    time = phase / float(frequency[mesh])
    exact = errors[mesh](phase)
    static = k * (exact - m)
    smooth = errors[mesh].mean + dynamic_error(train, errors, mesh, mesh, speed, phase, harmonics)
    own = k * (smooth - exact)
    at_once = np.broadcast_to(np.asarray(phases, dtype=float), (len(errors),))
    since = time - at_once[mesh] / float(frequency[mesh])  # from the moment that the phases hold for
    cross = np.zeros((len(errors) + len(ripple), place.size))
    reach, least = np.zeros_like(cross), np.zeros_like(cross)
    for j in range(len(errors)):
        if j == mesh:
            continue
        n, terms = _terms(train, errors, mesh, j, speed, harmonics)
        other = (at_once[j] + since * float(frequency[j])) / errors[j].pitches
        cross[j], reach[j], least[j] = _at_all_phases(k, other, n, terms, other_phases)
    for j, one in enumerate(ripple, start=len(errors)):
        terms = 0.5 * ripple_increment(train, one, speed, mesh)
        other = since * float(one.base_frequency(speed))
        cross[j], reach[j], least[j] = _at_all_phases(k, other, one.harmonics, terms, other_phases)
    for array in (place, time, static, own, cross, reach, least):
        array.flags.writeable = False
    return ToothForce(place, time, static, own, cross, reach, least)


def _at_all_phases(
    k: Array, phase: Array, n: NDArray[np.integer], terms: NDArray[np.complexfloating], count: int
) -> tuple[Array, Array, Array]:
    """A part of a tooth force at its phases, and its largest and smallest over so many shifts of them, shapes (n,)."""
    found = np.zeros((phase.size, count))
    for start in range(0, n.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        shift = np.exp(2j * math.pi * np.outer(n[part], np.arange(count) / count))
        waves = np.exp(2j * math.pi * np.outer(phase, n[part]))
        found += k[:, None] * 2.0 * np.real(waves @ (terms[part, None] * shift))
    return found[:, 0], found.max(axis=1), found.min(axis=1)


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
    """Smallest and largest force of mesh `i` at a speed of the first body [rad/s], others at their worst phase.

    Torque ripple counts as another mesh does.
    """
    found = mesh_force_spectrum(data.train, data.errors, [speed], harmonics, rotational=True)
    size = 16 * found.orders.size
    spectra = [np.concatenate([[0.0], found.coefficients[i, j, :, 0]]) for j in range(len(data.names))]
    parts = [size * np.fft.irfft(np.pad(row, (0, size // 2 + 1 - row.size)), size) for row in spectra]
    mean = float(data.forces[i])
    low, high = mean + sum(float(p.min()) for p in parts), mean + sum(float(p.max()) for p in parts)
    for one in data.ripple:
        least, most = one.extremes(ripple_increment(data.train, one, speed, i) * data.train.meshes[i].stiffness)
        low, high = low + least, high + most
    return low, high


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
