"""Why fegear's deflections are smaller than NASA's in Mark's Table 1: the table docs/studies/mark_table1.csv.

Run as ``python benchmarks/mark_table1_study.py`` (two minutes). All 30 rows are computed with every choice that the
report leaves open: how many teeth its sector had and whether its sides were free, plane stress or strain, a load on a
point of the mesh instead of a Hertzian pressure, kind and size of the elements, and where the body was fixed.
Everything here is scikit-fem's own assembly of the gear's sector mesh, so that nothing but the mesh is shared with
fegear's solution; only the rows "Hertz" take that of the case ``sources/mark_table1_fe``, plus what the sector adds to
a whole gear.
"""

from __future__ import annotations

import csv
import math
import sys
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse.linalg import splu
from skfem import (
    Basis,
    ElementQuad1,
    ElementQuadS2,
    ElementTriP1,
    ElementTriP2,
    ElementVector,
    MeshQuad,
    MeshTri,
    asm,
)
from skfem.models.elasticity import linear_elasticity

import fegear
from fegear.case.reading import read_scene
from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.whole_gear import whole_gear

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.whole_gear import WholeGear
    from fegear.geometry.gear import Gear, Plane

ROOT = Path(__file__).resolve().parents[1]
CASE = ROOT / "cases" / "sources" / "mark_table1_fe.toml"
PRINT = ROOT / "tests" / "data" / "mark_table1_loads_deflections.csv"
TABLE = ROOT / "docs" / "studies" / "mark_table1.csv"
#: The first line of the table.
COMMAND = "# python benchmarks/mark_table1_study.py"
HEAD = (
    "teeth", "sides", "plane", "load", "element", "node_spacing [modules]", "fixed_at [root radii]", "median [%]",
    "lowest [%]", "highest [%]", "scatter [%]",
)  # fmt: skip
#: Element, and by how much its nodes on the flank are closer than the triangles' vertices.
ELEMENTS = {
    "3-node triangle": (ElementTriP1, 1), "6-node triangle": (ElementTriP2, 2),
    "4-node quadrilateral": (ElementQuad1, 2), "8-node quadrilateral": (ElementQuadS2, 4),
}  # fmt: skip


@dataclass(frozen=True)
class Model:
    """One choice of what the report leaves open; 28 teeth are the whole gear."""

    teeth: int = 28
    sides: str = "free"
    plane: Plane = "stress"
    element: str = "6-node triangle"
    edge: float = 0.1
    fixed_at: float = 0.5


@cache
def test_gear() -> Gear:
    """The case's gear."""
    return read_scene(CASE).gears["test"]


@cache
def printed() -> tuple[Array, Array, Array]:
    """Roll angles [rad], loads [N] and deflections [m] of Table 1."""
    rows = np.genfromtxt(PRINT, delimiter=",", names=True)
    return rows["roll_rad"], rows["load_N"], rows["deflection_mm"] * 1e-3


@cache
def ring(edge: float, fixed_at: float) -> WholeGear:
    """The whole gear in even triangles, as long at the flank as the model's edges."""
    size = {f"{place}_edge_length": edge for place in ("root", "flank", "tip", "junction")}
    settings = replace(MeshSettings(), **size, back_edge_length=edge, root_fraction=10.0, order=2)
    tooth = test_gear().tooth
    return whole_gear(mesh_sector(tooth, fixed_at * tooth.root_radius, settings, frontal=True))


def point_compliance(model: Model) -> Array:
    """Deflection of the loaded point along the load at Table 1's roll angles, per load and 1/(E b)."""
    gear, whole, z = test_gear(), ring(model.edge, model.fixed_at), test_gear().teeth
    centre = np.arctan2(*whole.points[:, whole.triangles[:3]].mean(axis=1))
    inside = np.abs(centre) < math.pi * model.teeth / z
    mesh, element = _mesh(whole.points, whole.triangles[:3, inside], model.element)
    lam, mu = lame(gear.material.poisson_ratio, model.plane)
    basis = Basis(mesh, ElementVector(element))
    stiffness = asm(linear_elasticity(lam, mu), basis).tocsc()
    place, numbers = _nodes(basis)
    held = _held(model, place, z)
    free = np.setdiff1d(np.arange(basis.N), numbers[:, held].ravel())
    flank, roll = _flank(place, gear)
    force = -_normal(place[:, flank], gear)
    loads = np.zeros((basis.N, flank.size))
    loads[numbers[:, flank], np.arange(flank.size)] = force
    moved = np.zeros_like(loads)
    moved[free] = splu(stiffness[free][:, free]).solve(loads[free])
    own = np.einsum("cp,cp->p", moved[numbers[:, flank], np.arange(flank.size)], force)
    return np.interp(printed()[0], roll, own)


