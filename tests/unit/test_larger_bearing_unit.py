"""The bearing to change to where one does not last: it fits its seat, carries the axial force, and lasts."""

import math

import pytest

from fegear.shafts.axial_factors import AxialFactors
from fegear.shafts.bearing_seat import BearingSeat, Obstacle
from fegear.shafts.designations import KNOWN, designation_of, envelope_of
from fegear.shafts.larger_bearing import larger_bearing, rating_of

#: A long seat of a shaft with a high shoulder, and one without.
FREE, PLAIN = BearingSeat(shoulder=1.0), BearingSeat()


@pytest.mark.parametrize("name", ["6206", "6006-2RS", "NU206", "NJ 2208 ECP", "30206", "6310"])
@pytest.mark.parametrize("times", [1.3, 2.0, 8.0])
@pytest.mark.parametrize("most", [0.075, 0.12, 0.2])
def test_what_fits_lasts_and_none_that_fits_and_lasts_is_smaller(name, times, most):
    radial, axial = 3000.0, 0.0 if name.startswith("N") else 900.0
    present = envelope_of(name)
    own = max((key for key in KNOWN if name.replace(" ", "").startswith(key)), key=len)
    wanted = times * rating_of(own).revolutions(radial, axial)
    seat = BearingSeat(0.1, 0.05, 1.3 * present.bore, (Obstacle(0.0, 1.0, 0.5 * most),))
    change = larger_bearing(name, radial, axial, wanted, seat)
    letters = own.rstrip("0123456789")
    like = {
        key: one for key, one in KNOWN.items()
        if one.kind == present.kind and key.rstrip("0123456789") == letters
        and (one.kind != "ball" or not one.contact_angle) and 1.05 * one.outside_diameter <= most
        and rating_of(key).revolutions(radial, axial) >= wanted
        and (one.bore == present.bore or present.bore < one.bore <= seat.shoulder / 1.15)
    }  # fmt: skip
    of_bore = [key for key, one in like.items() if one.bore == present.bore]
    found = change.fitting
    if of_bore:  # the same kind on the same seat comes before all others, with the smallest outside diameter
        assert found.designation == min(of_bore, key=lambda key: (KNOWN[key].outside_diameter, KNOWN[key].width, key))
    if found is not None:
        assert found.revolutions >= wanted
        assert 1.05 * found.outside_diameter <= most
        assert found.same_bore is (found.bore == present.bore)
        assert found.same_bore or 1.15 * found.bore <= seat.shoulder
        assert not change.longest
        assert not change.thicker
    else:
        assert not like
        assert change.longest is None or change.longest.revolutions < wanted
        assert change.thicker is None or 1.15 * change.thicker.bore > seat.shoulder


def test_a_locating_ball_bearing_becomes_another_one_then_one_with_ribs_then_two_tapered_ones():
    # Ø 35 shaft with a shoulder of 42 mm: neither a bore of 40 mm nor one of 75 mm has a shoulder there
    seat = BearingSeat(0.205, 0.03, 0.042, (Obstacle(0.19, 0.22, 0.05),))
    lives = {name: rating_of(name).revolutions(4000.0, 1500.0) for name in ("6307", "NUP207", "NUP2307")}
    first = larger_bearing("6307", 4000.0, 1500.0, 1.2 * lives["6307"], seat).fitting
    assert (first.designation, first.count) == ("NUP207" if lives["NUP207"] >= 1.2 * lives["6307"] else "NUP2207", 1)
    ribbed = rating_of("NUP2307").revolutions(4000.0, 800.0)
    second = larger_bearing("6307", 4000.0, 800.0, 1.01 * ribbed, seat).fitting
    assert second.count == 2
    assert second.said.startswith("two 3")
    assert second.width == 2.0 * KNOWN[second.designation].width
    # above 0.4 of the radial force ribs are not loaded
    third = larger_bearing("6307", 4000.0, 1700.0, 1.2 * rating_of("6307").revolutions(4000.0, 1700.0), seat)
    assert third.fitting.designation.startswith("3")
    none = larger_bearing("6307", 4000.0, 1500.0, 1e15, seat)
    assert none.fitting is None
    assert none.longest.same_bore
    assert none.longest.revolutions > lives["6307"]


def test_a_larger_bore_needs_a_shoulder_and_a_thicker_shaft_is_named_where_it_would_do():
    wanted = 1.5 * max(
        larger_bearing("NU207", 9000.0, 0.0, 1e15, PLAIN).longest.revolutions,
        rating_of("NU2307").revolutions(9000.0, 0.0),
    )
    change = larger_bearing("NU207", 9000.0, 0.0, wanted, BearingSeat(shoulder=0.042))
    assert change.fitting is None
    assert change.longest.designation == "NU2307"
    assert change.thicker.bore > 0.035
    with_shoulder = larger_bearing("NU207", 9000.0, 0.0, wanted, BearingSeat(shoulder=1.15 * change.thicker.bore))
    assert with_shoulder.fitting.designation == change.thicker.designation
    assert not with_shoulder.fitting.same_bore


