"""Dynamic factors of a mesh over speed: what is kept, and how it is tabulated and drawn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.shown import shown

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.motion.motion_spec import MotionSpec
    from fegear.dynamics.train.charts import SpeedChart
    from fegear.dynamics.train.mesh_resonance import MeshResonance
    from fegear.dynamics.train.tooth_force import Pull


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
    resonance : MeshResonance or None
        Nearest to the speed of the largest factor.
    """

    chart: SpeedChart | None
    speed_of: str
    in_time: bool = False
    pull: Pull | None = None
    still: SpeedChart | None = None
    resonance: MeshResonance | None = None


def _errors(chart: SpeedChart, tolerance: float) -> Array:
    """Estimated errors of dynamic factors of motions in time; not a number where a motion does not repeat."""
    # what a motion that never repeats did over some periods is a sample: no tolerance holds for it
    repeats = np.array([kind == "periodic" for kind in chart.kinds])
    return np.where(repeats, np.maximum(tolerance * chart.dynamic_factor, chart.off), np.nan)


@dataclass(frozen=True)
class LargestFactor:
    """Largest dynamic factor over the speeds with bounded motion: where, how it is meant, and its estimated error."""

    over: str
    error: float | None
    factor: float = shown("", "maximum dynamic factor", name="largest_dynamic_factor")
    speed: float = shown("rpm", "its speed", name="speed_of_largest")
    without_ripple: float | None = shown(
        "", "over the speeds, without torque ripple", name="largest_dynamic_factor_without_ripple"
    )
    contact_loss: float | None = shown("", "fraction of time", name="largest_contact_loss")


def held_speeds(chart: SpeedChart) -> SpeedChart:
    """A chart at the speeds with bounded motion; at all where there are none."""
    return chart if chart.growing.all() else chart.at(~chart.growing)


@dataclass(frozen=True)
class ShownFactors:
    """Factors of a mesh as they are tabulated and drawn."""

    found: DynamicFactorData
    motion: MotionSpec

    @property
    def chart(self) -> SpeedChart | None:
        """At all speeds."""
        return self.found.chart

    @property
    def known(self) -> SpeedChart:
        """The same of a mesh that carries a mean force."""
        return cast("SpeedChart", self.chart)

    @property
    def parting(self) -> bool:
        """Whether teeth could lose contact."""
        return self.motion.contact_loss and self.found.in_time

    @property
    def zero(self) -> str:
        """What the shares of time without contact are where they could not."""
        return "" if self.parting else "; zero without effects.contact_loss"

    @property
    def lower(self) -> Array | None:
        """The other end of what is seen of a motion that is still on its way."""
        return self.known.lower if "not settled" in self.known.kinds else None

    @property
    def multiplier(self) -> Array | None:
        """Of motions in time."""
        return self.known.multiplier if self.found.in_time else None

    @property
    def averaged(self) -> SpeedChart | None:
        """What the averaging iteration found."""
        return self.chart if self.found.in_time and self.motion.method == "averaging" else None

    @property
    def errors(self) -> Array | None:
        """Of the dynamic factors of motions in time."""
        return _errors(self.known, self.motion.tolerance) if self.found.in_time else None

    @cached_property
    def held(self) -> SpeedChart:
        """At the speeds with bounded motion; at all where there are none."""
        return held_speeds(self.known)

    @property
    def largest(self) -> LargestFactor:
        """Over the speeds with bounded motion."""
        held, still = self.held, self.found.still
        worst, speed = held.worst
        at = int(np.argmax(held.dynamic_factor))
        repeats = held.kinds[at] == "periodic"
        over = "over the speeds" if held is self.known else "over the speeds with bounded motion"
        sample = "" if repeats else f"; maximum of {held.measured[at]} periods of a non-periodic motion"
        return LargestFactor(
            f"{over}, direction {self.motion.direction}{sample}",
            float(_errors(held, self.motion.tolerance)[at]) if self.found.in_time and repeats else None,
            worst, speed,
            None if still is None else float(still.dynamic_factor[np.isfinite(still.dynamic_factor)].max(initial=0.0)),
            float(self.known.apart.max()) if self.parting else None,
        )  # fmt: skip

    @property
    def several(self) -> bool:
        """Whether there is anything over speed."""
        return self.chart is not None and self.held.speeds.size > 1

    @property
    def drawn_still(self) -> Array | None:
        """Dynamic factors without torque ripple there; nan where they are endless."""
        still = self.found.still
        if still is None:
            return None
        factor = still.dynamic_factor if self.known.growing.all() else still.at(~self.known.growing).dynamic_factor
        return np.where(np.isfinite(factor), factor, np.nan)

    @property
    def odd(self) -> SpeedChart | None:
        """Speeds of motions that do not repeat."""
        odd = np.array([kind != "periodic" for kind in self.held.kinds])
        return self.held.at(odd) if odd.any() else None

    @property
    def apart(self) -> Array | None:
        """Share of the time without contact [%], where there is any."""
        return 100.0 * self.held.apart if self.held.apart.any() else None

    @property
    def behind(self) -> Array | None:
        """Share of the time with back-side contact [%], where there is any."""
        return 100.0 * self.held.behind if self.held.behind.any() else None
