"""A whole case: what is wanted, and the parts that describe it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from fegear.case.accuracy import AccuracyPart
from fegear.case.design import DesignPart, FlankDesignPart
from fegear.case.dynamics import DynamicsPart
from fegear.case.effects import EffectsPart
from fegear.case.gear import GearPart
from fegear.case.helical import ToothContactPart
from fegear.case.loading import LoadDistributionPart, LoadingPart, TransmissionErrorPart
from fegear.case.operation import RatingPart
from fegear.case.pair import PairPart
from fegear.case.part import Part
from fegear.case.planetary import PlanetaryPart
from fegear.case.shaft import BearingPart, ShaftInSpacePart
from fegear.case.stiffness import StiffnessPart
from fegear.case.studies import CostPart, StudyPart, TolerancePart
from fegear.case.train import TrainPart
from fegear.case.transmissibility import TransmissibilityPart


class Case(Part):
    """One case file."""

    title: str = Field(default="", description="Headline of the report; without it the file's name.")
    results: Annotated[list[str], Field(min_length=1)] = Field(
        description="What is wanted: these results are computed, and what they need, nothing else."
    )
    gear: dict[str, GearPart] = Field(default_factory=dict, description="The gears, each by a name of your choice.")
    pair: dict[str, PairPart] = Field(
        default_factory=dict, description="The pairs of gears in mesh, each by a name of your choice."
    )
    stiffness: StiffnessPart = Field(
        default_factory=StiffnessPart, description="Where the tables of compliance and root stress are taken."
    )
    study: StudyPart | None = Field(
        default=None, description="Gears over which root-stress formulas are compared with finite elements."
    )
    tooth_contact: ToothContactPart = Field(
        default_factory=ToothContactPart, description="How finely the contact of rigid flanks is followed."
    )
    load_distribution: LoadDistributionPart = Field(
        default_factory=LoadDistributionPart, description="How finely the load over the face is resolved."
    )
    transmissibility: dict[str, TransmissibilityPart] = Field(
        default_factory=dict, description="Helical pairs as rigid gears on bearings, each by a name of your choice."
    )
    design: DesignPart | None = Field(
        default=None, description="Which pair is to be relieved, for which load, and how its teeth are to share it."
    )
    flank_design: FlankDesignPart | None = Field(
        default=None, description="Relief over profile and face of a pair that is loaded with its width."
    )
    robustness: TolerancePart | None = Field(
        default=None, description="Deviations of a pair drawn at random inside the tolerances of its gears."
    )
    loading: LoadingPart | None = Field(default=None, description="Tooth loading functions to look at.")
    transmission_error: TransmissionErrorPart = Field(
        default_factory=TransmissionErrorPart,
        description="A method from the literature, in addition to the exact transmission error.",
    )
    train: TrainPart | None = Field(
        default=None, description="The gear train: bodies, shafts, meshes, dampers and torques."
    )
    planetary: dict[str, PlanetaryPart] = Field(
        default_factory=dict, description="Planetary sets, each by a name of your choice."
    )
    shaft: dict[str, ShaftInSpacePart] = Field(
        default_factory=dict,
        description="Shafts in space with their gears and bearings, each by a name of your choice.",
    )
    bearing: dict[str, BearingPart] = Field(
        default_factory=dict, description="Bearings of the shafts, each by a name of your choice."
    )
    dynamics: DynamicsPart = Field(
        default_factory=DynamicsPart, description="Speeds, frequencies, harmonics and friction of the running train."
    )
    effects: EffectsPart = Field(
        default_factory=EffectsPart, description="The physical effects that count; each is off unless named."
    )
    accuracy: AccuracyPart = Field(default_factory=AccuracyPart, description="How exact the finite elements shall be.")
    rating: RatingPart = Field(
        default_factory=RatingPart, description="What is evaluated in addition to the rating by ISO 6336."
    )
    cost: CostPart = Field(default_factory=CostPart, description="What `fegear cost` studies; a run does not read it.")
