"""The pages "Sources": every figure, table and group of equations of the papers has its row, and every number holds."""

import importlib.util
import sys
from pathlib import Path

import pytest

import fegear

ROOT = Path(__file__).parents[2]


def _source_rows():
    spec = importlib.util.spec_from_file_location("source_rows", ROOT / "docs" / "source_rows.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


rows = _source_rows()
#: Cases that cost more than a second; the site is built with every case and does not stand when a number does not hold.
COSTLY = {f"sources/lin_townsend_oswald_fig{n}" for n in ("8", "9", "10", "11c")} | {"blankenship_singh"}
CASES = [pytest.param(case, marks=[pytest.mark.long] if case in COSTLY else []) for case in rows.cases()]


@pytest.mark.parametrize("paper", rows.sources())
def test_every_item_of_a_paper_has_its_row(paper):
    assert rows.sources()[paper].faults() == []


@pytest.mark.parametrize("case", CASES)
def test_the_numbers_of_a_case_hold(case):
    run = rows.Run.of(fegear.run(ROOT / "cases" / f"{case}.toml"))
    assert rows.faults_of_runs(case, run) == []


def test_every_case_of_the_folder_answers_for_something():
    there = {f"sources/{path.stem}" for path in (ROOT / "cases" / "sources").glob("*.toml")}
    assert there - set(rows.cases()) == set()


ROW = {"covers": ["Fig. 1"], "shows": "x", "judgement": "reproduced", "case": "thin_rim"}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"judgement": "reproduced"}, "no number or function shows it"),
        ({"case": "nowhere", "judgement": "text lost"}, "nowhere.toml is not there"),
        ({"case": None, "judgement": "sketch"}, "names no case"),
        ({"case": None, "judgement": "sketch", "function": "fegear.geometry.Nothing"}, "is not there"),
        ({"case": None, "judgement": "sketch", "command": "fegear dance cases/thin_rim.toml"}, "is no command"),
        ({"judgement": "differs"}, "does not say why"),
        (
            {"number": [{"what": "a", "printed": "1 mm", "value": "b", "found": 2.0}]},
            "a differs in a row that is called reproduced",
        ),
    ],
)
def test_a_row_that_answers_for_nothing_is_found(changes, said):
    assert said in " ".join(rows.Row(**(ROW | changes)).faults())


def test_a_method_of_a_class_is_there():
    row = ROW | {"case": None, "judgement": "sketch", "function": "fegear.geometry.rack.BasicRack.named"}
    assert rows.Row(**row).faults() == []


def test_a_lost_item_and_a_made_up_one_are_found():
    row = rows.Row(**(ROW | {"judgement": "text lost"}))
    source = rows.Source(title="x", citation="mark", items=("Fig. 2",), row=(row,))
    assert source.faults() == ["no row covers Fig. 2", "a row covers Fig. 1, which is no item of the paper"]


@pytest.mark.parametrize(
    ("number", "said"),
    [
        ({"printed": "2.54 mm", "value": "a"}, ""),
        ({"printed": "2.5 mm", "value": "a"}, "fegear gives 2.54, printed is 2.5 mm"),
        ({"printed": "2.5 mm", "value": "a", "found": 2.54}, ""),
        ({"printed": "2.5 mm", "value": "a", "found": 2.56}, "the list says 2.56"),
        ({"statement": "below 0.2", "value": "a", "most": 0.2}, ""),
        ({"statement": "below 0.05", "value": "a", "most": 0.05}, "0.1 is more than 0.05"),
        ({"statement": "above 0.2", "value": "a", "least": 0.2}, "0.1 is less than 0.2"),
        ({"printed": "30 N", "table": "t", "column": "force [N]", "take": "max"}, ""),
        ({"printed": "20 N", "table": "t", "column": "force [N]", "where": {"n": 2}}, ""),
        ({"printed": "30 N", "table": "t", "column": "force [N]", "near": {"n": 2.6}}, ""),
        ({"printed": "20 N", "table": "t", "column": "force [N]", "take": "ptp"}, ""),
        ({"printed": "20 N", "table": "t", "column": "force [N]", "take": "mean"}, ""),
    ],
)
def test_a_number_is_held_against_its_run(number, said, tmp_path):
    (tmp_path / "summary.json").write_text('{"results": {"a": {"value": 0.1, "unit": "inch", "error": null}}}')
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "t.csv").write_text("n,force [N]\n1,10\n2,20\n3,30\n")
    fault = rows.Number(what="x", **number).fault(rows.Run.in_folder(tmp_path))
    assert (fault == "") if said == "" else (said in fault)
