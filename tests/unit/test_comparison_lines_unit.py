"""What a comparison says line by line: values, columns, tables, and what its page, summary and figures hold."""

import math

import numpy as np
import pytest

from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.comparison import comparison_page, comparison_summary
from fegear.studies.comparison.compare import (
    Input,
    Pairing,
    Side,
    compare,
    input_line,
    paired,
    table_lines,
    value_line,
)
from fegear.studies.comparison.drawn import comparison_figures
from fegear.studies.comparison.joined import follows, join


def um(size, error=None):
    return Value("I.te", size * 1e-6, "um", None if error is None else error * 1e-6)


def table(title="t", **columns):
    return Table(title, tuple(Column(key, np.array(values), unit) for key, (values, unit) in columns.items()))


def side(label, *tables, values=(), document=None):
    return Side(label, document or {}, {one.name: one for one in values}, {one.name: one for one in tables})


def test_a_value_is_told_with_its_change_over_the_larger_of_both():
    pair = Pairing("I.te", um(8.0, 0.5), um(10.0, 0.5))
    assert (pair.change, pair.share) == (pytest.approx(2.0), pytest.approx(0.2))
    assert (pair.within_errors, pair.resolved) == (False, True)
    assert value_line(pair) == "  I.te: 8 -> 10 um (+20 %)"
    assert value_line(Pairing("I.te", um(10.0), um(-8.0))) == "  I.te: 10 -> -8 um (-180 %)"
    near = Pairing("I.te", um(10.0, 0.2), um(9.5, 0.31))
    assert (near.within_errors, near.resolved) == (True, False)
    assert value_line(near) == "  I.te: 10 -> 9.5 um (-5.0 %, within the estimated errors)"
    assert not Pairing("I.te", um(10.0, 0.2), um(9.5, 0.25)).within_errors
    assert Pairing("I.te", um(10.0, 0.6), um(9.5)).within_errors
    assert not Pairing("x", Value("x", 1.0), Value("x", 1.0 + 1e-10)).resolved  # round-off of a number without an error
    assert Pairing("x", Value("x", 1.0), Value("x", 1.0 + 1e-8)).resolved
    assert value_line(Pairing("x", Value("x", 1.0), Value("x", 2.0))) == "  x: 1 -> 2 (+50 %)"
    assert value_line(Pairing("x", Value("x", 1.0), None)) == "  x: only in A"
    assert value_line(Pairing("x", None, Value("x", 1.0))) == "  x: only in B"
    other = Pairing("x", Value("x", 1e-3, "mm"), Value("x", 1e-3, "um"))
    assert value_line(other) == "  x: 1 mm -> 1000 um"
    assert math.isnan(other.change)
    assert other.differs(1.0)
    assert Pairing("x", um(0.0), um(0.0)).share == 0.0
    assert not Pairing("x", um(10.0), um(9.0)).differs(0.1)
    assert Pairing("x", um(10.0), um(9.0)).differs(0.0999)
    with pytest.raises(LookupError, match="missing on one side"):
        _ = Pairing("x", um(1.0), None).both
    assert [one.name for one in paired({"b": um(1.0), "a": um(1.0)}, {"c": um(1.0), "a": um(2.0)})] == ["b", "a", "c"]
    assert input_line(Input("k", None, 3)) == "  k: (not given) -> 3"


