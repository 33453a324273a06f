"""Doors through which the program is entered: applied designs, racks in Python, the window's jobs, forecasts."""

import contextlib
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
import typer

from fegear.base.errors import InputError
from fegear.cli import program
from fegear.contact.wide import over_revolution, stress_over_revolution
from fegear.results.gear import stiffness_study
from fegear.results.pair import mesh_stiffness_revolution
from fegear.results.rack import solid_rack
from fegear.workbench import rack as racks
from fegear.workbench.gear import Gear
from fegear.workbench.rack import Rack


# ---- fegear apply ----------------------------------------------------------------------------------------------------
@pytest.fixture
def applied(monkeypatch, tmp_path):
    """Call the command on made-up results: what was asked for, and what was written where."""
    asked, written = [], []
    side = SimpleNamespace(document="document", tables="tables")
    file = SimpleNamespace(text="text", written=lambda text: f"bytes of {text}")
    case = tmp_path / "case.toml"
    monkeypatch.setattr("fegear.output.run_folder.read_side", lambda path, key: side if key == "RESULTS" else None)
    monkeypatch.setattr(
        "fegear.case.text_file.read_file", lambda path, key: file if (path, key) == (case, "--case") else None
    )
    monkeypatch.setattr(
        "fegear.case.text_file.write_file", lambda path, content, key: written.append((path, content, key))
    )
    found = SimpleNamespace(text="changed", said="what was done.")
    monkeypatch.setattr(
        "fegear.results.relief.applied_design.applied_design", lambda *given: asked.append(("design", *given)) or found
    )
    monkeypatch.setattr(
        "fegear.results.relief.applied_fillet.applied_fillet", lambda *given: asked.append(("fillet", *given)) or found
    )
    monkeypatch.setattr(
        "fegear.results.sizing.applied_variant.text_of_variant",
        lambda *given: asked.append(("variant", *given)) or ("text of it", "variant 2"),
    )
    command = typer.main.get_command(program()).commands["apply"]

    def call(*options):
        command(["run", "--case", str(case), *options], standalone_mode=False)
        return asked.pop()

    call.written, call.case = written, case
    return call


def test_a_design_a_fillet_or_a_variant_is_applied_and_written_unless_it_is_only_shown(applied, capsys):
    common = ("text", applied.case, "document", "tables", "run")
    assert applied() == ("design", *common, "", "")
    assert applied.written.pop() == (applied.case, "bytes of changed", "--case")
    assert capsys.readouterr().out == "Wrote what was done.\n"
    assert applied("--relief", "linear", "--pair", "I", "--quiet") == ("design", *common, "linear", "I")
    assert applied("--fillet", "--pair", "J") == ("fillet", *common, "J")
    assert len(applied.written) == 2
    assert capsys.readouterr().out == "Wrote what was done.\n"
    assert applied("--variant", "2") == ("variant", "document", "tables", 2, "run")
    assert applied.written.pop() == (applied.case, b"text of it", "--case")
    assert capsys.readouterr().out == f"Wrote variant 2 to {applied.case}.\n"
    applied.written.clear()
    for options in ((), ("--fillet",), ("--variant", "0")):
        applied(*options, "--dry-run")
        assert capsys.readouterr().out.startswith("Would write ")
    assert applied.written == []
    applied.case.write_text("here already")
    with pytest.raises(InputError, match="already exists"):
        applied("--variant", "0")


# ---- a rack in Python ------------------------------------------------------------------------------------------------
@pytest.fixture
def rack(monkeypatch):
    asked = []
    monkeypatch.setattr(racks, "build_scene", lambda document, wanted, folder, bare_si: (document, wanted, bare_si))
    monkeypatch.setattr(racks, "drawn_rack", lambda scene, name: None)
    monkeypatch.setattr(racks, "relieved_parts", lambda scene, name: ("pinion",))
    monkeypatch.setattr(racks, "cache_of", lambda cache, known: ("own", known) if cache is None else cache)
    monkeypatch.setattr(racks, "run_scene", lambda scene, **more: asked.append((scene, more)) or "results")
    made = Rack(Gear(20, "3 mm"), 12, "30 mm", name="axis")
    made.asked = asked
    return made


