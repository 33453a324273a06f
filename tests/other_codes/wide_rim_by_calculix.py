"""A whole ring gear with its width in a spline or on pins by CalculiX: quadratic solids of all teeth, one loaded.

Nothing of fegear's solution is used but the section's nodes (`solid_by_calculix.solid`): the tractions of the spline,
the mean motion of the outer cylinder, what pins hold and the fillet's stress are summed here.
Module and modulus are one.
"""

import os
import re
import subprocess

import numpy as np
import solid_by_calculix as calculix

#: The ring of `solid_by_calculix`, all of its teeth.
RING = calculix.RING._replace(row=0)
_GAUSS = np.polynomial.legendre.leggauss(3)


def _shapes(xi, eta):
    """Eight shape functions of a quadrilateral on [-1, 1]^2 and their slopes, shape (8,), (2, 8)."""
    value, slope = [], [[], []]
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        value.append(0.25 * (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1))
        slope[0].append(0.25 * a * (1 + b * eta) * (2 * a * xi + b * eta))
        slope[1].append(0.25 * b * (1 + a * xi) * (a * xi + 2 * b * eta))
    for b in (-1, 1, -1, 1):
        along = b in (-1, 1) and len(value) % 2 == 0  # the middles of the first and third edge
        s, t, sign = (xi, eta, (-1, 1, 1, -1)[len(value) - 4]) if along else (eta, xi, (-1, 1, 1, -1)[len(value) - 4])
        value.append(0.5 * (1 - s * s) * (1 + sign * t))
        own, other = -s * (1 + sign * t), 0.5 * sign * (1 - s * s)
        slope[0].append(own if along else other)
        slope[1].append(other if along else own)
    return np.array(value), np.array(slope)


def rigid(points):
    """Three translations and three turns, shape (6, 3, nodes)."""
    x, y, z = points
    one, none = np.ones_like(x), np.zeros_like(x)
    return np.array([
        [one, none, none], [none, one, none], [none, none, one],
        [none, -z, y], [z, none, -x], [-y, x, none],
    ])  # fmt: skip


def even_tractions(mesh):
    """Nodal forces of tractions on the outer cylinder as even as rigid motions, shape (6, 3, nodes)."""
    faces = mesh.faces(mesh.section.edges("bore")).reshape(8, -1)
    at, motions = mesh.points[:, faces], rigid(mesh.points)
    found = np.zeros_like(motions)
    for xi, a in zip(*_GAUSS, strict=True):
        for eta, b in zip(*_GAUSS, strict=True):
            value, slope = _shapes(xi, eta)
            one, other = np.einsum("dk,ckf->dcf", slope, at)
            area = a * b * np.linalg.norm(np.cross(one, other, axis=0), axis=0)
            here = np.einsum("k,rckf->rcf", value, motions[:, :, faces]) * area
            for k in range(8):
                for r in range(6):
                    for c in range(3):
                        np.add.at(found[r, c], faces[k], value[k] * here[r, c])
    return found


def held_by_pins(mesh, support, heights):
    """Weights of nodes in what each pin holds: over its arc in space outward and along the circle, in so many
    polynomials along the face, and the mean along the axis; shape (pins (2 heights + 1), 3, nodes).
    """
    faces = mesh.faces(mesh.section.edges("bore")).reshape(8, -1)
    at, half = mesh.points[:, faces], 0.5 * support.width / RING.bore
    middle = support.angle + 2.0 * np.pi * np.arange(support.pins) / support.pins
    found = np.zeros((support.pins, 2 * heights + 1, 3, mesh.points.shape[1]))
    steps = 24
    places = (2.0 * np.arange(steps) + 1.0) / steps - 1.0
    for xi in places:
        for eta in places:
            value, slope = _shapes(xi, eta)
            one, other = np.einsum("dk,ckf->dcf", slope, at)
            area = (2.0 / steps) ** 2 * np.linalg.norm(np.cross(one, other, axis=0), axis=0)
            x, y, z = np.einsum("k,ckf->cf", value, at)
            along = np.polynomial.legendre.legvander(2.0 * z / calculix.FACE, heights - 1).T
            off = np.mod(np.arctan2(x, y) - middle[:, None] + np.pi, 2.0 * np.pi) - np.pi
            for pin, angle in enumerate(middle):
                on = np.flatnonzero(np.abs(off[pin]) < half)
                if not on.size:
                    continue
                share = area[on] / (support.width * calculix.FACE)
                ways = np.array([[np.sin(angle), np.cos(angle), 0.0], [np.cos(angle), -np.sin(angle), 0.0]])
                for k in range(8):
                    nodes, weight = faces[k, on], value[k] * share
                    for j in range(heights):
                        for i, way in enumerate(ways):
                            for c in range(2):
                                np.add.at(found[pin, i * heights + j, c], nodes, weight * along[j, on] * way[c])
                    np.add.at(found[pin, 2 * heights, 2], nodes, weight)
    return found.reshape(-1, 3, mesh.points.shape[1])


