"""Result ``crosscheck``: every closed form compared with the finite elements, over load positions.

What the result ``crosscheck`` reads and what it finds, by the names of gears and pairs.

Tables and single values of the result ``crosscheck``: closed forms over finite elements.

Figures of closed forms compared with finite elements.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from fegear.case.built.tooth_influence import mesh_settings, seconds_of_gear
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, columns_of, error_column, tiled
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark, Zone
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.forecasts import CLOSED_FORM_COMPLIANCES, RING, ROOT_STRESS_FORMULAS
from fegear.results.gear.crosscheck_iso import (
    IsoInputs,
    iso_inputs,
    iso_table,
    load_of_stiffness,
    section_figure,
    section_table,
)
from fegear.results.gear.load_positions import chosen_gears
from fegear.results.gear.solved_gear import needs_solution, solution_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.compared.crosscheck import ComplianceAnswers, PairReference, RootStressAnswers
    from fegear.contact.compared.rated_gears import RatedPair
    from fegear.fem.plane.table import StiffnessTable
    from fegear.formulas.cornell import SectionLengths
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.formulas.outcome import Outcome as Answer
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair


#: Line load of the pairs when the case names none [N/m].
USUAL_LINE_LOAD = 100e3


#: What formulas answer, by their names.
_Answers: TypeAlias = "Mapping[str, RootStressAnswers] | Mapping[str, ComplianceAnswers]"


#: The whole case is one subject: gears and pairs share the tables of sources and the remarks.
_WHOLE = ""


_GEAR_REMARKS = (
    (
        "Crosscheck: one tooth of the whole gear is loaded normal to its flank, without friction and with no other "
        "tooth loaded; everything is per unit line load (secant, not local slope)."
    ),
    (
        "Crosscheck of root stress: FE is the largest tangential stress along the fillet below the loaded flank, "
        "radial compression included, in the whole ring with its own rim; the formulas know no rim, and whether they "
        "subtract the radial compression stands in table crosscheck_sources. Root stress per line load is the same in "
        "plane stress and plane strain."
    ),
    (
        "Crosscheck of gear compliance: tooth and body without the contact zone; from FE the exact half-plane approach "
        "down to the tooth's centre line along the line of action is taken off."
    ),
)


_PAIR_REMARK = (
    "Crosscheck of pair compliance: one tooth pair with its contact of Hertz's width, no load sharing; FE "
    "deflections are means weighted with the contact pressure."
)


def _pairs(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[stiffness]`` names, else those of the gears that are looked at."""
    chosen, gears = scene.case.stiffness.pair, chosen_gears(scene)
    return tuple(
        name
        for name in scene.spur_pairs
        if chosen in (None, name) and {scene.case.pair[name].driver, scene.case.pair[name].driven} & set(gears)
    )


def _helical(scene: Scene) -> tuple[str, ...]:
    """The pairs that ISO 6336 rates through their virtual spur teeth."""
    return tuple(name for name in scene.pairs if name not in scene.spur_pairs)


def _pair_check(scene: Scene, name: str) -> PairCheck:
    pair, part, stiffness = scene.pairs[name], scene.case.pair[name], scene.case.stiffness
    load = part.normal_load(pair)
    gears, line_load, count = (part.driver, part.driven), stiffness.load, stiffness.load_positions
    if line_load is None and load is not None:
        return PairCheck(pair, gears, count, load / pair.face_width, False, part.operation.applied_factor)
    return PairCheck(pair, gears, count, line_load or USUAL_LINE_LOAD, line_load is None)


def _check(scene: Scene, _subject: str) -> None:
    from fegear.contact.compared.crosscheck import refuse_wide_contacts

    for name in _pairs(scene):
        check = _pair_check(scene, name)
        refuse_wide_contacts(check.pair, check.line_load, f"pair.{name}.load")


def _inputs(scene: Scene, _subject: str) -> CrosscheckInputs:
    gears = {name: scene.gears[name] for name in chosen_gears(scene)}
    pairs, settings = _pairs(scene), mesh_settings(scene.case.accuracy)
    iso = {name: iso_inputs(scene, name, settings) for name in (*pairs, *_helical(scene))}
    return CrosscheckInputs(gears, {name: _pair_check(scene, name) for name in pairs}, iso)


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    mates = [gear for name in _pairs(scene) for gear in (scene.case.pair[name].driver, scene.case.pair[name].driven)]
    return (*(Task("stiffness", name) for name in chosen_gears(scene)), *needs_solution(*mates))


