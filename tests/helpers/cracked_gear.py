"""A whole gear with a crack, by another mesh and another code: gmsh's splines and its plugin Crack, own P2 triangles.

Of fegear only the curves of the tooth are used. Loads act and displacements are read at single nodes of flanks, and
only between places that differ, so that what is beside a load does not count. Lengths in modules, E = 1, plane strain.
"""

import itertools
import math

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from fegear.fem.plane.gmsh_session import gmsh_session

#: Teeth whose edges are short, and on whose right flanks there are nodes to load.
NEAR = (-1, 0, 1)
#: Gauss points of a triangle, degree 5: areal coordinates and weights.
_A, _B = (6.0 - math.sqrt(15.0)) / 21.0, (6.0 + math.sqrt(15.0)) / 21.0
_AT = np.array(
    [(1 / 3, 1 / 3), (_A, _A), (_A, 1 - 2 * _A), (1 - 2 * _A, _A), (_B, _B), (_B, 1 - 2 * _B), (1 - 2 * _B, _B)]
)
_WEIGHT = np.array([9 / 80, *[(155 - math.sqrt(15)) / 2400] * 3, *[(155 + math.sqrt(15)) / 2400] * 3])


def turned(points, angle):
    """Points turned clockwise about the gear's centre."""
    c, s = math.cos(angle), math.sin(angle)
    return np.stack([c * points[0] + s * points[1], c * points[1] - s * points[0]])


def cracked_gear(tooth, bore, path, radii, size, tip=0.05, fillet=None, hole=None, factor=1.0, keyway=None):
    """Six-node triangles of the whole gear.

    Parameters
    ----------
    tooth : Tooth
    bore : float
    path : ndarray, shape (2, 2) or None
        Mouth, on the right fillet of tooth 0, and tip of a straight crack.
    radii : sequence of float
        Where the right flanks of teeth -1, 0 and 1 have nodes.
    size : float
        Edges along these teeth.
    tip : float
        Edge at the crack's tip as a share of its length.
    fillet : float, optional
        Edges along their fillets.
    hole : (float, float, float), optional
        Radius, and centre in the frame of tooth 0, of a round hole.
    factor : float
        Of all edges.
    keyway : (float, float, float), optional
        Width, depth, and clockwise angle from tooth 0 of a keyway in the bore.

    Returns
    -------
    points : ndarray, shape (2, N)
    triangles : ndarray of int, shape (6, M)
    nodes : dict of (int, int) to int
        By tooth and number of the radius.
    """
    z, marked, loop = tooth.teeth, {}, []
    with gmsh_session("cracked gear") as gmsh:
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.MeshSizeFactor", factor)
        geo = gmsh.model.geo
        first = last = None
        halves = [(k, right) for k in range(0, -z, -1) for right in (True, False)]  # counterclockwise
        for k, right in halves:
            number = next((n for n in NEAR if (n - k) % z == 0), None)
            for name, curve in list(tooth.outline.items())[:: 1 if right else -1]:
                edge = 0.4 if number is None else fillet or size if name == "fillet" else size
                stops = _stops(tooth, name, curve, number, right, path, radii)
                for (low, _), (high, mark) in itertools.pairwise(stops):
                    # Close to each other at the ends, where a spline has the direction of its last chord: else a kink.
                    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, 48 if name in ("fillet", "flank") else 5))
                    xy = curve.points(low + share * (high - low))
                    xy = turned(xy if right else xy * np.array([[-1.0], [1.0]]), 2.0 * math.pi * k / z)
                    inner = [geo.addPoint(*at, 0.0, edge) for at in xy[:, 1:-1].T]
                    if last is None:
                        first = last = geo.addPoint(*xy[:, 0], 0.0, edge)
                    closes = (k, right) == halves[-1] and name == next(iter(tooth.outline)) and mark is None
                    end = first if closes else geo.addPoint(*xy[:, -1], 0.0, edge)
                    loop.append(geo.addSpline([last, *inner, end]))
                    last = end
                    if mark is not None:
                        marked[mark] = end
        centre = geo.addPoint(0.0, 0.0, 0.0)
        held = _bore(geo, bore, centre, keyway)
        loops = [geo.addCurveLoop(loop), geo.addCurveLoop(held)]
        if hole is not None:
            radius, x, y = hole
            middle = geo.addPoint(x, y, 0.0)
            corner = [(x + radius * math.sin(a), y + radius * math.cos(a)) for a in 0.5 * math.pi * np.arange(4)]
            turn = [geo.addPoint(*at, 0.0, min(size, 0.12 * radius)) for at in corner]
            loops.append(geo.addCurveLoop([geo.addCircleArc(turn[i], middle, turn[(i + 1) % 4]) for i in range(4)]))
        surface = geo.addPlaneSurface(loops)
        line = None
        if path is not None:
            end = geo.addPoint(*path[:, 1], 0.0, tip * float(np.hypot(*(path[:, 1] - path[:, 0]))))
            line = geo.addLine(marked["mouth"], end)
        geo.synchronize()
        gmsh.model.addPhysicalGroup(2, [surface], 9)
        if line is not None:
            gmsh.model.mesh.embed(1, [line], 2, surface)
            gmsh.model.addPhysicalGroup(1, [line], 7)
            gmsh.model.addPhysicalGroup(0, [marked["mouth"]], 8)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 1)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        if line is not None:
            for key, value in (("Dimension", 1), ("PhysicalGroup", 7), ("OpenBoundaryPhysicalGroup", 8)):
                gmsh.plugin.setNumber("Crack", key, value)
            gmsh.plugin.run("Crack")
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        kinds, _, connected = gmsh.model.mesh.getElements(2)
        place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
        place[tags.astype(np.int64)] = np.arange(tags.size)
        six = place[connected[list(kinds).index(9)].astype(np.int64)].reshape(-1, 6).T
        points = xyz.reshape(-1, 3)[:, :2].T
        nodes = {
            key: int(place[int(gmsh.model.mesh.getNodes(0, point)[0][0])])
            for key, point in marked.items()
            if key != "mouth"
        }
    used, six = np.unique(six, return_inverse=True)
    new = np.full(points.shape[1], -1)
    new[used] = np.arange(used.size)
    points, six = points[:, used], six.reshape(6, -1)
    if path is not None:
        points = _quartered(points, six, int(np.hypot(*(points - path[:, 1:])).argmin()))
    return points, six, {key: int(new[node]) for key, node in nodes.items()}


