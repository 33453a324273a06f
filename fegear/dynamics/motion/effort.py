"""How much integration a motion at one speed may take before it is given up: by work, not by the clock.

A limit in seconds would let the machine decide what a row says. Work is steps of the integration times coordinates of
the train: a period takes more steps at a low speed, and where meshes of several frequencies come together only after
many of their own.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from fegear.dynamics.motion.packed_model import Packed

#: Work of one speed: some 45,000 periods of a train of four bodies. (One with a damping ratio of 0.005 of its shafts
#: looks settled for 25,000 periods and ends at twice the force.)
EFFORT = 3_000_000
#: Work of a train one of whose vibrations would outlast EFFORT: no effort settles it, and this shows what it does.
ENDLESS_EFFORT = EFFORT // 8
#: Share of the effort between two reports of progress.
_REPORT = 0.01
#: Decay per unit of time, that of the fastest mode per radian, which round-off of the eigenvalues may leave.
_RESOLVED = 1e-13


class Effort:
    """What is spent of a limit, and who is told.

    Parameters
    ----------
    limit : int
        Steps times coordinates.
    progress : callable, optional
        Told the share that is spent, at most one.
    """

    def __init__(self, limit: int = EFFORT, progress: Callable[[float], None] | None = None) -> None:
        self.limit, self.spent, self.periods = limit, 0, 0
        self._progress, self._told = progress, 0.0

    def spend(self, work: int) -> None:
        """Count the work of one period."""
        self.spent += work
        self.periods += 1
        share = min(self.spent / self.limit, 1.0)
        if self._progress is not None and share >= self._told + _REPORT:
            self._told = share
            self._progress(share)

    @property
    def left(self) -> int:
        """Periods that what is left pays for, as those so far were; zero when all is spent."""
        each = max(self.spent / max(self.periods, 1), 1.0)
        return max(int((self.limit - self.spent) / each), 0)


def least_decay(packed: Packed) -> float:
    """Logarithm by which the least damped vibration dies away in a period, every mesh in contact at its mean stiffness.

    Zero if one has no damping; infinite if nothing vibrates.
    """
    rows = packed.approach[:, packed.free]
    free = np.ix_(packed.free, packed.free)
    K = packed.K[free] + rows.T @ (packed.stiffness[:, None] * rows)
    C = packed.C[free] + rows.T @ (packed.damping[:, None] * rows)
    n = K.shape[0]
    if n == 0:
        return math.inf
    first_order = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -C]])
    decay = -float(np.max(np.linalg.eigvals(first_order).real)) * packed.period
    return decay if decay > _RESOLVED * packed.period else 0.0


def effort_for(packed: Packed, work: int, progress: Callable[[float], None] | None) -> Effort:
    """Effort of a motion one of whose periods took so much work: little if its vibration would outlast any.

    Parameters
    ----------
    packed : Packed
        What moves.
    work : int
        Steps times coordinates of a period.
    progress : callable, optional
        Told the share that is spent.
    """
    endless = least_decay(packed) * EFFORT / max(work, 1) < 1.0
    return Effort(ENDLESS_EFFORT if endless else EFFORT, progress)


def of_one(progress: Callable[[float], None] | None, number: int, count: int) -> Callable[[float], None] | None:
    """Progress of one speed, after so many of a count, as that of them all."""
    return None if progress is None else lambda share: progress((number + share) / count)
