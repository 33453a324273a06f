"""REXS models become the cases that are kept, as they are and with one attribute changed, and models again."""

import importlib.util
from pathlib import Path

import pytest

_SPEC = importlib.util.spec_from_file_location("exchanged", Path(__file__).with_name("exchanged.py"))
exchanged = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(exchanged)


@pytest.mark.dear("rich", "load cases")
@pytest.mark.parametrize("name", exchanged.kept())
def test_a_model_and_its_changes_become_what_is_kept(name):
    assert exchanged.differences(exchanged.kept()[name], exchanged.of_model_named(name)) == []