def test_results_of_a_rack_are_asked_for_with_its_load_effects_and_tolerance(rack):
    assert rack.transmission_error(force="2 kN") == "results"
    (document, wanted, bare), more = rack.asked.pop()
    assert (wanted, bare, document["results"]) == ("rack-transmission-error", True, ["rack-transmission-error"])
    assert document["rack"]["axis"]["force"] == "2 kN"
    assert "torque" not in document["rack"]["axis"]
    assert document["rack"]["axis"]["pinion"] == rack.pinion.name
    assert document["effects"] == {"relief": True}
    assert "accuracy" not in document
    assert more == {"progress": None, "cache": ("own", rack.known)}
    rack.transmission_error(torque="9 N*m", effects={"relief": False}, tolerance=0.02, progress=False, cache="cache")
    (document, *_), more = rack.asked.pop()
    assert "force" not in document["rack"]["axis"]
    assert (document["rack"]["axis"]["torque"], document["effects"]) == ("9 N*m", {"relief": False})
    assert document["accuracy"] == {"tolerance": 0.02}
    assert more == {"progress": False, "cache": "cache"}
    rack.stiffness_table(tolerance=0.3, progress=True)
    (document, wanted, _), more = rack.asked.pop()
    assert (wanted, document["results"], document["accuracy"]) == (
        "rack-stiffness",
        ["rack-stiffness"],
        {"tolerance": 0.3},
    )
    assert more["progress"] is True


def test_racks_are_equal_where_all_that_describes_them_is(rack):
    def made(gear=20, teeth=12, height="30 mm", name="axis"):
        return Rack(Gear(gear, "3 mm"), teeth, height, name=name)

    assert made() == rack
    assert made() != "rack"
    for other in (made(gear=21), made(teeth=13), made(height="31 mm"), made(name="other")):
        assert other != rack
    assert repr(made(name="other")).startswith("Rack(Gear(")
    with pytest.raises(InputError, match="pinion"):
        Rack("gear", 12, "30 mm")


# ---- over a revolution -----------------------------------------------------------------------------------------------
def test_flanks_over_a_revolution_are_followed_for_all_teeth_of_the_driver_and_stressed_gear_by_gear(monkeypatch):
    fractions = []
    over = SimpleNamespace(x=np.zeros(7))

    def follow(revolving, teeth, told):
        told(0.5)
        return SimpleNamespace(over=over, teeth=teeth)

    @dataclass(frozen=True)
    class Data:
        pair: object
        over: object
        stress: object
        positions: int = 0

    monkeypatch.setattr(over_revolution, "follow_flanks", follow)
    monkeypatch.setattr(
        stress_over_revolution, "wide_stress_over_revolution", lambda followed, member: (followed.teeth, member)
    )
    monkeypatch.setattr(stress_over_revolution, "usual_errors", lambda one, other: (("e", *one), ("e", *other)))
    monkeypatch.setattr(mesh_stiffness_revolution, "by_tooth", lambda one, gear, cracked: (one, gear, cracked))
    monkeypatch.setattr(mesh_stiffness_revolution, "_data", lambda asked, pair, over, stress: Data(pair, over, stress))
    revolving = SimpleNamespace(pair=SimpleNamespace(driver=SimpleNamespace(teeth=23)))
    work = SimpleNamespace(progress=fractions.append)
    asked = SimpleNamespace(gears=("p", "w"), cracked=(("driven", (4,)),))
    found = mesh_stiffness_revolution._of_wide(asked, revolving, work)
    assert found == Data(revolving.pair, over, ((("e", 23, "driver"), "p", ()), (("e", 23, "driven"), "w", (4,))), 7)
    assert fractions == [0.4]


