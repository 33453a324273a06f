"""The page of ``fegear effects``: for each effect its clearest curve without and with it, its values, its cost."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.engine.table import Table
from fegear.output.file_names import file_name
from fegear.output.numbers import plain_number, pretty_unit
from fegear.output.report.blocks import Block, DataTable, Facts, Folded, Grid, Paragraph, Plot
from fegear.output.report.page import Page, Section

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.case.reading import Scene
    from fegear.engine.figure.figure import Figure
    from fegear.studies.comparison.compare import Pairing
    from fegear.studies.effects import EffectCurve, Fixed, Switched


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
        return Paragraph("It changes no value.")
    grid = Grid(("Value", "Without", "With", "Unit", "Change"), rows)
    return Folded(f"The {len(rows)} values that it changes", (grid,))


def _kernels(found: Switched) -> Block:
    names = sorted({*found.without.kernels, *found.with_it.kernels})
    calls = {name: (found.without.kernels.get(name, 0), found.with_it.kernels.get(name, 0)) for name in names}
    changed = {name: f"{a} without, {b} with" for name, (a, b) in calls.items() if a != b}
    facts = Facts(changed or {"every kernel": "called as often without as with"})
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
    summary = Grid(("Effect", "In the case", "Value that it changes most", "Change", "Processor seconds"), rows)
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
        return "none by more than its error" if any(pair.change for pair in found.changes()) else "none", "", cost
    a, b = most.both
    unit = f" {pretty_unit(a.unit)}".rstrip()
    return most.name, f"{plain_number(a.value, 5)} to {plain_number(b.value, 5)}{unit}", cost
