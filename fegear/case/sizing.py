"""``[sizing]``: a requirement for which teeth are chosen: what a pair must do, what may vary, what it must not do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.evenly_spaced import EvenlySpaced
from fegear.case.gear_material import MaterialPart
from fegear.case.operation import OperationPart, ShaftsPart
from fegear.case.pair import IsoPart, TorquesPart
from fegear.case.part import (
    Angle,
    Number,
    Part,
    PositiveLength,
    PositiveNumber,
    PositivePower,
    PositiveSpeed,
    PositiveTorque,
    Table,
    at_most,
    refuse,
)
from fegear.case.strength import StrengthPart
from fegear.case.surface import LubricantPart, RoughnessPart
from fegear.case.tolerance_class import ToleranceClass
from fegear.design.sizing.limits import SizingLimits

#: What variants can be compared by; each is better where it is smaller, but `safety` and `contact-ratio`.
Criterion = Literal[
    "transmission-error",
    "relieved-transmission-error",
    "root-stress",
    "mass",
    "centre-distance",
    "loss",
    "safety",
    "contact-ratio",
    "sliding",
    "module",
]
#: Best variants that are verified: spur ones, and where some are helical.
_VERIFIED, _VERIFIED_HELICAL = 20, 3
#: Modules of ISO 54 [mm], series I and II.
_SERIES_I = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0)
_SERIES_II = (1.125, 1.375, 1.75, 2.25, 2.75, 3.5, 4.5, 5.5, 7.0, 9.0, 11.0, 14.0, 18.0)
Teeth = Annotated[int, Field(ge=5, le=1000)]
Lengths = Annotated[list[PositiveLength], Field(min_length=1), at_most(200, "values")]
Angles = Annotated[list[Angle], Field(min_length=1), at_most(200, "values")]
Positives = Annotated[list[PositiveNumber], Field(min_length=1), at_most(50, "values")]


def _usual_criteria() -> list[Criterion]:
    return ["transmission-error", "mass", "safety"]


class ShiftsPart(EvenlySpaced):
    """``pinion_shift = { start, stop, count }``, evenly spaced, or a list."""

    example = "write { start = -0.2, stop = 0.8, count = 11 }, or a list"

    values: Annotated[list[Number], Field(min_length=1), at_most(1000, "values")] | None = Field(
        default=None, description="Profile shift coefficients as a list (instead of the table)."
    )
    start: Number | None = Field(default=None, description="Minimum profile shift coefficient.")
    stop: Number | None = Field(default=None, description="Maximum profile shift coefficient.")
    count: Annotated[int, Field(ge=2, le=1000)] | None = Field(
        default=None, description="Number of equally spaced values, both ends included."
    )

    @property
    def shifts(self) -> tuple[float, ...]:
        """All of them, increasing, as somebody would write them."""
        return tuple(round(float(one), 12) + 0.0 for one in self.array)


if TYPE_CHECKING:

    class _LimitKeys(Part, SizingLimits):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _LimitKeys = keys_of(SizingLimits)


class LimitsPart(_LimitKeys):  # type: ignore[misc]  # frozen by pydantic
    """``limits = { tip_thickness, contact_ratio, ... }``: what a pair must not fall below or exceed."""

    shift_sum: Annotated[list[Number], Field(min_length=2, max_length=2)] = Field(  # type: ignore[assignment]  # a list of two in a case
        default_factory=lambda: [-1.0, 1.5], description="Minimum and maximum of x_1 + x_2."
    )

    @model_validator(mode="after")
    def _rising(self) -> Self:
        if self.shift_sum[0] > self.shift_sum[1]:
            raise refuse("must be minimum and maximum", "exchange the values", key="shift_sum", value=self.shift_sum)
        return self


class PresentPart(Part):
    """``[sizing.present]``: a design that exists, to be placed among the variants with what it breaks."""

    teeth: Annotated[list[Teeth], Field(min_length=2, max_length=2)] = Field(
        description="Numbers of teeth of driver and driven gear, the smaller first."
    )
    normal_module: PositiveLength = Field(description="Normal module m_n.")
    helix_angle: Angle = Field(default=0.0, description="Helix angle.")
    pressure_angle: Angle = Field(default=math.radians(20.0), description="Normal pressure angle.")
    profile_shift: Annotated[list[Number], Field(min_length=2, max_length=2)] = Field(
        default_factory=lambda: [0.0, 0.0], description="Profile shift coefficients."
    )
    face_width: PositiveLength = Field(description="Common face width.")
    addendum: PositiveNumber = Field(default=1.0, description="Addendum of the basic racks h_aP in modules.")
    tip_diameter: Lengths | None = Field(
        default=None, description="Tip diameters of both gears. Default: as those of the variants."
    )

    @model_validator(mode="after")
    def _pinion_first(self) -> Self:
        if self.teeth[0] > self.teeth[1]:
            raise refuse("must not be decreasing", "specify the pinion first", key="teeth", value=self.teeth)
        if self.tip_diameter is not None and len(self.tip_diameter) != 2:
            raise refuse("must be two diameters", 'for example ["60 mm", "180 mm"]', key="tip_diameter")
        return self


class TolerancesPart(Part):
    """``tolerances = { face_width, parallelism }``: between what limits the transmission error counts."""

    face_width: PositiveLength | None = Field(
        default=None,
        description="Tolerance t of the face width: FE values of helical variants include b - t and b + t.",
    )
    parallelism: PositiveLength | None = Field(
        default=None,
        description="Deviation of the shafts from parallel over the face width (out of plane): FE values of "
        "helical variants include it in both directions.",
    )

    @property
    def states(self) -> tuple[tuple[float, float], ...]:
        """What is added to the face width, and the deviation of the shafts [m]; the nominal pair first."""
        width, shafts = self.face_width, self.parallelism
        found = [(0.0, 0.0)]
        found += [] if width is None else [(-width, 0.0), (width, 0.0)]
        found += [] if shafts is None else [(0.0, -shafts), (0.0, shafts)]
        return tuple(found)


class SizingPart(Part):
    """A pair of external gears to be sized: requirement, what may vary, limits and criteria. The pinion drives."""

    power: PositivePower | None = Field(default=None, description="Nominal power at `speed`; alternatively `torque`.")
    torque: PositiveTorque | None = Field(default=None, description="Nominal torque on the pinion.")
    speed: PositiveSpeed = Field(description="Speed of the pinion.")
    ratio: Annotated[Number, Field(ge=1.0, le=100.0)] = Field(description="Gear ratio z_2/z_1 of the reduction.")
    ratio_tolerance: Annotated[Number, Field(ge=0.0, le=0.5)] = Field(
        default=0.02, description="Permissible relative deviation of the ratio; 0: exact."
    )
    centre_distance: PositiveLength | Lengths | None = Field(
        default=None,
        description="Centre distance, or its minimum and maximum as a list. Default: free.",
    )
    face_width: PositiveLength | Lengths | None = Field(
        default=None, description="Face width, or several to choose from; alternatively `width_ratios`."
    )
    width_ratios: Positives | None = Field(
        default=None, description="Face widths as b/d_1, rounded up to whole millimetres."
    )
    strength: Table[StrengthPart] = Field(description="Material of both gears for the rating.")
    wheel_strength: Table[StrengthPart] | None = Field(
        default=None, description="Material of the wheel for the rating. Default: that of the pinion."
    )
    material: Table[MaterialPart] | None = Field(
        default=None, description="Elastic constants and density of both gears. Default: steel."
    )
    tolerance_class: ToleranceClass = Field(default=6, description="Flank tolerance class (ISO 1328-1) of both gears.")
    roughness: Table[RoughnessPart] | None = Field(
        default=None, description="Roughness of both gears. Default: as in `rating`."
    )
    operation: Table[OperationPart] = Field(
        default_factory=OperationPart, description="Loads, life and minimum safety factors, as of a pair."
    )
    lubricant: Table[LubricantPart] | None = Field(default=None, description="Lubricant, as of a pair.")
    shafts: Table[ShaftsPart] | None = Field(
        default=None, description="Pinion shaft and bearing arrangement for K_Hbeta, as of a pair."
    )
    iso_6336: Table[IsoPart] = Field(default_factory=IsoPart, description="Options of ISO 6336, as of a pair.")
    torques: Table[TorquesPart] | None = Field(
        default=None,
        description="Torques for the transmission error (its maximum is used). Default: nominal torque.",
    )
    normal_modules: Lengths | None = Field(
        default=None, description="Normal modules to choose from. Default: `module_series`, 1 to 20 mm."
    )
    module_series: Literal["I", "I+II"] = Field(default="I", description="Series of ISO 54 for the modules.")
    pinion_teeth: Annotated[list[Teeth], Field(min_length=2, max_length=2)] = Field(
        default_factory=lambda: [15, 40], description="Minimum and maximum number of teeth of the pinion."
    )
    hunting: bool = Field(default=False, description="Only numbers of teeth without a common divisor.")
    helix_angles: Angles | None = Field(default=None, description="Helix angles. Default: 0 (spur gears).")
    pressure_angles: Angles | None = Field(default=None, description="Normal pressure angles. Default: 20 deg.")
    pinion_shifts: Table[ShiftsPart] | None = Field(
        default=None,
        description="Profile shift coefficients of the pinion. Default: -0.2 to 0.8 in steps of 0.1.",
    )
    shift_sums: Table[ShiftsPart] | None = Field(
        default=None,
        description="Sums x_1 + x_2 where the centre distance is free or a range. Default: 0.",
    )
    addenda: Positives = Field(
        default_factory=lambda: [1.0],
        description="Addenda of the basic racks h_aP in modules (above 1: deep teeth). Default: 1.",
    )
    root_clearance: PositiveNumber = Field(
        default=0.25, description="Dedendum of the basic racks minus `addenda`, in modules."
    )
    rack_tip_radius: PositiveNumber = Field(
        default=0.38, description="Tip radius of the basic racks rho_fP in modules."
    )
    shorten_tips: bool = Field(
        default=True, description="Shorten the tips of both gears to keep the clearance of the basic racks."
    )
    limits: Table[LimitsPart] = Field(default_factory=LimitsPart, description="Limits that every variant must keep.")
    criteria: Annotated[list[Criterion], Field(min_length=1)] = Field(
        default_factory=_usual_criteria,
        description="Criteria for the comparison of variants, the most important first. `transmission-error`, "
        "`relieved-transmission-error` and `root-stress` (of unmodified flanks, nominal torque) are by FE.",
    )
    estimated: Annotated[int, Field(ge=0, le=30_000_000)] = Field(
        default=1_000_000,
        description="Maximum number of variants whose transmission error is estimated by the atlas of solved gears "
        "(spur, racks of ISO 53 that come with fegear).",
    )
    relieved: Annotated[int, Field(ge=1, le=1_000_000)] = Field(
        default=300,
        description="Maximum number of variants for which the best tip relief is searched "
        "(`relieved-transmission-error`).",
    )
    screened: Annotated[int, Field(ge=0, le=5000)] = Field(
        default=24,
        description="Number of variants outside the range of the atlas of pre-solved gears (helical, other racks) "
        "whose transmission error is estimated by FE (coarse); of helical ones the best by thin slices from the atlas.",
    )
    verified: Annotated[int, Field(ge=0, le=200)] | None = Field(
        default=None,
        description="Number of best variants verified by FE with estimated errors. Default: 20, with helix angles 3.",
    )
    verified_width: Literal["slices", "solid"] = Field(
        default="solid", description="Tooth model by which helical variants are verified: `slices` or `solid` (3D)."
    )
    tolerance: Annotated[Number, Field(ge=1e-4, le=0.1)] = Field(
        default=1e-2, description="Relative accuracy of the FE verification."
    )
    tolerances: Table[TolerancesPart] = Field(
        default_factory=TolerancesPart,
        description="Deviations of helical variants included in transmission error and root stress by FE "
        "(their maximum). Default: none.",
    )
    present: Table[PresentPart] | None = Field(
        default=None, description="Existing design to be placed among the variants."
    )

    @property
    def modules(self) -> tuple[float, ...]:
        """Modules to choose from [m], ascending."""
        if self.normal_modules is not None:
            return tuple(sorted(set(self.normal_modules)))
        series = _SERIES_I if self.module_series == "I" else (*_SERIES_I, *_SERIES_II)
        return tuple(float(f"{one}e-3") for one in sorted(series))

    @property
    def chosen_helix_angles(self) -> tuple[float, ...]:
        """Helix angles to choose from [rad], ascending."""
        return tuple(sorted(set(self.helix_angles or (0.0,))))

    @property
    def chosen_pressure_angles(self) -> tuple[float, ...]:
        """Normal pressure angles to choose from [rad], ascending."""
        return tuple(sorted(set(self.pressure_angles or (math.radians(20.0),))))

    @property
    def chosen_shifts(self) -> tuple[float, ...]:
        """Profile shift coefficients of the pinion to choose from, ascending."""
        return (
            tuple(round(0.1 * k, 12) for k in range(-2, 9)) if self.pinion_shifts is None else self.pinion_shifts.shifts
        )

    @property
    def chosen_sums(self) -> tuple[float, ...]:
        """Sums of both shifts to choose from, ascending."""
        return (0.0,) if self.shift_sums is None else self.shift_sums.shifts

    @property
    def verified_count(self) -> int:
        """How many of the best are verified."""
        if self.verified is not None:
            return self.verified
        return _VERIFIED if not any(self.chosen_helix_angles) else _VERIFIED_HELICAL

    @property
    def distances(self) -> tuple[float, float] | None:
        """Minimum and maximum centre distance [m]; None where it is free."""
        given = self.centre_distance
        if given is None:
            return None
        return (min(given), max(given)) if isinstance(given, list) else (given, given)

    @property
    def widths(self) -> tuple[float, ...]:
        """Face widths [m]; none where they follow from b/d_1."""
        given = self.face_width
        return () if given is None else tuple(sorted(set(given))) if isinstance(given, list) else (given,)

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        if self.power is not None and self.torque is not None:
            raise refuse("contradicts power", "specify either power or torque", key="torque")
        if self.power is None and self.torque is None:
            raise refuse("is missing", 'set power = "5 kW" or torque = "120 N*m"', key="power")
        if self.face_width is not None and self.width_ratios is not None:
            raise refuse("contradicts face_width", "specify either of them", key="width_ratios")
        if self.face_width is None and self.width_ratios is None:
            raise refuse("is missing", 'set face_width = "35 mm" or width_ratios = [0.8]', key="face_width")
        if isinstance(self.centre_distance, list) and len(self.centre_distance) > 2:
            raise refuse("must be one length, or minimum and maximum", key="centre_distance", value="(a list)")
        if self.pinion_teeth[0] > self.pinion_teeth[1]:
            raise refuse("must be minimum and maximum", "exchange them", key="pinion_teeth", value=self.pinion_teeth)
        if len(set(self.criteria)) < len(self.criteria):
            raise refuse("contains a criterion twice", "specify each once", key="criteria", value=self.criteria)
        if any(not 0.0 <= one <= math.radians(45.0) for one in self.chosen_helix_angles):
            raise refuse("must be between 0 and 45 deg", key="helix_angles", value="(a list)")
        width, widths = self.tolerances.face_width, self.widths
        if width is not None and widths and not width < widths[0]:
            raise refuse("must be below the face width", key="tolerances.face_width", value=width)
        if any(not math.radians(10.0) <= one <= math.radians(30.0) for one in self.chosen_pressure_angles):
            raise refuse("must be between 10 and 30 deg", key="pressure_angles", value="(a list)")
        return self
