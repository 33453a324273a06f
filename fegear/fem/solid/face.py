"""Functions along the face: polynomials over the whole width, or over pieces where the hub holds only a part of it.

How many functions along the face each node of the section needs: short waves die out away from the loaded flank.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.elements import line_functions
from fegear.fem.solid.dissection import Unknowns, unknowns
from fegear.fem.solid.section import upward
from fegear.fem.solid.settings import whole

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array, Index
    from fegear.fem.solid.section import Section
    from fegear.fem.solid.settings import SolidSettings


#: Coefficients of a function's series that are smaller than this share of its largest are none.
_NOISE = 1e-10


@dataclass(frozen=True)
class FaceFunctions:
    """Continuous piecewise polynomials of z, long waves first.

    One piece over the whole width is the rule: away from the contact the solution is smooth along the face, and global
    polynomials converge faster than layers of elements. The functions are hierarchical: the first few of them span
    polynomials of lower degree, which is all that reaches a place far from the flank.

    Parameters
    ----------
    breaks : tuple of float
        Ends of the pieces, from one end face to the other [modules].
    degrees : tuple of int
        Of the polynomials on each piece, at least 3.
    """

    breaks: tuple[float, ...]
    degrees: tuple[int, ...]

    @property
    def width(self) -> float:
        """Face width [modules]."""
        return self.breaks[-1] - self.breaks[0]

    @property
    def count(self) -> int:
        """Number of functions."""
        return len(self.breaks) + sum(degree - 1 for degree in self.degrees)

    @cached_property
    def _numbers(self) -> list[Index]:
        """Function of each of a piece's own: first its two ends, then the others by their degree over its length."""
        ends = len(self.breaks)
        lengths = np.diff(self.breaks)
        inner = [(n / lengths[i], i, n) for i, degree in enumerate(self.degrees) for n in range(2, degree + 1)]
        numbers = [np.empty(degree + 1, dtype=np.int64) for degree in self.degrees]
        for i, own in enumerate(numbers):
            own[:2] = i, i + 1
        for place, (_, i, n) in enumerate(sorted(inner)):
            numbers[i][n] = ends + place
        return numbers

    @cached_property
    def _series(self) -> list[Array]:
        """Legendre series of each piece's own functions on (-1, 1), shape (degree + 1, degree + 1) each."""
        series = []
        for degree in self.degrees:
            x, w = np.polynomial.legendre.leggauss(degree + 1)
            values, _ = line_functions(degree, 0.5 + 0.5 * x)
            found = (values * w) @ np.polynomial.legendre.legvander(x, degree) * (np.arange(degree + 1) + 0.5)
            series.append(np.where(np.abs(found) > _NOISE * np.abs(found).max(axis=1, keepdims=True), found, 0.0))
        return series

    def at(self, zeta: Array) -> tuple[Array, Array]:
        """Values and slopes of every function at places on the face, shape (count, P) each."""
        slopes = np.zeros((self.count, zeta.size))
        for i, here, x in self._pieces(zeta):
            falling = np.polynomial.legendre.legder(self._series[i], axis=1)
            found = falling @ np.polynomial.legendre.legvander(x, self.degrees[i] - 1).T
            slopes[self._numbers[i][:, None], here] = found * (2.0 / (self.breaks[i + 1] - self.breaks[i]))
        return self.values(zeta), slopes

    def values(self, zeta: Array) -> Array:
        """Values of every function at places on the face, shape (count, P)."""
        values = np.zeros((self.count, zeta.size))
        for i, here, x in self._pieces(zeta):
            values[self._numbers[i][:, None], here] = (
                self._series[i] @ np.polynomial.legendre.legvander(x, self.degrees[i]).T
            )
        return values

    def _pieces(self, zeta: Array) -> Iterator[tuple[int, Index, Array]]:
        """Each piece with places on it: its number, which places, and where they lie on (-1, 1)."""
        breaks = np.asarray(self.breaks)
        piece = np.clip(np.searchsorted(breaks, zeta, side="right") - 1, 0, len(self.degrees) - 1)
        for i in range(len(self.degrees)):
            here = np.flatnonzero(piece == i)
            if here.size:
                low, high = breaks[i], breaks[i + 1]
                yield i, here, (2.0 * zeta[here] - low - high) / (high - low)

    @cached_property
    def products(self) -> tuple[Array, Array, Array]:
        """Integrals of P_k P_l, P_k P_l' and P_k' P_l', shape (count, count) each; entries of no size are zero."""
        place, weight = self.quadrature()
        values, slopes = self.at(place)
        found = [(values * weight) @ values.T, (values * weight) @ slopes.T, (slopes * weight) @ slopes.T]
        for matrix in found:
            matrix[np.abs(matrix) < 1e-13 * np.abs(matrix).max()] = 0.0
        return found[0], found[1], found[2]

    def quadrature(self) -> tuple[Array, Array]:
        """Gauss points and weights that integrate products of two functions exactly, shape (q,) each [modules]."""
        places, weights = [], []
        for low, high, degree in zip(self.breaks, self.breaks[1:], self.degrees, strict=False):
            x, w = np.polynomial.legendre.leggauss(degree + 1)
            places.append(0.5 * (low + high) + 0.5 * (high - low) * x)
            weights.append(0.5 * (high - low) * w)
        return np.concatenate(places), np.concatenate(weights)

    def vanishing_on(self, low: float, high: float) -> Index:
        """Functions that are zero everywhere between two breaks, ascending."""
        breaks = np.asarray(self.breaks)
        inside = [i for i in range(len(self.degrees)) if breaks[i] >= low - 1e-9 and breaks[i + 1] <= high + 1e-9]
        touched = np.concatenate([self._numbers[i] for i in inside]) if inside else np.zeros(0, dtype=np.int64)
        return np.setdiff1d(np.arange(self.count), touched)


