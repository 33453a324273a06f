"""Single values of two runs beside each other."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.engine.outcome import Value


#: Share that the last digits of a processor may change of a number without an estimated error.
_ROUND_OFF = 1e-9


class Pairing(NamedTuple):
    """A value in both runs; None where a run has none."""

    name: str
    first: Value | None
    second: Value | None

    @property
    def both(self) -> tuple[Value, Value]:
        """The two values, where no run lacks it."""
        if self.first is None or self.second is None:
            raise LookupError(f"{self.name} is missing on one side")
        return self.first, self.second

    @property
    def change(self) -> float:
        """Second less first, in the first one's unit; not a number where one is missing."""
        if self.first is None or self.second is None or self.first.unit != self.second.unit:
            return math.nan
        return self.second.value - self.first.value

    @property
    def share(self) -> float:
        """The change over the larger of the two."""
        if self.change == 0.0 or self.first is None or self.second is None:
            return self.change
        return self.change / max(abs(self.first.value), abs(self.second.value))

    @property
    def within_errors(self) -> bool:
        """Whether the estimated errors of the two explain the change."""
        errors = [value.error or 0.0 for value in (self.first, self.second) if value is not None]
        return abs(self.change) <= sum(errors)

    @property
    def resolved(self) -> bool:
        """Whether the change exceeds the estimated errors of the two, and the round-off of numbers without one."""
        return abs(self.share) > _ROUND_OFF and not self.within_errors

    def differs(self, tolerance: float) -> bool:
        """Whether it is missing on one side, or changes by more than a share; no number twice is no change."""
        both = self.first is not None and self.second is not None
        if both and math.isnan(self.first.si) and math.isnan(self.second.si):  # type: ignore[union-attr]
            return False
        return not abs(self.share) <= tolerance


def paired(first: Mapping[str, Value], second: Mapping[str, Value]) -> tuple[Pairing, ...]:
    """Every value of either run, in the order of the first."""
    return tuple(Pairing(name, first.get(name), second.get(name)) for name in dict.fromkeys([*first, *second]))
