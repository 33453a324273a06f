"""Traces for plotly: what is drawn how, what pointing at it says, bands of errors, numbers as plotly.js has them."""

from __future__ import annotations

import base64

import numpy as np
import pytest

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Curve, HeatMap, Points, Stems
from fegear.engine.figure.panel import Panel
from fegear.output.draw_plotly import traces
from fegear.output.draw_plotly.traces import along, rich, titled, typed

X, Y = np.array([1.0, 2.0, 4.0]), np.array([3.0, 5.0, 4.0])
AXES = Axis("angle_{1}", "deg"), Axis("stress", "MPa")


def panel(item, **more):
    return Panel(*AXES, (item,), **more)


def read(spec):
    """Numbers of a typed array."""
    found = np.frombuffer(base64.b64decode(spec["bdata"]), "<f8")
    return found.reshape([int(n) for n in spec["shape"].split(",")]) if "shape" in spec else found


def test_arrays_are_little_endian_doubles_with_their_shape_if_they_have_more_than_one_row():
    np.testing.assert_array_equal(read(typed([1, 2.5, -3])), [1.0, 2.5, -3.0])
    table = typed(np.arange(6.0).reshape(2, 3).T)
    assert table["shape"] == "3, 2"
    np.testing.assert_array_equal(read(table), [[0.0, 3.0], [1.0, 4.0], [2.0, 5.0]])
    assert "shape" not in typed([1.0])


def test_places_among_categories_have_their_names():
    axis = Axis("gear", categories=("a_{1}", "b<"))
    assert along(axis, [1.0, 0.0, np.nan, 0.2]) == ["b&lt;", "a<sub>1</sub>", None, "a<sub>1</sub>"]
    np.testing.assert_array_equal(read(along(AXES[0], X)), X)


def test_text_is_no_html_but_what_stands_lower():
    assert rich("a<b & c_{12}\nK_{Hα}") == "a&lt;b &amp; c<sub>12</sub><br>K<sub>Hα</sub>"
    assert titled("stress_{1}", "MPa") == "stress<sub>1</sub> [MPa]"
    assert titled("ratio", "") == "ratio"


@pytest.mark.parametrize("marked", [True, False])
def test_a_curve_is_a_line_that_says_its_value_in_the_unit_of_the_ordinate(marked):
    (trace,) = traces._curve(panel(one := Curve(X, Y, "load_{1}", markers=marked)), one)
    assert trace["mode"] == ("lines+markers" if one.marked else "lines")
    assert ("marker" in trace) == one.marked
    assert (trace["name"], trace["legendgroup"]) == ("load<sub>1</sub>",) * 2
    assert trace["hovertemplate"] == "%{y:.6~g} MPa"
    np.testing.assert_array_equal(read(trace["x"]), X)
    np.testing.assert_array_equal(read(trace["y"]), Y)
    assert trace["line"]["width"] == pytest.approx(one.width + 0.2)
    assert "fill" not in trace


def test_steps_are_drawn_from_place_to_place_and_fillings_down_to_zero():
    (trace,) = traces._curve(panel(one := Curve(X, Y, "load", dash="steps", fill=True)), one)
    assert trace["line"]["shape"] == "hv"
    assert trace["fill"] == "tozeroy"
    assert trace["fillcolor"] == f"{trace['line']['color']}40"


def test_a_curve_without_a_name_says_nothing_unless_it_has_notes():
    (trace,) = traces._curve(panel(one := Curve(X, Y)), one)
    assert trace["hoverinfo"] == "skip"
    assert "hovertemplate" not in trace
    (noted,) = traces._curve(panel(one := Curve(X, Y, notes=("a", "b<", "c"))), one)
    assert noted["text"] == ["a", "b&lt;", "c"]
    assert noted["hovertemplate"] == "%{text}<extra></extra>"
    (filled,) = traces._curve(panel(one := Curve(X, Y, fill=True)), one)
    assert "hovertemplate" in filled


def test_errors_are_a_band_about_what_is_known():
    error = np.array([0.1, np.nan, 0.3])
    band, trace = traces._curve(panel(one := Curve(X, Y, "load", error=error)), one)
    np.testing.assert_allclose(read(band["x"]), [1.0, 4.0, 4.0, 1.0])
    np.testing.assert_allclose(read(band["y"]), [3.1, 4.3, 3.7, 2.9])
    assert (band["fill"], band["hoverinfo"], band["legend_entry"]) == ("toself", "skip", False)
    assert band["legendgroup"] == trace["legendgroup"]
    np.testing.assert_array_equal(read(trace["customdata"]), error)
    assert trace["hovertemplate"] == "%{y:.6~g} ± %{customdata:.1~e} MPa"


