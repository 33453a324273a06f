"""Stage ``planet-root-stress``: root stress of a planet's tooth that sun and ring bend to either side, of sun and ring.

Range, mean and the ratio R of lowest to highest stress at one place of the fillet, over a turn of the gear.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from functools import cache
from typing import cast

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.case.built.planetary import planetary_part, set_inputs
from fegear.case.planetary import MESHES, Mesh, set_pair
from fegear.case.reading import Scene
from fegear.contact.plane.both_flanks import AlternatingStress, FilletTrace
from fegear.contact.plane.loaded_pair import LoadedPair
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Stage, Task, Upstream, Work
from fegear.geometry.pair import Member
from fegear.results import forecasts
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.alternating_rows import ALTERNATING, ALTERNATING_VALUES
from fegear.results.pair.idler_root_stress import check_along_fillet
from fegear.results.pair.loaded_teeth import gears_of
from fegear.results.pair.root_stress_history import RootStressData
from fegear.results.planetary.planet_set import planetary_sets

#: Of the mesh that pulls a fillet, and of the one that presses it.
Traces = tuple[FilletTrace, FilletTrace | None]


@dataclass(frozen=True)
class PlanetStressInputs:
    """What root stress over a turn depends on besides the loaded teeth.

    Parameters
    ----------
    between : float
        Angle that a planet turns in the carrier from a tooth's contact at the pitch point of the sun's mesh to that of
        the ring's [rad].
    planet_radius : mapping of mesh to float
        Its base radius [m], of the flanks that meet sun and ring.
    sun_drives : bool
        Whether the sun drives the planets in the motion relative to the carrier.
    name : str
    gears : mapping of str to str
        Names of sun, planet and ring.
    solved : mapping of mesh to mapping of member to str
        Names of the gears of each mesh as they are solved: asymmetric planets are for either flank.
    """

    between: float
    planet_radius: dict[Mesh, float]
    sun_drives: bool
    name: str
    gears: dict[str, str] = field(compare=False)
    solved: dict[Mesh, dict[Member, str]] = field(compare=False)

    def member(self, mesh: Mesh, *, planet: bool) -> Member:
        """Whether the planet, or its mate, is the driver of a mesh."""
        return "driver" if (self.sun_drives == (mesh == "ring")) == planet else "driven"


@dataclass(frozen=True)
class PlanetStress:
    """Root stress of the teeth of a set at the most pulled places of their fillets.

    Parameters
    ----------
    found : mapping of str to AlternatingStress
        Of the planet's fillets below the flanks that meet sun and ring, "planet_sun_side" and "planet_ring_side", of
        "sun" and "ring".
    angle : ndarray, shape (Q,)
        That the planet has turned in the carrier [rad].
    mesh : tuple of str
        In which its tooth is there.
    x : ndarray, shape (Q,)
        Position of the contact in this mesh [m].
    stress : ndarray, shape (2, Q)
        At both places of the planet's tooth [Pa].
    """

    found: dict[str, AlternatingStress]
    angle: Array
    mesh: tuple[str, ...]
    x: Array
    stress: Array


def _inputs(scene: Scene, name: str) -> PlanetStressInputs:
    part, inputs = planetary_part(scene, name), set_inputs(scene, name)
    found, drives = inputs.found, inputs.run.sun_drives
    thick = found.half_tooth_angle("sun") + found.half_tooth_angle("ring")
    gears = {"sun": part.sun, "planet": part.planet, "ring": part.ring or ""}
    between = math.pi - thick if drives else math.pi + thick
    radius = {mesh: found.base_radius("planet", mesh) for mesh in MESHES}
    solved = {mesh: gears_of(scene, set_pair(name, mesh)) for mesh in MESHES if set_pair(name, mesh) in scene.pairs}
    return PlanetStressInputs(between, radius, drives, name, gears, solved)


def _check(scene: Scene, name: str) -> None:
    set_inputs(scene, name)
    part = planetary_part(scene, name)
    if part.ring is None:
        raise InputError(
            f"planetary.{name}.ring", "(not given)", "is required for alternating bending of the planet",
            "define the ring as a gear with internal = true and set ring",
        )  # fmt: skip
    check_along_fillet(scene, [set_pair(name, mesh) for mesh in MESHES])


def needs_planet_stress(scene: Scene, name: str) -> tuple[Task, ...]:
    """Loaded teeth of both meshes, and root stress with its errors; gears with a width, as these stand along a face."""
    pairs = [set_pair(name, mesh) for mesh in MESHES]
    wide = [gear for pair in pairs if pair in scene.wide_pairs for gear in gears_of(scene, pair).values()]
    return (*(Task("root-stress-history", pair) for pair in pairs), *needs_solid_solution(*wide))


def _compute(asked: PlanetStressInputs, upstream: Upstream, _work: Work) -> PlanetStress:
    from fegear.contact.plane.both_flanks import alternating_stress, fillet_trace, with_errors
    from fegear.contact.wide.both_flanks import fillet_trace_at

    data = {mesh: cast("RootStressData", upstream[Task("root-stress-history", set_pair(asked.name, mesh))])
            for mesh in MESHES}  # fmt: skip
    pairs = {mesh: one.teeth for mesh, one in data.items()}

    @cache
    def trace(mesh: Mesh, planet: bool, z: float | None) -> FilletTrace:
        member, teeth = asked.member(mesh, planet=planet), pairs[mesh]
        if z is None:
            return fillet_trace(cast("LoadedPair", teeth).engagement, member, teeth.nominal)
        solved = solid_solution_of(upstream, asked.solved[mesh][member])
        return fillet_trace_at(cast("LoadedWidePair", teeth), member, solved.fine, z)

    def bent(pulled: Mesh, pressed: Mesh) -> tuple[AlternatingStress, Traces, list[Array]]:
        """Stress at one place over both traces; its errors are those of each mesh's largest, and of the place."""
        planet, i = pulled != pressed, pairs[pulled].loads.index(pairs[pulled].nominal)
        over = data[pulled].found.over_face.get(asked.member(pulled, planet=planet))
        z = None if over is None else float(over["tension"].z[np.argmax(over["tension"].value.max(axis=0))])
        # seen from the planet's other end
        traces = trace(pulled, planet, z), trace(pressed, True, None if z is None else -z) if planet else None
        pull, press = (
            next(iter(data[mesh].found.stress[asked.member(mesh, planet=planet)].values()))
            for mesh in (pulled, pressed)
        )
        found, *history = alternating_stress(*traces)
        return with_errors(found, pull, press, (i, i)), traces, history

    of_sun, placed, by_sun = bent("sun", "ring")
    of_ring, _, by_ring = bent("ring", "sun")
    found = {"planet_sun_side": of_sun, "planet_ring_side": of_ring}
    for mesh in MESHES:
        found[mesh], *_ = bent(mesh, mesh)
    ways = [one.x for one in placed if one is not None]
    angle = np.concatenate([x / asked.planet_radius[mesh] for mesh, x in zip(MESHES, ways, strict=True)])
    angle += np.repeat([0.0, asked.between], [one.size for one in ways])
    mesh_of = tuple(mesh for mesh, one in zip(MESHES, ways, strict=True) for _ in one)
    stress = np.array([np.concatenate(by_sun), np.concatenate(by_ring[::-1])])  # the ring pulls the second one
    return PlanetStress(found, angle, mesh_of, np.concatenate(ways), stress)


