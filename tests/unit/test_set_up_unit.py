"""The scripts' set-up where something is missing, on machines made of stand-ins for the system's programs."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LIBRARIES = (
    "libGLU.so.1 libXcursor.so.1 libXft.so.2 libXinerama.so.1 libGL.so.1 libEGL.so.1 libXrender.so.1 libXfixes.so.3 "
    "libgomp.so.1"
)
#: The environment's Python: fegear can be imported once pip has succeeded.
PYTHON = """#!/bin/sh
here=${0%/*}
case "$*" in
*"import fegear"*) [ -e "$here/installed" ] ;;
*"pip install"*) SAYS && : >"$here/installed" ;;
*pytest*) echo "pytest $*" ;;
esac
"""
SYSTEM = """#!/bin/sh
if [ "$1 $2" = "-m venv" ]; then
    /bin/mkdir -p "$3/bin"
    : >"$3/pyvenv.cfg"
    /bin/cp "${0%/*}/environment" "$3/bin/python"
fi
"""


@pytest.fixture
def machine(tmp_path):
    """A machine with all libraries, neither CalculiX nor Chromium, and a user without rights; runs a script on it."""
    programs = tmp_path / "bin"
    programs.mkdir()
    stand_ins = {"ldconfig": f"echo {LIBRARIES}", "id": "echo 1000"}
    for name in ("dirname", "cksum", "cat", "grep", "tail", "rm", "ls", "tee", "awk"):
        stand_ins[name] = f'exec /usr/bin/{name} "$@"'
    for name, line in stand_ins.items():
        (programs / name).write_text(f"#!/bin/sh\n{line}\n")
    (programs / "python3").write_text(SYSTEM)

    def run(script: str, venv: Path, pip: str = "true") -> subprocess.CompletedProcess:
        (programs / "environment").write_text(PYTHON.replace("SAYS", f"{{ {pip}; }}"))
        for path in programs.iterdir():
            path.chmod(0o755)
        environment = {"PATH": str(programs), "FEGEAR_VENV": str(venv)}
        command = ["/bin/sh", str(ROOT / script)]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=60)

    return run


def test_without_rights_the_tests_run_without_calculix_and_chromium(machine, tmp_path):
    done = machine("test.sh", tmp_path / "venv")
    assert done.returncode == 0, done.stderr
    assert "Tests that need these are skipped" in done.stderr
    assert "sudo apt-get install calculix-ccx chromium" in done.stderr
    assert done.stdout.startswith("pytest ")


def test_a_failing_pip_ends_in_one_sentence(machine, tmp_path):
    wall = "for line in Traceback: 'ERROR: No matching distribution found for gmsh>=4' ''; do echo \"$line\"; done"
    done = machine("test.sh", tmp_path / "venv", f"{wall}; false")
    assert done.returncode != 0
    (said,) = [line for line in done.stderr.splitlines() if line.startswith("fegear:")]
    assert "could not be installed (No matching distribution found for gmsh>=4)" in said
    assert said.endswith(f"pip's own words are in {tmp_path / 'venv'}/pip.log")
    assert "Traceback" not in done.stderr + done.stdout
    assert "Traceback" in (tmp_path / "venv" / "pip.log").read_text()
    assert "Setting up" in machine("test.sh", tmp_path / "venv").stderr  # the next attempt is a whole one


def test_an_environment_whose_python_is_gone_is_made_again(machine, tmp_path):
    venv = tmp_path / "venv"
    assert machine("test.sh", venv).returncode == 0
    assert "Setting up" not in machine("test.sh", venv).stderr
    (venv / "bin" / "python").unlink()
    (venv / "bin" / "python").symlink_to(tmp_path / "gone" / "python3.11")
    (venv / "left").write_text("of the former Python")
    done = machine("test.sh", venv)
    assert done.returncode == 0, done.stderr
    assert "Setting up" in done.stderr
    assert not (venv / "left").exists()


def test_a_folder_that_is_no_environment_is_left_alone(machine, tmp_path):
    venv = tmp_path / "thesis"
    venv.mkdir()
    (venv / "chapter1.tex").write_text("dear")
    done = machine("test.sh", venv)
    assert done.returncode != 0
    assert "is no virtual environment" in done.stderr
    assert (venv / "chapter1.tex").read_text() == "dear"


@pytest.mark.dear("False")
@pytest.mark.parametrize("strict", [False, True])
def test_a_missing_program_skips_its_test_or_fails_it(strict, tmp_path):
    (tmp_path / "test_program.py").write_text("def test_it(program):\n    program('ccx')\n")
    options = ["-rs", "-p", "no:cacheprovider", "--rootdir", str(tmp_path), *(["--no-skips"] if strict else [])]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "conftest", *options, str(tmp_path)],
        env=os.environ | {"PATH": str(tmp_path), "PYTHONPATH": str(ROOT / "tests")},
        capture_output=True, text=True, check=False, cwd=tmp_path, timeout=60,
    )  # fmt: skip
    assert done.returncode == (1 if strict else 0), done.stdout + done.stderr
    assert "apt-get install calculix-ccx" in done.stdout
    assert ("1 failed" if strict else "1 skipped") in done.stdout


@pytest.mark.dear("wrong-()-does not have", "b-('--dear',)-2 passed")
@pytest.mark.parametrize(
    ("name", "options", "words"),
    [("b", (), "1 passed, 1 deselected"), ("b", ("--dear",), "2 passed"), ("wrong", (), "does not have")],
    ids=str,
)
def test_dear_parameters_are_left_to_ci_and_a_name_that_no_test_has_is_refused(name, options, words, tmp_path):
    text = (
        f"import pytest\n@pytest.mark.dear('{name}')\n@pytest.mark.parametrize('x', 'ab')\ndef test_it(x):\n    pass\n"
    )
    (tmp_path / "test_dear.py").write_text(text)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "conftest", "--rootdir", tmp_path, *options, tmp_path],
        env=os.environ | {"PYTHONPATH": str(ROOT / "tests")},
        capture_output=True, text=True, check=False, cwd=tmp_path, timeout=60,
    )  # fmt: skip
    assert words in done.stdout + done.stderr


def test_what_is_set_up_for_development_serves_tests_and_site(machine, tmp_path):
    script = tmp_path / "both.sh"
    calls = "".join(f'fegear_setup "$FEGEAR_VENV" {extra}\n' for extra in ("dev", "test", "docs"))
    script.write_text(f'root={ROOT}\n. "$root/setup.sh"\n{calls}')
    done = machine(script, tmp_path / "venv")
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("Setting up") == 1
    again = machine(script, tmp_path / "venv", pip="false")
    assert "Setting up" not in again.stderr


@pytest.fixture
def checked(tmp_path):
    """A tree of two kinds of tests with what must pass before a change counts; scripts print how they are called."""
    for path in ("tests/unit/test_a.py", "tests/unit/test_b.py", "tests/hard/test_c.py", "tests/helpers/no_test.py"):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).touch()
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci" / "run", tmp_path / ".ci" / "run")
    for name in ("docs.sh", "test.sh", ".ci/versions", ".venv-ci/bin/mypy", ".venv-ci/bin/python"):
        script = tmp_path / name
        script.parent.mkdir(parents=True, exist_ok=True)
        script.write_text(f'#!/bin/sh\necho {name} called: $*\ncase "$*" in *"$FAILS"*) exit 3 ;; esac\n')
        script.chmod(0o755)

    def run(*parts: str, fails: str = "nothing") -> subprocess.CompletedProcess:
        environment = os.environ | {"FAILS": fails}
        command = ["./run", *parts]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, cwd=tmp_path / ".ci", timeout=60
        )

    return run


def test_parts_of_what_must_pass_are_the_kinds_of_tests_and_what_else_there_is(checked):
    done = checked("no-such-part")
    assert done.returncode != 0
    (named,) = re.findall(r"there are: (.*)", done.stdout)
    parts = named.split()
    assert parts[:3] == ["site", "tests/hard", "tests/unit"]
    assert {"last-bit-1", "last-bit-2", "versions", "types", "wheel", "workflows"} == set(parts[3:])


def test_parts_of_what_must_pass_skip_no_test_and_say_how_they_ended(checked):
    done = checked("site", "tests/unit", "last-bit-2", "types")
    assert done.returncode == 0, done.stdout
    assert "docs.sh called:" in done.stdout
    assert "test.sh called: -n 0 -p no:cacheprovider --no-skips --dear tests/unit" in done.stdout
    assert "test.sh called: -n 0 -p no:cacheprovider --last-bit 2" in done.stdout
    assert len(re.findall(r"^== \S+: passed after \d+ s$", done.stdout, re.MULTILINE)) == 4


@pytest.mark.parametrize(("part", "fails"), [("tests/unit", "tests/unit"), ("last-bit-2", "bit 2"), ("wheel", "wheel")])
def test_a_part_that_fails_anywhere_on_its_way_fails_what_must_pass(checked, part, fails):
    done = checked("types", part, fails=fails)
    assert done.returncode != 0
    assert f"== {part}: FAILED" in done.stdout
    assert "== types: passed" in done.stdout


def test_the_set_up_says_what_is_fetched_and_how_much_it_has_been(machine, tmp_path):
    lines = (
        "Collecting numpy<2.5", "  Downloading numpy-2.4.1-cp311.whl.metadata (62 kB)",
        "Downloading numpy-2.4.1-cp311.whl (16.6 MB)", "Downloading idna-3.1-py3.whl (71 kB)",
        "Downloading gmsh-4.15.0-py2.py3.whl (38.4 MB)", "Installing collected packages: gmsh, numpy, idna",
    )  # fmt: skip
    said = "; ".join(f"echo '{line}'" for line in lines)
    done = machine("test.sh", tmp_path / "venv", said)
    assert done.returncode == 0, done.stderr
    assert "fetched numpy 2.4.1, 17 MB; 17 MB in all" in done.stderr
    assert "fetched gmsh 4.15.0, 38 MB; 55 MB in all" in done.stderr
    assert "unpacking 3 packages" in done.stderr
    assert "idna" not in done.stderr
