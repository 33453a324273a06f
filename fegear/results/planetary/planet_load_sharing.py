"""Stages ``set-cycle`` and ``planet-load-sharing``: the teeth of a set, and how its planets share the torque.

Stage ``meshed-set`` has the same teeth as springs for motion: linear about an equal share.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.base.printed import percent
from fegear.base.shown import declared, shown, shown_as
from fegear.case.built.planetary import given_teeth, pin_errors, planetary_part, set_inputs
from fegear.case.planetary import MESHES, PHASED_HARMONICS, set_pair
from fegear.dynamics.planetary.kinematics import axial_forces
from fegear.dynamics.planetary.mesh_law import LawSprings, SlotSprings, WidenedSprings
from fegear.dynamics.planetary.phases import phasing
from fegear.dynamics.planetary.planet_loads import PlanetLoads, force_on, planet_loads
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.dynamics.planetary.set_cycle import MeshedSet, mean_force, set_cycle
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import effects_of_teeth, kind_of, loaded_pair
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.built.planetary import SetInputs
    from fegear.case.planetary import Mesh
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.mesh_law import MeshTeeth
    from fegear.dynamics.planetary.phases import Phasing
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_cycle import SetCycle
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Springs of the sun's mesh [s], the laws of both meshes, and the equilibrium over the cycle.
_TEETH, _LAWS, _LOADS = 0.6, 0.05, 0.05
#: A force or an error of a smaller share of the mean force, or of the largest error, is none.
_ROUND_OFF = 1e-10
_CYCLE = Axis("mesh cycle, in base pitches")


def needs_meshed(_scene: Scene, name: str) -> tuple[Task, ...]:
    """The task that makes the teeth of a set."""
    return (Task("meshed-set", name),)


def meshed_set(upstream: Upstream, name: str) -> MeshedSet:
    """What it made."""
    return cast("MeshedSet", upstream[Task("meshed-set", name)])


def solved_meshes(scene: Scene, name: str) -> tuple[Mesh, ...]:
    """Meshes of a set whose teeth are solved: those of gears of the case without a given stiffness."""
    part = planetary_part(scene, name)
    meshes: tuple[Mesh, ...] = MESHES if part.ring is not None else ("sun",)
    return tuple(mesh for mesh in meshes if getattr(part.stiffness, f"{mesh}_mesh") is None)


def needs_teeth(scene: Scene, name: str) -> tuple[Task, ...]:
    """The loaded pairs of its solved meshes."""
    pairs = (set_pair(name, mesh) for mesh in solved_meshes(scene, name))
    return tuple(Task(kind_of(scene, pair).stage, pair) for pair in pairs)


def effects_of_set(scene: Scene, name: str) -> tuple[str, ...]:
    """Effects that change the teeth of a set."""
    known = (effects_of_teeth(scene, set_pair(name, mesh)) for mesh in solved_meshes(scene, name))
    return tuple(dict.fromkeys(effect for one in known for effect in one))


def check_set(scene: Scene, name: str) -> None:
    """Refuse a set that cannot be assembled, or whose ring mesh is not known."""
    set_inputs(scene, name)
    part = planetary_part(scene, name)
    if part.ring is None and part.stiffness.ring_mesh is None:
        raise InputError(
            f"planetary.{name}.stiffness.ring_mesh", "(not given)", "is required if the ring is not a gear of the case",
            'set stiffness = { ring_mesh = "700 N/um" }, or define the ring gear and set ring',
        )  # fmt: skip


def given_or_wide_teeth(asked: SetInputs, mesh: Mesh, upstream: Upstream) -> MeshTeeth | None:
    """Teeth of a mesh whose stiffness is given, or that have a width; None of plane teeth.

    Those of double helical gears are two halves, each under half of the force.
    """
    given, name = asked.given[mesh], set_pair(asked.name, mesh)
    if given is not None:
        return SlotSprings(given_teeth(given))
    if Task("loaded-flanks", name) not in upstream:
        return None
    from fegear.dynamics.planetary.flank_law import FlankSprings

    load = mean_force(asked.model, asked.sun_torque, mesh) / asked.halves
    half = FlankSprings(loaded_flanks(upstream, name), load, asked.model.count)
    return half if asked.halves == 1 else WidenedSprings(half, asked.halves)


def given_or_wide_springs(asked: SetInputs, mesh: Mesh, upstream: Upstream) -> MeshExcitation | None:
    """The same teeth as springs about the mean force."""
    from fegear.dynamics.train.flank_excitation import excitation_of_flanks

    given, name = asked.given[mesh], set_pair(asked.name, mesh)
    if given is not None:
        return given_teeth(given)
    if Task("loaded-flanks", name) not in upstream:
        return None
    load = mean_force(asked.model, asked.sun_torque, mesh) / asked.halves
    return excitation_of_flanks(loaded_flanks(upstream, name), load).widened(asked.halves)


def _cycle(asked: SetInputs, upstream: Upstream, _work: Work) -> SetCycle:
    def teeth(mesh: Mesh) -> MeshTeeth:
        found = given_or_wide_teeth(asked, mesh, upstream)
        if found is not None:
            return found
        pair = loaded_pair(upstream, set_pair(asked.name, mesh))
        load = mean_force(asked.model, asked.sun_torque, mesh)
        return LawSprings(pair.engagement, pair.shifted, load, asked.model.count)

    return set_cycle(asked.model, (teeth("sun"), teeth("ring")), asked.phases, asked.sun_torque, asked.run.input)


_CYCLE_SHEET = Sheet(
    remarks=(
        Remark("Set {name}: specified planet-ring mesh stiffness used.", when=lambda seen: seen.asked.given["ring"]),
        Remark(
            "Set {name}: planet load sharing without friction.", when=lambda seen: seen.asked.run.mesh_efficiency < 1.0
        ),
    ),
)  # fmt: skip


#: Stage of what the loaded teeth of a set's meshes are to its planets.
_teeth_stage = partial(
    Stage, subjects=planetary_sets, inputs=set_inputs, needs=needs_teeth, check=check_set,
    effects_of=effects_of_set,
)  # fmt: skip

SET_CYCLE = _teeth_stage(
    compute=_cycle,
    present=_CYCLE_SHEET.present,
    cites=citing(Citation("mark", "load sharing of coupled tooth pairs", "App. A")),
    forecast=lambda _scene, _name: forecasts.constant(_LAWS),
)


def _meshed(asked: SetInputs, upstream: Upstream, _work: Work) -> MeshedSet:
    from fegear.dynamics.train.mesh_excitation import mesh_excitation

    def teeth(mesh: Mesh) -> MeshExcitation:
        found = given_or_wide_springs(asked, mesh, upstream)
        if found is not None:
            return found
        force = mean_force(asked.model, asked.sun_torque, mesh)
        return mesh_excitation(loaded_pair(upstream, set_pair(asked.name, mesh)).engagement, force)

    return MeshedSet(asked.model, teeth("sun"), teeth("ring"), asked.phases, asked.sun_torque, asked.run.input)


def _slotted(seen: Seen) -> bool:
    """Whether all solved meshes are linear at any share."""
    meshes = zip(MESHES, seen.data.teeth, strict=True)
    return all(one.slotted for mesh, one in meshes if seen.asked.given[mesh] is None)


_MESHED_SHEET = Sheet(
    remarks=(
        Remark(
            "Set {name}: for vibration, coupled teeth and corner contact are linearised at equal load sharing.",
            when=lambda seen: not _slotted(seen),
        ),
    ),
)  # fmt: skip


MESHED_SET = _teeth_stage(
    compute=_meshed,
    present=_MESHED_SHEET.present,
    cites=citing(Citation("mark", "tooth pairs as springs about the mean load", "section 2")),
    forecast=lambda _scene, _name: forecasts.constant(_TEETH),
)


@dataclass(frozen=True)
class LoadInputs:
    """What a set's loads depend on besides its teeth.

    Parameters
    ----------
    errors : ndarray, shape (2, planets)
        Of the pins, radial and counter-clockwise [m].
    phasing : Phasing
        What the phases of the meshes cancel.
    tilting : float
        Moment by which helical teeth tilt each planet where all carry alike [N m]; zero of spur sets.
    name : str
    """

    errors: Array
    phasing: Phasing
    tilting: float
    name: str


def _load_inputs(scene: Scene, name: str) -> LoadInputs:
    part, asked = planetary_part(scene, name), set_inputs(scene, name)
    tilting = axial_forces(asked.found, asked.run, asked.base_twist).tilting
    return LoadInputs(pin_errors(part), phasing(asked.found, part.harmonics or PHASED_HARMONICS), tilting, name)


def _compute(inputs: LoadInputs, upstream: Upstream, _work: Work) -> PlanetLoads:
    return planet_loads(cast("SetCycle", upstream[Task("set-cycle", inputs.name)]), inputs.errors)


@dataclass(frozen=True)
class PlanetCycle:
    """Load of one planet over the mesh cycle, and its error where the teeth have one; shape (M,)."""

    error: Array | None
    s: Array = shown_as(declared(PlanetLoads, "s"))
    load: Array = shown("N", "mesh force of this planet, along the line of action")

    @property
    def in_order(self) -> PlanetCycle:
        """By rising mesh position."""
        order = np.argsort(self.s)
        return PlanetCycle(None, self.s[order], self.load[order])


@dataclass(frozen=True)
class PlanetShares:
    """What every planet and its pin carry, shape (planets,); helical teeth tilt them."""

    pin_radial_error: Array
    pin_tangential_error: Array
    tilting_moment_error: Array | None
    planet: NDArray[np.intp] = shown("", "counter-clockwise")
    tangential_error: Array = shown("um", "tangential displacement of its pin, counter-clockwise")
    radial_error: Array = shown("um", "radial displacement of its pin, outward")
    apart_sun: Array = shown("", "fraction of the mesh cycle without contact, sun mesh")
    apart_ring: Array = shown("", "fraction of the mesh cycle without contact, ring mesh")
    pin_radial: Array = shown("N", "mean radial pin force on the planet, outward")
    pin_tangential: Array = shown("N", "mean tangential pin force on the planet, counter-clockwise")
    tilting_moment: Array | None = shown("N.m", "mean tilting moment of its meshes on the planet, carried by its pin")


@dataclass(frozen=True)
class ForceHarmonics:
    """Harmonics of the force on one member, shape (harmonics,)."""

    error: Array
    n: NDArray[np.intp] = shown("", "mesh harmonic")
    force: Array = shown("N", "radial force amplitude")


@dataclass(frozen=True)
class PlanetHarmonics:
    """Harmonics of the transmission error and of the forces on each member, and which of them phasing cancels."""

    te_error: Array
    forces: dict[str, ForceHarmonics]
    n: NDArray[np.intp] = shown("", "mesh harmonic")
    te: Array = shown("um", "0-peak")
    cancels: NDArray[np.str_] = shown(
        "", "cancelled by phasing (equal planets): transmission error and torque, radial forces, or both"
    )

    @property
    def unexcited(self) -> bool:
        """Whether no member is."""
        return not any(np.any(one.force) for one in self.forces.values())


@dataclass(frozen=True)
class ShownLoads:
    """What is shown of the loads of a set."""

    loads: PlanetLoads
    planets: dict[str, PlanetCycle]
    te_error: Array | None
    shares: PlanetShares
    harmonics: PlanetHarmonics


def _shown(data: PlanetLoads, inputs: LoadInputs) -> ShownLoads:
    known = bool(data.cycle.off.size)

    def planet(n: int) -> PlanetCycle:
        error = data.shift(lambda one: one.mesh_force[0, n]) if known else None
        return PlanetCycle(error, data.s, data.mesh_force[0, n])

    planets = {str(n + 1): planet(n) for n in range(data.mesh_force.shape[1])}
    te_error = data.shift(lambda one: one.te) if known else None
    return ShownLoads(data, planets, te_error, _shares(data, inputs), _harmonics(data, inputs))


def _shares(data: PlanetLoads, inputs: LoadInputs) -> PlanetShares:
    pins = data.pin_force @ data.weights
    radial, tangential = np.where(np.abs(pins) < _ROUND_OFF * data.mean_force, 0.0, pins)
    radial_error, tangential_error = data.mean_error(lambda one: one.pin_force)
    tilted = inputs.tilting != 0.0
    return PlanetShares(
        radial_error, tangential_error, abs(inputs.tilting) * data.shares_error if tilted else None,
        np.arange(1, data.shares.size + 1), inputs.errors[1], inputs.errors[0], data.lifted[0], data.lifted[1], radial,
        tangential, inputs.tilting * data.shares if tilted else None,
    )  # fmt: skip


def _harmonics(data: PlanetLoads, inputs: LoadInputs) -> PlanetHarmonics:
    rule = inputs.phasing
    order = rule.harmonic.astype(float)

    def forces(member: Central) -> ForceHarmonics:
        size = np.hypot(*_size(data, force_on(data, member), order))
        error = 2.0 * np.hypot(*data.harmonics_error(lambda one: force_on(one, member), order))
        return ForceHarmonics(error, rule.harmonic, size)

    words = {(True, True): "nothing", (False, True): "te", (True, False): "forces", (False, False): "te and forces"}
    cancelled = [words[t > 0.0, f > 0.0] for t, f in zip(rule.torque, rule.force, strict=True)]
    return PlanetHarmonics(
        2.0 * data.harmonics_error(lambda one: one.te, order), {member: forces(member) for member in CENTRALS},
        rule.harmonic, _size(data, data.te, order), np.array(cancelled),
    )  # fmt: skip


def _size(data: PlanetLoads, values: Array, order: Array) -> Array:
    """Amplitudes of harmonics, 0-peak; what is round-off is zero."""
    found = 2.0 * np.abs(data.harmonics(values, order))
    scale = data.mean_force if values.ndim > 1 else float(np.max(np.abs(values)))
    return np.where(found < _ROUND_OFF * scale, 0.0, found)


def _apart(seen: Seen) -> str:
    """Planets that lose contact."""
    lifted = seen.data.loads.lifted.max(axis=0)
    return ", ".join(f"planet {n + 1} ({percent(share)} of the cycle)" for n, share in enumerate(lifted) if share)


_SHEET = Sheet(
    of=_shown,
    tables=(
        Rows(
            "planet_loads_{name}", "Loads of the planets of {name} over the mesh cycle",
            (
                "loads.s", Cell("loads.te", error="te_error"),
                Cell("load", each="planets", ending="_{key}", error="error"),
            ),
        ),
        Rows(
            "planet_shares_{name}", "Load sharing of the planets of {name}",
            (
                *(f"shares.{one}" for one in ("planet", "tangential_error", "radial_error")),
                *(Cell(one, error=f"{one}_error") for one in ("loads.shares", "loads.largest_load")),
                "shares.apart_sun", "shares.apart_ring",
                *(
                    Cell(f"shares.{one}", error=f"shares.{one}_error")
                    for one in ("pin_radial", "pin_tangential", "tilting_moment")
                ),
            ),
            printed=True,
        ),
        Rows(
            "planet_forces_{name}", "Harmonics of the transmission error and of forces in {name}",
            (
                "n", Cell("te", error="harmonics.te_error"),
                Cell(
                    "force", each="harmonics.forces", ending="_{key}",
                    further=" on the {key} (root of the sum of squares of both directions)", error="error",
                ),
                "cancels",
            ),
            of="harmonics",
        ),
    ),
    values=tuple(
        Number(f"loads.{one}", f"loads.{one}_error")
        for one in ("mesh_load_factor", "largest_share", "te_mean", "te_peak_to_peak")
    ),
    figures=(
        Chart(
            "planet_load_sharing_{name}", "Load sharing of the planets of {name}",
            "Set {name}: mesh forces of each planet over a mesh cycle, and transmission error at the "
            "{d.loads.cycle.driving}. K_gamma = {d.loads.mesh_load_factor:.4g}.",
            (
                Over(
                    _CYCLE,
                    (
                        Line(
                            "load", x="s", of="in_order", each=Family("planets", "planet {key}", most=None),
                            look={"markers": False},
                        ),
                    ),
                    Axis("mesh force", "N", zero=True),
                ),
                Over(_CYCLE, (Line("te", x="s"),), Axis("transmission error", "um")),
            ),
            of="loads",
        ),
        Chart(
            "planet_forces_{name}", "Radial forces on sun, ring and carrier, set {name}",
            "Set {name}: harmonics of the forces of the planets on sun, ring and carrier, amplitude; zero for floating "
            "members.",
            (
                Over(
                    Axis("mesh harmonic", whole=True),
                    (Line("force", x="n", kind="bars", each=Family("harmonics.forces")),),
                    lambda seen: Axis("force", "N", limits=(0.0, 1.0) if seen.data.harmonics.unexcited else None),
                    title=lambda seen: "none (planet forces cancel)" if seen.data.harmonics.unexcited else "",
                ),
            ),
        ),
    ),
    answer=Answer(
        "Set {name}: the most loaded planet carries {v[K_gamma]} times an equal share (K_gamma); transmission error "
        "{v[te_peak_to_peak]} peak to peak.",
        figure="planet_load_sharing_{name}",
    ),
    remarks=(
        Remark(lambda seen: f"Set {seen.name}: loss of contact: {_apart(seen)}.", when=_apart),
        Remark(
            assuming("Set {name}: specified stiffnesses are assumed exact; errors include the mesh positions only."),
            when=lambda seen: not seen.data.loads.cycle.off.size,
        ),
    ),
    settings={"positions": "loads.s.size"},
)  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    return Forecast({"planets": planetary_part(scene, name).count}, _LOADS)


PLANET_LOAD_SHARING = Stage(
    subjects=planetary_sets,
    needs=lambda _scene, name: (Task("set-cycle", name),),
    inputs=_load_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(Citation("lin-parker", "bodies and springs of the set", "section 2")),
    forecast=_forecast,
)
