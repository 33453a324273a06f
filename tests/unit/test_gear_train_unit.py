"""What a train refuses, how it merges and counts, its matrices, modes and Campbell diagram."""

import math
import tomllib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.case.built.train import train_inputs
from fegear.case.reading import build_scene
from fegear.dynamics.train.matrices import damping_matrix, mass_matrix, static_forces, stiffness_matrix
from fegear.dynamics.train.modes import campbell, damped_eigenvalues, modes
from fegear.dynamics.train.train import (
    Body,
    Damper,
    Mesh,
    Shaft,
    Torque,
    Train,
    disc_inertia,
    mesh_damping,
    shaft_damping,
    shaft_stiffness,
)
from fegear.dynamics.train.train_spec import build_train


def mesh(name="m", a="a", b="b", ra=0.05, rb=0.1, za=20, zb=40, k=1e8, **more):
    return Mesh(name, a, b, ra, rb, za, zb, k, **more)


A, B = Body("a", 1e-3), Body("b", 2e-2)


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda: Body("a", 0.0), "body.a.inertia = 0.0: must be positive"),
        (lambda: Body("a", math.nan), "must be positive"),
        (lambda: Shaft("s", "a", "b", 0.0), "has neither stiffness nor damping"),
        (lambda: Shaft("s", "a", "b", -1.0), "must be zero or positive|must be positive"),
        (lambda: mesh(k=math.inf), "must be positive and finite"),
        (lambda: mesh(ra=0.06), "ratio of the tooth numbers"),
        (lambda: mesh(za=0), "at least 1"),
        (lambda: Damper("a", None, -1.0), "zero or positive"),
        (lambda: Torque("a", math.inf), "finite"),
        (lambda: Train(()), "at least one body"),
        (lambda: Train((A, A)), "used twice"),
        (lambda: Train((A, B)), "need shafts or gear pairs"),
        (lambda: Train((A, B), meshes=(mesh(b="c"),)), "is not a body of this train"),
        (lambda: Train((A, B), meshes=(mesh(b="a"),)), "connects a body with itself"),
        (lambda: Train((A, B, Body("c", 1.0)), meshes=(mesh(),)), "not connected with a"),
        (
            lambda: Train((A, B), meshes=(mesh(),), torques=(Torque("a", 5.0),)),
            "is not balanced, referred to the speed of",
        ),
        (
            lambda: Train((A, B), (Shaft("s", "a", "b", 1e3),), (mesh(),)),
            "is the speed ratio around a closed loop, which",
        ),
        (
            lambda: Train((A, B), (Shaft("s", "a", "b", math.inf),), (mesh(),)),
            "is the speed ratio around a closed loop, which",
        ),
    ],
)
def test_refusals_name_value_rule_and_remedy(build, says):
    with pytest.raises(InputError, match=says):
        build()


def test_torques_in_equilibrium_and_static_forces():
    """Two stages: 10 N m in, 10 x 2 x 3 out; every mesh carries torque over base radius."""
    train = Train(
        (A, B, Body("c", 1e-3), Body("d", 0.1)),
        (Shaft("s", "b", "c", 1e4),),
        (mesh(), mesh("n", "c", "d", -0.03, -0.09, 15, 45)),
        torques=(Torque("a", 10.0), Torque("d", -60.0)),
    )
    assert train.ratios.tolist() == pytest.approx([1.0, -0.5, -0.5, 1 / 6])
    assert static_forces(train) == pytest.approx([10.0 / 0.05, 20.0 / 0.03], rel=1e-12)
    assert train.mesh_orders == (Fraction(20), Fraction(15, 2))
    assert train.mesh_frequencies(2 * math.pi * 10) == pytest.approx([200.0, 75.0])


def test_rigid_shafts_merge_bodies():
    train = Train((A, B, Body("c", 3e-3)), (Shaft("s", "b", "c", math.inf),), (mesh(),))
    assert train.size == 2
    assert train.inertia.tolist() == pytest.approx([1e-3, 2.3e-2])
    assert train.dof == {"a": 0, "b": 1, "c": 1}


def test_matrices_are_symmetric_and_hold_the_rigid_motion():
    train = Train(
        (A, B, Body("c", 1e-3)),
        (Shaft("s", "b", "c", 1e4, 0.3),),
        (mesh(damping=40.0),),
        (Damper("a", "c", 0.2), Damper("b", None, 0.1)),
    )
    K, C = stiffness_matrix(train), damping_matrix(train)
    assert np.array_equal(K, K.T)
    assert np.array_equal(C, C.T)
    assert np.max(np.abs(K @ train.ratios)) < 1e-9 * np.max(np.abs(K))
    assert np.all(np.linalg.eigvalsh(C) > -1e-12)
    assert np.array_equal(np.diag(mass_matrix(train)), train.inertia)
    # the slipping damper works against the rigid motion, the shaft's and the teeth's own damping do not
    slip = train.ratios @ C @ train.ratios
    assert slip == pytest.approx(0.2 * (1.0 + 0.5) ** 2 + 0.1 * 0.5**2, rel=1e-12)


def test_natural_frequencies_of_two_gears_in_closed_form():
    """w^2 = k (Ra^2/Ja + Rb^2/Jb), the rigid motion exactly zero; unit modal mass; all strain energy in the teeth."""
    found = modes(Train((A, B), meshes=(mesh(),)))
    exact = math.sqrt(1e8 * (0.05**2 / 1e-3 + 0.1**2 / 2e-2)) / (2 * math.pi)
    assert found.frequencies[0] == 0.0
    assert found.frequencies[1] == pytest.approx(exact, rel=1e-13)
    assert found.shapes.T @ np.diag([1e-3, 2e-2]) @ found.shapes == pytest.approx(np.eye(2), abs=1e-12)
    assert found.mesh_energy[1, 0] == pytest.approx(1.0, rel=1e-12)


