"""Tables and values of the result ``rating``.

Service life, damage and transmittable power of a rated pair, for the values of the result ``rating``.

Stresses and safeties of a pair by every method of the result ``rating``, side by side for table and picture.

Figures of the result ``rating``: safeties by every method, and S-N lines with the points of operation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.units import from_si
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve, Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.formulas.symbols import AGMA_2101, ISO_6336
from fegear.geometry.pair import MEMBERS, Member

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from fegear.case.built.rated_pair import PairToRate
    from fegear.formulas.agma.agma2101 import AgmaRating
    from fegear.formulas.iso6336.conditions import Factor
    from fegear.formulas.iso6336.life import Knots
    from fegear.formulas.iso6336.part6_spectrum import Bin, ServiceLife
    from fegear.formulas.iso6336.rated import Both
    from fegear.formulas.iso6336.safety import SpectrumRating
    from fegear.results.rating.rating_data import RatingData


#: What the formulas remark where a value of the case stands in.
_STANDS_IN = "FE value instead of the formula"


def _column(symbol: str, member: Member, si: Sequence[float], ending: str = "", said: str = "") -> Column:
    """A symbol of ISO 6336 over levels or methods, of one gear."""
    how = ISO_6336[symbol]
    said = said or f"{how.meaning}, {member} gear"
    return Column(f"{symbol}_{member}{ending}", np.array(si), how.unit, said)


def _value(owner: str, symbol: str, si: float, said: str = "", error: float | None = None, ending: str = "") -> Value:
    """A symbol of ISO 6336 as a value, its meaning followed by what was `said` about it."""
    how = ISO_6336[symbol]
    return Value(f"{owner}.{symbol}{ending}", float(si), how.unit, error, f"{how.meaning}{said}")


def _texts(name: str, texts: Iterable[str], meaning: str) -> Column:
    return Column(name, np.array(list(texts)), "", meaning)


def _of_factors(
    factors: Sequence[Factor | None], units: Sequence[str], member: Member, i: int, ending: str, said: str
) -> Column:
    """Every factor of one gear in its unit; none where there is none."""
    numbers = [
        np.nan if one is None else one.values[i] * (from_si(unit) if unit else 1.0)
        for one, unit in zip(factors, units, strict=True)
    ]
    return Column(f"{member}{ending}", np.array(numbers), "", said)


def _factor_columns(
    rows: Sequence[Factor], places: Sequence[int], beside: Sequence[Factor | None] = ()
) -> list[Column]:
    """Symbol, numbers of both gears, unit, clause and meaning; `places` are those of driver and driven."""
    units = [one.shown.unit for one in rows]
    members = list(zip(MEMBERS, places, strict=True))
    found = [_of_factors(rows, units, member, i, "", f"of the {member} gear") for member, i in members]
    if beside:
        said = "with FE load factors and root stress"
        found += [_of_factors(beside, units, member, i, "_computed", said) for member, i in members]
    return [
        _texts("symbol", (one.symbol for one in rows), "symbol in the standard"),
        *found,
        _texts("unit", units, "unit of the values in this row"),
        _texts("clause", (one.clause for one in rows), "clause of the standard"),
        _texts("meaning", (one.shown.meaning for one in rows), "meaning"),
    ]


def factor_table(data: RatingData, asked: PairToRate) -> Table:
    """Every factor of ISO 6336 with its clause, and beside it what it is with computed values."""
    rows = data.formula.factors
    computed = {} if data.by_computed is None else {one.symbol: one for one in data.by_computed.factors}
    beside = [computed.get(one.symbol) for one in rows] if computed else []
    columns = (
        *_factor_columns(rows, [asked.of(member) for member in MEMBERS], beside),
        _texts("remark", (remark_of(one, asked) for one in rows), "note: outside a range, or specified"),
    )
    return Table(f"rating_{asked.name}", columns, f"Rating of pair {asked.name} to ISO 6336, all factors")


def remark_of(one: Factor, asked: PairToRate) -> str:
    """A factor's remark, which says of a given one that it was given."""
    given = one.symbol in asked.given or (one.symbol == "K_Falpha" and "K_Halpha" in asked.given)
    return "as specified in the case" if given and _STANDS_IN in one.remark else one.remark


