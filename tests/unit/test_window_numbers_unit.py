"""Every number on the page is one that ``fegear run`` writes for the saved case, whatever was computed before."""

from __future__ import annotations

import base64
import csv
import json
import re
import threading
from importlib import resources
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import Silence, run_plan
from fegear.output.run_files import write_results
from fegear.results.catalogue import STAGES
from fegear.window.bench import Bench
from fegear.window.computing import whole
from fegear.window.job_queue import Asked, Compute, Export, Unwanted
from fegear.window.worker import Worker

if TYPE_CHECKING:
    from fegear.window.job_queue import Said

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.toml"))
PAIR = """results = ["load-sharing", "transmission-error", "root-stress-history"]
[gear.a]
teeth = 28
module = "3 mm"
face_width = "20 mm"
relief = { tip = { amount = "12 um", length = "2.5 mm" } }
[gear.b]
teeth = 41
module = "3 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "b"
load = "5 kN"
loads = ["2 kN", "7 kN"]
compliance = { source = "weber-banaschek" }
root_stress = { source = "iso-6336-3" }
[effects]
hertz = "load-dependent"
relief = true
"""
HELICAL = """results = ["tooth-contact"]
[gear.a]
teeth = 20
normal_module = "5 mm"
helix_angle = "30 deg"
hand = "left"
face_width = "40 mm"
[gear.b]
teeth = 40
normal_module = "5 mm"
helix_angle = "30 deg"
hand = "right"
face_width = "40 mm"
[pair.I]
driver = "a"
driven = "b"
misalignment = { shaft_angle = "3 arcmin" }
modification = { parabola = "0.002 / mm", crown = "10 um" }
[effects]
misalignment = true
[tooth_contact]
positions = 12
"""


class Wire:
    """Stands for the connection to the page: keeps what is said."""

    def __init__(self) -> None:
        self.said: list[Said] = []

    def send(self, said: Said) -> None:
        self.said.append(said)


def shown(worker: Worker, wire: Wire, asked: Asked, number: int, before: dict) -> dict:
    """What stands on the page for a case when it is at rest: contents by task, as pages put them together."""
    wire.said.clear()
    worker.answer(Compute(number, asked))
    page: dict = {}
    for one in wire.said:
        assert one.what != "refused", one.content
        if one.what == "found":
            page[one.content["task"]] = whole(one.content, before.get(one.content["task"]))
    return page


def of_the_run(folder: Path, text: str) -> tuple[Path, str, dict]:
    """The folder that ``fegear run`` writes for a saved case, its report, and the figures in it by key."""
    path = folder / "c.toml"
    path.write_text(text)
    scene = read_scene(path)
    target = folder / "run"
    target.mkdir()
    write_results(run_plan(scene, make_plan(scene, STAGES)), target, Silence(), plots=False)
    report = (target / "report.html").read_text()
    embedded = re.search(r"<script type='application/json' id='figures'>(.*?)</script>", report, re.DOTALL)
    return target, report, {one["key"]: one for one in json.loads(embedded[1])} if embedded else {}


def same(one: object, other: object) -> bool:
    """Whether two figures are the same; numbers but for round-off, which LAPACK's modes differ by from call to call."""
    if isinstance(one, dict) and isinstance(other, dict) and "bdata" in one and "bdata" in other:
        first, second = (np.frombuffer(base64.b64decode(a["bdata"]), a["dtype"]) for a in (one, other))
        size = np.abs(np.nan_to_num(second.astype(float))).max(initial=0.0)
        return first.shape == second.shape and np.allclose(first, second, rtol=1e-9, atol=1e-9 * size, equal_nan=True)
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return one == pytest.approx(other, rel=1e-9, abs=1e-9, nan_ok=True)
    return one == other


