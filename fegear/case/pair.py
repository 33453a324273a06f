"""``[pair.NAME]``: two gears of a scene in mesh."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.base.errors import InputError
from fegear.case.evenly_spaced import EvenlySpaced
from fegear.case.helical import MisalignmentPart, ModificationPart, build_pair
from fegear.case.loading import LineErrorPart
from fegear.case.operation import OperationPart, ShaftsPart
from fegear.case.part import (
    Later,
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveForce,
    PositiveLength,
    PositivePower,
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
    from fegear.case.double_helical import DoubleHelicalPart
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.geometry.gear import Gear
else:  # few pairs have one
    DoubleHelicalPart = Later("fegear.case.double_helical", "DoubleHelicalPart")


def _several(value: Any) -> Any:
    """Let one name stand for a list of it."""
    return (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list) else value


class CompliancePart(Part):
    """``compliance = { source = "fe" }``: where a pair's tooth compliances come from."""

    source: Literal[
        "fe", "cornell", "weber-banaschek", "potential-energy", "potential-energy-simplified", "table"
    ] = Field(
        default="fe",
        description="Finite elements, a published formula, or a user table. Simplified: the tooth of the diagnosis "
        "literature, without fillet, of constant thickness below the base circle.",
    )  # fmt: skip
    file: str | None = Field(
        default=None,
        description="CSV file with `x [mm]` or `roll_angle [deg]` and `compliance [um/N]`, or with `load [N]` and "
        "`deflection [um]`.",
    )
    of: Literal["tooth", "pair"] | None = Field(default=None, description="Table for one tooth or for a tooth pair.")
    fit: Literal["linear", "cubic"] | None = Field(
        default=None, description="Interpolation of the table: linear, or one cubic fitted to all points."
    )

    @model_validator(mode="after")
    def _table_needs_file(self) -> Self:
        if self.source == "table" and self.file is None:
            raise refuse('is required for compliance source "table"', 'set file = "c.csv"', key="file")
        if self.source != "table":
            for key in ("file", "of", "fit"):
                if getattr(self, key) is not None:
                    raise refuse(
                        f'is not used with source = "{self.source}"', 'remove it or set source = "table"', key=key
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
        description="Finite elements or formulas; the first of a list is the result, the others are for comparison.",
    )

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        if len(set(self.source)) < len(self.source):
            raise refuse("contains a source twice", "specify each once", value=list(self.source), key="source")
        return self


class IsoPart(Part):
    """``iso_6336 = { edition = 2019, accuracy_grade = 4, ... }``: choices that ISO 6336 leaves, and own factors."""

    edition: Literal[2006, 2019] | None = Field(
        default=None,
        description="Edition of ISO 6336-2 and -3 (part 1: formulas of 2006, which 2019 keeps). "
        "Default: 2019 in a rating, 2006 in the crosscheck.",
    )
    accuracy_grade: Annotated[int, Field(ge=0, le=12)] = Field(
        default=6, description="Accuracy grade of the gears, 0 to 12; Y_DT for deep teeth requires grade 4 or better."
    )
    dynamic_method: Literal["B", "C"] = Field(
        default="B",
        description="Method for K_v: B (masses and stiffness), C (approximation for pairs well below resonance).",
    )
    tip_relief_factor: Annotated[Number, Field(ge=1.0, le=1.2)] | None = Field(
        default=None,
        description="User-defined f_ZCa of helical gears (edition 2019), 1 to 1.2. Default: 1.07 with tip "
        "relief of both gears above that of running in (C_ay of ISO 6336-1, 2 um of case-hardened flanks), otherwise "
        "1.2 (not verified against a printed source).",
    )
    micropitting_material_factor: Annotated[Number, Field(ge=0.3, le=2.0)] | None = Field(
        default=None,
        description="User-defined material factor W_W for the permissible film of ISO/TS 6336-22. Default: from the "
        "steels of both flanks.",
    )
    flank_fracture_material_factor: Annotated[Number, Field(ge=0.3, le=2.0)] = Field(
        default=1.0,
        description="Material factor K_material of ISO/TS 6336-4.",
    )


#: How wide the teeth of a loaded pair are: a section, coupled slices of it, or solid gears.
Width = Literal["plane", "slices", "solid"]


#: Keys of a range of torques as some write it, and what they are here.
_ALSO = {"from": "start", "to": "stop", "steps": "count"}


class TorquesPart(EvenlySpaced):
    """``torques = { start, stop, count }``, evenly spaced, or a list; ``{ from, to, steps }`` says the same."""

    example = 'write { start = "150 N*m", stop = "300 N*m", count = 4 }, or a list of torques'

    values: Annotated[list[PositiveTorque], Field(min_length=1), at_most(1000, "torques")] | None = Field(
        default=None, description="Torques as a list (instead of the table)."
    )
    start: PositiveTorque | None = Field(default=None, description="Minimum torque; also written `from`.")
    stop: PositiveTorque | None = Field(default=None, description="Maximum torque; also written `to`.")
    count: Annotated[int, Field(ge=2, le=1000)] | None = Field(
        default=None, description="Number of equally spaced torques, both ends included; also written `steps`."
    )

    @model_validator(mode="before")
    @classmethod
    def _other_words(cls, value: Any) -> Any:
        if not isinstance(value, dict):
            return value
        return {_ALSO.get(key, key) if _ALSO.get(key) not in value else key: one for key, one in value.items()}


