"""Whole gears by scikit-fem, to hold fegear's finite elements against: nothing of fegear.fem is used here.

What fegear's levels share is done otherwise: all teeth are assembled and factored at once (no condensation, no ring),
Lagrange triangles of fourth order on cubic edges through points of the exact outline (no tangents), every contact is
loaded with its own pressure, which the mesh resolves (no wider ones, no clamps, no wedge), deflections are read as the
work of that pressure, the bore's edges are short, and stresses are looked at along the whole fillet. Shared are the
outline's exact curves (fegear.geometry) and gmsh.
"""

import math
from itertools import pairwise

import gmsh
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP3, ElementTriP4, ElementVector, MeshTri, MeshTri2
from skfem.helpers import ddot, sym_grad, trace
from skfem.mapping import MappingIsoparametric

from fegear.geometry.curves import arc_length

ORDER = 4
_THETA, _WEIGHT = np.polynomial.legendre.leggauss(12)
#: Half-width that stands for a concentrated load [modules].
_POINT = 1e-5


class CubicMesh(MeshTri2):
    """Triangles with the ten nodes of third order."""

    elem = ElementTriP3
    affine = False
    node_numbers = None

    @property
    def dofs(self):
        return self.node_numbers


class Piece:
    """One piece of the outline by its arc length."""

    def __init__(self, curve):
        self.curve = curve
        self.parameter, self.arc = arc_length(curve, 4000)
        self.length = float(self.arc[-1])

    def at(self, s):
        return np.interp(s, self.arc, self.parameter)

    def points(self, s):
        return self.curve.points(self.at(s))

    def normals(self, s):
        return self.curve.normals(self.at(s))


def lagrange(xi):
    """Values and derivatives of the polynomials on equally spaced nodes of [0, 1], shape (5, *xi.shape) each."""
    nodes = np.linspace(0.0, 1.0, ORDER + 1)
    polynomials = [
        np.poly1d(np.delete(nodes, i), r=True) / np.prod(n - np.delete(nodes, i)) for i, n in enumerate(nodes)
    ]
    return np.array([p(xi) for p in polynomials]), np.array([p.deriv()(xi) for p in polynomials])


def graded(length, size):
    """Nodes from 0 to a length with the spacing that `size` asks for."""
    s = [0.0]
    while s[-1] < length:
        s.append(s[-1] + 0.1 * float(size(s[-1])))
    s = np.array(s)
    s[-1] = length
    density = 1.0 / np.array([size(x) for x in s])
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))])
    nodes = np.interp(np.linspace(0.0, count[-1], max(2, math.ceil(count[-1])) + 1), count, s)
    nodes[0], nodes[-1] = 0.0, length
    return nodes


