"""ISO 6336-1, clause 6: internal dynamic factor K_v by methods B and C.

Source: ISO 6336-1:2006 with technical corrigendum 1:2008, clause 6 (method B: 6.4, method C: 6.5); the edition of 2019
keeps the formulas. Equation numbers of clauses 6 to 8 were checked in a public program that types the standard with
them (mekanika.org, MechanicalCalculatorWeb, Services/Iso6336*.cs).
Method B takes the pair as two masses on the mean stiffness of their teeth; method C is a fit for pairs that run well
below their resonance. Method C's numbers are those of IACS UR M56 (Rev. 4), 1.6.3, which repeats ISO 6336-1:2019.
Lengths in m, specific loads (tangential, per face width) in N/m, stiffnesses per face width in Pa.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Both

#: Least specific load that the standard counts [N/m].
_LEAST_LOAD = 100e3
#: Ends of the ranges of the resonance ratio: the main resonance to 1.15, supercritical from 1.5.
MAIN_END, SUPERCRITICAL = 1.15, 1.5
#: K_1 of method C for grades 3 to 8, spur and helical; IACS UR M56 (Rev. 4), table 1.1.
K_1 = {"spur": (2.1, 3.9, 7.5, 14.9, 26.8, 39.1), "helical": (1.9, 3.5, 6.7, 13.3, 23.9, 34.8)}
#: Where K_3 = 2.071 - .357 x has fallen to nothing [m/s].
NO_K_3 = 2.071 / 0.357
K_2 = {"spur": 0.0193, "helical": 0.0087}


@dataclass(frozen=True, slots=True)
class DynamicErrors:
    """What excites the teeth, and what running in leaves of it; [m].

    Parameters
    ----------
    base_pitch, profile : float
        f_pb and f_falpha of the worse gear.
    run_in_pitch, run_in_profile : float
        y_p, y_f.
    tip_relief : float
        C_a; that of running in (`running_in_relief`) where there is none from design.
    coarse : bool
        Whether the pair is of accuracy grade 6 or coarser, whose tip relief counts for nothing: B_k = 1.
    """

    base_pitch: float
    profile: float
    run_in_pitch: float
    run_in_profile: float
    tip_relief: float
    coarse: bool


@dataclass(frozen=True, slots=True)
class DynamicFactor:
    """K_v and what it is made of.

    Parameters
    ----------
    reduced_mass : float
        m_red per face width [kg/m]; NaN by method C.
    resonance_speed : float
        n_E1 of the pinion [rad/s]; NaN by method C.
    resonance_ratio, lower_limit : float
        N, N_S; NaN by method C.
    load_parameters : (float, float, float)
        B_p, B_f, B_k; NaN by method C.
    coefficients : tuple of float
        C_v1 to C_v7; empty by method C.
    range : str
        "subcritical", "main resonance", "intermediate", "supercritical" or "method C".
    K_v : float
    remark : str
        What lies outside the range that the standard states; empty where nothing does.
    """

    reduced_mass: float
    resonance_speed: float
    resonance_ratio: float
    lower_limit: float
    load_parameters: tuple[float, float, float]
    coefficients: tuple[float, ...]
    range: str
    K_v: float
    remark: str = ""


def running_in_relief(contact: Both) -> float:
    """C_ay [m] that running in leaves at the tips: (sigma_Hlim/97 - 18.45)^2 / 18 + 1.5 um, the mean of both materials.

    Parameters
    ----------
    contact : (float, float)
        sigma_Hlim of both gears [Pa] (ISO 6336-1:2006, table 4).
    """
    return 0.5e-6 * sum((s / 97e6 - 18.45) ** 2 / 18.0 + 1.5 for s in contact)


def reduced_mass(pair: PairGeometry, meshes: tuple[int, int] = (1, 1)) -> float:
    """m_red of discs per face width [kg/m] (ISO 6336-1:2006, 6.4.8, Eqs. 30 to 32).

    The discs have the mean diameter d_m = (d_a + d_f)/2 and a bore of d_i; a web counts for nothing. Of a gear with
    several mates, as a sun has planets, each mesh moves its part. The disc of an internal gear lies outside of
    d_m, and a gear that stands still with the casing does not move at all (6.4.9).

    Parameters
    ----------
    pair : PairGeometry
    meshes : (int, int)
        How many mates pinion and wheel have.
    """
    masses = []
    for gear, d_b, mates in zip(pair.gears, pair.signed_base_diameters, meshes, strict=True):
        if gear.fixed:
            masses.append(math.inf)
            continue
        d_m = 0.5 * (gear.tip_diameter + gear.root_diameter)
        hollow = abs(1.0 - (gear.bore_diameter / d_m) ** 4)
        masses.append(math.pi / 8.0 * gear.density * hollow * d_m**4 / d_b**2 / mates)
    if math.inf in masses:
        return min(masses)
    return masses[0] * masses[1] / (masses[0] + masses[1])


def coefficients(total_contact_ratio: float) -> tuple[float, ...]:
    """C_v1 to C_v7 of epsilon_gamma (ISO 6336-1:2006, table 4).

    Raises
    ------
    RangeError
        If the total contact ratio is not above 1.
    """
    e = total_contact_ratio
    if not e > 1.0:
        raise RangeError("total contact ratio", f"{e:.4g}", "must exceed 1 (ISO 6336-1, table 4)")
    if e <= 2.0:
        first = (0.32, 0.34, 0.23, 0.90, 0.47, 0.47)
    else:
        first = (0.32, 0.57 / (e - 0.3), 0.096 / (e - 1.56), (0.57 - 0.05 * e) / (e - 1.44), 0.47, 0.12 / (e - 1.74))
    if e <= 1.5:
        last = 0.75
    elif e <= 2.5:
        last = 0.125 * math.sin(math.pi * (e - 2.0)) + 0.875
    else:
        last = 1.0
    return (*first, last)


def lower_limit(specific_load: float) -> float:
    """N_S, start of the main resonance: .85, less for F_t K_A K_gamma / b below 100 N/mm (ISO 6336-1, Eqs. 11, 12)."""
    return 0.85 if specific_load >= _LEAST_LOAD else 0.5 + 0.35 * math.sqrt(specific_load / _LEAST_LOAD)


def load_parameters(errors: DynamicErrors, single_stiffness: float, specific_load: float) -> tuple[float, float, float]:
    """B_p, B_f, B_k (ISO 6336-1:2006, 6.4.3, Eqs. 15 to 19); specific load F_t K_A K_gamma / b [N/m], c' [Pa]."""
    per_length = single_stiffness / specific_load
    b_p = per_length * (errors.base_pitch - errors.run_in_pitch)
    b_f = per_length * (errors.profile - errors.run_in_profile)
    return b_p, b_f, 1.0 if errors.coarse else abs(1.0 - per_length * errors.tip_relief)


