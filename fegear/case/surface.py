"""What flanks and oil are like: ``roughness`` of a gear, ``lubricant`` and ``friction`` of a pair."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.part import (
    Number,
    Part,
    PositiveLength,
    PositiveViscosity,
    Temperature,
    refuse,
)
from fegear.formulas.lubricant import Oil, OilKind

#: R_z is about this many R_a where only one of them is given (ISO 6336-2 and ISO/TS 6336-22 use the same ratio).
RZ_PER_RA = 6.0

#: Beyond these a unit is mistaken: Ra and Rz of rough castings [m], oils like pitch [m^2/s].
_ROUGHEST = {"flank": 100e-6, "root": 100e-6, "flank_rz": 600e-6, "root_rz": 600e-6}
_THICKEST = 0.1
#: Densities of oils [kg/m^3], from light hydrocarbons to perfluorinated ones.
_DENSITIES = (600.0, 2200.0)

#: Oils thinner than this at 40 degC [m^2/s] are none whose viscosity at 100 degC could be guessed.
_THIN = 7e-6

#: Base oils that ISO/TS 6336-20, -21 and -22 tell apart.
Supply = Literal["dip", "spray", "spray-with-dip", "submerged"]
#: What was done to the flanks, as the welding (structural) factor X_W of ISO/TS 6336-20 tells it apart.
FlankTreatment = Literal[
    "through-hardened",
    "phosphated",
    "copper-plated",
    "nitrided",
    "case-carburized",
    "case-carburized-low-austenite",
    "case-carburized-high-austenite",
    "austenitic",
]
FrictionLaw = Literal[
    "constant", "schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22", "buckingham", "benedict-kelley"
]


class RoughnessPart(Part):
    """``roughness = { flank = "0.4 um", root = "1.6 um" }``: arithmetic mean roughness R_a, new or after running in."""

    flank: PositiveLength | None = Field(
        default=None, description="Ra of the working flanks, in the direction of sliding."
    )
    root: PositiveLength | None = Field(default=None, description="Ra of the root fillets.")
    flank_rz: PositiveLength | None = Field(
        default=None, description="Mean peak-to-valley roughness Rz of the flanks. Default: 6 Ra."
    )
    root_rz: PositiveLength | None = Field(
        default=None, description="Mean peak-to-valley roughness Rz of the root fillets. Default: 6 Ra."
    )

    @model_validator(mode="after")
    def _of_gears(self) -> Self:
        for key, most in _ROUGHEST.items():
            value = getattr(self, key)
            if value is not None and value > most:
                raise refuse(
                    f"exceeds the maximum roughness of {most * 1e6:g} um",
                    "check the unit",
                    key=key,
                    value=f"{value * 1e6:g} um",
                )
        for ra, rz in (("flank", "flank_rz"), ("root", "root_rz")):
            low, high = getattr(self, ra), getattr(self, rz)
            if low is not None and high is not None and high < low:
                raise refuse(
                    f"must not be lower than {ra} = {low * 1e6:g} um", "check both", key=rz,
                    value=f"{high * 1e6:g} um",
                )  # fmt: skip
        return self

    @property
    def flank_ra(self) -> float | None:
        """Ra of the flanks [m]: as given, else a sixth of their Rz; None without either."""
        return self.flank or (None if self.flank_rz is None else self.flank_rz / RZ_PER_RA)

    @property
    def flank_height(self) -> float | None:
        """Rz of the flanks [m]: as given, else six Ra; None without either."""
        return self.flank_rz or (None if self.flank is None else self.flank * RZ_PER_RA)

    @property
    def root_height(self) -> float | None:
        """Rz of the fillets [m]: as given, else six Ra; None without either."""
        return self.root_rz or (None if self.root is None else self.root * RZ_PER_RA)


if TYPE_CHECKING:

    class _OilKeys(Part):
        viscosity_40: float
        viscosity_100: float | None
        density_15: float
        kind: OilKind

else:
    _OilKeys = keys_of(Oil, otherwise={"viscosity_100": "mineral oil of viscosity index 95"})


class LubricantPart(_OilKeys):
    """``lubricant = { viscosity_40, viscosity_100, density_15, temperature, kind, ... }``: the oil of a pair."""

    temperature: Temperature = Field(description="Oil temperature in the sump or at the spray nozzle.")
    supply: Supply = Field(default="dip", description="Lubrication method (dip, spray ...): factor X_S.")
    scuffing_load_stage: Annotated[int, Field(ge=1, le=14)] | None = Field(
        default=None,
        description="Failure load stage of the FZG test A/8.3/90 (ISO 14635-1), for S_B and S_intS.",
    )
    scuffing_temperature: Temperature | None = Field(
        default=None, description="Scuffing temperature of the oil. Default: from the test."
    )
    micropitting_load_stage: Annotated[int, Field(ge=5, le=10)] | None = Field(
        default=None, description="Failure load stage of the FVA 54/7 test C/8.3/90, for S_lambda."
    )
    micropitting_temperature: Temperature = Field(
        default=90.0, description="Oil temperature of the micropitting test (standard: 90 degC)."
    )
    permissible_film: Annotated[Number, Field(gt=0.0, le=100.0)] | None = Field(
        default=None,
        description="Permissible specific lubricant film thickness lambda_GFP. Default: from the micropitting test.",
    )

    @model_validator(mode="after")
    def _thinner_when_hot(self) -> Self:
        if self.viscosity_40 > _THICKEST:
            raise refuse(
                f"exceeds the maximum viscosity of {_THICKEST * 1e6:g} mm^2/s", "check the unit", key="viscosity_40",
                value=f"{self.viscosity_40 * 1e6:g} mm^2/s",
            )  # fmt: skip
        if not _DENSITIES[0] <= self.density_15 <= _DENSITIES[1]:
            raise refuse(
                f"is outside the density range of lubricating oils, {_DENSITIES[0]:g} to {_DENSITIES[1]:g} kg/m^3",
                'check the unit: for example "895 kg/m^3"', key="density_15", value=f"{self.density_15:g} kg/m^3",
            )  # fmt: skip
        if self.viscosity_100 is not None and self.viscosity_100 >= self.viscosity_40:
            raise refuse("must be lower than viscosity_40", "check both", key="viscosity_100")
        if self.viscosity_100 is None and self.viscosity_40 < _THIN:
            raise refuse(
                "is required for viscosity_40 this low (no default viscosity index)", "specify viscosity_100",
                key="viscosity_100", value="(not given)",
            )  # fmt: skip
        if self.viscosity_40 < 2e-6 or (self.viscosity_100 or 2e-6) < 2e-6:
            key = "viscosity_40" if self.viscosity_40 < 2e-6 else "viscosity_100"
            raise refuse("is below 2 mm^2/s, the validity limit of the viscosity law of ASTM D341", "check it", key=key)
        for one, other in (
            ("scuffing_load_stage", "scuffing_temperature"),
            ("micropitting_load_stage", "permissible_film"),
        ):
            if getattr(self, one) is not None and getattr(self, other) is not None:
                raise refuse(f"contradicts {one}", "specify only one", key=other)
        if not -40.0 <= self.temperature <= 250.0:
            raise refuse("must be between -40 and 250 degC", "check the unit", key="temperature")
        return self


class PairFrictionPart(Part):
    """``friction = { law = "schlenk" }`` or ``{ coefficient = 0.05 }``: of flanks, for `gear-mesh-power-loss`."""

    law: FrictionLaw | None = Field(
        default=None, description='Friction law. Default: "constant" with a coefficient, otherwise "schlenk".'
    )
    coefficient: Annotated[Number, Field(ge=0.0, le=0.5)] | None = Field(
        default=None, description='Coefficient of friction for law "constant".'
    )
    local: bool = Field(
        default=False,
        description="Apply a law for mean coefficients locally (local load, speeds and curvature).",
    )
    viscosity: PositiveViscosity | None = Field(
        default=None, description='Dynamic viscosity for "benedict-kelley". Default: that of the lubricant.'
    )

    @model_validator(mode="after")
    def _what_the_law_needs(self) -> Self:
        if self.law == "constant" and self.coefficient is None:
            raise refuse(
                'is required by law = "constant"', "specify coefficient", key="coefficient", value="(not given)"
            )
        if self.law not in (None, "constant") and self.coefficient is not None:
            raise refuse(f'is not used with law = "{self.law}"', "remove it", key="coefficient")
        if self.viscosity is not None and self.law != "benedict-kelley":
            raise refuse('requires law = "benedict-kelley"', "remove it", key="viscosity")
        if self.local and self.name in ("constant", "buckingham", "benedict-kelley"):
            raise refuse(f'is not used with law = "{self.name}"', "remove it", key="local", value=True)
        return self

    @property
    def name(self) -> FrictionLaw:
        """The law: as given, constant with a coefficient, else Schlenk's."""
        return self.law or ("schlenk" if self.coefficient is None else "constant")
