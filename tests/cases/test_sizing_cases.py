"""Sizing: feasible variants against plain loops over pairs, killed at random, any number of workers, the atlas."""

from __future__ import annotations

import itertools
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import FegearError, InputError
from fegear.base.solution_cache import SolutionCache, cache_on_disk
from fegear.case.built.rated_pair import pair_to_rate
from fegear.case.reading import build_scene
from fegear.case.sizing import SizingPart
from fegear.design.sizing.front import best_by_fronts, pareto_front
from fegear.design.sizing.limits import SizingLimits
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.iso6336.safety import rate_pair
from fegear.geometry.checks import tip_thickness
from fegear.geometry.involute import inv, pressure_angle_of_inv
from fegear.geometry.pair import MEMBERS
from fegear.geometry.path_of_contact import specific_sliding
from fegear.results.catalogue import STAGES
from fegear.results.sizing.applied_variant import text_of_variant
from fegear.results.sizing.basis import space_of
from fegear.results.sizing.variant_case import case_of_variant

REQUIREMENT = {
    "power": "2.9 kW",
    "speed": "725 rpm",
    "ratio": 2.5,
    "ratio_tolerance": 0.01,
    "strength": {"material": "18CrNiMo7-6"},
    "operation": {"application_factor": 1.25, "life": "5000 h"},
}
#: 112 mm, 2.9 kW, 725 to 287.5 rpm, and another free one.
FIXED = {
    **REQUIREMENT, "centre_distance": "112 mm", "face_width": "35 mm", "normal_modules": ["2.5 mm", "3 mm"],
    "pinion_teeth": [18, 26], "helix_angles": ["0 deg", "12 deg"], "pinion_shifts": [-0.2, 0.1, 0.4, 0.7],
    "criteria": ["safety", "mass", "sliding"], "verified": 0,
}  # fmt: skip
FREE = {
    **REQUIREMENT, "ratio": 4, "centre_distance": ["90 mm", "120 mm"], "width_ratios": [0.6, 0.9],
    "normal_modules": ["1.5 mm", "2 mm"], "pinion_teeth": [17, 21], "pinion_shifts": [0.0, 0.3, 0.6],
    "shift_sums": [-0.2, 0.4], "criteria": ["mass", "loss"], "verified": 0,
}  # fmt: skip


def sized(asked: dict, *, cache: SolutionCache | None = None, executor: Executor | None = None):
    scene = build_scene({"results": ["sizing"], "sizing": asked}, "sized", Path())
    results = run_plan(
        scene, make_plan(scene, STAGES), cache=cache or SolutionCache(), executor=executor or Executor(here=True)
    )
    tables = {table.name: {c.name: c.si for c in table.columns} for table in results.tables}
    return results, tables


def all_notes(results):
    return [note for outcome in results.outcomes.values() for note in outcome.remarks]


