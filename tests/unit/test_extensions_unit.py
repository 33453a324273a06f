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
from fegear.engine.run import run_plan
from fegear.exchange.importers import IMPORTERS, Importer, importer_for
from fegear.output.export import export_gears
from fegear.output.export_formats import FORMATS, formats
from fegear.results.catalogue import STAGES

PAGE = Path(__file__).resolve().parents[2] / "docs" / "developers" / "own-result.md"
GEARS = {
    "p": {"teeth": 21, "module": "2 mm", "face_width": "10 mm", "bore_radius": "5 mm"},
    "w": {"teeth": 33, "module": "2 mm", "face_width": "10 mm", "bore_radius": "5 mm"},
}
CASE = {"results": ["masses"], "gear": GEARS, "pair": {"I": {"driver": "p", "driven": "w"}}}


def installed(folder: Path, project: str, source: str = "", module: str = "fegear_masses") -> None:
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
def masses(folder):
    project, source = re.findall(
        r"^```(?:toml|py)\n# [\w.]+\n(.*?)^```", PAGE.read_text("utf-8"), re.DOTALL | re.MULTILINE
    )
    installed(folder, project, source)
    return folder


def test_a_result_of_another_distribution_runs_as_one_of_its_own(masses):
    found = fegear.run(CASE, progress=False)
    each = [fegear.Gear(**gear).geometry.mass_properties.mass for gear in GEARS.values()]
    assert found.values["I.total_mass"].value == pytest.approx(sum(each), rel=1e-12)
    assert list(found.tables["masses_I"]["mass"]) == pytest.approx(each, rel=1e-12)
    both = fegear.run({**CASE, "results": ["geometry", "masses"]}, progress=False)
    assert both.values["I.total_mass"] == found.values["I.total_mass"]


def test_it_is_listed_with_the_others_and_nearest_to_what_is_misspelt(masses):
    said = command("results", cwd=masses).stdout
    assert "From other distributions:" in said
    assert "masses of the gears of a pair" in said
    assert '"masses"' in command("schema", cwd=masses).stdout
    scene = build_scene({**CASE, "results": ["massses"]}, "case", Path())
    with pytest.raises(InputError, match='did you mean "masses"'):
        make_plan(scene, STAGES)


def test_formats_and_importers_of_another_distribution(masses):
    scene = build_scene({**CASE, "results": ["geometry"]}, "case", Path())
    assert list(formats()) == [*FORMATS, "masses"]
    target = masses / "written"
    target.mkdir()
    found = export_gears(scene, target, ["w"], "masses,dxf")
    assert "masses.txt" in found.files
    assert (target / "masses.txt").read_text().startswith("w 0.")
    assert "Masses are those of the exact sections." in found.remarks
    model = masses / "drive.teeth"
    model.write_text("19 57")
    done = command("import", model, "--out", "drive.toml", cwd=masses)
    assert done.returncode == 0, done.stderr
    assert "teeth = 57" in (masses / "drive.toml").read_text()
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
        ('odd = "fegear_odd:STAGE"', "raise SystemExit(3)", "cannot be imported: SystemExit: 3"),
        ('odd = "fegear_odd:NOTHING"', "STAGE = 1", "cannot be imported: AttributeError"),
        ('odd = "fegear_odd:STAGE"', "STAGE = 1", "is a int; must be a fegear.engine.stage.Stage"),
        ('geometry = "fegear_odd:STAGE"', "STAGE = 1", "has a name that is already used"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_distribution_is_said_with_its_name(masses, point, source, rule):
    installed(masses, PROJECT.format(point), source, "fegear_odd")
    said = command("results", cwd=masses).stdout  # which lists all others
    assert rule in said
    assert "fegear-odd 2" in said
    assert "masses of the gears of a pair" in said
    if point.startswith("odd"):
        with pytest.raises(InputError, match=re.escape(rule)):
            planned("odd")
    planned("geometry")  # others are not held up
    planned("masses")


def planned(*results):
    scene = build_scene({**CASE, "results": list(results)}, "case", Path())
    return scene, make_plan(scene, STAGES)


def test_of_two_distributions_with_one_name_neither_is_taken(masses):
    installed(masses, PROJECT.format('masses = "fegear_odd:STAGE"'), "STAGE = 1", "fegear_odd")
    with pytest.raises(InputError, match="has the name of another one"):
        planned("masses")


ODD_STAGES = """
from dataclasses import dataclass, replace
from fegear.base.errors import InputError
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Task
from fegear.engine.value import Value
@dataclass(frozen=True)
class Asked:
    name: str
GOOD = Stage(subjects=lambda scene: tuple(scene.pairs), inputs=lambda scene, name: Asked(name),
             compute=lambda asked, upstream, work: 1.0, present=lambda data, asked: Outcome())
def fails(*args):
    return 1 / 0
def refuses(*args):
    raise InputError("pair.I", "1", "must be two")
"""


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ("", ""),
        *((f"{key}=fails", "ZeroDivisionError: division by zero (fegear_odd.py, line 13)") for key in (
            "subjects", "needs", "check", "inputs", "compute", "present")),
        ("compute=refuses", "pair.I = 1: must be two"),
        ("present=lambda data, asked: None", "present() must be of type Outcome, and is None"),
        ("present=lambda data, asked: Outcome(remarks=(3,))", "each of remarks must be of type str, and is 3"),
        ("present=lambda data, asked: Outcome(values=(Value('a', 1.0, 'no_unit'),))", "no_unit"),
        ("present=lambda data, asked: Outcome(values=2 * (Value('a', 1.0),))", 'two values are called "a"'),
        ("inputs=lambda scene, name: object()", "object has no content key"),
        ("subjects=lambda scene: [1]", "subjects must be of type tuple"),
        ("needs=lambda scene, name: (Task('nowhere', name),)", 'asks for "nowhere", which is not a stage'),
        ("needs=lambda scene, name: (Task('odd', name),)", "waits for itself"),
        ("requires=('relief',)", "each of requires must be of type Need"),
        ("title=None", "title must be of type str"),
    ],
)  # fmt: skip
def test_what_goes_wrong_in_a_result_of_another_distribution_is_a_sentence(folder, change, rule):
    installed(
        folder, PROJECT.format('odd = "fegear_odd:STAGE"'), f"{ODD_STAGES}STAGE = replace(GOOD, {change})", "fegear_odd"
    )
    if not rule:
        run_plan(*planned("odd"))
        return
    with pytest.raises(InputError, match=re.escape(rule)):
        run_plan(*planned("odd"))


