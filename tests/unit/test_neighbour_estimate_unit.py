"""Loads far away as mixtures of pressures, and what is taken for the error of neighbours' deflections."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.flank_samples import SAMPLES
from fegear.fem.plane.influence import _REMOTE_PARTS, _REMOTE_WIDTHS
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

#: Longest edges at tolerances of 0.01 and 0.1, half-width of the wider pressure at both [modules].
EDGE, LONG_EDGE, WIDE = 0.26, 0.44, 0.36


def share(edge=EDGE, patch=WIDE, order=4):
    flank = SimpleNamespace(order=order, arc=np.linspace(0.0, 5.0 * edge, 6))
    return Estimate(SimpleNamespace(flank=flank), None, patch, 2.0 * patch)._neighbour_share


def test_the_shorter_the_edges_the_less_of_what_a_lower_order_changes_is_error():
    assert share(0.11, 0.255) == pytest.approx(0.102)
    assert share() == pytest.approx(0.144)
    assert share(LONG_EDGE) == pytest.approx(0.36)
    assert share(0.055, 0.18) == pytest.approx(0.1 * 0.72**2.5)
    assert share(0.055, 0.18, 3) == pytest.approx(0.5)


def held(rim, internal=True, order=4, support=None):
    """A gear whose outer circle lies so far beyond its root circle [modules]."""
    angle = np.linspace(0.0, 0.2, 5)
    return SimpleNamespace(
        flank=SimpleNamespace(order=order, arc=np.linspace(0.0, 5.0 * EDGE, 6)), support=support,
        tooth=SimpleNamespace(internal=internal, root_radius=20.0),
        mesh=SimpleNamespace(
            points=(20.0 + rim) * np.stack([np.sin(angle), np.cos(angle)]), edges={"bore": np.array([range(4)] * 3)}
        ),
    )  # fmt: skip


def test_on_a_ring_that_is_held_the_thinner_the_rim_the_less_of_the_order_is_error():
    """The rim gives way smoothly: of 68 rings 4.6 (0.01) and 8 times the true error was stated in the median."""
    parts = [Estimate(held(rim), None, WIDE, 2.0 * WIDE)._share_of_rim for rim in (0.5, 1.0, 3.0, 6.0, 7.0, 12.0)]
    assert np.array(parts[:4]) / parts[1] == pytest.approx([0.5, 1.0, 3.0, 6.0], rel=1e-9)
    assert parts[4:] == [1.0, 1.0]
    assert 0.9 < parts[3] < 1.0
    for other in ({"internal": False}, {"order": 3}, {"support": "pins"}):  # of which nobody measured it
        assert Estimate(held(2.0, **other), None, WIDE, 2.0 * WIDE)._share_of_rim == 1.0
    # where edges are few half of what the order changed was true on a thin rim
    assert Estimate(held(2.0), None, 0.9 * EDGE, 2.0 * EDGE)._share_of_rim == 1.0


def test_where_both_solutions_agree_by_chance_the_error_is_what_they_usually_differ_by():
    flank = SimpleNamespace(order=4, arc=np.linspace(0.0, 5.0 * EDGE, 6))
    known = Estimate(SimpleNamespace(flank=flank, reach=0), None, WIDE, 2.0 * WIDE)
    samples = np.linspace(10.0, 12.0, SAMPLES)
    usual = {1: np.full((SAMPLES, SAMPLES), 2.0)}
    known.__dict__.update(_samples=samples, common_errors=(0.0, 0.5), _least_beside=0.0, _neighbours=usual)
    off = np.array([[0.0, 3.0], [1.0, 7.0]])
    object.__setattr__(known, "_neighbour_difference", lambda *_asked: (off, off))
    _, error = known.neighbour(1, samples[[0, -1]], samples[[0, -1]])
    assert error == pytest.approx(np.array([[2.5, 3.5], [2.5, 7.5]]))


@pytest.mark.parametrize(
    ("internal", "order", "expected"),
    [(False, 4, [3.0, 6.0, 9.0]), (True, 4, [3.0, 0.0, 3.0]), (False, 3, [3.0, 0.0, 3.0])],
    ids=["external", "ring", "third order"],
)
def test_on_external_gears_two_differences_that_cancel_count_each(internal, order, expected):
    """Both orders differ by 3 at the start of the flank, by 0 in its middle and by -3 at its end."""
    samples = np.linspace(10.0, 12.0, SAMPLES)
    falling = SimpleNamespace(neighbour=lambda _k, p, q, *_width: 1.5 * (11.0 - p[:, None]) + 1.5 * (11.0 - q))
    none = held(12.0, internal, order)
    none.neighbour = lambda _k, p, q, *_width: np.zeros((p.size, q.size))
    known = Estimate(none, falling, WIDE, 2.0 * WIDE)
    known.__dict__.update(_samples=samples, _turned=0.0)
    object.__setattr__(known, "_of_edges", lambda *_asked: 0.0)
    at = samples[[0, SAMPLES // 2, -1]]
    _, difference = known._neighbour_difference(1, at, at)
    share = 0.144 if order == 4 else 0.5
    assert np.diagonal(difference) == pytest.approx(share * np.array(expected))


def test_a_mixture_of_pressures_is_a_concentrated_load_up_to_its_sixth_moment():
    """Semi-elliptic pressures by Gauss's rule: on a half-plane two mixtures move each other like two points.

    The mean of the logarithm of the distance, which the pressures' own moments say nothing of. A pressure by itself is
    off by a / distance squared.
    """
    angle = np.pi * np.arange(1, 41) / 41.0
    place, weight = np.cos(angle), np.sin(angle) ** 2 / np.sum(np.sin(angle) ** 2)
    x = np.outer(_REMOTE_WIDTHS, place).ravel()
    load = np.outer(_REMOTE_PARTS, weight).ravel()
    assert [load @ x**k for k in (0, 2, 4)] == pytest.approx([1.0, 0.0, 0.0], abs=1e-15)
    away = np.array([4.0, 8.0, 16.0])
    off = np.array([load @ np.log(np.abs(far + x[:, None] - x)) @ load - np.log(far) for far in away])
    single = np.array([weight @ np.log(np.abs(far + place[:, None] - place)) @ weight - np.log(far) for far in away])
    assert np.log2(off[:-1] / off[1:]) == pytest.approx([6.0, 6.0], abs=0.2)
    assert np.log2(single[:-1] / single[1:]) == pytest.approx([2.0, 2.0], abs=0.1)
    assert np.abs(off).max() < 1e-4 * np.abs(single).max()


@pytest.fixture(scope="module")
def gear():
    return Gear(Tooth(24, BasicRack(1.0, 1.25, 0.25), 0.1), 3e-3, 20e-3, 2e-2)


def test_the_width_of_pressures_moves_neighbours_by_its_sixth_power(gear):
    """Two pressures without a second moment: by the fourth, and 60 times as far."""
    known = solve_gear(gear, settings_at(-1.0), estimate_error=False).fine
    # Where pressures are as wide as they are asked for, and so wide that they rise above the elements' own scatter.
    room = 0.5
    arc = np.linspace(known.flank.flank_start + room, known.flank.flank_end - room, 9)
    r = known.flank.radius_of_arc(arc)
    found = np.array([np.diagonal(known.neighbour(1, r, r, width)) for width in (0.5, 0.25, 0.05)])
    off = np.abs(found - found[-1]).max(axis=1)
    assert np.log2(off[0] / off[1]) > 5.5
    assert off[0] < 2e-6 * np.abs(found[-1]).max()
