"""ISO/TS 6336-22: micropitting, by the thickness of the lubricant film compared with the roughness.

Source: ISO/TR 15144-1:2014, Calculation of micropitting load capacity of cylindrical spur and helical gears - Part 1,
from which ISO/TS 6336-22:2018 was made; formulas are numbered as there, and known here from secondary sources, of which
printed reports (fegear/verify/data/kisssoft_stage_*.toml) hold X_Y, p_dyn,Y, lambda_GF,Y, lambda_GFT and W_W.
lambda_GF,Y = h_Y / Ra with the film of Dowson and Higginson, thinned by the heat of the contact.

The FZG test gears of scuffing and micropitting tests.

Source: ISO 14635-1 (type A) and FVA information sheet 54/7 (type C); the dimensions as published reports of tests give
them. Centre distance 91.5 mm, 16 and 24 teeth, module 4.5 mm, 20 deg.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.formulas.flank_speeds import FlankSpeeds
from fegear.formulas.flash_temperature import STEEL_HEAT
from fegear.formulas.friction import Surface, contact_ratios, law_load, mean_friction, teeth_factor
from fegear.formulas.iso6336.part20_flash import buttressing, spur_sharing
from fegear.formulas.iso6336.rated import RatedSurface
from fegear.formulas.lubricant import Oil
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

#: B_M of the test gears: density, specific heat, conductivity of the steel of Table 2 (Formula 82) [N/(m s^0.5 K)].
_TEST_HEAT = math.sqrt(7800.0 * 440.0 * 45.0)
#: Overlap ratios up to which helical teeth share the load as spur teeth do, and from which evenly; in between linearly.
_NARROW, _WIDE = 0.8, 1.2
#: Bulk temperature: 7400 (P mu H_v / (a b))^0.72 X_S / (1.2 X_Ca) in kW and mm (Formula 84).
_BULK, _POWER, _RELIEF = 7400.0, 0.72, 1.2
#: Permissible film over that of the test gears (clause 5).
_OF_TEST = 1.4
#: Torque on the pinion of the FZG gears type C at the load stages of FVA 54/7 [N m], its speed, and the flanks' Ra.
_TEST_TORQUES = {5: 70.0, 6: 98.9, 7: 132.5, 8: 171.6, 9: 215.6, 10: 265.1}
_TEST_SPEED, _TEST_ROUGHNESS = 2250.0 * math.pi / 30.0, 0.5e-6
#: Line load at A over the torque on the test pinion [1/m^2]: 236.3 N/mm at 265.1 N m, printed for load stage 10.
_TEST_LINE_LOAD = 236.3e3 / 265.1
#: W_W: of carburized flanks 1, and .75 of such on through-hardened ones as printed, the mean of 1 and .5; the others
#: are recalled. `RECALLED_MATERIALS` names these.
MATERIAL_FACTOR = {
    "case-carburized": 1.0, "case-carburized-low-austenite": 1.0, "case-carburized-high-austenite": 0.95,
    "nitrided": 1.5, "induction-hardened": 0.65, "through-hardened": 0.5,
}  # fmt: skip
RECALLED_MATERIALS = frozenset({"case-carburized-high-austenite", "nitrided", "induction-hardened"})


@dataclass(frozen=True)
class Film:
    """The film at places on the path of contact; arrays of one shape.

    Parameters
    ----------
    flash, contact : ndarray
        Local flash temperature [K] and contact temperature [degC] (Formulae 79 and 80).
    thickness : ndarray
        Formula 4.
    ratio : ndarray
        Formula 2; infinite where nothing presses.
    """

    flash: Array
    contact: Array
    thickness: Array = shown("um", "h_Y of ISO/TS 6336-22", name="film_thickness_iso")
    ratio: Array = shown("", "lambda_GF,Y of ISO/TS 6336-22", name="film_ratio_iso")


@dataclass(frozen=True)
class RatedFilm:
    """Method B at places on the path of contact.

    Parameters
    ----------
    film : Film
    nominal, dynamic : ndarray
        Local Hertzian pressure.
    """

    film: Film
    sharing: Array = shown("", "X_Y of ISO/TS 6336-22", name="load_sharing_iso")
    nominal: Array = shown("MPa", "p_H,Y of ISO/TS 6336-22, no load factors", name="hertz_pressure_nominal_iso")
    dynamic: Array = shown("MPa", "p_dyn,Y of ISO/TS 6336-22, all load factors", name="hertz_pressure_iso")
    friction: float = shown("", "mu_m")
    bulk: float = shown("degC", "bulk temperature theta_M")


def load_sharing(pair: GearPair, x: ArrayLike, grade: int = 6) -> Array:
    """X_Y of unmodified profiles (clause 11): of spur teeth as in part 20, of helical ones with buttressed ends.

    Overlap ratios from 1.2 on spread the load evenly, X_but / epsilon_alpha, as a printed report has it (1.3 / 1.463 =
    .889 at A); up to .8 the load is that of spur teeth times X_but, and in between X_Y is linear in the overlap ratio,
    both recalled: `narrow`.

    Parameters
    ----------
    pair : GearPair
    x : array_like
        Places on the path of contact [m].
    grade : int
        Tolerance class of the flanks.
    """
    place = np.asarray(x, dtype=float)
    spur = spur_sharing(pair, place, grade)
    if pair.driver.helix_angle == 0.0:
        return spur
    wide = min(max((pair.overlap_ratio - _NARROW) / (_WIDE - _NARROW), 0.0), 1.0)
    return np.asarray(buttressing(pair, place) * ((1.0 - wide) * spur + wide / pair.contact_ratio))


def narrow(pair: GearPair) -> bool:
    """Whether a helical pair overlaps so little that its X_Y is one that no print holds."""
    return pair.driver.helix_angle != 0.0 and pair.overlap_ratio < _WIDE


def loss_factor(pair: GearPair) -> float:
    """H_v of the standard (Formulae 91 and 92); the number of teeth of an internal gear is negative."""
    one, two = contact_ratios(pair)
    scale = teeth_factor(pair)
    whole = one + two
    return scale * (one * one + two * two + 1.0 - whole if whole < 2.0 else 0.5 * whole)


def friction(rated: RatedSurface) -> float:
    """mu_m = 0.045 (K F_bt K_Bgamma / (b v_SigmaC rho_nC))^0.2 (1e3 eta_oil)^-0.05 X_R X_L (Formulae 86 and 87)."""
    at_pitch = rated.at(0.0)
    load = law_load("iso-6336-22", rated.pair, rated.line_load)
    return float(mean_friction("iso-6336-22", rated.surface, load, at_pitch.sum, at_pitch.relative_radius))


def relief_factor(rated: RatedSurface) -> float:
    """X_Ca: 1 + 0.24 e + 0.71 e^2 for flanks of class 6 or better with the relief C_eff, else 1 (100 and 101)."""
    if rated.grade > 6 or min(rated.tip_relief) < rated.optimal_relief:
        return 1.0
    e = max(contact_ratios(rated.pair))
    return 1.0 + 0.24 * e + 0.71 * e * e


def bulk_temperature(rated: RatedSurface, mu: float, losses: float) -> float:
    """theta_M = theta_oil + 7400 (P mu_m H_v / (a b))^0.72 X_S / (1.2 X_Ca) [degC] (Formula 84).

    Parameters
    ----------
    rated : RatedSurface
    mu : float
        Mean friction coefficient.
    losses : float
        H_v, of the standard or computed.
    """
    area = rated.pair.centre_distance * rated.pair.face_width * 1e6
    warm = (rated.power * 1e-3 * mu * losses / area) ** _POWER
    return rated.surface.temperature + _BULK * warm * rated.supply / (_RELIEF * relief_factor(rated))


def pressure(speeds: FlankSpeeds, line_load: ArrayLike, modulus: float) -> Array:
    """Local Hertzian pressure sqrt(w E_r / (2 pi rho_n)) [Pa], w in the plane of action per length (25 and 26)."""
    radius = np.maximum(speeds.relative_radius, np.finfo(float).tiny)
    return np.asarray(np.sqrt(np.maximum(np.asarray(line_load), 0.0) * modulus / (2.0 * math.pi * radius)))


def film(
    surface: Surface,
    speeds: FlankSpeeds,
    pressed: ArrayLike,
    mu: ArrayLike,
    bulk: float,
    modulus: float,
    heat: float = STEEL_HEAT,
) -> Film:
    """Film thickness at places on the path of contact.

    Parameters
    ----------
    surface : Surface
    speeds : FlankSpeeds
    pressed : array_like
        p_dyn,Y, local Hertzian pressure with all load factors [Pa].
    mu : array_like
        Friction coefficient.
    bulk : float
        theta_M [degC].
    modulus : float
        E_r [Pa].
    heat : float
        B_M of both gears [N/(m s^0.5 K)].
    """
    p, oil, tiny = np.maximum(np.asarray(pressed, dtype=float), 0.0), surface.oil, np.finfo(float).tiny
    through = heat * (np.sqrt(speeds.rolling_driver) + np.sqrt(speeds.rolling_driven))
    flash = (
        0.5 * math.sqrt(math.pi) * np.asarray(mu) * p * np.abs(speeds.sliding) / np.maximum(through, tiny)
        * np.sqrt(8.0 * speeds.relative_radius * p / modulus)
    )  # fmt: skip
    contact = bulk + flash
    alpha, eta = float(oil.pressure_viscosity(bulk)), float(oil.dynamic(bulk))
    g = alpha * modulus
    u = eta * speeds.sum / (2.0 * modulus * np.maximum(speeds.relative_radius, tiny))
    w = 2.0 * math.pi * (p / modulus) ** 2
    s = np.maximum(oil.pressure_viscosity(contact) * oil.dynamic(contact) / (alpha * eta), tiny)
    with np.errstate(divide="ignore"):
        thick = 1.6 * speeds.relative_radius * g**0.6 * u**0.7 * np.where(w > 0.0, w, np.nan) ** -0.13 * s**0.22
    thick = np.where(np.isnan(thick), np.inf, thick)  # nothing presses
    return Film(np.asarray(flash), np.asarray(contact), thick, thick / surface.roughness)


@lru_cache(maxsize=64)
def film_of_test(oil: Oil, load_stage: int, temperature: float = 90.0) -> float:
    """lambda_GFT: least film ratio of the FZG gears type C at the failure load stage of FVA 54/7 C/8.3/90.

    The same formulas on the test gears (16/24 teeth, module 4.5 mm, centre distance 91.5 mm, face 14 mm, no relief,
    2250 1/min, Ra 0.5 um, spray) at A under its line load, with the oil of the case.

    Raises
    ------
    RangeError
        If the load stage is none of 5 to 10.
    """
    from fegear.formulas.iso6336.rated import SUPPLY_FACTOR, LoadFactors, RatedSurface

    if load_stage not in _TEST_TORQUES:
        raise RangeError("load stage", load_stage, "must be 5 to 10")
    pair = fzg_type_c()
    load = _TEST_TORQUES[load_stage] / pair.driver.base_radius
    rated = RatedSurface(
        pair, _TEST_SPEED, load, LoadFactors(), Surface(oil, temperature, _TEST_ROUGHNESS), SUPPLY_FACTOR["spray"]
    )
    mu, at = friction(rated), rated.at(pair.x_start)
    bulk = bulk_temperature(rated, mu, loss_factor(pair))
    pressed = pressure(at, _TEST_LINE_LOAD * _TEST_TORQUES[load_stage], rated.modulus)
    return float(film(rated.surface, at, pressed, mu, bulk, rated.modulus, _TEST_HEAT).ratio)


def rated_film(rated: RatedSurface, x: ArrayLike) -> RatedFilm:
    """The standard's film with its own load sharing."""
    mu = friction(rated)
    bulk, at = bulk_temperature(rated, mu, loss_factor(rated.pair)), rated.at(x)
    share = load_sharing(rated.pair, x, rated.grade)
    nominal, dynamic = (
        pressure(at, share * load / rated.pair.face_width, rated.modulus)
        for load in (rated.load, rated.load * rated.factors.product)
    )
    return RatedFilm(film(rated.surface, at, dynamic, mu, bulk, rated.modulus), share, nominal, dynamic, mu, bulk)


