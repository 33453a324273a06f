"""What explains a measured trace, a clause: the likeliest cause first, with its error."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.notes import Note, failing
from fegear.base.printed import figures, percent
from fegear.results.pair.better_described import low_pass_said

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.trace_causes import Cause, Causes
    from fegear.geometry.pair import GearPair

#: Standard errors behind the sign.
_CERTAIN = 2.0
#: Measured over computed strain from which on leads may be the reason of less.
_LEADS = 0.9
#: Causes that are said besides the likeliest at most.
_MOST = 3
#: Teeth of a pitch deviation, which counts positive where the flank is set back.
_TEETH = {0: "the tooth of the gauge", -1: "the tooth before that of the gauge", 1: "the tooth after that of the gauge"}
_GEARS = {("driver",): "the driver", ("driven",): "the driven gear", ("driver", "driven"): "both gears"}


@dataclass(frozen=True)
class LikeliestFlank:
    """What of flanks and load may be otherwise than stated.

    Parameters
    ----------
    found : Causes
    pair : GearPair
    torques : tuple of float
        Of the traces, on the driver [N m].
    size : float
        Of the computed curve of the last one, of which residuals are parts.
    of : str
        How this is called.
    speed : float or None
        Of the gear of a gauge [rad/s].
    of_gauge : bool
        Whether a gauge measured, not encoders.
    """

    found: Causes
    pair: GearPair
    torques: tuple[float, ...]
    size: float
    of: str = "the peak-to-peak value"
    speed: float | None = None
    of_gauge: bool = False

    @property
    def said(self) -> Note:
        """What the traces agree with, and what explains less of it; empty for none."""
        if self.agrees:
            return failing("; ".join(filter(None, (self.agrees, self.less))))
        if not self.found.causes or self.found.within:
            return Note("")
        return Note(
            f"no single change of relief, torque{' or pitch, of grid or amplifier' if self.of_gauge else ' or pitch'} "
            "explains the residual; what explains most of it: " + self._shares(self.found.causes[:_MOST])
        )

    @property
    def agrees(self) -> str:
        """What the traces agree with, and what cannot be distinguished from it; empty where nothing explains them."""
        causes, alike = self.found.causes, self._alike
        if not alike:
            return ""
        agree = "the trace agrees" if len(self.torques) == 1 else "the traces agree"
        said = f"{agree} with {self._one(causes[0])}"
        if alike > 1:
            others = " or ".join(self._one(one) for one in causes[1:alike][:_MOST])
            said += f", which cannot be distinguished from {others}"
        return (
            f"{said}: RMS of the residual {percent(causes[0].rms / self.size)} of {self.of} instead of "
            f"{percent(self.found.rms / self.size)}"
        )

    @property
    def _alike(self) -> int:
        """How many causes are named as those; none where one is within its tolerance."""
        return 0 if self.found.within else self.found.alike

    @property
    def as_likely(self) -> Sequence[Cause]:
        """The likeliest cause, and those that cannot be distinguished from it."""
        return self.found.causes[: self._alike]

    def named(self, cause: Cause) -> str:
        """A cause with its error."""
        return self._one(cause)

    @property
    def of_size(self) -> bool:
        """Whether the likeliest cause is a size of the trace that may have a reason of its own."""
        return bool(self._alike) and self.found.causes[0].of.kind in ("scale", "load")

    @property
    def word(self) -> str:
        """The same in a few words, for a table; empty for none."""
        if not self._alike:
            return ""
        first, others = self._one(self.found.causes[0]).removeprefix("a "), self._alike - 1
        return first + (f", or {others} other cause{'s' if others > 1 else ''} as likely" if others else "")

    @property
    def less(self) -> str:
        """What explains less, the likeliest first; empty for nothing, and where nothing explains the traces."""
        alike = self._alike
        less = self.found.causes[alike:][:_MOST] if alike else ()
        return f"less likely: {self._shares(less)}" if less else ""

    def _shares(self, causes: Sequence[Cause]) -> str:
        """Causes with what each explains of the residual."""
        said = [f"{self._one(one)} ({percent(one.explained)}" for one in causes]
        return f"{said[0]} of the squared residual{''.join(f'), {one}' for one in said[1:])})"

    def _one(self, one: Cause) -> str:
        """A cause with its two standard errors, and what is stated."""
        of, gears, error = one.of, _GEARS.get(one.of.of, ""), _CERTAIN * one.error
        if of.kind == "load":
            if len(self.torques) == 1:
                torque = _both(one.value * self.torques[0], error * self.torques[0])
                times = f", {figures(one.tolerances, 2)} times load_tolerance" if self.of_gauge else ""
                return f"a torque of {torque} N m in place of {figures(self.torques[0])} N m{times}"
            off = _both(100.0 * abs(one.value - 1.0), 100.0 * error)
            return f"torques {off} % {'higher' if one.value > 1.0 else 'lower'} than stated"
        if of.kind == "tip relief":
            amount = f"{_both(one.value * 1e6, error * 1e6)} µm"
            if of.added:
                return f"a linear tip relief of {gears} of {amount} in place of none"
            return f"a tip relief of {gears} of {amount} in place of {figures(of.stated * 1e6)} µm"
        if of.kind == "start":
            start, stated = (self._diameter(one, roll) for roll in (one.value, of.stated))
            within = abs(self._diameter(one, one.value + error) - start)
            whose = f"{gears} (diameter of the driver)" if len(of.of) > 1 else gears
            return (
                f"a tip relief of {whose} from a diameter of {_both(start * 1e3, within * 1e3)} mm in place "
                f"of {figures(stated * 1e3, 5)} mm"
            )
        if of.kind == "scale":
            return self._scale(one)
        if of.kind == "place":
            where = "tip" if one.value > 0.0 else "root"
            times = f"{figures(one.tolerances, 2)} times placement_tolerance"
            return f"a grid {_both(abs(one.value) * 1e3, error * 1e3)} mm nearer to the {where}, {times}"
        if of.kind == "filter":
            return low_pass_said(of.called, of.order, math.exp(one.value), self.speed)
        if of.kind == "bridge":
            taken = "a quarter bridge" if of.called == "1" else "two equal and opposite strains"
            return f"a half bridge with the other fillet, evaluated as {taken} (set bridge)"
        return f"a single pitch deviation of {_TEETH[of.tooth]} of {_both(one.value * 1e6, error * 1e6)} µm"

    def _scale(self, one: Cause) -> str:
        """Scale of a trace: of gauges with what it is that of."""
        if not self.of_gauge:
            return f"a scale of {_both(one.value, _CERTAIN * one.error)}"
        off = f"{percent(abs(one.value - 1.0))} {'higher' if one.value > 1.0 else 'lower'}"
        times = f", {figures(one.tolerances, 2)} times load_tolerance" if one.tolerances else ""
        leads = " (or leads of a quarter bridge with two wires)" if _LEADS < one.value < 1.0 else ""
        return f"a gauge factor or bridge supply {off}{leads}{times}"

    def _diameter(self, one: Cause, roll: float) -> float:
        return 2.0 * self.pair.gear(one.of.of[0]).base_radius * math.hypot(1.0, roll)


def _both(value: float, error: float) -> str:
    """Value and error with the digits that the error allows: one of it, two where it begins with 1."""
    if not (error > 0.0 and math.isfinite(error)):
        return figures(value)
    size = math.floor(math.log10(error))
    decimals = max(-size + (error < 2.0 * 10.0**size), 0)
    return f"{value:.{decimals}f} ± {error:.{decimals}f}"
