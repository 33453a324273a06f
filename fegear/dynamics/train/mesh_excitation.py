"""From a loaded gear pair to what its teeth do to the train: one-sided springs over the path of contact."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.neglected_effects import corners_bear
from fegear.contact.plane.roll_grids import RollGrid
from fegear.contact.plane.transmission_error import contact_changes
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.fem.alike_teeth import together

#: Accuracy of the fitted stiffness, separation and transmission error relative to their largest value.
FIT = 1e-9
#: The same where load sharing with coupled teeth is solved at every point.
FIT_SHARED = 1e-7
#: Pieces of the fit get no shorter than this, in base pitches (a corner that starts to bear has an infinite slope).
SHORTEST = 2e-4
#: This near to the ends of a base pitch [base pitches].
_INSIDE = 1e-9


def stands_alone(engagement: Engagement, load: float) -> bool:
    """Whether every tooth pair is a spring of its own, the same one: no neighbours, no corner under the load."""
    compliance = engagement.compliance
    odd = compliance.cycles > 1 or engagement.odd is not None
    return not (compliance.coupling or odd or corners_bear(engagement, load))


def mesh_excitation(engagement: Engagement, load: float) -> MeshExcitation:
    """One-sided springs of a gear pair.

    Tooth pairs that stand alone are springs over the whole path; their contact deflection is linear about the full load
    on one pair, as in NASA TM-89901. Where teeth are coupled, or a tip corner bears under the mean load, every pair is
    linear about what it carries of the mean load, with its own local stiffness dW_j/dzeta. With spacing errors, or
    teeth that differ, every tooth pair that meets has its own separation (and local stiffness), until the same teeth
    meet again.

    Parameters
    ----------
    engagement : Engagement
    load : float
        Mean mesh force [N].
    """
    if not stands_alone(engagement, load):
        return _shared(engagement, load)
    return _uneven(_separate(replace(engagement, corner_contact=False), load), engagement)


def _uneven(even: MeshExcitation, engagement: Engagement) -> MeshExcitation:
    """Add the spacing errors of the teeth to their separations: slot j is on teeth p - j in base pitch p."""
    cycles = engagement.cycles
    if cycles == 1:
        return even

    def error(tooth: int) -> float:
        spacings = (engagement.driver_spacing, engagement.driven_spacing)
        return sum(float(errors[tooth % errors.size]) for errors in spacings if errors.size)

    slots = enumerate(even.separation, even.first_slot)
    uneven = (Periodic.joined([m.plus(error(p - j)) for p in range(cycles)]) for j, m in slots)
    return replace(even, separation=tuple(uneven))


def _row_of(engagement: Engagement, x: Array) -> tuple[RollGrid, NDArray[np.intp]]:
    """The grid at the roll positions that belong to places of one tooth pair, and the pair's row there."""
    pair = engagement.pair
    number = np.clip(np.floor((x - pair.x_start) / pair.base_pitch), 0, None)
    grid = engagement.grid(x - number * pair.base_pitch)
    row = np.rint((x - grid.contacts.x[0]) / pair.base_pitch).astype(np.intp)
    return grid, np.clip(row, 0, grid.contacts.x.shape[0] - 1)


def _separate(engagement: Engagement, load: float) -> MeshExcitation:
    pair, pitch = engagement.pair, engagement.pair.base_pitch

    def stiffness(x: Array) -> Array:
        grid, row = _row_of(engagement, np.asarray(x, dtype=float))
        own = np.arange(x.size)
        full = np.full((*grid.contacts.x.shape, 1), load)
        return np.asarray(1.0 / grid.matrices.at_load(full)[row, row, own, 0])

    def separation(x: Array) -> Array:
        grid, row = _row_of(engagement, np.asarray(x, dtype=float))
        return np.asarray(engagement.modification(grid.contacts)[row, np.arange(x.size)])

    places = [b + k * pitch for b in engagement.breaks for k in range(-2, math.ceil(pair.contact_ratio) + 2)]
    breaks = [b for b in places if pair.x_start < b < pair.x_end]
    return MeshExcitation.from_tooth_pair(
        stiffness, separation, pair.x_start, pair.x_end, pitch, breaks=breaks, tolerance=FIT
    )


def _shared(engagement: Engagement, load: float) -> MeshExcitation:
    """Springs about the mean load, from load sharing with coupled teeth and corners, base pitch by base pitch.

    Base pitches with teeth that answer and stand alike are fitted once.
    """
    # Corners bear before the start and after the end of the path: a slot more on either side.
    pair, extra = engagement.pair, 1 if engagement.corner_contact else 0
    first = math.floor(pair.x_start / pair.base_pitch) - extra
    last = math.ceil(pair.x_end / pair.base_pitch) - 1 + extra
    grids: dict[bytes, RollGrid] = {}
    pairs = engagement.grid([pair.x_start]).contacts.number
    known: dict[object, tuple[list[Periodic], list[Periodic]]] = {}
    pitches = []
    for p in range(engagement.cycles):
        of = tuple(engagement.teeth_in(pairs, cycle) for cycle in _cycles_of(engagement, p))
        if of not in known:
            known[of] = _one_pitch(engagement, load, p, range(first, last + 1), grids)
        pitches.append(known[of])
    stiffness, separation = (
        tuple(Periodic.joined(parts) for parts in zip(*one, strict=True)) for one in zip(*pitches, strict=True)
    )
    return MeshExcitation.about_load(stiffness, separation, first)


