"""Stage ``loaded-shafts``: all shafts of a case and all its meshes in one equilibrium, for what reports it."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from fegear.base.effects import MISALIGNMENT, WIDE_EFFECTS
from fegear.base.errors import ConvergenceError
from fegear.base.notes import Note, assuming, class_of, neglecting
from fegear.case.built.bearing_room import said_of_room
from fegear.case.built.members import gear_name
from fegear.case.built.pair_checks import check_wide_pair
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.shafts import gearbox_of, mesh_places, said_of_bearings, said_of_bodies
from fegear.contact.wide.maker import load_flanks
from fegear.contact.wide.on_shafts import (
    TOLERANCE,
    EvenForces,
    FlankForces,
    LoadedShafts,
    gaps_of_even_loads,
    load_gearbox,
)
from fegear.contact.wide.shaft_gaps import RIGID
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task
from fegear.geometry.pair import MEMBERS
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.shafts.rolling_bearing import RollingBearing

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.wide.on_shafts import MeshForces
    from fegear.engine.stage import Upstream, Work
    from fegear.shafts.gearbox import Gearbox

#: Seconds of the shafts alone, and of one mesh with its flanks under one load.
_SHAFTS, _FLANKS = 0.05, 1.0


@dataclass(frozen=True)
class LoadedShaftsInputs:
    """What the stage reads.

    Parameters
    ----------
    gearbox : Gearbox
    flanks : tuple of PairSpec or None
        Of every mesh whose flanks are loaded with it; None where the load stays even over the face.
    scales : tuple of float
        Loads over the nominal ones, ascending.
    said : tuple of str
        What is assumed of gears on their shafts, and of bearings of which only a catalogue is known.
    """

    gearbox: Gearbox
    flanks: tuple[PairSpec | None, ...]
    scales: tuple[float, ...]
    said: tuple[str, ...]


def loaded_shafts(upstream: Upstream) -> LoadedShafts:
    """What this stage computed."""
    return cast("LoadedShafts", upstream[LOADED_SHAFTS_TASK])


#: The one task of this stage.
LOADED_SHAFTS_TASK = Task("loaded-shafts", "all")


def shafts_of(scene: Scene) -> tuple[str, ...]:
    """One solution for all shafts of a case."""
    return ("all",) if scene.case.shaft else ()


def _feeding(scene: Scene, pair: str) -> bool:
    """Whether the flanks of a pair move its force on the shafts."""
    return scene.case.effects.misalignment and pair in scene.wide_pairs


def _scales(scene: Scene, pair: str) -> set[float]:
    """Loads of a pair over its nominal one, levels of its spectrum among them."""
    part, found = scene.case.pair[pair], scene.pairs[pair]
    nominal = part.normal_load(found) or 1.0
    loads = {load / nominal for load in part.all_loads(found)}
    for level in part.operation.spectrum or ():
        torque = level.torque / found.driver.base_radius / nominal if level.torque else level.load_factor
        loads |= {torque} if torque else set()
    return loads


def inputs_of_shafts(scene: Scene, _name: str) -> LoadedShaftsInputs:
    """As `Stage.inputs`."""
    box = gearbox_of(scene)
    flanks = tuple(pair_spec(scene, mesh.pair) if _feeding(scene, mesh.pair) else None for mesh in box.meshes)
    scales = {1.0}.union(*(_scales(scene, mesh.pair) for mesh in box.meshes))
    said = (*said_of_room(scene), *said_of_bodies(scene), *said_of_bearings(scene))
    return LoadedShaftsInputs(box, flanks, tuple(sorted(scales)), said)


def mesh_forces(inputs: LoadedShaftsInputs, upstream: Upstream, work: Work) -> list[MeshForces]:
    """Every mesh with its flanks, ready to be loaded with the shafts; those that do not move them evenly."""
    meshes: list[MeshForces] = []
    for number, (mesh, asked) in enumerate(zip(inputs.gearbox.meshes, inputs.flanks, strict=True)):
        if asked is None:
            meshes.append(EvenForces(mesh.even / mesh.load))
            continue
        bodies = {m: solid_solution_of(upstream, gear).fine for m, gear in zip(MEMBERS, asked.gears, strict=True)}
        flanks, gaps, found = load_flanks(asked.on(RIGID), bodies, work.cache)
        meshes.append(FlankForces(flanks, gaps, found.known, mesh.heights))
        work.progress((number + 1) / (len(inputs.flanks) + 1))
    return meshes


def _compute(inputs: LoadedShaftsInputs, upstream: Upstream, work: Work) -> LoadedShafts:
    states = load_gearbox(inputs.gearbox, mesh_forces(inputs, upstream, work), inputs.scales)
    return LoadedShafts(inputs.gearbox, states, tuple(one is not None for one in inputs.flanks))


def _remarks(data: LoadedShafts, assumed: tuple[str, ...]) -> list[str]:
    """What the model assumes and neglects, and what is not from a print at hand."""
    said: list[str] = [
        Note(f"{one}." if one.startswith("Bearing ") else f"Shafts: {one}.", class_of(one)) for one in assumed
    ]
    if any(one.shaft.gears for one in data.gearbox.shafts):
        said.append(
            "Shafts: gear bodies are treated as rigidly connected to the shaft over their seats and stiffen it in "
            "bending and torsion. For keys and normal shrink fits ISO 6336-1 assumes almost no stiffening: set "
            "stiffens = false."
        )
    meshes = data.gearbox.meshes
    even = [mesh.pair for mesh, feeding in zip(meshes, data.feeding, strict=True) if not feeding]
    if even:
        said.append(
            neglecting(
                f"Shafts: uniform load distribution over the face assumed for {', '.join(even)}; effects.misalignment "
                '= true couples load distribution and shaft deflection for pairs with width = "solid" or "slices".'
            )
        )
    if any(data.feeding):
        said.append(
            "Shafts: computed with the load distribution averaged over a base pitch; the change of centre distance "
            "is neglected in the working pressure angle."
        )
    seats = [seat.bearing for shaft in data.gearbox.shafts for seat in shaft.seats]
    if any(isinstance(one, RollingBearing) and one.kind == "roller" for one in seats):
        said.append(assuming("Shafts: roller contact law (ISO/TS 16281) is not verified against a printed source."))
    return said


_SHEET = Sheet(
    name=lambda _asked: "",
    remarks=(lambda seen: _remarks(seen.data, seen.asked.said),),
    settings={
        "scales": lambda seen: list(seen.asked.scales),
        "newton_steps": lambda seen: [state.steps for state in seen.data.states],
        "tolerance": lambda _: TOLERANCE,
        "flanks_loaded": lambda seen: list(seen.data.feeding),
    },
)


def fed_pairs(scene: Scene) -> list[str]:
    """Pairs whose load distribution moves the forces on the shafts."""
    return [mesh.pair for mesh in mesh_places(scene) if _feeding(scene, mesh.pair)]


def needs_gears_of_meshes(scene: Scene, _name: str) -> tuple[Task, ...]:
    """Solved gears of the pairs that move the forces on the shafts."""
    gears = [gear_name(scene, pair, member) for pair in fed_pairs(scene) for member in MEMBERS]
    return needs_solid_solution(*dict.fromkeys(gears)) if gears else ()


def _check(scene: Scene, _name: str) -> None:
    box, fed = gearbox_of(scene), fed_pairs(scene)
    for pair in fed:
        check_wide_pair(scene, pair)
    if fed:  # shafts that nothing locates are refused before gears are solved; no load distribution would be found
        with suppress(ConvergenceError):
            gaps_of_even_loads(box, fed[0])


def _forecast(scene: Scene, _name: str) -> Forecast:
    return Forecast({}, _SHAFTS + _FLANKS * len(fed_pairs(scene)))


LOADED_SHAFTS = Stage(
    subjects=shafts_of,
    inputs=inputs_of_shafts,
    compute=_compute,
    present=_SHEET.present,
    needs=needs_gears_of_meshes,
    check=_check,
    effects_of=lambda scene, _name: WIDE_EFFECTS if fed_pairs(scene) else (MISALIGNMENT.name,),
    forecast=_forecast,
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
)
