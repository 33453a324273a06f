"""From the pressed bands that the mesh resolves to contacts as narrow as Hertz has them.

Bands along one contact line are loaded as wide as the section resolves, and polynomials along the face stand for
their profiles. What both leave out is local, so a half-space knows it: its answer to the narrow contacts with their
own profiles is added, its answer to the wide bands as the polynomials see them is taken off. What is left is the end
faces, which the half-space has only as mirrors, and the square of the pressed width.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.alike_teeth import together
from fegear.fem.solid.bands import (
    Bands,
    band_cosines,
    check_half_width,
    end_slope,
    function_cosines,
    galerkin_compliance,
    loads_of,
    overlap,
    profile_moments,
    profiles_at,
    quick_band_spectrum,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.solid.flank_body import SolidFlank, TwistedFlank

#: Cosines along the face: so many to the shortest reach of a band. Those of a hat fall with the square of their number.
_WAVES, _FEWEST_WAVES, _MOST_WAVES = 12.0, 64, 1500
#: The same for the functions along the face, to each of their degrees.
_WAVES_TO_A_DEGREE = 20
#: Points on each pressed width beside an end face.
_END_POINTS = np.polynomial.legendre.leggauss(16)
#: How far from an end face its own part reaches, in pressed half-widths: that of a square end, and per Poisson's ratio;
#: what its lean adds or takes, and per radian, for it reaches less far from an acute end than from an obtuse one. Found
#: from end hats of half a module whose bands narrow from .2 to .1 module, 0 to 32 degrees: .1 % of such a hat are left.
_SQUARE_SPREAD, _LEAN_SPREAD = (0.6, 2.0), (1.85, -0.45)


class PressedLines:
    """Contact lines on one gear's flank, many at a time: what their stations do to each other.

    Parameters
    ----------
    solution : SolidFlank
    line : Bands
        Bands of all lines, one line after the other, as wide as the section resolves
        (`SolidSolution.band_half_width`), with their lines' own slope (`SolidSolution.line_slope`).
    spans : sequence of slice
        Where each line stands among them.
    teeth : sequence of int
        The tooth that each line is on, by its number.

    Attributes
    ----------
    common : list of ndarray, shape (P, P)
        Of each line the integrals of products of its bands' profiles [1/module].
    """

    def __init__(self, solution: SolidFlank, line: Bands, spans: Sequence[slice], teeth: Sequence[int]) -> None:
        self._solution, self._line, self._spans, self._teeth = solution, line, spans, teeth
        self.common = [overlap(line.part(span)) for span in spans]

    @cached_property
    def loads(self) -> list[Array]:
        """Loads of each line on its flank's ports, shape (n, P) each."""
        flanks = [self._solution.flank_of(tooth) for tooth in self._teeth]
        found: list[Array] = [np.zeros((0, 0))] * len(flanks)
        for lines in together(id(flank) for flank in flanks):
            chosen = [self._spans[line] for line in lines]
            columns = np.concatenate([np.arange(span.start, span.stop) for span in chosen])
            loads = loads_of(self._line.part(columns), flanks[int(lines[0])], self._solution.face)
            for line, own in zip(lines, _parted(loads, chosen), strict=True):
                found[line] = own
        return found

    def own(self) -> list[Array]:
        """c_0 of each line under contacts of half-width 1, less what `widened` gives, (P, P) each [1/(E module)]."""
        line, solution, slope = self._line, self._solution, self._solution.contact_slope
        seen, moments = self._as_the_functions_see_them()
        bend = solution.bend(line.radius) * line.half_width
        logs = np.log(line.half_width) / solution.width
        found, every = [], range(len(self._spans))
        answers = self._answered([(tooth, tooth) for tooth in self._teeth], every)
        for span, common, loads, answer in zip(self._spans, self.common, self.loads, answers, strict=True):
            taken = seen[span] @ moments[:, span] - 2.0 * logs[span, None]
            block = loads.T @ answer + solution.contact_slope * (_narrow(solution, line.part(span)) + 0.5 * common)
            block -= 0.5 * (slope * (taken + taken.T) + (bend[span, None] + bend[span]) * common)
            found.append(block)
        return found

    def widened(self, half_width: Array) -> list[Array]:
        """What the contacts' half-widths, shape (P,), change beside their logarithm, (P, P) for each line."""
        line, solution = self._line, self._solution
        found = widened_by_curvature(solution, line, self._spans, self.common, half_width)
        means = [float(np.exp(np.log(half_width[span]).mean())) for span in self._spans]
        found = [block + solution.contact_slope * _short_waves(solution, line.part(span), mean)
                 for span, block, mean in zip(self._spans, found, means, strict=True)]  # fmt: skip
        if solution.plane_strain:
            return found
        return [block + solution.normal_length * _at_the_faces(solution, line.part(span), mean)
                for span, block, mean in zip(self._spans, found, means, strict=True)]  # fmt: skip

    def between(self, i: int, j: int, pairs: Sequence[tuple[int, int]]) -> list[Array]:
        """c_ij between lines on teeth i and j, or on teeth like these: seen on the first, pressed on the second."""
        answers = self._answered([(i, j)] * len(pairs), [pressed for _, pressed in pairs])
        return [self.loads[seen].T @ answer for (seen, _), answer in zip(pairs, answers, strict=True)]

    def _answered(self, teeth: Sequence[tuple[int, int]], pressed: Sequence[int]) -> list[Array]:
        """Deflections of the ports of teeth i under lines on teeth j, solved for all lines of like teeth together."""
        matrices = [self._solution.coupling(i, j) for i, j in teeth]
        found: list[Array] = [np.zeros((0, 0))] * len(matrices)
        for group in together(id(matrix) for matrix in matrices):
            loads = [self.loads[pressed[n]] for n in group]
            ends = np.cumsum([one.shape[1] for one in loads])
            answers = np.split(matrices[int(group[0])] @ np.hstack(loads), ends[:-1], axis=1)
            for n, answer in zip(group, answers, strict=True):
                found[n] = answer
        return found

    def _as_the_functions_see_them(self) -> tuple[Array, Array]:
        """A half-space's answer to the wide bands as far as the functions resolve them, and the bands' moments.

        Shape (P, functions) and (functions, P); their product is what two bands do to each other, but for logarithms.
        """
        solution, line = self._solution, self._line
        face, width = solution.face, solution.width
        count = max(_WAVES_TO_A_DEGREE * max(face.degrees), 4 * _FEWEST_WAVES)  # the same for every line: found once
        _, plain = function_cosines(face, count)
        moments = profile_moments(line, face) - plain[:, None] / width
        seen = np.empty((line.count, face.count))
        for a in np.unique(line.half_width).tolist():
            here = line.half_width == a
            seen[here] = moments[:, here].T @ galerkin_compliance(face, solution.normal_length, count, a)
        return seen, moments


