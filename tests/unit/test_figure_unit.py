"""Descriptions of figures and their two renderers: the same arrays, names that are text, pictures that open."""

from __future__ import annotations

import base64
import json
import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import MissingLibraryError
from fegear.engine.colours import ROLES
from fegear.engine.figure.axis import Axis, Scale, round_numbers
from fegear.engine.figure.family import few
from fegear.engine.figure.figure import DeferredFigure, Figure, View
from fegear.engine.figure.items import (
    Bars,
    Curve,
    HeatMap,
    Mark,
    Points,
    Spot,
    Stems,
    Surface,
    TriangleField,
    Zone,
)
from fegear.engine.figure.panel import Panel
from fegear.output.draw_plotly.layout import darker, plotly_json, template
from fegear.output.draw_plotly.notebook import notebook_bundle, page_html
from fegear.output.draw_png import draw_pictures
from fegear.output.draw_png.sheet import Sheet
from fegear.output.shades import shade


def array(spec: dict) -> np.ndarray:
    found = np.frombuffer(base64.b64decode(spec["bdata"]), dtype=spec["dtype"])
    return found.reshape([int(n) for n in spec["shape"].split(",")]) if "shape" in spec else found


def everything() -> Figure:
    """One figure with every kind of item that a page draws itself."""
    x = np.linspace(1.0, 5.0, 30)
    scale = Scale("radius", "mm", x, 2.0 * x)
    return Figure("all", "All", "A caption.", (
        Panel(Axis("x", "mm", second=scale), Axis("c_{0}", "um.mm/N"), (
            Curve(x, np.sin(x), "curve", "tension", 0.1 + 0.0 * x), Points(x, np.cos(x), "points", "series:1"),
        ), (Mark("x", 2.0, "here"), Zone("y", -0.1, 0.1)), "A title"),
        Panel(Axis("mode", categories=("a", "b")), Axis("share"), (
            Bars([0, 1], [0.2, 0.4], "first", "series:0"), Bars([0, 1], [0.5, 0.1], "second", "series:1"),
        ), stacked=True),
        Panel(Axis("f", "Hz"), Axis("F", "N", log=True), (Stems([1.0, 2.0], [10.0, 1e-3], "lines", "series:2"),)),
        Panel(Axis("x"), Axis("y"), (HeatMap([1, 2, 3], [1, 2], [[1, 2, np.nan], [4, 5, 6]], "z", "um"),)),
    ))  # fmt: skip


