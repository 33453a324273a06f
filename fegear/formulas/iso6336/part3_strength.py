"""ISO 6336-3: what the tooth root bears: Y_NT, Y_ST, Y_deltarelT, Y_RrelT, Y_X, Y_M and sigma_FP.

Source: ISO 6336-3:2006, clauses 12 to 15 and annex B, which the edition of 2019 keeps; reference values of
Y_deltarelT, Y_RrelT and Y_X as in IACS UR M56 (Rev. 4), M56.3.11 to 3.13 (whose Y_X of normalized and through-hardened
steels, 1.03 - .06 m_n, is a misprint of 1.03 - .006 m_n: it must meet .85 at 30 mm). Stresses in Pa, lengths in m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part5_materials as groups
from fegear.formulas.iso6336.life import LONG, Knots

if TYPE_CHECKING:
    from fegear.formulas.iso6336.part5_materials import Group
    from fegear.formulas.iso6336.rated import Strength

#: Y_ST, stress correction factor of the reference gears.
STANDARD_GEAR = 2.0
#: Load cycles of the reference strength.
REFERENCE = 3e6
#: q_sT, notch parameter of the reference gears.
REFERENCE_NOTCH = 2.5
#: Slip-layer thickness rho' [mm] over yield (St, V, tough iron) or tensile strength (soft iron) [MPa]: table 3.
_LAYER_ST = ((300.0, 0.0833), (400.0, 0.0445))
_LAYER_V = ((500.0, 0.0281), (600.0, 0.0194), (800.0, 0.0064), (1000.0, 0.0014))
_LAYER_GG = ((150.0, 0.3124), (300.0, 0.3095))


@dataclass(frozen=True, slots=True)
class RootStrength:
    """Permissible tooth root stress of one gear and its factors.

    Parameters
    ----------
    Y_NT, Y_deltarelT, Y_RrelT, Y_X, Y_M : float
        At N_L; notch, surface, size and mean stress at reference.
    Y_deltarelT_static, Y_M_static : float
    static, reference, permissible : float
        sigma_FP of a safety of 1, static, at 3e6 cycles and at N_L [Pa].
    remark : str
    """

    Y_NT: float
    Y_deltarelT: float
    Y_RrelT: float
    Y_X: float
    Y_M: float
    Y_deltarelT_static: float
    Y_M_static: float
    static: float
    reference: float
    permissible: float
    remark: str = ""


def life_knots(strength: Strength) -> Knots:
    """Y_NT of a material: static, 3e6, 1e10 cycles (ISO 6336-3:2006, table 1)."""
    end = strength.long_life[1]
    if strength.group == "NV (nitrocar.)":
        return Knots((1e3, REFERENCE, LONG), (1.1, 1.0, end))
    if strength.group in groups.NITRIDED | groups.SOFT_IRON:
        return Knots((1e3, REFERENCE, LONG), (1.6, 1.0, end))
    if strength.group in groups.CASE_HARDENED:
        return Knots((1e3, REFERENCE, LONG), (2.5, 1.0, end))
    return Knots((1e4, REFERENCE, LONG), (2.5, 1.0, end))


def _table(table: tuple[tuple[float, float], ...], strength: float, what: str) -> tuple[float, str]:
    """rho' [mm], linear in the strength; the ends of the table, and a remark, beyond it."""
    if math.isnan(strength):
        return min(layer for _, layer in table), f"rho': {what} not specified, minimum value used"
    mega, (low, high) = strength / 1e6, (table[0][0], table[-1][0])
    note = "" if low <= mega <= high else f"rho': {what} of {mega:.4g} MPa is outside {low:g} to {high:g} MPa"
    strengths, layers = zip(*table, strict=True)
    return float(np.interp(mega, strengths, layers)), note


def slip_layer(strength: Strength) -> tuple[float, str]:
    """rho' [m] and a remark (ISO 6336-3:2006, table 3)."""
    group = strength.group
    if group in groups.CASE_HARDENED:
        value, remark = 0.0030, ""
    elif group in groups.NITRIDED:
        value, remark = 0.1005, ""
    elif group in groups.SOFT_IRON:
        value, remark = _table(_LAYER_GG, strength.tensile_strength, "the tensile strength")
    elif group in groups.NORMALIZED:
        value, remark = _table(_LAYER_ST, strength.yield_strength, "the yield strength")
    else:
        value, remark = _table(_LAYER_V, strength.yield_strength, "the yield strength")
    return value * 1e-3, remark


def notch_sensitivity(notch: float, layer: float) -> float:
    """Y_deltarelT at reference of q_s and rho' [m] (ISO 6336-3, clause 13; Eq. 49 of 2006)."""
    gradient, reference = 0.2e3 * (1.0 + 2.0 * notch), 0.2e3 * (1.0 + 2.0 * REFERENCE_NOTCH)
    return (1.0 + math.sqrt(layer * gradient)) / (1.0 + math.sqrt(layer * reference))


