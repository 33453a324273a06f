"""How the planets of a set share the load over a mesh cycle, quasi-static, and the transmission error of the set.

The meshes are one-sided springs at their places (`set_cycle`), each planet's at its phase; pins and bearings are
springs, or hold. Pins may stand off their places. Every number knows its error: by that of the teeth's compliances and
of their law between two forces, to first order, and by the places of the cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.dynamics.planetary.one_sided import equilibrium, guarded, spring_forces, tangent
from fegear.dynamics.planetary.planet_set import CENTRALS, Central
from fegear.dynamics.planetary.set_cycle import MeshedSet, SetCycle

#: Places within a piece at which the polynomial through its points is looked at for its largest value.
_BETWEEN = np.linspace(-1.0, 1.0, 17)


@dataclass(frozen=True)
class PlanetLoads:
    """Loads in a set over a mesh cycle, quasi-static.

    Parameters
    ----------
    cycle : SetCycle
    mesh_force : ndarray, shape (2, planets, M)
        At sun (0) and ring (1) [N]. Without inertia and friction both are alike where flanks are equal.
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
    shifted : tuple of PlanetLoads
        The same with the teeth off by one of their errors each, to first order.
    """

    cycle: SetCycle
    mesh_force: Array
    pin_force: Array
    member_force: Array
    displacement: Array
    s: Array = shown("", "mesh position, in base pitches of the sun mesh of the first planet")
    te: Array = shown(
        "um", "transmission error of the planetary set, at the base circle of the driving member or at the pins"
    )
    shifted: tuple[PlanetLoads, ...] = ()

    @property
    def weights(self) -> Array:
        """Shares of the cycle that the places stand for, shape (M,)."""
        return self.cycle.weights

    @property
    def mean_force(self) -> float:
        """Force in every mesh with the sun where all planets carry alike [N]."""
        return self.cycle.mean_force

    @property
    def on_one_lever(self) -> Array:
        """Mesh forces that the ring's meshes would have at the base radius of the sun's [N], shape of `mesh_force`."""
        return self.mesh_force * np.array([1.0, self.cycle.model.found.ring_lever])[:, None, None]

    @cached_property
    @shows("", "planet load / equal share, mean over the mesh cycle")
    def shares(self) -> Array:
        """Shape (planets,)."""
        return np.asarray(self.mesh_force[0] @ self.weights / self.mean_force)

    @property
    @shows("", "mesh load factor K_gamma: maximum planet load / equal share (mean over the mesh cycle)", name="K_gamma")
    def mesh_load_factor(self) -> float:
        """K_gamma."""
        return float(self.shares.max())

    @property
    @shows("", "maximum planet load / equal share, at any mesh position")
    def largest_share(self) -> float:
        """Its largest value over the cycle."""
        return float(self.on_one_lever.max()) / self.mean_force

    @cached_property
    @shows("N", "maximum mesh force over the mesh cycle")
    def largest_load(self) -> Array:
        """Shape (planets,)."""
        return np.asarray(self.mesh_force[0].max(axis=1))

    @property
    @shows("um", "peak-to-peak transmission error of the planetary set")
    def te_peak_to_peak(self) -> float:
        """Largest less smallest over the cycle [m]."""
        return float(np.ptp(self.te))

    @property
    @shows("um", "mean transmission error of the planetary set")
    def te_mean(self) -> float:
        """Mean of the cycle [m]."""
        return float(self.te @ self.weights)

    @property
    def lifted(self) -> Array:
        """Share of the cycle in which each mesh has no contact, shape (2, planets)."""
        return np.asarray((self.mesh_force <= 0.0) @ self.weights)

    def harmonics(self, values: Array, orders: Array) -> Complex:
        """Fourier coefficients of something over the cycle, its last axis: sum alpha_l exp(2 pi i l s)."""
        return self._series(values, orders, self.weights)

    def _series(self, values: Array, orders: Array, weights: Array) -> Complex:
        turn = np.exp(-2j * math.pi * np.outer(self.s, orders))
        return np.asarray((values * weights) @ turn)

    def shift(self, answer: Callable[[PlanetLoads], Array | float]) -> Array:
        """Changes of an answer by the errors of the teeth, added up."""
        here = np.asarray(answer(self), dtype=float)
        changes = (np.abs(np.asarray(answer(one), dtype=float) - here) for one in self.shifted)
        return np.asarray(sum(changes, start=np.zeros_like(here)))

    def mean_error(self, values: Callable[[PlanetLoads], Array]) -> Array:
        """Estimated error of a mean over the cycle, the last axis of values."""
        rough = values(self) * (self.weights - self.cycle.coarse)
        pieces = rough.reshape(*rough.shape[:-1], -1, self.cycle.points).sum(axis=-1)
        return np.asarray(np.abs(pieces).sum(axis=-1) + self.shift(lambda one: values(one) @ self.weights))

    def peak_error(self, values: Callable[[PlanetLoads], Array]) -> Array:
        """Estimated error of a largest value over the cycle, the last axis of values."""
        own = values(self)
        pieces = own.reshape(*own.shape[:-1], -1, self.cycle.points)
        nodes = np.linspace(-1.0, 1.0, 3) if self.cycle.points == 3 else _LOBATTO
        through = _polynomial(nodes, _BETWEEN)
        # what a piece may hide: beyond its points, and by a kink of which its points do not lie on one parabola
        parabola = pieces[..., ::2] @ _polynomial(nodes[::2], nodes).T if nodes.size > 3 else pieces
        least = pieces.max(axis=-1)
        hidden = np.maximum((pieces @ through.T).max(axis=-1) - least, 0.0)
        bound = least + hidden + np.abs(pieces - parabola).max(axis=-1)
        return np.asarray(bound.max(axis=-1) - own.max(axis=-1) + self.shift(lambda one: values(one).max(axis=-1)))

    def harmonics_error(self, values: Callable[[PlanetLoads], Array], orders: Array) -> Array:
        """Estimated error of the size of Fourier coefficients, shape of `harmonics`."""
        rough = np.abs(self._series(values(self), orders, self.weights - self.cycle.coarse))
        return np.asarray(rough + self.shift(lambda one: np.abs(one.harmonics(values(one), orders))))

    @property
    def shares_error(self) -> Array:
        """Of `shares`, shape (planets,)."""
        return self.mean_error(lambda one: one.mesh_force[0]) / self.mean_force

    @property
    def mesh_load_factor_error(self) -> float:
        """Of K_gamma."""
        return float(self.shares_error.max())

    @property
    def largest_load_error(self) -> Array:
        """Of `largest_load` [N], shape (planets,)."""
        return self.peak_error(lambda one: one.mesh_force[0])

    @property
    def largest_share_error(self) -> float:
        """Of `largest_share`."""
        return float(self.peak_error(lambda one: one.on_one_lever).max()) / self.mean_force

    @property
    def te_mean_error(self) -> float:
        """Of `te_mean` [m]."""
        return float(self.mean_error(lambda one: one.te))

    @property
    def te_peak_to_peak_error(self) -> float:
        """Of `te_peak_to_peak` [m]: what its ends hide, and its changes by the errors of the teeth."""
        ends = [self.peak_error(lambda one, sign=sign: sign * one.te) for sign in (1.0, -1.0)]  # type: ignore[misc]  # mypy cannot infer a lambda with a default
        teeth = [self.shift(lambda one, sign=sign: (sign * one.te).max()) for sign in (1.0, -1.0)]  # type: ignore[misc]  # mypy cannot infer a lambda with a default
        return float(sum(ends) - sum(teeth) + self.shift(lambda one: one.te_peak_to_peak))


def _polynomial(nodes: Array, at: Array) -> Array:
    """Values of Lagrange's polynomials of nodes, shape (at, nodes)."""
    return np.asarray(np.vander(at, nodes.size) @ np.linalg.inv(np.vander(nodes, nodes.size)))


