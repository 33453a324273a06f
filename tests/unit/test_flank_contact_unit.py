"""Loaded flanks of gears with a width: limits, laws and brute force."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache, cache_on_disk
from fegear.contact.between_positions import worth_a_look
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress
from fegear.contact.wide import compliance, load_sharing
from fegear.contact.wide.averages import GAUSS, averages
from fegear.contact.wide.compliance import FlankCompliance, flank_compliance
from fegear.contact.wide.error import flank_error
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import ContactLines, contact_lines
from fegear.contact.wide.load_sharing import hat_averages, solve_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.over_pitch import over_pitch
from fegear.contact.wide.rigid_flanks import unloaded_error
from fegear.contact.wide.root_stress import rooted_lines
from fegear.fem.plane.root_stress import extreme
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.bands import hats
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.flank_modification import LeadCrowning
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import tip_relief
from fegear.geometry.shaft_tilt import ShaftTilt

STEEL = Material(206.8e9, 0.3, 7850.0)
COARSE = SolidSettings().scaled(1.7)
MODULE, WIDTH, LOAD = 3e-3, 9e-3, 2000.0


def gear(beta=15.0, hand="right", teeth=20):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand if beta else "spur")


def solid(one, settings=COARSE, reach=3, plane_strain=False):
    m = one.module
    return solve_solid(
        one.tooth, one.twist * m, one.face_width / m, 0.3, one.bore_radius / m, settings, reach=reach,
        plane_strain=plane_strain,
    )  # fmt: skip


@pytest.fixture(scope="module")
def solved():
    """A right-handed gear and its left-handed mate."""
    gears = {hand: gear(hand=hand) for hand in ("right", "left")}
    return gears, {hand: solid(one) for hand, one in gears.items()}


def flank_pair(solved, driver="right", **how):
    gears, solids = solved
    driven = "left" if driver == "right" else "right"
    pair = GearPair(gears[driver], gears[driven])
    return FlankPair(pair, {"driver": solids[driver], "driven": solids[driven]}, **{"positions": 4, **how})


@pytest.fixture(scope="module")
def known(solved):
    flanks = flank_pair(solved)
    return flanks, flanks.compliance(LOAD)


MISALIGNED = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([0.0, 12e-6]))


@pytest.mark.dear
def test_a_spur_pair_that_cannot_move_along_the_axis_is_the_plane_pair():
    one = gear(0.0)
    plane = finite_element_compliance(solve_gear(one, reach=1))
    solution = solid(one, SolidSettings(), reach=1, plane_strain=True)
    pair = GearPair(one, one)
    flanks = FlankPair(pair, {"driver": solution, "driven": solution}, panel=1.0, positions=4)
    loads = np.array([200.0, 2000.0])
    found = flanks.solve(loads)
    engagement = Engagement(PairCompliance(pair, plane, plane))
    wanted = engagement.solve(engagement.grid(flanks.roll), loads)
    np.testing.assert_allclose(found.transmission_error, wanted.transmission_error, rtol=1e-3)
    share = dict(zip(found.pair_numbers.tolist(), found.share, strict=True))
    for j, s in zip(wanted.grid.contacts.number.tolist(), wanted.shared.shares, strict=True):
        np.testing.assert_allclose(share[j], s, atol=1e-3)
    # the same load all along the face, and Hertz's pressure of the plane
    line_load = found.line_load[:, :, 1]
    for p in range(4):
        for s in found.lines.at(p):
            np.testing.assert_allclose(line_load[p, s], line_load[p, s].mean(), rtol=2e-3)
    radius = wanted.grid.contacts.relative_radius
    pressure = engagement.compliance.pressure(wanted.loads[:, :, 1], radius).max()
    assert found.pressure[:, :, 1].max() == pytest.approx(pressure, rel=3e-3)
    np.testing.assert_allclose(found.face_load_factor, 1.0, atol=3e-3)
    # root stress of the whole way through the mesh, neighbours' loads included, is that of the plane everywhere
    for member in MEMBERS:
        wanted_stress = tooth_stress(engagement, loaded_states(engagement, (), [2000.0], flanks.roll), member)
        rooted = rooted_lines(pair, member, found.lines, solution, coupling=True)
        for side, sign, plane_stress in (
            ("tension", 1.0, wanted_stress.tension), ("compression", -1.0, wanted_stress.compression)
        ):  # fmt: skip
            stress = rooted.stress(side, found.contact.force[:, :, 1], np.array([-0.5, 0.0, 0.3]) * WIDTH)
            np.testing.assert_allclose(stress.value, stress.value[:, :1] * np.ones(3), rtol=1e-3)
            most = rooted.largest(side, found.contact.force[:, :, 1], np.array([-0.5, 0.0, 0.3]) * WIDTH)
            assert most == pytest.approx((sign * stress.value).max(), rel=1e-12)
            by_plane = np.interp(rooted.x, wanted_stress.x, plane_stress[:, 0])
            np.testing.assert_allclose(stress.largest(sign)[0], by_plane, atol=1e-2 * np.abs(by_plane).max())


@pytest.mark.long
def test_a_helix_that_goes_to_zero_is_a_spur_pair():
    spur = gear(0.0)
    straight = solid(spur)
    pair = GearPair(spur, spur)
    wanted = FlankPair(pair, {"driver": straight, "driven": straight}, positions=2).solve([LOAD])
    beta = 1e-5
    hands = [gear(beta, hand) for hand in ("right", "left")]
    solids = [solid(one) for one in hands]
    found = FlankPair(
        GearPair(*hands), dict(zip(("driver", "driven"), solids, strict=True)), positions=2
    ).solve([LOAD])  # fmt: skip
    np.testing.assert_allclose(found.transmission_error, wanted.transmission_error, rtol=1e-5)
    np.testing.assert_allclose(found.contact.force, wanted.contact.force, rtol=1e-4)


def test_forces_nearby_lead_to_the_same_in_fewer_steps(known):
    """Whatever they are: of another gap, or all on one station."""
    flanks, matrix = known
    gap, load = MISALIGNED.at(flanks.pair, matrix.lines), np.array([LOAD, 0.3 * LOAD])
    cold = solve_contact(matrix, gap, load)
    other = solve_contact(matrix, 0.97 * gap, load)
    warm = solve_contact(matrix, gap, load, near=other.force)
    first = np.zeros_like(cold.force)
    first[:, 0] = load
    for found in (warm, solve_contact(matrix, gap, load, near=first)):
        np.testing.assert_allclose(found.approach, cold.approach, rtol=1e-11)
        np.testing.assert_allclose(found.force, cold.force, atol=1e-8 * LOAD)
        assert found.residual.max() < 1e-9
    assert warm.steps < cold.steps


def test_mirrored_hands_mirror_the_load(solved, known):
    flanks, matrix = known
    mirrored = FlankGaps(face_position=MISALIGNED.face_position, line_gap=MISALIGNED.line_gap[::-1].copy())
    first = flanks.solve([LOAD], MISALIGNED, matrix)
    second = flank_pair(solved, "left").solve([LOAD], mirrored)
    np.testing.assert_allclose(second.transmission_error, first.transmission_error, rtol=1e-7)
    np.testing.assert_allclose(second.mean_over_face, first.mean_over_face[::-1], rtol=1e-5)


def test_exchanged_gears_answer_alike(solved, known):
    flanks, matrix = known
    found = flanks.solve([LOAD], MISALIGNED, matrix)
    solids = solved[1]
    other, exchanged = flanks.pair.reversed(), {"driver": solids["left"], "driven": solids["right"]}
    # the same roll positions, seen from the other side: x changes its sign
    lines = contact_lines(other, -flanks.roll, flanks.panel * MODULE)
    again = solve_contact(
        flank_compliance(other, exchanged, lines, LOAD), MISALIGNED.at(other, lines), np.array([LOAD])
    )  # fmt: skip
    np.testing.assert_allclose(again.approach, found.transmission_error, rtol=1e-9)
    np.testing.assert_allclose(np.sort(again.force, axis=1), np.sort(found.contact.force, axis=1), atol=1e-8 * LOAD)


def test_what_lines_do_to_each_other_depends_on_how_many_teeth_lie_between_them(known):
    """Not on what the pairs are numbered."""
    flanks, _ = known
    lines = contact_lines(flanks.pair, flanks.roll, flanks.panel * MODULE)
    beside = compliance._beside(flanks.pair, flanks.gears, lines)
    assert np.abs(beside).max() > 0.0
    further = replace(lines, pair=np.where(lines.present, lines.pair + 7, lines.pair))
    np.testing.assert_allclose(compliance._beside(flanks.pair, flanks.gears, further), beside, rtol=1e-12)


def test_compliances_are_symmetric_and_forces_sum_to_the_load(known):
    flanks, matrix = known
    c = matrix.matrix
    np.testing.assert_allclose(c, c.transpose(0, 2, 1), rtol=1e-12, atol=1e-12 * np.abs(c[:, :4, :4]).max())
    loads = np.array([1e-3, 1.0, 2000.0, 20000.0])
    found = flanks.solve(loads, MISALIGNED, matrix)
    assert found.equilibrium.max() < 1e-12
    assert found.contact.residual.max() < 1e-9
    np.testing.assert_allclose(found.share.sum(axis=0), 1.0, rtol=1e-12)
    cell = np.diff(found.cells)[:, None]
    np.testing.assert_allclose((found.over_face * cell).sum(axis=1), np.broadcast_to(loads, (4, 4)), rtol=1e-10)
    assert found.contact.force.min() >= 0.0
    # light loads stand where the gap is smallest, heavy ones all over the face
    on = (found.contact.force > 0.0).sum(axis=(0, 1))
    assert np.all(np.diff(on) >= 0)
    assert on[0] < on[-1] == flanks.compliance(LOAD).lines.present.sum()
    assert np.all(np.diff(found.face_load_factor[1:]) < 0.0)


def test_a_rigid_shift_changes_nothing_but_the_approach(known):
    flanks, matrix = known
    found = flanks.solve([LOAD], MISALIGNED, matrix)
    moved = FlankGaps(face_position=MISALIGNED.face_position, line_gap=MISALIGNED.line_gap + 1e-3)
    again = flanks.solve([LOAD], moved, matrix)
    np.testing.assert_allclose(again.transmission_error - 1e-3, found.transmission_error, rtol=1e-9)
    np.testing.assert_allclose(again.contact.force, found.contact.force, atol=1e-9 * LOAD)


def test_stiffness_is_the_slope_of_the_load(known):
    flanks, matrix = known
    found = flanks.solve([LOAD, 1.001 * LOAD], MISALIGNED, matrix)
    slope = 1e-3 * LOAD / np.diff(found.transmission_error, axis=1)[:, 0]
    np.testing.assert_allclose(slope, found.contact.stiffness.mean(axis=1), rtol=1e-5)


def test_relief_over_the_roll_angle_takes_load_from_the_tips(known):
    flanks, matrix = known
    relief = tip_relief(flanks.pair.driver, 30e-6, length=1.2e-3)
    plain = flanks.solve([LOAD], None, matrix)
    relieved = flanks.solve([LOAD], FlankGaps(relief, relief), matrix)
    tip = matrix.lines.at_edge & matrix.lines.present
    assert plain.line_load[tip].max() > 0.0
    assert relieved.line_load[tip].max() < 0.3 * plain.line_load[tip].max()


def test_without_coupling_pairs_are_stiffer_and_the_error_is_told(solved, known):
    flanks, matrix = known
    found = flanks.solve([LOAD], MISALIGNED, matrix)
    alone = flank_pair(solved, coupling=False).solve([LOAD], MISALIGNED)
    several = (found.share > 0.0).sum(axis=0) > 1
    assert several.any()
    assert (alone.transmission_error < 0.95 * found.transmission_error)[several].all()
    np.testing.assert_allclose(alone.transmission_error[~several], found.transmission_error[~several], rtol=1e-9)
    same = flank_error(flanks, found, flanks.gears, MISALIGNED, over_pitch(flanks, found, MISALIGNED, LOAD), LOAD)
    # the same gears: what is left is that of the panels
    assert 0.0 < same.mean[0] < 5e-3 * found.transmission_error.mean()
    assert 0.0 < same.face_load_factor[0] < 0.02 * found.face_load_factor[0]


def test_contact_lines_fill_the_plane_of_action(known):
    flanks, _ = known
    pair = flanks.pair
    roll = pair.x_start + pair.base_pitch * (np.arange(400) + 0.5) / 400
    lines = contact_lines(pair, roll, 1e-3)
    # mean length of all lines over a base pitch: the area of the plane of action over the pitch, less the short ones
    area = pair.path_length * pair.face_width / pair.base_pitch
    assert area * (1.0 - 1e-3) < lines.length.mean() < area * (1.0 + 1e-9)
    at, slope = lines.present, pair.driver.twist * pair.driver.base_radius
    start = np.broadcast_to(lines.roll[:, None], at.shape) + lines.pair * pair.base_pitch
    np.testing.assert_allclose(lines.x[at], (start - slope * lines.z)[at], atol=1e-15)
    assert lines.x[at].min() >= pair.x_start
    assert lines.x[at].max() <= pair.x_end
    np.testing.assert_allclose(lines.support.sum(axis=1), lines.length, rtol=1e-12)
    np.testing.assert_allclose(hat_averages(lines, np.where(at, 3.0, 0.0))[at], 3.0, rtol=1e-12)


def made_up(rng, stations, hertz, cut=0):
    """Two lines with random positive definite compliances."""
    z = np.sort(rng.uniform(-1e-2, 1e-2, stations))
    pair = (np.arange(stations) >= (cut or stations)).astype(int)
    lines = ContactLines(
        np.zeros(1), pair[None], np.ones((1, stations), bool), np.zeros((1, stations)), z[None], -1e-2, 1e-2,
        np.zeros((1, stations), bool),
    )  # fmt: skip
    root = rng.normal(size=(stations, stations)) * 1e-5
    matrix = root @ root.T + 1e-10 * np.eye(stations)
    slope = 1e-12 if hertz else 0.0
    fixed = None if hertz else np.ones((1, stations))
    return FlankCompliance(lines, matrix[None], slope, np.full((1, stations), 1e-14), fixed)


@pytest.mark.parametrize("seed", range(12))
def test_active_sets_against_all_subsets(seed):
    rng = np.random.default_rng(seed)
    known = made_up(rng, 7, hertz=False, cut=3)
    gap = rng.uniform(0.0, 3e-8, (1, 7))
    load = np.array([1.0, 30.0, 1000.0])
    found = solve_contact(known, gap, load)
    c, e = known.matrix[0], hat_averages(known.lines, gap)[0]
    for i, total in enumerate(load):
        best = None
        for bits in product((False, True), repeat=7):
            on = np.flatnonzero(bits)
            if on.size == 0:
                continue
            system = np.block([[c[np.ix_(on, on)], -np.ones((on.size, 1))], [np.ones((1, on.size)), np.zeros((1, 1))]])
            solution = np.linalg.solve(system, np.append(-e[on], total))
            force = np.zeros(7)
            force[on] = solution[:-1]
            if force.min() >= 0.0 and (c @ force + e - solution[-1] >= -1e-9 * abs(solution[-1])).all():
                best = force, solution[-1]
        assert best is not None
        np.testing.assert_allclose(found.force[0, :, i], best[0], atol=1e-8 * total)
        assert found.approach[0, i] == pytest.approx(best[1], rel=1e-8, abs=0.0)


@pytest.mark.parametrize("seed", range(4))
def test_contacts_that_widen_meet_their_conditions(seed):
    """The conditions, by plain quadrature on a fine grid."""
    rng = np.random.default_rng(100 + seed)
    known = made_up(rng, 9, hertz=True, cut=4)
    gap = rng.uniform(0.0, 1e-7, (1, 9))
    found = solve_contact(known, gap, np.array([500.0]))
    z, force = known.lines.z[0], found.force[0, :, 0]
    u = known.matrix[0] @ force
    for a, b in ((0, 4), (4, 9)):
        x = np.linspace(z[a], z[b - 1], 400_001)
        x = 0.5 * (x[1:] + x[:-1])
        hats = np.array([np.interp(x, z[a:b], np.eye(b - a)[i]) for i in range(b - a)])
        hats /= hats.mean(axis=1, keepdims=True) * (z[b - 1] - z[a])
        f = force[a:b] @ hats
        log = np.log(np.sqrt(1e-14 * np.where(f > 0.0, f, 1.0)))
        u[a:b] += (hats * (-2e-12 * f * log)).mean(axis=1) * (z[b - 1] - z[a])
        u[a:b] += (hats * np.interp(x, z[a:b], gap[0, a:b])).mean(axis=1) * (z[b - 1] - z[a])
    rest = u - found.approach[0, 0]
    scale = found.approach[0, 0]
    assert np.abs(rest[force > 0.0]).max() < 2e-4 * scale
    assert (rest[force == 0.0] > -2e-4 * scale).all()
    assert force.sum() == pytest.approx(500.0, rel=1e-12)


@pytest.mark.parametrize("window", [1e-6, 3e-4, 2e-3, 1.0])
def test_averages_along_a_line_are_mirrored_at_its_ends(window):
    known = made_up(np.random.default_rng(5), 9, hertz=True, cut=4)
    lines = known.lines
    found = averages(lines, np.full((1, 9), window))
    z = lines.z[0]
    for a, b in ((0, 4), (4, 9)):
        length = z[b - 1] - z[a]
        x = np.linspace(z[a], z[b - 1], 100_001)
        x = 0.5 * (x[1:] + x[:-1])
        count = round(min(window, length) / (x[1] - x[0]))
        for i in range(a, b):
            hat = np.interp(x, z[a:b], np.eye(b - a)[i - a])
            wide = np.cumsum(np.pad(np.pad(hat, (count, count), mode="symmetric"), (1, 0)))
            smooth = (wide[2 * count + 1 :] - wide[: -2 * count - 1]) / (2 * count + 1)
            for point, rows in zip(GAUSS[0], found.rows, strict=True):
                for panel in range(a, b - 1):
                    k = i - panel + found.reach
                    got = rows[0, panel, k] if 0 <= k < rows.shape[2] else 0.0
                    at = (1.0 - point) * z[panel] + point * z[panel + 1]
                    assert got == pytest.approx(np.interp(at, x, smooth), abs=2e-4)
    # of a line load, the sum stays what it is
    gathered = np.zeros(9 + 2 * found.reach)
    for weight, rows in zip(GAUSS[1], found.rows, strict=True):
        for k in range(rows.shape[2]):
            gathered[k : k + 8] += weight * lines.panel[0] * rows[0, :, k]
    wanted = lines.support[0]
    inside = gathered[found.reach : found.reach + 9]
    assert inside.sum() == pytest.approx(wanted.sum(), rel=1e-12)


def test_panels_as_short_as_the_contact_is_wide_and_high_loads_are_solved(solved, known):
    """With the width that follows the load of a single place they have no positive stiffness."""
    flanks, _ = known
    short = replace(flanks, panel=0.06, positions=1)
    found = short.solve([0.1 * LOAD, LOAD, 20.0 * LOAD], MISALIGNED)
    assert found.known.half_width(found.line_load[:, :, 2:]).max() > 2.0 * found.lines.panel.max()
    assert found.contact.residual.max() < 1e-9
    coarse = replace(flanks, positions=1).solve([0.1 * LOAD, LOAD, 20.0 * LOAD], MISALIGNED)
    np.testing.assert_allclose(coarse.transmission_error, found.transmission_error, rtol=4e-3)


@pytest.mark.parametrize("gap", ["aligned", "misaligned", "relieved"])
def test_shorter_panels_change_little(known, gap):
    """Panels of a quarter of a module, as cases have them, against half and a quarter of that."""
    flanks, _ = known
    relief = tip_relief(flanks.pair.driver, 20e-6, length=1.2e-3)
    apart = {"aligned": None, "misaligned": MISALIGNED, "relieved": FlankGaps(relief, relief)}[gap]
    found = [replace(flanks, panel=panel).solve([2.0 * LOAD], apart) for panel in (0.25, 0.125, 0.0625)]
    error, factor = (np.array([getattr(one, key) for one in found])
                     for key in ("mean_transmission_error", "face_load_factor"))  # fmt: skip
    np.testing.assert_allclose(error / error[-1], 1.0, atol=3e-3)
    np.testing.assert_allclose(factor / factor[-1], 1.0, atol=5e-3)


def test_loads_must_be_positive(known):
    flanks, matrix = known
    for load in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="positive"):
            flanks.solve([load], None, matrix)


def test_root_stress_is_the_sum_of_single_stations_over_own_and_neighbouring_teeth(solved, known):
    flanks, matrix = known
    found = flanks.solve([LOAD], MISALIGNED, matrix)
    force, z = found.contact.force[:, :, 0], np.linspace(-0.5, 0.5, 5) * WIDTH
    for member in MEMBERS:
        solution, forward = flanks.gears[member], (1 if member == "driver" else -1)
        rooted = rooted_lines(flanks.pair, member, found.lines, solution, coupling=True)
        p, j = rooted.teeth[len(rooted.teeth) // 2].tolist()
        # by brute force, station after station, through the solid's own function
        whole = 0.0
        for s in found.lines.at(p):
            radius = flanks.pair.radius(found.lines.x[p, s], member) / MODULE
            line = hats(radius, found.lines.z[p, s] / MODULE, solution.band_half_width(radius),
                        slope=solution.line_slope(radius))  # fmt: skip
            k = forward * (j - int(found.lines.pair[p, s.start]))
            whole = whole + solution.fillet_stress(k, "compression", line, z / MODULE)[0] @ force[p, s]
        stress = rooted.stress("compression", force, z)
        row = len(rooted.teeth) // 2
        # Both are the largest of a curve through the Gauss points, which lies up to 1.3 % beyond the largest of these.
        fillet = solution.fillets["compression"]
        largest = extreme(whole, fillet.arc, -1.0, fillet.length)[0]
        # pressed bands come in few widths, which the fillet hardly feels
        np.testing.assert_allclose(stress.value[row], largest / MODULE**2, rtol=1e-2)
        twice = rooted.stress("compression", 2.0 * force, z)
        np.testing.assert_allclose(twice.value, 2.0 * stress.value, rtol=1e-9)
        # without coupling only the teeth that touch are stressed
        alone = rooted_lines(flanks.pair, member, found.lines, solution, coupling=False)
        assert len(alone.teeth) < len(rooted.teeth)
        assert set(alone.sources) == {0}
        for p, count in zip(*np.unique(alone.teeth[:, 0], return_counts=True), strict=True):
            touch = [int(found.lines.pair[p, s.start]) for s in found.lines.at(p)]
            of_p = alone.teeth[alone.teeth[:, 0] == p, 1]
            assert count <= max(touch) - min(touch) + 1
            assert min(touch) <= of_p.min() <= of_p.max() <= max(touch)


def test_a_line_without_load_hides_nothing_of_the_fillet_below_it(known):
    """Flanks so far apart at one tooth pair that it carries nothing: its teeth are stressed by their neighbours."""
    flanks, matrix = known
    found, z = flanks.solve([LOAD], None, matrix), np.linspace(-0.5, 0.5, 5) * WIDTH
    for member in MEMBERS:
        rooted = rooted_lines(flanks.pair, member, found.lines, flanks.gears[member], coupling=True)
        force, fillet = found.contact.force[:, :, 0], rooted.solution.fillets["tension"]
        hidden = (rooted.ends("tension").at(z / MODULE, force) < fillet.length).any(axis=0)
        others = [(force[p] * (found.lines.pair[p] != j)).sum() for p, j in rooted.teeth.tolist()]
        tooth = int(np.argmax(np.where(hidden, others, -1.0)))  # another pair bears most
        assert hidden[tooth]
        assert others[tooth] > 0.0
        p, j = rooted.teeth[tooth].tolist()
        apart = force.copy()
        apart[p, found.lines.pair[p] == j] = 0.0
        total = rooted.surface("tension", apart, z)[0][:, :, tooth]
        stress = rooted.stress("tension", apart, z).value[tooth]
        assert stress == pytest.approx(extreme(total, fillet.arc, 1.0, fillet.length)[0] / MODULE**2, rel=1e-12)
        assert np.isfinite(rooted.along_fillets("tension", apart, z)[:, :, tooth]).all()
        assert not np.isfinite(rooted.along_fillets("tension", force, z)[:, :, tooth]).all()
        few = rooted.influence("tension", z[[0, 2]])
        for forces in (force, apart):
            assert few.largest(forces) == pytest.approx(rooted.largest("tension", forces, z[[0, 2]]), rel=1e-9)


def test_mirrored_hands_mirror_the_root_stress(solved, known):
    flanks, matrix = known
    other = flank_pair(solved, "left")
    mirrored = FlankGaps(face_position=MISALIGNED.face_position, line_gap=MISALIGNED.line_gap[::-1].copy())
    z = np.linspace(-0.5, 0.5, 7) * WIDTH
    one = rooted_lines(flanks.pair, "driver", matrix.lines, flanks.gears["driver"], coupling=True)
    found = flanks.solve([LOAD], MISALIGNED, matrix)
    stress = one.stress("tension", found.contact.force[:, :, 0], z)
    again = other.solve([LOAD], mirrored)
    two = rooted_lines(other.pair, "driver", again.lines, other.gears["driver"], coupling=True)
    wanted = two.stress("tension", again.contact.force[:, :, 0], z)
    np.testing.assert_allclose(stress.value, wanted.value[:, ::-1], rtol=1e-4, atol=1e-4 * stress.value.max())


def test_what_load_and_gaps_do_not_change_is_recalled_bit_for_bit(solved, known, tmp_path):
    flanks, matrix = known
    on_disk = [cache_on_disk(tmp_path) for _ in range(2)]
    first, again = (replace(flanks, cache=cache).compliance(LOAD) for cache in on_disk)
    np.testing.assert_array_equal(first.matrix, matrix.matrix)
    np.testing.assert_array_equal(again.matrix, matrix.matrix)
    assert [(cache.shapes.computed, cache.shapes.from_disk) for cache in on_disk] == [(3, 0), (0, 3)]
    # another load: what follows it is all that is computed
    third = replace(flanks, cache=on_disk[1]).compliance(3.0 * LOAD)
    assert on_disk[1].shapes.computed == 1
    np.testing.assert_allclose(third.matrix, flank_pair(solved).compliance(3.0 * LOAD).matrix, rtol=1e-14)
    assert np.abs(third.matrix - matrix.matrix).max() > 0.0
    # other gears, other lines: nothing is taken for what it is not
    for other in (flank_pair(solved, "left"), replace(flanks, panel=0.7), replace(flanks, positions=5)):
        cache = cache_on_disk(tmp_path)
        replace(other, cache=cache).compliance(LOAD)
        assert (cache.shapes.computed, cache.shapes.from_disk) == (3, 0)
    damaged = next(path for path in tmp_path.rglob("*.entry"))
    damaged.write_bytes(damaged.read_bytes()[:-8])
    mended = replace(flanks, cache=cache_on_disk(tmp_path)).compliance(LOAD)
    np.testing.assert_array_equal(mended.matrix, matrix.matrix)


def test_many_roll_positions_are_taken_in_parts(known, monkeypatch):
    flanks, matrix = known
    monkeypatch.setattr(compliance, "_STATIONS_AT_ONCE", 30)
    again = replace(flanks, cache=SolutionCache()).compliance(LOAD)
    np.testing.assert_allclose(again.matrix, matrix.matrix, rtol=1e-12, atol=1e-12 * np.abs(matrix.matrix[0, 0, 0]))


@pytest.mark.dear
def test_faces_that_overlap_in_part_bear_where_both_are(solved):
    """A wider mate, and mates beside each other: what is common bears, mirrored offsets mirror, nothing else jumps."""
    spur = gear(0.0)
    wide = replace(spur, face_width=4.0 / 3.0 * WIDTH)
    bodies = {"narrow": solid(spur), "wide": solid(wide)}
    at = {"positions": 2, "panel": 0.5}
    gears = {"driver": bodies["narrow"], "driven": bodies["wide"]}
    up, down = (
        FlankPair(GearPair(spur, wide, axial_offset=offset), gears, **at).solve([LOAD]) for offset in (4e-3, -4e-3)
    )
    low, high = up.lines.low, up.lines.high
    assert high - low == pytest.approx(0.5 * (WIDTH + wide.face_width) - 4e-3)
    np.testing.assert_allclose(up.transmission_error, down.transmission_error, rtol=1e-9)
    np.testing.assert_allclose(up.over_face, down.over_face[:, ::-1], rtol=1e-7)
    assert up.equilibrium.max() < 1e-12
    # both reach beyond one end of the common face, and what goes on there holds the flanks apart: that end bears more
    middle = FlankPair(GearPair(spur, wide), gears, **at).solve([LOAD])
    alone = FlankPair(GearPair(spur, spur), {"driver": gears["driver"], "driven": gears["driver"]}, **at).solve([LOAD])
    ends = [found.mean_over_face[[0, -1], 0].mean() / found.mean_over_face[:, 0].mean() for found in (middle, alone)]
    assert ends[0] > 1.02 * ends[1]
    assert (middle.transmission_error < alone.transmission_error).all()
    assert (middle.transmission_error < up.transmission_error).all()
    assert GearPair(spur, wide, axial_offset=4e-3).reversed().axial_offset == -4e-3


@pytest.mark.long
def test_a_face_that_is_wider_by_a_hair_changes_nothing_by_more_than_a_hair():
    """The law of the end of a face is that of the gear whose face ends."""
    spur = gear(0.0)
    hair = replace(spur, face_width=(1.0 + 1e-6) * WIDTH)
    one, other = solid(spur), solid(hair)
    alone = FlankPair(GearPair(spur, spur), {"driver": one, "driven": one}, positions=2).solve([LOAD])
    close = FlankPair(GearPair(spur, hair), {"driver": one, "driven": other}, positions=2).solve([LOAD])
    np.testing.assert_allclose(close.transmission_error, alone.transmission_error, rtol=1e-4)
    np.testing.assert_allclose(close.over_face, alone.over_face, rtol=1e-3)


def test_spacing_errors_move_load_to_the_other_pairs(known):
    flanks, matrix = known
    late = np.zeros(20)
    late[3] = 6e-6
    loads = [0.2 * LOAD, LOAD]
    plain = flanks.solve(loads, None, matrix)
    found = flanks.solve(loads, FlankGaps(driver_spacing=late, base_pitch=3), matrix)
    other = flanks.solve(loads, FlankGaps(driven_spacing=late, base_pitch=3), matrix)
    even = flanks.solve(loads, FlankGaps(driver_spacing=late, base_pitch=10), matrix)
    numbers = found.pair_numbers.tolist()
    assert (found.share[numbers.index(0)] <= plain.share[numbers.index(0)] + 1e-12).all()
    assert (found.share[numbers.index(0)] < 0.9 * plain.share[numbers.index(0)]).any()
    np.testing.assert_array_equal(found.share, other.share)
    np.testing.assert_array_equal(even.share, plain.share)  # the late tooth is far away
    # all teeth late by as much: a shift
    shifted = flanks.solve(loads, FlankGaps(driver_spacing=np.full(20, 6e-6)), matrix)
    np.testing.assert_allclose(shifted.transmission_error - 6e-6, plain.transmission_error, rtol=1e-9)


def test_light_loads_stand_where_rigid_flanks_touch(known):
    """A crowned pair's approach under a vanishing load is the least gap; shorter panels come nearer to it."""
    flanks, _ = known
    gaps = FlankGaps(driver_flank=(LeadCrowning(20e-6, WIDTH),), tilt=ShaftTilt(2e-4, 3e-4))
    rigid = unloaded_error(flanks.pair, gaps, flanks.roll)
    off = []
    for panel in (0.5, 0.25):
        found = replace(flanks, panel=panel, positions=4).solve([1e-3], gaps)
        off.append(found.transmission_error[:, 0] - rigid)
    # The gap of a hat is the mean of what it spans: C h^2/b^2 above the least one, a quarter of it for half the panel.
    assert (np.abs(off[0]) < 4.0 * 20e-6 * (0.5 * MODULE / (0.5 * WIDTH)) ** 2).all()
    assert np.abs(off[1]).max() < 0.5 * np.abs(off[0]).max()


