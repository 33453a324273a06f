"""Laws that single functions of several rooms have, each against brute force or a count by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.case.built.flank_modifications import described_relief
from fegear.case.reading import build_scene
from fegear.contact.rack.over_stroke import BasePitch, root_stresses
from fegear.contact.unloaded.extremes import extremes
from fegear.design.tip_relief.extremes import Between
from fegear.geometry.path_of_contact import ActiveProfile
from fegear.output import grinding_tables
from fegear.studies.cost.result import observed_order


# ---- profile charts --------------------------------------------------------------------------------------------------
def test_an_active_profile_that_ends_with_the_involute_is_no_point_of_its_own(tmp_path, monkeypatch):
    """Where both end together they may differ by round-off; where they do not both are points."""
    tip = {"tip": {"amount": "10 um", "normalised_length": 0.3}}
    gears = {
        name: {"teeth": z, "module": "3 mm", "face_width": "10 mm", "relief": tip} for name, z in (("a", 28), ("b", 41))
    }
    pair = {"I": {"driver": "a", "driven": "b", "load": "1 kN"}}
    scene = build_scene({"results": ["geometry"], "gear": gears, "pair": pair}, "c", tmp_path)
    relief, gear = described_relief(scene, "a").relief, scene.gears["a"]

    def points(start, end):
        active = ActiveProfile(gear.form_radius * start, math.nan, math.nan, gear.involute_tip_radius * end)
        monkeypatch.setattr(grinding_tables, "active_profile", lambda _pair, _member: active)
        _, chart = grinding_tables.relief_tables_of(scene, "a", relief)
        assert np.diff(chart.column("roll_angle").values).min() > 1e-6
        return [one for one in chart.columns[0].values.tolist() if one]

    ends = ["start of involute", "end of involute"]
    assert points(1.0, 1.0) == points(1.0 + 1e-14, 1.0 - 1e-14) == points(1.0 - 1e-14, 1.0 + 1e-14) == ends
    assert points(1.001, 0.999) == [
        ends[0], "start of active profile, pair I", "end of active profile, pair I", ends[1]
    ]  # fmt: skip


# ---- observed orders -------------------------------------------------------------------------------------------------
def test_errors_that_lie_on_no_line_have_no_order():
    found = observed_order([1.0, 2.0, 4.0, 8.0], [1.0, 30.0, 1.0, 30.0])
    assert (found.used, found.words) == (0, "none: no 3 adjacent configurations within 1.6 of a line")
    assert math.isnan(found.slope)
    assert math.isnan(found.scatter)
    flat = observed_order([1.0, 2.0, 4.0], [1.0, 1.01, 1.02])
    assert (flat.used, flat.words) == (0, "none: the error does not decrease with the setting")
    few = observed_order([1.0, 2.0, 4.0], [1.0, 4.0, 16.0], floor=2.0)
    assert (few.used, few.words) == (0, "none: only 1 of 3 configurations are above the error of the reference")
    assert observed_order([1.0, 2.0], [1.0, 2.0]).words == "none: only 2 of 2 configurations have an error"
    # an even power; the coarsest that are off it are left out
    found = observed_order([8.0, 1.0, 4.0, 2.0], [1e4, 3.0, 48.0, 12.0])
    assert (found.slope, found.used, found.scatter) == (pytest.approx(2.0), 3, pytest.approx(1.0))
    assert found.words == "3 of 4 configurations, within a factor of 1.00 of the line"


# ---- extremes --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("start", [0.0, 1.3])
def test_smooth_functions_are_cut_but_a_few_times(start):
    """Cells of a smooth function are judged by the places in their middle, not by one end of them."""
    asked = []

    def function(x):
        asked.append(x.size)
        return np.sin(x) + 0.2 * np.cos(3.0 * x), np.cos(x) - 0.6 * np.sin(3.0 * x), np.zeros(x.size)

    low, high = extremes(function, start, 2.0 * math.pi)
    dense = np.linspace(0.0, 2.0 * math.pi, 200_001)
    wanted = function(dense)[0]
    asked.pop()
    assert (low.value, high.value) == (pytest.approx(wanted.min(), abs=1e-8), pytest.approx(wanted.max(), abs=1e-8))
    assert max(low.error, high.error) < 3e-8
    assert asked[0] == 2 * 96  # one period, each end once
    assert sum(asked[1:]) <= 60
    for one in (low, high):
        assert start <= one.angle <= start + 2.0 * math.pi
        assert function(np.array([one.angle]))[0][0] == pytest.approx(one.value, abs=1e-12)


# ---- stencils of four positions --------------------------------------------------------------------------------------
@pytest.mark.parametrize("sizes", [(4,), (3,), (4, 3, 5), (2, 6), (9, 4, 4)])
def test_every_interval_is_within_four_positions_of_its_own_piece(sizes):
    x, breaks = np.arange(float(sum(sizes))), np.cumsum(sizes)[:-1] - 0.5
    whole = np.ones(x.size - 1, dtype=bool)
    between = Between(Space(points=Space(breaks=breaks)), Space(x=x, whole=whole), None, None, 1.0)
    wanted, start = [], 0
    for size in sizes:
        for i in range(start, start + size - 1):
            inside = [k for k in range(start, start + size - 3) if k <= i - 1 <= k + 1 or k <= i <= k + 2]
            # as central as the piece permits: one position before the interval where there is one
            wanted.append(min(inside, key=lambda k: abs(k - (i - 1))) if inside else -1)
        wanted.append(None)  # the interval of the break itself
        start += size
    found = between._first
    assert [int(one) for one, asked in zip(found, wanted, strict=False) if asked is not None] == [
        one for one in wanted if one is not None
    ]
    assert all(found[k] == -1 for k, one in enumerate(wanted[:-1]) if one is None)


def test_intervals_that_are_not_whole_divide_a_piece_too():
    whole = np.ones(8, dtype=bool)
    whole[4] = False
    between = Between(Space(points=Space(breaks=np.array([]))), Space(x=np.arange(9.0), whole=whole), None, None, 1.0)
    assert between._first.tolist() == [0, 0, 1, 1, -1, 5, 5, 5]


# ---- root stress along a rack ----------------------------------------------------------------------------------------
class _Root:
    """The sum of what is felt; where a tooth is touched counts once in the largest."""

    def __init__(self, reach):
        self.reach, self.touched = reach, {}

    def superposed(self, felt, shape):
        total = np.zeros(shape)
        for one in felt:
            total += one.line_load[:, None] * one.row
        return total

    def largest(self, i, total, touched):
        self.touched[i] = touched.copy()
        return total.max(axis=1)


@pytest.mark.parametrize("side", ["tension", "compression"])
@pytest.mark.parametrize("reach", [0, 1, 2])
def test_root_stress_of_pinion_and_rack_is_the_sum_over_loaded_teeth(side, reach):
    chance, size, points, width, tooth = np.random.default_rng(reach), 5, 4, 0.02, 7
    number, loads = np.array([-1, 0, 1]), chance.uniform(1.0, 2.0, (3, size))
    loads[2, :2], loads[0] = 0.0, loads[0] * (reach < 2)  # the first pair bears nothing in one of the cases
    here = np.array([True] * size + [False])
    felt = {key: chance.normal(0.0, 1.0, (size + 1, points)) for key in
            [*(("pinion", i, r) for i in range(-4, 5) for r in range(3)),
             *(("rack", t, s, r) for t in range(2, 13) for s in range(2, 13) for r in range(3))]}  # fmt: skip
    pinion, rack = _Root(reach), _Root(reach)
    driven = Space(reach=reach, exists=lambda t: t <= 8)
    unit = Space(
        compliance=Space(face_width=width, driven=driven), side=side, pinion=pinion, rack=rack,
        of_pinion=lambda i, r: felt["pinion", i, r], of_rack=lambda t, s, r: felt["rack", t, s, r],
    )  # fmt: skip
    radius, height = chance.uniform(1.0, 2.0, (2, 3, size))
    contacts = Space(number=number, radius_driver=radius, radius_driven=height)
    found = BasePitch(np.arange(float(size)), contacts, loads, np.zeros(size))
    worst, teeth = root_stresses(unit, found, tooth, here)

    sign = 1.0 if side == "tension" else -1.0
    loaded = [r for r in range(3) if loads[r].any()]

    def stress(felt_by):
        return sum(loads[r][:, None] / width * one[here] for r, one in felt_by)

    by_pair = []
    for i in range(-4, 5):
        if near := [(r, felt["pinion", i, r]) for r in loaded if abs(i - number[r]) <= reach and -2 <= i <= 2]:
            by_pair.append(sign * stress(near).max(axis=1))
            at = [r for r in loaded if number[r] == i]
            touched = np.where(loads[at[0]] > 0.0, radius[at[0]], np.inf) if at else np.full(size, np.inf)
            np.testing.assert_array_equal(pinion.touched[i], touched)
    np.testing.assert_allclose(worst, sign * np.max(by_pair, axis=0))
    # tooth 7 is on pair 0, and pair j on tooth 7 - j; there is no tooth 9
    on = {tooth - int(number[r]): r for r in loaded}
    wanted = sorted(t for t in range(9) if any(abs(t - s) <= reach for s in on))
    assert sorted(teeth) == wanted
    for t in wanted:
        near = [(r, felt["rack", t, s, r]) for s, r in on.items() if abs(t - s) <= reach]
        np.testing.assert_allclose(teeth[t], stress(near).max(axis=1))
        own = on.get(t)
        touched = np.full(size, np.inf) if own is None else np.where(loads[own] > 0.0, height[own], np.inf)
        np.testing.assert_array_equal(rack.touched[t], touched)
