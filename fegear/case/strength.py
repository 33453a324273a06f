"""``strength`` of a gear: what its material bears, by ISO 6336-5 or in own numbers."""

from __future__ import annotations

from bisect import bisect_left
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.base.errors import InputError
from fegear.base.unit_text import UnreadableError, split
from fegear.case.part import LengthOrZero, Part, PositiveLength, PositivePressure, quantity, refuse
from fegear.geometry.materials import named_material

#: Materials of ISO 6336-5 by the words that a case writes; `fegear.formulas.iso6336.part5_materials` knows their laws.
MaterialName = Literal[
    "normalized-steel",
    "normalized-cast-steel",
    "malleable-iron",
    "nodular-iron",
    "ferritic-nodular-iron",
    "grey-iron",
    "through-hardened-carbon-steel",
    "through-hardened-alloy-steel",
    "through-hardened-cast-carbon-steel",
    "through-hardened-cast-alloy-steel",
    "case-hardened-steel",
    "induction-hardened-steel",
    "nitrided-nitriding-steel",
    "nitrided-through-hardening-steel",
    "nitrocarburized-steel",
]


#: How materials with a hard case begin.
_WITH_A_CORE = ("case-hardened", "induction-hardened", "nitrided", "nitrocarburized")


#: Rockwell C and Vickers hardness of unalloyed and low-alloy steel: ISO 18265:2013, table A.1.
_HRC = (
    20.3, 22.2, 24.0, 25.6, 27.1, 28.5, 29.8, 31.0, 32.2, 33.3, 34.4, 35.5, 36.6, 37.7, 38.8, 39.8, 40.8, 41.8, 42.7,
    43.6, 44.5, 45.3, 46.1, 46.9, 47.7, 48.4, 49.1, 49.8, 50.5, 51.1, 51.7, 52.3, 53.0, 53.6, 54.1, 54.7, 55.2, 55.7,
    56.3, 56.8, 57.3, 57.8, 58.3, 58.8, 59.2, 59.7, 60.1, 61.0, 61.8, 62.5, 63.3, 64.0, 64.7, 65.3, 65.9, 66.4, 67.0,
    67.5, 68.0,
)  # fmt: skip


_HV = (*range(240, 700, 10), *range(700, 941, 20))


def _rockwell(value: Any) -> Any:
    """Rewrite Rockwell C as Vickers, from which it differs by no factor; anything else stays as it is."""
    if not isinstance(value, str):
        return value
    try:
        number, unit = split(value)
    except (UnreadableError, InputError):
        return value
    if unit != "HRC":
        return value
    if not _HRC[0] <= number <= _HRC[-1]:
        rule = f"must be between {_HRC[0]:g} and {_HRC[-1]:g} HRC (conversion of ISO 18265)"
        raise refuse(rule, "give it in HV or HBW", value=value)
    i = max(bisect_left(_HRC, number), 1)
    part = (number - _HRC[i - 1]) / (_HRC[i] - _HRC[i - 1])
    return f"{_HV[i - 1] + part * (_HV[i] - _HV[i - 1]):.9g} HV"


Hardness = Annotated[float, quantity("hardness", positive=True), BeforeValidator(_rockwell)]


#: Stress numbers outside these are those of no gear: a unit is mistaken [Pa].
_WEAKEST, _STRONGEST = 1e6, 10e9


#: Keys of such numbers.
_STRESSES = (
    "contact", "bending", "bending_allowable", "agma_contact", "agma_bending", "yield_strength", "tensile_strength",
)  # fmt: skip


Stress = Annotated[float, quantity("pressure")]


Hardnesses = Annotated[list[Hardness], Field(min_length=2, max_length=500)]


Depths = Annotated[list[LengthOrZero], Field(min_length=2, max_length=500)]


#: Residual stresses beyond this are those of no steel [Pa].
_LARGEST_RESIDUAL = 3e9


def _refuse_depths(depths: list[float], values: list[float], name: str) -> None:
    """Refuse a profile whose depths do not rise, or that are not as many as its values."""
    if len(depths) != len(values):
        raise refuse(
            f"has {len(depths)} depths for {len(values)} values of {name}",
            "specify one value for each depth",
            key="depth",
        )
    if any(one >= other for one, other in pairwise(depths)):
        raise refuse("must be strictly increasing", "sort the measured points", key="depth")


class HardnessProfilePart(Part):
    """``hardness_profile = { depth, hardness }``: as measured below the flank."""

    depth: Depths = Field(description="Depths below the finished flank, increasing.")
    hardness: Hardnesses = Field(description="Hardness at each depth in HV, HBW or HRC.")

    @model_validator(mode="after")
    def _one_each(self) -> Self:
        _refuse_depths(self.depth, self.hardness, "hardness")
        return self


class ResidualStressPart(Part):
    """``residual_stress = { depth, stress }``: along profile and face, as measured; compression is negative."""

    depth: Depths = Field(description="Depths below the finished flank, increasing.")
    stress: Annotated[list[Stress], Field(min_length=2, max_length=500)] = Field(
        description="Residual stress at each depth, uniform over the flank; compression negative."
    )

    @model_validator(mode="after")
    def _one_each(self) -> Self:
        _refuse_depths(self.depth, self.stress, "stress")
        for value in self.stress:
            if abs(value) > _LARGEST_RESIDUAL:
                raise refuse(
                    f"exceeds the residual stress of any steel, {_LARGEST_RESIDUAL * 1e-9:g} GPa", "check the unit",
                    key="stress", value=f"{value * 1e-6:g} MPa",
                )  # fmt: skip
        return self


