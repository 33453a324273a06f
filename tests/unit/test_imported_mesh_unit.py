"""A user's own tooth mesh: the same answers, and clear words when something is missing."""

import hashlib
import re
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.imported_mesh import check_triangles, read_mesh_file, read_sector_mesh
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.table import stiffness_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

MESHES = Path(__file__).parents[2] / "meshes"


def four_square():
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, 3.175e-3, 0.5 * tooth.root_radius * 3.175e-3)


def shifted():
    tooth = Tooth(40, BasicRack.named("A"), 0.2)
    return Gear(tooth, 2e-3, 0.8 * tooth.root_radius * 2e-3)


def test_meshes_are_the_ones_their_page_describes():
    page = (MESHES / "README.md").read_text()
    for name, digest in re.findall(r"`([\w.]+\.(?:msh|inp))` \|.*?`([0-9a-f]{64})`", page):
        assert hashlib.sha256((MESHES / name).read_bytes()).hexdigest() == digest


def test_nothing_is_printed_where_a_mesh_is_read(capsys):
    """A plan of a mesh of gmsh began with an empty line: what another format of that ending had to say."""
    for path in sorted(MESHES.glob("*.msh")):
        assert len(read_mesh_file(path).points)
    assert capsys.readouterr().out == ""


@pytest.mark.dear("four_square-four_square_test_gear.msh", "shifted-shifted_40_teeth.inp")
@pytest.mark.parametrize(
    ("make", "name"), [(four_square, "four_square_test_gear.msh"), (shifted, "shifted_40_teeth.inp")]
)
def test_a_foreign_mesh_gives_the_generated_mesh_s_answers_within_both_error_estimates(make, name):
    gear = make()
    mesh = read_sector_mesh(MESHES / name, gear.tooth, gear.module, gear.bore_radius)
    radii = np.linspace(gear.form_radius + 0.1 * gear.module, gear.tip_radius, 7)
    own = stiffness_table(gear, radii, 0.025 * gear.module)
    foreign = stiffness_table(gear, radii, 0.025 * gear.module, influence=solve_gear(gear, mesh=mesh))
    # The foreign fillets have edges of about 0.07 module, which is good for 1 % in stress, not for 0.5 %.
    for quantity, column, limit in (
        ("c_self", "c_self", 3e-3),
        ("c_next", "c_neighbour", 3e-4),
        ("root_tension", "root_tension", 1e-2),
    ):
        a, b = getattr(own, quantity), getattr(foreign, quantity)
        scale = np.abs(own.c_self if quantity == "c_next" else a)
        assert (np.abs(a - b) < limit * scale).all()
        assert (np.abs(a - b) < own.errors[column] + foreign.errors[column] + 2e-3 * scale).all()


def _written(tmp_path, change):
    data = meshio.read(MESHES / "shifted_40_teeth.inp")
    change(data)
    data.write(tmp_path / "bad.inp", float_fmt=".12e")
    return tmp_path / "bad.inp"


def _drop_fillet(data):
    del data.point_sets["fillet"]


def _invert(data):
    data.cells[0].data[7] = data.cells[0].data[7][[0, 2, 1, 5, 4, 3]]


def _move_side(data):
    nodes = data.point_sets["side_b"]
    inside = nodes[np.argsort(np.hypot(*data.points[nodes, :2].T))[4]]
    data.points[inside, :2] *= 1.01


def _inner(data):
    """An element far from every boundary: none of its nodes is named."""
    named = np.unique(np.concatenate([np.asarray(nodes) for nodes in data.point_sets.values()]))
    cells = data.cells[0].data
    middle = data.points[:, :2].mean(axis=0)
    centres = data.points[cells[:, :3]].mean(axis=1)[:, :2]
    free = ~np.isin(cells, named).any(axis=1)
    return np.flatnonzero(free)[np.argmin(np.hypot(*(centres[free] - middle).T))]


def _nan_node(data):
    data.points[data.cells[0].data[_inner(data), 0], 0] = np.nan


def _twice(data):
    cells = data.cells[0].data
    data.cells[0].data = np.vstack([cells, cells[[3]], cells[[_inner(data)]][:, [1, 2, 0, 4, 5, 3]]])


def _hole(data):
    data.cells[0].data = np.delete(data.cells[0].data, _inner(data), axis=0)


def _seam(data):
    """One corner of one element on a node of its own at the same place."""
    cells = data.cells[0].data
    element = _inner(data)
    data.points = np.vstack([data.points, data.points[cells[element, 0]]])
    cells[element, 0] = len(data.points) - 1


def _loose_piece(data):
    cells = data.cells[0].data
    count = len(data.points)
    data.points = np.vstack([data.points, data.points[cells[5]] + [500.0, 0.0, 0.0]])
    data.cells[0].data = np.vstack([cells, np.arange(count, count + 6)])


def _in_space(data):
    data.points[:, 2] = 0.1 * data.points[:, 1]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_drop_fillet, 'no group "fillet"'),
        (_invert, "1 inverted elements \\(one at x = .* mm\\)"),
        (_move_side, "have different nodes, so that sectors cannot be"),
        (_nan_node, "1 nodes with invalid coordinates|cannot be read"),
        (_twice, "has 2 duplicate elements \\(one at x = "),
        (_hole, "has 1 holes or unconnected parts \\(one at x = "),
        (_seam, "coincident nodes \\(one at x = "),
        (_loose_piece, "has 1 holes or unconnected parts \\(one at x = "),
        (_in_space, "must be in a plane z = constant"),
    ],
)
def test_broken_meshes_are_refused_in_words(tmp_path, change, words):
    gear = shifted()
    with pytest.raises(InputError, match=words):
        solve_gear(gear, mesh=read_sector_mesh(_written(tmp_path, change), gear.tooth, gear.module, gear.bore_radius))


