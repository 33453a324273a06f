"""A sheet: where quantities stand, how sentences are filled, tables, values and figures from declarations."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.shown import shown, shows
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Bars, Curve, Stems
from fegear.engine.sheet.chart import LOADS, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, EveryLoad, Off, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet


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
        ("{d.swing.largest:.3g} at most", "6 µm at most"),  # of the nominal load, in its unit
        ("{d.swing.word} teeth", "stiff teeth"),
        ("within {asked.tolerance:.0e}", "within 1e-03"),
        ("{d.at} of {d.loads}", "1 of (100.0, 200.0)"),
    ],
)
def test_sentences_are_filled_in(text: str, said: str) -> None:
    assert SEEN.said(text) == said


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
        "t", "T", (Cell("x", further=" of {name}"), cell), of=lambda _: replace(SWING, x=np.zeros(1))
    ).tables(SEEN)
    assert table.keys() == ("x", "sag_a", "sag_b")
    assert [one.meaning for one in table.columns] == ["position of I", "of part a", "of part b"]
    (none,) = Rows("t", "T", ("x", Cell("deflection", si="nothing")), of="swing").tables(SEEN)
    assert none.keys() == ("x",)


def test_stacked_rows_and_a_row_an_object() -> None:
    (below,) = Rows("t", "T", ("x",), stacked="parts").tables(SEEN)
    np.testing.assert_allclose(below["x"], [0.0, 1.0, 0.0, 2.0])
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
    assert list(Number("largest", of="swing", when="nothing").values(SEEN)) == []
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
