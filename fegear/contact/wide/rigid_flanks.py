"""Where rigid flanks touch: gaps of modified flanks on tilted shafts, each at the place up the flank where it is least.

`FlankGaps.at` looks where unmodified, aligned flanks touch. There the gap is off by R sigma^2 / 2, R the relative
radius of curvature and sigma the gap's slope up the flanks, for the flanks touch R sigma away. Here the driver's
helicoid is compared with the driven gear's, turned as its shaft is, and the least gap is looked for up the flank.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import ContactLines, base_twist
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.shaft_tilt import PARALLEL

#: How far up and down the flank is looked [modules], and how often that is cut by the golden section.
_REACH, _CUTS = 0.3, 22

_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

#: How far tip edges are followed past the ends of the path of contact [modules].
_PAST = 0.15

#: Stations on each contact line, and how often their neighbourhood is looked at again as finely.
_STATIONS, _ZOOMS = 65, 4


class _Places(NamedTuple):
    """Places in the plane of action: x and z [m], and the number of the tooth pair, all of one shape."""

    x: Array
    z: Array
    pair: NDArray[np.int64]


def touching_gaps(pair: GearPair, gaps: FlankGaps, lines: ContactLines) -> Array:
    """Least gap up the flanks at the heights of the stations, shape (P, M) [m]; infinite off the driven face.

    Exact for involute helicoids on tilted shafts; a modification sets a point of a flank back about its gear's axis, at
    the radius where it is. Unmodified, aligned flanks have none to round-off.

    Parameters
    ----------
    pair : GearPair
    gaps : FlankGaps
    lines : ContactLines
    """
    return _least(pair, gaps, _Places(lines.x, lines.z, lines.pair))


def beside_the_lines(pair: GearPair, gaps: FlankGaps, lines: ContactLines) -> float:
    """Largest difference of `FlankGaps.at` from the least gaps up the flanks, but for a shift of all [m].

    Of stations that lie on both flanks: at the end of a tilted face the mate may begin only beside the contact line.
    """
    on_path = lines.present if lines.edges is None else lines.present & (lines.edges.gap == 0.0)
    places = _Places(lines.x, lines.z, lines.pair)
    here = _helicoids(pair, gaps, places, np.clip(pair.roll_angle(lines.x, "driver"), *_limits(pair, "driver")))[0]
    found = np.where(on_path & np.isfinite(here), _least(pair, gaps, places), np.inf)
    on = np.isfinite(found)
    change = gaps.at(pair, lines)[on] - found[on]
    return float(np.abs(change - np.median(change)).max()) if change.size else 0.0


def _least(pair: GearPair, gaps: FlankGaps, at: _Places) -> Array:
    rb, form, tip = pair.driver.base_radius, *_limits(pair, "driver")
    middle = np.clip(pair.roll_angle(at.x, "driver"), form, tip)
    room = _REACH * pair.driver.module / np.maximum(np.abs(middle) * rb, _REACH * pair.driver.module)
    of_pair, up = gaps.of_pair(at.pair, at.z), pair.face_height("driven")
    if gaps.shafts.given:
        of_pair = of_pair + gaps.shafts.at(at.x, at.z)

    def gap(roll: Array) -> Array:
        apart, driven_roll = _helicoids(pair, gaps, at, roll)
        return np.asarray(apart + gaps.removed("driven", driven_roll, at.z + up) + of_pair)

    least = gap(middle)
    low, high = np.maximum(middle - room, form), np.minimum(middle + room, tip)
    least = np.minimum(least, np.minimum(gap(low), gap(high)))
    first, second = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_first, at_second = gap(first), gap(second)
    for _ in range(_CUTS):
        # Where both are off the driven flank, its tip is in the way: farther up the driver there is room.
        left = at_first < at_second
        least = np.minimum(least, np.where(left, at_first, at_second))
        low, high = np.where(left, low, first), np.where(left, second, high)
        new = np.where(left, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
        at_new = gap(new)
        first, second = np.where(left, new, second), np.where(left, first, new)
        at_first, at_second = np.where(left, at_new, at_second), np.where(left, at_first, at_new)
    return np.asarray(np.minimum(least, np.minimum(at_first, at_second)))


def _helicoids(pair: GearPair, gaps: FlankGaps, at: _Places, roll: Array) -> tuple[Array, Array]:
    """Gap [m] between driver and designed driven flank at a roll angle of the driver, and the driven roll angle there.

    Sections across the driver's axis in complex numbers: real along the pitch point's motion, imaginary toward the
    driven gear, from the pitch point; infinite where there is no flank. Radii are negative on an internal gear, as its
    roll angles are: then the driven gear's axis lies on the driver's side of the pitch point.
    """
    u = np.exp(1j * pair.working_pressure_angle)
    rb1, rb2 = (gear.tooth.side * gear.base_radius for gear in (pair.driver, pair.driven))
    rho1, rho2 = (pair.flank_curvature_radius(at.x, member) for member in ("driver", "driven"))
    pitch1, pitch2 = (rb / math.cos(pair.working_pressure_angle) for rb in (rb1, rb2))
    behind = gaps.removed("driver", roll, at.z + pair.face_height("driver")) / rb1
    rolled = roll * abs(rb1)
    point = -1j * pitch1 + np.exp(1j * ((rolled - rho1) / rb1 + behind)) * (1j * rb1 + rolled) * u
    place = np.stack([point.real, point.imag - pitch2, at.z], axis=-1)
    on = np.ones(at.z.shape, dtype=bool)
    if gaps.tilt != PARALLEL:
        from scipy.spatial.transform import Rotation

        # Into the frame of the driven gear, turned about the middle of the common face by (-in plane, out of plane).
        turn = Rotation.from_rotvec([pair.side * gaps.tilt.in_plane, -gaps.tilt.out_of_plane, 0.0]).as_matrix()
        place = place @ turn.T
        own = np.abs(place[..., 2] + pair.face_height("driven"))
        on &= own <= 0.5 * pair.driven.face_width * (1.0 + 1e-12)
    seen, height = place[..., 0] + 1j * place[..., 1], place[..., 2]
    radius = np.abs(seen)
    length = np.copysign(np.sqrt(np.maximum((radius - abs(rb2)) * (radius + abs(rb2)), 0.0)), rb2)
    turned = np.angle(seen / ((-1j * rb2 - length) * u)) - (length - rho2) / rb2
    apart = -rb2 * turned - base_twist(pair) * (height - at.z)
    apart -= (
        base_twist(pair) * pitch2 * pair.side * gaps.tilt.in_plane
    )  # of the whole gear along its axis: `ShaftTilt.gap` has it not
    form, tip = _limits(pair, "driven")
    driven_roll = length / abs(rb2)
    on &= (driven_roll <= tip) & (driven_roll >= form)
    return np.where(on, apart, np.inf), driven_roll


def _limits(pair: GearPair, member: Member) -> tuple[float, float]:
    """Roll angles of form and tip circle, with a hair of room."""
    gear = pair.gear(member)
    ends = [
        gear.tooth.side * math.sqrt(max((r / gear.base_radius) ** 2 - 1.0, 0.0))
        for r in (gear.form_radius, gear.involute_tip_radius)
    ]
    low, high = ends[0] - 1e-12, ends[1] + 1e-12
    return (low, min(high, 0.0)) if gear.tooth.internal else (max(low, 0.0), high)


def unloaded_error(pair: GearPair, gaps: FlankGaps, roll: ArrayLike) -> Array:
    """Transmission error of the flanks under no load [m]: the least gap of all tooth pairs, shape (P,).

    Found on whole contact lines, not at stations a panel apart, and on the tip edges past their ends: the limit of
    loaded flanks whose load goes to zero and whose panels go with it.

    Parameters
    ----------
    pair : GearPair
    gaps : FlankGaps
    roll : array_like, shape (P,)
        Roll positions [m].
    """
    start = np.atleast_1d(np.asarray(roll, dtype=float))[:, None]
    lean, past = base_twist(pair), _PAST * pair.driver.module
    # The face of a tilted mate ends a little before or after the common one of gears that are not.
    more = past if gaps.tilt != PARALLEL else 0.0
    up, own = pair.face_height("driver"), 0.5 * pair.driver.face_width
    bottom = max(-0.5 * pair.face_width - more, -own - up)
    top = min(0.5 * pair.face_width + more, own - up)
    half = max(-bottom, top)
    first, last = pair.x_start - past - abs(lean) * half, pair.x_end + past + abs(lean) * half
    number = np.arange(
        math.floor((first - start.max()) / pair.base_pitch), math.ceil((last - start.min()) / pair.base_pitch) + 1
    )
    middle = start + number * pair.base_pitch
    if lean:
        ends = np.sort([(middle - pair.x_end - past) / lean, (middle - pair.x_start + past) / lean], axis=0)
        low, high = np.maximum(ends[0], bottom), np.minimum(ends[1], top)
    else:
        inside = (middle >= pair.x_start - past) & (middle <= pair.x_end + past)
        low, high = np.where(inside, bottom, top), np.where(inside, top, bottom)
    position, j = np.nonzero(high > low)
    low, high = low[position, j][:, None], high[position, j][:, None]
    least = np.full(position.size, np.inf)
    share, row = np.linspace(0.0, 1.0, _STATIONS), np.arange(position.size)
    for _ in range(_ZOOMS + 1):
        z = low + (high - low) * share
        x = middle[position, j][:, None] - lean * z
        found = _least(pair, gaps, _Places(x, z, np.broadcast_to(number[j][:, None], z.shape)))
        i = found.argmin(axis=1)
        least = np.minimum(least, found[row, i])
        low, high = z[row, np.maximum(i - 1, 0)][:, None], z[row, np.minimum(i + 1, _STATIONS - 1)][:, None]
    of_all = np.full(start.size, np.inf)
    np.minimum.at(of_all, position, least)
    return of_all
