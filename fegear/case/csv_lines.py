"""Lines of a CSV file as measuring programs export them: what parts the entries, where the heads are, decimal commas.

What can be read in one way only is read, and said; what can be read in two is refused.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from fegear.base.errors import InputError, shown
from fegear.base.unit_text import plain_number
from fegear.case.text_file import read_table_text

#: Most lines of a table: some seconds of reading.
_MOST_LINES = 400_000
#: Lines in which the heads are looked for.
_ABOVE = 100
#: What may part entries, the usual one first.
_PARTINGS = ",;\t"
#: A head and its unit: ``angle [deg]``, ``angle (deg)``, ``angle / deg``, ``angle in deg``.
_UNITS = tuple(
    re.compile(form)
    for form in (r"(.*?)\s*\[([^\[\]]*)\]", r"(.*?)\s*\(([^()]*)\)", r"(.*?)\s+/\s+(\S+)", r"(.*?)\s+in\s+(\S+)")
)
_DECIMAL = re.compile(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?", re.ASCII)
_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}", re.ASCII)


@dataclass(frozen=True)
class Head:
    """The head of a column: its text, the column that it names, and its unit, empty without one."""

    text: str
    name: str
    unit: str = ""


@dataclass(frozen=True)
class CsvLines:
    """A file taken apart.

    Parameters
    ----------
    heads : tuple of Head
    rows : list of (int, list of str)
        Numbers of the lines in the file, and their entries.
    above : int
        Lines above the heads that were passed over.
    units_below : bool
        Whether a line below the heads has the units.
    """

    heads: tuple[Head, ...]
    rows: Sequence[tuple[int, list[str]]]
    above: int = 0
    units_below: bool = False


def read_lines(path: Path, key: str, known: Collection[str]) -> CsvLines:
    """Take a file apart.

    Parameters
    ----------
    path : Path
    key : str
        Where the case names the file, for messages.
    known : collection of str
        Names of columns: the heads are in the line that has most of them.

    Raises
    ------
    InputError
        If it has no heads with numbers below, or is no readable table.
    """
    every = read_table_text(path, key).splitlines()
    if len(every) > _MOST_LINES:
        raise InputError(key, f'"{path.name}"', f"has more than {_MOST_LINES:,} lines", "use every second point")
    lines = [(number, line) for number, line in enumerate(every, start=1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError(key, f'"{path.name}"', "must have column heads with numbers below")
    start, parting = _heads_at([line for _, line in lines[:_ABOVE]], known)
    lines = lines[start:]
    try:
        rows = [(number, next(csv.reader([line], delimiter=parting, strict=True))) for number, line in lines]
    except csv.Error as error:
        raise InputError(key, f'"{path.name}"', f"is not a readable table ({error})") from None
    if all(not row[-1].strip() for _, row in rows):
        rows = [(number, row[:-1]) for number, row in rows]
    heads = _named([text.strip() for text in rows[0][1]], known)
    below = _units_below(heads, rows[1:])
    if below:
        heads = tuple(Head(one.text, one.name, unit) for one, unit in zip(heads, below, strict=True))
    rows = rows[2 if below else 1 :]
    if not rows:
        raise InputError(key, f'"{path.name}"', "must have column heads with numbers below")
    for number, row in rows:
        if len(row) != len(heads):
            remedy = "use decimal points, or part the entries by semicolons" if parting == "," else "complete the line"
            raise InputError(
                key, f'"{path.name}"', f"has {len(row)} entries in line {number} but {len(heads)} column heads", remedy
            )
    return CsvLines(heads, rows, start, bool(below))


def _heads_at(lines: Sequence[str], known: Collection[str]) -> tuple[int, str]:
    """Which line has the heads, and what parts its entries: what parts most known names, and the line below alike.

    A list of channels above the heads may have one of their names: the line with most of them, the first of equals.
    """
    most, place, parting = 0, 0, ","
    for i, line in enumerate(lines):
        below = lines[i + 1] if i + 1 < len(lines) else ""
        found = {
            sign: (sum(one.name in known for one in _named(line.split(sign), known)), below.count(sign) > 0)
            for sign in _PARTINGS
        }
        best = max(_PARTINGS, key=lambda sign: found[sign])  # the first of equals
        if found[best][0] > most:
            most, place, parting = found[best][0], i, best
    if most:
        return place, parting
    # None is known: what stands above the first numbers is what a message names.
    numbers = next((i for i, line in enumerate(lines) if _numbers(line)), 0)
    likely = max(numbers - 1, 0)
    parting = next((sign for sign in _PARTINGS if sign in lines[likely]), ",")
    own, above = (lines[i].split(parting) for i in (likely, max(likely - 1, 0)))
    if likely and len(own) == len(above) > 1 and not any(one.unit for one in _named(own, known)):
        likely -= 1  # of two lines of as many texts the lower one has the units
    return likely, parting


def _numbers(line: str) -> bool:
    return any(
        sign in line and all(_is_number(text) for text in line.split(sign) if text.strip()) for sign in _PARTINGS
    )


def _named(texts: Sequence[str], known: Collection[str]) -> tuple[Head, ...]:
    """Heads with the known columns that they name; another spelling (``Angle``) where no head has the name itself."""
    exact = [_head(text, known, exact=True) for text in texts]
    taken = {one.name for one in exact if one.name in known}
    loose = [_head(text, known, exact=False) for text in texts]
    count = {name: sum(one.name == name for one in loose) for name in known}
    return tuple(
        other if one.name not in known and other.name not in taken and count.get(other.name) == 1 else one
        for one, other in zip(exact, loose, strict=True)
    )


def _head(text: str, known: Collection[str], *, exact: bool) -> Head:
    """A head taken apart in the way in which it names a known column."""
    text = text.strip().strip('"').strip()
    forms = [(text, ""), *(match.groups() for form in _UNITS if (match := form.fullmatch(text)))]
    for name, unit in forms:
        for one in known:
            if name == one or (not exact and name.casefold() == one.casefold()):
                return Head(text, one, unit)
    return Head(text, *forms[1] if len(forms) > 1 else forms[0])


def _units_below(heads: Sequence[Head], rows: Sequence[tuple[int, list[str]]]) -> list[str]:
    """Units of a line below heads that have none, no entry of which is a number."""
    if len(rows) < 2 or any(one.unit for one in heads):
        return []
    texts = [text.strip() for text in rows[0][1]]
    if len(texts) != len(heads) or not any(texts) or any(_is_number(text) for text in texts):
        return []
    if not all(_is_number(text) for text in rows[1][1] if text.strip()):
        return []
    return [text[1:-1].strip() if text[:1] + text[-1:] in ("[]", "()") else text for text in texts]


def _is_number(text: str) -> bool:
    return plain_number(text) is not None or _DECIMAL.fullmatch(text.strip()) is not None


def decimal_commas(entries: Sequence[tuple[int, str]], path: Path, key: str) -> bool:
    """Whether the numbers of a file have decimal commas.

    Parameters
    ----------
    entries : sequence of (int, str)
        Entries of all columns that are read, with their lines.
    path, key
        For messages.

    Raises
    ------
    InputError
        If some have commas and others points, or every comma may be one of thousands.
    """
    commas = [(number, text) for number, text in entries if "," in text and _DECIMAL.fullmatch(text.strip())]
    if not commas:
        return False
    number, first = commas[0]
    point = next(((n, text) for n, text in entries if "." in text and plain_number(text) is not None), None)
    if point is not None:
        raise InputError(
            key, f'"{path.name}"', f"has a comma in {shown(first)} (line {number}) and a point in {shown(point[1])} "
            f"(line {point[0]})", "use decimal points only",
        )  # fmt: skip
    if all(_THOUSANDS.fullmatch(text.strip()) for _, text in commas):
        raise InputError(
            key, f'"{path.name}"', f"contains {shown(first)} in line {number}: decimal comma or comma of thousands",
            "use decimal points",
        )  # fmt: skip
    return True
