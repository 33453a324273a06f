"""Root stress of one tooth of a gear on its way through the mesh, its neighbours' loads and its error included."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, first_of_largest
from fegear.base.shown import shown, shows
from fegear.contact.plane.compliance import RootStressInfluence, Side
from fegear.contact.plane.engagement import Engagement, Loaded, solve_again
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.peaks import refined_peaks
from fegear.contact.plane.root_stress import RootStress
from fegear.contact.plane.root_stress_history import RootStressHistory, root_stress_history
from fegear.geometry.pair import Member

#: Both fillets of a tooth, and the sign of the stress that is looked for.
#: Of the largest stress along a fillet that another tooth's load has, at least so much counts at the place of the
#: tooth's own largest: where it passes through zero there, the place itself moves with the loads.
_OF_LARGEST = 0.15
_FILLETS: Final[tuple[tuple[Side, float], ...]] = (("tension", 1.0), ("compression", -1.0))


class LargestBetween(NamedTuple):
    """Largest root stresses at more positions than a table has, under each load; arrays of shape (L,).

    Attributes
    ----------
    tension, compression : ndarray
        Largest and most negative [Pa].
    tension_x, tension_z, compression_x : ndarray
        Position of the tooth's contact, and the place along the face [m].
    tension_error, compression_error : ndarray
        Estimated, with what the positions leave open [Pa]; NaN where the source does not know it.
    least_tension, least_left : ndarray
        Where the tension is least, and what the positions leave open of it [Pa].
    """

    tension: Array
    compression: Array
    tension_x: Array
    tension_z: Array
    compression_x: Array
    tension_error: Array
    compression_error: Array
    least_tension: Array
    least_left: Array


@dataclass(frozen=True)
class ToothStress:
    """Largest root stresses of one tooth while its pair passes through the mesh; arrays of shape (P, L).

    Parameters
    ----------
    x : ndarray, shape (P,)
        Position of the tooth's contact [m].
    tension : ndarray
        Largest below the loaded flank [Pa]; NaN where a formula gives none, over which extremes are not taken.
    compression : ndarray or None
        Most negative of the other fillet [Pa]; None where the source knows none, as the formulas.
    tension_error : ndarray
        Estimated [Pa]; NaN where the source does not know its own.
    compression_error : ndarray or None
        As `tension_error`; None where the source knows no compression.
    between : LargestBetween or None
        Largest values at more positions; None where these are enough.
    """

    x: Array = shown("mm", "position of the tooth's contact on the line of action")
    tension: Array = shown(
        "MPa",
        "root stress, tension side: maximum tangential stress in the fillet of the loaded flank",
        name="stress",
        label="maximum root stress",
    )
    compression: Array | None = shown("MPa", "root stress, compression side: minimum stress in the opposite fillet")
    tension_error: Array = shown("MPa", "estimated error of stress", name="stress_error")
    compression_error: Array | None = shown("MPa", "estimated error of compression")
    between: LargestBetween | None = None

    @property
    def knows_error(self) -> bool:
        """Whether its error is estimated everywhere."""
        return not np.isnan(self.tension_error).any()

    def worst(self, i: int) -> int:
        """Position of the largest tension under load number i."""
        return int(first_of_largest(_or_least(self.tension[:, i])))

    def error(self, i: int) -> float | None:
        """Estimated error of the largest tension under load number i [Pa]; None where the source does not know it."""
        return _known(self._tension_off(i))

    def _tension_off(self, i: int) -> float:
        between = self.between
        return float(self.tension_error[self.worst(i), i] if between is None else between.tension_error[i])

    def largest_pressed(self, i: int) -> int | None:
        """Position of the most negative compression under load number i; None where the source knows none."""
        return None if self.compression is None else int(first_of_largest(-self.compression[:, i]))

    def compression_off(self, i: int) -> float | None:
        """Estimated error of the most negative compression under load number i [Pa]; None if it is not known."""
        at = self.largest_pressed(i)
        if at is None or self.compression_error is None:
            return None
        return _known(self.compression_error[at, i] if self.between is None else self.between.compression_error[i])

    def range_off(self, i: int) -> float | None:
        """Estimated error of the range of stress under load number i [Pa]: those of both its ends together."""
        least = int(np.argmin(np.where(np.isnan(self.tension[:, i]), np.inf, self.tension[:, i])))
        error = self.tension_error[least, i]
        error = error if self.between is None else np.hypot(error, self.between.least_left[i])
        return _known(self._tension_off(i) + error)

    def x_of_tension(self, i: int) -> float:
        """Position of the tooth's contact under the largest tension of load number i [m]."""
        return float(self.x[self.worst(i)] if self.between is None else self.between.tension_x[i])

    def x_of_compression(self, i: int) -> float | None:
        """The same under the most negative compression [m]; None where the source knows none."""
        at = self.largest_pressed(i)
        if at is None:
            return None
        return float(self.x[at] if self.between is None else self.between.compression_x[i])

    @property
    @shows("MPa", "of the mesh cycle", name="largest_root_tension")
    def largest_tension(self) -> Array:
        """Under each load, shape (L,) [Pa]."""
        return np.asarray(np.fmax.reduce(self.tension, axis=0) if self.between is None else self.between.tension)

    @property
    @shows("MPa", "of the mesh cycle", name="largest_root_compression")
    def largest_compression(self) -> Array | None:
        """Most negative under each load, shape (L,) [Pa]; None where the source knows none."""
        if self.between is not None:
            return self.between.compression
        return None if self.compression is None else np.asarray(self.compression.min(axis=0))

    @property
    @shows(
        "MPa",
        "stress range in the fillet of the loaded flank over the time in mesh (over a revolution, from unloaded: at "
        "least the maximum root stress)",
        name="root_stress_range",
    )
    def tension_range(self) -> Array:
        """Under each load, shape (L,) [Pa].

        Over the history, whose first and last positions still have loads on neighbouring teeth: a tooth far from the
        mesh has no stress, so that the range over a revolution is that from zero or from compression.
        """
        between = self.between
        least = np.fmin.reduce(self.tension, axis=0) if between is None else between.least_tension
        return np.asarray(self.largest_tension - least)


