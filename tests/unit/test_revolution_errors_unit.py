"""Errors of a motion over a revolution: from a motion beside it that differs by known amounts."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.sidebands import without_mesh_harmonics
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.motion_over_revolution import MotionOverRevolution
from fegear.dynamics.motion.revolution_errors import revolution_errors, softer
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.mesh_resonance import MeshResonance, mesh_resonance
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Shaft, Train
from fegear.engine.answered import Deciding
from fegear.results.train.mesh_resonance_said import resonance_said

PITCHES, SAMPLES, PARTS = 11, 64, 8
PAIR = SimpleNamespace(gear=lambda member: SimpleNamespace(teeth=PITCHES))


def motion(stretch=1.0, ripple=0.0):
    """A pulse in one base pitch, and a vibration that passes through zero, with a change that does so, too."""
    fine = np.arange(PITCHES * SAMPLES * PARTS) / (SAMPLES * PARTS)
    usual = 3.0 + np.cos(2.0 * np.pi * fine)
    pulse = np.exp(-(((fine - 4.53) / 0.1) ** 2))
    te = stretch * (usual + pulse) + ripple * np.sin(8.0 * np.pi * fine)
    force = 10.0 * te
    even = te[::PARTS]
    return MotionOverRevolution(
        PAIR, PITCHES, 1.0, 1, True, fine[::PARTS], fine[::PARTS], even, without_mesh_harmonics(even, PITCHES),
        10.0 * even, -even, fine_te=te, fine_force=force,
    )  # fmt: skip


def test_curves_have_the_largest_change_of_half_a_base_pitch_on_either_side():
    found = revolution_errors(motion(), motion(ripple=0.01), 0.0, 0.0)
    np.testing.assert_allclose(found.te, 0.01, rtol=1e-9)  # also where the change passes through zero
    np.testing.assert_allclose(found.force, 0.1, rtol=1e-9)
    np.testing.assert_allclose(found.te_change, 0.0, atol=1e-12)  # all base pitches have it
    assert found.te_order[4 * PITCHES - 1] == pytest.approx(0.01, rel=0.2)  # beside a line of the pulse


def test_maxima_have_what_softer_teeth_odd_teeth_and_samples_leave_open():
    here, there = motion(), motion(1.001)
    found = revolution_errors(here, there, 0.0, 0.0)
    for key in ("mesh_force_max", "mesh_force_max_ordinary", "dynamic_te_change_max", "dynamic_te_residual_max"):
        change = getattr(there, key) - getattr(here, key)
        assert change == pytest.approx(1e-3 * getattr(here, key), rel=1e-6)
        assert change <= getattr(found, key) < change + 2e-4 * getattr(here, key)  # the samples beside a maximum
    own = revolution_errors(here, there, 0.05, 0.0)
    assert own.dynamic_te_change_max >= 0.05 * here.dynamic_te_change_max
    assert own.mesh_force_max == found.mesh_force_max
    assert own.indicators.residual_rms == pytest.approx(0.05 * here.indicators.residual_rms)
    assert own.indicators.m6a == pytest.approx(0.1 * here.indicators.m6a)
    tolerant = revolution_errors(here, here, 0.0, 1e-3)
    assert tolerant.te == pytest.approx(1e-3 * here.te.max())
    assert tolerant.mesh_force_max >= 1e-3 * here.mesh_force_max


def test_a_maximum_at_a_jump_has_no_error_of_the_jump():
    """What half of the samples miss, not the height of the jump."""
    here = motion()
    s = np.arange(here.fine_force.size) / here.fine_force.size
    jump = np.where(s < 0.3, 100.0 - s, 0.0)
    found = revolution_errors(
        *(MotionOverRevolution(**{**vars_of(here), "fine_force": jump}) for _ in range(2)), 0.0, 0.0
    )
    assert found.mesh_force_max == pytest.approx(1.0 / here.fine_force.size, rel=1e-6)


def vars_of(found):
    return {name: getattr(found, name) for name in found.__dataclass_fields__}


def test_softer_teeth_deflect_more_by_their_relative_error():
    mesh = Mesh("I", "a", "b", 0.1, 0.2, 20, 40, 5e8, 0.07)
    train = Train((Body("a", 1e-3), Body("b", 2e-3)), (), (mesh,))
    model = MotionModel(train, (MeshExcitation.from_mesh(Periodic.constant(5e8)),), 100.0)
    assert softer(model, [0.25]).excitations[0].approach(4e8, 0.0) == pytest.approx(1.0)
    assert softer(model, [0.0]).excitations[0].approach(4e8, 0.0) == pytest.approx(0.8)


def test_a_mesh_resonates_where_a_harmonic_meets_the_mode_of_two_bodies():
    """By the closed form of two bodies, one spring; speeds are those of the second body."""
    mesh = Mesh("I", "a", "b", 0.1, 0.2, 20, 40, 5e8, 0.07)
    train = Train((Body("a", 1e-3), Body("b", 2e-3)), (), (mesh,))
    data = SimpleNamespace(train=train, speed_ratio=0.5)
    natural = math.sqrt(5e8 * (0.1**2 / 1e-3 + 0.2**2 / 2e-3)) / (2.0 * math.pi)
    speed = 2.0 * math.pi * natural / 20 * 0.5
    for at, harmonic, off, near in (
        (1.1 * speed, 1, 0.1, True), (0.8 * speed, 1, -0.2, False), (speed / 2.9, 3, 3 / 2.9 - 1.0, True),
        (speed / 2.4, 2, 2 / 2.4 - 1.0, False), (3.0 * speed, 1, 2.0, False),
    ):  # fmt: skip
        found = mesh_resonance(data, 0, at)
        assert (found.frequency, found.speed) == pytest.approx((natural, speed), rel=1e-9)
        assert (found.frequency_error, found.speed_error) == (None, None)
        softer_by = replace(found, doubt=1e-3)  # the frequency goes with the root of the stiffness
        assert softer_by.frequency_error == pytest.approx(natural * (1.0 - 1.0 / math.sqrt(1.001)), rel=1e-3)
        assert softer_by.speed_error == pytest.approx(speed * (1.0 - 1.0 / math.sqrt(1.001)), rel=1e-3)
        assert (found.harmonic, found.near) == (harmonic, near)
        assert (found.off, found.at) == pytest.approx((off, speed / harmonic), rel=1e-9)


def test_the_half_power_band_of_a_damped_mode_is_near():
    """Two bodies whose mesh alone is damped: c = 2 zeta k / omega."""
    omega = math.sqrt(5e8 * (0.1**2 / 1e-3 + 0.2**2 / 2e-3))
    speed = omega / 20
    for zeta, at, near in (
        (0.0, speed / 3.0 * 1.06, False), (0.07, speed / 3.0 * 1.06, True), (0.07, speed / 3.0 * 1.08, False),
        (0.07, speed / 3.0 * 0.94, True), (0.5, speed / 2.0 * 1.16, False), (0.5, speed * 1.16, False),
        (0.0, speed * 1.14, True), (0.0, speed / 3.0 * 1.04, True),
    ):  # fmt: skip
        mesh = Mesh("I", "a", "b", 0.1, 0.2, 20, 40, 5e8, 2.0 * zeta * 5e8 / omega)
        train = Train((Body("a", 1e-3), Body("b", 2e-3)), (), (mesh,))
        found = mesh_resonance(SimpleNamespace(train=train, speed_ratio=1.0), 0, at)
        assert found.damping == pytest.approx(zeta, rel=1e-9, abs=1e-15)
        assert found.near is near, (zeta, at / speed)


def test_the_mode_of_the_mesh_is_that_in_which_its_teeth_deform():
    """Not that of a soft shaft, whose frequency is far below."""
    train = Train(
        (Body("m", 1e-3), Body("a", 1e-3), Body("b", 1e3)), (Shaft("s", "m", "a", 1.0),),
        (Mesh("I", "a", "b", 0.1, 0.2, 20, 40, 5e8, 0.07),),
    )  # fmt: skip
    found = mesh_resonance(SimpleNamespace(train=train, speed_ratio=1.0), 0, 10.0)
    assert found.frequency == pytest.approx(math.sqrt(5e8 * 0.01 / 1e-3) / (2.0 * math.pi), rel=1e-3)


def test_the_nearest_resonance_is_said_with_what_occurs_at_the_speed():
    rpm = 2.0 * math.pi / 60.0
    far = MeshResonance(2, 1500.0 * rpm, -0.2, 800.0, 3000.0 * rpm)
    assert list(resonance_said("I", None, 1.0)) == []
    (said,) = resonance_said("I", far, 1200.0 * rpm)
    assert isinstance(said, Deciding)
    assert said == (
        "Mesh I: resonance nearest to 1200 rpm: harmonic 2 of the mesh frequency meets a natural frequency at 1500 rpm "
        "(+25 %); the mesh frequency meets 800 Hz at 3000 rpm."
    )
    (said,) = resonance_said("I", replace(far, off=0.01), 1515.0 * rpm, "the maximum")
    assert said.startswith("Mesh I: the maximum, at 1515 rpm, is near a resonance: harmonic 2 of")
    (said,) = resonance_said("I", far, 1200.0 * rpm, "the maximum")
    assert said.startswith("Mesh I: resonance nearest to the maximum, at 1200 rpm: harmonic 2 of")