@pytest.mark.long
def test_a_wide_spur_pair_free_to_move_tends_to_the_plane_in_the_middle_of_its_face():
    """Its ends give way, which reaches in by about one over the width: root stress and deflection."""
    missed = []
    for width in (4.0, 8.0):
        tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
        one = Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, width * MODULE, STEEL, "strain", "spur")
        load = 222e3 * width * MODULE
        plane = finite_element_compliance(solve_gear(one, reach=1))
        solution, pair = solid(one, SolidSettings(), reach=1), GearPair(one, one)
        flanks = FlankPair(pair, {"driver": solution, "driven": solution}, positions=12)
        found = flanks.solve([load])
        engagement = Engagement(PairCompliance(pair, plane, plane))
        wanted = tooth_stress(engagement, loaded_states(engagement, (), [load], flanks.roll), "driver")
        te = engagement.solve(engagement.grid(flanks.roll), [load]).transmission_error[:, 0]
        rooted = rooted_lines(pair, "driver", found.lines, solution, coupling=True)
        middle = rooted.stress("tension", found.contact.force[:, :, 0], np.zeros(1)).value[:, 0]
        missed.append((middle.max() / wanted.tension.max() - 1.0, np.mean(found.transmission_error[:, 0] / te - 1.0)))
    stress, deflection = np.array(missed).T
    assert 0.0 < stress[1] < 0.05
    assert 0.0 < deflection[1] < 0.035
    assert 0.35 < stress[1] / stress[0] < 0.65
    assert 0.4 < deflection[1] / deflection[0] < 0.8


