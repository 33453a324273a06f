"""The pages "Sources": every figure, table and group of equations of the papers has its row, and every number holds."""

import csv
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

import fegear

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "benchmarks")]

import lin_chart_study  # noqa: E402
import source_inputs  # noqa: E402
import source_numbers  # noqa: E402
import source_rows as rows  # noqa: E402
from source_runs import Found, Run  # noqa: E402

#: Cases that cost more than a second; the site is built with every case and does not stand when a number does not hold.
COSTLY = {
    "blankenship_singh", "sources/lin_huston_coy_iteration",
    *(f"sources/lin_townsend_oswald_fig{n}" for n in ("5c", "8", "9", "10", "11c")),
}  # fmt: skip
CASES = [pytest.param(case, marks=[pytest.mark.long] if case in COSTLY else []) for case in rows.cases()]


@pytest.mark.parametrize("paper", rows.sources())
def test_every_item_of_a_paper_has_its_row(paper):
    assert rows.sources()[paper].faults() == []


@pytest.mark.dear(
    "litvin_combined",
    "litvin_lead",
    "litvin_localised",
    "sources/litvin_fig07",
    "sources/litvin_fig09",
    "sources/blankenship_singh_helical",
    "sources/litvin_eq18",
    "sources/lin_townsend_oswald_fig6c",
)
@pytest.mark.parametrize("case", CASES)
def test_the_numbers_of_a_case_hold(case):
    run = Run.of(fegear.run(ROOT / "cases" / f"{case}.toml", cache=CACHE))
    assert rows.faults_of_runs(case, run) == []


def test_every_case_of_the_folder_answers_for_something():
    there = {f"sources/{path.stem}" for path in (ROOT / "cases" / "sources").glob("*.toml")}
    assert there - set(rows.cases()) == set()


def test_numbers_that_are_kept_hold_and_their_grid_knows_no_answer():
    """What a run gave that is too long for the site: lengths of a whole range, evenly spaced, and speeds too."""
    faults = [
        number.fault(rows.kept(number.kept))
        for source in rows.sources().values() for row in source.row for number in row.numbers if number.kept
    ]  # fmt: skip
    assert len(faults) > 10
    assert [fault for fault in faults if fault] == []
    with (lin_chart_study.KEPT / "tables" / "design_chart_I.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert sorted({float(row["amount"]) for row in table}) == lin_chart_study.AMOUNTS
    points = {(float(row["amount"]), float(row["length"])) for row in table}
    coarse = {(amount, length) for amount in lin_chart_study.AMOUNTS for length in lin_chart_study.LENGTHS}
    assert len(points) == len(table)
    assert coarse <= points
    np.testing.assert_allclose(lin_chart_study.LENGTHS, [*(0.02 * k for k in range(1, 65)), 1.284], atol=1e-12)
    # finer lengths are multiples of one step, about what is best on the coarse grid
    fine = np.array([length for _, length in points - coarse])
    np.testing.assert_allclose(fine / lin_chart_study.FINE, np.round(fine / lin_chart_study.FINE), atol=1e-9)
    assert {float(row["speed [rpm]"]) for row in table} <= set(lin_chart_study.SPEEDS)


@pytest.mark.long
@pytest.mark.parametrize("amount", lin_chart_study.AMOUNTS)
def test_the_kept_chart_is_what_the_case_gives(amount):
    """Every fifth length of one amount, and the best: the factors to the tolerance of a motion."""
    with (lin_chart_study.KEPT / "tables" / "design_chart_I.csv").open(encoding="utf-8", newline="") as file:
        kept = {
            float(r["length"]): float(r["dynamic_factor"]) for r in csv.DictReader(file) if float(r["amount"]) == amount
        }
    lengths = sorted(
        {*[length for length in lin_chart_study.LENGTHS if length in kept][::5], min(kept, key=kept.__getitem__)}
    )
    table = lin_chart_study.chart([amount], lengths).tables["design_chart_I"]
    found = next(column.values for column in table.columns if column.head == "dynamic_factor")
    np.testing.assert_allclose(found, [kept[length] for length in lengths], rtol=2e-3)


#: A row as a list has it, and numbers of each kind.
ROW = {"covers": ["Fig. 1"], "shows": "x", "kind": "printed", "case": "thin_rim"}
PRINTED = {"kind": "printed", "what": "a", "printed": "2.5 mm", "value": "b"}
DIFFERS = {"kind": "differs", "what": "a", "printed": "2.5 mm", "value": "b", "found": 3.0, "because": "it is cold"}
INPUT = {"kind": "input", "origin": "given", "what": "a", "printed": "2.5 mm", "value": "b"}
READ = PRINTED | {"kind": "read", "reading": 0.1, "because": "off a plot"}
GRID = {"table": "t", "column": "n", "step": 1.0}
PLACE = {"kind": "printed", "what": "a", "printed": "25", "value": "I.speed_of_largest", "grid": GRID | {"step": 0.4}}
WORDS = {"kind": "words", "what": "a", "statement": "small", "value": "b", "most": 1.0}
OWN = {"kind": "regression", "what": "a", "value": "b", "found": 3.0}
TEST = "literature/test_mark_contact_literature.py::test_effective_error_is_the_definition"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "is called 'printed', which needs a printed number"),
        ({"number": [OWN]}, "is called 'printed', which needs a printed number"),
        ({"number": [WORDS]}, "is called 'printed', which needs a printed number"),
        ({"number": [INPUT]}, "is called 'printed', which needs a printed number"),
        ({"number": [PRINTED, DIFFERS]}, "and none that differs"),
        ({"kind": "in part", "number": [PRINTED]}, "one that differs"),
        ({"kind": "differs", "number": [PRINTED, DIFFERS]}, "none that is reproduced"),
        ({"kind": "differs", "remark": "because"}, "needs a number that differs"),
        ({"kind": "words", "number": [WORDS, PRINTED]}, "no printed number"),
        ({"kind": "input", "number": [INPUT, PRINTED]}, "printed numbers that are input, and no others"),
        ({"kind": "regression", "number": [OWN, INPUT]}, "fegear's own numbers alone"),
        ({"kind": "equation"}, "needs tests"),
        ({"kind": "equation", "tests": ["literature/test_nothing.py::test_it"]}, "is not there"),
        ({"kind": "equation", "tests": [TEST + "_not"]}, "is not there"),
        ({"kind": "sketch", "number": [PRINTED]}, "no printed number"),
        ({"case": "nowhere", "kind": "text lost"}, "nowhere.toml is not there"),
        ({"case": None, "kind": "sketch"}, "names no case"),
        ({"case": None, "kind": "sketch", "function": "fegear.geometry.Nothing"}, "is not there"),
        ({"case": None, "kind": "sketch", "command": "fegear dance cases/thin_rim.toml"}, "is no command"),
        ({"number": [PRINTED | {"printed": "55 deg"}], "case": "helical_pair"}, ""),
        ({"number": [PRINTED | {"printed": "1.6 inch"}], "case": "litvin_lead"}, "holds what is printed"),
        ({"number": [READ | {"printed": "1.6 inch"}], "case": "litvin_lead"}, "holds what is printed"),
    ],
)
def test_a_row_that_is_called_what_it_is_not_is_found(changes, said):
    found = rows.Row(**(ROW | changes)).faults()
    assert (found == []) if said == "" else (said in " ".join(found))


