"""ISO 6336-6: Miner's rule against brute force, limits and the exponents that the standard prints."""

import math

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part2_pitting as part2_permissible
from fegear.formulas.iso6336 import part3_strength
from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import (
    Bin,
    cycles_to_failure,
    damage,
    equivalent_torque,
    service_life,
    spectrum_safety,
    wohler_exponent,
)
from fegear.formulas.iso6336.rated import Strength

CURVE = Knots((1e5, 5e7, 1e10), (2400e6, 1500e6, 1275e6))
ENDURING = Knots((1e3, 3e6, 1e10), (2.5, 1.0, 1.0))


@pytest.mark.parametrize("curve", [CURVE, ENDURING])
def test_cycles_to_failure_inverts_the_curve(curve):
    for n in np.geomspace(curve.cycles[0], curve.cycles[-1], 50)[:-1]:
        s = curve.at(float(n))
        if s > curve.values[-1]:
            assert cycles_to_failure(curve, s) == pytest.approx(n, rel=1e-9)
    assert cycles_to_failure(curve, curve.values[0] * 1.0001) == 0.0
    assert cycles_to_failure(curve, curve.values[-1]) == math.inf


def test_one_level_has_the_safety_of_the_curve():
    for n in (1e2, 1e5, 3e6, 5e7, 2e9, 1e10, 1e12):
        safety = spectrum_safety([Bin(900e6, n, CURVE)])
        assert safety == pytest.approx(CURVE.at(n) / 900e6, rel=1e-9), n


def test_bins_that_are_split_joined_or_idle_change_nothing():
    bins = [Bin(1500e6, 1e6, CURVE), Bin(1000e6, 1e8, CURVE)]
    split = [Bin(1500e6, 4e5, CURVE), Bin(1500e6, 6e5, CURVE), Bin(1000e6, 1e8, CURVE), Bin(0.0, 1e9, CURVE)]
    assert spectrum_safety(split) == pytest.approx(spectrum_safety(bins), rel=1e-12)
    assert damage(split) == pytest.approx(damage(bins), rel=1e-12)


def brute(bins):
    """The largest of 5,000 safeties whose Miner sum, added up anew, stays at 1."""
    best = 0.0
    for safety in np.geomspace(0.05, 50.0, 5_000):
        total = 0.0
        for one in bins:
            s = one.stress * safety
            x, y = np.log(one.curve.cycles), np.log(one.curve.values)
            if s > one.curve.values[0]:
                total = math.inf
                break
            if s <= one.curve.values[-1]:
                continue
            total += one.cycles / math.exp(np.interp(-math.log(s), -y, x))
        if total <= 1.0:
            best = safety
    return best


def test_random_spectra_equal_brute_force():
    rng = np.random.default_rng(6336)
    for _ in range(4):
        count = int(rng.integers(1, 6))
        bins = [Bin(float(s), float(n), CURVE) for s, n in zip(
            rng.uniform(200e6, 2000e6, count), 10 ** rng.uniform(2, 11, count), strict=True)]  # fmt: skip
        step = (50.0 / 0.05) ** (1 / 4_999)
        assert brute(bins) <= spectrum_safety(bins) * (1 + 1e-9)
        assert spectrum_safety(bins) <= brute(bins) * step * (1 + 1e-9)


def test_life_until_failure_is_the_life_whose_sum_is_one():
    bins = [Bin(1800e6, 1e6, CURVE), Bin(1400e6, 1e8, CURVE)]
    life = service_life(bins, 1.0)
    assert damage([Bin(b.stress, b.cycles * life, b.curve) for b in bins]) == pytest.approx(1.0, rel=1e-12)
    assert service_life([Bin(1200e6, 1e6, CURVE)], 1.0) == math.inf
    assert service_life([Bin(2500e6, 1.0, CURVE)], 1.0) == 0.0


def test_an_idle_spectrum_is_refused():
    with pytest.raises(RangeError, match="must have a bin"):
        spectrum_safety([Bin(0.0, 1e6, CURVE)])
    with pytest.raises(RangeError, match="must have a level"):
        equivalent_torque(np.zeros(2), np.ones(2), 6.6, 5e7)


#: ISO 6336-6, table A.1: exponents p in torque of flanks and roots.
PUBLISHED = {
    "Eh": (6.610, 8.738),
    "V": (6.610, 6.225),
    "NT (nitr.)": (5.709, 17.035),
    "NV (nitrocar.)": (15.715, 84.003),
}


@pytest.mark.parametrize("group", PUBLISHED)
def test_exponents_are_those_of_table_a1(group):
    strength = Strength(group, 1e9, 3e8)
    flank, root = PUBLISHED[group]
    assert 0.5 * wohler_exponent(part2_permissible.life_knots(strength)) == pytest.approx(flank, abs=2e-3)
    assert wohler_exponent(part3_strength.life_knots(strength)) == pytest.approx(root, abs=2e-3)


def test_equivalent_torque_is_where_a_material_just_fails():
    rng = np.random.default_rng(7)
    p, limit = 6.61, 5e7
    for _ in range(30):
        count = int(rng.integers(1, 7))
        torque, cycles = rng.uniform(10, 100, count), 10 ** rng.uniform(4, 9, count)
        found = equivalent_torque(torque, cycles, p, limit)

        def fails(strength, torque=torque, cycles=cycles):
            hurts = torque > strength
            return (cycles[hurts] * (torque[hurts] / strength) ** p).sum() / limit > 1.0

        assert fails(found * (1 - 1e-9))
        assert not fails(found * (1 + 1e-9))


def test_equivalent_torque_of_one_level_at_the_knee_is_itself():
    assert equivalent_torque(np.array([50.0]), np.array([5e7]), 6.61, 5e7) == pytest.approx(50.0, rel=1e-12)
    assert equivalent_torque(np.array([50.0]), np.array([5e9]), 6.61, 5e7) == pytest.approx(50.0, rel=1e-12)


def test_a_level_curve_has_no_equivalent_torque_but_the_largest():
    """Where static strength rules up to the knee, only the largest load can break; smaller ones do no damage."""
    level = Knots((1e5, 2e6, 1e10), (1.1, 1.1, 0.9))
    assert math.isinf(wohler_exponent(level))
    found = equivalent_torque(np.array([50.0, 70.0, 60.0]), np.array([1e6, 10.0, 1e9]), math.inf, 2e6)
    assert found == 70.0
