"""What pages and terminals say of runs, sweeps and effects: counts, shares, seconds, the worst and the first."""

import contextlib
import io
import math
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.notes import exceeding
from fegear.commands import studies as commands
from fegear.engine.named import Named
from fegear.engine.processes import Failure
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output import progress_bar
from fegear.output.effects import effects_page, effects_table, kernel_changes, sentence, stated_errors
from fegear.output.report.accuracy import accuracy_blocks
from fegear.output.report.blocks import Bars, Facts, Folded, Grid, Paragraph, Plot
from fegear.output.sweep_page import sweep_page
from fegear.studies.comparison.compare import Pairing
from fegear.studies.effects import Fixed, Measured, Switched
from fegear.studies.sweep import Point, SweepResults, read_axis
from fegear.studies.swept import Swept


# ---- the terminal ----------------------------------------------------------------------------------------------------
def test_a_log_has_a_line_for_each_finished_stage():
    stream = io.StringIO()
    with progress_bar.watcher(stream) as watcher:
        watcher.begin("Gear a", 2, 5)
        watcher.advance(0.4)
        assert stream.getvalue() == ""
        watcher.end(1.234)
    assert stream.getvalue() == "[2/5] Gear a: 1.23 s\n"
    stream.close()
    watcher.end(1.0)  # a closed log takes no run with it


def test_a_bar_is_filled_as_far_as_a_stage_is():
    told = []
    progress = SimpleNamespace(
        add_task=lambda words, total: told.append((words, total)) or "task",
        update=lambda task, completed: told.append((task, completed)),
    )
    bar = progress_bar.Bar(progress)
    bar.advance(0.5)
    bar.begin("Gear [a]", 1, 3)
    bar.advance(0.25)
    bar.end(9.0)
    assert told == [(r"\[1/3] Gear \[a]", 1.0), ("task", 0.25), ("task", 1.0)]


def test_a_notebook_s_line_changes_a_few_times_a_second_and_sums_up(monkeypatch):
    said = []
    handle = SimpleNamespace(update=lambda content, raw: said.append(content["text/plain"]))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=lambda *given, **how: handle))
    clock = iter([10.0, 10.0, 10.1, 10.25, 10.25])
    monkeypatch.setattr(progress_bar.time, "monotonic", lambda: next(clock))
    with progress_bar.watcher(io.StringIO(), notebook=True) as line:
        line.begin("Gear a", 1, 2)
        for fraction in (0.1, 0.2, 0.35):
            line.advance(fraction)
        line.end(1.5)
        line.end(2.0)
    assert said == ["[1/2] Gear a", "[1/2] Gear a: 10 %", "[1/2] Gear a: 35 %", "1 step in 1.50 s", "2 steps in 3.50 s"]


# ---- accuracy --------------------------------------------------------------------------------------------------------
def results_of(values, outcomes=None, solver="condensed"):
    accuracy = SimpleNamespace(tolerance=1e-2, solver=solver)
    return SimpleNamespace(
        scene=SimpleNamespace(case=SimpleNamespace(accuracy=accuracy)), values=values, seconds={"geometry": 0.5},
        outcomes=outcomes or {}, remarks=(),
    )  # fmt: skip


def test_values_are_counted_by_what_is_known_of_their_errors():
    values = [Value("a", 2.0, "", 0.01), Value("b", 4.0, "", 0.1), Value("c", 1.0, "", 0.0), Value("d", 1.0)]
    summary, figure, title, bars = accuracy_blocks(results_of(values))
    assert summary == Paragraph(
        "Relative tolerance of the case: 1 %. Of 4 values, 2 have an estimated error, 1 is exact, 1 have no error "
        "estimate. Above tolerance: b."
    )
    (panel,) = figure.figure.panels
    assert panel.y.categories == ("a", "b")
    within, over = panel.items
    assert (list(within.x), list(within.y), list(over.x), list(over.y)) == ([0.005], [0.0], [0.025], [1.0])
    assert (within.size, panel.marks[0].at, panel.x.log) == (9.0, 1e-2, True)
    assert isinstance(figure, Plot)
    assert (title.words, bars) == ("Elapsed time of each task:", Bars({"geometry": 0.5}, "s"))
    one = accuracy_blocks(results_of([Value("a", 2.0, "", 0.01), Value("c", 1.0, "", 0.0), Value("d", 1.0, "", 0.0)]))
    assert "1 have an estimated error, 2 are exact. No estimated error exceeds the tolerance." in one[0].words
    assert len(one) == 3  # one error is no figure
    noted = results_of([Value("a", 2.0, "", 0.01)])
    noted.remarks = (exceeding("Gear a: estimated error of c_self up to 8 % (tolerance 1 %)."),)
    assert "exceeds" not in accuracy_blocks(noted)[0].words  # a note names columns that do
    large = accuracy_blocks(results_of([Value("a", 2.0, "", 0.01), Value("b", 1.0, "", 0.7)]))
    assert large[0].words.endswith("Above tolerance: b.")
    assert accuracy_blocks(results_of([]))[0] == Paragraph("Elapsed time of each task:", "table-title")


