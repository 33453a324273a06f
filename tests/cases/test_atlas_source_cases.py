"""Cases whose plane gears come from an atlas in place of being solved: the same numbers, and every run says which."""

from __future__ import annotations

from pathlib import Path

import pytest
from solved_once import CACHE

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

TEXT = """
results = ["transmission-error", "root-stress-history"]
gear.a = {teeth = 24, module = "3 mm", profile_shift = 0.2, face_width = "20 mm", bore_radius = "17 mm", rack = "A"}
gear.b = {teeth = 41, module = "3 mm", face_width = "20 mm", bore_radius = "30 mm", rack = "A"}
pair.I = {driver = "a", driven = "b", torque = "100 N m", speed = "1000 rpm"}
effects = {neighbour_coupling = true, hertz = "load-dependent", corner_contact = true}
"""
OTHER = "gear.b.rack={dedendum = 1.3, tip_radius = 0.38}"


def planned(folder: Path, *overrides: str):
    path = folder / "pair.toml"
    path.write_text(TEXT.replace('"A"', '"ISO 53 A"'), "utf-8")
    scene = read_scene(path, overrides)
    return scene, make_plan(scene, STAGES)


def run(folder: Path, *overrides: str):
    results = run_plan(*planned(folder, *overrides), cache=CACHE)
    notes = [str(note) for outcome in results.outcomes.values() for note in outcome.remarks]
    return {value.name: value for value in results.values}, notes, {task.stage for task in results.outcomes}


@pytest.mark.dear
def test_a_pair_from_an_atlas_has_the_numbers_of_a_solved_one(tmp_path):
    solved, said, stages = run(tmp_path)
    assert "atlas-gear" not in stages
    assert not any("atlas" in note for note in said)
    known, notes, stages = run(tmp_path, 'accuracy.source="atlas"')
    assert "gear-solution" not in stages
    assert sum("interpolated from an atlas of solved gears; estimated errors" in note for note in notes) == 2
    assert known.keys() == solved.keys()
    roots = ("I.driver.largest_root_tension", "I.driven.largest_root_compression")
    for name in ("I.te_mean", "I.te_peak_to_peak", *roots):
        one, other = known[name], solved[name]
        assert abs(one.value - other.value) < 1.5 * (one.error + other.error)
        assert one.error < 5e-3 * abs(one.value)


@pytest.mark.dear
def test_auto_solves_what_the_atlas_has_not_and_says_so(tmp_path):
    values, notes, stages = run(tmp_path, 'accuracy.source="auto"', OTHER)
    assert {"atlas-gear", "gear-solution"} <= stages
    assert any("Gear a: compliance and root stress interpolated" in note for note in notes)
    why = "solved by finite elements, not taken from an atlas (rack.dedendum = 1.3: must be 1.25 in this atlas)"
    assert any(f"Gear b: {why}" in note for note in notes)
    assert values["I.te_mean"].value == pytest.approx(run(tmp_path, OTHER)[0]["I.te_mean"].value, rel=2e-3)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (OTHER, r"gear\.b\.rack\.dedendum = 1\.3: must be 1\.25 in this atlas"),
        ("gear.b.teeth=420", r"gear\.b\.teeth = 420: is outside the range of the atlas, 12 to 400"),
    ],
)
def test_what_no_atlas_has_is_refused_with_its_key(tmp_path, change, text):
    with pytest.raises(InputError, match=text):
        planned(tmp_path, 'accuracy.source="atlas"', change)


def test_auto_solves_where_the_tolerance_is_finer_than_the_atlas(tmp_path):
    _, plan = planned(tmp_path, 'accuracy.source="auto"', "accuracy.tolerance=1e-4")
    assert [step.task.stage for step in plan.steps].count("gear-solution") == 2
    assert "atlas-gear" not in [step.task.stage for step in plan.steps]
