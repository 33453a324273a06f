"""A planetary set some of whose teeth differ, over all base pitches until the same teeth mesh again, quasi-static."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shows
from fegear.contact.plane.odd_compliance import OddCompliance
from fegear.dynamics.planetary.planet_loads import PlanetLoads
from fegear.dynamics.planetary.set_signals import SetSignals

if TYPE_CHECKING:
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.sidebands import ConditionIndicators
    from fegear.dynamics.planetary.set_signals import RingLines, SetOrders
    from fegear.geometry.pair import Member

#: Even samples over a base pitch: whole parts for three to six planets, whose lines cancel then.
_SAMPLES = 960


def with_ordinary_teeth(engagement: Engagement, member: Member) -> Engagement:
    """The pair with all teeth of one gear alike: of the planets that have no odd tooth."""
    compliance = engagement.compliance
    source = compliance.source(member)
    plain = source.ordinary if isinstance(source, OddCompliance) else source
    if member == "driver":
        return replace(engagement, compliance=replace(compliance, driver=plain), driver_odd={})
    return replace(engagement, compliance=replace(compliance, driven=plain), driven_odd={})


@dataclass(frozen=True)
class SetRevolution:
    """Loads of a set until the same teeth mesh again.

    Parameters
    ----------
    loads : PlanetLoads
    odd_planet : int
        The planet that has the odd teeth of the planets, from 0.
    teeth : tuple of int
        Numbers of teeth of the gears with odd teeth.
    frequency : float
        Mesh frequency [Hz]; NaN without a speed.
    clockwise : bool
        Whether the sun turns clockwise relative to the carrier.
    """

    loads: PlanetLoads
    odd_planet: int
    teeth: tuple[int, ...]
    frequency: float
    clockwise: bool = False

    @property
    def base_pitches(self) -> int:
        """C."""
        return self.loads.cycle.cycles

    @cached_property
    @shows("um", "transmission error minus that of an ordinary base pitch", label="residual")
    def te_residual(self) -> Array:
        """Less the median of all base pitches, whose places are the same, shape (M,) [m]."""
        each = self.loads.te.reshape(self.base_pitches, -1)
        return np.asarray((each - np.median(each, axis=0)).ravel())

    @property
    @shows("um", "maximum residual: transmission error minus that of an ordinary base pitch")
    def te_residual_max(self) -> float:
        """[m]."""
        return float(np.abs(self.te_residual).max())

    def even(self, values: Array) -> Array:
        """Even samples over all base pitches of something over the places."""
        count, s = self.base_pitches, self.loads.s
        return np.interp(np.arange(count * _SAMPLES) / _SAMPLES, s, values, period=float(count))

    @cached_property
    def signals(self) -> SetSignals:
        """Of the transmission error and the mesh forces."""
        loads = self.loads
        force = np.array([[self.even(one) for one in mesh] for mesh in loads.mesh_force])
        return SetSignals(
            loads.cycle.model.found, self.base_pitches, self.odd_planet, self.teeth, self.frequency, self.clockwise,
            loads.mean_force, self.even(loads.te), force,
        )  # fmt: skip

    @property
    def orders(self) -> SetOrders:
        """Lines up to eight mesh harmonics."""
        return self.signals.orders

    @property
    def indicators(self) -> ConditionIndicators:
        """Condition indicators of the transmission error."""
        return self.signals.indicators

    @property
    def at_ring(self) -> RingLines:
        """What a pick-up on the ring, at the angle zero of the planets when the cycle begins, sees of their meshes."""
        return self.signals.at_ring
