"""The house is layered: data flow one way, each heavy library has one door, `import fegear` is light."""

from __future__ import annotations

import ast
import fnmatch
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

if "source_tree" not in sys.modules:  # once for all tests: it keeps what it has read
    _spec = importlib.util.spec_from_file_location("source_tree", Path(__file__).with_name("source_tree.py"))
    assert _spec is not None
    assert _spec.loader is not None
    sys.modules["source_tree"] = importlib.util.module_from_spec(_spec)
    _spec.loader.exec_module(sys.modules["source_tree"])
source_tree = sys.modules["source_tree"]

#: Layer of each package or top-level module; an import must go to a lower layer or stay in its own package.
LAYERS = {
    "fegear": 14,  # the top offers the workbench's names and loads them when they are used; __version__ is everyone's
    "base": 0,
    "geometry": 1,
    "formulas": 2,
    "fem": 2,
    "shafts": 2.5,
    "contact": 3,
    "atlas": 3.5,  # what contact asks of solved gears, interpolated
    "design": 4,
    "dynamics": 5,
    "case": 6,
    "exchange": 6.5,
    "engine": 7,
    "results": 8,
    "studies": 9,
    "output": 10,
    "verify": 10,
    "window": 11,
    "commands": 11.5,
    "workbench": 11,
    "cli": 12,
    "__main__": 13,
}

#: Where each heavy library may be imported.
DOORS = {
    "gmsh": ["fegear.fem.plane.gmsh_session"],
    "skfem": [
        "fegear.fem.forms",
        "fegear.fem.plane.curved_map",
        "fegear.fem.plane.elements",
        "fegear.fem.plane.scikit_fem_alone",
        "fegear.fem.plane.scikit_fem_solver",
        "fegear.fem.solid.scikit_fem_solver",
        "fegear.fem.revolved_body",
    ],
    "meshio": ["fegear.fem.plane.imported_mesh"],
    "pint": ["fegear.base.units"],
    "pydantic": ["fegear.case", "fegear.case.*"],
    "typer": ["fegear.cli", "fegear.commands.*"],
    "rich": ["fegear.output.progress_bar"],
    "dask": ["fegear.engine.cluster"],
    "distributed": ["fegear.engine.cluster"],
    "numba": ["fegear.dynamics.*", "fegear.contact.*"],
    "pyvista": ["fegear.output.*"],
    "vtk": [],
    "matplotlib": ["fegear.output.*"],
    "plotly": ["fegear.output.*"],
    "jinja2": ["fegear.output.report.page"],
    "ezdxf": ["fegear.output.*"],
    "pandas": ["fegear.engine.table"],
    "IPython": ["fegear.output.progress_bar", "fegear.workbench.plots"],  # there where a notebook runs
    "nicegui": ["fegear.window.*"],
    "tomlkit": ["fegear.case.changed_text"],
    "xarray": ["fegear.workbench.results"],  # a reader of what a run leaves behind
}

#: What `import fegear` may not load.
HEAVY = (
    "gmsh", "pyvista", "matplotlib", "dask", "skfem", "pint", "meshio", "plotly", "numba", "xarray", "scipy",
    "jinja2", "pandas", "IPython", "nicegui",
)  # fmt: skip


def _package(module: str) -> str:
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else "fegear"


def layer_faults(imports: list) -> list[str]:
    faults = []
    for one in imports:
        if one.imported.split(".")[0] != "fegear" or one.imported == "fegear":
            continue
        here, there = _package(one.importer), _package(one.imported)
        if here == there:
            continue
        if there not in LAYERS or here not in LAYERS:
            faults.append(f"{one}: not in the list of layers")
        elif LAYERS[there] >= LAYERS[here]:
            faults.append(f"{one}: layer {LAYERS[here]} must not import layer {LAYERS[there]}")
    return faults


