"""Orders and condition indicators of transmission errors that are made up: what is put in comes out."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane import over_revolution
from fegear.contact.plane.over_revolution import OverRevolution
from fegear.contact.plane.sidebands import along_revolution, condition_indicators, revolution_orders

CYCLES, POSITIONS, PITCH, START = 12, 400, 6e-3, -2e-3


def made(te):
    """A pair over twelve base pitches whose transmission error is a function of the turn, 0 to 1, in um."""
    x = np.linspace(START, START + PITCH, POSITIONS + 1)
    turn = (x - START + PITCH * np.arange(CYCLES)[:, None]) / (CYCLES * PITCH)
    error = 1e-6 * (te(turn) + 0.0 * turn)
    loads = np.stack([np.full(error.shape, 100.0), np.where(turn < 0.5, 50.0, 0.0)], axis=1)
    stiffness = 1e8 + 1e12 * error
    return OverRevolution(x, PITCH, 100.0, 0.03, np.array([0, 1]), error, stiffness, loads, 3, 2.0 * stiffness)


def mesh(turn):
    return 5.0 + 2.0 * np.cos(2.0 * math.pi * CYCLES * turn) + 0.5 * np.sin(2.0 * math.pi * 2 * CYCLES * turn)


def side(turn, a=0.3):
    """First sidebands of the mesh frequency: its amplitude rises and falls once a turn."""
    return a * np.cos(2.0 * math.pi * turn) * np.cos(2.0 * math.pi * CYCLES * turn)


def test_amplitudes_stand_at_their_orders():
    found = revolution_orders(made(lambda turn: mesh(turn) + side(turn)))
    at = dict(zip(found.n.tolist(), found.te * 1e6, strict=True))
    assert at[CYCLES] == pytest.approx(2.0, rel=2e-3)
    assert at[2 * CYCLES] == pytest.approx(0.5, rel=2e-3)
    assert (at[CYCLES - 1], at[CYCLES + 1]) == pytest.approx((0.15, 0.15), rel=2e-3)
    assert max(at[n] for n in (1, 5, CYCLES - 2, CYCLES + 2)) < 1e-3
    assert found.mesh_order[CYCLES - 1] == 1.0
    assert found.mesh_stiffness[CYCLES - 1] == pytest.approx(2e6, rel=2e-3)


def test_equal_base_pitches_have_no_residual():
    found = condition_indicators(made(mesh), [CYCLES])
    assert found.residual_rms == found.energy_ratio == found.sideband_level_factor == 0.0
    assert math.isnan(found.residual_kurtosis)
    assert math.isnan(found.fm4)
    assert math.isnan(found.m6a)
    assert found.fm0 == pytest.approx(np.ptp(mesh(np.linspace(0.0, 1.0, 20_001))) / 2.5, rel=2e-3)


def test_sidebands_are_in_the_residual_and_not_in_the_difference():
    found = condition_indicators(made(lambda turn: mesh(turn) + side(turn)), [CYCLES])
    assert found.residual_rms == pytest.approx(0.15e-6, rel=2e-3)  # two lines of .15
    assert found.residual_kurtosis == pytest.approx(9 / 4, rel=1e-2)  # a product of two cosines
    assert found.energy_ratio < 1e-3
    rms = math.sqrt(0.5 * (2.0**2 + 0.5**2 + 2 * 0.15**2))
    assert found.sideband_level_factor == pytest.approx(0.3 / rms, rel=2e-3)
    other = condition_indicators(made(lambda turn: mesh(turn) + side(turn)), [CYCLES // 2])  # of another shaft
    assert other.sideband_level_factor < 1e-3
    assert other.energy_ratio == pytest.approx(0.15 / math.sqrt(0.5 * (2.0**2 + 0.5**2)), rel=5e-3)


def test_a_pulse_once_a_turn_is_far_from_normal():
    pulse = condition_indicators(made(lambda turn: mesh(turn) + np.exp(-(((turn - 0.3) / 0.01) ** 2))), [CYCLES])
    line = condition_indicators(made(lambda turn: mesh(turn) + np.cos(2.0 * math.pi * 5 * turn)), [CYCLES])
    assert line.fm4 == pytest.approx(1.5, rel=1e-2)  # of a cosine
    assert line.m6a == pytest.approx(2.5, rel=1e-2)
    assert line.residual_kurtosis == pytest.approx(1.5, rel=1e-2)
    assert pulse.residual_kurtosis > 15.0
    assert pulse.fm4 > 10.0


def test_rows_follow_each_other_round_the_turn():
    found = made(lambda turn: mesh(turn) + 3.0 * (turn > 1.0 - 1.0 / CYCLES))
    rows = along_revolution(found)
    assert (np.diff(rows.x) > -1e-12).all()
    assert rows.driver_angle == pytest.approx(rows.x / 0.03)
    assert rows.base_pitch[POSITIONS + 1] == 1
    assert rows.te_error is None
    assert set(rows.pairs_in_contact[rows.base_pitch == 0]) == {2}
    assert set(rows.pairs_in_contact[rows.base_pitch == 11]) == {1}
    late = rows.te_residual[rows.base_pitch == 11]
    assert late[1:] == pytest.approx(np.full(POSITIONS, 3e-6), rel=1e-6)
    assert rows.te_residual[rows.base_pitch == 4] == pytest.approx(np.zeros(POSITIONS + 1), abs=1e-15)


def test_stiffness_at_any_rotation_of_the_driver():
    """Periodic over all base pitches, at the places of the table its rows."""
    found = made(lambda turn: mesh(turn) + side(turn))
    rows = along_revolution(found)
    inner = slice(5, -5)
    turn = CYCLES * PITCH / 0.03
    for at in (rows.driver_angle[inner], rows.driver_angle[inner] + 3.0 * turn, rows.driver_angle[inner] - turn):
        assert found.stiffness_at(at, secant=True) == pytest.approx(rows.mesh_stiffness[inner])
        assert found.stiffness_at(at) == pytest.approx(rows.local_stiffness[inner])
        assert found.error_at(at) == pytest.approx(rows.te[inner])
    assert found.error_at(rows.driver_angle[0] - 1e-9) == pytest.approx(rows.te[-1], rel=1e-6)


def odd_pitch(softer=0.3, scale=1.0):
    """One base pitch of twelve whose stiffness, 1e8 N/m, is lower by a share, its error larger by as much."""
    usual = made(lambda turn: 1.0 + 0.0 * turn)
    share = np.where(np.arange(CYCLES) == 4, 1.0 - softer, 1.0)[:, None] * scale
    full = np.ones(usual.stiffness.shape)
    return replace(usual, stiffness=1e8 * share * full, transmission_error=1e-6 / share * full)


def test_errors_of_losses_and_residuals_are_what_the_compliances_errors_change():
    plain = odd_pitch()
    assert plain.stiffness_loss == pytest.approx(0.3)
    assert plain.largest_residual == pytest.approx(1e-6 * (1.0 / 0.7 - 1.0))
    assert math.isnan(plain.stiffness_loss_error)
    assert math.isnan(plain.largest_residual_error)
    found = replace(plain, others=(odd_pitch(0.32), odd_pitch(0.29)))
    assert found.stiffness_loss_error == pytest.approx(0.03)
    assert found.largest_residual_error == pytest.approx(1e-6 * (1.0 / 0.68 - 1.0 / 0.71))
    assert found.stiffness_error.max() == pytest.approx(3e6)


def test_what_softens_all_teeth_alike_leaves_a_part_of_its_error():
    """Losses stay the same, but odd teeth share their errors with ordinary ones only in part; teeth all alike do."""
    found = replace(odd_pitch(), others=(odd_pitch(scale=0.99),))
    assert found.stiffness_loss_error == pytest.approx(0.2 * 0.7 * 0.01)
    assert found.largest_residual_error == pytest.approx(1e-6 * (1.0 / 0.7 - 1.0) * (1.0 / 0.99 - 1.0))
    alike = replace(odd_pitch(0.0), others=(odd_pitch(0.0, 0.99),), solved=1)
    assert alike.stiffness_loss_error == pytest.approx(0.0, abs=1e-15)
    assert alike.largest_residual_error == pytest.approx(0.0, abs=1e-21)


def test_an_error_of_stiffness_where_a_jump_is_moved_past_a_position_is_that_around_it():
    """Positions at which a pair bears in one solution and not in the other; in between, straight over the places."""
    x, loads = np.array([0.0, 1.0, 3.0, 4.0, 5.0]), np.zeros((2, 2, 5))
    loads[:, 0], loads[0, 1, 2:], loads[1, 1] = 60.0, 40.0, 40.0
    stiffness = np.full((2, 5), 9.0)
    one = OverRevolution(x, 5.0, 100.0, 0.03, np.array([0, 1]), stiffness, stiffness, loads, 2, stiffness)
    assert np.isnan(one.stiffness_error).all()
    other = replace(one, loads=loads.copy(), stiffness=stiffness + np.array([[0.5, 0.5, 7.0, 2.5, 2.5], [0.25] * 5]))
    other.loads[0, 1, 2] = 0.0
    found = replace(one, others=(other, replace(one, stiffness=stiffness - 0.125)), of_changes=2.0).stiffness_error
    np.testing.assert_allclose(found[0], 2.0 * (np.array([0.5, 0.5, 0.5 + 2.0 * 2.0 / 3.0, 2.5, 2.5]) + 0.125))
    np.testing.assert_allclose(found[1], 0.75)
    # where every position is passed there is nothing around it
    other.loads[0, 1] = np.where(loads[0, 1] > 0.0, 0.0, 40.0)
    whole = replace(one, others=(other,)).stiffness_error
    np.testing.assert_allclose(whole[0], [0.5, 0.5, 7.0, 2.5, 2.5])


def test_both_sides_of_every_change_of_contact_are_positions(monkeypatch):
    """Of base pitches that differ, each with its own; of changes in one place one."""
    changes = {0: [0.3, 1.4], 2: [0.3 + 1e-13, 2.5]}
    monkeypatch.setattr(over_revolution, "together", lambda teeth: [np.array([0, 1]), np.array([2, 3])])
    monkeypatch.setattr(over_revolution, "contact_changes", lambda engagement, load, cycle: np.array(changes[cycle]))
    engagement = SimpleNamespace(
        pair=SimpleNamespace(base_pitch=3.0), teeth_in=lambda number, cycle: cycle,
        grid=lambda x: SimpleNamespace(contacts=SimpleNamespace(number=np.array([0, 1]))),
    )  # fmt: skip
    x = np.array([0.0, 1.0, 2.0, 3.0])
    found = over_revolution._with_changes(engagement, 50.0, x, 4)
    assert np.isin(x, found).all()
    assert (np.diff(found) > 0.0).all()
    for change in (0.3, 1.4, 2.5):
        near = found[np.abs(found - change) < 3.0 * 1.01 * max(over_revolution._BESIDE_CHANGES)]
        assert (near < change).sum() == (near > change).sum() == len(over_revolution._BESIDE_CHANGES)
        closest = np.sort(np.abs(near - change))[:2]
        np.testing.assert_allclose(closest, 3.0 * min(over_revolution._BESIDE_CHANGES), rtol=1e-3)
    assert found.size == 4 + 3 * 2 * len(over_revolution._BESIDE_CHANGES)
