"""Figures of tooth loading functions: their families, the load of a tooth pair and its neighbours, their spectra."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Curve, Mark, few, ramp

if TYPE_CHECKING:
    from fegear.design.loading import LoadingFunction
    from fegear.results.relief.loading_spectrum import LoadingData, LoadingInputs

#: Spectra are drawn down to this share of their value at zero.
_LEAST = 1e-6
#: Panels of one figure.
_MOST_PANELS = 8


def loading_figures(data: LoadingData, asked: LoadingInputs) -> tuple[Figure, ...]:
    """Every figure; a contact ratio above 2 has two ramps, whose spectra only count together."""
    end, of = (f"_{asked.name}", f" of pair {asked.name}") if asked.name else ("", "")
    chosen = few(len(data.functions))
    roles, words = ramp(len(chosen)), labels(data.functions)
    shown = [(i, words[i], role) for i, role in zip(chosen, roles, strict=True)]
    figures = [_families(data, shown, end), _functions(data, asked, shown, end, of)]
    if data.functions[0].order == 1 and data.functions[0].terms[0][2] > 0.0:
        figures.append(_factors(data, words, end))
    return (*figures, _spectra(data, shown, end, of), _response(data, shown, end, of))


def labels(functions: tuple[LoadingFunction, ...]) -> list[str]:
    """What tells the functions apart; all of it where there is only one."""
    rows = [
        (f"s = {f.ramp.slope:g}", f"r = {f.ramp.exponent}" if f.ramp.exponent else "", f"F = {f.peak:.4g}")
        for f in functions
    ]
    differ = [len({row[k] for row in rows}) > 1 for k in range(3)]
    keep = [k for k in range(3) if differ[k]] or [k for k in range(3) if k < 2 or functions[0].order > 1]
    return [", ".join(row[k] for k in keep if row[k]) for row in rows]


def _families(data: LoadingData, shown: list[tuple[int, str, str]], end: str) -> Figure:
    x = np.linspace(-1.0, 1.0, 401)
    curves = tuple(
        Curve(x, data.functions[i].ramp.load(x), word, role, markers=False) for i, word, role in shown
    )  # fmt: skip
    panel = Panel(
        Axis("normalised roll distance", limits=(-1.0, 1.0)), Axis("normalised load", limits=(-1.0, 1.0)), curves,
    )  # fmt: skip
    family = "polynomial" if data.functions[0].ramp.exponent else "sinusoidal"
    return Figure(
        f"loading_families{end}", f"Normalised tooth loading, {family} family",
        "How a tooth pair takes over load where two pairs share it: from none (-1) to all (1), with slope s at both "
        "ends; s = 1 is the straight line.",
        (panel,),
    )  # fmt: skip


def _functions(data: LoadingData, asked: LoadingInputs, shown: list[tuple[int, str, str]], end: str, of: str) -> Figure:
    scale, pitch, first = (1e3 if asked.name else 1.0), asked.base_pitch, data.functions[0]
    x = Axis("roll distance", "mm") if asked.name else Axis("roll distance from the middle of contact", "base pitches")
    y = Axis("load of a tooth pair", "N", zero=True) if asked.name else Axis("load over the design load", zero=True)
    items = []
    for i, word, role in shown:
        items.append(Curve(data.x * scale, data.load[i] * asked.load, word, role, width=2.4, markers=False))
    for side in (-1, 1):
        at = (data.x + side * pitch) * scale
        near = np.abs(data.x + side * pitch - first.centre) <= 0.5 * (first.length + pitch)
        load = np.where(near, data.load[shown[0][0]] * asked.load, np.nan)
        items.append(Curve(at, load, "next pairs", "grey", dash="dash", width=1.2, markers=False))
    marks = (Mark("x", first.x_start * scale, "initiation"), Mark("x", first.x_end * scale, "end"))
    return Figure(
        f"loading_functions{end}", f"Tooth loading functions{of}",
        f"Load of one tooth pair over its path, contact ratio {asked.length / pitch:.4g}; dashed: the pairs before "
        f"and behind it, with the loading {shown[0][1]}. All pairs together carry the design load at every position.",
        (Panel(x, y, tuple(items), marks),),
    )  # fmt: skip


def _factors(data: LoadingData, words: list[str], end: str) -> Figure:
    q, panels = data.q, []
    for i in few(len(data.functions), most=_MOST_PANELS):
        slope = data.functions[i].ramp.slope
        curves = []
        if slope > 0.0:
            curves = [
                Curve(
                    q, np.abs(data.factor_asymptote[i]), "asymptote", "orange", dash="dash", width=2.2, markers=False
                ),
                Curve(q, slope / (np.pi * q), "its envelope", "grey", dash="dot", width=1.3, markers=False),
            ]
        curves.append(Curve(q, np.abs(data.factor[i]), "spectrum factor", "blue", width=1.4, markers=False))
        panels.append(Panel(
            Axis("q = (L - A) g", log=True, limits=(float(q[0]), float(q[-1]))),
            Axis("modulus of the factor", log=True, limits=(1e-4, 3.0)), tuple(curves), title=words[i],
        ))  # fmt: skip
    return Figure(
        f"loading_spectrum_factors{end}", "Spectrum factors of the tooth loading functions",
        "What the shape of the ramp adds to the spectrum of a tooth's load (the braces of Mark's 4.15b and 4.16), over "
        "the frequency in cycles per width of the ramp. At high frequency only the slope s at initiation counts.",
        tuple(panels), columns=2 if len(panels) > 1 else 1,
    )  # fmt: skip


def _spectra(data: LoadingData, shown: list[tuple[int, str, str]], end: str, of: str) -> Figure:
    curves = []
    for i, word, role in shown:
        curves.append(Curve(data.order, data.spectrum[i], word, role, markers=False, width=1.4))
        if np.any(data.envelope[i] > 0.0):
            inside = data.envelope[i] <= data.spectrum[i].max()
            curves.append(Curve(
                data.order[inside], data.envelope[i][inside], "", role, dash="dash", width=1.1, markers=False
            ))  # fmt: skip
    top = 2.0 * float(max(data.spectrum[i].max() for i, _, _ in shown))
    return Figure(
        f"loading_spectra{end}", f"Spectra of the tooth loading functions{of}",
        "Spectrum of the load of one tooth pair over frequency, in units of design load times base pitch; dashed: the "
        "envelope of its high-frequency asymptote (Mark 4.22). At whole orders it vanishes, for the loads of all pairs "
        "add up to a constant.",
        (Panel(
            Axis("frequency over the tooth-mesh frequency", log=True),
            Axis("spectrum over design load and base pitch", log=True, limits=(_LEAST * top, top)), tuple(curves),
        ),),
    )  # fmt: skip


def _response(data: LoadingData, shown: list[tuple[int, str, str]], end: str, of: str) -> Figure:
    left, largest = [], []
    for i, word, role in shown:
        answer = data.response[i]
        left.append(Curve(data.order, answer.residual, word, role, markers=False, width=1.4))
        largest.append(Curve(data.order, answer.largest, word, role, markers=False, width=1.4))
    order = Axis("natural frequency of the tooth over the tooth-mesh frequency", log=True)
    marks = tuple(Mark("x", own.order, own.member) for own in data.teeth)
    return Figure(
        f"loading_tooth_response{end}", f"Answer of a tooth by itself{of}",
        "A tooth as an oscillator without damping under the load of one passage: the vibration left when contact ends, "
        "and the largest deflection during contact, both over the deflection under the design load at rest.",
        (
            Panel(order, Axis("vibration left, 0-peak", log=True, limits=(1e-4, 4.0)), tuple(left), marks),
            Panel(order, Axis("largest deflection", zero=True), tuple(largest), marks),
        ),
    )  # fmt: skip
