"""Curves over frequency, speed or a parameter as they are drawn: broken at poles, on axes that end beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.dynamics.train.resolved_response import broken
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Family, Line, Over
from fegear.engine.sheet.seen import Seen, Where

#: An axis with poles or zeros that nothing limits ends so far above and below the middle of its curves.
_ABOVE, _BELOW = 1e3, 1e-4
#: Curves that a panel has at most: all.
_ALL = 1000


@dataclass(frozen=True)
class DrawnCurve:
    """A curve in the units of its panel's axes; NaN makes a gap."""

    name: str
    role: str
    x: Array = shown("", "in the unit of the abscissa")
    y: Array = shown("", "in the unit of the ordinate")
    width: float = 1.8
    dash: str = ""

    @classmethod
    def on_log(
        cls, name: str, role: str, x: Array, y: Array, poles: Array, width: float = 1.8
    ) -> DrawnCurve:  # fmt: skip
        """On a logarithmic ordinate, with a gap at every pole."""
        along, size = broken(x, y, poles)
        return cls(name, role, along, np.where(size > 0.0, size, np.nan), width)


@dataclass(frozen=True)
class DrawnPanel:
    """Curves with their axes."""

    x: Axis
    y: Axis
    curves: Sequence[DrawnCurve]
    title: str = ""


def _look(seen: Seen) -> dict[str, Any]:
    return {"markers": False, "width": seen.one.width, "dash": seen.one.dash}


def drawn_panels(where: Where) -> Over:
    """Panels of such curves."""
    lines = Line("y", "{one.name}", x="x", each=Family("curves", role="{one.role}", most=_ALL), look=_look)
    return Over(lambda seen: seen.one.x, (lines,), lambda seen: seen.one.y, title="{one.title}", each=where)


def ends(rows: Sequence[Array]) -> tuple[float, float] | None:
    """Ends of a logarithmic axis for curves with poles and zeros that nothing limits."""
    if not rows:
        return None
    middles = [float(np.median(row)) for row in rows]
    least = min(float(row[row > 0.0].min()) for row in rows)
    return max(_BELOW * min(middles), 0.5 * least), _ABOVE * max(middles)
