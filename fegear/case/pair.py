"""``[pair.NAME]``: two gears of a scene in mesh."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.base.errors import InputError
from fegear.case.helical import MisalignmentPart, ModificationPart, build_pair
from fegear.case.loading import LineErrorPart
from fegear.case.operation import OperationPart, ShaftsPart
from fegear.case.part import (
    Length,
    Number,
    Part,
    PositiveForce,
    PositiveLength,
    PositiveSpeed,
    PositiveTorque,
    Table,
    at,
    at_most,
    refuse,
)
from fegear.case.surface import LubricantPart, PairFrictionPart
from fegear.geometry.pair import GearPair

if TYPE_CHECKING:
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.geometry.gear import Gear


def _several(value: Any) -> Any:
    """Let one name stand for a list of it."""
    return (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list) else value


class CompliancePart(Part):
    """``compliance = { source = "fe" }``: where a pair's tooth compliances come from."""

    source: Literal["fe", "cornell", "weber-banaschek", "potential-energy", "table"] = Field(
        default="fe", description="Finite elements, a formula by its authors, or a table of your own."
    )
    file: str | None = Field(
        default=None,
        description="CSV file with `x [mm]` or `roll_angle [deg]` and `compliance [um/N]`, or with `load [N]` and "
        "`deflection [um]`.",
    )
    of: Literal["tooth", "pair"] | None = Field(
        default=None, description="Whether the table is of one tooth or of a pair of teeth."
    )
    fit: Literal["linear", "cubic"] | None = Field(
        default=None, description="How the table is made continuous: straight lines, or one cubic fitted to all of it."
    )

    @model_validator(mode="after")
    def _table_needs_file(self) -> Self:
        if self.source == "table" and self.file is None:
            raise refuse(
                "is missing, but the compliance source is a table", 'name its file: file = "c.csv"', key="file"
            )
        if self.source != "table":
            for key in ("file", "of", "fit"):
                if getattr(self, key) is not None:
                    raise refuse(
                        f'has no meaning with source = "{self.source}"', 'remove it or set source = "table"', key=key
                    )
        return self


RootStressName = Literal["fe", "cornell", "cornell-trochoid", "heywood", "iso-6336-3", "agma-908", "dolan-broghamer"]


class RootStressPart(Part):
    """``root_stress = { source = "cornell" }``: where root stresses come from; of a list the first is the result."""

    source: Annotated[
        tuple[RootStressName, ...],
        BeforeValidator(_several, json_schema_input_type=RootStressName | list[RootStressName]),
        Field(min_length=1),
    ] = Field(
        default=("fe",),
        description="Finite elements or formulas; of a list the first is the result, the others are compared with it.",
    )

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        if len(set(self.source)) < len(self.source):
            raise refuse("names a source twice", "name each once", value=list(self.source), key="source")
        return self


class IsoPart(Part):
    """``iso_6336 = { edition = 2019, accuracy_grade = 4, ... }``: choices that ISO 6336 leaves, and own factors."""

    edition: Literal[2006, 2019] | None = Field(
        default=None,
        description="Edition of ISO 6336 that is followed; without it 2019 in a rating, 2006 in the crosscheck.",
    )
    accuracy_grade: Annotated[int, Field(ge=0, le=12)] = Field(
        default=6, description="Accuracy grade of the gears, 0 to 12; grade 4 or better lets Y_DT relieve deep teeth."
    )
    dynamic_method: Literal["B", "C"] = Field(
        default="B",
        description="Method of K_v: B from masses and stiffness, C a fit for pairs well below their resonance.",
    )
    tip_relief_factor: Annotated[Number, Field(ge=1.0, le=1.2)] | None = Field(
        default=None,
        description="Own f_ZCa of helical flanks of the edition of 2019, 1 to 1.2; without it 1.2 without tip relief, "
        "1.07 with one, which are recalled.",
    )
    micropitting_material_factor: Annotated[Number, Field(ge=0.3, le=2.0)] | None = Field(
        default=None,
        description="Own material factor W_W of the permissible film of ISO/TS 6336-22; from the steels of both flanks "
        "without.",
    )
    flank_fracture_material_factor: Annotated[Number, Field(ge=0.3, le=2.0)] = Field(
        default=1.0,
        description="K_material of ISO/TS 6336-4: shear strength of both steels over that by their hardness.",
    )


#: How wide the teeth of a loaded pair are: a section, coupled slices of it, or solid gears.
Width = Literal["plane", "slices", "solid"]


