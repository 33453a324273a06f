"""The computing process of the window by itself: when it gives way, waits, tidies up, and what it says of faults."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Skin
from fegear.engine.figure.panel import Panel
from fegear.engine.stage import Task
from fegear.engine.value import Value
from fegear.window import glance, wanted, worker
from fegear.window.ahead import next_texts
from fegear.window.computing import whole
from fegear.window.glance import PICTURES, USUAL, USUAL_SET, USUAL_WIDE, keys_of, numbers_of
from fegear.window.job_queue import Asked, Compute, Export, Inbox, Stop, Unwanted
from fegear.window.time_left import TimeLeft
from fegear.window.worker import Worker, scene_of

TEXT = """
results = ["geometry"]
[gear.a]
teeth = 20
module = "3 mm"
[accuracy]
tolerance = 1e-3
"""


def asked(**more):
    return Asked(TEXT, "c", ".", **more)


def test_tolerances_are_loosened_within_what_has_a_meaning():
    assert scene_of(asked()).case.accuracy.tolerance == 1e-3
    assert scene_of(asked(loosened=10.0)).case.accuracy.tolerance == pytest.approx(1e-2)
    assert scene_of(asked(loosened=1e4)).case.accuracy.tolerance == 0.5
    assert scene_of(asked(loosened=1e-9)).case.accuracy.tolerance == 1e-6
    assert (scene_of(asked()).estimates, scene_of(asked(moving=True)).estimates) == (True, False)
    assert scene_of(asked(loosened=0.1)).text == TEXT


@pytest.fixture
def working(tmp_path, monkeypatch):
    """A process with an inbox that is played, and what it says."""
    said, waits = [], []
    inbox = SimpleNamespace(
        say=lambda one: said.append((one.number, one.what, one.content)), look=lambda: None, wait=waits.append,
        watch=lambda unwanted, within=None: None, given_up=False,
    )  # fmt: skip
    monkeypatch.setattr(worker, "Inbox", lambda connection: inbox)
    made = Worker(None, tmp_path)
    made.said, made.waits, made.inbox = said, waits, inbox
    return made


def test_what_is_dragged_for_is_finished_first_for_a_second_and_a_half(working, monkeypatch):
    clock = SimpleNamespace(now=100.0)
    monkeypatch.setattr(worker.time, "monotonic", lambda: clock.now)
    working._begun = 100.0

    def gives_way(of, to, wait_before=0):
        working._asked, working._wait_before = asked(moving=of), wait_before
        return working._gives_way(Compute(2, asked(moving=to)))

    assert gives_way(False, False)
    assert gives_way(False, True)
    assert gives_way(True, False)
    assert not gives_way(True, True)
    assert gives_way(True, True, wait_before=-1)  # the answer is there
    clock.now = 101.5
    assert not gives_way(True, True)
    clock.now = 101.6
    assert gives_way(True, True)
    working._asked = None
    assert working._gives_way(Compute(2, asked(moving=True)))


def test_faults_are_said_in_a_sentence_and_what_may_be_half_done_is_forgotten(working, monkeypatch, capsys):
    begun = []
    monkeypatch.setattr(working, "_begin_anew", lambda: begun.append(1))
    for problem, what, words, key, anew in (
        (Unwanted(), "dropped", None, None, 0), (MemoryError(), "refused", "Out of memory", "", 1),
        (InputError("gear.a", "1", "is wrong"), "refused", "gear.a = 1: is wrong", "gear.a", 1),
        (ZeroDivisionError("x"), "refused", "Internal error in fegear (ZeroDivisionError: x)", "", 2),
    ):  # fmt: skip

        def fail(job, problem=problem):
            raise problem

        monkeypatch.setattr(working, "_do", fail)
        monkeypatch.setattr(Worker, "_do", fail)
        working.answer(Compute(7, asked()))
        number, said, content = working.said[-1]
        assert (number, said) == (7, what)
        if words:
            assert content["sentence"].startswith(words)
            assert content["key"] == key
        assert len(begun) == anew
    assert "ZeroDivisionError" in capsys.readouterr().err
    working.inbox.given_up = True
    working.answer(Compute(8, asked()))
    assert working.said[-1][:2] == (8, "dropped")


def test_what_is_kept_is_bounded_at_rest_and_after_every_24th_answer_that_moves(working, monkeypatch):
    shrunk, given = [], []
    monkeypatch.setattr(working, "_cache", SimpleNamespace(shrink=lambda most: shrunk.append(most) or True))
    monkeypatch.setattr(worker, "give_back", lambda: given.append(1))
    for _ in range(23):
        working._tidy(moving=True)
    assert shrunk == []
    working._tidy(moving=True)
    assert (shrunk, given) == ([120_000_000], [1])
    working._tidy(moving=True)
    working._tidy(moving=False)
    assert len(shrunk) == 2
    for _ in range(23):
        working._tidy(moving=True)
    assert len(shrunk) == 2
    # Where nobody waits it is done before its turn.
    working._asked = asked(moving=True)
    working._pause()
    assert (len(shrunk), working._wait_before, working.waits) == (3, -1, [0.2])


def test_what_comes_behind_an_answer_is_told_once_and_by_kind(working):
    told = []
    working._later = [(kind, lambda kind=kind: told.append(kind)) for kind in ("hands", "load_now", "hands")]
    working._tell_later("load_now")
    assert told == ["load_now"]
    working._tell_later()
    working._tell_later()
    assert told == ["load_now", "hands", "hands"]


def test_gears_that_are_moved_are_drawn_before_the_answers_and_stress_inside_when_they_stand_still(working):
    text = """
