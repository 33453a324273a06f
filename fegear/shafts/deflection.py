"""Shafts on their bearings under forces: static, nonlinear where bearings are, all shafts of a housing together.

Unknown are the forces p of the bearings on the shafts and the motion q of each shaft's left end. With the compliance A
of the clamped shafts and H of the housing's seats, a ring moves in its seat by u = A p + H p + R q + u_0, and

    p + f(u) = 0   (u = 0 where a bearing is rigid),        R^T p + equilibrium of the outer forces = 0.

Nothing is divided by a compliance: rigid shafts (A = 0), rigid seats (H = 0) and rigid bearings need no large numbers.
Newton's method; where it fails, a stiffness added to every bearing at first, and taken away step by step, brings loose
shafts into contact; 1e-10 of it stays where a shaft floats in its clearance. Turning about the axis is free: torques
must balance, and twist is measured from the left end.

The outer ring of a bearing may turn with another shaft, around the inner one: -p acts there, and u is what the inner
shaft moves more than the outer one. A, R, u_0 and the outer forces are then sums over both.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import distinct
from fegear.base.errors import ConvergenceError, InputError
from fegear.base.shown import shown
from fegear.shafts.carried import carry
from fegear.shafts.held import LoadedShaft, held_by, refuse_loose, refuse_torque

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.shafts.bearing import Bearing
    from fegear.shafts.life import LifeRating

#: Shares of the usual stiffness that are added at first, and taken away.
_HELP = (1.0, 1e-2, 1e-4, 1e-6, 1e-8)
#: What is left of it where a shaft floats in its clearance without a force: it tells where, and carries nothing.
_FLOATING = 1e-10
_ITERATIONS, _HALVINGS = 60, 40
#: Residual over the forces at which Newton's method has ended.
_DONE = 1e-12
#: Of sums of displacements, a few times that of the machine.
_ROUND_OFF = 2e-15
#: Places along a shaft at which its line is known besides its bearings, steps and forces.
_PLACES = 101


@dataclass(frozen=True)
class ShaftLine:
    """How a shaft's axis lies; arrays of shape (n,)."""

    z: Array = shown("mm", "axial position from the left shaft end")
    x: Array = shown("um", "displacement of the axis along x")
    y: Array = shown("um", "displacement of the axis along y")
    along: Array = shown("um", "axial displacement")
    turn_x: Array = shown("arcsec", "rotation of the section about x")
    turn_y: Array = shown("arcsec", "rotation of the section about y")
    twist: Array = shown("arcsec", "angle of twist from the left end")


@dataclass(frozen=True)
class BearingLoads:
    """What the bearings of a shaft carry; arrays of shape (b,)."""

    at: Array = shown("mm", "position of the bearing from the left end")
    force_x: Array = shown("N", "bearing force on the shaft, x")
    force_y: Array = shown("N", "bearing force on the shaft, y")
    force_axial: Array = shown("N", "bearing reaction on the shaft")
    force_radial: Array = shown("N", "radial bearing force")
    moment_x: Array = shown("N.m", "moment of the bearing on the shaft about x")
    moment_y: Array = shown("N.m", "moment of the bearing on the shaft about y")
    shift: Array = shown("um", "displacement of the shaft at the bearing")
    tilt: Array = shown("arcsec", "tilt of the shaft at the bearing")
    life: Array = shown("", "basic rating life L_10, in revolutions (ISO 281)")
    equivalent: Array = shown("N", "equivalent dynamic load P (ISO 281)", name="equivalent_load")


