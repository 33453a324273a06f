"""What a moving train leaves out: contact loss and friction, from one motion with them at the speed where they tell."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import FegearError
from fegear.models.motion import motion_model
from fegear.models.neglected_effects import percent, remark
from fegear.tally import tallying

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.case.reading import Scene
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.gear_train import GearTrain
    from fegear.dynamics.steady_state import SteadyState


#: Separations that differ by less are the same [m].
_NOTHING = 1e-12


@dataclass(frozen=True, slots=True)
class FactorChange:
    """What one more effect does to the dynamic factor of a mesh at one speed.

    Parameters
    ----------
    mesh : int
    speed : float
        Of the first body [rad/s].
    factor, size : float
        Dynamic factor without the effect, and how much it changes.
    """

    mesh: int
    speed: float
    factor: float
    size: float

    @property
    def share(self) -> float:
        """Size over factor, positive."""
        return abs(self.size) / self.factor


def with_effects(scene: Scene, **chosen: bool) -> Scene:
    """The scene with some effects switched."""
    effects = scene.case.effects.model_copy(update=chosen)
    return replace(scene, case=scene.case.model_copy(update={"effects": effects}))


def _loaded(data: GearTrain) -> list[int]:
    """Meshes that carry a mean force."""
    least = 1e-9 * float(np.max(np.abs(data.forces)))
    return [m for m, force in enumerate(data.forces) if force > least]


def _changes(scene: Scene, data: GearTrain, state: SteadyState) -> list[FactorChange]:
    """One motion of a scene with one effect more, at the speed of a state without it."""
    from fegear.dynamics.steady_state import steady_state

    part = scene.case.dynamics
    start = "rest" if part.direction == "rest" else "static"
    speed = state.model.speed
    other = steady_state(motion_model(scene, data, speed), start=start, tolerance=max(part.tolerance, 1e-3))
    found = []
    for m in _loaded(data):
        before, after = (float(s.tooth_force[m] / data.forces[m]) for s in (state, other))
        found.append(FactorChange(m, speed, before, after - before))
    return found


def _held_apart(excitation: MeshExcitation) -> bool:
    """Whether a modification makes tooth pairs of one mesh touch at different approaches."""
    s = (np.arange(64) + 0.5) / 64
    pairs = zip(excitation.stiffness, excitation.separation, strict=True)
    touch = np.array([np.where(k(s) > 0.0, m(s), np.nan) for k, m in pairs])
    spread = np.nanmax(touch, axis=0) - np.nanmin(touch, axis=0)
    return bool(spread.max() > _NOTHING)


def contact_loss_changes(scene: Scene, data: GearTrain, states: Sequence[SteadyState]) -> list[FactorChange]:
    """What contact loss changes at the speed at which a mesh that may not part has the smallest force.

    No change, and no work, where no mesh force falls below zero and all teeth of a mesh touch at one approach: none
    would part then.
    """
    least = [min(float(s.smallest[m] / data.forces[m]) for m in _loaded(data)) for s in states]
    worst = int(np.argmin(least))
    if least[worst] >= 0.0 and not (
        scene.case.effects.parametric and any(_held_apart(m.excitation) for m in data.meshes)
    ):
        return []
    return _changes(with_effects(scene, contact_loss=True), data, states[worst])


def friction_changes(scene: Scene, data: GearTrain, states: Sequence[SteadyState]) -> list[FactorChange]:
    """What tooth friction changes at the speed of the largest dynamic factor."""
    effects = scene.case.effects
    if not effects.parametric or not all(mesh.excitation.slotted for mesh in data.meshes):
        return []  # lumped teeth have no place at which they slide
    # A motion that does not repeat takes long to find, and friction would have to be told from its wandering.
    steady = [s for s in states if s.kind == "periodic"]
    factors = [max(float(s.tooth_force[m] / data.forces[m]) for m in _loaded(data)) for s in steady]
    return _changes(with_effects(scene, friction=True), data, steady[int(np.argmax(factors))]) if steady else []


def motion_remarks(scene: Scene, data: GearTrain, states: Sequence[SteadyState]) -> tuple[str, ...]:
    """Contact loss and friction that are off and would change the dynamic factor by more than the tolerance."""
    told = []
    for effect, changes in (("contact_loss", contact_loss_changes), ("friction", friction_changes)):
        if scene.case.effects.is_on(effect) or not states:
            continue
        try:
            with tallying():  # what the estimate runs is no part of the scene's own work
                found = changes(scene, data, states)
        except FegearError as error:
            told.append(f"{effect} is off, and what it would change could not be estimated: {error}")
            continue
        sizes = [
            f"the dynamic factor of mesh {data.names[change.mesh]} by {change.size:+.3g} ({percent(change.share)}, at "
            f"{change.speed * data.speed_ratio * 30.0 / np.pi:.5g} rpm of {data.speed_of})"
            for change in found
            if change.share > scene.case.accuracy.tolerance
        ]
        if sizes:
            told.append(remark("Motion", scene.case.effects, scene.case.accuracy.tolerance, effect, sizes))
    return tuple(told)
