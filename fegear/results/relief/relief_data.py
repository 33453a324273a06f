"""What the design of a pair's relief depends on, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.case.design import DesignPart
from fegear.case.effects import EffectsPart
from fegear.contact.pair_spec import PairSpec
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.design.load_range import LoadRange
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.tip_relief.tip_tolerance import TipTolerance


@dataclass(frozen=True)
class ReliefInputs:
    """What the design of a pair's relief depends on.

    Parameters
    ----------
    part : DesignPart
    asked : PairSpec
    over : LoadRange or None
        Loads that reliefs to grind are designed for together.
    tolerances : tuple of TipTolerance
        Of reliefs to grind on driver and driven gear.
    tolerance : float
        That neglected effects are compared with.
    effects : EffectsPart
        All of the case, for the remedies.
    neglected : bool
        Whether the sizes of effects that are off are estimated.
    labels, gears : mapping of str to str
        Names of the tables and of the gears by member.
    load_key : str
        Key of the design load where the design has none of its own, for messages.
    """

    part: DesignPart
    asked: PairSpec
    over: LoadRange | None
    tolerances: tuple[TipTolerance, TipTolerance]
    tolerance: float
    effects: EffectsPart = field(compare=False)
    neglected: bool
    labels: Mapping[Member, str] = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)
    load_key: str = field(default="design.load", compare=False)


@dataclass(frozen=True)
class ReliefData:
    """A designed relief.

    Parameters
    ----------
    pair : LoadedPair
    design : ReliefDesign
    neglected : mapping of str to tuple of str
        What effects that are off would change, in words.
    points : mapping of member to ReliefTable
        At the roll angles that the case asks for; empty where it names none.
    """

    pair: LoadedPair
    design: ReliefDesign
    neglected: Mapping[str, tuple[str, ...]]
    points: Mapping[Member, ReliefTable]