@dataclass(frozen=True)
class Deflection:
    """A shaft in equilibrium.

    Parameters
    ----------
    loaded : LoadedShaft
    bearing_forces : ndarray, shape (b, 5)
        Of the bearings on the shaft: F_x, F_y, F_z, M_x, M_y [N, N m].
    rings : ndarray, shape (b, 5)
        Displacement of each inner ring in its outer one [m, rad].
    left_end : ndarray, shape (6,)
        Motion of the left end.
    floating : float
        Share of the bearings' usual stiffness that holds shafts which nothing else does; zero where none floats.
    inside_at, inside : ndarray, shapes (c,), (c, 6)
        Forces of bearings whose outer rings sit in it.
    """

    loaded: LoadedShaft
    bearing_forces: Array
    rings: Array
    left_end: Array
    floating: float = 0.0
    inside_at: Array = field(default_factory=lambda: np.empty(0))
    inside: Array = field(default_factory=lambda: np.empty((0, 6)))

    @cached_property
    def acting(self) -> tuple[Array, Array]:
        """Places and forces of all that acts on it, bearings among them, shapes (m,), (m, 6)."""
        places = np.array([seat.at for seat in self.loaded.seats])
        forces = np.column_stack([self.bearing_forces, np.zeros(len(places))])
        return (
            np.concatenate([places, self.inside_at, self.loaded.loads_at]),
            np.vstack([forces, self.inside, self.loaded.loads]),
        )

    def at(self, z: ArrayLike) -> Array:
        """Displacement and turns at places, shape (n, 6) [m, rad]."""
        places = np.atleast_1d(np.asarray(z, dtype=float))
        return self.rigid(places) + self.bent(places)

    def rigid(self, z: ArrayLike) -> Array:
        """Share of the motion of the left end: what bearings and housing give way, shape (n, 6)."""
        return np.einsum("nba,b->na", carry(z), self.left_end)

    def bent(self, z: ArrayLike) -> Array:
        """Share of the shaft itself, from its left end on, shape (n, 6)."""
        at, loads = self.acting
        return self.loaded.shaft.bent(z, at, loads)

    @property
    def line(self) -> ShaftLine:
        """The whole axis, bearings, steps and forces among its places."""
        shaft, (at, _) = self.loaded.shaft, self.acting
        z = distinct(shaft.steps, at, np.linspace(0.0, shaft.length, _PLACES))
        return ShaftLine(z, *self.at(z).T)

    def bearing_loads(self, lives: tuple[LifeRating | None, ...]) -> BearingLoads:
        """What every bearing carries, and how long by its ratings; NaN without."""
        force, ring = self.bearing_forces, self.rings
        radial = np.hypot(force[:, 0], force[:, 1])
        turns, loads = np.full(len(lives), np.nan), np.full(len(lives), np.nan)
        for n, life in enumerate(lives):
            if life is not None:
                loads[n] = life.equivalent_load(float(radial[n]), float(force[n, 2]))
                turns[n] = life.revolutions(float(radial[n]), float(force[n, 2]))
        at = np.array([seat.at for seat in self.loaded.seats])
        return BearingLoads(
            at, force[:, 0], force[:, 1], force[:, 2], radial, force[:, 3], force[:, 4],
            np.hypot(ring[:, 0], ring[:, 1]), np.hypot(ring[:, 3], ring[:, 4]), turns, loads,
        )  # fmt: skip

    @property
    def radial_stiffness(self) -> Array:
        """Slope of the radial force of every bearing along itself, shape (b,) [N/m]; NaN unloaded or rigid."""
        found = np.full(len(self.rings), np.nan)
        for n, (seat, ring, force) in enumerate(
            zip(self.loaded.seats, self.rings, self.bearing_forces[:, :2], strict=True)
        ):
            size = float(np.hypot(*force))
            if size > 0.0 and not seat.bearing.rigid[:2].any():
                along = force / size
                found[n] = along @ seat.bearing.reaction(ring)[1][:2, :2] @ along
        return found

    @property
    def balance(self) -> Array:
        """Sum of all forces, and of all moments about the left end, over the largest: round-off, shape (2,)."""
        at, loads = self.acting
        moved = np.einsum("nab,nb->na", carry(at), loads)
        most = np.abs(moved[:, :3]).max(initial=0.0), np.abs(moved[:, 3:]).max(initial=0.0)
        left = np.abs(moved.sum(axis=0))
        return np.array([left[:3].max() / max(most[0], 1e-300), left[3:].max() / max(most[1], 1e-300)])


@dataclass(frozen=True)
class _System:
    """Matrices of the equations, forces scaled by `force` and lengths by `length`."""

    shafts: tuple[LoadedShaft, ...]
    compliance: Array
    motion: Array
    free: Array
    outer: Array
    scale: Array

    @property
    def bearings(self) -> list[Bearing]:
        return [seat.bearing for one in self.shafts for seat in one.seats]

    def moved(self, p: Array, q: Array) -> Array:
        """u of every ring, shape (5 b,)."""
        return np.asarray(self.compliance @ p + self.motion @ q + self.free)

    def equations(self, p: Array, q: Array, helped: float) -> tuple[Array, Array, Array]:
        """Residual, its derivative by (p, q), and that of its first rows by the displacement of the rings."""
        u, size = self.moved(p, q), p.size
        force, stiffness, rigid = np.zeros(size), np.zeros((size, size)), np.zeros(size, dtype=bool)
        for n, bearing in enumerate(self.bearings):
            here = slice(5 * n, 5 * n + 5)
            force[here], stiffness[here, here] = bearing.reaction(u[here])
            more = helped * bearing.usual
            force[here] += more @ u[here]
            stiffness[here, here] += more
            rigid[here] = bearing.rigid
        residual = np.concatenate([np.where(rigid, u, p + force), self.motion.T @ p + self.outer])
        by_rings = np.where(rigid[:, None], np.eye(size), stiffness)
        derivative = np.zeros((residual.size, residual.size))
        derivative[:size, :size] = by_rings @ self.compliance + np.diag(np.where(rigid, 0.0, 1.0))
        derivative[:size, size:] = by_rings @ self.motion
        derivative[size:, :size] = self.motion.T
        return residual, derivative, by_rings


