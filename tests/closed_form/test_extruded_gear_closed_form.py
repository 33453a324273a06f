"""The explicit solid gear for other programs: closed, of the right volume, loaded with the right force and moments."""

import math
from collections import Counter

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.fem.plane.gear_section import gear_section, paired, uneven_section
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.solid.extruded import extruded, graded_stations, pressed_band, serendipity
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.output.solid_mesh_files import pressed_gear, write_solid_inp, write_solid_vtu

TOOTH = Tooth(10, BasicRack(1.0, 1.25, 0.25), 0.55)
FACE, RADIUS, HALF_WIDTH = 4.0, 5.5, 0.25
#: Faces of a wedge and a hexahedron by their corners.
FACES = {
    6: [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    8: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}


@pytest.fixture(scope="module")
def section():
    return uneven_section(TOOTH, 2.5, 2.8)


def helical(section, degrees=20.0):
    stations = graded_stations(FACE, (-1.5, -0.5, 0.0, 0.5, 1.5), 0.2, 0.5, 0.5)
    return extruded(section, stations, math.tan(math.radians(degrees)) / TOOTH.pitch_radius)


def test_stations_along_the_face_are_as_many_as_their_law_wants():
    """Evenly where the finest layer is the thickest, one layer where the ends of a band are near each other."""
    assert graded_stations(4.0, (), 0.5, 0.5, 0.5) == pytest.approx(np.linspace(-2.0, 2.0, 9))
    assert graded_stations(4.0, (0.1, 0.2), 1.0, 0.0, 1.0) == pytest.approx([-2.0, -0.95, 0.1, 0.2, 1.1, 2.0])
    found = np.diff(graded_stations(4.0, (), 0.1, 0.5, 10.0))
    assert found == pytest.approx(found[::-1])
    # a layer of h(s) = 0.1 + 0.5 s: ln(1 + 0.5 * 2 / 0.1) / 0.5 of them on either half
    assert found.size == round(2.0 * math.log(11.0) / 0.5)
    assert found[1] / found[0] == pytest.approx(math.exp(0.5 * 2.0 * math.log(11.0) / 0.5 / found.size), rel=2e-3)


def test_the_solid_has_no_seams(section):
    """Every inner face belongs to two elements, and those of one alone make a closed surface: a torus."""
    mesh = helical(section)
    times = Counter()
    for corners, elements in ((6, mesh.wedges), (8, mesh.hexahedra)):
        for face in FACES[corners]:
            times.update(map(tuple, np.sort(elements[list(face)], axis=0).T.tolist()))
    assert max(times.values()) == 2
    outer = [face for face, n in times.items() if n == 1]
    round_about = section.edges("bore").shape[1] + sum(section.edges(n).shape[1] for n in section.names if n != "bore")
    ends = 2 * (section.triangles.shape[1] + section.quadrilaterals.shape[1])
    assert len(outer) == round_about * mesh.layers + ends
    assert np.unique(np.concatenate([mesh.wedges.ravel(), mesh.hexahedra.ravel()])).size == mesh.points.shape[1]
    assert len(np.unique(np.round(mesh.points, 9), axis=1).T) == mesh.points.shape[1]


def _area():
    """By Green's formula round the exact outline, and the bore's circle."""
    total = -math.pi * 2.5**2
    for curve in TOOTH.outline.values():
        u = np.linspace(curve.start, curve.end, 20001)
        x, y = curve.points(u)
        total += TOOTH.teeth * abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))  # both halves of a tooth
    return total


@pytest.mark.parametrize(("degrees", "coarseness", "off"), [(0.0, 2.8, 2e-4), (20.0, 2.8, 2e-4), (20.0, 1.4, 2e-5)])
def test_the_volume_is_that_of_the_section_times_the_width(degrees, coarseness, off):
    """Turning with the helix keeps it; Gauss' theorem over the surface of the elements themselves.

    What is off are the far teeth, whose flanks are two or three parabolas.
    """
    section = uneven_section(TOOTH, 2.5, coarseness)
    mesh = helical(section, degrees)
    g, w = np.polynomial.legendre.leggauss(4)
    g, w = 0.5 + 0.5 * g, 0.5 * w
    step = 0.5  # differences of parabolas are exact
    total = 0.0
    for name in section.names:
        nodes = mesh.points[:, mesh.faces(section.edges(name))]
        xi, eta = (a.ravel() for a in np.meshgrid(g, g))

        def at(u, v, nodes=nodes):
            return np.einsum("ckln,kq->clnq", nodes, serendipity(u, v))

        along = (at(xi + step, eta) - at(xi - step, eta)) / (2 * step)
        up = (at(xi, eta + step) - at(xi, eta - step)) / (2 * step)
        normal = np.cross(along, up, axis=0)
        place = at(xi, eta)
        # x and y alone: the ends of the face lie across the axis.
        total += 0.5 * np.einsum("clnq,clnq,q->", place[:2], normal[:2], np.outer(w, w).ravel())
    assert total == pytest.approx(_area() * FACE, rel=off)


