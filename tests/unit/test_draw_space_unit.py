"""What is asked of the library that draws in space: surfaces with outlines, a skin with its scale, the camera."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.engine.figure.items import Skin, Spot, Surface
from fegear.output import draw_space

CAMERA = ((1.0, 1.0, 9.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))


class Body(dict):
    """A mesh; what is taken out of it is one too."""

    def __init__(self, kind, *given):
        self.kind, self.given = kind, given

    def clip(self, **how):
        body = Body("clipped", how)
        body.update(self)
        return body

    def extract_feature_edges(self, **how):
        return Body("edges", how, self)


@pytest.fixture
def drawn(monkeypatch):
    """All that was asked of the plotter, in order."""
    calls = []

    class Plotter:
        bounds = (0.0, 40.0, -2.0, 3.0, 0.0, 1.0)

        def __init__(self, **how):
            calls.append(("plotter", how))
            self.camera = SimpleNamespace(
                zoom=lambda by: calls.append(("zoom", by)),
                SetWindowCenter=lambda *at: calls.append(("centre", at)),
            )

        def __getattr__(self, name):
            return lambda *given, **how: calls.append((name, given, how))

        def screenshot(self, return_img):
            assert return_img
            calls.append(("camera", self.camera.position, self.camera.focal_point, self.camera.up))
            image = np.full((60, 90, 3), 255, dtype=np.uint8)
            image[20:30, 40:70] = 10
            return image

    pv = SimpleNamespace(
        Plotter=Plotter,
        PolyData=lambda *given: Body("poly", *given),
        StructuredGrid=lambda *given: Body("grid", *given),
    )
    monkeypatch.setattr(draw_space, "offscreen_pyvista", lambda: pv)
    return calls


def test_a_skin_has_its_values_from_zero_to_the_top_its_edges_and_a_scale_at_its_right(drawn):
    points = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 5.0]])
    triangles = np.array([[0, 0], [1, 2], [2, 3]])
    skin = Skin(points, triangles, [1.0, 2.0, 3.0, 4.0], 7.0, "stress", "MPa")
    image = draw_space.draw_space([skin], CAMERA)
    meshes = [(given[0], how) for name, given, how in (c for c in drawn if c[0] == "add_mesh")]
    (body, how), (edges, line) = meshes
    np.testing.assert_array_equal(body.given[0], points.T)
    assert body.given[1].tolist() == [3, 0, 1, 2, 3, 0, 2, 3]
    np.testing.assert_array_equal(body["stress [MPa]"], [1.0, 2.0, 3.0, 4.0])
    assert how["clim"] == (0.0, 7.0)
    assert how["scalars"] == "stress [MPa]"
    assert (how["ambient"], how["diffuse"], how["smooth_shading"]) == (0.45, 0.55, False)
    bar = how["scalar_bar_args"]
    # Upright, right of the middle, as far from the bottom as from the top, with room for its numbers.
    assert bar["vertical"]
    assert bar["height"] + 2.0 * bar["position_y"] == pytest.approx(1.0)
    assert (bar["height"], bar["width"], bar["position_x"]) == (0.6, 0.05, 0.86)
    assert (bar["title_font_size"], bar["label_font_size"]) == (24, 24)
    assert edges.given == (
        {"feature_angle": 40.0, "boundary_edges": True, "feature_edges": True, "manifold_edges": False,
         "non_manifold_edges": False}, body,
    )  # fmt: skip
    assert line == {"color": "black", "line_width": 2}
    assert not any(call[0] == "show_bounds" for call in drawn)
    assert ("zoom", draw_space._ZOOM_BARE) in drawn
    assert ("centre", (draw_space._ROOM_FOR_SCALE, 0.0)) in drawn
    # White around it is cut off, but for a margin.
    margin = draw_space._MARGIN
    assert image.shape == (
        min(30 - 1 + margin, 60) - max(20 - margin, 0), min(70 - 1 + margin, 90) - max(40 - margin, 0), 3,
    )  # fmt: skip
    draw_space.draw_space([Skin(points, triangles, [1.0] * 4, 7.0, "share", floor=-2.0)], CAMERA)
    floored = [call[1][0] for call in drawn if call[0] == "add_mesh"][2]
    assert floored.given == ({"normal": (0.0, -1.0, 0.0), "origin": (0.0, -2.0, 0.0)},)
    assert list(floored) == ["share"]


def test_surfaces_have_outlines_and_axes_and_spots_are_round(drawn):
    plane = Surface(np.stack([*np.meshgrid([0.0, 1.0], [0.0, 1.0]), np.zeros((2, 2))]), "blue", opacity=0.4)
    image = draw_space.draw_space([plane, Spot([1.0, 2.0, 3.0], "red")], CAMERA)
    meshes = [(call[1][0], call[2]) for call in drawn if call[0] == "add_mesh"]
    (grid, how), (outline, line), (spot, round_) = meshes
    assert (grid.kind, len(grid.given)) == ("grid", 3)
    assert (how["opacity"], how["ambient"], how["diffuse"]) == (0.4, 0.5, 0.5)
    assert outline.given[0] == {
        "boundary_edges": True, "feature_edges": False, "manifold_edges": False, "non_manifold_edges": False,
    }  # fmt: skip
    assert line == {"color": "black", "line_width": 2}
    assert (round_["point_size"], round_["render_points_as_spheres"]) == (16.0, True)
    assert spot.given[0].tolist() == [1.0, 2.0, 3.0]
    (bounds,) = (call[2] for call in drawn if call[0] == "show_bounds")
    assert (bounds["n_xlabels"], bounds["n_ylabels"], bounds["n_zlabels"], bounds["fmt"]) == (4, 4, 3, "%.1f")
    assert (bounds["font_size"], bounds["use_3d_text"]) == (22, False)
    assert ("zoom", draw_space._ZOOM) in drawn
    assert ("camera", *CAMERA) in drawn
    assert image.shape == (60, 90, 3)  # with axes it stays as it is
    order = [call[0] for call in drawn]
    assert order.index("reset_camera") < order.index("zoom") < order.index("reset_camera_clipping_range")
    assert order[-1] == "close"
    assert drawn[0] == ("plotter", {"off_screen": True, "window_size": draw_space._SIZE})


@pytest.mark.parametrize(
    ("longest", "decimals"), [(0.02, 4), (0.5, 3), (1.0, 2), (40.0, 1), (99.0, 1), (100.0, 0), (5e4, 0), (0.0, 0)]
)
def test_axes_have_three_digits_of_the_longest_side(longest, decimals):
    assert draw_space._labels((-1.0, -1.0 + longest, 0.0, 0.5 * longest, 2.0, 2.0)) == f"%.{decimals}f"


def test_nothing_but_white_stays_as_it_is():
    white = np.full((5, 6, 3), 255, dtype=np.uint8)
    assert draw_space._trimmed(white) is white
