"""The list of what the papers print, ``docs/sources/<paper>.toml``: read, checked, and held against what cases give.

A file names every numbered figure, table and group of equations of its paper (``items``) and says in ``[[row]]`` what
fegear makes of each. ``tests/cases/test_sources_cases.py`` holds the list complete and every number;
``docs/sources.py`` makes the pages from it.
"""

from __future__ import annotations

import importlib
import math
import shlex
import tomllib
from decimal import Decimal
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field, model_validator
from source_inputs import answer_in_input
from source_runs import Found, Part, Run

from fegear.cli import COMMANDS
from fegear.engine.citation import bibliography

if TYPE_CHECKING:
    from collections.abc import Mapping

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "sources"
CASES = ROOT / "cases"

#: What each kind of number says, in the order in which the pages count them.
NUMBERS: dict[str, str] = {
    "printed": "in print and reproduced, within half a unit of its last digit or the stated accuracy of reading",
    "differs": "in print, and not reproduced; the number says why",
    "input": "in print, and put into the case, or what the case's input was worked out from: it can only come back",
    "words": "what the text says in words, without a number; a bound chosen here holds it",
    "regression": "a number of fegear alone, kept so that it does not change unnoticed; nothing is in print",
}
#: What each kind of row says: by its numbers, or without any.
ROWS: dict[str, str] = {
    "printed": "printed numbers, and fegear reproduces all of them",
    "in part": "fegear reproduces some of what is printed, and not all",
    "differs": "fegear reproduces nothing of what is printed, and says why",
    "words": "described in words, and fegear's numbers agree with the words",
    "input": "printed numbers that the cases take as they are",
    "equation": "equations without a printed result; the tests named compare them with another method",
    "regression": "nothing in print to compare with; fegear's own numbers are kept",
    "text lost": "the curve is in no text that we have: fegear draws it, and there is nothing to compare it with",
    "sketch": "a drawing without numbers: the row leads to what fegear draws of the same thing",
}
NumberKind = Literal["printed", "differs", "input", "words", "regression"]
RowKind = Literal["printed", "in part", "differs", "words", "input", "equation", "regression", "text lost", "sketch"]
_TAKES = {"max": max, "min": min, "first": lambda v: v[0], "last": lambda v: v[-1], "mean": lambda v: sum(v) / len(v),
          "ptp": lambda v: max(v) - min(v)}  # fmt: skip


