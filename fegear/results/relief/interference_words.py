"""What an answer on reliefs begins with where a tip runs into the mating fillet: no relief mends that."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.tip_interference import below_form_by, clear_tip_radius

#: Less than this is no interference [m]: what tips wear off, and circles printed with three digits leave.
_MEETS = 1e-6
#: Hundredths of a millimetre in a metre.
_STEP = 1e5


def said_of_interference(name: str, pair: GearPair, gears: Mapping[Member, str]) -> Iterator[str]:
    """Which tips reach below the mating root form circle, and the tip diameter that does not.

    Parameters
    ----------
    name : str
        Of the pair.
    pair : GearPair
    gears : mapping of member to str
        Names of the gears.
    """
    for member in MEMBERS:
        deep = below_form_by(pair, member)
        if deep <= _MEETS:
            continue
        gear, mate = pair.gear(member), MEMBERS[member == "driver"]
        clear = 2.0 * clear_tip_radius(pair, member) * _STEP
        diameter, limit = (math.ceil(clear), "at least") if gear.tooth.internal else (math.floor(clear), "at most")
        key = "tip_diameter" if gear.involute_tip_radius == gear.tip_radius else "tip form diameter"
        yield (
            f"Pair {name}: first correct an interference: the tip of gear {gears[member]} reaches below the root form "
            f"circle of gear {gears[mate]} (by {deep * 1e3:.2g} mm of roll length); it requires a {key} of {limit} "
            f"{diameter * 1e3 / _STEP:.2f} mm."
        )
