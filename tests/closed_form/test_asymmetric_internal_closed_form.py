"""Ring gears whose flanks differ: equal flanks as ever, the cutter's rolling, backlash, mirrored and turned round."""

import copy
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import GeometryError, InputError
from fegear.case.reading import build_scene
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import influence_of_shape, solve_gear
from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalTooth
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.outline import tool_in_gear
from fegear.geometry.pair import GearPair
from fegear.output.export import export_gears
from fegear.results.catalogue import STAGES

CUTTER = PinionCutter(25, profile_shift=0.1, addendum=1.25, tip_radius=0.1)
STEEP, FLAT = math.radians(28.0), math.radians(18.0)
RING = AsymmetricInternalTooth(60, CUTTER, STEEP, FLAT, 0.15, -0.3, 0.02, 29.5, tip_rounding=0.05)
HELIX, M = math.radians(15.0), 4e-3
SETTINGS = settings_at(-4).scaled(1.5)


@pytest.mark.parametrize("beta", [0.0, HELIX])
def test_equal_flanks_give_the_digits_of_the_symmetric_tooth(beta):
    """Of generation, outline and the plane ring."""
    tip = 30.0 / math.cos(beta) - 0.5
    shape = {"profile_shift": -0.3, "thickness_allowance": 0.02, "tip_radius": tip, "helix_angle": beta}
    equal = AsymmetricInternalTooth(60, CUTTER, FLAT, FLAT, 0.1, **shape)
    usual = InternalTooth(60, CUTTER, FLAT, **shape)
    assert equal.generating_distance == pytest.approx(usual.generating_distance, rel=1e-15)
    for side in (equal.drive, equal.coast):
        for name in ("root_radius", "base_half_angle", "form_radius", "tip_half_angle", "limit_radius", "tip_middle"):
            assert getattr(side, name) == pytest.approx(getattr(usual, name), abs=1e-13)
    low, high = usual.involute_radii
    at = np.linspace(low + 0.1, high - 0.1, 4)
    found, wanted = (influence_of_shape(one, tip + 6.5, 0.3, "strain", SETTINGS, 1) for one in (equal.drive, usual))
    assert found.self_compliance(at, 0.2, 0.1) == pytest.approx(wanted.self_compliance(at, 0.2, 0.1), rel=1e-9)
    for side in ("tension", "compression"):
        one, other = (each.largest_root_stress(0, side, at, 0.1)[0] for each in (found, wanted))
        assert one == pytest.approx(other, rel=1e-9)


