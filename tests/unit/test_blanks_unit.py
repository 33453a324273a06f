"""What does not apply is blank in tables, null in JSON, and said so in the meaning of its column; readers take it."""

import json
import math
import re

import numpy as np
import pytest

from fegear.engine.table import Column, Table
from fegear.output.run_folder import _read_table as read_table
from fegear.output.tables import cells, printed_lines, sheet_lines, table_text

TABLE = Table("lives_I", (
    Column("place", np.array([0.0, 1e-3]), "mm", "along the shaft"),
    Column("life", np.array([math.inf, 3.6e6]), "h", "at this load"),
    Column("share", np.array([math.nan, 0.5])),
    Column("what", np.array(["", "x"])),
))  # fmt: skip
#: What Python, JSON and C write for what is no number.
NO_NUMBER = re.compile(r"(?i)(?<![\w.])[-+]?(nan|inf|infinity)(?![\w.])")


def test_a_table_has_blanks_and_its_columns_say_why():
    assert table_text(TABLE).splitlines()[1:] == ["0,,,", "1,1000,0.5,x"]
    assert not NO_NUMBER.search("\n".join(sheet_lines(TABLE)))
    assert [column.explained for column in TABLE.columns] == [
        "along the shaft", "at this load; blank where it is unlimited or does not apply",
        "blank where it does not apply", "",
    ]  # fmt: skip
    odd = (np.float64("nan"), np.float64("-inf"), np.int64(3), np.str_("a"))
    assert [cells(np.array([one])) for one in odd] == [[""], [""], ["3"], ["a"]]


def test_the_terminal_has_the_digits_that_a_person_reads():
    """ "S_H_driver 2.168138": sizes of a drawing need seven digits, safety factors and stresses do not."""
    columns = (("S_H", 2.1681384, ""), ("sigma_H", 605.402071e6, "MPa"), ("over_balls", 0.176865912, "mm"))
    table = Table("safety", tuple(Column(name, np.array([value]), unit) for name, value, unit in columns))
    assert [line.split()[-1] for line in sheet_lines(table)] == ["2.1681", "605.4", "176.8659"]


def test_the_terminal_leaves_errors_of_other_columns_to_the_files():
    names = ("amount", "amount_error", "spacing_error")
    table = Table("ground", tuple(Column(name, np.array([1e-6]), "um") for name in names))
    assert [line.split()[0] for line in printed_lines([table])] == ["amount", "spacing_error"]


def test_equal_tables_of_several_pairs_have_their_titles_in_the_terminal():
    """Two blocks of safety factors followed each other without a word of whose they were."""
    one, two = (Table(f"lives_{name}", TABLE.columns, f"Lives of pair {name}") for name in ("I", "II"))
    other = Table("shares_I", TABLE.columns[2:], "Shares of pair I")
    lines = printed_lines([one, other, two])
    assert [line for line in lines if line.endswith(":")] == ["Lives of pair I:", "Lives of pair II:"]
    assert printed_lines([one, other]) == [*sheet_lines(one), *sheet_lines(other)]


def test_a_reader_takes_blanks_for_what_does_not_apply(tmp_path):
    path = tmp_path / "lives_I.csv"
    path.write_text(table_text(TABLE), "utf-8")
    read = read_table(path, "DIR")
    assert np.array_equal(read.column("life").values, [math.nan, 1000.0], equal_nan=True)
    assert np.array_equal(read.column("share").values, [math.nan, 0.5], equal_nan=True)
    assert list(read.column("what").values) == ["", "x"]


CASES = {
    "lin_table1": {}, "rating_spur": {}, "two_stage_shafts": {}, "planetary_set": {}, "pinion_and_wheel": {},
    "litvin_lead": {}, "blankenship_singh": {}, "surface_and_loss": {}, "planet_and_ring": {},
}  # fmt: skip


@pytest.mark.dear
@pytest.mark.parametrize("name", CASES)
def test_no_file_of_a_run_has_a_number_that_is_none(name, tmp_path, monkeypatch):
    from case_laws import case, ran

    ran(case(name), monkeypatch).save(tmp_path / "run", plots=False)
    texts = [*(tmp_path / "run").rglob("*.csv"), *(tmp_path / "run").rglob("*.json")]
    assert len(texts) > 2
    for path in texts:
        found = NO_NUMBER.search(path.read_text("utf-8"))
        assert found is None, f"{path.name}: {found}"
    summary = json.loads((tmp_path / "run" / "summary.json").read_text("utf-8"))
    assert "results" in summary
