"""Force on one tooth pair of a train on its way through the mesh: which pair, at which places, at which speed.

The forces on all tooth pairs in contact at one moment, each at its own place, add up to the force in the mesh (Mark,
after Eq. 3.36): the vibration then meets the stiffness of the teeth that are in contact, not its mean.

Root stress of one tooth of either gear under the forces of a moving train.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.effects import RootEffects
from fegear.base.shown import shown
from fegear.contact.plane.compliance import RootStressInfluence
from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.contact.wide.lines import life_of_contact
from fegear.dynamics.train.gear_train import GearTrain
from fegear.dynamics.train.mesh_excitation import tooth_pair_at
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.tooth_force import ToothForce, dynamic_error, tooth_force
from fegear.dynamics.train.torque_response import ripple_increment
from fegear.geometry.pair import GearPair, Member

#: Lines that tooth forces are summed from, at least.
_LINES = 256


#: Places over the path at which the static force of every tooth pair is looked at.
_LOOKED_AT = 101


#: How near to the ends of the path the last positions are, in base pitches.
_INSIDE = 1e-9


#: How far beside a corner of the transmission error places stand [base pitches].
_BESIDE = 1e-7


@dataclass(frozen=True)
class MeshForce:
    """Force in a mesh over one base pitch, all meshes' shares included; arrays of shape (n,).

    The mean stiffness is that of Mark's equations 3.2 to 3.10; time is zero at phase zero.
    """

    phase: Array = shown("", "mesh position, in base pitches")
    time: Array = shown("s", "time from phase zero of the mesh", name="t")
    of_teeth: Array = shown(
        "N", "sum of the tooth pair forces, excited by all meshes", name="force", label="mesh force"
    )
    by_mean_stiffness: Array = shown(
        "N", "mean force plus mean stiffness times the dynamic increments of the transmission error",
        name="force_by_mean_stiffness",
    )  # fmt: skip
    pairs: NDArray[np.integer] = shown("", "tooth pairs in contact")


def summed_harmonics(data: GearTrain, harmonics: int) -> int:
    """Mesh harmonics of a tooth force: 256 lines at least, the rotational ones among them."""
    longest = max(error.pitches for error in data.errors)
    return max(harmonics, -(-_LINES // longest))


def heaviest_pair(data: GearTrain, i: int) -> int:
    """Number of the tooth pair that carries the largest static force; 0 where all teeth are alike."""
    error, pair = data.meshes[i].error, data.meshes[i].pair
    if error.pitches == 1:
        return 0
    x = np.linspace(pair.x_start, pair.x_end, _LOOKED_AT)
    largest = []
    for number in range(error.pitches):
        k, m = tooth_pair_at(data.meshes[i].excitation, x, pair.base_pitch, number)
        largest.append(float(np.max(k * (error(x / pair.base_pitch + number) - m))))
    return int(np.argmax(largest))


def positions(data: GearTrain, i: int, count: int, number: int = 0) -> Array:
    """Places of one tooth pair, of its middle for a helical one: evenly over its path, and beside every jump [m]."""
    pair, found = data.meshes[i].pair, data.meshes[i].excitation
    pitch = pair.base_pitch
    start, end = life_of_contact(pair)
    low, high = start + _INSIDE * pitch, end - _INSIDE * pitch
    functions = (data.meshes[i].error, *found.stiffness)
    cuts = np.concatenate([(f.breaks + j) * f.pitches - number % f.pitches for f in functions for j in range(-4, 5)])
    jumps = _jumps(data.meshes[i].error, np.sort(cuts), (low / pitch, high / pitch), number) * pitch
    return np.unique(np.concatenate([np.linspace(low, high, count), jumps]))


def _jumps(error: Periodic, cuts: Array, ends: tuple[float, float], number: int) -> Array:
    """Places on both sides of true corners of the transmission error [base pitches]; ends of fitted pieces are none.

    What functions have of one corner differs by round-off, and some have an end on either side of it: they are one.
    """
    apart = np.diff(cuts) > 3.0 * _BESIDE
    sides = np.stack([cuts[np.append(True, apart)] - _BESIDE, cuts[np.append(apart, True)] + _BESIDE])
    sides = sides[:, (sides[0] > ends[0]) & (sides[1] < ends[1])]
    slope = error.slope(sides + number)
    kink = np.abs(slope[1] - slope[0]) > 1e-3 * np.max(np.abs(slope), initial=1e-30)
    return np.asarray(sides[:, kink].ravel())


def force_history(data: GearTrain, i: int, speed: float, count: int, harmonics: int, number: int = 0) -> ToothForce:
    """Force on one tooth pair of mesh `i` at a speed of the reference body [rad/s]."""
    return force_at(data, i, speed, positions(data, i, count, number), harmonics, number)


def force_at(
    data: GearTrain, i: int, speed: float, x: Array, harmonics: int, number: int = 0, other_phases: int = 64
) -> ToothForce:
    """Force on tooth pair `number` at places x [m], others at the case's phases; zero off the path of contact."""
    pitch = data.meshes[i].pair.base_pitch
    k, m = tooth_pair_at(data.meshes[i].excitation, x, pitch, number)
    # linear about the mean load: a tooth pair that its modification holds apart at rest is no spring
    k = np.where(data.meshes[i].error(x / pitch + number) > m, k, 0.0)
    return tooth_force(
        data.train, data.errors, i, speed / data.speed_ratio, x, k, m, pitch, number=number, harmonics=harmonics,
        other_phases=other_phases, phases=data.phases, ripple=data.ripple,
    )  # fmt: skip