def by_plain_loops(asked: dict) -> tuple[int, dict[tuple, tuple[float, ...]]]:
    """All variants one by one, through the case of each: how many there are, and the costs of those that live."""
    limits, enumerated, feasible = SizingLimits(), 0, {}
    alpha = math.radians(20.0)
    widths = [asked["face_width"]] if "face_width" in asked else asked["width_ratios"]
    fixed = isinstance(asked["centre_distance"], str)
    for m_text, beta_text, width in itertools.product(
        asked["normal_modules"], asked.get("helix_angles", ["0 deg"]), widths
    ):
        m, beta = float(m_text.split()[0]), math.radians(float(beta_text.split()[0]))
        a_t = math.atan(math.tan(alpha) / math.cos(beta))
        low, high = asked["pinion_teeth"]
        tolerance = asked["ratio_tolerance"]
        for z_1, z_2 in itertools.product(range(low, high + 1), range(low, 140)):
            if abs(z_2 / z_1 / asked["ratio"] - 1.0) > tolerance + 1e-12:
                continue
            pitch = 0.5 * m * (z_1 + z_2) / math.cos(beta)
            for total in [None] if fixed else asked["shift_sums"]:
                for x_1 in asked["pinion_shifts"]:
                    enumerated += 1
                    if total is None:
                        a = float(asked["centre_distance"].split()[0])
                        cosine = pitch * math.cos(a_t) / a
                        if cosine >= 1.0:
                            continue
                        total_here = (z_1 + z_2) * float(inv(math.acos(cosine)) - inv(a_t)) / (2.0 * math.tan(alpha))
                    else:
                        total_here = total
                        value = float(inv(a_t)) + 2.0 * total * math.tan(alpha) / (z_1 + z_2)
                        a = pitch * math.cos(a_t) / math.cos(float(pressure_angle_of_inv(value)))
                    if not fixed and not 90.0 <= a <= 120.0:
                        continue
                    if not -1.0 <= total_here <= 1.5:
                        continue
                    if isinstance(width, str):
                        b = float(width.split()[0])
                    else:
                        b = math.ceil(width * m * z_1 / math.cos(beta) - 1e-6)
                    costs = one_by_one(asked, limits, (z_1, z_2), (x_1, total_here - x_1), m, beta, a, b)
                    if costs is not None:
                        feasible[z_1, z_2, m, round(math.degrees(beta)), x_1, total, b] = costs
    return enumerated, feasible


def one_by_one(asked, limits, z, x, m, beta, a, b) -> tuple[float, ...] | None:
    """The costs of a variant by its own case; None where it breaks a limit."""
    from fegear.design.sizing.space import Variant

    moved = min((a - 0.5 * m * sum(z) / math.cos(beta)) / m - sum(x), 0.0)
    tips = tuple(1e-3 * m * (zi / math.cos(beta) + 2.0 * (1.0 + xi + moved)) for zi, xi in zip(z, x, strict=True))
    variant = Variant(
        z, x, tips, m * 1e-3, math.radians(20.0), beta, 1.0, 1.25, 0.38, a * 1e-3, b * 1e-3
    )  # fmt: skip
    try:
        scene = build_scene(case_of_variant(asked, variant, ["rating"]), "one", Path())
    except FegearError:
        return None
    pair = scene.pairs["I"]
    gears = (pair.driver, pair.driven)
    if any(gear.tooth.undercut for gear in gears):
        return None
    reach = [pair.x_of_radius(gears[1 - i].involute_tip_radius, MEMBERS[1 - i]) for i in (0, 1)]
    starts = [pair.x_of_radius(gears[i].form_radius, MEMBERS[i]) for i in (0, 1)]
    if reach[0] < starts[0] - 1e-9 * m or reach[1] > starts[1] + 1e-9 * m:
        return None
    sliding = min(
        float(specific_sliding(pair, at, member))
        for at, member in zip((pair.x_start, pair.x_end), MEMBERS, strict=True)
    )
    kept = (
        min(tip_thickness(gear) / (m * 1e-3) for gear in gears) >= limits.tip_thickness,
        pair.contact_ratio >= limits.contact_ratio,
        min(pair.tip_clearance(member) / (m * 1e-3) for member in MEMBERS) >= limits.tip_clearance,
        sliding >= limits.specific_sliding,
        b * 1e-3 <= limits.width_ratio * 2.0 * pair.driver.pitch_radius,
    )
    if not all(kept):
        return None
    try:
        rated = rate_pair(pair_to_rate(scene, "I").conditions)
    except FegearError:
        return None
    s_h, s_f = min(rated.contact_safety), min(rated.bending_safety)
    if s_h < 1.0 or s_f < 1.4:
        return None
    discs = [(0.5 * (2.0 * g.tip_radius + 2.0 * g.root_radius)) ** 2 - g.root_radius**2 for g in gears]
    one, two = pair.x_end / pair.base_pitch, -pair.x_start / pair.base_pitch
    factor = math.pi * (1.0 / z[0] + 1.0 / z[1])
    of = {
        "safety": -min(s_h**2, s_f / 1.4),
        "mass": 7850.0 * b * 1e-3 * 0.25 * math.pi * sum(discs),
        "sliding": -sliding,
        "centre-distance": a * 1e-3,
        "loss": factor * (1.0 - one - two + one**2 + two**2),
    }
    return tuple(of[name] for name in asked["criteria"])


