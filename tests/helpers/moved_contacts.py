"""What contacts that move along their flanks take off the approach: a second-order term that load sharing neglects.

Teeth soften toward their tips, so a loaded flank tilts; and the radius of an involute changes over the width of the
contact, so the gap beside it has a cubic part. Both move the load away from the place where it was aimed at. With s
along the flanks toward the driver's tip, the rigid flanks part by s^2 / 2R + B s^3 + G s^4, the deflections that all
loads W_j cause at pair i add T_i s, T_i = sum_j t_ij W_j, and contacts of half-width b, b^2 = 4 W R / (pi E*), have an
energy that is less by

    (W R / 2) (T^2 + 3/2 T B b^2 + 3/4 B^2 b^4) - W G b^4 / 8

per pair; its derivative by W_i is what pair i approaches less. t_ii is half the slope of the pair's own compliance.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement, Loaded
    from fegear.geometry.pair import GearPair

#: Half the distance over which slopes of compliances are taken [modules].
_STEP = 2.5e-3


def moved_less(load: Array, slope: Array, radius: Array, cubic: Array, quartic: Array, modulus: float) -> Array:
    """How much less pairs approach, shape (n,) [m].

    Parameters
    ----------
    load : ndarray, shape (n,)
        W per face width [N/m].
    slope : ndarray, shape (n, n)
        t_ij [1/N m].
    radius, cubic, quartic : ndarray, shape (n,)
        R [m], B [1/m^2], G [1/m^3].
    modulus : float
        E* [Pa].
    """
    tilt, square = slope @ load, 4.0 * load * radius / (math.pi * modulus)
    bent = cubic * square
    own = 0.5 * radius * (tilt * tilt + 3.0 * tilt * bent + 2.25 * bent * bent)
    return np.asarray(own + slope.T @ (0.5 * radius * load * (2.0 * tilt + 1.5 * bent)) - 0.375 * quartic * square**2)


def flank_gap(pair: GearPair, x: float) -> tuple[float, float, float]:
    """1/R, B and G of both rigid flanks at a place on the path of contact [m]."""
    curvature = cubic = quartic = 0.0
    for member, toward in zip(MEMBERS, (1.0, -1.0), strict=True):
        rho, rb = float(pair.flank_curvature_radius(x, member)), pair.gear(member).base_radius
        curvature += 1.0 / rho
        cubic -= toward * rb / (6.0 * rho * rho * abs(rho))
        quartic += rb * rb / (8.0 * rho**5)
    return curvature, cubic, quartic


def moved_contacts(engagement: Engagement, state: Loaded) -> Array:
    """How much less every pair approaches at the one position and load of a state, shape (n,) [m].

    Parameters
    ----------
    engagement : Engagement
        With finite-element compliances.
    state : Loaded
        Of pairs on the path of contact; zero where a pair is unloaded.
    """
    pair, at, step = engagement.pair, state.grid.contacts, _STEP * engagement.pair.driver.module
    load = state.loads[:, 0, 0] / pair.face_width
    slope, found = np.zeros((load.size, load.size)), np.zeros(load.size)
    on = np.flatnonzero(load > 0.0)
    gaps = np.zeros((3, load.size))
    for i in on:
        gaps[:, i] = flank_gap(pair, float(at.x[i, 0]))
        for member, ahead in zip(MEMBERS, (-1, 1), strict=True):
            source, rho = engagement.compliance.source(member), float(pair.flank_curvature_radius(at.x[i, 0], member))
            high, low = pair.radius(at.x[i, 0] + step, member), pair.radius(at.x[i, 0] - step, member)
            per_arc = pair.gear(member).base_radius / abs(rho) / (2.0 * step)
            for j in on:
                if i == j:
                    rise = 0.5 * (source.own(0, high) - source.own(0, low))
                else:
                    k, there = ahead * int(at.number[j] - at.number[i]), pair.radius(at.x[j, 0], member)
                    rise = source.between(k, 0, high, there) - source.between(k, 0, low, there)
                slope[i, j] += float(rise) * per_arc
    curvature, cubic, quartic = gaps[:, on]
    found[on] = moved_less(
        load[on], slope[np.ix_(on, on)], 1.0 / curvature, cubic, quartic, engagement.compliance.contact_modulus
    )
    return found
