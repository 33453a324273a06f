"""What a rating reads of the case, and what it has found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.case.built.agma_pair import AgmaInputs
    from fegear.case.built.rated_pair import PairToRate
    from fegear.contact.wide.rated import Computed
    from fegear.formulas.agma.agma2101 import AgmaRating
    from fegear.formulas.iso6336.conditions import PairRating
    from fegear.formulas.iso6336.safety import Curves, SpectrumRating


@dataclass(frozen=True)
class RatingInputs:
    """What the stage reads.

    Parameters
    ----------
    asked : PairToRate
    agma : AgmaInputs or None
    computed : bool
        Whether load distribution and root stress are computed.
    said : tuple of str
        What AGMA 2101 assumes, or why there is nothing of it.
    alone : bool
        Whether no other pair of the case is rated.
    """

    asked: PairToRate
    agma: AgmaInputs | None
    computed: bool
    said: tuple[str, ...]
    alone: bool


@dataclass(frozen=True)
class RatingData:
    """What the stage finds.

    Parameters
    ----------
    formula : PairRating
        By ISO 6336 alone.
    curves : Curves
        S-N curves at the nominal speed.
    spectrum : SpectrumRating or None
    computed : Computed or None
    by_computed : PairRating or None
        With what was computed in the place of formulas.
    spectrum_computed : SpectrumRating or None
    agma : AgmaRating or None
    why_not : tuple of str
        Why something that was asked for is missing.
    bent : (float, float) or None
        Computed R of the pinion and the wheel of a pair with a planet, in the place of that of annex B.
    """

    formula: PairRating
    curves: Curves
    spectrum: SpectrumRating | None
    computed: Computed | None
    by_computed: PairRating | None
    spectrum_computed: SpectrumRating | None
    agma: AgmaRating | None
    why_not: tuple[str, ...]
    bent: tuple[float, float] | None = None
