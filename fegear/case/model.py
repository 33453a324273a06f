"""A whole case: what is wanted, and the parts that describe it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from fegear.case.accuracy import AccuracyPart
from fegear.case.dynamics import DynamicsPart
from fegear.case.effects import EffectsPart
from fegear.case.gear import GearPart
from fegear.case.helical import ToothContactPart
from fegear.case.loading import LoadDistributionPart, LoadingPart, TransmissionErrorPart
from fegear.case.operation import RatingPart
from fegear.case.pair import PairPart
from fegear.case.part import Later, Part, Table
from fegear.case.renamed import SCHEMA_VERSION
from fegear.case.stiffness import StiffnessPart
from fegear.case.studies import CostPart, StudyPart, TolerancePart

if TYPE_CHECKING:
    from fegear.case.compound import CompoundPart
    from fegear.case.crack_growth import CrackGrowthPart
    from fegear.case.design import DesignPart
    from fegear.case.encoders import EncodersPart
    from fegear.case.fillet_design import FilletDesignPart
    from fegear.case.flank_design import FlankDesignPart
    from fegear.case.gauge import GaugePart
    from fegear.case.planetary import PlanetaryPart
    from fegear.case.rack import RackAndPinionPart
    from fegear.case.shaft import BearingPart, ShaftInSpacePart
    from fegear.case.sizing import SizingPart
    from fegear.case.train import TrainPart
    from fegear.case.transmissibility import TransmissibilityPart
else:  # tables that few cases have
    CompoundPart = Later("fegear.case.compound", "CompoundPart")
    CrackGrowthPart = Later("fegear.case.crack_growth", "CrackGrowthPart")
    DesignPart = Later("fegear.case.design", "DesignPart")
    EncodersPart = Later("fegear.case.encoders", "EncodersPart")
    FilletDesignPart = Later("fegear.case.fillet_design", "FilletDesignPart")
    FlankDesignPart = Later("fegear.case.flank_design", "FlankDesignPart")
    GaugePart = Later("fegear.case.gauge", "GaugePart")
    PlanetaryPart = Later("fegear.case.planetary", "PlanetaryPart")
    RackAndPinionPart = Later("fegear.case.rack", "RackAndPinionPart")
    BearingPart = Later("fegear.case.shaft", "BearingPart")
    ShaftInSpacePart = Later("fegear.case.shaft", "ShaftInSpacePart")
    SizingPart = Later("fegear.case.sizing", "SizingPart")
    TrainPart = Later("fegear.case.train", "TrainPart")
    TransmissibilityPart = Later("fegear.case.transmissibility", "TransmissibilityPart")


class Case(Part):
    """One case file."""

    title: str = Field(default="", description="Title of the report. Default: file name.")
    schema_version: Annotated[int, Field(ge=1)] = Field(
        default=SCHEMA_VERSION,
        description="Version of the case file format; newer versions than supported are rejected.",
    )
    results: Annotated[list[str], Field(min_length=1)] = Field(description='Results to compute, e.g. ["rating"].')
    neglected: bool | Literal["once"] | None = Field(
        default=None,
        description="Estimate the influence of effects that are off (notes): `true`, `false`, or `once` (first point "
        "of a sweep only). Default: `true` in a run; `false` in sweeps, effect studies and Python.",
    )
    gear: dict[str, Table[GearPart]] = Field(default_factory=dict, description="Gears, by name.")
    pair: dict[str, Table[PairPart]] = Field(default_factory=dict, description="Gear pairs in mesh, by name.")
    gauge: dict[str, Table[GaugePart]] = Field(
        default_factory=dict, description="Strain gauges in root fillets, by name."
    )
    encoders: dict[str, Table[EncodersPart]] = Field(
        default_factory=dict, description="Transmission errors measured with encoders, by name."
    )
    crack_growth: Table[CrackGrowthPart] | None = Field(
        default=None, description="Growth of the cracks of odd teeth (result `crack-path`)."
    )
    stiffness: Table[StiffnessPart] = Field(
        default_factory=StiffnessPart, description="Load positions of the compliance and root stress tables."
    )
    study: Table[StudyPart] | None = Field(
        default=None, description="Gears for the comparison of root-stress formulas with FE."
    )
    tooth_contact: Table[ToothContactPart] = Field(
        default_factory=ToothContactPart, description="Settings of the tooth contact analysis (rigid flanks)."
    )
    load_distribution: Table[LoadDistributionPart] = Field(
        default_factory=LoadDistributionPart, description="Settings of the load distribution over the face width."
    )
    transmissibility: dict[str, Table[TransmissibilityPart]] = Field(
        default_factory=dict, description="Helical pairs as rigid gears on bearings, by name."
    )
    design: Table[DesignPart] | None = Field(
        default=None, description="Profile modification design: pair, design load, load sharing."
    )
    flank_design: Table[FlankDesignPart] | None = Field(
        default=None, description="Design of profile and flank line modifications of a 3D pair."
    )
    fillet_design: Table[FilletDesignPart] | None = Field(
        default=None, description="Design of the fillet with minimum root stress (result `fillet-design`)."
    )
    robustness: Table[TolerancePart] | None = Field(
        default=None, description="Random deviations of a pair within the tolerances of its gears."
    )
    sizing: Table[SizingPart] | None = Field(
        default=None, description="Requirement for which the teeth of a pair are chosen (`fegear size`)."
    )
    loading: Table[LoadingPart] | None = Field(default=None, description="Tooth loading functions.")
    transmission_error: Table[TransmissionErrorPart] = Field(
        default_factory=TransmissionErrorPart,
        description="Additional method for the transmission error (Mark's series).",
    )
    train: Table[TrainPart] | None = Field(
        default=None, description="Gear train: bodies, shafts, meshes, dampers and torques."
    )
    planetary: dict[str, Table[PlanetaryPart]] = Field(
        default_factory=dict, description="Planetary gear sets, by name."
    )
    compound: dict[str, Table[CompoundPart]] = Field(
        default_factory=dict,
        description="Planetary gear sets of any shafts, planets and meshes (stepped, Ravigneaux, Simpson), by name.",
    )
    rack: dict[str, Table[RackAndPinionPart]] = Field(
        default_factory=dict, description="Racks, each with the pinion that rolls on it, by name."
    )
    shaft: dict[str, Table[ShaftInSpacePart]] = Field(
        default_factory=dict,
        description="Shafts with their gears and bearings, by name.",
    )
    bearing: dict[str, Table[BearingPart]] = Field(default_factory=dict, description="Bearings of the shafts, by name.")
    dynamics: Table[DynamicsPart] = Field(
        default_factory=DynamicsPart, description="Speeds, frequencies, harmonics and friction of the gear train."
    )
    effects: Table[EffectsPart] = Field(
        default_factory=EffectsPart, description="Physical effects included; all others are off."
    )
    accuracy: Table[AccuracyPart] = Field(default_factory=AccuracyPart, description="Accuracy of the FE solution.")
    rating: Table[RatingPart] = Field(
        default_factory=RatingPart, description="Evaluations in addition to the rating to ISO 6336."
    )
    cost: Table[CostPart] = Field(
        default_factory=CostPart, description="Settings of `fegear cost` (not used in a run)."
    )
