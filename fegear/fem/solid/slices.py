"""Teeth with a width from slices: the plane section's flank, spread along the face by laws fitted to solid gears.

Thin slices answer with the plane compliance of the section without their neighbours. Here that compliance
is split into its own shapes up the flank, from the bending of the tooth on its body down to dents as short as the mesh
has them, and each shape spreads along the face by its own law (`slice_laws`). Where the laws have no reach, thin
slices remain; a load that is even along a wide face meets plane strain.

The stress of a fillet is that of the plane section under the load as the shapes spread it.

Thin slices: a gear with a width as plane sections side by side, none of which knows of the next.

What the usual programs of loaded tooth contact make of a helical gear: every slice answers its own line load with the
plane compliance of the section, own tooth and neighbours, and Hertz's contact. Nothing spreads along the face, ends
are as stiff as the middle. Kept to compare with; for results take `solve_slices` or `solve_solid`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.fem.plane.trace import LoadedFlank, lagrange
from fegear.fem.solid.bands import Bands, function_cosines, overlap
from fegear.fem.solid.contact import widened_by_curvature
from fegear.fem.solid.face import face_functions
from fegear.fem.solid.flank_body import TwistedFlank
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slice_laws import LAWS, SliceLaws, Spread
from fegear.fem.solid.solution import SolidSolution, solve_solid
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.rim_support import RimSupport

#: Functions along the face of the plane section, all but the constant of which stay at rest; and its width.
_PLANE_DEGREE, _PLANE_WIDTH = 3, 1.0


@dataclass(frozen=True)
class FlankShapes:
    """The plane section's compliance by its shapes up the flank.

    Parameters
    ----------
    values : ndarray, shape (m,)
        Compliance of each shape, the largest first [1/E].
    loads : ndarray, shape (n, m)
        Forces on the flank's nodes whose pressure is the shape, of mean square one.
    coefficients : ndarray, shape (n, m)
        A force on a node times these gives the shapes' shares.
    """

    values: Array
    loads: Array
    coefficients: Array


def flank_shapes(flank: LoadedFlank, compliance: Array) -> FlankShapes:
    """Split a plane compliance of the flank's nodes, shape (n, n), into shapes that are orthogonal along the arc."""
    mass = np.zeros((flank.nodes, flank.nodes))
    x, w = np.polynomial.legendre.leggauss(flank.order + 1)
    value = lagrange(flank.order, 0.5 + 0.5 * x)
    own = (value * 0.5 * w) @ value.T
    for edge, length in enumerate(np.diff(flank.arc)):
        nodes = edge * flank.order + np.arange(flank.order + 1)
        mass[np.ix_(nodes, nodes)] += length * own
    lower = np.linalg.cholesky(mass)
    found, vectors = np.linalg.eigh(lower.T @ (0.5 * (compliance + compliance.T)) @ lower)
    vectors = vectors[:, ::-1]
    return FlankShapes(found[::-1].copy(), lower @ vectors, np.linalg.solve(lower.T, vectors))


def solve_slices(
    tooth: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings,
    *,
    reach: int = 1,
    held: tuple[float, float] | None = None,
    body: GearBody | None = None,
    support: RimSupport | None = None,
    laws: SliceLaws = LAWS,
    plane: SolidSolution | None = None,
) -> SolidSolution:
    """Answer for a gear with a width from its plane section and the laws of slices.

    Parameters
    ----------
    tooth, tau, width, poisson_ratio, bore_radius, settings, reach
        As of `solve_solid`.
    held, body, support : None
        A bore held on a part of the face, web and hub, and the supports of a ring's rim are not known to slices.
    laws : SliceLaws
        By default those fitted to solid gears.
    plane : SolidSolution, optional
        What `plane_section` makes of the same section, if it is known already.

    Returns
    -------
    SolidSolution
        In the form of a solid gear's, for everything that takes one.

    Raises
    ------
    RangeError
        If the bore is held on a part of the face, the gear is no disc, a rim is not held, or the gear is internal.
    """
    if tooth.internal:
        raise RangeError(
            "internal", "true", 'is not available with width = "slices" (external gears only)',
            'set width = "solid"',
        )  # fmt: skip
    if body is not None:
        raise RangeError(
            "body", "web and hub", 'are not available with width = "slices" (solid disc only)',
            'set width = "solid"',
        )  # fmt: skip
    if support is not None:
        raise RangeError(
            "rim_support", "pins or a spline", 'is not available with width = "slices" (external gears only)',
            'set width = "solid"',
        )  # fmt: skip
    if held is not None:
        raise RangeError("held", held, 'is not available with width = "slices" (bore fixed over the full face width)')
    started = time.perf_counter()
    plane = plane or plane_section(tooth, poisson_ratio, bore_radius, settings, reach)
    solved = time.perf_counter()
    face = face_functions(width, settings.degree(width))
    one = function_cosines(plane.face, 1)[1]
    n, count = plane.flank.nodes, face.count
    alone = plane_compliance(plane)
    shapes = flank_shapes(plane.flank, alone[0])
    next_tooth = float(shapes.loads[:, 0] @ alone[1] @ shapes.loads[:, 0]) if 1 in alone else 0.0
    depth = tooth.root_radius - bore_radius
    spread = Spread(face, poisson_ratio, tau * tooth.base_radius, depth, laws)
    own = spread.own(shapes.values, next_tooth)
    beside, root = spread.beside(), spread.root(_node_arcs(plane.flank))
    compliance, displacement = {}, {}
    for k, c in alone.items():
        parts = (
            np.einsum("im,mkl,jm->ikjl", shapes.coefficients, own, shapes.coefficients, optimize=True)
            if k == 0
            else np.einsum("ij,kl->ikjl", c, beside)
        )
        compliance[k] = np.ascontiguousarray(parts.reshape(n * count, n * count))
    for (k, side), moved in plane.displacement.items():
        displacement[k, side] = _moved(moved, one, root if k == 0 else np.broadcast_to(beside, root.shape))
    seconds = {"section": solved - started, "slices": time.perf_counter() - solved}
    return SolidSolution(
        tooth, tau, width, bore_radius, None, None, poisson_ratio, False, face, plane.flank, compliance, plane.fillets,
        displacement, plane.reach, plane.unknowns, settings, seconds,
    )  # fmt: skip


