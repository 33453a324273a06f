"""Harris maps: transmission error over the mesh cycle for a family of loads, of a design and beside a load slider."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows
from fegear.contact.loaded_teeth import POSITIONS, LoadedTeeth
from fegear.engine.declared import drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.load_words import load_words
from fegear.engine.sheet.seen import Seen
from fegear.geometry.pair import GearPair
from fegear.results.pair.loaded_teeth import BASE_PITCH, pitch_marks

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.engine.figure.figure import Figure

#: Loads of a family up to the greatest, and roll positions of the curve that follows a slider.
_FAMILY, _QUICK = 10, 60
#: Name of the curve and the point that are for the present load.
NOW = "present load"
#: Widths of a curve that stands out, and of the others.
_WIDE, _NARROW = 3.0, 1.4


@dataclass(frozen=True)
class HarrisCurve:
    """Transmission error over one base pitch under one load; arrays of shape (P,)."""

    x: Array = shown("mm", "mesh position over one base pitch")
    transmission_error: Array = shown("um", "transmission error")
    load: float = shown("N", "total load along the line of action")
    label: str = ""
    wide: bool = False
    marked: bool | None = None

    @property
    def look(self) -> dict[str, object]:
        """Wide where it is the one of a family."""
        return {"width": _WIDE if self.wide else _NARROW, "markers": self.marked}

    @property
    @shows("N", "total load along the line of action")
    def loads(self) -> Array:
        """Itself, shape (1,)."""
        return np.array([self.load])

    @property
    @shows("um", "peak-to-peak value")
    def peak_to_peak(self) -> float:
        """[m]."""
        return float(np.ptp(self.transmission_error))


@dataclass(frozen=True)
class HarrisBand:
    """What a family covers between two of its loads; arrays of shape (P,).

    Parameters
    ----------
    half : ndarray
        From its middle to either side [m].
    """

    x: Array = shown("mm", "mesh position over one base pitch")
    transmission_error: Array = shown("um", "transmission error")
    half: Array | None = None


@dataclass(frozen=True)
class HarrisMap:
    """Transmission error of a pair over one base pitch for L loads and P roll positions.

    Parameters
    ----------
    pair : GearPair
    greatest : float
        Up to which loads may go [N].
    at : float
        Load whose curve stands out [N]; nan for none.
    word : str
        What that load is called.
    present : HarrisCurve or None
        A further curve, which stands out in place of it.
    over : tuple of float
        Ends of the range of loads that a design is for [N]; empty for none.
    """

    pair: GearPair
    x: Array = shown("mm", "mesh position over one base pitch")
    load: Array = shown("N", "total load along the line of action", name="total_load")
    transmission_error: Array = shown("um", "transmission error")
    greatest: float = math.nan
    at: float = math.nan
    word: str = ""
    present: HarrisCurve | None = None
    over: tuple[float, ...] = ()

    @property
    def band(self) -> HarrisBand | None:
        """From the smallest to the largest load of the range; None without one."""
        if len(self.over) < 2:
            return None
        low, high = (self.transmission_error[int(np.argmin(np.abs(self.load - one)))] for one in self.over)
        return HarrisBand(self.x, 0.5 * (low + high), 0.5 * np.abs(high - low))

    @property
    @shows("um", "peak-to-peak value")
    def peak_to_peak(self) -> Array:
        """For each load, shape (L,)."""
        return np.asarray(np.ptp(self.transmission_error, axis=1))

    @property
    def nearest(self) -> tuple[int, ...]:
        """Number of the load that stands out, or of the nearest to it."""
        return (0 if math.isnan(self.at) else int(np.argmin(np.abs(self.load - self.at))),)

    @cached_property
    def curves(self) -> tuple[HarrisCurve, ...]:
        """One for each load."""
        word, marked = f" ({self.word})" if self.load.size > 1 else "", None if self.present is None else False
        return tuple(
            HarrisCurve(self.x, te, w, f"{load_words(w)}{word if w == self.at else ''}", w == self.at, marked)
            for w, te in zip(self.load.tolist(), self.transmission_error, strict=True)
        )


#: Transmission error over one base pitch, a curve for each load of the map.
OVER_ROLL = Over(
    BASE_PITCH,
    (
        Line(
            "transmission_error", each=Family("curves", "{one.label}", "ramp", keep="nearest"),
            look=lambda seen: seen.one.look,
        ),
        Line("transmission_error", role="grey", of="band", error="band.half", look={"width": 0.0, "markers": False}),
        Line("transmission_error", NOW, "ink", of="present", look={"dash": "solid", "width": 3.2, "markers": False}),
    ),
    Axis("transmission error", "um", zero=True),
    marks=lambda seen: pitch_marks(seen.find("pair"), seen.find("x")),
)  # fmt: skip
_BESIDE_SLIDER = Chart(
    "slider_map_{name}",
    "Harris map of pair {name}",
    "Pair {name}: transmission error over the mesh cycle for loads up to {d.greatest:said} with the reliefs of the "
    "case, and peak-to-peak values; thick line and large point: present load.",
    (
        OVER_ROLL,
        Over(
            Axis("load along the line of action", "N", zero=True),
            (
                Line("peak_to_peak", role="designed", x="load", look={"markers": True}),
                Line(
                    "peak_to_peak", NOW, "ink", of="present", x="loads", kind="points",
                    look={"symbol": "circle", "size": 11.0},
                ),
            ),
            Axis("peak to peak", "um", zero=True),
            panel={"height": 0.7},
        ),
    ),
)  # fmt: skip


#: Of a design: a map for each of its reliefs.
HARRIS_CHART = Chart(
    "harris_map_{name}", "Harris map of pair {name}",
    "Pair {name}: transmission error over the mesh cycle for a family of loads, with each relief; "
    "thick: design load, {d.load:said}; grey: range of torques of the design.",
    (OVER_ROLL,), views="maps",
)  # fmt: skip


def _round_step(about: float) -> float:
    """The next step of 1, 2, 2.5 or 5 times a power of ten that is no longer than this."""
    power = 10.0 ** math.floor(math.log10(about))
    return max(one for one in (1.0, 2.0, 2.5, 5.0) if one <= about / power * (1.0 + 1e-9)) * power


def _now(teeth: LoadedTeeth, positions: int) -> HarrisCurve:
    """The pair under its nominal load."""
    x, load, error = teeth.error_under([teeth.nominal], positions)
    return HarrisCurve(x, error[:, 0], float(load[0]))


def load_now(teeth: LoadedTeeth) -> tuple[float, Array, Array]:
    """The transmission error at the nominal load, at a few roll positions, while a slider moves: N, mm and um."""
    now = _now(teeth, _QUICK)
    return now.load, drawn(now, "x"), drawn(now, "transmission_error")


def half_and_full(teeth: LoadedTeeth) -> tuple[float, float]:
    """Peak-to-peak transmission error at half the nominal load and at all of it [um]."""
    _, _, error = teeth.error_under([0.5 * teeth.nominal, teeth.nominal], POSITIONS)
    half, full = drawn(HarrisCurve, "peak_to_peak", np.ptp(error, axis=0)).tolist()
    return half, full


def slider_map(name: str, teeth: LoadedTeeth, greatest: float) -> Figure:
    """The Harris map beside a load slider: the family up to the greatest load, and the present load in it.

    Parameters
    ----------
    name : str
        Of the pair.
    teeth : LoadedTeeth
        Its reliefs, errors and effects are those of the case.
    greatest : float
        Load to which the slider goes [N].
    """
    step = _round_step(greatest / _FAMILY)
    loads = step * np.arange(1.0, math.floor(greatest / step * (1.0 + 1e-9)) + 1.0)
    x, load, error = teeth.error_under(loads, POSITIONS)
    shown_map = HarrisMap(teeth.pair, x, load, error.T, greatest, present=_now(teeth, POSITIONS))
    (figure,) = _BESIDE_SLIDER.figures(Seen(shown_map, name=name))
    return figure
