"""Streams that are closed or full, and memory that ends: no traceback, no half a result, a code of their own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

CASE = """
results = ["geometry"]
[gear.a]
teeth = 28
module = "3 mm"
"""
FEGEAR = f'"{sys.executable}" -m fegear'


def shell(line: str, folder: Path) -> subprocess.CompletedProcess:
    return subprocess.run(["sh", "-c", line], check=False, cwd=folder, capture_output=True, text=True, timeout=120)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "one.toml").write_text(CASE)
    return tmp_path


@pytest.mark.dear("2>/dev/full")
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize(
    "streams", ["<&- >&- 2>&-", "2>/dev/full", *(pytest.param(one, marks=pytest.mark.long) for one in ("2>&-", ">&-"))]
)
def test_a_run_does_its_work_whatever_its_streams_are(streams, folder):
    done = shell(f"{FEGEAR} run one.toml --no-plots --out out {streams}", folder)
    assert done.returncode == 0
    assert "Traceback" not in done.stdout + done.stderr
    assert json.loads((folder / "out" / "summary.json").read_text())["version"]
    assert (folder / "out" / "tables" / "geometry.csv").read_text().count("\n") == 2
    assert not [path for path in folder.iterdir() if path.name not in ("one.toml", "out")]


@pytest.mark.dear
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_output_that_nobody_takes_ends_without_a_traceback(folder):
    full = shell(f"{FEGEAR} run one.toml --no-plots --out out >/dev/full", folder)
    assert full.returncode != 0
    assert "Traceback" not in full.stderr
    assert full.stderr.splitlines()[-1].startswith("fegear: cannot write (No space left on device)")
    assert (folder / "out" / "report.html").exists()
    gone = shell(f"{FEGEAR} results | head -1", folder)
    assert gone.stdout.count("\n") == 1
    assert gone.stderr == ""


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's")
@pytest.mark.parametrize("kilobytes", [300_000, pytest.param(150_000, marks=pytest.mark.long)])
def test_memory_that_ends_is_one_sentence_and_the_old_results_stay(kilobytes, folder):
    (folder / "out").mkdir()
    (folder / "out" / "mine.txt").write_text("mine")
    done = shell(
        f"ulimit -v {kilobytes}; {FEGEAR} run one.toml --results stiffness --set stiffness.gear=a --out out", folder
    )
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.startswith("fegear: ")
    assert (folder / "out" / "mine.txt").read_text() == "mine"
    assert sorted(path.name for path in folder.iterdir()) == ["one.toml", "out"]
