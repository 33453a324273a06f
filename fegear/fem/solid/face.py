"""Functions along the face: polynomials over the whole width, or over pieces where the hub holds only a part of it.

How many functions along the face each node of the section needs: short waves die out away from the loaded flank.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Index, Mask
from fegear.fem.plane.elements import line_functions
from fegear.fem.solid.section import Section, upward
from fegear.fem.solid.settings import SolidSettings, whole
from fegear.fem.solid.unknowns import Unknowns, unknowns
from fegear.geometry.gear_body import GearBody

#: By what length along the axis is greater than places, at these.
Stretch = Callable[[Array], Array]
#: Coefficients of a function's series that are smaller than this share of its largest are none.
_NOISE = 1e-10
#: Places along the face this near to each other, as a share of its width, are one.
_NEAR = 1e-6
#: Long waves that each piece of the face beyond the first adds, as a share of those of a face of one piece.
_PIECE = 0.6
#: Power of a piece's share of the width with which its degree goes.
_BY_LENGTH = 0.6
#: Degree that functions of web and hub have at least, however far from the flank: they bend with cubes over their
#: thickness, and where they may not thin and thicken as they bend they are too stiff, threefold at a Poisson's ratio
#: of .45. Rim and teeth of a thin rim have the lowest ones of each piece, too: where the fillet away from the load had
#: fewer, its compression was up to 24 % off at a tolerance of .05, and no second solution showed it.
_BENDING = 4
#: How far outside the circle where a web begins its breaks are felt, and how deep a rim has teeth beyond [modules].
_FELT, _DEEP = 1.0, 1.45


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
    mirrored : bool
        Whether functions of pieces that mirror each other at the middle of the face are joined to even and odd ones.
    """

    breaks: tuple[float, ...]
    degrees: tuple[int, ...]
    mirrored: bool = False

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
        numbers = [np.empty(degree + 1, dtype=np.int64) for degree in self.degrees]
        for i, own in enumerate(numbers):
            own[:2] = i, i + 1
        for place, (_, i, n) in enumerate(self._inner):
            numbers[i][n] = ends + place
        return numbers

    @cached_property
    def _inner(self) -> list[tuple[float, int, int]]:
        """Functions that vanish at the ends of their piece: degree over its length, piece and degree, in order.

        Pieces whose lengths differ by round-off alone stand side by side.
        """
        lengths = [float(f"{length / self.width:.9g}") for length in np.diff(self.breaks)]
        return sorted((n / lengths[i], i, n) for i, degree in enumerate(self.degrees) for n in range(2, degree + 1))

    @cached_property
    def full_counts(self) -> Index:
        """How many of the first functions treat pieces of one length alike, for each number that is wanted."""
        last = [np.inf, *(wave for wave, _, _ in self._inner), np.inf]
        steps = [i for i in range(1, len(last)) if last[i] != last[i - 1]]
        allowed = len(self.breaks) - 1 + np.array(steps)
        return allowed[np.searchsorted(allowed, np.arange(self.count + 1))]

    @cached_property
    def _series(self) -> list[Array]:
        """Legendre series of each piece's own functions on (-1, 1), shape (degree + 1, degree + 1) each."""
        series = []
        for degree in self.degrees:
            x, w = np.polynomial.legendre.leggauss(degree + 1)
            values, _ = line_functions(degree, 0.5 + 0.5 * x)
            found = (values * w) @ np.polynomial.legendre.legvander(x, degree) * (np.arange(degree + 1) + 0.5)
            series.append(np.where(np.abs(found) > _NOISE * np.abs(found).max(axis=1, keepdims=True), found, 0.0))
        if len(series) == 1:  # nothing to join: in place of one function for each end their mean and their difference
            series[0][:2] = np.eye(2, self.degrees[0] + 1)
        return series

    @cached_property
    def odd(self) -> Mask:
        """Which functions are odd about the middle of the face, shape (count,); all others are even.

        Of a face of one piece, or of several that mirror each other.
        """
        if len(self.degrees) == 1:
            return np.arange(self.count) % 2 == 1
        return np.array([other < i or (other == i and sign < 0.0) for i, (other, sign) in enumerate(self._mirror)])

    @cached_property
    def _mirror(self) -> list[tuple[int, float]]:
        """Which function each becomes where the face is mirrored at its middle, and with which sign."""
        ends, pieces = len(self.breaks), len(self.degrees)
        found = [(ends - 1 - i, 1.0) for i in range(ends)]
        for _, i, n in self._inner:
            found.append((int(self._numbers[pieces - 1 - i][n]), (-1.0) ** n))
        return found

    def _joined(self, own: Array) -> Array:
        """Even and odd functions, the even one of each pair first, from those of single pieces, shape (count, P)."""
        if not self.mirrored or len(self.degrees) == 1:
            return own
        found = own.copy()
        for i, (other, sign) in enumerate(self._mirror):
            if i < other:
                found[i], found[other] = own[i] + sign * own[other], own[i] - sign * own[other]
        return found

    def at(self, zeta: Array) -> tuple[Array, Array]:
        """Values and slopes of every function at places on the face, shape (count, P) each."""
        return self.values(zeta), self.derivatives(zeta, 1)

    def derivatives(self, zeta: Array, order: int) -> Array:
        """First, second, ... derivatives of every function at places on the face, shape (count, P)."""
        found = np.zeros((self.count, zeta.size))
        for i, here, x in self._pieces(zeta):
            falling = np.polynomial.legendre.legder(self._series[i], order, axis=1)
            own = falling @ np.polynomial.legendre.legvander(x, self.degrees[i] - order).T
            found[self._numbers[i][:, None], here] = own * (2.0 / (self.breaks[i + 1] - self.breaks[i])) ** order
        return self._joined(found)

    def values(self, zeta: Array) -> Array:
        """Values of every function at places on the face, shape (count, P)."""
        values = np.zeros((self.count, zeta.size))
        for i, here, x in self._pieces(zeta):
            values[self._numbers[i][:, None], here] = (
                self._series[i] @ np.polynomial.legendre.legvander(x, self.degrees[i]).T
            )
        return self._joined(values)

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
        return self.products_over(-math.inf, math.inf)

    def products_over(self, low: float, high: float, stretched: Stretch | None = None) -> tuple[Array, Array, Array]:
        """The same from one break to another, where places may be stretched by a factor that is even on every piece."""
        place, weight = self.quadrature(low, high)
        return _products(*self.at(place), weight, None if stretched is None else stretched(place))

    def quadrature(self, low: float = -math.inf, high: float = math.inf, least: int = 0) -> tuple[Array, Array]:
        """Gauss points and weights that integrate products of two functions exactly, shape (q,) each [modules].

        Over the whole face, or from one break to another; also products of polynomials of a degree `least`.
        """
        places, weights = [], []
        for i in self._between(low, high):
            start, end = self.breaks[i], self.breaks[i + 1]
            x, w = np.polynomial.legendre.leggauss(max(self.degrees[i], least) + 1)
            places.append(0.5 * (start + end) + 0.5 * (end - start) * x)
            weights.append(0.5 * (end - start) * w)
        return np.concatenate(places), np.concatenate(weights)

    def vanishing_on(self, low: float, high: float) -> Index:
        """Functions that are zero everywhere between two breaks, ascending."""
        inside = self._between(low, high)
        touched = np.concatenate([self._numbers[i] for i in inside]) if inside else np.zeros(0, dtype=np.int64)
        return np.setdiff1d(np.arange(self.count), touched)

    def low_on(self, low: float, high: float, degree: int) -> Index:
        """Functions of at most a degree that are not zero between two breaks."""
        return np.concatenate([self._numbers[i][: degree + 1] for i in self._between(low, high)])

    def degree_on(self, low: float, high: float) -> int:
        """Highest degree of the pieces between two breaks."""
        return max(self.degrees[i] for i in self._between(low, high))

    def _between(self, low: float, high: float) -> list[int]:
        """Pieces between two breaks."""
        ends, near = self.breaks, _NEAR * self.width
        return [i for i in range(len(self.degrees)) if ends[i] >= low - near and ends[i + 1] <= high + near]


