"""The bench of the window: what is asked of the computing process, what pages are told, what waits how long."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.window import bench as benches
from fegear.window.beginnings import gallery
from fegear.window.bench import LEVELS, Bench
from fegear.window.document import Desk
from fegear.window.glance import LONGEST_QUESTION, View, read_view
from fegear.window.job_queue import Compute, Design, Export, Said, Stop
from fegear.window.journal import left_behind

CASE = """
results = ["load-sharing"]
[gear.a]
teeth = 23
module = "3 mm"
face_width = "10 mm"
[gear.b]
teeth = 41
module = "3 mm"
face_width = "10 mm"
[pair.I]
driver = "a"
driven = "b"
load = "900 N"
compliance = { source = "cornell" }
"""


class Loop:
    """A loop whose time is told: what waits is called by hand."""

    def __init__(self):
        self.waiting, self.soon = [], []

    def call_later(self, seconds, act):
        handle = SimpleNamespace(seconds=seconds, act=act, live=True)
        handle.cancel = lambda: setattr(handle, "live", False)
        self.waiting.append(handle)
        return handle

    def call_soon(self, act):
        self.soon.append(act)

    def call_soon_threadsafe(self, act, *given):
        act(*given)

    def is_closed(self):
        return False

    def live(self):
        return [one.seconds for one in self.waiting if one.live]


@pytest.fixture
def bench(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))
    made = Bench(None)
    made.asked_for, made.heard = [], []
    made._computing = SimpleNamespace(ask=made.asked_for.append)
    made.lay(Desk(CASE, "c", tmp_path))
    made.listen(lambda what, content: made.heard.append((what, content)))
    return made


def test_accuracy_is_ten_times_the_case_s_or_a_tenth_of_it(bench):
    assert LEVELS == {"draft": 10.0, "normal": 1.0, "fine": 0.1}
    for level, factor in LEVELS.items():
        bench.level = level
        assert bench.asked().loosened == factor
        bench._hear(Said(bench.asked_for[-1].number, "done", {"moving": False}))
        assert bench.heard[-1][1]["level"] == ("" if level == "normal" else f" ({level}, differs from the case)")
    bench.export("report", "out")
    assert isinstance(bench.asked_for[-1], Export)
    assert bench.asked_for[-1].asked.loosened == 1.0  # what is written has the case's own
    assert (bench.asked_for[-1].what, bench.asked_for[-1].target) == ("report", "out")


def test_the_case_is_asked_for_with_what_is_seen_and_shown(bench):
    first = bench.asked_for[-1]
    assert isinstance(first, Compute)
    assert (first.asked.text, first.asked.name, first.asked.laid, first.asked.moving) == (CASE, "c", 1, False)
    assert (first.asked.pictures, first.asked.field, first.asked.within) == ((), True, None)
    bench.see(["load-sharing of I"])
    bench.show("I", "stress", on=True)
    bench.show("I", "tool", on=True)
    bench.show("I", "stress", on=True)
    assert bench.asked_for[-1].asked.shows == (("I", "tool"), ("I", "stress"))
    assert bench.asked_for[-1].asked.sight == ("load-sharing of I",)
    count = len(bench.asked_for)
    bench.show("I", "tool", on=False)
    assert (bench._shows, len(bench.asked_for)) == ((("I", "stress"),), count)  # what is no longer shown costs nothing
    numbers = [job.number for job in bench.asked_for]
    assert numbers == sorted(set(numbers))
    bench.see_otherwise({"measure": "tension"})
    assert len(bench.asked_for) == count  # another stress of the same field
    bench.see_otherwise({"measure": "none"})
    assert (bench.asked_for[-1].asked.field, len(bench.asked_for)) == (False, count + 1)
    bench.see_otherwise({"pictures": ["te"]})
    assert bench.asked_for[-1].asked.pictures == ("te",)
    assert bench.view == View(pictures=("te",), measure="none")


def test_a_case_that_an_earlier_window_left_lies_on_the_desk_as_it_was_left(bench, tmp_path):
    desk = Desk(CASE, "unsaved", tmp_path)
    desk.set(("gear", "a", "teeth"), "29")
    desk.leave()  # a crash
    (left,) = left_behind(None)
    bench.from_left(left)
    assert bench.desk.document["gear"]["a"]["teeth"] == 29
    assert bench.desk.restored.startswith("Unsaved changes of ")
    assert "teeth = 29" in bench.asked_for[-1].asked.text


def test_every_page_hides_and_shows_the_answers_of_an_exercise_as_the_lecturer_does(bench):
    def told():
        return [content for what, content in bench.heard if what == "exercise"]

    def page(**said):
        return {"exercise": True, "revealed": False, "question": 0, "words": ""} | said

    hidden, shown = page(), page(revealed=True)
    bench.see_otherwise({"large": True})
    assert told() == []
    bench.see_otherwise({"exercise": True, "revealed": False})
    bench.see_otherwise({"revealed": True})
    bench.see_otherwise({"measure": "none"})  # another picture of the same case, which is computed
    assert told() == [hidden, shown]
    assert bench.view.revealed  # for a page that opens now
    assert not read_view(None).revealed
    assert read_view(None).exercise
    bench.heard.clear()
    bench.put(bench.desk.text.replace("900 N", "800 N"), moving=True)
    assert told() == [hidden]
    assert [what for what, _ in bench.heard].index("exercise") < [what for what, _ in bench.heard].index("asked")
    bench.put(bench.desk.text.replace("800 N", "700 N"), moving=False)
    bench.see_otherwise({"exercise": False})
    assert told() == [hidden, page(exercise=False)]
    bench.heard.clear()
    bench.see_otherwise({"exercise": True, "question": 2})  # the next question is that of all pages
    assert told() == [page(question=2)]
    bench.see_otherwise({"words": "  Why is\nC " + "so " * 200})  # one of the lecturer's own, on one line
    assert told()[-1]["words"].startswith("Why is C so so ")
    assert LONGEST_QUESTION - 3 <= len(told()[-1]["words"]) <= LONGEST_QUESTION
    assert read_view(None).words == bench.view.words  # it is still there the next time


def test_a_refused_case_is_not_asked_for_and_another_case_begins_anew(bench, tmp_path):
    count = len(bench.asked_for)
    bench.desk.change(CASE.replace("900 N", "-1 N"))
    bench.changed()
    assert len(bench.asked_for) == count
    told = {"stopped": False, "sentence": str(bench.desk.refusal)}  # what pages show is of an earlier case, and why
    assert bench.heard[-1] == ("outdated", told)
    assert "-1 N" in told["sentence"]
    assert bench.shown_now()[-2][0] == "outdated"
    bench._hear(Said(bench.asked_for[-1].number, "done", {"moving": False}))  # of the case before
    assert [what for what, _ in bench.heard][-2:] == ["done", "outdated"]
    bench.pin()
    bench.lay(Desk(CASE, "d", tmp_path))
    assert (bench.pinned, bench._shows, bench._sight) == (None, (), ())
    assert bench.asked_for[-1].asked.laid == 2
    assert [what for what, _ in bench.heard][-2:] == ["laid", "asked"]
    bench.lay(None)
    assert bench.heard[-1][0] == "laid"
    for act in (lambda: bench.name_driven("I"), lambda: bench.drop_relief("a"), bench.asked):
        with pytest.raises(InputError, match="is no longer open"):
            act()


def test_what_is_computed_is_stopped_and_taken_up_again(bench):
    bench.design("I")
    design, count = bench.asked_for[-1].number, len(bench.asked_for)
    bench.stop()
    assert bench.asked_for[-1] == Stop(design + 1)
    assert bench.heard[-1] == ("outdated", {"stopped": True, "sentence": ""})
    assert bench.shown_now()[-1] == bench.heard[-1]  # and nothing is asked for
    # What comes late of what was given up changes no case.
    bench._hear(Said(design, "designed", {"reliefs": {"a": None}, "told": "late"}))
    assert bench.desk.text == CASE
    bench._hear(Said(design + 1, "stopped", {}))
    assert (len(bench.asked_for), bench.heard[-1][0]) == (count + 1, "outdated")
    bench.compute()
    assert isinstance(bench.asked_for[-1], Compute)
    assert bench.shown_now()[-1][0] == "asked"
    assert "outdated" not in dict(bench.shown_now())
    bench.lay(None)
    bench.stop()  # nothing is there to be stopped
    assert isinstance(bench.asked_for[-1], Compute)


def test_what_a_page_that_opens_now_is_told_comes_in_order(bench):
    number = bench.asked_for[-1].number

    def say(what, **content):
        bench._hear(Said(number, what, content))

    drawn = dict(bench.shown_now())
    assert list(drawn) == ["hands", "assemblies", "asked"]  # the gears stand before anything is computed
    assert drawn["asked"] == {"number": number, "moving": False}
    assert len(drawn["hands"]["pairs"]["I"]["mesh"]["driver"]) == 2
    assert drawn["hands"]["pairs"]["I"]["load"] == {"key": "load", "text": "900 N"}
    say("plan", tasks=["one", "two"])
    say("found", task="one", values="v", figures=[])
    say("found", task="two", values="w", figures=[])
    say("picture", task="one", key="p-0")
    say("meshed", pair="I", kind="stress", task="three")
    say("meshed", pair="I", kind="pressure", task="two")
    say("meshed", pair="I", kind="field", task="two")
    say("done", moving=False)
    told = bench.shown_now()
    assert [what for what, _ in told] == [
        "plan", "hands", "assemblies", "found", "picture", "found", "meshed", "meshed", "done",
    ]  # fmt: skip
    assert "pictures" not in told[3][1]
    assert [one["kind"] for _, one in told[6:8]] == ["pressure", "field"]  # what is not switched on is not shown
    bench.show("I", "stress", on=True)
    assert [content["kind"] for what, content in bench.shown_now() if what == "meshed"] == [
        "stress",
        "pressure",
        "field",
    ]
    # Tasks that are gone are forgotten, with what they showed by themselves.
    bench._hear(Said(bench.asked_for[-1].number, "plan", {"tasks": ["one"]}))
    assert [content.get("task") for what, content in bench.shown_now() if what in ("found", "meshed")] == [
        "one",
        "three",
    ]
    assert bench.shown_now()[-1][0] == "asked"
    bench._hear(Said(bench.asked_for[-1].number, "refused", {"sentence": "s", "key": ""}))
    assert bench.shown_now()[-1][0] != "asked"


def test_a_pinned_case_is_compared_when_all_is_at_rest(bench):
    first = bench.asked_for[-1].number
    bench._hear(
        Said(first, "hands", {"pairs": {"I": {"mesh": {"ratios": {"transverse": 1.61}}}, "II": {"mesh": None}}})
    )
    bench._hear(Said(first, "plan", {"tasks": ["one"]}))
    bench._hear(Said(first, "found", {"task": "one", "values": "v", "figures": [], "pictures": {"p": 1}}))
    bench._hear(Said(first, "done", {"moving": False}))
    bench.pin()
    (told,) = (content for what, content in bench.heard if what == "pinned")
    assert [one["task"] for one in told["found"]] == ["one"]
    assert "pictures" not in told["found"][0]
    assert told["ratios"] == {"I.transverse": 1.61}  # no computed value: the contact ratio comes with the gears
    bench.move_load("I", "load", "950 N", moving=True)
    bench._hear(Said(bench.asked_for[-1].number, "done", {"moving": True}))
    assert isinstance(bench.asked_for[-1], Compute)  # what moves is not compared
    bench.move_load("I", "load", "990 N", moving=False)
    bench._hear(Said(bench.asked_for[-1].number, "done", {"moving": False}))
    compared = bench.asked_for[-1]
    assert (compared.first, compared.second) == (bench.pinned, bench.asked())
    bench._hear(Said(compared.number, "compared", {"sections": [1]}))
    assert dict(bench.shown_now())["compared"] == {"sections": [1], "number": compared.number}
    bench.unpin()
    assert bench.pinned is None
    assert {"pinned", "compared"} & {what for what, _ in bench.shown_now()} == set()


def test_designed_reliefs_are_taken_and_the_case_before_is_pinned(bench):
    bench.design("I")
    job = bench.asked_for[-1]
    assert isinstance(job, Design)
    assert (job.pair, job.how) == ("I", "exact")
    relief = {"tip": {"amount": "12 um", "length": "1 mm"}}
    bench._hear(Said(job.number, "designed", {"reliefs": {"a": relief, "b": None}, "told": "so much is left"}))
    gears = bench.desk.document["gear"]
    assert gears["a"]["relief"] == relief
    assert "relief" not in gears["b"]
    assert bench.desk.document["effects"]["relief"] is True
    assert bench.pinned.text == CASE
    assert [what for what, _ in bench.heard if what in ("designed", "pinned", "changed")] == [
        "designed", "pinned", "changed",
    ]  # fmt: skip
    bench.drop_relief("a")
    assert "relief" not in bench.desk.document["gear"]["a"]


def test_gears_that_were_not_sent_again_stay_as_they_were(bench):
    number = bench.asked_for[-1].number
    for mesh in ({"at": 1}, None, {"at": 2}):
        bench._hear(Said(number, "hands", {"pairs": {"I": {"mesh": mesh, "load": 1}}}))
        assert dict(bench.shown_now())["hands"]["pairs"]["I"]["mesh"] == {"at": 2 if mesh == {"at": 2} else 1}


def test_many_changes_are_shown_once_and_after_so_many_times_what_one_takes(bench, monkeypatch):
    clock = iter([0.0, 0.1, 1.0, 1.4, 2.0, 2.0])
    monkeypatch.setattr(benches.time, "monotonic", lambda: next(clock))
    bench._loop = loop = Loop()
    changes = []
    monkeypatch.setattr(bench, "_show_change", lambda *, moving: changes.append(moving))
    bench.changed(moving=True)
    assert (changes, loop.live()) == ([True], [pytest.approx(0.2)])
    bench.changed(moving=True)
    bench.changed(moving=True)
    assert changes == [True]
    bench._settle()
    assert changes == [True, True]
    assert loop.live()[-1] == 0.5  # at most
    bench.changed(moving=True)
    bench.changed(moving=False)
    bench.changed(moving=True)
    bench._settle()
    assert changes == [True, True, False]  # one of them stands still
    bench._settle()
    assert changes == [True, True, False]


def test_who_does_not_let_go_has_let_go_after_two_seconds(bench):
    bench._loop = loop = Loop()
    bench._show_change(moving=True)
    # The case is judged and kept beyond a crash once in 0.3 s, and when it stands still.
    assert loop.live() == [2.0, 0.3]
    assert loop.waiting[-1].act == bench._keep_up
    bench._show_change(moving=True)
    assert loop.live() == [0.3, 2.0]  # the one before counts no more
    bench._keep_up()
    bench._show_change(moving=True)
    assert loop.live() == [2.0, 0.3]
    bench._show_change(moving=False)
    assert loop.live() == []


def test_what_could_not_be_kept_is_tried_again_after_three_seconds_and_pages_say_so(bench):
    bench._loop = loop = Loop()
    troubles = iter(["disk full", "disk full", ""])
    bench.desk.keep_up = lambda: setattr(bench.desk, "trouble", next(troubles))
    bench._keep_up()
    assert (loop.live(), [what for what, _ in bench.heard].count("kept")) == ([3.0], 1)
    loop.waiting[-1].act()
    assert (loop.live()[-1:], [what for what, _ in bench.heard].count("kept")) == ([3.0], 1)
    loop.waiting[-1].act()
    assert (loop.live(), [what for what, _ in bench.heard].count("kept")) == ([], 2)
    bench.desk = None
    bench._keep_up()


def test_who_listens_no_longer_hears_nothing(bench):
    heard = []
    end = bench.listen(lambda what, _: heard.append(what))
    bench.tell("one")
    end()
    end()
    bench.tell("two", {"x": 1})
    assert heard == ["one"]
    assert bench.heard[-2:] == [("one", {}), ("two", {"x": 1})]


def test_the_gallery_has_the_cases_of_the_source_tree():
    found = gallery()
    assert list(found) == sorted(path.stem for path in (Path(__file__).parents[2] / "cases").glob("*.toml"))
    assert list(found) == sorted(found)


def test_a_framework_s_page_switch_is_no_event_of_this_page():
    from fegear.window import messages

    def client(kind):
        return SimpleNamespace(elements={1: SimpleNamespace(_event_listeners={"l": SimpleNamespace(type=kind)})})

    message = {"id": 1, "listener_id": "l", "args": []}
    assert messages._is_of_its_kind(client("sub_pages_navigate"), message) is False
    assert messages._is_of_its_kind(client("click"), message) is True
    assert messages._is_of_its_kind(client("click"), {**message, "id": 2}) is True  # gone with its form
