"""Positions, harmonics and time tolerance one at a time, with the gears of the reference."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact import transmission_error
from fegear.contact.fourier import fourier_series
from fegear.studies.cost.answers import HARMONICS, factor_at, largest_force, loaded, speed_looked_at, train_of
from fegear.studies.cost.result import make_knob
from fegear.studies.cost.timing import timed

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.arrays import Array
    from fegear.contact import Engagement, FourierSeries, TransmissionError
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.result import Knob
    from fegear.studies.cost.sources import Source


#: No powers of two: two jumps may lie as many such steps apart and hide each other.
_EVEN = (8, 13, 21, 34, 55, 89, 144, 233, 377, 610)
#: Placements of evenly spaced positions beside the jumps: a single one may be lucky.
_PLACEMENTS = 8
_GAUSS = (2, 3, 4, 6, 8, 12, 16)
_PARTIAL_SUMS = (2, 4, 8, 16, 32, 64)
_FORCE_HARMONICS = (4, 8, 16, 32, 64, 128)
_POSITIONS = (11, 21, 41, 81, 161)
_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
#: Far beyond the finest of the above.
_ALL_HARMONICS, _ALL_POSITIONS, _ALL_GAUSS, _TIGHT = 512, 401, 48, 1e-8
#: Amplitudes whose error is looked at.
_FIRST = 8


def pair_knobs(asked: Asked, source: Source) -> list[Knob]:
    """Positions, harmonics and time tolerance, with the gears of the reference.

    Parameters
    ----------
    asked : Asked
    source : Source

    Returns
    -------
    list of Knob
    """
    names = {q.name for q in asked.quantities}
    found: list[Knob] = []
    if "te-peak-to-peak" in names:
        pair = loaded(asked, source, asked.pair)
        found += _error_knobs(pair.engagement, pair.nominal)
    if asked.mesh and names & {"tooth-force", "dynamic-factor"}:
        data = train_of(asked, source)
        if "tooth-force" in names:
            best = largest_force(asked, data, _ALL_HARMONICS, _ALL_POSITIONS)

            def off(harmonics: int, positions: int) -> float:
                return abs(largest_force(asked, data, harmonics, positions) / best - 1.0)

            force = "tooth-force"
            found += [
                _counted(force, "harmonics of the force", f"{_ALL_POSITIONS} positions", _FORCE_HARMONICS,
                         lambda n: off(n, _ALL_POSITIONS)),
                _counted(force, "positions over the path", f"{_ALL_HARMONICS} harmonics; jumps come in addition",
                         _POSITIONS, lambda n: off(_ALL_HARMONICS, n)),
            ]  # fmt: skip
        if "dynamic-factor" in names:
            speed = speed_looked_at(asked)
            still = factor_at(asked, data, speed, _TIGHT)
            errors, spent = [], []
            for tolerance in _TOLERANCES:
                value, seconds = timed(partial(factor_at, asked, data, speed, tolerance))
                errors.append(abs(value / still - 1.0))
                spent.append(seconds.cpu)
            at = f"at {speed * 30.0 / math.pi:.6g} rpm, against {_TIGHT:g}"
            found.append(
                make_knob("dynamic-factor", "time tolerance", at, _TOLERANCES, _TOLERANCES, errors, 0.0, spent)
            )
    return found


def _counted(
    quantity: str, name: str, at: str, counts: Sequence[int], error: Callable[[int], float], floor: float = 0.0
) -> Knob:
    """A knob that is a number of things: what goes to zero is its inverse."""
    return make_knob(quantity, name, at, counts, 1.0 / np.array(counts), [error(n) for n in counts], floor)


def _error_knobs(engagement: Engagement, load: float) -> list[Knob]:
    """Transmission error and mesh stiffness: evenly spaced positions beside Gauss points between the jumps."""
    best = transmission_error(engagement, load, HARMONICS, order=_ALL_GAUSS)
    stiffness = _stiffness(best)
    second = transmission_error(engagement, load, HARMONICS, order=_ALL_GAUSS // 2)
    floor = abs(second.peak_to_peak / best.peak_to_peak - 1.0)
    known = (
        _amplitudes(second.series.amplitude, best.series),
        _amplitudes(_stiffness(second).amplitude, stiffness),
    )

    def gauss(n: int) -> TransmissionError:
        return transmission_error(engagement, load, HARMONICS, order=n)

    even, between = "positions per base pitch, evenly spaced", "Gauss points per piece between jumps"
    te, first = "te-peak-to-peak", f"first {_FIRST} amplitudes over the largest"
    placed = f"root mean square over {_PLACEMENTS} placements"
    dense = {n: _even(engagement, load, _PLACEMENTS * n) for n in _EVEN}

    def rms(n: int, which: int, off: Callable[[Array], float]) -> float:
        found = dense[n][which]
        return math.sqrt(float(np.mean([off(found[start::_PLACEMENTS]) ** 2 for start in range(_PLACEMENTS)])))

    return [
        _counted(te, even, f"as a run without break points would; {placed}", _EVEN,
                 lambda n: rms(n, 0, lambda v: float(np.ptp(v)) / best.peak_to_peak - 1.0), floor),
        _counted(te, between, "as a run does, with 16", _GAUSS,
                 lambda n: abs(gauss(n).peak_to_peak / best.peak_to_peak - 1.0), floor),
        _counted(te, "harmonics of the transmission error", "peak-to-peak of the partial sum", _PARTIAL_SUMS,
                 lambda n: _partial(best, n), floor),
        _counted("te-harmonics", even, f"{first}, trapezoidal rule; {placed}", _EVEN,
                 lambda n: rms(n, 0, lambda v: _amplitudes(_spectrum(v), best.series)), known[0]),
        _counted("te-harmonics", between, first, _GAUSS,
                 lambda n: _amplitudes(gauss(n).series.amplitude, best.series), known[0]),
        _counted("stiffness-harmonics", even, f"{first}, trapezoidal rule; {placed}", _EVEN,
                 lambda n: rms(n, 1, lambda v: _amplitudes(_spectrum(v), stiffness)), known[1]),
        _counted("stiffness-harmonics", between, first, _GAUSS,
                 lambda n: _amplitudes(_stiffness(gauss(n)).amplitude, stiffness), known[1]),
    ]  # fmt: skip


def _stiffness(found: TransmissionError) -> FourierSeries:
    """Series of the local mesh stiffness at the quadrature points of a transmission error."""
    return fourier_series(found.points, found.loaded.local_stiffness[:, 0], HARMONICS)


def _even(engagement: Engagement, load: float, n: int) -> tuple[Array, Array]:
    """Transmission error and local stiffness at n evenly spaced roll positions of one base pitch."""
    pair = engagement.pair
    x = pair.x_start + pair.base_pitch * (np.arange(n) + 0.5) / n
    state = engagement.solve(engagement.grid(x), [load])
    return state.transmission_error[:, 0], state.local_stiffness[:, 0]


def _spectrum(values: Array) -> Array:
    """Amplitudes (0-peak) of harmonics 1.. from evenly spaced values."""
    return np.asarray(2.0 * np.abs(np.fft.rfft(values))[1 : values.size // 2] / values.size)


def _amplitudes(found: Array, exact: FourierSeries) -> float:
    """Largest error of the first amplitudes that both have, over the largest amplitude."""
    n = min(_FIRST, found.size)
    amplitude = exact.amplitude
    return float(np.abs(found[:n] - amplitude[:n]).max() / amplitude.max())


def _partial(best: TransmissionError, harmonics: int) -> float:
    """Error of the peak-to-peak value of a partial sum."""
    series = best.series
    x = np.concatenate([best.points.x, np.linspace(0.0, series.period, 64 * harmonics + 1)])
    cut = type(series)(series.coefficients[: harmonics + 1], series.period)
    return abs(float(np.ptp(cut.evaluate(x))) / best.peak_to_peak - 1.0)
