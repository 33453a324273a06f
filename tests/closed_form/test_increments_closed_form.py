"""Dynamic increment functions against W. D. Mark's closed forms and against 50-digit arithmetic.

The closed forms (2.55 to 2.66, with the determinant repaired: s = i w, a = R^2/C_I, b = R^2/C_II) live only here.
"""

import math

import mpmath
import numpy as np
import pytest
from exact_increments import exact_increments

from fegear.base.errors import RangeError
from fegear.dynamics.train.increments import (
    _Solver,
    dynamic_increments,
    high_frequency_increments,
    low_frequency_increments,
    low_frequency_terms,
)
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train

R, C1, C2 = 0.0417693, 1.26312e-8, 2.10520e-9
I1, I2, I3 = 0.004112, 0.0008010, 0.002994


def damping_constants(zeta_1=0.1, zeta_3=0.5):
    """Eqs. 5.6 to 5.9."""
    k1, k3 = R**2 * (1 / C1 + 1 / C2), R**2 / C2
    c1 = 2 * zeta_1 * math.sqrt(I1 * k1)
    return c1, c1 / 2, c1 / 2, 2 * zeta_3 * math.sqrt(I3 * k3) - c1 / 2


def four_square(zeta_1=0.1, zeta_3=0.5, force=1615.0):
    c1, c2, c3, ca = damping_constants(zeta_1, zeta_3)
    return Train(
        bodies=(Body("1", I1), Body("2", I2), Body("3", I3)),
        meshes=(Mesh("I", "1", "2", R, R, 28, 28, 1 / C1), Mesh("II", "1", "3", -R, -R, 35, 35, 1 / C2)),
        dampers=(Damper("1", None, c1), Damper("2", None, c2), Damper("3", None, c3), Damper("2", "3", ca)),
        torques=(Torque("2", force * R), Torque("3", -force * R)),
    )


def closed_determinant(s, a, b, c1, c2, c3, ca, mp):
    """D(s)/s, repaired (2.57)."""
    i1, i2, i3 = (mp(v) for v in (I1, I2, I3))
    cs = c1 + c2 + c3
    terms = [
        a * b * cs,
        a * b * (i1 + i2 + i3) + a * ((c1 + c2) * (c3 + ca) + c3 * ca) + b * ((c1 + c3) * (c2 + ca) + c2 * ca),
        a * ((i1 + i2) * (c3 + ca) + i3 * (c1 + c2 + ca))
        + b * ((i1 + i3) * (c2 + ca) + i2 * (c1 + c3 + ca))
        + c1 * (c2 * c3 + ca * (c2 + c3)),
        a * (i1 + i2) * i3
        + b * (i1 + i3) * i2
        + i1 * (c2 * c3 + ca * (c2 + c3))
        + i2 * c1 * (c3 + ca)
        + i3 * c1 * (c2 + ca),
        i1 * i2 * (c3 + ca) + i1 * i3 * (c2 + ca) + i2 * i3 * c1,
        i1 * i2 * i3,
    ]
    return sum(t * s**n for n, t in enumerate(terms))


def closed_form(omega, zeta_3=0.5):
    """Q_I,I as -D(mesh I removed)/D with the repaired (2.57), and Q_I,II from (2.54b), in 50 digits."""
    with mpmath.workdps(50):
        mp = mpmath.mpf
        c1, c2, c3, ca = (mp(c) for c in damping_constants(zeta_3=zeta_3))
        a, b, s = mp(R) ** 2 * mp(1 / C1), mp(R) ** 2 * mp(1 / C2), mpmath.mpc(0, omega)
        d = closed_determinant(s, a, b, c1, c2, c3, ca, mp)
        own = -closed_determinant(s, mp(0), b, c1, c2, c3, ca, mp) / d
        a11 = s * s * mp(I1) + s * c1 + a + b
        a22 = s * s * mp(I2) + s * (c2 + ca) + a
        a33 = s * s * mp(I3) + s * (c3 + ca) + b
        a12, a13, a23 = a, b, -s * ca
        cross = b * (a23 * (a11 + a23 - a12 - a13) - (a33 - a13) * (a22 - a12)) / (d * s)
        return complex(own), complex(cross)


