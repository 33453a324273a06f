"""Modifications over roll angle and face, and the gaps that they leave on contact lines."""

import math

import numpy as np
import pytest

from fegear.base.errors import GeometryError, InputError
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.flank_modification import Bias, HelixSlope, LeadCrowning, LeadEndRelief, LeadTable, Topography
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import tip_relief
from fegear.geometry.shaft_tilt import ShaftTilt

STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE, WIDTH = 3e-3, 24e-3


def gear(teeth=20, beta=15.0, hand="right", width=WIDTH):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, width, STEEL, "strain", hand if beta else "spur")


@pytest.fixture(scope="module")
def pair():
    return GearPair(gear(), gear(31, hand="left"))


@pytest.fixture(scope="module")
def lines(pair):
    return contact_lines(pair, pair.x_start + pair.base_pitch * np.array([0.1, 0.4, 0.8]), 0.5 * MODULE)


ENDS = np.array([-0.5, 0.0, 0.5]) * WIDTH


@pytest.mark.parametrize(
    ("part", "removed"),
    [
        (LeadCrowning(8e-6, WIDTH), [8e-6, 0.0, 8e-6]),
        (HelixSlope(8e-6, WIDTH), [0.0, 4e-6, 8e-6]),
        (LeadEndRelief(8e-6, 2e-3, WIDTH), [8e-6, 0.0, 8e-6]),
        (LeadEndRelief(8e-6, 2e-3, WIDTH, "I"), [8e-6, 0.0, 0.0]),
        (LeadEndRelief(8e-6, 2e-3, WIDTH, "II", 2.0), [0.0, 0.0, 8e-6]),
        (LeadTable(ENDS, np.array([3e-6, 1e-6, 0.0])), [3e-6, 1e-6, 0.0]),
    ],
)
def test_lead_modifications_have_their_amounts_at_the_ends(part, removed):
    np.testing.assert_allclose(part.removal(0.4, ENDS), removed, atol=1e-20)
    assert part.removal(np.full((2, 1), 0.3), ENDS).shape == (2, 3)


def test_end_relief_reaches_half_its_amount_in_the_middle_of_its_length_or_a_quarter():
    at = 0.5 * WIDTH - 1e-3
    assert LeadEndRelief(8e-6, 2e-3, WIDTH).removal(0.4, at) == pytest.approx(4e-6)
    assert LeadEndRelief(8e-6, 2e-3, WIDTH, "both", 2.0).removal(0.4, -at) == pytest.approx(2e-6)
    with pytest.raises(InputError, match="face width"):
        LeadEndRelief(8e-6, 25e-3, WIDTH)


def test_bias_is_the_change_of_the_profile_slope_over_the_face_and_of_the_helix_slope_over_the_profile():
    bias = Bias(10e-6, 0.2, 0.6, WIDTH)
    corner = bias.removal(np.array([[0.2], [0.6]]), ENDS)
    profile_slope = corner[1] - corner[0]
    helix_slope = corner[:, 2] - corner[:, 0]
    assert profile_slope[2] - profile_slope[0] == pytest.approx(10e-6)
    assert helix_slope[1] - helix_slope[0] == pytest.approx(10e-6)
    assert corner[1, 2] == pytest.approx(2.5e-6)
    assert corner[:, 1] == pytest.approx(0.0, abs=1e-20)


def test_a_table_on_a_grid_is_its_formula(pair, lines):
    """Bilinear functions exactly; others to the square of the grid; held beyond the ends."""
    bias = Bias(10e-6, 0.2, 0.6, WIDTH)
    roll, z = np.linspace(0.0, 1.0, 5), np.linspace(-0.5, 0.5, 4) * WIDTH
    table = Topography(roll, z, bias.removal(roll[:, None], z))
    np.testing.assert_allclose(
        FlankGaps(driver_flank=(table,)).at(pair, lines), FlankGaps(driver_flank=(bias,)).at(pair, lines), atol=1e-18
    )
    crown = LeadCrowning(10e-6, WIDTH)
    errors = []
    for n in (17, 33):
        z = np.linspace(-0.5, 0.5, n) * WIDTH
        tables = Topography(roll, z, crown.removal(roll[:, None], z)), LeadTable(z, crown.removal(0.0, z))
        gaps = [FlankGaps(driven_flank=(t,)).at(pair, lines) for t in (*tables, crown)]
        np.testing.assert_allclose(gaps[0], gaps[1], atol=1e-18)
        errors.append(np.abs(gaps[0] - gaps[2]).max())
    assert errors[0] <= 10e-6 / 16**2 * (1.0 + 1e-9)
    assert errors[1] <= 10e-6 / 32**2 * (1.0 + 1e-9)
    assert table.removal(5.0, 1.0) == table.removal(1.0, 0.5 * WIDTH)
    assert table.removal(-5.0, -1.0) == table.removal(0.0, -0.5 * WIDTH)


