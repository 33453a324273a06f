"""Reliefs over torque: what each leaves at every torque, also within tolerances, and what to grind in a sentence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.engine.colours import ROLES
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.results.relief.allowed_words import allowed_words
from fegear.results.relief.left_errors import left_error

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.pair import GearPair
    from fegear.results.relief.grinding import Grinding


#: Share of what one shape may leave within its tolerances below which another is worth a word.
_CLEARLY = 0.95


@dataclass(frozen=True)
class LeftOverRange:
    """What one relief leaves at each torque of the range, arrays of shape (L,).

    Parameters
    ----------
    error : float or ndarray, shape (L,), or None
        Of the peak-to-peak values [m].
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

    @property
    def allowed(self) -> Array:
        """Maximum within the tolerances; without them what the relief itself leaves."""
        return self.peak_to_peak if self.most is None else self.most

    @property
    def worst_allowed(self) -> float:
        """The worst of it in proportion to the load, as the design counts it [m]."""
        return float((self.allowed * self.weight * self.load.max() / self.load).max())

    @property
    def errors(self) -> Array | None:
        """Of the peak-to-peak values [m]."""
        return None if self.error is None else np.broadcast_to(self.error, self.torque.shape)


def left_over_range(
    design: ReliefDesign, pair: GearPair, shifted: Sequence[Engagement] = ()
) -> dict[str, LeftOverRange]:
    """What every relief leaves at the loads of the range, or of the pair; `shifted` as in `left_error`."""
    over, load = design.task.over, np.array(design.task.over_loads)
    weights = np.asarray(load == design.task.load, dtype=float)
    if over is not None:
        weights = np.ones(load.size) if over.weights is None else np.array(over.weights)
    within = {f"{shape} tip relief": both[:, 1] for shape, both in design.within.items()}
    searched = {f"{shape} tip relief": one for shape, one in design.ground.items()}
    searched |= {f"{shape} tip relief for one load": one for shape, one in design.for_one_load.items()}
    return {
        label: LeftOverRange(
            load * pair.driver.base_radius, load, weights / weights.max(),
            np.array([one.peak_to_peak for one in found]), np.array([one.series.amplitude[0] for one in found]),
            within.get(label), _errors(found, shifted, searched.get(label)),
        )
        for label, found in design.over_range.items()
    }  # fmt: skip


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
        yield from said_at(seen, tuple(range(-1, -1 - _first(seen).torque.size, -1)), (-1, 0))


def said_at(seen: Seen, every: tuple[int, ...], ends: tuple[int, ...]) -> Iterator[str]:
    """The same of some torques of the table, by their numbers in it; what tolerances may leave at any of them."""
    d = seen.data
    shape = d.grinding[0].shape
    none, best = (d.over_range[label] for label in ("no relief", f"{shape} tip relief"))
    rows = [row for row in d.grinding if row.shape == shape and row.words]
    ground = [row.words for row in rows]
    left = ", ".join(
        f"{figures(none.peak_to_peak[i] * 1e6, 2)} -> {figures(best.peak_to_peak[i] * 1e6, 2)} µm at "
        f"{figures(best.torque[i], 4)} N m"
        for i in dict.fromkeys(i % best.torque.size for i in ends)
    )
    do = f"grind {' and '.join(ground)}, {shape}" if ground else "no tip relief reduces the transmission error"
    yield f"Pair {seen.name}: {do}: transmission error {left}, peak to peak."
    if ground and best.most is not None:
        yield _tolerated(seen, shape, none, best, every, rows)
    single = d.over_range.get(f"{shape} tip relief for one load")
    worse = np.flatnonzero(single.peak_to_peak > none.peak_to_peak) if single else np.empty(0, dtype=int)
    if single and worse.size:
        i = int(worse[np.argmax((single.peak_to_peak / none.peak_to_peak)[worse])])
        nominal = d.load * single.torque[i] / single.load[i]
        yield (
            f"Pair {seen.name}: tip relief designed for {figures(nominal, 4)} N m only gives "
            f"{figures(single.peak_to_peak[i] * 1e6)} µm peak-to-peak at {figures(single.torque[i], 4)} N m, "
            f"more than without relief ({figures(none.peak_to_peak[i] * 1e6)} µm)."
        )


def _tolerated(
    seen: Seen, shape: str, none: LeftOverRange, best: LeftOverRange, ends: tuple[int, ...], ground: list[Grinding]
) -> str:  # fmt: skip
    """What tolerances may leave where they take most of the gain, and which other shape they hurt less."""
    most, at = best.allowed, np.array(ends) % best.torque.size
    i = int(at[np.argmax(most[at] / none.peak_to_peak[at])])
    more = "more than the " if most[i] > none.peak_to_peak[i] else ""
    without = f"{more}{figures(none.peak_to_peak[i] * 1e6, 2)} µm without relief"
    said = (
        f"Pair {seen.name}: within {allowed_words(seen.asked.tolerances, ground)} at most "
        f"{figures(most[i] * 1e6, 2)} µm at {figures(best.torque[i], 4)} N m ({without})"
    )
    others = {
        key.removesuffix(" tip relief"): one
        for key, one in seen.data.over_range.items()
        if one.most is not None and key != f"{shape} tip relief"
    }
    other = min(others, key=lambda key: others[key].worst_allowed, default="")
    if not other or others[other].worst_allowed > _CLEARLY * best.worst_allowed:
        return f"{said}."
    within = figures(others[other].allowed[i] * 1e6, 2)
    return f"{said}; {other} tip relief is better within its tolerances: at most {within} µm."


def _key(seen: Seen) -> str:
    return seen.key.replace(" ", "_").replace("-", "_")


def _role(seen: Seen) -> str:
    """The look of a relief, or of its place among several that have none."""
    places = list(seen.data.over_range)
    return seen.key if seen.key in ROLES else f"series:{places.index(seen.key)}"


def _first(seen: Seen) -> LeftOverRange:
    return next(iter(seen.data.over_range.values()))


OVER_RANGE = Rows(
    "relief_over_torque_{name}", "Transmission error of {name} over the torque, with each relief",
    (
        "torque", "load", "weight",
        Each(
            "over_range",
            Cell("peak_to_peak", name=lambda seen: f"te_peak_to_peak_{_key(seen)}", further="{key}"),
            Off("peak_to_peak", "errors", name=lambda seen: f"te_peak_to_peak_{_key(seen)}"),
            Cell("most", name=lambda seen: f"te_peak_to_peak_max_{_key(seen)}", further="{key}"),
            Cell("first", name=lambda seen: f"te_first_harmonic_{_key(seen)}", further="{key}"),
            Cell("mean", name=lambda seen: f"te_mean_over_scatter_{_key(seen)}", further="{key}"),
        ),
    ),
    of=_first, when="over_range", printed=True,
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
                        Line("peak_to_peak", "{key}", look={"markers": True}),
                        Line("most", look={"width": 0.8, "markers": False}),
                    ),
                ),
            ),
            lambda _: Axis("peak-to-peak transmission error", "um", zero=True),
        ),
    ),
    of=_first, when=lambda seen: _first(seen).torque.size > 1,
)  # fmt: skip
