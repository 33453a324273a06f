"""Result ``crosscheck``: every closed form compared with the finite elements, over load positions."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from fegear.base.effects import ODD_TEETH
from fegear.base.notes import assuming
from fegear.case.built.odd_gears import odd_gears_of, reshaped_gears
from fegear.case.built.odd_teeth import odd_teeth_in
from fegear.case.built.tooth_influence import mesh_settings, seconds_of_gear
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results import forecasts
from fegear.results.forecasts import CLOSED_FORM_COMPLIANCES, RING, ROOT_STRESS_FORMULAS
from fegear.results.gear.crosscheck_answer import (
    said_of_compliance,
    said_of_helical,
    said_of_root_stress,
    said_of_single_contact,
    said_of_stiffness,
)
from fegear.results.gear.crosscheck_compared import (
    CrosscheckData,
    CrosscheckInputs,
    Everything,
    GearAnswers,
    PairAnswers,
    PairCheck,
)
from fegear.results.gear.crosscheck_cycle import (
    CYCLE_CHART,
    CYCLE_TABLE,
    cycle_values,
    said_of_cycle,
    silent_formulas,
)
from fegear.results.gear.crosscheck_iso import (
    ISO_TABLE,
    ISO_VALUES,
    SECTION_TABLE,
    SECTION_VALUES,
    iso_inputs,
    on_iso,
    section_figure,
)
from fegear.results.gear.crosscheck_odd import (
    ODD_CHART,
    ODD_TABLE,
    passage_values,
    said_of_passage,
    silent_on_odd_teeth,
)
from fegear.results.gear.crosscheck_rows import (
    GEAR_COMPLIANCE_COLUMNS,
    PAIR_COMPLIANCE_COLUMNS,
    ROOT_STRESS_COLUMNS,
    SINGLE_CONTACT_COLUMNS,
    at_single_contact_values,
    comparison,
    extremes,
)
from fegear.results.gear.load_positions import chosen_gears
from fegear.results.gear.odd_gear import ODD_SOLUTIONS, needs_odd_solution_in
from fegear.results.gear.solved_gear import needs_solution, solution_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.case.reading import Scene
    from fegear.contact.compared.odd_cycle import OddPassage, OddTeethOfPair
    from fegear.contact.compared.rated_gears import RatedPair
    from fegear.engine.sheet.seen import Seen, Text
    from fegear.fem.plane.table import StiffnessTable


#: Line load of the pairs when the case names none [N/m].
USUAL_LINE_LOAD = 100e3


#: Odd teeth of a pair that are followed through the mesh at most.
MOST_ODD_TEETH = 4

#: The whole case is one subject: gears and pairs share the tables of sources and the remarks.
_WHOLE = ""


_GEAR_REMARKS = (
    (
        "Crosscheck: single tooth of the complete gear loaded normal to the flank, no friction, no other tooth "
        "loaded; all values per unit line load (secant)."
    ),
    (
        "Crosscheck of root stress: FE is the largest tangential stress along the fillet below the loaded flank, "
        "radial compression included, of the complete gear with its rim; the formulas do not include the rim; table "
        "crosscheck_sources states whether radial compression is subtracted. Root stress per line load is the same "
        "in plane stress and plane strain."
    ),
    (
        "Crosscheck of gear compliance: tooth and body without the contact zone; the half-plane approach down to the "
        "tooth centre line along the line of action is subtracted from FE."
    ),
)


_PAIR_REMARK = (
    "Crosscheck of pair compliance: one tooth pair with Hertzian contact width, no load sharing; FE deflections are "
    "averaged with the contact pressure as weight."
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
        factor = part.operation.applied_factor
        return PairCheck(pair, gears, count, load / pair.face_width, False, factor, loaded=True)
    return PairCheck(pair, gears, count, line_load or USUAL_LINE_LOAD, line_load is None, loaded=load is not None)


def _check(scene: Scene, _subject: str) -> None:
    from fegear.contact.compared.crosscheck import refuse_wide_contacts

    for name in _pairs(scene):
        check = _pair_check(scene, name)
        refuse_wide_contacts(check.pair, check.line_load, f"pair.{name}.load")


def _inputs(scene: Scene, _subject: str) -> CrosscheckInputs:
    gears = {name: scene.gears[name] for name in chosen_gears(scene)}
    pairs, settings = _pairs(scene), mesh_settings(scene.case.accuracy)
    iso = {name: iso_inputs(scene, name, settings) for name in (*pairs, *_helical(scene))}
    odd = {name: odd_teeth_of_pair(scene, name) for name in pairs if odd_gears_of(scene, name)}
    return CrosscheckInputs(gears, {name: _pair_check(scene, name) for name in pairs}, iso, odd)


def odd_teeth_of_pair(scene: Scene, name: str) -> OddTeethOfPair:
    """Cracked and pitted teeth of a plane pair, as its mesh stiffness by formulas takes them."""
    from fegear.contact.compared.odd_cycle import OddTeethOfPair, OddTooth

    part, pair = scene.case.pair[name], scene.pairs[name]
    known = {m: odd_teeth_in(scene, name, gear) for m, gear in zip(MEMBERS, (part.driver, part.driven), strict=True)
             if gear in odd_gears_of(scene, name)}  # fmt: skip
    teeth = [
        OddTooth(member, one.name, tooth, what)
        for member, one in known.items()
        for what, numbers in (
            ("cracked", [tooth for tooth, _ in one.cracks]),
            ("pitted", [tooth for tooth, flank in one.flanks if flank.pits]),
        )
        for tooth in numbers
    ]
    return OddTeethOfPair(
        tuple(teeth[:MOST_ODD_TEETH]),
        {member: one.crack_tips(pair.gear(member).teeth) for member, one in known.items()},
        {member: dict(one.flanks) for member, one in known.items()},
    )


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    mates = [gear for name in _pairs(scene) for gear in (scene.case.pair[name].driver, scene.case.pair[name].driven)]
    odd = [task for name in _pairs(scene) for task in needs_odd_solution_in(scene, name, *_cracked(scene, name))]
    return (*(Task("stiffness", name) for name in chosen_gears(scene)), *needs_solution(*mates), *dict.fromkeys(odd))


def _cracked(scene: Scene, name: str) -> tuple[str, ...]:
    """Gears of a pair that are solved with their cracked teeth."""
    reshaped = reshaped_gears(scene)
    return tuple(gear for gear in odd_gears_of(scene, name) if gear in reshaped)


def _compute(asked: CrosscheckInputs, upstream: Upstream, work: Work) -> CrosscheckData:
    from fegear.contact.compared.crosscheck import (
        contact_zone,
        pair_compliance_answers,
        pair_reference,
        positions_on_flanks,
        root_stress_answers,
        tooth_compliance_answers,
    )
    from fegear.contact.compared.mesh_cycle import mesh_cycle
    from fegear.contact.compared.rated_gears import rated_helical_pair, rated_spur_pair
    from fegear.contact.compared.single_contact import at_single_contact
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
        x = positions_on_flanks(pair, w, check.positions)
        driver, driven = (solution_of(upstream, gear) for gear in check.gears)
        fe_pair = pair_reference(pair, driver, driven, x, w)
        iso = attempt(partial(pair_stiffness, pair, specific_load=check.applied_load))
        in_mesh = attempt(partial(mesh_cycle, pair, driver, driven, w))
        outer = at_single_contact(pair, (driver, driven))
        odd = _odd_passages(asked, name, upstream) if name in asked.odd else ()
        pairs[name] = PairAnswers(fe_pair, pair_compliance_answers(pair, fe_pair.x, w), iso, in_mesh.value, outer, odd)
        iso_asked = asked.iso[name]
        rated[name] = rated_spur_pair(pair, (driver, driven), w, iso_asked.choice, iso_asked.rims)
        work.progress((len(gears) + len(pairs)) / count)
    for name, wanted in asked.iso.items():
        if wanted.helical is not None and wanted.settings is not None:
            rated[name] = rated_helical_pair(wanted.helical, wanted.choice, wanted.rims, wanted.settings, work.cache)
    return CrosscheckData(gears, pairs, rated)


def _odd_passages(asked: CrosscheckInputs, name: str, upstream: Upstream) -> tuple[OddPassage, ...]:
    """Mesh stiffness of a pair while each of its cracked or pitted teeth passes; none where no pair is in contact."""
    from fegear.contact.compared.odd_cycle import odd_passages
    from fegear.contact.plane.fe_compliance import finite_element_compliance
    from fegear.contact.plane.odd_compliance import odd_compliance
    from fegear.formulas.outcome import attempt

    check = asked.pairs[name]
    ordinary = tuple(finite_element_compliance(solution_of(upstream, gear)) for gear in check.gears)
    solved = {task.subject: one for task, one in upstream.items() if task.stage in ODD_SOLUTIONS}
    odd = tuple(odd_compliance(solved[gear]) if gear in solved else one
                for gear, one in zip(check.gears, ordinary, strict=True))  # fmt: skip
    found = attempt(partial(odd_passages, check.pair, odd, ordinary, check.line_load, asked.odd[name]))
    return found.value or ()


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """Every closed form for every gear and pair; helical pairs solve two virtual spur gears for each of theirs."""
    virtual = 4 * len(_helical(scene)) * seconds_of_gear(mesh_settings(scene.case.accuracy))
    return forecasts.constant(0.05 + 0.08 * (len(scene.spur_gears) + len(scene.spur_pairs)) + virtual)


def _of_pair(seen: Seen) -> str:
    load = f"{seen.one.check.line_load * 1e-3:.6g} N/mm"
    return f"Compliance of one tooth pair of pair {seen.key} under {load}: closed forms over finite elements"


_ROOT = "Root stress of gear {key}: closed forms over finite elements"
_TOOTH = (
    "Compliance of one tooth of gear {key} without its contact, plane {one.gear.plane_assumption}: closed forms over "
    "finite elements"
)
_STRESS_DRAWN = (
    "maximum fillet stress for a load normal to the flank, its ratio to FE, and its position (ISO: always the 30 deg "
    "tangent)"
)
_COMPLIANCE_DRAWN = "along the line of action (secant), and its ratio to FE"
_STRESS_TABLE = Rows("crosscheck_root_stress_{key}", _ROOT, ROOT_STRESS_COLUMNS, of="root_stress")
_TOOTH_TABLE = Rows("crosscheck_compliance_{key}", _TOOTH, GEAR_COMPLIANCE_COLUMNS, of="compliance")
_SINGLE_TABLE = Rows(
    "crosscheck_single_contact_{key}",
    "Root stress of pair {key}, loads at the outer points of single pair contact (HPSTC): closed forms over finite "
    "elements",
    SINGLE_CONTACT_COLUMNS, of="single_contact",
)  # fmt: skip
_PAIR_TABLE = Rows("crosscheck_compliance_{key}", _of_pair, PAIR_COMPLIANCE_COLUMNS, of="compliance")


def _silent(title: Text, where: str) -> Callable[[Seen], list[str]]:
    """Which formulas answer nothing at some positions."""

    def said(seen: Seen) -> list[str]:
        silent = seen.find(where).silent.items()
        return [f"{seen.said(title)}: {name} is out of its range at some positions: {why}" for name, why in silent]

    return said


def _silent_iso(seen: Seen) -> list[str]:
    silent = {row.name: row.reason for row in seen.one.rows if row.reason}
    title = seen.said(ISO_TABLE.title)
    return [f"{title}: {name} is out of its range at some positions: {why}" for name, why in silent.items()]


def _on_load(seen: Seen) -> str:
    load = f"{seen.one.check.line_load * 1e-3:.6g} N/mm"
    return assuming(f"Pair {seen.key}: no load was given; its contact is that of {load}.")


def _said(seen: Seen) -> list[str]:
    """Each formula as it is meant first: root stress at the outer point of single pair contact, c' at its maximum.

    Stiffness leads where a pair carries a load.
    """
    outer, helical, stiffness, cycles, odd, compliance, gears = (
        [sentence for one in seen.each(where) for sentence in said(one)]
        for where, said in (
            ("pairs", said_of_single_contact), ("iso", said_of_helical), ("mean_stiffness", said_of_stiffness),
            ("cycles", said_of_cycle), ("passages", said_of_passage), ("pairs", said_of_compliance),
            ("gears", said_of_root_stress),
        )
    )  # fmt: skip
    loaded = any(one.check.loaded for one in seen.data.pairs.values())
    if loaded or not (outer or gears):
        return [*odd, *stiffness, *cycles, *outer, *helical, *compliance, *gears]
    return [*outer, *helical, *gears, *compliance, *stiffness, *cycles, *odd]


def _first_figure(seen: Seen) -> str:
    """Mesh stiffness of the first pair under a load, while an odd tooth passes if there is one; else the first gear's.

    Of helical pairs alone there is none.
    """
    if (key := next(iter(seen.data.passages), None)) is not None:
        return f"crosscheck_odd_tooth_{key}"
    loaded = (name for name in seen.data.cycles if seen.data.pairs[name].check.loaded)
    if (pair := next(loaded, None)) is not None:
        return f"crosscheck_mesh_stiffness_{pair}"
    return next((f"crosscheck_root_stress_{name}" for name in seen.asked.gears), "")


_SHEET = Sheet(
    name=lambda _asked: _WHOLE,
    of=Everything.of,
    answer=Answer(
        _said, figure=_first_figure,
    ),
    tables=(
        Rows("crosscheck_sources", "Formulas and their basis of comparison", (Every("sources"),), of="sources"),
        Each("gears", _STRESS_TABLE, _TOOTH_TABLE),
        Each("cycles", CYCLE_TABLE),
        Each("passages", ODD_TABLE),
        Each("pairs", _SINGLE_TABLE, _PAIR_TABLE),
        Each("iso", ISO_TABLE),
        Each("gears", SECTION_TABLE, when="cornell"),
    ),
    values=(
        Each("passages", passage_values),
        Each("pairs", at_single_contact_values),
        Each("gears", extremes("root_stress", "root_stress"), extremes("compliance", "compliance")),
        Each(
            "pairs",
            extremes("compliance", "compliance"),
            Number("single_stiffness_fe", owner="{key}"),
            Number(
                "single_stiffness_iso", owner="{key}", meaning="ISO 6336-1 c', solid, C_M = 0.8, {one.under}"
            ),
            Number("theoretical_stiffness_iso", owner="{key}"),
            Number("ratio_to_fe", owner="{key}", name="single_stiffness_iso.ratio_to_fe"),
        ),
        Each("iso", *ISO_VALUES),
        Each(
            "mean_stiffness", Number("iso", owner="{key}"), Number("fe", owner="{key}"),
            Number("ratio_to_fe", owner="{key}"),
        ),
        Each("cycles", cycle_values),
        Each("gears", *SECTION_VALUES, when="cornell"),
    ),
    figures=(
        Each("passages", ODD_CHART),
        Each("cycles", CYCLE_CHART),
        Each(
            "gears",
            comparison("crosscheck_root_stress_{key}", _ROOT, _STRESS_DRAWN, "root_stress", "roll_angle", stress=True),
            comparison("crosscheck_compliance_{key}", _TOOTH, _COMPLIANCE_DRAWN, "compliance", "roll_angle"),
        ),
        Each("pairs", comparison("crosscheck_compliance_{key}", _of_pair, _COMPLIANCE_DRAWN, "compliance", "x")),
        Each("gears", section_figure, when="cornell"),
    ),
    remarks=(
        # A case of helical pairs alone compares no spur gear of its own: its remarks come with each pair.
        lambda seen: _GEAR_REMARKS if seen.asked.gears else (),
        Remark(_PAIR_REMARK, when="pairs"),
        Each("pairs", Remark(_on_load, when="check.chosen"), Remark("Pair {key}: {one.remark}", when="remark")),
        Each("iso", on_iso),
        Each("gears", _silent(_ROOT, "root_stress"), _silent(_TOOTH, "compliance")),
        Each("pairs", _silent(_of_pair, "compliance")),
        Each("cycles", silent_formulas),
        Each("passages", silent_on_odd_teeth),
        Each("iso", _silent_iso),
    ),
)  # fmt: skip


CROSSCHECK = Stage(
    subjects=lambda scene: (_WHOLE,) if scene.spur_gears or _helical(scene) else (),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(
        *ROOT_STRESS_FORMULAS,
        *(citation for group in CLOSED_FORM_COMPLIANCES.values() for citation in group),
        Citation("iso-6336-1", "single tooth stiffness c'", "clause 9, method B"),
        *RING,
    ),
    forecast=_forecast,
    effects_of=lambda _scene, _subject: (ODD_TEETH.name,),
)