def test_modifications_add_up_and_count_the_same_on_either_gear(pair, lines):
    parts = LeadCrowning(8e-6, WIDTH), HelixSlope(-5e-6, WIDTH), LeadEndRelief(9e-6, 3e-3, WIDTH, "II")
    relief = tip_relief(pair.driver, 20e-6, length=2e-3)
    line = {"face_position": ENDS, "line_gap": np.array([0.0, 1e-6, 5e-6])}
    whole = FlankGaps(driver_relief=relief, driver_flank=parts, **line).at(pair, lines)
    alone = [FlankGaps(driver_flank=(part,)).at(pair, lines) for part in parts]
    alone += [FlankGaps(relief).at(pair, lines), FlankGaps(**line).at(pair, lines)]
    np.testing.assert_allclose(whole, np.sum(alone, axis=0), atol=1e-19)
    other = FlankGaps(driver_relief=relief, driven_flank=parts, **line).at(pair, lines)
    np.testing.assert_allclose(whole, other, atol=1e-19)
    assert not FlankGaps().at(pair, lines).any()


@pytest.mark.parametrize(
    "grid",
    [
        (np.array([0.1]), ENDS, np.zeros((1, 3))),
        (np.array([0.1, 0.1]), ENDS, np.zeros((2, 3))),
        (np.array([0.1, 0.2]), ENDS, np.full((2, 3), np.nan)),
        (np.array([0.1, 0.2]), ENDS, np.zeros((3, 2))),
    ],
)
def test_what_is_no_grid_is_refused(grid):
    with pytest.raises(InputError, match="topography"):
        Topography(*grid)


def test_mirrored_hands_with_mirrored_errors_have_mirrored_gaps():
    """z changes its sign with the hand; a shaft's deviation, a slope and a bias with it, a crowning does not."""
    at = np.array([0.1, 0.45, 0.8])
    sides = []
    for hands, sign in ((("right", "left"), 1.0), (("left", "right"), -1.0), (("spur", "spur"), 1.0),
                        (("spur", "spur"), -1.0)):  # fmt: skip
        beta = 0.0 if hands[0] == "spur" else 15.0
        pair = GearPair(gear(beta=beta, hand=hands[0]), gear(31, beta, hands[1]), axial_offset=sign * 3e-3)
        lines = contact_lines(pair, pair.x_start + pair.base_pitch * at, 0.5 * MODULE)
        end = LeadEndRelief(5e-6, 3e-3, WIDTH, "II" if sign > 0.0 else "I")
        slope = (HelixSlope(sign * 6e-6, WIDTH),)
        gaps = FlankGaps(
            driver_flank=(LeadCrowning(8e-6, WIDTH), Bias(sign * 9e-6, 0.2, 0.6, WIDTH), end),
            driven_flank=slope, tilt=ShaftTilt(sign * 3e-4, sign * 2e-4),
        )  # fmt: skip
        # what a slope of the other sign starts from is a shift of the whole
        gap = gaps.at(pair, lines) + (0.0 if sign > 0.0 else 6e-6)
        sides.append([np.sort(gap[p, s]) for p in range(at.size) for s in lines.at(p)])
    for one, other in (sides[:2], sides[2:]):
        for a, b in zip(one, other, strict=True):
            np.testing.assert_allclose(a, b, atol=1e-15)


def test_faces_beside_each_other_are_refused():
    with pytest.raises(GeometryError, match="leaves no common face width"):
        GearPair(gear(), gear(31, hand="left"), axial_offset=WIDTH)
    pair = GearPair(gear(), gear(31, hand="left", width=0.5 * WIDTH), axial_offset=0.5 * WIDTH)
    assert pair.face_width == pytest.approx(0.25 * WIDTH)
    assert pair.face_height("driver") == pytest.approx(0.375 * WIDTH)
    assert pair.face_height("driven") == pytest.approx(-0.125 * WIDTH)