def door_faults(imports: list) -> list[str]:
    faults = []
    for one in imports:
        library = one.imported.split(".")[0]
        doors = DOORS.get(library)
        if doors is None or one.typing_only:
            continue
        if not any(fnmatch.fnmatchcase(one.importer, door) for door in doors):
            faults.append(f"{one}: its door is {', '.join(doors) or 'nowhere'}")
    return faults


def cycles(edges: dict[str, set[str]]) -> list[list[str]]:
    """Elementary cycles found by depth-first search; empty when the graph is acyclic."""
    found: list[list[str]] = []
    state: dict[str, int] = {}

    def visit(node: str, path: list[str]) -> None:
        state[node] = 1
        for neighbour in sorted(edges.get(node, ())):
            if state.get(neighbour) == 1:
                found.append([*path[path.index(neighbour) :], neighbour])
            elif neighbour not in state:
                visit(neighbour, [*path, neighbour])
        state[node] = 2

    for node in sorted(edges):
        if node not in state:
            visit(node, [node])
    return found


@pytest.fixture(scope="module")
def imports() -> list:
    return source_tree.all_imports()


def test_no_module_imports_from_its_own_layer_or_above(imports):
    assert layer_faults(imports) == []


def test_every_heavy_library_is_imported_at_its_door_only(imports):
    assert door_faults(imports) == []


def test_there_are_no_import_cycles(imports):
    edges: dict[str, set[str]] = {}
    for one in imports:
        if one.imported.startswith("fegear") and not one.typing_only and one.imported != one.importer:
            edges.setdefault(one.importer, set()).add(one.imported)
    assert cycles(edges) == []


def test_results_know_no_pictures(imports):
    faults = [str(one) for one in imports if _package(one.imported) == "output" and _package(one.importer) != "output"]
    assert [
        fault for fault in faults if not fault.startswith(("fegear.commands.", "fegear.workbench.", "fegear.window."))
    ] == []


@pytest.mark.parametrize(
    ("importer", "source", "fault"),
    [
        ("fegear.geometry.external_tooth", "def f():\n    from fegear.fem import ring", "layer"),
        ("fegear.fem.plane.ring_closure", "import fegear.formulas.hertz", "layer"),
        (
            "fegear.engine.plan",
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from fegear import output",
            "layer",
        ),
        ("fegear.fem.plane.ring_closure", "import gmsh", "door"),
        ("fegear.contact.sharing", "def f():\n    import matplotlib.pyplot as plt", "door"),
        ("fegear.contact.sharing", "import importlib\nimportlib.import_module('pyvista')", "door"),
        ("fegear.geometry.external_tooth", "from .. import cli", "layer"),
    ],
)
def test_the_walk_finds_what_it_must_find(importer, source, fault):
    known = {"fegear.fem", "fegear.fem.plane.ring_closure", "fegear.formulas.hertz", "fegear.output", "fegear.cli"}
    found = source_tree.imports_of(importer, source, known, is_package=False)
    assert (layer_faults(found) if fault == "layer" else door_faults(found)) != []


def test_the_cycle_search_finds_a_cycle():
    assert cycles({"a": {"b"}, "b": {"c"}, "c": {"a"}}) == [["a", "b", "c", "a"]]


def test_importing_fegear_is_light_and_quick():
    probe = (
        "import sys, time; start = time.process_time(); import fegear; seconds = time.process_time() - start;"
        f"print(seconds, *[name for name in {HEAVY!r} if name in sys.modules])"
    )
    runs = [
        subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True).stdout.split()
        for _ in range(3)
    ]
    assert [run[1:] for run in runs] == [[], [], []]
    # The best of three: other work on the machine delays a run, nothing makes one faster than it is.
    assert min(float(run[0]) for run in runs) < 0.4


def test_the_command_line_starts_without_the_heavy_libraries():
    seen = f"print(*[name for name in {HEAVY!r} if name in sys.modules])"
    probe = f"import sys, fegear.cli, fegear.output.progress_bar; {seen}"
    run = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert run.stdout.split() == []


