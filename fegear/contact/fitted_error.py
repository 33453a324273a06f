"""A measured transmission error over the computed one: offset, scale, shift, and what else explains its curve.

The curve over one tooth pitch is one that repeats: a base pitch counts as a turn, and angles become those of the shaft.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows
from fegear.contact.curve_fit import fit_curve
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.trace_alternatives import alternatives
from fegear.contact.trace_low_pass import low_pass

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from fegear.base.arrays import Array
    from fegear.contact.fitted_line import Fitted
    from fegear.contact.measured_error import MeasuredError
    from fegear.contact.trace_alternatives import Alternative
    from fegear.contact.trace_low_pass import LowPass

#: Fewest groups of teeth whose gains have a scatter.
_FEW_GROUPS = 3
#: Logarithm of measured / computed up to which a trace may be at another torque.
_OF_CURVE = math.log(1.15)
#: Even places of a curve of which the higher harmonics are left out.
_EVEN = 1024
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class FittedError(FittedCurve):
    """A measured curve of the mesh over the computed one; angles are those of the shaft."""

    offset: float = shown("um", "offset of the measured transmission error", name="measured_offset")
    scale: float = shown("", "scale of the measured transmission error (measured / computed)", name="measured_scale")
    gain: float = shown(
        "", "measured / computed transmission error by least squares at this offset and shift", name="measured_gain"
    )
    angle: Array = shown(
        "deg", "rotation of the shaft within one tooth pitch, measured angle less the shift",
        label="rotation of the shaft",
    )  # fmt: skip
    measured: Array = shown(
        "um", "measured transmission error, mean of all teeth, less the offset and divided by the scale",
        label="transmission error",
    )  # fmt: skip
    computed: Array = shown("um", "computed transmission error at this angle")

    @property
    @shows("um", "measured transmission error less the computed one", label="residual")
    def residual(self) -> Array:
        """Shape (K,)."""
        return self.measured - self.computed

    @property
    @shows("um", "measured transmission error, mean of all teeth, less the offset, not divided by the scale",
           label="transmission error")  # fmt: skip
    def as_measured(self) -> Array:
        """Shape (K,)."""
        return super().as_measured

    @property
    @shows("um", "computed transmission error times the scale", label="transmission error")
    def fitted(self) -> Array:
        """Shape (K,)."""
        return super().fitted

    @property
    @shows("um", "measured transmission error less the computed one times the scale", label="residual")
    def left_by_fit(self) -> Array:
        """Shape (K,)."""
        return super().left_by_fit

    @property
    @shows("um", "standard error of measured_offset", name="measured_offset_standard_error")
    def offset_error(self) -> float:
        """Zero where it was not fitted."""
        return self.errors["offset"]

    @property
    @shows("um", "root mean square of the residual", name="residual_rms")
    def rms(self) -> float:
        """Over one tooth pitch."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    @shows("", "correlation coefficient of measured and computed transmission error")
    def correlation(self) -> float:
        """Of Pearson."""
        return super().correlation


def beside_computed(
    found: MeasuredError, x: Array, te: Array, base_pitch: float, fit: Collection[Fitted]
) -> FittedError:  # fmt: skip
    """Lay a measured curve of the mesh over a computed one.

    Parameters
    ----------
    found : MeasuredError
    x, te : ndarray, shape (P,)
        Computed transmission error over one base pitch [m].
    base_pitch : float
        [m].
    fit : collection of {"offset", "scale", "shift"}
        A shift is within half a tooth pitch to either side.
    """
    over = _Over(x, base_pitch)
    curve = over.closed(te, found.resolved)
    one = fit_curve(found.teeth * found.angle, found.te, over.angle, curve, fit)
    turn = 1.0 / found.teeth
    angle = np.mod(one.angle * turn, _TURN * turn)
    order = np.argsort(angle, kind="stable")
    return FittedError(
        one.fit, _errors_of_shaft(one, turn, found.mean_error), one.outside, one.offset, one.scale,
        one.shift * turn, one.gain, one.gain_error, angle[order], one.measured[order], one.computed[order],
        gain_scatter=_of_gain(found, one, over, curve), noise=one.noise,
    )  # fmt: skip


