"""What a tooth carries beyond its static load: the slope of its own load, not a share of the mesh's stiffness.

The references are an enumeration of loaded pairs under a prescribed approach, differences of its loads, and laws: an
effect that never acts changes nothing, and what the teeth carry adds up to what the mesh carries.
"""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from smooth_tooth import SmoothTooth

from fegear.contact.contact_law import ContactLaw
from fegear.contact.plane.coupled_teeth import PairMatrices
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.neglected_effects import corners_bear
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.roll_grids import RollGrid
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.mesh_excitation import mesh_excitation, tooth_pair_at
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.tooth_force import dynamic_error, tooth_force
from fegear.dynamics.train.train import Body, Damper, Mesh, Torque, Train, mesh_damping
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import tip_relief


# ---- the tangent of load sharing -------------------------------------------------------------------------------------
def deflection(w, c, kappa, power):
    return c * w - 0.5 * kappa * w * math.log(w) + power * w**0.9


def loads_at(zeta, c, e, kappa, power):
    """Loads of the pairs at a given approach: every set tried, its equations by Newton from the linear ones."""
    n = len(e)
    for loaded in product((True, False), repeat=n):
        s = [j for j in range(n) if loaded[j]]
        w = np.zeros(n)
        if s:
            v = np.maximum(np.linalg.solve(c[np.ix_(s, s)], zeta - e[s]), 1e-6)
            for _ in range(40):
                own = np.array([deflection(x, 0.0, kappa[j], power) for x, j in zip(v, s, strict=True)])
                slope = [-0.5 * kappa[j] * (1 + math.log(x)) + 0.9 * power * x**-0.1 for x, j in zip(v, s, strict=True)]
                change = np.linalg.solve(c[np.ix_(s, s)] + np.diag(slope), zeta - e[s] - own - c[np.ix_(s, s)] @ v)
                v = np.maximum(v + change, 0.2 * v)
                if np.max(np.abs(change) / v) < 1e-12:
                    break
            else:
                continue
            w[s] = v
        apart = [j for j in range(n) if not loaded[j]]
        if (c[apart] @ w + e[apart] >= zeta).all():
            return w
    raise AssertionError("no set of loaded pairs fits")


@st.composite
def sharing(draw):
    """Two to four coupled pairs in round numbers: compliance near 1, separations that some do not reach."""
    n = draw(st.integers(2, 4))
    number = st.floats(0.0, 1.0)
    c = np.diag([1.0 + draw(number) for _ in range(n)])
    for i in range(n):
        for j in range(i):
            c[i, j] = c[j, i] = 0.3 * draw(number) ** (i - j)
    e = np.array([0.6 * draw(number) for _ in range(n)])
    kappa = np.array([0.2 * draw(number) for _ in range(n)]) * draw(st.booleans())
    return c, e, kappa, 0.3 * draw(number) * draw(st.booleans()), 0.1 + draw(number)


@pytest.mark.examples(30, 1000)
@given(sharing())
def test_each_pair_has_the_slope_of_its_own_load(problem):
    c, e, kappa, power, load = problem
    matrices = PairMatrices(c[:, :, None], ContactLaw(kappa[:, None], 1.0, None, power))
    shared = matrices.share(e[:, None], [load])
    state = Loaded(RollGrid(np.zeros(1), None, matrices), np.array([load]), shared, e[:, None])
    zeta, h = float(shared.transmission_error[0, 0]), 1e-5
    low, middle, high = (loads_at(z, c, e, kappa, power) for z in (zeta - h, zeta, zeta + h))
    np.testing.assert_allclose(shared.loads[:, 0, 0], middle, atol=1e-10)
    assume(((low > 0.0) == (high > 0.0)).all() and (middle[middle > 0.0] > 1e-2).all())
    np.testing.assert_allclose(state.pair_tangent[:, 0, 0], (high - low) / (2 * h), rtol=2e-6, atol=2e-6)
    assert state.local_stiffness[0, 0] == pytest.approx(state.pair_tangent[:, 0, 0].sum(), rel=1e-14)


# ---- the springs of a mesh -------------------------------------------------------------------------------------------
GEAR = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3.175e-3, 20e-3, 25.4e-3)
PAIR = GearPair(GEAR, GEAR)
LOAD = 9000.0


def engagement(amount, coupled, **changes):
    """Equal tip reliefs over most of the double contact."""
    source = SmoothTooth(GEAR, reach=2)
    relief = tip_relief(GEAR, amount, length=2.2e-3)
    compliance = PairCompliance(PAIR, source, source, coupled, "load-dependent")
    return Engagement(compliance, driver_relief=relief, driven_relief=relief, **changes)


