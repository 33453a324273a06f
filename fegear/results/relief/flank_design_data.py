"""What the design of a pair's flanks depends on, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.case.flank_design import FlankDesignPart
from fegear.geometry.pair import GearPair, Member

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.design.flanks.flank_design import FlankDesign


@dataclass(frozen=True)
class FlankDesignInputs:
    """What the design of a pair's flanks depends on, besides its loaded flanks.

    Parameters
    ----------
    part : FlankDesignPart
    name : str
        Of the pair.
    gears : mapping of str to str
        Names of driver and driven.
    """

    part: FlankDesignPart
    name: str
    gears: Mapping[Member, str]


@dataclass(frozen=True)
class FlankDesignData:
    """A design and its pair."""

    pair: GearPair
    design: FlankDesign
    on_shafts: bool = False
