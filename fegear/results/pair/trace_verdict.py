"""What results say of a measured strain beside the computed one: verdict, better explanations, samples left out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from fegear.base.printed import figures, percent, with_rough_error
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.trace_alternatives import Alternative, Change, whole_pitches
from fegear.results.pair.better_described import BetterDescribed, degrees, of_unit

#: Standard errors that count as scatter.
_CERTAIN = 2.0
#: Most samples of a figure.
_DRAWN = 2000
#: Correlation below which shapes differ.
_ALIKE = 0.98
#: Estimated error of the computed peak above which it judges no measurement within it, as a part of the peak.
_JUDGES = 0.1
#: Ratios of measured to computed strain with a reason.
_FACTORS = {
    0.25: "a quarter bridge evaluated as a full bridge",
    0.5: "half the torque, or a quarter bridge evaluated as a half bridge",
    2.0: "twice the torque, or a half bridge evaluated as a quarter bridge",
    4.0: "a full bridge evaluated as a quarter bridge",
}
#: Difference from such a ratio within which it is named at most; a ratio nearer to one needs no reason.
_NEAR = 0.05


@dataclass(frozen=True)
class Limits:
    """How far measured and computed strain may differ, as parts of the peak.

    Parameters
    ----------
    lower, upper : float
        By the place, how far below and above the computed one.
    load, model, scatter : float
        By load and gauge factor, by the computation, by the scatter of the measurement.
    """

    lower: float
    upper: float
    load: float
    model: float
    scatter: float

    def placement(self, off: float) -> float:
        """By the place, on the side of a difference."""
        return self.upper if off >= 0.0 else self.lower

    def together(self, off: float) -> float:
        """Root of the sum of squares on the side of a difference."""
        return math.hypot(self.placement(off), self.load, self.model, self.scatter)

    def said(self, off: float) -> str:
        """The limit on the side of a difference, with both signs where it is the same on the other."""
        one, other = percent(self.together(off)), percent(self.together(-off))
        return f"{'±' if one == other else '+' if off >= 0.0 else '-'}{one}"


@dataclass(frozen=True)
class Otherwise(BetterDescribed):
    """What else may explain a trace.

    Parameters
    ----------
    side : str
        Fillet of the gauge.
    teeth : int
        Of its gear.
    torques : mapping of str to float
        Computed peak under other torques of the pair over that under the nominal one, by how they are said.
    """

    side: str = ""
    teeth: int = 1
    torques: Mapping[str, float] = field(default_factory=dict)

    def words(self, one: Alternative) -> dict[Change, tuple[str, str]]:
        """How each change is said, and what to check."""
        other, pitches = "compression" if self.side == "tension" else "tension", 0
        if "shift" in one.changes:
            pitches = whole_pitches(one.fitted.shift, self.teeth)
        of_pitches = f" ({pitches:+d} tooth pitch{'es' if abs(pitches) > 1 else ''})" if pitches else ""
        return {
            "curve": (f"the {other} fillet", "fillet"),
            "sign": ("with its sign reversed", "the polarity of the bridge"),
            "reverse": ("with its angle reversed", "reverse (direction of the angle)"),
            "shift": (
                f"shifted by {degrees(one)}{of_pitches}",
                "the tooth of the gauge and the zero of the angle" if pitches else 'the zero of the angle (add "shift" '
                "to fit)",
            ),
        }  # fmt: skip

    def of_ratio(self, ratio: float, limit: float) -> str:
        """Reason that a ratio of measured to computed strain has, with the sign before it; empty for none.

        Parameters
        ----------
        ratio : float
        limit : float
            Relative difference that does not count.
        """
        if abs(ratio - 1.0) <= max(limit, _NEAR):
            return ""
        if unit := of_unit(ratio, "the strain"):
            return unit
        near = min(max(limit, 0.01), _NEAR)
        for said, factor in self.torques.items():
            if abs(ratio / factor - 1.0) <= near:
                return f", as computed at {said}; check the torque of the trace"
        for factor, said in _FACTORS.items():
            if abs(ratio / factor - 1.0) <= near:
                return f", as of {said}; check torque and bridge"
        return ""


class BesideTrace:
    """What results say of a measured strain beside the computed one; heirs are dataclasses."""

    compared: FittedCurve | None
    otherwise: Otherwise

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
    def without(self) -> str:
        """Samples that are left out; empty for none."""
        return left_out(self.compared)

    @property
    def drawn_as(self) -> str:
        """How the figure draws the trace; empty where it is drawn as measured."""
        return drawn_as(self.compared)

    def _verdict(self, *, brief: bool) -> str:
        """Without a trace, and in drafts, empty."""
        raise NotImplementedError


def thinned(found: FittedCurve) -> FittedCurve:
    """As many samples as a figure can show; those that are left out within reach of the others."""
    some, of_left_out = (slice(None, None, max(-(-size // _DRAWN), 1)) for size in (found.samples, found.left_out.size))
    low, high = (float(edge(found.measured)) for edge in (np.min, np.max))
    room = high - low  # a dropout to -9999 would leave of the curve a line
    return replace(
        found, angle=found.angle[some], measured=found.measured[some], computed=found.computed[some],
        left_out_angle=found.left_out_angle[of_left_out],
        left_out=np.clip(found.left_out[of_left_out], low - room, high + room),
    )  # fmt: skip


def verdict(
    found: FittedCurve, peak: float, by_placement: tuple[float, float], error: float, load_tolerance: float,
    otherwise: Otherwise | None = None, *, brief: bool = False, sharper: str = "",
) -> str:  # fmt: skip
    """Measured against computed strain, in one or two sentences without a subject.

    The limit has placement, load, computation and the noise of the trace: not its residual, with which a difference of
    shape would make the verdict milder.

    Parameters
    ----------
    found : FittedCurve
    peak : float
        Computed.
    by_placement : tuple of float
        How far below and above it the peak is at places within the tolerance.
    error : float
        Its estimated one.
    load_tolerance : float
        Relative uncertainty of load and gauge factor.
    otherwise : Otherwise, optional
        What else may explain the trace.
    brief : bool
        Without the parts of the limit and the residual.
    sharper : str
        Remedy where the computed strain is too rough to judge the measured one.
    """
    size, otherwise = abs(peak), otherwise or Otherwise()
    lower, upper = (side / size for side in by_placement)
    limits = Limits(lower, upper, load_tolerance, error / size, _CERTAIN * found.gain_scatter)
    off = found.gain - 1.0
    differ = f"the curves differ in shape (correlation {found.likeness:.3f}, limit {_ALIKE:g})"
    if better := otherwise.said(found, size):
        as_given = "" if brief or found.likeness >= _ALIKE or found.gain <= 0.0 else f"; as described {differ}"
        return better + as_given
    if found.gain <= 0.0:
        return "measured and computed strain have opposite signs; check fillet, sign and shift of the trace"
    parts = (
        f"placement {percent(limits.placement(off))}, load and gauge factor {percent(limits.load)}, computation "
        f"{percent(limits.model)}, scatter {percent(limits.scatter)}"
    )
    together = limits.together(off)
    within = abs(off) <= together
    by = f"{percent(abs(off))} {'above' if off >= 0.0 else 'below'}"
    judged = f"measured strain is {by} the computed one"
    if within and limits.model > _JUDGES:  # so wide a band would pass nearly everything
        return f"{judged}; this cannot be judged: the computed strain is known to ±{percent(limits.model)} only" + (
            f"; {sharper}" if sharper else ""
        )
    limit = "" if brief else f" ({parts})"
    if found.likeness < _ALIKE:  # a gain of another shape proves nothing
        judged = (
            f"{differ}: check fillet, tooth "
            f"and position of the grid{'' if 'shift' in found.fit else ', or fit shift'}; {judged}{limit}"
        )
    elif reason := otherwise.of_ratio(found.gain, together):
        judged = f"measured strain is {figures(found.gain)} times the computed one, beyond {limits.said(off)}"
        judged += f"{limit}{reason}"
    else:
        judged += f", {'within' if within else 'beyond'} {limits.said(off)}{limit}"
        judged += "" if within else "; check load, gauge factor and position of the grid"
    if brief:  # what is said without its notes has to name what falsifies it
        drift = found.unfitted_drift
        judged += f"; {saturation}" if (saturation := _saturation(found)) else ""
        drifts = "" if drift is None else f"; the trace drifts by {figures(drift * 1e6)} µm/m per turn, not corrected"
        return judged + drifts
    return f"{judged}; RMS of the residual {percent(found.rms / size)} of the peak, noise {percent(found.noise / size)}"


def drawn_as(found: FittedCurve | None) -> str:
    """How figures draw a fitted trace, a sentence after others; empty where it is drawn as measured."""
    if found is None:
        return ""
    less = " and ".join(one for one in ("offset", "drift") if one in found.fit)
    done = [f"less the fitted {less}"] if less else []
    done += [f"divided by the fitted scale {found.scale:.3f}"] if "scale" in found.fit else []
    said = f" The measured strain is drawn {' and '.join(done)}." if done else ""
    return said + (
        " Crosses: samples left out of the comparison, far ones nearer than they are." if found.left_out.size else ""
    )


def left_out(found: FittedCurve | None) -> str:
    """Samples that are no measurement, a sentence without a subject; empty for none."""
    if found is None or not found.spikes + found.saturated:
        return ""
    of = f"of {found.samples + found.spikes + found.saturated} samples"
    said = [f"{found.spikes} {of} are spikes or dropouts"] if found.spikes else []
    said += [f"{_saturation(found, of)} (range of the amplifier)"] if found.saturated else []
    return f"{' and '.join(said)}; left out of the comparison, drawn as crosses"


def _saturation(found: FittedCurve, of: str = "samples") -> str:
    """What is saturated, and where; empty for none."""
    if found.saturated_at is None:
        return ""
    return f"{found.saturated} {of} are saturated at {figures(found.saturated_at * 1e6)} µm/m"


def drift_named(found: FittedCurve | None) -> str:
    """What a trace drifts by where nobody asked for it, a sentence without a subject; empty where it does not."""
    if found is None or found.trend_error is None or (drift := found.unfitted_drift) is None:
        return ""
    return (
        f"the measured strain drifts by {with_rough_error(drift * 1e6, found.trend_error * 1e6)} µm/m per turn "
        f"({figures(drift * found.turns * 1e6)} µm/m over {figures(found.turns)} turns), which falsifies offset and "
        'residual; add "drift" and "offset" to fit'
    )
