"""Transmission error and mesh stiffness of loaded teeth over one base pitch, with their harmonics and errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.brief import Brief
from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.fourier import FourierSeries
    from fegear.geometry.pair import GearPair

#: Harmonics on either side of one that tell of its error, too (of one pair the fourth was 1.6 times off what one on
#: either side told).
_BESIDE = 2
#: What is left of a transmission error that deflections make up, as a share of it.
_ROUND_OFF = 1e-7


@dataclass(frozen=True)
class TransmissionErrorShift:
    """Estimated errors of a transmission error's numbers, each the sum of the changes by the shifted compliances."""

    mean: float
    peak_to_peak: float
    effective: float
    amplitude: Array
    stiffness: float

    @property
    def first_harmonic(self) -> float:
        """Of the first amplitude; zero where there is none."""
        return float(self.amplitude[0]) if self.amplitude.size else 0.0


def no_less_than_beside(error: Array) -> Array:
    """Errors of harmonics, shape (N,), none below the root mean square of it and two on either side.

    What a change of the flank's ends adds to one harmonic may cancel, and does not in the next, whose phases differ.
    """
    around = np.lib.stride_tricks.sliding_window_view(np.pad(error**2, _BESIDE, mode="edge"), 2 * _BESIDE + 1)
    return np.maximum(error, np.sqrt(around.mean(axis=-1)))


@dataclass(frozen=True)
class Harmonics:
    """Lines of the transmission error, n = 1 to N, under L loads.

    Parameters
    ----------
    n : ndarray of int, shape (N,)
    cosine, sine, amplitude : ndarray, shape (N, L)
        0-peak [m].
    """

    n: NDArray[np.int64] = shown("", "harmonic of the tooth-mesh frequency", table="harmonics")
    cosine: Array = shown("um", "factor of cos(2 pi n x / p_b), 0-peak", table="harmonics")
    sine: Array = shown("um", "factor of sin(2 pi n x / p_b), 0-peak", table="harmonics")
    amplitude: Array = shown("um", "0-peak", table="harmonics")


@dataclass(frozen=True)
class RotationalHarmonics:
    """Lines of the transmission error over the base pitches after which the same teeth meet again, n = 1 to N.

    Parameters
    ----------
    cycles : int
        Base pitches of the period.
    n : ndarray of int, shape (N,)
    cosine, sine, amplitude : ndarray, shape (N,)
        0-peak [m].
    """

    cycles: int
    n: NDArray[np.int64] = shown("")
    cosine: Array = shown("um", "0-peak")
    sine: Array = shown("um", "0-peak")
    amplitude: Array = shown("um", "0-peak")

    @property
    @shows("", "frequency over the tooth-mesh frequency")
    def mesh_order(self) -> Array:
        """n over the base pitches of the period, shape (N,)."""
        return np.asarray(self.n / self.cycles)

    @property
    def below_mesh(self) -> Array:
        """Amplitudes below the tooth-mesh frequency [m]."""
        return self.amplitude[: self.cycles - 1]

    @property
    @shows("um", name="te_largest_rotational")
    def largest(self) -> float | None:
        """Of these [m]; None where there are none."""
        return float(self.below_mesh.max()) if self.below_mesh.size else None

    @property
    def at_largest(self) -> int:
        """Its harmonic."""
        return int(self.below_mesh.argmax()) + 1


