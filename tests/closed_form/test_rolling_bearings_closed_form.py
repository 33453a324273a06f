"""Rolling bearings: Hertz's point contact, Stribeck's largest load, derivatives of the energy, basic rating life."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.shafts.axial_factors import AxialFactors
from fegear.shafts.beam import Shaft
from fegear.shafts.deflection import deflect
from fegear.shafts.held import LoadedShaft, Seat
from fegear.shafts.life import LifeRating
from fegear.shafts.rolling_bearing import RollingBearing, point_contact
from fegear.shafts.section import Section

BALL = RollingBearing("ball", 9, 12.7e-3, 65e-3, clearance=15e-6)
ANGULAR = RollingBearing("ball", 14, 10e-3, 60e-3, contact_angle=math.radians(25))
ROLLER = RollingBearing("roller", 14, 10e-3, 60e-3, roller_length=12e-3)
TAPERED = RollingBearing("roller", 18, 9e-3, 60e-3, contact_angle=math.radians(-14), roller_length=14e-3)
SPHERICAL = RollingBearing(
    "roller", 15, 10e-3, 60e-3, math.radians(11), roller_length=8e-3, clearance=8e-6, aligning=True
)


def test_a_ball_on_a_plate_and_two_crossed_cylinders():
    plane = 226e9
    for radius in (0.005, 0.02):
        sphere = (1 / radius, 1 / radius, 0.0, 0.0)
        assert point_contact(sphere, plane) == pytest.approx(2 / 3 * plane * math.sqrt(radius), rel=1e-12)
        crossed = (1 / radius, 0.0, 0.0, 1 / radius)
        assert point_contact(crossed, plane) == pytest.approx(2 / 3 * plane * math.sqrt(radius), rel=1e-12)


def test_constants_of_steel_are_the_printed_ones():
    """ISO/TS 16281: 35948 L^(8/9) delta^(10/9) in N and mm; Harris: K = 2.15e5 (sum of curvatures)^-1/2 N/mm^1.5."""
    in_mm = ROLLER.constant * 1e-3 ** (10 / 9)
    assert in_mm == pytest.approx(35948 * 12 ** (8 / 9), rel=1e-12)
    of_sphere = point_contact((1 / 5e-3, 1 / 5e-3, 0.0, 0.0)) * 1e-3**1.5
    assert of_sphere == pytest.approx(2.15e5 * (2 / 5) ** -0.5, rel=0.01)
    assert of_sphere == pytest.approx(2 / 3 * 206e3 / 0.91 * math.sqrt(5), rel=1e-12)


@pytest.mark.parametrize("ratio", [1.1, 1.5, 6.7, 40.0])
def test_an_elliptic_contact_is_the_potential_of_its_pressure(ratio):
    """Hertz's pressure over the ellipse of semi-axes a = 1, b = 1/ratio: deflection and curvatures by quadrature.

    w = (p_0 b/2 E*) int_0^inf (1 - x^2/(1 + s) - y^2/(b^2 + s)) ds / sqrt((1 + s)(b^2 + s) s).
    """
    from scipy.integrate import quad

    b2, plane = ratio**-2, 1.0

    def integral(power_a, power_b):
        def of(t):
            s = t * t
            return 2.0 / ((1.0 + s) ** (0.5 + power_a) * (b2 + s) ** (0.5 + power_b))

        return sum(quad(of, *ends, epsabs=0, epsrel=1e-12, limit=500)[0] for ends in ((0, 1 / ratio), (1 / ratio, 1),
                                                                                      (1, math.inf)))  # fmt: skip

    factor = 0.5 / ratio / (0.5 * plane)  # p_0 = 1, E* = half of E' of one body
    delta, along, across = (factor * integral(*powers) for powers in ((0, 0), (1, 0), (0, 1)))
    load = 2.0 / 3.0 * math.pi / ratio
    found = point_contact((2.0 * along, 2.0 * across, 0.0, 0.0), plane)
    assert found * delta**1.5 == pytest.approx(load, rel=1e-9)


@pytest.mark.parametrize(("kind", "expected", "slack"), [("ball", 4.37, 0.02), ("roller", 4.08, 0.05)])
def test_the_largest_load_is_stribecks_without_clearance(kind, expected, slack):
    """Stribeck and Palmgren: Q_max = 4.37 F_r/Z for balls, 4.08 for rollers (n = 1; 10/9 gives 4.06)."""
    bearing = RollingBearing(kind, 40, 4e-3, 60e-3, roller_length=8e-3)
    u = np.array([20e-6, 0, 0, 0, 0])
    radial = bearing.reaction(u)[0][0]
    assert bearing.loads(u).max() * 40 / radial == pytest.approx(expected, abs=slack)


@pytest.mark.parametrize("bearing", [BALL, ANGULAR, ROLLER, TAPERED, SPHERICAL])
def test_stiffness_is_the_derivative_of_the_force_and_symmetric(bearing):
    u = np.array([22e-6, -9e-6, -15e-6 if bearing.contact_angle < 0 else 15e-6, 3e-4, -2e-4])
    stiffness = bearing.reaction(u)[1]
    scale = np.array([1e-6, 1e-6, 1e-6, 1e-5, 1e-5])
    for n, step in enumerate(np.diag(scale) * 1e-3):
        slope = (bearing.reaction(u + step)[0] - bearing.reaction(u - step)[0]) / (2 * step[n])
        assert slope * scale == pytest.approx(stiffness[n] * scale, abs=2e-4 * np.abs(stiffness * scale).max())
    assert np.abs(stiffness - stiffness.T).max() <= 1e-12 * np.abs(stiffness).max()


@pytest.mark.parametrize("bearing", [BALL, ANGULAR, ROLLER, TAPERED])
def test_a_motion_turned_by_one_element_loads_the_next_ones_alike(bearing):
    c, s = math.cos(2 * math.pi / bearing.count), math.sin(2 * math.pi / bearing.count)
    turn = np.array([[c, -s], [s, c]])
    u = np.array([22e-6, -9e-6, -15e-6 if bearing.contact_angle < 0 else 15e-6, 6e-4, -8e-4])
    turned = np.concatenate([turn @ u[:2], u[2:3], turn @ u[3:]])
    loads, force = bearing.loads(u), bearing.reaction(u)[0]
    assert np.count_nonzero(loads) >= 3
    assert bearing.loads(turned) == pytest.approx(np.roll(loads, 1), rel=1e-9, abs=1e-9 * loads.max())
    again = np.concatenate([turn @ force[:2], force[2:3], turn @ force[3:]])
    assert bearing.reaction(turned)[0] == pytest.approx(again, rel=1e-9, abs=1e-9 * np.abs(force).max())


def test_a_spherical_roller_bearing_is_two_tapered_ones_that_do_not_tilt():
    """Against each other, of one pitch circle, and free to turn about its centre; its clearance is across the axis."""
    u = np.array([21e-6, -12e-6, 9e-6, 0.0, 0.0])
    gap = SPHERICAL.clearance * math.cos(SPHERICAL.contact_angle)
    one = replace(SPHERICAL, aligning=False, clearance=gap)
    rows = [replace(one, contact_angle=sign * one.contact_angle).reaction(u)[0] for sign in (1.0, -1.0)]
    force = SPHERICAL.reaction(u)[0]
    assert force[:3] == pytest.approx(sum(rows)[:3], rel=1e-9)
    tilted = SPHERICAL.reaction(u + np.array([0.0, 0.0, 0.0, 2e-3, -3e-3]))
    assert tilted[0] == pytest.approx(force, rel=1e-12, abs=1e-9)
    assert not tilted[0][3:].any()
    assert not tilted[1][3:].any()


def test_axial_force_on_a_spherical_roller_bearing_is_on_one_row_by_hand():
    """Z c (w sin(alpha) - gap)^(10/9) sin(alpha), either way; none within the axial clearance."""
    sine, gap = math.sin(SPHERICAL.contact_angle), 0.5 * SPHERICAL.clearance * math.cos(SPHERICAL.contact_angle)
    for way in (1.0, -1.0):
        w = 60e-6
        by_hand = SPHERICAL.count * SPHERICAL.constant * (w * sine - gap) ** (10 / 9) * sine
        assert SPHERICAL.reaction(np.array([0, 0, way * w, 0, 0]))[0][2] == pytest.approx(way * by_hand, rel=1e-9)
        assert not SPHERICAL.reaction(np.array([0, 0, way * 0.99 * gap / sine, 0, 0]))[0].any()


def test_preload_stiffens_two_angular_contact_bearings_by_hand():
    """Face to face, pressed by w_0: each has Z c (w sin(alpha))^1.5; together 3 times the slope, the clearance along
    the normal as w_0 sin(alpha)."""
    angle, preload = math.radians(40.0), 12e-6
    stiff_grooves = (0.52, 0.52)
    one = RollingBearing("ball", 14, 12.7e-3, 60e-3, angle, stiff_grooves, clearance=-preload)
    pair = [one, replace(one, contact_angle=-angle)]
    step = 1e-8
    forces = [sum(b.reaction(np.array([0, 0, z, 0, 0]))[0][2] for b in pair) for z in (-step, 0.0, step)]
    slope = (forces[2] - forces[0]) / (2 * step)
    # the normal approach of either is half the preload at rest; the angle changes little with it
    by_hand = 2 * 1.5 * one.count * one.constant * (0.5 * preload) ** 0.5 * math.sin(angle) ** 2
    assert forces[1] == pytest.approx(0.0, abs=1e-6 * slope * preload)
    assert slope == pytest.approx(by_hand, rel=0.03)
    loose = [replace(b, clearance=0.0) for b in pair]
    free = [sum(b.reaction(np.array([0, 0, z, 0, 0]))[0][2] for b in loose) for z in (-step, step)]
    assert (free[1] - free[0]) / (2 * step) < 0.1 * slope


def test_a_roller_that_tilts_is_pressed_at_one_half_by_the_integral_of_its_law():
    """Half a roller under an approach theta cos(phi) z: moment c/L theta^n int z^(n+1) dz abs(cos(phi))^(n+1)."""
    theta, n, half = 1e-3, 10 / 9, 0.5 * ROLLER.roller_length
    phi = 2 * math.pi * np.arange(ROLLER.count) / ROLLER.count
    one = ROLLER.constant / ROLLER.roller_length * theta**n * half ** (n + 2) / (n + 2)
    about_y = ROLLER.reaction(np.array([0, 0, 0, 0, theta]))[0]
    about_x = ROLLER.reaction(np.array([0, 0, 0, theta, 0]))[0]
    assert about_y[4] == pytest.approx(one * (np.abs(np.cos(phi)) ** (n + 1)).sum(), rel=2e-3)
    assert about_x[3] == pytest.approx(one * (np.abs(np.sin(phi)) ** (n + 1)).sum(), rel=2e-3)


def test_the_usual_stiffness_is_that_of_all_elements_under_an_approach_of_a_two_thousandth_of_their_diameter():
    """Springs of one slope around: Z/2 of it across, Z along, and an arm's square more for tilting.

    Balls without a contact angle stand in for their lean under an axial force with a fifth of the slope's root.
    """
    for bearing in (BALL, ANGULAR, ROLLER):
        delta, n, angle = bearing.element_diameter / 2000, bearing.exponent, bearing.contact_angle
        slope = n * bearing.constant * delta ** (n - 1) * bearing.count
        radius = bearing.pitch_diameter / 2
        along = math.sin(angle) ** 2 + (0.04 if bearing is BALL else 0.0)
        of_tilt = along * radius**2 + (bearing.roller_length**2 / 12 if bearing.kind == "roller" else 0.0)
        expected = np.diag([math.cos(angle) ** 2 / 2, math.cos(angle) ** 2 / 2, along, of_tilt / 2, of_tilt / 2])
        mixed = math.sin(angle) * math.cos(angle) * radius / 2
        expected[0, 4] = expected[4, 0] = -mixed
        expected[1, 3] = expected[3, 1] = mixed
        assert bearing.usual == pytest.approx(slope * expected, rel=1e-9, abs=1e-9 * slope * radius**2)


def test_grooves_are_those_of_usual_bearings_where_nothing_is_said():
    """Radii of 0.52 of the ball's diameter, inside and outside; an axial approach opens the contact angle with them."""
    assert ANGULAR.constant == RollingBearing("ball", 14, 10e-3, 60e-3, ANGULAR.contact_angle, (0.52, 0.52)).constant
    apart, angle, axial = 0.04 * 10e-3, math.radians(25), 30e-6
    length = math.hypot(apart * math.cos(angle), apart * math.sin(angle) + axial)
    load = 14 * ANGULAR.constant * (length - apart) ** 1.5
    force = ANGULAR.reaction(np.array([0, 0, axial, 0, 0]))[0][2]
    assert force == pytest.approx(load * (apart * math.sin(angle) + axial) / length, rel=1e-12)


