"""The window without a browser: form, desk, journal, doorkeeper, computing process."""

from __future__ import annotations

import asyncio
import gc
import json
import math
import os
import queue
import signal
import socket
import subprocess
import sys
import threading
import time
import tomllib
from dataclasses import replace
from functools import partial
from multiprocessing import Pipe
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.changed_text import value_at
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.text import draft
from fegear.case.known_keys import flat
from fegear.case.reading import read_scene
from fegear.case.text_file import named_path
from fegear.engine.plan import make_plan
from fegear.engine.processes import loading
from fegear.engine.run import key_without_needs, run_plan
from fegear.engine.stage import Task
from fegear.output.report.blocks import Values
from fegear.output.report.page import fragment
from fegear.results.catalogue import STAGES
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.relief.harris import NOW, load_now, slider_map
from fegear.results.relief.relief_handles import handled_relief
from fegear.window import job_queue as inbox_module
from fegear.window.access import Doorkeeper, Keys
from fegear.window.bench import Bench
from fegear.window.computing import PATIENCE, SAME, Computing, Sent, whole
from fegear.window.designs import anew_of, draft_of, preview_told, previewed, with_previews
from fegear.window.document import Desk
from fegear.window.drag_handles import hands_of
from fegear.window.form import fields, fields_told, form, shortened, tables_to_add
from fegear.window.glance import glance_tasks, numbers_of, plan_with
from fegear.window.inputs import Inputs, merged
from fegear.window.job_queue import Asked, Compute, Design, Export, Inbox, Said, Unwanted
from fegear.window.journal import Scratch, drop, journal_folder, left_behind, sweep
from fegear.window.on_gears import gears_in_mesh
from fegear.window.order import HarrisMaps, in_order
from fegear.window.server import free_port, serve
from fegear.window.worker import scene_of

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.toml"))
TEXT = """title = "x"
results = ["load-sharing"]
[gear.a]
teeth = 28     # z
module = "3 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "a"
load = "5 kN"
compliance = { source = "weber-banaschek" }
"""


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))


# ---- form ------------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_the_form_shows_every_key_of_a_case_once(path):
    document = tomllib.loads(path.read_text("utf-8"))
    shown = [field.key for field in fields(form(document))]
    assert len(shown) == len(set(shown))
    for key in flat(document):
        assert any(key.startswith(one) for one in shown), key


def test_a_field_says_what_may_be_typed_and_what_holds_without_it():
    found = {field.key: field for field in fields(form(tomllib.loads(TEXT)))}
    assert found["gear.a.teeth"].shown == "28"
    assert found["gear.a.teeth"].required
    assert found["gear.a.pressure_angle"].default == "20 deg"
    assert not found["gear.a.pressure_angle"].given
    assert "length with its unit: mm" in found["gear.a.module"].hint
    assert list(found["gear.a.plane"].choices) == ["strain", "stress", "auto"]
    assert found["results"].kind == "several"
    assert "transmission-error" in found["results"].choices
    assert {"effects", "accuracy"} < set(tables_to_add(tomllib.loads(TEXT)))


def test_sections_are_called_by_their_keys_as_words():
    titles = [section.title for section in form({"gear": {"wheel_2": {}}, "tooth_contact": {"positions": 9}})]
    assert titles[0] == "case"
    assert {"gear wheel 2", "tooth contact"} <= set(titles)


def test_remarks_of_a_run_find_the_fields_that_they_are_about(tmp_path):
    text = TWO.replace('face_width = "20 mm"', "").replace('"weber-banaschek"', '"fe"')
    scene = scene_of(Asked(text + "[accuracy]\ntolerance = 0.1\n", "c", str(tmp_path)))
    remarks = run_plan(scene, make_plan(scene, STAGES)).remarks
    told = fields_told(form(scene.document), remarks)
    assert ": face_width not specified, 1 mm assumed." in told["gear", "a", "face_width"]
    assert "fixed at half the root radius," in told["gear", "b", "bore_radius"]
    # Fields of tables that the case does not have are not there; effects are, as this case has the table.
    off = {path[-1] for path in told if path[0] == "effects"}
    assert off == {"corner_contact"}
    assert {path[0] for path in told} == {"gear", "effects"}
    assert fields_told(form(scene.document), ["Pair I: the load on a tooth pair is high."]) == {}


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_form_shows_is_what_it_writes(kind):
    """Every shown value, typed again, leaves the case as it is."""
    desk = Desk(draft(Answers(kind, {}), kind), kind, Path.cwd())
    before = desk.text
    for field in fields(form(desk.document)):
        if field.given and field.kind != "switch":
            desk.set(field.path, field.written(field.shown))
    assert desk.text == before
    assert desk.refusal is None


