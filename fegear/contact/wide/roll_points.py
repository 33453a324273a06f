"""Roll positions over a base pitch: a quadrature whose pieces end where contact lines begin and end.

Between those places everything that roll positions show is smooth. At them pairs come and go, and largest and smallest
transmission errors stand beside them, so both sides are looked at: Lobatto's points on each piece, its ends included.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.contact.fourier import Panels
from fegear.contact.wide.lines import base_twist, shortest_line
from fegear.geometry.pair import GearPair

#: Points on a piece, at least; pieces shorter than this share of a base pitch have none of their own.
_FEWEST, _SHORTEST = 3, 5e-3

#: Pieces whose points stand equally far apart to this share are alike.
_ALIKE = 1e-9

#: How far beside the end of a piece its outermost points stand, as a share of a base pitch.
_BESIDE = 1e-7


def line_breaks(pair: GearPair, beyond: tuple[float, float] = (0.0, 0.0)) -> Array:
    """Roll positions in one base pitch from x_start on at which contact lines begin, end, or reach a corner [m].

    Along tip edges lines go on `beyond` start and end of the path [m].
    """
    reach = abs(base_twist(pair)) * 0.5 * pair.face_width
    late = abs(base_twist(pair)) * shortest_line(pair)  # a line counts once it is as long as that
    start, end = pair.x_start - beyond[0], pair.x_end + beyond[1]
    places = [start - reach + late, pair.x_start + reach, pair.x_end - reach, end + reach - late]
    return np.unique(np.mod(np.array(places) - pair.x_start, pair.base_pitch)) + pair.x_start


def roll_points(pair: GearPair, count: int, beyond: tuple[float, float] = (0.0, 0.0), others: ArrayLike = ()) -> Panels:
    """Roll positions and what part of a base pitch each stands for.

    Parameters
    ----------
    pair : GearPair
    count : int
        Number of positions. With fewer than three to a piece they are the middles of equal parts of the base pitch.
    beyond : (float, float)
        How far lines go on along tip edges before the start and after the end of the path [m].
    others : array_like
        Places at which pieces end besides: where lines of another half of the gears begin and end [m].

    Returns
    -------
    Panels
    """
    pitch = pair.base_pitch
    breaks = line_breaks(pair, beyond)
    if np.size(others):
        breaks = np.unique([*breaks, *(np.mod(np.asarray(others) - pair.x_start, pitch) + pair.x_start)])
    ends = np.append(breaks, breaks[0] + pitch)
    pieces = [(a, b) for a, b in pairwise(ends.tolist()) if b - a > _SHORTEST * pitch]
    if count < _FEWEST * len(pieces):
        x = pair.x_start + pitch * (np.arange(count) + 0.5) / count
        return Panels(x, np.full(count, pitch / count), pitch, ends)
    places: list[Array] = []
    weight: list[Array] = []
    for (a, b), n in zip(pieces, _shared([b - a for a, b in pieces], count), strict=True):
        at, w = _lobatto(n)
        inside = 1.0 - 2.0 * _BESIDE * pitch / (b - a)
        places.append(0.5 * (a + b) + 0.5 * (b - a) * inside * at)
        weight.append(0.5 * (b - a) * w)
    for i, ((_, end), (start, _)) in enumerate(zip(pieces, [*pieces[1:], (pieces[0][0] + pitch, 0.0)], strict=True)):
        weight[i][-1] += 0.5 * (start - end)  # what lies between two pieces, by the trapezoidal rule
        weight[(i + 1) % len(pieces)][0] += 0.5 * (start - end)
    return Panels(np.concatenate(places), np.concatenate(weight), pitch, ends)


def _shared(lengths: list[float], count: int) -> list[int]:
    """Points on each piece, so that they stand equally dense.

    Pieces that are alike have as many, as long as any other can take what is left: no last digit chooses between them,
    and not which of both gears drives.
    """
    points = np.full(len(lengths), _FEWEST)
    while (left := count - int(points.sum())) > 0:
        apart = np.array(lengths) / (points - 1)
        alike = np.abs(apart[:, None] - apart) < _ALIKE * apart
        fits = np.where(alike.sum(axis=1) <= left, apart, 0.0)
        chosen = (
            alike[int(np.argmax(fits > (1.0 - _ALIKE) * fits.max()))] if fits.any() else np.arange(len(lengths)) == 0
        )
        points[chosen] += 1
    found: list[int] = points.tolist()
    return found


def _lobatto(count: int) -> tuple[Array, Array]:
    """Points and weights of Lobatto's rule on (-1, 1), both ends among them."""
    legendre = np.polynomial.legendre.Legendre.basis(count - 1)
    x = np.concatenate([[-1.0], np.sort(np.real(legendre.deriv().roots())), [1.0]])
    return x, 2.0 / (count * (count - 1) * legendre(x) ** 2)
