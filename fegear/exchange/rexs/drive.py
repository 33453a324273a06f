"""How torque and speed go through a gearbox: from what is given on some shafts to all meshes.

Shafts that couplings join turn as one body. Torques in balance on every body, tooth forces equal on both gears of
a stage, and Willis's equation of every planetary set are linear; speeds that they do not determine stay unknown, what
contradicts them is refused.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.base.arrays import Array, Mask

#: Data may contradict each other by so much of the largest: they are often given with four digits.
_MISS = 1e-3


@dataclass(frozen=True, slots=True)
class Mesh:
    """Two gears in mesh.

    Parameters
    ----------
    bodies : (int, int)
        That the gears stand on.
    teeth : (int, int)
        Those of a ring gear are negative.
    """

    bodies: tuple[int, int]
    teeth: tuple[int, int]


@dataclass(frozen=True, slots=True)
class PlanetSet:
    """Bodies of sun, ring and carrier, and teeth of sun and ring, all positive."""

    sun: int
    ring: int
    carrier: int
    teeth: tuple[int, int]


@dataclass(frozen=True, slots=True)
class Torque:
    """A torque from outside on a body; None where it balances what is given elsewhere."""

    body: int
    value: float | None


@dataclass(frozen=True, slots=True)
class Driven:
    """What flows through a gearbox; speeds are NaN where they are not determined.

    Parameters
    ----------
    mesh_torque : tuple of float
        On the first gear of each mesh, by its mate [N m].
    set_torque : tuple of float
        On the sun of each planetary set by its planets [N m].
    outside : tuple of float
        Torques from outside, in their order [N m].
    speed : tuple of float
        Of every body [rad/s].
    shared : frozenset of int
        Meshes whose torque balance does not determine: paths beside each other share it as evenly as it allows.
    """

    mesh_torque: tuple[float, ...]
    set_torque: tuple[float, ...]
    outside: tuple[float, ...]
    speed: tuple[float, ...]
    shared: frozenset[int] = frozenset()


def driven(
    bodies: int,
    meshes: Sequence[Mesh],
    sets: Sequence[PlanetSet],
    torques: Sequence[Torque],
    speeds: Mapping[int, float],
    held: Sequence[int] = (),
) -> Driven:
    """Torques of all meshes and speeds of all bodies.

    Parameters
    ----------
    bodies : int
        Their number.
    meshes, sets, torques
    speeds : mapping
        Known speeds of bodies [rad/s].
    held : sequence of int
        Bodies that the casing holds.

    Raises
    ------
    InputError
        If what is given contradicts the teeth.
    """
    unknown = [n for n, one in enumerate(torques) if one.value is None]
    first_set, first_unknown = len(meshes), len(meshes) + len(sets)
    balance = np.zeros((bodies, first_unknown + len(unknown) + len(held)))
    given = np.zeros(bodies)
    for n, mesh in enumerate(meshes):
        balance[mesh.bodies[0], n] += 1.0
        balance[mesh.bodies[1], n] += mesh.teeth[1] / mesh.teeth[0]
    for n, one in enumerate(sets, first_set):
        sun, ring = one.teeth
        for body, share in ((one.sun, 1.0), (one.ring, ring / sun), (one.carrier, -(sun + ring) / sun)):
            balance[body, n] += share
    for column, n in enumerate(unknown, first_unknown):
        balance[torques[n].body, column] += 1.0
    for column, body in enumerate(held, first_unknown + len(unknown)):
        balance[body, column] += 1.0
    for torque in torques:
        given[torque.body] -= torque.value or 0.0
    solved, free = _solved(balance, given, "torque_around_u_axis", "torques not in equilibrium")
    outside = [one.value for one in torques]
    for column, n in enumerate(unknown, first_unknown):
        outside[n] = solved[column]
    return Driven(
        tuple(solved[:first_set]), tuple(solved[first_set:first_unknown]),
        tuple(math.nan if one is None else one for one in outside), _speeds(bodies, meshes, sets, speeds, held),
        frozenset(n for n in range(first_set) if free[n] and math.isfinite(solved[n])),
    )  # fmt: skip


def _speeds(
    bodies: int, meshes: Sequence[Mesh], sets: Sequence[PlanetSet], speeds: Mapping[int, float], held: Sequence[int]
) -> tuple[float, ...]:
    known = {**dict.fromkeys(held, 0.0), **speeds}
    rolling = np.zeros((len(meshes) + len(sets) + len(known), bodies))
    values = np.zeros(len(rolling))
    for row, mesh in zip(rolling, meshes, strict=False):
        for body, teeth in zip(mesh.bodies, mesh.teeth, strict=True):
            row[body] += teeth / max(map(abs, mesh.teeth))
    for row, one in zip(rolling[len(meshes) :], sets, strict=False):
        sun, ring = one.teeth
        for body, share in ((one.sun, sun), (one.ring, ring), (one.carrier, -sun - ring)):
            row[body] += share / (sun + ring)
    for n, (body, speed) in enumerate(known.items(), len(meshes) + len(sets)):
        rolling[n, body], values[n] = 1.0, speed
    solved, free = _solved(rolling, values, "rotational_speed", "speeds inconsistent with the gear ratios")
    return tuple(np.where(free, math.nan, solved))


def _solved(matrix: Array, right: Array, key: str, rule: str) -> tuple[Array, Mask]:
    """The smallest solution, NaN where nothing is given, and what of it is not determined."""
    if not matrix.size or not right.any():
        return np.full(matrix.shape[1], math.nan), np.ones(matrix.shape[1], dtype=bool)
    scale = np.maximum(np.abs(matrix).max(axis=0), 1e-300)
    left, sizes, directions = np.linalg.svd(matrix / scale)
    rank = int((sizes > 1e-10 * sizes[0]).sum())
    found = directions[:rank].T @ ((left[:, :rank].T @ right) / sizes[:rank])
    missed = np.abs(matrix / scale @ found - right).max()
    if missed > _MISS * np.abs(right).max():
        raise InputError(key, f"{missed:.4g} (SI) too much", f"belongs to {rule}", "correct the loads of the model")
    free = np.abs(directions[rank:]).max(axis=0, initial=0.0) > 1e-9
    return found / scale, free
