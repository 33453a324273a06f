"""A strain gauge as it is shown: its place, its strain over the rotation, and the measured strain beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.printed import figures, percent, with_rough_error
from fegear.base.shown import shown, shows
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.gauge_strain import GaugeHistory

#: Standard errors that count as scatter.
_CERTAIN = 2.0
#: Contacts nearer than this to the grid leave stress there that the mesh does not resolve [modules].
_NEAR_CONTACT = 0.15
#: Most samples of a figure.
_DRAWN = 2000
#: Correlation below which shapes differ.
_ALIKE = 0.98
#: Estimated error of the computed peak above which it judges no measurement within it, as a part of the peak.
_JUDGES = 0.1


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
class Limits:
    """How far measured and computed strain may differ, as parts of the peak.

    Parameters
    ----------
    placement, load, model, scatter : float
        By the place, by load and gauge factor, by the computation, by the scatter of the measurement.
    """

    placement: float
    load: float
    model: float
    scatter: float

    @property
    def together(self) -> float:
        """Root of the sum of squares."""
        return math.sqrt(self.placement**2 + self.load**2 + self.model**2 + self.scatter**2)


class BesideTrace:
    """What results say of a measured strain beside the computed one; heirs are dataclasses."""

    compared: FittedCurve | None

    @property
    def drawn(self) -> FittedCurve | None:
        """The comparison by as many samples as a figure can show."""
        return None if self.compared is None else thinned(self.compared)

    @property
    def verdict(self) -> str:
        """Measured against computed strain at the nominal load; empty without a trace and in drafts."""
        return self._verdict(brief=False)

    @property
    def judged(self) -> str:
        """The same without what its limit is made of."""
        return self._verdict(brief=True)

    @property
    def drifts(self) -> str:
        """What the measured strain drifts by where that is not fitted; empty where it does not."""
        return drift_named(self.compared)

    @property
    def drawn_as(self) -> str:
        """How the figure draws the trace; empty where it is drawn as measured."""
        return drawn_as(self.compared)

    def _verdict(self, *, brief: bool) -> str:
        """Without a trace, and in drafts, empty."""
        raise NotImplementedError


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
    reading : str
        What had to be understood in the file of the trace.
    estimated : bool
        Whether errors were estimated: a draft, which does not know its own, judges no measurement.
    sharper : str
        The setting that makes the computed strain more accurate.
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
    reading: str = ""
    estimated: bool = True
    sharper: str = ""

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
        peaks = self.history.peak_of_places(self.at)
        return float(np.abs(peaks - self.peak_strain[self.at]).max())

    @property
    def near_contact(self) -> bool:
        """Whether contacts come so near to the grid that the stress under it is that of the contact."""
        return self.clearance < _NEAR_CONTACT

    def _verdict(self, *, brief: bool) -> str:
        if self.compared is None or not self.estimated:
            return ""
        peak, error = float(self.peak_strain[self.at]), self.peak_error
        return verdict(
            self.compared, peak, self.peak_change_by_placement, 0.0 if error is None else float(error[self.at]),
            self.load_tolerance, brief=brief, sharper=self.sharper,
        )  # fmt: skip


def thinned(found: FittedCurve) -> FittedCurve:
    """As many samples as a figure can show."""
    some = slice(None, None, -(-found.samples // _DRAWN))
    return replace(found, angle=found.angle[some], measured=found.measured[some], computed=found.computed[some])


def verdict(
    found: FittedCurve, peak: float, by_placement: float, error: float, load_tolerance: float, *, brief: bool = False,
    sharper: str = "",
) -> str:  # fmt: skip
    """Measured against computed strain, in one or two sentences without a subject.

    Parameters
    ----------
    found : FittedCurve
    peak : float
        Computed.
    by_placement, error : float
        What the place within its tolerance changes of it, and its estimated error.
    load_tolerance : float
        Relative uncertainty of load and gauge factor.
    brief : bool
        Without the parts of the limit and the residual.
    sharper : str
        Remedy where the computed strain is too rough to judge the measured one.
    """
    size = abs(peak)
    limits = Limits(by_placement / size, load_tolerance, error / size, _CERTAIN * found.gain_error)
    off = found.gain - 1.0
    if found.gain <= 0.0:
        return "measured and computed strain have opposite signs; check fillet, sign and shift of the trace"
    parts = (
        f"placement {percent(limits.placement)}, load and gauge factor {percent(limits.load)}, computation "
        f"{percent(limits.model)}, scatter {percent(limits.scatter)}"
    )
    within = abs(off) <= limits.together
    if within and limits.model > _JUDGES:  # so wide a band would pass nearly everything
        return (
            f"measured strain is {percent(abs(off))} {'above' if off >= 0.0 else 'below'} the computed one; this "
            f"cannot be judged: the computed strain is known to ±{percent(limits.model)} only"
            + (f"; {sharper}" if sharper else "")
        )
    judged = f"measured strain is {percent(abs(off))} {'above' if off >= 0.0 else 'below'} the computed one"
    limit = "" if brief else f" ({parts})"
    if found.correlation < _ALIKE:  # scatter holds the difference of shape: being within it proves nothing
        judged = (
            f"the curves differ in shape (correlation {found.correlation:.3f}, limit {_ALIKE:g}): check fillet, tooth "
            f"and position of the grid{'' if 'shift' in found.fit else ', or fit shift'}; {judged}{limit}"
        )
    else:
        judged += f", {'within' if within else 'beyond'} ±{percent(limits.together)}{limit}"
        judged += "" if within else "; check load, gauge factor and position of the grid"
    if brief:  # what is said without its notes has to name what falsifies it
        drift = found.unfitted_drift
        drifts = "" if drift is None else f"; the trace drifts by {figures(drift * 1e6)} µm/m per turn, not corrected"
        return judged + drifts
    return f"{judged}; RMS of the residual {percent(found.rms / size)} of the peak"


def drawn_as(found: FittedCurve | None) -> str:
    """How figures draw a fitted trace, a sentence after others; empty where it is drawn as measured."""
    if found is None:
        return ""
    less = " and ".join(one for one in ("offset", "drift") if one in found.fit)
    done = [f"less the fitted {less}"] if less else []
    done += [f"divided by the fitted scale {found.scale:.3f}"] if "scale" in found.fit else []
    return f" The measured strain is drawn {' and '.join(done)}." if done else ""


def drift_named(found: FittedCurve | None) -> str:
    """What a trace drifts by where nobody asked for it, a sentence without a subject; empty where it does not."""
    if found is None or found.trend_error is None or (drift := found.unfitted_drift) is None:
        return ""
    return (
        f"the measured strain drifts by {with_rough_error(drift * 1e6, found.trend_error * 1e6)} µm/m per turn "
        f"({figures(drift * found.turns * 1e6)} µm/m over {figures(found.turns)} turns), which falsifies offset and "
        'residual; add "drift" and "offset" to fit'
    )
