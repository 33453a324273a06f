"""Torque that fluctuates about the constant torque of a body: harmonics, as they are given or read off one period.

T(t) = sum over n of A_n cos(2 pi n f t + phi_n), positive in the sense in which torques of the train count. The base
frequency f is fixed, or an order: so many periods in a turn of the first body.

Motion in time is closed over one period of all that excites it: the period that ripple and gear pairs have in common.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown
from fegear.dynamics.train.periodic import Periodic

#: Periods of the fastest gear pair that the common period may take.
LONGEST = 2000
#: Shift of a ripple's frequency that is small enough to end the search for a common period, and the largest taken.
SMALL_SHIFT, LARGEST_SHIFT = 1e-4, 0.02
#: How near a fixed frequency is to a whole ratio that is meant.
_WHOLE = 1e-11
#: How near the span of a file's angles is to a ratio of small numbers that is meant, and these numbers.
_RATIO, _SMALL = 1e-7, 1000
#: Harmonics below this share of the largest torque of a curve are round-off.
_NOTHING = 1e-14
#: Moments of one period at which a waveform is looked at, over its highest harmonic.
_SAMPLES = 64


@dataclass(frozen=True)
class TorqueRipple:
    """A torque that fluctuates at one body.

    Parameters
    ----------
    name, body : str
        Its own name, and the body that it acts on.
    amplitudes, phases : tuple of float
        Of the harmonics 1, 2, ... [N m, rad]; cosine, at time zero.
    order : (int, int), optional
        Base frequency over the rotation frequency of the first body, as a ratio of whole numbers.
    frequency : float
        Base frequency [Hz], where there is no order.
    left_out : float
        Root mean square of the harmonics that were left out [N m].

    Raises
    ------
    InputError
        If there is no harmonic, an amplitude is negative or not finite, or the base frequency is not positive.
    """

    name: str
    body: str
    amplitudes: tuple[float, ...]
    phases: tuple[float, ...]
    order: tuple[int, int] | None = None
    frequency: float = 0.0
    left_out: float = shown(
        "N.m", "root mean square torque of the omitted harmonics of the file", name="torque_left_out", default=0.0
    )

    def __post_init__(self) -> None:
        key = f"torque_ripple.{self.name}"
        if not self.amplitudes or len(self.phases) != len(self.amplitudes):
            raise InputError(f"{key}.phases", len(self.phases), f"must be {len(self.amplitudes)}, one per amplitude")
        if not all(math.isfinite(a) and a >= 0.0 for a in self.amplitudes):
            raise InputError(f"{key}.amplitudes", list(self.amplitudes), "must be zero or positive")
        if not all(map(math.isfinite, self.phases)):
            raise InputError(f"{key}.phases", list(self.phases), "must be finite")
        base = self.frequency if self.order is None else self.order[0] / self.order[1]
        if not (math.isfinite(base) and base > 0.0):
            raise InputError(f"{key}.frequency", base, "must be positive", "specify constant torques in torque")

    @property
    def harmonics(self) -> NDArray[np.int64]:
        """Numbers of the harmonics that are there."""
        return np.flatnonzero(np.array(self.amplitudes)) + 1

    @property
    def torques(self) -> Complex:
        """Complex amplitudes of these [N m]: T = Re sum A exp(i w t)."""
        size, phase = np.array(self.amplitudes), np.array(self.phases)
        return np.asarray((size * np.exp(1j * phase))[size != 0.0])

    def base_frequency(self, speed: float | Array) -> Array:
        """Base frequency [Hz] at speeds of the first body [rad/s]."""
        turns = np.abs(np.asarray(speed, dtype=float)) / (2.0 * math.pi)
        if self.order is None:
            return np.full(turns.shape, self.frequency)
        return np.asarray(self.order[0] / self.order[1] * turns)

    def frequencies(self, speed: float | Array) -> Array:
        """Frequencies of the harmonics [Hz], shape (harmonics, ...), at speeds of the first body [rad/s]."""
        return np.multiply.outer(self.harmonics, self.base_frequency(speed))

    def extremes(self, coefficients: Complex) -> tuple[float, float]:
        """Smallest and largest of what harmonics of complex amplitudes, in the order of `torques`, add up to."""
        if len(coefficients) == 1:
            return -float(abs(coefficients[0])), float(abs(coefficients[0]))
        size = _SAMPLES * int(self.harmonics.max(initial=1))
        spectrum = np.zeros(size // 2 + 1, dtype=complex)
        spectrum[self.harmonics] = coefficients
        found = 0.5 * size * np.fft.irfft(spectrum, size)
        return float(found.min()), float(found.max())


def ripple_of_curve(
    name: str, body: str, place: ArrayLike, torque: ArrayLike, harmonics: int, turn: Fraction | None = None
) -> tuple[TorqueRipple, float]:
    """The ripple of a torque over one period, straight between its entries, and its mean [N m], which is left out.

    Parameters
    ----------
    name, body : str
    place : array_like, shape (n,)
        Time [s], or angle of a body [turns], rising; the last entry is one period past the first.
    torque : array_like, shape (n,)
        [N m]; the last repeats the first.
    harmonics : int
        How many are kept.
    turn : Fraction, optional
        Turns of the body whose angle it is per turn of the first body; without it places are times.
    """
    at, value = np.asarray(place, dtype=float), np.asarray(torque, dtype=float)
    span = float(at[-1] - at[0])
    share = (at - at[0]) / span
    share[-1] = 1.0
    curve = Periodic.through_points(share, value)
    mean, n = curve.mean, np.arange(1, harmonics + 1)
    found = 2.0 * curve.fourier(n) * np.exp(-2j * math.pi * n * (at[0] / span))
    # mean square of straight lines, less those of mean and harmonics
    whole = float(np.sum(np.diff(share) * (value[:-1] ** 2 + value[:-1] * value[1:] + value[1:] ** 2) / 3.0))
    rest = max(whole - mean**2 - 0.5 * float(np.sum(np.abs(found) ** 2)), 0.0)
    size = np.where(np.abs(found) > _NOTHING * float(np.max(np.abs(value))), np.abs(found), 0.0)
    order = None if turn is None else turn / _exact(span)
    base = None if order is None else (order.numerator, order.denominator)
    ripple = TorqueRipple(
        name, body, tuple(size.tolist()), tuple(np.angle(found).tolist()), base,
        1.0 / span if order is None else 0.0, math.sqrt(rest),
    )  # fmt: skip
    return ripple, mean


def _exact(span: float) -> Fraction:
    """A span of an angle [turns] as a ratio: of small whole numbers where a table's digits mean one."""
    near = Fraction(span).limit_denominator(_SMALL)
    return near if near > 0 and abs(float(near) - span) <= _RATIO * span else Fraction(repr(span))


