"""Strain under a gauge in motion as it is shown: with and without vibration, and the measured strain beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fegear.base.arrays import Array
from fegear.base.effects import RootEffects
from fegear.base.shown import shows
from fegear.case.built.gauges import Gauge
from fegear.case.effects import EffectsPart
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.gauge_strain import StrainWith, gains_of_places
from fegear.dynamics.train.tooth_strain import ToothStrain
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.gauges_together import GaugeGain, gain_of
from fegear.results.pair.planned_gauges import PlannedGauge
from fegear.results.pair.trace_verdict import BesideTrace, ComputedPeak, Judged, verdict


@dataclass(frozen=True)
class DynamicStrainInputs:
    """What the strain in motion depends on besides the train and its gears.

    Parameters
    ----------
    gauge : Gauge
    mesh : str
    speed : float
        Of the body that speeds refer to [rad/s].
    positions : int
    coupled : bool
        Whether the forces on the teeth around count.
    effects : RootEffects
    name : str
    wide : bool
        Whether its gear is 3D.
    halves : int
        2 of a double helical pair, whose teeth are one half.
    sharper : str
        What makes the computed strain of 3D gears more accurate.
    odd : bool
        Whether some of the teeth differ from the others.
    neglected : bool
        Whether it is looked at what effects that are off would change: a trace is judged.
    tolerance : float
    in_bridge : bool
        Whether it is the second gauge of a half bridge.
    off : EffectsPart
        All of the case, for remedies.
    """

    gauge: Gauge
    mesh: str
    speed: float
    positions: int
    coupled: bool
    effects: RootEffects
    wide: bool
    halves: int
    sharper: str = field(compare=False)
    name: str = field(compare=False)
    odd: bool = field(default=False, compare=False)
    neglected: bool = False
    tolerance: float = 1.0
    in_bridge: bool = False
    off: EffectsPart = field(compare=False, default_factory=lambda: EffectsPart())


@dataclass(frozen=True)
class DynamicStrain(BesideTrace):
    """Strain of a gauge in motion, and what it measured.

    Parameters
    ----------
    found : ToothStrain
    alone : bool
        Whether nothing but the own mesh excites the train.
    load_tolerance : float
    compared : FittedCurve or None
    otherwise : Otherwise
        What else may explain the trace.
    sharper : str
        The setting that makes the computed strain of 3D gears more accurate; empty of plane ones.
    neglected : mapping of str to float
        Relative change of the quasi-static peak by each effect that is off and changes it by more than the tolerance.
    including : str
        What switches these on.
    seen : ToothStrain or None
        What a half bridge sees, of which the trace is; None without one.
    displaced_second : ndarray, shape (P, G), or None
        The same with the grid of its second gauge displaced.
    with_effects : mapping of str to StrainWith
        Quasi-static strain with each effect that is off, of the second gauge of a half bridge.
    gains : mapping of str to float
        Relative change of measured / computed strain by each neglected effect of what the trace is of.
    torque : float
        Mean of the driver of its mesh [N m].
    """

    found: ToothStrain
    alone: bool
    load_tolerance: float
    compared: FittedCurve | None
    otherwise: Otherwise
    sharper: str = ""
    neglected: Mapping[str, float] = field(default_factory=dict)
    including: str = ""
    seen: ToothStrain | None = None
    displaced_second: Array | None = None
    with_effects: Mapping[str, StrainWith] = field(default_factory=dict)
    gains: Mapping[str, float] = field(default_factory=dict)
    torque: float = 0.0

    @property
    @shows("um/m", "dynamic peak of the strain less that of the second gauge of the half bridge",
           name="dynamic_bridge_peak_strain")  # fmt: skip
    def bridge_peak(self) -> float | None:
        """None without a bridge."""
        return None if self.seen is None else self.seen.peak

    @property
    def error(self) -> Array | None:
        """Estimated, shape (P,); None where it is not known."""
        return None if self.found.peak_error is None else self.found.error

    @property
    def others(self) -> bool:
        """Whether other meshes, or fluctuating torques, excite the train."""
        return not self.alone

    def _verdict(self, *, brief: bool) -> Judged:
        if self.compared is None or (self.sharper and self.found.peak_error is None):
            return Judged("")
        return verdict(self.compared, self._computed(self.compared), self.otherwise, brief=brief)

    def planned(self, name: str) -> PlannedGauge:
        """What the gauge of this name comes to as long as it has no trace."""
        return PlannedGauge.of(name, self.found.peak, self.found.displacement, self.found.peak_of_places)

    def beside_others(self, gauge: Gauge) -> GaugeGain | PlannedGauge | None:
        """Measured / computed strain with its limits, to be judged with other gauges; None without a verdict."""
        if self.compared is None:
            return self.planned(gauge.name)
        return gain_of(gauge, self, self._computed(self.compared))

    def _computed(self, compared: FittedCurve) -> ComputedPeak:
        """What the trace is judged by."""
        found, of_second = self.seen or self.found, np.ones(1)
        if self.displaced_second is not None:
            of_second = gains_of_places(compared, found.angle, self.displaced_second)
        return ComputedPeak(
            found.peak, found.peak_error or 0.0, found.displacement,
            gains_of_places(compared, found.angle, found.displaced), self.load_tolerance, self.gains, self.sharper,
            self.including, of_second,
        )  # fmt: skip