class Sector:
    """One tooth's mesh and stiffness; side A counterclockwise, side B clockwise of the tooth.

    Every edge knows its piece of the boundary, its first and second vertex, and the arc lengths between which it lies.
    """

    def __init__(self, tooth, bore, poisson_ratio, plane, contacts, coarseness, fine):
        self.tooth, self.bore, self.coarseness = tooth, bore, coarseness
        self.pieces = {name: Piece(curve) for name, curve in tooth.outline.items()}
        if tooth.root_land is not None and tooth.root_radius * tooth.root_land_half_angle > 2e-4:
            self.pieces = {"root_land": Piece(tooth.root_land), **self.pieces}
        self._mesh(self._boundary(self._sizes(contacts, fine), fine))
        self._assemble(poisson_ratio, plane)

    def _sizes(self, contacts, fine):
        f, fillet, flank = self.coarseness, self.pieces["fillet"], self.pieces["flank"]
        places = np.linspace(0.0, fillet.length, 801)
        radius = 1.0 / np.maximum(np.abs(fillet.curve.curvatures(fillet.at(places))), 1e-9)
        by_radius = np.clip((0.07 if fine else 0.3) * f * radius, 1e-4, (0.03 if fine else 0.12) * f)
        by_radius = (by_radius + 0.25 * np.abs(places[:, None] - places)).min(axis=1)

        def on_fillet(s):
            return float(np.interp(s, places, by_radius))

        joint = min((0.0008 if fine else 0.05) * f, on_fillet(fillet.length))
        tip, growth = (0.0004 if fine else 0.03) * f, 0.22 * f if fine else 0.35

        def front(s):
            """By the distance along the outline from the start of the flank."""
            h = min((0.05 if fine else 0.2) * f, joint + growth * abs(s), tip + growth * abs(flank.length - s))
            if fine:
                for place, b in contacts:
                    h = min(h, 0.35 * f * b + 0.28 * max(abs(s - place) - 1.2 * b, 0.0))
            return h

        rounding = 0.25 * (self.tooth.tip_rounding or 1.0)
        sizes = {
            "root_land": lambda s: on_fillet(0.0) + 0.25 * (self.pieces["root_land"].length - s),
            "fillet": lambda s: min(on_fillet(s), front(s - fillet.length)),
            "flank": front,
            "tip_edge": lambda s: min(tip + 0.25 * s, rounding * f + 1e-4, 0.1 * f),
            "tip_land": lambda s: min(tip + 0.3 * s, 0.2 * f),
        }
        back = {
            "fillet": on_fillet,
            "flank": lambda s: min(on_fillet(fillet.length) + 0.3 * s, (0.15 if fine else 0.25) * f),
        }
        return sizes, back

    def _boundary(self, sizes, fine):
        """Edges counterclockwise from the bore: (name, four points of the exact curve, (first, second arc length))."""
        z, f = self.tooth.teeth, self.coarseness
        half, mirror, steps = math.pi / z, np.array([[-1.0], [1.0]]), np.linspace(0.0, 1.0, 4)
        forward, back = sizes
        nodes = {name: graded(p.length, forward[name]) for name, p in self.pieces.items()}
        behind = {
            name: graded(p.length, back[name]) if name in back else nodes[name] for name, p in self.pieces.items()
        }
        for every in (nodes, behind):
            if every["fillet"].size < 7:
                every["fillet"] = np.linspace(0.0, self.pieces["fillet"].length, 7)
        front, rear = [], []
        for name, piece in self.pieces.items():
            front += [(name, piece.points(a + (b - a) * steps), (a, b)) for a, b in pairwise(nodes[name])]
        for name, piece in reversed(self.pieces.items()):
            v = behind[name][::-1]
            rear += [(f"back_{name}", mirror * piece.points(a + (b - a) * steps), (a, b)) for a, b in pairwise(v)]
        self.corner = float(np.hypot(*front[0][1][:, 0])) * np.array([math.sin(half), math.cos(half)])
        outer = float(np.hypot(*self.corner))

        def body(depth):
            # The same in fine and coarse sectors, whose sides must match.
            return min(0.06 * f + 0.3 * depth, 1.4 * f * half * (outer - depth), 0.3 * f * (outer - self.bore))

        radii = outer - graded(outer - self.bore, body)
        right = np.array([math.sin(half), math.cos(half)])
        side_b = [("side_b", np.outer(right, a + (b - a) * steps), None) for a, b in pairwise(radii[::-1])]
        side_a = [("side_a", np.outer(mirror[:, 0] * right, a + (b - a) * steps), None) for a, b in pairwise(radii)]
        turns = np.linspace(-half, half, max(4, math.ceil(2.0 * half / 0.12 / f)) + 1)
        bore = []
        for a, b in pairwise(turns):
            t = a + (b - a) * steps
            bore.append(("bore", self.bore * np.stack([np.sin(t), np.cos(t)]), None))
        self.first_outer = len(bore) + len(side_b), len(bore) + len(side_b) + len(front) + len(rear)
        return [*bore, *side_b, *front, *rear, *side_a]

    def _mesh(self, edges):
        polygon = np.stack([edge[1][:, 0] for edge in edges], axis=1)
        n = polygon.shape[1]
        polygon[:, self.first_outer[0]] = self.corner
        polygon[:, self.first_outer[1]] = self.corner * (-1.0, 1.0)
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Algorithm", 5)
        geo = gmsh.model.geo
        for i in range(n):
            geo.addPoint(*polygon[:, i], 0.0, tag=i + 1)
        for i in range(n):
            geo.addLine(i + 1, (i + 1) % n + 1, i + 1)
            geo.mesh.setTransfiniteCurve(i + 1, 2)
        geo.addCurveLoop(list(range(1, n + 1)), 1)
        geo.addPlaneSurface([1], 1)
        geo.synchronize()
        gmsh.model.mesh.generate(2)
        tags, places, _ = gmsh.model.mesh.getNodes()
        _, _, corners = gmsh.model.mesh.getElements(2)
        gmsh.finalize()
        number = np.zeros(int(tags.max()) + 1, dtype=int)
        order = np.argsort(tags)
        number[tags[order].astype(int)] = np.arange(tags.size)
        points = places.reshape(-1, 3)[order, :2].T.copy()
        points[:, :n] = polygon
        # Sorted corners: elements of third and fourth order are wrong without (scikit-fem 12).
        triangles = np.sort(number[corners[0].astype(int)].reshape(-1, 3).T, axis=0)
        self.lift = np.array([[0.0], [float(polygon[1].max())]])
        self.mesh = mesh = MeshTri(points - self.lift, triangles)
        cubic = Basis(mesh, ElementTriP3())
        straight = cubic.doflocs.copy()
        places = straight.copy()
        facet = {tuple(pair): i for i, pair in enumerate(mesh.facets.T)}
        self.edges = []
        for i, (name, exact, span) in enumerate(edges):
            a, b = i, (i + 1) % n
            at = facet[min(a, b), max(a, b)]
            dofs = cubic.facet_dofs[:, at]
            away = np.hypot(*(straight[:, dofs] - mesh.p[:, [a]]))
            places[:, dofs[np.argsort(away)]] = (exact - self.lift)[:, 1:3]
            self.edges.append((name, a, b, at, span))
        # The node inside moves by a quarter of what those on the edges move: nothing of third order is lost.
        shift = places - straight
        places[:, cubic.interior_dofs[0]] += 0.25 * sum(shift[:, cubic.element_dofs[i]] for i in range(3, 9))
        curved = object.__new__(CubicMesh)
        curved.__dict__.update(mesh.__dict__ | {"doflocs": places, "node_numbers": cubic.dofs})
        mapping = MappingIsoparametric(curved, ElementTriP3())
        self.basis = Basis(mesh, ElementVector(ElementTriP4()), mapping=mapping, intorder=9)
        self.scalar = Basis(mesh, ElementTriP4(), mapping=mapping, intorder=2)
        self.size = self.scalar.N

    def _assemble(self, poisson_ratio, plane):
        nu = poisson_ratio
        mu = 0.5 / (1.0 + nu)
        lam = nu / (1.0 - nu**2) if plane == "stress" else nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

        @BilinearForm
        def energy(u, v, _):
            e, d = sym_grad(u), sym_grad(v)
            return lam * trace(e) * trace(d) + 2.0 * mu * ddot(e, d)

        numbers = np.zeros((2, self.size), dtype=int)
        one, two = self.scalar, self.basis
        for kind in ("nodal_dofs", "facet_dofs", "interior_dofs"):
            for i, dofs in enumerate(getattr(one, kind)):
                numbers[0, dofs], numbers[1, dofs] = getattr(two, kind)[2 * i], getattr(two, kind)[2 * i + 1]
        order = numbers.reshape(-1)  # x of all nodes, then y
        self.stiffness = energy.assemble(two).tocsr()[order][:, order].tocsr()

    def run(self, *names):
        """Edges of these boundaries: (name, its five nodes, its arc lengths)."""
        found = []
        for name, a, b, at, span in self.edges:
            if name in names:
                inside = self.scalar.facet_dofs[:, at]
                found.append((name, np.concatenate([[a], inside if a < b else inside[::-1], [b]]), span))
        return found

    def nodes(self, name):
        """Nodes of one boundary by their distance from the gear's centre."""
        found = np.unique(np.concatenate([nodes for _, nodes, _ in self.run(name)]))
        return found[np.argsort(np.hypot(*(self.scalar.doflocs[:, found] + self.lift)))]

    def loads(self, contacts):
        """Unit loads against the normals of fillet and flank, beyond the flank's end against the normal there."""
        flank, fillet = self.pieces["flank"], self.pieces["fillet"]
        before = {"fillet": -fillet.length, "flank": 0.0, "tip_edge": flank.length}
        loads = np.zeros((2 * self.size, len(contacts)))
        for j, (place, b) in enumerate(contacts):
            total = 0.0
            for name, nodes, (first, second) in self.run(*before):
                low, high = np.arcsin(np.clip((before[name] + np.array([first, second]) - place) / b, -1.0, 1.0))
                if high <= low:
                    continue
                theta = 0.5 * (low + high) + 0.5 * (high - low) * _THETA
                share = 0.5 * (high - low) * _WEIGHT * (2.0 / np.pi) * np.cos(theta) ** 2
                s = place + b * np.sin(theta) - before[name]
                normal = (
                    self.pieces[name].normals(s) if name != "tip_edge" else flank.normals(np.full(s.size, flank.length))
                )
                values = lagrange((s - first) / (second - first))[0]
                for axis in range(2):
                    np.add.at(loads[:, j], axis * self.size + nodes, -values @ (normal[axis] * share))
                total += share.sum()
            loads[:, j] /= total
        return loads

    def polar(self):
        """Matrix from unknowns with the sides' in radial and clockwise components to x and y."""
        matrix = sp.identity(2 * self.size, format="lil")
        for name, angle in (("side_a", -math.pi / self.tooth.teeth), ("side_b", math.pi / self.tooth.teeth)):
            s, c = math.sin(angle), math.cos(angle)
            for i in self.nodes(name):
                matrix[i, i], matrix[i, self.size + i] = s, c
                matrix[self.size + i, i], matrix[self.size + i, self.size + i] = c, -s
        return matrix.tocsr()