def static_notch_sensitivity(strength: Strength, stress_correction: float) -> float:
    """Y_deltarelT of static strength, of Y_S (ISO 6336-3:2006, clause 13); unknown yield: 1000 MPa."""
    group = strength.group
    if group in groups.CASE_HARDENED:
        return 0.44 * stress_correction + 0.12
    if group in groups.NITRIDED:
        return 0.20 * stress_correction + 0.60
    if group in groups.SOFT_IRON:
        return 1.0
    mega = 1000.0 if math.isnan(strength.yield_strength) else strength.yield_strength / 1e6
    part = 0.93 * (200.0 / mega) ** 0.25 if group in groups.NORMALIZED else 0.82 * (300.0 / mega) ** 0.25
    return float((1.0 + part * (stress_correction - 1.0)) / (1.0 + part))


def surface_factor(group: Group, roughness: float) -> tuple[float, str]:
    """Y_RrelT of the root's Rz [m], and a remark beyond 40 um (ISO 6336-3, clause 14; table 4 of 2006)."""
    rz = roughness * 1e6
    remark = f"Y_RrelT: Rz = {rz:.3g} um of the root is above 40 um" if rz > 40.0 else ""
    if group in groups.NORMALIZED:
        value = 1.07 if rz < 1.0 else 5.306 - 4.203 * (rz + 1.0) ** 0.01
    elif group in groups.NITRIDED | groups.SOFT_IRON:
        value = 1.025 if rz < 1.0 else 4.299 - 3.259 * (rz + 1.0) ** 0.0058
    else:
        value = 1.12 if rz < 1.0 else 1.674 - 0.529 * (rz + 1.0) ** 0.1
    return float(value), remark


def size_factor(group: Group, module: float) -> float:
    """Y_X at reference of m_n [m]; 1 up to 5 mm and for static strength (ISO 6336-3, clause 15; table 5 of 2006)."""
    mm = module * 1e3
    if mm <= 5.0:
        return 1.0
    if group in groups.SURFACE_HARDENED:
        return max(1.05 - 0.010 * mm, 0.80)
    if group in groups.SOFT_IRON:
        return max(1.075 - 0.015 * mm, 0.70)
    return max(1.03 - 0.006 * mm, 0.85)


def mean_stress_ratio(group: Group, stress_correction: float, *, static: bool = False, peened: bool = False) -> float:
    """M, how far a mean stress lowers what alternating load is borne (ISO 6336-3:2006, table B.1)."""
    if group in groups.NITRIDED:
        return 0.3
    if group == "Eh":
        if peened:
            return 0.6 if static else 0.4
        return 0.7 if static else 0.8 - 0.15 * stress_correction
    if group == "IF" or group in {"St (cast)", "V (cast)"} | groups.TOUGH_IRON | groups.SOFT_IRON:
        return 0.6 if static else 0.4
    return 0.5 if static else 0.3


def mean_stress_factor(ratio: float, stress_ratio: float) -> float:
    """Y_M = 1 / (1 - R (1 - M)/(1 + M)) (ISO 6336-3:2006, annex B).

    Parameters
    ----------
    ratio : float
        M, see `mean_stress_ratio`.
    stress_ratio : float
        R, lowest over highest stress: 0 pulsating; of idlers -1.2 times the load of the lightly over that of the
        heavily loaded flank.

    Raises
    ------
    RangeError
        If R is not between -1.2 and .5, or M not between 0 and 1.
    """
    if not -1.2 <= stress_ratio < 0.5:
        raise RangeError("stress ratio R", stress_ratio, "must be between -1.2 and 0.5 (ISO 6336-3, B.2)")
    if not 0.0 <= ratio <= 1.0:
        raise RangeError("mean stress ratio M", ratio, "must be between 0 and 1")
    return 1.0 / (1.0 - stress_ratio * (1.0 - ratio) / (1.0 + ratio))


def root_strength(
    strength: Strength,
    module: float,
    roughness: float,
    notch: tuple[float, float],
    cycles: float,
    mean_stress: tuple[float, float] = (1.0, 1.0),
) -> RootStrength:
    """sigma_FP of one gear for a safety of 1 (ISO 6336-3, 5.3): in between, log-log from static to reference.

    Parameters
    ----------
    strength : Strength
    module, roughness : float
        m_n; Rz of the root [m].
    notch : (float, float)
        q_s and Y_S of the critical section.
    cycles : float
        N_L.
    mean_stress : (float, float)
        Y_M of static strength and of endurance, whose M differ.
    """
    layer, unsure = slip_layer(strength)
    delta = notch_sensitivity(notch[0], layer)
    static = static_notch_sensitivity(strength, notch[1])
    surface, rough = surface_factor(strength.group, roughness)
    size = size_factor(strength.group, module)
    knots = life_knots(strength)
    whole = delta * surface * size
    base, endured = strength.bending * STANDARD_GEAR, whole * mean_stress[1]
    stress = Knots(knots.cycles, tuple(base * v for v in knots.values))
    stress = stress.scaled((static * mean_stress[0], endured, endured)).falling
    recalled = ""
    if cycles < REFERENCE and strength.group not in groups.CASE_HARDENED:
        recalled = (
            f"Y_deltarelT: static value for {strength.group} (below 3e6 load cycles) is not verified against a "
            "printed source"
        )
    remark = "; ".join(r for r in (unsure, rough, recalled) if r)
    return RootStrength(
        knots.at(cycles), delta, surface, size, mean_stress[1], static, mean_stress[0],
        stress.values[0], stress.values[1], stress.at(cycles), remark,
    )  # fmt: skip