def _errors_of_shaft(one: FittedCurve, turn: float, mean_error: float) -> dict[Fitted, float]:
    """Standard errors of a curve over one tooth pitch in angles of the shaft, that of the offset with slow parts."""
    offset = math.hypot(one.errors["offset"], mean_error) if "offset" in one.fit else 0.0
    return {**one.errors, "shift": one.errors["shift"] * turn, "offset": offset}


def better_described(
    found: MeasuredError, fitted: FittedError, x: Array, curves: Mapping[str, Array], base_pitch: float,
    fit: Collection[Fitted],
) -> tuple[Alternative, ...]:  # fmt: skip
    """Descriptions of a trace that fit clearly better, shifts in angles of the shaft.

    Parameters
    ----------
    found : MeasuredError
    fitted : FittedError
        As it is described.
    x : ndarray, shape (P,)
    curves : mapping of str to ndarray, shape (P,)
        Computed transmission error: under the empty name that beside which it is, and others, which have to fit in
        size as well.
    base_pitch : float
    fit : collection of {"offset", "scale", "shift"}
    """
    over = _Over(x, base_pitch)
    asked = {name: over.closed(te, found.resolved) for name, te in curves.items()}
    described = partial(alternatives, fitted, found.teeth * found.angle, found.te, over.angle)
    better = described(asked, fit)
    wrong = {one.curve for one in better if one.curve and abs(math.log(one.fitted.gain)) > _OF_CURVE}
    if wrong:  # another shape of the size of none of them
        better = described({name: te for name, te in asked.items() if name not in wrong}, fit)
    return tuple(replace(one, fitted=replace(one.fitted, shift=one.fitted.shift / found.teeth)) for one in better)


def behind_low_pass(
    found: MeasuredError, fitted: FittedError, x: Array, te: Array, base_pitch: float, fit: Collection[Fitted]
) -> LowPass | None:  # fmt: skip
    """The low pass with which a trace fits clearly better, its time constant as an angle of the shaft; None for none.

    Parameters
    ----------
    found : MeasuredError
        Of a trace along which the shaft turns forward.
    fitted : FittedError
        As it is described.
    x, te : ndarray, shape (P,)
        Computed transmission error over one base pitch [m].
    base_pitch : float
    fit : collection of {"offset", "scale", "shift"}
    """
    over = _Over(x, base_pitch)
    curve = over.closed(te, found.resolved)
    behind = low_pass(fitted, found.teeth * found.angle, found.te, over.angle, curve, fit, repeats=True)
    return behind and replace(behind, lag=behind.lag / found.teeth)


class _Over:
    """One base pitch as a turn: the computed curve over the number of teeth times the angle."""

    def __init__(self, x: Array, base_pitch: float) -> None:
        phase = _TURN * (x - x[0]) / base_pitch
        self._inside = phase < _TURN
        # Zero of both angles is where a tooth pair is at the pitch point.
        self.angle = _TURN * x[0] / base_pitch + np.append(phase[self._inside], _TURN)

    def closed(self, te: Array, harmonics: int | None = None) -> Array:
        """Transmission error over these angles, without what is above a harmonic."""
        whole = np.append(te[self._inside], te[0])
        if harmonics is None:
            return whole
        even = self.angle[0] + _TURN * np.arange(_EVEN) / _EVEN
        lines = np.fft.rfft(np.interp(even, self.angle, whole))
        lines[harmonics + 1 :] = 0.0
        return np.interp(self.angle, np.append(even, even[0] + _TURN), np.append(one := np.fft.irfft(lines), one[0]))


def _of_gain(found: MeasuredError, one: FittedCurve, over: _Over, curve: Array) -> float:
    """Standard error of the gain by how it differs between groups of teeth; of one group, by the noise of the curve."""
    if len(found.by_teeth) < _FEW_GROUPS:
        return one.gain_scatter
    begin = over.angle[0]
    at = np.interp(np.mod(found.teeth * found.angle - one.shift - begin, _TURN) + begin, over.angle, curve)
    own = at - at.mean()
    gains = found.by_teeth @ own / (own @ own)
    return float(gains.std(ddof=1)) / math.sqrt(gains.size)