@pytest.mark.parametrize(("odd", "plane", "wide"), [((), 1, 1), (("p",), 7, 8), (("p", "w"), 49, 64)])
def test_each_odd_gear_multiplies_the_base_pitches_that_differ(monkeypatch, odd, plane, wide):
    pair = SimpleNamespace(contact_ratio=1.6, total_contact_ratio=1.9)
    scene = SimpleNamespace(pairs={"I": pair}, wide_pairs=())
    monkeypatch.setattr(mesh_stiffness_revolution, "odd_gears_in", lambda scene, name: odd)
    monkeypatch.setattr(mesh_stiffness_revolution, "pair_spec", lambda scene, name: SimpleNamespace(panel_count=10))
    found = mesh_stiffness_revolution._forecast(scene, "I")
    assert found.settings == {"positions": mesh_stiffness_revolution.POSITIONS}
    assert found.seconds == pytest.approx(mesh_stiffness_revolution._PITCH * plane)
    scene.wide_pairs = ("I",)
    found = mesh_stiffness_revolution._forecast(scene, "I")
    places = over_revolution.POSITIONS + mesh_stiffness_revolution._ADDED
    assert found.settings == {"positions": places}
    station, again = mesh_stiffness_revolution._STATION, mesh_stiffness_revolution._AGAIN
    assert found.seconds == pytest.approx(places * 19.0 * (station + again * wide))


def test_a_study_takes_longer_with_each_pair_and_most_where_gears_are_solved():
    def seconds(samples, source):
        case = SimpleNamespace(
            study=samples and SimpleNamespace(samples=samples), accuracy=SimpleNamespace(source=source)
        )
        found = stiffness_study._forecast(SimpleNamespace(case=case), "")
        assert found.settings == {"pairs": samples or 0}
        return found.seconds

    none = seconds(None, "auto")
    assert seconds(10, "auto") - none == pytest.approx(10 * stiffness_study._KNOWN)
    assert seconds(10, "solve") - none == pytest.approx(10 * stiffness_study._SOLVED)
    assert stiffness_study._SOLVED > stiffness_study._KNOWN > 0.0


@pytest.mark.parametrize("slide", [0.0, 0.2])
def test_a_rack_with_its_width_takes_as_long_as_a_gear_on_a_rigid_hub(monkeypatch, slide):
    @dataclass
    class Settings:
        panels: int = 3

    asked = []
    made = SimpleNamespace(rack=SimpleNamespace(face_width=0.03, module=3e-3, slide=slide), settings=Settings())
    monkeypatch.setattr(solid_rack, "SolidRackToSolve", SimpleNamespace(of=lambda scene, name: made))
    monkeypatch.setattr(
        solid_rack, "seconds_of_solid_gear", lambda settings, width, **more: asked.append((width, more)) or 7.0
    )
    found = solid_rack._forecast(SimpleNamespace(), "axis")
    assert (found.settings, found.seconds) == ({"panels": 3}, 7.0)
    off = dict.fromkeys(("on_a_web", "rim_free", "holed"), False)
    assert asked == [(pytest.approx(10.0), {"apart": slide == 0.0, **off})]


@pytest.mark.parametrize(
    ("of_rack", "of_gear", "fits"), [(1, None, True), (None, 1, True), (1, 1, True), (None, None, False)]
)
def test_a_rack_with_its_width_has_one_of_its_own_or_of_its_pinion(monkeypatch, of_rack, of_gear, fits):
    checked = []
    made = SimpleNamespace(rack=SimpleNamespace(face_width=0.03, module=3e-3), settings="settings", pinion="p")
    monkeypatch.setattr(solid_rack, "SolidRackToSolve", SimpleNamespace(of=lambda scene, name: made))
    monkeypatch.setattr(solid_rack, "check_body", lambda name, rack: checked.append((name, rack)))
    monkeypatch.setattr(
        "fegear.fem.solid.settings.check_width", lambda width, settings: checked.append((width, settings))
    )
    case = SimpleNamespace(
        rack={"axis": SimpleNamespace(face_width=of_rack)}, gear={"p": SimpleNamespace(face_width=of_gear)}
    )
    with contextlib.nullcontext() if fits else pytest.raises(InputError, match=r"rack\.axis\.face_width"):
        solid_rack._check(SimpleNamespace(case=case), "axis")
        assert checked[1] == (pytest.approx(10.0), "settings")
    assert checked[0] == ("axis", made.rack)


# ---- the window ------------------------------------------------------------------------------------------------------
@pytest.fixture
def working(tmp_path, monkeypatch):
    from fegear.window import worker

    said = []
    inbox = SimpleNamespace(
        say=lambda one: said.append((one.what, one.content)), look=lambda: None, wait=lambda seconds: None,
        watch=lambda unwanted, within=None: None, given_up=False, open=lambda: said.append("open"), empty=True,
    )  # fmt: skip
    monkeypatch.setattr(worker, "Inbox", lambda connection: inbox)
    monkeypatch.setattr(worker, "_load", lambda: said.append("loaded"))
    made = worker.Worker(None, tmp_path)
    made.said, made.inbox = said, inbox
    return made