def _products(values: Array, slopes: Array, weight: Array, stretch: Array | None = None) -> tuple[Array, Array, Array]:
    if stretch is not None:
        slopes, weight = slopes / stretch, weight * stretch
    found = [(values * weight) @ values.T, (values * weight) @ slopes.T, (slopes * weight) @ slopes.T]
    for matrix in found:
        matrix[np.abs(matrix) < 1e-13 * np.abs(matrix).max()] = 0.0
    return found[0], found[1], found[2]


@dataclass(frozen=True)
class JoinedFunctions:
    """Functions of a body's pieces, and behind them those of teeth that are too far from the body to feel its breaks.

    Parameters
    ----------
    body, teeth : FaceFunctions
        Piece by piece, and over the whole face at once.
    """

    body: FaceFunctions
    teeth: FaceFunctions

    @property
    def odd(self) -> Mask:
        """Which functions are odd about the middle of the face, shape (count,)."""
        return np.concatenate([self.body.odd, self.teeth.odd])

    def products_over(self, low: float, high: float, stretched: Stretch | None = None) -> tuple[Array, Array, Array]:
        """Integrals of products of all functions from one break to another, as `FaceFunctions` has them."""
        place, weight = self.body.quadrature(low, high, max(self.teeth.degrees))
        values, slopes = (np.vstack(both) for both in zip(self.body.at(place), self.teeth.at(place), strict=True))
        return _products(values, slopes, weight, None if stretched is None else stretched(place))