def front_by_loops(costs: dict[tuple, tuple[float, ...]]) -> set[tuple]:
    front = set()
    for key, own in costs.items():
        beaten = any(
            all(p <= q * (1.0 + 1e-9 * math.copysign(1.0, q)) for p, q in zip(other, own, strict=True))
            and any(p < q - 1e-9 * abs(q) for p, q in zip(other, own, strict=True))
            for other in costs.values()
        )
        if not beaten:
            front.add(key)
    return front


@pytest.mark.parametrize("asked", [FIXED, pytest.param(FREE, marks=pytest.mark.dear)], ids=["fixed", "free"])
def test_plain_loops_over_single_pairs_find_the_same_variants_and_the_same_front(asked):
    enumerated, feasible = by_plain_loops(asked)
    results, tables = sized(asked)
    values = {value.name: value.si for value in results.values}
    assert values["sizing.variants"] == enumerated
    assert values["sizing.variants_feasible"] == len(feasible)
    assert sum(tables["excluded_variants"]["variants"]) + len(feasible) == enumerated
    front, table = front_by_loops(feasible), tables["sizing"]
    assert values["sizing.variants_on_front"] == len(front)
    assert 3 < len(front) < len(feasible)
    fixed = isinstance(asked["centre_distance"], str)
    found = {
        (
            int(table["z_1"][n]), int(table["z_2"][n]), round(table["normal_module"][n] * 1e3, 9),
            round(math.degrees(table["helix_angle"][n])), round(table["x_1"][n], 9),
            None if fixed else round(table["x_1"][n] + table["x_2"][n], 9), round(table["face_width"][n] * 1e3, 9),
        )
        for n in range(len(table["z_1"]))
    }  # fmt: skip
    assert found == front
    best = next(iter(sorted(front)))
    n = next(n for n in range(len(found)) if (table["z_1"][n], round(table["x_1"][n], 9)) == (best[0], best[4]))
    assert table["place"].min() >= 1
    assert np.isfinite(table["load_margin"][n])


def test_a_present_design_that_interferes_is_placed_with_its_reasons():
    present = {
        "teeth": [23, 58], "normal_module": "2.75 mm", "helix_angle": "12 deg", "profile_shift": [0.0, -0.6336],
        "face_width": "35 mm",
    }  # fmt: skip
    asked = {**FIXED, "ratio": 2.5217, "ratio_tolerance": 0.03, "present": present}
    results, tables = sized(asked)
    (said,) = [sentence for sentence in results.answer.sentences if "Present design (23/58 teeth" in sentence]
    assert "breaks interference" in said
    (said,) = [str(note) for note in all_notes(results) if "in place of 112 mm" in note]
    assert said.startswith("Present design: centre distance 112.00")
    assert 112e-3 < tables["present_design"]["centre_distance"][0] < 112.01e-3
    placed = tables["placed_design"]
    assert list(placed["criterion"]) == asked["criteria"]
    assert (placed["better"] > 0).any()
    own = tables["present_design"]
    assert own["S_H"][0] == pytest.approx(1.73, abs=0.15)


