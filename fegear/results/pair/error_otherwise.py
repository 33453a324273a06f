"""What else may explain a trace of encoders: another description, the other shaft, a wrong count, a low pass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.printed import figures
from fegear.contact.measured_error import MeasuredError
from fegear.contact.trace_alternatives import Alternative, Change
from fegear.contact.trace_low_pass import LowPass
from fegear.results.pair.better_described import BetterDescribed, degrees, of_unit

#: Difference from the ratio of the teeth within which it is named.
_AT_SHAFT = 0.05
#: Mesh orders that are looked at, and times by which those of the other gear are larger where the shaft is wrong.
_ORDERS, _OF_MATE = 3, 4.0


@dataclass(frozen=True)
class OtherwiseError(BetterDescribed):
    """What else may explain a trace of encoders.

    Parameters
    ----------
    mate_teeth : int
        Teeth of the other gear where the orders of the trace are its multiples; 0 where they are not.
    ratio : float
        Number of teeth of the driven gear over that of the driver, where the trace is an angle; else 0.
    low_pass : LowPass or None
        With which the trace fits clearly better.
    speed : float or None
        Of the shaft of the angle [rad/s].
    counted : {"", "twice", "half"}
        How the encoder counts, by the order of the mesh.
    """

    mate_teeth: int = 0
    ratio: float = 0.0
    low_pass: LowPass | None = None
    speed: float | None = None
    counted: str = ""

    @property
    def counts_otherwise(self) -> bool:
        """Whether the angle is one of another shaft, or counted otherwise than stated."""
        return bool(self.mate_teeth or self.counted)

    def words(self, one: Alternative) -> dict[Change, tuple[str, str]]:
        """How each change is said, and what to check."""
        return {
            "curve": (f"as computed at {one.curve}", "the torque of the trace"),
            "sign": ("with its sign reversed", "positive"),
            "reverse": ("with its angle reversed", "reverse"),
            "shift": (f"shifted by {degrees(one)}", 'the zero of the angle (add "shift" to fit)'),
        }

    def of_ratio(self, found: float) -> str:
        """Reason that a ratio of measured to computed has, with the sign before it; empty for none."""
        if unit := of_unit(found, "the transmission error"):
            return unit
        for ratio in (self.ratio, 1.0 / self.ratio) if self.ratio else ():
            if abs(ratio - 1.0) > _AT_SHAFT and abs(found / ratio - 1.0) <= _AT_SHAFT:
                return f", the ratio of the teeth being {figures(ratio)}; check te_at"
        return ""


def orders_of_mate(found: MeasuredError, mate_teeth: int) -> bool:
    """Whether the mesh orders of a trace are those of the mating gear: its angle is that of the other shaft."""

    def largest(teeth: int, other: int) -> float:
        orders = [float(n * teeth) for n in range(1, _ORDERS + 1) if (n * teeth) % other]
        return max((_near(found, order) for order in orders), default=0.0)

    return found.spectrum.turns >= 1.0 and largest(mate_teeth, found.teeth) > _OF_MATE * largest(
        found.teeth, mate_teeth
    ) > 0.0  # fmt: skip


def counted(found: MeasuredError) -> str:
    """Whether an encoder counts twice or half, by the order of the mesh; empty where it does not."""
    if found.spectrum.turns < 2.0:
        return ""
    own, double, half = (_near(found, factor * found.teeth) for factor in (1.0, 2.0, 0.5))
    uneven = max(own, _near(found, 3.0 * found.teeth))
    beside = max(_near(found, 0.5 * found.teeth + off) for off in (-2.5, -1.5, 1.5, 2.5))
    if half > own and half > _OF_MATE * beside:
        return "twice"
    return "half" if double > _OF_MATE * uneven else ""


def _near(found: MeasuredError, order: float) -> float:
    """Amplitude at an order or at the lines beside it, which have a part of one between two lines [m]."""
    spectrum = found.spectrum
    if order > spectrum.order[-1]:
        return 0.0
    at = int(np.abs(spectrum.order - order).argmin())
    return float(spectrum.amplitude[max(at - 1, 0) : at + 2].max())
