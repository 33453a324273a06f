"""Stiffness matrix of a loaded mesh: small rigid motions given as gaps, laws of rigid bodies, closed forms."""

import math

import numpy as np
import pytest

from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.contact.wide.load_sharing import hat_averages, solve_contact
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
from fegear.contact.wide.mesh_matrix import (
    even_moments,
    mesh_parameters_of,
    mesh_stiffness,
    rigid_motion_rows,
    tilt_lever,
)
from fegear.contact.wide.roll_points import roll_points
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters, mesh_parameters
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE, WIDTH, LOAD = 3e-3, 9e-3, 2000.0


def gear(beta=15.0, hand="right", teeth=20, width=WIDTH):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, width, STEEL, "strain", hand if beta else "spur")


def solid(one):
    m = one.module
    return solve_solid(
        one.tooth, one.twist * m, one.face_width / m, 0.3, one.bore_radius / m, SolidSettings().scaled(2.5), reach=2
    )


@pytest.fixture(scope="module")
def solved():
    gears = {hand: gear(hand=hand) for hand in ("right", "left")}
    return gears, {hand: solid(one) for hand, one in gears.items()}


def flank_pair(solved, driver="right"):
    gears, solids = solved
    driven = "left" if driver == "right" else "right"
    return FlankPair(
        GearPair(gears[driver], gears[driven]), {"driver": solids[driver], "driven": solids[driven]}, positions=4
    )


@pytest.fixture(scope="module")
def known(solved):
    flanks = flank_pair(solved)
    return flanks, flanks.compliance(LOAD)


#: Enough to lift a part of the face off.
MISALIGNED = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([0.0, 40e-6]))


class Moved:
    """Gaps that a rigid motion of approach e and tilt phi adds to."""

    def __init__(self, base, e=0.0, phi=0.0):
        self.base, self.e, self.phi = base, e, phi

    def at(self, pair, lines, _loads=None):
        return self.base.at(pair, lines) - self.e - self.phi * tilt_lever(pair, lines)


@pytest.mark.parametrize("gaps", [FlankGaps(), MISALIGNED], ids=["aligned", "lifted"])
def test_moments_are_the_slopes_of_the_loaded_solution(known, gaps):
    flanks, matrix = known
    found = flanks.solve([LOAD], gaps, matrix)
    lever = hat_averages(found.lines, tilt_lever(flanks.pair, found.lines))
    ms = mesh_stiffness(found, flanks.points)
    k, k1, k2 = ms.moments[:, :, 0]
    # the scalar stiffness of the contact itself, by another path
    np.testing.assert_allclose(k, found.contact.stiffness[:, 0], rtol=1e-12)
    h = 1e-8
    up, down = (flanks.solve([LOAD], Moved(gaps, phi=sign * h), matrix) for sign in (1, -1))
    # under one load, a tilt moves the approach by k_1 / k_0 and the moment by k_2 - k_1^2 / k_0
    rate = (up.transmission_error - down.transmission_error)[:, 0] / (2 * h)
    np.testing.assert_allclose(rate, -k1 / k, rtol=1e-5, atol=1e-5 * WIDTH)
    moment = np.einsum("pml,pm->p", up.contact.force - down.contact.force, lever) / (2 * h)
    np.testing.assert_allclose(moment, k2 - k1**2 / k, rtol=1e-5)
    np.testing.assert_allclose(
        ms.lever[:, 0] * LOAD, np.einsum("pm,pm->p", found.contact.force[:, :, 0], lever), rtol=1e-12
    )
    if gaps is MISALIGNED:
        assert ((found.contact.force == 0.0) & found.lines.present[:, :, None]).any()
        assert np.all(ms.lever < -0.1 * WIDTH)


def test_the_matrix_is_that_of_two_rigid_bodies(known):
    flanks, matrix = known
    ms = mesh_stiffness(flanks.solve([LOAD, 2 * LOAD], MISALIGNED, matrix), flanks.points)
    k = ms.matrix
    assert k.shape == (4, 2, 12, 12)
    np.testing.assert_allclose(k, np.swapaxes(k, -1, -2), rtol=1e-12)
    eigen = np.linalg.eigvalsh(k)
    assert eigen.min() > -1e-9 * eigen.max()
    assert np.all((eigen > 1e-9 * eigen.max()).sum(axis=-1) == 2)
    # all that moves as one body with both gears on it: three shifts, three turns about the pitch point
    pair = flanks.pair
    alpha = pair.working_pressure_angle
    for shift in np.eye(6):
        motion = np.zeros(12)
        for first, sign, one in ((0, 1.0, pair.driver), (6, -1.0, pair.driven)):
            axis = sign * one.base_radius * np.array([1.0, -math.tan(alpha), 0.0])
            motion[first : first + 3] = shift[:3] + np.cross(shift[3:], axis)
            motion[first + 3 : first + 6] = shift[3:]
        force = k @ motion
        assert np.abs(force).max() < 1e-12 * np.abs(k).max()
    # and a motion that the teeth are made for
    turn = np.zeros(12)
    turn[5], turn[11] = 1.0 / pair.driver.base_radius, -1.0 / pair.driven.base_radius
    assert np.abs(k @ turn).max() < 1e-9 * np.abs(k).max()


