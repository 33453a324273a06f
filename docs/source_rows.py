"""The list of what the papers print, ``docs/sources/<paper>.toml``: read, checked, and held against what cases give.

A file names every numbered figure, table and group of equations of its paper (``items``) and says in ``[[row]]`` what
fegear makes of each. ``tests/cases/test_sources_cases.py`` holds the list complete and every number;
``docs/sources.py`` makes the pages from it.
"""

from __future__ import annotations

import csv
import importlib
import io
import json
import math
import shlex
import tomllib
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fegear.cli import COMMANDS
from fegear.engine.citation import bibliography
from fegear.output.tables import table_text
from fegear.unit_text import canonical
from fegear.units import registry

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Set

    from fegear.workbench.results import Results

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "sources"
CASES = ROOT / "cases"

Judgement = Literal["reproduced", "repaired", "differs", "text lost", "sketch"]
#: What each word of judgement says, in the order in which the page counts them.
JUDGEMENTS: dict[str, str] = {
    "reproduced": "fegear gives what is printed, within the tolerance that is stated",
    "repaired": "it gives what is printed once an equation that is damaged in the text is repaired",
    "differs": "it gives something else, and the row says what and why",
    "text lost": "the curve is in no text that we have: fegear draws it, and there is nothing to compare it with",
    "sketch": "a drawing without numbers: the row leads to what fegear draws of the same thing",
}
_TAKES = {"max": max, "min": min, "first": lambda v: v[0], "last": lambda v: v[-1], "mean": lambda v: sum(v) / len(v),
          "ptp": lambda v: max(v) - min(v)}  # fmt: skip


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


def _unit(text: str) -> Any:
    return registry().parse_expression(canonical(text)) if text else registry().Quantity(1.0)


class Found(_Part):
    """A number of a run: its value and its unit."""

    value: float
    unit: str

    def to(self, unit: str) -> Found:
        """The same in another unit."""
        if unit == self.unit:
            return self
        return Found(value=(self.value * _unit(self.unit)).to(_unit(unit).units).magnitude, unit=unit)


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


class Number(_Part):
    """A number or a statement of a paper, and where fegear's stands."""

    what: str
    case: str | None = None
    printed: str | None = None
    statement: str | None = None
    value: str | None = None
    table: str | None = None
    column: str | None = None
    take: Literal["max", "min", "ptp", "first", "last", "mean"] = "first"
    where: dict[str, float | str] = Field(default_factory=dict)
    near: dict[str, float] = Field(default_factory=dict)
    tolerance: float = Field(gt=0.0, le=0.5, default=1e-3)
    found: float | None = None
    most: float | None = None
    least: float | None = None

    @model_validator(mode="after")
    def _whole(self) -> Number:
        if (self.printed is None) == (self.statement is None):
            raise ValueError(f"{self.what}: give `printed` or `statement`")
        if (self.value is None) == (self.table is None) or (self.table is None) != (self.column is None):
            raise ValueError(f"{self.what}: give `value`, or `table` and `column`")
        if self.statement and self.found is None and self.most is None and self.least is None:
            raise ValueError(f"{self.what}: a statement is held by `most`, `least` or `found`")
        return self

    def in_print(self) -> Found | None:
        """The printed number, where there is one."""
        if self.printed is None:
            return None
        number, _, unit = self.printed.partition(" ")
        return Found(value=float(number), unit=unit)

    def read(self, run: Run) -> Found:
        """Fegear's number, in the printed unit."""
        got = run.value(self.value) if self.value is not None else self._from_table(run)
        printed = self.in_print()
        return got if printed is None else got.to(printed.unit)

    def _from_table(self, run: Run) -> Found:
        assert self.table is not None
        assert self.column is not None
        rows = run.rows(self.table)
        if rows and (lost := {self.column, *self.where, *self.near} - rows[0].keys()):
            raise LookupError(f"{self.table} has no column {', '.join(sorted(lost))}; it has {', '.join(rows[0])}")
        for head, wanted in self.where.items():
            rows = [row for row in rows if _same(row[head], wanted)]
        for head, wanted in self.near.items():
            least = min((abs(float(row[head]) - wanted) for row in rows), default=math.inf)
            rows = [row for row in rows if abs(float(row[head]) - wanted) == least]
        if not rows:
            raise LookupError(f"{self.table} has no row with {self.where or self.near}")
        unit = self.column.rpartition("[")[2].rstrip("]") if "[" in self.column else ""
        return Found(value=_TAKES[self.take]([float(row[self.column]) for row in rows]), unit=unit)

    def fault(self, run: Run) -> str:
        """What is wrong with the number, or nothing."""
        got = self.read(run).value
        if self.found is not None and not _near(got, self.found, self.tolerance):
            return f"{self.what}: fegear gives {got:.6g}, the list says {self.found:.6g} within {self.tolerance:g}"
        printed = self.in_print()
        if self.found is None and printed is not None and not _near(got, printed.value, self.tolerance):
            return f"{self.what}: fegear gives {got:.6g}, printed is {self.printed} (within {self.tolerance:g})"
        if self.most is not None and not got <= self.most:
            return f"{self.what}: {got:.6g} is more than {self.most:g}"
        if self.least is not None and not got >= self.least:
            return f"{self.what}: {got:.6g} is less than {self.least:g}"
        return ""