_LOBATTO = np.array([-1.0, -math.sqrt(3.0 / 7.0), 0.0, math.sqrt(3.0 / 7.0), 1.0])


def planet_loads(teeth: MeshedSet | SetCycle, pin_errors: Array | None = None) -> PlanetLoads:
    """Equilibrium of a set over a mesh cycle.

    Parameters
    ----------
    teeth : MeshedSet or SetCycle
    pin_errors : ndarray, shape (2, planets), optional
        How far each pin stands from its place, radially outward and counter-clockwise [m].

    Raises
    ------
    ConvergenceError
        If the planets find no equilibrium.
    """
    cycle = teeth.cycle if isinstance(teeth, MeshedSet) else teeth
    model = cycle.model
    errors = np.zeros((2, model.count)) if pin_errors is None else np.array(pin_errors, dtype=float)
    if errors.shape != (2, model.count):
        raise InputError("pin_errors", errors.shape, f"must be {model.count} radial and {model.count} tangential ones")
    errors[1] *= -1.0 if model.mirrored else 1.0
    free = model.freed(member for member in CENTRALS if member != cycle.driving)
    start = model.with_pin_errors(errors)
    rows = model.mesh_rows.reshape(-1, model.size)
    load = model.torque_load(cycle.sun_torque)
    if math.isfinite(model.planet.pin):
        load = load - model.planet.pin * errors.ravel() @ model.pin_rows.reshape(-1, model.size)
    linear, bearing_rows = free.T @ model.held_stiffness() @ free, rows @ free
    separation = cycle.separation - (rows @ start)[:, None]
    z = equilibrium(linear, bearing_rows, cycle.stiffness, separation, load @ free)
    force, bearing = spring_forces(z @ bearing_rows.T, cycle.stiffness, separation)
    found = _put_together(cycle, start + z @ free.T, force)
    off = _off(cycle, force)
    # k (row dq - d) at every mesh, in balance with what always bears
    known = np.einsum("kmr,mr,ri->mik", off, bearing, bearing_rows, optimize=True)
    stiff = tangent(linear, bearing_rows, bearing) + guarded(linear, cycle.stiffness)
    moved = np.linalg.solve(stiff, known).transpose(2, 0, 1)
    changed = bearing * (moved @ bearing_rows.T - off)
    shifted = tuple(
        _put_together(cycle, start + (z + dz) @ free.T, force + df) for dz, df in zip(moved, changed, strict=True)
    )
    return replace(found, shifted=shifted)


