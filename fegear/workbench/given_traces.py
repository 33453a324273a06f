"""Traces that a script has as arrays or as a table of pandas, as the CSV files that a case names.

They are written once, into a folder of this process, with the heads of their columns; so they are read and refused by
the same rules as files.
"""

from __future__ import annotations

import hashlib
import re
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError, shown
from fegear.workbench.given import table

#: Key of a whole table beside the other keys of a trace.
DATA = "data"
#: Most characters of a head that a message has.
_HEAD = 40
#: How messages name the file of arrays.
_NAMED = re.compile(r'"[^"]*arrays_[0-9a-f]{12}\.csv"')


@cache
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="fegear-traces-")


def is_table(value: Any) -> bool:
    """Whether this is a table of pandas, or one like it."""
    return hasattr(value, "columns") and hasattr(value, "to_numpy")


def filed_trace(given: Any, key: str, units: Mapping[str, str]) -> dict[str, Any]:
    """The keys of a trace, its columns in a file where it has them as arrays.

    Parameters
    ----------
    given : mapping or table
        Keys of a case file; or columns under their heads (``"angle [deg]": array``) beside such keys, or a table of
        them alone or as ``data``. Heads are those of a CSV file.
    key : str
        For messages.
    units : mapping
        SI units of columns whose heads have none, by their names.

    Raises
    ------
    InputError
        If columns are no numbers or of several lengths, or there is a file beside them.
    """
    if is_table(given):
        given = {DATA: given}
    if not isinstance(given, Mapping):
        return table(given, key)
    columns = {head: value for head, value in given.items() if _is_column(head, value)}
    if DATA in given:
        whole = given[DATA]
        if not (is_table(whole) or isinstance(whole, Mapping)):
            raise InputError(f"{key}.{DATA}", shown(whole), "must be a mapping of heads to arrays, or a DataFrame")
        names = list(whole.columns) if is_table(whole) else list(whole)
        # a table may have texts beside the columns of a trace
        of_table = {head: whole[head] for head in names if not is_table(whole) or whole[head].dtype.kind in "iuf"}
        columns = {**of_table, **columns}
    rest = {head: value for head, value in given.items() if head not in columns and head != DATA}
    keys = table(rest, key)
    if not columns:
        if DATA in given:
            raise InputError(f"{key}.{DATA}", "(empty)", "must have at least one column", "check the table")
        return keys
    if "file" in keys:
        raise InputError(f"{key}.file", shown(keys["file"]), "contradicts arrays", "remove one of them")
    found = {}
    for head, value in columns.items():
        if not isinstance(head, str):
            raise InputError(key, shown(head), "is not the head of a column", "name the columns by texts")
        named, numbers = _numbers(head, value, f"{key}.{head[:_HEAD]}")
        bare = "[" not in named and "(" not in named
        found[f"{named} [{units[named]}]" if bare and units.get(named) else named] = numbers
    sizes = {head: numbers.size for head, numbers in found.items()}
    if len(set(sizes.values())) > 1:
        said = ", ".join(f"{head[:_HEAD]} {size}" for head, size in sizes.items())
        raise InputError(key, said, "must be columns of one length", "check the arrays")
    return {**keys, "file": str(_written(found))}


def _is_column(head: object, value: object) -> bool:
    """Whether a value is numbers, and no list that a key takes."""
    if head in (DATA, "fit"):
        return False
    if isinstance(value, (list, tuple)):
        return bool(value) and not any(isinstance(one, (str, Mapping)) for one in value)
    return np.ndim(getattr(value, "magnitude", value)) > 0 if hasattr(value, "__array__") else False


def _numbers(head: str, value: Any, key: str) -> tuple[str, Array]:
    """Head and numbers of a column; quantities of pint have their unit in the head."""
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        head, value = f"{head} [{value.units:~C}]" if f"{value.units:~C}" else head, value.magnitude
    try:
        numbers = np.asarray(value)
    except ValueError:
        raise InputError(key, "(rows of several lengths)", "must be one column of numbers") from None
    if numbers.ndim != 1 or numbers.dtype.kind not in "iuf" or not numbers.size:
        kind = f"(array of {numbers.dtype}, shape {numbers.shape})"
        raise InputError(key, kind, "must be one column of numbers", "pass a one-dimensional array")
    return head, numbers.astype(float)


def _written(columns: Mapping[str, Array]) -> Path:
    """The file of columns; the same columns are the same file."""
    rows = "\n".join("\t".join(map(repr, row)) for row in np.stack(list(columns.values()), axis=1).tolist())
    text = "\t".join(columns) + "\n" + rows + "\n"
    path = Path(_folder().name) / f"arrays_{hashlib.sha256(text.encode()).hexdigest()[:12]}.csv"
    if not path.is_file():
        path.write_text(text, encoding="utf-8")
    return path


def of_arrays(error: InputError) -> InputError:
    """A refusal of such a file as one of the arrays."""
    value, rule = str(error.value), _NAMED.sub("the trace", error.rule)
    if not _NAMED.search(value) and rule == error.rule:
        return error
    return InputError(error.key.removesuffix(".file"), _NAMED.sub("(arrays)", value), rule, error.remedy)
