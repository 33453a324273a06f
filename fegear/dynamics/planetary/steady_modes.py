"""Steady motion of damped modes under periodic forces that are polynomial between break points, without a series.

Over a piece a mode is a polynomial, which follows the force, and a ringing that decays; that it repeats with the period
says how much it rings. Jumps of the force are met exactly at every speed, low ones included, where a series would need
as many harmonics as the highest mode has waves in a period, and many times that.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Complex
from fegear.base.errors import RangeError
from fegear.dynamics.train.periodic import Periodic

#: Degree of the polynomials of forces: that of `Periodic.fit`.
_DEGREE = 8
#: Break points closer than this are one [periods].
_ONE = 1e-9
#: |rate times half a piece| up to which the polynomial is built from its constant upwards, beyond from its highest
#: power downwards: each way is stable where the other is not.
_UPWARDS = 4.0
#: A mode that meets a harmonic this closely, relative to it, without damping has no steady motion.
_RESONANT = 1e-12


@dataclass(frozen=True)
class PiecewiseForces:
    """Periodic functions of one period, polynomial between the same break points.

    Parameters
    ----------
    starts, widths : ndarray, shape (S,)
        Of the pieces [periods].
    rows : ndarray, shape (F, S, degree + 1)
        Of every function powers of v, which runs from -1 to 1 over the piece, lowest first.
    """

    starts: Array
    widths: Array
    rows: Array

    def at(self, piece: Array, v: Array) -> Array:
        """Values in pieces, shape (Q,), at places v of them, shape (Q, M): shape (F, Q, M)."""
        return _polynomial(np.moveaxis(self.rows, 2, 0), piece, v)


def on_common_pieces(functions: Sequence[Periodic], delays: Array) -> PiecewiseForces:
    """Functions of one base pitch, each behind by its delay and without its mean, between the break points of all.

    Parameters
    ----------
    functions : sequence of Periodic, length F
    delays : ndarray, shape (F,)
        [base pitches]
    """
    cuts = np.concatenate([one.breaks[:-1] + late for one, late in zip(functions, delays, strict=True)]) % 1.0
    starts = np.unique(cuts)
    starts = starts[np.append(True, np.diff(starts) > _ONE)]
    if starts.size > 1 and starts[0] + 1.0 - starts[-1] <= _ONE:
        starts = starts[:-1]
    widths = np.diff(np.append(starts, starts[0] + 1.0))
    nodes = -np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    places = starts[:, None] + 0.5 * widths[:, None] * (nodes + 1.0)
    to_power = np.linalg.inv(np.vander(nodes, increasing=True))
    rows = np.array([
        (one(places - late) - one.mean) @ to_power.T for one, late in zip(functions, delays, strict=True)
    ])  # fmt: skip
    return PiecewiseForces(starts, widths, rows)


@dataclass(frozen=True)
class SteadyModes:
    """Modes under piecewise polynomial forces at one period: Im(P(v) + A exp(mu (v + 1))) over their damped frequency.

    Parameters
    ----------
    rate : ndarray, complex, shape (J,)
        Of every mode: its damping and damped frequency [1/s].
    halves : ndarray, shape (S,)
        Half the durations of the pieces [s].
    polynomials : ndarray, shape (N, J, S)
        Im P, powers of v, lowest first: v is real.
    ringing : ndarray, complex, shape (J, S)
        A.
    """

    rate: Complex
    halves: Array
    polynomials: Array
    ringing: Complex

    def at(self, piece: Array, v: Array) -> Array:
        """Modal coordinates in pieces, shape (Q,), at places v of them, shape (Q, M): shape (J, Q, M)."""
        steady = _polynomial(self.polynomials, piece, v)
        late = self.halves[piece][:, None] * (v + 1.0)
        ringing = self.ringing[:, piece, None] * np.exp(self.rate[:, None, None] * late)
        return np.asarray((steady + ringing.imag) / self.rate.imag[:, None, None])


def _polynomial(powers: Array, piece: Array, v: Array) -> Array:
    found = np.zeros((powers.shape[1], *v.shape))
    for power in powers[::-1, :, piece]:
        found *= v
        found += power[..., None]
    return found


def steady_modes(
    natural: Array, damping_ratio: float, periods: Array, widths: Array, forces: Array
) -> list[SteadyModes]:
    """Steady modes x'' + 2 zeta w x' + w^2 x = f at periods of the forces.

    Parameters
    ----------
    natural : ndarray, shape (J,)
        Natural frequencies w [rad/s], none of them zero.
    damping_ratio : float
        zeta of every mode, below one.
    periods : ndarray, shape (W,)
        [s]
    widths : ndarray, shape (S,)
        Of the pieces [periods].
    forces : ndarray, shape (J, S, degree + 1)
        Powers of v of the force on every mode, over unit modal mass.

    Raises
    ------
    RangeError
        If a harmonic meets a natural frequency without damping.
    """
    turns = natural * periods[:, None] / (2.0 * math.pi)
    if damping_ratio == 0.0 and np.any((np.abs(turns - np.rint(turns)) <= _RESONANT * turns) & (turns > 0.5)):
        raise RangeError(
            "speed", "a resonance", "is a natural frequency of the undamped planetary set",
            "specify damping_ratio or remove this speed",
        )  # fmt: skip
    rate: Complex = np.asarray(natural * complex(-damping_ratio, math.sqrt(1.0 - damping_ratio**2)), dtype=complex)
    halves = 0.5 * periods[:, None] * widths  # (W, S)
    step: Complex = np.asarray(rate[None, :, None] * halves[:, None, :], dtype=complex)  # (W, J, S)
    polynomials = _particular(step, halves[:, None, :] * np.moveaxis(forces, 2, 0)[:, None])  # (N, W, J, S)
    odd = polynomials[1::2].sum(axis=0)
    even = polynomials[::2].sum(axis=0)
    gap = even + odd - np.roll(even - odd, -1, axis=-1)  # at the end of each piece
    decay = np.exp(2.0 * step)
    first = np.zeros(step.shape[:2], dtype=complex)
    for piece in range(widths.size):
        first = first * decay[..., piece] + gap[..., piece]
    first /= -np.expm1(rate * periods[:, None])
    ringing = np.empty_like(step)
    for piece in range(widths.size):
        ringing[..., piece] = first
        first = first * decay[..., piece] + gap[..., piece]
    each = np.ascontiguousarray(np.moveaxis(polynomials.imag, 1, 0))
    return [SteadyModes(rate, *parts) for parts in zip(halves, each, ringing, strict=True)]


def _particular(step: Complex, force: Array) -> Complex:
    """Polynomials with P' = step P + force: (n + 1) c_{n+1} = step c_n + f_n, upwards from zero or downwards.

    Parameters
    ----------
    step : ndarray, complex, shape (...)
    force : ndarray, shape (degree + 1, ...)

    Returns
    -------
    ndarray, complex, shape (N, ...)
        One power after the other, lowest first: each is read and written at once.
    """
    degree, size = force.shape[0] - 1, np.abs(step)
    small = size <= _UPWARDS
    down = np.zeros((degree + 1, *step.shape), dtype=complex)
    over = 1.0 / np.where(small, 1.0, step)
    higher: Complex = np.zeros_like(step)
    for n in range(degree, -1, -1):
        down[n] = higher = ((n + 1) * higher - force[n]) * over
    if not small.any():
        return down
    count, most = degree + 1, float(size[small].max())
    term = 1.0
    while term > 1e-17 or count < degree + 3:
        count += 1
        term *= most / (count - degree)
    up = np.zeros((count + 1, *step.shape), dtype=complex)
    bounded = np.where(small, step, 0.0)
    for n in range(count):
        up[n + 1] = (bounded * up[n] + (force[n] if n <= degree else 0.0)) / (n + 1)
    np.copyto(up[: degree + 1], down, where=~small)
    up[degree + 1 :, ~small] = 0.0
    return up