# ---- desk ------------------------------------------------------------------------------------------------------------
def test_a_refused_value_is_the_sentence_of_the_command_line_and_can_be_undone(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    desk = Desk.of_file(path)
    assert (desk.refusal, desk.changed, desk.can_undo) == (None, False, False)
    desk.set(("gear", "a", "module"), '"3 kg"')
    with pytest.raises(InputError) as told:
        read_scene(path, ['gear.a.module="3 kg"'])
    assert str(desk.refusal) == str(told.value)
    desk.undo()
    assert (desk.refusal, desk.text, desk.can_redo) == (None, TEXT, True)
    desk.redo()
    assert 'module = "3 kg"' in desk.text
    assert "teeth = 28     # z" in desk.text


def test_unsaved_changes_outlive_the_process_until_they_are_saved_or_given_up(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    Desk.of_file(path).set(("gear", "a", "teeth"), "30")  # and nothing more is heard of it
    again = Desk.of_file(path)
    assert (again.changed, again.document["gear"]["a"]["teeth"]) == (True, 30)
    assert again.restored
    assert path.read_text() == TEXT
    assert all(one.stat().st_mode & 0o077 == 0 for one in journal_folder().iterdir())
    again.save()
    assert tomllib.loads(path.read_text())["gear"]["a"]["teeth"] == 30
    assert (Desk.of_file(path).changed, list(journal_folder().iterdir())) == (False, [])
    last = Desk.of_file(path)
    last.set(("gear", "a", "teeth"), "31")
    last.give_up()
    assert Desk.of_file(path).document["gear"]["a"]["teeth"] == 30


def test_a_damaged_journal_is_none(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    Desk.of_file(path).set(("gear", "a", "teeth"), "30")
    (journal,) = journal_folder().iterdir()
    for content in ("", "{", "[]", '{"text": 1}'):
        journal.write_text(content)
        assert Desk.of_file(path).text == TEXT


def test_a_file_that_somebody_else_changed_is_not_written_over_unasked(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    path.chmod(0o640)
    desk = Desk.of_file(path)
    desk.set(("gear", "a", "teeth"), "30")
    path.write_text(TEXT.replace("28", "29"))
    with pytest.raises(InputError, match="was modified by another program since it was"):
        desk.save()
    assert "29" in path.read_text()
    desk.save(over_others=True)
    assert "30" in path.read_text()
    assert path.stat().st_mode & 0o777 == 0o640
    with pytest.raises(InputError, match="already exists"):
        desk.save_as(path)
    desk.save_as(tmp_path / "d")
    assert (desk.name, (tmp_path / "d.toml").read_text()) == ("d", desk.text)
    assert sorted(one.name for one in tmp_path.iterdir() if one.is_file()) == ["c.toml", "d.toml"]


def changed_desk(path, teeth):
    desk = Desk.of_file(path)
    desk.set(("gear", "a", "teeth"), str(teeth))
    return desk


def test_unsaved_changes_do_not_win_over_an_edit_that_somebody_made_meanwhile(tmp_path):
    """They came back as the case, and Save replaced the edit, for nobody knew what they had begun with."""
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    changed_desk(path, 30)  # and the window is closed
    path.write_text(TEXT.replace("28", "29"))
    again = Desk.of_file(path)
    assert again.document["gear"]["a"]["teeth"] == 29
    assert "The file was modified since the unsaved changes" in again.restored
    again.undo()
    assert again.document["gear"]["a"]["teeth"] == 30
    again.redo()
    again.save()
    assert path.read_text() == TEXT.replace("28", "29")
    assert (Desk.of_file(path).restored, list(journal_folder().iterdir())) == ("", [])


def test_two_windows_on_one_file_keep_their_changes_apart(tmp_path):
    """The second window's Save forgot what the first one kept, and each window's changes replaced the other's."""
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    first = changed_desk(path, 30)
    second = Desk.of_file(path)
    assert (second.text, second.restored) == (TEXT, "")  # those of a living window are not taken up
    second.set(("gear", "a", "teeth"), "31")
    second.save()
    with pytest.raises(InputError, match="was modified by another program since it was opened"):
        first.save()
    assert tomllib.loads(path.read_text())["gear"]["a"]["teeth"] == 31
    first.leave()  # a crash
    again = Desk.of_file(path)
    assert again.document["gear"]["a"]["teeth"] == 31
    again.undo()
    assert again.document["gear"]["a"]["teeth"] == 30


def test_cases_without_a_file_are_kept_each_by_itself(tmp_path):
    """All of them shared one journal: the second one's changes replaced those of the first."""
    desks = [Desk(TEXT, name, tmp_path) for name in ("first", "second", "third")]
    for number, desk in enumerate(desks):
        desk.set(("gear", "a", "teeth"), str(30 + number))
    assert left_behind(None) == []
    for desk in desks[:2]:
        desk.leave()
    left = left_behind(None)
    assert sorted(one.kept.name for one in left) == ["first", "second"]
    again = Desk.of_left(next(one for one in left if one.kept.name == "first"))
    assert again.document["gear"]["a"]["teeth"] == 30
    for one in left:
        if one.kept.name == "first":
            with pytest.raises(InputError, match="is now open in another window"):
                Desk.of_left(one)
    again.save_as(tmp_path / "first.toml")
    assert [one.kept.name for one in left_behind(None)] == ["second"]


def test_what_is_saved_under_another_name_is_what_that_file_opens_with(tmp_path):
    """An old journal of the file that was replaced won over it at the next start."""
    path, other = tmp_path / "c.toml", tmp_path / "d.toml"
    for one in (path, other):
        one.write_text(TEXT)
    changed_desk(other, 40).leave()
    desk = changed_desk(path, 30)
    desk.save_as(other, replace=True)
    desk.leave()
    assert Desk.of_file(other).document["gear"]["a"]["teeth"] == 30
    assert Desk.of_file(path).text == TEXT


def test_journals_of_version_0_2_are_still_found(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    changed_desk(path, 30).leave()
    (place,) = journal_folder().iterdir()
    old = json.loads(place.read_text())
    del old["base"]
    place.with_name(f"{place.name[:16]}.json").write_text(json.dumps(old))
    place.unlink()
    desk = Desk.of_file(path)
    assert desk.text == TEXT  # nobody knows what it began with
    desk.undo()
    assert desk.document["gear"]["a"]["teeth"] == 30


def test_save_keeps_links_line_ends_and_rights(tmp_path):
    """It replaced a link by a file, and wrote line feeds alone."""
    real, link = tmp_path / "real.toml", tmp_path / "link.toml"
    real.write_bytes(TEXT.replace("\n", "\r\n").encode())
    real.chmod(0o640)
    link.symlink_to(real)
    desk = changed_desk(link, 30)
    desk.save()
    assert link.is_symlink()
    assert real.read_bytes() == TEXT.replace("28", "30").replace("\n", "\r\n").encode()
    assert real.stat().st_mode & 0o777 == 0o640
    assert not Desk.of_file(link).changed


def test_changes_are_given_up_for_what_the_file_has_now(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    desk = changed_desk(path, 30)
    path.write_text(TEXT.replace("28", "29"))
    desk.give_up()
    assert (desk.text, desk.changed) == (path.read_text(), False)
    desk.set(("gear", "a", "teeth"), "31")
    desk.save()  # nobody has changed it since
    path.unlink()
    with pytest.raises(InputError, match="does not exist"):
        desk.give_up()


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("", "must not be empty"),
        ("~nobody-of-this-name/x", "refers to an unknown home folder"),
        ("n" * 3000, "File name too long"),
        ("a\0b", "contains a character not allowed in file names"),
        ("none/x", "is in a folder that does not exist"),
        ("..", "is a folder, not a file name"),
        ("c", "already exists"),
        ("folder", "already exists"),
    ],
    ids=["empty", "nobody", "long", "NUL", "cannot be used as a folder (", "above", "taken", "a folder"],
)
def test_a_name_that_no_case_can_be_saved_under_is_refused_in_a_sentence(tmp_path, monkeypatch, typed, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "c.toml").write_text(TEXT)
    (tmp_path / "folder.toml").mkdir()
    desk = Desk(TEXT, "c", tmp_path)
    with pytest.raises(InputError, match=words):
        desk.save_as(named_path(typed, "case", home=True))
    if typed == "folder":
        with pytest.raises(InputError, match="is a folder, a pipe or a device"):
            desk.save_as(named_path(typed, "case", home=True), replace=True)
    assert desk.path is None
    assert (tmp_path / "c.toml").read_text() == TEXT


def test_a_folder_that_takes_no_journal_is_told_and_loses_nothing_else(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "file" / "below"))
    (tmp_path / "file").write_text("")
    desk = Desk(TEXT, "c", tmp_path)
    desk.set(("gear", "a", "teeth"), "30")
    assert "cannot be recovered" in desk.trouble
    assert desk.document["gear"]["a"]["teeth"] == 30


@pytest.fixture
def full_disk():
    """Lets no file grow beyond some bytes, as a full disk does; gives room again when it is called."""
    resource = pytest.importorskip("resource", reason="only Unix bounds the size of files")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, before[1]))
    yield lambda: resource.setrlimit(resource.RLIMIT_FSIZE, before)
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_is_told_with_the_change_that_is_not_kept_until_there_is_room(tmp_path, monkeypatch, full_disk):
    """A dragged value told it one move late, it was told for ever, and each try left a hidden file behind."""
    monkeypatch.setattr("fegear.window.bench._AGAIN", 0.02)
    bench, told = Bench(None), []
    bench.desk = Desk(TWO, "c", tmp_path)
    bench.listen(lambda what, _content: told.append((what, bool(bench.desk.trouble))))

    async def full():
        bench.begin()
        bench.move_load("I", "load", "900 N", moving=True)
        for _ in range(100):  # a value that moves is kept now and then
            await asyncio.sleep(0.02)
            if bench.desk.trouble:
                break
        assert told[-1] == ("kept", True)
        assert "Changes cannot be recovered after a crash:" in bench.desk.trouble
        assert list(journal_folder().iterdir()) == []
        full_disk()
        for _ in range(100):
            await asyncio.sleep(0.02)
            if not bench.desk.trouble:
                break
        assert told[-1] == ("kept", False)

    asyncio.run(full())
    (kept,) = journal_folder().iterdir()
    assert "900 N" in json.loads(kept.read_text())["text"]


def test_a_text_that_no_file_takes_is_refused_and_the_case_stays(tmp_path):
    desk = Desk(TEXT, "c", tmp_path)
    for text in (TEXT.replace("28", "28 # \ud800"), TEXT.replace("28", "28 # \uffff")):
        with pytest.raises(InputError, match=r"invalid character .surrogate. in line 4"):
            desk.change(text)
    with pytest.raises(InputError, match="has 4000001 characters"):
        desk.change("#" * 4_000_001)
    assert (desk.text, desk.can_undo) == (TEXT, False)


def test_earlier_states_of_long_texts_are_bounded(tmp_path):
    desk = Desk(TEXT, "c", tmp_path)
    for i in range(40):
        desk.change(f"{TEXT}#{i}{'x' * 1_000_000}", stroke=True)
        desk.end_stroke()
    assert sum(map(len, desk._states)) < 31_000_000
    assert desk.can_undo


def test_a_long_text_is_judged_where_nobody_waits_for_it(tmp_path, monkeypatch):
    """3000 gears that were pasted blocked the server and its end for a minute."""
    threads, jobs, hand_out = [], [], Desk.hand_out

    def noted(desk):
        judge = hand_out(desk)
        return lambda: (threads.append(threading.current_thread()), judge())[1]

    monkeypatch.setattr(Desk, "hand_out", noted)
    bench = Bench(None, SimpleNamespace(ask=jobs.append, hear=None))
    bench.desk = Desk(TEXT, "c", tmp_path)
    many = "".join(f'[gear.g{i}]\nteeth = 28\nmodule = "3 mm"\nface_width = "20 mm"\n' for i in range(500))

    async def pasted(text):
        bench.begin()
        jobs.clear()
        bench.desk.change(text)
        bench.changed()
        assert bench.desk.pending
        assert bench.desk.document == tomllib.loads(TEXT)  # nobody waits
        assert jobs == []
        (left,) = journal_folder().iterdir()
        assert json.loads(left.read_text())["text"] == text  # it is kept all the same
        while bench.desk.pending:
            await asyncio.sleep(0.01)
        for _ in range(1000):  # what is judged is asked for in the loop's next turns
            if jobs or bench.desk.refusal is not None:
                break
            await asyncio.sleep(0.01)

    asyncio.run(pasted(TEXT + many))
    assert bench.desk.refusal is None
    assert len(bench.desk.document["gear"]) == 501
    assert jobs[-1].asked.text == TEXT + many
    assert threads
    assert threading.main_thread() not in threads
    bench.desk.undo()
    bench.desk.change(TEXT + many.replace("teeth = 28", "teeth = 2"))
    assert "gear.g0.teeth = 2" in str(bench.desk.refusal)  # who must know waits


def test_the_form_of_a_case_with_many_tables_shows_some_and_says_so():
    gears = {f"g{i}": {"teeth": 20, "relief": {f"r{j}": {} for j in range(50)}} for i in range(100)}
    short, left = shortened({"title": "x", "gear": gears, "pair": {"I": {"driver": "a"}}})
    assert len(short["gear"]) == 40
    assert left == 60 + 40 * 10
    assert short["pair"] == {"I": {"driver": "a"}}
    document = tomllib.loads(TEXT)
    assert shortened(document) == (document, 0)


def test_a_stroke_is_undone_in_one_step(tmp_path):
    desk = Desk(TEXT, "c", tmp_path)
    for teeth in (29, 30, 31):
        desk.change(TEXT.replace("28", str(teeth)), stroke=True)
    desk.end_stroke()
    desk.change(TEXT.replace("28", "40"), stroke=True)
    desk.undo()
    assert "teeth = 31" in desk.text
    desk.undo()
    assert desk.text == TEXT


# ---- by hand ---------------------------------------------------------------------------------------------------------
TWO = (
    TEXT.replace('driven = "a"', 'driven = "b"')
    + """[gear.b]
teeth = 41
module = "3 mm"
face_width = "20 mm"
[effects]
hertz = "load-dependent"
"""
)


def test_the_curve_of_a_relief_stays_within_its_axes(tmp_path):
    deep = '[gear.a.relief]\ntable = { roll_angles = ["0 deg", "90 deg"], removals = ["60 um", "60 um"] }\n'
    relief = handled_relief(scene_of(Asked(TWO + deep, "c", str(tmp_path))), "I", "driver")
    (panel,) = relief.figure.panels
    assert relief.handles == ()
    assert len(panel.items) == 1
    assert panel.items[0].y == pytest.approx(60.0)
    assert panel.y.limits[1] == pytest.approx(75.0)


def test_a_relief_moved_by_hand_is_the_relief_of_the_case(tmp_path):
    bench = Bench(None)
    bench.lay(Desk(TWO, "c", tmp_path))
    first = handled_relief(scene_of(bench.asked()), "I", "driver")
    assert first.handles == ()
    bench.move_relief("a", "tip", first.usual["tip"], 12.5, moving=True)
    bench.move_relief("a", "tip", first.usual["tip"] + 1.0, 15.25, moving=False)
    scene = scene_of(bench.asked())
    relief = handled_relief(scene, "I", "driver")
    (handle,) = relief.handles
    assert (handle.end, handle.amount) == ("tip", pytest.approx(15.25))
    assert handle.start == pytest.approx(first.usual["tip"] + 1.0, abs=6e-4)
    curve = relief.figure.panels[0].items[0]
    assert np.interp(handle.at, curve.x, curve.y) == pytest.approx(15.25, abs=0.05)
    assert np.abs(curve.y[curve.x <= handle.start]).max() == 0.0
    assert scene.case.effects.relief
    bench.desk.undo()
    assert bench.desk.text == TWO
    bench.desk.redo()
    bench.drop_relief("a")
    assert scene_of(bench.asked()).case.gear["a"].relief is None
    assert bench.desk.refusal is None


def test_the_answer_to_a_moved_value_is_asked_for_before_the_case_is_judged_and_kept(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))
    done: list[str] = []
    bench = Bench(None, SimpleNamespace(ask=lambda job: done.append("moves" if job.asked.moving else "at rest")))
    bench.lay(Desk(TWO, "c", tmp_path))
    judge, keep = Desk._judge, bench.desk._journal.keep
    monkeypatch.setattr(Desk, "_judge", lambda desk: done.append("judged") or judge(desk))
    monkeypatch.setattr(bench.desk._journal, "keep", lambda state: done.append("kept") or keep(state))
    done.clear()
    bench.move_load("I", "load", "900 N", moving=True)
    assert done == ["moves", "judged", "kept"]
    bench.move_load("I", "load", "-1 N", moving=True)  # refused, as who computes it says
    assert done[3:] == ["moves", "judged", "kept"]
    bench.move_load("I", "load", "-2 N", moving=True)  # known to be wrong: looked at first
    assert done[6:] == ["judged", "kept"]
    bench.move_load("I", "load", "800 N", moving=False)
    assert done[8:] == ["judged", "at rest", "kept"]
    bench.lay(None)
    (left,) = left_behind(None)
    assert '"800 N"' in left.kept.text


