"""Parts of the finite elements by what they stand for: flat triangles, bent faces, places on a fillet."""

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.gauge import FilletProfile
from fegear.fem.plane.tooth_meshing import areas, refuse_flat
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.slice_laws import _curvature


def test_twice_the_area_is_positive_counterclockwise():
    vertices = np.array([[0.0, 3.0, 0.0], [0.0, 0.0, 2.0]])
    assert areas(vertices, np.array([[0, 0], [1, 2], [2, 1]])).tolist() == [6.0, -6.0]


def square(short=None):
    """A square of four edges, or of five with a short one beside a corner; and two points close to its lower edge."""
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    if short:
        corners.insert(1, (1.0 - short, 0.0))
    return np.array([*corners, (0.4, 1e-4), (0.6, 2e-4)]).T, len(corners)


def test_a_flat_triangle_is_refused_but_where_short_edges_of_the_boundary_force_it():
    vertices, boundary = square()
    good, flat = np.array([[0], [1], [2]]), np.array([[0], [1], [4]])
    refuse_flat(vertices, good, boundary)
    with pytest.raises(InputError, match="has a triangle of quality"):
        refuse_flat(vertices, np.hstack([good, flat]), boundary)
    vertices, boundary = square(short=1e-4)
    forced = np.array([[0], [1], [5]])  # its second corner has an edge of 1 and one of a ten-thousandth
    refuse_flat(vertices, forced, boundary)
    with pytest.raises(InputError, match="has a triangle of quality"):
        refuse_flat(vertices, np.array([[0], [5], [6]]), boundary)


@pytest.mark.parametrize("width", [2.0, 3.0])
def test_bending_of_a_face_is_the_integral_of_products_of_second_derivatives(width):
    face = FaceFunctions((-0.5 * width, 0.5 * width), (6,))
    z = np.linspace(-0.5 * width, 0.5 * width, 60)
    found = _curvature(face)

    def of(power):
        return np.linalg.lstsq(face.values(z).T, z**power, rcond=None)[0]

    for m in range(7):
        for n in range(7):
            p = m + n - 3  # of the integral of m (m - 1) n (n - 1) z^(m + n - 4)
            exact = m * (m - 1) * n * (n - 1) * ((0.5 * width) ** p - (-0.5 * width) ** p) / p if p > 0 else 0.0
            assert of(m) @ found @ of(n) == pytest.approx(exact, abs=1e-6 * (1.0 + abs(exact)))


def arc_of_circle(count=91):
    """A fillet as a quarter of a circle of 1 mm, from the root land to the flank, at the root radius of 20 mm."""
    turned = np.linspace(0.0, 0.5 * np.pi, count)
    return FilletProfile(
        1e-3 * turned, 20e-3 + 1e-3 * (1.0 - np.cos(turned)), np.radians(4.0) - 0.05 * np.sin(turned),
        0.5 * np.pi - turned, 20e-3,
    )  # fmt: skip


def test_a_place_on_a_fillet_is_where_it_is_said_by_any_of_its_measures():
    profile = arc_of_circle()
    for share in (0.2, 0.5, 0.83):
        turned = share * 0.5 * np.pi
        height = 1e-3 * (1.0 - np.cos(turned))
        places = {"arc": 1e-3 * turned, "tangent_angle": 0.5 * np.pi - turned, "height": height,
                  "diameter": 40e-3 + 2.0 * height}  # fmt: skip
        for key, value in places.items():
            assert profile.middle(key, value) == pytest.approx(1e-3 * turned, rel=2e-4), key


def test_places_just_beyond_an_end_of_a_fillet_are_its_end_and_others_are_refused():
    profile = arc_of_circle()
    low, high = 40e-3, 42e-3  # diameters; a millionth of what the fillet spans is round-off
    assert profile.middle("diameter", high + 2.5e-9) == pytest.approx(0.5e-3 * np.pi)
    assert profile.middle("diameter", low - 2.5e-9) == 0.0
    for value in (high + 1e-8, low - 1e-8):
        with pytest.raises(InputError, match="is outside the fillet, 40 mm to 42 mm"):
            profile.middle("diameter", value)
