"""One tooth of a gear whose web has holes: what differs from the mean over all teeth that a solution holds."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.fem.solid.solution import SolidSolution


def tooth_over_holes(solution: SolidSolution, number: int) -> SolidSolution:
    """The solution with one tooth loaded, counted clockwise from tooth 0; its neighbours are those of that tooth."""
    holed = solution.holed
    if holed is None:
        return solution
    compliance = {k: c + holed.flank_apart(k, number) for k, c in solution.compliance.items()}
    moved = {(k, side): u + holed.fillet_apart(k, number, side) for (k, side), u in solution.displacement.items()}
    return replace(solution, compliance=compliance, displacement=moved, holed=None)


def as_if_all_were(solution: SolidSolution, number: int) -> SolidSolution:
    """A gear all of whose teeth stand to the holes as one does; neighbours of both sides deflect as on average."""
    one = tooth_over_holes(solution, number)
    return replace(one, compliance={k: 0.5 * (c + one.compliance[-k].T) for k, c in one.compliance.items()})
