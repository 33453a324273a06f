"""What results say of a measured strain beside the computed one: verdict, better explanations, samples left out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.notes import Note, NoteClass, class_of
from fegear.base.printed import figures, percent
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.gauge_strain import reach_of_places
from fegear.contact.trace_causes import SIZES
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.likely_cause import likely_causes, place_of_gain
from fegear.results.pair.planned_gauges import PlannedGauge
from fegear.results.pair.trace_named import (
    drawn_as,
    drift_named,
    hum_named,
    jump_of,
    left_out,
    runout_named,
    saturation,
    step_named,
    thinned,
    unsteady_named,
)

#: Standard errors that count as scatter.
_CERTAIN = 2.0
#: Difference of measured and computed strain below which its digits say nothing.
_SMALL = 1e-4
#: Correlation below which shapes differ.
_ALIKE = 0.98
#: Residual over noise below which a trace has the shape of its curve.
_SHAPED = 2.0
#: Residual over noise, and over the peak, from which on a shape is named that agrees in correlation.
_SYSTEMATIC, _NOTED = 5.0, 0.04
#: Estimated error of the computed peak above which it judges no measurement within it, as a part of the peak.
_JUDGES = 0.1
#: Change by effects that the computation does not have above which it judges nothing, over the rest of the limit.
_COUNTS = 0.5


@dataclass(frozen=True)
class Limits:
    """How far measured and computed strain may differ, as parts of the peak.

    Parameters
    ----------
    lower, upper : float
        By the place, how far below and above the computed one.
    load, model, scatter : float
        By load and gauge factor, by the computation, by the scatter of the measurement.
    neglected : float
        By effects that the computation does not have.
    """

    lower: float
    upper: float
    load: float
    model: float
    scatter: float
    neglected: float = 0.0

    def placement(self, off: float) -> float:
        """By the place, on the side of a difference."""
        return self.upper if off >= 0.0 else self.lower

    def together(self, off: float) -> float:
        """Root of the sum of squares on the side of a difference."""
        return math.hypot(self.placement(off), self.load, self.model, self.scatter, self.neglected)

    def parts(self, off: float) -> str:
        """What the limit is made of on the side of a difference."""
        named = {
            "placement": self.placement(off), "load and gauge factor": self.load, "computation": self.model,
            "neglected effects": self.neglected, "scatter": self.scatter,
        }  # fmt: skip
        said = {name: part for name, part in named.items() if part or name != "neglected effects"}
        return ", ".join(f"{name} {percent(part)}" for name, part in said.items())


@dataclass(frozen=True)
class ComputedPeak:
    """The computed peak that a measured strain is judged by, and what is not known of it.

    Parameters
    ----------
    strain, error : float
        Computed, and its estimated error.
    displacement, gains : ndarray, shape (G,)
        Of grids within the placement tolerance, towards the tip [m], and the measured / computed strain that such a
        grid would give; zero, with the gain one, is among them.
    load_tolerance : float
        Relative uncertainty of load and gauge factor.
    neglected : mapping of str to float
        Relative change of measured / computed strain with each effect that the computation does not have.
    sharper, including : str
        Remedies where the computed strain is too rough to judge the measured one, and of effects that are missing.
    gains_of_second : ndarray
        As `gains`, with the grid of the second gauge of a half bridge displaced.
    """

    strain: float
    error: float = 0.0
    displacement: Array = field(default_factory=lambda: np.zeros(1))
    gains: Array = field(default_factory=lambda: np.ones(1))
    load_tolerance: float = 0.0
    neglected: Mapping[str, float] = field(default_factory=dict)
    sharper: str = ""
    including: str = ""
    gains_of_second: Array = field(default_factory=lambda: np.ones(1))

    def limits(self, scatter: float) -> Limits:
        """How far a measured strain with a scatter (two standard errors, relative) may differ."""
        size = abs(self.strain)
        by_grids = reach_of_places(self.gains, 1.0), reach_of_places(self.gains_of_second, 1.0)
        lower, upper = (math.hypot(*one) for one in zip(*by_grids, strict=True))  # each is glued by itself
        known = Limits(lower, upper, self.load_tolerance, self.error / size, scatter)
        return replace(known, neglected=abs(self.missing))

    def limits_of(self, found: FittedCurve) -> Limits:
        """How far a trace may differ by its own scatter."""
        return self.limits(_CERTAIN * found.gain_scatter)

    @property
    def missing(self) -> float:
        """Relative change of measured / computed strain with all effects that the computation does not have."""
        return sum(self.neglected.values())

    def place_of(self, gain: float) -> float | None:
        """The smallest displacement that would give this gain [m]; None: not within reach."""
        return place_of_gain(self.displacement, self.gains, gain)


class Judged(Note):
    """A verdict that knows itself in a few words, for a table.

    Parameters
    ----------
    text, kind, margin
        As those of a `Note`.
    word : str
    """

    __slots__ = ("word",)
    word: str

    def __new__(
        cls, text: str, kind: NoteClass = NoteClass.INFORMATION, margin: float = 0.0, word: str = ""
    ) -> Judged:  # fmt: skip
        """Make the note and remember the words."""
        made = cast("Judged", super().__new__(cls, text, kind, margin))
        made.word = word
        return made

    def __reduce__(self) -> Any:
        """Travel to other processes with class and words."""
        return Judged, (str(self), self.kind, self.margin, self.word)


class BesideTrace:
    """What results say of a measured strain beside the computed one; heirs are dataclasses."""

    compared: FittedCurve | None
    otherwise: Otherwise

    @property
    def drawn(self) -> FittedCurve | None:
        """The comparison by as many samples as a figure can show."""
        return None if self.compared is None else thinned(self.compared)

    @property
    def verdict(self) -> Judged:
        """Measured against computed strain at the nominal load; empty without a trace and in drafts."""
        return self._verdict(brief=False)

    @property
    def judged(self) -> Judged:
        """The same without what its limit is made of."""
        return self._verdict(brief=True)

    @property
    def urgency(self) -> float:
        """The smaller, the sooner a reader has to act: the class of the verdict; without a trace behind all."""
        return float(class_of(self.judged)) + (0.5 if self.compared is None else 0.0)

    @property
    def drifts(self) -> str:
        """What the measured strain drifts by where that is not fitted; empty where it does not."""
        return drift_named(self._as_described)

    @property
    def runout(self) -> str:
        """What the measured strain has once per turn; empty where that is little."""
        return runout_named(self._as_described)

    @property
    def unsteady(self) -> str:
        """That measured strain differs from turn to turn as a torque does that is stepped; empty where it does not."""
        return unsteady_named(self._as_described)

    @property
    def hum(self) -> str:
        """Mains hum of the measured strain; empty where it has none."""
        return hum_named(self._as_described)

    @property
    def steps(self) -> str:
        """Coarse steps of the measured strain; empty where it has none."""
        return step_named(self.compared)

    @property
    def _as_described(self) -> FittedCurve | None:
        """The comparison, unless its angle or curve is a wrong one: what it has besides would be no advice."""
        return None if self.otherwise.better else self.fitted

    @property
    def fitted(self) -> FittedCurve | None:
        """The comparison, or where another curve explains the trace, that with it."""
        return self.otherwise.explained or self.compared

    @property
    def described(self) -> FittedCurve | None:
        """The same, None where nothing explains the trace: its offset, scale and shift are those of no fit."""
        found = self.fitted
        fails = found is None or self.otherwise.better or found.gain <= 0.0 or found.likeness < _ALIKE
        return None if fails else found

    @property
    def without(self) -> str:
        """Samples that are left out; empty for none."""
        return left_out(self.compared)

    @property
    def drawn_as(self) -> str:
        """How the figure draws the trace; empty where it is drawn as measured."""
        return drawn_as(self.compared)

    def planned(self, name: str) -> PlannedGauge:
        """What the gauge of this name comes to as long as it has no trace."""
        raise NotImplementedError

    def _verdict(self, *, brief: bool) -> Judged:
        """Without a trace, and in drafts, empty."""
        raise NotImplementedError


def alike(found: FittedCurve, otherwise: Otherwise) -> bool:
    """Whether only the ratio may be wrong: shapes agree, and no other description fits the trace better."""
    return found.gain > 0.0 and found.likeness >= _ALIKE and not otherwise.better and otherwise.low_pass is None


def verdict(
    found: FittedCurve, peak: ComputedPeak, otherwise: Otherwise | None = None, *, brief: bool = False
) -> Judged:  # fmt: skip
    """Measured against computed strain, in one or two sentences without a subject; failing unless they agree.

    The limit has placement, load, computation and the noise of the trace: not its residual, with which a difference of
    shape would make the verdict milder.

    Parameters
    ----------
    found : FittedCurve
    peak : ComputedPeak
    otherwise : Otherwise, optional
        What else may explain the trace.
    brief : bool
        Without the parts of the limit and the residual.
    """
    size, otherwise = abs(peak.strain), otherwise or Otherwise()
    limits, off = peak.limits_of(found), found.gain - 1.0
    differ = f"the curves differ in shape (correlation {found.likeness:.3f}, limit {_ALIKE:g})"
    if instead := _in_place_of_verdict(found, size, otherwise, differ, brief=brief):
        return instead
    with_them = found.gain * (1.0 + peak.missing) - 1.0
    known = replace(limits, neglected=0.0)
    if missing := limits.neglected > _COUNTS * known.together(off):  # too much to be an uncertainty: judged either way
        limits = known
    together = limits.together(off)
    within, by = abs(off) <= together, _by(off)
    either = missing and (within or abs(with_them) <= known.together(with_them) or off * with_them < 0.0)
    if within and limits.model > _JUDGES:  # so wide a band would pass nearly everything
        return Judged(
            f"measured strain is {by} the computed one; this cannot be judged: the computed strain is known to "
            f"±{percent(limits.model)} only{f'; {peak.sharper}' if peak.sharper else ''}",
            NoteClass.BEYOND_TOLERANCE, word=f"cannot be judged: {by}",
        )  # fmt: skip
    limit = f"limit {percent(together)}" + ("" if brief else f": {limits.parts(off)}")
    unsteady = unsteady_named(found)
    by_scatter = bool(unsteady) and within and abs(off) > replace(limits, scatter=0.0).together(off)
    effects = " and ".join(peak.neglected)
    kind, word = NoteClass.FAILS, f"does not agree: {by} (limit {percent(together)})"
    if by_scatter:  # the less steady a trace is, the more it would agree
        kind, word = NoteClass.BEYOND_TOLERANCE, f"cannot be judged: {by}, not steady"
        judged = (
            f"measured strain is {by} the computed one; this cannot be judged: measured / computed strain is "
            f"{found.turn_gains.min():.2f} to {found.turn_gains.max():.2f} from turn to turn ({limit})"
        )
    elif (cause := _cause(found, otherwise, together)) and not either:
        judged, word = _caused(cause, otherwise, by, limit)
    elif found.likeness < _ALIKE:  # a gain of another shape proves nothing
        word = f"differs in shape: correlation {found.likeness:.3f}"
        or_fit = "" if "shift" in found.fit else ", or fit shift"
        judged = (
            f"{differ}: check relief, pitch deviations and misalignment (load sharing), fillet and tooth{or_fit}; "
            f"measured strain is {by} the computed one ({limit})"
        )
    elif reason := otherwise.of_ratio(found.gain, together):
        judged = f"measured strain is {figures(found.gain)} times the computed one ({limit}){reason}"
        word = f"does not agree: {figures(found.gain)} times"
    elif either:
        kind, word = NoteClass.NEGLECTED, f"cannot be judged without {effects}"
        judged = (
            f"measured strain is {by} the one computed without {effects} and {_by(with_them)} that with "
            f"{'it' if len(peak.neglected) == 1 else 'them'}: this cannot be judged; {peak.including}"
        )
    elif within:
        kind, word = NoteClass.INFORMATION, f"agrees: {by} (limit {percent(together)})"
        word += ", not steady" if unsteady else ""
        judged = f"measured strain agrees with the computed one: {by} it ({limit}){_explained(peak, limits, off)}"
        judged += _of_shape(found, size)
    else:
        also = f", {_by(with_them)} it with {effects}" if missing else ""
        judged = (
            f"measured strain does not agree with the computed one: {by} it ({limit}){also}"
            + likely_causes(
                off, peak.load_tolerance, peak.displacement, peak.gains, _fillet_ratio(found, otherwise),
                leads=not otherwise.second,
            )
        )  # fmt: skip
    if brief:
        return _briefly(found, judged, kind, word, unsteady=bool(unsteady))
    if not found.fits:
        return Judged(judged, kind, word=word)
    residual = f"RMS of the residual {percent(found.rms / size)} of the peak, noise {percent(found.noise / size)}"
    return Judged(f"{judged}; {residual}", kind, word=word)


def _briefly(found: FittedCurve, judged: str, kind: NoteClass, word: str, *, unsteady: bool) -> Judged:
    """What is said without its notes has to name what falsifies it."""
    drift = found.unfitted_drift
    judged += f"; {saturated}" if (saturated := saturation(found)) else ""
    word += _saturated_at(found)
    drifts = "" if drift is None else f"; the trace drifts by {figures(drift * 1e6)} µm/m per turn, not corrected"
    drifts = f"; its zero {jumps}" if (jumps := jump_of(found)) else drifts
    steps = "; torque or gauge were not steady from turn to turn" if unsteady else ""
    if hum_named(found) and found.hum is not None:
        judged += f"; mains hum of ±{figures(found.hum.amplitude * 1e6)} µm/m at {figures(found.hum.frequency)} Hz"
        word += ", mains hum"
    return Judged(judged + drifts + steps, kind, word=word)


def _in_place_of_verdict(
    found: FittedCurve, size: float, otherwise: Otherwise, differ: str, *, brief: bool
) -> Judged | None:
    """What explains a trace that is not as it is described; None where it has to be judged."""
    if better := otherwise.said(found, size):
        as_given = "" if brief or found.likeness >= _ALIKE or found.gain <= 0.0 else f"; as described {differ}"
        return Judged(better + as_given, NoteClass.FAILS, word=better.partition(":")[0].removeprefix("the trace "))
    if behind := otherwise.of_low_pass(found, size):
        return Judged(behind, NoteClass.FAILS, word="fits behind a low pass (amplifier)")
    if found.gain <= 0.0:
        return Judged(
            "measured and computed strain have opposite signs; check fillet, sign and shift of the trace",
            NoteClass.FAILS, word="opposite sign",
        )  # fmt: skip
    return None


def _cause(found: FittedCurve, otherwise: Otherwise, limit: float) -> str:
    """The likeliest cause; empty for none, and where the ratio has a reason by itself."""
    ranked = otherwise.ranked
    if ranked is None or (ranked.of_size and otherwise.of_ratio(found.gain, limit)):
        return ""
    return otherwise.cause


def _caused(cause: str, otherwise: Otherwise, by: str, limit: str) -> tuple[str, str]:
    """The verdict by the likeliest cause, and in a few words."""
    ranked = otherwise.ranked
    if ranked is None:
        return cause, ""
    if ranked.as_likely[0].of.kind in SIZES:
        said = cause.removeprefix("the trace agrees with ")
        return (
            f"measured strain does not agree with the computed one: {by} it ({limit}); likeliest cause: {said}",
            ranked.word,
        )  # fmt: skip
    return f"{cause}; as described measured strain is {by} the computed one ({limit})", ranked.word


def _of_shape(found: FittedCurve, size: float) -> str:
    """That the shape differs by far more than noise though the ratio agrees, a clause; empty where it does not."""
    if found.rms < max(_SYSTEMATIC * found.noise, _NOTED * size) or found.unfitted_runout is not None:
        return ""
    return (
        f"; the residual, {percent(found.rms / size)} of the peak, is {figures(found.rms / found.noise, 2)} times the "
        "noise: check relief, pitch deviations (load sharing) and filters"
    )


def _fillet_ratio(found: FittedCurve, otherwise: Otherwise) -> float:
    """Of the other fillet, where it may be in the trace: its curve has another shape, which noise does not explain."""
    return otherwise.fillet_ratio if found.rms > _SHAPED * found.noise else 0.0


def _saturated_at(found: FittedCurve) -> str:
    return "" if found.saturated_at is None else f", saturated at {figures(found.saturated_at * 1e6)} µm/m"


def _by(off: float) -> str:
    size = percent(abs(off)) if abs(off) >= _SMALL else f"less than {percent(_SMALL)}"
    return f"{size} {'above' if off >= 0.0 else 'below'}"


def _explained(peak: ComputedPeak, limits: Limits, off: float) -> str:
    """What would make a difference within the limit; empty where it is scatter and error of the computation."""
    if abs(off) <= math.hypot(limits.model, limits.scatter):
        return ""
    ways = []
    if (place := peak.place_of(1.0 + off)) is not None and place != 0.0:
        ways.append(f"a grid {abs(place) * 1e3:.2g} mm nearer to the {'tip' if place > 0.0 else 'root'}")
    ways.append(f"a torque or gauge factor {percent(abs(off))} {'higher' if off >= 0.0 else 'lower'}")
    return f"; {' or '.join(ways)} would explain it"
