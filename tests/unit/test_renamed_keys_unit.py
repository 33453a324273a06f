"""Old names of a case are read as those of now, with a remark, and `fegear migrate` writes them anew; Python's warn."""

import importlib
import tomllib
import warnings

import pytest
from in_process import fegear

import fegear as top
from fegear.base.errors import InputError
from fegear.case import renamed
from fegear.case.reading import apply_override, build_scene, read_scene
from fegear.case.renamed import Renamed
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

OLD = """# A case with old names
results = [  # what is wanted
  "geometry",   # of the tooth
]

[gear.a]
teeth = 20   # from the drawing
size = "2 mm"

[gear.b]
teeth = 30
size = "2 mm"

[effects]
off_line_of_action = true
"""


@pytest.fixture
def old_names(monkeypatch):
    """As after a release that had called a module a size."""
    monkeypatch.setattr(renamed, "KEYS", (*renamed.KEYS, Renamed("gear.NAME.size", "gear.NAME.module", "0.9")))


@pytest.mark.usefixtures("old_names")
def test_old_names_are_read_with_a_remark_each(tmp_path):
    path = tmp_path / "old.toml"
    path.write_text(OLD)
    scene = read_scene(path, ["gear.b.size=3 mm"])
    assert [scene.gears[name].module for name in "ab"] == pytest.approx([2e-3, 3e-3])
    remarks = make_plan(scene, STAGES).remarks
    assert [sentence.partition(" was ")[0] for sentence in remarks] == [
        "effects.off_line_of_action", "gear.a.size",
    ]  # fmt: skip
    assert read_scene(path, ["gear.b.module=3 mm"]).gears == scene.gears
    assert all("fegear migrate" in sentence for sentence in remarks)


@pytest.mark.usefixtures("old_names")
def test_migrate_writes_the_names_of_now_and_leaves_the_rest(tmp_path):
    path = tmp_path / "old.toml"
    before = f"schema_version = 1\n{OLD}".replace('"geometry"', '"tooth-loss"')
    path.write_text(before)
    assert fegear("migrate", "old.toml", "--dry-run", cwd=tmp_path).returncode == 0
    assert path.read_text() == before
    done = fegear("migrate", "old.toml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    text = path.read_text()
    assert (tmp_path / "old.toml.old").read_text() == before
    for kept in (
        "# A case with old names",
        "[  # what is wanted",
        '"gear-mesh-power-loss",   # of the tooth',
        "# from the drawing",
    ):
        assert kept in text
    now = tomllib.loads(text)
    assert now == {
        "schema_version": renamed.SCHEMA_VERSION, "results": ["gear-mesh-power-loss"],
        "gear": {"a": {"teeth": 20, "module": "2 mm"}, "b": {"teeth": 30, "module": "2 mm"}}, "effects": {},
    }  # fmt: skip
    assert build_scene(now, "old", tmp_path).renamed == ()
    assert "is up to date." in fegear("migrate", "old.toml", cwd=tmp_path).stdout


@pytest.mark.usefixtures("old_names")
def test_a_key_by_both_names_is_refused(tmp_path):
    document = tomllib.loads(OLD)
    document["gear"]["b"]["module"] = "2 mm"
    with pytest.raises(InputError, match=r"gear\.b\.size.*old name of gear\.b\.module"):
        build_scene(document, "old", tmp_path)


def test_migrate_replaces_no_file_that_it_did_not_write(tmp_path):
    (tmp_path / "old.toml").write_text('results = ["geometry"]\ngear = { a = { teeth = 20, module = "2 mm" } }\n'
                                       "effects.off_line_of_action = false\n")  # fmt: skip
    (tmp_path / "old.toml.old").write_text("mine")
    done = fegear("migrate", "old.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "old.toml.old" in done.stderr
    assert (tmp_path / "old.toml.old").read_text() == "mine"


def test_a_case_of_a_later_form_is_refused(tmp_path):
    document = {"schema_version": renamed.SCHEMA_VERSION + 1, "results": ["geometry"]}
    with pytest.raises(
        InputError, match="was written for a newer version of fegear \\(this version supports schema_version up to"
    ):
        build_scene(document, "late", tmp_path)


def test_a_key_that_was_taken_out_is_not_set_anew():
    with pytest.raises(InputError, match="unknown key"):
        apply_override({"effects": {}}, "effects.off_line_of_action=true")


def test_an_old_name_of_python_is_that_of_now_and_warns_where_it_is_used(monkeypatch):
    monkeypatch.setitem(top._RENAMED, "loads_of_teeth", ("load_sharing", "0.9"))
    sentence = r"fegear\.loads_of_teeth was renamed fegear\.load_sharing in 0\.9"
    with pytest.warns(DeprecationWarning, match=sentence) as said:
        assert top.loads_of_teeth is top.load_sharing
    assert [one.filename for one in said] == [__file__]
    with pytest.warns(DeprecationWarning, match=sentence):
        from fegear import loads_of_teeth  # noqa: F401
    assert "loads_of_teeth" not in dir(top)  # neither offered nor kept: every use warns


def test_names_of_python_that_are_listed_as_old_lead_to_one_that_there_is():
    """One step, no chains: what a name was called three releases ago leads to that of now."""
    assert not set(top._RENAMED) & set(top._HOMES)
    assert {new for new, _ in top._RENAMED.values()} <= set(top._HOMES)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name, home in top._HOMES.items():
            assert getattr(top, name) is getattr(importlib.import_module(f"fegear.{home}"), name)
