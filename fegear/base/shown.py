"""Quantities declared once: unit and meaning stand at the field that the mechanics computes.

    @dataclass(frozen=True)
    class PairHistory:
        x: Array = shown("mm", "position of the pair on the line of action, from the pitch point")
        load: Array = shown("N", "on the pair along the line of action")

        @property
        @shows("um", "peak to peak of the transmission error")
        def peak_to_peak(self) -> float: ...

The numbers are in SI; the unit is the one in which an engineer reads them. Columns, values, axes, datasets and the
tables of the docs take unit and meaning from here (`fegear.engine.declared`).
"""

from __future__ import annotations

import inspect
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

_KEY = "shown"
_F = TypeVar("_F", bound="Callable[..., Any]")


class Shown(NamedTuple):
    """How a quantity is shown.

    Attributes
    ----------
    unit : str
        In which it is read; empty for dimensionless.
    meaning : str
        One clause.
    name : str
        In tables, values and datasets.
    label : str
        Of an axis; the meaning where it has none of its own.
    """

    unit: str
    meaning: str
    name: str
    label: str


def shown(unit: str = "", meaning: str = "", *, name: str = "", label: str = "", **options: Any) -> Any:
    """Declare how a field of a dataclass is shown.

    Parameters
    ----------
    unit, meaning : str
    name, label : str
        Where they differ from the field's name and from the meaning.
    **options
        Of `dataclasses.field`: ``default``, ``compare``, ...
    """
    return field(metadata={_KEY: Shown(unit, meaning, name, label or meaning)}, **options)


def shows(unit: str = "", meaning: str = "", *, name: str = "", label: str = "") -> Callable[[_F], _F]:
    """Declare how a property is shown; stands below ``@property`` or ``@cached_property``."""

    def mark(function: _F) -> _F:
        setattr(function, _KEY, Shown(unit, meaning, name, label or meaning))
        return function

    return mark


def declared(owner: type, attribute: str) -> Shown:
    """How a field or property of a class is shown.

    Raises
    ------
    TypeError
        If it is not declared: a fault of the program, not of its user.
    """
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
        raise TypeError(f"{owner.__name__}.{attribute} is not declared with shown() or shows()")
    return mark if mark.name else mark._replace(name=attribute)


def all_declared(owner: type) -> dict[str, Shown]:
    """Every quantity that a class declares, by attribute."""
    found = {}
    for attribute in (*getattr(owner, "__dataclass_fields__", {}), *dir(owner)):
        try:
            found[attribute] = declared(owner, attribute)
        except TypeError:
            continue
    return found