@pytest.mark.parametrize(
    ("row", "kinds"),
    [
        ({"number": [PRINTED, INPUT, WORDS, OWN]}, "printed"), ({"number": [PRINTED, DIFFERS]}, "in part"),
        ({"number": [READ]}, "printed"), ({"number": [PRINTED | {"kind": "again"}]}, "printed"),
        ({"number": [DIFFERS]}, "differs"), ({"number": [WORDS]}, "words"), ({"number": [INPUT]}, "input"),
        ({"number": [OWN]}, "regression"), ({"tests": [TEST]}, "equation"), ({}, "text lost"), ({}, "sketch"),
    ],
)  # fmt: skip
def test_a_row_that_is_called_what_it_is_stands(row, kinds):
    assert rows.Row(**(ROW | row | {"kind": kinds})).faults() == []


@pytest.mark.parametrize(
    ("number", "said"),
    [
        (OWN | {"kind": "printed"}, "no printed number is given"),
        (PRINTED | {"found": 2.5}, "fegear's number is not listed"),
        (PRINTED | {"reading": 0.3}, "`because` does not say why"),
        (DIFFERS | {"because": ""}, "`because` does not say why"),
        (DIFFERS | {"found": None}, "does not say by how much"),
        (DIFFERS | {"printed": None}, "differs from nothing"),
        (WORDS | {"most": None}, "needs `statement`, and `most` or `least`"),
        (WORDS | {"statement": None}, "needs `statement`"),
        (OWN | {"statement": "not printed"}, "nothing in print"),
        (OWN | {"printed": "3 mm"}, "nothing in print"),
        (OWN | {"found": None}, "needs `found`"),
        (OWN | {"table": "c", "column": "d"}, "give `value`, or"),
        # what is no answer says why, and nothing else does
        (INPUT | {"origin": None}, "give `origin` where it is input"),
        (PRINTED | {"origin": "given"}, "give `origin` where it is input"),
        (INPUT | {"origin": "arithmetic"}, "give `by` where its origin is arithmetic"),
        (INPUT | {"by": "2 + 0.5"}, "give `by` where its origin is arithmetic"),
        (INPUT | {"origin": "inferred"}, "`because` does not say what"),
        (PRINTED | {"printed": "0.0000"}, "is zero, which is input"),
        (READ | {"reading": None}, "give the accuracy of `reading`"),
        # a place of a maximum is read on a grid that is finer than the print
        (PLACE | {"grid": None}, "give `grid` where it is the place of a maximum"),
        (PRINTED | {"grid": GRID}, "give `grid` where it is the place of a maximum"),
        (PLACE | {"grid": GRID | {"step": 0.5}}, "was found on a grid that is not finer than the print is read"),
        (PLACE | {"value": "design_chart.best_length_0.75", "grid": None}, "give `grid`"),
    ],
)
def test_a_number_that_is_called_what_it_is_not_is_refused(number, said):
    with pytest.raises(ValueError, match=said):
        rows.Number(**number)


