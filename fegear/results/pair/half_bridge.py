"""Half bridges: a gauge with a second one of its tooth in the adjacent arm, of which the difference is measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.gauge_strain import GaugeHistory

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.contact.gauge_strain import StrainWith


@dataclass(frozen=True)
class HalfBridge:
    """What a half bridge sees; P positions.

    Parameters
    ----------
    second : str
        Gauge in the adjacent arm.
    history : GaugeHistory
        Of the difference, with the grid of the first gauge displaced.
    displaced : ndarray, shape (P, G)
        Difference at the nominal load with the grid of the second gauge displaced.
    with_effects : mapping of str to StrainWith
        Difference at the nominal load with each effect that is off.
    """

    second: str
    history: GaugeHistory
    displaced: Array
    with_effects: Mapping[str, StrainWith]

    @classmethod
    def of(
        cls, name: str, first: GaugeHistory, second: GaugeHistory, at: int, more: Mapping[str, StrainWith],
        more_of_second: Mapping[str, StrainWith],
    ) -> HalfBridge:  # fmt: skip
        """Of two gauges and what each sees with further effects.

        Parameters
        ----------
        name : str
            Of the second gauge.
        first, second : GaugeHistory
        at : int
            Number of the nominal load.
        more, more_of_second : mapping of str to StrainWith
        """
        history = first.less(second)
        peak = float(np.abs(history.strain[:, at]).max())
        both = {effect: one.less(more_of_second[effect], peak) for effect, one in more.items()
                if effect in more_of_second}  # fmt: skip
        return cls(name, history, first.less_displaced(second, at), both)