def safety_table(data: RatingData, asked: PairToRate) -> Table:
    """Stresses and safeties of every method, a row each."""
    rows = methods(data, asked)
    columns = [_texts("method", (row.name for row in rows), "source of the stresses")]
    for symbol, own, error in (
        ("sigma_H", "contact", False), ("S_H", "s_h", False), ("sigma_F", "bending", False), ("S_F", "s_f", False),
        ("S_H", "s_h_error", True), ("S_F", "s_f_error", True),
    ):  # fmt: skip
        if error and data.computed is None:
            continue
        for member in MEMBERS:
            found = [getattr(row, own)[asked.of(member)] for row in rows]
            said = f"estimated relative error of {symbol}, {member} gear"
            columns.append(
                Column(f"{symbol}_error_{member}", np.array(found), "", said) if error
                else _column(symbol, member, found)
            )  # fmt: skip
    return Table(f"rating_safety_{asked.name}", tuple(columns), f"Safety factors of pair {asked.name}", printed=True)


def spectrum_table(found: SpectrumRating, asked: PairToRate, computed: SpectrumRating | None = None) -> Table:
    """Load, stresses and damage of every level; beside them what was computed at its load."""
    geometry, levels = asked.conditions.geometry, found.levels
    driver = asked.of("driver")
    torque = [level.tangential * 0.5 * geometry.diameters[driver] for level in asked.levels]
    turn = geometry.turns[driver]

    def factor(symbol: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.array([np.nan if one.rating is None else one.rating[symbol].value for one in levels])

    columns = [
        Column("level", np.arange(1, len(levels) + 1), "", "level of the spectrum"),
        Column("torque", np.array(torque), "N.m", "torque of the driver"),
        Column("speed", np.array([level.speed * turn for level in asked.levels]), "rpm", "speed of the driver"),
        Column("share", np.array([level.share for level in asked.levels]), "", "share of the life"),
        *(Column(one, factor(one), "", ISO_6336[one].meaning) for one in ("K_v", "K_Hbeta", "K_Halpha")),
    ]
    for member in MEMBERS:
        i = asked.of(member)
        columns += [
            _column("cycles", member, [one.contact[i].cycles for one in levels]),
            _column("sigma_H", member, [one.contact[i].stress for one in levels]),
            _column("damage_H", member, [one.contact[i].damage() for one in levels]),
            _column("sigma_F", member, [one.bending[i].stress for one in levels]),
            _column("damage_F", member, [one.bending[i].damage() for one in levels]),
        ]  # fmt: skip
    for head, unit, meaning, of in _computed_levels(computed, asked):
        columns.append(Column(head, of, unit, meaning))
    title = f"Load spectrum of pair {asked.name}: stress and damage of every level"
    return Table(f"rating_spectrum_{asked.name}", tuple(columns), title)


def _computed_levels(
    found: SpectrumRating | None, asked: PairToRate
) -> Iterator[tuple[str, str, str, np.ndarray[tuple[int], np.dtype[np.float64]]]]:
    """Column head, unit, meaning and numbers of what was computed at the loads of the levels."""
    if found is None:
        return
    wide = asked.width != "plane"
    for one in ("K_Hbeta", "K_Halpha") if wide else ():
        values = [math.nan if level.rating is None else level.rating[one].value for level in found.levels]
        yield f"{one}_computed", "", f"{ISO_6336[one].meaning}, FE at the load of the level", np.array(values)
    for member in MEMBERS:
        i = asked.of(member)
        if wide:
            contact = np.array([level.contact[i].stress for level in found.levels])
            yield f"sigma_H_{member}_computed", "MPa", "contact stress, FE load distribution", contact
        bending = np.array([level.bending[i].stress for level in found.levels])
        yield f"sigma_F_{member}_computed", "MPa", "FE root stress", bending


def rating_values(data: RatingData, asked: PairToRate) -> tuple[Value, ...]:
    """Safeties, and the load factors that differ between the methods."""
    found: list[Value] = []
    edition, name = asked.conditions.edition, asked.name
    for member in MEMBERS:
        i = asked.of(member)
        key = f"{name}.{member}"
        found += [
            _value(key, "S_H", data.formula.contact_safety[i], f", ISO 6336:{edition}"),
            _value(key, "S_F", data.formula.bending_safety[i], f", ISO 6336:{edition}"),
            _value(key, "sigma_H", data.formula.contact_stress[i], ", ISO 6336"),
            _value(key, "sigma_F", data.formula.bending_stress[i], ", ISO 6336"),
        ]
        if data.by_computed is not None and data.computed is not None:
            s_h, s_f = data.by_computed.contact_safety[i], data.by_computed.bending_safety[i]
            if data.computed.replacement.K_Hbeta is not None:
                error, said = s_h * data.computed.contact_error, " with FE load distribution"
                found.append(_value(key, "S_H", s_h, said, error, "_computed"))
            error, said = s_f * data.computed.bending_error[i], " with FE root stress"
            found.append(_value(key, "S_F", s_f, said, error, "_computed"))
        if data.agma is not None:
            j = data.agma.members.index(member)
            for symbol, safety in (("S_H", data.agma.S_H[j]), ("S_F", data.agma.S_F[j])):
                found.append(
                    Value(f"{key}.{symbol}_agma", safety, "", None, f"{AGMA_2101[symbol].meaning}, AGMA 2101-D04")
                )
        if data.spectrum is not None:
            found += _of_spectrum(data, data.spectrum, asked, member)
        if data.spectrum_computed is not None:
            flanks, roots = data.spectrum_computed.contact_safety[i], data.spectrum_computed.bending_safety[i]
            if asked.width != "plane":
                said = " with load spectrum, FE load distribution of all levels"
                found.append(_value(key, "S_H", flanks, said, ending="_spectrum_computed"))
            said = " with load spectrum, FE root stress"
            found.append(_value(key, "S_F", roots, said, ending="_spectrum_computed"))
    for symbol in ("K_v", "K_Hbeta", "K_Halpha"):
        found.append(_value(name, symbol, data.formula[symbol].value, ", ISO 6336", ending="_rated"))
    if data.computed is not None and data.computed.replacement.K_Hbeta is not None:
        for symbol in ("K_Hbeta", "K_Halpha"):
            value, said = getattr(data.computed.replacement, symbol), ", FE at the load with K_A, K_gamma and K_v"
            found.append(_value(name, symbol, value, said, ending="_computed"))
        found.append(
            Value(f"{name}.largest_pressure_computed", data.computed.pressure, "MPa", None,
                  "FE flank contact at the load with K_A, K_gamma and K_v, excluding tip and form circles")
        )  # fmt: skip
    return (*found, *life_values(data, asked))


def agma_table(found: AgmaRating, asked: PairToRate) -> Table:
    """Every factor of ANSI/AGMA 2101-D04 with its clause."""
    columns = tuple(_factor_columns(found.factors, [found.members.index(member) for member in MEMBERS]))
    title = f"Rating of pair {asked.name} to ANSI/AGMA 2101-D04, all factors"
    return Table(f"rating_agma_{asked.name}", columns, title)


def _of_spectrum(data: RatingData, spectrum: SpectrumRating, asked: PairToRate, member: Member) -> list[Value]:
    """Safeties, damage and equivalent torque of one gear under the spectrum."""
    from fegear.formulas.iso6336.part6_spectrum import equivalent_torque, wohler_exponent

    i, key = asked.of(member), f"{asked.name}.{member}"
    radius = 0.5 * asked.conditions.geometry.diameters[asked.of("driver")]
    torque = np.array([level.tangential * radius for level in asked.levels])
    cycles = np.array([level.cycles[i] for level in asked.levels])
    flank, root = data.curves.contact[i], data.curves.bending[i]
    of_flank = equivalent_torque(torque, cycles, 0.5 * wohler_exponent(flank), flank.cycles[-2])
    of_root = equivalent_torque(torque, cycles, wohler_exponent(root), root.cycles[-2])
    found = [
        _value(key, "S_H", spectrum.contact_safety[i], " under the load spectrum", ending="_spectrum"),
        _value(key, "S_F", spectrum.bending_safety[i], " under the load spectrum", ending="_spectrum"),
        _value(key, "damage_H", spectrum.contact_damage[i]),
        _value(key, "damage_F", spectrum.bending_damage[i]),
        _value(key, "equivalent_torque_H", of_flank, f", over {flank.cycles[-2]:g} load cycles"),
        _value(key, "equivalent_torque_F", of_root, f", over {root.cycles[-2]:g} load cycles"),
    ]
    return [value for value in found if math.isfinite(value.si)]


def power_of(asked: PairToRate) -> float:
    """Nominal power of the pair [W]."""
    duty = asked.conditions.duty
    return duty.tangential * asked.conditions.geometry.pitch_line_velocity(duty.speed)


def transmittable_power(data: RatingData, asked: PairToRate) -> Both:
    """Power [W] at which flanks and roots of the weaker gear reach their required safeties, load factors unchanged."""
    found = data.formula if data.spectrum is None else data.spectrum
    of_flank, of_root = asked.conditions.required
    power = power_of(asked)
    return power * (min(found.contact_safety) / of_flank) ** 2, power * min(found.bending_safety) / of_root


def service_life(data: RatingData, asked: PairToRate, member: Member) -> ServiceLife:
    """Life of flank and root at the required safeties [s]; inf where nothing does damage, NaN where it is not known."""
    from fegear.formulas.iso6336.part6_spectrum import ServiceLife, damage

    i, required = asked.of(member), asked.conditions.required
    if data.spectrum is not None:
        life = math.nan if asked.life is None else asked.life
        sums = (
            damage([level.contact[i] for level in data.spectrum.levels], required[0]),
            damage([level.bending[i] for level in data.spectrum.levels], required[1]),
        )
        return ServiceLife(*(life / total if total > 0.0 else math.inf for total in sums))
    rate = _cycles_per_second(asked, i)
    return ServiceLife(*(
        _borne(curve, stress * least) / rate
        for curve, stress, least in zip(
            (data.curves.contact[i], data.curves.bending[i]),
            (data.formula.contact_stress[i], data.formula.bending_stress[i]), required, strict=True,
        )
    ))  # fmt: skip


def nominal_damage(data: RatingData, asked: PairToRate, member: Member) -> Both:
    """n/N of flank and root under the nominal load at a safety of 1."""
    i = asked.of(member)
    cycles = asked.conditions.duty.cycles[i]
    flank = _borne(data.curves.contact[i], data.formula.contact_stress[i])
    root = _borne(data.curves.bending[i], data.formula.bending_stress[i])
    return cycles / flank if flank else math.inf, cycles / root if root else math.inf


def life_values(data: RatingData, asked: PairToRate) -> list[Value]:
    """Transmittable power of the pair, service life and, without a spectrum, damage of both gears."""
    name, (flank, root) = asked.name, transmittable_power(data, asked)
    found = [
        _value(name, "transmittable_power", min(flank, root)),
        _value(name, "transmittable_power_H", flank),
        _value(name, "transmittable_power_F", root),
    ]
    for member in MEMBERS:
        key, life = f"{name}.{member}", service_life(data, asked, member)
        found += [_value(key, "life_H", life.flank), _value(key, "life_F", life.root)]
        if data.spectrum is None:
            harm_flank, harm_root = nominal_damage(data, asked, member)
            found += [_value(key, "damage_H", harm_flank), _value(key, "damage_F", harm_root)]
    return [value for value in found if math.isfinite(value.si)]


def _cycles_per_second(asked: PairToRate, i: int) -> float:
    """Load cycles of a flank of pinion or wheel per second."""
    duty = asked.conditions.duty
    return duty.speed * asked.conditions.geometry.turns[i] / (2.0 * math.pi) * duty.meshes[i]


def _borne(curve: Knots, stress: float) -> float:
    """Load cycles that a stress is borne."""
    from fegear.formulas.iso6336.part6_spectrum import cycles_to_failure

    return cycles_to_failure(curve, stress)


_UNKNOWN = (math.nan, math.nan)


@dataclass(frozen=True, slots=True)
class Method:
    """Of pinion and wheel; stresses [Pa], errors relative; NaN where there is none.

    Parameters
    ----------
    name : str
    contact, bending, s_h, s_f, s_h_error, s_f_error : (float, float)
        sigma_H, sigma_F, S_H, S_F.
    """

    name: str
    contact: Both
    bending: Both
    s_h: Both
    s_f: Both
    s_h_error: Both = _UNKNOWN
    s_f_error: Both = _UNKNOWN


def methods(data: RatingData, asked: PairToRate) -> tuple[Method, ...]:
    """Every method that was asked for, ISO 6336 first."""
    one = data.formula
    found = [
        Method(
            f"ISO 6336:{asked.conditions.edition}", one.contact_stress, one.bending_stress, one.contact_safety,
            one.bending_safety,
        )
    ]  # fmt: skip
    if data.by_computed is not None and data.computed is not None:
        own, off = data.by_computed, data.computed
        wide = off.replacement.K_Hbeta is not None  # of a plane pair nothing of the contact is computed
        found.append(
            Method(
                "computed", own.contact_stress if wide else _UNKNOWN, own.bending_stress,
                own.contact_safety if wide else _UNKNOWN, own.bending_safety,
                (off.contact_error, off.contact_error) if wide else _UNKNOWN, off.bending_error,
            )
        )  # fmt: skip
    if data.agma is not None:
        first, second = (data.agma.members.index(member) for member in asked.conditions.geometry.members)
        contact, bending, s_h, s_f = (
            (values[first], values[second])
            for values in (data.agma.contact, data.agma.bending, data.agma.S_H, data.agma.S_F)
        )
        found.append(Method("AGMA 2101-D04", contact, bending, s_h, s_f))
    for name, under in (("ISO 6336, spectrum", data.spectrum), ("FE, spectrum", data.spectrum_computed)):
        if under is not None:
            flanks = under is data.spectrum or data.computed is None or data.computed.replacement.K_Hbeta is not None
            contact = under.contact_safety if flanks else _UNKNOWN
            found.append(Method(name, _UNKNOWN, _UNKNOWN, contact, under.bending_safety))
    return tuple(found)


#: First and last load cycles that are drawn.
_FIRST, _LAST = 1e2, 1e11


_MPA = 1e-6


#: Ends of the axis of gears, with room for the word of what is required beside the bars.
_ROOM = (-0.55, 1.85)


def rating_figures(data: RatingData, asked: PairToRate) -> tuple[Figure, ...]:
    """Both figures of a pair."""
    return _safeties(data, asked), _sn_lines(data, asked)


def _safeties(data: RatingData, asked: PairToRate) -> Figure:
    names = tuple(f"{gear} ({member})" for gear, member in zip(asked.gears, MEMBERS, strict=True))
    order = [asked.of(member) for member in MEMBERS]
    required, panels = asked.conditions.required, []
    for contact, label, least in ((True, "S_H, pitting", required[0]), (False, "S_F, root", required[1])):
        items = []
        for number, method in enumerate(methods(data, asked)):
            if np.isnan((method.s_h if contact else method.s_f)[0]):
                continue
            safety, off = (method.s_h, method.s_h_error) if contact else (method.s_f, method.s_f_error)
            height, error = np.array([safety[i] for i in order]), np.array([off[i] for i in order])
            known = bool(np.isfinite(error).all())
            items.append(
                Bars(np.arange(2.0), height, method.name, f"series:{number}", error * height if known else None)
            )
        mark = Mark("y", least, f"minimum {least:g}")
        panels.append(Panel(Axis(categories=names, limits=_ROOM), Axis(label, zero=True), tuple(items), (mark,)))
    caption = (
        f"Safety factors of pair {asked.name} against pitting and tooth breakage by every method; dotted: required "
        "safety."
    )
    return Figure(f"rating_{asked.name}", f"Safety factors of pair {asked.name}", caption, tuple(panels))


def _line(curve: Knots) -> tuple[list[float], list[float]]:
    """Load cycles and stress [MPa] of an S-N line, drawn beyond its ends."""
    cycles = [_FIRST, *curve.cycles, _LAST]
    return cycles, [curve.at(one) * _MPA for one in cycles]


def _sn_lines(data: RatingData, asked: PairToRate) -> Figure:
    panels = []
    for contact, label in ((True, "contact stress"), (False, "root stress")):
        items: list[Curve | Points] = []
        marks: list[Points] = []
        for number, (member, gear) in enumerate(zip(MEMBERS, asked.gears, strict=True)):
            i = asked.of(member)
            curve = (data.curves.contact if contact else data.curves.bending)[i]
            stress = (data.formula.contact_stress if contact else data.formula.bending_stress)[i]
            items.append(Curve(*_line(curve), f"{gear} ({member}), limit stress", f"series:{number}", markers=False))
            cycles = asked.conditions.duty.cycles[i]
            if data.spectrum is None:
                shown = [(cycles, stress)]
            else:
                some = [(level.contact if contact else level.bending)[i] for level in data.spectrum.levels]
                shown = [(one.cycles, one.stress) for one in some if _drawn(one)]
            x, y = (np.array(values) for values in zip(*shown, strict=True))
            what = "load" if data.spectrum is None else "spectrum"
            marks.append(Points(x, y * _MPA, f"{gear} ({member}), {what}", f"series:{number}", size=8.0))
            if data.by_computed is not None and data.spectrum is None and (not contact or _computed_flanks(data)):
                own = (data.by_computed.contact_stress if contact else data.by_computed.bending_stress)[i]
                marks.append(
                    Points([cycles], [own * _MPA], f"{gear} ({member}), FE", f"series:{number}", "diamond", 8.0)
                )
        panels.append(Panel(Axis("load cycles", log=True), Axis(label, "MPa", log=True), (*items, *marks)))
    caption = (
        f"S-N curves (limit stresses) of flanks and roots of pair {asked.name}, ISO 6336-2 and -3, and operating "
        "points."
    )
    return Figure(f"rating_sn_{asked.name}", f"S-N curves of pair {asked.name}", caption, tuple(panels))


def _computed_flanks(data: RatingData) -> bool:
    return data.computed is not None and data.computed.replacement.K_Hbeta is not None


def _drawn(one: Bin) -> bool:
    return one.stress > 0.0 and one.cycles > 0.0
