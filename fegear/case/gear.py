"""``[gear.NAME]``: one gear of a scene."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.errors import GeometryError, InputError
from fegear.case.deviations import DeviationsPart
from fegear.case.gear_body import GearBodyPart, RimSupportPart
from fegear.case.gear_tool import CutterPart, RackPart
from fegear.case.part import (
    Angle,
    LengthOrZero,
    Number,
    Part,
    PositiveDensity,
    PositiveInverseLength,
    PositiveLength,
    PositivePressure,
    Table,
    at,
    refuse,
)
from fegear.case.relief import BiasPart, LeadPart, MeasuredPart, ReliefPart, SpacingErrorsPart, TopographyPart
from fegear.case.strength import StrengthPart
from fegear.case.surface import FlankTreatment, RoughnessPart
from fegear.geometry.gear import USUAL_RING_RIM, Gear, Material
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.over_balls import over_balls
from fegear.geometry.plausible import refuse_material
from fegear.geometry.tooth import Tooth

#: Names of the geometry layer that a case file calls otherwise.
_KEYS = {
    "tip_rounding": "tip_radius_rounding",
    "rack.pressure_angle": "pressure_angle",
}


class MaterialPart(Part):
    """``material = { young_modulus, poisson_ratio, density }``."""

    young_modulus: PositivePressure = Field(default=206.8e9, description="Young's modulus.")
    poisson_ratio: Number = Field(
        default=0.3, description="Poisson's ratio, below 0.5 (in plane strain at most 0.4999)."
    )
    density: PositiveDensity = Field(default=7850.0, description="Density, for inertia.")

    def build(self) -> Material:
        """Make the material."""
        made = Material(self.young_modulus, self.poisson_ratio, self.density)
        refuse_material(made.young_modulus, made.density)
        return made


#: Keys of gears that an internal one has not, and what it has instead.
_EXTERNAL_ONLY = {
    "rack": "describe its cutter",
    "bore_radius": "write outer_radius or rim_thickness, for its body is held outside the teeth",
    "web_thickness": "leave it out",
    "body": "write outer_radius or rim_thickness",
    "tooth_mesh": "leave it out: its mesh is generated",
    "tooth_mesh_fillet": "leave it out",
}


class GearPart(Part):
    """One gear: tooth, size, body and material."""

    teeth: int = Field(description="Number of teeth, 5 to 1000.")
    module: PositiveLength | None = Field(
        default=None, description="Module, the pitch diameter over the number of teeth; give this or `diametral_pitch`."
    )
    diametral_pitch: PositiveInverseLength | None = Field(
        default=None, description="Diametral pitch, teeth per length of pitch diameter; give this or `module`."
    )
    pressure_angle: Angle = Field(default=math.radians(20.0), description="Pressure angle of the basic rack.")
    profile_shift: Number = Field(
        default=0.0, description="Profile shift coefficient x: how far the rack is moved outward, in modules."
    )
    rack: Table[RackPart] = Field(
        default_factory=RackPart,
        description="The basic rack that cuts the gear: a profile of ISO 53 by name, or a table in modules; without "
        "it ISO 53 C.",
    )
    thickness_allowance: LengthOrZero = Field(
        default=0.0, description="Reduction of the tooth thickness at the pitch circle, cut by feeding the rack deeper."
    )
    tip_diameter: PositiveLength | None = Field(
        default=None,
        description="Diameter of the tip circle; without it the pitch diameter plus 2 (x + addendum) modules.",
    )
    tip_radius_rounding: LengthOrZero = Field(
        default=0.0, description="Radius that rounds the edge between flank and tip circle; zero leaves it sharp."
    )
    tip_chamfer: LengthOrZero = Field(
        default=0.0, description="Height of the chamfer between flank and tip circle; zero leaves the edge sharp."
    )
    bore_radius: PositiveLength | None = Field(
        default=None,
        description="Radius at which the body is held fast, inside the root circle; without it half the root radius.",
    )
    internal: bool = Field(
        default=False,
        description="Whether the gear is a ring gear, whose teeth point toward its centre; it wants a `cutter`. A "
        "positive `profile_shift` moves its teeth toward their tips (ISO 21771), so that its diameters shrink.",
    )
    cutter: Table[CutterPart] | None = Field(
        default=None, description="The pinion-type cutter that cuts an internal gear, in the place of `rack`."
    )
    outer_radius: PositiveLength | None = Field(
        default=None,
        description="Radius at which an internal gear is held fast, outside its root circle; give this or "
        "`rim_thickness`.",
    )
    rim_thickness: PositiveLength | None = Field(
        default=None,
        description="Rim s_R below the root circle, for Y_B, C_R and K_B of the ratings; without it what `bore_radius` "
        f"leaves, or none. Internal gears: the held rim outside it, without it {USUAL_RING_RIM:g} modules.",
    )
    web_thickness: PositiveLength | None = Field(
        default=None,
        description="Thickness b_s of the web that carries the rim, for C_R of ISO 6336-1, at most twice the face; "
        "`bore_radius` is then the inside of the rim. Without it the body is a disc as wide as the face.",
    )
    body: Table[GearBodyPart] | None = Field(
        default=None,
        description="Rim, web and hub of a gear that is solved with its width, its bore held over the hub; without it "
        "the body is a disc as wide as the face.",
    )
    rim_support: Table[RimSupportPart] | None = Field(
        default=None,
        description="What carries the rim of an internal gear: pins or a spline; without it its outer circle is held.",
    )
    face_width: PositiveLength | None = Field(
        default=None, description="Width of the gear; without it 1 mm, which no result per unit width depends on."
    )
    ball_diameter: PositiveLength | None = Field(
        default=None,
        description="Diameter of the balls or pins over which M_dK is given; without it the next preferred number (R "
        "40) above the ball that touches at the V-circle.",
    )
    plane: Literal["strain", "stress", "auto"] = Field(
        default="strain",
        description="Plane strain, plane stress, or `auto`: strain where the face is at least five tooth thicknesses "
        "wide.",
    )
    material: Table[MaterialPart] = Field(
        default_factory=MaterialPart, description="Elasticity and density of the gear; without it steel."
    )
    strength: Table[StrengthPart] | None = Field(
        default=None,
        description="Strength of the material (allowable stress numbers), for the result rating: kind, quality and "
        "hardness.",
    )
    tooth_mesh: str | None = Field(
        default=None,
        description="File with a finite-element mesh of your own of the tooth sector; without it one is generated.",
    )
    tooth_mesh_fillet: Literal["rack", "own"] = Field(
        default="rack",
        description="Whether the fillet of `tooth_mesh` is compared with the one that the rack cuts, or is your own "
        "(optimised, ground).",
    )
    relief: Table[ReliefPart] | None = Field(
        default=None,
        description="Profile modification of every tooth; its parts add up, and it needs the effect `relief`.",
    )
    lead: Table[LeadPart] | None = Field(
        default=None,
        description="Modification of every flank over the face, the same at every height; it needs the effect "
        "`relief`.",
    )
    bias: Table[BiasPart] | None = Field(
        default=None,
        description="Twist S_alpha: the profile slope at end II less that at end I; it needs the effect `relief`.",
    )
    topography: Table[TopographyPart] | None = Field(
        default=None,
        description="Modification of every flank by a table over roll angle and face; it needs the effect `relief`.",
    )
    measured: Table[MeasuredPart] | None = Field(
        default=None,
        description="Measured profiles, helices or flanks in the place of those that are drawn; they need the effect "
        "`relief`.",
    )
    spacing_errors: Table[SpacingErrorsPart] | None = Field(
        default=None,
        description="One accumulated error for each tooth in the order of meshing, positive where the flank lies "
        "back; it needs the effect `spacing_errors`.",
    )
    roughness: Table[RoughnessPart] | None = Field(
        default=None, description="of flanks and root fillets, for scuffing, micropitting, friction and rating"
    )
    flank_treatment: FlankTreatment | None = Field(
        default=None,
        description="what was done to the flanks: X_W of scuffing (default: that of `through-hardened`, 1) and W_W of "
        "micropitting (default: by the gear's `strength`, else 1)",
    )
    tolerance_class: Annotated[int, Field(ge=1, le=11)] | None = Field(
        default=None,
        description="Flank tolerance class of ISO 1328-1:2013, 1 (tightest) to 11; it wants a `face_width`.",
    )
    deviations: Table[DeviationsPart] | None = Field(
        default=None,
        description="Own deviations of the flanks, in the place of those by `tolerance_class` in a rating and in "
        "`robustness`; a gear outside the sizes of ISO 1328-1 has no others.",
    )
    helix_angle: Angle | None = Field(
        default=None, description="Helix angle on the pitch cylinder, up to 60 deg; without it the gear is a spur gear."
    )
    hand: Literal["left", "right", "spur"] | None = Field(
        default=None, description="Which way the helix winds; `spur` goes with a helix angle of zero."
    )
    normal_module: PositiveLength | None = Field(
        default=None,
        description="Module in the normal section of a helical gear; give this or `normal_diametral_pitch`.",
    )
    normal_diametral_pitch: PositiveInverseLength | None = Field(
        default=None,
        description="Diametral pitch in the normal section of a helical gear; give this or `normal_module`.",
    )

    def rim(self, root_radius: float) -> float | None:
        """s_R [m]: as given, else what a given bore leaves below the root circle [m]; None of a solid gear."""
        if self.body is not None:
            return self.body.rim_thickness
        if self.rim_thickness is not None or self.bore_radius is None:
            return self.rim_thickness
        return root_radius - self.bore_radius

    @property
    def gives_rim(self) -> bool:
        """Whether the case says how thick the body under the teeth is, so that it is not fegear's assumption."""
        if self.internal:
            return self.outer_radius is not None or self.rim_thickness is not None
        return self.bore_radius is not None

    @property
    def web(self) -> float | None:
        """b_s [m], of the body or for the ratings alone; None of a disc."""
        return self.web_thickness if self.body is None else self.body.web_thickness

    @property
    def over_face(self) -> tuple[str, ...]:
        """Keys that say what is ground off over the face, of those that are given."""
        given = tuple(key for key in ("lead", "bias", "topography") if getattr(self, key) is not None)
        wide = self.measured is not None and (self.measured.lead or self.measured.topography)
        return (*given, "measured") if wide else given

    @property
    def relieved(self) -> bool:
        """Whether its profile is drawn, or measured, to differ from an involute."""
        return self.relief is not None or (self.measured is not None and self.measured.profile is not None)

    @property
    def is_helical(self) -> bool:
        """Whether the gear is described as a helical one (of helix angle zero as the limit)."""
        return self.helix_angle is not None

    @property
    def has_helix(self) -> bool:
        """Whether its teeth are not straight."""
        return bool(self.helix_angle)

    @model_validator(mode="after")
    def _one_size(self) -> Self:
        if self.tolerance_class is not None and self.face_width is None:
            raise refuse(
                "is missing, but helix tolerances of a tolerance_class depend on it", 'write face_width = "20 mm"',
                key="face_width",
            )  # fmt: skip
        self._check_web()
        self._check_internal()
        if self.is_helical:
            self._check_helical()
            return self
        for key in ("hand", "normal_module", "normal_diametral_pitch"):
            if getattr(self, key) is not None:
                raise refuse("has a meaning only with helix_angle", 'write helix_angle = "30 deg"', key=key)
        if self.module is None and self.diametral_pitch is None:
            raise refuse("is missing", 'write module = "3.175 mm" or diametral_pitch = "8 / inch"', key="module")
        if self.module is not None and self.diametral_pitch is not None:
            raise refuse("contradicts module", "give either module or diametral_pitch", key="diametral_pitch")
        if self.plane == "auto" and self.face_width is None:
            raise refuse(
                'is missing, but plane = "auto" decides by it', 'write face_width = "6.35 mm"', key="face_width"
            )
        return self

    def _check_internal(self) -> None:
        """Refuse keys of external gears on internal ones, and of internal gears on external ones."""
        if not self.internal:
            for key in ("cutter", "outer_radius", "rim_support"):
                if getattr(self, key) is not None:
                    raise refuse("has a meaning only for internal gears", "write internal = true", key=key)
            return
        for key, remedy in _EXTERNAL_ONLY.items():
            if key in self.given:
                raise refuse("has no meaning for an internal gear", remedy, key=key)
        if self.cutter is None:
            raise refuse(
                "is missing, but it makes the teeth of an internal gear",
                "write cutter = { teeth = 20, addendum = 1.25, tip_radius = 0.2 }", key="cutter",
            )  # fmt: skip
        if self.outer_radius is not None and self.rim_thickness is not None:
            raise refuse("contradicts outer_radius", "give either rim_thickness or outer_radius", key="rim_thickness")

    def _check_web(self) -> None:
        """Refuse webs of no rim, wider than any, and twice given."""
        if self.body is not None:
            for key in ("rim_thickness", "web_thickness"):
                if getattr(self, key) is not None:
                    raise refuse("contradicts body, which has its own", f"write {key} in body alone", key=key)
            for key in ("bore_radius", "face_width"):
                if getattr(self, key) is None:
                    raise refuse("is missing for a gear with a body", f'write {key} = "20 mm"', key=key)
        if self.web_thickness is None:
            return
        if self.rim_thickness is None and self.bore_radius is None:
            raise refuse(
                "is missing, but C_R of a gear with a web_thickness depends on it", 'write rim_thickness = "20 mm"',
                key="rim_thickness",
            )  # fmt: skip
        if self.face_width is None or self.web_thickness > 2.0 * self.face_width:
            raise refuse(
                "must be at most twice the face_width", "check it, or leave it out for a solid disc",
                key="web_thickness", value=f"{self.web_thickness * 1e3:.6g} mm",
            )  # fmt: skip

    def _check_helical(self) -> None:
        """Refuse sizes of the section across the axis, and keys of what is computed in a plane."""
        if (self.normal_module is None) == (self.normal_diametral_pitch is None):
            remedy = 'write normal_module = "5 mm" or normal_diametral_pitch = "5 / inch"'
            raise refuse("must be given once for a helical gear", remedy, key="normal_module")
        for key in ("module", "diametral_pitch"):
            if key in self.model_fields_set:
                raise refuse("is that of a spur gear", f"write normal_{key} for a gear with a helix_angle", key=key)
        for key in ("plane", "tooth_mesh", "tooth_mesh_fillet"):
            if self.has_helix and getattr(self, key) != type(self).model_fields[key].default:
                raise refuse(
                    "is not computed for a gear with a helix_angle yet", f"remove {key}: results do without it", key=key
                )
        for key in ("hand", "face_width"):
            if getattr(self, key) is None:
                raise refuse("is missing for a helical gear", f"give {key}", key=key)

    @property
    def module_length(self) -> float:
        """The normal module m_n [m], that of a spur gear's only section."""
        if self.is_helical:
            given = self.normal_module, self.normal_diametral_pitch
        else:
            given = self.module, self.diametral_pitch
        return given[0] if given[0] is not None else 1.0 / (given[1] or math.nan)

    def build(self, prefix: str) -> Gear:
        """Make the gear; errors of the geometry are reported under the keys of the case file.

        Without a bore radius the body is held fast at half the root radius; without a face width the gear is 1 mm
        wide, which no plane result per unit width depends on.
        """
        m = self.module_length
        try:
            tooth = self._tooth(m)
            width = 1e-3 if self.face_width is None else self.face_width
            held = self._held_radius(tooth.root_radius * m)
            body = None if self.body is None else self.body.build(tooth.root_radius * m, held, width)
            support = None if self.rim_support is None else self.rim_support.build()
            gear = Gear(tooth, m, held, width, self.material.build(), self.plane, self.hand or "spur", body, support)
            if self.ball_diameter is not None:
                over_balls(gear, self.ball_diameter)  # refuses balls that no gauge could use
            told = self.deviations is not None and self.deviations.enough_to_rate
            if self.tolerance_class is not None and not told:
                from fegear.formulas.iso1328 import tolerances_of

                tolerances_of(gear, self.tolerance_class)  # refuses sizes that the standard knows no tolerance of
        except InputError as error:
            names = _KEYS | ({"module": "normal_module"} if self.is_helical else {"normal_module": "module"})
            names |= {"bore_radius": "outer_radius"} if self.internal else {}
            raise at(prefix, self._in_words_of_the_case(error), names) from None
        return gear

    def _tooth(self, module: float) -> Tooth | InternalTooth:
        """The tooth in modules, as the rack or the cutter makes it."""
        tip = math.nan if self.tip_diameter is None else 0.5 * self.tip_diameter / module
        shape = (
            self.profile_shift, self.thickness_allowance / module, tip, self.tip_radius_rounding / module,
            self.tip_chamfer / module, self.helix_angle or 0.0,
        )  # fmt: skip
        if (cutter := self.cutter) is not None:
            return self._cut(
                cutter.teeth,
                lambda z0: InternalTooth(self.teeth, cutter.build(module, z0), self.pressure_angle, *shape),
            )
        return Tooth(self.teeth, self.rack.build(self.pressure_angle), *shape)

    def _cut(self, given: int | None, made: Callable[[int], InternalTooth]) -> InternalTooth:
        """The tooth that a cutter makes; the largest cutter that clears where none is given, and in refusals."""
        from fegear.geometry.internal_interference import largest_cutter

        if given is None:
            found = largest_cutter(made, self.teeth)
            if found is not None:
                return found
            given = max(self.teeth // 2, 5)
        try:
            return made(given)
        except GeometryError as error:
            if error.key not in ("tip_radius", "cutter.teeth"):
                raise
            found = largest_cutter(made, self.teeth)
            if found is None:
                raise
            remedy = f"set cutter.teeth = {found.cutter.teeth}, the largest cutter that clears; or {error.remedy}"
            raise GeometryError(error.key, error.value, error.rule, remedy) from None

    def _held_radius(self, root_radius: float) -> float:
        """Where the body is held [m]; refuses a rim that reaches beyond the gear's centre."""
        if self.internal:
            rim = USUAL_RING_RIM * self.module_length if self.rim_thickness is None else self.rim_thickness
            return root_radius + rim if self.outer_radius is None else self.outer_radius
        if self.rim_thickness is not None and self.rim_thickness > root_radius:
            raise InputError(
                "rim_thickness", f"{self.rim_thickness * 1e3:.6g} mm",
                f"must lie inside (0, root radius = {root_radius * 1e3:.6g} mm)", "leave it out for a solid gear",
            )  # fmt: skip
        return 0.5 * root_radius if self.bore_radius is None else self.bore_radius

    def _in_words_of_the_case(self, error: InputError) -> InputError:
        """Report lengths that the tooth takes in modules as the case gave them."""

        def in_mm(text: str) -> str:
            return re.sub(
                r"(\d[\d.e+-]*) modules", lambda found: f"{float(found[1]) * self.module_length * 1e3:.6g} mm", text
            )

        if error.key in ("tip_rounding", "tip_chamfer"):
            length = self.tip_radius_rounding if error.key == "tip_rounding" else self.tip_chamfer
            return InputError(error.key, f"{length * 1e3:.6g} mm", in_mm(error.rule), in_mm(error.remedy))
        if error.key != "tip_radius":
            return error
        rule, remedy = in_mm(f"the tip radius of {error.value} modules {error.rule}"), in_mm(error.remedy)
        if self.tip_diameter is None:
            return InputError("profile_shift", self.profile_shift, rule, remedy)
        return InputError("tip_diameter", f"{self.tip_diameter * 1e3:.6g} mm", rule, remedy)