def test_columns_are_told_from_the_one_that_changes_most_and_four_of_them_at_most():
    x = ([1e-3, 2e-3, 3e-3], "mm")
    names = "abcdef"
    first = table(x=x, **{name: ([1.0, 2.0, 4.0], "N") for name in names})
    second = table(x=x, **{name: ([1.0, 2.0 + 0.1 * k, 4.0], "N") for k, name in enumerate(names)})
    lines = table_lines(join(first, second), 1e-9)
    assert lines == [
        "  t, f: by up to +0.5 N at x = 2 mm", "  t, e: by up to +0.4 N at x = 2 mm",
        "  t, d: by up to +0.3 N at x = 2 mm", "  t, c: by up to +0.2 N at x = 2 mm", "  t: 1 more columns",
    ]  # fmt: skip
    four = table_lines(join(first, second), 0.2 / 4.0 - 1e-9)
    assert four == lines[:4]
    # Over the largest entry of either: 0.3 of 4 and more.
    assert [line[5] for line in table_lines(join(first, second), 0.3 / 4.0 - 1e-9)] == ["f", "e", "d"]
    less = table_lines(join(second, first), 0.3 / 4.0 - 1e-9)
    assert less[0] == "  t, f: by up to -0.5 N at x = 2 mm"
    words = table(name=(["p", "q"], ""), load=([1.0, 3.0], ""))
    other = table(name=(["p", "q"], ""), load=([1.5, 3.0], ""))
    assert table_lines(join(words, other), 0.0) == ["  t, load: by up to +0.5 at name = p"]
    longer = table(x=([1e-3, 2e-3, 5e-3, 6e-3], "mm"), a=([1.0, 2.0, 4.0, 4.0], "N"), z=([1.0, 1.0, 1.0, 1.0], ""))
    told = table_lines(join(table(x=x, a=([1.0, 2.0, 4.0], "N")), longer), 1e-9)
    assert told == ["  t: 1 rows only in A, 2 only in B", "  t: column z only in B"]


def test_what_is_on_the_terminal_is_bounded_and_says_how_much_more_there_is():
    values = [Value(f"v{k}", float(k)) for k in range(45)]
    changed = [Value(f"v{k}", 2.0 * k + 1.0) for k in range(45)]
    found = compare(side("one", values=values), side("other", values=changed))
    lines = found.lines()
    assert lines[:4] == [
        "A: one", "B: other", "Inputs: not available for both runs (written by an older version).",
        "Values that differ:",
    ]  # fmt: skip
    assert lines[4 + 40] == "  ... 5 more in the report"
    assert lines[-1] == "Tables: none."
    assert len(lines) == 4 + 40 + 2
    same = compare(side("one", values=values), side("other", values=values))
    assert same.lines()[-2:] == ["Values: identical.", "Tables: none."]
    assert not same.results_differ
    few = compare(side("one", values=values[:40]), side("other", values=changed))
    assert sum("only in B" in line for line in few.lines()) == 0  # beyond the fortieth
    assert few.lines()[-2] == "  ... 5 more in the report"
    exactly = compare(side("one", values=values[:40]), side("other", values=changed[:40]))
    assert not any("more in the report" in line for line in exactly.lines())
    alone = compare(side("one", table("p", x=([1.0], ""))), side("other", table("q", x=([1.0], ""))))
    assert alone.lines()[-2:] == ["Table p only in A.", "Table q only in B."]
    assert alone.results_differ
    half = compare(side("one", document={"results": []}), side("other"))
    assert half.inputs is None


