"""A measured curve laid over a computed one: offset, scale and shift by least squares, with their standard errors.

measured = offset + scale * computed(angle - shift) + residual, where only what is asked for is fitted; else offset and
shift are zero and the scale is one. Angles count modulo one turn: a trace of many revolutions is one engagement many
times. Where the computed curve ends there is nothing to compare with; while the shift is searched for the tooth counts
as unstrained there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from fegear.base.arrays import Array

Fitted = Literal["offset", "scale", "shift"]
FITTED: tuple[Fitted, ...] = ("offset", "scale", "shift")
#: Fewest samples within the computed curve, beside those that the fit takes.
FEWEST = 8
_TURN = 2.0 * math.pi
#: Steps of the first search over the length of the computed curve.
_STEPS = 400
#: Share of the curve's length over which its slope is taken: at a jump it has none.
_SLOPE = 1.0 / 500.0
#: A jump: points of the curve nearer than this share of its length, and values farther apart than this of its range.
_JUMP_WITHIN, _JUMP_OF = 1e-5, 0.02
#: Largest correlation of neighbouring residuals with which standard errors are counted.
_MOST_CORRELATED = 0.99


class NothingToCompareError(ValueError):
    """A trace has too few samples where the computed curve is known."""


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

    @property
    @shows("um/m", "measured strain less the computed one", label="residual")
    def residual(self) -> Array:
        """Shape (K,)."""
        return self.measured - self.computed

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
    @shows("", "correlation coefficient of measured and computed strain")
    def correlation(self) -> float:
        """Of Pearson."""
        one, other = self.measured - self.measured.mean(), self.computed - self.computed.mean()
        size = float(np.sqrt((one @ one) * (other @ other)))
        return float(one @ other) / size if size else 0.0

    @property
    @shows("", "samples compared", name="measured_samples")
    def samples(self) -> int:
        """K."""
        return int(self.angle.size)


def fit_curve(
    angle: Array, measured: Array, curve_angle: Array, curve: Array, fit: Collection[Fitted] = ()
) -> FittedCurve:
    """Lay a measured curve over a computed one.

    Parameters
    ----------
    angle, measured : ndarray, shape (N,)
        Samples in the order of the trace [rad, any unit].
    curve_angle, curve : ndarray, shape (Q,)
        Computed, ascending [rad, the same unit]; less than a turn.
    fit : collection of {"offset", "scale", "shift"}

    Raises
    ------
    NothingToCompareError
        If fewer than `FEWEST` samples, beside the fitted numbers, lie within the computed curve.
    """
    middle = 0.5 * (curve_angle[0] + curve_angle[-1])
    half = 0.5 * (curve_angle[-1] - curve_angle[0])

    def within(shift: float, of: Array = angle) -> Array:
        return np.asarray(np.mod(of - shift - middle + math.pi, _TURN) - math.pi + middle)

    def computed(places: Array) -> Array:
        return np.interp(places, curve_angle, curve)

    asked: tuple[Fitted, ...] = tuple(one for one in FITTED if one in fit)
    shift = _searched(angle, measured, computed, half, middle, asked) if "shift" in asked else 0.0
    inside = np.abs(within(shift) - middle) <= half
    if np.count_nonzero(inside) < FEWEST + len(asked):
        raise NothingToCompareError
    a, y = angle[inside], measured[inside]
    if "shift" in asked:
        shift = _refined(lambda at: _squares(computed(within(at, a)), y, asked), shift, 2.0 * half / _STEPS)
    places = within(shift, a)
    found = computed(places)
    offset, scale = _linear(found, y, asked)
    residual = y - offset - scale * found
    gain_with: tuple[Fitted, ...] = tuple(one for one in FITTED if one in asked or one == "scale")
    gain = _linear(found, y, gain_with)[1]
    reach = 2.0 * half * _SLOPE
    slope = (computed(places + reach) - computed(places - reach)) / (2.0 * reach)
    errors = _standard_errors(found, slope, scale, residual, asked)
    if "shift" in asked and _jumps(curve_angle, curve):  # between two samples the jump may be anywhere
        spacing = float(np.median(np.diff(np.sort(places))))
        errors["shift"] = math.hypot(errors["shift"], spacing / math.sqrt(12.0))
    of_gain = _standard_errors(found, slope, gain, y - _linear(found, y, gain_with)[0] - gain * found, gain_with)
    return FittedCurve(
        asked, {one: errors.get(one, 0.0) for one in FITTED}, int(angle.size - a.size),
        offset, scale, float(np.mod(shift + math.pi, _TURN) - math.pi), gain, of_gain["scale"], places,
        (y - offset) / scale, found,
    )  # fmt: skip


def _jumps(angle: Array, curve: Array) -> bool:
    """Whether the curve has a step that its slope says nothing about."""
    steep = np.diff(angle) < _JUMP_WITHIN * (angle[-1] - angle[0])
    return bool((np.abs(np.diff(curve))[steep] > _JUMP_OF * np.ptp(curve)).any())


def _searched(
    angle: Array, measured: Array, computed: Callable[[Array], Array], half: float, middle: float,
    asked: tuple[Fitted, ...],
) -> float:  # fmt: skip
    """The best shift of a grid over one turn; a measured curve upside down is none.

    Samples are counted in the cells of the grid: sums over products with the displaced curve are circular correlations.
    """
    cells = math.ceil(_TURN / (2.0 * half) * _STEPS)
    step = _TURN / cells
    cell = np.floor(np.mod(angle, _TURN) / step).astype(int) % cells
    count = np.bincount(cell, minlength=cells).astype(float)
    total = np.bincount(cell, measured, cells)
    centre = np.mod((np.arange(cells) + 0.5) * step - middle + math.pi, _TURN) - math.pi + middle
    curve = np.where(np.abs(centre - middle) <= half, computed(centre), 0.0)

    def correlated(of: Array, with_curve: Array) -> Array:
        product = np.fft.rfft(of) * np.conj(np.fft.rfft(with_curve))
        return np.asarray(np.fft.irfft(product, cells))

    n, mean = measured.size, measured.mean() if "offset" in asked else 0.0
    curves, squares, products = (
        correlated(count, curve), correlated(count, curve**2), correlated(total - mean * count, curve)
    )  # fmt: skip
    size = squares - curves**2 / n if "offset" in asked else squares
    likely = size > 1e-6 * size.max()
    scale = np.where(likely, products / np.where(likely, size, 1.0), 0.0)
    if "scale" not in asked:
        scale = np.ones(cells)
    gained = np.where(likely & (scale > 0.0), scale * (2.0 * products - scale * size), -np.inf)
    return float(int(np.argmax(gained)) * step)


def _refined(squares: Callable[[float], float], shift: float, step: float) -> float:
    from scipy.optimize import minimize_scalar

    ends = shift - 2.0 * step, shift + 2.0 * step
    return float(minimize_scalar(squares, bounds=ends, method="bounded", options={"xatol": 1e-6 * step}).x)


def _linear(curve: Array, measured: Array, asked: tuple[Fitted, ...]) -> tuple[float, float]:
    """Offset and scale by least squares, those that are asked for."""
    if "scale" not in asked:
        return (float(np.mean(measured - curve)) if "offset" in asked else 0.0), 1.0
    c, m = (curve.mean(), measured.mean()) if "offset" in asked else (0.0, 0.0)
    size = float((curve - c) @ (curve - c))
    scale = float((curve - c) @ (measured - m)) / size if size else 0.0
    return float(m - scale * c), scale


def _squares(curve: Array, measured: Array, asked: tuple[Fitted, ...]) -> float:
    offset, scale = _linear(curve, measured, asked)
    residual = measured - offset - scale * curve
    return float(residual @ residual)


def _standard_errors(
    curve: Array, slope: Array, scale: float, residual: Array, asked: tuple[Fitted, ...]
) -> dict[Fitted, float]:
    """Of what is fitted; neighbouring residuals that go together count as fewer samples."""
    columns: dict[Fitted, Array] = {"offset": np.ones(curve.size), "scale": curve, "shift": -scale * slope}
    if not asked:
        return {}
    matrix = np.stack([columns[one] for one in asked], axis=1)
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0.0] = 1.0
    squares = float(residual @ residual)
    variance = squares / max(curve.size - len(asked), 1)
    follows = float(residual[1:] @ residual[:-1]) / squares if squares else 0.0
    follows = min(max(follows, 0.0), _MOST_CORRELATED)
    variance *= (1.0 + follows) / (1.0 - follows)
    spread = np.diag(np.linalg.pinv((matrix / size).T @ (matrix / size))) * variance
    return {one: float(math.sqrt(max(spread[i], 0.0)) / size[i]) for i, one in enumerate(asked)}
