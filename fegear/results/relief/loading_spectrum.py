"""Result ``loading-spectrum``: families of tooth loading functions and how much each excites the teeth themselves."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.case.loading import LoadingPart
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Column, Table
from fegear.geometry.pair import MEMBERS
from fegear.results.relief.drawn_loading import loading_figures

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.design.loading import LoadingFunction, SlopeTradeOff, ToothResponse
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import GearPair, Member

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

    Parameters
    ----------
    member : {"driver", "driven"}
    frequency : float
        Lowest natural frequency of a tooth [Hz].
    order : float
        The same over the tooth-mesh frequency.
    response : tuple of ToothResponse
        To each loading function, arrays of shape (1,).
    """

    member: Member
    frequency: float
    order: float
    response: tuple[ToothResponse, ...]


@dataclass(frozen=True)
class LoadingData:
    """Loading functions with their loads and spectra.

    Parameters
    ----------
    functions : tuple of LoadingFunction
        F of them.
    x : ndarray, shape (P,)
        [m].
    load : ndarray, shape (F, P)
        W / W_d.
    order : ndarray, shape (G,)
        Frequencies g A [tooth-mesh orders], positive.
    spectrum, asymptote, envelope : ndarray, shape (F, G)
        Moduli over W_d A.
    q : ndarray, shape (G,)
        Frequencies g (L - A).
    factor, factor_asymptote : ndarray, shape (F, G)
        The braces of (4.15b) and (4.16), and s sinc(q).
    trade_off : SlopeTradeOff
    response : tuple of ToothResponse
        Of a tooth to each function, over its natural frequency in `order`.
    teeth : tuple of OwnVibration
        Of both gears at the case's speed; empty without one.
    sum_misfit : float
        Largest difference of the loads of all pairs together from W_d, over W_d.
    """

    functions: tuple[LoadingFunction, ...]
    x: Array
    load: Array
    order: Array
    spectrum: Array
    asymptote: Array
    envelope: Array
    q: Array
    factor: Array
    factor_asymptote: Array
    trade_off: SlopeTradeOff
    response: tuple[ToothResponse, ...]
    teeth: tuple[OwnVibration, ...]
    sum_misfit: float


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
        raise InputError("loading.load", "(not given)", "is needed with a pair that has no load", 'write load = "1 kN"')
    gears, middle = pair if part.speed else None, 0.5 * (pair.x_start + pair.x_end)
    return LoadingInputs(part, length, pair.base_pitch, middle, load, pair.path_length, name, gears)


