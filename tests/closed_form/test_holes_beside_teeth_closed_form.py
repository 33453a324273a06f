"""A round hole through the body beside one tooth: laws of the ring, and the whole gear by another mesh and code."""

import functools
import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import FegearError, InputError
from fegear.case.built.odd_teeth import check_odd_gear, odd_teeth_of
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.plane.odd.hole import SMALLEST, Hole, hole_at, holed_sector, refuse_hole
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport
from fegear.results.catalogue import STAGES
from tests.helpers.cracked_gear import Solved, cracked_gear

TOOTH, BORE = Tooth(28, BasicRack(1.0, 1.25, 0.25)), 6.375
RADII, WIDTH = np.array([13.5, 14.2, 14.8]), np.full(3, 0.02)
SETTINGS = settings_at(-3)
HOLE = hole_at(0.6, 11.2, math.radians(1.5))


@functools.cache
def ordinary():
    return solve_gear(Gear(TOOTH, 1.0, BORE, 1.0, Material(1.0)), SETTINGS, reach=2)


@functools.cache
def solved(*holes):
    return solve_cracked_gear(ordinary(), dict(holes))


def test_a_hole_that_goes_to_nothing_leaves_the_ordinary_gear():
    """About as its radius squared: 1.7 % of the deflection at 0.5 modules."""
    usual = ordinary().self_compliance(RADII, WIDTH)
    change = {
        radius: np.abs(solved((0, hole_at(radius, 11.2, 0.0))).own(0, RADII, WIDTH) / usual - 1.0).max()
        for radius in (SMALLEST, 0.25, 0.5)
    }
    assert change[0.5] == pytest.approx(0.0170, rel=0.03)
    assert change[0.5] / change[0.25] == pytest.approx(4.0, rel=0.2)
    assert change[SMALLEST] < 1.5e-4  # another mesh


def test_teeth_are_counted_from_the_hole_and_deflections_stay_reciprocal():
    here, there = solved((0, HOLE)), solved((5, HOLE))
    assert there.own(5, RADII, WIDTH) == pytest.approx(here.own(0, RADII, WIDTH), rel=1e-12)
    c = here.between(1, 0, RADII, RADII)
    assert c == pytest.approx(here.between(0, 1, RADII, RADII).T, rel=1e-9)
    assert there.between(6, 5, RADII, RADII) == pytest.approx(c, rel=1e-12)
    assert (here.own(0, RADII, WIDTH) > ordinary().self_compliance(RADII, WIDTH)).all()


def test_a_hole_toward_the_loaded_flank_is_on_its_side():
    """Under a load that bends the tooth away, the tension side's fillet feels a hole below it more than the other."""
    toward, away = (solved((0, hole_at(0.5, 11.6, math.radians(way * 2.5)))) for way in (1.0, -1.0))
    assert HOLE.centre[0] > 0.0
    assert HOLE.mirrored() == Hole(HOLE.radius, (-HOLE.centre[0], HOLE.centre[1]))
    usual = float(ordinary().largest_root_stress(0, "tension", RADII[1:2])[0][0])
    near, far = (float(one.largest_root_stress(0, 0, "tension", RADII[1:2])[0][0]) for one in (toward, away))
    assert abs(near - usual) > 1.5 * abs(far - usual)


@pytest.mark.dear
def test_stated_errors_cover_a_finer_solution():
    finer = solve_cracked_gear(
        solve_gear(ordinary().gear, settings_at(0.0), reach=2, estimate_error=False), {0: HOLE}
    )  # fmt: skip
    known = solved((0, HOLE))
    for i, j in ((0, 0), (1, 0), (1, 1)):
        if i == j:
            off, stated = known.own(i, RADII, WIDTH) - finer.own(i, RADII, WIDTH), known.own_error(i, RADII, WIDTH)
        else:
            off = known.between(i, j, RADII, RADII) - finer.between(i, j, RADII, RADII)
            stated = known.between_error(i, j, RADII, RADII)
        assert np.abs(off).max() < 1.5 * stated.max()
        stress, true = (one.largest_root_stress(i, j, "tension", RADII)[0] for one in (known, finer))
        assert np.abs(stress - true).max() < 1.5 * known.root_stress_error(i, j, "tension", RADII).max()


@pytest.mark.dear
def test_the_gear_with_a_hole_is_the_whole_gear_by_another_code():
    """Own six-node triangles, which CalculiX agrees with: c_ij within 3e-4, root tension within 2e-3 of the largest."""
    radii = [13.4, 14.0, 14.6]
    known = solve_cracked_gear(solve_gear(ordinary().gear, settings_at(-2.0), reach=2, estimate_error=False), {0: HOLE})
    mesh = cracked_gear(TOOTH, BORE, None, radii, 0.08, fillet=0.04, hole=(HOLE.radius, *HOLE.centre))
    whole = Solved(TOOTH, BORE, mesh)
    largest, apart = float(known.own(0, radii, WIDTH).max()), ~np.eye(3, dtype=bool)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            off = np.abs(known.between(i, j, radii, radii) - whole.between(i, j))
            assert off[apart if i == j else slice(None)].max() < 3e-4 * largest
    loaded = float(known.largest_root_stress(0, 0, "tension", [radii[1]], 0.02)[0][0])
    for i, j in ((0, 0), (1, 1), (1, 0), (0, -1)):
        stress, _ = known.largest_root_stress(i, j, "tension", [radii[1]], 0.02)
        assert whole.root_tension(i, (j, 1)) == pytest.approx(stress[0], abs=2e-3 * loaded)