def _off(cycle: SetCycle, force: Array) -> Array:
    """Changes of the approach of each mesh by each error [m], shape (K, M, 2N); the last is the law's between forces.

    Errors of compliances grow with the force.
    """
    level = np.hstack([cycle.level, np.full((len(cycle.level), 1), np.inf)])
    at = np.maximum((force[..., None] > level).sum(axis=2) - 1, 0)
    own = np.arange(force.shape[1])
    share = (force - level[own, at]) / (level[own, at + 1] - level[own, at])
    bent = 4.0 * share * (1.0 - share) * np.take_along_axis(cycle.bent, at[..., None], 2)[..., 0]
    lever = np.repeat([1.0, cycle.model.found.ring_lever], cycle.model.count)
    return np.concatenate([cycle.off * (force * lever / cycle.mean_force), bent[None]])


def _put_together(cycle: SetCycle, q: Array, force: Array) -> PlanetLoads:
    """Forces on planets and members of coordinates and forces in the meshes, shapes (M, size) and (M, 2N)."""
    model = cycle.model
    sense = -1.0 if model.mirrored else 1.0
    mesh = force.T.reshape(2, model.count, -1).copy()
    # a planet is held by its pin against both meshes
    pushed = np.einsum("anm,ani->mi", mesh, model.mesh_rows)
    planets = pushed[:, 9:].reshape(-1, model.count, 3)[:, :, :2].transpose(2, 1, 0).copy()
    members = -pushed[:, :6].reshape(-1, 2, 3)[:, :, :2].transpose(1, 2, 0)
    carrier = -np.einsum("anm,ani->im", planets, model.pin_rows[:, :, 6:8])
    moved = q[:, :9].reshape(-1, 3, 3)[:, :, :2].transpose(1, 2, 0).copy()
    forces = np.concatenate([members, carrier[None]])
    for one in (planets, forces.swapaxes(0, 1), moved.swapaxes(0, 1)):
        one[1] *= sense
    driven = q[:, 3 * CENTRALS.index(cycle.driving) + 2]
    te = driven * (-1.0 if cycle.driving == "carrier" else 1.0)
    return PlanetLoads(cycle, mesh, planets, forces, moved, cycle.s, te)


def force_on(loads: PlanetLoads, member: Central) -> Array:
    """Force on a member by the planets over the cycle, x and y in the carrier [N], shape (2, M)."""
    return np.asarray(loads.member_force[CENTRALS.index(member)])
