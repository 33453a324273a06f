"""The window's elements without a server: form, text, bar and page built in this process, pressed and read."""

from __future__ import annotations

import asyncio
import json
import math
import re
import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest

pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")

from nicegui import Client, core, ui
from nicegui.events import GenericEventArguments, handle_event
from nicegui.page import page as ui_page

from fegear.base.errors import InputError
from fegear.output.export_formats import formats
from fegear.results.gear.drawing import moving_pair
from fegear.window import messages
from fegear.window import page as page_module
from fegear.window.bar import Bar, exports
from fegear.window.beginnings import JOBS, examples
from fegear.window.bench import LEVELS, Bench
from fegear.window.document import Desk
from fegear.window.drag_handles import hands_of
from fegear.window.first_drawing import first_drawing
from fegear.window.glance import View
from fegear.window.inputs import Inputs, stepped
from fegear.window.messages import Messages, _moved, checked
from fegear.window.page import Page

TEXT = """title = "x"
results = ["load-sharing"]
[gear.a]
teeth = 28     # z
module = "3 mm"
face_width = "20 mm"
plane = "stress"
[pair.I]
driver = "a"
driven = "a"
load = "5 kN"
compliance = { source = "weber-banaschek" }
[effects]
neighbour_coupling = false
"""
TEETH, MODULE, PLANE = ("gear", "a", "teeth"), ("gear", "a", "module"), ("gear", "a", "plane")
COUPLING, RESULTS, LOAD = ("effects", "neighbour_coupling"), ("results",), ("pair", "I", "load")


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))


@pytest.fixture
def client(monkeypatch):
    """A page that nobody looks at; `said` are notices on it."""
    loop = asyncio.new_event_loop()
    monkeypatch.setattr(core, "loop", loop)
    asyncio.set_event_loop(loop)
    made = Client(ui_page("/tested"), request=None)
    made.said, made.scripts = [], []
    monkeypatch.setattr(ui, "notify", lambda words, **_: made.said.append(words))
    monkeypatch.setattr(made, "run_javascript", lambda script, **_: made.scripts.append(script))
    with made:
        yield made
    made.delete()
    loop.run_until_complete(asyncio.sleep(0))
    asyncio.set_event_loop(None)
    loop.close()


@pytest.fixture
def bench(tmp_path):
    """What the elements see of the bench, with the number of changes that it was told."""
    made = SimpleNamespace(desk=Desk(TEXT, "c", tmp_path), level="normal", pinned=None, changes=0, asked=[])

    def changed():
        made.changes += 1

    made.changed = changed
    made.pin = lambda: setattr(made, "pinned", True)
    made.unpin = lambda: setattr(made, "pinned", None)
    made.lay = lambda desk: made.asked.append(("lay", desk))
    made.export = lambda what, target: made.asked.append((what, target))
    return made


def press(element, kind="click", args=None):
    """Have an element hear of an event as the framework does."""
    event = GenericEventArguments(sender=element, client=element.client, args=args)
    heard = [one for one in element._event_listeners.values() if one.type == kind]
    assert heard
    for one in heard:
        handle_event(one.handler, event)


def button(client, text):
    (found,) = [one for one in client.elements.values() if isinstance(one, ui.button) and one.text == text]
    return found


def typed(inputs, path, text):
    inputs._elements[path].set_value(text)
    press(inputs._elements[path], "keydown.enter")


# ---- form ------------------------------------------------------------------------------------------------------------
def test_each_key_has_a_field_of_its_kind(client, bench):
    inputs = Inputs(bench)
    made = {path: type(element) for path, element in inputs._elements.items()}
    assert made[TEETH] is ui.input
    assert made[PLANE] is ui.select
    assert made[COUPLING] is ui.switch
    assert made[RESULTS] is ui.select
    values = {path: inputs._elements[path].value for path in (TEETH, MODULE, PLANE, COUPLING, RESULTS, LOAD)}
    assert values == {
        TEETH: "28", MODULE: "3 mm", PLANE: "stress", COUPLING: False, RESULTS: ["load-sharing"], LOAD: "5 kN",
    }  # fmt: skip
    teeth = inputs._elements[TEETH]
    assert teeth.props["data-key"] == "gear.a.teeth"
    assert teeth.props["hint"] == teeth.props["title"] == "Number of teeth, 5 to 1000. A whole number"
    assert "hint" not in inputs._elements[COUPLING].props
    assert "given" in teeth.classes
    assert "absent" not in teeth.classes
    assert "" in inputs._elements[PLANE].options
    assert inputs._elements[PLANE].options["stress"] == "stress"
    assert inputs._elements[RESULTS].multiple
    assert bench.changes == 0


