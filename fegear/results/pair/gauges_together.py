"""What several gauges say together: that all agree, that one is off, or that one cause explains all of them.

A torque, a gauge factor and the supply of the bridges scale every gauge alike, a grid elsewhere scales its own only.
Gauges that differ from the computation therefore have a common cause where one factor brings each of them within its
own limit, and most of them are beyond it without that factor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import NoteClass
from fegear.base.printed import figures, in_words, percent
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.gauge_teeth import TraceZero, teeth_apart
from fegear.results.pair.planned_gauges import PlannedGauge, of_planned_gauges
from fegear.results.pair.shared_cause import NamedCause, shared_cause
from fegear.results.pair.trace_verdict import alike

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.case.built.gauges import Gauge
    from fegear.results.pair.trace_verdict import BesideTrace, ComputedPeak

#: Gauges from which on something is said of all of them.
_SEVERAL = 3
#: Gauges in the two fillets of a tooth.
_PAIR = 2
#: Standard errors by which a mean that is not one is more than chance.
_CERTAIN = 2.0
#: Correlation of the shapes from which on a shift is that of the tooth.
_LIKE = 0.95
#: Kinds of causes that a common factor may be the reason of.
_OF_SIZE = ("scale", "load", "place")
#: Gauges that a common sentence names.
_NAMED = 6


@dataclass(frozen=True)
class GaugeGain:
    """Measured / computed strain of one gauge, and how far it may be from one.

    Parameters
    ----------
    name : str
    gain : float
    below, above : float
        Relative limits of a measured strain below and above the computed one.
    load : float
        What load and gauge factor are uncertain by, relative.
    agrees : bool
        Whether its own verdict is that both agree.
    alike : bool
        Whether only the ratio may be wrong: the shapes agree, and nothing else explains the trace better.
    zero : TraceZero or None
        Where its tooth is in contact, by the angle of its trace; None where that was not fitted.
    explained : bool
        Whether another description, or a low pass, explains its trace.
    fits : tuple or None
        Pair, gear, tooth and side of the fillet that its trace fits, where that is the other one of its tooth.
    cause : NamedCause or None
        What explains its trace, by name.
    """

    name: str
    gain: float
    below: float
    above: float
    load: float
    agrees: bool
    alike: bool
    zero: TraceZero | None = None
    explained: bool = False
    fits: tuple[str, str, int, str] | None = None
    cause: NamedCause | None = None

    def within(self, factor: float) -> bool:
        """Whether the strain agrees with a computed one that is multiplied by a factor."""
        off = self.gain / factor - 1.0
        return self.alike and abs(off) <= (self.above if off >= 0.0 else self.below)

    @property
    def limit(self) -> float:
        """Mean of both."""
        return 0.5 * (self.below + self.above)


def gain_of(gauge: Gauge, data: BesideTrace, peak: ComputedPeak) -> GaugeGain | None:
    """What a gauge says beside others; None without a verdict.

    Parameters
    ----------
    gauge : Gauge
    data : BesideTrace
    peak : ComputedPeak
        What its trace is judged by.
    """
    found, judged = data.compared, data.judged
    if found is None or not judged:
        return None
    limits, same = peak.limits_of(found), alike(found, data.otherwise)
    ranked, cause, zero = data.otherwise.ranked, None, None
    if ranked is not None and ranked.as_likely:
        cause = NamedCause("gauge", gauge.name, gauge.pair, ranked, gauge.tooth)
        same = same and ranked.as_likely[0].of.kind in _OF_SIZE
    if (
        not data.otherwise.better
        and found.likeness >= _LIKE
        and found.gain > 0.0
        and gauge.measured is not None
        and "shift" in found.fit
    ):
        on = gauge.pair, gauge.gear, gauge.member, gauge.measured.file
        zero = TraceZero(on, gauge.tooth, data.otherwise.teeth, found.shift)
    return GaugeGain(
        gauge.name, found.gain, limits.together(-1.0), limits.together(1.0), gauge.load_tolerance,
        judged.kind is NoteClass.INFORMATION, same, zero,
        bool(data.otherwise.better or data.otherwise.low_pass or cause), _other_fillet(gauge, data), cause,
    )  # fmt: skip


def _other_fillet(gauge: Gauge, data: BesideTrace) -> tuple[str, str, int, str] | None:
    """The place that a trace fits if it is the other fillet of its tooth and nothing else; None otherwise."""
    better = data.otherwise.better
    if not better or better[0].changes != ("curve",):
        return None
    return gauge.pair, gauge.gear, gauge.tooth, "compression" if gauge.side == "tension" else "tension"


def common_factor(gauges: Sequence[GaugeGain]) -> float:
    """Mean of measured / computed strain, geometric, each gauge weighted by its limit."""
    weights = [1.0 / max(one.limit, 1e-6) ** 2 for one in gauges]
    return math.exp(float(np.average([math.log(one.gain) for one in gauges], weights=weights)))


def of_all_gauges(gauges: Sequence[GaugeGain | PlannedGauge | None]) -> str:
    """Sentences about all gauges that have a trace: their ratios, from three on, and their teeth; empty for none.

    Where none has a trace, a sentence about what is computed for them.

    Parameters
    ----------
    gauges : sequence of GaugeGain, PlannedGauge or None
        None for a gauge with a trace and without a verdict.
    """
    planned = [one for one in gauges if isinstance(one, PlannedGauge)]
    if planned and len(planned) == len(gauges):
        return of_planned_gauges(planned)
    measured = [one for one in gauges if isinstance(one, GaugeGain)]
    return " ".join(filter(None, (of_ratios(measured), teeth_apart([(one.name, one.zero) for one in measured]))))


def of_ratios(measured: Sequence[GaugeGain]) -> str:
    """Sentence about measured / computed strain of all gauges; of fewer than three only whether they are exchanged."""
    failing = [one for one in measured if not one.agrees]
    if exchanged := _exchanged(failing):
        return exchanged
    if len(measured) < _SEVERAL:
        return ""
    if not failing:
        return _all_agree(measured)
    if 2 * len(failing) >= len(measured) and (cause := _common_cause(measured)):
        return cause
    good, explained = len(measured) - len(failing), [one for one in failing if one.explained]
    agree = f"{in_words(good).capitalize() if good else 'None'} of {in_words(len(measured))} gauges " + (
        "agrees" if good < 2 else "agree"
    )
    agree += " with the computed strain"
    if len(explained) == len(failing):
        shared = shared_cause([one.cause for one in failing if one.cause is not None])
        if not good and shared is not None and len(shared.of) == len(failing):
            return ""  # it is said of all of them, and of encoders
        return f"{agree}{'' if good else ' as described'}; {_explained(explained)}: see below."
    rest = [one for one in failing if not one.explained]
    if explained:
        return f"{agree}; {_explained(explained)}; check {_names(rest)}."
    if not good:
        return f"{agree}, and no common factor explains them: check each of them."
    if 2 * len(failing) < len(measured):
        its = "its" if len(failing) == 1 else "their"
        return (
            f"{agree}, {_names(failing)} {'does' if len(failing) == 1 else 'do'} not: check "
            f"{its} bridge, bond and position before the torque, which the others confirm."
        )
    return f"{agree}; no common factor explains the others: check each of them."


def _explained(gauges: Sequence[GaugeGain]) -> str:
    """That the traces of gauges have a cause, or fit with another description."""
    if len(gauges) == 1:
        return f"the trace of {gauges[0].name} has a cause"
    return f"the traces of {_names(gauges)} have causes"


def _exchanged(failing: Sequence[GaugeGain]) -> str:
    """That the only two traces that do not agree fit the two fillets of a tooth the other way round; empty if not."""
    places = [one.fits for one in failing if one.fits is not None]
    if len(failing) != len(places) or len(set(places)) != len({one[:3] for one in places}) + 1 or len(places) != _PAIR:
        return ""
    return (
        f"The traces of {_names(failing)} are exchanged, each fits the fillet of the other: check channels "
        "(strain_column) and leads."
    )


def _all_agree(gauges: Sequence[GaugeGain]) -> str:
    """With the mean, whose error is smaller than the limit of a single gauge."""
    gains = np.array([one.gain for one in gauges])
    off = float(gains.mean()) - 1.0
    error = float(gains.std(ddof=1)) / math.sqrt(gains.size)
    said = (
        f"All {in_words(len(gauges))} gauges agree with the computed strain: measured / computed {gains.min():.3f} to "
        f"{gains.max():.3f}, mean {1.0 + off:.3f} (standard error {error:.2g})"
    )
    chance = max(_CERTAIN * error, _mean_limit(gauges), *(one.load for one in gauges))
    if abs(off) <= chance or ((gains - 1.0) * off <= 0.0).any():
        return f"{said}."
    side, way = ("above", "higher") if off > 0.0 else ("below", "lower")
    return (
        f"{said}; all are {side} it: a torque or gauge factor {percent(abs(off))} {way} is more likely than "
        f"{in_words(len(gauges))} displaced grids."
    )


def _mean_limit(gauges: Sequence[GaugeGain]) -> float:
    """Limit of the mean of gauges whose positions are independent."""
    return math.sqrt(sum(one.limit**2 for one in gauges)) / len(gauges)


def _common_cause(gauges: Sequence[GaugeGain]) -> str:
    """What one factor explains: all gauges, or all but one; empty for none."""
    sound = [one for one in gauges if one.alike]
    if len(sound) < max(_SEVERAL, len(gauges) - 1):
        return ""
    factor = common_factor(sound)
    explained = [one for one in sound if one.within(factor)]
    if len(explained) < len(sound) == len(gauges) > _SEVERAL:  # one that is far off must not draw the mean
        far = max(sound, key=lambda one: abs(math.log(one.gain / factor)) / one.limit)
        rest = [one for one in sound if one is not far]
        factor = common_factor(rest)
        explained = [one for one in rest if one.within(factor)]
    if len(explained) < max(_SEVERAL, len(gauges) - 1):
        return ""
    off = factor - 1.0
    reason = Otherwise().of_ratio(factor, max(_mean_limit(explained), 0.01)) or (
        f", as of a torque, gauge factor or bridge supply {percent(abs(off))} {'higher' if off > 0.0 else 'lower'}; "
        "check these before the grids"
    )
    left = [one for one in gauges if one not in explained]
    which = f"all {in_words(len(gauges))} gauges" if not left else (
        f"{in_words(len(explained))} of {in_words(len(gauges))} gauges (not {_names(left)})"
    )  # fmt: skip
    return f"One cause explains {which}: measured strain is {figures(factor)} times the computed one{reason}."


def _names(gauges: Sequence[GaugeGain]) -> str:
    names = [one.name for one in gauges[:_NAMED]]
    more = f" and {len(gauges) - _NAMED} more" if len(gauges) > _NAMED else ""
    return f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 and not more else ", ".join(names) + more