def equations(held):
    """*EQUATION cards that keep weighted sums at zero, each with an unknown of its own that no other has."""
    from scipy.linalg import qr

    rows = held.transpose(0, 2, 1).reshape(held.shape[0], -1)
    used = np.flatnonzero(np.abs(rows).max(axis=0) > 0.0)
    part = rows[:, used]
    own = qr(part, mode="r", pivoting=True)[1][: rows.shape[0]]
    solved = np.linalg.solve(part[:, own], part)
    deck = []
    for i, mine in enumerate(own):
        row = solved[i]
        row[own] = 0.0
        others = np.flatnonzero(np.abs(row) > 1e-13 * np.abs(row).max())
        terms = [(used[mine], 1.0), *((used[j], row[j]) for j in others)]
        deck += ["*EQUATION", f"{len(terms)}"]
        deck += [f"{dof // 3 + 1}, {dof % 3 + 1}, {weight:.12e}" for dof, weight in terms]
    return deck


def solve(folder, mesh, forces, ccx="ccx", held=None):
    """Displacements (3, P) in units of force / (E module) of a ring on pins, of which `held_by_pins` says what is held,
    or of one whose outer cylinder does not move on average.
    """
    tractions, motions = even_tractions(mesh), rigid(mesh.points)
    inverse = np.linalg.inv(np.einsum("rcn,scn->rs", motions, tractions))
    applied = forces - np.tensordot(inverse @ np.tensordot(motions, forces, 2), tractions, 1)
    outer = mesh.nodes_of(mesh.section.edges("bore"))
    place = mesh.points[:, outer]
    top, side = outer[np.argmax(place[1] - place[2])], outer[np.argmax(place[0] - place[2])]
    far = outer[np.argmax(place[2] - place[1])]
    deck = ["*NODE, NSET=NALL"]
    deck += [f"{i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(mesh.points.T, 1)]
    number = 0
    for kind, cells in (("C3D15", mesh.wedges), ("C3D20", mesh.hexahedra)):
        deck.append(f"*ELEMENT, TYPE={kind}, ELSET=EALL")
        for i, nodes in enumerate((cells + 1).T, number + 1):
            row = list(map(str, [i, *nodes]))
            deck += [", ".join(row[:12]) + ",", ", ".join(row[12:])]
        number += cells.shape[1]
    if held is None:
        deck += ["*BOUNDARY", f"{top + 1}, 1, 3", f"{side + 1}, 2, 3", f"{far + 1}, 1, 1"]
    else:
        deck, applied = deck + equations(held), forces
    deck += ["*MATERIAL, NAME=ONE", "*ELASTIC", f"1.0, {calculix.NU}", "*SOLID SECTION, ELSET=EALL, MATERIAL=ONE"]
    deck += ["*STEP", "*STATIC", "*CLOAD"]
    deck += [f"{n + 1}, {c + 1}, {applied[c, n]:.12e}" for c in range(3) for n in np.flatnonzero(applied[c])]
    deck += ["*NODE PRINT, NSET=NALL", "U", "*END STEP"]
    (folder / "ring.inp").write_text("\n".join(deck) + "\n", encoding="ascii")
    alone = dict(os.environ, OMP_NUM_THREADS="1")
    subprocess.run([ccx, "ring"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=alone)
    moved = np.full_like(mesh.points, np.nan)
    for line in (folder / "ring.dat").read_text().splitlines():
        if row := re.match(r"\s*(\d+)\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s*$", line):
            moved[:, int(row[1]) - 1] = float(row[2]), float(row[3]), float(row[4])
    mean = np.tensordot(inverse.T @ np.tensordot(tractions, moved, 2), motions, 1)
    return moved - mean if held is None else moved