def cells(table: bytes) -> list[list[object]]:
    """The columns of a table, numbers in proportion to the largest of their column."""
    found: list[list[object]] = []
    for column in zip(*csv.reader(table.decode().splitlines()), strict=True):
        try:
            numbers = np.array([float(one) for one in column[1:]])
        except ValueError:
            found.append(list(column))
            continue
        size = np.abs(numbers[np.isfinite(numbers)]).max(initial=0.0) or 1.0
        found.append([column[0], *(numbers / size).tolist()])
    return found


def hold(tmp_path: Path, text: str, changes: list[tuple[str, str]], wire: Wire, worker: Worker) -> None:
    """Change a case on the page, back and forth, and hold what it shows at the end against the files of a run."""
    asked, page = Asked(text, "c", str(tmp_path)), {}
    for number, (old, new) in enumerate(changes, 1):
        assert old in text
        for moving in (True, False):
            other = asked._replace(text=text.replace(old, new), moving=moving)
            page = shown(worker, wire, other, 2 * number + moving, page)
    page = shown(worker, wire, asked, 100, page)
    run, report, figures = of_the_run(tmp_path, text)
    drawn = {}
    for content in page.values():
        rows = re.findall(r"<tr>.*?</tr>", content["values"], re.DOTALL)
        assert len(rows) >= content["values"].count("<code>")
        for row in rows:  # reports fold the later ones of many
            assert row in report, content["task"]
        drawn |= {one["key"]: one for one in content["figures"]}
    assert page
    for key, figure in drawn.items():
        assert same(json.loads(json.dumps(figure["data"])), figures[key]["data"]), key
        assert same(json.loads(json.dumps(figure["layout"])), figures[key]["layout"]), key
    for name, one in json.loads((run / "summary.json").read_text())["results"].items():
        assert "now" in one or any(name in content["values"] for content in page.values()), name
    worker.answer(Export(101, asked, "tables", str(tmp_path / "tables")))
    tables = {path.name: path.read_bytes() for path in (run / "tables").glob("*.csv")}
    exported = {path.name: path.read_bytes() for path in (tmp_path / "tables").glob("*.csv")}
    assert exported.keys() == tables.keys()
    for name, table in tables.items():
        assert exported[name] == table or same(cells(exported[name]), cells(table)), name


@pytest.fixture
def wire():
    return Wire()


@pytest.fixture
def worker(wire, tmp_path, monkeypatch):
    monkeypatch.setattr(Worker, "_pictures", lambda _worker, _results: None)  # drawn from the same, and slow
    return Worker(wire, tmp_path / "shapes")


@pytest.mark.dear
@pytest.mark.parametrize(
    ("text", "changes"),
    [
        (PAIR, [('load = "5 kN"', 'load = "6.5 kN"'), ('amount = "12 um"', 'amount = "20 um"')]),
        (HELICAL, [('"3 arcmin"', '"1 arcmin"')]),
    ],
    ids=["pair", "helical"],
)
def test_the_page_at_rest_has_the_numbers_of_the_run(tmp_path, text, changes, wire, worker):
    hold(tmp_path, text, changes, wire, worker)


@pytest.mark.long
@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_the_page_of_every_case_has_the_numbers_of_its_run(tmp_path, path, wire, worker):
    folder = tmp_path / "cases"
    folder.mkdir()
    for one in path.parent.iterdir():  # what a case names stands beside it
        if one.suffix != ".toml":
            (folder / one.name).symlink_to(one)
    hold(folder, path.read_text("utf-8"), [], wire, worker)


@pytest.mark.dear
def test_every_kind_of_export_writes_its_files(tmp_path, wire, worker):
    text = PAIR.replace(', "transmission-error", "root-stress-history"', "")
    endings = {"dxf": ".dxf", "relief": ".csv", "tables": ".csv"}
    for number, (what, ending) in enumerate(endings.items()):
        worker.answer(Export(number, Asked(text, "c", str(tmp_path)), what, str(tmp_path / what)))
        assert wire.said[-1].what == "exported", wire.said[-1].content
        assert any(one.suffix == ending for one in (tmp_path / what).iterdir())
    assert (tmp_path / "relief" / "a_k_chart.csv").is_file()
    none = text.replace('relief = { tip = { amount = "12 um", length = "2.5 mm" } }', "")
    worker.answer(Export(9, Asked(none, "c", str(tmp_path)), "relief", str(tmp_path / "none")))
    assert wire.said[-1].what == "refused"
    assert "has nothing to write: no gear has a relief of" in wire.said[-1].content["sentence"]
    assert not (tmp_path / "none").exists()


