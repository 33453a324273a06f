"""Lin, Townsend, Oswald, NASA TM-89901: dynamic factor of 28-tooth gears with linear tip relief, Cornell compliances.

Not given in the paper and chosen here (they put the resonance near 10,500 rpm): gears as solid steel discs of pitch
radius, motor and load inertia ten times a gear's, shafts of 2.18e4 N m/rad with a damping ratio of 0.005. Mesh damping
ratio 0.10, W = 8890 N, one inch of face. The dynamic factor is the paper's: largest over static *tooth* load.
Every speed starts from the static state, as the paper's iteration does; Delta is the deflection of one tooth pair at
the HPSTC. Tolerances: the paper prints two digits.
"""

import math
from functools import cache

import numpy as np
import pytest

from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.train.charts import FourInertia, chart_point, linear_tip_relief, relief_start, speed_chart
from fegear.dynamics.train.excitation import MeshExcitation, effective_error
from fegear.dynamics.train.train import disc_inertia
from fegear.formulas.sources import pair_compliance, source
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

FORCE, FACE, RPM = 8890.0, 0.0254, math.pi / 30
SPEEDS = np.arange(2000.0, 16001.0, 250.0) * RPM


@cache
def gears():
    steel = Material(206.8e9, 0.3, 7850.0)
    gear = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.3, math.radians(20.0))), 3.175e-3, 0.0111, FACE, steel, "strain")
    return GearPair(gear, gear)


@cache
def stiffness():
    """Stiffness of one tooth pair over its path [N/m], a smooth fit to Cornell's compliance under the full load."""
    pair = gears()
    x = np.linspace(pair.x_start, pair.x_end, 241) * (1 - 1e-9)
    return np.polynomial.Chebyshev.fit(x, FACE / pair_compliance(source("cornell"), pair, x, FORCE / FACE).total, 14)


def delta():
    return FORCE / float(stiffness()(gears().x_hpstc))


def relieved(amount_1, amount_2, length):
    pair = gears()
    start_1 = relief_start(pair.x_end, pair.x_hpstc, length)
    start_2 = relief_start(pair.x_start, pair.x_lpstc, length)

    def separation(x):
        one = linear_tip_relief(x, pair.x_end, start_1, amount_1 * delta())
        return one + linear_tip_relief(x, pair.x_start, start_2, amount_2 * delta())

    return MeshExcitation.from_tooth_pair(
        stiffness(), separation, pair.x_start, pair.x_end, pair.base_pitch, breaks=[start_1, start_2], tolerance=1e-8
    )


def system(shaft_ratio=0.05):
    gear = gears().driver
    j = disc_inertia(gear.pitch_radius, FACE, 7850.0)
    r = gear.base_radius
    return FourInertia(
        10 * j, j, j, 10 * j, 2.18e4, 2.18e4, r, r, 28, 28, FORCE, shaft_ratio, 0.10, damping_law="momentary"
    )


def worst(amount_1, amount_2, length):
    return chart_point(system(), relieved(amount_1, amount_2, length), SPEEDS, direction="static")


def test_contact_ratio_and_pitch_point():
    """Contact ratio 1.64 (Table I); the pitch point is at L_n = 1.284."""
    pair = gears()
    assert pair.contact_ratio == pytest.approx(1.64, abs=0.005)
    assert relief_start(pair.x_end, pair.x_hpstc, 1.284) == pytest.approx(0.0, abs=3e-6)


@pytest.mark.long
def test_unmodified_gears():
    """Fig. 5(c): about 2.2 at about 11,000 rpm; the issue asks for 2.1 to 2.2 between 10,000 and 11,500 rpm."""
    for shaft_ratio in (0.02, 0.05):
        found = relieved(0.0, 0.0, 1.0)
        chart = speed_chart(
            MotionModel(system(shaft_ratio).train(1 / found.mean_compliance()), (found,), 1.0), SPEEDS,
            direction="static",
        )  # fmt: skip
        factor, where = chart.worst
        assert 2.1 < factor < 2.2
        assert 10_000 < where / RPM < 11_500


@pytest.mark.long
def test_falling_speed_keeps_the_contact_loss_branch():
    found = relieved(0.0, 0.0, 1.0)
    model = MotionModel(system(0.05).train(1 / found.mean_compliance()), (found,), 1.0)
    speeds = np.arange(7000.0, 12001.0, 250.0) * RPM
    up, down = (speed_chart(model, speeds, direction=d) for d in ("up", "down"))
    assert down.worst[0] > up.worst[0] + 0.5
    assert down.worst[1] < up.worst[1]


def test_unequal_relief_of_fig_11():
    """1.00 Delta on one gear, 1.25 on the other, L_n = 0.65: 1.39 from the equations of motion."""
    assert worst(1.0, 1.25, 0.65).dynamic_factor == pytest.approx(1.39, abs=0.02)


@pytest.mark.dear
def test_where_the_paper_is_not_met():
    """Fig. 6(c): "did not exceed 1.5" with 1.25 Delta at 0.52 L_n; 1.74 here, 16 % more.

    It hangs on the length: the factor falls by 0.03 for every 0.01 of L_n and passes 1.5 at L_n = 0.60; at L_n = 0.52 a
    mesh damping ratio of 0.135 would give the paper's 1.5 (and 1.9 instead of 2.1 for the unmodified gears).
    """
    assert worst(1.25, 1.25, 0.52).dynamic_factor == pytest.approx(1.74, abs=0.03)
    assert worst(1.25, 1.25, 0.62).dynamic_factor < 1.55


#: The rows of Figs. 9 and 10 on the page of sources hold all three; the ordinary run finds one of them anew.
OPTIMA = [
    (0.75, 1.05, 1.13),
    *(pytest.param(*rest, marks=pytest.mark.long) for rest in ((0.50, 1.16, 1.26), (1.50, 0.66, 0.74))),
]


@pytest.mark.dear
@pytest.mark.parametrize(("amount", "low", "high"), OPTIMA)
def test_optimum_length(amount, low, high):
    """Figs. 9 and 10: 1.21 for 0.50 Delta, 1.09 for 0.75 Delta, 0.68 to 0.72 for 1.50 Delta; grid of 0.02 to 0.04."""
    lengths = np.arange(low - 0.12, high + 0.13, 0.04)
    speeds = np.arange(3000.0, 15001.0, 500.0) * RPM
    factors = [
        chart_point(system(), relieved(amount, amount, float(n)), speeds, direction="static").dynamic_factor
        for n in lengths
    ]
    best = lengths[int(np.argmin(factors))]
    assert low - 0.02 <= best <= high + 0.02


@pytest.mark.dear
def test_effective_error_ranks_like_the_dynamic_factor():
    """Fig. 7: A_e over the length of relief has its minimum where the dynamic factor has, at 1.00 Delta."""
    lengths = np.arange(0.5, 1.25, 0.1)
    found = [effective_error(relieved(1.0, 1.0, float(n)).transmission_error(FORCE, tolerance=1e-8)) for n in lengths]
    speeds = np.arange(6000.0, 14001.0, 500.0) * RPM
    factors = [
        chart_point(system(), relieved(1.0, 1.0, float(n)), speeds, direction="static").dynamic_factor for n in lengths
    ]
    assert abs(int(np.argmin(found)) - int(np.argmin(factors))) <= 1
    assert np.corrcoef(found, factors)[0, 1] > 0.95
