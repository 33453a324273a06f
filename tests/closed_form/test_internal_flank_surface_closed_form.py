"""Flanks of internal pairs: rigid bodies, Blok's formula against the geometry factor, and the rack as limit."""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.formulas.flank_speeds import flank_speeds
from fegear.formulas.flash_temperature import flash_temperature
from fegear.formulas.friction import Surface
from fegear.formulas.iso6336 import part20_flash, part21_integral, part22_micropitting
from fegear.formulas.iso6336.rated import LoadFactors, RatedSurface
from fegear.formulas.lubricant import Oil

OIL = Surface(Oil(220e-6, 19e-6), 70.0, 0.5e-6)
PINION = {"teeth": 23, "module": "4 mm", "profile_shift": 0.3, "face_width": "40 mm"}
RING = {"internal": True, "module": "4 mm", "face_width": "40 mm", "rim_thickness": "20 mm"}
CUTTER = {"teeth": 25, "addendum": 1.25, "tip_radius": 0.2}


def wheel(teeth, shift, *, internal):
    """A ring with cut tips, or a wheel."""
    if internal:
        tip = f"{4.0 * (teeth - 2.0 * (shift + 0.5))} mm"
        return RING | {"teeth": teeth, "profile_shift": shift, "cutter": CUTTER, "tip_diameter": tip}
    tip = f"{4.0 * (teeth + 2.0 * (shift + 0.5))} mm"
    return {"teeth": teeth, "module": "4 mm", "profile_shift": shift, "face_width": "40 mm", "tip_diameter": tip}


def pair_of(teeth, shift, *, internal, ring_drives=False):
    a, b = ("w", "p") if ring_drives else ("p", "w")
    gears = {"p": PINION, "w": wheel(teeth, shift, internal=internal)}
    asked = {"results": ["geometry"], "gear": gears, "pair": {"I": {"driver": a, "driven": b}}}
    return build_scene(asked, "rings", Path()).pairs["I"]


def rated_of(pair, speed=150.0):
    return RatedSurface(pair, speed, 12e3, LoadFactors(1.25, 1.1, 1.05, 1.0), OIL)


@pytest.mark.parametrize("ring_drives", [False, True])
def test_flanks_slide_as_rigid_bodies_do(ring_drives):
    """Velocities of both bodies at the contact along the flank's tangent, from how they turn about their centres."""
    pair = pair_of(60, -0.3, internal=True, ring_drives=ring_drives)
    x = np.linspace(pair.x_start, pair.x_end, 7)
    speed, a, angle = 150.0, pair.centre_distance, pair.working_pressure_angle
    planet_speed = speed * (60 / 23 if ring_drives else 1.0)
    # Planet's centre at 0, the ring's at -a e_y, the pitch point above; both turn clockwise and the planet pushes.
    pitch_point = np.array([0.0, pair.gear("driven" if ring_drives else "driver").base_radius / math.cos(angle)])
    along = np.array([math.cos(angle), -math.sin(angle)])
    toward_planet_tip = -along if abs(np.hypot(*(pitch_point + 1e-3 * along))) < np.hypot(*pitch_point) else along
    sign = -1.0 if ring_drives else 1.0  # x counts toward the driver's tip
    at = pitch_point + sign * x[:, None] * toward_planet_tip
    tangent = np.array([-along[1], along[0]])

    def slide(turning, centre):
        arm = at - centre
        return turning * (arm[:, 1] * tangent[0] - arm[:, 0] * tangent[1])  # clockwise

    planet, ring = slide(planet_speed, np.zeros(2)), slide(planet_speed * 23 / 60, np.array([0.0, -a]))
    found = flank_speeds(pair, x, speed)
    mine = (found.rolling_driven, found.rolling_driver) if ring_drives else (found.rolling_driver, found.rolling_driven)
    assert np.abs(planet) == pytest.approx(mine[0], rel=1e-12)
    assert np.abs(ring) == pytest.approx(mine[1], rel=1e-12)
    assert np.all(planet * ring > 0.0)  # through the contact the same way
    assert sign * found.sliding == pytest.approx(planet_speed * (1.0 - 23 / 60) * sign * x, abs=1e-12)
    assert found.relative_radius == pytest.approx(1.0 / (planet_speed / mine[0] - planet_speed * 23 / 60 / mine[1]))


@pytest.mark.parametrize(("teeth", "shift", "internal"), [(60, -0.3, True), (140, 0.1, True), (60, 0.0, False)])
def test_the_standards_geometry_factor_is_bloks_formula_at_the_pinions_tip(teeth, shift, internal):
    pair = pair_of(teeth, shift, internal=internal)
    rated = rated_of(pair)
    found = part21_integral.integral_temperature(rated)
    load = found.helical * rated.line_load
    blok = flash_temperature(rated.at(pair.x_end), load, found.friction, rated.modulus)
    assert found.at_tip * found.approach * found.relief == pytest.approx(float(blok), rel=5e-3)  # .51 x 1.22 for .62


def test_ring_and_wheel_meet_in_the_rack():
    """Of z and -z the mean is the rack's but for 1/z^2, and half their difference is of the order of 1/z."""

    def numbers(teeth, internal):
        pair = pair_of(teeth, -0.3, internal=internal)
        rated = rated_of(pair)
        x = np.linspace(-6e-3, 6e-3, 5)
        at, mu = rated.at(x), part20_flash.friction(rated)
        flash = flash_temperature(at, rated.line_load, mu, rated.modulus)
        film = part22_micropitting.film(
            OIL, at, part22_micropitting.pressure(at, rated.line_load, rated.modulus), mu, 90.0, rated.modulus
        )
        return np.concatenate([at.relative_radius, at.sum, flash[[0, 1, 3, 4]], film.thickness,
                               [mu, part22_micropitting.loss_factor(pair)]])  # fmt: skip

    mean, half = [], []
    for teeth in (400, 800):
        ring, other = numbers(teeth, internal=True), numbers(teeth, internal=False)
        mean.append(0.5 * (ring + other))
        half.append(0.5 * (ring - other))
    scale = np.abs(mean[1])
    assert np.all(np.abs(half[1]) < 0.1 * scale)
    assert np.all(np.abs(half[0] - 2.0 * half[1]) < 1e-3 * scale)
    assert np.all(np.abs(mean[0] - mean[1]) < 5e-3 * scale)


def test_a_ring_that_drives_is_as_hot():
    planet, ring = (rated_of(pair_of(60, -0.3, internal=True, ring_drives=d), 150.0 * (23 / 60 if d else 1.0))
                    for d in (False, True))  # fmt: skip
    x = np.linspace(planet.pair.x_start, planet.pair.x_end, 9)
    one, other = planet.at(x), ring.at(-x)
    heat = [flash_temperature(at, 3e5, 0.06, planet.modulus) for at in (one, other)]
    assert heat[0] == pytest.approx(heat[1], rel=1e-9)
    assert part22_micropitting.loss_factor(planet.pair) == pytest.approx(part22_micropitting.loss_factor(ring.pair))
    assert part21_integral.geometry_factor(-60 / 23, 20.0, -40.0) == pytest.approx(
        0.51 * math.sqrt(60 / 23 - 1.0) * (math.sqrt(20.0) - math.sqrt(40.0 * 23 / 60)) / 800.0**0.25
    )
