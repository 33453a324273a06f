"""``fegear export``: drawings, reliefs to grind, meshes and models of a case, each by the row of its format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.extensions import Added
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.flank_modifications import described_relief
from fegear.case.built.rack import rack_pinion
from fegear.case.nearest import nearest
from fegear.output.export_formats import FORMATS, Format, Request, added_formats

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from fegear.case.reading import Scene
    from fegear.output.export_formats import Holds
    from fegear.studies.comparison.compare import Side

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


def wanted_formats(text: str) -> Mapping[str, Format]:
    """Formats by their names, which commas separate: those of fegear in their order, then those of others.

    Raises
    ------
    InputError
        If one is unknown, or none is named.
    """
    wanted = {part.strip() for part in text.split(",") if part.strip()}
    others = Added[Format]({}, {}, {}) if wanted <= FORMATS.keys() else added_formats()
    known = {**FORMATS, **others.found}
    for name in sorted(wanted.difference(known)):
        others.refuse_broken(name)
        raise InputError("--format", f'"{name}"', "is not a supported format", nearest(name, known))
    if not wanted:
        raise InputError(
            "--format", f'"{text}"', "must contain at least one format", f"choose from {', '.join(FORMATS)}"
        )
    return {name: row for name, row in known.items() if name in wanted}


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
        Gears and racks of the scene; none for all of them.
    formats : str
        Formats separated by commas.
    results : Side, optional
        Of a run of the case, for formats that take them.
    say : callable, optional
        Called with a sentence before what takes long.

    Raises
    ------
    InputError
        If a gear or a format is unknown, something that a format needs is not installed, or nothing can be written
        because all gears are helical or there is none.
    """
    wanted = wanted_formats(formats)
    racks = _racks(scene, names, wanted)
    chosen = [] if names and set(names) <= set(racks) else _chosen(scene, [one for one in names if one not in racks])
    plane, of_gears = _of(wanted, "plane mesh"), [name for name, row in wanted.items() if row.holds != "case"]
    helical = [name for name in chosen if name not in scene.spur_gears]
    if chosen and len(helical) == len(chosen) and plane and len(plane) == len(wanted):
        spur = "a spur gear" if len(helical) == 1 else "spur gears"
        others = " or ".join(name for name, row in FORMATS.items() if row.holds == "flanks")
        rule = f"must be {spur} for {', '.join(sorted(plane))} (plane meshes)"
        raise InputError("--gear", ", ".join(helical), rule, f"use {others}")
    _refuse_asymmetric(scene, chosen, wanted)
    for row in wanted.values():
        row.require()
    written: list[Path] = []
    remarks = [f"Gear {name} is helical: no {', '.join(sorted(plane))} is written for it." for name in helical if plane]

    def write(name: str, gears: Sequence[str], cache: SolutionCache, *, rack: bool = False) -> None:
        request = Request(scene, folder, tuple(gears), results, cache)
        files, said = wanted[name].written_rack(request) if rack else wanted[name].written(request)
        written.extend(_inside(files, name, folder))
        remarks.extend(said)

    for gear in chosen if of_gears else ():
        cache = SolutionCache()
        fitting = [name for name in of_gears if _fits(wanted[name].holds, scene, gear)]
        remarks += _of_relief(scene, gear, _of(wanted, "flanks"))
        for name in fitting:
            if (predicted := wanted[name].predicted(scene.gears[gear])) >= _LONG:
                teeth = scene.gears[gear].teeth
                say(f"Gear {gear}, {name.upper()}: about {predicted:.0f} s of CPU time for {teeth} teeth.")
            write(name, (gear,), cache)
        remarks += _left_out(scene, gear, wanted, fitting)
    for rack in racks:
        cache, holding = SolutionCache(), _of_rack(scene, rack, wanted)
        for name in holding:
            write(name, (rack,), cache, rack=True)
        remarks += _left_out_of_rack(scene, rack, wanted, [name for name in of_gears if name not in holding])
    for name in _of(wanted, "case") if chosen else ():
        write(name, chosen, SolutionCache())
    if not written and "relief" not in wanted:
        rule = f"wrote nothing: {remarks[0].rstrip('.')}" if remarks else "wrote no file and no message"
        raise InputError("--format", f'"{formats}"', rule, "choose another format")
    if not written:
        raise InputError(
            f"gear.{chosen[0]}.relief", "(not given)", "has nothing to write: no gear has a relief of known amount",
            'specify one: relief = { tip = { amount = "10 um", length = "2 mm" } }',
        )  # fmt: skip
    return Exported(tuple(path.name for path in written), tuple(remarks))


def _chosen(scene: Scene, names: Sequence[str]) -> list[str]:
    """The gears that are asked for."""
    every = [name for name in scene.gears if name not in scene.written]  # both flanks of a gear are in one file
    if not every:
        raise InputError("gear", "(not given)", "is required for export", "add [gear.NAME]")
    for name in names:
        if name not in every:
            known = [*every, *scene.case.rack]
            raise InputError("--gear", f'"{name}"', "is not a gear of this case", nearest(name, known))
    return list(names or every)


