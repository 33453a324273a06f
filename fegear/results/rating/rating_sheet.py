"""What the result ``rating`` shows: every factor, safeties by every method, load spectrum, life and S-N curves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shown_as
from fegear.base.units import from_si
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.formulas.symbols import ISO_6336
from fegear.geometry.pair import MEMBER_WORDS, MEMBERS, Member
from fegear.results.rating.face_load_factors import FaceLoadFactor, face_load_factors
from fegear.results.rating.rated_life import nominal_damage, service_life, transmittable_power
from fegear.results.rating.rated_methods import ByMethod, computed_flanks, methods
from fegear.results.rating.rating_answer import RATING_ANSWER
from fegear.results.rating.rating_remarks import rating_remarks, remark_of, shortfalls

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.case.built.rated_pair import PairToRate
    from fegear.engine.sheet.seen import Seen, Where
    from fegear.formulas.iso6336.conditions import Factor, PairRating
    from fegear.formulas.iso6336.life import Knots
    from fegear.formulas.iso6336.part6_spectrum import Bin
    from fegear.results.rating.rating_data import RatingData, RatingInputs

_NONE = (math.nan, math.nan)
_FACTORS = ("K_v", "K_Hbeta", "K_Halpha")
#: First and last load cycles that are drawn.
_FIRST, _LAST = 1e2, 1e11
#: Ends of the axis of gears, with room for the word of what is required beside the bars.
_ROOM = (-0.55, 1.85)


@dataclass(frozen=True)
class FactorRow:
    """A factor of a standard in its unit; None where there is no such column."""

    symbol: str = shown("", "symbol in the standard", table="factors")
    driver: float = shown("", "of the driver", table="factors")
    driven: float = shown("", "of the driven gear", table="factors")
    driver_computed: float | None = shown("", "with FE load factors and root stress", table="factors")
    driven_computed: float | None = shown("", "with FE load factors and root stress", table="factors")
    unit: str = shown("", "unit of the values in this row", table="factors")
    clause: str = shown("", "clause of the standard", table="factors")
    meaning: str = shown("", "meaning", table="factors")
    remark: str | None = shown("", "note: outside a range, or specified", table="factors")


def _factor_row(
    one: Factor, places: Sequence[int], beside: Sequence[float | None] = (None, None), remark: str | None = None
) -> FactorRow:
    """`places` are those of driver and driven among the values."""
    scale = from_si(one.shown.unit) if one.shown.unit else 1.0
    driver, driven = (one.values[i] * scale for i in places)
    computed, other = (None if value is None else value * scale for value in beside)
    shown = one.shown
    return FactorRow(one.symbol, driver, driven, computed, other, shown.unit, one.clause, shown.meaning, remark)


def _factors(seen: Seen) -> list[FactorRow]:
    """Every factor of ISO 6336, and what it is with computed values."""
    data, asked = seen.data.found, seen.asked.asked
    places = [asked.of(member) for member in MEMBERS]
    computed = {} if data.by_computed is None else {one.symbol: one.values for one in data.by_computed.factors}

    def beside(symbol: str) -> list[float | None]:
        return [computed.get(symbol, _NONE)[i] if computed else None for i in places]

    return [_factor_row(one, places, beside(one.symbol), remark_of(one, asked)) for one in data.formula.factors]


def _agma_factors(seen: Seen) -> list[FactorRow] | None:
    found = seen.data.found.agma
    places = [] if found is None else [found.members.index(member) for member in MEMBERS]
    return None if found is None else [_factor_row(one, places) for one in found.factors]


@dataclass(frozen=True)
class LoadFactors:
    """Of a pair or of one level of a spectrum; None where there are none."""

    K_v: float | None = shown_as(ISO_6336["K_v"], default=None)
    K_Hbeta: float | None = shown_as(ISO_6336["K_Hbeta"], default=None)
    K_Halpha: float | None = shown_as(ISO_6336["K_Halpha"], default=None)


def _load_factors(rating: PairRating | None) -> LoadFactors:
    return LoadFactors(*(math.nan if rating is None else rating[symbol].value for symbol in _FACTORS))


@dataclass(frozen=True)
class Level:
    """One level of a spectrum."""

    factors: LoadFactors
    computed: LoadFactors
    level: int = shown("", "level of the spectrum", table="level")
    torque: float = shown("N.m", "torque of the driver", table="level")
    speed: float = shown("rpm", "speed of the driver", table="level")
    share: float = shown("", "share of the life", table="level")


@dataclass(frozen=True)
class LevelOfGear:
    """Load cycles, stresses and damage of one gear in one level; None where nothing is computed."""

    cycles: float = shown_as(ISO_6336["cycles"])
    contact_stress: float = shown_as(ISO_6336["sigma_H"])
    contact_damage: float = shown_as(ISO_6336["damage_H"])
    bending_stress: float = shown_as(ISO_6336["sigma_F"])
    bending_damage: float = shown_as(ISO_6336["damage_F"])
    contact_computed: float | None = shown("MPa", "contact stress, FE load distribution", name="sigma_H")
    bending_computed: float | None = shown("MPa", "FE root stress", name="sigma_F")


def _levels(data: RatingData, asked: PairToRate) -> list[Level]:
    """Of the spectrum, with what was computed at their loads."""
    if data.spectrum is None:
        return []
    geometry, driver, of = asked.conditions.geometry, asked.of("driver"), data.spectrum_computed
    return [
        Level(
            _load_factors(one.rating), LoadFactors() if of is None or asked.width == "plane"
            else replace(_load_factors(of.levels[k].rating), K_v=None), k + 1,
            asked.halves * level.tangential * 0.5 * geometry.diameters[driver],
            level.speed * geometry.turns[driver], level.share,
        )
        for k, (level, one) in enumerate(zip(asked.levels, data.spectrum.levels, strict=True))
    ]  # fmt: skip


def _levels_of_gear(data: RatingData, asked: PairToRate, i: int) -> list[LevelOfGear]:
    found = []
    for k, one in enumerate(() if data.spectrum is None else data.spectrum.levels):
        flank, root, of = one.contact[i], one.bending[i], data.spectrum_computed
        sigma_h = None if of is None or asked.width == "plane" else of.levels[k].contact[i].stress
        sigma_f = None if of is None else of.levels[k].bending[i].stress
        found.append(
            LevelOfGear(flank.cycles, flank.stress, flank.damage(), root.stress, root.damage(), sigma_h, sigma_f)
        )
    return found


@dataclass(frozen=True)
class StressOver:
    """Stresses over load cycles, shape (N,)."""

    cycles: Array = shown_as(ISO_6336["cycles"])
    stress: Array = shown("MPa", "stress")


@dataclass(frozen=True)
class Strength:
    """S-N curve of a flank or a root, and the loads that it bears; `what` they are in a word."""

    limit: StressOver
    loads: StressOver
    what: str
    computed: StressOver | None


def _strengths(data: RatingData, asked: PairToRate, i: int) -> tuple[Strength, Strength]:
    """Of flank and root of pinion or wheel."""
    cycles, own = asked.conditions.duty.cycles[i], data.by_computed

    def strength(curve: Knots, stress: float, levels: Sequence[Bin], computed: float | None) -> Strength:
        along = [_FIRST, *curve.cycles, _LAST]
        limit = StressOver(np.array(along), np.array([curve.at(one) for one in along]))
        if data.spectrum is None:
            found = None if computed is None else StressOver(np.array([cycles]), np.array([computed]))
            return Strength(limit, StressOver(np.array([cycles]), np.array([stress])), "load", found)
        loaded = [one for one in levels if one.stress > 0.0 and one.cycles > 0.0]
        loads = StressOver(np.array([one.cycles for one in loaded]), np.array([one.stress for one in loaded]))
        return Strength(limit, loads, "spectrum", None)

    levels = () if data.spectrum is None else data.spectrum.levels
    contact = own.contact_stress[i] if own is not None and computed_flanks(data) else None
    return (
        strength(data.curves.contact[i], data.formula.contact_stress[i], [one.contact[i] for one in levels], contact),
        strength(
            data.curves.bending[i], data.formula.bending_stress[i], [one.bending[i] for one in levels],
            None if own is None else own.bending_stress[i],
        ),
    )  # fmt: skip


@dataclass(frozen=True)
class RatedGear:
    """Driver or driven gear, as it is shown.

    Parameters
    ----------
    label : str
    methods : tuple of ByMethod
    levels : list of LevelOfGear
    flank, root : Strength
    """

    label: str
    methods: tuple[ByMethod, ...]
    levels: list[LevelOfGear]
    flank: Strength
    root: Strength
    contact_life: float = shown_as(ISO_6336["life_H"])
    bending_life: float = shown_as(ISO_6336["life_F"])
    contact_damage: float | None = shown_as(ISO_6336["damage_H"])
    bending_damage: float | None = shown_as(ISO_6336["damage_F"])


@dataclass(frozen=True)
class RatedPair:
    """All that is shown of a rating: what was found, and both gears by member."""

    found: RatingData
    gears: dict[Member, RatedGear]
    levels: list[Level]
    factors: LoadFactors
    computed: LoadFactors
    pressure: float | None = shown(
        "MPa", "FE flank contact at the load with K_A, K_gamma and K_v, excluding tip and form circles",
        name="largest_pressure_computed",
    )  # fmt: skip
    power: float = shown_as(ISO_6336["transmittable_power"])
    contact_power: float = shown_as(ISO_6336["transmittable_power_H"])
    bending_power: float = shown_as(ISO_6336["transmittable_power_F"])


def _shown(data: RatingData, inputs: RatingInputs) -> RatedPair:
    asked = inputs.asked
    known, (flank, root) = list(methods(data, asked)), transmittable_power(data, asked)
    gears = {}
    for place, (member, gear) in enumerate(zip(MEMBERS, asked.gears, strict=True)):
        i, life = asked.of(member), service_life(data, asked, member)
        by = tuple(
            ByMethod(one, number, member, one.name, float(place), **{key: pair[i] for key, pair in of.items()})
            for number, (one, of) in enumerate(known)
        )
        damage = nominal_damage(data, asked, member) if data.spectrum is None else (None, None)
        strengths, levels = _strengths(data, asked, i), _levels_of_gear(data, asked, i)
        gears[member] = RatedGear(f"{gear} ({member})", by, levels, *strengths, life.flank, life.root, *damage)
    computed, pressure = LoadFactors(), None
    if data.computed is not None and computed_flanks(data):
        stands, pressure = data.computed.replacement, data.computed.pressure
        computed = LoadFactors(None, stands.K_Hbeta, stands.K_Halpha)
    factors, power = _load_factors(data.formula), min(flank, root)
    return RatedPair(data, gears, _levels(data, asked), factors, computed, pressure, power, flank, root)


def _face_load_factors(seen: Seen) -> tuple[FaceLoadFactor, ...] | None:
    by_iso = seen.data.factors.K_Hbeta
    if math.isnan(by_iso):
        return None
    return face_load_factors(seen.asked.asked.conditions.alignment, by_iso, seen.data.computed.K_Hbeta)


def _of_gear(quantity: str, owner: str = "{name}.{key}", further: str = "") -> Number:
    return Number(quantity, owner=owner, further=further, finite=True)


def _safety(part: str) -> Number:
    def error(seen: Seen) -> float | None:
        one: ByMethod = seen.one
        return float(getattr(one, f"{part}_safety") * getattr(one, f"{part}_error")) if one.by.estimated else None

    return Number(
        f"{part}_safety", error, owner=_OF_MEMBER, ending="{one.by.ending}", meaning=f"{{one.by.{part}}}", finite=True
    )


def _both(quantity: str, *, each: Where = "gears") -> Cell:
    """A quantity of driver and driven gear, a row for each method."""
    return Cell(quantity, of="methods", each=each, ending="_{key}", further=lambda seen: f", {MEMBER_WORDS[seen.key]}")


def _estimated(seen: Seen) -> dict[Member, RatedGear] | None:
    return None if seen.data.found.computed is None else seen.data.gears


def _bars(part: str, label: str) -> Over:
    """Safeties of both gears beside each other by every method, and the required one."""
    safety = f"{part}_safety"

    def pairs(seen: Seen) -> list[tuple[ByMethod, ...]]:
        both = zip(*(gear.methods for gear in seen.data.gears.values()), strict=True)
        return [pair for pair in both if not math.isnan(getattr(pair[0], safety))]

    def error(seen: Seen) -> Array | None:
        height, off = (np.array([getattr(one, key) for one in seen.one]) for key in (safety, f"{part}_error"))
        return height * off if np.isfinite(off).all() else None

    def required(seen: Seen) -> tuple[Mark, ...]:
        least = dict(zip(("contact", "bending"), seen.asked.asked.conditions.required, strict=True))[part]
        return (Mark("y", least, f"minimum {least:g}"),)

    family = Family(pairs, lambda seen: seen.one[0].method, lambda seen: f"series:{seen.one[0].number}")
    return Over(
        lambda seen: Axis(categories=tuple(gear.label for gear in seen.data.gears.values()), limits=_ROOM),
        (Line(safety, error=error, x="place", each=family, kind="bars"),), Axis(label, zero=True), required,
    )  # fmt: skip


def _sn_lines(part: str, label: str) -> Over:
    """S-N curves of both flanks or roots, then the loads on them."""

    def points(of: str, what: str, symbol: str = "") -> Line:
        look = {"symbol": symbol, "size": 8.0}
        return Line("stress", f"{{one.label}}, {what}", x="cycles", of=f"{part}.{of}", kind="points", look=look)

    limit = Line("stress", "{one.label}, limit stress", x="cycles", of=f"{part}.limit", look={"markers": False})
    loads = points("loads", f"{{one.{part}.what}}"), points("computed", "FE", "diamond")
    return Over(
        Axis("load cycles", log=True), (replace(limit, each=Family("gears")), Bundle(Family("gears"), loads)),
        Axis(label, "MPa", log=True),
    )  # fmt: skip


def _remarks(seen: Seen) -> tuple[str, ...]:
    data, asked = seen.data.found, seen.asked.asked
    return *shortfalls(data, asked), *asked.assumed, *seen.asked.said, *rating_remarks(data, asked)


def _settings(seen: Seen) -> dict[str, object]:
    computed, asked = seen.data.found.computed, seen.asked.asked
    load = None if computed is None or asked.width == "plane" else computed.load
    return {"edition": asked.conditions.edition, "computed_at_load": load}


_OF_MEMBER = "{name}.{one.member}"
_AT_LEVEL, _AT_LOAD = ", FE at the load of the level", ", FE at the load with K_A, K_gamma and K_v"
RATING_SHEET = Sheet(
    answer=RATING_ANSWER,
    of=_shown,
    name=lambda inputs: inputs.asked.name,
    tables=(
        Rows("rating_{name}", "Rating of pair {name} to ISO 6336, all factors", (Every("factors"),), of=_factors),
        Rows(
            "rating_safety_{name}", "Safety factors of pair {name}",
            (
                Cell("method", of="gears.driver.methods"),
                *map(_both, ("contact_stress", "contact_safety", "bending_stress", "bending_safety")),
                _both("contact_error", each=_estimated),
                _both("bending_error", each=_estimated),
            ),
            printed=True,
        ),
        Rows(
            "face_load_factors_{name}", "Face load factors of pair {name}: effects included, and where each is used",
            ("method", "factor", "includes", "excludes", "used_for"), of=_face_load_factors,
        ),
        Rows(
            "rating_agma_{name}", "Rating of pair {name} to ANSI/AGMA 2101-D04, all factors", (Every("factors"),),
            of=_agma_factors,
        ),
        Rows(
            "rating_spectrum_{name}", "Load spectrum of pair {name}: stress and damage of every level",
            (
                Every("level"),
                *(f"factors.{one}" for one in _FACTORS),
                Each("gears", *(
                    Cell(one, of="levels", ending="_{key}", further=lambda seen: f", {MEMBER_WORDS[seen.key]}")
                    for one in ("cycles", "contact_stress", "contact_damage", "bending_stress", "bending_damage")
                )),
                *(Cell(f"computed.{one}", ending="_computed", further=_AT_LEVEL) for one in _FACTORS),
                Each("gears", *(
                    Cell(f"{one}_computed", of="levels", ending="_{key}_computed") for one in ("contact", "bending")
                )),
            ),
            of="levels", when="levels",
        ),
    ),
    values=(
        Each(
            "gears",
            Each(
                "methods",
                _safety("contact"),
                _safety("bending"),
                Each(
                    lambda seen: () if seen.one.number else (seen.one,),
                    _of_gear("contact_stress", _OF_MEMBER, ", ISO 6336"),
                    _of_gear("bending_stress", _OF_MEMBER, ", ISO 6336"),
                ),
                _of_gear("contact_damage", _OF_MEMBER),
                _of_gear("bending_damage", _OF_MEMBER),
                _of_gear("contact_torque", _OF_MEMBER, ", over {one.contact_cycles:g} load cycles"),
                _of_gear("bending_torque", _OF_MEMBER, ", over {one.bending_cycles:g} load cycles"),
            ),
        ),
        *(Number(f"factors.{one}", ending="_rated", further=", ISO 6336") for one in _FACTORS),
        *(Number(f"computed.{one}", ending="_computed", further=_AT_LOAD) for one in _FACTORS),
        "pressure",
        *(Number(one, finite=True) for one in ("power", "contact_power", "bending_power")),
        Each("gears", *map(_of_gear, ("contact_life", "bending_life", "contact_damage", "bending_damage"))),
    ),
    figures=(
        Chart(
            "rating_{name}", "Safety factors of pair {name}",
            "Safety factors of pair {name} against pitting and tooth breakage by every method; dotted: required "
            "safety.",
            (_bars("contact", "S_H, pitting"), _bars("bending", "S_F, root")),
        ),
        Chart(
            "rating_sn_{name}", "S-N curves of pair {name}",
            "S-N curves (limit stresses) of flanks and roots of pair {name}, ISO 6336-2 and -3, and operating points.",
            (_sn_lines("flank", "contact stress"), _sn_lines("root", "root stress")),
        ),
    ),
    remarks=(_remarks,),
    settings=_settings,
)  # fmt: skip
