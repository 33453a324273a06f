"""How two halves of opposite hand share a load: their torques add up, their axial forces balance or meet a stop.

The transmission error zeta is common to both halves. Where the driver's apex is at q from the driven's along the axis,
a half whose helix has the tangent t_k on the base cylinder feels the approach zeta + t_k q and carries the force W_k
that goes with it. With s = W_1 / W,

    h(s) = zeta_1(s W) - zeta_2((1 - s) W) = (t_1 - t_2) q,      W_1 t_1 + W_2 t_2 = F   while the member floats.

Approaches grow with their loads, so h grows with s, and any demand for q has one s: that of balanced axial forces
asks for the q that the halves' curves give; where that lies beyond the play, q is at the stop and s follows from h.
A half that h cannot reach carries nothing, and the other one carries all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.base.errors import ConvergenceError, InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: Steps within which a share is found; bisection alone would take some 50.
_MOST_STEPS = 80
#: Approaches are balanced up to this share of what one half carrying all and the other doing so differ by.
_BALANCED = 1e-12


class Half(Protocol):
    """One half of a double helical pair at P mesh positions."""

    @property
    def touch(self) -> Array:
        """Approach at which it first touches, shape (P, 1) or (P, L) [m]."""

    def under(self, load: Array) -> tuple[Array, Array]:
        """Approach [m] and dW / dzeta [N/m] under positive loads of its own [N], all of shape (P, L)."""


@dataclass(frozen=True, slots=True)
class AxialSeat:
    """How both members are held along the axis.

    Parameters
    ----------
    twist : (float, float)
        Tangent of the base helix angle of either half's driver, of opposite signs.
    offset : float
        Axial distance of the driver's apex from the driven's, the floating member in the middle of its play [m].
    room : float
        How far it can go to either side [m]: 0 for members that are both located, infinite for a free one.
    force : float
        W_1 t_1 + W_2 t_2 that balances what else pushes the floating member along its axis [N].
    """

    twist: tuple[float, float]
    offset: float = 0.0
    room: float = math.inf
    force: float = 0.0

    @property
    def span(self) -> float:
        """t_1 - t_2."""
        return self.twist[0] - self.twist[1]

    @property
    def stops(self) -> tuple[float, float]:
        """Lower and upper limit of h [m]."""
        low, high = sorted(self.span * (self.offset + end) for end in (-self.room, self.room))
        return low, high

    def free_share(self, total: Array) -> Array:
        """Share of the first half where nothing but the halves and `force` acts along the axis."""
        return np.asarray((self.force / total - self.twist[1]) / self.span)


@dataclass(frozen=True)
class Balance(ReadOnlyArrays):
    """How the halves share their load at P mesh positions under L loads; arrays of shape (P, L).

    Parameters
    ----------
    share : ndarray
        Of the first half.
    approach : ndarray
        Transmission error [m].
    position : ndarray
        q: axial distance of the driver's apex from the driven's [m].
    free : ndarray of bool
        Whether the floating member touches no stop.
    separation : ndarray, shape (2, P, L)
        Distance of the flanks of a half that carries nothing, 0 of one that does [m].
    stiffness : ndarray
        dW / dzeta with the contacts and the stop as they are [N/m].
    residual : ndarray
        By how much the approaches of two loaded halves differ from what q asks for [m].
    steps : int
    """

    share: Array
    approach: Array
    position: Array
    free: Mask
    separation: Array
    stiffness: Array
    residual: Array
    steps: int


def balance(first: Half, second: Half, load: ArrayLike, seat: AxialSeat) -> Balance:
    """Find shares, transmission error and axial position.

    Parameters
    ----------
    first, second : Half
    load : array_like, shape (L,)
        Of both together [N].
    seat : AxialSeat

    Returns
    -------
    Balance

    Raises
    ------
    InputError
        If a load is not positive, or pushes a free member off.
    ConvergenceError
        If approaches do not grow with their loads.
    """
    loads = np.atleast_1d(np.asarray(load, dtype=float))
    if not (np.isfinite(loads) & (loads > 0.0)).all():
        raise InputError("load", f"{loads.min()} N", "must be positive and finite")
    count = first.touch.shape[0]
    total = np.broadcast_to(loads, (count, loads.size))
    free = _free(seat, total)
    inside = (free > 0.0) & (free < 1.0)
    low, high = seat.stops
    if seat.room > 0.0:
        known = np.where(inside, free, 0.5)
        (one, k_one), (two, k_two) = first.under(known * total), second.under((1.0 - known) * total)
        wanted = np.where(inside, one - two, np.where(free < 0.5, -np.inf, np.inf))
        target = np.clip(wanted, low, high)
        floats = inside & (target == wanted)
        if floats.all():
            q = target / seat.span
            parts = (seat.twist[1] / seat.span) ** 2 / k_one + (seat.twist[0] / seat.span) ** 2 / k_two
            nothing = np.zeros_like(q)
            apart = np.zeros((2, *q.shape))
            return Balance(free, one - seat.twist[0] * q, q, floats, apart, 1.0 / parts, nothing, 1)
    else:
        target, floats = np.full(total.shape, low), np.zeros(total.shape, dtype=bool)
    return _stopped(first, second, total, seat, target, free, floats)


def _free(seat: AxialSeat, total: Array) -> Array:
    """Shares of balanced axial forces; a member without a stop must not be pushed off."""
    if seat.twist[0] * seat.twist[1] >= 0.0:
        raise InputError("hand", "equal in both halves", "must be opposite", "change the hand of one half")
    free = seat.free_share(total)
    if math.isinf(seat.room) and not ((free > 0.0) & (free < 1.0)).all():
        most = min(abs(one) for one in seat.twist) * float(total.min())
        raise InputError(
            "axial_force", f"{abs(seat.force):.6g} N", f"is not below {most:.6g} N, the axial force of one half "
            "that carries the whole load", "reduce it or specify axial_play",
        )  # fmt: skip
    return free


def _stopped(
    first: Half, second: Half, total: Array, seat: AxialSeat, target: Array, free: Array, floats: Mask
) -> Balance:
    """Shares where h is given; `floats` are those at which `free` is known to be the answer."""
    full_one, full_two = first.under(total), second.under(total)
    least, most = first.touch - full_two[0], full_one[0] - second.touch
    spread = most - least
    if not (spread > 0.0).all():
        raise ConvergenceError("The approach of a half does not increase with its load: check compliances and gaps.")
    alone = ~floats & (most <= target), ~floats & (least >= target)
    open_ = ~(floats | alone[0] | alone[1])
    share = np.where(floats, free, np.where(alone[0], 1.0, np.where(alone[1], 0.0, (target - least) / spread)))
    below, above = np.zeros_like(share), np.ones_like(share)
    steps, error, settled = 1, np.zeros_like(share), floats | alone[0] | alone[1]
    while True:
        tried = np.where((share > 0.0) & (share < 1.0), share, 0.5)
        (one, k_one), (two, k_two) = first.under(tried * total), second.under((1.0 - tried) * total)
        off = one - two - target
        error = np.where(settled, error, off)
        near = _BALANCED * spread + 4.0 * np.finfo(float).eps * (np.abs(one) + np.abs(two) + np.abs(target))
        settled = settled | (np.abs(off) <= near) | (above - below <= np.finfo(float).eps)
        steps += 1
        if settled.all():
            break
        if steps > _MOST_STEPS:
            raise ConvergenceError(
                f"The load sharing of the two halves was not found at {int((~settled).sum())} of {settled.size} mesh "
                "positions and loads: check compliances and gaps."
            )
        below = np.where(open_ & (off < 0.0), np.maximum(below, tried), below)
        above = np.where(open_ & (off > 0.0), np.minimum(above, tried), above)
        step = tried - off / (total * (1.0 / k_one + 1.0 / k_two))
        step = np.where((step > below) & (step < above), step, 0.5 * (below + above))
        share = np.where(settled, share, step)
    # What is settled has not moved since: the last approaches belong to it.
    one = np.where(alone[0], full_one[0], one)
    two = np.where(alone[1], full_two[0], two)
    q = np.where(floats, one - two, target) / seat.span
    approach = np.where(alone[1], two - seat.twist[1] * q, one - seat.twist[0] * q)
    apart = np.stack([
        np.where(alone[1], first.touch - (approach + seat.twist[0] * q), 0.0),
        np.where(alone[0], second.touch - (approach + seat.twist[1] * q), 0.0),
    ])  # fmt: skip
    parts = (seat.twist[1] / seat.span) ** 2 / k_one + (seat.twist[0] / seat.span) ** 2 / k_two
    stiffness = np.where(
        floats, 1.0 / parts, np.where(alone[0], full_one[1], np.where(alone[1], full_two[1], k_one + k_two))
    )
    return Balance(share, approach, q, floats, apart, stiffness, np.where(open_, np.abs(error), 0.0), steps)
