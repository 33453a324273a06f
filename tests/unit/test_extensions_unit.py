"""Results, formats and importers of other distributions: the one that a page shows, whole, and ones that are wrong."""

from __future__ import annotations

import re
import sys
import tomllib
from importlib import invalidate_caches
from pathlib import Path

import pytest
from in_process import fegear as command

import fegear
from fegear.base import extensions
from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.commands.schema import schema_text
from fegear.engine.plan import make_plan
from fegear.exchange.importers import IMPORTERS, importer_for
from fegear.output.export import export_gears
from fegear.output.formats import FORMATS, formats
from fegear.results.catalogue import STAGES

PAGE = Path(__file__).resolve().parents[2] / "docs" / "developers" / "own-result.md"
GEARS = {
    "p": {"teeth": 21, "module": "2 mm", "face_width": "10 mm", "bore_radius": "5 mm"},
    "w": {"teeth": 33, "module": "2 mm", "face_width": "10 mm", "bore_radius": "5 mm"},
}
CASE = {"results": ["weights"], "gear": GEARS, "pair": {"I": {"driver": "p", "driven": "w"}}}


def installed(folder: Path, project: str, source: str = "", module: str = "fegear_weights") -> None:
    """As pip leaves a distribution: its module, and what its project says, beside each other."""
    given = tomllib.loads(project)["project"]
    home = folder / f"{given['name'].replace('-', '_')}-{given['version']}.dist-info"
    home.mkdir(parents=True)
    (home / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {given['name']}\nVersion: {given['version']}\n")
    groups = (
        f"[{group}]\n" + "".join(f"{name} = {where}\n" for name, where in points.items())
        for group, points in given["entry-points"].items()
    )
    (home / "entry_points.txt").write_text("\n".join(groups))
    if source:
        (folder / f"{module}.py").write_text(source)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where distributions are looked for besides, until the test ends."""

    def forget():
        extensions._points.cache_clear()
        STAGES.__dict__.pop("with_added", None)
        schema_text.cache_clear()
        for name in [name for name in sys.modules if name.startswith("fegear_")]:
            del sys.modules[name]
        invalidate_caches()

    monkeypatch.syspath_prepend(str(tmp_path))
    forget()
    yield tmp_path
    forget()


@pytest.fixture
def weights(folder):
    project, source = re.findall(
        r"^```(?:toml|py)\n# [\w.]+\n(.*?)^```", PAGE.read_text("utf-8"), re.DOTALL | re.MULTILINE
    )
    installed(folder, project, source)
    return folder


def test_a_result_of_another_distribution_runs_as_one_of_its_own(weights):
    found = fegear.run(CASE, progress=False)
    each = [fegear.Gear(**gear).geometry.mass_properties.mass for gear in GEARS.values()]
    assert found.values["I.weight"].value == pytest.approx(sum(each), rel=1e-12)
    assert list(found.tables["weights_I"]["mass"]) == pytest.approx(each, rel=1e-12)
    both = fegear.run({**CASE, "results": ["geometry", "weights"]}, progress=False)
    assert both.values["I.weight"] == found.values["I.weight"]


def test_it_is_listed_with_the_others_and_nearest_to_what_is_misspelt(weights):
    said = command("results", cwd=weights).stdout
    assert "Of other distributions:" in said
    assert "what the gears of a pair weigh" in said
    assert '"weights"' in command("schema", cwd=weights).stdout
    scene = build_scene({**CASE, "results": ["weihgts"]}, "case", Path())
    with pytest.raises(InputError, match='the nearest known name is "weights"'):
        make_plan(scene, STAGES)


def test_formats_and_importers_of_another_distribution(weights):
    scene = build_scene({**CASE, "results": ["geometry"]}, "case", Path())
    assert list(formats()) == [*FORMATS, "weights"]
    target = weights / "written"
    target.mkdir()
    found = export_gears(scene, target, ["w"], "weights,dxf")
    assert "weights.txt" in found.files
    assert (target / "weights.txt").read_text().startswith("w 0.")
    assert "Weights are those of the exact sections." in found.remarks
    model = weights / "drive.teeth"
    model.write_text("19 57")
    done = command("import", model, "--out", "drive.toml", cwd=weights)
    assert done.returncode == 0, done.stderr
    assert "teeth = 57" in (weights / "drive.toml").read_text()
    with pytest.raises(InputError, match="must hold numbers of teeth"):
        importer_for(Path("x.TEETH"), None).case_of(PAGE, {"load_case": None})
    assert importer_for(Path("x.rexs"), None) is importer_for(model, "rexs") is IMPORTERS["rexs"]
    for option, value in (("--load-case", 2), ("--spectrum", True)):
        given = {option[2:].replace("-", "_"): value}
        with pytest.raises(InputError, match=f"{option} = .*is not known to models of this kind"):
            importer_for(model, None).case_of(model, given)
    with pytest.raises(InputError, match="choose from rexs, teeth"):
        importer_for(model, "kissoft")


def test_nothing_is_looked_for_where_fegear_knows_all_names(monkeypatch):
    monkeypatch.setattr(extensions, "_points", lambda group: pytest.fail(f"looked for {group}"))
    STAGES.__dict__.pop("with_added", None)
    make_plan(build_scene({**CASE, "results": ["geometry"]}, "case", Path()), STAGES)


PROJECT = '[project]\nname = "fegear-odd"\nversion = "2"\n[project.entry-points."fegear.results"]\n{}\n'


@pytest.mark.parametrize(
    ("point", "source", "rule"),
    [
        ('odd = "fegear_odd:STAGE"', "raise OSError('no licence')", "cannot be imported: OSError: no licence"),
        ('odd = "fegear_odd:NOTHING"', "STAGE = 1", "cannot be imported: AttributeError"),
        ('odd = "fegear_odd:STAGE"', "STAGE = 1", "is a int, and must be a fegear.engine.stage.Stage"),
        ('geometry = "fegear_odd:STAGE"', "STAGE = 1", "has a name that is taken"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_distribution_is_said_with_its_name(folder, point, source, rule):
    installed(folder, PROJECT.format(point), source, "fegear_odd")
    scene = build_scene({**CASE, "results": ["of-others"]}, "case", Path())
    with pytest.raises(InputError, match=re.escape(rule)) as refused:
        make_plan(scene, STAGES)
    assert "fegear-odd 2" in str(refused.value)
    make_plan(build_scene({**CASE, "results": ["geometry"]}, "case", Path()), STAGES)  # others are not held up


def test_files_outside_of_the_folder_of_an_export_are_refused(folder):
    source = (
        "from pathlib import Path\nfrom fegear.output.formats import Format\n"
        "OUT = Format('case', 'a file elsewhere', lambda request: ([Path(__file__)], []))\n"
    )
    project = '[project]\nname = "fegear-odd"\nversion = "2"\n[project.entry-points."fegear.formats"]\n'
    installed(folder, project + 'out = "fegear_odd:OUT"\n', source, "fegear_odd")
    scene = build_scene({**CASE, "results": ["geometry"]}, "case", Path())
    target = folder / "written"
    target.mkdir()
    with pytest.raises(InputError, match="is no file in the folder of the export"):
        export_gears(scene, target, ["w"], "out")
