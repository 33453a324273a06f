"""``fegear compare``: what it finds between two runs, what it leaves, and its exit codes."""

from __future__ import annotations

import csv
import json
import shutil
import sys

import numpy as np
import pytest

import fegear.cli
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.run_folder import read_side
from fegear.studies.comparison.compare import Side, compare, different_inputs, paired
from fegear.studies.comparison.drawn import comparison_figures
from fegear.studies.comparison.joined import join

CASE = """
results = ["geometry", "load-sharing"]
[gear.a]
teeth = 28
module = "3 mm"
bore_radius = "20 mm"
face_width = "10 mm"
rack = "ISO 53 C"
[pair.I]
driver = "a"
driven = "a"
load = "1000 N"
compliance = { source = "cornell" }
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Three runs: a case, the same with twice the load, and with another face width."""
    folder = tmp_path_factory.mktemp("runs")
    (folder / "one.toml").write_text(CASE)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, change in (("one", ()), ("loaded", ("--set", "pair.I.load=2000 N")),
                             ("shifted", ("--set", "gear.a.profile_shift=0.1"))):  # fmt: skip
            patch.setattr(sys, "argv", ["fegear", "run", "one.toml", "--no-plots", "-q", "--out", name, *change])
            with pytest.raises(SystemExit):
                fegear.cli.main()
    return folder


@pytest.fixture
def say(runs, monkeypatch, capsys):
    monkeypatch.chdir(runs)

    def run(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["fegear", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
        return int(end.value.code or 0), *capsys.readouterr()

    return run


def test_inputs_values_and_curves_are_told_apart(say, runs):
    code, out, _ = say("compare", "one", "loaded", "--out", "cmp")
    assert code == 1
    assert "  pair.I.load: 1000 N -> 2000 N" in out
    assert "I.largest_load: 1000 -> 2000 N (+50 %)" in out
    assert "I.contact_ratio" not in out  # does not depend on the load
    with (runs / "cmp" / "tables" / "load_sharing_I.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    single = [row for row in rows if float(row["load_a [N]"]) == pytest.approx(1000.0)]
    assert single
    assert all(float(row["load_change [N]"]) == pytest.approx(1000.0) for row in single)
    assert (runs / "cmp" / "plots" / "compare_load_sharing_I.png").stat().st_size > 5000
    assert "Curves overlaid" in (runs / "cmp" / "report.html").read_text()
    summary = json.loads((runs / "cmp" / "summary.json").read_text())
    assert summary["inputs"] == {"pair.I.load": {"a": "1000 N", "b": "2000 N"}}
    assert summary["values"]["I.largest_load"]["share"] == pytest.approx(0.5)
    assert {p.relative_to(runs / "cmp").as_posix() for p in (runs / "cmp").rglob("*") if p.is_file()} >= set(
        summary["files"]
    )


def test_a_run_and_its_own_case_are_the_same(say):
    code, out, _ = say("compare", "one", "one.toml", "--out", "cmp_same", "--no-plots")
    assert code == 0
    assert "Inputs: identical." in out
    assert "Values: identical." in out
    assert "Tables: identical." in out
    # With another load the case is no longer that of the folder.
    assert say("compare", "one", "one.toml", "--set", "pair.I.load=1001 N", "--out", "cmp_other", "-q")[0] == 1
    assert say("compare", "one", "one.toml", "--set", "pair.I.load=1001 N", "--tolerance", "0.02", "-q")[0] == 0


def test_curves_over_other_places_are_compared_where_both_are(say, runs):
    """A profile shift moves the path of contact: no row of one table meets a row of the other."""
    code, out, _ = say("compare", "one", "shifted", "--json", "--no-plots")
    told = json.loads(out)
    assert code == 1
    table = told["tables"]["load_sharing_I"]
    assert table["rows_only_in_a"] > 100
    assert 0.0 < abs(table["largest"]["deflection [um]"]) < 10.0
    sides = [read_side(runs / name, "compare") for name in ("one", "shifted")]
    x, deflection = (
        [np.asarray(side.tables["load_sharing_I"][name]) for side in sides] for name in ("x", "deflection")
    )
    there = (x[0] >= x[1][0]) & (x[0] <= x[1][-1])
    change = np.interp(x[0][there], x[1], deflection[1]) - deflection[0][there]
    assert abs(table["largest"]["deflection [um]"]) == pytest.approx(np.abs(change).max(), rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("compare", "one", "nothing.toml"), "does not exist"),
        (("compare", "one", "."), "is not a results folder (no"),
        (("compare", "one", "loaded", "--set", "gear.a.teeth=30"), "both are folders"),
        (("compare", "one", "loaded", "--tolerance", "-1"), "zero or greater"),
    ],
)
def test_what_cannot_be_compared_is_refused(say, arguments, words):
    code, out, err = say(*arguments)
    assert (code, out) == (2, "")
    assert words in err


def test_a_folder_without_inputs_is_compared_by_its_numbers(say, runs):
    shutil.copytree(runs / "one", runs / "old", dirs_exist_ok=True)
    summary = json.loads((runs / "old" / "summary.json").read_text())
    del summary["inputs"]
    (runs / "old" / "summary.json").write_text(json.dumps(summary))
    code, out, _ = say("compare", "old", "one", "--no-plots")
    assert code == 0
    assert "Inputs: not available for both runs (written by an older version)." in out


def test_inputs_that_mean_the_same_are_the_same():
    first = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "3 mm"}}}
    second = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "0.3 cm", "profile_shift": 0}}}
    assert different_inputs(first, second) == ()
    second["gear"]["a"]["rack"] = "ISO 53 A"
    (found,) = different_inputs(first, second)
    assert (found.first, found.second) == (None, "ISO 53 A")
    second["gear"]["b"] = {"teeth": 30, "module": "3 mm"}
    keys = {one.key: one for one in different_inputs(first, second)}
    assert keys["gear.b.teeth"].first is None
    assert keys["gear.b.teeth"].second == 30