@pytest.mark.parametrize("support", [RimSupport(free_teeth=5), RimSupport(web=0.3, inner_radius=4.0)])
def test_rims_with_a_hole(support):
    gear = Gear(TOOTH, 1.0, 10.0, 1.0, Material(1.0), support=support)
    plain = solve_gear(gear, SETTINGS, reach=1, estimate_error=False)
    found = solve_cracked_gear(plain, {0: hole_at(0.4, 11.3, 0.0)})
    assert (found.own(0, RADII, WIDTH) > 1.0005 * plain.self_compliance(RADII, WIDTH)).all()


def test_a_hole_lies_within_one_pitch():
    for hole, key in (
        (hole_at(2.0, 11.2, 0.0), "diameter"),
        (hole_at(0.5, 11.2, math.radians(6.5)), "angle"),
        (hole_at(0.5, 5.0, 0.0), "position_radius"),
        (hole_at(0.01, 11.2, 0.0), "diameter"),
    ):
        with pytest.raises(InputError) as refused:
            refuse_hole(TOOTH, BORE, SETTINGS, hole)
        assert refused.value.key == key
    # as large as is said
    with pytest.raises(InputError, match="must be at most") as refused:
        refuse_hole(TOOTH, BORE, SETTINGS, hole_at(2.0, 11.2, 0.0))
    most = float(str(refused.value.rule).split("at most ")[1].split()[0])
    assert refuse_hole(TOOTH, BORE, SETTINGS, hole_at(0.49999 * most, 11.2, 0.0)) > 0.0
    mesh = holed_sector(TOOTH, BORE, SETTINGS, hole_at(0.49999 * most, 11.2, 0.0))
    assert "hole" in mesh.edges
    x, y = mesh.points[:, np.unique(mesh.edges["hole"])]
    assert np.hypot(x, y - 11.2) == pytest.approx(0.49999 * most, rel=1e-9)


GEAR = {
    "teeth": 25, "module": "2 mm", "rack": {"addendum": 1.0, "dedendum": 1.25, "tip_radius": 0.25},
    "face_width": "20 mm",
}  # fmt: skip


def scene(hole, on=True, **more):
    odd = {"tooth": 3, "hole": hole, **more}
    return build_scene(
        {
            "results": ["transmission-error"], "gear": {"a": {**GEAR, "odd_tooth": [odd]}, "b": {**GEAR, "teeth": 30}},
            "pair": {"I": {"driver": "a", "driven": "b", "torque": "60 N*m"}},
            "effects": {"odd_teeth": on, "corner_contact": True}, "accuracy": {"tolerance": 1e-2},
        },
        "hole", Path(),
    )  # fmt: skip


def test_a_case_says_where_the_hole_is_and_what_is_refused():
    hole = {"diameter": "1.5 mm", "position_radius": "19.5 mm", "angle": "2 deg"}
    found = odd_teeth_of(scene(hole), "a")
    ((number, made),) = found.outlines
    assert (number, found.numbers, found.described) == (3, (3,), "tooth 3 above a hole")
    assert made.radius == pytest.approx(0.375)
    assert made.centre == pytest.approx((9.75 * math.sin(math.radians(2.0)), 9.75 * math.cos(math.radians(2.0))))
    assert found.on_other_flank().outlines == ((3, made.mirrored()),)
    for given, more, said in (
        ({**hole, "angle": "9 deg"}, {}, r"odd_tooth\[0\].hole.angle = 9 deg: must be between"),
        ({**hole, "diameter": "4.5 mm"}, {}, r"hole.diameter = 4.5 mm: must be at most \d.\d+ mm at this place"),
        (hole, {"missing": True}, "hole = .given.: is not available together with missing"),
        (hole, {"crack": {"depth": "0.5 mm"}}, "is not available together with crack"),
    ):
        with pytest.raises(FegearError, match=said):
            check_odd_gear(scene(given, **more), "a")


@pytest.mark.dear
def test_without_its_effect_a_hole_changes_nothing():
    hole = {"diameter": "3 mm", "position_radius": "19.5 mm"}
    values = []
    for case in (scene(hole, on=False), scene({**hole, "diameter": "1 mm"}, on=False)):
        results = run_plan(case, make_plan(case, STAGES))
        values.append([(v.name, v.si) for outcome in results.outcomes.values() for v in outcome.values])
    assert values[0] == values[1]
    assert values[0]