def _bore(geo, bore, centre, keyway):
    """Lines of the bore, clockwise."""
    if keyway is None:
        turn = [geo.addPoint(bore * math.sin(a), bore * math.cos(a), 0.0, 0.4) for a in 0.5 * math.pi * np.arange(4)]
        return [geo.addCircleArc(turn[i], centre, turn[(i + 1) % 4]) for i in range(4)]
    width, depth, angle = keyway
    inner, outer, edge = math.sqrt(bore**2 - 0.25 * width**2), bore + depth, 0.03
    xy = turned(0.5 * width * np.array([[-1.0, -1.0, 1.0, 1.0], [0.0] * 4]) + [[0.0] * 4, [inner, outer, outer, inner]],
                angle)  # fmt: skip
    corners = [geo.addPoint(*at, 0.0, edge) for at in xy.T]
    first = math.asin(0.5 * width / bore)
    angles = angle + first + (2.0 * math.pi - 2.0 * first) * np.array([0.25, 0.5, 0.75])
    around = [corners[3], *(geo.addPoint(bore * math.sin(a), bore * math.cos(a), 0.0, 0.4) for a in angles), corners[0]]
    walls = [geo.addLine(*corners[n : n + 2]) for n in range(3)]
    return [*walls, *(geo.addCircleArc(around[n], centre, around[n + 1]) for n in range(4))]


def _quartered(points, six, tip):
    """Middle nodes of the edges at the tip at a quarter of them."""
    found = points.copy()
    for a, b, middle in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
        for start, end in ((a, b), (b, a)):
            at = six[start] == tip
            found[:, six[middle, at]] = 0.75 * points[:, [tip]] + 0.25 * points[:, six[end, at]]
    return found