def test_points_say_both_of_their_places_and_bear_notes_letters_and_errors():
    item = Points(X, Y, "peaks", notes=("a", "b", "c"), error=Y / 10.0, size=7, symbol="diamond")
    (trace,) = traces._points(panel(item), item)
    assert (trace["mode"], trace["marker"]["symbol"], trace["marker"]["size"]) == ("markers", "diamond", 7)
    place = trace["hovertemplate"].removeprefix("%{text}<br>")
    assert place.startswith("%{x:.6~g} ")
    assert place.endswith(", %{y:.6~g} MPa")
    assert trace["text"] == ["a", "b", "c"]
    np.testing.assert_allclose(read(trace["error_y"]["array"]), Y / 10.0)
    plain = Points(X, Y, "peaks")
    (trace,) = traces._points(panel(plain), plain)
    assert "error_y" not in trace
    assert trace["hovertemplate"] == place


@pytest.mark.parametrize(("size", "mode"), [(7, "markers+text"), (0, "text")])
def test_labels_stand_on_points_or_in_their_place(size, mode):
    item = Points(X, Y, "", labels=("a", "b_{1}", "c"), size=size)
    (trace,) = traces._points(panel(item), item)
    assert (trace["mode"], trace["text"]) == (mode, ["a", "b<sub>1</sub>", "c"])
    assert (trace["textposition"], trace["textfont"]) == ("middle center", {"size": 11})


def test_shades_are_powers_of_ten_with_whole_ticks():
    item = Points(X, Y, "", shade=np.array([0.02, 5.0, 300.0]), shade_label="error")
    (trace,) = traces._points(panel(item), item)
    np.testing.assert_allclose(read(trace["marker"]["color"]), np.log10([0.02, 5.0, 300.0]))
    bar = trace["marker"]["colorbar"]
    assert bar["tickvals"] == [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
    assert bar["ticktext"][0] == "10<sup>-2</sup>"
    assert trace["marker"]["showscale"] is True


def test_stems_reach_down_to_the_foot_of_their_panel():
    item = Stems(X, Y, "orders", numbers=("1", "2", "3"), notes=("n1", "n2", "n<"))
    there = panel(item)
    (trace,) = traces._stems(there, item)
    bars = trace["error_y"]
    np.testing.assert_allclose(read(bars["arrayminus"]), Y - there.foot)
    np.testing.assert_array_equal(read(bars["array"]), np.zeros(3))
    assert (bars["symmetric"], bars["width"], bars["thickness"]) == (False, 0, 1)
    assert (trace["mode"], trace["text"]) == ("markers+text", ["1", "2", "3"])
    assert trace["customdata"] == ["n1", "n2", "n&lt;"]
    assert "%{customdata}" in trace["hovertemplate"]
    assert "%{text}" not in trace["hovertemplate"]
    plain = Stems(X, Y, "orders")
    (trace,) = traces._stems(panel(plain), plain)
    assert trace["mode"] == "markers"
    assert "customdata" not in trace


@pytest.mark.parametrize("centre", [(-6.0, 6.0), None])
def test_a_map_has_its_own_ends_of_colours_and_numbers(centre):
    z = np.array([[1.0, 2.0, np.nan], [-4.0, 5.0, 6.0]])
    item = HeatMap(X, Y[:2], z, "error_{1}", "um", centre=centre, numbers=True)
    (trace,) = traces._heat(panel(item), item)
    assert (trace["zmin"], trace["zmax"]) == item.ends
    np.testing.assert_array_equal(read(trace["z"]), z)
    assert trace["text"] == [["1.00", "2.00", "×"], ["-4.00", "5.00", "6.00"]]
    assert trace["hovertemplate"].startswith("angle<sub>1</sub> %{x}<br>stress %{y}<br>error<sub>1</sub> %{z:.5~g} ")
    if centre:
        assert [row[0] for row in trace["colorscale"]][::10] == pytest.approx(
            np.arange(0, len(traces.DIVERGING), 10) / (len(traces.DIVERGING) - 1)
        )
    plain = HeatMap(X, Y[:2], z, "error", "um")
    assert "text" not in traces._heat(panel(plain), plain)[0]


def test_one_name_has_one_entry_in_the_legend_and_bands_have_none():
    made = [{"name": "a", "legend_entry": False}, {"name": "a"}, {"name": "a"}, {"name": ""}, {}, {"name": "b"}]
    traces.one_entry_each(made)
    assert [one["showlegend"] for one in made] == [False, True, False, False, False, True]
    assert not any("legend_entry" in one for one in made)
    assert [traces.anchor(number) for number in (1, 2, 13)] == ["", "2", "13"]


@pytest.mark.parametrize("shared", [True, False])
def test_all_in_a_panel_is_on_its_own_axes(shared):
    items = Curve(X, Y, "load"), Points(X, Y, "peaks")
    made = traces.traces(Panel(*AXES, items), 3, shared=shared)
    assert [(one["xaxis"], one["yaxis"]) for one in made] == [("x3", "y3")] * 2
    assert all(one["hovertemplate"].endswith("<extra></extra>") is not shared for one in made)
    noted = Curve(X, Y, "load", notes=("a", "b", "c"))
    (trace,) = traces.traces(Panel(*AXES, (noted,)), 1, shared=False)
    assert trace["hovertemplate"] == "%{text}<extra></extra>"
