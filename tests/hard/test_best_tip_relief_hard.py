"""Tip reliefs that leave the least: no brute force finds less, and what is stated is what they leave.

The reference shares the load by itself: pairs with straight laws and without coupling approach by the least
(W + sum m_j / c_j) / sum 1 / c_j over all sets of pairs. It tries a grid of amounts and lengths, then descends from the
best of it with scipy's simplex search.
"""

from dataclasses import replace
from itertools import chain, combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import differential_evolution, minimize

from fegear.atlas.shipped import shipped_atlas
from fegear.base.errors import InputError
from fegear.contact.fourier import effective_error
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import contact_changes, transmission_error
from fegear.design.relief_bench import bench
from fegear.design.tip_relief.grindable import grindable, optimise_tip_relief, relief_over_path
from fegear.design.tip_relief.relief_scan import even_bench
from fegear.design.tip_relief.trials import Trials
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import deepest_relief
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import roll_of_radius


def engaged(z1, z2, module=3e-3, addendum=1.0, shift=0.0, hertz="linear", line_load=3e5):
    rack = BasicRack(addendum, addendum + 0.25, 0.2)
    teeth = Tooth(z1, rack, profile_shift=shift), Tooth(z2, rack, profile_shift=-shift)
    gears = [Gear(tooth, module, 0.1 * tooth.teeth * module, 10 * module) for tooth in teeth]
    sources = [closed_form_compliance(g, "cornell") for g in gears]
    load = line_load * 10 * module
    return Engagement(PairCompliance(GearPair(*gears), *sources, hertz=hertz, nominal_load=load)), load