results = ["load-sharing"]
gear.a = { teeth = 20, module = "3 mm", face_width = "20 mm" }
gear.b = { teeth = 33, module = "3 mm", face_width = "20 mm" }
pair.I = { driver = "a", driven = "b", torque = "50 N*m" }
accuracy.tolerance = 0.05
"""

    def answered(number, text, moving):
        del working.said[:]
        working.answer(Compute(number, Asked(text, "c", ".", moving=moving, laid=1, pictures=("load",), field=True)))
        return [(what, content.get("task", "")) for _, what, content in working.said]

    assert ("meshed", "stress-inside of I") in answered(1, text, True)  # nothing moves on

    def moves_on(_seconds):
        raise Unwanted

    working.inbox.wait = moves_on
    told = answered(2, text.replace("teeth = 20", "teeth = 21"), True)
    assert [what for what, _ in told[:3]] == ["plan", "hands", "found"]
    assert ("found", "load-sharing of I") in told
    assert ("meshed", "stress-inside of I") not in told
    (hands,) = (content for _, what, content in working.said if what == "hands")
    assert hands["pairs"]["I"]["mesh"] is not None
    assert hands["pairs"]["I"].keys() == {"mesh"}  # reliefs go with the gears, at rest
    assert "an atlas" in next(content["draft"] for _, what, content in working.said if what == "found")
    told = answered(3, text.replace("teeth = 20", "teeth = 21").replace("50 N", "60 N"), True)
    assert "hands" not in [what for what, _ in told]  # only the load has moved: the page knows where it is
    working.inbox.wait = lambda _seconds: None
    told = answered(4, text, True)  # these teeth are known, and those of others are on the page
    assert ("meshed", "stress-inside of I") in told
    first, whole = (content["pairs"]["I"] for _, what, content in working.said if what == "hands")
    assert first.keys() == {"mesh"}
    assert (whole["mesh"], len(whole["reliefs"])) == (None, 2)


def test_the_gears_of_the_move_before_spare_a_plan_and_change_no_answer(working, tmp_path, monkeypatch):
    text = """
