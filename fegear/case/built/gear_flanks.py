"""What a case says of the profiles of a gear and of how its teeth stand: reliefs, tables, spacing errors."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from fegear.base.effects import RELIEF, SPACING_ERRORS
from fegear.base.errors import InputError
from fegear.case.part import Part, at
from fegear.contact.pair_spec import FlankSpec
from fegear.geometry.plausible_flanks import refuse_spacing_errors
from fegear.geometry.relief import TabulatedRelief, roll_as_given, roll_of_radius
from fegear.geometry.relief_spec import CrowningSpec, ReliefSpec, RootReliefSpec, TipReliefSpec

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.case.odd_tooth import OddToothPart
    from fegear.case.reading import Scene
    from fegear.case.relief import ReliefPart, ReliefTablePart
    from fegear.contact.odd_flank import ToothProfile
    from fegear.geometry.gear import Gear

_S = TypeVar("_S")


def gear_flanks(scene: Scene, gear: str, *, drawn: bool = False, back: bool = False) -> FlankSpec:
    """What a case says of the profiles and the spacing of a gear; data of effects that are off may be wrong.

    Parameters
    ----------
    scene : Scene
    gear : str
    drawn : bool
        Whether the relief is wanted that is drawn, where another one is measured.
    back : bool
        Whether the flanks that are not loaded are wanted; of equal flanks they are the same.
    """
    part, effects = scene.case.gear[gear], scene.case.effects
    seen = scene.gears[gear].from_the_back if back else scene.gears[gear]
    given, key = part.relief_of(seen.tooth.working_flank), relief_key(seen)
    written = scene.written.get(gear, gear)
    relief: ReliefSpec | None = None
    spacing, wrong, measured = np.empty(0), {}, False
    if given is not None:
        relief = _ends(given)
    try:
        if not drawn and part.measured_of(seen.tooth.working_flank)[0] is not None:
            from fegear.case.built.measured_flanks import measured_gear

            found = measured_gear(scene, gear)
            if found.topography is not None:
                relief = None
            elif found.relief is not None:
                relief, measured = ReliefSpec(tables=(found.relief,)), True
        if relief is not None and not measured:
            tables = given.table if given is not None else ()
            relief = replace(relief, tables=_tables(scene, seen, tables, f"gear.{written}.{key}.table"))
    except InputError as error:
        if effects.relief:
            raise
        wrong[RELIEF.name] = error
    try:
        spacing = _spacing_errors(scene, gear)
    except InputError as error:
        if effects.spacing_errors:
            raise
        wrong[SPACING_ERRORS.name] = error
    return FlankSpec(relief, spacing, gear=gear, written=written, key=key, measured=measured, wrong=wrong)


def _ends(given: ReliefPart) -> ReliefSpec:
    """A relief without its tables."""
    return ReliefSpec(
        tuple(_spec(TipReliefSpec, tip) for tip in given.tip),
        tuple(_spec(RootReliefSpec, root) for root in given.root),
        tuple(_spec(CrowningSpec, crown) for crown in given.crowning),
    )


def _tables(scene: Scene, gear: Gear, tables: Sequence[ReliefTablePart], key: str) -> tuple[TabulatedRelief, ...]:
    return tuple(_table_relief(scene, gear, table, f"{key}[{i}]") for i, table in enumerate(tables))


def tooth_profile(scene: Scene, name: str, part: OddToothPart, prefix: str) -> ToothProfile:
    """The profile of one tooth that is another than its gear's.

    Raises
    ------
    InputError
        If a table is none.
    """
    gear, relief, deviation = scene.gears[name], None, None
    if part.relief is not None:
        relief = replace(_ends(part.relief), tables=_tables(scene, gear, part.relief.table, f"{prefix}.relief.table"))
    if part.deviation:
        deviation = ReliefSpec(tables=_tables(scene, gear, part.deviation, f"{prefix}.deviation"))
    from fegear.contact.odd_flank import ToothProfile  # late: few gears have odd teeth

    return ToothProfile(relief, deviation, prefix)


def relief_key(gear: Gear) -> str:
    """The key of the relief of the flanks that a gear is seen from."""
    return "coast_relief" if gear.tooth.working_flank == "coast" else "relief"


def _spec(kind: type[_S], part: Part) -> _S:
    """A spec of the keys of the same names."""
    values: dict[str, Any] = {one.name: getattr(part, one.name) for one in fields(kind)}  # type: ignore[arg-type]  # specs are dataclasses
    return kind(**values)


def _table_relief(scene: Scene, gear: Gear, part: ReliefTablePart, key: str) -> TabulatedRelief:
    if part.file is not None:
        from fegear.case.csv_file import one_column, read_columns

        columns = read_columns(
            scene.file(part.file, f"{key}.file"), f"{key}.file",
            {"roll_angle": "angle", "radius": "length", "relief": "length"},
        )  # fmt: skip
        if "relief" not in columns or not ("roll_angle" in columns or "radius" in columns):
            rule = f"requires the columns relief and roll_angle or radius; it has {columns.has}"
            raise InputError(f"{key}.file", f'"{part.file}"', rule)
        one_column(columns, ("roll_angle", "radius"), f"{key}.file", part.file)
        values = columns["relief"]
        roll = (
            roll_as_given(gear, columns["roll_angle"])
            if "roll_angle" in columns
            else _rolls(gear, columns["radius"], key)
        )
    else:
        values = np.array(part.removals)
        roll = (
            roll_as_given(gear, np.array(part.roll_angles))
            if part.roll_angles
            else _rolls(gear, np.array(part.radii), key)
        )
    order = np.argsort(roll)
    return TabulatedRelief(roll[order], values[order], part.interpolation)


def _rolls(gear: Gear, radii: Array, key: str) -> Array:
    if (radii < gear.base_radius).any():
        raise InputError(f"{key}.radii", f"{radii.min() * 1e3:.6g} mm", "lies inside the base circle")
    return roll_of_radius(gear, radii)


def _spacing_errors(scene: Scene, gear: str) -> Array:
    """Spacing error of each tooth of a gear [m]; empty for none."""
    part, key = scene.case.gear[gear].spacing_errors, f"gear.{scene.written.get(gear, gear)}.spacing_errors"
    if part is None:
        return np.empty(0)
    if part.values is not None:
        errors = np.array(part.values)
    else:
        from fegear.case.csv_file import read_columns

        columns = read_columns(scene.file(part.file or "", f"{key}.file"), f"{key}.file", {"spacing_error": "length"})
        if "spacing_error" not in columns:
            raise InputError(f"{key}.file", f'"{part.file}"', f"has no column spacing_error; it has {columns.has}")
        errors = columns["spacing_error"]
    teeth, module = scene.gears[gear].teeth, scene.gears[gear].module
    if errors.size != teeth:
        raise InputError(key, f"{errors.size} errors", f"must be one for each of the {teeth} teeth")
    try:
        refuse_spacing_errors(errors, module)
    except InputError as error:
        raise at(f"gear.{gear}", error) from None
    return errors
