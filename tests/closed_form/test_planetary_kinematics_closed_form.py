"""Speeds, torques, efficiency, frequencies and assembly of planetary sets, worked out by hand or by counting."""

import math
from fractions import Fraction

import numpy as np
import pytest

from fegear.base.errors import FegearError, GeometryError, InputError
from fegear.dynamics.planetary.kinematics import passing, running, sidebands
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.verify.planetary_sets import unshifted

FOUND = unshifted(24, 30, 3)
RATIO = Fraction(84, 24)

#: Fixed, driving, and input over output speed as handbooks have them.
RATIOS = (
    ("ring", "sun", 1 + RATIO),
    ("ring", "carrier", 1 / (1 + RATIO)),
    ("carrier", "sun", -RATIO),
    ("carrier", "ring", -1 / RATIO),
    ("sun", "ring", 1 + 1 / RATIO),
    ("sun", "carrier", 1 / (1 + 1 / RATIO)),
)


@pytest.mark.parametrize(("fixed", "driving", "ratio"), RATIOS)
@pytest.mark.parametrize("speed", [100.0, -37.0])
def test_ratio_torques_and_power_of_each_arrangement(fixed, driving, ratio, speed):
    run = running(FOUND, fixed, driving, speed, 50.0, 0.98)
    assert run.ratio == pytest.approx(float(ratio), rel=1e-14)
    assert run.speed[fixed] == 0.0
    assert abs(24 * run.speed["sun"] + 84 * run.speed["ring"] - 108 * run.speed["carrier"]) < 1e-10
    assert abs(sum(run.torque.values())) < 1e-10
    assert run.torque[driving] * speed == pytest.approx(50.0 * abs(speed))
    # the mesh loses 2 % of the power that rolls: with the carrier at rest, of all of it
    turns = {name: run.speed[name] - run.speed["carrier"] for name in ("sun", "ring")}
    rolling = sorted(run.torque[name] * turns[name] for name in ("sun", "ring"))
    assert -rolling[0] == pytest.approx(0.98 * rolling[1], rel=1e-12)
    lost = sum(run.torque[name] * run.speed[name] for name in CENTRALS)
    assert lost == pytest.approx(0.02 * rolling[1], rel=1e-9)
    assert run.efficiency == pytest.approx(1.0 - lost / (50.0 * abs(speed)), rel=1e-12)


def test_efficiency_of_the_usual_set_is_the_handbook_formula():
    """(1 + i0 eta0) / (1 + i0) with the ring fixed and the sun driving."""
    run = running(FOUND, "ring", "sun", 10.0, 1.0, 0.97)
    assert run.efficiency == pytest.approx((1.0 + 3.5 * 0.97) / 4.5, rel=1e-14)
    assert run.sun_drives
    assert not run.mirrored
    assert not running(FOUND, "sun", "ring", 10.0, 1.0).sun_drives
    assert running(FOUND, "ring", "sun", -10.0, 1.0).mirrored


def test_mesh_frequency_and_passings_by_counting():
    """One turn of the carrier against the ring: 84 teeth of the ring are met by every planet."""
    run = running(FOUND, "ring", "sun", 2.0 * math.pi * 4.5, 1.0)
    assert run.mesh_frequency == pytest.approx(84.0)
    rows = dict(zip(*(getattr(passing(FOUND, run), key) for key in ("what", "frequency")), strict=True))
    assert rows["passing frequency of a ring tooth (planets)"] == pytest.approx(3.0)
    assert rows["passing frequency of a sun tooth (planets)"] == pytest.approx(3.0 * 3.5)
    assert rows["rotation of a planet in the carrier"] == pytest.approx(84.0 / 30.0)
    assert rows["rotation of a planet"] == pytest.approx(84.0 / 30.0 - 1.0)


def test_sidebands_are_those_of_a_signal_that_is_added_up():
    """Each planet passes with a window of its own; the spectrum over one turn of the carrier."""
    angles = np.array([0, 31, 60, 85]) * 2.0 * math.pi / 107
    found = unshifted(25, 29, angles, ring=82, addendum=-14.0)
    run = running(found, "ring", "sun", 10.0, 1.0)
    t = np.arange(4096) / 4096  # turns of the carrier
    signal = np.zeros(t.size)
    for psi in angles:
        window = sum(np.cos(k * (2.0 * math.pi * t + psi)) for k in range(7))
        signal += window * np.cos(82 * (2.0 * math.pi * t + psi))
    spectrum = np.abs(np.fft.rfft(signal)) / t.size * 2.0
    alone = np.abs(np.fft.rfft(window * np.cos(82 * (2.0 * math.pi * t + psi)))) / t.size * 2.0
    rows = sidebands(found, run, 1, 6)
    assert np.allclose(rows.share, spectrum[rows.order] / alone[rows.order] / 4.0, atol=1e-9)
    even = sidebands(FOUND, running(FOUND, "ring", "sun", 10.0, 1.0), 2, 6)
    assert np.array_equal(even.share > 0.5, even.order % 3 == 0)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: unshifted(24, 30, 5), "108 / 5 = 21.6 is not an integer"),
        (lambda: unshifted(24, 30, 5), "use 4 planets, change a number of teeth by 2"),  # six would meet
        (lambda: unshifted(24, 30, 5, addendum=-15.0), "use 4 or 6 planets"),
        (lambda: unshifted(24, 30, 6), "adjacent planets interfere: tip circles overlap by 10 mm"),
        (lambda: unshifted(24, 30, np.radians([0.0, 121.0, 240.0])), "use 120 deg"),
        (lambda: unshifted(24, 30, np.radians([0.0, 240.0, 120.0])), "must be increasing within one revolution"),
        (lambda: unshifted(24, 30, 3, ring=92), "mm, for both lines of action to exist"),
        (lambda: unshifted(24, 30, 3, ring=29), "must have more teeth than the planet's 30"),
        (lambda: running(FOUND, "ring", "ring", 1.0, 1.0), "is fixed as well"),
        (lambda: running(FOUND, "ring", "sun", 0.0, 1.0), "must be finite and not zero"),
        (lambda: running(FOUND, "ring", "sun", 1.0, -1.0), "must be positive (acts in the direction of"),
        (lambda: running(FOUND, "ring", "sun", 1.0, 1.0, 1.1), "mesh_efficiency = 1.1: must be above 0 and at most 1"),
    ],
)
def test_what_cannot_be_is_refused_with_its_margin(make, said):
    with pytest.raises(FegearError) as caught:
        make()
    assert isinstance(caught.value, (GeometryError, InputError))
    assert said in str(caught.value)


def test_most_planets_that_are_named_do_fit():
    with pytest.raises(GeometryError, match="at most 4 equally spaced planets"):
        unshifted(24, 30, 6)
    assert unshifted(24, 30, 4).neighbour_clearance > 0.0
    assert unshifted(24, 30, 4).neighbour_clearance == pytest.approx(2 * 0.054 * math.sin(math.pi / 4) - 0.064)