def test_elements_on_nodes_that_are_not_there_are_refused():
    data = meshio.read(MESHES / "shifted_40_teeth.inp")
    cells = data.cells[0].data.T.copy()
    cells[1, 4] = 10**6
    with pytest.raises(InputError, match="has elements with missing nodes \\(it has"):
        check_triangles(data.points.T / 2.0, cells, 2e-3, lambda rule, remedy: InputError("mesh", "m", rule, remedy))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda g: {"bore_radius": 0.9 * g.bore_radius},
            "bore at radius 30.32 to 30.32 mm, in the case at 27.28.*set bore",
        ),
        (
            lambda g: {"tooth": replace(g.tooth, rack=BasicRack.named("C"))},
            "fillet deviating up to 0.0.* at radius",
        ),
        (
            lambda g: {"tooth": replace(g.tooth, rack=replace(g.tooth.rack, dedendum=1.3))},
            "fillet deviating up to",
        ),
        (lambda g: {"tooth": replace(g.tooth, tip_radius=g.tooth.tip_radius - 0.2)}, "flank ending at radius 42.4"),
    ],
)
def test_a_bore_a_fillet_or_a_tip_that_contradicts_the_case_is_refused(change, words):
    gear = shifted()
    other = replace(gear, **change(gear))
    with pytest.raises(InputError, match=words) as refusal:
        read_sector_mesh(MESHES / "shifted_40_teeth.inp", other.tooth, other.module, other.bore_radius)
    assert "\n" not in str(refusal.value)


def test_a_fillet_of_the_user_s_own_is_taken_as_the_mesh_has_it():
    gear = shifted()
    other = replace(gear, tooth=replace(gear.tooth, rack=BasicRack.named("C")))
    radii = np.array([gear.pitch_radius])
    stress = []
    for known, own in ((gear, False), (other, True)):
        mesh = read_sector_mesh(
            MESHES / "shifted_40_teeth.inp", known.tooth, known.module, known.bore_radius, own_fillet=own
        )
        solved = solve_gear(known, mesh=mesh, estimate_error=False)
        stress.append(stiffness_table(known, radii, 0.025 * known.module, influence=solved).root_tension[0])
    assert stress[1] == pytest.approx(stress[0], rel=1e-9)


def test_a_mesh_of_another_gear_or_none_at_all_is_refused():
    gear = four_square()
    with pytest.raises(InputError, match="involute"):
        read_sector_mesh(MESHES / "shifted_40_teeth.inp", gear.tooth, gear.module, gear.bore_radius)
    with pytest.raises(InputError, match="file not found"):
        read_sector_mesh(MESHES / "nothing.msh", gear.tooth, gear.module, gear.bore_radius)
    with pytest.raises(InputError, match="cannot be read"):
        read_sector_mesh(MESHES / "README.md", gear.tooth, gear.module, gear.bore_radius)


def test_three_node_triangles_are_read_too(tmp_path):
    gear = shifted()
    data = meshio.read(MESHES / "shifted_40_teeth.inp")
    straight = meshio.Mesh(data.points, [("triangle", data.cells[0].data[:, :3])], point_sets=data.point_sets)
    for name, nodes in straight.point_sets.items():
        straight.point_sets[name] = np.intersect1d(nodes, np.unique(straight.cells[0].data))
        assert straight.point_sets[name].size
    straight.write(tmp_path / "straight.inp", float_fmt=".12e")
    mesh = read_sector_mesh(tmp_path / "straight.inp", gear.tooth, gear.module, gear.bore_radius)
    radius = [gear.pitch_radius]
    linear = solve_gear(gear, mesh=mesh, estimate_error=False).self_compliance(radius, 5e-5)
    assert linear == pytest.approx(solve_gear(gear).self_compliance(radius, 5e-5), rel=5e-3, abs=0.0)


@pytest.mark.parametrize("corners", [3, 6])
def test_a_mesh_whose_triangles_are_all_clockwise_and_whose_groups_are_numbers_at_points_is_the_same(tmp_path, corners):
    gear = shifted()
    data = meshio.read(MESHES / "shifted_40_teeth.inp")
    cells = data.cells[0].data[:, :corners]
    kind, used = {3: "triangle", 6: "triangle6"}[corners], np.unique(cells)
    groups = {name: np.intersect1d(nodes, used) for name, nodes in data.point_sets.items()}
    at_points = {name: np.isin(np.arange(len(data.points)), nodes).astype(float) for name, nodes in groups.items()}
    turned = cells[:, [0, 2, 1] if corners == 3 else [0, 2, 1, 5, 4, 3]]
    meshio.Mesh(data.points, [(kind, cells)], point_sets=groups).write(tmp_path / "a.inp", float_fmt=".16e")
    meshio.Mesh(data.points, [(kind, turned)], point_data=at_points).write(tmp_path / "b.vtu")
    one, other = (
        read_sector_mesh(tmp_path / name, gear.tooth, gear.module, gear.bore_radius) for name in ("a.inp", "b.vtu")
    )
    np.testing.assert_allclose(one.points, other.points, atol=1e-12)
    middles = [np.sort(mesh.points[:, mesh.triangles[3:]].reshape(2, -1)) for mesh in (one, other)]
    np.testing.assert_allclose(*middles, atol=1e-12)
    assert one.edges.keys() == other.edges.keys()
    for name, edges in one.edges.items():
        assert sorted(map(tuple, np.sort(edges, axis=0).T)) == sorted(map(tuple, np.sort(other.edges[name], axis=0).T))
    a, b, c = (other.points[:, node] for node in other.triangles[:3])
    assert ((b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])).all()
