"""Tooth friction: the two formulas of TM-100180, the torques they make, and the losses that follow."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.dynamics.motion.motion_model import MotionModel, friction_loss_torque
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.charts import FourInertia
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.friction import friction_over_path, with_friction
from fegear.dynamics.train.friction_law import benedict_kelley, buckingham
from fegear.dynamics.train.gear_train import TrainMesh, a_drives
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Mesh
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

INCH, POUND = 0.0254, 4.4482216152605
BASE, ANGLE = 0.04177, math.radians(20.0)
PITCH = 2 * math.pi * BASE / 28
FORCE = 8890.0


def test_buckingham():
    """(17) with V in in/s: 0.05 at rest, by hand at 40 in/s; the sign of the sliding does not matter."""
    assert buckingham(0.0) == pytest.approx(0.05)
    assert buckingham(-40 * INCH) == pytest.approx(0.05 * math.exp(-5) + 0.002 * math.sqrt(40))


def test_benedict_kelley():
    """(18) by hand in lb/in, lb s/in^2 and in/s, and Benedict and Kelley's own 3.17e8 in cP."""
    reyn = POUND / INCH**2
    mu, vs, vr, w = 0.02, 1.5, 12.0, 3.5e5
    by_hand = 0.0127 * math.log10(45.94 * (w * INCH / POUND) / ((mu / reyn) * (vs / INCH) * (vr / INCH) ** 2))
    original = 0.0127 * math.log10(3.17e8 * (w * INCH / POUND) / ((mu * 1e3) * (vs / INCH) * (vr / INCH) ** 2))
    assert benedict_kelley(w, mu, vs, vr) == pytest.approx(by_hand, rel=1e-12)
    assert by_hand == pytest.approx(original, rel=1e-3)
    assert benedict_kelley(w, mu, 0.0, vr) == 0.2  # no bound where sliding stops: held
    assert benedict_kelley(0.0, mu, vs, vr) == 0.0
    with pytest.raises(RangeError, match="viscosity"):
        benedict_kelley(w, 0.0, vs, vr)


def plain(length=1.6):
    half = 0.5 * length * PITCH
    return MeshExcitation.from_tooth_pair(
        lambda x: 3e8 * np.ones_like(x), lambda x: np.zeros_like(x), -half, half, PITCH
    )


def train(shaft_ratio=0.05):
    j = 1.22e-3
    system = FourInertia(10 * j, j, j, 10 * j, 2.18e4, 2.18e4, BASE, BASE, 28, 28, FORCE, shaft_ratio, 0.1)
    return system.train(1 / plain().mean_compliance())


def rubbed(mu, speed=300.0):
    found = train()
    return with_friction(
        plain(), found.meshes[0], PITCH, ANGLE, float(found.mesh_frequencies(speed)[0]), FORCE, lambda *_: mu
    )


def test_lever_arms_and_signs():
    """At x before the pitch point (approach) friction helps the driver along its own rolling, after it friction brakes.

    Torque on the driver is -sign(x) mu W (R tan a + x), on the driven gear sign(x) mu W (R tan a - x).
    """
    found = rubbed(0.05)
    for j, (on_a, on_b) in enumerate(found.friction):
        s = np.linspace(0.02, 0.98, 25)
        x = (s + found.first_slot + j) * PITCH
        there = found.stiffness[j](s) > 0
        expected_a = -np.sign(x) * 0.05 * (BASE * math.tan(ANGLE) + x)
        expected_b = np.sign(x) * 0.05 * (BASE * math.tan(ANGLE) - x)
        assert on_a(s)[there] == pytest.approx(expected_a[there], abs=1e-9)
        assert on_b(s)[there] == pytest.approx(expected_b[there], abs=1e-9)


def test_loss_is_the_sliding_work():
    """Loss = mean of mu W |v_s|; both gears turn at w, the loss torque is that over w, taken off the load."""
    speed, mu = 300.0, 0.05
    found = MotionModel(train(), (rubbed(mu, speed),), speed)
    s = np.linspace(0, 1, 20_001)[:-1]
    exc = found.excitations[0]
    error = exc.approach(FORCE, s)
    power = 0.0
    for j, k in enumerate(exc.stiffness):
        x = (s + exc.first_slot + j) * PITCH
        power += np.mean(k(s) * error * mu * np.abs(2 * speed * x))
    extra = friction_loss_torque(found)
    assert extra[:3].tolist() == [0.0, 0.0, 0.0]
    assert extra[3] == pytest.approx(power / speed, rel=2e-3)