def loading_functions(asked: LoadingInputs) -> tuple[LoadingFunction, ...]:
    """Every combination of exponent, slope and peak."""
    from fegear.design.loading import LoadingFunction, Ramp

    part, ratio = asked.part, asked.length / asked.base_pitch
    if part.contact_ratio is not None and ratio < 1.0:
        raise RangeError(
            "loading.contact_ratio", part.contact_ratio,
            "is below 1: no pair is left to carry the load at some positions", "choose at least 1",
        )  # fmt: skip
    if ratio > _LARGEST_RATIO:
        given = "contact_ratio" if part.contact_ratio is not None else "length"
        raise RangeError(
            f"loading.{given}", f"{ratio:.6g} base pitches", "is a contact ratio that no gears have",
            f"choose at most {_LARGEST_RATIO:g}",
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
    loading_functions(_inputs(scene, name))  # refuses what no pair of teeth can carry


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
        functions, x, np.stack([f.fraction(x) for f in functions]), order, moduli("spectrum"), moduli("asymptote"),
        moduli("envelope"), q, np.stack([f.ramp.spectrum_factor(q) for f in functions]),
        np.stack([f.ramp.asymptotic_factor(q) for f in functions]),
        slope_trade_off(functions, asked.part.content_above), tuple(tooth_response(f, order) for f in functions),
        _own_vibrations(asked, functions), misfit,
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
        found.append(OwnVibration(member, frequency, order, tuple(tooth_response(f, [order]) for f in functions)))
    return tuple(found)


def _frequencies(top: float) -> Array:
    """In even steps where a spectrum has many lobes of one width, in even ratios below."""
    return np.concatenate([np.geomspace(_LOWEST, _LOBES, _BELOW, endpoint=False), np.linspace(_LOBES, top, _ABOVE)])


def _present(data: LoadingData, asked: LoadingInputs) -> Outcome:
    end, first, shares = f"_{asked.name}" if asked.name else "", data.functions[0], not asked.name
    length = "" if shares else "mm"
    tables = [
        _long(data, f"loading_families{end}", "Loading of a ramp, from -1 to 1", (
            ("x", np.linspace(-1.0, 1.0, _RAMP), "", "roll distance over half the ramp, from its middle"),
        ), (
            ("load", [f.ramp.load(np.linspace(-1.0, 1.0, _RAMP)) for f in data.functions], "",
             "twice the load over the design load, less 1"),
        )),
        _long(data, f"loading_functions{end}", "Load of one tooth pair", (
            ("x", data.x, length, "roll distance" + (" in base pitches, from the middle of contact" if shares else "")),
        ), (
            ("load", list(data.load * asked.load), "" if shares else "N", "over the design load" if shares else ""),
        )),
        _long(data, f"loading_spectrum_factors{end}", "Spectrum of the ramp: the braces of Mark's (4.15b) and (4.16)", (
            ("q", data.q, "", "cycles over the width of the ramp"),
        ), (
            ("factor", list(data.factor), "", "1 at q = 0"),
            ("asymptote", list(data.factor_asymptote), "", "s sinc(q)"),
        )),
        _long(data, f"loading_spectra{end}", "Spectrum of the load of one tooth pair", (
            ("order", data.order, "", "frequency over the tooth-mesh frequency"),
        ), (
            ("spectrum", list(data.spectrum), "", "modulus over design load times base pitch"),
            ("asymptote", list(data.asymptote), "", "what it tends to at high frequency (4.20)"),
            ("envelope", list(data.envelope), "", "largest size of that (4.22)"),
        )),
        _long(data, f"loading_tooth_response{end}", "Answer of a tooth by itself, over its deflection at rest", (
            ("order", data.order, "", "natural frequency of the tooth over the tooth-mesh frequency"),
        ), (
            ("residual", [r.residual for r in data.response], "", "0-peak, left when contact ends, without damping"),
            ("envelope", [r.envelope for r in data.response], "", "what it does not exceed at high frequency (4.22)"),
            ("largest", [r.largest for r in data.response], "", "largest deflection during contact"),
        )),
        _trade_off_table(f"loading_trade_off{end}", data, asked, length),
        *_own_table(f"loading_tooth_vibration{end}", data),
    ]  # fmt: skip
    ratio, of = asked.length / asked.base_pitch, f"{asked.name}." if asked.name else ""
    values = [
        Value(f"{of}loading_contact_ratio", ratio, "", 0.0, "length of the loaded path over the base pitch"),
        Value(f"{of}loading_sum_misfit", data.sum_misfit, "", 0.0,
              "largest difference of the loads of all pairs from the design load, over it"),
    ]  # fmt: skip
    if asked.name:
        outer = first.terms[0][2]
        values += [
            Value(f"{of}loading_base_pitch", asked.base_pitch, "mm", 0.0, "A"),
            Value(f"{of}loading_path", asked.path, "mm", 0.0, "of contact of the pair"),
            Value(f"{of}loading_length", asked.length, "mm", 0.0, "L, over which a pair is loaded"),
            Value(f"{of}loading_ramp", outer, "mm", 0.0, "over which the load rises at initiation"),
        ]
        for own in data.teeth:
            key = f"{of}tooth_frequency_{own.member}"
            given = "given" if asked.part.tooth_frequency else "lowest natural one of a tooth, a beam on its foundation"
            values.append(Value(key, own.frequency, "Hz", None, f"{given}; order {own.order:.5g} of the tooth mesh"))
    remarks = []
    if data.teeth:
        remarks.append(
            f"Pair {asked.name}: a tooth's own vibration neglects damping, its neighbours and the mate that it touches."
        )
    if any(f.ramp.slope == 0.0 for f in data.functions):
        remarks.append(
            "Loading that starts with slope zero has no asymptote of second order: its spectrum falls faster than the "
            "square of the frequency."
        )
    if any(math.isinf(f.initial_slope()) for f in data.functions):
        remarks.append(
            "The loaded path is a whole number of base pitches, so the load starts with a jump: its initial slope is "
            "infinite and its spectrum falls with the frequency only."
        )
    figures = loading_figures(data, asked)
    return Outcome(data, tuple(tables), tuple(values), {"load": asked.load}, tuple(remarks), figures)


def _long(
    data: LoadingData,
    name: str,
    title: str,
    over: tuple[tuple[str, Array, str, str], ...],
    columns: tuple[tuple[str, list[Array], str, str], ...],
) -> Table:
    """All functions below each other, each over the same abscissa."""
    ((head, at, unit, meaning),) = over
    return Table(
        name,
        (
            *_which(data, at.size),
            Column(head, np.tile(at, len(data.functions)), unit, meaning),
            *(Column(word, np.concatenate(parts), u, m) for word, parts, u, m in columns),
        ),
        title,
    )


def _which(data: LoadingData, rows: int) -> tuple[Column, ...]:
    """Slope, exponent and peak of each function, so many times."""
    f = data.functions
    return (
        Column("slope", np.repeat([one.ramp.slope for one in f], rows), "", "s at initiation"),
        Column("exponent", np.repeat([one.ramp.exponent or 0 for one in f], rows), "", "r; 0: sinusoidal family"),
        Column("peak", np.repeat([one.peak for one in f], rows), "", "F, largest load over the design load"),
    )


def _own_table(name: str, data: LoadingData) -> tuple[Table, ...]:
    """Every function's answer by the teeth of both gears at the case's speed; none without one."""
    if not data.teeth:
        return ()
    rows, count = [(own, response) for own in data.teeth for response in own.response], len(data.teeth)
    which = (Column(c.name, np.tile(c.si, count), c.unit, c.meaning) for c in _which(data, 1))
    columns = (
        Column("gear", np.array([own.member for own, _ in rows]), "", "driver or driven"),
        *which,
        Column("order", np.array([own.order for own, _ in rows]), "", "natural frequency over tooth-mesh frequency"),
        Column("residual", np.array([r.residual[0] for _, r in rows]), "", "left when contact ends, 0-peak, over the "
               "deflection under the design load"),
        Column("largest", np.array([r.largest[0] for _, r in rows]), "", "largest deflection during contact"),
    )  # fmt: skip
    return (Table(name, columns, "Answer of the teeth by themselves at the case's speed"),)


def _trade_off_table(name: str, data: LoadingData, asked: LoadingInputs, unit: str) -> Table:
    found, inverse = data.trade_off, f"1/{unit}" if unit else ""
    start = "change of the load over the design load, at initiation" + ("" if unit else ", per base pitch")
    above = asked.part.content_above
    return Table(
        name,
        (
            *_which(data, 1),
            Column("initial_slope", found.initial_slope, inverse, start),
            Column("length_per_load", found.length_per_load, unit,
                   "by how much the loaded length changes when the load grows by its own size"
                   + ("" if unit else ", in base pitches")),
            Column("high_frequency_content", found.high_frequency_content, "",
                   f"root mean square of the spectrum from order {above:g} to {10.0 * above:g}"),
        ),
        "What the slope at initiation buys and costs",
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
