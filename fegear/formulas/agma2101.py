"""ANSI/AGMA 2101-D04: contact and bending stress of a spur or helical pair, what it may bear, and the safeties.

Source: ANSI/AGMA 2101-D04, Fundamental Rating Factors and Calculation Methods for Involute Spur and Helical Gear Teeth
(metric edition), clause 5: sigma_H by equation (1), sigma_F by equation (10); geometry factors Z_I = I and Y_J = J of
AGMA 908-B89 (`fegear.formulas.agma908_pair`), allowable stress numbers of clause 16
(`fegear.formulas.agma2101_materials`), factors of `fegear.formulas.agma2101_factors`. The standard's safety factor of
pitting S_H is one of stress: the load may rise by its square.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.errors import RangeError
from fegear.formulas.agma908_pair import bending_factor, contact_geometry, pitting_factor
from fegear.formulas.agma2101_factors import (
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
from fegear.formulas.iso6336.pair_rating import Factor

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.formulas.agma2101_materials import AllowableStress
    from fegear.formulas.iso6336.rated import Both
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member

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
    same: list[tuple[str, float, str, str]] = [
        ("F_t", service.tangential, "N", "7"), ("v_t", service.speed, "m/s", "7"), ("K_o", service.overload, "", "9"),
        ("K_v", k_v, "", "8" if service.dynamic is None else "given"),
    ]  # fmt: skip
    if spread:
        same += [
            ("K_Hmc", spread.lead, "", "15.3"), ("K_Hpf", spread.proportion, "", "15.3"),
            ("K_Hpm", spread.offset, "", "15.3"), ("K_Hma", spread.alignment, "", "15.3"),
            ("K_He", spread.correction, "", "15.3"),
        ]  # fmt: skip
    same += [
        ("K_H", k_h, "", "15" if spread else "given"), ("Z_E", z_e, "sqrt(Pa)", "12"),
        ("Z_R", service.surface, "", "13"),
        ("Z_I", shape.Z_I, "", "6, AGMA 908-B89, 4"), ("Y_Z", y_z, "", "18"),
        ("Y_theta", service.temperature, "", "19"),
    ]  # fmt: skip
    each: list[tuple[str, Both, str, str]] = [
        ("K_s", service.size, "", "20"), ("K_B", k_b, "", "5.2.5"), ("Y_J", shape.Y_J, "", "6, AGMA 908-B89, 5"),
        ("sigma_H", contact, "Pa", "5.1.1, (1)"), ("sigma_F", bending, "Pa", "5.2.1, (10)"),
        ("sigma_HP", (allowed[0].contact, allowed[1].contact), "Pa", "16"),
        ("sigma_FP", (allowed[0].bending, allowed[1].bending), "Pa", "16"),
        ("Z_N", z_n, "", "17"), ("Y_N", y_n, "", "17"), ("Z_W", (1.0, z_w), "", "14"),
    ]  # fmt: skip
    factors = [Factor(s, (v, v), u, _clause(c)) for s, v, u, c in same]
    factors += [Factor(s, v, u, _clause(c)) for s, v, u, c in each]
    made = AgmaRating((first, second), (), contact, contact_allowed, bending, bending_allowed)
    factors += [Factor("S_H", made.S_H, "", _clause("11")), Factor("S_F", made.S_F, "", _clause("11"))]
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
