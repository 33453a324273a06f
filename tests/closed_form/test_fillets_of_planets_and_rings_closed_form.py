"""Fillets of ring gears and planets: the path of the mating tip, laws of two meshes, designs that keep their word."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.design.fillet.fillet_bench import FilletBench, mating_corner
from fegear.design.fillet.fillet_limits import Limits
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair

M = 4e-3
SUN = Gear(Tooth(24), M, 22e-3, 40e-3)
PLANET = Gear(Tooth(17, profile_shift=0.3), M, 15e-3, 40e-3)
CUTTER = PinionCutter(25, profile_shift=0.1, addendum=1.25, tip_radius=0.2)
RING = Gear(InternalTooth(60, CUTTER, profile_shift=-0.3, tip_radius=29.5), M, 145e-3, 40e-3)
OUTER, INNER = GearPair(SUN, PLANET), GearPair(PLANET, RING)


def corner_of(pair, member):
    return mating_corner(SimpleNamespace(pair=pair), member)


def turned_about(pair, member):
    """The same path by turning both gears about their centres: angles of external mates from the centre distance."""
    mate, own = pair.gear("driven" if member == "driver" else "driver"), pair.gear(member)
    tip, base = mate.involute_tip_radius, mate.base_radius
    roll = math.sqrt(tip**2 - base**2) / base
    inv = math.tan(pair.working_pressure_angle) - pair.working_pressure_angle
    theta = np.linspace(-1.2, 1.2, 2001) * 2.0 * math.pi / mate.teeth
    angle = roll - math.atan(roll) - inv - theta
    x, y = tip * np.sin(angle), pair.centre_distance - tip * np.cos(angle)
    turn = theta * mate.teeth / own.teeth + own.symmetric_tooth.base_half_angle - inv
    x, y = np.cos(turn) * x + np.sin(turn) * y, np.cos(turn) * y - np.sin(turn) * x
    return np.hypot(x, y) / M, np.arctan2(x, y)


@pytest.mark.parametrize("member", ["driver", "driven"])
def test_path_of_an_external_mates_tip_is_that_of_turned_gears(member):
    height, polar = corner_of(OUTER, member)
    radius, angle = turned_about(OUTER, member)
    inside = (radius > height[0] + 0.1) & (radius < height[-2])  # the path turns at its deepest point
    nearest = np.interp(radius[inside], height, polar)
    assert (angle[inside] - nearest).min() == pytest.approx(0.0, abs=2e-6)
    deep = int(np.argmin(radius))
    assert height[0] == pytest.approx(radius[deep], abs=1e-6)


@pytest.mark.parametrize("member", ["driver", "driven"])
def test_path_of_the_tip_touches_the_flank_where_contact_ends_and_nowhere_cuts_into_it(member):
    """Planet and ring: on the involute above that point, beside the fillet below it."""
    height, polar = corner_of(INNER, member)
    other = "driven" if member == "driver" else "driver"
    own = INNER.gear(member)
    tooth = own.symmetric_tooth
    x = INNER.x_of_radius(INNER.gear(other).involute_tip_radius, other)
    active = tooth.side * float(INNER.radius(x, member)) / M
    assert np.interp(active, height, polar) == pytest.approx(float(tooth.half_thickness_angle(abs(active))), abs=1e-6)
    above = height[height > active]
    flank = np.array([float(tooth.half_thickness_angle(abs(one))) for one in above])
    assert (polar[height > active] - flank).min() > -1e-7
    assert height[0] > tooth.side * tooth.root_radius  # clearance to the root


@pytest.fixture(scope="module")
def meshes():
    settings = settings_at(-5.0)
    sun, planet, ring = (solve_gear(gear, settings, reach=2, estimate_error=False) for gear in (SUN, PLANET, RING))
    outer = load_plane(PairSpec(OUTER, (10e3,), corner_contact=True), (sun, planet), estimates=False)
    inner = load_plane(PairSpec(INNER, (10e3,), corner_contact=True), (planet, ring), estimates=False)
    return outer.engagement, inner.engagement


def test_laws_of_two_meshes(meshes):
    """The mesh itself as the other one changes nothing; both may be exchanged; the larger of both fillets counts."""
    outer, inner = meshes
    tooth, more = PLANET.symmetric_tooth, {"settings": settings_at(-5.0), "objective": "alternating"}

    def along(engagement, member, load, other=None, **changed):
        return FilletBench(engagement, load, member, other=other, **(more | changed)).along(tooth)

    def bench(engagement, member, load, **changed):
        return FilletBench(engagement, load, member, **(more | changed))

    alone = along(outer, "driven", 10e3)
    assert along(outer, "driven", 10e3, bench(outer, "driven", 10e3)) == pytest.approx(alone, rel=1e-12)
    one = along(outer, "driven", 10e3, bench(inner, "driver", 20e3))
    assert one == pytest.approx(along(inner, "driver", 20e3, bench(outer, "driven", 10e3)), rel=1e-12)
    assert one.max() > 1.2 * alone.max()
    assert one.max() < 1.02 * max(alone.max(), along(inner, "driver", 20e3).max())
    tension = {"objective": "tension"}
    pulled = along(outer, "driven", 10e3, **tension)
    assert along(outer, "driven", 10e3, bench(inner, "driver", 1.0, **tension), **tension) == pytest.approx(pulled)
    # Each fillet is pulled by the mesh of its flank and pressed by the other one: the larger counts at each place.
    its = along(inner, "driver", 20e3, **tension)
    both = bench(outer, "driven", 10e3, other=bench(inner, "driver", 20e3, **tension), **tension)
    assert both.along(tooth) == pytest.approx(np.maximum(pulled, its), rel=1e-12)
    assert both.largest(tooth) == pytest.approx(max(pulled.max(), its.max()), rel=1e-12)
    pressed, squeezed = pulled - 2.0 * alone, its - 2.0 * along(inner, "driver", 20e3)
    assert one == pytest.approx(0.5 * np.maximum(pulled - squeezed, its - pressed), rel=1e-9)
    # A tooth is coupled as far as in that of both meshes in which it is coupled farther.
    assert both.reach == 2
    assert bench(outer, "driven", 10e3).reach == 2
    for first, second in ((1, 3), (3, 1), (0, 0)):
        far = [
            SimpleNamespace(other=None, engagement=SimpleNamespace(compliance=SimpleNamespace(
                source={"driven": SimpleNamespace(reach=reach)}.__getitem__)), member="driven")
            for reach in (first, second)
        ]  # fmt: skip
        far[1].reach = FilletBench.reach.fget(far[1])
        far[0].other = far[1]
        assert FilletBench.reach.fget(far[0]) == max(first, second, 1)


def test_room_is_the_least_of_both_meshes(meshes):
    outer, inner = meshes
    tooth, limits = PLANET.symmetric_tooth, Limits(0.0, 1e-6)
    one, other = FilletBench(outer, 1.0, "driven", limits), FilletBench(inner, 1.0, "driver", limits)
    both = FilletBench(outer, 1.0, "driven", limits, other=other)
    assert both.room(tooth) == pytest.approx(np.minimum(one.room(tooth), other.room(tooth)), abs=1e-12)
    assert abs(both.active_roll) == min(abs(one.active_roll), abs(other.active_roll))


def gears():
    common = {"face_width": "40 mm"}
    sun = fegear.Gear(24, "4 mm", bore_radius="22 mm", name="sun", **common)
    planet = fegear.Gear(17, "4 mm", bore_radius="15 mm", profile_shift=0.3, name="planet", **common)
    cutter = {"teeth": 25, "profile_shift": 0.1, "addendum": 1.25, "tip_radius": 0.2}
    ring = fegear.Gear(60, "4 mm", internal=True, profile_shift=-0.3, cutter=cutter, tip_diameter="236 mm",
                       rim_thickness="16 mm", name="ring", **common)  # fmt: skip
    return fegear.Pair(sun, planet, name="S"), fegear.Pair(planet, ring, name="R", load="10 kN")


@pytest.mark.dear
def test_the_fillet_of_a_ring_gear_keeps_its_word():
    """The stress of the pair with the designed points is what the design states; it is below the present one."""
    _, pair = gears()
    design = fegear.fillet_design(pair, "ring", searches=1, waves=1, tolerance=0.1)
    values = {value.name.split(".")[-1]: value for value in design.values}
    assert values["gain"].value > 0.1
    assert any("pinion-type cutter" in one for one in design.remarks)
    x, y = (design.tables["designed_fillet_R_ring"].column(name).si.tolist() for name in ("x", "y"))
    shaped = pair.driven.changed(fillet={"kind": "points", "x": x, "y": y})
    again = fegear.root_stress(fegear.Pair(pair.driver, shaped, name="R"), load="10 kN", tolerance=0.1)
    found = next(value for value in again.values if value.name == "R.driven.largest_root_tension")
    assert found.value == pytest.approx(values["root_stress_optimum"].value, rel=0.02)


def test_what_fits_no_design_is_refused():
    outer, inner = gears()
    for words, asked in (
        (r"fillet_design\.other_pair = .R.: must be another pair of gear sun", lambda: fegear.fillet_design(
            outer, "sun", load="1 kN", other=inner)),
        (r"fillet_design\.generated = true: requires a gear cut by a rack", lambda: fegear.fillet_design(
            inner, "ring", generated=True)),
        (r"has the name of the pair itself", lambda: fegear.fillet_design(inner, other=inner)),
        (r"must be a fegear\.Pair", lambda: fegear.fillet_design(3)),
        (r"is another gear of the same name", lambda: fegear.fillet_design(
            outer, "planet", load="1 kN", other=fegear.Pair(
                inner.driver.changed(profile_shift=0.2), inner.driven, name="R", load="1 kN"))),
    ):  # fmt: skip
        with pytest.raises(InputError, match=words):
            asked()
