"""``[pair.NAME]``: two gears of a scene in mesh."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.case.helical import MisalignmentPart, ModificationPart, build_pair
from fegear.case.load_distribution import LineErrorPart
from fegear.case.operation import OperationPart, ShaftsPart
from fegear.case.part import (
    Length,
    Part,
    PositiveForce,
    PositiveLength,
    PositiveSpeed,
    PositiveTorque,
    at,
    at_most,
    refuse,
)
from fegear.case.surface import LubricantPart, PairFrictionPart
from fegear.errors import InputError
from fegear.geometry import GearPair

if TYPE_CHECKING:
    from fegear.geometry import Gear
    from fegear.helical.pair import HelicalPair


def _several(value: Any) -> Any:
    """Let one name stand for a list of it."""
    return (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list) else value


class CompliancePart(Part):
    """``compliance = { source = "fe" }``: where a pair's tooth compliances come from."""

    source: Literal["fe", "cornell", "weber-banaschek", "potential-energy", "table"] = "fe"
    file: str | None = None
    of: Literal["tooth", "pair"] | None = None
    fit: Literal["linear", "cubic"] | None = None

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
    ] = ("fe",)

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        if len(set(self.source)) < len(self.source):
            raise refuse("names a source twice", "name each once", value=list(self.source), key="source")
        return self


class IsoPart(Part):
    """``iso_6336 = { edition = 2019, accuracy_grade = 4 }``: what ISO 6336-3 asks for beside the geometry."""

    edition: Literal[2006, 2019] = 2006
    accuracy_grade: Annotated[int, Field(ge=0, le=12)] = 6


#: How wide the teeth of a loaded pair are: a section, coupled slices of it, or solid gears.
Width = Literal["plane", "slices", "solid"]


class PairPart(Part):
    """Two gears in mesh and the load between them."""

    driver: str
    driven: str
    centre_distance: PositiveLength | None = None
    load: PositiveForce | None = None
    torque: PositiveTorque | None = None
    loads: Annotated[list[PositiveForce], Field(min_length=1), at_most(1000, "loads")] | None = None
    speed: PositiveSpeed | None = None
    width: Width | None = None
    compliance: CompliancePart = Field(default_factory=CompliancePart)
    root_stress: RootStressPart = Field(default_factory=RootStressPart)
    misalignment: MisalignmentPart | None = None
    line_error: LineErrorPart | None = None
    modification: ModificationPart | None = None
    axial_offset: Length = 0.0
    iso_6336: IsoPart = Field(default_factory=IsoPart)
    lubricant: LubricantPart | None = Field(
        default=None, description="the oil of the pair, for film thickness, scuffing, micropitting and friction"
    )
    friction: PairFrictionPart | None = Field(
        default=None, description="friction law of tooth-loss; Schlenk's where the lubricant is known"
    )
    operation: OperationPart = Field(
        default_factory=OperationPart, description="loads, life and required safeties that the result rating is for"
    )
    shafts: ShaftsPart | None = Field(
        default=None, description="what carries the pinion, for the face load factor of ISO 6336-1 in the result rating"
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
        if "compliance" in self.model_fields_set:
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
