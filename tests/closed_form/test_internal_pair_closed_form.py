"""A planet and its ring gear: path, gaps off it, load sharing, compared with turned outlines and enumeration."""

from __future__ import annotations

import math
from functools import cache
from itertools import combinations

import numpy as np
import pytest
from matplotlib.path import Path as Polygon
from scipy.optimize import brentq

from fegear.base.errors import FegearError, GeometryError
from fegear.contact.plane.corner import corner_contact
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.loading import LoadingFunction
from fegear.design.minimum_excitation import minimum_excitation
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.outline import tooth_outline
from fegear.geometry.pair import GearPair
from fegear.geometry.path_of_contact import active_profile, specific_sliding

MODULE = 4e-3


def internal_pair(planet: Tooth, ring: InternalTooth, distance: float = math.nan, module: float = MODULE) -> GearPair:
    """The planet drives."""
    one = Gear(planet, module, 0.5 * planet.root_radius * module, 20e-3)
    other = Gear(ring, module, (ring.root_radius + 4.0) * module, 20e-3)
    return GearPair(one, other, distance)


@cache
def the_pair() -> GearPair:
    ring = InternalTooth(60, PinionCutter(25, 0.1), profile_shift=-0.3, tip_radius=29.5, thickness_allowance=0.02)
    return internal_pair(Tooth(23, profile_shift=0.3), ring)


