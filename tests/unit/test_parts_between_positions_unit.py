"""Parts by laws: places where pairs part as they move, quick sharing, pressures, modifications within tolerances."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.flanks.designed_flanks import FlankDesign
from fegear.design.flanks.trials import Tried
from fegear.design.quick_sharing import quick_sharing
from fegear.design.tip_relief import ground
from fegear.design.tip_relief.grindable import relief_over_path
from fegear.design.tip_relief.relief_scan import even_bench
from fegear.design.tip_relief.search import _are_like
from fegear.design.tip_relief.trials import Trials
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.over_balls import _R40, touching_ball, usual_ball
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import refuse_relief_elsewhere
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief

LOAD = 9000.0


def engaged(z1=24, z2=36, rack=BasicRack(1.0, 1.25, 0.2)):  # noqa: B008
    gears = [Gear(Tooth(z, rack), 3e-3, 0.1 * z * 3e-3, 0.03) for z in (z1, z2)]
    sources = [closed_form_compliance(gear, "cornell") for gear in gears]
    return Engagement(PairCompliance(GearPair(*gears), *sources, hertz="linear", nominal_load=LOAD))


@pytest.fixture(scope="module")
def pair():
    return engaged()


@pytest.fixture(scope="module")
def high():
    """Two or three pairs bear."""
    found = engaged(45, 60, BasicRack(1.35, 1.55, 0.1))
    assert found.pair.contact_ratio > 2.1
    return found


def bent(trials, p):
    """Where the error of one relief bends."""
    return trials._between.bends(p, carried(trials, p)[1])


def carried(trials, p):
    """Errors and loads of one relief at all positions."""
    shared = trials._shared(trials._removed(p)[0])
    loads = np.moveaxis(shared.loads.reshape(*shared.loads.shape[:2], len(p), 1), 1, 2)
    return np.moveaxis(shared.transmission_error.reshape(-1, len(p), 1), 1, 0), loads


def reliefs(teeth, count):
    size = 1.0 if teeth == "pair" else 0.6
    ends = ((8e-6 * size, 40e-6 * size), (0.15, 0.6)) * 2
    return np.stack([np.random.default_rng(8 + k).uniform(*one, count) for k, one in enumerate(ends)], axis=1)


@pytest.mark.parametrize("power", [1.0, 2.0])
@pytest.mark.parametrize("teeth", ["pair", "high"])
def test_places_where_pairs_part_and_touch_move_as_their_derivatives_say(request, teeth, power):
    """By differences: places, and of starts of straight reliefs also how much the slope jumps there."""
    trials = Trials(even_bench(request.getfixturevalue(teeth), 60), np.array([0.6 * LOAD]), power, "effective_error")
    step, seen = 1e-4 * np.array([20e-6, 1.0, 20e-6, 1.0]), 0
    for here in reliefs(teeth, 5):
        every = here + np.concatenate([np.zeros((1, 4)), np.diag(step), -np.diag(step)])
        for kind, kinds in enumerate(zip(*(bent(trials, one[None]) for one in every), strict=True)):
            if len({str(one.where.tolist()) for one in kinds}) > 1 or not kinds[0].x.size:
                continue
            one, seen = kinds[0], seen + kinds[0].x.size
            moved = np.array([one.x for one in kinds])
            moved = (moved[1:5] - moved[5:]).T / (2.0 * step)
            scale = np.abs(one.moved * step).max() / step
            np.testing.assert_allclose(one.moved / scale, moved / scale, atol=3e-3)
            if kind == 1:
                grown = np.array([one.jump for one in kinds])
                grown = (grown[1:5] - grown[5:]).T / (2.0 * step)
                scale = np.abs(one.grown * step).max() / step
                np.testing.assert_allclose((one.grown / scale)[:, ::2], (grown / scale)[:, ::2], atol=3e-3)
                # It is in proportion to amount over length, the shares of the pairs as they are.
                np.testing.assert_allclose(one.grown[:, 1::2] * here[1::2], -one.grown[:, ::2] * here[::2], rtol=1e-9)
                np.testing.assert_allclose((one.grown[:, ::2] * here[::2]).sum(axis=1), one.jump, rtol=1e-9)
    assert seen > 6


@pytest.mark.parametrize("power", [1.0, 2.0])
@pytest.mark.parametrize("teeth", ["pair", "high"])
def test_peaks_and_troughs_between_positions_grow_as_their_derivatives_say(request, teeth, power):
    """As if they stayed: a peak that moves along a slope of nothing grows by what changes there."""
    trials = Trials(even_bench(request.getfixturevalue(teeth), 60), np.array([0.6 * LOAD]), power, "peak_to_peak")
    step, seen = 2e-5 * np.array([20e-6, 1.0, 20e-6, 1.0]), np.zeros(3, dtype=int)
    for here in reliefs(teeth, 6):
        every = here + np.concatenate([np.zeros((1, 4)), np.diag(step), -np.diag(step)])
        found = [trials._between.extremes(one[None], *carried(trials, one[None]))[:3] for one in every]
        for kind in range(3):
            kinds = [one[kind] for one in found]
            if len({str(one.where.tolist()) for one in kinds}) > 1 or not kinds[0].values.size:
                continue
            seen[kind] += kinds[0].values.size
            values = np.array([one.values for one in kinds])
            grown = (values[1:5] - values[5:]).T / (2.0 * step)
            scale = max((np.abs(kinds[0].slopes) * step).max(), 2e-11) / step
            np.testing.assert_allclose(kinds[0].slopes / scale, grown / scale, atol=5e-3)
    assert seen[0] > 2
    assert seen[1] + seen[2] > 2


@pytest.mark.parametrize("loads", [[LOAD], [0.5 * LOAD, LOAD]])
def test_quick_sharing_is_nearly_the_exact_one_and_counts_all_its_states(pair, loads):
    """Each set of neighbouring pairs bears by straight laws; the stiffest of those in reach is the one that bears."""
    loads = np.array(loads)
    grid = pair.grid(pair.pair.x_start + pair.pair.base_pitch * (np.arange(40) + 0.5) / 40)
    quick = quick_sharing(grid, loads)
    assert quick.size == 40 * loads.size
    least = np.full(quick.size, np.inf)
    for one in quick.sets:
        least[one.states] = np.minimum(least[one.states], one.base)
        np.testing.assert_allclose(one.weight.sum(axis=0), 1.0, rtol=1e-5)
    exact = np.stack([pair.solve(grid, [one]).transmission_error[:, 0] for one in loads], axis=1)
    np.testing.assert_allclose(least.reshape(40, -1), exact, rtol=2e-3)


def test_gears_are_alike_by_the_compliance_of_the_loaded_tooth_only():
    """What their neighbours feel may differ."""

    def like(driver, driven):
        sources = {"driver": SimpleNamespace(own=driver), "driven": SimpleNamespace(own=driven)}
        return _are_like(engaged(24, 24).pair, SimpleNamespace(source=sources.__getitem__))

    assert like(lambda i, r: 1.0 + r + i, lambda i, r: 1.0 + r - i)
    assert not like(lambda i, r: 1.0 + r + (i == 0), lambda i, r: 1.0 + r)


# ---- flanks ----------------------------------------------------------------------------------------------------------
def test_pressure_counts_on_the_smooth_flank_only_at_each_misalignment_and_load():
    smooth = np.array([[True, False], [True, True], [False, True]])
    pressure = np.arange(24.0).reshape(2, 3, 2, 2)
    found = Tried(tuple(SimpleNamespace(smooth=smooth, pressure=one) for one in pressure), None, None).pressure
    assert found.tolist() == [[10.0, 11.0], [22.0, 23.0]]
    rough = Tried((SimpleNamespace(smooth=smooth & [True, False], pressure=pressure[0]),), None, None).pressure
    assert rough.tolist() == [[4.0, 5.0]]


@pytest.mark.parametrize(
    ("ours", "theirs", "left", "fewer"),
    [
        ((9e-6, 0.0, 9e-6), (9e-6, 2e-6, 9e-6), 0.5, True),  # one more, below its tolerance
        ((9e-6, 0.0, 9e-6), (9e-6, 7e-6, 9e-6), 0.5, False),  # one more, above it
        ((9e-6, 0.0, 9e-6), (9e-6, 4.9e-6, 9e-6), 0.5, True),  # just below it
        ((9e-6, 0.0, 9e-6), (9e-6, 5e-6, 9e-6), 0.5, False),  # as large as it
        ((9e-6, 0.0, 9e-6), (9e-6, 5.2e-6, 9e-6), 0.5, False),
        ((9e-6, 0.0, 9e-6), (0.0, 2e-6, 9e-6), 0.5, False),  # another one
        ((9e-6, 0.0, 9e-6), (9e-6, 0.0, 9e-6), 0.5, False),  # the same ones
        ((9e-6, 0.0, 9e-6), (9e-6, 2e-6, 9e-6), 1.5, False),  # more is left than without
        ((9e-6, 0.0, 0.0), (9e-6, 2e-6, 7e-6), 0.5, False),  # two more, of which one is above
        ((0.0, 0.0, 0.0), (2e-6, 2e-6, 2e-6), 1.0, True),
    ],
)
def test_fewer_modifications_are_within_tolerance_where_all_that_they_lack_are(monkeypatch, ours, theirs, left, fewer):
    monkeypatch.setattr("fegear.design.flanks.designed_flanks._AMOUNTS", slice(0, 3))
    state, least = (
        SimpleNamespace(relief="r", amounts=np.array(one), over_peak_to_peak=np.array([0.3, value]))
        for one, value in ((ours, left), (theirs, 0.2))
    )
    design = SimpleNamespace(
        task=SimpleNamespace(tolerance=SimpleNamespace(amounts=np.full(9, 5e-6))), least=least,
        unrelieved=SimpleNamespace(over_peak_to_peak=np.array([1.0, 1.0])),
    )  # fmt: skip
    assert FlankDesign.within_tolerance(design, state) is fewer
    for without in (None, state):
        other = SimpleNamespace(**vars(design) | {"least": SimpleNamespace(**vars(least) | {"relief": None})})
        if without is not None:
            other = SimpleNamespace(**vars(design) | {"task": SimpleNamespace(tolerance=None)})
        assert FlankDesign.within_tolerance(other, state) is False


# ---- gears -----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("z", "module"), [(12, 0.5e-3), (31, 3e-3), (80, 20e-3)])
def test_a_usual_ball_is_the_next_preferred_number(z, module):
    gear = Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25), 0.3 if z < 20 else 0.0), module, 0.1 * z * module, 0.02)
    touches, usual = touching_ball(gear) * 1e3, usual_ball(gear) * 1e3
    decade = 10.0 ** math.floor(math.log10(usual) + 1e-12)
    assert min(abs(usual / decade - one) for one in _R40) < 1e-9
    steps = sorted(one * 10.0**k for one in _R40 for k in range(-3, 4))
    assert usual == pytest.approx(min(one for one in steps if one >= touches * (1.0 - 1e-9)))


def test_a_relief_is_long_enough_by_its_share_of_the_active_profile():
    low, high = 0.4, 0.6
    for share, fits in ((1.05, True), (0.95, False)):
        relief = EndRelief(9e-6, high - share * 2e-3 * (high - low), high)
        if fits:
            refuse_relief_elsewhere(relief, low, high)
        else:
            with pytest.raises(InputError, match="of the active profile long") as refused:
                refuse_relief_elsewhere(relief, low, high)
            assert refused.value.rule.startswith("is 0.0019 of")
    # A start or an end may lie as far outside as the profile is long.
    for off, fits in ((0.99, True), (1.01, False)):
        for relief in (EndRelief(9e-6, low - off * 0.2, high), EndRelief(9e-6, low, high + off * 0.2)):
            if fits:
                refuse_relief_elsewhere(relief, low, high)
            else:
                with pytest.raises(InputError, match="outside the active profile"):
                    refuse_relief_elsewhere(relief, low, high)
    inside = replace(EndRelief(9e-6, 0.5, high), amount=0.0)
    refuse_relief_elsewhere(inside, low, high)


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_extremes_are_those_of_many_more_positions(pair, power):
    """What tip reliefs leave from peak to peak by 40 positions and what lies between, beside 6000 of them."""
    loads = np.array([0.6 * LOAD])
    trials = Trials(even_bench(pair, 40), loads, power, "peak_to_peak")
    rng = np.random.default_rng(5)
    p = np.stack([rng.uniform(*ends, 6) for ends in ((8e-6, 40e-6), (0.15, 0.6)) * 2], axis=1)
    tried = trials.exact(p)
    found = trials.left(tried.seen, tried.low)
    of, gears = pair.pair, (pair.pair.driver, pair.pair.driven)
    even = of.x_start + of.base_pitch * (np.arange(6000) + 0.5) / 6000
    grid = pair.grid(np.union1d(even, trials.bench.points.x))  # with both sides of every change of pairs
    for one, left in zip(p, found, strict=True):
        reliefs = [
            relief_over_path(gear, of.path_length, *one[2 * g : 2 * g + 2], power) for g, gear in enumerate(gears)
        ]
        ground = replace(pair, driver_relief=reliefs[0], driven_relief=reliefs[1])
        error = ground.solve(grid, loads).transmission_error[:, 0]
        assert 1.0 - 5e-4 < np.ptp(error) / left < 1.0 + 1e-5


@pytest.mark.parametrize("loads", [1, 2])
def test_along_rounded_steps_what_harmonics_leave_curves_by_one(loads):
    """At the load that leaves most; the curvature by second differences of the metric itself."""
    rng, harmonics = np.random.default_rng(3), 5
    curved = [
        ground._Curved(
            (1.0 + 0.3 * k) * rng.normal(size=10), rng.normal(size=(10, 4)),
            rng.normal(size=10)[:, None, None] * np.array([[3, 1, 0, 1], [1, 2, 1, 0], [0, 1, -1, 1], [1, 0, 1, 4.0]]),
        )
        for k in range(loads)
    ]  # fmt: skip
    problem = ground._Problem(tuple(curved), tuple(curved), harmonics)
    most = max(curved, key=lambda one: ground._effective(one.value, harmonics)[0])

    def left(d):
        parts = most.at(d)
        each = np.hypot(parts[:harmonics], parts[harmonics:])
        return float(each[0] + np.sqrt((each**2).sum()))

    step, eye = 1e-4, 1e-4 * np.eye(4)
    bent = np.array([
        [left(a + b) - left(a - b) - left(b - a) + left(-a - b) for b in eye] for a in eye
    ]) / (4.0 * step**2)  # fmt: skip
    ways = problem.rounded()
    round_ = ways.T @ bent @ ways
    np.testing.assert_allclose(np.abs(round_), np.eye(4), atol=2e-4)
    straight = ground._Problem(tuple(curved), tuple(curved), 0)
    np.testing.assert_array_equal(straight.rounded(), np.eye(4))
