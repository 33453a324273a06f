"""What is stated of a whole base pitch: few roll positions, further loads, peaks between positions, spots."""

import functools
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from fegear.base.errors import ConvergenceError
from fegear.base.solution_cache import SolutionCache
from fegear.contact.between_positions import likely_peaks
from fegear.contact.wide.error import flank_error
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_sharing import solve_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.contact.wide.over_pitch import over_pitch
from fegear.contact.wide.spots import missed_of_spots
from fegear.contact.wide.tip_edges import usual_gap
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import heavy_load
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
COARSE = SolidSettings().scaled(1.7)
MODULE, WIDTH, LOAD = 3e-3, 9e-3, 2000.0
FACE = np.linspace(-0.5, 0.5, 4001) * WIDTH
MISALIGNED = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([0.0, 8e-6]))


def crowned(amount):
    return FlankGaps(face_position=FACE, line_gap=amount * (2.0 * FACE / WIDTH) ** 2)


def pair_of(beta):
    hands = ("right", "left") if beta else ("spur", "spur")
    tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return GearPair(*(Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", h) for h in hands))


@pytest.fixture(scope="module")
def bodies():
    """Driver and driven gear, spur and helical, of usual and of coarser meshes, when first asked for."""

    @functools.cache
    def body(tooth, twist, bore_radius, settings):
        return solve_solid(tooth, twist * MODULE, WIDTH / MODULE, 0.3, bore_radius / MODULE, settings, reach=2)

    def of(beta, name):
        pair, settings = pair_of(beta), COARSE if name == "usual" else COARSE.coarser(WIDTH / MODULE)
        return {
            member: body(gear.tooth, gear.twist, gear.bore_radius, settings)
            for member, gear in (("driver", pair.driver), ("driven", pair.driven))
        }

    return of


def flanks_of(bodies, beta, *, edges=False, **how):
    pair = pair_of(beta)
    gap = usual_gap(pair, LOAD) if edges else 0.0
    settings = {"positions": 12, "panel": 0.25, "most_gap": gap, "cache": SolutionCache(), **how}
    return FlankPair(pair, bodies(beta, "usual"), **settings)


def stated(flanks, bodies, beta, gaps, loads=(LOAD,)):
    found = flanks.solve(loads, gaps, flanks.compliance(LOAD))
    over = over_pitch(flanks, found, gaps, LOAD)
    return over.stated, flank_error(flanks, found, bodies(beta, "coarse"), gaps, over, LOAD), over


def test_the_largest_share_is_that_of_the_whole_base_pitch_and_its_error_what_half_of_the_positions_miss():
    """It was that of the positions of a table, which may be four, and its error that of each of them."""
    x = np.arange(8.0)
    share = np.stack([0.9 - 0.01 * (x - 5.0) ** 2, 0.1 + 0.01 * (x - 5.0) ** 2])[:, :, None]
    lines = SimpleNamespace(x=np.zeros((8, 1)), z=np.zeros((8, 1)))
    over = SimpleNamespace(
        found=SimpleNamespace(share=share, smooth_pressure=np.ones((8, 1, 1)), lines=lines),
        points=SimpleNamespace(x=x, breaks=np.array([8.0])),
    )
    error = SimpleNamespace(share=np.full((2, 4, 1), 0.003), largest_pressure=np.zeros(1))
    pair = SimpleNamespace(at=0, over=over, found=SimpleNamespace(share=share[:, ::2]), error=error)
    found = LoadedWidePair.largest.func(pair)
    assert found.share == pytest.approx(0.9)
    assert found.share_error == pytest.approx(0.003 + 0.01)


@pytest.mark.dear
def test_short_contact_lines_decide_no_largest_pressure(bodies):
    """Lines at a corner of the face are as short as a panel, and what they bear hangs on its length."""
    gaps = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([10e-6, 0.0]))
    flanks = flanks_of(bodies, 15.0)
    values, error, over = stated(flanks, bodies, 15.0, gaps)
    found, off = over.found, float(error.largest_pressure[0])
    smooth = np.where(found.smooth, found.pressure[:, :, 0], 0.0)
    p, s = np.unravel_index(np.argmax(smooth), smooth.shape)
    (own,) = (one for one in found.lines.at(p) if one.start <= s < one.stop)
    assert np.ptp(found.lines.z[p, own]) >= MODULE * (1.0 - 1e-9)
    assert (found.lines.present & ~found.long).any()
    largest = []
    for share in (0.5, 0.3):  # nor do stations beside a tip, which bear the more the shorter panels are
        finer = replace(flanks, positions=48, panel=share * flanks.panel)
        largest.append(finer.solve([LOAD], gaps, finer.compliance(LOAD)).largest_pressure[0])
    assert largest[0] == pytest.approx(largest[1], rel=0.02)
    assert abs(largest[1] - values.largest_pressure[0]) < off < 0.15 * values.largest_pressure[0]


def test_panels_shorter_than_a_contact_leave_no_zigzag(bodies):
    """Station by station forces of 150 panels alternate by a third, and made 2045 of 1800 MPa of `helical_load`."""
    flanks = flanks_of(bodies, 15.0, panel=0.018)
    found = flanks.solve([LOAD], MISALIGNED, flanks.compliance(LOAD, flanks.roll[:1]))
    lines, rough = found.lines, found.contact.force[:, :, 0] / np.where(found.lines.present, found.lines.support, 1.0)
    long = max(lines.at(0), key=lambda one: np.ptp(lines.z[0, one]))
    smooth = found.line_load[0, long, 0]

    def bends(values):
        return np.abs(np.diff(values, 2)).sum()

    assert bends(smooth) < 0.2 * bends(rough[0, long])
    assert np.trapezoid(smooth, lines.z[0, long]) == pytest.approx(found.contact.force[0, long, 0].sum(), rel=1e-3)
    usual = flanks_of(bodies, 15.0).solve([LOAD], MISALIGNED)  # panels longer than that: what stands at a station
    on = usual.lines.support > 0.0
    np.testing.assert_array_equal(usual.line_load[on][:, 0], usual.contact.force[on][:, 0] / usual.lines.support[on])


@pytest.mark.dear
@pytest.mark.parametrize(("beta", "edges"), [pytest.param(0.0, True, marks=pytest.mark.long), (15.0, True)])
def test_few_roll_positions_state_what_many_show(bodies, beta, edges):
    """Twelve positions were off by up to six times what was stated; so was what eight said of the peak to peak."""
    flanks = flanks_of(bodies, beta, edges=edges)
    dense = replace(flanks, positions=128)
    many = dense.solve([LOAD], MISALIGNED, dense.compliance(LOAD))
    # kinks are narrower than that: once more about the largest value
    roll, te = dense.roll, many.transmission_error[:, 0]
    nearby = roll[te.argmax()] + np.linspace(-0.02, 0.02, 61) * flanks.pair.base_pitch
    largest = dense.solve([LOAD], MISALIGNED, dense.compliance(LOAD, nearby)).transmission_error.max()
    true = {
        "mean": many.mean_transmission_error[0], "peak_to_peak": max(largest, te.max()) - te.min(),
        "face_load_factor": many.face_load_factor[0],
    }  # fmt: skip
    for positions in (8, 12):
        values, error, over = stated(replace(flanks, positions=positions), bodies, beta, MISALIGNED)
        for key, wanted in true.items():
            off, left = abs(getattr(values, key)[0] - wanted), getattr(over.left_by_positions, key)[0]
            assert off < 1.5 * left + 1e-3 * wanted, key
            assert off < 1.5 * getattr(error, key)[0], key
            # no blanket: that of the peak to peak was twice the value
            assert getattr(error, key)[0] < 0.05 * wanted, key


@pytest.mark.long
def test_a_larger_load_besides_changes_nothing(bodies):
    """Contact lines go farther along tip edges for it, and roll positions stand elsewhere."""
    alone, error, _ = stated(flanks_of(bodies, 15.0, edges=True), bodies, 15.0, MISALIGNED)
    farther = flanks_of(bodies, 15.0, most_gap=usual_gap(pair_of(15.0), 2.0 * LOAD))
    beside, _, _ = stated(farther, bodies, 15.0, MISALIGNED, (LOAD, 2.0 * LOAD))
    for key in ("mean", "peak_to_peak", "face_load_factor"):
        assert abs(getattr(beside, key)[0] - getattr(alone, key)[0]) < 0.2 * getattr(error, key)[0], key


def test_peaks_between_positions_are_looked_for_where_both_sides_meet():
    x = np.linspace(0.0, 1.0, 21)[:-1]
    kink = 0.5323
    curve = np.where(x < kink, x, kink - 3.0 * (x - kink))[:, None]
    places, height = likely_peaks(x, curve, 1.0)
    likeliest = int(height[:, 0].argmax())
    assert places[likeliest, 0, 0] == pytest.approx(kink, abs=1e-12)
    # at least what is missed, at most half of an interval of the flatter side
    assert kink - curve.max() <= height[likeliest, 0] < kink - curve.max() + 0.5 * 0.05
    # both sides of a jump are known: nothing stands between them
    x = np.sort(np.append(x, [0.52, 0.52 + 1e-7]))
    _, height = likely_peaks(x, np.where(x <= 0.52, x, -x)[:, None], 1.0)
    assert height.max() <= 0.0


@pytest.mark.dear("1.0")
@pytest.mark.parametrize("longer", [1.0, 4.0, 20.0])
def test_spots_are_hertz_ellipses_within_what_is_stated(bodies, longer):
    """Crowning as round as the profiles, and flatter (Johnson, Contact Mechanics, 4.2)."""
    pair = pair_of(0.0)
    radius = float(1.0 / sum(1.0 / pair.flank_curvature_radius(0.0, member) for member in ("driver", "driven")))
    gaps = crowned((0.5 * WIDTH) ** 2 / (2.0 * longer * radius))
    modulus = 0.5 * STEEL.young_modulus / (1.0 - STEEL.poisson_ratio**2)
    shape, force = hertz_ellipse(longer), np.array([20.0, 200.0, 2000.0])
    mean_axis = np.cbrt(0.75 * force * radius * math.sqrt(longer) / modulus) * shape[1]
    hertz = 1.5 * force / (math.pi * mean_axis**2)
    flanks = flanks_of(bodies, 0.0, panel=0.015, positions=2)
    for load, pressure in zip(force.tolist(), hertz.tolist(), strict=True):
        found = flanks.solve([load], gaps, flanks.compliance(load, np.zeros(1)))
        low = missed_of_spots(found.known, found.contact, found.smooth_pressure, 0.0)
        missed = float(low[0] / found.largest_pressure[0])
        assert found.contact.residual.max() < 1e-9
        assert abs(float(found.largest_pressure[0]) / pressure - 1.0) < missed + 0.02
        assert missed < 0.8 * shape[0] ** 2 + 0.02


def hertz_ellipse(longer):
    """b / a of the ellipse of curvatures in the ratio of `longer`, and its factor F_1 (Johnson, 4.28 to 4.31)."""

    def off(k):
        e, kk = ellipe(1.0 - k**2), ellipk(1.0 - k**2)
        return (e / k**2 - kk) / (kk - e) - longer

    if longer == 1.0:
        return 1.0, 1.0
    k = brentq(off, 1e-3, 0.999)
    e, kk = ellipe(1.0 - k**2), ellipk(1.0 - k**2)
    return k, np.cbrt(4.0 / (math.pi * (1.0 - k**2)) * k**1.5 * math.sqrt((e / k**2 - kk) * (kk - e)))


def test_a_light_load_on_a_spot_is_found_whatever_loads_are_beside_it(bodies):
    """It stands on so little of its line that the width under the mean load is an eighth of its own."""
    pair = pair_of(0.0)
    flanks, gaps = flanks_of(bodies, 0.0, panel=0.015, positions=2), crowned(2e-3)
    known = flanks.compliance(20.0, np.zeros(1))
    with pytest.raises(ConvergenceError, match=r"load_distribution\.panels"):
        solve_contact(known, gaps.at(pair, known.lines), np.array([20.0]), 60)
    found, alone = flanks.solve([20.0, 200.0], gaps, known), flanks.solve([20.0], gaps, known)
    assert found.contact.residual.max() < 1e-9
    np.testing.assert_array_equal(found.contact.force[:, :, 0], alone.contact.force[:, :, 0])


def test_flanks_say_what_no_metal_bears():
    pair = pair_of(0.0)
    assert not heavy_load(pair, LOAD, 2e9)
    assert "strength of any metal" in heavy_load(pair, 250e3)
    assert "crowning" in heavy_load(pair, LOAD, 5e9)
    soft = replace(STEEL, young_modulus=3e9)
    plastic = GearPair(*(replace(gear, material=soft) for gear in (pair.driver, pair.driven)))
    assert not heavy_load(plastic, LOAD, 5e9)
