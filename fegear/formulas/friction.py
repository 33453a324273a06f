"""Mean friction coefficients of gear teeth from load, speed, curvature, oil and roughness.

Sources: L. Schlenk, Untersuchungen zur Fresstragfähigkeit von Großzahnrädern, thesis, TU München 1994, as ISO/TR
14179-2:2001 carries it; ISO/TR 13989-1:2000, Eqs. 25 to 28 (now ISO/TS 6336-20); ISO/TR 13989-2:2000, Eqs. 1 to 7 (now
ISO/TS 6336-21); ISO/TR 15144-1:2014, Formulae 86 and 87 (now ISO/TS 6336-22). All are of one form,

    mu = c (w / (v_Sigma rho))^0.2 eta^-0.05 X_L X_R,  w in N/mm, v in m/s, rho in mm, eta in mPa s, R_a in um,

and known here from secondary sources. Of X_R in Eq. 28 these carry the square root and the fourth root of R_a; the
square root is taken, which a printed report of another program has.

Tooth loss factor H_V: mean power that a friction coefficient of 1 would take, over the power transmitted.

H_V = (1/r_b1 + 1/r_b2) / cos(beta_b) times the mean over a base pitch of sum(share |x|); 1/cos(beta_b) is the normal
force over that in the transverse section. What differs is the share of load at each place.

Sources: H. Ohlendorf, Verlustleistung und Erwärmung von Stirnrädern, thesis, TU München 1958; A. Wimmer, Lastverluste
von Stirnradverzahnungen, thesis, TU München 2006 (load even along all contact lines of rigid gears); ISO/TR
15144-1:2014, Formulae 91 and 92. As secondary sources carry them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.geometry.pair import GearPair

if TYPE_CHECKING:
    from fegear.formulas.lubricant import Oil


MeanLaw = Literal["schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22"]


MEAN_LAWS: tuple[MeanLaw, ...] = ("schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22")


#: Parts -20 and -21 take no higher pitch line speed [m/s], and -21 no smaller load [N/m].
FASTEST, LEAST_LOAD = 50.0, 150e3


#: No law is held to hold beyond this coefficient: dry steel.
LARGEST = 0.5


@dataclass(frozen=True)
class Surface:
    """What a friction law asks of oil and flanks.

    Parameters
    ----------
    oil : Oil
    temperature : float
        Of the oil [degC].
    roughness : float
        R_a, arithmetic mean of both flanks [m].
    """

    oil: Oil
    temperature: float
    roughness: float

    def __post_init__(self) -> None:
        """Refuse flanks without roughness, for which the formulas give no friction at all."""
        if not self.roughness > 0.0:
            raise RangeError("roughness", f"{self.roughness:.4g} m", "must be positive")

    @property
    def thickness(self) -> float:
        """eta_oil^-0.05 with the dynamic viscosity in mPa s."""
        return float(self.oil.dynamic(self.temperature) * 1e3) ** -0.05


def helical_load_factor(total_contact_ratio: float) -> float:
    """K_Bgamma by the total contact ratio: 1 up to 2, 1.3 from 3.5 on (ISO/TR 13989-2, Eq. 5)."""
    if total_contact_ratio <= 2.0:
        return 1.0
    if total_contact_ratio >= 3.5:
        return 1.3
    return 1.0 + 0.2 * float(np.sqrt((total_contact_ratio - 2.0) * (5.0 - total_contact_ratio)))


def law_load(law: MeanLaw, pair: GearPair, line_load: ArrayLike) -> Array:
    """Load per face width that a law is stated for [N/m].

    Parameters
    ----------
    law : {"schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22"}
    pair : GearPair
    line_load : array_like
        w = F_bt / b along the line of action, with the load factors that count [N/m].

    Returns
    -------
    ndarray
        w for Schlenk; the tangential w_Bt = w cos(alpha_t) for -20; at least 150 N/mm of it times K_Bgamma for -21;
        w K_Bgamma for -22. No load stays none.
    """
    w = np.asarray(line_load, dtype=float)
    if law in ("iso-6336-20", "iso-6336-21"):
        w = pair.tangential_load(1.0) * w
    if law == "iso-6336-21":
        w = np.where(w > 0.0, np.maximum(w, LEAST_LOAD), 0.0)
    crowded = helical_load_factor(pair.total_contact_ratio) if law in ("iso-6336-21", "iso-6336-22") else 1.0
    return np.asarray(crowded * w)


def mean_friction(law: MeanLaw, surface: Surface, load: ArrayLike, rolling: ArrayLike, radius: ArrayLike) -> Array:
    """Friction coefficient by one of the mean laws; with local arguments it is taken at every point.

    Parameters
    ----------
    law : {"schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22"}
    surface : Surface
    load : array_like
        Load per face width that the law is stated for [N/m], see `law_load`: F_bt / b or F_t / b, and factors of its
        own; none, no friction.
    rolling : array_like
        v_Sigma, sum of both flanks' tangential speeds [m/s].
    radius : array_like
        rho_n, relative radius of curvature in the normal section [m]; of the transverse section for -20.

    Returns
    -------
    ndarray
        At most 0.5, that of dry steel: where radius or speed go to zero the laws have no bound.
    """
    tiny = np.finfo(float).tiny
    w = np.maximum(np.asarray(load, dtype=float), 0.0) * 1e-3
    v, rho = np.asarray(rolling, dtype=float), np.asarray(radius, dtype=float) * 1e3
    ra = surface.roughness * 1e6
    x_l: Array = np.asarray(surface.oil.factor)
    if law == "schlenk":
        factor, x_r = 0.048, np.asarray(ra**0.25)
        if surface.oil.kind in ("polyglycol", "water-soluble-polyglycol"):
            x_l = 0.75 * (6.0 / np.maximum(v, tiny)) ** 0.2
    elif law == "iso-6336-20":
        factor, x_r = 0.060, np.asarray(ra**0.5)
    else:
        factor, x_r = 0.045, 2.2 * (ra / np.maximum(rho, tiny)) ** 0.25
    with np.errstate(over="ignore", divide="ignore"):
        mu = factor * (w / np.maximum(v * rho, tiny)) ** 0.2 * surface.thickness * x_l * x_r
    return np.asarray(np.minimum(np.where(w > 0.0, mu, 0.0), LARGEST))


#: Gauss points between two changes of the contact lines.
_GAUSS = 12


#: An overlap ratio below this is that of a spur gear: the load per length has no limit of its own.
_SPUR = 1e-9


def teeth_factor(pair: GearPair) -> float:
    """pi (1/z_1 + 1/z_2) / cos(beta_b), of an internal pair with the difference."""
    sum_ = abs(1.0 / pair.driver.teeth + pair.side / pair.driven.teeth)
    return math.pi * sum_ / math.cos(pair.driver.base_helix_angle)


def contact_ratios(pair: GearPair) -> tuple[float, float]:
    """epsilon_1 and epsilon_2: contact ratio from the pitch point to the tips of driver and driven gear."""
    return pair.x_end / pair.base_pitch, -pair.x_start / pair.base_pitch


def ohlendorf(pair: GearPair) -> float:
    """H_V = pi (1/z_1 + 1/z_2) / cos(beta_b) (1 - epsilon_alpha + epsilon_1^2 + epsilon_2^2).

    Two tooth pairs share alike and one bears all; exact for that with the pitch point in single contact.

    Raises
    ------
    RangeError
        Unless the contact ratio lies between 1 and 2, and the path holds the pitch point.
    """
    one, two = contact_ratios(pair)
    if min(one, two) < 0.0:
        raise RangeError("path of contact", "(not containing the pitch point)", "is not covered by H_V of Ohlendorf")
    if not 1.0 <= one + two <= 2.0:
        raise RangeError("contact ratio", f"{one + two:.4g}", "must be between 1 and 2 for Ohlendorf's H_V")
    return teeth_factor(pair) * (1.0 - one - two + one * one + two * two)


def overlapping(pair: GearPair) -> float:
    """H_V of contact lines of constant length (overlap ratio a whole number), evenly loaded.

    pi (1/z_1 + 1/z_2) / cos(beta_b) (epsilon_1^2 + epsilon_2^2) / epsilon_alpha; with epsilon_1 = epsilon_2 that of
    ISO/TR 15144-1, Formula 92.
    """
    one, two = contact_ratios(pair)
    return teeth_factor(pair) * (one * one + two * two) / (one + two)


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
    return 2.0 * teeth_factor(pair) * total


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
    sliding = abs(1.0 / pair.driver.base_radius + pair.side / pair.driven.base_radius)  # over x and the driver's speed
    return sliding * mean_of_share_times_distance / math.cos(pair.driver.base_helix_angle)
