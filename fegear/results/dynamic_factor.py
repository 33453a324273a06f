"""Stage ``dynamic-factor``: largest tooth force over speed, with contact loss or from the linearised train."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.dynamics.pull import largest_pull, mesh_force_range
from fegear.dynamics.single_tooth import force_history
from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Panel, Points
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage, Task
from fegear.errors import InputError
from fegear.models.motion import in_time, motion_model
from fegear.models.neglected_in_motion import motion_remarks
from fegear.models.train import train_part
from fegear.results import forecasts
from fegear.results.gear_train import gear_train, needs_train, the_train
from fegear.results.train_parts import meshes, needs_speeds, pull_remarks

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.dynamics.charts import SpeedChart
    from fegear.dynamics.gear_train import GearTrain
    from fegear.dynamics.steady_state import SteadyState
    from fegear.engine.stage import Done, Progress

    Array = NDArray[np.float64]


_RPM = 30.0 / np.pi


@dataclass(frozen=True)
class SweepData:
    """Steady motions over speeds, in increasing order of speed."""

    train: GearTrain
    speeds: Array
    states: tuple[SteadyState, ...]


@dataclass(frozen=True)
class DynamicFactorData:
    """What pictures need: the chart of one mesh, speeds in rad/s of the body that the case refers to."""

    chart: SpeedChart
    speed_of: str


def check_motion(scene: Scene, _subject: str = "") -> None:
    """Refuse friction where teeth are lumped, and backlash that nothing looks at."""
    effects = scene.case.effects
    if effects.friction and (effects.neighbour_coupling or effects.corner_contact):
        raise InputError(
            "effects.friction", "true", "needs tooth pairs that stand alone, each at its place on the path",
            "leave out neighbour_coupling and corner_contact",
        )  # fmt: skip
    if effects.friction and not effects.parametric:
        raise InputError(
            "effects.friction", "true", "needs tooth pairs that come and go", "set effects.parametric = true"
        )


def _run_sweep(scene: Scene, _subject: str, done: Done, progress: Progress) -> Outcome:
    from fegear.dynamics.steady_state import steady_state

    data, part = gear_train(done), scene.case.dynamics
    speeds = part.speed_values / data.speed_ratio
    order = speeds[::-1] if part.direction == "down" else speeds
    start: str | tuple[Array, Array] = "rest" if part.direction == "rest" else "static"
    states: list[SteadyState] = []
    model = motion_model(scene, data, float(order[0]))
    for number, speed in enumerate(order):
        model = motion_model(scene, data, float(speed)) if scene.case.effects.friction else model.at_speed(float(speed))
        state = steady_state(model, start=start, tolerance=part.tolerance)
        states.append(state)
        if part.direction in ("up", "down"):
            start = (state.x, state.v)
        progress((number + 1) / order.size)
    found = tuple(states[::-1] if part.direction == "down" else states)
    remarks = [*motion_remarks(scene, data, found)]
    if "friction" in part.model_fields_set and not scene.case.effects.friction:
        remarks.append("dynamics.friction is given, but effects.friction is off: teeth slide without friction.")
    odd = [state for state in found if state.kind != "periodic"]
    if odd:
        told = ", ".join(f"{state.model.speed * data.speed_ratio * 30.0 / np.pi:.6g} rpm {state.kind}" for state in odd)
        remarks.append(
            f"The motion does not repeat at {len(odd)} of {len(found)} speeds: {told}. Its factors are the largest of "
            f"{odd[0].measured} periods, a sample without a tolerance: more periods find larger ones. See the "
            "quantiles in the table."
        )
    settings: dict[str, object] = {"direction": part.direction, "tolerance": part.tolerance}
    return Outcome(SweepData(data, speeds, found), (), (), settings, tuple(remarks))


def _linear_chart(scene: Scene, data: GearTrain, i: int, speeds: Array, progress: Progress) -> SpeedChart:
    """Dynamic factor of the linearised train: no contact loss, the other meshes at the worst relative phase."""
    from fegear.dynamics.charts import SpeedChart

    part, mean = scene.case.dynamics, float(data.forces[i])
    tooth, mesh = np.empty(speeds.size), np.empty(speeds.size)
    for number, speed in enumerate(speeds):
        found = force_history(data, i, float(speed) * data.speed_ratio, part.positions, part.harmonics)
        tooth[number] = (float(found.total.max()) + float(found.cross_peak.sum())) / mean
        mesh[number] = mesh_force_range(data, i, float(speed), part.harmonics)[1] / mean
        progress((number + 1) / speeds.size)
    return SpeedChart.linear(speeds, tooth, mesh)


def _run(scene: Scene, name: str, done: Done, progress: Progress) -> Outcome:
    from fegear.dynamics.charts import SpeedChart

    data, part = gear_train(done), scene.case.dynamics
    states = cast("SweepData", done[Task("motion")].data).states if in_time(scene) else ()
    speeds = part.speed_values / data.speed_ratio
    i = data.train.mesh_index(name)
    if data.forces[i] <= 1e-9 * float(np.max(np.abs(data.forces))):
        remark = f"Mesh {name} carries no mean force, so it has no dynamic factor."
        return Outcome(None, (), (), {}, (remark,))
    if states:
        chart = SpeedChart.of(speeds, states, i, float(data.forces[i]))
    else:
        chart = _linear_chart(scene, data, i, speeds, progress)
    chart = replace(chart, speeds=chart.speeds * data.speed_ratio)
    parting = scene.case.effects.contact_loss and bool(states)
    zero = "" if parting else "; zero, for nothing parts without effects.contact_loss"
    table = Table(
        f"dynamic_factor_{name}",
        (
            Column("speed", chart.speeds, "rpm", f"of {data.speed_of}"),
            Column(
                "dynamic_factor", chart.dynamic_factor, "", "largest force on one tooth pair over the mean mesh force"
            ),
            Column("contact_loss_fraction", chart.apart, "", f"share of the time without contact{zero}"),
            Column("backside_fraction", chart.behind, "", f"share of the time on the back flanks{zero}"),
            Column(
                "periods", chart.periods, "", "periods of excitation after which the motion repeats; 0 if it does not"
            ),
            Column("mesh_force_factor", chart.mesh_force_factor, "", "largest mesh force over the mean mesh force"),
            Column(
                "motion",
                np.array(chart.kinds, dtype=str),
                "",
                "periodic (and stable), quasi-periodic, chaotic, long-period or unsettled",
            ),
            Column("median_factor", chart.median, "", "dynamic factor that half of the periods do not exceed"),
            Column("factor_99_percent", chart.upper, "", "dynamic factor that 99 % of the periods do not exceed"),
            Column("periods_measured", chart.measured, "", "periods of excitation that the largest forces come from"),
        ),
        f"Dynamic factor of mesh {name} over speed",
    )
    worst, where = chart.worst
    at = int(np.argmax(chart.dynamic_factor))
    repeats = chart.kinds[at] == "periodic"
    # what a motion that never repeats did over some periods is a sample: no tolerance holds for it
    error = part.tolerance * worst if states and repeats else None
    sample = "" if repeats else f"; largest of {chart.measured[at]} periods of a motion that does not repeat"
    values = [
        Value(
            f"{name}.largest_dynamic_factor", worst, "", error, f"over the speeds, direction {part.direction}{sample}"
        ),
        Value(f"{name}.speed_of_largest", where, "rpm", None, f"of {data.speed_of}"),
    ]
    if parting:
        lost = float(chart.apart.max())
        values.append(Value(f"{name}.largest_contact_loss", lost, "", None, "share of the time"))
    remarks = [] if states else [*pull_remarks(largest_pull(data, i, speeds, part.harmonics))]
    if states and not scene.case.effects.parametric:
        remarks.append(
            f"Mesh {name}: effects.parametric is off, so all teeth in contact are one spring of mean stiffness and the "
            "dynamic factor is that of the mesh force."
        )
    figures = (_figure(name, chart, data.speed_of),) if chart.speeds.size > 1 else ()
    return Outcome(DynamicFactorData(chart, data.speed_of), (table,), tuple(values), {}, tuple(remarks), figures)


def _check(scene: Scene, name: str) -> None:
    needs_speeds(scene, name)
    if scene.case.effects.contact_loss is False and train_part(scene).mesh[name].backlash is not None:
        raise InputError(
            f"train.mesh.{name}.backlash", "(given)", "has a meaning only with effects.contact_loss = true",
            "switch the effect on, or leave the backlash out",
        )  # fmt: skip


def _figure(name: str, chart: SpeedChart, speed_of: str) -> Figure:
    """Dynamic factor over speed, and the share of the time without contact where there is any."""
    speed, x = chart.speeds * _RPM, Axis(f"speed of {speed_of}", "rpm")
    items: list[Curve | Points] = [
        Curve(speed, chart.dynamic_factor, "tooth force", "own force"),
        Curve(speed, chart.mesh_force_factor, "mesh force", "mesh force", width=1.2),
    ]
    odd = np.array([kind != "periodic" for kind in chart.kinds])
    if odd.any():
        notes = tuple(kind for kind in chart.kinds if kind != "periodic")
        items.append(
            Points(speed[odd], chart.dynamic_factor[odd], "motion that does not repeat", "red", notes=notes, size=7)
        )
    panels = [Panel(x, Axis("largest over mean force"), tuple(items), height=1.3)]
    shares = (("no contact", "no contact", chart.apart), ("on the back flanks", "back flanks", chart.behind))
    lost = tuple(Curve(speed, 100.0 * share, label, role) for label, role, share in shares if share.any())
    if lost:
        panels.append(Panel(x, Axis("time", "%", zero=True), lost, height=0.5))
    worst, where = chart.worst
    return Figure(
        f"dynamic_factor_{name}",
        f"Dynamic factor of mesh {name}",
        f"Mesh {name}: largest force on one tooth pair (dynamic factor) and largest mesh force, both over the mean "
        f"mesh force. Largest dynamic factor {worst:.4g} at {where * _RPM:.6g} rpm.",
        tuple(panels),
    )


def _motion_forecast(scene: Scene, _subject: str) -> Forecast:
    """One steady motion for each speed; one that does not repeat takes ten times as long, which nobody foresees."""
    speeds = int(scene.case.dynamics.speed_values.size)
    settings = {"speeds": speeds, "periods": forecasts.periods(scene), "tolerance": scene.case.dynamics.tolerance}
    left_out = sum(not scene.case.effects.is_on(effect) for effect in ("contact_loss", "friction"))
    return Forecast(settings, forecasts.seconds_per_speed(scene) * speeds + 0.1 * left_out)


def _factor_forecast(scene: Scene, _name: str) -> Forecast:
    """Read from the motion, or the linearised train at each speed."""
    speeds = int(scene.case.dynamics.speed_values.size)
    return Forecast({"speeds": speeds}, 0.005 if in_time(scene) else 0.02 * speeds)


def _motion_sources(scene: Scene, _subject: str) -> Iterator[Citation]:
    yield Citation("lin-huston-coy", "contact, its loss, and contact on the back flanks", "Eqs. 19 to 24")
    if scene.case.effects.friction:
        yield Citation("lin-huston-coy", "tooth friction", "Eqs. 17 and 18")


MOTION = Stage(
    name="motion",
    title="Motion over the speeds",
    results=(),
    subjects=the_train,
    run=_run_sweep,
    needs=needs_train,
    check=check_motion,
    effects=("contact_loss", "friction", "parametric"),
    cites=_motion_sources,
    forecast=_motion_forecast,
)

DYNAMIC_FACTOR = Stage(
    name="dynamic-factor",
    title="Dynamic factor over speed",
    results=("dynamic-factor",),
    subjects=meshes,
    run=_run,
    needs=lambda scene, name: (*needs_train(scene, name), *((Task("motion"),) if in_time(scene) else ())),
    check=_check,
    effects=("contact_loss", "friction", "parametric"),
    cites=citing(Citation("lin-townsend-oswald", "dynamic factor over speed")),
    forecast=_factor_forecast,
)