def test_a_move_that_has_not_been_kept_yet_is_left_behind_all_the_same(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))
    for leave in (lambda desk: desk.leave(), lambda desk: (desk.undo(), desk.redo(), desk.leave())):
        desk = Desk(TWO, "c", tmp_path)
        desk.change(TWO.replace("28", "29"), stroke=True)
        assert not left_behind(None)
        leave(desk)
        (left,) = left_behind(None)
        assert left.kept.text == desk.text != TWO
        drop(left)


def test_answers_to_earlier_places_of_a_moved_value_are_shown_and_end_nothing(tmp_path):
    bench = Bench(None)
    bench.lay(Desk(TWO, "c", tmp_path))
    told = []
    bench.listen(lambda what, content: told.append(what))
    bench._first, bench._number = 3, 7
    found = {"task": "x", "values": "", "figures": []}
    for number, what, content in (
        (2, "found", found), (2, "done", {}), (2, "refused", {"sentence": "", "key": ""}),  # of the case before
        (5, "plan", {"tasks": ["x"]}), (5, "hands", {"pairs": {"I": {"mesh": {"a": 1}, "reliefs": [2]}}}),
        (5, "found", found),
        (5, "done", {"moving": True}), (7, "hands", {"pairs": {"I": {"mesh": None}}}), (7, "done", {"moving": False}),
    ):  # fmt: skip
        bench._hear(Said(number, what, content))
    assert told == ["plan", "hands", "found", "hands", "done"]
    (pair,) = dict(bench.shown_now())["hands"]["pairs"].values()
    assert (pair["mesh"], pair["reliefs"]) == ({"a": 1}, [2])  # as they were told last


def test_what_is_refused_beside_the_case_is_told_and_a_design_does_not_reach_the_next_case(tmp_path):
    class Quiet:
        def ask(self, job):
            asked.append(job)

    bench, told, asked = Bench(None), [], []
    bench.lay(Desk(TWO, "c", tmp_path))
    bench.listen(lambda what, content: told.append((what, content.get("sentence"))))
    bench._computing = Quiet()
    bench.export("relief", str(tmp_path / "out"))
    bench.design("I", "ground")
    export, design = asked
    bench._hear(
        Said(export.number, "refused", {"sentence": "has nothing to write: no gear has a relief of", "key": ""})
    )
    assert told[-1] == ("failed", "has nothing to write: no gear has a relief of")
    other = TWO.replace("teeth = 41", "teeth = 43")
    bench.lay(Desk(other, "d", tmp_path))
    count = len(told)
    bench._hear(Said(design.number, "designed", {"reliefs": {"a": None, "b": None}, "told": ""}))
    assert (bench.desk.text, len(told)) == (other, count)


def test_a_value_that_nobody_moves_any_more_stands_still_though_nobody_said_so(tmp_path, monkeypatch):
    """A page that is closed while a value moves says nothing more."""

    class Quiet:
        def ask(self, job):
            asked.append(job.asked.moving)

    async def moved():
        bench._loop = asyncio.get_running_loop()
        for load in ("6 kN", "7 kN"):
            bench.move_load("I", "load", load, moving=True)
        for _ in range(1000):  # how soon depends on how busy the machine is
            await asyncio.sleep(0.01)
            if len(asked) == 3:
                break

    monkeypatch.setattr("fegear.window.bench._HELD", 0.01)
    monkeypatch.setattr("fegear.window.bench._PAUSE", 0.0)  # the second move is shown before the first is let go
    bench, asked = Bench(None), []
    bench.lay(Desk(TWO, "c", tmp_path))
    bench._computing = Quiet()
    asyncio.run(moved())
    assert asked == [True, True, False]


def test_a_comparison_with_what_is_pinned_no_longer_is_not_shown(tmp_path):
    class Quiet:
        def ask(self, job):
            asked.append(job)

    bench, told, asked = Bench(None), [], []
    bench.lay(Desk(TWO, "c", tmp_path))
    bench._computing = Quiet()
    bench.listen(lambda what, _content: told.append(what))
    bench.pin()
    for pinned_anew in (False, True):
        bench.changed()
        bench._hear(Said(asked[-1].number, "done", {"moving": False}))
        late = asked[-1].number
        bench.unpin()
        if pinned_anew:
            bench.pin()
        bench._hear(Said(late, "compared", {"sections": []}))
        assert "compared" not in told
        bench.pin()
    bench.changed()
    bench._hear(Said(asked[-1].number, "done", {"moving": False}))
    bench._hear(Said(asked[-1].number, "compared", {"sections": []}))
    assert told[-1] == "compared"
    assert bench.shown_now()[-1][0] == "compared"
    bench.changed()  # a page that opens now shows that more is to come
    assert bench.shown_now()[-1] == ("asked", {"number": asked[-1].number, "moving": False})
    bench._hear(Said(asked[-1].number, "refused", {"sentence": "", "key": ""}))
    assert bench.shown_now()[-1][0] == "compared"
    bench.changed()  # nothing is computed any more for a case that is taken off the desk
    bench.lay(None)
    bench._hear(Said(asked[-1].number, "done", {"moving": False}))
    assert bench.shown_now() == []


