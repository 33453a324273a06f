"""The contact ellipse under load (Hertz), and the bearing contact that ellipses spread into over the flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown
from fegear.contact.unloaded.parting import parting
from fegear.contact.unloaded.placement import Placement

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.contact.unloaded.pair_contact import PairContact


@dataclass(frozen=True, slots=True)
class ContactEllipse:
    """Hertzian contact of two smooth bodies.

    Parameters
    ----------
    long, short : ndarray
        Half axes [m].
    pressure : ndarray
        Largest pressure [Pa].
    approach : ndarray
        Approach of the bodies [m].
    """

    long: Array = shown("mm", "half the long axis")
    short: Array = shown("mm", "half the short axis")
    pressure: Array = shown("MPa", "largest pressure")
    approach: Array = shown("um", "approach of the flanks")


def contact_ellipse(large: ArrayLike, small: ArrayLike, load: float, modulus: float) -> ContactEllipse:
    """Half axes, pressure and approach of an elliptical contact (Johnson, Contact Mechanics, 4.2).

    With m1 = (b/a)^2 and Legendre's D = (K - E)/e^2 the ratio of curvatures is (K - D)/(m1 D) and
    a^3 = 3 F D/(pi E* small): no difference cancels between the circle and the long ellipse.

    Parameters
    ----------
    large, small : array_like
        Principal relative curvatures [1/m], large >= small > 0.
    load : float
        F [N].
    modulus : float
        E* [Pa], 1/E* the sum of (1 - nu^2)/E of both bodies.

    Raises
    ------
    InputError
        If load, modulus or curvatures are not positive (line contact has no ellipse).
    """
    from scipy.special import ellipkm1, elliprd

    large, small = np.broadcast_arrays(np.asarray(large, dtype=float), np.asarray(small, dtype=float))
    if not (load > 0.0 and math.isfinite(load)):
        raise InputError("load", load, "must be positive and finite")
    if not (modulus > 0.0 and math.isfinite(modulus)):
        raise InputError("modulus", modulus, "must be positive and finite")
    if not (np.all(small > 0.0) and np.all(large >= small)):
        raise InputError("small", small, "must be positive and no larger than the large curvature")

    def ratio(log_m1: Array) -> tuple[Array, Array]:
        m1 = np.exp(log_m1)
        D = elliprd(0.0, m1, 1.0) / 3.0
        return (ellipkm1(m1) - D) / (m1 * D), D

    lo, hi = np.full(large.shape, -80.0), np.zeros(large.shape)
    for _ in range(64):
        middle = 0.5 * (lo + hi)
        longer = ratio(middle)[0] > large / small
        lo, hi = np.where(longer, middle, lo), np.where(longer, hi, middle)
    log_m1 = 0.5 * (lo + hi)
    D = ratio(log_m1)[1]
    a = np.cbrt(3.0 * load * D / (np.pi * modulus * small))
    b = a * np.exp(0.5 * log_m1)
    return ContactEllipse(
        a, b, 1.5 * load / (np.pi * a * b), 1.5 * load * ellipkm1(np.exp(log_m1)) / (np.pi * modulus * a)
    )


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
            "contact", "edge or line contact only", "has no contact ellipse", "specify a parabola for the pinion cutter"
        )
    p = Placement.of(pair)
    gap = parting(p, pair.flank, contact.phi_1[index], contact.s[index], contact.z1[index])
    return Bearing(index, contact_ellipse(gap.large, gap.small, load, modulus), gap.along, gap.across)
