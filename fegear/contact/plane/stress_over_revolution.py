"""Root stress of every tooth of a gear over all base pitches until the same teeth mesh again, and its errors.

Each tooth is followed on its whole way through the mesh. Its largest stress stands where another pair comes to bear or
lets go, between roll positions, at a place that only the loads know: it is looked for there (`with_peaks`), in the
plane as over the face. Errors are estimated at the positions at which the teeth have their largest stress.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.contact.between_positions import between_positions, folded, worth_a_look
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.compliance import RootStressInfluence, Side
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.over_revolution import refuse_too_many
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.tooth_stress import stress_with_error
from fegear.fem.alike_teeth import together
from fegear.geometry.pair import Member

#: Rounds of looking for largest values between positions.
_ROUNDS = 3
#: Share of a tooth's largest stress below which what may stand between positions is stated and not looked for.
_WORTH = 2e-4
#: New positions are whole multiples of this share of a base pitch, so that no last digit changes them.
_SNAP = 1e-6


@dataclass(frozen=True)
class StressOfTeeth:
    """Root stress of every tooth of a gear over all base pitches until the same teeth mesh again.

    Parameters
    ----------
    member : {"driver", "driven"}
    side : {"tension", "compression"}
    x : ndarray, shape (P,)
        Roll positions in a base pitch [m].
    pitch : float
        Base pitch [m].
    number : ndarray of int, shape (n,)
        Of the pairs, ascending.
    tooth : ndarray of int, shape (C, n)
        Number of the tooth, 0 to min(z, C) - 1: where fewer base pitches pass than the gear has teeth, these are all
        alike, and tooth C finds what tooth 0 found.
    stress : ndarray, shape (C, n, P)
        Largest tension, or most negative compression, of its fillet [Pa].
    teeth : int
        min(z, C).
    beyond : ndarray, shape (min(z, C),), optional
        By how much the largest may lie beyond those at the roll positions, between these [Pa].
    off : ndarray, shape (min(z, C),), optional
        Estimated error of the largest by those of gears and contacts [Pa].
    """

    member: Member
    side: Side
    x: Array
    pitch: float
    number: Index
    tooth: Index
    stress: Array
    teeth: int
    beyond: Array | None = None
    off: Array | None = None

    @property
    def sign(self) -> float:
        """1 for tension, -1 for compression."""
        return 1.0 if self.side == "tension" else -1.0

    @property
    def largest(self) -> Array:
        """Of each tooth on its way through the mesh, shape (min(z, C),) [Pa]."""
        return self.sign * self.of_each(self.sign * self.stress)

    @property
    def largest_error(self) -> Array | None:
        """Estimated error of these, shape (min(z, C),) [Pa]; None where gears state none."""
        if self.off is None:
            return None
        return np.asarray(self.off + (0.0 if self.beyond is None else self.beyond))

    def of_each(self, values: Array) -> Array:
        """Largest of values as of `stress` for each tooth, shape (min(z, C),)."""
        found = np.full(self.teeth, -np.inf)
        np.maximum.at(found, self.tooth, values.max(axis=2))
        return found

    def on_their_way(self) -> tuple[Array, Array, Index]:
        """Curves of the teeth on their way through the mesh, those that are the same once.

        Returns
        -------
        way : ndarray, shape (n P,)
            Position of the tooth's contact [m].
        curves : ndarray, shape (U, n P)
            Tension, or compression with its sign changed [Pa].
        of_tooth : ndarray of int, shape (C, 2)
            Number of a tooth and its curve, on each way.
        """
        count, rows = self.stress.shape[0], np.arange(self.number.size)
        cycle = np.mod(np.arange(count)[:, None] + self.number, count)  # that a tooth has on each pair
        every = self.sign * self.stress[cycle, rows].reshape(count, -1)
        known: dict[bytes, int] = {}
        which = [known.setdefault(one.tobytes(), len(known)) for one in every]
        _, first = np.unique(which, return_index=True)
        of_tooth = np.stack([self.tooth[cycle[:, 0], 0], which], axis=1)
        return (self.x + self.pitch * self.number[:, None]).ravel(), every[first], of_tooth

    def only(self, x: Array) -> StressOfTeeth:
        """At some of its roll positions, ascending [m]."""
        kept = np.isin(self.x, x)
        return replace(self, x=self.x[kept], stress=self.stress[:, :, kept])

    def joined(self, other: StressOfTeeth) -> StressOfTeeth:
        """With what was found at other roll positions."""
        x = np.concatenate([self.x, other.x])
        order = np.argsort(x, kind="stable")
        return replace(self, x=x[order], stress=np.concatenate([self.stress, other.stress], axis=2)[:, :, order])


def with_peaks(found: StressOfTeeth, at: Callable[[Array], StressOfTeeth]) -> StressOfTeeth:
    """The same with the roll positions between them at which a tooth's largest stress is likely, and what is left.

    Parameters
    ----------
    found : StressOfTeeth
    at : callable
        The same at other roll positions.
    """
    for turn in range(_ROUNDS + 1):
        way, curves, of_tooth = found.on_their_way()
        start, pitch, period = float(found.x[0]), found.pitch, found.number.size * found.pitch
        likely = [between_positions(way, curve, period, pitch) for curve in curves]
        worth = [
            folded(places, np.where(height > _WORTH * curve.max(), height, -1.0), start, pitch)
            for curve, (places, height) in zip(curves, likely, strict=True)
        ]
        new = np.unique(np.round(worth_a_look(found.x, worth, pitch) / (_SNAP * pitch))) * _SNAP * pitch
        if turn == _ROUNDS or not new.size:
            break
        found = found.joined(at(new))
    left, beyond = np.array([max(float(height.max()), 0.0) for _, height in likely]), np.zeros(found.teeth)
    np.maximum.at(beyond, of_tooth[:, 0], left[of_tooth[:, 1]])
    return replace(found, beyond=beyond)


def peak_positions(found: StressOfTeeth) -> Array:
    """Roll positions at which teeth have their largest stress, ascending [m]."""
    _, curves, _ = found.on_their_way()
    return np.unique(found.x[curves.argmax(axis=1) % found.x.size])


def off_of_largest(found: StressOfTeeth, error: Array) -> Array:
    """What errors of stress, shape (C, n, P), make of the largest of each tooth, shape (min(z, C),) [Pa]."""
    stress = found.sign * found.stress
    return found.of_each(stress + error) - found.of_each(stress)


def stress_over_revolution(
    engagement: Engagement,
    load: float,
    member: Member,
    side: Side = "tension",
    positions: int = 200,
    source: RootStressInfluence | None = None,
    shifted: Sequence[Engagement] = (),
) -> StressOfTeeth:
    """Root stress of every tooth of a gear by its own load and its neighbours', tooth after tooth.

    Parameters
    ----------
    engagement : Engagement
    load : float
        [N].
    member : {"driver", "driven"}
    side : {"tension", "compression"}
    positions : int
        Even steps over a base pitch; more stand on either side of every jump, and where teeth have their largest
        stress.
    source : RootStressInfluence, optional
        Where this gear's root stress comes from; by default where its compliance does.
    shifted : sequence of Engagement
        The same with one compliance each off by its estimated error, which errors are estimated by.

    Raises
    ------
    InputError
        If the source knows no root stress, or there are too many base pitches.
    """
    refuse_too_many(engagement)
    teeth = _Teeth(engagement, load, member, side, source)
    x = roll_positions(engagement, positions)
    found = with_peaks(teeth.at(x), teeth.at)
    return replace(found, off=teeth.off(peak_positions(found), shifted)) if shifted else found


@dataclass(frozen=True)
class _Teeth:
    """Of which gear, and under which load, root stress is asked for; see `stress_over_revolution`."""

    engagement: Engagement
    load: float
    member: Member
    side: Side
    source: RootStressInfluence | None

    def at(self, x: Array) -> StressOfTeeth:
        """Root stress at roll positions [m]."""
        compliance, count = self.engagement.compliance, self.engagement.cycles
        rows, pitches = self._alike(x)
        stress = np.empty((count, rows.size, x.size))
        grid = self.engagement.grid(x)
        for alike in pitches:
            state = self.engagement.solve(grid, [self.load], int(alike[0]))
            history = root_stress_history(self.engagement, state, self.member, self.side, 1, self.source)
            stress[alike] = history.stress[:, :, 0]
        numbered = min(compliance.pair.gear(self.member).teeth, count)
        tooth = np.array([[compliance.tooth(self.member, int(row), cycle) for row in rows] for cycle in range(count)])
        pitch = compliance.pair.base_pitch
        return StressOfTeeth(self.member, self.side, x, pitch, rows, tooth % numbered, stress, numbered)

    def off(self, x: Array, shifted: Sequence[Engagement]) -> Array | None:
        """Estimated error of each tooth's largest stress, at one of these positions [Pa]; None where unknown."""
        found, pair = self.at(x), self.engagement.pair
        error, grid = np.empty(found.stress.shape), self.engagement.grid(x)
        for alike in self._alike(x)[1]:
            first = int(alike[0])
            state = self.engagement.solve(grid, [self.load], first)
            others = [other.solve(other.grid(x), [self.load], first) for other in shifted]
            apart = independent_errors(state, shifted, (pair.x_start, pair.x_end)).load
            _, each = stress_with_error(self.engagement, state, others, apart, self.member, self.side, self.source)
            error[alike] = each[:, :, 0]
        return None if np.isnan(error).any() else off_of_largest(found, error)

    def _alike(self, x: Array) -> tuple[Index, list[Index]]:
        """Numbers of the pairs whose teeth are followed, and the base pitches that are like each other."""
        compliance, number = self.engagement.compliance, self.engagement.grid(x).contacts.number
        known = self.source or compliance.source(self.member)
        rows = np.arange(int(number[0]) - 1, int(number[-1]) + 2)
        reach = known.reach if compliance.coupling else 0

        def teeth_and_fillets(cycle: int) -> tuple[object, ...]:
            ends = [compliance.tooth(self.member, int(row), cycle) for row in (rows[0], rows[-1])]
            fillets = known.same_as(min(ends) - reach, rows.size + 2 * reach)
            return (*self.engagement.teeth_in(number, cycle), fillets)

        return rows, list(together(teeth_and_fillets(cycle) for cycle in range(self.engagement.cycles)))
