"""The sentence on a trace that fits clearly better with another description: how it fits, and what to check."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.printed import figures, percent
from fegear.contact.trace_alternatives import Alternative
from fegear.contact.trace_low_pass import WIDTH_OF_AVERAGE

if TYPE_CHECKING:
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.trace_alternatives import Change
    from fegear.contact.trace_low_pass import LowPass

#: Ratios of measured to computed that a wrong unit has, and how near to one of them a ratio is.
_UNITS, _OF_UNIT = (1e-6, 1e-3, 1e3, 1e6), 0.2
#: The changes in the order in which they are said.
_ORDER: tuple[Change, ...] = ("turning", "curve", "sign", "reverse", "shift")


@dataclass(frozen=True)
class BetterDescribed:
    """Descriptions of a trace that fit clearly better; heirs have the words of what is measured.

    Parameters
    ----------
    better : tuple of Alternative
        The likeliest first.
    """

    better: tuple[Alternative, ...] = ()

    def words(self, one: Alternative) -> dict[Change, tuple[str, str]]:
        """How each change is said, and what to check."""
        raise NotImplementedError

    def said(self, found: FittedCurve, size: float, of: str = "the peak") -> str:
        """The better descriptions beside the given one, a clause; empty for none.

        Parameters
        ----------
        found : FittedCurve
            The trace as it is described.
        size : float
            Computed, of which residuals are parts.
        of : str
            How this is called.
        """
        if not self.better:
            return ""
        ways, remedies = (
            " or ".join(dict.fromkeys(
                " and ".join(self.words(one)[change][i] for change in _ORDER if change in one.changes)
                for one in self.better
            ))
            for i in range(2)
        )  # fmt: skip
        likeliest = self.better[0].fitted
        instead = f" instead of {percent(found.rms / size)}" if found.fits else ", as described no fit"
        return (
            f"the trace fits {ways}: RMS of the residual {percent(likeliest.rms / size)} of {of}{instead}, "
            f"measured / computed {likeliest.gain:#.3g}; check {remedies}"
        )


def low_pass_said(kind: str, order: int, lag: float, speed: float | None) -> str:
    """A low pass by its kind and limit, a clause.

    Parameters
    ----------
    kind : str
        Empty for first order.
    order : int
    lag : float
        Rotation within its time constant [rad].
    speed : float or None
        Of the shaft of the angle [rad/s].
    """
    cutoff = ""
    if speed:
        hertz = figures(speed / (2.0 * math.pi * lag), 2)
        cutoff = f"a limiting frequency of {hertz} Hz at {figures(speed * 30.0 / math.pi)} rpm"
    if kind == "moving average":
        width = WIDTH_OF_AVERAGE * lag
        passed = f"a moving average over {figures(math.degrees(width), 2)}° of rotation"
        if not speed:
            return passed
        return f"{passed}, {figures(1e3 * width / speed, 2)} ms at {figures(speed * 30.0 / math.pi)} rpm"
    if kind:
        limit = cutoff or f"a limiting frequency of {figures(1.0 / lag, 2)} times per turn"
        return f"a low pass of about order {order} ({kind}) with {limit}"
    passed = f"a low pass with a time constant of {figures(math.degrees(lag), 2)}° of rotation"
    return passed + (f", {cutoff}" if cutoff else "")


def behind_low_pass(behind: LowPass, found: FittedCurve, size: float, speed: float | None, of: str, check: str) -> str:
    """That a trace fits behind a low pass, a clause.

    Parameters
    ----------
    behind : LowPass
    found : FittedCurve
        The trace as it is described.
    size : float
        Computed, of which residuals are parts.
    speed : float or None
        Of the shaft of the angle [rad/s].
    of, check : str
        How the size is called, and where the low pass is looked for.
    """
    return (
        f"the trace fits behind {low_pass_said(behind.kind, behind.order, behind.lag, speed)}: RMS of the residual "
        f"{percent(behind.fitted.rms / size)} of {of} instead of {percent(found.rms / size)}, measured / computed "
        f"{behind.fitted.gain:#.3g}; check {check}"
    )


def degrees(one: Alternative) -> str:
    """Shift of an alternative."""
    return f"{math.degrees(one.fitted.shift):.3g}°"


def of_unit(ratio: float, what: str) -> str:
    """Reason of a ratio of measured to computed that a wrong unit has, a clause; empty for none."""
    for unit in _UNITS:
        if abs(ratio / unit - 1.0) <= _OF_UNIT:
            size = f"{1.0 / unit:g} times larger" if unit < 1.0 else f"{unit:g} times smaller"
            return f"; with a unit {size} it is {figures(ratio / unit)} times: check the unit of {what}"
    return ""