def solver_of(settings: SolidSettings) -> Callable[..., SolidSolution]:
    """What solves a gear with its width as settings say; both take the arguments of `solve_solid`."""
    return solve_slices if settings.source == "slices" else solve_solid


def plane_section(
    tooth: InvoluteSide, poisson_ratio: float, bore_radius: float, settings: SolidSettings, reach: int
) -> SolidSolution:
    """Plane strain, by the solid's own elements without twist and axial displacement."""
    few = replace(settings, least_degree=_PLANE_DEGREE, waves_per_module=1e-3)
    return solve_solid(tooth, 0.0, _PLANE_WIDTH, poisson_ratio, bore_radius, few, reach=reach, plane_strain=True)


def plane_compliance(plane: SolidSolution) -> dict[int, Array]:
    """Compliance of the flank's nodes in the plane section per width, by tooth, shape (n, n) each [1/E]."""
    n, one = plane.flank.nodes, function_cosines(plane.face, 1)[1]
    return {
        k: np.einsum("ikjl,k,l->ij", c.reshape(n, one.size, n, one.size), one, one) / plane.width
        for k, c in plane.compliance.items()
    }


def _node_arcs(flank: LoadedFlank) -> Array:
    """Arc length of the flank's nodes from its lower end [modules]."""
    p, edges = flank.order, np.arange(flank.arc.size)
    return np.interp(np.arange(flank.nodes) / p, edges, flank.arc - flank.flank_start)


def _moved(moved: Array, one: Array, along: Array) -> Array:
    """Displacements of a fillet's nodes, shape (nodes, 3, functions, n * functions), from those of the plane section.

    `moved` is of shape (nodes, 3, functions, n * functions) of the plane's own functions, `one` their integrals.
    """
    nodes, count = moved.shape[0], along.shape[1]
    # Even along the face, so that any place on it shows the displacement: that of the first end.
    even = moved[:, :, 0].reshape(nodes, 3, -1, one.size) @ one
    return np.ascontiguousarray(np.einsum("acj,jkl->ackjl", even, along).reshape(nodes, 3, count, -1))


#: Points along the face between two stations: hats make a square, what the section answers hardly varies.
_GAUSS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True)
class ThinSlices(TwistedFlank):
    """Plane sections side by side; lengths in modules, E = 1.

    Parameters
    ----------
    tooth : InvoluteSide
        The transverse section.
    tau : float
        Twist [rad/module].
    width : float
        [modules].
    poisson_ratio : float
    flank : LoadedFlank
    compliance : mapping of int to ndarray, shape (n, n)
        Of the flank's nodes on tooth k under line loads on tooth 0, plane strain [1/E].
    reach : int
        K: neighbours -K..K are known.
    settings : SolidSettings
    seconds : mapping of str to float
    """

    tooth: InvoluteSide
    tau: float
    width: float
    poisson_ratio: float
    flank: LoadedFlank
    compliance: Mapping[int, Array]
    reach: int
    settings: SolidSettings
    seconds: Mapping[str, float]

    def pressed(self, line: Bands, spans: Sequence[slice], teeth: Sequence[int]) -> ThinLines:  # noqa: ARG002  (as of every solution)
        """Press contact lines on it."""
        return ThinLines(self, line, spans)