@pytest.mark.parametrize("amount", [4e-6, 12e-6])
def test_springs_of_coupled_teeth_are_load_sharing_and_its_slope(amount):
    """At rest each spring carries what load sharing gives its pair; ten newtons more, and it follows."""
    e = engagement(amount, True)
    excitation, more = mesh_excitation(e, LOAD), 10.0
    pitch = PAIR.base_pitch
    for x in np.linspace(PAIR.x_start + 0.02 * pitch, PAIR.x_start + 0.97 * pitch, 9):
        grid = e.grid([x])
        before, after = (e.solve(grid, [w]) for w in (LOAD, LOAD + more))
        place = grid.contacts.x[:, 0]
        k, m = tooth_pair_at(excitation, place, pitch)
        present = grid.contacts.present[:, 0]
        zeta, further = float(before.transmission_error[0, 0]), float(after.transmission_error[0, 0])
        rest = np.where(present, k * (zeta - m), 0.0)
        np.testing.assert_allclose(rest, before.loads[:, 0, 0], atol=1e-4 * LOAD)
        assert excitation.approach(LOAD, x / pitch) == pytest.approx(zeta, rel=1e-5)
        if (before.loads > 0.0).sum() == (after.loads > 0.0).sum() and before.loads[before.loads > 0.0].min() > 200.0:
            moved = np.where(present, k * (further - zeta), 0.0)
            np.testing.assert_allclose(moved, (after.loads - before.loads)[:, 0, 0], atol=3e-3 * more)


@pytest.mark.parametrize("coupled", [True, False])
def test_what_the_teeth_carry_adds_up_to_what_the_mesh_carries(coupled):
    """Static parts to the mean load, increments to the stiffness of the pairs in contact times the dynamic error."""
    excitation, pitch, speed = mesh_excitation(engagement(10e-6, coupled), LOAD), PAIR.base_pitch, 700.0
    rig = two_discs(excitation, 0.1)
    errors, s = [excitation.transmission_error(LOAD, tolerance=1e-9)], np.linspace(0.003, 0.997, 40)
    static, own, stiffness = 0.0, 0.0, 0.0
    for j in range(-2, 3):
        k, m = tooth_pair_at(excitation, (s + j) * pitch, pitch)
        k = np.where(errors[0](s) > m, k, 0.0)
        found = tooth_force(rig, errors, 0, speed, (s + j) * pitch, k, m, pitch, number=-j, harmonics=64)
        static, own, stiffness = static + found.static, own + found.own, stiffness + k
    np.testing.assert_allclose(static, LOAD, rtol=1e-4)
    moved = errors[0].mean + dynamic_error(rig, errors, 0, 0, speed, s, 64) - errors[0](s)
    np.testing.assert_allclose(own, stiffness * moved, atol=1e-6 * LOAD)
    assert np.abs(own).max() > 0.02 * LOAD


def two_discs(excitation, zeta, radius=GEAR.base_radius, inertia=1.2e-3, load=LOAD):
    k = 1.0 / excitation.mean_compliance()
    damping = mesh_damping(zeta, k, radius, radius, inertia, inertia)
    return Train(
        (Body("a", inertia), Body("b", inertia)),
        meshes=(Mesh("I", "a", "b", radius, radius, 28, 28, k, damping),),
        torques=(Torque("a", load * radius), Torque("b", load * radius)),
    )


def speed_at(rig, ratio):
    """Speed at which the mesh frequency is that part of the natural frequency [rad/s]."""
    mesh = rig.meshes[0]
    return ratio * math.sqrt(2.0 * mesh.stiffness * mesh.radius_a**2 / rig.inertia[0]) / mesh.teeth_a


@pytest.mark.examples(15, 300)
@given(st.floats(2e-6, 40e-6), st.floats(2e3, 2e4))
def test_corners_touch_where_the_teeth_give_way_by_more_than_their_gap(amount, load):
    """Where corners are found not to bear, no gap off the path is smaller than what the teeth give way by without."""
    plain, cornered = (engagement(amount, False, corner_contact=corner) for corner in (False, True))
    near = np.geomspace(1e-6, 0.5, 40)
    x = PAIR.x_start + PAIR.base_pitch * np.concatenate([near, 1.0 - near])
    grid = cornered.grid(x)
    gave = plain.solve(plain.grid(x), [load]).transmission_error[:, 0]
    gap = np.where(grid.contacts.gap > 0.0, cornered.separation(grid.contacts), np.inf).min(axis=0)
    bears = corners_bear(cornered, load)
    assert bears or not (gap < gave).any()
    # a pair that bears at the very end of the path bears at its corner as well
    assert not bears or (gap < 1.05 * gave).any()


