"""Changes of single keys in the text of a case file, which leave its comments and its order as they are."""

from __future__ import annotations

import copy
import functools
import itertools
import json
import re
import tomllib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

#: Keys from table to table; the number of one of several tables in a list is a text as well.
Path = tuple[str, ...]
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_BLANK = re.compile(r"[ \t]*")
#: Blanks, line ends and comments between two statements.
_BETWEEN = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_LINE = re.compile(r"[^\n]*\n?")
#: A value that is neither a text nor in brackets.
_PLAIN = re.compile(r"[^,\]}#\n]*")


@dataclass(frozen=True, slots=True)
class Entry:
    """Where a key stands: `begin` is that of the key, `start` and `end` those of its value; `depth` counts brackets.

    A table in a list stands there without a key.
    """

    path: Path
    begin: int
    start: int
    end: int
    depth: int


@dataclass(frozen=True, slots=True)
class Head:
    """A line ``[a.b]`` or ``[[a.b]]``: its table's path, where it begins, and where the last of its statements ends."""

    path: Path
    begin: int
    end: int


def literal(value: object) -> str:
    """A plain value as TOML writes it on one line."""
    if isinstance(value, dict):
        inside = ", ".join(f"{_quoted(key)} = {literal(one)}" for key, one in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(literal, value))}]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (str, bool)) else str(value)


def as_typed(text: str) -> str:
    """What somebody typed as a TOML value: what is none is taken as a text, as ``--set`` does."""
    try:
        read = tomllib.loads(f"value = {text.strip()}")
    except (ValueError, RecursionError):
        read = {}
    return text.strip() if set(read) == {"value"} else literal(text.strip())


def value_at(document: Mapping[str, Any], path: Path) -> Any:
    """The value below a path; None where there is none."""
    found: Any = document
    for step in path:
        if isinstance(found, list) and step.isdecimal() and int(step) < len(found):
            found = found[int(step)]
        elif isinstance(found, dict) and step in found:
            found = found[step]
        else:
            return None
    return found


def with_value(text: str, path: Path, value: str | None) -> str:
    """The text of a case with one key changed, added or removed.

    Parameters
    ----------
    text : str
        Valid TOML.
    path : tuple of str
    value : str or None
        As TOML writes it; None removes the key, and the tables that hold nothing after that.

    Returns
    -------
    str
        It is read again, and holds what was asked for and nothing else that is new.

    Raises
    ------
    InputError
        If the key stands where it cannot be changed by itself, or the value is no TOML.
    """
    before = _read(text)
    wanted = _changed(before, path, value)
    if wanted == before:
        return text
    for made in _removed(text, path, wanted) if value is None else _added(text, path, value):
        try:
            if _solid(_read(made)) == _solid(wanted):
                return made
        except ValueError:
            continue
    raise InputError(".".join(path), value or "(removed)", "cannot be changed by itself", "change it in the text")


@functools.lru_cache(maxsize=8)
def _read(text: str) -> Mapping[str, Any]:
    """A text as plain tables, which nobody changes: a moved relief sets one key after the other."""
    return tomllib.loads(text)


def _solid(document: Mapping[str, Any]) -> dict[str, Any]:
    """A document without its empty tables, which say nothing."""
    inside = {key: _solid(value) if isinstance(value, dict) else value for key, value in document.items()}
    return {key: value for key, value in inside.items() if value != {}}


def _changed(document: Mapping[str, Any], path: Path, value: str | None) -> dict[str, Any]:
    made: dict[str, Any] = copy.deepcopy(dict(document))
    if value is None:
        for depth in range(len(path), 0, -1):
            held = value_at(made, path[: depth - 1])
            if isinstance(held, dict) and (depth == len(path) or (depth > 1 and held.get(path[depth - 1]) == {})):
                held.pop(path[depth - 1], None)
        return made
    table: Any = made
    for step, after in itertools.pairwise(path):
        table = table.setdefault(step, {}) if isinstance(table, dict) else value_at(table, (step,))
        if not isinstance(table, dict) and value_at(table, (after,)) is None:
            raise InputError(".".join(path), value, f'cannot be set: "{step}" is no table', "change it in the text")
    try:
        table[path[-1]] = tomllib.loads(f"value = {value}")["value"]
    except (ValueError, KeyError):
        raise InputError(".".join(path), value, "is no value", 'write for example "3 mm", 0.25 or true') from None
    return made