def test_keys_with_their_defaults_come_when_somebody_looks(client, bench):
    inputs = Inputs(bench)
    path = ("gear", "a", "pressure_angle")
    assert path not in inputs._elements
    fold = inputs._places[path]
    count = sum(place is fold for place in inputs._places.values())
    assert fold.text == f"{count} further keys (defaults)"
    fold.set_value(True)
    angle = inputs._elements[path]
    assert (angle.value, angle.props["placeholder"], angle.props["stack-label"]) == ("", "20 deg", True)
    assert "absent" in angle.classes
    number = len(inputs._elements)
    fold.set_value(False)
    fold.set_value(True)
    assert inputs._elements[path] is angle
    assert len(inputs._elements) == number
    # A step begins at the default.
    press(angle, "keydown.up.prevent", {"shiftKey": False})
    assert angle.value == "21 deg"
    assert tomllib.loads(bench.desk.text)["gear"]["a"]["pressure_angle"] == "21 deg"


def test_what_is_typed_is_in_the_case_and_comments_stay(client, bench):
    inputs = Inputs(bench)
    typed(inputs, TEETH, "31")
    assert "teeth = 31     # z" in bench.desk.text
    assert bench.changes == 1
    typed(inputs, TEETH, "31")
    assert bench.changes == 1 or "teeth = 31" in bench.desk.text
    inputs.hear("changed", {})
    press(inputs._elements[TEETH], "blur")
    assert bench.changes <= 2
    typed(inputs, MODULE, "4 mm")
    assert tomllib.loads(bench.desk.text)["gear"]["a"]["module"] == "4 mm"
    inputs._elements[PLANE].set_value("")
    assert "plane" not in tomllib.loads(bench.desk.text)["gear"]["a"]
    inputs._elements[COUPLING].set_value(True)
    assert tomllib.loads(bench.desk.text)["effects"]["neighbour_coupling"] is True
    inputs._elements[RESULTS].set_value(["load-sharing", "transmission-error"])
    assert tomllib.loads(bench.desk.text)["results"] == ["load-sharing", "transmission-error"]


def test_arrow_keys_step_by_one_unit_of_the_last_digit_and_by_ten(client, bench):
    inputs = Inputs(bench)
    load = inputs._elements[LOAD]
    for key, shift, wanted in (
        ("up", False, "6 kN"),
        ("down", True, "-4 kN"),
        ("down", False, "-5 kN"),
        ("up", True, "5 kN"),
    ):
        press(load, f"keydown.{key}.prevent", {"shiftKey": shift})
        assert load.value == wanted
        inputs.hear("changed", {})
    assert bench.changes == 4
    press(load, "keydown.up.prevent", "nonsense")
    assert load.value == "6 kN"
    assert stepped("0.30", -1) == "0.29"
    assert stepped("2", 10) == "12"
    assert stepped("-1.05e-3 mm", 1) == stepped("-1.05e-3 mm", 1)
    assert stepped("gear", 1) is None


@pytest.mark.dear
def test_a_number_that_is_dragged_is_one_stroke_and_what_is_none_is_not_taken(client, tmp_path):
    bench = Bench(None)
    bench.desk = Desk(TEXT, "c", tmp_path)
    inputs = Inputs(bench)
    teeth = inputs._elements[TEETH]
    assert {"scrubs", "whole"} <= set(teeth.classes)
    assert "scrubs" in inputs._elements[LOAD].classes
    assert "whole" not in inputs._elements[LOAD].classes
    for text in ("29", "30", "31"):
        before = teeth.value
        inputs.move("gear.a.teeth", text, moving=text != "31")
        # On its way the page that is dragged in shows the number; to hear it from here would draw the whole form anew.
        assert teeth.value == (text if text == "31" else before)
        assert f"teeth = {text}" in bench.desk.text
    assert "teeth = 31     # z" in bench.desk.text
    inputs.hear("changed", {})
    press(teeth, "blur")  # confirms what is there already
    assert "teeth = 31     # z" in bench.desk.text
    bench.desk.undo()
    assert bench.desk.text == TEXT
    inputs.move("pair.I.load", "5.5 kN", moving=False)
    assert tomllib.loads(bench.desk.text)["pair"]["I"]["load"] == "5.5 kN"
    before = bench.desk.text
    for key, text in (("gear.a.teeth", ""), ("gear.a.teeth", "x"), ("gear.b.teeth", "3"), ("results", "3"),
                      ("effects.neighbour_coupling", "3"), ("gear.a.teeth", "3" * 4_000_000)):  # fmt: skip
        with pytest.raises(InputError):
            inputs.move(key, text, moving=True)
    assert bench.desk.text == before


def test_the_gears_stand_in_the_page_that_is_served(tmp_path):
    pairs = hands_of(Desk(TEXT, "c", tmp_path).scene)
    mesh = pairs["I"]["mesh"]
    drawn = first_drawing(pairs, View())
    assert drawn.count("<path") == 2
    x, y = re.search(r'class="driver" d="M([-.\d]+),([-.\d]+)L', drawn).groups()
    row = 1e3 * moving_pair(Desk(TEXT, "c", tmp_path).scene.pairs["I"]).driver
    assert (float(x), float(y)) == pytest.approx(row[:, 0], abs=6e-4)
    assert drawn.split('class="driver" d="M')[1].split('"')[0].count(",") == row.shape[1]
    turned = float(re.search(r"rotate\(([-.\d]+) 0 -42", drawn).group(1))
    assert turned == pytest.approx(-math.degrees(mesh["start"] / mesh["driver_base"]), abs=1e-4)
    assert "folded" in first_drawing(pairs, View(folded=True))
    assert first_drawing(pairs, View(middle="I")) == drawn
    assert first_drawing(pairs, View(middle="set P")) == first_drawing(pairs, View(report=True)) == ""
    assert first_drawing({}, View()) == ""
    # the title stands there at once, with or without gears
    assert "<p>Rig &lt;1&gt;: computing …</p>" in first_drawing(pairs, View(), "Rig <1>")
    assert first_drawing({}, View(), "Rig") == '<div id="first-gears"><p>Rig: computing …</p></div>'
    assert first_drawing({}, View(report=True), "Rig") == ""


