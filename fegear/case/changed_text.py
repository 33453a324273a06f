"""Changes of single keys in the text of a case file, which leave its comments and its order as they are."""

from __future__ import annotations

import copy
import functools
import itertools
import re
import tomllib
from typing import TYPE_CHECKING, Any

import tomlkit
from tomlkit.container import Container
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AbstractTable, InlineTable, Table

from fegear.base.errors import InputError
from fegear.case.reading import typed_value
from fegear.case.text_file import toml_string

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Keys from table to table; the number of one of several tables in a list is a text as well.
Path = tuple[str, ...]
#: How remarks of fegear begin: a later one takes the place of an earlier one.
REMARK = "fegear apply"
_BARE = re.compile(r"[A-Za-z0-9_-]+")
#: The text that was made last by other values alone, and its document: a value that is moved changes it again and
#: again, and to parse it takes most of the time. After new keys it is parsed anew: spaces come out otherwise.
_last: dict[str, tomlkit.TOMLDocument] = {}


def literal(value: object) -> str:
    """A plain value as TOML writes it on one line."""
    if isinstance(value, dict):
        inside = ", ".join(f"{_quoted(key)} = {literal(one)}" for key, one in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(literal, value))}]"
    if isinstance(value, str):
        return toml_string(value)
    return str(value).lower() if isinstance(value, bool) else str(value)


def as_typed(text: str) -> str:
    """What somebody typed as a TOML value: what is none is taken as a number or a text, as ``--set`` does."""
    typed = text.strip()
    try:
        is_toml = set(tomllib.loads(f"value = {typed}")) == {"value"}
    except (ValueError, RecursionError):
        is_toml = False
    return typed if is_toml else literal(typed_value(typed))


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
    """The text of a case with one key changed, added or removed: see `with_values`."""
    return with_values(text, {path: value})


def with_values(
    text: str, changes: Mapping[Path, str | None], comments: Mapping[Path, str] | None = None
) -> str:  # fmt: skip
    """The text of a case with some keys changed, added or removed, one after the other.

    Comments, order and spelling of all else stay, with one exception: tables ``[[a.b]]`` of one list that stand apart
    come to stand together.

    Parameters
    ----------
    text : str
        Valid TOML.
    changes : mapping of tuple of str to str or None
        Values as TOML writes them; None removes the key, and the tables that hold nothing after that.
    comments : mapping of tuple of str to str, optional
        Remarks that stand behind changed keys, after what the user has written there.

    Returns
    -------
    str
        It is read again, and holds what was asked for and nothing else that is new.

    Raises
    ------
    InputError
        If a key stands where it cannot be changed by itself, or a value is no TOML.
    """
    before = wanted = _read(text)
    document, values_alone = None, True
    for path, value in changes.items():
        now, wanted = wanted, _changed(wanted, path, value)
        if wanted == now:
            continue
        if document is None:  # parsed at the first change: ten times dearer than to read what the text says
            document = _last.pop(text, None) or tomlkit.parse(text)
        values_alone = values_alone and value is not None and value_at(now, path) is not None
        try:
            if value is None:
                _remove(document, path, wanted)
            else:
                _set(document, path, value, (comments or {}).get(path, ""))
        except (TOMLKitError, LookupError, TypeError, ValueError, AttributeError):
            raise _refused(path, value) from None
    if document is None or wanted == before:
        return text
    made = tomlkit.dumps(document)
    try:
        whole = _solid(_read(made)) == _solid(wanted)
    except ValueError:
        whole = False
    if not whole:
        raise _refused(*list(changes.items())[-1])
    _last.clear()
    if values_alone:
        _last[made] = document
    return made


def _refused(path: Path, value: str | None) -> InputError:
    return InputError(".".join(path), value or "(removed)", "cannot be changed individually", "change it in the text")


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
            raise InputError(".".join(path), value, f'cannot be set: "{step}" is not a table', "change it in the text")
    try:
        table[path[-1]] = tomllib.loads(f"value = {value}")["value"]
    except (ValueError, KeyError):
        raise InputError(".".join(path), value, "is not a valid value", 'for example "3 mm", 0.25 or true') from None
    return made


def _innermost(document: Any, path: Path) -> tuple[Any, Path]:
    """The innermost table on the way that is there, and what is left of the path."""
    found = document
    for depth, step in enumerate(path[:-1]):
        inside = found[int(step)] if isinstance(found, list) else found.get(step)
        if inside is None:
            return found, path[depth:]
        found = inside
    return found, path[-1:]


def _set(document: Any, path: Path, value: str, comment: str = "") -> None:
    """Set a key where it stands, else in the innermost table that has a place, else below a head of its own."""
    holder, rest = _innermost(document, path)
    item = tomlkit.value(value)
    if rest[0] in holder:  # what stands behind it on its line stays there
        inside = holder.value if isinstance(holder, AbstractTable) else holder
        held: Any = inside.item(rest[0]) if isinstance(inside, Container) else inside[rest[0]]
        item.trivia.indent, item.trivia.comment_ws = held.trivia.indent, held.trivia.comment_ws
        item.trivia.comment = held.trivia.comment
    if comment and len(rest) == 1 and not isinstance(holder, InlineTable):  # inside braces a comment would end them
        item.trivia.comment_ws = item.trivia.comment_ws or "  "
        kept = item.trivia.comment.partition(REMARK)[0].rstrip("; ")
        item.trivia.comment = f"{kept}; {comment}" if kept.strip("# ") else f"# {comment}"
    # A table that is only named in the heads of those below it gets the new one under a head as well.
    headed = holder is document or (isinstance(holder, Table) and holder.is_super_table())
    for step in reversed(rest[1:]):
        outer: Any = tomlkit.table() if headed and step is rest[1] else tomlkit.inline_table()
        outer[step] = item
        item = outer
    holder[rest[0]] = item


def _remove(document: Any, path: Path, wanted: Mapping[str, Any]) -> None:
    """Remove a key, or the outermost table on its way that holds nothing else."""
    gone = next(depth for depth in range(1, len(path) + 1) if value_at(wanted, path[:depth]) is None)
    holder, rest = _innermost(document, path[:gone])
    del holder[rest[0]]


def _quoted(key: str) -> str:
    return key if _BARE.fullmatch(key) else toml_string(key)
