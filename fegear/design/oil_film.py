"""The layer of oil between loaded flanks, half of which each relief makes up for (Mark, after Eq. 4.6).

A film that is equally thick everywhere only turns the gears a little; one that thins along the path is an error of the
transmission, which the relief takes back where the film's thickness is known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.contact.plane.engagement import Engagement
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.relief import Relief


@dataclass(frozen=True)
class OilFilm:
    """Thickness of the film at the design load over the path of contact: straight between places, level beyond.

    Parameters
    ----------
    x : tuple of float
        Places on the line of action, rising [m].
    thickness : tuple of float
        There, of the whole film [m].
    """

    x: tuple[float, ...]
    thickness: tuple[float, ...]

    def half(self, x: ArrayLike) -> Array:
        """What each flank's relief makes up for at x [m]."""
        return np.asarray(0.5 * np.interp(np.asarray(x, dtype=float), self.x, self.thickness))

    def between(self, engagement: Engagement) -> Engagement:
        """The pair with the film between its flanks, which it holds apart as if they were so much thicker."""
        pair, e = engagement.pair, engagement
        return replace(
            e, driver_relief=Coated(e.driver_relief, self, pair, "driver"),
            driven_relief=Coated(e.driven_relief, self, pair, "driven"),
        )  # fmt: skip


@dataclass(frozen=True)
class Coated:
    """A flank's relief less its half of the film, as contact meets it.

    Parameters
    ----------
    relief : Relief
    film : OilFilm
    pair : GearPair
    member : {"driver", "driven"}
    """

    relief: Relief
    film: OilFilm
    pair: GearPair
    member: Member

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angles of the relief's and of the film's places."""
        places = (float(self.pair.roll_angle(x, self.member)) for x in self.film.x)
        return tuple(sorted({*self.relief.kinks, *places}))

    def removal(self, roll: ArrayLike) -> Array:
        """Removal less half the film at roll angles [m]."""
        return np.asarray(self.relief.removal(roll) - self.film.half(self.pair.x_of_roll(roll, self.member)))
