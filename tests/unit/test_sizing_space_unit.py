"""How many variants requirements have, which, and when there are none or too many: counted one by one."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.design.sizing import space as space_module
from fegear.design.sizing.space import SizingSpace, variant_of

SPACE = SizingSpace(
    (2e-3, 3e-3), (math.radians(20.0),), (0.0, math.radians(10.0), math.radians(15.0)), (1.0, 1.1), (20e-3, 30e-3), (),
    (20, 22), 2.0, 0.03, False, (0.1, 0.3), (0.0, 0.2, 0.5), None, (-1.0, 1.0),
)  # fmt: skip


def by_hand(one):
    teeth = [
        (z_1, z_2) for z_1 in range(one.pinion_teeth[0], one.pinion_teeth[1] + 1) for z_2 in range(z_1, 200)
        if abs(z_2 / z_1 / one.ratio - 1.0) <= one.tolerance + 1e-9 and (not one.hunting or math.gcd(z_1, z_2) == 1)
    ]  # fmt: skip
    widths = one.widths or one.relative_widths
    return list(itertools.product(one.modules, one.alphas, one.betas, one.heights, widths, teeth)), teeth


@pytest.mark.parametrize("change", [
    {}, {"hunting": True}, {"tolerance": 0.0}, {"ratio": 1.0, "tolerance": 0.1}, {"distances": (70e-3, 70e-3)},
    {"distances": (60e-3, 80e-3)}, {"widths": (), "relative_widths": (0.5, 0.8, 1.1)},
])  # fmt: skip
def test_variants_are_all_combinations_each_once(change):
    one = replace(SPACE, **change)
    rows, teeth = by_hand(one)
    assert sorted(one.pairs_of_teeth) == sorted(teeth)
    per_row = len(one.shifts) * (1 if one.fixed else len(one.sums))
    assert (one.per_row, one.count) == (per_row, len(rows) * per_row)
    pairs = one.pairs(np.arange(one.count))
    seen = {variant_of(pairs, k) for k in range(one.count)}
    assert len(seen) == one.count
    sums = {round(sum(variant.profile_shift), 9) for variant in seen}
    assert one.fixed or sums == {0.0, 0.2, 0.5}
    assert {variant.profile_shift[0] for variant in seen} == {0.1, 0.3}
    assert {variant.teeth for variant in seen} == set(teeth)


def test_as_many_variants_as_the_limit_are_looked_at_and_one_more_is_refused(monkeypatch):
    rows, _ = by_hand(SPACE)
    count = 6 * len(rows)
    monkeypatch.setattr(space_module, "MOST", count)
    SPACE.refuse_none_or_too_many()
    monkeypatch.setattr(space_module, "MOST", count - 1)
    with pytest.raises(InputError, match=f"{count:,} variants.*limit of {count - 1:,}"):
        SPACE.refuse_none_or_too_many()
    with pytest.raises(InputError, match="variants"):
        replace(SPACE, widths=(), relative_widths=(0.5, 0.8)).refuse_none_or_too_many()
    with pytest.raises(InputError, match="not met by any numbers of teeth"):
        replace(SPACE, ratio=2.024, tolerance=0.0).refuse_none_or_too_many()


def test_chunks_hold_all_variants_in_order(monkeypatch):
    small = replace(SPACE, modules=(2e-3,), heights=(1.0,), pinion_teeth=(20, 20))
    for size in (1, 7, 60, 10**6):
        monkeypatch.setattr(space_module, "_CHUNK", size)
        chunks = list(small.chunks())
        np.testing.assert_array_equal(np.concatenate([numbers for numbers, _ in chunks]), np.arange(small.count))
        assert max(numbers.size for numbers, _ in chunks) <= max(size, small.per_row)
        assert len(chunks) == -(-len(small.pairs_of_teeth) * 6 // max(size // small.per_row, 1))
        assert all(pairs.teeth.shape == (2, numbers.size) for numbers, pairs in chunks)
    whole, few = SPACE.pairs(np.arange(SPACE.count)), SPACE.pairs(np.array([5, 100, 2]))
    assert [variant_of(few, k) for k in range(3)] == [variant_of(whole, k) for k in (5, 100, 2)]


def inv(angle):
    return math.tan(angle) - angle


@pytest.mark.parametrize("fixed", [False, True])
def test_sum_of_shifts_and_distance_belong_together_by_the_involute(fixed):
    one = replace(SPACE, distances=(65e-3, 65e-3), shortened=True) if fixed else SPACE
    pairs = one.pairs(np.arange(one.count))
    checked = 0
    for k in range(0, one.count, 13):
        m, a_n, beta, z = pairs.module[k], pairs.pressure_angle[k], pairs.helix_angle[k], pairs.teeth[:, k]
        alpha, half = math.atan(math.tan(a_n) / math.cos(beta)), 0.5 * m * z.sum() / math.cos(beta)
        if not abs(half * math.cos(alpha) / pairs.centre_distance[k]) < 1.0:
            assert math.isnan(pairs.profile_shift[1, k])
            continue
        checked += 1
        working = math.acos(half * math.cos(alpha) / pairs.centre_distance[k])
        total = z.sum() * (inv(working) - inv(alpha)) / (2.0 * math.tan(a_n))
        assert pairs.profile_shift[:, k].sum() == pytest.approx(total, abs=1e-9)
    assert checked


def test_widths_by_the_reference_circle_are_whole_millimetres_above_it():
    one = replace(SPACE, widths=(), relative_widths=(0.5, 0.8))
    pairs = one.pairs(np.arange(one.count))
    d_1 = pairs.teeth[0] * pairs.module / np.cos(pairs.helix_angle)
    row = np.arange(one.count) // one.per_row // len(one.pairs_of_teeth)
    exact = np.array(one.relative_widths)[row % 2] * d_1 * 1e3
    assert pairs.face_width * 1e3 == pytest.approx(np.round(pairs.face_width * 1e3), abs=1e-9)
    assert (pairs.face_width * 1e3 >= exact - 1e-6).all()
    assert (pairs.face_width * 1e3 < exact + 1.0).all()


def test_what_lies_at_an_end_is_named():
    first, last = SPACE.on_bounds(0), SPACE.on_bounds(SPACE.count - 1)
    assert [name.split(" (")[0] for name in first] == [
        "normal_modules",
        "helix_angles",
        "addenda",
        "face_width",
        "pinion_teeth",
        "pinion_shifts",
        "shift_sums",
    ]
    assert all(name.endswith("(minimum)") for name in first)
    assert all(name.endswith("(maximum)") for name in last)
    relative = replace(SPACE, widths=(), relative_widths=(0.5, 0.8), distances=(70e-3, 70e-3))
    assert "width_ratios (minimum)" in relative.on_bounds(0)
    assert not any("shift_sums" in name for name in relative.on_bounds(0))


@pytest.mark.parametrize(("pinion", "ratio"), [(17, 2.0), (25, 1.12), (25, 1.16), (25, 2.28)])
def test_a_ratio_that_whole_numbers_meet_exactly_is_met_by_them_in_spite_of_round_off(pinion, ratio):
    one = replace(SPACE, pinion_teeth=(pinion, pinion), ratio=ratio, tolerance=0.0)
    assert one.pairs_of_teeth == ((pinion, round(pinion * ratio)),)
    least = replace(SPACE, pinion_teeth=(20, 20), ratio=1.0, tolerance=0.1)  # the wheel is no smaller than the pinion
    assert least.pairs_of_teeth == ((20, 20), (20, 21), (20, 22))


@pytest.mark.parametrize("shortened", [True, False])
@pytest.mark.parametrize("fixed", [True, False])
def test_tools_clear_the_roots_and_tips_are_shortened_as_far_as_centres_come_closer_than_shifts(fixed, shortened):
    distances = (65e-3, 65e-3) if fixed else (60e-3, 80e-3)
    one = replace(SPACE, distances=distances, shortened=shortened, root_clearance=0.3, rack_tip_radius=0.2)
    pairs = one.pairs(np.arange(one.count))
    np.testing.assert_allclose(pairs.dedendum - pairs.addendum, 0.3)
    np.testing.assert_array_equal(pairs.rack_tip_radius, 0.2)
    assert not fixed or (pairs.centre_distance == 65e-3).all()
    by_reference = 0.5 * pairs.module * pairs.teeth.sum(axis=0) / np.cos(pairs.helix_angle)
    closer = (pairs.centre_distance - by_reference) / pairs.module - pairs.profile_shift.sum(axis=0)
    expected = np.where(np.isnan(closer), np.nan, np.minimum(closer, 0.0)) if shortened else np.zeros(one.count)
    np.testing.assert_allclose(pairs.tip_alteration, expected, atol=1e-12)
    assert not shortened or (pairs.tip_alteration < -0.01).any()


def test_a_width_that_is_whole_millimetres_stays_it_in_spite_of_round_off():
    """b = 0.8 d_1 of a module of 2.5 mm: 2 mm for every tooth."""
    one = replace(SPACE, widths=(), relative_widths=(0.8,), betas=(0.0,), modules=(2.5e-3,), pinion_teeth=(17, 30))
    pairs = one.pairs(np.arange(one.count))
    np.testing.assert_allclose(pairs.face_width, 2e-3 * pairs.teeth[0], rtol=1e-12)


def test_every_variant_names_the_ends_that_its_own_numbers_lie_at():
    one = replace(SPACE, shifts=(0.1, 0.2, 0.3, 0.4), sums=(0.0, 0.2, 0.5, 0.6))
    pairs = one.pairs(np.arange(one.count))
    for k in range(0, one.count, 7):
        x = pairs.profile_shift[:, k]
        values = {
            "normal_modules": (pairs.module[k], 2e-3, 3e-3), "helix_angles": (pairs.helix_angle[k], 0.0, one.betas[-1]),
            "addenda": (pairs.addendum[k], 1.0, 1.1), "face_width": (pairs.face_width[k], 20e-3, 30e-3),
            "pinion_teeth": (pairs.teeth[0, k], 20, 22), "pinion_shifts": (x[0], 0.1, 0.4),
            "shift_sums": (round(x.sum(), 9), 0.0, 0.6),
        }  # fmt: skip
        named = [f"{name} ({word})" for name, (value, low, high) in values.items()
                 for word, end in (("minimum", low), ("maximum", high)) if value == end]  # fmt: skip
        assert one.on_bounds(k) == tuple(named)