#: What the rows of the summary are.
_TEETH = {
    "planet_sun_side": "planet fillet, sun side",
    "planet_ring_side": "planet fillet, ring side",
    "sun": "sun fillet, loaded flank",
    "ring": "ring fillet, loaded flank",
}


@dataclass(frozen=True)
class Tooth:
    """One fillet of a set, and what it is."""

    found: AlternatingStress
    what: str
    tooth: str = shown("", "member and fillet")


@dataclass(frozen=True)
class TurnOfPlanet:
    """Stress of a planet's tooth at both places over a turn in the carrier, shape (Q,)."""

    angle: Array = shown(
        "deg", "rotation of the planet in the carrier since the tooth was at the pitch point with the sun",
        name="planet_angle", label="rotation of the planet in the carrier", table="turn",
    )  # fmt: skip
    mesh: NDArray[np.str_] = shown("", "mesh in which the tooth is loaded", table="turn")
    x: Array = shown("mm", "contact position of the tooth on the line of action of this mesh", table="turn")
    stress_sun_side: Array = shown(
        "MPa", "at the point of maximum tension of the fillet on the sun side", label="stress", table="turn"
    )
    stress_ring_side: Array = shown(
        "MPa", "at the point of maximum tension of the fillet on the ring side", table="turn"
    )


