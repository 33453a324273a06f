"""What ``fegear effects`` writes: ``tables/effects.csv``, a picture of each effect, report, summary.

The page of ``fegear effects``: for each effect its clearest curve without and with it, its values, its cost.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import fegear
from fegear.base.printed import figures
from fegear.case.reading import Scene
from fegear.engine.figure.figure import Figure
from fegear.engine.table import Column, Table
from fegear.output.file_names import file_name
from fegear.output.folder import SUMMARY, files_in
from fegear.output.numbers import plain_number, pretty_unit
from fegear.output.report.blocks import Block, DataTable, Facts, Folded, Grid, Paragraph, Plot
from fegear.output.report.page import Page, Section, write_page
from fegear.output.summary import write_json
from fegear.output.tables import write_table
from fegear.studies.comparison.compare import Pairing
from fegear.studies.effects import EffectCurve, Fixed, Switched, clearest_curve, effect_figure


def _carried(effect: str, found: EffectCurve) -> tuple[Table, Table]:
    """The tables of the curve without and with an effect, under names of their own."""
    before, after, _, _ = found
    tables = tuple(
        Table(f"{effect}_{label}", table.columns, f"{table.title or table.name}, {label} {effect}")
        for table, label in ((before, "without"), (after, "with"))
    )
    return tables[0], tables[1]


def stated_errors(pair: Pairing) -> str:
    """Estimated errors of a value without an effect and with it; none is stated where both are unknown."""
    known = [f"+- {value.error:.2g}" for value in pair.both if value.error]
    return " and ".join(known) or "round-off"


def _values(found: Switched) -> Block:
    rows = []
    for pair in sorted(found.changes(), key=lambda pair: -abs(pair.share)):
        if pair.change == 0.0:
            continue
        a, b = pair.both
        change = f"{100.0 * pair.share:+.3g} %" if pair.resolved else f"not resolved ({stated_errors(pair)})"
        rows.append((a.name, a.value, b.value, pretty_unit(a.unit), change))
    if not rows:
        return Paragraph("No value changes.")
    grid = Grid(("Value", "Without", "With", "Unit", "Change"), rows)
    return Folded(f"The {len(rows)} values it changes", (grid,))


def _kernels(found: Switched) -> Block:
    names = sorted({*found.without.kernels, *found.with_it.kernels})
    calls = {name: (found.without.kernels.get(name, 0), found.with_it.kernels.get(name, 0)) for name in names}
    changed = {name: f"{a} without, {b} with" for name, (a, b) in calls.items() if a != b}
    facts = Facts(changed or {"all kernels": "same number of calls with and without"})
    return Folded("Calls of the kernels", (facts,))


def effects_page(
    scene: Scene,
    switched: Sequence[Switched],
    fixed: Sequence[Fixed],
    table: Table,
    curves: Mapping[str, EffectCurve | None],
    figures: Mapping[str, Figure],
    sentences: Mapping[str, str],
) -> Page:
    """Put the page together.

    Parameters
    ----------
    scene : Scene
    switched : sequence of Switched
    fixed : sequence of Fixed
    table : Table
        What ``tables/effects.csv`` holds.
    curves : mapping
        The curve of each effect, or None.
    figures : mapping
    sentences : mapping
        One sentence for each effect.
    """
    sections, carried = [], [table]
    for found in switched:
        blocks: list[Block] = [Paragraph(sentences[found.effect])]
        curve = curves[found.effect]
        if curve is not None:
            carried += _carried(found.effect, curve)
        blocks += [Plot(figures[found.effect]), _values(found), _kernels(found)]
        state = "on" if found.named else "off"
        sections.append(Section(f"{found.effect} ({state} in the case)", tuple(blocks)))
    stuck = [(one.effect, one.reason) for one in fixed]
    rows = [(found.effect, "on" if found.named else "off", *_largest(found)) for found in switched]
    summary = Grid(("Effect", "In the case", "Largest change", "Change", "CPU time [s]"), rows)
    return Page(
        title=f"Effects: {scene.case.title or scene.name}",
        note=f"Case {scene.name} with each of {len(switched)} effects switched, one at a time.",
        sections=(
            Section("At a glance", (summary,) if rows else ()),
            *sections,
            Section("Effects that cannot be switched", (Grid(("Effect", "Why"), stuck),) if stuck else ()),
            Section("Table", (DataTable(table),)),
        ),
        tables=tuple(carried),
        files={f"{file_name(scene.name)}.toml": scene.text.encode()} if scene.text else {},
        name=f"{scene.name}_effects",
    )


def _largest(found: Switched) -> tuple[str, str, str]:
    """The value that an effect changes most, by how much, and what the effect costs."""
    cost = f"{found.without.seconds:.2f} without, {found.with_it.seconds:.2f} with"
    most = found.largest_change()
    if most is None:
        return "none above the estimated error" if any(pair.change for pair in found.changes()) else "none", "", cost
    a, b = most.both
    unit = f" {pretty_unit(a.unit)}".rstrip()
    return most.name, f"{plain_number(a.value, 5)} to {plain_number(b.value, 5)}{unit}", cost


Curve = tuple[Table, Table, str, str]


#: Name, unit and meaning of the columns.
_HEADS = (
    ("effect", "", "which effect"),
    ("in_the_case", "", "1: effect is on in the case"),
    ("result", "", "name of the value"),
    ("unit", "", "unit of the value"),
    ("without", "", "value without the effect"),
    ("with", "", "value with the effect"),
    ("change", "", "change (with - without)"),
    ("share", "", "change relative to the larger value"),
    ("error_without", "", "estimated error of the value without the effect"),
    ("error_with", "", "estimated error of the value with the effect"),
    ("resolved", "", "1: change exceeds the sum of both estimated errors (or 1e-9 of a value without one)"),
    ("processor_without", "s", "CPU time without the effect"),
    ("processor_with", "s", "CPU time with the effect"),
    ("kernels", "", "calls of the kernels without -> with"),
)


def effects_table(switched: Sequence[Switched]) -> Table:
    """One row for each effect and value: without and with the effect, seconds, and the kernels that it calls more."""
    rows = []
    for found in switched:
        kernels = kernel_changes(found)
        for pair in found.changes():
            a, b = pair.both
            errors = [math.nan if value.error is None else value.error for value in (a, b)]
            rows.append(
                (found.effect, "on" if found.named else "off", a.name, a.unit, a.value, b.value, pair.change,
                 pair.share, *errors, "yes" if pair.resolved else "no", found.without.seconds, found.with_it.seconds,
                 kernels)
            )  # fmt: skip
    columns = list(zip(*rows, strict=True)) if rows else [()] * len(_HEADS)
    made = [Column(h, np.array(c), unit, meaning) for (h, unit, meaning), c in zip(_HEADS, columns, strict=True)]
    return Table("effects", tuple(made), "Influence and cost of each effect")


def kernel_changes(found: Switched) -> str:
    """Kernels whose number of calls the effect changes."""
    before, after = found.without.kernels, found.with_it.kernels
    names = [name for name in {**before, **after} if before.get(name, 0) != after.get(name, 0)]
    return "; ".join(f"{name} {before.get(name, 0)} -> {after.get(name, 0)}" for name in names)


def write_effects(scene: Scene, switched: Sequence[Switched], fixed: Sequence[Fixed], folder: Path) -> list[str]:
    """Write table, pictures, report and summary.

    Parameters
    ----------
    scene : Scene
    switched : sequence of Switched
    fixed : sequence of Fixed
    folder : Path
        An empty folder.

    Returns
    -------
    list of str
        One sentence for each effect.
    """
    from fegear.output.draw_png import draw_pictures

    (folder / "tables").mkdir()
    (folder / "plots").mkdir()
    table = effects_table(switched)
    write_table(folder / "tables", table)
    curves = {found.effect: clearest_curve(found) for found in switched}
    title = scene.case.title or scene.name
    figures = {found.effect: effect_figure(found, curves[found.effect], title) for found in switched}
    for figure in figures.values():
        for _ in draw_pictures(replace(figure, case=scene.name), folder / "plots"):
            pass
    sentences = {found.effect: sentence(found) for found in switched}
    write_page(folder / "report.html", effects_page(scene, switched, fixed, table, curves, figures, sentences))
    lines = list(sentences.values())
    lines += [f"{one.effect} cannot be switched in this case: {one.reason}" for one in fixed]
    write_json(
        folder / SUMMARY,
        {
            "title": scene.case.title,
            "case": scene.name,
            "effects": {
                found.effect: {
                    "in_the_case": found.named,
                    "processor_seconds": {
                        "without": round(found.without.seconds, 6), "with": round(found.with_it.seconds, 6)
                    },
                    "kernels": {"without": dict(found.without.kernels), "with": dict(found.with_it.kernels)},
                }
                for found in switched
            },
            "remarks": lines,
            "files": [*files_in(folder), SUMMARY],
            "version": fegear.__version__,
        },
    )  # fmt: skip
    return lines


def sentence(found: Switched) -> str:
    """The value that an effect changes most, of those by more than their errors, and what that costs."""
    cost = f"CPU time {found.without.seconds:.2f} s without, {found.with_it.seconds:.2f} s with"
    most = found.largest_change()
    if most is not None:
        a, b = most.both
        values = f"{figures(a.value, 5)} -> {figures(b.value, 5)} {a.unit}".rstrip()
        return f"{found.effect}: largest change in {a.name}: {values}; {cost}."
    unresolved = [pair for pair in found.changes() if pair.change != 0.0]
    if not unresolved:
        return f"{found.effect}: no value changes; {cost}."
    most = max(unresolved, key=lambda pair: abs(pair.share))
    change = f"{figures(most.change, signed=True)} {most.both[0].unit}".rstrip()
    not_resolved = f"{most.name}: {change}, not resolved ({stated_errors(most)})"
    return f"{found.effect}: no change above the estimated error; {not_resolved}; {cost}."