def _compute(asked: CrosscheckInputs, upstream: Upstream, work: Work) -> CrosscheckData:
    from fegear.contact.compared.crosscheck import (
        contact_zone,
        pair_compliance_answers,
        pair_reference,
        root_stress_answers,
        tooth_compliance_answers,
    )
    from fegear.contact.compared.rated_gears import rated_helical_pair, rated_spur_pair
    from fegear.formulas.cornell import radial_section_lengths
    from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
    from fegear.formulas.outcome import attempt

    gears, pairs, count = {}, {}, len(asked.gears) + len(asked.pairs)
    rated: dict[str, RatedPair] = {}
    for name, gear in asked.gears.items():
        fe: StiffnessTable = upstream[Task("stiffness", name)]
        gears[name] = GearAnswers(
            fe, root_stress_answers(gear.external_tooth, fe.radius / gear.module),
            tooth_compliance_answers(gear, fe.radius),
            contact_zone(gear, fe.radius, fe.half_width),
            attempt(partial(radial_section_lengths, gear.external_tooth, fe.radius / gear.module)),
        )  # fmt: skip
        work.progress(len(gears) / count)
    for name, check in asked.pairs.items():
        pair, w = check.pair, check.line_load
        x = np.linspace(pair.x_start, pair.x_end, check.positions)
        driver, driven = (solution_of(upstream, gear) for gear in check.gears)
        fe_pair = pair_reference(pair, driver, driven, x, w)
        iso = attempt(partial(pair_stiffness, pair, specific_load=check.applied_load))
        pairs[name] = PairAnswers(fe_pair, pair_compliance_answers(pair, fe_pair.x, w), iso)
        iso_asked = asked.iso[name]
        rated[name] = rated_spur_pair(pair, (driver, driven), w, iso_asked.choice, iso_asked.rims)
        work.progress((len(gears) + len(pairs)) / count)
    for name, wanted in asked.iso.items():
        if wanted.helical is not None and wanted.settings is not None:
            rated[name] = rated_helical_pair(wanted.helical, wanted.choice, wanted.rims, wanted.settings, work.cache)
    return CrosscheckData(gears, pairs, rated)


def _present(data: CrosscheckData, asked: CrosscheckInputs) -> Outcome:
    # A case of helical pairs alone compares no spur gear of its own: its remarks come with each pair.
    tables, values = [sources_table()], []
    remarks = [*(_GEAR_REMARKS if asked.gears else ()), *((_PAIR_REMARK,) if asked.pairs else ())]
    for name, gear in asked.gears.items():
        answers = data.gears[name]
        found = (
            root_stress_table(name, gear, answers.table, answers.root_stress),
            gear_compliance_table(name, gear, answers),
        )
        tables += [table for table, _ in found]
        values += [value for _, some in found for value in some]
    for name, check in asked.pairs.items():
        if check.chosen:
            load = f"{check.line_load * 1e-3:.6g} N/mm"
            remarks.append(f"Pair {name}: no load was given; its contact is that of {load}.")
        table, some, remark = pair_table(name, check, data.pairs[name])
        remarks += [remark] if remark else []
        tables.append(table)
        values += some
    for name, wanted in asked.iso.items():
        table, some, more = iso_table(name, wanted, data.iso[name])
        remarks += more
        tables.append(table)
        values += some
    for table in tables[1:]:
        head = table.columns[0].name
        silent = {str(f): str(r) for f, r in zip(table[head], table["reason"], strict=True) if r}
        remarks += [f"{table.title}: {f} is out of its range at some positions: {r}" for f, r in silent.items()]
    figures = [crosscheck_figure(table) for table in tables[1:] if "formula" in table.columns[0].name]
    for name, gear in asked.gears.items():
        answers = data.gears[name]
        if answers.cornell.value is not None:
            table, some = section_table(name, gear, answers.table.radius, answers.cornell.value)
            tables.append(table)
            values += some
            figures.append(section_figure(name, gear, answers.table, answers.cornell.value))
    return Outcome(data, tuple(tables), tuple(values), {}, tuple(remarks), tuple(figures))


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """Every closed form for every gear and pair; helical pairs solve two virtual spur gears for each of theirs."""
    virtual = 4 * len(_helical(scene)) * seconds_of_gear(mesh_settings(scene.case.accuracy))
    return forecasts.constant(0.05 + 0.08 * (len(scene.spur_gears) + len(scene.spur_pairs)) + virtual)


