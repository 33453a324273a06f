"""The relief that a case gives a gear, for drawings: whether or not the effect `relief` counts it in load sharing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.part import at
from fegear.errors import InputError
from fegear.geometry.pair import MEMBERS
from fegear.models.loaded_pair import build_relief
from fegear.models.pair_inputs import gear_flanks, gear_name

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.geometry.relief import Relief


@dataclass(frozen=True, slots=True)
class DescribedRelief:
    """Relief of both flanks of a gear.

    Parameters
    ----------
    relief : Relief or None
        None if the case gives none, or if it cannot be had.
    left_out : str
        Why it cannot be had; else empty.
    pair : str
        The pair with which it was built, where other pairs of the gear would give another; else empty.
    """

    relief: Relief | None = None
    left_out: str = ""
    pair: str = ""


def described_relief(scene: Scene, gear: str) -> DescribedRelief:
    """Relief of a gear from its own keys and, for lengths that count on the path of contact, from its pairs.

    Raises
    ------
    InputError
        If the relief does not fit the gear.
    """
    if scene.case.gear[gear].relief is None:
        return DescribedRelief()
    flanks = gear_flanks(scene, gear)
    if "relief" in flanks.wrong:
        raise flanks.wrong["relief"]
    if flanks.wants_delta:
        return DescribedRelief(left_out="its amount counts in deflections (amount_over_delta)")
    built: dict[str, Relief] = {}
    for name, pair in scene.pairs.items():
        for member in MEMBERS:
            if gear_name(scene, name, member) == gear and name not in built:
                try:
                    built[name] = build_relief(pair, member, flanks, math.nan)
                except InputError as error:
                    raise at(f"gear.{gear}", error) from None
    if not built:
        return DescribedRelief(left_out="its ends follow from the path of contact, and the gear is in no pair")
    (first, relief), *others = built.items()
    involute = scene.gears[gear].tooth.involute
    roll = np.linspace(involute.start, involute.end, 101)
    differ = any(np.abs(other.removal(roll) - relief.removal(roll)).max() > 1e-9 for _, other in others)
    return DescribedRelief(relief, pair=first if differ else "")
