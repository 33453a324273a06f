"""What the edges of a mesh, which are no more than cubic, take off a fillet or add to it, and what that moves.

Elements of any order have the same edges, so that no two of them on one mesh show it. To the first order a free surface
that lies farther out by h makes teeth deflect less by the integral of the strain energy of the surface times h
(Hadamard), and the stress along the fillet is known for every load.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.mesh import GENERATED
from fegear.geometry.curves import arc_length

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Influence, Side

#: Steps of Newton's method to the foot of a point on its curve, which lies near.
_STEPS = 3


def beyond_the_fillet(known: Influence, side: Side) -> Array:
    """How far the points of a fillet lie outside its exact curve, out of the material, shape (points,) [modules].

    Nothing of a user's own mesh: it need not be of the exact curve.
    """
    fillet, curve = known.fillets[side], known.tooth.fillet
    if known.mesh.origin != GENERATED:
        return np.zeros(fillet.arc.size)
    mirror = 1.0 if side == "tension" else -1.0
    place = fillet.radius * np.stack([mirror * np.sin(fillet.angle), np.cos(fillet.angle)])
    parameter, length = arc_length(curve)
    at = np.interp(fillet.arc * (length[-1] / fillet.length), length, parameter)
    low, high = min(curve.start, curve.end), max(curve.start, curve.end)
    for _ in range(_STEPS):
        normal = curve.normals(at)
        ahead = ((place - curve.points(at)) * np.stack([-normal[1], normal[0]])).sum(axis=0)
        step = curve.points(at + 1e-6) - curve.points(at - 1e-6)
        rate = (step * np.stack([-normal[1], normal[0]])).sum(axis=0) / 2e-6
        at = np.clip(at + ahead / rate, low, high)
    return np.asarray(((place - curve.points(at)) * curve.normals(at)).sum(axis=0))


def moved_by_edges(known: Influence, k: int, p: Array, q: Array, outside: dict[Side, Array]) -> Array:
    """By how much c_k(p, q) of a solution is too small since its fillets' edges lie outside the curves, shape (P, Q).

    Parameters
    ----------
    known : Influence
    k : int
    p, q : ndarray, shape (2n, P) and (2n, Q)
        Loads on the run of the flank.
    outside : mapping of {"tension", "compression"} to ndarray
        As of `beyond_the_fillet`.
    """
    modulus = 1.0 if known.plane == "stress" else 1.0 / (1.0 - known.poisson_ratio**2)
    total = np.zeros((p.shape[1], q.shape[1]))
    for side, off in outside.items():
        weight = off * _lengths(known, side) / modulus
        for j in range(max(k, 0) - known.reach, min(k, 0) + known.reach + 1):
            under_q, under_p = known.stress[j, side] @ q, known.stress[j - k, side] @ p
            total += (under_p * weight[:, None]).T @ under_q
    return total


def _lengths(known: Influence, side: Side) -> Array:
    """Arc length that each point of a fillet stands for, by Gauss's weights, shape (points,) [modules]."""
    places, weights = np.polynomial.legendre.leggauss(known.flank.order)
    arc = known.fillets[side].arc.reshape(-1, places.size)
    half = (arc[:, -1] - arc[:, 0]) / (places[-1] - places[0])
    return np.asarray((half[:, None] * weights).ravel())
