"""The flanks that touch once the backlash is used up, where they differ from those that carry the load.

All is counted along the line of action of the working flanks, as the train's motion is: the same turn moves the contact
of the back flanks by cos(alpha_b) / cos(alpha) as far, so that their stiffness counts with the square of that. They are
in contact elsewhere: the back flank of a tooth passes the pitch point by the tooth's thickness on the pitch circle, and
half the backlash, after its working flank.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.dynamics.train.periodic import Periodic, combine

if TYPE_CHECKING:
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class BackFlanks:
    """What the back flanks of a gear pair are to its motion.

    Parameters
    ----------
    stiffness : Periodic
        Mesh stiffness over the position of their own contact, along the line of action of the working flanks [N/m].
    shift : float
        By how much their position is ahead of that of the working flanks [base pitches].
    """

    stiffness: Periodic
    shift: float = 0.0

    @property
    def even(self) -> BackFlanks:
        """The same with the mean stiffness at all positions: the reverse of the mean compliance."""
        mean = combine((self.stiffness,), lambda k: 1.0 / k).mean
        return BackFlanks(Periodic.constant(1.0 / mean), self.shift)


def leverage(pair: GearPair) -> float:
    """cos(alpha_b) / cos(alpha) of the working pressure angles: ways along the lines of action for one turn."""
    return math.cos(pair.from_the_back.working_pressure_angle) / math.cos(pair.working_pressure_angle)


def back_flanks(pair: GearPair, stiffness: Periodic) -> BackFlanks:
    """Back flanks of a pair from the mesh stiffness of these flanks, loaded on their own.

    Parameters
    ----------
    pair : GearPair
        As it runs, seen from the working flanks.
    stiffness : Periodic
        Of the back flanks, which the driven gear loads, along their line of action over x toward its tip [N/m].
    """
    driver = pair.driver
    radius = driver.base_radius / math.cos(pair.working_pressure_angle)
    thickness = float(driver.tooth.thickness_angle(radius / driver.module))
    room = max(pair.circumferential_backlash, 0.0) / radius
    shift = -(thickness + 0.5 * room) / driver.angular_pitch
    return BackFlanks(stiffness.scaled(leverage(pair) ** 2), shift)
