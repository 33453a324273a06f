"""Lengths of edges, places between positions and removals: laws that tests of whole gears do not see."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.surface import FlankSurface
from fegear.contact.wide.lines import SHORTEST_LINE, shortest_line
from fegear.design.tip_relief.extremes import Between, removed
from fegear.fem.plane import edge_sizes
from fegear.fem.plane.settings import settings_at
from fegear.geometry.curves import Arc, Stretched, arc_length
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

PLAIN, ROUNDED = Tooth(23, profile_shift=0.1), Tooth(23, profile_shift=0.1, tip_rounding=0.15)


# ---- edges of plane meshes -------------------------------------------------------------------------------------------
@pytest.mark.parametrize("growth", [0.0, 0.3, -0.2])
def test_nodes_follow_a_size_that_grows_along_the_way(growth):
    """Edges of a size a + g s have ends in geometric progression; as many as the integral of 1 / size."""
    first = 0.42 if growth < 0.0 else 0.02
    nodes = edge_sizes.graded(2.0, lambda s: first + growth * s)
    ends = first + growth * nodes
    count = math.log(ends[-1] / ends[0]) / growth if growth else 2.0 / first
    assert (nodes[0], nodes[-1]) == (0.0, 2.0)
    assert nodes.size - 1 == max(round(count), 1)
    if growth:
        np.testing.assert_allclose(np.diff(np.log(ends)), math.log(ends[-1] / ends[0]) / (nodes.size - 1), rtol=5e-3)
    else:
        np.testing.assert_allclose(np.diff(nodes), 2.0 / (nodes.size - 1), rtol=1e-9)
    assert edge_sizes.graded(2.0, lambda s: np.full(s.shape, 50.0), fewest=3) == pytest.approx([0.0, 2 / 3, 4 / 3, 2.0])
    uneven = 2.0 * np.linspace(0.0, 1.0, 4001) ** 3
    assert edge_sizes.graded(2.0, lambda s: 1e-4 + s, at=uneven).size == pytest.approx(math.log(2.0001 / 1e-4), abs=1.5)


@pytest.mark.parametrize("tooth", [PLAIN, ROUNDED, Tooth(60, BasicRack(1.0, 1.25, 0.1))])
@pytest.mark.parametrize("level", [0, 2])
def test_edges_of_neighbours_go_together_all_round_a_tooth(tooth, level):
    settings = settings_at(level)
    front, back = edge_sizes.front_sizes(tooth, settings), edge_sizes.back_sizes(tooth, settings)
    root, length = edge_sizes.fillet_size(tooth, settings), edge_sizes.length_of

    def at(law, s):
        return float(law(np.array([s]))[0])

    fillet, flank = length(tooth.fillet), length(tooth.involute)
    land = length(tooth.outline["tip_land"])
    # of the root land and the fillet, of fillet and flank, and in the middle of the tip of both sides
    assert at(edge_sizes.land_size(tooth, settings), tooth.root_land_length) == pytest.approx(at(root, 0.0))
    assert at(edge_sizes.land_size(tooth, settings), 0.0) == pytest.approx(
        at(root, 0.0) + settings.growth * tooth.root_land_length
    )
    assert at(front["fillet"], fillet) == pytest.approx(at(front["flank"], 0.0))
    assert at(front["fillet"], fillet) <= at(root, fillet)
    assert at(front["flank"], flank) == pytest.approx(settings.tip_edge_length)
    assert at(front["tip_edge"], 0.0) <= settings.tip_edge_length * (1.0 + 1e-12)
    # a rounding's short edges grow over the land behind it, too, on the back no less than they may
    rounding = at(back["tip_edge"], 0.5 * length(tooth.tip_edge)) if tooth.tip_edge else math.inf
    middle = min(at(front["tip_land"], land), rounding + settings.growth * land)
    assert at(back["tip_land"], land) == pytest.approx(middle)
    assert at(back["flank"], flank) == pytest.approx(at(back["tip_edge"], 0.0))
    edge = length(tooth.tip_edge) if tooth.tip_edge else 0.0
    assert at(back["tip_edge"], edge) == pytest.approx(at(back["tip_land"], 0.0))
    assert at(front["tip_land"], 0.0) >= at(front["tip_edge"], edge)
    if rounding < middle:
        assert at(back["tip_edge"], edge) == pytest.approx(rounding)
    assert at(back["flank"], 0.0) == pytest.approx(min(at(root, fillet), settings.back_edge_length))
    coarse = edge_sizes.front_sizes(tooth, replace(settings, junction_edge_length=1.5, flank_edge_length=1.5))
    assert at(coarse["flank"], 0.0) == pytest.approx(at(root, fillet))
    # neither on a fillet nor on a flank or behind it do edges grow faster than they may
    s = np.linspace(0.0, fillet, 400)
    assert np.abs(np.diff(root(s)) / np.diff(s)).max() <= settings.growth * (1.0 + 1e-6)
    s = np.linspace(0.0, flank, 400)
    assert np.abs(np.diff(back["flank"](s)) / np.diff(s)).max() <= settings.growth * (1.0 + 1e-6)
    assert np.abs(np.diff(front["flank"](s)) / np.diff(s)).max() <= settings.tip_growth * (1.0 + 1e-6)


@pytest.mark.parametrize("half", [0.3, 0.5])
def test_edges_on_a_fillet_are_as_short_as_the_sharpest_place_near_them_asks(half):
    """Of an ellipse, sharp at one end or in its middle: by all pairs of places."""
    settings = replace(settings_at(0), root_edge_length=0.2, growth=0.1)
    arc = Stretched(Arc((0.0, 0.0), 0.4, 0.5 * math.pi - half * 1.8, 0.5 * math.pi + (1.0 - half) * 1.8), 3.0)
    tooth = SimpleNamespace(fillet=arc)
    parameter, s = arc_length(arc)
    wanted = np.minimum(settings.root_fraction / np.abs(arc.curvatures(parameter)), settings.root_edge_length)
    by_pairs = (wanted + settings.growth * np.abs(s[:, None] - s)).min(axis=1)
    assert (by_pairs < 0.9 * wanted).any()
    np.testing.assert_allclose(edge_sizes.fillet_size(tooth, settings)(s), by_pairs, rtol=1e-9)


def test_edges_below_a_pressure_resolve_its_half_width_and_grow_away_from_it():
    settings = settings_at(-4)
    place, half = 0.5 * edge_sizes.length_of(PLAIN.involute), 0.002
    pressed = edge_sizes.front_sizes(PLAIN, settings, [(place, half)])["flank"]
    near = pressed(place + half * np.array([-1.19, 0.0, 1.19]))
    assert near == pytest.approx(np.full(3, near[1]))
    assert 0.2 * half < near[1] < 0.5 * half
    off = 1.2 * half + np.array([0.01, 0.02])
    for way in (1.0, -1.0):
        assert np.diff(pressed(place + way * off)) == pytest.approx([0.01 * settings.growth])
    usual = edge_sizes.front_sizes(PLAIN, settings)["flank"]
    ends = np.array([0.0, 2.0 * place])
    assert pressed(ends) == pytest.approx(usual(ends))


def test_edges_on_a_rounded_tip_turn_a_little_and_are_not_longer_than_their_neighbours():
    settings = settings_at(0)
    for radius in (0.02, 0.1, 0.2):
        tooth = Tooth(23, profile_shift=0.1, tip_rounding=radius)
        longest = float(edge_sizes.front_sizes(tooth, settings)["tip_edge"](np.array([10.0]))[0])
        assert settings.tip_edge_length <= longest <= 0.5 * settings.flank_edge_length
        assert longest <= max(0.25 * radius, settings.tip_edge_length)
        assert longest > 0.15 * min(radius, 0.5 * settings.flank_edge_length)
    assert edge_sizes._longest_on_rounding(PLAIN, settings, 0.7) == 0.7


def test_short_fillets_have_more_edges_the_finer_the_level():
    short, usual = (SimpleNamespace(fillet=Arc((0.0, 0.0), radius, 0.0, 1.2)) for radius in (0.08, 0.084))
    assert edge_sizes.length_of(short.fillet) < edge_sizes.SHORT_FILLET < edge_sizes.length_of(usual.fillet)
    levels = [edge_sizes.fewest_edges(short, settings_at(level)) for level in (-6, 0, 2, 4)]
    assert {edge_sizes.fewest_edges(usual, settings_at(level)) for level in (-6, 4)} == {min(levels)}
    assert levels == sorted(levels)
    assert levels[3] == pytest.approx(2.0 * levels[1], abs=1.0)  # a quarter of the fraction, by its root


# ---- contact and design ----------------------------------------------------------------------------------------------
def test_the_shortest_line_is_a_part_of_a_module_or_half_of_a_narrow_face():
    for width in (1e-9, 1e-5, 0.02, 3.0):
        pair = SimpleNamespace(driver=SimpleNamespace(module=2e-3), face_width=width)
        assert shortest_line(pair) == pytest.approx(min(SHORTEST_LINE * 2e-3, width / 2.0), rel=1e-12)


def test_the_place_of_a_value_is_that_of_its_column_and_row():
    rng = np.random.default_rng(1)
    values = rng.permutation(12).reshape(3, 4).astype(float)
    values[values == 11.0] = np.nan
    nothing = np.zeros((3, 4))
    x, z = np.array([1.0, 2.0, 4.0, 8.0]), np.array([10.0, 30.0, 50.0])
    found = FlankSurface(x, z, *[nothing] * 4, values, nothing, values + 0.5, 3.0, 0.0, 0.0)
    for wanted, least in ((10.0, False), (0.0, True)):
        (row,), (column,) = np.nonzero(values == wanted)
        assert found.place(values, least=least) == (x[column], z[row])
    assert (found.largest, found.least_ratio) == (10.0, 0.5)
    cold = FlankSurface(x, z, *[nothing] * 4, values, nothing, values, 37.0, 0.0, 0.0)
    assert cold.largest == 37.0


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_removal_is_that_of_both_tips_and_grows_with_the_numbers_as_its_differences_say(power):
    rng = np.random.default_rng(3)
    depths = rng.uniform(0.0, 6e-3, (2, 5, 7))
    p = np.array([12e-6, 3e-3, 20e-6, 4.5e-3])
    found, slopes = removed(depths, p[:, None, None], power)
    by_hand = sum(
        amount * np.clip(1.0 - depth / length, 0.0, None) ** power
        for depth, amount, length in zip(depths, p[::2], p[1::2], strict=True)
    )
    np.testing.assert_allclose(found, by_hand, atol=1e-18)
    assert (by_hand == 0.0).any()
    for k, step in enumerate(1e-6 * p):
        more, less = (removed(depths, (p + way * step * np.eye(4)[k])[:, None, None], power)[0] for way in (1, -1))
        np.testing.assert_allclose(slopes[k], (more - less) / (2.0 * step), atol=1e-9 * np.abs(slopes[k]).max())


def between(x, known, breaks=(), whole=None):
    whole = np.ones(x.size - 1, dtype=bool) if whole is None else whole
    positions = SimpleNamespace(x=x, whole=whole)
    made = SimpleNamespace(
        bench=SimpleNamespace(points=SimpleNamespace(breaks=np.array(breaks))), positions=positions, _known=known
    )
    made._first = Between._first.func(made)
    return made


def test_between_four_positions_cubics_are_exact_with_their_slopes():
    x = np.sort(np.random.default_rng(4).uniform(0.0, 3.0, 12))
    cubics = [np.polynomial.Polynomial(c) for c in ([1.0, -2.0, 0.5, 0.3], [0.0, 1.0, 0.0, -1.0], [4.0])]
    made = between(x, np.stack([one(x) for one in cubics]))
    cell = np.arange(11)
    at = 0.3 * x[:-1] + 0.7 * x[1:]
    value, slope = Between._interpolated(made, SimpleNamespace(x=at, where=(None, cell, None)))
    np.testing.assert_allclose(value, [one(at) for one in cubics], atol=1e-11)
    np.testing.assert_allclose(slope, [one.deriv()(at) * np.ones(11) for one in cubics], atol=1e-9)
    # the four are those about the cell, as many before as after it, but at the ends
    assert made._first.tolist() == [0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 8]


def test_cubics_do_not_reach_over_breaks_or_over_what_is_not_whole():
    x = np.arange(14.0)
    assert between(x, None, breaks=[4.5])._first.tolist() == [0, 0, 1, 1, -1, 5, 5, 6, 7, 8, 9, 10, 10]
    assert between(x, None, breaks=[3.5])._first.tolist() == [0, 0, 0, -1, 4, 4, 5, 6, 7, 8, 9, 10, 10]
    whole = np.ones(13, dtype=bool)
    whole[2] = False  # three positions are too few
    assert between(x, None, whole=whole)._first.tolist() == [-1, -1, -1, 3, 3, 4, 5, 6, 7, 8, 9, 10, 10]
