"""From a case's pair to the spec of the mechanics: its gears, loads and effects, and whatever its files hold."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fegear.base.effects import EFFECTS, PAIR_EFFECTS, ROOT_EFFECTS
from fegear.base.errors import InputError
from fegear.case.built.gear_flanks import gear_flanks
from fegear.case.built.members import gear_name
from fegear.case.part import at
from fegear.contact.pair_spec import ComplianceTable, PairSpec
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def pair_spec(scene: Scene, name: str, *, over_face: bool = False) -> PairSpec:
    """Collect what a case says of a loaded pair, plane or with its width.

    Parameters
    ----------
    scene : Scene
    name : str
    over_face : bool
        Whether it is loaded with its width although its other results take plane teeth, as spur gears are.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for.
    """
    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    width = scene.width_of(name)
    if over_face and width == "plane":
        width = "solid"
    driver, driven = (gear_flanks(scene, gear_name(scene, name, member)) for member in MEMBERS)
    counted: dict[str, Any] = {}
    for row in (EFFECTS[effect] for effect in (*PAIR_EFFECTS, *ROOT_EFFECTS)):
        counted[row.name] = getattr(effects, row.name) if (row.plane if width == "plane" else row.wide) else row.off
    spec = PairSpec(
        pair, part.all_loads(pair), part.normal_load(pair) or math.nan, width, part.compliance.source,
        driver=driver, driven=driven, name=name, **counted,
    )  # fmt: skip
    if width == "plane":
        table = pair_compliance_table(scene, name) if part.compliance.source == "table" else None
        return replace(spec, table=table)
    return _with_face(scene, spec)


def _with_face(scene: Scene, spec: PairSpec) -> PairSpec:
    """The spec with what teeth with a width have besides, whose modules plane teeth do without."""
    from fegear.case.built.flank_errors import cutter_modification, flank_errors
    from fegear.case.built.flank_modifications import with_face
    from fegear.contact.wide_spec import WideSpec

    name, divided = spec.name, scene.case.load_distribution
    wide = WideSpec(
        flank_errors(scene, name), cutter_modification(scene, name), divided.positions, divided.panels or 0,
        divided.base_pitch,
    )  # fmt: skip
    return replace(spec, driver=with_face(scene, spec.driver), driven=with_face(scene, spec.driven), wide=wide)


def pair_compliance_table(scene: Scene, name: str) -> ComplianceTable:
    """Positions [m] and compliances [m/N] of the file that a pair names.

    Raises
    ------
    InputError
        If it has not the columns, both kinds of positions or of compliances, or is none of this pair's teeth.
    """
    from fegear.case.csv_file import one_column, read_columns
    from fegear.contact.plane.table_compliance import refuse_table

    part, pair = scene.case.pair[name].compliance, scene.pairs[name]
    key = f"pair.{name}.compliance.file"
    dimensions = {
        "x": "length", "roll_angle": "angle", "compliance": "compliance", "load": "force", "deflection": "length"
    }  # fmt: skip
    columns = read_columns(scene.file(part.file or "", key), key, dimensions)
    if "compliance" in columns:
        if "deflection" in columns:
            raise InputError(key, f'"{part.file}"', "has both compliance and deflection", "remove one of the columns")
        c = columns["compliance"]
    elif "load" in columns and "deflection" in columns:
        if not (columns["load"] > 0.0).all():
            raise InputError(key, f'"{part.file}"', "contains a load that is not positive: compliance is undefined")
        c = columns["deflection"] / columns["load"]
    else:
        raise InputError(key, f'"{part.file}"', "has neither a column compliance nor load and deflection")
    place = one_column(columns, ("x", "roll_angle"), key, part.file)
    x = columns[place]
    if place == "roll_angle":
        rb = pair.driver.base_radius
        x = x * rb - rb * math.tan(pair.working_pressure_angle)
    try:
        refuse_table(pair, x, c, part.of or "tooth", part.fit or "cubic")
    except InputError as error:
        raise at(f"pair.{name}", error) from None
    return ComplianceTable(x, c, part.of or "tooth", part.fit or "cubic")