@pytest.mark.parametrize("tooth", [0, 1])
@pytest.mark.parametrize("hat", [(-0.5, 0.0, 0.5), (1.5, 2.0, 2.0), (-2.0, -2.0, -1.5)])
@pytest.mark.parametrize("degrees", [0.0, 20.0, -20.0])
def test_a_band_presses_with_a_unit_force_along_the_line_of_action(section, hat, tooth, degrees):
    mesh = helical(section, degrees)
    forces = pressed_band(mesh, TOOTH, RADIUS, HALF_WIDTH, hat, tooth)
    rb = TOOTH.base_radius
    # The axial part of a force normal to the flank is tau r_b = tan(beta_b) of the transverse one.
    assert forces[2].sum() == pytest.approx(-mesh.twist * rb, abs=1e-12)
    torque = (mesh.points[0] * forces[1] - mesh.points[1] * forces[0]).sum()
    assert torque == pytest.approx(rb, rel=2e-6)  # the flank's quadratic edges miss the involute by so little
    # Where it presses along the face: the centroid of a hat, or of half a hat.
    low, top, high = hat
    assert (forces[2] * mesh.points[2]).sum() == pytest.approx(forces[2].sum() * (low + top + high) / 3, abs=1e-12)
    loaded = np.any(forces != 0.0, axis=0)
    x, y, z = mesh.points[:, loaded]
    assert low - 1e-9 <= z.min() <= z.max() <= high + 1e-9
    # Only on its own tooth's right flank: turned back it lies at positive x.
    angle = mesh.twist * z - 2.0 * math.pi * tooth / TOOTH.teeth
    assert (np.cos(angle) * x + np.sin(angle) * y > 0.0).all()
    assert (np.abs(np.hypot(x, y) - RADIUS) < 0.5).all()


def test_a_spur_band_across_the_face_is_the_plane_contact(section):
    """Summed over a row of hats that make a constant, the nodal forces are those of the plane mesh, layer by layer."""
    stations = np.linspace(-2.0, 2.0, 5)
    mesh = extruded(section, stations, 0.0)
    hats = [(max(t - 1.0, -2.0), t, min(t + 1.0, 2.0)) for t in stations]
    shares = [0.5 if abs(t) == 2.0 else 1.0 for t in stations]
    total = sum(s * pressed_band(mesh, TOOTH, RADIUS, HALF_WIDTH, hat) for hat, s in zip(hats, shares, strict=True))
    flank = section.boundaries["flank", 0]
    whole = total[:, mesh.nodes_of(flank)].sum(axis=1)
    assert np.linalg.norm(whole) == pytest.approx(4.0, rel=1e-3)  # one per length, all but parallel
    inner = [total[:, mesh.at_station(np.unique(flank), k)].sum(axis=1) for k in range(5)]
    assert inner[1] == pytest.approx(inner[2], rel=1e-12)
    assert inner[0] == pytest.approx(0.5 * inner[2], rel=1e-12)


def test_quadrilaterals_are_square_and_lose_no_area():
    mesh = mesh_sector(TOOTH, 2.5, MeshSettings().scaled(2.0))
    three, four = paired(mesh)
    assert three.shape[1] + 2 * four.shape[1] == mesh.triangles.shape[1]
    assert four.shape[1] > three.shape[1]
    p = mesh.points[:, four]
    # Jacobians of the eight-node elements at their Gauss points.
    g = np.sqrt(0.6) * np.array([-1.0, 0.0, 1.0]) * 0.5 + 0.5
    xi, eta = (a.ravel() for a in np.meshgrid(g, g))
    step = 0.5  # differences of parabolas are exact
    du = (serendipity(xi + step, eta) - serendipity(xi - step, eta)) / (2 * step)
    dv = (serendipity(xi, eta + step) - serendipity(xi, eta - step)) / (2 * step)
    a, b = np.einsum("ckm,kq->cmq", p, du), np.einsum("ckm,kq->cmq", p, dv)
    jacobian = a[0] * b[1] - a[1] * b[0]
    assert jacobian.min() > 0.0
    w = np.outer([5, 8, 5], [5, 8, 5]).ravel() / 324.0
    u, v = np.array([1 / 6, 2 / 3, 1 / 6]), np.array([1 / 6, 1 / 6, 2 / 3])
    n = 1.0 - u - v
    tu = np.array([1 - 4 * n, 4 * u - 1, 0 * u, 4 * (n - u), 4 * v, -4 * v])
    tv = np.array([1 - 4 * n, 0 * u, 4 * v - 1, -4 * u, 4 * u, 4 * (n - v)])

    def of_triangles(t):
        a, b = np.einsum("cim,iq->cmq", mesh.points[:, t], tu), np.einsum("cim,iq->cmq", mesh.points[:, t], tv)
        return (a[0] * b[1] - a[1] * b[0]).sum() / 6.0

    assert (jacobian @ w).sum() + of_triangles(three) == pytest.approx(of_triangles(mesh.triangles), rel=1e-12)


