"""Root stress over the mesh of arrays of pairs: what to call."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.contact.many import kernel
from fegear.contact.many.many_load_sharing import compiled, placed, tables_of
from fegear.fem.plane.root_stress import smooth_curve

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.many.arrays import ManyEngagements

#: Points that the smooth curve at a point of the fillet is fitted to.
_FITTED = 10


@dataclass(frozen=True, eq=False)
class ManyFillets(ReadOnlyArrays):
    """Stress along the fillets of both gears of each pair.

    Parameters
    ----------
    stress : ndarray, shape (2, N, 2, 2 K + 1, C, P)
        Per unit line load and of module 1, by gear, fillet (tension, compression), tooth -K to K from the loaded one,
        contact over the flank and point along the fillet; tension of the loaded tooth itself is that under a force.
    length, nearest : ndarray, shape (2, N)
        Of a fillet, and how near to the flank's start contacts press [modules].
    contacts : ndarray, shape (C,)
        Shares of the flank's roll length, ascending from 0 to 1.
    points : ndarray, shape (P,)
        Shares of the fillet's length from the root land on, ascending.
    """

    stress: Array
    length: Array
    nearest: Array
    contacts: Array
    points: Array


class ManyRootStress(NamedTuple):
    """Root stress of the teeth of both gears over the mesh, shape (2, N, L) [Pa]; NaN where a pair has none.

    Attributes
    ----------
    tension, compression : ndarray
        Largest, and most negative, of the mesh.
    tension_range : ndarray
        Largest less least root tension, from a base pitch before the tooth's contact to one after it.
    """

    tension: Array
    compression: Array
    tension_range: Array


class ManyStressHistories(NamedTuple):
    """Root stress of each tooth in reach at roll positions.

    Attributes
    ----------
    stress : ndarray, shape (2, N, 2, teeth, P)
        By gear and fillet (tension, compression): largest tension and most negative compression [Pa]; NaN farther than
        a base pitch from the path.
    first : ndarray of int, shape (N,)
        Number of the pair of the first tooth.
    """

    stress: Array
    first: NDArray[np.int64]


def root_stresses(
    engagements: ManyEngagements, fillets: ManyFillets, loads: ArrayLike, *, samples: int = 24, followed: bool = False
) -> ManyRootStress:
    """Largest root stresses of each pair under each load, over the mesh.

    Parameters
    ----------
    engagements : ManyEngagements
    fillets : ManyFillets
        Of the same pairs.
    loads : array_like, shape (N, L) or (L,)
        Along the line of action [N].
    samples : int
        Positions over a base pitch; where contact comes or goes, and the peaks between them, are added.
    followed : bool
        Whether positions and peaks are those of each pair alone, as of `contact.plane.tooth_stress` (64 samples there):
        the same numbers, in some ten times the time.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    count, given = engagements.module.size, np.asarray(loads, dtype=float)
    each = np.ascontiguousarray(np.broadcast_to(given, (count, given.shape[-1])))
    out = np.empty((count, each.shape[1], 2, 3))
    compiled()["followed_stresses" if followed else "root_stresses"](
        engagements.numbers, *tables_of(engagements), engagements.corner_contact, each, samples, *_along(fillets), out
    )
    return ManyRootStress(*(np.moveaxis(out[..., i], 2, 0) for i in range(3)))


def root_stress_at(
    engagements: ManyEngagements, fillets: ManyFillets, load: ArrayLike, at: ArrayLike
) -> ManyStressHistories:
    """Root stress of every tooth in reach at roll positions.

    Parameters
    ----------
    engagements : ManyEngagements
    fillets : ManyFillets
        Of the same pairs.
    load : array_like, shape (N,) or ()
        [N].
    at : array_like, shape (P,)
        From the start of the path [base pitches], 0 to 1.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    n, (each, x) = engagements.numbers, placed(engagements, load, at)
    out, first = np.empty((n.shape[0], 2, 2, kernel.MOST + 2, x.shape[1])), np.zeros(n.shape[0], dtype=np.int64)
    compiled()["root_stress_at"](
        n, *tables_of(engagements), engagements.corner_contact, each, x, *_along(fillets), out, first
    )
    return ManyStressHistories(np.moveaxis(out, 1, 0), first - 1)


def _along(fillets: ManyFillets) -> tuple[Array, ...]:
    """Tables of the fillets and of the smooth curve along them."""
    stress1, stress2 = (np.ascontiguousarray(one, dtype=float) for one in fillets.stress)
    points = np.ascontiguousarray(fillets.points)
    # of one type for numba, whatever they were
    length, nearest = (np.array(one.T, dtype=float, order="C") for one in (fillets.length, fillets.nearest))
    return stress1, stress2, length, nearest, np.ascontiguousarray(fillets.contacts), points, *_fitted(points.tobytes())


@lru_cache(maxsize=4)
def _fitted(points: bytes) -> tuple[Array, Array]:
    """Weights of the points about each for the height and the slope of the smooth curve there, shape (P, 10)."""
    at = np.frombuffer(points)
    first = np.clip(np.arange(at.size) - _FITTED // 2, 0, at.size - _FITTED)
    column = first[:, None] + np.arange(_FITTED)
    height, slope = (np.take_along_axis(one.toarray(), column, axis=1) for one in smooth_curve(at))
    return np.ascontiguousarray(height), np.ascontiguousarray(slope)
