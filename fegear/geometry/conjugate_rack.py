"""The rack that generates a given fillet: the outline of its tip, point by point, and whether there is one.

A hob is a rack. Where a rack touches a tooth, the normal of both passes through the pitch point (law of gearing), so
that a point of the fillet is made as its normal meets the pitch circle there; the point of the rack is what lies at
that place then. Curves that are parallel to both touch in the same positions: a tool that is worn by some depth leaves
a fillet that is higher by the same depth.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array
from fegear.geometry.involute_side import InvoluteSide

#: Points of a fillet.
_POINTS = 193


@dataclass(frozen=True)
class ConjugateRack:
    """Tip of a rack's tooth from its middle to where the flank begins, in the section across the gear's axis [modules].

    Parameters
    ----------
    half_width : ndarray, shape (N,)
        Distance from the centre line of the rack's tooth.
    height : ndarray, shape (N,)
        Above the reference line, where the rack's tooth is half a pitch wide (profile shift and allowances are those of
        the gear).
    along : ndarray, shape (N - 1,)
        Length of the rack from point to point, negative where its outline turns back.
    turned : ndarray, shape (N - 1,)
        Angle by which its tangent turns there, positive where it is convex [rad].
    fillet : ndarray, shape (N - 1,)
        Length of the fillet between the same points.
    """

    half_width: Array
    height: Array
    along: Array
    turned: Array
    fillet: Array

    def room(self, smallest_radius: float) -> Array:
        """What is left, per length of the fillet, of an outline that nowhere turns back nor is sharper than a radius.

        Shape (N - 1,); negative: no rack of such a tip generates the fillet.
        """
        return (self.along - smallest_radius * np.maximum(self.turned, 0.0)) / self.fillet

    @cached_property
    def exists(self) -> bool:
        """Whether the outline nowhere turns back: only then can it be ground, and cuts the fillet and nothing else."""
        return bool(self.along.min() > 0.0)

    @property
    def smallest_radius(self) -> float:
        """Of curvature, where the outline is convex [modules]; infinite of none."""
        convex = self.turned > 0.0
        return float((self.along[convex] / self.turned[convex]).min(initial=np.inf))


def conjugate_rack(tooth: InvoluteSide, count: int = _POINTS) -> ConjugateRack:
    """Outline of the rack that generates the fillet of an external tooth.

    Parameters
    ----------
    tooth : InvoluteSide
        External; the outline is that of the half of the rack beside its flank.
    count : int
        Points, evenly over the fillet's parameter.

    Notes
    -----
    A fillet that reaches above the pitch circle is made there as its normal leaves the circle again; normals that miss
    it have no rack, and blank (NaN) points.
    """
    fillet, pitch = tooth.fillet, tooth.pitch_radius
    u = np.linspace(fillet.start, fillet.end, count)
    point, normal = fillet.points(u), fillet.normals(u)
    # The normal's way to the pitch circle, and where on it they meet, from the centre line of the tooth.
    out = (point * normal).sum(axis=0)
    with np.errstate(invalid="ignore"):
        way = -out + np.sqrt(out**2 - (point**2).sum(axis=0) + pitch**2)
    roll = np.arctan2(*(point + way * normal))
    c, s = np.cos(roll), np.sin(roll)
    x = c * point[0] - s * point[1] + pitch * roll
    y = s * point[0] + c * point[1] - pitch
    # Tangents of the rack toward its flank: right of the normals, which point out of the tooth that it cuts.
    angle = np.unwrap(np.arctan2(normal[1], normal[0]) + roll)
    middle = 0.5 * (angle[1:] + angle[:-1])
    along = np.diff(y) * np.cos(middle) - np.diff(x) * np.sin(middle)
    return ConjugateRack(
        pitch * np.pi / tooth.teeth - x, tooth.generating_shift - y, along, -np.diff(angle), np.hypot(*np.diff(point)),
    )  # fmt: skip