def largest_error(train, frequencies):
    omega = 2 * np.pi * np.asarray(frequencies)
    q = dynamic_increments(train, omega)
    worst = 0.0
    for n, w in enumerate(omega):
        exact = exact_increments(train, w, digits=50)
        worst = max(worst, float(np.max(np.abs(q[:, :, n] - exact) / np.abs(exact))))
    return worst


@pytest.mark.parametrize("mesh", [0, 1, 2])
def test_increments_by_pivots_are_exact_where_meshes_differ_in_stiffness_and_damping(mesh):
    train = Train(
        bodies=tuple(Body(name, inertia) for name, inertia in zip("abcd", (0.004, 0.0008, 0.003, 0.02), strict=True)),
        meshes=(
            Mesh("I", "a", "b", 0.04, 0.06, 28, 42, 8e7, damping=900.0),
            Mesh("II", "b", "c", 0.03, 0.05, 21, 35, 3e8, damping=70.0), Mesh("III", "c", "d", 0.02, 0.09, 20, 90, 5e8),
        ),
        dampers=(Damper("a", None, 2.0), Damper("d", None, 1.0)),
        torques=(Torque("a", 40.0), Torque("d", 40.0 * (0.06 / 0.04) * (0.05 / 0.03) * (0.09 / 0.02))),
    )  # fmt: skip
    omega = 2.0 * math.pi * np.array([40.0, 900.0, 7000.0])
    found = _Solver.of(train)._by_pivots(omega.astype(np.longdouble), mesh).q
    for n, w in enumerate(omega):
        assert found[:, n] == pytest.approx(exact_increments(train, w)[:, mesh], rel=1e-11)


def test_damping_constants_are_the_papers():
    """(5.10): 12.6114, 6.30571, 43.5062 N m s; 1e-4, since the paper worked them out in inches and pounds."""
    c1, c2, c3, ca = damping_constants()
    assert c1 == pytest.approx(12.6114, rel=1e-4)
    assert c2 == c3 == pytest.approx(6.30571, rel=1e-4)
    assert ca == pytest.approx(43.5062, rel=1e-4)
    assert static_forces(four_square()) == pytest.approx([1615.0, 1615.0], rel=1e-12)


def test_magnitudes_are_the_papers():
    """|Q_I,II| is "about 5.6" near 3500 Hz and "about 0.43" at 5833 Hz (issue: 5.57 and 0.44)."""
    q = np.abs(dynamic_increments(four_square(), 2 * np.pi * np.array([3500.0, 5833.333])))
    assert q[0, 1] == pytest.approx([5.57, 0.44], abs=0.006)


@pytest.mark.parametrize("zeta_3", [0.5, 0.2])
def test_four_square_rig_equals_the_closed_form(zeta_3):
    omega = 2 * np.pi * np.logspace(-6, 6, 61)
    q = dynamic_increments(four_square(zeta_3=zeta_3), omega)
    for n, w in enumerate(omega):
        own, cross = closed_form(float(w), zeta_3)
        assert abs(q[0, 0, n] - own) <= 1e-12 * abs(own)
        assert abs(q[0, 1, n] - cross) <= 1e-12 * abs(cross)


def test_asymptotes_of_the_paper():
    """(2.62), (2.64), (2.65) and (2.66), the last with a plus sign."""
    c1, c2, c3, ca = damping_constants()
    train, cs, f = four_square(), sum((c1, c2, c3)), 2 * np.pi * np.array([0.1, 700.0, 9e4])
    low, high = low_frequency_increments(train, f), high_frequency_increments(train, f)
    np.testing.assert_allclose(low[0, 0], -1j * (ca + c2 * (c1 + c3) / cs) * f * C1 / R**2, rtol=1e-5)
    np.testing.assert_allclose(low[0, 1], -1j * f * C1 / R**2 * (ca + c2 * c3 / cs), rtol=1e-5)
    np.testing.assert_allclose(high[0, 0], -1 - R**2 / C1 * (I1 + I2) / (I1 * I2 * f**2), rtol=1e-12)
    np.testing.assert_allclose(high[0, 1], R**2 / C2 / (I1 * f**2), rtol=1e-12)


