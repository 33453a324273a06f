"""A designed relief as a case writes it: by Eq. 4.6 as tables, or the tip reliefs that a shop can grind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from fegear.base.printed import percent
from fegear.engine.sheet.load_words import load_words
from fegear.results.relief.applied_design import EXACT, keys_of_design, short_keys
from fegear.results.relief.relief_data import ReliefData

if TYPE_CHECKING:
    from fegear.engine.run import Results

#: ``exact``: by Mark's Eq. 4.6, as tables; ``ground``: linear or parabolic tip reliefs that a shop can grind.
How = Literal["exact", "ground"]


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
    gears = (part.driver, part.driven)
    found = keys_of_design(dict(results.tables.items()), pair, gears, EXACT if how == "exact" else "")
    return {gear: short_keys(results.scene, gear, keys.get("relief")) for gear, keys in found.items()}


def _data(results: Results) -> ReliefData:
    (data,) = (one.data for one in results.outcomes.values() if isinstance(one.data, ReliefData))
    return data


def _over(data: ReliefData, label: str) -> str:
    """Peak-to-peak values with a relief from the smallest to the largest torque of a range, as it is rounded."""
    rounded = {f"{shape} tip relief": one for shape, one in data.design.rounded.items()}.get(label)
    found = [one.peak_to_peak for one in data.design.over_range[label]] if rounded is None else rounded
    return f"{found[0] * 1e6:.3g} to {found[-1] * 1e6:.3g} um"


def _best_in_words(data: ReliefData, shape: str, before: str, left: float) -> str:
    """What the best shape leaves, at the design load or at both ends of a range."""
    over = data.design.task.over
    if over is None:
        return f"Best {shape} tip relief: transmission error {left:.3g} um {before}"
    low, high = (load * data.pair.pair.driver.base_radius for load in (over.loads[0], over.loads[-1]))
    return (
        f"Best {shape} tip relief for {low:.4g} to {high:.4g} N m: transmission error "
        f"{_over(data, f'{shape} tip relief')} peak to peak ({_over(data, 'no relief')} without relief)"
    )


def what_it_leaves(results: Results, how: How) -> str:
    """What the reliefs leave of the transmission error, peak to peak, in a sentence or two."""
    data = _data(results)
    design = data.design
    te, load = {label: one.peak_to_peak * 1e6 for label, one in design.te.items()}, load_words(design.task.load)
    before = f"peak to peak ({te['no relief']:.3g} um without relief, at {load})"
    if how == "exact":
        left = "0 um" if te["designed"] < _NOTHING else f"{te['designed']:.3g} um"
        return f"Relief by Mark's Eq. 4.6: transmission error {left} {before}."
    shape, best = design.best_ground
    # what is written into the case has the digits of the grinding table
    at = design.task.over_loads.index(design.task.load)
    te |= {f"{one} tip relief": float(left[at]) * 1e6 for one, left in design.rounded.items()}
    others = [f"{one} ones {te[f'{one} tip relief']:.3g} um" for one in design.ground if one != shape]
    others = others if design.task.over is None else []
    beside = f"; {', '.join(others)}" if others else ""
    return (
        f"{_best_in_words(data, shape, before, te[f'{shape} tip relief'])}{beside}. Two "
        f"independent searches (after a scan of {best.candidates:,} reliefs) agree within "
        f"{percent(best.least_error / best.least if best.least > 0.0 else 0.0)}."
    )
