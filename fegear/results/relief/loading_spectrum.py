"""Result ``loading-spectrum``: families of tooth loading functions and how much each excites the teeth themselves."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown
from fegear.case.loading import LoadingPart
from fegear.case.reading import Scene
from fegear.design.loading import LoadingFunction, SlopeTradeOff, ToothResponse
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, column_over, columns_of, repeated, stacked, tiled, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark, few, ramp
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS, GearPair, Member

#: Positions on a ramp and over the path.
_RAMP, _PATH = 201, 401
#: Lowest frequency of spectra, where their lobes begin, and how many frequencies lie below and above.
_LOWEST, _LOBES, _BELOW, _ABOVE = 0.1, 2.9, 199, 501
#: Highest of the ramp's own frequency q.
_HIGHEST_Q = 30.0
#: Largest contact ratio: gears have 1 to 4, and each base pitch of the path costs memory.
_LARGEST_RATIO = 100.0
#: Exponent of the polynomial family where the case names none.
_EXPONENT = 7
#: Spectra are drawn down to this share of their value at zero.
_LEAST = 1e-6
#: Panels of one figure.
_MOST_PANELS = 8
#: Functions that are drawn: number, words and role of each.
_Chosen: TypeAlias = "list[tuple[int, str, str]]"


@dataclass(frozen=True)
class LoadingInputs:
    """Which loading functions are looked at.

    Parameters
    ----------
    part : LoadingPart
    length, base_pitch, centre : float
        L, A and the middle of the path [m]; without a pair in base pitches, A = 1, about zero.
    load : float
        Design load [N]; 1 where loads are fractions of it.
    path : float
        Length of the pair's path of contact [m]; nan without a pair.
    name : str
        Of the pair, empty without one.
    gears : GearPair or None
        The pair, where the case gives it a speed.
    """

    part: LoadingPart
    length: float
    base_pitch: float
    centre: float
    load: float
    path: float
    name: str = field(compare=False)
    gears: GearPair | None = None


@dataclass(frozen=True)
class OwnVibration:
    """What the teeth of one gear of the pair do by themselves at the case's speed.

    `response` is that to each loading function, arrays of shape (1,).
    """

    response: tuple[ToothResponse, ...]
    member: Member = shown("", "driver or driven", name="gear")
    frequency: float = shown("Hz", "lowest natural frequency of a tooth")
    order: float = shown("", "natural frequency of the tooth / mesh frequency")


@dataclass(frozen=True)
class LoadingData:
    """F loading functions with their loads and spectra.

    `x` has shape (P,) [m], `load` (F, P) as shares of the design load, `order` and `q` (G,), spectra (F, G) as moduli.
    `factor` and `factor_asymptote` are the braces of (4.15b) and (4.16). `response` is that of a tooth to each function
    over its natural frequency in `order`; `teeth` are those of both gears at the case's speed, empty without one.
    """

    functions: tuple[LoadingFunction, ...]
    x: Array
    load: Array
    trade_off: SlopeTradeOff
    response: tuple[ToothResponse, ...]
    teeth: tuple[OwnVibration, ...]
    order: Array = shown("", "frequency / mesh frequency")
    spectrum: Array = shown(
        "", "modulus / (design load times base pitch)", label="spectrum / (design load times base pitch)"
    )
    asymptote: Array = shown("", "high-frequency asymptote (4.20)")
    envelope: Array = shown("", "envelope of the asymptote (4.22)")
    q: Array = shown("", "cycles over the width of the ramp", label="q = (L - A) g")
    factor: Array = shown("", "1 at q = 0", label="modulus of the factor")
    factor_asymptote: Array = shown("", "s sinc(q)", name="asymptote")
    sum_misfit: float = shown(
        "", "maximum relative deviation of the total load of all pairs from the design load", name="loading_sum_misfit"
    )


def _subjects(scene: Scene) -> tuple[str, ...]:
    return () if scene.case.loading is None else (scene.case.loading.pair or "",)


def _inputs(scene: Scene, name: str) -> LoadingInputs:
    part = scene.case.loading or LoadingPart(contact_ratio=1.5)
    if not name:
        return LoadingInputs(part, part.contact_ratio or math.nan, 1.0, 0.0, 1.0, math.nan, "")
    pair = scene.pairs[name]
    length = part.length or (part.contact_ratio * pair.base_pitch if part.contact_ratio else pair.path_length)
    load = part.load or scene.case.pair[name].normal_load(pair)
    if load is None:
        raise InputError("loading.load", "(not given)", "is required for a pair without load", 'set load = "1 kN"')
    gears, middle = pair if part.speed else None, 0.5 * (pair.x_start + pair.x_end)
    return LoadingInputs(part, length, pair.base_pitch, middle, load, pair.path_length, name, gears)


def loading_functions(asked: LoadingInputs) -> tuple[LoadingFunction, ...]:
    """Every combination of exponent, slope and peak."""
    from fegear.design.loading import LoadingFunction, Ramp

    part, ratio = asked.part, asked.length / asked.base_pitch
    if part.contact_ratio is not None and ratio < 1.0:
        raise RangeError(
            "loading.contact_ratio", part.contact_ratio,
            "is below 1: no tooth pair in contact at some positions", "choose at least 1",
        )  # fmt: skip
    if ratio > _LARGEST_RATIO:
        given = "contact_ratio" if part.contact_ratio is not None else "length"
        raise RangeError(
            f"loading.{given}", f"{ratio:.6g} base pitches", "is not a plausible contact ratio",
            f"use at most {_LARGEST_RATIO:g}",
        )  # fmt: skip
    exponents = (part.exponents or [_EXPONENT]) if part.family == "polynomial" else [None]
    try:
        return tuple(
            LoadingFunction(
                asked.length, asked.base_pitch, asked.centre, Ramp(slope, exponent),
                Ramp(part.inner_slope, exponent), peak,
            )
            for exponent, slope, peak in itertools.product(exponents, part.slopes, part.peaks or [math.nan])
        )  # fmt: skip
    except InputError as error:
        key = {"slope": "slopes", "exponent": "exponents", "peak": "peaks"}
        word = error.key.rpartition(".")[2]
        raise type(error)(f"loading.{key.get(word, word)}", error.value, error.rule, error.remedy) from None


def _check(scene: Scene, name: str) -> None:
    asked = _inputs(scene, name)
    loading_functions(asked)  # refuses what no pair of teeth can carry
    if asked.gears is not None and asked.gears.internal and asked.part.tooth_frequency is None:
        raise InputError(
            "loading.tooth_frequency", "(not given)",
            "is required for an internal pair (the beam model is for external teeth)",
            'set tooth_frequency = "30 kHz", or no speed',
        )  # fmt: skip


def _compute(asked: LoadingInputs, _upstream: Upstream, _work: Work) -> LoadingData:
    from fegear.design.loading import slope_trade_off, tooth_response

    functions, pitch = loading_functions(asked), asked.base_pitch
    first = functions[0]
    x = np.unique(np.concatenate([np.linspace(first.x_start, first.x_end, _PATH), first.kinks]))
    # Where a path starts with a jump, pairs count or not at the jump itself: look beside it.
    beside = first.centre + pitch * (np.linspace(0.0, 1.0, _PATH) + 0.31830988618 / _PATH)
    reach = 2 + math.ceil(asked.length / pitch)
    pairs = beside[None, :] + pitch * np.arange(-reach, reach + 1)[:, None]
    misfit = max(float(np.abs(f.fraction(pairs).sum(axis=0) - 1.0).max()) for f in functions)
    order, q = _frequencies(asked.part.highest_order), _frequencies(_HIGHEST_Q)

    def moduli(what: str) -> Array:
        return np.stack([np.abs(getattr(f, what)(order / pitch)) / pitch for f in functions])

    return LoadingData(
        functions, x, np.stack([f.fraction(x) for f in functions]),
        slope_trade_off(functions, asked.part.content_above), tuple(tooth_response(f, order) for f in functions),
        _own_vibrations(asked, functions), order, moduli("spectrum"), moduli("asymptote"), moduli("envelope"), q,
        np.stack([f.ramp.spectrum_factor(q) for f in functions]),
        np.stack([f.ramp.asymptotic_factor(q) for f in functions]), misfit,
    )  # fmt: skip


def _own_vibrations(asked: LoadingInputs, functions: tuple[LoadingFunction, ...]) -> tuple[OwnVibration, ...]:
    from fegear.design.loading import tooth_response
    from fegear.formulas.tooth_vibration import tooth_frequency

    pair, part, found = asked.gears, asked.part, []
    if pair is None or part.speed is None:
        return ()
    mesh = part.speed / (2.0 * math.pi) * pair.driver.tooth.teeth
    for member in MEMBERS:
        frequency = part.tooth_frequency or tooth_frequency(pair.gear(member))
        order = frequency / mesh
        found.append(OwnVibration(tuple(tooth_response(f, [order]) for f in functions), member, frequency, order))
    return tuple(found)


def _frequencies(top: float) -> Array:
    """In even steps where a spectrum has many lobes of one width, in even ratios below."""
    return np.concatenate([np.geomspace(_LOWEST, _LOBES, _BELOW, endpoint=False), np.linspace(_LOBES, top, _ABOVE)])


def _present(data: LoadingData, asked: LoadingInputs) -> Outcome:
    end, first, shares = f"_{asked.name}" if asked.name else "", data.functions[0], not asked.name
    length, x = "" if shares else "mm", np.linspace(-1.0, 1.0, _RAMP)
    ramps = np.concatenate([f.ramp.load(x) for f in data.functions])
    base_pitches = " in base pitches, from the middle of contact" if shares else ""

    def all_of(*attributes: str) -> tuple[Column, ...]:
        return tuple(column_of(data, key, getattr(data, key).ravel()) for key in attributes)

    tables = [
        _long(
            data, f"loading_families{end}", "Loading of a ramp, from -1 to 1",
            Column("x", x, "", "roll distance / half ramp length, from its middle"),
            Column("load", ramps, "", "2 (load / design load) - 1"),
        ),
        _long(
            data, f"loading_functions{end}", "Load of one tooth pair",
            Column("x", data.x, length, f"roll distance{base_pitches}"),
            Column("load", data.load.ravel() * asked.load, *(("", "load / design load") if shares else ("N", ""))),
        ),
        _long(
            data, f"loading_spectrum_factors{end}", "Spectrum of the ramp: braces of Mark (4.15b) and (4.16)",
            column_of(data, "q"), *all_of("factor", "factor_asymptote"),
        ),
        _long(
            data, f"loading_spectra{end}", "Spectrum of the load of one tooth pair",
            column_of(data, "order"), *all_of("spectrum", "asymptote", "envelope"),
        ),
        _long(
            data, f"loading_tooth_response{end}", "Response of a single tooth / static deflection",
            column_of(OwnVibration, "order", data.order),
            *stacked([columns_of(one, "residual", "envelope", "largest") for one in data.response]),
        ),
        _trade_off_table(f"loading_trade_off{end}", data, asked, length),
        *_own_table(f"loading_tooth_vibration{end}", data),
    ]  # fmt: skip
    ratio, of = asked.length / asked.base_pitch, f"{asked.name}." if asked.name else ""
    values = [
        Value(f"{of}loading_contact_ratio", ratio, "", 0.0, "length of the loaded path / base pitch"),
        value_of(data, "sum_misfit", asked.name, 0.0),
    ]  # fmt: skip
    if asked.name:
        outer = first.terms[0][2]
        values += [
            Value(f"{of}loading_base_pitch", asked.base_pitch, "mm", 0.0, "A"),
            Value(f"{of}loading_path", asked.path, "mm", 0.0, "path of contact of the pair"),
            Value(f"{of}loading_length", asked.length, "mm", 0.0, "L, loaded length of a pair"),
            Value(f"{of}loading_ramp", outer, "mm", 0.0, "ramp length at initiation"),
        ]
        for own in data.teeth:
            key = f"{of}tooth_frequency_{own.member}"
            given = (
                "given"
                if asked.part.tooth_frequency
                else ("lowest natural frequency of a tooth (beam on elastic foundation)")
            )
            values.append(Value(key, own.frequency, "Hz", None, f"{given}; order {own.order:.5g} of the tooth mesh"))
    remarks = []
    if data.teeth:
        remarks.append(
            f"Pair {asked.name}: single tooth response without damping, neighbouring teeth and mating tooth."
        )
    if any(f.ramp.slope == 0.0 for f in data.functions):
        remarks.append(
            "Loading with zero initial slope has no second-order asymptote: its spectrum decreases faster than the "
            "square of the frequency."
        )
    if any(math.isinf(f.initial_slope()) for f in data.functions):
        remarks.append(
            "Integer number of base pitches in the loaded path: the load starts with a step (infinite slope) and its "
            "spectrum decreases only with the frequency."
        )
    figures = _figures(data, asked)
    return Outcome(data, tuple(tables), tuple(values), {"load": asked.load}, tuple(remarks), figures)


def _long(data: LoadingData, name: str, title: str, over: Column, *columns: Column) -> Table:
    """All functions below each other, each over the same abscissa."""
    return Table(name, (*_which(data, len(over)), *tiled((over,), len(data.functions)), *columns), title)


def _which(data: LoadingData, rows: int) -> tuple[Column, ...]:
    """Slope, exponent and peak of each function, so many times."""
    ramps = [one.ramp for one in data.functions]
    exponents = column_of(ramps[0], "exponent", [one.exponent or 0 for one in ramps])
    return repeated((column_over(ramps, "slope"), exponents, column_over(data.functions, "peak")), rows)


def _own_table(name: str, data: LoadingData) -> tuple[Table, ...]:
    """Every function's answer by the teeth of both gears at the case's speed; none without one."""
    if not data.teeth:
        return ()
    responses = [response for own in data.teeth for response in own.response]
    gear, order = (column_over(data.teeth, key) for key in ("member", "order"))
    each = len(data.functions)
    columns = (
        *repeated((gear,), each), *tiled(_which(data, 1), len(data.teeth)), *repeated((order,), each),
        *(column_of(responses[0], key, [getattr(r, key)[0] for r in responses]) for key in ("residual", "largest")),
    )  # fmt: skip
    return (Table(name, columns, "Response of single teeth at the speed of the case"),)


def _trade_off_table(name: str, data: LoadingData, asked: LoadingInputs, unit: str) -> Table:
    found, inverse = data.trade_off, f"1/{unit}" if unit else ""
    start = "slope of load / design load at initiation" + ("" if unit else ", per base pitch")
    above = asked.part.content_above
    return Table(
        name,
        (
            *_which(data, 1),
            Column("initial_slope", found.initial_slope, inverse, start),
            Column("length_per_load", found.length_per_load, unit,
                   "change of the loaded length for a relative load change of 1"
                   + ("" if unit else ", in base pitches")),
            Column("high_frequency_content", found.high_frequency_content, "",
                   f"root mean square of the spectrum from order {above:g} to {10.0 * above:g}"),
        ),
        "Trade-off of the slope at initial contact",
    )  # fmt: skip


def _figures(data: LoadingData, asked: LoadingInputs) -> tuple[Figure, ...]:
    """Every figure; a contact ratio above 2 has two ramps, whose spectra only count together."""
    end, of = (f"_{asked.name}", f" of pair {asked.name}") if asked.name else ("", "")
    drawn = few(len(data.functions))
    roles, words = ramp(len(drawn)), _labels(data.functions)
    chosen = [(i, words[i], role) for i, role in zip(drawn, roles, strict=True)]
    figures = [_families(data, chosen, end), _functions(data, asked, chosen, end, of)]
    if data.functions[0].order == 1 and data.functions[0].terms[0][2] > 0.0:
        figures.append(_factors(data, words, end))
    return (*figures, _spectra(data, chosen, end, of), _response(data, chosen, end, of))


def _labels(functions: tuple[LoadingFunction, ...]) -> list[str]:
    """What tells the functions apart; all of it where there is only one."""
    rows = [
        (f"s = {f.ramp.slope:g}", f"r = {f.ramp.exponent}" if f.ramp.exponent else "", f"F = {f.peak:.4g}")
        for f in functions
    ]
    differ = [len({row[k] for row in rows}) > 1 for k in range(3)]
    keep = [k for k in range(3) if differ[k]] or [k for k in range(3) if k < 2 or functions[0].order > 1]
    return [", ".join(row[k] for k in keep if row[k]) for row in rows]


def _families(data: LoadingData, chosen: _Chosen, end: str) -> Figure:
    x = np.linspace(-1.0, 1.0, 401)
    curves = tuple(
        Curve(x, data.functions[i].ramp.load(x), word, role, markers=False) for i, word, role in chosen
    )  # fmt: skip
    panel = Panel(
        Axis("normalised roll distance", limits=(-1.0, 1.0)), Axis("normalised load", limits=(-1.0, 1.0)), curves,
    )  # fmt: skip
    family = "polynomial" if data.functions[0].ramp.exponent else "sinusoidal"
    return Figure(
        f"loading_families{end}", f"Normalised tooth loading, {family} family",
        "Load transfer between two pairs: from none (-1) to all (1), slope s at both ends; s = 1: linear.",
        (panel,),
    )  # fmt: skip


def _functions(data: LoadingData, asked: LoadingInputs, chosen: _Chosen, end: str, of: str) -> Figure:
    scale, pitch, first = (1e3 if asked.name else 1.0), asked.base_pitch, data.functions[0]
    x = Axis("roll distance", "mm") if asked.name else Axis("roll distance from the middle of contact", "base pitches")
    y = Axis("load of a tooth pair", "N", zero=True) if asked.name else Axis("load / design load", zero=True)
    items = []
    for i, word, role in chosen:
        items.append(Curve(data.x * scale, data.load[i] * asked.load, word, role, width=2.4, markers=False))
    for side in (-1, 1):
        at = (data.x + side * pitch) * scale
        near = np.abs(data.x + side * pitch - first.centre) <= 0.5 * (first.length + pitch)
        load = np.where(near, data.load[chosen[0][0]] * asked.load, np.nan)
        items.append(Curve(at, load, "adjacent pairs", "grey", dash="dash", width=1.2, markers=False))
    marks = (Mark("x", first.x_start * scale, "initiation"), Mark("x", first.x_end * scale, "end"))
    return Figure(
        f"loading_functions{end}", f"Tooth loading functions{of}",
        f"Load of one tooth pair over its path, contact ratio {asked.length / pitch:.4g}; dashed: adjacent pairs "
        f"with the loading {chosen[0][1]}. The total load is constant.",
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
                Curve(q, slope / (np.pi * q), "envelope", "grey", dash="dot", width=1.3, markers=False),
            ]
        curves.append(Curve(q, np.abs(data.factor[i]), "spectrum factor", "blue", width=1.4, markers=False))
        panels.append(Panel(
            axis_of(data, "q", log=True, limits=(float(q[0]), float(q[-1]))),
            axis_of(data, "factor", log=True, limits=(1e-4, 3.0)), tuple(curves), title=words[i],
        ))  # fmt: skip
    return Figure(
        f"loading_spectrum_factors{end}", "Spectrum factors of the tooth loading functions",
        "Ramp factor of the load spectrum (braces of Mark 4.15b and 4.16) over frequency in cycles per ramp length. "
        "At high frequency it depends on the slope s at initiation only.",
        tuple(panels), columns=2 if len(panels) > 1 else 1,
    )  # fmt: skip


def _spectra(data: LoadingData, chosen: _Chosen, end: str, of: str) -> Figure:
    curves = []
    for i, word, role in chosen:
        curves.append(Curve(data.order, data.spectrum[i], word, role, markers=False, width=1.4))
        if np.any(data.envelope[i] > 0.0):
            inside = data.envelope[i] <= data.spectrum[i].max()
            curves.append(Curve(
                data.order[inside], data.envelope[i][inside], "", role, dash="dash", width=1.1, markers=False
            ))  # fmt: skip
    top = 2.0 * float(max(data.spectrum[i].max() for i, _, _ in chosen))
    return Figure(
        f"loading_spectra{end}", f"Spectra of the tooth loading functions{of}",
        "Spectrum of the load of one tooth pair over frequency, in units of design load times base pitch; dashed: "
        "the envelope of its high-frequency asymptote (Mark 4.22). Zero at integer orders (constant total load).",
        (Panel(
            axis_of(data, "order", log=True),
            axis_of(data, "spectrum", log=True, limits=(_LEAST * top, top)), tuple(curves),
        ),),
    )  # fmt: skip


def _response(data: LoadingData, chosen: _Chosen, end: str, of: str) -> Figure:
    left, largest = (
        tuple(
            Curve(data.order, getattr(data.response[i], key), word, role, markers=False, width=1.4)
            for i, word, role in chosen
        )
        for key in ("residual", "largest")
    )
    order, answer = axis_of(OwnVibration, "order", log=True), data.response[0]
    marks = tuple(Mark("x", own.order, own.member) for own in data.teeth)
    return Figure(
        f"loading_tooth_response{end}", f"Vibration of a single tooth{of}",
        "Single tooth as an undamped oscillator under the load of one engagement: residual vibration after contact "
        "and maximum deflection during contact, both relative to the static deflection under the design load.",
        (
            Panel(order, axis_of(answer, "residual", log=True, limits=(1e-4, 4.0)), left, marks),
            Panel(order, axis_of(answer, "largest", zero=True), largest, marks),
        ),
    )  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Each function with its spectra."""
    part = scene.case.loading
    lists = (part.slopes, part.exponents, part.peaks) if part else ()
    count = math.prod(len(values) for values in lists if values)
    return Forecast({"functions": count}, 0.02 + 0.06 * count)


LOADING_SPECTRUM = Stage(
    subjects=_subjects,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(Citation("mark", "families of tooth loading functions and their spectra", "Eqs. 4.8 to 4.22")),
    forecast=_forecast,
)
