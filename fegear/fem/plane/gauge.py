"""A strain gauge glued into a root fillet: where its grid lies, and the mean strain under it per unit line load.

A grid averages the strain of the surface that it covers. Along the fillet that is the integral over the smoothed curve
through the stress at its points (`smooth_curve`), which is linear in the stress: a gauge is one row of weights, and
the strain under any loads a product with it. The surface is free, so a strain gauge sees the tangential stress alone:
in plane strain eps = (1 - nu^2) sigma / E along the profile and nothing along the face, in plane stress sigma / E and
-nu sigma / E.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import InputError
from fegear.fem.plane.root_stress import smooth_curve

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Influence, Side
    from fegear.fem.plane.root_stress import FilletStrain
    from fegear.geometry.gear import Gear, Material, Plane
    from fegear.geometry.involute_tooth import InvoluteTooth

#: How the middle of a grid may be given, and the quantity of a fillet that has it.
PlaceKey = Literal["tangent_angle", "centre_angle", "arc", "diameter", "height"]
#: Gauss points of each piece of a fillet's curve: a cubic under a weight that is linear needs three.
_POINTS = 3
#: Points by which the fillet of a generated tooth is drawn.
_DRAWN = 2001
#: Angle of the tangent with the tooth's centre line at the critical section of ISO 6336-3 [rad].
ISO_TANGENT = math.radians(30.0)
ISO_TANGENT_INTERNAL = math.radians(60.0)
#: How far beyond an end of the fillet a place still counts as that end [modules]: round-off of lengths in millimetres.
_SLACK = 1e-6
#: Part of the fillet below which a grid is none.
_SHORT = 0.02
#: Both orders have the edges' own curves in common. They scatter the stress at the points of a fillet about its smooth
#: curve; so many times what that scatter is under a grid, the points' each by itself, is the least error of its mean.
_SCATTERED = 3.5
#: Beside an end of the fillet, nearer than these parts of its length, the smooth curve is fitted from one side: there a
#: grid errs by no less than the largest stress does (fading in between).
_AT_END, _OFF_END = 0.1, 0.2


@dataclass(frozen=True)
class Grid:
    """Measuring grid of a gauge.

    Parameters
    ----------
    length, width : float
        Along and across its direction [m]; both zero for a point.
    direction : float
        Angle between the direction of measurement and the profile [rad].
    """

    length: float
    width: float
    direction: float

    @property
    def along(self) -> tuple[float, float]:
        """Lengths of both sides of the grid as seen along the profile [m]."""
        return self.length * abs(math.cos(self.direction)), self.width * abs(math.sin(self.direction))

    @property
    def half(self) -> float:
        """How far the grid reaches along the profile to either side of its middle [m]."""
        return 0.5 * sum(self.along)

    @property
    def half_across(self) -> float:
        """How far it reaches across the profile to either side [m]."""
        return 0.5 * (self.length * abs(math.sin(self.direction)) + self.width * abs(math.cos(self.direction)))

    def strain_per_stress(self, material: Material, plane: Plane) -> float:
        """Strain in its direction per tangential stress of a free surface [1/Pa]."""
        along, across = math.cos(self.direction) ** 2, math.sin(self.direction) ** 2
        contraction = material.poisson_ratio * across if plane == "stress" else 0.0
        return along / material.plane_modulus(plane) - contraction / material.young_modulus


@dataclass(frozen=True)
class FilletProfile:
    """The line along which gauges are placed, from the root land up to the flank.

    Parameters
    ----------
    arc, radius, centre_angle, tangent_angle : ndarray, shape (points,)
        Arc length from the root land [m], distance from the axis [m], angle from the tooth's centre line [rad], angle
        between tangent and centre line [rad].
    root_radius : float
        [m].
    """

    arc: Array
    radius: Array
    centre_angle: Array
    tangent_angle: Array
    root_radius: float

    @classmethod
    def of_tooth(cls, tooth: InvoluteTooth, module: float) -> FilletProfile:
        """Of a generated tooth."""
        curve = tooth.fillet
        t = np.linspace(curve.start, curve.end, _DRAWN)
        x, y = curve.points(t)
        slope = np.gradient(np.stack([x, y]), t, axis=1, edge_order=2) * np.sign(curve.end - curve.start)
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        lean = np.arctan2(np.abs(slope[0]), tooth.side * slope[1])
        return cls(
            arc * module, np.hypot(x, y) * module, np.abs(np.arctan2(x, y)), lean, tooth.root_radius * module
        )  # fmt: skip

    @classmethod
    def of_mesh(cls, fillet: FilletStrain, gear: Gear) -> FilletProfile:
        """Of a fillet as it is meshed; its ends are half an edge's points away and go on straight."""
        return cls.through(fillet.arc, fillet.length, fillet.radius, fillet.angle, fillet.tangent_angle, gear)

    @classmethod
    def through(
        cls, arc: Array, length: float, radius: Array, angle: Array, tangent_angle: Array, gear: Gear
    ) -> FilletProfile:
        """Through points of a fillet, shape (points,) each: lengths in modules, angles from the tooth's centre line."""
        module = gear.module

        def to_ends(values: Array) -> Array:
            first, last = (
                values[at] + (end - arc[at]) * (values[at] - values[by]) / (arc[at] - arc[by])
                for at, by, end in ((0, 1, 0.0), (-1, -2, length))
            )
            return np.concatenate([[first], values, [last]])

        return cls(
            np.concatenate([[0.0], arc, [length]]) * module, to_ends(radius) * module, np.abs(to_ends(angle)),
            to_ends(tangent_angle), gear.root_radius,
        )  # fmt: skip

    @property
    def height(self) -> Array:
        """Radial distance from the root circle [m]."""
        return np.abs(self.radius - self.root_radius)

    @property
    def diameter(self) -> Array:
        """[m]."""
        return 2.0 * self.radius

    def place(self, key: PlaceKey, value: float, grid: Grid) -> float:
        """Arc length of the middle of a grid [m], all of which lies on the fillet: `middle` and `check`.

        Raises
        ------
        InputError
        """
        middle = self.middle(key, value)
        self.check(middle, grid)
        return middle

    def middle(self, key: PlaceKey, value: float) -> float:
        """Arc length of a place [m]; of several that of the one nearest to the root land.

        Raises
        ------
        InputError
            If the fillet has no such place.
        """
        along = np.asarray(getattr(self, key))
        over = (along - value) * (1.0 if along[0] <= along[-1] else -1.0)
        crossed = np.flatnonzero((over[:-1] <= 0.0) & (over[1:] >= 0.0))
        low, high = float(along.min()), float(along.max())
        if not crossed.size:
            slack = 1e-9 + _SLACK * (high - low)
            if not low - slack <= value <= high + slack:
                raise InputError(
                    key, _written(key, value),
                    f"is outside the fillet, {_written(key, low)} to {_written(key, high)}", "choose a place within",
                )  # fmt: skip
            return float(self.arc[int(np.argmin(np.abs(along - value)))])
        i = int(crossed[0])
        rise = over[i + 1] - over[i]
        share = -over[i] / rise if rise else 0.0
        return float(self.arc[i] + share * (self.arc[i + 1] - self.arc[i]))

    def check(self, middle: float, grid: Grid, half: float | None = None) -> None:
        """Refuse a grid that reaches beyond the fillet, by `half` of a length to either side where that is known [m].

        Raises
        ------
        InputError
        """
        length, half = float(self.arc[-1]), grid.half if half is None else half
        slack = _SLACK * length
        if middle - half < -slack or middle + half > length + slack:
            longest = 2.0 * min(middle, length - middle)
            shorter = f"reduce it below {longest * 1e3:.2g} mm or " if longest > _SHORT * length else ""
            raise InputError(
                "grid_length", f"{grid.length * 1e3:.6g} mm",
                f"reaches beyond the fillet, from {(middle - half) * 1e3:.3g} to {(middle + half) * 1e3:.3g} mm of "
                f"its arc of {length * 1e3:.3g} mm",
                f"{shorter}move the gauge, for example to arc = \"{0.5e3 * length:.2g} mm\"",
            )  # fmt: skip

    def at(self, arc: float) -> dict[str, float]:
        """Radius [m], angle from the centre line and angle of the tangent [rad] at an arc length [m]."""
        return {
            key: float(np.interp(arc, self.arc, getattr(self, key)))
            for key in ("radius", "centre_angle", "tangent_angle")
        }


