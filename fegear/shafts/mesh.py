"""Where two gears mesh between their shafts: how flanks push the shafts, and how far these move the flanks apart.

In the frame of a pair X points to where the driver pushes the driven gear at the pitch point, Y from the driver's axis
to the pitch point, Z to the end from which the driver turns clockwise (`GearPair`). A force W along the transverse
line of action u is W N, N = u + tan(beta_b) e_Z, and acts at the pitch point + x u + z e_Z. By the principle of virtual
work the gap that moved shafts open there is N . (motion of the driven gear - motion of the driver), taken at that point
of either gear. It is linear in x: with W and W x at a height as forces, the gap at x = 0 and its slope over x are the
displacements that go with them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.pair import MEMBERS
from fegear.shafts.carried import carry

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.geometry.pair import GearPair
    from fegear.shafts.gear_on_shaft import GearOnShaft

#: Heights at which forces of a mesh act on its shafts, evenly over the common face: an odd number, the middle is one.
_HEIGHTS = 17


@dataclass(frozen=True)
class MeshPlace:
    """A pair between two shafts.

    Parameters
    ----------
    pair : str
        Its name.
    shafts : tuple of str
        Of driver and driven.
    at : tuple of float
        Middle of the faces from the left ends [m].
    towards : ndarray, shape (2,)
        Unit vector from the driver's axis to the driven one's, across the axes.
    sense : int
        1 where the driver turns counter-clockwise seen from +z, else -1.
    found : GearPair
    load : float
        Along the transverse line of action [N].
    bodies : tuple of GearOnShaft or None
        Bodies of the gears that sit fast on their shafts; gears without move with the shaft's section at each height.
    """

    pair: str
    shafts: tuple[str, str]
    at: tuple[float, float]
    towards: Array
    sense: int
    found: GearPair
    load: float
    bodies: tuple[GearOnShaft | None, GearOnShaft | None] = (None, None)

    @property
    def axes(self) -> Array:
        """X, Y and Z of the pair as rows in the coordinates of the shafts, shape (3, 3)."""
        x, y = self.found.driven.tooth.side * self.towards  # a ring's axis and the pitch point lie on opposite sides
        return np.array([[-self.sense * y, self.sense * x, 0.0], [x, y, 0.0], [0.0, 0.0, -self.sense]])

    @property
    def line_of_action(self) -> Array:
        """u, shape (3,): away from an external driver, toward the axis of a hollow one."""
        angle, side = self.found.working_pressure_angle, self.found.driver.tooth.side
        return np.asarray(np.array([math.cos(angle), side * math.sin(angle), 0.0]) @ self.axes)

    @property
    def normal(self) -> Array:
        """N, shape (3,)."""
        driver = self.found.driver
        return np.asarray(self.line_of_action + driver.base_radius * driver.twist * self.axes[2])

    @property
    def force(self) -> Array:
        """On the driven gear, shape (3,) [N]."""
        return self.load * self.normal

    @cached_property
    def heights(self) -> Array:
        """Z from the middle of the common face at which forces act, ascending, shape (n,) [m]."""
        half = 0.5 * self.found.face_width
        return np.linspace(-half, half, _HEIGHTS)

    @property
    def even(self) -> Array:
        """Forces W and W x at the heights, spread evenly over the face at the pitch point, shape (2, n) [N, N m]."""
        share = np.full(self.heights.size, 1.0 / (self.heights.size - 1))
        share[[0, -1]] *= 0.5
        return self.load * np.stack([share, np.zeros_like(share)])

    def ways(self, lengths: tuple[float, float]) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]:
        """Where a mesh acts on its shafts, and what forces and moments unit forces W and W x are there.

        A face that ends beyond its shaft is carried by the shaft's end.

        Parameters
        ----------
        lengths : tuple of float
            Of both shafts [m].

        Returns
        -------
        of_driver, of_driven : tuple of ndarray
            Places from the left end, shape (p,) [m]; forces with moments about the axis there per unit force at each
            height, shape (p, 6, 2, n); how the gear moves at the heights with the places, shape (n, 6, p, 6).
        """
        u, normal, pair = self.line_of_action, self.normal, self.found
        found = []
        for member, body, side, to_pitch, at, length in zip(
            MEMBERS, self.bodies, (-1.0, 1.0), (1.0, -pair.side), self.at, lengths, strict=True
        ):
            radius = pair.gear(member).base_radius / math.cos(pair.working_pressure_angle)
            arm = to_pitch * radius * self.axes[1]
            own = at - self.sense * (self.heights + pair.face_height(member))
            unit = side * np.stack(
                [np.concatenate([normal, np.cross(arm, normal)]), np.concatenate([np.zeros(3), np.cross(u, normal)])],
                axis=1,
            )
            if body is None:
                place, each = np.clip(own, 0.0, length), np.eye(own.size)
                motion = np.einsum("kp,pba->kapb", each, carry(own - place))
            else:
                place = np.clip(body.places, 0.0, length)
                motion = body.carried(own, length)
            found.append((place, np.einsum("kapb,aw->pbwk", motion, unit), motion))
        return found[0], found[1]

    def tilt(self, moved: Array, driver: Array) -> Array:
        """Straight part of how two axes part over the face: in their plane and across it, as `ShaftTilt` counts.

        Parameters
        ----------
        moved, driver : ndarray, shape (..., n, 6)
            Displacements of the driven gear's axis and of the driver's at the heights [m, rad].

        Returns
        -------
        ndarray, shape (..., 2)
            [rad].
        """
        apart = (moved - driver)[..., :3] @ np.array([[*self.towards, 0.0], self.axes[0]]).T
        return straight_slope(self.heights, apart)


def straight_slope(at: Array, values: Array) -> Array:
    """Slope of the straight line of least squares through values (..., n, k), shape (..., k).

    Of what the values stand for all over the face: ends count half.
    """
    weight = np.ones(at.size)
    weight[[0, -1]] = 0.5
    off = at - weight @ at / weight.sum()
    return np.asarray(np.einsum("n,...nk->...k", weight * off, values) / (weight * off @ off))
