"""Modes followed by their shapes: crossings go straight through, veerings turn, however coarse the values."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import InputError
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.modal_indices import mode_table
from fegear.dynamics.helical_pair.mode_following import SAME, _meetings, _State, follow_modes
from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel, RigidGear
from fegear.dynamics.train.modes import undamped_modes

PSI = math.radians(30.0)
BENDING = 2  # number of the bending mode at alpha_z = 0.5, from 0


def pair(alpha_z, kappa=0.0, psi=PSI, alpha_theta=0.4, mu=1.0 / 3.0):
    return ReducedPairModel.from_ratios(
        MeshParameters(3e8, kappa, mu, psi), mass=2.882, aspect_ratio=0.3, alpha_y=2.0, alpha_z=alpha_z,
        alpha_theta=alpha_theta,
    )  # fmt: skip


def axial_and_bending_meet():
    """alpha_z at which a mode of the uncoupled pair rises through the frequency of the bending mode, by bisection."""
    bending = mode_table(pair(0.5)).ratio[BENDING]

    def above(alpha):
        return int((mode_table(pair(alpha)).ratio > bending * (1.0 + 1e-14)).sum())

    low, high = 0.5, 5.0
    assert above(low) == above(high) - 1 == BENDING
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if above(middle) == BENDING else (low, middle)
    return 0.5 * (low + high)


@pytest.mark.parametrize("count", [2, 3, 40])
def test_uncoupled_modes_cross_and_keep_their_shapes(count):
    found = follow_modes(pair, np.linspace(0.5, 5.0, count))
    bending = found.shapes[:, :, BENDING]
    assert np.abs(bending[:, [0, 1, 3, 4]]).max() < 1e-8 * np.abs(bending[:, 2]).min(), "rotation about x alone"
    assert found.ratio[:, BENDING] == pytest.approx(np.full(count, found.ratio[0, BENDING]), rel=1e-9)
    met = [meeting for meeting in found.crossings if BENDING in (meeting.first, meeting.second)]
    assert len(met) == 1
    assert met[0].value == pytest.approx(axial_and_bending_meet(), rel=1e-5)
    assert met[0].gap == 0.0
    assert met[0].first < met[0].second
    assert not any(BENDING in (meeting.first, meeting.second) for meeting in found.veerings)


@pytest.mark.parametrize("kappa", [1e-2, 1e-3, 1e-4, 1e-5])
def test_a_coupling_however_weak_makes_them_veer_with_the_gap_of_perturbation_theory(kappa):
    """Where two frequencies would meet, the coupling c of their shapes holds lambda = Lambda^2 apart by 2 c."""
    meet = axial_and_bending_meet()
    plain = pair(meet)
    frequency, shapes = undamped_modes(plain.mass, plain.stiffness)
    ratio = frequency / plain.natural_frequency
    two = np.argsort(np.abs(ratio - mode_table(pair(0.5)).ratio[BENDING]))[:2]
    other = pair(meet, kappa)
    extra = (other.stiffness - plain.stiffness) / plain.natural_frequency**2
    # At the meeting both shapes span one space: the largest coupling in it is that of bending with the other.
    block = shapes[:, two].T @ extra @ shapes[:, two]
    c = float(np.ptp(np.linalg.eigvalsh(block))) / 2.0
    for values in ([0.5, 5.0], np.linspace(0.5, 5.0, 30)):
        found = follow_modes(lambda alpha: pair(alpha, kappa), values)
        assert np.diff(np.sort(found.ratio, axis=1)[:, ::-1] - found.ratio, axis=0) == pytest.approx(0.0, abs=1e-12)
        met = [meeting for meeting in found.veerings if BENDING in (meeting.first, meeting.second)]
        assert len(met) == 1
        assert met[0].first < met[0].second
        assert not found.crossings
        assert met[0].value == pytest.approx(meet, rel=max(3e-3, 20.0 * kappa**2))
        # The trail passes the narrowest place within a fraction of its width.
        assert met[0].gap == pytest.approx(c / ratio[two[0]], rel=0.3)
        # Beyond the veering the branch that was bending moves along the axis.
        last = np.sqrt(pair(5.0).mass) * np.abs(found.shapes[-1, :, BENDING]).T
        assert np.argmax(last) != 2


def test_a_veering_below_the_resolution_is_a_crossing():
    found = follow_modes(lambda alpha: pair(alpha, 0.1 * SAME), [0.5, 5.0])
    assert [meeting.gap for meeting in found.crossings] == [0.0]
    assert np.argmax(np.abs(found.shapes[-1, :, BENDING]) * np.sqrt(pair(5.0).mass)) == 2


@pytest.mark.examples(6, 200)
@given(st.floats(-0.9, 0.9), st.floats(-1.0, 1.0), st.floats(0.1, 3.0), st.integers(2, 60))
def test_branches_do_not_depend_on_the_values_asked_for(kappa, psi, alpha_theta, count):
    def build(alpha):
        return pair(alpha, kappa, psi, alpha_theta, kappa**2 + (1.0 - abs(kappa)) ** 2 / 3.0)

    ends = np.array([0.05, 6.0])
    coarse, fine = follow_modes(build, ends), follow_modes(build, np.linspace(*ends, count))
    assert fine.ratio[[0, -1]] == pytest.approx(coarse.ratio, rel=1e-9, abs=1e-9)
    # Shapes are modes of the model at every value.
    for value, ratio, shapes in zip(fine.values, fine.ratio, fine.shapes, strict=True):
        model = build(value)
        squared = (ratio * model.natural_frequency) ** 2
        residual = model.stiffness @ shapes - model.mass[:, None] * shapes * squared
        assert np.abs(residual / np.sqrt(model.mass)[:, None]).max() < 1e-5 * squared.max()


def test_branches_bear_the_numbers_of_the_value_they_start_from_and_run_both_ways():
    values = np.linspace(0.5, 5.0, 10)
    found = follow_modes(pair, values, start=2.6)
    at_start = mode_table(pair(2.6)).ratio
    again = follow_modes(pair, np.sort(np.append(values, 2.6)), start=2.6)
    (k,) = np.flatnonzero(again.values == 2.6)
    assert again.ratio[k] == pytest.approx(at_start, rel=1e-12)
    assert np.delete(again.ratio, k, axis=0) == pytest.approx(found.ratio, rel=1e-9)
    outside = follow_modes(pair, values, start=0.1)
    assert outside.ratio[0] == pytest.approx(follow_modes(pair, [0.1, 0.5]).ratio[1], rel=1e-9)


def test_a_value_upon_the_crossing_keeps_both_shapes():
    """z and theta_y of a spur pair stand alone: alpha_theta = alpha_z / 2 puts them together exactly."""

    def build(alpha):
        return pair(alpha, psi=0.0, alpha_theta=0.4)

    for start in (0.6, 0.8, 1.0):
        found = follow_modes(build, [0.6, 0.8, 1.0], start=start)
        alone = np.abs(found.shapes) * np.sqrt(build(0.8).mass)[:, None]
        assert (alone.max(axis=1) > 0.8).all()
        moves = np.argmax(alone, axis=1).tolist()
        assert moves[0] == moves[1] == moves[2]
        crossed = [meeting.value for meeting in found.crossings]
        # theta_y and theta_x have frequencies of their own.
        assert crossed == pytest.approx([0.8, (2.0 * mode_table(build(0.6)).ratio[2]) ** 2], rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(60))
def test_branches_of_random_pairs_of_two_gears_do_not_depend_on_the_values_either(seed):
    """Ten coordinates with a rigid-body motion; equal gears have many exact crossings, small kappa narrow veerings."""
    rng = np.random.default_rng(seed)

    def gear(mass, a):
        bearing = np.diag(np.array([6e8, 1.5e8, 2e5, 4e5, 0.0]) * rng.uniform(0.05, 5.0, 5))
        return RigidGear(mass, (0.4 * mass * a**2, 0.5 * mass * a**2, 0.6 * mass * a**2), a, 0.02, bearing)

    one = gear(rng.uniform(1.0, 5.0), 0.07)
    two = one if seed % 2 else gear(rng.uniform(1.0, 5.0), rng.uniform(0.04, 0.12))
    kappa, helix = rng.choice([0.0, 1e-6, 0.2, 0.5]), rng.choice([0.0, 0.3])

    def over_bearings(x):
        i, j = (replace(g, bearing_stiffness=x * g.bearing_stiffness) for g in (one, two))
        return HelicalPairModel(i, j, MeshParameters(3e8, kappa, 0.6, helix))

    build, ends = (
        (lambda x: HelicalPairModel(one, two, MeshParameters(3e8, kappa, 0.6, x)), (0.0, 1.0)),
        (over_bearings, (0.05, 20.0)),
        (lambda x: HelicalPairModel(one, two, MeshParameters(3e8, x, 1.3, helix)), (-1.0, 1.0)),
    )[seed % 3]
    coarse, fine = follow_modes(build, ends), follow_modes(build, np.linspace(*ends, int(rng.integers(3, 40))))
    assert fine.ratio[[0, -1]] == pytest.approx(coarse.ratio, abs=1e-8)
    assert coarse.likeness >= 0.8


def test_a_veering_beside_a_crossing_in_one_step_is_no_crossing():
    """Two modes cross and two others, coupled by 1e-8, veer between the same two values, 6e-7 apart."""
    coupling, t = 1e-8, 3e-7

    def build(value):
        stiffness = np.diag([3.0 + value, 3.0 - value, 1.0 + value, 1.0 - value])
        stiffness[0, 1] = stiffness[1, 0] = coupling
        return SimpleNamespace(mass=np.ones(4), stiffness=stiffness, natural_frequency=1.0)

    found = follow_modes(build, [-t, t])
    off = math.hypot(t, coupling)
    squares = [[3.0 + off, 3.0 - off, 1.0 + t, 1.0 - t], [3.0 + off, 3.0 - off, 1.0 - t, 1.0 + t]]
    assert found.ratio**2 == pytest.approx(np.array(squares), rel=1e-13)
    assert {(one.first, one.second) for one in found.crossings} == {(2, 3)}


def test_values_that_do_not_rise_are_refused():
    for values in ([1.0, 1.0], [2.0, 1.0], [], [1.0, math.nan]):
        with pytest.raises(InputError, match="must be finite and increasing"):
            follow_modes(pair, values)


def two_modes(coupling, places, *, curved=False):
    """States of the matrix [[1 + t, c], [c, 1 - t]]: Lambda^2 = 1 +- root(t^2 + c^2), shapes turned by a quarter.

    Curved: the same distances without a turn, of a matrix that is diagonal all along.
    """
    trail = []
    for t in places:
        off, turn = math.hypot(t, coupling), 0.0 if curved else 0.5 * math.atan2(coupling, t)
        vectors = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        trail.append(_State(t, np.sqrt([1.0 + off, 1.0 - off]), vectors, np.empty(0), np.ones(2)))
    return trail


@pytest.mark.parametrize(
    ("coupling", "low", "high", "curved", "found"),
    [
        (0.02, -20.0, 20.0, False, True),
        (0.02, -2.0, 20.0, False, False),  # only after it are they four times as far apart
        (0.02, -20.0, 3.0, False, False),  # only before it
        (0.02, -20.0, 20.0, True, False),  # near each other, and each keeps its shape
        (0.1, -5.0, 5.0, False, True),  # 0.1001 of 1.0488 is less than a tenth
        (0.12, -5.0, 5.0, False, False),
    ],
)
def test_veerings_are_narrow_exchange_shapes_and_are_seen_from_both_sides(coupling, low, high, curved, found):
    places = coupling * np.array([low, 0.5 * low, -1.0, -0.3, 0.0, 0.2, 0.9, 0.5 * high, high])
    trail = two_modes(coupling, np.unique(places), curved=curved)
    crossings, veerings = _meetings(trail)
    assert not crossings
    gap = math.sqrt(1.0 + coupling) - math.sqrt(1.0 - coupling)
    assert veerings == ([(0.0, 0, 1, pytest.approx(gap))] if found else [])
