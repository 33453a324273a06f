"""Transmissibility: two models against each other, against plain inversion, and against laws."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.base.errors import ConvergenceError, GeometryError, InputError, RangeError
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters, mesh_parameters, partial_face_mu
from fegear.dynamics.helical_pair.modal_indices import mode_table, rank_modes
from fegear.dynamics.helical_pair.mode_following import follow_modes
from fegear.dynamics.helical_pair.model import HelicalPairModel, P, ReducedPairModel, RigidGear
from fegear.dynamics.helical_pair.transmissibility import (
    complex_modes,
    compliance,
    reduced_transmissibility,
    transmissibility,
)
from fegear.dynamics.train.modes import undamped_modes

DEG = math.pi / 180.0


def psd(rng, n=5, size=1.0):
    a = rng.normal(size=(n, n))
    return size * (a @ a.T) / n


def unequal(seed=0, damped=True, psi=25.0, kappa=0.3, mesh_damping=2e-6):
    rng = np.random.default_rng(seed)
    scale = np.array([1.0, 1.0, 0.03, 0.05, 0.05])  # bearing matrices per metre and radian

    def gear(mass, a, b):
        K = scale[:, None] * psd(rng, size=3e8) * scale
        C = scale[:, None] * psd(rng, size=300.0 if damped else 0.0) * scale
        for free in (K, C):
            free[4] = free[:, 4] = 0.0  # the shaft turns freely
        return RigidGear(mass, (0.4 * mass * a**2, 0.5 * mass * a**2, 0.6 * mass * a**2), a, b, K, C)

    mesh = MeshParameters(3e8, kappa, partial_face_mu(kappa), psi * DEG)
    return HelicalPairModel(gear(2.0, 0.05, 0.02), gear(5.0, 0.09, 0.02), mesh, mesh_damping if damped else 0.0)


def equal(psi=30.0, kappa=0.5, zeta=0.03):
    K = np.diag([6e8, 1.5e8, 2e5, 4e5, 0.0])
    K[0, 3] = K[3, 0] = 3e6  # a bearing that couples y and theta_y
    C = 1e-6 * K
    sign = np.diag(P)
    g = RigidGear(2.882, (0.008, 0.009, 0.0143), 0.07048, 0.02114, K, C)
    for matrix in (g.bearing_stiffness, g.bearing_damping):
        with pytest.raises(ValueError, match="read-only"):
            matrix[0, 0] = 1.0
    h = RigidGear(2.882, (0.008, 0.009, 0.0143), 0.07048, 0.02114, sign[:, None] * K * sign, sign[:, None] * C * sign)
    return HelicalPairModel(g, h, MeshParameters(3e8, kappa, partial_face_mu(kappa), psi * DEG), 1e-6, zeta)


def plain(model, w):
    D = model.stiffness + 1j * w * model.damping - w**2 * np.diag(model.mass)
    return np.linalg.inv(D)


def test_ten_and_five_degrees_of_freedom_agree():
    model = equal()
    small = model.reduced()
    w = model.natural_frequency * np.linspace(0.05, 3.0, 200)
    big, red = transmissibility(model, w), reduced_transmissibility(small, w)
    scale = np.abs(red.G).max()
    assert np.abs(big.G - red.G).max() < 1e-10 * scale
    assert np.abs(big.R_ii - red.R).max() < 1e-10 * np.abs(red.R).max()
    assert np.abs(big.R_ij @ P - red.R).max() < 1e-10 * np.abs(red.R).max()
    assert np.abs(big.G_B_i - red.G_B).max() < 1e-10 * np.abs(red.G_B).max()
    assert np.abs(big.R_B_ii + P @ big.R_B_ji - red.R_B).max() < 1e-10 * np.abs(red.R_B).max()
    # Modes: the mesh modes of the ten are the modes of the five, with the same indices.
    ten, five = mode_table(model), mode_table(small)
    in_mesh = np.flatnonzero((ten.normal > 1e-9) | (ten.bending > 1e-9))
    assert ten.ratio[in_mesh] == pytest.approx(five.ratio, rel=1e-10)
    assert ten.normal[in_mesh] == pytest.approx(five.normal, rel=1e-8)
    assert ten.coupling[in_mesh] == pytest.approx(five.coupling, rel=1e-8)
    for a, b in zip(rank_modes(small), [r for r in rank_modes(model) if r.weight > 1e-9], strict=True):
        assert a.weight == pytest.approx(b.weight, rel=1e-8)
        assert a.resonance == pytest.approx(b.resonance, rel=1e-8)


@given(st.integers(0, 1000), st.floats(0.0, 45.0), st.floats(-1.0, 1.0))
def test_direct_state_space_and_plain_inversion_agree_for_general_damping(seed, psi, kappa):
    model = unequal(seed, psi=psi, kappa=kappa)
    w = model.natural_frequency * np.linspace(0.1, 2.0, 15)
    full = np.array([plain(model, x) for x in w])
    # Plain inversion contains the rigid-body motion -1/w^2; forces do not feel it.
    natural, shapes = undamped_modes(model.mass, model.stiffness)
    free = shapes[:, natural == 0.0]
    assert free.shape[1] == 1
    flexible = full + np.einsum("ir,m,jr->mij", free, 1.0 / w**2, free)
    size = np.abs(flexible).max()
    assert np.abs(compliance(model, w) - flexible).max() < 1e-9 * size
    assert np.abs(compliance(model, w, "state-space") - flexible).max() < 1e-8 * size
    G = transmissibility(model, w).G
    a = model.mesh_stiffness_matrix + 1j * w[:, None, None] * model.mesh_damping_matrix
    drive = np.concatenate([a, P @ a], axis=1)
    plain_G = a - a @ (full[:, :5] + P @ full[:, 5:]) @ drive
    assert np.abs(G - plain_G).max() < 1e-8 * np.abs(G).max()


def test_direct_and_modal_sum_agree_for_proportional_damping():
    model = unequal(3, damped=False)
    model = HelicalPairModel(model.driver, model.driven, model.mesh, 0.0, 0.04)
    w = model.natural_frequency * np.linspace(0.0, 3.0, 50)
    a, b, c = (compliance(model, w, method) for method in ("direct", "modal", "state-space"))
    assert np.abs(a - b).max() < 1e-12 * np.abs(a).max()
    assert np.abs(a - c).max() < 1e-10 * np.abs(a).max()


@given(st.integers(0, 1000), st.floats(0.05, 2.5))
def test_forces_balance_on_every_gear(seed, ratio):
    model = unequal(seed)
    w = ratio * model.natural_frequency
    t = transmissibility(model, w)
    rng = np.random.default_rng(seed)
    delta, f_i, f_j = rng.normal(size=(3, 5))
    mesh_i = t.G[0] @ delta - t.R_ii[0] @ (f := 1e8 * f_i) - t.R_ij[0] @ (g := 1e8 * f_j)
    bearing_i = -(t.G_B_i[0] @ delta + t.R_B_ii[0] @ f + t.R_B_ij[0] @ g)
    bearing_j = -(t.G_B_j[0] @ delta + t.R_B_ji[0] @ f + t.R_B_jj[0] @ g)
    H = plain(model, w)
    a = model.mesh_stiffness_matrix + 1j * w * model.mesh_damping_matrix
    q = H @ np.concatenate([a @ delta + f, P @ a @ delta + g])
    acceleration = -(w**2) * model.mass * q
    size = np.abs(np.concatenate([mesh_i, f, g])).max()
    # Newton: mass times acceleration = mesh + bearing + external, on both gears; the mesh force on j is P times.
    assert np.abs(acceleration[:5] - mesh_i - bearing_i - f).max() < 1e-7 * size
    assert np.abs(acceleration[5:] - P @ mesh_i - bearing_j - g).max() < 1e-7 * size


def test_forces_stay_accurate_down_to_frequency_zero():
    model = unequal(1)
    w = np.array([0.0, 1e-6, 1e-3, 1.0])
    t = transmissibility(model, w)
    # A torque pair that balances through the mesh passes on in full: the mesh carries what gear j takes.
    f_i, f_j = np.array([0.0, 0.0, 0.0, 0.0, 1.0]), np.array([0.0, 0.0, 0.0, 0.0, -1.0])
    passed = t.R_ii @ f_i + t.R_ij @ f_j
    assert passed[:, 4] == pytest.approx(passed[0, 4], rel=1e-6)
    assert np.isfinite(t.R_B_ij).all()
    assert np.abs(t.G[0] - t.G[1]).max() < 1e-9 * np.abs(t.G).max()
    # Static transmission error of a free pair turns the gears and loads nothing.
    assert np.abs(t.G[0] @ np.array([0, 0, 0, 0, 1.0])).max() < 1e-9 * model.mesh.stiffness


def test_rigid_body_motions_are_distinguished():
    model = unequal(2)
    assert (mode_table(model).ratio == 0.0).sum() == 1
    spur = ReducedPairModel.from_ratios(
        MeshParameters(3e8, 0.0, 0.0, 0.0), mass=3.0, aspect_ratio=0.3, alpha_y=2.0, alpha_z=0.0, alpha_theta=0.0
    )
    # Without bearings in z and tilt, a spur mesh with mu = 0 leaves three of the five coordinates free.
    table = mode_table(spur)
    assert (table.ratio == 0.0).sum() == 3
    assert table.ratio[:2] == pytest.approx([1.618034, 0.618034], abs=1e-6)
    assert np.isfinite(reduced_transmissibility(spur, [0.0, 100.0]).G).all()


def test_a_free_motion_with_drag_is_kept():
    base = unequal(4, damped=False)
    C = np.zeros((5, 5))
    C[4, 4] = 0.5  # viscous drag on the driver's rotation, no spring
    dragged = RigidGear(2.0, base.driver.inertia, 0.05, 0.02, base.driver.bearing_stiffness, C)
    model = HelicalPairModel(dragged, base.driven, base.mesh, 0.0, 0.0)
    w = model.natural_frequency * np.array([0.01, 0.37, 1.1])
    full = np.array([plain(model, x) for x in w])
    assert np.abs(compliance(model, w) - full).max() < 1e-9 * np.abs(full).max()
    assert np.abs(compliance(model, w, "state-space") - full).max() < 1e-9 * np.abs(full).max()


def test_resonance_without_damping_and_critical_damping_are_refused():
    model = ReducedPairModel.from_ratios(
        MeshParameters(3e8), mass=3.0, aspect_ratio=0.3, alpha_y=2.0, alpha_z=0.5, alpha_theta=0.4
    )
    resonance = mode_table(model).frequency[1]
    for method in ("direct", "modal", "state-space"):
        with pytest.raises(RangeError, match="is an undamped resonance: unbounded response"):
            compliance(model, [10.0, resonance], method)
    critical = ReducedPairModel.from_ratios(
        MeshParameters(3e8), mass=3.0, aspect_ratio=0.3, alpha_y=2.0, alpha_z=0.5, alpha_theta=0.4, modal_damping=1.0
    )
    with pytest.raises(ConvergenceError, match="Critical damping"):
        complex_modes(critical)
    assert np.isfinite(compliance(critical, [0.0, resonance])).all()


@pytest.mark.parametrize(
    ("build", "error", "words"),
    [
        (lambda: MeshParameters(-1.0), InputError, "positive"),
        (lambda: MeshParameters(1.0, 0.9, 0.5), RangeError, "kappa"),
        (lambda: MeshParameters(1.0, base_helix_angle=2.0), RangeError, "must be between -90 and 90 deg"),
        (lambda: partial_face_mu(1.5), RangeError, "within"),
        (lambda: RigidGear(1.0, (1.0, 1.0, 0.0), 0.1, 0.1), InputError, "positive"),
        (
            lambda: RigidGear(1.0, (1.0, 1.0, 1.0), 0.1, 0.1, np.diag([-1.0, 0, 0, 0, 0])),
            RangeError,
            "negative eigenvalue",
        ),
        (lambda: RigidGear(1.0, (1.0, 1.0, 1.0), 0.1, 0.1, np.ones((2, 2))), (InputError, ValueError), "5"),
        (lambda: unequal().reduced(), GeometryError, "general model"),
        (lambda: compliance(unequal(), [-1.0]), InputError, "must be finite, non-negative"),
        (lambda: compliance(unequal(), [1.0], "guess"), InputError, "must be"),
        (
            lambda: mesh_parameters([0.0], [1.0], 1.0, face_width=1.0),
            InputError,
            "must be at least two increasing values, one",
        ),
        (
            lambda: mesh_parameters([0.0, 1.0], [0.0, 0.0], 1.0, face_width=1.0),
            InputError,
            "must be finite and non-negative, with at least",
        ),
        (lambda: mesh_parameters([0.0, 1.0], [1.0, 1.0], 0.0, face_width=1.0), InputError, "positive where"),
    ],
)
def test_nonsense_is_refused(build, error, words):
    with pytest.raises(error, match=words):
        build()


@given(st.floats(-0.9, 0.9), st.floats(0.01, 0.2), st.integers(3, 40))
def test_uniform_contact_from_one_end_has_the_papers_mu(kappa, width, n):
    b = 0.5 * width
    lo, hi = (-b, b * (2.0 * kappa + 1.0)) if kappa < 0.0 else (b * (2.0 * kappa - 1.0), b)
    assume(hi - lo > 1e-3 * b)
    found = mesh_parameters(np.linspace(lo, hi, n), np.full(n, 3e5), 1e-5, face_width=width)
    assert found.kappa == pytest.approx(kappa, abs=1e-12)
    assert found.mu == pytest.approx(partial_face_mu(kappa), abs=1e-12)
    assert found.stiffness == pytest.approx(3e10 * (hi - lo), rel=1e-12)
    shifted = mesh_parameters(np.linspace(lo, hi, n), np.full(n, 3e5), 1e-5, face_width=width, centre_of_mass=0.3 * b)
    assert shifted.kappa == pytest.approx(kappa - 0.3, abs=1e-12)


@given(st.floats(-0.8, 0.8), st.floats(-0.9, 0.9))
def test_mesh_matrix_is_never_indefinite(psi, kappa):
    for mu in (kappa**2, partial_face_mu(kappa)):
        matrix = MeshParameters(2.0, kappa, mu, psi).matrix()
        assert np.linalg.eigvalsh(matrix).min() > -1e-12
        assert np.linalg.matrix_rank(matrix, tol=1e-7) == (1 if mu == kappa**2 else 2)


def test_modes_are_followed_through_crossings():
    def build(alpha):
        return ReducedPairModel.from_ratios(
            MeshParameters(3e8), mass=2.882, aspect_ratio=0.3, alpha_y=2.0, alpha_z=alpha,
            alpha_theta=0.4,
        )  # fmt: skip

    # The axial mode, sqrt(alpha_z)/2, crosses the rocking and bending modes between alpha_z = 0.5 and 2.
    followed = follow_modes(build, [0.5, 2.0])
    assert followed.ratio.shape == (2, 5)
    assert sorted(followed.ratio[1]) == pytest.approx(sorted(mode_table(build(2.0)).ratio), rel=1e-12)
    exact = build(2.0)
    residual = exact.stiffness @ followed.shapes[1] - (exact.mass[:, None] * followed.shapes[1]) * (
        (followed.ratio[1] * exact.natural_frequency) ** 2
    )
    assert np.abs(residual).max() < 1e-6 * np.abs(exact.stiffness @ followed.shapes[1]).max()
    fine = follow_modes(build, np.linspace(0.5, 2.0, 302))
    assert fine.ratio[-1] == pytest.approx(followed.ratio[1], rel=1e-10), "the way there does not matter"


def test_a_contact_at_the_end_of_the_face_may_be_rounded():
    """Digits that a file or another processor rounds are no reason to refuse a contact; more is."""
    for rounded in (1.0 + 1e-12, -1.0 - 1e-12):
        assert partial_face_mu(rounded) == pytest.approx(1.0, abs=1e-11)
        MeshParameters(3e8, rounded, partial_face_mu(rounded))
    with pytest.raises(RangeError, match="within"):
        partial_face_mu(1.0 + 1e-6)