def test_a_rigid_motion_closes_each_station_by_its_own_normal(known):
    """Rows against the motion of points of both bodies, projected onto the normal of the flank."""
    flanks, matrix = known
    pair, lines = flanks.pair, matrix.lines
    rng = np.random.default_rng(5)
    x, z = lines.x[lines.present], lines.z[lines.present]
    points = np.stack([np.zeros(x.size), x, z], axis=1)
    slope = pair.driver.twist * pair.driver.base_radius
    normal = np.array([0.0, 1.0, slope])  # at right angles to the contact lines x = x_0 - slope z
    assert normal @ np.array([0.0, -slope, 1.0]) == pytest.approx(0.0, abs=1e-15)
    motion = rng.normal(size=12)
    closed = np.zeros(x.size)
    for first, sign, one in ((0, 1.0, pair.driver), (6, -1.0, pair.driven)):
        r = sign * one.base_radius
        axis = np.array([r, -r * math.tan(pair.working_pressure_angle), 0.0])
        moved = motion[first : first + 3] + np.cross(motion[first + 3 : first + 6], points - axis)
        closed += sign * moved @ normal
    e, phi = rigid_motion_rows(pair) @ motion
    np.testing.assert_allclose(e + phi * tilt_lever(pair, lines)[lines.present], closed, atol=1e-12)


def test_mirrored_hands_change_the_sign_of_the_coupling(solved, known):
    flanks, matrix = known
    first = mesh_stiffness(flanks.solve([LOAD], MISALIGNED, matrix), flanks.points)
    mirrored = FlankGaps(face_position=MISALIGNED.face_position, line_gap=MISALIGNED.line_gap[::-1].copy())
    other = flank_pair(solved, "left")
    second = mesh_stiffness(other.solve([LOAD], mirrored), other.points)
    stiff, kappa, mu = first.parameters
    np.testing.assert_allclose(second.parameters[0], stiff, rtol=1e-6)
    np.testing.assert_allclose(second.parameters[1], -kappa, atol=1e-6)
    np.testing.assert_allclose(second.parameters[2], mu, rtol=1e-5)
    np.testing.assert_allclose(second.lever, -first.lever, atol=1e-6 * WIDTH)
    assert np.abs(first.mean_parameters[1]) > 0.1


def winkler(pair, lines):
    """A bed of springs of 1 N/m per square metre: C is the overlap of the hats."""
    h, support = lines.panel, lines.support
    matrix = np.zeros((lines.roll.size, support.shape[1], support.shape[1]))
    at = np.arange(support.shape[1])
    density = np.divide(1.0, support, out=np.zeros_like(support), where=support > 0.0)
    matrix[:, at[:-1], at[:-1]] += h / 3.0
    matrix[:, at[1:], at[1:]] += h / 3.0
    matrix[:, at[:-1], at[1:]] += h / 6.0
    matrix[:, at[1:], at[:-1]] += h / 6.0
    matrix *= density[:, :, None] * density[:, None, :]
    matrix[:, at, at] += np.where(lines.present, 0.0, 1.0)
    return FlankCompliance(lines, matrix, 0.0, np.ones(lines.x.shape), np.ones(lines.x.shape))


