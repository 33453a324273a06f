"""Stress intensity along a front as functionals, on fields that leave the faces of a crack free and have known K."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.odd import crack_field
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.cracked_sector import FACES, cracked_sector
from fegear.fem.plane.odd.stress_intensity import interaction
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.solid.field import _AtNodes, _Layer, _layer, _von_mises
from fegear.fem.solid.fillet import SolidFillet, solid_fillet, surface_stress
from fegear.fem.solid.influence import sample_lines
from fegear.fem.solid.odd.front_intensity import front_rows
from fegear.fem.solid.section import HUB, make_section
from fegear.fem.solid.sector import section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

NU = 0.3
LAM, MU = NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), 0.5 / (1.0 + NU)
TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))


class Front:
    """A crack in a coarse sector, functionals of its front, and the nodes' places in the crack's own axes."""

    def __init__(self):
        mouth = mouth_at_tangent(TOOTH, math.radians(30.0))
        self.sector = cracked_sector(
            TOOTH, 9.0, settings_at(-5), straight_crack(TOOTH, mouth, math.radians(70.0), depth=0.5)
        )
        self.elements = sector_elements(self.sector.mesh, 2)
        self.rows = front_rows(self.sector, NU, self.elements)
        way = self.sector.way
        self.axes = np.array([way, [-way[1], way[0]]])
        self.node = self.elements.point_nodes
        self.x, self.y = self.axes @ (self.sector.mesh.points - self.sector.tip[:, None])

    def nodal(self, x, y, z):
        """Displacement at all nodes, of components along the crack, to its left, and along the front, (N, 3)."""
        found = np.zeros((self.rows.shape[3], 3))
        flat = np.stack([np.broadcast_to(one, self.x.shape) for one in (x, y)])
        found[self.node, :2] = (self.axes.T @ flat).T
        found[self.node, 2] = z
        return found

    def intensity(self, displacement, slope=(0.0, 0.0, 0.0), curvature=(0.0, 0.0, 0.0)):
        """K_I, K_II, K_III by each ring, and the size of the terms that they are the sum of."""
        each = [
            np.einsum("rmnc,nc->rm", self.rows[:, :, k], self.nodal(*of))
            for k, of in enumerate((displacement, slope, curvature))
        ]
        size = [
            np.einsum("rmnc,nc->rm", np.abs(self.rows[:, :, k]), np.abs(self.nodal(*of)))
            for k, of in enumerate((displacement, slope, curvature))
        ]
        return np.sum(each, axis=0), np.max(size)


@pytest.fixture(scope="module")
def front():
    return Front()


def near_tip(front, mode):
    """Displacement of Williams' first terms in plane strain, K = 1; of the faces' own sides at the faces."""
    x, y = front.x.copy(), front.y.copy()
    mesh, theta = front.sector.mesh, np.arctan2(y, x)
    for name, side in zip(FACES, (1.0, -1.0), strict=True):
        on = np.unique(mesh.edges[name])
        theta[on] = np.where(np.hypot(x[on], y[on]) > 1e-9, side * math.pi, 0.0)
    root = np.sqrt(np.hypot(x, y) / (2.0 * math.pi))
    c, s, kappa = np.cos(0.5 * theta), np.sin(0.5 * theta), 3.0 - 4.0 * NU
    none = 0.0 * x
    if mode == 0:
        return root / (2.0 * MU) * c * (kappa - np.cos(theta)), root / (2.0 * MU) * s * (kappa - np.cos(theta)), none
    if mode == 1:
        along = root / (2.0 * MU) * s * (kappa + 2.0 + np.cos(theta))
        return along, -root / (2.0 * MU) * c * (kappa - 2.0 + np.cos(theta)), none
    return none, none, 2.0 * root / MU * s


@pytest.mark.parametrize("mode", [0, 1, 2])
def test_the_field_of_a_mode_has_its_own_intensity_only(front, mode):
    found, _ = front.intensity(near_tip(front, mode))
    assert found == pytest.approx(np.tile(np.eye(3)[mode], (2, 1)), abs=2e-2)


def test_in_the_plane_it_is_the_functional_of_the_plane(front):
    one = interaction(front.sector, NU, "strain", front.elements)
    displacement = np.random.default_rng(6).normal(size=(front.rows.shape[3], 2))
    by_front = np.einsum("mnc,nc->m", front.rows[0, :2, 0, :, :2], displacement)
    assert by_front == pytest.approx(one.T @ displacement.ravel(), rel=1e-9)


def fields(front):
    """Displacement, slope and curvature along the front of fields in equilibrium that leave the faces free."""
    x, y = front.x, front.y
    none = (0.0, 0.0, 0.0)
    bent = -2.0 * LAM / (LAM + 2.0 * MU)
    warped = -(LAM * bent + 2.0 * (LAM + 2.0 * MU)) / (2.0 * MU)
    return {
        "moved along the crack": ((1.0, 0.0, 0.0), none, none),
        "moved across": ((0.0, 1.0, 0.0), none, none),
        "moved along the front": ((0.0, 0.0, 1.0), none, none),
        "turned in the section": ((-y, x, 0.0), none, none),
        "turned about the crack": ((0.0, 0.0, y), (0.0, -1.0, 0.0), none),
        "turned about the normal": ((0.0, 0.0, -x), (1.0, 0.0, 0.0), none),
        "pulled along the crack": (((1.0 - NU**2) * x, -NU * (1.0 + NU) * y, 0.0), none, none),
        "pulled along the front": ((-NU * x, -NU * y, 0.0), (0.0, 0.0, 1.0), none),
        "sheared along the front": ((0.0, 0.0, x), none, none),
        "bent along the crack": ((-0.5 * NU * (x**2 - y**2), -NU * x * y, 0.0), (0.0, 0.0, x), (-1.0, 0.0, 0.0)),
        "bent across": ((-NU * x * y, 0.5 * NU * (x**2 - y**2), 0.0), (0.0, 0.0, y), (0.0, -1.0, 0.0)),
        "twisted": ((0.0, 0.0, -x * y), (-y, x, 0.0), none),
        "sheared by bending": (
            (0.0, 0.0, warped * x**2 - 0.5 * bent * y**2), (0.0, bent * y, 0.0), (0.0, 0.0, 2.0)
        ),
    }  # fmt: skip


@pytest.mark.parametrize("name", list(fields(type("None", (), {"x": np.zeros(1), "y": np.zeros(1)}))))
def test_what_leaves_the_faces_free_and_has_no_bound_nowhere_has_no_intensity(front, name):
    found, size = front.intensity(*fields(front)[name])
    assert np.abs(found).max() < 1e-4 * size


# ---- a picture of a cracked tooth ------------------------------------------------------------------------------------
def tooth_of(front, plane):
    kind = SimpleNamespace(mesh=front.sector.mesh, tooth=TOOTH)
    return SimpleNamespace(poisson_ratio=NU, plane=plane, kind=lambda i: kind)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize(
    "strain", [((1.0, 0.0), (0.0, 0.0)), ((0.0, 0.0), (0.0, 1.0)), ((0.0, 0.7), (0.3, 0.0)), ((0.5, -0.2), (0.1, 1.0))]
)  # fmt: skip
def test_of_a_uniform_strain_stress_is_hooke_s_everywhere(front, plane, strain):
    slope = np.array(strain)
    moved = np.zeros(2 * front.rows.shape[3])
    for axis in (0, 1):
        moved[axis::2][front.node] = slope[axis] @ front.sector.mesh.points
    found = crack_field._mises(tooth_of(front, plane), 0, 2, moved)
    even = 0.5 * (slope + slope.T)
    across = 0.0 if plane == "strain" else -NU / (1.0 - NU) * np.trace(even)
    whole = np.array([[even[0, 0], even[0, 1], 0.0], [even[1, 0], even[1, 1], 0.0], [0.0, 0.0, across]])
    stress = LAM * np.trace(whole) * np.eye(3) + 2.0 * MU * whole
    apart = stress - np.trace(stress) / 3.0 * np.eye(3)
    assert found == pytest.approx(np.full(found.size, math.sqrt(1.5 * (apart**2).sum())))


def test_a_picture_has_the_tooth_and_the_body_near_it_in_small_triangles(front):
    mesh, known = front.sector.mesh, tooth_of(front, "strain")
    corners, count = np.unique(mesh.triangles[:3]), mesh.points.shape[1]
    moved = np.array([[1.0, 2.0], [0.5, -1.0]]) @ mesh.points
    some = moved.copy()
    some[:, np.setdiff1d(np.arange(count), corners)] = np.nan  # nodes between corners that the elements do not have
    found = crack_field._shown(known, 0, some, np.arange(count, dtype=float))
    at = found.mises.astype(int)  # each point told by its number
    assert np.array_equal(found.points, mesh.points[:, at])
    straight = np.isin(at, corners)
    assert found.moved[:, straight] == pytest.approx(moved[:, at[straight]])
    bent = np.abs(found.moved - moved[:, at]).max(axis=0)
    assert bent[~straight].max() < 0.05  # the mean of both ends; edges of the outline are curved a little
    assert np.median(bent[~straight]) < 1e-9

    def areas(points, t):
        (ax, ay), (bx, by), (cx, cy) = (points[:, one] for one in t)
        return 0.5 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))

    small = areas(found.points, found.triangles)
    assert (small > 0.0).all()
    radius = np.hypot(*mesh.points)
    root = radius[np.unique(mesh.edges["fillet"][:2])].min()
    near = (radius[mesh.triangles] > root - 2.2).any(axis=0)
    assert small.size == 4 * near.sum() < 4 * near.size
    whole = areas(mesh.points, mesh.triangles[:3, near])
    assert small.sum() == pytest.approx(whole.sum(), rel=5e-3)
    for name, line in zip(FACES, (found.left, found.right), strict=True):
        assert at[line[-1]] == mesh.tip
        assert set(at[line].tolist()) == set(np.unique(mesh.edges[name]).tolist())
        off = np.hypot(*(found.points[:, line] - front.sector.tip[:, None]))
        assert (np.diff(off) < 0.0).all()  # from the mouth to the tip
    ends = found.points[:, [found.left[0], found.right[0]]]
    assert np.hypot(*(ends[:, 0] - ends[:, 1])) == pytest.approx(0.0, abs=1e-9)
    assert set(at[found.fillets].tolist()) == {
        int(n) for name in ("fillet", "back_fillet") for n in np.unique(mesh.edges[name])
    }


# ---- stress in sections of 3D teeth ----------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("tau", "lean", "stretch"), [(0.0, None, 1.0), (0.06, None, 1.0), (0.0, 0.4, 1.0), (0.0, -0.3, 0.7)]
)
def test_stress_of_a_uniform_strain_is_the_same_in_straight_twisted_and_leaning_sections(front, tau, lean, stretch):
    """Displacement G X: of a twisted prism in its turned axes, of a cone by heights that fall as the radius grows."""
    mesh = mesh_sector(TOOTH, 9.0, settings_at(-5))
    elements = sector_elements(mesh, 2)
    slope = np.array([[1.0, 0.2, -0.6], [0.1, -0.4, 0.8], [0.7, -0.3, 0.5]])
    place = np.zeros_like(mesh.points)
    place[:, elements.point_nodes] = mesh.points
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    height = 0.0 * place[0] if lean is None else -lean * np.hypot(*place)
    value = slope @ np.vstack([place, height])
    along = slope[:, :2] @ (tau * quarter @ place) + slope[:, 2:]
    along[:2] -= tau * quarter @ value[:2]
    nodes = elements.element_nodes
    count, some = nodes.shape[0], np.arange(nodes.shape[0]) % 7 != 0
    layer = _Layer(some, None if lean is None else np.full(count, lean), np.full(count, stretch))
    at = _AtNodes(nodes, elements.gradients_at_nodes(), place[:, nodes])
    found = _von_mises(at, value.T, stretch * along.T, tau, NU, layer)
    strain = 0.5 * (slope + slope.T)
    stress = LAM * np.trace(strain) * np.eye(3) + 2.0 * MU * strain
    apart = stress - np.trace(stress) / 3.0 * np.eye(3)
    beside = np.unique(nodes[some])
    assert found[beside] == pytest.approx(np.full(beside.size, math.sqrt(1.5 * (apart**2).sum())), rel=2e-3)
    assert (np.delete(found, beside) == 0.0).all()  # no material there


def test_material_is_where_a_zone_spans_its_ends_included_and_hubs_are_longer():
    section = SimpleNamespace(spans=((-1.0, 1.0), (0.5, 2.0)), zone=np.array([0, 1, HUB, 1]), lean="lean")
    section.spans = tuple(section.spans[n % 2] for n in range(HUB + 1))
    along = SimpleNamespace(stretched=lambda place: 3.0 + place)
    spans = np.array([section.spans[zone] for zone in section.zone])
    for place in (-1.0 - 1e-9, -1.0, 0.0, 0.5, 1.0 + 1e-9, 2.0, 2.1, -1.1):
        found = _layer(section, along, place, 1e-6)
        assert found.filled.tolist() == [low - 1e-6 <= place <= high + 1e-6 for low, high in spans]
        assert found.stretch == pytest.approx(np.where(section.zone == HUB, 3.0 + place, 1.0))
        assert found.lean == "lean"
    assert (_layer(section, None, 0.0, 1e-6).stretch == 1.0).all()


@pytest.mark.parametrize(("tau", "slide"), [(0.0, 0.0), (0.06, 0.0), (-0.06, 0.0), (0.0, 0.2)])
def test_stress_in_a_surface_is_that_of_the_strain_in_it(tau, slide):
    """Displacement G X at a straight fillet: by the tensor, along the tangent of the section and square to it."""
    slope = np.array([[1.0, 0.2, -0.6], [0.1, -0.4, 0.8], [0.7, -0.3, 0.5]])
    way, start = np.array([math.sin(0.4), math.cos(0.4)]), np.array([1.0, 8.0])
    node, arc = np.array([0.0, 0.5, 1.0]), np.array([0.2, 0.7])
    values = np.array([[2.0 * (s - 0.5) * (s - 1.0), -4.0 * s * (s - 1.0), 2.0 * s * (s - 0.5)] for s in arc])
    slopes = np.array([[4.0 * s - 3.0, 4.0 - 8.0 * s, 4.0 * s - 1.0] for s in arc])
    place, tangent = start[:, None] + way[:, None] * arc, np.tile(way[:, None], 2)
    fillet = SolidFillet(np.arange(3), values, slopes, tangent, place, arc, np.full(2, 0.4), 1.0)
    at, quarter = start[:, None] + way[:, None] * node, np.array([[0.0, -1.0], [1.0, 0.0]])
    value = slope @ np.vstack([at, 0.0 * node])
    along = slope[:, :2] @ (tau * quarter @ at + np.array([[slide], [0.0]])) + slope[:, 2:]
    along[:2] -= tau * quarter @ value[:2]
    moved = np.stack([value.T, along.T], axis=2)[..., None]  # 1 and the height as functions along the face
    found = surface_stress(fillet, tau, NU, moved, np.array([[1.0], [0.0]]), np.array([[0.0], [1.0]]), slide)
    strain = 0.5 * (slope + slope.T)
    for p in range(2):
        t, helix = np.append(way, 0.0), np.append(tau * quarter @ place[:, p] + [slide, 0.0], 1.0)
        b = helix - (helix @ t) * t
        b /= np.linalg.norm(b)
        tt, bb, tb = t @ strain @ t, b @ strain @ b, t @ strain @ b
        expected = [(tt + NU * bb) / (1.0 - NU**2), (bb + NU * tt) / (1.0 - NU**2), tb / (1.0 + NU)]
        assert found[:, p, 0, 0] == pytest.approx(expected)


@pytest.mark.parametrize("name", ["fillet", "back_fillet"])
def test_points_of_a_fillet_give_back_places_and_their_slopes(name):
    """Of functions of the section: constants, and the place itself, whose slope along the arc is the tangent."""
    mesh = section_mesh(TOOTH, 9.0, SolidSettings().scaled(2.0).section, None)
    section = make_section(mesh, 3, 0.0, NU, TOOTH.base_radius)
    found = solid_fillet(section, name)
    assert found.nodes.size == np.unique(found.nodes).size
    assert found.values.sum(axis=1) == pytest.approx(np.ones(found.arc.size))
    assert found.slopes.sum(axis=1) == pytest.approx(np.zeros(found.arc.size), abs=1e-9)
    nodes = section.places[:, found.nodes]
    assert found.values @ nodes.T == pytest.approx(found.place.T, abs=2e-5)
    assert found.slopes @ nodes.T == pytest.approx(found.tangent.T, abs=2e-3)
    assert np.hypot(*found.tangent) == pytest.approx(np.ones(found.arc.size))
    # along the arc: from the root land up, by steps that are the way between the points
    assert (np.diff(found.arc) > 0.0).all()
    assert 0.0 < found.arc[0] < found.arc[-1] < found.length
    chord = np.hypot(*np.diff(found.place))
    assert ((np.diff(found.arc) >= chord) & (np.diff(found.arc) < 1.004 * chord)).all()
    ends = mesh.points[:, np.unique(mesh.edges[name][:2])]
    low, high = np.argmin(np.hypot(*ends)), np.argmax(np.hypot(*ends))
    way = np.column_stack([ends[:, low], found.place, ends[:, high]])
    assert found.length == pytest.approx(np.hypot(*np.diff(way)).sum(), rel=3e-3)
    assert (np.diff(np.hypot(*found.place)) > -1e-9).all()
    # between the tangent and the centre line of the tooth: from across it to nearly along it
    assert found.tangent_angle == pytest.approx(np.arccos(found.tangent[1]), abs=1e-9)
    assert found.tangent_angle[0] > 1.0 > 0.6 > found.tangent_angle[-1] > 0.0
    assert math.isnan(found.mouth)


@pytest.mark.parametrize("side", [1, -1])
def test_contact_lines_that_errors_are_sampled_on_have_two_stations_at_least(side):
    """All on the flank, off its ends; the steeper they climb the fewer stations of a line are on it."""
    base, low, high = 9.0, 10.0, 11.0
    flank = SimpleNamespace(
        lowest_radius=low, highest_radius=high, flank_start=1.0, flank_end=2.0,
        arc_of_radius=lambda r: 2.0 - (r - low) if side < 0 else 1.0 + (r - low),
        radius_of_arc=lambda s: low + (2.0 - s if side < 0 else s - 1.0),
    )  # fmt: skip
    fewest, every = [], []
    for lean in (0.0, 0.1, 0.3, 0.5, 0.7, 1.2):
        tooth = SimpleNamespace(base_radius=base, side=side)
        lines = list(sample_lines(SimpleNamespace(flank=flank, width=2.0, tau=lean / base, tooth=tooth)))
        for radius, stations, above in lines:
            assert ((radius > low) & (radius < high)).all()
            assert radius.size == stations.size == above.size >= 2
            roll = side * np.sqrt(radius**2 - base**2)
            assert np.diff(roll) == pytest.approx(-lean * np.diff(stations), abs=1e-9)
            place = flank.arc_of_radius(radius) - 1.0
            assert place.min() > 0.0
            assert (place[above].min(initial=1.0) > place[~above].max(initial=0.0)) or not above.any()
        every.append(len(lines))
        fewest.append(min(radius.size for radius, *_ in lines))
    assert fewest[0] == 5
    assert 2 in fewest
    assert every[0] >= every[-1]
