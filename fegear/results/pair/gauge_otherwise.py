"""What else may explain a trace of a gauge: another description, a low pass, a ratio that has a reason."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from fegear.base.printed import figures, percent
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.trace_alternatives import Alternative, Change, whole_pitches
from fegear.contact.trace_low_pass import LowPass
from fegear.results.pair.better_described import BetterDescribed, behind_low_pass, degrees, of_unit
from fegear.results.pair.likeliest_flank import LikeliestFlank

#: Ratios of measured to computed strain with a reason.
_FACTORS = {
    0.25: "a quarter bridge evaluated as a full bridge",
    0.5: "half the torque, or a quarter bridge evaluated as a half bridge",
    2.0: "twice the torque, or a half bridge evaluated as a quarter bridge",
    4.0: "a full bridge evaluated as a quarter bridge",
}
#: The same of a half bridge with a second gauge.
_FACTORS_OF_BRIDGE = {
    0.5: "half the torque, or a strain that the amplifier divided by two active arms (set active_arms = 2)",
    2.0: "twice the torque, or a strain that was not divided by two active arms (remove active_arms)",
}
#: Difference from such a ratio within which it is named at most; a ratio nearer to one needs no reason.
_NEAR = 0.05


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
    second : str
        Other gauge of the half bridge that measured; empty for none.
    fillet_ratio : float
        Strain of an equal gauge in the other fillet over that of the gauge, in size and as traces are compared, over
        the whole curve; zero where it is not known.
    low_pass : LowPass or None
        With which the trace fits clearly better.
    speed : float or None
        Of its gear [rad/s].
    mate_teeth : int
        Of the gear that it meshes with.
    over_time : bool
        Whether the trace has the time in place of an angle.
    ranked : LikeliestFlank or None
        What explains the trace, the likeliest cause first; None where it was not looked for.
    explained : FittedCurve or None
        The trace over the computed curve with the likeliest cause, where that is another curve.
    """

    side: str = ""
    teeth: int = 1
    torques: Mapping[str, float] = field(default_factory=dict)
    second: str = ""
    fillet_ratio: float = 0.0
    low_pass: LowPass | None = None
    speed: float | None = None
    mate_teeth: int = 1
    over_time: bool = False
    ranked: LikeliestFlank | None = None
    explained: FittedCurve | None = None

    @property
    def cause(self) -> str:
        """The likeliest cause, and those as likely, with the residual, a clause; empty for none."""
        return "" if self.ranked is None else self.ranked.agrees

    def of_low_pass(self, found: FittedCurve, size: float) -> str:
        """That the trace fits behind a low pass, a clause; empty for none.

        Parameters
        ----------
        found : FittedCurve
            The trace as it is described.
        size : float
            Computed peak.
        """
        if self.low_pass is None:
            return ""
        return behind_low_pass(
            self.low_pass, found, size, self.speed, "the peak", "filter and bandwidth of the amplifier"
        )  # fmt: skip

    def words(self, one: Alternative) -> dict[Change, tuple[str, str]]:
        """How each change is said, and what to check."""
        other, pitches = "compression" if self.side == "tension" else "tension", 0
        key = "speed (that of the gear of the gauge)" if self.over_time else "shaft (whose rotation the angle is)"
        if "shift" in one.changes:
            pitches = whole_pitches(one.fitted.shift, self.teeth)
        of_pitches = f" ({pitches:+d} tooth pitch{'es' if abs(pitches) > 1 else ''})" if pitches else ""
        longer, off = one.factor > 1.0, abs(one.factor - 1.0)
        of_turn = f"{percent(off)} {'longer' if longer else 'shorter'} ({figures(360.0 * off, 2)}° per turn)"
        pulses = "lost" if longer else "additional"
        turning = {
            "mate": (f"at {figures(abs(self.mate_teeth / self.teeth))} times its angle, that of the other shaft", key),
            "own": ("with its angle as that of the gear of the gauge", "shaft"),
            "twice": (
                "at half its angle", "speed" if self.over_time else
                "the lines per revolution of the encoder (it counts twice)",
            ),
            "half": (
                "at twice its angle", "speed" if self.over_time else
                "the lines per revolution of the encoder (it counts half)",
            ),
            "counted": (f"with an angle {of_turn}", f"the encoder ({pulses} pulses, lines per revolution)"),
        }  # fmt: skip
        return {
            "turning": turning.get(one.turning, ("", "")),
            "curve": (f"the {other} fillet", "fillet"),
            "sign": (
                "with its sign reversed",
                f"which of both gauges is subtracted ({self.second}, by bridge)" if self.second else
                "the polarity of the bridge",
            ),
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
        torque = next((one for one, factor in self.torques.items() if abs(ratio / factor - 1.0) <= near), "")
        causes = _FACTORS_OF_BRIDGE if self.second else _FACTORS
        cause = next((one for factor, one in causes.items() if abs(ratio / factor - 1.0) <= near), "")
        if torque and cause:  # half the torque is often among those of the pair
            return f", as computed at {torque}, or as of {cause.rpartition(', or ')[2]}; check torque and bridge"
        if torque:
            return f", as computed at {torque}; check the torque of the trace"
        return f", as of {cause}; check torque and bridge" if cause else ""
