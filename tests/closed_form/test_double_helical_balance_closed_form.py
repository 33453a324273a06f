"""Shares of two halves of opposite hand: linear halves by hand, curved ones by a scalar root, limits and exchange."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.base.errors import InputError
from fegear.contact.double_helical import load_double
from fegear.contact.double_helical.balance import AxialSeat, balance

TWIST = (0.3, -0.3)


@dataclass(frozen=True)
class Bar:
    """A half of constant stiffness behind a gap."""

    stiffness: np.ndarray
    gap: np.ndarray

    @property
    def touch(self):
        return self.gap

    def under(self, load):
        return self.gap + load / self.stiffness, np.broadcast_to(self.stiffness, load.shape)


@dataclass(frozen=True)
class Curved:
    """zeta = gap + (W / a)^n, as of contacts that widen with their load."""

    a: np.ndarray
    n: np.ndarray
    gap: np.ndarray

    @property
    def touch(self):
        return self.gap

    def under(self, load):
        zeta = (load / self.a) ** self.n
        return self.gap + zeta, load / (self.n * zeta)


def bar(stiffness, gap=0.0):
    return Bar(np.array([[stiffness]]), np.array([[gap]]))


def test_without_float_the_halves_share_by_their_stiffness_and_gap():
    """W = k_1 zeta + k_2 (zeta - g): by hand, both in contact."""
    found = balance(bar(4e8), bar(1e8, 3e-6), [1000.0, 9000.0], AxialSeat(TWIST, room=0.0))
    zeta = (np.array([1000.0, 9000.0]) + 1e8 * 3e-6) / 5e8
    assert found.approach[0] == pytest.approx([1000.0 / 4e8, zeta[1]], rel=1e-12)
    assert found.share[0] == pytest.approx([1.0, 4e8 * zeta[1] / 9000.0], rel=1e-12)
    assert found.separation[1, 0] == pytest.approx([3e-6 - 1000.0 / 4e8, 0.0], rel=1e-9)
    assert found.stiffness[0] == pytest.approx([4e8, 5e8])


@pytest.mark.parametrize("k", [(4e8, 4e8), (6e8, 2e8)])
def test_an_apex_error_is_taken_by_uneven_load_until_one_half_carries_all(k):
    """W_1 = (k_1 W + k_1 k_2 (t_1 - t_2) q) / (k_1 + k_2), all of W from (t_1 - t_2) q = W / k_1 on."""
    load, span = 5000.0, TWIST[0] - TWIST[1]
    all_on_first = load / k[0] / span
    for part in (-1.5, -0.2, 0.0, 0.4, 1.0 - 1e-9, 1.0 + 1e-9, 3.0):
        q = part * all_on_first
        found = balance(bar(k[0]), bar(k[1]), load, AxialSeat(TWIST, offset=q, room=0.0))
        by_hand = (k[0] * load + k[0] * k[1] * span * q) / (k[0] + k[1]) / load
        assert found.share.item() == pytest.approx(min(max(by_hand, 0.0), 1.0), abs=1e-11)
        assert (found.share.item() == 1.0) == (part > 1.0)
        assert found.position.item() == pytest.approx(q, abs=1e-18)
        carried = found.share.item() * load
        zeta = carried / k[0] - TWIST[0] * q if carried else load / k[1] - TWIST[1] * q
        assert found.approach.item() == pytest.approx(zeta, rel=1e-12)


def test_a_floating_member_shares_evenly_and_moves():
    found = balance(bar(6e8), bar(2e8, 1e-6), [1000.0, 5000.0], AxialSeat(TWIST, offset=7e-6))
    one, two = np.array([500.0, 2500.0]) / 6e8, 1e-6 + np.array([500.0, 2500.0]) / 2e8
    assert (found.share == 0.5).all()
    assert found.free.all()
    assert found.approach[0] == pytest.approx(0.5 * (one + two), rel=1e-13)
    assert found.position[0] == pytest.approx((one - two) / 0.6, rel=1e-13)
    stiffness = balance(bar(6e8), bar(2e8, 1e-6), [5000.0, 5001.0], AxialSeat(TWIST))
    assert 1.0 / np.diff(stiffness.approach[0]) == pytest.approx(stiffness.stiffness[0, :1], rel=1e-6)


def test_play_is_floating_as_far_as_it_goes_and_then_a_stop():
    halves = bar(6e8), bar(2e8, 1e-6)
    wanted = balance(*halves, 5000.0, AxialSeat(TWIST)).position.item()
    wide = balance(*halves, 5000.0, AxialSeat(TWIST, room=1.01 * abs(wanted)))
    assert wide.free.all()
    assert wide.share.item() == 0.5
    narrow = balance(*halves, 5000.0, AxialSeat(TWIST, room=0.5 * abs(wanted)))
    held = balance(*halves, 5000.0, AxialSeat(TWIST, offset=0.5 * wanted, room=0.0))
    assert not narrow.free.any()
    assert narrow.share.item() == held.share.item() != 0.5
    assert narrow.approach.item() == held.approach.item()


def test_a_force_along_the_axis_takes_its_part():
    """W_1 t_1 + W_2 t_2 = F: the halves differ by F / t; beyond W t there is no balance without a stop."""
    found = balance(bar(6e8), bar(2e8), 5000.0, AxialSeat(TWIST, force=300.0))
    assert (2.0 * found.share.item() - 1.0) * 5000.0 == pytest.approx(300.0 / TWIST[0])
    with pytest.raises(InputError, match=r"axial_force = 1600 N: is not below 1500 N"):
        balance(bar(6e8), bar(2e8), 5000.0, AxialSeat(TWIST, force=1600.0))
    pushed = balance(bar(6e8), bar(2e8), 5000.0, AxialSeat(TWIST, force=1600.0, room=1e-3))
    assert pushed.share.item() == 1.0
    assert pushed.position.item() == 1e-3


def test_loads_that_are_none_and_halves_of_one_hand_are_refused():
    for load in (0.0, -1.0, math.nan):
        with pytest.raises(InputError, match="must be positive and finite"):
            balance(bar(1e8), bar(1e8), load, AxialSeat(TWIST))
    with pytest.raises(InputError, match="must be opposite"):
        balance(bar(1e8), bar(1e8), 1.0, AxialSeat((0.3, 0.3)))


@dataclass(frozen=True)
class Springs:
    """A half of parallel springs behind gaps, all of them along the transverse line of action."""

    stiffness: np.ndarray
    gap: np.ndarray

    @property
    def touch(self):
        return np.array([[self.gap.min()]])

    def under(self, load):
        order = np.argsort(self.gap)
        k, gap = np.cumsum(self.stiffness[order]), np.cumsum((self.stiffness * self.gap)[order])
        ends = np.append(self.gap[order][1:], np.inf)
        on = (load[..., None] <= k * ends - gap).argmax(axis=-1)  # how many springs are closed
        return (load + gap[on]) / k[on], k[on]


def _turned(angle):
    return np.array([[math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0, 0, 1]])


@pytest.mark.parametrize("floating", [True, False])
def test_a_rigid_body_on_springs_along_the_normals_turns_and_moves_as_the_balance_has_it(floating):
    """The driver in space: points of its flanks in the plane of action, forces along the helices' normals.

    Torque about its axis and force along it come from vector products; turn and axial place are searched for.
    """
    generator = np.random.default_rng(17)
    radius, beta, torque, apex = 0.04, math.radians(24.0), 250.0, 0.0 if floating else 3e-6
    rows = []
    for sign, low in ((1.0, -0.06), (-1.0, 0.02)):
        for _ in range(9):
            along, z = generator.uniform(-0.01, 0.01), generator.uniform(low, low + 0.04)
            normal = np.array([math.cos(beta), 0.0, sign * math.sin(beta)])
            rows.append((np.array([along, radius, z]), normal, generator.uniform(1e7, 6e7), generator.uniform(0, 8e-6)))

    def forces(turn, move):
        """Clockwise turn seen from +z, which drives the flanks along +x, and way along the axis."""
        total, moment = np.zeros(3), 0.0
        for point, normal, k, gap in rows:
            way = _turned(-turn) @ point + [0.0, 0.0, move] - point
            push = k * max(normal @ way - gap * normal[0], 0.0)
            total -= push * normal
            moment -= np.cross(point, push * normal)[2]
        return total, moment

    def turn_at(move):
        return brentq(lambda turn: forces(turn, move)[1] - torque, -1e-2, 1e-2, xtol=1e-16, rtol=1e-14)

    move = brentq(lambda q: forces(turn_at(q), q)[0][2], -5e-5, 5e-5, xtol=1e-15) if floating else apex
    turn = turn_at(move)
    # A force along the normal has cos(beta_b) of itself in the section, and so has its way.
    halves = [
        Springs(np.array([k for _, n, k, _ in rows if n[2] * sign > 0.0]) * math.cos(beta) ** 2,
                np.array([gap for _, n, _, gap in rows if n[2] * sign > 0.0]))
        for sign in (1.0, -1.0)
    ]  # fmt: skip
    seat = AxialSeat((math.tan(beta), -math.tan(beta)), apex, math.inf if floating else 0.0)
    found = balance(*halves, torque / radius, seat)
    assert found.approach.item() == pytest.approx(turn * radius, rel=1e-4)  # the turn is not small to the last digit
    assert found.position.item() == pytest.approx(move, rel=2e-3)
    thrust = -(2.0 * found.share.item() - 1.0) * torque / radius * math.tan(beta)
    assert thrust == pytest.approx(forces(turn, move)[0][2], rel=1e-3, abs=0.5)


def _random(generator, count):
    shape = (count, 1)
    return Curved(
        generator.uniform(1e8, 1e10, shape), generator.uniform(0.6, 1.0, shape), generator.uniform(0.0, 1e-5, shape)
    )


def _by_scipy(first, second, p, load, seat):
    """One position and load by nested scalar logic of its own: forces as functions of zeta, zeta by bisection."""

    def force(half, zeta):
        over = max(zeta - half.gap[p, 0], 0.0)
        return half.a[p, 0] * over ** (1.0 / half.n[p, 0])

    def at(q):
        def rest(zeta):
            pair = zip((first, second), seat.twist, strict=True)
            return sum(force(half, zeta + twist * q) for half, twist in pair) - load

        zeta = brentq(rest, -1e-2, 1e-2 + load, xtol=1e-18, rtol=1e-14)
        return zeta, force(first, zeta + seat.twist[0] * q)

    def push(q):
        one = at(q)[1]
        return one * seat.twist[0] + (load - one) * seat.twist[1] - seat.force

    low, high = seat.offset - seat.room, seat.offset + seat.room
    if push(low) >= 0.0:
        q = low
    elif push(high) <= 0.0:
        q = high
    else:
        q = brentq(push, low, high, xtol=1e-18, rtol=1e-14)
    zeta, one = at(q)
    return zeta, one / load, q


@pytest.mark.parametrize("seed", range(4))
def test_curved_halves_are_those_of_a_search_for_the_axial_position(seed):
    """Floating, play, stops, unequal helices, forces: the position is searched for, not the share."""
    generator = np.random.default_rng(seed)
    first, second = _random(generator, 12), _random(generator, 12)
    twist = (generator.uniform(0.1, 0.6), -generator.uniform(0.1, 0.6))
    if seed % 2:
        twist = twist[::-1]
    loads = np.array([3.0, 700.0, 20000.0])
    for room in (0.0, 2e-6, 2e-5, 1e-3):
        seat = AxialSeat(twist, generator.uniform(-1e-5, 1e-5), room, generator.uniform(-400.0, 400.0))
        found = balance(first, second, loads, seat)
        for p in range(12):
            for i, load in enumerate(loads):
                zeta, share, q = _by_scipy(first, second, p, load, seat)
                assert found.position[p, i] == pytest.approx(q, abs=1e-13)
                assert found.approach[p, i] == pytest.approx(zeta, rel=1e-8, abs=1e-13)
                assert found.share[p, i] == pytest.approx(share, abs=1e-7)


def test_exchanged_halves_exchange_their_shares():
    generator = np.random.default_rng(9)
    first, second = _random(generator, 30), _random(generator, 30)
    for room in (0.0, 3e-6, math.inf):
        one = balance(first, second, [50.0, 5000.0], AxialSeat(TWIST, 4e-6, room))
        two = balance(second, first, [50.0, 5000.0], AxialSeat(TWIST[::-1], 4e-6, room))
        np.testing.assert_allclose(two.share, 1.0 - one.share, atol=1e-11)
        np.testing.assert_allclose(two.approach, one.approach, rtol=1e-11)
        np.testing.assert_allclose(two.position, one.position, rtol=1e-11)
        np.testing.assert_allclose(two.separation[::-1], one.separation, atol=1e-17)


def test_equal_halves_share_to_the_last_bit():
    half = _random(np.random.default_rng(3), 20)
    for room in (0.0, math.inf):
        found = balance(half, half, [50.0, 5000.0], AxialSeat(TWIST, room=room))
        assert (found.share == 0.5).all()
        assert (found.approach == half.under(np.broadcast_to([25.0, 2500.0], (20, 2)))[0]).all()
        assert (found.position == 0.0).all()


@pytest.mark.parametrize("widths", [("solid", "solid"), ("slices", "solid"), ("slices", "slices")])
def test_what_slices_miss_counts_in_errors_of_halves_that_are_sliced_and_of_no_others(monkeypatch, widths):
    monkeypatch.setattr(load_double, "_made", lambda *_: (SimpleNamespace(panel=1.0), "gaps"))
    monkeypatch.setattr(load_double, "_common_positions", lambda *_: None)
    monkeypatch.setattr(load_double, "_balanced", lambda *_: SimpleNamespace())
    monkeypatch.setattr(load_double, "missed_by_slices", lambda twist: {"contact": 0.1 * twist})
    monkeypatch.setattr(load_double, "double_error", lambda steps, missed: (len(steps), missed))
    monkeypatch.setattr(load_double, "replace", lambda one, **more: SimpleNamespace(**(vars(one) | more)))
    halves = [SimpleNamespace(width=width, pair=SimpleNamespace(driver=SimpleNamespace(twist=twist)))
              for width, twist in zip(widths, (2.0, 3.0), strict=True)]  # fmt: skip
    gears = [[SimpleNamespace(coarse=None)] * 2] * 2
    found = load_double.load_double(SimpleNamespace(halves=halves), gears)
    wanted = max(0.1 * half.pair.driver.twist if half.width == "slices" else 0.0 for half in halves)
    assert found.error == (2, pytest.approx(wanted))
