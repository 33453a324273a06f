"""The pieces that pages are made of: texts, facts, values, tables, plots, pictures, folded parts."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.printed import rounded
from fegear.base.spoken_names import spoken
from fegear.engine.inexact import is_inexact
from fegear.output.numbers import plain_number, pretty_unit, with_error
from fegear.output.tables import cells, read_cells, table_file

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fegear.base.notes import Note
    from fegear.engine.figure.figure import Figure
    from fegear.engine.table import Column, Table
    from fegear.engine.value import Value
    from fegear.output.draw_png import Picture

#: Rows of a table that stand in the page as text; the others are a click away.
_ROWS = 6
#: Rows of a brief table, and its digits where nothing is known of an error.
_BRIEF_ROWS, _BRIEF = 24, 3
#: Tables of so few rows with more columns than this stand on their side.
_BESIDE = 8
#: Longer cells than this are sentences.
_WORDS = 24
#: More columns than this cannot be read on a sheet of paper.
_ON_PAPER = 11
#: Digits of a number that a person reads where nothing is known of its error.
_READ = 4
#: Larger errors than this share of the value are given as absolute numbers alone.
_MEANINGLESS = 0.5


class Block:
    """A piece of a page: plain data, drawn by the macro of its class's name in ``templates/blocks.html``."""


#: Symbols at the beginning of a name: K_Hbeta, S_F, sigma_H, C_Hbeta.
_SYMBOL = re.compile(r"([A-Z]|sigma)_([A-Z][A-Za-z]*)(?![A-Za-z])")


@dataclass(frozen=True)
class Paragraph(Block):
    """A paragraph."""

    words: str
    kind: str = ""


@dataclass(frozen=True)
class Heading(Block):
    """A heading inside a section."""

    words: str


@dataclass(frozen=True)
class Notes(Block):
    """Sentences that the reader should see; `kind` is ``warning`` where they change what the numbers mean."""

    sentences: Sequence[str]
    kind: str = "note-list"


@dataclass(frozen=True)
class ClassifiedNotes(Block):
    """Notes of a run, each with its class."""

    notes: Sequence[Note]


@dataclass(frozen=True)
class Listed(Block):
    """Anything plain in a row, with commas between."""

    items: Sequence[object]


@dataclass(frozen=True)
class Facts(Block):
    """Names and what belongs to them."""

    found: Mapping[str, object]


@dataclass(frozen=True)
class Grid(Block):
    """A small table of anything plain."""

    heads: Sequence[str]
    rows: Sequence[Sequence[object]]
    kind: str = ""


@dataclass(frozen=True)
class Bars(Block):
    """What each part took, as bars that print."""

    parts: Mapping[str, float]
    unit: str

    @property
    def rows(self) -> list[tuple[str, str, str]]:
        """Name, length in percent and value of each bar."""
        largest = max(self.parts.values(), default=0.0) or 1.0
        return [(name, f"{100 * v / largest:.1f}", f"{v:.3f} {self.unit}") for name, v in self.parts.items()]


@dataclass(frozen=True)
class Folded(Block):
    """Blocks behind a line to click on."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Group(Block):
    """Blocks that stay together, with other groups at their side where the page is broad."""

    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Code(Block):
    """A file as it is."""

    content: str


@dataclass(frozen=True)
class Switch(Block):
    """A box to tick that shows what is hidden without it; the page's style knows it by its name."""

    name: str
    words: str


@dataclass(frozen=True)
class Download(Block):
    """A button that hands out a file of the page."""

    file: str


@dataclass(frozen=True)
class Values(Block):
    """Single results: what they are, their numbers as people read them, and with all digits and errors on request."""

    values: Sequence[Value]
    tolerance: float | None = None

    @property
    def rows(self) -> list[ValueRow]:
        """Each value as it stands in the table."""
        several = len({value.name.partition(".")[0] for value in self.values if "." in value.name}) > 1
        return [self._row(value, several=several) for value in self.values]

    def _row(self, value: Value, *, several: bool) -> ValueRow:
        what, more = spoken(value.name), value.meaning
        if not what and more:
            what, more = ": ".join((*value.name.split(".")[1:-1], more)), ""
        if several and "." in value.name:
            what = f"{value.name.partition('.')[0]}: {what}".removesuffix(": ")
        shown, error = value_cells(value)
        row = ValueRow(value.name, what, more, _short_value(value), shown, "", error, "", value.unit)
        if error in ("exact", "not estimated"):
            return row
        share = relative_error(value)
        percent = "" if share is None else f"{plain_number(100.0 * share, 2)} %"
        over = self.tolerance is not None and is_inexact(value, self.tolerance)
        rough = f"± {percent or _short(f'{value.error:.1g}')}" if over else ""
        return replace(row, error=f"± {error}", remark=f"({percent})" if percent else "", rough=rough)


