"""ISO 6336-2: the contact stress of a pair: Z_H, Z_B, Z_D, Z_E, Z_epsilon, Z_beta, sigma_H0, sigma_H.

Source: ISO 6336-2:2006, clauses 5 to 9, and IACS UR M56 (Rev. 4), M56.2, which repeats ISO 6336-2:2019 but for f_ZCa.
Two things moved between editions: Z_beta, printed as sqrt(cos beta) in 2006 and corrected to 1/sqrt(cos beta) by
technical corrigendum 1:2008; and Z_B, Z_D of helical gears, which 2019 raises by f_ZCa where tips are not relieved (its
values are recalled: no public text that repeats them was at hand, and a rating remarks on it).

ISO 6336-2: what the flanks bear: Z_NT, Z_L, Z_v, Z_R, Z_W, Z_X and sigma_HP, static, at reference and in between.

Source: ISO 6336-2:2006, clauses 10 to 14; numbers of Z_L, Z_v, Z_R and Z_W as in IACS UR M56 (Rev. 4), M56.2.10 and
2.11, which repeats ISO 6336-2:2019. The denominator of Z_W of static strength, misprinted as 680 in the standard,
is 6800 (errata in doi:10.1007/978-3-030-33146-7_15). Stresses in Pa, roughness in m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part5_materials as groups
from fegear.formulas.iso6336.life import LONG, Knots

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Both, Duty, Quality, Strength


#: How tips of helical gears are relieved, for f_ZCa of 2019: not at all, by experience, as computed under load.
TipRelief = Literal["none", "experience", "computed"]


#: Which Z_beta: "2006" as printed then, sqrt(cos beta); otherwise 1/sqrt(cos beta) (corrigendum of 2008, and 2019).
HelixFactor = Literal["printed in 2006", "corrected"]


_TIP_RELIEF: dict[TipRelief, float] = {"none": 1.2, "experience": 1.07, "computed": 1.0}


def zone_factor(pair: PairGeometry) -> float:
    """Z_H = sqrt(2 cos(beta_b) cos(alpha_wt) / (cos^2(alpha_t) sin(alpha_wt))) (ISO 6336-2, clause 6)."""
    return math.sqrt(
        2.0
        * math.cos(pair.base_helix_angle)
        / (math.cos(pair.transverse_pressure_angle) ** 2 * math.tan(pair.working_pressure_angle))
    )


#: What is said of f_ZCa.
RECALLED = (
    "f_ZCa: {value:g} for helical gears {tips} is not verified against a printed source; the contact stress is "
    "multiplied by its square root for overlap ratios of 1 and above (iso_6336.tip_relief_factor)"
)


TIPS: dict[TipRelief, str] = {
    "none": "without tip relief", "experience": "with tip relief by experience", "computed": "with a calculated relief",
}  # fmt: skip


def tip_relief_factor(relief: TipRelief, edition: int) -> float:
    """f_ZCa of helical gears (ISO 6336-2:2019, 6.3): 1.2, 1.07 or 1; 1 in 2006."""
    return _TIP_RELIEF[relief] if edition == 2019 else 1.0


def single_pair_factors(pair: PairGeometry, tip_relief: float = 1.0) -> tuple[Both, Both]:
    """M_1, M_2 and Z_B, Z_D: from the pitch point to the inner points of single pair contact.

    ISO 6336-2, 6.2; Eqs. 17 and 18 of 2006. From a transverse contact ratio of 2 on there are none, and all are 1.

    Parameters
    ----------
    pair : PairGeometry
    tip_relief : float
        f_ZCa; counts for helical gears only.

    Raises
    ------
    RangeError
        If the transverse contact ratio is below 1, or a single pair contact point lies below a base circle.
    """
    e = pair.contact_ratio
    if not e >= 1.0:
        raise RangeError("contact ratio", f"{e:.4g}", "must be at least 1 (ISO 6336-2, 6.2)")
    if e >= 2.0:
        return (1.0, 1.0), (1.0, 1.0)
    tips = [
        math.sqrt(max((g.active_tip_diameter / d_b) ** 2 - 1.0, 0.0))
        for g, d_b in zip(pair.gears, pair.signed_base_diameters, strict=True)
    ]
    steps = [2.0 * math.pi / g.signed_teeth for g in pair.gears]
    factors = []
    for one, other in ((0, 1), (1, 0)):
        product = (tips[one] - steps[one]) * (tips[other] - (e - 1.0) * steps[other])
        if not product > 0.0:
            raise RangeError("single pair contact", f"{product:.4g}", "is below a base circle (teeth too short)")
        factors.append(math.tan(pair.working_pressure_angle) / math.sqrt(product))
    m = (factors[0], factors[1])
    part, helical = min(pair.overlap_ratio, 1.0), math.sqrt(tip_relief)
    z_b, z_d = (max(v - part * (v - helical), 1.0) if pair.helix_angle else max(v, 1.0) for v in m)
    return m, (z_b, 1.0 if pair.internal else z_d)  # Z_D of an internal wheel is 1 always (6.2)


def elasticity_factor(pair: PairGeometry) -> float:
    """Z_E [sqrt(Pa)] = sqrt(1 / (pi sum((1 - nu^2)/E))) (ISO 6336-2, clause 7; Eq. 19 of 2006)."""
    return math.sqrt(1.0 / (math.pi * sum((1.0 - g.poisson_ratio**2) / g.young_modulus for g in pair.gears)))


def contact_ratio_factor(contact_ratio: float, overlap_ratio: float) -> float:
    """Z_epsilon (ISO 6336-2, clause 8); overlap counts up to 1.

    Raises
    ------
    RangeError
        If the transverse contact ratio is below 1, or 4 and more without overlap.
    """
    if not contact_ratio >= 1.0:
        raise RangeError("contact ratio", f"{contact_ratio:.4g}", "must be at least 1")
    if overlap_ratio < 0.0:
        raise RangeError("overlap ratio", overlap_ratio, "must not be negative")
    part = min(overlap_ratio, 1.0)
    square = (4.0 - contact_ratio) / 3.0 * (1.0 - part) + part / contact_ratio
    if not square > 0.0:
        raise RangeError(
            "contact ratio", f"{contact_ratio:.4g}", "must be below 4 for Z_epsilon (ISO 6336-2, clause 8)"
        )
    return math.sqrt(square)


def helix_factor(helix_angle: float, form: HelixFactor = "corrected") -> float:
    """Z_beta = 1/sqrt(cos beta) (ISO 6336-2:2006/Cor.1:2008 and 2019, clause 9); sqrt(cos beta) as printed in 2006."""
    root = math.sqrt(math.cos(helix_angle))
    return root if form == "printed in 2006" else 1.0 / root


def nominal_contact_stress(pair: PairGeometry, tangential: float, factors: tuple[float, ...]) -> float:
    """sigma_H0 [Pa] = Z_H Z_E Z_epsilon Z_beta sqrt(F_t (u + 1) / (d_1 b u)) (ISO 6336-2, 5.2).

    Parameters
    ----------
    pair : PairGeometry
    tangential : float
        F_t [N].
    factors : tuple of float
        Z_H, Z_E, Z_epsilon, Z_beta.
    """
    u = pair.signed_ratio
    load = tangential * (u + 1.0) / (pair.diameters[0] * pair.face_width * u)
    return math.prod(factors) * math.sqrt(load)


#: sigma_Hlim between which C_ZL, C_Zv and C_ZR change [Pa].
_SOFT, _HARD = 850e6, 1200e6


#: Gear ratio beyond which Z_W of a harder pinion grows no more.
LARGEST_RATIO = 20.0


@dataclass(frozen=True, slots=True)
class FlankStrength:
    """Permissible contact stress of one gear and its factors.

    Parameters
    ----------
    Z_NT : float
        Life factor of the standard's reference gears at N_L.
    Z_L, Z_v, Z_R, Z_W, Z_X : float
        At reference and beyond; static strength has Z_L = Z_v = Z_R = 1 and Z_W_static.
    Z_W_static : float
    static, reference, permissible : float
        sigma_HP of a safety of 1, static, at N_ref and at N_L [Pa].
    remark : str
    static_rules : bool
        Whether the film would let the flank bear more at many load cycles than its static strength, which holds then.
    """

    Z_NT: float
    Z_L: float
    Z_v: float
    Z_R: float
    Z_W: float
    Z_X: float
    Z_W_static: float
    static: float
    reference: float
    permissible: float
    remark: str = ""
    static_rules: bool = False


def life_knots(strength: Strength) -> Knots:
    """Z_NT of a material: static, knots, reference, 1e10 cycles (ISO 6336-2:2006, table 2).

    With limited pitting the standard's two exponents meet at 1e7 cycles within .5 %; the knot there is the tabled 1.3.
    """
    end = strength.long_life[0]
    if strength.group == "NV (nitrocar.)":
        return Knots((1e5, 2e6, LONG), (1.1, 1.0, end))
    if strength.group in groups.NITRIDED | groups.SOFT_IRON:
        return Knots((1e5, 2e6, LONG), (1.3, 1.0, end))
    if strength.limited_pitting:
        return Knots((6e5, 1e7, 1e9, LONG), (1.6, 1.3, 1.0, end))
    return Knots((1e5, 5e7, LONG), (1.6, 1.0, end))


def between(contact: float, soft: float, hard: float) -> float:
    """Constant of sigma_Hlim [Pa]: `soft` to 850 MPa, `hard` from 1200 MPa, straight in between."""
    part = min(max((contact - _SOFT) / (_HARD - _SOFT), 0.0), 1.0)
    return soft + part * (hard - soft)


def lubricant_factor(contact: float, viscosity: float) -> float:
    """Z_L of the softer material's sigma_Hlim [Pa] and nu_40 [m^2/s] (ISO 6336-2, clause 12; Eq. 37 of 2006)."""
    c = between(contact, 0.83, 0.91)
    return c + 4.0 * (1.0 - c) / (1.2 + 134e-6 / viscosity) ** 2