def test_a_method_of_a_class_is_there():
    row = ROW | {"case": None, "kind": "sketch", "function": "fegear.geometry.rack.BasicRack.named"}
    assert rows.Row(**row).faults() == []


def test_a_lost_item_and_a_made_up_one_are_found():
    row = rows.Row(**(ROW | {"kind": "text lost"}))
    source = rows.Source(title="x", citation="mark", items=("Fig. 2",), row=(row,))
    assert source.faults() == ["no row covers Fig. 2", "a row covers Fig. 1, which is no item of the paper"]


T = {"table": "t", "column": "force [N]"}


@pytest.mark.parametrize(
    ("number", "said"),
    [
        # 0.1 inch is 2.54 mm: within half a unit of the last printed digit, or not
        ({"kind": "printed", "printed": "2.54 mm", "value": "a"}, ""),
        ({"kind": "printed", "printed": "2.5 mm", "value": "a"}, ""),
        (
            {"kind": "printed", "printed": "2.50 mm", "value": "a"},
            "fegear gives 2.54, printed is 2.50 mm (within 0.005)",
        ),
        ({"kind": "printed", "printed": "3 mm", "value": "a"}, ""),
        ({"kind": "printed", "printed": "2.4 mm", "value": "a"}, "printed is 2.4 mm (within 0.05)"),
        ({"kind": "printed", "printed": "2.4 mm", "value": "a", "reading": 0.2, "because": "off a plot"}, ""),
        ({"kind": "printed", "printed": "2.54e-3 m", "value": "a"}, ""),
        ({"kind": "input", "origin": "given", "printed": "2.60 mm", "value": "a"}, "printed is 2.60 mm"),
        ({"kind": "input", "origin": "arithmetic", "by": "2 * 1.27", "printed": "2.54 mm", "value": "a"}, ""),
        (
            {"kind": "input", "origin": "arithmetic", "by": "2 * 1.3", "printed": "2.54 mm", "value": "a"},
            "2 * 1.3 is 2.6",
        ),
        (
            {"kind": "input", "origin": "arithmetic", "by": "10 * at", "printed": "20 N", "near": {"n": 2}, **T},
            "",
        ),
        (
            {
                "kind": "printed",
                "printed": "1.5",
                "reading": 1.2,
                "because": "x",
                "grid": GRID,
                "value": "I.best_length",
            },
            "",
        ),
        (
            {
                "kind": "printed",
                "printed": "1.5",
                "reading": 1.2,
                "because": "x",
                "grid": GRID | {"step": 0.5},
                "value": "I.best_length",
            },
            "t has steps of 1 there, not 0.5",
        ),
        (
            {
                "kind": "printed",
                "printed": "1",
                "reading": 1.2,
                "because": "x",
                "grid": GRID,
                "value": "I.best_length_end",
            },
            "the place 1 is an end of t",
        ),
        ({"kind": "differs", "printed": "2.60 mm", "value": "a", "found": 2.54, "because": "x"}, ""),
        ({"kind": "differs", "printed": "2.60 mm", "value": "a", "found": 2.56, "because": "x"}, "the list says 2.56"),
        ({"kind": "differs", "printed": "2.54 mm", "value": "a", "found": 2.54, "because": "x"}, "is what is printed"),
        ({"kind": "words", "statement": "below 0.2", "value": "a", "most": 0.2}, ""),
        ({"kind": "words", "statement": "below 0.05", "value": "a", "most": 0.05}, "0.1 is more than 0.05"),
        ({"kind": "words", "statement": "above 0.2", "value": "a", "least": 0.2}, "0.1 is less than 0.2"),
        ({"kind": "regression", "value": "a", "found": 0.1}, ""),
        ({"kind": "regression", "value": "a", "found": 0.11}, "the list says 0.11"),
        ({"kind": "printed", "printed": "30 N", "take": "max", **T}, ""),
        ({"kind": "printed", "printed": "20 N", "where": {"n": 2}, **T}, ""),
        ({"kind": "printed", "printed": "30 N", "near": {"n": 2.6}, **T}, ""),
        ({"kind": "printed", "printed": "20 N", "take": "ptp", **T}, ""),
        ({"kind": "printed", "printed": "20 N", "take": "mean", **T}, ""),
        ({"kind": "printed", "printed": "1.5", "near": {"n": 3}, "over": {"n": 2}, **T}, ""),
        ({"kind": "printed", "printed": "2.0", "value": "c", "over": {"value": "a"}}, ""),
    ],
)
def test_a_number_is_compared_with_its_run(number, said, tmp_path):
    (tmp_path / "summary.json").write_text(
        '{"results": {"a": {"value": 0.1, "unit": "inch"}, "c": {"value": 5.08, "unit": "mm"},'
        '"I.best_length": {"value": 2, "unit": ""}, "I.best_length_end": {"value": 1, "unit": ""}}}'
    )
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "t.csv").write_text("n,force [N]\n1,10\n2,20\n3,30\n")
    fault = rows.Number(what="x", **number).fault(Run.in_folder(tmp_path))
    assert (fault == "") if said == "" else (said in fault)