def random_pairs(count: int = 30) -> list[GearPair]:
    rng, found = np.random.default_rng(28), []
    while len(found) < count:
        z1, x1, x3 = int(rng.integers(14, 40)), rng.uniform(-0.1, 0.6), rng.uniform(-0.6, 0.3)
        z3 = z1 + int(rng.integers(20, 80))
        rounding = float(rng.choice([0.0, 0.08]))
        try:
            ring = InternalTooth(
                z3, PinionCutter(max(15, z3 // 2), rng.uniform(-0.1, 0.3)), profile_shift=x3, thickness_allowance=0.03,
                tip_rounding=rounding, tip_radius=0.5 * z3 - x3 - rng.uniform(0.5, 0.9),
            )  # fmt: skip
            pair = internal_pair(Tooth(z1, profile_shift=x1, tip_rounding=rounding), ring)
        except FegearError:
            continue
        # the involutes touch, and no tip reaches the fillet of its mate
        if all(corner_contact(pair, member).exists for member in ("driver", "driven")) and pair.contact_ratio > 1.0:
            found.append(pair)
    return found


def turned(points: np.ndarray, clockwise: float) -> np.ndarray:
    c, s = math.cos(clockwise), math.sin(clockwise)
    return np.stack([c * points[0] + s * points[1], c * points[1] - s * points[0]])


def standing(pair: GearPair, member: str, points: np.ndarray, rolled: float, tooth: int = 0) -> np.ndarray:
    """Points of a tooth (frame: along +y, loaded flank at x > 0) [m] after its gear has rolled from the pitch point.

    Planet at the origin, pitch point above it; the ring's centre lies below. Its loaded flank faces the other way.
    """
    gear = pair.gear(member)
    alpha = math.acos((pair.driven.base_radius - pair.driver.base_radius) / pair.centre_distance)
    roll = gear.tooth.side * math.tan(alpha)
    half = gear.tooth.base_half_angle - (roll - math.atan(roll))
    mirrored = 1.0 if member == "driver" else -1.0
    x, y = turned(points, mirrored * rolled / gear.base_radius - half + tooth * 2.0 * math.pi / gear.teeth)
    return np.stack([mirrored * x, y - (0.0 if member == "driver" else pair.centre_distance)])


def test_published_set_of_18_36_and_93_teeth():
    """m 21, x .5039 and .1171, a 584, cutter 30: printed angle 15.630 deg, contact ratio 1.618 with d_a2 = 815.66."""
    pair = internal_pair(
        Tooth(36, profile_shift=0.5039, tip_radius=815.66 / 42),
        InternalTooth(93, PinionCutter(30), profile_shift=0.1171), 0.584, 21e-3,
    )  # fmt: skip
    assert math.degrees(pair.working_pressure_angle) == pytest.approx(15.630, abs=1e-3)
    assert pair.contact_ratio == pytest.approx(1.618, abs=5e-4)
    assert pair.contact_ratio == pytest.approx(1.6176, abs=5e-5)
    assert pair.x_start > 0.0  # the path begins beyond the pitch point
    gap = corner_contact(pair, "driven").locate(np.array([0.05, 0.1, 0.2]) * pair.base_pitch)[0]
    assert gap == pytest.approx([2.35e-6, 9.56e-6, 39.6e-6], rel=5e-3)


@pytest.mark.dear
def test_flanks_roll_on_each_other_without_cutting_and_with_the_stated_backlash():
    """Polygons of three teeth of each gear, over a base pitch: none inside the other, apart by the backlash behind."""
    pair = the_pair()
    rows = {m: tooth_outline(pair.gear(m).tooth, 1e-6) * pair.gear(m).module for m in ("driver", "driven")}
    for share in (0.02, 0.4, 0.8):
        x = pair.x_start + share * pair.base_pitch
        for shift, free in ((-5e-8, True), (1e-6, False)):  # 50 nm for the chords; a push of 1 um cuts in
            planet = [standing(pair, "driver", rows["driver"], x + shift, k) for k in (-1, 0, 1)]
            inside = 0
            for k in (-1, 0, 1):
                ring = Polygon(standing(pair, "driven", rows["driven"], x, -k).T)
                inside += sum(int(ring.contains_points(one.T).sum()) for one in planet)
            assert (inside == 0) is free, (share, shift)
        back = -0.999 * pair.normal_backlash
        planet = [standing(pair, "driver", rows["driver"], x + back, k) for k in (-1, 0, 1)]
        rings = [Polygon(standing(pair, "driven", rows["driven"], x, -k).T) for k in (-2, -1, 0, 1, 2)]
        assert not any(ring.contains_points(one.T).any() for ring in rings for one in planet)
        planet = [standing(pair, "driver", rows["driver"], x + back * 1.03, k) for k in (-1, 0, 1)]
        assert any(ring.contains_points(one.T).any() for ring in rings for one in planet)


@pytest.mark.parametrize("reverse", [False, True], ids=["planet drives", "ring drives"])
def test_gap_of_a_tip_corner_equals_turning_the_gears_until_they_touch(reverse):
    """By a root finder on the corner's place and the flank's own polar angle, at random places beyond the path."""
    rng = np.random.default_rng(3)
    for pair in random_pairs():
        seen = pair.reversed() if reverse else pair
        for member in ("driver", "driven"):  # whose tip: the driver's leaves, the driven one's arrives
            tip_of = {"driver": "driven", "driven": "driver"}[member] if reverse else member
            corner = corner_contact(seen, tip_of)
            u = float(rng.uniform(0.02, 0.6)) * min(corner.reach, pair.base_pitch)
            gap, length, tilt = corner.locate(u)
            assert tilt > 0.0
            tip, flank = pair.gear(member), pair.gear("driven" if member == "driver" else "driver")
            end, out = (pair.x_end, 1.0) if member == "driver" else (pair.x_start, -1.0)
            arc = tip.tooth.tip_edge
            place = np.array(tip.tooth.involute.points(tip.tooth.involute.end)) if arc is None else np.array(arc.centre)
            involute, rounding = flank.tooth.involute, tip.tooth.tip_rounding * tip.module

            def beyond(extra, pair=pair, member=member, u=u, end=end, out=out, place=place):
                """The corner, or its rounding's centre, in the frame of the flank's tooth [m]."""
                tip, flank = pair.gear(member), pair.gear("driven" if member == "driver" else "driver")
                x = standing(pair, member, place[:, None] * tip.module, end + out * (u + 0.5 * extra))
                other = "driven" if member == "driver" else "driver"
                rolled = end + out * (u - 0.5 * extra)
                # two points of the flank's tooth give its frame
                basis = standing(pair, other, np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), rolled)
                axes = basis[:, 1:] - basis[:, :1]
                return np.linalg.solve(axes, x - basis[:, :1]).ravel(), flank

            def apart(extra, involute=involute, rounding=rounding, beyond=beyond):
                at, flank = beyond(extra)
                radius = math.hypot(*at)
                rb, side = flank.base_radius, flank.tooth.side
                roll = side * math.sqrt(radius**2 - rb**2) / rb
                half = flank.tooth.base_half_angle - (roll - math.atan(roll))
                return rb * (math.atan2(at[0], at[1]) - half) - rounding

            found = brentq(apart, 0.2 * gap, 4.0 * gap + 1e-9, xtol=1e-18, rtol=1e-14)
            assert found == pytest.approx(float(gap), rel=1e-6, abs=1e-13)
            at, _ = beyond(found)
            rb = flank.base_radius
            rolled = flank.tooth.side * math.sqrt(math.hypot(*at) ** 2 - rb**2) - rounding
            assert rolled == pytest.approx(float(length), rel=1e-7)


def test_specific_sliding_is_that_of_both_surface_velocities():
    pair = the_pair()
    x = np.linspace(pair.x_start, pair.x_end, 5)
    w1, w3 = 1.0, pair.driver.teeth / pair.driven.teeth
    xi = pair.driver.base_radius * math.tan(pair.working_pressure_angle) + x
    v1, v3 = w1 * xi, w3 * (xi + pair.centre_distance * math.sin(pair.working_pressure_angle))
    assert specific_sliding(pair, x, "driver") == pytest.approx(1.0 - v3 / v1)
    assert specific_sliding(pair, x, "driven") == pytest.approx(1.0 - v1 / v3)
    assert v1 - v3 == pytest.approx((w1 - w3) * x)
    assert active_profile(pair, "driven").end == pytest.approx(pair.driven.tip_radius)


@pytest.mark.parametrize(
    ("distance", "words"),
    [
        (75.0e-3, "both flanks are in contact at 74.1093 mm; reduce"),
        (69.5e-3, "is below the difference of the base radii"),
    ],
)
def test_distances_at_which_planet_and_ring_do_not_mesh(distance, words):
    pair = the_pair()
    with pytest.raises(GeometryError, match=words):
        GearPair(pair.driver, pair.driven, distance)


def test_two_ring_gears_make_no_pair():
    ring = the_pair().driven
    with pytest.raises(GeometryError, match="not possible: an internal gear must mesh with an external gear"):
        GearPair(ring, ring)


@pytest.mark.parametrize("teeth", [60, 61, 90])
@pytest.mark.parametrize("reverse", [False, True])
def test_a_gear_as_large_as_its_ring_gear_makes_no_pair(teeth, reverse):
    """Equal numbers divided by zero, larger ones were drawn."""
    ring, gear = the_pair().driven, Gear(Tooth(teeth), MODULE, 60e-3, 20e-3)
    with pytest.raises(GeometryError, match=f"teeth = {teeth}: must be below the 60 of the ring gear"):
        GearPair(*((ring, gear) if reverse else (gear, ring)))


@cache
def solved() -> tuple:
    pair = the_pair()
    return tuple(
        solve_gear(gear, settings_at(-2), reach=2, estimate_error=False) for gear in (pair.driver, pair.driven)
    )


def by_enumeration(pair: GearPair, x: float, load: float) -> tuple[dict[int, float], float]:
    """Loads by pair number and the approach, from the gears' influence functions by the equations of internal pairs.

    xi runs from the planet's base point: rho1 = xi, rho3 = xi + a sin(aw), 1/rho = 1/rho1 - 1/rho3. The pair i beside a
    loaded pair j takes c_(i-j) of the planet and c_-(i-j) of the ring; each contact has Hertz's width of its own load.
    """
    planet, ring = solved()
    aw = math.acos((pair.driven.base_radius - pair.driver.base_radius) / pair.centre_distance)
    first = pair.driver.base_radius * math.tan(aw)
    ends = [
        math.sqrt(pair.driven.tip_radius**2 - pair.driven.base_radius**2) - pair.centre_distance * math.sin(aw),
        math.sqrt(pair.driver.tip_radius**2 - pair.driver.base_radius**2),
    ]
    places = {j: xi for j in range(-3, 4) if ends[0] <= (xi := first + x + j * pair.base_pitch) <= ends[1]}
    radii = {
        j: (
            np.array([math.hypot(pair.driver.base_radius, xi)]),
            np.array([math.hypot(pair.driven.base_radius, xi + pair.centre_distance * math.sin(aw))]),
        )
        for j, xi in places.items()
    }
    modulus = 1.0 / (1.0 / pair.driver.plane_modulus + 1.0 / pair.driven.plane_modulus)

    def approach(j: int, w: float) -> float:
        xi = places[j]
        rho = 1.0 / (1.0 / xi - 1.0 / (xi + pair.centre_distance * math.sin(aw)))
        b = math.sqrt(4.0 * w * rho / (math.pi * modulus))
        wide = planet.reference_half_width  # solved under a usual width, the Hertzian one by its logarithm
        own = planet.self_compliance(radii[j][0], wide)[0] + ring.self_compliance(radii[j][1], wide)[0]
        return w * float(own + (planet.log_slope + ring.log_slope) * math.log(wide / b))

    def beside(i: int, j: int) -> float:
        one = planet.neighbour(i - j, radii[i][0], radii[j][0])
        return float((one + ring.neighbour(j - i, radii[i][1], radii[j][1])).item())

    for count in range(1, len(places) + 1):
        for bearing in combinations(places, count):
            w = dict.fromkeys(bearing, load / count)
            for _ in range(200):  # secant compliances, until they no longer change
                c = np.array([[approach(i, w[i]) / w[i] if i == j else beside(i, j) for j in bearing] for i in bearing])
                system = np.block([[c, -np.ones((count, 1))], [np.ones((1, count)), np.zeros((1, 1))]])
                *found, u = np.linalg.solve(system, np.append(np.zeros(count), load))
                if min(found) <= 0.0:
                    break
                change = max(abs(a - w[j]) for a, j in zip(found, bearing, strict=True))
                w = dict(zip(bearing, found, strict=True))
                if change < 1e-13 * load:
                    break
            gaps = [sum(beside(i, j) * w[j] for j in bearing) - u for i in places if i not in bearing]
            if min(found) > 0.0 and all(gap >= 0.0 for gap in gaps):
                return w, u
    raise AssertionError("no state of contact")


@pytest.mark.parametrize("share", [0.05, 0.3, 0.49, 0.6, 0.93])
@pytest.mark.parametrize("reverse", [False, True], ids=["planet drives", "ring drives"])
def test_load_sharing_is_that_of_the_issue_s_equations_by_enumeration(share, reverse):
    """Within 2e-5: fegear tabulates own compliances by splines and neighbours by polynomials."""
    pair, load = the_pair(), 250e3
    x = pair.x_start + share * pair.base_pitch
    w, u = by_enumeration(pair, x, load)
    sources = [finite_element_compliance(one) for one in solved()]
    if reverse:
        engagement = Engagement(PairCompliance(pair.reversed(), sources[1], sources[0]))
        x = -x
    else:
        engagement = Engagement(PairCompliance(pair, *sources))
    face = pair.face_width
    got = engagement.solve(engagement.grid([float(engagement.meshing.reduced(x))]), [load * face])
    loads = got.loads[:, 0, 0] / face
    found = sorted(one for one in loads if one > 0.0)
    assert found == pytest.approx(sorted(w.values()), rel=2e-5)
    assert got.transmission_error[0, 0] == pytest.approx(u, rel=2e-5)


@pytest.mark.parametrize("member", ["driver", "driven"])
def test_root_stress_of_a_lone_tooth_is_that_of_its_gear(member):
    """Where one pair bears and neighbours are uncoupled, the history has the stress of a gear under that load."""
    pair, load = the_pair(), 250e3 * the_pair().face_width
    engagement = Engagement(PairCompliance(pair, *(finite_element_compliance(one) for one in solved()), coupling=False))
    x = np.linspace(pair.x_end - pair.base_pitch, pair.x_start + pair.base_pitch, 9)[1:-1]
    state = engagement.solve(engagement.grid(x), [load])
    assert (state.shared.pairs_in_contact == 1).all()
    gear = solved()[0 if member == "driver" else 1]
    for side in ("tension", "compression"):
        found = root_stress_history(engagement, state, member, side).stress[:, :, 0]
        lone = gear.largest_root_stress(0, side, pair.radius(x, member))[0] * load / pair.face_width
        assert (found.max(axis=0) if side == "tension" else found.min(axis=0)) == pytest.approx(lone, rel=1e-8)


def test_neighbours_loads_belong_in_the_root_stress_of_a_ring():
    """A thin held rim: what the teeth beside it carry changes the largest root tension by several percent."""
    pair, load = the_pair(), 250e3 * the_pair().face_width
    engagement = Engagement(PairCompliance(pair, *(finite_element_compliance(one) for one in solved())))
    x = pair.x_start + np.linspace(0.05, 0.45, 5) * pair.base_pitch
    state = engagement.solve(engagement.grid(x), [load])
    whole = root_stress_history(engagement, state, "driven").stress[:, :, 0]
    ring = solved()[1]
    for row, number in enumerate(state.grid.contacts.number):
        w = state.loads[row, :, 0] / pair.face_width
        if (w > 0.0).all():
            own = ring.largest_root_stress(0, "tension", pair.radius(x + number * pair.base_pitch, "driven"))[0] * w
            assert (np.abs(whole[row] / own - 1.0) > 0.02).any()
            assert np.abs(whole[row] / own - 1.0).max() < 0.5


@pytest.mark.parametrize("reverse", [False, True], ids=["planet drives", "ring drives"])
def test_a_relief_for_least_excitation_leaves_a_planet_in_its_ring_none(reverse):
    """With the compliances it was designed with, coupling included; whichever drives, the gears get the same relief."""
    pair = the_pair().reversed() if reverse else the_pair()
    planet, ring = (finite_element_compliance(one) for one in solved())
    e = Engagement(PairCompliance(pair, *((ring, planet) if reverse else (planet, ring))))
    share = LoadingFunction(1.45 * pair.base_pitch, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end))
    designed, load = minimum_excitation(e, share, 3000.0), 3000.0
    te = transmission_error(designed, load)
    assert te.peak_to_peak < 1e-9 * te.mean < 0.5e-9 * 1e-3
    assert transmission_error(e, load).peak_to_peak > 0.1 * te.mean
    # The planet's removal at its tip and at its root, where the ring's tip touches it, is the same for either driver.
    relief = designed.driven_relief if reverse else designed.driver_relief
    rolled = the_pair().roll_angle(np.array([the_pair().x_start, the_pair().x_end]), "driver")
    assert relief.removal(rolled) == pytest.approx(removals(), rel=1e-6, abs=1e-12)


@cache
def removals() -> tuple[float, ...]:
    """Of the planet when it drives."""
    pair = the_pair()
    e = Engagement(PairCompliance(pair, *(finite_element_compliance(one) for one in solved())))
    share = LoadingFunction(1.45 * pair.base_pitch, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end))
    relief = minimum_excitation(e, share, 3000.0).driver_relief
    return tuple(relief.removal(pair.roll_angle(np.array([pair.x_start, pair.x_end]), "driver")))
