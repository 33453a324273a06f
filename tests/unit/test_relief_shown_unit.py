"""What a designed relief shows of its charts: only those of the design to be ground are recommended."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.results.relief import relief_shown
from fegear.results.relief.relief_shown import FlankRelief, Leaves, ReliefShown

SHAPES = "linear", "parabolic"
OVER = {"over": "range"}


def shown(monkeypatch, te, recommended):
    design = Space(shapes=SHAPES, te=te, ground={
        shape: Space(driver=f"{shape} of driver", driven=f"{shape} of driven") for shape in SHAPES
    })  # fmt: skip
    pair = Space(gear=lambda member: f"spec of {member}")
    reliefs = {"driver_relief": "now of driver", "driven_relief": "now of driven"}
    data = Space(design=design, pair=Space(pair=pair, engagement=Space(pair=pair, **reliefs)))
    asked = Space(gears={"driver": "p", "driven": "w"}, tolerances=("fine", "coarse"))
    made = ReliefShown(data, asked)
    made.__dict__["grinding"], made.__dict__["over_range"] = ("rows",), OVER

    def design_to_grind(rows, over):
        assert (rows, over) == (("rows",), OVER)
        return recommended

    def active(given, member):
        assert given is pair
        return f"active of {member}"

    monkeypatch.setattr(relief_shown, "recommended_design", design_to_grind)
    monkeypatch.setattr(relief_shown, "active_profile", active)
    monkeypatch.setattr(relief_shown, "profile_chart", lambda *given, recommended: (*given, recommended))
    return made


@pytest.mark.parametrize("recommended", ["linear tip relief", "parabolic tip relief", ""])
@pytest.mark.parametrize("present", [True, False])
def test_charts_are_of_each_shape_and_gear_and_one_design_is_recommended(monkeypatch, recommended, present):
    te = {"no relief": 1, "present relief": 2} if present else {"no relief": 1}
    charts = shown(monkeypatch, te, recommended).profile_charts
    assert charts == {
        f"{shape} tip relief": tuple(
            (gear, f"spec of {member}", f"{shape} of {member}", allowed, f"now of {member}" if present else None,
             f"active of {member}", f"{shape} tip relief" == recommended)
            for gear, member, allowed in (("p", "driver", "fine"), ("w", "driven", "coarse"))
        )
        for shape in SHAPES
    }  # fmt: skip


def test_what_reliefs_leave_is_ordered_by_what_is_to_be_ground():
    design = Space(shapes=("parabolic", "linear"))
    made = ReliefShown(Space(design=design), None)
    names = ["linear tip relief", "other", "no relief", "parabolic tip relief", "present relief"]
    made.__dict__["left"] = dict(zip(names, range(5), strict=True))
    assert list(made.best_first.items()) == [
        ("parabolic tip relief", 3), ("no relief", 2), ("present relief", 4), ("linear tip relief", 0), ("other", 1),
    ]  # fmt: skip
    made.__dict__["left"] = {"linear tip relief": 0}
    assert made.best_first == {"linear tip relief": 0}
    made.__dict__["tips"] = tips = tuple(Space(shape=one) for one in ("linear", "parabolic", "linear"))
    assert (made.best_tips, made.other_tips) == (tips[1:2], (tips[0], tips[2]))


def test_a_relief_is_drawn_above_its_least_between_the_ends_of_its_load():
    table = Space(relief=np.array([3e-6, 1e-6, 2e-6]), load=np.array([0.0, 5.0, 7.0]), roll_angle=np.array([1.0, 2, 3]))
    one = FlankRelief("p", "pinion", "driver", table, None, None, {}, ("mark",))
    np.testing.assert_allclose(one.above_least, [2e-6, 0.0, 1e-6], atol=1e-20)


@pytest.mark.parametrize(("size", "words"), [(1.2345e-6, "1.23 µm"), (0.0, "0"), (12.3e-6, "12.3 µm")])
def test_what_is_left_in_words(size, words):
    te = Space(peak_to_peak=size, mean=2e-6)
    harris = Space(transmission_error=np.array([[1e-6, 2e-6], [3e-6, 4e-6]]), nearest=[1], x=np.array([0.0, 1.0]))
    one = Leaves(te, None, harris, None)
    assert one.peak_to_peak == words
    np.testing.assert_allclose(one.minus_mean, [1e-6, 2e-6])
    assert one.map_error is None
    np.testing.assert_array_equal(Leaves(te, None, harris, 1e-9).map_error, np.full((2, 2), 1e-9))


def test_the_loading_of_least_stress_is_that_per_load_and_its_root():
    chosen = Space(stress=2.0, pressure=3.0, candidates=[(None, 0.5, 4.0, 5.0), (7, 0.6, 6.0, 8.0)])
    task = Space(load=100.0, loading=Space(peak=0.7))
    made = ReliefShown(Space(design=Space(chosen=chosen, task=task)), None)
    least = made.least_stress
    assert (least.family, least.peak, least.root_tension, least.hertz_pressure) == ("", 0.7, 200.0, 30.0)
    rows = [(one.family, one.peak, one.root_tension, one.hertz_pressure) for one in made.tried]
    assert rows == [("sinusoidal", 0.5, 400.0, 50.0), ("polynomial, r = 7", 0.6, 600.0, 80.0)]
    none = ReliefShown(Space(design=Space(chosen=None, task=task)), None)
    assert (none.least_stress, none.tried) == (None, ())


@pytest.mark.parametrize("given", [True, False])
def test_rounded_numbers_are_those_of_the_best_shape_at_the_design_load(given):
    task = Space(load=200.0, over_loads=(100.0, 200.0, 300.0), over="range")
    rounded = {"linear": [1e-6, 2e-6, 3e-6], "parabolic": [4e-6, 5e-6, 6e-6]} if given else {}
    made = ReliefShown(Space(design=Space(shapes=("parabolic", "linear"), task=task, rounded=rounded, ground=rounded)),
                       None)  # fmt: skip
    assert made.at_design_load == 1
    assert made.rounded == (5e-6 if given else None)
    assert made.for_range is given
    assert not ReliefShown(Space(design=Space(task=Space(over=None), ground={"linear": 1})), None).for_range


def test_flanks_and_what_is_left_over_a_range_are_of_this_design_and_pair(monkeypatch):
    design = Space(ground={"linear": Space(driver=Space(removal=lambda roll: 2.0 * roll))})
    data = Space(design=design, pair=Space(pair="pair", shifted="shifted"))
    made = ReliefShown(data, Space(labels={"driver": "label"}, gears={"driver": "gear"}))
    monkeypatch.setattr(relief_shown, "left_over_range", lambda *given: given)
    assert made.over_range == (design, "pair", "shifted")
    monkeypatch.setattr(relief_shown, "roll_marks", lambda *given: given)
    monkeypatch.setattr(relief_shown, "replace", lambda table, relief: (table, relief.tolist()))
    table = Space(roll_angle=np.array([1.0, 3.0]))
    one = made._flank("driver", table, "diagonal", "error")
    assert (one.label, one.gear, one.member, one.table) == ("label", "gear", "driver", table)
    assert (one.diagonal, one.error, one.marks) == ("diagonal", "error", ("pair", "driver"))
    assert one.ground == {"linear tip relief": (table, [2.0, 6.0])}
