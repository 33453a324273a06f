"""The averaging iteration of TM-100180: its rate in closed form, an own solver of n intervals, its limits."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

from fegear.dynamics.motion.averaging import averaged_motion
from fegear.dynamics.motion.motion import propagate
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.motion.shooting import close
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Torque, Train, mesh_damping

R, J, K, FORCE = 0.05, 2e-3, 2e8, 500.0
NATURAL = math.sqrt(2 * K * R * R / J)
DEFLECTION = FORCE / K


def fitted(function):
    return Periodic.fit(function, degree=10, tolerance=1e-12)


def two_discs(ratio, *, zeta=0.02, depth=0.0, error=0.0, parting=True, backlash=math.inf):
    """Two discs at a mesh frequency of `ratio` natural frequencies, stiffness and error of one harmonic each."""
    train = Train(
        (Body("1", J), Body("2", J)),
        meshes=(Mesh("g", "1", "2", R, R, 30, 30, K, mesh_damping(zeta, K, R, R, J, J), backlash),),
        torques=(Torque("1", FORCE * R), Torque("2", FORCE * R)),
    )
    stiffness = fitted(lambda s: K * (1 + depth * np.cos(2 * np.pi * s)))
    separation = fitted(lambda s: error * DEFLECTION * np.cos(2 * np.pi * s + 1.0))
    found = MeshExcitation.from_mesh(stiffness, separation)
    return MotionModel(train, (found if parting else found.never_parting(FORCE),), ratio * NATURAL / 30)


@pytest.mark.parametrize(
    ("ratio", "zeta"), [(1.0, 0.02), (1.0, 0.1), (0.5, 0.02), (0.7, 0.02), (1.6, 0.05), (2.0, 0.01)]
)
def test_a_vibration_shrinks_by_the_mean_of_one_and_its_multiplier(ratio, zeta):
    """Differences of a linear oscillator: |rho - 1| |(1 + rho)/2|^k, so many repetitions and no more."""
    moves = two_discs(ratio, zeta=zeta, error=0.2, parting=False)
    found, nearer = averaged_motion(moves, tolerance=1e-4), averaged_motion(moves, tolerance=1e-8)
    rate = abs(1 + np.exp((-zeta + 1j * math.sqrt(1 - zeta**2)) * 2 * math.pi / ratio)) / 2
    assert nearer.kind == "periodic"
    # the larger of coordinate and speed is known to the square root of two at both ends
    expected = math.log(1e-4) / math.log(rate)
    assert abs(nearer.followed - found.followed - expected) <= 1 + math.log(2.0) / -math.log(rate)
    exact = steady_state(moves, tolerance=1e-6).dynamic_factor[0]
    assert abs(found.dynamic_factor[0] - exact) <= 1.5 * found.off + 1e-7
    assert abs(nearer.dynamic_factor[0] - exact) < 1e-6


def test_near_resonance_it_takes_longer_and_does_not_stall():
    """A tenth of critical damping, TM-89901's: some 40 periods where waiting takes 20, not hundreds."""
    at = {
        ratio: averaged_motion(two_discs(ratio, zeta=0.1, error=0.2, parting=False), tolerance=1e-5)
        for ratio in (1.0, 2.0)
    }
    assert 3 * at[2.0].followed < at[1.0].followed < 60
    assert {one.kind for one in at.values()} == {"periodic"}


def test_without_damping_at_resonance_it_is_given_up():
    told, moves = [], two_discs(1.0, zeta=1e-6, error=0.01, parting=False)
    found = averaged_motion(moves, tolerance=1e-6, repetitions=240, progress=told.append)
    assert (found.kind, found.followed, found.periods) == ("not settled", 240, 0)
    assert told == [100 / 240, 200 / 240]
    assert found.per_period.shape == (100, 1)
    assert found.residual > 1e-3
    assert found.quantile(0.0)[0] <= found.tooth_force[0]


