"""Tables of designed flanks by geometry only: nodes, roll positions, weights, thin plates through known surfaces."""

import math

import numpy as np
import pytest

from fegear.contact.wide.lines import base_twist
from fegear.design.flanks.topography import (
    FlankLoading,
    StationRelief,
    design_force,
    design_lines,
    lines_at,
    table_nodes,
    tabulated,
    topography,
)
from fegear.design.loading import LoadingFunction, Ramp
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE, WIDTH = 3e-3, 9e-3


def pair_of(beta):
    hands = ("right", "left") if beta else ("spur", "spur")
    gears = []
    for hand in hands:
        tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
        gears.append(Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, Material(206e9, 0.3), "strain", hand))
    return GearPair(*gears)


def share_of(pair, ends=0.0):
    middle = 0.5 * (pair.x_start + pair.x_end)
    return FlankLoading(LoadingFunction(pair.path_length, pair.base_pitch, middle, Ramp(0.5)), WIDTH, ends)


def found_on(lines, surface):
    none = np.zeros(lines.x.shape)
    return StationRelief(lines, none, np.where(lines.present, surface(lines.x, lines.z), 0.0), none)


@pytest.mark.parametrize("beta", [0.0, 15.0])
def test_nodes_run_from_end_to_end_as_dense_as_the_stations(beta):
    pair = pair_of(beta)
    panel = WIDTH / 6.0
    lines = design_lines(pair, share_of(pair), 12, panel)
    x, z = table_nodes(found_on(lines, lambda x, z: 0.0 * x), pair)
    assert (x[0], x[-1]) == (pytest.approx(pair.x_start), pytest.approx(pair.x_end))
    assert (np.diff(x) > 0.0).all()
    np.testing.assert_allclose(z, np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, z.size))
    assert z.size == max(4, round(WIDTH / float(lines.panel.max()))) + 1
    if beta:
        count = max(8, round(lines.roll.size * pair.contact_ratio))
        np.testing.assert_allclose(x, np.linspace(pair.x_start, pair.x_end, count + 1))
    else:  # of a spur pair the stations themselves, and the ends of the path
        inside = np.unique(lines.x[lines.present])
        inside = inside[(inside > pair.x_start) & (inside < pair.x_end)]
        assert inside.size > 10
        np.testing.assert_allclose(x, np.concatenate([[pair.x_start], inside, [pair.x_end]]))


def test_each_line_stands_for_half_of_the_way_to_its_neighbours():
    pair = pair_of(15.0)
    roll = pair.x_start + pair.base_pitch * np.array([0.1, 0.2, 0.5, 0.9])
    lines = lines_at(pair, roll, WIDTH / 6.0)
    np.testing.assert_allclose(lines.roll, roll)
    np.testing.assert_allclose(lines.weight, [0.15, 0.2, 0.35, 0.3])


def test_the_design_load_is_on_the_stations_at_every_roll_position():
    pair = pair_of(15.0)
    share = share_of(pair, 2e-3)
    lines = design_lines(pair, share, 12, WIDTH / 30.0)
    force = design_force(lines, share, 2500.0)
    np.testing.assert_allclose(force.sum(axis=1), 2500.0)
    assert (force[~lines.present] == 0.0).all()
    wanted = 2500.0 * share.line_load(lines.x, lines.z) * lines.support
    strong = lines.present & (force > 0.05 * force.max())
    np.testing.assert_allclose(force[strong], wanted[strong], rtol=0.02)
    # Over the face: even in the middle, nothing at the ends, the whole load in all.
    z = np.linspace(-0.5, 0.5, 20_001) * WIDTH
    over = share.over_face(z)
    assert np.trapezoid(over, z) == pytest.approx(1.0, rel=1e-6)
    assert over[0] == pytest.approx(0.0, abs=1e-9)
    assert over[10_000] == pytest.approx(1.0 / (WIDTH - 2e-3))
    assert share.over_face([0.5 * WIDTH - 1e-3])[0] == pytest.approx(0.5 / (WIDTH - 2e-3))
    assert share.over_face([0.6 * WIDTH])[0] == 0.0
    even = share_of(pair)
    np.testing.assert_allclose(even.over_face([0.0, 0.5 * WIDTH, 0.51 * WIDTH]), [1.0 / WIDTH, 1.0 / WIDTH, 0.0])
    assert share.face_load_factor == pytest.approx(WIDTH / (WIDTH - 2e-3))


@pytest.mark.parametrize("beta", [0.0, 15.0])
def test_plates_through_stations_of_a_smooth_surface_are_that_surface(beta):
    """A plane exactly, a bent one nearly; the least is zero."""
    pair = pair_of(beta)
    lines = design_lines(pair, share_of(pair), 16, WIDTH / 12.0)
    half, path = 0.5 * WIDTH, 0.5 * pair.path_length
    middle = 0.5 * (pair.x_start + pair.x_end)

    def plane(x, z):
        return 5e-6 * (x - middle) / path + 3e-6 * z / half

    def bent(x, z):
        return plane(x, z) + 4e-6 * ((x - middle) / path) ** 2 + 2e-6 * (z / half) ** 2

    for surface, off in ((plane, 1e-9), (bent, 0.15e-6)):
        found = found_on(lines, surface)
        x, z = table_nodes(found, pair)
        removal = tabulated(found, pair, x, z)
        wanted = surface(*np.meshgrid(x, z, indexing="ij"))
        assert removal.min() == 0.0
        inner = np.s_[1:-1, 1:-1]
        offset = np.median((removal - wanted)[inner])
        np.testing.assert_allclose((removal - wanted)[inner], offset, atol=off)
        for member, sign in (("driver", 1.0), ("driven", -1.0)):
            table = topography(pair, member, x, z, removal)
            roll = pair.roll_angle(x, member)
            assert (np.diff(roll) * sign > 0.0).all()
            height = z[3] + pair.face_height(member)
            np.testing.assert_allclose(table.removal(roll, np.full(roll.size, height)), removal[:, 3], atol=1e-12)
    assert base_twist(pair) == pytest.approx(0.0) or beta
