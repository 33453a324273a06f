"""The outline of a tooth and of a gear as points, to a chord tolerance, from the exact curves.

The outline of a tooth whose flanks carry a relief: what is ground, not only what is generated.

The flank runs inside the involute by the removal along its normal, on to where it meets the tip. A rounding or chamfer
of the tip keeps its shape and moves with the flank. Where the involute starts, root relief ends in a step onto the
fillet, as a grinding wheel leaves it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.geometry.curves import Arc, Drawn, Involute, Line
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.relief import Relief

if TYPE_CHECKING:
    from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalSide
    from fegear.geometry.asymmetric_rack import RackHalf
    from fegear.geometry.asymmetric_tooth import AsymmetricSide
    from fegear.geometry.rack import BasicRack

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


def tooth_outline(
    tooth: InvoluteSide, tolerance: float = 1e-4, pieces: Sequence[Drawn] | None = None,
    back: Sequence[Drawn] | None = None,
) -> Array:  # fmt: skip
    """One tooth from the middle of its left space over the tip to the middle of its right space [modules], (2, N).

    Parameters
    ----------
    tooth : InvoluteSide
        Seen from its right flank.
    tolerance : float
        How far chords may lie off the curves [modules].
    pieces : sequence of Drawn, optional
        Another right half than the generated one, see `relieved_outline`; of equal flanks another left half, too.
    back : sequence of Drawn, optional
        Of asymmetric teeth another left half, as seen from its own flank.
    """
    right = _half(pieces or list(tooth.outline.values()), tolerance)
    if tooth.back is tooth:
        right[0, -1] = 0.0  # the tooth's centre line, free of round-off
        left = right * np.array([[-1.0], [1.0]])
    else:
        left = _half(back or list(tooth.back.outline.values()), tolerance) * np.array([[-1.0], [1.0]])
    return np.hstack([left, right[:, -2::-1]])


def _half(pieces: Sequence[Drawn], tolerance: float) -> Array:
    lines = [along(curve, tolerance) for curve in pieces]
    return np.hstack([lines[0], *[line[:, 1:] for line in lines[1:]]])


def gear_outline(
    gear: Gear, tolerance: float = 1e-4, pieces: Sequence[Drawn] | None = None, back: Sequence[Drawn] | None = None
) -> Array:
    """The closed outline of all teeth [m], clockwise from tooth 0's left space; the first point is not repeated.

    Parameters as for `tooth_outline`.
    """
    one = tooth_outline(gear.tooth, tolerance, pieces, back)[:, :-1] * gear.module
    pitch = 2.0 * math.pi / gear.teeth
    return np.hstack([turned(one, k * pitch) for k in range(gear.teeth)])


def _rack_half(rack: BasicRack | RackHalf, addendum: float, shift: float, beside: float, cos_helix: float) -> Array:
    """One half of the tool's tooth from its foot to its tip, from where the middle of its tip is [modules]."""
    alpha, rho = rack.pressure_angle, rack.tip_radius
    top = np.array([[math.pi / 4 + addendum * math.tan(alpha)], [shift + addendum]])
    beta = np.linspace(math.pi / 2 - alpha, 0.0, 25)
    centre = rack.tip_centre_offset, shift - rack.tip_centre_depth
    rounding = np.stack([centre[0] + rho * np.sin(beta), centre[1] - rho * np.cos(beta)])
    half = np.hstack([top, rounding])
    half[0] = half[0] / cos_helix - beside
    return half


def rack_tooth(tooth: Tooth | AsymmetricSide) -> Array:
    """Outline of the tool's tooth across the gear's axis [modules], (2, N): along the rack, above the pitch line.

    From right to left; its left flank makes the one that the tooth is seen from.
    """
    lean = math.cos(tooth.helix_angle)
    if isinstance(tooth, Tooth):
        right = _rack_half(tooth.rack, tooth.rack.addendum, tooth.generating_shift, 0.0, lean)
        left = right
    else:
        right, left = (
            _rack_half(side.rack, side.tooth.rack.addendum, side.tooth.generating_shift, side.beside, lean)
            for side in (tooth.back, tooth)
        )
    return np.hstack([right, left[:, ::-1] * np.array([[-1.0], [1.0]])])


def rack_in_gear(tooth: Tooth | AsymmetricSide, rolled: float) -> Array:
    """The tool in the gear's frame after the gear has rolled by an angle [rad], in the space right of the tooth."""
    u, v = rack_tooth(tooth)
    placed = np.stack([u + tooth.pitch_radius * rolled, v + tooth.pitch_radius])
    return turned(placed, math.pi / tooth.teeth - rolled)


def _cutter_in_gear(tooth: InternalTooth | AsymmetricInternalSide, rolled: float) -> Array:
    """The pinion-type cutter's tooth in the frame of an internal gear that has turned by an angle [rad], likewise."""
    made = tooth if isinstance(tooth, InternalTooth) else tooth.tooth
    placed = turned(tooth.cutter_tooth(), rolled * tooth.teeth / made.cutter.teeth)
    placed[1] += made.generating_distance
    return turned(placed, math.pi / tooth.teeth - rolled)