@pytest.mark.dear
def test_every_case_has_hands_and_every_handle_can_be_moved_to_where_it_is():
    for path in CASES:
        asked = Asked(path.read_text("utf-8"), path.stem, str(path.parent))
        pairs = hands_of(scene_of(asked))
        json.dumps(pairs, allow_nan=False)
        for one in (relief for pair in pairs.values() for relief in pair["reliefs"]):
            assert one["low"] < one["usual"]["root"] <= one["usual"]["tip"] < one["high"], path.stem
            for handle in one["handles"]:
                bench = Bench(None)
                bench.desk = Desk(asked.text, asked.name, Path(asked.folder))
                bench.move_relief(
                    one["gear"], handle["end"], handle["start"], handle["amount"], moving=False, index=handle["index"]
                )
                assert bench.desk.refusal is None, path.stem


SEVERAL = """
[gear.a.relief]
tip = [{ amount = "10 um", start_radius = "42.5 mm" }, { amount = "4 um", length = "2 mm", shape = "parabolic" }]
root = { amount = "6 um", length = "1.5 mm" }
crowning = { amount = "3 um" }
"""


LISTED = """
[[gear.a.relief.tip]]
amount = "10 um" # ground first
start_radius = "42.5 mm"

[[gear.a.relief.tip]]
amount = "4 um"
length = "2 mm" # then this
shape = "parabolic"

[[gear.a.relief.root]]
amount = "6 um"
length = "1.5 mm"

[gear.a.relief.crowning]
amount = "3 um"
"""


@pytest.mark.parametrize("several", [SEVERAL, LISTED])
def test_every_part_of_a_relief_has_its_handle_and_moves_alone(tmp_path, several):
    text = TWO + several
    desk = Desk(text, "c", tmp_path)
    bench = Bench(None)
    bench.lay(desk)

    def handles():
        return {(one.end, one.index): one for one in handled_relief(scene_of(bench.asked()), "I", "driver").handles}

    before = handles()
    assert sorted(before) == [("crowning", 0), ("root", 0), ("tip", 0), ("tip", 1)]
    for (end, index), one in before.items():
        start = one.start + (0.5 if end != "root" else -0.25)
        bench.move_relief("a", end, start, one.amount + 1.5, moving=False, index=index)
        after = handles()
        assert after[end, index].amount == pytest.approx(one.amount + 1.5, abs=0.01)
        assert after[end, index].start == pytest.approx(one.start if end == "crowning" else start, abs=1e-3)
        for other in set(before) - {(end, index)}:
            assert (after[other].start, after[other].amount) == pytest.approx(
                (before[other].start, before[other].amount)
            )
        assert value_at(desk.document, ("gear", "a", "relief", "tip"))[1]["shape"] == "parabolic"
        desk.undo()
    assert desk.text == text
    if several is LISTED:
        bench.move_relief("a", "tip", before["tip", 1].start, 5.0, moving=False, index=1)
        assert desk.text.replace("5.00 um", "4 um") == text.replace(
            'hertz = "load-dependent"\n', 'hertz = "load-dependent"\nrelief = true\n'
        )
        bench.drop_relief("a")
        assert desk.text.rstrip() == TWO.rstrip()


@pytest.mark.parametrize(("start", "amount"), [(28.0, None), (None, 5.0), (28.0, math.inf), (math.nan, 5.0)])
def test_a_relief_moved_to_no_number_is_refused_and_changes_nothing(tmp_path, start, amount):
    """JSON has no infinity: what a page without room for its axes sends arrives as None."""
    bench = Bench(None)
    bench.lay(Desk(TWO, "c", tmp_path))
    with pytest.raises(InputError, match="must be a finite number"):
        bench.move_relief("a", "tip", start, amount, moving=True)
    assert bench.desk.text == TWO


@pytest.mark.parametrize(
    ("key", "given"),
    [("length", '"4 mm"'), ("start_radius", '"43 mm"'), ("start_roll_angle", '"25 deg"'), ("normalised_length", "0.8")],
)
def test_where_a_moved_relief_starts_is_said_by_the_key_that_the_user_chose(tmp_path, key, given):
    bench = Bench(None)
    bench.lay(Desk(f"{TWO}[gear.a.relief]\ntip = {{ amount = '10 um', {key} = {given} }}\n", "c", tmp_path))

    def now():
        (handle,) = handled_relief(scene_of(bench.asked()), "I", "driver").handles
        return handle, value_at(bench.desk.document, ("gear", "a", "relief", "tip"))

    before, kept = now()
    bench.move_relief("a", "tip", before.start, 14.0, moving=False)
    after, part = now()
    assert part == kept | {"amount": "14.00 um"}  # its start is as the user wrote it
    assert (after.start, after.amount) == (before.start, pytest.approx(14.0))
    bench.move_relief("a", "tip", before.start + 1.25, 14.0, moving=False)
    after, part = now()
    assert part.keys() == kept.keys()
    assert after.start == pytest.approx(before.start + 1.25, abs=1e-3)
    assert after.amount == pytest.approx(14.0)


@pytest.mark.dear
def test_the_map_beside_the_slider_of_a_pair_with_a_width_is_that_of_runs_at_its_loads(tmp_path):
    text = TWO.replace("[gear.b]", 'width = "slices"\n[gear.b]').replace(
        'compliance = { source = "weber-banaschek" }', "loads = ['2.5 kN', '7.5 kN']"
    )
    text = (
        text.replace('"load-sharing"', '"transmission-error"')
        + "[load_distribution]\npositions = 6\npanels = 5\n[accuracy]\ntolerance = 0.05\n"
    )
    scene = scene_of(Asked(text, "c", str(tmp_path)))
    hands = hands_of(scene)["I"]
    assert [len(hands["reliefs"]), hands["designs"], hands["load"]["text"]] == [2, False, "5 kN"]
    results = run_plan(scene, make_plan(scene, STAGES))
    found = HarrisMaps().at_rest(results)["I"]
    assert "up to 10000 N" in found["figure"]["caption"]
    data = results.outcomes[Task("loaded-flanks", "I")].data
    over_roll, over_load = slider_map("I", data, 10_000.0).panels
    drawn = {one.name: one for one in over_roll.items}
    load, x, te = load_now(data)
    assert load == 5000.0
    np.testing.assert_array_equal([drawn[NOW].x, drawn[NOW].y], [x, te])
    # Loads that the case names were solved together with the nominal one: the family has the same.
    family = over_load.items[0]
    for i, one in enumerate(data.found.load.tolist()):
        if one in family.x:
            swing = np.ptp(data.found.transmission_error[:, i]) * 1e6
            assert family.y[list(family.x).index(one)] == pytest.approx(swing, rel=1e-6)
    assert (np.ptp(te), results.values["I.te_peak_to_peak"].si * 1e6) == pytest.approx([over_load.items[1].y[0]] * 2)


def test_a_gear_that_meets_its_like_gets_a_name_of_its_own(tmp_path):
    bench = Bench(None)
    bench.lay(Desk(TEXT, "c", tmp_path))
    assert len(hands_of(scene_of(bench.asked()))["I"]["reliefs"]) == 1
    first = scene_of(bench.asked()).pairs["I"]
    bench.name_driven("I")
    assert bench.desk.refusal is None
    scene = scene_of(bench.asked())
    assert scene.case.pair["I"].driven == "a_driven"
    assert scene.case.gear["a_driven"] == scene.case.gear["a"]
    assert scene.pairs["I"] == first
    assert "# z" in bench.desk.text


def test_the_map_beside_the_slider_is_that_of_runs_at_its_loads(tmp_path):
    scene = scene_of(Asked(TWO, "c", str(tmp_path)))
    results = run_plan(scene, make_plan(scene, STAGES))
    maps = HarrisMaps()
    found = maps.at_rest(results)["I"]
    json.dumps(found, allow_nan=False)
    data = loaded_pair({task: one.data for task, one in results.outcomes.items()}, "I")
    figure = slider_map("I", data, 10_000.0)
    drawn = {one.name: one for one in figure.panels[0].items}
    (_, x, te), now = load_now(data), drawn[NOW]
    assert np.interp(x, now.x, now.y) == pytest.approx(te, abs=0.02 * np.ptp(te) + 1e-9)
    other = scene_of(Asked(TWO.replace('"5 kN"', '"7 kN"'), "c", str(tmp_path)))
    there = run_plan(other, make_plan(other, STAGES))
    at_7 = loaded_pair({task: one.data for task, one in there.outcomes.items()}, "I")
    at_7_now = {one.name: one for one in slider_map("I", at_7, 10_000.0).panels[0].items}[NOW]
    assert drawn["7000 N"].y == pytest.approx(at_7_now.y)
    # The range stays while the slider is within it, and follows a load beyond it.
    assert "up to 10000 N" in found["figure"]["caption"]
    assert "up to 10000 N" in maps.at_rest(there)["I"]["figure"]["caption"]
    far = scene_of(Asked(TWO.replace('"5 kN"', '"11 kN"'), "c", str(tmp_path)))
    assert "up to 22000 N" in maps.at_rest(run_plan(far, make_plan(far, STAGES)))["I"]["figure"]["caption"]