def test_a_refusal_stands_at_its_field_and_goes_with_its_cause(client, bench):
    inputs = Inputs(bench)
    typed(inputs, TEETH, "2")
    inputs.hear("changed", {})
    teeth = inputs._elements[TEETH]
    assert teeth.props["error"] is True
    assert teeth.props["error-message"] == str(bench.desk.refusal)
    assert inputs._refusal.text == ""
    assert inputs._text_refusal.text == str(bench.desk.refusal)
    typed(inputs, TEETH, "20")
    inputs.hear("changed", {})
    assert not teeth.props.get("error")
    assert inputs._text_refusal.text == inputs._refusal.text == ""
    # What only the computation refuses; of a table: at the nearest field, or above all where there is none.
    inputs.hear("refused", {"sentence": "no room", "key": "gear.a.module.x"})
    assert inputs._elements[MODULE].props["error-message"] == "no room"
    inputs.hear("refused", {"sentence": "nowhere", "key": "pear.b"})
    assert not inputs._elements[MODULE].props.get("error")
    assert inputs._refusal.text == "nowhere"
    inputs.hear("refused", {"sentence": "a switch", "key": "effects.neighbour_coupling"})
    assert inputs._refusal.text == "a switch"


def test_what_cannot_be_typed_is_said_and_not_taken(client, bench):
    inputs = Inputs(bench)
    before = bench.desk.text
    typed(inputs, TEETH, "2" + chr(0xD800))
    assert bench.desk.text == before
    assert bench.changes == 0
    assert inputs._elements[TEETH].props["error"] is True


def test_remarks_of_results_mark_fields_and_the_folds_that_hide_them(client, bench):
    inputs = Inputs(bench)
    bore = ("gear", "a", "bore_radius")
    inputs._warn({bore: "assumed", TEETH: "few"})
    fold = inputs._places[bore]
    assert fold.props["caption"] == "assumed or not specified: bore radius"
    assert "warned" in inputs._elements[TEETH].classes
    assert inputs._elements[TEETH].props["hint"].startswith("few Number of teeth")
    fold.set_value(True)
    assert "warned" in inputs._elements[bore].classes
    inputs._warn({})
    assert fold.props["caption"] == ""
    assert "warned" not in inputs._elements[TEETH].classes
    assert "warned" not in inputs._elements[bore].classes


def test_what_others_change_is_shown_but_not_over_what_is_being_typed(client, bench):
    inputs = Inputs(bench)
    inputs._elements[MODULE].set_value("3.5 m")
    bench.desk.change(TEXT.replace("28", "44").replace("neighbour_coupling = false", "neighbour_coupling = true"))
    inputs.hear("changed", {})
    assert inputs._elements[TEETH].value == "44"
    assert inputs._elements[COUPLING].value is True
    assert inputs._elements[MODULE].value == "3.5 m"
    assert inputs._text.value == bench.desk.text
    bench.desk.change(bench.desk.text.replace('"3 mm"', '"5 mm"'))
    inputs.hear("changed", {})
    assert inputs._elements[MODULE].value == "5 mm"  # this one another has changed
    # Another table: the form is made anew, and what is typed stays.
    inputs._elements[LOAD].set_value("7 k")
    bench.desk.change(bench.desk.text + '[gear.b]\nteeth = 30\nmodule = "5 mm"\nface_width = "20 mm"\n')
    inputs.hear("changed", {})
    assert inputs._elements["gear", "b", "teeth"].value == "30"
    assert inputs._elements[LOAD].value == "7 k"


def test_the_text_is_the_case_and_what_cannot_be_one_stays_in_its_field(client, bench):
    inputs = Inputs(bench)
    inputs._text.set_value(TEXT.replace("28", "29"))
    assert "teeth = 29" in bench.desk.text
    assert bench.changes == 1
    inputs.hear("changed", {})
    assert inputs._elements[TEETH].value == "29"
    inputs._text.set_value(TEXT + chr(0xD800))
    assert "teeth = 29" in bench.desk.text
    assert inputs._text_refusal.text.startswith("Not accepted (kept in this field only): ")
    assert inputs._refusal.text.startswith("Text not accepted: ")
    inputs.hear("changed", {})
    assert inputs._text.value == TEXT + chr(0xD800)
    inputs._text.set_value(TEXT.replace("28", "29"))
    assert inputs._text_refusal.text == inputs._refusal.text == ""
    inputs.leave_too_long()
    assert "characters; move tables to separate files." in inputs._text_refusal.text


