"""What gauges come to before there is a trace: their peaks, and how much each changes with the place of its grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from fegear.base.printed import figures, in_words, percent

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array

#: Changes below this are none.
_NOTHING = 5e-4


@dataclass(frozen=True)
class PlannedGauge:
    """A gauge without a trace.

    Parameters
    ----------
    name : str
    peak : float
        Computed strain.
    displacement, change : ndarray, shape (G,)
        Of its grid towards the tip [m], and of the peak there, relative.
    """

    name: str
    peak: float
    displacement: Array
    change: Array

    @classmethod
    def of(cls, name: str, peak: float, displacement: Array, peaks: Array) -> Self:
        """From the peaks at all places, of which the peak is that at zero."""
        return cls(name, peak, displacement, peaks / peak - 1.0)

    @property
    def largest(self) -> float:
        """Largest change, signed."""
        return float(self.change[np.abs(self.change).argmax()])

    @property
    def by_placement(self) -> str:
        """How the peak changes within the tolerance, a clause; empty without one."""
        ends = sorted({int(self.change.argmin()), int(self.change.argmax())}, key=lambda i: self.change[i])
        said = [
            f"{percent(float(self.change[i]), signed=True)} ({self._where(i)})" for i in ends
            if abs(self.change[i]) > _NOTHING
        ]  # fmt: skip
        return " to ".join(said)

    @property
    def at_largest(self) -> str:
        """The largest change and where."""
        i = int(np.abs(self.change).argmax())
        return f"{percent(self.largest, signed=True)} ({self._where(i)})"

    def _where(self, i: int) -> str:
        place = float(self.displacement[i])
        return f"{figures(abs(place) * 1e3, 2)} mm towards the {'tip' if place > 0.0 else 'root'}"


def of_planned_gauges(gauges: Sequence[PlannedGauge]) -> str:
    """Sentence about all gauges: range of their peaks, and the one whose place counts most; empty for one."""
    if len(gauges) < 2:
        return ""
    low, high = (end(gauges, key=lambda one: one.peak) for end in (min, max))
    said = (
        f"{in_words(len(gauges)).capitalize()} gauges, computed peak strain {figures(low.peak * 1e6, 4)} µm/m "
        f"({low.name}) to {figures(high.peak * 1e6, 4)} µm/m ({high.name})"
    )
    worst = max(gauges, key=lambda one: abs(one.largest))
    if abs(worst.largest) <= _NOTHING:
        return f"{said}."
    least = min(gauges, key=lambda one: abs(one.largest))
    return (
        f"{said}; displaced within its tolerance {worst.name} changes most, by up to {worst.at_largest}, {least.name} "
        f"least, by up to {percent(abs(least.largest))}."
    )