def test_friction_ripples_the_torque_and_vanishes_with_its_coefficient():
    speed = 300.0
    dry = steady_state(MotionModel(train(), (plain(),), speed), tolerance=1e-7)
    differences = []
    for mu in (0.0, 0.02, 0.04):
        wet = steady_state(MotionModel(train(), (rubbed(mu, speed),), speed), tolerance=1e-7)
        assert wet.kind == "periodic"
        twist = wet.trajectory(1)
        t = np.linspace(0, wet.model.period, 200)[1:-1]
        base = dry.trajectory(1)
        ripple = [np.ptp(r.angles(t)[:, 0] - r.angles(t)[:, 1]) for r in (twist, base)]
        differences.append(np.max(np.abs(twist.mesh_forces(t) - base.mesh_forces(t))) / FORCE)
        assert np.isfinite(ripple).all()
    assert differences[0] < 1e-6
    assert 1e-4 < differences[1] < differences[2]
    assert differences[2] / differences[1] == pytest.approx(2.0, rel=0.2)


def test_real_coefficients_run():
    speed = 10_000 * math.pi / 30
    found = train()
    frequency = float(found.mesh_frequencies(speed)[0])
    laws = (lambda v, _r, _w: buckingham(v), lambda v, r, w: benedict_kelley(w / 0.0254, 0.02, v, r))
    for law in laws:
        exc = with_friction(plain(), found.meshes[0], PITCH, ANGLE, frequency, FORCE, law, tolerance=1e-5)
        state = steady_state(MotionModel(found, (exc,), speed), tolerance=1e-5)
        assert 1.0 < state.dynamic_factor[0] < 4.0
    with pytest.raises(InputError, match="tooth pairs"):
        with_friction(
            MeshExcitation.from_mesh(Periodic.constant(3e8)), found.meshes[0], PITCH, ANGLE, frequency, FORCE, laws[0]
        )


def vectors(mesh, a_drives, x, turn_a):
    """Torques on both bodies per newton across the flanks at x from the pitch point toward the driver's tip.

    Gear a at the origin and gear b beside it, velocities as cross products, friction against the sliding.
    """
    ra, rb = abs(mesh.radius_a), abs(mesh.radius_b)
    centre = np.array([(ra + rb) / math.cos(ANGLE), 0.0])
    pitch = np.array([ra / math.cos(ANGLE), 0.0])
    turn_b = -turn_a * ra / rb

    def across(w, v):
        return w * np.array([-v[1], v[0]])

    # the driver pushes the driven gear away from itself and the way that both move at the pitch point
    away = math.sin(ANGLE) if a_drives else -math.sin(ANGLE)
    push = np.array([away, math.copysign(math.cos(ANGLE), turn_a)])
    point = pitch + x * push
    normal_on_b = push if a_drives else -push
    sliding = across(turn_a, point) - across(turn_b, point - centre)
    sliding -= (sliding @ push) * push
    rub_b = sliding / np.linalg.norm(sliding)  # a drags b along

    def torque(arm, force):
        return arm[0] * force[1] - arm[1] * force[0]

    normal = torque(point, -normal_on_b), torque(point - centre, normal_on_b)
    return normal, (torque(point, -rub_b), torque(point - centre, rub_b))


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.75])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("a_drives", [True, False])
def test_either_body_may_drive(a_drives, sign, ratio):
    """Against plane vectors, for gears of any ratio, both senses of rotation, and either body driving."""
    mesh = Mesh("g", "a", "b", sign * BASE, sign * ratio * BASE, 28, round(28 * ratio), 3e8)
    found = with_friction(plain(1.4), mesh, PITCH, ANGLE, 500.0, FORCE, lambda *_: 0.05, a_drives=a_drives)
    # the gears approach as body a turns with its radius, or body b: whoever drives turns that way
    turn_a = sign * 100.0 if a_drives else -sign * 100.0
    power = 0.0
    for j, pair in enumerate(found.friction):
        for s in (0.05, 0.31, 0.77, 0.94):
            x = (s + found.first_slot + j) * PITCH
            if not found.stiffness[j](s) > 0.0:
                continue
            normal, rub = vectors(mesh, a_drives, x, turn_a)
            assert normal == pytest.approx((-mesh.radius_a, -mesh.radius_b), rel=1e-9)
            got = [float(f(s)) for f in pair]
            np.testing.assert_allclose(got, 0.05 * np.array(rub), rtol=1e-6)
            power += got[0] * turn_a - got[1] * turn_a / ratio
    assert power < 0.0


def test_friction_made_for_the_wrong_driver_is_refused():
    """A friction that feeds power into the train has the driver wrong."""
    right = train()
    meshes = tuple(replace(m, radius_a=-m.radius_a, radius_b=-m.radius_b) for m in right.meshes)
    turned = replace(right, torques=tuple(replace(t, value=-t.value) for t in right.torques), meshes=meshes)
    assert (a_drives(right), a_drives(turned)) == ((True,), (False,))
    frequency = float(turned.mesh_frequencies(300.0)[0])
    for drives in (True, False):
        found = with_friction(
            plain(), turned.meshes[0], PITCH, ANGLE, frequency, FORCE, lambda *_: 0.05, a_drives=drives
        )
        model = MotionModel(turned, (found,), 300.0)
        if drives:
            with pytest.raises(InputError, match="adds power to the train: with these torques the"):
                friction_loss_torque(model)
        else:
            assert friction_loss_torque(model)[3] > 0.0  # the load, which drives now, gives more


