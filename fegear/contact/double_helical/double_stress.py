"""Root stress of both halves of a double helical pair under what each of them carries."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.contact.wide.root_stress import rooted_lines
from fegear.fem.plane.root_stress import curves_apart

if TYPE_CHECKING:
    from fegear.base.solution_cache import SolutionCache
    from fegear.contact.double_helical.loaded_double import LoadedDoublePair
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.geometry.pair import Member

#: Places along the face per module, at which it is looked for, and how many at least.
_PER_MODULE, _FEWEST = 4.0, 17


class LargestTension(NamedTuple):
    """Largest root tension of one gear of a half [Pa], its estimated error, and where along the half's face [m]."""

    value: float
    error: float
    z: float


def largest_tension(
    pair: LoadedDoublePair, number: int, member: Member, gear: SolidInfluence, case: int, cache: SolutionCache
) -> LargestTension:
    """Largest tension over fillet, face and mesh positions, under one load; NaN of a half that carries nothing.

    Its error is that of the gear's solution with that of the half's load.

    Parameters
    ----------
    pair : LoadedDoublePair
    number : int
        0 or 1: the half at end I or II.
    member : {"driver", "driven"}
    gear : SolidInfluence
        Solved, of this half.
    case : int
        Number of the load.
    cache : SolutionCache
    """
    half, spec = pair.halves[number], pair.spec.halves[number]
    force = half.contact.force[:, :, case]
    if not force.any():
        return LargestTension(math.nan, math.nan, math.nan)
    lines, module, coupled = half.lines, half.pair.driver.module, spec.neighbour_coupling
    rooted = cache.call(rooted_lines, half.pair, member, lines, gear.fine, coupling=coupled).value
    count = max(_FEWEST, 2 * round(0.5 * _PER_MODULE * (lines.high - lines.low) / module) + 1)
    z = np.linspace(lines.low, lines.high, count)
    felt = rooted.stress("tension", force, z)
    values, places, _ = felt.largest(1.0)
    most = int(np.argmax(values))
    largest, error = float(values[most]), math.nan
    if pair.error is not None:
        if gear.coarse is None:  # slices know how far they are off
            error = gear.error["root_tension"] * largest
        else:
            again = cache.call(rooted_lines, half.pair, member, lines, gear.coarse, coupling=coupled).value
            other = again.stress("tension", force, z)
            error = gear.entry_shares["root_tension"] * float(curves_apart(felt.value, other.value)[most])
        error += largest * float(pair.error.share[:, case].max() / pair.share[number, :, case].max())
    return LargestTension(largest, error, float(places[most]))