@dataclass(frozen=True)
class ErrorOverPitch(Brief):
    """Transmission error and mesh stiffness at P roll positions over one base pitch, under L loads, N harmonics.

    Parameters
    ----------
    pair : GearPair
    loads : tuple of float
        Ascending [N].
    at : int
        Number of the nominal one.
    positions : int
        Roll positions that were asked for.
    integrated : str
        How the harmonics come about, for their figure.
    series : tuple of FourierSeries
        Of the transmission error under every load.
    shift : TransmissionErrorShift or None
        Estimated errors at the nominal load.
    x : ndarray, shape (P,)
        Roll positions [m].
    te, mesh_stiffness, local_stiffness, pairs_in_contact : ndarray, shape (P, L)
        [m], [N/m], [N/m].
    te_mean, te_peak_to_peak, te_effective, local_stiffness_mean : ndarray, shape (L,)
        Of the whole base pitch [m], [m], [m], [N/m].
    mesh_stiffness_mean : float
        At the nominal load [N/m].
    mesh_compliance_mean : float or None
        Mean of 1/K_T of perfect flanks [m/N]; none where no pair of them is on the path at some roll positions.
    te_error : ndarray, shape (P,), or None
        Estimated at the nominal load along the curve, where it is known [m].
    rotational : FourierSeries or None
        Over the base pitches after which the same teeth meet again, with spacing errors, where it is computed.
    cycles : int
        How many base pitches these are; 1 where teeth stand evenly or none but this one is looked at.
    only : int or None
        The one base pitch that is looked at although each has a transmission error of its own.
    shifts : tuple of TransmissionErrorShift
        Estimated errors under every load; empty where they are not known.
    corner_contact : bool
        Whether teeth may touch outside the path of contact.
    mesh_stiffness_on_path, local_stiffness_on_path : float or None
        Means at the nominal load if they may not; None where they may not anyway, or where this is not known [N/m].
    """

    pair: GearPair
    loads: tuple[float, ...]
    at: int
    positions: int
    integrated: str
    series: tuple[FourierSeries, ...]
    shift: TransmissionErrorShift | None
    x: Array = shown("mm", "mesh position: position of the last tooth pair to come into contact", table="pitch")
    te: Array = shown("um", "loaded transmission error", label="transmission error", table="pitch")
    mesh_stiffness: Array = shown(
        "N/um", "mesh stiffness (secant), sum over the pairs in contact", label="mesh stiffness", table="pitch"
    )
    pairs_in_contact: Array = shown("", "number of tooth pairs in contact", table="pitch")
    local_stiffness: Array = shown("N/um", "local (tangent) mesh stiffness dF/dTE", table="pitch")
    te_mean: Array = shown("um", "mean transmission error over the base pitch", label="mean", table="loads")
    te_peak_to_peak: Array = shown("um", "peak-to-peak value", label="peak-to-peak value", table="loads")
    te_effective: Array = shown("um", "effective transmission error A_e (amplitude, NASA TM-89901)", table="loads")
    local_stiffness_mean: Array = shown("N/um", "tangent mesh stiffness, mean over the base pitch", table="loads")
    mesh_stiffness_mean: float = shown(
        "N/um", "secant mesh stiffness (load / deflection of the pairs in contact), mean over the base pitch"
    )
    mesh_compliance_mean: float | None = shown(
        "um/N", "mean of 1/K_T, ideal flanks, all tooth pairs on the path in contact (Mark, A.11)"
    )
    te_error: Array | None = shown("um", "estimated error of te", default=None)
    rotational: FourierSeries | None = None
    cycles: int = 1
    only: int | None = None
    shifts: tuple[TransmissionErrorShift, ...] = ()
    corner_contact: bool = False
    mesh_stiffness_on_path: float | None = shown(
        "N/um", "secant mesh stiffness without contact outside the path of contact, mean over the base pitch",
        name="mesh_stiffness_mean_on_path", default=None,
    )  # fmt: skip
    local_stiffness_on_path: float | None = shown(
        "N/um", "tangent mesh stiffness without contact outside the path of contact, mean over the base pitch",
        name="local_stiffness_mean_on_path", default=None,
    )  # fmt: skip

    @property
    def off_path_stiffens(self) -> bool | None:
        """Whether contact outside the path changes the mean secant stiffness beyond its error; None: not known."""
        if self.mesh_stiffness_on_path is None:
            return None
        change = abs(self.mesh_stiffness_mean - self.mesh_stiffness_on_path)
        error = 0.0 if self.shift is None else self.shift.stiffness
        return change > max(error, _ROUND_OFF * self.mesh_stiffness_mean)

    @property
    def on_path_error(self) -> float | None:
        """Estimated, of the mean secant stiffness on the path: relatively that with all contact [N/m]."""
        return self._share_of_error(self.mesh_stiffness_on_path)

    @property
    def local_on_path_error(self) -> float | None:
        """The same of the tangent [N/m]."""
        return self._share_of_error(self.local_stiffness_on_path)

    def _share_of_error(self, stiffness: float | None) -> float | None:
        """Estimated, of a mean stiffness at the nominal load: relatively that of the secant stiffness [N/m]."""
        if self.shift is None or stiffness is None:
            return None
        return self.shift.stiffness / self.mesh_stiffness_mean * stiffness

    @property
    def mean_errors(self) -> Array | None:
        """Estimated, of the mean under every load, shape (L,) [m]; None where they are not known."""
        return self._errors("mean")

    @property
    def peak_to_peak_errors(self) -> Array | None:
        """The same of the peak-to-peak value [m]."""
        return self._errors("peak_to_peak")

    @property
    def effective_errors(self) -> Array | None:
        """The same of the effective transmission error [m]."""
        return self._errors("effective")

    def _errors(self, of: str) -> Array | None:
        return np.array([getattr(one, of) for one in self.shifts]) if self.shifts else None

    @property
    def load(self) -> float:
        """The nominal load [N]."""
        return self.loads[self.at]

    @property
    @shows("N", "along the line of action", label="load along the line of action")
    def total_load(self) -> Array:
        """Every load, shape (L,) [N]."""
        return np.array(self.loads)

    @property
    @shows("deg", "rotation of the driver from where this tooth pair is at the pitch point, with its motion")
    def driver_angle(self) -> Array:
        """Of the rows, x over the base radius of the driver, shape (P,) [rad]."""
        return self.x / self.pair.driver.base_radius

    @property
    @shows("N.m", "driver torque at this load", label="torque on the driver", table="loads")
    def driver_torque(self) -> Array:
        """Under each load, shape (L,) [N m]."""
        return self.total_load * self.pair.driver.base_radius

    def stiffness(self, driver_angle: ArrayLike, *, secant: bool = False, under: int | None = None) -> Array:
        """Mesh stiffness at rotations of the driver under the nominal load, for equations of motion.

        Parameters
        ----------
        driver_angle : array_like
            As `driver_angle`: zero where the tooth pair is at the pitch point [rad]; any number of turns.
        secant : bool
            Load over transmission error in place of the slope dF/dTE.
        under : int, optional
            Number of another load.

        Returns
        -------
        ndarray
            Periodic over a tooth of the driver, straight between the rows of the curve [N/m].
        """
        return self._over_rotation(self.mesh_stiffness if secant else self.local_stiffness, driver_angle, under)

    def error(self, driver_angle: ArrayLike, *, under: int | None = None) -> Array:
        """Transmission error at rotations of the driver under the nominal load [m], as `stiffness`."""
        return self._over_rotation(self.te, driver_angle, under)

    @property
    @shows("um", "transmission error minus load over mesh_stiffness: force = mesh_stiffness (deflection - te_0)")
    def te_0(self) -> Array:
        """Where the secant has no force, shape (P, L) [m], see `secant_start`."""
        return secant_start(self.te, self.mesh_stiffness, self.total_load)

    def start(self, driver_angle: ArrayLike, *, under: int | None = None) -> Array:
        """Where the secant has no force at rotations of the driver [m], as `stiffness`.

        It is that of both curves between their rows, so that the secant from there carries the load everywhere.
        """
        stiffness = self.stiffness(driver_angle, secant=True, under=under)
        return secant_start(
            self.error(driver_angle, under=under), stiffness, self.loads[self.at if under is None else under]
        )

    def _over_rotation(self, values: Array, driver_angle: ArrayLike, under: int | None) -> Array:
        x = np.asarray(driver_angle, dtype=float) * self.pair.driver.base_radius
        part = (x - self.x[0]) / self.pair.base_pitch % 1.0
        return over_pitch(self.x, values[:, self.at if under is None else under], self.pair.base_pitch, part)

    @property
    def harmonics(self) -> Harmonics:
        """Lines of its series under every load."""
        cosine, sine, amplitude = (
            np.stack([getattr(one, part) for one in self.series], axis=-1) for part in ("cosine", "sine", "amplitude")
        )
        return Harmonics(np.arange(1, len(amplitude) + 1), cosine, sine, amplitude)

    @property
    def rotational_harmonics(self) -> RotationalHarmonics | None:
        """Lines of the series over several base pitches, where it is computed."""
        if (one := self.rotational) is None:
            return None
        n = np.arange(1, one.amplitude.size + 1)
        return RotationalHarmonics(self.cycles, n, one.cosine, one.sine, one.amplitude)

    @property
    def local_stiffness_error(self) -> float | None:
        """Estimated, of the mean slope at the nominal load [N/m]."""
        return self._share_of_error(float(self.local_stiffness_mean[self.at]))

    @property
    def mesh_compliance_error(self) -> float | None:
        """Estimated [m/N]: relatively that of the mean transmission error."""
        if self.shift is None or self.mesh_compliance_mean is None:
            return None
        return self.shift.mean / float(self.te_mean[self.at]) * self.mesh_compliance_mean

    @property
    @shows("um", "0-peak")
    def te_first_harmonic(self) -> Array:
        """Amplitude of the first harmonic under each load, shape (L,) [m]; zero where none is known."""
        return np.array([one.amplitude[0] if one.amplitude.size else 0.0 for one in self.series])


def secant_start(te: Array, stiffness: Array, load: float | Array) -> Array:
    """Transmission error at which the secant line has no force.

    Zero with unmodified flanks; beside contact of tips, and with reliefs and deviations, the gaps that are closed
    before the pairs bear.

    Parameters
    ----------
    te, stiffness : ndarray
        Transmission error [m] and secant mesh stiffness of the pairs in contact [N/m].
    load : float or ndarray
        [N].

    Returns
    -------
    ndarray
        ``te - load / stiffness``, zero where only round-off is left [m].
    """
    start = te - load / stiffness
    return np.where(np.abs(start) > _ROUND_OFF * np.abs(te), start, 0.0)


def over_pitch(x: Array, values: Array, pitch: float, part: Array) -> Array:
    """A curve straight between its rows and periodic, at parts of the base pitch counted from its first row."""
    inside = x < x[0] + pitch
    at, found = np.append(x[inside], x[0] + pitch), np.append(values[inside], values[0])
    return np.asarray(np.interp(x[0] + part * pitch, at, found))
