"""Result ``crosscheck``: every closed form beside the finite elements, over load positions."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.models.settings import mesh_settings, seconds_of_gear
from fegear.results import forecasts
from fegear.results.crosscheck_data import CrosscheckData, CrosscheckInputs, GearAnswers, PairAnswers, PairCheck
from fegear.results.crosscheck_iso import iso_inputs, iso_table
from fegear.results.crosscheck_tables import gear_compliance_table, pair_table, root_stress_table, sources_table
from fegear.results.drawn_cornell import section_figure, section_table
from fegear.results.drawn_crosscheck import crosscheck_figure
from fegear.results.gear_contacts import chosen_gears
from fegear.results.gear_solution import needs_solution, solution_of
from fegear.results.sources import CLOSED_FORM_COMPLIANCES, RING, ROOT_STRESS_FORMULAS

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.iso_check import RatedPair
    from fegear.engine.stage import Upstream, Work
    from fegear.fem import StiffnessTable

#: Line load of the pairs when the case names none [N/m].
USUAL_LINE_LOAD = 100e3
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
    force = part.normal_load(pair)
    line_load, chosen = stiffness.load, False
    if line_load is None:
        chosen = force is None
        width = pair.face_width
        line_load = USUAL_LINE_LOAD if force is None else force / width
    return PairCheck(pair, (part.driver, part.driven), stiffness.positions, line_load, chosen)


def _inputs(scene: Scene, _subject: str) -> CrosscheckInputs:
    gears = {name: scene.gears[name] for name in chosen_gears(scene)}
    pairs, settings = _pairs(scene), mesh_settings(scene.case.accuracy)
    iso = {name: iso_inputs(scene, name, settings) for name in (*pairs, *_helical(scene))}
    return CrosscheckInputs(gears, {name: _pair_check(scene, name) for name in pairs}, iso)


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    mates = [gear for name in _pairs(scene) for gear in (scene.case.pair[name].driver, scene.case.pair[name].driven)]
    return (*(Task("stiffness", name) for name in chosen_gears(scene)), *needs_solution(*mates))


def _compute(asked: CrosscheckInputs, upstream: Upstream, work: Work) -> CrosscheckData:
    from fegear.contact.crosscheck import (
        contact_zone,
        pair_compliance_answers,
        pair_reference,
        root_stress_answers,
        tooth_compliance_answers,
    )
    from fegear.contact.iso_check import rated_helical_pair, rated_spur_pair
    from fegear.formulas.cornell_section import radial_section_lengths
    from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
    from fegear.formulas.outcome import attempt

    gears, pairs, count = {}, {}, len(asked.gears) + len(asked.pairs)
    rated: dict[str, RatedPair] = {}
    for name, gear in asked.gears.items():
        fe: StiffnessTable = upstream[Task("stiffness", name)]
        gears[name] = GearAnswers(
            fe, root_stress_answers(gear.tooth, fe.radius / gear.module), tooth_compliance_answers(gear, fe.radius),
            contact_zone(gear, fe.radius, fe.half_width),
            attempt(partial(radial_section_lengths, gear.tooth, fe.radius / gear.module)),
        )  # fmt: skip
        work.progress(len(gears) / count)
    for name, check in asked.pairs.items():
        pair, w = check.pair, check.line_load
        x = np.linspace(pair.x_start, pair.x_end, check.positions)
        driver, driven = (solution_of(upstream, gear) for gear in check.gears)
        fe_pair = pair_reference(pair, driver, driven, x, w)
        iso = attempt(partial(pair_stiffness, pair, w))
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


CROSSCHECK = Stage(
    subjects=lambda scene: (_WHOLE,) if scene.spur_gears or _helical(scene) else (),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(
        *ROOT_STRESS_FORMULAS,
        *(citation for group in CLOSED_FORM_COMPLIANCES.values() for citation in group),
        Citation("iso-6336-1", "single tooth stiffness c'", "clause 9, method B"),
        *RING,
    ),
    forecast=_forecast,
)
