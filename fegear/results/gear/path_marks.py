"""The line of action as abscissa, and the points A to E of the path of contact as marks of it or of a roll angle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.engine.figure.axis import Axis

if TYPE_CHECKING:
    from fegear.engine.figure.items import Mark
    from fegear.geometry.pair import GearPair, Member

#: Abscissa of everything that is followed along the path of contact.
LINE_OF_ACTION = Axis("position on the line of action from the pitch point", "mm")


def path_marks(pair: GearPair) -> tuple[Mark, ...]:
    """The points A to E of the path of contact as marks of an abscissa in millimetres."""
    from fegear.engine.figure.items import Mark
    from fegear.geometry.path_of_contact import path_points

    return tuple(Mark("x", point.x * 1e3, point.letter) for point in path_points(pair))


def roll_marks(pair: GearPair, member: Member) -> tuple[Mark, ...]:
    """The same points as marks of a gear's roll angle in degrees."""
    from fegear.engine.figure.items import Mark
    from fegear.geometry.path_of_contact import path_points

    return tuple(
        Mark("x", math.degrees(float(pair.roll_angle(point.x, member))), point.letter) for point in path_points(pair)
    )
