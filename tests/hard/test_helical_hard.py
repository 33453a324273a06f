"""Helical pairs at their limits: no helix, no misalignment, modes and curvatures that coincide."""

import math

import mpmath
import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.contact.unloaded.contact_ellipse import contact_ellipse
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.tooth_contact import mesh_cycle, tooth_contact
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.modal_indices import mode_table
from fegear.dynamics.helical_pair.model import ReducedPairModel
from fegear.dynamics.helical_pair.transmissibility import reduced_transmissibility

DEG, ARCMIN = math.pi / 180.0, math.pi / 10800.0


def pair(beta, errors, teeth=(30, 61), width=0.03, parabola=0.0):
    hands = ("left", "right") if beta > 0.0 else ("spur", "spur")
    gears = [helical_gear(z, 4e-3, 20.0 * DEG, beta, width, h) for z, h in zip(teeth, hands, strict=True)]
    return HelicalPair(*gears, errors, parabola=parabola)


angles = st.floats(-5.0, 5.0).map(lambda a: a * ARCMIN)


@pytest.mark.examples(6, 120)
@given(angles, st.floats(-6.0, 6.0), st.sampled_from([0.0, 1.0]))
@pytest.mark.long
def test_a_helix_angle_that_vanishes_leaves_the_spur_pair(shaft, lead, parabola):
    errors = Misalignment(shaft_angle=shaft, profile_angle=lead * ARCMIN)
    assume(abs(shaft) > 0.01 * ARCMIN)
    spur = mesh_cycle(pair(0.0, errors, parabola=parabola), 24)
    size, slope = np.abs(spur.error).max(), math.inf
    for beta in (1e-4, 1e-7, 1e-10, 1e-14):
        found = mesh_cycle(pair(beta, errors, parabola=parabola), 24)
        # Shaft angle and lead may cancel in the spur pair, so the bound is loose; that it is of first order is not.
        off = np.abs(found.error - spur.error).max()
        slope = off / beta if beta == 1e-4 else slope
        assert off < size * (200.0 * beta + 1e-9)
        assert off < 1.5 * slope * beta + 1e-9 * size
    ranges = [tooth_contact(pair(beta, errors, parabola=parabola), 24).peak_to_peak for beta in (0.0, 1e-10)]
    assert abs(ranges[1] - ranges[0]) < size * (200.0 * 1e-10 + 1e-9)


@pytest.mark.dear
@pytest.mark.examples(6, 120)
@given(st.sampled_from([0.0, 12.0, 30.0]), angles, angles, st.integers(20, 60), st.integers(20, 90))
def test_error_is_proportional_to_a_misalignment_that_vanishes(beta, shaft, lead, n1, n2):
    """Down to errors of 1e-9 rad, a tenth at a time: proportional, whichever edges touch; zero at zero."""
    assume(abs(shaft) + abs(lead) > 0.1 * ARCMIN)
    assume(beta > 0.0 or lead == 0.0 or abs(lead) > 1e-6 * ARCMIN)
    largest = []
    for part in (1e-3, 1e-4, 1e-5):
        errors = Misalignment(shaft_angle=part * shaft, lead_angle=part * lead)
        found = mesh_cycle(pair(beta * DEG, errors, (n1, n2)), 24)
        assert np.isfinite(found.error).all()
        largest.append(np.abs(found.error).max() / part)
    assert largest[1:] == pytest.approx(largest[:-1], rel=2e-2, abs=1e-9)
    aligned = mesh_cycle(pair(beta * DEG, Misalignment(), (n1, n2)), 24)
    assert np.abs(aligned.error).max() < 1e-12


def small_model(psi, alpha_z=0.5, alpha_theta=0.6, kappa=0.2):
    mesh = MeshParameters(3e8, kappa, 1.0 / 3.0 + kappa**2, psi)
    return ReducedPairModel.from_ratios(
        mesh, mass=2.9, aspect_ratio=0.6, alpha_y=0.9, alpha_z=alpha_z, alpha_theta=alpha_theta, modal_damping=0.03
    )


