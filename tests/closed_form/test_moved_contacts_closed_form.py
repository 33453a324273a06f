"""Second-order approach of contacts that move: against the exact contact of polynomial gaps on half-planes."""

import math

import numpy as np
import pytest
from numpy.polynomial import chebyshev
from scipy.optimize import fsolve

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from tests.helpers.moved_contacts import flank_gap, moved_less


def exact_approach(load, radius, cubic, quartic, slope):
    """Approach of frictionless half-planes, E* = 1, whose gap is a polynomial and whose bodies soften along s.

    With s = m + h x the pressure is (1 - x^2)^1/2 times a series of U_k, since (2/pi) PV of its integral over s - t is
    the slope of gap and tilt, and vanishes at both ends; m and h follow from that and from the load.
    """
    x = np.cos(math.pi * (np.arange(12) + 0.5) / 12)

    def series(m, h):
        s = m + h * x
        rise = s / radius + 3.0 * cubic * s**2 + 4.0 * quartic * s**3 + slope * load
        return chebyshev.chebfit(x, 0.5 * math.pi * rise, 5)

    scale = math.sqrt(4.0 * load * radius / math.pi)
    m, h = fsolve(lambda at: (series(*at)[0] * scale, 0.5 * at[1] * series(*at)[1] - load), (0.0, scale), xtol=1e-12)
    u = series(m, h)
    # (1 - x^2)^1/2 U_{k-1} = (T_{k-1} - T_{k+1}) / 2 (1 - x^2)^-1/2, of which the logarithm leaves pi/n T_n
    weight = np.zeros(u.size + 1)
    for k in range(1, u.size):
        weight[k - 1] += 0.5 * u[k] / math.pi
        weight[k + 1] -= 0.5 * u[k] / math.pi
    waves = chebyshev.chebvander(np.zeros(1), u.size)[0]
    logarithm = weight[0] * math.pi * math.log(2.0) + sum(
        weight[n] * math.pi / n * waves[n] for n in range(1, weight.size)
    )
    pressed = h * (logarithm - math.pi * weight[0] * math.log(h))
    moment = m * load + h * h * 0.5 * math.pi * weight[1]
    gap = m * m / (2.0 * radius) + cubic * m**3 + quartic * m**4
    return 2.0 / math.pi * pressed + gap + slope * (m * load + moment)


@pytest.mark.parametrize(("cubic", "quartic", "slope"), [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0),
                                                         (1.0, 0.5, 1.0), (-1.0, 0.5, 1.0)])  # fmt: skip
def test_the_term_is_that_of_the_exact_contact(cubic, quartic, slope):
    load, radius = 0.02, 1.3
    straight = exact_approach(load, radius, 0.0, 0.0, 0.0)
    square = 4.0 * load * radius / math.pi
    # per square of the half-width all three are of the size of the parabola
    parts = np.array([cubic / radius / math.sqrt(square), quartic / radius / square, slope * math.sqrt(square) / load])
    for size, within in ((4e-2, 2e-2), (1e-2, 2e-3)):
        b, g, t = parts * size * np.array([1.0, size, 1.0])
        less = moved_less(*(np.array(one) for one in ([load], [[t]], [radius], [b], [g])), 1.0)
        found = straight - exact_approach(load, radius, b, g, t)
        assert found == pytest.approx(float(less[0]), rel=within)


def test_coupled_pairs_have_one_energy():
    """Of two pairs each approaches less by the derivative of the energy of both."""
    rng = np.random.default_rng(4)
    load, radius, cubic = rng.uniform(0.5, 1.5, 2), rng.uniform(0.5, 1.5, 2), rng.uniform(-0.3, 0.3, 2)
    slope, quartic = rng.uniform(-0.3, 0.3, (2, 2)), rng.uniform(-0.1, 0.1, 2)

    def energy(w):
        tilt, square = slope @ w, 4.0 * w * radius / math.pi
        turned = tilt**2 + 1.5 * tilt * cubic * square + 0.75 * (cubic * square) ** 2
        return float((0.5 * w * radius * turned - 0.125 * w * quartic * square**2).sum())

    step = 1e-5 * np.eye(2)
    wanted = [(energy(load + one) - energy(load - one)) / 2e-5 for one in step]
    assert moved_less(load, slope, radius, cubic, quartic, 1.0) == pytest.approx(wanted, rel=1e-8)


def test_the_gap_of_involutes_follows_their_arcs():
    """rho^2 = rho_0^2 + 2 r_b s along either flank, whose curvatures are integrated twice."""
    pair = GearPair(*(Gear(Tooth(z), 4e-3, 10e-3, 20e-3) for z in (19, 41)))
    x = 2e-3
    curvature, cubic, quartic = flank_gap(pair, x)
    s = np.linspace(-0.4e-3, 0.4e-3, 9)
    total = sum(
        1.0
        / np.sqrt(float(pair.flank_curvature_radius(x, member)) ** 2 + sign * 2.0 * pair.gear(member).base_radius * s)
        for member, sign in (("driver", 1.0), ("driven", -1.0))
    )
    assert total == pytest.approx(curvature + 6.0 * cubic * s + 12.0 * quartic * s * s, rel=1e-3)
    assert (total[5] - total[3]) / (s[5] - s[3]) == pytest.approx(6.0 * cubic, rel=1e-3)
