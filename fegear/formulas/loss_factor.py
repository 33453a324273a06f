"""Tooth loss factor H_V: mean power that a friction coefficient of 1 would take, over the power transmitted.

H_V = (1/r_b1 + 1/r_b2) / cos(beta_b) times the mean over a base pitch of sum(share |x|); 1/cos(beta_b) is the normal
force over that in the transverse section. What differs is the share of load at each place.

Sources: H. Ohlendorf, Verlustleistung und Erwärmung von Stirnrädern, thesis, TU München 1958; A. Wimmer, Lastverluste
von Stirnradverzahnungen, thesis, TU München 2006 (load even along all contact lines of rigid gears); ISO/TR
15144-1:2014, Formulae 91 and 92. As secondary sources carry them.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError
from fegear.formulas.flank_speeds import contact_ratios

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.geometry import GearPair

#: Gauss points between two changes of the contact lines.
_GAUSS = 12
#: An overlap ratio below this is that of a spur gear: the load per length has no limit of its own.
_SPUR = 1e-9


def _scale(pair: GearPair) -> float:
    """pi (1/z_1 + 1/z_2) / cos(beta_b)."""
    return math.pi * (1.0 / pair.driver.teeth + 1.0 / pair.driven.teeth) / math.cos(pair.driver.base_helix_angle)


def ohlendorf(pair: GearPair) -> float:
    """H_V = pi (1/z_1 + 1/z_2) / cos(beta_b) (1 - epsilon_alpha + epsilon_1^2 + epsilon_2^2).

    Two tooth pairs share alike and one bears all; exact for that with the pitch point in single contact.

    Raises
    ------
    RangeError
        Unless the contact ratio lies between 1 and 2.
    """
    one, two = contact_ratios(pair)
    if not 1.0 <= one + two <= 2.0:
        raise RangeError("contact ratio", f"{one + two:.4g}", "must lie between 1 and 2 for Ohlendorf's H_V")
    return _scale(pair) * (1.0 - one - two + one * one + two * two)


def overlapping(pair: GearPair) -> float:
    """H_V of contact lines of constant length (overlap ratio a whole number), evenly loaded.

    pi (1/z_1 + 1/z_2) / cos(beta_b) (epsilon_1^2 + epsilon_2^2) / epsilon_alpha; with epsilon_1 = epsilon_2 that of
    ISO/TR 15144-1, Formula 92.
    """
    one, two = contact_ratios(pair)
    return _scale(pair) * (one * one + two * two) / (one + two)


def wimmer(pair: GearPair) -> float:
    """H_V of rigid gears whose load is even along all contact lines that stand at a time, any contact ratio.

    Raises
    ------
    RangeError
        If the contact ratio is below 1: at times nothing would bear the load.
    """
    if pair.total_contact_ratio < 1.0 or pair.contact_ratio < 1.0:
        raise RangeError("contact ratio", f"{pair.contact_ratio:.4g}", "must be at least 1")
    pitch = pair.base_pitch
    start, end, half = pair.x_start / pitch, pair.x_end / pitch, 0.5 * pair.overlap_ratio
    changes = np.array([start - half, start + half, end - half, end + half, half, -half, 0.0])
    cuts = np.unique(np.concatenate([np.array([0.0, 1.0]), changes % 1.0]))
    node, weight = np.polynomial.legendre.leggauss(_GAUSS)
    numbers = np.arange(math.floor(start - half) - 1, math.ceil(end + half) + 2)
    total = 0.0
    for a, b in pairwise(cuts.tolist()):
        if b - a < 1e-12:
            continue
        middle = 0.5 * (a + b) + 0.5 * (b - a) * node
        total += 0.5 * (b - a) * float(weight @ _mean_distance(middle[:, None] + numbers, start, end, half))
    return 2.0 * _scale(pair) * total


def _mean_distance(at: Array, start: float, end: float, half: float) -> Array:
    """Mean of abs(x) over all contact lines whose middles are at these places, in base pitches, shape (places,)."""
    if half < _SPUR:
        on = (at >= start) & (at <= end)
        return np.asarray((np.abs(at) * on).sum(axis=1) / on.sum(axis=1))
    low, high = np.clip(at - half, start, end), np.clip(at + half, start, end)
    passed = 0.5 * (high * np.abs(high) - low * np.abs(low))
    return np.asarray(passed.sum(axis=1) / (high - low).sum(axis=1))


def computed(pair: GearPair, mean_of_share_times_distance: float) -> float:
    """H_V from the mean over a base pitch of sum(share abs(x)) [m], the shares being whatever was computed."""
    curvature = 1.0 / pair.driver.base_radius + 1.0 / pair.driven.base_radius
    return curvature * mean_of_share_times_distance / math.cos(pair.driver.base_helix_angle)