def test_a_plan_needs_none_of_the_mechanics_libraries():
    """What results could be asked for is known without loading what computes them: `fegear plan` stays quick."""
    late = ("scipy.", "fegear.contact.", "fegear.fem.", "fegear.formulas.")
    # What a case may ask of meshes, oils and cracks is declared there, with numpy and the standard library only.
    specs = ("fegear.fem.plane", "fegear.fem.plane.settings", "fegear.formulas.lubricant", "fegear.formulas.paris")
    probe = (
        "import sys, fegear.engine.run, fegear.results.catalogue; from fegear.case.reading import build_scene;"
        "build_scene({'results': ['geometry'], 'gear': {'a': {'teeth': 28, 'module': '1 mm'}}}, 'case', None);"
        f"print(*[name for name in sys.modules if name.startswith({late!r}) and name not in {specs!r}],"
        f"*[name for name in {HEAVY!r} if name in sys.modules and name not in ('pint', 'scipy')])"
    )
    run = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert run.stdout.split() == []


def test_a_plan_loads_no_result_that_it_does_not_compute():
    """Effects that nothing uses are answered from the catalogue, with the results that would use them."""
    probe = (
        "import sys; from fegear.case.reading import build_scene; from fegear.engine.plan import make_plan;"
        "from fegear.results.catalogue import STAGES;"
        "case = {'results': ['geometry'], 'gear': {'a': {'teeth': 28, 'module': '1 mm'}}, 'cost': {'gear': 'a'},"
        "'effects': {'friction': True, 'contact_loss': True, 'parametric': True}};"
        "plan = make_plan(build_scene(case, 'case', None), STAGES);"
        "print(len(plan.idle_effects), *[name for name in sys.modules if name.startswith('fegear.results.')])"
    )
    run = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    idle, *loaded = run.stdout.split()
    assert int(idle) == 3
    others = {name for name in loaded if not name.startswith("fegear.results.gear")}
    assert others == {"fegear.results.catalogue", "fegear.results.forecasts"}
    assert len(loaded) <= 7


def test_the_window_computes_and_draws_nothing_of_its_own(imports):
    """What it shows comes through the engine, the results and the output: no mechanics below the case, no plotting."""
    below = ("geometry", "formulas", "fem", "contact", "design", "dynamics")
    reached = [
        one
        for one in imports
        if _package(one.importer) == "window"
        and (_package(one.imported) in below or one.imported.startswith("fegear.case.built."))
    ]
    warmed = {
        "fegear.case.built.tooth_influence",
        "fegear.contact.plane.root_stress_history",
        "fegear.contact.plane.transmission_error",
        "fegear.design.relief_design",
        "fegear.fem.plane.table",
    }  # loaded before they are asked for
    assert [str(one) for one in reached if one.importer != "fegear.window.worker" or one.imported not in warmed] == []


def _reads_wanted_results(source: str) -> bool:
    """Whether it looks at ``case.results``, the list of what a case asks for."""
    return re.search(r"\.\s*results\b", source) is not None and any(
        isinstance(node, ast.Attribute) and node.attr == "results"
        and (node.value.attr if isinstance(node.value, ast.Attribute) else getattr(node.value, "id", "")) == "case"
        for node in ast.walk(ast.parse(source))
    )  # fmt: skip


def test_no_number_depends_on_the_list_of_wanted_results():
    """What is computed follows from the tasks that need it, and what these say of themselves: plans read the list."""
    assert _reads_wanted_results('if "relief" in scene.case.results: pass')
    assert not _reads_wanted_results("scene.case.pair")
    house = Path(__file__).resolve().parents[2] / "fegear"
    rooms = ("case", "results", "contact", "dynamics", "design", "fem", "window", "workbench")
    files = [path for room in rooms for path in (house / room).rglob("*.py")]
    assert len(files) > 200
    assert [path.name for path in files if _reads_wanted_results(path.read_text("utf-8"))] == []
