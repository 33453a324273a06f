"""The command line as users meet it: what it prints, its exit codes, and what it leaves behind when something fails."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import subprocess
import sys
import time

import in_process
import pytest
import typer

from fegear.base.errors import lacks_memory
from fegear.cli import _NO_MEMORY, COMMANDS, program

CASE = """
title = "One gear"
results = ["geometry"]
[gear.a]
teeth = 28
module = "3.175 mm"
bore_radius = "20 mm"
[gear.b]
teeth = 35
module = "3.175 mm"
[pair.I]
driver = "a"
driven = "b"
[effects]
friction = true
"""


def fegear(*arguments: object, cwd, program: str = "") -> subprocess.CompletedProcess:
    if not program:
        return in_process.fegear(*arguments, cwd=cwd)
    command = [sys.executable, "-c", program, *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, timeout=120)


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "one.toml"
    path.write_text(CASE)
    return path


def test_run_writes_what_it_says(case, tmp_path):
    done = fegear("run", case, cwd=tmp_path)
    assert (done.returncode, done.stderr.count("\n")) == (0, 2)
    assert "[1/2] Geometry" in done.stderr
    assert "I.contact_ratio = 1.66232" in done.stdout
    out = tmp_path / "results" / "one"
    summary = json.loads((out / "summary.json").read_text())
    assert summary["results"]["I.centre_distance"]["value"] == pytest.approx(63 / 2 * 3.175)
    assert all((out / name).is_file() for name in summary["files"])


def test_plan_tells_what_and_why_and_what_not(case, tmp_path):
    done = fegear("plan", case, cwd=tmp_path)
    assert done.returncode == 0
    assert 'geometry: requested by results = ["geometry"]' in done.stdout
    assert re.search(
        r"^  - not requested: .*\bstiffness, .*\n( {4}.*\n)*  - not required by the requested results: ",
        done.stdout,
        re.MULTILINE,
    )
    assert "friction" in done.stdout.splitlines()[-1]
    assert re.search(r"^Estimated CPU time: about [\d.e-]+ s ", done.stdout, re.MULTILINE)
    done = fegear("plan", case, "--set", 'results=["stiffness"]', "--set", "accuracy.tolerance=1e-2", cwd=tmp_path)
    lines = done.stdout.splitlines()
    assert any("root_edge_length = " in line and "patch_half_width = 0.36" in line for line in lines)
    assert sum("     about " in line for line in lines) == 4
    assert not (tmp_path / "results").exists()


def test_set_changes_the_case(case, tmp_path):
    changes = ("--set", "gear.a.teeth=30", "--set", "gear.b.teeth=30")
    done = fegear("run", case, *changes, "--no-plots", "--out", "o", cwd=tmp_path)
    assert done.returncode == 0
    summary = json.loads((tmp_path / "o" / "summary.json").read_text())
    assert summary["results"]["I.centre_distance"]["value"] == pytest.approx(30 * 3.175)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("run", "none.toml"), 'case = "none.toml": does not exist'),
        (("run", "one.toml", "--set", "gear.a.teth=3"), "teeth"),
        (("run", "one.toml", "--set", "gear.a.module=3 N"), 'gear.a.module = "3 N": is not a length'),
        (("run", "one.toml", "--set", 'results=["stifness"]'), 'did you mean "stiffness"'),
        (("plan", "one.toml", "--set", "gear.a.bore_radius=90 mm"), "gear.a.bore_radius = 90 mm"),
        (("run", "one.toml", "--out", "one.toml"), "is a file"),
        (("run", "one.toml", "--out", "/proc/none/out"), '--out = "/proc/none/out": is not writable'),
        (("run", "one.toml", "--colour"), "No such option"),
    ],
)
def test_bad_input_is_one_sentence_and_exit_code_2(arguments, words, case, tmp_path):
    before = sorted(tmp_path.rglob("*"))
    done = fegear(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.dear
def test_export_writes_drawings_and_meshes(case, tmp_path):
    done = fegear("export", case, "--gear", "a", "--format", "dxf, msh", "--out", "o", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert {p.name for p in (tmp_path / "o").iterdir()} == {
        ".fegear-files.json",
        "a.msh",
        "a_gear_polyline.dxf",
        "a_gear_spline.dxf",
        "a_tooth_polyline.dxf",
        "a_tooth_spline.dxf",
    }
    for arguments, words in (
        (("--gear", "c"), "known here: a, b"),
        (("--format", "iges"), "is not a supported format"),
    ):
        done = fegear("export", case, *arguments, "--out", "new", cwd=tmp_path)
        assert (done.returncode, words in done.stderr, (tmp_path / "new").exists()) == (2, True, False)


@pytest.mark.dear
def test_an_interrupt_keeps_earlier_results_and_exits_with_130(case, tmp_path):
    assert fegear("run", case, "--no-plots", cwd=tmp_path).returncode == 0
    out = tmp_path / "results" / "one"
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    slow = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # background jobs ignore it
        "import time, fegear.results.gear.geometry as g\n"
        "g.interference = lambda *a: (print('working', flush=True), time.sleep(600))\n"
        "from fegear.cli import main; main()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", slow, "run", str(case), "--set", "gear.a.teeth=20"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "working\n"
    time.sleep(0.1)
    os.kill(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors == "fegear: interrupted; results of earlier runs are unchanged.\n"
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before
    assert [path.name for path in out.parent.iterdir()] == ["one"]


@pytest.mark.parametrize(
    "module",
    [
        "fegear.base.streams",
        "fegear.cli",
        "typer",
        "pydantic",
        "fegear.case.text_file",
        "fegear.engine.plan",
        "fegear.results.catalogue",
    ],
)
def test_ctrl_c_while_the_program_loads_is_one_line(module, case, tmp_path):
    program = (
        "import sys\n"
        "class Typed:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        f"        if name == {module!r}:\n"
        "            sys.meta_path.remove(self)\n"
        "            raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Typed())\n"
        "from fegear.__main__ import main\n"
        "main()"
    )
    done = fegear("run", case, "--out", "there", cwd=tmp_path, program=program)
    assert done.returncode == 130
    assert done.stderr == "fegear: interrupted; results of earlier runs are unchanged.\n"


@pytest.mark.dear
def test_ctrl_c_while_a_sweep_starts_its_processes_is_one_line(case, tmp_path):
    """Ctrl-C reaches every process of a terminal; those that were still loading ended in tracebacks of their own."""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(
        "import pathlib, sys, time\n"
        "if any('spawn_main' in word for word in sys.orig_argv):\n"
        f"    pathlib.Path({str(tmp_path / 'loading')!r}).touch()\n"
        "    time.sleep(600)\n"
    )
    # A background job of a shell without job control ignores SIGINT, and its children would inherit that.
    program = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from fegear.cli import main\nif __name__ == '__main__': main()"
    )
    options = ["--over", "gear.a.teeth=20:60:41", "--workers", "2", "--no-plots", "--no-cache"]
    path = os.pathsep.join([str(tmp_path / "site"), *filter(None, [os.environ.get("PYTHONPATH")])])
    process = subprocess.Popen(
        [sys.executable, "-c", program, "sweep", str(case), *options], env=os.environ | {"PYTHONPATH": path},
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    until = time.monotonic() + 60
    while not (tmp_path / "loading").exists() and time.monotonic() < until:
        time.sleep(0.01)
    time.sleep(0.2)  # the parent is past starting them
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors == "fegear: interrupted; started again, the sweep resumes where it stopped.\n"


@pytest.mark.dear
def test_a_terminal_gets_a_bar(case, tmp_path):
    import pty

    master, slave = pty.openpty()
    command = [sys.executable, "-c", "from fegear.cli import main; main()", "run", str(case), "--no-plots"]
    done = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=slave, check=True, timeout=60)
    os.close(slave)
    text = os.read(master, 65536).decode(errors="ignore")  # a slow machine redraws past the end of what is read
    os.close(master)
    assert "Geometry" in text
    assert "━" in text
    assert b"Wrote" in done.stdout


def test_a_command_is_read_alone_and_is_that_of_the_whole_program(capsys, monkeypatch):
    whole = typer.main.get_command(program())
    read, plain = [], typer.main.get_command_from_info
    monkeypatch.setattr(
        typer.main, "get_command_from_info", lambda command_info, **how: read.append(0) or plain(command_info, **how)
    )
    assert len(whole.commands) == len(COMMANDS)
    for name in whole.commands:
        whole([name, "--help"], prog_name="fegear", standalone_mode=False)
        expected = capsys.readouterr().out
        assert "--help" in expected
        program([name, "--help"])([name, "--help"], prog_name="fegear", standalone_mode=False)
        assert capsys.readouterr().out == expected
    assert len(read) == len(COMMANDS)  # one each


def test_version(tmp_path):
    import fegear as package

    assert fegear("--version", cwd=tmp_path).stdout == f"fegear {package.__version__}\n"


def test_the_program_loads_the_command_that_is_called_and_for_its_version_none():
    """Modules of all commands took a tenth of the time to start."""
    code = (
        "import sys; from fegear.cli import program; program(sys.argv[1:]);"
        "print(*sorted(name for name in sys.modules if name.startswith('fegear.commands.')))"
    )
    common = {"fegear.commands.arguments", "fegear.commands.terminal", "fegear.commands.help_texts"}

    def loaded(*words):
        return set(subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=True)
                   .stdout.split()) - common  # fmt: skip

    assert loaded("--version") == set()
    assert loaded("import", "model.rexs") == {"fegear.commands.import_model"}
    assert loaded("plan", "drive.toml") == {"fegear.commands.run"}
    assert loaded() == loaded("runn") == loaded("--help") == {f"fegear.commands.{home}" for _, home, _ in COMMANDS}


@pytest.mark.parametrize("command", ["run", "export", "effects", "cost", "compare", "sweep"])
def test_an_output_folder_without_a_name_is_refused(case, tmp_path, command):
    """`--out "$UNSET"` wrote into the folder that somebody stood in."""
    more = {"compare": [case], "sweep": ["--over", "gear.a.teeth=28,29"]}.get(command, [])
    done = fegear(command, case, *more, "--out", "", cwd=tmp_path)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert '--out = "": must not be empty' in done.stderr
    assert [one.name for one in tmp_path.iterdir()] == ["one.toml"]


@pytest.mark.dear
@pytest.mark.parametrize(
    "arguments", [("new", "x"), ("schema", "--out", "x"), ("run",), ("compare", "a.toml", "b.toml")]
)
def test_a_working_folder_that_was_deleted_is_one_sentence(case, tmp_path, arguments):
    gone = tmp_path / "gone"
    gone.mkdir()
    program = (
        "import os, shutil, sys\nfrom fegear.cli import main\n"
        f"os.chdir({str(gone)!r})\nshutil.rmtree({str(gone)!r})\nmain()\n"
    )
    done = fegear(*arguments, *([case] if arguments == ("run",) else []), cwd=tmp_path, program=program)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert not gone.exists()


def test_a_lack_of_memory_is_not_said_to_be_a_missing_library(case, tmp_path, monkeypatch):
    """`apt-get install ...` was the advice where gmsh could not be mapped into what memory there was."""
    said = "libgmsh.so: failed to map segment from shared object"
    real = __import__

    def without_room(name, *rest, **more):
        if name == "gmsh":
            raise OSError(said)
        return real(name, *rest, **more)

    monkeypatch.setattr("builtins.__import__", without_room)
    done = fegear("run", case, "--results", "stiffness", "-q", "--no-plots", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, f"fegear: {_NO_MEMORY}\n")
    assert [one.name for one in tmp_path.iterdir()] == ["one.toml"]
    monkeypatch.undo()
    assert lacks_memory(MemoryError())
    assert lacks_memory(OSError(errno.ENOMEM, ""))
    assert not lacks_memory(OSError("libGLU.so.1: cannot open shared object file"))
    assert not lacks_memory(ImportError("libgomp.so: cannot allocate memory in static TLS block"))
