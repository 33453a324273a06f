"""What is shown of a double helical pair: both halves, the base pitch, harmonics, load over both faces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.wide.transmission_error import series_over_pitch

if TYPE_CHECKING:
    from fegear.contact.double_helical.double_stress import LargestTension
    from fegear.contact.double_helical.loaded_double import DoubleError, LoadedDoublePair

#: A displacement of a smaller share of the transmission error, or a force of one of the load's, is none.
_ROUND_OFF = 1e-9
#: Both ends.
ENDS = ("I", "II")


@dataclass(frozen=True)
class DoubleHelicalData:
    """A double helical pair under all its loads, and the root stress of its halves at the nominal one.

    Parameters
    ----------
    pair : LoadedDoublePair
    at : int
        Number of the nominal load.
    stress : tuple of (LargestTension, LargestTension)
        Of driver and driven, of each half.
    """

    pair: LoadedDoublePair
    at: int
    stress: tuple[tuple[LargestTension, LargestTension], ...]

    @property
    def load_factor(self) -> float:
        """K_gamma at the nominal load."""
        return float(self.pair.load_factor[self.at])


@dataclass(frozen=True)
class HalfRow:
    """One half under the nominal load."""

    end: str = shown("", "end of the pair")
    share: float = shown("", "mean share of the load over the base pitch")
    share_max: float = shown("", "maximum share of the load over the base pitch")
    share_min: float = shown("", "minimum share of the load over the base pitch")
    load: float = shown("N", "mean load along the line of action")
    face_load_factor: float = shown("", "maximum / mean load per face width of the half", name="K_Hbeta")
    driver_tension: float = shown("MPa", "maximum root stress, tension side, driver", name="root_tension_driver")
    driven_tension: float = shown("MPa", "maximum root stress, tension side, driven", name="root_tension_driven")
    share_error: float | None = None
    share_max_error: float | None = None
    face_load_factor_error: float | None = None
    driver_tension_error: float | None = None
    driven_tension_error: float | None = None


@dataclass(frozen=True)
class DoubleOverPitch:
    """Both halves over the base pitch under the nominal load, by rising mesh position."""

    te_error: Array | None
    share_error: Array | None
    motion_error: Array | None
    force_error: Array | None
    x: Array = shown("mm", "mesh position of the half at end I", label="mesh position over one base pitch")
    te: Array = shown("um", "loaded transmission error of both halves", label="transmission error")
    first_share: Array = shown("", "share of the load, half at end I", name="share_I", label="share of the load")
    second_share: Array = shown("", "share of the load, half at end II", name="share_II")
    axial_motion: Array | None = shown(
        "um", "axial displacement of the floating member towards end II", label="axial displacement"
    )
    axial_force: Array = shown("N", "axial mesh force on the driver towards end II", label="axial force")
    mesh_stiffness: Array = shown("N/um", "tangent mesh stiffness of both halves")


@dataclass(frozen=True)
class DoubleHarmonics:
    """Amplitudes at the tooth-mesh frequency and its multiples under the nominal load."""

    n: NDArray[np.int64] = shown("", "harmonic of the tooth-mesh frequency")
    frequency: Array | None = shown("Hz", "at the speed of the pair")
    te: Array = shown("um", "amplitude of the transmission error")
    axial_motion: Array | None = shown("um", "amplitude of the axial displacement")
    axial_force: Array = shown("N", "amplitude of the axial mesh force on the driver")
    axial_acceleration: Array | None = shown(
        "m/s^2", "amplitude of the quasi-static axial acceleration of the floating member"
    )


@dataclass(frozen=True)
class FaceOfHalf:
    """Mean load over the face of one half under the nominal load."""

    end: str = shown("", "end of the pair")
    z: Array = shown("mm", "axial position from the middle of the gap")
    load: Array = shown("N/mm", "mean load per face width over the base pitch", label="load per face width")
    even: Array = shown("N/mm", "load of both halves over their face width")


@dataclass(frozen=True)
class DoubleOverLoads:
    """Numbers of the base pitch under every load, shape (L,)."""

    load: Array = shown("N", "load of both halves along the line of action")
    load_factor: Array = shown("", "load of the more loaded half / equal share (mean)", name="K_gamma")
    te_mean: Array = shown("um", "mean transmission error")
    te_peak_to_peak: Array = shown("um", "transmission error, peak-to-peak")
    K_Hbeta_I: Array = shown("", "maximum / mean load per face width, half at end I")
    K_Hbeta_II: Array = shown("", "maximum / mean load per face width, half at end II")
    motion_mean: Array | None = shown("um", "mean axial displacement of the floating member towards end II")
    motion_peak_to_peak: Array | None = shown("um", "axial displacement of the floating member, peak-to-peak")
    force_mean: Array = shown("N", "mean axial mesh force on the driver towards end II")


@dataclass(frozen=True)
class ShownDouble:
    """A double helical pair as it is shown at its nominal load.

    Parameters
    ----------
    data : DoubleHelicalData
    frequency : float
        Of the mesh [Hz], or NaN.
    """

    data: DoubleHelicalData
    frequency: float

    @property
    def pair(self) -> LoadedDoublePair:
        """Loaded."""
        return self.data.pair

    @property
    def at(self) -> int:
        """Number of the nominal load."""
        return self.data.at

    @property
    def loads(self) -> tuple[float, ...]:
        """Of both halves [N]."""
        return self.pair.spec.loads

    @property
    def error(self) -> DoubleError | None:
        """Estimated errors."""
        return self.pair.error

    @property
    def floating(self) -> str | None:
        """Member that floats."""
        return self.pair.spec.floating

    @cached_property
    def halves(self) -> dict[str, HalfRow]:
        """By their end."""
        return {end: self._half(number, end) for number, end in enumerate(ENDS)}

    def _half(self, number: int, end: str) -> HalfRow:
        pair, error, i = self.pair, self.error, self.at
        share, factors = pair.share[number, :, i], pair.face_load_factors[number]
        one, two = self.data.stress[number]
        off, worst = (
            (None, None) if error is None else (float(pair.mean(error.share)[i]), float(error.share[:, i].max()))
        )
        return HalfRow(
            end, float(pair.mean(share)), float(share.max()), float(share.min()),
            float(pair.mean(share)) * float(pair.load[i]), float(factors[i]), one.value, two.value, off, worst,
            None if error is None else float(error.face_load_factors[number, i]), one.error, two.error,
        )  # fmt: skip

    @cached_property
    def over_pitch(self) -> DoubleOverPitch:
        """Over the base pitch."""
        pair, error, i = self.pair, self.error, self.at
        load, span = float(pair.load[i]), abs(pair.spec.seat.span)

        def off(values: Array | None) -> Array | None:
            return None if values is None else values[:, i]

        share = None if error is None else error.share
        return DoubleOverPitch(
            off(None if error is None else error.transmission_error), off(share),
            off(None if error is None else error.axial_motion), None if share is None else off(share * load * span),
            pair.points.x, pair.transmission_error[:, i], pair.share[0, :, i], pair.share[1, :, i],
            pair.axial_motion[:, i] if self.floating else None, pair.axial_force[:, i], pair.balance.stiffness[:, i],
        )  # fmt: skip

    @cached_property
    def harmonics(self) -> DoubleHarmonics:
        """As far as the mesh positions show them."""
        pair, i = self.pair, self.at
        te, motion, force = (
            _amplitudes(pair, one[:, i], scale * _ROUND_OFF)
            for one, scale in (
                (pair.transmission_error, 0.0), (pair.axial_motion, self.te_mean), (pair.axial_force, pair.load[i])
            )
        )  # fmt: skip
        n = np.arange(1, te.size + 1)
        moved = motion if self.floating else None
        if math.isnan(self.frequency):
            return DoubleHarmonics(n, None, te, moved, force, None)
        frequency: Array = n.astype(float) * self.frequency
        accelerated = None if moved is None else (2.0 * np.pi * frequency) ** 2 * moved
        return DoubleHarmonics(n, frequency, te, moved, force, accelerated)

    @cached_property
    def faces(self) -> dict[str, FaceOfHalf]:
        """Load over the face of either half."""
        pair, i = self.pair, self.at
        even, found = float(pair.load[i]) / pair.spec.total_width, {}
        for end, half, middle in zip(ENDS, pair.halves, pair.spec.middles, strict=True):
            z = middle + 0.5 * (half.cells[1:] + half.cells[:-1])
            found[end] = FaceOfHalf(end, z, half.mean_over_face[:, i], np.full(z.size, even))
        return found

    @property
    def face_of_first(self) -> FaceOfHalf:
        """That of the half at end I."""
        return self.faces["I"]

    @cached_property
    def over_loads(self) -> DoubleOverLoads:
        """Under every load."""
        pair = self.pair
        motion, (first, second) = pair.axial_motion, pair.face_load_factors
        return DoubleOverLoads(
            pair.load, pair.load_factor, pair.mean_transmission_error, pair.peak_to_peak, first, second,
            pair.mean(motion) if self.floating else None, np.ptp(motion, axis=0) if self.floating else None,
            pair.mean(pair.axial_force),
        )  # fmt: skip

    @property
    @shows(
        "", "mesh load factor: load of the more loaded half / equal share (mean over the base pitch)", name="K_gamma"
    )
    def load_factor(self) -> float:
        """K_gamma."""
        return self.data.load_factor

    @property
    @shows("um", "mean transmission error of both halves over the base pitch")
    def te_mean(self) -> float:
        """[m]."""
        return float(self.pair.mean_transmission_error[self.at])

    @property
    @shows("um", "transmission error of both halves, peak-to-peak")
    def te_peak_to_peak(self) -> float:
        """[m]."""
        return float(self.pair.peak_to_peak[self.at])

    @property
    @shows("um", "mean axial displacement of the floating member towards end II")
    def axial_motion_mean(self) -> float | None:
        """[m]; None of located members."""
        if not self.floating:
            return None
        return _or_zero(float(self.pair.mean(self.pair.axial_motion)[self.at]), self.te_mean)

    @property
    @shows("um", "axial displacement of the floating member, peak-to-peak")
    def axial_motion_peak_to_peak(self) -> float | None:
        """[m]; None of located members."""
        if self.floating is None:
            return None
        return _or_zero(float(np.ptp(self.pair.axial_motion[:, self.at])), self.te_mean)

    @property
    @shows("um", "mean axial distance of the apexes under load, driver from driven, towards end II")
    def apex_distance(self) -> float:
        """[m]."""
        return float(self.pair.mean(self.pair.balance.position)[self.at])

    @property
    @shows("N", "mean axial mesh force on the driver towards end II")
    def axial_force_mean(self) -> float:
        """[N]."""
        return _or_zero(float(self.pair.mean(self.pair.axial_force)[self.at]), self._largest_force)

    @property
    @shows("N", "axial mesh force on the driver, peak-to-peak")
    def axial_force_peak_to_peak(self) -> float:
        """[N]."""
        return _or_zero(float(np.ptp(self.pair.axial_force[:, self.at])), self._largest_force)

    @property
    def _largest_force(self) -> float:
        """Axial force of one half that carries the whole load [N]."""
        return abs(self.pair.spec.seat.span) * float(self.pair.load[self.at])

    @property
    @shows("N/um", "axial stiffness of the mesh at constant torque")
    def axial_stiffness(self) -> float:
        """(t_1 - t_2)^2 k_1 k_2 / (k_1 + k_2) of the halves' mean tangent stiffness [N/m]; 0 where one is idle."""
        one, two = (float(half.lines.mean(half.contact.stiffness)[self.at]) for half in self.pair.halves)
        return self.pair.spec.seat.span**2 * one * two / (one + two)

    @property
    def share_error(self) -> float | None:
        """Of mean shares."""
        return None if self.error is None else float(self.pair.mean(self.error.share)[self.at])

    @property
    def motion_error(self) -> float | None:
        """Of mean axial displacement and distance [m]."""
        return None if self.error is None else float(self.pair.mean(self.error.axial_motion)[self.at])

    @property
    def motion_swing_error(self) -> float | None:
        """Of its peak-to-peak value [m]: by half of the positions, and by the error of displacements."""
        if self.error is None:
            return None
        motion, off = self.pair.axial_motion[:, self.at], self.error.axial_motion[:, self.at]
        return float(2.0 * off.max() + _missed(motion))

    @property
    def force_error(self) -> float | None:
        """Of the mean axial force [N]."""
        error = self.share_error
        return None if error is None else _or_zero(error * self._largest_force, self._largest_force)

    @property
    def force_swing_error(self) -> float | None:
        """Of its peak-to-peak value [N]."""
        if self.error is None:
            return None
        worst = float(self.error.share[:, self.at].max())
        force = self.pair.axial_force[:, self.at]
        return _or_zero(2.0 * worst * self._largest_force + _missed(force), self._largest_force)

    @property
    def at_stop(self) -> bool:
        """Whether the floating member touches a stop."""
        return self.floating is not None and not bool(self.pair.balance.free[:, self.at].all())

    @property
    def idle(self) -> tuple[str, ...]:
        """Ends whose half carries nothing at some mesh positions."""
        return tuple(end for end, half in self.halves.items() if half.share_min == 0.0)

    @property
    def back(self) -> bool:
        """Whether other flanks touch, which is not included."""
        return bool(self.pair.touches_back[self.at])


def _amplitudes(pair: LoadedDoublePair, values: Array, least: float) -> Array:
    """Of the harmonics of what is known at the mesh positions; smaller ones are none."""
    found = series_over_pitch(pair.points, values).amplitude
    return np.where(found > least, found, 0.0)


def _or_zero(value: float, scale: float) -> float:
    """A value, zero where it is only round-off of its scale."""
    return value if abs(value) > _ROUND_OFF * abs(scale) else 0.0


def _missed(values: Array) -> float:
    """What every second position misses of the range."""
    return float(np.ptp(values) - np.ptp(values[::2]))
