"""Numbers that the code states are those that are kept: none changes unseen."""

import importlib.util
from pathlib import Path

_SPEC = importlib.util.spec_from_file_location("constants", Path(__file__).with_name("constants.py"))
constants = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(constants)


def test_constants_defaults_and_bounds_are_those_that_are_kept():
    assert constants.differences(constants.kept(), constants.found()) == []
