"""Every number that a user can reach is in the unit beside it: in Python, in the CSV, the summary and the dataset."""

from __future__ import annotations

import csv
import io
import pickle
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

import fegear
from fegear.output.summary import summary
from fegear.output.tables import table_text

CASES = Path(__file__).parents[2] / "cases"
COARSE = {"accuracy.tolerance": 0.05}
#: Cases that together have nearly every result and every unit, at a processor second or less each.
CHEAP = {
    "blankenship_singh": {},
    "cornell_test_gear": COARSE,
    "four_square_dynamics": {},
    "lin_dynamic_factor": {"dynamics.speeds": ["4000 rpm"]},
    "lin_table1": COARSE,
    "lin_tip_relief": {},
    "litvin_localised": {},
    "mark_minimum_excitation": {},
    "mark_tip_relief": {},
    "pinion_and_wheel": COARSE,
}


@pytest.mark.dear
@pytest.mark.parametrize("name", CHEAP)
def test_numbers_and_units_agree_everywhere(name):
    found = fegear.run(CASES / f"{name}.toml", CHEAP[name], cache=CACHE)
    written = summary(found, [], [])["results"]
    data = found.to_xarray()
    spelt = {"": "1", "deg": "degree"}
    for value in found.values:
        assert (written[value.name]["value"], written[value.name]["unit"]) == (value.value, value.unit)
        assert written[value.name]["error"] == value.error
        assert data[value.name].item() == value.value
        assert data[value.name].attrs["units"] == spelt.get(value.unit, value.unit)
        # pint, which knows nothing of fegear's own factors, comes back to SI
        assert value.quantity.to_base_units().magnitude == pytest.approx(value.si, rel=1e-12)
        printed = float(repr(value).split(" = ")[1].split()[0])
        assert printed == pytest.approx(value.value, rel=1e-5, abs=value.error or 0.0)
        assert repr(value).endswith(value.unit)
    for table in found.tables:
        heads, *rows = csv.reader(io.StringIO(table_text(table)))
        frame = table.to_pandas()
        assert list(frame.columns) == heads
        for place, column in enumerate(table.columns):
            assert heads[place] == column.head
            if column.si.dtype.kind not in "iuf":
                assert not column.unit, f"{table.name}.{column.name} is a text with a unit"
                continue
            values = table[column.head]
            assert np.array_equal(values, frame[column.head].to_numpy(), equal_nan=True)
            assert np.array_equal(values, data[f"{table.name}.{column.name}"].values, equal_nan=True)
            np.testing.assert_allclose([float(row[place]) for row in rows], values, rtol=1e-11)
            np.testing.assert_allclose(column.quantity.to_base_units().magnitude, column.si, rtol=1e-12)
    # What a stage has found travels between processes: charts and draws send it to every worker.
    for task, outcome in found.outcomes.items():
        there = pickle.loads(pickle.dumps(outcome.data))  # noqa: S301  (our own)
        assert type(there) is type(outcome.data), task