def test_a_column_is_a_number_for_each_row(tmp_path):
    (tmp_path / "summary.json").write_text('{"results": {}}')
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "t.csv").write_text("n,force [N]\n1,10\n2,20\n3,30\n")
    column = rows.Series(kind="printed", what="force", key="n", unit="N", printed={"1": "10", "3": "31"}, **T)
    row = rows.Row(**(ROW | {"series": [column]}))
    assert [number.fault(Run.in_folder(tmp_path)) for number in row.numbers] == [
        "", "force 3: fegear gives 30, printed is 31 N (within 0.5)"
    ]  # fmt: skip
    assert row.count("printed") == 2


@pytest.mark.parametrize(
    ("case", "printed", "key"),
    [
        ("chart = { lengths = [0.91, 1.09, 1.21] }", "1.09", "chart.lengths"),  # a grid that is the printed answer
        (f"lengths = {[round(0.1 * k, 1) for k in range(1, 13)]}", "1.2", ""),
        (f"lengths = {[*(round(0.1 * k, 1) for k in range(1, 13)), 1.284]}", "1.284", ""),
        ("lengths = [0.1, 0.2, 0.3]", "0.2", "lengths"),
        ("kappa = 0.5", "0.50", "kappa"),
        ("face_width = '1 inch'", "2.54 cm", "face_width"),
        ("speeds = ['2000 rpm', '11000 rpm']", "11000 rpm", "speeds"),
        ("speeds = { start = '2000 rpm', stop = '16000 rpm', count = 57 }", "11000 rpm", ""),
        ("addendum = 1.0", "1.0000", ""),
        ("inner = [{ load = '363 lbf' }]", "363 lbf", "inner.load"),
        ("load = '1615 N'", "1615 mm", ""),
        ("title = 'one'", "1.5", ""),
    ],
)
def test_an_answer_in_the_input_is_found(case, printed, key):
    number, _, unit = printed.partition(" ")
    assert source_inputs.answer_in_input(Found(value=float(number), unit=unit), tomllib.loads(case)) == key


def numbers_of(paper):
    return [(row, number) for row in rows.sources()[paper].row for number in row.numbers]


#: Numbers worth the word "printed", those that a paper reads off its own curves, and those printed twice, by paper.
WORTH = {
    "blankenship_singh": (29, 0, 3), "lin_huston_coy": (0, 0, 0), "lin_townsend_oswald": (0, 1, 0),
    "litvin": (0, 0, 0), "mark": (3, 3, 1),
}  # fmt: skip
#: What is arithmetic on what is given, wherever it stands: geometry, kinematics and loads by a formula of the input.
ARITHMETIC = re.compile(
    r"contact_ratio|base_pitch|loading_(path|ramp)|mesh_frequency|frequency \[Hz\]|t \[s\]|load \[N\]"
    r"|(^|\.)mu$|mean_force"
)