class PairPart(Part):
    """Two gears in mesh and the load between them."""

    driver: str = Field(description="Name of the driving gear.")
    driven: str = Field(description="Name of the driven gear; may be the same gear.")
    flank: Literal["drive", "coast"] | None = Field(
        default=None,
        description="Working flanks of asymmetric teeth (`coast_pressure_angle`): `drive`, or `coast` as under "
        "reversed torque. Default: as the other pairs of its gears imply (idlers and planets: opposite flanks of "
        "driving and driven mates), else `drive`.",
    )
    centre_distance: PositiveLength | None = Field(
        default=None,
        description="Working centre distance. Default: zero backlash.",
    )
    shift_distribution: Literal["driver", "driven", "equal", "equal-sliding", "equal-root-stress"] | None = Field(
        default=None,
        description="Sum of the profile shifts from `centre_distance`: the rest for `driver` or `driven`, or shared by "
        "equal x, specific sliding at A and E, or sigma_F0 (ISO 6336-3).",
    )
    normal_backlash: LengthOrZero | None = Field(
        default=None,
        description="Normal backlash, shared by equal `thickness_allowance` of the gears that specify none.",
    )
    circumferential_backlash: LengthOrZero | None = Field(
        default=None,
        description="Backlash on the working pitch circle; alternatively `normal_backlash`.",
    )
    load: PositiveForce | None = Field(
        default=None, description="Nominal load along the line of action; alternatively `torque` or `power`."
    )
    torque: PositiveTorque | None = Field(
        default=None, description="Nominal torque on the driver; alternatively `load` or `power`."
    )
    power: PositivePower | None = Field(
        default=None, description="Nominal power at `speed`; alternatively `torque` or `load`."
    )
    loads: Annotated[list[PositiveForce], Field(min_length=1), at_most(1000, "loads")] | None = Field(
        default=None,
        description="Additional loads along the line of action. Without `load` or `torque` the largest is the "
        "nominal load.",
    )
    torques: Table[TorquesPart] | None = Field(
        default=None,
        description="Torques on the driver at which the pair runs, in place of `loads`: a list or an equally spaced "
        "range. Relief is designed for all of them (`design.over`).",
    )
    weights: Annotated[list[Annotated[Number, Field(ge=0.0)]], Field(min_length=1)] | None = Field(
        default=None,
        description="Weight of each of `torques` or `loads` in the design of relief; 0: not included. "
        "Default: equal weights.",
    )
    speed: PositiveSpeed | None = Field(
        default=None, description="Speed of the driver, for example for the time column of root-stress histories."
    )
    width: Width | None = Field(
        default=None,
        description="Tooth model: `plane` (2D), `slices` (coupled slices) or `solid` (3D). Default: plane for spur, "
        "solid for helical gears.",
    )
    compliance: Table[CompliancePart] = Field(
        default_factory=CompliancePart, description="Source of the tooth compliances."
    )
    root_stress: Table[RootStressPart] = Field(
        default_factory=RootStressPart, description="Source of the root stresses."
    )
    misalignment: Table[MisalignmentPart] | None = Field(
        default=None,
        description="Misalignment of the shafts and deviations of the pinion flank; active with the "
        "effect `misalignment`.",
    )
    line_error: Table[LineErrorPart] | None = Field(
        default=None,
        description="Gap between the unloaded flanks over the face width (line error); active with "
        "effects.misalignment.",
    )
    modification: Table[ModificationPart] | None = Field(
        default=None,
        description="Crowning of the pinion flank for tooth contact analysis; included in loaded flanks with "
        "effects.relief.",
    )
    axial_offset: Length = Field(
        default=0.0,
        description="Axial offset of the driven gear's mid-face towards end I; only the common face width carries "
        "load.",
    )
    double_helical: Table[DoubleHelicalPart] | None = Field(
        default=None,
        description="Double helical pair: the gears are the half at end I; load, torque and power are those of both "
        "halves. Default: single helical.",
    )
    iso_6336: Table[IsoPart] = Field(
        default_factory=IsoPart, description="Options of ISO 6336: edition, methods, user-defined factors."
    )
    lubricant: Table[LubricantPart] | None = Field(
        default=None, description="Lubricant of the pair, for film thickness, scuffing, micropitting and friction."
    )
    friction: Table[PairFrictionPart] | None = Field(
        default=None, description="Friction law for gear-mesh-power-loss. Default: Schlenk if `lubricant` is specified."
    )
    operation: Table[OperationPart] = Field(
        default_factory=OperationPart, description="Loads, life and minimum safety factors for rating."
    )
    shafts: Table[ShaftsPart] | None = Field(
        default=None,
        description="Pinion shaft and bearing arrangement for K_Hbeta (ISO 6336-1) in rating.",
    )

    @model_validator(mode="after")
    def _one_load(self) -> Self:
        if self.load is not None and self.torque is not None:
            raise refuse(
                "contradicts load", "specify either the load along the line of action or the torque", key="torque"
            )
        if self.power is not None:
            for key in ("load", "torque"):
                if getattr(self, key) is not None:
                    raise refuse(f"contradicts {key}", f"specify either {key} or power", key="power")
            if self.speed is None:
                raise refuse("is required for power", 'set speed = "1500 rpm"', key="speed")
        if self.loads is not None and self.torques is not None:
            raise refuse("contradicts loads", "specify either loads along the line of action or torques", key="torques")
        return self

    @model_validator(mode="after")
    def _one_backlash(self) -> Self:
        if self.normal_backlash is not None and self.circumferential_backlash is not None:
            raise refuse("contradicts normal_backlash", "specify either of them", key="circumferential_backlash")
        if self.shift_distribution is not None and self.centre_distance is None:
            raise refuse("is required for shift_distribution", 'set centre_distance = "112 mm"', key="centre_distance")
        return self

    @model_validator(mode="after")
    def _a_weight_each(self) -> Self:
        if self.weights is None:
            return self
        values = self.loads if self.torques is None else self.torques.in_order.tolist()
        if values is None:
            raise refuse("requires torques or loads", 'set torques = ["150 N*m", "300 N*m"]', key="weights")
        if len(values) != len(self.weights):
            rule = (
                f"must have one weight for each of the {len(values)} {'loads' if self.torques is None else 'torques'}"
            )
            raise refuse(rule, key="weights", value=self.weights)
        if len(set(values)) < len(values):
            raise refuse("contradicts a value that is given twice", "specify each torque or load once", key="weights")
        if not any(self.weights):
            raise refuse("must contain a weight above zero", key="weights", value=self.weights)
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
                f"{prefix}.width", '"plane"', "is not available for helical gears",
                'set width = "solid" or "slices", or remove it',
            )  # fmt: skip
        if self.width_in(pair) == "plane":
            return
        if "compliance" in self.given:
            raise InputError(
                f"{prefix}.compliance", "(given)",
                "is defined for the plane (2D) model only; 3D gears are solved by FE",
                "remove compliance" if pair.driver.helix_angle else 'remove compliance, or set width = "plane"',
            )  # fmt: skip
        if self.root_stress.source != ("fe",):
            raise InputError(
                f"{prefix}.root_stress.source", list(self.root_stress.source),
                "is defined for the plane (2D) model only; root stress of 3D gears is computed "
                "by FE", 'set source = "fe"',
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

    @property
    def gears(self) -> tuple[str, ...]:
        """Names of its gears, those at end II of a double helical pair among them."""
        others = () if self.double_helical is None else self.double_helical.others.values()
        return (self.driver, self.driven, *(one for one in others if one is not None))

    @property
    def halves(self) -> int:
        """How many halves share the load evenly: 2 of a double helical pair, whose gears are one half."""
        return 1 if self.double_helical is None else 2

    def several_loads(self, pair: GearPair) -> tuple[float, ...]:
        """What `loads` or `torques` say, as loads along the line of action [N] in the order of the case, of a half."""
        if self.torques is not None:
            return tuple(torque / pair.driver.base_radius / self.halves for torque in self.torques.in_order.tolist())
        return tuple(load / self.halves for load in self.loads or ())

    def normal_load(self, pair: GearPair) -> float | None:
        """Load along the line of action [N]: the load, the driver's torque, or the largest of several; None without.

        Of a double helical pair that of one half, which is what its gears carry where the load is even.
        """
        if self.torque is not None:
            return self.torque / pair.driver.base_radius / self.halves
        return max(self.several_loads(pair), default=None) if self.load is None else self.load / self.halves

    def lever(self, pair: GearPair) -> float | None:
        """Lever of the driver [m] by which loads are torques; None where the case gives loads, or those of a half."""
        by_torque = self.torque is not None or (self.torques is not None and self.load is None)
        return pair.driver.base_radius if by_torque and self.halves == 1 else None

    def load_key(self, pair: GearPair) -> str:
        """Key by which the largest load is given: one of torques only where `lever` says that these are the loads."""
        if self.lever(pair) is None:
            return "load" if self.load is not None or self.loads is None else "loads"
        largest = 0.0 if self.torques is None else float(self.torques.in_order.max())
        return "torques" if self.torque is None or largest > self.torque else "torque"

    def all_loads(self, pair: GearPair) -> tuple[float, ...]:
        """Every load of the case along the line of action [N], ascending, the nominal one among them."""
        nominal = self.normal_load(pair)
        return tuple(sorted({*self.several_loads(pair), *(() if nominal is None else (nominal,))}))
