"""Shafts on their bearings under forces: static, nonlinear where bearings are, all shafts of a housing together.

Unknown are the forces p of the bearings on the shafts and the motion q of each shaft's left end. With the compliance A
of the clamped shafts and H of the housing's seats, a ring moves in its seat by u = A p + H p + R q + u_0, and

    p + f(u) = 0   (u = 0 where a bearing is rigid),        R^T p + equilibrium of the outer forces = 0.

Nothing is divided by a compliance: rigid shafts (A = 0), rigid seats (H = 0) and rigid bearings need no large numbers.
Newton's method; where it fails, a stiffness added to every bearing at first, and taken away step by step, brings loose
shafts into contact; 1e-10 of it stays where a shaft floats in its clearance. Turning about the axis is free: torques
must balance, and twist is measured from the left end.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import distinct
from fegear.base.errors import ConvergenceError, InputError
from fegear.base.shown import shown
from fegear.shafts.beam import carry

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.shafts.beam import Shaft
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
#: Torques about an axis that balance to so much of the largest are round-off.
_BALANCED = 1e-9
#: Places along a shaft at which its line is known besides its bearings, steps and forces.
_PLACES = 101
#: Smallest over largest stiffness of a shaft on its bearings below which it is loose.
_LOOSE = 1e-12


@dataclass(frozen=True)
class Seat:
    """A bearing on a shaft.

    Parameters
    ----------
    bearing : Bearing
    at : float
        From the shaft's left end [m].
    name : str
        For messages.
    """

    bearing: Bearing
    at: float
    name: str = "bearing"


@dataclass(frozen=True)
class LoadedShaft:
    """A shaft, its bearings and the forces from outside.

    Parameters
    ----------
    shaft : Shaft
    seats : tuple of Seat
    loads_at : ndarray, shape (m,)
        From its left end [m].
    loads : ndarray, shape (m, 6)
        Forces and moments F_x, F_y, F_z, M_x, M_y, M_z at the axis [N, N m].
    name : str

    Raises
    ------
    InputError
        If a bearing or force is off the shaft, it has no bearings, or is loose.
    """

    shaft: Shaft
    seats: tuple[Seat, ...]
    loads_at: Array
    loads: Array
    name: str = "shaft"

    def __post_init__(self) -> None:
        """Refuse shafts that are not held."""
        for seat in self.seats:
            self.shaft.place(seat.at, f"{self.name}.{seat.name}.at")
        for at in self.loads_at:
            self.shaft.place(float(at), f"{self.name}.load.at")
        if not self.seats:
            raise InputError(f"{self.name}.bearings", "(none)", "leave the shaft without support", "give two bearings")
        length = self.shaft.length
        scale = np.array([1.0, 1.0, 1.0, 1.0 / length, 1.0 / length])
        held = np.zeros((5, 5))
        for seat in self.seats:
            moved = carry(seat.at)[:5, :5].T
            soft = np.abs(np.diag(seat.bearing.usual))
            firm = np.diag(np.where(seat.bearing.rigid, max(1e9, float(soft[:3].max())) / scale**2 * 1e3, 0.0))
            held += moved.T @ (seat.bearing.usual + firm) @ moved
        stiff = held * np.outer(scale, scale)
        values, motions = np.linalg.eigh(stiff)
        if not values[0] > _LOOSE * values[-1]:
            ways = ("across along x", "across along y", "along its axis", "in tilt about x", "in tilt about y")
            loose = ways[int(np.argmax(np.abs(motions[:, 0])))]
            raise InputError(
                f"{self.name}.bearings", f"{len(self.seats)} in number", f"leave the shaft loose {loose}",
                "give a bearing that holds it there",
            )  # fmt: skip


@dataclass(frozen=True)
class ShaftLine:
    """How a shaft's axis lies; arrays of shape (n,)."""

    z: Array = shown("mm", "from the left end of the shaft")
    x: Array = shown("um", "displacement of the axis along x")
    y: Array = shown("um", "displacement of the axis along y")
    along: Array = shown("um", "displacement along the axis")
    turn_x: Array = shown("arcsec", "turn of the section about x")
    turn_y: Array = shown("arcsec", "turn of the section about y")
    twist: Array = shown("arcsec", "twist from the left end")


