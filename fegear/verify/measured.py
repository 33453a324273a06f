"""Rows of measured flanks: traces whose waves, slope, form and crown are known in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fegear.verify.row import Compared, Rows, near

ROWS = Rows()


@ROWS.add("filter of measured flanks", "own", "the Fourier transform of a Gaussian weight, half at the cut-off")
def trace_filter() -> Iterator[Compared]:
    """What is left of waves from a third to three times the cut-off, in the middle of a trace of 10 mm."""
    from fegear.formulas.iso1328_traces import cutoff, filtered

    length = 10e-3
    x = np.linspace(0.0, 12e-3, 2401)
    for share in (1.0 / 3.0, 0.5, 1.0, 2.0, 3.0):
        wave = np.cos(2.0 * math.pi * (x - 6e-3) / (share * cutoff(length)))
        yield from near(filtered(x, wave, cutoff(length))[1200], 2.0 ** -(share**-2), 2e-4, scale=1.0)


@ROWS.add("slope, form and crown of measured flanks", "own", "least-squares line, parabola and wave by hand")
def trace_deviations() -> Iterator[Compared]:
    """A slope of 12 um and a crown of 8 um alone; five whole waves of 3 um about a line."""
    from fegear.formulas.iso1328_traces import evaluate

    x = np.linspace(-0.1, 1.1, 24001)
    s = 2.0 * x - 1.0
    line = evaluate(x, 6.0 * s, 0.0, 1.0)
    yield from near((line.slope, line.total), (12.0, 12.0), 1e-9)
    yield from near((line.form, line.crown), (0.0, 0.0), 1e-9, scale=12.0)
    crowned = evaluate(x, 8.0 * (1.0 - s**2), 0.0, 1.0)
    # The line of least squares through a parabola is level: what is left of it is the parabola's whole height.
    yield from near((crowned.crown, crowned.form, crowned.total), (8.0, 8.0, 8.0), 1e-6)
    yield from near(crowned.slope, 0.0, 1e-9, scale=8.0)
    waves = evaluate(x, 5.0 * s + 3.0 * np.cos(10.0 * math.pi * x), 0.0, 1.0)
    yield from near((waves.slope, waves.form), (10.0, 6.0), 1e-6)