def _added(text: str, path: Path, value: str) -> Iterator[str]:
    """Texts that may be what is wanted, the one that changes least first."""
    entries, heads = statements(text)
    for entry in entries:
        if entry.path == path:
            yield text[: entry.start] + value + text[entry.end :]
    for entry in sorted(entries, key=lambda one: -len(one.path)):
        rest = path[len(entry.path) :]
        if rest and entry.path == path[: len(entry.path)] and text[entry.start] == "{":
            inside = text[entry.start + 1 : entry.end - 1]
            more = f"{', ' if inside.strip() else ' '}{_dotted(rest)} = {value} "
            yield text[: entry.start + 1] + inside.rstrip() + more + text[entry.end - 1 :]
    for head in sorted(heads, key=lambda one: -len(one.path)):
        rest = path[len(head.path) :]
        if rest and head.path == path[: len(head.path)] and (head.path or len(rest) == 1):
            nested = value
            for step in reversed(rest[1:]):
                nested = f"{{ {_quoted(step)} = {nested} }}"
            for line in (f"{_quoted(rest[0])} = {nested}", f"{_dotted(rest)} = {value}"):
                yield _with_line(text, head.end, line)
    end = text if text.endswith("\n") or not text else f"{text}\n"
    yield (
        f"{end}\n[{_dotted(path[:-1])}]\n{_quoted(path[-1])} = {value}\n"
        if path[:-1]
        else f"{path[-1]} = {value}\n{text}"
    )


def _with_line(text: str, place: int, line: str) -> str:
    """Put a line below the one that ends at `place`; at the very beginning above everything but comments."""
    before, behind = text[:place], text[place:]
    gap = "" if not before or before.endswith("\n") else "\n"
    return f"{before}{gap}{line}\n{behind}"


def _removed(text: str, path: Path, wanted: Mapping[str, Any]) -> Iterator[str]:
    entries, heads = statements(text)
    gone = next((depth for depth in range(1, len(path) + 1) if value_at(wanted, path[:depth]) is None), len(path))
    for entry in entries:
        if entry.path != path[: len(entry.path)] or len(entry.path) < gone:
            continue
        if entry.depth == 0:
            line = _LINE.match(text, entry.end)
            start = text.rfind("\n", 0, entry.begin) + 1
            behind = text[line.end() if line else entry.end :]
            for head in heads:  # the table that held nothing else
                if gone <= len(head.path) < len(path) and head.path == path[: len(head.path)]:
                    yield _without(text, head.begin, len(text) - len(behind))
            yield text[:start] + behind
        else:
            before, behind = text[: entry.begin].rstrip(), text[entry.end :].lstrip()
            if before.endswith(","):
                yield f"{before[:-1]} {behind}"
            yield f"{before} {behind.removeprefix(',').lstrip()}"
    made = text
    for head in reversed(heads):  # a table that stands under heads of its own, with the tables in it
        if head.path[: len(path)] == path:
            made = _without(made, head.begin, head.end)
    yield made
    for head in heads:
        if head.path == path[: len(head.path)] and len(head.path) >= gone:
            yield _without(text, head.begin, head.end)


def _without(text: str, begin: int, end: int) -> str:
    """The text without some whole lines, and without one of two blank lines that then follow each other."""
    before, behind = text[:begin], text[end:]
    if before.endswith("\n\n") and (behind.startswith("\n") or not behind):
        before = before[:-1]
    return before + behind


