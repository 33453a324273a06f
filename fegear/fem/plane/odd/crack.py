"""A crack in a tooth, as a line of straight pieces from its mouth on a fillet to its tip; lengths in modules.

All is said in the tooth's own frame: gear centre at the origin, tooth centre line along +y, loaded flank at x > 0. A
crack is named by where it starts and where it runs; how far it may go is what the tooth leaves of room.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.geometry.curves import arc_length
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.outline import tooth_outline

#: A crack ends at least so far before the next surface, as a share of its depth and in modules.
_ROOM_SHARE, _LEAST_ROOM = 0.02, 5e-3
#: The shortest crack [modules]: a shorter one lies within one edge of the coarsest fillet's.
SHORTEST = 5e-3


@dataclass(frozen=True)
class Crack:
    """A crack from a fillet into a tooth.

    Parameters
    ----------
    mouth : float
        Arc length of its mouth from the root land up the fillet [modules].
    corners : tuple of (float, float)
        Where it bends, and its tip last [modules], in the frame of its tooth.
    back : bool
        Whether it starts in the fillet of the flank that is not loaded.
    closing : bool
        Whether its faces may press on each other; open ones go through each other.
    """

    mouth: float
    corners: tuple[tuple[float, float], ...]
    back: bool = False
    closing: bool = False

    def path(self, tooth: InvoluteTooth) -> Array:
        """Mouth, bends and tip, shape (2, n) [modules]."""
        return np.column_stack([fillet_point(tooth, self.mouth, back=self.back), *map(np.array, self.corners)])

    def mirrored(self) -> Crack:
        """The same crack as a load on the other flank sees it; what one opens the other presses together."""
        return replace(self, corners=tuple((-x, y) for x, y in self.corners), back=not self.back, closing=True)

    def length(self, tooth: InvoluteTooth) -> float:
        """Along the crack [modules]."""
        return float(np.hypot(*np.diff(self.path(tooth))).sum())


def fillet_length(tooth: InvoluteTooth) -> float:
    """Length of a fillet from the root land to the flank [modules]."""
    return float(arc_length(tooth.fillet)[1][-1])


def fillet_point(tooth: InvoluteTooth, arc: float, *, back: bool = False) -> Array:
    """Point of a fillet at an arc length from the root land, shape (2,) [modules]."""
    parameter, length = arc_length(tooth.fillet)
    x, y = tooth.fillet.points(np.interp([arc], length, parameter))[:, 0]
    return np.array([-x if back else x, y])


def mouth_at_tangent(tooth: InvoluteTooth, angle: float) -> float:
    """Arc length up the fillet at which its tangent makes an angle with the tooth's centre line [rad].

    ISO 6336-3 looks at 30 degrees (60 degrees on an internal tooth).

    Raises
    ------
    InputError
        If no tangent of the fillet makes this angle.
    """
    parameter, length = arc_length(tooth.fillet)
    normal = tooth.fillet.normals(parameter)
    lean = np.arctan2(np.abs(normal[1]), np.abs(normal[0]))
    if not lean.min() - 1e-9 <= angle <= lean.max() + 1e-9:
        low, high = np.degrees([lean.min(), lean.max()])
        raise InputError(
            "tangent_angle", f"{math.degrees(angle):.6g} deg",
            f"must be an angle of the fillet's tangents, {low:.4g} to {high:.4g} deg",
        )  # fmt: skip
    order = np.argsort(lean)
    return float(np.interp(angle, lean[order], length[order]))


def mouth_at_radius(tooth: InvoluteTooth, radius: float) -> float:
    """Arc length up the fillet at which it has a radius from the gear's centre [modules].

    Raises
    ------
    InputError
        If the fillet has no such radius.
    """
    parameter, length = arc_length(tooth.fillet)
    radii = np.hypot(*tooth.fillet.points(parameter))
    if not radii.min() - 1e-9 <= radius <= radii.max() + 1e-9:
        raise InputError(
            "radius", f"{radius:.6g} modules",
            f"must be a radius of the fillet, {radii.min():.6g} to {radii.max():.6g} modules",
        )  # fmt: skip
    order = np.argsort(radii)
    return float(np.interp(radius, radii[order], length[order]))


def straight_crack(
    tooth: InvoluteTooth, mouth: float, angle: float, *, depth: float = 0.0, share: float = 0.0, back: bool = False
) -> Crack:
    """A crack of one straight piece.

    Parameters
    ----------
    tooth : InvoluteTooth
    mouth : float
        Arc length up the fillet [modules].
    angle : float
        Between the crack and the tooth's centre line [rad]: 0 runs straight into the body, a right angle across the
        tooth.
    depth, share : float
        Its length [modules], or that as a share of the way through to the next surface: one of the two.
    back : bool
        Whether it starts in the fillet of the flank that is not loaded.

    Raises
    ------
    InputError
        If the crack does not start into the material.
    """
    start, across = fillet_point(tooth, mouth, back=back), 1.0 if back else -1.0
    way = np.array([across * math.sin(angle), -tooth.side * math.cos(angle)])
    length = depth or share * way_through(tooth, start, way)
    return Crack(mouth, (tuple((start + length * way).tolist()),), back)


def way_through(tooth: InvoluteTooth, start: Array, way: Array) -> float:
    """How far it is through a tooth from a point on its fillet, along a unit vector [modules].

    To the surface on the other side, or, where the way runs below the root there, to abreast of the same point of the
    other fillet.

    Raises
    ------
    InputError
        If the way does not lead to the other side.
    """
    outline = tooth_outline(tooth)
    first, chord = outline[:, :-1], np.diff(outline)
    cross = way[0] * chord[1] - way[1] * chord[0]
    off = first - start[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (off[0] * chord[1] - off[1] * chord[0]) / cross
        at = (off[0] * way[1] - off[1] * way[0]) / cross
    met = along[(at >= 0.0) & (at <= 1.0) & (along > 1e-3)]
    if start[0] * way[0] > -1e-6 * abs(start[0]):
        raise InputError(
            "share", "", "requires a crack that runs to the other side of the tooth", "specify its depth instead"
        )
    return float(min([*met, -2.0 * start[0] / way[0]]))
