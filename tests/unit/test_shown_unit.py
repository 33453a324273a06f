"""A quantity declared once: columns, values, axes and curves take unit and meaning from the mechanics' own field."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import pytest

from fegear.base.shown import Shown, all_declared, declared, shown, shows
from fegear.engine.declared import (
    axis_of,
    column_of,
    column_over,
    columns_of,
    curve_of,
    drawn,
    error_column,
    repeated,
    tiled,
    value_of,
)  # fmt: skip


@dataclass(frozen=True)
class History:
    x: np.ndarray = shown("mm", "position on the line of action", label="line of action")
    load: np.ndarray = shown("N", "on the pair")
    share: np.ndarray = shown("", "share of the total load", name="load_share")
    hidden: int = field(default=3)

    @property
    @shows("um", "peak-to-peak value")
    def peak_to_peak(self) -> float:
        return 2e-6

    @cached_property
    @shows("N", "largest load")
    def largest(self) -> np.ndarray:
        return self.load.max(axis=0)


FOUND = History(np.array([-1e-3, 2e-3]), np.array([[10.0, 20.0], [30.0, 40.0]]), np.array([0.5, 1.0]))


def test_fields_and_properties_are_declared_once():
    assert declared(History, "x") == Shown("mm", "position on the line of action", "x", "line of action")
    assert declared(History, "share").name == "load_share"
    assert declared(History, "peak_to_peak") == Shown("um", "peak-to-peak value", "peak_to_peak", "peak-to-peak value")
    assert set(all_declared(History)) == {"x", "load", "share", "peak_to_peak", "largest"}
    for missing in ("hidden", "nothing"):
        with pytest.raises(TypeError, match=f"History.{missing} is not declared"):
            declared(History, missing)


def test_columns_are_in_the_declared_unit_and_of_one_load():
    x, load, share = columns_of(FOUND, "x", "load", "share", load=1)
    assert (x.head, load.head, share.head) == ("x [mm]", "load [N]", "load_share")
    assert x.values.tolist() == [-1.0, 2.0]
    assert load.values.tolist() == [20.0, 40.0]
    assert share.values.tolist() == [0.5, 1.0]  # one for every load alike
    other = column_of(History, "load", np.array([1.0]), name="design_load", meaning="of the design")
    assert (other.head, other.meaning) == ("design_load [N]", "of the design")
    error = error_column(load, np.array([0.1, 0.2]))
    assert (error.head, error.meaning) == ("load_error [N]", "estimated error of load")


def test_values_axes_and_curves_are_in_the_declared_unit():
    value = value_of(FOUND, "peak_to_peak", "I", 1e-7)
    assert (value.name, value.value, value.error) == ("I.peak_to_peak", pytest.approx(2.0), pytest.approx(0.1))
    assert value_of(FOUND, "largest", "I", load=1).value == 40.0
    axis = axis_of(History, "x", zero=True)
    assert (axis.label, axis.unit, axis.zero) == ("line of action", "mm", True)
    curve = curve_of(FOUND, "x", "load", "20 N", load=1, error=np.array([1.0, 2.0]))
    assert curve.x.tolist() == [-1.0, 2.0]
    assert curve.y.tolist() == [20.0, 40.0]
    assert curve.error is not None
    assert curve.error.tolist() == [1.0, 2.0]


def test_columns_over_several_results_and_rows_many_times():
    other = History(np.array([0.0]), np.array([[7.0, 9.0]]), np.array([1.0]))
    column = column_over([FOUND, other], "peak_to_peak", meaning="of each")
    assert (column.head, column.meaning, column.values.tolist()) == ("peak_to_peak [um]", "of each", [2.0, 2.0])
    columns = columns_of(FOUND, "x", "share")
    assert [one.values.tolist() for one in tiled(columns, 2)] == [[-1.0, 2.0, -1.0, 2.0], [0.5, 1.0, 0.5, 1.0]]
    assert [one.values.tolist() for one in repeated(columns, 2)] == [[-1.0, -1.0, 2.0, 2.0], [0.5, 0.5, 1.0, 1.0]]
    assert [(one.unit, one.meaning) for one in tiled(columns, 2)] == [(one.unit, one.meaning) for one in columns]


def test_other_numbers_are_shown_as_the_declared_quantity():
    assert value_of(History, "x", "I", si=0.004, name="pitch").value == 4.0
    assert drawn(FOUND, "x", [0.001]).tolist() == [1.0]
    assert axis_of(FOUND, "load").unit == "N"


@dataclass(frozen=True)
class Path:
    x: np.ndarray = shown("mm", "position", table="path")
    mean: float = shown("N", "mean load")
    corner: np.ndarray | None = shown("", "1 where a corner touches", table="path")

    @property
    @shows("N", "load", name="force", table="path")
    def load(self) -> np.ndarray:
        return 2.0 * self.x

    @property
    @shows("", "position over the length", table="path")
    def place(self) -> np.ndarray:
        return self.x / 1e-3


def test_a_quantity_that_names_a_table_is_a_column_of_it_in_the_order_of_declaration():
    one = Path(np.array([0.0, 1e-3]), 1.0, None)
    assert [column.name for column in columns_of(one, table="path")] == ["x", "force", "place"]
    assert [c.name for c in columns_of(replace(one, corner=one.x), "mean", table="path")] == [
        "mean", "x", "corner", "force", "place",
    ]  # fmt: skip
    assert columns_of(one, table="none") == ()
