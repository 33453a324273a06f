"""How the planets of a set share the torque over a mesh cycle: floating members, pin errors, teeth that part.

Statics: every tooth pair is a one-sided spring at its place on the path, each mesh delayed by its phase.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown, shows
from fegear.dynamics.planetary.one_sided import equilibrium
from fegear.dynamics.planetary.phases import common_parts
from fegear.dynamics.planetary.planet_set import CENTRALS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Complex
    from fegear.dynamics.planetary.phases import Phases
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_model import SetModel
    from fegear.dynamics.train.excitation import MeshExcitation

#: Gauss points of each piece between break points, and pieces above which two of them do.
_POINTS, _MANY = 4, 150
#: Positions between two break points at least, where there are few of them.
_FINEST = 1.0 / 48.0


@dataclass(frozen=True)
class MeshedSet:
    """A set with the teeth of its meshes and the torque that it carries.

    Parameters
    ----------
    model : SetModel
    sun, ring : MeshExcitation
        Teeth of the first planet's meshes, as springs over the base pitch.
    phases : Phases
    sun_torque : float
        Size of the torque on the sun [N m].
    driving : {"sun", "ring", "carrier"}
        Whose rotation the transmission error is; the other two do not turn.
    """

    model: SetModel
    sun: MeshExcitation
    ring: MeshExcitation
    phases: Phases
    sun_torque: float
    driving: Central

    def __post_init__(self) -> None:
        """Refuse teeth that differ from one another, and torques that carry nothing."""
        if not (math.isfinite(self.sun_torque) and self.sun_torque > 0.0):
            raise RangeError("torque", self.sun_torque, "must be positive and finite")
        for name, one in (("sun", self.sun), ("ring", self.ring)):
            if any(part.pitches != 1 for part in (*one.stiffness, *one.separation)):
                raise InputError(name, "spacing errors", "are not known to a planetary set: teeth must be alike")

    @property
    def teeth(self) -> tuple[MeshExcitation, MeshExcitation]:
        """Of the sun's and of the ring's mesh."""
        return self.sun, self.ring

    @property
    def mean_force(self) -> float:
        """Force in every mesh where all planets carry alike [N]."""
        return self.sun_torque / (self.model.found.base_radius("sun") * self.model.count)

    @cached_property
    def delays(self) -> Array:
        """Of every mesh behind the first planet's with the sun [base pitches], shape (2, planets)."""
        return self.phases.delays

    def positions(self) -> tuple[Array, Array]:
        """Gauss points of a mesh cycle and their weights [base pitches], shapes (M,).

        Break points of the teeth are ends of pieces, and the whole grid repeats after the common part of all delays:
        what the phases cancel then cancels in the sums as well, to round-off.
        """
        parts = common_parts(self.model.found)
        cuts = [np.arange(0.0, 1.0, _FINEST)]
        for mesh, one in enumerate(self.teeth):
            own = np.unique(np.concatenate([part.breaks for part in (*one.stiffness, *one.separation)]))
            cuts.append((own[:, None] + self.delays[mesh]).ravel())
        first = np.sort(np.concatenate(cuts) % (1.0 / parts))
        first = first[np.append(True, np.diff(first) > 1e-9)]
        starts = (first[None, :] + np.arange(parts)[:, None] / parts).ravel()
        lengths = np.diff(np.append(starts, starts[0] + 1.0))
        points, weights = np.polynomial.legendre.leggauss(_POINTS if starts.size <= _MANY else 2)
        s = starts[:, None] + 0.5 * lengths[:, None] * (1.0 + points)
        return s.ravel(), (0.5 * lengths[:, None] * weights).ravel()

    def springs(self, s: Array) -> tuple[Array, Array, NDArray[np.intp]]:
        """One-sided springs at places of the cycle: stiffness and separation, shapes (M, springs), mesh and planet.

        The last has shape (springs, 2).
        """
        stiffness, separation, owner = [], [], []
        for mesh, one in enumerate(self.teeth):
            for n in range(self.model.count):
                at = s + one.phase - self.delays[mesh, n]
                stiffness += [part(at) for part in one.stiffness]
                separation += [part(at) for part in one.separation]
                owner += [(mesh, n)] * len(one.stiffness)
        return np.array(stiffness).T, np.array(separation).T, np.array(owner, dtype=np.intp)