def least_ratio(rated: RatedSurface) -> tuple[float, str]:
    """lambda_GF,min of method B, and at which of the points A, AB, B, C, D, DE, E (clause 8.2)."""
    pair = rated.pair
    first, last = pair.x_end - pair.base_pitch, pair.x_start + pair.base_pitch
    tiny = 1e-9 * pair.base_pitch
    points = {
        "A": pair.x_start, "AB": 0.5 * (pair.x_start + first), "B": first + tiny, "C": 0.0, "D": last - tiny,
        "DE": 0.5 * (last + pair.x_end), "E": pair.x_end,
    }  # fmt: skip
    inside = {name: x for name, x in points.items() if pair.x_start <= x <= pair.x_end}
    ratios = rated_film(rated, np.array(list(inside.values()))).film.ratio
    least = int(np.argmin(ratios))
    return float(ratios[least]), list(inside)[least]


def permissible_ratio(oil: Oil, load_stage: int, temperature: float = 90.0, material: float = 1.0) -> float:
    """lambda_GFP = 1.4 W_W lambda_GFT: from a test in another gear pair; `material` is W_W of both gears."""
    return _OF_TEST * material * film_of_test(oil, load_stage, temperature)


_MODULE, _DISTANCE = 4.5e-3, 91.5e-3