class PairPart(Part):
    """Two gears in mesh and the load between them."""

    driver: str = Field(description="Name of the driving gear.")
    driven: str = Field(description="Name of the driven gear; it may be the same.")
    centre_distance: PositiveLength | None = Field(
        default=None,
        description="Working centre distance; without it the one at which the teeth mesh without backlash.",
    )
    load: PositiveForce | None = Field(
        default=None, description="Nominal load along the line of action; give this or `torque`."
    )
    torque: PositiveTorque | None = Field(
        default=None, description="Nominal torque on the driver; give this or `load`."
    )
    loads: Annotated[list[PositiveForce], Field(min_length=1), at_most(1000, "loads")] | None = Field(
        default=None,
        description="Further loads along the line of action; without `load` and `torque` the largest is the nominal "
        "one.",
    )
    speed: PositiveSpeed | None = Field(
        default=None, description="Speed of the driver, for the time column of root-stress histories."
    )
    width: Width | None = Field(
        default=None,
        description="How wide the loaded teeth are: one plane section, coupled slices of it, or solid gears; without "
        "it plane for spur and solid for helical gears.",
    )
    compliance: Table[CompliancePart] = Field(
        default_factory=CompliancePart, description="Where the tooth compliances come from."
    )
    root_stress: Table[RootStressPart] = Field(
        default_factory=RootStressPart, description="Where root stresses come from."
    )
    misalignment: Table[MisalignmentPart] | None = Field(
        default=None, description="How the shafts and the pinion's flank deviate; it needs the effect `misalignment`."
    )
    line_error: Table[LineErrorPart] | None = Field(
        default=None,
        description="What keeps the unloaded flanks apart over the face; it needs the effect `misalignment`.",
    )
    modification: Table[ModificationPart] | None = Field(
        default=None,
        description="How the pinion's flank is localised for tooth contact analysis; loaded flanks count it with the "
        "effect `relief`.",
    )
    axial_offset: Length = Field(
        default=0.0,
        description="Height of the driven gear's mid face above the driver's, toward end I; only the common face "
        "bears.",
    )
    iso_6336: Table[IsoPart] = Field(
        default_factory=IsoPart, description="Choices that ISO 6336 leaves: edition, methods, and own factors."
    )
    lubricant: Table[LubricantPart] | None = Field(
        default=None, description="the oil of the pair, for film thickness, scuffing, micropitting and friction"
    )
    friction: Table[PairFrictionPart] | None = Field(
        default=None, description="friction law of gear-mesh-power-loss; Schlenk's where the lubricant is known"
    )
    operation: Table[OperationPart] = Field(
        default_factory=OperationPart, description="Loads, life and required safeties that the result rating is for."
    )
    shafts: Table[ShaftsPart] | None = Field(
        default=None,
        description="What carries the pinion, for the face load factor of ISO 6336-1 in the result rating.",
    )

    @model_validator(mode="after")
    def _one_load(self) -> Self:
        if self.load is not None and self.torque is not None:
            raise refuse(
                "contradicts load", "give either the load along the line of action or the torque", key="torque"
            )
        return self

    def build(self, gears: dict[str, Gear], prefix: str) -> GearPair:
        """Make the pair from the scene's gears."""
        distance = math.nan if self.centre_distance is None else self.centre_distance
        try:
            # Heights on loaded flanks run against those of TM-107451, in which a case counts the offset.
            pair = GearPair(gears[self.driver], gears[self.driven], distance, -self.axial_offset)
        except InputError as error:
            if error.key == "axial_offset":
                error = type(error)(error.key, f"{self.axial_offset * 1e3:.6g} mm", error.rule, error.remedy)
            raise at(prefix, error, {"pair": ""}) from None
        self._check_width(pair, prefix)
        return pair

    def _check_width(self, pair: GearPair, prefix: str) -> None:
        """Refuse what contradicts the width in which the pair is loaded."""
        if pair.driver.helix_angle != 0.0 and self.width == "plane":
            raise InputError(
                f"{prefix}.width", '"plane"', "has no meaning for helical gears: their load moves along the face",
                'write width = "solid" or "slices", or remove it',
            )  # fmt: skip
        if self.width_in(pair) == "plane":
            return
        if "compliance" in self.given:
            raise InputError(
                f"{prefix}.compliance", "(given)",
                "is for plane teeth, and gears with a width are solved by finite elements",
                "remove compliance" if pair.driver.helix_angle else 'remove compliance, or write width = "plane"',
            )  # fmt: skip
        if self.root_stress.source != ("fe",):
            raise InputError(
                f"{prefix}.root_stress.source", list(self.root_stress.source),
                "is for plane teeth: over the face, root stress comes from finite elements", 'write source = "fe"',
            )  # fmt: skip

    def width_in(self, pair: GearPair) -> Width:
        """Width in which the pair is loaded: as given, else plane for spur and solid for helical gears."""
        return self.width or ("plane" if pair.driver.helix_angle == 0.0 else "solid")

    def build_helical(self, design: GearPair, prefix: str, *, misaligned: bool) -> HelicalPair:
        """Make the rigid flanks of a pair; their errors count only where the scene calls for misalignment."""
        try:
            return self.rigid(design, misaligned)
        except InputError as error:
            names = {key: f"misalignment.{key}" for key in ("shaft_angle", "lead_angle", "lead", "profile_angle")}
            if self.misalignment is not None and self.misalignment.lead is not None:
                names["lead_angle"] = names["lead"]
            names |= {key: f"modification.{key}" for key in ("parabola", "crown")}
            if error.key == "crown" and self.modification is not None:  # below, it is a turn of the section
                error = type(error)("crown", f"{self.modification.crown * 1e3:.6g} mm", error.rule, error.remedy)
            raise at(prefix, error, names) from None

    def rigid(self, design: GearPair, misaligned: bool) -> HelicalPair:
        """The same, errors in the words of the flanks."""
        return build_pair(design, self.misalignment if misaligned else None, self.modification, self.axial_offset)

    def normal_load(self, pair: GearPair) -> float | None:
        """Load along the line of action [N]: the load, the driver's torque, or the largest of loads; None without."""
        if self.torque is not None:
            return self.torque / pair.driver.base_radius
        return max(self.loads) if self.load is None and self.loads else self.load

    def all_loads(self, pair: GearPair) -> tuple[float, ...]:
        """Every load of the case along the line of action [N], ascending, the nominal one among them."""
        nominal = self.normal_load(pair)
        return tuple(sorted({*(self.loads or ()), *(() if nominal is None else (nominal,))}))
