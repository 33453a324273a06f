"""Columns, values, axes and curves of quantities that the mechanics declares (`fegear.base.shown`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import columns_declared, declared
from fegear.base.units import from_si
from fegear.engine.figure.axis import Axis
from fegear.engine.table import Column
from fegear.engine.value import Value

if TYPE_CHECKING:
    from fegear.engine.figure.items import Curve


def _class(owner: object) -> type:
    return owner if isinstance(owner, type) else type(owner)


def _si(found: object, attribute: str, load: int | None) -> Any:
    si = getattr(found, attribute)
    return si[..., load] if load is not None and np.ndim(si) > 1 else si


def columns_of(found: object, *attributes: str, table: str = "", load: int | None = None) -> tuple[Column, ...]:
    """Columns of some quantities of a result, and of of all that its class declares for a table.

    Parameters
    ----------
    found : object
        Of a class that declares them; arrays of shape (N,) or (N, L).
    *attributes : str
    table : str
        Whose declared columns follow those named; a quantity that this result lacks (None) has none.
    load : int, optional
        Which of the L loads.
    """
    more = columns_declared(_class(found), table) if table else ()
    named = (*attributes, *(one for one in more if getattr(found, one) is not None))
    return tuple(column_of(found, attribute, load=load) for attribute in named)


def column_of(
    found: object, attribute: str, si: Any = None, *,
    load: int | None = None, name: str = "", ending: str = "", meaning: str = "", further: str = "",
) -> Column:  # fmt: skip
    """One such column, of other numbers, under another name or with a meaning of its own where these are given.

    `ending` follows the declared name, `further` the declared meaning.
    """
    how = declared(_class(found), attribute)
    numbers = _si(found, attribute, load) if si is None else si
    return Column(f"{name or how.name}{ending}", np.asarray(numbers), how.unit, f"{meaning or how.meaning}{further}")


def error_column(column: Column, si: Any, meaning: str = "") -> Column:
    """The estimated error of a column, in its unit."""
    return Column(f"{column.name}_error", np.asarray(si), column.unit, meaning or f"estimated error of {column.name}")


def column_over(objects: Sequence[Any], attribute: str, *, name: str = "", meaning: str = "") -> Column:
    """One row for each of several results of one class, at least one."""
    return column_of(type(objects[0]), attribute, [getattr(one, attribute) for one in objects], name=name,
                     meaning=meaning)  # fmt: skip


def columns_on_grid(found: object, axes: Sequence[str], *cells: str, table: str = "") -> tuple[Column, ...]:
    """Columns of what was computed on a grid over keys or inputs, a row for each point, the last axis fastest.

    Parameters
    ----------
    found : object
        Of a class that declares its axes, of shape (A,), (B,), ..., and its cells, of shape (A, B, ...).
    axes : sequence of str
    *cells : str
    table : str
        Whose declared columns are cells, too.
    """
    points = np.meshgrid(*(getattr(found, axis) for axis in axes), indexing="ij")
    named = (*cells, *(columns_declared(_class(found), table) if table else ()))
    return (
        *(column_of(found, axis, point.ravel()) for axis, point in zip(axes, points, strict=True)),
        *(column_of(found, cell, np.ravel(getattr(found, cell))) for cell in named),
    )


def stacked(parts: Sequence[Sequence[Column]]) -> tuple[Column, ...]:
    """Rows of several tables with the same columns, at least one, below each other."""
    return tuple(replace(same[0], si=np.concatenate([one.si for one in same])) for same in zip(*parts, strict=True))


def tiled(columns: Iterable[Column], times: int) -> tuple[Column, ...]:
    """All rows of some columns, so many times one after the other."""
    return tuple(replace(column, si=np.tile(column.si, times)) for column in columns)


def repeated(columns: Iterable[Column], times: int | Sequence[int]) -> tuple[Column, ...]:
    """Every row of some columns so many times: one number, or one for each row."""
    return tuple(replace(column, si=np.repeat(column.si, times)) for column in columns)


def value_of(
    found: object, attribute: str, owner: str, error: float | None = None, *,
    load: int | None = None, name: str = "", ending: str = "", meaning: str = "", further: str = "", si: Any = None,
) -> Value:  # fmt: skip
    """A single value ``owner.name``: a quantity that is a number, or one for each load, or `si` in its place.

    Without an owner it is one of the whole case; `ending` follows the declared name, `further` the declared meaning.
    """
    how = declared(_class(found), attribute)
    si = getattr(found, attribute) if si is None else si
    number = float(si if load is None or np.ndim(si) == 0 else si[load])
    full = ".".join(filter(None, (owner, f"{name or how.name}{ending}")))
    return Value(full, number, how.unit, error, f"{meaning or how.meaning}{further}")


def axis_of(owner: object, attribute: str, label: str = "", **options: Any) -> Axis:
    """An axis on which a quantity of a result, or of a class of results, is drawn, in its unit."""
    how = declared(_class(owner), attribute)
    return Axis(label or how.label, how.unit, **options)


def drawn(found: object, attribute: str, si: Any = None, *, load: int | None = None) -> Array:
    """Numbers of a quantity, or others like it, in its unit, as they are drawn."""
    unit = declared(_class(found), attribute).unit
    numbers = _si(found, attribute, load) if si is None else si
    return np.asarray(numbers, dtype=float) * (from_si(unit) if unit else 1.0)


def curve_of(
    found: object, x: str, y: str, label: str = "", role: str = "blue", error: Array | None = None, *,
    load: int | None = None,
) -> Curve:  # fmt: skip
    """One quantity over another, both in their units; `error` in SI."""
    from fegear.engine.figure.items import Curve

    unit = declared(type(found), y).unit
    band = None if error is None else error * (from_si(unit) if unit else 1.0)
    return Curve(drawn(found, x), drawn(found, y, load=load), label, role, band)