def loaded(ratio=1.0, a_drives=True):
    """A gear pair at work in a train, of real gears and springs of one stiffness."""
    steel = Material(206.8e9, 0.3, 7850.0)
    made = [
        Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25, ANGLE)), 3.175e-3, 0.01, 0.0254, steel, "strain")
        for z in (28, round(28 * ratio))
    ]
    pair = GearPair(*made)
    springs = MeshExcitation.from_tooth_pair(
        lambda x: 3e8 * np.ones_like(x), lambda x: np.zeros_like(x), pair.x_start, pair.x_end, pair.base_pitch
    )
    return TrainMesh.under(pair, springs, FORCE, a_drives=a_drives)


def buckingham_law(sliding, _rolling, _force):
    return buckingham(sliding)


@pytest.mark.parametrize("ratio", [1.0, 2.5])
def test_friction_over_the_path_in_closed_form(ratio):
    """A constant coefficient: mu W |v_s| of the sharing pairs by quadrature, torques by lever arms, power by both."""
    mesh, mu, frequency = loaded(ratio), 0.06, 2000.0
    pair = mesh.pair
    found = friction_over_path(mesh, frequency, lambda v, *_: np.full(np.shape(v), mu), 301)
    w_1 = frequency * 2 * math.pi / pair.driver.teeth
    w_2 = w_1 * pair.driver.teeth / pair.driven.teeth
    np.testing.assert_allclose(found.sliding, (w_1 + w_2) * found.x, atol=1e-9)
    # one pair's friction takes mu W |v_s| at every place
    taken = -(found.torque_driver * w_1 + found.torque_driven * w_2)
    np.testing.assert_allclose(taken, mu * found.load * np.abs(found.sliding), rtol=1e-9, atol=1e-6)
    # equal springs: half the load where two pairs touch, all of it where one does
    x = np.linspace(pair.x_start, pair.x_end, 200_001)
    alone = (x > pair.x_lpstc) & (x < pair.x_hpstc)
    mean = np.trapezoid(mu * np.where(alone, 1.0, 0.5) * FORCE * (w_1 + w_2) * np.abs(x), x) / pair.base_pitch
    assert found.loss == pytest.approx(mean, rel=1e-4)
    assert found.mean_coefficient == pytest.approx(mu, rel=1e-12)
    assert found.loss_error < 1.001e-9 * found.loss  # what the fit of the teeth leaves counts 1e-9
    assert found.power == pytest.approx(FORCE * w_1 * pair.driver.base_radius)
    # both pairs together: the pair one base pitch behind or ahead
    k = int(np.argmin(np.abs(found.x - 0.9 * pair.x_end)))
    other = np.interp(found.x[k] - pair.base_pitch, found.x, found.torque_driver)
    assert found.total_driver[k] == pytest.approx(found.torque_driver[k] + other, rel=1e-3)


def test_friction_over_the_path_is_the_friction_of_the_motion():
    """The same torques as the springs in motion have, for laws that depend on sliding, rolling and load."""
    mesh, train_mesh = loaded(1.0), Mesh("g", "a", "b", 1.0, 1.0, 28, 28, 3e8)
    train_mesh = replace(train_mesh, radius_a=mesh.pair.driver.base_radius, radius_b=-mesh.pair.driven.base_radius)
    for law in (buckingham_law, lambda v, r, w: benedict_kelley(w / 0.0254, 0.02, v, r)):
        found = friction_over_path(mesh, 1500.0, law)
        rubbed = with_friction(
            mesh.excitation, train_mesh, mesh.pair.base_pitch, mesh.pair.working_pressure_angle, 1500.0, FORCE, law,
            tolerance=1e-9,
        )  # fmt: skip
        place = found.x / mesh.pair.base_pitch
        clear = np.flatnonzero(np.abs(place) > 0.02)
        for k in clear[::17]:
            slot = math.floor(place[k]) - rubbed.first_slot
            on_a, on_b = (float(f(place[k])) * found.load[k] for f in rubbed.friction[slot])
            assert on_a == pytest.approx(found.torque_driver[k], rel=1e-5)
            assert on_b == pytest.approx(found.torque_driven[k], rel=1e-5)


def test_friction_over_the_path_of_coupled_teeth_is_refused():
    mesh = replace(loaded(), excitation=MeshExcitation.from_mesh(Periodic.constant(3e8)))
    with pytest.raises(InputError, match="tooth pairs"):
        friction_over_path(mesh, 1500.0, buckingham_law)


def test_no_friction_no_torque():
    found = friction_over_path(loaded(), 1500.0, lambda v, *_: np.zeros_like(v))
    assert not np.any(found.torque_driver)
    assert (found.loss, found.mean_coefficient) == (0.0, 0.0)