def test_asymptotes_are_what_increments_tend_to():
    """Long-digit increments far below and far above every natural frequency: the misfit shrinks with the distance."""
    for train in (
        four_square(),
        Train(BODIES, SHAFTS, MESHES),
        Train(BODIES, SHAFTS, MESHES, (Damper("motor", None, 0.1), Damper("a", "d", 3.0))),
    ):
        _, power = low_frequency_terms(train)
        assert set(power.ravel()) <= {0, 1, 2}
        for f in (1e-5, 1e-6):
            w = 2 * np.pi * f
            exact = exact_increments(train, w, digits=50)
            # c is read off where the power is whole to 1e-6
            np.testing.assert_allclose(low_frequency_increments(train, w), exact, rtol=2e-6 + 1e-2 * f / 1e-5)
        left = []
        for f in (1e7, 1e8):
            w = 2 * np.pi * f
            exact = exact_increments(train, w, digits=50)
            found = high_frequency_increments(train, w)
            assert np.all((found == 0.0) == (train.approach @ train.approach.T == 0.0))
            left.append(np.abs(found - exact).max())
        assert left[1] < 0.02 * left[0]


def test_a_locked_power_loop_and_free_discs_have_low_frequency_terms_too():
    loop = Train(
        (Body("1", 0.004), Body("1b", 0.003), Body("2", 0.001), Body("2b", 0.002)),
        (Shaft("s1", "1", "1b", 2e4, 0.05), Shaft("s2", "2", "2b", 1e4, 0.02)),
        (Mesh("p", "1", "2", 0.04, 0.04, 28, 28, 8e7, 50.0), Mesh("q", "1b", "2b", -0.05, -0.05, 35, 35, 4e8, 20.0)),
    )
    c, power = low_frequency_terms(loop)
    assert np.all(power == 0)
    np.testing.assert_allclose(c, dynamic_increments(loop, 0.0).real, rtol=1e-6)
    # two free discs: Q = (w/w_n)^2/(1 - (w/w_n)^2), w_n^2 = 4, so Q = -s^2/4 to begin with
    discs = Train((Body("1", 1.0), Body("2", 1.0)), meshes=(Mesh("I", "1", "2", 1.0, 1.0, 20, 20, 2.0),))
    c, power = low_frequency_terms(discs)
    assert power[0, 0] == 2
    assert c[0, 0] == pytest.approx(-0.25, rel=1e-5)


def test_second_resonance_appears_near_2000_hz_when_the_torque_applier_is_damped_less():
    f = np.linspace(500.0, 6000.0, 1101)
    peaks = {}
    for zeta_3 in (0.5, 0.1):
        q = np.abs(dynamic_increments(four_square(zeta_3=zeta_3), 2 * np.pi * f)[0, 0])
        peaks[zeta_3] = f[1:-1][(q[1:-1] > q[:-2]) & (q[1:-1] > q[2:])]
    assert not np.any((peaks[0.5] > 1500) & (peaks[0.5] < 2500))
    assert np.any((peaks[0.1] > 1500) & (peaks[0.1] < 2500))


FREQUENCIES = np.logspace(-6, 6, 49)
BODIES = (
    Body("motor", 0.02), Body("a", 0.0012), Body("b", 0.004), Body("c", 0.0008), Body("d", 0.003),
    Body("load", 0.05), Body("pump", 1e-5),
)  # fmt: skip
SHAFTS = (
    Shaft("s1", "motor", "a", 2e3, 0.05), Shaft("s2", "b", "c", 5e4, 0.01), Shaft("s3", "d", "load", 800.0, 0.02),
    Shaft("s4", "b", "pump", 30.0, 0.0),
)  # fmt: skip
MESHES = (
    Mesh("p", "a", "b", 0.03, 0.06, 20, 40, 3e8, 500.0),
    Mesh("q", "c", "d", -0.025, -0.075, 20, 60, 5e8, 300.0),
)


