"""Measured natural frequencies beside computed ones."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.dynamics.train.measured_modes import beside_modes
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASE = Path(__file__).parents[2] / "cases" / "four_square_dynamics.toml"


def test_frequencies_with_one_factor_and_gaps_are_found_again():
    computed = np.array([400.0, 900.0, 950.0, 2100.0, 5000.0])
    found = beside_modes(0.97 * computed[[4, 0, 2]], computed)
    assert found.mode.tolist() == [1, 3, 5]
    assert found.mean_ratio == pytest.approx(0.97)
    assert found.scatter == pytest.approx(0.0, abs=1e-12)
    assert found.verdict.startswith("3.0 % below the computed ones on average")
    assert "a stiffness 5.9 % lower" in found.verdict


def test_frequencies_without_a_common_factor_name_no_stiffness():
    found = beside_modes(np.array([180.0, 2410.0]), np.array([82.0, 5180.0]))
    assert found.scatter > 0.5
    assert "no common factor; check which modes they are" in found.verdict
    assert "stiffness" not in found.verdict
    assert "a stiffness" in beside_modes(np.array([84.0, 5100.0]), np.array([82.0, 5180.0])).verdict


@pytest.mark.parametrize("seed", range(6))
def test_the_assignment_is_that_of_trying_all(seed):
    rng = np.random.default_rng(seed)
    computed = np.sort(rng.uniform(100.0, 5000.0, 6))
    measured = rng.uniform(100.0, 5000.0, 3)
    found = beside_modes(measured, computed)
    scaled = np.sort(measured) / found.mean_ratio
    costs = {c: (np.log(scaled / computed[list(c)]) ** 2).sum() for c in combinations(range(6), 3)}
    best = min(costs, key=costs.get)
    assert (np.log(found.ratio / found.mean_ratio) ** 2).sum() == pytest.approx(costs[best])
    assert found.mode.tolist() == [k + 1 for k in best]
    assert found.scatter == pytest.approx((found.ratio / found.mean_ratio).std())


def ran(*overrides):
    scene = read_scene(CASE, ['results=["natural-modes"]', *overrides])
    return run_plan(scene, make_plan(scene, STAGES)).outcomes[Task("natural-modes")]


def test_a_case_lays_them_beside_its_modes():
    plain = ran()
    natural = np.array(list(plain.data.flexible.values()))
    assert plain.data.measured is None
    assert not any("easured" in remark for remark in plain.remarks)
    typed = ", ".join(f'"{1.02 * f:.9g} Hz"' for f in natural[:2])
    found = ran(f"dynamics.measured_frequencies=[{typed}]")
    values = {value.name: value.si for value in found.values}
    assert values["measured_frequency_ratio"] == pytest.approx(1.02)
    assert values["measured_frequency_scatter"] == pytest.approx(0.0, abs=1e-8)
    table = next(one for one in found.tables if one.name == "measured_frequencies")
    assert table.columns[0].si.tolist() == [1, 2]
    assert any("2.0 % above the computed ones on average" in remark for remark in found.remarks)
    many = ", ".join(f'"{100 + k} Hz"' for k in range(natural.size + 1))
    with pytest.raises(InputError, match=r"dynamics\.measured_frequencies"):
        ran(f"dynamics.measured_frequencies=[{many}]")
