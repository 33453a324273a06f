"""Columns and values of stress that alternates in a fillet over a revolution, of idlers and of planets."""

from __future__ import annotations

from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell

#: Columns of a table with one `AlternatingStress` a row, each with its error.
ALTERNATING = tuple(Cell(key, error=f"{key}_error") for key in ("highest", "lowest", "range", "mean", "ratio"))
#: Values of each fillet: objects that have the stress as `found` and say `what` and by which `key` it is.
ALTERNATING_VALUES = tuple(
    Number(quantity, f"found.{quantity}_error", "found", owner="{name}.{key}", meaning=f"{{one.what}}: {said}")
    for quantity, said in (("range", "stress range"), ("mean", "mean stress"), ("ratio", "R"))
)