def whole_gear(tooth, bore, poisson_ratio, plane, contacts, coarseness=1.4):
    """Solve a gear for contacts (arc length from the start of the flank, half-width), all in modules.

    Returns
    -------
    dict
        c_self (pressure-weighted mean deflection and a quarter of the half-plane's logarithm), c_next and c_prev (of
        concentrated loads, at the same place), and by side the arc lengths and tangential stresses along the fillet.
    """
    z, n = tooth.teeth, len(contacts)
    fine, plain = (Sector(tooth, bore, poisson_ratio, plane, contacts, coarseness, kind) for kind in (True, False))
    turned = {sector: sector.polar() for sector in (fine, plain)}
    sector_of = [fine] + [plain] * (z - 1)
    side = fine.nodes("side_a").size
    count, numbers = z * side, []
    for k, sector in enumerate(sector_of):
        own = np.full(sector.size, -1)
        own[sector.nodes("side_a")] = k * side + np.arange(side)
        own[sector.nodes("side_b")] = (k + 1) % z * side + np.arange(side)
        inside = np.flatnonzero(own < 0)
        own[inside] = count + np.arange(inside.size)
        count += inside.size
        numbers.append(np.concatenate([2 * own, 2 * own + 1]))
    parts = {s: (turned[s].T @ s.stiffness @ turned[s]).tocoo() for s in (fine, plain)}
    rows = np.concatenate([own[parts[s].row] for own, s in zip(numbers, sector_of, strict=True)])
    columns = np.concatenate([own[parts[s].col] for own, s in zip(numbers, sector_of, strict=True)])
    values = np.concatenate([parts[s].data for s in sector_of])
    matrix = sp.coo_matrix((values, (rows, columns)), shape=(2 * count, 2 * count)).tocsc()
    held = [
        own[np.concatenate([s.nodes("bore"), s.size + s.nodes("bore")])]
        for own, s in zip(numbers, sector_of, strict=True)
    ]
    free = np.setdiff1d(np.arange(2 * count), np.concatenate(held))
    points = [(s, _POINT) for s, _ in contacts]
    own_loads = fine.loads(contacts)
    right = np.zeros((2 * count, 2 * n))
    right[numbers[0]] = turned[fine].T @ np.hstack([own_loads, fine.loads(points)])
    factor = splu(
        matrix[free][:, free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    moved = np.zeros_like(right)
    moved[free] = factor.solve(right[free])
    here, after, before = (turned[sector_of[k]] @ moved[numbers[k]] for k in (0, 1, -1))
    modulus = 1.0 / (1.0 - poisson_ratio**2) if plane == "strain" else 1.0
    far = plain.loads(points)
    return {
        "c_self": np.einsum("ip,ip->p", own_loads, here[:, :n]) + 0.5 / (np.pi * modulus),
        "c_next": np.einsum("ip,ip->p", far, after[:, n:]),
        "c_prev": np.einsum("ip,ip->p", far, before[:, n:]),
        "tension": _fillet_stress(fine, "fillet", here[:, :n], modulus),
        "compression": _fillet_stress(fine, "back_fillet", here[:, :n], modulus),
    }


def _fillet_stress(sector, name, moved, modulus):
    """Arc lengths from the root land and tangential stresses at the Gauss points of a fillet's edges."""
    xi = 0.5 + 0.5 * np.polynomial.legendre.leggauss(ORDER)[0]
    slopes, piece = lagrange(xi)[1], sector.pieces["fillet"]
    mirror = np.array([[-1.0], [1.0]]) if name == "back_fillet" else np.ones((2, 1))
    arc, stress = [], []
    for _, nodes, (first, second) in sector.run(name):
        s = first + (second - first) * xi
        normal = mirror * piece.normals(s)
        tangent = np.stack([-normal[1], normal[0]])
        along = sum(tangent[i][:, None] * (slopes.T @ moved[i * sector.size + nodes]) for i in range(2))
        arc.append(s)
        stress.append(modulus * along / abs(second - first))
    order = np.argsort(np.concatenate(arc))
    return np.concatenate(arc)[order], np.vstack(stress)[order]
