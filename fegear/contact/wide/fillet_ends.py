"""How far up a fillet stress is root stress: less where a contact line presses near its foot.

Beside a contact stress is what the contact itself leaves, which no root stress is. A line on the path along which the
flanks are apart presses nothing and hides nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array


class LineOnTooth(NamedTuple):
    """A contact line, and the tooth that it lies on.

    Attributes
    ----------
    tooth : int
    position : int
        Of the roll positions.
    stations : slice
        Of the line, among those of its roll position.
    zeta : ndarray, shape (n,)
        Where along the face they stand [modules].
    beyond : (float, float)
        How far along the face the contact reaches beyond the first and the last of them [modules].
    end : ndarray, shape (n,)
        How far up the fillet stress is root stress below each of them [modules].
    """

    tooth: int
    position: int
    stations: slice
    zeta: Array
    beyond: tuple[float, float]
    end: Array


@dataclass(frozen=True)
class FilletEnds:
    """Ends of the fillets of T teeth.

    Parameters
    ----------
    length : float
        Of a fillet [modules].
    teeth : int
        T.
    lines : tuple of LineOnTooth
    """

    length: float
    teeth: int
    lines: tuple[LineOnTooth, ...]

    def at(self, zeta: Array, force: Array) -> Array:
        """At places along the face under forces on the stations, shape (Z, T) [modules].

        Parameters
        ----------
        zeta : ndarray, shape (Z,)
            [modules].
        force : ndarray, shape (P, M)
            At all roll positions [N]; a station's force reaches as far as the stations beside it.
        """
        found = np.full((zeta.size, self.teeth), self.length)
        for one in self.lines:
            presses = force[one.position, one.stations] > 0.0
            if not presses.any():
                continue
            beside = presses.copy()
            beside[1:] |= presses[:-1]
            beside[:-1] |= presses[1:]
            near = (zeta > one.zeta[0] - one.beyond[0]) & (zeta < one.zeta[-1] + one.beyond[1])
            found[near, one.tooth] = np.interp(zeta[near], one.zeta, np.where(beside, one.end, self.length))
        return found