@dataclass(frozen=True, slots=True)
class PairCheck:
    """One pair whose compliance is compared.

    Parameters
    ----------
    pair : GearPair
    gears : tuple of str
        Names of driver and driven.
    positions : int
        Over the path of contact.
    line_load : float
        w = F_bt / b, along the line of action [N/m].
    chosen : bool
        Whether the line load had to be chosen.
    load_factor : float
        K_A K_gamma of the case's own load, which c' of ISO 6336-1 takes.
    """

    pair: GearPair
    gears: tuple[str, str]
    positions: int
    line_load: float
    chosen: bool
    load_factor: float = 1.0

    @property
    def applied_load(self) -> float:
        """F_t K_A K_gamma / b of ISO 6336-1 [N/m]."""
        return self.load_factor * self.pair.tangential_load(self.line_load)


@dataclass(frozen=True, slots=True)
class CrosscheckInputs:
    """Gears and pairs that are compared, and spur and helical pairs that ISO 6336 rates, by name."""

    gears: Mapping[str, Gear]
    pairs: Mapping[str, PairCheck]
    iso: Mapping[str, IsoInputs]


@dataclass(frozen=True, slots=True)
class GearAnswers:
    """Closed forms of a gear compared with its finite elements, and Cornell's root section or why it has none."""

    table: StiffnessTable
    root_stress: Mapping[str, RootStressAnswers]
    compliance: Mapping[str, ComplianceAnswers]
    contact_zone: Array
    cornell: Answer[SectionLengths]


@dataclass(frozen=True, slots=True)
class PairAnswers:
    """Closed forms of a pair compared with its finite elements; ISO's stiffness or the reason why there is none."""

    reference: PairReference
    compliance: Mapping[str, ComplianceAnswers]
    iso: Answer[Stiffness]


@dataclass(frozen=True, slots=True)
class CrosscheckData:
    """Everything that is compared, by the names of gears and pairs."""

    gears: Mapping[str, GearAnswers]
    pairs: Mapping[str, PairAnswers]
    iso: Mapping[str, RatedPair]


def root_stress_table(
    name: str, gear: Gear, fe: StiffnessTable, answers: Mapping[str, RootStressAnswers]
) -> tuple[Table, tuple[Value, ...]]:
    """Every root-stress formula over the finite elements of one gear."""
    count, m = fe.radius.size, gear.module
    times = len(answers)

    def joined(attribute: str, scale: float) -> Array:
        return np.concatenate([getattr(a, attribute) for a in answers.values()]) * scale

    stress = joined("stress", 1.0 / m)
    ratio = stress / np.tile(fe.root_tension, times)
    of_fe = column_of(
        fe, "root_tension", name="root_tension_fe", meaning="largest tangential stress of the fillet by FE"
    )
    columns = (
        _formulas(answers, count),
        *tiled(columns_of(fe, "radius", "roll_angle"), times),
        column_of(fe, "root_tension", stress, meaning="by the formula, per line load normal to the flank"),
        *tiled((of_fe, error_column(of_fe, fe.errors["root_tension"], "estimated error of FE")), times),
        Column("ratio_to_fe", ratio, "", "formula over FE"),
        column_of(
            fe, "root_tension_radius", joined("radius", m), name="place_radius", meaning="where the formula puts it"
        ),
        *tiled((column_of(fe, "root_tension_radius", name="place_radius_fe", meaning="where FE puts it"),), times),
        column_of(fe, "root_tension_angle", joined("tangent_angle", 1.0), name="place_angle"),
        *tiled((column_of(fe, "root_tension_angle", name="place_angle_fe", meaning="the same by FE"),), times),
        _reasons(answers),
    )
    title = f"Root stress of gear {name}: closed forms over finite elements"
    values = _extremes(f"{name}.root_stress", ratio.reshape(times, count), tuple(answers))
    return Table(f"crosscheck_root_stress_{name}", columns, title), values