@pytest.mark.parametrize("beta", [0.0, HELIX])
@pytest.mark.parametrize("flank", ["drive", "coast"])
def test_the_cutter_rolls_through_the_space_and_cuts_nowhere_deeper(flank, beta):
    """Positions of the cutter's tooth against the outline: it touches flank and fillet everywhere, within 1e-9."""
    tip = 30.0 / math.cos(beta) - 0.5
    side = replace(RING, tip_rounding=0.0, helix_angle=beta, tip_radius=tip).side(flank)
    pieces = [one.points(np.linspace(one.start, one.end, 12001)) for one in (side.fillet, side.involute)]
    x, y = np.hstack(pieces)
    radius, polar = np.hypot(x, y), np.arctan2(x, y)
    order = np.argsort(radius)
    radius, polar = radius[order], polar[order]
    nearest = np.full(10, np.inf)
    for rolled in np.linspace(-0.3, 0.3, 401):
        left = np.hypot(*(cut := tool_in_gear(side, rolled))[:, cut.shape[1] // 2 :])
        angle = np.arctan2(*cut[:, cut.shape[1] // 2 :])
        inside = (left > radius[0]) & (left < radius[-1])
        gap = (angle[inside] - np.interp(left[inside], radius, polar)) * left[inside]
        which = (10 * (left[inside] - radius[0]) / (radius[-1] - radius[0])).astype(int)
        np.minimum.at(nearest, which, gap)
    assert nearest.min() > -1e-7  # of the table of the steep fillet
    assert nearest[:-2].min() > -2e-9
    assert nearest.max() < 2e-3  # 401 positions of a few points


def test_thickness_and_sides_go_together():
    assert 30.0 * float(RING.drive.thickness_angle(30.0)) == pytest.approx(RING.thickness, rel=1e-14)
    assert RING.drive.root_land_half_angle == RING.coast.root_land_half_angle
    assert RING.reversed.drive.base_half_angle == pytest.approx(RING.coast.base_half_angle, abs=1e-15)
    assert RING.reversed.reversed == RING
    assert RING.drive.tip_middle == -RING.coast.tip_middle


def planet(teeth=23, drive=STEEP, coast=FLAT, tips=(0.15, 0.25), shift=0.3, allowance=0.01):
    rack = AsymmetricRack(RackFlank(drive, tips[0]), RackFlank(coast, tips[1]))
    return AsymmetricTooth(teeth, rack, shift, allowance)


def pair_of(outer, inner, flank="drive"):
    driver = Gear(outer.side(flank), M, 22e-3, 40e-3)
    return GearPair(driver, Gear(inner.side(flank), M, inner.root_radius * M + 16e-3, 40e-3))


PAIR = pair_of(planet(), RING)


def test_backlash_is_what_the_allowances_take():
    """At the distance of their shifts; both flanks touch at the tight distance."""
    arc = (0.02 + 0.01) * M
    assert PAIR.centre_distance == pytest.approx(0.5 * (60 - 23) * M)  # shifts cancel
    assert PAIR.circumferential_backlash == pytest.approx(arc, rel=1e-9)
    assert PAIR.normal_backlash == pytest.approx(arc * math.cos(FLAT), rel=1e-9)
    tight = replace(PAIR, centre_distance=PAIR.tight_centre_distance)
    assert tight.circumferential_backlash == pytest.approx(0.0, abs=1e-12)
    assert tight.centre_distance > PAIR.centre_distance
    back = PAIR.from_the_back
    assert back.contact_ratio > PAIR.contact_ratio
    assert back.circumferential_backlash == pytest.approx(PAIR.circumferential_backlash, rel=1e-9)


def test_equal_flanks_have_the_distance_and_the_checks_of_symmetric_gears():
    usual = GearPair(
        Gear(Tooth(23, profile_shift=0.4), M, 22e-3, 40e-3), Gear(InternalTooth(60, CUTTER), M, 142e-3, 40e-3)
    )
    angle = math.radians(20.0)
    equal = pair_of(
        planet(drive=angle, coast=angle, tips=(0.25, 0.25), shift=0.4, allowance=0.0),
        AsymmetricInternalTooth(60, CUTTER, angle, angle, 0.1),
    )
    assert equal.centre_distance == pytest.approx(usual.centre_distance, rel=1e-12)
    margins = {one.name: one.margin for one in usual.internal_checks}
    checks = equal.internal_checks
    assert len(checks) == 2 * (len(margins) - 2)  # both flanks, without assembly and feed across the axis
    for one in checks:
        assert one.margin == pytest.approx(margins[one.name.partition(" (")[0]], abs=1e-9)


@pytest.fixture(scope="module")
def loaded():
    def error(pair):
        solved = [solve_gear(gear, SETTINGS, reach=1, estimate_error=False) for gear in (pair.driver, pair.driven)]
        e = load_plane(PairSpec(pair, (8e3,), corner_contact=True), solved, estimates=False).engagement
        x = pair.x_start + pair.base_pitch * np.array([0.1, 0.4, 0.6, 0.9])
        return e.solve(e.grid(x), [8e3]).transmission_error[:, 0]

    return error


def test_gears_turned_round_are_loaded_on_their_other_flanks(loaded):
    """A pair of coast flanks is that of the drive flanks of both gears turned round, within 1e-12."""
    coast = loaded(pair_of(planet(), RING, "coast"))
    turned = loaded(pair_of(planet().reversed, RING.reversed))
    assert coast == pytest.approx(turned, rel=1e-12)
    assert np.abs(loaded(PAIR) / coast - 1.0).max() > 0.02


@pytest.mark.parametrize("seed", [0, 1, 2, pytest.param(3, marks=pytest.mark.long)])
def test_random_ring_gears_that_are_not_refused_are_solved_from_either_flank(seed):
    """Teeth, angles, roundings, shifts and rims at random: compliance and root tension are positive."""
    draw, solved = np.random.default_rng(seed), 0
    while solved < (30 if seed == 3 else 2):
        teeth = int(draw.integers(20, 140))
        cutter = PinionCutter(
            max(8, int(teeth * draw.uniform(0.2, 0.6))), draw.uniform(-0.1, 0.3), draw.uniform(1.1, 1.35),
            tip_radius=draw.uniform(0.0, 0.3),
        )  # fmt: skip
        steep, flat = np.radians(draw.uniform(15.0, 32.0, 2))
        rounding, shift, tip = draw.uniform(0.0, 0.3), draw.uniform(-0.6, 0.3), 0.5 * teeth - draw.uniform(0.5, 1.0)
        try:
            tooth = AsymmetricInternalTooth(teeth, cutter, steep, flat, rounding, shift, tip_radius=tip)
        except GeometryError:
            continue
        solved += 1
        outside = (tooth.root_radius + draw.uniform(1.0, 5.0)) * M
        for side in (tooth.drive, tooth.coast):
            known = solve_gear(Gear(side, M, outside, 10e-3), settings_at(-5.0), reach=1, estimate_error=False).fine
            low, high = side.involute_radii
            at = np.linspace(low + 0.05, high - 0.05, 3)
            assert (known.self_compliance(at, 0.3, np.asarray(0.05)) > 0.0).all()
            assert (known.largest_root_stress(0, "tension", at)[0] > 0.0).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"teeth": 27}, "difference below 3"), ({"drive_angle": 0.9}, "between 5 and 45 deg"),
        ({"tip_radius": 32.5}, "gives no involute"), ({"tip_radius": 27.0}, "limit of the involutes"),
        ({"coast_tip_radius": -0.1}, "must not be negative"), ({"profile_shift": 9.0}, "no working pressure angle"),
        ({"profile_shift": -500.0}, "above 76 deg"),
        ({"cutter": replace(CUTTER, tip_radius=0.5)}, "use at most"),
        ({"cutter": replace(CUTTER, addendum=2.5)}, "pointed cutter tooth"),
        ({"tip_rounding": 1.5}, "is too large|removes the entire"),
    ],
)  # fmt: skip
def test_teeth_that_cannot_be_are_refused(change, words):
    with pytest.raises(GeometryError, match=words):
        replace(RING, **change)