def test_a_soft_mode_keeps_its_digits_beside_stiff_ones():
    """Two heavy discs on a soft shaft with a stiff light gear pair between: 1e-3 rad/s beside 1e6 rad/s."""
    heavy = Body("x", 1.0), Body("y", 1.0)
    light = Body("a", 1e-6), Body("b", 1e-6)
    train = Train(
        (heavy[0], *light, heavy[1]),
        (Shaft("1", "x", "a", 2e-6), Shaft("2", "b", "y", 2e-6)),
        (mesh(ra=0.1, rb=0.1, za=20, zb=20, k=1e8),),
    )
    # by hand for rigid teeth (their compliance changes 1e-12): both shafts in series between the heavy discs
    soft = modes(train).frequencies[1] * 2 * math.pi
    assert soft == pytest.approx(math.sqrt(2 * 1e-6), rel=1e-5)
    import mpmath

    with mpmath.workdps(40):
        n = train.size
        K, M = mpmath.matrix(stiffness_matrix(train).tolist()), train.inertia
        scaled = mpmath.matrix(n, n)
        for i in range(n):
            for j in range(n):
                scaled[i, j] = K[i, j] / mpmath.sqrt(mpmath.mpf(float(M[i])) * mpmath.mpf(float(M[j])))
        values = sorted(float(v) for v in mpmath.eigsy(scaled, eigvals_only=True))
    assert soft**2 == pytest.approx(values[1], rel=1e-3)


def test_damped_eigenvalues():
    c = mesh_damping(0.1, 1e8, 0.05, 0.1, 1e-3, 2e-2)
    train = Train((A, B), meshes=(mesh(damping=c),))
    values = damped_eigenvalues(train)
    w = 2 * math.pi * modes(train).frequencies[1]
    assert np.sort(values[2:].imag) == pytest.approx(np.array([-1, 1]) * w * math.sqrt(1 - 0.01), rel=1e-9)
    assert values[2:].real == pytest.approx(-0.1 * w, rel=1e-9)
    assert np.all(np.abs(values[:2]) < 1e-2)


def test_campbell_diagram():
    train = Train((A, B), meshes=(mesh(),))
    found = campbell(train, np.linspace(0, 2000, 5), harmonics=2)
    assert found.lines.shape == (1, 2, 5)
    assert found.lines[0, 1] == pytest.approx(2 * found.lines[0, 0])
    # at the critical speed the harmonic is at the natural frequency
    assert train.mesh_frequencies(found.critical[0, 1, 0])[0] * 2 == pytest.approx(found.natural[0])
    with pytest.raises(RangeError, match="at least 1"):
        campbell(train, [1.0], harmonics=0)


def test_parts_from_dimensions():
    """Disc pi rho b R^4/2; shaft pi d^4 G/(32 l); damping from ratios (TM-100180, 14 to 16)."""
    assert disc_inertia(0.1, 0.02, 7850.0) == pytest.approx(math.pi * 7850 * 0.02 * 1e-4 / 2)
    assert disc_inertia(0.1, 0.02, 7850.0, 0.05) == pytest.approx(disc_inertia(0.1, 0.02, 7850.0) * (1 - 1 / 16))
    assert shaft_stiffness(0.5, 0.03, 80e9) == pytest.approx(math.pi * 0.03**4 / 32 * 80e9 / 0.5)
    assert shaft_damping(0.05, 1e4, 2.0, 2.0) == pytest.approx(0.1 * math.sqrt(1e4))
    with pytest.raises(InputError, match="smaller than the radius"):
        disc_inertia(0.1, 0.02, 7850.0, 0.1)
    with pytest.raises(InputError, match="smaller than the diameter"):
        shaft_stiffness(0.1, 0.02, 80e9, 0.02)


def test_rigid_shafts_of_a_case_join_bodies_in_damping_ratios():
    """Motor and load on rigid shafts: one oscillator, damped by the ratio that the case asks of its gear pair."""
    case = tomllib.loads((Path(__file__).parents[2] / "cases" / "lin_dynamic_factor.toml").read_text())
    for shaft in case["train"]["shaft"].values():
        for key in set(shaft) - {"a", "b"}:
            del shaft[key]
        shaft["rigid"] = True
    (mesh,) = case["train"]["mesh"].values()
    swinging = damped_eigenvalues(build_train(train_inputs(build_scene(case, "rigid", Path())).spec))[-1]
    assert -swinging.real / abs(swinging) == pytest.approx(mesh["damping_ratio"], rel=1e-9)


def test_mode_shapes_have_one_sign():
    """The first of the largest turns is positive: a shape and its mirror image are one mode, and rounding chose."""
    shaft = Shaft("s", "b", "c", 2e4)
    for scale in (1.0, 1.0 + 1e-12, 0.3, 7.0):
        bodies = tuple(Body(name, scale * inertia) for name, inertia in (("a", 1e-3), ("b", 2e-2), ("c", 1e-3)))
        shapes = modes(Train(bodies, (shaft,), (mesh(),))).shapes[:, 1:]
        assert (shapes[np.abs(shapes).argmax(axis=0), np.arange(shapes.shape[1])] > 0.0).all()
    like = tuple(Body(name, 1e-3) for name in "abc")
    springs = Shaft("1", "a", "b", 1e4), Shaft("2", "b", "c", 1e4)
    assert modes(Train(like, springs)).shapes[0, 1] > 0.0  # ends that turn alike: the first of both
