"""Quantities declared once: unit and meaning stand at the field that the mechanics computes.

    @dataclass(frozen=True)
    class PairHistory:
        x: Array = shown("mm", "position of the pair on the line of action, from the pitch point")
        load: Array = shown("N", "on the pair along the line of action", table="path")

        @property
        @shows("um", "peak to peak of the transmission error")
        def peak_to_peak(self) -> float: ...

With a `table` a quantity is a column of the table of that name, in the order in which the quantities stand in their
class: a new column is one field. The numbers are in SI; the unit is the one in which an engineer reads them. Columns,
values, axes, datasets and the tables of the docs take unit and meaning from here (`fegear.engine.declared`).
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import count
from typing import Any, TypeVar

_KEY = "shown"
_F = TypeVar("_F", bound="Callable[..., Any]")


@dataclass(frozen=True, slots=True)
class Shown:
    """How a quantity is shown.

    Parameters
    ----------
    unit : str
        In which it is read; empty for dimensionless.
    meaning : str
        One clause.
    name : str
        In tables, values and datasets.
    label : str
        Of an axis; the meaning where it has none of its own.
    table : str
        Of which it is a column; empty where a result lists its columns itself.
    order : int
        Grows in the order of declaration.
    """

    unit: str
    meaning: str
    name: str
    label: str
    table: str = ""
    order: int = field(default=0, compare=False)


_ORDER = count()


def _how(unit: str, meaning: str, name: str, label: str, table: str) -> Shown:
    return Shown(unit, meaning, name, label or meaning, table, next(_ORDER))


def shown(
    unit: str = "", meaning: str = "", *, name: str = "", label: str = "", table: str = "", **options: Any
) -> Any:
    """Declare how a field of a dataclass is shown.

    Parameters
    ----------
    unit, meaning : str
    name, label : str
        Where they differ from the field's name and from the meaning.
    table : str
        Of which it is a column.
    **options
        Of `dataclasses.field`: ``default``, ``compare``, ...
    """
    return field(metadata={_KEY: _how(unit, meaning, name, label, table)}, **options)


def shown_as(how: Shown, *, name: str = "", table: str = "", **options: Any) -> Any:
    """Declare that a field is shown as something known: a symbol of a standard (`fegear.formulas.symbols`).

    Parameters
    ----------
    how : Shown
    name, table : str
    **options
        As those of `shown`.
    """
    return field(metadata={_KEY: _how(how.unit, how.meaning, name or how.name, how.label, table)}, **options)


def shows(unit: str = "", meaning: str = "", *, name: str = "", label: str = "", table: str = "") -> Callable[[_F], _F]:
    """Declare how a property is shown; stands below ``@property`` or ``@cached_property``."""

    def mark(function: _F) -> _F:
        setattr(function, _KEY, _how(unit, meaning, name, label, table))
        return function

    return mark


#: What was looked up before: a run asks for the same few hundred again and again.
_KNOWN: dict[tuple[type, str], Shown] = {}
_UNDECLARED: set[tuple[type, str]] = set()
_COLUMNS: dict[tuple[type, str], tuple[str, ...]] = {}


def declared(owner: type, attribute: str) -> Shown:
    """How a field or property of a class is shown.

    Raises
    ------
    TypeError
        If it is not declared: a fault of the program, not of its user.
    """
    if (known := _KNOWN.get((owner, attribute))) is not None:
        return known
    if (owner, attribute) in _UNDECLARED:
        raise TypeError(f"{owner.__name__}.{attribute} is not declared with shown() or shows()")
    found = getattr(owner, "__dataclass_fields__", {}).get(attribute)
    mark: Shown | None = found.metadata.get(_KEY) if found is not None else None
    if mark is None:
        member = inspect.getattr_static(owner, attribute, None)
        if isinstance(member, property):
            member = member.fget
        elif isinstance(member, cached_property):
            member = member.func
        mark = getattr(member, _KEY, None)
    if not isinstance(mark, Shown):
        _UNDECLARED.add((owner, attribute))
        raise TypeError(f"{owner.__name__}.{attribute} is not declared with shown() or shows()")
    _KNOWN[owner, attribute] = mark = mark if mark.name else replace(mark, name=attribute)
    return mark


def all_declared(owner: type) -> dict[str, Shown]:
    """Every quantity that a class declares, by attribute."""
    found = {}
    for attribute in (*getattr(owner, "__dataclass_fields__", {}), *dir(owner)):
        try:
            found[attribute] = declared(owner, attribute)
        except TypeError:
            continue
    return found


def columns_declared(owner: type, table: str) -> tuple[str, ...]:
    """Attributes of a class that are columns of one of its tables, in the order of their declaration."""
    if (owner, table) not in _COLUMNS:
        found = {attribute: how for attribute, how in all_declared(owner).items() if how.table == table}
        _COLUMNS[owner, table] = tuple(sorted(found, key=lambda attribute: found[attribute].order))
    return _COLUMNS[owner, table]
