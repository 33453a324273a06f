"""A pair of whose gears some teeth differ, over all base pitches until the same teeth mesh again.

Base pitches in which the teeth answer alike are solved once: of a gear with one odd tooth those in which it or a tooth
beside it can touch, and one for all the others. `revolution` has the lines of the same transmission error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Index, distinct
from fegear.base.errors import InputError
from fegear.contact.error_over_pitch import secant_start
from fegear.contact.plane.base_pitch import BESIDE, roll_positions, secant_stiffness
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.transmission_error import contact_changes
from fegear.fem.alike_teeth import together

#: Base pitches that are looked at at most: hunting teeth of two odd gears meet after the product of their numbers.
MOST_PITCHES = 20_000
#: Part of an odd tooth's estimated error that ordinary teeth do not share: a shallow crack's loss of stiffness was off
#: by 0.19 of the error of the stiffness (random cracks).
_OWN_PART = 0.2
#: How far beside a change of contact curves are looked at: at the jump, farther than errors of compliances move it, and
#: where the stiffness of a pair that has just come to bear still rises steeply [base pitches].
_BESIDE_CHANGES = (BESIDE, 2e-4, 2e-3)
#: How near to each other rows are the same one, but for both sides of a jump, and changes of contact [base pitches].
_SAME, _SAME_CHANGE = 5e-5, 4.0 * BESIDE


@dataclass(frozen=True)
class Beyond:
    """By how much extreme values may lie beyond those at the roll positions, between these.

    Parameters
    ----------
    stiffness, ordinary_stiffness : float
        Lowest, of all and of an ordinary base pitch [N/m].
    transmission_error, residual : float
        Largest [m].
    """

    stiffness: float = 0.0
    ordinary_stiffness: float = 0.0
    transmission_error: float = 0.0
    residual: float = 0.0


@dataclass(frozen=True)
class OverRevolution:
    """A loaded pair over C base pitches, P roll positions in each, under one load.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Roll positions in a base pitch [m]; in base pitch c they are farther by c times `pitch`.
    pitch : float
        Base pitch [m].
    load : float
        [N].
    driver_base_radius : float
        [m].
    number : ndarray of int, shape (n,)
        Of the pairs, as of `Contacts`.
    transmission_error : ndarray, shape (C, P)
        [m].
    stiffness : ndarray, shape (C, P)
        Secant mesh stiffness (`secant_stiffness`) [N/m].
    loads : ndarray, shape (C, n, P)
        On each pair [N].
    solved : int
        How many base pitches differ from each other.
    tangent : ndarray, shape (C, P)
        Local mesh stiffness dF/dTE [N/m].
    others : tuple of OverRevolution
        The same with one compliance each off by its estimated error.
    beyond : Beyond
        What few roll positions leave open.
    of_changes : float
        What is taken for an error of what the others change.
    """

    x: Array
    pitch: float
    load: float
    driver_base_radius: float
    number: Index
    transmission_error: Array
    stiffness: Array
    loads: Array
    solved: int
    tangent: Array
    others: tuple[OverRevolution, ...] = ()
    beyond: Beyond = Beyond()
    of_changes: float = 1.0

    def shift(self, answer: Callable[[OverRevolution], ArrayLike]) -> Array:
        """Estimated error of an answer: what the compliances' errors change of it; NaN where they state none."""
        here = np.asarray(answer(self), dtype=float)
        if not self.others:
            return np.full_like(here, np.nan)
        changes = sum(np.abs(np.asarray(answer(other)) - here) for other in self.others)
        return np.asarray(self.of_changes * changes)

    @cached_property
    def transmission_error_error(self) -> Array:
        """Shape (C, P) [m]."""
        return self.shift(lambda one: one.transmission_error)

    @cached_property
    def stiffness_error(self) -> Array:
        """Shape (C, P) [N/m]; where compliances that are off move a jump past a position, that around it."""
        error = self.shift(lambda one: one.stiffness)
        passed = np.any(
            [((one.loads > 0.0) != (self.loads > 0.0)).any(axis=1) for one in self.others or (self,)], axis=0
        )
        for cycle in np.flatnonzero(passed.any(axis=1) & ~passed.all(axis=1)):
            at = passed[cycle]
            error[cycle, at] = np.interp(self.x[at], self.x[~at], error[cycle, ~at])
        return error

    @property
    def along(self) -> Array:
        """Roll positions over all base pitches, shape (C, P) [m]."""
        return np.asarray(self.x + self.pitch * np.arange(self.transmission_error.shape[0])[:, None])

    @property
    def residual(self) -> Array:
        """Transmission error less that of an ordinary base pitch, their median, shape (C, P) [m]."""
        return np.asarray(self.transmission_error - np.median(self.transmission_error, axis=0))

    def stiffness_at(self, driver_angle: ArrayLike, *, secant: bool = False) -> Array:
        """Mesh stiffness at rotations of the driver, for equations of motion.

        Parameters
        ----------
        driver_angle : array_like
            Zero with the first teeth at the pitch point [rad]; any number of turns.
        secant : bool
            Load over transmission error in place of the slope dF/dTE.

        Returns
        -------
        ndarray
            Periodic over all base pitches, straight between the roll positions [N/m].
        """
        return self._over_rotation(self.stiffness if secant else self.tangent, driver_angle)

    def error_at(self, driver_angle: ArrayLike) -> Array:
        """Transmission error under the load at rotations of the driver [m], as `stiffness_at`."""
        return self._over_rotation(self.transmission_error, driver_angle)

    def start_at(self, driver_angle: ArrayLike) -> Array:
        """Where the secant has no force at rotations of the driver [m], as `stiffness_at`."""
        stiffness = self.stiffness_at(driver_angle, secant=True)
        return secant_start(self.error_at(driver_angle), stiffness, self.load)

    def _over_rotation(self, values: Array, driver_angle: ArrayLike) -> Array:
        period = self.pitch * self.transmission_error.shape[0]
        x = np.asarray(driver_angle, dtype=float) * self.driver_base_radius
        along = self.along.ravel()
        ends = np.append(along, along[0] + period)
        return np.interp(np.mod(x - along[0], period) + along[0], ends, np.append(values, values.flat[0]))

    @property
    def lowest_stiffness(self) -> float:
        """[N/m]."""
        return float(self.stiffness.min())

    @property
    def lowest_stiffness_error(self) -> float:
        """Estimated [N/m]; at a jump of the stiffness that of the place beside it says nothing."""
        return float(self.shift(lambda one: one.lowest_stiffness)) + self.beyond.stiffness

    @property
    def ordinary_lowest_stiffness_error(self) -> float:
        """Estimated [N/m]."""
        return float(self.shift(lambda one: one.ordinary_lowest_stiffness)) + self.beyond.ordinary_stiffness

    @property
    def largest_error(self) -> float:
        """Largest transmission error [m]."""
        return float(self.transmission_error.max())

    @property
    def largest_error_error(self) -> float:
        """Estimated [m]."""
        at = int(np.argmax(self.transmission_error))
        return float(self.transmission_error_error.flat[at]) + self.beyond.transmission_error

    @property
    def ordinary_lowest_stiffness(self) -> float:
        """The lowest of an ordinary base pitch [N/m]."""
        return float(np.median(self.stiffness, axis=0).min())

    @property
    def stiffness_loss(self) -> float:
        """By how much the lowest stiffness is below that of an ordinary base pitch, as a share of it."""
        return 1.0 - self.lowest_stiffness / self.ordinary_lowest_stiffness

    @property
    def stiffness_loss_error(self) -> float:
        """Estimated, as a share of the ordinary lowest stiffness."""
        either = float(self.shift(lambda one: one.lowest_stiffness)) / self.ordinary_lowest_stiffness
        beyond = (self.beyond.stiffness + self.beyond.ordinary_stiffness) / self.ordinary_lowest_stiffness
        return self._of_difference(float(self.shift(lambda one: one.stiffness_loss)), either) + beyond

    @property
    def largest_residual(self) -> float:
        """[m]."""
        return float(np.abs(self.residual).max())

    @property
    def largest_residual_error(self) -> float:
        """Estimated [m]."""
        either = float(self.transmission_error_error.flat[int(np.argmax(np.abs(self.residual)))])
        return self._of_difference(float(self.shift(lambda one: one.largest_residual)), either) + self.beyond.residual

    def _of_difference(self, change: float, either: float) -> float:
        """Error of how odd and ordinary teeth differ: a part of the error of either is its own, not that of both."""
        return max(change, _OWN_PART * either) if self.solved > 1 else change


