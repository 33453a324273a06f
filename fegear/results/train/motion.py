"""Stage ``motion``: steady motions of the train over the speeds, for the results that are read from them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming, neglecting
from fegear.base.printed import percent
from fegear.case.built.neglected_in_motion import (
    SIZED,
    NeglectedInMotion,
    backlash_changes,
    motion_remarks,
    neglected_in_motion,
)
from fegear.case.built.train import motion_spec, train_inputs
from fegear.case.part import at
from fegear.dynamics.motion.motion_spec import MotionSpec
from fegear.dynamics.train.torque_ripple import LONGEST, common_period
from fegear.dynamics.train.train_spec import build_train, speed_ratio
from fegear.engine.citation import Citation
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.train.gear_train import gear_train, needs_plane_teeth, needs_train, the_train

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.case.built.neglected_in_motion import FactorChange
    from fegear.case.effects import EffectsPart
    from fegear.case.reading import Scene
    from fegear.dynamics.motion.steady_state import SteadyState
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.engine.sheet.seen import Seen

_RPM = 30.0 / math.pi
#: Shift of a ripple's frequency that is said.
_SHIFTED = 1e-9


@dataclass(frozen=True)
class SweepData:
    """Steady motions over speeds, in increasing order of speed, and what they neglect.

    `still`: the same without torque ripple, where there is any. `with_room`: what unlimited backlash changes of meshes
    without any, at the speed at which their non-working flanks carry load for the largest part of the time.
    """

    train: GearTrain
    states: tuple[SteadyState, ...]
    neglected: NeglectedInMotion
    still: tuple[SteadyState, ...] = ()
    with_room: tuple[FactorChange, ...] = ()


@dataclass(frozen=True)
class SweepInputs:
    """What the motions depend on besides the train.

    Parameters
    ----------
    motion : MotionSpec
    tolerance : float
        That neglected effects are compared with.
    idle_friction : bool
        Whether the case describes a friction that is off.
    effects : EffectsPart
        All of the case, for the remedies.
    neglected : bool
        Whether the sizes of effects that are off are estimated.
    """

    motion: MotionSpec
    tolerance: float = field(compare=False)
    idle_friction: bool = field(compare=False)
    effects: EffectsPart = field(compare=False)
    neglected: bool


def check_friction(scene: Scene, _subject: str = "") -> None:
    """Refuse friction where teeth are coupled or touch off the path."""
    effects = scene.case.effects
    # whose teeth touch along the face cannot be mended by effects: first
    if effects.friction and scene.case.train is not None:
        for mesh in scene.case.train.mesh:
            needs_plane_teeth(scene, mesh, "effects.friction", "true")
    if effects.friction and (effects.neighbour_coupling or effects.corner_contact):
        raise InputError(
            "effects.friction", "true", "requires uncoupled tooth pairs",
            "switch off neighbour_coupling and corner_contact",
        )  # fmt: skip


def check_motion(scene: Scene, subject: str = "") -> None:
    """Refuse friction where teeth are lumped, and torque ripple that shares no period with the meshes."""
    check_friction(scene, subject)
    _check_ripple(scene)
    _check_back_sides(scene)
    effects = scene.case.effects
    if effects.friction and not effects.parametric:
        raise InputError(
            "effects.friction", "true", "requires time-varying mesh stiffness", "set effects.parametric = true"
        )


def _check_back_sides(scene: Scene) -> None:
    """Refuse asymmetric teeth that might touch on their back flanks, whose stiffness a mesh does not have."""
    if not scene.case.effects.contact_loss:
        return
    asked = train_inputs(scene)
    for mesh in asked.spec.meshes:
        if mesh.pair.asymmetric and math.isfinite(mesh.room) and not asked.teeth[mesh.name].back:
            raise InputError(
                f"train.mesh.{mesh.name}.backlash", f"{mesh.room * 1e3:.6g} mm",
                "requires back_pair for asymmetric teeth with loss of contact (stiffness of the other flanks)",
                "set back_pair to a pair of the same gears with driver and driven exchanged, or "
                'backlash = "unlimited"',
            )  # fmt: skip


def _check_ripple(scene: Scene) -> None:
    """Refuse torque ripple so slow that no motion can be closed over its period."""
    if not scene.case.effects.torque_ripple or not motion_spec(scene).in_time:
        return
    spec = train_inputs(scene).spec
    train = build_train(spec)
    ratio = speed_ratio(spec, train)
    try:
        for speed in scene.case.dynamics.speed_values / ratio if spec.ripple else ():
            common_period(train.mesh_turns, max(train.mesh_orders), float(speed), spec.ripple)
    except InputError as error:
        raise at("train", error) from None


def _inputs(scene: Scene, _subject: str) -> SweepInputs:
    effects = scene.case.effects
    idle = "friction" in scene.case.dynamics.given and not effects.friction
    return SweepInputs(motion_spec(scene), scene.case.accuracy.tolerance, idle, effects, scene.sizes_neglected)


def _compute(asked: SweepInputs, upstream: Upstream, work: Work) -> SweepData:
    from fegear.dynamics.motion.moving_train import steady_motions  # late: the integrator, which no plan needs

    data = gear_train(upstream)
    if data.ripple:
        # side by side: what the meshes do by themselves, and what they do under a torque that fluctuates
        half = [lambda share, start=start: work.progress(start + 0.5 * share) for start in (0.0, 0.5)]
        still = steady_motions(asked.motion, replace(data, ripple=()), half[0])
        states = steady_motions(asked.motion, data, half[1])
    else:
        still, states = (), steady_motions(asked.motion, data, work.progress)
    neglected = neglected_in_motion(asked.motion, data, states) if asked.neglected else NeglectedInMotion({}, {})
    with_room = tuple(backlash_changes(asked.motion, data, states)) if asked.neglected else ()
    return SweepData(data, states, neglected, still, with_room)


def _without_backlash(
    data: GearTrain, states: tuple[SteadyState, ...] = (), with_room: Sequence[FactorChange] = ()
) -> list[str]:
    """Meshes whose teeth touch on both flanks, so that contact loss cannot act, and where their other flanks carry."""
    said = []
    for m, (mesh, one) in enumerate(zip(data.train.meshes, data.meshes, strict=True)):
        if mesh.backlash > 0.0:
            continue
        jam = one.pair.normal_backlash
        why = f" (negative by {-jam * 1e6:.3g} um, rounded profile shifts)" if jam < 0.0 else ""
        remedy = f'set thickness_allowance of a gear, or train.mesh.{mesh.name}.backlash (a length or "unlimited").'
        behind = [state for state in states if state.behind[m] > 0.0]
        if not behind:
            said.append(f"Mesh {mesh.name}: no backlash{why}: contact on both flanks, no loss of contact; {remedy}")
            continue
        worst = max(behind, key=lambda state: float(state.behind[m]))
        room = "".join(
            f" (dynamic factor {one.factor:.4g}, with unlimited backlash {one.factor + one.size:.4g})"
            for one in with_room if one.mesh == m and one.speed == worst.model.speed
        )  # fmt: skip
        said.append(
            assuming(
                f"Mesh {mesh.name}: no backlash{why}: at {len(behind)} of {len(states)} speeds the non-working flanks "
                f"carry load, up to {percent(float(worst.behind[m]))} of the time at {speed_text(data, worst)}{room}. "
                f"Gears with backlash lose contact there: {remedy}"
            )
        )
    return said


def _common_period(data: GearTrain, states: tuple[SteadyState, ...]) -> list[str]:
    """Over which period motions under torque ripple are closed, and whose frequencies were shifted for that."""
    from fegear.dynamics.motion.motion_model import MotionModel  # late: as above

    models = [state.model for state in states if isinstance(state.model, MotionModel) and state.model.ripple]
    if not models:
        return []
    shifts = np.array([model.common.stretch for model in models]) - 1.0
    shifted = []
    for one, shift in zip(data.ripple, shifts.T, strict=True):
        worst = int(np.argmax(np.abs(shift)))
        if abs(shift[worst]) > _SHIFTED:
            base = float(one.base_frequency(models[worst].speed))
            shifted.append(f"{one.name} (by up to {percent(float(abs(shift[worst])))}: {base:.6g} Hz "
                           f"taken as {base * (1.0 + shift[worst]):.6g} Hz)")  # fmt: skip
    if not shifted:
        return []
    sentence = (
        f"Torque ripple {', '.join(shifted)}: no common period with the meshes within {LONGEST:,} mesh periods; "
        "nearest frequency with a common period used."
    )
    return [sentence]


def _unsteady(data: GearTrain, states: tuple[SteadyState, ...]) -> list[str]:
    """What is to be known of motions that do not repeat, of those that grow, and of stable ones with them."""

    def rpm(state: SteadyState) -> str:
        return speed_text(data, state)

    said = _growing(data, states)
    odd = [state for state in states if state.kind not in ("periodic", "growing", "not settled")]
    moving = [state for state in states if state.kind == "not settled"]
    if odd:
        where = ", ".join(f"{rpm(s)} {s.kind}" for s in odd)
        said.append(
            f"The motion does not repeat at {len(odd)} of {len(states)} speeds: {where}. The factors are maxima over "
            f"{odd[0].measured} periods and grow with the number of periods; see the quantiles in the table."
        )
    if moving:
        seen = "; ".join(f"{rpm(s)} after {s.followed:,} periods, {_range(data, s)}" for s in moving)
        said.append(
            f"Motion not converged at {len(moving)} of {len(states)} speeds: {seen} (minimum and maximum of the last "
            f"{_span(moving)} periods; may change with a longer simulation). {_settling(data)}"
        )
    beside = [
        f"{rpm(s)} of {other.periods} {'period' if other.periods == 1 else 'periods'}, dynamic factor "
        + ", ".join(f"{f:.5g} of mesh {name}" for name, f in zip(data.names, _factors(data, other), strict=True) if f)
        for s in (*odd, *moving)
        for other in s.coexisting
    ]  # fmt: skip
    if beside:
        said.append(
            "A stable periodic solution coexists with the non-periodic one (other initial conditions): "
            f"{'; '.join(beside)}."
        )
    return said


def speed_text(data: GearTrain, state: SteadyState) -> str:
    """Speed of a motion, of the body that speeds refer to."""
    return f"{state.model.speed * data.speed_ratio * _RPM:.6g} rpm"


def _growing(data: GearTrain, states: tuple[SteadyState, ...]) -> list[str]:
    """Speeds at which the motion grows without bound."""
    growing = [state for state in states if state.kind == "growing"]
    if not growing:
        return []
    where = ", ".join(f"{speed_text(data, s)} (multiplier {s.multiplier:.4g} per period)" for s in growing)
    said = (
        f"Parametric instability at {len(growing)} of {len(states)} speeds: {where}. Increase mesh damping, allow "
        "loss of contact (effects.contact_loss = true) or avoid these speeds."
    )
    return [said]


def averaging_remarks(data: GearTrain, states: tuple[SteadyState, ...]) -> list[str]:
    """Where the averaging iteration settled, where it did not, and where no machine would stay in what it found."""
    said = _growing(data, states)
    given_up = [state for state in states if state.kind == "not settled"]
    unstable = [state for state in states if state.kind == "unstable"]
    settled = [state for state in states if state.kind in ("periodic", "unstable")]
    if settled:
        counts = [state.followed for state in settled]
        said.append(
            f"Averaging iteration converged at {len(settled)} of {len(states)} speeds, after {min(counts):,} to "
            f"{max(counts):,} periods."
        )
    if given_up:
        seen = "; ".join(
            f"{speed_text(data, s)} after {s.followed:,} periods, difference between start and end of the last "
            f"period {s.residual:.2g} of the static deflection, {_range(data, s)} in the last {s.measured}"
            for s in given_up
        )
        said.append(
            f"Averaging iteration did not converge at {len(given_up)} of {len(states)} speeds: {seen}. Set "
            'dynamics.method = "shooting" there.'
        )
    if unstable:
        where = ", ".join(f"{speed_text(data, s)} (multiplier {s.multiplier:.6g} per period)" for s in unstable)
        said.append(
            f"Averaging iteration converged to an unstable motion at {len(unstable)} of {len(states)} speeds: "
            f'{where}. Set dynamics.method = "shooting" there.'
        )
    return said


def _range(data: GearTrain, state: SteadyState) -> str:
    """Dynamic factors that were seen, mesh by mesh, from the smallest of a period to the largest."""
    least = state.quantile(0.0)
    each = zip(data.names, least, state.tooth_force, data.forces, strict=True)
    ranges = [f"{low / mean:.4g} to {high / mean:.4g} of mesh {name}" for name, low, high, mean in each if mean > 0.0]
    return "dynamic factor " + ", ".join(ranges)


def _span(states: list[SteadyState]) -> str:
    """Over how many periods the motions were looked at: one number, or from the smallest to the largest."""
    counts = sorted({state.measured for state in states})
    return f"{counts[0]:,}" if len(counts) == 1 else f"{counts[0]:,} to {counts[-1]:,}"


def _settling(data: GearTrain) -> str:
    """The keys of the damping that such a motion wants: those that are zero, or the shafts' where none is."""
    bare = undamped(data)
    if bare:
        keys = ", ".join(f"{key}.damping_ratio" for key in bare)
        return f"Vibrations do not decay without damping; set {keys} (0.01 to 0.1)."
    return "Increase damping (damping_ratio of shafts and meshes of the train)."


