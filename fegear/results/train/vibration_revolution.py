"""Result ``vibration-revolution``: a mesh of the moving train at one speed until the same teeth mesh again.

Dynamic transmission error, mesh force and acceleration in time, what is left of them without the mesh harmonics, their
sidebands and condition indicators: what a crack, a missing tooth or a pitch deviation does to the vibration.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.effects import MOTION_EFFECTS
from fegear.base.notes import assuming
from fegear.base.printed import percent
from fegear.case.built.train import motion_spec, train_part
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.pair.loaded_teeth import pair_over_revolution
from fegear.results.pair.mesh_stiffness_revolution import INDICATORS
from fegear.results.train.gear_train import RPM, gear_train, needs_meshes, needs_one_speed, needs_train, own_meshes
from fegear.results.train.mesh_resonance_said import resonance_said
from fegear.results.train.motion import check_motion

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.dynamics.motion.motion_model import MotionModel
    from fegear.dynamics.motion.motion_over_revolution import MotionOverRevolution
    from fegear.dynamics.motion.motion_spec import MotionSpec
    from fegear.dynamics.train.gear_train import TrainMesh
    from fegear.engine.sheet.seen import Seen


#: Roll positions of a base pitch at which errors of the teeth at rest are looked at.
_AT_REST = 24
#: Tolerance of the steps through the motion beside.
_STEPS_BESIDE = 1e-7
#: Time of a motion with its errors over that of a motion alone.
_BESIDE = 1.6


@dataclass(frozen=True)
class VibrationInputs:
    """What the vibration of a mesh depends on besides the train.

    Parameters
    ----------
    motion : MotionSpec
        At one speed.
    mesh : str
    pairs : tuple of str
        Whose teeth each mesh of the train has.
    """

    motion: MotionSpec
    mesh: str
    pairs: tuple[str, ...]


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    """The train, and the loaded teeth of its meshes for their errors."""
    return (*needs_train(scene, name), *needs_meshes(scene))


def _check(scene: Scene, name: str) -> None:
    needs_one_speed(scene, name)
    check_motion(scene, name)


def _inputs(scene: Scene, name: str) -> VibrationInputs:
    speeds = np.array([scene.case.dynamics.one_speed])
    part = train_part(scene)
    pairs = tuple(part.loaded_pair_of(mesh) for mesh in part.mesh)
    return VibrationInputs(replace(motion_spec(scene), speeds=speeds), name, pairs)


def _compute(asked: VibrationInputs, upstream: Upstream, work: Work) -> MotionOverRevolution:
    from fegear.dynamics.motion.motion_over_revolution import motion_over_revolution
    from fegear.dynamics.motion.moving_train import steady_motion, steady_motions
    from fegear.dynamics.motion.revolution_errors import COARSER, revolution_errors, softer
    from fegear.dynamics.train.mesh_resonance import mesh_resonance

    data, motion = gear_train(upstream), asked.motion
    i = data.train.mesh_index(asked.mesh)
    mesh, phase = data.meshes[i], data.phases[i]
    (state,) = steady_motions(motion, data, lambda share: work.progress(0.6 * share))
    resonance = mesh_resonance(data, i, float(motion.speeds[0]))
    doubts = [_doubt(upstream, pair, one) for pair, one in zip(asked.pairs, data.meshes, strict=True)]
    if resonance is not None and (doubt := doubts[i]) is not None:
        resonance = replace(resonance, doubt=doubt.compliance)
    found = replace(motion_over_revolution(state, i, mesh.pair, mesh.error.pitches, phase), resonance=resonance)
    if not state.repeats or any(one is None for one in doubts):
        return found
    known = [one for one in doubts if one is not None]
    coarser = min(COARSER * motion.tolerance, 1e-2)
    other = steady_motion(
        motion, softer(cast("MotionModel", state.model), [one.compliance for one in known]), (state.x, state.v), coarser
    )
    if not other.repeats or other.periods != state.periods:
        return found
    beside = motion_over_revolution(other, i, mesh.pair, mesh.error.pitches, phase, tolerance=_STEPS_BESIDE)
    return replace(found, errors=revolution_errors(found, beside, known[i].own, motion.tolerance))


@dataclass(frozen=True)
class _Doubt:
    """Relative errors of the compliance of a mesh, and of what its odd teeth change."""

    compliance: float
    own: float = 0.0


def _doubt(upstream: Upstream, pair: str, mesh: TrainMesh) -> _Doubt | None:
    """As load sharing states them at rest; None where the source of the compliances states none."""
    from fegear.contact.plane.over_revolution import over_revolution

    if mesh.doubt is not None:
        stiffness = 1.0 / mesh.excitation.mean_compliance()
        return _Doubt(mesh.doubt[0] / stiffness)
    loaded = pair_over_revolution(upstream, pair)
    if not loaded.shifted:
        return None
    over = over_revolution(loaded.engagement, loaded.nominal, _AT_REST, loaded.shifted)
    compliance = float(over.transmission_error_error.max() / np.mean(over.load / over.tangent))
    own = over.largest_residual_error / over.largest_residual if over.solved > 1 and over.largest_residual else 0.0
    return _Doubt(compliance, own)


def _on_other_flanks(seen: Seen) -> Iterator[str]:
    """Where non-working flanks carry load: how far they are from the others decides."""
    data: MotionOverRevolution = seen.data
    if data.behind > 0.0:
        yield assuming(
            f"Mesh {seen.name}: the non-working flanks carry load for {percent(data.behind)} of the time, with the "
            f"backlash of the case (zero by default). Gears with more backlash lose contact: set "
            f'train.mesh.{seen.name}.backlash (a length or "unlimited"), or thickness_allowance of a gear.'
        )


def _speed(seen: Seen) -> str:
    return f"{float(seen.asked.motion.speeds[0]) * RPM:.6g} rpm"


def _resonance(seen: Seen) -> Iterator[str]:
    """The resonance of the mesh that is nearest to the speed."""
    yield from resonance_said(seen.name, seen.data.resonance, float(seen.asked.motion.speeds[0]))


_SHEET = Sheet(
    name=lambda asked: str(asked.mesh),
    tables=(
        Rows(
            "vibration_revolution_{name}", "Vibration of mesh {name} over {d.cycles} base pitches",
            (
                Every("revolution"),
                *(Off(key, f"errors.{key}") for key in ("te", "te_residual", "te_change", "force", "acceleration")),
            ),
            matlab=True,
        ),
        Rows(
            "vibration_orders_{name}", "Orders of the vibration of mesh {name}",
            (Every("orders"), *(Off(key, f"errors.{key}_order") for key in ("te", "force", "acceleration"))),
            of="orders", matlab=True,
        ),
    ),
    values=(
        *(
            Number(key, f"errors.{key}")
            for key in ("mesh_force_max", "mesh_force_max_ordinary", "dynamic_te_change_max", "dynamic_te_residual_max")
        ),
        Number("frequency", "resonance.frequency_error", of="resonance"),
        Number("speed", "resonance.speed_error", of="resonance"),
        *(Number(key, f"errors.indicators.{key}", of="indicators", name="dynamic_" + key) for key in INDICATORS),
    ),
    figures=(
        Chart(
            "vibration_revolution_{name}", "Vibration of mesh {name} over the rotation",
            lambda seen: f"Mesh {seen.name} at {_speed(seen)}: dynamic transmission error, its residual (without mesh "
            f"harmonics) and mesh force over {seen.data.cycles} base pitches.",
            (
                Over("driver_angle", (Line("te", "transmission error"), Line("te_residual", "residual", "red"))),
                Over("driver_angle", ("force",)),
            ),
            under=_speed,
        ),
        Chart(
            "vibration_orders_{name}", "Orders of the vibration of mesh {name}",
            "Mesh {name}: amplitudes over the order of the tooth-mesh frequency; integers are mesh harmonics, the "
            "others are due to teeth that differ.",
            tuple(Over("mesh_order", (Line(key, kind="stems"),)) for key in ("te", "acceleration")),
            of="orders", under=_speed,
        ),
    ),
    answer=Answer(
        "Mesh {name}: dynamic transmission error up to {v[dynamic_te_change_max]} from that of an ordinary base "
        "pitch, kurtosis of its residual {v[dynamic_residual_kurtosis]}, maximum mesh force {v[mesh_force_max]} "
        "({v[mesh_force_max_ordinary]} in an ordinary base pitch).",
        _resonance,
        figure="vibration_revolution_{name}",
    ),
    remarks=(
        Remark(
            "Mesh {name}: all base pitches are equal; specify [[gear.NAME.odd_tooth]] or spacing_errors for teeth that "
            "differ.",
            when=lambda seen: seen.data.cycles == 1,
        ),
        Remark(
            "Mesh {name}: the motion does not repeat; one period of the excitation is shown.",
            when=lambda seen: not seen.data.repeats,
        ),
        Remark(
            "Mesh {name}: no errors stated: the motion does not repeat, or changes its kind within the error of the "
            "stiffness, or the compliances are without errors.",
            when=lambda seen: seen.data.errors is None,
        ),
        _on_other_flanks,
    ),
    settings={"speed": lambda seen: float(seen.asked.motion.speeds[0]), "averaged": "averaged"},
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    return Forecast({"periods": forecasts.periods(scene)}, _BESIDE * forecasts.seconds_per_speed(scene))


VIBRATION_REVOLUTION = Stage(
    subjects=own_meshes,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    effects_of=lambda _scene, _name: MOTION_EFFECTS,
    cites=citing(
        Citation("lin-huston-coy", "contact, loss of contact, back-side contact", "Eqs. 19 to 24"),
        Citation("zakrajsek-townsend-decker", "condition indicators FM0, FM4, energy ratio"),
    ),
    forecast=_forecast,
)
