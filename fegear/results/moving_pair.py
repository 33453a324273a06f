"""A pair in motion: what a moving picture of it turns and points at, from the same outlines as its drawing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.frozen import ReadOnlyArrays
from fegear.geometry.path_of_contact import path_points
from fegear.results.drawn_pair import in_mesh

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.geometry import GearPair

#: Teeth on either side of the one that touches at the pitch point: enough for a turn over the whole path.
_TEETH = 6


@dataclass(frozen=True)
class MovingPair(ReadOnlyArrays):
    """Both gears with their flanks touching at the pitch point, which is the origin, and how they turn [m].

    Where a tooth pair touches at x on the line of action, the driver has turned clockwise and the driven gear the other
    way by x over their base radii; the contact stands at x (cos a, sin a), a the working pressure angle, and so does
    that of the pair k base pitches ahead at x + k p_b.

    Parameters
    ----------
    driver, driven : ndarray, shape (2, N)
        Outlines of their teeth near the mesh.
    driver_radius, driven_radius : float
        Of the working pitch circles: the driver's centre lies so far below the origin, that of the driven gear above.
    driver_base, driven_base : float
        Base radii.
    pressure_angle : float
        Working, in the section across the axes [rad].
    start, end, base_pitch : float
        Of the path of contact.
    points : tuple of (str, float)
        Points A to E of the path with their places.
    module : float
    twist : float
        Tangent of the base helix angle, positive for a right-handed driver: a contact line that crosses the middle of
        the face at x stands at x - z twist at z along it.
    """

    driver: Array
    driven: Array
    driver_radius: float
    driven_radius: float
    driver_base: float
    driven_base: float
    pressure_angle: float
    start: float
    end: float
    base_pitch: float
    points: tuple[tuple[str, float], ...]
    module: float
    twist: float


def moving_pair(pair: GearPair) -> MovingPair:
    """Make a pair ready to be turned.

    Parameters
    ----------
    pair : GearPair
    """
    base = pair.driver.base_radius, pair.driven.base_radius
    share = pair.centre_distance / (base[0] + base[1])
    return MovingPair(
        in_mesh(pair, "driver", _TEETH),
        in_mesh(pair, "driven", _TEETH),
        base[0] * share,
        base[1] * share,
        *base,
        pair.working_pressure_angle,
        pair.x_start,
        pair.x_end,
        pair.base_pitch,
        tuple((point.letter, point.x) for point in path_points(pair)),
        pair.driver.module,
        pair.driver.twist * pair.driver.base_radius,
    )