def _formulas(answers: _Answers, count: int) -> Column:
    return Column("formula", np.repeat(list(answers), count), "", "name of the formula, see crosscheck_sources")


def _reasons(answers: _Answers) -> Column:
    words = np.array([reason for a in answers.values() for reason in a.reasons], dtype=np.str_)
    return column_of(next(iter(answers.values())), "reasons", words)


def _extremes(prefix: str, ratio: Array, names: tuple[str, ...]) -> tuple[Value, ...]:
    """Smallest and largest ratio and the largest deviation of every formula that gives anything."""
    found = []
    for name, row in zip(names, ratio, strict=True):
        r = row[np.isfinite(row)]
        if r.size:
            key = f"{prefix}.{name}"
            found += [
                Value(f"{key}.lowest_ratio", float(r.min()), "", None, f"{name} over FE, smallest over the positions"),
                Value(f"{key}.highest_ratio", float(r.max()), "", None, f"{name} over FE, largest over the positions"),
                Value(
                    f"{key}.largest_deviation", float(np.abs(r - 1.0).max()), "", None, f"{name} against FE, relative"
                ),
            ]
    return tuple(found)


def _compliance_table(
    name: str,
    what: str,
    first: tuple[Column, ...],
    reference: tuple[Column, ...],
    answers: Mapping[str, ComplianceAnswers],
    parts: tuple[str, ...],
) -> tuple[Table, tuple[Value, ...]]:
    times, count = len(answers), len(first[0].si)
    total = np.concatenate([a.total for a in answers.values()])
    ratio = total / np.tile(reference[0].si, times)
    split = [
        np.concatenate([a.parts[i] if len(a.parts) > i else a.parts[0] for a in answers.values()])
        for i in range(len(parts))
    ]
    some = next(iter(answers.values()))
    columns = (
        _formulas(answers, count),
        *tiled(first, times),
        column_of(some, "total", total),
        *tiled(reference, times),
        Column("ratio_to_fe", ratio, "", "formula over FE"),
        *(column_of(some, "parts", s, name=p) for p, s in zip(parts, split, strict=True)),
        _reasons(answers),
    )
    table = Table(f"crosscheck_compliance_{name}", columns, f"{what}: closed forms over finite elements")
    return table, _extremes(f"{name}.compliance", ratio.reshape(times, count), tuple(answers))


def gear_compliance_table(name: str, gear: Gear, found: GearAnswers) -> tuple[Table, tuple[Value, ...]]:
    """Every compliance formula of one tooth, without its contact, over the finite elements."""
    fe, zone = found.table, found.contact_zone
    tooth = column_of(
        fe, "c_self", fe.c_self - zone, name="compliance_fe", meaning="FE, the loaded tooth without its contact zone"
    )
    taken_off = "half-plane approach that was taken off from FE"
    reference = (
        tooth,
        error_column(tooth, fe.errors["c_self"], "estimated error of FE"),
        column_of(fe, "c_self", zone, name="contact_zone", meaning=taken_off),
    )
    parts = ("bending", "shear", "axial", "foundation")
    what = f"Compliance of one tooth of gear {name} without its contact, plane {gear.plane_assumption}"
    first = columns_of(fe, "radius", "roll_angle")
    return _compliance_table(name, what, first, reference, found.compliance, parts)


