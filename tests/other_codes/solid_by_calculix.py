"""Solid gears by CalculiX: the references of `make_solid_calculix.py` and of the test that runs it on a small deck.

Nothing of fegear's solution is used: CalculiX's quadratic wedges and hexahedra on an explicit mesh of all teeth, all
sides joined node by node, its own solver. The shape is fegear's plane spur section, turned with the helix. Stress comes
from the displacements of the fillet itself (CalculiX's nodal stresses, extrapolated from inside, are 1 % low).
"""

import math
import re
import subprocess
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from fegear.fem.plane.gear_section import uneven_section
from fegear.fem.plane.root_stress import extreme
from fegear.fem.solid.extruded import extruded, pressed_band
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.rack import BasicRack
from fegear.output.solid_mesh_files import write_solid_inp

TEETH, SHIFT, BORE, FACE = 10, 0.55, 2.5, 4.0
RADIUS, HALF_WIDTH, SPACING = 5.5, 0.25, 0.5
TOOTH = Tooth(TEETH, BasicRack(1.0, 1.25, 0.25), SHIFT)


class Shape(NamedTuple):
    """A gear: its tooth, where it is held and where bands press [modules]; teeth of a row with free sides, or 0."""

    tooth: InvoluteSide
    bore: float
    radius: float
    row: int = 0


EXTERNAL = Shape(TOOTH, BORE, RADIUS)
#: Five of the 20 teeth of a ring that is held 1.5 modules outside its root circle.
RING = Shape(InternalTooth(20, PinionCutter(14, 0.4, 1.0, tip_radius=0.25), profile_shift=-0.5), 13.0, 10.3, 5)
YOUNG = 200e9
NU = 0.3
#: Hats on tooth 0 and on its neighbours, by name: tooth, station of the top along the face [modules].
BANDS = {
    "middle": (0, 0.0),
    "beside": (0, 1.0),
    "front": (0, 0.5 * FACE),
    "back": (0, -0.5 * FACE),
    "next": (1, 0.0),
    "previous": (-1, 0.0),
    "next_front": (1, 0.5 * FACE),
}
#: Which of them are loaded.
LOADED = ("middle", "front", "back")
#: Where the largest fillet stress is wanted [modules].
STATIONS = np.array([-1.9, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 1.9])
#: Edges of the other teeth: halved they change the next tooth's deflection by 5e-4, those of tooth 0 by less.
OTHERS = 2.8
_GAUSS = np.polynomial.legendre.leggauss(2)[0]


def twist_of(beta, shape=EXTERNAL):
    """tau of a helix angle on the reference circle [rad/module]."""
    return math.tan(beta) / shape.tooth.pitch_radius


def hat(place):
    """Where the hat of a band rises and falls."""
    half = 0.5 * FACE
    return max(place - SPACING, -half), place, min(place + SPACING, half)


def solid(beta, coarseness, ends, inside, shape=EXTERNAL):
    """The solid and the nodal forces of each band; its layers from an end of the face, and inside it [modules]."""
    depth = 0.5 * FACE - np.cumsum(ends)
    inner = np.linspace(-depth[-1], depth[-1], round(2.0 * depth[-1] / inside) + 1)
    stations = np.unique(np.round([-0.5 * FACE, *-depth, *inner, *depth, 0.5 * FACE], 12))
    section = uneven_section(shape.tooth, shape.bore, coarseness, max(coarseness, OTHERS), row=shape.row)
    mesh = extruded(section, stations, twist_of(beta, shape))
    bands = {
        name: pressed_band(mesh, shape.tooth, shape.radius, HALF_WIDTH, hat(place), tooth)
        for name, (tooth, place) in BANDS.items()
    }
    return mesh, bands


def solve(folder, name, mesh, bands, loaded, ccx="ccx", timeout=None, shape=EXTERNAL):
    """Displacements (3, P), module 1 and E = 1, of the printed nodes by load; NaN elsewhere."""
    gear = Gear(shape.tooth, 1e-3, shape.bore * 1e-3, FACE * 1e-3, Material(YOUNG, NU))
    return solved(folder, name, gear, mesh, bands, loaded, (-1, 0, 1), ccx, timeout)


def solved(folder, name, gear, mesh, bands, loaded, teeth, ccx="ccx", timeout=None):
    """As `solve`, of a gear or a rack of module 1 mm, with the numbers of the printed teeth."""
    boundaries = mesh.section.boundaries
    wanted = [boundaries[n, k] for n in ("flank", "fillet", "back_fillet") for k in teeth]
    printed = {"WANTED": np.unique(np.concatenate([mesh.nodes_of(edges) for edges in wanted]))}
    force = 1e3
    write_solid_inp(folder / f"{name}.inp", gear, mesh, {b: bands[b] for b in loaded}, force, printed)
    subprocess.run([ccx, name], cwd=folder, check=True, stdout=subprocess.DEVNULL, timeout=timeout)
    found, row = [], re.compile(r"\s*(\d+)((?:\s+[-+]?\d\.\d+E[-+]\d+){3})\s*$")
    for line in (folder / f"{name}.dat").read_text().splitlines():
        if "displacements" in line:
            found.append(np.full((3, mesh.points.shape[1]), np.nan))
        elif match := row.match(line):
            found[-1][:, int(match[1]) - 1] = [float(x) for x in match[2].split()]
    scale = YOUNG * 1e-6 / force
    return {b: u * scale for b, u in zip(loaded, found, strict=True)}


