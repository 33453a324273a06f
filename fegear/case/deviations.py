"""``deviations`` of a gear: own ones, measured or agreed, in the place of those of a tolerance class."""

from __future__ import annotations

from typing import Self

from pydantic import Field, model_validator

from fegear.case.part import LengthOrZero, Part, refuse

#: Twice what class 11 of ISO 1328-1 allows its largest gears; beyond it a unit is mistaken [m].
_LARGEST = 1e-3


class DeviationsPart(Part):
    """``deviations = { base_pitch = "5 um", profile_form = "4 um", helix_slope = "6 um" }``: magnitudes."""

    base_pitch: LengthOrZero | None = Field(
        default=None,
        description="Transverse base pitch deviation f_pb, along the line of action; by class f_pT cos(alpha_t).",
    )
    profile_form: LengthOrZero | None = Field(default=None, description="Profile form deviation f_falpha.")
    helix_slope: LengthOrZero | None = Field(
        default=None, description="Helix slope deviation f_Hbeta over the face width."
    )
    profile_slope: LengthOrZero | None = Field(
        default=None, description="Profile slope deviation f_Halpha, for `robustness` only (not used in the rating)."
    )

    @property
    def enough_to_rate(self) -> bool:
        """Whether no tolerance class is needed for a rating."""
        return None not in (self.base_pitch, self.profile_form, self.helix_slope)

    @model_validator(mode="after")
    def _of_gears(self) -> Self:
        for key in ("base_pitch", "profile_form", "helix_slope", "profile_slope"):
            value = getattr(self, key)
            if value is not None and value > _LARGEST:
                rule = f"exceeds the plausible maximum of {_LARGEST * 1e3:g} mm"
                raise refuse(rule, "check the unit", key=key, value=f"{value * 1e3:.6g} mm")
        return self
