"""What errors of single teeth change in the load sharing, if those of neighbours are not alike.

`shifted_compliance` lets a whole flank be softer by its error; two tooth pairs that share the load are then softer
alike, and where their effects cancel nothing seems to change. True errors differ along the flank. Here each pair is off
by itself, to first order: the loaded pairs stay the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement, Loaded

#: Part of a tooth's error that another place of its flank need not have, for loads and for the transmission error;
#: random pairs (docs/numerics.md).
_OWN_PART, _ALONG_PART = 0.65, 0.4


class IndependentErrors(NamedTuple):
    """First-order changes by the part of the errors that one place of a flank has by itself.

    Attributes
    ----------
    load : ndarray, shape (n, P, L)
        Of the loads on the pairs [N]: root of the sum of squares over the pairs that are off.
    transmission_error : ndarray, shape (S, P, L)
        Of the transmission error [m], by each of S compliances, its error falling from its size at the start of the
        path through nothing to the opposite at the end.
    """

    load: Array
    transmission_error: Array


def independent_errors(loaded: Loaded, shifted: Sequence[Engagement], path: tuple[float, float]) -> IndependentErrors:
    """Linearise the load sharing about its solution.

    Parameters
    ----------
    loaded : Loaded
    shifted : sequence of Engagement
        The same with one compliance each off by its error.
    path : (float, float)
        Start and end of the path of contact [m].
    """
    matrices, contacts, w = loaded.grid.matrices, loaded.grid.contacts, loaded.loads
    on = w > 0.0
    n = on.shape[0]
    identity = np.eye(n)[:, :, None, None]
    system = np.moveaxis(np.where(on[:, None] & on[None], matrices.tangent(w), identity), (0, 1), (-2, -1))
    inverse = np.moveaxis(np.linalg.inv(system), (-2, -1), (0, 1)) * on[:, None] * on[None]
    approach = inverse.sum(axis=1)  # load of each pair per unit approach
    stiffness = approach.sum(axis=0)
    by_pair = approach[:, None] * approach[None] / stiffness - inverse  # dW_i/du_j
    middle, half = 0.5 * (path[0] + path[1]), 0.5 * (path[1] - path[0])
    along = np.clip((contacts.x - middle) / half, -1.0, 1.0)[:, :, None]
    here = matrices.at_load(w)
    squares, changes = np.zeros_like(w), []
    for other in shifted:
        there = other.matrices(contacts, loaded.cycle).at_load(w)
        deflection = np.einsum("ijpl,jpl->ipl", there - here, w)
        squares += ((by_pair * deflection[None]) ** 2).sum(axis=1)
        changes.append(_ALONG_PART * (approach * along * deflection).sum(axis=0) / stiffness)
    return IndependentErrors(_OWN_PART * np.sqrt(squares), np.array(changes))
