"""What a script gives, taken as a case file would have it: plain tables, lists, numbers and texts of its own.

Nothing of the caller is kept: what he changes afterwards changes no gear.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.errors import InputError, shown
from fegear.base.solution_cache import SolutionCache
from fegear.case.text_file import named_path

#: Tables in tables; a case has five.
_DEEPEST = 20


#: Bits of a whole number; a float has no room for more.
_BITS = 1000


def taken(value: Any, key: str, depth: int = 0) -> Any:
    """Copy what somebody gave for a key into plain tables, lists, numbers and texts.

    Parameters
    ----------
    value : object
        Arrays, tuples and other iterables become lists, numbers of numpy those of Python; quantities of pint stay, an
        array of them becomes a list of quantities. What is nothing of all this stays as it is, to be refused where the
        key is read.
    key : str
        For messages.

    Raises
    ------
    InputError
        If it is nested too deeply, holds bytes, sets, keys that are no texts, half a character, or an absurd number.
    """
    if depth > _DEEPEST:
        raise InputError(key, "(a table)", f"is nested more than {_DEEPEST} deep", "check for self-reference")
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, str):
        return _text(value, key)
    if isinstance(value, int) and value.bit_length() > _BITS:
        raise InputError(
            key, f"(a number of {value.bit_length()} bits)", "is outside the plausible range", "check the number"
        )
    if isinstance(value, (bytes, bytearray, memoryview, set, frozenset)):
        kind = "a set (unordered)" if isinstance(value, (set, frozenset)) else "bytes, not text"
        raise InputError(key, shown(value), f"is {kind}", "use a list, or text in quotes")
    if isinstance(value, Mapping):
        return {_key(name, key): taken(one, f"{key}.{name}", depth + 1) for name, one in value.items()}
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return _quantities(value)
    if isinstance(value, Iterable) and not isinstance(value, os.PathLike):
        return [taken(one, f"{key}[{number}]", depth + 1) for number, one in enumerate(value)]
    return value


def _text(value: str, key: str) -> str:
    try:
        value.encode()
    except UnicodeEncodeError:
        raise InputError(key, shown(value), "contains an invalid character (surrogate)", "correct the text") from None
    return str(value)


def _key(name: object, key: str) -> str:
    if not isinstance(name, str):
        raise InputError(key, shown(name), "is not a text key", "put it in quotes")
    return _text(name, key)


def _quantities(value: Any) -> Any:
    """A quantity of pint as it is; one of an array as a list of quantities."""
    if not isinstance(value.magnitude, np.ndarray):
        return value
    numbers = value.magnitude.tolist()
    if not isinstance(numbers, list):
        return type(value)(numbers, value.units)
    return [_quantities(type(value)(np.asarray(one), value.units)) for one in numbers]


def table(value: Any, key: str) -> dict[str, Any]:
    """A mapping that somebody gave, copied; None is an empty one.

    Raises
    ------
    InputError
        If it is no mapping, or `taken` refuses something in it.
    """
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise InputError(
            key, shown(value), "must be a mapping of keys to values", "use the form of a table of a case file"
        )
    found: dict[str, Any] = taken(value, key)
    return found


def name_of(value: Any) -> str:
    """The name of a gear or a pair.

    Raises
    ------
    InputError
        If it is no text.
    """
    if not isinstance(value, str):
        raise InputError("name", shown(value), "must be a text", 'for example name="pinion"')
    return _text(value, "name")


def texts(value: Any, key: str, example: str = "geometry") -> list[str]:
    """One text, or several, as a list.

    Raises
    ------
    InputError
        If it is neither.
    """
    found = taken(value, key)
    found = [found] if isinstance(found, str) else found
    if not isinstance(found, list) or not all(isinstance(one, str) for one in found):
        raise InputError(key, shown(value), "must be a text or a list of texts", f'for example "{example}"')
    return found


def cache_of(value: Any, usual: SolutionCache | None = None) -> SolutionCache | None:
    """A cache that somebody gave, or the usual one.

    Raises
    ------
    InputError
        If it is none.
    """
    if value is None:
        return usual
    if not isinstance(value, SolutionCache):
        raise InputError(
            "cache", shown(value), "must be a SolutionCache", "set cache=fegear.base.solution_cache.SolutionCache()"
        )
    return value


def folder_of(value: Any) -> Path:
    """A folder that somebody named to write into.

    Raises
    ------
    InputError
        If it can be none.
    """
    if not isinstance(value, (str, os.PathLike)) or not isinstance(os.fspath(value), str):
        raise InputError("folder", shown(value), "is not a path", 'for example "results/drive"')
    return named_path(os.fspath(value), "folder")


def working_folder() -> Path:
    """Where relative file names start: the working folder, or nowhere in particular if it has been deleted."""
    try:
        return Path.cwd()
    except OSError:
        return Path()
