"""Stress along both fillets of one tooth with a width, at one height, for bending to either side.

The same of plane teeth stands in `fegear.contact.plane.both_flanks`. A planet is seen from its other end where its
other flank is loaded: what stands at the height z in the mesh with the sun stands at -z in that with the ring.
"""

from __future__ import annotations

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.plane.both_flanks import FilletTrace
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.contact.wide.root_stress import rooted_lines
from fegear.fem.plane.influence import Side
from fegear.fem.solid.solution import SolidSolution
from fegear.geometry.pair import Member


def fillet_trace_at(teeth: LoadedWidePair, member: Member, solution: SolidSolution, z: float) -> FilletTrace:
    """Follow one tooth of a gear through a mesh under the nominal load, at a height from the middle of the face [m]."""
    found = teeth.found
    rooted = rooted_lines(teeth.pair, member, found.lines, solution, coupling=teeth.coupling)
    force = found.contact.force[:, :, teeth.at]
    sides: tuple[Side, Side] = ("tension", "compression")
    stress = {side: _held(rooted.along_fillets(side, force, [z])[:, 0]).T for side in sides}
    fillets = solution.fillets
    return FilletTrace(
        rooted.x, {side: fillets[side].arc for side in sides}, stress, min(fillets[side].length for side in sides)
    )


def _held(stress: Array) -> Array:
    """Up the fillet, shape (points, T): beside a contact line, where stress is no root stress, as below it."""
    known = np.isfinite(stress)
    last = np.maximum.accumulate(np.where(known, np.arange(len(stress))[:, None], 0), axis=0)
    return np.take_along_axis(stress, last, axis=0)
