"""How long a computation still takes: what its steps are predicted to take, at the pace of those that are done."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

#: A step that took less says nothing of the pace [s]; until more has gone by than this the pace is half a guess [s].
_SHORT, _GUESSED = 0.2, 2.0
#: A step that has come less far says nothing of its own end yet.
_LITTLE = 0.05


class TimeLeft:
    """Seconds left of steps that are done one after the other.

    Parameters
    ----------
    predicted : sequence of float or None
        Seconds of every step on a machine of another pace; None where nothing is known.
    """

    def __init__(self, predicted: Sequence[float | None]) -> None:
        self._predicted = [math.nan if one is None else max(one, 0.0) for one in predicted]
        self._step = 0
        self._begun = time.monotonic()
        self._foretold = self._taken = _GUESSED

    def begin(self, step: int) -> None:
        """Note that a step, counted from one, begins."""
        self._step, self._begun = step, time.monotonic()

    def end(self, seconds: float) -> None:
        """Note what it took, which shows how fast this machine is; what was recalled took nothing."""
        predicted = self._of_present
        if seconds > _SHORT and predicted > _SHORT:
            self._foretold += predicted
            self._taken += seconds

    def left(self, fraction: float = 0.0) -> float | None:
        """Seconds left where the present step is done to a fraction; None where too little is known to say."""
        pace, took = self._taken / self._foretold, time.monotonic() - self._begun
        own = max(pace * self._of_present - took, 0.0)
        if _LITTLE < fraction <= 1.0 and took > _SHORT:
            own = took * (1.0 - fraction) / fraction
        left = own + pace * sum(self._predicted[self._step :])
        return left if math.isfinite(left) else None

    @property
    def _of_present(self) -> float:
        return self._predicted[self._step - 1] if 0 < self._step <= len(self._predicted) else math.nan
