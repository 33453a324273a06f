"""Symbols of standards: every one has a meaning and a unit that tables know, and factors are read in it."""

import pytest

from fegear.base.units import PER_SI
from fegear.formulas.iso6336.conditions import FactorTable
from fegear.formulas.symbols import AGMA_2101, ISO_6336


@pytest.mark.parametrize("table", [ISO_6336, AGMA_2101], ids=["ISO 6336", "AGMA 2101"])
def test_every_symbol_has_a_meaning_and_a_unit_of_tables(table):
    for symbol, how in table.items():
        assert how.name == symbol
        assert how.meaning, symbol
        assert how.unit == "" or how.unit in PER_SI, symbol


def test_a_factor_takes_unit_and_meaning_from_its_symbol():
    table = FactorTable()
    table.add("c_gamma_alpha", 20e9, "ISO 6336-1:2006, 9.3.2, Eq. 91")
    (row,) = table.rows
    assert (row.symbol, row.shown.unit, row.shown.meaning) == ("c_gamma_alpha", "N/(mm.um)", "mean mesh stiffness")
    assert row.values[0] * PER_SI[row.shown.unit] == pytest.approx(20.0, rel=1e-15)
    with pytest.raises(KeyError):
        table.add("K_nothing", 1.0, "")