def velocity_factor(contact: float, velocity: float) -> float:
    """Z_v of the softer material's sigma_Hlim [Pa] and v at the pitch line [m/s] (ISO 6336-2, clause 12; Eq. 42)."""
    c = between(contact, 0.85, 0.93)
    return c + 2.0 * (1.0 - c) / math.sqrt(0.8 + 32.0 / velocity)


def roughness_factor(contact: float, roughness: Both, curvature_radius: float) -> float:
    """Z_R = (3 um / Rz10)^C_ZR, Rz10 the mean Rz of a flank with rho_red = 10 mm (ISO 6336-2, clause 12; Eq. 48)."""
    relative = 0.5 * sum(roughness) * (10e-3 / curvature_radius) ** (1.0 / 3.0)
    return float((3e-6 / relative) ** between(contact, 0.15, 0.08))


def equivalent_roughness(roughness: Both, curvature_radius: float, viscosity: float, velocity: float) -> float:
    """R_zH of a hard pinion's flank [m], 3 to 16 um (ISO 6336-2, 13.2): what it smooths on the soft wheel."""
    hard, soft = roughness
    value = hard * (10e-3 / curvature_radius) ** 0.33 * (hard / soft) ** 0.66
    value /= (velocity * viscosity * 1e6 / 1500.0) ** 0.33
    return min(max(value, 3e-6), 16e-6)