def _parted(columns: Array, spans: Sequence[slice]) -> list[Array]:
    """Columns of each span, which stand one after the other."""
    ends = np.cumsum([span.stop - span.start for span in spans])
    return np.split(columns, ends[:-1], axis=1)


def line_compliance(solution: SolidFlank, line: Bands, half_width: ArrayLike) -> Array:
    """c_0 between the contacts of one contact line, shape (P, P) [1/(E module)].

    Parameters
    ----------
    solution : SolidFlank
    line : Bands
        Bands of one contact line, as `PressedLines` takes them.
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
    lines = PressedLines(solution, line, (slice(0, line.count),), (0,))
    width = np.log(b)
    return lines.own()[0] + lines.widened(b)[0] - solution.contact_slope * (width[:, None] + width) * lines.common[0]


def widened_by_curvature(
    body: TwistedFlank, line: Bands, spans: Sequence[slice], common: Sequence[Array], half_width: Array
) -> list[Array]:
    """What half-widths of contacts, shape (P,), change by the flank's curvature, (P, P) for each line."""
    bend = body.bend(line.radius) * half_width
    return [0.5 * (bend[span, None] + bend[span]) * own for span, own in zip(spans, common, strict=True)]


def _wave_numbers(solution: SolidFlank, line: Bands) -> Array:
    """Of the cosines along the contact line, which is longer than the face is wide, shape (n,) [1/module]."""
    shortest = float(np.maximum(line.before, line.after).min())
    count = int(np.clip(_WAVES * solution.width / shortest, _FEWEST_WAVES, _MOST_WAVES))
    return np.asarray(np.pi * np.arange(1, count + 1) / solution.width / solution.normal_length)


def _short_waves(solution: SolidFlank, line: Bands, b: float) -> Array:
    """What waves as short as the contact is wide change of `_narrow`: its logarithm would turn negative, (P, P)."""
    k = _wave_numbers(solution, line)
    waves = band_cosines(line, solution.width, k.size)[:, 1:]
    spectrum = quick_band_spectrum(k * b) - 2.0 * (np.log(4.0 / (k * b)) - np.euler_gamma + 0.25)
    return np.asarray(2.0 / solution.width * (waves * spectrum) @ waves.T)


def _narrow(solution: SolidFlank, line: Bands) -> Array:
    """What a half-space makes of contacts of half-width 1 in the limit of narrow ones, but for its slope, (P, P)."""
    k = _wave_numbers(solution, line)
    waves = band_cosines(line, solution.width, k.size)[:, 1:]
    spectrum = 2.0 * (np.log(4.0 / k) - np.euler_gamma + 0.25)
    return np.asarray(2.0 / solution.width * (waves * spectrum) @ waves.T)


def _at_the_faces(solution: SolidFlank, line: Bands, b: float) -> Array:
    """What end faces without traction add to their mirrors, by a logarithm beside them, (P, P)."""
    half = 0.5 * solution.width
    x, w = 0.5 + 0.5 * _END_POINTS[0], 0.5 * _END_POINTS[1]
    lean = math.atan(solution.base_twist)
    total = np.zeros((line.count, line.count))
    square, even = end_slope(0.0, solution.poisson_ratio), np.dot(_SQUARE_SPREAD, (1.0, solution.poisson_ratio))
    for side, angle in ((-1.0, lean), (1.0, -lean)):
        leans = end_slope(angle, solution.poisson_ratio) - square
        for size, spread in ((square, even), (leans, np.dot(_LEAN_SPREAD, (1.0, angle)))):
            reach = np.minimum(spread * line.half_width, half)
            near = np.flatnonzero(half - reach < side * line.zeta + (line.after if side > 0.0 else line.before))
            if not near.size:
                continue
            reach = reach[near, None]
            distance, weight = reach * x**3, 3.0 * reach * x**2 * w / spread
            depth = weight * np.log(reach / np.maximum(distance, np.minimum(spread * b, reach)))
            profile = profiles_at(line, (side * (half - distance)).ravel()).reshape(line.count, near.size, -1)
            part = np.einsum("jiq,iq->ij", profile, profile[near, np.arange(near.size)] * depth)
            total[near] += 0.5 * size * part
    return total + total.T
