"""Result ``vibration-revolution``: a mesh of the moving train at one speed until the same teeth mesh again.

Dynamic transmission error, mesh force and acceleration in time, what is left of them without the mesh harmonics, their
sidebands and condition indicators: what a crack, a missing tooth or a pitch deviation does to the vibration.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import MOTION_EFFECTS
from fegear.base.notes import assuming
from fegear.base.printed import percent
from fegear.case.built.train import motion_spec
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.pair.mesh_stiffness_revolution import INDICATORS
from fegear.results.train.gear_train import RPM, gear_train, needs_one_speed, needs_train, own_meshes
from fegear.results.train.motion import check_motion

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.dynamics.motion.motion_over_revolution import MotionOverRevolution
    from fegear.dynamics.motion.motion_spec import MotionSpec
    from fegear.engine.sheet.seen import Seen


@dataclass(frozen=True)
class VibrationInputs:
    """What the vibration of a mesh depends on besides the train.

    Parameters
    ----------
    motion : MotionSpec
        At one speed.
    mesh : str
    """

    motion: MotionSpec
    mesh: str


def _check(scene: Scene, name: str) -> None:
    needs_one_speed(scene, name)
    check_motion(scene, name)


def _inputs(scene: Scene, name: str) -> VibrationInputs:
    speeds = np.array([scene.case.dynamics.one_speed])
    return VibrationInputs(replace(motion_spec(scene), speeds=speeds), name)


def _compute(asked: VibrationInputs, upstream: Upstream, work: Work) -> MotionOverRevolution:
    from fegear.dynamics.motion.motion_over_revolution import motion_over_revolution
    from fegear.dynamics.motion.moving_train import steady_motions

    data = gear_train(upstream)
    i = data.train.mesh_index(asked.mesh)
    mesh = data.meshes[i]
    (state,) = steady_motions(asked.motion, data, work.progress)
    return motion_over_revolution(state, i, mesh.pair, mesh.error.pitches, data.phases[i])


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


_SHEET = Sheet(
    name=lambda asked: str(asked.mesh),
    tables=(
        Rows(
            "vibration_revolution_{name}", "Vibration of mesh {name} over {d.cycles} base pitches",
            (Every("revolution"),), matlab=True,
        ),
        Rows(
            "vibration_orders_{name}", "Orders of the vibration of mesh {name}", (Every("orders"),), of="orders",
            matlab=True,
        ),
    ),
    values=(
        "mesh_force_max", "mesh_force_max_ordinary", "dynamic_te_change_max", "dynamic_te_residual_max",
        *(Number(key, of="indicators", name="dynamic_" + key) for key in INDICATORS),
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
        _on_other_flanks,
    ),
    settings={"speed": lambda seen: float(seen.asked.motion.speeds[0]), "averaged": "averaged"},
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    return Forecast({"periods": forecasts.periods(scene)}, forecasts.seconds_per_speed(scene))


VIBRATION_REVOLUTION = Stage(
    subjects=own_meshes,
    needs=needs_train,
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
