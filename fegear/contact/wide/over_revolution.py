"""A pair with a width of whose gears some teeth differ, over all base pitches until the same teeth mesh again.

As of plane teeth (`fegear.contact.plane.over_revolution`): base pitches in which the same teeth meet are solved once.
What all teeth have in common is found once for all of them (`compliance`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.contact.between_positions import between_positions, folded, worth_a_look
from fegear.contact.plane.over_revolution import MOST_PITCHES, Beyond, OverRevolution
from fegear.contact.wide.compliance import like_cycle
from fegear.contact.wide.flanks import as_specified, open_gaps
from fegear.contact.wide.lines import contact_lines
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.tip_edges import usual_gap
from fegear.contact.wide.transmission_error import secant_stiffness
from fegear.fem.alike_teeth import together
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.contact.odd_flank import OddFlank
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.lines import ContactLines
    from fegear.fem.solid.flank_body import FlankBody

#: Roll positions over a base pitch.
POSITIONS = 32
#: How often contact lines may be continued farther along tip edges that turn out to be loaded.
_LONGER_EDGES = 4
#: Rounds of looking for extreme values between positions.
_ROUNDS = 3
#: New positions are whole multiples of this share of a base pitch, so that no last digit changes them.
_SNAP = 1e-6
#: A residual below this share of the largest transmission error is round-off.
_ROUND_OFF = 1e-9
#: Panels are so many times longer than over one base pitch, unless their number is given: what they leave open of loads
#: of whole teeth is stated with them.
_OVER_ALL = 2.0
#: By how much panels are longer that show what theirs leave open.
_LONGER = 1.5
#: What is taken for an error of what these and coarser gears change: beside a missing tooth, where tip edges carry all,
#: values were off by up to 1.7 times as much, the transmission error of one cracked pair by 2.25 times (random pairs).
_OF_CHANGES = 1.5


@dataclass(frozen=True)
class RevolvingFlanks:
    """A pair with a width whose teeth may differ, ready to be followed.

    Parameters
    ----------
    flanks : FlankPair
    gaps : FlankGaps
    coarse : mapping of {"driver", "driven"} to FlankBody, or None
        Coarser solutions of the gears, which show their error; None where none is estimated.
    load : float
        Along the transverse line of action [N].
    """

    flanks: FlankPair
    gaps: FlankGaps
    coarse: Mapping[Member, FlankBody] | None
    load: float

    @property
    def pair(self) -> GearPair:
        """Both gears in mesh."""
        return self.flanks.pair

    @property
    def cycles(self) -> int:
        """Base pitches until the same teeth meet again; 1 where all teeth are alike."""
        periods = [self.flanks.gears[member].period for member in MEMBERS]
        for member, spacing, odd in zip(MEMBERS, *_of_teeth(self.gaps), strict=True):
            if spacing.size or odd:
                periods.append(self.pair.gear(member).teeth)
        return math.lcm(*periods)


def revolving_flanks(
    spec: PairSpec,
    fine: Mapping[Member, FlankBody],
    coarse: Mapping[Member, FlankBody] | None,
    cache: SolutionCache | None = None,
    positions: int = POSITIONS,
) -> RevolvingFlanks:
    """Make a pair ready to be followed over all base pitches.

    Parameters
    ----------
    spec : PairSpec
    fine, coarse : mapping of {"driver", "driven"} to FlankBody
    cache : SolutionCache, optional
        Of compliances.
    positions : int
        Over a base pitch.
    """
    most_gap = usual_gap(spec.placed, spec.nominal) if spec.corner_contact else 0.0
    panel = spec.panel if spec.face.panels else _OVER_ALL * spec.panel
    bare = FlankPair(
        spec.placed, fine, panel=panel, positions=positions, most_gap=most_gap,
        cache=SolutionCache() if cache is None else cache,
    )  # fmt: skip
    return RevolvingFlanks(as_specified(spec, bare), open_gaps(spec), coarse, spec.nominal)


@dataclass(frozen=True)
class FollowedFlanks:
    """A pair with a width that was followed over all base pitches.

    Parameters
    ----------
    over : OverRevolution
    revolving : RevolvingFlanks
        What was followed.
    flanks : FlankPair
        As they were loaded.
    pitches : tuple of ndarray of int
        Numbers of the base pitches in which the same teeth meet.
    parts : tuple of (ContactLines, tuple of ndarray, shape (P, M))
        Lines of some of the roll positions, and forces on their stations in these base pitches [N].
    reaches_the_last_edges : bool
        Whether tip edges are loaded that are as far off as any.
    """

    over: OverRevolution
    revolving: RevolvingFlanks
    flanks: FlankPair
    pitches: tuple[Index, ...]
    parts: tuple[tuple[ContactLines, tuple[Array, ...]], ...]
    reaches_the_last_edges: bool = False

    @property
    def cycles(self) -> int:
        """Base pitches until the same teeth meet again; 1 where all teeth are alike."""
        return self.revolving.cycles

    def at(self, roll: Array) -> FollowedFlanks:
        """The same at other roll positions, shape (P,) [m]."""
        return self._again(self.flanks, roll)

    def less_exactly(self, roll: Array) -> tuple[FollowedFlanks, ...]:
        """On longer panels, and with coarser gears, at some roll positions [m]; none where gears state no errors."""
        if self.revolving.coarse is None:
            return ()
        longer = replace(self.flanks, panel=_LONGER * self.flanks.panel)
        return self._again(longer, roll), self._again(replace(self.flanks, gears=self.revolving.coarse), roll)

    def _again(self, flanks: FlankPair, roll: Array) -> FollowedFlanks:
        return _followed(self.revolving, flanks, self.over.transmission_error.shape[0], roll, self)


def wide_over_revolution(
    revolving: RevolvingFlanks, base_pitches: int = 1, progress: Callable[[float], None] | None = None
) -> OverRevolution:
    """What `follow_flanks` finds of transmission error, stiffness and loads."""
    return follow_flanks(revolving, base_pitches, progress).over


def follow_flanks(
    revolving: RevolvingFlanks, base_pitches: int = 1, progress: Callable[[float], None] | None = None
) -> FollowedFlanks:
    """Follow a pair with a width over all base pitches until the same teeth mesh again.

    Parameters
    ----------
    revolving : RevolvingFlanks
    base_pitches : int
        How many there are where all teeth are alike.
    progress : callable, optional
        Receives the fraction that is done.

    Raises
    ------
    InputError
        If the same teeth meet again after more than `MOST_PITCHES` base pitches only, or no pair is left in contact.
    """
    cycles = revolving.cycles
    if cycles > MOST_PITCHES:
        raise InputError(
            "pair", f"{cycles} base pitches until the same teeth mesh again",
            f"must be at most {MOST_PITCHES} for a revolution", "specify different teeth on one gear only",
        )  # fmt: skip
    count, report = cycles if cycles > 1 else base_pitches, progress or (lambda _fraction: None)
    found = _with_peaks(_far_enough(revolving, count))
    report(0.5)
    if revolving.coarse is None:
        return found
    others = tuple(one.over for one in found.less_exactly(found.over.x))
    over = replace(found.over, others=others, of_changes=_OF_CHANGES)
    return replace(found, over=over)


def _with_peaks(found: FollowedFlanks) -> FollowedFlanks:
    """The same with the roll positions between them at which extreme values are likely, and what is left of these."""
    count, pitch = found.over.transmission_error.shape[0], found.over.pitch
    for turn in range(_ROUNDS + 1):
        over = found.over
        along, period = over.along.ravel(), count * pitch
        every = (-over.stiffness, over.transmission_error, np.abs(over.residual))
        likely = [between_positions(along, curve.ravel(), period, pitch) for curve in every]
        likely = [folded(*one, float(over.x[0]), pitch) for one in likely]
        likely.append(between_positions(over.x, -np.median(over.stiffness, axis=0), pitch, pitch))
        if over.largest_residual < _ROUND_OFF * over.largest_error:
            likely[2] = likely[2][0], np.zeros_like(likely[2][1])
        new = np.unique(np.round(worth_a_look(over.x, likely, pitch) / (_SNAP * pitch))) * _SNAP * pitch
        if turn == _ROUNDS or not new.size:
            break
        found = _joined(found, found.at(new))
    stiffness, error, residual, ordinary = (max(float(height.max()), 0.0) for _, height in likely)
    return replace(found, over=replace(found.over, beyond=Beyond(stiffness, ordinary, error, residual)))


def _joined(one: FollowedFlanks, other: FollowedFlanks) -> FollowedFlanks:
    """What was found at some roll positions and at others, together."""
    x = np.concatenate([one.over.x, other.over.x])
    order = np.argsort(x, kind="stable")
    error, stiffness, loads, tangent = (
        np.concatenate([getattr(part.over, name) for part in (one, other)], axis=-1)[..., order]
        for name in ("transmission_error", "stiffness", "loads", "tangent")
    )
    over = replace(
        one.over, x=x[order], transmission_error=error, stiffness=stiffness, loads=loads, tangent=tangent
    )  # fmt: skip
    reached = one.reaches_the_last_edges or other.reaches_the_last_edges
    return replace(one, over=over, parts=(*one.parts, *other.parts), reaches_the_last_edges=reached)


def _far_enough(revolving: RevolvingFlanks, count: int) -> FollowedFlanks:
    """The pair over all base pitches, along tip edges as far as these carry load."""
    flanks = revolving.flanks
    for left in range(_LONGER_EDGES, -1, -1):
        try:
            found = _followed(revolving, flanks, count, flanks.roll)
        except InputError as error:  # beside a missing tooth the edges of the next ones carry all of the load
            if error.key != "odd_tooth" or not flanks.most_gap or not left:
                raise
        else:
            if not (found.reaches_the_last_edges and left):
                break
        flanks = replace(flanks, most_gap=2.0 * flanks.most_gap)
    return found


def _followed(
    revolving: RevolvingFlanks, flanks: FlankPair, count: int, roll: Array, like: FollowedFlanks | None = None
) -> FollowedFlanks:
    """The pair over all base pitches at some roll positions; those `like` others are for the pairs of these."""
    pair, gaps, load = revolving.pair, revolving.gaps, revolving.load
    panel = flanks.panel * pair.driver.module
    lines = contact_lines(pair, roll, panel, most_gap=flanks.most_gap, missing=flanks.missing)
    if like is None:
        number = np.unique(lines.pair[lines.present])
        pitches = tuple(together(_teeth_in(flanks, gaps, lines, number, cycle) for cycle in range(count)))
    else:
        number, pitches = like.over.number, like.pitches
    shape = count, roll.size
    error, stiffness, tangent = (np.empty(shape) for _ in range(3))
    loads, forces, reached = np.zeros((count, number.size, roll.size)), [], False
    for alike in pitches:
        first = int(alike[0])
        known = flanks.compliance(load, roll, first)
        state = flanks.solve([load], replace(gaps, base_pitch=first), known)
        error[alike], tangent[alike] = state.transmission_error[:, 0], state.contact.stiffness[:, 0]
        stiffness[alike] = secant_stiffness(state.known, state.contact.force)[:, 0]
        rows = np.searchsorted(number, state.pair_numbers)
        loads[alike[:, None], rows] = state.pair_load[:, :, 0]
        forces.append(state.contact.force[:, :, 0])
        reached |= state.reaches_the_last_edges
    found = OverRevolution(
        roll, pair.base_pitch, load, pair.driver.base_radius, number, error, stiffness, loads, len(pitches), tangent
    )
    return FollowedFlanks(found, revolving, flanks, pitches, ((lines, tuple(forces)),), reached)


def _of_teeth(gaps: FlankGaps) -> tuple[tuple[Array, Array], tuple[tuple[tuple[int, OddFlank], ...], ...]]:
    """Spacing errors of both gears, and their odd flanks."""
    return (gaps.driver_spacing, gaps.driven_spacing), (gaps.driver_odd, gaps.driven_odd)


def _teeth_in(flanks: FlankPair, gaps: FlankGaps, lines: ContactLines, number: Index, cycle: int) -> tuple[object, ...]:
    """What tells the teeth in a base pitch from those in others."""
    orders = cycle - number
    flank: list[object] = []
    for member, spacing, odd in zip(MEMBERS, *_of_teeth(gaps), strict=True):
        known = {order for order, _ in odd}
        z = flanks.pair.gear(member).teeth
        flank += [order % z if order % z in known else -1 for order in orders.tolist()] if known else []
        flank += spacing[np.mod(orders, spacing.size)].tolist() if spacing.size else []
    return (like_cycle(flanks.gears, lines, cycle), *flank)