def pair_table(name: str, check: PairCheck, found: PairAnswers) -> tuple[Table, tuple[Value, ...], str]:
    """Table and values of a pair, and what is to be remarked about ISO's c'; empty if nothing."""
    fe, w = found.reference, check.line_load
    first, reference = columns_of(fe, "x"), columns_of(fe, "total", "driver", "driven", "half_width")
    what = f"Compliance of one tooth pair of pair {name} under {w * 1e-3:.6g} N/mm"
    parts = ("driver", "driven", "contact")
    table, values = _compliance_table(name, what, first, reference, found.compliance, parts)
    greatest = float(1.0 / fe.total.min())
    unit = "N/(mm.um)"
    own = Value(f"{name}.single_stiffness_fe", greatest, unit, None, "greatest stiffness of one tooth pair by FE")
    iso = found.iso.value
    if iso is None:
        return table, (*values, own), f"Pair {name}: ISO 6336-1 gives no c': {found.iso.reason}"
    under = load_of_stiffness(check.applied_load, check.load_factor)
    extra = (
        *values,
        own,
        Value(f"{name}.single_stiffness_iso", iso.single, unit, None, f"ISO 6336-1 c', solid, C_M = 0.8, {under}"),
        Value(f"{name}.theoretical_stiffness_iso", iso.theoretical, unit, None, "ISO 6336-1 c'_th"),
        Value(f"{name}.single_stiffness_iso.ratio_to_fe", iso.single / greatest, "", None, "c' over FE"),
    )
    return table, extra, f"Pair {name}: {iso.remark}." if iso.remark else ""


def sources_table() -> Table:
    """Where each closed form comes from and what it compares."""
    from fegear.formulas.sources import ROOT_STRESS_SOURCES, SOURCES

    rows = [(s.name, "root stress", s.citation, s.compared) for s in ROOT_STRESS_SOURCES.values()]
    rows += [(s.name, "compliance", s.citation, s.remark) for s in SOURCES.values()]
    heads = ("formula", "gives", "source", "what_is_compared")
    columns = (Column(head, np.array(values)) for head, values in zip(heads, zip(*rows, strict=True), strict=True))
    return Table("crosscheck_sources", tuple(columns), "The closed forms and what each compares")


#: Ratios that figures shade as agreement.
_AGREEMENT = (0.95, 1.05)


def crosscheck_figure(table: Table) -> Figure:
    """Every formula of a table compared with the finite elements, their ratio, and of a root stress its place."""
    shown = {column.name: column.values for column in table.columns}
    formulas = list(dict.fromkeys(str(name) for name in shown["formula"]))
    stress = "root_tension" in shown
    first = "x" if "x" in shown else "roll_angle"
    label = ("contact point from the pitch point", "mm") if first == "x" else ("roll angle of the load", "deg")

    def curves(key: str, reference: str) -> tuple[Curve, ...]:
        drawn = []
        for number, formula in enumerate(formulas):
            rows = shown["formula"] == formula
            x, y = (np.asarray(shown[k][rows], dtype=float) for k in (first, key))
            if reference and not number:
                fe = np.asarray(shown[reference][rows], dtype=float)
                drawn.append(Curve(x, fe, "finite elements", "finite elements", width=2.6))
            drawn.append(Curve(x, y, formula, f"series:{number}"))
        return tuple(drawn)

    x = Axis(*label)
    key = "root_tension" if stress else "compliance"
    unit = table.column(key).unit
    title = "root stress per line load" if stress else "deflection per line load"
    panels = [
        Panel(x, Axis(title, unit, zero=not stress), curves(key, f"{key}_fe"), height=1.2),
        Panel(x, Axis("formula / FE"), curves("ratio_to_fe", ""), (Zone("y", *_AGREEMENT), Mark("y", 1.0, "±5 %"))),
    ]
    if stress:
        angle = Axis("fillet tangent to centre line", "deg")
        panels.append(Panel(x, angle, curves("place_angle", "place_angle_fe")))
    silent = dict.fromkeys(str(f) for f, r in zip(shown["formula"], shown["reason"], strict=True) if r)
    out = f" Out of range at some positions (see the table's reasons): {', '.join(silent)}." if silent else ""
    what = "along the line of action (secant), and its ratio to the finite elements"
    if stress:
        what = (
            "largest fillet stress under a load normal to the flank, its ratio to the finite elements, and its place "
            "(ISO looks at 30 deg always)"
        )
    subject = table.title.split(":", maxsplit=1)[0]
    return Figure(table.name, table.title, f"{subject}: {what}.{out}", tuple(panels))


CROSSCHECK = Stage(
    subjects=lambda scene: (_WHOLE,) if scene.spur_gears or _helical(scene) else (),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(
        *ROOT_STRESS_FORMULAS,
        *(citation for group in CLOSED_FORM_COMPLIANCES.values() for citation in group),
        Citation("iso-6336-1", "single tooth stiffness c'", "clause 9, method B"),
        *RING,
    ),
    forecast=_forecast,
)
