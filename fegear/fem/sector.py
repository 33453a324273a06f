"""Mesh one tooth sector with gmsh (its only door): the boundary's nodes are given, gmsh fills the inside."""

from __future__ import annotations

import ctypes
import signal
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.errors import FegearError, InputError, MissingLibraryError, lacks_memory
from fegear.fem.boundary import Chain, sector_boundary
from fegear.fem.elements import check_cubic_edges
from fegear.fem.mesh import GENERATED, SectorMesh, with_middle_nodes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.fem.settings import MeshSettings
    from fegear.geometry.tooth import Tooth

#: What gmsh's wheel needs from the system, for the error message.
SYSTEM_PACKAGES = "libglu1-mesa libxcursor1 libxft2 libxinerama1"

#: A middle node this near to the middle of its edge, as a share of the edge, leaves the edge straight.
_STRAIGHT = 1e-12
#: How often, and by which factor, edges are shortened when elements turn inside out.
_MOST_REFINEMENTS, _FINER = 4, 0.6


def load_gmsh() -> Any:
    """Import gmsh, or say which system packages it misses.

    Raises
    ------
    MissingLibraryError
        If gmsh or one of its shared libraries is not there.
    MemoryError
        If there is too little memory to load it.
    """
    try:
        import gmsh
    except (ImportError, OSError) as problem:
        if lacks_memory(problem):
            raise MemoryError(f"gmsh cannot be loaded ({problem})") from problem
        raise MissingLibraryError(
            f"gmsh cannot be loaded ({problem}); on Debian or Ubuntu run: apt-get install {SYSTEM_PACKAGES}"
        ) from problem
    return gmsh


@contextmanager
def gmsh_session(name: str) -> Iterator[Any]:
    """Gmsh with an empty model of this name, which is gone afterwards; started and ended unless it runs already."""
    gmsh = load_gmsh()
    own = not gmsh.isInitialized()
    if own:
        _initialize(gmsh)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.model.add(name)
        try:
            yield gmsh
        finally:
            gmsh.model.remove()
    finally:
        if own:
            gmsh.finalize()


def mesh_sector(tooth: Tooth, bore_radius: float, settings: MeshSettings) -> SectorMesh:
    """Mesh the sector of one tooth.

    Parameters
    ----------
    tooth : Tooth
    bore_radius : float
        [modules].
    settings : MeshSettings
        Where they are too coarse for a sound mesh (a curved boundary may turn an element inside out), finer ones are
        taken.

    Returns
    -------
    SectorMesh
        Side B's nodes are side A's, turned by one pitch.

    Raises
    ------
    RangeError
        If the bore lies too near the centre or the outline to be meshed.
    FegearError
        If gmsh fails, or no finer mesh is sound either.
    """
    started = time.perf_counter()
    for _ in range(_MOST_REFINEMENTS):
        try:
            return _mesh(tooth, bore_radius, settings, started)
        except InputError as problem:
            if problem.key != "mesh":
                raise
            refused = problem
            settings = settings.scaled(_FINER)
    raise FegearError(
        f"No sound mesh of the tooth sector was found: at edges of {settings.root_edge_length:.3g} modules along the "
        f"fillet it still {refused.rule}. Choose a thicker rim or a larger fillet."
    ) from refused


def _mesh(tooth: Tooth, bore_radius: float, settings: MeshSettings, started: float) -> SectorMesh:
    mesh = mesh_inside(sector_boundary(tooth, bore_radius, settings), tooth.teeth, started)
    if settings.order > 2:
        check_cubic_edges(mesh)
    return mesh


