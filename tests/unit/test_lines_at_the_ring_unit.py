"""Orders of a set's transmission error and mesh force, and what a pick-up on the ring sees while planets pass."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.sidebands import HIGHEST, indicators_of
from fegear.dynamics.planetary.set_signals import SetSignals

PLANETS = 3
ANGLES = np.array([0.0, 2.0, 4.3])  # none opposite another
SAMPLES = 64  # of a base pitch


def signals(count, ring, *, clockwise=False, frequency=250.0):
    """Sums of lines up to three mesh harmonics, other ones for every curve."""
    chance = np.random.default_rng(7 * count + ring)
    t = np.arange(SAMPLES * count) / SAMPLES

    def curve(scale):
        n = np.arange(1, 3 * count + 1)
        amplitude, phase = chance.uniform(0.2, 1.0, n.size) * scale, chance.uniform(0.0, 2.0 * np.pi, n.size)
        return 5.0 * scale + amplitude @ np.cos(2.0 * np.pi * np.outer(n / count, t) + phase[:, None])

    force = np.array([[curve(100.0) for _ in range(PLANETS)] for _ in range(2)])
    found = SimpleNamespace(ring_teeth=ring, angles=ANGLES)
    return SetSignals(found, count, 1, (9, 15), frequency, clockwise, 500.0, curve(1e-6), force), t


def seen(one, t, ring):
    """The signal of the pick-up over a turn of the carrier and more, and its amplitudes by order."""
    turn, sense = math.lcm(one.base_pitches, ring) * 4, -1.0 if one.clockwise else 1.0
    place = np.arange(turn * SAMPLES) / SAMPLES
    total = np.zeros(place.size)
    for force, angle in zip(one.mesh_force[1], ANGLES, strict=True):
        passing = 0.5 * (1.0 + np.cos(2.0 * np.pi * place / ring + sense * angle))
        total += passing * np.interp(place % one.base_pitches, [*t, one.base_pitches], [*force, force[0]])
    return np.arange(place.size // 2 + 1) / turn, 2.0 * np.abs(np.fft.rfft(total)) / place.size


@pytest.mark.parametrize(("count", "ring"), [(3, 7), (3, 6), (5, 2), (1, 12)])
@pytest.mark.parametrize("clockwise", [False, True])
def test_the_lines_of_a_pick_up_are_those_of_what_it_sees_of_passing_planets(count, ring, clockwise):
    one, t = signals(count, ring, clockwise=clockwise)
    lines = one.at_ring
    order, amplitude = seen(one, t, ring)
    assert (np.diff(lines.order) > 0.0).all()
    at = np.rint(lines.order / order[1]).astype(int)
    assert order[at] == pytest.approx(lines.order)
    assert lines.force == pytest.approx(amplitude[at], rel=1e-9, abs=1e-7)
    # It has no others.
    rest = amplitude.copy()
    rest[[0, *at]] = 0.0
    assert rest.max() < 1e-6 * amplitude.max()
    assert lines.frequency == pytest.approx(250.0 * lines.order)
    # Which line of the force each is, and which way the carrier's turn moves it.
    assert np.abs(lines.force_order + lines.passing / ring) == pytest.approx(lines.order)
    assert set(lines.passing.tolist()) <= {-1, 0, 1}
    assert lines.force_order * count == pytest.approx(np.rint(lines.force_order * count))
    assert lines.force_order.max() == pytest.approx(3.0)


def test_the_largest_part_names_a_line_of_several():
    one, _ = signals(3, 6)
    lines = one.at_ring
    series = np.fft.rfft(one.mesh_force[1], axis=1) / one.mesh_force.shape[2]
    turned = np.exp(1j * ANGLES)
    parts = {1: abs(turned @ series[:, 1]), -1: abs(np.conj(turned) @ series[:, 2])}  # 1/3 + 1/6 and 2/3 - 1/6
    at = int(np.argmin(np.abs(lines.order - 0.5)))
    assert lines.order[at] == pytest.approx(0.5)
    assert lines.passing[at] == max(parts, key=parts.__getitem__)


def test_a_line_below_a_billionth_of_the_mean_force_is_none():
    one, _ = signals(3, 7)
    louder = SetSignals(**{**vars_of(one), "mean_force": 2e9 * float(np.median(one.at_ring.force))})
    assert 0 < louder.at_ring.force.size < one.at_ring.force.size
    assert louder.at_ring.force.min() > 1e-9 * louder.mean_force
    kept = one.at_ring.force > 1e-9 * louder.mean_force
    assert louder.at_ring.order == pytest.approx(one.at_ring.order[kept])


def vars_of(one):
    return {key: getattr(one, key) for key in SetSignals.__dataclass_fields__}


def test_orders_are_those_of_the_odd_planet_at_the_sun():
    one, t = signals(3, 7)
    orders = one.orders
    assert orders.n.tolist() == list(range(1, 3 * HIGHEST + 1))
    assert orders.mesh_order == pytest.approx(orders.n / 3.0)
    assert orders.frequency == pytest.approx(250.0 / 3.0 * orders.n)
    for n in (1, 2, 9):
        wave = np.exp(-2j * np.pi * n * t / 3.0)
        assert orders.te[n - 1] == pytest.approx(2.0 * abs(np.mean(wave * one.te)))
        assert orders.load[n - 1] == pytest.approx(2.0 * abs(np.mean(wave * one.mesh_force[0, 1])))
    assert orders.te[9:] == pytest.approx(0.0, abs=1e-18)
    assert signals(3, 7, frequency=math.nan)[0].orders.frequency is None
    assert signals(3, 7, frequency=math.nan)[0].at_ring.frequency is None
    assert one.indicators == indicators_of(one.te, 3, (9, 15))
