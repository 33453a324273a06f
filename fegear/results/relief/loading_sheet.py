"""What loading functions show: their families, loads and spectra, and how a tooth answers each of them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.declared import axis_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.results.relief.loading_data import LoadingShown, OwnVibration

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen, Where

#: Spectra are drawn down to this share of their value at zero.
_LEAST = 1e-6


def _own(quantity: str) -> Cell:
    """What the data have for all functions, of this one."""
    return Cell(f"data.{quantity}", lambda seen: getattr(seen.one.data, quantity)[seen.one.number])


def _modulus(quantity: str) -> Where:
    return lambda seen: np.abs(getattr(seen.one.data, quantity)[seen.one.number])


def _stacked(name: str, title: str, *columns: Cell | str) -> Rows:
    """All functions below each other, each over the same abscissa."""
    return Rows(f"{name}{{d.end}}", title, (*_which(), *columns), stacked="functions")


def _which(head: str = "") -> tuple[str, ...]:
    """Slope, exponent and peak of a function."""
    return f"{head}function.ramp.slope", f"{head}exponent", f"{head}function.peak"


def _drawn(y: str, x: str, width: float) -> Line:
    """A quantity of each function, as many as can be told apart."""
    look = {"width": width, "markers": False}
    return Line(y, "{one.label}", x=x, each=Family("functions", role="ramp"), look=look)


def _beside(y: str, x: str) -> Line:
    """The pairs before and after."""
    look = {"dash": "dash", "width": 1.2, "markers": False}
    return Line(y, "adjacent pairs", "grey", x=x, each=Family("adjacent"), look=look)


def _path_axes(seen: Seen) -> tuple[Axis, Axis]:
    if seen.asked.name:
        return Axis("roll distance", "mm"), Axis("load of a tooth pair", "N", zero=True)
    return Axis("roll distance from the middle of contact", "base pitches"), Axis("load / design load", zero=True)


def _path_marks(seen: Seen) -> tuple[Mark, ...]:
    scale, first = (1e3 if seen.asked.name else 1.0), seen.data.first
    return Mark("x", first.x_start * scale, "initiation"), Mark("x", first.x_end * scale, "end")


def _look(dash: str, width: float) -> dict[str, object]:
    return {"dash": dash, "width": width, "markers": False}


def _answer(quantity: str, **options: Any) -> Over:
    """Answer of a tooth over its natural frequency; marks are the teeth of the pair."""
    return Over(
        lambda _: axis_of(OwnVibration, "order", log=True), (_drawn(f"response.{quantity}", "data.order", 1.4),),
        lambda seen: axis_of(seen.data.data.response[0], quantity, **options),
        marks=lambda seen: tuple(Mark("x", own.order, own.member) for own in seen.data.data.teeth),
    )  # fmt: skip


def _content(seen: Seen) -> str:
    above = seen.asked.part.content_above
    return f"root mean square of the spectrum from order {above:g} to {10.0 * above:g}"


def _frequency(seen: Seen) -> str:
    computed = "lowest natural frequency of a tooth (beam on elastic foundation)"
    return f"{'given' if seen.asked.part.tooth_frequency else computed}; order {seen.one.order:.5g} of the tooth mesh"


def _only_of_pair(quantity: str) -> Number:
    return Number(quantity, exact, name=f"loading_{quantity}", when="asked.name")


def _first_answer(quantity: str) -> Cell:
    return Cell(f"response.{quantity}", lambda seen: [getattr(one.response, quantity)[0] for one in seen.data.own])


LOADING_SHEET = Sheet(
    of=LoadingShown,
    tables=(
        _stacked("loading_families", "Loading of a ramp, from -1 to 1", "listed_ramp.x", "listed_ramp.load"),
        _stacked(
            "loading_functions", "Load of one tooth pair", "on_path.x", "on_path.in_pitches", "on_path.load",
            "on_path.share",
        ),
        _stacked(
            "loading_spectrum_factors", "Spectrum of the ramp: braces of Mark (4.15b) and (4.16)", "data.q",
            _own("factor"), _own("factor_asymptote"),
        ),
        _stacked(
            "loading_spectra", "Spectrum of the load of one tooth pair", "data.order", _own("spectrum"),
            _own("asymptote"), _own("envelope"),
        ),
        _stacked(
            "loading_tooth_response", "Response of a single tooth / static deflection",
            Cell("order", "data.order", lambda _: OwnVibration), "response.residual", "response.envelope",
            "response.largest",
        ),
        Rows(
            "loading_trade_off{d.end}", "Trade-off of the slope at initial contact",
            (
                *_which(), "slope_per_length", "slope_per_pitch", "length_per_load", "pitches_per_load",
                Cell("high_frequency_content", meaning=_content),
            ),
            of="functions",
        ),
        Rows(
            "loading_tooth_vibration{d.end}", "Response of single teeth at the speed of the case",
            (
                "own.member", *_which("loading."), "own.order", _first_answer("residual"), _first_answer("largest"),
            ),
            of="own", when="own",
        ),
    ),
    values=(
        Number("contact_ratio", exact, name="loading_contact_ratio"),
        Number("sum_misfit", exact, "data"),
        *map(_only_of_pair, ("base_pitch", "path", "length", "ramp")),
        Number("frequency", name="tooth_frequency_{one.member}", meaning=_frequency, each="data.teeth"),
    ),
    figures=(
        Chart(
            "loading_families{d.end}",
            lambda seen: (
                f"Normalised tooth loading, {'polynomial' if seen.data.first.ramp.exponent else 'sinusoidal'} family"
            ),
            "Load transfer between two pairs: from none (-1) to all (1), slope s at both ends; s = 1: linear.",
            (
                Over(
                    Axis("normalised roll distance", limits=(-1.0, 1.0)),
                    (_drawn("drawn_ramp.load", "drawn_ramp.x", 1.8),),
                    Axis("normalised load", limits=(-1.0, 1.0)),
                ),
            ),
        ),
        Chart(
            "loading_functions{d.end}", "Tooth loading functions{d.of_pair}",
            lambda seen: (
                f"Load of one tooth pair over its path, contact ratio {seen.data.contact_ratio:.4g}; dashed: adjacent "
                f"pairs with the loading {seen.data.functions[0].label}. The total load is constant."
            ),
            (
                Over(
                    lambda seen: _path_axes(seen)[0],
                    (
                        _drawn("on_path.load", "on_path.x", 2.4),
                        _drawn("on_path.share", "on_path.in_pitches", 2.4),
                        _beside("load", "x"), _beside("share", "in_pitches"),
                    ),
                    lambda seen: _path_axes(seen)[1],
                    marks=_path_marks,
                ),
            ),
        ),
        Chart(
            "loading_spectrum_factors{d.end}", "Spectrum factors of the tooth loading functions",
            "Ramp factor of the load spectrum (braces of Mark 4.15b and 4.16) over frequency in cycles per ramp "
            "length. At high frequency it depends on the slope s at initiation only.",
            (
                Over(
                    lambda seen: axis_of(
                        seen.data.data, "q", log=True, limits=tuple(seen.data.data.q[[0, -1]].tolist())
                    ),
                    (
                        Line("data.factor_asymptote", "asymptote", "orange", x="data.q", when="asymptotic",
                             look=_look("dash", 2.2), si=_modulus("factor_asymptote")),
                        Line("factor_envelope", "envelope", "grey", x="data.q", look=_look("dot", 1.3)),
                        Line("data.factor", "spectrum factor", "blue", x="data.q", si=_modulus("factor"),
                             look={"width": 1.4, "markers": False}),
                    ),
                    "data.factor", options={"log": True, "limits": (1e-4, 3.0)}, title="{one.label}",
                    each="panelled",
                ),
            ),
            when="has_factors", columns=lambda seen: 2 if len(seen.data.panelled) > 1 else 1,
        ),
        Chart(
            "loading_spectra{d.end}", "Spectra of the tooth loading functions{d.of_pair}",
            "Spectrum of the load of one tooth pair over frequency, in units of design load times base pitch; dashed: "
            "the envelope of its high-frequency asymptote (Mark 4.22). Zero at integer orders (constant total load).",
            (
                Over(
                    "order",
                    (
                        Bundle(
                            Family("functions", role="ramp"),
                            (
                                Line("data.spectrum", "{one.label}", x="data.order", si=_modulus("spectrum"),
                                     look={"width": 1.4, "markers": False}),
                                Line("data.envelope", x="data.order", x_si="seen_order", si="seen_envelope",
                                     look=_look("dash", 1.1)),
                            ),
                        ),
                    ),
                    lambda seen: axis_of(
                        seen.data.data, "spectrum", log=True, limits=(_LEAST * seen.data.highest, seen.data.highest)
                    ),
                    x_options={"log": True},
                ),
            ),
            of="data",
        ),
        Chart(
            "loading_tooth_response{d.end}", "Vibration of a single tooth{d.of_pair}",
            "Single tooth as an undamped oscillator under the load of one engagement: residual vibration after contact "
            "and maximum deflection during contact, both relative to the static deflection under the design load.",
            (_answer("residual", log=True, limits=(1e-4, 4.0)), _answer("largest", zero=True)),
        ),
    ),
    remarks=(
        Remark(
            "Pair {name}: single tooth response without damping, neighbouring teeth and mating tooth.",
            when="data.teeth",
        ),
        Remark(
            "Loading with zero initial slope has no second-order asymptote: its spectrum decreases faster than the "
            "square of the frequency.",
            when=lambda seen: any(f.ramp.slope == 0.0 for f in seen.data.data.functions),
        ),
        Remark(
            "Integer number of base pitches in the loaded path: the load starts with a step (infinite slope) and its "
            "spectrum decreases only with the frequency.",
            when=lambda seen: any(math.isinf(f.initial_slope()) for f in seen.data.data.functions),
        ),
    ),
    settings={"load": "asked.load"},
)  # fmt: skip
