"""Geometry of a pair as ISO 6336-1 uses it: diameters, angles, contact ratios, curvature at the pitch point.

`PairGeometry` holds plain numbers, so that a published example can be typed in; `of_pair` takes them from two gears.
In the standard an internal gear has a negative number of teeth, and with it negative reference and base diameters
and a negative gear ratio. That sign belongs to the equations of involutes: `signed_teeth`, `signed_diameters`,
`signed_base_diameters` and `signed_ratio` have it. Everything else is counted and measured without it: speeds, torques,
load cycles and lives are made from `teeth`, `diameters` and `turns`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from fegear.formulas.iso6336.rated import Both
    from fegear.geometry.gear import Gear
    from fegear.geometry.internal_tooth import InternalTooth
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.pair import GearPair, Member


@dataclass(frozen=True, slots=True)
class GearShape:
    """Geometry of one gear as ISO 6336 sees it; lengths [m].

    Parameters
    ----------
    teeth : int
        Number of teeth, positive of an internal gear as well.
    profile_shift : float
        x, nominal.
    tip_diameter, root_diameter, face_width : float
    dedendum, tip_radius : float
        h_fP and rho_fP of the basic rack [modules].
    residual_undercut : float
        s_pr, what protuberance leaves [modules].
    bore_diameter : float
        d_i, inside diameter of the body (of the rim, where it has a web); of an internal gear its outside diameter.
    generating_shift : float
        x_E, thinned for backlash, for the root; NaN: the nominal one.
    active_tip_diameter : float
        d_Na, where the involute ends; NaN: the tip diameter.
    rim_thickness, web_ratio : float, optional
        s_R; b_s/b. None for a solid gear.
    young_modulus, poisson_ratio, density : float
        [Pa], 1, [kg/m^3].
    outline : InternalTooth, optional
        Teeth of an internal gear, for the root: no rack describes them. An external gear has None.
    formed : InvoluteTooth, optional
        Teeth of a spur gear whose fillets no tool has made: their root is that of the outline.
    fixed : bool
        Whether the gear stands still with the casing, as the ring of most planetary sets: its mass counts as infinite.
    """

    teeth: int
    profile_shift: float
    tip_diameter: float
    root_diameter: float
    face_width: float
    dedendum: float = 1.25
    tip_radius: float = 0.38
    residual_undercut: float = 0.0
    bore_diameter: float = 0.0
    generating_shift: float = math.nan
    active_tip_diameter: float = math.nan
    rim_thickness: float | None = None
    web_ratio: float | None = None
    young_modulus: float = 206e9
    poisson_ratio: float = 0.3
    density: float = 7830.0
    outline: InternalTooth | None = None
    formed: InvoluteTooth | None = None
    fixed: bool = False

    def __post_init__(self) -> None:
        """Fill in what follows from the rest; refuse what no gear has."""
        if not self.teeth > 0:
            raise RangeError("teeth", self.teeth, "must be positive, also for an internal gear")
        for name in ("face_width", "root_diameter", "young_modulus", "density"):
            if not getattr(self, name) > 0.0:
                raise RangeError(name, getattr(self, name), "must be positive")
        inward = (self.tip_diameter, self.root_diameter, self.bore_diameter)
        if self.internal:
            inward = inward[::-1]
        if not inward[0] > inward[1] > inward[2] >= 0.0:
            diameters = f"{self.tip_diameter:.6g}, {self.root_diameter:.6g}, {self.bore_diameter:.6g} m"
            rule = f"must be {'increasing' if self.internal else 'decreasing'} in this order"
            raise RangeError(f"tip, root and {'outside' if self.internal else 'bore'} diameter", diameters, rule)
        if math.isnan(self.generating_shift):
            object.__setattr__(self, "generating_shift", self.profile_shift)
        if math.isnan(self.active_tip_diameter):
            object.__setattr__(self, "active_tip_diameter", self.tip_diameter)

    @property
    def internal(self) -> bool:
        """Whether the teeth point inward."""
        return self.outline is not None

    @property
    def signed_teeth(self) -> int:
        """z of the equations of involutes: negative of an internal gear."""
        return -self.teeth if self.internal else self.teeth

    @property
    def depth(self) -> float:
        """h, tooth depth from tip to root [m]."""
        return 0.5 * abs(self.tip_diameter - self.root_diameter)


@dataclass(frozen=True, slots=True)
class PairGeometry:
    """Two gears on parallel axes, of which the wheel may be internal; lengths [m], angles [rad].

    Parameters
    ----------
    gears : (GearShape, GearShape)
        Pinion (fewer teeth) and wheel; an internal gear is the wheel.
    module, pressure_angle, helix_angle : float
        m_n, alpha_n, beta.
    centre_distance : float
        a.
    members : (Member, Member)
        Which of driver and driven pinion and wheel are.
    contact_ratio : float
        epsilon_alpha; NaN: from the active tip diameters.
    face_width : float
        b that carries; NaN: the smaller one.

    Raises
    ------
    RangeError
        If the first gear has more teeth or is internal, or the gears do not meet.
    """

    gears: tuple[GearShape, GearShape]
    module: float
    pressure_angle: float
    helix_angle: float
    centre_distance: float
    members: tuple[Member, Member] = ("driver", "driven")
    contact_ratio: float = math.nan
    face_width: float = math.nan

    def __post_init__(self) -> None:
        """Fill in face width and contact ratio; refuse what is no pair."""
        if self.gears[0].internal or self.gears[0].teeth > self.gears[1].teeth:
            given = f"{self.gears[0].teeth}, {self.gears[1].teeth}"
            raise RangeError(
                "teeth of pinion and wheel", given, "must not be decreasing", "specify the gear with fewer teeth first"
            )
        if not self.module > 0.0:
            raise RangeError("module", self.module, "must be positive")
        if not 0.0 <= self.helix_angle < math.pi / 2:
            raise RangeError("helix angle", self.helix_angle, "must be between 0 and 90 deg, unsigned")
        if math.isnan(self.face_width):
            object.__setattr__(self, "face_width", min(g.face_width for g in self.gears))
        if not self.centre_distance > 0.5 * abs(sum(self.signed_base_diameters)):
            raise RangeError(
                "centre distance", f"{self.centre_distance:.6g} m",
                f"must exceed the {'difference' if self.internal else 'sum'} of the base radii",
            )  # fmt: skip
        if math.isnan(self.contact_ratio):
            object.__setattr__(self, "contact_ratio", self._contact_ratio())

    def _contact_ratio(self) -> float:
        reach = sum(
            math.copysign(0.5, d_b) * math.sqrt(max(g.active_tip_diameter**2 - d_b**2, 0.0))
            for g, d_b in zip(self.gears, self.signed_base_diameters, strict=True)
        )
        between = self.centre_distance * math.sin(self.working_pressure_angle)
        path = reach + between if self.internal else reach - between
        if not path > 0.0:
            raise RangeError("centre distance", f"{self.centre_distance:.6g} m", "is too large: no tooth contact")
        return path / self.base_pitch

    @property
    def internal(self) -> bool:
        """Whether the wheel is an internal gear."""
        return self.gears[1].internal

    @property
    def signed_ratio(self) -> float:
        """Gear ratio u = z_2 / z_1 of the equations of involutes: at least 1, or at most -1 of an internal pair."""
        return self.gears[1].signed_teeth / self.gears[0].signed_teeth

    @property
    def turns(self) -> Both:
        """Revolutions of pinion and wheel per revolution of the pinion, both positive: z_1 / z_1 and z_1 / abs(z_2)."""
        return 1.0, self.gears[0].teeth / self.gears[1].teeth

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t."""
        return math.atan(math.tan(self.pressure_angle) / math.cos(self.helix_angle))

    @property
    def base_helix_angle(self) -> float:
        """beta_b: sin(beta_b) = sin(beta) cos(alpha_n)."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.pressure_angle))

    @property
    def diameters(self) -> Both:
        """abs(d_1), abs(d_2): reference diameters, positive of an internal gear as well."""
        d_1, d_2 = (g.teeth * self.module / math.cos(self.helix_angle) for g in self.gears)
        return d_1, d_2

    @property
    def signed_diameters(self) -> Both:
        """d_1, d_2 of the equations of involutes: negative of an internal gear."""
        d_1, d_2 = (g.signed_teeth * self.module / math.cos(self.helix_angle) for g in self.gears)
        return d_1, d_2

    @property
    def signed_base_diameters(self) -> Both:
        """d_b1, d_b2 of the equations of involutes: negative of an internal gear."""
        d_1, d_2 = self.signed_diameters
        c = math.cos(self.transverse_pressure_angle)
        return d_1 * c, d_2 * c

    @property
    def base_pitch(self) -> float:
        """p_bt."""
        return math.pi * self.signed_base_diameters[0] / self.gears[0].teeth

    @property
    def working_pressure_angle(self) -> float:
        """alpha_wt."""
        return math.acos(0.5 * abs(sum(self.signed_base_diameters)) / self.centre_distance)

    @property
    def overlap_ratio(self) -> float:
        """epsilon_beta = b sin(beta) / (pi m_n)."""
        return self.face_width * math.sin(self.helix_angle) / (math.pi * self.module)

    @property
    def total_contact_ratio(self) -> float:
        """epsilon_gamma."""
        return self.contact_ratio + self.overlap_ratio

    @property
    def virtual_contact_ratio(self) -> float:
        """epsilon_alpha_n = epsilon_alpha / cos^2(beta_b) (ISO 6336-3, 6.2)."""
        return self.contact_ratio / math.cos(self.base_helix_angle) ** 2

    @property
    def relative_curvature_radius(self) -> float:
        """rho_red at the pitch point, in the transverse section: rho_1 rho_2 / (rho_1 + rho_2)."""
        rho = [0.5 * d * math.tan(self.working_pressure_angle) for d in self.signed_base_diameters]
        return rho[0] * rho[1] / (rho[0] + rho[1])

    def pitch_line_velocity(self, speed: float) -> float:
        """v at the reference circle [m/s] for a speed of the pinion [rad/s]."""
        return 0.5 * self.diameters[0] * speed


@dataclass(frozen=True, slots=True)
class Body:
    """What of a gear's body ISO 6336 counts, besides its bore; lengths [m].

    Parameters
    ----------
    rim_thickness : float, optional
        s_R; None for a solid gear.
    web_thickness : float, optional
        b_s; None for a disc as wide as the face.
    bored : bool
        Whether the bore is that of the gear, and not one that finite elements assume.
    fixed : bool
        Whether the gear stands still with the casing.
    """

    rim_thickness: float | None = None
    web_thickness: float | None = None
    bored: bool = True
    fixed: bool = False

    def web_ratio(self, face_width: float) -> float | None:
        """b_s/b."""
        return None if self.web_thickness is None else self.web_thickness / face_width

    def bore_diameter(self, gear: Gear) -> float:
        """d_i: inside of the rim where a web carries it and no bore is known."""
        if self.bored or self.web_thickness is None or self.rim_thickness is None:
            return 2.0 * gear.bore_radius
        return 2.0 * max(gear.root_radius - self.rim_thickness, 0.0)


#: A gear without web and rim.
SOLID = Body()


def _ring_shape(gear: Gear, tooth: InternalTooth, body: Body) -> GearShape:
    return GearShape(
        teeth=gear.teeth,
        profile_shift=tooth.profile_shift,
        tip_diameter=2.0 * gear.tip_radius,
        root_diameter=2.0 * gear.root_radius,
        face_width=gear.face_width,
        dedendum=tooth.dedendum,
        bore_diameter=2.0 * gear.bore_radius,
        active_tip_diameter=2.0 * gear.involute_tip_radius,
        rim_thickness=body.rim_thickness,
        web_ratio=body.web_ratio(gear.face_width),
        young_modulus=gear.material.young_modulus,
        poisson_ratio=gear.material.poisson_ratio,
        density=gear.material.density,
        outline=tooth,
        formed=_formed(gear),
        fixed=body.fixed,
    )


def _formed(gear: Gear) -> InvoluteTooth | None:
    """The teeth of a gear with fillets of its own; refuses helical ones, whose virtual gear no outline gives."""
    if not gear.shaped:
        return None
    if gear.helix_angle:
        raise RangeError(
            "fillet", "(given)", "is not available in the rating of helical gears (virtual spur gear of a tool)",
            "remove it for the rating",
        )  # fmt: skip
    return gear.symmetric_tooth


def _shape(gear: Gear, body: Body) -> GearShape:
    from fegear.geometry.custom_fillet_tooth import CustomFilletTooth
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.internal_tooth import InternalTooth

    formed = _formed(gear)
    generated = gear.tooth.generated if isinstance(gear.tooth, CustomFilletTooth) else gear.tooth
    if isinstance(generated, InternalTooth):
        return _ring_shape(gear, generated, body)
    if not isinstance(generated, Tooth):
        generated = gear.external_tooth
    tooth = generated
    return GearShape(
        teeth=gear.teeth,
        profile_shift=tooth.profile_shift,
        tip_diameter=2.0 * gear.tip_radius,
        root_diameter=2.0 * gear.root_radius,
        face_width=gear.face_width,
        dedendum=tooth.dedendum if formed is None else gear.symmetric_tooth.dedendum,
        tip_radius=tooth.rack.tip_radius,
        residual_undercut=tooth.rack.residual_undercut,
        formed=formed,
        bore_diameter=body.bore_diameter(gear),
        generating_shift=tooth.generating_shift,
        active_tip_diameter=2.0 * gear.involute_tip_radius,
        rim_thickness=body.rim_thickness,
        web_ratio=body.web_ratio(gear.face_width),
        young_modulus=gear.material.young_modulus,
        poisson_ratio=gear.material.poisson_ratio,
        density=gear.material.density,
        fixed=body.fixed,
    )


def of_pair(pair: GearPair, bodies: tuple[Body, Body] = (SOLID, SOLID)) -> PairGeometry:
    """Geometry of a gear pair; the pinion is the gear with fewer teeth, of equal ones that with more profile shift.

    ISO 6336-1, 9.3.1.1, wants x_1 >= x_2 for c'; of equal shifts it is the driver.

    Parameters
    ----------
    pair : GearPair
    bodies : (Body, Body)
        Rim and web of driver and driven.
    """
    driver, driven = (_shape(g, body) for g, body in zip((pair.driver, pair.driven), bodies, strict=True))
    first = pair.pinion == "driver"
    return PairGeometry(
        gears=(driver, driven) if first else (driven, driver),
        module=pair.driver.module,
        pressure_angle=pair.driver.normal_pressure_angle,
        helix_angle=pair.driver.helix_angle,
        centre_distance=pair.centre_distance,
        members=("driver", "driven") if first else ("driven", "driver"),
        contact_ratio=pair.contact_ratio,
        face_width=pair.face_width,
    )