@pytest.mark.dear("both", "slipping damper")
@pytest.mark.parametrize(
    "dampers",
    [
        (),
        (Damper("motor", None, 0.1),),
        (Damper("motor", "load", 0.1),),
        (Damper("b", None, 0.2), Damper("a", "d", 3.0)),
    ],
    ids=["free", "grounded", "slipping damper", "both"],
)
def test_elastic_shafts_branches_and_rigid_motion(dampers):
    """Two stages with four shafts and a branch; the rigid-body motion is free, damped or held by a slipping damper."""
    assert largest_error(Train(BODIES, SHAFTS, MESHES, dampers), FREQUENCIES) < 1e-10


def test_closed_power_loop_with_elastic_shafts():
    """Here a transmission error loads the loop even at standstill: Q_ii(0) is not zero."""
    train = Train(
        (Body("1", 0.004), Body("1b", 0.003), Body("2", 0.001), Body("2b", 0.002)),
        (Shaft("s1", "1", "1b", 2e4, 0.05), Shaft("s2", "2", "2b", 1e4, 0.02)),
        (Mesh("p", "1", "2", 0.04, 0.04, 28, 28, 8e7, 50.0), Mesh("q", "1b", "2b", -0.05, -0.05, 35, 35, 4e8, 20.0)),
    )
    assert largest_error(train, FREQUENCIES) < 1e-10
    still = dynamic_increments(train, 0.0)
    slow = dynamic_increments(train, 1e-3)
    assert still == pytest.approx(slow, rel=1e-5)
    assert abs(still[0, 0]) > 0.04


def test_three_stages_of_very_different_size():
    train = Train(
        (Body("a", 1e-6), Body("b", 3e-5), Body("c", 2e-6), Body("d", 4e-2), Body("e", 1e-3), Body("f", 20.0)),
        (Shaft("1", "b", "c", 50.0), Shaft("2", "d", "e", 3e5)),
        (
            Mesh("I", "a", "b", 0.005, 0.02, 10, 40, 1e7, 1.0),
            Mesh("II", "c", "d", -0.01, -0.1, 12, 120, 6e7, 10.0),
            Mesh("III", "e", "f", 0.05, 0.6, 14, 168, 9e8, 100.0),
        ),
    )
    assert largest_error(train, FREQUENCIES) < 1e-10


def test_zero_and_negative_frequency():
    q = dynamic_increments(four_square(), np.array([0.0, 1e3, -1e3]))
    assert np.all(q[:, :, 0] == 0.0)
    assert np.array_equal(q[:, :, 2], np.conj(q[:, :, 1]))


def test_undamped_resonance_is_refused_and_next_to_it_is_not():
    """Two equal discs: the only natural frequency is sqrt(2 k R^2/I), here exactly 2 rad/s."""
    train = Train((Body("1", 1.0), Body("2", 1.0)), meshes=(Mesh("I", "1", "2", 1.0, 1.0, 20, 20, 2.0),))
    with pytest.raises(RangeError, match="is a natural frequency of the undamped train:"):
        dynamic_increments(train, 2.0)
    assert dynamic_increments(train, 2.0 + 1e-6)[0, 0].real == pytest.approx(-1e6, rel=1e-5)
    with pytest.raises(RangeError, match="finite"):
        dynamic_increments(train, np.nan)


