"""Bearing contact: the ellipses that surface contact points spread into under load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError
from fegear.helical.curvature import ContactEllipse, contact_ellipse, parting
from fegear.helical.separation import Placement

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.arrays import Array
    from fegear.helical.pair import HelicalPair
    from fegear.helical.pair_contact import PairContact


@dataclass(frozen=True, slots=True)
class Bearing:
    """Contact ellipses along a path of contact.

    Parameters
    ----------
    index : ndarray of int, shape (m,)
        Positions of the contact that are surface contact with a defined place.
    ellipse : ContactEllipse
        Half axes, pressure and approach, arrays of shape (m,).
    long_axis, short_axis : ndarray, shape (3, m)
        Unit vectors of the axes in the fixed frame.
    """

    index: NDArray[np.int_]
    ellipse: ContactEllipse
    long_axis: Array
    short_axis: Array


def bearing_contact(pair: HelicalPair, contact: PairContact, load: float, modulus: float) -> Bearing:
    """Contact ellipses of one tooth pair that carries a load.

    Parameters
    ----------
    pair : HelicalPair
    contact : PairContact
        From `pair_contact`, or the ``mesh`` or ``single`` part of `tooth_contact`.
    load : float
        Normal force on the tooth pair [N].
    modulus : float
        E* [Pa], 1/E* the sum of (1 - nu^2)/E of both gears.

    Raises
    ------
    RangeError
        If no position is surface contact with a defined place: edges have no ellipse, lines none that ends.
    """
    index = np.flatnonzero((contact.kind == "surface") & ~contact.ill_defined)
    if index.size == 0:
        raise RangeError(
            "contact", "edges or lines only", "have no contact ellipse", "give the pinion's cutter a parabola"
        )
    p = Placement.of(pair)
    gap = parting(p, pair.flank, contact.phi_1[index], contact.s[index], contact.z1[index])
    return Bearing(index, contact_ellipse(gap.large, gap.small, load, modulus), gap.along, gap.across)
