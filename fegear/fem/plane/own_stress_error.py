"""What of two differences is the error of a loaded tooth's own root stress; dimensionless.

Elements one order lower differ from those that count (what the order changes), and stress at the points of a fillet
scatters about the smooth curve along it (what few edges and their own curves leave). Either may be small by chance
where the error is not: they are errors that know nothing of each other, and the root of their sum of squares is stated.
Learned from 99 random gears and rings at tolerances from 0.1 to 1e-4 (docs/numerics.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side

#: Of what the order changes, of which the number of edges along a fillet has already left a share, so much is error,
#: times the root of that share and no more than so much: the shorter the edges, the less of it.
_OF_ORDER, _MOST_OF_ORDER = 0.93, 0.9
#: Of what scatters; more where edges are few, between these shares.
_OF_SCATTER, _OF_SCATTER_OF_FEW, _FEW = 0.55, 0.8, (0.7, 0.85)
#: The farther up the flank a contact, the less its pressure has to do with the fillet: at the end of the flank tension
#: errs by so much less of what the order changes and of what scatters where edges are rather long, from the first of
#: these shares on and wholly from the second. Where edges are fewer than the third, up to the fourth, it does not. It
#: goes with the square of the way: at half of it the error still is the whole one.
_LESS_ORDER_UP, _LESS_SCATTER_UP, _LONG = 0.65, 0.45, (0.36, 0.6, 0.75, 0.85)


def own_stress_error(
    side: Side, share: float, of_order: ArrayLike, of_scatter: ArrayLike, up: ArrayLike = 0.0
) -> Array:
    """Error of the largest stress of elements of fourth order, shape (P,).

    Parameters
    ----------
    side : {"tension", "compression"}
    share : float
        Part of what the order changes that so many edges leave, 0 to 1.
    of_order : array_like, shape (P,)
        That part.
    of_scatter : array_like, shape (P,)
    up : array_like, shape (P,)
        How far up the flank contacts are: 0 at its start, 1 at its end.
    """
    far = np.interp(share, _LONG, (0.0, 1.0, 1.0, 0.0)) * np.asarray(up) ** 2 * (side == "tension")
    order = min(_OF_ORDER * share**0.5, _MOST_OF_ORDER) * (1.0 - _LESS_ORDER_UP * far)
    scatter = np.interp(share, _FEW, (_OF_SCATTER, _OF_SCATTER_OF_FEW)) * (1.0 - _LESS_SCATTER_UP * far)
    return np.hypot(order * np.asarray(of_order), scatter * np.asarray(of_scatter))
