"""A pair in motion: wherever it is turned to, both flanks pass through where the contact is said to be."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.gear.drawing import moving_pair


def turned(points, angle, centre):
    """Clockwise about a point of the centre line."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = points[0], points[1] - centre
    return np.stack([c * x + s * y, c * y - s * x + centre])


def distance(point, line):
    """From a point to a line of chords."""
    a, b = line[:, :-1], line[:, 1:]
    chord = b - a
    share = np.clip(np.sum((point[:, None] - a) * chord, axis=0) / np.maximum(np.sum(chord**2, axis=0), 1e-300), 0, 1)
    return float(np.hypot(*(a + share * chord - point[:, None])).min())


@pytest.mark.parametrize(
    ("teeth", "shifts", "distance_factor"),
    [((23, 57), (0.3, -0.1), 1.0), ((17, 17), (0.2, 0.2), 1.003), ((40, 19), (0.0, 0.5), 1.0)],
)
def test_both_flanks_pass_through_every_contact_at_every_position(teeth, shifts, distance_factor):
    m = 3e-3
    gears = [
        Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25), profile_shift=x), m, 5e-3) for z, x in zip(teeth, shifts, strict=True)
    ]
    free = GearPair(*gears)
    pair = GearPair(*gears, free.centre_distance * distance_factor)
    found = moving_pair(pair)
    assert found.driver_radius + found.driven_radius == pytest.approx(pair.centre_distance, rel=1e-14)
    assert found.driver_radius / found.driven_radius == pytest.approx(teeth[0] / teeth[1], rel=1e-14)
    direction = np.array([math.cos(found.pressure_angle), math.sin(found.pressure_angle)])
    for first in np.linspace(found.start, found.start + found.base_pitch, 9):
        driver = turned(found.driver, first / found.driver_base, -found.driver_radius)
        driven = turned(found.driven, -first / found.driven_base, found.driven_radius)
        for x in (first, first + found.base_pitch):
            if not found.start < x < found.end:
                continue
            for line in (driver, driven):  # chords stay within a thousandth of a module of the flank
                assert distance(x * direction, line) < 1.1e-3 * m
