"""What the design of tip reliefs of teeth with a width depends on, what comes of it, and as its sheet reads it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.shown import shows
from fegear.contact.fourier import effective_error
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.path_of_contact import active_profile
from fegear.geometry.relief import roll_in_drawing
from fegear.results.relief.ground_flank_keys import ground_rows
from fegear.results.relief.harris import HarrisMap
from fegear.results.relief.profile_charts import ProfileChart, profile_chart
from fegear.results.relief.recommended import recommended_design
from fegear.results.relief.relief_over_range import LeftOverRange

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.design import DesignPart
    from fegear.design.flanks.tip_bench import Read
    from fegear.design.flanks.tip_design import TipDesign
    from fegear.design.load_range import LoadRange
    from fegear.design.tip_relief.tip_tolerance import TipTolerance
    from fegear.geometry.gear import Gear
    from fegear.geometry.relief import EndRelief, Relief, Shape
    from fegear.results.relief.grinding import Grinding

#: Views of the Harris map in their order; others stand behind.
_VIEWS = ("linear tip relief", "parabolic tip relief", "no relief")
#: A transmission error below this is written as none [um].
_NOTHING = 1e-6


@dataclass(frozen=True)
class TipReliefInputs:
    """What the design of tip reliefs of a pair with a width depends on, besides the loaded pair.

    Parameters
    ----------
    part : DesignPart
    over : LoadRange or None
        Loads that they are designed for together.
    tolerances : tuple of TipTolerance
        Of driver and driven gear.
    present : bool
        Whether the reliefs of the case count.
    name : str
        Of the pair.
    gears : mapping of str to str
        Names by member.
    misaligned : str
        Keys of the misalignment that they are designed for; empty for none.
    """

    part: DesignPart
    over: LoadRange | None
    tolerances: tuple[TipTolerance, TipTolerance]
    present: bool
    name: str
    gears: Mapping[Member, str]
    misaligned: str = ""


@dataclass(frozen=True)
class TipReliefData:
    """A design and its pair.

    Parameters
    ----------
    pair : GearPair
    design : TipDesign
    present : tuple of Relief or None
        Profile reliefs that driver and driven gear have now.
    on_shafts : bool
        Whether shafts bend under the loads.
    """

    pair: GearPair
    design: TipDesign
    present: tuple[Relief, Relief] | None
    on_shafts: bool


@dataclass(frozen=True)
class LeftByTips:
    """What one relief leaves.

    Parameters
    ----------
    read : Read
    at : int
        Number of the design load.
    map : HarrisMap
    """

    read: Read
    at: int
    map: HarrisMap

    @property
    def error(self) -> float:
        """Of the peak-to-peak value at the design load [m]."""
        return float(self.read.error[self.at])

    @property
    @shows("um", "peak-to-peak transmission error", name="te_peak_to_peak")
    def peak_to_peak(self) -> float:
        """At the design load [m]."""
        return float(self.read.peak_to_peak[self.at])

    @property
    @shows("um", "effective transmission error A_e (amplitude, NASA TM-89901)", name="te_effective")
    def effective(self) -> float:
        """At the design load [m]."""
        return float(effective_error(self.read.series)[self.at])

    @property
    def map_error(self) -> Array:
        """Of every point of the map [m]."""
        return np.broadcast_to(self.read.error[:, None], self.map.transmission_error.shape)

    @property
    @shows("mm", "mesh position over one base pitch")
    def x(self) -> Array:
        """Shape (P,)."""
        return self.map.x

    @property
    @shows("um", "transmission error minus mean")
    def minus_mean(self) -> Array:
        """At the design load, shape (P,)."""
        return self.read.te[:, self.at] - float(self.read.series.mean[self.at])

    @property
    def words(self) -> str:
        """The peak-to-peak value as a legend says it."""
        size = self.peak_to_peak * 1e6
        return f"{size:.3g} µm" if size > _NOTHING else "0"


@dataclass(frozen=True)
class Tip:
    """Tip relief of one gear; neither errors nor equally good ones are looked for."""

    member: Member
    shape: str
    relief: EndRelief
    gear: Gear
    error: tuple[None, None] = (None, None)
    equal_amounts: str = ""
    equal_starts: str = ""

    @property
    @shows("deg", "roll angle at which the relief starts", name="start_roll_angle")
    def start(self) -> float:
        """As on the drawing: positive on an internal gear, too [rad]."""
        return float(roll_in_drawing(self.gear, self.relief.start))


@dataclass(frozen=True)
class TipsShown:
    """Tip reliefs as their sheet reads them."""

    data: TipReliefData
    asked: TipReliefInputs

    @property
    def design(self) -> TipDesign:
        """All of it."""
        return self.data.design

    @property
    def load(self) -> float:
        """Design load [N]."""
        return self.design.task.load

    @cached_property
    def ends(self) -> tuple[int, ...]:
        """Numbers of the torques that the answer names: of the range, or the design load."""
        first = next(iter(self.over_range.values()))
        return first.named if self.design.task.over else (int(np.argmin(np.abs(first.load - self.load))),)

    @cached_property
    def over_range(self) -> dict[str, LeftOverRange]:
        """What each relief leaves at each torque of the range, or of the pair."""
        task, design = self.design.task, self.design
        chosen = np.array([task.over is None or load in task.over.loads for load in task.loads])
        load = np.array(task.loads)[chosen]
        weights, shares = np.asarray(load == task.load, dtype=float), None
        if task.over is not None:
            weights = np.ones(load.size) if task.over.weights is None else np.array(task.over.weights)
            shares = None if task.over.shares is None else np.array(task.over.shares)
        most = {f"{shape} tip relief": one[chosen] for shape, one in design.most.items()}
        best = f"{design.shapes[0]} tip relief"
        finer = {best: design.finer}
        slopes = None if design.unrelieved_most is None else design.unrelieved_most[chosen]
        decisive = {best: tuple(one for one, there in zip(design.decisive, chosen, strict=True) if there)}
        return {
            label: LeftOverRange(
                load * self.data.pair.driver.base_radius, load, weights / weights.max(), read.peak_to_peak[chosen],
                read.series.amplitude[0][chosen], most.get(label), read.error[chosen],
                finer=finer.get(label, 0), decisive=decisive.get(label, ()), share=shares,
                slopes=slopes if label == "no relief" else None,
            )
            for label, read in design.left.items()
        }  # fmt: skip

    @cached_property
    def shapes(self) -> list[Shape]:
        """That were designed, the one to be ground first."""
        return self.design.shapes

    @cached_property
    def tips(self) -> tuple[Tip, ...]:
        """Of both gears for each shape, the best first."""
        from fegear.design.flanks.flank_tolerance import end_reliefs
        from fegear.design.flanks.tip_design import POWERS

        found = (
            (shape, end_reliefs(self.design.found[shape].relief.numbers, self.data.pair, POWERS[shape]))
            for shape in self.shapes
        )
        return tuple(
            Tip(member, shape, tip, self.data.pair.gear(member))
            for shape, both in found
            for member, tip in zip(MEMBERS, both, strict=True)
        )

    @cached_property
    def grinding(self) -> tuple[Grinding, ...]:
        """What is ground, the best shape first."""
        from fegear.design.flanks.flank_tolerance import FlankTolerance

        return tuple(
            row
            for shape in self.shapes
            for row in ground_rows(
                self.design.found[shape].relief, self.data.pair, self.asked.gears, f"{shape} tip relief",
                FlankTolerance(self.asked.tolerances),
            )
        )  # fmt: skip

    @cached_property
    def profile_charts(self) -> dict[str, tuple[ProfileChart, ...]]:
        """Of both gears for each shape, the best first."""
        present = self.data.present or (None, None)
        recommended = recommended_design(self.grinding, self.over_range)
        charts = {
            (tip.shape, tip.member): profile_chart(
                self.asked.gears[tip.member], self.data.pair.gear(tip.member), tip.relief,
                self.asked.tolerances[MEMBERS.index(tip.member)], present[MEMBERS.index(tip.member)],
                active_profile(self.data.pair, tip.member), recommended=f"{tip.shape} tip relief" == recommended,
            )
            for tip in self.tips
        }  # fmt: skip
        return {
            f"{shape} tip relief": tuple(charts[shape, member] for member in MEMBERS) for shape in self.shapes
        }  # fmt: skip

    @cached_property
    def left(self) -> dict[str, LeftByTips]:
        """What each relief leaves."""
        task, points = self.design.task, self.design.points
        over, loads = () if task.over is None else (task.over.loads[0], task.over.loads[-1]), np.array(task.loads)
        return {
            label: LeftByTips(
                read, task.loads.index(task.load),
                HarrisMap(self.data.pair, points.x, loads, read.te.T, at=self.load, word="design", over=over),
            )
            for label, read in self.design.left.items()
        }  # fmt: skip

    @property
    def maps(self) -> dict[str, HarrisMap]:
        """Of what each leaves, in the order of the views."""
        order = sorted(self.left, key=lambda label: _VIEWS.index(label) if label in _VIEWS else len(_VIEWS))
        return {label: self.left[label].map for label in order}

    @property
    def unproven(self) -> str:
        """Shapes whose optimum on the grid is not proven."""
        return ", ".join(cast("str", shape) for shape, best in self.design.found.items() if not best.proven)
