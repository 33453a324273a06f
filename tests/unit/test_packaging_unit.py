"""What other systems set up with says the same as pyproject.toml and setup.sh: recipe, container, workflows."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

import fegear

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
#: The same library under conda-forge's name.
CONDA = {"gmsh": "python-gmsh", "matplotlib": "matplotlib-base"}


def text(name: str) -> str:
    return (ROOT / name).read_text("utf-8")


def test_the_recipe_has_the_dependencies_with_their_bounds():
    recipe = text("packaging/conda/meta.yaml")
    asked = re.findall(r"^    - ([\w-]+) (\S+)$", recipe.partition("  run:\n")[2].partition("\ntest:")[0], re.MULTILINE)
    split = [re.fullmatch(r"([\w-]+)(.*)", line).groups() for line in PROJECT["dependencies"]]
    wanted = {(CONDA.get(name, name), bounds) for name, bounds in split}
    assert set(asked) == wanted | {("python", PROJECT["requires-python"])}
    assert f'version = "{fegear.__version__}"' in recipe


def test_the_container_has_the_system_libraries_of_the_set_up():
    pairs = re.findall(r"\blib\w+\.so\.\d:(\S+?)[;\s]", text("setup.sh"))
    assert len(pairs) >= 9
    assert set(pairs) <= set(text("packaging/Containerfile").split())


@pytest.mark.parametrize("name", sorted(path.name for path in (ROOT / ".github" / "workflows").glob("*.yml")))
def test_workflows_are_whole_and_call_scripts_that_are_there(name):
    yaml = pytest.importorskip("yaml")
    flow = yaml.safe_load(text(f".github/workflows/{name}"))
    assert flow["permissions"] == {"contents": "read"}
    for job in flow["jobs"].values():
        assert job["steps"]
        for step in job["steps"]:
            for script in re.findall(r"\./([\w.]+\.(?:sh|ps1))", step.get("run", "")):
                assert (ROOT / script).is_file()
            for case in re.findall(r"cases/\w+\.toml", step.get("run", "")):
                assert (ROOT / case).is_file()


def test_every_python_that_is_promised_is_tried():
    promised = {one.rpartition(" ")[2] for one in PROJECT["classifiers"] if re.search(r"Python :: 3\.\d+", one)}
    assert promised <= set(re.findall(r'"(3\.\d+)"', text(".github/workflows/tests.yml")))