class StrengthPart(Part):
    """``strength = { material, quality, hardness, ... }``: what the flanks and roots of a gear bear.

    The allowable stress numbers come from the laws of ISO 6336-5 for the material, its quality and its hardness, or as
    own numbers (`contact`, `bending` or `bending_allowable`); the material is named in any case, since life and notch
    factors depend on its kind.
    """

    material: MaterialName = Field(
        description="Material type to ISO 6336-5; or the name of a steel (see `steel`) for its usual type."
    )
    steel: str | None = Field(
        default=None,
        description="Name of the steel (16MnCr5, 18CrNiMo7-6, 42CrMo4, ...), from which `material` follows: "
        "type of its usual heat treatment.",
    )
    quality: Literal["ML", "MQ", "ME"] = Field(
        default="MQ",
        description="Material quality ML, MQ or ME (ISO 6336-5).",
    )
    hardness: Hardness | None = Field(
        default=None,
        description="Surface hardness in HV, HBW or HRC. Default: middle of the range of the material.",
    )
    core_hardness: Hardness | None = Field(
        default=None,
        description="Core hardness of surface-hardened teeth: at least 25 HRC for case-hardened steel MQ (higher "
        "sigma_Flim from 30 HRC); also used by AGMA 2101.",
    )
    jominy_12: Hardness | None = Field(
        default=None,
        description="Jominy hardness at 12 mm, of case-hardened steel MQ (higher sigma_Flim from 28 HRC).",
    )
    case_depth: PositiveLength | None = Field(
        default=None,
        description="Case depth of the finished flank at 550 HV (CHD, Eht) of surface-hardened teeth, for "
        "`flank-fracture`.",
    )
    hardness_profile: HardnessProfilePart | None = Field(
        default=None, description="Measured hardness over depth, instead of the curve through case_depth."
    )
    residual_stress: ResidualStressPart | None = Field(
        default=None,
        description="Measured residual stress over depth. Default: from the hardness (Lang).",
    )
    contact: PositivePressure | None = Field(
        default=None, description="User-defined allowable stress number (contact) sigma_Hlim. Default: ISO 6336-5."
    )
    bending: PositivePressure | None = Field(
        default=None, description="User-defined nominal stress number (bending) sigma_Flim. Default: ISO 6336-5."
    )
    bending_allowable: PositivePressure | None = Field(
        default=None,
        description="User-defined allowable stress number (bending) sigma_FE = 2 sigma_Flim, instead of bending.",
    )
    agma_contact: PositivePressure | None = Field(
        default=None,
        description="Allowable contact stress number sigma_HP of AGMA 2101. Default: for material and quality (table 3 "
        "of ANSI/AGMA 2101-D04).",
    )
    agma_bending: PositivePressure | None = Field(
        default=None,
        description="Allowable bending stress number sigma_FP of AGMA 2101. Default: for material and quality (table 4 "
        "of ANSI/AGMA 2101-D04).",
    )
    yield_strength: PositivePressure | None = Field(
        default=None,
        description="Yield point sigma_S or proof stress sigma_0.2, for the notch sensitivity of steels without "
        "surface hardening. Default: least favourable value.",
    )
    tensile_strength: PositivePressure | None = Field(
        default=None, description="Tensile strength sigma_B of cast iron, for its notch sensitivity."
    )
    long_life: Annotated[float, Field(ge=0.85, le=1.0)] = Field(
        default=0.85,
        description="Z_NT and Y_NT at 1e10 load cycles: 0.85, up to 1.0 for optimum material, manufacture, "
        "lubrication and experience.",
    )
    pitting_allowed: bool = Field(
        default=False, description="Limited pitting permitted (higher Z_NT in the limited life range)."
    )

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, value: Any) -> Any:
        """Take the type of a named steel, unless the case gives one."""
        if not isinstance(value, dict):
            return value
        key = next((key for key in ("steel", "material") if isinstance(value.get(key), str)), None)
        named = None if key is None else named_material(value[key])
        if key == "steel" and (named is None or not named.kind):
            raise refuse("is not a known steel", "set material to its type of ISO 6336-5", key="steel")
        if named is None or not named.kind:
            return value
        kept = value.get("material") if key == "steel" else None
        return {**value, "material": kept or named.kind, "steel": named.name}

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        if self.bending is not None and self.bending_allowable is not None:
            raise refuse("contradicts bending", "specify sigma_Flim or sigma_FE", key="bending_allowable")
        for key in _STRESSES:
            value = getattr(self, key)
            if value is not None and not _WEAKEST <= value <= _STRONGEST:
                raise refuse(
                    f"is outside the range of gear materials, {_WEAKEST * 1e-6:g} MPa to {_STRONGEST * 1e-9:g} "
                    "GPa", "check the unit",
                    key=key, value=f"{value * 1e-6:g} MPa",
                )  # fmt: skip
        for key in ("core_hardness", "case_depth", "hardness_profile", "residual_stress"):
            if getattr(self, key) is not None and not self.material.startswith(_WITH_A_CORE):
                raise refuse("applies only to surface-hardened steel", f"remove {key}", key=key)
        if self.jominy_12 is not None and self.material != "case-hardened-steel":
            raise refuse("applies only to case-hardened-steel", "remove jominy_12", key="jominy_12")
        if self.tensile_strength is not None and not self.material.endswith("iron"):
            raise refuse("applies only to cast iron", "remove it, or give yield_strength", key="tensile_strength")
        return self