@pytest.mark.dear
@pytest.mark.parametrize("seed", range(8))
def test_random_trains(seed):
    """Trees of two to eight bodies over many decades, with dampers to ground and between bodies of any speed."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    bodies = tuple(Body(str(i), float(10 ** rng.uniform(-6, 1))) for i in range(n))
    shafts, meshes = [], []
    for i in range(1, n):
        other = str(int(rng.integers(0, i)))
        if i == 1 or rng.random() < 0.5:
            za, zb = (int(z) for z in rng.integers(15, 90, 2))
            m = 10 ** rng.uniform(-3.5, -2)
            k, c = float(10 ** rng.uniform(6, 9.5)), float(10 ** rng.uniform(0, 3.5))
            meshes.append(Mesh(f"m{i}", other, str(i), za * m / 2, zb * m / 2, za, zb, k, c))
        else:
            shafts.append(
                Shaft(f"s{i}", other, str(i), float(10 ** rng.uniform(1, 7)), float(10 ** rng.uniform(-3, 1)))
            )
    dampers = tuple(Damper(str(i), None, float(10 ** rng.uniform(-4, 2))) for i in range(n) if rng.random() < 0.3)
    if n > 3 and rng.random() < 0.5:
        dampers += (Damper("1", "3", float(10 ** rng.uniform(-3, 2))),)
    train = Train(bodies, tuple(shafts), tuple(meshes), dampers)
    assert largest_error(train, np.logspace(-6, 6, 25)) < 1e-10
    slow, fast = 1e-10, 1e13  # far below the slowest decay, far above the stiffest mesh
    exact = exact_increments(train, slow, digits=120)
    np.testing.assert_allclose(low_frequency_increments(train, slow), exact, rtol=3e-6)
    exact, own = exact_increments(train, fast, digits=120), np.eye(len(meshes))
    size = np.abs(exact + own)
    found = np.abs(high_frequency_increments(train, fast) + own)
    np.testing.assert_allclose(found[found > 0.0], size[found > 0.0], rtol=1e-3)


def test_reciprocity():
    """Q_ij / C_i is symmetric: what mesh j's error does to mesh i's force, mesh i's error does to mesh j's."""
    train = Train(BODIES, SHAFTS, MESHES, (Damper("a", None, 0.3),))
    q = dynamic_increments(train, 2 * np.pi * np.logspace(-3, 5, 30))
    k = np.array([m.stiffness for m in train.meshes])
    damped = np.array([1 + 2j * np.pi * np.logspace(-3, 5, 30) * m.damping / m.stiffness for m in train.meshes])
    forward, back = k[0] * q[0, 1] / damped[0], k[1] * q[1, 0] / damped[1]
    assert forward == pytest.approx(back, rel=1e-11)


@pytest.mark.parametrize("zeta", [0.02, 0.4])
def test_an_entry_by_the_way_back_is_the_entry(zeta):
    """Q_ij by a column of mesh i: forces there and back are the same, up to springs and dampers of the two."""
    train, w = four_square(zeta, 3.0 * zeta), 2.0 * math.pi * np.array([200.0, 1500.0, 4000.0])
    solver = _Solver.of(train)
    count = len(train.meshes)
    for mesh in range(count):
        for i in range(count):
            if i == mesh:
                continue
            direct, back = solver._solve(solver.long, w, mesh), solver._back(w, i=i, mesh=mesh)
            np.testing.assert_allclose(back.q[i], direct.q[i], rtol=1e-10, atol=1e-14 * np.abs(direct.q).max())
            assert np.isfinite(back.doubt[i]).all()
            assert (back.doubt[i] <= 1e-9 * np.abs(back.q[i]).max()).all()
            others = np.arange(count) != i  # of these nothing is known
            assert np.isinf(back.doubt[others]).all()
            assert not back.q[others].any()
            assert not back.resonance.any()


def test_gears_on_one_rigid_body_leave_all_of_the_error_to_the_teeth():
    train = four_square()
    found = _Solver.of(train)._rigid(np.array([10.0, 20.0]), 1)
    np.testing.assert_array_equal(found.q[1], [-1.0, -1.0])
    assert not np.delete(found.q, 1, axis=0).any()
    assert not found.doubt.any()
    assert not found.resonance.any()
