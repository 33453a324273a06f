"""The head of a report: the data of the gears as on a drawing, and each pair drawn in mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.geometry.pair import MEMBERS
from fegear.output.report.blocks import Download, Paragraph, Plot, Sheet, SheetGroup, value_cells
from fegear.output.report.page import Section
from fegear.output.tables import table_file
from fegear.results.drawn_pair import pair_figure
from fegear.results.gear_data import drawing_of, lone_table, pair_table, pair_values
from fegear.results.gear_modifications import MEANINGS as MODIFICATIONS
from fegear.results.rating_sheet import rated_columns

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.engine.outcome import Table, Value
    from fegear.engine.run import Results
    from fegear.output.report.blocks import Block

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
    """A section for each pair, that in question first, and one for gears in no pair; empty without gears."""
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
    return tuple(sections)


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
