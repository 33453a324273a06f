"""Gauges on 3D gears: stretch of the moved surface, a rosette, own quadrature, finer gears, plane gears."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.contact.wide.compliance import places_of
from fegear.contact.wide.gauge_on_face import _between_positions
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.plane.gauge import Grid
from fegear.fem.solid.gauge import grid_on_face, lean_at
from fegear.results.catalogue import STAGES

_CACHE = SolutionCache()
FACE = {"grid_length": "0.4 mm", "grid_width": "0.8 mm", "placement_tolerance": "0.1 mm"}


def case_of(helix="0 deg", tolerance=0.1, width="solid", face="14 mm", **gauges):
    gears = {
        name: {
            "teeth": teeth, "normal_module": "2 mm", "face_width": face, "helix_angle": helix, "hand": hand,
            "profile_shift": shift, "bore_radius": "9 mm",
        }
        for name, teeth, hand, shift in (("a", 20, "right", 0.1), ("b", 24, "left", 0.0))
    }  # fmt: skip
    if helix == "0 deg":
        for gear in gears.values():
            gear["module"] = gear.pop("normal_module")
            gear.pop("hand"), gear.pop("helix_angle")
    return {
        "results": ["gauge"], "gear": gears,
        "pair": {"p": {"driver": "a", "driven": "b", "load": "2000 N", "width": width}}, "gauge": gauges,
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}, "accuracy": {"tolerance": tolerance},
    }  # fmt: skip


def ran(document):
    scene = build_scene(document, "case", Path())
    outcomes = run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes
    return {str(task).removeprefix("gauge of "): one.data for task, one in outcomes.items() if task.stage == "gauge"}


@cache
def helical():
    """Loaded pair, and both solid gears."""
    document = case_of("15 deg", face="12 mm", g={"gear": "a"}, h={"gear": "b"})
    scene = build_scene(document, "case", Path())
    outcomes = run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes
    found = {(task.stage, task.subject): one.data for task, one in outcomes.items()}
    return found["loaded-flanks", "p"], {"driver": found["solid-solution", "a"], "driven": found["solid-solution", "b"]}


def moved_surface(rooted, side, load):
    """Displacement of the points up a fillet in space at places along the face, of tooth number `row` [modules/E]."""
    solution = rooted.solution
    _, spans = places_of(rooted.lines)
    on = load[rooted.lines.present]
    loads = np.stack([own @ on[s] for own, s in zip(rooted.loads, spans, strict=True)], axis=1)
    total = 0.0
    for k, felt in rooted.sources.items():
        under = np.zeros((loads.shape[0], len(rooted.teeth)))
        under[:, felt[:, 0]] = loads[:, felt[:, 1]]
        total = total + solution.moved(k, side, under)

    def at(row, zeta):
        values, _ = solution.face.at(np.array([zeta]))
        fillet = solution.fillets[side]
        local = fillet.values @ np.einsum("ncf,f->nc", total[:, :, :, row], values[:, 0])
        turn = solution.tau * zeta
        c, s = math.cos(turn), math.sin(turn)
        rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        place = np.column_stack([*fillet.place, np.full(fillet.arc.size, 0.0)]) @ rotation.T + [0.0, 0.0, zeta]
        return place, local @ rotation.T

    return at


@pytest.mark.dear
@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize("degrees", [0.0, 35.0, 90.0, -35.0])
def test_strain_in_a_direction_is_the_stretch_of_the_moved_surface(member, degrees):
    loaded, gears = helical()
    influence, m = gears[member], loaded.pair.driver.module
    rooted = loaded.rooted(member, loaded.found, influence.fine)
    force, side, phi = loaded.found.contact.force[:, :, 0], "tension", math.radians(degrees)
    fillet = influence.fine.fillets[side]
    arc, zeta, step = 0.55 * fillet.length, 0.4, 0.01
    grid = grid_on_face(influence.fine, side, Grid(0.0, 0.0, phi), np.array([arc * m]), zeta * m, m)
    surface = rooted.surface(side, force, grid.zeta * m) / m**2
    material = loaded.pair.gear(member).material
    strain = grid.means(surface, material, plane_strain=False)[0][0]
    row = int(np.abs(strain).argmax())
    skew, across = lean_at(fillet, influence.fine.tau, arc)
    at, ends = moved_surface(rooted, side, force), []
    for sign in (-1.0, 1.0):
        up, over = sign * step * math.cos(phi), sign * step * math.sin(phi)
        place, moved = at(row, zeta + over / across)
        s = arc + up - skew * over / across
        near = np.argsort(np.abs(fillet.arc - arc))[:7]
        near.sort()
        # a polynomial through points beside: the displacement is smooth within a few of them
        fits = [np.polyfit(fillet.arc[near] - arc, one[near], 5) for one in (*place.T, *moved.T)]
        ends.append(np.array([np.polyval(fit, s - arc) for fit in fits]))
    along, stretch = (ends[1] - ends[0])[:3], (ends[1] - ends[0])[3:]
    length = math.hypot(*along)
    assert length == pytest.approx(2.0 * step, rel=2e-3)
    scale = 1.0 / (material.young_modulus * m**2)  # of forces in newtons on lengths in modules
    assert along @ stretch / length**2 * scale == pytest.approx(strain[row], rel=0.02)


@pytest.mark.dear
def test_a_rosette_gives_the_stress_and_a_grid_the_mean_of_points():
    loaded, gears = helical()
    solution, m, material = gears["driver"].fine, loaded.pair.driver.module, loaded.pair.driver.material
    rooted = loaded.rooted("driver", loaded.found, solution)
    force, e, nu = loaded.found.contact.force[:, :, 0], material.young_modulus, material.poisson_ratio
    arc = np.array([0.5 * solution.fillets["tension"].length * m])

    def strain(direction, length=0.0, width=0.0, at=arc, z=0.5e-3):
        grid = grid_on_face(solution, "tension", Grid(length, width, direction), at, z, m)
        surface = rooted.surface("tension", force, grid.zeta * m) / m**2
        return grid.means(surface, material, plane_strain=False)

    (a, stress), (b, _), (c, _) = (strain(math.radians(one)) for one in (0.0, 45.0, 90.0))
    assert e / (1 - nu**2) * (a + nu * c) == pytest.approx(stress, rel=1e-12, abs=1.0)
    shear = 2.0 * b - a - c
    assert strain(math.radians(-45.0))[0] == pytest.approx(0.5 * (a + c - shear), rel=1e-9, abs=1e-12)
    # midpoints over the rectangle, each a point gauge
    length, width, phi = 0.5e-3, 0.9e-3, math.radians(25.0)
    skew, across = lean_at(solution.fillets["tension"], solution.tau, float(arc[0]) / m)
    total, count = 0.0, 9
    for u in ((np.arange(count) + 0.5) / count - 0.5) * length:
        for v in ((np.arange(count) + 0.5) / count - 0.5) * width:
            up, over = math.cos(phi) * u - math.sin(phi) * v, math.sin(phi) * u + math.cos(phi) * v
            total = total + strain(phi, at=arc + up - skew / across * over, z=0.5e-3 + over / across)[0]
    mean = strain(phi, length, width)[0]
    assert total / count**2 == pytest.approx(mean, abs=4e-3 * np.abs(mean).max())
    assert np.abs(mean - strain(phi)[0]).max() > 1e-2 * np.abs(mean).max()  # a grid is no point


@pytest.mark.dear
def test_in_the_middle_of_a_wide_spur_face_strain_is_that_of_plane_teeth():
    wide = ran(case_of(g={"gear": "a", **FACE}))["g"]
    plane = ran(case_of(tolerance=0.01, width="plane", g={"gear": "a", **FACE}))["g"]
    slices = ran(case_of(width="slices", g={"gear": "a", **FACE}))["g"]
    assert wide.peak_strain[0] == pytest.approx(plane.peak_strain[0], rel=0.05)
    assert slices.peak_strain[0] == pytest.approx(plane.peak_strain[0], rel=0.05)
    assert wide.place.diameter == pytest.approx(plane.place.diameter, rel=1e-3)


@pytest.mark.dear
def test_what_mirrors_mirrors_and_finer_gears_lie_within_the_stated_error():
    gauges = {
        name: {"gear": "a", "face_position": f"{z} mm", "direction": f"{phi} deg", **FACE}
        for name, z, phi in (("l", -3, -20), ("r", 3, 20), ("m", 3, -20))
    }
    found = ran(case_of(**gauges))
    left, right = found["l"].history, found["r"].history
    assert left.strain == pytest.approx(right.strain, rel=1e-3, abs=1e-3 * np.abs(right.strain).max())
    assert np.abs(found["m"].history.strain - right.strain).max() > 5e-3 * np.abs(right.strain).max()
    fine = ran(case_of(tolerance=0.04, r=gauges["r"]))["r"]
    assert abs(fine.peak_strain[0] - found["r"].peak_strain[0]) < found["r"].peak_error[0] + fine.peak_error[0]
    assert found["r"].peak_error[0] < 0.1 * found["r"].peak_strain[0]


def test_a_straight_line_between_positions_misses_no_more_than_stated():
    x = np.linspace(0.0, 1.0, 13)
    curve = np.stack([np.sin(3.0 * x), x], axis=1)
    stated = _between_positions(x, curve)
    fine = np.linspace(x[1], x[-2], 1001)
    missed = np.abs(np.interp(fine, x, curve[:, 0]) - np.sin(3.0 * fine))
    assert missed.max() == pytest.approx(stated[:, 0].max(), rel=0.05)
    assert stated[:, 1].max() < 1e-15
    assert _between_positions(x[:2], curve[:2]).max() == 0.0
    # a jump of which both sides are known is no error, and its sides err as their neighbours
    jumping, place = np.insert(x, 7, x[6] + 1e-6), np.arange(14) > 6
    beside = _between_positions(jumping, (np.sin(3.0 * jumping) + 5.0 * place)[:, None])[:, 0]
    assert beside.max() < 1.3 * stated[:, 0].max()
    assert beside.min() > 0.0
