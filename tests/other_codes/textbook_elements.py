"""Plane elements of order 2 to 4 written a second time, from the textbook and without fegear or scikit-fem, for tests.

Silvester's polynomials in areal coordinates, a Gauss-Legendre square folded onto the triangle, strains and Hooke's
matrix (Zienkiewicz, The Finite Element Method, chapters 4 and 6), nodes numbered by looking up who shares an edge.
"""

import numpy as np
from scipy.sparse import coo_matrix


def node_indices(order):
    """Silvester's triples of every node: corners, inside edges 0-1, 1-2 and 0-2 from the first named, inside."""
    p = order
    edges = [
        [(p - k, k, 0) for k in range(1, p)],
        [(0, p - k, k) for k in range(1, p)],
        [(p - k, 0, k) for k in range(1, p)],
    ]
    inner = [(p - j - k, j, k) for k in range(1, p) for j in range(1, p) if j + k < p]
    return [(p, 0, 0), (0, p, 0), (0, 0, p), *edges[0], *edges[1], *edges[2], *inner]


def silvester(order, index, areal):
    """One shape function and its derivatives along the three areal coordinates, for numbers of any kind."""
    factors = []
    for count, coordinate in zip(index, areal, strict=True):
        value, slope = 1, 0
        for m in range(count):
            term = (order * coordinate - m) / (m + 1)
            value, slope = value * term, slope * term + value * order / (m + 1)
        factors.append((value, slope))
    (a, da), (b, db), (c, dc) = factors
    return a * b * c, (da * b * c, a * db * c, a * b * dc)


def edge_moves(areal, sags, leans):
    """Shift and its derivatives along the areal coordinates that curved edges 0-1, 1-2, 0-2 add to a straight triangle.

    An edge from corner i to j leaves its chord by l_i l_j (4 sag + l_i lean_i + l_j lean_j).
    """
    shift, slopes = 0, [0, 0, 0]
    for (i, j), sag, (lean_i, lean_j) in zip(((0, 1), (1, 2), (0, 2)), sags, leans, strict=True):
        a, b = areal[i], areal[j]
        off = 4 * sag + a * lean_i + b * lean_j
        shift = shift + a * b * off
        slopes[i] = slopes[i] + b * off + a * b * lean_i
        slopes[j] = slopes[j] + a * off + a * b * lean_j
    return shift, slopes


def curved_edges(mesh, order, elements):
    """Corners in ascending order (m, 3), and how their edges 0-1, 1-2, 0-2 bend, x and y last."""
    bends = {}
    if order > 2:
        for name, values in mesh.bends.items():
            for (first, second, middle), bend in zip(mesh.edges[name].T, values.transpose(2, 1, 0), strict=True):
                bends[middle] = bend if first < second else bend[::-1]
    corners = np.sort(mesh.triangles[:3, elements], axis=0).T
    sags, leans = np.zeros((3, len(corners), 2)), np.zeros((3, 2, len(corners), 2))
    for e, element in enumerate(elements):
        own = mesh.triangles[:, element]
        middle_of = {frozenset((own[i], own[(i + 1) % 3])): own[3 + i] for i in range(3)}
        for side, (i, j) in enumerate(((0, 1), (1, 2), (0, 2))):
            first, second = corners[e, i], corners[e, j]
            middle = middle_of[frozenset((first, second))]
            sag = mesh.points[:, middle] - 0.5 * (mesh.points[:, first] + mesh.points[:, second])
            sags[side, e] = sag
            if middle in bends:
                leans[side, :, e] = bends[middle] - 4.0 * sag
    return corners, sags, leans


def folded_rule(points):
    """Gauss-Legendre points (3 areal coordinates) and weights, exact to degree 2 points - 2."""
    x, w = np.polynomial.legendre.leggauss(points)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    s, t = (a.ravel() for a in np.meshgrid(x, x))
    return np.stack([1.0 - s, s * (1.0 - t), s * t]), np.outer(w, w).ravel() * s


def hooke(nu, plane):
    """Stress of unit strains xx, yy and engineering shear, E = 1."""
    if plane == "stress":
        return np.array([[1, nu, 0], [nu, 1, 0], [0, 0, 0.5 * (1 - nu)]]) / (1 - nu**2)
    return np.array([[1 - nu, nu, 0], [nu, 1 - nu, 0], [0, 0, 0.5 - nu]]) / ((1 + nu) * (1 - 2 * nu))


def element_matrices(mesh, order, nu, plane, points, elements=None):
    """Stiffness (m, 2 n, 2 n) of elements, x and y node by node in the order of `node_indices`; places (m, n, 2).

    The tip lies at y = 0.
    """
    elements = np.arange(mesh.triangles.shape[1]) if elements is None else elements
    corners, sags, leans = curved_edges(mesh, order, elements)
    vertices = (mesh.points - [[0.0], [mesh.points[1].max()]])[:, corners].transpose(2, 1, 0)  # (3, m, 2)
    indices = node_indices(order)
    areal, weights = folded_rule(points)
    stiffness = 0.0
    for place, weight in zip(areal.T, weights, strict=True):
        _, moves = edge_moves(place, sags, leans)
        by = [vertices[i] + moves[i] for i in range(3)]  # dx/dl_i, (m, 2)
        a, b = by[1] - by[0], by[2] - by[0]
        determinant = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        strain = np.zeros((len(elements), 3, len(indices), 2))
        for n, index in enumerate(indices):
            slope = silvester(order, index, place)[1]
            u, v = slope[1] - slope[0], slope[2] - slope[0]
            dx = (u * b[:, 1] - v * a[:, 1]) / determinant
            dy = (v * a[:, 0] - u * b[:, 0]) / determinant
            strain[:, 0, n, 0], strain[:, 1, n, 1] = dx, dy
            strain[:, 2, n, 0], strain[:, 2, n, 1] = dy, dx
        flat = strain.reshape(len(elements), 3, -1)
        stress = np.einsum("st,mtk,m->msk", hooke(nu, plane), flat, weight * np.abs(determinant))
        stiffness = stiffness + flat.transpose(0, 2, 1) @ stress
    places = []
    for index in indices:
        place = np.array(index) / order
        places.append(np.tensordot(place, vertices, 1) + edge_moves(place, sags, leans)[0])
    return stiffness, np.stack(places, axis=1)


def assembled(mesh, order, nu, plane="strain", points=8):
    """Stiffness of a whole mesh (unknowns x and y node by node), and the nodes' places (2, N), the tip at y = 0."""
    matrices, places = element_matrices(mesh, order, nu, plane, points)
    per_edge = order - 1
    number, rows = {}, []

    def node(key):
        return number.setdefault(key, len(number))

    for e, corners in enumerate(np.sort(mesh.triangles[:3], axis=0).T):
        a, b, c = (int(v) for v in corners)
        keys = [(a,), (b,), (c,)]
        keys += [(*ends, k) for ends in ((a, b), (b, c), (a, c)) for k in range(per_edge)]
        keys += [("inside", e, k) for k in range(matrices.shape[1] // 2 - len(keys))]
        rows.append([node(key) for key in keys])
    nodes = np.array(rows)
    where = np.empty((2, len(number)))
    where[:, nodes.ravel()] = places.reshape(-1, 2).T
    dofs = (2 * nodes[:, :, None] + [0, 1]).reshape(len(nodes), -1)
    i, j = (np.broadcast_to(d, matrices.shape).ravel() for d in (dofs[:, :, None], dofs[:, None]))
    return coo_matrix((matrices.ravel(), (i, j)), shape=2 * (2 * len(number),)).tocsc(), where
