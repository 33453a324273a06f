"""Orders of a pair over a revolution, and what indicators of gear condition make of its transmission error.

The signal splits as in vibration monitoring: the regular part are the mesh harmonics, the residual all else, the
difference the residual without the first sidebands of each mesh harmonic (Stewart 1977; Zakrajsek, Townsend and Decker
1993, NASA TM-105950). Here it is the computed transmission error, without the path to a sensor.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass, replace

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.shown import shown
from fegear.contact.error_over_pitch import secant_start
from fegear.contact.plane.over_revolution import OverRevolution

#: Even samples over a base pitch, and the highest harmonic of the mesh frequency.
_SAMPLES, HIGHEST = 128, 8
#: Positions nearer to each other than this share of a base pitch stand on both sides of a jump.
_JUMP = 1e-5
#: Share of the transmission error below which a part of it is round-off.
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class RevolutionOrders:
    """Harmonics over C base pitches, by their number n = 1..N."""

    n: Index = shown("", "harmonic of all base pitches until the same teeth mesh again", table="orders")
    mesh_order: Array = shown("", "order of the tooth-mesh frequency", table="orders")
    te: Array = shown(
        "um", "amplitude of this order of the transmission error", label="transmission error", table="orders"
    )
    mesh_stiffness: Array = shown(
        "N/um", "amplitude of this order of the mesh stiffness (secant)", label="mesh stiffness", table="orders"
    )


@dataclass(frozen=True)
class ConditionIndicators:
    """Condition indicators of the transmission error over a revolution; those of no residual are not a number."""

    residual_rms: float = shown("um", "RMS of the residual (transmission error without mesh harmonics)")
    residual_kurtosis: float = shown("", "kurtosis of the residual (3 for a normal distribution)")
    fm0: float = shown("", "FM0: peak-to-peak of the transmission error by the sum of its first eight mesh harmonics")
    fm4: float = shown("", "FM4: kurtosis of the difference signal (without mesh harmonics and first sidebands)")
    m6a: float = shown("", "M6A: sixth moment of the difference signal by the cube of its variance")
    energy_ratio: float = shown("", "energy ratio: RMS of the difference signal by that of the regular signal")
    sideband_level_factor: float = shown(
        "", "sideband level factor: first sidebands of the mesh frequency by the RMS of the transmission error"
    )


def _even(found: OverRevolution, curve: Array) -> Array:
    """A curve at even steps over all base pitches, straight between its rows."""
    count, start = found.transmission_error.shape[0], float(found.x[0])
    at = start + found.pitch * np.arange(count * _SAMPLES) / _SAMPLES
    return np.interp(at, found.along.ravel(), curve.ravel())


def amplitudes(even: Array, count: int) -> Array:
    """Amplitudes of the first harmonics of even samples over a period."""
    found = 2.0 * np.abs(np.fft.rfft(even)[1 : count + 1]) / even.size
    return np.pad(found, (0, count - found.size))


def revolution_orders(found: OverRevolution) -> RevolutionOrders:
    """Harmonics of transmission error and mesh stiffness over all base pitches, up to eight mesh harmonics."""
    cycles = found.transmission_error.shape[0]
    n = np.arange(1, HIGHEST * cycles + 1)
    te, stiffness = (amplitudes(_even(found, curve), n.size) for curve in (found.transmission_error, found.stiffness))
    return RevolutionOrders(n, n / cycles, te, stiffness)


def condition_indicators(found: OverRevolution, teeth: Sequence[int]) -> ConditionIndicators:
    """Condition indicators of the transmission error.

    Parameters
    ----------
    found : OverRevolution
    teeth : sequence of int
        Numbers of teeth of the gears whose teeth differ: their shafts' orders are the first sidebands.
    """
    return indicators_of(_even(found, found.transmission_error), found.transmission_error.shape[0], teeth)


def indicator_errors(found: OverRevolution, teeth: Sequence[int]) -> ConditionIndicators:
    """Estimated errors of the condition indicators: what errors of the gears and half of the positions change of them.

    That of the residual's RMS is relatively no less than that of its maximum: what all teeth have in common, errors of
    odd teeth do not share. Kurtosis and sixth moment go with second and third powers of a square: their relative errors
    are no less than once and twice that one.
    """

    def each(one: OverRevolution) -> Array:
        return np.array(astuple(condition_indicators(one, teeth)))

    here = each(found)
    off = found.shift(each) + np.abs(each(_every_second(found)) - here)
    if found.largest_residual > 0.0:
        part = found.largest_residual_error / found.largest_residual
        off = np.maximum(off, part * np.array([1.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0]) * here)
    return ConditionIndicators(*off.tolist())


def _every_second(found: OverRevolution) -> OverRevolution:
    """At half of the roll positions, and on both sides of jumps."""
    jump = np.diff(found.x) < _JUMP * found.pitch
    beside = np.append(jump, False) | np.append(False, jump)
    kept = beside | (np.cumsum(~beside) % 2 == 1)
    return replace(
        found, x=found.x[kept], transmission_error=found.transmission_error[:, kept],
        stiffness=found.stiffness[:, kept], loads=found.loads[:, :, kept], tangent=found.tangent[:, kept], others=(),
    )  # fmt: skip


def without_mesh_harmonics(signal: Array, cycles: int) -> Array:
    """The residual: a signal of even samples over so many base pitches without its mean and mesh harmonics."""
    spectrum = np.fft.rfft(signal)
    spectrum[::cycles] = 0.0
    return np.fft.irfft(spectrum, signal.size)


def indicators_of(te: Array, cycles: int, teeth: Sequence[int]) -> ConditionIndicators:
    """Condition indicators of a transmission error by even samples over so many base pitches."""
    spectrum = np.fft.rfft(te)
    spectrum[0] = 0.0
    mesh = np.arange(0, spectrum.size, cycles)
    regular = np.zeros_like(spectrum)
    regular[mesh] = spectrum[mesh]
    residual = spectrum - regular
    beside = {cycles // z for z in teeth if cycles % z == 0 and cycles > 1}
    first = np.array([n for shaft in beside for k in mesh for n in (k - shaft, k + shaft)], dtype=int)
    difference = residual.copy()
    difference[first[(first > 0) & (first < spectrum.size)]] = 0.0
    r, d, g = (np.fft.irfft(one, te.size) for one in (residual, difference, regular))
    whole = _rms(g + r)
    r, d = (np.where(_rms(one) > _ROUND_OFF * whole, one, 0.0) for one in (r, d))
    amplitude = 2.0 * np.abs(spectrum) / te.size
    harmonics = float(amplitude[mesh[1 : HIGHEST + 1]].sum())
    sides = sum(float(amplitude[cycles + side * shaft]) for shaft in beside for side in (-1, 1))
    sides = sides if sides > _ROUND_OFF * whole else 0.0
    return ConditionIndicators(
        _rms(r), _moment(r, 4), float(np.ptp(te)) / harmonics if harmonics else math.nan, _moment(d, 4),
        _moment(d, 6), _rms(d) / _rms(g) if _rms(g) else math.nan, sides / whole if whole else math.nan,
    )  # fmt: skip


def _rms(signal: Array) -> float:
    return float(np.sqrt(np.mean(signal**2)))


def _moment(signal: Array, power: int) -> float:
    """N sum s^n / (sum s^2)^(n/2) with the mean taken away; not a number where there is no signal."""
    size = _rms(signal)
    return float(np.mean(((signal - signal.mean()) / size) ** power)) if size > 0.0 else math.nan


@dataclass(frozen=True)
class AlongRevolution:
    """Rows of a pair over all base pitches, one position after the other."""

    base_pitch: Index = shown("", "number of the base pitch", table="revolution")
    driver_angle: Array = shown(
        "deg",
        "rotation of the driver, zero with the first teeth in contact at the pitch point",
        label="rotation of the driver",
        table="revolution",
    )
    x: Array = shown("mm", "mesh position: on the line of action over the base pitches", table="revolution")
    te: Array = shown("um", "transmission error", table="revolution")
    te_residual: Array = shown("um", "transmission error minus that of an ordinary base pitch", table="revolution")
    mesh_stiffness: Array = shown("N/um", "mesh stiffness (secant)", table="revolution")
    local_stiffness: Array = shown("N/um", "local (tangent) mesh stiffness dF/dTE", table="revolution")
    pairs_in_contact: Index = shown("", "number of tooth pairs in contact", table="revolution")
    te_0: Array = shown(
        "um", "transmission error minus load over mesh_stiffness: force = mesh_stiffness (deflection - te_0)"
    )
    te_error: Array | None = None
    mesh_stiffness_error: Array | None = None


def along_revolution(found: OverRevolution) -> AlongRevolution:
    """All base pitches one below the other."""
    base_radius = found.driver_base_radius
    cycles, positions = found.transmission_error.shape
    stated = bool(np.isfinite(found.transmission_error_error).all())
    return AlongRevolution(
        np.repeat(np.arange(cycles), positions), found.along.ravel() / base_radius, found.along.ravel(),
        found.transmission_error.ravel(), found.residual.ravel(), found.stiffness.ravel(), found.tangent.ravel(),
        (found.loads > 0.0).sum(axis=1).ravel(),
        secant_start(found.transmission_error.ravel(), found.stiffness.ravel(), found.load),
        found.transmission_error_error.ravel() if stated else None, found.stiffness_error.ravel() if stated else None,
    )  # fmt: skip
