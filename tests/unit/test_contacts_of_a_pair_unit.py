"""Which tooth pairs touch where: places on the line of action, corners beyond its ends, pairs that lose contact."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.plane import meshing
from fegear.contact.plane.corner import corner_contact
from fegear.contact.plane.meshing import Meshing, refuse_gaps
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE = 3e-3


def pair(addendum=1.0, teeth=(20, 31)):
    gears = []
    for z in teeth:
        tooth = Tooth(z, BasicRack(addendum, 1.25, 0.25))
        steel = Material(206e9, 0.3, 7850.0)
        gears.append(Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, 0.02, steel, "strain"))
    return GearPair(*gears)


def places(one, count=400):
    return one.x_start + np.linspace(0.0, 1.0, count) * one.base_pitch


@pytest.mark.parametrize("corner", [False, True])
@pytest.mark.parametrize("addendum", [1.0, 1.25])
def test_pair_numbers_are_all_that_touch_within_a_base_pitch(addendum, corner):
    one = pair(addendum, (40, 60) if addendum > 1.0 else (20, 31))
    found = Meshing(one, corner)
    x = places(one)
    j = np.arange(-6, 7)
    gap = found.touching(x + j[:, None] * one.base_pitch).gap
    touch = (gap < np.inf).any(axis=1)
    inside = (gap[:, 1:-1] < np.inf).any(axis=1)  # not only at an end of the base pitch
    numbers = found.pair_numbers.tolist()
    assert set(j[inside]) <= set(numbers)
    assert set(numbers) <= set(j[touch])
    assert numbers == list(range(numbers[0], numbers[-1] + 1))


@pytest.mark.parametrize("corner", [False, True])
def test_a_contact_on_the_path_is_where_both_involutes_have_a_common_normal(corner):
    one = pair()
    contacts = Meshing(one, corner).contacts(x := places(one, 37))
    assert contacts.x == pytest.approx(x + contacts.number[:, None] * one.base_pitch)
    on = (contacts.x >= one.x_start) & (contacts.x <= one.x_end)
    assert contacts.present[on].all()
    assert (contacts.gap[on] == 0.0).all()
    at = contacts.x[on]
    # Radii of curvature r_b tan(alpha_w) and what the contact has moved from the pitch point.
    tan = np.tan(one.working_pressure_angle)
    rb1, rb2 = one.driver.base_radius, one.driven.base_radius
    rho1, rho2 = rb1 * tan + at, rb2 * tan - at
    assert contacts.radius_driver[on] == pytest.approx(np.hypot(rb1, rho1))
    assert contacts.radius_driven[on] == pytest.approx(np.hypot(rb2, rho2))
    assert contacts.roll_driver[on] == pytest.approx(rho1 / rb1)
    assert contacts.roll_driven[on] == pytest.approx(rho2 / rb2)
    assert contacts.relative_radius[on] == pytest.approx(rho1 * rho2 / (rho1 + rho2))
    if not corner:
        assert not contacts.present[~on].any()
        assert np.isinf(contacts.gap[~on]).all()
        assert (contacts.edge == -np.inf).all()
        return
    # The distance along the flank to the nearer of both tip corners: arcs of an involute are rho^2 / (2 r_b).
    tips = [(one.gear(who).involute_tip_radius ** 2 - rb**2, rb) for who, rb in (("driver", rb1), ("driven", rb2))]
    apart = [(tip - rho**2) / (2.0 * rb) for (tip, rb), rho in zip(tips, (rho1, rho2), strict=True)]
    assert contacts.edge[on] == pytest.approx(-np.minimum(*apart), abs=1e-12)


def test_beyond_the_path_a_corner_is_apart_by_more_the_farther_it_is():
    one = pair()
    found = Meshing(one, corner_contact=True)
    for tip_of, end, outward in (("driven", one.x_start, -1.0), ("driver", one.x_end, 1.0)):
        corner = corner_contact(one, tip_of)
        beyond = np.linspace(0.02, 0.98, 9) * min(corner.reach, one.base_pitch)
        at = found.touching(end + outward * beyond)
        apart, flank, slope = corner.locate(beyond)
        assert at.gap == pytest.approx(apart)
        assert (np.diff(at.gap) > 0.0).all()
        touched = at.driven_length if tip_of == "driver" else at.driver_length
        other = at.driver_length if tip_of == "driver" else at.driven_length
        assert touched == pytest.approx(flank)
        gear = one.gear(tip_of)
        tip = np.sqrt(gear.involute_tip_radius**2 - gear.base_radius**2)
        assert other == pytest.approx(tip)  # the tip itself
        relative = tip * flank / (tip + flank)
        assert at.relative_radius == pytest.approx(relative)
        assert at.edge == pytest.approx(slope * relative)
    # At the ends themselves pairs are on the path, a hair outside they are there with the least of gaps.
    ends = np.array([one.x_start, one.x_end])
    assert found.touching(ends).gap.tolist() == [0.0, 0.0]
    assert found.touching(ends + np.array([-1e-11, 1e-11]) * one.base_pitch).gap.tolist() == [0.0, 0.0]
    nearly = found.touching(ends + np.array([-1e-9, 1e-9]) * one.base_pitch).gap
    assert ((nearly > 0.0) & (nearly < 1e-15)).all()
    far = found.touching(np.array([one.x_start - 1.01 * one.base_pitch, one.x_end + 1.01 * one.base_pitch])).gap
    assert np.isinf(far).all()


def test_roll_positions_are_the_same_a_base_pitch_on():
    one = pair()
    found = Meshing(one)
    x = one.x_start + np.array([0.0, 0.3, 0.999]) * one.base_pitch
    for shift in (-2.0, 0.0, 1.0, 5.0):
        assert found.reduced(x + shift * one.base_pitch) == pytest.approx(x, abs=1e-12 * one.base_pitch)
    assert isinstance(found.reduced(0.0), np.ndarray)


def test_pairs_below_a_contact_ratio_of_one_run_by_their_corners_or_not_at_all(monkeypatch):
    one = pair(0.5)
    assert one.contact_ratio < 1.0
    for enough in (pair(), pair(0.6)):  # of 1.5 and of 1.03
        refuse_gaps(enough, "pair.I", corner_contact=False)
    refuse_gaps(one, "pair.I", corner_contact=True)
    with pytest.raises(
        InputError, match=r"pair\.I = contact ratio 0\.8758.*set effects\.corner_contact = true"
    ) as given:
        refuse_gaps(one, "pair.I", corner_contact=False)
    assert "base pitches only" not in str(given.value)
    with pytest.raises(InputError, match="contact ratio"):
        Meshing(one)
    Meshing(one, single=True)
    Meshing(one, corner_contact=True)
    # Corners that reach just far enough, and a little less.
    lacking = (1.0 - one.contact_ratio) * one.base_pitch
    for share, closed in ((1.0 + 1e-9, True), (0.5, False)):
        reach = SimpleNamespace(reach=0.5 * share * lacking)
        monkeypatch.setattr(meshing, "_corners", lambda _, reach=reach: (reach, reach))
        if closed:
            refuse_gaps(one, "pair.I", corner_contact=True)
            continue
        for corner in (True, False):
            with pytest.raises(InputError, match=r"extends it by 0\.06209 base pitches only") as given:
                refuse_gaps(one, "pair.I", corner_contact=corner)
            assert "corner_contact = true" not in str(given.value)
