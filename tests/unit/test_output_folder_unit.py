"""An output folder is whole at any moment, and a run can be read back from any of its files."""

from __future__ import annotations

import csv
import json
import os
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from in_process import fegear

import fegear as fegear_package
from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.engine.outcome import Outcome
from fegear.engine.plan import Plan
from fegear.engine.run import Results, Silence, Timing
from fegear.engine.stage import Task
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.dataset import write_dataset
from fegear.output.folder import whole_or_nothing
from fegear.output.new_for_old import RECORD
from fegear.output.run_files import write_results
from fegear.output.summary import summary


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
        Value("peak", 12.345678901234e6, "MPa", 1e3, "maximum root stress"),
        Value("ratio", 1.638),
        Value("nothing", float("nan"), "mm"),
    )
    task = Task("demo", "a")
    outcome = Outcome(None, (table,), values, {"order": 2}, ("A remark.",))
    return Results(scene, Plan((), (), ()), {task: outcome}, {task: Timing(0.25)})


def test_the_summary_has_old_names_where_no_other_number_is_called_so(results):
    task = Task("demo", "a")
    values = (
        Value("I.unloaded_te_max", 1e-6, "um", 0.0),
        Value("II.wide_te_mean", 2e-6, "um"),
        Value("II.te_mean", 3e-6, "um"),
        Value("wide_of_no_owner", 4.0),
    )
    outcome = replace(results.outcomes[task], values=values)
    found = summary(replace(results, outcomes={task: outcome}), [], [])["results"]
    assert found["I.te_max"] == {**found["I.unloaded_te_max"], "now": "I.unloaded_te_max"}
    assert found["II.te_mean"] == {"value": pytest.approx(3.0), "unit": "um", "error": None}
    assert set(found) == {one.name for one in values} | {"I.te_max"}


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
        assert data["demo_a.count"].attrs == {"units": "1", "long_name": "count"}
        assert "units" not in data["demo_a.kind"].attrs


def test_the_dataset_follows_the_cf_conventions(tmp_path):
    scene = build_scene({"results": ["x"], "gear": {"a": {"teeth": 20, "module": "1 mm"}}}, "case", Path())
    te = Table(
        "te_I",
        (
            Column("x", np.array([-1.0, 0.0, 2.0]) * 1e-3, "mm", "position"),
            Column("te", np.array([1.0, np.nan, 3.0]) * 1e-6, "um", "transmission error"),
            Column("c_prev", np.array([1.0, 2.0, 3.0]) * 1e-9, "um.mm/N"),
            Column("c_next", np.array([1.0, 2.0, 3.0]) * 1e-9, "um.mm/N"),
            Column("te_error", np.array([0.1, 0.2, 0.3]) * 1e-6, "um", "estimated error of te"),
            Column("c_neighbour_error", np.array([0.1, 0.2, 0.3]), "", "estimated error of c_prev and c_next"),
            Column("angle", np.array([0.1, 0.2, 0.3]), "deg"),
        ),
    )
    back = Table("back_I", (Column("x", np.array([1.0, 0.0, 2.0])), Column("y", np.zeros(3))))
    outcome = Outcome(None, (te, back), (Value("I.te", 1e-6, "um", 1e-8), Value("n", 2.0)), {}, ("A remark.",))
    run = Results(scene, Plan((), (), ()), {Task("demo"): outcome}, {Task("demo"): Timing(0.25)})
    write_dataset(tmp_path / "results.nc", run)
    first = (tmp_path / "results.nc").read_bytes()
    write_dataset(tmp_path / "results.nc", run)
    assert (tmp_path / "results.nc").read_bytes() == first
    with xr.open_dataset(tmp_path / "results.nc") as data:
        assert data.attrs["Conventions"] == "CF-1.11"
        assert {"title", "source", "history"} <= set(data.attrs)
        assert data.attrs["comment"] == "A remark."
        assert data["te_I.te"].sel(te_I=1.8, method="nearest").item() == 3.0
        assert "back_I" not in data.indexes  # its first column does not rise throughout: a coordinate, but no index
        assert "back_I.x" in data.coords
        assert data["te_I.te"].attrs["ancillary_variables"] == "te_I.te_error"
        for name in ("c_prev", "c_next"):
            assert data[f"te_I.{name}"].attrs["ancillary_variables"] == "te_I.c_neighbour_error"
        assert "ancillary_variables" not in data["te_I.angle"].attrs
        assert data["te_I.angle"].attrs["units"] == "degree"
        assert data[data["I.te"].attrs["ancillary_variables"]].item() == pytest.approx(0.01)
        assert np.isnan(data["te_I.te"].encoding["_FillValue"])
        for variable in data.variables.values():
            assert variable.attrs["long_name"]
            assert variable.dtype.kind in "OSU" or variable.attrs["units"]


