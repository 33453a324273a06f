"""The table of what Mark's Table 1 depends on, docs/studies/mark_table1.csv: whole, and a few of its rows anew."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import mark_table1_study as study


def kept():
    """Rows of the committed table by all that was chosen."""
    with study.TABLE.open(encoding="utf-8") as file:
        assert next(file).rstrip() == study.COMMAND
        rows = list(csv.reader(file))
    assert tuple(rows[0]) == study.HEAD
    return {tuple(row[:7]): [float(cell) for cell in row[7:]] for row in rows[1:]}


def test_the_body_explains_more_than_contact_or_elements():
    """What the page says: 2 points by a load on a point, 16 by the elements, 30 and more by the sector."""
    table = kept()
    assert len(table) == 24 + 24 + 10 - 2  # a model is listed once
    whole = {load: table["whole", "-", "stress", load, *kind, "0.5"][0]
             for load, kind in (("Hertz", ("-", "-")), ("point", ("6-node triangle", "0.05")))}  # fmt: skip
    assert whole == {"Hertz": -21.0, "point": -19.3}
    five = [
        values[0] for key, values in table.items() if key[:4] == ("5", "free", "stress", "point") and key[6] == "0.5"
    ]
    assert (min(five), max(five)) == (-2.4, 18.2)
    assert table["3", "free", "stress", "point", "6-node triangle", "0.05", "0.5"][0] == 101.8
    for values in table.values():
        median, lowest, highest, scatter = values
        assert lowest <= median <= highest
        assert scatter > 0.0
    # no choice meets all 30 rows
    assert min(max(-lowest, highest) for _, lowest, highest, _ in table.values()) > 9.0


@pytest.mark.parametrize(
    ("model", "key"),
    [
        ({"teeth": 3, "fixed_at": 0.65}, ("3", "free", "stress", "point", "6-node triangle", "0.05", "0.65")),
        ({"teeth": 5, "element": "4-node quadrilateral", "edge": 0.2},
         ("5", "free", "stress", "point", "4-node quadrilateral", "0.1", "0.5")),
    ],
)  # fmt: skip
def test_rows_of_the_table_are_what_comes_out_now(model, key):
    found = study.against_print(study.deflection(study.point_compliance(study.Model(**model))))
    assert found == pytest.approx(kept()[key], abs=1.0)


def test_a_sector_of_five_and_of_three_teeth_under_point_loads():
    """The deflections [um] at six of Table 1's roll angles that the page on the paper names."""
    degrees = np.degrees(study.printed()[0])
    rows = [int(np.argmin(np.abs(degrees - at))) for at in (16.74, 19.40, 22.21, 24.92, 26.61, 27.82)]
    for teeth, wanted in (
        (5, [13.428, 14.187, 15.870, 17.151, 12.631, 7.262]),
        (3, [25.256, 26.284, 28.310, 29.980, 21.368, 12.145]),
    ):
        found = study.deflection(study.point_compliance(study.Model(teeth)))[rows] * 1e6
        assert found == pytest.approx(wanted, rel=5e-3)
