"""JSON files that a user hands over: read with the guards of case files, and no deeper than anything fegear writes."""

from __future__ import annotations

import json
from pathlib import Path

from fegear.base.errors import PATH, InputError, shown
from fegear.case.text_file import read_text

#: Tables and lists within each other at most; what walks through them later must not run out of stack.
_DEPTH = 40


def read_json(path: Path, key: str) -> dict[str, object]:
    """Return the object that a JSON file holds.

    Parameters
    ----------
    path : Path
    key : str
        Where the file is named, for messages.

    Raises
    ------
    InputError
        If it is no file in UTF-8, is no JSON, is no object at the top, or is nested too deep.
    """
    name = shown(str(path), PATH)

    def refused(constant: str) -> float:
        raise InputError(key, name, f"must not have {constant} for a number", "write null")

    text = read_text(path, key)
    try:
        found = json.loads(text, parse_constant=refused)
    except json.JSONDecodeError as error:
        rule = f"is not valid JSON: line {error.lineno}: {error.msg}"
        raise InputError(key, name, rule, "write it again") from None
    except (RecursionError, ValueError):  # nests and whole numbers that Python does not read
        found = _TOO_DEEP
    if found is _TOO_DEEP or _deeper(found, _DEPTH):
        raise InputError(key, name, "nests its values too deep, or has numbers too long", "write it again")
    problem = _unwritable(found)
    if problem:
        raise InputError(key, name, problem, "write it again")
    if not isinstance(found, dict):
        raise InputError(key, name, "must be an object with names", "write it again")
    return found


_TOO_DEEP = object()


def _unwritable(found: object) -> str:
    """What keeps it from being written as JSON again, if anything."""
    try:
        json.dumps(found, ensure_ascii=False, allow_nan=False).encode()
    except UnicodeEncodeError:
        return "has half a character in a text"
    except ValueError:
        return "has a number that is too large"
    return ""


def _deeper(found: object, most: int) -> bool:
    """Whether something holds more than `most` levels of tables and lists."""
    level = [found]
    for _ in range(most + 1):
        parts = [one.values() if isinstance(one, dict) else one for one in level if isinstance(one, (dict, list))]
        level = [item for part in parts for item in part]
    return any(isinstance(one, (dict, list)) for one in level)
