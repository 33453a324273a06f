"""Dynamic increment functions Q_ij of any gear train, free of cancellation at every frequency.

Q_ij(w) is the dynamic increment of the transmission error of gear pair i per unit static transmission error of gear
pair j: W_i = Q_ij zeta_j / C_i (W. D. Mark, transfer function method, Eqs. 2.58 to 2.60, for any number of meshes).

Formed as Mark writes them, R (H_11 + H_21) - 1, they lose all digits at low frequency, where the train turns as a
rigid body: Q_II falls like w or w^2 while its two terms stay at one. Here the train is an electrical network
(`network`) whose nodes are eliminated one by one towards gear pair j, with the leaks (inertia, dampers to ground) kept
apart from the links (`star_mesh`; the idea of Grassmann, Taksar and Heyman for Markov chains). What is left is
Q_jj = -D(mesh j removed)/D, and on the way back the forces of the other pairs follow as products. A train without loops
is swept once for all of its gear pairs (`branches`); of one with loops each pair has its own elimination.

Every number carries a bound of its round-off (`rounded`). Frequencies in doubt are solved again in longer floats, those
of trains with loops or slipping dampers, if need be, in other orders, from gear pair i to j (forces are reciprocal) and
from the equations as they stand (`direct`); the best is taken entry by entry.

What dynamic increments tend to at low and at high frequency, for any gear train (Mark, 2.62 to 2.66).

Slowly a train turns as a rigid body, and what is left of Q_ij is its first power of s = i w: dampers give s, inertia
alone s^2, a locked power loop a constant. Fast, springs no longer hold the bodies: each turns as a free inertia under
the force of the teeth that press on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex, Floats
from fegear.base.errors import RangeError
from fegear.dynamics.train.branches import Branches, Ways
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.network import Network
from fegear.dynamics.train.segments import lags_by_pivots
from fegear.dynamics.train.star_mesh import RESONANCE, Response, respond
from fegear.dynamics.train.train import Train

#: Estimated relative round-off beyond which a frequency is solved again.
DOUBTFUL = 1e-13


#: Memory that the elimination may take [bytes]; frequencies are solved in blocks that fit.
MEMORY = 16 * 2**20


#: Fewest and most frequencies of a block.
BLOCK = 16, 2048


#: Other orders of elimination that are tried for frequencies in doubt.
ORDERS = 5


def dynamic_increments(train: Train, omega: ArrayLike, sources: Sequence[int] | None = None) -> Complex:
    """Dynamic increment functions of every ordered pair of meshes.

    Parameters
    ----------
    train : Train
        The gear train; its meshes carry their mean stiffness 1/C.
    omega : array_like, shape (...)
        Angular frequency [rad/s], zero included (the static limit); negative values give the complex conjugate.
    sources : sequence of int, optional
        Meshes j whose transmission error is looked at; all by default.

    Returns
    -------
    ndarray, shape (meshes, sources, ...)
        Q[i, j]: from the static transmission error of mesh j to C_i times the force of mesh i.

    Raises
    ------
    RangeError
        If a frequency is not finite, or meets a resonance without damping.
    """
    w = np.asarray(omega, dtype=float)
    flat = np.abs(w).ravel()
    if not np.all(np.isfinite(flat)):
        raise RangeError("frequency", "nan or inf", "must be finite")
    count = len(train.meshes)
    chosen = range(count) if sources is None else sources
    found = np.empty((count, len(chosen), flat.size), dtype=complex)
    solver = _Solver.of(train)
    for places in (np.flatnonzero(flat > 0.0), np.flatnonzero(flat == 0.0)):
        for part in solver.blocks(places):
            for column, q in enumerate(solver.columns(flat[part], chosen)):
                found[:, column, part] = q
    negative = (w < 0.0).ravel()
    found[:, :, negative] = np.conj(found[:, :, negative])
    return found.reshape((count, len(chosen), *w.shape))


@dataclass(frozen=True)
class _Column:
    """Q[i] for one mesh that excites, with its doubt, shape (meshes, frequencies), and where there is none."""

    q: Complex
    doubt: Floats
    resonance: NDArray[np.bool_]

    def weak(self) -> NDArray[np.bool_]:
        """Frequencies at which an entry is in doubt."""
        return np.asarray(self.resonance | np.any(self.doubt > DOUBTFUL * np.abs(self.q), axis=0))

    def improved(self, places: NDArray[np.bool_], other: _Column) -> _Column:
        """With what another solution knows better at some frequencies; a resonance is one that both find."""
        q, doubt, resonance = np.array(self.q), np.array(self.doubt), np.array(self.resonance)
        closer = (other.doubt < doubt[:, places]) | (resonance[places] & ~other.resonance)
        q[:, places] = np.where(closer, other.q, q[:, places])
        doubt[:, places] = np.where(closer, other.doubt, doubt[:, places])
        resonance[places] &= other.resonance
        return _Column(q, doubt, resonance)


@dataclass(frozen=True)
class _Solver:
    """A train's network in plain and in long floats, with the parts of it that do not depend on frequency."""

    train: Train
    plain: Network
    long: Network
    orders: dict[tuple[int, int], list[tuple[int, tuple[int, ...]]]]
    branches: Branches | None

    @classmethod
    def of(cls, train: Train) -> _Solver:
        plain = Network.of(train)
        branches = Branches.of(plain) if plain.branches_only and plain.size > 1 else None
        return cls(train, plain, Network.of(train, np.longdouble), {}, branches)

    def blocks(self, places: NDArray[np.intp]) -> Iterator[NDArray[np.intp]]:
        """Frequencies in blocks that keep within `MEMORY`."""
        if self.branches is not None:
            each = 24 * self.branches.kept
        else:
            links = sum(len(others) for _, others in self._order(0)) if self.train.meshes else 0
            each = 24 * (3 * self.plain.size + 3 * links + 2 * len(self.plain.slips) * self.plain.size)
        size = min(max(MEMORY // each, BLOCK[0]), BLOCK[1])
        for start in range(0, places.size, size):
            yield places[start : start + size]

    def _order(self, mesh: int, variant: int = 0) -> list[tuple[int, tuple[int, ...]]]:
        if (mesh, variant) not in self.orders:
            self.orders[mesh, variant] = self.plain.order(mesh, variant)
        return self.orders[mesh, variant]

    def columns(self, w: Floats, meshes: Sequence[int]) -> Iterator[Complex]:
        """Q[i, mesh] at frequencies that are all positive or all zero, shape (meshes, frequencies), mesh by mesh."""
        if self.branches is None:
            for mesh in meshes:
                found = self._solve(self.plain, w, mesh)
                weak = found.weak()
                if np.any(weak):
                    found = found.improved(weak, self._careful(w[weak].astype(np.longdouble), mesh))
                yield self._bounded(w, found)
            return
        ways = Ways(self.plain, self.branches, w)
        columns = [self._by_ways(ways, mesh) for mesh in meshes]
        weak = np.any([column.weak() for column in columns], axis=0) if columns else np.zeros(w.size, dtype=bool)
        if np.any(weak):
            ways = Ways(self.long, self.branches, w[weak].astype(np.longdouble))
            columns = [c.improved(weak, self._by_ways(ways, mesh)) for c, mesh in zip(columns, meshes, strict=True)]
        for column in columns:
            yield self._bounded(w, column)

    def _bounded(self, w: Floats, found: _Column) -> Complex:
        if np.any(found.resonance):
            where = float(w[found.resonance][0]) / (2.0 * math.pi)
            raise RangeError(
                "frequency",
                f"{where:.9g} Hz",
                "is a natural frequency of the undamped train: unbounded response",
                "specify damping or remove this frequency",
            )
        return found.q

    def _careful(self, w: Floats, mesh: int) -> _Column:
        """Longer floats, then other orders of elimination, the way from i to j, and pivots; the best of each."""
        best = self._solve(self.long, w, mesh)
        if not np.all(w > 0.0):
            return best
        tries: list[Callable[[Floats], _Column]] = [
            partial(self._solve, self.long, mesh=mesh, variant=order) for order in range(1, ORDERS + 1)
        ]
        tries += [partial(self._back, i=i, mesh=mesh) for i in range(len(self.train.meshes)) if i != mesh]
        tries.append(partial(self._by_pivots, mesh=mesh))
        for attempt in tries:
            left = best.weak()
            if not np.any(left):
                break
            best = best.improved(left, attempt(w[left]))
        return best

    def _back(self, w: Floats, i: int, mesh: int) -> _Column:
        """Entry i of a column by the way from mesh i to the one that excites: their forces are the same."""
        back = self._solve(self.long, w, i)
        scale = self._scale(w, i, mesh) / self._scale(w, mesh, i)
        q, doubt = np.zeros_like(back.q), np.full(back.doubt.shape, np.inf)
        q[i], doubt[i] = back.q[mesh] * scale, back.doubt[mesh] * np.abs(scale)
        return _Column(q, doubt, back.resonance)

    def _scale(self, w: Floats, i: int, j: int) -> Complex:
        """From the difference of approach at mesh i per force at mesh j to Q_ij: k_j (1 + i w c_i / k_i)."""
        one, other = self.train.meshes[i], self.train.meshes[j]
        return np.asarray(other.stiffness * (1.0 + 1j * w * (one.damping / one.stiffness)))

    def _solve(self, network: Network, w: Floats, mesh: int, variant: int = 0) -> _Column:
        if network.links[mesh].a == network.links[mesh].b:
            return self._rigid(w, mesh)
        return self._column(w, mesh, respond(network, w, mesh, self._order(mesh, variant)))

    def _by_ways(self, ways: Ways, mesh: int) -> _Column:
        w, link = ways.solved.w, self.plain.links[mesh]
        return self._rigid(w, mesh) if link.a == link.b else self._column(w, mesh, ways.respond(mesh))

    def _rigid(self, w: Floats, mesh: int) -> _Column:
        """Rigid shafts join the two gears: the teeth take all of the error."""
        q = np.zeros((len(self.train.meshes), w.size), dtype=complex)
        q[mesh] = -1.0
        return _Column(q, np.zeros(q.shape), np.zeros(w.size, dtype=bool))

    def _column(self, w: Floats, mesh: int, response: Response) -> _Column:
        count, eps = len(self.train.meshes), float(np.finfo(w.dtype).eps)
        q = np.zeros((count, w.size), dtype=complex)
        doubt = np.zeros((count, w.size))
        q[mesh], doubt[mesh] = response.own.value, eps * response.own.error
        for i, lag in response.lags.items():
            scale = self._scale(w, i, mesh)
            q[i], doubt[i] = lag.value * scale, eps * lag.error * np.abs(scale)
        return _Column(q, doubt, response.resonance)

    def _by_pivots(self, w: Floats, mesh: int) -> _Column:
        """Increments as Mark writes them, R H - 1, from the equations as they stand."""
        lags = lags_by_pivots(self.long, w.astype(np.longdouble), mesh)
        scales = [self._scale(w, i, mesh) for i in range(len(lags))]
        q = np.stack([lag.value * scale for lag, scale in zip(lags, scales, strict=True)])
        error = np.stack([lag.error * np.abs(scale) for lag, scale in zip(lags, scales, strict=True)])
        q[mesh] -= 1.0
        error[mesh] += 1.0
        resonance = RESONANCE * error[mesh] >= 1.0 + np.abs(q[mesh])
        doubt = (np.finfo(w.dtype).eps * error).astype(float)
        return _Column(q.astype(complex), doubt, np.asarray(resonance))


#: How near to a whole power of the frequency an increment has to be where its first term is taken.
_WHOLE = 1e-6


#: Share of the lowest natural frequency where the search begins, by how much it goes down, and how often.
_FIRST, _DOWN, _STEPS = 1e-3, 1e-2, 12


def high_frequency_increments(train: Train, omega: ArrayLike) -> Complex:
    """Increments of a train whose bodies turn as free inertias (2.64, 2.66, for any train).

    Parameters
    ----------
    train : Train
    omega : array_like, shape (...)
        Angular frequency [rad/s], not zero.

    Returns
    -------
    ndarray, shape (meshes, meshes, ...)
        -1 for i = j, plus (1 + s c_i/k_i) k_j G_ij / s^2 with G_ij the approach of mesh i per second squared and unit
        force in mesh j; zero where two meshes share no body.
    """
    s = 1j * np.asarray(omega, dtype=float)
    k = np.array([mesh.stiffness for mesh in train.meshes])
    lag = np.array([mesh.damping for mesh in train.meshes]) / k
    share = (train.approach / train.inertia) @ train.approach.T * k
    wave = (1.0 + np.multiply.outer(lag, s))[:, None] / s**2
    own = np.eye(k.size).reshape(k.size, k.size, *(1,) * s.ndim)
    return np.asarray(share.reshape(*share.shape, *(1,) * s.ndim) * wave - own)


def low_frequency_terms(train: Train) -> tuple[Array, Array]:
    """First terms c s^p of every increment, s = i w.

    Each is read off where the increment follows a whole power of the frequency to `_WHOLE`; it has all its digits
    there, for increments are computed free of cancellation.

    Returns
    -------
    c : ndarray, shape (meshes, meshes)
        [s^p]; zero where mesh j does nothing to mesh i.
    p : ndarray of int, shape (meshes, meshes)

    Raises
    ------
    RangeError
        If some increment follows no power at any frequency that was tried.
    """
    lowest = modes(train).frequencies[1:]
    w = 2.0 * math.pi * (float(lowest.min()) if lowest.size else 1.0) * _FIRST
    for _ in range(_STEPS):
        q = dynamic_increments(train, np.array([w, 2.0 * w]))
        size = np.abs(q)
        coupled = size[..., 0] > 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = np.where(coupled, np.log2(size[..., 1] / size[..., 0]), 0.0)
        power = np.rint(slope)
        if np.all(np.abs(slope - power) < _WHOLE):
            c = np.where(coupled, (q[..., 0] / (1j * w) ** power).real, 0.0)
            return c, power.astype(int)
        w *= _DOWN
    raise RangeError(
        "frequency", f"{w / _DOWN / (2.0 * math.pi):.3g} Hz", "is too high for a low-frequency asymptote",
        "remove negligible damping",
    )  # fmt: skip


def low_frequency_increments(train: Train, omega: ArrayLike) -> Complex:
    """First terms of every increment at angular frequencies [rad/s], shape (meshes, meshes, ...) (2.62, 2.65)."""
    s = 1j * np.asarray(omega, dtype=float)
    c, p = (part.reshape(*part.shape, *(1,) * s.ndim) for part in low_frequency_terms(train))
    return np.asarray(c * s**p)