# ---- doorkeeper ------------------------------------------------------------------------------------------------------
HOST = {"host": "127.0.0.1:5000"}
KEY = {"cookie": "other=1; fegear-5000=secret"}


@pytest.mark.parametrize(
    ("heads", "query", "let_in"),
    [
        (HOST | KEY, "", True),
        (HOST | KEY, "key=used", True),
        (HOST, "key=secret", False),  # the secret of the cookie is no key
        ({"host": "localhost:5000"} | KEY, "", True),
        (HOST | KEY | {"origin": "http://127.0.0.1:5000", "sec-fetch-site": "same-origin"}, "", True),
        (HOST, "", False),
        (HOST, "key=Secret", False),
        (HOST, "key=", False),
        (HOST | {"cookie": 'a[b]="x; \x01=\xff; ={; fegear-5000=secret'}, "", True),  # of other programs here
        (HOST | {"cookie": "fegear-5000=old; fegear-5000=secret"}, "", True),
        (HOST | {"cookie": "a=fegear-5000=secret"}, "", False),
        (HOST | {"cookie": "\xff"}, "", False),
        (HOST | {"cookie": "fegear-5001=secret"}, "", False),
        (HOST | {"cookie": "fegear-5000="}, "", False),
        ({"host": "evil.example:5000"} | KEY, "", False),
        ({"host": "127.0.0.1"} | KEY, "", False),
        (KEY, "", False),
        (HOST | KEY | {"origin": "http://evil.example"}, "", False),
        (HOST | KEY | {"origin": "http://127.0.0.1:5001"}, "", False),
        (HOST | KEY | {"origin": "https://127.0.0.1:5000"}, "", False),
        (HOST | KEY | {"origin": "null"}, "", False),
        (HOST | KEY | {"sec-fetch-site": "cross-site"}, "key=secret", False),
        (HOST | KEY | {"sec-fetch-site": "same-site"}, "", False),  # of another port of this machine
        (HOST | KEY | {"sec-fetch-site": "cross-site", "sec-fetch-dest": "document"}, "", False),
    ],
)
@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_only_the_page_that_was_opened_is_let_in(heads, query, let_in, kind):
    seen, sent = [], []

    async def app(scope, receive, send):
        seen.append(scope)
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def send(message):
        sent.append(message)

    keys = Keys()
    keys.secret = KEY["cookie"].rpartition("=")[2]
    scope = {
        "type": kind,
        "path": "/",
        "query_string": query.encode(),
        "headers": [(k.encode(), v.encode("latin-1")) for k, v in heads.items()],
    }
    asyncio.run(Doorkeeper(app, 5000, keys)(scope, None, send))
    assert bool(seen) is let_in
    if not let_in:
        assert sent[0].get("status", sent[0].get("code")) in (403, 1008)
        assert b"secret" not in json.dumps(sent, default=str).encode()


def test_a_port_that_cannot_be_had_and_a_case_that_is_not_there_are_refused(tmp_path):
    with pytest.raises(InputError, match="--port = 70000"):
        serve(None, 70000, browser=False, say=print)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(InputError, match="is not available \\("):
            free_port(taken.getsockname()[1])
    with pytest.raises(InputError, match="does not exist"):
        serve(tmp_path / "missing.toml", None, browser=False, say=print)


def test_loading_does_without_searches_for_garbage_and_leaves_them_as_they_were():
    before = gc.get_freeze_count()
    try:
        with loading():
            assert not gc.isenabled()
        assert gc.isenabled()
        with pytest.raises(ZeroDivisionError), loading():
            1 / 0  # noqa: B018
        assert gc.isenabled()
        assert gc.get_freeze_count() > before
        gc.disable()
        with loading():
            pass
        assert not gc.isenabled()
    finally:
        gc.unfreeze()
        gc.enable()


# ---- computing process -----------------------------------------------------------------------------------------------
class Heard:
    """Everything that a computing process says, job by job."""

    def __init__(self):
        self._queue = queue.Queue()
        self.all = []

    def __call__(self, said):
        self._queue.put(said)

    def until(self, number, *what):
        while True:
            said = self._queue.get(timeout=60)
            self.all.append(said)
            if said.number == number and said.what in what:
                return said


@pytest.fixture(scope="module")
def computing():
    heard = Heard()
    made = Computing()
    made.hear = heard
    yield made, heard
    pid = made.pid
    made.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


@pytest.mark.dear
def test_the_page_is_told_the_numbers_of_a_run_and_only_what_depends_is_computed_again(computing, tmp_path):
    made, heard = computing
    made.ask(Compute(1, Asked(TEXT, "c", str(tmp_path))))
    first = heard.until(1, "done")
    path = tmp_path / "c.toml"
    path.write_text(TEXT)
    scene = read_scene(path)
    run = run_plan(scene, make_plan(scene, STAGES))
    told = "".join(said.content["values"] for said in heard.all if said.what == "found")
    tolerance = scene.case.accuracy.tolerance
    expected = "".join(fragment([Values(o.values, tolerance)]) for o in run.outcomes.values() if o.values)
    assert told == expected
    assert first.content["remarks"] == list(run.remarks)
    figures = [one["key"] for said in heard.all if said.what == "found" for one in said.content["figures"]]
    assert figures == [figure.name for figure in run.figures]
    made.ask(Compute(2, Asked(TEXT + 'speed = "100 rpm"\n', "c", str(tmp_path))))
    assert {origin for _, origin in heard.until(2, "done").content["timings"].values()} == {"recalled"}


def test_numbers_while_a_value_moves_are_the_numbers_to_what_a_plot_shows(tmp_path):
    """From one state of the base pitch: at rest they are computed anew."""
    text = TWO.replace('"load-sharing"', '"transmission-error"').replace(
        'compliance = { source = "weber-banaschek" }\n', ""
    )
    scene = scene_of(Asked(text + "[accuracy]\ntolerance = 0.05\n", "c", str(tmp_path)))
    plan = make_plan(scene, STAGES)
    cache = SolutionCache()
    whole = run_plan(scene, plan, cache=cache)
    quick = run_plan(replace(scene, estimates=False), plan, cache=cache)
    assert [one.name for one in quick.values] == [one.name for one in whole.values]
    assert [one.si for one in quick.values] == pytest.approx([one.si for one in whole.values], rel=5e-3)
    mean = [name.endswith("te_mean") for name in (one.name for one in whole.values)].index(True)
    assert quick.values[mean].si == pytest.approx(whole.values[mean].si, rel=1e-4)
    assert any(one.si_error for one in whole.values)
    assert not any(one.si_error for one in quick.values)


def test_root_stress_while_a_value_moves_is_that_of_the_positions(tmp_path):
    text = TWO.replace('"load-sharing"', '"root-stress-history"').replace(
        'compliance = { source = "weber-banaschek" }\n', ""
    )
    scene = scene_of(Asked(text + "[accuracy]\ntolerance = 0.05\n", "c", str(tmp_path)))
    plan, cache = make_plan(scene, STAGES), SolutionCache()
    whole, quick = (run_plan(replace(scene, estimates=asked), plan, cache=cache) for asked in (True, False))
    largest = [one.name for one in whole.values if ".largest_root_" in one.name]
    assert len(largest) == 4
    for name in largest:
        # its positions are others: one may be nearer to a peak than the search of the run at rest comes
        assert 0.99 < quick.values[name].si / whole.values[name].si < 1.0 + 1e-6, name


@pytest.mark.dear
def test_designed_reliefs_remove_the_transmission_error(computing, tmp_path):
    made, heard = computing
    text = TWO.replace('"load-sharing"', '"transmission-error"')

    def swing(text):
        scene = scene_of(Asked(text, "c", str(tmp_path)))
        return run_plan(scene, make_plan(scene, STAGES)).values["I.te_peak_to_peak"].si

    before, left = swing(text), {}
    for number, how in ((49, "exact"), (50, "ground")):
        made.ask(Design(number, Asked(text, "c", str(tmp_path)), "I", how))
        content = heard.until(number, "designed", "refused").content
        assert sorted(content["reliefs"]) == ["a", "b"]
        json.dumps(content, allow_nan=False)
        assert [one["key"] for one in content["figures"]] == ["designed-relief_I", "designed-relief_candidates_I"]
        bench = Bench(None)
        bench.desk = Desk(text, "c", tmp_path)
        bench._take_reliefs(content["reliefs"])
        assert bench.desk.refusal is None
        assert bench.pinned.text == text  # what was there before is held against it
        left[how] = swing(bench.desk.text)
        bench.desk.undo()
        assert bench.desk.text == text
    # Tables are read with straight lines; what can be ground leaves what the search says that it does.
    assert left["exact"] < 0.03 * before
    assert left["exact"] < left["ground"] < 0.5 * before
    told = float(content["told"].split("transmission error ")[1].split(" um")[0])
    assert told == pytest.approx(left["ground"] * 1e6, rel=0.01)


