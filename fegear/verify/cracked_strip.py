"""A row against published stress intensity: an edge crack in a strip, by elements and integral of cracked teeth."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.odd.cracked_sector import CrackedSector
from fegear.verify.row import Compared, Rows

ROWS = Rows()
#: Poisson's ratio; half the height of the strip of width one; edges on its outside.
_NU, _HALF, _EDGE = 0.3, 3.0, 0.12
#: Crack as a share of the width: K_I over stress times sqrt(pi a), in tension and in bending, their table 2.
KAYA_ERDOGAN = {0.1: (1.1892, 1.0472), 0.3: (1.6599, 1.1241), 0.5: (2.8246, 1.4972), 0.7: (6.3549, 2.7252)}


@ROWS.add(
    "stress intensity of cracks", "printed", "A. C. Kaya and F. Erdogan, Q. Appl. Math. 45 (1987), 105-122, table 2"
)
def edge_cracks() -> Iterator[Compared]:
    """K_I of an edge crack of 10 to 70 % of the width of a strip, in tension and in bending."""
    for share, printed in KAYA_ERDOGAN.items():
        sector = strip(share, 0.1 * min(share, 1.0 - share))
        for stress, wanted in zip((_tension, _bending), printed, strict=True):
            yield Compared(float(intensity(sector, 4, stress)[0]), wanted, wanted, 1e-3)


def _tension(x: Array) -> Array:
    return np.ones_like(x)


def _bending(x: Array) -> Array:
    return 1.0 - 2.0 * x


def strip(
    share: float, tip_edge: float, *, quarter: bool = True, edge: float = _EDGE, angle: float = 90.0, rays: int = 8
) -> CrackedSector:
    """A strip of width one whose left side is cracked at half its height.

    Parameters
    ----------
    share : float
        Length of the crack.
    tip_edge : float
        Length of the edges at its tip.
    quarter : bool
        Whether their middle nodes stand at a quarter.
    edge : float
        Length of the edges elsewhere.
    angle : float
        To the strip's axis [deg].
    rays : int
        Triangles around the tip.
    """
    from fegear.fem.plane.mesh import SectorMesh, with_middle_nodes
    from fegear.fem.plane.odd.cracked_sector import crack_line, opened, quartered
    from fegear.fem.plane.tooth_meshing import Slit, fill

    # The boundary counterclockwise from the upper left.
    y = np.linspace(_HALF, -_HALF, 2 * round(_HALF / edge) + 1)
    x = np.linspace(0.0, 1.0, round(1.0 / edge) + 1)
    left, bottom = np.stack([0.0 * y, y]), np.stack([x[1:], -_HALF + 0.0 * x[1:]])
    right, top = np.stack([1.0 + 0.0 * y[1:], y[-2::-1]]), np.stack([x[-2:0:-1], _HALF + 0.0 * x[1:-1]])
    polygon, mouth = np.hstack([left, bottom, right, top]), y.size // 2
    way = np.array([math.sin(math.radians(angle)), -math.cos(math.radians(angle))])
    path = np.stack([np.zeros(2), share * way], axis=1)
    turn = math.atan2(-way[1], -way[0]) + 2.0 * math.pi * np.arange(1, rays) / rays
    around = path[:, 1:] + tip_edge * np.stack([np.cos(turn), np.sin(turn)])
    vertices, triangles, numbers = fill(polygon, 0.4, Slit(mouth, crack_line(path, 0.5 * edge, tip_edge, edge), around))
    vertices, triangles, left_face = opened(vertices, triangles, numbers)
    n = polygon.shape[1]
    runs = {"before": np.append(np.arange(mouth), left_face[0]), "after": np.append(np.arange(mouth, n), 0)}
    runs |= {"crack_left": left_face, "crack_right": numbers}
    middles = {name: 0.5 * (vertices[:, run[1:]] + vertices[:, run[:-1]]) for name, run in runs.items()}
    points, six, edges = with_middle_nodes(vertices, triangles, runs, middles)
    tip = int(numbers[-1])
    mesh = SectorMesh(quartered(points, six, tip) if quarter else points, six, edges, 1, tip=tip if quarter else -1)
    return CrackedSector(mesh, path[:, 1], way, min(path[0, 1], 1.0 - path[0, 1]), 0.0, False)


def pulled(sector: CrackedSector, order: int, stress: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Displacement of a strip whose ends carry a stress over x, and its loads."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import spsolve

    from fegear.fem.plane.elasticity import assemble
    from fegear.fem.plane.trace import lagrange

    elasticity = assemble(sector.mesh, _NU, "strain", order)
    dofs, width = elasticity.element_dofs, elasticity.element_dofs.shape[1]
    rows, columns = np.repeat(dofs, width, axis=1).ravel(), np.tile(dofs, (1, width)).ravel()
    whole = csc_matrix((elasticity.stiffness.ravel(), (rows, columns)), shape=(elasticity.size,) * 2)
    at, weight = np.polynomial.legendre.leggauss(6)
    shape, loads = lagrange(order, 0.5 + 0.5 * at), np.zeros(elasticity.size)
    for name in ("before", "after"):
        for (first, second, _), unknowns in zip(
            sector.mesh.edges[name].T, elasticity.edge_dofs[name].transpose(2, 0, 1), strict=True
        ):
            (x, y), (other, end) = sector.mesh.points[:, first], sector.mesh.points[:, second]
            if abs(abs(y) - _HALF) < 1e-9 and abs(end - y) < 1e-9:
                place = x + (other - x) * (0.5 + 0.5 * at)
                loads[unknowns[1]] += np.sign(y) * shape @ (stress(place) * 0.5 * weight * abs(other - x))
    corner = sector.mesh.points[:, : sector.mesh.vertex_count]
    low, high = (int(np.hypot(corner[0] - 1.0, corner[1] - y).argmin()) for y in (-_HALF, _HALF))
    free = np.setdiff1d(np.arange(elasticity.size), [2 * low, 2 * low + 1, 2 * high])
    moved = np.zeros(elasticity.size)
    moved[free] = spsolve(whole[free][:, free], loads[free])
    return moved, loads


def intensity(
    sector: CrackedSector, order: int, stress: Callable[[Array], Array] = _tension,
    ring: tuple[float, float] | None = None,
) -> Array:  # fmt: skip
    """K_I and K_II over sqrt(pi a)."""
    from fegear.fem.plane.elements import sector_elements
    from fegear.fem.plane.odd.stress_intensity import RINGS, interaction

    length, elements = float(np.hypot(*sector.tip)), sector_elements(sector.mesh, order)
    integral = interaction(sector, _NU, "strain", elements, RINGS[0] if ring is None else ring)
    return np.asarray(integral.T @ pulled(sector, order, stress)[0] / math.sqrt(math.pi * length))