def test_endless_and_missing_numbers_are_changes_where_one_side_has_others():
    nan, inf = math.nan, math.inf

    def difference(one, other):
        x = ([1.0, 2.0, 3.0], "")
        return join(table(x=x, a=(one, "um")), table(x=x, a=(other, "um"))).differences[0]

    same = difference([1e-6, nan, inf], [1e-6, nan, inf])
    assert (same.largest, same.share) == (0.0, 0.0)
    for other in ([1e-6, nan, -inf], [1e-6, nan, 5.0], [1e-6, 1.0, inf], [nan, nan, inf]):
        assert difference([1e-6, nan, inf], other).share == inf
        assert math.isnan(difference([1e-6, nan, inf], other).largest)
    moved = difference([1e-6, nan, 4e-6], [1e-6, nan, 3e-6])
    assert (moved.largest, moved.share, moved.where) == (pytest.approx(-1.0), pytest.approx(0.25), 3.0)
    nothing = difference([nan, nan, nan], [nan, nan, nan])
    assert (nothing.share, nothing.where) == (0.0, "")
    zero = difference([0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    assert (zero.largest, zero.share) == (0.0, 0.0)
    other_unit = join(table(x=([1.0], ""), a=([1.0], "um")), table(x=([1.0], ""), a=([1.0], "N")))
    assert math.isnan(other_unit.table["a_b"][0])


def test_rows_follow_a_column_that_rises_with_two_at_a_jump_and_no_more():
    def of(*places):
        return follows(table(x=(list(places), "")), "x")

    assert of(1.0, 2.0, 2.0, 3.0)
    assert not of(1.0, 2.0, 2.0, 2.0)
    assert not of(2.0, 1.0)
    assert not of(1.0)
    assert of(1.0, 1.0)
    assert not follows(table(x=(["a", "b"], "")), "x")


def curve(label, shift=0.0, **lifts):
    x = np.linspace(0.0, 4.0, 5) + shift
    columns = {name: (x**2 * (1.0 + lift), "um") for name, lift in lifts.items()}
    return side(label, table("te", x=(x, "mm"), **columns))


def test_figures_show_the_four_columns_that_change_most_in_the_order_of_the_table():
    one = curve("one", a=0.0, b=0.0, c=0.0, d=0.0, e=0.0, a_error=0.0)
    other = curve("other", a=0.5, b=0.1, c=0.2, d=0.3, e=0.4, a_error=2.0)
    (figure,) = comparison_figures(compare(one, other))
    assert [panel.y.label for panel in figure.panels] == ["a", "c", "d", "e"]
    assert figure.key == "compare_te"
    first, second = figure.panels[0].items
    assert (first.name, second.name) == ("A: one", "B: other")
    assert (first.dash, second.dash) == ("solid", "dash")
    np.testing.assert_allclose(second.y, 1.5 * np.asarray(first.y))
    np.testing.assert_allclose(first.x, np.linspace(0.0, 4.0, 5) * 1e3)
    # Rows that do not meet are compared as curves where both are.
    moved = compare(one, curve("other", shift=0.5, a=0.0, b=0.0, c=0.0, d=0.0, e=0.0, a_error=0.0))
    (joined,) = moved.different_tables
    x, xb = np.linspace(0.0, 4.0, 5), np.linspace(0.5, 4.5, 5)
    change = (np.interp(x, xb, xb**2) - x**2)[1:]
    largest = change[np.argmax(np.abs(change))]
    assert joined.differences[0].largest == pytest.approx(largest * 1e6)
    assert joined.differences[0].share == pytest.approx(abs(largest) / 16.25)  # of both curves where they meet
    short = [
        side(label, table("te", x=([0.0, 1.0], ""), a=([1.0, value], "")))
        for label, value in (("one", 2.0), ("other", 3.0))
    ]
    assert comparison_figures(compare(*short)) == []  # two rows are no curve


def test_page_and_summary_of_a_comparison_hold_what_differs():
    values = [um(8.0, 0.1)], [um(10.0, 0.1), Value("n", 2.0)]
    one = side("one", *curve("", a=0.0).tables.values(), table("p", x=([1.0], "")), values=values[0])
    other = side("other", *curve("", a=0.5).tables.values(), values=values[1])
    found = compare(one, other, 1e-3)
    page = comparison_page(found)
    grid = page.sections[1].blocks[0]
    assert [list(row) for row in grid.rows] == [
        ["I.te", "8 um", "10 um", "+20 %", ""],
        ["n", "", "2", "", ""],
    ]
    assert [section.title for section in page.sections] == [
        "Inputs that differ", "Values that differ", "Curves overlaid", "Tables that differ",
    ]  # fmt: skip
    assert page.note == "A: one. B: other."
    summary = comparison_summary(found)
    assert summary["same"] is False
    assert summary["inputs"] is None
    assert summary["values"]["I.te"] == {
        "a": pytest.approx(8.0), "b": pytest.approx(10.0), "unit": "um", "share": pytest.approx(0.2),
        "within_errors": False,
    }  # fmt: skip
    assert summary["values"]["n"] == {"a": None, "b": 2.0, "unit": "", "share": None, "within_errors": False}
    assert summary["tables"]["te"]["largest"] == {"a [um]": pytest.approx(8e6)}
    assert (summary["tables"]["te"]["rows_only_in_a"], summary["tables"]["te"]["rows_only_in_b"]) == (0, 0)
    assert summary["tables_only_in"] == {"p": "a"}
    assert comparison_summary(compare(one, one))["same"] is True
