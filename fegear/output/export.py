"""``fegear export``: drawings, reliefs to grind and meshes of the gears of a case.

The relief of a gear for who grinds it: a fine table over the profile, and the points of its profile chart.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.flank_modifications import described_relief
from fegear.case.built.pair_inputs import gear_name
from fegear.case.built.tooth_influence import mesh_settings, own_sector_mesh
from fegear.case.nearest import nearest
from fegear.engine.table import Column, Table
from fegear.geometry.outline import relieved_outline
from fegear.geometry.pair import MEMBERS, active_profile
from fegear.geometry.relief import Relief, chart_points, roll_of_radius
from fegear.output.dxf import AS_GENERATED, write_dxf
from fegear.output.file_names import file_name
from fegear.output.formats import FORMATS, Format, of_kind
from fegear.output.formats import formats as every_format
from fegear.output.tables import write_table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.exchange.rexs.written import Found
    from fegear.studies.comparison.compare import Side


#: Those that hold the flanks with their relief, a mesh of the solid gear, no single gear, the mesh of a spur gear.
_EXACT, _SOLID = of_kind("flanks"), of_kind("solid mesh")
_WHOLE, _PLANE = of_kind("case"), of_kind("plane mesh")


#: What takes so many seconds is predicted before it starts.
_LONG = 5.0


@dataclass(frozen=True, slots=True)
class Exported:
    """Files of an export and what they leave out.

    Parameters
    ----------
    files : tuple of str
        Names of the files.
    remarks : tuple of str
        Sentences for the user.
    """

    files: tuple[str, ...]
    remarks: tuple[str, ...]


def export_gears(
    scene: Scene,
    folder: Path,
    names: Sequence[str],
    formats: str,
    results: Side | None = None,
    say: Callable[[str], None] = lambda _line: None,
) -> Exported:
    """Write every format of every named gear.

    Drawings and solid models hold the flanks with the relief that the case gives them, ``relief`` holds it as tables,
    whether or not the effect ``relief`` counts it; meshes hold the generated flanks, because relief enters fegear's own
    contact as a distance, not as a change of the mesh. A helical gear is drawn in its section across the axis; its
    plane mesh would be no gear and is left out.

    Parameters
    ----------
    scene : Scene
    folder : Path
    names : sequence of str
        Gears of the scene; none for all of them.
    formats : str
        Formats separated by commas.
    results : Side, optional
        Of a run of the case, which go into a REXS model.
    say : callable, optional
        Called with a sentence before what takes long.

    Raises
    ------
    InputError
        If a gear or a format is unknown, or nothing can be written because all gears are helical or there is none.
    """
    wanted = {part.strip() for part in formats.split(",") if part.strip()}
    others = {name: every_format()[name] for name in sorted(wanted.difference(FORMATS)) if name in every_format()}
    for one in sorted(wanted.difference(FORMATS, others)):
        raise InputError("--format", f'"{one}"', "is no format that fegear writes", nearest(one, every_format()))
    if not wanted:
        raise InputError("--format", f'"{formats}"', "names no format", f"choose from {', '.join(FORMATS)}")
    every = list(scene.gears)
    if not every:
        raise InputError("gear", "(not given)", "is missing: the case describes no gear to export", "add [gear.NAME]")
    for name in names:
        if name not in every:
            raise InputError("--gear", f'"{name}"', "is no gear of this case", nearest(name, every))
    chosen = list(names or every)
    helical = [name for name in chosen if name not in scene.spur_gears]
    plane = ", ".join(sorted(wanted.intersection(_PLANE)))
    if len(helical) == len(chosen) and wanted <= _PLANE:
        which = "is helical" if len(helical) == 1 else "are helical"
        raise InputError(
            "--gear", ", ".join(helical), which, f"{plane} hold plane meshes of spur gears; write dxf or step"
        )
    written: list[Path] = []
    remarks = [f"Gear {name} is helical: no {plane} is written for it." for name in helical if plane]
    for name in chosen if wanted - _WHOLE - set(others) else ():
        files, left_out = _export_gear(scene, folder, name, wanted, say)
        written += files
        remarks += left_out
    if "fmu" in wanted:
        files, said = _export_meshes_in_motion(scene, folder)
        written += files
        remarks += said
    if "rexs" in wanted:
        from fegear.exchange.rexs.written_gearbox import model_text

        date = datetime.now(UTC).isoformat(timespec="seconds")
        text, left = model_text(scene, date, *(() if results is None else (_found(results),)))
        written.append(folder / f"{file_name(scene.name)}.rexs")
        written[-1].write_text(text, "utf-8")
        remarks += left
    for name, other in others.items():
        files, said = _by_another(name, other, scene, folder, chosen)
        written += files
        remarks += said
    if not written:
        raise InputError(
            f"gear.{chosen[0]}.relief", "(not given)", "leaves no relief to write: no gear has one of known amount",
            'give one: relief = { tip = { amount = "10 um", length = "2 mm" } }',
        )  # fmt: skip
    return Exported(tuple(path.name for path in written), tuple(remarks))


def _by_another(name: str, other: Format, scene: Scene, folder: Path, gears: list[str]) -> tuple[list[Path], list[str]]:
    """Files of a format that another distribution writes."""
    if other.write is None:
        raise InputError("--format", f'"{name}"', "has nothing that writes it", "give its Format a write function")
    files, said = other.write(scene, folder, tuple(gears))
    outside = [path for path in files if not (path.is_file() and path.resolve().is_relative_to(folder.resolve()))]
    if outside:
        rule = f"names {outside[0]}, which is no file in the folder of the export"
        raise InputError("--format", f'"{name}"', rule, "write below the folder that write() is given")
    return list(files), list(said)


def _found(results: Side) -> Found:
    """What a run found, for a REXS model: numbers that are known, and of tables the columns of such and of names."""
    from fegear.exchange.rexs.written import Found

    tables = {
        name: {one.name: one.si for one in table.columns if one.si.dtype.kind != "f" or bool(np.isfinite(one.si).all())}
        for name, table in results.tables.items()
    }
    return Found({name: value.si for name, value in results.values.items() if np.isfinite(value.si)}, tables)


def _export_gear(
    scene: Scene, folder: Path, name: str, wanted: set[str], say: Callable[[str], None]
) -> tuple[list[Path], list[str]]:
    """Write the wanted formats of a gear: files, and remarks on its relief."""
    found = described_relief(scene, name)
    relieved = scene.case.gear[name].relief is not None
    written: list[Path] = []
    remarks = []
    gear = scene.gears[name]
    exact = f"Gear {name}, {', '.join(sorted(wanted & _EXACT)).upper()}"
    if wanted & _EXACT and found.pair:
        remarks.append(f"{exact}: relief as in pair {found.pair}; in other pairs it would end elsewhere.")
    if wanted & _EXACT and found.left_out:
        remarks.append(f"{exact}: flanks without relief, because {found.left_out}.")
    if "dxf" in wanted:
        flanks = AS_GENERATED if found.relief is None else "with the relief of the case, both flanks"
        flanks += f", as in pair {found.pair}" if found.pair else ""
        if name not in scene.spur_gears:
            remarks.append(f"Gear {name}, DXF: the section across the axis.")
        written += write_dxf(gear, folder, file_name(name), found.relief, flanks)
    if "step" in wanted:
        from fegear.fem.solid.step_model import seconds_of_step, write_step

        if (predicted := seconds_of_step(gear.teeth)) >= _LONG:
            say(f"Gear {name}, STEP: about {predicted:.0f} s of CPU time for {gear.teeth} teeth.")
        written.append(folder / f"{file_name(name)}.step")
        write_step(written[-1], gear, None if found.relief is None else relieved_outline(gear, found.relief))
        if scene.case.gear[name].face_width is None:
            remarks.append(f"Gear {name}, STEP: {gear.face_width * 1e3:.6g} mm wide, for the case has no face_width.")
        if scene.case.gear[name].body is not None:
            remarks.append(f"Gear {name}, STEP: a disc as wide as the face; its body is to be cut from it in CAD.")
    if "relief" in wanted and found.relief is not None:
        written += write_relief(scene, folder, name, found.relief)
    elif "relief" in wanted and not relieved:
        remarks.append(f"Gear {name}, RELIEF: the case gives it none, so there is no table.")
    meshes, left_out = _export_meshes(scene, folder, name, wanted)
    return [*written, *meshes], [*remarks, *left_out, *_left_out(scene, name)]


def _export_meshes_in_motion(scene: Scene, folder: Path) -> tuple[list[Path], list[str]]:
    """Write the FMU of every loaded pair."""
    from fegear.output.fmu import c_compiler, mesh_models, write_fmu

    c_compiler()  # before anything is solved
    models = mesh_models(scene)
    return [write_fmu(folder, model) for model, _ in models], [said for _, said in models]


def _export_meshes(scene: Scene, folder: Path, name: str, wanted: set[str]) -> tuple[list[Path], list[str]]:
    """Write the wanted meshes of a gear."""
    gear = scene.gears[name]
    written: list[Path] = []
    meshes = wanted.intersection(_PLANE if name in scene.spur_gears else ()) | (wanted & _SOLID)
    if not meshes:
        return [], []
    settings, mesh = mesh_settings(scene.case.accuracy), own_sector_mesh(scene, name)
    if plane := meshes & _PLANE:
        from fegear.output.mesh_export import write_meshes

        written += write_meshes(gear, folder, file_name(name), plane, settings, mesh)
    solid = meshes & _SOLID
    if solid and gear.tooth.internal:
        return written, [f"Gear {name} is internal: no {', '.join(sorted(solid))} is written for it."]
    if solid:
        from fegear.output.mesh_export import write_solid

        written += write_solid(gear, folder, file_name(name), solid, mesh=mesh)
    if scene.case.gear[name].relief is None:
        return written, []
    told = ", ".join(sorted(meshes))
    return written, [f"Gear {name}, {told}: flanks as generated, without the relief of the case."]


def _left_out(scene: Scene, name: str) -> list[str]:
    """What no format holds of a gear's teeth: modifications over the face, spacing errors."""
    part, remarks = scene.case.gear[name], []
    if part.over_face:
        given = " and ".join(part.over_face)
        remarks.append(f"Gear {name}: flanks the same all along the face, without {given} of the case.")
    if part.spacing_errors is not None:
        remarks.append(f"Gear {name}: teeth evenly spaced, without the spacing errors of the case.")
    return remarks