def face_functions(
    width: float, degree: int, cuts: Sequence[float] = (), least: int = 4, fewer: int = 0, *, mirrored: bool = False
) -> FaceFunctions:
    """Functions over a face width.

    Parameters
    ----------
    width : float
        [modules]; the face runs from -width / 2 to width / 2.
    degree : int
        Degree over the whole width.
    cuts : sequence of float
        Where web, hub or the held part of a bore end; they become breaks between pieces, whose degrees go with the
        root of their lengths or somewhat less: what changes there needs short waves beside it.
    least, fewer : int
        Lowest degree of a piece, and by how much it is lower than that.
    mirrored : bool
        Whether pieces, which mirror each other at the middle of the face, have even and odd functions.

    Returns
    -------
    FaceFunctions
    """
    half = 0.5 * width
    near = _NEAR * width
    breaks = [-half]
    for x in sorted(cuts):
        if breaks[-1] + near < x < half - near:
            breaks.append(x)
    if len(breaks) == 1:
        return FaceFunctions((-half, half), (degree,))
    breaks.append(half)
    share = (np.diff(breaks) / width) ** _BY_LENGTH
    degrees = tuple(max(least, whole(degree * float(s)) - fewer) for s in share)
    return FaceFunctions(tuple(breaks), degrees, mirrored)