def _mesh(points: Array, triangles: Index, element: str) -> tuple[Any, Any]:
    """The model's elements: the triangles, or each as three quadrilaterals about its centre."""
    used, t = np.unique(triangles, return_inverse=True)
    corners, t = points[:, used], t.reshape(triangles.shape)
    kind = ELEMENTS[element][0]()
    plain = MeshTri(corners, t)
    if "triangle" in element:
        return plain, kind
    count, edges = corners.shape[1], plain.facets
    middle = corners[:, edges].mean(axis=1)
    centre = corners[:, t].mean(axis=1)
    e, c = count + plain.t2f, count + edges.shape[1] + np.arange(t.shape[1])  # facets 0-1, 1-2, 0-2
    quads = np.hstack([np.stack(q) for q in ((plain.t[0], e[0], c, e[2]), (plain.t[1], e[1], c, e[0]),
                                             (plain.t[2], e[2], c, e[1]))])  # fmt: skip
    everything = np.hstack([corners, middle, centre])
    x, y = everything[:, quads]
    area = sum(x[i] * y[(i + 1) % 4] - x[(i + 1) % 4] * y[i] for i in range(4))
    quads[:, area < 0.0] = quads[::-1, area < 0.0]
    return MeshQuad(everything, quads), kind


def _nodes(basis: Any) -> tuple[Array, Index]:
    """Places of all nodes, and the numbers of their two displacements."""
    dofs = basis.dofs
    numbers = [dofs.nodal_dofs.reshape(2, -1)]
    if dofs.facet_dofs.size:
        numbers.append(dofs.facet_dofs.reshape(2, -1))
    both = np.hstack(numbers)
    return basis.doflocs[:, both[0]], both


def _held(model: Model, place: Array, teeth: int) -> Index:
    radius, angle = np.hypot(*place), np.arctan2(*place)
    bore = radius < model.fixed_at * test_gear().tooth.root_radius * (1.0 + 1e-3)
    sides = np.abs(np.abs(angle) - math.pi * model.teeth / teeth) < 1e-6
    return np.flatnonzero(bore | sides if model.sides == "fixed" and model.teeth < teeth else bore)


def _flank(place: Array, gear: Gear) -> tuple[Index, Array]:
    """Nodes on the loaded flank of tooth 0, by roll angle, and these."""
    tooth, radius = gear.tooth, np.hypot(*place)
    low, high = (r / gear.module for r in gear.involute_radii)
    near = np.flatnonzero((radius > low) & (radius < high) & (place[0] > 0.0))
    half = tooth.half_thickness_angle(radius[near])
    off = np.abs(np.arctan2(*place[:, near]) - half) * radius[near]
    on = near[off < 3e-3]
    roll = tooth.roll(radius[on])
    order = np.argsort(roll)
    return on[order], roll[order]


def _normal(place: Array, gear: Gear) -> Array:
    """Outward normals of the involute."""
    radius = np.hypot(*place)
    cosine = gear.base_radius / gear.module / radius
    radial, around = place / radius, np.stack([place[1], -place[0]]) / radius
    return cosine * around + np.sqrt(1.0 - cosine**2) * radial


def against_print(deflection: Array) -> tuple[float, float, float, float]:
    """Median, lowest and highest difference from Table 1 [%], and the scatter about a common factor."""
    ratio = deflection / printed()[2]
    off = 100.0 * (ratio - 1.0)
    scatter = 100.0 * float(np.std(ratio / np.median(ratio)))
    return float(np.median(off)), float(off.min()), float(off.max()), scatter


def deflection(compliance: Array) -> Array:
    """Under the loads of Table 1 [m]."""
    gear = test_gear()
    return printed()[1] * compliance / (gear.material.young_modulus * gear.face_width)


@cache
def by_hertz(plane: Plane) -> Array:
    """Deflections of the whole gear under Hertzian pressures, as the case gives them [m]."""
    found = fegear.run(CASE, {"results": ["relief"], "gear.test.plane": plane}, progress=False)
    table = {column.head: column.values for column in found.tables["relief_points_I_test"].columns}
    return np.asarray(table["deflection [um]"]) * 1e-6


def rows() -> list[tuple[str | float, ...]]:
    """All rows of the table."""
    found: list[tuple[str | float, ...]] = []

    def add(model: Model, load: str, values: Array) -> None:
        point = load == "point"
        spacing = model.edge / ELEMENTS[model.element][1]
        kind = (model.element, round(spacing, 4)) if point else ("-", "-")
        body = "whole" if model.teeth == test_gear().teeth else model.teeth
        sides = "-" if body == "whole" else model.sides
        rounded = (round(value, 1) for value in against_print(values))
        found.append((body, sides, model.plane, load, *kind, model.fixed_at, *rounded))
        print(*found[-1], flush=True)

    planes: tuple[Plane, ...] = ("stress", "strain")
    for plane in planes:
        whole = point_compliance(Model(plane=plane))
        for teeth, sides in ((28, "free"), (7, "free"), (5, "free"), (3, "free"), (5, "fixed"), (3, "fixed")):
            model = Model(teeth, sides, plane)
            added = point_compliance(model) - whole
            add(model, "Hertz", by_hertz(plane) + deflection(added))
            add(model, "point", deflection(whole + added))
    for element in ELEMENTS:
        for edge in (0.4, 0.2, 0.1):
            for teeth in (5, 3):
                model = Model(teeth, element=element, edge=edge)
                add(model, "point", deflection(point_compliance(model)))
    for fixed_at in (0.55, 0.6, 0.65, 0.7, 0.85):
        for teeth in (5, 3):
            model = Model(teeth, fixed_at=fixed_at)
            add(model, "point", deflection(point_compliance(model)))
    return found


def main() -> None:
    """Make the table."""
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        file.write(COMMAND + "\n")
        csv.writer(file, lineterminator="\n").writerows([HEAD, *rows()])


if __name__ == "__main__":
    sys.exit(main())