@dataclass(frozen=True)
class PlanetLoads:
    """Loads in a set over a mesh cycle, quasi-static.

    Parameters
    ----------
    meshed : MeshedSet
    weights : ndarray, shape (M,)
        Shares of the cycle that the places stand for.
    mesh_force : ndarray, shape (2, planets, M)
        At sun (0) and ring (1) [N]. Without inertia and friction both are alike.
    pin_force : ndarray, shape (2, planets, M)
        On each planet by its pin, radially outward and counter-clockwise [N].
    member_force : ndarray, shape (members, 2, M)
        On sun, ring and carrier by the planets, in x and y of the carrier [N].
    displacement : ndarray, shape (members, 2, M)
        Of sun, ring and carrier in x and y [m].
    s : ndarray, shape (M,)
        Places in the cycle [base pitches].
    te : ndarray, shape (M,)
        How far the driving member turns ahead of the rigid motion, as a length at its base circle (of the carrier: at
        the pins) [m].
    """

    meshed: MeshedSet
    weights: Array
    mesh_force: Array
    pin_force: Array
    member_force: Array
    displacement: Array
    s: Array = shown("", "place in the mesh cycle, in base pitches of the first planet's mesh with the sun")
    te: Array = shown("um", "transmission error of the set: of the driving member, at its base circle or the pins")

    @property
    def mean_force(self) -> float:
        """Force in every mesh where all planets carry alike [N]."""
        return self.meshed.mean_force

    @cached_property
    @shows("", "load of each planet over that of an equal share, mean of the cycle")
    def shares(self) -> Array:
        """Shape (planets,)."""
        return np.asarray(self.mesh_force[0] @ self.weights / self.mean_force)

    @property
    @shows("", "largest load of a planet over an equal share, mean of the cycle: K_gamma of the rating", name="K_gamma")
    def mesh_load_factor(self) -> float:
        """K_gamma."""
        return float(self.shares.max())

    @property
    @shows("", "largest load of a planet over an equal share, at any place in the cycle")
    def largest_share(self) -> float:
        """Its largest value over the cycle."""
        return float(self.mesh_force.max()) / self.mean_force

    @property
    @shows("um", "transmission error of the set, peak to peak")
    def te_peak_to_peak(self) -> float:
        """Largest less smallest over the cycle [m]."""
        return float(np.ptp(self.te))

    @property
    @shows("um", "transmission error of the set, mean of the cycle")
    def te_mean(self) -> float:
        """Mean of the cycle [m]."""
        return float(self.te @ self.weights)

    @property
    def lifted(self) -> Array:
        """Share of the cycle in which each mesh has no contact, shape (2, planets)."""
        return np.asarray((self.mesh_force <= 0.0) @ self.weights)

    def harmonics(self, values: Array, orders: Array) -> Complex:
        """Fourier coefficients of something over the cycle, its last axis: sum alpha_l exp(2 pi i l s)."""
        turn = np.exp(-2j * math.pi * np.outer(self.s, orders))
        return np.asarray((values * self.weights) @ turn)


def planet_loads(meshed: MeshedSet, pin_errors: Array | None = None) -> PlanetLoads:
    """Equilibrium of a set over a mesh cycle.

    Parameters
    ----------
    meshed : MeshedSet
    pin_errors : ndarray, shape (2, planets), optional
        How far each pin stands from its place, radially outward and counter-clockwise [m].

    Raises
    ------
    ConvergenceError
        If the planets find no equilibrium.
    """
    model = meshed.model
    sense = -1.0 if model.mirrored else 1.0
    errors = np.zeros((2, model.count)) if pin_errors is None else np.array(pin_errors, dtype=float)
    if errors.shape != (2, model.count):
        raise InputError("pin_errors", errors.shape, f"must be {model.count} radial and {model.count} tangential ones")
    errors[1] *= sense
    free = model.freed(member for member in CENTRALS if member != meshed.driving)
    start = model.with_pin_errors(errors)
    s, weights = meshed.positions()
    stiffness, separation, owner = meshed.springs(s)
    rows = model.mesh_rows[owner[:, 0], owner[:, 1]]
    load = model.torque_load(meshed.sun_torque)
    pins = model.pin_rows.reshape(-1, model.size)
    if math.isfinite(model.planet.pin):
        load = load - model.planet.pin * errors.ravel() @ pins
    z = equilibrium(
        free.T @ model.held_stiffness() @ free, rows @ free, stiffness, separation - rows @ start, load @ free
    )
    q = start + z @ free.T
    force = stiffness * np.maximum(q @ rows.T - separation, 0.0)
    mesh = np.zeros((2, model.count, s.size))
    np.add.at(mesh, (owner[:, 0], owner[:, 1]), force.T)
    # a planet is held by its pin against both meshes
    pushed = np.einsum("anm,ani->mi", mesh, model.mesh_rows)
    planets = pushed[:, 9:].reshape(-1, model.count, 3)[:, :, :2].transpose(2, 1, 0).copy()
    members = -pushed[:, :6].reshape(-1, 2, 3)[:, :, :2].transpose(1, 2, 0)
    carrier = -np.einsum("anm,ani->im", planets, model.pin_rows[:, :, 6:8])
    moved = q[:, :9].reshape(-1, 3, 3)[:, :, :2].transpose(1, 2, 0).copy()
    forces = np.concatenate([members, carrier[None]])
    for one in (planets, forces.swapaxes(0, 1), moved.swapaxes(0, 1)):
        one[1] *= sense
    driven = q[:, 3 * CENTRALS.index(meshed.driving) + 2]
    return PlanetLoads(
        meshed, weights, mesh, planets, forces, moved, s, driven * (-1.0 if meshed.driving == "carrier" else 1.0)
    )


def force_on(loads: PlanetLoads, member: Central) -> Array:
    """Force on a member by the planets over the cycle, x and y in the carrier [N], shape (2, M)."""
    return np.asarray(loads.member_force[CENTRALS.index(member)])
