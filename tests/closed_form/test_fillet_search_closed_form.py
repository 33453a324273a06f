"""The search for the least stressed fillet with stresses made up, whose least is known; and its final numbers."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError, GeometryError
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.maker import load_plane
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress
from fegear.design.fillet import fillet_design
from fegear.design.fillet.fillet_bench import SHARES, FilletBench, Judged
from fegear.design.fillet.fillet_design import FilletDesign, LoadedSolved, Stressed, design_fillet
from fegear.design.fillet.fillet_limits import Limits
from fegear.design.fillet.fillet_search import KEPT, Found, search
from fegear.design.fillet.moved_ellipses import MovedEllipses
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

M, LOAD = 3.175e-3, 1615.0
TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25), tip_rounding=0.12)
GEAR = Gear(TOOTH, M, 0.5 * TOOTH.root_radius * M, 6.35e-3)
SPEC = PairSpec(GearPair(GEAR, GEAR), (LOAD,))


class Bench:
    """Stress and room as functions of the numbers; a fillet whose second number is too large cannot be."""

    def __init__(self, stress, room, most=math.inf):
        self.stress, self.room, self.most, self.tried = stress, room, most, 0
        self.limits = SimpleNamespace(generated=False)

    def tooth(self, numbers):
        if numbers[1] > self.most:
            raise GeometryError("fillet", "here", "cannot be")
        return numbers

    def judged(self, numbers):
        self.tried += 1
        return Judged(np.asarray(self.stress(*numbers)), np.asarray(self.room(*numbers)))


FAMILY = SimpleNamespace(
    spread=np.array([0.5, 0.02]), lower=np.array([0.0, -math.inf]), upper=np.array([1.0, math.inf]),
    shape=lambda numbers: numbers,
)  # fmt: skip


def least(stress, room=lambda a, b: [1.0], start=(0.5, 0.0), most=math.inf):
    return search(Bench(stress, room, most), FAMILY, 2.0, np.array(start))


def tent(a, b):
    """Four planes: least at a = 0.3, b = 0.05, where all meet at 1."""
    x, y = a - 0.3, 10.0 * (b - 0.05)
    return [1.0 + x + y, 1.0 - x + 0.5 * y, 1.0 + 0.2 * x - y, 1.0 - 0.1 * x - y]


def test_a_kink_is_found_where_all_points_are_stressed_alike():
    found = least(tent)
    assert found.stress == pytest.approx(1.0, abs=1e-3)
    assert found.numbers == pytest.approx([0.3, 0.05], abs=1e-3)
    assert found.kept
    assert found.room == 1.0
    assert 6 <= found.tried <= 60
    assert least(tent, start=(0.9, 0.1)).numbers == pytest.approx([0.3, 0.05], abs=1e-3)


def test_a_limit_holds_a_search_off_what_it_would_like():
    """Room for b of 0.04 only: the least is on it, where two planes meet."""
    found = least(tent, lambda a, b: [0.04 - b, 2.0])
    assert found.numbers[1] == pytest.approx(0.04, abs=1e-6)
    assert found.room == pytest.approx(0.0, abs=1e-6)
    assert found.stress == pytest.approx(max(tent(found.numbers[0], 0.04)), rel=1e-9)
    assert found.stress == pytest.approx(min(max(tent(a, 0.04)) for a in np.linspace(0.0, 1.0, 2001)), abs=2e-4)
    # a start that breaks it comes back; where nothing keeps it, the least broken is said to be broken
    assert least(tent, lambda a, b: [0.04 - b], start=(0.3, 0.2)).kept
    assert not least(tent, lambda a, b: [-0.1 - 0.0 * b]).kept
    assert Found(np.zeros(1), None, 1.0, 1, -0.9 * KEPT).kept
    assert not Found(np.zeros(1), None, 1.0, 1, -KEPT).kept


def test_the_flank_begins_between_its_ends_and_bowls_are_followed_to_their_bottom():
    """The first number is a share; without kinks a region of trust shrinks about the bottom."""
    assert least(lambda a, b: [1.0 + a + 10.0 * abs(b)], start=(0.5, 0.1)).numbers == pytest.approx(
        [0.0, 0.0], abs=1e-3
    )
    assert least(lambda a, b: [2.0 - a + b * b]).numbers[0] == pytest.approx(1.0)
    bowl = least(lambda a, b: [1.0 + (a - 0.4) ** 2 + 100.0 * (b - 0.03) ** 2], start=(0.9, -0.1))
    assert bowl.stress == pytest.approx(1.0, abs=1e-3)
    assert bowl.numbers == pytest.approx([0.4, 0.03], abs=0.03)


def test_where_a_fillet_cannot_be_slopes_are_taken_on_the_other_side():
    found = least(tent, most=0.06, start=(0.5, 0.06))
    assert found.numbers == pytest.approx([0.3, 0.05], abs=1e-3)
    assert found.stress == pytest.approx(1.0, abs=1e-3)
    with pytest.raises(GeometryError, match="not a fillet of this gear"):
        least(tent, most=-0.1)


@pytest.fixture(scope="module")
def loaded():
    solved = solve_gear(GEAR, settings_at(-5.0), reach=1, estimate_error=False)
    return load_plane(SPEC, (solved, solved), estimates=False), solved


@pytest.mark.parametrize("alike", [False, True])
def test_final_numbers_are_those_of_the_pair_with_that_tooth(loaded, alike):
    """Both gears are solved anew where one meshes with its like; half the range where both flanks are loaded."""
    pair, solved = loaded
    tooth = replace(TOOTH, rack=BasicRack(1.0, 1.25, 0.38))
    calls, made = [], []

    def solve(gear, tolerance, *, reach):
        calls.append((gear.tooth, tolerance, reach))
        made.append(solve_gear(gear, settings_at(-5.0), reach=reach))
        return made[0]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fillet_design, "solve_to_tolerance", solve)
        objective = "alternating" if alike else "tension"
        final = fillet_design._Final(LoadedSolved(pair, SPEC, (solved, solved), "driven", alike), None, objective, 0.02)
        found = final.stressed("new", tooth)
    assert calls == [(tooth, 0.02, 1)]
    (new,) = made
    assert new.gear == replace(GEAR, tooth=tooth)
    gears = (new, new) if alike else (solved, new)
    e = load_plane(replace(SPEC, pair=GearPair(gears[0].gear, new.gear)), gears, estimates=False).engagement
    known = tooth_stress(e, loaded_states(e, (), (LOAD,), roll_positions(e, 48)), "driven")
    tension, compression = float(known.largest_tension[0]), float(known.largest_compression[0])
    assert found.along.shape == SHARES.shape
    assert (found.name, found.tooth) == ("new", tooth)
    if alike:
        assert found.stress == found.along.max()
        assert 0.5 * tension < found.stress < 0.5 * (tension - compression) * 1.001
        assert found.error == pytest.approx(0.5 * (known.error(0) + known.compression_off(0)), rel=0.05)
    else:
        assert found.stress == pytest.approx(tension, rel=1e-6)
        assert found.along.max() == pytest.approx(tension, rel=2e-2)
        assert found.error == pytest.approx(known.error(0), rel=1e-6)


def _stressed(stress, error=0.0, name="x"):
    return Stressed(name, TOOTH, stress, error, np.full(3, stress))


def test_the_best_of_the_searches_that_keep_their_limits_is_the_design():
    found = {
        "waves": Found(np.zeros(1), "a", 100.0, 10, 0.1), "bumps": Found(np.zeros(1), "b", 98.0, 20, -1.0),
        "waves, other start": Found(np.zeros(1), "c", 99.0, 30, 0.0),
    }  # fmt: skip
    design = FilletDesign(
        "driver", _stressed(150.0, 3.0), _stressed(99.0, 0.99), _stressed(120.0, 1.2), found, (0.1, 0.2)
    )
    assert design.first == "waves, other start"
    assert (design.shapes, design.kept, design.tried) == (("c",), True, 60)
    assert design.spread == pytest.approx(100.0 / 98.0 - 1.0)
    assert design.off_by == 0.01
    assert design.gain(design.present) == pytest.approx((1.0 - 0.66, 0.66 * (0.01 + 0.02)))
    broken = {name: replace(one, room=-1.0) for name, one in found.items()}
    assert replace(design, found=broken).first == "bumps"
    assert not replace(design, found=broken).kept


def test_a_design_is_searched_thrice_from_what_can_be_and_loaded_with_three_teeth(loaded, monkeypatch):
    pair, solved = loaded
    searched, said = [], []

    def searching(bench, family, present, start):
        searched.append((family.basis, family.count, start[:2].tolist(), float(np.abs(start[2:]).sum())))
        assert (bench.member, bench.objective, bench.limits) == ("driver", "tension", Limits(0.02, 0.2))
        assert present == 77.0
        return Found(start, family.shape(start), 60.0 - len(searched), 7, 0.1)

    class Final:
        def __init__(self, *given):
            assert given == (asked, None, "tension", 0.5)

        def stressed(self, name, tooth):
            said.append((name, tooth))
            return _stressed(50.0, 1.0, name)

    monkeypatch.setattr(fillet_design, "search", searching)
    monkeypatch.setattr(fillet_design, "_Final", Final)
    monkeypatch.setattr(FilletBench, "largest", lambda bench, tooth: 77.0)
    progress, asked = [], LoadedSolved(pair, SPEC, (solved, solved), "driver", alike=True)
    design = design_fillet(asked, Limits(0.02, 0.2), tolerance=0.5, progress=progress.append)
    assert searched == [("waves", 7, [0.0, 0.0], 0.0), ("waves", 7, [0.4, 0.02], 0.0), ("bumps", 6, [0.3, 0.0], 0.0)]
    assert progress == [0.25, 0.5, 0.75, 1.0]
    assert [name for name, _ in said] == ["present", "optimum", "full fillet of a rack"]
    assert said[0][1] == TOOTH
    assert said[2][1].rack.tip_radius > 0.3
    assert design.first == "bumps"
    assert design.best.name == "optimum"
    assert design.off == (0.0, 0.0)
    assert len(design_fillet(asked, Limits(0.02, 0.2), tolerance=0.5, searches=1, waves=1).found) == 1
    assert searched[-1][:2] == ("waves", 1)
    monkeypatch.setattr(Final, "stressed", lambda final, name, tooth: None)
    with pytest.raises(ConvergenceError):
        design_fillet(asked, Limits(0.02, 0.2), tolerance=0.5, searches=1)


def test_starts_are_tried_in_turn_until_one_can_be():
    family = SimpleNamespace(start=MovedEllipses(None, 1.0, count=3).start, shape=lambda numbers: numbers)
    assert fillet_design._start(Bench(None, None), family, 0.1, 0.3).tolist() == [0.1, 0.3, 0.0, 0.0]

    class Few(Bench):
        def tooth(self, numbers):
            if numbers[0] < self.most:
                raise GeometryError("fillet", "here", "cannot be")
            return numbers

    for most, start in ((0.1, [0.2, 0.0]), (0.3, [0.4, 0.0]), (0.6, [0.7, 0.0]), (0.8, [0.9, 0.1])):
        assert fillet_design._start(Few(None, None, most), family, 0.05, 0.3)[:2].tolist() == start
    assert fillet_design._start(Few(None, None, 0.95), family, 0.05, 0.3) is None


def test_starts_that_a_rack_is_to_make_come_nearer_to_the_ellipse_until_one_can(monkeypatch):
    family = SimpleNamespace(start=MovedEllipses(None, 1.0, count=3).start, shape=lambda numbers: numbers)
    bench, made = Bench(None, None), {}
    bench.limits = SimpleNamespace(generated=True, smallest_tool_radius=0.1)

    monkeypatch.setattr(bench, "rack_room", lambda numbers: made["up to"] - numbers[1], raising=False)
    for most, start in (
        (0.5, [0.2, 0.4]),
        (0.3, [0.1, 0.2]),
        (0.11, [0.05, 0.1]),
        (0.06, [0.025, 0.05]),
        (0.04, [0, -0.03]),  # deeper than the ellipse itself, from which another search begins
    ):
        made["up to"] = most
        assert fillet_design._start(bench, family, 0.2, 0.4)[:2] == pytest.approx(start)
    made["up to"] = -1.0  # none: the first that is a fillet
    assert fillet_design._start(bench, family, 0.2, 0.4)[:2] == pytest.approx([0.2, 0.4])


def test_higher_waves_move_less_and_bumps_alike():
    assert MovedEllipses(None, 1.0, "waves", 3).spread[1:] / MovedEllipses(None, 1.0, "waves", 3).spread[1] == (
        pytest.approx([1.0, 1.0 / 1.5, 0.5])
    )
    bumps = MovedEllipses(None, 1.0, "bumps", 4).spread
    assert bumps.size == 5
    assert bumps[1:] == pytest.approx(np.full(4, 0.25 * MovedEllipses(None, 1.0, "waves", 4).spread[1]))
