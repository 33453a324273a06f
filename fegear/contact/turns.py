"""Turns along a trace, whose angle goes on from turn to turn or begins at zero with each."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Turns from which on an angle is one that goes on, and is taken as it is.
_GOES_ON = 1.1
_TURN = 2.0 * math.pi


def going_on(angle: Array) -> Array:
    """Angle of a trace that goes on from turn to turn, also where each turn begins at zero [rad]."""
    return angle if float(np.ptp(angle)) > _GOES_ON * _TURN else np.unwrap(angle)


def turns_along(angle: Array) -> Array:
    """Turns of each sample of a trace from its first one, ascending along it, also where each turn begins at zero."""
    going = going_on(angle)
    return np.asarray((going - going[0]) / (_TURN if going[-1] >= going[0] else -_TURN))