results = ["load-sharing"]
gear.a = { teeth = 20, module = "3 mm", face_width = "20 mm" }
gear.b = { teeth = 33, module = "3 mm", face_width = "20 mm" }
pair.I = { driver = "a", driven = "b", torque = "50 N*m" }
accuracy.tolerance = 0.05
"""
    plans, plan_with = [], wanted.plan_with
    monkeypatch.setattr(wanted, "plan_with", lambda *given, **more: plans.append(1) or plan_with(*given, **more))
    monkeypatch.setattr(worker, "compute_ahead", lambda *_given: None)

    def moves_on(_seconds):
        raise Unwanted

    working.inbox.wait = moves_on

    def answered(of, number, teeth, mate=33):
        del working.said[:], plans[:]
        case = text.replace("teeth = 20", f"teeth = {teeth}").replace("teeth = 33", f"teeth = {mate}")
        of.answer(Compute(number, Asked(case, "c", ".", moving=True, laid=1, pictures=("load",))))
        (found,) = (one for _, _, one in working.said if one.get("task") == "load-sharing of I")
        return [found[key] for key in ("numbers", "draft", "loads")], len(plans)

    def afresh(number, teeth, mate=33):
        return answered(Worker(None, tmp_path / str(number)), number, teeth, mate)[0]

    first = answered(working, 1, 21)
    assert first == (afresh(2, 21), 2)
    assert answered(working, 3, 22) == (afresh(4, 22), 1)
    assert answered(working, 5, 23, 34) == (afresh(6, 23, 34), 1)
    assert answered(working, 7, 10, 34)[1] == 2  # no atlas has it
    # Numbers out of sight are written out when all is at rest.
    answered(working, 8, 24)
    (seen,) = (one for _, _, one in working.said if one.get("task") == "load-sharing of I")
    assert seen["values"] is None
    kept = {"task": "t", "figures": [], "values": "before"}
    assert whole(seen | {"figures": []}, kept)["values"] == "before"


@pytest.mark.parametrize(
    ("before", "now", "after"),
    [
        ("z = 21\nx = 0.3", "z = 22\nx = 0.3", ("z = 23\nx = 0.3", "z = 24\nx = 0.3")),
        ("z = 13", "z = 11", ("z = 9", "z = 8", "z = 10")),
        ("x = 0.98", "x = 0.99", ("x = 1.00", "x = 1.01")),
        ("x = 0.3", "x = 0.35", ("x = 0.40", "x = 0.41", "x = 0.39")),
        ("x = 0.1", "x = 0", ("x = -0.1", "x = -0.2")),
        ("x = -.01 # m", "x = .01 # m", ("x = 0.03 # m", "x = 0.04 # m", "x = 0.02 # m")),
        ('m = "3 mm"', 'm = "3.01 mm"', ('m = "3.02 mm"', 'm = "3.03 mm"')),
        ("z = 21", "z = 21", ()), ("a = 1\nb = 2", "a = 2\nb = 3", ()), ('m = "3 mm"', 'm = "3 in"', ()),
        ("z = 21", "z = 21\nx = 1", ()), ("", "z = 21", ()),
    ],
)  # fmt: skip
def test_a_number_that_moves_goes_on_by_steps_like_the_last(before, now, after):
    assert next_texts(before, now) == after


def test_the_next_place_of_a_gear_is_computed_ahead_and_recalled(working, tmp_path, monkeypatch):
    text = """
results = ["load-sharing"]
gear.a = { teeth = 20, module = "3 mm", face_width = "20 mm" }
gear.b = { teeth = 33, module = "3 mm", face_width = "20 mm" }
pair.I = { driver = "a", driven = "b", torque = "50 N*m" }
accuracy.tolerance = 0.05
"""
    ahead, compute_ahead, places = [], worker.compute_ahead, []

    def watched(asked, *more):
        ahead.append(asked.text)
        places.append(len(working.said))
        return compute_ahead(asked, *more)

    def moves_on(_seconds):
        raise Unwanted

    monkeypatch.setattr(worker, "compute_ahead", watched)
    working.inbox.wait = moves_on

    def answered(of, number, case):
        del working.said[:], ahead[:], places[:]
        before = of._cache.solutions.computed
        of.answer(Compute(number, Asked(case, "c", ".", moving=True, laid=1, pictures=("load",))))
        (found,) = (one for _, _, one in working.said if one.get("task") == "load-sharing of I")
        return [found[key] for key in ("numbers", "draft", "loads")], of._cache.solutions.computed - before

    def teeth(count):
        return text.replace("teeth = 20", f"teeth = {count}")

    assert answered(working, 1, teeth(21))[1] > 0
    assert ahead == []  # nobody knows where it goes
    assert answered(working, 2, teeth(22))[1] > 0
    assert ahead == [teeth(23), teeth(24)]
    assert [what for _, what, _ in working.said[places[0] :]] == ["dropped"]  # behind the answer, and nobody is told
    monkeypatch.setattr(worker, "compute_ahead", lambda *_given: ahead.append("next"))
    found, computed = answered(working, 3, teeth(23))
    assert computed == 0
    assert found == answered(Worker(None, tmp_path / "afresh"), 4, teeth(23))[0]
    # A load is not a gear, and what takes long is not begun.
    answered(working, 5, teeth(23).replace("50 N", "60 N"))
    assert ahead == []
    monkeypatch.setattr(worker, "_SOON", 0.0)
    answered(working, 6, teeth(24))
    assert ahead == []


def test_a_next_place_that_is_refused_is_not_told(working):
    text = """
