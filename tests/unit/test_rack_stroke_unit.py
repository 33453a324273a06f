"""Strokes of racks put together from given base pitches: extremes between positions, means, ends."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.rack.stroke import BasePitches, OnPitch
from fegear.results.rack.rack_stroke import _root_shares

PITCH, START, COS, TEETH = 2.0, 1.0, 0.8, 5
SIDES = ("tension", "compression")
#: The tent of the middle base pitch: where, and how high.
TENT, HEIGHT = 4.737, 1.5


def curve(way):
    """Steady, with a tent in the middle of the stroke."""
    return 1.0 + np.maximum(HEIGHT - np.abs(way - TENT), 0.0)


def pitches(count, solved, of=curve):
    """Base pitches under a curve of the transmission error; the stroke ends with the last of them."""

    def solve(c, roll):
        solved.append((c, roll))
        error = of(c * PITCH + roll - START)
        teeth = {side: {0: sign * error} for side, sign in zip(SIDES, (1.0, -1.0), strict=True)}
        pinion = {side: of_tooth[0] for side, of_tooth in teeth.items()}
        return OnPitch(roll, error, np.ones(roll.size, dtype=int), np.ones(roll.size), pinion, teeth)

    roll = START + PITCH * np.concatenate([[1e-7], (np.arange(count) + 0.5) / count, [1.0 - 1e-7]])
    return BasePitches(tuple(range(TEETH)), solve, roll, TEETH, START, PITCH, COS)


def test_a_kink_between_positions_is_found():
    solved = []
    found = pitches(9, solved).stroke()
    assert np.nanmax(found.error) == pytest.approx(1.0 + HEIGHT, rel=1e-6)
    assert found.rack_tension.max() == pytest.approx(1.0 + HEIGHT, rel=1e-6)
    assert found.rack_compression.min() == pytest.approx(-1.0 - HEIGHT, rel=1e-6)
    assert found.beyond.largest < 1e-4
    assert {c for c, _ in solved[TEETH:]} == {2}  # only the base pitch that has it is solved again
    travel = found.travel[~np.isnan(found.travel)]
    assert (np.diff(travel) > 0.0).all()
    assert travel.max() == pytest.approx(TEETH * PITCH / COS)


def test_what_is_not_looked_for_is_stated():
    """At the positions of another solution nothing is added, and what is left is known."""
    found = pitches(9, []).stroke(added={})
    missed = 1.0 + HEIGHT - np.nanmax(found.error)
    assert 0.0 < missed <= found.beyond.largest * (1.0 + 1e-6) < 0.2
    assert not found.added


def test_root_stress_that_is_alike_on_two_meshes_by_chance_has_the_error_of_the_other_side():
    of = SimpleNamespace(
        pinion_tension=np.array([[2.0, np.nan]]), pinion_compression=np.array([[-4.0, np.nan]]),
        rack_tension=np.array([1.0, 5.0]), rack_compression=np.array([-2.0, -10.0]),
    )  # fmt: skip
    coarse = SimpleNamespace(**vars(of) | {"rack_compression": np.array([-2.0, -10.2])})
    pinion, middle, rack = _root_shares(of, coarse)
    assert pinion == 0.0
    assert middle == rack == pytest.approx(0.03)


def test_a_rounded_top_lies_within_what_is_stated():
    found = pitches(4, [], lambda way: 2.0 - 0.1 * (way - TENT) ** 2).stroke()
    assert 2.0 - np.nanmax(found.error) <= found.beyond.largest + 1e-4
    assert found.beyond.largest < 0.02


def test_means_and_peaks_in_the_middle():
    """Over the base pitch from 4 to 6, in closed form."""
    found = pitches(64, [], lambda way: 1.0 + (way - 4.0) ** 2).stroke()
    assert found.middle == 2
    assert abs(found.mean_in_middle - (1.0 + 4.0 / 3.0)) < found.beyond.mean < 1e-3
    assert found.peak_to_peak_in_middle == pytest.approx(4.0, rel=1e-6)
