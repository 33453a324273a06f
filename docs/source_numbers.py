"""A number of a paper, what it is worth, and where fegear's stands.

"Printed" is only what the paper computed or measured and fegear's model answers. No answer, and so "input", is what the
case is given, a zero that holds by construction, arithmetic on what is given, and what a constant of the model was
inferred from. Where the place of a maximum over a grid is read, the grid must be finer than the print is read: else a
member of the grid is found, not a maximum.
"""

from __future__ import annotations

import math
from decimal import Decimal
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field, model_validator
from source_runs import Found, Part, Run

if TYPE_CHECKING:
    from collections.abc import Mapping

#: What each kind of number says, in the order in which the pages count them.
NUMBERS: dict[str, str] = {
    "printed": "in print and reproduced, within half a unit of its last digit or the stated accuracy of reading",
    "read": 'what the paper\'s own text reads off a curve ("about"), reproduced within the stated accuracy of reading',
    "again": "in print a second time, and reproduced: counted once, where it stands first",
    "differs": "in print, and not reproduced; the number says why",
    "input": "in print, and no answer: it can only come back",
    "words": "what the text says in words, without a number; a bound chosen here holds it",
    "regression": "a number of fegear alone, kept so that it does not change unnoticed; nothing is in print",
}
NumberKind = Literal["printed", "read", "again", "differs", "input", "words", "regression"]
#: Kinds that say that a printed answer comes out.
REPRODUCED = ("printed", "read", "again")
#: Why a printed number is no answer.
ORIGINS: dict[str, str] = {
    "given": "put into the case",
    "zero": "zero by construction, whatever the other numbers are",
    "arithmetic": "arithmetic on what is given, without the model",
    "inferred": "what a constant of the model or a place was inferred from",
}
Origin = Literal["given", "zero", "arithmetic", "inferred"]
#: Values that are places of a maximum or minimum among members of a grid.
_PLACES = ("speed_of_", "best_length", "best_amount", "position_of_", "roll_angle_of_")
_TAKES = {"max": max, "min": min, "first": lambda v: v[0], "last": lambda v: v[-1], "mean": lambda v: sum(v) / len(v),
          "ptp": lambda v: max(v) - min(v)}  # fmt: skip


