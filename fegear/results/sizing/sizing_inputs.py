"""What a sizing depends on, and by which criteria its variants are compared."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from fegear.case.sizing import SizingPart
from fegear.design.sizing.by_atlas import AtlasDuty
from fegear.design.sizing.feasible import BARE, BY_FE, RELIEVED, ROOT
from fegear.design.sizing.limits import SizingLimits
from fegear.design.sizing.rated import SizingDuty
from fegear.design.sizing.space import SizingSpace

#: Criteria that stand in where none of the wanted ones is given by formulas.
_STAND_IN = ("mass", "safety")
#: Criterion by which variants are chosen for finite elements: transmission errors fall with the total contact ratio.
_FOR_FE = "contact-ratio"


@dataclass(frozen=True)
class SizingInputs:
    """What a sizing depends on.

    Parameters
    ----------
    part : SizingPart
    space, limits, duty
        What may vary, limits, what every variant is rated for.
    asked : mapping
        What the cases of variants have from the requirement, numbers in SI.
    atlas : AtlasDuty or None
        What variants are looked up for in an atlas; None where none contains any, or arrays cannot be computed.
    folder : str
        Where files that the case names are looked for.
    said : tuple of str
        What had to be assumed.
    """

    part: SizingPart
    space: SizingSpace
    limits: SizingLimits
    duty: SizingDuty
    asked: Mapping[str, Any]
    atlas: AtlasDuty | None = None
    folder: str = field(compare=False, default="")
    said: tuple[str, ...] = field(compare=False, default=())

    @property
    def by_formulas(self) -> tuple[str, ...]:
        """Criteria that formulas give; the contact ratio stands for the transmission error until it is known."""
        names = tuple(name for name in self.part.criteria if name not in BY_FE) or _STAND_IN
        return (*names, _FOR_FE) if self.with_fe and _FOR_FE not in names else names

    @property
    def with_fe(self) -> bool:
        """Whether a criterion is given by finite elements, and variants are asked of them."""
        return bool(BY_FE & set(self.part.criteria)) and (self.part.screened > 0 or self.atlas is not None)

    @property
    def criteria(self) -> tuple[str, ...]:
        """Criteria by which the variants that are shown are compared."""
        return tuple(self.part.criteria) if self.with_fe else self.by_formulas

    @property
    def relieved(self) -> bool:
        """Whether reliefs are searched."""
        return RELIEVED in self.criteria

    @property
    def bare(self) -> bool:
        """Whether numbers of unmodified flanks count."""
        return BARE in self.criteria or ROOT in self.criteria or not self.relieved
