"""Numbers of a run with their units, as `fegear run` leaves them or as they come from Python."""

from __future__ import annotations

import csv
import io
import json
from functools import partial
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict

from fegear.base.unit_text import canonical
from fegear.base.units import registry
from fegear.output.tables import table_text

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Set
    from pathlib import Path

    from fegear.workbench.results import Results


class Part(BaseModel):
    """Of a list: unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def unit_of(text: str) -> Any:
    """One of a unit, by its text; without one a plain 1."""
    return registry().parse_expression(canonical(text)) if text else registry().Quantity(1.0)


class Found(Part):
    """A number of a run: its value and its unit."""

    value: float
    unit: str

    def to(self, unit: str) -> Found:
        """The same in another unit."""
        if unit == self.unit:
            return self
        return Found(value=(self.value * unit_of(self.unit)).to(unit_of(unit).units).magnitude, unit=unit)


class Run:
    """What a run found: single values, and tables as the text of their files.

    Parameters
    ----------
    values : mapping of str to Found
    tables : mapping of str to callable
        Gives the text of the table's CSV file.
    pictures : set of str
        Names of the files in ``plots/``.
    """

    def __init__(
        self, values: Mapping[str, Found], tables: Mapping[str, Callable[[], str]], pictures: Set[str] = frozenset()
    ) -> None:
        self._values, self._tables, self.pictures = values, tables, pictures

    @classmethod
    def in_folder(cls, folder: Path) -> Run:
        """What ``fegear run`` left in its folder."""
        summary = json.loads((folder / "summary.json").read_text("utf-8"))["results"]
        values = {
            name: Found(value=found["value"], unit=found["unit"])
            for name, found in summary.items()
            if found["value"] is not None
        }
        tables = {path.stem: partial(path.read_text, "utf-8") for path in sorted((folder / "tables").glob("*.csv"))}
        return cls(values, tables, {path.name for path in (folder / "plots").glob("*.png")})

    @classmethod
    def of(cls, results: Results) -> Run:
        """What `fegear.run` found, as its files would have it."""
        values = {one.name: Found(value=one.value, unit=one.unit) for one in results.values if one.value is not None}
        return cls(values, {table.name: partial(table_text, table) for table in results.tables})

    def value(self, name: str) -> Found:
        """A single value of ``summary.json``."""
        if name not in self._values:
            raise LookupError(f"no value {name!r}; there are {', '.join(self._values)}")
        return self._values[name]

    def rows(self, table: str) -> list[dict[str, str]]:
        """The lines of a table, each by its heads."""
        if table not in self._tables:
            raise LookupError(f"no table {table!r}; there are {', '.join(self._tables)}")
        return list(csv.DictReader(io.StringIO(self._tables[table]())))