def face_functions(width: float, degree: int, held: tuple[float, float] | None = None) -> FaceFunctions:
    """Functions over a face width.

    Parameters
    ----------
    width : float
        [modules]; the face runs from -width / 2 to width / 2.
    degree : int
        Degree over the whole width.
    held : (float, float), optional
        Part of the width on which the bore is held; its ends become breaks between pieces, whose degrees go with the
        root of their lengths: what changes at the ends of the hub needs short waves beside them.

    Returns
    -------
    FaceFunctions
    """
    half = 0.5 * width
    if held is None:
        return FaceFunctions((-half, half), (degree,))
    near = 1e-6 * width
    between = [x for x in held if -half + near < x < half - near]
    breaks = (-half, *between, half)
    share = np.sqrt(np.diff(breaks) / width)
    return FaceFunctions(breaks, tuple(max(4, whole(degree * float(s))) for s in share))


def solid_unknowns(
    section: Section,
    face: FaceFunctions,
    settings: SolidSettings,
    held: tuple[float, float] | None = None,
    *,
    plane_strain: bool = False,
) -> Unknowns:
    """Unknowns of the solid sector, its bore held.

    Parameters
    ----------
    section : Section
    face : FaceFunctions
    settings : SolidSettings
    held : (float, float), optional
        Part of the width on which the bore is held [modules]; by default all of it.
    plane_strain : bool
        Nothing moves along the axis.

    Returns
    -------
    Unknowns
    """
    counts = function_counts(section, face, settings)
    has = np.arange(face.count) < np.repeat(counts, 3)[:, None]
    bore = 3 * section.nodes_of("bore")[:, None] + np.arange(3)
    free = np.zeros(face.count, dtype=bool)
    if held is not None:
        free[face.vanishing_on(*held)] = True
    has[bore.ravel()] &= free
    if plane_strain:
        has[2::3] = False
    return unknowns(has)


def function_counts(section: Section, face: FaceFunctions, settings: SolidSettings) -> Index:
    """Functions along the face of each node, shape (N,).

    What varies along the face with a wavelength l decays within about l from where it is loaded. A node at a distance
    d from the flank has all functions of degree below `wave_reach` times (width / 2 d), and a few more.
    """
    distance = np.maximum(flank_distance(section), 1e-9 * face.width)
    ends = len(face.breaks)
    wanted = settings.wave_reach * 0.5 * face.width / distance + settings.fewest_waves * (ends - 1)
    counts = np.minimum(np.ceil(np.minimum(wanted, face.count)).astype(np.int64), face.count)
    # Sides meet those of the neighbours: both have the functions of the one that is nearer to its flank.
    more = np.maximum(counts[section.side_a], counts[section.side_b])
    counts[section.side_a] = counts[section.side_b] = more
    return np.asarray(counts)


def flank_distance(section: Section) -> Array:
    """Distance of every node from the loaded flank, shape (N,) [modules]."""
    line, _ = upward(section, "flank")
    run = np.concatenate([line[:-1].T.ravel(), line[-1:, -1]])
    start, end = section.places[:, run[:-1], None], section.places[:, run[1:], None]
    chord = end - start
    way = section.places[:, None, :] - start
    share = np.clip((way * chord).sum(axis=0) / (chord * chord).sum(axis=0), 0.0, 1.0)
    return np.asarray(np.hypot(*(way - share * chord)).min(axis=0))
