"""Drawings, grinding tables, meshes and models that exports write are those that are kept."""

import importlib.util
from pathlib import Path

import pytest

from fegear.output.export_formats import FORMATS

_SPEC = importlib.util.spec_from_file_location("exported", Path(__file__).with_name("exported.py"))
exported = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(exported)


@pytest.mark.dear("ring")
@pytest.mark.parametrize("name", exported.EXPORTS)
def test_an_export_writes_what_is_kept(name):
    assert exported.differences(exported.kept()[name], exported.of_export(name)) == []


#: Formats whose files hold what another program makes of them: it reads them back in tests of their own.
READ_BACK = {
    "fmu": "other_codes/test_fmu_other_codes.py",
    "pdf": "unit/test_drawn_mesh_unit.py",
    "step": "closed_form/test_solid_model_closed_form.py",
    "svg": "unit/test_drawn_mesh_unit.py",
}


def test_every_format_is_kept_or_read_back():
    kept = {name for *_, names in exported.EXPORTS.values() for name in names.split(",")}
    how = "give each an export in EXPORTS of exported.py and accept it, or name the test that reads it in READ_BACK"
    assert {*FORMATS} - kept == {*READ_BACK}, how
    assert all((Path(__file__).resolve().parents[1] / test).is_file() for test in READ_BACK.values())