@dataclass(frozen=True)
class BearingLoads:
    """What the bearings of a shaft carry; arrays of shape (b,)."""

    at: Array = shown("mm", "place of the bearing from the left end")
    force_x: Array = shown("N", "of the bearing on the shaft, along x")
    force_y: Array = shown("N", "of the bearing on the shaft, along y")
    force_axial: Array = shown("N", "of the bearing on the shaft")
    force_radial: Array = shown("N", "of the bearing, across the axis")
    shift: Array = shown("um", "of the shaft in its seat")
    tilt: Array = shown("arcsec", "of the shaft in its seat")
    life: Array = shown("", "basic rating life L_10 in revolutions (ISO 281)")


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
    """

    loaded: LoadedShaft
    bearing_forces: Array
    rings: Array
    left_end: Array
    floating: float = 0.0

    @cached_property
    def _all(self) -> tuple[Array, Array]:
        places = np.array([seat.at for seat in self.loaded.seats])
        forces = np.column_stack([self.bearing_forces, np.zeros(len(places))])
        return np.concatenate([places, self.loaded.loads_at]), np.vstack([forces, self.loaded.loads])

    def at(self, z: ArrayLike) -> Array:
        """Displacement and turns at places, shape (n, 6) [m, rad]."""
        places = np.atleast_1d(np.asarray(z, dtype=float))
        return self.rigid(places) + self.bent(places)

    def rigid(self, z: ArrayLike) -> Array:
        """Share of the motion of the left end: what bearings and housing give way, shape (n, 6)."""
        return np.einsum("nba,b->na", carry(z), self.left_end)

    def bent(self, z: ArrayLike) -> Array:
        """Share of the shaft itself, from its left end on, shape (n, 6)."""
        at, loads = self._all
        return self.loaded.shaft.bent(z, at, loads)

    @property
    def line(self) -> ShaftLine:
        """The whole axis, bearings, steps and forces among its places."""
        shaft, (at, _) = self.loaded.shaft, self._all
        z = distinct(shaft.steps, at, np.linspace(0.0, shaft.length, _PLACES))
        return ShaftLine(z, *self.at(z).T)

    def bearing_loads(self, lives: tuple[LifeRating | None, ...]) -> BearingLoads:
        """What every bearing carries, and how long by its ratings; NaN without."""
        force, ring = self.bearing_forces, self.rings
        radial = np.hypot(force[:, 0], force[:, 1])
        turns = [
            np.nan if life is None else life.revolutions(float(across), float(one[2]))
            for life, across, one in zip(lives, radial, force, strict=True)
        ]
        at = np.array([seat.at for seat in self.loaded.seats])
        return BearingLoads(
            at, force[:, 0], force[:, 1], force[:, 2], radial, np.hypot(ring[:, 0], ring[:, 1]),
            np.hypot(ring[:, 3], ring[:, 4]), np.array(turns),
        )  # fmt: skip

    @property
    def balance(self) -> Array:
        """Sum of all forces, and of all moments about the left end, over the largest: round-off, shape (2,)."""
        at, loads = self._all
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


def refuse_torque(shafts: tuple[LoadedShaft, ...]) -> None:
    """Refuse torques about an axis that nothing takes.

    Raises
    ------
    InputError
    """
    for one in shafts:
        torque = one.loads[:, 5]
        if abs(torque.sum()) > _BALANCED * max(float(np.abs(torque).max(initial=0.0)), 1e-12):
            raise InputError(
                one.name, f"{torque.sum():.6g} N m", "is a torque about its axis that nothing takes",
                "give a coupling that takes it",
            )  # fmt: skip


def _system(shafts: tuple[LoadedShaft, ...], housing: Array | None) -> _System:
    counts = [len(one.seats) for one in shafts]
    total = sum(counts)
    compliance = np.zeros((5 * total, 5 * total)) if housing is None else np.array(housing, dtype=float)
    if compliance.shape != (5 * total, 5 * total):
        raise InputError("housing", f"{compliance.shape}", f"must have 5 rows for each of {total} bearings")
    motion, free, outer = np.zeros((5 * total, 5 * len(shafts))), np.zeros(5 * total), np.zeros(5 * len(shafts))
    scale, first = [], 0
    for n, one in enumerate(shafts):
        at = np.array([seat.at for seat in one.seats])
        rows, columns = slice(5 * first, 5 * (first + len(at))), slice(5 * n, 5 * n + 5)
        own = one.shaft.compliance(at)[:, :5, :, :5].reshape(5 * len(at), -1)
        compliance[rows, rows] += own
        motion[rows, columns] = np.swapaxes(carry(at)[:, :5, :5], 1, 2).reshape(-1, 5)
        free[rows] = one.shaft.bent(at, one.loads_at, one.loads)[:, :5].ravel()
        outer[columns] = np.einsum("nab,nb->a", carry(one.loads_at), one.loads)[:5]
        scale += [np.array([1.0, 1.0, 1.0, one.shaft.length, one.shaft.length])] * len(at)
        first += len(at)
    return _System(shafts, compliance, motion, free, outer, np.concatenate(scale))


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
        If the torques of a shaft do not balance.
    ConvergenceError
        If no equilibrium is found.
    """
    refuse_torque(shafts)
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
        raise ConvergenceError(f"The bearings of {names} find no equilibrium: reduce clearance or loads.")
    found, first = [], 0
    u = system.moved(p, q)
    for n, one in enumerate(shafts):
        last = first + 5 * len(one.seats)
        left = np.append(q[5 * n : 5 * n + 5], 0.0)
        found.append(Deflection(one, p[first:last].reshape(-1, 5), u[first:last].reshape(-1, 5), left, helped))
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
    rings, places = 0, 0
    for n, (one, z) in enumerate(zip(found, at, strict=True)):
        seats = np.array([seat.at for seat in one.loaded.seats])
        b, these, held = seats.size, slice(places, places + 6 * z.size), slice(rings, rings + 5 * seats.size)
        bent = one.loaded.shaft.compliance(np.concatenate([seats, z]))
        own[these, these] = bent[b:, :, b:].reshape(6 * z.size, 6 * z.size)
        across[these, held] = bent[b:, :, :b, :5].reshape(6 * z.size, 5 * b)
        moved = carry(z)[:, :5]
        across[these, size + 5 * n : size + 5 * n + 5] = np.swapaxes(moved, 1, 2).reshape(6 * z.size, 5)
        right[held, these] = bent[:b, :5, b:].reshape(5 * b, 6 * z.size)
        right[size + 5 * n : size + 5 * n + 5, these] = np.swapaxes(moved, 0, 1).reshape(5, 6 * z.size)
        rings, places = held.stop, these.stop
    right[:size] = by_rings @ right[:size]
    try:
        return np.asarray(own - across @ _solved(derivative, right))
    except np.linalg.LinAlgError:
        names = ", ".join(one.loaded.name for one in found)
        raise ConvergenceError(f"The bearings of {names} leave a shaft loose: give them preload.") from None