def test_a_relief_that_cannot_be_designed_is_refused_in_one_sentence(computing, tmp_path):
    made, heard = computing
    none = TWO.replace('"load-sharing"', '"transmission-error"') + "[design]\ngrind = []\n"
    made.ask(Design(52, Asked(none, "c", str(tmp_path)), "I", "ground"))
    assert (
        "design.grind = []: contains no grindable shape" in heard.until(52, "designed", "refused").content["sentence"]
    )
    made.ask(Design(51, Asked(TEXT, "c", str(tmp_path)), "I"))
    assert "is also the driver; the design needs separate" in heard.until(51, "designed", "refused").content["sentence"]


def test_of_many_changes_the_last_is_computed_and_those_before_are_given_up(computing, tmp_path):
    made, heard = computing
    for number in range(10, 18):
        made.ask(Compute(number, Asked(TEXT.replace("28", str(number + 10)), "c", str(tmp_path))))
    heard.until(17, "done")
    finished = [said.number for said in heard.all if said.what == "done" and said.number >= 10]
    assert finished[-1] == 17
    assert len(finished) <= 2
    for _ in range(1200):  # what is forgotten in there would end the process later
        if not made._open:
            break
        time.sleep(0.05)
    assert made._open == {}


def test_while_a_value_moves_what_it_is_moved_for_is_found_and_the_rest_when_it_stands_still(computing, tmp_path):
    made, heard = computing
    text = TEXT.replace('["load-sharing"]', '["geometry", "load-sharing"]')
    asked = Asked(text, "c", str(tmp_path), moving=True)
    for number in range(600, 620, 2):
        made.ask(Compute(number, asked))
        while heard.until(number, "found").content["task"] != "load-sharing of I":
            pass
        made.ask(Compute(number + 1, asked._replace(text=text.replace("5 kN", "6 kN"))))
        if heard.until(number, "dropped", "done").what == "dropped":
            break  # on a busy machine this process may be too slow to move the value before it counts as standing still
    else:
        raise AssertionError("the rest was computed each time although the value moved on")
    heard.until(number + 1, "done")
    found = [(said.number, said.content["task"]) for said in heard.all if said.what == "found"]
    assert [task for of, task in found if of == number][-1] == "load-sharing of I"
    assert [task for of, task in found if of == number + 1][-2:] == ["load-sharing of I", "geometry"]
    # what is the same as before is not sent again, and a page that opens later is shown it all the same
    geometry = [s.content for s in heard.all if s.what == "found" and s.content["task"] == "geometry"]
    made.ask(Compute(630, asked._replace(moving=False)))
    heard.until(630, "done")
    again = next(s.content for s in heard.all if s.number == 630 and s.content.get("task") == "geometry")
    assert geometry[-1]["figures"]
    assert [one.get("same") for one in again["figures"]] == [True] * len(geometry[-1]["figures"])
    assert whole(again, geometry[-1])["figures"] == geometry[-1]["figures"]


@pytest.mark.dear("load-distribution", "load-sharing")
@pytest.mark.parametrize("result", ["load-distribution", "load-sharing"])
def test_a_glance_at_a_pair_with_a_width_refuses_nothing_that_the_case_has(tmp_path, result):
    """Load over the face and load sharing both tell the largest pressure: one of them stands beside the other."""
    text = TWO.replace('compliance = { source = "weber-banaschek" }', 'width = "slices"').replace(
        "load-sharing", result
    )
    text += "[load_distribution]\npositions = 6\npanels = 4\n[accuracy]\ntolerance = 0.1\n"
    scene = scene_of(Asked(text, "c", str(tmp_path)))
    plan = plan_with(scene, glance_tasks(scene, ("sharing", "line-load", "te")), [Task("load-sharing", "I")])
    cache = SolutionCache()
    found, own = (run_plan(scene, one, cache=cache) for one in (plan, make_plan(scene, STAGES)))
    for task, outcome in own.outcomes.items():
        assert found.outcomes[task].values == outcome.values
    names = {name for outcome in found.outcomes.values() for name in numbers_of(outcome.values)}
    assert gears_in_mesh(scene, "I")["wide"]
    assert {"I.te_peak_to_peak", "I.largest_hertz_pressure", "I.driver.largest_root_tension"} <= names


def test_answers_come_before_what_is_in_sight_and_that_before_the_rest(tmp_path):
    results = '["geometry", "tooth-geometry-check", "relief-curves", "load-sharing"]'
    scene = scene_of(Asked(TEXT.replace('["load-sharing"]', results), "c", str(tmp_path)))
    plan = make_plan(scene, STAGES)
    assert {"geometry", "relief-curves of I"} <= {str(step.task) for step in plan.steps}

    def order(sight, seconds=None):
        found = in_order(plan, scene, sight, seconds or {})
        names = [step.task.stage for step in found.plan.steps]
        assert sorted(names) == sorted(step.task.stage for step in plan.steps)
        for number, step in enumerate(found.plan.steps):  # each behind what it needs
            assert set(step.stage.needs(scene, step.task.subject)) <= {s.task for s in found.plan.steps[:number]}
        return names[: found.at_once], names[found.at_once :]

    assert order(())[0] == ["loaded-pair", "load-sharing"]
    assert order(("geometry",))[1][0] == "geometry"
    assert order(("geometry",), {"geometry": 0.01})[0] == ["loaded-pair", "load-sharing", "geometry"]
    assert order(("geometry",), {"geometry": 1.0})[0] == ["loaded-pair", "load-sharing"]
    # what small pictures show is always in sight, however long it takes
    pictured = in_order(plan, scene, (), {"geometry": 1.0}, [Task("geometry", "")])
    assert [step.task.stage for step in pictured.plan.steps[: pictured.at_once]].count("geometry") == 1
    scene = scene_of(Asked(TEXT.replace('["load-sharing"]', '["geometry", "relief-curves"]'), "c", str(tmp_path)))
    plan = make_plan(scene, STAGES)
    assert order(("geometry",))[0] == ["geometry"]
    assert order(()) == ([step.task.stage for step in plan.steps], [])


def _count(most):
    while most:
        most -= 1


def drafted(folder, text, *known):
    """The draft of a case whose gears are known as far as some scenes have them."""
    scene, cache = scene_of(Asked(text, "c", str(folder))), SolutionCache()
    for one in known:
        for step in make_plan(one, STAGES).steps:
            if step.stage.name == "gear-solution":
                cache.solve(key_without_needs(one, step), lambda: "solved")
    return draft_of(scene, make_plan(scene, STAGES), cache, lambda scene: make_plan(scene, STAGES))


def test_a_gear_that_has_to_be_solved_anew_is_answered_from_an_atlas_first(tmp_path):
    text = TEXT.replace("weber-banaschek", "fe")
    draft = partial(drafted, tmp_path)
    found = draft(text)
    assert [step.task.stage for step in found.plan.steps] == ["atlas-gear", "loaded-pair", "load-sharing"]
    assert (found.scene.previews, found.scene.drafts, found.scene.estimates) == ({"a"}, {}, False)
    assert found.told == ("Preview: gear a interpolated from an atlas (no error estimate); result with 0.001 follows.")
    scene = scene_of(Asked(text, "c", str(tmp_path)))
    assert draft(text, scene) is None  # the gear is known, as where only the load changes
    assert draft(TEXT) is None  # a formula needs none
    assert draft(text.replace("load-sharing", "stiffness")) is None  # nothing that would come before the rest
    assert draft(f"{text}[accuracy]\nflank_edge_length = 0.08\n").scene.previews == {"a"}
    # an atlas answers about one of two gears, the other one is drafted
    two = text.replace('driven = "a"', 'driven = "b"') + (
        '[gear.b]\nteeth = 31\nmodule = "3 mm"\nface_width = "20 mm"\nrack = { tip_radius = 0.2 }\n'
    )
    found = draft(two)
    assert (found.scene.previews, list(found.scene.drafts)) == ({"a"}, ["b"])
    assert "gear a interpolated from an atlas, others with tolerance 0.0032 (no" in found.told
    stages = [step.task.stage for step in found.plan.steps]
    assert stages == ["atlas-gear", "gear-solution", "loaded-pair", "load-sharing"]


def test_while_a_tooth_moves_its_gear_comes_from_an_atlas(tmp_path):
    text = TEXT.replace("weber-banaschek", "fe")
    scene = scene_of(Asked(text, "c", str(tmp_path), moving=True))
    plan = make_plan(scene, STAGES)
    anew = anew_of(scene, plan, SolutionCache())
    assert [step.task.subject for step in anew] == ["a"]
    moved = with_previews(scene, anew)
    assert moved.previews == {"a"}
    assert next(step.task.stage for step in make_plan(moved, STAGES).steps) == "atlas-gear"
    assert preview_told(moved) == "Preview: gear a interpolated from an atlas"
    assert preview_told(with_previews(scene, ())) == ""


