"""Periodic functions that jump: polynomials between known break points, with exact Fourier coefficients."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import ConvergenceError, InputError

#: Most pieces whose values are asked for at once.
_AT_ONCE = 64
#: Length of a piece below which a jump is looked for no longer [periods].
_JUMP = 1e-9
#: Jumps that a coarser function keeps, over its tolerance, and changes of slope, over its size in a period.
_SEEN, _BENT = 0.01, 1e-3


@dataclass(frozen=True)
class Periodic:
    """A function of the phase (position in base pitches), polynomial between break points, of period 1 or more.

    Parameters
    ----------
    breaks : ndarray, shape (pieces + 1,)
        Break points in periods, from 0 to 1, increasing.
    coefficients : ndarray, shape (pieces, degree + 1)
        Row i holds the powers of v, which runs from -1 to 1 over piece i, lowest first (powers about the middle keep
        their digits where powers about the start would lose five).
    pitches : int
        Base pitches in one period (1, or the tooth number for spacing errors).

    Raises
    ------
    InputError
        If the break points do not run from 0 to 1, or a coefficient is not finite.
    """

    breaks: Array
    coefficients: Array
    pitches: int = 1

    def __post_init__(self) -> None:
        breaks = np.array(self.breaks, dtype=float)
        coefficients = np.atleast_2d(np.array(self.coefficients, dtype=float))
        if breaks.size < 2 or breaks[0] != 0.0 or breaks[-1] != 1.0 or np.any(np.diff(breaks) <= 0.0):
            raise InputError("periodic.breaks", breaks.tolist(), "must increase from 0 to 1")
        if coefficients.shape[0] != breaks.size - 1:
            raise InputError("periodic.coefficients", coefficients.shape, f"must have {breaks.size - 1} rows")
        if not np.all(np.isfinite(coefficients)):
            raise InputError("periodic.coefficients", "nan or inf", "must be finite")
        if self.pitches < 1:
            raise InputError("periodic.pitches", self.pitches, "must be a whole number of at least 1")
        for name, array in (("breaks", breaks), ("coefficients", coefficients)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @classmethod
    def constant(cls, value: float) -> Periodic:
        """The same value everywhere."""
        return cls(np.array([0.0, 1.0]), np.array([[value]]))

    @classmethod
    def fit(
        cls,
        function: Callable[[Array], Array],
        breaks: Iterable[float] = (),
        *,
        degree: int = 8,
        tolerance: float = 1e-12,
        pitches: int = 1,
        shortest: float = 0.0,
        scale: float = 0.0,
        ahead: Callable[[list[Array]], None] | None = None,
        pointwise: bool = False,
    ) -> Periodic:
        """Fit a vectorised function of the period fraction s, smooth between `breaks`, halving pieces as needed.

        Parameters
        ----------
        function : callable
            Takes an array of s in (0, 1), one piece at a time unless it is `pointwise`, never a break point itself.
        breaks : iterable of float
            Where the function or a derivative jumps, in (0, 1); 0 and 1 are always break points.
        degree : int
            Degree of each piece (Chebyshev interpolation).
        tolerance : float
            Largest error relative to the largest value.
        pitches : int
            Base pitches in one period.
        shortest : float
            Pieces of at most this length [periods] are taken as they are (a square root's tip, a clipped logarithm).
        scale : float
            Size relative to which errors count where the function itself is smaller: a difference of things so large.
        ahead : callable, optional
            Takes the places of all pieces that the function is asked for next, to compute them at once.
        pointwise : bool
            Whether a value depends on its own place only: the function is then asked for many pieces in one array.

        Raises
        ------
        ConvergenceError
            If the pieces get shorter than 1e-9 periods, or a thousandth of what is between two break points that are
            nearer to each other than that: a jump that is not declared.
        """
        nodes, to_power = _chebyshev(degree)
        probe = np.array([-0.9726, -0.746, -0.218, 0.2346, 0.684, 0.9822])
        inner = sorted(b for b in {float(b) for b in breaks} if 1e-13 < b < 1.0 - 1e-13)
        cuts = [0.0, *inner, 1.0]
        cuts = [c for n, c in enumerate(cuts) if n == 0 or c - cuts[n - 1] > 1e-12 or c == 1.0]
        if len(cuts) > 2 and cuts[-1] - cuts[-2] <= 1e-12:
            del cuts[-2]
        places = np.concatenate([nodes, probe])
        # between break points that are nearer to each other than a jump is looked for there is still what can be halved
        waiting = [(a, b, min(_JUMP, (b - a) / 1024.0)) for a, b in pairwise(cuts)]
        rows: dict[float, Array] = {}
        while waiting:  # the halves made last come first: what is rough everywhere is refused before there are many
            pieces, waiting = waiting[-_AT_ONCE:], waiting[:-_AT_ONCE]
            at = [0.5 * (a + b) + 0.5 * (b - a) * places for a, b, _ in pieces]
            if ahead is not None:
                ahead(at)
            if pointwise:
                found = list(np.reshape(np.asarray(function(np.concatenate(at)), dtype=float), (len(at), places.size)))
            else:
                found = [np.asarray(function(s), dtype=float) for s in at]
            scale = max(scale, *(float(np.max(np.abs(values))) for values in found))
            for (a, b, least), values in zip(pieces, found, strict=True):
                row, h = to_power @ values[: degree + 1], b - a
                error = np.max(np.abs(np.polynomial.polynomial.polyval(probe, row) - values[degree + 1 :]))
                # Between break points that all but coincide a place is known to 1e-7 of the piece or less: what the
                # function changes there is known no better. A jump that was not declared errs by much of itself.
                unknown = 4.0 * np.finfo(float).eps / h * np.ptp(values)
                narrow = h < _JUMP and error <= max(1e-8 * scale, unknown)
                if not error > tolerance * scale or h <= shortest or narrow:
                    rows[a] = row
                    continue
                if h < least:
                    raise ConvergenceError(
                        f"A periodic function cannot be fitted near s = {a:.9g}: error {error:.3g} of {scale:.3g}. "
                        "Name its jump among the break points."
                    )
                middle = 0.5 * (a + b)
                waiting += [(a, middle, least), (middle, b, least)]
        starts = sorted(rows)
        return cls(np.array([*starts, 1.0]), np.array([rows[a] for a in starts]), pitches)

    @classmethod
    def through_points(cls, s: ArrayLike, values: ArrayLike, *, pitches: int = 1) -> Periodic:
        """Straight lines through points; two points at the same s make a jump. s runs from 0 to 1."""
        x, y = np.asarray(s, dtype=float), np.asarray(values, dtype=float)
        if x.shape != y.shape or x.ndim != 1 or x.size < 2 or np.any(np.diff(x) < 0.0):
            raise InputError("periodic.points", x.tolist(), "must be two lists of one length, s not decreasing")
        piece = np.flatnonzero(np.diff(x) > 0.0)
        return cls(
            np.append(x[piece], x[-1]),
            0.5 * np.column_stack([y[piece] + y[piece + 1], y[piece + 1] - y[piece]]),
            pitches,
        )

    @classmethod
    def joined(cls, parts: Sequence[Periodic]) -> Periodic:
        """One function after the other, each over one base pitch of its own.

        Parameters
        ----------
        parts : sequence of Periodic
            Functions of one base pitch; part p counts from phase p to p + 1.

        Raises
        ------
        InputError
            If there are none, or one is longer than a base pitch.
        """
        if not parts or any(part.pitches != 1 for part in parts):
            raise InputError("periodic.parts", len(parts), "must be functions of one base pitch each")
        count, width = len(parts), max(part.coefficients.shape[1] for part in parts)
        breaks = np.concatenate([(p + part.breaks[:-1]) / count for p, part in enumerate(parts)])
        rows = [np.pad(part.coefficients, ((0, 0), (0, width - part.coefficients.shape[1]))) for part in parts]
        return cls(np.append(breaks, 1.0), np.concatenate(rows), count)

    def _locate(self, phase: ArrayLike) -> tuple[NDArray[np.intp], Array]:
        s = np.asarray(phase, dtype=float) / self.pitches
        s = s - np.floor(s)
        piece = np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, self.breaks.size - 2)
        start, end = self.breaks[piece], self.breaks[piece + 1]
        return piece, ((s - start) - (end - s)) / (end - start)

    def __call__(self, phase: ArrayLike) -> Array:
        """Value at a phase in base pitches; at a jump, the value after it."""
        piece, v = self._locate(phase)
        value = np.zeros_like(v)
        for power in range(self.coefficients.shape[1] - 1, -1, -1):
            value = value * v + self.coefficients[piece, power]
        return value

    def slope(self, phase: ArrayLike) -> Array:
        """Derivative with respect to the phase, per base pitch."""
        half = 0.5 * np.diff(self.breaks)[:, None] * self.pitches
        powers = np.arange(1, self.coefficients.shape[1])
        rows = self.coefficients[:, 1:] * powers / half if powers.size else np.zeros((self.breaks.size - 1, 1))
        return Periodic(self.breaks, rows, self.pitches)(phase)

    @property
    def mean(self) -> float:
        """Mean value over a period."""
        even = self.coefficients[:, ::2] / (2.0 * np.arange((self.coefficients.shape[1] + 1) // 2) + 1.0)
        return float(np.diff(self.breaks) @ even.sum(axis=1))

    def fourier(self, n: ArrayLike) -> Complex:
        """Complex Fourier coefficients: f(s) = sum alpha_n exp(2 pi i n s), exact for every n.

        Each piece is taken in Legendre polynomials, whose transforms are spherical Bessel functions, so that large
        and small n are equally exact; a sampled transform would converge like 1/N at jumps.
        """
        order = np.ascontiguousarray(n, dtype=float)
        shape = self.coefficients.shape
        return _fourier(self.breaks.tobytes(), self.coefficients.tobytes(), shape, order.tobytes()).reshape(order.shape)

    def scaled(self, factor: float) -> Periodic:
        """The function times a number."""
        return Periodic(self.breaks, factor * self.coefficients, self.pitches)

    def plus(self, constant: float) -> Periodic:
        """The function plus a number."""
        rows = np.array(self.coefficients)
        rows[:, 0] += constant
        return Periodic(self.breaks, rows, self.pitches)

    def coarser(self, tolerance: float) -> Periodic:
        """The function in as few pieces as keep it within a tolerance of its largest value; its jumps stay.

        Parameters
        ----------
        tolerance : float
        """
        powers = np.arange(self.coefficients.shape[1])
        half, signs = 0.5 * np.diff(self.breaks), (-1.0) ** powers
        starts, ends = self.coefficients @ signs, self.coefficients.sum(axis=1)
        rise = (self.coefficients * -powers) @ signs / half, (self.coefficients * powers).sum(axis=1) / half
        scale = float(np.abs(self.coefficients).sum(axis=1).max())
        jumps = np.abs(starts - np.roll(ends, 1)) > _SEEN * tolerance * scale
        kinks = np.abs(rise[0] - np.roll(rise[1], 1)) > _BENT * scale
        cuts = self.breaks[:-1][jumps | kinks]
        few = Periodic.fit(lambda s: self(s * self.pitches), cuts, tolerance=tolerance, pitches=self.pitches,
                           pointwise=True)  # fmt: skip
        return few if few.breaks.size < self.breaks.size else self

    def breaks_over(self, pitches: int) -> Array:
        """Break points in pitches over a longer window of whole periods, both ends included."""
        turns = pitches // self.pitches
        spots = (np.arange(turns)[:, None] + self.breaks[None, :-1]).ravel() * self.pitches
        return np.append(spots, float(pitches))


def combine(
    parts: tuple[Periodic, ...],
    rule: Callable[..., Array],
    *,
    extra_breaks: Iterable[float] = (),
    degree: int = 8,
    tolerance: float = 1e-12,
    shortest: float = 0.0,
    scale: float = 0.0,
) -> Periodic:
    """Fit ``rule(part_1(phase), part_2(phase), ...)`` over the common period of all parts.

    `extra_breaks` are phases in base pitches where the rule itself has kinks. The rule is one of single values.
    """
    pitches = math.lcm(*(part.pitches for part in parts))
    cuts = np.unique(np.concatenate([*(part.breaks_over(pitches) for part in parts), np.array([*extra_breaks])]))
    return Periodic.fit(
        lambda s: rule(*(part(s * pitches) for part in parts)),
        cuts / pitches,
        degree=degree,
        tolerance=tolerance,
        pitches=pitches,
        shortest=shortest,
        scale=scale,
        pointwise=True,
    )


@lru_cache(maxsize=16)
def _fourier(breaks: bytes, coefficients: bytes, shape: tuple[int, int], order: bytes) -> Complex:
    """Coefficients of `Periodic.fourier`; spectra, forces and stresses of one train ask for the same ones."""
    from scipy.special import spherical_jn

    cuts, flat = np.frombuffer(breaks), np.frombuffer(order)
    legendre = np.frombuffer(coefficients).reshape(shape) @ _to_legendre(shape[1] - 1).T
    total = np.zeros(flat.size, dtype=complex)
    degrees = np.arange(shape[1])
    for start, width, row in zip(cuts[:-1], np.diff(cuts), legendre, strict=True):
        half = math.pi * np.abs(flat) * width
        turn = np.exp(-2j * math.pi * np.abs(flat) * (start + 0.5 * width))
        total += width * turn * ((row * (-1j) ** degrees) @ spherical_jn(degrees[:, None], half[None, :]))
    found = np.where(flat < 0.0, np.conj(total), total)
    found.flags.writeable = False
    return found


@cache
def _chebyshev(degree: int) -> tuple[Array, Array]:
    """Chebyshev nodes on (-1, 1) and the matrix from values there to powers of v."""
    nodes = -np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    basis = np.polynomial.chebyshev.chebvander(nodes, degree)
    to_chebyshev = np.linalg.inv(basis)
    to_power = np.zeros((degree + 1, degree + 1))
    for k in range(degree + 1):
        to_power[: k + 1, k] = np.polynomial.chebyshev.cheb2poly(np.eye(degree + 1)[k, : k + 1])
    return nodes, to_power @ to_chebyshev


@cache
def _to_legendre(degree: int) -> Array:
    """Matrix from powers of v to Legendre polynomials."""
    matrix = np.zeros((degree + 1, degree + 1))
    for k in range(degree + 1):
        matrix[: k + 1, k] = np.polynomial.legendre.poly2leg(np.eye(degree + 1)[k, : k + 1])
    return matrix
