"""The outline of a tooth whose flanks carry a relief: what is ground, not only what is generated.

The flank runs inside the involute by the removal along its normal, on to where it meets the tip. A rounding or chamfer
of the tip keeps its shape and moves with the flank. Where the involute starts, root relief ends in a step onto the
fillet, as a grinding wheel leaves it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.errors import InputError
from fegear.geometry.curves import Arc, Line

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry.curves import Involute
    from fegear.geometry.gear import Gear
    from fegear.geometry.relief import Relief


class Drawn(Protocol):
    """A smooth piece of an outline, enough of `Curve` to draw it."""

    @property
    def start(self) -> float:
        """Parameter at the end nearer the tooth space."""

    @property
    def end(self) -> float:
        """Parameter at the end nearer the tooth's centre line."""

    def points(self, parameter: ArrayLike) -> Array:
        """Points [modules], shape (2, N)."""


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
    if left < 0.0:
        raise InputError("relief", f"{float(relief.removal(end)) * 1e6:.6g} um at the tip", "leaves no tip")
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
        raise InputError("relief", f"{float(flank.relief.removal(t0)) * 1e6:.6g} um", "takes the tooth away")
    return t1


def _turned_edge(edge: Arc | Line, angle: float) -> Arc | Line:
    """A tip rounding or chamfer turned about the gear's centre toward the tooth's centre line."""
    c, s = math.cos(angle), math.sin(angle)

    def turn(point: tuple[float, float]) -> tuple[float, float]:
        return c * point[0] - s * point[1], s * point[0] + c * point[1]

    if isinstance(edge, Line):
        return Line(turn(edge.a), turn(edge.b))
    return Arc(turn(edge.centre), edge.radius, edge.start - angle, edge.end - angle)
