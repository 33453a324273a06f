"""Phases of the meshes of a planetary set described as data, for one way in which it runs.

As in `fegear.dynamics.planetary.phases`: the phase of a mesh is the place of a tooth pair on the line of action in base
pitches, zero at the pitch point. Each planet's mesh lags behind that of the first; meshes that share a gear, and with
it their frequency, lag behind each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown
from fegear.dynamics.compound.assembly import clusters, mesh_turns
from fegear.dynamics.compound.compound_set import End, Shaft

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.dynamics.compound.compound_set import CompoundSet, Toothed
    from fegear.dynamics.compound.speeds_and_torques import Drive

#: A sum of planets below this share of what they are together is cancelled.
_CANCELLED = 1e-9


@dataclass(frozen=True)
class MeshPhases:
    """Delays of one mesh [base pitches].

    Parameters
    ----------
    mesh : str
    planet : ndarray of int, shape (planets,)
    angle : ndarray, shape (planets,)
        Of its planets [rad].
    lag : ndarray, shape (planets,)
        Of each planet's mesh behind that of the first.
    behind : float or None
        Of the first planet's mesh behind that of `reference`.
    reference : str
        First mesh that shares gears with this one, itself where there is none.
    """

    mesh: str
    planet: NDArray[np.intp]
    angle: Array
    lag: Array
    behind: float | None
    reference: str


def mesh_phases(of: CompoundSet, drive: Drive, direction: int = 1) -> tuple[MeshPhases, ...]:
    """Phases of all meshes that roll.

    Parameters
    ----------
    of : CompoundSet
    drive : Drive
    direction : int
        1 where the driving shaft turns counter-clockwise, -1 clockwise. Its torque acts in the same sense.
    """
    found = []
    ahead = _ahead(of, drive, direction)
    parts = clusters(of)
    for number, toothed in enumerate(of.toothed):
        cluster = next(one for one in parts if any(mesh is toothed for mesh in one.meshes))
        turns = np.array(mesh_turns(cluster, [mesh is toothed for mesh in cluster.meshes].index(True)))
        forward = direction * _sign(drive.speed[toothed.planets.name] - drive.speed[toothed.planets.carrier])
        if not forward:
            continue
        at, reference = ahead[number]
        behind = None if at is None else float(_part(at))
        found.append(
            MeshPhases(
                toothed.mesh.name, np.arange(1, turns.size + 1), np.array(toothed.planets.angles),
                _part(-forward * turns), behind, of.meshes[reference].name,
            )
        )  # fmt: skip
    return tuple(found)


def _ahead(of: CompoundSet, drive: Drive, direction: int) -> list[tuple[float | None, int]]:
    """Lag of each mesh of the first planets behind a reference mesh [base pitches], and the reference's number.

    Two meshes k of one gear with z teeth that turns by theta have the phases s z (theta + f_k tau_k - phi_k) / 2 pi:
    s the sense of rotation, f_k = 1 where the flank on the counter-clockwise side of its teeth bears, tau_k half its
    tooth at the working pitch circle, phi_k the direction of the pitch point.
    """
    meshes = of.toothed
    found: list[tuple[float | None, int]] = [(None, k) for k in range(len(meshes))]
    for first in range(len(meshes)):
        if found[first][0] is not None or not drive.tooth[first] or not drive.rolling[first]:
            continue
        found[first] = (0.0, first)
        waiting = [first]
        while waiting:
            one = waiting.pop()
            for other in range(len(meshes)):
                if found[other][0] is not None or not drive.tooth[other]:
                    continue
                lag = _between(of, drive, direction, one, other)
                if lag is not None:
                    found[other] = ((found[one][0] or 0.0) + lag, first)
                    waiting.append(other)
    return found


def _between(of: CompoundSet, drive: Drive, direction: int, one: int, other: int) -> float | None:
    """Lag of a mesh behind another with which it shares a gear [base pitches]; None where they share none."""
    a, b = of.toothed[one], of.toothed[other]
    for end in (0, 1):
        for mate in (0, 1):
            if _end(a, end) != _end(b, mate) or a.planets.carrier != b.planets.carrier:
                continue
            member, wheel = _end(a, end)
            turning = direction * _sign(drive.speed[member] - drive.speed[a.planets.carrier])
            gear = of.wheel(End(member, wheel))
            places = []
            for number, toothed, side in ((one, a, end), (other, b, mate)):
                flank = -direction * _sign(drive.tooth[number]) * (1 if gear.signed > 0 else -1)
                tau = gear.half_tooth(of.working_angle(toothed))
                places.append(flank * tau - _seen(of, toothed, side))
            return turning * gear.teeth * (places[0] - places[1]) / (2.0 * math.pi)
    return None


def _end(toothed: Toothed, number: int) -> End:
    if number == 0:
        return End(toothed.planets.name, toothed.wheel.name)
    return End(toothed.other.name, toothed.other_wheel.name)


def _seen(of: CompoundSet, toothed: Toothed, side: int) -> float:
    """Direction of the pitch point from the planet (0) or the other gear (1) [rad]."""
    angle = of.direction(toothed)
    if side == 0 or toothed.other_wheel.internal:
        return angle
    if isinstance(toothed.other, Shaft):
        return toothed.planets.angles[0]
    return angle + math.pi


def _sign(number: object) -> int:
    return (number > 0) - (number < 0)  # type: ignore[operator]  # any number that can be compared


def _part(pitches: Array | float) -> Array:
    """The part of a phase below one; what is whole but for round-off is zero."""
    part = np.asarray(pitches, dtype=float) % 1.0
    return np.where(np.abs(part - np.rint(part)) < 1e-9, 0.0, part)


@dataclass(frozen=True)
class CompoundPhasing:
    """What each harmonic of one mesh adds up to over its planets.

    Parameters
    ----------
    mesh : str
    harmonic : ndarray of int
    torque, force : ndarray
        Torque on, and force across the axis of, the members that share the axis, over the sum of the planets.
    """

    mesh: str = shown("", "members in mesh")
    harmonic: NDArray[np.intp] = shown("", "mesh harmonic")
    torque: Array = shown("", "resultant torque of all planets relative to the sum of their amplitudes")
    force: Array = shown("", "resultant radial force of all planets relative to the sum of their amplitudes")


def phasing(phases: MeshPhases, harmonics: int) -> CompoundPhasing:
    """Resultants by the phases of a mesh: sums of exp(-2 pi i l lag), turned with the planets for the force."""
    order = np.arange(1, harmonics + 1)
    psi = phases.angle - phases.angle[0]
    turned = np.exp(-2j * np.pi * np.outer(order, phases.lag))
    torque = np.abs(turned.sum(axis=1)) / psi.size
    force = np.maximum(*(np.abs((turned * np.exp(sign * 1j * psi)).sum(axis=1)) for sign in (1.0, -1.0))) / psi.size
    torque, force = (np.where(share < _CANCELLED, 0.0, share) for share in (torque, force))
    return CompoundPhasing(phases.mesh, order, torque, force)