def _near(got: float, wanted: float, tolerance: float) -> bool:
    """Within a relative tolerance; of zero, within an absolute one."""
    return abs(got - wanted) <= tolerance * (abs(wanted) or 1.0)


def _same(cell: str, wanted: float | str) -> bool:
    return cell == wanted if isinstance(wanted, str) else math.isclose(float(cell), wanted, rel_tol=1e-6, abs_tol=1e-12)


class Row(_Part):
    """One figure, table or group of equations (or several that are made together)."""

    covers: tuple[str, ...] = Field(min_length=1)
    shows: str
    case: str | None = None
    command: str | None = None
    function: str | None = None
    picture: str | None = None
    judgement: Judgement
    remark: str = ""
    number: tuple[Number, ...] = ()

    def cases_of_numbers(self) -> list[str]:
        """The case of each number: its own, or the row's."""
        return [number.case or self.case or "" for number in self.number]

    def cases(self) -> list[str]:
        """All cases that the row names, each once."""
        return list(dict.fromkeys(name for name in (self.case or "", *self.cases_of_numbers()) if name))

    def faults(self) -> list[str]:
        """What is wrong with the row as it stands, without a run."""
        wrong = []
        if not (self.case or self.command or self.function):
            wrong.append("names no case, command or function that makes it")
        wrong += [f"cases/{name}.toml is not there" for name in self.cases() if not (CASES / f"{name}.toml").is_file()]
        if (self.picture and not self.case) or not all(self.cases_of_numbers()):
            wrong.append("has a number or a picture, and no case that makes it")
        if self.command and not _is_command(self.command):
            wrong.append(f"{self.command!r} is no command on files that are there")
        if self.function and not _is_there(self.function):
            wrong.append(f"{self.function} is not there")
        if self.judgement in ("reproduced", "repaired"):
            if not (self.number or self.function):
                wrong.append("is called reproduced, and no number or function shows it")
            wrong += [f"{n.what} differs in a row that is called {self.judgement}" for n in self.number if n.found]
        if self.judgement == "differs" and not self.remark:
            wrong.append("differs, and does not say why")
        return [f"{', '.join(self.covers)} {fault}" for fault in wrong]


class Source(_Part):
    """One paper: everything that it numbers, and the rows that answer for it."""

    title: str
    citation: str
    items: tuple[str, ...]
    row: tuple[Row, ...] = ()

    def faults(self) -> list[str]:
        """Items that no row covers, rows that cover something else, and faults of rows."""
        covered = [item for row in self.row for item in row.covers]
        wrong = [f"no row covers {item}" for item in self.items if item not in covered]
        wrong += [f"a row covers {item}, which is no item of the paper" for item in covered if item not in self.items]
        wrong += [f"{item} is listed twice" for item in set(self.items) if self.items.count(item) > 1]
        if self.citation not in bibliography():
            wrong.append(f"the bibliography has no {self.citation}")
        return wrong + [fault for row in self.row for fault in row.faults()]


@cache
def sources() -> dict[str, Source]:
    """The papers by the names of their files."""
    return {path.stem: Source(**tomllib.loads(path.read_text("utf-8"))) for path in sorted(FOLDER.glob("*.toml"))}


def _is_there(name: str) -> bool:
    """Whether a module, or something in one (a method of a class, too), goes by this name."""
    path = name.split(".")
    for cut in range(len(path), 0, -1):
        try:
            target = importlib.import_module(".".join(path[:cut]))
        except ModuleNotFoundError:
            continue
        return all((target := getattr(target, part, None)) is not None for part in path[cut:])
    return False


def _is_command(command: str) -> bool:
    program, name, *rest = shlex.split(command)
    known = {one.__name__ for one, _ in COMMANDS}
    files = [word for word in rest if word.endswith(".toml")]
    return program == "fegear" and name in known and all((ROOT / file).is_file() for file in files)


def cases() -> list[str]:
    """Every case that a row names, ``sources/mark_fig22``."""
    return sorted({name for source in sources().values() for row in source.row for name in row.cases()})


def faults_of_runs(case: str, run: Run) -> list[str]:
    """Numbers of all papers that the run of a case does not hold."""
    wrong = []
    for name, source in sources().items():
        for row in source.row:
            for number, made_by in zip(row.number, row.cases_of_numbers(), strict=True):
                if made_by == case:
                    try:
                        fault = number.fault(run)
                    except (LookupError, ValueError) as error:
                        fault = f"{number.what}: {error}"
                    wrong += [f"{name}, {', '.join(row.covers)}: {fault}"] if fault else []
    return wrong
