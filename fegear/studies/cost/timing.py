"""Processor seconds of one core, honestly: one thread, repeated when short."""

from __future__ import annotations

import time
from statistics import median
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")

#: What takes less than this is done again, three times in all, and the median counts [s].
_SHORT = 0.1
_TIMES = 3


class Seconds(NamedTuple):
    """What some work took: processor seconds of this process, and seconds on the wall."""

    cpu: float
    wall: float

    def plus(self, other: Seconds) -> Seconds:
        """Both after one another."""
        return Seconds(self.cpu + other.cpu, self.wall + other.wall)


NOTHING = Seconds(0.0, 0.0)


def timed(work: Callable[[], T], *, repeat: bool = True) -> tuple[T, Seconds]:
    """Do some work and measure its seconds.

    Parameters
    ----------
    work : callable
        Must do everything anew each time it is called.
    repeat : bool
        Whether short work is done again for a median.
    """
    cpu, wall = [], []
    while True:
        started, clock = time.process_time(), time.perf_counter()
        found = work()
        cpu.append(time.process_time() - started)
        wall.append(time.perf_counter() - clock)
        if not repeat or cpu[0] > _SHORT or len(cpu) == _TIMES:
            return found, Seconds(median(cpu), median(wall))
