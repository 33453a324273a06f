"""What a measured curve laid over a computed one has: offset, scale, shift and drift with their errors, and the rest.

measured = offset + drift * turns + scale * computed(angle - shift) + residual. It is laid there by
`fegear.contact.curve_fit`; what is once per turn, hum and jumps of the zero are added by those that look for them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.fitted_line import Fitted
    from fegear.contact.mains_hum import MainsHum
    from fegear.contact.once_per_turn import OncePerTurn
    from fegear.contact.zero_jump import ZeroJump

_TURN = 2.0 * math.pi
#: A drift is named from this many standard errors on, and from this part of the computed range on over the whole trace.
_DRIFT_ERRORS, _DRIFT_PART = 4.0, 0.01
#: Part of the variance of a trace from which on it is noise, with no shape to be told.
_ALL_NOISE = 0.9


@dataclass(frozen=True)
class FittedCurve:
    """A measured curve beside the computed one, over the samples within it; K of them.

    Parameters
    ----------
    fit : tuple of str
        What was fitted.
    offset, scale, shift : float
        Measured where the computed curve is zero; measured change per computed change; angle by which the measured
        curve lags [rad].
    errors : mapping of str to float
        Standard errors of what was fitted; zero of the rest.
    gain, gain_error : float
        Scale of the least squares with this shift whether or not it was asked for, and its standard error.
    angle : ndarray, shape (K,)
        Of the samples, less the shift [rad], in the order of the trace.
    measured, computed : ndarray, shape (K,)
        As measured, less offset and scale; and the curve there.
    outside : int
        Samples beyond the computed curve.
    drift : float
        Change of the measured curve per turn along the trace, where it was fitted; zero half-way through the trace.
    trend, trend_error : float or None
        Drift of the least squares with this shift whether or not it was asked for, and its standard error; None of a
        trace that has no place of the curve twice.
    turns : float
        From the first to the last compared sample.
    gain_scatter : float
        Standard error of the gain by what does not repeat at the same place (noise, torque from turn to turn): without
        the difference of shape, which `gain_error` has.
    wave : OncePerTurn or None
        What the trace has once per turn outside the mesh, where it was looked for.
    wave_less : bool
        Whether that is subtracted.
    turn_gains : ndarray, shape (T,)
        Gain of each turn, in their order; empty of fewer than three.
    gain_noise : float
        Standard error of the gain by the noise alone.
    left_out_angle, left_out : ndarray, shape (J,)
        Spikes, dropouts and saturated samples within the computed curve, as `angle` and `measured`.
    step : float
        In which the samples were taken; zero where they have none.
    hum, jump : MainsHum or None, ZeroJump or None
        At 50 or 60 Hz, and of the zero, where they were looked for.
    """

    fit: tuple[Fitted, ...]
    errors: dict[Fitted, float]
    outside: int
    offset: float = shown("um/m", "offset of the measured strain", name="measured_offset")
    scale: float = shown("", "scale of the measured strain (measured / computed)", name="measured_scale")
    shift: float = shown("deg", "shift of the measured curve towards larger angles", name="measured_shift")
    gain: float = shown(
        "", "measured / computed strain by least squares at this offset and shift", name="measured_gain"
    )
    gain_error: float = shown("", "standard error of measured_gain", name="measured_gain_standard_error")
    angle: Array = shown("deg", "rotation of the gear, measured angle less the shift", label="rotation of the gear")
    measured: Array = shown("um/m", "measured strain, less the offset and divided by the scale", label="strain")
    computed: Array = shown("um/m", "computed strain at this angle")
    drift: float = shown(
        "um/m", "drift of the measured strain per turn of the gear", name="measured_drift", default=0.0
    )
    trend: float | None = None
    trend_error: float | None = None
    turns: float = 0.0
    gain_scatter: float = 0.0
    noise: float = shown(
        "um/m", "standard deviation of the measured strain from what repeats at the same place", name="measured_noise",
        default=0.0,
    )  # fmt: skip
    left_out_angle: Array = shown(
        "deg", "rotation of the gear at a sample left out", label="rotation of the gear",
        default_factory=lambda: np.zeros(0),
    )  # fmt: skip
    left_out: Array = shown("um/m", "sample left out", label="strain", default_factory=lambda: np.zeros(0))
    spikes: int = shown("", "spikes and dropouts left out", name="measured_spikes", default=0)
    saturated: int = shown("", "saturated samples left out", name="measured_saturated", default=0)
    saturated_at: float | None = None
    wave: OncePerTurn | None = None
    wave_less: bool = False
    turn_gains: Array = field(default_factory=lambda: np.zeros(0))
    gain_noise: float = 0.0
    step: float = 0.0
    hum: MainsHum | None = None
    jump: ZeroJump | None = None

    @property
    @shows("um/m", "amplitude of the part of the trace once per turn of the gear", name="measured_runout")
    def runout(self) -> float | None:
        """Outside the mesh; None where it was not looked for."""
        return None if self.wave is None else self.wave.amplitude

    @property
    @shows("um/m", "standard error of measured_runout", name="measured_runout_standard_error")
    def runout_error(self) -> float | None:
        """By the scatter of the samples outside the mesh."""
        return None if self.wave is None else self.wave.error

    @property
    @shows(
        "deg", "rotation of the gear at the maximum of the part once per turn, from the contact of the tooth of the "
        "gauge at the pitch point", name="measured_runout_angle",
    )  # fmt: skip
    def runout_angle(self) -> float | None:
        """Less the shift [rad]."""
        return None if self.wave is None else float(np.mod(self.wave.place - self.shift + math.pi, _TURN) - math.pi)

    @property
    @shows(
        "deg", "measured angle at the maximum of the part once per turn, from the zero of the measured angle",
        name="measured_runout_at_measured_angle",
    )  # fmt: skip
    def runout_measured_angle(self) -> float | None:
        """As that of encoders, 0 to one turn [rad]."""
        return None if self.wave is None else float(np.mod(self.wave.place, _TURN))

    @property
    def unfitted_runout(self) -> OncePerTurn | None:
        """Once per turn, where it is not subtracted, certain, and large beside the curve."""
        wave = self.wave
        if wave is None or self.wave_less or self.jump is not None:
            return None
        large = wave.amplitude > _DRIFT_PART * float(np.ptp(self.computed)) * abs(self.scale)
        return wave if large and wave.amplitude > _DRIFT_ERRORS * wave.error else None

    @property
    def unfitted_drift(self) -> float | None:
        """Per turn, where the residual has one that is certain, and large beside the curve."""
        if "drift" in self.fit or self.jump is not None or self.trend is None or self.trend_error is None:
            return None
        large = abs(self.trend) * self.turns > _DRIFT_PART * float(np.ptp(self.computed)) * abs(self.scale)
        return self.trend if large and abs(self.trend) > _DRIFT_ERRORS * self.trend_error else None

    @property
    @shows("um/m", "standard error of measured_drift", name="measured_drift_standard_error")
    def drift_error(self) -> float:
        """Zero where it was not fitted."""
        return self.errors["drift"]

    @property
    @shows("um/m", "measured strain less the computed one", label="residual")
    def residual(self) -> Array:
        """Shape (K,)."""
        return self.measured - self.computed

    @property
    @shows("um/m", "measured strain, less the offset, not divided by the scale", label="strain")
    def as_measured(self) -> Array:
        """Shape (K,)."""
        return self.measured * (self.scale or 1.0)

    @property
    @shows("um/m", "computed strain times the scale", label="strain")
    def fitted(self) -> Array:
        """By ascending `drawn_angle`, shape (K,)."""
        return (self.computed * self.scale)[self._ascending]

    @property
    @shows("deg", "rotation of the gear", label="rotation of the gear")
    def drawn_angle(self) -> Array:
        """Ascending, shape (K,)."""
        return self.angle[self._ascending]

    @property
    def _ascending(self) -> NDArray[np.intp]:
        return np.argsort(self.angle, kind="stable")

    @property
    @shows("um/m", "measured strain less the computed one times the scale", label="residual")
    def left_by_fit(self) -> Array:
        """Shape (K,)."""
        return self.as_measured - self.computed * self.scale

    @property
    @shows("um/m", "sample left out", label="strain")
    def left_out_as_measured(self) -> Array:
        """Shape (J,)."""
        return self.left_out * (self.scale or 1.0)

    @property
    @shows("um/m", "standard error of measured_offset", name="measured_offset_standard_error")
    def offset_error(self) -> float:
        """Zero where it was not fitted."""
        return self.errors["offset"]

    @property
    @shows("", "standard error of measured_scale", name="measured_scale_standard_error")
    def scale_error(self) -> float:
        """Zero where it was not fitted."""
        return self.errors["scale"]

    @property
    @shows("deg", "standard error of measured_shift", name="measured_shift_standard_error")
    def shift_error(self) -> float:
        """Zero where it was not fitted [rad]."""
        return self.errors["shift"]

    @property
    @shows("um/m", "root mean square of the residual", name="residual_rms")
    def rms(self) -> float:
        """Over the samples within the computed curve."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def fits(self) -> bool:
        """Whether a residual over the fitted scale says anything: of a scale near zero it is without limit."""
        return "scale" not in self.fit or self.rms < float(np.ptp(self.computed))

    @property
    @shows("", "correlation coefficient of measured and computed strain")
    def correlation(self) -> float:
        """Of Pearson."""
        one, other = self.measured - self.measured.mean(), self.computed - self.computed.mean()
        size = float(np.sqrt((one @ one) * (other @ other)))
        return float(one @ other) / size if size else 0.0

    @property
    def likeness(self) -> float:
        """Correlation of the shapes: that of Pearson, had the trace no noise; at most 1."""
        power = float(self.measured.var())
        noise = self.noise**2 / power if power else 0.0
        return min(self.correlation / math.sqrt(1.0 - noise), 1.0) if noise < _ALL_NOISE else self.correlation

    @property
    @shows("", "samples compared", name="measured_samples")
    def samples(self) -> int:
        """K."""
        return int(self.angle.size)
