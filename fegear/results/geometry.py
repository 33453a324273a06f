"""Stage ``geometry``: the numbers of every gear and pair that a drawing would carry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.geometry import interference
from fegear.geometry.span import span, span_teeth
from fegear.results.sources import INVOLUTE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.geometry import Gear, GearPair


def _everything(scene: Scene) -> tuple[str, ...]:
    return ("",) if scene.gears else ()


def _pair_values(name: str, pair: GearPair) -> tuple[Value, ...]:
    return (
        Value(f"{name}.contact_ratio", pair.contact_ratio, "", 0.0, "transverse contact ratio"),
        Value(f"{name}.centre_distance", pair.centre_distance, "mm", 0.0, "working centre distance"),
        Value(f"{name}.working_pressure_angle", pair.working_pressure_angle, "deg", 0.0, "working pressure angle"),
        Value(f"{name}.path_length", pair.path_length, "mm", 0.0, "length of the path of contact"),
        Value(f"{name}.base_pitch", pair.base_pitch, "mm", 0.0, "base pitch"),
        Value(f"{name}.normal_backlash", pair.normal_backlash, "mm", 0.0, "backlash along the line of action"),
    )


@dataclass(frozen=True)
class Drawing:
    """Everything that a drawing would carry: gears and pairs by name."""

    gears: Mapping[str, Gear]
    pairs: Mapping[str, GearPair]


def _present(_found: Drawing, drawing: Drawing) -> Outcome:
    gears, pairs = drawing.gears, drawing.pairs

    def column(name: str, attribute: str, meaning: str) -> Column:
        values = np.array([getattr(gear, attribute) for gear in gears.values()])
        return Column(name, values, "mm", meaning)

    counts = [span_teeth(gear) for gear in gears.values()]
    spans = [span(gear, count) for gear, count in zip(gears.values(), counts, strict=True)]
    table = Table(
        "geometry",
        (
            Column("gear", np.array(list(gears)), "", "name of the gear"),
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
            Column("span_teeth", np.array(counts), "", "k, teeth of the span measurement"),
            Column("span", np.array(spans), "mm", "base tangent length W_k over them, allowance included"),
        ),
        "Gears",
    )
    values = tuple(value for name, pair in pairs.items() for value in _pair_values(name, pair))
    remarks = tuple(
        f"Pair {name}: {sentence}."
        for name, pair in pairs.items()
        for sentence in (interference(pair, "driver").sentence, interference(pair, "driven").sentence)
        if sentence
    )
    return Outcome(drawing, (table,), values, {}, remarks)


GEOMETRY = Stage(
    name="geometry",
    title="Geometry",
    results=("geometry",),
    subjects=_everything,
    inputs=lambda scene, _subject: Drawing(scene.gears, scene.pairs),
    compute=lambda drawing, _upstream, _work: drawing,
    present=_present,
    cites=citing(INVOLUTE, Citation("iso-53", "standard basic racks", "Table 1")),
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
)