def test_the_process_answers_jobs_and_writes_what_waits_between_them_until_nobody_asks(working, monkeypatch):
    done, jobs, unwritten = [], ["first", "second"], [True, True, False, False]

    def take():
        if not jobs:
            raise EOFError
        return jobs.pop(0)

    working.inbox.take = take
    monkeypatch.setattr(working, "answer", done.append)
    monkeypatch.setattr(working._cache, "write_one", lambda: done.append("wrote") or unwritten.pop(0))
    working.serve()
    assert working.said == ["open", "loaded"]
    assert done == ["first", "wrote", "wrote", "wrote", "second", "wrote"]
    jobs[:] = ["third"]
    working.inbox.empty = False  # another one waits: it comes first
    done.clear()
    working.serve()
    assert done == ["third"]


def test_a_draft_is_told_before_the_gears_are_solved_but_not_while_a_value_moves(working, monkeypatch):
    from fegear.window import worker

    ran, found = [], []
    draft = SimpleNamespace(scene="scene of the draft", plan="plan of the draft", told="told")
    drafts = [draft]
    monkeypatch.setattr(
        worker, "draft_of", lambda *given: drafts[0] if given == ("scene", "plan", working._cache, "planned") else None
    )
    monkeypatch.setattr(working, "_found", lambda *given: found.append(given))

    def run(scene, plan, watcher, *, cache, found):
        ran.append((scene, plan, watcher, cache))
        found("task", "outcome")

    monkeypatch.setattr("fegear.engine.run.run_plan", run)
    working._draft(SimpleNamespace(moving=True), "scene", "plan", "planned")
    assert ran == []
    working._draft(SimpleNamespace(moving=False), "scene", "plan", "planned")
    assert ran == [("scene of the draft", "plan of the draft", working, working._cache)]
    assert found == [("scene of the draft", "plan of the draft", "task", "outcome", "told")]
    drafts[0] = None
    working._draft(SimpleNamespace(moving=False), "scene", "plan", "planned")
    assert len(ran) == 1


def test_designed_reliefs_are_told_of_the_pair_that_was_asked_for(working, monkeypatch):
    from fegear.window import worker

    monkeypatch.setattr(worker, "design_asked", lambda asked, pair, how: (asked, pair, how))
    monkeypatch.setattr(working, "_results", lambda asked: ("results of", asked))
    monkeypatch.setattr(worker, "designed", lambda results, pair, how: {"results": results, "pair": pair, "how": how})
    working._design(SimpleNamespace(asked="asked", pair="I", how="ground"))
    ((what, content),) = working.said
    assert what == "designed"
    assert content == {"results": ("results of", ("asked", "I", "ground")), "pair": "I", "how": "ground"}
    assert working._asked is None
    assert working._compute_ahead() == 0.0  # of no case nothing lies ahead


def test_nothing_is_kept_of_no_case_and_templates_and_the_gallery_open_as_copies(monkeypatch, tmp_path):
    pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")
    from fegear.window import bench as benches

    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path))
    bench, laid = benches.Bench(None), []
    bench.end()
    monkeypatch.setattr(bench, "lay", laid.append)
    bench.from_template("pair")
    bench.from_gallery("lin_table1")
    template, copy = laid
    assert (template.name, copy.name) == ("pair", "lin_table1")
    assert (template.path, copy.path) == (None, None)
    assert copy.text == benches.gallery()["lin_table1"].read_text("utf-8")
    kept = []
    bench.desk = SimpleNamespace(keep_up=lambda: kept.append(True))
    bench.end()
    assert kept == [True]
    heard = []
    monkeypatch.setattr(bench, "_hear", heard.append)
    bench._from_process("before there is a loop")
    bench._loop = SimpleNamespace(is_closed=lambda: True, call_soon_threadsafe=lambda act, said: act(said))
    bench._from_process("after the end")
    bench._loop.is_closed = lambda: False
    bench._from_process("said")
    assert heard == ["said"]
