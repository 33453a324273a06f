"""ISO 6336-2: the contact stress of a pair: Z_H, Z_B, Z_D, Z_E, Z_epsilon, Z_beta, sigma_H0, sigma_H.

Source: ISO 6336-2:2006, clauses 5 to 9, and IACS UR M56 (Rev. 4), M56.2, which repeats ISO 6336-2:2019 but for f_ZCa.
Two things moved between editions: Z_beta, printed as sqrt(cos beta) in 2006 and corrected to 1/sqrt(cos beta) by
technical corrigendum 1:2008; and Z_B, Z_D of helical gears, which 2019 raises by f_ZCa where tips are not relieved (its
values are recalled: no public text that repeats them was at hand, and a rating remarks on it).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from fegear.errors import RangeError

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Both

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
    "f_ZCa: {value:g} of helical flanks {tips} is recalled from memory, for no printed source was at hand; it "
    "multiplies the contact stress by its square root where the overlap ratio is 1 and more (tip_relief_factor of "
    "iso_6336)"
)
TIPS: dict[TipRelief, str] = {
    "none": "without tip relief", "experience": "with tip relief by experience", "computed": "with a computed relief",
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
        for g, d_b in zip(pair.gears, pair.base_diameters, strict=True)
    ]
    steps = [2.0 * math.pi / g.teeth for g in pair.gears]
    factors = []
    for one, other in ((0, 1), (1, 0)):
        product = (tips[one] - steps[one]) * (tips[other] - (e - 1.0) * steps[other])
        if not product > 0.0:
            raise RangeError(
                "single pair contact", f"{product:.4g}", "lies below a base circle: the teeth are too short"
            )
        factors.append(math.tan(pair.working_pressure_angle) / math.sqrt(product))
    m = (factors[0], factors[1])
    if pair.helix_angle == 0.0:
        return m, (max(m[0], 1.0), max(m[1], 1.0))
    part, helical = min(pair.overlap_ratio, 1.0), math.sqrt(tip_relief)
    z_b, z_d = (max(v - part * (v - helical), 1.0) for v in m)
    return m, (z_b, z_d)


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
    u = pair.ratio
    load = tangential * (u + 1.0) / (pair.diameters[0] * pair.face_width * u)
    return math.prod(factors) * math.sqrt(load)