def test_units_are_those_that_the_conventions_read():
    """Spellings that UDUNITS 2.2.28 reads; it knows no ``deg``, and no unit that starts with a number."""
    from fegear.base.units import PER_SI
    from fegear.output.netcdf import UDUNITS

    known = {"mm", "um", "degree", "rad", "N", "N^2", "N.m", "s", "MPa", "GPa", "N/mm", "N/um", "um/N", "um.mm/N",
             "MPa.mm/N", "MPa/N", "Hz", "kHz", "rpm", "arcsec", "N/(mm.um)", "mm-1", "m/s", "m/s^2", "W", "kW", "h",
             "degC", "mPa.s", "K", "kg/mm", "kg", "kg.m^2", "N/(N.m)", "%", "um/m", "arcmin"}  # fmt: skip
    # It knows no roots either: one is the unit of a symbol in a list of factors, of no variable; stress intensity has
    # no other spelling, so such readers take it as it stands.
    known |= {"MPa^(1/2)", "MPa.m^(1/2)"}
    assert {UDUNITS.get(unit, unit) for unit in PER_SI} == known


def test_an_empty_table_can_be_written(results, tmp_path):
    empty = Table("none", (Column("x", np.array([]), "mm"),))
    run = Results(results.scene, results.plan, {Task("none"): Outcome(None, (empty,))}, {Task("none"): Timing(0.0)})
    write_results(run, tmp_path, Silence(), plots=False)
    assert (tmp_path / "tables" / "none.csv").read_text() == "x [mm]\n"
    with xr.open_dataset(tmp_path / "results.nc") as data:
        assert data.sizes["none"] == 0


NAMES = {"Greek": ("Τροχός", "ζ"), "Chinese": ("齿轮", "轮"), "umlauts": ("Räd", "Größe"), "signs": ("a/b", "c d,e"),
         "long": ("x" * 3000, "y"), "markup": ("<b>&", "'\"")}  # fmt: skip


@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES.keys())
def test_gears_and_pairs_may_be_called_anything_in_every_file(tmp_path, names):
    """They were computed to the end, and then lost in a UnicodeEncodeError of the dataset."""
    one, other = (json.dumps(name) for name in names)
    case = tmp_path / f"{names[1].replace('/', '_')}.toml"
    case.write_text(
        'results = ["geometry", "transmission-error"]\n'
        f'[gear.{one}]\nteeth = 28\nmodule = "3 mm"\nface_width = "9 mm"\n'
        f'[gear.{other}]\nteeth = 35\nmodule = "3 mm"\nface_width = "9 mm"\n[pair.{one}]\ndriver = {one}\n'
        f'driven = {other}\nload = "1 kN"\ncompliance = {{ source = "weber-banaschek" }}\n',
        encoding="utf-8",
    )
    done = fegear("run", case, "-q", "--no-plots", "--out", "out", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "")
    summary = json.loads((tmp_path / "out" / "summary.json").read_text("utf-8"))
    assert f"{names[0]}.te_mean" in summary["results"]
    with xr.open_dataset(tmp_path / "out" / "results.nc", engine="scipy") as data:
        real = json.loads(data.attrs.get("fegear_names", "{}"))
        written = {real.get(name, name): name for name in data.variables}
        assert all(name.isascii() for name in data.variables)
        assert {f"{names[0]}.te_mean", f"transmission_error_{names[0]}.te"} <= written.keys()
        te = written[f"transmission_error_{names[0]}.te"]
        assert data[te].coords[data[te].dims[0]].attrs["units"] == "mm"
        assert data[te].size > 10
    table = next((tmp_path / "out" / "tables").glob("transmission_error_[!h]*.csv"))
    assert names[0] in te or te == f"{table.stem}.te"  # one name for a table's file and its dimension
    frame = fegear_package.run(case).to_xarray()
    assert frame[f"{names[0]}.te_mean"].item() == summary["results"][f"{names[0]}.te_mean"]["value"]
    assert frame[f"transmission_error_{names[0]}.te"].dims == (f"transmission_error_{names[0]}",)
    if names[0] == "Räd":
        axis = f"gear.{names[0]}.profile_shift"
        done = fegear("sweep", case, "--over", f"{axis}=0,0.1", "--no-cache", "-q", "--no-plots", "--out", "swept",
                      cwd=tmp_path, points_here=True)  # fmt: skip
        assert done.returncode == 0
        with xr.open_dataset(tmp_path / "swept" / "sweep.nc", engine="scipy") as data:
            real = json.loads(data.attrs["fegear_names"])
            assert axis in {real.get(name, name) for name in data.dims}
            assert f"transmission_error_{names[0]}.te" in {real.get(name, name) for name in data.variables}
