"""Keys that case files have had: read as those of now, with a remark, and written anew by `fegear migrate`.

The rule stands in docs/stability.md: an old name is read for as long as it stands here, at least one minor release. Old
names of results stand in the catalogue of results.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any, NamedTuple

from fegear.base.errors import InputError

#: The form of case files that this version writes; it counts up when a key is renamed or taken out.
SCHEMA_VERSION = 2
_ANY = "NAME"


class Renamed(NamedTuple):
    """A key that has another name now, or none.

    Attributes
    ----------
    old, new : str
        Dotted keys, NAME for a name of the user's choice; `new` is empty for a key that was taken out.
    since : str
        The release that changed it.
    reason : str
        Why, as the end of a sentence.
    """

    old: str
    new: str
    since: str
    reason: str = ""


#: Keys, the oldest change first.
KEYS: tuple[Renamed, ...] = (Renamed("effects.off_line_of_action", "", "0.2", "not used by any result"),)


class Change(NamedTuple):
    """A change of one case: the path of a key, that of now (empty if there is none), and the sentence about it."""

    old: tuple[str, ...]
    new: tuple[str, ...]
    remark: str


def changes(document: Mapping[str, object]) -> list[Change]:
    """Old keys of a case given as plain tables."""
    return [
        Change(path, _path(renamed.new, names), _remark(".".join(path), ".".join(_path(renamed.new, names)), renamed))
        for renamed in KEYS
        for path, names in _found(document, renamed.old.split("."))
    ]


def current(document: Mapping[str, object]) -> tuple[Mapping[str, object], tuple[str, ...]]:
    """A case by the names of now, and a sentence about each old one.

    Raises
    ------
    InputError
        If it was written for a later version, or gives a key by both names.
    """
    version = document.get("schema_version", SCHEMA_VERSION)
    if isinstance(version, int) and version > SCHEMA_VERSION:
        raise InputError(
            "schema_version", version, "was written for a newer version of fegear (this version supports "
                                       f"schema_version up to {SCHEMA_VERSION})",
            "update fegear",
        )  # fmt: skip
    found = changes(document)
    if not found:
        return document, ()
    made: dict[str, Any] = copy.deepcopy(dict(document))
    for old, new, _ in found:
        value = _table(made, old[:-1]).pop(old[-1])
        if new:
            table = _table(made, new[:-1])
            if new[-1] in table:
                rule = f"is the old name of {'.'.join(new)}, which is also set"
                raise InputError(".".join(old), value, rule, "remove the old key")
            table[new[-1]] = value
    return made, tuple(change.remark for change in found)


def without_old(document: dict[str, Any], key: str) -> None:
    """Take an old name of a key out of a case, in which the key is about to be set anew."""
    for old, new, _ in changes(document):
        if ".".join(new) == key:
            del _table(document, old[:-1])[old[-1]]


def current_key(key: str) -> str:
    """A dotted key by its name of now; one that was taken out stays as it is, and is refused like any unknown one."""
    steps = key.split(".")
    for renamed in KEYS:
        pattern = renamed.old.split(".")
        names = _names(pattern, steps[: len(pattern)])
        if renamed.new and names is not None:
            return ".".join((*_path(renamed.new, names), *steps[len(pattern) :]))
    return key


def _names(pattern: list[str], steps: list[str]) -> list[str] | None:
    """The user's names in a key that fits a pattern; None if it does not."""
    if len(pattern) != len(steps) or any(a not in (_ANY, b) for a, b in zip(pattern, steps, strict=True)):
        return None
    return [b for a, b in zip(pattern, steps, strict=True) if a == _ANY]


def _found(table: object, steps: list[str]) -> list[tuple[tuple[str, ...], list[str]]]:
    """Paths in nested tables that fit a pattern, each with the user's names on it."""
    if not isinstance(table, Mapping):
        return []
    here = list(table) if steps[0] == _ANY else [steps[0]] if steps[0] in table else []
    if len(steps) == 1:
        return [((name,), []) for name in here]
    return [
        ((name, *path), [name, *names] if steps[0] == _ANY else names)
        for name in here
        for path, names in _found(table[name], steps[1:])
    ]


def _path(pattern: str, names: list[str]) -> tuple[str, ...]:
    left = iter(names)
    return tuple(next(left) if step == _ANY else step for step in pattern.split(".")) if pattern else ()


def _table(document: dict[str, Any], path: tuple[str, ...]) -> dict[str, Any]:
    for step in path:
        document = document.setdefault(step, {})
    return document


def _remark(old: str, new: str, renamed: Renamed) -> str:
    reason = f" ({renamed.reason})" if renamed.reason else ""
    now = f"was renamed {new} in {renamed.since}{reason}" if new else f"was removed in {renamed.since}{reason}; ignored"
    return f"{old} {now}; update the file with fegear migrate."
