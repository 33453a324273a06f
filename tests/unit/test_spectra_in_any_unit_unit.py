"""Spectra keep no size of their own: loads a billion times smaller, or idle levels beside them, change no ratio."""

import numpy as np
import pytest

from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin, damage, equivalent_torque, service_life, spectrum_safety
from fegear.formulas.many.lives import ManyBins, ManyKnots, damages, spectrum_safeties

CYCLES, VALUES = (1e5, 5e7, 1e10), (2400e6, 1500e6, 1275e6)
LEVELS = ((1500e6, 1e6), (1000e6, 1e8))


def bins(scale=1.0, more=()):
    curve = Knots(CYCLES, tuple(scale * one for one in VALUES))
    return [Bin(scale * stress, n, curve) for stress, n in (*LEVELS, *more)]


@pytest.mark.parametrize("scale", [1e-10, 1.0, 1e3])
@pytest.mark.parametrize("more", [(), ((0.0, 1e9),), ((9000e6, 0.0),), ((0.0, 0.0),)])
def test_safety_and_damage_are_those_of_the_loaded_levels_in_any_unit(scale, more):
    plain = bins()
    assert spectrum_safety(bins(scale, more)) == pytest.approx(spectrum_safety(plain), rel=1e-9)
    assert damage(bins(scale, more), 1.2) == pytest.approx(damage(plain, 1.2), rel=1e-9)
    assert service_life(bins(scale, more), 7.0) == pytest.approx(7.0 / damage(plain), rel=1e-9)


@pytest.mark.parametrize("cycles", [9e4, 1e5, 1.02e5, 1.2e5])
def test_just_beyond_the_knee_of_static_strength_less_is_borne(cycles):
    curve = Knots(CYCLES, VALUES)
    assert spectrum_safety([Bin(1000e6, cycles, curve)]) == pytest.approx(curve.at(cycles) / 1000e6, rel=1e-9)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("more", [(), ((0.0, 1e9),), ((5e4, 0.0),)])
def test_an_equivalent_torque_scales_with_its_levels(scale, more):
    """Of 20 cycles of 100 N m where the knee is at 10 and p = 3, T_eq = 100 N m 2^(1/3), but no more than 100."""

    def found(levels, limit, exponent=3.0):
        torque, cycles = np.array([(scale * t, n) for t, n in (*levels, *more)]).T
        return equivalent_torque(torque, cycles, exponent, limit) / scale

    assert found([(100.0, 5)], 10) == pytest.approx(100.0 * 0.5 ** (1.0 / 3.0))
    assert found([(100.0, 20)], 10) == pytest.approx(100.0)
    both = found([(80.0, 2), (100.0, 3)], 10)
    assert both == pytest.approx(100.0 * (0.3 + 0.2 * 0.8**3) ** (1.0 / 3.0))
    assert found([(80.0, 8), (100.0, 3)], 10) == pytest.approx(80.0)  # above them the second level does none
    # 60 N m of a level are less than what the first one comes to: no damage
    assert found([(60.0, 8), (100.0, 5)], 10) == found([(100.0, 5)], 10)


@pytest.mark.parametrize("scale", [1e-10, 1.0])
def test_many_pairs_have_the_damage_of_each_and_none_at_rest(scale):
    """Three pairs: at the loads of the spectrum, at none of the first level, at no load cycles of the second."""
    line = ManyKnots(CYCLES, tuple(np.full(3, scale * one) for one in VALUES))
    (s_1, n_1), (s_2, n_2) = LEVELS
    first = ManyBins(scale * np.array([s_1, 0.0, s_1]), np.array([n_1, n_1, n_1]), line)
    second = ManyBins(scale * np.array([s_2, s_2, s_2]), np.array([n_2, n_2, 0.0]), line)
    each = [bins(), bins()[1:], bins()[:1]]
    assert first.damage()[1] == second.damage()[2] == 0.0
    assert damages([first, second], 1.2) == pytest.approx([damage(one, 1.2) for one in each])
    alone = ManyBins(first.stress[:1], first.cycles[:1], ManyKnots(CYCLES, tuple(one[:1] for one in line.values)))
    assert spectrum_safeties([alone]) == pytest.approx([spectrum_safety(bins()[:1])], rel=1e-9)
