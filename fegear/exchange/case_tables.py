"""A commented case file, table by table, from what another program's model says."""

from __future__ import annotations

import math
import re
import textwrap
import unicodedata
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from fegear.case.text_file import toml_string

#: Widest line of a remark, and the column where remarks stand behind keys.
_WIDE, _REMARKS = 118, 44

#: Names that are taken as they are.
_PLAIN = re.compile(r"[a-z][a-z0-9_]{0,79}")
#: Units in which a case is written, with their sizes in SI.
_UNITS = {
    "mm": 1e-3,
    "um": 1e-6,
    "deg": math.pi / 180.0,
    "N": 1.0,
    "kN": 1e3,
    "N*m": 1.0,
    "N*m/rad": 1.0,
    "rpm": 2.0 * math.pi / 60.0,
    "N/um": 1e6,
    "GPa": 1e9,
    "MPa": 1e6,
    "kg/m^3": 1.0,
    "mm^2/s": 1e-6,
    "h": 3600.0,
    "degC": 1.0,
    "kg": 1.0,
    "kg*m^2": 1.0,
}


@dataclass(frozen=True, slots=True)
class Key:
    """A line of a case: a key, its value as TOML writes it, and where it comes from."""

    name: str
    value: str
    remark: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of a case.

    Parameters
    ----------
    name : str
        ``gear.pinion``; empty for keys before all tables.
    keys : tuple of Key
    remark : str
        What stands above it.
    """

    name: str
    keys: tuple[Key, ...]
    remark: str = ""


def quantity(value: float, unit: str, digits: int = 15) -> str:
    """A value in SI as a case writes it: ``"3.5 mm"``."""
    return f'"{value / _UNITS[unit] + 0.0:.{digits}g} {unit}"'


def number(value: float) -> str:
    """A plain number."""
    return f"{value + 0.0:.15g}"


def text(value: str) -> str:
    """A text in quotes."""
    return toml_string(value)


def inline(**keys: str | None) -> str:
    """A table in one line, of the keys that have a value."""
    return "{ " + ", ".join(f"{key} = {value}" for key, value in keys.items() if value is not None) + " }"


def listed(values: Iterable[str]) -> str:
    """A list."""
    return f"[{', '.join(values)}]"


def plain_name(said: str, other: str, taken: Collection[str]) -> str:
    """A name that TOML takes without quotes: of a component's, or another one, and one of its own.

    Parameters
    ----------
    said : str
        ``Gear pos=1 [23]``, whose number in brackets is dropped.
    other : str
        What is used where nothing of it is left, and added where the name is taken.
    taken : collection of str
    """
    latin = unicodedata.normalize("NFKD", re.sub(r"\s*\[\d+\]\s*$", "", said)).encode("ascii", "ignore").decode()
    name = latin if _PLAIN.fullmatch(latin) else re.sub(r"[^A-Za-z0-9]+", "_", latin).strip("_").lower()[:40]
    if name and name not in taken:
        return name
    return f"{name}_{other}" if name else other


def case_text(head: Sequence[str], tables: Iterable[Table], foot: Sequence[str]) -> str:
    """The text of a case file.

    Parameters
    ----------
    head, foot : sequence of str
        Remarks before and behind everything, a paragraph each.
    tables : iterable of Table
    """
    lines = [line for part in head for line in _comment(part)]
    for table in tables:
        lines.append("")
        lines += _comment(table.remark) if table.remark else []
        lines += [f"[{table.name}]"] if table.name else []
        for key in table.keys:
            line = f"{key.name} = {key.value}"
            lines.append(f"{line:<{_REMARKS}} # {_one_line(key.remark)}" if key.remark else line)
    lines.append("")
    lines += [line for part in foot for line in _comment(part)]
    return "\n".join(lines) + "\n"


def _one_line(remark: str) -> str:
    return "".join(sign if sign.isprintable() else " " for sign in remark)


def _comment(remark: str) -> list[str]:
    wrapped = textwrap.wrap(_one_line(remark), _WIDE - 2, subsequent_indent="  ", break_long_words=False)
    return [f"# {line}" for line in wrapped or [""]]