def undamped(data: GearTrain) -> list[str]:
    """Shafts and meshes of the train that have no damping, by their keys."""
    shafts = [f"train.shaft.{s.name}" for s in data.train.shafts if s.damping == 0.0 and math.isfinite(s.stiffness)]
    return shafts + [f"train.mesh.{mesh.name}" for mesh in data.train.meshes if mesh.damping == 0.0]


def _factors(data: GearTrain, state: SteadyState) -> list[float]:
    """Largest tooth force of each mesh over its mean force; zero for meshes that carry nothing."""
    return [
        float(force / mean) if mean > 0.0 else 0.0 for force, mean in zip(state.tooth_force, data.forces, strict=True)
    ]


def _how_it_settled(seen: Seen) -> list[str]:
    found: SweepData = seen.data
    averaged = seen.asked.motion.method == "averaging"
    return averaging_remarks(found.train, found.states) if averaged else _unsteady(found.train, found.states)


def _method(seen: Seen) -> str | None:
    method: str = seen.asked.motion.method
    return method if method == "averaging" else None


_SHEET = Sheet(
    name=lambda _asked: "",
    remarks=(
        lambda seen: motion_remarks(seen.data.neglected, seen.data.train, seen.asked.effects, seen.asked.tolerance),
        lambda seen: (
            _without_backlash(seen.data.train, seen.data.states, seen.data.with_room)
            if seen.asked.motion.contact_loss else []
        ),
        Remark(
            neglecting("dynamics.friction ignored because effects.friction is off."),
            when=lambda seen: seen.asked.idle_friction,
        ),
        lambda seen: _common_period(seen.data.train, seen.data.states),
        _how_it_settled,
    ),
    settings={
        "direction": lambda seen: seen.asked.motion.direction, "tolerance": lambda seen: seen.asked.motion.tolerance,
        "method": _method,
    },
)  # fmt: skip


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """One steady motion for each speed; one that does not repeat takes longer, which only damping foretells."""
    speeds = int(scene.case.dynamics.speed_values.size)
    settings = {"speeds": speeds, "periods": forecasts.periods(scene), "tolerance": scene.case.dynamics.tolerance}
    off = sum(not scene.case.effects.is_on(effect) for effect in SIZED)
    neglected = off if scene.sizes_neglected else 0
    return Forecast(settings, forecasts.seconds_per_speed(scene) * speeds + 0.1 * neglected)


def _sources(scene: Scene, _subject: str) -> Iterator[Citation]:
    yield Citation("lin-huston-coy", "contact, loss of contact, back-side contact", "Eqs. 19 to 24")
    if scene.case.effects.friction:
        yield Citation("lin-huston-coy", "tooth friction", "Eqs. 17 and 18")


MOTION = Stage(
    subjects=the_train,
    needs=needs_train,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_motion,
    cites=_sources,
    forecast=_forecast,
)
