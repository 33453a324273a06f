"""One side of a comparison, from a run in memory; `fegear.output.comparison` reads one from a folder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.engine.outcome import Table, Value
    from fegear.engine.run import Results


@dataclass(frozen=True, slots=True)
class Side:
    """What is known of a run.

    Parameters
    ----------
    label : str
        By which the reader knows it.
    document : mapping
        The case as it was written, ``--set`` options included; empty where it is not known.
    values : mapping of str to Value
    tables : mapping of str to Table
    """

    label: str
    document: Mapping[str, object]
    values: Mapping[str, Value]
    tables: Mapping[str, Table]


def side_of(results: Results, label: str) -> Side:
    """A run as one side of a comparison."""
    return Side(
        label,
        results.scene.document,
        {value.name: value for value in results.values},
        {table.name: table for table in results.tables},
    )
