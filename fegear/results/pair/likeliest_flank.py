"""Which relief, torque or pitch explains a measured trace, a clause: the likeliest first, with its error."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.notes import Note, failing
from fegear.base.printed import figures, percent

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.trace_causes import Cause, Causes
    from fegear.geometry.pair import GearPair

#: Standard errors behind the sign.
_CERTAIN = 2.0
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
    """

    found: Causes
    pair: GearPair
    torques: tuple[float, ...]
    size: float
    of: str = "the peak-to-peak value"

    @property
    def said(self) -> Note:
        """What the traces agree with, and what explains less of it; empty for none."""
        if self.agrees:
            return failing("; ".join(filter(None, (self.agrees, self.less))))
        if not self.found.causes:
            return Note("")
        return Note(
            "no single change of relief, torque or pitch explains the residual; what explains most of it: "
            + self._shares(self.found.causes[:_MOST])
        )

    @property
    def agrees(self) -> str:
        """What the traces agree with, and what cannot be distinguished from it; empty where nothing explains them."""
        causes, alike = self.found.causes, self.found.alike
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
    def less(self) -> str:
        """What explains less, the likeliest first; empty for nothing, and where nothing explains the traces."""
        alike = self.found.alike
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
                return f"a torque of {torque} N m in place of {figures(self.torques[0])} N m"
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
            return f"a scale of {_both(one.value, error)}"
        if of.kind == "place":
            where = "tip" if one.value > 0.0 else "root"
            return f"a grid {_both(abs(one.value) * 1e3, error * 1e3)} mm nearer to the {where}"
        return f"a single pitch deviation of {_TEETH[of.tooth]} of {_both(one.value * 1e6, error * 1e6)} µm"

    def _diameter(self, one: Cause, roll: float) -> float:
        return 2.0 * self.pair.gear(one.of.of[0]).base_radius * math.hypot(1.0, roll)


def _both(value: float, error: float) -> str:
    """Value and error with the digits that the error allows: one of it, two where it begins with 1."""
    if not (error > 0.0 and math.isfinite(error)):
        return figures(value)
    size = math.floor(math.log10(error))
    decimals = max(-size + (error < 2.0 * 10.0**size), 0)
    return f"{value:.{decimals}f} ± {error:.{decimals}f}"