def test_a_row_of_teeth_has_two_free_sides():
    mesh = mesh_sector(TOOTH, 2.5, MeshSettings().scaled(2.8))
    row = gear_section(dict.fromkeys((-1, 0, 1), mesh))
    assert not row.closed
    corners = row.triangles[:3]
    edges = [corners[[a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]
    edges += [row.quadrilaterals[[a, b]] for a, b in ((0, 1), (1, 2), (2, 3), (3, 0))]
    _, times = np.unique(np.sort(np.hstack(edges), axis=0), axis=1, return_counts=True)
    sides = 2 * mesh.edges["side_a"].shape[1]
    assert (times == 1).sum() == sum(row.edges(name).shape[1] for name in row.names) + sides
    with pytest.raises(InputError, match="must be consecutive numbers, at most"):
        gear_section({0: mesh, 2: mesh})
    other = mesh_sector(TOOTH, 2.5, MeshSettings().scaled(1.0))
    with pytest.raises(InputError, match="sides whose nodes do not match"):
        gear_section({0: mesh, 1: other})


def test_bands_off_the_flank_or_the_face_are_refused(section):
    mesh = helical(section)
    with pytest.raises(RangeError, match="end of the flank"):
        pressed_band(mesh, TOOTH, 6.45, HALF_WIDTH, (-0.5, 0.0, 0.5))
    with pytest.raises(RangeError, match="within the face"):
        pressed_band(mesh, TOOTH, RADIUS, HALF_WIDTH, (1.5, 2.0, 2.5))
    with pytest.raises(RangeError, match="must coincide with mesh stations"):
        pressed_band(mesh, TOOTH, RADIUS, HALF_WIDTH, (-0.5, 0.1, 0.5))
    with pytest.raises(InputError, match="must ascend"):
        extruded(section, [0.0, 0.0, 1.0], 0.0)


def test_layers_grow_from_the_ends_and_keep_what_they_must():
    stations = graded_stations(20.0, (-0.3, 7.0), 0.1, 0.5, 1.0)
    layers = np.diff(stations)
    assert stations[0] == -10.0
    assert stations[-1] == 10.0
    assert np.isin([-0.3, 7.0], stations).all()
    assert layers.min() > 0.07
    assert layers.max() < 1.3
    assert layers[0] < 0.2 > layers[-1]


def test_decks_have_short_numbers_and_refuse_what_is_off_the_face(tmp_path):
    gear = Gear(TOOTH, 1.7e-3 / 3.0, 2.5 * 1.7e-3 / 3.0, 0.7e-3)
    deck, field = tmp_path / "g_solid.inp", tmp_path / "g_solid.vtu"
    pressed = pressed_gear(gear, face_positions=(0.0, 0.25e-3))
    write_solid_inp(deck, gear, pressed.mesh, pressed.bands, 1e3, {})
    write_solid_vtu(field, gear, pressed)
    text = deck.read_text().splitlines()
    rows = [line.split(",") for line in text if line[:1].isdigit()]
    assert max(len(part.strip()) for row in rows for part in row) <= 20  # CalculiX reads no more
    assert text.count("*STEP") == 2
    nodes = int(np.flatnonzero([line.startswith("*ELEMENT") for line in text])[0]) - 3
    places = np.array([[float(x) for x in row[1:]] for row in rows[:nodes]])
    assert np.abs(places[:, 2]).max() == pytest.approx(0.35, rel=1e-11)
    assert field.stat().st_size > 1e4
    with pytest.raises(InputError, match=r"is outside the face width, -0.35 to 0.35 mm"):
        pressed_gear(gear, face_positions=(1e-3,))
    with pytest.raises(InputError, match="would give a mesh of about"):
        pressed_gear(Gear(Tooth(40, TOOTH.rack), 1e-3, 15e-3, 0.3))
