"""Ring gears on pins and in a spline, compared with the whole ring solved at once, and their limits and laws."""

import math

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from fegear.base.errors import FegearError
from fegear.case.reading import read_scene
from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.rim import _outer, rigid_motions
from fegear.fem.plane.sector_sides import _matching_sides
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.tooth_on_pins import over_the_teeth, tooth_on_pins
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rim_support import RimSupport

pytestmark = pytest.mark.last_bit

NU, TEETH = 0.3, 24
COARSE = MeshSettings(
    root_edge_length=0.3, root_fraction=0.8, flank_edge_length=0.4, tip_edge_length=0.2, junction_edge_length=0.2,
    back_edge_length=0.8, growth=0.6, tip_growth=0.6, side_growth=0.8, order=3,
)  # fmt: skip
TOOTH = InternalTooth(TEETH, PinionCutter(12, 0.0, 1.2, tip_radius=0.2), profile_shift=0.0, tip_radius=11.5)
MESHES = {rim: mesh_sector(TOOTH, TOOTH.root_radius + rim, COARSE) for rim in (0.3, 1.0, 4.0)}


def solved(support, rim=1.0, reach=2):
    return solve_influence(TOOTH, MESHES[rim], NU, "strain", order=3, reach=reach, support=support)


def to_sector(k):
    """From components of the ring to those of sector k, clockwise from sector 0."""
    a = 2.0 * math.pi * k / TEETH
    return np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])


def mean_over_arcs(places, support, radius):
    """Nodes on the outer circle of all sectors, at places (edges, nodes, 2), and their weights in each pin's mean.

    By a fine sum over each pin's arc with shape functions written down here: nothing of `rim` is used.
    """
    found = []
    for pin in range(support.pins):
        middle = support.angle + 2.0 * math.pi * pin / support.pins
        half, n = 0.5 * support.width / radius, 1000
        row = np.zeros(places.shape[:2])
        for angle in middle - half + (np.arange(n) + 0.5) * 2.0 * half / n:
            ends = np.arctan2(places[:, [0, -1], 0], places[:, [0, -1], 1])
            into = np.mod(angle - ends[:, 0] + math.pi, 2.0 * math.pi) - math.pi
            span = np.mod(ends[:, 1] - ends[:, 0] + math.pi, 2.0 * math.pi) - math.pi
            (edge,) = np.flatnonzero((into / span >= 0.0) & (into / span < 1.0))[:1]
            xi, nodes = into[edge] / span[edge], np.linspace(0.0, 1.0, places.shape[1])
            for i, at in enumerate(nodes):
                others = np.delete(nodes, i)
                row[edge, i] += np.prod((xi - others) / (at - others)) / n
        found.append(row)
    return found


