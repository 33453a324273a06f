"""A whole case: what is wanted, and the parts that describe it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fegear.case.accuracy import AccuracyPart
from fegear.case.design import DesignPart
from fegear.case.dynamics import DynamicsPart
from fegear.case.effects import EffectsPart
from fegear.case.flank_design import FlankDesignPart
from fegear.case.gear import GearPart
from fegear.case.helical import ToothContactPart
from fegear.case.loading import LoadDistributionPart, LoadingPart, TransmissionErrorPart
from fegear.case.operation import RatingPart
from fegear.case.pair import PairPart
from fegear.case.part import Part, Table
from fegear.case.planetary import PlanetaryPart
from fegear.case.renamed import SCHEMA_VERSION
from fegear.case.shaft import BearingPart, ShaftInSpacePart
from fegear.case.stiffness import StiffnessPart
from fegear.case.studies import CostPart, StudyPart, TolerancePart
from fegear.case.train import TrainPart
from fegear.case.transmissibility import TransmissibilityPart


class Case(Part):
    """One case file."""

    title: str = Field(default="", description="Headline of the report; without it the file's name.")
    schema_version: Annotated[int, Field(ge=1)] = Field(
        default=SCHEMA_VERSION,
        description="Form of case files that this one was written in; a later one than fegear knows is refused.",
    )
    results: Annotated[list[str], Field(min_length=1)] = Field(
        description="What is wanted: these results are computed, and what they need, nothing else."
    )
    neglected: bool | Literal["once"] | None = Field(
        default=None,
        description="Estimate in notes what effects that are off would change: `true`, `false`, or `once` (of a sweep "
        "only its first point). Default: `true` in a run; `false` in sweeps, effect studies and questions from Python.",
    )
    gear: dict[str, Table[GearPart]] = Field(
        default_factory=dict, description="The gears, each by a name of your choice."
    )
    pair: dict[str, Table[PairPart]] = Field(
        default_factory=dict, description="The pairs of gears in mesh, each by a name of your choice."
    )
    stiffness: Table[StiffnessPart] = Field(
        default_factory=StiffnessPart, description="Where the tables of compliance and root stress are taken."
    )
    study: Table[StudyPart] | None = Field(
        default=None, description="Gears over which root-stress formulas are compared with finite elements."
    )
    tooth_contact: Table[ToothContactPart] = Field(
        default_factory=ToothContactPart, description="How finely the contact of rigid flanks is followed."
    )
    load_distribution: Table[LoadDistributionPart] = Field(
        default_factory=LoadDistributionPart, description="How finely the load over the face is resolved."
    )
    transmissibility: dict[str, Table[TransmissibilityPart]] = Field(
        default_factory=dict, description="Helical pairs as rigid gears on bearings, each by a name of your choice."
    )
    design: Table[DesignPart] | None = Field(
        default=None, description="Which pair is to be relieved, for which load, and how its teeth are to share it."
    )
    flank_design: Table[FlankDesignPart] | None = Field(
        default=None, description="Relief over profile and face of a pair that is loaded with its width."
    )
    robustness: Table[TolerancePart] | None = Field(
        default=None, description="Deviations of a pair drawn at random inside the tolerances of its gears."
    )
    loading: Table[LoadingPart] | None = Field(default=None, description="Tooth loading functions to look at.")
    transmission_error: Table[TransmissionErrorPart] = Field(
        default_factory=TransmissionErrorPart,
        description="A method from the literature, in addition to the exact transmission error.",
    )
    train: Table[TrainPart] | None = Field(
        default=None, description="The gear train: bodies, shafts, meshes, dampers and torques."
    )
    planetary: dict[str, Table[PlanetaryPart]] = Field(
        default_factory=dict, description="Planetary sets, each by a name of your choice."
    )
    shaft: dict[str, Table[ShaftInSpacePart]] = Field(
        default_factory=dict,
        description="Shafts in space with their gears and bearings, each by a name of your choice.",
    )
    bearing: dict[str, Table[BearingPart]] = Field(
        default_factory=dict, description="Bearings of the shafts, each by a name of your choice."
    )
    dynamics: Table[DynamicsPart] = Field(
        default_factory=DynamicsPart, description="Speeds, frequencies, harmonics and friction of the running train."
    )
    effects: Table[EffectsPart] = Field(
        default_factory=EffectsPart, description="The physical effects that count; each is off unless named."
    )
    accuracy: Table[AccuracyPart] = Field(
        default_factory=AccuracyPart, description="How exact the finite elements shall be."
    )
    rating: Table[RatingPart] = Field(
        default_factory=RatingPart, description="What is evaluated in addition to the rating by ISO 6336."
    )
    cost: Table[CostPart] = Field(
        default_factory=CostPart, description="What `fegear cost` studies; a run does not read it."
    )
