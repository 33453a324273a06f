"""What a moving train neglects: contact loss and friction, from one motion with them at the speed where they matter."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import CONTACT_LOSS, FRICTION
from fegear.base.errors import FegearError
from fegear.base.printed import percent
from fegear.base.tally import note
from fegear.case.built.neglected_effects import remark
from fegear.case.effects import EffectsPart

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from fegear.dynamics.motion.motion_spec import MotionSpec
    from fegear.dynamics.motion.steady_state import SteadyState
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.gear_train import GearTrain


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


def _loaded(data: GearTrain) -> list[int]:
    """Meshes that carry a mean force."""
    least = 1e-9 * float(np.max(np.abs(data.forces)))
    return [m for m, force in enumerate(data.forces) if force > least]


def _changes(asked: MotionSpec, data: GearTrain, state: SteadyState) -> list[FactorChange]:
    """One motion with one effect more, at the speed of a state without it."""
    from fegear.dynamics.motion.moving_train import motion_model, steady_motion

    speed = state.model.speed
    other = steady_motion(asked, motion_model(asked, data, speed), asked.start, max(asked.tolerance, 1e-3))
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


def contact_loss_changes(asked: MotionSpec, data: GearTrain, states: Sequence[SteadyState]) -> list[FactorChange]:
    """What contact loss changes at the speed at which a mesh that may not part has the smallest force.

    No change, and no work, where no mesh force falls below zero and all teeth of a mesh touch at one approach: none
    would part then.
    """
    # a motion that grows has no size that an effect could change: its own remark names contact loss
    states = [state for state in states if state.kind != "growing"]
    if not states:
        return []
    least = [min(float(s.smallest[m] / data.forces[m]) for m in _loaded(data)) for s in states]
    worst = int(np.argmin(least))
    if least[worst] >= 0.0 and not (asked.parametric and any(_held_apart(m.excitation) for m in data.meshes)):
        return []
    return _changes(replace(asked, contact_loss=True), _with_backlash(data), states[worst])


def _with_backlash(data: GearTrain) -> GearTrain:
    """The train with room behind the teeth of gears that have none: what neglecting contact loss costs where it can be.

    Teeth at their nominal thickness have no backlash, for nobody has stated it; built ones have.
    """
    meshes = tuple(replace(mesh, backlash=mesh.backlash or math.inf) for mesh in data.train.meshes)
    return replace(data, train=replace(data.train, meshes=meshes))


def backlash_changes(asked: MotionSpec, data: GearTrain, states: Sequence[SteadyState]) -> list[FactorChange]:
    """What unlimited backlash changes where non-working flanks carry load for the largest part of the time.

    Of meshes without backlash whose teeth may lose contact; no work where their non-working flanks carry none, and
    none where a motion does not repeat, which takes long to find.
    """
    tight = [m for m in _loaded(data) if data.train.meshes[m].backlash == 0.0] if asked.contact_loss else []
    known = [state for state in states if state.kind == "periodic" and any(state.behind[m] > 0.0 for m in tight)]
    if not known:
        return []
    worst = max(known, key=lambda state: max(float(state.behind[m]) for m in tight))
    return [change for change in _changes(asked, _with_backlash(data), worst) if change.mesh in tight]


def friction_changes(asked: MotionSpec, data: GearTrain, states: Sequence[SteadyState]) -> list[FactorChange]:
    """What tooth friction changes at the speed of the largest dynamic factor."""
    if not asked.parametric or not all(mesh.excitation.slotted for mesh in data.meshes):
        return []  # lumped teeth have no place at which they slide
    # A motion that does not repeat takes long to find, and friction would have to be seen in its wandering.
    steady = [s for s in states if s.kind == "periodic"]
    factors = [max(float(s.tooth_force[m] / data.forces[m]) for m in _loaded(data)) for s in steady]
    return _changes(replace(asked, friction=True), data, steady[int(np.argmax(factors))]) if steady else []


#: What one more effect changes, by the effects of which that is estimated.
SIZED: dict[str, Callable[[MotionSpec, GearTrain, Sequence[SteadyState]], list[FactorChange]]] = {
    CONTACT_LOSS.name: contact_loss_changes,
    FRICTION.name: friction_changes,
}


@dataclass(frozen=True)
class NeglectedInMotion:
    """Effects of a motion that are off.

    Parameters
    ----------
    changes : mapping of str to tuple of FactorChange
        What each of them would change.
    failed : mapping of str to str
        Why the size of an effect cannot be estimated.
    """

    changes: Mapping[str, tuple[FactorChange, ...]]
    failed: Mapping[str, str]


def neglected_in_motion(asked: MotionSpec, data: GearTrain, states: Sequence[SteadyState]) -> NeglectedInMotion:
    """What contact loss and friction would change where they are off."""
    from fegear.contact.plane.neglected_effects import COUNTED  # late: the estimates, which no plan needs

    changes: dict[str, tuple[FactorChange, ...]] = {}
    failed: dict[str, str] = {}
    for effect, estimate in SIZED.items():
        if getattr(asked, effect) or not states:
            continue
        try:
            note(COUNTED)
            changes[effect] = tuple(estimate(asked, data, states))
        except FegearError as error:
            failed[effect] = str(error)
    return NeglectedInMotion(changes, failed)


def motion_remarks(
    found: NeglectedInMotion, data: GearTrain, effects: EffectsPart, tolerance: float
) -> tuple[str, ...]:
    """Contact loss and friction that are off and would change the dynamic factor by more than the tolerance."""
    said = []
    for effect in SIZED:
        if effect in found.failed:
            said.append(f"{effect} is off; its influence cannot be estimated: {found.failed[effect]}")
        sizes = [
            f"the dynamic factor of mesh {data.names[change.mesh]} by {change.size:+.3g} ({percent(change.share)}, at "
            f"{change.speed * data.speed_ratio * 30.0 / np.pi:.5g} rpm of {data.speed_of})"
            for change in found.changes.get(effect, ())
            if change.share > tolerance
        ]
        if sizes:
            said.append(remark("Motion", effects, tolerance, effect, sizes))
    return tuple(said)
