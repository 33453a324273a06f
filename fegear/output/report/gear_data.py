"""The data of the gears as on a drawing, and each pair drawn in mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.table import Column, Table
from fegear.geometry.gear_data import MODIFICATIONS
from fegear.geometry.pair import MEMBERS
from fegear.output.report.blocks import (
    Block,
    Download,
    Paragraph,
    Plot,
    Sheet,
    SheetGroup,
    value_cells,
)
from fegear.output.report.page import Section
from fegear.output.tables import table_file
from fegear.results.gear.body_section import body_figures
from fegear.results.gear.drawing import pair_figure
from fegear.results.gear.geometry import drawing_of, lone_table, pair_table, pair_values

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.engine.run import Results
    from fegear.engine.value import Value


#: Which columns of the gear data stand together, in the order of a drawing.
_GROUPS = (
    ("Teeth", (
        "gear", "teeth", "module", "pressure_angle", "helix_angle", "hand", "lead", "transverse_module",
        "transverse_pressure_angle", "base_helix_angle", "back_pressure_angle", "profile_shift", "face_width",
    )),
    ("Diameters", (
        "reference_diameter", "base_diameter", "back_base_diameter", "tip_diameter", "tip_form_diameter",
        "active_tip_diameter", "hpstc_diameter", "lpstc_diameter", "active_root_diameter", "root_form_diameter",
        "back_root_form_diameter", "root_diameter",
    )),
    ("Measurement", (
        "tooth_thickness", "tip_thickness", "span_teeth", "span", "ball_diameter", "over_balls", "over_pins",
        "chordal_thickness", "chordal_height",
    )),
    ("Modifications", MODIFICATIONS),
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
        table = pair_table(name, drawing)
        blocks = _blocks(table, pair_values(name, drawing), written, _loaded(results, name))
        sections.append(Section(f"Gear data: pair {name}", (*blocks, Plot(pair_figure(name, drawing)))))
    lone = lone_table(drawing)
    if lone is not None:
        sections.append(Section("Gear data", _blocks(lone, (), written)))
    if bodies := body_figures(drawing.gears):
        sections.append(Section("Gear bodies", tuple(map(Plot, bodies))))
    return tuple(sections)


#: Values of the result ``rating`` that the data sheet shows, in its order.
_SHOWN = {
    "S_H": "safety factor for pitting S_H, ISO 6336",
    "S_H_computed": "S_H, FE load distribution",
    "S_H_spectrum": "S_H, load spectrum",
    "S_H_agma": "S_H, AGMA 2101",
    "S_F": "safety factor for tooth breakage S_F, ISO 6336",
    "S_F_computed": "S_F, FE root stress",
    "S_F_spectrum": "S_F, load spectrum",
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
    groups = (SheetGroup("Rating (load capacity)", rated_columns(results.values, name)),)
    return tuple(group for group in groups if group.columns)


def _blocks(
    table: Table, values: Sequence[Value], written: set[str], more: Sequence[SheetGroup] = ()
) -> tuple[Block, ...]:
    columns = {column.name: column for column in table.columns}
    heads = MEMBERS if values else tuple("" for _ in columns["gear"].values)
    groups = [SheetGroup(title, tuple(columns[name] for name in names if name in columns)) for title, names in _GROUPS]
    shared = tuple((value.meaning, value_cells(value)[0], value.unit) for value in values)
    sheet = Sheet(heads, (*(group for group in groups if group.columns), *more), shared)
    note = "" if table.name in written else 'The table is written with results = ["geometry"].'
    if note:
        return sheet, Paragraph(note, "note screen")
    return sheet, Download(f"tables/{table_file(table)}")
