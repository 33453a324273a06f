"""Which of the designs of a pair is to be ground: none where tolerances or tiny amounts make relief useless."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from fegear.results.relief.answer_numbers import microns, torque_words

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.results.relief.grinding import Grinding
    from fegear.results.relief.relief_over_range import LeftOverRange


def recommended_design(rows: Sequence[Grinding], over: Mapping[str, LeftOverRange]) -> str:
    """Name of the design to be ground; empty where the answer advises against all of them.

    Parameters
    ----------
    rows : sequence of Grinding
        The best design first.
    over : mapping of str to LeftOverRange
        What each design leaves.
    """
    design = next((row.design for row in rows if row.words), "")
    if not design or all(row.is_faint for row in rows if row.design == design and row.words):
        return ""
    best, none = over[design], over["no relief"]
    lost = best.most is not None and best.finer != 0 and bool(np.all(best.most > none.compared))
    return "" if lost else design


def marked(name: str, *, recommended: bool) -> str:
    """Name of a design or gear in a chart, with a mark where the design is the one to be ground."""
    return f"{name} (recommended)" if recommended else name


def nothing_words(name: str, rows: Sequence[Grinding], torque: Array, none: Array) -> str:
    """That all modifications are too small to be ground, and what remains without any.

    Parameters
    ----------
    name : str
        Of the pair.
    rows : sequence of Grinding
        Of the optimum.
    torque, none : ndarray, shape (L,)
        [N m], and peak-to-peak transmission error without relief [m].
    """
    small = ", ".join(f"{row.words} (± {microns(row.amount_tolerance)} µm)" for row in rows)
    at = sorted({int(np.argmax(torque)), int(np.argmin(torque))}, reverse=True)
    left = ", ".join(f"{microns(none[i])} µm at {torque_words(torque[i])}" for i in at)
    return (
        f"Pair {name}: no modification needed: the optimum, {small}, is below a quarter of its tolerances and cannot "
        f"be ground; transmission error without relief {left}, peak to peak."
    )
