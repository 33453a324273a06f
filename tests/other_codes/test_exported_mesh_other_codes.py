"""Exported meshes as other programs read them: meshio, and CalculiX solving the whole gear on the same mesh."""

from __future__ import annotations

import math
import re
import subprocess
from dataclasses import replace

import meshio
import numpy as np
import pytest

from fegear.fem.plane.gear_field import gear_field
from fegear.fem.plane.loaded_gear import loaded_gear, nodal_fields
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.whole_gear import whole_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.output.plane_mesh_files import write_field, write_inp, write_msh

GEAR = Gear(Tooth(17, BasicRack(1.0, 1.25, 0.25), profile_shift=0.2), 3.175e-3, 9e-3, 25.4e-3)
COARSE = MeshSettings().scaled(2.0)


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    folder, (whole, field) = tmp_path_factory.mktemp("meshes"), loaded_gear(GEAR, COARSE)
    write_msh(folder / "g.msh", GEAR, whole)
    write_field(folder / "g.vtu", GEAR, whole, field)
    write_inp(folder / "g.inp", GEAR, whole, field.forces)
    return {path.suffix: path for path in folder.iterdir()}


def test_the_ring_is_closed_without_seams():
    mesh = mesh_sector(GEAR.tooth, GEAR.bore_radius / GEAR.module, COARSE)
    whole = whole_gear(mesh)
    corners = whole.triangles[:3]
    edges = np.sort(np.hstack([corners[[0, 1]], corners[[1, 2]], corners[[2, 0]]]), axis=0)
    _, times = np.unique(edges, axis=1, return_counts=True)
    outer = sum(edge.shape[1] for name, edge in whole.boundaries.items() if not name.endswith("_0"))
    assert times.max() == 2
    assert (times == 1).sum() == outer
    # Euler: a ring has characteristic zero.
    assert np.unique(corners).size - times.size + corners.shape[1] == 0
    assert len(np.unique(np.round(whole.points, 9), axis=1).T) == whole.points.shape[1]


def test_gmsh_file_keeps_names_and_area(exported):
    mesh = meshio.read(exported[".msh"])
    assert set(mesh.field_data) >= {"gear", "bore", "flank", "fillet", "flank_0", "tip"}
    assert mesh.cells[0].type == "triangle6"
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    bore = mesh.field_data["bore"][0]
    tags = mesh.cell_data["gmsh:physical"]
    nodes = np.unique(
        np.vstack([c.data[t == bore] for c, t in zip(mesh.cells, tags, strict=True) if (t == bore).any()])
    )
    assert np.hypot(x[nodes], y[nodes]) == pytest.approx(GEAR.bore_radius * 1e3, rel=1e-9)


def test_vtu_file_holds_the_fields(exported):
    mesh = meshio.read(exported[".vtu"])
    assert mesh.point_data["displacement"].shape == mesh.points.shape
    assert mesh.point_data["von_mises"].max() > 0.5


def test_the_field_is_the_influence_functions_own_solution():
    second = replace(MeshSettings().scaled(0.7), order=2)
    mesh = mesh_sector(GEAR.tooth, GEAR.bore_radius / GEAR.module, second)
    nu, plane = GEAR.material.poisson_ratio, GEAR.plane_assumption
    radius = GEAR.pitch_radius / GEAR.module
    field = gear_field(GEAR.tooth, mesh, nu, plane, radius, 0.08)
    fine = solve_gear(GEAR, second, estimate_error=False).fine
    # The work of the nodal forces is the pressure-weighted mean deflection.
    work = float((field.forces * field.displacement[0]).sum())
    arc, patch = fine.place(radius, 0.08)
    loads = fine.flank.patches(arc, patch)
    assert work == pytest.approx(float(loads[:, 0] @ fine.compliance[0] @ loads[:, 0]), rel=1e-9)
    # Along the fillet only the tangential stress is left: nodal averages against the surface strain.
    fillet = np.unique(mesh.edges["fillet"])
    xx, yy, xy, _ = field.stress[0][:, fillet]
    largest = (0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy)).max()
    assert largest == pytest.approx(fine.largest_root_stress(0, "tension", radius, 0.08)[0][0], rel=0.02)
    # The bore is held, and the torque of the load arrives there: nothing moves across the gear's far side.
    assert np.abs(field.displacement[:, :, np.unique(mesh.edges["bore"])]).max() == 0.0
    assert np.abs(field.displacement[8]).max() < 0.2 * np.abs(field.displacement[0]).max()


@pytest.mark.dear
@pytest.mark.parametrize(
    ("plane", "face_width"), [("strain", 25.4e-3), pytest.param("stress", 1.5e-5, marks=pytest.mark.long)]
)
def test_calculix_solves_the_deck_to_the_same_displacements(plane, face_width, tmp_path, program):
    # CalculiX makes solid wedges of plane elements. In plane stress these bulge with the in-plane stress, and a thick
    # gear resists the slope of that bulge (4 % at 25 mm): only a thin slice is in plane stress there.
    ccx = program("ccx")
    gear = Gear(GEAR.tooth, GEAR.module, GEAR.bore_radius, face_width, GEAR.material, plane)
    whole, field = loaded_gear(gear, COARSE)
    write_inp(tmp_path / "g.inp", gear, whole, field.forces)
    subprocess.run([ccx, "g"], cwd=tmp_path, check=True, capture_output=True, timeout=300)
    rows = [line.split() for line in (tmp_path / "g.dat").read_text().splitlines()]
    found = {
        int(r[0]): np.array([float(r[1]), float(r[2])]) for r in rows if len(r) == 4 and re.fullmatch(r"\d+", r[0])
    }
    own = nodal_fields(gear, whole, field, 1e3)["displacement"][:, :2]
    nodes = whole.node_set("flank_0")
    assert set(found) >= {int(node) + 1 for node in nodes}
    theirs = np.array([found[int(node) + 1] for node in nodes])
    # CalculiX prints six to seven digits and integrates its expanded 3-D wedges as fegear integrates the triangles.
    assert np.abs(theirs - own[nodes]).max() < 1e-4 * np.abs(own[nodes]).max()
    assert math.isfinite(float(theirs.sum()))
