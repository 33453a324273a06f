"""Lead correction: what is stated comes true in a fresh case, and the table for grinding has it."""

import copy
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.design.flanks import lead_correction
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


def coarse(**leads):
    """Two stages that their shafts misalign, without lead modifications but those given [um]; slices, coarse."""
    case = tomllib.loads((CASES / "gearbox_misaligned.toml").read_text(encoding="utf-8"))
    case |= {"accuracy": {"tolerance": 0.3}, "load_distribution": {"positions": 4, "panels": 4}}
    case["bearing"]["ball"]["elements"]["clearance"] = "60 um"
    case["effects"]["relief"] = bool(leads)
    for gear in case["gear"].values():
        gear.pop("lead", None)
    for gear, (slope, crowning) in leads.items():
        case["gear"][gear]["lead"] = {"slope": f"{slope:.6g} um", "crowning": f"{crowning:.6g} um"}
    return case


def run(case, result):
    scene = build_scene({**copy.deepcopy(case), "results": [result]}, "box", Path())
    return run_plan(scene, make_plan(scene, STAGES)).outcomes


@pytest.fixture(scope="module")
def corrected():
    return run(coarse(), "lead-correction")[Task("lead-correction", "all")]


def leads_of(outcome):
    """Amounts by driver [um]."""
    found = dict(zip(("a", "c"), outcome.data.found, strict=True))
    return {gear: (one.slope * 1e6, one.crowning * 1e6) for gear, one in found.items()}


def factors(case):
    """K_Hbeta over the loads of both pairs."""
    found = run(case, "load-distribution")
    return [found[Task("loaded-flanks", pair)].data.stated.face_load_factor for pair in ("I", "II")]


@pytest.mark.dear
def test_a_fresh_case_with_the_corrections_has_the_stated_factors(corrected):
    for one in corrected.data.found:
        assert one.after @ one.loads < one.before @ one.loads
        assert one.left.max() < 0.02
    fresh = factors(coarse(**leads_of(corrected)))
    for one, found in zip(corrected.data.found, fresh, strict=True):
        at = np.isin(np.round(one.loads, 3), np.round(one.loads[-found.size :], 3))
        np.testing.assert_allclose(found, one.after[at], rtol=1e-6)
    second = corrected.data.found[1]
    assert second.before[-1] > 1.25 > 1.15 > second.after[-1]


@pytest.mark.dear
def test_the_table_for_grinding_has_gear_amounts_and_factors(corrected):
    table, *grinding = corrected.tables
    assert [one.name for one in grinding] == ["lead_grinding_II", "lead_grinding_I"]
    assert set(table["gear"]) == {"a", "c"}
    amounts = leads_of(corrected)
    for gear in ("a", "c"):
        rows = np.array(table["gear"]) == gear
        assert np.unique(np.array(table["slope [um]"])[rows]) == pytest.approx(amounts[gear][0])
        (ground,) = (one for one in grinding if one["gear"][0] == gear)
        assert list(ground["modification"]) == ["helix slope", "crowning"]
        assert ground["amount"] == pytest.approx(np.array(amounts[gear]))
    assert all(2.0 * one.slope * 1e6 == pytest.approx(round(2.0 * one.slope * 1e6)) for one in corrected.data.found)
    assert "grind a helix slope" in corrected.answer.sentences[0]
    assert "gear.c.lead" in " ".join(corrected.remarks)


@pytest.mark.dear
def test_present_crowning_is_searched_over_and_the_minimum_is_that_of_all_of_the_grid(corrected, monkeypatch):
    asked, search = [], lead_correction.least_of_grid

    def spied(value, first, longest):
        asked.append((value, search(value, first, longest)))
        return asked[-1][1]

    monkeypatch.setattr(lead_correction, "least_of_grid", spied)
    found = run(coarse(a=(0.3, 5.2), c=(0.0, 6.0)), "lead-correction")[Task("lead-correction", "all")]
    for gear, amounts in leads_of(corrected).items():
        assert leads_of(found)[gear] == pytest.approx(amounts)
    value, (slope, crowning) = asked[-1]
    grid = {(k, n): value(k, n) for k in range(slope - 5, slope + 6, 2) for n in range(0, 7, 2)}
    assert value(slope, crowning) <= min(grid.values())
    for one in found.data.found:
        assert one.kept[-1] > one.after[-1] + 0.1
    (ground,) = (one for one in found.tables if one.name == "lead_grinding_II")
    rows = list(zip(ground["design"], ground["modification"], ground["amount"], strict=True))
    assert rows[2:] == [
        ("lead correction, present crowning", "helix slope", rows[0][2]),
        ("lead correction, present crowning", "crowning", pytest.approx(6.0)),
    ]
    other = "pair II: not recommended is lead correction, present crowning, with a crowning of 6 µm (the present one, "
    assert any(f"{other}for manufacturing deviations): K_Hβ of the loaded flanks 1.35." in one for one in found.remarks)
    assert not any("not recommended" in one for one in corrected.remarks)
    for one in found.answer.sentences:  # one correction, with the values of the table
        assert one.count("K_Hβ") == one.count("helix slope") == 1
    assert "fall without crowning" in " ".join(found.remarks)
    assert not any(one.name == "lead_safety" for one in found.tables)  # nothing is rated


def test_without_misaligned_flanks_there_is_nothing_to_correct():
    case = coarse()
    case["effects"]["misalignment"] = False
    scene = build_scene({**case, "results": ["lead-correction"]}, "box", Path())
    with pytest.raises(InputError, match="misalignment"):
        make_plan(scene, STAGES)