def tool_in_gear(tooth: InvoluteSide, rolled: float) -> Array:
    """The tool, rack or pinion-type cutter, in the frame of a gear that has turned by an angle [rad], (2, N)."""
    from fegear.geometry.asymmetric_fillets import AsymmetricFilletSide
    from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalSide
    from fegear.geometry.asymmetric_tooth import AsymmetricSide
    from fegear.geometry.custom_fillet_tooth import CustomFilletTooth

    if isinstance(tooth, (InternalTooth, AsymmetricInternalSide)):
        return _cutter_in_gear(tooth, rolled)
    if isinstance(tooth, (Tooth, AsymmetricSide)):
        return rack_in_gear(tooth, rolled)
    if isinstance(tooth, AsymmetricFilletSide):
        return turned(tool_in_gear(tooth.as_generated, rolled), tooth.turn)
    if isinstance(tooth, CustomFilletTooth):
        return tool_in_gear(tooth.generated, rolled)
    raise TypeError(f"no tool available for a {type(tooth).__name__}")


def tool_in_space(tooth: InvoluteSide, count: int) -> Array:
    """Positions of the tool as it rolls through the space right of the tooth, shape (count, 2, N) [modules].

    Parameters
    ----------
    tooth : InvoluteSide
    count : int
        Even steps of the roll, from before the first touch to after the last.
    """
    reach = 1.6 * math.pi / tooth.teeth + 0.6 / math.sqrt(tooth.teeth)
    return np.stack([tool_in_gear(tooth, rolled) for rolled in np.linspace(-reach, reach, count).tolist()])


@dataclass(frozen=True, slots=True)
class RelievedFlank:
    """A piece of a right flank without a kink, parameter roll angle [rad].

    Parameters
    ----------
    involute : Involute
    relief : Relief
    module : float
        [m].
    start, end : float
        Roll angles [rad].
    """

    involute: Involute
    relief: Relief
    module: float
    start: float
    end: float

    def points(self, parameter: ArrayLike) -> Array:
        """The involute less the removal along its normal."""
        t = np.asarray(parameter, dtype=float)
        return np.asarray(self.involute.points(t) - self.involute.normals(t) * self.relief.removal(t) / self.module)


def relieved_outline(gear: Gear, relief: Relief) -> list[Drawn]:
    """The right half of the outline from the middle of the tooth space to the tooth's centre line.

    Parameters
    ----------
    gear : Gear
    relief : Relief

    Raises
    ------
    InputError
        If the relief takes away the tip, or the flank with it.
    """
    tooth = gear.tooth
    involute = tooth.involute
    before: list[Drawn] = [p for p in (tooth.root_land, tooth.fillet) if p is not None]
    whole = RelievedFlank(involute, relief, gear.module, involute.start, involute.end)
    end = _roll_at_radius(whole, float(np.hypot(*involute.points(involute.end))))
    inner = [t for t in sorted(relief.kinks) if involute.start + 1e-9 < t < end - 1e-9]
    marks = [involute.start, *inner, end]
    flank: list[Drawn] = [replace(whole, start=a, end=b) for a, b in pairwise(marks)]
    foot, ground = involute.points(involute.start), whole.points(involute.start)
    if math.dist(foot, ground) > 1e-9:
        flank.insert(0, Line((float(foot[0]), float(foot[1])), (float(ground[0]), float(ground[1]))))
    (x, y), (x0, y0) = whole.points(end), involute.points(involute.end)
    angle = math.atan2(x0, y0) - math.atan2(x, y)
    after: list[Drawn] = [] if tooth.tip_edge is None else [_turned_edge(tooth.tip_edge, angle)]
    left = tooth.tip_land.start - angle
    if left < tooth.tip_middle:
        raise InputError("relief", f"{float(relief.removal(end)) * 1e6:.6g} um at the tip", "removes the entire tip")
    after.append(replace(tooth.tip_land, start=left))
    return [*before, *flank, *after]


def _roll_at_radius(flank: RelievedFlank, radius: float) -> float:
    """Roll angle at which the relieved flank reaches a radius [modules], by the secant rule from the involute's."""
    t0 = flank.involute.end
    t1 = t0 + float(flank.relief.removal(t0)) / flank.module / flank.involute.base_radius
    off = [float(np.hypot(*flank.points(t))) - radius for t in (t0, t1)]
    for _ in range(60):
        if abs(off[1]) < 1e-13 * radius or off[0] == off[1]:
            break
        t0, t1 = t1, t1 - off[1] * (t1 - t0) / (off[1] - off[0])
        off = [off[1], float(np.hypot(*flank.points(t1))) - radius]
    if not (math.isfinite(t1) and abs(off[1]) < 1e-9 * radius and t1 > flank.involute.start):
        raise InputError("relief", f"{float(flank.relief.removal(t0)) * 1e6:.6g} um", "removes the entire tooth")
    return t1


def _turned_edge(edge: Arc | Line, angle: float) -> Arc | Line:
    """A tip rounding or chamfer turned about the gear's centre toward the tooth's centre line."""
    c, s = math.cos(angle), math.sin(angle)

    def turn(point: tuple[float, float]) -> tuple[float, float]:
        return c * point[0] - s * point[1], s * point[0] + c * point[1]

    if isinstance(edge, Line):
        return Line(turn(edge.a), turn(edge.b))
    return Arc(turn(edge.centre), edge.radius, edge.start - angle, edge.end - angle)
