"""Measured transmission errors as they are shown: what each trace says, the computed curve beside it, a verdict."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.notes import Note, NoteClass, class_of, exceeding, failing
from fegear.base.printed import figures, percent
from fegear.base.shown import shown, shows
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.fitted_error import FittedError
from fegear.contact.measured_error import MeasuredError
from fegear.contact.order_spectrum import OrderLine
from fegear.contact.trace_causes import Cause
from fegear.results.pair.better_described import behind_low_pass
from fegear.results.pair.error_otherwise import OtherwiseError
from fegear.results.pair.error_over_torques import common_cause
from fegear.results.pair.likeliest_flank import LikeliestFlank

#: Standard errors that count as scatter.
_CERTAIN = 2.0
#: Correlation below which shapes differ.
_ALIKE = 0.98
#: Estimated error of the computed value above which it judges no measurement within it, relative.
_JUDGES = 0.1
#: Residual over that of a likely cause up to which another description explains as much.
_NO_MORE = 1.4
#: Orders of a figure, over the number of teeth; harmonics over torque that are drawn.
_DRAWN_ORDERS, _DRAWN_HARMONICS = 6.5, 3


@dataclass(frozen=True)
class TraceBeside:
    """One trace beside what is computed at its load.

    Parameters
    ----------
    found : MeasuredError
    fitted : FittedError
    computed_amplitude : ndarray, shape (H,)
        Of the mesh harmonics that both have [m].
    computed_error : float or None
        Estimated error of the computed peak-to-peak value [m].
    load_tolerance : float
    reading : str
        What had to be understood in the file.
    estimated : bool
        Whether errors were estimated: a draft, which does not know its own, judges no measurement.
    otherwise : OtherwiseError
        What else may explain the trace.
    torque_needed : float or None
        Torque on the driver at which the computed transmission error is the measured one [N m].
    """

    found: MeasuredError
    fitted: FittedError
    computed_amplitude: Array = shown("um", "amplitude computed")
    computed_error: float | None = shown("um", "estimated error of computed_peak_to_peak")
    torque: float = shown("N.m", "torque on the driver")
    load: float = shown("N", "load along the line of action")
    computed_peak_to_peak: float = shown("um", "peak-to-peak transmission error computed")
    load_tolerance: float = 0.01
    reading: str = ""
    estimated: bool = True
    otherwise: OtherwiseError = field(default_factory=lambda: OtherwiseError())
    torque_needed: float | None = None

    @property
    @shows("", "harmonic of the tooth-mesh frequency")
    def n(self) -> NDArray[np.int64]:
        """Of both amplitudes, shape (H,)."""
        return self.found.n[: self.computed_amplitude.size]

    @property
    @shows("um", "amplitude measured (not divided by the scale)")
    def measured_amplitude(self) -> Array:
        """Of the mesh harmonics, shape (H,) [m]."""
        return self.found.amplitude[: self.computed_amplitude.size]

    @property
    @shows("um", "peak-to-peak value of the measured mesh curve, mean of all teeth")
    def measured_peak_to_peak(self) -> float:
        """[m]."""
        return float(np.ptp(self.found.te))

    @property
    @shows("", "measured / computed peak-to-peak value")
    def ratio(self) -> float:
        """Infinite where nothing is computed."""
        computed = self.computed_peak_to_peak
        return self.measured_peak_to_peak / computed if computed else math.inf

    @property
    @shows("um", "standard deviation of the measured curve between teeth")
    def spread(self) -> float:
        """[m]."""
        return self.found.spread

    @property
    @shows("", "tooth pitches averaged")
    def pitches(self) -> int:
        """Of the trace."""
        return self.found.pitches

    @property
    @shows("", "revolutions of the shaft in the order spectrum")
    def turns(self) -> float:
        """Whole ones, or tooth pitches over the number of teeth."""
        return self.found.spectrum.turns

    @property
    @shows("", "order per revolution of the shaft of the angle", label="order")
    def drawn_order(self) -> Array:
        """Up to some multiples of the mesh order."""
        return self.found.spectrum.order[: self._drawn]

    @property
    @shows("um", "amplitude of the measured transmission error", label="amplitude")
    def drawn_amplitude(self) -> Array:
        """Of these orders [m]."""
        return self.found.spectrum.amplitude[: self._drawn]

    @property
    def _drawn(self) -> int:
        order = self.found.spectrum.order
        return int(np.searchsorted(order, _DRAWN_ORDERS * self.found.teeth))

    @property
    @shows("", "maximum order that is not a multiple of the mesh order")
    def largest_order(self) -> float | None:
        """None where only mesh orders are resolved."""
        order, amplitude = self.found.spectrum.order, self.found.spectrum.amplitude
        other = np.abs(order / self.found.teeth - np.round(order / self.found.teeth)) > 1e-6
        return float(order[other][amplitude[other].argmax()]) if other.any() else None

    @property
    @shows("um", "amplitude of largest_order")
    def largest_amplitude(self) -> float | None:
        """[m]."""
        if (largest := self.largest_order) is None:
            return None
        spectrum = self.found.spectrum
        return float(spectrum.amplitude[np.searchsorted(spectrum.order, largest - 1e-9)])

    @property
    def runouts(self) -> tuple[OrderLine | None, OrderLine | None]:
        """Once per revolution of the shaft of the angle, and of the mating gear; None where the trace is too short."""
        found = self.found
        return found.spectrum.line(1.0), found.spectrum.line(found.mate_order) if found.mate_order else None

    @property
    @shows("um", "amplitude once per revolution of the shaft of the angle (runout of gear, shaft or encoder)")
    def runout(self) -> float | None:
        """[m]."""
        return None if (line := self.runouts[0]) is None else line.amplitude

    @property
    @shows("deg", "rotation of the shaft of the angle, from the zero of the measured angle, at the maximum of the part "
           "once per revolution")  # fmt: skip
    def runout_angle(self) -> float | None:
        """[rad]."""
        return None if (line := self.runouts[0]) is None else line.phase

    @property
    @shows("um", "amplitude once per revolution of the mating gear (runout of gear, shaft or encoder)")
    def mate_runout(self) -> float | None:
        """[m]."""
        return None if (line := self.runouts[1]) is None else line.amplitude

    @property
    @shows("deg", "rotation of the mating gear, from the zero of the measured angle, at the maximum once per "
           "revolution of it")  # fmt: skip
    def mate_runout_angle(self) -> float | None:
        """[rad]."""
        return None if (line := self.runouts[1]) is None else line.phase

    @property
    def by_runout(self) -> bool:
        """Whether the largest order besides the mesh is once per revolution of either gear."""
        orders = [line.order for line in self.runouts if line is not None]
        return any(abs((self.largest_order or 0.0) - order) < 1e-6 for order in orders)

    def runout_said(self, own: str, mate: str) -> str:
        """What there is once per revolution of both gears, a sentence without a subject; empty for a short trace."""
        said = [
            f"{figures(line.amplitude * 1e6)} µm of the {name} (maximum at {math.degrees(line.phase):.0f}° {of})"
            for line, name, of in zip(
                self.runouts, (own, mate), ("of the measured angle", "of its own rotation from there"), strict=True
            )
            if line is not None
        ]
        if not said:
            return ""
        return f"once per revolution {' and '.join(said)}: runout of gear, shaft or encoder, not part of the comparison"

    @property
    def steps(self) -> str:
        """Where the trace steps as an encoder does that loses pulses, a clause; empty where it does not."""
        if not (steps := self.found.steps):
            return ""
        said = " and ".join(
            f"by {figures(one.height * 1e6, 2, signed=True)} µm at {math.degrees(one.angle):.0f}° of the measured angle"
            for one in steps
        )
        return f"the trace steps {said} (to a tooth pitch): an encoder lost a pulse, or counted one too many"

    @property
    def few_samples(self) -> str:
        """Which mesh harmonics cannot be judged, a clause; empty of a trace with enough samples."""
        if (resolved := self.found.resolved) is None:
            return ""
        harmonics = "the first mesh harmonic" if resolved == 1 else f"{resolved} mesh harmonics"
        return (
            f"{figures(self.found.samples)} samples per tooth pitch resolve {harmonics}: both curves are compared up to"
            " these, higher ones and peaks between samples cannot be judged"
        )

    @property
    def verdict(self) -> Note:
        """Measured against computed, a clause without a subject; empty in drafts."""
        return self._verdict(brief=False)

    @property
    def judged(self) -> Note:
        """The same without what its limit is made of."""
        return self._verdict(brief=True)

    def _verdict(self, *, brief: bool) -> Note:
        """Failing unless both agree."""
        if not self.estimated:
            return Note("")
        fitted, computed = self.fitted, self.computed_peak_to_peak
        if self.otherwise.mate_teeth:
            return failing(
                f"the mesh order of the trace is {self.otherwise.mate_teeth}, the number of teeth of the other gear: "
                "check shaft"
            )
        if counts := self.otherwise.counted:
            order = self.found.teeth * (0.5 if counts == "twice" else 2.0)
            return failing(
                f"the mesh order of the trace is {order:g}, {'half' if counts == 'twice' else 'twice'} the number of "
                f"teeth: the encoder counts {counts}; check its lines per revolution"
            )
        if better := self.otherwise.said(fitted, computed, "the peak-to-peak value"):
            return failing(better)
        if (behind := self.otherwise.low_pass) is not None:
            return failing(behind_low_pass(
                behind, fitted, computed, self.otherwise.speed, "the peak-to-peak value",
                f"filters and averaging of the encoder signals{self._mesh_frequency}",
            ))  # fmt: skip
        if fitted.gain <= 0.0:
            return failing("measured and computed curve go against each other; check positive, reverse and fit")
        parts = self._limits
        together = math.hypot(*parts.values())
        off = fitted.gain - 1.0
        within, by = abs(off) <= together, f"{percent(abs(off))} {'above' if off >= 0.0 else 'below'}"
        said = f"measured transmission error, fitted over the whole curve, is {by} the computed one"
        if within and parts["computation"] > _JUDGES:  # so wide a band would pass nearly everything
            return exceeding(
                f"{said}; this cannot be judged: the computed one is known to ±{percent(parts['computation'])} only; "
                'set width = "solid" or reduce accuracy.tolerance'
            )
        made_of = ", ".join(f"{name} {percent(part)}" for name, part in parts.items())
        limit = f"limit {percent(together)}" + ("" if brief else f": {made_of}")
        kind = NoteClass.FAILS
        if fitted.likeness < _ALIKE:  # a gain of another shape proves nothing
            said = (
                f"the curves differ in shape (correlation {fitted.likeness:.3f}, limit {_ALIKE:g}): check relief, "
                f"profile deviations and misalignment{'' if 'shift' in fitted.fit else ', or fit shift'}; {said} "
                f"({limit})"
            )
        elif reason := self.otherwise.of_ratio(fitted.gain):
            said = (
                f"fitted over the whole curve, the measured transmission error is {figures(fitted.gain)} times the "
                f"computed one{reason}"
            )
        elif within:
            kind = NoteClass.INFORMATION
            said = f"measured transmission error agrees with the computed one: {by} it ({limit})"
        else:
            said = (
                f"measured transmission error does not agree with the computed one: {by} it ({limit}); "
                f"{self._by_torque}check torque, relief and the unit of the trace"
            )
        if not brief and fitted.fits:
            said += f"; RMS of the residual {percent(fitted.rms / computed)} of the peak-to-peak value"
        return Note(said, kind)

    @property
    def tolerance(self) -> float:
        """Of measured over computed, scatter aside, relative."""
        parts = self._limits
        return math.hypot(parts["torque"], parts["computation"])

    def beside_cause(self, cause: Cause | None) -> TraceBeside:
        """The same without a low pass or another torque that explains no more than a relief or a torque does."""
        if cause is None:
            return self
        otherwise, most = self.otherwise, _NO_MORE * cause.rms
        if otherwise.low_pass is not None and _left_by(otherwise.low_pass.fitted) > most:
            otherwise = replace(otherwise, low_pass=None)
        better = tuple(one for one in otherwise.better if one.changes != ("curve",) and _left_by(one.fitted) <= most)
        return replace(self, otherwise=replace(otherwise, better=better))

    @property
    def _limits(self) -> dict[str, float]:
        """What measured and computed may differ by, relative, by its cause."""
        return {
            "torque": self.load_tolerance,
            "computation": (self.computed_error or 0.0) / self.computed_peak_to_peak,
            "scatter": _CERTAIN * self.fitted.gain_scatter,
        }

    @property
    def _by_torque(self) -> str:
        """Which torque would give what was measured, a clause before another; empty for none."""
        if self.torque_needed is None:
            return ""
        off = self.torque_needed / self.torque - 1.0
        by = f"{percent(abs(off))} {'higher' if off >= 0.0 else 'lower'}"
        return f"a torque of {figures(self.torque_needed)} N m ({by}) would explain it; "

    @property
    def _mesh_frequency(self) -> str:
        """What a filter has to pass, where the speed is known; else empty."""
        if not (speed := self.otherwise.speed):
            return ""
        return f" (mesh frequency {figures(speed * self.found.teeth / (2.0 * math.pi))} Hz)"

    @property
    def described(self) -> bool:
        """Whether the trace is as it is described."""
        otherwise = self.otherwise
        return not (otherwise.mate_teeth or otherwise.counted or otherwise.better)

    @property
    def differs_in_size(self) -> bool:
        """Whether shapes agree, and only the ratio does not."""
        fitted, otherwise = self.fitted, self.otherwise
        elsewhere = otherwise.mate_teeth or otherwise.counted or otherwise.better or otherwise.low_pass
        return (
            self.estimated and not elsewhere and not otherwise.of_ratio(fitted.gain)
            and fitted.gain > 0.0 and fitted.likeness >= _ALIKE
            and abs(fitted.gain - 1.0) > math.hypot(*self._limits.values())
        )  # fmt: skip


def _left_by(fitted: FittedCurve) -> float:
    """Root mean square of what a fitted curve leaves, as measured."""
    return fitted.rms * abs(fitted.scale)


@dataclass(frozen=True)
class OverTorque:
    """One mesh harmonic over the torques of the traces."""

    n: int
    torque: Array = shown("N.m", "torque on the driver")
    measured: Array = shown("um", "amplitude of the mesh harmonic", label="amplitude")
    computed: Array = shown("um", "amplitude computed", label="amplitude")


@dataclass(frozen=True)
class MeasuredErrorData:
    """Traces of a pair by load, ascending."""

    traces: Sequence[TraceBeside]
    shaft: str
    flank: LikeliestFlank

    @property
    def last(self) -> TraceBeside:
        """Of the largest load."""
        return self.traces[-1]

    @property
    def judged(self) -> Note:
        """The verdict at the largest load; empty where a cause of all traces is named."""
        return Note("") if self.flank.agrees else self.last.judged

    @property
    def described(self) -> FittedCurve | None:
        """The fit at the largest load; None where the trace has another curve: its numbers are those of no fit."""
        last = self.last
        fails = self.flank.agrees or not last.described or last.fitted.gain <= 0.0 or last.fitted.likeness < _ALIKE
        return None if fails else last.fitted

    @property
    def readings(self) -> list[tuple[str, str]]:
        """What had to be understood in the files, and at which torques [N m]; the same of all torques said once."""
        torques: dict[str, list[str]] = {}
        for one in self.traces:
            if one.reading:
                torques.setdefault(one.reading, []).append(f"{one.torque:.5g}")
        return [("" if len(at) == len(self.traces) else f", {', '.join(at)} N m", said) for said, at in torques.items()]

    @property
    def urgency(self) -> float:
        """The smaller, the sooner a reader has to act: the class of the verdict at the largest load."""
        return float(class_of(self.last.judged))

    @property
    def common_cause(self) -> str:
        """What would explain differences at all torques, a sentence without a subject; empty for none."""
        if not self.several or not all(one.differs_in_size for one in self.traces):
            return ""
        torques, gains = (
            np.array(values) for values in zip(*((one.torque, one.fitted.gain) for one in self.traces), strict=True)
        )  # fmt: skip
        return common_cause(torques, gains, [one.torque_needed for one in self.traces])

    @property
    def several(self) -> bool:
        """Whether there are several torques."""
        return len(self.traces) > 1

    @cached_property
    def over_torque(self) -> list[OverTorque]:
        """First mesh harmonics against torque."""
        count = min(_DRAWN_HARMONICS, *(one.n.size for one in self.traces))
        torque = np.array([one.torque for one in self.traces])
        return [
            OverTorque(
                n + 1, torque, np.array([one.measured_amplitude[n] for one in self.traces]),
                np.array([one.computed_amplitude[n] for one in self.traces]),
            )
            for n in range(count)
        ]  # fmt: skip