WRONG_FORMATS = {
    "out": "is not a file in the folder of the export",
    "fails": "division by zero", "answerless": "cannot unpack", "idle": "wrote no file and no message",
    "words": "must answer a list of paths and one of sentences",
}  # fmt: skip


def test_files_outside_of_the_folder_of_an_export_and_formats_that_fail_are_refused(folder):
    source = (
        "from pathlib import Path\nfrom fegear.output.export_formats import Format\n"
        "OUT = Format('case', 'a file elsewhere', lambda request: ([Path(__file__)], []))\n"
        "FAILS = Format('case', 'fails', lambda request: 1 / 0)\n"
        "ANSWERLESS = Format('case', 'answers None', lambda request: None)\n"
        "IDLE = Format('case', 'writes nothing', lambda request: ([], []))\n"
        "WORDS = Format('case', 'a sentence that is none', lambda request: ([], [3]))\n"
    )
    project = '[project]\nname = "fegear-odd"\nversion = "2"\n[project.entry-points."fegear.formats"]\n'
    points = "".join(f'{one} = "fegear_odd:{one.upper()}"\n' for one in WRONG_FORMATS)
    installed(folder, project + points, source, "fegear_odd")
    scene = build_scene({**CASE, "results": ["geometry"]}, "case", Path())
    target = folder / "written"
    target.mkdir()
    for name, rule in WRONG_FORMATS.items():
        with pytest.raises(InputError, match=rule):
            export_gears(scene, target, ["w"], name)


READERS = {
    "fails": ("lambda path: 1 / 0", "division by zero"),
    "none": ("lambda path: None", "must answer the text of a case, and answered a NoneType"),
    "bytes": ("lambda path: b''", "answered a bytes"),
    "surrogate": ("lambda path: chr(0xd800)", "surrogates not allowed"),
    "no_toml": ("lambda path: 'a = = 1'", "invalid TOML"),
}


@pytest.mark.parametrize("kind", READERS)
def test_importers_that_fail_are_refused_in_a_sentence(folder, kind):
    read, rule = READERS[kind]
    source = f"from fegear.exchange.importers import Importer\nONE = Importer(('.odd',), 'odd', {read})\n"
    project = '[project]\nname = "fegear-odd"\nversion = "2"\n[project.entry-points."fegear.importers"]\n'
    installed(folder, f'{project}{kind} = "fegear_odd:ONE"\n', source, "fegear_odd")
    (folder / "model.odd").write_text("1")
    done = command("import", folder / "model.odd", "--out", "made.toml", cwd=folder)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert rule in done.stderr
    assert not (folder / "made.toml").exists()


def test_suffixes_that_are_a_text_are_refused():
    """A model.s was read by an importer of ".suf", for the one is a part of the other."""
    for suffixes in (".suf", ("suf",), (".SUF",)):
        with pytest.raises(ValueError, match="suffixes must be a tuple"):
            Importer(suffixes, "odd", str)