CASE = {
    "results": ["geometry"],
    "gear": {
        "planet": {
            "teeth": 23, "module": "4 mm", "pressure_angle": "28 deg", "coast_pressure_angle": "18 deg",
            "rack": {"tip_radius": 0.15, "coast_tip_radius": 0.25}, "profile_shift": 0.3, "bore_radius": "22 mm",
            "face_width": "40 mm", "thickness_allowance": "40 um",
        },
        "ring": {
            "internal": True, "teeth": 60, "module": "4 mm", "pressure_angle": "28 deg",
            "coast_pressure_angle": "18 deg", "profile_shift": -0.3, "tip_diameter": "236 mm",
            "cutter": {"teeth": 25, "profile_shift": 0.1, "tip_radius": 0.1, "coast_tip_radius": 0.15},
            "rim_thickness": "16 mm", "face_width": "40 mm", "thickness_allowance": "80 um",
        },
    },
    "pair": {"I": {"driver": "planet", "driven": "ring", "load": "8 kN"}},
    "accuracy": {"tolerance": 0.05},
}  # fmt: skip


def case(*results, ring=None):
    found = copy.deepcopy(CASE)
    found["results"] = list(results)
    found["gear"]["ring"] |= ring or {}
    return build_scene(found, "ring", Path())


def test_a_case_says_what_the_mechanics_takes():
    scene = case("geometry")
    ring = scene.gears["ring"].tooth
    wanted = AsymmetricInternalTooth(60, CUTTER, STEEP, FLAT, 0.15, -0.3, ring.thickness_allowance, 29.5)
    assert ring.tooth == wanted
    assert ring.thickness_allowance == pytest.approx(0.02, rel=1e-12)
    assert ring.flank == "drive"
    values = {value.name: value.value for value in run_plan(scene, make_plan(scene, STAGES)).values}
    alone = pair_of(planet(), replace(RING, tip_rounding=0.0))
    assert values["I.contact_ratio"] == pytest.approx(alone.contact_ratio, rel=1e-9)
    assert values["I.back_contact_ratio"] > values["I.contact_ratio"]
    usual = {"coast_pressure_angle": "28 deg", "cutter": {"teeth": 25, "tip_radius": 0.05}}
    equal = {"results": ["geometry"], "gear": {"ring": CASE["gear"]["ring"] | usual}}
    assert type(build_scene(equal, "ring", Path()).gears["ring"].tooth) is InternalTooth


