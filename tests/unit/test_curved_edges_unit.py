"""How near cubic edges lie to circles, and how many edges a bore has."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.fem.plane.boundary import Chain
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.tooth_meshing import _bends, mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack


def edges(curve, tangent, count):
    """A chain along a curve from 0 to 1."""
    at = np.linspace(0.0, 1.0, 2 * count + 1)
    direction = tangent(at[::2])
    return Chain("fillet", curve(at[::2]), curve(at[1::2]), direction / np.hypot(*direction))


def cubic(chain):
    """Points of every edge's cubic, shape (2, edges, points)."""
    bends, chord, s = _bends(chain), np.diff(chain.vertices), np.linspace(0.0, 1.0, 101)
    start, first, second = (one[:, :, None] for one in (chain.vertices[:, :-1], bends[:, 0], bends[:, 1]))
    return start + s * chord[:, :, None] + s * (1.0 - s) * ((1.0 - s) * first + s * second)


def test_edges_of_a_circle_miss_it_by_the_sixth_power_of_their_angle():
    """By the fourth power over 384 with tangents as long as the arc: 4e-5 of the radius for one of 0.35 rad."""

    def circle(t):
        return np.stack([np.sin(0.7 * t), np.cos(0.7 * t)])

    def along(t):
        return np.stack([np.cos(0.7 * t), -np.sin(0.7 * t)])

    off = [np.abs(np.hypot(*cubic(edges(circle, along, count))) - 1.0).max() for count in (1, 2, 4)]
    assert np.log2(np.divide(off[:-1], off[1:])) == pytest.approx([6.0, 6.0], abs=0.05)
    assert off[1] < 0.35**6 / 20000.0


def test_edges_of_curves_that_turn_back_are_no_worse_for_it():
    def wave(t):
        return np.stack([t, 0.1 * np.sin(2.0 * np.pi * t)])

    def along(t):
        return np.stack([np.ones_like(t), 0.2 * np.pi * np.cos(2.0 * np.pi * t)])

    def off(count):
        found = cubic(edges(wave, along, count))
        return np.abs(found[1] - 0.1 * np.sin(2.0 * np.pi * found[0])).max()

    assert off(14) < 1.2e-5  # 2.6e-5 with tangents as long as the arc
    assert np.log2(off(14) / off(28)) > 3.8


THIN = Gear(
    Tooth(48, BasicRack(1.2, 1.413, 0.1506, math.radians(25.0)), -0.192), 3e-3, 56.44e-3, 0.02
)  # fmt: skip


def test_a_bore_below_a_thin_rim_has_two_edges():
    """With one the next tooth of this gear was 1.5e-5 of the largest off at a tolerance of 0.001, with two 1e-7."""
    coarse, fine = settings_at(-2.0), replace(settings_at(0.0), rim_fraction=0.1)
    bore = THIN.bore_radius / THIN.module
    assert mesh_sector(THIN.tooth, bore, coarse).edges["bore"].shape[1] == 2
    assert mesh_sector(THIN.tooth, 0.4 * bore, coarse).edges["bore"].shape[1] == 1
    known, truth = (solve_gear(THIN, one, estimate_error=False).fine for one in (coarse, fine))
    r = np.linspace(known.flank.lowest_radius * 1.0001, known.flank.highest_radius * 0.9999, 9)
    found, exact = (np.diagonal(one.neighbour(1, r, r, 0.15)) for one in (known, truth))
    assert np.abs(found - exact).max() < 1e-6 * exact.max()
