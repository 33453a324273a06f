"""A whole case: what is wanted, and the parts that describe it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from fegear.case.accuracy import AccuracyPart
from fegear.case.cost import CostPart
from fegear.case.design import DesignPart
from fegear.case.dynamics import DynamicsPart
from fegear.case.effects import EffectsPart
from fegear.case.flank_design import FlankDesignPart
from fegear.case.gear import GearPart
from fegear.case.helical import ToothContactPart
from fegear.case.load_distribution import LoadDistributionPart
from fegear.case.loading import LoadingPart
from fegear.case.pair import PairPart
from fegear.case.part import Part
from fegear.case.stiffness import StiffnessPart
from fegear.case.study import StudyPart
from fegear.case.train import TrainPart
from fegear.case.transmissibility import TransmissibilityPart
from fegear.case.transmission_error import TransmissionErrorPart


class Case(Part):
    """One case file."""

    title: str = ""
    results: Annotated[list[str], Field(min_length=1)]
    gear: dict[str, GearPart] = Field(default_factory=dict)
    pair: dict[str, PairPart] = Field(default_factory=dict)
    stiffness: StiffnessPart = Field(default_factory=StiffnessPart)
    study: StudyPart | None = None
    tooth_contact: ToothContactPart = Field(default_factory=ToothContactPart)
    load_distribution: LoadDistributionPart = Field(default_factory=LoadDistributionPart)
    transmissibility: dict[str, TransmissibilityPart] = Field(default_factory=dict)
    design: DesignPart | None = None
    flank_design: FlankDesignPart | None = None
    loading: LoadingPart | None = None
    transmission_error: TransmissionErrorPart = Field(default_factory=TransmissionErrorPart)
    train: TrainPart | None = None
    dynamics: DynamicsPart = Field(default_factory=DynamicsPart)
    effects: EffectsPart = Field(default_factory=EffectsPart)
    accuracy: AccuracyPart = Field(default_factory=AccuracyPart)
    cost: CostPart = Field(default_factory=CostPart)
