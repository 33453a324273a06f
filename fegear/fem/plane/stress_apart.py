"""How far the stress of a fillet is apart in two solutions beside the place where it is largest; dimensionless.

Two solutions wave about each other where edges resolve little, and may agree by chance at the place that counts: there
they are compared a little to either side of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.root_stress import CLEARANCE, search_end, smooth_at, without_contact

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Influence, Side

#: So it is in the first and the last edge of a fillet, where its curvature ends: they are compared so many of these
#: edges' lengths to either side of places no farther from an end than so many.
_BESIDE_PLACE, _FROM_END = 0.25, 1.25
#: And below a contact so near to the fillet that its pressure is narrowed, which no edge resolves: so much of the way
#: up to where the search ends (of 48 gears and rings one had 1.8 times the stated error; now 0.8 at most).
_BESIDE_CONTACT = 0.1


def apart_beside_ends(
    solutions: tuple[Influence, Influence], side: Side, stress: tuple[Array, Array], place: Array
) -> Array:
    """Largest distance of both solutions' curves beside places near an end of the fillet, shape (P,); elsewhere 0.

    Parameters
    ----------
    solutions : (Influence, Influence)
        On the same mesh.
    side : {"tension", "compression"}
    stress : (ndarray, ndarray), shape (points, P)
        Along the fillet, of each.
    place : ndarray, shape (P,)
        Arc lengths from the root land [modules].
    """
    fillet, order = solutions[0].fillets[side], solutions[0].flank.order
    arc, length = fillet.arc, fillet.length
    # Gauss points stand alike from both ends of an edge.
    first, last = float(arc[0] + arc[order - 1]), float(2.0 * length - arc[-1] - arc[-order])
    edge = np.where(place < 0.5 * length, first, last)
    near = np.minimum(place, length - place) <= _FROM_END * edge
    found = np.zeros_like(place)
    if near.any():
        at = place[near] + _BESIDE_PLACE * edge[near] * np.array([[-1.0], [0.0], [1.0]])
        at = np.clip(at, 0.0, length)
        curves = [
            smooth_at(values[:, near], one.fillets[side].arc, at) for one, values in zip(solutions, stress, strict=True)
        ]
        found[near] = np.abs(curves[0] - curves[1]).max(axis=0)
    return found


def apart_beside_contacts(
    solutions: tuple[Influence, Influence],
    stress: tuple[Array, Array],
    place: Array,
    above: Array,
    width: Array,
    half_width: Array,
) -> Array:
    """The same of tension below contacts whose pressure the fillet narrows, shape (P,); elsewhere 0.

    Parameters
    ----------
    solutions, stress, place
        As of `apart_beside_ends`.
    above, width : ndarray, shape (P,)
        How far above the fillet contacts stand, infinitely of the other fillet, and their half-widths [modules].
    half_width : ndarray
        That of contacts that nothing narrows [modules].
    """
    found, near = np.zeros_like(place), above < half_width
    if near.any():
        end = search_end(solutions[0].fillets["tension"].length, above[near], width[near], CLEARANCE)
        at = np.clip(place[near] + _BESIDE_CONTACT * end * np.array([[-1.0], [0.0], [1.0]]), 0.0, end)
        curves = []
        for one, values in zip(solutions, stress, strict=True):
            arc = one.fillets["tension"].arc
            below = without_contact(np.ascontiguousarray(values[:, near]), arc, end, CLEARANCE)
            curves.append(smooth_at(below, arc, at))
        found[near] = np.abs(curves[0] - curves[1]).max(axis=0)
    return found
