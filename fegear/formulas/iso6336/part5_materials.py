"""ISO 6336-5: allowable stress numbers sigma_Hlim and sigma_Flim of gear materials by kind, quality and hardness.

Source: ISO 6336-5:2016, 5.5 and table 1: straight lines over the surface hardness, each for a range of it. The lines
stand in ``part5_table1.csv``, each with its row of the table. Hardness is in HV here, HBW = 0.95 HV (ISO 18265).

ISO 6336-5: the groups of materials, by the standard's own letters; parts 1, 2 and 3 choose their factors by them.

How deep the case of surface-hardened teeth should be: ISO 6336-5 and ANSI/AGMA 2101-D04.

All numbers of this module are recalled: printed papers name both standards' rules, none at hand has their equations.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType
from typing import Literal

from fegear.base.errors import RangeError
from fegear.geometry.pair import GearPair

Quality = Literal["ML", "MQ", "ME"]


Stress = Literal["contact", "bending"]


#: HBW of one HV.
BRINELL = 0.95


#: A hardness may miss the end of a range by so much: the standard's 660 HV or 58 HRC and 600 HV or 55 HRC of
#: case-hardened steel are 654 and 597 HV by the table of ISO 18265.
_CONVERSION = 0.01


#: 25, 28 and 30 HRC in HV (ISO 18265, table A.1), by which case-hardened cores of quality MQ are distinguished.
HRC_25, HRC_28, HRC_30 = 266.25, 286.4285714285714, 301.6666666666667


#: Letters of each material in the standard. Ferritic nodular iron has the laws of the pearlitic and bainitic one, and
#: the life and notch factors of grey iron.
MATERIALS: Mapping[str, Group] = MappingProxyType(
    {
        "normalized-steel": "St",
        "normalized-cast-steel": "St (cast)",
        "malleable-iron": "GTS (perl.)",
        "nodular-iron": "GGG (perl.)",
        "ferritic-nodular-iron": "GGG (ferr.)",
        "grey-iron": "GG",
        "through-hardened-carbon-steel": "V",
        "through-hardened-alloy-steel": "V",
        "through-hardened-cast-carbon-steel": "V (cast)",
        "through-hardened-cast-alloy-steel": "V (cast)",
        "case-hardened-steel": "Eh",
        "induction-hardened-steel": "IF",
        "nitrided-nitriding-steel": "NT (nitr.)",
        "nitrided-through-hardening-steel": "NV (nitr.)",
        "nitrocarburized-steel": "NV (nitrocar.)",
    }
)


#: Materials that share the laws of another one.
_LAWS_OF = {"ferritic-nodular-iron": "nodular-iron"}


#: Rows of the table that are levels at which another row ends, and stand in no text at hand.
_NOT_IN_PRINT = frozenset({70, 73})


@dataclass(frozen=True, slots=True)
class Law:
    """One row of table 1: sigma = slope x + level.

    Parameters
    ----------
    row : int
        Of the table.
    slope, level : float
        A [Pa per HV] and B [Pa].
    lowest, highest : float
        Range of the hardness [HV].
    """

    row: int
    slope: float
    level: float
    lowest: float
    highest: float

    def at(self, hardness: float) -> float:
        """Stress number of a hardness [HV] inside the range [Pa]."""
        return self.slope * hardness + self.level


@dataclass(frozen=True, slots=True)
class Allowable:
    """A stress number with where it comes from.

    Parameters
    ----------
    stress : float
        sigma_Hlim or sigma_Flim [Pa].
    row : int
        Of table 1.
    remark : str
        What was assumed; empty where nothing was.
    """

    stress: float
    row: int
    remark: str = ""


@cache
def _table() -> Mapping[tuple[str, Stress, Quality], tuple[Law, ...]]:
    text = resources.files("fegear.formulas.iso6336").joinpath("part5_table1.csv").read_text("utf-8")
    laws: dict[tuple[str, Stress, Quality], tuple[Law, ...]] = {}
    for one in csv.DictReader(line for line in text.splitlines() if not line.startswith("#")):
        scale = BRINELL if one["scale"] == "HBW" else 1.0
        law = Law(
            int(one["row"]), float(one["A"]) * scale * 1e6, float(one["B"]) * 1e6,
            float(one["lowest"]) / scale, float(one["highest"]) / scale,
        )  # fmt: skip
        stress: Stress = "contact" if one["stress"] == "contact" else "bending"
        for quality in one["quality"].split():
            name: Quality = "ML" if quality == "ML" else "MQ" if quality == "MQ" else "ME"
            key = (one["material"], stress, name)
            laws[key] = (*laws.get(key, ()), law)
    return MappingProxyType(laws)


def laws(material: str, stress: Stress, quality: Quality) -> tuple[Law, ...]:
    """Rows of table 1 for a material, in order of hardness; three for the root of case-hardened steel, MQ, by the core.

    Raises
    ------
    RangeError
        If the material is none of `MATERIALS`.
    """
    if material not in MATERIALS:
        raise RangeError("material", f'"{material}"', f"must be one of {', '.join(MATERIALS)}")
    return _table()[_LAWS_OF.get(material, material), stress, quality]


def usual_hardness(material: str, quality: Quality) -> float:
    """The middle of the range that the laws of flank and root share [HV]."""
    both = [laws(material, stress, quality) for stress in ("contact", "bending")]
    lowest = max(some[0].lowest for some in both)
    return 0.5 * (lowest + min(some[-1].highest for some in both))


def allowable(
    material: str,
    stress: Stress,
    quality: Quality,
    hardness: float | None = None,
    *,
    core_hardness: float | None = None,
    jominy_12: float | None = None,
) -> Allowable:
    """sigma_Hlim or sigma_Flim of a material.

    Parameters
    ----------
    material : str
        One of `MATERIALS`.
    stress : {"contact", "bending"}
        sigma_Hlim of the flanks or sigma_Flim of the roots.
    quality : {"ML", "MQ", "ME"}
    hardness : float, optional
        Of the surface [HV]; without, the middle of the range. Above the range the value at its end holds, as the
        standard's figures go on to no higher one.
    core_hardness, jominy_12 : float, optional
        Of case-hardened steel, MQ [HV]: hardness of the core and 12 mm from the end of a Jominy bar.

    Raises
    ------
    RangeError
        If the hardness lies below the range of the material and quality, by more than conversions of hardness differ.
    """
    rows = laws(material, stress, quality)
    known = usual_hardness(material, quality) if hardness is None else hardness
    remark = f"hardness {known:.4g} HV assumed (middle of the range)" if hardness is None else ""
    if material == "case-hardened-steel" and stress == "bending" and quality == "MQ":
        row, told = _core(core_hardness, jominy_12)
        rows, remark = (rows[row],), "; ".join(one for one in (remark, told) if one)
    if known < rows[0].lowest * (1.0 - _CONVERSION):
        raise RangeError(
            "hardness", f"{known:.4g} HV",
            f"is below {rows[0].lowest:.4g} HV, the lower limit of ISO 6336-5 for {material}, quality {quality}",
            "specify another quality or material, or user-defined stress numbers",
        )  # fmt: skip
    known = max(known, rows[0].lowest)
    law = next((one for one in rows if known <= one.highest), rows[-1])
    if known > law.highest * (1.0 + _CONVERSION):
        end = f"{known:.4g} HV is above the range of ISO 6336-5; limit value {law.highest:.4g} HV used"
        remark = "; ".join(one for one in (remark, end) if one)
    if law.row in _NOT_IN_PRINT:
        level = (
            f"the level of {law.level * 1e-6:.4g} MPa above {law.lowest:.4g} HV is not verified against a "
            "printed source"
        )
        remark = "; ".join(one for one in (remark, level) if one)
    return Allowable(law.at(min(known, law.highest)), law.row, remark)


def _core(core: float | None, jominy: float | None) -> tuple[int, str]:
    """Which of the three rows holds, and what was assumed (ISO 6336-5, figure 10)."""
    if core is None:
        return 0, "core hardness of 25 HRC assumed"
    if core < HRC_25 * (1.0 - 1e-9):
        raise RangeError(
            "core_hardness", f"{core:.4g} HV", "is below 25 HRC, the minimum of ISO 6336-5 for quality MQ", 'use "ML"'
        )
    if core >= HRC_30 * (1.0 - 1e-9):
        return 2, ""
    return (1 if jominy is not None and jominy >= HRC_28 * (1.0 - 1e-9) else 0), ""


#: St: normalized low carbon steels, wrought or cast. GTS: black malleable cast iron. GGG: nodular cast iron. GG: grey
#: cast iron. V: through-hardened wrought or cast steels. Eh: case-hardened. IF: flame or induction hardened.
#: NT (nitr.): nitriding steels, nitrided. NV (nitr.), NV (nitrocar.): through-hardening or case-hardening steels,
#: nitrided or nitrocarburized (ISO 6336-5:2016, table 1).
Group = Literal[
    "St", "St (cast)", "GTS (perl.)", "GGG (perl.)", "GGG (bai.)", "GGG (ferr.)", "GG", "V", "V (cast)", "Eh", "IF",
    "NT (nitr.)", "NV (nitr.)", "NV (nitrocar.)",
]  # fmt: skip


NORMALIZED: frozenset[Group] = frozenset({"St", "St (cast)"})


THROUGH_HARDENED: frozenset[Group] = frozenset({"V", "V (cast)"})


TOUGH_IRON: frozenset[Group] = frozenset({"GTS (perl.)", "GGG (perl.)", "GGG (bai.)"})


SOFT_IRON: frozenset[Group] = frozenset({"GG", "GGG (ferr.)"})


CASE_HARDENED: frozenset[Group] = frozenset({"Eh", "IF"})


NITRIDED: frozenset[Group] = frozenset({"NT (nitr.)", "NV (nitr.)", "NV (nitrocar.)"})


#: Steels whose flanks are harder than their core.
SURFACE_HARDENED = CASE_HARDENED | NITRIDED


GROUPS: frozenset[Group] = NORMALIZED | THROUGH_HARDENED | TOUGH_IRON | SOFT_IRON | SURFACE_HARDENED


#: Usual case depths at 550 HV of finished flanks, and the largest one, in normal modules; that is at most 6 mm.
USUAL, LARGEST, DEEPEST = (0.15, 0.25), 0.4, 6e-3
#: U_H of ISO 6336-5 by quality of case-carburized steel [Pa].
ISO_CRUSHING = {"ML": 44e9, "MQ": 66e9, "ME": 66e9}
#: U_H of AGMA 2101: carburized, and hardened by induction tooth by tooth [Pa].
AGMA_CRUSHING = {"carburized": 44e9, "induction-hardened": 30e9}


def crushing_depth(pair: GearPair, contact_stress: float, hardening: float) -> float:
    """Eht_c = sigma_H d_w1 sin(alpha_wt) abs(z2 / (z1 + z2)) / (U_H cos(beta_b)), below which the case is crushed [m].

    The same form stands for ISO 6336-5 and for h_e,min of AGMA 2101.

    Parameters
    ----------
    pair : GearPair
    contact_stress : float
        sigma_H of the standard [Pa].
    hardening : float
        U_H of the standard [Pa].
    """
    one, two = pair.driver, pair.driven
    angle = pair.working_pressure_angle
    diameter = 2.0 * one.base_radius / math.cos(angle)
    share = two.teeth / abs(one.teeth * pair.side + two.teeth)
    return contact_stress * diameter * math.sin(angle) * share / (hardening * math.cos(one.base_helix_angle))


def recommended(normal_module: float) -> tuple[float, float, float]:
    """Least and largest usual case depth, and the one not to exceed [m]."""
    least, most = (factor * normal_module for factor in USUAL)
    return least, most, min(LARGEST * normal_module, DEEPEST)
