"""Commands beside `run`: names that no file can have, files that are none, links, two at once, and Ctrl-C."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from in_process import fegear

CASE = """
results = ["geometry"]
[gear."Räd"]
teeth = 20
module = "3 mm"
[gear."齿轮"]
teeth = 23
module = "3 mm"
[pair."Ζεῦγος"]
driver = "Räd"
driven = "齿轮"
"""
COMMANDS = (
    ("check",), ("migrate",), ("import",), ("import", "--force", "--out", "o.toml"), ("export", "--out", "ex"),
    ("export", "--format", "fmu", "--out", "ex"), ("export", "--format", "rexs", "--out", "ex"),
)  # fmt: skip
HOSTILE = {
    "long": "n" * 3000, "newline": "a\nb", "empty": "", "folder": "folder.toml", "pipe": "pipe.toml",
    "link": "link.toml", "bytes": "bytes.toml", "latin": "latin.toml", "deep": "deep.toml", "device": "/dev/zero",
}  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "folder.toml").mkdir()
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "link.toml").symlink_to("nowhere.toml")
    (tmp_path / "bytes.toml").write_bytes(bytes(range(256)))
    (tmp_path / "latin.toml").write_bytes(CASE.encode("utf-8").replace("ä".encode(), b"\xe4"))
    (tmp_path / "deep.toml").write_text("a = " + "[" * 3000)
    return tmp_path


@pytest.mark.parametrize("name", HOSTILE)
def test_what_is_no_case_is_refused_by_every_command_in_a_sentence(folder, name):
    """A name of 3,000 characters was a traceback of `import`, `export` and `compare`."""
    before = sorted(folder.rglob("*"))
    for command in (*COMMANDS, ("compare", HOSTILE[name])):
        done = fegear(*command, HOSTILE[name], cwd=folder)
        assert (done.returncode, done.stdout) == (2, ""), command
        assert "Traceback" not in done.stderr
        assert len(done.stderr) < 1200
        assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize("arguments", [("--positions", "9" * 20), ("--positions", "0"), ("--positions", "nan")])
def test_positions_that_no_check_has_are_refused(tmp_path, arguments):
    """Twenty nines were a traceback of numpy."""
    (tmp_path / "case.toml").write_text(CASE, "utf-8")
    done = fegear("check", "case.toml", *arguments, cwd=tmp_path)
    assert (done.returncode, "--positions" in done.stderr, "Traceback" in done.stderr) == (2, True, False)


@pytest.mark.parametrize("row", ["nothing", "", "a\nb", "x" * 3000, "--against="])
def test_rows_that_are_none_are_refused(tmp_path, row):
    done = fegear("verify", row, cwd=tmp_path)
    assert (done.returncode, done.stdout, "Traceback" in done.stderr) == (2, "", False)
    assert len(done.stderr) < 1200


def test_migrate_follows_no_link_to_where_the_old_case_is_kept(tmp_path):
    """A link of that name that leads nowhere yet was written through."""
    old = f"{CASE}[effects]\noff_line_of_action = true\n"
    (tmp_path / "case.toml").write_text(old, "utf-8")
    (tmp_path / "case.toml.old").symlink_to("elsewhere")
    done = fegear("migrate", "case.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "already exists" in done.stderr
    assert (tmp_path / "case.toml").read_text("utf-8") == old
    assert not (tmp_path / "elsewhere").exists()


@pytest.mark.dear
def test_drawings_of_names_in_any_script_stay_in_their_folder(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, "utf-8")
    (tmp_path / "mine").mkdir()
    (tmp_path / "ex").symlink_to("mine")
    assert fegear("export", "case.toml", "--format", "dxf", "--out", "ex", cwd=tmp_path).returncode == 0
    assert sorted(one.name for one in tmp_path.iterdir()) == ["case.toml", "ex", "mine"]
    assert len(list((tmp_path / "mine").glob("*.dxf"))) == 8
    assert (tmp_path / "ex").is_symlink()


SLOW = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # background jobs ignore it
    "import time, fegear.results.gear.geometry as g\n"
    "g.interference = lambda *a: (print('working', flush=True), time.sleep(600))\n"
    "from fegear.cli import main; main()"
)


def test_a_second_run_into_a_folder_is_refused_and_ctrl_c_of_the_first_frees_it(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, "utf-8")
    run = ("run", "case.toml", "--no-plots", "-q", "--out", "out")
    assert fegear(*run, cwd=tmp_path).returncode == 0
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with subprocess.Popen(
        [sys.executable, "-c", SLOW, *run], cwd=tmp_path, env=environment,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as first:  # fmt: skip
        assert first.stdout.readline() == "working\n"
        for command in (run, ("export", "case.toml", "--format", "dxf", "--out", "out")):
            second = fegear(*command, cwd=tmp_path)
            assert second.returncode == 2
            assert f"another run (process {first.pid} on" in second.stderr
        first.send_signal(signal.SIGINT)
        assert first.wait(timeout=60) == 130
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before
    assert fegear(*run, cwd=tmp_path).returncode == 0


def test_the_page_on_security_names_the_command_that_opens_a_port():
    """It said that no port is opened."""
    root = Path(__file__).parents[2]
    text = (root / "SECURITY.md").read_text("utf-8")
    assert "`fegear open` listens on a port of 127.0.0.1" in text
    assert "No other command opens a port" in text
    binds = [path for path in (root / "fegear").rglob("*.py") if "127.0.0.1" in path.read_text("utf-8")]
    assert {path.parent.name for path in binds} == {"window"}
