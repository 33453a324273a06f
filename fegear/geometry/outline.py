"""The outline of a tooth and of a gear as points, to a chord tolerance, from the exact curves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.arrays import Array
    from fegear.geometry import Gear, Tooth
    from fegear.geometry.relieved_outline import Drawn

_LARGEST_COUNT = 1 << 14


def along(curve: Drawn, tolerance: float) -> Array:
    """Points on a curve whose chords stay within `tolerance` [modules] of it, ends included, shape (2, N)."""
    count = 8
    while True:
        u = np.linspace(curve.start, curve.end, 2 * count + 1)
        p = curve.points(u)
        a, middle, b = p[:, :-1:2], p[:, 1::2], p[:, 2::2]
        chord = b - a
        length = np.maximum(np.hypot(*chord), 1e-300)
        off = np.abs(chord[0] * (middle[1] - a[1]) - chord[1] * (middle[0] - a[0])) / length
        if off.max() <= tolerance or count >= _LARGEST_COUNT:
            return p[:, ::2]
        count *= 2


def turned(points: Array, angle: float) -> Array:
    """Points turned clockwise about the gear's centre by `angle` [rad], shape (2, N)."""
    s, c = math.sin(angle), math.cos(angle)
    return np.stack([c * points[0] + s * points[1], c * points[1] - s * points[0]])


def tooth_outline(tooth: Tooth, tolerance: float = 1e-4, pieces: Sequence[Drawn] | None = None) -> Array:
    """One tooth from the middle of its left space over the tip to the middle of its right space [modules], (2, N).

    Parameters
    ----------
    tooth : Tooth
    tolerance : float
        How far chords may lie off the curves [modules].
    pieces : sequence of Drawn, optional
        Another right half than the generated one, see `relieved_outline`.
    """
    lines = [along(curve, tolerance) for curve in pieces or tooth.outline.values()]
    right = np.hstack([lines[0], *[line[:, 1:] for line in lines[1:]]])
    right[0, -1] = 0.0  # the tooth's centre line, free of round-off
    left = right * np.array([[-1.0], [1.0]])
    return np.hstack([left, right[:, -2::-1]])


def gear_outline(gear: Gear, tolerance: float = 1e-4, pieces: Sequence[Drawn] | None = None) -> Array:
    """The closed outline of all teeth [m], clockwise from tooth 0's left space; the first point is not repeated.

    Parameters as for `tooth_outline`.
    """
    one = tooth_outline(gear.tooth, tolerance, pieces)[:, :-1] * gear.module
    pitch = 2.0 * math.pi / gear.teeth
    return np.hstack([turned(one, k * pitch) for k in range(gear.teeth)])


def rack_tooth(tooth: Tooth) -> Array:
    """Outline of the tool's tooth across the gear's axis [modules], (2, N): along the rack, above the pitch line."""
    rack, shift = tooth.rack, tooth.generating_shift
    alpha, rho = rack.pressure_angle, rack.tip_radius
    top = np.array([[math.pi / 4 + rack.addendum * math.tan(alpha)], [shift + rack.addendum]])
    beta = np.linspace(math.pi / 2 - alpha, 0.0, 25)
    centre = rack.tip_centre_offset, shift - rack.tip_centre_depth
    rounding = np.stack([centre[0] + rho * np.sin(beta), centre[1] - rho * np.cos(beta)])
    right = np.hstack([top, rounding])
    right[0] /= math.cos(tooth.helix_angle)
    return np.hstack([right, right[:, ::-1] * np.array([[-1.0], [1.0]])])


def rack_in_gear(tooth: Tooth, rolled: float) -> Array:
    """The tool in the gear's frame after the gear has rolled by an angle [rad], in the space right of the tooth."""
    u, v = rack_tooth(tooth)
    placed = np.stack([u + tooth.pitch_radius * rolled, v + tooth.pitch_radius])
    return turned(placed, math.pi / tooth.teeth - rolled)


def tool_in_space(tooth: Tooth, count: int) -> Array:
    """Positions of the tool as it rolls through the space right of the tooth, shape (count, 2, N) [modules].

    Parameters
    ----------
    tooth : Tooth
    count : int
        Even steps of the roll, from before the first touch to after the last.
    """
    reach = 1.6 * math.pi / tooth.teeth + 0.6 / math.sqrt(tooth.teeth)
    return np.stack([rack_in_gear(tooth, rolled) for rolled in np.linspace(-reach, reach, count).tolist()])