@dataclass(frozen=True)
class ValueRow:
    """A single result as a table has it.

    Parameters
    ----------
    name : str
        Its identifier.
    what, more : str
        What it is, for people: its identifier in words, and its meaning; of a symbol its meaning only.
    short, shown : str
        The number as a person reads it, and with all digits that its error leaves.
    error, remark : str
        Its estimated error, and the error's share or what there is in place of it.
    rough : str
        The error where it is large enough to change a decision; else empty.
    unit : str
    """

    name: str
    what: str
    more: str
    short: str
    shown: str
    error: str
    remark: str
    rough: str
    unit: str


def _short_value(value: Value) -> str:
    """Few digits of what is computed; sizes that are exact keep theirs."""
    if not math.isfinite(value.value) or (value.error == 0.0 and value.unit == "mm"):
        return plain_number(value.value)  # sizes of a drawing
    if not value.error:
        return plain_number(value.value, _READ)
    return plain_number(float(rounded(value.value, value.error).partition(" ")[0]))


def value_cells(value: Value) -> tuple[str, str]:
    """Value and error of a result as two texts."""
    error = value.error
    if error is None:
        return plain_number(value.value), "not estimated"
    if error <= 0.0:
        return plain_number(value.value), "exact"
    return with_error(value.value, error)


def relative_error(value: Value) -> float | None:
    """Estimated error over the value; None where there is no estimate or the value is as good as zero."""
    if not value.error or not value.value:
        return None
    share = abs(value.error / value.value)
    return share if share <= _MEANINGLESS else None


@dataclass(frozen=True)
class DataTable(Block):
    """The beginning of a table, with what it takes to see all of it, to sort it and to download it.

    A table of few rows and many columns stands on its side, so that no column is out of sight.

    Parameters
    ----------
    table : Table
    brief : bool
        Beside an answer: all of its rows, with the digits that a person reads; all digits and errors on request.
    as_on_terminal : bool
        Of a brief one, whether its columns have the digits that the terminal shows.
    """

    table: Table
    brief: bool = False
    as_on_terminal: bool = False

    @property
    def file(self) -> str:
        """Name of the file that holds all of it."""
        return f"tables/{table_file(self.table)}"

    @property
    def count(self) -> int:
        """Number of rows of the whole table."""
        return len(self.table.columns[0])

    @property
    def on_its_side(self) -> bool:
        """Whether quantities stand below each other."""
        return self.count <= _ROWS and len(self.table.columns) > _BESIDE

    @property
    def broad(self) -> bool:
        """Whether a sheet of paper is too narrow for it."""
        return not self.on_its_side and len(self.table.columns) > _ON_PAPER

    @property
    def texts(self) -> list[bool]:
        """Of each column, whether its cells are sentences, which are broken into lines."""
        return [
            column.values.dtype.kind != "f" and max(map(len, cells(column.values)), default=0) > _WORDS
            for column in self.table.columns
        ]

    @property
    def sides(self) -> list[tuple[str, str, str, bool, tuple[tuple[str, str], ...]]]:
        """Name, unit, meaning, whether it is an error, and values of each quantity of a table on its side."""
        return [(*head, row) for head, row in zip(self.heads, zip(*self.rows, strict=True), strict=True)]

    @property
    def heads(self) -> list[tuple[str, str, str, bool]]:
        """Name, unit and meaning of each column, and whether it is the error of another one."""
        names = {f"{column.name}_error" for column in self.table.columns}
        return [(*_name_and_unit(column), column.explained, column.name in names) for column in self.table.columns]

    @property
    def rows(self) -> list[tuple[tuple[str, str], ...]]:
        """The first rows: of each cell what a person reads, and all digits; equal where the table is not brief."""
        count = _BRIEF_ROWS if self.brief else _ROWS
        full = [[_short(one) for one in cells(column.values[:count])] for column in self.table.columns]
        if not self.brief:
            return list(zip(*([(one, one) for one in column] for column in full), strict=True))
        errors = {
            one.name.removesuffix("_error"): one.values for one in self.table.columns if one.name.endswith("_error")
        }
        columns = [
            list(
                zip(
                    read_cells(column.values) if self.as_on_terminal else _read(column, errors.get(column.name)),
                    shown,
                    strict=False,
                )
            )
            for column, shown in zip(self.table.columns, full, strict=True)
        ]
        return list(zip(*columns, strict=True))


