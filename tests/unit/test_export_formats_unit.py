"""Formats of an export are rows: each has its function, what lists say of them is theirs, and solves are shared."""

from __future__ import annotations

import importlib.util
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import pytest
from in_process import fegear as command

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.output import export, export_formats
from fegear.output.export import export_gears, wanted_formats
from fegear.output.export_formats import FORMATS, Format, _called

DOCS = Path(__file__).resolve().parents[2] / "docs"
GEARS = {
    "p": {"teeth": 21, "module": "2 mm", "face_width": "10 mm", "bore_radius": "5 mm"},
    "w": {"teeth": 33, "module": "2 mm", "face_width": "10 mm", "bore_radius": "5 mm"},
}


def scene_of(**more):
    return build_scene({"results": ["geometry"], "gear": GEARS, "accuracy": {"tolerance": 0.1}, **more}, "c", Path())


def _teeth(request):
    path = request.folder / f"{request.name}.teeth"
    path.write_text(str(request.gear.teeth))
    return [path], [f"Gear {request.name}, TEETH: no flanks."]


@pytest.fixture
def teeth(monkeypatch):
    """A format more, by its row alone."""
    row = Format("plane mesh", "number of teeth", _teeth, seconds=lambda gear: 0.25 * gear.teeth)
    more = MappingProxyType({**FORMATS, "teeth": row})
    for module in (export_formats, export):
        monkeypatch.setattr(module, "FORMATS", more)


def test_a_format_is_its_row(teeth, tmp_path):
    said = []
    found = export_gears(scene_of(), tmp_path, (), "teeth", say=said.append)
    assert [(tmp_path / name).read_text() for name in found.files] == ["21", "33"]
    assert found.remarks == ("Gear p, TEETH: no flanks.", "Gear w, TEETH: no flanks.")
    assert said == [
        "Gear p, TEETH: about 5 s of CPU time for 21 teeth.",
        "Gear w, TEETH: about 8 s of CPU time for 33 teeth.",
    ]
    with pytest.raises(InputError, match='did you mean "teeth"'):
        wanted_formats("teeht")
    helical = {
        name: {"teeth": gear["teeth"], "normal_module": "2 mm", "helix_angle": "15 deg", "hand": hand,
               "face_width": "10 mm"}
        for (name, gear), hand in zip(GEARS.items(), ("right", "left"), strict=True)
    }  # fmt: skip
    with pytest.raises(
        InputError, match=r"--gear = p, w: must be spur gears for teeth \(plane meshes\); use dxf or step or relief"
    ):
        export_gears(scene_of(gear=helical), tmp_path, (), "teeth")


def test_every_row_finds_what_it_names_and_help_names_it(tmp_path):
    said = "".join(command("export", "--help", cwd=tmp_path).stdout.split())  # however its lines are broken
    for name, row in FORMATS.items():
        assert row.about
        assert row.files
        assert row.contents
        assert all(callable(_called(one)) for one in (row.write, row.needs, row.seconds) if one)
        assert name in said


def test_the_page_has_the_rows():
    spec = importlib.util.spec_from_file_location("format_rows", DOCS / "format_rows.py")
    format_rows = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(format_rows)
    page = format_rows.PAGE.read_text("utf-8")
    assert format_rows.page_with_formats(page) == page, "docs/how-to/export.md is old: python docs/format_rows.py"


def test_files_of_one_mesh_are_written_of_one_solution(tmp_path, monkeypatch):
    caches = []

    def made():
        caches.append(SolutionCache())
        return caches[-1]

    monkeypatch.setattr(export, "SolutionCache", made)
    found = export_gears(scene_of(), tmp_path, ["p"], "inp,msh,vtu")
    assert found.files == ("p.msh", "p.vtu", "p.inp")
    assert [cache.solutions.computed for cache in caches] == [1]


def test_what_is_not_installed_is_refused_before_anything_is_written(tmp_path, monkeypatch):
    def lacking():
        raise InputError("--format", "rexs", "needs a pen")

    more = MappingProxyType({**FORMATS, "rexs": replace(FORMATS["rexs"], needs=lacking)})
    monkeypatch.setattr(export, "FORMATS", more)
    with pytest.raises(InputError, match="needs a pen"):
        export_gears(scene_of(), tmp_path, (), "dxf,rexs")
    assert not list(tmp_path.iterdir())
