"""Answers of several gauges: one table, what does not agree first, on the terminal and on the page."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from fegear.base.printed import column_figures
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.answered import Answered
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.run_answer import joined
from fegear.engine.table import Column, Table
from fegear.output.report.blocks import DataTable
from fegear.output.spoken_values import answer_lines
from fegear.output.tables import row_lines
from fegear.results.catalogue import STAGES

_CACHE = SolutionCache()


def run(gauges, folder=Path(), torques=("16 N*m",)):
    gear = {"module": "2 mm", "face_width": "10 mm"}
    document = {
        "results": ["gauge"],
        "gear": {"a": {"teeth": 20, "profile_shift": 0.1, **gear}, "b": {"teeth": 31, **gear}},
        "pair": {"p": {"driver": "a", "driven": "b", "torques": list(torques)}},
        "gauge": {name: {"gear": "a", "grid_length": "0.3 mm", **more} for name, more in gauges.items()},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True},
        "accuracy": {"tolerance": 1e-2},
    }
    scene = build_scene(document, "case", folder)
    return run_plan(scene, make_plan(scene, STAGES), cache=_CACHE)


def written(folder, name, history, gain):
    angle = np.arange(0.0, 720.0, 0.7)
    place = np.mod(np.radians(angle - 40.0) + math.pi, 2.0 * math.pi) - math.pi
    strain = 1e6 * gain * np.interp(place, history.angle, history.strain[:, 0], left=0.0, right=0.0) + 20.0
    strain += np.random.default_rng(3).normal(0.0, 2.0, angle.size)
    rows = "".join(f"{a:.2f},{s:.4f}\n" for a, s in zip(angle, strain, strict=True))
    (folder / f"{name}.csv").write_text("angle [deg],strain [um/m]\n" + rows)


@pytest.mark.dear
def test_every_gauge_has_its_row_in_the_order_of_the_case(tmp_path):
    plain = run({"one": {}})
    (outcome,) = (one for task, one in plain.outcomes.items() if str(task) == "gauge of one")
    for name, gain in (("good", 1.01), ("turned", -0.99), ("twice", 2.0)):
        written(tmp_path, name, outcome.data.history, gain)
    fit = ["offset", "scale", "shift"]
    traces = {name: {"measured": {"file": f"{name}.csv", "fit": fit}} for name in ("good", "turned", "twice")}
    found = run({"plain": {}, **traces}, tmp_path)
    (table,) = found.answer.overviews
    cells = {column.name: column.values.tolist() for column in table.columns}
    assert cells["gauge"] == ["plain", *traces]  # as in the case
    row = dict(zip(cells["gauge"], zip(*(cells[one] for one in ("verdict", "scale", "offset", "shift")), strict=True),
                   strict=True))  # fmt: skip
    assert re.match(r"agrees: (0\.[89]\d*|1\.[012]) % above \(limit ", row["good"][0])
    assert row["good"][1:] == pytest.approx((1.01, 20.0, 40.0), abs=0.4)
    assert row["turned"][0] == "fits with its sign reversed"
    assert row["twice"][0] == "does not agree: 2 times"
    assert row["plain"][0] == ""
    assert np.isnan(row["plain"][1:]).all()
    assert cells["torque"] == pytest.approx([16.0] * 4)
    assert found.tables["gauges"] is not None
    lines = answer_lines(found.answer)
    assert lines[0] == found.answer.sentences[0]
    assert lines[1].startswith("gauge ")
    assert [line.split()[0] for line in lines[2:6]] == cells["gauge"]
    assert lines[6:] == list(found.answer.sentences[1:])
    assert "gauges" not in run({"one": {}, "two": {"grid_length": "0.2 mm"}}).tables  # sentences say both


def test_columns_of_traces_are_not_shown_where_nothing_was_measured():
    found = run({"one": {}, "two": {"grid_length": "0.2 mm"}, "three": {"fillet": "compression"}})
    lines = answer_lines(found.answer)
    assert lines[1].split() == [
        "gauge", "torque", "[N.m]", "computed_peak", "[um/m]", "change_by_placement", "[%]",
    ]  # fmt: skip
    assert [line.split()[0] for line in lines[2:5]] == ["one", "two", "three"]  # as in the case
    assert lines[0].startswith("Three gauges, computed peak strain -")
    assert "; displaced within its tolerance two changes most, by up to -" in lines[0]
    assert lines[0].count(" %") == 2
    assert found.tables["gauges"].title == "Computed strain of all gauges"
    assert {"scale", "shift [deg]"} <= {column.head for column in found.tables["gauges"].columns}  # the file has all


def test_before_there_is_a_trace_the_peak_of_every_torque_is_in_the_table():
    found = run({"one": {}, "two": {"fillet": "compression"}}, torques=["4 N*m", "16 N*m", "8 N*m"])
    table = found.tables["gauges"]
    assert table.column("gauge").values.tolist() == ["one"] * 3 + ["two"] * 3
    assert table.column("torque").values.tolist() == pytest.approx([4.0, 8.0, 16.0] * 2)
    for name in ("one", "two"):
        peaks = next(one.data for task, one in found.outcomes.items() if str(task) == f"gauge of {name}").peak_strain
        mine = table.column("gauge").values == name
        assert sorted(np.abs(table.column("computed_peak").si[mine])) == pytest.approx(sorted(np.abs(peaks)))
    assert len(answer_lines(found.answer)[1:8]) == 7


def test_numbers_of_a_column_have_equal_decimals():
    assert column_figures([0.97791, 1.0, 1.0172]) == ["0.978", "1.000", "1.017"]
    assert column_figures([118.62, 243.8, math.nan]) == ["118.6", "243.8", ""]
    assert column_figures([150.0, 300.0]) == ["150", "300"]
    assert column_figures([-1234.6, 2.0]) == ["-1235", "2"]
    assert column_figures([0.0]) == ["0"]
    assert column_figures([math.nan]) == [""]
    column = Column("scale", np.array([0.97791, 1.0]), "")
    block = DataTable(Table("t", (Column("gauge", np.array(["a", "b"])), column)), brief=True, as_on_terminal=True)
    assert [row[1] for row in block.rows] == [("0.978", "0.97791"), ("1.000", "1")]
    assert row_lines(block.table) == ["gauge  scale", "a      0.978", "b      1.000"]


def test_tables_of_subjects_are_joined_in_the_order_of_the_case():
    def of(name, rank):
        table = Table("all", (Column("name", np.array([name])), Column("size", np.array([rank]), "mm")), "All")
        return Answered((f"{name}.",), rank=rank, overviews=(table,))

    (found,) = joined([of("a", 2.0), of("long", 1.0), of("c", 3.0)]).overviews
    assert found.columns[0].values.tolist() == ["a", "long", "c"]
    assert found.columns[1].values == pytest.approx([2e3, 1e3, 3e3])
    assert row_lines(found) == ["name  size [mm]", "a          2000", "long       1000", "c          3000"]
    assert joined([of("a", 2.0)]).overviews[0].columns[0].values.tolist() == ["a"]
