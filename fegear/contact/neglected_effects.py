"""What a neglected effect would change: load sharing at a few roll positions, with it and without it.

The estimate takes the contact problem itself, not a formula for it: the same teeth and loads, one effect more, at under
a hundred roll positions instead of the thousands of a run, without quadrature and without error estimates. It is exact
where it looks, and it looks on either side of every jump, where effects show most.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.contact.root_stress_history import root_stress_history
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.contact.engagement import Engagement, Loaded

Answer = Literal["transmission error", "load on a tooth pair", "root tension"]

#: Roll positions spread over the base pitch.
_SPREAD = 32
#: Distances from a jump at which both sides of it are looked at [base pitches]: corners take over within hundredths.
_BESIDE = (1e-7, *(float(d) for d in np.geomspace(1e-3, 6e-2, 13)))


@dataclass(frozen=True, slots=True)
class Change:
    """What one more effect does to one answer.

    Parameters
    ----------
    answer : str
        "transmission error", "load on a tooth pair" or "root tension".
    size : float
        Largest change over the base pitch [m, N or Pa], with its sign; for the root tension that of its largest value.
    scale : float
        What it is compared with: mean transmission error, total load, largest root tension.
    load : float
        Load at which its share is largest [N].
    x : float
        Roll position where it is largest [m]; nan for the root tension, whose largest value has a place of its own.
    """

    answer: Answer
    size: float
    scale: float
    load: float
    x: float

    @property
    def share(self) -> float:
        """Size over scale, positive."""
        return abs(self.size) / self.scale


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
    stress = _largest_tensions(engagement, before) if "root tension" in answers and others else np.zeros(w.size)
    found = {}
    for name, other in others.items():
        after = other.solve(other.grid(x), w, cycle)
        parts: dict[Answer, Change] = {}
        if "transmission error" in answers:
            difference = after.transmission_error - before.transmission_error
            parts["transmission error"] = _worst(
                "transmission error", difference, before.transmission_error.mean(axis=0), w, x
            )
        if "load on a tooth pair" in answers:
            parts["load on a tooth pair"] = _worst("load on a tooth pair", _load_changes(before, after), w, w, x)
        if "root tension" in answers:
            grown = _largest_tensions(other, after) - stress
            parts["root tension"] = _worst("root tension", grown[None], stress, w, np.array([np.nan]))
        found[name] = tuple(parts[answer] for answer in answers)
    return found


def _worst(answer: Answer, difference: Array, scale: Array, loads: Array, x: Array) -> Change:
    """Pick the load and the position at which a difference, shape (P, L), is the largest share of its scale."""
    p, i = np.unravel_index(int(np.argmax(np.abs(difference) / scale)), difference.shape)
    return Change(answer, float(difference[p, i]), float(scale[i]), float(loads[i]), float(x[p]))


def _largest_tensions(engagement: Engagement, state: Loaded) -> Array:
    """Of the loaded teeth of both gears, shape (L,) [Pa]."""
    return np.max([root_stress_history(engagement, state, member).largest for member in MEMBERS], axis=0)


def _load_changes(before: Loaded, after: Loaded) -> Array:
    """Change of that pair's load which changes most, shape (P, L) [N]; pairs are matched by their place."""
    numbers = before.grid.contacts.number, after.grid.contacts.number
    first = min(n[0] for n in numbers)
    difference = np.zeros((int(max(n[-1] for n in numbers) - first) + 1, *before.loads.shape[1:]))
    for state, number, sign in ((after, numbers[1], 1.0), (before, numbers[0], -1.0)):
        difference[number - first] += sign * state.loads
    row = np.argmax(np.abs(difference), axis=0)
    return np.take_along_axis(difference, row[None], axis=0)[0]