class ThinLines:
    """Contact lines on thin slices; see `flank_body.FlankLines`."""

    def __init__(self, body: ThinSlices, line: Bands, spans: Sequence[slice]) -> None:
        self._body, self._line, self._spans = body, line, spans
        self.common = [overlap(line.part(span)) for span in spans]

    def own(self) -> list[Array]:
        """c_0 of each line under contacts of half-width 1, less what `widened` gives, (P, P) [1/(E module)]."""
        return self._products(0, [(i, i) for i in range(len(self._spans))])

    def widened(self, half_width: Array) -> list[Array]:
        """What the contacts' half-widths change beside their logarithm, (P, P) for each line."""
        return widened_by_curvature(self._body, self._line, self._spans, self.common, half_width)

    def between(self, i: int, j: int, pairs: Sequence[tuple[int, int]]) -> list[Array]:
        """c_k, k = i - j, between lines on teeth i and j: of slices where both lines pass."""
        return self._products(i - j, pairs)

    def _products(self, k: int, pairs: Sequence[tuple[int, int]]) -> list[Array]:
        """Integrals of the bands' profiles on two lines times what the slices there answer, (P, Q) each."""
        points = [self._points(*(self._spans[i] for i in pair)) for pair in pairs]
        ends = np.cumsum([z.size for z, _ in points])[:-1]
        seen, pressed = ([self._at(self._spans[pair[i]], z) for pair, (z, _) in zip(pairs, points, strict=True)]
                         for i in (0, 1))  # fmt: skip
        answer = self._answer(k, *(np.concatenate([r for r, _ in side]) for side in (seen, pressed)))
        return [(first * (weight * part)) @ second.T
                for (_, first), (_, second), (_, weight), part in zip(seen, pressed, points, np.split(answer, ends),
                                                                      strict=True)]  # fmt: skip

    def _points(self, first: slice, second: slice) -> tuple[Array, Array]:
        """Gauss points and weights where two lines stand beside each other, between all their stations."""
        one, other = self._line.zeta[first], self._line.zeta[second]
        low, high = max(one[0], other[0]), min(one[-1], other[-1])
        if high <= low:
            return np.empty(0), np.empty(0)
        cuts = np.union1d(np.clip(one, low, high), np.clip(other, low, high))
        half = 0.5 * np.diff(cuts)[:, None]
        z = 0.5 * (cuts[1:] + cuts[:-1])[:, None] + half * _GAUSS[0]
        return z.ravel(), (half * _GAUSS[1]).ravel()

    def _at(self, span: slice, z: Array) -> tuple[Array, Array]:
        """Radius of a line at some heights, shape (n,), and its bands' profiles there, shape (P, n)."""
        zeta, rb = self._line.zeta[span], self._body.tooth.base_radius
        # The line is straight in the plane of action, where its distance from the base circle's tangent point counts.
        rolled = np.interp(z, zeta, np.sqrt(np.maximum(self._line.radius[span] ** 2 - rb**2, 0.0)))
        flank = self._body.flank
        radius = np.clip(np.hypot(rb, rolled), flank.lowest_radius, flank.highest_radius)
        i = np.clip(np.searchsorted(zeta, z, side="right") - 1, 0, zeta.size - 2)
        part = (z - zeta[i]) / np.diff(zeta)[i]
        profile = np.zeros((zeta.size, z.size))
        height = 2.0 / (self._line.before[span] + self._line.after[span])
        at = np.arange(z.size)
        profile[i, at], profile[i + 1, at] = (1.0 - part) * height[i], part * height[i + 1]
        return radius, profile

    def _answer(self, k: int, seen: Array, pressed: Array) -> Array:
        """Deflection at some places of slices under unit line loads at others, shape (n,) [1/E]."""
        body, flank = self._body, self._body.flank
        width, arc = body.band_half_width(pressed), flank.arc_of_radius(pressed)
        load = flank.normal_patches(arc, width)
        if k:
            at = flank.normal_patches(flank.arc_of_radius(seen), body.band_half_width(seen))
            return np.asarray(np.einsum("np,np->p", at, body.compliance[k] @ load))
        mean = np.einsum("np,np->p", load, body.compliance[0] @ load)
        # From the mean under a wide pressure to the centre of one of half-width 1: Hertz, as in the plane.
        change = body.contact_slope * (0.5 + 2.0 * np.log(width)) - body.bend(pressed) * width
        return np.asarray(mean + change)


def solve_thin_slices(
    tooth: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings,
    *,
    reach: int = 1,
    plane: SolidSolution | None = None,
) -> ThinSlices:
    """Answer for a gear with a width from its plane section alone.

    Parameters
    ----------
    tooth, tau, width, poisson_ratio, bore_radius, settings, reach
        As of `solve_solid`.
    plane : SolidSolution, optional
        What `plane_section` makes of the same section, if it is known already.

    Returns
    -------
    ThinSlices
        For `FlankPair`, as a solid gear's solution is.
    """
    started = time.perf_counter()
    plane = plane or plane_section(tooth, poisson_ratio, bore_radius, settings, reach)
    seconds = {"section": time.perf_counter() - started}
    return ThinSlices(
        tooth, tau, width, poisson_ratio, plane.flank, plane_compliance(plane), plane.reach, settings, seconds
    )
