"""A gauge's trace over torque: the gain at each torque of its pair, and whether it is the same at all of them.

One trace has one zero of the angle: the shift found at the nominal torque holds for all. Offset, drift and scale are
those of each torque's own samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.notes import Note, failing
from fegear.base.printed import figures, percent
from fegear.base.shown import shown, shows
from fegear.case.built.measured_strain import turns_of
from fegear.contact.curve_fit import DRIFT_TURNS, NothingToCompareError, fit_curve
from fegear.contact.once_per_turn import once_per_turn
from fegear.contact.turns import turns_along

if TYPE_CHECKING:
    from fegear.case.built.gauges import Gauge
    from fegear.case.built.measured_strain import StrainLevel
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.gauge_strain import GaugeHistory

#: Standard errors that count as scatter.
_CERTAIN = 2.0
#: Part of the computed engagement that samples of a torque have to cover.
_COVERED = 0.9


@dataclass(frozen=True)
class TraceLevel:
    """Measured beside computed strain at one torque.

    Parameters
    ----------
    found : FittedCurve
    computed_peak : float
    """

    found: FittedCurve
    torque: float = shown("N.m", "torque on the driver")
    mean_torque: float = shown("N.m", "mean of the measured torque on the driver")
    turns: float = shown("", "turns of the gear at this torque")
    computed_peak: float = shown("um/m", "peak strain computed at this torque", label="peak strain")

    @property
    @shows("", "samples compared")
    def samples(self) -> int:
        """Within the computed curve."""
        return self.found.samples

    @property
    @shows("um/m", "peak strain measured, by the fitted curve less its offset", label="peak strain")
    def measured_peak(self) -> float:
        """[m/m]."""
        return self.gain * self.computed_peak

    @property
    @shows("", "measured / computed strain by least squares", label="measured / computed strain")
    def gain(self) -> float:
        """At the shift of the nominal torque."""
        return self.found.gain

    @property
    @shows("", "standard error of gain by the scatter of the samples")
    def gain_scatter(self) -> float:
        """Without a difference of shape, which is alike at all torques."""
        return self.found.gain_scatter

    @property
    @shows("", "measured / computed strain, the computed one in proportion to the mean of the measured torque",
           label="measured / computed strain")  # fmt: skip
    def gain_at_mean(self) -> float:
        """What is compared between torques."""
        return self.gain * self.torque / self.mean_torque

    @property
    def gain_band(self) -> float:
        """Two standard errors."""
        return _CERTAIN * self.gain_scatter

    @property
    @shows("um/m", "root mean square of the residual", name="residual_rms")
    def rms(self) -> float:
        """At this torque."""
        return self.found.rms

    @property
    @shows("", "correlation coefficient of measured and computed strain")
    def correlation(self) -> float:
        """Of Pearson."""
        return self.found.correlation


@dataclass(frozen=True)
class OverTorque:
    """Levels of a trace by torque, ascending.

    Parameters
    ----------
    levels : sequence of TraceLevel
    at : int
        Number of the nominal one.
    load_tolerance : float
        Relative uncertainty of load and gauge factor.
    partial : tuple of str
        Torques whose samples cover too little of the engagement.
    """

    levels: Sequence[TraceLevel]
    at: int
    load_tolerance: float
    partial: tuple[str, ...] = ()

    @property
    def _changes(self) -> Array:
        """Of the gain from the nominal torque, relative, shape (L,)."""
        gains = np.array([one.gain_at_mean for one in self.levels])
        return np.asarray(gains / gains[self.at] - 1.0)

    @property
    def _limits(self) -> Array:
        """What scatter and torque may change of it, shape (L,)."""
        parts = np.array([one.gain_band / abs(one.gain) for one in self.levels])
        return np.sqrt(parts**2 + parts[self.at] ** 2 + self.load_tolerance**2)

    @property
    def _largest(self) -> int:
        return int(np.argmax(np.abs(self._changes)))

    @property
    @shows("", "maximum relative change of measured / computed strain from the nominal torque to another",
           name="gain_change_over_torque")  # fmt: skip
    def change(self) -> float:
        """With its sign."""
        return float(self._changes[self._largest])

    @property
    def bands(self) -> Array:
        """Two standard errors of the gains, shape (L,)."""
        return np.array([one.gain_band for one in self.levels])

    @property
    def several(self) -> bool:
        """Whether there is more than one torque."""
        return len(self.levels) > 1

    @property
    def linear(self) -> bool:
        """Whether the gain is the same at all torques, within what scatter and torque may change of it."""
        return not bool((np.abs(self._changes) > self._limits).any())

    @property
    def torque_zero(self) -> tuple[float, float] | None:
        """How much too high the torque reads [N m], and the gain without that, where this makes a change; else None.

        A strain p that grows with the torque T is p (1 - t p' / p) at a torque that is t less than it reads.
        """
        torque = np.array([one.mean_torque for one in self.levels])
        peak = np.array([one.computed_peak * one.mean_torque / one.torque for one in self.levels])
        if self.linear or np.ptp(torque) <= 0.0:
            return None
        slope = np.gradient(np.append(0.0, peak), np.append(0.0, torque))[1:]
        gains, bands = np.array([one.gain_at_mean for one in self.levels]), self.bands
        weight = 1.0 / np.hypot(bands, 1e-3 * np.abs(gains))
        matrix = np.stack([np.ones_like(torque), -slope / peak], axis=1)
        gain, of_slope = np.linalg.lstsq(matrix * weight[:, None], gains * weight)[0]
        rest = np.abs(gains - matrix @ np.array([gain, of_slope]))
        if gain <= 0.0 or (rest > np.hypot(bands, self.load_tolerance * np.abs(gains))).any():
            return None
        return float(of_slope / gain), float(gain)

    @property
    def said(self) -> Note:
        """How the gain changes over torque, a sentence without a subject; empty for a single torque."""
        if not self.several or min(one.gain for one in self.levels) <= 0.0:
            return Note("")
        by_torque = sorted(self.levels, key=lambda one: one.torque)  # of several gauges the same, whose notes are one
        ends = " and ".join(f"{one.gain_at_mean:.3f} at {_torque(one.torque)}" for one in (by_torque[0], by_torque[-1]))
        start = f"measured / computed strain over {len(self.levels)} torques is {ends}"
        changes, limits = self._changes, self._limits
        if self.linear:
            i = self._largest
            return Note(
                f"{start}, linear: the largest change from the nominal torque is {percent(abs(self.change))} at "
                f"{_torque(self.levels[i].torque)}, within ±{percent(limits[i])}"
            )
        i = int(np.argmax(np.abs(changes) / limits))
        return failing(
            f"{start}, not linear: at {_torque(self.levels[i].torque)} it is {percent(abs(changes[i]))} "
            f"{'above' if changes[i] > 0.0 else 'below'} that at the nominal torque, beyond ±{percent(limits[i])} "
            f"(load, scatter); {self._to_check}"
        )

    @property
    def _to_check(self) -> str:
        """What to look at where the gain is not the same at all torques."""
        check = "check the zero of the torque" + ("" if "offset" in self.levels[self.at].found.fit else
                                                  " and of the bridge")  # fmt: skip
        if (zero := self.torque_zero) is None:
            return check
        reads = f"reads {figures(abs(zero[0]), 2)} N m too {'high' if zero[0] > 0.0 else 'low'}"
        return f"{check}: a torque that {reads} would explain it, measured / computed strain then {zero[1]:.3f}"

    @property
    def off_nominal(self) -> str:
        """Where the mean of the torque is not the nominal one, a sentence without a subject; else empty."""
        one = self.levels[self.at]
        off = one.mean_torque / one.torque - 1.0
        if abs(off) <= self.load_tolerance:
            return ""
        return (
            f"mean of the measured torque is {_torque(one.mean_torque)}, {percent(abs(off))} "
            f"{'above' if off > 0.0 else 'below'} the nominal {_torque(one.torque)} of the computed strain, which the "
            "verdict does not subtract"
        )

    @property
    def left_out(self) -> str:
        """Torques that could not be compared, a sentence without a subject; empty for none."""
        if not self.partial:
            return ""
        return f"samples at {', '.join(self.partial)} do not cover the engagement of the tooth; left out"


def _torque(torque: float) -> str:
    return f"{figures(torque, 4)} N m"


def over_torque(gauge: Gauge, found: FittedCurve | None, history: GaugeHistory, loads: Sequence[float],
                nominal: int) -> OverTorque | None:  # fmt: skip
    """Every torque of a trace beside the strain computed there; None where its file does not have the torque.

    Parameters
    ----------
    gauge : Gauge
    found : FittedCurve or None
        The trace at the nominal load.
    history : GaugeHistory
    loads : sequence of float
        Of the history [N].
    nominal : int
        Number of the nominal one.
    """
    measured = gauge.measured
    if measured is None or found is None or not measured.levels:
        return None
    levels: list[TraceLevel] = []
    partial: list[str] = []
    at = 0
    for level in measured.levels:
        i = min(range(len(loads)), key=lambda k: abs(loads[k] - level.load))
        strain, turns = history.strain[:, i], turns_of(level.angle)
        fit = [one for one in measured.fit if one != "shift" and (one != "drift" or turns >= DRIFT_TURNS)]
        try:
            fitted = found if i == nominal else fit_curve(
                level.angle - found.shift, _less_runout(level, found, measured.runout), history.angle, strain, fit
            )  # fmt: skip
        except NothingToCompareError:
            fitted = None
        if fitted is None or (i != nominal and np.ptp(fitted.angle) < _COVERED * np.ptp(history.angle)):
            partial.append(_torque(level.level))
            continue
        if i == nominal:
            at = len(levels)
        peak = float(strain[history.peak_position(i)])
        levels.append(TraceLevel(fitted, level.level, level.torque, turns, peak))
    return OverTorque(levels, at, gauge.load_tolerance, tuple(partial))


def _less_runout(level: StrainLevel, found: FittedCurve, less: bool) -> Array:
    """Strain of a level less what it has itself once per turn, where that is asked for."""
    if not less:
        return level.strain
    wave = once_per_turn(level.angle, level.strain, turns_along(level.angle), found.shift, np.sort(found.angle))
    return level.strain if wave is None else level.strain - wave.at(level.angle)
