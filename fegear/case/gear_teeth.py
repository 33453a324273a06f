"""Teeth of ``[gear.NAME]``: their number, size, angles and thickness, each as drawings and handbooks give it.

What is another name of one number (a circular pitch, a span over k teeth) stays here as it was written;
`fegear.case.settled` makes module, profile shift and thickness allowance of it.
"""

from __future__ import annotations

import math
import re
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, ValidationInfo, model_validator

from fegear.base.errors import shown
from fegear.case.part import (
    QUANTITY,
    Angle,
    Number,
    Part,
    PositiveInverseLength,
    PositiveLength,
    quantity,
    refuse,
)

#: Thickness allowance that follows from a thickness and the profile shift.
DERIVED = "derived"
#: Dimensions from which the profile shift follows, as columns of `geometry` are called.
MEASURES = ("tooth_thickness", "span", "over_balls", "over_pins", "chordal_thickness")
#: Each with the key that it cannot do without, and an example.
_NEEDS = {
    "span": ("span_teeth", "span_teeth = 3"),
    "over_balls": ("ball_diameter", 'ball_diameter = "5 mm"'),
    "over_pins": ("ball_diameter", 'ball_diameter = "5 mm"'),
    "chordal_height": ("tip_diameter", 'tip_diameter = "78 mm"'),
}
#: Designations of DIN 3967: cd25, 25cd, DIN 3967 cd 25.
_SERIES = "ab|bc|cd|[a-h]"
_FIT = rf"(?:DIN ?3967[ -]?)?(?:(?:{_SERIES}) ?(?:2[1-9]|30)|(?:2[1-9]|30) ?(?:{_SERIES}))"
_LENGTH = quantity("length", positive=True)


def _mean_of_limits(value: Any, info: ValidationInfo) -> Any:
    """The mean of both limits of a drawing; a single length stays as it is."""
    if not isinstance(value, (list, tuple)):
        return _LENGTH.func(value, info)  # type: ignore[call-arg]  # pydantic allows validators without info, too
    if len(value) != 2:
        raise refuse("must be one length or both its limits", 'for example ["23.33 mm", "23.37 mm"]', value="(a list)")
    low, high = (_LENGTH.func(limit, info) for limit in value)  # type: ignore[call-arg]  # as above
    return 0.5 * (low + high)


_WRITTEN = Annotated[str, Field(json_schema_extra={QUANTITY: "length"})]
#: A length, or both its limits on the drawing.
Toleranced = Annotated[float, BeforeValidator(_mean_of_limits, json_schema_input_type=_WRITTEN | list[_WRITTEN])]


def _allowance(value: Any, info: ValidationInfo) -> Any:
    """A length, the designation of DIN 3967, or what the thickness of the tooth says."""
    if isinstance(value, str):
        text = " ".join(value.split())
        if text == DERIVED or re.fullmatch(_FIT, text):
            return text
        if text[:1].isalpha():
            raise refuse(
                "is neither a length nor a designation of DIN 3967 (a to h with 21 to 30)",
                'for example "45 um", "cd25" or "derived"', value=shown(value),
            )  # fmt: skip
    return quantity("length", not_negative=True).func(value, info)  # type: ignore[call-arg]  # pydantic allows validators without info, too


_DESIGNATION = Annotated[str, Field(pattern=f"^({_FIT}|{DERIVED})$", json_schema_extra={"examples": ["cd25"]})]
Allowance = Annotated[
    float | str,
    BeforeValidator(
        _allowance,
        json_schema_input_type=Annotated[str, Field(json_schema_extra={QUANTITY: "length"})] | _DESIGNATION,
    ),
]