def _or_least(stress: Array) -> Array:
    """The same with nothing lower than what is not known."""
    return np.where(np.isnan(stress), -np.inf, stress)


def _known(error: float) -> float | None:
    return None if np.isnan(error) else float(error)


class LoadedStates(NamedTuple):
    """States that the teeth of both gears pass through.

    Attributes
    ----------
    rows : list of Loaded
        Of each tooth, from the one before the first pair that can touch to the one after the last: the same state
        unless teeth differ by their spacing errors.
    shifted : list of list of Loaded
        The same with one compliance each off by its error.
    apart : list of ndarray, shape (n, P, L)
        What the errors of single tooth pairs change in the loads of the state [N] (`independent_errors`).
    """

    rows: list[Loaded]
    shifted: list[list[Loaded]]
    apart: list[Array]


def loaded_states(
    e: Engagement, shifted: Sequence[Engagement], loads: Sequence[float], x: ArrayLike, tooth: int = 0
) -> LoadedStates:
    """Share loads for a base pitch before and after a tooth's contact, once for both gears.

    Parameters
    ----------
    e : Engagement
    shifted : sequence of Engagement
        The same with one compliance each off by its error.
    loads : sequence of float, shape (L,)
        Along the line of action [N].
    x : array_like, shape (P,)
        Roll positions over one base pitch [m].
    tooth : int
        Which tooth of either gear is followed, in the order of meshing, where teeth differ.
    """
    grid = e.grid(x)
    teeth = grid.contacts.number.size + 2
    path = e.pair.x_start, e.pair.x_end

    def apart(state: Loaded) -> Array:
        return independent_errors(state, shifted, path).load if shifted else np.zeros_like(state.loads)

    if not e.uneven:
        state = e.solve(grid, loads)
        again = [solve_again(other, state) for other in shifted]
        return LoadedStates([state] * teeth, [again] * teeth, [apart(state)] * teeth)
    # The tooth of interest carries pair number j in base pitch number j.
    first = int(grid.contacts.number[0]) - 1 + tooth
    rows = [e.solve(grid, loads, first + row) for row in range(teeth)]
    each = [[solve_again(other, state) for other in shifted] for state in rows]
    return LoadedStates(rows, each, [apart(state) for state in rows])


def alike_states(state: Loaded) -> LoadedStates:
    """What `loaded_states` returns of gears whose teeth are alike, of one state and without its errors."""
    teeth = state.grid.contacts.number.size + 2
    return LoadedStates([state] * teeth, [[]] * teeth, [np.zeros_like(state.loads)] * teeth)


