"""Drawings, grinding tables, meshes and models that exports write are those that are kept."""

import importlib.util
from pathlib import Path

import pytest

_SPEC = importlib.util.spec_from_file_location("exported", Path(__file__).with_name("exported.py"))
exported = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(exported)


@pytest.mark.parametrize("name", exported.EXPORTS)
def test_an_export_writes_what_is_kept(name):
    assert exported.differences(exported.kept()[name], exported.of_export(name)) == []
