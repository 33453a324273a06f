"""Every case gives what is kept of it: see net.py, which also renews what is kept."""

import copy
import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest

_SPEC = importlib.util.spec_from_file_location("golden_net", Path(__file__).with_name("net.py"))
net = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(net)

CHEAPEST = ("litvin_profile_angle", "sources/litvin_eq18")


@pytest.mark.dear("sources/litvin_eq18", "litvin_profile_angle")
@pytest.mark.parametrize("case", CHEAPEST)
def test_the_cheapest_cases_give_what_is_kept(case):
    """But for tenth digits between the samples: another processor rounds some of them the other way."""
    assert [said for said in net.checked(case)[0] if not said.endswith("its samples are the same")] == []


@pytest.mark.long
@pytest.mark.parametrize("case", [case for case in net.cases() if case not in CHEAPEST])
def test_every_case_gives_what_is_kept(case):
    assert net.checked(case)[0] == []


def test_what_is_kept_belongs_to_the_cases_there_are():
    """A case of which nothing is kept yet fails in the long run."""
    kept = {path.relative_to(net.KEPT).with_suffix("").as_posix() for path in net.KEPT.rglob("*.json")}
    assert kept - {*net.cases()} == set()
    assert {*CHEAPEST} <= kept


@pytest.fixture
def kept():
    return json.loads(net.place(CHEAPEST[0]).read_text(encoding="utf-8"))


def test_a_lost_column_a_changed_meaning_and_a_new_remark_are_found(kept):
    found = copy.deepcopy(kept)
    assert net.differences(kept, found) == []
    columns = list(found["columns"])
    del found["columns"][columns[0]]
    found["columns"][columns[1]]["meaning"] = "another"
    found["remarks"]["Something else."] = ""
    said = net.differences(kept, found)
    assert len(said) == 3
    assert f"columns: {columns[0]} is lost" in said
    assert any(columns[1] in one and "meaning" in one for one in said)
    assert "remarks: Something else. is new" in said


def test_another_order_of_columns_is_found(kept):
    found = copy.deepcopy(kept)
    found["columns"] = dict(reversed(found["columns"].items()))
    assert net.differences(kept, found) == ["columns: the order differs"]


def test_a_changed_digit_is_found_with_how_far_it_is_away():
    values = np.array([1.0, -2.5, 40.0])
    kept = {"columns": {"t / x": {"unit": "mm", **net.of_array(values)}}}
    found = {"columns": {"t / x": {"unit": "mm", **net.of_array([*values[:2], 40.00000004])}}}
    (said,) = net.differences(kept, found)
    assert "t / x" in said
    assert "differ by 1e-09" in said


def test_a_change_between_the_samples_is_found():
    values = np.array([1.0, -2.0, 0.5, 0.25, 2.0])
    moved = [1.0, -2.0, 0.500001, 0.249999, 2.0]
    (said,) = net.differences({"columns": {"a": net.of_array(values)}}, {"columns": {"a": net.of_array(moved)}})
    assert "its samples are the same" in said


def test_what_is_zero_but_for_round_off_is_no_change():
    """Slopes of 1e-16 are other ones on another processor; one that grows is found."""
    kept, other, grown = ({"columns": {"a": net.of_array([x, -x])}} for x in (2.2e-16, 6.1e-16, 1e-8))
    assert net.differences(kept, other) == []
    assert len(net.differences(kept, grown)) == 1


def test_noise_is_no_change():
    """Of the last bits, and of what should be zero beside large numbers."""
    values = np.array([1.0 / 3.0, 0.0, 1e5, np.nan, np.inf])
    noisy = np.array([np.nextafter(1.0 / 3.0, 1.0), -1e-9, 1e5, np.nan, np.inf])
    assert net.of_array(values) == net.of_array(noisy)


def test_rounding_keeps_ten_digits_of_every_number():
    values = np.array([12345678901.2, 0.12345678912, -5e-3, 1e300, 1e-300])
    np.testing.assert_allclose(net.rounded(values[:2]), [12345678900.0, 0.12], rtol=1e-15)
    for one in values:
        assert abs(net.rounded([one])[0] / one - 1.0) < 5e-10


def test_words_without_time_and_place_and_with_fewer_digits():
    text = f"Took 3.25 s with 0.2.0 on 2026-01-31 in {net.ROOT}/x: 1.23456789 mm at 12 teeth of a1.5"
    assert net.worded(text) == "Took (time) s with (version) on (date) in ./x: 1.23457 mm at 12 teeth of a1.5"