@pytest.mark.dear
def test_while_a_tooth_moves_a_gear_that_no_atlas_has_is_solved_on_a_coarse_mesh(tmp_path):
    text = TEXT.replace("weber-banaschek", "fe")
    high = text.replace("teeth = 28", "teeth = 28\nprofile_shift = 0.9")
    two = high.replace('driven = "a"', 'driven = "b"') + '[gear.b]\nteeth = 31\nmodule = "3 mm"\nface_width = "20 mm"\n'

    def moved(text, before=frozenset()):
        scene = scene_of(Asked(text, "c", str(tmp_path), moving=True))
        return previewed(scene, lambda scene: make_plan(scene, STAGES), SolutionCache(), before)[0]

    def said(text):
        scene = moved(text)
        return scene.drafts, preview_told(scene)

    assert said(text) == ({}, "Preview: gear a interpolated from an atlas")
    assert said(high) == ({"a": 0.05}, "Preview with tolerance 0.05")
    assert said(two) == ({"a": 0.05}, "Preview: gear b interpolated from an atlas, others with tolerance 0.05")
    assert moved(two, frozenset({"b"})).drafts == {"a": 0.05}  # the gears of the move before are not all
    assert said(f"{high}[accuracy]\ntolerance = 0.08\n")[0] == {"a": 0.08}
    assert said(f"{high}[accuracy]\nflank_edge_length = 0.08\n") == ({}, "")  # solved with those settings

    def numbers(scene):
        results = run_plan(scene, make_plan(scene, STAGES, [Task("root-stress-history", "I")]), cache=SolutionCache())
        wanted = ("I.te_peak_to_peak", "I.driver.largest_root_tension")
        return np.array([results.values[name].si for name in wanted if name in results.values])

    text = high.replace('["load-sharing"]', '["transmission-error"]')
    for teeth, shift in ((28, 0.9), (11, 0.4)):
        rough = moved(text.replace("teeth = 28", f"teeth = {teeth}").replace("0.9", str(shift)))
        assert list(rough.drafts) == ["a"]
        values, exact = numbers(rough), numbers(replace(rough, drafts={}))
        assert values.size == 2
        assert np.abs(values / exact - 1.0).max() < 1e-2
        assert (values != exact).all()


def test_a_gear_outside_the_atlases_is_answered_by_a_draft_first(tmp_path):
    text = TEXT.replace("weber-banaschek", "fe").replace("[pair.I]", "rack = { tip_radius = 0.2 }\n[pair.I]")
    draft = partial(drafted, tmp_path)
    found = draft(text)
    assert [step.task.stage for step in found.plan.steps] == ["gear-solution", "loaded-pair", "load-sharing"]
    assert found.scene.drafts == {"a": pytest.approx(3.2e-3)}
    assert not found.scene.previews
    assert not found.scene.estimates
    assert found.told == "Preview with tolerance 0.0032 (no error estimate); result with 0.001 follows."
    assert draft(f"{text}[accuracy]\ntolerance = 0.01\n") is None
    assert draft(f"{text}[accuracy]\ntolerance = 1e-4\n").scene.drafts == {"a": pytest.approx(3.2e-3)}
    assert draft(f"{text}[accuracy]\nflank_edge_length = 0.08\n") is None  # solved with those settings

    # of two gears the changed one alone is drafted; its mate is taken as it is
    two = text.replace('driven = "a"', 'driven = "b"') + '[gear.b]\nteeth = 31\nmodule = "3 mm"\nface_width = "20 mm"\n'
    before, after = (scene_of(Asked(one, "c", str(tmp_path))) for one in (two, two.replace("28", "29")))
    found = draft(two.replace("28", "29"), before)
    assert list(found.scene.drafts) == ["a"]
    keys = {
        (name, step.task.subject): key_without_needs(scene, step)
        for name, scene in (("before", before), ("after", after), ("draft", found.scene))
        for step in make_plan(scene, STAGES).steps
        if step.stage.name == "gear-solution"
    }
    assert keys["before", "b"] == keys["draft", "b"] == keys["after", "b"]
    assert len({keys["before", "a"], keys["draft", "a"], keys["after", "a"]}) == 3


def test_nothing_is_computed_while_only_one_of_two_gears_has_the_new_pressure_angle(tmp_path):
    path, jobs = tmp_path / "c.toml", []
    other = '[gear.b]\nteeth = 31\nmodule = "3 mm"\nface_width = "20 mm"\n'
    path.write_text(TEXT.replace('driven = "a"', 'driven = "b"') + other)
    bench = Bench(path, SimpleNamespace(ask=jobs.append))
    for gear, refused in (("a", True), ("b", False)):
        bench.desk.set(("gear", gear, "pressure_angle"), '"21 deg"')
        bench.changed()
        assert (bench.desk.refusal is not None) == refused
    assert len(jobs) == 1
    assert jobs[0].asked.text.count("21 deg") == 2


def test_the_draft_of_a_gear_is_its_solution_on_a_coarser_mesh(tmp_path):
    text = TEXT.replace("weber-banaschek", "fe").replace("[pair.I]", "rack = { tip_radius = 0.2 }\n[pair.I]")
    text = f"{text}[accuracy]\ntolerance = 5e-3\n"
    scene, cache = scene_of(Asked(text, "c", str(tmp_path))), SolutionCache()
    plan, solution = make_plan(scene, STAGES), Task("gear-solution", "a")
    draft = draft_of(scene, plan, cache, lambda scene: make_plan(scene, STAGES))

    def solved(scene, plan, cache):
        alone = replace(plan, steps=tuple(step for step in plan.steps if step.task == solution))
        return run_plan(scene, alone, cache=cache).outcomes[solution].data

    drafted, whole = (solved(one, draft.plan, cache) for one in (draft.scene, scene))
    assert drafted.coarse is None
    assert drafted.settings.root_edge_length > whole.settings.root_edge_length
    assert drafted.fine.unknowns < whole.fine.unknowns
    assert cache.shapes.computed == 1  # the draft's goes to no disk
    undrafted = solved(scene, plan, SolutionCache())
    assert np.array_equal(whole.fine.compliance[1], undrafted.fine.compliance[1])
    assert dict(whole.rounds[0].errors) == dict(undrafted.rounds[0].errors)
    assert draft_of(scene, plan, cache, lambda scene: make_plan(scene, STAGES)) is None


@pytest.mark.long
def test_a_draft_is_told_as_one_and_replaced(computing, tmp_path):
    made, heard = computing
    made.ask(Compute(70, Asked(TEXT.replace("weber-banaschek", "fe"), "c", str(tmp_path))))
    heard.until(70, "done")
    drafts = [
        bool(said.content["draft"])
        for said in heard.all
        if said.number == 70 and said.what == "found" and said.content["task"] == "load-sharing of I"
    ]
    assert drafts == [True, False]


def test_what_is_no_longer_wanted_is_given_up_between_two_steps_of_a_long_computation(monkeypatch):
    ours, theirs = Pipe()
    inbox = Inbox(theirs)
    before = signal.getsignal(inbox_module._KNOCK)
    try:
        monkeypatch.setattr(inbox_module, "_OWN", str(Path(__file__).parent))
        inbox.open()
        inbox.watch(lambda _job: False, _count.__code__)
        ours.send(Compute(1, Asked("", "c", "")))
        end = time.monotonic() + 0.2
        while time.monotonic() < end:  # wanted still
            _count(10_000)
        inbox.watch(lambda _job: True, _count.__code__)
        end = time.monotonic() + 0.2
        while time.monotonic() < end:  # not where it could be given up: what follows an end is not torn apart
            pass
        with pytest.raises(Unwanted):
            _count(10**10)
        inbox.watch(None)
        ours.send(Compute(2, Asked("", "c", "")))  # the first is not wanted any more
        assert (ours.recv().what, inbox.take().number) == ("dropped", 2)
    finally:
        ours.close()
        signal.signal(inbox_module._KNOCK, before)


def test_a_case_that_is_refused_while_it_computes_says_where(computing, tmp_path):
    made, heard = computing
    made.ask(Compute(20, Asked(TEXT.replace("28", "4"), "c", str(tmp_path))))
    said = heard.until(20, "refused", "done")
    assert (said.what, said.content["key"]) == ("refused", "gear.a.teeth")


@pytest.mark.long
def test_an_export_is_finished_whatever_is_asked_meanwhile(computing, tmp_path):
    made, heard = computing
    made.ask(Export(30, Asked(TEXT, "c", str(tmp_path)), "drawings", str(tmp_path / "out")))
    made.ask(Compute(31, Asked(TEXT, "c", str(tmp_path))))
    assert heard.until(30, "exported", "dropped", "refused").what == "exported"
    heard.until(31, "done")
    assert any(one.suffix == ".dxf" for one in (tmp_path / "out").iterdir())