def _stops(tooth, name, curve, number, right, path, radii):
    """Parameters at which a piece of the outline ends, or has a marked point; in the order of the way round."""
    start, end = (curve.start, curve.end) if right else (curve.end, curve.start)
    found, u = [], np.linspace(curve.start, curve.end, 20001)
    if name == "flank" and right and number is not None:
        found = [(float(np.interp(r, np.hypot(*curve.points(u)), u)), (number, i)) for i, r in enumerate(radii)]
    if name == "fillet" and right and number == 0 and path is not None:
        found = [(float(u[np.hypot(*(curve.points(u) - path[:, :1])).argmin()]), "mouth")]
    return [(start, None), *sorted(found), (end, None)]


class Solved:
    """Displacements of a gear held at its bore under unit forces at marked nodes against the flank's normal."""

    def __init__(self, tooth, bore, mesh, nu=0.3):
        self.tooth, self.nu, (self.points, self.triangles, self.nodes) = tooth, nu, mesh
        self.lame = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu)
        size = 2 * self.points.shape[1]
        free = np.abs(np.hypot(*self.points) - bore) > 1e-6 * bore
        self.free = np.flatnonzero(np.repeat(free, 2))
        matrix = stiffness(self.points, self.triangles, nu)[self.free][:, self.free]
        self.factor = splu(  # symmetric and positive definite: no pivots, half of the time
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
        self.size = size

    def load(self, key):
        """Unit force at a marked node along the line of action, into the tooth."""
        x, y = self.points[:, self.nodes[key]]
        radius = math.hypot(x, y)
        # Tangent to the base circle: its torque about the centre is the base radius, counterclockwise.
        toward = math.atan2(x, y) - math.acos(self.tooth.base_radius / radius)
        found = np.zeros(self.size)
        found[2 * self.nodes[key] : 2 * self.nodes[key] + 2] = -math.cos(toward), math.sin(toward)
        return found

    def moved(self, key):
        """Displacement of all nodes under a unit force."""
        found = np.zeros(self.size)
        found[self.free] = self.factor.solve(self.load(key)[self.free])
        return found

    def between(self, i, j):
        """c_ij(p, q) between all marked places; where they are the same it is nothing but the mesh's."""
        count = 1 + max(number for _, number in self.nodes)
        by = np.stack([self.moved((j, q)) for q in range(count)], axis=1)
        return np.stack([self.load((i, p)) for p in range(count)]) @ by

    def energy_release(self, keys, tip, way, inner, outer):
        """J of unit forces at marked nodes (Rice's integral over a ring about the tip), and of all their sums."""
        lam, mu = self.lame
        corners = np.hypot(*(self.points[:, self.triangles[:3]] - tip[:, None, None]))
        chosen = self.triangles[:, (corners.min(axis=0) < outer) & (corners.max(axis=0) > inner)]
        moved = np.stack([self.moved(key) for key in keys]).reshape(len(keys), -1, 2)[:, chosen]  # (k, 6, M, 2)
        local, found = np.array([way, [-way[1], way[0]]]), 0.0
        for at, weight in zip(_AT, _WEIGHT, strict=True):
            jacobian, gradient = _gradient(self.points[:, chosen], *at)
            place = np.einsum("cim,i->cm", self.points[:, chosen], _values(*at)) - tip[:, None]
            r = np.hypot(*place)
            w = np.clip((r - inner) / (outer - inner), 0.0, 1.0)
            fall = local @ (-6.0 * w * (1.0 - w) / (outer - inner) * place / r)
            slope = np.einsum("ac,kimc,bd,mdi->kabm", local, moved, local, gradient)
            strain = 0.5 * (slope + slope.transpose(0, 2, 1, 3))
            stress = 2.0 * mu * strain
            for c in range(2):
                stress[:, c, c] += lam * (strain[:, 0, 0] + strain[:, 1, 1])
            work = 0.5 * np.einsum("kabm,labm->klm", stress, strain)
            term = np.einsum("kabm,lam,bm->klm", stress, slope[:, :, 0], fall) - work * fall[0]
            found = found + (weight * np.abs(np.linalg.det(jacobian)) * term).sum(axis=2)
        return 0.5 * (found + found.T)

    def root_tension(self, tooth, key):
        """Largest tangential stress along the right fillet of a tooth under a unit force at a marked node."""
        curve = self.tooth.outline["fillet"]
        turn = 2.0 * math.pi * tooth / self.tooth.teeth
        u = np.linspace(curve.start, curve.end, 40001)
        line = turned(curve.points(u), turn)
        edges = np.hstack([self.triangles[[a, b, m]] for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5))])
        _, first, count = np.unique(edges[2], return_index=True, return_counts=True)
        edges = edges[:, first[count == 1]]
        low, high = line.min(axis=1) - 1e-4, line.max(axis=1) + 1e-4
        beside = self.points[:, edges[2]].T
        edges = edges[:, ((beside > low) & (beside < high)).all(axis=1)]
        middle = self.points[:, edges[2]]
        away = np.array([np.hypot(*(line - at[:, None])) for at in middle.T])
        near = away.min(axis=1) < 1e-4
        moved = self.moved(key).reshape(-1, 2).T
        place, found = [], []
        for xi in 0.5 + np.array([-0.5, 0.5]) / math.sqrt(3.0):
            slope = np.array([4 * xi - 3, 4 * xi - 1, 4 - 8 * xi])
            along, change = (np.einsum("cin,i->cn", of[:, edges[:, near]], slope) for of in (self.points, moved))
            found.append((along * change).sum(axis=0) / (along**2).sum(axis=0) / (1.0 - self.nu**2))
            at = np.einsum(
                "cin,i->cn",
                self.points[:, edges[:, near]],
                [(1 - xi) * (1 - 2 * xi), xi * (2 * xi - 1), 4 * xi * (1 - xi)],
            )
            place.append(np.array([np.hypot(*(line - one[:, None])).argmin() for one in at.T]))
        place, found = np.concatenate(place) / u.size, np.concatenate(found)
        # A smooth curve through the places around the largest value: elements scatter about it.
        close = np.abs(place - place[found.argmax()]).argsort()[:12]
        middle, low, high = place[close].mean(), place[close].min(), place[close].max()
        # Beyond the last of these places there is a part of an edge: the largest value may be at the fillet's end.
        low, high = 0.0 if low == place.min() else low, 1.0 if high == place.max() else high
        curve = np.polynomial.Polynomial.fit(place[close] - middle, found[close], 4)
        return float(curve(np.linspace(low - middle, high - middle, 401)).max())


