"""Files, places and words at their edges: by numbers that are counted by hand, locks and names that are taken."""

import json
import math
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.case.drafts.first_size import MODULES, module_for
from fegear.case.text_file import is_below
from fegear.commands.schema import _is_schema
from fegear.exchange.rexs import bearings
from fegear.exchange.rexs.set_bodies import _radial
from fegear.output import held_folder
from fegear.output.new_for_old import _free_name
from fegear.output.numbers import with_error
from fegear.results.pair.error_otherwise import orders_of_mate
from fegear.results.shafts.at_glance import BearingAtGlance
from fegear.results.shafts.gearbox_changes import change_of_life, shortest_life
from fegear.shafts.larger_bearing import BearingChange, LargerBearing
from fegear.studies import swept
from fegear.studies.sweep import Axis
from fegear.window import journal
from fegear.window.on_gears import _cracks


# ---- REXS ------------------------------------------------------------------------------------------------------------
class Said:
    """What components say; links by their other end."""

    def __init__(self):
        self.notes = []

    def number(self, one, _kind, *names):
        return next((one.says[name] for name in names if name in one.says), None)

    def word(self, one, *names):
        return next((one.says[name] for name in names if name in one.says), None)

    yes = word
    needed = number

    def linked(self, one, _role, _kind, other, *types):
        return [c for c in one.links.get(other, ()) if not types or c.type in types]


def component(number, kind, links=None, **says):
    return SimpleNamespace(id=number, type=kind, said=f"{kind} {number}", name="", says=says, links=links or {})


@pytest.mark.parametrize(
    ("first", "second", "coaxial"),
    [((3.0, 4.0), (3.0, 4.0), True), ((3.0, 4.0), (3.0, 5.0), False), ((3.0, 4.0), (2.0, 4.0), False),
     ((0.1, -0.2), (0.1, -0.2), True), ((0.1, 0.2), (0.1, -0.2), False)],
)  # fmt: skip
def test_shafts_are_coaxial_where_both_coordinates_across_agree(first, second, coaxial):
    places = {n: SimpleNamespace(v=v, w=w) for n, (v, w) in enumerate((first, second))}
    one, other = (component(n, "shaft") for n in (0, 1))
    assert bearings._coaxial(places, one, other) is coaxial
    assert bearings._coaxial(places, other, one) is coaxial
    assert not bearings._coaxial(places, one, one)
    assert not bearings._coaxial({0: places[0]}, one, other)
    assert not bearings._coaxial({1: places[1]}, one, other)


@pytest.mark.parametrize("count", [3.0, 7.0, 12.0, 30.0])
def test_balls_fit_on_their_pitch_circle_where_neighbours_do_not_overlap(count):
    """Centres of neighbours on a circle of 60 mm are a chord apart; balls that touch each other just fit."""
    corner = 30e-3 * np.exp(2j * math.pi / count * np.array([0.0, 1.0]))
    chord = abs(corner[1] - corner[0])
    for share, fits in ((0.999, True), (1.001, False)):
        ball = component(3, "rolling_element", diameter_of_rolling_element=share * chord)
        row = component(2, "rolling_bearing_row", {"part": [ball]}, number_of_rolling_elements=count,
                        reference_diameter=60e-3)  # fmt: skip
        said, one = Said(), component(1, "rolling_bearing", {"part": [row]}, bearing_type="deep_groove")
        found = bearings._rows(said, one)
        assert (found is not None) is fits
        assert len(said.notes) == (not fits)
        if fits:
            assert (found.count, found.diameter, found.pitch) == (count, share * chord, 60e-3)
            assert found.length is None


@pytest.mark.parametrize("count", [2.0, 2.5, 7.5])
def test_balls_are_whole_and_three_at_least(count):
    ball = component(3, "rolling_element", diameter_of_rolling_element=1e-3)
    row = component(2, "rolling_bearing_row", {"part": [ball]}, number_of_rolling_elements=count,
                    reference_diameter=60e-3)  # fmt: skip
    said = Said()
    assert bearings._rows(said, component(1, "rolling_bearing", {"part": [row]}, bearing_type="deep_groove")) is None
    assert "do not fit" in said.notes[0]


def test_what_holds_nothing_radially_has_no_stiffness_and_what_says_none_is_rigid():
    free = component(1, "rolling_bearing", radial_force_absorption=False, radial_stiffness=3e8)
    assert _radial(Said(), free) == 0.0
    assert _radial(Said(), component(2, "rolling_bearing", radial_stiffness=3e8)) == 3e8
    assert _radial(Said(), component(3, "rolling_bearing")) is None


def test_rollers_resist_tilt_and_balls_do_not():
    rows = SimpleNamespace(length=None)
    held = bearings.Held(component(1, "rolling_bearing", bending_stiffness=5.0), "b", 0.0, outside=False, rows=rows)
    assert not held.tilts(Said())
    rows.length = 8e-3
    assert held.tilts(Said())