results = ["geometry"]
gear.a = { teeth = 10, module = "3 mm" }
gear.b = { teeth = 33, module = "3 mm" }
pair.I = { driver = "a", driven = "b" }
"""

    def answered(number, teeth):
        del working.said[:]
        case = text.replace("teeth = 10", f"teeth = {teeth}")
        working.answer(Compute(number, Asked(case, "c", ".", moving=True, laid=1)))
        return [what for _, what, _ in working.said]

    assert "refused" not in answered(1, 10)
    assert "refused" not in answered(2, 6)  # next 2
    assert "refused" in answered(3, 2)


def test_progress_is_told_to_who_waits_and_not_to_who_moves(working, monkeypatch):
    clock = SimpleNamespace(now=50.0)
    monkeypatch.setattr(worker.time, "monotonic", lambda: clock.now)
    working._number, working._asked, working._reports = 3, asked(), True
    working._left = TimeLeft([1.0, 4.0, None, 2.0, 1.0])
    working.begin("Gear a", 2, 5)
    assert working.said == [(3, "begin", {"title": "Gear a", "step": 2, "count": 5, "left": None})]
    working._left = TimeLeft([1.0, 4.0, 2.0])
    working.begin("Gear a", 2, 3)
    assert working.said.pop() == (3, "begin", {"title": "Gear a", "step": 2, "count": 3, "left": 6.0})
    clock.now += 0.2
    working.advance(0.1)  # too soon after the last report
    assert len(working.said) == 1
    clock.now += 0.8
    working.advance(0.25)
    assert working.said.pop() == (
        3,
        "advance",
        {"fraction": 0.25, "left": 5.0},
    )  # 3 s by its own pace, and the last step
    working._asked, working._reports = asked(moving=True), False
    working.begin("Gear a", 2, 5)
    assert len(working.said) == 1
    working._wait_before = 4
    working.begin("Gear b", 4, 5)
    assert working.waits == [0.2]  # what nobody waits for does not begin while a value moves
    working._wait_before = 4
    working.begin("Gear b", 3, 5)
    assert len(working.waits) == 1


def test_a_figure_waits_while_a_value_moves_where_nobody_sees_it(working):
    task = Task("transmission-error", "I")
    working._sent._figures[str(task), "transmission_error_I"] = "x"
    working._sent._figures[str(task), "other"] = "x"
    working._asked = asked(moving=True, pictures=("te",))
    assert not working._waits(task, "transmission_error_I")  # a small picture
    assert working._waits(task, "other")
    assert not working._waits(task, "never sent")
    for seen in (asked(moving=True), asked(pictures=("te",)), asked(moving=True, pictures=("te",), sight=(str(task),))):
        working._asked = seen
        assert not working._waits(task, "other")


def test_time_left_follows_the_pace_of_this_machine_and_no_step_that_was_recalled(monkeypatch):
    clock = SimpleNamespace(now=0.0)
    monkeypatch.setattr(worker.time, "monotonic", lambda: clock.now)
    left = TimeLeft([6.0, 4.0, 0.1])
    left.begin(1)
    assert left.left() == pytest.approx(10.1)
    clock.now = 14.0
    left.end(14.0)  # twice as slow as predicted: with the 2 s of a guess (2 + 14) / (2 + 6)
    left.begin(2)
    assert left.left() == pytest.approx(2.0 * 4.1)
    left.end(0.001)
    left.begin(3)
    assert left.left() == pytest.approx(2.0 * 0.1)
    assert TimeLeft([]).left() is None
    assert TimeLeft([float("nan"), 1.0]).left() is None


def test_a_stop_gives_up_whatever_is_done_and_another_case_only_a_case(working):
    assert worker._is_stop(Stop(2))
    assert not worker._is_stop(Compute(2, asked()))
    working._asked = asked(moving=True)
    assert working._gives_way(Stop(2))  # of what is dragged as well, within its second and a half
    working.answer(Stop(9))
    assert working.said == [(9, "stopped", {})]


def test_a_stop_takes_everything_that_waits_and_a_case_only_cases():
    said = []
    inbox = Inbox(SimpleNamespace(send=said.append))
    inbox.put(Export(1, asked(), "report", "x"))
    inbox.put(Compute(2, asked()))
    inbox.put(Compute(3, asked()))
    assert [(one.number, one.what) for one in said] == [(2, "dropped")]
    inbox.put(Stop(4))
    assert [(one.number, one.what) for one in said[1:]] == [(1, "dropped"), (3, "dropped")]
    assert inbox.newest == Stop(4)
    inbox.watch(worker._is_stop)
    with pytest.raises(Unwanted):
        inbox.look()
    assert inbox.take() == Stop(4)


# ---- at a glance -----------------------------------------------------------------------------------------------------
def test_small_pictures_are_of_figures_by_their_keys():
    assert keys_of(("te", "pressure", "nothing")) == {"transmission_error_", "load_sharing_"}
    assert keys_of(()) == {PICTURES[one].key for one in (*USUAL, *USUAL_WIDE, *USUAL_SET)}
    assert [PICTURES[one].panel for one in ("te", "stiffness", "pressure", "set-te")] == [1, 2, 2, 2]


def test_the_strip_has_numbers_with_the_digits_of_their_errors():
    found = numbers_of((
        Value("I.te_peak_to_peak", 1.23456e-6, "um", 2e-8), Value("I.driver.S_F", 1.23456), Value("I.something", 1.0),
        Value("I.mesh_stiffness_mean", 2e8, "N/um", 0.0),
    ))  # fmt: skip
    assert list(found) == ["I.te_peak_to_peak", "I.driver.S_F", "I.mesh_stiffness_mean"]
    te, safety = found["I.te_peak_to_peak"], found["I.driver.S_F"]
    assert (te["text"], te["error"], te["unit"], te["subject"], te["name"]) == (
        "1.235", "0.020", "µm", "I", "te_peak_to_peak",
    )  # fmt: skip
    assert (safety["text"], safety["error"], safety["label"]) == ("1.235", "", "S_F, driver")
    assert found["I.mesh_stiffness_mean"]["error"] == ""


def test_what_a_case_cannot_have_leaves_its_place_empty(monkeypatch):
    def make_plan(scene, stages, tasks):
        if "impossible" in tasks:
            raise InputError("x", "y", "is not to be had")
        return tasks

    monkeypatch.setattr(glance, "make_plan", make_plan)
    assert glance.plan_with(None, ["a", "b"], ["c"]) == ["a", "b", "c"]
    assert glance.plan_with(None, ["a", "impossible", "b"], ["c"]) == ["a", "b", "c"]
    with pytest.raises(InputError, match="is not to be had"):
        glance.plan_with(None, ["a"], ["impossible"])


def test_an_export_holds_the_results_where_its_format_takes_them(working, tmp_path):
    text = """
