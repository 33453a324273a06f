"""Tables as CSV: numbers are numbers, and no text is a formula."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from scipy.io import loadmat

from fegear.engine.table import Column, Table
from fegear.output.tables import table_text, write_table


@pytest.mark.parametrize(
    "text", ["=1+1", "=cmd|' /C calc'!A0", "+1+1", "-1+1", "@SUM(A1)", "\t=1", "\r=1", "-A1", "--1"]
)
def test_no_text_is_a_formula(text):
    table = Table("t", (Column("gear", np.array([text])), Column(text, np.array([1.0]))))
    head, row = csv.reader(table_text(table).splitlines(keepends=True)) if "\r" not in text else (["", ""], ["", "1"])
    assert (head[1], row[0]) in ((f"'{text}", f"'{text}"), ("", ""))
    assert f"'{text}" in table_text(table)
    assert row[1] == "1"


@pytest.mark.parametrize("text", ["-0.5", "+3 mm", "-1e-3 um", "-", "", "a=b", "it's", "-.5 deg", "Größe"])
def test_other_texts_stay_as_they_are(text):
    table = Table("t", (Column("gear", np.array([text])),))
    assert table_text(table) == f"gear\n{text}\n" or text == ""


def test_numbers_stay_numbers_and_what_is_none_is_blank():
    values = np.array([-1.5, 1e-30, -np.inf, np.nan, 12345.678901234])
    text = table_text(Table("t", (Column("x", values), Column("n", np.array([-1, 2, -3, 4, 5])))))
    assert text.splitlines()[3:5] == [",-3", ",4"]
    found = np.array([[float(cell or "nan") for cell in line.split(",")] for line in text.splitlines()[1:]])
    np.testing.assert_allclose(found[:, 0], np.where(np.isfinite(values), values, np.nan), rtol=1e-11)
    assert found[:, 1].tolist() == [-1, 2, -3, 4, 5]


def test_columns_of_texts_of_any_length_are_read_back_from_mat(tmp_path):
    """As those of a dynamic factor over speed: the kind of each motion beside its numbers."""
    kinds = ["periodic", "not periodic", "growing"]
    columns = (Column("dynamic_factor", np.array([1.0, 2.0, np.inf])), Column("motion", np.array(kinds)))
    write_table(tmp_path, Table("dynamic_factor_I", columns, "Dynamic factor", matlab=True))
    read = loadmat(tmp_path / "dynamic_factor_I.mat", simplify_cells=True)
    assert [kind.strip() for kind in read["motion"]] == kinds  # a matrix of characters, as MATLAB has them
    assert read["dynamic_factor"].tolist() == [1.0, 2.0, np.inf]
