"""Harris maps: transmission error over the mesh cycle for a family of loads, of a design and beside a load slider."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.contact.loaded_teeth import POSITIONS, LoadedTeeth
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Curve, Item, Points
from fegear.results.pair.loaded_teeth import BASE_PITCH, drawn_loads, pitch_marks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Loaded
    from fegear.geometry.pair import GearPair

#: Loads of a family up to the greatest, and roll positions of the curve that follows a slider.
_FAMILY, _QUICK = 10, 60
#: Name of the curve and the point that are for the present load.
NOW = "present load"


class HarrisCurves(NamedTuple):
    """Transmission error of a pair over a base pitch, for several loads.

    Attributes
    ----------
    x : ndarray, shape (P,)
        Roll positions [m].
    load : ndarray, shape (L,)
        [N].
    transmission_error : ndarray, shape (P, L)
        [m].
    """

    x: Array
    load: Array
    transmission_error: Array


def harris_panel(
    curve: Loaded | HarrisCurves, pair: GearPair, load: float, word: str, more: Sequence[Item] = ()
) -> Panel:
    """Transmission error over one base pitch, a curve for each load; the one that is `load` is wide.

    Parameters
    ----------
    curve : Loaded or HarrisCurves
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


def _now(teeth: LoadedTeeth, positions: int) -> HarrisCurves:
    """The pair under its nominal load."""
    return HarrisCurves(*teeth.error_under([teeth.nominal], positions))


def load_now(teeth: LoadedTeeth) -> tuple[float, Array, Array]:
    """The transmission error at the nominal load, at a few roll positions, while a slider moves: N, mm and um."""
    now = _now(teeth, _QUICK)
    return float(now.load[0]), now.x * 1e3, now.transmission_error[:, 0] * 1e6


def slider_map(name: str, teeth: LoadedTeeth, greatest: float) -> Figure:
    """The Harris map beside a load slider: the family up to the greatest load, and the present load in it.

    Parameters
    ----------
    name : str
        Of the pair.
    teeth : LoadedTeeth
        Its reliefs, errors and effects are those of the case.
    greatest : float
        Load to which the slider goes [N].
    """
    step = _round_step(greatest / _FAMILY)
    loads = step * np.arange(1.0, math.floor(greatest / step * (1.0 + 1e-9)) + 1.0)
    curve, present = HarrisCurves(*teeth.error_under(loads, POSITIONS)), _now(teeth, POSITIONS)
    x, now, error = present.x, present.load, present.transmission_error * 1e6
    wide = Curve(x * 1e3, error[:, 0], NOW, "ink", dash="solid", width=3.2, markers=False)
    over_roll = harris_panel(curve, teeth.pair, math.nan, "", (wide,))
    over_load = Panel(
        Axis("load along the line of action", "N", zero=True),
        Axis("peak to peak", "um", zero=True),
        (
            Curve(loads, np.ptp(curve.transmission_error, axis=0) * 1e6, "", "designed", markers=True),
            Points(now, np.ptp(error, axis=0), NOW, "ink", symbol="circle", size=11.0),
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
