"""Contact along tip edges: where the flanks go on touching beyond the ends of the plane of action.

Across parallel axes a helical tooth is its transverse section, turned along the axis, and what turns the gears closes
the gap of every section by itself. So the gap between a tip edge and its mate's flank at a height z is that of the
plane corner at its distance beyond the path of contact (`fegear.contact.plane.corner`), and the contact line goes on in
the coordinates of the plane of action, x = x_0 + j p_bt - z tan(beta_b), with a gap that grows from zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial, singledispatch
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.plane.meshing import Meshing
from fegear.geometry.pair import GearPair, Member

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.contact.plane.corner import CornerContact, InternalCornerContact

#: Approach of a tooth pair times Young's modulus over the load per face width: 15 to 20, and as much again.
_SOFTNESS = 40.0


#: Points on which the reach of an edge is looked up, and how much of a base pitch it covers at most.
_POINTS, FARTHEST = 400, 0.9


@dataclass(frozen=True)
class TipEdges(ReadOnlyArrays):
    """Contact of stations on the path and along both gears' tip edges; arrays of shape (P, M).

    Parameters
    ----------
    gap : ndarray
        Between an edge and its mate's unmodified flank, along the line of action [m]; 0 on the path.
    driver_length, driven_length : ndarray
        Roll lengths of the places that touch: on the path the flanks' radii of curvature [m].
    relative_radius : ndarray
        In the transverse section [m]: beyond the path that of the edge's rounding, or of the flank that a sharp edge
        ends, with the mate's flank.
    tilt : ndarray
        Slope at which the flanks part inward from the nearest sharp edge times the relative radius [m]: minus the
        distance from the edge on the path; minus infinity where edges are rounded.
    """

    gap: Array
    driver_length: Array
    driven_length: Array
    relative_radius: Array
    tilt: Array

    def length(self, member: Member) -> Array:
        """Roll lengths of one gear, shape (P, M) [m]."""
        return self.driver_length if member == "driver" else self.driven_length


@singledispatch
def edge_reach(pair: object, most_gap: float) -> tuple[float, float]:
    """How far beyond the start and the end of the path [m] a tip edge is no farther from its mate than a gap [m]."""
    if most_gap <= 0.0:
        return 0.0, 0.0
    assert isinstance(pair, GearPair)  # noqa: S101  (for mypy: others are registered)
    found = []
    for corner in Meshing(pair, corner_contact=True).corners:
        if not corner.exists:
            found.append(0.0)
            continue
        farthest = min(corner.reach, FARTHEST * pair.base_pitch)
        found.append(reach_of_corner(partial(_gap_of, corner), farthest, most_gap))
    return found[0], found[1]


def _gap_of(corner: CornerContact | InternalCornerContact, beyond: Array) -> Array:
    return corner.locate(beyond)[0]


def reach_of_corner(gap: Callable[[Array], Array], farthest: float, most_gap: float) -> float:
    """Distance beyond the path, up to the farthest, at which a corner's gap is as given [m]."""
    beyond = np.linspace(0.0, farthest, _POINTS)
    found = gap(beyond)
    there = np.isfinite(found)
    return float(np.interp(most_gap, found[there], beyond[there]))


def usual_gap(pair: GearPair, load: float) -> float:
    """Gap [m] that a load [N] does not close at any tip edge of a pair of solid steel gears whose load is even."""
    modulus = min(gear.material.young_modulus for gear in (pair.driver, pair.driven))
    return _SOFTNESS * load / (modulus * pair.face_width)


@singledispatch
def tip_edges(pair: object, x: ArrayLike) -> TipEdges:
    """Contact at places along the line of action, on the path or beyond it.

    Parameters
    ----------
    pair : GearPair
    x : array_like, shape (P, M)
        [m].
    """
    assert isinstance(pair, GearPair)  # noqa: S101  (for mypy: others are registered)
    at = Meshing(pair, corner_contact=True).touching(np.asarray(x, dtype=float))
    return TipEdges(at.gap, at.driver_length, at.driven_length, at.relative_radius, at.edge)