def _system(shafts: tuple[LoadedShaft, ...], housing: Array | None) -> _System:
    total = sum(len(one.seats) for one in shafts)
    compliance = np.zeros((5 * total, 5 * total)) if housing is None else np.array(housing, dtype=float)
    if compliance.shape != (5 * total, 5 * total):
        raise InputError("housing", f"{compliance.shape}", f"must have 5 rows for each of {total} bearings")
    motion, free, outer = np.zeros((5 * total, 5 * len(shafts))), np.zeros(5 * total), np.zeros(5 * len(shafts))
    scale = np.ones(5 * total)
    for n, (one, held) in enumerate(zip(shafts, held_by(shafts), strict=True)):
        rows, columns, sign = held.rows, slice(5 * n, 5 * n + 5), np.repeat(held.sign, 5)
        own = one.shaft.compliance(held.at)[:, :5, :, :5].reshape(rows.size, -1)
        compliance[np.ix_(rows, rows)] += sign[:, None] * own * sign
        motion[rows, columns] = sign[:, None] * np.swapaxes(carry(held.at)[:, :5, :5], 1, 2).reshape(-1, 5)
        free[rows] += sign * one.shaft.bent(held.at, one.loads_at, one.loads)[:, :5].ravel()
        outer[columns] = np.einsum("nab,nb->a", carry(one.loads_at), one.loads)[:5]
        turns = rows.reshape(-1, 5)[held.sign > 0.0, 3:]
        scale[turns] = one.shaft.length
    return _System(shafts, compliance, motion, free, outer, scale)


def _solved(matrix: Array, right: Array) -> Array:
    """Solution of equations whose rows and unknowns are of very different sizes."""
    most = np.abs(matrix).max(axis=1)
    most[most == 0.0] = 1.0
    columns = np.abs(matrix / most[:, None]).max(axis=0)
    columns[columns == 0.0] = 1.0
    return np.asarray(np.linalg.solve(matrix / most[:, None] / columns, right / most[:, None]) / columns[:, None])


def _newton(system: _System, p: Array, q: Array, helped: float) -> tuple[Array, Array, bool]:
    """From a start to the solution, halving steps that do not help; the last says whether it was reached."""
    size = p.size
    loads = max((float(np.abs(one.loads[:, :3]).max(initial=0.0)) for one in system.shafts), default=0.0)
    force = max(loads, float(np.abs(system.outer).max(initial=0.0)), 1e-9)
    lengths = np.array([one.shaft.length for one in system.shafts])
    balance = np.concatenate([[1.0, 1.0, 1.0, length, length] for length in lengths])
    rigid = np.concatenate([bearing.rigid for bearing in system.bearings])
    reach = max(float(np.abs(system.free * system.scale).max(initial=0.0)), 1e-9)
    # Of very stiff bearings a force is the round-off of a displacement times their stiffness: no less can be asked.
    stout = np.concatenate([np.abs(bearing.usual).sum(axis=1) for bearing in system.bearings])
    carried = force * system.scale + _ROUND_OFF / _DONE * reach * stout / system.scale
    rows = np.concatenate([np.where(rigid, reach / system.scale, carried), force * balance])

    def size_of(residual: Array) -> float:
        return float(np.abs(residual / rows).max())

    residual, derivative, _ = system.equations(p, q, helped)
    for _ in range(_ITERATIONS):
        try:
            step = -_solved(derivative, residual[:, None])[:, 0]
        except np.linalg.LinAlgError:
            return p, q, False
        before, share = size_of(residual), 1.0
        for _ in range(_HALVINGS):
            new = p + share * step[:size], q + share * step[size:]
            residual, derivative, _ = system.equations(*new, helped)
            if size_of(residual) < (1.0 - 1e-4 * share) * before or size_of(residual) < _DONE:
                break
            share *= 0.5
        else:
            return p, q, before < 1e3 * _DONE
        p, q = new
        if size_of(residual) < _DONE:
            return p, q, True
    return p, q, size_of(residual) < 1e3 * _DONE