def test_what_another_page_changes_waits_for_who_types_and_is_merged(client, bench, monkeypatch):
    monkeypatch.setattr("fegear.window.inputs._PAUSE", 250)
    inputs = Inputs(bench)
    bench.desk.change(TEXT.replace('"5 kN"', '"6 kN"'))

    async def heard():
        inputs._begun()
        inputs.hear("changed", {})
        assert "5 kN" in inputs._text.value
        inputs._text.set_value(TEXT.replace("28", "32"))

    core.loop.run_until_complete(heard())
    assert "teeth = 32" in bench.desk.text
    assert '"6 kN"' in bench.desk.text
    assert inputs._text.value == bench.desk.text
    bench.desk.change(bench.desk.text.replace('"6 kN"', '"7 kN"'))

    async def nothing_typed():
        inputs._begun()
        inputs.hear("changed", {})
        assert "6 kN" in inputs._text.value
        for _ in range(100):
            await asyncio.sleep(0.1)
            if "7 kN" in inputs._text.value:
                return
        pytest.fail("what another has changed is not shown though nobody types any more")

    core.loop.run_until_complete(nothing_typed())


def test_a_table_is_added_at_the_end(client, bench):
    inputs = Inputs(bench)
    (choice,) = [one for one in client.elements.values() if isinstance(one, ui.select) and "accuracy" in one.options]
    assert "effects" not in choice.options
    assert choice.options["accuracy"].startswith("accuracy: ")
    choice.set_value("accuracy")
    assert bench.desk.text == f"{TEXT.rstrip()}\n\n[accuracy]\n"
    assert bench.changes == 1
    inputs.hear("changed", {})
    assert any(path[:1] == ("accuracy",) for path in (*inputs._places, *inputs._elements))


# ---- bar -------------------------------------------------------------------------------------------------------------
def test_the_bar_says_what_the_case_is_called_and_whether_it_is_saved(client, bench, tmp_path):
    bar = Bar(bench)
    undo, redo = button(client, "Undo"), button(client, "Redo")
    assert (bar._name.text, bar._unsaved.text) == ("c", "has no file yet")
    assert (undo.enabled, redo.enabled, bar._give_up.visible) == (False, False, False)
    bench.desk.save_as(tmp_path / "d.toml")
    bar.hear("changed", {})
    assert (bar._name.text, bar._unsaved.text) == ("d", "saved")
    bench.desk.change(TEXT.replace("28", "29"))
    bar.hear("changed", {})
    assert bar._unsaved.text == "changed, not saved"
    assert (undo.enabled, redo.enabled, bar._give_up.visible) == (True, False, True)
    press(undo)
    assert bench.desk.text == TEXT
    assert bench.changes == 1
    bar.hear("kept", {})
    assert (undo.enabled, redo.enabled) == (False, True)
    press(redo)
    assert "29" in bench.desk.text
    press(button(client, "Discard changes"))
    assert bench.desk.text == TEXT
    assert bench.changes == 3


def test_saving_asks_for_a_name_and_before_it_writes_over_others(client, bench, tmp_path):
    Bar(bench)
    press(button(client, "Save"))
    (path,) = [one for one in client.elements.values() if isinstance(one, ui.input)]
    assert path.value.endswith("c.toml")
    (tmp_path / "there.toml").write_text("x = 1\n")
    path.set_value(str(tmp_path / "no" / "folder.toml"))
    press(button(client, "OK"))
    assert path.props["error"] is True
    path.set_value(str(tmp_path / "there.toml"))
    press(button(client, "OK"))
    press(button(client, "Overwrite"))
    assert (tmp_path / "there.toml").read_text() == TEXT
    assert client.said[-1] == f"Saved {tmp_path / 'there.toml'}"
    assert bench.changes == 1
    bench.desk.change(TEXT.replace("28", "29"))
    press(button(client, "Save"))
    assert "29" in (tmp_path / "there.toml").read_text()
    (tmp_path / "there.toml").write_text("x = 2\n")
    bench.desk.change(TEXT)
    press(button(client, "Save"))
    assert (tmp_path / "there.toml").read_text() == "x = 2\n"
    press([one for one in client.elements.values() if isinstance(one, ui.button) and one.text == "Overwrite"][-1])
    assert (tmp_path / "there.toml").read_text() == TEXT


def test_only_what_may_be_written_over_is_offered_to_be(client, bench, tmp_path):
    """A file whose place a folder took was offered to be overwritten: errors were told apart by no kind of theirs."""
    Bar(bench)
    path = tmp_path / "mine.toml"
    bench.desk.save_as(path)
    bench.desk.change(TEXT.replace("28", "29"))
    path.unlink()
    path.mkdir()
    press(button(client, "Save"))
    assert "cannot be read (Is a directory)" in client.said[-1]
    assert not [one for one in client.elements.values() if isinstance(one, ui.button) and one.text == "Overwrite"]


