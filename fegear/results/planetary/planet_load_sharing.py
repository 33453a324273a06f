"""Stages ``set-cycle`` and ``planet-load-sharing``: the teeth of a set, and how its planets share the torque.

Stage ``meshed-set`` has the same teeth as springs for motion: linear about an equal share.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import percent
from fegear.case.built.planetary import given_teeth, pin_errors, planetary_part, set_inputs
from fegear.case.planetary import MESHES, PHASED_HARMONICS, set_pair
from fegear.dynamics.planetary.kinematics import axial_forces
from fegear.dynamics.planetary.mesh_law import LawSprings, SlotSprings
from fegear.dynamics.planetary.phases import phasing
from fegear.dynamics.planetary.planet_loads import force_on, planet_loads
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.dynamics.planetary.set_cycle import MeshedSet, mean_force, set_cycle
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, columns_of, curve_of, error_column, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import effects_of_teeth, kind_of, loaded_pair
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array
    from fegear.case.built.planetary import SetInputs
    from fegear.case.planetary import Mesh
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.phases import Phasing
    from fegear.dynamics.planetary.planet_loads import PlanetLoads
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_cycle import MeshTeeth, SetCycle
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.engine.stage import Upstream, Work

#: Springs of the sun's mesh [s], the laws of both meshes, and the equilibrium over the cycle.
_TEETH, _LAWS, _LOADS = 0.6, 0.05, 0.05
#: A force or an error of a smaller share of the mean force, or of the largest error, is none.
_ROUND_OFF = 1e-10


def needs_meshed(_scene: Scene, name: str) -> tuple[Task, ...]:
    """The task that makes the teeth of a set."""
    return (Task("meshed-set", name),)


def meshed_set(upstream: Upstream, name: str) -> MeshedSet:
    """What it made."""
    return cast("MeshedSet", upstream[Task("meshed-set", name)])


def _solved(scene: Scene, name: str) -> tuple[Mesh, ...]:
    """Meshes of a set whose teeth are solved: those of gears of the case without a given stiffness."""
    part = planetary_part(scene, name)
    meshes: tuple[Mesh, ...] = MESHES if part.ring is not None else ("sun",)
    return tuple(mesh for mesh in meshes if getattr(part.stiffness, f"{mesh}_mesh") is None)


def needs_teeth(scene: Scene, name: str) -> tuple[Task, ...]:
    """The loaded pairs of its solved meshes."""
    pairs = (set_pair(name, mesh) for mesh in _solved(scene, name))
    return tuple(Task(kind_of(scene, pair).stage, pair) for pair in pairs)


def _effects(scene: Scene, name: str) -> tuple[str, ...]:
    """Effects that change the teeth of a set."""
    known = (effects_of_teeth(scene, set_pair(name, mesh)) for mesh in _solved(scene, name))
    return tuple(dict.fromkeys(effect for one in known for effect in one))


def _check(scene: Scene, name: str) -> None:
    set_inputs(scene, name)
    part = planetary_part(scene, name)
    if part.ring is None and part.stiffness.ring_mesh is None:
        raise InputError(
            f"planetary.{name}.stiffness.ring_mesh", "(not given)", "is required if the ring is not a gear of the case",
            'set stiffness = { ring_mesh = "700 N/um" }, or define the ring gear and set ring',
        )  # fmt: skip


def _cycle(asked: SetInputs, upstream: Upstream, _work: Work) -> SetCycle:
    load = mean_force(asked.model, asked.sun_torque)

    def teeth(mesh: Mesh) -> MeshTeeth:
        given = asked.given[mesh]
        if given is not None:
            return SlotSprings(given_teeth(given))
        name = set_pair(asked.name, mesh)
        if Task("loaded-flanks", name) in upstream:
            from fegear.dynamics.planetary.flank_law import FlankSprings

            return FlankSprings(loaded_flanks(upstream, name), load, asked.model.count)
        pair = loaded_pair(upstream, name)
        return LawSprings(pair.engagement, pair.shifted, load, asked.model.count)

    return set_cycle(asked.model, (teeth("sun"), teeth("ring")), asked.phases, asked.sun_torque, asked.run.input)


def _present_cycle(data: SetCycle, asked: SetInputs) -> Outcome:
    said = []
    if asked.given["ring"] is not None:
        said.append(f"Set {asked.name}: specified planet-ring mesh stiffness used.")
    if asked.run.mesh_efficiency < 1.0:
        said.append(f"Set {asked.name}: planet load sharing without friction.")
    return Outcome(data, remarks=tuple(said))


#: Stage of what the loaded teeth of a set's meshes are to its planets.
_teeth_stage = partial(
    Stage, subjects=planetary_sets, inputs=set_inputs, needs=needs_teeth, check=_check,
    effects_of=_effects,
)  # fmt: skip

SET_CYCLE = _teeth_stage(
    compute=_cycle,
    present=_present_cycle,
    cites=citing(Citation("mark", "load sharing of coupled tooth pairs", "App. A")),
    forecast=lambda _scene, _name: forecasts.constant(_LAWS),
)


def _meshed(asked: SetInputs, upstream: Upstream, _work: Work) -> MeshedSet:
    from fegear.dynamics.train.flank_excitation import excitation_of_flanks
    from fegear.dynamics.train.mesh_excitation import mesh_excitation

    force = mean_force(asked.model, asked.sun_torque)

    def teeth(mesh: Mesh) -> MeshExcitation:
        given = asked.given[mesh]
        if given is not None:
            return given_teeth(given)
        name = set_pair(asked.name, mesh)
        if Task("loaded-flanks", name) in upstream:
            return excitation_of_flanks(loaded_flanks(upstream, name), force)
        return mesh_excitation(loaded_pair(upstream, name).engagement, force)

    return MeshedSet(asked.model, teeth("sun"), teeth("ring"), asked.phases, asked.sun_torque, asked.run.input)


def _present_meshed(data: MeshedSet, asked: SetInputs) -> Outcome:
    solved = [one for mesh, one in zip(MESHES, data.teeth, strict=True) if asked.given[mesh] is None]
    said = f"Set {asked.name}: for vibration, coupled teeth and corner contact are linearised at equal load sharing."
    return Outcome(data, remarks=(said,) if any(not one.slotted for one in solved) else ())


MESHED_SET = _teeth_stage(
    compute=_meshed,
    present=_present_meshed,
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


def _tables(data: PlanetLoads, inputs: LoadInputs) -> tuple[Table, ...]:
    name, count = inputs.name, data.mesh_force.shape[1]
    known = bool(data.cycle.off.size)

    def with_error(column: Column, error: Array) -> tuple[Column, ...]:
        return column, error_column(column, error)

    def over(column: Column, answer: Callable[[PlanetLoads], Array]) -> tuple[Column, ...]:
        return with_error(column, data.shift(answer)) if known else (column,)

    cycle = [*columns_of(data, "s"), *over(column_of(data, "te"), lambda one: one.te)]
    for n in range(count):
        load = Column(f"load_{n + 1}", data.mesh_force[0, n], "N", "mesh force of this planet, along the line of "
                                                                   "action")  # fmt: skip
        cycle += over(load, lambda one, n=n: one.mesh_force[0, n])  # type: ignore[misc]
    pins = data.pin_force @ data.weights
    pins = np.where(np.abs(pins) < _ROUND_OFF * data.mean_force, 0.0, pins)
    of_pins = data.mean_error(lambda one: one.pin_force)
    shares = [
        Column("planet", np.arange(1, count + 1), "", "counter-clockwise"),
        Column("tangential_error", inputs.errors[1], "um", "tangential displacement of its pin, counter-clockwise"),
        Column("radial_error", inputs.errors[0], "um", "radial displacement of its pin, outward"),
        *with_error(column_of(data, "shares"), data.shares_error),
        *with_error(column_of(data, "largest_load"), data.largest_load_error),
        Column("apart_sun", data.lifted[0], "", "fraction of the mesh cycle without contact, sun mesh"),
        Column("apart_ring", data.lifted[1], "", "fraction of the mesh cycle without contact, ring mesh"),
        *with_error(Column("pin_radial", pins[0], "N", "mean radial pin force on the planet, outward"), of_pins[0]),
        *with_error(Column("pin_tangential", pins[1], "N", "mean tangential pin force on the planet, "
                                                           "counter-clockwise"),
                    of_pins[1]),
    ]  # fmt: skip
    if inputs.tilting:
        meaning = "mean tilting moment of its meshes on the planet, carried by its pin"
        shares += with_error(Column("tilting_moment", inputs.tilting * data.shares, "N.m", meaning),
                             abs(inputs.tilting) * data.shares_error)  # fmt: skip
    return (
        Table(f"planet_loads_{name}", tuple(cycle), f"Loads of the planets of {name} over the mesh cycle"),
        Table(f"planet_shares_{name}", tuple(shares), f"Load sharing of the planets of {name}", printed=True),
        _forces(data, inputs),
    )


def _forces(data: PlanetLoads, inputs: LoadInputs) -> Table:
    """Harmonics of the transmission error and of the forces on each member, and which of them phasing cancels."""
    rule = inputs.phasing
    order = rule.harmonic.astype(float)
    te = Column("te", _size(data, data.te, order), "um", "0-peak")
    columns = [
        Column("n", rule.harmonic, "", "mesh harmonic"),
        te,
        error_column(te, 2.0 * data.harmonics_error(lambda one: one.te, order)),
    ]
    for member in CENTRALS:

        def force_of(one: PlanetLoads, member: Central = member) -> Array:
            return force_on(one, member)

        said = f"radial force amplitude on the {member} (root of the sum of squares of both directions)"
        force = Column(f"force_{member}", np.hypot(*_size(data, force_of(data), order)), "N", said)
        columns += [force, error_column(force, 2.0 * np.hypot(*data.harmonics_error(force_of, order)))]
    words = {(True, True): "nothing", (False, True): "te", (True, False): "forces", (False, False): "te and forces"}
    cancelled = [words[t > 0.0, f > 0.0] for t, f in zip(rule.torque, rule.force, strict=True)]
    said = "cancelled by phasing (equal planets): transmission error and torque, radial forces, or both"
    columns.append(Column("cancels", np.array(cancelled), "", said))
    title = f"Harmonics of the transmission error and of forces in {inputs.name}"
    return Table(f"planet_forces_{inputs.name}", tuple(columns), title)


def _size(data: PlanetLoads, values: Array, order: Array) -> Array:
    """Amplitudes of harmonics, 0-peak; what is round-off is zero."""
    found = 2.0 * np.abs(data.harmonics(values, order))
    scale = data.mean_force if values.ndim > 1 else float(np.max(np.abs(values)))
    return np.where(found < _ROUND_OFF * scale, 0.0, found)


def _present(data: PlanetLoads, inputs: LoadInputs) -> Outcome:
    name = inputs.name
    values = [value_of(data, key, name, getattr(data, f"{key}_error"))
              for key in ("mesh_load_factor", "largest_share", "te_mean", "te_peak_to_peak")]  # fmt: skip
    said = []
    apart = [
        f"planet {n + 1} ({percent(share)} of the cycle)" for n, share in enumerate(data.lifted.max(axis=0)) if share
    ]
    if apart:
        said.append(f"Set {name}: loss of contact: {', '.join(apart)}.")
    if not data.cycle.off.size:
        said.append(f"Set {name}: specified stiffnesses are assumed exact; errors include the mesh positions only.")
    return Outcome(data, _tables(data, inputs), tuple(values), {"positions": int(data.s.size)}, tuple(said),
                   (_over_cycle(name, data), _harmonics(name, data, inputs)))  # fmt: skip


def _over_cycle(name: str, data: PlanetLoads) -> Figure:
    order = np.argsort(data.s)
    curves = tuple(
        Curve(data.s[order], data.mesh_force[0, n, order], f"planet {n + 1}", f"series:{n}", markers=False)
        for n in range(data.mesh_force.shape[1])
    )
    x = axis_of(type(data), "s", "mesh cycle, in base pitches")
    return Figure(
        f"planet_load_sharing_{name}", f"Load sharing of the planets of {name}",
        f"Set {name}: mesh forces of each planet over a mesh cycle, and transmission error at the "
        f"{data.cycle.driving}. K_gamma = {data.mesh_load_factor:.4g}.",
        (
            Panel(x, Axis("mesh force", "N", zero=True), curves),
            Panel(x, axis_of(type(data), "te", "transmission error"), (curve_of(data, "s", "te"),)),
        ),
    )  # fmt: skip


def _harmonics(name: str, data: PlanetLoads, inputs: LoadInputs) -> Figure:
    order = inputs.phasing.harmonic.astype(float)
    bars = tuple(
        Bars(order, np.hypot(*_size(data, force_on(data, member), order)), member, f"series:{k}")
        for k, member in enumerate(CENTRALS)
    )
    none = not any(np.any(bar.y) for bar in bars)
    return Figure(
        f"planet_forces_{name}", f"Radial forces on sun, ring and carrier, set {name}",
        f"Set {name}: harmonics of the forces of the planets on sun, ring and carrier, amplitude; zero for floating "
        "members.",
        (
            Panel(
                Axis("mesh harmonic", whole=True), Axis("force", "N", limits=(0.0, 1.0) if none else None), bars,
                title="none (planet forces cancel)" if none else "",
            ),
        ),
    )  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    return Forecast({"planets": planetary_part(scene, name).count}, _LOADS)


PLANET_LOAD_SHARING = Stage(
    subjects=planetary_sets,
    needs=lambda _scene, name: (Task("set-cycle", name),),
    inputs=_load_inputs,
    compute=_compute,
    present=_present,
    cites=citing(Citation("lin-parker", "bodies and springs of the set", "section 2")),
    forecast=_forecast,
)
