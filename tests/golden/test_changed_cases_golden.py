"""Cases of which one key is left out, negative, zero, larger or another word: refused or planned as is kept."""

import importlib.util
from pathlib import Path

import pytest

_SPEC = importlib.util.spec_from_file_location("changed_cases", Path(__file__).with_name("changed_cases.py"))
changed_cases = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(changed_cases)
KEPT = changed_cases.kept()


@pytest.mark.parametrize("case", KEPT)
def test_what_becomes_of_a_changed_case_is_what_is_kept(case):
    assert changed_cases.again(case, KEPT[case]) == []


def test_another_outcome_is_a_difference():
    assert changed_cases.same([1, 0, 5, 2.0], [1, 0, 5, 2.0 + 1e-9])
    for other in ([1, 0, 5, 2.01], [1, 1, 5, 2.0], "refused: a"):
        assert not changed_cases.same([1, 0, 5, 2.0], other)