def with_peaks(e: Engagement, load: float, x: Array, sources: Mapping[Member, Sequence[RootStressInfluence]]) -> Array:
    """Roll positions and, in addition, those where a tooth's root stress is largest, ascending [m].

    As many for every state: peaks of two curves at one kink stay two positions, which round-off could tell apart.

    Parameters
    ----------
    e : Engagement
    load : float
        [N].
    x : ndarray, shape (P,)
        Over one base pitch, with both sides of every jump, ascending [m].
    sources : mapping of member to sequence of RootStressInfluence
        Of root stress.
    """
    wanted = [
        (member, source, side, sign)
        for member, several in sources.items()
        for source in several
        for side, sign in _FILLETS
        if _knows(e, member, source, side)
    ]

    def curves(at: Array) -> Array:
        rows = loaded_states(e, (), [load], at).rows
        alike = all(state is rows[0] for state in rows)
        found = []
        for member, source, side, sign in wanted:
            stress = [
                root_stress_history(e, state, member, side, 1, source).stress for state in (rows[:1] if alike else rows)
            ]
            teeth = stress[0] if alike else np.stack([one[row] for row, one in enumerate(stress)])
            found.append(np.fmax.reduce(sign * teeth[:, :, 0], axis=0))
        return np.array(found)

    return np.sort(np.concatenate([x, refined_peaks(curves, x)[0]]))


def _knows(e: Engagement, member: Member, source: RootStressInfluence, side: Side) -> bool:
    """Whether a source knows the stress of a fillet; formulas know that of the tension fillet alone."""
    roots = RootStress.of(e.compliance, member, side, source)
    if roots.curve(0) is not None:  # finite elements need not be asked for a stress
        return True
    ends = np.array([e.pair.radius(end, member) for end in (e.pair.x_start, e.pair.x_end)])
    return roots.row(0, 0, ends) is not None


def tooth_stress(
    e: Engagement,
    states: LoadedStates,
    member: Member,
    source: RootStressInfluence | None = None,
    *,
    estimates: bool = True,
) -> ToothStress:
    """Follow one tooth of a gear from a base pitch before its contact to one after it.

    Parameters
    ----------
    e : Engagement
    states : LoadedStates
        Of this engagement.
    member : {"driver", "driven"}
    source : RootStressInfluence, optional
        Where the gear's root stress comes from; by default where its compliance does, which must be finite elements.
    estimates : bool
        Whether the error is estimated; else it is not known.

    Raises
    ------
    InputError
        If the source knows no root stress.
    """
    knows_both = _knows(e, member, source or e.compliance.source(member), "compression")
    sides: tuple[Side, ...] = ("tension", "compression") if knows_both else ("tension",)
    known: dict[int, list[Array]] = {}
    parts: list[list[Array]] = []
    for row, (state, shifted, apart) in enumerate(zip(*states, strict=True)):
        if id(state) not in known:
            histories = [
                stress_with_error(e, state, shifted, apart, member, side, source, _within(e), estimates=estimates)
                for side in sides
            ]
            known[id(state)] = [histories[0][0].x, *(a for one, off in histories for a in (one.stress, off))]
        parts.append([values[row] for values in known[id(state)]])
    x, *stresses = (np.concatenate(one) for one in zip(*parts, strict=True))
    order = np.argsort(x)
    low, high = _within(e)
    order = order[(x[order] > low) & (x[order] < high)]
    tension, error, *other = (one[order] for one in stresses)
    if getattr(source, "silent", False):  # a formula that holds nowhere: nothing is known of an unloaded tooth either
        tension = np.full_like(tension, np.nan)
    compression, pressed_error = other or (None, None)
    return ToothStress(x[order], tension, compression, error, pressed_error)


def _within(e: Engagement) -> tuple[float, float]:
    """From a base pitch before the path of contact to one after it [m]."""
    pitch = e.pair.base_pitch
    return e.pair.x_start - pitch, e.pair.x_end + pitch


def stress_with_error(
    e: Engagement,
    state: Loaded,
    shifted: Sequence[Loaded],
    apart: Array,
    member: Member,
    side: Side,
    source: RootStressInfluence | None = None,
    within: tuple[float, float] | None = None,
    *,
    estimates: bool = True,
) -> tuple[RootStressHistory, Array]:
    """Stress of one fillet in every row of a state, and its estimated error, shape (n + 2, P, L) [Pa].

    Parameters
    ----------
    e : Engagement
    state : Loaded
    shifted : sequence of Loaded
        The same with one compliance each off by its error.
    apart : ndarray, shape (n, P, L)
        What the errors of single tooth pairs change in the loads of the state [N] (`independent_errors`).
    member, side, source, within
        See `root_stress_history`; NaN where x is outside.
    estimates : bool
        Whether the error is estimated; else it is not known.
    """
    found = root_stress_history(e, state, member, side, 1, source, within)
    if not estimates:
        return found, np.full_like(found.stress, np.nan)
    off = np.zeros_like(found.stress)
    for again in shifted:
        off += np.abs(root_stress_history(e, again, member, side, 1, source, within).stress - found.stress)
    by_load, by_source = _by_each_load(e, found, state, apart, source)
    return found, np.hypot(np.maximum(off, by_load), by_source)


