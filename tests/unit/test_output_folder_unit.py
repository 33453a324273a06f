"""An output folder is whole at any moment, and a run can be read back from any of its files."""

from __future__ import annotations

import csv
import json
import os
import signal
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from fegear.case.reading import build_scene
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.plan import Plan
from fegear.engine.run import Results, Silence, Timing
from fegear.engine.stage import Task
from fegear.errors import InputError
from fegear.output.exchange import RECORD
from fegear.output.folder import whole_or_nothing
from fegear.output.write import write_results


def contents(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def fill(folder: Path, names: list[str], text: str) -> None:
    for name in names:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    (folder / "summary.json").write_text(json.dumps({"files": [*names, "summary.json"]}))


def test_files_appear_together_and_stale_ones_go(tmp_path):
    out = tmp_path / "deep" / "out"
    with whole_or_nothing(out) as scratch:
        fill(scratch, ["tables/a.csv", "plots/p.png"], "first")
        assert not out.exists()
    (out / "mine.txt").write_text("the user's own")
    with whole_or_nothing(out) as scratch:
        fill(scratch, ["tables/b.csv"], "second")
    assert set(contents(out)) == {"tables/b.csv", "summary.json", RECORD, "mine.txt"}
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["out"]


@pytest.mark.parametrize("error", [KeyboardInterrupt, InputError("a", 1, "is bad"), ZeroDivisionError])
def test_an_error_leaves_earlier_results_whole_and_no_traces(tmp_path, error):
    out = tmp_path / "out"
    with whole_or_nothing(out) as scratch:
        fill(scratch, ["tables/a.csv"], "first")
    before = contents(tmp_path)

    def interrupted(target):
        with whole_or_nothing(target) as scratch:
            fill(scratch, ["tables/a.csv"], "half")
            raise error

    for target in (out, tmp_path / "new" / "deeper" / "out"):
        with pytest.raises(BaseException):  # noqa: B017, PT011  (each of the three above)
            interrupted(target)
    assert contents(tmp_path) == before
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_an_interrupt_while_files_are_moved_waits(tmp_path, monkeypatch):
    out = tmp_path / "out"
    out.mkdir()
    replace, before = Path.replace, signal.getsignal(signal.SIGINT)

    def interrupting(self, target):
        os.kill(os.getpid(), signal.SIGINT)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", interrupting)
    with whole_or_nothing(out) as scratch:
        fill(scratch, ["a.csv", "b.csv"], "first")
    assert set(contents(out)) == {"a.csv", "b.csv", "summary.json", RECORD}
    assert signal.getsignal(signal.SIGINT) is before


def test_folders_that_cannot_be_written_are_refused(tmp_path, monkeypatch):
    blocker = tmp_path / "file"
    blocker.write_text("")
    for target in (blocker, blocker / "out"):
        with pytest.raises(InputError, match=r"file|written") as refusal, whole_or_nothing(target):
            pass
        assert refusal.value.key == "--out"
    read_only = tmp_path / "read_only"
    read_only.mkdir()
    # The superuser may write anywhere, so the system's answer is set instead of the folder's mode.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(InputError, match="read-only"), whole_or_nothing(read_only):
        pass
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "read_only"]


@pytest.fixture
def results() -> Results:
    scene = build_scene(
        {"title": "Größe", "results": ["x"], "gear": {"a": {"teeth": 20, "module": "1 mm"}}}, "case", Path()
    )
    table = Table(
        "demo_a",
        (
            Column("radius", np.array([1.0, 2.0, np.pi]) * 1e-3, "mm", "load position"),
            Column("count", np.array([1, 2, 3])),
            Column("kind", np.array(["flank", "Fuß", ""])),
        ),
    )
    values = (
        Value("peak", 12.345678901234e6, "MPa", 1e3, "largest root stress"),
        Value("ratio", 1.638),
        Value("nothing", float("nan"), "mm"),
    )
    task = Task("demo", "a")
    outcome = Outcome(None, (table,), values, {"order": 2}, ("A remark.",))
    return Results(scene, Plan((), (), ()), {task: outcome}, {task: Timing(0.25)})


def test_every_file_holds_the_same_numbers(results, tmp_path):
    write_results(results, tmp_path, Silence(), plots=False)
    with (tmp_path / "tables" / "demo_a.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    assert rows[0] == ["radius [mm]", "count", "kind"]
    assert float(rows[3][0]) == pytest.approx(np.pi, rel=1e-11)
    assert rows[2][1:] == ["2", "Fuß"]

    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["results"]["peak"] == {"value": 12.345678901234, "unit": "MPa", "error": pytest.approx(1e-3)}
    assert summary["results"]["ratio"]["error"] is None
    assert summary["results"]["nothing"]["value"] is None
    assert summary["timings"] == {"demo of a": 0.25, "total": 0.25}
    assert summary["files"] == ["report.html", "results.nc", "tables/demo_a.csv", "summary.json"]
    assert summary["settings"]["stages"] == {"demo of a": {"order": 2}}

    with xr.open_dataset(tmp_path / "results.nc") as data:
        assert data["demo_a.radius"].values == pytest.approx([1.0, 2.0, np.pi], rel=1e-15)
        assert data["demo_a.radius"].attrs == {"units": "mm", "long_name": "load position"}
        assert "demo_a.radius" in data.coords
        assert list(data["demo_a.kind"].values.astype(str)) == ["flank", "Fuß", ""]
        assert data["demo_a.count"].values.tolist() == [1, 2, 3]
        assert float(data["peak"]) == pytest.approx(12.345678901234, rel=1e-15)
        assert data["peak"].attrs["error"] == pytest.approx(1e-3)
        assert data.attrs["title"] == "Größe"


def test_an_empty_table_can_be_written(results, tmp_path):
    empty = Table("none", (Column("x", np.array([]), "mm"),))
    run = Results(results.scene, results.plan, {Task("none"): Outcome(None, (empty,))}, {Task("none"): Timing(0.0)})
    write_results(run, tmp_path, Silence(), plots=False)
    assert (tmp_path / "tables" / "none.csv").read_text() == "x [mm]\n"
    with xr.open_dataset(tmp_path / "results.nc") as data:
        assert data.sizes["none"] == 0
