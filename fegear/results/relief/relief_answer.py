"""What a designed relief comes to: what to grind from which diameter, and what remains at the design and half load."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.design.load_range import proportions
from fegear.design.preferred import CLEARLY
from fegear.engine.sheet.answer import Answer
from fegear.geometry.pair import MEMBERS
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.grinding_words import said_at, said_of_range
from fegear.results.relief.interference_words import said_of_interference

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Floats
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.relief_over_range import LeftOverRange

#: Loads of the case between these shares of the design load count as half of it.
_HALF = (0.3, 0.7)


def _best(seen: Seen) -> str:
    """Shape of the tip relief to be ground; empty where none is designed."""
    return next(iter(seen.data.data.design.shapes), "")


def _interference(seen: Seen) -> Iterator[str]:
    yield from said_of_interference(seen.name, seen.data.data.pair.pair, seen.asked.gears)


def _grind(seen: Seen) -> Iterator[str]:
    """What to grind, and what it changes; limits and objective come second: beside other results there is room for two.

    Where relief does not pay within its tolerances, what to do about that comes first.
    """
    first, *rest = (*_ground(seen), "")
    further = (*_at_limits(seen), *_minimised(seen))
    pays = seen.data.data.design.finer == 0
    for sentence in (first, *further, *rest) if pays else (first, *rest, *further):
        if sentence:
            yield sentence


def _ground(seen: Seen) -> Iterator[str]:
    """What to grind, and what it changes at the design load, or from end to end of a range."""
    if seen.data.for_range:
        yield from said_of_range(seen)
    elif _best(seen):
        at = (seen.data.at_design_load,)
        yield from said_at(seen, at, at)


def _minimised(seen: Seen) -> Iterator[str]:
    """That the maximum within the tolerances is minimised, and what the minimum as drawn would leave at most."""
    design, shape = seen.data.data.design, _best(seen)
    if design.undeviated is None or not shape:
        return
    best: LeftOverRange = seen.data.over_range[f"{shape} tip relief"]
    part = proportions(best.load, best.weight)
    i = int(np.argmax(part * design.undeviated[:, 1]))
    drawn, most = design.undeviated[i]
    own = "" if best.most is None else f", not {microns(best.most[i])} µm"
    yield (
        f"Pair {seen.name}: minimised: maximum within the tolerances (design.metric). Tip relief with the minimum as "
        f"drawn: {microns(drawn)} µm at {torque_words(best.torque[i])}, within tolerances at most {microns(most)}{own}."
    )
    yield from _as_good(seen, shape, best, part)


def _as_good(seen: Seen, shape: str, best: LeftOverRange, part: Floats) -> Iterator[str]:
    """Which other shape has nearly the same maximum, which decides nothing, and what it leaves as drawn."""
    if best.most is None:
        return
    i = int(np.argmax(part * best.most))
    for other in seen.data.data.design.shapes:
        one: LeftOverRange = seen.data.over_range[f"{other} tip relief"]
        if other == shape or one.most is None:
            continue
        if not CLEARLY <= (part * one.most).max() / (part * best.most).max() < 1.0:
            continue
        less, more = told_apart(one.most[i], best.most[i])
        theirs, ours = told_apart(one.peak_to_peak[i], best.peak_to_peak[i])
        yield (
            f"Pair {seen.name}: {other} tip relief is as good within the tolerances (at most {less}, not {more} µm at "
            f"{torque_words(best.torque[i])}: less than {percent(1.0 - CLEARLY, whole=True)}), but {theirs}, not "
            f"{ours} µm as drawn."
        )


def _at_limits(seen: Seen) -> Iterator[str]:
    """Which numbers of the relief to grind lie at limits of the case: less may remain beyond them."""
    design, shape = seen.data.data.design, _best(seen)
    limits, pair = design.task.tip_limits, seen.data.data.pair.pair
    if not shape or limits is None:
        return
    found = []
    for number, member in enumerate(MEMBERS):
        gear, tip, name = pair.gear(member), getattr(design.ground[shape], member), seen.asked.gears[member]
        length = gear.base_radius * (tip.end - tip.start) / pair.path_length
        amount_at, length_at = limits.active(number, tip.amount, length)
        if amount_at:
            found.append(f"amount on gear {name} ({microns(tip.amount)} µm)")
        if length_at:
            diameter = 2.0 * gear.base_radius * math.hypot(1.0, tip.start)
            found.append(f"start on gear {name} (d {diameter * 1e3:.1f} mm)")
    if found:
        yield f"Pair {seen.name}: at design.limits: {', '.join(found)}; less may remain with wider limits."


def _at_half_load(seen: Seen) -> Iterator[str]:
    """What the same relief does near half of the design load, where the case has such a load."""
    shape = _best(seen)
    if not shape or seen.data.for_range:
        return
    none, ground = (seen.data.over_range[label] for label in ("no relief", f"{shape} tip relief"))
    share = none.load / seen.data.load
    k = int(np.argmin(np.abs(share - 0.5)))
    if _HALF[0] <= share[k] <= _HALF[1]:
        before, after = none.peak_to_peak[k], ground.peak_to_peak[k]
        verdict = ", worse than without relief" if after > before else ""
        yield (
            f"Pair {seen.name}: the same relief at {torque_words(none.torque[k])}: {microns(before)} -> "
            f"{microns(after)} µm{verdict}."
        )


def _exact(seen: Seen) -> Iterator[str]:
    """What the relief of theory leaves, and how much it takes off."""
    designed, before = seen.data.left["designed"].te.peak_to_peak, seen.data.left["no relief"].te.peak_to_peak
    most = ", ".join(f"{microns(float(one.table.relief.max()))} µm ({m})" for m, one in seen.data.reliefs.items())
    if most:
        at = torque_words(seen.data.load * seen.data.data.pair.pair.driver.base_radius)
        yield (
            f"Pair {seen.name}: the exact relief, at most {most}, reduces the transmission error from "
            f"{microns(before)} to {microns(designed)} µm at {at}."
        )


def _figure(seen: Seen) -> str:
    return f"relief_over_torque_{seen.name}" if seen.data.for_range else f"relief_{seen.name}"


RELIEF_ANSWER = Answer(_interference, _grind, _at_half_load, _exact, figure=_figure)