def of_resonance_ratio(
    ratio: float, limit: float, c: tuple[float, ...], b: tuple[float, float, float]
) -> tuple[str, float]:
    """Range and K_v (ISO 6336-1:2006, 6.4.3 to 6.4.6, Eqs. 13, 14, 20, 21, 22).

    The standard's K_v jumps at N_S; at 1.15 and 1.5 it is continuous.

    Parameters
    ----------
    ratio, limit : float
        N, N_S.
    c : tuple of float
        C_v1 to C_v7.
    b : (float, float, float)
        B_p, B_f, B_k.
    """
    b_p, b_f, b_k = b
    if ratio <= limit:
        return "subcritical", 1.0 + ratio * (c[0] * b_p + c[1] * b_f + c[2] * b_k)
    main = 1.0 + c[0] * b_p + c[1] * b_f + c[3] * b_k
    if ratio <= MAIN_END:
        return "main resonance", main
    above = c[4] * b_p + c[5] * b_f + c[6]
    if ratio >= SUPERCRITICAL:
        return "supercritical", above
    return "intermediate", above + (main - above) * (SUPERCRITICAL - ratio) / (SUPERCRITICAL - MAIN_END)


def method_b(
    pair: PairGeometry,
    stiffness: tuple[float, float],
    specific_load: float,
    speed: float,
    errors: DynamicErrors,
    meshes: tuple[int, int] = (1, 1),
) -> DynamicFactor:
    """K_v by method B (ISO 6336-1:2006, 6.4).

    Parameters
    ----------
    pair : PairGeometry
    stiffness : (float, float)
        c' and c_gamma_alpha [Pa].
    specific_load : float
        F_t K_A K_gamma / b [N/m].
    speed : float
        Of the pinion [rad/s].
    errors : DynamicErrors
    meshes : (int, int)
        How many mates pinion and wheel have.
    """
    for name, value in (("specific load", specific_load), ("speed", speed)):
        if not value > 0.0:
            raise RangeError(name, value, "must be positive")
    mass = reduced_mass(pair, meshes)
    resonance = math.sqrt(stiffness[1] / mass) / pair.gears[0].teeth
    limit = lower_limit(specific_load)
    c = coefficients(pair.total_contact_ratio)
    b = load_parameters(errors, stiffness[0], specific_load)
    name, k_v = of_resonance_ratio(speed / resonance, limit, c, b)
    remark = ""
    if name == "main resonance":
        remark = "K_v: operation in the main resonance range; ISO 6336-1 recommends to avoid it or to use method A"
    elif k_v < 1.0:
        remark = f"K_v: {k_v:.3g} from the formula of the {name} range is below 1; 1 is conservative"
    return DynamicFactor(mass, resonance, speed / resonance, limit, b, c, name, k_v, remark)


