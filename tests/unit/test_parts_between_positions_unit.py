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
from fegear.design.flanks.flank_design import FlankDesign
from fegear.design.flanks.trials import Tried
from fegear.design.quick_sharing import quick_sharing
from fegear.design.tip_relief.grindable import relief_over_path
from fegear.design.tip_relief.search import _are_like, _even
from fegear.design.tip_relief.trials import Trials
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.over_balls import _R40, touching_ball, usual_ball
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import refuse_relief_elsewhere
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief

LOAD = 9000.0


def engaged(z1=24, z2=36):
    rack = BasicRack(1.0, 1.25, 0.2)
    gears = [Gear(Tooth(z, rack), 3e-3, 0.1 * z * 3e-3, 0.03) for z in (z1, z2)]
    sources = [closed_form_compliance(gear, "cornell") for gear in gears]
    return Engagement(PairCompliance(GearPair(*gears), *sources, hertz="linear", nominal_load=LOAD))


@pytest.fixture(scope="module")
def pair():
    return engaged()


def bent(trials, p):
    """Where the error of one relief bends."""
    shared = trials._shared(trials._removed(p)[0]).loads
    loads = np.moveaxis(shared.reshape(*shared.shape[:2], len(p), 1), 1, 2)
    return trials._between.bends(p, loads)


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_places_where_pairs_part_and_touch_move_as_their_derivatives_say(pair, power):
    """By differences: places, and of starts of straight reliefs also how much the slope jumps there."""
    trials = Trials(_even(pair, 60), np.array([0.6 * LOAD]), power, "effective_error")
    here, step = np.array([18e-6, 0.33, 25e-6, 0.41]), 1e-4 * np.array([20e-6, 1.0, 20e-6, 1.0])
    found = bent(trials, here[None])
    assert len(found) == (2 if power == 1.0 else 1)
    assert found[0].x.size >= 2
    for k in range(4):
        ends = [bent(trials, (here + sign * step * np.eye(4)[k])[None]) for sign in (1.0, -1.0)]
        for kind, (one, up, down) in enumerate(zip(found, *ends, strict=True)):
            assert up.where.tolist() == down.where.tolist() == one.where.tolist()
            moved = (up.x - down.x) / (2.0 * step[k])
            scale = np.abs(one.moved * step).max() / step[k]
            np.testing.assert_allclose(one.moved[:, k], moved, atol=2e-3 * scale)
            if kind == 1:
                grown = (up.jump - down.jump) / (2.0 * step[k])
                np.testing.assert_allclose(one.grown[:, k], grown, atol=0.1 * np.abs(one.grown * step).max() / step[k])


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
        ((9e-6, 0.0, 9e-6), (0.0, 2e-6, 9e-6), 0.5, False),  # another one
        ((9e-6, 0.0, 9e-6), (9e-6, 0.0, 9e-6), 0.5, False),  # the same ones
        ((9e-6, 0.0, 9e-6), (9e-6, 2e-6, 9e-6), 1.5, False),  # more is left than without
        ((9e-6, 0.0, 0.0), (9e-6, 2e-6, 7e-6), 0.5, False),  # two more, of which one is above
        ((0.0, 0.0, 0.0), (2e-6, 2e-6, 2e-6), 1.0, True),
    ],
)
def test_fewer_modifications_are_within_tolerance_where_all_that_they_lack_are(monkeypatch, ours, theirs, left, fewer):
    monkeypatch.setattr("fegear.design.flanks.flank_design._AMOUNTS", slice(0, 3))
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
    trials = Trials(_even(pair, 40), loads, power, "peak_to_peak")
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
