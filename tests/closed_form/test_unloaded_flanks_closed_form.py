"""Loaded flanks without load: rigid tooth contact analysis, found by other means (NASA TM-107451)."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fegear.contact.unloaded.manufacture import CutRemoval
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.tooth_contact import mesh_cycle
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.contact.wide.rigid_flanks import beside_the_lines, touching_gaps, unloaded_error
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.flank_modification import LeadCrowning
from fegear.geometry.gear import Gear, Material
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import tip_relief
from fegear.geometry.shaft_tilt import ShaftTilt

STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE, WIDTH = 3e-3, 20e-3
ARCSEC = math.radians(1.0 / 3600.0)


def gear(teeth, beta, hand):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand if beta else "spur")


def both(beta, errors=None, parabola=0.0, crown=0.0, hands=("right", "left"), positions=16):
    """Transmission error over a pitch, of rigid tooth contact analysis and of unloaded flanks [rad of the gear]."""
    errors = errors or {}
    first, second = (gear(z, beta, hand) for z, hand in zip((23, 41), hands, strict=True))
    drive = HelicalPair(first, second, Misalignment(**errors), parabola=parabola, crown=crown)
    cycle = mesh_cycle(drive, positions)
    pair = GearPair(first, second)
    parts = {k: errors[k] for k in ("profile_angle", "lead_angle") if k in errors}
    cut = CutRemoval(first, **parts, parabola=parabola, crown=crown)
    # x of pair 0 from the pinion's angle; the wrongly cut pinion is turned until its pitch point is the designed one.
    pitch = math.sqrt((first.pitch_radius / first.base_radius) ** 2 - 1.0)
    angle = cycle.phi_1 + pair.working_pressure_angle - first.half_base_space_angle + float(cut._profile(pitch))
    roll = pair.driver.base_radius * (angle - math.tan(pair.working_pressure_angle))
    gaps = FlankGaps(driver_flank=(cut,), tilt=ShaftTilt(out_of_plane=errors.get("shaft_angle", 0.0)))
    found = -unloaded_error(pair, gaps, roll) / pair.driven.base_radius
    return cycle.error, found, (pair, gaps, roll)


@pytest.mark.dear("15.0-errors2-0.0-3.0", "30.0-errors3-1.0-3.0", "30.0-errors4-0.0-2.0")
@pytest.mark.parametrize(
    ("beta", "errors", "parabola", "crown"),
    [
        (0.0, {"shaft_angle": 1e-3}, 0.0, 0.0),
        (15.0, {"shaft_angle": 5e-4}, 0.0, 0.0),
        (15.0, {"shaft_angle": -1e-3}, 0.0, 3.0),
        (30.0, {"shaft_angle": 3e-4}, 1.0, 3.0),
        (30.0, {"lead_angle": 3e-5}, 0.0, 2.0),
        (15.0, {"profile_angle": 2e-4, "shaft_angle": 2e-4}, 3.0, 2.0),
    ],
)
def test_no_load_is_rigid_tooth_contact(beta, errors, parabola, crown):
    """To a thousandth of an arc-second: shafts, lead, profile, parabola, crown; surface, tip and face-end contact."""
    wanted, found, _ = both(beta, errors, parabola, crown)
    apart = (found - found.mean()) - (wanted - wanted.mean())
    assert np.ptp(wanted) > (1e-3 if beta else 1e-5) * ARCSEC
    assert np.abs(apart).max() < 1e-3 * ARCSEC


def test_the_gap_on_contact_lines_is_off_by_the_square_of_its_slope():
    """What `FlankGaps.at` leaves out: four times as much for twice the error, R sigma^2 / 2 of a relief."""
    pair = GearPair(gear(23, 15.0, "right"), gear(41, 15.0, "left"))
    lines = contact_lines(pair, pair.x_start + pair.base_pitch * (np.arange(6) + 0.5) / 6, MODULE)
    off = [beside_the_lines(pair, FlankGaps(tilt=ShaftTilt(3e-4 * e, 4e-4 * e)), lines) for e in (1.0, 2.0)]
    assert off[1] == pytest.approx(4.0 * off[0], rel=0.02)
    assert 0.0 < off[1] < 50e-9  # 1 um over a millimetre of face
    assert beside_the_lines(pair, FlankGaps(), lines) < 1e-16
    relief = tip_relief(pair.driver, 4e-6, length=2e-3)
    gaps = FlankGaps(driver_relief=relief)
    on = lines.present & (pair.roll_angle(lines.x, "driver") > relief.start + 0.01) & ~lines.at_edge
    rho = [pair.flank_curvature_radius(lines.x, member) for member in ("driver", "driven")]
    slope = 4e-6 / (relief.end - relief.start) / rho[0]
    # A relieved point is set back about the axis, so that the line of action meets one a little farther down.
    lower = slope * rho[0] / pair.driver.base_radius * relief.removal(pair.roll_angle(lines.x, "driver"))
    wanted = 0.5 * slope**2 * rho[0] * rho[1] / (rho[0] + rho[1]) + lower
    found = gaps.at(pair, lines) - touching_gaps(pair, gaps, lines)
    assert on.any()
    np.testing.assert_allclose(found[on], wanted[on], rtol=0.03)


def exact_gap(pair, tilt, x0, driver_flank=()):
    """Least gap of two whole helicoids, the driven one turned with its shaft: points of the driver by brute force [m].

    In the frame of TM-107451, whose z runs against that of loaded flanks.
    """
    first, second = InvoluteHelicoid.of(pair.driver, "space"), InvoluteHelicoid.of(pair.driven, "tooth")
    angle = x0 / pair.driver.base_radius + math.tan(pair.working_pressure_angle) - pair.working_pressure_angle
    phi_1 = angle + pair.driver.half_base_space_angle
    phi_2 = phi_1 * pair.driver.teeth / pair.driven.teeth
    # The gear's axis, from (0, 0, 1) to (-in plane, -out of plane, 1): z runs against that of loaded flanks.
    turn = Rotation.from_rotvec([tilt.out_of_plane, -tilt.in_plane, 0.0])
    half = 0.5 * pair.face_width
    ends = [math.sqrt(r**2 - first.base_radius**2) for r in (pair.driver.form_radius, pair.driver.involute_tip_radius)]
    form, tip = (math.sqrt(r**2 - second.base_radius**2) for r in (pair.driven.form_radius,
                                                                  pair.driven.involute_tip_radius))  # fmt: skip

    def gap(at):
        t, z = at[0], at[1]
        point = first.points(t, z)
        back = sum(part.removal(t / first.base_radius, -z) for part in driver_flank) / first.base_radius
        c, s = np.cos(phi_1 - back), np.sin(phi_1 - back)
        seen = np.stack([c * point[0] - s * point[1], s * point[0] + c * point[1], point[2]], axis=-1)
        seen = turn.apply((seen - np.array([pair.centre_distance, 0.0, 0.0])).reshape(-1, 3), inverse=True)
        x2, y2, z2 = -seen[:, 0], -seen[:, 1], seen[:, 2]
        c, s = np.cos(phi_2), np.sin(phi_2)
        own = np.stack([c * x2 - s * y2, s * x2 + c * y2, z2])
        length = np.sqrt(np.maximum(own[0] ** 2 + own[1] ** 2 - second.base_radius**2, 0.0))
        on = (length >= form) & (length <= tip) & (np.abs(z2) <= half)
        apart = second.separation_angle(own) * second.base_radius
        return np.where(on, apart, 1.0).reshape(np.shape(t))

    return gap, ends, half


@pytest.mark.parametrize(
    ("beta", "tilt"), [(0.0, ShaftTilt(4e-4, 0.0)), (20.0, ShaftTilt(5e-4, -2e-4)), (20.0, ShaftTilt(-4e-4, 0.0))]
)
def test_shafts_tilted_in_and_out_of_their_plane_against_whole_helicoids(beta, tilt):
    hands = ("right", "left") if beta else ("spur", "spur")
    pair = GearPair(gear(23, beta, hands[0]), gear(41, beta, hands[1]))
    crown = LeadCrowning(6e-6, WIDTH)
    roll = pair.x_start + pair.base_pitch * np.array([0.3, 0.55, 0.8])
    found = unloaded_error(pair, FlankGaps(tilt=tilt, driver_flank=(crown,)), roll)
    wanted = []
    for x0 in roll.tolist():
        best = np.inf
        for j in range(-2, 3):
            gap, (form, tip), half = exact_gap(pair, tilt, x0 + j * pair.base_pitch, (crown,))
            t, z = np.linspace(form, tip, 151), np.linspace(-half, half, 151)
            for _ in range(7):
                grid = gap(np.meshgrid(t, z, indexing="ij"))
                i, k = np.unravel_index(int(grid.argmin()), grid.shape)
                best = min(best, float(grid[i, k]))
                t = np.linspace(t[max(i - 3, 0)], t[min(i + 3, t.size - 1)], 41)
                z = np.linspace(z[max(k - 3, 0)], z[min(k + 3, z.size - 1)], 41)
        wanted.append(best)
    # But for a shift of all: the pitch point of a gear that tilts about the middle of its axis goes along the axis.
    arm = pair.driven.base_radius / math.cos(pair.working_pressure_angle)
    shift = pair.driver.twist * pair.driver.base_radius * arm * tilt.in_plane
    np.testing.assert_allclose(found - wanted, -shift, atol=1e-3 * ARCSEC * pair.driven.base_radius)


@pytest.mark.parametrize("offset", [-6e-3, 5e-3])
def test_faces_that_stand_apart_touch_as_rigid_flanks_do(offset):
    """Unequal faces, one beyond the other; the offset of TM-107451 counts against the heights of loaded flanks."""
    one, other = gear(23, 20.0, "right"), replace(gear(41, 20.0, "left"), face_width=15e-3)
    drive = HelicalPair(one, other, Misalignment(shaft_angle=1e-4), crown=3.0, axial_offset=-offset)
    cycle = mesh_cycle(drive, 12)
    pair = GearPair(one, other, axial_offset=offset)
    assert pair.face_width == pytest.approx(drive.overlap[1] - drive.overlap[0])
    assert pair.overlap_ratio == pytest.approx(drive.overlap_ratio)
    # z counts from the middle of the common face, and x of pair 0 there; there the shaft tilts, too, which is a shift.
    lean, up = pair.driver.twist * pair.driver.base_radius, pair.face_height("driver")
    angle = cycle.phi_1 + pair.working_pressure_angle - one.half_base_space_angle
    roll = pair.driver.base_radius * (angle - math.tan(pair.working_pressure_angle)) - lean * up
    gaps = FlankGaps(tilt=ShaftTilt(out_of_plane=1e-4), driver_flank=(CutRemoval(one, crown=3.0),))
    apart = -unloaded_error(pair, gaps, roll) / other.base_radius - cycle.error
    assert np.ptp(cycle.error) > 0.1 * ARCSEC
    assert np.ptp(apart) < 1e-3 * ARCSEC


@pytest.mark.parametrize("beta", [0.0, 15.0])
def test_no_load_repeats_after_a_base_pitch_however_far_the_gears_have_turned(beta):
    """Of crowned flanks on tilted shafts: the next tooth is where this one was."""
    pair = GearPair(gear(23, beta, "right"), gear(41, beta, "left"))
    gaps = FlankGaps(
        driver_flank=(CutRemoval(pair.driver, crown=3.0, parabola=2.0),), tilt=ShaftTilt(out_of_plane=2e-4)
    )
    roll = np.linspace(pair.x_start, pair.x_end, 7)
    found = unloaded_error(pair, gaps, roll)
    assert np.ptp(found) > 0.0
    for pitches in (-9, 4, 11):
        again = unloaded_error(pair, gaps, roll + pitches * pair.base_pitch)
        assert np.abs(again - found).max() < 1e-9 * np.abs(found).max() + 1e-15
