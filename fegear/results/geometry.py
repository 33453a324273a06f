"""Stage ``geometry``: the numbers of every gear and pair that a drawing would carry."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Column, Outcome, Table
from fegear.engine.stage import Forecast, Stage
from fegear.geometry import interference
from fegear.results.drawn_pair import pair_figure
from fegear.results.gear_data import (
    Drawing,
    drawing_of,
    lone_table,
    measurement_columns,
    pair_table,
    pair_values,
    unmeasured_remarks,
)
from fegear.results.sources import INVOLUTE

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def _everything(scene: Scene) -> tuple[str, ...]:
    return ("",) if scene.gears else ()


def _present(_found: Drawing, drawing: Drawing) -> Outcome:
    gears, pairs = drawing.gears, drawing.pairs
    names = list(gears)
    measures = {column.name: column for column in measurement_columns(drawing, names)}

    def column(name: str, attribute: str, meaning: str) -> Column:
        values = np.array([getattr(gear, attribute) for gear in gears.values()])
        return Column(name, values, "mm", meaning)

    table = Table(
        "geometry",
        (
            Column("gear", np.array(names), "", "name of the gear"),
            Column("teeth", np.array([gear.teeth for gear in gears.values()]), "", "number of teeth"),
            column("module", "module", "module"),
            column("tip_radius", "tip_radius", "tip circle"),
            column("involute_tip_radius", "involute_tip_radius", "where the involute ends"),
            column("pitch_radius", "pitch_radius", "pitch circle"),
            column("base_radius", "base_radius", "base circle"),
            column("form_radius", "form_radius", "where the involute starts"),
            column("root_radius", "root_radius", "root circle"),
            column("bore_radius", "bore_radius", "radius at which the body is held"),
            column("face_width", "face_width", "face width"),
            *(measures[name] for name in ("span_teeth", "span", "ball_diameter", "over_balls")),
            *(measures[name] for name in ("tooth_thickness", "tip_thickness")),
        ),
        "Gears",
        printed=True,
    )
    values = tuple(value for name, pair in pairs.items() for value in pair_values(name, pair))
    remarks = tuple(
        f"Pair {name}: the contact ratio of {pair.total_contact_ratio:.4f} is below 1: no teeth are on the path at "
        "some roll positions. Lengthen the teeth, raise their number or lower the centre distance."
        for name, pair in pairs.items()
        if pair.total_contact_ratio < 1.0
    )
    remarks += tuple(
        f"Pair {name}: {sentence}."
        for name, pair in pairs.items()
        for sentence in (interference(pair, "driver").sentence, interference(pair, "driven").sentence)
        if sentence
    )
    lone = lone_table(drawing)
    tables = (table, *(pair_table(name, drawing) for name in pairs), *(() if lone is None else (lone,)))
    figures = tuple(pair_figure(name, drawing) for name in pairs)
    return Outcome(drawing, tables, values, {}, (*remarks, *unmeasured_remarks(drawing)), figures)


GEOMETRY = Stage(
    subjects=_everything,
    inputs=lambda scene, _subject: drawing_of(scene),
    compute=lambda drawing, _upstream, _work: drawing,
    present=_present,
    cites=citing(INVOLUTE, Citation("iso-53", "standard basic racks", "Table 1")),
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
)
