"""Stages ``meshed-set`` and ``planet-load-sharing``: the teeth of a set, and how its planets share the torque."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.planetary import given_teeth, pin_errors, planetary_part, set_inputs
from fegear.case.effects import PLANE_EFFECTS
from fegear.case.planetary import set_pair
from fegear.dynamics.planetary.planet_loads import MeshedSet, force_on, planet_loads
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, columns_of, curve_of, value_of
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.planetary import SetInputs
    from fegear.case.planetary import Mesh
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.planet_loads import PlanetLoads
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.engine.stage import Upstream, Work

#: Springs of the sun's mesh [s], and the equilibrium over the cycle.
_TEETH, _LOADS = 0.6, 0.03
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
    meshes: tuple[Mesh, ...] = ("sun", "ring") if part.ring is not None else ("sun",)
    return tuple(mesh for mesh in meshes if getattr(part.stiffness, f"{mesh}_mesh") is None)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return tuple(Task("loaded-pair", set_pair(name, mesh)) for mesh in _solved(scene, name))


def _check(scene: Scene, name: str) -> None:
    set_inputs(scene, name)
    part = planetary_part(scene, name)
    if part.ring is None and part.stiffness.ring_mesh is None:
        raise InputError(
            f"planetary.{name}.stiffness.ring_mesh", "(not given)", "is needed, for the ring is no gear of the case",
            'write stiffness = { ring_mesh = "700 N/um" }, or describe the ring and write ring = "its name"',
        )  # fmt: skip
    for pair in (set_pair(name, mesh) for mesh in _solved(scene, name)):
        if pair in scene.wide_pairs:
            raise InputError(
                f"pair.{pair}.width", f'"{scene.width_of(pair)}"', "is not known to a set: its teeth are plane",
                'write width = "plane"',
            )  # fmt: skip


def _meshed(asked: SetInputs, upstream: Upstream, _work: Work) -> MeshedSet:
    from fegear.dynamics.train.mesh_excitation import mesh_excitation

    force = asked.sun_torque / (asked.found.base_radius("sun") * asked.found.count)

    def teeth(mesh: Mesh) -> MeshExcitation:
        given = asked.given[mesh]
        if given is not None:
            return given_teeth(given)
        return mesh_excitation(loaded_pair(upstream, set_pair(asked.name, mesh)).engagement, force)

    return MeshedSet(asked.model, teeth("sun"), teeth("ring"), asked.phases, asked.sun_torque, asked.run.input)


def _present_meshed(data: MeshedSet, asked: SetInputs) -> Outcome:
    said = []
    solved = [one for mesh, one in zip(("sun", "ring"), data.teeth, strict=True) if asked.given[mesh] is None]
    if any(not one.slotted for one in solved):
        said.append(f"Set {asked.name}: coupled teeth and contacts off the path are linear about an equal share.")
    if asked.given["ring"] is not None:
        said.append(f"Set {asked.name}: the mesh stiffness of planet and ring is the given one.")
    if asked.run.mesh_efficiency < 1.0:
        said.append(f"Set {asked.name}: planets share the torque without friction.")
    return Outcome(data, remarks=tuple(said))


MESHED_SET = Stage(
    subjects=planetary_sets,
    needs=_needs,
    inputs=set_inputs,
    compute=_meshed,
    present=_present_meshed,
    check=_check,
    effects=PLANE_EFFECTS,
    cites=citing(Citation("mark", "tooth pairs as springs about the mean load", "section 2")),
    forecast=lambda _scene, _name: forecasts.constant(_TEETH),
    internal=True,
)


@dataclass(frozen=True)
class LoadInputs:
    """What a set's loads depend on besides its teeth.

    Parameters
    ----------
    errors : ndarray, shape (2, planets)
        Of the pins, radial and counter-clockwise [m].
    harmonics : int
    name : str
    """

    errors: Array
    harmonics: int
    name: str


def _load_inputs(scene: Scene, name: str) -> LoadInputs:
    part = planetary_part(scene, name)
    return LoadInputs(pin_errors(part), part.harmonics, name)


def _compute(inputs: LoadInputs, upstream: Upstream, _work: Work) -> PlanetLoads:
    return planet_loads(meshed_set(upstream, inputs.name), inputs.errors)


def _tables(data: PlanetLoads, inputs: LoadInputs) -> tuple[Table, ...]:
    name, count = inputs.name, data.mesh_force.shape[1]
    order = np.arange(1.0, inputs.harmonics + 1.0)
    over = [*columns_of(data, "s", "te")]
    over += [Column(f"load_{n + 1}", data.mesh_force[0, n], "N", "in the meshes of this planet, along the line of "
                    "action") for n in range(count)]  # fmt: skip
    pins = data.pin_force @ data.weights
    pins = np.where(np.abs(pins) < _ROUND_OFF * data.mean_force, 0.0, pins)
    shares = (
        Column("planet", np.arange(1, count + 1), "", "counter-clockwise"),
        Column("tangential_error", inputs.errors[1], "um", "of its pin, counter-clockwise"),
        Column("radial_error", inputs.errors[0], "um", "of its pin, outward"),
        *columns_of(data, "shares"),
        Column("largest_load", data.mesh_force[0].max(axis=1), "N", "largest mesh force over the cycle"),
        Column("apart_sun", data.lifted[0], "", "share of the cycle without contact with the sun"),
        Column("apart_ring", data.lifted[1], "", "share of the cycle without contact with the ring"),
        Column("pin_radial", pins[0], "N", "mean force of the pin on the planet, outward"),
        Column("pin_tangential", pins[1], "N", "mean force of the pin on the planet, counter-clockwise"),
    )
    forces = [
        Column("n", order.astype(int), "", "mesh harmonic"),
        Column("te", _size(data, data.te, order), "um", "0-peak"),
    ]
    for member in CENTRALS:
        force = np.hypot(*_size(data, force_on(data, member), order))
        forces.append(Column(f"force_{member}", force, "N", f"on the {member} across the axis, root of the sum of "
                             "squares of both directions, 0-peak"))  # fmt: skip
    return (
        Table(f"planet_loads_{name}", tuple(over), f"Loads of the planets of {name} over the mesh cycle"),
        Table(f"planet_shares_{name}", shares, f"Load sharing of the planets of {name}", printed=True),
        Table(f"planet_forces_{name}", tuple(forces), f"Harmonics of the transmission error and of forces in {name}"),
    )


def _size(data: PlanetLoads, values: Array, order: Array) -> Array:
    """Amplitudes of harmonics, 0-peak; what is round-off is zero."""
    found = 2.0 * np.abs(data.harmonics(values, order))
    scale = data.mean_force if values.ndim > 1 else float(np.max(np.abs(values)))
    return np.where(found < _ROUND_OFF * scale, 0.0, found)


def _present(data: PlanetLoads, inputs: LoadInputs) -> Outcome:
    name = inputs.name
    values = [value_of(data, key, name)
              for key in ("mesh_load_factor", "largest_share", "te_mean", "te_peak_to_peak")]  # fmt: skip
    said = []
    apart = [f"planet {n + 1} ({share:.0%} of the cycle)" for n, share in enumerate(data.lifted.max(axis=0)) if share]
    if apart:
        said.append(f"Set {name}: without contact: {', '.join(apart)}.")
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
        f"Set {name}: force in the meshes of each planet over a mesh cycle, and the transmission error of the set at "
        f"its {data.meshed.driving}. K_gamma = {data.mesh_load_factor:.4g}.",
        (
            Panel(x, Axis("mesh force", "N", zero=True), curves),
            Panel(x, axis_of(type(data), "te", "transmission error"), (curve_of(data, "s", "te"),)),
        ),
    )  # fmt: skip


def _harmonics(name: str, data: PlanetLoads, inputs: LoadInputs) -> Figure:
    order = np.arange(1.0, inputs.harmonics + 1.0)
    bars = tuple(
        Bars(order, np.hypot(*_size(data, force_on(data, member), order)), member, f"series:{k}")
        for k, member in enumerate(CENTRALS)
    )
    return Figure(
        f"planet_forces_{name}", f"Forces across the axis of set {name}",
        f"Set {name}: harmonics of the forces of the planets on sun, ring and carrier, 0-peak; a member that floats "
        "feels none.",
        (Panel(Axis("mesh harmonic", whole=True), Axis("force", "N"), bars),),
    )  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    return Forecast({"planets": planetary_part(scene, name).count}, _LOADS)


PLANET_LOAD_SHARING = Stage(
    subjects=planetary_sets,
    needs=needs_meshed,
    inputs=_load_inputs,
    compute=_compute,
    present=_present,
    cites=citing(Citation("lin-parker", "bodies and springs of the set", "section 2")),
    forecast=_forecast,
    internal=True,
)