def mesh_force(data: GearTrain, i: int, speed: float, count: int, harmonics: int, number: int = 0) -> MeshForce:
    """Force in mesh `i` at a speed of the reference body [rad/s], by its teeth and by its mean stiffness.

    Over the base pitch in which tooth pair `number` passes the pitch point and the next one comes there; at `count`
    even phases, and beside those at which pairs enter and leave. Pair j is (phase - j) base pitches past the pitch
    point at the same moment.
    """
    pitch = data.meshes[i].pair.base_pitch
    start, end = (place / pitch for place in life_of_contact(data.meshes[i].pair))
    changes = [(edge + side * _INSIDE) % 1.0 for edge in (start, end) for side in (-1.0, 1.0)]
    phase = number + np.unique([*np.linspace(0.0, 1.0, count), *changes])
    total, pairs = np.zeros(phase.size), np.zeros(phase.size, dtype=int)
    for j in range(math.floor(number - end), math.ceil(number + 1 - start) + 1):
        on = (phase - j > start) & (phase - j < end)
        if on.any():
            tooth = force_at(data, i, speed, (phase[on] - j) * pitch, harmonics, j, other_phases=1)
            total[on] += tooth.with_others
            pairs[on] += tooth.static > 0.0
    time = phase / float(data.train.mesh_frequencies(speed / data.speed_ratio)[i])
    own, others = error_increments(data, i, speed, phase, harmonics)
    linear = data.forces[i] + data.train.meshes[i].stiffness * (own + others)
    return MeshForce(phase, time, total, linear, pairs)


def error_increments(data: GearTrain, i: int, speed: float, phase: Array, harmonics: int) -> tuple[Array, Array]:
    """What vibration adds to the transmission error of mesh `i`: by its own one, and by all that excites it besides.

    Parameters
    ----------
    data : GearTrain
    i : int
    speed : float
        Of the body that speeds refer to [rad/s].
    phase : ndarray, shape (n,)
        Of the mesh [its base pitches]; the others are at those of the case.
    harmonics : int

    Returns
    -------
    own, others : ndarray, shape (n,)
        [m].
    """
    reference, errors, train = speed / data.speed_ratio, data.errors, data.train
    frequency = train.mesh_frequencies(reference)
    own = errors[i].mean - errors[i](phase) + dynamic_error(train, errors, i, i, reference, phase, harmonics)
    others = np.zeros(phase.shape)
    for j, ahead in enumerate(data.phases):
        if j != i:
            at = ahead + (phase - data.phases[i]) * float(frequency[j] / frequency[i])
            others += dynamic_error(train, errors, i, j, reference, at, harmonics)
    since = (phase - data.phases[i]) / float(frequency[i])
    for one in data.ripple:
        found = ripple_increment(train, one, reference, i)
        others += np.real(np.exp(2j * math.pi * np.outer(since, one.frequencies(reference))) @ found)
    return own, others


#: Positions over the flank at which the source's own error is asked for.
_FEW = 9
#: What other meshes add to a force at their worst phases: least and most.
_CROSS = ("cross_least", "cross_reach")


