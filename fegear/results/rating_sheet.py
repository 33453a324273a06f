"""Safeties of a pair for its gear data, where a rating was asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.engine.outcome import Value

#: Values of the result ``rating`` that the data sheet shows, in its order.
_SHOWN = {
    "S_H": "safety against pitting S_H, ISO 6336",
    "S_H_computed": "S_H, computed load distribution",
    "S_H_spectrum": "S_H under the spectrum",
    "S_H_agma": "S_H, AGMA 2101",
    "S_F": "safety against tooth breakage S_F, ISO 6336",
    "S_F_computed": "S_F, computed root stress",
    "S_F_spectrum": "S_F under the spectrum",
    "S_F_agma": "S_F, AGMA 2101",
}


def rated_columns(values: Iterable[Value], pair: str) -> tuple[Column, ...]:
    """A column for every safety of driver and driven among the values of a run; none without a rating."""
    known = {value.name: value.value for value in values}
    rows = {key: [known.get(f"{pair}.{member}.{key}", np.nan) for member in MEMBERS] for key in _SHOWN}
    return tuple(
        Column(key, np.array([round(one, 3) for one in row]), "", _SHOWN[key])
        for key, row in rows.items()
        if not np.isnan(row).any()
    )
