"""Which columns the heads of a table name."""

from __future__ import annotations

import pytest

from fegear.case.csv_lines import read_lines

KNOWN = ("angle", "strain")


@pytest.mark.parametrize(
    ("heads", "names"),
    [
        ("angle,strain", ["angle", "strain"]),
        ("Angle,STRAIN", ["angle", "strain"]),
        ("angle,Angle,strain", ["angle", "Angle", "strain"]),
        ("Angle,ANGLE,strain", ["Angle", "ANGLE", "strain"]),
        ("Angle [deg],strain [um/m]", ["angle", "strain"]),
        ("Angle;time;strain", ["angle", "time", "strain"]),
    ],
)
def test_another_spelling_counts_where_no_head_has_the_name_itself_and_only_one_is_alike(tmp_path, heads, names):
    path = tmp_path / "trace.csv"
    parting = ";" if ";" in heads else ","
    path.write_text(f"{heads}\n{parting.join(['0.5'] * len(names))}\n")
    found = read_lines(path, "gauge.a.measured", KNOWN)
    assert [one.name for one in found.heads] == names
    assert [one.unit for one in found.heads if one.unit] == (["deg", "um/m"] if "[" in heads else [])
