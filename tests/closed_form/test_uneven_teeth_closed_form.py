"""Spacing errors in motion: what they excite, against load sharing itself, even teeth and the linear train."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import revolution
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.mesh_excitation import mesh_excitation, tooth_pair_at
from fegear.dynamics.train.mesh_force_spectrum import mesh_force_spectrum
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.tooth_force import dynamic_error
from fegear.dynamics.train.train import Body, Damper, Mesh, Torque, Train
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

GEAR = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3.175e-3, 20e-3, 25.4e-3)
PAIR = GearPair(GEAR, GEAR)
LOAD = 9000.0
#: Accumulated errors of five teeth in turn [m], a tenth of the teeth's deflection.
ERRORS = np.array([0.0, 1.2e-6, -0.7e-6, 0.4e-6, -1.5e-6])


def uneven(**changes):
    source = closed_form_compliance(GEAR, "cornell")
    return Engagement(PairCompliance(PAIR, source, source, False, "load-dependent"), driver_spacing=ERRORS, **changes)


def amplitudes(error, count):
    return 2.0 * np.abs(error.fourier(np.arange(1, count + 1)))


@pytest.mark.parametrize(
    ("corner", "rtol"),
    # teeth that stand alone are linear about the full load on one pair; off the path load sharing itself is fitted
    [(False, 0.04), pytest.param(True, 1e-3, marks=pytest.mark.long)],
)
def test_rotational_harmonics_are_those_of_load_sharing(corner, rtol):
    engagement = uneven(corner_contact=corner)
    error = mesh_excitation(engagement, LOAD).transmission_error(LOAD, tolerance=1e-9)
    assert error.pitches == ERRORS.size
    expected = revolution(engagement, LOAD, ERRORS.size, 15).amplitude[:15]
    np.testing.assert_allclose(amplitudes(error, 15), expected, atol=rtol * expected.max())
    # number 5 of five pitches is the tooth-mesh frequency, where even teeth have theirs as well
    even = mesh_excitation(replace(engagement, driver_spacing=np.empty(0)), LOAD)
    even = even.transmission_error(LOAD, tolerance=1e-9)
    assert even.pitches == 1
    assert np.delete(amplitudes(error, 5), 4).max() > 0.05 * amplitudes(even, 1)[0]


@pytest.mark.dear
@pytest.mark.parametrize("number", [4, *(pytest.param(n, marks=pytest.mark.long) for n in (-1, 0, 1, 2, 3))])
def test_every_tooth_pair_has_its_own_force(number):
    """k (zeta - e) of the pair that is at the pitch point in base pitch `number`: what load sharing gives it."""
    engagement = uneven(corner_contact=True)
    excitation = mesh_excitation(engagement, LOAD)
    x = np.array([-0.7, -0.3, 0.2, 0.45, 0.7]) * PAIR.base_pitch
    k, m = tooth_pair_at(excitation, x, PAIR.base_pitch, number)
    force = k * (excitation.transmission_error(LOAD, tolerance=1e-9)(x / PAIR.base_pitch + number) - m)
    expected = []
    for place in x:
        reduced = float(engagement.meshing.reduced(place))
        rows = round((place - reduced) / PAIR.base_pitch)
        state = engagement.solve(engagement.grid([reduced]), [LOAD], number + rows)
        expected.append(state.loads[list(state.grid.contacts.number).index(rows), 0, 0])
    np.testing.assert_allclose(force, expected, atol=2e-5 * LOAD)


def train(zeta=0.1):
    """Damped to the ground, as Mark's rig is: his increments know no damping of the mesh itself."""
    inertia, radius, k = 1.2e-3, GEAR.base_radius, 3.0e8
    damping = 2.0 * zeta * math.sqrt(2.0 * k * radius**2 * inertia)
    return Train(
        bodies=(Body("a", inertia), Body("b", inertia)),
        meshes=(Mesh("I", "a", "b", radius, radius, 28, 28, k),),
        dampers=tuple(Damper(name, None, damping) for name in "ab"),
        torques=(Torque("a", LOAD * radius), Torque("b", LOAD * radius)),
    )


