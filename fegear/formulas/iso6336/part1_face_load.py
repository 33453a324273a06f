"""ISO 6336-1, 7.5: K_Hbeta by method C, from the pinion shaft's deformation, manufacture, modification and running in.

Source: ISO 6336-1:2006 with technical corrigendum 1:2008, 7.5; the edition of 2019 keeps the method. The constants K'
and B_1, B_2 were checked against two public programs that type them from the standard: python-gearbox (E. M. Firvida
Donestevez, doi:10.5281/zenodo.3660527) and MechanicalCalculatorWeb (mekanika.org). Lengths in m, F_m/b in N/m.

ISO 6336-1: face load factors K_Hbeta from a misalignment of the flanks, and K_Fbeta from it.

Source: ISO 6336-1:2006, Calculation of load capacity of spur and helical gears - Part 1, clause 7: the mesh is a row of
equal springs c_gamma_beta that a straight gap keeps apart, so the load over the face is a straight line; what the gap
is after running in, F_betay, is an input.

What K_Hbeta by method C of ISO 6336-1 asks for: the pinion's shaft, what is done to the flanks, what is known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part1_transverse as running_in

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Quality, Strength


#: .023 mm um/N of f_sh and .005 mm um/N of F_betaxmin, in m^2/N.
BENDING, LEAST = 0.023e-9, 0.005e-9


#: K' where the pinion stiffens its shaft and where it does not, and the s/l below which they hold.
SEAT: dict[Arrangement, tuple[float, float, float]] = {
    "a": (0.48, 0.8, 0.3),
    "b": (-0.48, -0.8, 0.3),
    "c": (1.33, 1.33, 0.5),
    "d": (-0.36, -0.6, 0.3),
    "e": (-0.6, -1.0, 0.3),
}


#: d_1/d_sh from which a pinion stiffens its shaft.
STIFFENING = 1.15


#: B_1 and B_2: table 8.
MODIFICATIONS: dict[HelixModification, tuple[float, float]] = {
    "none": (1.0, 1.0),
    "crowned for manufacture": (1.0, 0.5),
    "crowned": (0.5, 0.5),
    "helix corrected": (0.1, 1.0),
    "helix corrected and crowned": (0.1, 0.5),
    "end relief": (0.7, 0.7),
}


#: Lead crowning over f_ma from which it counts in full. Table 8 is for 0.5; drafts and practice have from 0.2 on.
FULL_CROWNING = 0.2


def modification_constants(alignment: Alignment, manufacture: float) -> tuple[float, float]:
    """B_1 and B_2 of table 8; crowning of less than `FULL_CROWNING` f_ma reduces B_2 in proportion to its amount.

    So they are continuous: crowning of 0 is none, and half a micrometre compensates hardly any of f_ma.

    Parameters
    ----------
    alignment : Alignment
    manufacture : float
        f_ma [m].
    """
    b_1, b_2 = MODIFICATIONS[alignment.modification]
    row = _WITHOUT_CROWNING.get(alignment.modification)
    if row is None or alignment.crowning is None or not alignment.crowning < FULL_CROWNING * manufacture:
        return b_1, b_2
    share = alignment.crowning / (FULL_CROWNING * manufacture)
    return b_1, b_2 + (1.0 - share) * (MODIFICATIONS[row][1] - b_2)


#: Rows of table 8 that follow from the leads of a case, and those without their crowning.
_WITHOUT_CROWNING: dict[HelixModification, HelixModification] = {
    "crowned for manufacture": "none",
    "helix corrected and crowned": "helix corrected",
}


@dataclass(frozen=True, slots=True)
class Misalignment:
    """K_Hbeta by method C and what it is made of; [m].

    Parameters
    ----------
    deformation, manufacture : float
        f_sh, f_ma; NaN where K_Hbeta was given.
    constants : (float, float)
        B_1, B_2.
    initial, least : float
        F_betax and its lower bound F_betaxmin.
    run_in : float
        y_beta.
    effective : float
        F_betay.
    K_Hbeta : float
    remark : str
        What lies outside the range that the standard states; empty where nothing does.
    """

    deformation: float
    manufacture: float
    constants: tuple[float, float]
    initial: float
    least: float
    run_in: float
    effective: float
    K_Hbeta: float
    remark: str = ""


def shaft_deformation(shaft: PinionShaft, specific_load: float, width: float, diameter: float) -> tuple[float, str]:
    """f_sh [m] of spur and single helical gears, and a remark (ISO 6336-1:2006, 7.5.2.4, Eq. 57 and figure 13).

    Parameters
    ----------
    shaft : PinionShaft
    specific_load : float
        F_m/b [N/m].
    width, diameter : float
        b, d_1 [m].
    """
    for name, value in (("F_m/b", specific_load), ("b", width), ("d_1", diameter)):
        if not value > 0.0:
            raise RangeError(name, value, "must be positive")
    stiff, free, most = SEAT[shaft.arrangement]
    k = stiff if diameter / shaft.diameter >= STIFFENING else free
    torque = 1.0 + 2.0 * (1.0 - shaft.power_share) / shaft.power_share  # B*
    bending = k * shaft.bearing_span * shaft.offset / diameter**2 * (diameter / shaft.diameter) ** 4
    deformation = specific_load * BENDING * (abs(torque + bending - 0.3) + 0.3) * (width / diameter) ** 2
    place = shaft.offset / shaft.bearing_span
    remarks = []
    if not place < most:
        remarks.append(f"s/l = {place:.3g} exceeds the limit {most:g} of arrangement {shaft.arrangement}")
    if shaft.diameter > diameter:
        remarks.append(
            f"the shaft of {shaft.diameter * 1e3:.4g} mm is thicker than the pinion, {diameter * 1e3:.4g} mm at its "
            "reference circle"
        )
    return deformation, f"f_sh: {'; '.join(remarks)}" if remarks else ""


def manufacturing(quality: tuple[Quality, Quality]) -> float:
    """f_ma of a pair that nothing adjusts [m]: sqrt(f_Hbeta1^2 + f_Hbeta2^2) (ISO 6336-1:2006, Eq. 64)."""
    return math.hypot(quality[0].helix_slope, quality[1].helix_slope)


def initial_misalignment(
    alignment: Alignment, deformation: float, manufacture: float, least: float, helix_slope_5: float
) -> float:
    """F_betax before running in [m] (ISO 6336-1:2006, 7.5.2.2 and 7.5.2.3, Eqs. 52, 53, 55 and 56, with corrigendum 1).

    Table 8 takes a helix modification as one that fits the deformation, B_1 = 0.1. Where it is known what slopes take
    off, the deformation that they leave counts if it is larger: a slope of the wrong direction adds to it.

    Parameters
    ----------
    alignment : Alignment
    deformation, manufacture, least, helix_slope_5 : float
        f_sh, f_ma, F_betaxmin, f_Hbeta5 [m]; the last counts where the contact pattern is favourable.
    """
    b_1, b_2 = modification_constants(alignment, manufacture)
    remaining = b_1 * deformation
    if alignment.against is not None:
        remaining = max(remaining, abs(deformation - alignment.against))
    if alignment.contact_pattern == "verified":
        return least
    if alignment.contact_pattern == "favourable":
        return max(abs(1.33 * remaining - helix_slope_5), least)
    return max(1.33 * remaining + b_2 * manufacture, least)


def method_c(
    pair: PairGeometry,
    alignment: Alignment,
    strength: tuple[Strength, Strength],
    quality: tuple[Quality, Quality],
    specific_load: float,
    stiffness: float,
    velocity: float,
) -> Misalignment:
    """K_Hbeta by method C (ISO 6336-1:2006, 7.5).

    Parameters
    ----------
    pair : PairGeometry
    alignment : Alignment
    strength, quality : pairs
        Of pinion and wheel.
    specific_load : float
        F_m/b = F_t K_A K_gamma K_v / b [N/m].
    stiffness : float
        c_gamma_beta [Pa].
    velocity : float
        v at the reference circle [m/s].

    Raises
    ------
    RangeError
        If neither the shaft nor f_sh nor K_Hbeta is given, or f_Hbeta5 is missing where it counts.
    """
    nan = math.nan
    if alignment.face_load_factor is not None:
        if not alignment.face_load_factor >= 1.0:
            raise RangeError("K_Hbeta", alignment.face_load_factor, "must be at least 1")
        return Misalignment(
            nan, nan, (nan, nan), nan, nan, nan, nan, alignment.face_load_factor, "K_Hbeta: as specified"
        )
    remark = ""
    if alignment.deformation is not None:
        deformation = alignment.deformation
    elif alignment.computed is not None:
        deformation, remark = alignment.computed * specific_load, "f_sh: from the shaft calculation with uniform load"
    elif alignment.shaft is not None:
        deformation, remark = shaft_deformation(alignment.shaft, specific_load, pair.face_width, pair.diameters[0])
    else:
        raise RangeError(
            "alignment",
            "no shaft",
            "K_Hbeta by method C requires the pinion shaft or f_sh",
            "specify the shaft, f_sh or K_Hbeta",
        )
    slope_5 = alignment.helix_slope_5
    if alignment.contact_pattern == "favourable" and slope_5 is None:
        raise RangeError("f_Hbeta5", "missing", "a favourable contact pattern requires the tolerance of grade 5")
    manufacture = manufacturing(quality) if alignment.manufacture is None else alignment.manufacture
    least = max(LEAST * specific_load, 0.5 * max(q.helix_slope for q in quality))
    initial = initial_misalignment(alignment, deformation, manufacture, least, slope_5 or 0.0)
    one, other = (running_in.helix_allowance(s, initial, velocity) for s in strength)
    worn = running_in.mean((one, other))
    factor = face_load_factor(initial - worn, stiffness, specific_load)
    constants = modification_constants(alignment, manufacture)
    return Misalignment(deformation, manufacture, constants, initial, least, worn, initial - worn, factor, remark)


#: b/h counts as at least this in the exponent of K_Fbeta.
_LEAST_WIDTH = 3.0


def face_load_factor(misalignment: float, mesh_stiffness: float, specific_load: float) -> float:
    """K_Hbeta = 1 + F_betay c / (2 F_m / b), or sqrt(2 F_betay c / (F_m / b)) where the face bears on a part only.

    Parameters
    ----------
    misalignment : float
        F_betay, from end to end of the face [m]; its sign does not matter.
    mesh_stiffness : float
        c_gamma_beta per face width [Pa].
    specific_load : float
        F_m / b, mean tangential load per face width [N/m].

    Raises
    ------
    RangeError
        If the stiffness or the load is not positive.
    """
    for name, value in (("c_gamma_beta", mesh_stiffness), ("F_m/b", specific_load)):
        if not value > 0.0:
            raise RangeError(name, f"{value:.4g}", "must be positive")
    relative = abs(misalignment) * mesh_stiffness / (2.0 * specific_load)
    return 1.0 + relative if relative <= 1.0 else 2.0 * math.sqrt(relative)


def root_exponent(width: tuple[float, float], depth: tuple[float, float]) -> float:
    """N_F of K_Fbeta = K_Hbeta^N_F, 1 / (1 + h/b + (h/b)^2), with the smaller b/h of both gears and at least 3.

    Parameters
    ----------
    width : (float, float)
        b, face widths of both gears [m].
    depth : (float, float)
        h, tooth depths from tip to root [m].

    Raises
    ------
    RangeError
        If a width or a depth is not positive.
    """
    for b, h in zip(width, depth, strict=True):
        if not (b > 0.0 and h > 0.0):
            raise RangeError("b/h", f"{b:.4g}/{h:.4g}", "must be positive")
    flat = 1.0 / max(min(b / h for b, h in zip(width, depth, strict=True)), _LEAST_WIDTH)
    return 1.0 / (1.0 + flat + flat * flat)


#: Where a pinion sits between or beside its bearings: figure 13 of ISO 6336-1:2006, a to e.
Arrangement = Literal["a", "b", "c", "d", "e"]


#: What is done to the flanks along the face: table 8 of ISO 6336-1:2006, rows 1 to 6.
HelixModification = Literal[
    "none", "crowned", "crowned for manufacture", "helix corrected", "helix corrected and crowned", "end relief"
]


#: What is known of the contact pattern: nothing, that deformation and manufacture offset each other, that it is ideal.
ContactPattern = Literal["unknown", "favourable", "verified"]


@dataclass(frozen=True, slots=True)
class PinionShaft:
    """The pinion and its shaft (ISO 6336-1, figure 13).

    Parameters
    ----------
    arrangement : {"a", "b", "c", "d", "e"}
    bearing_span : float
        l [m].
    offset : float
        s, of the pinion's middle from that of the span; of an overhung pinion (c) from the nearer bearing [m].
    diameter : float
        d_sh, nominal outside diameter of the shaft that bends [m].
    power_share : float
        Part of the power that goes through this mesh, above 0 to 1 (B*); 1 where all of it does.
    """

    arrangement: Arrangement
    bearing_span: float
    offset: float
    diameter: float
    power_share: float = 1.0

    def __post_init__(self) -> None:
        """Refuse shafts that are none."""
        for name in ("bearing_span", "diameter"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(name, value, "must be positive and finite")
        if not (math.isfinite(self.offset) and self.offset >= 0.0):
            raise RangeError("offset", self.offset, "must be finite and not negative")
        if not 0.0 < self.power_share <= 1.0:
            raise RangeError("power_share", self.power_share, "must be above 0 and at most 1")


@dataclass(frozen=True, slots=True)
class Alignment:
    """What K_Hbeta by method C asks for; lengths [m].

    Parameters
    ----------
    shaft : PinionShaft, optional
        For f_sh; not needed where `deformation` or `face_load_factor` is given.
    deformation : float, optional
        f_sh, if it is known better.
    manufacture : float, optional
        f_ma; by default the root of the sum of squares of both f_Hbeta.
    modification : HelixModification
    contact_pattern : ContactPattern
    helix_slope_5 : float, optional
        f_Hbeta5, tolerance of grade 5, which a favourable contact pattern takes off.
    face_load_factor : float, optional
        K_Hbeta itself, where it is given.
    computed : float, optional
        f_sh over F_m/b of shafts that were computed [m^2/N].
    crowning : float, optional
        C_beta of both gears together, where `modification` follows from it; by default as much as its row requires.
    against : float, optional
        What helix slopes take off f_sh, where their direction is known; negative where they add to it [m]. By default
        they compensate it as their row states, whatever their amount.
    """

    shaft: PinionShaft | None = None
    deformation: float | None = None
    manufacture: float | None = None
    modification: HelixModification = "none"
    contact_pattern: ContactPattern = "unknown"
    helix_slope_5: float | None = None
    face_load_factor: float | None = None
    computed: float | None = None
    crowning: float | None = None
    against: float | None = None
