"""Reliefs over torque: what each leaves at every torque, also within tolerances, and what to grind in a sentence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.design.load_range import proportions
from fegear.design.preferred import CLEARLY
from fegear.engine.colours import ROLES
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.geometry.pair import MEMBERS
from fegear.results.relief.allowed_words import allowed_words, decisive_words
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.left_errors import left_error
from fegear.results.relief.within_words import lost_words, within_words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.design.tip_relief.tip_tolerance import Decisive
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.pair import GearPair
    from fegear.results.relief.grinding import Grinding

#: Torques of a spectrum that an answer names at most.
_NAMED = 4

#: Over what no relief leaves, from which a relief is said to leave more: below, both read the same.
_MORE = 1.005

#: Largest over smallest torque from which a range is wide: its small torques may govern the relief of all.
_WIDE = 10.0


@dataclass(frozen=True)
class LeftOverRange:
    """What one relief leaves at each torque of the range, arrays of shape (L,).

    Parameters
    ----------
    error : float or ndarray, shape (L,), or None
        Of the peak-to-peak values [m].
    finer : int or None
        By how many classes the tolerances would have to be finer for it to leave no more than no relief anywhere: 0
        where they do, None where none does.
    slopes : ndarray, shape (L,), or None
        Of no relief: maximum peak-to-peak value with profile slopes inside the tolerances of the amounts [m]; None
        where nothing is compared with it.
    decisive : tuple of Decisive or None, length L
        Which tolerance, once halved, reduces the maximum within the tolerances most at each torque; empty where this
        is not known.
    """

    torque: Array = shown("N.m", "torque on the driver", label="torque on the driver")
    load: Array = shown("N", "total load along the line of action", name="total_load")
    weight: Array = shown("", "weight in the design, over the largest")
    peak_to_peak: Array = shown("um", "peak-to-peak transmission error", name="te_peak_to_peak")
    first: Array = shown("um", "first harmonic of the transmission error, amplitude", name="te_first_harmonic")
    most: Array | None = shown(
        "um", "maximum peak-to-peak transmission error within the tolerances of amount and length",
        name="te_peak_to_peak_max", default=None,
    )  # fmt: skip
    error: float | Array | None = None
    mean: Array | None = shown(
        "um", "peak-to-peak transmission error, mean over the scatter of misalignment",
        name="te_mean_over_scatter", default=None,
    )  # fmt: skip
    finer: int | None = 0
    decisive: tuple[Decisive | None, ...] = ()
    slopes: Array | None = None
    share: Array | None = shown("", "share of time in the load spectrum", default=None, name="time_share")
    rounded: Array | None = shown(
        "um", "peak-to-peak transmission error with the rounded numbers of the grinding table",
        name="te_peak_to_peak_rounded", default=None,
    )  # fmt: skip

    @property
    def time_mean(self) -> float:
        """Peak-to-peak value, mean over the time under load of the spectrum [m]."""
        return float("nan") if self.share is None else float(np.average(self.peak_to_peak, weights=self.share))

    @property
    def compared(self) -> Array:
        """Of no relief: what a relief within its tolerances is compared with, shape (L,) [m]."""
        return self.peak_to_peak if self.slopes is None else self.slopes

    @property
    def named(self) -> tuple[int, ...]:
        """Places that an answer names, the largest torque first: both ends, of a spectrum also the longest times."""
        longest = [] if self.share is None else np.argsort(-self.share, kind="stable")[: _NAMED - 2].tolist()
        return tuple(sorted({0, self.torque.size - 1, *longest}, reverse=True))

    @property
    def errors(self) -> Array | None:
        """Of the peak-to-peak values [m]."""
        return None if self.error is None else np.broadcast_to(self.error, self.torque.shape)


def left_over_range(
    design: ReliefDesign, pair: GearPair, shifted: Sequence[Engagement] = ()
) -> dict[str, LeftOverRange]:
    """What every relief leaves at the loads of the range, or of the pair; `shifted` as in `left_error`."""
    load = np.array(design.task.over_loads)
    weights, over = design.task.over_weights, design.task.over
    shares = None if over is None or over.shares is None else np.array(over.shares)
    within = {f"{shape} tip relief": both[:, 1] for shape, both in design.within.items()}
    best = f"{design.shapes[0]} tip relief" if design.ground else ""
    rounded = {f"{shape} tip relief": one for shape, one in design.rounded.items()}
    searched = {f"{shape} tip relief": one for shape, one in design.ground.items()}
    searched |= {f"{shape} tip relief for one load": one for shape, one in design.for_one_load.items()}
    return {
        label: LeftOverRange(
            load * pair.driver.base_radius, load, weights / weights.max(),
            np.array([one.peak_to_peak for one in found]), np.array([one.series.amplitude[0] for one in found]),
            within.get(label), _errors(found, shifted, searched.get(label)),
            finer=design.finer if label == best else 0, decisive=design.decisive if label == best else (),
            share=shares, rounded=rounded.get(label),
            slopes=design.unrelieved_most if label == "no relief" else None,
        )
        for label, found in _best_first(design).items()
    }  # fmt: skip


def _best_first(design: ReliefDesign) -> dict[str, tuple[TransmissionError, ...]]:
    """What is left without relief, with the present one, with those to grind, the best first, and with the others."""
    shapes = [f"{shape} tip relief" for shape in design.shapes] if design.ground else []
    order = dict.fromkeys(("no relief", "present relief", *shapes, "designed", *design.over_range))
    return {label: design.over_range[label] for label in order if label in design.over_range}


def _errors(
    found: Sequence[TransmissionError], shifted: Sequence[Engagement], ground: TipReliefPair | None
) -> Array | None:
    """Of the peak-to-peak value at each torque [m]."""
    searched = None if ground is None else ground.objective_error
    known = [left_error(te, shifted, searched).peak_to_peak for te in found]
    return None if None in known else np.array(known)


def said_of_range(seen: Seen) -> Iterator[str]:
    """What to grind and what it leaves from the largest to the smallest torque; what one load only would do."""
    if seen.data.for_range:
        yield from said_at(seen, tuple(range(-1, -1 - _first(seen).torque.size, -1)), _first(seen).named)


def said_of_spectrum(name: str, none: LeftOverRange, drawn: LeftOverRange) -> Iterator[str]:
    """What a relief leaves on the mean over the time of a spectrum, and what it was designed by; nothing without one.

    Parameters
    ----------
    name : str
        Of the pair.
    none, drawn : LeftOverRange
        Without relief, and with what is ground.
    """
    if none.share is None:
        return
    before, after = told_apart(none.time_mean, drawn.time_mean)
    yield (
        f"Pair {name}: mean over the time under load {before} -> {after} µm; minimised: the maximum over the load "
        "spectrum of transmission error / torque times share of time."
    )


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
    """Tolerances of the ground gears that are so many classes finer, in words."""

    def allowed(classes: int) -> str:
        return allowed_words([one.finer(classes) if classes else one for one in seen.asked.tolerances], rows)

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
        gears = {row.member: row.gear for row in rows}
        decides = decisive_words(best.peak_to_peak[i], best.most[i], best.torque[i], best.decisive[i], gears)
        if decides:
            yield f"Pair {seen.name}: {decides}."
    weights = ", or set weights that emphasise the larger torques" if len(every) > 1 and best.share is None else ""
    for row in rows:
        if row.is_faint:
            off = seen.asked.tolerances[MEMBERS.index(row.member)].amount
            amount, allowed_off = microns(row.amount), microns(off)
            yield (
                f"Pair {seen.name}: {amount} µm on gear {row.gear} is below a quarter of its tolerance "
                f"(± {allowed_off} µm) and cannot be ground; omit it{weights}."
            )


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


def left_words(
    none: Array, drawn: Array, most: Array | None, torque: Array, at: Sequence[int], share: Array | None = None
) -> str:
    """Without relief, as drawn and at most within the tolerances: "7 -> 2.4 µm (tolerances: at most 4.5 µm) at ...".

    Parameters
    ----------
    none, drawn : ndarray, shape (L,)
        Peak-to-peak transmission error [m].
    most : ndarray, shape (L,), or None
        With amounts and lengths inside their tolerances; None where nothing is known of these [m].
    torque : ndarray, shape (L,)
        [N m].
    at : sequence of int
        Places that are named.
    share : ndarray, shape (L,), optional
        Of the time, at each torque of a spectrum.
    """
    said: list[str] = []
    for i in at:
        within = ""
        if most is not None:
            within = f" ({'at most' if said else 'within tolerances at most'} {microns(most[i])} µm)"
        time = "" if share is None else f" for {percent(float(share[i])).replace('.0 %', ' %')} of the time"
        said.append(f"{microns(none[i])} -> {microns(drawn[i])} µm{within} at {torque_words(torque[i])}{time}")
    return ", ".join(said)


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


def _key(seen: Seen) -> str:
    return seen.key.replace(" ", "_").replace("-", "_")


def _legend(seen: Seen) -> str:
    """A relief in a legend; that by theory is for one load, whatever the others are for."""
    return "exact relief for one load (designed)" if seen.key == "designed" else seen.key


def _role(seen: Seen) -> str:
    """The look of a relief, or of its place among several that have none."""
    places = list(seen.data.over_range)
    return seen.key if seen.key in ROLES else f"series:{places.index(seen.key)}"


def _first(seen: Seen) -> LeftOverRange:
    return next(iter(seen.data.over_range.values()))


OVER_RANGE = Rows(
    "relief_over_torque_{name}", "Transmission error of {name} over the torque, with each relief",
    (
        "torque", "load", "weight", "share",
        Each(
            "over_range",
            Cell("peak_to_peak", name=lambda seen: f"te_peak_to_peak_{_key(seen)}", further=", {key}"),
            Off("peak_to_peak", "errors", name=lambda seen: f"te_peak_to_peak_{_key(seen)}"),
            Cell("rounded", name=lambda seen: f"te_peak_to_peak_rounded_{_key(seen)}", further=", {key}"),
            Cell("most", name=lambda seen: f"te_peak_to_peak_max_{_key(seen)}", further=", {key}"),
            Cell("first", name=lambda seen: f"te_first_harmonic_{_key(seen)}", further=", {key}"),
            Cell("mean", name=lambda seen: f"te_mean_over_scatter_{_key(seen)}", further=", {key}"),
        ),
    ),
    of=_first, when="over_range", printed=True,
)  # fmt: skip

#: Of every relief, where the loads are those of a spectrum.
TIME_MEANS = Each(
    "over_range",
    Number(
        "peak_to_peak", si="time_mean", name=lambda seen: f"te_time_mean.{_key(seen)}",
        meaning="mean over the time under load of the spectrum, {key}",
    ),
)  # fmt: skip

RANGE_CHART = Chart(
    "relief_over_torque_{name}", "Transmission error of pair {name} over the torque",
    "Pair {name}: peak-to-peak transmission error over the torque with each relief, and without. Thin: maximum within "
    "the tolerances of the grinding table.",
    (
        Over(
            "torque",
            (
                Bundle(
                    Family("over_range", role=_role),
                    (
                        Line("peak_to_peak", _legend, look={"markers": True}),
                        Line("most", look={"width": 0.8, "markers": False}),
                    ),
                ),
            ),
            lambda _: Axis("peak-to-peak transmission error", "um", zero=True),
        ),
    ),
    of=_first, when=lambda seen: _first(seen).torque.size > 1,
)  # fmt: skip
