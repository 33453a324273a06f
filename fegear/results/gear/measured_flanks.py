"""Stage ``measured-flanks``: slope, form and total deviation of measured traces, and their tolerance class."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fegear.base.arrays import Array
from fegear.case.built.flank_modifications import described_relief, gear_face
from fegear.case.built.measured_flanks import MeasuredGear, Traces, measured_gear
from fegear.case.reading import Scene
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.formulas.iso1328 import tolerances_of
from fegear.formulas.iso1328_traces import TraceDeviations, tightest_class
from fegear.geometry.gear import Gear
from fegear.results import forecasts

#: Teeth that are drawn.
_DRAWN = 8
#: What a trace is called in the case, and along what it runs.
_CALLED = {"profile": ("profile", "length of roll"), "helix": ("helix", "height over the middle of the face")}


@dataclass(frozen=True)
class FlanksToEvaluate:
    """What the deviations of a gear's measured flanks depend on.

    Parameters
    ----------
    measured : MeasuredGear
    gear : Gear
    design : mapping of str to ndarray
        Deviation of the drawn flank from the involute or helix at the places of each kind of trace [m].
    tolerance_class : int or None
    remarks : tuple of str
    name : str
    """

    measured: MeasuredGear
    gear: Gear
    design: Mapping[str, Array]
    tolerance_class: int | None
    remarks: tuple[str, ...] = field(default=(), compare=False)
    name: str = field(default="", compare=False)

    @property
    def traces(self) -> tuple[Traces, ...]:
        """Those that there are."""
        return tuple(one for one in (self.measured.profile, self.measured.helix) if one is not None)


def _inputs(scene: Scene, name: str) -> FlanksToEvaluate:
    measured, gear = measured_gear(scene, name), scene.gears[name]
    design: dict[str, Array] = {}
    remarks: list[str] = []
    if measured.profile is not None:
        drawn = described_relief(scene, name)
        if drawn.left_out:
            remarks.append(
                f"Gear {name}: its profile is compared with an involute, not with its relief, because {drawn.left_out}."
            )
        roll = measured.profile.x / gear.base_radius
        design["profile"] = np.zeros(roll.size) if drawn.relief is None else -drawn.relief.removal(roll)
    if measured.helix is not None:
        over = gear_face(scene, name, drawn=True).parts
        middle = 0.5 * (gear.tooth.involute.start + gear.tooth.involute.end)
        z = measured.helix.x
        design["helix"] = -sum((part.removal(middle, z) for part in over), np.zeros(z.size))
    part = scene.case.gear[name]
    if part.spacing_errors is None and any(len(one.teeth) > 1 for one in (measured.profile, measured.helix) if one):
        remarks.append(
            f"Gear {name}: pairs take the mean of its teeth; how unevenly these stand is what spacing_errors says."
        )
    return FlanksToEvaluate(measured, gear, design, part.tolerance_class, tuple(remarks), name)


@dataclass(frozen=True)
class MeasuredFlanks:
    """Deviations of every tooth, and of the mean trace as the last, by kind of trace."""

    found: Mapping[str, tuple[TraceDeviations, ...]]


def _compute(asked: FlanksToEvaluate, _upstream: Upstream, _work: Work) -> MeasuredFlanks:
    return MeasuredFlanks({one.kind: tuple(one.deviations(asked.design[one.kind])) for one in asked.traces})


def _present(data: MeasuredFlanks, asked: FlanksToEvaluate) -> Outcome:
    tables, values, figures = [_deviations(data, asked)], [], []
    remarks = list(asked.remarks)
    for one in asked.traces:
        found = data.found[one.kind]
        values += _values(asked, one, found)
        tables.append(_trace_table(asked, one))
        figures.append(_figure(asked, one))
        shown = "unfiltered" if not one.wavelength else f"filtered at {one.wavelength * 1e3:.4g} mm"
        remarks.append(
            f"Gear {asked.name}: {one.kind} traces of {len(one.teeth)} {'tooth' if len(one.teeth) == 1 else 'teeth'}, "
            f"{shown}, evaluated from {one.ends[0] * 1e3:.5g} to {one.ends[1] * 1e3:.5g} mm."
        )
        if _beyond_all_classes(asked, one, found):
            remarks.append(
                f"Gear {asked.name}: {one.kind} deviations of a tooth exceed class 11, the widest of ISO 1328-1."
            )
    return Outcome(data, tuple(tables), tuple(values), {}, tuple(remarks), tuple(figures))


def _values(asked: FlanksToEvaluate, traces: Traces, found: tuple[TraceDeviations, ...]) -> list[Value]:
    """The mean slope and crown, the worst tooth, the class that it keeps, and the tolerances of the drawn class."""
    each, mean, kind, of = found[:-1], found[-1], traces.kind, f"{asked.name}.{traces.kind}"
    worst = max(each, key=lambda one: abs(one.slope))
    values = [
        Value(f"{of}_slope_mean", mean.slope, "um", None, f"slope of the mean {kind} trace"),
        Value(f"{of}_crown", mean.crown, "um", None, "height of its mean parabola"),
        Value(f"{of}_slope", worst.slope, "um", None, f"{kind} slope deviation, largest of all teeth"),
        Value(f"{of}_form", max(one.form for one in each), "um", None, f"{kind} form deviation, largest of all teeth"),
        Value(f"{of}_total", max(one.total for one in each), "um", None, "total deviation, largest of all teeth"),
    ]
    if asked.tolerance_class is not None:
        allowed = tolerances_of(asked.gear, asked.tolerance_class).rounded
        values += [
            Value(f"{of}_{key}_tolerance", getattr(allowed, f"{kind}_{key}"), "um", 0.0,
                  f"of class {asked.tolerance_class}, ISO 1328-1:2013")
            for key in ("slope", "form", "total")
        ]  # fmt: skip
    kept = _kept(asked, traces, each)
    if kept is not None and not math.isnan(kept):
        values.append(Value(f"{of}_class", kept, "", 0.0, "tightest class of ISO 1328-1:2013 that every tooth keeps"))
    return values


def _kept(asked: FlanksToEvaluate, traces: Traces, found: tuple[TraceDeviations, ...]) -> float | None:
    """The tightest class that all keep; NaN beyond class 11, None where the standard knows no such gear."""
    from fegear.base.errors import RangeError

    try:
        classes = [tightest_class(one, asked.gear, traces.kind) for one in found]
    except RangeError:
        return None
    return math.nan if None in classes else float(max(one for one in classes if one is not None))


def _beyond_all_classes(asked: FlanksToEvaluate, traces: Traces, found: tuple[TraceDeviations, ...]) -> bool:
    kept = _kept(asked, traces, found[:-1])
    return kept is not None and math.isnan(kept)


def _deviations(data: MeasuredFlanks, asked: FlanksToEvaluate) -> Table:
    rows = [
        (one.kind, str(tooth) if tooth is not None else "mean", found, _kept(asked, one, (found,)))
        for one in asked.traces
        for tooth, found in zip((*one.teeth, None), data.found[one.kind], strict=True)
    ]
    kinds, teeth, found, classes = zip(*rows, strict=True)
    columns = [
        Column("trace", np.array(kinds), "", "profile or helix"),
        Column("tooth", np.array(teeth), "", "its number in the file, or the mean of all"),
        Column("slope_deviation", np.array([one.slope for one in found]), "um", "rise of the mean line over the range"),
        Column("form_deviation", np.array([one.form for one in found]), "um", "range of the trace about its mean line"),
        Column("total_deviation", np.array([one.total for one in found]), "um", "range of the trace about the design"),
        Column("crown", np.array([one.crown for one in found]), "um", "height of the mean parabola over its ends"),
    ]
    if all(one is not None for one in classes):
        kept = np.array([math.nan if one is None else one for one in classes])
        columns.append(Column("class", kept, "", "tightest of ISO 1328-1:2013 that holds it"))
    return Table(f"measured_deviations_{asked.name}", tuple(columns), f"Deviations of gear {asked.name}", printed=True)


def _trace_table(asked: FlanksToEvaluate, traces: Traces) -> Table:
    called, along = _CALLED[traces.kind]
    place = [Column("z" if traces.kind == "helix" else "roll_length", traces.x, "mm", along)]
    if traces.kind == "profile":
        roll = traces.x / asked.gear.base_radius
        radius = asked.gear.tooth.radius_of_roll(roll) * asked.gear.module
        place += [
            Column("roll_angle", roll, "deg", "of the gear"),
            Column("radius", radius, "mm", "of the flank point"),
        ]
    return Table(
        f"measured_{called}_{asked.name}",
        (
            *place,
            Column("measured", traces.mean, "um", "mean of all teeth, from the involute or helix"),
            Column("design", asked.design[traces.kind], "um", "of the drawn flank, from the same"),
            Column("removal", traces.removal, "um", "that pairs take"),
        ),
        f"Mean {called} of gear {asked.name}",
    )


def _figure(asked: FlanksToEvaluate, traces: Traces) -> Figure:
    called, along = _CALLED[traces.kind]
    x = traces.x * 1e3
    curves = [
        Curve(x, row * 1e6, f"tooth {tooth}", "grey", dash="solid", markers=False, width=1.0)
        for tooth, row in list(zip(traces.teeth, traces.deviation, strict=True))[:_DRAWN]
        if len(traces.teeth) > 1
    ]
    curves.append(Curve(x, traces.mean * 1e6, "mean", "series:0", markers=False))
    if asked.design[traces.kind].any():
        curves.append(Curve(x, asked.design[traces.kind] * 1e6, "design", "series:1", markers=False))
    marks = tuple(Mark("x", end * 1e3, word) for end, word in zip(traces.ends, ("from", "to"), strict=True))
    panel = Panel(Axis(along, "mm"), Axis("deviation", "um"), tuple(curves), marks)
    return Figure(
        f"measured_{called}_{asked.name}", f"Measured {called} of gear {asked.name}",
        f"Gear {asked.name}: {called} traces, filtered; marked is the evaluation range.", (panel,),
    )  # fmt: skip


MEASURED_FLANKS = Stage(
    subjects=lambda scene: tuple(name for name, part in scene.case.gear.items() if part.measured is not None),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(Citation("iso-1328-1", "evaluation of profile and helix traces, tolerances")),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
    internal=True,
)