def _values(u, v):
    w = 1.0 - u - v
    return np.array([w * (2 * w - 1), u * (2 * u - 1), v * (2 * v - 1), 4 * u * w, 4 * u * v, 4 * v * w])


def _gradient(nodes, u, v):
    """Jacobians (M, 2, 2) and gradients (M, 2, 6) of elements with nodes (2, 6, M)."""
    w = 1.0 - u - v
    slope = np.array(
        [[1 - 4 * w, 4 * u - 1, 0, 4 * (w - u), 4 * v, -4 * v], [1 - 4 * w, 0, 4 * v - 1, -4 * u, 4 * u, 4 * (w - v)]]
    )
    jacobian = np.einsum("cim,ri->mrc", nodes, slope)
    return jacobian, np.linalg.solve(jacobian, np.broadcast_to(slope, (nodes.shape[2], 2, 6)))


def stiffness(points, triangles, nu):
    """Of six-node triangles, plane strain, E = 1."""
    lam, mu = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu)
    law = np.array([[lam + 2.0 * mu, lam, 0.0], [lam, lam + 2.0 * mu, 0.0], [0.0, 0.0, mu]])
    total = np.zeros((triangles.shape[1], 12, 12))
    nodes = points[:, triangles]  # (2, 6, M)
    for at, weight in zip(_AT, _WEIGHT, strict=True):
        jacobian, gradient = _gradient(nodes, *at)
        strain = np.zeros((triangles.shape[1], 3, 12))
        strain[:, 0, ::2], strain[:, 1, 1::2] = gradient[:, 0], gradient[:, 1]
        strain[:, 2, ::2], strain[:, 2, 1::2] = gradient[:, 1], gradient[:, 0]
        total += (weight * np.abs(np.linalg.det(jacobian)))[:, None, None] * (strain.transpose(0, 2, 1) @ law @ strain)
    dofs = (2 * triangles.T[:, :, None] + np.array([0, 1])).reshape(-1, 12)
    rows, columns = np.repeat(dofs, 12, axis=1).ravel(), np.tile(dofs, (1, 12)).ravel()
    return csc_matrix((total.ravel(), (rows, columns)), shape=(2 * points.shape[1],) * 2)