def test_accuracy_and_variants_are_chosen_in_the_bar(client, bench):
    bar = Bar(bench)
    assert bar._level.options == list(LEVELS)
    other = next(name for name in LEVELS if name != "normal")
    bar._level.set_value(other)
    assert (bench.level, bench.changes) == (other, 1)
    bar._level.set_value(None)
    assert (bench.level, bar._level.value, bench.changes) == (other, other, 1)
    bench.level = "normal"
    bar.hear("changed", {})
    assert (bar._level.value, bench.changes) == ("normal", 1)
    assert bar._pin.text == "Pin as A"
    press(bar._pin)
    bar.hear("pinned", {})
    assert (bench.pinned, bar._pin.text) == (True, "Unpin A")
    press(bar._pin)
    bar.hear("unpinned", {})
    assert (bench.pinned, bar._pin.text) == (None, "Pin as A")
    bench.desk.change(TEXT.replace("28", "2"))
    press(bar._pin)
    assert bench.pinned is None
    assert client.said == [str(bench.desk.refusal)]
    press(button(client, "Other case"))
    assert bench.asked == [("lay", None)]


def test_exports_go_into_the_folder_that_is_named(client, bench, tmp_path, monkeypatch):
    Bar(bench)
    items = {
        one.props.get("label") or one.default_slot.children[0].text: one
        for one in client.elements.values()
        if isinstance(one, ui.menu_item)
    }
    others = set(items) - {words for words, _, _ in exports()}  # written by the page itself
    assert sorted(one.partition(" ")[0] for one in others) == ["Case", "Gears"]
    assert len(items) == 2 + len(exports())
    assert {what for _, what, _ in exports()} == {"report", "tables", *formats()}
    for words, what, ending in exports():
        press(items[words])
        path = [one for one in client.elements.values() if isinstance(one, ui.input)][-1]
        assert path.value.endswith(f"c{ending}" if ending else path.value)
        path.set_value(str(tmp_path / "to"))
        press([one for one in client.elements.values() if isinstance(one, ui.button) and one.text == "OK"][-1])
        assert bench.asked[-1] == (what, str(tmp_path / "to"))
        assert client.said[-1] == "Writing ..."
    sent = []
    monkeypatch.setattr(ui.download, "content", lambda *given: sent.append(given))
    press(items["Case (TOML), current state"])
    assert sent == [(TEXT.encode(), "c.toml", "application/toml")]


def test_the_bar_reports_what_has_been_done(client, bench):
    bar = Bar(bench)
    bar.hear("designed", {"told": "a relief"})
    bar.hear("failed", {"sentence": "no relief"})
    bar.hear("exported", {"target": "out", "remarks": ["one", "two"]})
    assert client.said == ["a relief", "no relief", "Wrote out\none\ntwo"]
    bench.desk = None
    bar.refresh()
    press(button(client, "Undo"))
    assert "is no longer open" in client.said[-1]


# ---- page ------------------------------------------------------------------------------------------------------------
def run(loop, seconds=0.0):
    loop.run_until_complete(asyncio.sleep(seconds))


def test_a_page_tells_its_scripts_all_at_once_and_form_and_bar_what_is_theirs(client, tmp_path, monkeypatch):
    monkeypatch.setattr("fegear.window.page._STILL", 0.02)
    bench = Bench(None)
    bench.desk = Desk(TEXT, "c", tmp_path)

    async def begun():
        with client:
            return Page(bench)

    page = core.loop.run_until_complete(begun())
    heard = []
    page._bar = SimpleNamespace(
        hear=lambda what, content: heard.append(("bar", what)), save=lambda: heard.append("save")
    )
    page._inputs = SimpleNamespace(
        hear=lambda what, content: heard.append(("form", what)), leave_too_long=lambda: heard.append("long")
    )
    client.scripts.clear()

    async def told():
        for what, content in (
            ("done", {"moving": True}), ("done", {"moving": False}), ("pinned", {}), ("figures", {"n": 1}),
            ("kept", {}), ("changed", {"moving": False}),
        ):  # fmt: skip
            page._hear(what, content)
        await asyncio.sleep(0)
        await asyncio.sleep(0)

    core.loop.run_until_complete(told())
    assert heard == [(who, what) for what in ("done", "pinned", "kept", "changed") for who in ("bar", "form")]
    (script,) = client.scripts
    sent = json.loads(script.removeprefix("fegear.hearAll(").removesuffix(")"))
    assert [what for what, _ in sent] == ["done", "done", "pinned", "figures"]
    assert page._unsent == []
    # A value that moves is shown in the form when it stands still, once.
    heard.clear()

    async def moved():
        page._hear("changed", {"moving": True})
        page._hear("changed", {"moving": True})
        assert heard == []
        for _ in range(100):
            await asyncio.sleep(0.02)
            if len(heard) > 1:
                break
        await asyncio.sleep(0.05)

    core.loop.run_until_complete(moved())
    assert heard == [("bar", "changed"), ("form", "changed")]

    async def forgotten():
        page._hear("changed", {"moving": True})
        page._forget()
        await asyncio.sleep(0.05)

    core.loop.run_until_complete(forgotten())
    assert len(heard) == 2
    page._too_long()
    assert heard[-1] == "long"


