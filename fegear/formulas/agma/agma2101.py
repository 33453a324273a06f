"""ANSI/AGMA 2101-D04: contact and bending stress of a spur or helical pair, what it may bear, and the safeties.

Source: ANSI/AGMA 2101-D04, Fundamental Rating Factors and Calculation Methods for Involute Spur and Helical Gear Teeth
(metric edition), clause 5: sigma_H by equation (1), sigma_F by equation (10); geometry factors Z_I = I and Y_J = J of
AGMA 908-B89 (`fegear.formulas.agma.agma908`), allowable stress numbers of clause 16
(`fegear.formulas.agma.agma2101`), factors of `fegear.formulas.agma.agma2101_factors`. The standard's safety factor of
pitting S_H is one of stress: the load may rise by its square.

Allowable stress numbers of steel gears (ANSI/AGMA 2101-D04, clause 16), by treatment, grade and hardness.

Source: ANSI/AGMA 2101-D04, tables 3 (contact), 4 and 6 (bending), figures 8 to 11; the metric numbers of the tables.
Public texts that repeat them were at hand for the lines of through-hardened steel, the cores of 4140 and nitralloy and
the flanks of all cases (table 3 of 2001-D04, engineersedge.com, AGMA Allowable Contact Stress); the roots of carburized
and induction-hardened teeth and the lines of 2.5 % chrome steel are recalled: `RECALLED_ROOTS`.
They are for ten million cycles, one direction of load and a reliability of 99 %. For gears that are loaded both ways
(idlers, planets) the standard takes 70 % of the bending number: `reversed_bending`.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from typing import Literal

from fegear.base.errors import RangeError
from fegear.formulas.agma.agma908 import bending_factor, contact_geometry, pitting_factor
from fegear.formulas.agma.agma2101_factors import (
    Curve,
    Mounting,
    bending_cycle_factor,
    dynamic_factor,
    elastic_coefficient,
    hardness_ratio_factor,
    load_distribution,
    pitting_cycle_factor,
    reliability_factor,
    rim_factor,
    work_hardening_factor,
)
from fegear.formulas.iso6336.conditions import Factor
from fegear.formulas.iso6336.rated import Both
from fegear.formulas.symbols import AGMA_2101
from fegear.geometry.pair import GearPair, Member

_STANDARD = "ANSI/AGMA 2101-D04"


#: Treatments that leave a flank of 48 HRC and more (clause 14.2).
HARD_CASES = {"carburized", "induction-hardened", "nitrided-4140", "nitrided-nitralloy", "nitrided-chrome"}


@dataclass(frozen=True, slots=True)
class Service:
    """What a pair has to do, and what the standard leaves to the designer.

    Parameters
    ----------
    tangential : float
        F_t at the operating pitch circle [N].
    speed : float
        v_t, pitch line velocity [m/s].
    cycles : (float, float)
        n_L, load cycles of pinion and wheel.
    accuracy : int
        A_v, transmission accuracy level, 6 to 12; 17 - Q_v.
    overload : float
        K_o.
    mounting : Mounting
        For the empirical K_H.
    reliability : float
        0.5 to 0.9999.
    size, surface, temperature : float
        K_s, Z_R, Y_theta: 1 unless there is a reason.
    backup_ratio : (float, float)
        m_B, rim thickness over whole depth; inf for solid gears.
    pinion_roughness : float
        R_a [m], for Z_W of a surface-hardened pinion on a through-hardened wheel.
    curve : {"upper", "lower"}
        Of Z_N and Y_N at many cycles.
    dynamic, load_distribution : float, optional
        K_v and K_H known otherwise, in place of the standard's.
    """

    tangential: float
    speed: float
    cycles: Both = (1e7, 1e7)
    accuracy: int = 8
    overload: float = 1.0
    mounting: Mounting = field(default_factory=Mounting)
    reliability: float = 0.99
    size: Both = (1.0, 1.0)
    surface: float = 1.0
    temperature: float = 1.0
    backup_ratio: Both = (math.inf, math.inf)
    pinion_roughness: float = 0.8e-6
    curve: Curve = "upper"
    dynamic: float | None = None
    load_distribution: float | None = None

    def __post_init__(self) -> None:
        """Refuse loads and factors that are none."""
        for name, value in (
            ("F_t", self.tangential), ("K_o", self.overload), ("K_s", min(self.size)), ("Z_R", self.surface),
            ("Y_theta", self.temperature), ("K_v", 1.0 if self.dynamic is None else self.dynamic),
            ("K_H", 1.0 if self.load_distribution is None else self.load_distribution),
        ):  # fmt: skip
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(name, value, "must be positive and finite")


@dataclass(frozen=True, slots=True)
class AgmaRating:
    """A rating with every factor on its way; pairs of values are those of pinion and wheel.

    Parameters
    ----------
    members : (Member, Member)
        Which of driver and driven is the pinion, which the wheel.
    factors : tuple of Factor
        In the order in which the standard computes them.
    contact, contact_allowed : (float, float)
        sigma_H, and sigma_HP Z_N Z_W / (Y_theta Y_Z) [Pa].
    bending, bending_allowed : (float, float)
        sigma_F, and sigma_FP Y_N / (Y_theta Y_Z) [Pa].
    """

    members: tuple[Member, Member]
    factors: tuple[Factor, ...]
    contact: Both
    contact_allowed: Both
    bending: Both
    bending_allowed: Both

    @property
    def S_H(self) -> Both:
        """Safety factor for pitting, of stress."""
        return self.contact_allowed[0] / self.contact[0], self.contact_allowed[1] / self.contact[1]

    @property
    def S_F(self) -> Both:
        """Safety factor for bending strength."""
        return self.bending_allowed[0] / self.bending[0], self.bending_allowed[1] / self.bending[1]

    def factor(self, symbol: str) -> Factor:
        """The factor of that symbol."""
        return next(one for one in self.factors if one.symbol == symbol)


def rate(
    pair: GearPair, service: Service, allowed: tuple[AllowableStress, AllowableStress], geometry: Geometry | None = None
) -> AgmaRating:
    """Rate a pair by ANSI/AGMA 2101-D04.

    Parameters
    ----------
    pair : GearPair
        External, spur or helical.
    service : Service
    allowed : (AllowableStress, AllowableStress)
        Of pinion and wheel.
    geometry : Geometry, optional
        Z_I and Y_J known otherwise; by default those of AGMA 908-B89.

    Raises
    ------
    RangeError
        If the pair or the service lies outside the standard.
    """
    first = pair.pinion
    second: Member = "driven" if first == "driver" else "driver"
    pinion, wheel = pair.gear(first), pair.gear(second)
    face, d = pair.face_width, 2.0 * pinion.base_radius / math.cos(pair.working_pressure_angle)
    shape = geometry_of(pair) if geometry is None else geometry
    k_v = dynamic_factor(service.speed, service.accuracy) if service.dynamic is None else service.dynamic
    spread = None if service.load_distribution else load_distribution(face, d, service.mounting)
    k_h = spread.K_H if spread else service.load_distribution or 1.0
    k_b = _both(rim_factor(m_b) for m_b in service.backup_ratio)
    z_e = elastic_coefficient(
        (pinion.material.young_modulus, wheel.material.young_modulus),
        (pinion.material.poisson_ratio, wheel.material.poisson_ratio),
    )
    z_n = _both(
        pitting_cycle_factor(n, service.curve, nitrided=a.treatment.startswith("nitrided"))
        for n, a in zip(service.cycles, allowed, strict=True)
    )
    y_n = _both(
        bending_cycle_factor(n, a.brinell, a.treatment, service.curve)
        for n, a in zip(service.cycles, allowed, strict=True)
    )
    y_z, z_w = reliability_factor(service.reliability), _hardness(pair, service, allowed)
    load = service.tangential * service.overload * k_v
    transverse_module = 2.0 * pinion.pitch_radius / pinion.teeth
    contact = _both(
        z_e * math.sqrt(load * k_s * k_h / (d * face) * service.surface / shape.Z_I) for k_s in service.size
    )
    bending = _both(
        load * k_s / (face * transverse_module) * k_h * b / j
        for k_s, b, j in zip(service.size, k_b, shape.Y_J, strict=True)
    )
    less = service.temperature * y_z
    contact_allowed = _both(a.contact * n * w / less for a, n, w in zip(allowed, z_n, (1.0, z_w), strict=True))
    bending_allowed = _both(a.bending * n / less for a, n in zip(allowed, y_n, strict=True))
    same: list[tuple[str, float, str]] = [
        ("F_t", service.tangential, "7"), ("v_t", service.speed, "7"), ("K_o", service.overload, "9"),
        ("K_v", k_v, "8" if service.dynamic is None else "given"),
    ]  # fmt: skip
    if spread:
        same += [
            ("K_Hmc", spread.lead, "15.3"), ("K_Hpf", spread.proportion, "15.3"),
            ("K_Hpm", spread.offset, "15.3"), ("K_Hma", spread.alignment, "15.3"),
            ("K_He", spread.correction, "15.3"),
        ]  # fmt: skip
    same += [
        ("K_H", k_h, "15" if spread else "given"), ("Z_E", z_e, "12"),
        ("Z_R", service.surface, "13"),
        ("Z_I", shape.Z_I, "6, AGMA 908-B89, 4"), ("Y_Z", y_z, "18"),
        ("Y_theta", service.temperature, "19"),
    ]  # fmt: skip
    each: list[tuple[str, Both, str]] = [
        ("K_s", service.size, "20"), ("K_B", k_b, "5.2.5"), ("Y_J", shape.Y_J, "6, AGMA 908-B89, 5"),
        ("sigma_H", contact, "5.1.1, (1)"), ("sigma_F", bending, "5.2.1, (10)"),
        ("sigma_HP", (allowed[0].contact, allowed[1].contact), "16"),
        ("sigma_FP", (allowed[0].bending, allowed[1].bending), "16"),
        ("Z_N", z_n, "17"), ("Y_N", y_n, "17"), ("Z_W", (1.0, z_w), "14"),
    ]  # fmt: skip
    factors = [Factor(AGMA_2101[s], (v, v), _clause(c)) for s, v, c in same]
    factors += [Factor(AGMA_2101[s], v, _clause(c)) for s, v, c in each]
    made = AgmaRating((first, second), (), contact, contact_allowed, bending, bending_allowed)
    factors += [Factor(AGMA_2101[s], v, _clause("11")) for s, v in (("S_H", made.S_H), ("S_F", made.S_F))]
    return AgmaRating((first, second), tuple(factors), contact, contact_allowed, bending, bending_allowed)


@dataclass(frozen=True, slots=True)
class Geometry:
    """Z_I of the pair and Y_J of pinion and wheel."""

    Z_I: float
    Y_J: Both


def geometry_of(pair: GearPair) -> Geometry:
    """Z_I and Y_J by AGMA 908-B89."""
    contact = contact_geometry(pair)
    mate: Member = "driven" if contact.pinion == "driver" else "driver"
    return Geometry(
        pitting_factor(pair, contact), _both(bending_factor(pair, m, contact).J for m in (contact.pinion, mate))
    )


def _both(values: Iterable[float]) -> Both:
    one, other = values
    return one, other


def _clause(clause: str) -> str:
    return clause if clause == "given" else f"{_STANDARD}, {clause}"


def _hardness(pair: GearPair, service: Service, allowed: tuple[AllowableStress, AllowableStress]) -> float:
    """Z_W of the wheel."""
    if allowed[1].treatment != "through-hardened":
        return 1.0
    if allowed[0].treatment in HARD_CASES:
        return work_hardening_factor(service.pinion_roughness, allowed[1].brinell)
    if allowed[0].treatment != "through-hardened":
        return 1.0
    return hardness_ratio_factor(max(pair.ratio, 1.0 / pair.ratio), allowed[0].brinell, allowed[1].brinell)


Grade = Literal[1, 2, 3]


Treatment = Literal[
    "through-hardened", "carburized", "induction-hardened", "nitrided-4140", "nitrided-nitralloy", "nitrided-chrome"
]


#: Treatments whose sigma_FP no public text at hand repeats.
RECALLED_ROOTS = frozenset({"carburized", "induction-hardened", "nitrided-chrome"})


@dataclass(frozen=True, slots=True)
class _Line:
    """slope x HB + start [MPa] between two hardnesses of the core or the through-hardened gear."""

    slope: float
    start: float
    softest: float
    hardest: float


#: sigma_HP and sigma_FP of through-hardened steel by grade [MPa], HB of the gear (figures 8 and 9).
_THROUGH: dict[int, tuple[_Line, _Line]] = {
    1: (_Line(2.22, 200.0, 180.0, 400.0), _Line(0.533, 88.3, 180.0, 400.0)),
    2: (_Line(2.41, 237.0, 180.0, 400.0), _Line(0.703, 113.0, 180.0, 400.0)),
}


#: sigma_HP, sigma_FP [MPa] of carburized and of flame or induction hardened cases (tables 3, 4: 54 HRC, pattern A).
_CASE: dict[str, dict[int, tuple[float, float]]] = {
    "carburized": {1: (1240.0, 380.0), 2: (1550.0, 450.0), 3: (1895.0, 515.0)},
    "induction-hardened": {1: (1205.0, 310.0), 2: (1345.0, 380.0)},
}


#: sigma_HP [MPa] of the nitrided case and the line of sigma_FP over the core's hardness (table 3; figures 10 and 11).
_NITRIDED: dict[str, dict[int, tuple[float, _Line]]] = {
    "nitrided-4140": {
        1: (1070.0, _Line(0.568, 83.8, 270.0, 350.0)),
        2: (1160.0, _Line(0.749, 110.0, 270.0, 350.0)),
    },
    "nitrided-nitralloy": {
        1: (1170.0, _Line(0.594, 87.76, 250.0, 350.0)),
        2: (1260.0, _Line(0.784, 114.81, 250.0, 350.0)),
    },
    "nitrided-chrome": {
        1: (1070.0, _Line(0.7255, 63.89, 290.0, 350.0)),
        2: (1185.0, _Line(0.7255, 153.63, 290.0, 350.0)),
        3: (1305.0, _Line(0.7255, 201.91, 290.0, 350.0)),
    },
}


@dataclass(frozen=True, slots=True)
class AllowableStress:
    """Allowable stress numbers of a gear.

    Parameters
    ----------
    contact, bending : float
        sigma_HP, sigma_FP [Pa].
    brinell : float
        Of the flank of a through-hardened gear, of the core of a case-hardened one; for Z_W and the cycle curves.
    treatment : str
        "given" where the numbers are the user's own.
    """

    contact: float
    bending: float
    brinell: float
    treatment: Treatment | Literal["given"] = "given"

    def __post_init__(self) -> None:
        """Refuse numbers that are no strengths."""
        for name, value in (("sigma_HP", self.contact), ("sigma_FP", self.bending), ("hardness", self.brinell)):
            if not value > 0.0:
                raise RangeError(name, value, "must be positive")

    @property
    def reversed_bending(self) -> AllowableStress:
        """The same of a gear that is loaded both ways: 70 % of sigma_FP (clause 16)."""
        return AllowableStress(self.contact, 0.7 * self.bending, self.brinell, self.treatment)


def _on_line(line: _Line, brinell: float, what: str) -> float:
    if not line.softest <= brinell <= line.hardest:
        rule = f"must be {line.softest:g} to {line.hardest:g} HB for {what} (ANSI/AGMA 2101-D04, 16)"
        raise RangeError("hardness", f"{brinell:g} HB", rule, "specify sigma_HP and sigma_FP")
    return (line.slope * brinell + line.start) * 1e6


def allowable_stress(treatment: Treatment, grade: Grade, brinell: float) -> AllowableStress:
    """Look up sigma_HP and sigma_FP (ANSI/AGMA 2101-D04, clause 16).

    Parameters
    ----------
    treatment : str
        "through-hardened", "carburized" (and hardened, 55 to 64 HRC), "induction-hardened" (or flame, 54 HRC, pattern A
        with hardened roots), "nitrided-4140" (also 4340), "nitrided-nitralloy", "nitrided-chrome" (2.5 % chrome).
    grade : {1, 2, 3}
    brinell : float
        HB: of the gear where through-hardened, else of the core.

    Raises
    ------
    RangeError
        If the standard has no such grade or hardness.
    """
    grades: dict[str, Collection[int]] = {"through-hardened": _THROUGH, **_CASE, **_NITRIDED}
    if treatment not in grades:
        raise RangeError("treatment", treatment, f"must be one of {', '.join(grades)}")
    if grade not in grades[treatment]:
        raise RangeError("grade", grade, f"has no allowable bending stress number for {treatment} steel in AGMA 2101")
    if treatment == "through-hardened":
        contact, bending = (_on_line(line, brinell, treatment) for line in _THROUGH[grade])
    elif treatment in _CASE:
        contact, bending = (1e6 * number for number in _CASE[treatment][grade])
    else:
        number, line = _NITRIDED[treatment][grade]
        contact, bending = 1e6 * number, _on_line(line, brinell, f"the core of {treatment} steel")
    return AllowableStress(contact, bending, brinell, treatment)
