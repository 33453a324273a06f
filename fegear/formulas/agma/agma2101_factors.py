"""Factors of ANSI/AGMA 2101-D04: K_v, K_H, K_B, Z_E, Z_W, Z_N, Y_N, Y_Z, each with its clause.

Source: ANSI/AGMA 2101-D04, Fundamental Rating Factors and Calculation Methods for Involute Spur and Helical Gear Teeth
(metric edition), clauses 5, 8, 12, 14, 15, 17 and 18. SI in and out; the standard's own millimetres stay inside.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from fegear.base.errors import RangeError

Enclosure = Literal["open", "commercial", "precision", "extra-precision"]
#: A, B [1/mm], C [1/mm^2] of K_Hma (clause 15, table 2).
_ALIGNMENT: dict[str, tuple[float, float, float]] = {
    "open": (0.247, 0.657e-3, -1.186e-7),
    "commercial": (0.127, 0.622e-3, -1.69e-7),
    "precision": (0.0675, 0.504e-3, -1.44e-7),
    "extra-precision": (0.0380, 0.402e-3, -1.27e-7),
}
#: Reliability and Y_Z (clause 18, table 11).
_RELIABILITY = ((0.5, 0.70), (0.9, 0.85), (0.99, 1.0), (0.999, 1.25), (0.9999, 1.5))
#: Fewest cycles of the curves, where Z_N ends, and where Y_N and Z_N bend.
_FEWEST, _Z_START, _Y_KNEE, _Z_KNEE = 1e2, 1e4, 3e6, 1e7
#: Y_N = a N^-b below the knee by hardness [HB] of through-hardened steel, and of cases (clause 17, figure 18).
_Y_THROUGH = ((160.0, 2.3194, 0.0538), (250.0, 4.9404, 0.1045), (400.0, 9.4518, 0.148))
_Y_CARBURIZED, _Y_NITRIDED = (6.1514, 0.1192), (3.517, 0.0817)

Curve = Literal["upper", "lower"]


def dynamic_factor(speed: float, accuracy: int) -> float:
    """K_v = (C / (C + sqrt(196.85 v_t)))^-B, B = .25 (A_v - 5)^.667, C = 50 + 56 (1 - B) (clause 8).

    Parameters
    ----------
    speed : float
        v_t, pitch line velocity [m/s].
    accuracy : int
        A_v, transmission accuracy level, 6 to 12 (fine to coarse). The quality number of the edition of 1995 is
        Q_v = 17 - A_v.

    Raises
    ------
    RangeError
        If the level is not between 6 and 12 or the velocity above (C + 14 - A_v)^2 / 196.85.
    """
    if not 6 <= accuracy <= 12:
        raise RangeError("A_v", accuracy, "must be 6 to 12 (ANSI/AGMA 2101-D04, clause 8)", "specify K_v")
    b = 0.25 * (accuracy - 5.0) ** 0.667
    c = 50.0 + 56.0 * (1.0 - b)
    fastest = (c + 14.0 - accuracy) ** 2 / 196.85
    if not 0.0 <= speed <= fastest:
        rule = f"must not exceed {fastest:.4g} m/s at A_v = {accuracy} (ANSI/AGMA 2101-D04, clause 8)"
        raise RangeError("pitch line velocity", f"{speed:.4g} m/s", rule, "choose a better accuracy level")
    return ((c + math.sqrt(196.85 * speed)) / c) ** b


@dataclass(frozen=True, slots=True)
class Mounting:
    """What the empirical K_H asks for (clause 15).

    Parameters
    ----------
    enclosure : str
        "open", "commercial", "precision" or "extra-precision" enclosed gear units: the curve of K_Hma.
    crowned : bool
        Whether leads are crowned or otherwise modified by skilful design (K_Hmc = .8).
    offset_ratio : float
        S_1 / S, pinion's offset from the middle of the bearing span over the span.
    adjusted : bool
        Whether the gearing is adjusted at assembly or its contact improved by lapping (K_He = .8).
    """

    enclosure: Enclosure = "commercial"
    crowned: bool = False
    offset_ratio: float = 0.0
    adjusted: bool = False


@dataclass(frozen=True, slots=True)
class LoadDistribution:
    """K_H = 1 + K_Hmc (K_Hpf K_Hpm + K_Hma K_He) and its parts (clause 15)."""

    lead: float
    proportion: float
    offset: float
    alignment: float
    correction: float

    @property
    def K_H(self) -> float:
        """Load distribution factor."""
        return 1.0 + self.lead * (self.proportion * self.offset + self.alignment * self.correction)


def load_distribution(face_width: float, pinion_diameter: float, mounting: Mounting) -> LoadDistribution:
    """K_H by the empirical method (clause 15.3).

    Parameters
    ----------
    face_width : float
        b, net face width [m], at most 1.02 m.
    pinion_diameter : float
        d_w1, operating pitch diameter of the pinion [m].
    mounting : Mounting

    Raises
    ------
    RangeError
        Outside the empirical method: b / d_w1 above 2 or b above 1020 mm.
    """
    b, d = face_width * 1e3, pinion_diameter * 1e3
    if not (b > 0.0 and d > 0.0):
        raise RangeError("face width, pinion diameter", (face_width, pinion_diameter), "must be positive")
    if b > 2.0 * d or b > 1020.0:
        rule = "must be at most 2 pinion diameters and 1020 mm for the empirical method (ANSI/AGMA 2101-D04, 15)"
        raise RangeError("face width", f"{b:.4g} mm", rule, "use K_H from an FE load distribution")
    if not 0.0 <= abs(mounting.offset_ratio) <= 0.5:
        raise RangeError("S_1/S", mounting.offset_ratio, "must be between -0.5 and 0.5 (pinion between bearings)")
    if mounting.enclosure not in _ALIGNMENT:
        raise RangeError("enclosure", mounting.enclosure, f"must be one of {', '.join(_ALIGNMENT)}")
    slim = max(b / (10.0 * d), 0.05)
    if b <= 25.0:
        proportion = slim - 0.025
    elif b <= 432.0:
        proportion = slim - 0.0375 + 0.000492 * b
    else:
        proportion = slim - 0.1109 + 0.000815 * b - 0.353e-6 * b * b
    offset = 1.0 if abs(mounting.offset_ratio) < 0.175 else 1.1
    a1, a2, a3 = _ALIGNMENT[mounting.enclosure]
    lead, correction = 0.8 if mounting.crowned else 1.0, 0.8 if mounting.adjusted else 1.0
    return LoadDistribution(lead, proportion, offset, a1 + a2 * b + a3 * b * b, correction)


def rim_factor(backup_ratio: float) -> float:
    """K_B: 1 for m_B = rim / whole depth of 1.2 and more, else 1.6 ln(2.242 / m_B) (clause 5.2.5).

    Raises
    ------
    RangeError
        For m_B below 0.5, where the rim rather than the tooth breaks.
    """
    if not backup_ratio >= 0.5:
        raise RangeError("m_B", f"{backup_ratio:.4g}", "must be at least 0.5; below that rim fracture governs")
    return 1.0 if backup_ratio >= 1.2 else 1.6 * math.log(2.242 / backup_ratio)


def elastic_coefficient(young_modulus: tuple[float, float], poisson_ratio: tuple[float, float]) -> float:
    """Z_E = sqrt(1 / (pi ((1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2))) [sqrt(Pa)] (clause 12)."""
    soft = sum((1.0 - nu * nu) / e for e, nu in zip(young_modulus, poisson_ratio, strict=True))
    return math.sqrt(1.0 / (math.pi * soft))


def hardness_ratio_factor(ratio: float, pinion_hardness: float, gear_hardness: float) -> float:
    """Z_W of the gear (the pinion's is 1) where both are through-hardened (clause 14.1).

    Parameters
    ----------
    ratio : float
        u, teeth of the gear over those of the pinion, at least 1; counts as 20 at most.
    pinion_hardness, gear_hardness : float
        HB.
    """
    if not (ratio >= 1.0 and pinion_hardness > 0.0 and gear_hardness > 0.0):
        raise RangeError("u, HB_1, HB_2", (ratio, pinion_hardness, gear_hardness), "must be at least 1, and positive")
    hard = pinion_hardness / gear_hardness
    a = 0.0 if hard < 1.2 else 8.98e-3 * hard - 8.29e-3
    if hard > 1.7:
        a = 0.00698
    return 1.0 + a * (min(ratio, 20.0) - 1.0)


def work_hardening_factor(pinion_roughness: float, gear_hardness: float) -> float:
    """Z_W of a through-hardened gear, 180 to 400 HB, run with a pinion of 48 HRC and more (clause 14.2).

    Z_W = 1 + 0.00075 e^(-0.448 R) (450 - HB_2), and at least 1.

    Parameters
    ----------
    pinion_roughness : float
        R_a of the pinion's flanks [m]; above 1.6 um the factor is 1.
    gear_hardness : float
        HB_2.
    """
    if not 180.0 <= gear_hardness <= 400.0:
        raise RangeError("HB_2", gear_hardness, "must be 180 to 400 HB for work hardening", "use Z_W = 1")
    if pinion_roughness < 0.0:
        raise RangeError("roughness", pinion_roughness, "must not be negative")
    rough = pinion_roughness * 1e6
    return 1.0 if rough > 1.6 else max(1.0, 1.0 + 0.00075 * math.exp(-0.448 * rough) * (450.0 - gear_hardness))


def pitting_cycle_factor(cycles: float, curve: Curve = "upper", *, nitrided: bool = False) -> float:
    """Z_N over the load cycles (clause 17, figure 17).

    Parameters
    ----------
    cycles : float
        n_L, at least 100; below 10,000 the factor stays.
    curve : {"upper", "lower"}
        Beyond ten million cycles: 1.4488 N^-0.023, or 2.466 N^-0.056 where little pitting may be allowed.
    nitrided : bool
        Nitrided flanks: 1.249 N^-0.0138 up to ten million cycles.
    """
    n = max(_cycles(cycles), _Z_START)
    if n <= _Z_KNEE:
        return float(1.249 * n**-0.0138 if nitrided else 2.466 * n**-0.056)
    return float(1.4488 * n**-0.023 if curve == "upper" else 2.466 * n**-0.056)


def bending_cycle_factor(cycles: float, brinell: float, treatment: str, curve: Curve = "upper") -> float:
    """Y_N over the load cycles (clause 17, figure 18), between the drawn hardnesses by the logarithm's share.

    Parameters
    ----------
    cycles : float
        n_L, at least 100.
    brinell : float
        HB of through-hardened steel (160 to 400 are drawn; the ends count beyond).
    treatment : str
        As of `allowable_stress`; "given" counts as through-hardened.
    curve : {"upper", "lower"}
        Beyond three million cycles: 1.3558 N^-0.0178, or 1.6831 N^-0.0323 for critical service.
    """
    n = _cycles(cycles)
    if n >= _Y_KNEE:
        return float(1.3558 * n**-0.0178 if curve == "upper" else 1.6831 * n**-0.0323)
    if treatment.startswith("nitrided"):
        return _power(_Y_NITRIDED, n)
    if treatment in {"carburized", "induction-hardened"}:
        return _power(_Y_CARBURIZED, n)
    hard = min(max(brinell, _Y_THROUGH[0][0]), _Y_THROUGH[-1][0])
    for (low, *a), (high, *b) in pairwise(_Y_THROUGH):
        if hard <= high:
            share = (hard - low) / (high - low)
            return _power((a[0], a[1]), n) ** (1.0 - share) * _power((b[0], b[1]), n) ** share
    raise AssertionError


def _power(law: tuple[float, float], cycles: float) -> float:
    """A curve below the knee; fewer than a thousand cycles count as a thousand, which is safe."""
    return float(law[0] * max(cycles, 1e3) ** -law[1])


def _cycles(cycles: float) -> float:
    if not cycles >= _FEWEST:
        raise RangeError("load cycles", f"{cycles:.4g}", "must be at least 100 (ANSI/AGMA 2101-D04, 17)")
    return cycles


def reliability_factor(reliability: float) -> float:
    """Y_Z of table 11 (clause 18), between its rows straight in the logarithm of the failing share.

    Parameters
    ----------
    reliability : float
        Share of gears that hold, 0.5 to 0.9999.
    """
    if not _RELIABILITY[0][0] <= reliability <= _RELIABILITY[-1][0]:
        raise RangeError("reliability", reliability, "must be 0.5 to 0.9999 (ANSI/AGMA 2101-D04, table 11)")
    for (low, a), (high, b) in pairwise(_RELIABILITY):
        if reliability <= high:
            share = math.log((1.0 - low) / (1.0 - reliability)) / math.log((1.0 - low) / (1.0 - high))
            return a + share * (b - a)
    raise AssertionError
