"""Growing cracks: direction and cycles by hand, patches as the ring with one odd sector, energy, NASA's rims."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.plane.growing_crack import growing_crack
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.growth import LEVEL, equivalent, grow, turning
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.formulas.paris import ParisLaw, cycles_to, length_at
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rim_support import RimSupport

TOOTH, NU = Tooth(28), 0.3
DEPTH = TOOTH.tip_radius - TOOTH.root_radius
ARC = RimSupport(free_teeth=11)
LOAD = np.array([14.4]), np.array([1.0])


def crack_at(tangent, depth=0.08):
    """Straight into the fillet, at a right angle to it."""
    mouth = mouth_at_tangent(TOOTH, math.radians(tangent))
    return straight_crack(TOOTH, mouth, math.radians(90.0 - tangent), depth=depth)


def grown(backup, crack, steps, step=0.2, support=ARC, loads=LOAD, estimates=False):
    support = support if backup < 2.0 else None
    bore = TOOTH.root_radius - backup * DEPTH
    return grow(TOOTH, bore, NU, "stress", crack, loads, step=step, steps=steps, support=support, estimates=estimates)


def test_a_crack_turns_to_where_the_tangential_stress_is_largest():
    assert turning(1.0, 0.0) == 0.0
    assert turning(0.0, 1.0) == pytest.approx(-math.acos(1.0 / 3.0), rel=1e-12)
    assert turning(0.0, -1.0) == pytest.approx(math.acos(1.0 / 3.0), rel=1e-12)
    for k_2 in (-0.7, -0.1, 0.02, 0.5):
        t = np.linspace(-math.pi, math.pi, 200001)
        stress = np.cos(0.5 * t) ** 2 * (np.cos(0.5 * t) - 3.0 * k_2 * np.sin(0.5 * t))
        assert turning(1.0, k_2) == pytest.approx(t[stress.argmax()], abs=5e-5)
        (most,) = equivalent(np.ones(1), np.array([k_2]))
        assert most == pytest.approx(stress.max(), rel=1e-8)


@pytest.mark.parametrize("exponent", [1.5, 2.0, 3.1])
def test_cycles_are_those_of_a_crack_in_a_wide_plate(exponent):
    """K = S sqrt(pi a): N = (b^(1 - m/2) - a^(1 - m/2)) / (C S^m pi^(m/2) (1 - m/2)), the logarithm for m = 2."""
    stress, law = 80e6, ParisLaw(6.9e-12, exponent)
    length = np.array([1e-3, 1.2e-3, 2e-3, 5e-3])
    k = stress * np.sqrt(math.pi * length)
    found, power = cycles_to(length, law.rate(k)), 1.0 - 0.5 * exponent
    along = np.log(length / length[0]) if power == 0.0 else (length**power - length[0] ** power) / power
    assert found == pytest.approx(
        along / (6.9e-12 * (stress * 1e-6) ** exponent * math.pi ** (0.5 * exponent)), rel=1e-9
    )
    assert length_at(length, k, stress * math.sqrt(math.pi * 3e-3)) == pytest.approx(3e-3, rel=1e-9)
    assert length_at(length, k, 1e9) is None


def test_a_crack_stops_below_the_threshold_and_a_spectrum_is_the_mean_of_its_loads():
    length, k = np.array([1e-3, 2e-3, 3e-3]), np.array([4.0e6, 6.0e6, 9.0e6])
    law = ParisLaw(1e-11, 3.0, 5.0)
    assert np.isinf(cycles_to(length, law.rate(k))[1:]).all()
    mean = law.rate(k, (2.0, 0.5), (0.1, 0.9))
    assert mean == pytest.approx(0.1 * 1e-11 * np.array([8.0, 12.0, 18.0]) ** 3, rel=1e-12)
    one, other = cycles_to(length, ParisLaw(1e-11, 3.0).rate(k)), cycles_to(length, ParisLaw(1e-11, 3.0).rate(2.0 * k))
    assert one[1:] == pytest.approx(8.0 * other[1:], rel=1e-12)


@functools.cache
def whole(backup, support):
    gear = Gear(TOOTH, 1.0, TOOTH.root_radius - backup * DEPTH, 1.0, Material(1.0, NU, 1.0), "stress", support=support)
    return solve_gear(gear, settings_at(LEVEL), reach=1, estimate_error=False)


@pytest.mark.parametrize(
    ("backup", "support"),
    [pytest.param(1.0, ARC, marks=pytest.mark.dear), pytest.param(3.3, None, marks=pytest.mark.long)],
)
def test_a_patch_answers_as_the_ring_with_one_cracked_sector(backup, support):
    """At the first and the second depth: the patch's neighbours are coarse, its fillet is not."""
    found = grown(backup, crack_at(45.0, 0.3), 1)
    for n, crack in enumerate((crack_at(45.0, 0.3), found.crack)):
        known = solve_cracked_gear(whole(backup, support), {0: crack})
        k = known.stress_intensity(0, 0, LOAD[0])[0][:, 0]
        assert [found.k_1[n], found.k_2[n]] == pytest.approx(k, abs=2e-3 * k[0])
    first, last = (solve_cracked_gear(whole(backup, support), {0: c}) for c in (crack_at(45.0, 0.3), found.crack))
    change = last.own(0, LOAD[0], 0.1) - first.own(0, LOAD[0], 0.1)
    assert np.diff(found.compliance) == pytest.approx(change, rel=3e-3)


