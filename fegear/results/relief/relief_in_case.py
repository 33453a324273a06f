"""A designed relief as a case writes it: by Eq. 4.6 as tables, or the tip reliefs that a shop can grind."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fegear.base.printed import percent
from fegear.results.relief.relief_data import ReliefData

if TYPE_CHECKING:
    from fegear.design.relief_design import ReliefDesign
    from fegear.engine.run import Results

#: ``exact``: by Mark's Eq. 4.6, as tables; ``ground``: linear or parabolic tip reliefs that a shop can grind.
How = Literal["exact", "ground"]


#: Points of a designed relief that a case is given: straight lines between them stay within its own error.
_POINTS = 61


#: A removal below this is none [um].
_NOTHING = 0.005


def relief_for_case(results: Results, pair: str, how: How) -> dict[str, dict[str, Any] | None]:
    """Reliefs of both gears of a pair.

    Parameters
    ----------
    results : Results
        Of a case that asks for ``relief`` of that pair.
    pair : str
    how : {"exact", "ground"}

    Returns
    -------
    dict
        By gear ``gear.NAME.relief`` as plain data; None where nothing is removed.
    """
    part = results.scene.case.pair[pair]
    if how == "exact":
        return {gear: {"table": _table(results, pair, gear)} for gear in (part.driver, part.driven)}
    shape, best = _design(results).best_ground
    form = {} if shape == "linear" else {"shape": shape}
    found: dict[str, dict[str, Any] | None] = {}
    for gear, relief in ((part.driver, best.driver), (part.driven, best.driven)):
        amount, start = relief.amount * 1e6, math.degrees(relief.start)
        tip = {"amount": f"{amount:.4g} um", "start_roll_angle": f"{start:.6g} deg", **form}
        found[gear] = {"tip": tip} if amount > _NOTHING else None
    return found


def _design(results: Results) -> ReliefDesign:
    (data,) = (one.data for one in results.outcomes.values() if isinstance(one.data, ReliefData))
    return data.design


def _table(results: Results, pair: str, gear: str) -> dict[str, list[str]]:
    table = results.tables[f"relief_{pair}_{gear}"]
    roll, removal = (np.asarray(table[name], dtype=float) for name in ("roll_angle", "relief"))
    order = np.argsort(roll)
    places = np.linspace(roll.min(), roll.max(), _POINTS)
    taken = np.interp(places, roll[order], removal[order])
    return {
        "roll_angles": [f"{one:.6g} deg" for one in places],
        "removals": [f"{one:.4g} um" for one in taken],
    }


def what_it_leaves(results: Results, how: How) -> str:
    """What the reliefs leave of the transmission error, peak to peak, in a sentence or two."""
    design = _design(results)
    te, load = {label: one.peak_to_peak * 1e6 for label, one in design.te.items()}, f"{design.task.load:.5g} N"
    before = f"peak to peak ({te['no relief']:.3g} um without relief, at {load})"
    if how == "exact":
        left = "0 um" if te["designed"] < _NOTHING else f"{te['designed']:.3g} um"
        return f"Relief by Mark's Eq. 4.6: transmission error {left} {before}."
    shape, best = design.best_ground
    others = [f"{one} ones {te[f'{one} tip relief']:.3g} um" for one in design.ground if one != shape]
    beside = f"; {', '.join(others)}" if others else ""
    return (
        f"Best {shape} tip relief: transmission error {te[f'{shape} tip relief']:.3g} um {before}{beside}. Two "
        f"independent searches (after a scan of {best.candidates:,} reliefs) agree within "
        f"{percent(best.least_error / best.least if best.least > 0.0 else 0.0)}."
    )
