"""Odd flanks and cracks under the loads of a mesh, by parts: gaps, contacts, sums over teeth; solutions are made up."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.odd_flank import OddFlank, Pit
from fegear.contact.plane.crack_in_mesh import _closed, crack_in_mesh
from fegear.contact.plane.faces_in_mesh import faces_in_mesh
from fegear.contact.plane.meshing import Meshing
from fegear.contact.plane.odd_compliance import OddCompliance
from fegear.contact.plane.odd_contacts import OddContacts
from fegear.contact.plane.root_stress_history import RootStressHistory
from fegear.contact.plane.shifted_compliance import ShiftedCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief

MODULE, Z, WIDTH = 3e-3, {"driver": 17, "driven": 23}, 20e-3


def gear(teeth, hand, width=WIDTH):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(12.0 if hand != "spur" else 0.0))
    return Gear(tooth, MODULE, 0.3 * teeth * MODULE, width, Material(206e9), "strain", hand)


SPUR = GearPair(gear(17, "spur"), gear(23, "spur"))
HELICAL = GearPair(gear(17, "right"), gear(23, "left", 1.4 * WIDTH), axial_offset=3e-3)
LINES = contact_lines(HELICAL, HELICAL.x_start + HELICAL.base_pitch * np.linspace(0.0, 0.9, 5), MODULE)


# ---- gaps over the face ----------------------------------------------------------------------------------------------
def gaps(member, flank, order=3, base_pitch=0):
    return FlankGaps(**{f"{member}_odd": ((order, flank),), "base_pitch": base_pitch}).at(HELICAL, LINES)


def on_tooth(member, order, base_pitch):
    return LINES.present & ((base_pitch - LINES.pair) % Z[member] == order)


@pytest.mark.parametrize("member", MEMBERS)
@pytest.mark.parametrize("base_pitch", [2, 3, 4, 40])
def test_a_pit_all_over_a_flank_is_a_gap_of_its_depth_on_its_own_tooth_only(member, base_pitch):
    low, high = HELICAL.gear(member).involute_radii
    whole = OddFlank(pits=(Pit(0.9 * low, 1.1 * high, 1.0, 4e-6), Pit(0.9 * low, 1.1 * high, 1.0, 1e-6)))
    lean = math.cos(HELICAL.gear(member).base_helix_angle)
    expected = np.where(on_tooth(member, 3, base_pitch), 4e-6 / lean, 0.0)
    assert gaps(member, whole, 3, base_pitch) == pytest.approx(expected, abs=1e-15)
    if base_pitch == 3:
        assert on_tooth(member, 3, 3).any()
        gone = gaps(member, OddFlank(missing=True), 3, base_pitch)
        assert (np.isinf(gone) == (expected > 0.0)).all()
        # next to the odd tooth, one base pitch on, the next pair is on it
        assert (on_tooth(member, 3, 4) == (LINES.present & (LINES.pair == 1))).all()


@pytest.mark.parametrize("member", MEMBERS)
def test_a_profile_of_its_own_replaces_that_of_the_gear_and_a_deviation_adds_to_it(member):
    roll = LINES.roll_angle(HELICAL, member)
    usual, other = (EndRelief(amount, 0.3, 0.6) for amount in (10e-6, 25e-6))
    on = on_tooth(member, 3, 3)

    def found(**flank):
        given = {f"{member}_relief": usual, f"{member}_odd": ((3, OddFlank(**flank)),), "base_pitch": 3}
        return FlankGaps(**given).at(HELICAL, LINES)

    alike = FlankGaps(**{f"{member}_relief": usual}).at(HELICAL, LINES)
    assert found(relief=usual) == pytest.approx(alike, abs=1e-18)
    every = FlankGaps(**{f"{member}_relief": other}).at(HELICAL, LINES)
    assert found(relief=other) == pytest.approx(np.where(on, every, alike), abs=1e-18)
    assert found(deviation=other)[on] == pytest.approx((alike + other.removal(roll))[on], abs=1e-18)
    assert found(deviation=other)[~on] == pytest.approx(alike[~on], abs=1e-18)
    assert np.abs(every - alike)[on].max() > 5e-6


@pytest.mark.parametrize("member", MEMBERS)
@pytest.mark.parametrize("place", [-4e-3, 0.0, 4e-3])
def test_a_pit_over_a_part_of_the_face_leaves_what_is_beside_it(place, member):
    low, high = HELICAL.gear(member).involute_radii
    found = gaps(member, OddFlank(pits=(Pit(low, high, 0.4, 0.0, place),)), 3, 3)
    # the face of the driven gear lies 3 mm farther on
    off = np.abs(LINES.z - (3e-3 if member == "driven" else 0.0) - place) - 0.2 * HELICAL.gear(member).face_width
    on, near = on_tooth(member, 3, 3), 0.5 * MODULE  # half a panel about an end may be of either side
    assert (on & (off < -near)).any()
    assert np.isinf(found[on & (off < -near)]).all()
    assert (on & (off > near)).any()
    assert (found[on & (off > near)] == 0.0).all()
    assert (found[~on] == 0.0).all()
    # a shallow one of a part of the face is a gap that a load may close, a deep one is out of reach
    shallow, deep = (OddFlank(pits=(Pit(low, high, 0.4, depth),)) for depth in (1e-6, 1e-3))
    radius, z = np.full(3, 0.5 * (low + high)), np.array([-0.21, 0.0, 0.21]) * WIDTH
    assert shallow.gap_over_face(radius, z, WIDTH).tolist() == [0.0, 1e-6, 0.0]
    assert deep.gap_over_face(radius, z, WIDTH).tolist() == [0.0, math.inf, 0.0]
    edge = 0.2 * WIDTH * np.array([-1.0, 1.0])
    assert shallow.gap_over_face(radius[:2], edge, WIDTH).tolist() == [1e-6, 1e-6]
    beside = OddFlank(pits=(Pit(low, high, 1.0, 1e-3), Pit(low, high, 1.0, 3e-6)))
    assert beside.gap_over_face(radius, z, WIDTH).tolist() == [1e-3] * 3
    assert beside.gap(np.array([0.9 * low, low, high, 1.1 * high])).tolist() == [0.0, 1e-3, 1e-3, 0.0]


# ---- contacts of plane teeth -----------------------------------------------------------------------------------------
def contacts(corner=False):
    meshing = Meshing(SPUR, corner)
    x = SPUR.x_start + SPUR.base_pitch * np.linspace(0.02, 0.97, 9)
    return meshing.contacts(x)


@pytest.mark.parametrize(("member", "other"), [MEMBERS, MEMBERS[::-1]])
def test_a_missing_or_lower_tooth_takes_its_own_pair_away(member, other):
    usual, number = contacts(), contacts().number
    gone = OddContacts(SPUR, **{member: {5: OddFlank(missing=True)}, other: {}})
    for cycle in (5, 6, 5 + Z[member]):
        found = gone.changed(usual, cycle)
        row = number == cycle % Z[member] - 5
        assert row.any()
        assert not found.present[row].any()
        assert np.isinf(found.gap[row]).all()
        for name in ("present", "radius_driver", "relative_radius", "gap"):
            assert np.array_equal(getattr(found, name)[~row], getattr(usual, name)[~row])
    assert gone.changed(usual, 9) is usual
    tip = SPUR.gear(member).involute_tip_radius
    lower = OddContacts(SPUR, **{member: {5: OddFlank(tip_radius=tip - 0.2 * MODULE)}, other: {}})
    lost = 0
    for cycle in (5, 6):
        found, row = lower.changed(usual, cycle), int(np.flatnonzero(number == cycle - 5)[0])
        expected = usual.present[row] & (getattr(usual, f"radius_{member}")[row] <= tip - 0.2 * MODULE)
        assert (found.present[row] == expected).all()
        lost += int((usual.present[row] & ~expected).sum())
        for name in ("radius_driver", "radius_driven", "roll_driver", "roll_driven", "relative_radius"):
            assert getattr(found, name)[row, expected] == pytest.approx(getattr(usual, name)[row, expected], rel=1e-12)
    assert lost > 0


@pytest.mark.parametrize(("member", "other"), [MEMBERS, MEMBERS[::-1]])
def test_pits_change_gap_and_bearing_share_where_they_touch(member, other):
    usual = contacts()
    low, high = SPUR.gear(member).involute_radii
    middle = 0.5 * (low + high)
    odd = OddFlank(pits=(Pit(0.9 * low, middle, 1.0, 3e-6), Pit(middle, 1.1 * high, 0.3)))
    found = OddContacts(SPUR, **{member: {5: odd}, other: {2: OddFlank(pits=(Pit(0.0, 1.0, 0.5),))}})
    assert found.changed(usual, 5) is usual
    gap, left = found.gap(usual, 5), found.bearing_share(usual, 5)
    row, radius = usual.number == 0, getattr(usual, f"radius_{member}")[usual.number == 0]
    assert gap[row] == pytest.approx(np.where(radius <= middle, 3e-6, 0.0))
    assert (gap[~row] == 0.0).all()
    assert left[row] == pytest.approx(np.where(radius < middle, 1.0, 0.7))
    assert (left[~row] == 1.0).all()
    assert (found.bearing_share(usual, 2)[row] == 0.5).all()
    whole = OddContacts(SPUR, **{member: {5: OddFlank(pits=(Pit(0.9 * low, 1.1 * high, 0.3),))},
                                 other: {5: OddFlank(pits=(Pit(0.0, 1.0, 0.5),))}})  # fmt: skip
    assert (whole.bearing_share(usual, 5)[row] == 0.5).all()  # the smaller one of both flanks
    assert sorted(found.places) == pytest.approx(sorted(
        [float(SPUR.x_of_radius(r, member)) for r in (low, middle, middle, high)]
        + [float(SPUR.x_of_radius(r, other)) for r in SPUR.gear(other).involute_radii]
    ))  # fmt: skip


@pytest.mark.parametrize(("member", "other"), [MEMBERS, MEMBERS[::-1]])
def test_of_a_flank_with_a_profile_of_its_own_the_removal_is_by_it_and_by_the_mates(member, other):
    usual, (relief, own, off) = contacts(), (EndRelief(amount, 0.2, 0.5) for amount in (8e-6, 30e-6, 3e-6))
    reliefs = {member: relief, other: EndRelief(5e-6, 0.3, 0.5)}
    roll = {name: getattr(usual, f"roll_{name}") for name in MEMBERS}
    removal = sum(reliefs[name].removal(roll[name]) for name in MEMBERS)
    both, row = tuple(reliefs[name] for name in MEMBERS), usual.number == 0

    def modified(cycle=5, **flanks):
        given = {name: {5: flanks[name]} if name in flanks else {} for name in MEMBERS}
        found = OddContacts(SPUR, **given).modified(removal, usual, cycle, both)
        assert (found[usual.number != cycle - 5] == removal[usual.number != cycle - 5]).all()
        return found

    assert modified(**{member: OddFlank(pits=(Pit(0.0, 1.0),))}) is removal  # pits are no profile
    mate = reliefs[other].removal(roll[other])
    found = modified(**{member: OddFlank(relief=own, deviation=off)})
    expected = own.removal(roll[member]) + off.removal(roll[member]) + mate
    assert found[row] == pytest.approx(expected[row], abs=1e-18)
    found = modified(**{member: OddFlank(deviation=off)})
    assert found[row] == pytest.approx((removal + off.removal(roll[member]))[row], abs=1e-18)
    found = modified(**{member: OddFlank(relief=own), other: OddFlank(deviation=off)})
    expected = own.removal(roll[member]) + mate + off.removal(roll[other])
    assert found[row] == pytest.approx(expected[row], abs=1e-18)
    assert modified(9, **{member: OddFlank(relief=own)}) is removal


@pytest.mark.parametrize(("member", "other"), [MEMBERS, MEMBERS[::-1]])
def test_pairs_are_of_one_kind_where_their_flanks_are(member, other):
    low = OddFlank(tip_radius=20e-3)
    flanks = {3: low, 8: OddFlank(tip_radius=20e-3), 9: OddFlank(missing=True)}
    odd, number = OddContacts(SPUR, **{member: flanks, other: {}}), np.array([0, 1])
    at = MEMBERS.index(member)

    def kinds(cycle):
        return [one[at] for one in odd.kinds(number, cycle)]

    assert kinds(3) == kinds(8 + Z[member]) == [3, -1]  # the same flank, though another tooth
    assert kinds(9) == [9, 3]
    assert kinds(4) == [-1, 3]
    assert kinds(6) == []
    assert [one[1 - at] for one in odd.kinds(number, 3)] == [-1, -1]
    assert [one[at] for one in odd.on(number, 9)] == [flanks[9], flanks[8]]


# ---- cracks ----------------------------------------------------------------------------------------------------------
class Mesh:
    """Three pairs over six base pitches: loads, radii and intensities made up; the first carries little, or none."""

    number, x = np.array([-1, 0, 1]), np.array([0.1, 0.4, 0.7])

    def __init__(self, closing=()):
        rng = np.random.default_rng(4)
        self.loads = rng.uniform(5.0, 9.0, (6, 3, 3))
        self.loads[:, 0] = 0.0
        self.loads[:3, 0, 2] = 0.5
        self.loads[:, 1, 0] = self.loads[:, 2, 2] = 0.0
        self.radius = rng.uniform(1.1, 1.9, (3, 3))
        grid = SimpleNamespace(contacts=SimpleNamespace(radius_driver=self.radius, radius_driven=self.radius))
        compliance = SimpleNamespace(
            face_width=2.0, tooth=lambda member, row, cycle: row - cycle if member == "driver" else cycle - row
        )
        self.engagement = SimpleNamespace(grid=lambda _x: grid, compliance=compliance)
        self.found = SimpleNamespace(x=self.x, pitch=1.3, load=10.0, number=self.number, loads=self.loads)
        self.influence = SimpleNamespace(
            gear=SimpleNamespace(teeth=6, base_radius=4.0), known=range(-2, 3), from_middle=lambda i: (i + 3) % 6 - 3,
            ordinary=SimpleNamespace(lowest_radius=1.0, highest_radius=2.0), fine=SimpleNamespace(closing=closing),
            stress_intensity=lambda i, j, r: (self.k(i, j, r), 0.01 * np.abs(self.k(i, j, r))), faces_under=self.under,
        )  # fmt: skip

    def k(self, i, j, radius):
        """Stress intensity by loads on tooth j."""
        j = self.influence.from_middle(j)
        return np.stack([(10.0 + j) * radius, (1.0 - j) * radius**2])

    def under(self, tooth, here):
        return np.sum([radius * line for radius, line in here.values()], axis=0) + 100.0 * (tooth % 6)


@pytest.mark.parametrize(("member", "forward"), [("driver", -1), ("driven", 1)])
def test_intensity_is_the_sum_of_those_by_the_loads_on_all_teeth(member, forward):
    mesh = Mesh()
    found = crack_in_mesh(mesh.engagement, mesh.found, member, mesh.influence, 1)
    order = (forward * 1) % 6
    assert found.tooth == order
    pitches = np.unique(found.base_pitch)
    assert found.base_pitch.tolist() == np.repeat(pitches, 3).tolist()
    # all in which the teeth that are loaded are known by number: tooth 3, across the gear, is not
    wanted = []
    for pitch in range(-4, 5):
        loaded = [j for j, load in zip((-1, 0, 1), mesh.loads[(order + pitch) % 6], strict=True) if load.any()]
        if all((order + pitch - j) % 6 != 3 for j in loaded):
            wanted.append(pitch)
    assert pitches.tolist() == wanted
    for n, pitch in enumerate(pitches.tolist()):
        loads, (expected, off) = mesh.loads[(order + pitch) % 6] / 2.0, np.zeros((2, 2, 3))
        for row, pair in enumerate((-1, 0, 1)):
            by_row = mesh.k(1, forward * (order + pitch - pair), mesh.radius[row]) * loads[row]
            expected, off = expected + by_row, off + 0.01 * np.abs(by_row)
        here = slice(3 * n, 3 * n + 3)
        assert found.k_1[here] == pytest.approx(expected[0])
        assert found.k_2[here] == pytest.approx(expected[1])
        assert found.k_1_error[here] == pytest.approx(off[0])
        assert found.k_2_error[here] == pytest.approx(off[1])
        # its own load: on pair 0 in its base pitch, on pair 1 in the next one
        own = mesh.loads[(order + pitch) % 6, pitch + 1] if pitch in (-1, 0, 1) else np.zeros(3)
        assert found.load[here] == pytest.approx(own)


def test_faces_that_may_close_do_so_under_all_loads_together():
    open_, mesh, asked = Mesh(), Mesh(closing=(1,)), []

    def closed(tooth, loads):
        asked.append((tooth, {one: (radius, load) for one, (radius, load) in loads.items()}))
        return np.array([[2.0] * 3, [3.0] * 3]), np.array([[0.1] * 3, [0.2] * 3])

    mesh.influence.closed_intensity = closed
    before, found = (crack_in_mesh(one.engagement, one.found, "driven", one.influence, 1) for one in (open_, mesh))
    assert found.k_1 == pytest.approx(before.k_1 + 2.0)
    assert found.k_2 == pytest.approx(before.k_2 + 3.0)
    assert found.k_1_error == pytest.approx(before.k_1_error + 0.1)
    assert found.k_2_error == pytest.approx(before.k_2_error + 0.2)
    pitches = np.unique(found.base_pitch).tolist()
    assert len(asked) == len(pitches)
    for pitch, (tooth, loads) in zip(pitches, asked, strict=True):
        assert tooth % 6 == 1
        on = {1 + pitch - j: row for row, j in enumerate((-1, 0, 1)) if mesh.loads[(1 + pitch) % 6, row].any()}
        assert {one for one in loads if one != tooth} == {one for one in on if one != tooth}
        for one, row in on.items():
            radius, load = loads[one]
            assert np.array_equal(radius, mesh.radius[row])
            assert load == pytest.approx(mesh.loads[(1 + pitch) % 6, row] / 2.0)


def test_of_unstated_errors_none_is_made():
    mesh = Mesh()
    mesh.influence.stress_intensity = lambda i, j, r: (mesh.k(i, j, r), np.full((2, r.size), np.nan))
    found = crack_in_mesh(mesh.engagement, mesh.found, "driver", mesh.influence, 1)
    assert found.k_1_error is found.k_2_error is None


def test_faces_that_press_leave_no_negative_k_1_and_what_is_below_zero_is_an_error():
    asked = []

    def closed(tooth, loads):
        asked.append((tooth, loads))
        return np.array([[1.0, -3.0], [0.5, 0.5]]), np.array([[0.1, 0.1], [0.2, 0.2]])

    influence = SimpleNamespace(gear=SimpleNamespace(teeth=6), closed_intensity=closed)
    k, error = np.array([[1.0, 1.0], [2.0, 2.0]]), np.array([[0.01, 0.02], [0.03, 0.04]])
    radius, load = np.array([1.5, 1.6]), np.array([3.0, 4.0])
    value, off = _closed(influence, 2, {8: (radius, load)}, k, error)
    assert value == pytest.approx(np.array([[2.0, 0.0], [2.5, 2.5]]))
    # below zero by 2: an error of both modes
    assert off == pytest.approx(np.array([[0.11, 2.12], [0.23, 2.24]]))
    assert asked[0][0] == 8  # the cracked tooth by the number under which it is loaded
    _closed(influence, 2, {3: (radius, load)}, k, error)
    tooth, loads = asked[1]
    assert (tooth, sorted(loads)) == (2, [2, 3])
    assert (loads[2][1] == 0.0).all()
    assert np.array_equal(loads[2][0], radius)
    assert np.array_equal(loads[3][1], load)


@pytest.mark.parametrize(("member", "forward"), [("driver", -1), ("driven", 1)])
def test_faces_are_followed_while_their_own_tooth_carries(member, forward):
    mesh = Mesh()
    found = faces_in_mesh(mesh.engagement, mesh.found, member, mesh.influence, 1)
    order, expected = (forward * 1) % 6, []
    for row, pair in enumerate((-1, 0, 1)):
        loads = mesh.loads[(order + pair) % 6]
        at = loads[row] > 0.0
        expected += ((mesh.radius * loads / 2.0).sum(axis=0)[at] + 100.0).tolist()
    assert (found.tooth, found.member) == (order, member)
    assert found.closed == pytest.approx(expected)
    mesh.loads[:] = 0.0
    assert faces_in_mesh(mesh.engagement, mesh.found, member, mesh.influence, 1).closed.size == 0


def test_a_missing_tooth_has_no_stress_and_makes_none():
    fine = SimpleNamespace(missing=(1,), odd={0: "cracked"})
    influence = SimpleNamespace(
        known=range(-2, 3), touched=range(-2, 3), from_middle=lambda tooth: (tooth + 5) % 10 - 5, fine=fine,
        gear=SimpleNamespace(teeth=10), ends=lambda near: (1.0, 2.0),
        fillet_stress=lambda i, j, side, r, free=False: np.full((4, np.size(r)), 10.0 * i + j + 0.5 * free),
    )  # fmt: skip
    ordinary = SimpleNamespace(
        root_stress=lambda i, j, r, side: np.full((3, np.size(r)), 1000.0 + i - j), reach=2
    )  # fmt: skip
    odd = OddCompliance.__new__(OddCompliance)
    for name, value in (("influence", influence), ("ordinary", ordinary), ("free", False)):
        object.__setattr__(odd, name, value)
    radius = np.array([1.2, 1.4])

    def stress(i, j):
        return odd.root_stress(i, j, radius, "tension")

    assert (stress(1, 0).shape, stress(1, 0).any()) == ((3, 2), False)  # it has no fillet
    assert (stress(0, 1).shape, stress(0, 1).any()) == ((4, 2), False)  # and nothing loads it
    assert (stress(0, 2) == 2.0).all()
    assert (stress(5, 4) == 1001.0).all()  # ordinary ones
    assert (stress(0, 3).shape, stress(0, 3).any()) == ((4, 2), False)  # beyond the reach
    ordinary.root_stress = lambda *_asked: None
    assert stress(1, 0) is None


def test_a_compliance_that_is_off_by_its_error_answers_as_its_base_about_stress():
    base = SimpleNamespace(
        root_stress=lambda *asked: ("stress", *asked), fillet_curve=lambda *asked: ("curve", *asked),
        root_stress_error=lambda *asked: ("error", *asked),
    )  # fmt: skip
    shifted = ShiftedCompliance.__new__(ShiftedCompliance)
    object.__setattr__(shifted, "base", base)
    assert shifted.root_stress(3, 4, "r", "compression") == ("stress", 3, 4, "r", "compression")
    assert shifted.fillet_curve(3, "tension") == ("curve", 3, "tension")
    assert shifted.root_stress_error(3, 4, "r") == ("error", 3, 4, "r", "tension")


@pytest.mark.parametrize(("side", "largest"), [("tension", [5.0, 8.0]), ("compression", [-2.0, -9.0])])
def test_the_largest_of_a_history_is_over_all_rows_and_positions_with_stress(side, largest):
    stress = np.array([[[1.0, 8.0], [-2.0, np.nan]], [[5.0, -9.0], [np.nan, 0.0]]])
    assert RootStressHistory("driver", side, np.zeros(2), stress).largest.tolist() == largest
