"""A strain gauge as it is shown: its place, its strain over the rotation, and the measured strain beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from fegear.base.arrays import Array
from fegear.base.notes import Note, class_of
from fegear.base.shown import shown, shows
from fegear.case.built.gauges import Gauge
from fegear.case.effects import EffectsPart
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.gauge_strain import GaugeHistory, StrainWith, gains_of_places, reach_of_places
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.gauges_together import GaugeGain, gain_of
from fegear.results.pair.half_bridge import HalfBridge
from fegear.results.pair.planned_gauges import PlannedGauge
from fegear.results.pair.trace_levels import OverTorque
from fegear.results.pair.trace_verdict import BesideTrace, ComputedPeak, Judged, verdict

#: Contacts nearer than this to the grid leave stress there that the mesh does not resolve [modules].
_NEAR_CONTACT = 0.15
#: What puts a gauge whose strain is not linear over torque behind those whose own verdict is of the same class.
_BY_LINEARITY = 0.25
#: What puts a gauge without a trace before others, by the relative change of its peak with the place.
_BY_PLACE = 0.4


@dataclass(frozen=True)
class GaugeInputs:
    """What this stage reads.

    Parameters
    ----------
    gauge : Gauge
    speed : float or None
        Of its gear [rad/s].
    estimates : bool
        Whether errors are estimated.
    wide : bool
        Whether its gear is 3D.
    sharper : str
        What makes the computed strain more accurate.
    name : str
    finer : str
        Remedy where its estimated error exceeds the tolerance; of 3D gears.
    tolerance : float
    effects : EffectsPart
        All of the case, for remedies.
    halves : int
        2 of a double helical pair, whose teeth are one half.
    neglected : bool
        Whether it is looked at what effects that are off would change.
    in_bridge : bool
        Whether it is the second gauge of a half bridge.
    """

    gauge: Gauge
    speed: float | None
    estimates: bool
    wide: bool
    sharper: str = field(compare=False)
    name: str = field(compare=False)
    finer: str = field(compare=False, default="")
    tolerance: float = 1.0
    effects: EffectsPart = field(compare=False, default_factory=lambda: EffectsPart())
    halves: int = 1
    neglected: bool = False
    in_bridge: bool = False


@dataclass(frozen=True)
class GaugePlace:
    """Where the middle of a grid is."""

    arc: float = shown("mm", "arc length of the grid centre along the fillet, from the root land", name="place_arc")
    diameter: float = shown("mm", "diameter of the grid centre", name="place_diameter")
    tangent_angle: float = shown("deg", "angle of the fillet tangent to the tooth centre line at the grid centre",
                                 name="place_tangent_angle")  # fmt: skip
    centre_angle: float = shown("deg", "angle of the grid centre from the tooth centre line, about the gear axis",
                                name="place_centre_angle")  # fmt: skip
    z: float = shown("mm", "place of the grid centre along the face, from the middle of the common face",
                     name="place_face_position")  # fmt: skip


@dataclass(frozen=True)
class PeakOfPlaces:
    """Largest strain at the nominal load of grids glued elsewhere."""

    displacement: Array = shown("mm", "displacement of the grid along the fillet towards the tip")
    peak: Array = shown("um/m", "peak strain at this position", name="peak_strain")


@dataclass(frozen=True)
class GaugeData(BesideTrace):
    """What a gauge sees under every load, and what it measured.

    Parameters
    ----------
    loads : tuple of float
        [N].
    at : int
        Number of the nominal one.
    history : GaugeHistory
    place : GaugePlace
    clearance : float
        From the grid's end to the lowest contact on its own flank, along the profile [modules]; infinite on the other.
    clipped : bool
        Whether the placement tolerance reaches beyond the fillet.
    load_tolerance : float
    speed : float or None
        Of the gear [rad/s].
    compared : FittedCurve or None
        Measured and computed strain at the nominal load.
    otherwise : Otherwise
        What else may explain the trace.
    reading : str
        What had to be understood in the file of the trace.
    estimated : bool
        Whether errors were estimated: a draft, which does not know its own, judges no measurement.
    sharper : str
        The setting that makes the computed strain more accurate.
    over_torque : OverTorque or None
        The trace at every torque that its file has; None where it does not say the torque.
    neglected : mapping of str to float
        Relative change of the peak at the nominal load by each effect that is off and changes it by more than the
        tolerance.
    including : str
        What switches these on.
    gains : mapping of str to float
        Relative change of measured / computed strain with each of them.
    bridge : HalfBridge or None
        What a half bridge sees, of which the trace is, with this gauge and a second one.
    with_effects : mapping of str to StrainWith
        What the second gauge of a half bridge sees with each effect that is off.
    """

    loads: Sequence[float]
    at: int
    history: GaugeHistory
    place: GaugePlace
    clearance: float
    clipped: bool
    load_tolerance: float
    speed: float | None
    compared: FittedCurve | None
    otherwise: Otherwise
    reading: str = ""
    estimated: bool = True
    sharper: str = ""
    over_torque: OverTorque | None = None
    neglected: Mapping[str, float] = field(default_factory=dict)
    including: str = ""
    gains: Mapping[str, float] = field(default_factory=dict)
    bridge: HalfBridge | None = None
    with_effects: Mapping[str, StrainWith] = field(default_factory=dict)

    @property
    @shows("s", "time from the first position")
    def t(self) -> Array | None:
        """Where a speed is given, shape (P,) [s]."""
        return None if self.speed is None else (self.history.angle - self.history.angle[0]) / self.speed

    def _peak(self, i: int) -> int:
        return self.history.peak_position(i)

    @property
    @shows("um/m", "peak of the mean strain under the grid")
    def peak_strain(self) -> Array:
        """Under each load, shape (L,)."""
        return np.array([self.history.strain[self._peak(i), i] for i in range(len(self.loads))])

    @property
    def peak_error(self) -> Array | None:
        """Estimated, shape (L,)."""
        error = self.history.strain_error
        return None if error is None else np.array([error[self._peak(i), i] for i in range(len(self.loads))])

    @property
    @shows("MPa", "mean tangential stress under the grid at the peak")
    def peak_stress(self) -> Array:
        """Under each load, shape (L,)."""
        return np.array([self.history.stress[self._peak(i), i] for i in range(len(self.loads))])

    @property
    def peak_stress_error(self) -> Array | None:
        """Estimated, shape (L,)."""
        error = self.history.stress_error
        if np.isnan(error).any():
            return None
        return np.array([error[self._peak(i), i] for i in range(len(self.loads))])

    @property
    @shows("um/m", "largest less smallest strain over the mesh cycle")
    def strain_range(self) -> Array:
        """Under each load, shape (L,)."""
        return np.asarray(np.ptp(self.history.strain, axis=0))

    @property
    @shows("deg", "rotation of the gear at the peak, zero with its tooth in contact at the pitch point")
    def peak_angle(self) -> Array:
        """Under each load, shape (L,) [rad]."""
        return np.array([self.history.angle[self._peak(i)] for i in range(len(self.loads))])

    @property
    @shows("mm", "position of the contact on the line of action at the peak")
    def peak_x(self) -> Array:
        """Under each load, shape (L,) [m]."""
        return np.array([self.history.x[self._peak(i)] for i in range(len(self.loads))])

    @property
    @shows("um/m", "peak strain of an equal gauge in the opposite fillet of the tooth")
    def peak_strain_opposite(self) -> Array:
        """Under each load, shape (L,)."""
        return self.history.peak_opposite

    @property
    @shows("", "peak strain of the compression fillet / peak strain of the tension fillet")
    def fillet_ratio(self) -> Array:
        """Under each load, shape (L,)."""
        pair = self.history.peak_opposite, self.peak_strain
        compressed, pulled = pair if self.history.side == "tension" else pair[::-1]
        return np.asarray(compressed / pulled)

    @property
    def places(self) -> PeakOfPlaces | None:
        """Peak over the place of the grid at the nominal load; None without a tolerance."""
        history = self.history
        if history.displacement.size == 1:
            return None
        return PeakOfPlaces(history.displacement, history.peak_of_places(self.at))

    @property
    @shows("um/m", "maximum change of the peak strain within placement_tolerance")
    def peak_change_by_placement(self) -> float:
        """At the nominal load."""
        return max(self.reach_of_placement)

    @property
    def reach_of_placement(self) -> tuple[float, float]:
        """How far below and above the peak strain at the nominal load, in size, that of another place is."""
        return reach_of_places(self.history.peak_of_places(self.at), float(self.peak_strain[self.at]))

    @property
    def linearity(self) -> Note:
        """How measured / computed strain changes over torque; empty without a verdict, and where it has a cause."""
        if self.over_torque is None or not self.estimated or self.otherwise.better or self.otherwise.explained:
            return Note("")
        return self.over_torque.said

    @property
    def urgency(self) -> float:
        """A verdict at one torque is worth little where the strain is not linear; behind one that fails itself."""
        own = super().urgency
        if self.compared is None:  # the one whose place counts most is the one to think about
            return own - _BY_PLACE * min(max(self.reach_of_placement) / abs(float(self.peak_strain[self.at])), 1.0)
        return min(own, class_of(self.linearity) + _BY_LINEARITY) if self.linearity else own

    @property
    def near_contact(self) -> bool:
        """Whether contacts come so near to the grid that the stress under it is that of the contact."""
        return self.clearance < _NEAR_CONTACT

    def planned(self, name: str) -> PlannedGauge:
        """What the gauge of this name comes to as long as it has no trace."""
        history = self.history
        peaks = history.peak_of_places(self.at)
        return PlannedGauge.of(name, float(self.peak_strain[self.at]), history.displacement, peaks)

    def beside_others(self, gauge: Gauge) -> GaugeGain | PlannedGauge | None:
        """Measured / computed strain with its limits, to be judged with other gauges; None without a verdict.

        Nor has one of which the ratio depends on the torque a ratio to compare.
        """
        if self.compared is None:
            return self.planned(gauge.name)
        if self.linearity and self.over_torque and not self.over_torque.linear:
            return None
        return gain_of(gauge, self, self._computed(self.compared))

    @property
    @shows("um/m", "peak of the strain less that of the second gauge of the half bridge", name="bridge_peak_strain")
    def bridge_peak(self) -> float | None:
        """At the nominal load; None without a bridge."""
        return None if self.bridge is None else self.traced_peak

    @property
    def traced(self) -> GaugeHistory:
        """What a trace is of: the strain of the gauge, or that of its half bridge."""
        return self.history if self.bridge is None else self.bridge.history

    @property
    def traced_peak(self) -> float:
        """Its peak at the nominal load."""
        return self._at_traced_peak(self.traced.strain)

    def _at_traced_peak(self, over_loads: Array) -> float:
        return float(over_loads[self.traced.peak_position(self.at), self.at])

    @property
    def tolerance(self) -> float:
        """Relative difference of measured and computed strain that is none, scatter aside; without a trace zero."""
        if self.compared is None:
            return 0.0
        limits = self._computed(self.compared).limits(0.0)
        return max(limits.together(-1.0), limits.together(1.0))

    def _computed(self, found: FittedCurve) -> ComputedPeak:
        """What the trace is judged by."""
        history = self.traced
        error = history.strain_error
        of_second = np.ones(1) if self.bridge is None else gains_of_places(found, history.angle, self.bridge.displaced)
        return ComputedPeak(
            self.traced_peak, 0.0 if error is None else self._at_traced_peak(error),
            history.displacement, gains_of_places(found, history.angle, history.displaced[:, self.at]),
            self.load_tolerance, self.gains, self.sharper, self.including, of_second,
        )  # fmt: skip

    def _verdict(self, *, brief: bool) -> Judged:
        if self.compared is None or not self.estimated:
            return Judged("")
        judged = verdict(self.compared, self._computed(self.compared), self.otherwise, brief=brief)
        if not brief or self.over_torque is None or not self.linearity or self.over_torque.linear:
            return judged
        return Judged(
            f"{judged}; measured / computed strain is not linear over torque", judged.kind,
            word=f"{judged.word}; not linear over torque",
        )  # fmt: skip