def test_the_libraries_are_named_where_finite_elements_were_solved():
    def told(settings, solver="condensed"):
        outcomes = {"t": SimpleNamespace(settings=settings)}
        return [block for block in accuracy_blocks(results_of([], outcomes, solver)) if isinstance(block, Paragraph)]

    assert len(told({"order": 4})) == 1
    plain = told({"gear": {"solver": "condensed"}})
    assert "nested dissection assembles and eliminates" in plain[0].words
    other = told({"solver": "scikit-fem"}, "scikit-fem")
    assert 'fegear couples the sectors to the full gear (accuracy.solver = "scikit-fem").' in other[0].words
    folded = accuracy_blocks(
        results_of([], {"t": SimpleNamespace(settings={"a": 1}), "u": SimpleNamespace(settings={})})
    )
    assert folded[-1] == Folded("Settings: t", (Facts({"a": 1}),))
    assert sum(isinstance(block, Folded) for block in folded) == 1


# ---- a sweep's page --------------------------------------------------------------------------------------------------
def test_the_page_of_a_sweep_counts_points_and_tells_what_stays():
    axes = (read_axis("gear.a.teeth=20:31:12"), read_axis("b=1:13:13"), read_axis("c=p,q"))
    points = [Point((), (), ())] * 3 + [Failure("InputError", "too thin")] + [Point((), (), ())] * 308
    results = SweepResults("two", "Two gears", axes, tuple(points), 1.0, 0, (0, 0, 0.0))
    level = Swept("n", "um", "", np.append(np.full(311, 2.5), math.nan), None)
    moving = Swept("te", "", "", np.arange(312.0), None)
    nothing = Swept("none", "", "", np.full(312, math.nan), None)
    page = sweep_page(results, Table("sweep", ()), [level, moving, nothing], [], ["A note."])
    assert page.title == "Sweep: Two gears"
    assert page.note == "Case two over gear.a.teeth and b and c. 311 of 312 points computed."
    by_title = {section.title: section.blocks for section in page.sections}
    assert by_title["Varied keys"][0] == Grid(("Key", "Values"), [
        ("gear.a.teeth", ", ".join(map(str, range(20, 32)))), ("b", "1 to 13, 13 values"), ("c", "p, q"),
    ])  # fmt: skip
    assert by_title["Constant values"] == (Facts({"n [µm]": "2.5"}),)
    (failures,) = by_title["Failures"]
    assert failures.rows == [(1, "InputError", "gear.a.teeth = 20, b = 2, c = q", "too thin")]
    assert len(by_title["Warnings"]) == 1
    whole = SweepResults("two", "t", axes[2:], tuple(points[:2]), 1.0, 0, (0, 0, 0.0))
    page = sweep_page(whole, Table("sweep", ()), [], [], [])
    assert page.note.endswith("All 2 points computed.")
    assert [section.blocks for section in page.sections if section.title in ("Warnings", "Failures")] == [(), ()]


# ---- effects ---------------------------------------------------------------------------------------------------------
def measured(values, seconds, kernels=None):
    named = Named(tuple(values))
    return Measured(SimpleNamespace(values=named, tables=()), seconds, kernels or {})


def switched(before, after, named=True):
    return Switched("hertz", named, measured(before, 1.0, {"contact": 3, "spline": 2}),
                    measured(after, 2.5, {"contact": 3, "spline": 5, "edge": 1}))  # fmt: skip


def um(name, size, error=None):
    return Value(name, size * 1e-6, "um", None if error is None else error * 1e-6)