def over_revolution(
    engagement: Engagement,
    load: float,
    positions: int = 200,
    shifted: Sequence[Engagement] = (),
    base_pitches: int = 1,
) -> OverRevolution:
    """Follow a pair over all base pitches until the same teeth mesh again.

    Parameters
    ----------
    engagement : Engagement
    load : float
        [N].
    positions : int
        Even steps over a base pitch; more stand on either side of every jump.
    shifted : sequence of Engagement
        The same with one compliance each off by its estimated error.
    base_pitches : int
        How many there are where all teeth are alike.

    Raises
    ------
    InputError
        If the same teeth meet again after more than `MOST_PITCHES` base pitches only.
    """
    refuse_too_many(engagement)
    count = engagement.cycles if engagement.cycles > 1 else base_pitches
    x = _with_changes(engagement, load, roll_positions(engagement, positions), count)
    number = engagement.grid(x).contacts.number
    found, *others = (_followed(one, x, number, load, count) for one in (engagement, *shifted))
    return replace(found, others=tuple(others))


def _with_changes(engagement: Engagement, load: float, x: Array, count: int) -> Array:
    """Roll positions [m] and, in addition, both sides of those at which a pair comes to bear or lets go.

    Extremes of the curves are there: between even steps the lowest stiffness of a revolution would be missed. Those of
    every base pitch that differs from the others count.
    """
    pitch = engagement.pair.base_pitch
    alike = together(engagement.teeth_in(engagement.grid(x).contacts.number, cycle) for cycle in range(count))
    each = [contact_changes(engagement, load, int(pitches[0])) for pitches in alike]
    # base pitches without an odd tooth at a change have the same one
    changes = distinct(x[[0, -1]], *each, within=_SAME_CHANGE)[1:-1]
    sides = [changes[:, None] + pitch * away * np.array([-1.0, 1.0]) for away in _BESIDE_CHANGES]
    at_jumps, *beside = (one[(one > x[0]) & (one < x[-1])] for one in sides)
    rows = np.union1d(x, at_jumps)
    found = np.unique(np.concatenate([rows, *beside]))
    near = np.isin(found, rows) | np.append(True, np.diff(found) > _SAME * pitch)
    return found[near]


