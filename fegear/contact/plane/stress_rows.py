"""Root stress along a fillet per unit line load at many contacts, each evaluated once."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import Array

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray


#: Rows of stress at contacts, by the tooth that is looked at, shape (contacts, points) each.
Rows = dict[int, Array]
#: Contacts that no one asked for now are kept until there are so many times those that are.
_MOST = 4


class _Table(NamedTuple):
    """Rows of contacts, their radii in ascending order, and the row of each."""

    ascending: Array
    row: NDArray[np.intp]
    rows: Rows


class StressRows:
    """Rows of the contacts of one flank: those asked for before are looked up, whatever the load and the relief.

    What is kept does not travel to other processes.
    """

    def __init__(self) -> None:
        self._table: _Table | None = None

    def __reduce__(self) -> tuple[type[StressRows], tuple[()]]:
        """Travel without rows."""
        return StressRows, ()

    def at(self, radius: Array, evaluate: Callable[[Array], Rows]) -> Rows:
        """Rows of contacts at radii, shape (Q,) [m].

        Parameters
        ----------
        radius : ndarray, shape (Q,)
            [m].
        evaluate : callable
            Radii to rows, where they are not known; always that of the same teeth.
        """
        wanted, inverse = np.unique(radius, return_inverse=True)
        table = self._table if self._table is not None and self._table.row.size else None  # none carried load before
        known = np.zeros(wanted.size, dtype=bool)
        if table is not None:
            place = np.minimum(np.searchsorted(table.ascending, wanted), table.ascending.size - 1)
            known = table.ascending[place] == wanted
        if not known.all() or table is None:
            table = self._table = _extended(table if known.any() else None, wanted, known, evaluate)
            place = np.searchsorted(table.ascending, wanted)
        at = table.row[place][inverse]
        return {k: rows[at] for k, rows in table.rows.items()}


def _extended(
    table: _Table | None, wanted: Array, known: NDArray[np.bool_], evaluate: Callable[[Array], Rows]
) -> _Table:
    missing = wanted[~known]
    new = evaluate(missing)
    if table is None:
        return _Table(missing, np.arange(missing.size), new)
    radius, keep = np.empty(table.row.size), np.ones(table.row.size, dtype=bool)
    radius[table.row] = table.ascending
    if table.row.size + missing.size > _MOST * wanted.size:
        keep = np.isin(radius, wanted)
    radius = np.concatenate([radius[keep], missing])
    order = np.argsort(radius)
    return _Table(radius[order], order, {k: np.concatenate([rows[keep], new[k]]) for k, rows in table.rows.items()})