def statements(text: str) -> tuple[list[Entry], list[Head]]:
    """Every key of a valid TOML text, and every table's head; the first is the file's."""
    entries: list[Entry] = []
    heads = [Head((), 0, 0)]
    table: Path = ()
    counts: dict[Path, int] = {}  # how many tables of a list there are so far
    at = 0
    while True:
        at = _end(_BETWEEN, text, at)
        if at >= len(text):
            return entries, heads
        if text[at] == "[":
            begin, several = text.rfind("\n", 0, at) + 1, text.startswith("[[", at)
            keys, at = _keys(text, at + 1 + several)
            at = _end(_LINE, text, at)
            table = ()
            for step in keys:  # below a list its last table is meant
                table = (*table, str(counts[table] - 1), step) if table in counts else (*table, step)
            if several:
                counts[table] = counts.get(table, 0) + 1
                table = (*table, str(counts[table] - 1))
            heads.append(Head(table, begin, at))
            continue
        begin = at
        keys, at = _keys(text, at)
        start = _end(_BLANK, text, at + 1)
        at = _value(text, start)
        entries += [Entry(table + keys, begin, start, at, 0), *_within(text, start, at, table + keys, 1)]
        heads[-1] = Head(heads[-1].path, heads[-1].begin, _end(_LINE, text, at))


def _within(text: str, start: int, end: int, path: Path, depth: int) -> Iterator[Entry]:
    """Keys of an inline table, and tables in a list with theirs."""
    if text[start] not in "{[":
        return
    at, listed = start + 1, text[start] == "["
    for number in itertools.count():
        at = _end(_BETWEEN, text, at)
        if at >= end - 1:
            return
        begin = first = at
        keys: Path = (str(number),)
        if not listed:
            keys, at = _keys(text, at)
            first = _end(_BLANK, text, at + 1)
        at = _value(text, first)
        if not listed or text[first] == "{":
            yield Entry(path + keys, begin, first, at, depth)
        yield from _within(text, first, at, path + keys, depth + 1)
        at = _end(_BETWEEN, text, at)
        at += text[at] == ","


def _keys(text: str, at: int) -> tuple[Path, int]:
    """Dotted keys from a place on, and where the sign behind them stands."""
    found: list[str] = []
    while True:
        at = _end(_BLANK, text, at)
        if text[at] in "\"'":
            end = _string(text, at)
            found.append(str(tomllib.loads(f"value = {text[at:end]}")["value"]))
        else:
            end = _end(_BARE, text, at)
            found.append(text[at:end])
        at = _end(_BLANK, text, end)
        if text[at] != ".":
            return tuple(found), at
        at += 1


def _string(text: str, at: int) -> int:
    """Where a text in quotes ends."""
    quote = text[at]
    triple = text.startswith(quote * 3, at)
    mark = quote * 3 if triple else quote
    at += len(mark)
    while not text.startswith(mark, at):
        at += 2 if text[at] == "\\" and quote == '"' else 1
    at += len(mark)
    while triple and text.startswith(quote, at):  # quotes that belong to the text stand before the last three
        at += 1
    return at


def _value(text: str, at: int) -> int:
    """Where a value ends."""
    if text[at] in "\"'":
        return _string(text, at)
    if text[at] not in "[{":
        end = _end(_PLAIN, text, at)
        return at + len(text[at:end].rstrip())
    depth = 0
    while True:
        sign = text[at]
        if sign in "\"'":
            at = _string(text, at)
            continue
        if sign == "#":
            at = _end(_LINE, text, at)
            continue
        depth += (sign in "[{") - (sign in "]}")
        at += 1
        if depth == 0:
            return at


def _end(pattern: re.Pattern[str], text: str, at: int) -> int:
    found = pattern.match(text, at)
    return found.end() if found else at


def _quoted(key: str) -> str:
    return key if _BARE.fullmatch(key) else json.dumps(key, ensure_ascii=False)


def _dotted(path: Path) -> str:
    return ".".join(map(_quoted, path))