results = ["geometry"]
gear.a = { teeth = 20, module = "3 mm", face_width = "20 mm" }
gear.b = { teeth = 33, module = "3 mm", face_width = "20 mm" }
pair.I = { driver = "a", driven = "b", torque = "50 N*m", speed = "900 rpm" }
"""
    working._do(Export(1, Asked(text, "box", "."), "rexs", str(tmp_path / "out")))
    assert [what for _, what, _ in working.said] == ["exported"]
    model = (tmp_path / "out" / "box.rexs").read_text("utf-8")
    ratio = re.search(r'id="radial_contact_ratio"[^>]*>([^<]*)<', model)
    pair = scene_of(Asked(text, "box", ".")).pairs["I"]
    assert ratio is not None
    assert float(ratio[1]) == pytest.approx(pair.contact_ratio, rel=1e-9)


def test_figures_that_a_page_can_draw_are_sent_and_pictures_and_what_is_not_made_yet_are_not():
    line = Panel(Axis("x"), Axis("y"), (Curve(np.arange(2.0), np.arange(2.0), "one"),))
    points, corners = np.zeros((3, 3)), np.zeros((3, 1), dtype=int)
    body = Panel(Axis(""), Axis(""), (Skin(points, corners, np.zeros(3), 1.0, "stress", "MPa"),))
    figures = Figure("drawn", "Drawn", "", (line,)), Figure("body", "Body", "", (body,)), SimpleNamespace(key="later")
    said = []
    worker = SimpleNamespace(
        _asked=None, _later=[], _waits=lambda *_: False, _unseen=lambda *_: False,
        _sent=SimpleNamespace(news=lambda found: found),
        _say=lambda kind, **more: said.append((kind, more)),
    )  # fmt: skip
    task = Task("geometry", "a")
    plan = SimpleNamespace(steps=[SimpleNamespace(task=task, stage=SimpleNamespace(title="Geometry"))])
    scene = SimpleNamespace(case=SimpleNamespace(accuracy=SimpleNamespace(tolerance=0.01)))
    outcome = SimpleNamespace(figures=figures, values=(), tables=(), data=None)
    Worker._found(worker, scene, plan, task, outcome, "draft")
    ((kind, found),) = said
    assert (kind, found["title"], found["draft"]) == ("found", "Geometry: a", "draft")
    assert [one["key"] for one in found["figures"]] == ["drawn"]
