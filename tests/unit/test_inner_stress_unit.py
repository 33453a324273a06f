"""Stress inside the teeth under unit loads: against the fillets' own strains, another mesh, and the mesh history."""

import json

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.fem.plane.inner_stress import inner_stress
from fegear.fem.plane.loaded_gear import loaded_gear
from fegear.results.catalogue import STAGES
from fegear.window.on_gears import on_the_gears

CASE = {
    "results": ["load-sharing"],
    "gear": {
        "a": {"teeth": 21, "module": "3 mm", "face_width": "30 mm", "profile_shift": 0.3},
        "b": {"teeth": 53, "module": "3 mm", "face_width": "28 mm"},
    },
    "pair": {"I": {"driver": "a", "driven": "b", "load": "5 kN"}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
    "accuracy": {"tolerance": 1e-3},
}


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


@pytest.fixture(scope="module")
def ran(cache):
    return _run(CASE, cache)


def _run(case, cache):
    scene = build_scene(case, "case", None)
    return run_plan(scene, make_plan(scene, STAGES, [Task("stress-inside", "I")]), cache=cache)


@pytest.mark.parametrize("gear", ["a", "b"])
def test_on_a_fillet_it_is_the_tangential_stress_that_the_surface_strain_gives(ran, gear):
    """A free surface bears no other stress; strains of edges and gradients of elements are taken apart."""
    fine, table = ran.outcomes[Task("gear-solution", gear)].data.fine, ran.outcomes[Task("inner-stress", gear)].data
    middle = slice(4, 17)  # contacts whose pressure is as wide as the table says
    xx, yy, xy = (table.stress[middle, :, i][:, :, table.fillet] for i in range(3))
    half, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    points = table.points[:, table.fillet]
    for side, on in (("tension", points[0] > 0.0), ("compression", points[0] < 0.0)):
        fillet = fine.fillets[side]
        height, order = np.hypot(*points[:, on]), np.argsort(fillet.radius)
        inner = (height > fillet.radius.min() + 0.1) & (height < fillet.radius.max() - 0.1)
        for k in (-1, 0, 1):
            known = fine.fillet_stress(k, side, table.radius[middle], table.half_width).T
            wanted = np.stack([np.interp(height, fillet.radius[order], one[order]) for one in known])
            mean, off = half[:, k + table.reach][:, on], radius[:, k + table.reach][:, on]
            found = np.where(mean > 0.0, mean + off, mean - off)
            np.testing.assert_allclose(found[:, inner], wanted[:, inner], atol=3e-3 * np.abs(wanted).max())


def test_it_is_the_field_of_a_finer_mesh_of_the_whole_gear(ran):
    """Six-node triangles on a mesh of their own, all teeth solved: away from the contact to 1 % of the largest."""
    from scipy.interpolate import LinearNDInterpolator

    solved, table = ran.outcomes[Task("gear-solution", "a")].data, ran.outcomes[Task("inner-stress", "a")].data
    row = 9
    place = table.radius[row] * solved.gear.module
    _, field = loaded_gear(solved.gear, solved.settings, radius=place)
    inside = np.hypot(*table.points) > np.hypot(*table.points[:, table.fillet]).min() - 1.0
    contact = np.array([[0.0], [table.radius[row]]])
    away = inside & (np.hypot(*(table.points - contact)) > 1.1)
    for k in range(-1, 2):
        read = LinearNDInterpolator(field.mesh.points.T, field.stress[k % solved.gear.teeth, :3].T)
        wanted = read(table.points.T).T
        known = away & np.isfinite(wanted).all(axis=0)
        assert known.sum() > 150
        off = np.abs(table.stress[row, k + table.reach] - wanted)[:, known]
        top = np.abs(field.stress[0, :3]).max()
        assert np.percentile(off, 98) < 0.01 * top


def test_stress_across_a_circle_below_all_teeth_bears_the_moment_of_the_load(ran):
    from scipy.interpolate import LinearNDInterpolator

    solved = ran.outcomes[Task("gear-solution", "a")].data
    table, row = inner_stress(solved.fine, 40), 10
    assert table.reach == 10  # a gear has no more neighbours than it has
    radius = float(np.hypot(*table.points[:, table.fillet]).min()) - 0.4
    angle = np.linspace(-np.pi, np.pi, 401) / solved.gear.teeth
    normal, along = np.stack([np.sin(angle), np.cos(angle)]), np.stack([np.cos(angle), -np.sin(angle)])
    moment = 0.0
    for tooth in table.stress[row]:
        xx, yy, xy = LinearNDInterpolator(table.points.T, tooth.T)(radius * normal.T).T
        shear = xx * normal[0] * along[0] + yy * normal[1] * along[1]
        shear += xy * (normal[0] * along[1] + normal[1] * along[0])
        moment += float(np.trapezoid(shear, angle)) * radius**2
    assert abs(moment) == pytest.approx(solved.gear.tooth.base_radius, rel=1e-2)  # straight between the points


def test_the_page_is_sent_what_it_needs_and_no_relief_changes_it(ran, cache):
    sent = on_the_gears(Task("stress-inside", "I"), ran.outcomes[Task("stress-inside", "I")].data)
    text = json.dumps(sent, allow_nan=False)
    assert len(text) < 2_500_000
    moved = json.loads(json.dumps(CASE))
    moved["gear"]["a"]["relief"] = {"tip": {"amount": "20 um", "length": "4 mm"}}
    moved["effects"]["relief"] = True
    again = _run(moved, cache)
    assert again.outcomes[Task("loaded-pair", "I")].data is not ran.outcomes[Task("loaded-pair", "I")].data
    assert again.outcomes[Task("stress-inside", "I")].data is ran.outcomes[Task("stress-inside", "I")].data
    assert sent["gears"]["driver"]["per_load"] == pytest.approx(1e-6 / (0.028 * 0.003))