def test_what_gaps_do_not_change_is_recalled(solved):
    flanks = flank_pair(solved, positions=4)
    known = flanks.compliance(1000.0)
    assert flanks.compliance(1000.0) is known
    others = (
        flanks.compliance(1100.0), replace(flanks, positions=5).compliance(1000.0),
        replace(flanks, coupling=False).compliance(1000.0), replace(flanks, hertz="none").compliance(1000.0),
        replace(flanks, panel=0.4).compliance(1000.0), replace(flanks, most_gap=1e-5).compliance(1000.0),
    )  # fmt: skip
    assert len({id(one) for one in (known, *others)}) == 7
    alone = replace(flanks, cache=SolutionCache()).compliance(1000.0)
    assert alone is not known
    assert np.array_equal(alone.matrix, known.matrix)


def test_problems_in_parts_are_the_same_to_the_last_bit_and_tell_how_far_they_are(known, monkeypatch):
    flanks, compliances = known
    told, loads = [], LOAD * np.array([0.2, 1.0, 3.0])
    whole = flanks.solve(loads, MISALIGNED, compliances)
    monkeypatch.setattr(load_sharing, "_ENTRIES", 5 * compliances.lines.x.shape[1] ** 2)
    parts = replace(flanks, progress=told.append).solve(loads, MISALIGNED, compliances)
    for name in ("force", "approach", "stiffness", "residual"):
        np.testing.assert_array_equal(getattr(parts.contact, name), getattr(whole.contact, name))
    assert parts.contact.steps == whole.contact.steps
    assert told == [5 / 12, 10 / 12, 1.0]  # four positions under three loads, five at a time


def test_peaks_of_many_loads_are_looked_for_at_a_bounded_number_of_places():
    period, loads = 1e-2, 400
    x = np.linspace(0.0, period, 48, endpoint=False)
    places = np.random.default_rng(0).uniform(0.0, period, (48, loads, 2))
    new = worth_a_look(x, [(places, np.ones((48, loads)))] * 2, period)
    assert 10 <= new.size <= 64
    few = worth_a_look(x, [(places[:, :3], np.ones((48, 3)))] * 2, period)
    assert few.size == 12  # two places of two ends each of three loads
