"""What to grind in sentences: from which diameter, what it leaves over torque, and what tolerances make of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.design.load_range import proportions
from fegear.design.preferred import CLEARLY
from fegear.geometry.pair import MEMBERS
from fegear.results.relief.allowed_words import allowed_words, decisive_words
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.relief_over_range import left_words, said_of_spectrum
from fegear.results.relief.within_words import lost_words, within_words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.grinding import Grinding
    from fegear.results.relief.relief_over_range import LeftOverRange

#: Over what no relief leaves, from which a relief is said to leave more: below, both read the same.
_MORE = 1.005
#: Largest over smallest torque from which a range is wide: its small torques may govern the relief of all.
_WIDE = 10.0


def said_of_range(seen: Seen) -> Iterator[str]:
    """What to grind and what it leaves from the largest to the smallest torque; what one load only would do."""
    if seen.data.for_range:
        first: LeftOverRange = next(iter(seen.data.over_range.values()))
        yield from said_at(seen, tuple(range(-1, -1 - first.torque.size, -1)), first.named)


def said_at(seen: Seen, every: tuple[int, ...], ends: tuple[int, ...]) -> Iterator[str]:
    """The same of some torques of the table, by their numbers in it; what tolerances may leave at any of them."""
    d = seen.data
    chosen = d.grinding[0].shape
    none, best = (d.over_range[label] for label in ("no relief", f"{chosen} tip relief"))
    rows = _ground(seen, chosen)
    lost, shape = "", chosen
    if rows and best.most is not None:
        places = np.array(every) % best.torque.size
        of_places = (none.compared[places], best.most[places], best.torque[places])
        shape = _best_as_drawn(seen, places)  # what tolerances decide is not what deviations of zero leave
        named = "" if shape == chosen else f"{chosen} tip "
        lost = lost_words(*of_places, best.finer, _allowed(seen, rows), named, slopes=none.slopes is not None)
    if lost:
        yield f"Pair {seen.name}: {lost}."
        best, rows = d.over_range[f"{shape} tip relief"], _ground(seen, shape)
    else:
        shape = chosen
    faint = [row for row in rows if row.is_faint]
    if rows and len(faint) == len(rows):
        yield _nothing_to_grind(seen, none, rows, ends)
        single = d.over_range.get(f"{shape} tip relief for one load")
        if single and len(every) > 1:
            yield from _said_of_small_torques(seen, best, single)
        return
    ground = [row.words for row in rows if row not in faint]
    at = tuple(dict.fromkeys(i % best.torque.size for i in ends))
    most = best.most if ground else None
    left = left_words(none.peak_to_peak, best.peak_to_peak, most, best.torque, at, best.share)
    do = f"grind {' and '.join(ground)}, {shape}" if ground else "no tip relief reduces the transmission error"
    do = f"without deviations {do}" if lost else do
    over = "" if none.share is None else " over the load spectrum"
    rounded = _as_rounded(best, at) if ground else ""
    yield f"Pair {seen.name}: {do}: transmission error{over} {left}, peak to peak{rounded}."
    yield from said_of_spectrum(seen.name, none, best)
    single = d.over_range.get(f"{shape} tip relief for one load")
    if single and len(every) > 1 and none.share is None:  # beside other results a design has room for two sentences
        yield from _said_of_small_torques(seen, best, single)
    yield from said_of_undefined(seen, rows)
    yield from said_of_tolerances(seen, shape, every, lost=bool(lost))
    worse = np.flatnonzero(single.peak_to_peak > _MORE * none.peak_to_peak) if single else np.empty(0, dtype=int)
    if single and worse.size:
        i = int(worse[np.argmax((single.peak_to_peak / none.peak_to_peak)[worse])])
        nominal = d.load * single.torque[i] / single.load[i]
        more, less = told_apart(single.peak_to_peak[i], none.peak_to_peak[i])
        yield (
            f"Pair {seen.name}: tip relief designed for {torque_words(nominal)} only gives {more} µm peak-to-peak "
            f"at {torque_words(single.torque[i])}, more than without relief ({less} µm)."
        )


def _as_rounded(best: LeftOverRange, at: Sequence[int]) -> str:
    """What is left with the rounded numbers of the grinding table; empty where this is not known."""
    if best.rounded is None:
        return ""
    left = ", ".join(microns(best.rounded[i], 3) for i in at)
    return f" (with the rounded numbers of the grinding table {left} µm)"


def _nothing_to_grind(seen: Seen, none: LeftOverRange, rows: Sequence[Grinding], ends: tuple[int, ...]) -> str:
    """That the best relief is too small to be ground, and what remains without one."""
    at = tuple(dict.fromkeys(i % none.torque.size for i in ends))
    torques = [torque_words(none.torque[i]) for i in (min(at), max(at))]
    where = f"from {torques[0]} to {torques[1]}" if none.torque.size > 1 else f"at {torques[0]}"
    small = " and ".join(f"{microns(row.amount)} µm on gear {row.gear}" for row in rows)
    off = max(seen.asked.tolerances[MEMBERS.index(row.member)].amount for row in rows)
    left = ", ".join(f"{microns(none.peak_to_peak[i])} µm at {torque_words(none.torque[i])}" for i in at)
    return (
        f"Pair {seen.name}: no tip relief needed {where}: the optimum, {small}, is below a quarter of its tolerance "
        f"(± {microns(off)} µm) and cannot be ground; transmission error without relief {left}, peak to peak."
    )


def _ground(seen: Seen, shape: str) -> list[Grinding]:
    """What is ground of a shape, a row for each gear."""
    return [row for row in seen.data.grinding if row.shape == shape and row.words]


def _best_as_drawn(seen: Seen, places: Array) -> str:
    """The shape that leaves least without deviations at these torques, by the worst of them in proportion."""

    def left(shape: str) -> float:
        one: LeftOverRange = seen.data.over_range[f"{shape} tip relief"]
        part = proportions(one.load[places], one.weight[places])
        return float((part * one.peak_to_peak[places]).max())

    return min(dict.fromkeys(row.shape for row in seen.data.grinding if row.words), key=left)


def _said_of_small_torques(seen: Seen, best: LeftOverRange, single: LeftOverRange) -> Iterator[str]:
    """That small torques of a wide range limit the relief, where one for the largest torque clearly leaves less."""
    small, large = int(np.argmin(best.torque)), int(np.argmax(best.torque))
    if best.torque[large] < _WIDE * best.torque[small]:
        return
    if single.peak_to_peak[large] >= CLEARLY * best.peak_to_peak[large]:
        return
    remaining, possible = told_apart(best.peak_to_peak[large], single.peak_to_peak[large])
    yield (
        f"Pair {seen.name}: torques down to {torque_words(best.torque[small])} limit the relief: {remaining} µm at "
        f"{torque_words(best.torque[large])}, {possible} µm with tip relief for that torque only; set weights that "
        "emphasise the larger torques."
    )


def _allowed(seen: Seen, rows: Sequence[Grinding]) -> Callable[[int], str]:
    """Tolerances that are so many classes finer, in words: of the ground gears, and profile slopes of the others."""
    ground = {row.member for row in rows}
    others = {row.member: row for row in seen.data.grinding if row.member not in ground}

    def allowed(classes: int) -> str:
        of_gears = [one.finer(classes) if classes else one for one in seen.asked.tolerances]
        return allowed_words(of_gears, rows, [*others.values()])

    return allowed


def said_of_tolerances(seen: Seen, shape: str, every: tuple[int, ...], lost: bool = False) -> Iterator[str]:
    """What tolerances may leave of a shape at any of these torques, and which would do where it does not pay.

    `lost`: it has been said already that it does not pay at any of them, and which would do.
    """
    d = seen.data
    none, best = (d.over_range[label] for label in ("no relief", f"{shape} tip relief"))
    rows = _ground(seen, shape)
    if not rows or best.most is None:
        return
    places = np.array(every) % best.torque.size
    i = int(places[np.argmax(best.most[places] / none.compared[places])])

    if not lost:
        slopes = None if none.slopes is None else float(none.slopes[i])
        ends = none.peak_to_peak[i], best.most[i], best.torque[i]
        within = within_words(*ends, best.finer, _allowed(seen, rows), slopes)
        yield f"Pair {seen.name}: {within}{_as_drawn(seen, shape, best, i)}."
    if best.decisive:
        gears = {row.member: row.gear for row in seen.data.grinding}
        decides = decisive_words(best.peak_to_peak[i], best.most[i], best.torque[i], best.decisive[i], gears)
        if decides:
            yield f"Pair {seen.name}: {decides}."
    yield from _said_of_wide_tolerances(seen, rows)
    weights = ", or set weights that emphasise the larger torques" if len(every) > 1 and best.share is None else ""
    for row in rows:
        if row.is_faint:
            off = seen.asked.tolerances[MEMBERS.index(row.member)].amount
            amount, allowed_off = microns(row.amount), microns(off)
            yield (
                f"Pair {seen.name}: {amount} µm on gear {row.gear} is below a quarter of its tolerance "
                f"(± {allowed_off} µm) and cannot be ground; omit it{weights}."
            )


def _said_of_wide_tolerances(seen: Seen, rows: Sequence[Grinding]) -> Iterator[str]:
    """Which amounts are smaller than their tolerances, and what to do; of faint ones another sentence says it."""
    allowed = dict(zip(MEMBERS, seen.asked.tolerances, strict=True))
    small = [row for row in rows if not row.is_faint and abs(row.amount) < allowed[row.member].amount]
    if not small:
        return

    def fits(classes: int) -> bool:
        return all(allowed[row.member].finer(classes).amount <= abs(row.amount) for row in small)

    finest = min(allowed[row.member].finest for row in small)
    classes = next((one for one in range(1, finest + 1) if fits(one)), None)
    sizes = " and ".join(
        f"{microns(row.amount)} µm (± {microns(allowed[row.member].amount)} µm) on gear {row.gear}" for row in small
    )
    finer = []
    if classes is not None:
        tighter = [allowed[row.member].finer(classes) for row in small]
        words = [f"± {microns(one.amount)} µm" + (f" ({one.origin})" if one.origin else "") for one in tighter]
        finer = [f"finer tolerances, {' and '.join(dict.fromkeys(words))}"]
    remedies = [*finer, "a larger amount", "no relief there"]
    verb = "is less than its tolerance" if len(small) == 1 else "are less than their tolerances"
    yield f"Pair {seen.name}: {sizes} {verb}; specify {', '.join(remedies[:-1])} or {remedies[-1]}."


def said_of_undefined(seen: Seen, rows: Sequence[Grinding]) -> Iterator[str]:
    """Which amounts have no defined optimum: their estimated error exceeds them."""
    for row in rows:
        if row.amount_error > abs(row.amount):
            equal = ""
            if row.amount_to > row.amount_from:
                low, high = told_apart(row.amount_from, row.amount_to)
                equal = f"; {low} to {high} µm are equally good"
            yield (
                f"Pair {seen.name}: no defined optimum on gear {row.gear}: {microns(row.amount)} µm has an "
                f"estimated error of {microns(row.amount_error)} µm{equal}."
            )


def _as_drawn(seen: Seen, shape: str, best: LeftOverRange, i: int) -> str:
    """Which other shape leaves less as drawn at this torque, but more within its tolerances; empty for none."""
    if best.most is None:
        return ""
    worse = {
        key.removesuffix(" tip relief"): (float(one.peak_to_peak[i]), float(one.most[i]))
        for key, one in seen.data.over_range.items()
        if one.most is not None
        and key != f"{shape} tip relief"
        and one.peak_to_peak[i] < best.peak_to_peak[i]
        and CLEARLY * one.most[i] > best.most[i]
    }
    if not worse:
        return ""
    other = min(worse, key=lambda key: worse[key])
    drawn, most = map(microns, worse[other])
    return f"; {other} tip relief {drawn} µm as drawn there, but at most {most} µm"
