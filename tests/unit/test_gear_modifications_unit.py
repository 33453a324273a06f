"""What is ground off the flanks stands in the gear data, and safeties where a rating was asked for."""

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.engine.value import Value
from fegear.output.report.gear_data import rated_columns
from fegear.results.gear.geometry import drawing_of, pair_table


def table(**keys):
    a = {"teeth": 28, "module": "3 mm", "face_width": "20 mm"}
    document = {
        "results": ["geometry"],
        "gear": {"a": a | keys, "b": a},
        "pair": {"I": {"driver": "a", "driven": "b"}},
    }
    return pair_table("I", drawing_of(build_scene(document, "c", None)))


def test_every_amount_of_a_drawing_is_listed():
    found = table(
        relief={"tip": [{"amount": "10 um", "length": "1 mm"}, {"amount": "5 um", "length": "2 mm"}],
                "root": {"amount": "4 um", "length": "1 mm"}, "crowning": {"amount": "3 um"}},
        lead={"crowning": "6 um", "slope": "-7 um", "end_relief": {"amount": "8 um", "length": "2 mm", "end": "II"}},
        bias="9 um",
    )  # fmt: skip
    expected = {
        "tip_relief": 15.0, "root_relief": 4.0, "profile_crowning": 3.0, "crowning": 6.0, "helix_slope": -7.0,
        "end_relief_II": 8.0, "bias": 9.0,
    }  # fmt: skip
    for key, amount in expected.items():
        assert found[key].tolist() == pytest.approx([amount, 0.0])
        assert found.column(key).unit == "um"
    assert "end_relief_I" not in found.keys()  # noqa: SIM118  (a table is no mapping)


def test_plain_gears_have_no_rows_of_modifications():
    assert not {"tip_relief", "crowning", "bias"} & set(table().keys())


def test_safeties_of_the_sheet_are_those_of_the_rating():
    values = [Value("I.driver.S_H", 1.23456), Value("I.driven.S_H", 2.0), Value("I.driver.S_F", 3.0)]
    (column,) = rated_columns(values, "I")
    assert column.name == "S_H"
    assert np.asarray(column.si).tolist() == [1.235, 2.0]
    assert rated_columns(values, "II") == ()
