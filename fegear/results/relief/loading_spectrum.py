"""Result ``loading-spectrum``: families of tooth loading functions and how much each excites the teeth themselves."""

from __future__ import annotations

import itertools
import math

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.case.loading import LoadingPart
from fegear.case.reading import Scene
from fegear.design.loading import LoadingFunction
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results.relief.loading_data import LoadingData, LoadingInputs, OwnVibration
from fegear.results.relief.loading_sheet import LOADING_SHEET

#: Positions over the path.
_PATH = 401
#: Lowest frequency of spectra, where their lobes begin, and how many frequencies lie below and above.
_LOWEST, _LOBES, _BELOW, _ABOVE = 0.1, 2.9, 199, 501
#: Highest of the ramp's own frequency q.
_HIGHEST_Q = 30.0
#: Largest contact ratio: gears have 1 to 4, and each base pitch of the path costs memory.
_LARGEST_RATIO = 100.0
#: Exponent of the polynomial family where the case names none.
_EXPONENT = 7


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
    present=LOADING_SHEET.present,
    check=_check,
    cites=citing(Citation("mark", "families of tooth loading functions and their spectra", "Eqs. 4.8 to 4.22")),
    forecast=_forecast,
)