def deflection(u, forces):
    """Mean deflection of a band along the transverse line of action."""
    at = np.any(forces != 0.0, axis=0)
    return float((u[:, at] * forces[:, at]).sum())


def surface_stress(mesh, u, edges, side=1, outward=None):
    """Stress on a free surface over edges of the section, at the Gauss points of its faces, E = 1.

    Returns
    -------
    zeta, arc : ndarray, shape (2 L,), (2 n,)
    stress : ndarray, shape (3, 2 L, 2 n)
        Tangential (in the transverse section), across it in the surface, and shear between both.
    """
    height = side * np.hypot(*mesh.section.points) if outward is None else outward
    edges = edges[:, np.argsort(height[edges[2]])]
    up = height[edges[0]] < height[edges[1]]
    edges = np.where(up, edges, edges[[1, 0, 2]])
    nodes = mesh.faces(edges)
    g = 0.5 + 0.5 * _GAUSS
    along, across = _slopes(g)
    x, v = mesh.points[:, nodes], u[:, nodes]
    x1, x2 = (np.einsum("ckln,kab->clanb", x, d) for d in (across, along))
    v1, v2 = (np.einsum("ckln,kab->clanb", v, d) for d in (across, along))
    # x1 along the section's edge, x2 along the face; both tangents of the surface.
    t = x1 / np.sqrt((x1**2).sum(axis=0))
    b = x2 - (x2 * t).sum(axis=0) * t
    b /= np.sqrt((b**2).sum(axis=0))
    # du/dt = du/d1 / |x1|; du/db from what of x2 is not along t.
    dt = v1 / np.sqrt((x1**2).sum(axis=0))
    db = (v2 - (x2 * t).sum(axis=0) * dt) / (x2 * b).sum(axis=0)
    tt, bb = (dt * t).sum(axis=0), (db * b).sum(axis=0)
    shear = (dt * b).sum(axis=0) + (db * t).sum(axis=0)
    stress = np.stack([(tt + NU * bb) / (1 - NU**2), (bb + NU * tt) / (1 - NU**2), shear / (2 * (1 + NU))])
    layers, n = mesh.layers, edges.shape[1]
    z = mesh.stations
    zeta = (z[:-1, None] + np.diff(z)[:, None] * g).reshape(-1)
    p = mesh.section.points
    length = np.hypot(*(p[:, edges[2]] - p[:, edges[0]])) + np.hypot(*(p[:, edges[1]] - p[:, edges[2]]))
    start = np.concatenate([[0.0], np.cumsum(length)])[:-1]
    arc = (start[:, None] + length[:, None] * g).reshape(-1)
    return zeta, arc, stress.reshape(3, 2 * layers, 2 * n)


def _slopes(g):
    """Derivatives of the eight shape functions along the face and along the edge, shape (8, 2 along face, 2 edge)."""
    eta, xi = np.meshgrid(2 * g - 1, 2 * g - 1, indexing="ij")
    d_xi, d_eta = [], []
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        d_xi.append(0.25 * a * (1 + b * eta) * (2 * a * xi + b * eta))
        d_eta.append(0.25 * b * (1 + a * xi) * (a * xi + 2 * b * eta))
    d_xi += [-xi * (1 - eta), 0.5 * (1 - eta**2), -xi * (1 + eta), -0.5 * (1 - eta**2)]
    d_eta += [-0.5 * (1 - xi**2), -(1 + xi) * eta, 0.5 * (1 - xi**2), -(1 - xi) * eta]
    return 2 * np.array(d_eta), 2 * np.array(d_xi)


def largest_along(mesh, u, name, sign, side=1, tooth=0, outward=None):
    """Largest tangential stress over one fillet of a tooth at `STATIONS`; outward: height of the section's nodes."""
    zeta, arc, stress = surface_stress(mesh, u, mesh.section.boundaries[name, tooth], side, outward)
    value, _ = extreme(stress[0].T, arc, sign, arc[-1])
    return CubicSpline(zeta, value)(STATIONS)


def told(mesh, bands, fields, side=1):
    """The numbers of a reference."""
    return {
        "nodes": mesh.points.shape[1],
        "layers": mesh.layers,
        "deflection": {
            loaded: {name: deflection(u, forces) for name, forces in bands.items()} for loaded, u in fields.items()
        },
        "tension": {loaded: largest_along(mesh, u, "fillet", 1, side).tolist() for loaded, u in fields.items()},
        "compression": {
            loaded: largest_along(mesh, u, "back_fillet", -1, side).tolist() for loaded, u in fields.items()
        },
    }