@pytest.mark.parametrize("backlash", [math.inf, 2e-6])
def test_joined_copies_change_nothing(backlash):
    even = mesh_excitation(replace(uneven(), driver_spacing=np.empty(0)), LOAD)
    parts = (even.stiffness, even.separation)
    stiffness, separation = (tuple(Periodic.joined([f] * 3) for f in part) for part in parts)
    thrice = replace(even, stiffness=stiffness, separation=separation)
    rig = train(zeta=0.02)
    rig = replace(rig, meshes=(replace(rig.meshes[0], backlash=backlash),))
    speed = 1.1 * 2.0 * math.pi * modes(rig).frequencies[-1] / 28
    one, three = (steady_state(MotionModel(rig, (e,), speed), tolerance=1e-8) for e in (even, thrice))
    assert (one.behind[0] > 0.0) == (backlash < 1.0)  # a resonance that hammers both flanks where it can
    assert three.model.period == pytest.approx(3.0 * one.model.period, rel=1e-14)
    assert three.largest == pytest.approx(one.largest, rel=1e-6)
    assert three.smallest == pytest.approx(one.smallest, rel=1e-6)


def test_motion_that_grows_for_ever_is_named():
    """Teeth that touch on either flank with hardly any play are a spring that the mesh frequency pumps."""
    even = mesh_excitation(replace(uneven(), driver_spacing=np.empty(0)), LOAD)
    rig = train(zeta=0.006)
    rig = replace(rig, meshes=(replace(rig.meshes[0], backlash=2e-6),))
    speed = 1.2 * 2.0 * math.pi * modes(rig).frequencies[-1] / 28
    state = steady_state(MotionModel(rig, (even,), speed), tolerance=1e-6)
    assert state.kind == "growing"
    assert state.multiplier > 1.01


@pytest.mark.long
def test_linear_motion_has_the_spectrum_of_the_linear_train():
    """Constant stiffness and an uneven transmission error: shooting over five pitches against Fourier, line by line."""
    error = mesh_excitation(uneven(), LOAD).transmission_error(LOAD, tolerance=1e-9)
    rig, speed = train(), 650.0
    # constant stiffness: all that is uneven is in the transmission error
    flat = MeshExcitation.from_mesh(Periodic.constant(rig.meshes[0].stiffness), error.plus(-error.mean))
    state = steady_state(MotionModel(rig, (flat,), speed), tolerance=1e-9)
    phase = np.linspace(0.0, 5.0, 20_001)[1:-1]
    # (1 + Q) alpha falls like n^-3, the force itself has the jumps of the transmission error
    smooth = dynamic_error(rig, [error], 0, 0, speed, phase, 1000)
    force = LOAD + rig.meshes[0].stiffness * (smooth - error(phase) + error.mean)
    assert state.changes == 0
    assert state.largest[0] == pytest.approx(force.max(), rel=1e-4)
    assert state.smallest[0] == pytest.approx(force.min(), rel=1e-4)


def test_lines_of_even_teeth_stay_among_the_rotational_ones():
    error = mesh_excitation(uneven(), LOAD).transmission_error(LOAD, tolerance=1e-9)
    every = mesh_force_spectrum(train(), [error], [650.0], 20, rotational=True)
    mesh = mesh_force_spectrum(train(), [error], [650.0], 20)
    assert every.orders[:5] == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    assert every.present.all()
    np.testing.assert_allclose(mesh.coefficients, every.coefficients[:, :, 4::5], rtol=1e-12)
    np.testing.assert_allclose(mesh.frequencies, every.frequencies[:, 4::5], rtol=1e-12)


def test_only_functions_of_one_base_pitch_are_joined():
    with pytest.raises(InputError, match="one base pitch"):
        Periodic.joined([Periodic.joined([Periodic.constant(1.0)] * 2)])
    with pytest.raises(InputError, match="one base pitch"):
        Periodic.joined([])
