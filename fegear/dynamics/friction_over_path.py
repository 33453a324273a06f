"""Tooth friction over the path of contact: coefficient, torques on both gears, and the power that it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.friction import sliding_contact
from fegear.dynamics.mesh_excitation import FIT
from fegear.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Array
    from fegear.dynamics.train_mesh import TrainMesh

#: Gauss points between neighbouring kinks of what is integrated; half of them for the estimate of the error.
_GAUSS = 32
#: How far from a jump it is looked at [base pitches].
_BESIDE = 1e-9


@dataclass(frozen=True)
class FrictionOverPath:
    """Friction on one tooth pair from its first to its last contact under the static load; arrays of shape (N,).

    Parameters
    ----------
    x : ndarray
        Position on the line of action, toward the tip of the gear that drives [m]; two beside each jump.
    load : ndarray
        Static force on the tooth pair [N].
    sliding, rolling : ndarray
        Speed of the driver's flank less that of the driven one, and their sum [m/s].
    coefficient : ndarray
    torque_driver, torque_driven : ndarray
        Of this pair's friction on both gears [N m]; positive turns a gear on, as T_f1 and T_f2 of TM-100180.
    total_driver, total_driven : ndarray
        Of all pairs in contact then [N m].
    loss, loss_error : float
        Mean power that friction takes [W], and its error: of the integration and of the fitted teeth.
    mean_coefficient : float
        That would take as much, were it the same everywhere.
    power : float
        That the mesh transmits [W].
    """

    x: Array
    load: Array
    sliding: Array
    rolling: Array
    coefficient: Array
    torque_driver: Array
    torque_driven: Array
    total_driver: Array
    total_driven: Array
    loss: float
    loss_error: float
    mean_coefficient: float
    power: float


def friction_over_path(
    mesh: TrainMesh, frequency: float, coefficient: Callable[[Array, Array, Array], Array], positions: int = 201
) -> FrictionOverPath:
    """Follow a tooth pair over its path (TM-100180, Figs. 5 and 6).

    Parameters
    ----------
    mesh : TrainMesh
        Its tooth pairs stand alone.
    frequency : float
        Tooth-mesh frequency [Hz].
    coefficient : callable
        From sliding speed [m/s], sum of the rolling speeds [m/s] and tooth force [N], arrays.
    positions : int
        Over the path; two more beside each jump of the load and beside the pitch point.

    Raises
    ------
    InputError
        If the excitation is one spring for the whole gear pair.
    """
    if not mesh.excitation.slotted:
        raise InputError("friction", "one spring per gear pair", "needs tooth pairs, each at its place on the path")
    pair, pitch = mesh.pair, mesh.pair.base_pitch
    speed = frequency * pitch
    pitches, kinks = _kinks(mesh)
    ends = pair.x_start / pitch, pair.x_end / pitch
    turns = np.arange(math.floor(ends[0] / pitches), math.ceil(ends[1] / pitches) + 1) * pitches
    inside = (kinks[None, :] + turns[:, None]).ravel()
    cuts = _distinct(np.array([*ends, *inside[(inside > ends[0]) & (inside < ends[1])]]))
    shares = np.diff(cuts) / (ends[1] - ends[0])
    place = np.concatenate(
        [_between(a, b, round(positions * share)) for (a, b), share in zip(pairwise(cuts), shares, strict=True)]
    )
    slots = _on_slots(mesh, speed, coefficient, place)
    own = np.floor(place).astype(int) - mesh.excitation.first_slot
    load, sliding, rolling, mu, *own_torques = slots[own, :, np.arange(place.size)].T
    total = slots[:, 4:].sum(axis=0)
    turn = speed / pair.driver.base_radius, speed / pair.driven.base_radius

    def loss(count: int, law: Callable[[Array, Array, Array], Array]) -> float:
        node, weight = np.polynomial.legendre.leggauss(count)
        power = 0.0
        for a, b in pairwise(kinks):
            at = 0.5 * (a + b) + 0.5 * (b - a) * node
            on_driver, on_driven = _on_slots(mesh, speed, law, at)[:, 4:].sum(axis=0)
            power -= 0.5 * (b - a) * float(weight @ (on_driver * turn[0] + on_driven * turn[1]))
        return power / pitches

    exact = loss(_GAUSS, coefficient)
    # two rules integrate the same fitted teeth: they cannot see what the fit leaves
    error = abs(exact - loss(_GAUSS // 2, coefficient)) + FIT * abs(exact)
    return FrictionOverPath(
        place * pitch, load, sliding, rolling, mu, own_torques[0], own_torques[1], total[0], total[1], exact,
        error, exact / loss(_GAUSS, lambda v, _r, _w: np.ones_like(v)), mesh.force * speed,
    )  # fmt: skip


def _on_slots(
    mesh: TrainMesh, speed: float, coefficient: Callable[[Array, Array, Array], Array], phase: Array
) -> Array:
    """Load, sliding, rolling, coefficient and both torques of the tooth pair in each slot, shape (slots, 6, N)."""
    excitation, pair = mesh.excitation, mesh.pair
    approach, rows = excitation.approach(mesh.force, phase), []
    for slot in range(len(excitation.stiffness)):
        load = excitation.tooth_force(slot, phase, approach)
        at = sliding_contact(
            excitation.place(slot, phase) * pair.base_pitch, pair.driver.base_radius, pair.driven.base_radius,
            pair.working_pressure_angle, speed,
        )  # fmt: skip
        mu = coefficient(np.abs(at.sliding), at.rolling, load)
        rub = np.sign(at.sliding) * mu * load
        rows.append([load, at.sliding, at.rolling, mu, -rub * at.arm_driver, rub * at.arm_driven])
    return np.array(rows)


def _kinks(mesh: TrainMesh) -> tuple[int, Array]:
    """Base pitches after which all repeats, and the phases at which loads or sliding have a kink, both ends included.

    Sliding turns at the pitch point, which is the end of a slot: every whole phase.
    """
    parts = (*mesh.excitation.stiffness, *mesh.excitation.separation)
    pitches = math.lcm(*(part.pitches for part in parts))
    found = [part.breaks_over(pitches) for part in parts]
    changes = mesh.excitation.contact_changes(mesh.force)
    return pitches, _distinct(np.concatenate([*found, np.array(changes), np.arange(pitches + 1.0)]))


def _between(a: float, b: float, count: int) -> Array:
    """Places between two kinks, close together beside them: at the pitch point the coefficient has a tip."""
    middle, half = 0.5 * (a + b), 0.5 * (b - a) - _BESIDE
    return np.asarray(middle - half * np.cos(math.pi * np.linspace(0.0, 1.0, max(3, count))))


def _distinct(places: Array) -> Array:
    """Rising, without any that lie on each other."""
    rising = np.unique(places)
    return rising[np.append(True, np.diff(rising) > 4.0 * _BESIDE)]