class Number(Part):
    """A number or a statement of a paper, and where fegear's stands.

    Parameters
    ----------
    kind : str
        One of `NUMBERS`.
    what : str
    case, kept : str, optional
        The case that makes it, else the row's; or the folder in docs/sources that keeps what a run gave that is too
        long for the site.
    printed : str, optional
        As printed, with its unit: ``"338 lbf"``.
    reading : float, optional
        Accuracy of the print in its own unit, where that is not half a unit of the last digit; `because` says why.
    statement : str, optional
        What the text says in words.
    because : str
        Why it differs, or why the print is less accurate than its digits; one sentence.
    value, table, column, take, where, near
        Where fegear's number stands: a single value, or what is taken of a column's rows.
    over : dict
        What it is divided by: ``{ value = "..." }``, or the entries of `where` and `near` that are other there.
    found, tolerance : float
        Fegear's number where it is none of the printed ones, and within which part of it.
    most, least : float, optional
        Bounds.
    """

    kind: NumberKind
    what: str
    case: str | None = None
    kept: str | None = None
    printed: str | None = None
    reading: float | None = Field(gt=0.0, default=None)
    statement: str | None = None
    because: str = ""
    value: str | None = None
    table: str | None = None
    column: str | None = None
    take: Literal["max", "min", "ptp", "first", "last", "mean"] = "first"
    where: dict[str, float | str] = Field(default_factory=dict)
    near: dict[str, float] = Field(default_factory=dict)
    over: dict[str, float | str] = Field(default_factory=dict)
    tolerance: float = Field(gt=0.0, le=0.5, default=1e-3)
    found: float | None = None
    most: float | None = None
    least: float | None = None

    @model_validator(mode="after")
    def _whole(self) -> Number:
        in_print, own = self.kind in ("printed", "input"), self.found is not None
        rules = (
            (in_print and self.printed is None, f"is {self.kind}, and no printed number is given"),
            (in_print and own, "is in print: fegear's number is not listed"),
            (
                self.kind == "words" and not (self.statement and self._bounded),
                "needs `statement`, and `most` or `least`",
            ),
            (
                self.kind == "regression" and bool(self.printed or self.statement),
                "is fegear's own, has nothing in print",
            ),
            (self.kind == "regression" and not (own or self._bounded), "needs `found`, `most` or `least`"),
            (self.kind == "differs" and not (self.printed or self.statement), "differs from nothing: give `printed`"),
            (self.kind == "differs" and not own, "differs, and `found` does not say by how much"),
            (self.kind == "differs" and not self.because, "differs, and `because` does not say why"),
            (self.reading is not None and not self.because, "is read less accurately; `because` does not say why"),
            (bool(self.printed and self.statement), "give `printed` or `statement`"),
            ((self.value is None) == (self.table is None), "give `value`, or `table` and `column`"),
            ((self.table is None) != (self.column is None), "give `table` and `column`"),
        )
        for wrong, said in rules:
            if wrong:
                raise ValueError(f"{self.what}: {said}")
        return self

    @property
    def _bounded(self) -> bool:
        return self.most is not None or self.least is not None

    def in_print(self) -> Found | None:
        """The printed number, where there is one."""
        if self.printed is None:
            return None
        number, _, unit = self.printed.partition(" ")
        return Found(value=float(number), unit=unit)

    def accuracy(self) -> float:
        """Half a unit of the last printed digit, or the stated accuracy of reading, in the printed unit."""
        assert self.printed is not None
        last = Decimal(self.printed.partition(" ")[0]).as_tuple().exponent
        return self.reading if self.reading is not None else 0.5 * 10.0 ** int(last)

    def read(self, run: Run) -> Found:
        """Fegear's number, in the printed unit."""
        got = self._found(run, self.value, self.where, self.near)
        if self.over:
            other = {key: value for key, value in self.over.items() if key != "value"}
            where, near = (
                {**part, **{key: other[key] for key in part if key in other}} for part in (self.where, self.near)
            )
            value = self.over.get("value")
            below = self._found(run, value if value is None else str(value), where, near)
            return Found(value=got.value / below.to(got.unit).value, unit="")
        printed = self.in_print()
        return got if printed is None else got.to(printed.unit)

    def _found(self, run: Run, value: str | None, where: Mapping[str, Any], near: Mapping[str, Any]) -> Found:
        """A single value, or what is taken of a table's rows."""
        if value is not None:
            return run.value(value)
        assert self.table is not None
        assert self.column is not None
        rows = run.rows(self.table)
        if rows and (lost := {self.column, *where, *near} - rows[0].keys()):
            raise LookupError(f"{self.table} has no column {', '.join(sorted(lost))}; it has {', '.join(rows[0])}")
        for head, wanted in where.items():
            rows = [row for row in rows if _same(row[head], wanted)]
        for head, wanted in near.items():
            least = min((abs(float(row[head]) - wanted) for row in rows), default=math.inf)
            rows = [row for row in rows if abs(float(row[head]) - wanted) == least]
        if not rows:
            raise LookupError(f"{self.table} has no row with {where or near}")
        unit = self.column.rpartition("[")[2].rstrip("]") if "[" in self.column else ""
        return Found(value=_TAKES[self.take]([float(row[self.column]) for row in rows]), unit=unit)

    def fault(self, run: Run) -> str:
        """What is wrong with the number, or nothing."""
        got, printed = self.read(run).value, self.in_print()
        if self.found is not None and not _near(got, self.found, self.tolerance):
            return f"{self.what}: fegear gives {got:.6g}, the list says {self.found:.6g} within {self.tolerance:g}"
        if printed is not None:
            within = abs(got - printed.value) <= self.accuracy() * (1.0 + 1e-9)
            if self.kind != "differs" and not within:
                return f"{self.what}: fegear gives {got:.6g}, printed is {self.printed} (within {self.accuracy():g})"
            if self.kind == "differs" and within:
                return f"{self.what}: {got:.6g} is what is printed, {self.printed}, and the list says that it differs"
        if self.most is not None and not got <= self.most:
            return f"{self.what}: {got:.6g} is more than {self.most:g}"
        if self.least is not None and not got >= self.least:
            return f"{self.what}: {got:.6g} is less than {self.least:g}"
        return ""


class Series(Part):
    """A printed column: numbers of one kind by the rows of one table, ``printed = { "1" = "1.61803", ... }``."""

    kind: NumberKind
    what: str
    case: str | None = None
    table: str
    column: str
    key: str
    unit: str = ""
    printed: dict[str, str] = Field(min_length=1)
    reading: float | None = None
    because: str = ""

    def numbers(self) -> tuple[Number, ...]:
        """A number for each printed one."""
        return tuple(
            Number(
                kind=self.kind, what=f"{self.what} {at}", case=self.case, printed=f"{text} {self.unit}".strip(),
                table=self.table, column=self.column, near={self.key: float(at)}, reading=self.reading,
                because=self.because,
            )
            for at, text in self.printed.items()
        )  # fmt: skip


def _near(got: float, wanted: float, tolerance: float) -> bool:
    """Within a relative tolerance; of zero, within an absolute one."""
    return abs(got - wanted) <= tolerance * (abs(wanted) or 1.0)