def test_a_page_without_a_case_offers_what_to_begin_with(client, tmp_path):
    bench = Bench(None)

    async def begun():
        with client:
            return Page(bench)

    page = core.loop.run_until_complete(begun())
    assert page._bar is None
    offers = [one for one in client.elements.values() if "offer" in one.classes]
    assert len(offers) == sum(len(job.templates) for job in JOBS.values()) + sum(map(len, examples().values()))

    async def chosen():
        press(offers[0])

    core.loop.run_until_complete(chosen())
    assert bench.desk is not None
    assert bench.desk.name == "pair"


def page_of(client, bench, **more):
    async def begun():
        with client:
            return Page(bench, **more)

    page = core.loop.run_until_complete(begun())
    run(core.loop)
    return page


def test_who_only_looks_on_sees_a_case_or_that_none_is_open_and_is_offered_nothing(client, tmp_path):
    bench = Bench(None)
    page_of(client, bench, looks=True)
    assert [one.text for one in client.elements.values() if isinstance(one, ui.label)] == ["No case is open."]
    assert not [one for one in client.elements.values() if "offer" in one.classes]
    assert "fegearLook.begin()" in client.scripts
    bench.desk = Desk(TEXT, "c", tmp_path)
    assert page_of(client, bench, looks=True)._bar is not None
    client.scripts.clear()
    page_of(client, bench)
    assert "fegearLook.begin()" not in client.scripts


#: What pages say, and what of the bench hears it.
SAID = {
    "relief": ("move_relief", {"gear": "a", "end": "tip", "index": 0, "start": 1.5, "amount": 2, "moving": True}),
    "load": ("move_load", {"pair": "I", "key": "load", "text": "3 kN", "moving": False}),
    "drop": ("drop_relief", {"gear": "a"}),
    "name_driven": ("name_driven", {"pair": "I"}),
    "design": ("design", {"pair": "I", "how": "ground"}),
    "shows": ("show", {"pair": "I", "kind": "stress", "on": True}),
    "sight": ("see", {"tasks": ["a"]}),
    "stop": ("stop", {}),
    "compute": ("compute", {}),
}


def test_what_a_page_says_reaches_what_it_is_about(client, tmp_path, monkeypatch):
    bench, heard = Bench(None), []
    bench.desk = Desk(TEXT, "c", tmp_path)
    for name in {"see_otherwise", "put", *(name for name, _ in SAID.values())}:
        monkeypatch.setattr(bench, name, lambda *given, _name=name, **more: heard.append((_name, given, more)))
    page = page_of(client, bench)
    for kind, (name, parts) in SAID.items():
        press(client.layout, kind, parts)
        assert heard.pop() == (name, (), parts)
    press(client.layout, "view", {"stress": "shear"})
    press(client.layout, "view", ["stress"])
    assert heard == [("see_otherwise", ({"stress": "shear"},), {}), ("see_otherwise", ({},), {})]
    heard.clear()
    monkeypatch.setattr("fegear.window.page.moved_crack", lambda *given: given)
    press(client.layout, "crack", {"gear": "a", "place": 1, "depth": 0.2, "angle": 30.0, "moving": True})
    assert heard == [("put", ((bench.desk, "a", 1, 0.2, 30.0),), {"moving": True})]
    page._inputs = SimpleNamespace(move=lambda *given, **more: heard.append((given, more)))
    press(client.layout, "value", {"field": "f", "text": "3", "moving": False})
    assert heard[1:] == [(("f", "3"), {"moving": False})]
    page._bar = SimpleNamespace(save=lambda: heard.append("saved"))
    press(client.layout, "save")
    assert heard.pop() == "saved"
    for kind in ("save", "value", "crack", "untaken"):  # of a case that has just been closed
        page._bar = page._inputs = bench.desk = None
        press(
            client.layout,
            kind,
            {"field": "f", "text": "3", "moving": False}
            if kind == "value"
            else {"gear": "a", "place": 1, "depth": 0.2, "angle": 30.0, "moving": True},
        )
    assert len(heard) == 2
    assert client.said == []


def test_a_page_is_called_as_the_case_on_the_desk(tmp_path):
    assert page_module._title(SimpleNamespace(desk=None)) == ""
    titled = Desk(TEXT, "c", tmp_path)
    assert page_module._title(SimpleNamespace(desk=titled)) == "x"
    assert page_module._title(SimpleNamespace(desk=Desk(TEXT.replace('title = "x"', ""), "c", tmp_path))) == "c"
    titled.set(MODULE, '"3 kg"')
    assert page_module._title(SimpleNamespace(desk=titled)) == "x"  # of what was right before
    refused = Desk(TEXT.replace("3 mm", "3 kg"), "c", tmp_path)
    assert refused.refusal is not None
    assert page_module._title(SimpleNamespace(desk=refused)) == "c"