def _teeth(seen: Seen) -> dict[str, Tooth]:
    return {key: Tooth(one, _TEETH[key], key) for key, one in seen.data.found.items()}


def _turn(seen: Seen) -> TurnOfPlanet:
    data: PlanetStress = seen.data
    return TurnOfPlanet(data.angle, np.array(data.mesh), data.x, *data.stress)


def _in_order(seen: Seen) -> TurnOfPlanet:
    """By rising angle."""
    turn = _turn(seen)
    order = np.argsort(turn.angle)
    return TurnOfPlanet(*(getattr(turn, one.name)[order] for one in fields(turn)))


def _bent(seen: Seen) -> str:
    sides = list(_TEETH)[:2]
    ratios = ", ".join(f"{seen.data.found[key].ratio:.3f} at the {key.split('_')[1]}'s side" for key in sides)
    return (
        f"Set {seen.name}: alternating bending of the planet's teeth, R = {ratios} (annex B of ISO 6336-3 takes -1.2 "
        "for idlers)."
    )


_SHEET = Sheet(
    tables=(
        Rows(
            "planet_root_stress_{name}", "Root stress over one revolution in set {name}",
            (
                Cell("tooth", of=lambda seen: list(_teeth(seen).values())),
                *ALTERNATING,
                "place",
            ),
            of=lambda seen: list(seen.data.found.values()), printed=True,
        ),
        Rows(
            lambda seen: f"root_stress_history_{seen.name}_{seen.asked.gears['planet']}",
            lambda seen: (
                f"Root stress of a tooth of planet {seen.asked.gears['planet']} over a revolution in the carrier"
            ),
            (Every("turn"),), of=_turn,
        ),
    ),
    values=(
        Each(
            _teeth, *ALTERNATING_VALUES
        ),
    ),
    figures=(
        Chart(
            "planet_root_stress_{name}", "Root stress of a planet's tooth in set {name}",
            "Set {name}: stress at the points of maximum tension of both fillets of a planet's tooth over a revolution "
            "in the carrier; contact with the sun at 0 deg, with the ring half a revolution later.",
            (
                Over(
                    "angle",
                    tuple(
                        Line(f"stress_{mesh}_side", f"fillet, {mesh} side", f"series:{row}",
                             look={"markers": False})
                        for row, mesh in enumerate(MESHES)
                    ),
                    options={"zero": True},
                ),
            ),
            of=_in_order,
        ),
    ),
    remarks=(
        Remark(_bent),
        Remark(
            "Set {name}: root stresses are for equal load sharing; apart from Hertzian contact they are proportional "
            "to a planet's load."
        ),
    ),
)  # fmt: skip


PLANET_ROOT_STRESS = Stage(
    subjects=planetary_sets,
    needs=needs_planet_stress,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("mark", "root stress history of a tooth in mesh", "section 3, Appendix B")),
    forecast=lambda _scene, _name: forecasts.constant(0.4),
)
