"""How changes of loaded flanks become the errors that are stated; the solutions are made up."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide import error
from fegear.contact.wide.error import FlankError, _changes, _of_largest, _share_changes, flank_error, with_misses
from fegear.contact.wide.lines import ContactLines
from fegear.contact.wide.over_pitch import Stated
from fegear.contact.wide.spots import missed_of_spots

LOADS = 2
ROLL = np.array([0.1, 0.4, 0.7])


@dataclass(frozen=True)
class Flanks:
    """Panels and gears by name; what they give is looked up."""

    panel: float
    gears: str
    given: dict

    def compliance(self, about):
        assert about == 55.0
        return f"compliance of {self.gears} at panel {self.panel}"

    def solve(self, load, gaps, known):
        assert (load.tolist(), gaps) == ([100.0, 300.0], "gaps")
        assert known == f"compliance of {self.gears} at panel {self.panel}"
        return self.given[self.panel, self.gears]


def loaded(mean, curve, over_face, line_loads, pressures, shares):
    """Loaded flanks at three roll positions under two loads."""
    te = np.array(mean) + np.array(curve)
    return SimpleNamespace(
        load=np.array([100.0, 300.0]), transmission_error=te, mean_transmission_error=np.array(mean),
        lines=SimpleNamespace(high=2.0, low=-3.0, roll=ROLL), mean_over_face=np.array(over_face),
        face_load_factor=np.array([1.4, 1.8]), mean_between=lambda cells: np.array(over_face) + 0.0 * cells,
        cells=1.0, largest_line_loads=np.array(line_loads), largest_pressures=np.array(pressures),
        pair=SimpleNamespace(base_pitch=0.9), share=np.array(shares), pair_numbers=np.arange(len(shares)),
        largest_line_load=np.max(line_loads, axis=0), largest_pressure=np.max(pressures, axis=0), known="known",
        contact="contact", smooth=np.ones((1, 1), dtype=bool),
    )  # fmt: skip


CURVE = [[0.0, 0.0], [1.0, 2.0], [-1.0, 0.0]]
SHARES = [[[0.6, 0.5]] * 3, [[0.4, 0.5]] * 3]
FOUND = loaded([10.0, 30.0], CURVE, [[20.0, 60.0], [25.0, 70.0]], [[50.0, 90.0]] * 3, [[7.0, 9.0]] * 3, SHARES)


def over(values):
    """What is stated of the whole pitch, read at the same positions."""
    stated = SimpleNamespace(
        largest_line_loads=np.array(values), largest_pressures=0.1 * np.array(values),
        largest_line_load=np.max(values, axis=0), largest_pressure=0.2 * np.max(values, axis=0),
        smooth=np.array([[True, True, False]]), pressure=np.array([[[3.0, 4.0], [5.0, 6.0], [99.0, 99.0]]]),
        known="more", contact="of", bounded_line_load="loads", smooth_pressure="pressures",
    )  # fmt: skip
    return SimpleNamespace(
        found=stated, points=SimpleNamespace(x=ROLL),
        left_by_positions=Stated(*(np.full(LOADS, 0.001 * (k + 1)) for k in range(5))),
    )  # fmt: skip


VALUES = [[50.0, 90.0], [60.0, 80.0], [10.0, 20.0]]


def test_the_largest_may_become_what_the_largest_and_its_rivals_may():
    first = np.array([[10.0, 10.0], [10.0, 10.0], [0.0, 10.0]])
    second = np.array([[12.0, 9.0], [9.0, 10.0], [5.0, 16.0]])
    found = _of_largest(FOUND, first, second, over(VALUES), np.array(VALUES))
    # By 1.25 times a share of 0.2 and 0.1 of 50 and 60, a position that was at zero by nothing: up to 67.5, or down to
    # 52.5 where both fall; 90 by 0.1, and 20 by 0.6, which stays far below: up to 101.25, down to 80 only.
    np.testing.assert_allclose(found, [max(67.5 - 60.0, 60.0 - 52.5), max(101.25 - 90.0, 90.0 - 80.0)])
    np.testing.assert_allclose(_of_largest(FOUND, first, first, over(VALUES), np.array(VALUES)), 0.0)


def test_changes_from_one_solution_to_another():
    other = loaded(
        [10.5, 29.0], [[0.0, 0.0], [1.2, 2.0], [-1.0, 0.6]], [[21.0, 61.0], [26.0, 78.0]], [[55.0, 90.0]] * 3,
        [[7.0, 9.9]] * 3, SHARES,
    )  # fmt: skip
    found = _changes(FOUND, other, over(VALUES))
    np.testing.assert_allclose(found.mean, [0.5, 1.0])
    np.testing.assert_allclose(found.peak_to_peak, [0.2, 0.3])  # of spans 2 and 2.2; half of 0.6 where spans are alike
    # Over the mean line load 20 and 60: 1 and 8; no less than mean's share of the factor.
    np.testing.assert_allclose(found.face_load_factor, [max(1.0 / 20.0, 0.5 / 10.0 * 1.4), max(8.0 / 60.0, 1.8 / 30.0)])
    np.testing.assert_allclose(found.largest_line_load, [1.25 * 0.1 * 60.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(found.largest_pressure, [0.0, 1.25 * 0.1 * 9.0], atol=1e-12)


def test_shares_change_pair_by_pair_and_one_that_is_not_there_has_none():
    one = SimpleNamespace(pair_numbers=np.array([0, 1]), share=np.array([[[0.6]], [[0.4]]]))
    two = SimpleNamespace(pair_numbers=np.array([1, 2]), share=np.array([[[0.5]], [[0.5]]]))
    found = SimpleNamespace(pair_numbers=np.array([0, 1, 2, 3]), share=np.zeros((4, 1, 1)))
    np.testing.assert_allclose(_share_changes(found, one, two).ravel(), [0.6, 0.1, 0.5, 0.0])


@pytest.mark.parametrize("finer", [False, True])
def test_an_error_adds_what_panels_gears_positions_and_spots_change(finer, monkeypatch):
    more = loaded([11.0, 30.0], CURVE, [[20.0, 60.0]] * 2, [[50.0, 90.0]] * 3, [[7.0, 9.0]] * 3, SHARES)
    softer = loaded([11.0, 34.0], CURVE, [[20.0, 60.0]] * 2, [[50.0, 90.0]] * 3, [[7.0, 9.0]] * 3,
                    [[[0.5, 0.5]] * 3, [[0.5, 0.5]] * 3])  # fmt: skip
    flanks = Flanks(2.0, "fine", {(3.0, "fine"): more, (3.0, "coarse"): softer})
    steps = []

    def changes(one, two, _over):
        steps.append((one, two))
        size = 1.0 if len(steps) == 1 else 10.0
        return Stated(*(np.full(LOADS, size * (k + 1)) for k in range(5)))

    again = {"largest_line_load": np.array([6.0, 8.0]), "largest_pressure": np.array([0.6, 0.8])} if finer else {}
    # On short panels coarser gears change the second load's pressure more than on long ones, and all else less.
    by_gears = {"largest_line_load": np.array([39.0, 39.0]), "largest_pressure": np.array([49.0, 77.0])}
    both = {key: (change, by_gears[key]) for key, change in again.items()}
    monkeypatch.setattr(error, "_changes", changes)
    monkeypatch.setattr(error, "finer_changes", lambda *given: given[1:] == ("coarse", "gaps", stated, 55.0) and both)
    monkeypatch.setattr(error, "long_line", lambda pair: 0.7 if pair is FOUND.pair else None)
    spots = {"loads": np.array([0.5, 0.9]), "pressures": np.array([0.07, 0.09])}
    monkeypatch.setattr(
        error, "missed_of_spots", lambda *given: spots[given[2]] if (*given[:2], given[3]) == ("more", "of", 0.7) else 0
    )
    stated = over(VALUES)
    result = flank_error(flanks, FOUND, "coarse", "gaps", stated, 55.0)
    assert steps == [(FOUND, more), (more, softer)]
    assert (result.longer, result.coarse) == (more, softer)
    # Coarser gears change means and shapes by more than they err; panels leave an error that knows nothing of theirs.
    np.testing.assert_allclose(result.mean, np.hypot(1.0, 0.5 * 10.0) + 0.001)
    np.testing.assert_allclose(result.peak_to_peak, np.hypot(2.0, 0.6 * 20.0) + 0.002)
    np.testing.assert_allclose(result.face_load_factor, 3.0 + 0.6 * 30.0 + 0.003)
    # Spots miss some of each largest number; a pressure read between stations six tenths of what it adds.
    by_panels, left = (np.array([4.0, 4.0]), 0.004) if not finer else (0.0, 1.5 * again["largest_line_load"])
    np.testing.assert_allclose(result.largest_line_load, by_panels + 40.0 + left + spots["loads"])
    by_panels, left = (np.array([5.0, 5.0]), 0.005) if not finer else (0.0, 1.5 * again["largest_pressure"])
    gears = np.array([50.0, 77.0]) if finer else 50.0
    between = 0.6 * (0.2 * np.array([60.0, 90.0]) - np.array([5.0, 6.0]))
    np.testing.assert_allclose(result.largest_pressure, by_panels + gears + left + spots["pressures"] + between)
    np.testing.assert_allclose(result.transmission_error, np.tile([1.0, 0.6 * 4.0], (3, 1)))
    np.testing.assert_allclose(result.share, np.tile([0.12, 0.0], (2, 3, 1)), atol=1e-15)


def test_a_spot_that_comes_and_goes_leaves_a_share_of_the_mean_s_change(monkeypatch):
    flanks = Flanks(2.0, "fine", {(3.0, "fine"): FOUND, (3.0, "coarse"): FOUND})
    rows = iter(
        [Stated(*np.array([[9.0, 0.1], [1.0, 1.0], [0.0] * 2, [0.0] * 2, [0.0] * 2])), Stated(*np.zeros((5, 2)))]
    )
    monkeypatch.setattr(error, "_changes", lambda *given: next(rows))
    monkeypatch.setattr(error, "finer_changes", lambda *given: {})
    monkeypatch.setattr(error, "long_line", lambda pair: 0.7)
    monkeypatch.setattr(error, "missed_of_spots", lambda *given: 0.0)
    found = flank_error(flanks, FOUND, "coarse", "gaps", over(VALUES), 55.0)
    np.testing.assert_allclose(found.peak_to_peak, [0.6 * 9.0 + 0.002, 1.0 + 0.002])


def test_an_edge_that_just_touches_says_nothing_of_the_line_that_carries_all():
    """One roll position, lines of five stations each: one carries all along, of the other one station just touches."""
    z = np.tile(np.linspace(-2.0, 2.0, 5), 2)[None]
    lines = ContactLines(
        np.zeros(1), np.repeat([[0, 1]], 5, axis=1), np.ones((1, 10), dtype=bool), z, z, -2.0, 2.0,
        np.zeros((1, 10), dtype=bool),
    )  # fmt: skip
    load = np.concatenate([np.full(5, 100.0), [4.0, 0.0, 0.0, 0.0, 0.0]])[None, :, None]
    known = SimpleNamespace(lines=lines, half_width=lambda line_load: 0.04 * np.sqrt(line_load))
    contact = SimpleNamespace(force=load * lines.support[:, :, None], approach=np.zeros((1, 1)))
    # Of half-lengths of 2 and 0.25 the widths 0.4 and 0.08 are 0.2 and 0.32; 0.6 of the squares is missed of each.
    np.testing.assert_allclose(missed_of_spots(known, contact, load, 1.0), 0.6 * 0.2**2 * 100.0)
    np.testing.assert_allclose(missed_of_spots(known, contact, load[:, ::-1], 1.0), 0.6 * 0.32**2 * 100.0)
    np.testing.assert_allclose(missed_of_spots(known, contact, load, 5.0), 0.0)


def test_bodies_that_miss_a_share_of_their_compliance_add_it_to_every_error():
    none = FlankError(np.zeros((3, 2)), np.zeros((2, 3, 2)), FOUND, FOUND, *np.zeros((5, 2)))
    some = replace(none, mean=np.array([1.0, 2.0]), share=np.full((2, 3, 2), 0.5))
    found = with_misses(some, FOUND, 0.04)
    np.testing.assert_allclose(found.transmission_error, 0.04 * np.abs(FOUND.transmission_error))
    np.testing.assert_allclose(found.share[0], 0.5 + 0.04 * np.tile([0.24, 0.25], (3, 1)))
    np.testing.assert_allclose(found.mean, [1.4, 3.2])
    np.testing.assert_allclose(found.peak_to_peak, [0.08, 0.08])
    np.testing.assert_allclose(found.face_load_factor, [0.016, 0.032])
    np.testing.assert_allclose(found.largest_line_load, [2.0, 3.6])
    np.testing.assert_allclose(found.largest_pressure, [0.14, 0.18])
    assert found.coarse is FOUND