class Grid(Part):
    """What a place was looked for on: a column of a run, and how far apart its members stand about the place.

    Parameters
    ----------
    table, column : str
    where : dict
        The rows that count.
    step : float
        Distance to the next member, the larger of both sides, in the unit of the column.
    """

    table: str
    column: str
    where: dict[str, float | str] = Field(default_factory=dict)
    step: float = Field(gt=0.0)

    def fault(self, run: Run, place: float) -> str:
        """What is wrong with it at a place that was read, or nothing."""
        members = sorted({float(row[self.column]) for row in select(run, self.table, self.column, self.where, {})})
        at = min(range(len(members)), key=lambda k: abs(members[k] - place))
        if at in (0, len(members) - 1):
            return f"the place {place:g} is an end of {self.table}"
        step = max(members[at + 1] - members[at], members[at] - members[at - 1])
        return "" if near(step, self.step, 1e-3) else f"{self.table} has steps of {step:g} there, not {self.step:g}"


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
    origin : str, optional
        Of a number that is input: one of `ORIGINS`.
    by : str, optional
        The arithmetic, ``"28 * 10000 / 60"``, in the printed unit; in a column, ``at`` is the key of the row.
    grid : Grid, optional
        Where the place of a maximum is read: what it was looked for on.
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
    origin: Origin | None = None
    by: str = ""
    grid: Grid | None = None
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
        in_print, own = self.kind in (*REPRODUCED, "input"), self.found is not None
        printed = self.in_print()
        rules = (
            ((self.kind == "input") != (self.origin is not None), "give `origin` where it is input, and only there"),
            (
                (self.origin == "arithmetic") != bool(self.by),
                "give `by` where its origin is arithmetic, and only there",
            ),
            (self.origin == "inferred" and not self.because, "is inferred from; `because` does not say what"),
            (
                self.kind in REPRODUCED and printed is not None and printed.value == 0.0,
                'is zero, which is input of the origin "zero" unless the model could give something else',
            ),
            (self.kind == "read" and self.reading is None, "is read off a curve: give the accuracy of `reading`"),
            (
                self.is_place != (self.grid is not None),
                "give `grid` where it is the place of a maximum, and only there",
            ),
            (
                self.kind in REPRODUCED
                and printed is not None
                and self.grid is not None
                and self.grid.step >= self.accuracy(),
                "was found on a grid that is not finer than the print is read",
            ),
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

    @property
    def is_place(self) -> bool:
        """Whether it is the place of a maximum of what stands at the members of a grid."""
        named = self.value is not None and self.value.partition(".")[2].startswith(_PLACES)
        return named and self.kind not in ("regression", "words") and not self.over

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
        rows = select(run, self.table, self.column, where, near)
        unit = self.column.rpartition("[")[2].rstrip("]") if "[" in self.column else ""
        return Found(value=_TAKES[self.take]([float(row[self.column]) for row in rows]), unit=unit)

    def _misses(self, printed: float) -> str:
        """By how much its arithmetic misses the print, with what half a digit of the row's key moves; else nothing."""
        at = next(iter(self.near.values()), math.nan)
        value = arithmetic(self.by, at)
        moved = 0.0
        if math.isfinite(at):
            half = 0.5 * 10.0 ** int(Decimal(str(at)).as_tuple().exponent)
            moved = max(abs(arithmetic(self.by, at + side * half) - value) for side in (-1.0, 1.0))
        if abs(value - printed) <= self.accuracy() + moved:
            return ""
        return f"{self.by} is {value:.6g}, printed is {self.printed}"

    def fault(self, run: Run) -> str:
        """What is wrong with the number, or nothing."""
        got, printed = self.read(run).value, self.in_print()
        if self.grid is not None and (fault := self.grid.fault(run, got)):
            return f"{self.what}: {fault}"
        if printed is not None and self.by and (fault := self._misses(printed.value)):
            return f"{self.what}: {fault}"
        if self.found is not None and not near(got, self.found, self.tolerance):
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
    origin: Origin | None = None
    by: str = ""

    def numbers(self) -> tuple[Number, ...]:
        """A number for each printed one."""
        return tuple(
            Number(
                kind=self.kind, what=f"{self.what} {at}", case=self.case, printed=f"{text} {self.unit}".strip(),
                table=self.table, column=self.column, near={self.key: float(at)}, reading=self.reading,
                because=self.because, origin=self.origin, by=self.by,
            )
            for at, text in self.printed.items()
        )  # fmt: skip


#: What the arithmetic of a number may call.
_FUNCTIONS = {name: getattr(math, name) for name in ("cos", "hypot", "pi", "radians", "sin", "sqrt", "tan", "acos")}


def arithmetic(text: str, at: float) -> float:
    """Value of a number's arithmetic; `at` is the key of its row."""
    names = {**_FUNCTIONS, "abs": abs, "min": min, "max": max, "at": at}
    return float(eval(text, {"__builtins__": {}}, names))


def select(
    run: Run, table: str, column: str, where: Mapping[str, float | str], near: Mapping[str, float]
) -> list[dict[str, str]]:
    """The rows of a table that count: with the same entries, and nearest to others.

    Raises
    ------
    LookupError
        If a column or every row is missing.
    """
    rows = run.rows(table)
    if rows and (lost := {column, *where, *near} - rows[0].keys()):
        raise LookupError(f"{table} has no column {', '.join(sorted(lost))}; it has {', '.join(rows[0])}")
    for head, entry in where.items():
        rows = [row for row in rows if _same(row[head], entry)]
    for head, wanted in near.items():
        least = min((abs(float(row[head]) - wanted) for row in rows), default=math.inf)
        rows = [row for row in rows if abs(float(row[head]) - wanted) == least]
    if not rows:
        raise LookupError(f"{table} has no row with {where or near}")
    return rows


def near(got: float, wanted: float, tolerance: float) -> bool:
    """Within a relative tolerance; of zero, within an absolute one."""
    return abs(got - wanted) <= tolerance * (abs(wanted) or 1.0)


def _same(cell: str, wanted: float | str) -> bool:
    return cell == wanted if isinstance(wanted, str) else math.isclose(float(cell), wanted, rel_tol=1e-6, abs_tol=1e-12)