@pytest.mark.parametrize(("amount", "load", "ratio"), [(30e-6, 9e3, 0.45), (40e-6, 4e3, 0.9), (18e-6, 5e3, 1.3)])
def test_corners_that_never_touch_change_nothing(amount, load, ratio):
    plain, cornered = (engagement(amount, False, corner_contact=corner) for corner in (False, True))
    assert not corners_bear(cornered, load)
    without, with_them = (mesh_excitation(e, load) for e in (plain, cornered))
    rig = two_discs(without, 0.08, load=load)
    assert with_them.mean_compliance() == without.mean_compliance()
    for parting in (True, False):
        one, other = (e if parting else e.never_parting(load) for e in (without, with_them))
        model = MotionModel(rig, (one,), speed_at(rig, ratio))
        first, second = (steady_state(replace(model, excitations=(e,)), tolerance=1e-4) for e in (one, other))
        assert (first.tooth_force == second.tooth_force).all()
        assert (first.largest == second.largest).all()


@pytest.mark.parametrize("coupled", [pytest.param(True, marks=pytest.mark.long), False])
def test_corners_that_hardly_touch_hardly_change_a_force(coupled):
    """Coupled or not, the largest force on a tooth moves little as the corner begins to bear."""
    plain, cornered = (engagement(14e-6, coupled, corner_contact=corner) for corner in (False, True))
    low, load = 3e3, 6e3
    assert corners_bear(cornered, load)
    for _ in range(10):
        middle = 0.5 * (low + load)
        low, load = (low, middle) if corners_bear(cornered, middle) else (middle, load)
    factors = []
    for e in (plain, cornered):
        excitation = mesh_excitation(e, load)
        model = MotionModel(two_discs(excitation, 0.1, load=load), (excitation,), 300.0)
        factors.append(steady_state(model, tolerance=1e-4).dynamic_factor[0])
    assert factors[1] == pytest.approx(factors[0], rel=1e-3 if coupled else 2e-2)


@st.composite
def unmodified_paths(draw):
    """Tooth pairs over one to three base pitches, softer or stiffer along the path."""
    length, bend, tilt = draw(st.floats(1.05, 2.9)), draw(st.floats(-0.3, 0.4)), draw(st.floats(-0.3, 0.3))
    half, stiff = 0.5 * length, 1.5e8 / length
    return MeshExcitation.from_tooth_pair(
        lambda x: stiff * (1.0 - bend * (x / half) ** 2 + tilt * x / half), np.zeros_like, -half, half, 1.0
    )


@pytest.mark.examples(15, 300)
@given(unmodified_paths(), st.floats(0.15, 1.6), st.floats(0.08, 0.2))
def test_where_contact_is_never_lost_contact_loss_changes_nothing(excitation, ratio, zeta):
    rig = two_discs(excitation, zeta)
    model = MotionModel(rig, (excitation,), speed_at(rig, ratio))
    free = steady_state(model, tolerance=1e-8)
    assume(free.changes == 0 and free.kind == "periodic")
    held = steady_state(replace(model, excitations=(excitation.never_parting(LOAD),)), tolerance=1e-8)
    for name in ("tooth_force", "largest", "smallest"):
        assert getattr(held, name) == pytest.approx(getattr(free, name), rel=1e-8)


def integrated(e, rig, speed, coupled):
    """Largest force on a tooth pair from an integration of one's own: load sharing itself, about its static answers.

    m z'' + c z' + sum of W_j = W with W_j = W_j0 + K_Sj (z - zeta), K_Sj by differences of load sharing;
    stand-alone pairs as they are taken, linear about the full load on one pair: W_j = (z - m_j) / c_jj(W).
    """
    pitch, mesh = PAIR.base_pitch, rig.meshes[0]
    mass = rig.inertia[0] / (2.0 * mesh.radius_a**2)
    rate = speed * mesh.teeth_a / (2.0 * math.pi)  # base pitches per second
    u = (np.arange(400) + 0.5) / 400
    grid = e.grid(PAIR.x_start + u * pitch)
    if coupled:
        less, rest, more = (e.solve(grid, [LOAD * w]) for w in (1.0 - 1e-5, 1.0, 1.0 + 1e-5))
        approach = (more.transmission_error - less.transmission_error)[:, 0]
        stiffness = (more.loads - less.loads)[:, :, 0] / approach
        preload = rest.loads[:, :, 0] - stiffness * rest.transmission_error[:, 0]
    else:
        full = grid.matrices.at_load(np.full((*grid.contacts.x.shape, 1), LOAD))[:, :, :, 0]
        stiffness = np.where(grid.contacts.present, 1.0 / np.einsum("jjp->jp", full), 0.0)
        preload = -stiffness * e.modification(grid.contacts)

    def at(values, time):
        place = (time * rate - PAIR.x_start / pitch) % 1.0
        return np.array([np.interp(place, u, row, period=1.0) for row in values])

    def slope(time, y):
        force = at(stiffness, time).sum() * y[0] + at(preload, time).sum()
        return y[1], (LOAD - force - mesh.damping * y[1]) / mass

    period = 1.0 / rate
    run = solve_ivp(slope, (0.0, 9.0 * period), (3e-6, 0.0), max_step=period / 120, rtol=1e-6, atol=1e-13)
    last = run.t > 8.0 * period
    elastic = at(stiffness, run.t[last]) * run.y[0, last] + at(preload, run.t[last])
    # mesh damping is carried by the pairs as their springs are
    carried = elastic * (1.0 + mesh.damping * run.y[1, last] / elastic.sum(axis=0))
    return float(carried.max())


