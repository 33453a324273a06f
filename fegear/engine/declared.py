"""Columns, values, axes and curves of quantities that the mechanics declares (`fegear.base.shown`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.shown import declared
from fegear.base.units import from_si
from fegear.engine.figure.figure import Axis
from fegear.engine.figure.items import Curve
from fegear.engine.outcome import Value
from fegear.engine.table import Column

if TYPE_CHECKING:
    from fegear.base.arrays import Array


def _si(found: object, attribute: str, load: int | None) -> Any:
    si = getattr(found, attribute)
    return si[..., load] if load is not None and np.ndim(si) > 1 else si


def columns_of(found: object, *attributes: str, load: int | None = None) -> tuple[Column, ...]:
    """Columns of some quantities of a result.

    Parameters
    ----------
    found : object
        Of a class that declares them; arrays of shape (N,) or (N, L).
    *attributes : str
    load : int, optional
        Which of the L loads.
    """
    return tuple(column_of(found, attribute, load=load) for attribute in attributes)


def column_of(
    found: object, attribute: str, si: Any = None, *, load: int | None = None, name: str = "", meaning: str = ""
) -> Column:
    """One such column, of other numbers, under another name or with a meaning of its own where these are given."""
    how = declared(found if isinstance(found, type) else type(found), attribute)
    numbers = _si(found, attribute, load) if si is None else si
    return Column(name or how.name, np.asarray(numbers), how.unit, meaning or how.meaning)


def error_column(column: Column, si: Array, meaning: str = "") -> Column:
    """The estimated error of a column, in its unit."""
    return Column(f"{column.name}_error", si, column.unit, meaning or f"estimated error of {column.name}")


def value_of(
    found: object, attribute: str, owner: str, error: float | None = None, *,
    load: int | None = None, name: str = "", meaning: str = "",
) -> Value:  # fmt: skip
    """A single value ``owner.name`` of a quantity that is a number, or one number for each load."""
    how, si = declared(type(found), attribute), getattr(found, attribute)
    number = float(si if load is None or np.ndim(si) == 0 else si[load])
    return Value(f"{owner}.{name or how.name}", number, how.unit, error, meaning or how.meaning)


def axis_of(owner: type, attribute: str, label: str = "", **options: Any) -> Axis:
    """An axis on which a quantity is drawn, in its unit."""
    how = declared(owner, attribute)
    return Axis(label or how.label, how.unit, **options)


def drawn(found: object, attribute: str, *, load: int | None = None) -> Array:
    """Numbers of a quantity in its unit, as they are drawn."""
    unit = declared(type(found), attribute).unit
    return np.asarray(_si(found, attribute, load), dtype=float) * (from_si(unit) if unit else 1.0)


def curve_of(
    found: object, x: str, y: str, label: str = "", role: str = "blue", error: Array | None = None, *,
    load: int | None = None,
) -> Curve:  # fmt: skip
    """One quantity over another, both in their units; `error` in SI."""
    unit = declared(type(found), y).unit
    band = None if error is None else error * (from_si(unit) if unit else 1.0)
    return Curve(drawn(found, x), drawn(found, y, load=load), label, role, band)
