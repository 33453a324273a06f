"""A rack with its width: plane racks and gears of many teeth as its limits, hands, reciprocity, its loads."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fegear.contact.rack.rack_in_mesh import RackInMesh
from fegear.contact.rack.wide_stroke import WideRackFlanks, wide_over_stroke
from fegear.fem.plane.rack.solved_rack import solve_rack_teeth
from fegear.fem.solid.bands import bands
from fegear.fem.solid.rack.rack_flank import SolidRackSpec
from fegear.fem.solid.rack.solid_rack import solve_solid_rack
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_and_pinion import OTHER_HAND, RackAndPinion, distance_of_backlash
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.toothed_rack import Rack

NU, BODY, WIDTH = 0.3, 2.0, 3.0
PLACES = (-1.0, 0.0, 1.0)


@cache
def rack_of(helix=0.0, hand=-1.0, teeth=9, **more):
    """A solved rack; a helix angle in degrees, -1 for a right hand."""
    beta = math.radians(helix)
    tooth = RackTooth(BasicRack(), helix_angle=beta)
    return solve_solid_rack(SolidRackSpec(tooth, hand * math.tan(beta), WIDTH, BODY, teeth, NU, **more))


def pressed(solution, place, width=0.25):
    """Bands along the contact line at three places of the face."""
    return bands(place, PLACES, 0.5, width, slope=solution.line_slope([place])[0])


def numbers(solution, place):
    """Deflections of own and next teeth and root stress under bands at a height or radius."""
    band = pressed(solution, place)
    own = [np.diag(solution.deflection(k, band, band)) for k in (0, 1, -1)]
    stress = [solution.largest_root_stress(0, side, band, PLACES)[0].ravel() for side in ("tension", "compression")]
    return np.concatenate(own), np.concatenate(stress)


@pytest.mark.dear
def test_without_motion_along_the_axis_a_spur_rack_is_the_plane_one():
    found = rack_of(plane_strain=True, teeth=5, held=(False, True, False, False, True), pin_width=1.0)
    plane, _, _ = solve_rack_teeth(
        found.tooth, BODY, 5, NU, "strain", found.settings.section, held=found.spec.held, pin_width=1.0
    )
    for j in (0, 2):
        here, there = found.loaded(j), plane.loaded(j)
        line = bands(0.3, 0.0, 0.5 * WIDTH, 0.25, slope=0.0, profile="even")
        load = there.flank.patches(there.flank.arc_of_radius(np.array([0.3])), np.array([0.25]))[:, 0]
        for k in (-1, 0, 1):
            if not found.exists(j + k):
                continue
            wide, narrow = float(here.deflection(k, line, line)[0, 0]), float(load @ there.compliance[k] @ load)
            assert wide * WIDTH == pytest.approx(narrow, rel=1e-6)


@pytest.mark.dear
def test_it_is_the_limit_of_gears_with_many_teeth():
    """Extrapolated over 250, 500 and 1000 teeth: deflections 1e-3, root stress as both coarse meshes have it.

    Root stresses differ by 0.8 %, on meshes three quarters as coarse by 0.26 % with the other sign.
    """
    deflection, stress = numbers(rack_of(20.0, teeth=15).usual, 0.2)
    beta, counts = math.radians(20.0), (250, 500, 1000)
    found = []
    for teeth in counts:
        gear = Tooth(teeth, BasicRack(), helix_angle=beta)
        twist = math.tan(beta) / gear.pitch_radius
        solved = solve_solid(gear, twist, WIDTH, NU, gear.root_radius - BODY)
        found.append(np.concatenate(numbers(solved, gear.pitch_radius + 0.2)))
    limit = np.linalg.solve(np.vander(1.0 / np.array(counts), increasing=True), np.array(found))[0]
    assert limit[: deflection.size] == pytest.approx(deflection, rel=1e-3)
    assert limit[deflection.size :] == pytest.approx(stress, abs=1.2e-2 * np.abs(stress).max())


@pytest.mark.dear
def test_exchanged_hands_mirror_each_other_at_the_middle_of_the_face():
    right, left = (numbers(rack_of(20.0, hand, teeth=15).usual, 0.2) for hand in (-1.0, 1.0))
    assert left[0].reshape(3, 3)[:, ::-1] == pytest.approx(right[0].reshape(3, 3), rel=1e-9)
    one, other = (found[1].reshape(2, 3, 3) for found in (right, left))
    assert other[:, ::-1, ::-1] == pytest.approx(one, rel=1e-9)


@pytest.mark.dear
def test_without_a_helix_it_is_spur():
    """Whose motions are solved apart; the smaller the helix angle, the nearer."""
    spur = numbers(rack_of().usual, 0.2)[0]
    apart = [np.abs(numbers(rack_of(helix).usual, 0.2)[0] / spur - 1.0).max() for helix in (1.0, 0.5)]
    assert apart[1] < 1e-2
    assert apart[1] < 0.6 * apart[0]


@pytest.mark.dear
def test_maxwell_and_the_ends():
    rack = rack_of(20.0, teeth=15)
    size = np.abs(rack.coupling(2, 2)).max()
    for i, j in ((0, 0), (0, 1), (2, 3)):
        assert np.abs(rack.coupling(i, j) - rack.coupling(j, i).T).max() < 1e-6 * size  # like teeth are merged at 1e-5
    assert not rack.loaded(0).compliance[-1].any()
    first, middle = (numbers(rack.loaded(j), 0.2)[0][:3] for j in (0, 2))
    assert (first > 1.05 * middle).all()
    assert rack.differ(0, 0)
    assert not rack.differ(rack.middle, rack.middle)


@pytest.mark.dear
def test_teeth_between_pins_are_softer_and_far_teeth_alike():
    pinned = rack_of(teeth=12, held=tuple(i % 6 == 2 for i in range(12)), pin_width=2.0)
    on, between = (numbers(pinned.loaded(j), 0.2)[0][:3] for j in (2, 5))
    assert (between > 1.1 * on).all()
    held = rack_of(teeth=12)
    assert held.alike[5] == held.alike[6]
    assert held.same_as(5, 1) == held.alike[5]


def _meshing(helix, teeth, hand="right"):
    beta, m, width = math.radians(helix), 2e-3, 5e-3
    hand = hand if helix else "spur"
    pinion = Gear(Tooth(20, BasicRack(), profile_shift=0.3, helix_angle=beta), m, 10e-3, width, hand=hand)
    tooth = RackTooth(BasicRack(), helix_angle=beta)
    rack = Rack(tooth, m, teeth, 6e-3, width, hand=OTHER_HAND[hand])
    return RackAndPinion(pinion, rack, distance_of_backlash(pinion, rack, 40e-6))


def _ready(pair, positions=8):
    """On coarse elements."""
    pinion, rack = pair.pinion, pair.rack
    m = pinion.module
    settings = SolidSettings().scaled(2.0)
    solved = solve_solid(pinion.tooth, pinion.twist * m, WIDTH, NU, pinion.bore_radius / m, settings)
    spec = SolidRackSpec(rack.tooth, rack.slide, WIDTH, rack.body / m, rack.teeth, NU, settings)
    return WideRackFlanks(RackInMesh(pair), solved, solve_solid_rack(spec), positions=positions)


@pytest.mark.dear
def test_a_helical_rack_over_its_stroke():
    """Forces add up to the load, and teeth at the ends deflect more."""
    pair = _meshing(20.0, 3)
    found = wide_over_stroke(_ready(pair), 500.0)
    cos = math.cos(pair.rack.pressure_angle)
    assert found.middle.contact.force.sum(axis=1)[:, 0] == pytest.approx(np.full(found.travel.size, 500.0 / cos))
    there = ~np.isnan(found.stroke.error)
    assert np.nanmax(found.stroke.travel) <= pair.stroke * (1.0 + 1e-6)
    assert np.nanmax(found.stroke.error[0]) > 1.5 * np.nanmean(found.stroke.error[found.stroke.middle])
    assert (found.stroke.pairs[there] >= 1).all()
    assert np.nanmin(found.stroke.travel) == pytest.approx(0.0, abs=1e-6 * pair.rack.pitch)
    assert np.nanmax(found.stroke.travel) == pytest.approx(pair.stroke, rel=1e-6)


@pytest.mark.dear
def test_numbers_of_a_stroke_hardly_depend_on_its_positions():
    """What more positions change is within what is stated; extremes at the ends of the stroke are there with few."""
    ready = _ready(_meshing(20.0, 3))
    few, many = (wide_over_stroke(replace(ready, positions=n), 500.0).stroke for n in (8, 48))
    assert np.nanmax(few.error) == pytest.approx(np.nanmax(many.error), rel=1e-6)
    assert few.peak_to_peak_in_middle == pytest.approx(many.peak_to_peak_in_middle, rel=2e-3)
    assert abs(few.mean_in_middle - many.mean_in_middle) < few.beyond.mean + many.beyond.mean
    left = few.beyond.middle + many.beyond.middle
    assert abs(few.rack_tension[1] - many.rack_tension[1]) < left < 6e-3 * many.rack_tension[1]