def test_a_shaft_on_two_tapered_bearings_and_one_on_balls_with_clearance_balance():
    shaft = Shaft((Section(0.3, 0.045),))
    mirrored = RollingBearing("roller", 18, 9e-3, 60e-3, contact_angle=math.radians(14), roller_length=14e-3)
    load = np.array([[2000.0, -6000, 1200, 0, 30, 0]])
    for left, right in ((TAPERED, mirrored), (BALL, BALL)):
        held = LoadedShaft(shaft, (Seat(left, 0.02), Seat(right, 0.28)), np.array([0.12]), load)
        found = deflect((held,))[0]
        assert found.balance.max() < 1e-9
        for seat, u, force in zip(held.seats, found.rings, found.bearing_forces, strict=True):
            assert seat.bearing.reaction(u)[0] == pytest.approx(-force, abs=1e-6 * 6000)


def test_basic_rating_lives():
    """ISO 281: C/P = 10 is 1000 million revolutions of balls; a radial load alone below e, X and Y above."""
    plain = LifeRating(33.2e3, "ball", 0.56, 1.6, 0.27)
    assert plain.revolutions(3320.0, 0.0) == pytest.approx(1e9, rel=1e-12)
    assert plain.equivalent_load(4000.0, 1000.0) == 4000.0
    assert plain.equivalent_load(4000.0, -2000.0) == pytest.approx(0.56 * 4000 + 1.6 * 2000)
    assert LifeRating(1e5, "roller").revolutions(2e4, 0.0) == pytest.approx(1e6 * 5 ** (10 / 3), rel=1e-12)
    assert plain.revolutions(0.0, 0.0) == math.inf
    assert LifeRating(1e4).equivalent_load(300.0, 700.0) == 300.0  # without factors the radial load alone


