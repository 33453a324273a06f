"""A gear of the other hand from one that is solved: both mirror each other at the middle of the face.

The section stays, the helix and all motion along the axis change sign, and functions along the face that are odd about
its middle do. So nothing is solved again.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.solid.influence import SolidInfluence
from fegear.fem.solid.solution import SolidSolution


def can_be_mirrored(solution: SolidSolution) -> bool:
    """Whether its functions along the face are even or odd: those of a disc that is fixed all along the face."""
    return (
        solution.body is None and solution.held is None and solution.support is None and len(solution.face.degrees) == 1
    )


def mirrored_solution(solution: SolidSolution) -> SolidSolution:
    """The gear of the other hand; see `can_be_mirrored`."""
    along = np.where(solution.face.odd, -1.0, 1.0)
    ports = np.tile(along, solution.flank.nodes)
    # of a displacement: x and y stay as they are, z turns
    axes = np.array([1.0, 1.0, -1.0])
    moved = np.multiply.outer(axes, along)

    def turned(displacement: Array) -> Array:
        return displacement * moved[None, :, :, None] * ports

    return replace(
        solution,
        tau=-solution.tau,
        compliance={k: c * np.multiply.outer(ports, ports) for k, c in solution.compliance.items()},
        displacement={key: turned(one) for key, one in solution.displacement.items()},
    )


def mirrored_influence(influence: SolidInfluence) -> SolidInfluence:
    """The same with the solution that shows its errors, which stay as they are."""
    coarse = None if influence.coarse is None else mirrored_solution(influence.coarse)
    return replace(influence, fine=mirrored_solution(influence.fine), coarse=coarse)
