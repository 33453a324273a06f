"""Three cases solved whole by scikit-fem alone: every difference lies within what is stated of the error."""

from pathlib import Path

import pytest

from fegear.case.reading import read_scene
from fegear.studies.check import check_gear, gears_to_check

CASES = Path(__file__).parents[2] / "cases"


@pytest.mark.long
@pytest.mark.parametrize("case", ["lin_table1", "thin_rim", "high_contact_ratio"])
def test_stated_errors_cover_what_scikit_fem_finds_on_the_whole_gear(case):
    scene = read_scene(CASES / f"{case}.toml", ())
    for name in gears_to_check(scene):
        compared = check_gear(scene, name, 3).compared
        assert len(compared) == 15
        for one in compared:
            assert one.difference <= one.stated_error, one
            assert one.difference < 5e-4