@pytest.mark.parametrize("angle", [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0])
def test_equivalent_loads_of_balls_have_no_step(angle):
    """ISO 281, Table 3: X F_r + Y F_a is F_r where F_a = e F_r, within the digits of e and Y; e rises with the load."""
    factors, last = AxialFactors(True, math.radians(angle), 9 * 12.7e-3**2), 0.0
    for axial in np.geomspace(1.0, 2e4, 40):
        x, y, e = factors.at(axial)
        assert x + y * e == pytest.approx(1.0, abs=0.011)
        assert e >= last
        last = e
    assert factors.at(1.0)[1] >= factors.at(2e4)[1] >= 0.5


def test_axial_factors_by_hand():
    """A 6308 of C_0 = 25 kN, f_0 = 13.2, under 1330 N: f_0 F_a/C_0 = 0.702, between rows 0.689 and 1.03 of Table 3."""
    area = 25e3 / 13.2 * 1e-6  # Z D_w^2 [m^2]
    x, y, e = AxialFactors(True, 0.0, area).at(1330.0)
    share = (13.2 * 1330.0 / 25e3 - 0.689) / (1.03 - 0.689)
    assert (x, y, e) == pytest.approx((0.56, 1.71 - 0.16 * share, 0.26 + 0.02 * share), rel=1e-12)
    rated = LifeRating(42.5e3, "ball", axial=AxialFactors(True, 0.0, area))
    assert rated.equivalent_load(1724.0, -1330.0) == pytest.approx(0.56 * 1724.0 + y * 1330.0, rel=1e-12)
    assert rated.equivalent_load(1724.0, 200.0) == 1724.0
    rollers = AxialFactors(False, math.radians(14.0), math.nan).at(500.0)
    assert rollers == pytest.approx((0.4, 0.4 / math.tan(math.radians(14.0)), 1.5 * math.tan(math.radians(14.0))))
    assert LifeRating(3e4, "roller", axial=AxialFactors(False, 0.0, 1e-3)).equivalent_load(300.0, 700.0) == 300.0


def test_an_axial_force_without_factors_is_overlooked():
    """Which the results say; not of forces below e of every bearing, nor with factors."""
    assert LifeRating(1e4).overlooks(300.0, -700.0)
    assert not LifeRating(1e4).overlooks(300.0, 50.0)
    assert not LifeRating(1e4, "ball", 0.56, 1.6, 0.27).overlooks(300.0, 700.0)
    assert not LifeRating(1e4, axial=AxialFactors(True, 0.0, 1e-3)).overlooks(300.0, 700.0)
    assert LifeRating(1e4, "roller", axial=AxialFactors(False, 0.0, 1e-3)).overlooks(300.0, 700.0)


def test_elements_that_do_not_fit_are_refused():
    with pytest.raises(RangeError, match=r"is too large: 30 elements on the pitch diameter have 6\.79"):
        RollingBearing("ball", 30, 12.7e-3, 65e-3)
    with pytest.raises(RangeError, match="groove radius larger than ball radius"):
        RollingBearing("ball", 9, 12.7e-3, 65e-3, groove_ratio=(0.5, 0.52))
