"""A sheet: where quantities stand, how sentences are filled, tables, values and figures from declarations."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.shown import declared, shown, shown_as, shows
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Bars, Curve, HeatMap, Stems
from fegear.engine.sheet.chart import LOADS, Bundle, Chart, Family, Line, Map, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Every, EveryLoad, Off, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import UNSHOWN, Remark, Sheet


@dataclass(frozen=True)
class Swing:
    """Deflection over a roll, under two loads."""

    x: np.ndarray = shown("mm", "position", table="path")
    deflection: np.ndarray = shown("um", "of the tooth", label="deflection", table="path")
    lacking: np.ndarray | None = shown("um", "known for some only", table="path", default=None)
    off: np.ndarray | None = None
    word: str = shown("", "in words", default="stiff")

    @property
    @shows("um", "largest")
    def largest(self) -> np.ndarray:
        return self.deflection.max(axis=0)


@dataclass(frozen=True)
class Data:
    """What a result computes."""

    swing: Swing
    loads: tuple[float, ...] = (100.0, 200.0)
    parts: dict[str, Swing] = field(default_factory=dict)
    nothing: None = None
    at: int = 1


SWING = Swing(np.array([0.0, 1e-3]), np.array([[1e-6, 2e-6], [3e-6, 6e-6]]), off=np.array([[1e-9, 2e-9], [3e-9, 4e-9]]))
DATA = Data(SWING, parts={"a": SWING, "b": replace(SWING, x=np.array([0.0, 2e-3]))})
SEEN = Seen(DATA, SimpleNamespace(name="I", tolerance=1e-3), "I", DATA.loads, 1)


def test_paths_lead_to_what_stands_there_and_end_at_none() -> None:
    assert SEEN.find("swing.x") is SWING.x
    assert SEEN.find("") is DATA
    assert SEEN.find("parts.b.x") is DATA.parts["b"].x
    assert SEEN.find("nothing.anything.more") is None
    assert SEEN.find(lambda seen: seen.asked.tolerance) == 1e-3
    with pytest.raises(AttributeError):
        SEEN.find("swing.missspelt")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Pair {name}: no field", "Pair I: no field"),
        ("at {load:.5g} N", "at 200 N"),
        ("{d.swing.largest:.3g!} um", "6 um"),
        ("{d.swing.largest:.3g} at most", "6 µm at most"),  # of the nominal load, in its unit
        ("{d.swing.word} teeth", "stiff teeth"),
        ("within {asked.tolerance:.0e}", "within 1e-03"),
        ("{d.at} of {d.loads}", "1 of (100.0, 200.0)"),
    ],
)
def test_sentences_are_filled_in(text: str, said: str) -> None:
    assert SEEN.said(text) == said


def test_quantities_of_a_declared_object_are_written_in_their_units() -> None:
    @dataclass(frozen=True)
    class Whole:
        swing: Swing = shown("", "its swing")

    assert replace(SEEN, data=Whole(SWING)).said("{d.swing.largest:.3g} of {d.swing.word}") == "6 µm of stiff"


def test_a_sentence_with_an_unknown_field_is_no_sentence() -> None:
    with pytest.raises((AttributeError, KeyError)):
        SEEN.said("{d.swing.missspelt:.3g}")


def test_repetitions_know_their_name_and_object() -> None:
    seen = list(SEEN.each("parts"))
    assert [one.key for one in seen] == ["a", "b"]
    assert seen[1].find("x") is DATA.parts["b"].x
    assert seen[1].said("{key}: {one.largest:.3g}") == "b: 6 µm"
    assert [one.key for one in SEEN.each("loads")] == ["0", "1"]
    assert list(SEEN.each("nothing")) == []
    assert list(SEEN.each(None)) == [SEEN]


@pytest.mark.parametrize(
    ("when", "holds"),
    [(None, True), ("nothing", False), ("parts", True), ("swing.x", True), (lambda seen: seen.data.at > 1, False)],
)
def test_conditions(when: object, holds: bool) -> None:
    assert SEEN.holds(when) is holds  # type: ignore[arg-type]


def test_a_table_has_the_declared_columns_of_the_nominal_load() -> None:
    rows = Rows("swing_{name}", "Swing, {load:.6g} N", (Every("path"), Off("deflection", "swing.off")), of="swing")
    (table,) = rows.tables(SEEN)
    assert (table.name, table.title) == ("swing_I", "Swing, 200 N")
    assert table.keys() == ("x", "deflection", "deflection_error")  # and none for what this result lacks
    np.testing.assert_allclose(table["deflection"], [2.0, 6.0])
    np.testing.assert_allclose(table["deflection_error"], [2e-3, 4e-3])
    assert table.column("deflection").unit == table.column("deflection_error").unit == "um"


def test_a_table_for_every_load_stands_below_itself() -> None:
    (table,) = EveryLoad("all", "All", (Every("path"),), "swing", (Swing, "x")).tables(SEEN)
    np.testing.assert_allclose(table.columns[0].si, [100.0, 100.0, 200.0, 200.0])
    np.testing.assert_allclose(table["deflection"], [1.0, 3.0, 2.0, 6.0])
    one_load = replace(SEEN, loads=(100.0,), nominal=0)
    assert list(EveryLoad("all", "All", (Every("path"),), "swing", (Swing, "x")).tables(one_load)) == []


def test_cells_take_other_numbers_names_and_words() -> None:
    cell = Cell("deflection", si=lambda _: np.array([7e-6]), name="sag_{key}", meaning="of part {key}", each="parts")
    (table,) = Rows(
        "t", "T", (Cell("x", further=" of {name}", ending="_i"), cell), of=lambda _: replace(SWING, x=np.zeros(1))
    ).tables(SEEN)
    assert table.keys() == ("x_i", "sag_a", "sag_b")
    assert [one.meaning for one in table.columns] == ["position of I", "of part a", "of part b"]
    (none,) = Rows("t", "T", ("x", Cell("deflection", si="nothing")), of="swing").tables(SEEN)
    assert none.keys() == ("x",)


def test_the_error_of_a_cell_stands_behind_it_under_its_name() -> None:
    cell = Cell("deflection", name="sag_{key}", each="parts", error=lambda seen: 0.1 * seen.one.deflection)
    columns = (cell, Cell("swing.deflection", error="nothing"), Cell("swing.lacking", error="swing.off"))
    (table,) = Rows("t", "T", columns).tables(SEEN)
    assert table.keys() == ("sag_a", "sag_a_error", "sag_b", "sag_b_error", "deflection")
    np.testing.assert_allclose(table["sag_b_error"], 0.1 * table["sag_b"])
    (each,) = Rows("t", "T", (Cell("x", error="off"),), of=lambda _: [Gauge(1e-3, 1e-6), Gauge(2e-3, 2e-6)]).tables(
        SEEN
    )
    np.testing.assert_allclose(each["x_error"], [1e-3, 2e-3])
    assert each.column("x_error").meaning == "estimated error of x"


def test_stacked_rows_and_a_row_an_object() -> None:
    (below,) = Rows("t", "T", ("x",), stacked="parts").tables(SEEN)
    np.testing.assert_allclose(below["x"], [0.0, 1.0, 0.0, 2.0])
    (words,) = Rows("t", "T", ("word", "x"), stacked="parts").tables(SEEN)
    assert words["word"].tolist() == ["stiff"] * 4
    (each,) = Rows("t", "T", ("word",), of=lambda seen: list(seen.data.parts.values())).tables(SEEN)
    assert each["word"].tolist() == ["stiff", "stiff"]
    named = list(Rows("t_{key}", "T", ("x",), each="parts").tables(SEEN))
    assert [table.name for table in named] == ["t_a", "t_b"]


def test_values_are_of_the_nominal_load_with_their_errors() -> None:
    (value,) = Number("largest", error=lambda _: 1e-7, of="swing", further=" of {name}").values(SEEN)
    assert (value.name, value.unit, value.meaning) == ("I.largest", "um", "largest of I")
    assert value.value == pytest.approx(6.0)
    assert value.error == pytest.approx(0.1)
    assert list(Number("largest", of="nothing").values(SEEN)) == []
    assert list(Number("largest", of="swing", si="nothing").values(SEEN)) == []
    assert list(Number("swing.largest", si=lambda _: float("nan")).values(SEEN)) == []
    assert [one.name for one in Number("parts.b.largest").values(SEEN)] == ["I.largest"]
    assert list(Number("largest", of="swing", when="nothing").values(SEEN)) == []
    over_loads = Number("largest", error=lambda _: np.array([1e-7, 2e-7]), of="swing")
    assert next(iter(over_loads.values(SEEN))).error == pytest.approx(0.2)
    assert next(iter(Number("largest", exact, "swing").values(SEEN))).error == 0.0
    endless = Number("largest", si=lambda _: float("inf"), of="swing")
    assert [one.si for one in endless.values(SEEN)] == [float("inf")]
    assert list(replace(endless, finite=True).values(SEEN)) == []
    assert [one.name for one in Number("largest", ending="_of_{key}", each="parts").values(SEEN)][1] == "I.largest_of_b"
    each = list(Number("largest", each="parts", owner="{key}").values(SEEN))
    assert [one.name for one in each] == ["a.largest", "b.largest"]


def test_a_chart_draws_families_bars_and_bands() -> None:
    chart = Chart(
        "swing_{name}", "Swing of {name}", "Largest {d.swing.largest:.2g}.",
        (
            Over("x", (Line("deflection", error="swing.off", each=LOADS),), options={"zero": True}),
            Over("x", (Line("deflection", each=Family("parts"), kind="stems"),)),
            Over(Axis("place"), (Line("deflection", "all", x="x", kind="bars", first=1),), Axis("how far", "um")),
        ),
        of="swing",
    )  # fmt: skip
    (figure,) = chart.figures(SEEN)
    first, second, third = figure.panels
    assert (figure.key, figure.caption, figure.under) == ("swing_I", "Largest 6 µm.", "")
    assert (first.x.unit, first.y.label, first.y.zero) == ("mm", "deflection", True)
    low, high = first.items
    assert isinstance(low, Curve)
    assert isinstance(high, Curve)
    assert (low.name, high.name) == ("100 N", "200 N (nominal)")
    assert low.error is None
    np.testing.assert_allclose(high.error, [2e-3, 4e-3])
    assert [item.name for item in second.items if isinstance(item, Stems)] == ["a", "b"]
    (bars,) = third.items
    assert isinstance(bars, Bars)
    np.testing.assert_allclose(bars.y, [2.0])
    assert third.y.label == "how far"


@dataclass(frozen=True)
class Gauge:
    """One length and its error."""

    x: float = shown("mm", "length")
    off: float = 0.0


@dataclass(frozen=True)
class Gear:
    """One number of a gear, at its place among others; shown as what the swing declares, under another name."""

    place: float = shown("", "place")
    sag: float | None = shown_as(declared(Swing, "deflection"), name="gear_sag")


def test_all_members_of_a_family_are_drawn_where_there_is_no_most() -> None:
    gears = {str(k): [Gear(float(k), 1e-6)] for k in range(9)}
    lines = [Line("sag", each=Family(lambda _: gears, most=most)) for most in (None, 4)]
    (figure,) = Chart("c", "C", "", (Over("place", tuple(lines)),), of=lambda _: gears["0"]).figures(SEEN)
    assert [item.name for item in figure.panels[0].items] == [*"012345678", *"0358"]  # type: ignore[union-attr]


def test_a_line_over_objects_has_a_point_of_each_and_what_a_member_lacks_is_not_drawn() -> None:
    pair = [Gear(0.0, 1e-6), Gear(1.0, 3e-6)]
    family = Family(lambda _: {"a": pair, "b": [Gear(0.0, None)]}, role=lambda seen: f"as {seen.key}")
    bars = Line("sag", error=lambda _: [5e-7, 5e-7], kind="bars", each=family)
    lacking = Line("sag", "lacking", of=lambda _: None)
    idle = Line("sag", "idle", when=lambda seen: seen.key != "a")
    chart = Chart("c", "C", "", (Over("place", (bars, Bundle(family, (lacking, idle)))),), of=lambda _: pair)
    (figure,) = chart.figures(SEEN)
    (panel,) = figure.panels
    assert (panel.x.label, panel.y.label, panel.y.unit) == ("place", "deflection", "um")
    (only,) = panel.items
    assert isinstance(only, Bars)
    assert (only.name, only.role) == ("a", "as a")
    np.testing.assert_allclose((only.x, only.y, only.error), [(0.0, 1.0), (1.0, 3.0), (0.5, 0.5)])
    assert declared(Gear, "sag").name == "gear_sag"


@dataclass(frozen=True)
class Field:
    """A number over a grid, beside what it is compared with."""

    x: np.ndarray = shown("mm", "along")
    z: np.ndarray = shown("mm", "across")
    heat: np.ndarray | None = shown("um", "removal")
    mean: float = shown("um", "mean")


FIELD = Field(np.array([0.0, 1e-3, 2e-3]), np.array([0.0, 1e-3]), np.arange(6.0).reshape(2, 3) * 1e-6, 2.5e-6)


def test_a_path_leads_to_a_quantity() -> None:
    off = Off("swing.deflection", "swing.off")
    (table,) = Rows("t", "T", ("swing.x", Cell("swing.deflection", name="sag"), off, "swing.lacking")).tables(SEEN)
    assert table.keys() == ("x", "sag", "deflection_error")
    np.testing.assert_allclose(table["sag"], [2.0, 6.0])
    several = Rows("t", "T", ("swing.word",), of=lambda seen: [seen.data, seen.data])
    assert next(iter(several.tables(SEEN)))["word"].tolist() == ["stiff", "stiff"]


def test_columns_are_repeated_together() -> None:
    both = Each("parts", Cell("deflection", name="sag_{key}"), Off("deflection", "off", name="sag_{key}"))
    (table,) = Rows("t", "T", ("x", both), of="swing").tables(SEEN)
    assert table.keys() == ("x", "sag_a", "sag_a_error", "sag_b", "sag_b_error")
    np.testing.assert_allclose(table["sag_b_error"], [2e-3, 4e-3])


def test_maps_level_lines_and_panels_for_each() -> None:
    seen = Seen({"a": FIELD, "b": replace(FIELD, heat=None)}, name="I")
    over = Over(
        "x",
        (
            Map("heat", "z", limits=lambda seen: (0.0, 5e-6), centre=lambda seen: (1e-6, 1e-6), numbers=True),
            Line("mean", "mean", look={"dash": "dash"}),
            Line("mean", "ends", ends=True),
        ),
        each=lambda seen: seen.data, title="{key}",
    )  # fmt: skip
    (figure,) = Chart("f", "F", "C", (over,), columns=lambda seen: len(seen.data)).figures(seen)
    first, second = figure.panels
    assert figure.columns == 2
    assert (first.title, second.title) == ("a", "b")
    heat, level, ends = first.items
    assert isinstance(heat, HeatMap)
    assert (heat.label, heat.unit, heat.limits, heat.centre, heat.numbers) == ("removal", "um", (0, 5), (1, 1), True)
    np.testing.assert_allclose(heat.z, [[0, 1, 2], [3, 4, 5]])
    np.testing.assert_allclose(heat.y, [0.0, 1.0])
    assert isinstance(level, Curve)
    assert isinstance(ends, Curve)
    np.testing.assert_allclose(level.y, [2.5, 2.5, 2.5])
    np.testing.assert_allclose((ends.x, ends.y), ([0.0, 2.0], [2.5, 2.5]))
    assert (first.y.label, len(second.items)) == ("across", 2)  # what is None is not drawn
    turned = Over(
        "z", (Map("heat", "x", si=lambda seen: seen.find("heat").T), Line("mean", si=lambda _: np.array([1e-6, 2e-6])),
              Line("mean", si=lambda _: None)), each=lambda seen: [FIELD],
    )  # fmt: skip
    heat, other = next(Chart("f", "F", "C", (turned,)).figures(seen)).panels[0].items
    assert isinstance(heat, HeatMap)
    assert isinstance(other, Curve)
    np.testing.assert_allclose(heat.z, [[0, 3], [1, 4], [2, 5]])
    np.testing.assert_allclose(other.y, [1.0, 2.0])
    named = Over("x", (Line("deflection", each=Family(lambda seen: [SWING])),), "mean")  # the panel's, not the line's
    assert next(Chart("f", "F", "C", (named,), of=lambda _: FIELD).figures(seen)).panels[0].y.label == "mean"
    of = Over("x", ("mean",), each=lambda seen: [seen], of=lambda seen: seen.one.data["b"])
    assert next(Chart("f", "F", "C", (of,)).figures(seen)).panels[0].y.label == "mean"


def test_a_bundle_draws_all_lines_of_a_member_before_the_next() -> None:
    lines = (Line("deflection", look={"dash": "dot"}), Line("lacking"), Line("largest", "{key}", ends=True))
    chart = Chart("f", "F", "C", (Over("x", (Bundle(Family("parts", "no", "ramp"), lines),)),), of="swing")
    stem = Line("deflection", kind="stems", look=lambda seen: {"notes": (seen.key,)})
    (figure,) = Chart("f", "F", "C", (Over("x", (replace(stem, each=Family("parts")),)),), of="swing").figures(SEEN)
    assert [one.notes for one in figure.panels[0].items if isinstance(one, Stems)] == [("a",), ("b",)]
    own = Bundle(Family("parts", role="role of {key}"), (Line("deflection"), Line("deflection", role="red")))
    (figure,) = Chart("f", "F", "C", (Over("x", (own,), "deflection"),), of="swing").figures(replace(SEEN, loads=()))
    assert [one.role for one in figure.panels[0].items if isinstance(one, Curve)] == [
        "role of a", "red", "role of b", "red",
    ]  # fmt: skip
    (figure,) = chart.figures(replace(SEEN, loads=()))
    items = figure.panels[0].items
    assert [(one.name, one.dash, one.role) for one in items if isinstance(one, Curve)] == [
        ("", "dot", "ramp:0.000"), ("a", "", "ramp:0.000"), ("", "dot", "ramp:1.000"), ("b", "", "ramp:1.000"),
    ]  # fmt: skip
    assert figure.panels[0].y.label == "deflection"


def test_a_figure_has_a_view_for_each_of_some_objects() -> None:
    panels = (Over("x", ("deflection",)), Over("x", (Line("lacking"),), "deflection", when=lambda s: s.key == "b"))
    chart = Chart("f", "F", "C", panels, of="swing", views="parts", view="member {key}", most_views=2)
    (figure,) = chart.figures(replace(SEEN, loads=()))
    assert [(view.label, len(view.panels)) for view in figure.views] == [("member a", 1), ("member b", 2)]
    drawn = [view.panels[0].items[0] for view in figure.views]
    assert [one.x.tolist() for one in drawn if isinstance(one, Curve)] == [[0.0, 1.0], [0.0, 2.0]]
    assert (figure.panels, figure.most_views) == ((), 2)


def test_a_complex_quantity_has_a_column_for_each_part() -> None:
    cell = Cell("x", name="{key}", si=lambda seen: seen.one.x * (1.0 + 2.0j), each="parts", parts=True)
    (table,) = Rows("t", "T", ("x", cell), of="swing").tables(replace(SEEN, loads=()))
    assert [column.name for column in table.columns] == ["x", "a_re", "a_im", "b_re", "b_im"]
    np.testing.assert_allclose(table.columns[4].values, [0.0, 4.0])
    assert {column.unit for column in table.columns} == {"mm"}


def test_elements_are_repeated_together() -> None:
    both = Each("parts", Number("largest", owner="{key}"), lambda seen: [seen.key], when=lambda seen: seen.key == "b")
    value, key = both.values(SEEN)
    assert (value.name, key) == ("b.largest", "b")
    tables = Each("parts", Rows("x_{key}", "X", ("x",)), Rows("w_{key}", "W", ("deflection",)))
    assert [table.name for table in tables.tables(SEEN)] == ["x_a", "w_a", "x_b", "w_b"]
    figures = Each("parts", Chart("f_{key}", "F", "C", (Over("x", ("deflection",)),)))
    assert [one.key for one in figures.figures(SEEN)] == ["f_a", "f_b"]
    assert list(Each("parts", Remark("{key} swings.")).sentences(SEEN)) == ["a swings.", "b swings."]
    assert list(Each("nothing", Remark("Never.")).sentences(SEEN)) == []
    outcome = Sheet(tables=(tables,), remarks=(Each("parts", Remark("{key}.")),)).present(DATA, SEEN)
    assert (len(outcome.tables), outcome.remarks) == (4, ("a.", "b."))


def test_what_is_not_shown_hands_on_its_data() -> None:
    outcome = UNSHOWN.present(DATA, None)
    assert (outcome.data, outcome.tables, outcome.values, outcome.figures, outcome.remarks) == (DATA, (), (), (), ())


def test_a_sheet_is_presented_in_its_order_and_lacks_what_is_not_there() -> None:
    sheet = Sheet(
        loads="loads", nominal="at",
        tables=(Rows("one", "One", ("x",), of="swing"), Rows("two", "Two", ("x",), of="nothing")),
        values=(Number("largest", of="swing"), lambda seen: ()),
        figures=(Chart("f", "F", "C", (Over("x", ("deflection",)),), of="nothing"),),
        remarks=(Remark("{name} swings.", when="parts"), Remark("Never.", when="nothing"), lambda seen: [seen.name]),
        settings={"at": "at", "none": "nothing"},
    )  # fmt: skip
    outcome = sheet.present(DATA, SEEN.asked)
    assert outcome.data is DATA
    assert [table.name for table in outcome.tables] == ["one"]
    assert [value.name for value in outcome.values] == ["I.largest"]
    assert outcome.remarks == ("I swings.", "I")
    assert outcome.settings == {"at": 1}
    assert outcome.figures == ()


def test_views_show_one_object_at_a_time() -> None:
    panels = (Over("x", ("largest",)), Over("x", ("lacking",), when="lacking"))
    (figure,) = Chart("f", "F", "C", panels, views="parts", view="part {key}", most_views=1).figures(SEEN)
    assert [view.label for view in figure.views] == ["part a", "part b"]
    assert (figure.most_views, [len(view.panels) for view in figure.views]) == (1, [1, 1])
    items = [view.panels[0].items[0] for view in figure.views]
    assert [float(np.max(one.x)) for one in items if isinstance(one, Curve)] == [1.0, 2.0]


def test_a_family_keeps_members_and_a_line_takes_another_abscissa() -> None:
    many = Family(lambda _: [SWING] * 9, "", "ramp", most=3, keep=lambda _: (5,))
    over = Over("x", (Line("deflection", "{key}", each=many),))
    (figure,) = Chart("f", "F", "C", (over,), of="swing").figures(SEEN)
    assert [item.name for item in figure.panels[0].items if isinstance(item, Curve)] == ["0", "4", "5", "8"]
    moved = Line("deflection", x_si=lambda seen: seen.data.swing.x + 1e-3)
    (curve,) = next(Chart("f", "F", "C", (Over("x", (moved,)),), of="swing").figures(SEEN)).panels[0].items
    assert isinstance(curve, Curve)
    np.testing.assert_allclose(curve.x, [1.0, 2.0])


def test_rows_over_a_grid_of_each_object_below_each_other() -> None:
    columns = (Cell("word", lambda seen: f"part {seen.key}", lambda _: SWING), Cell("heat", name="removed"))
    (table,) = Rows("t", "T", columns, stacked=lambda _: {"a": FIELD, "b": FIELD}, on=("z", "x")).tables(SEEN)
    assert table.keys() == ("word", "z", "x", "removed")
    assert table["word"].tolist() == ["part a"] * 6 + ["part b"] * 6
    np.testing.assert_allclose(table["z"][:6], np.repeat(FIELD.z, 3) * 1e3)
    np.testing.assert_allclose(table["removed"], [0, 1, 2, 3, 4, 5] * 2)
    (one,) = Rows("t", "T", ("heat",), of=lambda _: FIELD, on=("z", "x")).tables(SEEN)
    np.testing.assert_allclose(one["x"], list(FIELD.x * 1e3) * 2)


def test_a_repetition_names_the_quantity() -> None:
    asked = Each(lambda _: {"x": SWING, "deflection": SWING}, Cell("{key}", si=lambda _: [1e-3, 0.0], name="own_{key}"))
    (table,) = Rows("t", "T", (asked,), of="swing").tables(SEEN)
    assert [(one.name, one.unit) for one in table.columns] == [("own_x", "mm"), ("own_deflection", "um")]
    (value,) = Number("{key}", of=lambda _: SWING, each=lambda _: {"largest": 1}).values(SEEN)
    assert (value.name, value.value) == ("I.largest", pytest.approx(6.0))


def test_panels_are_repeated_together_and_a_line_names_its_quantity() -> None:
    one, other = Over("x", (Line("{one.word}", x="x"),), "largest", title="{key}"), Over("x", ("largest",))
    named = {"a": replace(SWING, word="deflection"), "b": replace(SWING, word="lacking")}
    each = Each(lambda _: named, one, other, when=lambda seen: seen.key != "c")
    (figure,) = Chart("f", "F", "C", (each,), of="swing").figures(SEEN)
    assert [panel.title for panel in figure.panels] == ["a", "", "b", ""]
    assert [len(panel.items) for panel in figure.panels] == [1, 1, 0, 1]  # of b the quantity is None: no curve
    (curve,) = figure.panels[0].items
    assert isinstance(curve, Curve)
    np.testing.assert_allclose(curve.y, [2.0, 6.0])
    none = Each(lambda _: named, one, when=lambda _: False)
    assert next(Chart("f", "F", "C", (none, other), of="swing").figures(SEEN)).panels[0].title == ""
