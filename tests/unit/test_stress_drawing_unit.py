"""Gears in mesh as they are drawn for slides: where letters, arrows, words and the scale are."""

from __future__ import annotations

import math

import matplotlib.figure
import numpy as np
import pytest
from matplotlib.colors import to_hex

from fegear.output.draw_png import stress_drawing
from fegear.output.shades import LIGHT
from fegear.results.pair.drawn_mesh import StressDrawing

ALONG = np.array([math.cos(math.radians(20.0)), math.sin(math.radians(20.0))])
MODULE = 4.0


def drawing(**given) -> StressDrawing:
    usual = {
        "name": "I", "letter": "B", "under": "120 N m",
        "points": np.array([[0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]),
        "triangles": np.array([[0, 1], [1, 3], [2, 2]]), "stress": np.array([0.0, 10.0, 90.0, 400.0]), "top": 250.0,
        "outlines": {"driver": np.array([[-1.0, 0.0, 1.0], [-2.0, -1.0, -2.0]]),
                     "driven": np.array([[-1.0, 0.0, 1.0], [2.0, 1.0, 2.0]])},
        "along": ALONG, "path": np.array([-10.0, 12.0]),
        "letters": (("A", -8.0), ("B", 1.0), ("C", 0.0), ("D", 1.5), ("E", 9.0)),
        "loads": ((1.0, 3000.0), (-10.0, 1000.0)), "load": 4000.0, "room": (20.0, 15.0), "module": MODULE,
    }  # fmt: skip
    return StressDrawing(**usual | given)


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """What is saved, and how."""
    saved = {}

    def savefig(self, path, **settings):
        saved.update(canvas=self, path=path, settings=settings)

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", savefig)
    stress_drawing.write_drawing(drawing(), "a case", tmp_path / "mesh.svg")
    return saved


def texts(axes) -> dict[str, object]:
    return {one.get_text(): one for one in axes.texts if one.get_text()}


def test_the_drawing_has_its_scale_its_title_and_equal_lengths_both_ways(drawn):
    canvas, (axes, bar) = drawn["canvas"], drawn["canvas"].axes
    assert drawn["path"].name == "mesh.svg"
    wide, tall = canvas.get_size_inches()
    assert (wide, tall) == pytest.approx((9.0, 9.0 * 15.0 / 20.0 + 0.55 + 0.75))
    assert (axes.get_xlim(), axes.get_ylim()) == ((-20.0, 20.0), (-15.0, 15.0))
    box = axes.get_position()
    assert box.height * tall / 30.0 == pytest.approx(box.width * wide / 40.0)  # inches per mm
    assert box.y0 * tall == pytest.approx(0.75)
    assert box.y1 * tall == pytest.approx(tall - 0.55)
    assert not axes.axison
    title, case, scale = canvas.texts
    assert title.get_text() == "Pair I, contact at B, 120 N m"
    assert (case.get_text(), case.get_ha(), scale.get_ha()) == ("a case", "right", "right")
    middle = tall - 0.5 * 0.55
    assert [one.get_position()[1] * tall for one in (title, case)] == pytest.approx([middle, middle])
    assert [one.get_position()[0] * wide for one in (title, case)] == pytest.approx([0.12, 9.0 - 0.12])
    assert [title.get_fontsize(), case.get_fontsize(), scale.get_fontsize()] == [17, 12, 12]
    # the scale is below the drawing, in the middle, with its words at its left
    box = bar.get_position()
    assert (box.x0, box.width, box.y0 * tall, box.height * tall) == pytest.approx((0.3, 0.4, 0.45 * 0.75, 0.2))
    assert scale.get_text() == "von Mises stress [MPa]"
    assert scale.get_position() == pytest.approx((0.285, box.y0))


def test_colours_begin_at_no_stress_and_end_at_the_top(drawn):
    axes, bar = drawn["canvas"].axes
    (mesh,) = axes.collections
    assert mesh.get_clim() == (0.0, 250.0)
    assert bar.get_xlim() == (0.0, 250.0)
    assert mesh.get_rasterized()
    np.testing.assert_array_equal(np.asarray(mesh.get_array()), [0.0, 10.0, 90.0, 400.0])
    light, dark = (sum(mesh.cmap(mesh.norm(one))[:3]) for one in (0.0, 250.0))
    assert light > dark


def test_both_gears_have_their_outline_and_their_name_on_their_own_side(drawn):
    axes = drawn["canvas"].axes[0]
    driver, driven = axes.lines[:2]
    assert [to_hex(one.get_color()) for one in (driver, driven)] == [to_hex(LIGHT[one]) for one in ("blue", "red")]
    np.testing.assert_array_equal(driver.get_ydata(), [-2.0, -1.0, -2.0])
    np.testing.assert_array_equal(driven.get_ydata(), [2.0, 1.0, 2.0])
    names = texts(axes)
    assert names["driver"].get_position() == pytest.approx((-0.98 * 20.0, -0.97 * 15.0))
    assert names["driven"].get_position() == pytest.approx((-0.98 * 20.0, 0.97 * 15.0))
    assert (names["driver"].get_va(), names["driven"].get_va()) == ("bottom", "top")


def test_points_are_on_the_line_of_action_and_their_letters_do_not_meet(drawn):
    axes = drawn["canvas"].axes[0]
    path, *points = axes.lines[2:8]
    np.testing.assert_allclose(path.get_xydata(), np.outer([-10.0, 12.0], ALONG))
    np.testing.assert_allclose([one.get_xydata()[0] for one in points],
                               np.outer([-8.0, 1.0, 0.0, 1.5, 9.0], ALONG))  # fmt: skip
    at = {letter: texts(axes)[letter].get_position() for letter in "ABCDE"}
    for letter, place in (("A", -8.0), ("B", 1.0), ("D", 1.5), ("E", 9.0)):
        assert at[letter][1] == pytest.approx((ALONG * place)[1] + 0.24 * MODULE)
    for letter, place in (("A", -8.0), ("B", 1.0), ("E", 9.0)):
        assert at[letter][0] == pytest.approx((ALONG * place)[0] - 0.1 * MODULE)
    assert at["D"][0] == pytest.approx(at["B"][0] + 0.34 * MODULE)  # B would be in its way
    assert at["C"] == pytest.approx((0.0, -0.52 * MODULE))  # below


def test_arrows_begin_at_the_contacts_and_are_as_long_as_their_loads(drawn):
    axes = drawn["canvas"].axes[0]
    arrows = [one for one in axes.texts if not one.get_text()]
    assert len(arrows) == 2
    across = np.array([ALONG[1], -ALONG[0]])  # to the right of the arrow
    labels = texts(axes)
    for arrow, dot, (place, load, said) in zip(
        arrows, axes.lines[8:], ((1.0, 3000.0, "3 kN"), (-10.0, 1000.0, "1 kN")), strict=True
    ):
        start = ALONG * place
        end = start + ALONG * 2.6 * MODULE * load / 4000.0
        np.testing.assert_allclose(arrow.xyann, start)
        np.testing.assert_allclose(arrow.xy, end)
        np.testing.assert_allclose(dot.get_xydata()[0], start)
        np.testing.assert_allclose(labels[said].get_position(), end + 0.22 * MODULE * (ALONG + across))
