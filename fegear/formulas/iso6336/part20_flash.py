"""ISO/TS 6336-20: scuffing by the flash temperature method.

Source: ISO/TR 13989-1:2000, Calculation of scuffing load capacity - Part 1: Flash temperature method, from which ISO/TS
6336-20 was made; clauses and equations are numbered as there, and known here from secondary sources. External
gears, and internal ones with signed radii of curvature; unmodified profiles: a relief counts in the approach factor,
and in the computed load sharing besides the standard's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.formulas.flash_temperature import flash_temperature
from fegear.formulas.friction import FASTEST, law_load, mean_friction
from fegear.formulas.iso6336.rated import RatedSurface
from fegear.geometry.pair import GearPair

#: Share of the mean flash temperature by which the teeth are warmer than the oil (Eq. 22).
_BULK = 0.47
#: Scuffing temperature: 80 degC + (0.85 + 1.4 X_W) X_L S_FZG^2 (Eq. 99).
_TEST_OIL, _BASE, _BY_STRUCTURE = 80.0, 0.85, 1.4
#: Approach factor: one per 50 um of missing relief (Eqs. 46 and 48) [m].
_APPROACH = 50e-6
#: Positions over which the mean flash temperature is taken.
_POSITIONS = 401


@dataclass(frozen=True)
class FlashTemperatures:
    """Temperatures at places x [m] along the path of contact, with X_Gamma and X_J there."""

    x: Array
    load_sharing: Array
    approach: Array
    flash: Array = shown("K", "ISO/TS 6336-20, flash temperature", name="flash_temperature_iso")
    contact: Array = shown("degC", "ISO/TS 6336-20", name="contact_temperature_iso")
    friction: float = shown("", "mu_m")
    mean_flash: float = shown("K", "mean flash temperature")
    bulk: float = shown("degC", "bulk temperature Theta_M")
    largest: float = shown("degC", "ISO/TS 6336-20", name="largest_contact_temperature_iso")
    optimal_relief: float = shown("um", "C_eff")


def load_sharing_factor(pair: GearPair, x: ArrayLike, grade: int = 6) -> Array:
    """X_Gamma of unmodified profiles (clause 9, Eqs. 49 to 60 and 76).

    (Q - 2)/15 at A and E, a third more beside B and D, 1 between them, with Q the tolerance class, at least 7: 1/3 and
    2/3 of fine gears, as in ISO/TR 15144-1 and, recalled, in AGMA 925-A03, Eqs. 45 to 47 (one program: 1 at B).
    Helical pairs with epsilon_gamma above 2 have 1/epsilon_alpha; helical teeth count the buttressing of their ends
    besides. A transverse contact ratio of 2 or more lies outside the clause: 1 everywhere, on the safe side.

    Parameters
    ----------
    pair : GearPair
    x : array_like
        [m].
    grade : int
    """
    place = np.asarray(x, dtype=float)
    buttress = buttressing(pair, place)
    if pair.driver.helix_angle != 0.0 and pair.total_contact_ratio > 2.0:
        return buttress / pair.contact_ratio
    share = np.where((place < pair.x_start) | (place > pair.x_end), 0.0, spur_sharing(pair, place, grade))
    return np.asarray(share * buttress)


def spur_sharing(pair: GearPair, x: ArrayLike, grade: int = 6) -> Array:
    """Share of the load of unmodified spur teeth, as parts 20 and 22 take it; arguments as `load_sharing_factor`."""
    place, start, end = np.asarray(x, dtype=float), pair.x_start, pair.x_end
    if pair.contact_ratio >= 2.0:
        return np.ones_like(place)
    first, last = end - pair.base_pitch, start + pair.base_pitch
    least, tiny = (max(grade, 7) - 2.0) / 15.0, np.finfo(float).tiny
    rising = least + (place - start) / max(first - start, tiny) / 3.0
    falling = least + (end - place) / max(end - last, tiny) / 3.0
    return np.asarray(np.where(place < first, rising, np.where(place > last, falling, 1.0)))


def buttressing(pair: GearPair, x: Array) -> Array:
    """X_but (Eqs. 49 to 56): the ends of helical teeth bear up to 1.3 times more; 1 for spur teeth."""
    if pair.driver.helix_angle == 0.0:
        return np.ones_like(x)
    pinion = min((pair.driver, pair.driven), key=lambda gear: gear.teeth)
    unit = pinion.base_radius * math.tan(pair.working_pressure_angle)
    width = 0.2 * math.sin(abs(pair.driver.base_helix_angle)) * unit
    peak = 1.3 if pair.overlap_ratio >= 1.0 else 1.0 + 0.3 * pair.overlap_ratio
    at_start = peak - (x - pair.x_start) / width * (peak - 1.0)
    at_end = peak - (pair.x_end - x) / width * (peak - 1.0)
    return np.asarray(np.maximum(1.0, np.maximum(np.minimum(at_start, peak), np.minimum(at_end, peak))))


def approach_factor(rated: RatedSurface, x: ArrayLike) -> Array:
    """X_J, shock at the start of engagement: 1 + (C_eff - C_a) / 50 um (x / g_alpha)^3 before C (Eqs. 45 to 48)."""
    place = np.asarray(x, dtype=float)
    missing = (rated.optimal_relief - rated.tip_relief[1]) / _APPROACH
    before = np.clip(-place / rated.pair.path_length, 0.0, None)
    return np.asarray(np.maximum(1.0, 1.0 + missing * before**3))


def friction(rated: RatedSurface) -> float:
    """mu_m = 0.060 (w_Bt / (v_SigmaC rho_relC))^0.2 X_L X_R (Eqs. 25 to 28)."""
    angle = rated.pair.working_pressure_angle
    rolling = 2.0 * min(rated.pitch_line_speed, FASTEST) * math.sin(angle)
    radius = float(rated.at(0.0).relative_radius) * math.cos(rated.pair.driver.base_helix_angle)
    load = law_load("iso-6336-20", rated.pair, rated.line_load)
    return float(mean_friction("iso-6336-20", rated.surface, load, rolling, radius))


def flash_temperatures(rated: RatedSurface, x: ArrayLike) -> FlashTemperatures:
    """The standard's temperatures with its own load sharing.

    Parameters
    ----------
    rated : RatedSurface
    x : array_like
        Places at which they are reported [m]; mean and largest are taken over the whole path.
    """
    mu = friction(rated)

    def flash(at: Array) -> Array:
        share = load_sharing_factor(rated.pair, at, rated.grade)
        rise = flash_temperature(rated.at(at), share * rated.line_load, mu, rated.modulus)
        return np.asarray(rise * approach_factor(rated, at))

    place = np.asarray(x, dtype=float)
    whole = flash(np.linspace(rated.pair.x_start, rated.pair.x_end, _POSITIONS))
    mean = float(np.trapezoid(whole) / (_POSITIONS - 1))
    bulk = bulk_temperature(rated, mean)
    own = flash(place)
    return FlashTemperatures(
        place, load_sharing_factor(rated.pair, place, rated.grade), approach_factor(rated, place), own, bulk + own,
        mu, mean, bulk, bulk + float(whole.max()), rated.optimal_relief,
    )  # fmt: skip


def bulk_temperature(rated: RatedSurface, mean_flash: float) -> float:
    """Theta_M = Theta_oil + 0.47 X_S X_mp Theta_flm [degC], one mating gear (Eqs. 22 and 23)."""
    return rated.surface.temperature + _BULK * rated.supply * mean_flash


def scuffing_temperature(rated: RatedSurface, load_stage: int) -> float:
    """Theta_S = 80 + (0.85 + 1.4 X_W) X_L S_FZG^2 [degC] from the failure load stage of FZG A/8.3/90 (Eq. 99)."""
    x_l = rated.surface.oil.factor * rated.surface.thickness
    return _TEST_OIL + (_BASE + _BY_STRUCTURE * rated.structure) * x_l * load_stage**2


def safety(scuffing: float, largest: float, oil: float) -> float:
    """S_B = (Theta_S - Theta_oil) / (Theta_Bmax - Theta_oil) (Eq. 100); infinite where nothing becomes warmer."""
    return (scuffing - oil) / (largest - oil) if largest > oil else math.inf