def _racks(scene: Scene, names: Sequence[str], wanted: Mapping[str, Format]) -> list[str]:
    """The racks that are asked for: those that are named, all of them where nothing is and a format holds racks."""
    held = [name for name, row in FORMATS.items() if row.racks]
    some = any(row.racks for row in wanted.values())
    if not names:
        return list(scene.case.rack) if some else []
    found = [name for name in names if name in scene.case.rack and name not in scene.gears]
    if found and not some:
        raise InputError("--format", f'"{", ".join(wanted)}"', f"is not available for rack {found[0]}",
                         f"use {', '.join(held)}")  # fmt: skip
    return found


def _refuse_asymmetric(scene: Scene, chosen: Sequence[str], wanted: Mapping[str, Format]) -> None:
    """Refuse formats that hold teeth with equal flanks only."""
    gear = next((name for name in chosen if scene.gears[name].asymmetric), None)
    other = next((name for name, row in wanted.items() if not row.asymmetric), None)
    if gear is not None and other is not None:
        held = ", ".join(name for name, row in FORMATS.items() if row.asymmetric)
        raise InputError(
            "--format", f'"{other}"', f"is not available for the asymmetric teeth of gear {gear}", f"use {held}"
        )


def _of_rack(scene: Scene, rack: str, wanted: Mapping[str, Format]) -> list[str]:
    """Formats that are written for a rack: those that hold racks, plane meshes of spur racks only."""
    helical = bool(scene.gears[rack_pinion(scene, rack)].helix_angle)
    return [name for name, row in wanted.items() if row.racks and not (helical and row.holds == "plane mesh")]


def _left_out_of_rack(scene: Scene, rack: str, wanted: Mapping[str, Format], unwritten: Sequence[str]) -> list[str]:
    """What is not written for a rack, and what its meshes do not hold."""
    plane = sorted(name for name in unwritten if wanted[name].racks)
    others = sorted(name for name in unwritten if not wanted[name].racks)
    meshes = sorted(name for name, row in wanted.items() if row.holds.endswith("mesh") and name not in unwritten)
    said = [f"Rack {rack} is helical: no {', '.join(plane)} is written for it."] if plane else []
    said += [f"Rack {rack}: no {', '.join(others)} is written for racks."] if others else []
    if meshes and scene.case.rack[rack].tip_relief:
        said.append(f"Rack {rack}, {', '.join(meshes)}: flanks as generated, without the tip relief of the case.")
    return said


def _of(wanted: Mapping[str, Format], holds: Holds) -> list[str]:
    """Names of the formats of a kind."""
    return [name for name, row in wanted.items() if row.holds == holds]


def _fits(holds: Holds, scene: Scene, gear: str) -> bool:
    """Whether formats of a kind are written for a gear."""
    if holds == "plane mesh":
        return gear in scene.spur_gears
    return holds != "solid mesh" or not scene.gears[gear].tooth.internal


def _inside(files: Sequence[Path], name: str, folder: Path) -> Sequence[Path]:
    """The files that a format says it wrote, if they are files of the export."""
    for path in files:
        if not (path.is_file() and path.resolve().is_relative_to(folder.resolve())):
            rule = f"names {path}, which is not a file in the folder of the export"
            raise InputError("--format", f'"{name}"', rule, "write below the folder of the request")
    return files


def _of_relief(scene: Scene, gear: str, names: Sequence[str]) -> list[str]:
    """Which relief formats of flanks hold."""
    if not names:
        return []
    remarks = []
    for back in (False, True) if scene.gears[gear].asymmetric else (False,):
        found, subject = described_relief(scene, gear, back=back), f"Gear {gear}, {', '.join(sorted(names)).upper()}"
        if found.pair:
            remarks.append(f"{subject}: relief as in pair {found.pair}; in other pairs it would end elsewhere.")
        if found.left_out:
            remarks.append(f"{subject}: flanks without relief, because {found.left_out}.")
    return remarks


def _left_out(scene: Scene, gear: str, wanted: Mapping[str, Format], written: Sequence[str]) -> list[str]:
    """What files do not hold of a gear's teeth: solids of rings, relief of meshes, what differs over face and teeth."""
    part, remarks = scene.case.gear[gear], []
    tooth = scene.gears[gear].tooth
    if tooth.working_flank is not None:
        up = "root" if tooth.internal else "tip"
        remarks.append(f"Gear {gear}: seen with the tooth {up} up, the {tooth.working_flank} flank is on the right.")
    if scene.gears[gear].tooth.internal and (solid := _of(wanted, "solid mesh")):
        remarks.append(f"Gear {gear} is internal: no {', '.join(sorted(solid))} is written for it.")
    meshes = sorted(name for name in written if wanted[name].holds in ("plane mesh", "solid mesh"))
    if meshes and (part.relief or part.coast_relief):
        remarks.append(f"Gear {gear}, {', '.join(meshes)}: flanks as generated, without the relief of the case.")
    if part.over_face:
        given = " and ".join(part.over_face)
        remarks.append(f"Gear {gear}: flanks the same all along the face, without {given} of the case.")
    if part.spacing_errors is not None:
        remarks.append(f"Gear {gear}: uniform pitch, without the pitch deviations of the case.")
    return remarks
