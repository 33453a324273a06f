"""What designed flanks come to: what to grind, what it leaves over torques and within tolerances, why no more."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.design.preferred import CLASS_STEP
from fegear.engine.sheet.answer import Answer
from fegear.results.relief.allowed_words import allowed_words, decisive_words
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.grinding import TIP
from fegear.results.relief.interference_words import said_of_interference
from fegear.results.relief.recommended import nothing_words
from fegear.results.relief.relief_over_range import (
    left_words,
    said_of_spectrum,
)
from fegear.results.relief.within_words import lost_words, within_words

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.flanks.designed_flanks import FlankState
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.grinding import Grinding

#: A transmission error below this is none [m]; by this share of it less is worth a word.
_NONE, _CLEARLY = 1e-12, 0.05


def _left(seen: Seen, label: str) -> tuple[Array, Array]:
    """Torques [N m] and what a way leaves under each [m], aligned as given: of a range, or at the design load."""
    data = seen.data
    if data.over_range[label].torque.size > 1 or seen.asked.over is not None:
        return data.over_range[label].torque, data.over_range[label].peak_to_peak
    state = next(state for state in data.design.states if state.label == label)
    return np.array([data.load * data.data.pair.driver.base_radius]), np.array([state.judged.peak_to_peak.value])


def _interference(seen: Seen) -> Iterator[str]:
    yield from said_of_interference(seen.name, seen.data.data.pair, seen.asked.gears)


def _grind(seen: Seen) -> Iterator[str]:
    """What to grind and what it leaves, from the largest to the smallest torque of a range; why no more is ground."""
    design = seen.data.design
    best, least = design.best, design.least
    torque, none = _left(seen, design.unrelieved.label)
    after = _left(seen, best.label)[1]
    ground = _rows(seen, best)
    within = _at_most(best, torque) if ground else None
    first = seen.data.over_range[design.unrelieved.label]
    ends = first.named if torque.size == first.torque.size else (0,)

    def allowed(classes: int) -> str:
        return _allowed(seen, ground, classes)

    # What tolerances decide is not what deviations of zero leave.
    other = least is not best and not design.alike(best) and not design.within_tolerance(best)
    named = f"{best.label} " if other else ""
    slopes = first.slopes if torque.size == first.torque.size else None
    compared = none if slopes is None else slopes
    lost = ""
    if within is not None:
        lost = lost_words(compared, within, torque, design.finer, allowed, named, slopes=slopes is not None)
    if lost:
        yield f"Pair {seen.name}: {lost}."
    if lost and other:
        drawn, most, rows = _left(seen, least.label)[1], _at_most(least, torque), _rows(seen, least)
    else:
        drawn, most, rows = after, within, ground
    if rows and all(row.is_faint for row in rows):
        yield nothing_words(seen.name, rows, torque, none)
        return
    left = left_words(none, drawn, most, torque, ends, first.share)
    do = f"{'without deviations ' if lost else ''}grind {', '.join(row.words for row in rows) or 'nothing'}"
    over = "" if first.share is None else " over the load spectrum"
    yield f"Pair {seen.name}: {do}: transmission error{over} {left}, peak to peak."
    ground_as = seen.data.over_range[(least if lost and other else best).label]
    yield from said_of_spectrum(seen.name, first, ground_as)
    if within is not None and not lost:
        i = int(np.argmax(within / np.maximum(compared, _NONE)))
        same = None if slopes is None else float(slopes[i])
        yield f"Pair {seen.name}: {within_words(none[i], within[i], torque[i], design.finer, allowed, same)}."
    if within is not None and design.decisive:
        i = int(np.argmax(within / np.maximum(compared, _NONE)))
        gears = {row.member: row.gear for row in ground}
        if decides := decisive_words(after[i], within[i], torque[i], design.decisive[i], gears):
            yield f"Pair {seen.name}: {decides}."
    if least is not best:
        why = "within the estimated error" if design.alike(best) else f"by {_further(seen, best, least)}"
        than = f"than {best.label} ({best.modifications})"
        if not design.alike(best) and not design.within_tolerance(best):
            said = f"is better {than} as drawn{_drawn(seen, best, least)}, but worse within its tolerances"
            said += _within(seen, best, least)
        else:
            gain = percent((design.left_by(best) - design.left_by(least)) / design.left_by(best))
            said = f"is only {gain} better {than}, {why}"
        yield f"Pair {seen.name}: {least.label} ({least.modifications} modifications) {said}."


def _rows(seen: Seen, state: FlankState) -> list[Grinding]:
    """What is ground of a way."""
    return [row for row in seen.data.grinding if row.design == state.label and row.words]


def _at_most(state: FlankState, torque: Array) -> Array | None:
    """What a way leaves at most within its tolerances under each torque [m]; None where it is not known."""
    return state.over_most if state.over_most is not None and state.over_most.size == torque.size else None


def _allowed(seen: Seen, ground: list[Grinding], classes: int) -> str:
    """Tolerances of what is ground, so many classes finer: of tips, and of everything else by its kind."""
    tips, allowed = [row for row in ground if row.modification == TIP], seen.asked.tolerance.tips
    tip = [allowed_words([one.finer(classes) if classes else one for one in allowed], tips)] if tips else []
    rest = [
        f"± {microns(row.amount_tolerance / CLASS_STEP**classes)} µm {row.modification}"
        for row in ground
        if row.modification != TIP
    ]
    return ", ".join([*tip, *dict.fromkeys(rest)])


def _drawn(seen: Seen, best: FlankState, least: FlankState) -> str:
    """What two ways leave as drawn, at the torque at which the one that leaves less in proportion is ahead.

    Values of one torque, as the table of the range has them: what ways are compared by is in proportion to the load.
    """
    design, torque = seen.data.design, _left(seen, best.label)[0]
    if torque.size == 1:
        ours, theirs, i = design.left_by(best), design.left_by(least), 0
    else:
        left = design.left_under(best)
        i = design.worst_load(left)
        ours, theirs = float(left[i]), float(design.left_under(least)[i])
    less, more = told_apart(theirs, ours)
    return f" ({less}, not {more} µm at {torque_words(torque[i])})"


def _within(seen: Seen, best: FlankState, least: FlankState) -> str:
    """What two ways leave at most within their tolerances, at the torque at which it counts most; empty if unknown."""
    torque = _left(seen, best.label)[0]
    most, ours = _at_most(least, torque), _at_most(best, torque)
    if most is None or ours is None:
        return ""
    i = seen.data.design.worst_load(most)
    more, less = told_apart(most[i], ours[i])
    return f" (at most {more}, not {less} µm at {torque_words(torque[i])})"


def _further(seen: Seen, best: FlankState, least: FlankState) -> str:
    """What a way has besides the one to be ground, each below its tolerance."""
    rows = seen.data.grinding
    ours = {(row.gear, row.modification) for row in rows if row.design == best.label}
    more = [
        f"{microns(row.amount)} ± {microns(row.amount_tolerance)} µm {row.modification}"
        for row in rows
        if row.design == least.label and row.words and (row.gear, row.modification) not in ours
    ]
    return f"modifications below their tolerances ({', '.join(more)})"


def _exact(seen: Seen) -> Iterator[str]:
    """What the topography leaves at the design load, and where in a range it leaves more than no relief."""
    design = seen.data.design
    before, after = (state.judged.peak_to_peak.value for state in (design.unrelieved, design.exact))
    at = torque_words(seen.data.load * seen.data.data.pair.driver.base_radius)
    said = (
        f"Pair {seen.name}: the exact topography reduces the transmission error from {microns(before)} to "
        f"{microns(after)} µm at {at}"
    )
    (torque, none), left = _left(seen, design.unrelieved.label), _left(seen, design.exact.label)[1]
    worst = int(np.argmax(left / np.maximum(none, _NONE)))
    if left[worst] > none[worst]:
        more, less = told_apart(left[worst], none[worst])
        said += f"; at {torque_words(torque[worst])} it is {more} µm, more than without relief ({less} µm)"
    yield f"{said}."


def _scattered(seen: Seen) -> Iterator[str]:
    """By what a relief for scattered misalignment is chosen, and which leaves less aligned as specified."""
    design = seen.data.design
    if not design.scattered or not design.ground:
        return
    best, torque = design.best, _left(seen, design.best.label)[0]

    def means(state: FlankState) -> Array:
        """Over the scatter at each torque [m]; at the design load as it is stated."""
        return state.over_mean if torque.size > 1 else np.array([state.judged.mean_over_scatter.value])

    before, after = means(design.unrelieved), means(best)
    left = ", ".join(
        f"{microns(before[i])} -> {microns(after[i])} µm at {torque_words(torque[i])}"
        for i in dict.fromkeys(i % torque.size for i in (-1, 0))
    )
    worst = " (maximum over the torques relative to the torque)" if torque.size > 1 else ""
    said = f"Pair {seen.name}: {best.label} is chosen by the mean over the scatter of misalignment{worst}: {left}"
    aligned = min(design.ground, key=lambda state: float(_left(seen, state.label)[1][-1]))
    mine, other = (float(_left(seen, state.label)[1][-1]) for state in (best, aligned))
    if other < (1.0 - _CLEARLY) * mine:
        said += f"; aligned as specified {aligned.label} leaves less, {microns(other)} µm at {torque_words(torque[-1])}"
    yield f"{said}."


#: What the report says first.
FLANK_DESIGN_ANSWER = Answer(
    _interference, _grind, _scattered, _exact,
    figure=lambda seen: seen.said(
        "relief_over_torque_{name}" if len(seen.data.design.task.loads) > 1 else "flank_topography_{name}"
    ),
)  # fmt: skip
