"""A formula that fails takes neither the other results of its run nor its own other numbers with it."""

from __future__ import annotations

import pytest

from fegear.workbench.run import run

GEAR = {
    "module": "3 mm", "face_width": "20 mm", "tolerance_class": 6, "strength": {"material": "case-hardened-steel"},
    "roughness": {"flank": "0.5 um", "root": "2 um"},
}  # fmt: skip
SPECTRUM = [{"load_factor": 1.0, "share": 0.5}, {"load_factor": 0.5, "speed": "9000 rpm", "share": 0.5}]


def case(*results: str, method: str = "B", **operation: object) -> dict:
    pair = {
        "driver": "a", "driven": "b", "torque": "100 N m", "speed": "300 rpm", "operation": operation,
        "iso_6336": {"dynamic_method": method},
        "lubricant": {"viscosity_40": "220 mm^2/s", "temperature": "70 degC"},
    }  # fmt: skip
    return {
        "results": list(results), "rating": {"beside": []}, "pair": {"I": pair},
        "gear": {"a": {"teeth": 25, **GEAR}, "b": {"teeth": 60, **GEAR}},
    }  # fmt: skip


def numbers(found) -> dict[str, float]:
    return {value.name.removeprefix("I."): value.value for value in found.values}


def notes(found) -> list[str]:
    return [note for outcome in found.outcomes.values() for note in outcome.remarks]


def test_a_level_that_a_formula_does_not_know_leaves_the_rating_at_the_nominal_load():
    """K_v of method C knows no pair as fast as its second level; there was no rating at all, and no run."""
    found = run(case("geometry", "rating", method="C", life="100 h", spectrum=SPECTRUM), progress=False)
    plain = run(case("geometry", "rating", method="C", life="100 h"), progress=False)
    assert any("rating with load spectrum not possible: v z_1/100" in note for note in notes(found))
    for one in ("driver.S_H", "driven.S_F", "K_v_rated"):
        assert numbers(found)[one] == pytest.approx(numbers(plain)[one], rel=1e-12)
    assert not any("spectrum" in value.name for value in found.values)