def _by_each_load(
    e: Engagement, found: RootStressHistory, state: Loaded, apart: Array, source: RootStressInfluence | None
) -> tuple[Array, Array]:
    """Errors of the stress of each tooth by that of every load that it feels, shape (n + 2, P, L) each [Pa].

    A tooth that carries next to nothing is stressed by its neighbours' loads; the sum may pass through zero where its
    parts, and their errors, do not. What another load changes of the largest stress is, to first order, what a unit of
    it has at the place of the largest: elsewhere along the fillet it may have many times as much of the other sign.

    Parameters
    ----------
    found : RootStressHistory
        Where along its fillet each tooth's stress is largest.
    apart : ndarray, shape (n, P, L)
        Errors of the loads that pairs have by themselves [N].

    Returns
    -------
    by_load, by_source : ndarray
        Root of the sum of squares of what errors of the loads change, and of what the source leaves in the stress per
        load; not a number where it does not know its own error.
    """
    member, place = found.member, found.place
    roots, contacts = RootStress.of(e.compliance, member, found.side, source), state.grid.contacts
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    few = np.linspace(radius.min(), radius.max(), 9)
    n, face = radius.shape[0], e.compliance.face_width
    reach = min(roots.reach, n + 1)
    numbers = [e.compliance.tooth(member, int(contacts.number[0]) + row, state.cycle) for row in range(-1, n + 1)]
    known: dict[int, dict[int, _Sizes]] = {}
    by_load, by_source = (np.zeros((n + 2, *state.loads.shape[1:])) for _ in range(2))
    for row, tooth in enumerate(numbers):
        for other, loaded in enumerate(numbers[1:-1]):
            like = roots.source.same_as(loaded - reach, 2 * reach + 1)
            if like not in known:
                known[like] = _sizes(roots, loaded, reach, few)
            if tooth - loaded in known[like]:
                sizes = known[like][tooth - loaded]
                size = np.interp(radius[other], few, sizes.largest)[:, None]
                if tooth != loaded and place is not None:
                    there = _interpolated(roots.at_place(tooth, sizes.row, place[row].ravel()), few, radius[other])
                    size = np.maximum(np.abs(there), _OF_LARGEST * size)
                by_load[row] += (apart[other] * (size / face)) ** 2
                left = np.interp(radius[other], few, sizes.error)[:, None]
                by_source[row] += (state.loads[other] * (left / face)) ** 2
    return np.sqrt(by_load), np.sqrt(by_source)


class _Sizes(NamedTuple):
    """Stress along a fillet per unit line load at F radii, shape (F, points), its largest, and that one's error."""

    row: Array
    largest: Array
    error: Array


def _sizes(roots: RootStress, loaded: int, reach: int, few: Array) -> dict[int, _Sizes]:
    """Those of the teeth that feel a load on one tooth, by how far they are from it."""
    found: dict[int, _Sizes] = {}
    for k in sorted(range(-reach, reach + 1), key=abs):
        row = roots.row(loaded + k, loaded, few)
        if row is not None:
            # a tooth's own below the contact: at it stress is what the contact itself leaves
            size = np.abs(roots.largest(loaded, row, few) if k == 0 else row).reshape(few.size, -1).max(axis=1)
            found[k] = _Sizes(row, size, roots.error(loaded + k, loaded, few))
    return found


def _interpolated(values: Array, few: Array, radius: Array) -> Array:
    """Values of P positions under each of L loads at a few radii, (P L, F), at the radius of each position: (P, L)."""
    below = np.clip(np.searchsorted(few, radius) - 1, 0, few.size - 2)
    share = (radius - few[below]) / (few[below + 1] - few[below])
    each = values.reshape(radius.size, -1, few.size)
    low, high = (np.take_along_axis(each, at[:, None, None], axis=2)[..., 0] for at in (below, below + 1))
    return low + share[:, None] * (high - low)
