"""ISO/TS 6336-21: scuffing by the integral temperature method.

Source: ISO/TR 13989-2:2000, Calculation of scuffing load capacity - Part 2: Integral temperature method, from which
ISO/TS 6336-21 was made; equations are numbered as there, and known here from secondary sources. Cylindrical gears,
transverse contact ratio below 3 (stated for up to about 2.5); gear ratio and radius of curvature of an internal gear
are negative.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.base.errors import RangeError
from fegear.formulas.flash_temperature import STEEL_HEAT
from fegear.formulas.friction import FASTEST, contact_ratios, helical_load_factor, law_load, mean_friction
from fegear.formulas.iso6336.rated import RatedSurface
from fegear.geometry.pair import GearPair

#: C_1 and C_2: weights of the mean flash temperature in the bulk and in the integral temperature (Eqs. 17 and 20).
_BULK, _WEIGHT = 0.7, 1.5
#: Torque on the pinion of the FZG test over the square of the load stage [N m] (Eq. 97).
_TEST_TORQUE = 3.726
#: Tip relief counts in flanks of this ISO 1328-1 class or better (6.1.12).
_FINE = 6


@dataclass(frozen=True)
class IntegralTemperature:
    """The integral temperature and every factor in it.

    Parameters
    ----------
    friction : float
        mu_mC (Eq. 1).
    helical : float
        K_Bgamma (Eq. 5).
    thermal : float
        X_M for the pair's material [K N^-0.75 s^0.5 m^-0.5 mm] (Eq. 11).
    angle : float
        X_alphabeta (Eq. 13).
    geometry : float
        X_BE at the pinion's tip (Eq. 22).
    approach : float
        X_Q (Eqs. 25 to 29).
    relief : float
        X_Ca (Eqs. 32 to 38).
    contact_ratio : float
        X_epsilon (Eqs. 39 to 45).
    at_tip, mean : float
        theta_flaE and theta_flaint [K] (Eqs. 18 and 19).
    bulk, integral : float
        theta_M and theta_int [degC] (Eqs. 17 and 20).
    """

    friction: float
    helical: float
    thermal: float
    angle: float
    geometry: float
    approach: float
    relief: float
    contact_ratio: float
    at_tip: float
    mean: float
    bulk: float
    integral: float


def angle_factor(pair: GearPair) -> float:
    """X_alphabeta = 1.22 sin^0.25(a_wt) cos^0.25(a_n) cos^0.25(beta) / (cos a_wt cos a_t)^0.5 (Eq. 13)."""
    a_wt, a_t = pair.working_pressure_angle, pair.driver.transverse_pressure_angle
    normal = math.cos(pair.driver.normal_pressure_angle) * math.cos(pair.driver.helix_angle)
    return 1.22 * (math.sin(a_wt) * normal) ** 0.25 / math.sqrt(math.cos(a_wt) * math.cos(a_t))


def thermal_factor(modulus: float, heat: float = STEEL_HEAT) -> float:
    """X_M = E_r^0.25 / B_M [K N^-0.75 s^0.5 m^-0.5 mm]: 50.0 for steel, E = 206 GPa, nu = 0.3 (Eq. 11)."""
    return 1e3 * (modulus * 1e-6) ** 0.25 / (heat / math.sqrt(1e3))


def geometry_factor(ratio: float, rho_1: float, rho_2: float) -> float:
    """X_BE = 0.51 |u + 1|^0.5 (rho_E1^0.5 - (rho_E2/u)^0.5) / (rho_E1 |rho_E2|)^0.25 (Eq. 22).

    Parameters
    ----------
    ratio : float
        u; negative of an internal pair, as rho_E2 is.
    rho_1, rho_2 : float
        Radii of curvature of pinion and wheel at the pinion's tip [mm].
    """
    hollow = math.copysign(max(abs(rho_2), 1e-9), ratio)
    slide = math.sqrt(rho_1) - math.sqrt(hollow / ratio)
    return 0.51 * math.sqrt(abs(ratio + 1.0)) * slide / (rho_1 * abs(hollow)) ** 0.25


def contact_ratio_factor(one: float, two: float) -> float:
    """X_epsilon from both addendum contact ratios (Eqs. 39 to 45).

    Raises
    ------
    RangeError
        Outside the ranges of the standard: a contact ratio of 3 or more, or a path that misses the pitch point.
    """
    whole = one + two
    if not (one > 0.0 and two >= 0.0 and whole < 3.0):
        raise RangeError(
            "contact ratio", f"{one:.4g} + {two:.4g}", "is outside the range of the integral temperature method"
        )
    if whole < 1.0:
        sum_ = one * one + two * two
    elif whole < 2.0 and one < 1.0 and two < 1.0:
        sum_ = 0.70 * (one * one + two * two) - 0.22 * whole + 0.52 - 0.60 * one * two
    elif whole < 2.0 and one >= 1.0:
        sum_ = 0.18 * one * one + 0.70 * two * two + 0.82 * one - 0.52 * two - 0.30 * one * two
    elif whole < 2.0:
        sum_ = 0.70 * one * one + 0.18 * two * two - 0.52 * one + 0.82 * two - 0.30 * one * two
    elif one >= two:
        sum_ = 0.44 * one * one + 0.59 * two * two + 0.30 * one - 0.30 * two - 0.15 * one * two
    else:
        sum_ = 0.59 * one * one + 0.44 * two * two - 0.30 * one + 0.30 * two - 0.15 * one * two
    return sum_ / (2.0 * whole * one)


def integral_temperature(rated: RatedSurface) -> IntegralTemperature:
    """theta_int = theta_M + 1.5 theta_flaint of run-in flanks (X_E = 1).

    Raises
    ------
    RangeError
        If the contact ratio lies outside the method.
    """
    pair = rated.pair
    pinion_drives = pair.driver.teeth <= pair.driven.teeth
    one, two = contact_ratios(pair) if pinion_drives else contact_ratios(pair)[::-1]
    ratio = pair.side * max(pair.driver.teeth, pair.driven.teeth) / min(pair.driver.teeth, pair.driven.teeth)
    helical = helical_load_factor(pair.total_contact_ratio)
    mu = friction(rated)
    tip = pair.x_end if pinion_drives else pair.x_start  # the end of the path at the pinion's tip
    at_tip = rated.at(tip)
    rho_1, rho_2 = float(at_tip.radius_driver) * 1e3, float(at_tip.radius_driven) * 1e3
    if not pinion_drives:
        rho_1, rho_2 = rho_2, rho_1
    geometry = geometry_factor(ratio, rho_1, rho_2)
    angle, thermal = angle_factor(pair), thermal_factor(rated.modulus)
    first, second = (two, one) if pinion_drives else (one, two)
    q = first / second if second > 0.0 else math.inf
    approach = 1.0 if q <= 1.5 else 0.6 if q >= 3.0 else 1.4 - 4.0 / 15.0 * q
    relief = relief_factor(rated, one, two, pinion_drives=pinion_drives)
    whole = contact_ratio_factor(one, two)
    speed = rated.reference_speed
    flash = (
        mu * thermal * geometry * angle * (helical * rated.unit_load * 1e-3) ** 0.75 * math.sqrt(speed)
        / (pair.centre_distance * 1e3) ** 0.25 / (approach * relief)
    )  # fmt: skip
    mean = flash * whole
    bulk = rated.surface.temperature + _BULK * rated.supply * mean
    return IntegralTemperature(
        mu, helical, thermal, angle, geometry, approach, relief, whole, flash, mean, bulk, bulk + _WEIGHT * mean
    )


def friction(rated: RatedSurface) -> float:
    """mu_mC = 0.045 (w_Bt K_Bgamma / (v_SigmaC rho_redC))^0.2 eta^-0.05 X_R X_L (Eqs. 1 to 7)."""
    pair = rated.pair
    rolling = (
        2.0 * min(rated.reference_speed, FASTEST) * math.tan(pair.working_pressure_angle)
        * math.cos(pair.driver.transverse_pressure_angle)
    )  # fmt: skip
    load = law_load("iso-6336-21", pair, rated.line_load)
    return float(mean_friction("iso-6336-21", rated.surface, load, rolling, rated.at(0.0).relative_radius))


def relief_factor(rated: RatedSurface, one: float, two: float, *, pinion_drives: bool) -> float:
    """X_Ca = 1 + (0.06 + 0.18 C_a/C_eff) e + (0.02 + 0.69 C_a/C_eff) e^2, e the larger addendum ratio (Eqs. 32 to 38).

    1 for flanks that are coarser than class 6 (6.1.12).
    """
    if rated.grade > _FINE:
        return 1.0
    stiffness = rated.mesh_stiffness if rated.pair.driver.helix_angle else rated.single_stiffness
    best = rated.factors.application * rated.tangential_load / (rated.pair.face_width * stiffness)
    pinion, wheel = rated.tip_relief if pinion_drives else rated.tip_relief[::-1]
    by_pinion = one > 1.5 * two if pinion_drives else one > 2.0 / 3.0 * two
    part = min((pinion if by_pinion else wheel) / best, 1.0)
    e = max(one, two)
    return 1.0 + (0.06 + 0.18 * part) * e + (0.02 + 0.69 * part) * e * e


def computed_integral(rated: RatedSurface, mean_flash: float) -> float:
    """theta_int with a mean flash temperature that was computed over the path, in place of the tip's [degC].

    Parameters
    ----------
    rated : RatedSurface
    mean_flash : float
        With the friction coefficient of this method [K].
    """
    return rated.surface.temperature + (_BULK * rated.supply + _WEIGHT) * mean_flash


def scuffing_integral_temperature(rated: RatedSurface, load_stage: int) -> float:
    """theta_intS from the failure load stage of the test FZG A/8.3/90 [degC] (Eqs. 94 to 97, 102)."""
    torque, oil = _TEST_TORQUE * load_stage**2, rated.surface.oil
    flash = 0.2 * torque * (100.0 / (oil.viscosity_40 * 1e6)) ** 0.02 * oil.factor
    return 80.0 + 0.23 * torque * oil.factor + rated.structure * _WEIGHT * flash


def safety(scuffing: float, integral: float) -> float:
    """S_intS = theta_intS / theta_int, temperatures in degC (Eq. 14): below 1 scuffing, from 2 on little risk."""
    return scuffing / integral if integral > 0.0 else math.inf
