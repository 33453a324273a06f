"""``[gear.NAME]``: one gear of a scene."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.errors import GeometryError, InputError, shown
from fegear.case.deviations import DeviationsPart
from fegear.case.gear_body import GearBodyPart, RimSupportPart
from fegear.case.gear_material import MaterialPart
from fegear.case.gear_teeth import MEASURES, TeethPart
from fegear.case.gear_tool import CutterPart, RackPart
from fegear.case.odd_tooth import OUTLINES, OddToothPart
from fegear.case.part import (
    LengthOrZero,
    PositiveLength,
    Table,
    at,
    refuse,
)
from fegear.case.relief import (
    BiasPart,
    LeadPart,
    MeasuredPart,
    ReliefPart,
    SpacingErrorsPart,
    TopographyPart,
    several,
)
from fegear.case.strength import StrengthPart
from fegear.case.surface import FlankTreatment, RoughnessPart
from fegear.case.tolerance_class import ToleranceClass
from fegear.geometry.asymmetric_tooth import AsymmetricSide, AsymmetricTooth
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import USUAL_RING_RIM, Gear
from fegear.geometry.inspection import span
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_side import Flank
from fegear.geometry.over_balls import over_balls

#: Names of the geometry layer that a case file calls otherwise.
_KEYS = {
    "tip_rounding": "tip_radius_rounding",
    "rack.pressure_angle": "pressure_angle",
    "rack.drive.pressure_angle": "pressure_angle",
    "rack.coast.pressure_angle": "coast_pressure_angle",
    "rack.drive.tip_radius": "rack.tip_radius",
    "rack.coast.tip_radius": "rack.coast_tip_radius",
}

#: Keys of gears that an internal one has not, and what it has instead.
_EXTERNAL_ONLY = {
    "rack": "specify its cutter",
    "bore_radius": "set outer_radius or rim_thickness: the body of an internal gear is fixed at its outside",
    "web_thickness": "remove it",
    "body": "write outer_radius or rim_thickness",
    "tooth_mesh": "remove it: its mesh is generated",
    "tooth_mesh_fillet": "remove it",
    "coast_pressure_angle": "remove it: asymmetric internal gears are not available yet",
}

#: Two pressure angles that differ by less [of the angle] are one, as written in deg and in rad.
_ONE_ANGLE = 1e-12
#: Keys that are for gears with equal flanks only, and what to do with them.
_SYMMETRIC_ONLY = {
    "helix_angle": "remove it: asymmetric teeth are available for spur gears only",
    "transverse_pressure_angle": "remove it",
    "tooth_mesh": "remove it: its mesh is generated",
    "body": "remove it: asymmetric teeth are available for plane (2D) gears only",
    "rim_support": "remove it: asymmetric teeth are fixed all round the bore",
    "odd_tooth": "remove it",
    "lead": "remove it",
    "bias": "remove it",
    "topography": "remove it",
    "measured": "remove it",
    "span_teeth": "remove it: no span can be measured over flanks of two base circles",
    **dict.fromkeys(MEASURES, "set profile_shift"),
}


class GearPart(TeethPart):
    """One gear: tooth, size, body and material."""

    rack: Table[RackPart] = Field(
        default_factory=RackPart,
        description="Basic rack (tool): profile by name (`rack.profile`), or a table in modules. Default: ISO 53 C.",
    )
    tip_radius_rounding: LengthOrZero = Field(default=0.0, description="Tip rounding radius; 0: sharp tip edge.")
    tip_chamfer: LengthOrZero = Field(default=0.0, description="Height of the tip chamfer; 0: none.")
    bore_radius: PositiveLength | None = Field(
        default=None,
        description="Radius at which the gear body is fixed, inside the root circle. Default: half the root radius.",
    )
    cutter: Table[CutterPart] | None = Field(
        default=None, description="Pinion-type cutter of an internal gear, instead of `rack`."
    )
    outer_radius: PositiveLength | None = Field(
        default=None,
        description="Radius at which an internal gear is fixed, outside its root circle; alternatively "
        "`rim_thickness`.",
    )
    rim_thickness: PositiveLength | None = Field(
        default=None,
        description="Rim thickness s_R for Y_B, C_R (ISO 6336) and K_B (AGMA 2101). Default: from `bore_radius`, "
        f"otherwise solid. Internal gears: rim up to the fixed outer circle, default {USUAL_RING_RIM:g} "
        "modules.",
    )
    web_thickness: PositiveLength | None = Field(
        default=None,
        description="Web thickness b_s for C_R (ISO 6336-1), at most twice the face width; `bore_radius` is then the "
        "inner radius of the rim. Default: solid disc.",
    )
    body: Table[GearBodyPart] | None = Field(
        default=None,
        description="Rim, web and hub of a 3D gear, its bore fixed over the hub. Default: solid disc of full face "
        "width.",
    )
    rim_support: Table[RimSupportPart] | None = Field(
        default=None,
        description="Support of the rim: pins, bearing, spline, a bore free over an arc, or a web (plane gears); "
        "internal gears: pins or spline. Default: bore or outer circle fixed.",
    )
    face_width: PositiveLength | None = Field(
        default=None, description="Face width. Default: 1 mm (results per unit width do not depend on it)."
    )
    plane: Literal["strain", "stress", "auto"] = Field(
        default="strain",
        description="Plane strain, plane stress or `auto` (plane strain if the face width is at least five tooth "
        "thicknesses).",
    )
    material: Table[MaterialPart] = Field(
        default_factory=MaterialPart, description="Elastic constants and density. Default: steel."
    )
    strength: Table[StrengthPart] | None = Field(
        default=None,
        description="Material for rating: type, quality (ML, MQ, ME) and hardness (allowable stress numbers of ISO "
        "6336-5).",
    )
    tooth_mesh: str | None = Field(
        default=None,
        description="File with a user FE mesh of the tooth sector. Default: generated.",
    )
    tooth_mesh_fillet: Literal["rack", "own"] = Field(
        default="rack",
        description="Fillet of `tooth_mesh`: checked against the generated fillet, or `own` (optimised, ground).",
    )
    relief: Table[ReliefPart] | None = Field(
        default=None,
        description="Profile modification of all teeth (sum of its parts); active with the effect `relief`.",
    )
    coast_relief: Table[ReliefPart] | None = Field(
        default=None,
        description="Profile modification of the coast flanks of asymmetric teeth; `relief` is that of the drive "
        "flanks.",
    )
    lead: Table[LeadPart] | None = Field(
        default=None,
        description="Flank line (lead) modification, the same at every tooth height; active with the effect `relief`.",
    )
    bias: Table[BiasPart] | None = Field(
        default=None,
        description="Flank twist S_alpha: profile slope at end II minus that at end I; active with effects.relief.",
    )
    topography: Table[TopographyPart] | None = Field(
        default=None,
        description="Flank modification by a table over roll angle and face width; active with the effect `relief`.",
    )
    measured: Table[MeasuredPart] | None = Field(
        default=None,
        description="Measured profiles, helices or flanks instead of the nominal ones; active with the effect "
        "`relief`.",
    )
    spacing_errors: Table[SpacingErrorsPart] | None = Field(
        default=None,
        description="Cumulative pitch deviation of each tooth in meshing order, positive for missing material; "
        "active with effects.spacing_errors.",
    )
    odd_tooth: Annotated[list[Table[OddToothPart]], several(OddToothPart)] = Field(
        default_factory=list,
        description="Teeth that differ (crack, missing, broken, shorter, pits), a table for each "
        "([[gear.NAME.odd_tooth]]); spur gears in plane (2D) pairs; active with effects.odd_teeth.",
    )
    roughness: Table[RoughnessPart] | None = Field(
        default=None,
        description="Roughness of flanks and root fillets, for scuffing, micropitting, friction and rating.",
    )
    flank_treatment: FlankTreatment | None = Field(
        default=None,
        description="what was done to the flanks: X_W of scuffing (default: that of `through-hardened`, 1) and W_W of "
        "micropitting (default: by the gear's `strength`, else 1)",
    )
    tolerance_class: ToleranceClass | None = Field(
        default=None,
        description="Flank tolerance class of ISO 1328-1:2013, 1 (tightest) to 11, or by name as `ISO 1328-1 6`; "
        "requires `face_width`.",
    )
    deviations: Table[DeviationsPart] | None = Field(
        default=None,
        description="User-defined flank deviations, replacing those of `tolerance_class` in rating and `robustness`. "
        "Required outside the size range of ISO 1328-1.",
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

    def relief_of(self, flank: Flank | None) -> ReliefPart | None:
        """Profile modification of a flank of asymmetric teeth, or of both of equal ones (None)."""
        return self.coast_relief if flank == "coast" else self.relief

    @property
    def over_face(self) -> tuple[str, ...]:
        """Keys that say what is ground off over the face, of those that are given."""
        given = tuple(key for key in ("lead", "bias", "topography") if getattr(self, key) is not None)
        wide = self.measured is not None and (self.measured.lead or self.measured.topography)
        return (*given, "measured") if wide else given

    @property
    def relieved(self) -> bool:
        """Whether its profile is drawn, or measured, to differ from an involute."""
        measured = self.measured is not None and self.measured.profile is not None
        return measured or self.relief is not None or self.coast_relief is not None

    @model_validator(mode="after")
    def _one_gear(self) -> Self:
        if self.tolerance_class is not None and self.face_width is None:
            raise refuse(
                "is required for the helix tolerances of tolerance_class", 'set face_width = "20 mm"',
                key="face_width",
            )  # fmt: skip
        self._check_web()
        if not self.internal and self.rim_support is not None:
            self.rim_support.check_external(self)
        self._check_internal()
        self._check_asymmetric()
        self._check_odd_teeth()
        if self.is_helical:
            self._check_helical()
            return self
        if self.plane == "auto" and self.face_width is None:
            raise refuse('is required for plane = "auto"', 'set face_width = "6.35 mm"', key="face_width")
        return self

    def _check_internal(self) -> None:
        """Refuse keys of external gears on internal ones, and of internal gears on external ones."""
        if not self.internal:
            for key in ("cutter", "outer_radius"):
                if getattr(self, key) is not None:
                    raise refuse("applies only to internal gears", "set internal = true", key=key)
            return
        for key, remedy in _EXTERNAL_ONLY.items():
            if key in self.given:
                raise refuse("is not used for an internal gear", remedy, key=key)
        if self.cutter is None:
            raise refuse(
                "is required for an internal gear",
                "set cutter = { teeth = 20, addendum = 1.25, tip_radius = 0.2 }", key="cutter",
            )  # fmt: skip
        if self.outer_radius is not None and self.rim_thickness is not None:
            raise refuse(
                "contradicts outer_radius", "specify either rim_thickness or outer_radius", key="rim_thickness"
            )

    @property
    def asymmetric(self) -> bool:
        """Whether the two flanks of its teeth differ."""
        angle, tip = self.coast_pressure_angle, self.rack.coast_tip_radius
        return (angle is not None and not math.isclose(angle, self.pressure_angle, rel_tol=_ONE_ANGLE)) or (
            tip is not None and tip != self.rack.tip_radius
        )

    def _check_asymmetric(self) -> None:
        """Refuse keys of equal flanks on others."""
        if self.rack.coast_tip_radius is not None and not isinstance(self.rack.tip_radius, float):
            raise refuse(
                "is required for rack.coast_tip_radius", "set rack.tip_radius = 0.25", key="rack.tip_radius",
                value=self.rack.tip_radius,
            )  # fmt: skip
        if not self.asymmetric:
            if self.coast_relief is not None:
                raise refuse("requires asymmetric teeth", "specify relief (both flanks)", key="coast_relief")
            return
        for key, remedy in _SYMMETRIC_ONLY.items():
            if key in self.given:
                raise refuse("is not available for asymmetric teeth", remedy, key=key)
        for key in ("protuberance", "grinding_allowance"):
            if getattr(self.rack, key):
                raise refuse("is not available for asymmetric teeth", "remove it", key=f"rack.{key}")
        if isinstance(self.profile_shift, str):
            raise refuse(
                "is not available for asymmetric teeth", "give the profile shift as a number", key="profile_shift",
                value=shown(self.profile_shift),
            )  # fmt: skip

    def _check_odd_teeth(self) -> None:
        """Refuse odd teeth of gears that are not solved with them, that are no teeth of theirs, and twice given."""
        if not self.odd_tooth:
            return
        if self.has_helix:
            raise refuse("is not available for helical gears yet (spur gears only)", "remove it", key="odd_tooth")
        for n, one in enumerate(self.odd_tooth if self.internal else []):
            outline = next((key for key in OUTLINES if getattr(one, key)), None)
            if outline is not None:
                raise refuse(
                    "is not available for internal gears yet",
                    "describe a crack or pits",
                    key=f"odd_tooth[{n}].{outline}",
                )
        if self.tooth_mesh is not None:
            raise refuse("requires the generated mesh", "remove tooth_mesh", key="odd_tooth")
        numbers = [one.tooth for one in self.odd_tooth]
        for n, number in enumerate(numbers):
            if number >= self.teeth:
                raise refuse(
                    f"must be less than {self.teeth}, the number of teeth (the first tooth is 0)",
                    f"specify at most {self.teeth - 1}", key=f"odd_tooth[{n}].tooth", value=number,
                )  # fmt: skip
            if number in numbers[:n]:
                raise refuse(
                    "is specified twice", "merge both tables, or change one number", key=f"odd_tooth[{n}].tooth",
                    value=number,
                )  # fmt: skip

    def _check_web(self) -> None:
        """Refuse webs of no rim, wider than any, and twice given."""
        if self.body is not None:
            for key in ("rim_thickness", "web_thickness"):
                if getattr(self, key) is not None:
                    raise refuse("contradicts body.{key}", f"specify {key} in body only", key=key)
            for key in ("bore_radius", "face_width"):
                if getattr(self, key) is None:
                    raise refuse("is required for a gear with a body", f'set {key} = "20 mm"', key=key)
        if self.web_thickness is None:
            return
        if self.rim_thickness is None and self.bore_radius is None:
            raise refuse(
                "is required for C_R of a gear with web_thickness", 'set rim_thickness = "20 mm"',
                key="rim_thickness",
            )  # fmt: skip
        if self.face_width is None or self.web_thickness > 2.0 * self.face_width:
            raise refuse(
                "must be at most twice the face_width", "check it, or remove it for a solid disc",
                key="web_thickness", value=f"{self.web_thickness * 1e3:.6g} mm",
            )  # fmt: skip

    def _check_helical(self) -> None:
        """Refuse keys of what is computed in a plane, and what a helical gear cannot do without."""
        for key in ("plane", "tooth_mesh", "tooth_mesh_fillet"):
            if self.has_helix and getattr(self, key) != type(self).model_fields[key].default:
                raise refuse("is not available for helical gears", f"remove {key} (not needed for results)", key=key)
        for key in ("hand", "face_width"):
            if getattr(self, key) is None:
                raise refuse("is required for a helical gear", f"specify {key}", key=key)

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
            support = None if self.rim_support is None else self.rim_support.build(width)
            gear = Gear(tooth, m, held, width, self.material.build(), self.plane, self.hand or "spur", body, support)
            if self.ball_diameter is not None:
                over_balls(gear, self.ball_diameter)  # refuses balls that no gauge could use
            if self.span_teeth is not None:
                self._refuse_span(gear)
            told = self.deviations is not None and self.deviations.enough_to_rate
            if self.tolerance_class is not None and not told:
                from fegear.formulas.iso1328 import tolerances_of

                tolerances_of(gear, self.tolerance_class)  # refuses sizes that the standard knows no tolerance of
        except InputError as error:
            names = _KEYS | ({"module": "normal_module"} if self.is_helical else {"normal_module": "module"})
            names |= {"bore_radius": "outer_radius"} if self.internal else {}
            raise at(prefix, self._of_measure(self._in_words_of_the_case(error)), names) from None
        return gear

    def _refuse_span(self, gear: Gear) -> None:
        """Refuse teeth over which no disc micrometer could measure."""
        try:
            span(gear, self.span_teeth or 1)
        except GeometryError as error:
            if error.key != "teeth":
                raise
            raise GeometryError("span_teeth", error.value, error.rule, error.remedy) from None

    def _tooth(self, module: float) -> Tooth | InternalTooth | AsymmetricSide:
        """The tooth in modules, as the rack or the cutter makes it; an asymmetric one is seen from its drive flank."""
        tip = math.nan if self.tip_diameter is None else 0.5 * self.tip_diameter / module
        shape = (
            self.x, self.allowance / module, tip, self.tip_radius_rounding / module,
            self.tip_chamfer / module, self.helix_angle or 0.0,
        )  # fmt: skip
        if (cutter := self.cutter) is not None:
            return self._cut(
                cutter.teeth,
                lambda z0: InternalTooth(self.teeth, cutter.build(module, z0), self.pressure_angle, *shape),
            )
        if self.asymmetric:
            coast = self.pressure_angle if self.coast_pressure_angle is None else self.coast_pressure_angle
            rack = self.rack.build_asymmetric(self.pressure_angle, coast, module)
            return AsymmetricTooth(self.teeth, rack, *shape).drive
        return Tooth(self.teeth, self.rack.build(self.pressure_angle, module), *shape)

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
            remedy = (
                f"set cutter.teeth = {found.cutter.teeth}, the largest cutter without interference; or {error.remedy}"
            )
            raise GeometryError(error.key, error.value, error.rule, remedy) from None

    def _held_radius(self, root_radius: float) -> float:
        """Where the body is held [m]; refuses a rim that reaches beyond the gear's centre."""
        if self.internal:
            rim = USUAL_RING_RIM * self.module_length if self.rim_thickness is None else self.rim_thickness
            return root_radius + rim if self.outer_radius is None else self.outer_radius
        if self.rim_thickness is not None and self.rim_thickness > root_radius:
            raise InputError(
                "rim_thickness", f"{self.rim_thickness * 1e3:.6g} mm",
                f"must be between 0 and the root radius {root_radius * 1e3:.6g} mm", "remove it for a solid gear",
            )  # fmt: skip
        return 0.5 * root_radius if self.bore_radius is None else self.bore_radius

    def _of_measure(self, error: InputError) -> InputError:
        """Report a profile shift under the dimension from which it was derived."""
        measure = self.measure
        if error.key != "profile_shift" or measure is None:
            return error
        given = f"{getattr(self, measure) * 1e3:.6g} mm"
        link = ": " if error.rule.startswith("the ") else ", which "
        return InputError(measure, given, f"gives x = {self.x:.4g}{link}{error.rule}", "check the dimension")

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