def speed_parameter(pair: PairGeometry, velocity: float) -> float:
    """v z_1 / 100 sqrt(u^2 / (1 + u^2)) [m/s] (ISO 6336-1:2006, 6.3.2 and 6.5)."""
    u = abs(pair.signed_ratio)
    return velocity * pair.gears[0].teeth / 100.0 * u / math.sqrt(1.0 + u * u)


def method_c(pair: PairGeometry, specific_load: float, velocity: float, grade: int) -> DynamicFactor:
    """K_v by method C (ISO 6336-1:2006, 6.5), for solid steel discs of accuracy grade 3 to 8 below the resonance.

    Parameters
    ----------
    pair : PairGeometry
    specific_load : float
        F_t K_A K_gamma / b [N/m], counted as at least 100 N/mm.
    velocity : float
        v at the reference circle [m/s].
    grade : int
        The coarser one of both gears.

    Raises
    ------
    RangeError
        Outside grades 3 to 8, or faster than 5.8 m/s of `speed_parameter`: K_3 is negative beyond, though the method is
        stated for up to 10 m/s.
    """
    if not 3 <= grade <= 8:
        raise RangeError("accuracy grade", grade, "must be 3 to 8 for K_v by method C", "use method B")
    x = speed_parameter(pair, velocity)
    if not 0.0 <= x <= NO_K_3:
        raise RangeError(
            "v z_1/100 sqrt(u^2/(1 + u^2))", f"{x:.4g} m/s", "must be at most 5.8 for K_v by method C", "use method B"
        )
    load = max(specific_load, _LEAST_LOAD) / 1e3
    k_3 = 2.0 if x <= 0.2 else 2.071 - 0.357 * x
    spur, helical = (1.0 + (K_1[kind][grade - 3] / load + K_2[kind]) * x * k_3 for kind in ("spur", "helical"))
    k_v = spur - min(pair.overlap_ratio, 1.0) * (spur - helical)
    remarks = []
    if x > 0.5 * NO_K_3:
        remarks.append("K_v falls with speed beyond 2.9 m/s of v z_1/100 sqrt(u^2/(1 + u^2))")
    if pair.helix_angle > math.radians(30.0) and x >= 3.0:
        remarks.append("beta is above 30 deg")
    if pair.gears[0].teeth >= 50 and x >= 3.0:
        remarks.append("z_1 is not below 50")
    remark = f"K_v: {' and '.join(remarks)}, outside the range of method C" if remarks else ""
    nan = math.nan
    return DynamicFactor(nan, nan, nan, nan, (nan, nan, nan), (), "method C", k_v, remark)
