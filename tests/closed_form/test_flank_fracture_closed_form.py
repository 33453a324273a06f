"""Stresses below a line contact, mean shear, hardness curves and exposure against own integrals and limits."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fegear.base.errors import RangeError
from fegear.formulas.hardened_case import HardenedCase, depth_of, lang_hardness, lang_residual_stress
from fegear.formulas.hertz import stresses_below
from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, HARDNESS_FACTOR, exposure, half_width, mean_shear
from fegear.formulas.iso6336.part5_materials import crushing_depth, recommended
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack


def flamant(x, z, steps=20000):
    """Stresses below an elliptical pressure, as the sum of Flamant's lines of force; u = cos(t) takes its ends off."""
    t = (np.arange(steps) + 0.5) * math.pi / steps
    away = x - np.cos(t)
    ray = -2.0 / math.pi * np.sin(t) ** 2 * (math.pi / steps) * z / (away**2 + z**2) ** 2
    return (ray * away**2).sum(), (ray * z**2).sum(), (ray * away * z).sum()


def test_stresses_below_a_line_contact_are_the_integral_of_flamant_s():
    rng = np.random.default_rng(4)
    places = [
        *zip(rng.uniform(-4.0, 4.0, 40), rng.uniform(0.02, 6.0, 40), strict=True),
        (1.0, 0.1),
        (0.0, 0.7),
        (1.0, 1.0),
    ]
    for x, z in places:
        assert [float(s) for s in stresses_below(x, z)] == pytest.approx(flamant(x, z), abs=2e-9), (x, z)


def test_largest_shear_is_three_tenths_of_the_pressure_at_786_thousandths_of_the_half_width():
    def shear(z):
        along, down, _ = stresses_below(0.0, z)
        return -0.5 * float(along - down)

    found = minimize_scalar(shear, bounds=(0.3, 1.5), method="bounded", options={"xatol": 1e-10})
    assert found.x == pytest.approx(0.78615138, abs=1e-6)
    assert -found.fun == pytest.approx(0.3002831060, rel=1e-9)
    orthogonal = stresses_below(math.sqrt(0.75), 0.5)[2]  # p_0 / 4, Johnson's section 4.2
    assert abs(float(orthogonal)) == pytest.approx(0.25, rel=1e-12)


def test_stresses_at_the_edges():
    for x, pressed in ((0.0, 1.0), (0.6, 0.8), (-1.0, 0.0), (3.0, 0.0)):
        along, down, shear = stresses_below(x, 0.0)
        assert [float(along), float(down)] == pytest.approx([-pressed] * 2, abs=1e-15)
        assert float(shear) == pytest.approx(0.0, abs=1e-15)
    deep = np.array([float(value) for value in stresses_below(0.0, np.inf)])
    assert (np.abs(deep) < 1.01e-4).all()  # as good as nothing, and no overflow
    far = stresses_below(0.0, 900.0)  # a line of force 2 w / (pi z), w = pi / 2
    assert float(far[1]) == pytest.approx(-1.0 / 900.0, rel=1e-5)
    # the difference of two terms of 1800 that is 7e-10 of them
    assert float(far[0]) == pytest.approx(
        -1.0 / (math.hypot(1.0, 900.0) * (900.0 + math.hypot(1.0, 900.0)) ** 2), rel=1e-2
    )