# ---- files -----------------------------------------------------------------------------------------------------------
def test_a_kept_file_has_the_first_name_that_is_free(tmp_path):
    (tmp_path / "a").mkdir()
    for name in ("a/te.kept.csv", "a/te.kept2.csv", "a/te.kept3.csv"):
        assert _free_name(tmp_path, "a/te.csv") == name
        (tmp_path / name).write_text("")
    (tmp_path / "x.kept.csv").symlink_to("nowhere")  # a link to nothing is taken, too
    assert _free_name(tmp_path, "x.csv") == "x.kept2.csv"


def test_a_path_is_below_what_it_leads_to(tmp_path):
    inside, outside = tmp_path / "in", tmp_path / "out"
    inside.mkdir(), outside.mkdir()
    (inside / "link").symlink_to(outside)
    real = [os.path.realpath(inside)]
    assert is_below(inside / "case.toml", real)
    assert is_below(inside, real)
    assert not is_below(outside, real)
    assert not is_below(inside / "link" / "case.toml", real)
    assert not is_below(Path("a\0b"), [os.path.realpath("/")])


def test_a_schema_is_known_by_its_title():
    from fegear.case.schema import TITLE

    assert _is_schema(json.dumps({"title": TITLE}))
    assert not _is_schema(json.dumps({"title": "another"}))
    assert not _is_schema(json.dumps([TITLE]))
    assert not _is_schema("{")
    assert not _is_schema("[" * 100_000)


@pytest.mark.parametrize("still", [journal._is_still, held_folder._is_still])
def test_an_open_file_is_the_one_at_its_place_until_it_is_removed_or_replaced(tmp_path, still):
    place = tmp_path / "held"
    with place.open("w") as file:
        assert still(file, place) is True
        place.unlink()
        assert still(file, place) is False
        place.write_text("another")
        assert still(file, place) is False


def test_a_journal_is_held_by_one_window_and_by_each_where_nothing_can_be_locked(tmp_path, monkeypatch):
    import fcntl

    with (tmp_path / "j").open("w") as one, (tmp_path / "j").open("w") as other:
        assert journal._lock(one) is True
        assert journal._lock(other) is False

        def no_locks(*_):
            raise OSError(95, "not supported")

        monkeypatch.setattr(fcntl, "flock", no_locks)
        assert journal._lock(other) is True
        assert held_folder._lockable(tmp_path) is False
        monkeypatch.undo()
        assert held_folder._lockable(tmp_path) is True
        monkeypatch.setitem(sys.modules, "fcntl", None)  # Windows has none
        assert journal._lock(other) is True


def test_journals_are_where_they_are_told_or_below_the_user_s_state(monkeypatch, tmp_path):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path))
    assert journal.journal_folder() == tmp_path
    monkeypatch.delenv("FEGEAR_STATE")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert journal.journal_folder() == tmp_path / "fegear" / "unsaved"


# ---- numbers and words -----------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [(math.nan, 1.234, ("none", "1.2")), (2.5, math.inf, ("2.5", "∞")), (2.5, math.nan, ("2.5", "none")),
     (-math.inf, 0.0412, ("−∞", "0.041"))],
)  # fmt: skip
def test_what_is_not_finite_stands_beside_what_is(value, error, shown):
    assert with_error(value, error) == tuple(one.replace("−", "-") for one in shown)


def test_a_pinion_without_a_module_that_lasts_has_the_largest_of_the_series():
    assert module_for(1e9, 17) == MODULES[-1] * 1e-3
    assert module_for(1e-9, 17) == MODULES[0] * 1e-3
    assert module_for(1e-9, 17, least=MODULES[3] * 1e-3) == MODULES[3] * 1e-3
    some = [module_for(torque, 17) for torque in np.geomspace(1.0, 1e5, 12)]
    assert some == sorted(some)
    assert len(set(some)) > 6


def bearing(margin, change, hours=1000.0):
    return BearingAtGlance("A", "s", 1.0, 0.0, 60e6, hours * 3600.0, margin, 3.0, designation="6205", change=change)


def test_a_life_that_falls_short_is_told_with_the_bearing_that_fits():
    fitting = LargerBearing("6305", 25e-3, 62e-3, 17e-3, True, 90e6, 1)
    change = change_of_life(bearing(0.5, BearingChange(fitting, None, None)), 2000.0 * 3600.0)
    assert change.brief == "6305 instead of 6205"
    assert change.finding == "life 1000 h of 2000 h"
    assert change.remedy.endswith(", or C 2 times as large")
    without = change_of_life(bearing(0.5, BearingChange(None, None, None)), 2000.0 * 3600.0)
    assert without.brief == "a dynamic load rating C 2 times as large"
    assert change_of_life(bearing(0.5, None), 2000.0 * 3600.0).remedy == "a dynamic load rating C 2 times as large"
    assert change_of_life(bearing(1.0, None), 2000.0 * 3600.0) is None
    assert change_of_life(bearing(1.0 - 1e-9, None), 2000.0 * 3600.0) is not None


