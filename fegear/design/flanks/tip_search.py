"""The tip reliefs of teeth with a width that leave the least: the search of a family on a grid that fits its loads."""

from __future__ import annotations

import numpy as np

from fegear.design.flanks.families import FamilyBest, best_of_family
from fegear.design.flanks.grid import TIP_AMOUNTS, ReliefGrid
from fegear.design.flanks.tip_bench import TipTrials
from fegear.geometry.pair import GearPair

#: Lengths that are tried, over the path of contact.
_LENGTHS = (0.1, 0.17, 0.27, 0.4, 0.55, 0.75, 1.0)
#: What a tip may lose at most [modules].
_DEEPEST = 0.1


def tip_grid(pair: GearPair, mean: float) -> ReliefGrid:
    """Amounts and lengths that are tried; what is found lies between their ends.

    Parameters
    ----------
    pair : GearPair
    mean : float
        Transmission error at the largest load [m].
    """
    deepest = _DEEPEST * pair.driver.module
    amounts = tuple(min(mean * share, deepest) for share in TIP_AMOUNTS)
    return ReliefGrid(amounts, tuple(pair.path_length * share for share in _LENGTHS), (), (), (), (), ())


def best_tips(trials: TipTrials) -> FamilyBest:
    """The tip reliefs of both gears that leave the least, of the shape of the trials.

    Parameters
    ----------
    trials : TipTrials
        Under the loads that count.
    """
    few = trials.few
    plain = few.of_gap(np.zeros(few.known.lines.x.shape)).found[0]
    grid = tip_grid(few.pair, float(plain.mean_transmission_error[-1]))
    return best_of_family(trials.more, "profile", grid, plain.contact.force[:, :, -1], scan=few)
