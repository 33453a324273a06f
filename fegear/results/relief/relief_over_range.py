"""Reliefs over torque: what each leaves at every torque, also within tolerances, as a table, a chart and in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.engine.colours import ROLES
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.left_errors import left_error

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.design.tip_relief.tip_tolerance import Decisive
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.pair import GearPair

#: Torques of a spectrum that an answer names at most.
_NAMED = 4


@dataclass(frozen=True)
class LeftOverRange:
    """What one relief leaves at each torque of the range, arrays of shape (L,).

    Parameters
    ----------
    error : float or ndarray, shape (L,), or None
        Of the peak-to-peak values [m].
    finer : int or None
        By how many classes the tolerances would have to be finer for it to leave no more than no relief anywhere: 0
        where they do, None where none does.
    slopes : ndarray, shape (L,), or None
        Of no relief: maximum peak-to-peak value with profile slopes inside the tolerances of the amounts [m]; None
        where nothing is compared with it.
    decisive : tuple of Decisive or None, length L
        Which tolerance, once halved, reduces the maximum within the tolerances most at each torque; empty where this
        is not known.
    """

    torque: Array = shown("N.m", "torque on the driver", label="torque on the driver")
    load: Array = shown("N", "total load along the line of action", name="total_load")
    weight: Array = shown("", "weight in the design, over the largest")
    peak_to_peak: Array = shown("um", "peak-to-peak transmission error", name="te_peak_to_peak")
    first: Array = shown("um", "first harmonic of the transmission error, amplitude", name="te_first_harmonic")
    most: Array | None = shown(
        "um", "maximum peak-to-peak transmission error within the tolerances of amount and length",
        name="te_peak_to_peak_max", default=None,
    )  # fmt: skip
    error: float | Array | None = None
    mean: Array | None = shown(
        "um", "peak-to-peak transmission error, mean over the scatter of misalignment",
        name="te_mean_over_scatter", default=None,
    )  # fmt: skip
    finer: int | None = 0
    decisive: tuple[Decisive | None, ...] = ()
    slopes: Array | None = None
    share: Array | None = shown("", "share of time in the load spectrum", default=None, name="time_share")
    rounded: Array | None = shown(
        "um", "peak-to-peak transmission error with the rounded numbers of the grinding table",
        name="te_peak_to_peak_rounded", default=None,
    )  # fmt: skip

    @property
    def time_mean(self) -> float:
        """Peak-to-peak value, mean over the time under load of the spectrum [m]."""
        return float("nan") if self.share is None else float(np.average(self.peak_to_peak, weights=self.share))

    @property
    def compared(self) -> Array:
        """Of no relief: what a relief within its tolerances is compared with, shape (L,) [m]."""
        return self.peak_to_peak if self.slopes is None else self.slopes

    @property
    def named(self) -> tuple[int, ...]:
        """Places that an answer names, the largest torque first: both ends, of a spectrum also the longest times."""
        longest = [] if self.share is None else np.argsort(-self.share, kind="stable")[: _NAMED - 2].tolist()
        return tuple(sorted({0, self.torque.size - 1, *longest}, reverse=True))

    @property
    def errors(self) -> Array | None:
        """Of the peak-to-peak values [m]."""
        return None if self.error is None else np.broadcast_to(self.error, self.torque.shape)


def left_over_range(
    design: ReliefDesign, pair: GearPair, shifted: Sequence[Engagement] = ()
) -> dict[str, LeftOverRange]:
    """What every relief leaves at the loads of the range, or of the pair; `shifted` as in `left_error`."""
    load = np.array(design.task.over_loads)
    weights, over = design.task.over_weights, design.task.over
    shares = None if over is None or over.shares is None else np.array(over.shares)
    within = {f"{shape} tip relief": both[:, 1] for shape, both in design.within.items()}
    best = f"{design.shapes[0]} tip relief" if design.ground else ""
    rounded = {f"{shape} tip relief": one for shape, one in design.rounded.items()}
    searched = {f"{shape} tip relief": one for shape, one in design.ground.items()}
    searched |= {f"{shape} tip relief for one load": one for shape, one in design.for_one_load.items()}
    return {
        label: LeftOverRange(
            load * pair.driver.base_radius, load, weights / weights.max(),
            np.array([one.peak_to_peak for one in found]), np.array([one.series.amplitude[0] for one in found]),
            within.get(label), _errors(found, shifted, searched.get(label)),
            finer=design.finer if label == best else 0, decisive=design.decisive if label == best else (),
            share=shares, rounded=rounded.get(label),
            slopes=design.unrelieved_most if label == "no relief" else None,
        )
        for label, found in _best_first(design).items()
    }  # fmt: skip


def _best_first(design: ReliefDesign) -> dict[str, tuple[TransmissionError, ...]]:
    """What is left without relief, with the present one, with those to grind, the best first, and with the others."""
    shapes = [f"{shape} tip relief" for shape in design.shapes] if design.ground else []
    order = dict.fromkeys(("no relief", "present relief", *shapes, "designed", *design.over_range))
    return {label: design.over_range[label] for label in order if label in design.over_range}


def _errors(
    found: Sequence[TransmissionError], shifted: Sequence[Engagement], ground: TipReliefPair | None
) -> Array | None:
    """Of the peak-to-peak value at each torque [m]."""
    searched = None if ground is None else ground.objective_error
    known = [left_error(te, shifted, searched).peak_to_peak for te in found]
    return None if None in known else np.array(known)


def said_of_spectrum(name: str, none: LeftOverRange, drawn: LeftOverRange) -> Iterator[str]:
    """What a relief leaves on the mean over the time of a spectrum, and what it was designed by; nothing without one.

    Parameters
    ----------
    name : str
        Of the pair.
    none, drawn : LeftOverRange
        Without relief, and with what is ground.
    """
    if none.share is None:
        return
    before, after = told_apart(none.time_mean, drawn.time_mean)
    yield (
        f"Pair {name}: mean over the time under load {before} -> {after} µm; minimised: the maximum over the load "
        "spectrum of transmission error / torque times share of time."
    )


def left_words(
    none: Array, drawn: Array, most: Array | None, torque: Array, at: Sequence[int], share: Array | None = None
) -> str:
    """Without relief, as drawn and at most within the tolerances: "7 -> 2.4 µm (tolerances: at most 4.5 µm) at ...".

    Parameters
    ----------
    none, drawn : ndarray, shape (L,)
        Peak-to-peak transmission error [m].
    most : ndarray, shape (L,), or None
        With amounts and lengths inside their tolerances; None where nothing is known of these [m].
    torque : ndarray, shape (L,)
        [N m].
    at : sequence of int
        Places that are named.
    share : ndarray, shape (L,), optional
        Of the time, at each torque of a spectrum.
    """
    said: list[str] = []
    for i in at:
        within = ""
        if most is not None:
            within = f" ({'at most' if said else 'within tolerances at most'} {microns(most[i])} µm)"
        time = "" if share is None else f" for {percent(float(share[i])).replace('.0 %', ' %')} of the time"
        said.append(f"{microns(none[i])} -> {microns(drawn[i])} µm{within} at {torque_words(torque[i])}{time}")
    return ", ".join(said)


def _key(seen: Seen) -> str:
    return seen.key.replace(" ", "_").replace("-", "_")


def _legend(seen: Seen) -> str:
    """A relief in a legend; that by theory is for one load, whatever the others are for."""
    return "exact relief for one load (designed)" if seen.key == "designed" else seen.key


def _role(seen: Seen) -> str:
    """The look of a relief, or of its place among several that have none."""
    places = list(seen.data.over_range)
    return seen.key if seen.key in ROLES else f"series:{places.index(seen.key)}"


def _first(seen: Seen) -> LeftOverRange:
    return next(iter(seen.data.over_range.values()))


OVER_RANGE = Rows(
    "relief_over_torque_{name}", "Transmission error of {name} over the torque, with each relief",
    (
        "torque", "load", "weight", "share",
        Each(
            "over_range",
            Cell("peak_to_peak", name=lambda seen: f"te_peak_to_peak_{_key(seen)}", further=", {key}"),
            Off("peak_to_peak", "errors", name=lambda seen: f"te_peak_to_peak_{_key(seen)}"),
            Cell("rounded", name=lambda seen: f"te_peak_to_peak_rounded_{_key(seen)}", further=", {key}"),
            Cell("most", name=lambda seen: f"te_peak_to_peak_max_{_key(seen)}", further=", {key}"),
            Cell("first", name=lambda seen: f"te_first_harmonic_{_key(seen)}", further=", {key}"),
            Cell("mean", name=lambda seen: f"te_mean_over_scatter_{_key(seen)}", further=", {key}"),
        ),
    ),
    of=_first, when="over_range", printed=True,
)  # fmt: skip

#: Of every relief, where the loads are those of a spectrum.
TIME_MEANS = Each(
    "over_range",
    Number(
        "peak_to_peak", si="time_mean", name=lambda seen: f"te_time_mean.{_key(seen)}",
        meaning="mean over the time under load of the spectrum, {key}",
    ),
)  # fmt: skip

RANGE_CHART = Chart(
    "relief_over_torque_{name}", "Transmission error of pair {name} over the torque",
    "Pair {name}: peak-to-peak transmission error over the torque with each relief, and without. Thin: maximum within "
    "the tolerances of the grinding table.",
    (
        Over(
            "torque",
            (
                Bundle(
                    Family("over_range", role=_role),
                    (
                        Line("peak_to_peak", _legend, look={"markers": True}),
                        Line("most", look={"width": 0.8, "markers": False}),
                    ),
                ),
            ),
            lambda _: Axis("peak-to-peak transmission error", "um", zero=True),
        ),
    ),
    of=_first, when=lambda seen: _first(seen).torque.size > 1,
)  # fmt: skip