#: Places of the fine table, and how far the relief may lie from the lines between points of the chart [m].
_PLACES, _WITHIN = 101, 1e-7


def write_relief(scene: Scene, folder: Path, name: str, relief: Relief) -> list[Path]:
    """Write the relief of a gear as two CSV files, its profile from the start to the end of the involute.

    Parameters
    ----------
    scene : Scene
    folder : Path
    name : str
        Of the gear.
    relief : Relief

    Returns
    -------
    list of Path
        ``<gear>_relief.csv`` at even roll angles and kinks, ``<gear>_k_chart.csv`` with the chart's points.
    """
    return [write_table(folder, table) for table in relief_tables_of(scene, name, relief)]


def relief_tables_of(scene: Scene, name: str, relief: Relief) -> tuple[Table, Table]:
    """The fine table and that of the profile chart."""
    gear = scene.gears[name]
    low, high = (float(roll_of_radius(gear, r)) for r in (gear.form_radius, gear.involute_tip_radius))
    named = {low: "start of involute", high: "end of involute"}
    for pair_name, pair in scene.pairs.items():
        for member in MEMBERS:
            if gear_name(scene, pair_name, member) == name:
                alone = active_profile(pair, member)
                for end, radius in (("start", alone.start), ("end", alone.end)):
                    roll = float(roll_of_radius(gear, radius))
                    if low + 1e-9 < roll < high - 1e-9:
                        named.setdefault(roll, f"{end} of active profile, pair {pair_name}")
    chart = chart_points(relief, low, high, _WITHIN, tuple(named))
    words = [next((word for at, word in named.items() if abs(at - roll) < 1e-12), "") for roll in chart]
    kinks = [kink for kink in relief.kinks if low < kink < high]
    fine = np.unique(np.concatenate([np.linspace(low, high, _PLACES), kinks]))
    stem, base = file_name(name), gear.base_radius
    point = Column("point", np.array(words), "", "end of the involute or of an active profile; empty: the relief bends")
    return (
        Table(f"{stem}_relief", _columns(base, fine, relief), f"Relief of gear {name}"),
        Table(f"{stem}_k_chart", (point, *_columns(base, chart, relief)), f"Profile chart of gear {name}"),
    )


def _columns(base: float, roll: Array, relief: Relief) -> tuple[Column, ...]:
    return (
        Column("diameter", 2.0 * base * np.hypot(1.0, roll), "mm", "of the flank point"),
        Column("roll_angle", roll, "deg", "of the gear"),
        Column("roll_length", base * roll, "mm", "along the line of action, from the base circle"),
        Column("removal", relief.removal(roll), "um", "along the normal of the involute, from the involute"),
    )
