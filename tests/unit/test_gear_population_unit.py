"""A population of gears fills its box evenly, and the range in which a formula is near is found on half of it."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.compared.formula_reach import NEAR, reach, sentence
from fegear.contact.compared.population import LOADS, drawn_gears, share_error, unevenness
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.results.gear.root_stress_spread import WORDS, bounds_in_words, spread
from fegear.results.gear.root_stress_study import StudyRows

BASE = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 1e-3, 6e-3)
BOX = {"teeth": (20.0, 100.0), "profile_shift": (-0.2, 0.5), "rack_tip_radius": (0.1, 0.35)}


def numbers(population):
    return np.array(
        [(d.gear.teeth, d.gear.tooth.profile_shift, d.gear.tooth.rack.tip_radius) for d in population.gears]
    )


def test_a_population_fills_its_box_evenly():
    found = drawn_gears(BASE, BOX, 256, 3)
    assert len(found.gears) == 256
    assert found.tried == 256  # every draw of this box gives a tooth
    z, x, rho = numbers(found).T
    drawn = np.stack([x, rho], axis=1)
    assert unevenness(drawn, np.array([-0.2, 0.1]), np.array([0.5, 0.35])) < 0.15
    random = np.random.default_rng(0).uniform((-0.2, 0.1), (0.5, 0.35), (256, 2))
    assert unevenness(random, np.array([-0.2, 0.1]), np.array([0.5, 0.35])) > 0.3
    share, _ = np.histogram(np.log(z / 20.0) / math.log(5.0), 8, (0.0, 1.0))
    assert np.abs(share - 32).max() <= 8  # whole numbers of teeth are rounded
    # and two of them together: every ninth of the plane has its share
    both, _, _ = np.histogram2d(x, rho, 3)
    assert both.min() > 0.8 * 256 / 9
    at = np.array([d.load_position for d in found.gears])
    assert at.shape == (256, LOADS)
    assert (np.floor(at * LOADS) == np.arange(LOADS)).all()  # one load in each eighth


def test_the_same_seed_draws_the_same_gears():
    one, again, other = (numbers(drawn_gears(BASE, BOX, 16, s)) for s in (1, 1, 2))
    assert (one == again).all()
    assert (one != other).any()


def test_what_gives_no_tooth_is_drawn_anew_and_an_empty_box_is_refused():
    found = drawn_gears(BASE, {**BOX, "rack_tip_radius": (0.1, 1.0)}, 32)
    assert found.tried > 40
    assert numbers(found)[:, 2].max() < 0.5
    with pytest.raises(InputError, match="choose narrower ranges"):
        drawn_gears(BASE, {**BOX, "rack_tip_radius": (2.0, 3.0)}, 4)


@pytest.mark.parametrize("gears", [24, 192])
def test_shares_of_drawn_gears_are_within_their_errors(gears):
    """Loads of a gear agree more than chance: counted as independent their error would be up to 2.8 times too small."""
    rng, off, small = np.random.default_rng(7), [], []
    for _ in range(300):
        own = rng.beta(0.3, 0.7, gears)
        hits = rng.uniform(size=(gears, LOADS)) < own[:, None]
        off.append(abs(hits.mean() - 0.3) / share_error(hits))
        small.append(share_error(hits) / hits.mean(axis=1).std() * math.sqrt(gears))
    assert 0.93 < np.mean(np.array(off) < 2.0) < 0.99
    assert np.median(small) < 1.3


def test_a_share_of_none_or_all_of_some_gears_has_an_error():
    assert share_error(np.zeros((24, LOADS))) == share_error(np.ones((24, LOADS))) == pytest.approx(1.0 / 26.0)
    assert share_error(np.zeros((192, LOADS))) < 0.006


def planted(rng, right):
    """A formula that is 2 % off where `right` says, and 30 % elsewhere."""
    n = 1200
    columns = {
        "teeth": np.round(rng.uniform(10.0, 100.0, n)), "profile_shift": rng.uniform(-0.5, 0.5, n),
        "load_position": rng.uniform(0.0, 1.0, n),
    }  # fmt: skip
    ratio = np.where(right(columns), 0.98, 0.7) * (1.0 + 0.01 * rng.standard_normal(n))
    return ratio, columns, np.arange(n) // 8


def test_a_planted_range_is_found():
    ratio, columns, gear = planted(
        np.random.default_rng(1), lambda c: (c["teeth"] >= 37.0) & (c["profile_shift"] < 0.3)
    )
    found = reach("planted", ratio, columns, gear, columns["load_position"] >= 0.5)
    said = {(c.name, c.above): c.at for c in found.range}
    assert said[("teeth", True)] == pytest.approx(37.0, abs=8.0)
    assert said[("profile_shift", False)] == pytest.approx(0.25, abs=0.1)
    assert found.held > 0.9
    words = sentence(found, WORDS)
    assert words.startswith("planted is within 10 % of FE for z >= ")
    assert "x <= 0.2" in words
    assert "30 % low to 2 % low" in words or "31 % low" in words


def test_chance_is_no_range():
    rng = np.random.default_rng(2)
    ratio, columns, gear = planted(rng, lambda c: rng.uniform(size=c["teeth"].size) < 0.5)
    assert reach("chance", ratio, columns, gear, columns["load_position"] >= 0.5).range is None
    assert ": no parameter range found in which it is within" in sentence(
        reach("chance", ratio, columns, gear, columns["load_position"] >= 0.5), WORDS
    )


def test_right_everywhere_and_silent_everywhere():
    _, columns, gear = planted(np.random.default_rng(3), lambda c: c["teeth"] > 0)
    exact = reach("exact", np.ones(1200), columns, gear, columns["load_position"] >= 0.5)
    assert (exact.range, exact.held, exact.part, exact.near) == ((), 1.0, 1.0, 1.0)
    assert "everywhere, 100 % of the population" in sentence(exact, WORDS)
    silent = reach("silent", np.full(1200, np.nan), columns, gear, columns["load_position"] >= 0.5)
    assert silent.silent == 1.0
    assert sentence(silent, WORDS) == "silent gives no value for any gear of this population."
    # points at which a formula gives nothing are no points at which it is near
    half = np.where(np.arange(1200) % 2 == 0, 1.0, np.nan)
    assert reach("half", half, columns, gear, columns["load_position"] >= 0.5).range is None


def test_a_curve_ends_at_all_of_its_points_and_tells_what_lies_beyond():
    curve = spread(np.array([0.2, 0.9, 1.1, 2.0, np.nan]))
    assert curve.share[0] == 0.25
    assert curve.share[-1] == 1.0
    assert (curve.ratio.min(), curve.ratio.max()) == (0.5, 1.5)
    assert spread(np.array([np.nan])) is None
    assert NEAR == 0.1


def test_a_pressure_angle_is_said_in_degrees():
    """A page once had the conversion twice: 20 degrees were 1150."""
    one, two = np.ones(2), np.array([0.2, 0.8])
    rows = StudyRows(
        np.array([20, 30]), one, one, two, one, np.array(["f", "f"]), one, one, one, one, one, np.array(["high"] * 2),
        reason=np.array(["", ""]), rack_dedendum=one, pressure_angle=np.radians([20.0, 25.0]), stress_fe_error=one,
    )  # fmt: skip
    assert "z 20 to 30" in bounds_in_words(rows.read())
    assert "pressure angle 20 to 25°," in bounds_in_words(rows.read())


def test_stress_across_the_root_of_a_surface_that_is_pulled_across_its_helix():
    from fegear.contact.wide.root_stress import _across
    from fegear.fem.solid.fillet import SolidFillet

    rng, tau = np.random.default_rng(4), 0.07
    angle = rng.uniform(0.0, 1.5, 6)
    tangent, place = np.stack([np.cos(angle), np.sin(angle)]), rng.uniform(-9.0, 9.0, (2, 6))
    empty = np.empty(0)
    fillet = SolidFillet(empty.astype(int), empty, empty, tangent, place, empty, empty, 1.0)
    # own directions in space: t in the section, g along the helix, n across both; b across t in the surface
    for p in range(6):
        t = np.array([*tangent[:, p], 0.0])
        g = np.array([-tau * place[1, p], tau * place[0, p], 1.0])
        b = g - (g @ t) * t
        b /= np.linalg.norm(b)
        across = t - (t @ g) / (g @ g) * g
        across /= np.linalg.norm(across)
        along = g / np.linalg.norm(g)
        for pull, want in ((across, 1.0), (along, 0.0)):
            stress = np.outer(pull, pull)
            surface = np.zeros((3, 6, 1, 1))
            surface[:, p, 0, 0] = t @ stress @ t, b @ stress @ b, t @ stress @ b
            assert _across(surface, fillet, tau)[p, 0, 0] == pytest.approx(want, abs=1e-12)
    straight = np.ones((3, 6, 1, 1))
    assert _across(straight, fillet, 0.0) == pytest.approx(1.0)