def test_two_tapered_bearings_by_hand():
    # C 2^(7/9) times that of one, P = F_r + 0.45 cot(alpha) F_a or 0.67 F_r + 0.67 cot(alpha) F_a
    slope = math.tan(KNOWN["32307"].contact_angle)
    tight = BearingSeat(obstacles=(Obstacle(-1.0, 1.0, 0.043),))  # 80 mm have room, 90 mm have not
    for axial, longest in ((0.3 * slope * 9000.0, "32307"), (4.0 * slope * 9000.0, "31307")):
        tan = math.tan(KNOWN[longest].contact_angle)
        load = 9000.0 + 0.45 / tan * axial if axial < 1.5 * tan * 9000.0 else 0.67 * 9000.0 + 0.67 / tan * axial
        life = 1e6 * (2.0 ** (7.0 / 9.0) * rating_of(longest).dynamic_rating / load) ** (10.0 / 3.0)
        found = larger_bearing("6307", 9000.0, axial, 1e15, tight).longest
        assert (found.designation, found.revolutions) == (longest, pytest.approx(life))


def test_by_hand():
    # 6206 with P = 3 kN: C = 3 kN (L/10^6)^(1/3); 6306 is the next of bore 30 mm
    enough = rating_of("6306").revolutions(3000.0, 0.0)
    assert larger_bearing("6206-2Z/C3", 3000.0, 0.0, 0.999 * enough, FREE).fitting.designation == "6306"
    assert larger_bearing("6206", 3e6, 0.0, 1e9, FREE).fitting is None
    assert larger_bearing("1206", 3e3, 0.0, 1e6, FREE) is None  # a series that is not tabulated
    # of angular contact ball bearings the same kind only, of 40 degrees only
    wanted = 1.1 * rating_of("7206").revolutions(3e3, 2e3)
    assert larger_bearing("7206-B", 3e3, 2e3, wanted, FREE).fitting.designation == "7306"
    assert larger_bearing("7206 C", 3e3, 2e3, wanted, FREE) is None
    wanted = 1.1 * rating_of("22208").revolutions(3e4, 5e3)
    assert larger_bearing("22208 E", 3e4, 5e3, wanted, FREE).fitting.designation == "22308"
    # NU stays NU, in the same bore of the housing where that suffices
    wanted = 1.1 * rating_of("NU206").revolutions(3e3, 0.0)
    assert larger_bearing("NU206", 3e3, 0.0, wanted, FREE).fitting.designation == "NU2206"


def test_room_is_that_beside_neighbours_along_the_shaft():
    seat = BearingSeat(0.1, 0.03, 0.042, (Obstacle(0.115, 0.14, 0.0), Obstacle(0.0, 0.3, 0.06)))
    assert seat.has_room(0.08, 0.03)
    assert not seat.has_room(0.08, 0.031)  # into the gear beside it
    assert not seat.has_room(0.115, 0.02)  # 57.5 mm and a wall of 5 %: beyond 60 mm
    assert seat.has_room(0.114, 0.02)
    far = BearingSeat(0.1, obstacles=(Obstacle(0.2, 0.3, 0.01),))
    assert far.has_room(0.5, 0.19)


def test_ribs_have_the_factors_of_catalogues():
    assert rating_of("NUP207").axial == AxialFactors(False, 0.0, rating_of("NUP207").axial.area, (0.6, 0.2))
    assert rating_of("NUP2307").axial.at(1000.0) == (0.92, 0.4, 0.3)
    assert rating_of("NUP207").equivalent_load(1000.0, 190.0) == 1000.0
    assert rating_of("NUP207").equivalent_load(1000.0, 300.0) == pytest.approx(920.0 + 0.6 * 300.0)
    assert not rating_of("NUP207").overlooks(1000.0, 300.0)
    assert rating_of("NU207").overlooks(1000.0, 300.0)


def test_an_envelope_has_the_designation_that_has_it():
    one = KNOWN["6305"]
    assert designation_of("ball", one.bore, one.outside_diameter, one.width) == "6305"
    assert designation_of("ball", one.bore, one.outside_diameter, 1.01 * one.width) == ""
    roller = KNOWN["NU204"]  # N, NJ and NUP share its envelope and its rating
    assert designation_of("cylindrical", roller.bore, roller.outside_diameter, roller.width).endswith("204")
