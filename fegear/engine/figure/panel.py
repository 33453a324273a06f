"""A pair of axes with what is drawn over them, and the ranges, marks and bars that follow from it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Alike, Array
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.fixed import fixed
from fegear.engine.figure.items import (
    Bars,
    Curve,
    Item,
    Mark,
    Points,
    Stems,
    Which,
    Zone,
)

#: Curves that vary by less than this share of their size are drawn level, not their last digits over the whole height.
_LEVEL = 1e-3

#: Half the height of the axis of a level curve, as a share of its size.
_LEVEL_HEIGHT = 0.05

#: Marks of an axis of whole numbers.
_MOST_WHOLE = 20

#: Share of an axis that a word beside a mark takes.
_ROOM_OF_WORD = 0.045

#: Share of the axis that neighbouring bars of one place take.
_BAR_ROOM = 0.8


@dataclass(frozen=True, slots=True)
class Panel(Alike):
    """One pair of axes and what is drawn over them.

    Parameters
    ----------
    x, y : Axis
    items : tuple of items
    marks : tuple of Mark or Zone
    title : str
    height : float
        Weight among the panels of a figure.
    equal : bool
        Whether lengths along both axes are alike, as in a drawing.
    stacked : bool
        Whether bars stand on each other.
    camera : tuple of three points, optional
        Position, focal point and upward direction for surfaces.
    """

    x: Axis
    y: Axis
    items: tuple[Item, ...]
    marks: tuple[Mark | Zone, ...] = ()
    title: str = ""
    height: float = 1.0
    equal: bool = False
    stacked: bool = False
    camera: tuple[tuple[float, float, float], ...] = ()

    @property
    def limits(self) -> tuple[float, float] | None:
        """Range of the ordinate: as the axis says, or level where curves hardly vary; None where it finds itself."""
        if self.y.log and not self.y.limits and any(isinstance(i, Stems) and np.size(i.y) for i in self.items):
            return self.foot, 2.0 * self.extent("y")[1]
        if self.y.limits or self.y.log or self.y.zero or self.equal:
            return self.y.limits
        found = [np.asarray(i.y)[np.isfinite(i.y)] for i in self.items if isinstance(i, (Curve, Points))]
        shown = np.concatenate([np.empty(0), *found])
        if shown.size == 0 or len(found) < len(self.items):
            return None
        size, middle = float(np.abs(shown).max()), 0.5 * float(shown.min() + shown.max())
        if np.ptp(shown) >= _LEVEL * size or size == 0.0:
            return None
        return middle - _LEVEL_HEIGHT * size, middle + _LEVEL_HEIGHT * size

    def extent(self, which: Which) -> tuple[float, float]:
        """Ends of what is drawn along an axis, or of the axis where it says them."""
        axis = self.x if which == "x" else self.y
        if axis.limits:
            return axis.limits
        drawn = [getattr(item, which) for item in self.items if hasattr(item, which)]
        found = np.concatenate([np.zeros(int(axis.zero)), *(np.ravel(values) for values in drawn)])
        found = found[np.isfinite(found)]
        return (float(found.min()), float(found.max())) if found.size else (0.0, 1.0)

    def whole_step(self, which: Which) -> int:
        """Step between the marks of an axis of whole numbers."""
        low, high = self.extent(which)
        return max(1, math.ceil((high - low) / _MOST_WHOLE))

    def written(self, mark: Mark | Zone) -> str:
        """Word of a mark; none where it would lie on that of an earlier one."""
        if isinstance(mark, Zone):
            return ""
        low, high = self.extent(mark.axis)
        placed: list[float] = []
        for one in self.marks:
            if isinstance(one, Zone) or one.axis != mark.axis or not one.label:
                continue
            free = all(abs(one.at - other) >= _ROOM_OF_WORD * (high - low) for other in placed)
            if one is mark:
                return mark.label if free else ""
            placed += [one.at] if free else []
        return ""

    @property
    def foot(self) -> float:
        """Where stems stand: at zero, or below the shortest on a logarithmic scale."""
        if not self.y.log:
            return 0.0
        return 0.5 * min((float(np.min(i.y)) for i in self.items if isinstance(i, Stems) and np.size(i.y)), default=0.0)

    def bars(self) -> Iterator[tuple[Bars, Array, Array, float]]:
        """Every row of bars with the places of their middles, their feet and their width."""
        rows = [item for item in self.items if isinstance(item, Bars)]
        if not rows:
            return
        places = np.unique(np.concatenate([np.asarray(row.x) for row in rows]))
        step = float(np.diff(places).min()) if places.size > 1 else 1.0
        width = _BAR_ROOM * step / (1 if self.stacked else len(rows))
        below = dict.fromkeys(places.tolist(), 0.0)
        for number, row in enumerate(rows):
            x, y = fixed(row.x), fixed(row.y)
            foot = np.array([below[place] for place in x.tolist()]) if self.stacked else np.zeros(x.size)
            below |= dict(zip(x.tolist(), (foot + y).tolist(), strict=True))
            shift = 0.0 if self.stacked else (number - 0.5 * (len(rows) - 1)) * width
            yield row, x + shift, foot, width
