"""Odd teeth by parts: how far it is through a tooth, which stress counts, what is not known; answers made up."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.odd import odd_gear
from fegear.fem.plane.odd.crack import Crack, fillet_point, straight_crack, way_through
from fegear.fem.plane.odd.hole import Hole, _room
from fegear.fem.plane.odd.odd_influence import OddInfluence
from fegear.fem.plane.odd.other_sector import _arc
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.outline import tooth_outline
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))
MOUTH = 0.35


def off_outline(point):
    """Distance of a point from the outline of the tooth."""
    line = tooth_outline(TOOTH)
    start, chord = line[:, :-1], np.diff(line)
    along = np.clip(((point[:, None] - start) * chord).sum(axis=0) / (chord**2).sum(axis=0), 0.0, 1.0)
    return float(np.hypot(*(start + along * chord - point[:, None])).min())


@pytest.mark.parametrize("back", [False, True])
def test_straight_across_a_tooth_it_is_twice_the_way_to_its_centre_line(back):
    start, across = fillet_point(TOOTH, MOUTH, back=back), 1.0 if back else -1.0
    way = np.array([across, 0.0])
    assert way_through(TOOTH, start, way) == pytest.approx(2.0 * abs(start[0]), rel=1e-3)
    crack = straight_crack(TOOTH, MOUTH, math.radians(90.0), share=0.25, back=back)
    (end,) = crack.corners
    assert end == pytest.approx((0.5 * start[0], start[1]), rel=1e-3, abs=1e-12)


@pytest.mark.parametrize("angle", [100.0, 115.0, 130.0])
def test_upwards_it_leads_to_the_surface_on_the_other_side(angle):
    start = fillet_point(TOOTH, MOUTH)
    way = np.array([-math.sin(math.radians(angle)), -math.cos(math.radians(angle))])
    end = start + way_through(TOOTH, start, way) * way
    assert end[0] < 0.0
    assert end[1] > start[1]
    assert off_outline(end) < 1e-9


@pytest.mark.parametrize("angle", [20.0, 50.0, 70.0])
def test_below_the_root_it_leads_to_abreast_of_the_other_fillet(angle):
    start = fillet_point(TOOTH, MOUTH)
    way = np.array([-math.sin(math.radians(angle)), -math.cos(math.radians(angle))])
    through = way_through(TOOTH, start, way)
    assert through == pytest.approx(2.0 * start[0] / math.sin(math.radians(angle)), rel=1e-9)
    whole, half = (
        np.array(straight_crack(TOOTH, MOUTH, math.radians(angle), share=share).corners[0]) for share in (1.0, 0.5)
    )
    assert whole[0] == pytest.approx(-start[0])
    np.testing.assert_allclose(half, start + 0.5 * (whole - start))
    by_depth = straight_crack(TOOTH, MOUTH, math.radians(angle), depth=0.5 * through)
    np.testing.assert_allclose(by_depth.corners[0], half)


def test_a_share_of_a_way_that_leads_to_no_other_side_is_refused_and_a_crack_of_no_length_is_none():
    start = fillet_point(TOOTH, MOUTH)
    with pytest.raises(InputError, match="a crack that runs to the other side of the tooth"):
        way_through(TOOTH, start, np.array([0.0, -1.0]))
    with pytest.raises(InputError, match="its depth instead"):
        straight_crack(TOOTH, MOUTH, 0.0, share=0.5)
    assert np.isfinite(straight_crack(TOOTH, MOUTH, 0.0, depth=0.5).corners[0]).all()
    np.testing.assert_allclose(straight_crack(TOOTH, MOUTH, math.radians(60.0)).corners[0], start)  # of no length


# ---- which stress counts ---------------------------------------------------------------------------------------------
class Curve:
    """A piece of a fillet: its largest stress of either sign below a place."""

    def __init__(self, sign):
        self.sign = sign

    def largest_below(self, stress, above, width):
        counted = np.where(np.arange(len(stress))[:, None] < above, self.sign * stress, -np.inf)
        return self.sign * counted.max(axis=0), counted.argmax(axis=0) + width


def influence(side):
    sign = 1.0 if side == "tension" else -1.0
    whole = np.array([[1.0, 9.0], [5.0, 2.0], [3.0, 3.0], [40.0, 30.0]])
    stress = sign * whole
    pieces = ((0.0, Curve(sign), slice(0, 2)), (10.0, Curve(sign), slice(2, 4)))
    return SimpleNamespace(
        tooth=lambda j: SimpleNamespace(fillet_loads=lambda radius, half: (None, np.array([1.0, 1.0]), 0.25)),
        fillet_stress=lambda i, j, of, radius, half: stress if of == side else None,
        kind=lambda i: SimpleNamespace(pieces=lambda of: pieces if of == side else None),
    )


def test_beside_a_contact_on_the_fillet_only_what_is_below_it_counts_and_elsewhere_all():
    own = OddInfluence.largest_root_stress(influence("tension"), 0, 0, "tension", [1.0, 2.0])
    # Below the first point of each piece: 1 and 3, 9 and 3.
    np.testing.assert_allclose(own[0], [3.0, 9.0])
    np.testing.assert_allclose(own[1], [10.25, 0.25])
    for tooth, side, sign in ((1, "tension", 1.0), (0, "compression", -1.0), (1, "compression", -1.0)):
        found = OddInfluence.largest_root_stress(influence(side), tooth, 0, side, [1.0, 2.0])
        np.testing.assert_allclose(found[0], [sign * 40.0, sign * 30.0])
        np.testing.assert_allclose(found[1], [11.25, 11.25])


def test_an_intensity_errs_by_another_ring_and_the_lower_order_and_is_not_known_without_it():
    usual, other, below = (np.array(one)[:, None] for one in ([3.0, -2.0], [3.5, -2.25], [2.0, -1.0]))
    rings = np.stack([usual, other])
    lower = SimpleNamespace(by_ring=lambda *given: np.stack([below, 99.0 * below]))
    found, error = OddInfluence.stress_intensity(
        SimpleNamespace(by_ring=lambda *given: rings, lower=lower), 2, 1, [1.0], 0.18
    )
    np.testing.assert_allclose(found, usual)
    np.testing.assert_allclose(error[:, 0], [0.5 + 1.0, 0.25 + 1.0])
    alone = OddInfluence.stress_intensity(SimpleNamespace(by_ring=lambda *given: rings, lower=None), 2, 1, [1.0], 0.18)
    np.testing.assert_allclose(alone[0], usual)
    assert alone[1].shape == usual.shape
    assert np.isnan(alone[1]).all()


def test_a_tooth_answers_for_itself_as_an_ordinary_one():
    tooth = SimpleNamespace(self_compliance=lambda *given: given)
    one = SimpleNamespace(tooth=lambda i: tooth if i == 4 else None, closing=())
    assert OddInfluence.own(one, 4, "radius", "patch", "width") == ("radius", "patch", "width")


def test_a_hole_has_the_room_to_the_nearest_place_of_an_outline_not_to_its_nearest_corner():
    """In a square of side 4, nearest to the middle of an edge or to none; beside it there is none."""
    corners = np.array([[-2.0, 2.0, 2.0, -2.0, -2.0], [-2.0, -2.0, 2.0, 2.0, -2.0]])
    chains = [SimpleNamespace(vertices=corners[:, :3]), SimpleNamespace(vertices=corners[:, 2:])]
    for centre, away in (((0.0, 0.0), 2.0), ((0.5, 0.0), 1.5), ((-0.3, 0.9), 1.1)):
        assert _room(chains, Hole(0.2, centre)) == pytest.approx(away - 0.2, rel=1e-12)
    with pytest.raises(InputError, match="across its outline"):
        _room(chains, Hole(0.2, (2.5, 0.0)))


@pytest.mark.parametrize("closing", [False, True])
def test_a_crack_seen_from_the_other_flank_is_mirrored_and_its_faces_press(closing):
    """What one load opens the other presses together; the mouth is as far up the other fillet."""
    crack = Crack(0.4, ((0.3, 8.0), (-0.1, 7.8)), True, closing)
    assert crack.mirrored() == Crack(0.4, ((-0.3, 8.0), (0.1, 7.8)), False, True)
    assert crack.mirrored().mirrored() == replace(crack, closing=True)


def test_a_stress_errs_by_no_less_than_a_usual_part_of_what_orders_differ_by_along_the_flank():
    """The root mean square of what they differ by at places of the flank, where they happen to agree."""

    def apart(_near, _other, _side, r, _width):
        return np.array([3.0, 4.0, 0.0]) if np.size(r) == 3 else np.array([0.1, 50.0])

    known = SimpleNamespace(
        _near=lambda *teeth: teeth, _on_flank=lambda _, r: np.asarray(r), _half_width=lambda width: width, _kept={},
        _samples=lambda _: np.zeros(3), _off_stress=apart, fine=SimpleNamespace(lower=1, odd=()),
        gear=SimpleNamespace(module=0.5), ordinary=SimpleNamespace(reach=-1),
    )  # fmt: skip
    found = odd_gear.OddGearInfluence.root_stress_error(known, 0, 0, "tension", np.zeros(2), None)
    least = odd_gear._USUAL * math.sqrt(25.0 / 3.0)
    assert found == pytest.approx(odd_gear._STRESS_SHARE / 0.5 * np.array([max(0.1, least), 50.0]))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_the_root_circle_of_a_missing_tooth_has_unit_tangents_along_it(way):
    ends = [7.0 * np.array([math.sin(a), math.cos(a)]) for a in (-0.3 * way, 0.2 * way)]
    chain = _arc(*ends, np.linspace(0.0, 1.0, 6))
    assert np.hypot(*chain.vertices) == pytest.approx(np.full(6, 7.0))
    assert np.hypot(*chain.tangents) == pytest.approx(np.ones(6))
    assert (chain.tangents * chain.vertices).sum(axis=0) == pytest.approx(np.zeros(6), abs=1e-12)
    steps = np.diff(chain.vertices)
    assert (steps * chain.tangents[:, :-1]).sum(axis=0) == pytest.approx(np.full(5, 7.0 * math.sin(0.1)))