def test_what_a_killed_server_left_is_removed_by_the_next_and_nothing_else(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    alive = Scratch()
    killed = Scratch()
    (killed.folder / "ab").mkdir()
    (killed.folder / "ab" / "x.entry").write_bytes(b"x")
    killed._held.close()  # as the system does
    for name in ("fegear-open-other", "something"):
        (tmp_path / name).mkdir()
    (tmp_path / "fegear-open-link").symlink_to(tmp_path / "something")
    assert sweep() == [killed.folder]
    left = {path.name for path in tmp_path.iterdir()}
    assert left == {alive.folder.name, "fegear-open-other", "something", "fegear-open-link"}
    alive.remove()
    assert not alive.folder.exists()


@pytest.mark.parametrize("life", ["while True: path.mkdir(parents=True, exist_ok=True)", "connection.poll(None)"])
def test_a_process_whose_parent_is_killed_ends_and_clears_away_after_it(tmp_path, life):
    """Whether it goes on writing or ends by itself because nobody speaks to it any more."""
    (tmp_path / "busy.py").write_text(
        "import os, pathlib\n"
        "def serve(connection, scratch):\n"
        "    path = pathlib.Path(scratch, 'ab')\n"
        "    path.mkdir(parents=True)\n"
        "    connection.send(os.getpid())\n"
        f"    {life}\n"
    )
    scratch = tmp_path / "scratch"
    parent = subprocess.Popen(
        [sys.executable, "-c", ("import multiprocessing, sys; from fegear.engine.processes import start_process\n"
         "ours, theirs = multiprocessing.Pipe()\n"
         "start_process('busy', theirs, sys.argv[1]); print(ours.recv(), flush=True); input()"), str(scratch)],
        env=os.environ | {"PYTHONPATH": str(tmp_path)}, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    with parent:
        pid = int(parent.stdout.readline())
        parent.kill()
    end = time.monotonic() + 20.0
    while scratch.exists() or (
        Path(f"/proc/{pid}/stat").exists() and " Z " not in Path(f"/proc/{pid}/stat").read_text()
    ):
        assert time.monotonic() < end
        time.sleep(0.01)


def test_a_process_that_takes_long_to_load_is_not_replaced_by_one_that_takes_as_long(tmp_path, monkeypatch):
    (tmp_path / "slow.py").write_text(
        "import time\n"
        "from fegear.window.job_queue import Said\n"
        "import pathlib\n"
        f"while not pathlib.Path({str(tmp_path / 'loaded')!r}).exists(): time.sleep(0.01)\n"
        "def serve(connection, scratch):\n"
        "    while True:\n"
        "        connection.send(Said(connection.recv().number, 'done'))\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("fegear.window.computing._WORKER", "slow")
    monkeypatch.setattr("fegear.window.computing.PATIENCE", 0.02)
    looked, insist = [], Computing._insist
    monkeypatch.setattr(Computing, "_insist", lambda self: (looked.append(1), insist(self)))
    heard = Heard()
    made = Computing()
    try:
        made.hear = heard
        pid = made.pid
        for number in (1, 2, 3):
            made.ask(Compute(number, Asked(TEXT, "c", str(tmp_path))))
        end = time.monotonic() + 60.0
        while len(looked) < 3:  # it has been unwanted for longer than anybody is patient, and again
            assert time.monotonic() < end
            time.sleep(0.01)
        monkeypatch.setattr("fegear.window.computing.PATIENCE", 60.0)  # however slow this machine is from now on
        (tmp_path / "loaded").touch()
        heard.until(3, "done")
        assert made.pid == pid
    finally:
        made.close()


def test_what_is_moved_by_hand_while_the_text_is_no_toml_is_refused_in_words(monkeypatch, tmp_path):
    from nicegui import ui

    from fegear.window.bench import Bench
    from fegear.window.page import Page

    told = []
    monkeypatch.setattr(ui, "notify", lambda words, **_: told.append(words))
    bench = Bench(None)
    bench.desk = Desk("a = [", "c", tmp_path)
    Page._by_hand(lambda: bench.move_load("I", "load", "3 kN", moving=True))
    Page._by_hand(lambda: bench.move_relief("a", "tip", 26.0, 5.0, moving=True))
    assert len(told) == 2
    assert all("valid TOML: " in one and "orrect the text first" in one for one in told)


def test_a_fault_of_fegear_is_said_to_be_one_and_the_next_case_is_computed(computing):
    made, heard = computing
    made.ask(Compute(38, Asked(TEXT, "c", None)))
    assert "Internal error in fegear (TypeError: " in heard.until(38, "refused").content["sentence"]
    made.ask(Compute(39, Asked(TEXT, "c", ".")))
    heard.until(39, "done")


@pytest.mark.dear
def test_a_process_that_dies_is_replaced_and_says_so(computing, tmp_path):
    made, heard = computing
    made.ask(Compute(40, Asked(TEXT.replace("weber-banaschek", "fe"), "c", str(tmp_path))))
    heard.until(40, "begin")
    pid = made.pid
    os.kill(pid, 9)
    assert "Computation terminated unexpectedly (out of" in heard.until(40, "refused").content["sentence"]
    made.ask(Compute(41, Asked(TEXT, "c", str(tmp_path))))
    heard.until(41, "done")
    assert made.pid != pid


def test_a_figure_out_of_sight_stays_as_it_is_until_all_is_at_rest():
    sent = Sent()
    content = {"task": "t", "values": "", "loads": None, "figures": [{"key": "k", "data": 1}]}
    assert not sent.knows("t", "k")
    assert sent.news(content) == content
    assert sent.knows("t", "k")
    waiting = {**content, "figures": [{"key": "k", **SAME}]}
    assert sent.news(waiting) == waiting
    assert whole(waiting, content) == content
    moved = {**content, "figures": [{"key": "k", "data": 2}]}
    assert sent.news(moved) == moved
    assert sent.news(content) == content  # back where it was, which no page has any more


class Typed:
    """A text field of a page, and what lies on the desk."""

    def __init__(self, desk):
        self.desk, self.value, self.changes = desk, desk.text, 0

    def set_value(self, text):
        self.value = text

    def changed(self):
        self.changes += 1


def test_text_that_is_being_typed_outlives_the_change_of_another_page(tmp_path):
    """It was overwritten: the server hears of it when nobody has typed for half a second."""
    page = object.__new__(Inputs)
    field = Typed(Desk(TEXT, "c", tmp_path))
    page._bench = page._text = field
    page._shown, page._typing = TEXT, 0.0

    async def both():
        page._begun()
        field.desk.change(TEXT.replace("28     # z", "31     # z"))  # by the form of another page
        page._refresh_text()
        assert field.value == TEXT
        typed = TEXT.replace('title = "x"', 'title = "mine"')
        page._text_typed(SimpleNamespace(value=typed))
        assert field.desk.text == field.value == typed.replace("28     # z", "31     # z")
        field.desk.change(TEXT)
        page._refresh_text()  # nobody types any more
        assert field.value == TEXT

    asyncio.run(both())
    assert field.changes == 1


def test_long_texts_are_merged_at_once():
    """A line that stands there thousands of times was compared with each of them."""
    base = "teeth = 20\n" * 20_000
    started = time.process_time()
    assert merged(base, f"{base}x\n", base) == f"{base}x\n"
    assert merged(base, f"{base}x\n", f"y\n{base}") == f"y\n{base}x\n"
    assert merged(base, base.replace("20", "21"), base.replace("20", "22")) == base.replace("20", "21")
    assert time.process_time() - started < 2.0


@pytest.mark.parametrize(
    ("mine", "theirs", "both"),
    [
        ("a\nb\nc\nD\n", "A\nb\nc\nd\n", "A\nb\nc\nD\n"),
        ("a\nb\nx\nc\nd\n", "a\nz\nb\nc\nD\n", "a\nz\nb\nx\nc\nD\n"),
        ("A\nb\nc\nd\n", "Z\nb\nc\nd\n", "A\nb\nc\nd\n"),  # the same line: who typed last
        ("a\nb\nc\nd\n", "Z\nb\nc\nd\n", "Z\nb\nc\nd\n"),
        ("a\nc\nd\n", "a\nb\nc\nd\ne\n", "a\nc\nd\ne\n"),
    ],
)
def test_two_texts_of_one_are_merged_by_lines(mine, theirs, both):
    assert merged("a\nb\nc\nd\n", mine, theirs) == both


@pytest.mark.parametrize("loaded", [False, True])
def test_who_insists_waits_anew_for_a_process_that_loads_and_replaces_one_that_computes(loaded, monkeypatch):
    began, ended = [], []
    made = object.__new__(Computing)
    made._lock, made._closed, made._timer, made._loaded = threading.Lock(), False, None, loaded
    now = time.monotonic()
    made._open = {1: "old", 2: "new"}
    made._unwanted = {1: now - 1000.0}
    made._process, made._connection = "process", SimpleNamespace(send=began.append)
    monkeypatch.setattr("fegear.window.computing.end", ended.append)
    monkeypatch.setattr(made, "_start", lambda: began.append("start"), raising=False)
    made._insist()
    if loaded:
        assert ended == ["process"]
        assert began == ["start", "new"]
        assert made._open == {2: "new"}
        assert made._unwanted == {}
        assert made._timer is None
    else:
        assert (ended, began) == ([], [])
        assert list(made._unwanted) == [1]
        assert made._unwanted[1] == pytest.approx(now, abs=60.0)
        assert made._timer.interval == pytest.approx(PATIENCE, abs=1.0)
        made._timer.cancel()