def test_a_picture_that_a_page_cannot_draw_gives_way_to_a_move_soon_after(wire, tmp_path, monkeypatch):
    """Half a second of drawing stood between the release of a point and the first answer to the next drag."""
    figure = SimpleNamespace(key="space", drawable_in_page=False)
    figure.made = lambda: figure
    results = SimpleNamespace(outcomes={"flanks": SimpleNamespace(figures=(figure,))})
    drawn = []
    monkeypatch.setattr("fegear.output.draw_png.draw_pictures", lambda one, _folder: drawn.append(one.key) or ())
    worker = Worker(wire, tmp_path / "shapes")
    worker._inbox.watch(lambda _job: True)
    soon = threading.Timer(0.2, worker._inbox.put, [Compute(2, Asked("", "c", "."))])
    soon.start()
    with pytest.raises(Unwanted):
        worker._pictures(results)
    assert drawn == []
    soon.join()
    worker._inbox.take()
    worker._inbox.watch(lambda _job: True)
    worker._pictures(results)  # at rest
    assert drawn == ["space"]


def test_what_the_page_moves_itself_comes_when_a_value_pauses(worker, wire, monkeypatch):
    """Outlines and reliefs took a tenth of every answer to a value that had moved on already."""
    relieved = Asked(PAIR.replace("12 um", "15 um"), "c", ".", moving=True, pictures=())
    worker.answer(Compute(1, relieved._replace(moving=False)))
    found = {}
    for number, next_one in ((2, Compute(3, relieved)), (4, None)):
        wire.said.clear()
        monkeypatch.setattr(worker._inbox, "wait", lambda _s, one=next_one: one and worker._inbox.put(one))
        worker.answer(Compute(number, relieved._replace(text=PAIR.replace("12 um", f"{number} um"))))
        found[number] = [one.what for one in wire.said]
        if next_one:
            worker._inbox.take()
    assert "hands" not in found[2]
    assert found[2].count("found") == found[4].count("found") > 1
    assert found[2][-1] == "dropped"
    assert found[4][-3:] == ["hands", "load_now", "done"]
    wire.said.clear()
    monkeypatch.setattr(worker._inbox, "wait", lambda _s: worker._inbox.put(Compute(6, relieved)))
    worker.answer(Compute(5, relieved._replace(text=PAIR.replace("12 um", "5 um"), sight=("load-sharing of p",))))
    assert [one.what for one in wire.said][-2:] == ["load_now", "dropped"]  # the map stands among results in sight


def test_progress_counts_the_tasks_of_the_case_and_not_the_changes_before_it(worker, wire):
    """The page said "9 of 7" of the ninth change: the number of the job stood in the place of the task's."""
    bench = Bench(None)
    told: list[tuple[str, dict]] = []
    bench.listen(lambda what, content: told.append((what, content)))
    worker.answer(
        Compute(9, Asked(PAIR.replace('results = ["load-sharing", ', 'results = ["load-sharing"] #'), "c", "."))
    )
    for said in wire.said:
        bench._hear(said)
    steps = [content for what, content in told if what == "begin"]
    assert [one["step"] for one in steps] == list(range(1, steps[0]["count"] + 1))
    assert {one["number"] for one in steps} == {9}
    words = (resources.files("fegear.window") / "window.js").read_text("utf-8")
    assert "step = `${number} of ${count}: ${title}`" in words
    assert "begin({ step: number, count, title, left })" in words
