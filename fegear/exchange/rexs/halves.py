"""Two stages between the same shafts with equal teeth of opposite hand: halves of a double helical pair.

REXS has a stage for each half. They are imported as the pairs that they are, each with its part of the torque; how the
halves share it is a question to a pair with ``double_helical``, and a note says how to ask it.
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

from fegear.exchange.rexs.teeth import module_of, teeth_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.said import Said

#: Helix angles [rad] and modules agree within this share.
_AGREE = 1e-6


def double_helical_notes(
    said: Said, stages: Sequence[Stage], on: Mapping[int, Component | None], middles: Mapping[int, float]
) -> list[str]:
    """A note on every two stages that are halves of a double helical pair.

    Parameters
    ----------
    said : Said
    stages : sequence of Stage
        That carry a load.
    on : mapping of int to Component or None
        Shafts of gears, by the gears' numbers.
    middles : mapping of int to float
        Middle of every face on its shaft [m].
    """
    found = []
    for first, second in combinations(stages, 2):
        mates = [(gear, _on_the_same(gear, second, on)) for gear in first.gears]
        if first.internal or second.internal or not all(
            other is not None and _mirrored(said, gear, other) for gear, other in mates
        ):  # fmt: skip
            continue
        gear, other = mates[0]
        assert other is not None  # noqa: S101  (for mypy: see above)
        width = [said.number(one, "length", "face_width") or 0.0 for one in (gear, other)]
        gap = abs(middles[gear.id] - middles[other.id]) - 0.5 * sum(width)
        how = f'double_helical = {{ gap = "{max(gap, 0.0) * 1e3:.6g} mm" }}'
        found.append(
            f"{first.component.said} and {second.component.said}: equal teeth of opposite hand on the same shafts "
            "(halves of a double helical pair), imported as two pairs. For the load sharing of the halves, request "
            f"double-helical in a case of the first pair with the torque of both and {how}, without the second pair, "
            "shafts and effects.misalignment."
        )
    return found


def _on_the_same(gear: Component, stage: Stage, on: Mapping[int, Component | None]) -> Component | None:
    """The gear of a stage that is on the shaft of another gear."""
    shaft = on.get(gear.id)
    if shaft is None:
        return None
    same = [one for one in stage.gears if (other := on.get(one.id)) is not None and other.id == shaft.id]
    return same[0] if len(same) == 1 and same[0].id != gear.id else None


def _mirrored(said: Said, one: Component, other: Component) -> bool:
    """Whether two gears have equal teeth of opposite hand."""
    helix = [said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0 for gear in (one, other)]
    modules = [module_of(said, gear) for gear in (one, other)]
    return (
        teeth_of(said, one) == teeth_of(said, other)
        and math.isclose(*modules, rel_tol=_AGREE)
        and helix[0] != 0.0
        and math.isclose(helix[0], -helix[1], rel_tol=_AGREE)
    )
