"""Stage ``dynamic-factor``: largest tooth force over speed, with contact loss or from the linearised train."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import neglecting
from fegear.base.printed import figures, percent
from fegear.case.built.train import motion_spec, train_inputs
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.train.dynamic_factor_data import DynamicFactorData, ShownFactors, held_speeds
from fegear.results.train.gear_train import (
    RPM,
    carries_nothing,
    gear_train,
    meshes,
    needs_speeds,
    needs_train,
    pull_remarks,
)
from fegear.results.train.mesh_resonance_said import resonance_said

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.dynamics.motion.motion_spec import MotionSpec
    from fegear.dynamics.train.charts import SpeedChart
    from fegear.engine.sheet.seen import Seen
    from fegear.results.train.motion import SweepData


#: A change of the dynamic factor from one speed to the next that is too large to see peaks between them.
_COARSE = 0.1
#: A relative rise of the dynamic factor towards an end of the speeds that is more than its error.
_RISES = 2e-3
#: Share of the time below which it is round-off.
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class FactorInputs:
    """What the factors of a mesh depend on besides train and motions.

    Parameters
    ----------
    mesh : str
    motion : MotionSpec
    positions, harmonics : int
        Of tooth forces in the linearised train.
    """

    mesh: str
    motion: MotionSpec
    positions: int
    harmonics: int


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (*needs_train(scene, name), *((Task("motion"),) if motion_spec(scene).in_time else ()))


def _inputs(scene: Scene, name: str) -> FactorInputs:
    part = scene.case.dynamics
    return FactorInputs(name, motion_spec(scene), part.positions, part.harmonics)


def _compute(asked: FactorInputs, upstream: Upstream, work: Work) -> DynamicFactorData:
    from fegear.dynamics.train.charts import SpeedChart
    from fegear.dynamics.train.dynamic_factor import linear_chart
    from fegear.dynamics.train.mesh_resonance import mesh_resonance
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
    resonance = mesh_resonance(data, i, held_speeds(chart).worst[1])
    return DynamicFactorData(chart, data.speed_of, motion.in_time, pull, still, resonance)


def _check(scene: Scene, name: str) -> None:
    needs_speeds(scene, name)
    if scene.case.dynamics.method == "averaging" and not motion_spec(scene).in_time:
        raise InputError(
            "dynamics.method", "averaging", "applies to time-domain results only",
            "set effects.contact_loss, effects.parametric or effects.friction, or remove the key",
        )  # fmt: skip
    (mesh,) = (mesh for mesh in train_inputs(scene).spec.meshes if mesh.name == name)
    given, own = mesh.room, mesh.pair.free_backlash  # said once more, that of the gears changes nothing
    said_nothing = math.isinf(given) or math.isclose(given, own, rel_tol=1e-6, abs_tol=1e-12)
    if scene.case.effects.contact_loss is False and not said_nothing:
        raise InputError(
            f"train.mesh.{name}.backlash", "(given)", "requires effects.contact_loss = true",
            "switch the effect on, or remove the backlash",
        )  # fmt: skip


def _coarse(chart: SpeedChart) -> str:
    """Say where the factor changes too much from one speed to the next."""
    smaller = np.minimum(chart.dynamic_factor[1:], chart.dynamic_factor[:-1])
    changed = np.abs(np.diff(chart.dynamic_factor))
    # teeth that fly apart may carry nothing while they are looked at
    step = np.divide(changed, smaller, out=np.zeros_like(changed), where=smaller > 0.0)
    at = int(np.argmax(step))
    if step[at] <= _COARSE:
        return ""
    low, high = chart.speeds[at : at + 2] * RPM
    return (
        f" From {low:.6g} to {high:.6g} rpm the dynamic factor changes by {percent(step[at])}: peaks may be missed, "
        "use a finer speed grid there."
    )


def _caption(seen: Seen) -> str:
    chart: SpeedChart = seen.data.held
    worst, where = chart.worst
    return (
        f"Mesh {seen.name}: maximum tooth pair force (dynamic factor) and maximum mesh force, both relative to the "
        f"mean mesh force; points: the {chart.speeds.size} computed speeds. Maximum dynamic factor {worst:.4g} at "
        f"{where * RPM:.6g} rpm.{_coarse(chart)}"
    )


def _constant_stiffness(seen: Seen) -> bool:
    return seen.data.chart is not None and seen.data.found.in_time and not seen.data.motion.parametric


_WITHOUT_RIPPLE = "maximum {} / mean mesh force, without torque ripple"
_MARKED = {"markers": True, "width": 0.9}


def _speed(seen: Seen) -> Axis:
    return Axis(f"speed of {seen.data.found.speed_of}", "rpm")


def _at_the_end(held: SpeedChart, known: SpeedChart) -> str:
    """Whether the factor rises up to an end of the speeds, so that it may be higher beyond it."""
    factor = held.dynamic_factor
    for at, beside, end, beyond in ((0, 1, "start", "below"), (-1, -2, "end", "above")):
        rises = factor[at] == factor.max() and factor[at] > (1.0 + _RISES) * factor[beside]
        if rises and held.speeds[at] == known.speeds[at]:
            return f"; the maximum is at the {end} of the range and may be higher {beyond} it"
    return ""


def _lowest(seen: Seen) -> Iterator[str]:
    """Where it is lowest, of several speeds."""
    if seen.data.several:
        held: SpeedChart = seen.data.held
        at = int(np.argmin(held.dynamic_factor))
        low, high = figures(held.speeds[0] * RPM, 4), figures(held.speeds[-1] * RPM, 4)
        yield (
            f"Mesh {seen.name}: minimum {figures(held.dynamic_factor[at])} at {figures(held.speeds[at] * RPM, 4)} rpm "
            f"({held.speeds.size} speeds from {low} to {high} rpm{_at_the_end(held, seen.data.known)})."
        )


def _resonance(seen: Seen) -> Iterator[str]:
    """The resonance nearest to the speed of the maximum, and whether that explains it."""
    if seen.data.chart is not None:
        what = "the maximum" if seen.data.several else ""
        yield from resonance_said(seen.name, seen.data.found.resonance, seen.data.largest.speed, what)


def _lost(seen: Seen) -> Iterator[str]:
    """Whether teeth lose contact, and whether the other flanks carry load instead."""
    if seen.data.chart is not None and seen.data.parting:
        most, behind = seen.data.largest.contact_loss, float(seen.data.held.behind.max())
        words = f"up to {percent(most)} of the time" if most and most > _ROUND_OFF else "at no speed"
        if behind > _ROUND_OFF:
            words += f"; the non-working flanks carry load up to {percent(behind)} of the time"
        yield f"Mesh {seen.name}: loss of contact {words}."


_SHEET = Sheet(
    name=lambda asked: str(asked.mesh),
    answer=Answer(
        "Mesh {name}: maximum dynamic factor {v[largest_dynamic_factor]} at {v[speed_of_largest]} (force on one tooth "
        "pair over the mean mesh force).",
        _resonance,
        _lowest,
        _lost,
        "Mesh {name}: without torque ripple at most {v[largest_dynamic_factor_without_ripple]}.",
        figure="dynamic_factor_{name}", rank=lambda seen: -seen.data.largest.factor if seen.data.chart else None,
        among="the highest of {count} meshes",
    ),
    of=lambda data, asked: ShownFactors(data, asked.motion),
    tables=(
        Rows(
            "dynamic_factor_{name}", "Dynamic factor of mesh {name} over speed",
            (
                Cell("speeds", meaning="of {d.found.speed_of}"), "dynamic_factor", Cell("apart", further="{d.zero}"),
                Cell("behind", further="{d.zero}"),
                *(
                    Cell(
                        key, f"found.still.{key}", name=f"{key}_without_ripple", meaning=_WITHOUT_RIPPLE.format(force)
                    )
                    for key, force in (("dynamic_factor", "tooth force"), ("mesh_force_factor", "mesh force"))
                ),
                "periods", "mesh_force_factor", "kinds", "median", "upper", "measured", Cell("lower", "lower"),
                Cell("multiplier", "multiplier"), Cell("repetitions", "averaged.repetitions"),
                Cell("difference", "averaged.difference"), Off("dynamic_factor", "errors"),
            ),
            of="chart", matlab=True,
        ),
    ),
    values=(
        Number("factor", lambda seen: seen.data.largest.error, "largest", meaning="{d.largest.over}", when="chart"),
        Number("speed", of="largest", meaning="of {d.found.speed_of}", when="chart"),
        Number("without_ripple", of="largest", when="chart"),
        Number("contact_loss", of="largest", when="chart"),
    ),
    figures=(
        Chart(
            "dynamic_factor_{name}", "Dynamic factor of mesh {name}", _caption,
            (
                Over(
                    _speed,
                    (
                        Line("dynamic_factor", "tooth force", "own force", x="speeds", look=_MARKED | {"width": 1.2}),
                        Line("mesh_force_factor", "mesh force", "mesh force", x="speeds", look=_MARKED),
                        Line(
                            "dynamic_factor", "tooth force without torque ripple", "static", x="speeds",
                            si="drawn_still", look={"markers": False, "width": 1.2},
                        ),
                        Line(
                            "dynamic_factor", "non-periodic motion", "red", x="speeds", of="odd", kind="points",
                            look=lambda seen: {"notes": seen.data.odd.kinds, "size": 7},
                        ),
                    ),
                    Axis("maximum / mean force"), panel={"height": 1.3},
                ),
                Over(
                    _speed,
                    (
                        Line("apart", "no contact", "no contact", x="speeds", si="apart"),
                        Line("behind", "back-side contact", "back flanks", x="speeds", si="behind"),
                    ),
                    Axis("time", "%", zero=True), panel={"height": 0.5},
                    when=lambda seen: seen.data.apart is not None or seen.data.behind is not None,
                ),
                Over(
                    _speed, (Line("repetitions", "averaging", "ink", x="speeds", look=_MARKED),),
                    Axis("periods until convergence", zero=True), panel={"height": 0.5}, when="averaged",
                ),
            ),
            of="held", when="several",
        ),
    ),
    remarks=(
        Remark(
            "Mesh {name} has no mean force and therefore no dynamic factor.", when=lambda seen: seen.data.chart is None
        ),
        lambda seen: pull_remarks(seen.data.found.pull),
        Remark(
            neglecting("Mesh {name}: effects.parametric is off: constant mean mesh stiffness; the dynamic factor "
            "refers to the mesh force."),
            when=_constant_stiffness,
        ),
    ),
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Read from the motion, or the linearised train at each speed."""
    speeds = int(scene.case.dynamics.speed_values.size)
    return Forecast({"speeds": speeds}, 0.005 if motion_spec(scene).in_time else 0.02 * speeds)


DYNAMIC_FACTOR = Stage(
    subjects=meshes,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("lin-townsend-oswald", "dynamic factor over speed")),
    forecast=_forecast,
)
