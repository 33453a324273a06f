"""Libraries that only some results need: named, refused before anything is computed, and not missed by the others."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import fegear
from fegear.base.errors import MissingLibraryError
from fegear.base.extras import EXTRAS
from fegear.case.reading import read_scene
from fegear.engine.extras import missing
from fegear.engine.plan import make_plan
from fegear.output.draw_space import offscreen_pyvista
from fegear.results.catalogue import STAGES

ROOT = Path(__file__).parents[2]
CASES = ROOT / "cases"
#: A case, the extras that it needs, of them those without which it is refused.
NEEDS = (
    ("pinion_and_wheel", (), ()),
    ("planet_and_ring", (), ()),
    ("lin_design_chart", ("motion",), ("motion",)),
    ("litvin_localised", ("space",), ()),
)


@pytest.fixture
def bare(monkeypatch):
    """Without the libraries of all extras."""
    for library, _ in EXTRAS.values():
        monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.setattr("fegear.engine.extras.absent", lambda _extra: True)


def test_extras_are_those_of_the_package():
    packages = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    offered, always = packages["optional-dependencies"], " ".join(packages["dependencies"])
    for extra, (library, _) in EXTRAS.items():
        assert any(line.startswith(library) for line in offered[extra])
        assert library not in always
    assert {entry.extra for entry in STAGES.entries} == {"", *EXTRAS}


@pytest.mark.parametrize(("name", "needed", "refused"), NEEDS)
def test_a_case_names_what_it_needs(bare, name, needed, refused):
    plan = make_plan(read_scene(CASES / f"{name}.toml"), STAGES)
    assert missing(plan) == needed
    assert missing(plan, plots=False) == refused


@pytest.mark.usefixtures("bare")
def test_what_cannot_be_computed_is_refused_before_anything_is():
    with pytest.raises(
        MissingLibraryError, match=r"numba is not installed\. Install it with: pip install 'fegear\[mot"
    ):
        fegear.run(CASES / "lin_design_chart.toml", progress=False)


@pytest.mark.usefixtures("bare")
def test_pictures_that_cannot_be_drawn_say_what_to_install():
    with pytest.raises(MissingLibraryError, match=r"pip install 'fegear\[space\]'"):
        offscreen_pyvista()


@pytest.mark.dear
def test_every_command_starts_without_them(tmp_path):
    """In a new process where importing any of them fails: help of all commands, a new case, its run with its report."""
    program = f"""
import sys
for name in {[library for library, _ in EXTRAS.values()] + ["vtk", "llvmlite", "nicegui", "dask", "pandas", "xarray"]}:
    sys.modules[name] = None
from fegear.cli import COMMANDS, program
app = program()
for command, _, _ in COMMANDS:
    app([command, "-h"], standalone_mode=False)
app(["new", "drive", "--teeth", "21", "53", "--module", "3mm", "--torque", "260 N m"], standalone_mode=False)
app(["run", "drive.toml"], standalone_mode=False)
from fegear.base.errors import FegearError
import fegear
for call in (
    lambda: app(["open", "--no-browser", "drive.toml"], standalone_mode=False),
    lambda: app(["sweep", "drive.toml", "--over", "gear.pinion.teeth=21,22", "--scheduler", "tcp://127.0.0.1:9"],
                standalone_mode=False),
    lambda: fegear.Results.to_pandas(found),
    lambda: found.to_xarray(),
    lambda: fegear.run({str(CASES / "lin_design_chart.toml")!r}, progress=False),
):
    try:
        found = fegear.run("drive.toml", results=["geometry"], progress=False)
        call()
    except FegearError as error:
        print("REFUSED", error)
    else:
        print("TAKEN")
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    assert (tmp_path / "results" / "drive" / "report.html").stat().st_size > 10_000
    assert list((tmp_path / "results" / "drive" / "plots").glob("*.png"))
    refused = [line for line in done.stdout.splitlines() if line.startswith(("REFUSED", "TAKEN"))]
    for line, extra in zip(refused, ("workbench", "distributed", "notebook", "notebook", "motion"), strict=True):
        assert f"pip install 'fegear[{extra}]'" in line


#: Libraries of each extra.
ALONE = {
    "motion": ("numba", "llvmlite"), "space": ("pyvista", "vtk"), "notebook": ("pandas", "xarray"),
    "workbench": ("nicegui",), "distributed": ("dask", "distributed"),
}  # fmt: skip


@pytest.mark.parametrize(
    "extra", [pytest.param(one, marks=pytest.mark.dear if one == "notebook" else pytest.mark.long) for one in ALONE]
)
def test_without_one_extra_alone_only_what_it_is_for_is_refused(extra, tmp_path):
    """In a new process that cannot import the libraries of this extra and has all others: the page's table by lines."""
    program = f"""
import math, sys
from pathlib import Path
for name in {ALONE[extra]}:
    sys.modules[name] = None
import fegear
from fegear.base.errors import FegearError
from fegear.case.reading import read_scene
from fegear.engine import cluster
from fegear.engine.executor import Executor, map_points
from fegear.engine.extras import require
from fegear.engine.plan import make_plan
from fegear.output.draw_space import offscreen_pyvista
from fegear.results.catalogue import STAGES
from fegear.window.server import serve
if __name__ == "__main__":
    cluster._PATIENCE = cluster._GRACE = 0.2
    document = {{"gear": {{"a": {{"teeth": 20, "module": "2 mm"}}}}, "results": ["geometry"]}}
    found = fegear.run(document, progress=False)
    for door, call in {{
        "motion": lambda: require(make_plan(read_scene(Path({str(CASES)!r}, "lin_design_chart.toml")), STAGES)),
        "space": offscreen_pyvista,
        "notebook": lambda: found.to_pandas(),
        "notebook, too": lambda: found.to_xarray(),
        **({{"workbench": lambda: serve(None, None, browser=False, say=print)}} if {extra == "workbench"} else {{}}),
        "distributed": lambda: map_points(math.sqrt, [4.0], Executor("tcp://127.0.0.1:9")),
    }}.items():
        try:
            call()
        except FegearError as error:
            named = "pip install 'fegear[" + door.partition(",")[0] in str(error)
            print("REFUSED" if named else "other", door)
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    refused = [line.split()[1].rstrip(",") for line in done.stdout.splitlines() if line.startswith("REFUSED")]
    assert refused == [extra] * (2 if extra == "notebook" else 1)


def test_the_page_has_a_line_for_every_extra():
    packages = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
    page = (ROOT / "docs" / "extras.md").read_text("utf-8")
    assert [extra for extra in packages if f"`fegear[{extra}]`" not in page] == []