def _cycles_of(engagement: Engagement, number: int) -> tuple[int, ...]:
    """Base pitches of load sharing in which base pitch `number` from the pitch point lies.

    Load sharing counts its own from the start of contact, so that they are two.
    """
    if engagement.cycles == 1:
        return (number,)
    ends = np.array([_INSIDE, 1.0 - _INSIDE]) * engagement.pair.base_pitch
    before = np.rint((engagement.meshing.reduced(ends) - ends) / engagement.pair.base_pitch)
    return tuple(sorted({number - int(n) for n in before}))


def _one_pitch(
    engagement: Engagement, load: float, number: int, slots: range, grids: dict[bytes, RollGrid]
) -> tuple[list[Periodic], list[Periodic]]:
    """Local stiffness and separation of the tooth pairs in the slots over base pitch `number` from the pitch point.

    `grids` keeps contacts and compliances, which are the same in every base pitch with like teeth.
    """
    pitch = engagement.pair.base_pitch
    cycles = _cycles_of(engagement, number)
    changes = [*engagement.breaks, *(x for cycle in cycles for x in contact_changes(engagement, load, cycle))]
    cuts = sorted({(b / pitch) % 1.0 for b in changes})
    known: dict[bytes, tuple[Array, Array]] = {}

    def solved(s: Array) -> tuple[Array, Array]:
        """K_Sj [N/m] and zeta - W_j / K_Sj [m] of every slot, each of shape (slots, s)."""
        key = s.tobytes()
        if key not in known:
            solve_at_once([s])
        return known[key]

    def before(s: Array) -> int:
        """Base pitches that load sharing counts less; one call is about one piece between breaks."""
        if engagement.cycles == 1:
            return 0
        x = s * pitch
        return round(float(np.mean(engagement.meshing.reduced(x) - x)) / pitch)

    def solve_at_once(places: list[Array]) -> None:
        """`solved` of many pieces, which costs little more than one."""
        new = [s for s in places if s.tobytes() not in known]
        for pieces in together(map(before, new)):
            these = [new[piece] for piece in pieces]
            every = np.concatenate(these)
            key = every.tobytes()
            grid = grids.get(key) or engagement.grid(every * pitch, again=False)
            if engagement.cycles > 1:
                grids[key] = grid
            state = engagement.solve(grid, [load], number - before(these[0]))
            ends = np.cumsum([s.size for s in these])[:-1]
            found = (np.split(one, ends, axis=1) for one in _by_slot(state, every, slots, pitch))
            known.update((s.tobytes(), pair) for s, pair in zip(these, zip(*found, strict=True), strict=True))

    def fit(quantity: int, slot: int, scale: float) -> Periodic:
        return Periodic.fit(
            lambda s: solved(s)[quantity][slot], cuts, tolerance=FIT_SHARED, shortest=SHORTEST, scale=scale,
            ahead=solve_at_once,
        )  # fmt: skip

    # Of perfect flanks that deflect in proportion to their load no separation is left but round-off.
    few = [np.array([s]) for s in (np.arange(8) + 0.5) / 8]
    solve_at_once(few)
    deflection = float(np.max([load / solved(s)[0].sum() for s in few]))
    count = range(len(slots))
    return [fit(0, slot, 0.0) for slot in count], [fit(1, slot, deflection) for slot in count]


def _by_slot(state: Loaded, s: Array, slots: range, pitch: float) -> tuple[Array, Array]:
    """Local stiffness and separation of the pairs of a state in the order of the slots, (slots, positions) each.

    Raises
    ------
    RangeError
        If a pair carries less as the gears approach: no spring does.
    """
    tangent, loads, error = state.pair_tangent[:, :, 0], state.loads[:, :, 0], state.transmission_error[:, 0]
    if np.any(tangent[loads > 0.0] <= 0.0):
        raise RangeError(
            "compliance", "a coupled tooth pair", "has a negative tangent stiffness",
            "switch neighbour_coupling off, or increase the rim thickness",
        )  # fmt: skip
    apart = error - np.divide(loads, tangent, out=np.zeros_like(loads), where=loads > 0.0)
    own = np.arange(s.size)
    stiffness, separation = np.zeros((len(slots), s.size)), np.tile(error, (len(slots), 1))
    for index, j in enumerate(slots):
        row = np.rint(s + j - state.pair_x[0] / pitch).astype(np.intp)
        inside = (row >= 0) & (row < loads.shape[0])
        at = row[inside], own[inside]
        stiffness[index, inside], separation[index, inside] = tangent[at], apart[at]
    return stiffness, separation


def tooth_pair_at(excitation: MeshExcitation, x: Array, base_pitch: float, number: int = 0) -> tuple[Array, Array]:
    """Stiffness [N/m] and separation [m] of a tooth pair at its places x [m]; number 0 is at the pitch point first."""
    s = np.asarray(x, dtype=float) / base_pitch
    slot = np.floor(s).astype(int)
    k, m = np.zeros(s.shape), np.zeros(s.shape)
    for j in np.unique(slot):
        index = int(j) - excitation.first_slot
        if 0 <= index < len(excitation.stiffness):
            at = slot == j
            k[at] = excitation.stiffness[index](s[at] + number)
            m[at] = excitation.separation[index](s[at] + number)
    return k, m
