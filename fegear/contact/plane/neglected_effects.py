"""What a neglected effect would change: load sharing at a few roll positions, with it and without it.

The estimate takes the contact problem itself, not a formula for it: the same teeth and loads, one effect more, at under
a hundred roll positions instead of the thousands of a run, without quadrature and without error estimates. It is exact
where it looks, and it looks on either side of every jump and follows the largest changes between its positions. The
largest root tension has a place of its own with each effect, which is searched for, too: two maxima over the same
positions would differ by what both miss.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.effects import (
    CORNER_CONTACT,
    EFFECTS,
    HERTZ,
    NEIGHBOUR_COUPLING,
    PLANE_EFFECTS,
    ROOT_EFFECTS,
    SPACING_ERRORS,
)
from fegear.base.errors import InputError
from fegear.base.tally import note
from fegear.contact.loaded_teeth import Answer, Change, Neglected
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.flanks import as_specified, relieved, spaced
from fegear.contact.plane.peaks import refined_peaks
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.geometry.pair import MEMBERS

#: Roll positions spread over the base pitch.
_SPREAD = 32
#: Changes are large where contacts begin a little sooner or later, over less than the distance of two positions: how
#: far a sample may be below the largest whose neighbourhood is looked at, how many are, and how closely.
_NARROW = (1.0, 6, 2)
#: Distances from a jump at which both sides of it are looked at [base pitches]: corners take over within hundredths.
_BESIDE = (1e-7, *(float(d) for d in np.geomspace(1e-3, 6e-2, 13)))

#: The kernel that counts effects whose size is estimated; what an estimate runs counts as what it is.
COUNTED = "neglected effects"


#: Whether an effect changes nothing in an engagement that has it.
_IDLE: dict[str, Callable[[Engagement], bool]] = {
    CORNER_CONTACT.name: lambda e: not any(corner.exists for corner in e.meshing.corners),
    NEIGHBOUR_COUPLING.name: lambda e: all(source.reach == 0 for source in e.compliance.both),
    HERTZ.name: lambda e: all(
        e.compliance.contact_slope(member) <= 0.0 and e.compliance.power(member) <= 0.0 for member in MEMBERS
    ),
}


def effects_off(spec: PairSpec, known: Sequence[str]) -> list[str]:
    """Effects that are off, and contacts whose stiffness is assumed to be that under the nominal load."""
    found = [effect for effect in known if getattr(spec, effect) != EFFECTS[effect].on]
    return sorted(found, key=spec.is_on)  # those that are on in part come last


def with_effect(spec: PairSpec, engagement: Engagement, effect: str) -> Engagement | None:
    """The engagement with one effect more; None where there is nothing that it could change.

    Raises
    ------
    InputError
        If the data of the effect are wrong.
    """
    for flank in spec.both:
        if effect in flank.wrong:
            raise flank.wrong[effect]
    if not spec.has_data(effect):
        return None
    more = spec.with_effect(effect)
    other = as_specified(more, engagement)
    if effect in _IDLE and _IDLE[effect](other):
        return None
    if more.spacing_errors and not spec.spacing_errors:
        other = spaced(more, other)
    # An amount of relief that counts in deflections changes with them.
    again = more.relief and (not spec.relief or any(flank.wants_delta for flank in spec.both))
    return relieved(more, other) if again else other


def neglected_effects(
    spec: PairSpec, engagement: Engagement, answers: Sequence[Answer], loads: Sequence[float]
) -> Neglected:
    """What each effect of load sharing that is off would change.

    Parameters
    ----------
    spec : PairSpec
    engagement : Engagement
        Made of it.
    answers : sequence of str
        What is looked at.
    loads : sequence of float
        [N].
    """
    if not answers:
        return Neglected()
    others: dict[str, Engagement] = {}
    wrong: dict[str, InputError] = {}
    on_roots = ROOT_EFFECTS if "root tension" in answers else ()
    for effect in effects_off(spec, (*PLANE_EFFECTS, *on_roots)):
        try:
            other = with_effect(spec, engagement, effect)
        except InputError as error:  # data that nothing uses may be wrong: the run goes on without its size
            wrong[effect] = error
            continue
        if other is not None:
            others[effect] = other
    if not others:
        return Neglected({}, wrong)
    note(COUNTED, len(others))
    cycle = _uneven(others[SPACING_ERRORS.name]) if SPACING_ERRORS.name in others else 0
    return Neglected(changes(engagement, others, loads, answers, cycle), wrong)


def _uneven(engagement: Engagement) -> int:
    """The base pitch in which the pair that comes into contact has the largest spacing error."""
    sizes = [errors.size for errors in (engagement.driver_spacing, engagement.driven_spacing) if errors.size]
    cycles = np.arange(max(sizes))
    total = np.zeros(cycles.size)
    for errors in (engagement.driver_spacing, engagement.driven_spacing):
        if errors.size:
            total += errors[cycles % errors.size]
    return int(np.argmax(np.abs(total - np.median(total))))


def few_positions(engagements: Sequence[Engagement]) -> Array:
    """Roll positions [m] over one base pitch, and beside every jump and kink of any of the engagements, shape (P,)."""
    first = engagements[0]
    start, pitch = first.pair.x_start, first.pair.base_pitch
    spread = start + pitch * (np.arange(_SPREAD) + 0.5) / _SPREAD
    breaks = {b for engagement in engagements for b in engagement.breaks}
    beside = [b + side * d * pitch for b in breaks for d in _BESIDE for side in (-1.0, 1.0)]
    return np.unique(np.concatenate([spread, first.meshing.reduced(beside)]))


def corners_bear(engagement: Engagement, load: float) -> bool:
    """Whether a tip corner carries load anywhere under a load [N], in any of the base pitches of spacing errors."""
    if not engagement.corner_contact:
        return False
    grid = engagement.grid(few_positions([engagement]))
    return any(bool(engagement.solve(grid, [load], cycle).corner_bears.any()) for cycle in range(engagement.cycles))


def changes(
    engagement: Engagement,
    others: Mapping[str, Engagement],
    loads: ArrayLike,
    answers: Sequence[Answer],
    cycle: int = 0,
) -> dict[str, tuple[Change, ...]]:
    """What other sets of effects change, each on its own.

    Parameters
    ----------
    engagement : Engagement
        As it is computed.
    others : mapping of str to Engagement
        The same gears with one effect more, by its name.
    loads : array_like, shape (L,)
        [N]; each answer is given for the load at which its share is largest.
    answers : sequence of str
        What is looked at. Root tension needs finite-element compliances.
    cycle : int
        Which teeth meet, with spacing errors.

    Returns
    -------
    dict of str to tuple of Change
    """
    x, w = few_positions([engagement, *others.values()]), np.atleast_1d(np.asarray(loads, dtype=float))
    before = engagement.solve(engagement.grid(x), w, cycle)
    scales: dict[Answer, Array] = {
        "transmission error": before.transmission_error.mean(axis=0), "load on a tooth pair": w,
    }  # fmt: skip
    if "root tension" in answers and others:
        scales["root tension"] = _largest_tensions(engagement, x, w, cycle)
    found = {}
    for name, other in others.items():
        parts: dict[Answer, Change] = {}
        for answer in answers:
            if answer == "root tension":
                grown = _largest_tensions(other, x, w, cycle) - scales[answer]
                parts[answer] = _worst(answer, grown, scales[answer], w, np.full(w.size, np.nan))
            else:
                difference = partial(_DIFFERENCES[answer], partial(_states, (other, engagement), w, cycle, x))
                at, _ = refined_peaks(partial(_sizes, difference), x, *_NARROW)
                parts[answer] = _worst(answer, np.diagonal(difference(at)), scales[answer], w, at)
        found[name] = tuple(parts[answer] for answer in answers)
    return found


def _worst(answer: Answer, differences: Array, scales: Array, loads: Array, x: Array) -> Change:
    """Pick the load, of L, at which a difference is the largest share of its scale."""
    i = int(np.argmax(np.abs(differences) / scales))
    return Change(answer, *(float(of[i]) for of in (differences, scales, loads, x)))


def _largest_tensions(engagement: Engagement, x: Array, loads: Array, cycle: int) -> Array:
    """Of the loaded teeth of both gears over the base pitch, shape (L,) [Pa]; x has both sides of every jump."""

    def curves(at: Array) -> Array:
        state = engagement.solve(engagement.grid(at, again=False), loads, cycle)
        both = [root_stress_history(engagement, state, member).stress.max(axis=0) for member in MEMBERS]
        return np.max(both, axis=0).T

    return refined_peaks(curves, x)[1]


def _sizes(difference: Callable[[Array], Array], x: Array) -> Array:
    """As curves over the positions, shape (L, P)."""
    return np.abs(difference(x)).T


def _states(engagements: tuple[Engagement, ...], loads: Array, cycle: int, samples: Array, x: Array) -> list[Loaded]:
    """Of each engagement at positions; those at the samples serve every answer and effect."""
    return [one.solve(one.grid(x, again=x is samples), loads, cycle) for one in engagements]


def _error_change(states: Callable[[Array], list[Loaded]], x: Array) -> Array:
    """Change of the transmission error, shape (P, L) [m]."""
    after, before = states(x)
    return np.asarray(after.transmission_error - before.transmission_error)


def _load_change(states: Callable[[Array], list[Loaded]], x: Array) -> Array:
    """Change of that pair's load which changes most, shape (P, L) [N]; pairs are matched by their place."""
    after, before = states(x)
    numbers = before.grid.contacts.number, after.grid.contacts.number
    first = min(n[0] for n in numbers)
    difference = np.zeros((int(max(n[-1] for n in numbers) - first) + 1, *before.loads.shape[1:]))
    for state, number, sign in ((after, numbers[1], 1.0), (before, numbers[0], -1.0)):
        difference[number - first] += sign * state.loads
    size = np.abs(difference)  # what one of two pairs gains the other loses: the last digit must not choose the sign
    row = np.argmax(size >= (1.0 - 1e-9) * size.max(axis=0), axis=0)
    return np.take_along_axis(difference, row[None], axis=0)[0]


_DIFFERENCES = {"transmission error": _error_change, "load on a tooth pair": _load_change}
