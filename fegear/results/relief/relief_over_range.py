"""Reliefs over a range of torques: what each leaves at every torque, and what to grind, in a table and a sentence."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown, shows
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.base.arrays import Array
    from fegear.design.relief_design import ReliefDesign
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.pair import GearPair
    from fegear.results.relief.ground_tips import GroundTip

#: A removal, or what is left, below this is none [m].
_NOTHING = 5e-9


@dataclass(frozen=True)
class LeftOverRange:
    """What one relief leaves at each torque of the range, arrays of shape (L,).

    Parameters
    ----------
    error : float or None
        Of each peak-to-peak value [m].
    """

    torque: Array = shown("N.m", "torque on the driver", label="torque on the driver")
    load: Array = shown("N", "total load along the line of action", name="total_load")
    weight: Array = shown("", "weight in the design, over the largest")
    peak_to_peak: Array = shown("um", "peak-to-peak transmission error", name="te_peak_to_peak")
    first: Array = shown("um", "first harmonic of the transmission error, amplitude", name="te_first_harmonic")
    error: float | None = None

    @property
    def errors(self) -> Array | None:
        """Of the peak-to-peak values [m]."""
        return None if self.error is None else np.full(self.torque.size, self.error)


def left_over_range(design: ReliefDesign, pair: GearPair) -> dict[str, LeftOverRange]:
    """What every relief leaves over the range of the design; empty without one."""
    over = design.task.over
    if over is None:
        return {}
    load = np.array(over.loads)
    weights = np.ones(load.size) if over.weights is None else np.array(over.weights)
    searched = {f"{shape} tip relief": one for shape, one in design.ground.items()}
    searched |= {f"{shape} tip relief for one load": one for shape, one in design.for_one_load.items()}
    return {
        label: LeftOverRange(
            load * pair.driver.base_radius, load, weights / weights.max(),
            np.array([one.peak_to_peak for one in found]), np.array([one.series.amplitude[0] for one in found]),
            searched[label].objective_error if label in searched else None,
        )
        for label, found in design.over_range.items()
    }  # fmt: skip


@dataclass(frozen=True)
class GrindingRow:
    """Tip relief of one gear as a grinder is given it; what is equally good, from and to.

    Parameters
    ----------
    tip : GroundTip
    """

    tip: GroundTip
    gear: str = shown("", "gear")
    member: Member = shown("", "driver or driven", name="member")
    shape: str = shown("", "shape of the relief from its start")

    def _diameter(self, roll: float) -> float:
        return 2.0 * self.tip.base_radius * math.hypot(1.0, roll)

    @property
    @shows("um", "amount of relief at end_diameter")
    def amount(self) -> float:
        """[m]."""
        return self.tip.relief.amount

    @property
    @shows("mm", "diameter at the start of relief")
    def start_diameter(self) -> float:
        """[m]."""
        return self._diameter(self.tip.relief.start)

    @property
    def amount_error(self) -> float:
        """[m]."""
        return float(self.tip.error[0])

    @property
    def start_diameter_error(self) -> float:
        """[m]."""
        return 2.0 * self.tip.start_radius_error

    @property
    @shows("mm", "diameter at which the amount applies (tip form circle)")
    def end_diameter(self) -> float:
        """[m]."""
        return self._diameter(self.tip.relief.end)

    @property
    @shows("deg", "roll angle at the start of relief")
    def start_roll_angle(self) -> float:
        """[rad]."""
        return self.tip.relief.start

    @property
    @shows("mm", "length of the relief on the line of action", name="length_on_path")
    def length(self) -> float:
        """[m]."""
        return self.tip.base_radius * (self.tip.relief.end - self.tip.relief.start)

    @property
    @shows("um", "lower end of the near-optimum range (within 1 % of the minimum)")
    def amount_from(self) -> float:
        """[m]."""
        return self.tip.band[0].amount

    @property
    @shows("um", "upper end of the near-optimum range")
    def amount_to(self) -> float:
        """[m]."""
        return self.tip.band[1].amount

    @property
    @shows("mm", "lower end of the near-optimum range")
    def start_diameter_from(self) -> float:
        """Of the longest relief [m]."""
        return self._diameter(self.tip.band[1].start)

    @property
    @shows("mm", "upper end of the near-optimum range")
    def start_diameter_to(self) -> float:
        """Of the shortest relief [m]."""
        return self._diameter(self.tip.band[0].start)

    @property
    def words(self) -> str:
        """As a sentence says it."""
        return f"{figures(self.amount * 1e6, 2)} µm from d {self.start_diameter * 1e3:.1f} mm on gear {self.gear}"


def grinding_rows(tips: tuple[GroundTip, ...], gears: Mapping[Member, str], shape: str) -> tuple[GrindingRow, ...]:
    """Of both gears, for one shape."""
    return tuple(GrindingRow(one, gears[one.member], one.member, shape) for one in tips if one.shape == shape)


def said_of_range(seen: Seen) -> Iterator[str]:
    """What to grind and what it leaves from the largest to the smallest torque; what one load only would do."""
    d = seen.data
    if not d.grinding:
        return
    shape = d.grinding[0].shape
    none, best, single = (
        d.over_range[label] for label in ("no relief", f"{shape} tip relief", f"{shape} tip relief for one load")
    )
    ground = [row.words for row in d.grinding if row.amount > _NOTHING]
    ends = dict.fromkeys((best.torque.size - 1, 0))
    left = ", ".join(
        f"{figures(none.peak_to_peak[i] * 1e6, 2)} -> {figures(best.peak_to_peak[i] * 1e6, 2)} µm at "
        f"{figures(best.torque[i], 4)} N m"
        for i in ends
    )
    do = f"grind {' and '.join(ground)}, {shape}" if ground else "no tip relief reduces the transmission error"
    yield f"Pair {seen.name}: {do}: transmission error {left}, peak to peak."
    worse = np.flatnonzero(single.peak_to_peak > none.peak_to_peak)
    if worse.size:
        i = int(worse[np.argmax((single.peak_to_peak / none.peak_to_peak)[worse])])
        nominal = d.load * d.data.pair.pair.driver.base_radius
        yield (
            f"Pair {seen.name}: tip relief designed for {figures(nominal, 4)} N m only gives "
            f"{figures(single.peak_to_peak[i] * 1e6)} µm peak-to-peak at {figures(single.torque[i], 4)} N m, "
            f"more than without relief ({figures(none.peak_to_peak[i] * 1e6)} µm)."
        )


def _key(seen: Seen) -> str:
    return seen.key.replace(" ", "_")


def _first(seen: Seen) -> LeftOverRange:
    return next(iter(seen.data.over_range.values()))


OVER_RANGE = Rows(
    "relief_over_torque_{name}", "Transmission error of {name} over the torque, with each relief",
    (
        "torque", "load", "weight",
        Each(
            "over_range",
            Cell("peak_to_peak", name=lambda seen: f"te_peak_to_peak_{_key(seen)}", further="{key}"),
            Off("peak_to_peak", "errors", name=lambda seen: f"te_peak_to_peak_{_key(seen)}"),
            Cell("first", name=lambda seen: f"te_first_harmonic_{_key(seen)}", further="{key}"),
        ),
    ),
    of=_first, when="over_range", printed=True,
)  # fmt: skip

GRINDING = Rows(
    "grinding_{name}", "Tip relief to grind on {name}",
    (
        "gear", "member", "shape", "amount", Off("amount", "amount_error"), "start_diameter",
        Off("start_diameter", "start_diameter_error"),
        "start_roll_angle", "length", "end_diameter", "amount_from", "amount_to", "start_diameter_from",
        "start_diameter_to",
    ),
    of="grinding", when="grinding", printed=True,
)  # fmt: skip

RANGE_CHART = Chart(
    "relief_over_torque_{name}", "Transmission error of pair {name} over the torque",
    "Pair {name}: peak-to-peak transmission error over the torque with each relief: for the whole range, for the "
    "design load only (for one load), and without.",
    (
        Over(
            "torque",
            (Line("peak_to_peak", each=Family("over_range", role="{key}"), look={"markers": True}),),
            options={"zero": True},
        ),
    ),
    of=_first, when="over_range",
)  # fmt: skip
