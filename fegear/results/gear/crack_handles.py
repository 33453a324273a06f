"""A straight crack whose tip is moved: what its length is as a share of the way through the tooth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from fegear.case.reading import Scene

#: A share is less than the whole way.
_MOST = 0.9999


def share_of_way(scene: Scene, gear: str, place: int, length: float, angle: float) -> float | None:
    """Length of a crack as a share of the way through the tooth in its direction; None where there is no such way.

    Parameters
    ----------
    scene : Scene
        With the crack as it was.
    gear : str
    place : int
        Which of the gear's `odd_tooth` has it.
    length : float
        [m].
    angle : float
        To the tooth's centre line [rad].
    """
    from fegear.case.built.odd_teeth import crack_of
    from fegear.fem.plane.odd.crack import fillet_point, way_through

    part, made = scene.case.gear[gear].odd_tooth[place].crack, scene.gears[gear]
    if part is None:
        return None
    tooth = made.symmetric_tooth
    crack = crack_of(made, part, f"gear.{gear}.odd_tooth[{place}].crack")
    way = np.array([(1.0 if crack.back else -1.0) * math.sin(angle), -tooth.side * math.cos(angle)])
    try:
        through = way_through(tooth, fillet_point(tooth, crack.mouth, back=crack.back), way)
    except InputError:
        return None
    return min(length / made.module / through, _MOST)