@pytest.mark.parametrize("beta", [0.0, 25.0])
def test_a_bed_of_even_springs_has_the_moments_of_its_lines(beta):
    pair = GearPair(gear(beta), gear(beta, "left"))
    points = roll_points(pair, 16)
    lines = contact_lines(pair, points.x, 1e-3, points.weights / points.period)
    known = winkler(pair, lines)
    contact = solve_contact(known, np.zeros(lines.x.shape), np.array([1.0]))
    ms = mesh_stiffness(LoadedFlanks(pair, known, contact, np.ones(1), {}), points)
    np.testing.assert_allclose(ms.moments[0, :, 0], lines.length, rtol=1e-10)
    mean = ms.mean_moments[:, 0]
    even = even_moments(pair, lines)
    np.testing.assert_allclose(mean / mean[0], even, rtol=1e-9, atol=1e-9 * WIDTH)
    stiffness, kappa, mu = ms.parameters[:, :, 0]
    if beta == 0.0:  # uniform over the whole face: b^2 / 3, and the centre in its middle
        np.testing.assert_allclose(mu, 1.0 / 3.0, rtol=1e-10)
        np.testing.assert_allclose(kappa, 0.0, atol=1e-10)
        np.testing.assert_allclose(stiffness, lines.length, rtol=1e-10)
    else:
        np.testing.assert_allclose(stiffness, lines.length / math.cos(pair.driver.base_helix_angle) ** 2, rtol=1e-10)
        assert np.ptp(kappa) > 0.1
    assert np.all(mu >= kappa**2)


def test_a_wide_spur_face_nears_even_springs():
    """Load over the face is even, and the tilt about twice as stiff as springs that know nothing of each other."""
    wide = gear(0.0, width=27e-3)
    one = solid(wide)
    flanks = FlankPair(GearPair(wide, wide), {"driver": one, "driven": one}, positions=1, panel=1.0)
    ms = mesh_stiffness(flanks.solve([3 * LOAD]), flanks.points)
    narrow = gear(0.0, width=4.5e-3)
    two = solid(narrow)
    other = FlankPair(GearPair(narrow, narrow), {"driver": two, "driven": two}, positions=1, panel=0.5)
    beside = mesh_stiffness(other.solve([0.5 * LOAD]), other.points)
    assert np.abs(ms.parameters[1]).max() < 1e-6
    assert np.all(ms.parameters[2] > 1.0 / 3.0)
    assert np.all(ms.parameters[2] < 0.6 * beside.parameters[2])
    assert np.all(ms.parameters[2] < 0.5)


def test_parameters_are_those_of_the_paper(known):
    """Eq. 6 with the parameters is the matrix where both gears tilt about the pitch axis."""

    flanks, matrix = known
    ms = mesh_stiffness(flanks.solve([LOAD], MISALIGNED, matrix), flanks.points)
    pair = flanks.pair
    r, b, slope = pair.driver.base_radius, ms.half_width, pair.driver.twist * pair.driver.base_radius
    stiffness, kappa, mu = mesh_parameters_of(pair, ms.mean_moments)[:, 0]
    paper = MeshParameters(stiffness, kappa, mu, math.atan(slope)).matrix()
    # driver of the full matrix in q = (y, z, -b theta_x, -r theta_y, -r theta_z), tilting about the pitch axis
    full = ms.mean(ms.matrix[:, 0])[1:6, 1:6]
    own = np.diag([1.0, 1.0, -1.0 / b, -1.0 / r, -1.0 / r])
    lift = np.eye(5)
    lift[1, 2] = r * math.tan(pair.working_pressure_angle) / b  # the axis stays where the pitch point is
    full = lift.T @ own @ full @ own @ lift
    np.testing.assert_allclose(full, paper, rtol=1e-9, atol=1e-9 * stiffness)


def test_a_mesh_of_a_stiffness_only_is_even_over_its_face():
    mesh = MeshParameters(3e8)
    assert (mesh.kappa, mesh.mu, mesh.base_helix_angle) == (0.0, pytest.approx(1.0 / 3.0, abs=1e-15), 0.0)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_moments_of_a_distribution_are_those_of_its_trapezoids_however_small_the_load(scale):
    """Load and deflection scaled alike; where nothing is carried nothing gives way."""
    z, give = np.array([-1.0, 0.0, 0.5, 1.0]), np.array([2.0, 4.0, 5.0, 0.0])
    load = np.array([6.0, 4.0, 10.0, 0.0])  # 3, 1, 2, 0 per length
    found = mesh_parameters(z, scale * load, scale * give, face_width=2.0)
    fine = np.linspace(-1.0, 1.0, 400_001)
    k = np.interp(fine, z, [3.0, 1.0, 2.0, 0.0])
    total, first, second = (np.trapezoid(k * fine**n, fine) for n in range(3))
    assert total == pytest.approx(3.25)
    assert found.stiffness == pytest.approx(total)
    assert (found.kappa, found.mu) == (pytest.approx(first / total), pytest.approx(second / total))
