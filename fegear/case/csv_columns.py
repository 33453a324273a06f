"""CSV files that a case names: columns with units in their heads, as fegear itself writes them."""

from __future__ import annotations

import csv
import math
import re
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import InputError
from fegear.units import unit_size

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

_HEAD = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*")


def read_columns(path: Path, key: str, dimensions: Mapping[str, str]) -> dict[str, NDArray[np.float64]]:
    """Read the columns that are known by name into SI; others are passed over.

    Parameters
    ----------
    path : Path
        The first line that does not start with ``#`` holds the heads, ``name [unit]``.
    key : str
        Where the case names the file, for messages.
    dimensions : mapping
        Dimension of each column that may be there.

    Raises
    ------
    InputError
        If a head's unit has another dimension, or an entry is no finite number.
    """
    lines = [line for line in path.read_text(encoding="utf-8-sig").splitlines() if line.strip()]
    rows = list(csv.reader(line for line in lines if not line.lstrip().startswith("#")))
    if len(rows) < 2:
        raise InputError(key, f'"{path.name}"', "has no heads with numbers below them")
    columns = {}
    for i, head in enumerate(rows[0]):
        match = _HEAD.fullmatch(head)
        if match is None or match["name"] not in dimensions:
            continue
        name, unit = match["name"], match["unit"] or ""
        scale = unit_size(unit, dimensions[name], f"{key}, column {name}")
        try:
            values = np.array([float(row[i]) for row in rows[1:]])
        except (ValueError, IndexError):
            raise InputError(key, f'"{path.name}"', f"has an entry in column {name} that is no number") from None
        if not all(math.isfinite(v) for v in values):
            raise InputError(key, f'"{path.name}"', f"has an entry in column {name} that is not finite")
        columns[name] = values * scale
    return columns