def _pair(shifts: tuple[float, float], tips: tuple[float, float], widths: tuple[float, float]) -> GearPair:
    steel, gears = Material(206e9, 0.3), []
    for teeth, shift, tip, width in zip((16, 24), shifts, tips, widths, strict=True):
        rack = BasicRack.named("A", math.radians(20.0))
        tooth = Tooth(teeth, rack, profile_shift=shift, tip_radius=0.5 * tip / _MODULE)
        gears.append(Gear(tooth, _MODULE, 0.5 * tooth.root_radius * _MODULE, width, steel))
    return GearPair(gears[0], gears[1], _DISTANCE)


def fzg_type_c() -> GearPair:
    """FZG gears type C: x = 0.1817 and 0.1715, addendum of one module uncut, face 14 mm.

    Tips of 82.64 and 118.54 mm, as a public program has them (C. Fernandes, GEARpie: no addendum reduction). With those
    of 82.46 and 118.36 mm, cut for the full clearance, the test's bulk temperature and film are further from print.
    """
    return _pair((0.1817, 0.1715), (82.635e-3, 118.544e-3), (14e-3, 14e-3))


def fzg_type_a() -> GearPair:
    """FZG gears type A: x = 0.8532 and -0.5, tips 88.77 and 112.5 mm, face 20 mm: much sliding at the pinion's tip."""
    return _pair((0.8532, -0.5), (88.77e-3, 112.5e-3), (20e-3, 20e-3))