@pytest.mark.dear
def test_faces_in_contact_stop_a_crack_that_its_tooth_presses_together_and_leave_an_open_one():
    """Of an open crack not a bit changes; one in the opposite fillet has its faces shut, and no K_I."""
    crack = crack_at(45.0, 0.3)
    opened, closing = (grown(1.0, one, 1) for one in (crack, replace(crack, closing=True)))
    assert closing.k_1 == pytest.approx(opened.k_1, rel=1e-9)
    assert closing.compliance == pytest.approx(opened.compliance, rel=1e-9)
    assert closing.shut.tolist() == opened.shut.tolist() == [0.0, 0.0]
    back = straight_crack(TOOTH, crack.mouth, math.radians(45.0), depth=0.3, back=True)
    usual, shut = (grown(1.0, one, 1) for one in (back, replace(back, closing=True)))
    assert usual.stopped == shut.stopped == "closed"
    assert usual.k_1[0] < -0.1
    assert shut.k_1[0] == pytest.approx(0.0, abs=0.02 * abs(usual.k_1[0]))
    assert shut.shut[0] > 0.9
    assert shut.compliance[0] < usual.compliance[0]  # the shut crack carries


@pytest.mark.long
def test_errors_stated_along_a_path_beside_shorter_steps_and_finer_meshes():
    """True over stated: 0.4 to 1.0 of the path and of K_I beside steps of a quarter; the first K beside level 0."""
    coarse, fine = grown(1.0, crack_at(45.0), 8, estimates=True), grown(1.0, crack_at(45.0), 32, step=0.05)
    lengths = [np.append(0.0, np.cumsum(np.hypot(*np.diff(one.path)))) for one in (coarse, fine)]
    there, here = (
        np.array([np.interp(coarse.length, along, xy) for xy in one.path])
        for one, along in zip((coarse, fine), lengths, strict=True)
    )
    off = np.hypot(*(there - here))[1:]
    assert (off < 1.2 * coarse.tip_error[1:]).all()
    assert (off > 0.2 * coarse.tip_error[1:]).all()
    k = np.interp(coarse.length, fine.length, fine.k_1)
    assert (np.abs(coarse.k_1 - k) < 1.5 * (coarse.k_1_error + coarse.off_the_path)).all()
    gear = whole(1.0, ARC).gear
    known = solve_cracked_gear(solve_gear(gear, settings_at(0.0), reach=1, estimate_error=False), {0: crack_at(45.0)})
    k = known.stress_intensity(0, 0, LOAD[0])[0][:, 0]
    assert abs(coarse.k_1[0] - k[0]) < 1.5 * coarse.k_1_error[0] < 5e-3 * k[0]
    assert abs(coarse.k_2[0] - k[1]) < 1.5 * coarse.k_2_error[0]


