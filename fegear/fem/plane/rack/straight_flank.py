"""Loads along the straight flank of a rack: places are heights above the reference line, the normal is one for all."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.fem.plane.root_stress import FilletCurve, contact_width
from fegear.fem.plane.trace import LoadedFlank, loaded_run

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.trace import BoundaryUnknowns
    from fegear.geometry.rack_tooth import RackTooth


@dataclass(frozen=True)
class StraightFlank(LoadedFlank):
    """The loaded run of a rack's tooth; what a gear's says of radii are heights here [modules].

    Parameters
    ----------
    heights : tuple of float
        Of the flank's ends.
    pressure_angle : float
        alpha [rad].
    """

    heights: tuple[float, float] = (0.0, 0.0)
    pressure_angle: float = 0.0

    @property
    def lowest_radius(self) -> float:
        """Height at which the flank starts [modules]."""
        return self.heights[0]

    @property
    def highest_radius(self) -> float:
        """Height at which the flank ends [modules]."""
        return self.heights[1]

    def arc_of_radius(self, radius: Array) -> Array:
        """Arc length along the run of flank points at heights [modules].

        Raises
        ------
        RangeError
            If a height lies off the flank.
        """
        y, (low, high) = np.asarray(radius, dtype=float), self.heights
        slack = 1e-7 * max(abs(low), abs(high), 1.0)
        if y.size and not (y.min() >= low - slack and y.max() <= high + slack):
            off = y[~((y >= low - slack) & (y <= high + slack))][0]
            raise RangeError("height", f"{off:.8g} modules", f"is outside the flank, {low:.8g} to {high:.8g}")
        return np.asarray(self.flank_start + np.clip(y - low, 0.0, high - low) / math.cos(self.pressure_angle))

    def radius_of_arc(self, arc: Array) -> Array:
        """Height of flank points, the reverse of `arc_of_radius` [modules]."""
        return np.asarray(self.heights[0] + (arc - self.flank_start) * math.cos(self.pressure_angle))

    def _normal_on_flank(self, edge: Index, along: Array) -> Array:  # noqa: ARG002  (one for all)
        """Into the material."""
        inward = np.array([-math.cos(self.pressure_angle), -math.sin(self.pressure_angle)])
        return np.asarray(np.multiply.outer(inward, np.ones(along.shape)))


def straight_flank(mesh: SectorMesh, elasticity: BoundaryUnknowns, tooth: RackTooth, margin: float) -> StraightFlank:
    """Collect the loaded run of a rack's tooth, and `margin` [modules] of the rounding beside it."""
    run = loaded_run(mesh, elasticity, tooth, margin)
    return StraightFlank(
        dofs=run.dofs,
        points=run.points,
        arc=run.arc,
        first_flank_edge=run.first_flank_edge,
        after_flank_edge=run.after_flank_edge,
        roll_squared=np.empty(0),
        base_radius=math.inf,
        order=elasticity.order,
        lower_corner=False,
        upper_corner=run.upper_corner,
        heights=(tooth.form_height, tooth.flank_end),
        pressure_angle=tooth.pressure_angle,
    )


@dataclass(frozen=True)
class StraightFilletCurve(FilletCurve):
    """As `FilletCurve`, below contacts on a straight flank, whose places are heights.

    Parameters
    ----------
    heights : tuple of float
        Of the flank's ends [modules].
    pressure_angle : float
        [rad].
    """

    heights: tuple[float, float] = field(default=(0.0, 0.0))
    pressure_angle: float = 0.0

    def _beside(self, radius: ArrayLike, half_width: float) -> tuple[Array, Array]:
        touched = np.asarray(radius, dtype=float) / self.module
        cos = math.cos(self.pressure_angle)
        above, room = (touched - self.heights[0]) / cos, (self.heights[1] - touched) / cos
        above = np.where(np.isinf(touched), np.inf, above)
        return above, contact_width(half_width, above, room)
