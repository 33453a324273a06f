"""Cases with `accuracy.solver = "scikit-fem"`: every table as with the nested dissection."""

from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
#: Of the largest value of a table in the same unit (neighbours are added to c_self); places of a maximum and estimated
#: errors hang on differences of such values.
SAME, SAME_OF_DIFFERENCES = 1e-10, 1e-6
#: A ten-millionth of a base pitch beside a change of contact round-off of the place is 1e-9 of what a pair bears there.
SAME_BESIDE_CHANGES = 5e-8
#: Both solve the same mesh: what they agree on does not depend on how fine it is.
FEW = {
    "nasa_four_square": ('results=["stiffness", "root-stress"]', "accuracy.tolerance=2e-2", "stiffness.positions=8"),
    "pinion_and_wheel": ('results=["stiffness", "load-sharing", "transmission-error"]', "accuracy.tolerance=2e-2"),
    "ring_gear": ('results=["stiffness"]', "accuracy.tolerance=2e-2", "stiffness.positions=8"),
    "own_mesh": ("accuracy.tolerance=2e-2", "stiffness.positions=8"),
    "spur_over_the_face": ("accuracy.tolerance=5e-2", "stiffness.positions=2", "stiffness.face_positions=2"),
}
QUICK = ("ring_gear", "nasa_four_square")


def ran(case: str, solver: str):
    scene = read_scene(CASES / f"{case}.toml", [*FEW[case], f'accuracy.solver="{solver}"'])
    return run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())


@pytest.mark.parametrize(
    "case", [name if name in QUICK else pytest.param(name, marks=pytest.mark.dear) for name in FEW]
)
def test_tables_are_those_of_the_nested_dissection(case):
    plain, other = (ran(case, solver) for solver in ("condensed", "scikit-fem"))
    assert [t.name for t in plain.tables] == [t.name for t in other.tables]
    compared = 0
    for one, two in zip(plain.tables, other.tables, strict=True):
        largest = {}
        for column in one.columns:
            numbers = np.asarray(column.values)
            if numbers.dtype.kind == "f":
                largest[column.unit] = max(largest.get(column.unit, 0.0), np.nanmax(np.abs(numbers), initial=0.0))
        for a, b in zip(one.columns, two.columns, strict=True):
            values = np.asarray(a.values)
            if values.dtype.kind != "f":
                assert list(a.values) == list(b.values)
                continue
            known = np.isfinite(values)
            assert (known == np.isfinite(np.asarray(b.values))).all()
            if not known.any():
                continue
            size = largest[a.unit]
            loose = "error" in a.head or "radius" in a.head or "place" in a.head
            difference = np.abs(values - np.asarray(b.values))[known].max()
            beside = one.name.startswith("transmission_error_") and ("stiffness" in a.head or "te_0" in a.head)
            same = SAME_OF_DIFFERENCES if loose else SAME_BESIDE_CHANGES if beside else SAME
            assert difference <= same * size, (one.name, a.head)
            compared += 1
    assert compared > 5
    said = [str(outcome.settings) for outcome in other.outcomes.values() if outcome.settings]
    assert any("'solver': 'scikit-fem'" in each for each in said)
