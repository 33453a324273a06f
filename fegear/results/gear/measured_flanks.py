"""Stage ``measured-flanks``: slope, form and total deviation of measured traces, and their tolerance class."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.notes import exceeding
from fegear.base.shown import shown, shows
from fegear.case.built.flank_modifications import described_relief, gear_face
from fegear.case.built.measured_flanks import Kind, MeasuredGear, Traces, measured_gear
from fegear.case.reading import Scene
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Stage, Upstream, Work
from fegear.formulas.iso1328 import tolerances_of
from fegear.formulas.iso1328_traces import TraceDeviations, tightest_class
from fegear.geometry.gear import Gear
from fegear.results import forecasts

#: Teeth that are drawn.
_DRAWN = 8


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


def _is_measured(scene: Scene, name: str) -> bool:
    """Whether a case says how the flanks were measured that a gear is seen from."""
    return scene.case.gear[name].measured_of(scene.gears[name].tooth.working_flank)[0] is not None


def _inputs(scene: Scene, name: str) -> FlanksToEvaluate:
    measured, gear = measured_gear(scene, name), scene.gears[name]
    design: dict[str, Array] = {}
    remarks: list[str] = []
    if measured.profile is not None:
        drawn = described_relief(scene, name)
        if drawn.left_out:
            remarks.append(
                f"Gear {name}: profile compared with the involute, without relief, because {drawn.left_out}."
            )
        roll = measured.profile.x / gear.base_radius
        design["profile"] = np.zeros(roll.size) if drawn.relief is None else -drawn.relief.removal(roll)
    if measured.helix is not None:
        over = gear_face(scene, name, drawn=True)
        middle = 0.5 * (gear.tooth.involute.start + gear.tooth.involute.end)
        # traces count z as the drive flanks do, modifications as the flank that is seen
        z = -measured.helix.x if gear.tooth.working_flank == "coast" else measured.helix.x
        design["helix"] = -sum((part.removal(middle, z) for part in over), np.zeros(z.size))
    part = scene.case.gear[name]
    if part.spacing_errors is None and any(len(one.teeth) > 1 for one in (measured.profile, measured.helix) if one):
        remarks.append(
            f"Gear {name}: the mean of the measured teeth is used for all teeth; pitch deviations are taken from "
            "spacing_errors."
        )
    return FlanksToEvaluate(measured, gear, design, part.tolerance_class, tuple(remarks), name)


@dataclass(frozen=True)
class MeasuredFlanks:
    """Deviations of every tooth, and of the mean trace as the last, by kind of trace."""

    found: Mapping[Kind, tuple[TraceDeviations, ...]]


def _compute(asked: FlanksToEvaluate, _upstream: Upstream, _work: Work) -> MeasuredFlanks:
    return MeasuredFlanks({one.kind: tuple(one.deviations(asked.design[one.kind])) for one in asked.traces})


def _kept(gear: Gear, kind: Kind, found: tuple[TraceDeviations, ...]) -> float | None:
    """The tightest class that all keep; NaN beyond class 11, None where the standard knows no such gear."""
    try:
        classes = [tightest_class(one, gear, kind) for one in found]
    except RangeError:
        return None
    return math.nan if None in classes else float(max(one for one in classes if one is not None))


@dataclass(frozen=True)
class OneTrace:
    """Deviations of one tooth's trace, or of the mean one's."""

    deviations: TraceDeviations
    gear: Gear
    trace: Kind = shown("", "profile or helix")
    tooth: str = shown("", "tooth number in the file, or the mean of all teeth")

    @property
    @shows("um", "slope deviation: rise of the mean line over the evaluation range")
    def slope_deviation(self) -> float:
        """f_H [m]."""
        return self.deviations.slope

    @property
    @shows("um", "form deviation (range about the mean line)")
    def form_deviation(self) -> float:
        """f_f [m]."""
        return self.deviations.form

    @property
    @shows("um", "range of the trace about the design profile")
    def total_deviation(self) -> float:
        """F [m]."""
        return self.deviations.total

    @property
    @shows("um", "crowning: height of the mean parabola over its ends")
    def crown(self) -> float:
        """[m]."""
        return self.deviations.crown

    @property
    @shows("", "tightest class of ISO 1328-1:2013 met", name="class")
    def kept(self) -> float | None:
        """nan beyond class 11, None where the standard knows no such gear."""
        return _kept(self.gear, self.trace, (self.deviations,))


@dataclass(frozen=True)
class OneKind:
    """All traces of one kind with what was found of them.

    Parameters
    ----------
    traces : Traces
    deviations : tuple of TraceDeviations
        Of every tooth, and of the mean trace as the last.
    asked : FlanksToEvaluate
    """

    traces: Traces
    deviations: tuple[TraceDeviations, ...]
    asked: FlanksToEvaluate

    @property
    def kind(self) -> Kind:
        """Profile or helix."""
        return self.traces.kind

    @property
    def rows(self) -> tuple[OneTrace, ...]:
        """Tooth by tooth, and the mean."""
        teeth = (*map(str, self.traces.teeth), "mean")
        return tuple(
            OneTrace(one, self.asked.gear, self.kind, tooth) for tooth, one in zip(teeth, self.deviations, strict=True)
        )

    @property
    @shows("mm", "face position from mid-face")
    def z(self) -> Array | None:
        """Of helix traces, shape (N,) [m]."""
        return self.traces.x if self.kind == "helix" else None

    @property
    @shows("mm", "length of roll")
    def roll_length(self) -> Array | None:
        """Of profile traces, shape (N,) [m]."""
        return self.traces.x if self.kind == "profile" else None

    @property
    @shows("deg", "roll angle on the gear")
    def roll_angle(self) -> Array | None:
        """Of profile traces, shape (N,) [rad]."""
        return self.traces.x / self.asked.gear.base_radius if self.kind == "profile" else None

    @property
    @shows("mm", "radius of the point on the flank")
    def radius(self) -> Array | None:
        """Of profile traces, shape (N,) [m]."""
        gear, roll = self.asked.gear, self.roll_angle
        return None if roll is None else gear.tooth.radius_of_roll(roll) * gear.module

    @property
    @shows("um", "mean deviation of all teeth from the involute or helix", label="deviation")
    def measured(self) -> Array:
        """Shape (N,) [m]."""
        return self.traces.mean

    @property
    @shows("um", "design flank, deviation from the involute or helix")
    def design(self) -> Array:
        """Shape (N,) [m]."""
        return self.asked.design[self.kind]

    @property
    @shows("um", "deviation used in gear pairs")
    def removal(self) -> Array:
        """Shape (N,) [m]."""
        return self.traces.removal

    @property
    @shows("um")
    def slope_mean(self) -> float:
        """Of the mean trace [m]."""
        return self.deviations[-1].slope

    @property
    @shows("um", "crowning of the mean trace")
    def crown(self) -> float:
        """Of the mean trace [m]."""
        return self.deviations[-1].crown

    @property
    @shows("um")
    def slope(self) -> float:
        """Largest of all teeth, with its sign [m]."""
        return max(self.deviations[:-1], key=lambda one: abs(one.slope)).slope

    @property
    @shows("um")
    def form(self) -> float:
        """Largest of all teeth [m]."""
        return max(one.form for one in self.deviations[:-1])

    @property
    @shows("um", "total deviation, maximum over all teeth")
    def total(self) -> float:
        """[m]."""
        return max(one.total for one in self.deviations[:-1])

    def allowed(self, what: str) -> float | None:
        """Tolerance of the drawn class [m]; None without one."""
        drawn = self.asked.tolerance_class
        if drawn is None:
            return None
        return float(getattr(tolerances_of(self.asked.gear, drawn).rounded, f"{self.kind}_{what}"))

    @property
    @shows("", "tolerance class (ISO 1328-1:2013) met by all teeth", name="class")
    def kept(self) -> float | None:
        """None where the standard knows no such gear, and where a tooth exceeds all classes."""
        return None if self._kept is None or math.isnan(self._kept) else self._kept

    @property
    def beyond_all_classes(self) -> bool:
        """Whether a tooth exceeds the widest class."""
        return self._kept is not None and math.isnan(self._kept)

    @cached_property
    def _kept(self) -> float | None:
        return _kept(self.asked.gear, self.kind, self.deviations[:-1])

    @property
    def teeth(self) -> dict[str, ToothTrace]:
        """Traces that are drawn, where there are several teeth."""
        found = zip(self.traces.teeth, self.traces.deviation, strict=True)
        return {
            str(tooth): ToothTrace(self.traces.x, row)
            for tooth, row in list(found)[:_DRAWN]
            if len(self.deviations) > 2
        }


@dataclass(frozen=True)
class ToothTrace:
    """Trace of one tooth [m]."""

    along: Array = shown("mm")
    deviation: Array = shown("um")


def _kinds(seen: Seen) -> dict[str, OneKind]:
    return {one.kind: OneKind(one, seen.data.found[one.kind], seen.asked) for one in seen.asked.traces}


def _all_rows(seen: Seen) -> list[OneTrace]:
    return [row for one in _kinds(seen).values() for row in one.rows]


def _class_column(seen: Seen) -> Array | None:
    """None where the standard knows a gear for some traces only."""
    classes = [row.kept for row in _all_rows(seen)]
    return None if None in classes else np.array(classes)


def _where_from(seen: Seen) -> str:
    one: Traces = seen.one.traces
    filtered = "unfiltered" if not one.wavelength else f"filtered at {one.wavelength * 1e3:.4g} mm"
    return (
        f"Gear {seen.name}: {one.kind} traces of {len(one.teeth)} {'tooth' if len(one.teeth) == 1 else 'teeth'}, "
        f"{filtered}, evaluated from {one.ends[0] * 1e3:.5g} to {one.ends[1] * 1e3:.5g} mm."
    )


def _marks(seen: Seen) -> tuple[Mark, ...]:
    return tuple(Mark("x", end * 1e3, word) for end, word in zip(seen.one.traces.ends, ("from", "to"), strict=True))


def _along(seen: Seen) -> Axis:
    return axis_of(OneKind, _place(seen))


def _place(seen: Seen) -> str:
    return "z" if seen.key == "helix" else "roll_length"


def _curves(place: str) -> tuple[Line, ...]:
    """Every tooth, their mean and the design, over the place that the kind of trace has."""
    thin = {"dash": "solid", "markers": False, "width": 1.0}
    return (
        Line("deviation", "tooth {key}", x="along", each=Family("teeth", role="grey", most=_DRAWN), look=thin,
             when=place),
        Line("measured", "mean", "series:0", x=place, look={"markers": False}, when=place),
        Line("design", "design", "series:1", x=place, look={"markers": False},
             when=lambda seen: seen.find(place) is not None and seen.one.design.any()),
    )  # fmt: skip


def _exact(_seen: Seen) -> float:
    return 0.0


def _tolerance(what: str) -> Number:
    return Number(
        what, _exact, si=lambda seen: seen.one.allowed(what), name=f"{{key}}_{what}_tolerance",
        meaning="tolerance of class {asked.tolerance_class}, ISO 1328-1:2013",
    )  # fmt: skip


_SHEET = Sheet(
    tables=(
        Rows(
            "measured_deviations_{name}", "Deviations of gear {name}",
            (
                "trace", "tooth", "slope_deviation", "form_deviation", "total_deviation", "crown",
                Cell("kept", si=_class_column),
            ),
            of=_all_rows, printed=True,
        ),
        Rows(
            "measured_{key}_{name}", "Mean {key} of gear {name}",
            ("z", "roll_length", "roll_angle", "radius", "measured", "design", "removal"), each=_kinds,
        ),
    ),
    values=(
        Each(
            _kinds,
            Number("slope_mean", name="{key}_slope_mean", meaning="slope of the mean {key} trace"),
            Number("crown", name="{key}_crown"),
            Number("slope", name="{key}_slope", meaning="{key} slope deviation, largest of all teeth"),
            Number("form", name="{key}_form", meaning="{key} form deviation, largest of all teeth"),
            Number("total", name="{key}_total"),
            *map(_tolerance, ("slope", "form", "total")),
            Number("kept", _exact, name="{key}_class"),
        ),
    ),
    figures=(
        Chart(
            "measured_{key}_{name}", "Measured {key} of gear {name}",
            "Gear {name}: {key} traces, filtered; marked is the evaluation range.",
            (Over(_along, (*_curves("z"), *_curves("roll_length")), "measured", marks=_marks),), each=_kinds,
        ),
    ),
    remarks=(
        lambda seen: seen.asked.remarks,
        Each(
            _kinds,
            Remark(_where_from),
            Remark(
                exceeding("Gear {name}: {key} deviations of a tooth exceed class 11, the widest of ISO 1328-1."),
                when="beyond_all_classes",
            ),
        ),
    ),
)  # fmt: skip


MEASURED_FLANKS = Stage(
    subjects=lambda scene: tuple(name for name in scene.case.gear if _is_measured(scene, name)),
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(Citation("iso-1328-1", "evaluation of profile and helix traces, tolerances")),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
)