def _followed(engagement: Engagement, x: Array, number: Index, load: float, count: int) -> OverRevolution:
    (error, stiffness, loads, tangent), solved = _each_pitch(engagement, x, load, _curves, count)
    pair = engagement.pair
    return OverRevolution(
        x, pair.base_pitch, load, pair.driver.base_radius, number, error, stiffness, loads, solved, tangent
    )


def refuse_too_many(engagement: Engagement) -> None:
    """Refuse a pair whose same teeth meet again after more than `MOST_PITCHES` base pitches only."""
    if engagement.cycles > MOST_PITCHES:
        raise InputError(
            "pair", f"{engagement.cycles} base pitches until the same teeth mesh again",
            f"must be at most {MOST_PITCHES} for a revolution", "specify odd teeth of one gear only",
        )  # fmt: skip


def _curves(loaded: Loaded) -> tuple[Array, ...]:
    """Transmission error, secant stiffness, loads and tangent stiffness of a base pitch."""
    secant = secant_stiffness(loaded)[:, 0]
    return loaded.transmission_error[:, 0], secant, loaded.loads[:, :, 0], loaded.local_stiffness[:, 0]


def _each_pitch(
    engagement: Engagement, x: Array, load: float, of: Callable[[Loaded], tuple[Array, ...]], count: int
) -> tuple[list[Array], int]:
    """What is asked of every base pitch, shape (C, ...) each, and how many of them differ from each other."""
    grid = engagement.grid(x)
    alike = together(engagement.teeth_in(grid.contacts.number, cycle) for cycle in range(count))
    found: list[Array] = []
    for pitches in alike:
        each = of(engagement.solve(grid, [load], int(pitches[0])))
        found = found or [np.empty((count, *one.shape)) for one in each]
        for whole, one in zip(found, each, strict=True):
            whole[pitches] = one
    return found, len(alike)
