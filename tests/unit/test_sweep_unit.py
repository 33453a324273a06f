"""Sweeps: axes as users write them, one labelled dataset, failures in words, and the same bits however it was run."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
import threading
import time

import in_process
import numpy as np
import pytest
from typer.testing import CliRunner

from fegear.base.errors import InputError
from fegear.case.built.atlas_teeth import solved_remarks
from fegear.cli import program
from fegear.engine.executor import Executor
from fegear.studies.sweep import SweepResults, _by_atlas, _point, point_content, read_axis, sweep_case
from fegear.studies.swept import Swept, best_lines

CASE = """
title = "A pinion and its mate"
results = ["geometry"]
[gear.a]
teeth = 20
module = "2 mm"
bore_radius = "10 mm"
[gear.b]
teeth = 31
module = "2 mm"
bore_radius = "15 mm"
[pair.I]
driver = "a"
driven = "b"
[stiffness]
gear = "a"
positions = 5
contact_half_width = "0.05 mm"
[accuracy]
tolerance = 0.5
"""
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
#: The shapes of 2 profile shifts under 100 contact widths.


def grid(points):
    """Two shapes, many contact widths."""
    return (
        "--set", 'results=["stiffness"]',
        "--over", "gear.a.profile_shift=0.1:0.5:2",
        "--over", f"stiffness.contact_half_width=0.02:0.119:{points // 2}:mm",
        "--no-plots",
    )  # fmt: skip


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "two.toml"
    path.write_text(CASE)
    return path


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-c", "from fegear.cli import main; main()", "sweep", *map(str, arguments)]


def fegear(*arguments: object, cwd, cache, points_here: bool = False):
    """Run the sweep command in this process (its workers are processes of their own, or this one)."""
    return in_process.fegear("sweep", *arguments, cwd=cwd, points_here=points_here, FEGEAR_CACHE=cache)


@pytest.mark.parametrize(
    ("text", "values", "unit"),
    [
        ("k=-0.4:0.8:4", (-0.4, 0.0, 0.4, 0.8), ""),
        ("k=0:1:11", tuple(i / 10 for i in range(11)), ""),
        ("k=20:26:4", (20, 22, 24, 26), ""),
        ("k=20:21:3", (20.0, 20.5, 21.0), ""),
        ("k=1:1000:4:log", (1, 10, 100, 1000), ""),
        ("k=10:20:3:mm", ("10 mm", "15 mm", "20 mm"), "mm"),
        ("k=10 mm:20 mm:3", ("10 mm", "15 mm", "20 mm"), "mm"),
        ("k=1:100:3:N/mm:log", ("1 N/mm", "10 N/mm", "100 N/mm"), "N/mm"),
        ("k=3:3:1", (3,), ""),
        ("k=0.1,0.25", (0.1, 0.25), ""),
        ("k=1 mm,2 mm", ("1 mm", "2 mm"), "mm"),
        ("k=0.001,100:N*m", ("0.001 N*m", "100 N*m"), "N*m"),
        ('k="ISO 53 A","ISO 53 B"', ("ISO 53 A", "ISO 53 B"), ""),
        ("k=fe,cornell", ("fe", "cornell"), ""),
        ("k=[true, false]", (True, False), ""),
    ],
)
def test_axes_are_read_as_a_user_means_them(text, values, unit):
    axis = read_axis(text)
    assert (axis.key, axis.values, axis.unit) == ("k", values, unit)
    assert [type(value) for value in axis.values] == [type(value) for value in values]


@pytest.mark.parametrize(
    "text",
    ["k", "k=", "=1:2:3", "k=1:2", "k=1:2:0", "k=1:2:x", "k=a:b:3", "k=1 mm:2 cm:3", "k=1:2:1", "k=0:1:3:log",
     "k=1,1", "k=[1, nan]", "k=1:2:3:4:5:6", "k=1:2:10000000", "k=1,2:3,4"],
)  # fmt: skip
def test_axes_that_mean_nothing_are_refused(text):
    with pytest.raises(InputError, match="--over"):
        read_axis(text)


def test_the_dataset_is_labelled_and_agrees_with_single_runs(case, tmp_path):
    import xarray

    out = tmp_path / "out"
    axes = (
        "--over",
        "gear.a.teeth=18:24:3",
        "--over",
        "gear.b.module=2:2:1:mm",
        "--over",
        "gear.a.profile_shift=0,0.3",
    )
    done = fegear(case, *axes, "--no-plots", "--out", out, cwd=tmp_path, cache=tmp_path / "cache", points_here=True)
    assert done.returncode == 0, done.stderr
    assert sorted(p.relative_to(out).as_posix() for p in out.rglob("*") if p.is_file()) == [
        ".fegear-files.json", "report.html", "summary.json", "sweep.nc", "tables/sweep.csv",
    ]  # fmt: skip
    with xarray.open_dataset(out / "sweep.nc") as data:
        assert dict(data.sizes)["gear.a.teeth"] == 3
        assert data["gear.b.module"].attrs["units"] == "mm"
        assert (data["failure"] == "").all()
        ratio = data["I.contact_ratio"].sel({"gear.a.teeth": 21, "gear.a.profile_shift": 0.3}).item()
        radius = data["geometry.tip_radius"].sel({"gear.a.teeth": 21}).values
        assert data["geometry.tip_radius"].attrs["units"] == "mm"
    changes = ("--set", "gear.a.teeth=21", "--set", "gear.a.profile_shift=0.3", "--out", str(tmp_path / "one"))
    assert CliRunner().invoke(program(), ["run", str(case), "--no-plots", *changes]).exit_code == 0
    one = json.loads((tmp_path / "one" / "summary.json").read_text())["results"]
    assert ratio == one["I.contact_ratio"]["value"]
    assert radius[0] == pytest.approx(np.array([[23.0, 33.0], [23.6, 33.0]]))
    with (out / "tables" / "sweep.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["gear.a.teeth"] for row in rows] == ["18", "18", "21", "21", "24", "24"]
    assert float(rows[3]["I.contact_ratio"]) == pytest.approx(ratio, rel=1e-11)


def test_the_best_point_is_told_with_those_that_may_be_as_good_and_where_a_better_one_may_lie():
    axes = (read_axis("gear.a.profile_shift=0:0.2:3"), read_axis("gear.b.teeth=30:31:2"))
    results = SweepResults("two", "", axes, (), 0.0, 0, (0, 0, 0.0))
    shift = np.array([5.0, 4.0, 3.0, 3.1, np.nan, 6.0])
    values = [
        Swept("I.te_peak_to_peak", "um", "", shift, np.full(6, 0.06)),
        Swept("I.driver.S_F", "", "", shift, None),
        Swept("I.te_peak_to_peak.designed", "um", "", shift, None),
        Swept("I.te_mean", "um", "", shift, None),
    ]
    least, most = best_lines(results, values)
    assert least == (
        "Minimum I.te_peak_to_peak: 3 um at gear.a.profile_shift = 0.1, gear.b.teeth = 30; 1 other point equal within "
        "the estimated errors."
    )
    assert most == (
        "Maximum I.driver.S_F: 6 at gear.a.profile_shift = 0.2, gear.b.teeth = 31; at the limit of the range of "
        "gear.a.profile_shift."
    )


def test_who_asks_for_no_atlas_is_not_bothered_with_those_that_do_not_answer():
    """28 of 28 points of a page said that no atlas has their rack."""
    said = [*solved_remarks("a", "rack.tip_radius = 0.25: must be 0.38 in this atlas"), "something else"]
    found = {"values": [], "tables": [], "remarks": said}
    assert _point(found, unasked=True).remarks == ("something else",)
    assert _point(found, unasked=False).remarks == tuple(said)


def test_sweeps_over_gears_take_teeth_from_an_atlas_unless_the_case_or_an_axis_says_otherwise():
    gears, speed = read_axis("gear.a.teeth=20,21"), read_axis("pair.I.speed=10:20:2:rpm")
    assert _by_atlas([gears], {"title": "x"}) == {"title": "x", "accuracy": {"source": "auto"}}
    assert _by_atlas([speed, gears], {"accuracy": {"tolerance": 1e-2}})["accuracy"] == {
        "tolerance": 1e-2,
        "source": "auto",
    }
    said = {"accuracy": {"source": "solve"}}
    assert _by_atlas([gears], said) is said
    assert _by_atlas([speed], {}) == {}
    assert _by_atlas([gears, read_axis("accuracy.source=solve,atlas")], {}) == {}


def test_failures_are_values_with_a_reason_and_reported_in_groups(case, tmp_path):
    import xarray

    where = {"cwd": tmp_path, "cache": tmp_path / "cache", "points_here": True}
    done = fegear(case, "--over", "gear.a.profile_shift=0:2:5", **where)
    assert done.returncode == 0, done.stderr
    notes = [line for line in done.stdout.splitlines() if "failed" in line]
    with xarray.open_dataset(tmp_path / "results" / "two_sweep" / "sweep.nc") as data:
        failed = data["failure"].values != ""
        assert (np.isnan(data["I.contact_ratio"].values) == failed).all()
        assert "gear.a" in data["failure"].values[-1]
    assert 0 < failed.sum() < 5
    assert 1 <= len(notes) < failed.sum()
    counts = [int(note.split()[1]) for note in notes]
    assert sum(counts) == failed.sum()
    assert f"{5 - failed.sum()} of 5 points computed." in done.stdout
    page = (tmp_path / "results" / "two_sweep" / "report.html").read_text(encoding="utf-8")
    told = page.split("<section id='failures'")[1].split("</section>")[0]
    assert [int(row.split("<td>")[1].split("</td>")[0]) for row in told.split("<tr>")[2:]] == counts
    assert (tmp_path / "results" / "two_sweep" / "plots" / "sweep_I.contact_ratio.png").is_file()
    nothing = fegear(case, "--over", "gear.a.profile_shift=5:6:2", "--no-plots", **where)
    assert nothing.returncode == 1
    assert "0 of 2 points computed." in nothing.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--over", "gear.a.teth=20:22:3"), 'did you mean "teeth"'),
        (("--over", "gear.c.teeth=20:22:3"), '"c" is not in this case'),
        (("--over", "gear.a.teeth=20:22:3", "--over", "gear.a.teeth=1:2:3"), "is specified twice"),
        (
            ("--set", "gear.a.bore_diameter=20 mm", "--over", "gear.a.bore_radius=8:12:3:mm"),
            "contradicts gear.a.bore_diameter = 20 mm of the case; sweep gear.a.bore_diameter, or remove it",
        ),
        (("--over", "gear.a.teeth=20:22:3", "--out", "/proc/none"), "is not writable ("),
        ((), "Missing option '--over'"),
    ],
)
def test_sweeps_that_cannot_be_are_refused_before_they_start(arguments, words, case, tmp_path):
    done = fegear(case, *arguments, cwd=tmp_path, cache=tmp_path / "cache")
    assert done.returncode == 2
    assert words in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["two.toml"]


@pytest.mark.dear
@pytest.mark.parametrize("points", [14, pytest.param(200, marks=pytest.mark.long)])
def test_a_killed_sweep_goes_on_and_equals_an_uninterrupted_one_bit_for_bit(case, tmp_path, points):
    asked, early = grid(points), points // 7
    whole = fegear(case, *asked, "--out", "whole", cwd=tmp_path, cache=tmp_path / "one")
    assert whole.returncode == 0, whole.stderr
    assert f"{points} of {points} points computed." in whole.stdout
    # 2 shapes on a mesh or more each: all points and two workers never solved one twice.
    summary = json.loads((tmp_path / "whole" / "summary.json").read_text())
    shapes = summary["timings"]["shapes_solved"]
    assert shapes >= 2
    assert len(list((tmp_path / "one" / "solutions").rglob("*.entry"))) == points + shapes

    kept = tmp_path / "two"
    environment = {**ENVIRONMENT, "FEGEAR_CACHE": str(kept)}
    process = subprocess.Popen(
        command(case, *asked, "--workers", 1, "--out", "resumed"),
        cwd=tmp_path, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    for _ in range(6000):
        finished = len(list((kept / "solutions").rglob("*.entry"))) - shapes
        if finished >= early or process.poll() is not None:
            break
        time.sleep(0.01)
    process.kill()
    process.wait()
    assert early <= finished < points
    assert not (tmp_path / "resumed").exists()

    resumed = fegear(case, *asked, "--workers", 1, "--out", "resumed", cwd=tmp_path, cache=kept)
    assert resumed.returncode == 0, resumed.stderr
    told = json.loads((tmp_path / "resumed" / "summary.json").read_text())["timings"]
    assert early <= told["points_kept_from_earlier"] < points
    assert told["shapes_solved"] < shapes
    for name in ("sweep.nc", "tables/sweep.csv", "report.html"):
        assert (tmp_path / "resumed" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one", "resumed", "two", "two.toml", "whole"]


@pytest.mark.dear
@pytest.mark.parametrize("cluster", [False, pytest.param(True, marks=pytest.mark.long)])
def test_executors_are_bit_equal(case, request, tmp_path, cluster):
    """Points on a cluster are those computed here: tests of the executor, in the ordinary run too."""
    scheduler = [("cluster", ("--scheduler", request.getfixturevalue("scheduler")))] if cluster else []
    axis = ("--set", 'results=["stiffness"]', "--over", "gear.a.profile_shift=0:2:3", "--no-cache", "--no-plots")
    for name, more in (("cores", ()), ("one", ("--workers", 1)), *scheduler):
        done = fegear(case, *axis, *more, "--out", name, cwd=tmp_path, cache=tmp_path / "cache")
        assert done.returncode == 0, done.stderr
        assert "2 of 3 points computed." in done.stdout
    first = (tmp_path / "cores" / "sweep.nc").read_bytes()
    for name in ("one", *dict(scheduler)):
        assert (tmp_path / name / "sweep.nc").read_bytes() == first
    assert not (tmp_path / "cache").exists()


def test_a_changed_file_that_the_case_names_is_computed_anew(tmp_path):
    point = {"document": {"title": "x", "pair": {"I": {"file": "c.csv"}}}, "name": "x", "folder": str(tmp_path)}
    keys = [point_content(point)]
    for text in ("1", "2"):
        (tmp_path / "c.csv").write_text(text)
        keys.append(point_content(point))
    assert keys[0] != keys[1] != keys[2]
    assert point_content({**point, "document": {**point["document"], "title": "y"}}) == keys[2]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
def test_a_text_of_the_case_that_names_a_pipe_or_a_device_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "file").write_text("x")
    document = {"load": "pipe", "more": ["/dev/zero", "/dev/tty", ".", "", "\0", "x" * 5000, {"a": "file"}]}
    found = []
    point = {"document": document, "name": "x", "folder": str(tmp_path)}
    thread = threading.Thread(target=lambda: found.append(point_content(point)), daemon=True)
    thread.start()
    thread.join(10.0)
    assert [files.keys() for _, files in found] == [{"file"}]


@pytest.mark.dear
def test_sweeps_work_from_python_too(case):
    found = sweep_case(case, [read_axis("gear.a.teeth=20:22:3")], executor=Executor(workers=1))
    assert [point.values[0].name for point in found.points] == ["I.contact_ratio"] * 3
    assert found.kept == 0
    assert found.place(2) == "gear.a.teeth = 22"


@pytest.mark.dear
def test_a_run_reads_the_cache_only_when_asked_and_then_says_so(case, tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_CACHE", str(tmp_path / "cache"))
    told = []
    for more in ((), ("--cache",), ("--cache",), ()):
        arguments = ["run", case, "--no-plots", "--set", 'results=["stiffness"]', "--out", tmp_path / "o", *more]
        assert CliRunner().invoke(program(), [str(one) for one in arguments]).exit_code == 0
        found = json.loads((tmp_path / "o" / "summary.json").read_text())
        told.append((found["recalled"], [r for r in found["remarks"] if "disk cache" in r], found["results"]))
    assert [bool(cached) for cached, _, _ in told] == [False, False, True, False]
    assert [len(remarks) for _, remarks, _ in told] == [0, 0, 1, 0]
    assert told[2][0]["gear-solution of a"]["shapes"] == 1
    assert told[2][0]["gear-solution of a"]["seconds_when_computed"] > 0.0
    assert set(found["origin"].values()) == {"computed"}
    assert all(results == told[0][2] for _, _, results in told)


@pytest.mark.parametrize("changed", [False, True])
def test_only_where_a_sweep_has_asked_for_an_atlas_itself_points_are_not_bothered_with_it(
    monkeypatch, tmp_path, changed
):
    from fegear.studies import sweep

    given, asked = {"title": "given"}, {"title": "asked"}
    monkeypatch.setattr(sweep, "read_document", lambda path, overrides: given)
    monkeypatch.setattr(sweep, "_check", lambda axes, document: None)
    monkeypatch.setattr(sweep, "_by_atlas", lambda axes, document: asked if changed else document)
    monkeypatch.setattr(sweep, "_grid", lambda document, axes: [{"n": 1}, {"n": 2}])
    monkeypatch.setattr(sweep, "_neglecting", lambda number, document: document | {"number": number})
    monkeypatch.setattr(sweep, "count_kept", lambda compute, points, cache, key: len(points) + 5)
    failure = sweep.Failure("f", "words")
    monkeypatch.setattr(
        sweep, "map_points", lambda compute, points, executor, cache, **how: [points[0], failure],
    )  # fmt: skip
    monkeypatch.setattr(sweep, "_point", lambda item, unasked: (item, unasked))
    found = sweep.sweep_case(tmp_path / "c.toml", ["axis"])
    item = {"document": {"n": 1, "number": 0}, "name": "c", "folder": str(tmp_path)}
    assert found.points == ((item, changed), failure)
    assert (found.title, found.axes) == ("asked" if changed else "given", ("axis",))
    assert found.kept == 7
