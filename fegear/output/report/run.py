"""The page of a run: what was asked, the numbers and their errors, each stage's plots and tables, plan, cost."""

from __future__ import annotations

from typing import TYPE_CHECKING

import fegear
from fegear.base.effects import EFFECTS
from fegear.base.notes import counted, open_and_folded, ordered
from fegear.engine.citation import Citation, bibliography
from fegear.engine.run_answer import in_order
from fegear.output.fields import field_file
from fegear.output.file_names import file_name
from fegear.output.plane_state import plane_state
from fegear.output.report.accuracy import accuracy_blocks
from fegear.output.report.blocks import (
    Block,
    ClassifiedNotes,
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
    Still,
    Switch,
    Values,
)
from fegear.output.report.gear_data import gear_sections
from fegear.output.report.page import Page, Section, write_page

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fegear.base.notes import Note
    from fegear.engine.run import Results
    from fegear.engine.run_answer import RunAnswer
    from fegear.engine.stage import Task
    from fegear.engine.table import Table
    from fegear.output.figures import Drawn


#: More values than this are folded, task by task: forty numbers before the first plot are too many.
_MOST_OPEN = 16


def _number_of(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def _title(results: Results, task: Task) -> str:
    step = next((step for step in results.plan.steps if step.task == task), None)
    title = step.stage.title if step else task.stage.replace("-", " ").capitalize()
    return f"{title}: {task.subject}" if task.subject else title


def _in_order(results: Results) -> list[Task]:
    return in_order(results.outcomes, results.plan, results.outcomes, results.scene.case.results)


def _values(results: Results) -> tuple[Block, ...]:
    """Results of every task: wanted before those that only serve others, in the order in which they are wanted."""
    found = [(task, results.outcomes[task].values) for task in _in_order(results) if results.outcomes[task].values]
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
            group += (Folded(f"{len(rest)} more value{'s' if len(rest) > 1 else ''}", (Values(rest, tolerance),)),)
        open_.append(Group(group))
    switch = (Switch("all-digits", "All digits and estimated errors"),) if found else ()
    return (*switch, *open_, *folded)


def _answer(
    answer: RunAnswer, drawn: Sequence[Drawn], shown: frozenset[str], tables: Sequence[Table]
) -> tuple[Block, ...]:
    """The card on top: what the wanted results come to, the figure that shows it, and short tables."""
    order = {name: n for n, name in enumerate(answer.tables)}
    named = sorted((table for table in tables if table.name in order), key=lambda table: order[table.name])
    short = [DataTable(table, brief=True) for table in named]
    figure = next((one for one in drawn if one.figure.key == answer.figure and answer.figure not in shown), None)
    first = 1 if answer.overviews else len(answer.sentences)
    before, behind = (
        [line for sentence in part for line in sentence.splitlines()]
        for part in (answer.sentences[:first], answer.sentences[first:])
    )
    blocks: tuple[Block, ...] = (
        *(Notes(part, "answer") for part in (before,) if part),
        *(DataTable(table.filled, brief=True, as_on_terminal=True) for table in answer.overviews),
        *(Notes(part, "answer") for part in (behind,) if part),
    )
    if figure is None:
        return (*blocks, *short)
    picture = [Plot(figure.figure)] if figure.figure.drawable_in_page else map(Still, figure.pictures)
    return (*blocks, *picture, *short)


def _drawable(one: Drawn, shown: frozenset[str]) -> bool:
    """Whether it is a picture of its section."""
    return one.figure.key not in shown and bool(one.figure.drawable_in_page or one.pictures)


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
    if information := results.information(task):
        blocks.append(Notes(ordered(information), "information"))
    return Section(_title(results, task), (*blocks, *_sources(results, task)) if blocks else ())


def _notes(notes: Sequence[Note]) -> tuple[Block, ...]:
    """The first ones open, the others behind a line that counts them."""
    shown, folded = open_and_folded(notes)
    blocks: tuple[Block, ...] = (ClassifiedNotes(shown),) if shown else ()
    return (*blocks, Folded(counted(folded), (ClassifiedNotes(folded),))) if folded else blocks


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
        "active effects": ", ".join(case.effects.on()) or "none",
        "effects that are off": ", ".join(off) or "none",
    }
    if plan.idle_effects:
        facts["active effects without influence"] = ", ".join(plan.idle_effects)
    skipped = Folded(
        f"Not computed ({len(plan.skipped)} stages) and reasons", (Grid(("Stage", "Reason"), plan.skipped),)
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
    values, answer, notes = _values(results), results.answer, results.notes(remarks, information=False)
    pictures = {task: [one for one in drawn if one.task == task] for task in results.outcomes}
    # Pictures before what is a table only: the mesh under load before the data of its gears.
    order = sorted(_in_order(results), key=lambda task: not any(_drawable(one, shown) for one in pictures[task]))
    stages = [_stage(results, task, pictures[task], shown | {answer.figure, *answer.tables}) for task in order]
    warned = f" {len(notes)} note{'s' if len(notes) > 1 else ''}, below the answer." if notes else ""
    plane = f" 2D teeth: {state} (gear.NAME.plane)." if (state := plane_state(results)) else ""
    total = sum(results.seconds.values())
    count = sum(len(outcome.values) for outcome in results.outcomes.values())
    return Page(
        title=scene.case.title or scene.name,
        note=f"Case {scene.name}: {', '.join(scene.case.results)}. "
        f"{_number_of(count, 'value')} and {_number_of(len(results.tables), 'table')}, "
        f"computed in {total:.2f} s by fegear {fegear.__version__}.{plane}{warned}",
        sections=(
            Section("Answer", _answer(answer, drawn, shown, results.tables)),
            Section("Notes", _notes(notes)),
            Section("Results", values),
            *stages,
            *gear_sections(results),
            Section("Accuracy and computing time", accuracy_blocks(results)),
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