@dataclass(frozen=True)
class CommonPeriod:
    """The period of gear pairs and ripple together.

    Attributes
    ----------
    count : int
        Periods that the gear pairs have in common by themselves.
    stretch : tuple of float
        Frequency of each ripple that fits into it over its own; one where there is such a period.
    """

    count: int
    stretch: tuple[float, ...]


def common_period(
    mesh_turns: Fraction, fastest: Fraction, speed: float, ripple: Sequence[TorqueRipple]
) -> CommonPeriod:
    """How often gear pairs repeat until every ripple does.

    Where that takes more than `LONGEST` periods of the fastest gear pair, or never happens, each ripple takes the
    nearest frequency that repeats in as few periods as shift it by at most `SMALL_SHIFT`; in the best number of periods
    where none does.

    Parameters
    ----------
    mesh_turns : Fraction
        Period of all gear pairs in turns of the first body.
    fastest : Fraction
        Mesh frequency of the fastest gear pair over the rotation frequency of the first body.
    speed : float
        Of the first body [rad/s].
    ripple : sequence of TorqueRipple

    Raises
    ------
    RangeError
        If a ripple is slower than the longest period, or none comes near enough.
    """
    most = max(int(LONGEST // (mesh_turns * fastest)), 1)
    cycles = np.array([float(one.base_frequency(speed)) for one in ripple]) * float(mesh_turns) * 2.0 * math.pi / speed
    exact = [_whole_cycles(one, mesh_turns, float(value), most) for one, value in zip(ripple, cycles, strict=True)]
    known = [ratio for ratio in exact if ratio is not None]
    count = math.lcm(*(ratio.denominator for ratio in known))
    if len(known) == len(exact) and count <= most:
        of_order = np.array([one.order is not None for one in ripple])
        stretch = np.where(of_order, 1.0, np.array([float(ratio) for ratio in known]) / cycles)
        return CommonPeriod(count, tuple(stretch.tolist()))
    counts = np.arange(1, most + 1)
    whole = np.rint(np.multiply.outer(counts, cycles))
    shift = whole / np.multiply.outer(counts, cycles) - 1.0
    worst = np.max(np.abs(shift), axis=1)
    good = np.flatnonzero(worst <= SMALL_SHIFT)
    at = int(good[0]) if good.size else int(np.argmin(worst))
    if worst[at] > LARGEST_SHIFT:
        slow = int(np.argmax(np.abs(shift[at])))
        base = float(ripple[slow].base_frequency(speed))
        raise RangeError(
            f"torque_ripple.{ripple[slow].name}", f"{base:.6g} Hz",
            f"is too low: the motion does not repeat within {LONGEST:,} mesh periods",
            "treat so slow a torque as constant: compare runs with different train.torque",
        )  # fmt: skip
    return CommonPeriod(int(counts[at]), tuple((1.0 + shift[at]).tolist()))


def _whole_cycles(one: TorqueRipple, mesh_turns: Fraction, cycles: float, most: int) -> Fraction | None:
    """Periods of a ripple in one of the gear pairs, exactly; None where no ratio of whole numbers is meant."""
    if one.order is not None:
        return Fraction(*one.order) * mesh_turns
    near = Fraction(cycles).limit_denominator(most)
    return near if abs(float(near) - cycles) <= _WHOLE * cycles else None
