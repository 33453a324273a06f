"""Orders of results, levels of double helical pairs, whole numbers on axes, titles and pictures of the window."""

import re
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built import measured_strain
from fegear.engine.run_answer import in_order
from fegear.engine.sheet.chart import Chart
from fegear.engine.stage import Task
from fegear.results.planetary import planet_set
from fegear.results.train import design_chart_sheet, natural_modes
from fegear.window import inputs, pictures


def test_a_result_without_an_answer_stands_before_what_describes_the_gears_and_behind_what_leads():
    def step(name):
        return SimpleNamespace(task=Task(name, "I"), wanted=True, stage=SimpleNamespace(results=(name,)))

    names = ("about", "none", "leads", "later")
    answers = {
        "about": SimpleNamespace(background=True, leads=False), "none": None,
        "leads": SimpleNamespace(background=False, leads=True), "later": SimpleNamespace(background=False, leads=False),
    }  # fmt: skip
    outcomes = {Task(name, "I"): SimpleNamespace(answer=answer) for name, answer in answers.items()}
    plan = SimpleNamespace(steps=[step(name) for name in names])
    unknown = Task("helper", "I")
    found = in_order([unknown, *outcomes], plan, outcomes, names)
    assert [task.stage for task in found] == ["leads", "none", "later", "about", "helper"]


@pytest.mark.parametrize(("halves", "torques"), [(1, [50.0, 100.0]), (2, [100.0, 200.0])])
def test_torques_of_a_trace_are_those_of_both_halves(monkeypatch, halves, torques):
    """1 and 2 kN in a half at a base radius of 50 mm."""
    asked = []
    monkeypatch.setattr(measured_strain, "torque_levels", lambda *given: asked.append(given) or {})
    monkeypatch.setattr(measured_strain, "no_level", lambda *_: InputError("torque", "", "has no level"))
    placed = SimpleNamespace(driver=SimpleNamespace(base_radius=0.05), ratio=1.5)
    mesh = SimpleNamespace(all_loads=lambda _: (1e3, 2e3), normal_load=lambda _: 2e3, halves=halves)
    scene = SimpleNamespace(pairs={"I": placed}, case=SimpleNamespace(pair={"I": mesh}))
    part = SimpleNamespace(torque_band=0.02, file="t.csv", fit=())
    with pytest.raises(InputError, match="has no level"):
        measured_strain._levels(scene, part, "I", 0.3, "key", np.zeros(3), np.ones(3), np.full(3, 2.0))
    ((torque, angle, pitch, levels, band),) = asked
    assert levels == pytest.approx(torques)
    assert (torque.tolist(), angle.tolist(), pitch, band) == ([2.0] * 3, [0.0] * 3, 0.3, 0.02)


def test_modes_and_planets_are_counted_by_whole_numbers():
    for sheet, counted in ((natural_modes._SHEET, "mode"), (planet_set._SHEET, "planet")):
        panels = [over for one in sheet.figures if isinstance(one, Chart) for over in one.panels]
        of_counts = [one for one in panels if isinstance(one.x, str) and one.x == counted]
        assert all(one.x_options.get("whole") for one in of_counts)
        assert of_counts or counted == "planet"


def test_a_design_chart_counts_every_run_that_it_took():
    """One without relief, its grid, and three for each unequal relief: it, and either amount on both gears."""
    given = {key: of for key, of in design_chart_sheet.__dict__.items() if hasattr(of, "settings")}
    (sheet,) = [of for of in given.values() if isinstance(of.settings, dict) and "points" in of.settings]

    def points(rows, columns, unequal):
        data = SimpleNamespace(dynamic_factor=np.zeros((rows, columns)), unequal=[None] * unequal)
        return sheet.settings["points"](SimpleNamespace(data=data))

    assert points(0, 0, 0) == 1
    assert points(3, 4, 0) - points(0, 0, 0) == 12
    assert points(3, 4, 2) - points(3, 4, 0) == 6


# ---- window ----------------------------------------------------------------------------------------------------------
class Page:
    """What is put on a page, in order."""

    def __init__(self):
        self.written = []

    @contextmanager
    def _within(self):
        yield self

    def element(self, _kind):
        return SimpleNamespace(classes=lambda name: self.written.append(("in", name)) or self._within())

    def html(self, text, tag, sanitize=None):
        self.written.append((tag, text))
        return SimpleNamespace(classes=lambda _: None)


@pytest.mark.parametrize(("path", "shown"), [
    (("gear", "a"), [("in", ""), ("h3", "Gear a"), ("p", "of it")]),
    (("gear", "a", "spacing_errors"), [("in", "inner"), ("h3", "spacing errors")]),
    (("gear", "a", "relief", "tip_relief"), [("in", "inner"), ("h3", "tip relief")]),
    ((), [("in", "")]),
])  # fmt: skip
def test_a_table_within_a_section_is_called_by_its_own_key(monkeypatch, path, shown):
    page = Page()
    monkeypatch.setattr(inputs, "ui", page)
    fields = []
    own = SimpleNamespace(_field=fields.append, _rest=lambda section, left: fields.append(left))
    section = SimpleNamespace(path=path, title="Gear a", about="of it", given=("x", "y"), left_out=("z",))
    inputs.Inputs._section(own, section)
    assert page.written == shown
    assert fields == ["x", "y", ("z",)]


def drawn(svg):
    """Points of the paths of a picture, by their look."""
    found = {}
    for look, line in re.findall(r'<path class="(\w+)" d="M([^"Z]*)Z?"', svg):
        points = [[float(x) for x in one.split(",")] for one in line.split("L")]
        found.setdefault(look, []).append(np.array(points).T)
    return found


def test_the_picture_of_a_face_has_its_load_and_the_mean_of_it_over_the_same_face():
    parts = drawn(pictures._face())
    (load,), (mean,) = parts["driven"], parts["way"]
    assert load[0][[0, -1]] == pytest.approx(mean[0])
    assert np.diff(load[1]).max() <= 0.0  # it grows along the face; down is positive in a picture
    assert load[1].min() < mean[1][0] < load[1].max()
    assert all(one[0][[0, -1]] == pytest.approx(mean[0]) for one in parts["axis"])
    assert len(parts["axis"]) == 5


def test_pictures_stay_in_their_frame_but_for_gears():
    for one in (pictures._face, pictures._relief):
        for lines in drawn(one()).values():
            for x, y in lines:
                assert x.min() >= 0.0
                assert x.max() <= pictures._WIDE
                assert y.min() >= 0.0
                assert y.max() <= pictures._HIGH