def test_arrays_are_copies_that_nobody_can_change():
    given_x = np.arange(3.0)
    curve = Curve(given_x, [1, 2, 3])
    given_x[0] = 9.0
    assert np.asarray(curve.x).tolist() == [0.0, 1.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        np.asarray(curve.y)[0] = 5.0


def test_plotly_gets_every_number_to_the_last_bit_and_plain_json():
    figure = everything()
    spec = json.loads(json.dumps(plotly_json(figure), allow_nan=False))
    curve = next(trace for trace in spec["data"] if trace.get("name") == "curve" and "customdata" in trace)
    item = figure.panels[0].items[0]
    assert np.array_equal(array(curve["x"]), item.x)
    assert np.array_equal(array(curve["y"]), item.y)
    assert np.array_equal(array(curve["customdata"]), item.error)
    tiles = next(trace for trace in spec["data"] if trace["type"] == "heatmap")
    assert np.array_equal(array(tiles["z"]), figure.panels[3].items[0].z, equal_nan=True)
    assert array(tiles["z"]).shape == (2, 3)


def test_bars_of_one_place_stand_on_each_other_or_side_by_side():
    panel = everything().panels[1]
    (_, a, below_a, _), (_, b, below_b, width) = panel.bars()
    assert a.tolist() == b.tolist() == [0.0, 1.0]
    assert (below_a.tolist(), below_b.tolist()) == ([0.0, 0.0], [0.2, 0.4])
    beside = Panel(panel.x, panel.y, panel.items)
    (_, a, _, _), (_, b, foot, width) = beside.bars()
    assert np.allclose(b - a, width)
    assert not foot.any()


@pytest.mark.dear("svg")
@pytest.mark.parametrize("kind", ["png", "svg"])
def test_a_picture_of_everything_can_be_read(tmp_path, kind):
    (picture,) = draw_pictures(everything(), tmp_path, kind)
    assert picture.path == tmp_path / f"all.{kind}"
    if kind == "svg":
        again = tmp_path / "again"
        again.mkdir()
        (twice,) = draw_pictures(everything(), again, kind)
        assert picture.path.read_bytes() == twice.path.read_bytes()
        return
    from matplotlib.image import imread

    image = imread(picture.path)
    assert min(image.shape[:2]) > 400
    assert (image[..., :3].min(axis=2) < 0.9).mean() > 0.01


@pytest.mark.dear
@pytest.mark.examples(15, 1000)
@given(st.text(min_size=1, max_size=30))
def test_names_are_text_and_never_markup(name):
    figure = Figure("k", "t", "c", (Panel(Axis(name), Axis("y"), (Curve([0, 1], [0, 1], name, "series:0"),)),))
    spec = plotly_json(figure)
    shown = spec["data"][0]["name"]
    assert re.sub(r"</?sub>|<br>", "", shown).count("<") == 0
    assert "<script" not in json.dumps(spec)


@pytest.mark.parametrize("name", ["a $x$ b", "50 % \\alpha", "p_{1} and $", "x_{$}", "under_score", "Δ_{θx}"])
def test_names_that_look_like_mathematics_are_drawn(tmp_path, name):
    panel = Panel(Axis(name), Axis("y"), (Curve([0, 1], [0, 1], name, "blue"), Curve([0, 1], [1, 0], "b", "red")))
    (picture,) = draw_pictures(Figure("k", "t", "c", (panel,)), tmp_path)
    assert picture.path.stat().st_size > 5_000


def test_a_menu_shows_one_view_and_paper_shows_them_beside_each_other(tmp_path):
    views = tuple(
        View(f"view {k}", (Panel(Axis("x"), Axis("y", "N"), (Curve([0, 1], [0, k], "c", "blue"),)),)) for k in range(6)
    )
    spec = plotly_json(Figure("k", "t", "c", views=views))
    assert [trace.get("visible", True) for trace in spec["data"]] == [True] + [False] * 5
    buttons = spec["layout"]["updatemenus"][0]["buttons"]
    assert [button["args"][0]["visible"].index(True) for button in buttons] == list(range(6))
    assert len(list(draw_pictures(Figure("k", "t", "c", views=views), tmp_path))) == 1
    alone = tuple(View(view.label, view.panels, f"own_{k}") for k, view in enumerate(views))
    names = [picture.path.stem for picture in draw_pictures(Figure("k", "t", "c", views=alone), tmp_path)]
    assert names == [f"own_{k}" for k in range(6)]


def test_titles_and_marks_of_panels_are_those_of_the_chosen_view():
    """The chart of a second design bore the amounts and the start of the first."""

    def views(*titles):
        return tuple(
            View(one, (Panel(Axis("x"), Axis("y"), (Curve([0, 9], [0, 1], "c", "blue"),), (Mark("x", n, one),), one),))
            for n, one in enumerate(titles, start=2)
        )

    layout = plotly_json(Figure("k", "t", "c", views=views("first", "second")))["layout"]
    for number, button in enumerate(layout["updatemenus"][0]["buttons"]):
        own = button["args"][1]
        assert {note["text"] for note in own["annotations"]} == {
            ("first", "second")[number], ("<b>first</b>", "<b>second</b>")[number]
        }  # fmt: skip
        assert [shape["x0"] for shape in own["shapes"]] == [2 + number]
    assert layout["annotations"] == layout["updatemenus"][0]["buttons"][0]["args"][1]["annotations"]
    (view,) = views("same")
    alike = plotly_json(Figure("k", "t", "c", views=(view, view)))["layout"]["updatemenus"][0]["buttons"]
    assert all("annotations" not in button["args"][1] for button in alike)


def test_the_margin_has_room_for_the_longest_legend_of_all_views():
    def view(count):
        curves = tuple(Curve([0, 1], [0, k], f"curve {k}", f"series:{k}") for k in range(count))
        return View(f"{count} curves", (Panel(Axis("x"), Axis("y", "N"), curves),))

    few, many = (plotly_json(Figure("k", "t", "c", views=(view(2), view(n)))) for n in (2, 9))
    assert [one["layout"]["meta"]["names"] for one in (few, many)] == [2, 9]
    assert many["layout"]["margin"]["t"] > few["layout"]["margin"]["t"]


def test_every_role_has_a_shade_on_either_ground_and_pages_know_the_pairs():
    pairs = [shade(role) for role in (*ROLES, "series:7", "ramp:0.000", "ramp:1.000", "ramp:0.333")]
    assert all(re.fullmatch("#[0-9A-F]{6}", colour) for pair in pairs for colour in pair)
    figure = everything()
    known = darker([figure])
    used = set(re.findall("#[0-9A-F]{6}", json.dumps([plotly_json(figure), template()])))
    assert used <= set(known)


def test_curves_that_hardly_vary_are_drawn_level():
    level = Panel(Axis("x"), Axis("y"), (Curve([0, 1], [100.0, 100.001]),))
    assert level.limits == pytest.approx((95.0, 105.0), rel=1e-3)
    assert Panel(Axis("x"), Axis("y"), (Curve([0, 1], [100.0, 101.0]),)).limits is None


def test_words_of_marks_that_would_lie_on_each_other_are_said_once():
    marks = tuple(Mark("y", at, f"mode {at}") for at in (1.0, 1.01, 2.0))
    panel = Panel(Axis("x"), Axis("y", limits=(0.0, 3.0)), (Curve([0, 1], [0, 3]),), marks)
    assert [panel.written(mark) for mark in marks] == ["mode 1.0", "", "mode 2.0"]


@given(st.floats(-1e6, 1e6), st.floats(1e-6, 1e6))
def test_round_numbers_lie_between_the_ends_and_are_few(low, width):
    found = round_numbers(low, low + width)
    if low + width > low:
        step = 1e-6 * width
        assert ((found >= low - step) & (found <= low + width + step)).all()
        assert found.size <= 8


def test_a_family_keeps_its_ends_and_what_it_must():
    assert few(5) == [0, 1, 2, 3, 4]
    chosen = few(100, (37,))
    assert {0, 37, 99} <= set(chosen)
    assert len(chosen) <= 8


def test_fields_are_pictures_in_pages_and_notebooks(tmp_path):
    field = TriangleField([[0, 1, 0], [0, 0, 1]], np.array([[0], [1], [2]]), [0, 1, 2], 2.0, "stress", "MPa")
    figure = Figure("f", "<Field>", "c", (Panel(Axis("x"), Axis("y"), (field,), equal=True),))
    assert not figure.drawable_in_page
    assert everything().drawable_in_page
    made = figure._repr_mimebundle_()
    shown = made["text/html"]
    assert list(made) == ["text/html"]
    assert "data:image/png;base64," in shown
    assert "&lt;Field&gt;" in shown
    deferred = DeferredFigure("f", "Field", lambda: figure)
    assert deferred.make() is figure


@pytest.mark.parametrize("log", [False, True])
def test_what_is_empty_or_unknown_is_drawn_empty(tmp_path, log):
    nothing, unknown = np.empty(0), np.full(3, np.nan)
    items = (
        Curve(nothing, nothing, "a"), Curve([1, 2, 3], unknown, "b", error=unknown), Points(nothing, nothing, "c"),
        Stems(nothing, nothing, "d"), Points([1, 2, 3], unknown, "e", notes=("x", "y", "z")),
    )  # fmt: skip
    panel = Panel(Axis("x"), Axis("y", log=log), items, (Mark("y", 1.0, "one"),))
    tiles = HeatMap([1, 2], [1, 2], np.full((2, 2), np.nan), "z")
    figure = Figure("k", "t", "c", (panel, Panel(Axis("x"), Axis("y"), (tiles,))))
    json.dumps(plotly_json(figure), allow_nan=False)
    (picture,) = draw_pictures(figure, tmp_path)
    assert picture.path.is_file()


def in_space() -> Figure:
    points = np.stack([*np.meshgrid([0.0, 1.0], [0.0, 2.0], indexing="ij"), np.ones((2, 2))])
    items = Surface(points, "blue"), Spot([0, 0, 1], "red")
    return Figure("space", "Space", "c", (Panel(Axis(), Axis(), items, camera=((1, 1, 9), (0, 0, 0), (0, 1, 0))),))


def test_surfaces_are_seen_by_their_camera(tmp_path, monkeypatch):
    asked = []
    image = np.full((90, 140, 3), 128, dtype=np.uint8)
    monkeypatch.setattr("fegear.output.draw_space.draw_space", lambda *given: (asked.append(given), image)[1])
    assert not in_space().drawable_in_page
    (picture,) = draw_pictures(in_space(), tmp_path)
    assert picture.path.stat().st_size > 1_000
    ((items, camera),) = asked
    assert [type(item).__name__ for item in items] == ["Surface", "Spot"]
    assert camera == ((1, 1, 9), (0, 0, 0), (0, 1, 0))


def test_a_system_that_cannot_draw_in_space_is_told_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr("ctypes.util.find_library", lambda _name: None)
    with pytest.raises(MissingLibraryError, match="apt-get install libegl1"):
        list(draw_pictures(in_space(), tmp_path))


def test_a_page_shows_a_plot():
    shown = page_html(everything())
    assert "Plotly.newPlot" in shown
    assert "A caption." in shown
    assert len(shown) > 1_000_000  # plotly.js comes with it, unless a figure before it has brought it
    assert len(page_html(everything(), library=False)) < 200_000


def test_a_notebook_shows_a_plot_without_the_library():
    made = notebook_bundle(everything())
    assert "A caption." in made["text/html"]
    assert "data:image/png;base64," in made["text/html"]
    plot = made["application/vnd.plotly.v1+json"]
    assert "bdata" not in json.dumps(plot, allow_nan=False)
    traces = [
        (one["y"], other["y"]) for one, other in zip(plotly_json(everything())["data"], plot["data"], strict=True)
    ]
    typed = [(y, plain) for y, plain in traces if isinstance(y, dict)]
    assert len(typed) > 3
    for y, plain in typed:
        read = np.frombuffer(base64.b64decode(y["bdata"]))
        assert [np.nan if value is None else value for value in plain] == pytest.approx(read.tolist(), nan_ok=True)


def test_letters_of_points_and_marks_are_read_on_paper_and_in_pages():
    from matplotlib.figure import Figure as Canvas

    points = Points([0, 1], [0, 1], "", "ink", written=True, notes=("A", "B_{2}"))
    long = Points([0, 1], [0, 1], "", "ink", written=True, notes=("0.1 s", "2 s"))
    assert (points.lettered, long.lettered) == (True, False)
    panel = Panel(Axis("x"), Axis("y"), (points,), (Mark("x", 0.5, "C"),))
    spec = plotly_json(Figure("k", "t", "c", (panel,)))
    (trace,) = (one for one in spec["data"] if "text" in one)
    assert (trace["mode"], trace["text"]) == ("markers+text", ["A", "B<sub>2</sub>"])
    assert [one["text"] for one in spec["layout"]["annotations"]] == ["C"]
    made = Canvas()
    Sheet(made, [(panel, "")], 1).draw()
    assert {text.get_text() for text in made.axes[0].texts} == {"A", "B₂", "C"}


def two_maps() -> tuple[Panel, Panel]:
    """Maps of different quantities, the first with long numbers."""
    x, y = np.arange(3.0), np.arange(2.0)
    over = Axis("face position", "mm"), Axis("roll angle of the load", "deg")
    maps = (HeatMap(x, y, np.linspace(0.0141, 0.0357, 6).reshape(2, 3), "c_{0}", "um/N"),
            HeatMap(x, y, np.linspace(0.2, 0.4, 6).reshape(2, 3), "maximum root stress "
                                                                  "(tension side)", "MPa/N"))  # fmt: skip
    return tuple(Panel(*over, (one,), title=one.label) for one in maps)


def test_scales_of_colours_in_a_page_stand_beside_their_panels():
    """Each as high as its own: those of two maps lay on each other."""
    spec = plotly_json(Figure("two", "Two", "Two maps.", two_maps()))
    ends = []
    for trace, axis in zip(spec["data"], ("yaxis", "yaxis2"), strict=True):
        bar = trace["colorbar"]
        ends.append((bar["y"] - 0.5 * bar["len"], bar["y"] + 0.5 * bar["len"]))
        assert ends[-1] == pytest.approx(spec["layout"][axis]["domain"])
    assert ends[1][1] < ends[0][0]


def test_a_scale_of_colours_on_paper_has_room_for_its_numbers():
    """Six letters beside the left map's: its label lay on that of the next panel."""
    from matplotlib.figure import Figure as Made

    made = Made()
    sheet = Sheet(made, [(panel, panel.title) for panel in two_maps()], 2)
    sheet.draw()
    made.draw_without_rendering()
    left, right = (axes.get_tightbbox() for axes in (made.axes[2], made.axes[1]))
    assert left.x1 <= right.x0


@pytest.mark.parametrize("symbol", ["", "x", "star"])
def test_points_have_the_symbol_that_they_ask_for_or_their_role_s_own(symbol):
    from fegear.engine.colours import look

    roles = ("tension", "series:1", "ink")
    panel = Panel(Axis("x"), Axis("y"), tuple(Points([1.0], [2.0], role, role, symbol=symbol) for role in roles))
    drawn = [trace for trace in plotly_json(Figure("f", "F", "c", (panel,)))["data"] if trace.get("mode") == "markers"]
    assert [trace["marker"]["symbol"] for trace in drawn] == [symbol or look(role).symbol for role in roles]


def plain(x="x", y="y", unit="", **more):
    return Panel(Axis(x, unit), Axis(y), (Curve([0.0, 1.0], [1.0, 2.0], "one"),), **more)


@pytest.mark.parametrize(("columns", "letters"), [(1, 78), (2, 51), (3, 40), (5, 40)])
def test_titles_are_broken_to_the_width_of_a_panel(columns, letters):
    """6.5, 4.3 or 3.4 inches of 0.083 a letter; the lines that a title has stay its own."""
    word = "wide " * 40
    sheet = Sheet(None, [(plain(), f"First line\n{word.strip()}")] * 6, columns)
    first, *others = sheet.panels[0][1].split("\n")
    assert first == "First line"
    assert all(letters - 5 < len(line) <= letters for line in others[:-1])
    assert " ".join(others) == word.strip()
    assert sheet.rows == math.ceil(6 / columns)


def test_panels_share_what_names_their_axes():
    """The abscissa with the panel below, the ordinate with that to the left, of the same row; none in spaces."""
    a, b = plain("x", "y"), plain("x", "z")
    sheet = Sheet(None, [(a, ""), (b, ""), (a, ""), (plain("t", "z"), ""), (plain("x", "z"), "")], 2)
    assert [sheet._joined(row, column) for row, column in ((0, 0), (0, 1), (1, 0), (1, 1))] == [
        True,
        False,
        True,
        False,
    ]
    assert [sheet._beside(i) for i in range(5)] == [False, False, False, False, False]
    assert [list(sheet._row(row)) for row in range(3)] == [[0, 1], [2, 3], [4]]
    assert [list(sheet._column(column)) for column in range(2)] == [[0, 2, 4], [1, 3]]
    alike = Sheet(None, [(a, ""), (plain("t", "y"), "")], 2)
    assert [alike._beside(i) for i in range(2)] == [False, True]


def test_rows_of_words_have_a_height_each_and_other_panels_one_by_their_share():
    def height(*panels):
        return plotly_json(Figure("f", "F", "C.", panels))["layout"]["height"]

    x = np.linspace(0.0, 1.0, 5)

    def rows(count, share=1.0):
        words = tuple(f"row {k}" for k in range(count))
        return Panel(Axis("x"), Axis(categories=words), (Points(x[:2], [0.0, 1.0], "p", "ink"),), height=share)

    def plain(share=1.0):
        return Panel(Axis("x"), Axis("y"), (Curve(x, x, "c"),), height=share)

    more = height(rows(9)) - height(rows(5))
    assert more == pytest.approx(4.0 * 26)  # a line of text and some room
    assert height(rows(9)) == height(rows(9, 2.0))  # by their rows, not by their share
    alone = height(plain(2.0)) - height(plain())
    stacked = (height(plain(2.0), plain(2.0)) - height(plain(), plain())) / 2.0
    assert height(plain(3.0)) - height(plain()) == pytest.approx(2.0 * alone)
    assert alone > stacked > 100.0