@pytest.mark.dear
@pytest.mark.parametrize(
    ("coupled", "ratio"),
    [(False, 0.85), *(pytest.param(*one, marks=pytest.mark.long) for one in ((True, 1.0), (True, 0.7), (False, 0.7)))],
)
def test_relieved_teeth_part_or_not_alike_while_none_does(coupled, ratio):
    """Little relief, heavy damping: every pair keeps bearing where it bears at rest, and carries what it must."""
    e = engagement(8e-6, coupled)
    excitation = mesh_excitation(e, LOAD)
    rig = two_discs(excitation, 0.2)
    speed = speed_at(rig, ratio)
    model = MotionModel(rig, (excitation,), speed)
    free = steady_state(model, tolerance=1e-7)
    held = steady_state(replace(model, excitations=(excitation.never_parting(LOAD),)), tolerance=1e-7)
    assert free.changes == 0
    assert held.tooth_force == pytest.approx(free.tooth_force, rel=1e-6)
    assert held.largest == pytest.approx(free.largest, rel=1e-6)
    assert held.tooth_force[0] == pytest.approx(integrated(e, rig, speed, coupled), rel=3e-3)


def test_a_pair_that_its_relief_holds_apart_is_no_spring_of_the_linear_mesh():
    excitation = mesh_excitation(engagement(30e-6, False), LOAD)
    s = np.linspace(0.0, 1.0, 400, endpoint=False) + 1e-4
    zeta, held = excitation.approach(LOAD, s), excitation.never_parting(LOAD)
    for k, m, linear in zip(excitation.stiffness, excitation.separation, held.stiffness, strict=True):
        np.testing.assert_allclose(linear(s), np.where(zeta > m(s), k(s), 0.0), rtol=1e-9, atol=1e-3)
    assert any(np.any((k(s) > 0.0) & (h(s) == 0.0)) for k, h in zip(excitation.stiffness, held.stiffness, strict=True))
    np.testing.assert_allclose(held.approach(LOAD, s, one_sided=False), zeta, rtol=1e-9)


# ---- phases of the meshes --------------------------------------------------------------------------------------------
@pytest.mark.examples(10, 100)
@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_increments_from_another_mesh_follow_its_phase(own, other):
    """A chain of three bodies, one cosine in the second mesh: the response solved as complex amplitudes."""
    r, k, j, a, speed = 0.05, (2e8, 3e8), (2e-3, 3e-3, 1e-3), 3e-6, 500.0
    damping = 8.0
    rig = Train(
        tuple(Body(name, inertia) for name, inertia in zip("xyz", j, strict=True)),
        meshes=(Mesh("1", "x", "y", r, r, 30, 30, k[0]), Mesh("2", "y", "z", 0.8 * r, 0.8 * r, 24, 24, k[1])),
        dampers=tuple(Damper(name, None, damping) for name in "xyz"),
        torques=(Torque("x", 10.0), Torque("y", 20.0), Torque("z", 10.0)),
    )
    wave = Periodic.fit(lambda s: a * np.cos(2 * np.pi * s), degree=10, tolerance=1e-12)
    flat = Periodic.constant(0.0)
    x = np.linspace(-0.5, 0.5, 11)
    found = tooth_force(
        rig, [flat, wave], 0, speed, x, np.full(11, 1e8), np.zeros(11), 1.0, harmonics=2, phases=(own, other)
    )
    w = speed * 24
    rows = np.array([[r, r, 0.0], [0.0, 0.8 * r, 0.8 * r]])
    dynamic = rows.T @ np.diag(k) @ rows - w**2 * np.diag(j) + 1j * w * damping * np.eye(3)
    zeta = rows[0] @ np.linalg.solve(dynamic, rows[1] * k[1] * a)
    time = (x - own) / (speed * 30 / (2 * np.pi))  # from the moment that the phases hold for
    expected = 1e8 * np.real(zeta * np.exp(1j * (w * time + 2 * np.pi * other)))
    np.testing.assert_allclose(found.cross[1], expected, atol=1e-9 * np.abs(expected).max())
    assert found.cross_peak[1] == pytest.approx(1e8 * abs(zeta), rel=2e-3)