@pytest.mark.parametrize("paper", rows.sources())
def test_what_is_called_printed_is_an_answer(paper):
    """No zero, no arithmetic, nothing inferred from, no member of a coarse grid, and nothing counted twice."""
    found = [(row, n) for row, n in numbers_of(paper) if n.kind in source_numbers.REPRODUCED]
    assert tuple(sum(n.kind == kind for _, n in found) for kind in source_numbers.REPRODUCED) == WORTH[paper]
    for row, n in found:
        assert n.in_print().value != 0.0
        assert not ARITHMETIC.search(n.value or n.column), (row.covers, n.what)
        assert not n.is_place or n.grid.step < n.accuracy(), (row.covers, n.what)
    counted = [
        (n.case or row.case, n.value, n.table, n.column, str(n.where or n.near), n.take)
        for row, n in found if n.kind != "again"
    ]  # fmt: skip
    # a row is asked for by its number as it is or as the key of a column
    alike = [(*key[:4], key[4].replace(".0", ""), key[5]) for key in counted]
    assert len(set(alike)) == len(alike)


#: Figures, tables and groups of equations of each paper, and how many of them differ in whole or in part.
ITEMS = {
    "blankenship_singh": (31, 4), "lin_huston_coy": (25, 0), "lin_townsend_oswald": (25, 8), "litvin": (43, 0),
    "mark": (83, 8),
}  # fmt: skip


@pytest.mark.parametrize("paper", rows.sources())
def test_every_item_is_held_or_differs_and_it_is_said_what_was_tried(paper):
    source = rows.sources()[paper]
    verdicts = source.verdicts()
    assert set(verdicts) == set(source.items)
    assert (len(verdicts), list(verdicts.values()).count("differs")) == ITEMS[paper]
    assert set(verdicts.values()) <= {"held", "differs"}
    assert {row.covers: row.untried() for row in source.row if row.untried()} == {}


TRIED = {"what": "warmer", "set": ["accuracy.tolerance=0.1"], "gave": {"a": 2.0}}


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ({"number": [DIFFERS], "tried": [TRIED]}, ""),
        ({"number": [PRINTED], "tried": [TRIED], "kind": "printed"}, "'warmer' names 'a', which does not differ"),
        ({"number": [DIFFERS], "tried": [TRIED | {"gave": {"b": 1.0}}]}, "'warmer' names 'b', which does not differ"),
        ({"number": [DIFFERS], "tried": [TRIED | {"set": []}]}, "'warmer' sets nothing"),
        ({"number": [DIFFERS], "tried": [TRIED | {"set": []}], "trial": ["accuracy.tolerance=0.1"]}, ""),
        ({"number": [DIFFERS], "tried": [TRIED | {"test": TEST}]}, "sets what its test does not run"),
        ({"number": [DIFFERS], "tried": [TRIED | {"set": [], "test": TEST}]}, ""),
        ({"number": [DIFFERS], "tried": [TRIED | {"set": [], "test": TEST + "_not"}]}, "is not there"),
    ],
)
def test_what_was_tried_names_numbers_that_differ_and_can_be_repeated(row, said):
    found = rows.Row(**(ROW | {"kind": "differs"} | row))
    assert (found.faults() == []) if said == "" else (said in " ".join(found.faults()))
    assert found.untried() == (["a"] if row["number"] == [DIFFERS] and "b" in row["tried"][0]["gave"] else [])


def test_one_item_that_differs_somewhere_differs():
    held, differs = (
        rows.Row(**(ROW | {"number": [PRINTED]})),
        rows.Row(**(ROW | {"kind": "differs", "number": [DIFFERS]})),
    )
    for both in ((held, differs), (differs, held)):
        assert rows.Source(title="x", citation="mark", items=("Fig. 1",), row=both).verdicts() == {"Fig. 1": "differs"}


def test_the_pages_count_what_the_rows_hold():
    """Reproduced, differing, input and regression are counted apart, and no number of fegear's stands in print."""
    numbers = [number for source in rows.sources().values() for row in source.row for number in row.numbers]
    kinds = {kind: [number for number in numbers if number.kind == kind] for kind in source_numbers.NUMBERS}
    assert sum(map(len, kinds.values())) == len(numbers)
    assert len([n for n in kinds["input"] if "relief [um]" in n.what]) == 30  # Mark's Table 2
    assert not [number.what for number in kinds["regression"] if number.printed or number.statement]
    assert all(number.because for number in kinds["differs"])
    origins = [number.origin for number in kinds["input"]]
    assert {origin: origins.count(origin) for origin in source_numbers.ORIGINS} == {
        "given": 6, "zero": 22, "arithmetic": 32, "inferred": 73
    }  # fmt: skip
