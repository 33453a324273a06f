"""``[gear.NAME]``: one gear of a scene."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Self

from pydantic import model_validator

from fegear.base.errors import GeometryError, InputError
from fegear.case.gear_checks import check_asymmetric, check_helical, check_internal, check_odd_teeth, check_web
from fegear.case.gear_keys import GearKeys
from fegear.case.part import at, refuse
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import USUAL_RING_RIM, Gear
from fegear.geometry.inspection import span
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_side import Flank, InvoluteSide

if TYPE_CHECKING:
    from fegear.case.fillet import FindFile
    from fegear.case.relief import LeadPart, MeasuredPart, ReliefPart
    from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalSide
    from fegear.geometry.asymmetric_tooth import AsymmetricSide

#: Names of the geometry layer that a case file calls otherwise.
_KEYS = {
    "tip_rounding": "tip_radius_rounding",
    "rack.pressure_angle": "pressure_angle",
    "rack.drive.pressure_angle": "pressure_angle",
    "rack.coast.pressure_angle": "coast_pressure_angle",
    "rack.drive.tip_radius": "rack.tip_radius",
    "rack.coast.tip_radius": "rack.coast_tip_radius",
}


class GearPart(GearKeys):
    """One gear: tooth, size, body and material."""

    def rim(self, root_radius: float) -> float | None:
        """s_R [m]: as given, else what a given bore leaves below the root circle [m]; None of a solid gear."""
        if self.body is not None:
            return self.body.rim_thickness
        if self.rim_thickness is not None or self.bore is None:
            return self.rim_thickness
        return root_radius - self.bore

    @property
    def gives_rim(self) -> bool:
        """Whether the case says how thick the body under the teeth is, so that it is not fegear's assumption."""
        if self.internal:
            return self.outer_radius is not None or self.rim_thickness is not None
        return self.bore is not None

    @property
    def web(self) -> float | None:
        """b_s [m], of the body or for the ratings alone; None of a disc."""
        return self.web_thickness if self.body is None else self.body.web_thickness

    def relief_of(self, flank: Flank | None) -> ReliefPart | None:
        """Profile modification of a flank of asymmetric teeth, or of both of equal ones (None)."""
        return self.coast_relief if flank == "coast" else self.relief

    def lead_of(self, flank: Flank | None) -> tuple[LeadPart | None, str]:
        """Lead modification as of `relief_of`, and its key: one for both flanks unless the coast flanks have theirs."""
        if flank == "coast" and self.coast_lead is not None:
            return self.coast_lead, "coast_lead"
        return self.lead, "lead"

    def measured_of(self, flank: Flank | None) -> tuple[MeasuredPart | None, str]:
        """Measured flanks as of `relief_of`, and their key."""
        return (self.coast_measured, "coast_measured") if flank == "coast" else (self.measured, "measured")

    @property
    def over_face(self) -> tuple[str, ...]:
        """Keys that say what is ground off over the face, of those that are given."""
        keys = ("lead", "coast_lead", "bias", "topography")
        given = tuple(key for key in keys if getattr(self, key) is not None)
        measured = {"measured": self.measured, "coast_measured": self.coast_measured}
        wide = (key for key, part in measured.items() if part is not None and (part.lead or part.topography))
        return (*given, *wide)

    @property
    def relieved(self) -> bool:
        """Whether its profile is drawn, or measured, to differ from an involute."""
        measured = any(part is not None and part.profile for part in (self.measured, self.coast_measured))
        return measured or self.relief is not None or self.coast_relief is not None

    @model_validator(mode="after")
    def _one_gear(self) -> Self:
        if self.tolerance_class is not None and self.face_width is None:
            raise refuse(
                "is required for the helix tolerances of tolerance_class", 'set face_width = "20 mm"',
                key="face_width",
            )  # fmt: skip
        if self.bore_radius is not None and self.bore_diameter is not None:
            raise refuse("contradicts bore_radius", "specify one of them", key="bore_diameter")
        check_web(self)
        if not self.internal and self.rim_support is not None:
            self.rim_support.check_external(self)
        check_internal(self)
        check_asymmetric(self)
        check_odd_teeth(self)
        if self.is_helical:
            check_helical(self)
            return self
        if self.plane == "auto" and self.face_width is None:
            raise refuse('is required for plane = "auto"', 'set face_width = "6.35 mm"', key="face_width")
        return self

    def build(self, prefix: str, find: FindFile | None = None) -> Gear:
        """Make the gear; errors of the geometry are reported under the keys of the case file.

        Without a bore radius the body is held fast at half the root radius; without a face width the gear is 1 mm
        wide, which no plane result per unit width depends on.
        """
        m = self.module_length
        try:
            tooth: InvoluteSide = self._tooth(m)
            if self.fillet is not None or self.coast_fillet is not None:
                from fegear.case.fillet import with_fillets_of_case

                tooth = with_fillets_of_case(tooth, m, find, self.fillet, self.coast_fillet)
            width = 1e-3 if self.face_width is None else self.face_width
            held = self._held_radius(tooth.root_radius * m)
            body = None if self.body is None else self.body.build(tooth.root_radius * m, held, width)
            support = None if self.rim_support is None else self.rim_support.build(width)
            gear = Gear(tooth, m, held, width, self.material.build(), self.plane, self.hand or "spur", body, support)
            if self.ball_diameter is not None:
                from fegear.geometry.over_balls import over_balls

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

    def _tooth(self, module: float) -> Tooth | InternalTooth | AsymmetricSide | AsymmetricInternalSide:
        """The tooth in modules, as the rack or the cutter makes it; an asymmetric one is seen from its drive flank."""
        tip = math.nan if self.tip_diameter is None else 0.5 * self.tip_diameter / module
        shape = (
            self.x, self.allowance / module, tip, self.tip_radius_rounding / module,
            self.tip_chamfer / module, self.helix_angle or 0.0,
        )  # fmt: skip
        coast = self.pressure_angle if self.coast_pressure_angle is None else self.coast_pressure_angle
        if (cutter := self.cutter) is not None and self.asymmetric:
            from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalTooth

            if cutter.teeth is None:
                raise InputError("cutter.teeth", "(not given)", "is required for asymmetric teeth",
                                 f"set cutter.teeth = {max(2 * self.teeth // 5, 5)}")  # fmt: skip
            beside = cutter.tip_radius if cutter.coast_tip_radius is None else cutter.coast_tip_radius
            made = cutter.build(module, cutter.teeth)
            return AsymmetricInternalTooth(self.teeth, made, self.pressure_angle, coast, beside, *shape).drive
        if cutter is not None:
            return self._cut(
                cutter.teeth,
                lambda z0: InternalTooth(self.teeth, cutter.build(module, z0), self.pressure_angle, *shape),
            )
        if self.asymmetric:
            from fegear.geometry.asymmetric_tooth import AsymmetricTooth

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
        return 0.5 * root_radius if self.bore is None else self.bore

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

        if error.key == "bore_radius" and self.bore_diameter is not None:
            given = f"{self.bore_diameter * 1e3:.6g} mm"
            return InputError("bore_diameter", given, f"(radius {error.value}) {error.rule}", error.remedy)
        if error.key in ("tip_rounding", "tip_chamfer"):
            length = self.tip_radius_rounding if error.key == "tip_rounding" else self.tip_chamfer
            return InputError(error.key, f"{length * 1e3:.6g} mm", in_mm(error.rule), in_mm(error.remedy))
        if error.key.removeprefix("coast_").startswith("fillet"):
            return InputError(error.key, in_mm(str(error.value)), in_mm(error.rule), in_mm(error.remedy))
        if error.key != "tip_radius":
            return error
        rule, remedy = in_mm(f"the tip radius of {error.value} modules {error.rule}"), in_mm(error.remedy)
        if self.tip_diameter is None:
            return InputError("profile_shift", self.profile_shift, rule, remedy)
        return InputError("tip_diameter", f"{self.tip_diameter * 1e3:.6g} mm", rule, remedy)