def _same(cell: str, wanted: float | str) -> bool:
    return cell == wanted if isinstance(wanted, str) else math.isclose(float(cell), wanted, rel_tol=1e-6, abs_tol=1e-12)


class Row(Part):
    """One figure, table or group of equations (or several that are made together).

    Parameters
    ----------
    covers : tuple of str
        Items of the paper.
    shows : str
    case, command, function : str, optional
        What makes it.
    picture : str, optional
        Of the case's plots.
    kind : str
        One of `ROWS`; its numbers must bear it out.
    repaired : bool
        Whether an equation is damaged in the text, and was derived anew.
    tests : tuple of str
        Tests that hold the equations, ``literature/test_x.py::test_y``.
    remark : str
    number, series : tuple
    """

    covers: tuple[str, ...] = Field(min_length=1)
    shows: str
    case: str | None = None
    command: str | None = None
    function: str | None = None
    picture: str | None = None
    kind: RowKind
    repaired: bool = False
    tests: tuple[str, ...] = ()
    remark: str = ""
    number: tuple[Number, ...] = ()
    series: tuple[Series, ...] = ()

    @property
    def numbers(self) -> tuple[Number, ...]:
        """Its numbers, those of its columns last."""
        return self.number + tuple(one for series in self.series for one in series.numbers())

    def cases_of_numbers(self) -> list[str]:
        """The case of each number: its own, or the row's."""
        return [number.case or self.case or "" for number in self.numbers]

    def cases(self) -> list[str]:
        """All cases that the row names, each once."""
        return list(dict.fromkeys(name for name in (self.case or "", *self.cases_of_numbers()) if name))

    def count(self, kind: str) -> int:
        """How many of its numbers are of a kind."""
        return sum(number.kind == kind for number in self.numbers)

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
        wrong += [f"tests/{name} is not there" for name in self.tests if not _is_test(name)]
        wrong += self._faults_of_kind()
        wrong += [f"{n.what}: {key} of the case holds what is printed" for n, key in self._answers() if key]
        return [f"{', '.join(self.covers)} {fault}" for fault in wrong]

    def _answers(self) -> list[tuple[Number, str]]:
        """Printed numbers that are not called input, and where their case holds them all the same."""
        return [
            (number, answer_in_input(printed, _case(case)))
            for number, case in zip(self.numbers, self.cases_of_numbers(), strict=True)
            if number.kind in ("printed", "differs") and number.kept is None and (printed := number.in_print())
        ]

    def _faults_of_kind(self) -> list[str]:
        """Where the row is called what its numbers do not bear out."""
        has = {kind: self.count(kind) > 0 for kind in NUMBERS}
        compared = has["printed"] or has["differs"]
        rules = {
            "printed": (has["printed"] and not has["differs"], "a printed number, and none that differs"),
            "in part": (has["differs"] and (has["printed"] or has["words"]), "one that holds and one that differs"),
            "differs": (has["differs"] and not has["printed"], "a number that differs, and none that is reproduced"),
            "words": (has["words"] and not compared, "a statement, and no printed number"),
            "input": (has["input"] and not (compared or has["words"]), "printed numbers that are input, and no others"),
            "equation": (bool(self.tests) and not compared, "tests, and no printed number"),
            "regression": (
                has["regression"] and not (compared or has["words"] or has["input"]), "fegear's own numbers alone"
            ),
            "text lost": (not compared, "no printed number"),
            "sketch": (not compared, "no printed number"),
        }  # fmt: skip
        holds, needed = rules[self.kind]
        return [] if holds else [f"is called {self.kind!r}, which needs {needed}"]


class Source(Part):
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


def kept(folder: str) -> Run:
    """What a run gave that is too long for the site, as it lies in docs/sources."""
    return Run.in_folder(FOLDER / folder)


@cache
def _case(name: str) -> dict[str, Any]:
    """A case as its file has it; nothing where there is none, which is another fault."""
    path = CASES / f"{name}.toml"
    return tomllib.loads(path.read_text("utf-8")) if path.is_file() else {}


def _is_test(name: str) -> bool:
    """Whether tests/ has this test, ``literature/test_x.py::test_y``."""
    file, _, function = name.partition("::")
    path = ROOT / "tests" / file
    return path.is_file() and f"\ndef {function}(" in path.read_text("utf-8")


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
    """Numbers of all papers that the run of a case, and what is kept of longer ones, do not hold."""
    wrong = []
    for name, source in sources().items():
        for row in source.row:
            for number, made_by in zip(row.numbers, row.cases_of_numbers(), strict=True):
                if made_by == case:
                    try:
                        fault = number.fault(kept(number.kept) if number.kept else run)
                    except (LookupError, ValueError) as error:
                        fault = f"{number.what}: {error}"
                    wrong += [f"{name}, {', '.join(row.covers)}: {fault}"] if fault else []
    return wrong
