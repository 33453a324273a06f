"""A tolerance picks settings, is solved to, and tells what it paid; settings that are given are obeyed."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.built.tooth_influence import settings_for
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.fem.plane import solution
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.settings import MeshSettings, settings_at
from fegear.fem.plane.solution import level_for, solve_gear, solve_to_tolerance
from fegear.fem.plane.table import stiffness_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES


def steel_gear():
    return Gear(Tooth(23), 1e-3, 5e-3)


def run(folder, **accuracy):
    document = {
        "results": ["stiffness"],
        "gear": {"a": {"teeth": 23, "module": "1 mm", "bore_radius": "5 mm"}},
        "stiffness": {"positions": 5, "contact_half_width": "0.02 mm"},
        "accuracy": accuracy,
    }
    scene = build_scene(document, "tolerance", folder)
    results = run_plan(scene, make_plan(scene, STAGES))
    table = results.outcomes[Task("stiffness", "a")]
    return replace(table, remarks=results.remarks)


def test_finer_tolerances_start_with_finer_settings_of_one_ladder():
    edges = [settings_for(10.0**-k).root_edge_length for k in (1, 2, 3, 4, 5, 6)]
    assert all(coarser > finer for coarser, finer in itertools.pairwise(edges))
    assert settings_for(0.5) == settings_for(0.1)  # a coarser mesh saves next to nothing
    assert settings_for(1e-4) == settings_at(0) == MeshSettings()
    assert settings_for(1e-3).root_edge_length == pytest.approx(2.0 * MeshSettings().root_edge_length)
    # Between the tolerances that were learned the finer half of a level is taken, and beyond them the last.
    assert [level_for(t) for t in (0.5, 0.05, 1e-2, 3e-3, 2e-3, 1e-3, 5e-4, 1e-4)] == [
        -6,
        -5.5,
        -4,
        -3,
        -2.5,
        -2,
        -1,
        0,
    ]


def test_a_missed_tolerance_is_refined_and_its_error_estimated_on_the_same_mesh(monkeypatch):
    monkeypatch.setattr(solution, "level_for", lambda _tolerance: -3)
    cache = SolutionCache()
    known = solve_to_tolerance(steel_gear(), 2e-4, cache=cache)
    assert len(known.rounds) > 1
    assert cache.shapes.computed == len(known.rounds)
    assert [one.error <= 2e-4 for one in known.rounds] == [False] * (len(known.rounds) - 1) + [True]
    assert known.rounds[-1].errors == pytest.approx(known.largest_errors(), rel=1e-6)
    # Levels fall the error by three times on average: one round more, where whole levels one by one took two.
    assert len(known.rounds) == 2
    level = -3 + solution.levels_finer(known.rounds[0].error / 2e-4)
    assert known.settings == settings_at(level)
    assert -2 < level <= -1
    assert known.coarse.mesh is known.fine.mesh
    assert known.coarse.flank.order == known.fine.flank.order - 1
    assert known.coarse.corner_distance > known.fine.corner_distance
    sizes = [one.unknowns for one in known.rounds]
    assert sizes == sorted(sizes)
    assert known.seconds["total"] == pytest.approx(sum(one.seconds for one in known.rounds))


@pytest.mark.parametrize(
    ("teeth", "rack", "level"),
    [
        (60, BasicRack(1.0, 1.25, 0.38), -4.5),
        (60, BasicRack(0.8, 1.0, 0.4), -4.0),
        (13, BasicRack(1.1, 1.42, 0.14, np.radians(14.5)), -4.0),
    ],
)
def test_a_tolerance_of_a_hundredth_starts_finer_where_the_fillet_has_few_edges_or_many(teeth, rack, level):
    """Of forty gears seven, all with short fillets, were solved twice; of long ones too small an error was stated."""
    tooth = Tooth(teeth, rack)
    assert solution.first_level(tooth, 1e-2) == level
    known = solve_to_tolerance(Gear(tooth, 1e-3, 0.5e-3 * tooth.root_radius), 1e-2)
    assert known.settings == settings_at(level)
    assert len(known.rounds) == 1
    assert solution.first_level(tooth, 1e-3) == -2
    assert solution.first_level(tooth, 0.5) == -6


@pytest.mark.parametrize(
    ("excess", "levels"), [(1.0 + 1e-9, 0.5), (1.5, 0.5), (1.6, 1.0), (3.0, 1.5), (6.0, 2.0), (1e9, 2.0)]
)
def test_a_tolerance_that_is_missed_by_little_is_refined_by_little(excess, levels):
    """Every miss took a whole level: of an excess of a tenth a third more of the time than need be."""
    assert solution.levels_finer(excess) == levels


@pytest.mark.parametrize("excess", [np.inf, np.nan])
def test_an_error_that_is_not_known_refines_as_far_as_any(excess):
    assert solution.levels_finer(excess) == 2.0


def test_errors_are_looked_for_once_for_tolerance_and_table(monkeypatch):
    """And with them what is usual over the flank, which every table needs: each load is integrated once."""
    known = solve_to_tolerance(steel_gear(), 1e-2)
    asked, own = [], Influence.self_compliance
    monkeypatch.setattr(Influence, "self_compliance", lambda self, *args: asked.append(self) or own(self, *args))
    radii = [1.1e-2, 1.15e-2, 1.2e-2]
    table = stiffness_table(known.gear, radii, 2e-5, influence=known)
    assert [one is known.coarse for one in asked] == [True]
    # to round-off: a processor may add up one radius otherwise than three
    np.testing.assert_allclose(table.c_self, known.self_compliance(radii, 2e-5), rtol=1e-13)
    assert (table.errors["c_self"] >= known.self_error(radii, 2e-5)).all()
    off = known.root_stress_error(0, "tension", radii, 2e-5)
    np.testing.assert_allclose(table.errors["root_tension"], off, rtol=1e-9)


def test_a_gear_without_a_second_solution_knows_no_error():
    known = solve_gear(steel_gear(), settings_at(-3), estimate_error=False)
    assert np.isnan(list(known.largest_errors().values())).all()
    assert all(np.isnan(one).all() for one in (known.self_error(1.1e-2, 2e-5), known.contact(1.1e-2, 2e-5)[1]))
    assert np.isnan(known.root_stress_error(0, "tension", 1.1e-2)).all()
    assert known.neighbour_error(1, [1.1e-2, 1.2e-2], [1.1e-2]).shape == (2, 1)


def test_refinement_ends_at_the_finest_level_and_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(solution, "level_for", lambda _tolerance: -3)
    monkeypatch.setattr(solution, "FINEST_LEVEL", -2)
    outcome = run(tmp_path, tolerance=1e-6)
    assert len(outcome.settings["rounds"]) == 2
    said = [remark for remark in outcome.remarks if "mesh refined once for tolerance 0.0001 %" in remark]
    assert len(said) == 1
    assert "the last mesh (finest allowed) is used although" in said[0]
    assert any("at radius" in remark and "c_self" in remark for remark in outcome.remarks)


def test_what_a_tolerance_cost_is_reported_round_by_round(tmp_path):
    outcome = run(tmp_path, tolerance=0.1)
    (only,) = outcome.settings["rounds"]
    assert set(only) == {"root_edge_length", "unknowns", "estimated_error", "seconds"}
    assert max(only["estimated_error"].values()) <= 0.1
    assert only["root_edge_length"] == outcome.settings["root_edge_length"] == settings_for(0.1).root_edge_length
    assert not any("refined" in remark for remark in outcome.remarks)


def test_given_settings_are_obeyed_without_refinement(tmp_path):
    outcome = run(tmp_path, tolerance=1e-5, order=2, root_edge_length=0.2, flank_edge_length=0.2)
    assert "rounds" not in outcome.settings
    assert (outcome.settings["order"], outcome.settings["root_edge_length"]) == (2, 0.2)
    assert outcome.settings["growth"] == settings_for(1e-5).growth
    assert any("estimated error of root tension up to" in remark for remark in outcome.remarks)


@pytest.mark.parametrize(("tolerance", "most"), [(1e-1, 3000), (1e-2, 6000), (1e-3, 9000), (1e-4, 20_000)])
def test_a_tolerance_is_met_by_few_unknowns_and_its_estimate_by_fewer(tolerance, most):
    """It took 4,200, 14,000 and 49,000 unknowns of meshes that spent them elsewhere than at the fillets."""
    known = solve_to_tolerance(steel_gear(), tolerance)
    assert len(known.rounds) == 1
    assert known.rounds[0].error <= tolerance
    assert known.coarse is not None
    assert known.coarse.unknowns < known.fine.unknowns < most
