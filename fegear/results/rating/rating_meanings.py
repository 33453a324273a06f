"""What the symbols of ISO 6336 mean, for the table of the result ``rating``; and in which units engineers read them."""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

MEANINGS: Mapping[str, str] = MappingProxyType(
    {
        "F_t": "nominal tangential load at the reference circle",
        "v": "pitch line velocity at the reference circle",
        "u": "gear ratio",
        "alpha_wt": "working transverse pressure angle",
        "epsilon_alpha": "transverse contact ratio",
        "epsilon_beta": "overlap ratio",
        "epsilon_gamma": "total contact ratio",
        "K_A": "application factor",
        "K_gamma": "mesh load factor",
        "N_L": "load cycles",
        "C_R": "gear blank factor",
        "c'_th": "theoretical single stiffness",
        "c'": "single stiffness",
        "c_gamma_alpha": "mean mesh stiffness",
        "c_gamma_beta": "mesh stiffness for the face load factor",
        "f_pb": "transverse base pitch deviation",
        "f_falpha": "profile form deviation",
        "y_alpha": "running-in allowance of the pitch",
        "m_red": "reduced mass per face width",
        "n_E1": "resonance speed of the pinion",
        "N": "resonance ratio",
        "N_S": "lower limit of the resonance range",
        "y_p": "running-in allowance of the pitch, for K_v",
        "y_f": "running-in allowance of the profile, for K_v",
        "C_a": "tip relief, from design or running in",
        "B_p": "effect of pitch deviations on K_v",
        "B_f": "effect of profile deviations on K_v",
        "B_k": "effect of tip relief on K_v",
        "K_v": "dynamic factor",
        "F_m/b": "line load with K_A, K_gamma and K_v",
        "f_sh": "misalignment from deformation of the shafts",
        "f_ma": "misalignment from manufacture",
        "B_1": "constant of the helix modification, for deformation",
        "B_2": "constant of the helix modification, for manufacture",
        "F_betaxmin": "least misalignment before running in",
        "F_betax": "misalignment before running in",
        "y_beta": "running-in allowance of the misalignment",
        "F_betay": "misalignment after running in",
        "K_Hbeta": "face load factor, contact",
        "N_F": "exponent of K_Fbeta",
        "K_Fbeta": "face load factor, root",
        "K_Halpha": "transverse load factor, contact",
        "K_Falpha": "transverse load factor, root",
        "Z_H": "zone factor",
        "Z_E": "elasticity factor",
        "Z_epsilon": "contact ratio factor",
        "Z_beta": "helix angle factor, contact",
        "f_ZCa": "tip relief factor",
        "M": "M_1, M_2: pressure at the inner single contact point over that at the pitch point",
        "Z_BD": "single pair tooth contact factors Z_B, Z_D",
        "sigma_H0": "nominal contact stress at the pitch point",
        "sigma_H": "contact stress",
        "sigma_Hlim": "allowable stress number, contact",
        "Z_NT": "life factor, contact",
        "Z_L": "lubricant factor",
        "Z_v": "velocity factor",
        "Z_R": "roughness factor",
        "Z_W": "work hardening factor",
        "Z_X": "size factor, contact",
        "sigma_HG_static": "pitting stress limit, static",
        "sigma_HG_reference": "pitting stress limit at the knee of the life line",
        "sigma_HG": "pitting stress limit at N_L",
        "S_Hmin": "required safety against pitting",
        "sigma_HP": "permissible contact stress, sigma_HG / S_Hmin",
        "z_n": "teeth of the virtual spur gear",
        "epsilon_alpha_n": "transverse contact ratio of the virtual pair",
        "d_en": "virtual diameter at the outer point of single pair contact",
        "alpha_Fen": "load direction angle",
        "h_Fe": "bending moment arm",
        "s_Fn": "chord at the critical section",
        "rho_F": "fillet radius at the critical section",
        "f_epsilon": "load distribution factor",
        "Y_F": "form factor",
        "q_s": "notch parameter",
        "Y_S": "stress correction factor",
        "Y_beta": "helix angle factor, root",
        "Y_B": "rim thickness factor",
        "Y_DT": "deep tooth factor",
        "sigma_F0": "nominal root stress",
        "sigma_F": "root stress",
        "sigma_Flim": "nominal stress number, bending",
        "Y_ST": "stress correction factor of the test gears",
        "Y_NT": "life factor, root",
        "Y_deltarelT": "relative notch sensitivity factor",
        "Y_RrelT": "relative surface factor",
        "Y_X": "size factor, root",
        "Y_M": "mean stress influence factor of endurance",
        "Y_M_static": "mean stress influence factor of static strength",
        "sigma_FG_static": "root stress limit, static",
        "sigma_FG_reference": "root stress limit at the knee of the life line",
        "sigma_FG": "root stress limit at N_L",
        "S_Fmin": "required safety against breakage of the tooth root",
        "sigma_FP": "permissible root stress, sigma_FG / S_Fmin",
        "S_H": "safety against pitting",
        "S_F": "safety against breakage of the tooth root",
        "S_H_static": "safety against pitting, static",
        "S_F_static": "safety against breakage of the tooth root, static",
        "S_H_reference": "safety against pitting at the knee of the life line",
        "S_F_reference": "safety against breakage of the tooth root at the knee of the life line",
        **{f"C_v{i}": "coefficient of K_v" for i in range(1, 8)},
    }
)
#: What the symbols of ANSI/AGMA 2101-D04 mean, with those of the inch edition (2001) where they differ.
AGMA_MEANINGS: Mapping[str, str] = MappingProxyType(
    {
        "F_t": "tangential load at the operating pitch circle",
        "v_t": "pitch line velocity",
        "K_o": "overload factor",
        "K_v": "dynamic factor",
        "K_Hmc": "lead correction factor, C_mc",
        "K_Hpf": "pinion proportion factor, C_pf",
        "K_Hpm": "pinion proportion modifier, C_pm",
        "K_Hma": "mesh alignment factor, C_ma",
        "K_He": "mesh alignment correction factor, C_e",
        "K_H": "load distribution factor, K_m",
        "Z_E": "elastic coefficient, C_p",
        "Z_R": "surface condition factor, C_f",
        "Z_I": "geometry factor for pitting, I",
        "Y_Z": "reliability factor, K_R",
        "Y_theta": "temperature factor, K_T",
        "K_s": "size factor",
        "K_B": "rim thickness factor",
        "Y_J": "geometry factor for bending, J",
        "sigma_H": "contact stress, s_c",
        "sigma_F": "bending stress, s_t",
        "sigma_HP": "allowable contact stress number, s_ac",
        "sigma_FP": "allowable bending stress number, s_at",
        "Z_N": "stress cycle factor for pitting",
        "Y_N": "stress cycle factor for bending",
        "Z_W": "hardness ratio factor, C_H",
        "S_H": "safety factor for pitting",
        "S_F": "safety factor for bending",
    }
)
#: Units of its factors as engineers read them, and by how much a number in SI is multiplied.
AGMA_UNITS: Mapping[str, tuple[str, float]] = MappingProxyType(
    {"": ("", 1.0), "N": ("N", 1.0), "m/s": ("m/s", 1.0), "Pa": ("MPa", 1e-6), "sqrt(Pa)": ("MPa^0.5", 1e-3)}
)
#: Stiffnesses, which are pressures in SI.
_STIFFNESSES = ("c'_th", "c'", "c_gamma_alpha", "c_gamma_beta")
#: Lengths that are dimensions, not deviations.
_DIMENSIONS = ("d_en", "h_Fe", "s_Fn", "rho_F")
#: Units of SI as engineers read them, and by how much a number in SI is multiplied.
_READ: Mapping[str, tuple[str, float]] = MappingProxyType(
    {
        "": ("", 1.0), "N": ("N", 1.0), "m/s": ("m/s", 1.0), "Pa": ("MPa", 1e-6), "m": ("um", 1e6),
        "rad": ("deg", 180.0 / math.pi), "rad/s": ("rpm", 30.0 / math.pi), "N/m": ("N/mm", 1e-3),
        "kg/m": ("kg/mm", 1e-3), "Pa^0.5": ("MPa^0.5", 1e-3),
    }
)  # fmt: skip


def read_as(symbol: str, unit: str) -> tuple[str, float]:
    """Unit in which a factor is read, and what an SI number is multiplied by."""
    if symbol in _STIFFNESSES:
        return "N/(mm.um)", 1e-9
    if symbol in _DIMENSIONS:
        return "mm", 1e3
    return _READ[unit]