def test_a_table_that_one_case_lacks_is_told_by_its_own_keys_alone():
    first = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "3 mm"}}}
    relief = {"tip": {"amount": "10 um", "length": "2 mm"}}
    second = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "3 mm", "relief": relief}}}
    assert [(one.key, one.first, one.second) for one in different_inputs(first, second)] == [
        ("gear.a.relief.tip[0].amount", None, "10 um"),
        ("gear.a.relief.tip[0].length", None, "2 mm"),
    ]


def test_curves_over_each_other_are_of_quantities_in_their_order_not_of_their_errors():
    def run(label, te):
        x = np.arange(5.0)
        columns = [Column("x", x, "mm"), Column("te", x + te, "um"), Column("te_error", x * te, "um"),
                   Column("stiffness", 1.0 + 9.0 * te + x, "N/um")]  # fmt: skip
        return Side(label, {}, {}, {"transmission_error_I": Table("transmission_error_I", tuple(columns), "T")})

    (figure,) = comparison_figures(compare(run("a", 0.0), run("b", 1.0), 1e-9))
    assert [panel.y.label for panel in figure.panels] == ["te", "stiffness"]


def test_rows_that_only_one_table_has_are_counted_and_kept():
    def table(names, places, loads):
        return Table("t", (Column("x", np.array(places), "mm"), Column("name", np.array(names)),
                           Column("load", np.array(loads), "N")))  # fmt: skip

    first = table(["p", "q", "p"], [1e-3, 1e-3, 2e-3], [10.0, 20.0, 30.0])
    second = table(["q", "p", "p"], [1e-3, 1e-3 * (1 + 1e-12), 3e-3], [25.0, 10.0, 40.0])
    found = join(first, second)
    assert (found.only_first, found.only_second) == (1, 1)
    assert found.table["x"] == pytest.approx([1.0, 1.0, 2.0, 3.0])
    np.testing.assert_array_equal(found.table["load_change"], [0.0, 5.0, np.nan, np.nan])
    (difference,) = found.differences
    assert difference.largest == pytest.approx(5.0)
    assert difference.share == pytest.approx(5.0 / 40.0)
    assert found.differs(1.0)
    assert not join(first, first).differs(0.0)
    apart = join(table(["p"], [5e-3], [1.0]), table(["q"], [7e-3], [2.0])).table  # first rows that nobody shares
    assert (apart["name"].tolist(), apart["x"].tolist()) == (["p", "q"], [5.0, 7.0])