@dataclass(frozen=True)
class SheetGroup:
    """Columns of a table that stand together as rows below a heading."""

    title: str
    columns: tuple[Column, ...]

    @property
    def rows(self) -> list[tuple[str, str, tuple[str, ...]]]:
        """What each row is, its unit and its values."""
        return [
            (column.explained, column.unit, tuple(_short(one) for one in cells(column.values)))
            for column in self.columns
        ]


@dataclass(frozen=True)
class Sheet(Block):
    """A short table on its side: a row for each quantity, a column for each gear.

    Parameters
    ----------
    heads : tuple of str
        Over the columns of values.
    groups : tuple of SheetGroup
    shared : tuple of (str, str, str)
        What belongs to all columns together: what it is, its value, its unit.
    """

    heads: tuple[str, ...]
    groups: tuple[SheetGroup, ...]
    shared: tuple[tuple[str, str, str], ...] = ()


def _read(column: Column, errors: NDArray[np.generic] | None) -> list[str]:
    """Cells of a column with the digits that their errors allow and a person reads."""
    if column.values.dtype.kind != "f":
        return [_short(one) for one in cells(column.values)]
    known = [0.0] * len(column) if errors is None else errors.tolist()
    return [_read_cell(value, error) for value, error in zip(column.values.tolist(), known, strict=True)]


def _read_cell(value: float, error: float) -> str:
    if not math.isfinite(value):
        return ""
    if not error > 0.0 or not math.isfinite(error):
        return plain_number(float(f"{value:.{_BRIEF}g}"))
    return plain_number(float(rounded(value, error, _READ).partition(" ")[0]))


def _name_and_unit(column: Column) -> tuple[str, str]:
    """Name and unit as people read them; some tables have the unit in the name."""
    name, unit = column.name, column.unit
    if name.endswith("]"):
        name, _, within = name[:-1].partition(" [")
        unit = unit or within
    return as_words(name), pretty_unit(unit)


def _short(shown: str) -> str:
    try:
        return plain_number(float(shown)) if not shown.lstrip("-").isdigit() else shown.replace("-", "−")
    except ValueError:
        return shown


@dataclass(frozen=True)
class Plot(Block):
    """An interactive figure; the page's script draws it."""

    figure: Figure


@dataclass(frozen=True)
class Still(Block):
    """A picture of the folder ``plots``, embedded."""

    picture: Picture


def as_words(name: object) -> str:
    """A name as words, symbols as written in the trade (K_Hβ); names with dots are keys and stay as they are."""
    text = str(name)
    if "." in text:
        return text
    symbol = _SYMBOL.match(text)
    if symbol is None:
        return text.replace("_", " ")
    letter, lower = symbol.groups()
    for word, greek in (("alpha", "α"), ("beta", "β")):
        lower = lower.replace(word, greek)
    return f"{'σ' if letter == 'sigma' else letter}_{lower}{text[symbol.end() :].replace('_', ' ')}"


def readable(value: object) -> Block | str:
    """Anything plain as people read it: numbers short, mappings and lists of mappings as tables, lists in a row."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return plain_number(value)
    if isinstance(value, Mapping):
        return Facts(value)
    if isinstance(value, str) or not isinstance(value, Sequence):
        return str(value)
    if value and all(isinstance(item, Mapping) for item in value):
        keys = list(dict.fromkeys(str(key) for item in value for key in item))
        return Grid([as_words(key) for key in keys], [[item.get(key, "") for key in keys] for item in value])
    return Listed(value)
