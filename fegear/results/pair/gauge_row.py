"""A gauge in one row: what it comes to beside other gauges."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.shown import shown
from fegear.engine.sheet.rows import Rows

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.fitted_line import Fitted
    from fegear.engine.sheet.seen import Seen, Text
    from fegear.results.pair.trace_verdict import BesideTrace

#: Word where a trace is not judged.
_DRAFT = "not judged"


@dataclass(frozen=True)
class GaugeRow:
    """What a gauge comes to; NaN where it was not measured or not fitted."""

    gauge: str = shown("", "gauge")
    torque: float = shown("N.m", "torque on the driver")
    peak: float = shown("um/m", "peak strain computed", name="computed_peak")
    change: float = shown(
        "%", "largest change of the computed peak within placement_tolerance", name="change_by_placement"
    )
    scale: float = shown("", "measured / computed strain by least squares")
    offset: float = shown("um/m", "fitted zero of the bridge")
    shift: float = shown("deg", "fitted zero of the angle")
    residual: float = shown("um/m", "root mean square of the residual")
    verdict: str = shown("", "measured strain compared with the computed one")

    @classmethod
    def of(cls, name: str, data: BesideTrace, torque: float, peak: float) -> GaugeRow:
        """Of a gauge with the peak that is computed for it."""
        change = data.planned(name).largest or math.nan
        if data.compared is None:
            return cls(name, torque, peak, change, *(math.nan,) * 4, "")
        word, found = data.judged.word or _DRAFT, data.described
        if found is None:  # what is fitted to a curve that the trace has not is nothing
            return cls(name, torque, peak, change, *(math.nan,) * 4, word)
        return cls(
            name, torque, peak, change, found.gain, _if_fitted(found, "offset"), _if_fitted(found, "shift"),
            found.rms if found.fits else math.nan, word,
        )  # fmt: skip


def _if_fitted(found: FittedCurve, quantity: Fitted) -> float:
    return float(getattr(found, quantity)) if quantity in found.fit else math.nan


def gauge_rows(name: str, title: Text, rows: Callable[[Seen], list[GaugeRow]]) -> Rows:
    """A table of gauges, of which each has one row, or without a trace one for each torque."""
    return Rows(
        name, title, ("gauge", "torque", "peak", "change", "scale", "offset", "shift", "residual", "verdict"),
        of=rows,
    )  # fmt: skip