def test_a_table_over_a_grid_is_no_curve():
    """Three rows at each place: joined row by row, and not interpolated where the places differ."""

    def grid(places, values):
        return Table("t", (Column("radius", np.repeat(places, 3)), Column("c", np.array(values, dtype=float))))

    one = grid([1.0, 2.0], [1, 2, 3, 4, 5, 6])
    same = join(one, grid([1.0, 2.0], [1, 2, 3, 4, 5, 7]))
    (changed,) = same.differences
    assert changed.largest == 1.0
    assert same.only_first == same.only_second == 0
    other = join(one, grid([1.1, 1.9], [1, 2, 3, 4, 5, 6]))
    assert other.only_first == other.only_second == 6
    assert np.isnan(other.differences[0].largest)


def test_a_comparison_is_not_written_over_a_run_that_it_compares(say, runs):
    """`fegear compare ra rb --out rb` removed rb's tables and dataset, with exit code 0."""
    link = runs / "link"
    link.symlink_to("shifted")
    before = {path: path.read_bytes() for path in (runs / "shifted").rglob("*") if path.is_file()}
    for out in ("shifted", "./shifted/", "link"):
        code, _, complaint = say("compare", "one", "shifted", "--out", out)
        assert code == 2
        assert "is one of the runs to be compared and would be overwritten" in complaint
    assert {path: path.read_bytes() for path in (runs / "shifted").rglob("*") if path.is_file()} == before


def test_columns_that_only_one_table_has_are_a_difference():
    """A column, all columns or a whole table of one side were passed over, and the runs said to be the same."""

    def table(**columns):
        return Table("t", tuple(Column(name, np.array(values)) for name, values in columns.items()))

    def found(one, other):
        sides = (Side(label, {}, {}, {"t": table}) for label, table in (("a", one), ("b", other)))
        return compare(*sides, 1e-9)

    both = table(x=[1.0, 2.0], te=[3.0, 4.0], name=["p", "q"])
    assert not found(both, both).results_differ
    for one, other, told in (
        (both, table(x=[1.0, 2.0], name=["p", "q"]), "t: column te only in A"),
        (table(x=[1.0, 2.0], name=["p", "q"]), both, "t: column te only in B"),
        (both, table(x=[1.0, 2.0], te=[3.0, 4.0]), "t: column name only in A"),
        (both, table(other=[1.0, 2.0]), "t: columns x, te, name only in A"),
        (table(te=[3.0]), table(), "t: column te only in A"),
    ):
        comparison = found(one, other)
        assert comparison.results_differ
        assert any(told in line for line in comparison.lines())
        joined = comparison.different_tables[0].table
        assert {"te_a", "te_b"} & set(joined.keys()) or "te" in joined.keys()  # noqa: SIM118
    # So was a number that is none any more, as long as another entry of its column stayed one.
    lost = found(both, table(x=[1.0, 2.0], te=[3.0, np.nan], name=["p", "q"]))
    assert lost.results_differ
    assert any("value in one run only" in line for line in lost.lines())


def test_no_number_on_both_sides_is_no_difference():
    none = Value("I.te", float("nan"), "um", None)
    (pair,) = paired({"I.te": none}, {"I.te": none})
    assert not pair.differs(0.0)
    assert paired({"I.te": none}, {"I.te": Value("I.te", 1.0, "um")})[0].differs(1.0)