class Reference:
    """Own load sharing on even roll positions and at both sides of every change of pairs."""

    def __init__(self, engagement, load, positions=160):
        pair, c = engagement.pair, engagement.compliance
        pitch = pair.base_pitch
        x = pair.x_start + pitch * (np.arange(positions) + 0.5) / positions
        ends = pair.x_start + np.mod(pair.path_length, pitch) + 1e-9 * pitch * np.array([-1.0, 1.0])
        x = np.sort(np.concatenate([x, ends, [pair.x_start + 1e-9 * pitch, pair.x_start + (1 - 1e-9) * pitch]]))
        self.engagement, self.pair, self.load, self.x = engagement, pair, load, x
        self.at = x + np.arange(int(np.ceil(pair.contact_ratio)))[:, None] * pitch
        self.there = self.at <= pair.x_end
        inside = np.minimum(self.at, pair.x_end)
        own = 0.0
        rho = [pair.flank_curvature_radius(inside, m) for m in ("driver", "driven")]
        b = c.half_width(np.asarray(load), rho[0] * rho[1] / (rho[0] + rho[1]))
        for m in ("driver", "driven"):
            source, r = c.source(m), pair.radius(inside, m)
            own = own + source.own(0, r)
            if c.hertz == "none":  # as wide as under 100 N/mm
                own = own + source.power * 1e5**-0.1
            else:
                own = own + source.log_slope * np.log(source.reference_half_width(r) / b)
                own = own + source.power * (load / c.face_width) ** -0.1
        self.stiffness = np.where(self.there, c.face_width / own, 0.0)
        count = range(self.at.shape[0])
        self.sets = list(chain.from_iterable(combinations(count, k + 1) for k in count))

    def approach(self, m):
        """Of removals, shape (..., n, P)."""
        least = np.full((*m.shape[:-2], self.x.size), np.inf)
        for chosen in self.sets:
            k = self.stiffness[list(chosen)]
            ok = (k > 0.0).all(axis=0)
            zeta = (self.load + (k * m[..., list(chosen), :]).sum(axis=-2))[..., ok] / k.sum(axis=0)[ok]
            least[..., ok] = np.minimum(least[..., ok], zeta)
        return least

    def removal(self, p, power):
        """Of (amount, length over the path) of the driver and of the driven gear, shape (..., n, P)."""
        p = np.asarray(p)[..., None, None]
        path = self.pair.path_length
        driver = np.maximum(1.0 - (self.pair.x_end - self.at) / (path * p[..., 1, :, :]), 0.0) ** power
        driven = np.maximum(1.0 - (self.at - self.pair.x_start) / (path * p[..., 3, :, :]), 0.0) ** power
        return p[..., 0, :, :] * driver + p[..., 2, :, :] * driven

    def left(self, p, power, metric):
        te = self.approach(self.removal(p, power))
        if metric == "peak_to_peak":
            return np.ptp(te, axis=-1)
        pitch = self.pair.base_pitch
        weights = 0.5 * (np.roll(self.x, -1) - np.roll(self.x, 1))
        weights[[0, -1]] += 0.5 * pitch
        kernel = np.exp(-2j * np.pi * np.multiply.outer(self.x, np.arange(1, 13)) / pitch) * weights[:, None] / pitch
        a = 2.0 * np.abs(te @ kernel)
        return a[..., 0] + np.sqrt((a**2).sum(axis=-1))

    def brute_force(self, power, metric, side=12, descents=6):
        """What the best of a grid, and of descents from the best of it, leave.

        Judged at many more roll positions: the largest and smallest values sit on kinks between those of the search.
        """
        scale = self.approach(self.removal([0.0, 0.5, 0.0, 0.5], power)).mean()
        amounts, lengths = scale * np.linspace(0.0, 3.5, side), np.linspace(0.06, 1.0, side)
        one = np.stack(np.meshgrid(amounts, lengths, indexing="ij"), axis=-1).reshape(-1, 2)
        values = []
        for first in one:
            p = np.concatenate([np.broadcast_to(first, one.shape), one], axis=1)
            values.append(self.left(p, power, metric))
        values = np.array(values)
        order = np.argsort(values.ravel())
        unit = np.array([scale, 1.0, scale, 1.0])
        best, used, candidates = values.min(), [], []
        for i in order:
            p = np.concatenate([one[i // one.shape[0]], one[i % one.shape[0]]]) / unit
            if any(np.abs(p - q).max() < 0.2 for q in used):
                continue
            used.append(p)
            bounds = [(0.0, 6.0), (0.02, 1.0)] * 2
            found = minimize(
                lambda q: self.left(q * unit, power, metric), p, method="Nelder-Mead", bounds=bounds,
                options={"maxiter": 300, "xatol": 1e-4, "fatol": 1e-4 * best},
            )  # fmt: skip
            candidates.append(found.x * unit)
            best = min(best, found.fun)
            if len(used) == descents:
                break
        dense = Reference(self.engagement, self.load, 1500)
        return min(float(dense.left(p, power, metric)) for p in candidates)


def numbers(found, pair):
    both = (found.driver, pair.driver), (found.driven, pair.driven)
    return [n for r, g in both for n in (r.amount, (r.end - r.start) * g.base_radius / pair.path_length)]


@pytest.mark.dear
@pytest.mark.parametrize(
    ("z1", "z2", "addendum", "shift", "shape", "metric"),
    [
        (17, 60, 1.0, 0.3, "linear", "effective_error"), (50, 50, 1.3, 0.0, "parabolic", "peak_to_peak"),
        pytest.param(17, 60, 1.0, 0.3, "linear", "peak_to_peak", marks=pytest.mark.long),
        pytest.param(50, 50, 1.3, 0.0, "parabolic", "effective_error", marks=pytest.mark.long),
        pytest.param(28, 28, 1.0, 0.0, "parabolic", "peak_to_peak", marks=pytest.mark.long),
        pytest.param(28, 28, 1.0, 0.0, "parabolic", "effective_error", marks=pytest.mark.long),
    ],
)  # fmt: skip
def test_no_brute_force_finds_less(z1, z2, addendum, shift, shape, metric):
    """One start left 1.64 um of a pair where 1.05 is possible."""
    e, load = engaged(z1, z2, addendum=addendum, shift=shift)
    power = 1.0 if shape == "linear" else 2.0
    reference = Reference(e, load)
    found = grindable(e, load, shape, metric)
    assert found.least < 1.02 * reference.brute_force(power, metric)
    # Of all that leave up to 1 % more the one with the least removal is taken.
    assert found.objective == pytest.approx(1.01 * found.least, rel=0.005)
    stated = Reference(e, load, 1500).left(numbers(found, e.pair), power, metric)
    assert stated == pytest.approx(found.objective, rel=0.01)
    assert found.candidates > 10_000
    # Two independent searches came to the same, or it is said how far they are apart: one may miss the deepest valley.
    assert 0.0 < found.objective_error <= found.least_error
    # What the search costs, by its count of exact load sharings: a tenth of a millisecond each where many go together.
    assert found.evaluations < 2500  # 16 ends of bands among them
    assert found.objective <= 1.0001 * found.before[0]


def left_at(e, load, relief):
    """Peak to peak at 192 even roll positions, both sides of all kinks, and close by these."""
    pair = e.pair
    solved = transmission_error(relief.applied(e), load, 12)
    even = pair.x_start + pair.base_pitch * (np.arange(192) + 0.5) / 192
    kinks = np.array([*relief.applied(e).breaks, *contact_changes(relief.applied(e), load)])
    x = e.meshing.reduced(np.concatenate([even, kinks, kinks - 1e-9 * pair.base_pitch, kinks + 1e-9 * pair.base_pitch]))
    values = relief.applied(e).solve(relief.applied(e).grid(x), [load]).transmission_error[:, 0]
    return max(np.ptp(values), solved.peak_to_peak)


@pytest.mark.dear
@pytest.mark.parametrize("shape", ["linear", pytest.param("parabolic", marks=pytest.mark.long)])
def test_a_relief_on_finite_elements_leaves_what_the_search_says(shape):
    """A pair that parted just before a straight relief's start left .748 um where the search saw .664."""
    teeth = Tooth(23, BasicRack(), profile_shift=0.3), Tooth(57, BasicRack(), profile_shift=-0.1)
    gears = [Gear(t, 3e-3, bore, 10e-3) for t, bore in zip(teeth, (15e-3, 40e-3), strict=True)]
    settings = MeshSettings().scaled(1.6)
    sources = [finite_element_compliance(solve_gear(g, settings, reach=2, estimate_error=False)) for g in gears]
    e = Engagement(PairCompliance(GearPair(*gears), *sources), corner_contact=True)
    load = 90.0 / gears[0].base_radius
    found = grindable(e, load, shape)
    assert left_at(e, load, found) == pytest.approx(1.01 * found.least, rel=1e-3)
    assert found.objective == pytest.approx(1.01 * found.least, rel=1e-3)
    assert found.peak_to_peak[0] < {"linear": 0.665e-6, "parabolic": 0.87e-6}[shape]


@pytest.mark.parametrize("hertz", ["linear", "load-dependent"])
@pytest.mark.parametrize("power", [1.0, 2.0])
@pytest.mark.parametrize(("teeth", "addendum"), [((24, 36), 1.0), ((50, 50), 1.3), ((52, 86), 0.8)])
def test_extremes_between_positions_are_those_of_a_dense_curve(teeth, addendum, power, hertz):
    """At 56 positions; lines continued to where they meet were off by up to 3e-3 of the mean error."""
    e, load = engaged(*teeth, addendum=addendum, hertz=hertz)
    trials = Trials(even_bench(e, 56), np.array([load]), power, "peak_to_peak")
    scale = trials.mean()
    rng = np.random.default_rng(5)
    p = rng.uniform([0.1 * scale, 0.05, 0.1 * scale, 0.05], [1.5 * scale, 0.8, 1.5 * scale, 0.8], (10, 4))
    tried = trials.exact(p)
    dense = Trials(even_bench(e, 6000), np.array([load]), power, "peak_to_peak")
    # Values at the positions alone.
    truth = [np.ptp(dense._shared(dense._removed(one[None])[0]).transmission_error) for one in p]
    more = (trials.left(tried.seen, tried.low) - truth) / scale
    assert more.min() > -2e-6
    assert more.max() < 2e-4  # a kink halfway between two of them


@pytest.mark.dear
def test_the_two_gears_of_a_like_pair_may_change_places():
    e, load = engaged(28, 28)
    one = grindable(e, load, "parabolic")
    c = e.compliance
    mirrored = PairCompliance(e.pair.reversed(), c.driven, c.driver, hertz="linear", nominal_load=load)
    other = grindable(Engagement(mirrored), load, "parabolic")
    assert one.least == pytest.approx(other.least, rel=1e-6)
    assert one.driver.amount + one.driven.amount == pytest.approx(other.driver.amount + other.driven.amount, rel=1e-3)


@pytest.mark.dear
def test_the_driver_of_a_like_pair_takes_the_deeper_relief_and_both_have_one_band():
    """Under noise of 1e-12 reliefs of like gears changed places, and each gear had a band of its own."""
    e, load = engaged(28, 28, hertz="load-dependent")
    for one in (load, load * (1.0 + 1e-12)):
        found = grindable(e, one)
        assert found.driver.amount >= found.driven.amount
        for mine, other in zip(found.driver_band, found.driven_band, strict=True):
            assert (mine.amount, mine.start) == (other.amount, other.start)
        assert found.driven_band[0].amount <= found.driven.amount
        assert found.driver.amount <= found.driver_band[1].amount
        assert (found.error > 0.0).all()
        assert (found.band_error > 0.0).all()


@pytest.mark.dear
@pytest.mark.parametrize(
    ("teeth", "options", "shape"),
    [
        ((17, 60), {"shift": 0.3}, "linear"),
        pytest.param((17, 60), {"shift": 0.3}, "parabolic", marks=pytest.mark.long),
        pytest.param((24, 36), {"hertz": "load-dependent"}, "linear", marks=pytest.mark.long),
        pytest.param((50, 50), {"addendum": 1.3}, "parabolic", marks=pytest.mark.long),
    ],
)  # fmt: skip
def test_ends_of_bands_are_where_they_are_whatever_the_last_digits(teeth, options, shape):
    """Under 1e-12 of every input they moved by up to a third, a thousand times their error."""
    bands, errors = [], []
    for k in range(3):
        rng = np.random.default_rng(k)
        off = 1.0 + (1e-12 * rng.uniform(-1.0, 1.0, 4) if k else np.zeros(4))
        e, load = engaged(*teeth, **{"addendum": 1.0, **options, "module": 3e-3 * off[0], "line_load": 3e5 * off[1]})
        found = grindable(e, load, shape)
        bands.append([[v for r in ends for v in (r.amount, r.start)]
                      for ends in zip(found.driver_band, found.driven_band, strict=True)])  # fmt: skip
        errors.append(found.band_error)
        assert found.driver_band[0].amount < found.driver_band[1].amount
    assert (np.ptp(bands, axis=0) <= 0.5 * np.min(errors, axis=0)).all()


def scaled(e, load, by):
    """The same pair, all lengths scaled: loads and amounts go with the lengths, where a face width does."""
    gears = [
        Gear(g.tooth, g.module * by, g.bore_radius * by, g.face_width * by) for g in (e.pair.driver, e.pair.driven)
    ]
    sources = [closed_form_compliance(g, "cornell") for g in gears]
    pair = PairCompliance(GearPair(*gears), *sources, hertz=e.compliance.hertz, nominal_load=load * by**2)
    return Engagement(pair), load * by**2


PAIRS = [
    pytest.param((17, 60), {"shift": 0.3}, "linear", 3, marks=pytest.mark.long),
    # Descents that end early miss the deepest valley under one load and find it under the next.
    ((44, 61), {"shift": 0.246, "hertz": "load-dependent"}, "linear", 2),
    pytest.param((17, 60), {"shift": 0.3}, "linear", 8, marks=pytest.mark.long),
    pytest.param((28, 28), {"hertz": "load-dependent"}, "linear", 8, marks=pytest.mark.long),
    pytest.param((44, 61), {"shift": 0.246, "hertz": "load-dependent"}, "linear", 8, marks=pytest.mark.long),
    pytest.param((39, 95), {"addendum": 0.8, "hertz": "load-dependent"}, "parabolic", 8, marks=pytest.mark.long),
    pytest.param((50, 50), {"addendum": 1.3}, "parabolic", 8, marks=pytest.mark.long),
    pytest.param((52, 50), {"addendum": 1.3, "shift": 0.1}, "linear", 8, marks=pytest.mark.long),
    # Different by 1e-3 to 9e-3 where extremes were continued from neighbouring positions.
    pytest.param((24, 36), {"hertz": "load-dependent"}, "linear", 8, marks=pytest.mark.long),
    pytest.param((31, 90), {}, "linear", 8, marks=pytest.mark.long),
    pytest.param((44, 45), {"hertz": "load-dependent"}, "linear", 8, marks=pytest.mark.long),
]


def unchanged(teeth, options, shape, loads, metric, close):
    """Whether the last digits of loads, and the unit of length, leave amounts, lengths and the least as they are."""
    e, load = engaged(*teeth, **options)
    found = grindable(e, load, shape, metric)
    first = np.array(numbers(found, e.pair))
    for k in range(1, loads):
        other = grindable(e, load * (1.0 + k * 1e-10), shape, metric)
        np.testing.assert_allclose(numbers(other, e.pair), first, rtol=1e-6)
        assert other.least == pytest.approx(found.least, rel=close)
    large, its_load = scaled(e, load, 2.7)
    other = grindable(large, its_load, shape, metric)
    np.testing.assert_allclose(numbers(other, large.pair), first * [2.7, 1.0, 2.7, 1.0], rtol=1e-6)
    assert other.objective == pytest.approx(2.7 * found.objective, rel=1e-6)


@pytest.mark.dear
@pytest.mark.parametrize(("teeth", "options", "shape", "loads"), PAIRS)
def test_the_last_digits_of_the_load_and_the_unit_of_length_change_nothing(teeth, options, shape, loads):
    """Loads 1e-10 apart left .895 to .920 um of a pair, with 26.7 to 61.1 um on the driver."""
    unchanged(teeth, options, shape, loads, "peak_to_peak", 1e-8)


@pytest.mark.dear
@pytest.mark.parametrize(
    ("teeth", "options", "shape", "loads"),
    [
        ((50, 50), {"addendum": 1.3}, "parabolic", 2),
        *(pytest.param(*getattr(p, "values", p), marks=pytest.mark.long) for p in PAIRS),
    ],
)
def test_the_last_digits_change_nothing_of_the_least_effective_error(teeth, options, shape, loads):
    """Amounts moved by up to 1.6e-2, the least by 3e-5: quadrature made an edge wherever a kink passed a point."""
    unchanged(teeth, options, shape, min(loads, 4), "effective_error", 1e-8)


@pytest.mark.parametrize(
    ("teeth", "options", "power"),
    [
        ((17, 60), {"shift": 0.3}, 1.0), ((50, 50), {"addendum": 1.3}, 1.0),
        ((50, 50), {"addendum": 1.3}, 2.0), ((24, 36), {"hertz": "load-dependent"}, 1.0),
    ],
)  # fmt: skip
def test_harmonics_across_kinks_are_those_with_a_break_at_every_kink(teeth, options, power):
    """Quadrature that did not know of kinks was up to 9e-4 of the effective error off, and 2e-5 as a median."""
    e, load = engaged(*teeth, **options)
    few, many = (Trials(bench(e, 12, waves), np.array([load]), power, "effective_error") for waves in (12, 48))
    scale = few.mean()
    rng = np.random.default_rng(5)
    p = rng.uniform([0.1 * scale, 0.05] * 2, [1.5 * scale, 0.8] * 2, (12, 4))
    truth, gears = [], (e.pair.driver, e.pair.driven)
    for one in p:
        tips = [relief_over_path(g, e.pair.path_length, *one[2 * i : 2 * i + 2], power) for i, g in enumerate(gears)]
        solved = transmission_error(replace(e, driver_relief=tips[0], driven_relief=tips[1]), load, 12)
        truth.append(float(effective_error(solved.series)))
    of_few, of_many = (np.abs(t.left(t.exact(p).seen) / truth - 1.0) for t in (few, many))
    bare = np.abs(few.left(few.seen(np.moveaxis(few._shared(few._removed(p)[0]).transmission_error, 1, 0)[..., None]))
                  / truth - 1.0)  # fmt: skip
    assert of_few.max() < {1.0: 1e-5, 2.0: 5e-5}[power]  # a parabolic start bends without a corner: next order
    assert np.median(of_few) < 3e-7
    assert np.median(of_few) < np.median(bare) / (100.0 if power == 1.0 else 1.0)
    # Four times the points: third order, where it was second.
    assert np.median(of_many) < np.median(of_few) / 16.0
    # Derivatives are those of the values.
    h = 1e-7 * np.array([scale, 1.0, scale, 1.0])
    for one in p[:4]:
        tried = few.exact(one + np.concatenate([np.diag(h), -np.diag(h), np.zeros((1, 4))]))
        slope = (tried.seen[:4, 0] - tried.seen[4:8, 0]) / (2.0 * h[:, None])
        off = np.abs(slope - tried.slope[8, :, 0]).max(axis=1) / np.abs(slope).max(axis=1)
        assert off.max() < 2e-3


def test_the_band_holds_what_is_equally_good():
    """Ends of the band are reliefs that leave no more than 1 % above the least; the one taken removes the least."""
    e, load = engaged(52, 50, addendum=1.3, shift=0.1)
    found = grindable(e, load)
    bands = found.driver_band, found.driven_band
    for relief, (first, last) in zip((found.driver, found.driven), bands, strict=True):
        assert first.amount <= relief.amount <= last.amount
        assert last.start <= relief.start <= first.start
    # Reliefs a third deeper and longer leave the same on this pair: one number would hide that.
    assert found.driver_band[1].amount > 1.3 * found.driver.amount
    assert found.driver.amount < 1.01 * found.driver_band[0].amount


def drawn(seed):
    """A random pair under a load, a shape, and its search."""
    rng = np.random.default_rng(seed)
    addendum, hertz = float(rng.choice([0.8, 1.0, 1.3])), str(rng.choice(["linear", "none"]))
    z1, z2 = int(rng.integers(12, 61)), int(rng.integers(17, 101))
    addendum = addendum if z1 >= 18 else 0.8  # longer teeth would be pointed
    shift = max(rng.uniform(0.0, 0.4), (18 - z1) / 18 * addendum)
    e, load = engaged(z1, z2, addendum=addendum, shift=shift, hertz=hertz, line_load=10 ** rng.uniform(4.5, 6.0))
    power = float(rng.choice([1.0, 2.0]))
    return e, load, power, grindable(e, load, "linear" if power == 1.0 else "parabolic")


def evolved(e, load, power, positions, seed, aim, popsize=15):
    """Least of an aim, of numbers in their units and what they leave, by differential evolution: numbers, and unit."""
    reference = Reference(e, load, positions)
    scale = reference.approach(reference.removal([0.0, 0.5, 0.0, 0.5], power)).mean()
    tooth = [float(deepest_relief(g, roll_of_radius(g, g.involute_tip_radius))) for g in (e.pair.driver, e.pair.driven)]
    bounds = [b for t in tooth for b in ((0.0, min(6.0 * scale, t) / scale), (0.02, 1.0))]
    unit = np.array([scale, 1.0, scale, 1.0])
    best = differential_evolution(
        lambda p: aim(p, reference.left(p.T * unit, power, "peak_to_peak")), bounds, popsize=popsize, maxiter=250,
        seed=seed, tol=1e-6, vectorized=True, updating="deferred", polish=False,
    )  # fmt: skip
    return best.x, unit


@pytest.mark.long
@pytest.mark.parametrize("seed", range(30))
def test_no_differential_evolution_finds_less_on_random_pairs(seed):
    """It found 1.88389 for 1.9341 um and .269379 for .27935 um."""
    e, load, power, found = drawn(seed)
    x, unit = evolved(e, load, power, 120, seed, lambda _, left: left)
    assert found.least < Reference(e, load, 1500).left(x * unit, power, "peak_to_peak") / 0.99


@pytest.mark.long
@pytest.mark.parametrize("seed", range(30))
def test_no_differential_evolution_finds_less_removal_among_the_equally_good(seed):
    e, load, power, found = drawn(seed)
    # Half of the hundredth is left to what 240 positions do not see.
    fined = 1.005 * found.least
    x, unit = evolved(
        e, load, power, 240, seed, lambda p, left: p[0] + p[2] + 100.0 * np.maximum(left / fined - 1.0, 0.0), 25
    )
    if Reference(e, load, 1500).left(x * unit, power, "peak_to_peak") < 1.01 * found.least:
        assert found.driver.amount + found.driven.amount < 1.002 * (x[0] + x[2]) * unit[0]


@pytest.mark.dear
def test_the_least_removal_is_found_in_a_valley_that_is_not_the_deepest():
    """72.5 um were removed of a pair where 60.8 leave as little, in a valley whose ground is .6 % higher."""
    teeth = Tooth(18, BasicRack(), profile_shift=0.22941994), Tooth(40, BasicRack(), profile_shift=-0.22941994)
    gears = [Gear(t, 3e-3, 12e-3, 30e-3) for t in teeth]
    sources = [closed_form_compliance(g, "weber-banaschek") for g in gears]
    load = 11396.11
    e = Engagement(PairCompliance(GearPair(*gears), *sources, hertz="none", nominal_load=load))
    found = grindable(e, load, "parabolic")
    assert found.objective == pytest.approx(1.01 * found.least, rel=1e-3)
    assert found.driver.amount + found.driven.amount < 61e-6


@pytest.mark.dear
def test_reliefs_for_several_loads_are_at_least_as_good_as_those_for_one():
    e, load = engaged(24, 36, hertz="load-dependent")
    loads = [0.5 * load, load]
    found = optimise_tip_relief(e, loads, "linear", "effective_error")
    for one in loads:
        alone = optimise_tip_relief(e, [one], "linear", "effective_error")
        assert alone.objective <= 1.02 * found.effective_error[loads.index(one)]
    assert (found.effective_error < found.before).all()


def test_without_a_load_nothing_is_searched():
    e, _ = engaged(20, 30)
    for loads in ([], [0.0], [float("nan")]):
        with pytest.raises(InputError, match=r"design\.loads"):
            optimise_tip_relief(e, loads)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(
    z1=st.integers(12, 60), z2=st.integers(17, 100), shift=st.floats(0.0, 0.4),
    addendum=st.sampled_from([0.8, 1.0, 1.3]), line_load=st.floats(1e4, 1e6),
    shape=st.sampled_from(["linear", "parabolic"]),
    metric=st.sampled_from(["peak_to_peak", "effective_error"]),
)  # fmt: skip
def test_no_brute_force_finds_less_on_random_pairs(z1, z2, shift, addendum, line_load, shape, metric):
    e, load = engaged(z1, z2, addendum=addendum, shift=max(shift, (18 - z1) / 18 * addendum), line_load=line_load)
    power = 1.0 if shape == "linear" else 2.0
    found = grindable(e, load, shape, metric)
    least = Reference(e, load).brute_force(power, metric)
    assert found.least < 1.05 * least + 1e-3 * found.before[0]


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_extremes_between_positions_count_tip_corners_that_bear(power):
    """Shallow reliefs under a heavy load: corners outside of the path carry; left out they cost up to 9e-3."""
    teeth = [Tooth(z, BasicRack(1.0, 1.25, 0.38)) for z in (24, 36)]
    gears = [Gear(tooth, 3e-3, 0.5 * tooth.root_radius * 3e-3, 30e-3) for tooth in teeth]
    sources = [shipped_atlas("A").compliance(one) for one in gears]
    pair = PairCompliance(GearPair(*gears), *sources, hertz="load-dependent", nominal_load=3e4)
    e, loads = Engagement(pair, corner_contact=True), np.array([3e4])
    trials, dense = (Trials(even_bench(e, count), loads, power, "peak_to_peak") for count in (56, 3000))
    scale = trials.mean()
    p = np.random.default_rng(5).uniform([0.0, 0.05, 0.0, 0.05], [scale, 0.8, scale, 0.8], (10, 4))
    tried = trials.exact(p)
    truth = [np.ptp(dense._shared(dense._removed(one[None])[0]).transmission_error) for one in p]
    more = (trials.left(tried.seen, tried.low) - truth) / scale
    assert np.abs(more).max() < 2e-4
