"""Mass, inertia and centre of gravity of a gear, from its exact section.

The transverse section is bounded by the curves of the teeth (root land, fillet, involute, tip edge, tip land) and by a
circle. By the divergence theorem its area and its polar moment of area are integrals along that boundary,

    A = 1/2 oint p.n ds,    J = 1/4 oint |p|^2 p.n ds,

with p the place from the axis and n the normal out of the material. A helix turns the section along the face and
changes neither. Reliefs and flank modifications, some micrometres, count for nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.geometry.curves import Curve, smooth_pieces
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide

#: Panels of a curve are halved until both integrals stay within this share of themselves; no more than so many.
_CONVERGED, _PANELS = 1e-12, 256


@dataclass(frozen=True, slots=True)
class SectionMoments:
    """Of what the teeth's outline encloses, counted from the axis; of an internal gear what it leaves out, negative.

    Parameters
    ----------
    area, polar : float
        A and J [modules^2, modules^4].
    error : float
        By how much both changed at most when the last panels were halved, relative.
    """

    area: float
    polar: float
    error: float


@dataclass(frozen=True, slots=True)
class MassProperties:
    """Mass and moments of inertia of a gear with its teeth, rim, web and hub.

    Parameters
    ----------
    mass : float
        [kg].
    inertia : float
        Moment of inertia about the axis [kg m^2].
    transverse_inertia : float
        Moment of inertia about a line across the axis through the centre of gravity [kg m^2]; with one or two holes in
        the web the mean over all directions.
    centre_of_gravity : float
        Place along the axis from the middle of the face, positive toward end II [m].
    error : float
        Estimated error of the integration, relative.
    """

    mass: float = shown("kg", "mass (teeth integrated)")
    inertia: float = shown("kg.m^2", "moment of inertia about the axis")
    transverse_inertia: float = shown("kg.m^2", "transverse moment of inertia through the centre of gravity")
    centre_of_gravity: float = shown("mm", "axial position of the centre of gravity from mid-face")
    error: float = 0.0

    @property
    def inertia_at_mid_face(self) -> float:
        """Moment of inertia about a line across the axis through the middle of the face [kg m^2]."""
        return self.transverse_inertia + self.mass * self.centre_of_gravity**2


@lru_cache(maxsize=1)
def _points() -> tuple[Array, Array]:
    """Gauss points of a panel, when they are asked for: a plan that asks for no mass loads no polynomials."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    return nodes, weights


def _along(curve: Curve, panels: int) -> Array:
    """Integrals of p.n / 2 and |p|^2 p.n / 4 along a curve, shape (2,)."""
    nodes, weights = _points()
    edges = np.linspace(curve.start, curve.end, panels + 1)
    half = 0.5 * np.diff(edges)[:, None]
    at = (0.5 * (edges[:-1] + edges[1:])[:, None] + half * nodes).ravel()
    p = curve.points(at)
    flux = (p * curve.normals(at)).sum(axis=0) * curve.speed(at) * np.abs(half * weights).ravel()
    return np.array([0.5 * flux.sum(), 0.25 * ((p * p).sum(axis=0) * flux).sum()])


def _enclosed(pieces: list[Curve], panels: int) -> Array:
    return np.asarray(np.sum([_along(piece, panels) for piece in pieces], axis=0))


@lru_cache(maxsize=256)
def section_moments(tooth: InvoluteSide) -> SectionMoments:
    """Area and polar moment of area that the outline of all teeth encloses [modules]."""
    halves = [tooth] if tooth.back is tooth else [tooth, tooth.back]
    pieces = smooth_pieces(piece for half in halves for piece in half.outline.values())
    panels, found = 1, _enclosed(pieces, 1)
    while True:
        panels *= 2
        finer = _enclosed(pieces, panels)
        error = float(np.abs(finer / found - 1.0).max())
        found = finer
        if error <= _CONVERGED or panels >= _PANELS:
            break
    whole = 2.0 / len(halves) * tooth.teeth * found  # both flanks of every tooth
    return SectionMoments(float(whole[0]), float(whole[1]), max(error, float(np.finfo(float).eps)))


def mass_properties(
    tooth: InvoluteSide, module: float, face_width: float, held_radius: float, density: float,
    body: GearBody | None = None,
) -> MassProperties:  # fmt: skip
    """Mass, inertia and centre of gravity of a gear.

    Parameters
    ----------
    tooth : InvoluteSide
        External or internal.
    module, face_width, held_radius : float
        m_n, b, and the radius of the bore or, of an internal gear, of its outer circle [m].
    density : float
        [kg/m^3].
    body : GearBody, optional
        Rim, web, hub and holes [m]; by default the gear is as wide as its face down to its bore.
    """
    outline, side = section_moments(tooth), tooth.side
    circle = held_radius if body is None else body.rim_radius
    area = outline.area * module**2 - side * math.pi * circle**2
    polar = outline.polar * module**4 - side * 0.5 * math.pi * circle**4
    per_length = density * face_width
    mass, spin = per_length * area, per_length * polar
    # how much of the outline's error is left once the circle is taken away from it
    error = outline.error * max(abs(outline.area) * module**2 / area, abs(outline.polar) * module**4 / polar)
    first, tilt = 0.0, 0.5 * spin + mass * face_width**2 / 12.0
    if body is not None:
        low, high = body.web
        shift = body.lean * (body.rim_radius - body.hub_radius)
        for part in (
            _ring(density, body.rim_radius, body.hub_radius, low, high, shift),
            _ring(density, body.hub_radius, held_radius, *body.hub),
            _holes(density, body),
        ):
            mass, spin, first, tilt = (a + b for a, b in zip((mass, spin, first, tilt), part, strict=True))
    centre = first / mass
    return MassProperties(mass, spin, tilt - mass * centre**2, centre, error)


def _ring(
    density: float, outer: float, inner: float, low: float, high: float, shift: float = 0.0
) -> tuple[float, float, float, float]:
    """Mass, inertia, first moment, tilting inertia about z = 0 of a ring that moves by a shift from outside inward."""
    if outer <= inner:
        return 0.0, 0.0, 0.0, 0.0
    length, squares, lean = high - low, outer**2 + inner**2, shift / (outer - inner)
    mass = math.pi * density * length * (outer**2 - inner**2)
    # the middle of the length lies at c - lean r; means over the area
    c, cubes = 0.5 * (low + high) + lean * outer, (outer**3 - inner**3) / (outer**2 - inner**2)
    mean = c - 2.0 / 3.0 * lean * cubes
    far = c**2 - 4.0 / 3.0 * c * lean * cubes + 0.5 * lean**2 * squares
    return mass, 0.5 * mass * squares, mass * mean, mass * ((3.0 * squares + length**2) / 12.0 + far)


def _holes(density: float, body: GearBody) -> tuple[float, float, float, float]:
    """What the holes in a web take away, negative; across the axis on average over all directions."""
    holes, (low, high) = body.holes, body.web
    if holes is None:
        return 0.0, 0.0, 0.0, 0.0
    middle, length = 0.5 * (low + high), high - low
    mass = -math.pi * density * length * holes.radius**2 * holes.count
    tilt = (3.0 * holes.radius**2 + length**2) / 12.0 + middle**2 + 0.5 * holes.circle_radius**2
    return mass, mass * (0.5 * holes.radius**2 + holes.circle_radius**2), mass * middle, mass * tilt