def _written(key: PlaceKey, value: float) -> str:
    # rounded first: the root circle is at 7e-15 mm
    return f"{math.degrees(value):.4g} deg" if key.endswith("angle") else f"{round(value * 1e3, 9) + 0.0:.5g} mm"


def grid_weights(points: Array, middle: ArrayLike, along: tuple[float, float]) -> Array:
    """Mean over grids of the smooth curve through values at a fillet's points, as weights of the values.

    Parameters
    ----------
    points : ndarray, shape (points,)
        Arc lengths, ascending.
    middle : array_like, shape (G,)
        Arc lengths of the middles of the grids, in the same unit.
    along : (float, float)
        Sides of the grid as seen along the fillet: a grid that lies askew covers its ends less than its middle. Where
        one is zero the weight is even, where both are it is that of a point.

    Returns
    -------
    ndarray, shape (G, points)
        The integral is exact: three Gauss points in each piece of the curve and of the weight.
    """
    height, rise = smooth_curve(points)
    short, long = sorted(along)
    top, half = 0.5 * (long - short), 0.5 * (long + short)
    node, weight = np.polynomial.legendre.leggauss(_POINTS)
    made = []
    for centre in np.atleast_1d(np.asarray(middle, dtype=float)):
        if half == 0.0:
            places, shares = np.array([centre]), np.ones(1)
        else:
            low, high = centre - half, centre + half
            cuts = [centre - top, centre + top, *points[(points > low) & (points < high)]]
            ends = np.unique(np.clip([low, *cuts, high], low, high))
            middles, halves = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
            places = (middles[:, None] + halves[:, None] * node).ravel()
            steep = np.clip((half - np.abs(places - centre)) / short, 0.0, 1.0) if short > 0.0 else 1.0
            shares = (halves[:, None] * weight).ravel() * steep / long
        made.append(_curve_at(points, places, shares, height, rise))
    return np.array(made)