def surface_hardened_factor(hardness: float, equivalent: float) -> tuple[float, float]:
    """Z_W of a through-hardened gear on a surface-hardened one, at reference and static (ISO 6336-2, 13.2).

    Parameters
    ----------
    hardness : float
        Brinell hardness of the softer gear; the standard's range is 130 to 470, its ends hold beyond.
    equivalent : float
        R_zH [m].
    """
    part = (min(max(hardness, 130.0), 470.0) - 130.0) / 340.0
    return float((1.2 - 0.2 * part) * (3e-6 / equivalent) ** 0.15), 1.05 - 0.05 * part


def through_hardened_factor(ratio_of_hardness: float, ratio: float) -> float:
    """Z_W of the wheel on a harder, through-hardened pinion: HB_1/HB_2 and abs(u) (ISO 6336-2, 13.3), at least 1."""
    if ratio_of_hardness < 1.2:
        return 1.0
    slope = 0.00698 if ratio_of_hardness > 1.7 else 0.00898 * ratio_of_hardness - 0.00829
    return max(1.0 + slope * (min(ratio, LARGEST_RATIO) - 1.0), 1.0)


def work_hardening(
    pair: PairGeometry, strength: tuple[Strength, Strength], roughness: Both, viscosity: float, velocity: float
) -> tuple[Both, Both, str]:
    """Z_W of both gears at reference, static, and a remark (ISO 6336-2, clause 13)."""
    hard = [s.group in groups.SURFACE_HARDENED for s in strength]
    reference, static, remark = [1.0, 1.0], [1.0, 1.0], ""
    if hard[0] != hard[1]:
        soft = 1 if hard[0] else 0
        if strength[soft].group not in groups.NORMALIZED | groups.THROUGH_HARDENED:
            return (1.0, 1.0), (1.0, 1.0), ""  # of steels only
        if math.isnan(strength[soft].hardness):
            return (1.0, 1.0), (1.0, 1.0), "Z_W = 1: hardness of the softer gear not specified"
        values = (roughness[1 - soft], roughness[soft])
        equivalent = equivalent_roughness(values, pair.relative_curvature_radius, viscosity, velocity)
        reference[soft], static[soft] = surface_hardened_factor(strength[soft].hardness, equivalent)
        if not 130.0 <= strength[soft].hardness <= 470.0:
            remark = "Z_W: hardness of the softer gear is outside 130 to 470 HB"
    elif all(s.group in groups.THROUGH_HARDENED for s in strength):
        hardness = strength[0].hardness / strength[1].hardness
        if math.isnan(hardness):
            return (1.0, 1.0), (1.0, 1.0), "Z_W = 1: hardness of the gears not specified"
        reference[1] = static[1] = through_hardened_factor(hardness, abs(pair.signed_ratio))
    return (reference[0], reference[1]), (static[0], static[1]), remark