def test_a_present_design_that_cannot_be_rated_is_behind_every_variant_that_is_no_heavier():
    present = {
        "teeth": [11, 41], "normal_module": "2.5 mm", "helix_angle": "14 deg", "profile_shift": [0.3, -1.0506],
        "face_width": "25 mm",
    }  # fmt: skip
    asked = {
        **FIXED, "power": "1 kW", "centre_distance": "65 mm",
        "ratio": 3.7273, "ratio_tolerance": 0.03, "face_width": "25 mm",
        "pinion_teeth": [16, 24], "normal_modules": ["1.5 mm"], "criteria": ["safety", "mass"],
        "helix_angles": ["14 deg"], "pinion_shifts": {"start": -0.2, "stop": 0.6, "count": 9},
        "present": present,
    }  # fmt: skip
    results, tables = sized(asked)
    (said,) = [sentence for sentence in results.answer.sentences if "Present design (11/41 teeth" in sentence]
    assert "breaks undercut, interference" in said
    assert said.endswith("not rated.")
    assert any("is better than the present design by all criteria" in sentence for sentence in results.answer.sentences)
    better = dict(zip(tables["placed_design"]["criterion"], tables["placed_design"]["better"], strict=True))
    assert better["safety"] == results_of(results)["sizing.variants_feasible"]


def results_of(results):
    return {value.name: value.si for value in results.values}


def test_reasons_name_what_a_requirement_without_a_design_breaks():
    results, tables = sized({**FIXED, "power": "2900 kW"})
    assert results.answer.sentences[0].startswith("None of ")
    assert "S_H" in results.answer.sentences[0]
    assert "sizing" not in tables
    with pytest.raises(InputError, match="is not met by any numbers of teeth"):
        sized({**FIXED, "ratio": 2.517, "ratio_tolerance": 0.0})
    with pytest.raises(InputError, match=r"sizing\.operation"):
        sized({**FIXED, "operation": {"life": "1e-9 s"}})


def test_a_range_of_shifts_may_begin_or_end_at_zero():
    for low, high in ((0.0, 0.4), (-0.4, 0.0)):
        spaced = {"start": low, "stop": high, "count": 3}
        results, _ = sized({**FIXED, "pinion_shifts": spaced, "helix_angles": ["0 deg"], "normal_modules": ["3 mm"]})
        listed, _ = sized(
            {**FIXED, "pinion_shifts": [low, 0.5 * (low + high), high], "helix_angles": ["0 deg"],
             "normal_modules": ["3 mm"]}
        )  # fmt: skip
        assert [value.si for value in results.values] == [value.si for value in listed.values]


def test_fronts_of_equal_costs_keep_all_and_larger_fronts_are_thinned_evenly():
    costs = np.array([[1.0, 2.0], [2.0, 1.0], [1.0, 2.0], [2.0, 2.0], [1.5, 1.5]])
    assert pareto_front(costs).tolist() == [0, 1, 2, 4]
    assert best_by_fronts(costs, 5).tolist() == [0, 1, 2, 3, 4]
    line = np.array([[k, 10.0 - k] for k in range(11)])
    assert best_by_fronts(line, 3).tolist() == [0, 5, 10]


RELIEVED = {
    **FIXED, "helix_angles": ["0 deg"],
    "criteria": ["relieved-transmission-error", "transmission-error", "root-stress"],
    "relieved": 3, "verified": 1, "normal_modules": ["3 mm"], "tolerance": 0.05, "torques": ["15 N*m", "30 N*m"],
}  # fmt: skip


def not_solved(point, cache):
    """In place of finite elements: numbers that depend on the case."""
    text = repr([point["document"], point["estimates"]])
    return {"te": 1e-6 + 1e-9 * (sum(map(ord, text)) % 97), "te_error": 1e-9, "root_stress": 1e8}