def test_who_opens_the_page_gets_its_files_the_first_drawing_and_what_is_allowed(client, tmp_path, monkeypatch):
    head, body, made = [], [], []
    bench = Bench(None)
    monkeypatch.setattr(page_module, "_serve_files", lambda of: made.append(of))
    monkeypatch.setattr(ui, "add_head_html", head.append)
    monkeypatch.setattr(ui, "add_body_html", body.append)
    monkeypatch.setattr(page_module, "Page", lambda of, *, looks: made.append((of, looks)))
    monkeypatch.setattr(page_module, "first_drawing", lambda pairs, view, title: (pairs, view, title))
    scope = {}
    monkeypatch.setattr(ui, "context", SimpleNamespace(client=SimpleNamespace(request=SimpleNamespace(scope=scope))))
    page_module.show(bench)
    assert made == [bench, (bench, False)]
    assert [re.findall(r'(?:href|src)="([^"]*)"', one)[0] for one in head] == [
        "/fegear/page.css", "/fegear/window.css", "/fegear/scripts.js"
    ]  # fmt: skip
    assert body == []
    bench.desk = Desk(TEXT, "c", tmp_path)
    monkeypatch.setattr(bench, "shown_now", lambda: [("done", {}), ("hands", {"pairs": ["I"]})])
    scope["fegear_looks"] = True
    page_module.show(bench)
    assert made[2:] == [bench, (bench, True)]
    assert body == [(["I"], bench.view, "x")]


def test_what_cannot_be_changed_by_hand_is_said_on_the_page(client):
    def refused():
        raise InputError("gear.a", "1", "is wrong")

    Page._by_hand(refused)
    Page._by_hand(lambda: tomllib.loads("= 3"))
    assert client.said[0] == "gear.a = 1: is wrong."
    assert client.said[1].startswith("The case is not valid TOML: ")
    assert client.said[1].endswith("Correct the text first.")


def test_a_case_file_is_opened_by_its_path_or_its_name_is_refused_beside_it(client, tmp_path, monkeypatch):
    path = tmp_path / "mine.toml"
    path.write_text(TEXT)
    monkeypatch.chdir(tmp_path)
    bench, opened = Bench(None), []
    monkeypatch.setattr(bench, "from_file", lambda named: opened.append(named) or (_ for _ in ()).throw(
        InputError("case", str(named), "is none")) if "none" in str(named) else opened.append(named))  # fmt: skip
    page_of(client, bench)
    (field,) = [one for one in client.elements.values() if isinstance(one, ui.input) and "case file" in str(one.props)]
    field.set_value(" mine.toml ")
    press(button(client, "Open"))
    assert [Path(one).name for one in opened] == ["mine.toml"]
    assert field.props["error"] is None
    field.set_value("none.toml")
    press(field, "keydown.enter")
    assert field.props["error"] is True
    assert "is none" in field.props["error-message"]


def test_cases_that_were_left_unsaved_are_offered_first_and_taken_up_once(client, monkeypatch):
    left = SimpleNamespace(kept=SimpleNamespace(name="mine", when="yesterday"))
    monkeypatch.setattr("fegear.window.start_page.left_behind", lambda path: [left] if path is None else [])
    bench, taken = Bench(None), []

    def take(one):
        if taken:
            raise InputError("case", "mine", "is open in another window")
        taken.append(one)

    monkeypatch.setattr(bench, "from_left", take)
    page_of(client, bench)
    offers = [one for one in client.elements.values() if "offer" in one.classes]
    texts = [getattr(one, "content", "") for one in client.elements.values()]
    assert "unsaved, last changed yesterday" in texts
    press(offers[0])
    press(offers[0])
    assert taken == [left]
    assert "is open in another window" in client.said[-1]


def test_a_run_that_is_done_reaches_the_form_of_a_page_that_is_laid_again(client, tmp_path, monkeypatch):
    bench, heard = Bench(None), []
    bench.desk = Desk(TEXT, "c", tmp_path)
    done = {"moving": False, "remarks": []}
    monkeypatch.setattr(bench, "shown_now", lambda: [("figures", {}), ("done", done)])
    monkeypatch.setattr(Inputs, "hear", lambda self, what, content: heard.append((what, content)))
    page_of(client, bench)
    assert heard == [("done", done)]
    sent = [one for one in client.scripts if one.startswith("fegear.hearAll(")]
    assert [what for one in sent for what, _ in json.loads(one[len("fegear.hearAll(") : -1])] == ["figures", "done"]


# ---- messages --------------------------------------------------------------------------------------------------------
RELIEF = {"gear": "a", "end": "tip", "index": 0, "start": 1.5, "amount": 2, "moving": True}


def test_what_pages_say_is_looked_at():
    assert checked("relief", RELIEF) == RELIEF
    assert "index" not in checked("relief", {k: v for k, v in RELIEF.items() if k != "index"})
    assert checked("design", {"pair": "I"}) == {"pair": "I"}
    assert checked("sight", {"tasks": ["a", "b"]}) == {"tasks": ["a", "b"]}
    for wrong in (
        {**RELIEF, "start": None}, {**RELIEF, "start": True}, {**RELIEF, "amount": float("inf")},
        {**RELIEF, "index": -1},
        {**RELIEF, "index": False}, {**RELIEF, "index": 0.5}, {**RELIEF, "end": "side"}, {**RELIEF, "gear": 1},
        {**RELIEF, "gear": chr(0xD800)}, {**RELIEF, "moving": 1}, {**RELIEF, "more": 1}, [RELIEF], None,
        {k: v for k, v in RELIEF.items() if k != "amount"},
    ):  # fmt: skip
        with pytest.raises(InputError):
            checked("relief", wrong)
    for kind, wrong in (
        ("sight", {"tasks": "ab"}), ("sight", {"tasks": [1]}), ("design", {"pair": "I", "how": "other"}),
        ("design", {}), ("shows", {"pair": "I", "kind": "stress", "on": "yes"}),
        ("load", {"pair": "I", "key": "speed", "text": "", "moving": False}),
    ):  # fmt: skip
        with pytest.raises(InputError):
            checked(kind, wrong)


