"""Harris maps: transmission error over the mesh cycle for a family of loads, of a design and beside a load slider."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Panel, Points
from fegear.results.loaded_pair import BASE_PITCH, LoadedPairData, drawn_loads, pitch_marks
from fegear.results.transmission_error import POSITIONS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.arrays import Array
    from fegear.contact import Loaded
    from fegear.engine.figure import Item
    from fegear.geometry import GearPair

#: Loads of a family up to the greatest, and roll positions of the curve that follows a slider.
_FAMILY, _QUICK = 10, 60
#: Name of the curve and the point that are for the present load.
NOW = "present load"


def harris_panel(curve: Loaded, pair: GearPair, load: float, word: str, more: Sequence[Item] = ()) -> Panel:
    """Transmission error over one base pitch, a curve for each load; the one that is `load` is wide.

    Parameters
    ----------
    curve : Loaded
    pair : GearPair
    load : float
        [N]; nan where none of them stands out.
    word : str
        What that load is called.
    more : sequence of items
        Further curves over the same axes.
    """
    loads = [float(w) for w in curve.load]
    items = tuple(
        Curve(
            curve.x * 1e3, curve.transmission_error[:, i] * 1e6, text, role,
            width=3.0 if loads[i] == load else 1.4, markers=False if more else None,
        )
        for i, text, role in drawn_loads(loads, load, word)
    )  # fmt: skip
    axis = Axis("transmission error", "um", zero=True)
    return Panel(BASE_PITCH, axis, (*items, *more), pitch_marks(pair, curve.x))


def _round_step(about: float) -> float:
    """The next step of 1, 2, 2.5 or 5 times a power of ten that is no longer than this."""
    power = 10.0 ** math.floor(math.log10(about))
    return max(one for one in (1.0, 2.0, 2.5, 5.0) if one <= about / power * (1.0 + 1e-9)) * power


def load_now(data: LoadedPairData) -> tuple[float, Array, Array]:
    """The transmission error at the nominal load, at a few roll positions, while a slider moves: N, mm and um."""
    from fegear.contact.mesh_curve import roll_positions

    engagement, load = data.pair.engagement, data.pair.nominal
    x = roll_positions(engagement, _QUICK)
    solved = engagement.solve(engagement.grid(x), (load,))
    return load, x * 1e3, solved.transmission_error[:, 0] * 1e6


def slider_map(name: str, data: LoadedPairData, greatest: float) -> Figure:
    """The Harris map beside a load slider: the family up to the greatest load, and the present load in it.

    Parameters
    ----------
    name : str
        Of the pair.
    data : LoadedPairData
        Its reliefs, errors and effects are those of the case.
    greatest : float
        Load to which the slider goes [N].
    """
    from fegear.contact.mesh_curve import roll_positions

    engagement, now = data.pair.engagement, data.pair.nominal
    step = _round_step(greatest / _FAMILY)
    loads = step * np.arange(1, math.floor(greatest / step * (1.0 + 1e-9)) + 1)
    x = roll_positions(engagement, POSITIONS)
    at = engagement.grid(x)
    curve, present = engagement.solve(at, tuple(loads)), engagement.solve(at, (now,)).transmission_error * 1e6
    wide = Curve(x * 1e3, present[:, 0], NOW, "ink", dash="solid", width=3.2, markers=False)
    over_roll = harris_panel(curve, engagement.pair, math.nan, "", (wide,))
    over_load = Panel(
        Axis("load along the line of action", "N", zero=True),
        Axis("peak to peak", "um", zero=True),
        (
            Curve(loads, np.ptp(curve.transmission_error, axis=0) * 1e6, "", "designed", markers=True),
            Points(np.array([now]), np.ptp(present, axis=0), NOW, "ink", symbol="circle", size=11.0),
        ),
        height=0.7,
    )
    return Figure(
        f"slider_map_{name}",
        f"Harris map of pair {name}",
        f"Pair {name}: transmission error over the mesh cycle for loads up to {greatest:.5g} N with the reliefs of the "
        "case, and below it how far each curve goes from peak to peak; wide, and the large point: the present load.",
        (over_roll, over_load),
    )
