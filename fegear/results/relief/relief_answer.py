"""What a designed relief comes to: what to grind from which diameter, and what remains at the design and half load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.engine.sheet.answer import Answer
from fegear.geometry.pair import MEMBER_WORDS
from fegear.results.relief.relief_over_range import said_of_range, said_of_tolerances, said_of_undefined

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.sheet.seen import Seen

#: A transmission error below this is none [m].
_NOTHING = 1e-9
#: Loads of the map between these shares of the design load count as half of it.
_HALF = (0.3, 0.7)


def _microns(size: float) -> str:
    """A length [m] in µm."""
    return figures(size * 1e6) if size > _NOTHING else "0"


def _torque(seen: Seen, load: float) -> str:
    return f"{figures(load * seen.data.data.pair.pair.driver.base_radius)} N m"


def _best(seen: Seen) -> str:
    """Shape of the tip relief to be ground; empty where none is designed."""
    return next(iter(seen.data.data.design.shapes), "")


def _grind(seen: Seen) -> Iterator[str]:
    """What to grind, and what it changes at the design load, or from end to end of a range."""
    if seen.data.for_range:
        yield from said_of_range(seen)
        return
    shape, left = _best(seen), seen.data.left
    if not shape:
        return
    amounts = [
        f"{_microns(tip.relief.amount)} µm from d {figures(2e3 * tip.start_radius, 4)} mm "
        f"on the {MEMBER_WORDS[tip.member]}"
        for tip in seen.data.tips
        if tip.shape == shape and tip.relief.amount > _NOTHING
    ]
    before, after = left["no relief"].te.peak_to_peak, left[f"{shape} tip relief"].te.peak_to_peak
    at = _torque(seen, seen.data.load)
    changed = f"transmission error {_microns(before)} -> {_microns(after)} µm peak to peak at {at}"
    if amounts:
        best, i = seen.data.over_range[f"{shape} tip relief"], seen.data.at_design_load
        within = "" if best.most is None else f" (within tolerances at most {_microns(best.most[i])} µm)"
        yield f"Pair {seen.name}: grind {' and '.join(amounts)} ({shape} tip relief): {changed}{within}."
        yield from said_of_undefined(seen, [row for row in seen.data.grinding if row.shape == shape and row.words])
        yield from said_of_tolerances(seen, shape, (i,))
    else:
        yield f"Pair {seen.name}: no tip relief reduces the excitation: {changed}."


def _at_half_load(seen: Seen) -> Iterator[str]:
    """What the same relief does near half of the design load, where such a load is in the map."""
    shape, left = _best(seen), seen.data.left
    if not shape or seen.data.for_range:
        return
    plain, ground = left["no relief"].map, left[f"{shape} tip relief"].map
    share = plain.load / seen.data.load
    k = int(np.argmin(np.abs(share - 0.5)))
    if _HALF[0] <= share[k] <= _HALF[1]:
        before, after = plain.peak_to_peak[k], ground.peak_to_peak[k]
        verdict = ", worse than without relief" if after > before else ""
        yield (
            f"Pair {seen.name}: the same relief at {_torque(seen, plain.load[k])}: {_microns(before)} -> "
            f"{_microns(after)} µm{verdict}."
        )


def _exact(seen: Seen) -> Iterator[str]:
    """What the relief of theory leaves, and how much it takes off."""
    designed, before = seen.data.left["designed"].te.peak_to_peak, seen.data.left["no relief"].te.peak_to_peak
    most = ", ".join(f"{_microns(float(one.table.relief.max()))} µm ({m})" for m, one in seen.data.reliefs.items())
    if most:
        yield (
            f"Pair {seen.name}: the exact relief, at most {most}, reduces the transmission error from "
            f"{_microns(before)} to {_microns(designed)} µm at {_torque(seen, seen.data.load)}."
        )


def _figure(seen: Seen) -> str:
    return f"relief_over_torque_{seen.name}" if seen.data.for_range else f"relief_{seen.name}"


RELIEF_ANSWER = Answer(_grind, _at_half_load, _exact, figure=_figure)
