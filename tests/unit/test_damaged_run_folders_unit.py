"""Folders of runs with one thing wrong: the refusal names the key, the file and what is wrong with it."""

import json

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.output.run_folder import read_side

VALUES = {"I.load": {"value": 1000.0, "error": 2.0, "unit": "N"}}


def written(folder, summary=None, table=None, name="one"):
    (folder / "tables").mkdir()
    whole = {"results": VALUES, "inputs": {}} if summary is None else summary
    (folder / "summary.json").write_text(json.dumps(whole), encoding="utf-8")
    if table is not None:
        (folder / "tables" / f"{name}.csv").write_text(table, encoding="utf-8")
    return folder


def value(**changes):
    return {"results": {"I.load": VALUES["I.load"] | changes}}


SUMMARY, TABLE = "summary.json", "tables/one.csv"


@pytest.mark.parametrize(
    ("summary", "table", "where", "said"),
    [
        ({"results": [1]}, None, SUMMARY, "has no results"),
        ({"results": {}, "inputs": 3}, None, SUMMARY, "contains inputs that are not a case"),
        ({"results": {"I.load": 7}}, None, SUMMARY, 'has 7 as the value "I.load"'),
        (value(unit="ell"), None, SUMMARY, 'has the unknown unit "ell" at the value "I.load"'),
        (value(value=True), None, SUMMARY, 'for the value "I.load"; must be a finite number or null'),
        (value(error="much"), None, SUMMARY, 'has "much" for the value "I.load"; must be a finite number or null'),
        (None, "", TABLE, "must have column heads in its first line"),
        (None, 'x [mm]\n"1', TABLE, "is not a readable table"),
        (None, "x [mm],y\n1,2\n3\n", TABLE, "has 1 entries in row 2 but 2 column heads"),
        (None, "x [mm],x [um]\n1,2\n", TABLE, 'has two columns "x"'),
    ],
)
def test_a_refusal_names_key_file_and_what_is_wrong(tmp_path, summary, table, where, said):
    with pytest.raises(InputError) as refused:
        read_side(written(tmp_path, summary, table), "left")
    text = str(refused.value)
    assert text.startswith(f'left = "{tmp_path / where}": ')
    assert said in text
    assert text.endswith("; specify a folder that fegear run wrote, or a case file.")


def test_a_name_that_cannot_be_printed_and_no_folder_at_all_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"right = .*is not a results folder \(no summary.json\)"):
        read_side(tmp_path, "right")
    with pytest.raises(InputError, match=r"right = .*csv.*has a name that cannot be printed"):
        read_side(written(tmp_path, None, "x\n1\n", name="a\x07b"), "right")


def test_values_and_columns_are_read_in_si_with_their_errors_and_unknown_ones_are_nan(tmp_path):
    results = {
        "I.te": {"value": 2.0, "error": 0.5, "unit": "um"}, "gone": {"value": None, "unit": "mm"},
        "r.swept": {"now": [1.0]},
    }  # fmt: skip
    side = read_side(written(tmp_path, {"results": results}, "x [mm],n,why [?]\n1,2,a\n3,4,b\n"), "left")
    assert set(side.values) == {"I.te", "gone"}
    te = side.values["I.te"]
    assert (te.si, te.value, te.unit) == (pytest.approx(2e-6), pytest.approx(2.0), "um")
    assert te.error == pytest.approx(0.5)
    assert np.isnan(side.values["gone"].value)
    assert side.values["gone"].error is None
    columns = {column.name: column for column in side.tables["one"].columns}
    assert columns["x"].si == pytest.approx([1e-3, 3e-3])
    assert columns["n"].si.tolist() == [2.0, 4.0]
    assert list(columns["why [?]"].values) == ["a", "b"]


def test_a_run_of_values_only_has_no_tables(tmp_path):
    folder = written(tmp_path)
    (folder / "tables").rmdir()
    assert read_side(folder, "left").tables == {}
    (folder / "tables").write_text("", encoding="utf-8")
    assert read_side(folder, "left").tables == {}
