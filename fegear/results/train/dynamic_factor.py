"""Stage ``dynamic-factor``: largest tooth force over speed, with contact loss or from the linearised train."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import percent
from fegear.case.built.train import MotionInputs, backlash_of, motion_inputs, train_part
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, columns_of, drawn, error_column
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.train.gear_train import carries_nothing, gear_train, meshes, needs_speeds, needs_train, pull_remarks

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.dynamics.train.charts import SpeedChart
    from fegear.dynamics.train.tooth_force import Pull
    from fegear.results.train.motion import SweepData


_RPM = 30.0 / np.pi

#: A change of the dynamic factor from one speed to the next that is too large to see peaks between them.
_COARSE = 0.1


@dataclass(frozen=True)
class DynamicFactorData:
    """Factors of one mesh over speed.

    Parameters
    ----------
    chart : SpeedChart or None
        Speeds in rad/s of the body that they refer to; None where the mesh carries no mean force.
    speed_of : str
        That body.
    in_time : bool
        Whether they come from motions in time; else from the linearised train.
    pull : Pull or None
        How far the force of the linearised mesh falls below zero.
    still : SpeedChart or None
        The same without torque ripple, where there is any.
    """

    chart: SpeedChart | None
    speed_of: str
    in_time: bool = False
    pull: Pull | None = None
    still: SpeedChart | None = None


@dataclass(frozen=True)
class FactorInputs:
    """What the factors of a mesh depend on besides train and motions.

    Parameters
    ----------
    mesh : str
    motion : MotionInputs
    positions, harmonics : int
        Of tooth forces in the linearised train.
    """

    mesh: str
    motion: MotionInputs
    positions: int
    harmonics: int


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (*needs_train(scene, name), *((Task("motion"),) if motion_inputs(scene).in_time else ()))


def _inputs(scene: Scene, name: str) -> FactorInputs:
    part = scene.case.dynamics
    return FactorInputs(name, motion_inputs(scene), part.positions, part.harmonics)


def _compute(asked: FactorInputs, upstream: Upstream, work: Work) -> DynamicFactorData:
    from fegear.dynamics.train.charts import SpeedChart
    from fegear.dynamics.train.dynamic_factor import linear_chart
    from fegear.dynamics.train.tooth_force import largest_pull

    data, motion = gear_train(upstream), asked.motion
    speeds, i = motion.speeds / data.speed_ratio, data.train.mesh_index(asked.mesh)
    if carries_nothing(data, i):
        return DynamicFactorData(None, data.speed_of)
    pull = still = None
    if motion.in_time:
        sweep: SweepData = upstream[Task("motion")]
        chart = SpeedChart.of(speeds, sweep.states, i, float(data.forces[i]))
        if sweep.still:
            still = SpeedChart.of(speeds, sweep.still, i, float(data.forces[i]))
    else:
        chart = linear_chart(data, i, speeds, asked.positions, asked.harmonics, work.progress)
        pull = largest_pull(data, i, speeds, asked.harmonics)
        if data.ripple:
            still = linear_chart(replace(data, ripple=()), i, speeds, asked.positions, asked.harmonics)
    chart = replace(chart, speeds=chart.speeds * data.speed_ratio)
    return DynamicFactorData(chart, data.speed_of, motion.in_time, pull, still)


def _present(found: DynamicFactorData, asked: FactorInputs) -> Outcome:
    name, motion, chart = asked.mesh, asked.motion, found.chart
    if chart is None:
        return Outcome(found, remarks=(f"Mesh {name} has no mean force and therefore no dynamic factor.",))
    parting = motion.contact_loss and found.in_time
    zero = "" if parting else "; zero without effects.contact_loss"
    of_body = f"of {found.speed_of}"
    factor = column_of(chart, "dynamic_factor")
    table = Table(
        f"dynamic_factor_{name}",
        (
            column_of(chart, "speeds", meaning=of_body),
            factor,
            column_of(chart, "apart", further=zero),
            column_of(chart, "behind", further=zero),
            *_without_ripple(found.still),
            *columns_of(chart, "periods", "mesh_force_factor", "kinds", "median", "upper", "measured"),
            # the other end of what is seen of a motion that is still on its way
            *(columns_of(chart, "lower") if "not settled" in chart.kinds else ()),
            *(columns_of(chart, "multiplier") if found.in_time else ()),
            *(columns_of(chart, "repetitions", "difference") if found.in_time and motion.method == "averaging" else ()),
            *((error_column(factor, _errors(chart, motion.tolerance)),) if found.in_time else ()),
        ),
        f"Dynamic factor of mesh {name} over speed",
    )
    held = chart.at(~chart.growing) if not chart.growing.all() else chart
    worst, where = held.worst
    at = int(np.argmax(held.dynamic_factor))
    repeats = held.kinds[at] == "periodic"
    error = float(_errors(held, motion.tolerance)[at]) if found.in_time and repeats else None
    sample = "" if repeats else f"; maximum of {held.measured[at]} periods of a non-periodic motion"
    over = "over the speeds" if held is chart else "over the speeds with bounded motion"
    values = [
        Value(f"{name}.largest_dynamic_factor", worst, "", error, f"{over}, direction {motion.direction}{sample}"),
        Value(f"{name}.speed_of_largest", where, "rpm", None, of_body),
    ]
    if found.still is not None:
        still = float(found.still.dynamic_factor[np.isfinite(found.still.dynamic_factor)].max(initial=0.0))
        without = "over the speeds, without torque ripple"
        values.append(Value(f"{name}.largest_dynamic_factor_without_ripple", still, "", None, without))
    if parting:
        lost = float(chart.apart.max())
        values.append(Value(f"{name}.largest_contact_loss", lost, "", None, "fraction of time"))
    remarks = [*pull_remarks(found.pull)]
    if found.in_time and not motion.parametric:
        remarks.append(
            f"Mesh {name}: effects.parametric is off: constant mean mesh stiffness; the dynamic factor refers to the "
            "mesh force."
        )
    averaged = found.in_time and motion.method == "averaging"
    still_held = found.still.at(~chart.growing) if found.still is not None and held is not chart else found.still
    figures = (_figure(name, held, found.speed_of, still_held, averaged=averaged),) if held.speeds.size > 1 else ()
    return Outcome(found, (table,), tuple(values), {}, tuple(remarks), figures)


def _errors(chart: SpeedChart, tolerance: float) -> Array:
    """Estimated errors of dynamic factors of motions in time; not a number where a motion does not repeat."""
    # what a motion that never repeats did over some periods is a sample: no tolerance holds for it
    repeats = np.array([kind == "periodic" for kind in chart.kinds])
    return np.where(repeats, np.maximum(tolerance * chart.dynamic_factor, chart.off), np.nan)


def _check(scene: Scene, name: str) -> None:
    needs_speeds(scene, name)
    if scene.case.dynamics.method == "averaging" and not motion_inputs(scene).in_time:
        raise InputError(
            "dynamics.method", "averaging", "applies to time-domain results only",
            "set effects.contact_loss, effects.parametric or effects.friction, or remove the key",
        )  # fmt: skip
    mesh, pair = train_part(scene).mesh[name], scene.pairs[train_part(scene).pair_of(name)]
    given, own = backlash_of(mesh, pair), pair.free_backlash  # said once more, that of the gears changes nothing
    said_nothing = math.isinf(given) or math.isclose(given, own, rel_tol=1e-6, abs_tol=1e-12)
    if scene.case.effects.contact_loss is False and not said_nothing:
        raise InputError(
            f"train.mesh.{name}.backlash", "(given)", "requires effects.contact_loss = true",
            "switch the effect on, or remove the backlash",
        )  # fmt: skip


def _without_ripple(still: SpeedChart | None) -> tuple[Column, ...]:
    """Columns of what the meshes do by themselves."""
    if still is None:
        return ()
    parts = (("dynamic_factor", "tooth force"), ("mesh_force_factor", "mesh force"))
    return tuple(
        column_of(still, key, name=f"{key}_without_ripple", meaning=f"maximum {what} / mean mesh force, without "
                                                                    "torque ripple")
        for key, what in parts
    )  # fmt: skip


def _figure(
    name: str, chart: SpeedChart, speed_of: str, still: SpeedChart | None = None, *, averaged: bool = False
) -> Figure:
    """Dynamic factor over speed, the share of the time without contact where there is any, and how averaging went.

    `still`: the same without torque ripple.
    """
    speed, x = drawn(chart, "speeds"), Axis(f"speed of {speed_of}", "rpm")
    items: list[Curve | Points] = [
        Curve(speed, chart.dynamic_factor, "tooth force", "own force", markers=True, width=1.2),
        Curve(speed, chart.mesh_force_factor, "mesh force", "mesh force", markers=True, width=0.9),
    ]
    if still is not None:
        alone = np.where(np.isfinite(still.dynamic_factor), still.dynamic_factor, np.nan)
        items.append(Curve(speed, alone, "tooth force without torque ripple", "static", markers=False, width=1.2))
    odd = np.array([kind != "periodic" for kind in chart.kinds])
    if odd.any():
        notes = tuple(kind for kind in chart.kinds if kind != "periodic")
        items.append(Points(speed[odd], chart.dynamic_factor[odd], "non-periodic motion", "red", notes=notes, size=7))
    panels = [Panel(x, Axis("maximum / mean force"), tuple(items), height=1.3)]
    shares = (("no contact", "no contact", chart.apart), ("back-side contact", "back flanks", chart.behind))
    lost = tuple(Curve(speed, 100.0 * share, label, role) for label, role, share in shares if share.any())
    if lost:
        panels.append(Panel(x, Axis("time", "%", zero=True), lost, height=0.5))
    if averaged:
        counts = Curve(speed, chart.repetitions.astype(float), "averaging", "ink", markers=True, width=0.9)
        panels.append(Panel(x, Axis("periods until convergence", zero=True), (counts,), height=0.5))
    worst, where = chart.worst
    smaller = np.minimum(chart.dynamic_factor[1:], chart.dynamic_factor[:-1])
    changed = np.abs(np.diff(chart.dynamic_factor))
    # teeth that fly apart may carry nothing while they are looked at
    step = np.divide(changed, smaller, out=np.zeros_like(changed), where=smaller > 0.0)
    at = int(np.argmax(step))
    coarse = (
        f" From {speed[at]:.6g} to {speed[at + 1]:.6g} rpm the dynamic factor changes by {percent(step[at])}: peaks "
        "may be missed, use a finer speed grid there."
        if step[at] > _COARSE else ""
    )  # fmt: skip
    return Figure(
        f"dynamic_factor_{name}",
        f"Dynamic factor of mesh {name}",
        f"Mesh {name}: maximum tooth pair force (dynamic factor) and maximum mesh force, both relative to the mean "
        f"mesh force; points: the {speed.size} computed speeds. Maximum dynamic factor {worst:.4g} at "
        f"{where * _RPM:.6g} rpm.{coarse}",
        tuple(panels),
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Read from the motion, or the linearised train at each speed."""
    speeds = int(scene.case.dynamics.speed_values.size)
    return Forecast({"speeds": speeds}, 0.005 if motion_inputs(scene).in_time else 0.02 * speeds)


DYNAMIC_FACTOR = Stage(
    subjects=meshes,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(Citation("lin-townsend-oswald", "dynamic factor over speed")),
    forecast=_forecast,
)
