"""What other systems set up with says the same as pyproject.toml and setup.sh: recipe, container, workflows."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

import fegear
from fegear.verify.rows import ALL

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


def test_the_recipe_is_one_when_its_templates_are_filled():
    yaml, jinja2 = pytest.importorskip("yaml"), pytest.importorskip("jinja2")
    filled = jinja2.Environment(undefined=jinja2.StrictUndefined).from_string(text("packaging/conda/meta.yaml"))
    recipe = yaml.safe_load(filled.render(PYTHON="python"))
    assert recipe["package"] == {"name": PROJECT["name"], "version": fegear.__version__}
    assert recipe["build"]["noarch"] == "python"
    entry = [" = ".join(one) for one in PROJECT["scripts"].items()]
    assert recipe["build"]["entry_points"] == entry
    assert {one.split()[0] for one in recipe["requirements"]["host"]} == {"python", "pip", "hatchling"}
    assert re.fullmatch(r"[0-9a-f]{64}", recipe["source"]["sha256"])
    assert recipe["source"]["url"].endswith(f"/fegear-{fegear.__version__}.tar.gz")
    assert (ROOT / recipe["about"]["license_file"]).is_file()
    (verify,) = recipe["test"]["commands"]
    assert {word for word in verify.split() if word in {row.name for row in ALL}} == {
        "beams", "cones", "load-sharing-enumerated",
    }  # fmt: skip


def test_the_bare_root_runs_every_step_of_the_container():
    """It reads the file itself; what it copies where, it knows by heart."""
    steps = text("packaging/bare_root.sh")
    copied = re.findall(r"^COPY \. (\S+)$", text("packaging/Containerfile"), re.MULTILINE)
    assert copied == ["/opt/fegear/source"]
    assert "$bare/opt/fegear/source" in steps
    assert 'ENTRYPOINT ["/opt/fegear/venv/bin/fegear"]' in text("packaging/Containerfile")
    assert "FROM docker.io/library/debian:bookworm-slim" in text("packaging/Containerfile")
    assert " bookworm " in steps


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
