"""The page of a run: what was asked, the numbers and their errors, each stage's plots and tables, plan, cost.

Accuracy and its cost: seconds, errors compared with the tolerance, settings.

The data of the gears as on a drawing, and each pair drawn in mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

import fegear
from fegear.case.effects import EFFECTS
from fegear.engine.citation import Citation, bibliography
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Mark, Points
from fegear.engine.table import Column, Table
from fegear.geometry.pair import MEMBERS
from fegear.output.fields import field_file
from fegear.output.file_names import file_name
from fegear.output.numbers import plain_number
from fegear.output.report.blocks import (
    Bars,
    Block,
    Code,
    DataTable,
    Download,
    Facts,
    Folded,
    Grid,
    Group,
    Heading,
    Notes,
    Paragraph,
    Plot,
    Sheet,
    SheetGroup,
    Still,
    Values,
    relative_error,
    value_cells,
)
from fegear.output.report.page import Page, Section, write_page
from fegear.output.tables import table_file
from fegear.results.gear.body_section import body_figures
from fegear.results.gear.drawing import pair_figure
from fegear.results.gear.geometry import MEANINGS as MODIFICATIONS
from fegear.results.gear.geometry import drawing_of, lone_table, pair_table, pair_values

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fegear.engine.outcome import Value
    from fegear.engine.run import Results
    from fegear.engine.stage import Task
    from fegear.output.figures import Drawn


#: More values than this are folded, task by task: forty numbers before the first plot are too many.
_MOST_OPEN = 16


def _title(results: Results, task: Task) -> str:
    step = next((step for step in results.plan.steps if step.task == task), None)
    title = step.stage.title if step else task.stage.replace("-", " ").capitalize()
    return f"{title}: {task.subject}" if task.subject else title


def _values(results: Results) -> tuple[Block, ...]:
    """Results of every task: wanted before those that only serve others, estimated before exact ones."""
    wanted = {step.task for step in results.plan.steps if any(r.startswith("results asks") for r in step.reasons)}
    found = [(task, outcome.values) for task, outcome in results.outcomes.items() if outcome.values]
    found.sort(key=lambda item: (bool(wanted) and item[0] not in wanted, not any(value.error for value in item[1])))
    open_: list[Block] = []
    folded: list[Block] = []
    shown, tolerance = 0, results.scene.case.accuracy.tolerance
    for task, values in found:
        if shown and shown + len(values) > _MOST_OPEN:
            folded.append(Folded(f"{_title(results, task)} ({len(values)} values)", (Values(values, tolerance),)))
            continue
        shown += len(values)
        group: tuple[Block, ...] = (Heading(_title(results, task)), Values(values[:_MOST_OPEN], tolerance))
        if rest := values[_MOST_OPEN:]:
            group += (Folded(f"{len(rest)} more of them", (Values(rest, tolerance),)),)
        open_.append(Group(group))
    return (*open_, *folded)


def _citations(results: Results, task: Task) -> tuple[Citation, ...]:
    step = next((step for step in results.plan.steps if step.task == task), None)
    return tuple(dict.fromkeys(step.stage.cites(results.scene, task.subject))) if step else ()


def _sources(results: Results, task: Task) -> tuple[Block, ...]:
    works = bibliography()
    cited = [
        f"{works[c.key].short}{f', {c.where}' if c.where else ''}: {c.what}" for c in _citations(results, task)
    ]  # fmt: skip
    return (Folded("Sources of these results", (Notes(cited, "sources"),)),) if cited else ()


def _stage(results: Results, task: Task, drawn: Sequence[Drawn], shown: frozenset[str]) -> Section:
    outcome = results.outcomes[task]
    blocks: list[Block] = []
    for one in drawn:
        if one.figure.key in shown:
            continue
        blocks += [Plot(one.figure)] if one.figure.drawable_in_page else [Still(picture) for picture in one.pictures]
        if field := field_file(one.figure):
            blocks.append(Paragraph(str(field)))
    blocks += [DataTable(table) for table in outcome.tables if table.name not in shown]
    return Section(_title(results, task), (*blocks, *_sources(results, task)) if blocks else ())


def _plan(results: Results) -> tuple[Block, ...]:
    plan, case = results.plan, results.scene.case
    steps = [
        (
            str(step.task),
            "; ".join(step.reasons),
            ", ".join(step.effects) or "none",
            f"{results.seconds[step.task]:.3f}",
        )
        for step in plan.steps
    ]
    off = [name for name in EFFECTS if not case.effects.is_on(name)]
    facts = {
        "wanted": ", ".join(case.results),
        "tolerance": case.accuracy.tolerance,
        "effects that are on": ", ".join(case.effects.on()) or "none",
        "effects that are off": ", ".join(off) or "none",
    }
    if plan.idle_effects:
        facts["effects on that nothing uses"] = ", ".join(plan.idle_effects)
    skipped = Folded(
        f"What was not computed, and why ({len(plan.skipped)} stages)", (Grid(("Stage", "Why not"), plan.skipped),)
    )
    return (
        Facts(facts),
        Grid(("Computed", "Why", "Effects used", "Seconds"), steps, "plan"),
        *((skipped,) if plan.skipped else ()),
    )


def _references(results: Results) -> tuple[Block, ...]:
    works = bibliography()
    cited = {c.key for task in results.outcomes for c in _citations(results, task)}
    return (
        Notes([work.full for key, work in works.items() if key in cited], "references"),
        Paragraph(f"To cite fegear itself: fegear {fegear.__version__}, a workbench for gear teeth, BSD 3-clause."),
    )  # fmt: skip


def run_page(results: Results, drawn: Sequence[Drawn], remarks: Sequence[str]) -> Page:
    """Put the page of a run together.

    Parameters
    ----------
    results : Results
    drawn : sequence of Drawn
        Figures that a page cannot draw itself are embedded as pictures; their files are read when it is written.
    remarks : sequence of str
        Sentences that the reader should see first.

    Returns
    -------
    Page
    """
    scene = results.scene
    name = f"{file_name(scene.name)}.toml"
    files = {name: scene.text.encode()} if scene.text else {}
    shown = frozenset(
        {"gear_data", *(f"gear_data_{pair}" for pair in scene.pairs), *(f"gear_body_{gear}" for gear in scene.gears)}
    )
    values = _values(results)
    pictures = {task: [one for one in drawn if one.task == task] for task in results.outcomes}
    stages = [_stage(results, task, pictures[task], shown) for task in results.outcomes]
    # Pictures before what is a table only: the mesh under load before the data of its gears.
    stages.sort(key=lambda section: not any(isinstance(block, Plot | Still) for block in section.blocks))
    warned = (
        f" {len(remarks)} warning{'s' if len(remarks) > 1 else ''}, below the results." if remarks and values else ""
    )
    total = sum(results.seconds.values())
    count = sum(len(outcome.values) for outcome in results.outcomes.values())
    return Page(
        title=scene.case.title or scene.name,
        note=f"Case {scene.name}: {', '.join(scene.case.results)}. {count} values and {len(results.tables)} tables, "
        f"computed in {total:.2f} s by fegear {fegear.__version__}.{warned}",
        sections=(
            Section("Results", values),
            Section("Warnings", (Notes(remarks, "warning"),) if remarks else ()),
            *stages,
            *gear_sections(results),
            Section("Accuracy and its cost", accuracy_blocks(results)),
            Section("Plan", _plan(results)),
            Section("Case file", (Code(scene.text), Download(name)) if files else ()),
            Section("References", _references(results)),
        ),
        tables=results.tables,
        files=files,
        name=scene.name,
    )


def write_report(path: Path, results: Results, drawn: Sequence[Drawn], remarks: Sequence[str]) -> None:
    """Write the page of a run; see `run_page`."""
    write_page(path, run_page(results, drawn, remarks))


def _errors(results: Results) -> list[tuple[str, float]]:
    found = [(value.name, relative_error(value)) for value in results.values]
    return [(name, share) for name, share in found if share is not None]


def _figure(found: list[tuple[str, float]], tolerance: float) -> Figure:
    found = sorted(found, key=lambda item: item[1])
    names, share = tuple(name for name, _ in found), np.array([share for _, share in found])
    rows = np.arange(len(found))
    points = tuple(
        Points(share[here], rows[here], label, role, symbol, 9.0)
        for here, label, role, symbol in (
            (share <= tolerance, "within the tolerance", "green", "circle"),
            (share > tolerance, "over the tolerance", "red", "diamond"),
        )
        if here.any()
    )
    axes = Axis("estimated relative error", log=True), Axis(categories=names)
    return Figure(
        "estimated_errors", "Estimated errors and the tolerance",
        "Estimated error of every value over the value; left of the line it is within the case's tolerance.",
        (Panel(*axes, points, (Mark("x", tolerance, "tolerance"),)),),
    )  # fmt: skip


def accuracy_blocks(results: Results) -> tuple[Block, ...]:
    """Blocks on accuracy and its cost, from whatever the stages say of their settings."""
    tolerance = results.scene.case.accuracy.tolerance
    found = _errors(results)
    estimated = [value for value in results.values if value.error is not None]
    over = [name for name, share in found if share > tolerance]
    exact = sum(not value.error for value in estimated)
    kinds = (
        (len(estimated) - exact, "carry an estimated error"),
        (exact, "are exact" if exact != 1 else "is exact"),
        (len(results.values) - len(estimated), "have no estimate"),
    )
    summary = f"The case asks for a relative error of {plain_number(tolerance)}. Of its {len(results.values)} values "
    summary += ", ".join(f"{count} {words}" for count, words in kinds if count) + "."
    if over:
        summary += f" Over the tolerance: {', '.join(over)}."
    elif found:
        summary += " None of the estimates exceeds the tolerance."
    settings = tuple(
        Folded(f"Settings: {task}", (Facts(outcome.settings),))
        for task, outcome in results.outcomes.items()
        if outcome.settings
    )
    return (
        *((Paragraph(summary),) if results.values else ()),
        *(Paragraph(sentence) for sentence in _libraries(results)),
        *((Plot(_figure(found, tolerance)),) if len(found) > 1 else ()),
        Paragraph("Seconds of each task:", "table-title"),
        Bars({str(task): seconds for task, seconds in results.seconds.items()}, "s"),
        *settings,
    )


def _libraries(results: Results) -> tuple[str, ...]:
    """Which library does what on the way to influence functions, where finite elements were solved."""
    if not any(_has_solver(outcome.settings) for outcome in results.outcomes.values()):
        return ()
    solver = results.scene.case.accuracy.solver
    first = "gmsh meshes one tooth; scikit-fem numbers its unknowns, maps and integrates its elements"
    if solver == "scikit-fem":
        rest = "assembles them and eliminates the inner unknowns; fegear closes the ring of all teeth"
        return (f'{first}, {rest} (accuracy.solver = "scikit-fem").',)
    rest = "fegear's nested dissection assembles and eliminates, and closes the ring of all teeth"
    other = 'accuracy.solver = "scikit-fem" has scikit-fem do that too: same numbers, several times the CPU time'
    return (f"{first}; {rest}. {other} (fegear check measures both).",)


def _has_solver(settings: object) -> bool:
    """Whether settings, or some within them, are those of finite elements."""
    if not isinstance(settings, Mapping):
        return False
    return "solver" in settings or any(_has_solver(within) for within in settings.values())


#: Which columns of the gear data stand together, in the order of a drawing.
_GROUPS = (
    ("Teeth", (
        "gear", "teeth", "module", "pressure_angle", "helix_angle", "hand", "lead", "transverse_module",
        "transverse_pressure_angle", "base_helix_angle", "profile_shift", "face_width",
    )),
    ("Diameters", (
        "reference_diameter", "base_diameter", "tip_diameter", "tip_form_diameter", "active_tip_diameter",
        "hpstc_diameter", "lpstc_diameter", "active_root_diameter", "root_form_diameter", "root_diameter",
    )),
    ("Measurement", ("tooth_thickness", "tip_thickness", "span_teeth", "span", "ball_diameter", "over_balls")),
    ("Modifications", tuple(MODIFICATIONS)),
    ("In mesh", ("tip_clearance", "specific_sliding_start", "specific_sliding_end")),
)  # fmt: skip


def gear_sections(results: Results) -> tuple[Section, ...]:
    """A section for each pair, that in question first, one for gears in no pair, one for bodies."""
    drawing = drawing_of(results.scene)
    written = {table.name for table in results.tables}
    case = results.scene.case
    first = next(
        (n for n in (case.stiffness.pair, case.design.pair if case.design else None) if n in drawing.pairs), None
    )
    names = sorted(drawing.pairs, key=lambda name: name != first)
    sections = []
    for name in names:
        table, pair = pair_table(name, drawing), drawing.pairs[name]
        blocks = _blocks(table, pair_values(name, pair), written, _loaded(results, name))
        sections.append(Section(f"Gear data: pair {name}", (*blocks, Plot(pair_figure(name, drawing)))))
    lone = lone_table(drawing)
    if lone is not None:
        sections.append(Section("Gear data", _blocks(lone, (), written)))
    if bodies := body_figures(drawing.gears):
        sections.append(Section("Gear bodies", tuple(map(Plot, bodies))))
    return tuple(sections)


#: Values of the result ``rating`` that the data sheet shows, in its order.
_SHOWN = {
    "S_H": "safety against pitting S_H, ISO 6336",
    "S_H_computed": "S_H, computed load distribution",
    "S_H_spectrum": "S_H under the spectrum",
    "S_H_agma": "S_H, AGMA 2101",
    "S_F": "safety against tooth breakage S_F, ISO 6336",
    "S_F_computed": "S_F, computed root stress",
    "S_F_spectrum": "S_F under the spectrum",
    "S_F_agma": "S_F, AGMA 2101",
}


def rated_columns(values: Sequence[Value], pair: str) -> tuple[Column, ...]:
    """A column for every safety of driver and driven among the values of a run; none without a rating."""
    known = {value.name: value.value for value in values}
    rows = {key: [known.get(f"{pair}.{member}.{key}", np.nan) for member in MEMBERS] for key in _SHOWN}
    return tuple(
        Column(key, np.array([round(one, 3) for one in row]), "", _SHOWN[key])
        for key, row in rows.items()
        if not np.isnan(row).any()
    )


def _loaded(results: Results, name: str) -> tuple[SheetGroup, ...]:
    """What the wanted results tell of a pair under load: a group for each."""
    groups = (SheetGroup("Load capacity", rated_columns(results.values, name)),)
    return tuple(group for group in groups if group.columns)


def _blocks(
    table: Table, values: Sequence[Value], written: set[str], more: Sequence[SheetGroup] = ()
) -> tuple[Block, ...]:
    columns = {column.name: column for column in table.columns}
    heads = MEMBERS if values else tuple("" for _ in columns["gear"].values)
    groups = [SheetGroup(title, tuple(columns[name] for name in names if name in columns)) for title, names in _GROUPS]
    shared = tuple((value.meaning, value_cells(value)[0], value.unit) for value in values)
    sheet = Sheet(heads, (*(group for group in groups if group.columns), *more), shared)
    note = "" if table.name in written else 'The table itself is written with results = ["geometry"].'
    if note:
        return sheet, Paragraph(note, "note screen")
    return sheet, Download(f"tables/{table_file(table)}")