def test_a_base_helix_angle_that_vanishes_leaves_the_spur_pair_s_transmissibility():
    spur = small_model(0.0)
    w = spur.natural_frequency * np.linspace(0.05, 2.5, 60)
    straight = reduced_transmissibility(spur, w)
    errors = []
    for psi in (1e-3, 1e-5, 1e-7):
        found = reduced_transmissibility(small_model(psi), w)
        errors.append(np.abs(found.G - straight.G).max() / np.abs(straight.G).max())
    assert errors[1] == pytest.approx(1e-2 * errors[0], rel=0.05)
    assert errors[2] == pytest.approx(1e-2 * errors[1], rel=0.05)
    # Without a helix nothing pushes along the axis.
    assert np.abs(straight.G[:, 1]).max() == 0.0


def test_modes_that_share_a_frequency_are_reported_and_their_sums_hold():
    """z and theta_y of a spur pair move on their bearings alone: alpha_theta = alpha_z / 2 puts them together."""
    together = mode_table(small_model(0.0, alpha_z=0.8, alpha_theta=0.4))
    assert any(": repeated natural frequencies (within" in remark for remark in together.remarks)
    assert together.shape_doubt.max() > 0.1
    apart = mode_table(small_model(0.0, alpha_z=0.8, alpha_theta=0.5))
    assert apart.remarks == ()
    assert apart.shape_doubt.max() < 1e-10
    # What the pair transmits does not depend on the basis that was chosen.
    exact, near = (
        reduced_transmissibility(small_model(0.0, 0.8, a), np.array([1e4, 1e5])).G for a in (0.4, 0.4 * (1.0 + 1e-12))
    )
    assert near == pytest.approx(exact, rel=1e-9, abs=1e-3)


def test_a_mode_too_soft_beside_the_others_is_reported_before_it_is_taken_for_rigid():
    soft = mode_table(small_model(0.3, alpha_z=1e-9))
    assert any("round-off error of the frequencies" in remark for remark in soft.remarks)
    assert mode_table(small_model(0.3, alpha_z=1e-3)).remarks == ()


@pytest.mark.parametrize("apart", [0.0, 1e-15, 1e-9, 1e-4, 1.0, 1e6, 1e12])
def test_contact_ellipses_keep_their_digits_where_curvatures_coincide_and_where_they_do_not(apart):
    small, load, modulus = 20.0, 1500.0, 1.15e11
    found = contact_ellipse(small * (1.0 + apart), small, load, modulus)
    with mpmath.workdps(50):
        ratio = 1 + mpmath.mpf(apart) if apart > 1e-14 else mpmath.mpf(float(small * (1.0 + apart))) / small

        def misfit(log_k):
            k2 = mpmath.exp(2 * log_k)  # (b / a)^2
            e2 = 1 - k2
            kk, ee = mpmath.ellipk(e2), mpmath.ellipe(e2)
            d = (kk - ee) / e2
            return mpmath.log((kk - d) / (k2 * d)) - mpmath.log(ratio)

        log_k = mpmath.findroot(misfit, (mpmath.mpf(-1e-20), mpmath.mpf(-60)), solver="anderson", tol=1e-60) if (
            apart > 1e-14
        ) else mpmath.mpf(-1e-20)  # fmt: skip
        k2 = mpmath.exp(2 * log_k)
        d = (mpmath.ellipk(1 - k2) - mpmath.ellipe(1 - k2)) / (1 - k2)
        long = mpmath.cbrt(3 * load * d / (mpmath.pi * modulus * small))
        exact = float(long), float(long * mpmath.exp(log_k))
    assert float(found.long) == pytest.approx(exact[0], rel=1e-12)
    assert float(found.short) == pytest.approx(exact[1], rel=1e-12)
