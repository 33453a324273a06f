"""The data sheet of a report: which columns stand together, what both gears share, safeties, and where files are."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.report import gear_data
from fegear.output.report.blocks import (
    DataTable,
    Download,
    Paragraph,
    Sheet,
    SheetGroup,
    Values,
    relative_error,
    value_cells,
)


def value(name, si, error=None, unit="um"):
    return Value(name, si, unit, error, "meaning")


def test_a_value_stands_with_the_digits_of_its_error():
    assert value_cells(value("a", 7.61867e-6, 2.6e-9)) == ("7.6187", "0.0026")
    assert value_cells(value("a", 7.5e-6)) == ("7.5", "not estimated")
    assert value_cells(value("a", 7.5e-6, 0.0)) == ("7.5", "exact")


def test_an_error_is_a_share_of_its_value_where_there_is_one():
    assert relative_error(value("a", -2e-6, 1e-7)) == pytest.approx(0.05)
    assert relative_error(value("a", 2e-6)) is None
    assert relative_error(value("a", 2e-6, 0.0)) is None
    assert relative_error(value("a", 0.0, 1e-7)) is None
    assert relative_error(value("a", 1e-30, 1e-6)) is None


def test_a_row_has_its_error_its_share_and_a_mark_where_it_is_beyond_the_tolerance():
    exact, rough = Values((value("a", 2e-6, 0.0), value("b", 2e-6, 1e-7)), 1e-2).rows
    assert (exact.error, exact.rough, exact.remark) == ("", "", "exact")
    assert rough.error.startswith("± 0.1")
    assert rough.remark == "(5 %)"
    assert rough.rough == "± 5 %"
    (fine,) = Values((value("b", 2e-6, 1e-9),), 1e-2).rows
    assert fine.rough == ""
    assert fine.remark == "(0.05 %)"
    (unasked,) = Values((value("b", 2e-6, 1e-7),)).rows
    assert unasked.rough == ""


def table(name="gear_data_I"):
    return Table(name, (
        Column("gear", np.array(["pinion", "wheel"])), Column("teeth", np.array([20, 43])),
        Column("tip_diameter", np.array([0.05, 0.1]), "mm", "tip diameter"),
        Column("tip_clearance", np.array([1e-3, 2e-3]), "mm", "tip clearance"),
        Column("of_no_group", np.array([1.0, 2.0])),
    ))  # fmt: skip


def test_columns_stand_in_groups_and_what_both_gears_share_below_them():
    safety = SheetGroup("Rating", (Column("S_H", np.array([1.1, 1.2]), "", "S_H"),))
    shared = (value("I.centre_distance", 0.1, None, "mm"), value("I.backlash", 2e-5, 1e-6))
    sheet, download = gear_data._blocks(table(), shared, {"gear_data_I"}, (safety,))
    assert isinstance(sheet, Sheet)
    assert sheet.heads == ("driver", "driven")
    assert [group.title for group in sheet.groups] == ["Teeth", "Diameters", "In mesh", "Rating"]
    assert [[column.name for column in group.columns] for group in sheet.groups] == [
        ["gear", "teeth"], ["tip_diameter"], ["tip_clearance"], ["S_H"],
    ]  # fmt: skip
    assert sheet.shared == (("meaning", "100", "mm"), ("meaning", "20.0", "um"))
    assert isinstance(download, Download)
    assert download.file == "tables/gear_data_I.csv"
    (_, _, texts), *_ = sheet.groups[1].rows
    assert texts == ("50", "100")


def test_a_table_that_is_not_written_says_what_writes_it_and_lone_gears_have_no_roles():
    sheet, note = gear_data._blocks(table(), (), set())
    assert sheet.heads == ("", "")
    assert sheet.shared == ()
    assert isinstance(note, Paragraph)
    assert note.kind == "note screen"
    assert 'results = ["geometry"]' in note.words


def test_safeties_of_both_gears_are_columns_and_half_known_ones_are_left_out():
    values = [
        *(Value(f"I.{member}.{key}", number, "", None) for member, key, number in (
            ("driver", "S_H", 1.23456), ("driven", "S_H", 1.3), ("driver", "S_F", 2.0), ("driver", "S_F_agma", 3.0),
            ("driven", "S_F_agma", 4.0),
        )),
        Value("II.driver.S_H", 9.0, "", None),
    ]  # fmt: skip
    found = gear_data.rated_columns(values, "I")
    assert [column.name for column in found] == ["S_H", "S_F_agma"]
    assert found[0].values.tolist() == [1.235, 1.3]
    assert found[0].meaning == "safety factor for pitting S_H, ISO 6336"
    results = SimpleNamespace(values=values)
    (group,) = gear_data._loaded(results, "I")
    assert group.title == "Rating (load capacity)"
    assert gear_data._loaded(results, "III") == ()


def test_a_brief_table_has_the_digits_that_errors_allow_and_all_of_them_behind_the_switch():
    columns = (
        Column("pair", ["I", "II"]), Column("K", np.array([1.23456789, 2.5])), Column("K_error", np.array([0.02, 0.3])),
        Column("life", np.array([33612.345, np.nan]) * 3600.0, "h"), Column("gap", np.array([12.3456e-6, 0.0]), "um"),
    )  # fmt: skip
    brief = DataTable(Table("t", columns), brief=True)
    assert [[one[0] for one in row] for row in brief.rows] == [
        ["I", "1.23", "0.02", "33600", "12.3"], ["II", "2.5", "0.3", "", "0"]
    ]  # fmt: skip
    assert [one[1] for one in brief.rows[0]] == ["I", "1.23457", "0.02", "33612.3", "12.3456"]
    assert [head[3] for head in brief.heads] == [False, False, True, False, False]
    assert [one[0] for one in DataTable(Table("t", columns)).rows[0]] == ["I", "1.23457", "0.02", "33612.3", "12.3456"]


def test_the_rows_of_a_table_are_counted_by_its_columns():
    shown = DataTable(table("other"))
    assert shown.count == 2
    assert shown.file == "tables/other.csv"
