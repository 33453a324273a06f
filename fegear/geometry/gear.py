"""A gear: a tooth in its real size, with bore, face width and material."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

from fegear.base.errors import GeometryError, InputError
from fegear.base.given import given
from fegear.base.shown import shown, shows
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.mass import MassProperties, mass_properties
from fegear.geometry.plausible import is_of_pure_numbers, refuse_material, refuse_size
from fegear.geometry.rim_support import RimSupport

Plane = Literal["strain", "stress"]
Hand = Literal["left", "right", "spur"]
#: Compliances at this value are within 1e-4 of those at 0.5; beyond it elements stiffen and digits are lost.
_LARGEST_POISSON_RATIO = 0.4999
#: Rim of a ring gear outside its root circle when none is given [modules]: some 1.5 times its teeth.
USUAL_RING_RIM = 3.5


@dataclass(frozen=True, slots=True)
class Material:
    """A linear elastic, isotropic material."""

    young_modulus: float = given("pressure", "Young's modulus.", default=206.8e9, above=0.0)
    poisson_ratio: float = given(meaning="Poisson's ratio, below 0.5 (in plane strain at most 0.4999).", default=0.3)
    density: float = given("density", "Density, for inertia.", default=7850.0, above=0.0)

    def __post_init__(self) -> None:
        """Refuse materials that are unstable."""
        if not (math.isfinite(self.young_modulus) and self.young_modulus > 0.0):
            raise InputError("material.young_modulus", self.young_modulus, "must be positive")
        if not -1.0 < self.poisson_ratio < 0.5:
            raise InputError(
                "material.poisson_ratio", self.poisson_ratio, "must be inside (-1, 0.5)", "steel has about 0.3"
            )
        if not (math.isfinite(self.density) and self.density > 0.0):
            raise InputError("material.density", self.density, "must be positive")

    def plane_modulus(self, plane: Plane) -> float:
        """E / (1 - nu^2) in plane strain, E in plane stress [Pa]."""
        return self.young_modulus / (1.0 - self.poisson_ratio**2) if plane == "strain" else self.young_modulus


@dataclass(frozen=True)
class Gear:
    """A spur or helical gear in SI, or of pure numbers: any module with a Young's modulus such as 1.

    A helical gear is its transverse section (`tooth`) turned by `twist` z at the height z along the axis; the solid
    lies within abs(z) <= face_width / 2. Lengths and angles without "normal" in their name are those of that section.

    Parameters
    ----------
    tooth : InvoluteSide
        Shape of the transverse section in normal modules, with the helix angle: external (`Tooth`), internal
        (`InternalTooth`), or a side of an asymmetric tooth, seen from the flank that is loaded.
    module : float
        m_n, the normal module [m].
    bore_radius : float
        Radius at which the body is held fast [m]: inside (0, root radius), or, of a ring gear, outside its root circle.
    face_width : float
        b [m].
    material : Material
    plane : {"strain", "stress", "auto"}
        Plane assumption; "auto" is strain when the face is at least five tooth thicknesses (reference circle) wide.
    hand : {"left", "right", "spur"}
        Hand of the helix; "spur" if and only if the helix angle is zero.
    body : GearBody, optional
        Rim, web and hub in the place of a disc as wide as the face [m].
    support : RimSupport, optional
        What carries the rim [m]; by default the whole bore, or outer circle of a ring gear, is held.

    Raises
    ------
    GeometryError
        If module, bore, face width, hand or material break their rules, or are of a size that no gear has.
    InputError
        If the plane assumption is unknown, or plane strain meets a material that is as good as incompressible.
    """

    tooth: InvoluteSide
    module: float = shown("mm", "module")
    bore_radius: float = shown("mm", "radius at which the gear body is fixed")
    face_width: float = shown("mm", "face width", default=1e-3)
    material: Material = field(default_factory=Material)
    plane: Literal["strain", "stress", "auto"] = "strain"
    hand: Hand = "spur"
    body: GearBody | None = None
    support: RimSupport | None = None

    def __post_init__(self) -> None:
        """Refuse sizes that cannot be and settle the plane assumption."""
        if self.hand not in ("left", "right", "spur"):
            raise GeometryError("hand", f'"{self.hand}"', 'must be "left", "right" or "spur"')
        if (self.hand == "spur") != (self.helix_angle == 0.0):
            raise GeometryError(
                "hand",
                f'"{self.hand}" at a helix angle of {math.degrees(self.helix_angle):.6g} deg',
                "contradicts the helix angle",
                'specify "left" or "right" for a helical gear and "spur" for a helix angle of zero',
            )
        for name in ("module", "face_width", "bore_radius"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise GeometryError(name, value, "must be positive and finite")
        if not is_of_pure_numbers(self.material.young_modulus):
            refuse_size(self.module, self.face_width)
            refuse_material(self.material.young_modulus, self.material.density)
        self._check_held_radius()
        if self.body is not None:
            self.body.check(self.module, self.face_width, self.bore_radius, self.root_radius, self.teeth)
        if self.support is not None:
            if self.body is not None:
                raise GeometryError(
                    "rim_support", "of a gear with a body", "contradicts body",
                    "specify either body (3D) or rim_support (2D)",
                )  # fmt: skip
            self.support.check(self.module, self.bore_radius, self.teeth, internal=self.tooth.internal)
        if self.plane not in ("strain", "stress", "auto"):
            raise InputError("plane", f'"{self.plane}"', 'must be "strain", "stress" or "auto"')
        if self.plane == "auto":
            t = self.tooth
            radius = max(t.pitch_radius, t.base_radius, t.back.base_radius)
            thickness = self.pitch_radius * float(t.thickness_angle(radius))
            object.__setattr__(self, "plane", "strain" if self.face_width >= 5.0 * thickness else "stress")
        nu = self.material.poisson_ratio
        if self.plane == "strain" and nu > _LARGEST_POISSON_RATIO:
            raise InputError(
                "material.poisson_ratio",
                nu,
                "is too close to 0.5 (incompressible) for plane strain elements",
                f"use at most {_LARGEST_POISSON_RATIO}, or plane stress",
            )

    def _check_held_radius(self) -> None:
        """Refuse bodies that are held within their own teeth."""
        held, root, internal = self.bore_radius, self.root_radius, self.tooth.internal
        if not internal and held >= root:
            raise GeometryError(
                "bore_radius",
                f"{held * 1e3:.6g} mm",
                f"must be between 0 and the root radius {root * 1e3:.6g} mm",
                f"half the root radius, {root * 500:.4g} mm, is a usual start",
            )
        if internal and held <= root:
            usual = root + USUAL_RING_RIM * self.module
            raise GeometryError(
                "bore_radius",
                f"{held * 1e3:.6g} mm",
                f"must be outside the root circle of the internal gear, radius {root * 1e3:.6g} mm",
                f"{usual * 1e3:.4g} mm, a rim of {USUAL_RING_RIM:g} modules, is a usual start",
            )

    @property
    def external_tooth(self) -> Tooth:
        """The tooth of an external gear, cut by a rack.

        Raises
        ------
        GeometryError
            Of an internal gear, of asymmetric teeth, or of teeth with a fillet of their own: it is what formulas and
            effects take that are made for racks.
        """
        tooth = self.symmetric_tooth
        if not isinstance(tooth, Tooth):
            if self.shaped and not tooth.internal:
                raise GeometryError(
                    "fillet", "(not generated)", "is not generated by a rack, which this result requires",
                    "request the FE results of the gear, or remove fillet",
                )  # fmt: skip
            raise GeometryError(
                "internal", "true", "is an internal gear; this result is available for external gears only",
                "request the FE results of the gear",
            )  # fmt: skip
        return tooth

    @property
    def symmetric_tooth(self) -> InvoluteTooth:
        """The tooth of a gear whose flanks are equal.

        Raises
        ------
        GeometryError
            Of asymmetric teeth: it is what formulas, drawings and effects take that hold for equal flanks only.
        """
        if not isinstance(self.tooth, InvoluteTooth):
            raise GeometryError(
                "coast_pressure_angle", f"{math.degrees(self.tooth.back.normal_pressure_angle):.6g} deg",
                "makes the teeth asymmetric, and this is available for equal flanks only", "remove it, or the request",
            )  # fmt: skip
        return self.tooth

    @property
    def shaped(self) -> bool:
        """Whether its fillets are other than its tool makes them."""
        return self.tooth.shaped

    @property
    def asymmetric(self) -> bool:
        """Whether the two flanks of its teeth differ."""
        return self.tooth.back is not self.tooth

    @property
    def from_the_back(self) -> Gear:
        """The gear with its other flanks loaded: itself, where both are equal."""
        return replace(self, tooth=self.tooth.back) if self.asymmetric else self

    @property
    def plane_assumption(self) -> Plane:
        """Either "strain" or "stress": "auto" is settled at construction."""
        return "strain" if self.plane == "strain" else "stress"

    @property
    @shows("", "number of teeth")
    def teeth(self) -> int:
        """Number of teeth z."""
        return self.tooth.teeth

    @property
    def angular_pitch(self) -> float:
        """2 pi / z [rad]."""
        return 2.0 * math.pi / self.teeth

    @property
    def half_base_tooth_angle(self) -> float:
        """psi_b, half the angle of a tooth on the base cylinder [rad]; eta of TM-107451."""
        return self.symmetric_tooth.base_half_angle

    @property
    def half_base_space_angle(self) -> float:
        """Half the angle of a tooth space on the base cylinder [rad]; mu of TM-107451."""
        return 0.5 * self.angular_pitch - self.symmetric_tooth.base_half_angle

    @property
    def helix_angle(self) -> float:
        """Helix angle beta on the reference cylinder [rad], without the sign of the hand."""
        return self.tooth.helix_angle

    @property
    def lead_angle(self) -> float:
        """Lead angle on the reference cylinder, pi/2 - beta [rad]."""
        return 0.5 * math.pi - self.helix_angle

    @property
    def base_helix_angle(self) -> float:
        """Helix angle beta_b on the base cylinder [rad], without the sign of the hand."""
        return self.tooth.base_helix_angle

    @property
    def twist(self) -> float:
        """Turn of the transverse section per height z [rad/m]: tan(beta) / r, positive for a right hand.

        The turn is counter-clockwise seen from +z, so that the section at z has the points R(twist z) (x, y).
        """
        size = self.tooth.twist / self.module
        return -size if self.hand == "left" else size

    @property
    def flank_twist(self) -> float:
        """Twist of the section whose tooth stands on +y with its loaded flank on the right, as it is solved [rad/m].

        Seen with the tip up, the loaded flank of an external and of an internal tooth is the right one. That of an
        internal tooth, whose tip points to the axis, is then drawn as a mirror image, which has the other hand.
        """
        return self.tooth.side * self.twist

    @property
    def lead(self) -> float:
        """p_z, height of one turn of the helix [m]; infinite for a spur gear."""
        return math.inf if self.twist == 0.0 else 2.0 * math.pi / abs(self.twist)

    @property
    def transverse_module(self) -> float:
        """m_t = m_n / cos(beta) [m]."""
        return self.module / math.cos(self.helix_angle)

    @property
    def normal_pressure_angle(self) -> float:
        """alpha_n [rad], that of the tool; of asymmetric teeth of the loaded flank."""
        return self.tooth.normal_pressure_angle

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return self.tooth.pressure_angle

    @property
    @shows("mm", "reference circle")
    def pitch_radius(self) -> float:
        """Pitch radius r [m]."""
        return self.tooth.pitch_radius * self.module

    @property
    @shows("mm", "base circle")
    def base_radius(self) -> float:
        """r_b [m]."""
        return self.tooth.base_radius * self.module

    @property
    @shows("mm", "root circle")
    def root_radius(self) -> float:
        """r_f [m]."""
        return self.tooth.root_radius * self.module

    @property
    @shows("mm", "tip circle")
    def tip_radius(self) -> float:
        """r_a [m]."""
        return self.tooth.tip_radius * self.module

    @property
    @shows("mm", "root form circle")
    def form_radius(self) -> float:
        """r_Ff, where the involute starts [m]."""
        return self.tooth.form_radius * self.module

    @property
    @shows("mm", "tip form circle")
    def involute_tip_radius(self) -> float:
        """r_Fa, where the involute ends [m]."""
        return self.tooth.involute_tip_radius * self.module

    @property
    def involute_radii(self) -> tuple[float, float]:
        """Least and largest radius of the usable involute [m]."""
        low, high = sorted((self.form_radius, self.involute_tip_radius))
        return low, high

    def normal_thickness(self, radius: float) -> float:
        """Thickness of a tooth at a radius [m], normal to its helix there: s_n = s_t cos(beta) [m]."""
        arc = radius * float(self.tooth.thickness_angle(radius / self.module))
        return arc * math.cos(math.atan(self.twist * radius))

    @cached_property
    def mass_properties(self) -> MassProperties:
        """Mass, inertia and centre of gravity: the exact section of the teeth, down to the bore, with the body."""
        return mass_properties(
            self.tooth, self.module, self.face_width, self.bore_radius, self.material.density, self.body
        )

    @property
    def body_in_modules(self) -> GearBody | None:
        """Rim, web and hub in normal modules, as finite elements take them; None of a disc."""
        if self.body is None or self.body.is_disc(self.face_width):
            return None
        return self.body.scaled(1.0 / self.module)

    @property
    def support_in_modules(self) -> RimSupport | None:
        """What carries the rim, in normal modules; None of a held one."""
        return None if self.support is None else self.support.scaled(1.0 / self.module)

    @property
    def base_pitch(self) -> float:
        """p_bt, across the axis [m]."""
        return self.tooth.base_pitch * self.module

    @property
    def plane_modulus(self) -> float:
        """E / (1 - nu^2) in plane strain, E in plane stress [Pa]."""
        return self.material.plane_modulus(self.plane_assumption)