@dataclass(frozen=True)
class ToothRootStress:
    """Largest root tension of one tooth, over the positions of the force on it, shape (n,) [Pa].

    `error` is NaN where the source does not know. Of 3D teeth the largest over the face, and where it is there [m].
    """

    total: Array = shown(
        "MPa",
        "maximum root stress (tension side), excited by all meshes",
        name="stress",
        label="maximum root stress (tension side)",
    )
    any_phase: Array = shown("MPa", "upper bound over all phases of the other meshes", name="stress_any_phase")
    own: Array = shown("MPa", "without the contribution of the other meshes", name="stress_own_mesh")
    static: Array = shown("MPa", "quasi-static", name="static_stress")
    error: Array = shown("MPa", "estimated error of stress_own_mesh", name="stress_error")
    z: Array | None = shown(
        "mm", "face position of the maximum, from mid-face", name="stress_face_position", default=None
    )
    static_z: Array | None = shown(
        "mm", "face position of the quasi-static maximum, from mid-face", name="static_stress_face_position",
        default=None,
    )  # fmt: skip


def tooth_root_stress(
    source: RootStressInfluence,
    pair: GearPair,
    member: Member,
    around: dict[int, ToothForce],
    effects: RootEffects | None = None,
) -> ToothRootStress:
    """Root stress of a tooth under its own force and those on the teeth around it.

    Parameters
    ----------
    source : RootStressInfluence
        Of its gear: `fegear.contact.plane.fe_compliance.finite_element_compliance` or
        `fegear.contact.plane.closed_form_compliance`.
    pair : GearPair
        As it runs.
    member : {"driver", "driven"}
        What the gear is as the pair runs.
    around : mapping of int to ToothForce
        See `forces_around`.
    effects : RootEffects, optional
        On root stress only; by default the usual ones.
    """
    roots = RootStress(source, member, effects=effects or RootEffects())
    rows, width = rows_around(roots, pair, around), pair.face_width
    # No contact hides anything of the fillet of a tooth that carries no load.
    radius = pair.radius(np.clip(around[0].x, pair.x_start, pair.x_end), member)
    touched = np.where((around[0].static != 0.0) | (around[0].with_others != 0.0), radius, np.inf)
    felt = {
        part: [Felt(getattr(force, part) / width, rows[k]) for k, force in around.items()]
        for part in ("with_others", "total", "static")
    }
    least, most = ((getattr(f, part).sum(axis=0) / width for f in around.values()) for part in _CROSS)
    worst = roots.bound(felt["total"], least, most, rows[0].shape)
    with_others, total, static = (
        roots.largest(0, roots.superposed(parts, rows[0].shape), touched) for parts in felt.values()
    )
    return ToothRootStress(
        with_others, roots.largest(0, worst, touched), total, static, _own_error(roots, pair, around[0])
    )


def forces_around(
    train: GearTrain, mesh: int, force: ToothForce, number: int, speed: float, harmonics: int, reach: int
) -> dict[int, ToothForce]:
    """Forces on a tooth pair and on those around it at the same moment, by their place beside it.

    Parameters
    ----------
    train : GearTrain
    mesh : int
    force : ToothForce
        On tooth pair `number`.
    number : int
    speed : float
        Of the body that speeds refer to [rad/s].
    harmonics : int
    reach : int
        How many tooth pairs on either side; 0 for the one alone.
    """
    around = {0: force}
    for k in range(-reach, reach + 1):
        if k:
            # k base pitches ahead at the same moment: it was at the pitch point that much earlier
            ahead = force.x + k * train.meshes[mesh].pair.base_pitch
            around[k] = force_at(train, mesh, speed, ahead, harmonics, number - k)
    return around


def rows_around(roots: RootStress, pair: GearPair, around: Mapping[int, ToothForce]) -> dict[int, Array]:
    """Stress along the fillet of tooth 0 per unit line load on each tooth around it, (n, points) [1/m].

    Parameters
    ----------
    roots : RootStress
    pair : GearPair
        As it runs.
    around : mapping of int to ToothForce
        See `forces_around`.

    Raises
    ------
    InputError
        If the source knows no root stress.
    """
    found = {}
    for k, force in around.items():
        loaded, on_path = roots.tooth(k), np.clip(force.x, pair.x_start, pair.x_end)
        found[k] = roots.known_row(0, loaded, pair.radius(on_path, roots.member))
    return found


def _own_error(roots: RootStress, pair: GearPair, force: ToothForce) -> Array:
    """What the source leaves in the stress of the tooth's own load [Pa]."""
    x = np.linspace(pair.x_start, pair.x_end, _FEW)
    usual = roots.error(0, 0, pair.radius(x, roots.member)) / pair.face_width
    return np.asarray(np.interp(force.x, x, usual) * np.abs(force.total))
