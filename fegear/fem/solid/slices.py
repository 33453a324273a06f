"""Teeth with a width from slices: the plane section's flank, spread along the face by laws fitted to solid gears.

Thin slices answer with the plane compliance of the section and know nothing of their neighbours. Here that compliance
is split into its own shapes up the flank, from the bending of the tooth on its body down to dents as short as the mesh
has them, and each shape spreads along the face by its own law (`slice_laws`). Where the laws have no reach, thin
slices remain; a load that is even along a wide face meets plane strain.

The stress of a fillet is that of the plane section under the load as the shapes spread it.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError
from fegear.fem.solid.face import face_functions
from fegear.fem.solid.half_space import function_cosines
from fegear.fem.solid.slice_laws import LAWS, Spread
from fegear.fem.solid.solution import SolidSolution, solve_solid
from fegear.fem.trace import lagrange

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Array
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.solid.slice_laws import SliceLaws
    from fegear.fem.trace import LoadedFlank
    from fegear.geometry.tooth import Tooth

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
    tooth: Tooth,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings,
    *,
    reach: int = 1,
    held: tuple[float, float] | None = None,
    laws: SliceLaws = LAWS,
    plane: SolidSolution | None = None,
) -> SolidSolution:
    """Answer for a gear with a width from its plane section and the laws of slices.

    Parameters
    ----------
    tooth, tau, width, poisson_ratio, bore_radius, settings, reach
        As of `solve_solid`.
    held : None
        A bore held on a part of the face is not known to slices.
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
        If the bore is held on a part of the face.
    """
    if held is not None:
        raise RangeError("held", held, "is not known to slices, whose bore is held all along the face")
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
        tooth, tau, width, bore_radius, None, poisson_ratio, False, face, plane.flank, compliance, plane.fillets,
        displacement, plane.reach, plane.unknowns, settings, seconds,
    )  # fmt: skip


def solver_of(settings: SolidSettings) -> Callable[..., SolidSolution]:
    """What solves a gear with its width as settings say; both take the arguments of `solve_solid`."""
    return solve_slices if settings.source == "slices" else solve_solid


def plane_section(
    tooth: Tooth, poisson_ratio: float, bore_radius: float, settings: SolidSettings, reach: int
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
