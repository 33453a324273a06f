"""Stage ``gear-train``: the train of the case with the stiffness and transmission error of its gear pairs.

What several results of a train share: its meshes, the speeds that they need, and a sentence on teeth that part.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming, neglecting
from fegear.base.printed import figures, percent
from fegear.base.shown import shown, shows
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.pair_checks import check_odd_teeth, check_relief
from fegear.case.built.train import MeshTeeth, TrainInputs, check_train, train_inputs, train_part
from fegear.dynamics.train.gear_train import GearTrain, a_drives
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.train_spec import assemble, build_train
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.pair.loaded_teeth import (
    loaded_pair,
    needs_teeth,
    odd_teeth_task,
    pair_over_revolution,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.dynamics.train.back_flanks import BackFlanks
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.gear_train import TrainMesh
    from fegear.dynamics.train.tooth_force import Pull
    from fegear.dynamics.train.train import Mesh
    from fegear.dynamics.train.train_spec import MeshSpec
    from fegear.engine.sheet.seen import Seen


#: One mesh as springs [s]: tooth pairs that stand alone, and pairs that share.
_ALONE, _SHARED = 0.05, 0.6
#: Base pitches that differ in a revolution of a gear with odd teeth.
_PITCHES = 8


def the_train(scene: Scene) -> tuple[str, ...]:
    """The one train of a case that has one."""
    return () if scene.case.train is None else ("",)


def needs_train(_scene: Scene, _subject: str) -> tuple[Task, ...]:
    """The task of this stage."""
    return (Task("gear-train"),)


def gear_train(upstream: Mapping[Task, object]) -> GearTrain:
    """What this stage computed."""
    return cast("GearTrain", upstream[Task("gear-train")])


def needs_meshes(scene: Scene, _subject: str = "") -> tuple[Task, ...]:
    """The tasks that load the teeth of the meshes."""
    part = train_part(scene)
    needed: dict[Task, None] = {}
    for name, mesh in part.mesh.items():
        pair = part.loaded_pair_of(name)
        # teeth like those of another mesh are those of perfect gears
        needed.update(dict.fromkeys(needs_teeth(scene, pair) if mesh.like else (odd_teeth_task(scene, pair),)))
        needed.update(dict.fromkeys(needs_teeth(scene, mesh.back_pair) if mesh.back_pair else ()))
    return tuple(needed)


def _check(scene: Scene, _subject: str) -> None:
    check_train(scene)
    part = train_part(scene)
    for name, mesh in part.mesh.items():
        if mesh.like and part.loaded_pair_of(name) in scene.wide_pairs:
            raise InputError(
                f"train.mesh.{name}.like.pair", f'"{mesh.like.pair}"',
                "uses a 3D load distribution, which cannot be scaled to another face width", "specify a separate pair",
            )  # fmt: skip
        _check_spacing(scene, part.loaded_pair_of(name))
    for name in dict.fromkeys(part.loaded_pair_of(mesh) for mesh in part.mesh):
        check_relief(scene, name)
        if name not in scene.wide_pairs:
            check_odd_teeth(scene, name)


def _check_spacing(scene: Scene, name: str) -> None:
    """Refuse spacing errors of teeth with a width: their flanks are loaded in one base pitch of all that differ."""
    pair = scene.case.pair[name]
    uneven = [gear for gear in (pair.driver, pair.driven) if scene.case.gear[gear].spacing_errors is not None]
    if scene.case.effects.spacing_errors and name in scene.wide_pairs and uneven:
        raise InputError(
            f"gear.{uneven[0]}.spacing_errors", "(given)",
            f"is not supported in a train with the 3D flanks of pair {name} (one base pitch only)",
            "remove it, or switch spacing_errors off",
        )  # fmt: skip


def compute_train(asked: TrainInputs, upstream: Upstream, work: Work) -> GearTrain:
    """Springs and excitation of every mesh under its mean force, put into the train."""
    from fegear.dynamics.train.flank_excitation import excitation_of_flanks
    from fegear.dynamics.train.mesh_excitation import mesh_excitation
    from fegear.results.pair.loaded_flanks import loaded_flanks  # late: a plan of plane pairs does without

    train = build_train(asked.spec)
    forces, forward = static_forces(train), a_drives(train)
    excitations: dict[str, MeshExcitation] = {}
    backs: dict[str, BackFlanks] = {}
    for number, (name, teeth) in enumerate(asked.teeth.items()):
        pair, force, width = teeth.pair, abs(float(forces[number])), teeth.width_ratio
        if Task("loaded-flanks", pair) in upstream:
            found = excitation_of_flanks(
                loaded_flanks(upstream, pair), force / teeth.halves, forward=forward[number]
            ).widened(teeth.halves)
        else:
            loaded = pair_over_revolution(upstream, pair) if teeth.odd else loaded_pair(upstream, pair)
            engagement = loaded.engagement.unmodified() if teeth.like else loaded.engagement
            found = mesh_excitation(
                engagement if forward[number] else engagement.reversed(), force / width or loaded.nominal
            )
        excitations[name] = found.widened(width)
        if teeth.back:
            backs[name] = _back(asked.spec.meshes[number], teeth, force, upstream, forward=forward[number])
        work.progress((number + 1) / len(asked.teeth))
    made = assemble(asked.spec, excitations)
    meshes = tuple(
        replace(one, doubt=_doubt(loaded_flanks(upstream, teeth.pair), teeth.halves))
        if Task("loaded-flanks", teeth.pair) in upstream else one
        for teeth, one in zip(asked.teeth.values(), made.meshes, strict=True)
    )  # fmt: skip
    with_backs = tuple(replace(one, back=backs.get(name)) for name, one in zip(asked.teeth, meshes, strict=True))
    return replace(made, meshes=with_backs)


def _back(mesh: MeshSpec, teeth: MeshTeeth, force: float, upstream: Upstream, *, forward: bool) -> BackFlanks:
    """Back flanks of a mesh under the torque of its mean force [N]."""
    from fegear.dynamics.train.back_flanks import back_flanks, leverage
    from fegear.dynamics.train.flank_excitation import excitation_of_flanks
    from fegear.dynamics.train.mesh_excitation import mesh_excitation
    from fegear.results.pair.loaded_flanks import loaded_flanks  # late: a plan of plane pairs does without

    load = force / leverage(mesh.pair)
    if Task("loaded-flanks", teeth.back) in upstream:
        flanks = loaded_flanks(upstream, teeth.back)
        found = excitation_of_flanks(flanks, load / teeth.halves, forward=forward).widened(teeth.halves)
    else:
        loaded = loaded_pair(upstream, teeth.back)
        engagement = loaded.engagement if forward else loaded.engagement.reversed()
        found = mesh_excitation(engagement, load or loaded.nominal)
    return back_flanks(mesh.pair if forward else mesh.pair.reversed(), found.total_stiffness())


def _doubt(data: LoadedWidePair, halves: int) -> tuple[float, float]:
    """Estimated errors of mean stiffness [N/m] and peak-to-peak transmission error [m] under the nominal load."""
    i, found, coarse = data.at, data.found, data.error.coarse
    fine, other = (1.0 / float(one.lines.mean(1.0 / one.contact.stiffness[:, i])) for one in (found, coarse))
    return halves * abs(other - fine), float(data.error.peak_to_peak[i])


@dataclass(frozen=True)
class MeshRow:
    """One mesh of a train as its springs are.

    Parameters
    ----------
    made : TrainMesh
        With its excitation.
    spring : Mesh
        In the train.
    teeth : MeshTeeth
        Whose they are.
    """

    made: TrainMesh
    spring: Mesh
    teeth: MeshTeeth

    @property
    @shows("N", "mean axial force (helix)")
    def axial_force(self) -> float | None:
        """[N]; None for spur gears, and for double helical ones, whose halves balance."""
        if self.teeth.halves > 1:
            return None
        helix = self.made.pair.driver.base_helix_angle
        return self.made.force * math.tan(helix) if helix else None

    @property
    @shows("N", "force along the line of action, from the torques")
    def mean_force(self) -> float:
        """[N]."""
        return self.made.force

    @property
    @shows(
        "N/um", "1 / mean of 1 / tangent mesh stiffness, the spring of the train; transmission-error has arithmetic "
        "means: mesh_stiffness_mean (secant), local_stiffness_mean (tangent)",
    )  # fmt: skip
    def mean_stiffness(self) -> float:
        """[N/m]."""
        return self.spring.stiffness

    @property
    @shows("N/um", "mean stiffness of the non-working flanks, along the line of action of the working flanks")
    def back_stiffness(self) -> float | None:
        """[N/m]; None where they are not known apart."""
        return None if self.made.back is None else float(self.made.back.even.stiffness(0.0))

    @property
    @shows("um", "peak to peak of the static transmission error under the mean force")
    def static_te_peak_to_peak(self) -> float:
        """[m]."""
        pitches = self.made.error.pitches
        return float(np.ptp(self.made.error(np.linspace(0.0, pitches, 2000 * pitches + 1))))

    @property
    def doubt(self) -> tuple[float | None, float | None]:
        """Estimated errors of both where they are known [N/m], [m]."""
        return self.made.doubt or (None, None)

    @property
    def pitches(self) -> int:
        """Base pitches after which its excitation repeats; 1 for teeth like those of another mesh."""
        return self.made.error.pitches if not self.teeth.like else 1

    @property
    def why_uneven(self) -> str:
        """What makes base pitches differ."""
        return "odd teeth" if self.teeth.odd else "spacing errors"


@dataclass(frozen=True)
class BodyRow:
    """A body of a train with its moment of inertia [kg m^2]."""

    sources: str
    inertia: float = shown("kg.m^2")


def _meshes(seen: Seen) -> dict[str, MeshRow]:
    parts = zip(seen.data.meshes, seen.data.train.meshes, seen.asked.teeth.items(), strict=True)
    return {name: MeshRow(made, spring, teeth) for made, spring, (name, teeth) in parts}


def _bodies(seen: Seen) -> dict[str, BodyRow]:
    sources = seen.asked.sources
    return {body.name: BodyRow(sources[body.name], body.inertia) for body in seen.asked.spec.bodies}


def _whose_speeds(seen: Seen) -> list[str]:
    """Say whose speeds are meant, where bodies turn at different speeds and the order of tables alone tells."""
    data, asked = seen.data, seen.asked
    ratios = np.abs(data.train.ratios)
    if not asked.assumed or float(np.ptp(ratios)) <= 1e-12 * float(ratios.max()):
        return []
    low, high = (float(ratio) / data.speed_ratio for ratio in (ratios.min(), ratios.max()))
    said = assuming(
        f"dynamics.speed_of not specified: speeds refer to {asked.spec.reference}, the first table under [train.body]. "
        f"Other bodies rotate at {low:.4g} to {high:.4g} times this speed; set speed_of under [dynamics]."
    )
    return [said]


def _unlikely(seen: Seen) -> Iterator[str]:
    """Inertias that look like another unit."""
    for name, ratio in seen.asked.unlikely.items():
        (given,) = (body.inertia for body in seen.asked.spec.bodies if body.name == name)
        yield assuming(
            f"train.body.{name}.inertia is {figures(ratio, 2)} times the inertia of its gears (body in all "
            f"{figures(given, 3)} kg m²): check the unit, 1 kg m² = 10⁶ kg mm²."
        )


def _on_axial_force(seen: Seen) -> str:
    return neglecting(
        f"Mesh {seen.key}: axial force of {seen.one.axial_force:.5g} N on bearings assumed rigid; the train includes "
        "rotation only. Request transmissibility with mesh.pair for axial motion and tilting."
    )


_SHEET = Sheet(
    name=lambda _asked: "",
    values=(
        Each(
            _meshes,
            Number("axial_force", owner="{key}"),
            Number("mean_force", owner="{key}"),
            Number("mean_stiffness", lambda seen: seen.one.doubt[0], owner="{key}"),
            Number("back_stiffness", owner="{key}"),
            Number("static_te_peak_to_peak", lambda seen: seen.one.doubt[1], owner="{key}"),
        ),
        Number("inertia", each=_bodies, owner="{key}", meaning="moment of inertia of body {key}: {one.sources}"),
    ),
    remarks=(
        _whose_speeds,
        _unlikely,
        Remark(
            neglecting("train.torque_ripple ignored because effects.torque_ripple is off (constant torques)."),
            when=lambda seen: seen.asked.idle_ripple,
        ),
        Each(
            _meshes,
            Remark(
                "Mesh {key}: by the torques {one.spring.b} drives {one.spring.a}; x is positive towards the tip of "
                "the gear on {one.spring.b}.",
                when=lambda seen: not seen.one.made.a_drives,
            ),
            Remark(
                "Mesh {key}: coupled teeth and corner contact are linearised at the mean load.",
                when=lambda seen: not seen.one.made.excitation.slotted,
            ),
            Remark(
                "Mesh {key}: its excitation repeats after {one.pitches} base pitches ({one.why_uneven}).",
                when=lambda seen: seen.one.pitches > 1,
            ),
            Remark(_on_axial_force, when="axial_force"),
            Remark(
                neglecting(
                    "Mesh {key}: double helical, two equal meshes in parallel; axial mass and friction of the "
                    "floating member are neglected, tooth forces are those of both halves together."
                ),
                when=lambda seen: seen.one.teeth.halves > 1,
            ),
        ),
    ),
    settings={"inertia": lambda seen: {body.name: body.inertia for body in seen.data.train.bodies}},
)  # fmt: skip


#: Seconds of the springs of the first mesh beside those of each: what integrates them is loaded and compiled once.
_SPRINGS = 0.3


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """Springs of every mesh."""
    effects, count = scene.case.effects, len(scene.case.train.mesh) if scene.case.train else 0
    each = _SHARED if effects.corner_contact or effects.neighbour_coupling else _ALONE
    part = scene.case.train
    odd = [odd_gears_of(scene, part.loaded_pair_of(mesh)) for mesh in part.mesh] if part else []
    return forecasts.constant(_SPRINGS + each * count + sum(_PITCHES ** len(gears) * _SHARED for gears in odd if gears))


#: What every result of a train rests on.
TRAIN_SOURCES = citing(
    Citation("mark", "gear train of rotors, shafts and meshes", "section 2"),
    Citation("lin-huston-coy", "four-inertia model, damping", "Eqs. 1 to 4 and 16"),
)


RPM = 30.0 / math.pi
#: Of root stress and strain in motion where teeth differ.
ORDINARY_ROOTS = neglecting(
    "Mesh {asked.mesh}: root stress in motion is that of ordinary teeth, under forces that follow the odd teeth; "
    "request mesh-stiffness-revolution for the root stress of every tooth."
)


#: A mesh with less of the largest mean force carries none.
_NO_SHARE = 1e-9


def meshes(scene: Scene) -> tuple[str, ...]:
    """All meshes of the train, by name."""
    return () if scene.case.train is None else tuple(scene.case.train.mesh)


def own_meshes(scene: Scene) -> tuple[str, ...]:
    """Meshes whose teeth are described by their own pair."""
    return tuple(name for name in meshes(scene) if train_part(scene).mesh[name].like is None)


def carries_nothing(data: GearTrain, mesh: int) -> bool:
    """Whether a mesh idles."""
    return bool(data.forces[mesh] <= _NO_SHARE * float(np.max(np.abs(data.forces))))


def from_exciter(data: GearTrain, number: int) -> str:
    """Entry of a legend for the part that one mesh, or one torque ripple, excites."""
    kind = "mesh" if number < len(data.names) else "torque ripple"
    return f"from {kind} {data.exciters[number]}"


def what_excites(data: GearTrain) -> str:
    """What parts of a force are told apart by."""
    return "exciting mesh or torque ripple" if data.ripple else "exciting mesh"


def needs_plane_teeth(scene: Scene, mesh: str, key: str, value: str) -> None:
    """Refuse what follows one place of contact on the path where the teeth of a mesh touch along lines over the face.

    Raises
    ------
    InputError
    """
    pair = train_part(scene).loaded_pair_of(mesh)
    if pair in scene.wide_pairs:
        helical = scene.pairs[pair].driver.helix_angle != 0.0
        raise InputError(
            key, value, f"applies to point contact on the path; the teeth of mesh {mesh} are 3D",
            "remove it" if helical else f'remove it, or set pair.{pair}.width = "plane"',
        )  # fmt: skip


def needs_one_speed(scene: Scene, _subject: str) -> None:
    """Refuse histories without a speed."""
    if math.isnan(scene.case.dynamics.one_speed):
        raise InputError("dynamics.speed", "(not given)", "is required for this result", 'set speed = "10000 rpm"')


def needs_speeds(scene: Scene, _subject: str) -> None:
    """Refuse sweeps without speeds."""
    if not scene.case.dynamics.speed_values.size:
        raise InputError(
            "dynamics.speeds", "(not given)", "is required for this result",
            'set speeds = { start = "2000 rpm", stop = "16000 rpm", count = 57 }',
        )  # fmt: skip


def pull_remarks(pull: Pull | None) -> tuple[str, ...]:
    """Say how far the linearised force of a mesh falls below zero, if it does."""
    if pull is None:
        return ()
    where = f"{percent(pull.share)} of the mean force, at {pull.speed * RPM:.5g} rpm of {pull.speed_of}"
    sentence = neglecting(
        f"Mesh {pull.mesh}: minimum linearised mesh force {pull.force:.4g} N ({where}), i.e. loss of contact, not "
        "modelled here; request dynamic-factor with effects.contact_loss = true."
    )
    return (sentence,)


GEAR_TRAIN = Stage(
    subjects=the_train,
    needs=needs_meshes,
    inputs=lambda scene, _subject: train_inputs(scene),
    compute=compute_train,
    present=_SHEET.present,
    check=_check,
    answers=("transmission error",),
    cites=TRAIN_SOURCES,
    forecast=_forecast,
)
