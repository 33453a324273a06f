"""Tooth friction over the path of contact: coefficient, torques on both gears, and the power that it takes.

TM-100180, Eqs. (17) and (18); the coefficients are in `fegear.dynamics.train.friction_law`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.base.tally import tallied
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.gear_train import TrainMesh
from fegear.dynamics.train.mesh_excitation import FIT
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Mesh
from fegear.formulas.flank_speeds import speeds_on_line

#: Shortest stretch of the base pitch on which friction is resolved; at the pitch point it has a root or a logarithm.
SHORTEST = 1e-3


@tallied("friction fits")
def with_friction(
    excitation: MeshExcitation,
    mesh: Mesh,
    base_pitch: float,
    pressure_angle: float,
    mesh_frequency: float,
    load: float,
    coefficient: Callable[[Array, Array, Array], Array],
    *,
    tolerance: float = 1e-7,
    a_drives: bool = True,
    internal: bool = False,
) -> MeshExcitation:
    """Add tooth friction to a gear pair.

    The friction force is the coefficient times the elastic tooth force at every instant; the coefficient itself is
    taken at the nominal speed and the static tooth load.

    Parameters
    ----------
    excitation : MeshExcitation
        A gear pair in tooth-pair slots (`from_tooth_pair`): friction needs to know where each contact is. Its positions
        count toward the tip of the gear that drives.
    mesh : Mesh
        The gear pair in the train.
    base_pitch, pressure_angle : float
        Base pitch [m] and working pressure angle [rad].
    mesh_frequency, load : float
        Mesh frequency [Hz] and mean mesh force [N].
    coefficient : callable
        Friction coefficient from sliding speed [m/s], sum of rolling speeds [m/s] and static tooth force [N], arrays.
    tolerance : float
        Accuracy of the fitted torques relative to the largest.
    a_drives : bool
        Whether the mesh's body `a` drives, and not body `b` (see `train_mesh.a_drives`).
    internal : bool
        Whether one of the gears is a ring.

    Raises
    ------
    InputError
        If the excitation is one spring for the whole gear pair.
    """
    if not excitation.slotted:
        raise InputError(
            "friction", "one spring per gear pair", "requires tooth pairs with positions on the line of action"
        )
    speed = mesh_frequency * base_pitch  # of the contact along the line of action
    radii = (mesh.radius_a, mesh.radius_b) if a_drives else (mesh.radius_b, mesh.radius_a)
    radius_1, radius_2 = (abs(r) for r in radii)  # of the gear that drives, of the driven one
    if internal:  # the larger gear is the ring
        radius_1, radius_2 = (-radius_1, radius_2) if radius_1 > radius_2 else (radius_1, -radius_2)
    # the gears approach as the driver turns forward and the driven gear back
    sense_1, sense_2 = math.copysign(1.0, radii[0]), -math.copysign(1.0, radii[1])
    kinks = tuple(excitation.contact_changes(load)) if load > 0.0 else ()
    parts = (*excitation.stiffness, *excitation.separation)
    pitches = math.lcm(*(part.pitches for part in parts))
    cuts = np.unique(np.concatenate([*(part.breaks_over(pitches) for part in parts), np.array([*kinks])])) / pitches
    known: dict[bytes, Array] = {}

    def static_force(j: int, phase: Array) -> Array:
        key = phase.tobytes()
        if key not in known:  # the torques of all slots are asked for at the same places
            known[key] = excitation.approach(load, phase)
        return excitation.tooth_force(j, phase, known[key])

    def torque(j: int, phase: Array, *, driver: bool) -> Array:
        at = speeds_on_line(excitation.place(j, phase) * base_pitch, (radius_1, radius_2), pressure_angle, speed)
        bears = np.where(excitation.stiffness[j](phase) > 0.0, 1.0, 0.0)
        mu = coefficient(np.abs(at.sliding), at.sum, static_force(j, phase)) * bears
        slip = np.sign(at.sliding)
        if driver:
            return -slip * mu * np.abs(at.radius_driver) * sense_1
        return slip * mu * np.abs(at.radius_driven) * sense_2

    def fitted(j: int, *, driver: bool) -> Periodic:
        return Periodic.fit(
            lambda s: torque(j, s * pitches, driver=driver), cuts, tolerance=tolerance, pitches=pitches,
            shortest=SHORTEST,
        )  # fmt: skip

    slots = range(len(excitation.stiffness))
    return replace(
        excitation, friction=tuple((fitted(j, driver=a_drives), fitted(j, driver=not a_drives)) for j in slots)
    )


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
        Toward the tip of the gear that drives; two beside each jump.
    """

    x: Array = shown("mm", "position of the tooth pair on the line of action")
    load: Array = shown("N", "static load on the tooth pair")
    sliding: Array = shown("m/s", "sliding velocity", name="sliding_velocity")
    rolling: Array = shown("m/s", "sum velocity", name="rolling_velocity")
    coefficient: Array = shown(name="friction_coefficient", label="friction coefficient")
    torque_driver: Array = shown(
        "N.m", "friction torque of this pair; positive in the direction of rotation", label="torque on the driver"
    )
    torque_driven: Array = shown(
        "N.m", "friction torque of this pair; positive in the direction of rotation", label="torque on the driven"
    )
    total_driver: Array = shown("N.m", "friction torque of all pairs in contact (T_f1)", name="total_torque_driver")
    total_driven: Array = shown("N.m", "friction torque of all pairs in contact (T_f2)", name="total_torque_driven")
    loss: float = shown("W", "mean gear mesh power loss", name="friction_loss")
    loss_error: float = shown("W", "error of integration and tooth fit")
    mean_coefficient: float = shown("", "equivalent constant friction coefficient (same loss)")
    power: float = shown("W", "power transmitted by the mesh")

    @property
    @shows("", "efficiency of the mesh (tooth friction only)")
    def efficiency(self) -> float:
        """Share of the power that tooth friction leaves."""
        return 1.0 - self.loss / self.power


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
        raise InputError(
            "friction", "one spring per gear pair", "requires tooth pairs with positions on the path of contact"
        )
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
    radii = pair.driver.tooth.side * pair.driver.base_radius, pair.driven.tooth.side * pair.driven.base_radius
    approach, rows = excitation.approach(mesh.force, phase), []
    for slot in range(len(excitation.stiffness)):
        load = excitation.tooth_force(slot, phase, approach)
        x = excitation.place(slot, phase) * pair.base_pitch
        at = speeds_on_line(x, radii, pair.working_pressure_angle, speed)
        mu = coefficient(np.abs(at.sliding), at.sum, load)
        rub = np.sign(at.sliding) * mu * load
        arms = np.abs(at.radius_driver), np.abs(at.radius_driven)  # of the friction forces about the gears' axes
        rows.append([load, at.sliding, at.sum, mu, -rub * arms[0], rub * arms[1]])
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