def _curve_at(points: Array, places: Array, shares: Array, height: Array, rise: Array) -> Array:
    """Weights of the values at points in a sum of the curve's heights at places, each with its share."""
    piece = np.clip(np.searchsorted(points, places) - 1, 0, points.size - 2)
    step = points[piece + 1] - points[piece]
    t = (places - points[piece]) / step
    of_height, of_rise = np.zeros(points.size), np.zeros(points.size)
    np.add.at(of_height, piece, shares * (1.0 + t * t * (2.0 * t - 3.0)))
    np.add.at(of_height, piece + 1, shares * (t * t * (3.0 - 2.0 * t)))
    np.add.at(of_rise, piece, shares * step * (t * (1.0 - t) ** 2))
    np.add.at(of_rise, piece + 1, shares * step * (t * t * (t - 1.0)))
    return np.asarray(height.T @ of_height + rise.T @ of_rise)


@dataclass(frozen=True)
class GaugesOnFillet:
    """Gauges of one grid at several places of a solved gear's fillet, G of them.

    Parameters
    ----------
    influence : GearInfluence
    side : {"tension", "compression"}
    grid : Grid
    arc : ndarray, shape (G,)
        Middles of the grids [m].
    """

    influence: GearInfluence
    side: Side
    grid: Grid
    arc: Array

    def only(self, number: int) -> GaugesOnFillet:
        """One of them."""
        return replace(self, arc=self.arc[number : number + 1])

    def weights(self, solution: Influence | None = None) -> Array:
        """Of the stress at the points of the fillet of a solution, the finer one by default, shape (G, points)."""
        module = self.influence.gear.module
        fillet = (solution or self.influence.fine).fillets[self.side]
        along = self.grid.along[0] / module, self.grid.along[1] / module
        return grid_weights(fillet.arc, self.arc / module, along)

    def stress(self, k: int, radius: ArrayLike) -> Array:
        """Mean stress along the profile on tooth k per unit line load on tooth 0 at radii [m], shape (G, P) [1/m]."""
        return np.asarray(self.weights() @ self.influence.fillet_stress(k, self.side, radius))

    def stress_error(self, k: int, radius: ArrayLike) -> Array:
        """Estimated error of `stress`; NaN if unknown.

        A share of what elements one order lower give otherwise, and no less than what both orders have in common.
        """
        r, known = np.atleast_1d(np.asarray(radius, dtype=float)), self.influence
        if known.estimate is None:
            return np.full((self.arc.size, r.size), np.nan)
        coarse, m = known.estimate.coarse, known.gear.module
        clipped = np.clip(r, known.lowest_radius, known.highest_radius)
        other = self.weights(coarse) @ coarse.fillet_stress(k, self.side, clipped / m) / m
        by_order = known.estimate.place_error(self.stress(k, clipped), np.asarray(other))
        in_common = np.maximum(
            self._scattered(k, clipped), self._beside_end[:, None] * known.root_stress_error(k, self.side, clipped)
        )
        return np.maximum(by_order, in_common)

    def _scattered(self, k: int, radius: Array) -> Array:
        """What the scatter of the stress at the fillet's points makes of its mean under the grids, shape (G, P)."""
        stress = self.influence.fillet_stress(k, self.side, radius)
        off = stress - smooth_curve(self.influence.fine.fillets[self.side].arc)[0] @ stress
        return np.asarray(_SCATTERED * np.sqrt(self.weights() ** 2 @ off**2))

    @property
    def _beside_end(self) -> Array:
        """How much the fillet's ends count: one at them, nothing in the middle, shape (G,)."""
        length = self.influence.fine.fillets[self.side].length * self.influence.gear.module
        off = np.minimum(self.arc, length - self.arc) / length
        return np.interp(off, [_AT_END, _OFF_END], [1.0, 0.0])

    @property
    def strain_per_stress(self) -> float:
        """In the direction of the grid [1/Pa]."""
        return self.grid.strain_per_stress(self.influence.gear.material, self.influence.fine.plane)
