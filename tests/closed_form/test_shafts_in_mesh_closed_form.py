"""Shafts that move the flanks of their meshes: the gap by whole helicoids in space, virtual work, shares by cause."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.shaft_tilt import ShaftTilt
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import stiff
from fegear.shafts.gearbox import CAUSES, Gearbox
from fegear.shafts.held import LoadedShaft, Seat
from fegear.shafts.mesh import MeshPlace
from fegear.shafts.section import Section

E_Z = np.array([0.0, 0.0, 1.0])
OTHER = {"right": "left", "left": "right", "spur": "spur"}


def _gear(teeth, beta, hand, width):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, 3e-3, 0.5 * tooth.root_radius * 3e-3, width, Material(206e9, 0.3), "strain", hand)


def _mesh(beta, hand, sense, angle, offset=0.0, names=("a", "b"), load=5000.0):
    pair = GearPair(_gear(21, beta, hand, 0.03), _gear(43, beta, OTHER[hand], 0.026), axial_offset=-sense * offset)
    towards = np.array([math.cos(angle), math.sin(angle)])
    return MeshPlace("I", names, (0.04, 0.04 + offset), towards, sense, pair, load)


def _about(axis, angle, points):
    return Rotation.from_rotvec(np.asarray(axis) * angle).apply(points)


def _gap_of_helicoids(mesh, x, z, motions):
    """Gap along the line of action at flank points as two rigid gears move, in the coordinates of the shafts.

    From scratch: involutes drawn in space, right hands turning counter-clockwise toward +z; a driver that turns
    counter-clockwise pushes with its flank that faces so. Nothing of this knows the frame of a pair.
    """
    pair, s = mesh.found, mesh.sense
    y = np.array([*mesh.towards, 0.0])
    x_space = s * np.cross(E_Z, y)
    angle = math.acos(pair.driver.base_radius / (pair.centre_distance / (1.0 + pair.ratio)))
    u = math.cos(angle) * x_space + math.sin(angle) * y
    heights = mesh.at[0] - s * (z + pair.face_height("driver"))  # toward end II z of the shafts falls where s = 1
    centres = np.zeros(3), pair.centre_distance * y
    flanks = []
    for gear, centre, along, side in ((pair.driver, centres[0], u, 1.0), (pair.driven, centres[1], -u, -1.0)):
        rb = gear.base_radius
        rho = rb * math.tan(angle) + side * x
        e_t = s * along  # the normal, at every contact point
        e_r = np.cross(e_t, E_Z)
        flanks.append((rb, rho, e_r, e_t, centre, {"right": 1, "left": -1, "spur": 0}[gear.hand] * abs(gear.twist)))
    rb, rho, e_r, e_t, centre, _ = flanks[0]
    points = centre + rb * e_r + s * rho[:, None] * e_t + heights[:, None] * E_Z
    rb2, rho2, e_r2, e_t2, centre2, twist2 = flanks[1]
    touching = centre2 + rb2 * e_r2 + s * rho2[:, None] * e_t2 + heights[:, None] * E_Z
    assert np.abs(points - touching).max() < 1e-12
    found = []
    for moved in motions:
        (shift, turn), (shift2, turn2) = moved
        pivot = np.array([0.0, 0.0, mesh.at[0]])
        seen = pivot + shift + Rotation.from_rotvec(turn).apply(points - pivot)
        pivot2 = centre2 + np.array([0.0, 0.0, mesh.at[1]])
        own = Rotation.from_rotvec(turn2).apply(seen - pivot2 - shift2, inverse=True) + pivot2 - centre2
        radius = np.hypot(own[:, 0], own[:, 1])
        length = np.sqrt(radius**2 - rb2**2)
        # Azimuth of the driven flank at this radius and height, from that of its contact normal where it touched.
        base = math.atan2(e_r2[1], e_r2[0]) + s * rho2 / rb2 + twist2 * (own[:, 2] - heights)
        flank = base - s * length / rb2 + s * np.arctan(length / rb2)
        azimuth = np.arctan2(own[:, 1], own[:, 0])
        found.append(rb2 * s * (np.mod(azimuth - flank + math.pi, 2 * math.pi) - math.pi))
    return np.array(found)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("hand", ["right", "left", "spur"])
def test_the_gap_is_that_of_two_helicoids_in_space(sense, hand):
    rng = np.random.default_rng(7)
    mesh = _mesh(0.0 if hand == "spur" else 17.0, hand, sense, 0.7, offset=0.004)
    pair = mesh.found
    lean = pair.driver.base_radius * pair.driver.twist
    z = rng.uniform(-0.4, 0.4, 40) * pair.face_width
    x = 0.1 * pair.base_pitch - lean * z
    motions = rng.normal(size=(5, 2, 2, 3)) * 1e-9 * np.array([1.0, 30.0])[:, None]
    exact = _gap_of_helicoids(mesh, x, z, motions)
    for both, wanted in zip(motions, exact, strict=True):
        gap = np.zeros((2, mesh.heights.size))
        for (shift, turn), (place, ways, _), at in zip(both, mesh.ways((1.0, 1.0)), mesh.at, strict=True):
            moved = shift + np.cross(turn, (place - at)[:, None] * E_Z)
            gap += np.einsum("pakn,pa->kn", ways, np.column_stack([moved, np.tile(turn, (place.size, 1))]))
        found = np.interp(z, mesh.heights, gap[0]) + x * np.interp(z, mesh.heights, gap[1])
        assert found == pytest.approx(wanted, abs=1e-5 * np.abs(wanted).max())


@pytest.mark.parametrize("sense", [1, -1])
def test_tilted_axes_open_the_gap_of_shaft_tilt(sense):
    mesh = _mesh(17.0, "right", sense, -2.0)
    pair, box = mesh.found, None
    turns = np.array([2e-5, -3e-5, 0.0]), np.array([-1e-5, 4e-5, 0.0])
    gap, lines = np.zeros((2, mesh.heights.size)), []
    for turn, (place, ways, _), at in zip(turns, mesh.ways((1.0, 1.0)), mesh.at, strict=True):
        moved = np.column_stack([np.cross(turn, (place - at)[:, None] * E_Z), np.tile(turn, (place.size, 1))])
        gap += np.einsum("pakn,pa->kn", ways, moved)
        lines.append(moved)
    in_plane, out_of_plane = mesh.tilt(lines[1], lines[0])
    x = np.array([[-2e-3], [0.0], [3e-3]])
    wanted = ShaftTilt(in_plane, out_of_plane).gap(pair, x, mesh.heights)
    found = gap[0] + x * gap[1]
    assert found - found[1, 8] == pytest.approx(wanted, abs=1e-12 * np.abs(wanted).max() * 1e3)
    assert box is None


HELD, FREE = stiff(2e8, 1e8, 1e5), (stiff(2e8, 1e8), stiff(2e8))


def _gearbox(seats=(HELD, HELD), names=("a", "b"), housing=None, e=206e9):
    mesh = _mesh(17.0, "right", 1, 0.4)
    shafts = []
    for name in names:
        shaft = Shaft((Section(0.02, 0.03), Section(0.11, 0.04, 0.01)), e, 0.3)  # faces hold no step
        held = Seat(seats[0], 0.005), Seat(seats[1], 0.12)
        shafts.append(LoadedShaft(shaft, held, np.array([0.09]), np.array([[300.0, -200.0, 50.0, 0, 0, 0]]), name))
    return Gearbox(
        tuple(shafts),
        (0.0, 0.13),
        (mesh,),
        np.diag([2e-9, 2e-9, 3e-9, 0, 0] * 4) if housing is None else housing,
        names,
    )


def test_forces_and_energy_balance_and_the_response_is_the_derivative():
    box = _gearbox()
    rng = np.random.default_rng(3)
    forces = tuple(one * rng.uniform(0.5, 1.5, one.shape) + rng.normal(size=one.shape) for one in box.even)
    bent = box.under(forces)
    assert all(one.balance.max() < 1e-9 for one in bent)
    unit = box.compliance(bent)
    more = rng.normal(size=forces[0].shape) * 10.0
    more[0] -= more[0].mean()  # loads move over the face, their sum is given
    moved = [
        box.gaps(tuple(one.at(z) for one, z in zip(state, box.places, strict=True)))[0]
        for state in (bent, box.under((forces[0] + more,)))
    ]
    assert unit @ more.ravel() == pytest.approx((moved[1] - moved[0]).ravel(), rel=1e-6, abs=1e-13)
    # Clapeyron: without forces from outside, work of the forces on the gaps is twice the energy of beams and springs.
    alone = Gearbox(
        tuple(LoadedShaft(s.shaft, s.seats, np.empty(0), np.empty((0, 6)), s.name) for s in box.shafts),
        (0.0, 0.13),
        box.meshes,
        box.housing,
        box.names,
    )
    bent = alone.under(forces)
    energy = 0.0
    for one in bent:
        at, loads = one.acting
        s, weight = one.loaded.shaft.quadrature(at)
        strain = one.loaded.shaft.strains(at, loads, s)
        energy += 0.5 * float(weight @ (strain**2 / one.loaded.shaft.section_compliance(s)).sum(axis=1))
        energy += 0.5 * float(-(one.bearing_forces * one.rings).sum())
        seat = np.diag([2e-9, 2e-9, 3e-9, 0, 0])
        energy += 0.5 * float((one.bearing_forces @ seat * one.bearing_forces).sum())
    work = 0.0
    for one in bent:
        at, loads = one.acting
        work += float((loads[2:] * one.at(at[2:])).sum())
    assert 0.5 * work == pytest.approx(energy, rel=1e-9)


def test_shares_by_cause_add_up_and_are_those_of_rigid_parts():
    box = _gearbox(seats=FREE)
    bent = box.under(box.even)
    causes = box.by_cause(bent)
    for one, shares, z in zip(bent, causes, box.places, strict=True):
        assert shares.sum(axis=0) == pytest.approx(one.at(z), rel=1e-9, abs=1e-16)
    # Of two bearings across and one along each part is what the others leave when they are rigid.
    shares, _ = box.misalignment(bent, box.even)[0]
    rigid = np.zeros((20, 20))
    for n, name in enumerate(CAUSES):
        if name == "torsion":
            continue
        other = _gearbox(
            seats=FREE if name == "bearings" else (stiff(1e16, 1e16), stiff(1e16)),
            housing=None if name == "housing" else rigid, e=206e9 if name == "bending" else 206e17,
        )  # fmt: skip
        alone, _ = other.misalignment(other.under(other.even), other.even)[0]
        assert alone.over_face[n + 1] == pytest.approx(shares.over_face[n + 1], rel=1e-6)
        assert alone.in_plane[n + 1] == pytest.approx(shares.in_plane[n + 1], rel=1e-6)


def test_wind_up_of_a_wide_pinion_is_that_of_a_bar_with_an_even_torque():
    """Torque that leaves a bar evenly over its length b twists its ends by T b / (2 G J)."""
    mesh = _mesh(0.0, "spur", 1, 0.0)
    stout = Shaft((Section(0.08, 0.5),), 206e12, 0.3)
    thin = Shaft((Section(0.08, 0.03),), 206e9, 0.3)
    seats = Seat(stiff(math.inf, math.inf), 0.0), Seat(stiff(math.inf), 0.08)
    shafts = tuple(LoadedShaft(s, seats, np.empty(0), np.empty((0, 6)), n) for s, n in ((thin, "a"), (stout, "b")))
    box = Gearbox(shafts, (0.0, 0.08), (mesh,), np.zeros((20, 20)), ("a", "b"))
    twist = box.by_cause(box.under(box.even))[0][3][:, 5]
    torque, b = mesh.load * mesh.found.driver.base_radius, mesh.found.face_width
    shear_modulus = 206e9 / 2.6
    wanted = torque * b / (2 * shear_modulus * math.pi / 32 * 0.03**4)
    assert abs(twist[0] - twist[-1]) == pytest.approx(wanted, rel=1e-9)
    # The coupling is at the left end: there the pinion leads, for it is driven there, and the gap closes.
    gap = box.misalignment(box.under(box.even), box.even)[0][1]
    torsion = gap.by_cause[3]
    left, right = (torsion[-1], torsion[0]) if mesh.sense > 0 else (torsion[0], torsion[-1])
    assert right - left == pytest.approx(wanted * mesh.found.driver.base_radius, rel=1e-6)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("ring", ["", "driver", "driven"])
def test_forces_turn_both_gears_at_their_base_circles(ring, sense):
    """Torques are load times base radius; a ring is turned the way of its mate, which it pulls toward its own axis."""
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter

    small = Gear(Tooth(20, BasicRack(1.0, 1.25, 0.25)), 3e-3, 12e-3, 0.02)
    hollow = Gear(InternalTooth(60, PinionCutter(25), tip_radius=29.3), 3e-3, 105e-3, 0.02)
    pair = {"": GearPair(small, small), "driven": GearPair(small, hollow), "driver": GearPair(hollow, small)}[ring]
    towards = np.array([0.6, -0.8])
    mesh = MeshPlace("I", ("a", "b"), (0.05, 0.05), towards, sense, pair, 1000.0)
    (_, on_driver, _), (_, on_driven, _) = mesh.ways((0.1, 0.1))
    driver, driven = (1000.0 * ways[8, :, 0, 8] for ways in (on_driver, on_driven))
    assert driver[:3] == pytest.approx(-driven[:3])
    assert driver[5] == pytest.approx(-sense * 1000.0 * pair.driver.base_radius)
    assert driven[5] == pytest.approx((sense if ring else -sense) * 1000.0 * pair.driven.base_radius)
    apart = driven[:2] @ towards  # flanks press external gears apart, and a gear and its ring together
    assert apart == pytest.approx((-1.0 if ring else 1.0) * 1000.0 * math.sin(pair.working_pressure_angle))


def test_what_heights_leave_out_falls_with_their_square(monkeypatch):
    found = []
    for count in (5, 9, 17, 33):
        monkeypatch.setattr("fegear.shafts.mesh._HEIGHTS", count)
        box = _gearbox()
        shares, gap = box.misalignment(box.under(box.even), box.even)[0]
        found.append([shares.over_face[0], gap.gap[0], gap.gap[-1]])
    changes = np.abs(np.diff(found, axis=0))
    assert changes[1:] == pytest.approx(changes[:-1] / 4.0, rel=0.1)
    assert changes[-1].max() < 1e-3 * np.abs(found[-1]).max()  # of the 17 that are used