def test_an_effect_is_told_by_the_value_that_it_changes_most():
    found = switched([um("I.te", 8.0, 0.1), um("I.mean", 20.0, 0.1)], [um("I.te", 10.0, 0.1), um("I.mean", 21.0, 0.1)])
    assert sentence(found) == "hertz: largest change in I.te: 8 -> 10 um; CPU time 1.00 s without, 2.50 s with."
    assert kernel_changes(found) == "spline 2 -> 5; edge 0 -> 1"
    table = effects_table([found])
    data = {one.name: list(one.values) for one in table.columns}
    assert data["without"] == pytest.approx([8.0, 20.0])
    assert data["change"] == pytest.approx([2.0, 1.0])
    assert data["share"] == pytest.approx([0.2, 1.0 / 21.0])
    assert data["error_without"] == pytest.approx([0.1, 0.1])
    assert (data["resolved"], data["in_the_case"]) == (["yes", "yes"], ["on", "on"])
    assert (data["processor_without"], data["processor_with"]) == ([1.0, 1.0], [2.5, 2.5])
    assert len(effects_table([]).columns[0]) == 0
    none = switched([um("I.te", 8.0)], [um("I.te", 8.0)], named=False)
    assert sentence(none) == "hertz: no value changes; CPU time 1.00 s without, 2.50 s with."
    within = switched([um("I.te", 8.0, 1.0), um("I.k", 5.0, 4.0)], [um("I.te", 9.0, 1.0), um("I.k", 7.0)])
    assert sentence(within) == (
        "hertz: no change above the estimated error; I.k: +2 um, not resolved (+- 4); CPU time 1.00 s without, 2.50 "
        "s with."
    )
    assert stated_errors(Pairing("x", um("x", 1.0, 0.25), um("x", 2.0, 0.5))) == "+- 0.25 and +- 0.5"
    assert stated_errors(Pairing("x", um("x", 1.0), um("x", 2.0, 0.0))) == "round-off"


def test_the_page_of_effects_lists_the_largest_changes_first():
    found = switched([um("I.mean", 20.0, 0.1), um("I.te", 8.0, 0.1), um("n", 3.0)],
                     [um("I.mean", 21.0, 0.1), um("I.te", 10.0, 0.1), um("n", 3.0)])  # fmt: skip
    scene = SimpleNamespace(case=SimpleNamespace(title="A pair"), name="pair", text="")
    page = effects_page(scene, [found], [Fixed("relief", "is not given")], Table("effects", ()), {"hertz": None},
                        {"hertz": "figure"}, {"hertz": "It does."})  # fmt: skip
    glance, effect, stuck, _ = page.sections
    assert glance.blocks[0].rows == [("hertz", "on", "I.te", "8 to 10 µm", "1.00 without, 2.50 with")]
    said, _, values, kernels = effect.blocks
    assert said == Paragraph("It does.")
    assert effect.title == "hertz (on in the case)"
    assert values.title == "The 2 values it changes"
    assert values.blocks[0].rows == [
        ("I.te", pytest.approx(8.0), pytest.approx(10.0), "µm", "+20 %"),
        ("I.mean", pytest.approx(20.0), pytest.approx(21.0), "µm", "+4.76 %"),
    ]
    assert kernels.blocks[0] == Facts({"edge": "0 without, 1 with", "spline": "2 without, 5 with"})
    assert stuck.blocks[0].rows == [("relief", "is not given")]
    assert page.note == "Case pair with each of 1 effects switched, one at a time."
    assert page.files == {}


def test_a_table_of_nothing_is_empty():
    assert len(effects_table([]).columns) == 14
    assert isinstance(effects_table([]).columns[0], Column)


def test_a_study_of_effects_ends_after_the_seconds_that_it_took(monkeypatch, tmp_path):
    ended, said = [], []
    watching = SimpleNamespace(begin=lambda *_: None, advance=lambda _: None, end=ended.append)
    voice = SimpleNamespace(
        watcher=lambda: contextlib.nullcontext(watching), say=said.append, tell_folder=lambda _: None
    )
    monkeypatch.setattr(commands, "Voice", lambda *_: voice)
    monkeypatch.setattr("fegear.studies.effects.effect_study", lambda *_: ("scene", (), ()))
    monkeypatch.setattr("fegear.output.effects.write_effects", lambda *_: ["one."])
    clock = iter([1000.0, 1003.5, 1004.25])
    monkeypatch.setattr(commands, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    commands.effects(Path("c.toml"), out=tmp_path / "new")
    assert ended == [3.5]
    assert said == ["one.", f"Wrote {tmp_path / 'new'} in 4.25 s."]


def test_a_sweep_says_how_long_it_has_still_to_run(monkeypatch, tmp_path):
    asked = []

    def watcher(**given):
        asked.append(given)
        return contextlib.nullcontext(SimpleNamespace(begin=lambda *_: None, advance=None))

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(commands, "Voice", lambda *_: SimpleNamespace(watcher=watcher))
    monkeypatch.setattr("fegear.studies.sweep.sweep_case", interrupted)
    with pytest.raises(SystemExit) as end:
        commands.sweep(Path("c.toml"), over=["gear.a.teeth=20,21"], out=tmp_path / "new")
    assert end.value.code == 130
    assert asked == [{"remaining": True}]
