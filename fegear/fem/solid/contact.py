"""From the pressed bands that the mesh resolves to contacts as narrow as Hertz has them.

Bands along one contact line are loaded as wide as the section resolves, and polynomials along the face stand for
their profiles. What both leave out is local, so a half-space knows it: its answer to the narrow contacts with their
own profiles is added, its answer to the wide bands as the polynomials see them is taken off. What is left is the end
faces, which the half-space has only as mirrors, and the square of the pressed width.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.influence import curvature_slope
from fegear.fem.solid.bands import check_half_width, overlap, profile_moments, profiles_at
from fegear.fem.solid.end_slope import end_slope
from fegear.fem.solid.half_space import band_cosines, function_cosines, galerkin_compliance

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.solution import SolidSolution

#: Mean distance of two points of a semi-elliptic pressure over its half-width.
_MEAN = 256.0 / (45.0 * np.pi**2)
#: Cosines along the face: so many to the shortest reach of a band. Those of a hat fall with the square of their number.
_WAVES, _FEWEST_WAVES, _MOST_WAVES = 12.0, 64, 1500
#: The same for the functions along the face, to each of their degrees.
_WAVES_TO_A_DEGREE = 20
#: Points on each pressed width beside an end face.
_END_POINTS = np.polynomial.legendre.leggauss(16)
#: How far from an acute or square, and from an obtuse end face its own part reaches, in pressed half-widths: found from
#: hats of half a module, which weight it otherwise than even loads do.
_ACUTE_SPREAD, _OBTUSE_SPREAD = 1.5, 2.5


def line_compliance(solution: SolidSolution, line: Bands, half_width: ArrayLike) -> Array:
    """c_0 between the contacts of one contact line, shape (P, P) [1/(E module)].

    Parameters
    ----------
    solution : SolidSolution
    line : Bands
        Bands of one contact line, as wide as the section resolves (`SolidSolution.band_half_width`), with the line's
        own slope (`SolidSolution.line_slope`).
    half_width : array_like, shape (P,) or ()
        Of the contacts, across the contact line [modules]; narrow beside the bands' reach along the face.

    Returns
    -------
    ndarray, shape (P, P)
        Approach along the transverse line of action per unit transverse force, weighted with the contacts' own
        pressures. As in the plane it is that of Hertz's centre, which lies deeper than the mean.

    Raises
    ------
    RangeError
        If a contact has no width, is wider than the flank, or its band does not lie on flank and face.
    """
    b = np.broadcast_to(np.asarray(half_width, dtype=float), (line.count,))
    check_half_width(b, solution.flank)
    common = overlap(line)
    slope = (1.0 - solution.poisson_ratio**2) * solution.normal_length / np.pi
    found = solution.deflection(0, line, line)
    found += slope * (_narrow(solution, line) + (0.5 - np.log(b)[:, None] - np.log(b)) * common)
    bend = curvature_slope(solution.poisson_ratio, "strain") * _MEAN * solution.curvature(line.radius)
    change = bend * (line.half_width - b)
    found -= 0.5 * (change[:, None] + change) * common
    for a in np.unique(line.half_width).tolist():
        share = 0.5 * ((line.half_width == a)[:, None].astype(float) + (line.half_width == a))
        found -= slope * share * _as_the_functions_see_it(solution, line, a)
        if not solution.plane_strain:
            found += solution.normal_length * share * _at_the_faces(solution, line, a, float(np.exp(np.log(b).mean())))
    return np.asarray(found, dtype=float)


def _wave_numbers(solution: SolidSolution, line: Bands) -> Array:
    """Of the cosines along the contact line, which is longer than the face is wide, shape (n,) [1/module]."""
    shortest = float(np.maximum(line.before, line.after).min())
    count = int(np.clip(_WAVES * solution.width / shortest, _FEWEST_WAVES, _MOST_WAVES))
    return np.asarray(np.pi * np.arange(1, count + 1) / solution.width / solution.normal_length)


def _narrow(solution: SolidSolution, line: Bands) -> Array:
    """What a half-space makes of contacts of half-width 1 in the limit of narrow ones, but for its slope, (P, P)."""
    k = _wave_numbers(solution, line)
    waves = band_cosines(line, solution.width, k.size)[:, 1:]
    spectrum = 2.0 * (np.log(4.0 / k) - np.euler_gamma + 0.25)
    return np.asarray(2.0 / solution.width * (waves * spectrum) @ waves.T)


def _as_the_functions_see_it(solution: SolidSolution, line: Bands, a: float) -> Array:
    """The same for wide bands, as far as the functions along the face resolve them."""
    face, width = solution.face, solution.width
    count = max(_WAVES_TO_A_DEGREE * max(face.degrees), 4 * _FEWEST_WAVES)  # the same for every line: found once
    _, plain = function_cosines(face, count)
    moments = profile_moments(line, face) - plain[:, None] / width
    answer = galerkin_compliance(face, solution.normal_length, count, a)
    return np.asarray(moments.T @ answer @ moments - 2.0 / width * math.log(a))


def _at_the_faces(solution: SolidSolution, line: Bands, a: float, b: float) -> Array:
    """What end faces without traction add to their mirrors, by a logarithm beside them, (P, P)."""
    half = 0.5 * solution.width
    x, w = 0.5 + 0.5 * _END_POINTS[0], 0.5 * _END_POINTS[1]
    lean = math.copysign(math.acos(1.0 / solution.normal_length), solution.tau)
    total = np.zeros((line.count, line.count))
    for side, angle in ((-1.0, lean), (1.0, -lean)):
        spread = _ACUTE_SPREAD if angle >= 0.0 else _OBTUSE_SPREAD
        reach = min(spread * a, half)
        distance, weight = reach * x**3, 3.0 * reach * x**2 * w / spread
        depth = weight * np.log(reach / np.maximum(distance, min(spread * b, reach)))
        profile = profiles_at(line, side * (half - distance))
        total += end_slope(angle, solution.poisson_ratio) * (profile * depth) @ profile.T
    return np.asarray(total)
