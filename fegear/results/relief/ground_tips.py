"""Tip reliefs that a shop can grind, one gear each: what a table and single values give of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows
from fegear.design.tip_relief.tip_tolerance import NOTHING
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.relief import roll_in_drawing
from fegear.results.relief.answer_numbers import ground_microns, microns, told_apart

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fegear.base.arrays import Array
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.engine.sheet.seen import Seen, Where
    from fegear.geometry.gear import Gear
    from fegear.geometry.relief import EndRelief

#: Estimated error of an amount over it from which its optimum is flat.
_SHARP = 0.01
#: The same where two searches for the least maximum within tolerances are how far amounts are apart.
_FLAT = 0.05


@dataclass(frozen=True)
class GroundTip:
    """Tip relief of one gear.

    Parameters
    ----------
    ground : TipReliefPair
        Of both gears.
    gear : Gear
    left : TransmissionError or None
        What the reliefs of both gears leave.
    left_error : float or None
        Of its peak-to-peak and its effective value [m].
    """

    ground: TipReliefPair
    gear: Gear
    left: TransmissionError | None
    left_error: float | None
    shape: str = shown("", "of the tip relief")
    member: Member = shown("", "driver or driven", name="gear")

    @property
    def base_radius(self) -> float:
        """[m]."""
        return self.gear.base_radius

    @property
    def relief(self) -> EndRelief:
        """Its own."""
        return self.ground.driver if self.member == "driver" else self.ground.driven

    @property
    def _own(self) -> slice:
        return slice(0, 2) if self.member == "driver" else slice(2, 4)

    @property
    def error(self) -> Array:
        """Of amount [m] and start [rad]."""
        return self.ground.error[self._own]

    @property
    def band(self) -> tuple[EndRelief, EndRelief]:
        """The least and the largest that are equally good."""
        return self.ground.driver_band if self.member == "driver" else self.ground.driven_band

    @property
    def low_error(self) -> Array:
        """Of the least of these."""
        return self.ground.band_error[0, self._own]

    @property
    def high_error(self) -> Array:
        """Of the largest."""
        return self.ground.band_error[1, self._own]

    @property
    @shows("deg", "roll angle at which the relief starts", name="start_roll_angle")
    def start(self) -> float:
        """As on the drawing: positive on an internal gear, too [rad]."""
        return self.drawn_start(self.relief)

    def drawn_start(self, tip: EndRelief) -> float:
        """Roll angle at which a relief of this gear starts, as on the drawing [rad]."""
        return float(roll_in_drawing(self.gear, tip.start))

    @property
    @shows("mm", "as radius")
    def start_radius(self) -> float:
        """Of the flank point at which it starts [m]."""
        return self.base_radius * math.hypot(1.0, self.relief.start)

    @property
    def start_radius_error(self) -> float:
        """[m]."""
        return float(self.base_radius * self.start / math.hypot(1.0, self.start) * self.error[1])

    @property
    @shows("um", "minimum found")
    def least(self) -> float:
        """[m]."""
        return self.ground.least

    @property
    @shows("um", "difference between two independent searches")
    def least_error(self) -> float:
        """[m]."""
        return self.ground.least_error

    @property
    @shows("", "number of reliefs scanned")
    def candidates(self) -> int:
        """Of both gears."""
        return self.ground.candidates

    @property
    @shows("", "number of start points of the search")
    def starts(self) -> int:
        """Of both gears."""
        return self.ground.starts

    @property
    def has_band(self) -> bool:
        """Whether equally good ones were looked for: not of reliefs chosen by the maximum within their tolerances."""
        return self.ground.undeviated is None

    @property
    def equal_amounts(self) -> str:
        """Amounts that are equally good; empty where they were not looked for."""
        if not self.has_band:
            return ""
        return " to ".join(f"{one.amount * 1e6:.4g}" for one in self.band) + " um"

    @property
    def equal_starts(self) -> str:
        """Starts that are equally good; empty where they were not looked for."""
        return (
            ""
            if not self.has_band
            else " to ".join(f"{math.degrees(self.drawn_start(one)):.5g}" for one in self.band[::-1]) + " deg"
        )


def tips_of(
    ground: TipReliefPair,
    pair: GearPair,
    shape: str = "",
    left: TransmissionError | None = None,
    left_error: float | None = None,
) -> tuple[GroundTip, ...]:
    """The tip reliefs of both gears of a pair, driver first."""
    return tuple(GroundTip(ground, pair.gear(member), left, left_error, shape, member) for member in MEMBERS)


def tip_numbers(tips: Where, head: str) -> Each:
    """Amount and start of each tip relief, no start without an amount; what is equally good is named with each.

    Parameters
    ----------
    tips : where
        Sequence of `GroundTip`.
    head : str
        Start of the values' names after that of the pair and the member.
    """
    return Each(tips, _tip_number(head, "amount", "amount to grind", 0), _tip_number(head, "start", "roll angle", 1))


def _tip_number(head: str, what: str, words: str, number: int) -> Number:
    def meaning(seen: Seen) -> str:
        equal = getattr(seen.one, f"equal_{what}s")
        return f"{words}; equally good: {equal}" if equal else words

    def starts(seen: Seen) -> bool:
        return what == "amount" or float(seen.one.relief.amount) > NOTHING

    quantity = "relief.amount" if what == "amount" else what
    return Number(
        quantity, lambda seen: seen.one.error[number], owner="{name}.{one.member}", name=f"{head}{what}",
        meaning=meaning, choice=True, when=starts,
    )  # fmt: skip


def said_of_flat_optima(seen: Seen) -> Iterator[str]:
    """Where amounts of a wide range are equally good: their estimated errors are no inaccuracy of the result."""
    flat: dict[str, list[str]] = {}
    for tip in seen.data.tips:
        if not tip.has_band:
            yield from _said_of_two_searches(seen, tip)
            continue
        low, high = (one.amount for one in tip.band)
        if high > low and tip.error[0] > _SHARP * tip.relief.amount:
            band = " to ".join(told_apart(low, high))
            flat.setdefault(tip.shape, []).append(f"{band} µm on gear {seen.asked.gears[tip.member]}")
    for shape, bands in flat.items():
        yield (
            f"Pair {seen.name}: flat optimum of {shape} tip relief: {' and '.join(bands)} with their best starts leave "
            "at most 1 % more than the minimum."
        )


def _said_of_two_searches(seen: Seen, tip: GroundTip) -> Iterator[str]:
    """Where two searches for the least maximum within the tolerances end apart."""
    if 0.0 < _FLAT * tip.relief.amount < tip.error[0]:
        amount = f"{ground_microns(tip.relief.amount)} ± {microns(tip.error[0])} µm"
        yield (
            f"Pair {seen.name}: flat optimum of {tip.shape} tip relief: {amount} on gear "
            f"{seen.asked.gears[tip.member]} is what two searches differ by, with maxima within the tolerances that "
            f"differ by {microns(tip.least_error)} µm."
        )


def _errors(which: str, what: int) -> Callable[[Seen], Array | None]:
    """Errors of amounts or starts, a number for each row; None of the ends of a band that was not looked for."""

    def found(seen: Seen) -> Array | None:
        known = which == "error" or all(tip.has_band for tip in seen.data.tips)
        return np.array([getattr(tip, which)[what] for tip in seen.data.tips]) if known else None

    return found


def _left(seen: Seen) -> Array | None:
    """Errors of what they leave, a number for each row."""
    known = [tip.left_error for tip in seen.data.tips]
    return None if None in known else np.array(known)


def _end(which: str, quantity: str, name: str, meaning: str) -> Cell:
    def si(seen: Seen) -> list[float] | None:
        if not all(tip.has_band for tip in seen.data.tips):
            return None
        ends = [(tip, tip.band[which == "high"]) for tip in seen.data.tips]
        return [tip.drawn_start(end) if quantity == "start" else end.amount for tip, end in ends]

    return Cell(quantity, si,
                lambda seen: seen.data.tips[0].relief, name, meaning)  # fmt: skip


def _end_off(which: str, quantity: str, name: str, how: str) -> Off:
    return Off(f"relief.{quantity}", _errors(f"{which}_error", int(quantity == "start")),
               f"how much {how} {name} may be", name=name)  # fmt: skip


_EQUAL = "equally good, roll angle"
#: The reliefs of `tips`, a row for each gear and shape, and what they leave by the evaluation of the single values.
GRINDABLE = Rows(
    "grindable_{name}",
    "Grindable tip reliefs of {name}",
    (
        "shape", "member", "relief.amount", Off("relief.amount", _errors("error", 0)), "start",
        Off("start", _errors("error", 1)), "start_radius",
        Off("start_radius", lambda seen: [tip.start_radius_error for tip in seen.data.tips]),
        Cell("left.peak_to_peak", meaning="remaining at design load"),
        Off("left.peak_to_peak", _left, "estimated error of te_peak_to_peak and te_effective"),
        Cell("left.effective_error", meaning="remaining A_e"), "least", "least_error",
        _end("low", "amount", "amount_from", "lower end of near-optimum range (within 1 % of the minimum)"),
        _end("high", "amount", "amount_to", "equally good"),
        _end_off("low", "amount", "amount_from", "less"), _end_off("high", "amount", "amount_to", "more"),
        _end("high", "start", "start_from", _EQUAL), _end("low", "start", "start_to", _EQUAL),
        _end_off("high", "start", "start_from", "less"), _end_off("low", "start", "start_to", "more"),
        "candidates", "starts",
    ),
    of="tips", when="tips",
)  # fmt: skip