def whole_ring(support, rim, tooth, loads, dofs, watched):
    """Displacements of watched unknowns on the neighbours of a tooth, the whole ring assembled and solved at once."""
    mesh = MESHES[rim]
    known = assemble(mesh, NU, "strain", 3)
    side_a, side_b = _matching_sides(mesh, known)[:2]
    number, count = np.full((TEETH, known.size), -1), 0
    own = np.setdiff1d(np.arange(known.size), side_a)
    for k in range(TEETH):
        number[k, own] = count + np.arange(own.size)
        count += own.size
    for k in range(TEETH):
        number[k, side_a] = number[k - 1, side_b]
    n = known.stiffness.shape[1]
    rows, columns, entries = [], [], []
    for k in range(TEETH):
        turn = np.kron(np.eye(n // 2), to_sector(k))
        at = number[k][known.element_dofs]
        rows.append(np.repeat(at, n, axis=1).ravel())
        columns.append(np.tile(at, (1, n)).ravel())
        entries.append((turn.T @ known.stiffness @ turn).ravel())
    matrix = csc_array((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), (count, count))
    held = supports(support, known, number, count)
    forces = np.zeros((count, loads.shape[1]))
    for x in range(0, known.size, 2):
        here = [np.flatnonzero(dofs == x + c) for c in range(2)]
        if here[0].size:
            forces[number[tooth, [x, x + 1]]] += to_sector(tooth).T @ loads[[here[0][0], here[1][0]]]
    # A stiffness lent to what the support holds, which then is made to vanish: both are exact.
    lent = (matrix + csc_array(held) @ csc_array(held).T).tocsc()
    both = splu(lent, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(np.hstack([forces, held]))
    free, by_support = both[:, : loads.shape[1]], both[:, loads.shape[1] :]
    moved = free - by_support @ np.linalg.solve(held.T @ by_support, held.T @ free)
    found = {}
    for k in (-1, 0, 1):
        there = moved[number[(tooth + k) % TEETH]].reshape(-1, 2, loads.shape[1])
        found[k] = np.einsum("cd,ndp->ncp", to_sector(tooth + k), there).reshape(-1, loads.shape[1])[watched]
    return found


def supports(support, known, number, count):
    """Weights of the ring's unknowns in what the support holds: means over pins, or over the whole circle."""
    edges, motion = known.edge_dofs["bore"], rigid_motions(known)
    radius = float(np.hypot(*known.edge_places["bore"][:, 0, 0]))
    nodes, places = [], []
    for k in range(TEETH):
        for edge in np.moveaxis(edges, 2, 0):
            nodes.append(number[k][edge])
            local = np.stack([motion[edge[1], 2], -motion[edge[0], 2]])  # a turn moves (x, y) by (-y, x)
            places.append((to_sector(k).T @ local).T)
    nodes, places = np.array(nodes), np.array(places)
    if support.pins:
        held = np.zeros((count, 2 * support.pins))
        for pin, weight in enumerate(mean_over_arcs(places, support, radius)):
            for c in range(2):
                np.add.at(held[:, 2 * pin + c], nodes[:, c], weight)
    else:
        held = np.zeros((count, 3))
        xi, share = np.polynomial.legendre.leggauss(8)
        shapes = np.array([
            np.prod([(0.5 + 0.5 * xi - j / 3.0) / (i / 3.0 - j / 3.0) for j in range(4) if j != i], axis=0)
            for i in range(4)
        ])  # fmt: skip
        even = np.einsum("iq,q,jq->ij", shapes, share, shapes)  # edges are alike
        for c in range(2):
            np.add.at(held[:, c], nodes[:, c], np.tile(even.sum(axis=1), (len(nodes), 1)))
            turned = -places[:, :, 1] if c == 0 else places[:, :, 0]
            np.add.at(held[:, 2], nodes[:, c], turned @ even)
    return held


@pytest.mark.dear("support3-4.0-1", "support0-1.0-0")
@pytest.mark.parametrize(
    ("support", "rim", "tooth"),
    [
        (RimSupport(), 1.0, 0),
        pytest.param(RimSupport(), 0.3, 0, marks=pytest.mark.long),
        (RimSupport(5, 2.0, 0.3), 1.0, 7),
        (RimSupport(8, 1.1, -0.2), 4.0, 1),
    ],
)
def test_rings_answer_as_the_whole_ring_solved_at_once(support, rim, tooth):
    known = tooth_on_pins(solved(support, rim), tooth)
    loads = np.random.default_rng(1).normal(size=(known.flank.dofs.size, 2))
    fillet = known.fillets["tension"]
    watched = np.concatenate([known.flank.dofs, fillet.dofs])
    found = whole_ring(support, rim, tooth, loads, known.flank.dofs, watched)
    n, close = known.flank.dofs.size, 1e-9
    if (
        support.pins or rim < 1.0
    ):  # the arcs' sum is good to that; digits of a thin ring, which gives way 100 times as much
        close = 1e-5 if support.pins else 1e-6
    for k, moved in found.items():
        size = np.abs(found[0]).max()
        np.testing.assert_allclose(known.compliance[k] @ loads, moved[:n], atol=close * size)
        stress = fillet.strain @ moved[n:] / (1.0 - NU**2)
        np.testing.assert_allclose(known.stress[k, "tension"] @ loads, stress, atol=10.0 * close * np.abs(stress).max())


def test_pins_all_over_the_circle_are_the_held_circle():
    radius = TOOTH.root_radius + 4.0
    every = solved(RimSupport(TEETH, 2.0 * math.pi * radius / TEETH), 4.0)
    held = solve_influence(TOOTH, MESHES[4.0], NU, "strain", order=3, reach=2)
    size = np.abs(held.compliance[0]).max()
    np.testing.assert_allclose(every.compliance[0], held.compliance[0], atol=2e-2 * size)
    assert every.pins is not None
    assert every.pins.teeth == 1


def test_the_mean_over_the_teeth_is_that_of_each_and_answers_both_ways():
    known = solved(RimSupport(9, 1.5, 0.1))
    each = [tooth_on_pins(known, tooth) for tooth in range(known.pins.teeth)]
    assert len(each) == 8
    size = np.abs(known.compliance[0]).max()
    for k, mean in known.compliance.items():
        np.testing.assert_allclose(np.mean([one.compliance[k] for one in each], axis=0), mean, atol=1e-11 * size)
        np.testing.assert_allclose(known.compliance[-k].T, mean, atol=1e-9 * size)
    least, most = TOOTH.involute_radii
    radius, width = np.linspace(least + 0.2, most - 0.2, 3), np.full(3, 0.02)
    spread = over_the_teeth(known, radius, 0.18, width)
    for tooth, one in enumerate(each):
        np.testing.assert_allclose(spread["c_self"][tooth], one.self_compliance(radius, 0.18, width), rtol=2e-3)
        for side in ("tension", "compression"):
            wanted = one.largest_root_stress(0, side, radius, width)[0]
            np.testing.assert_allclose(spread[f"root_{side}"][tooth], wanted, rtol=1e-9, atol=1e-9)
    assert np.ptp(spread["c_self"], axis=0).min() > 0.01 * spread["c_self"].min()


def test_a_ring_turned_by_a_pitch_under_its_pins_is_the_next_tooth():
    pitch = 2.0 * math.pi / TEETH
    one, other = solved(RimSupport(5, 2.0, 0.1)), solved(RimSupport(5, 2.0, 0.1 - pitch))
    size = np.abs(one.compliance[0]).max()
    there, here = tooth_on_pins(one, 3), tooth_on_pins(other, 2)
    for k in one.compliance:
        np.testing.assert_allclose(there.compliance[k], here.compliance[k], atol=1e-9 * size)


@pytest.mark.parametrize("support", [RimSupport(), RimSupport(2, 2.0, 0.3)])
def test_thin_rims_do_not_hang_on_the_last_bit(support):
    """A rim of .3 modules, which gives way 1e4 times as much as a tooth: no stiffness against rigid motion is left."""
    other = mesh_sector(TOOTH, (TOOTH.root_radius + 0.3) * (1.0 + 1e-13), COARSE)
    one, two = (solve_influence(TOOTH, mesh, NU, "strain", order=3, support=support) for mesh in (MESHES[0.3], other))
    radius = np.linspace(*TOOTH.involute_radii, 5)[1:-1]
    width = np.full(3, 0.02)
    first, second = (x.self_compliance(radius, 0.18, width) for x in (one, two))
    np.testing.assert_allclose(first, second, rtol=1e-6)


def thin_ring(harmonics, r, k, teeth):
    """c_k of a thin inextensible ring under forces at its teeth but for a factor; r is the neutral radius.

    Bending of harmonic n by q_n is q_n / (n^2 - 1)^2 (Timoshenko, Strength of Materials II, thin rings); n >= 2, what
    is left is the motion as a body. Of a force along the line of action: radial, tangential, and its moment.
    """
    base = 0.5 * teeth * math.cos(math.radians(20.0))
    at = math.radians(20.0)
    radial, tangential, arm = math.sin(at), math.cos(at), r * math.cos(at) - base
    n = np.arange(2, harmonics)
    across = -tangential / n + arm * (n - 1.0 / n) / r
    return float(np.sum((radial**2 + across**2) * np.cos(2.0 * math.pi * k * n / teeth) / (n**2 - 1.0) ** 2))


def test_far_teeth_of_a_thin_splined_ring_move_as_a_thin_ring_bends():
    teeth = 100
    tooth = InternalTooth(teeth, PinionCutter(25, 0.1, 1.25, tip_radius=0.2), tip_radius=49.2)
    mesh = mesh_sector(tooth, tooth.root_radius + 1.2, COARSE)
    known = solve_influence(tooth, mesh, NU, "strain", order=3, reach=49, support=RimSupport())
    radius, far = np.array([0.5 * teeth]), [20, 25, 30, 40, 49]
    found = np.array([known.neighbour(k, radius, radius, 0.18)[0, 0] for k in far])
    wanted = np.array([thin_ring(60, tooth.root_radius + 0.5, k, teeth) for k in far])
    ratio = found / wanted
    np.testing.assert_allclose(ratio / ratio[-1], 1.0, atol=0.03)


CASE = """
results = ["stiffness"]
[gear.r]
internal = true
teeth = 60
module = "4 mm"
profile_shift = 0.2
cutter = { teeth = 20, profile_shift = 0.1, addendum = 1.25, tip_radius = 0.25 }
rim_thickness = "12 mm"
rim_support = SUPPORT
"""


@pytest.mark.parametrize(
    ("support", "words"),
    [
        ('{ kind = "pins" }', "pins"),
        ('{ kind = "pins", pins = 0, width = "12 mm" }', "at least 2"),
        ('{ kind = "pins", pins = 61, width = "3 mm" }', "between 2 and the number of teeth, 60"),
        ('{ kind = "pins", pins = 6, width = "500 mm" }', r"and 142\.542 mm \(pin spacing on the outer circle\)"),
        ('{ kind = "pins", pins = 6, width = "1 um" }', "0.02 modules"),
        ('{ kind = "splined", pins = 6 }', "applies only to a rim on pins"),
        ('{ kind = "glued" }', "pins"),
    ],
)
def test_supports_that_hold_no_ring_are_refused_in_words(tmp_path, support, words):
    path = tmp_path / "ring.toml"
    path.write_text(CASE.replace("SUPPORT", support))
    with pytest.raises(FegearError, match=words) as refused:
        read_scene(path)
    assert "gear.r.rim_support" in str(refused.value)


EXTERNAL = """
results = ["stiffness"]
[gear.a]
teeth = 30
module = "2 mm"
bore_radius = "24 mm"
face_width = "10 mm"
rim_support = SUPPORT
"""


@pytest.mark.parametrize(
    ("support", "words"),
    [
        ('{ kind = "free_arc" }', "is required for a bore that is free over an arc; set teeth = 5"),
        ('{ kind = "free_arc", teeth = 4 }', "must be an odd number between 1 and 29"),
        ('{ kind = "free_arc", teeth = 0 }', "must be an odd number between 1 and 29"),
        ('{ kind = "free_arc", teeth = 31 }', "must be an odd number between 1 and 29"),
        ('{ kind = "web", web_thickness = "3 mm" }', r"web_radius.*is required for a rim on a web"),
        ('{ kind = "web", web_thickness = "11 mm", web_radius = "9 mm" }', "1.1 of the face width: must be between"),
        ('{ kind = "web", web_thickness = "3 mm", web_radius = "24 mm" }', r"must be between 0 and 23\.9 mm"),
        ('{ kind = "bearing", pins = 2, width = "1 mm" }', "must be between 3 and the number of teeth, 30"),
        ('{ kind = "pins", pins = 6, width = "60 mm" }', r"and 25\.1327 mm \(pin spacing on the bore\)"),
        ('{ kind = "splined", teeth = 3 }', "applies only to a bore that is free over an arc"),
    ],
)
def test_supports_that_carry_no_external_rim_are_refused_in_words(tmp_path, support, words):
    path = tmp_path / "gear.toml"
    path.write_text(EXTERNAL.replace("SUPPORT", support))
    with pytest.raises(FegearError, match=words) as refused:
        read_scene(path)
    assert "gear.a.rim_support" in str(refused.value)


def test_an_external_rim_needs_its_inside_and_no_second_body(tmp_path):
    path, given = tmp_path / "gear.toml", EXTERNAL.replace("SUPPORT", '{ kind = "splined" }')
    for text, words in (
        (given.replace('bore_radius = "24 mm"', ""), "bore_radius.*is required for a gear with rim_support"),
        (given + 'body = { rim_thickness = "3 mm", web_thickness = "3 mm" }', "rim_support.*contradicts body"),
    ):
        path.write_text(text)
        with pytest.raises(FegearError, match=words):
            read_scene(path)
    path.write_text(given)
    assert read_scene(path).gears["a"].support == RimSupport()


@pytest.mark.parametrize("kind", ["free_arc", "web", "bearing"])
def test_rings_have_no_support_of_external_rims(tmp_path, kind):
    keys = {
        "free_arc": "teeth = 3", "web": 'web_thickness = "1 um", web_radius = "9 mm"',
        "bearing": 'pins = 6, width = "6 mm"',
    }  # fmt: skip
    path = tmp_path / "ring.toml"
    path.write_text(CASE.replace("SUPPORT", f'{{ kind = "{kind}", {keys[kind]} }}'))
    with pytest.raises(FegearError, match="applies only to external gears"):
        read_scene(path)


@pytest.mark.parametrize(
    ("place", "half"), [(2.1, 0.7), (1.9, 0.7), (2.5, 0.05), (-0.2, 0.4), (0.0, 3.3), (23.45, 0.2)]
)
def test_a_pin_moves_with_a_ring_that_moves_as_a_body(place, half):
    """Weights of each pin over all sectors add up to one, out and along, wherever its arc begins and ends."""
    outer, radius = _outer(assemble(MESHES[1.0], NU, "strain", 3)), TOOTH.root_radius + 1.0
    pitch = 2.0 * math.pi / TEETH
    support = RimSupport(2, 2.0 * half * pitch * radius, place * pitch)
    weights = outer.held(TEETH, support, radius)
    assert weights.shape == (TEETH, outer.dofs.size, 4)
    turned = np.array([outer.motion[:, :2] @ to_sector(k) for k in range(TEETH)])
    moved = np.einsum("knp,knt->pt", weights, turned).reshape(2, 2, 2)
    for pin, found in enumerate(moved):
        m = support.angle + math.pi * pin
        np.testing.assert_allclose(found, [[math.sin(m), math.cos(m)], [math.cos(m), -math.sin(m)]], atol=1e-9)
    touched = {k for k in range(TEETH) if weights[k, :, :2].any()}
    centre = np.arange(-5, TEETH + 5)
    within = centre[(centre + 0.5 > place - half) & (centre - 0.5 < place + half)]
    assert touched == {int(k) % TEETH for k in within}
