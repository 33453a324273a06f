"""What results take, before they run: processor seconds of one core, within about a factor of three.

The numbers were measured on one core of a server over all the cases (benchmarks/forecasts.py prints the ratios). They
follow what a result does most of: gears solved, engagements shared, speeds run; below a twentieth of a second no
more is needed. Each result has its own forecast in its own file; what several of them count stands here.

Sources that several results share.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.tooth_influence import mesh_settings, seconds_of_gear
from fegear.case.reading import Scene
from fegear.engine.citation import Citation
from fegear.engine.stage import Forecast

#: Importing mesher and solvers, once in a process.
LIBRARIES = 0.2


#: One speed in time: linear, with contact loss, each further period until the motion repeats, friction of one mesh.
_LINEAR, _LOSS, _PERIOD, _FRICTION = 0.008, 0.03, 0.4, 0.06
#: One speed of a train with contact loss and a shaft or mesh without damping, where many of the motions never settle.
_ENDLESS = 0.7


def constant(seconds: float) -> Forecast:
    """A stage that takes about as long for every case."""
    return Forecast({}, seconds)


def shapes(scene: Scene, gears: Iterable[str]) -> dict[object, float]:
    """Seconds of the finite-element solutions of gears, each shape once; none on meshes of the user's own.

    Loading mesher and solvers counts as a shape too, for it happens once.
    """
    settings = mesh_settings(scene.case.accuracy)
    found: dict[object, float] = {}
    for name in gears:
        gear = scene.gears[name]
        if scene.case.gear[name].tooth_mesh is None:
            key = (gear.tooth, gear.bore_radius / gear.module, gear.material.poisson_ratio, gear.plane_assumption)
            found[key] = seconds_of_gear(settings)
    return {"libraries": LIBRARIES, **found}


def engagements(scene: Scene, pair: str) -> int:
    """The engagement itself, and those with one compliance each off by its error."""
    if scene.case.pair[pair].compliance.source != "fe":
        return 1
    return 4 if scene.case.effects.neighbour_coupling else 3


def loads(scene: Scene, pair: str) -> int:
    """How many loads a pair has."""
    return len(scene.case.pair[pair].all_loads(scene.pairs[pair]))


def sizes(scene: Scene) -> tuple[int, int]:
    """How many meshes and bodies the train has."""
    train = scene.case.train
    return (len(train.mesh), len(train.body)) if train else (0, 0)


def _pitches(scene: Scene, mesh: str) -> int:
    """Base pitches after which the teeth of a mesh that differ meet again."""
    part = scene.case.train
    if part is None or part.mesh[mesh].like is not None:
        return 1
    name = part.loaded_pair_of(mesh)
    odd, spaced = odd_gears_of(scene, name), scene.case.effects.spacing_errors
    pair = scene.case.pair[name]
    return math.lcm(*(
        scene.gears[gear].teeth
        for gear in (pair.driver, pair.driven)
        if gear in odd or (spaced and scene.case.gear[gear].spacing_errors is not None)
    ))  # fmt: skip


def periods(scene: Scene) -> int:
    """Periods of the fastest mesh after which all meshes stand as before, with teeth that differ."""
    from fegear.case.built.train import train_inputs
    from fegear.dynamics.train.torque_ripple import common_period
    from fegear.dynamics.train.train import common_multiple
    from fegear.dynamics.train.train_spec import build_train, speed_ratio

    spec = train_inputs(scene).spec
    train = build_train(spec)
    pitches = [_pitches(scene, mesh) for mesh in scene.case.train.mesh] if scene.case.train else []
    turns = common_multiple(count / order for count, order in zip(pitches, train.mesh_orders, strict=True))
    fastest = max(train.mesh_orders)
    speeds = scene.case.dynamics.speed_values
    if spec.ripple and speeds.size:
        turns *= common_period(turns, fastest, float(speeds[0]) / speed_ratio(spec, train), spec.ripple).count
    return round(float(turns * fastest))


def seconds_per_speed(scene: Scene) -> float:
    """Seconds of the steady motion at one speed."""
    effects, (meshes, _) = scene.case.effects, sizes(scene)
    each = (_LOSS if effects.contact_loss else _LINEAR) * (1.0 + _PERIOD * (periods(scene) - 1))
    endless = _ENDLESS if effects.contact_loss and has_undamped(scene) else 0.0
    return each + endless + (_FRICTION * meshes if effects.friction else 0.0)


def has_undamped(scene: Scene) -> bool:
    """Whether an elastic shaft or a mesh of the train has no damping."""
    train = scene.case.train
    if train is None:
        return False
    shafts = any(not (part.rigid or part.damping or part.damping_ratio) for part in train.shaft.values())
    return shafts or any(not (part.damping or part.damping_ratio) for part in train.mesh.values())


RING = (
    Citation("thomas", "one tooth sector for the full gear: harmonics of a cyclic structure"),
    Citation("gmsh", "mesh of the tooth"),
)


PATCH = Citation("johnson", "local contact deformation and exchange of its half-width", "sections 4.2(c) and 5.6")


HERTZ = Citation("hertz", "half-width and pressure of the contact")


INVOLUTE = Citation("iso-21771", "names and geometry of involute gears and pairs")


CLOSED_FORM_COMPLIANCES: dict[str, tuple[Citation, ...]] = {
    "cornell": (
        Citation("cornell", "compliance of tooth and foundation"),
        Citation("lin-huston-coy", "the form in which it is computed", "Eqs. 5 to 11"),
        Citation("lundberg-palmgren", "approach of the teeth"),
    ),
    "weber-banaschek": (Citation("weber-banaschek", "compliance of tooth, foundation and contact"),),
    "potential-energy": (
        Citation("yang-lin", "bending, axial and contact compliance"),
        Citation("tian", "shear compliance"),
        Citation("wan", "beam that starts on the root circle and follows the fillet"),
        Citation("sainsot", "compliance of the gear body", "Eqs. 14 and 15, Table 1"),
    ),
    "potential-energy-simplified": (
        Citation("yang-lin", "bending, axial and contact compliance"),
        Citation("tian", "shear compliance"),
        Citation("wu-zuo-parey", "beam of the involute from the base circle on, without fillet"),
        Citation("liang-zuo-pandey", "root circle and base circle apart"),
        Citation("sainsot", "compliance of the gear body", "Eqs. 14 and 15, Table 1"),
    ),
}


_CORNELL_STRESS = (
    Citation("cornell", "root stress"),
    Citation("mark", "the form in which Cornell's formula is computed", "Eqs. B.1 to B.10"),
)


_HEYWOOD = Citation("heywood", "fillet stress of a loaded projection")


ROOT_STRESS_CITATIONS: dict[str, tuple[Citation, ...]] = {
    "fe": RING,
    "cornell": _CORNELL_STRESS,
    "cornell-trochoid": _CORNELL_STRESS,
    "heywood": (_HEYWOOD, Citation("kelley-pedersen", "Heywood's formula for gear teeth")),
    "iso-6336-3": (Citation("iso-6336-3", "Y_F, Y_S and nominal root stress", "method B, clauses 5 to 9"),),
    "agma-908": (Citation("agma-908", "geometry factor J", "section 5"),),
    "dolan-broghamer": (
        Citation("dolan-broghamer", "stress concentration in the fillet"),
        Citation("lewis", "section of a beam of uniform strength"),
    ),
}


ROOT_STRESS_FORMULAS = tuple(
    dict.fromkeys(one for name, found in ROOT_STRESS_CITATIONS.items() if name != "fe" for one in found)
)