def mesh_inside(chains: list[Chain], teeth: int, started: float | None = None) -> SectorMesh:
    """Fill a closed boundary of one sector with curved triangles.

    Parameters
    ----------
    chains : list of Chain
        As `sector_boundary` makes them; sides of another mesh's boundary make sectors that fit each other.
    teeth : int
    started : float, optional
        When the work began [s], of `time.perf_counter`.

    Raises
    ------
    InputError
        If an element is turned inside out.
    FegearError
        If gmsh fails.
    """
    started = time.perf_counter() if started is None else started
    polygon = np.hstack([chain.vertices[:, :-1] for chain in chains])
    vertices, triangles = _fill(polygon)
    starts = np.cumsum([0] + [chain.vertices.shape[1] - 1 for chain in chains])
    total = int(starts[-1])
    runs: dict[str, list[NDArray[np.int64]]] = {}
    middles: dict[str, list[NDArray[np.float64]]] = {}
    bends: dict[str, list[NDArray[np.float64]]] = {}
    for chain, start in zip(chains, starts, strict=False):
        n = chain.vertices.shape[1]
        runs.setdefault(chain.name, []).append(np.arange(start, start + n) % total)
        middles.setdefault(chain.name, []).append(chain.middles)
        bends.setdefault(chain.name, []).append(_bends(chain))
    edges: dict[str, NDArray[np.int64]] = {}
    flat = {f"{name}:{i}": run for name, parts in runs.items() for i, run in enumerate(parts)}
    flat_middles = {f"{name}:{i}": m for name, parts in middles.items() for i, m in enumerate(parts)}
    points, six, numbered = with_middle_nodes(vertices, triangles, flat, flat_middles)
    for name, parts in runs.items():
        edges[name] = np.hstack([numbered[f"{name}:{i}"] for i in range(len(parts))])
    joined = {name: np.concatenate(parts, axis=2) for name, parts in bends.items()}
    return SectorMesh(points, six, edges, teeth, GENERATED, time.perf_counter() - started, joined)


def _bends(chain: Chain) -> NDArray[np.float64]:
    """How the exact curve leaves each edge's chord at its ends, shape (2, 2, n): see `SectorMesh`."""
    chord = np.diff(chain.vertices)
    # Twice the way over the middle node, less what the chord is shorter: the arc's length to fourth order.
    halves = np.hypot(*(chain.middles - chain.vertices[:, :-1])) + np.hypot(*(chain.vertices[:, 1:] - chain.middles))
    length = (4.0 * halves - np.hypot(*chord)) / 3.0
    bends = np.stack([length * chain.tangents[:, :-1] - chord, chord - length * chain.tangents[:, 1:]], axis=1)
    off = np.hypot(*(chain.middles - 0.5 * (chain.vertices[:, 1:] + chain.vertices[:, :-1])))
    return np.where(off > _STRAIGHT * np.hypot(*chord), bends, 0.0)


def _initialize(gmsh: Any) -> None:
    """Start gmsh, from any thread; signals stay with whoever has them.

    gmsh.initialize gives them back to the system: a request to stop would end the process before it has cleared away
    what is unfinished, and writing to a pipe that the other side has closed would end it without a word.
    """
    names = ("SIGPIPE", "SIGTERM", "SIGHUP")
    handlers = ctypes.pythonapi
    handlers.PyOS_getsig.restype = ctypes.c_void_p
    held = {int(n): handlers.PyOS_getsig(int(n)) for n in (getattr(signal, name, None) for name in names) if n}
    gmsh.initialize(interruptible=False)
    for number, handler in held.items():
        handlers.PyOS_setsig(number, ctypes.c_void_p(handler))


def _fill(polygon: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Triangulate the inside of a closed polygon whose corners stay the only boundary nodes."""
    n = polygon.shape[1]
    with gmsh_session("fegear sector") as gmsh:
        try:
            gmsh.option.setNumber("Mesh.Algorithm", 6)
            gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
            geo = gmsh.model.geo
            for tag, (x, y) in enumerate(polygon.T, start=1):
                geo.addPoint(x, y, 0.0, tag=tag)
            for tag in range(1, n + 1):
                geo.addLine(tag, tag % n + 1, tag)
                geo.mesh.setTransfiniteCurve(tag, 2)
            geo.addCurveLoop(list(range(1, n + 1)), 1)
            geo.addPlaneSurface([1], 1)
            geo.synchronize()
            gmsh.model.mesh.generate(2)
            tags, coordinates, _ = gmsh.model.mesh.getNodes()
            _, _, connectivity = gmsh.model.mesh.getElements(2)
        except Exception as problem:
            raise FegearError(f"gmsh could not mesh the sector: {problem}") from problem
    position = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    order = np.argsort(tags)  # boundary corners carry the lowest tags, in the polygon's order
    position[tags[order].astype(np.int64)] = np.arange(tags.size)
    vertices = coordinates.reshape(-1, 3)[order, :2].T.copy()
    vertices[:, :n] = polygon
    triangles = position[connectivity[0].astype(np.int64)].reshape(-1, 3).T.copy()
    a, b, c = vertices[:, triangles[0]], vertices[:, triangles[1]], vertices[:, triangles[2]]
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    flipped = area < 0.0
    triangles[1:, flipped] = triangles[:0:-1, flipped]
    return vertices, triangles