def flank_strength(
    pair: PairGeometry,
    strength: tuple[Strength, Strength],
    quality: tuple[Quality, Quality],
    duty: Duty,
) -> tuple[FlankStrength, FlankStrength]:
    """sigma_HP of both gears for a safety of 1 (ISO 6336-2, 5.3): in between, log-log from static to reference.

    Raises
    ------
    RangeError
        If a pitch line velocity or a load cycle number is not positive.
    """
    velocity = pair.pitch_line_velocity(duty.speed)
    if not velocity > 0.0:
        raise RangeError("pitch line velocity", velocity, "must be positive")
    softer = min(s.contact for s in strength)
    roughness = (quality[0].flank_roughness, quality[1].flank_roughness)
    z_l = lubricant_factor(softer, duty.viscosity)
    z_v = velocity_factor(softer, velocity)
    z_r = roughness_factor(softer, roughness, pair.relative_curvature_radius)
    z_w, z_w_static, remark = work_hardening(pair, strength, roughness, duty.viscosity, velocity)
    found = []
    for i, material in enumerate(strength):
        knots = life_knots(material)
        film = z_l * z_v * z_r * z_w[i]
        # from static to reference the effect of the film comes in along the line in logarithms
        reference = len(knots.cycles) - 2
        whole = math.log(knots.cycles[reference] / knots.cycles[0])
        parts = [math.log(n / knots.cycles[0]) / whole for n in knots.cycles]
        scale = tuple(z_w_static[i] * (film / z_w_static[i]) ** min(p, 1.0) for p in parts)
        unbounded = Knots(knots.cycles, tuple(material.contact * v for v in knots.values)).scaled(scale)
        stress = unbounded.falling
        found.append(
            FlankStrength(
                knots.at(duty.cycles[i]), z_l, z_v, z_r, z_w[i], 1.0, z_w_static[i],
                stress.values[0], stress.values[reference], stress.at(duty.cycles[i]), remark,
                static_rules=stress != unbounded,
            )
        )  # fmt: skip
    return found[0], found[1]