def said(**parts):
    return {"client_id": "p", "listener_id": "l", "args": [json.dumps(parts)]}


def test_a_moved_value_takes_the_place_of_the_one_that_waits():
    assert _moved(said(gear="a", start=1.0, amount=2.0, moving=True)) == ("p", "l", "gear a", "moving True")
    assert _moved(said(gear="a", moving=False)) is None
    assert _moved({"args": ["["], "client_id": "p"}) is None
    assert _moved({"args": ["1"]}) is None
    assert (
        _moved({"args": [json.dumps({"moving": True, "x": "y" * 1000})], "client_id": "p", "listener_id": "l"}) is None
    )
    heard = Messages()
    first, second, other = (said(gear=g, start=s, moving=True) for g, s in (("a", 1.0), ("a", 2.0), ("b", 3.0)))
    assert not heard._replaces(first)
    assert heard._replaces(second)
    assert first["args"] == second["args"]
    assert not heard._replaces(other)
    assert heard._replaces(said(gear="b", start=4.0, moving=True))
    assert not heard._replaces({"args": []})  # whatever comes between stays between
    assert not heard._replaces(said(gear="a", start=5.0, moving=True))


def test_a_long_message_is_put_together_from_its_pieces(client, monkeypatch):
    heard, refused = Messages(), []
    monkeypatch.setattr(messages, "refuse", lambda page, words: refused.append(words))
    acted = []
    monkeypatch.setattr(messages, "_act", acted.append)
    whole = {"client_id": client.id, "id": 1, "args": ["x" * 30]}
    text = json.dumps(whole)

    def piece(at, part, count=3, name="n"):
        core.loop.run_until_complete(
            heard.piece("s", {"client_id": client.id, "name": name, "count": count, "at": at, "text": part})
        )

    third = len(text) // 3
    parts = [text[:third], text[third : 2 * third], text[2 * third :]]
    for at, part in enumerate(parts):
        piece(at, part)
    assert acted == [whole]
    assert refused == []
    # Begun anew from the first; one in the wrong order, or beyond its count, is refused.
    piece(0, parts[0])
    for at, part in enumerate(parts):
        piece(at, part)
    assert acted == [whole] * 2
    piece(1, parts[1])
    assert len(refused) == 1
    piece(3, parts[1])
    assert len(refused) == 2
    piece(0, "[", count=1)
    assert len(refused) == 3
    piece(0, json.dumps({"client_id": "another"}), count=1)
    assert len(refused) == 4
    for k in range(8):
        piece(0, "x", name=f"m{k}")
    assert len(refused) == 4
    piece(0, "x", name="m8")
    assert len(refused) == 5
    monkeypatch.setattr(messages, "_MOST", 10)
    piece(0, "x" * 11, name="m0")
    assert len(refused) == 6
    assert acted == [whole] * 2


def test_files_of_the_page_are_asked_for_anew_and_served_once(monkeypatch):
    """A browser that kept an old script would show a page that half works."""
    from fegear.window import page as pages

    served, ends = {}, []
    app = SimpleNamespace(
        routes=[], on_shutdown=ends.append,
        add_static_file=lambda **how: served.update({how.pop("url_path"): how}),
        add_api_route=lambda path, answer: made.update({path: answer()}),
    )  # fmt: skip
    made = {}
    messages = SimpleNamespace(install=lambda: ends.append("installed"), end="messages end")
    monkeypatch.setattr(pages, "app", app)
    monkeypatch.setattr(pages, "Messages", lambda: messages)
    pages._serve_files(SimpleNamespace(end="bench end"))
    assert ends == ["installed", "messages end", "bench end"]
    assert set(served) == {f"/fegear/{name}" for name in ("plotly.js", "page.css", "window.css")}
    (scripts,) = made.values()
    assert scripts.headers["cache-control"] == "public, max-age=0"
    begun = [scripts.body.decode().index(f"const fegear{name} =") for name in ("Figure", "", "Gears", "Scrub")]
    assert begun == sorted(begun)  # each uses what stands before it
    folder = Path(pages.__file__).parent
    assert {path.stem for path in folder.glob("*.js")} == set(pages._SCRIPTS)
    assert all(Path(how["local_file"]).is_file() for how in served.values())
    assert {name: how.get("max_cache_age") for name, how in served.items() if how.get("max_cache_age") != 0} == {
        "/fegear/plotly.js": None
    }
    app.routes = [SimpleNamespace(path=path) for path in ("/", *served, *made)]
    served.clear()
    pages._serve_files(SimpleNamespace(end="bench end"))
    assert (served, len(ends)) == ({}, 3)