@pytest.mark.long
def test_stress_intensity_in_a_rim_gives_back_the_energy():
    """K_I^2 + K_II^2 = E' dC/da / 2 (plane stress), of a crack that is about to leave its tooth."""
    found = grown(0.5, crack_at(60.0), 3)
    n, delta = found.length.size - 1, 0.01
    start = found.crack.corners[-2]
    way = np.subtract(found.crack.corners[-1], start)
    ends = []
    for sign in (-1.0, 1.0):
        scale = 1.0 + sign * delta / float(np.hypot(*way))
        corner = tuple((np.array(start) + scale * way).tolist())
        changed = type(found.crack)(found.crack.mouth, (*found.crack.corners[:-1], corner), False)
        ends.append(float(grown(0.5, changed, 1, step=0.05).compliance[0]))
    release = 0.5 * (ends[1] - ends[0]) / (2.0 * delta)
    assert found.k_1[n] ** 2 + found.k_2[n] ** 2 == pytest.approx(release, rel=4e-3)


NASA = [
    (backup, tangent, "rim" if backup == 0.3 or (backup == 0.5 and tangent > 40.0) else "tooth")
    for backup in (3.3, 1.0, 0.5, 0.3)
    for tangent in (30.0, 45.0, 60.0)
]
FEW = [(0.3, 30.0), (0.5, 60.0)]


@pytest.mark.parametrize(
    ("backup", "tangent", "end"),
    [
        pytest.param(*one, marks=pytest.mark.dear if one[:2] in FEW else pytest.mark.long, id=f"{one[0]}-{one[1]:g}")
        for one in NASA
    ],
)
def test_cracks_run_through_tooth_or_rim_as_in_nasas_gears(backup, tangent, end):
    """TM-107229: backup ratios of 3.3 and 1.0 break teeth, 0.3 the rim, 0.5 either, by the initial crack."""
    found = grown(backup, crack_at(tangent), 14)
    assert found.end == end
    assert found.stopped == "surface"
    assert (np.diff(found.k_1) > 0.0).all()


@pytest.mark.dear
def test_a_growing_crack_in_si_scales_with_size_and_load():
    gear = Gear(TOOTH, 3e-3, 3e-3 * (TOOTH.root_radius - DEPTH), 0.02, Material(2e11, NU), "stress", support=ARC)
    loads = 3e-3 * LOAD[0], np.array([1e5])
    found = growing_crack(
        gear, crack_at(45.0, 0.3), loads, step=0.6e-3, steps=1, law=ParisLaw(6.9e-12, 3.0), toughness=1e6
    )
    plain = grown(1.0, crack_at(45.0, 0.3), 1, estimates=True)
    assert found.k_1 == pytest.approx(plain.k_1 * 1e5 / math.sqrt(3e-3), rel=1e-9)
    assert found.length == pytest.approx(3e-3 * plain.length, rel=1e-9)
    assert found.stiffness == pytest.approx(2e11 / plain.compliance, rel=1e-9)
    assert found.fracture == pytest.approx(found.length[0])
    assert found.cycles[0] == 0.0
    assert found.cycles[1] > 0.0
    assert 0.0 < found.k_1_error[0] < 5e-3 * found.k_1[0]
    assert found.tip_error[0] == found.cycles_error[0] == 0.0
    assert found.tip_error[1] == pytest.approx(3e-3 * plain.tip_error[1], rel=1e-9)
    # a power of K: what K is off by counts three times
    assert found.cycles_error[1] == pytest.approx(3.0 * (found.k_1_error / found.k_1).mean() * found.cycles[1], rel=0.5)
    assert found.closed is None
    assert found.stiffness_loss[1] > found.stiffness_loss[0] == 0.0
