"""Elements of a sheet that are repeated together: all of them for one object before the next."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from fegear.engine.sheet.seen import Seen, Where


@dataclass(frozen=True)
class Each:
    """Elements for each of some objects; in a sheet's tables, values, figures or remarks, among columns or panels.

    Parameters
    ----------
    where : where
        Objects; paths of the elements begin there. None there: nothing.
    *elements : Rows, Number, Chart, Remark, columns, panels or callable
        Of one kind.
    when : where, optional
        Of which objects.
    """

    where: Where
    elements: tuple[Any, ...]
    when: Where | None

    def __init__(self, where: Where, *elements: Any, when: Where | None = None) -> None:
        object.__setattr__(self, "where", where)
        object.__setattr__(self, "elements", elements)
        object.__setattr__(self, "when", when)

    def _all(self, seen: Seen, kind: str) -> Iterator[Any]:
        for one in seen.each(self.where):
            if one.holds(self.when):
                for element in self.elements:
                    yield from element(one) if callable(element) else getattr(element, kind)(one)

    def tables(self, seen: Seen) -> Iterator[Any]:
        """Of every object."""
        return self._all(seen, "tables")

    def values(self, seen: Seen) -> Iterator[Any]:
        """Of every object."""
        return self._all(seen, "values")

    def figures(self, seen: Seen) -> Iterator[Any]:
        """Of every object."""
        return self._all(seen, "figures")

    def sentences(self, seen: Seen) -> Iterator[str]:
        """Of every object."""
        return self._all(seen, "sentences")