def solid_unknowns(
    section: Section,
    face: FaceFunctions,
    settings: SolidSettings,
    held: tuple[float, float] | None = None,
    *,
    plane_strain: bool = False,
    all_waves: bool = False,
    teeth: tuple[FaceFunctions, float] | None = None,
    bore_held: bool = True,
    beside: Section | None = None,
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
    all_waves : bool
        Every node has all functions along the face, as a body without a loaded flank wants them.
    teeth : (FaceFunctions, float), optional
        Functions, behind those of the face, that nodes beyond a radius [modules] have in their place.
    bore_held : bool
        Not the outer circle of a ring that has another support.
    beside : Section, optional
        The ordinary one, next to which one whose tooth differs stands.

    Returns
    -------
    Unknowns
    """
    few = function_counts(section, face, settings, beside)
    counts = np.full_like(few, face.count) if all_waves else few
    has = np.arange(face.count) < np.repeat(counts, 3)[:, None]
    if len(section.spans) > 1:  # where web and hub are no material no function of theirs is any use
        there, bends = np.zeros((2, section.places.shape[1], face.count), dtype=bool)
        for zone, span in enumerate(section.spans):
            used = np.ones(face.count, dtype=bool)
            used[face.vanishing_on(*span)] = False
            nodes = np.unique(section.element_dofs[section.zone == zone, ::3] // 3)
            there[nodes] |= used
            if len(face.breaks) > 2 and (zone > 0 or teeth is None):  # as wide as the face they are a disc
                low = face.low_on(*span, settings.least_piece_degree if zone == 0 else _BENDING)
                bends[np.ix_(nodes, low)] = True
        has = np.repeat(there, 3, axis=0) & (has | np.repeat(bends, 3, axis=0))
    bore = 3 * section.nodes_of("bore")[:, None] + np.arange(3)
    free = np.zeros(face.count, dtype=bool)
    if held is not None:
        free[face.vanishing_on(*held)] = True
    has[bore.ravel()] &= free | (not bore_held)
    if teeth is not None:
        beyond = np.repeat(np.hypot(*section.places) > teeth[1], 3)[:, None]
        own = np.arange(teeth[0].count) < np.repeat(function_counts(section, teeth[0], settings, beside), 3)[:, None]
        has = np.hstack([has & ~beyond, own & beyond])
    if plane_strain:
        has[2::3] = False
    return unknowns(has)


def own_of_teeth(face: FaceFunctions, body: GearBody | None, root_radius: float) -> float:
    """Beyond which radius teeth have functions of their own over the whole face [modules]; none if infinite.

    A thin rim has none: its fillets feel where the web ends. Nor has a disc, or a body of one piece.
    """
    if body is None or len(face.breaks) == 2 or root_radius - body.rim_radius < _DEEP:
        return math.inf
    return body.rim_radius + _FELT


def function_counts(
    section: Section, face: FaceFunctions, settings: SolidSettings, beside: Section | None = None
) -> Index:
    """Functions along the face of each node, shape (N,).

    What varies along the face with a wavelength l decays within about l from where it is loaded. A node at a distance
    d from the flank has all functions of degree below `wave_reach` times (width / 2 d), and a few more. In a sector
    `beside` ordinary ones the ordinary flank counts, whatever is left of it, and its sides are theirs.
    """
    distance = np.maximum(flank_distance(section, beside), 1e-9 * face.width)
    wanted = settings.wave_reach * 0.5 * face.width / distance + settings.fewest_waves * (
        1.0 + _PIECE * (len(face.breaks) - 2)
    )
    counts = face.full_counts[np.minimum(np.ceil(np.minimum(wanted, face.count)).astype(np.int64), face.count)]
    # Sides meet those of the neighbours: both have the functions of the one that is nearer to its flank.
    more = np.maximum(counts[section.side_a], counts[section.side_b])
    if beside is not None:
        more = function_counts(beside, face, settings)[beside.side_a]
    counts[section.side_a] = counts[section.side_b] = more
    return np.asarray(counts)


def flank_distance(section: Section, of: Section | None = None) -> Array:
    """Distance of every node from the loaded flank, of its own or another section, shape (N,) [modules]."""
    owner = section if of is None else of
    line, _ = upward(owner, "flank")
    run = np.concatenate([line[:-1].T.ravel(), line[-1:, -1]])
    start, end = owner.places[:, run[:-1], None], owner.places[:, run[1:], None]
    chord = end - start
    way = section.places[:, None, :] - start
    share = np.clip((way * chord).sum(axis=0) / (chord * chord).sum(axis=0), 0.0, 1.0)
    return np.asarray(np.hypot(*(way - share * chord)).min(axis=0))