def deflect(shafts: tuple[LoadedShaft, ...], housing: Array | None = None) -> tuple[Deflection, ...]:
    """Deflect the shafts of one housing.

    Parameters
    ----------
    shafts : tuple of LoadedShaft
    housing : ndarray, shape (5 b, 5 b), optional
        Compliance of the bearings' seats, in the order of shafts and seats [m/N, 1/N, 1/(N m)]; rigid without it.

    Raises
    ------
    InputError
        If the torques of a shaft do not balance, or one is loose.
    ConvergenceError
        If no equilibrium is found.
    """
    refuse_torque(shafts)
    refuse_loose(shafts)
    system = _system(shafts, housing)
    p, q = np.zeros(system.free.size), np.zeros(5 * len(shafts))
    helped = 0.0
    p, q, reached = _newton(system, p, q, helped)
    if not reached:
        p, q = np.zeros(system.free.size), np.zeros(5 * len(shafts))
        for helped in _HELP:
            p, q, _ = _newton(system, p, q, helped)
        for helped in (0.0, _FLOATING):
            again = _newton(system, p, q, helped)
            if reached := again[2]:
                p, q, _ = again
                break
    if not reached:
        names = ", ".join(one.name for one in shafts)
        raise ConvergenceError(f"No equilibrium found for the bearings of {names}: reduce clearance or loads.")
    found, first = [], 0
    u, forces = system.moved(p, q), p.reshape(-1, 5)
    for n, (one, held) in enumerate(zip(shafts, held_by(shafts), strict=True)):
        last, inside = first + len(one.seats), held.sign < 0.0
        left = np.append(q[5 * n : 5 * n + 5], 0.0)
        found.append(Deflection(
            one, forces[first:last], u.reshape(-1, 5)[first:last], left, helped, held.at[inside],
            np.pad(-forces[held.bearings[inside]], ((0, 0), (0, 1))),
        ))  # fmt: skip
        first = last
    return tuple(found)


def response(found: tuple[Deflection, ...], at: tuple[Array, ...], housing: Array | None = None) -> Array:
    """How much places of deflected shafts move by small further forces at them: tangent at the bearings' state.

    Parameters
    ----------
    found : tuple of Deflection
        All shafts of a housing, from `deflect`.
    at : tuple of ndarray, shape (n,) each
        Places on each shaft from its left end [m].
    housing : ndarray, shape (5 b, 5 b), optional
        As of `deflect`.

    Returns
    -------
    ndarray, shape (6 N, 6 N)
        Displacements and turns of all places of all shafts, one shaft after the other, per force and moment; symmetric.

    Raises
    ------
    ConvergenceError
        If a shaft is loose where it stands.
    """
    system = _system(tuple(one.loaded for one in found), housing)
    p = np.concatenate([one.bearing_forces.ravel() for one in found])
    q = np.concatenate([one.left_end[:5] for one in found])
    _, derivative, by_rings = system.equations(p, q, found[0].floating)
    total, size = 6 * sum(z.size for z in at), p.size
    right, own, across = np.zeros((size + q.size, total)), np.zeros((total, total)), np.zeros((total, size + q.size))
    places = 0
    for n, (one, z, held) in enumerate(zip(found, at, held_by(system.shafts), strict=True)):
        b, sign, rows = held.at.size, np.repeat(held.sign, 5), held.rows
        these, motion = slice(places, places + 6 * z.size), slice(size + 5 * n, size + 5 * n + 5)
        bent = one.loaded.shaft.compliance(np.concatenate([held.at, z]))
        own[these, these] = bent[b:, :, b:].reshape(6 * z.size, 6 * z.size)
        across[these, rows] = sign * bent[b:, :, :b, :5].reshape(6 * z.size, 5 * b)
        moved = carry(z)[:, :5]
        across[these, motion] = np.swapaxes(moved, 1, 2).reshape(6 * z.size, 5)
        right[rows, these] = sign[:, None] * bent[:b, :5, b:].reshape(5 * b, 6 * z.size)
        right[motion, these] = np.swapaxes(moved, 0, 1).reshape(5, 6 * z.size)
        places = these.stop
    right[:size] = by_rings @ right[:size]
    try:
        return np.asarray(own - across @ _solved(derivative, right))
    except np.linalg.LinAlgError:
        names = ", ".join(one.loaded.name for one in found)
        raise ConvergenceError(
            f"Shaft of {names} not constrained within the bearing clearance; specify preload."
        ) from None