def printed_iteration(model, intervals, tolerance):
    """As printed: n equal intervals with constant coefficients, each solved exactly, start and end averaged.

    Own equations of one mesh, x = its approach over the static deflection, in the time of the oscillator.
    """
    ratio = model.speed * 30 / NATURAL
    zeta = model.train.meshes[0].damping * NATURAL / (2 * K)
    (stiffness,), (separation,) = model.excitations[0].stiffness, model.excitations[0].separation
    s = (np.arange(intervals) + 0.5) / intervals
    k, e, h = stiffness(s) / K, separation(s) / DEFLECTION, 2 * math.pi / ratio / intervals
    y, force = np.array([1.0, 0.0]), np.zeros(intervals)
    for count in range(1, 2000):
        start = y
        for n in range(intervals):
            touch = y[0] > e[n]
            now, drag = (k[n], 2 * zeta) if touch else (0.0, 0.0)
            force[n] = now * (y[0] - e[n]) + drag * y[1]
            system = np.array([[0.0, 1.0, 0.0], [-now, -drag, 1.0 + now * e[n]], [0.0, 0.0, 0.0]])
            y = (expm(system * h) @ [*y, 1.0])[:2]
        if np.max(np.abs(y - start)) < tolerance:
            return count, float(np.max(force))
        y = 0.5 * (start + y)
    return count, math.nan


@pytest.mark.parametrize("ratio", [0.7, 1.1])
def test_the_printed_intervals_come_to_the_same_motion(ratio):
    """With contact loss above resonance: the more intervals the nearer, after about as many repetitions."""
    moves = two_discs(ratio, zeta=0.05, depth=0.3, error=0.3)
    found = averaged_motion(moves, tolerance=1e-4)
    misses = []
    for intervals in (60, 240):
        count, factor = printed_iteration(moves, intervals, 1e-4)
        assert abs(count - found.followed) <= 0.3 * found.followed + 2
        misses.append(abs(factor - found.dynamic_factor[0]))
    assert misses[1] < 0.4 * misses[0]
    assert misses[1] < 0.02 * found.dynamic_factor[0]
    if ratio == 1.1:
        assert found.apart[0] > 0.1


@pytest.mark.parametrize("ratio", [0.3, 0.5, 0.9, 1.0, 1.3, 1.7, 2.5])
def test_where_it_settles_on_a_stable_motion_newton_finds_the_same(ratio):
    """And what its difference leaves in the force, estimated by one step of Newton's method, is what it is off by."""
    moves = two_discs(ratio, zeta=0.05, depth=0.3, error=0.3)
    found, newton = averaged_motion(moves, tolerance=5e-4), steady_state(moves, tolerance=1e-8)
    assert (found.kind, newton.kind) == ("periodic", "periodic")
    assert abs(found.dynamic_factor[0] - newton.dynamic_factor[0]) <= 1.5 * found.off + 1e-6


@pytest.mark.parametrize("ratio", [1.9, 2.0, 2.1])
def test_it_settles_on_a_motion_that_no_machine_stays_in(ratio):
    """About twice the natural frequency the motion repeats after two periods; one of a single period is unstable."""
    moves = two_discs(ratio, zeta=0.05, depth=0.3, error=0.3)
    found, newton = averaged_motion(moves, tolerance=5e-4), steady_state(moves)
    assert (found.kind, found.multiplier > 1.0, newton.periods) == ("unstable", True, 2)
    assert newton.dynamic_factor[0] > 1.4 * found.dynamic_factor[0]


@pytest.mark.dear
def test_of_random_discs_what_is_said_of_a_motion_holds():
    """Damping from 0.001 to 0.2, stiffness varying by up to 60 %, backlash of any size, started loaded or unloaded.

    Newton's method from where the iteration ended closes on the same motion, as far away as is estimated and as stable
    as is said.
    """
    rng = np.random.default_rng(11)
    kinds = set()
    for _ in range(60):
        moves = two_discs(
            rng.uniform(0.15, 4.0), zeta=10.0 ** rng.uniform(-3.0, -0.7), depth=rng.uniform(0.0, 0.6),
            error=rng.uniform(0.0, 1.5), backlash=rng.choice([math.inf, DEFLECTION * 10.0 ** rng.uniform(-1.0, 1.0)]),
        )  # fmt: skip
        found = averaged_motion(moves, tolerance=1e-5, start=str(rng.choice(["static", "rest"])))
        orbit = close(pack(moves), found.x, found.v, 1, 1e-12)
        closed = propagate(orbit.packed, orbit.x, orbit.v, orbit.packed.period, tolerance=1e-12)
        assert abs(closed.tooth_force[0] / FORCE - found.dynamic_factor[0]) <= 1.5 * found.off + 1e-6
        assert found.kind == ("periodic" if orbit.stable else "unstable")
        kinds.add(found.kind)
    assert kinds == {"periodic", "unstable"}