def test_mean_shear_is_the_root_mean_square_over_all_planes():
    rng = np.random.default_rng(7)
    normals = rng.standard_normal((400_000, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    one, axial, down, shear = 130.0, -400.0, -900.0, 210.0
    tensor = np.array([[one, shear, 0.0], [shear, down, 0.0], [0.0, 0.0, axial]])
    traction = normals @ tensor
    across = (normals * traction).sum(axis=1)
    squares = (traction**2).sum(axis=1) - across**2
    assert float(mean_shear(one, axial, down, shear)) == pytest.approx(math.sqrt(squares.mean()), rel=3e-3)
    assert float(mean_shear(-5.0, -5.0, -5.0)) == 0.0


def test_lang_s_hardness_passes_its_points():
    depth = np.linspace(0.0, 4e-3, 200)
    for surface, core, case in ((697.5, 318.6, 0.8e-3), (750.0, 420.0, 1.5e-3), (551.0, 549.0, 1e-3)):
        found = lang_hardness(depth, surface, core, case)
        assert found[0] == pytest.approx(surface)
        assert float(lang_hardness(case, surface, core, case)) == pytest.approx(550.0, rel=1e-12)
        assert (np.diff(found) < 0.0).all() or surface == 551.0
        assert (found >= core).all()
    for surface, core in ((540.0, 300.0), (700.0, 560.0)):
        with pytest.raises(RangeError, match="550 HV"):
            lang_hardness(depth, surface, core, 1e-3)
    residual = lang_residual_stress(np.array([300.0, 400.0, 600.0, 600.1, 700.0]), 300.0)
    assert residual[:3] == pytest.approx([0.0, -125e6, -375e6])
    assert residual[3] == pytest.approx(residual[2], rel=3e-3)  # both lines meet but for rounded numbers


def test_a_measured_profile_is_followed_and_has_its_own_case_depth():
    points = ((0.0, 0.5e-3, 1e-3, 2e-3), (720.0, 650.0, 500.0, 330.0))
    assert depth_of(points) == pytest.approx(0.5e-3 + 0.5e-3 * 100.0 / 150.0)
    assert math.isnan(depth_of(((0.0, 1e-3), (700.0, 600.0))))
    case = HardenedCase(720.0, 330.0, depth_of(points), points, ((0.0, 1e-3), (-400e6, 0.0)))
    assert case.hardness([0.25e-3, 5e-3]) == pytest.approx([685.0, 330.0])
    assert case.residual_stress([0.5e-3, 5e-3]) == pytest.approx([-200e6, 0.0])


def test_exposure_without_residual_stress_is_that_under_the_middle_and_falls_with_compression():
    modulus = 226e9
    pressed, radius = np.array([1.2e9, 0.0]), np.array([0.012, 0.02])
    width = half_width(pressed, radius, modulus)
    depth = np.linspace(0.0, 3e-3, 150)
    hard, none = np.full(150, 500.0), np.zeros(150)
    found = exposure(depth, pressed, width, hard, none)
    along, down, _ = stresses_below(0.0, depth / width[0])
    middle = 1.2e9 * mean_shear(along, 0.3 * (along + down), down)
    assert found.stress[0] == pytest.approx(middle, rel=1e-12)
    assert found.load_stress == pytest.approx(found.stress)
    assert found.exposure[0] == pytest.approx(middle / (HARDNESS_FACTOR * 500.0) + CALIBRATION)
    assert found.exposure[1] == pytest.approx(np.full(150, CALIBRATION))  # nothing presses
    squeezed = exposure(depth, pressed, width, hard, np.full(150, -300e6))
    assert (squeezed.stress[0] <= found.stress[0] * (1.0 + 1e-12)).all()
    assert (squeezed.stress >= 0.0).all()
    twice = exposure(depth, pressed, width, hard, none, material_factor=2.0)
    assert twice.stress == pytest.approx(found.stress)
    assert twice.strength == pytest.approx(2.0 * found.strength)


def test_residual_stress_counts_over_the_whole_passage():
    """Own sums of lines of force at many places, and the planes' mean shear by eigenvalues of the deviator."""
    pressed, residual, ratios = 1.4e9, -320e6, np.array([0.5, 1.5, 4.0])
    width = np.array([0.3e-3])
    depth = ratios * width[0]
    found = exposure(depth, np.array([pressed]), width, np.full(3, 600.0), np.full(3, residual))

    def shear_of(x, z):
        along, down, shear = (pressed * value for value in flamant(x, z, 2000))
        axial = 0.3 * (along + down) + residual
        tensor = np.array([[along + residual, shear, 0.0], [shear, down, 0.0], [0.0, 0.0, axial]])
        values = np.linalg.eigvalsh(tensor)
        return math.sqrt(0.2 * ((values - values.mean()) ** 2).sum())

    alone = abs(residual) * math.sqrt(2.0 / 15.0)
    for i, z in enumerate(ratios):
        own = max(shear_of(x, z) for x in np.linspace(0.0, 2.0 * (1.0 + z), 400)) - alone
        assert found.stress[0, i] == pytest.approx(own, rel=2e-3)


def test_crushing_depth_is_a_multiple_of_the_depth_of_the_largest_shear():
    """Eht_c = 2 sigma_H rho_C / U_H with rho_C of the normal section; the half-width is 4 sigma_H rho_C / E_r."""
    rack = BasicRack.named("A", math.radians(20.0))
    one, two = (
        Gear(Tooth(z, rack, helix_angle=0.25), 4e-3, 0.01, 0.02, hand=hand) for z, hand in ((23, "right"), (58, "left"))
    )
    pair = GearPair(one, two)
    from fegear.formulas.flank_speeds import flank_speeds

    radius = float(flank_speeds(pair, 0.0, 1.0).relative_radius)
    assert crushing_depth(pair, 1.3e9, 66e9) == pytest.approx(2.0 * 1.3e9 * radius / 66e9, rel=1e-12)
    assert crushing_depth(GearPair(two, one), 1.3e9, 66e9) == pytest.approx(crushing_depth(pair, 1.3e9, 66e9))
    assert recommended(4e-3) == pytest.approx((0.6e-3, 1e-3, 1.6e-3))
    assert recommended(20e-3)[2] == 6e-3