class TeethPart(Part):
    """Number, size, angles and thickness of the teeth of a gear."""

    teeth: int = Field(description="Number of teeth, 5 to 1000.")
    module: PositiveLength | None = Field(
        default=None, description="Module m; alternatively `diametral_pitch` or `circular_pitch`."
    )
    diametral_pitch: PositiveInverseLength | None = Field(
        default=None, description="Diametral pitch, teeth per length of reference diameter; alternatively `module`."
    )
    circular_pitch: PositiveLength | None = Field(
        default=None, description="Circular pitch p = pi m; alternatively `module`."
    )
    helix_angle: Angle | None = Field(
        default=None, description="Helix angle at the reference cylinder, up to 60 deg. Default: 0 (spur gear)."
    )
    hand: Literal["left", "right", "spur"] | None = Field(
        default=None, description="Hand of helix, `left` or `right`; `spur` for zero helix angle."
    )
    normal_module: PositiveLength | None = Field(
        default=None,
        description="Normal module m_n of a helical gear; alternatively `normal_diametral_pitch`, "
        "`normal_circular_pitch` or `transverse_module`.",
    )
    normal_diametral_pitch: PositiveInverseLength | None = Field(
        default=None,
        description="Normal diametral pitch of a helical gear; alternatively `normal_module`.",
    )
    normal_circular_pitch: PositiveLength | None = Field(
        default=None, description="Normal circular pitch p_n = pi m_n of a helical gear; alternatively `normal_module`."
    )
    transverse_module: PositiveLength | None = Field(
        default=None,
        description="Transverse module m_t = m_n / cos(beta) of a helical gear; alternatively `normal_module`.",
    )
    pressure_angle: Angle = Field(
        default=math.radians(20.0),
        description="Pressure angle of the basic rack, normal to the teeth of helical gears.",
    )
    coast_pressure_angle: Angle | None = Field(
        default=None,
        description="Pressure angle of the coast flank of asymmetric teeth; `pressure_angle` is that of the drive "
        "flank. Default: `pressure_angle`.",
    )
    transverse_pressure_angle: Angle | None = Field(
        default=None,
        description="Transverse pressure angle alpha_t of a helical gear, tan(alpha_t) = tan(alpha_n) / cos(beta); "
        "alternatively `pressure_angle`.",
    )
    internal: bool = Field(
        default=False,
        description="Internal gear (ring gear); requires `cutter`. For the sign of its profile shift see "
        "`profile_shift_sign`.",
    )
    profile_shift: Number | Literal["no-undercut"] = Field(
        default=0.0,
        description="Profile shift coefficient x, or `no-undercut`: minimum without undercut, rounded up to 0.0001, at "
        "least 0.",
    )
    profile_shift_sign: Literal["iso-21771", "khk"] = Field(
        default="iso-21771",
        description="Sign of the profile shift of internal gears: positive towards the tooth tip, diameters become "
        "smaller (`iso-21771`), or positive outwards, diameters become larger (`khk`).",
    )
    tooth_thickness: Toleranced | None = Field(
        default=None,
        description="Normal tooth thickness s_n at the reference diameter, or its two limits (mean); instead of "
        "`profile_shift`.",
    )
    span: Toleranced | None = Field(
        default=None,
        description="Span W_k over `span_teeth` teeth, or its two limits (mean); instead of `profile_shift`.",
    )
    span_teeth: Annotated[int, Field(ge=1)] | None = Field(
        default=None,
        description="Number of teeth k for the span W_k. Default: contact near the middle of the involute.",
    )
    over_balls: Toleranced | None = Field(
        default=None,
        description="Dimension M_dK over balls of `ball_diameter` (internal gears: between them), or its two limits "
        "(mean); instead of `profile_shift`.",
    )
    over_pins: Toleranced | None = Field(
        default=None,
        description="Dimension M_dR over pins of `ball_diameter` (internal gears: between them), or its two limits "
        "(mean); instead of `profile_shift`.",
    )
    ball_diameter: PositiveLength | None = Field(
        default=None,
        description="Ball or pin diameter D_M for M_dK and M_dR. Default: next R 40 value above the diameter with "
        "contact at the V-circle.",
    )
    chordal_thickness: Toleranced | None = Field(
        default=None,
        description="Normal chordal tooth thickness at `chordal_height`, or its two limits (mean); instead of "
        "`profile_shift`.",
    )
    chordal_height: PositiveLength | None = Field(
        default=None,
        description="Height from the tip circle at which `chordal_thickness` applies; requires `tip_diameter`. "
        "Default: at the reference diameter.",
    )
    thickness_allowance: Allowance = Field(
        default=0.0,
        description="Tooth thickness allowance by tool infeed: reduction of the normal thickness at the reference "
        "diameter; or DIN 3967, e.g. `cd25` (mean of its limits); or `derived`: from a thickness given besides "
        "`profile_shift`.",
    )
    tip_diameter: PositiveLength | None = Field(
        default=None,
        description="Tip diameter. Default: reference diameter + 2 m (x + h_aP*).",
    )

    @property
    def is_helical(self) -> bool:
        """Whether the gear is described as a helical one (of helix angle zero as the limit)."""
        return self.helix_angle is not None

    @property
    def has_helix(self) -> bool:
        """Whether its teeth are not straight."""
        return bool(self.helix_angle)

    @property
    def measure(self) -> str | None:
        """The key that gives the thickness of a tooth, if one does."""
        return next((key for key in MEASURES if getattr(self, key) is not None), None)

    @property
    def x(self) -> float:
        """Profile shift coefficient in the sign of ISO 21771; nan before it is settled."""
        return self.profile_shift if isinstance(self.profile_shift, float) else math.nan

    @property
    def allowance(self) -> float:
        """A_sn, reduction of the normal tooth thickness [m]; nan before it is settled."""
        return self.thickness_allowance if isinstance(self.thickness_allowance, float) else math.nan

    @property
    def module_length(self) -> float:
        """The normal module m_n [m], that of a spur gear's only section."""
        lean = math.cos(self.helix_angle or 0.0)
        sizes = (
            self.module, self.normal_module, _over(1.0, self.diametral_pitch), _over(1.0, self.normal_diametral_pitch),
            _over(self.circular_pitch, math.pi), _over(self.normal_circular_pitch, math.pi),
            _over(self.transverse_module, 1.0 / lean),
        )  # fmt: skip
        return next((size for size in sizes if size is not None), math.nan)

    @model_validator(mode="after")
    def _sized_once(self) -> Self:
        if self.helix_angle is not None and self.helix_angle < 0.0:
            angle = f'set helix_angle = "{-math.degrees(self.helix_angle):.9g} deg"'
            sign = ' and hand = "left" or "right"' if self.hand is None else f'; hand = "{self.hand}" defines the sign'
            raise refuse("must be between 0 and 60 deg", angle + sign, key="helix_angle")
        if self.is_helical:
            self._check_helical_size()
        else:
            self._check_spur_size()
        self._check_thickness()
        return self

    def _check_spur_size(self) -> None:
        """Refuse keys of helical gears, and no size or two."""
        for key in ("hand", *_HELICAL_SIZES, "transverse_pressure_angle"):
            if getattr(self, key) is not None:
                raise refuse("requires helix_angle", 'set helix_angle = "30 deg"', key=key)
        given = [key for key in ("module", "diametral_pitch", "circular_pitch") if getattr(self, key) is not None]
        if not given:
            raise refuse("is missing", 'set module = "3.175 mm" or diametral_pitch = "8 / inch"', key="module")
        if len(given) > 1:
            raise refuse(f"contradicts {given[0]}", f"specify either {given[0]} or {given[1]}", key=given[1])

    def _check_helical_size(self) -> None:
        """Refuse sizes of the section across the axis without saying so, and no size or two."""
        if sum(getattr(self, key) is not None for key in _HELICAL_SIZES) != 1:
            remedy = 'set normal_module = "5 mm" or normal_diametral_pitch = "5 / inch"'
            raise refuse("must be specified exactly once for a helical gear", remedy, key="normal_module")
        for key in ("module", "diametral_pitch", "circular_pitch"):
            if key in self.model_fields_set:
                raise refuse("is for spur gears only", f"use normal_{key} for a gear with helix_angle", key=key)
        if self.transverse_pressure_angle is None:
            return
        if "pressure_angle" in self.model_fields_set:
            raise refuse("contradicts pressure_angle", "specify either of them", key="transverse_pressure_angle")
        if not 0.0 < self.transverse_pressure_angle < 0.5 * math.pi:
            raise refuse("must be between 0 and 90 deg", "20 deg is usual", key="transverse_pressure_angle")

    def _check_thickness(self) -> None:
        """Refuse two thicknesses, a thickness beside the profile shift that gives it, and half a measurement."""
        given = [key for key in MEASURES if getattr(self, key) is not None]
        if len(given) > 1:
            raise refuse(f"contradicts {given[0]}", f"specify either {given[0]} or {given[1]}", key=given[1])
        if self.chordal_height is not None and self.chordal_thickness is None:
            raise refuse("requires chordal_thickness", "set it, or remove chordal_height", key="chordal_height")
        for key, (needed, example) in _NEEDS.items():
            if getattr(self, key) is not None and getattr(self, needed) is None:
                raise refuse(f"is required for {key}", f"set {example}", key=needed)
        if self.internal and self.span_teeth is not None:
            raise refuse("cannot be measured on an internal gear", "set over_balls", key="span_teeth")
        derived = self.thickness_allowance == DERIVED
        if not given:
            if derived:
                raise refuse(
                    "requires the thickness from which it follows", f"set one of {', '.join(MEASURES)}",
                    key="thickness_allowance",
                )  # fmt: skip
            return
        measure = given[0]
        if "profile_shift" in self.model_fields_set and not derived:
            raise refuse(
                "contradicts profile_shift",
                'remove profile_shift, or set thickness_allowance = "derived" for the difference', key=measure,
            )  # fmt: skip
        if self.internal and measure in ("span", "chordal_thickness"):
            raise refuse("cannot be measured on an internal gear", "set over_balls or tooth_thickness", key=measure)
        if self.internal and self.has_helix and measure == "over_pins":
            raise refuse("cannot be measured on a helical internal gear", "set over_balls", key=measure)


_HELICAL_SIZES = ("normal_module", "normal_diametral_pitch", "normal_circular_pitch", "transverse_module")


def _over(number: float | None, divisor: float | None) -> float | None:
    return None if number is None or divisor is None else number / divisor
