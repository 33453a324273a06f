"""Tables of a sheet: columns of declared quantities, for one load or several, over a grid, or a row an object."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fegear.base.shown import columns_declared
from fegear.engine.declared import column_of, columns_on_grid, error_column, stacked
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.seen import Seen, Text, Where, reach
from fegear.engine.table import Column, Table


@dataclass(frozen=True)
class Every:
    """All columns that the class declares for a table; a quantity that a result lacks (None) has none.

    Parameters
    ----------
    table : str
    names : mapping of str to str
        Columns that have another name than declared, by quantity.
    """

    table: str
    names: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Cell:
    """A column: a declared quantity, of other numbers or under other words where these are given.

    Parameters
    ----------
    quantity : str
        Of several that are alike one that the object of a repetition names: ``{key}``.
    si : where, optional
        Numbers in place of the quantity's own; None there: no column.
    of : where, optional
        What declares the quantity, if it is not what the table is of; a class where `si` has the numbers.
    name, meaning, ending, further : text
        In place of the declared ones; `ending` follows the declared name, `further` the declared meaning.
    each : where, optional
        Objects for each of which there is such a column.
    parts : bool
        Whether it is complex: two columns, ``name_re`` and ``name_im``.
    error : where, optional
        Its estimated error, a column behind it; None there: none. Elsewhere among the columns it is an `Off`.
    """

    quantity: str
    si: Where | None = None
    of: Where | None = None
    name: Text = ""
    meaning: Text = ""
    further: Text = ""
    each: Where | None = None
    parts: bool = False
    ending: Text = ""
    error: Where | None = None


@dataclass(frozen=True)
class Off:
    """Estimated error of a quantity, a column in its unit.

    Parameters
    ----------
    quantity : str
        As that of a `Cell`.
    error : where
        None there: no column.
    meaning : text
    of : where, optional
        What declares the quantity.
    name : text
        Of the column that it is the error of, where that has a name of its own.
    """

    quantity: str
    error: Where
    meaning: Text = ""
    of: Where | None = None
    name: Text = ""


Columns = tuple[Every | Cell | Off | Each | str, ...]


@dataclass(frozen=True)
class Rows:
    """A table; a declared quantity is named by its attribute only, or by the path to it (``path.load``).

    Parameters
    ----------
    name, title : text
    columns : tuple of Every, Cell, Off, Each of these, or str
    of : where, optional
        What declares the quantities: one object with arrays, or a sequence of objects, a row each. None there: no
        table.
    each : where, optional
        Objects for each of which there is such a table.
    when : where, optional
        Whether there is one.
    stacked : where, optional
        Objects whose rows stand one below the other; `columns` are of these, a single number or word of an object
        stands in all of its rows.
    on : tuple of str
        Axes of the grid over which the quantities are known; a row for each of its points. Single numbers and words
        stand before the axes, in all rows.
    printed, matlab : bool
        As those of `Table`.
    """

    name: Text
    title: Text
    columns: Columns
    of: Where = ""
    each: Where | None = None
    when: Where | None = None
    stacked: Where | None = None
    on: tuple[str, ...] = ()
    printed: bool = False
    matlab: bool = False

    def tables(self, seen: Seen) -> Iterator[Table]:
        """Those that there are."""
        for one in seen.each(self.each):
            if not one.holds(self.when) or (owner := one.find(self.of)) is None:
                continue
            yield Table(one.said(self.name), self._columns(one, owner), one.said(self.title), self.printed, self.matlab)

    def _columns(self, seen: Seen, owner: Any) -> tuple[Column, ...]:
        if self.stacked is None:
            return tuple(self._of_one(seen, owner))
        return stacked([_even(self._of_one(one, one.one)) for one in seen.each(self.stacked)])

    def _of_one(self, seen: Seen, owner: Any) -> list[Column]:
        """Columns of one object."""
        if not self.on:
            return _flat(seen, owner, self.columns, seen.nominal)
        columns = _flat(seen, owner, self.columns, None)
        single = [column for column in columns if not column.si.ndim]
        cells = [replace(column, si=column.si.ravel()) for column in columns if column.si.ndim]
        return _even([*single, *columns_on_grid(owner, self.on), *cells])


@dataclass(frozen=True)
class EveryLoad:
    """Columns of one load for every load, one below the other, behind a column of the loads; none for one load only.

    Parameters
    ----------
    name, title : text
    columns : tuple of Every, Cell, Off or str
    of : where
        What declares the quantities.
    over : tuple of class and str
        What declares the column of loads, and under which attribute.
    """

    name: Text
    title: Text
    columns: Columns
    of: Where
    over: tuple[type, str]

    def tables(self, seen: Seen) -> Iterator[Table]:
        """It, if there is one."""
        if len(seen.loads) < 2:
            return
        owner = seen.find(self.of)
        parts = [_flat(seen, owner, self.columns, load) for load in range(len(seen.loads))]
        loads = column_of(*self.over, np.repeat(seen.loads, [len(part[0]) for part in parts]))
        yield Table(seen.said(self.name), (loads, *stacked(parts)), seen.said(self.title))


def _even(columns: list[Column]) -> list[Column]:
    """Columns of one object with single numbers and words in all rows."""
    rows = max(column.si.size for column in columns)
    return [column if column.si.ndim else replace(column, si=np.full(rows, column.si)) for column in columns]


def _flat(seen: Seen, owner: Any, columns: Columns, load: int | None) -> list[Column]:
    """Columns of one object, or of a sequence of objects with a row each."""
    made: list[Column] = []
    for spec in columns:
        if isinstance(spec, Every):
            made += [
                _plain(owner, one, load, name=spec.names.get(one, ""))
                for one in columns_declared(_class(owner), spec.table) if _has(owner, one)
            ]  # fmt: skip
        elif isinstance(spec, str):
            made += [_plain(owner, spec, load)] if _has(owner, spec) else []
        elif isinstance(spec, Off):
            made += _off(seen, owner, spec, load)
        elif isinstance(spec, Each):
            for one in seen.each(spec.where):
                if one.holds(spec.when):
                    made += _flat(one, one.one, spec.elements, load)
        else:
            for one in seen.each(spec.each):
                of = owner if spec.each is None else one.one
                cells = _cell(one, of, spec, load)
                made += [part for cell in cells for part in _parts(cell)] if spec.parts else cells
                errors = None if spec.error is None or not cells else _errors(one, of, spec.error, load)
                made += [] if errors is None else [error_column(cells[0], errors)]
    return made


def _parts(column: Column) -> tuple[Column, ...]:
    """Real and imaginary part of a complex column."""
    return tuple(
        replace(column, name=f"{column.name}_{end}", si=part)
        for end, part in (("re", column.si.real), ("im", column.si.imag))
    )


def _cell(seen: Seen, owner: Any, spec: Cell, load: int | None) -> list[Column]:
    declares, quantity = owner if spec.of is None else seen.find(spec.of), seen.said(spec.quantity)
    words: dict[str, Any] = {key: seen.said(getattr(spec, key)) for key in ("name", "ending", "meaning", "further")}
    if spec.si is not None:
        si = _under(seen.find(spec.si), load)
        return [] if si is None else [column_of(*_declares(declares, quantity), si, **words)]
    return [_plain(declares, quantity, load, **words)] if _has(declares, quantity) else []


def _off(seen: Seen, owner: Any, spec: Off, load: int | None) -> list[Column]:
    declares = owner if spec.of is None else seen.find(spec.of)
    errors = _errors(seen, owner, spec.error, load)
    if errors is None:
        return []
    column = column_of(*_declares(declares, seen.said(spec.quantity)), errors, name=seen.said(spec.name))
    return [error_column(column, errors, seen.said(spec.meaning))]


def _errors(seen: Seen, owner: Any, where: Where, load: int | None) -> Any:
    """Errors under one load; by a path those of every object of a sequence."""
    if isinstance(owner, Sequence) and isinstance(where, str):
        return [getattr(*reach(one, where)) for one in owner]
    return _under(seen.find(where), load)


def _plain(owner: Any, quantity: str, load: int | None, **words: Any) -> Column:
    if isinstance(owner, Sequence):
        return column_of(*_declares(owner, quantity), [getattr(*reach(one, quantity)) for one in owner], **words)
    return column_of(*reach(owner, quantity), load=load, **words)


def _has(owner: Any, quantity: str) -> bool:
    """Whether a result has a quantity: it is None where it lacks it."""
    return getattr(*reach(owner[0] if isinstance(owner, Sequence) else owner, quantity)) is not None


def _declares(owner: Any, quantity: str) -> tuple[type, str]:
    """Class that declares a quantity of an object, of the first of several or of a class, and its attribute there."""
    found, attribute = reach(owner[0] if isinstance(owner, Sequence) else owner, quantity)
    return _class(found), attribute


def _class(owner: Any) -> type:
    if isinstance(owner, type):
        return owner
    return type(owner[0]) if isinstance(owner, Sequence) else type(owner)


def _under(si: Any, load: int | None) -> Any:
    """Numbers under one load, where there is an axis of loads."""
    return si[..., load] if load is not None and np.ndim(si) > 1 else si
