"""ISO 6336-1 method B: tooth stiffness c'_th, c', mesh stiffness c_gamma_alpha, c_gamma_beta.

Source: ISO 6336-1:2006, Calculation of load capacity of spur and helical gears - Part 1, clause 9 (steel, basic
rack 20 deg; theory of Weber and Banaschek for discs, C_M = 0.8 from measurements). All stiffnesses are per
unit face width, N/(m m) = Pa; 1 N/(mm um) = 1e9 Pa.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from fegear.base.errors import RangeError
from fegear.formulas.iso6336.part3_root_stress import virtual_teeth
from fegear.geometry.pair import GearPair

#: Table 9 of the standard: q' in mm um/N.
COEFFICIENTS = (0.04723, 0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182)
#: 1 N/(mm um) in Pa.
UNIT = 1e9
#: E of the steel behind q' [Pa].
STEEL = 206e9


@dataclass(frozen=True, slots=True)
class Stiffness:
    """ISO 6336-1 stiffnesses per unit face width [Pa]; 1e9 Pa is 1 N/(mm um).

    Parameters
    ----------
    theoretical : float
        c'_th of one tooth pair.
    single : float
        c', greatest stiffness of one tooth pair.
    mesh_alpha : float
        c_gamma_alpha, mean stiffness of the teeth in mesh.
    mesh_beta : float
        c_gamma_beta, for the face load factors.
    remark : str
        What of the gears lies outside the range that the standard states; empty where nothing does.
    """

    theoretical: float
    single: float
    mesh_alpha: float
    mesh_beta: float
    remark: str = ""


def theoretical_stiffness(z_n1: float, z_n2: float, x_1: float = 0.0, x_2: float = 0.0) -> float:
    """c'_th = 1/q' [Pa] (ISO 6336-1:2006, Eqs. 82 and 83).

    Parameters
    ----------
    z_n1, z_n2 : float
        Virtual numbers of teeth of pinion and wheel; inf for a rack.
    x_1, x_2 : float
        Profile shift coefficients, -0.5 <= x_1 + x_2 <= 2. The standard states x_1 >= x_2 besides, which most pairs of
        real gearboxes break; the series is smooth there, published reports use it, and so does this: `outside_range`.
        Outside the range of the sum the series is continued as well: published pairs and rings of planetary sets lie
        below -0.5. From -0.5 to -1 it stays within 9 % of the theory of Weber and Banaschek to which it was fitted
        (11/41 to 30/60 teeth; 4 % inside the range); at 60/60 teeth and -1.6 it is 16 % low.

    Raises
    ------
    RangeError
        Outside the range of the series.
    """
    for name, z in (("z_n1", z_n1), ("z_n2", z_n2)):
        if not z > 0.0:
            raise RangeError(name, z, "must be positive: the series is for external gears (inf for a rack)")
    terms = (1.0, 1.0 / z_n1, 1.0 / z_n2, x_1, x_1 / z_n1, x_2, x_2 / z_n2, x_1 * x_1, x_2 * x_2)
    q = sum(c * t for c, t in zip(COEFFICIENTS, terms, strict=True))
    if not q > 0.0:
        raise RangeError("q'", f"{q:.4g} mm um/N", "is not positive: the series is not valid for these gears")
    return UNIT / q


def outside_range(x_1: float, x_2: float) -> str:
    """What ISO 6336-1, 9.3.1.1, states about its series and these profile shifts break, in words; empty if nothing."""
    if not -0.5 <= x_1 + x_2 <= 2.0:
        return (
            f"c': x_1 + x_2 = {x_1 + x_2:.4g} is outside -0.5 to 2, the range of the series of ISO 6336-1, 9.3.1.1; "
            "extrapolated"
        )
    if x_1 >= x_2:
        return ""
    return f"x_1 = {x_1:.4g} is below x_2 = {x_2:.4g}, outside the range of ISO 6336-1, 9.3.1.1, for c'"


def blank_factor(web_ratio: float | None, rim_ratio: float = math.inf) -> float:
    """C_R: 1 for solid discs, else 1 + ln(b_s/b) / (5 exp(s_R / (5 m_n))) (ISO 6336-1:2006, 9.3.1.3).

    Parameters
    ----------
    web_ratio : float or None
        b_s/b; None for a solid disc; taken as 0.2 below and 1.2 above those bounds, as the standard says.
    rim_ratio : float
        s_R/m_n, taken as at least 1.
    """
    if web_ratio is None:
        return 1.0
    if not web_ratio > 0.0:
        raise RangeError("web ratio b_s/b", web_ratio, "must be positive", "remove it for a solid disc")
    if not rim_ratio > 0.0:
        raise RangeError("rim ratio s_R/m_n", rim_ratio, "must be positive")
    return 1.0 + math.log(min(max(web_ratio, 0.2), 1.2)) / (5.0 * math.exp(max(rim_ratio, 1.0) / 5.0))


def pair_blank_factor(bodies: Iterable[tuple[float | None, float]]) -> float:
    """C_R of a pair, the mean of both gears; of each b_s/b and s_R/m_n, as `blank_factor` takes them."""
    one, other = (blank_factor(web, rim) for web, rim in bodies)
    return 0.5 * (one + other)


def rack_factor(dedendum: float, pressure_angle: float = math.radians(20.0)) -> float:
    """C_B = [1 + 0.5 (1.2 - h_fP/m_n)] [1 - 0.02 (20 deg - alpha_Pn)] (ISO 6336-1:2006, 9.3.1.4)."""
    factor = (1.0 + 0.5 * (1.2 - dedendum)) * (1.0 - 0.02 * (20.0 - math.degrees(pressure_angle)))
    if not factor > 0.0:
        raise RangeError("dedendum h_fP/m_n", dedendum, "is outside the range of C_B")
    return factor


def stiffness(
    teeth: tuple[int, int],
    contact_ratio: float,
    *,
    helix_angle: float = 0.0,
    profile_shift: tuple[float, float] = (0.0, 0.0),
    dedendum: tuple[float, float] = (1.2, 1.2),
    pressure_angle: float = math.radians(20.0),
    blank: float = 1.0,
    specific_load: float = math.inf,
    young_modulus: tuple[float, float] = (STEEL, STEEL),
) -> Stiffness:
    """Stiffnesses of a gear pair (ISO 6336-1:2006, 9.3, method B).

    Parameters
    ----------
    teeth : (int, int)
        z_1, z_2; an internal gear's is negative and counts as infinite in q', as the standard says of internal gears.
    contact_ratio : float
        Transverse contact ratio epsilon_alpha, at least 1 and below 2.5 for spur gears.
    helix_angle : float
        beta [rad], at most 45 deg.
    profile_shift, dedendum : (float, float)
        x_1, x_2; h_fP/m_n of each gear's basic rack. C_B is the mean of both.
    pressure_angle : float
        alpha_Pn [rad].
    blank : float
        C_R, see `blank_factor`.
    specific_load : float
        F_t K_A / b [N/m]; below 100 N/mm c' falls with its fourth root.
    young_modulus : (float, float)
        E of both gears [Pa]; other than steel scales c' by 2 E_1 E_2 / ((E_1 + E_2) E_steel).

    Raises
    ------
    RangeError
        Outside the range of the method.
    """
    if not 0.0 <= helix_angle <= math.radians(45.0):
        raise RangeError("helix angle", f"{math.degrees(helix_angle):.4g} deg", "must be between 0 and 45 deg")
    if not contact_ratio >= 1.0:
        raise RangeError("contact ratio", f"{contact_ratio:.4g}", "must be at least 1")
    if helix_angle == 0.0 and contact_ratio >= 2.5:
        raise RangeError(
            "contact ratio", f"{contact_ratio:.4g}", "must be below 2.5 for spur gears (ISO 6336-1, 9.3.2)"
        )
    if not specific_load > 0.0:
        raise RangeError("specific load", specific_load, "must be positive")
    z_n = [math.inf if z < 0 else virtual_teeth(z, helix_angle, pressure_angle) for z in teeth]
    theoretical = theoretical_stiffness(z_n[0], z_n[1], *profile_shift)
    c_b = 0.5 * (rack_factor(dedendum[0], pressure_angle) + rack_factor(dedendum[1], pressure_angle))
    e_1, e_2 = young_modulus
    material = 2.0 * e_1 * e_2 / (e_1 + e_2) / STEEL
    low_load = min(specific_load / 1e5, 1.0) ** 0.25
    single = theoretical * 0.8 * blank * c_b * math.cos(helix_angle) * low_load * material
    alpha = single * (0.75 * contact_ratio + 0.25)
    return Stiffness(theoretical, single, alpha, 0.85 * alpha, outside_range(*profile_shift))


def pair_stiffness(pair: GearPair, *, specific_load: float = math.inf, blank: float = 1.0) -> Stiffness:
    """Stiffnesses of a gear pair, spur or helical; the pinion is the one with fewer teeth, or more profile shift.

    Parameters
    ----------
    pair : GearPair
    specific_load : float
        F_t K_A / b [N/m], tangential at the reference circle (`GearPair.specific_load`), not along the line of action.
    blank : float
        C_R; 1 for solid discs. The standard knows nothing of a bore.
    """
    pinion, wheel = sorted((pair.driver, pair.driven), key=lambda g: (g.teeth, -g.tooth.profile_shift))
    return stiffness(
        (pinion.tooth.side * pinion.teeth, wheel.tooth.side * wheel.teeth),
        pair.contact_ratio,
        helix_angle=pair.driver.helix_angle,
        profile_shift=(pinion.tooth.profile_shift, wheel.tooth.profile_shift),
        dedendum=(pinion.symmetric_tooth.dedendum, wheel.symmetric_tooth.dedendum),
        pressure_angle=pinion.normal_pressure_angle,
        blank=blank,
        specific_load=specific_load,
        young_modulus=(pinion.material.young_modulus, wheel.material.young_modulus),
    )
