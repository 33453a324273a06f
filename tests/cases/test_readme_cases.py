"""The README's first screen: its program prints its numbers, its commands and links exist."""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import in_process
import pytest

ROOT = Path(__file__).parents[2]
#: Pages that hooks of docs/ make; the finished site is searched for dead links when it is built.
MADE_PAGES = {"how-to/index.md", "theory/index.md", "sources/index.md", "readme.md", "changelog.md"}
MADE_PAGES |= {f"sources/{source.stem}.md" for source in (ROOT / "docs" / "sources").glob("*.toml")}
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(kind: str) -> list[str]:
    return re.findall(rf"```{kind}\n(.*?)```", README, re.DOTALL)


@pytest.mark.dear
def test_the_program_prints_what_the_readme_says(tmp_path):
    (program,), (printed,) = blocks("python"), blocks("text")
    assert len([line for line in program.splitlines() if line.strip()]) <= 12
    run = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    spec = importlib.util.spec_from_file_location("readme_snippets", ROOT / "docs" / "snippets.py")
    snippets = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = snippets
    spec.loader.exec_module(snippets)
    snippets.compare(printed, run.stdout)
    assert (tmp_path / "pictures" / "transmission_error_I.png").is_file()


def test_the_commands_are_there_and_set_themselves_up():
    commands, _ = blocks("sh")
    scripts = [line.split()[0] for line in commands.splitlines()]
    assert scripts == ["./run.sh", "./open.sh", "./test.sh", "./docs.sh"]
    for script in scripts:
        path = ROOT / script
        assert os.access(path, os.X_OK)
        subprocess.run(["sh", "-n", path], check=True)
        assert "fegear_setup" in path.read_text()
    assert (ROOT / commands.splitlines()[0].split()[1]).is_file()


def test_the_first_commands_write_a_case_that_is_one(tmp_path):
    _, commands = blocks("sh")
    activate, new, run = (line.split("  #")[0] for line in commands.splitlines())
    assert activate == ". .venv/bin/activate"
    looked = run.replace("run", "plan")  # what it computes is the tutorial's matter
    for line in (new, looked):
        program, *arguments = shlex.split(line)
        assert program == "fegear"
        done = in_process.fegear(*arguments, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drive.toml", "fegear.schema.json"]


def test_every_command_has_its_line_and_its_section(tmp_path):
    from fegear.cli import COMMANDS

    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    names = [command for command, _, _ in COMMANDS]
    assert re.findall(r"^\| `fegear (\w+)", README, re.MULTILINE) == names
    assert re.findall(r"^## `fegear (\w+)", page, re.MULTILINE) == names
    for name in names:
        section = page.split(f"## `fegear {name}")[1].split("\n## ")[0]
        told = in_process.fegear(name, "-h", cwd=tmp_path).stdout
        options = set(re.findall(r"^ +(?:-\w, )?(--[a-z-]+)", told, re.MULTILINE)) - {"--help", "--quiet", "--json"}
        assert {option for option in options if f"`{option}" not in section} == set(), name


def test_version_and_name_are_the_same_everywhere():
    import fegear

    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {fegear.__version__}\n" in citation
    assert f"## [{fegear.__version__}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"fegear-{fegear.__version__}-py3-none-any.whl" in README


def test_every_link_leads_somewhere():
    pages = [
        *sorted(ROOT.glob("*.md")),
        ROOT / "meshes" / "README.md",
        *sorted((ROOT / "docs").rglob("*.md")),
    ]
    for page in pages:
        for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8")):
            # What a page's own run makes is under results/, pictures that are taken for it under its name: the hooks of
            # docs/ refuse a link to what they do not make.
            made = link.startswith(("results/", f"{page.stem}_files/", "gallery/")) or link in MADE_PAGES
            if "://" not in link and not made:
                assert (page.parent / link).exists(), f"{page.name} links to {link}"


@pytest.mark.parametrize("missing", ["python3-venv", "libglu1-mesa"])
def test_without_rights_the_scripts_name_the_apt_get_line(missing, tmp_path):
    """A machine without the package and a user who may not install it, made of stand-ins for the system's programs."""
    programs = tmp_path / "bin"
    programs.mkdir()
    libraries = "libGLU.so.1 libXcursor.so.1 libXft.so.2 libXinerama.so.1 libGL.so.1 libEGL.so.1 libXrender.so.1"
    libraries += " libXfixes.so.3 libgomp.so.1"
    if missing == "libglu1-mesa":
        libraries = libraries.replace("libGLU.so.1", "")
    stand_ins = {
        "ldconfig": f"echo {libraries}",
        "id": "echo 1000",
        "python3": "exit 1" if missing == "python3-venv" else "exit 0",
        "dirname": 'exec /usr/bin/dirname "$@"',
    }
    for name, line in stand_ins.items():
        (programs / name).write_text(f"#!/bin/sh\n{line}\n")
        (programs / name).chmod(0o755)
    run = subprocess.run(
        ["/bin/sh", ROOT / "run.sh"],
        env={"PATH": f"{programs}", "FEGEAR_VENV": str(tmp_path / "venv")},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert run.returncode != 0
    assert f"sudo apt-get install {missing}" in run.stderr
    assert not (tmp_path / "venv").exists()


def test_the_case_file_page_s_example_is_a_case(tmp_path):
    import tomllib

    from fegear.case.reading import build_scene

    page = (ROOT / "docs" / "case-files.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    assert build_scene(tomllib.loads(example), "example", tmp_path).gears["a"].teeth == 28
