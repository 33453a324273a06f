"""What the ground flanks of teeth with a width leave when amounts and lengths are off by what a drawing allows.

Where only tips are ground the profile slope of a gear without tip relief is off by the same tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.design.flanks.forms import NUMBERS, TipPower, lead_bearer, powers_of
from fegear.design.flanks.trials import FlankTrials, Tries
from fegear.design.tip_relief.tip_tolerance import (
    HALVED,
    TIP_NUMBERS,
    Decisive,
    LeadNumber,
    TipNumber,
    TipTolerance,
    finer_tolerance,
)
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.relief import EndRelief

#: Tips: amount and length of driver and driven gear; the amounts behind them.
_TIPS = 4
_CROWNING, _END, _SLOPE, _BIAS = (NUMBERS.index(name) for name in ("crowning", "end_relief", "slope", "bias"))
#: Numbers to which each tolerance of the lead belongs.
_OF_LEAD: Mapping[LeadNumber, list[int]] = {"crowning": [_CROWNING, _END], "slope": [_SLOPE], "twist": [_BIAS]}
#: Rounds of tips and lead in turn.
_ROUNDS = 2


@dataclass(frozen=True)
class LeadTolerance:
    """By how much lead and twist of the gear that has them may be off, to either side [m].

    Parameters
    ----------
    slope : float
        Of the helix slope over the face.
    crowning : float
        Of crowning and end relief at the ends of the face.
    twist : float
        Of the flank twist.
    unrounded : tuple of float or None
        The same three by class before they are rounded; None where one does not follow a class.
    """

    slope: float
    crowning: float
    twist: float
    unrounded: tuple[float | None, float | None, float | None] = (None, None, None)

    def finer(self, classes: int) -> LeadTolerance:
        """The same so many classes finer."""
        sizes = self.slope, self.crowning, self.twist
        (slope, a), (crowning, b), (twist, c) = (
            finer_tolerance(size, by_class, classes) for size, by_class in zip(sizes, self.unrounded, strict=True)
        )
        return LeadTolerance(slope, crowning, twist, (a, b, c))


@dataclass(frozen=True)
class FlankTolerance:
    """By how much what is ground on a pair may be off.

    Parameters
    ----------
    tips : tuple of TipTolerance
        Of driver and driven gear.
    lead : LeadTolerance or None
        None where only tips are ground.
    """

    tips: tuple[TipTolerance, TipTolerance]
    lead: LeadTolerance | None = None

    @property
    def finest(self) -> int:
        """By how many classes all of it can be finer."""
        return min(tip.finest for tip in self.tips)

    def finer(self, classes: int) -> FlankTolerance:
        """The same so many classes finer, lengths of tip reliefs as they are."""
        tips = self.tips[0].finer(classes), self.tips[1].finer(classes)
        return FlankTolerance(tips, None if self.lead is None else self.lead.finer(classes))

    @property
    def amounts(self) -> Array:
        """Of the amounts among the nine numbers of a ground relief, zero at lengths, shape (9,) [m]."""
        found = np.zeros(len(NUMBERS))
        found[[0, 2]] = [tip.amount for tip in self.tips]
        if self.lead is not None:
            found[[_CROWNING, _END, _SLOPE, _BIAS]] = (
                self.lead.crowning, self.lead.crowning, self.lead.slope, self.lead.twist,
            )  # fmt: skip
        return found


def powers_with_slopes(numbers: Array, tip_power: float) -> TipPower:
    """Powers of the tip reliefs that a pair has: the profile slope of a gear without one is straight."""
    amounts = numbers[0:4:2].tolist()
    if all(amounts):
        return tip_power
    driver, driven = (tip_power if amount else 1.0 for amount in amounts)
    return driver, driven


def end_reliefs(numbers: Array, pair: GearPair, tip_power: TipPower) -> tuple[EndRelief, EndRelief]:
    """The tip reliefs of driver and driven gear over their roll angles."""
    found = []
    amounts, lengths = numbers[0:4:2].tolist(), numbers[1:4:2].tolist()
    for member, amount, length, power in zip(MEMBERS, amounts, lengths, powers_of(tip_power), strict=True):
        end = pair.x_end if member == "driver" else pair.x_start
        start = end - length if member == "driver" else end + length
        if amount == 0.0:
            start = end - 0.5 * pair.path_length if member == "driver" else end + 0.5 * pair.path_length
        first, last = (float(pair.roll_angle(x, member)) for x in (start, end))
        found.append(EndRelief(amount, first, last, power))
    return found[0], found[1]


def within_tolerances(trials: FlankTrials, pair: GearPair, numbers: Array, tolerance: FlankTolerance) -> Array:
    """Nine numbers inside their tolerances that leave most under each load, shape (L, 9).

    Amounts and lengths of both tip reliefs are at the ends of their tolerances and in their middle, each with each; so
    are then the amounts over the face with the tips that leave most, and the tips once more with these. What is not
    ground is not off, but for profile slopes where only tips are ground.

    Parameters
    ----------
    trials : FlankTrials
        By whose roll positions the worst is chosen; their tip reliefs have `powers_with_slopes` where only tips are
        ground.
    pair : GearPair
    numbers : ndarray, shape (9,)
        Nominal.
    tolerance : FlankTolerance
    """
    return _worst(_left_by(trials, numbers), trials, pair, numbers, tolerance)


def _left_by(trials: FlankTrials, numbers: Array) -> Callable[[Array], Array]:
    """What nine numbers about those given leave under each load, shape (L,) [m]."""
    tries = Tries(trials, np.abs(numbers))
    tries.of(numbers)
    return lambda one: tries.of(one).peak_to_peak[0]


def unrelieved_within(trials: FlankTrials, pair: GearPair, numbers: Array, tolerance: FlankTolerance) -> Array:
    """Nine numbers of flanks without relief that leave most under each load, shape (L, 9).

    What relief is compared with within its tolerances: each amount that it has is off by its tolerance from zero, to
    either side; of tip reliefs the profile slope, straight over the path of contact.

    Parameters
    ----------
    trials, pair, tolerance
        As in `within_tolerances`; tip reliefs of the trials are straight lines.
    numbers : ndarray, shape (9,)
        Of the relief, which say what is ground; where only tips are, both profile slopes are off.
    """
    off = np.where((numbers != 0.0) | _are_tips(tolerance), tolerance.amounts, 0.0)
    off[_CROWNING] = max(off[_CROWNING], off[_END])  # both have one tolerance
    off[_END] = 0.0
    of_each = [(0.0,) if size == 0.0 else (-size, size) for size in off.tolist()]
    both = np.array([np.zeros(len(NUMBERS)), *product(*of_each)])
    both[:, [1, 3]] = np.where(both[:, [0, 2]] != 0.0, pair.path_length, 0.0)
    left = np.stack([trials.of_numbers(one).peak_to_peak[0] for one in both])
    return np.asarray(both[left.argmax(axis=0)])


def _are_tips(tolerance: FlankTolerance) -> Array:
    """Which of nine numbers are amounts of tip reliefs that are off whether or not they are ground, shape (9,)."""
    found = np.zeros(len(NUMBERS), dtype=bool)
    found[[0, 2]] = tolerance.lead is None
    return found


def _worst(
    left: Callable[[Array], Array], trials: FlankTrials, pair: GearPair, numbers: Array, tolerance: FlankTolerance
) -> Array:
    """As `within_tolerances`; `left` says what nine numbers leave under each load, shape (L,) [m]."""
    tips, leads = _tips(trials, pair, numbers, tolerance), _leads(numbers, tolerance)
    worst = np.tile(numbers, (trials.loads.size, 1))
    for turn in range(_ROUNDS if len(leads) > 1 else 1):
        worst = _most(left, worst, tips, slice(0, _TIPS), alike=turn == 0)
        if len(leads) > 1:
            worst = _most(left, worst, leads, slice(_TIPS, None))
    return worst


def decisive_tolerances(
    trials: FlankTrials, pair: GearPair, numbers: Array, tolerance: FlankTolerance, most: Array
) -> tuple[Decisive | None, ...]:
    """Which tolerance, once halved, reduces what is left at most under each load; None where nothing is ground.

    Parameters
    ----------
    trials, pair, numbers, tolerance
        As in `within_tolerances`.
    most : ndarray, shape (L,)
        Largest peak-to-peak transmission error within all tolerances [m].
    """
    left = _left_by(trials, numbers)  # most combinations belong to several tolerances

    def worst(given: FlankTolerance) -> Array:
        return np.array([left(one)[i] for i, one in enumerate(_worst(left, trials, pair, numbers, given))])

    part = most / worst(tolerance)
    found: list[Decisive | None] = [None] * trials.loads.size
    for member, number, given, tighter in _halved(pair, numbers, trials.tip_power, tolerance):
        then = part * worst(tighter)
        for i, least in enumerate(found):
            if least is None or then[i] < least.most:
                found[i] = Decisive(member, number, float(then[i]), given)
    return tuple(found)


def _halved(
    pair: GearPair, numbers: Array, tip_power: TipPower, tolerance: FlankTolerance
) -> Iterator[tuple[Member, TipNumber | Literal["profile_slope"] | LeadNumber, float, FlankTolerance]]:
    """Whose tolerance of which number is halved, what it was [m], and all tolerances then."""
    for k, (member, tip) in enumerate(zip(MEMBERS, end_reliefs(numbers, pair, tip_power), strict=True)):
        one, gear = tolerance.tips[k], pair.gear(member)
        for number, given in zip(TIP_NUMBERS, (one.amount, one.length_of(gear, tip)), strict=True):
            bare = tip.amount == 0.0 and number == "amount" and tolerance.lead is None
            if given and (tip.amount or bare):
                tips = list(tolerance.tips)
                tips[k] = one.halved(number, gear, tip)
                yield member, "profile_slope" if bare else number, given, replace(tolerance, tips=(tips[0], tips[1]))
    lead = tolerance.lead
    if lead is None:
        return
    for name, at in _OF_LEAD.items():
        given = getattr(lead, name)
        if given and numbers[at].any():
            yield lead_bearer(pair), name, given, replace(tolerance, lead=replace(lead, **{name: HALVED * given}))


def _most(
    left: Callable[[Array], Array], worst: Array, choices: Array, where: slice, *, alike: bool = False
) -> Array:  # fmt: skip
    """Put the choice that leaves most under each load in place of some numbers; `alike`: all rows of `worst` are."""
    found = worst.copy()
    seen: Array | None = None
    for load, base in enumerate(worst):
        if seen is None or not alike:
            tried = np.tile(base, (len(choices), 1))
            tried[:, where] = choices
            seen = np.stack([left(one) for one in tried])
        found[load, where] = choices[int(seen[:, load].argmax())]
    return found


def _tips(trials: FlankTrials, pair: GearPair, numbers: Array, tolerance: FlankTolerance) -> Array:
    """Amounts and lengths of both tips, nominal and at the ends of their tolerances, shape (C, 4)."""
    each: list[list[tuple[float, float]]] = []
    ends = end_reliefs(numbers, pair, trials.tip_power)
    for member, tip, allowed in zip(MEMBERS, ends, tolerance.tips, strict=True):
        gear = pair.gear(member)
        off = [allowed.off(gear, tip, *by) for by in ((-1, -1), (-1, 1), (1, -1), (1, 1))] if tip.amount else []
        each.append([(one.amount, gear.base_radius * (one.end - one.start)) for one in (tip, *off)])
        if not tip.amount and allowed.amount and tolerance.lead is None:
            each[-1] += [(allowed.amount, pair.path_length), (-allowed.amount, pair.path_length)]
    # A number without a tolerance gives some of them twice.
    each = [list(dict.fromkeys(one)) for one in each]
    return np.array([[*driver, *driven] for driver, driven in product(*each)])


def _leads(numbers: Array, tolerance: FlankTolerance) -> Array:
    """Numbers over the face, nominal and at the ends of their tolerances, shape (C, 5)."""
    allowed = tolerance.amounts
    each = [
        (at,) if at == 0.0 or off == 0.0 else (at, at - off, at + off)
        for at, off in zip(numbers[_TIPS:].tolist(), allowed[_TIPS:].tolist(), strict=True)
    ]
    return np.array(list(product(*each)))
