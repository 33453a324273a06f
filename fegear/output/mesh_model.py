"""From a case to the meshes that its FMUs hold: loaded pairs, and what their train says of damping and backlash."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from fegear.base.errors import InputError
from fegear.case.built.train import build_train, train_inputs
from fegear.dynamics.train.gear_train import a_drives
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.output.fmu import MeshModel
from fegear.results.catalogue import STAGES
from fegear.results.pair.loaded_teeth import loaded_pairs, needs_teeth, teeth_of

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import LoadedTeeth
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.dynamics.train.excitation import MeshExcitation


def mesh_models(scene: Scene) -> list[tuple[MeshModel, str]]:
    """Every loaded pair of a case, solved, with a remark on where its damping and backlash come from.

    Raises
    ------
    InputError
        If the case has no pair, or one cannot be loaded.
    """
    if not scene.pairs:
        raise InputError("pair", "(not given)", "is missing: an FMU is of two gears in mesh", "add [pair.NAME]")
    tasks = [task for name in loaded_pairs(scene) for task in needs_teeth(scene, name)]
    alone = replace(scene, case=scene.case.model_copy(update={"results": []}), estimates=False)
    found = run_plan(alone, make_plan(alone, STAGES, tasks)).outcomes
    return [_model(scene, task.subject, cast("LoadedTeeth", teeth_of(task, found[task].data))) for task in tasks]


def _model(scene: Scene, name: str, teeth: LoadedTeeth) -> tuple[MeshModel, str]:
    part, forward, mesh = scene.case.train, True, None
    of = [m for m, one in part.mesh.items() if one.like is None and part.pair_of(m) == name] if part else []
    if part and of:
        number = list(part.mesh).index(of[0])
        forward = a_drives(build_train(train_inputs(scene)))[number]
    found = tuple(_springs(teeth, load, forward=forward) for load in teeth.loads)
    about = "no damping is given, so it starts with none; set its parameter damping"
    if part and of:
        stiffness = 1.0 / found[teeth.loads.index(teeth.nominal)].mean_compliance()
        mesh = build_train(train_inputs(scene), {of[0]: stiffness}).meshes[number]
        found = tuple(replace(one, phase=part.mesh[of[0]].phase) for one in found)
        about = f"damping and phase are those of train.mesh.{of[0]}"
    pair = teeth.pair if forward else teeth.pair.reversed()
    backlash = max(pair.normal_backlash, 0.0) / math.cos(pair.driver.base_helix_angle)
    if mesh and math.isfinite(mesh.backlash):
        backlash = mesh.backlash
    model = MeshModel(
        name, pair, teeth.loads, teeth.nominal, found, backlash, mesh.damping if mesh else 0.0,
        mesh is not None and mesh.damping_law == "momentary",
    )  # fmt: skip
    return model, (
        f"Pair {name}, FMU: {about}; tooth friction is neglected, and teeth are linear about the "
        f"{len(teeth.loads)} load{'s' if len(teeth.loads) > 1 else ''} of the pair, between which forces are "
        "interpolated."
    )


def _springs(teeth: LoadedTeeth, load: float, *, forward: bool) -> MeshExcitation:
    """The springs of a pair under a mean load [N], as the motion of a train takes them."""
    if hasattr(teeth, "flanks"):
        from fegear.dynamics.train.flank_excitation import flank_excitation

        wide = cast("LoadedWidePair", teeth)
        return flank_excitation(wide.flanks, wide.flanks.solve([load], wide.gaps, wide.known), forward=forward)
    from fegear.dynamics.train.mesh_excitation import mesh_excitation

    engagement = cast("LoadedPair", teeth).engagement
    return mesh_excitation(engagement if forward else engagement.reversed(), load)