def test_the_least_reserve_of_life_is_told_with_a_tenth_more_load_rating():
    """Balls: life goes with the cube of C; 1.1^3 = 1.331."""
    one = shortest_life(bearing(1.5, None), 500.0 * 3600.0)
    assert not one.urgent
    assert one.finding == "life 1000 h, required 500 h: minimum reserve of bearings"
    assert one.remedy == "10 % more dynamic load rating C: 1330 h"
    fitting = LargerBearing("6305", 25e-3, 62e-3, 17e-3, True, 90e6, 1)
    assert shortest_life(bearing(1.5, BearingChange(fitting, None, None)), 500.0).remedy.startswith("6305 instead of")


# ---- traces ----------------------------------------------------------------------------------------------------------
def trace(own, mate, *, turns=3.0, teeth=20, mate_teeth=31):
    order = np.arange(0.0, 200.0, 1.0 / 3.0)
    amplitude = np.zeros(order.size)
    amplitude[np.isclose(order, teeth)], amplitude[np.isclose(order, mate_teeth)] = own, mate
    return SimpleNamespace(teeth=teeth, spectrum=SimpleNamespace(turns=turns, order=order, amplitude=amplitude))


@pytest.mark.parametrize(
    ("own", "mate", "turns", "of_mate"),
    [(1.0, 100.0, 3.0, True), (100.0, 1.0, 3.0, False), (1.0, 1.0, 3.0, False), (1.0, 100.0, 0.99, False),
     (1.0, 100.0, 1.0, True), (0.0, 100.0, 3.0, False)],
)  # fmt: skip
def test_a_trace_over_the_other_shaft_s_angle_has_the_orders_of_the_mate(own, mate, turns, of_mate):
    assert orders_of_mate(trace(own, mate, turns=turns), 31) is of_mate


# ---- figures ---------------------------------------------------------------------------------------------------------
def test_values_of_a_sweep_over_words_are_points_and_over_numbers_curves():
    words, numbers = Axis("pair.I.width", ("slices", "solid"), None), Axis("gear.a.bore", ("1 mm", "2 mm", "3 mm"),
                                                                          (1.0, 2.0, 3.0))  # fmt: skip
    number = np.arange(6.0)
    one = SimpleNamespace(number=number, name="te", error=None)
    over_numbers = swept._family(one, (words, numbers), numbers, words)
    assert [item.name for item in over_numbers] == ["width = slices", "width = solid"]
    assert np.array_equal([item.y for item in over_numbers], [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]])
    over_words = swept._family(one, (words, numbers), words, numbers)
    assert {type(item).__name__ for item in over_numbers} == {"Curve"}
    assert {type(item).__name__ for item in over_words} == {"Points"}
    for k, item in enumerate(over_words):
        assert np.array_equal(item.x, [0.0, 1.0])
        assert np.array_equal(item.y, number[[k, k + 3]])


# ---- window ----------------------------------------------------------------------------------------------------------
def test_a_crack_is_as_wide_as_its_faces_are_apart_at_the_mouth():
    moved = np.array([[3e-6, 9e-6, 0.0, 6e-6], [1e-6, 9e-6, 0.0, 5e-6]])
    one = SimpleNamespace(
        tooth=0, place=0, ends="path", back=False, path=np.zeros((2, 2)), outline=np.zeros((2, 3)),
        points=np.zeros((2, 4)), moved=moved, triangles=np.array([[0], [1], [2]]),
        mises=np.array([1e6, 50e6, 2e6, 1e6]),
        fillets=np.array([0, 2]), left=np.array([0, 1]), right=np.array([3, 2]), contact=np.zeros((2, 1)),
        k_1=(3e6, math.nan), k_2=(-1e6, 2e4), loss=0.1, closed=False,
    )  # fmt: skip
    data = SimpleNamespace(gear=SimpleNamespace(module=2e-3, tooth=SimpleNamespace(side=1)), radius=0.03, load=5e3,
                           pair="I", cracks=[one])  # fmt: skip
    shown = _cracks(data)
    (crack,) = shown["cracks"]
    assert crack["opening"] == pytest.approx(5.0)  # 3 and 4 um across each other
    assert crack["limit"] == pytest.approx(2.0)
    assert crack["faces"] == [[0, 1], [3, 2]]
    opening, sliding = crack["k"]
    assert opening == {"value": pytest.approx(3.0), "error": None}
    assert sliding == {"value": pytest.approx(-1.0), "error": pytest.approx(0.02)}
    lengths = shown["module"], shown["radius"], shown["load"]  # in mm, and N/mm
    assert lengths == pytest.approx((2.0, 30.0, 5.0))