@pytest.mark.parametrize(
    ("ring", "words"),
    [
        ({"cutter": {"tip_radius": 0.1}}, r"gear\.ring\.cutter\.teeth = \(not given\): is required for asymmetric"),
        ({"cutter": {"teeth": 25, "tip_radius": 0.1, "coast_tip_radius": -1}}, r"gear\.ring\.cutter\.coast_tip_radius"),
        ({"coast_pressure_angle": "80 deg"}, "deg"), ({"odd_tooth": [{"tooth": 0, "missing": True}]}, "asymmetric"),
    ],
)  # fmt: skip
def test_cases_that_cannot_be_are_refused_under_their_key(ring, words):
    with pytest.raises(InputError, match=words):
        case("geometry", ring=ring)


def test_drawings_of_the_ring_close(tmp_path):
    import ezdxf
    from ezdxf.path import make_path

    written = export_gears(case("geometry"), tmp_path, ("ring",), "dxf")
    assert any("tooth root up, the drive flank is on the right" in one for one in written.remarks)
    entities = list(ezdxf.readfile(tmp_path / "ring_tooth_spline.dxf").modelspace())
    lines = [np.array([(v.x, v.y) for v in make_path(one).flattening(1e-3)]) for one in entities]
    ends = np.array([end for line in lines for end in (line[0], line[-1])])
    assert all(np.sort(np.hypot(*(ends - end).T))[1] < 1e-6 for end in ends)


@pytest.mark.parametrize("teeth", [8, 12, 25])
@pytest.mark.parametrize("radius", [0.1, 0.35])
def test_the_rounding_of_a_cutter_touches_both_of_its_flanks_and_its_tip_circle(teeth, radius):
    """Its centre lies so far along the involute's normal, and so far inside of the tip."""
    cutter = PinionCutter(teeth, profile_shift=0.1, addendum=1.0, tip_radius=radius)
    ring = AsymmetricInternalTooth(60, cutter, FLAT, math.radians(20.0), radius, -0.3, 0.0, 29.9)
    for flank, angle in (("drive", FLAT), ("coast", math.radians(20.0))):
        base = 0.5 * teeth * math.cos(angle)
        length, normal, centre = ring.cutter_rounding(flank)
        assert math.hypot(base, length - radius) == pytest.approx(0.5 * teeth + 1.1 - radius, rel=1e-12)
        assert centre - normal == pytest.approx(math.atan2(length - radius, base), rel=1e-12)


@pytest.mark.parametrize(("flank", "key"), [("drive", "cutter.tip_radius"), ("coast", "cutter.coast_tip_radius")])
def test_a_fillet_with_a_cusp_is_refused_by_the_key_of_its_own_flank(flank, key):
    fillet = SimpleNamespace(start=0.0, end=1.0, speed=lambda u: u - 0.5)
    side = SimpleNamespace(
        root_land_half_angle=0.0, teeth=30, fillet=fillet, flank=flank,
        tooth=SimpleNamespace(rounding={"drive": 0.3, "coast": 0.4}.get),
    )  # fmt: skip
    with pytest.raises(GeometryError, match="loop or cusp") as refused:
        type(RING.drive).check(side)
    assert refused.value.key == key
    assert float(refused.value.value) == {"drive": 0.3, "coast": 0.4}[flank]