@pytest.mark.dear
def test_a_sizing_that_is_killed_anywhere_goes_on_to_the_same_table(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_CACHE", str(tmp_path / "cache"))
    import fegear.engine.executor as executor
    import fegear.results.sizing.by_atlas as by_atlas
    import fegear.results.sizing.by_fe as by_fe

    asked = {**RELIEVED, "verified": 4, "rack_tip_radius": 0.38}
    monkeypatch.setattr(by_atlas, "_PART", 2)
    monkeypatch.setattr(by_atlas, "_RELIEVED", 1)
    monkeypatch.setattr(by_fe, "compute_variant", not_solved)
    alone, left, done, rng = executor.here, [10**6], [0], np.random.default_rng(5)

    def killed(function, point, cache):
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        found = alone(function, point, cache)
        done[0] += 1
        return found

    monkeypatch.setattr(executor, "here", killed)
    _, whole = sized(asked)
    points, done[0], kills = done[0], 0, 0
    while True:
        left[0] = int(rng.integers(0, 4))
        try:
            _, again = sized(asked, cache=cache_on_disk())
            break
        except KeyboardInterrupt:
            kills += 1
    assert kills > 2
    assert done[0] == points > 6  # none was computed twice
    for name, column in whole["sizing"].items():
        assert np.array_equal(np.asarray(column), np.asarray(again["sizing"][name]), equal_nan=column.dtype.kind == "f")


@pytest.mark.dear
def test_estimates_and_verified_numbers_are_those_of_the_variants_own_cases(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_CACHE", str(tmp_path / "cache"))
    asked = RELIEVED
    scene = build_scene({"results": ["sizing"], "sizing": asked}, "sized", Path())
    results = run_plan(scene, make_plan(scene, STAGES), cache=cache_on_disk(), executor=Executor(here=True))
    tables = {table.name: table for table in results.tables}
    table = {column.name: np.asarray(column.si) for column in tables["sizing"].columns}
    number = int(table["variant"][0])
    text, said = text_of_variant(scene.document, tables, number, "results/sized")
    assert f"variant {number}" in said
    own = tomllib.loads(text) | {"results": ["transmission-error", "root-stress-history", "rating"], "neglected": False}
    assert own["gear"]["pinion"]["relief"]["tip"]["amount"] == f"{table['relief_amount'][0] * 1e6:.6g} um"
    own["accuracy"] = {"tolerance": 0.05}
    for relieved in (True, False):
        own["effects"]["relief"] = relieved
        case = build_scene(own, "own", Path())
        found = run_plan(case, make_plan(case, STAGES), cache=cache_on_disk())
        (loads,) = [one for one in found.tables if one.name == "transmission_error_summary_I"]
        columns = {column.name: np.asarray(column.si) for column in loads.columns}
        counts = np.isclose(columns["driver_torque"][:, None], [15.0, 30.0], rtol=1e-9).any(axis=1)
        name = "te_relieved" if relieved else "te"
        verified, error = table[f"{name}_verified"][0], table[f"{name}_verified_error"][0]
        assert columns["te_peak_to_peak"][counts].max() == pytest.approx(verified, rel=1e-9)
        assert table[f"{name}_estimated"][0] == pytest.approx(verified, abs=error + table["te_estimated_error"][0])
    values = {value.name: value.si for value in found.values}
    root = table["root_stress_verified"][0]
    assert max(values[f"I.{member}.largest_root_tension"] for member in MEMBERS) == pytest.approx(root, rel=1e-9)
    assert table["root_stress_estimated"][0] == pytest.approx(root, rel=1e-2)
    s_h = min(values["I.driver.S_H"], values["I.driven.S_H"])
    assert s_h == pytest.approx(table["S_H"][0], rel=1e-11)
    assert 0.0 < table["te_relieved_verified"][0] < 0.9 * table["te_verified"][0]
    with pytest.raises(InputError, match="not in the table of variants"):
        text_of_variant(scene.document, tables, 10**6, "results/sized")


@pytest.mark.dear
def test_the_best_relief_is_that_of_a_plain_scan_of_amounts():
    from fegear.atlas.many_pairs import known_pairs, spur_pairs
    from fegear.atlas.shipped import shipped_atlas
    from fegear.contact.many.arrays import ManyReliefs
    from fegear.contact.many.many_load_sharing import transmission_errors
    from fegear.design.sizing.by_atlas import AtlasDuty, bare_errors, relieved_errors

    space = space_of(SizingPart.model_validate(
        {**FIXED, "helix_angles": ["0 deg", "12 deg"], "pinion_shifts": [0.1, 0.4], "normal_modules": ["3 mm"]}
    ))  # fmt: skip
    pairs = space.pairs(np.arange(space.count))
    duty = AtlasDuty((15.0, 30.0), 206.8e9, 0.3)
    bare, best = bare_errors(pairs, duty), relieved_errors(pairs, duty)
    held = np.isfinite(bare.te)
    assert not held[pairs.helix_angle > 0.0].any()
    assert 2 < held.sum() < held.size
    some = pairs.at(held)
    known = known_pairs(shipped_atlas("A"), spur_pairs(some, young_modulus=206.8e9)).engagements
    loads = np.array(duty.torques) / (0.5 * some.base_diameters[0])[:, None]
    flank = known.flanks.highest - known.flanks.lowest
    shape, one = (2, len(some)), best.lengths[:, held]
    start = 1.0 - np.where(one > 0.0, one, 0.5 * flank) / flank
    for amount in np.arange(0.5e-6, 12e-6, 0.25e-6):
        reliefs = ManyReliefs(np.full(shape, amount), start, np.ones(shape))
        left = transmission_errors(replace(known, reliefs=reliefs), loads).peak_to_peak.max(axis=1)
        assert (left >= 0.97 * best.te[held]).all()
    assert (best.te[held] <= bare.te[held]).all()
    assert (best.amount[held] > 0.0).any()
    assert not relieved_errors(pairs, replace(duty, poisson_ratio=0.4)).at_limit.any()


def test_relief_is_refused_where_no_atlas_contains_a_variant():
    wanted = {**FIXED, "criteria": ["relieved-transmission-error", "mass"]}
    for change in ({}, {"helix_angles": ["0 deg"], "rack_tip_radius": 0.33},
                   {"helix_angles": ["0 deg"], "material": {"poisson_ratio": 0.35}}):  # fmt: skip
        with pytest.raises(InputError, match="requires spur gears of steel"):
            sized({**wanted, **change})


@pytest.mark.long
def test_workers_here_in_processes_and_on_a_cluster_find_the_same_table(monkeypatch, scheduler):
    import fegear.results.sizing.by_atlas as by_atlas

    monkeypatch.setattr(by_atlas, "_PART", 2)
    monkeypatch.setattr(by_atlas, "_RELIEVED", 1)
    executors = (Executor(here=True), Executor(workers=1), Executor(workers=2), Executor(scheduler))
    first, *others = [sized({**RELIEVED, "verified": 2}, executor=one)[1] for one in executors]
    for other in others:
        assert other.keys() == first.keys()
        for table, columns in first.items():
            for name, column in columns.items():
                assert np.array_equal(column, other[table][name], equal_nan=column.dtype.kind == "f")


def test_ratings_of_variants_are_those_of_their_cases_under_a_spectrum_and_on_a_shaft():
    spectrum = [{"load_factor": 1.0, "share": 0.2}, {"load_factor": 0.6, "speed": "900 rpm", "share": 0.8}]
    asked = {
        **FIXED, "pinion_shifts": [0.4], "normal_modules": ["3 mm"], "wheel_strength": {"material": "42CrMo4"},
        "operation": {"spectrum": spectrum, "life": "2000 h", "safety_contact": 0.5, "safety_root": 0.5},
        "shafts": {"arrangement": "a", "bearing_span": "120 mm", "offset": "10 mm", "diameter": "35 mm"},
    }  # fmt: skip
    _, tables = sized(asked)
    table = tables["sizing"]
    scene = build_scene({"results": ["sizing"], "sizing": asked}, "sized", Path())
    results = run_plan(scene, make_plan(scene, STAGES))
    text, _ = text_of_variant(scene.document, {t.name: t for t in results.tables}, 0, "sized")
    case = build_scene(tomllib.loads(text) | {"results": ["rating"]}, "own", Path())
    values = {value.name: value.si for value in run_plan(case, make_plan(case, STAGES)).values}
    for symbol in ("S_H", "S_F"):
        both = [values[f"I.{member}.{symbol}_spectrum"] for member in MEMBERS]
        assert min(both) == pytest.approx(table[symbol][0], rel=1e-10)
    assert replace(SizingLimits(), mass=1.0).mass == 1.0
