"""The list of what the papers print, ``docs/sources/<paper>.toml``: read, checked, and held against what cases give.

A file names every numbered figure, table and group of equations of its paper (``items``) and says in ``[[row]]`` what
fegear makes of each. ``tests/cases/test_sources_cases.py`` holds the list complete and every number;
``docs/sources.py`` makes the pages from it.
"""

from __future__ import annotations

import importlib
import shlex
import tomllib
from functools import cache
from pathlib import Path
from typing import Any, Literal

from pydantic import Field
from source_inputs import answer_in_input
from source_numbers import NUMBERS, REPRODUCED, Number, Series
from source_runs import Part, Run

from fegear.cli import COMMANDS
from fegear.engine.citation import bibliography

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "sources"
CASES = ROOT / "cases"

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
RowKind = Literal["printed", "in part", "differs", "words", "input", "equation", "regression", "text lost", "sketch"]


class Tried(Part):
    """A reading of the text, or a choice of what it leaves open, that was tried where a number differs.

    Parameters
    ----------
    what : str
    case : str, optional
        The case that was run, else that of the number.
    set : tuple of str
        What was set in it, ``KEY=VALUE`` as after ``--set``.
    gave : dict
        What each number of the row, by its `what`, came to.
    read : dict
        Where such a number stands elsewhere than in the row: entries of `Number` that are other here.
    tolerance : float
        Relative, of `gave`.
    test : str, optional
        The test that shows it, where it is no run of a case.
    """

    what: str
    case: str | None = None
    set: tuple[str, ...] = ()
    gave: dict[str, float] = Field(min_length=1)
    read: dict[str, dict[str, Any]] = Field(default_factory=dict)
    tolerance: float = Field(gt=0.0, le=0.05, default=2e-3)
    test: str | None = None

    @property
    def runs(self) -> bool:
        """Whether it is a run of a case."""
        return self.test is None


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
    trial : tuple of str
        What is set in all that was tried, as `Tried.set`: fewer speeds.
    tried : tuple of Tried
        Where numbers differ: what was tried, with what it gave.
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
    trial: tuple[str, ...] = ()
    tried: tuple[Tried, ...] = ()

    @property
    def verdict(self) -> str:
        """Whether what is printed holds, or differs and it is said what was tried."""
        return "differs" if self.kind in ("differs", "in part") else "held"

    def named(self, what: str) -> tuple[Number, str]:
        """A number by its name, and the case that makes it."""
        return next((n, c) for n, c in zip(self.numbers, self.cases_of_numbers(), strict=True) if n.what == what)

    def case_of(self, tried: Tried) -> str:
        """The case of something tried: its own, or that of the numbers that it names."""
        return tried.case or self.named(next(iter(tried.gave)))[1]

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
        wrong += self._faults_of_tried()
        wrong += [f"{n.what}: {key} of the case holds what is printed" for n, key in self._answers() if key]
        return [f"{', '.join(self.covers)} {fault}" for fault in wrong]

    def _answers(self) -> list[tuple[Number, str]]:
        """Printed numbers that are not called input, and where their case holds them all the same."""
        return [
            (number, answer_in_input(printed, _case(case)))
            for number, case in zip(self.numbers, self.cases_of_numbers(), strict=True)
            if number.kind in (*REPRODUCED, "differs") and number.kept is None and (printed := number.in_print())
        ]

    def untried(self) -> list[str]:
        """Numbers that differ, and nothing was tried."""
        tried = {what for one in self.tried for what in one.gave}
        return [n.what for n in self.numbers if n.kind == "differs" and n.what not in tried]

    def reading(self, tried: Tried, what: str) -> Number:
        """A number as it is read in what was tried."""
        number, _ = self.named(what)
        return number.model_copy(update={"kept": None, **tried.read.get(what, {})})

    def _faults_of_tried(self) -> list[str]:
        """Where something was tried that no number asks for, or that nobody can repeat."""
        differ = {number.what for number in self.numbers if number.kind == "differs"}
        named = [(t, what) for t in self.tried for what in (*t.gave, *t.read)]
        wrong = [f"{t.what!r} names {what!r}, which does not differ" for t, what in named if what not in differ]
        wrong += [
            f"{t.what!r} sets nothing" for t in self.tried if t.runs and not (t.set or t.case or t.read or self.trial)
        ]
        wrong += [f"{t.what!r} sets what its test does not run" for t in self.tried if t.test and (t.set or t.case)]
        return wrong + [f"tests/{t.test} is not there" for t in self.tried if t.test and not _is_test(t.test)]

    def _faults_of_kind(self) -> list[str]:
        """Where the row is called what its numbers do not bear out."""
        has = {kind: self.count(kind) > 0 for kind in NUMBERS}
        has["printed"] = any(has[kind] for kind in REPRODUCED)
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

    def verdicts(self) -> dict[str, str]:
        """Of every item: "held", or "differs" where a row that covers it says so; none where no row does."""
        found: dict[str, str] = {}
        for row in self.row:
            for item in row.covers:
                found[item] = "differs" if "differs" in (row.verdict, found.get(item)) else "held"
        return found

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
    known = {name for name, _, _ in COMMANDS}
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
