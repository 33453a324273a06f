"""Teeth of a gear whose web has holes: each stands differently to them, and the mean over all is what pairs take.

Forces f on tooth t add -P(t + k) X P(t)' f to the motion of tooth t + k, with P and X of `holed_web`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.fem.plane.influence import Side

#: Waves of which no more is felt than this share of what is felt of others are no use.
_SMALL = 2e-5


@dataclass(frozen=True)
class HoledRing(ReadOnlyArrays):
    """How a ring with a holed web differs from one without holes, in real waves: cosines (m >= 0) and sines (m < 0).

    Parameters
    ----------
    follow : ndarray, shape (watch, N)
        P, of what is watched and loaded on tooth 0.
    lost : ndarray, shape (N, N)
        X.
    orders : ndarray of int, shape (N,)
        m of each wave.
    partner : ndarray of int, shape (N,)
        The sine of a cosine and the other way round.
    teeth, holes : int
    """

    follow: Array
    lost: Array
    orders: Index
    partner: Index
    teeth: int
    holes: int

    @property
    def different(self) -> int:
        """How many teeth in a row stand differently to the holes."""
        return self.teeth // math.gcd(self.teeth, self.holes)

    def turned(self, follow: Array, tooth: int) -> Array:
        """Rows of P for a tooth so many pitches clockwise, shape (..., N)."""
        angle = 2.0 * math.pi * tooth / self.teeth * self.orders
        return np.asarray(follow * np.cos(angle) - follow[..., self.partner] * np.sin(angle))

    def added_on_average(self, k: int, loaded: slice) -> Array:
        """What holes add on average to the motion of tooth k under unit forces on tooth 0, shape (watch, loaded)."""
        return np.asarray(-self.turned(self.follow, k) @ (self.mean @ self.follow[loaded].T))

    @cached_property
    def mean(self) -> Array:
        """X of which only what all teeth have in common is left."""
        # With c and s of order m, a = c - i s goes with exp(i m phi): only equal orders but for whole turns of a pitch.
        m, z, x, j = self.orders, self.teeth, self.lost, self.partner
        sign = np.where(m < 0, -1.0, 1.0)
        crossed = sign[:, None] * sign * x[np.ix_(j, j)]
        same = (np.abs(m)[:, None] - np.abs(m)) % z == 0
        opposite = (np.abs(m)[:, None] + np.abs(m)) % z == 0
        half = 0.5 * (same * (x + crossed) + opposite * (x - crossed))
        return np.where((m == 0)[:, None] | (m == 0), same * x, half)

    def without_small(self) -> HoledRing:
        """The same without waves that change nothing."""
        # Cosine and sine together: where the holes are turned, one becomes the other.
        taken, felt = np.abs(np.diagonal(self.lost)), np.abs(self.follow).max(axis=0)
        size = np.sqrt(taken + taken[self.partner]) * np.maximum(felt, felt[self.partner])
        kept = np.flatnonzero(size > _SMALL * size.max())
        place = np.full(size.size, -1)
        place[kept] = np.arange(kept.size)
        return replace(
            self, follow=self.follow[:, kept], lost=self.lost[np.ix_(kept, kept)], orders=self.orders[kept],
            partner=place[self.partner[kept]],
        )  # fmt: skip


@dataclass(frozen=True)
class HoledTeeth(ReadOnlyArrays):
    """What the teeth of a solid gear owe to the holes of its web.

    Parameters
    ----------
    ring : HoledRing
        Its rows are the ports of the flank, shape (n, N).
    moved : mapping of {"tension", "compression"} to ndarray, shape (nodes, 3, functions, N)
        The same of the fillets' nodes, in the axes of the tooth.
    """

    ring: HoledRing
    moved: Mapping[Side, Array]

    def flank_apart(self, k: int, tooth: int) -> Array:
        """Approach of tooth + k under forces on a tooth less the mean over all teeth, shape (n, n)."""
        return self._apart(self.ring.follow, k, tooth)

    def fillet_apart(self, k: int, tooth: int, side: Side) -> Array:
        """The same of the displacements of a fillet, shape (nodes, 3, functions, n)."""
        return self._apart(self.moved[side], k, tooth)

    def _apart(self, follow: Array, k: int, tooth: int) -> Array:
        ring = self.ring
        mean, own = ring.mean @ ring.follow.T, ring.lost @ ring.turned(ring.follow, tooth).T
        return np.asarray(ring.turned(follow, k) @ mean - ring.turned(follow, tooth + k) @ own)

    def apart(self, load: Array) -> tuple[Array, dict[Side, Array]]:
        """Each tooth that differs under a load of its own, shape (n,), less the mean over all teeth.

        Returns
        -------
        approach : ndarray, shape (T,)
            Of the load.
        moved : dict of side to ndarray, shape (nodes, 3, functions, T)
            Of the fillets.
        """
        ring, pressed = self.ring, load @ self.ring.follow
        mean = ring.mean @ pressed
        forces = [(tooth, ring.lost @ ring.turned(pressed, tooth)) for tooth in range(ring.different)]
        approach = np.array([pressed @ mean - ring.turned(pressed, tooth) @ force for tooth, force in forces])
        moved = {
            side: np.stack([u @ mean - ring.turned(u, tooth) @ force for tooth, force in forces], axis=-1)
            for side, u in self.moved.items()
        }
        return approach, moved


@dataclass(frozen=True)
class HoledHalf:
    """Motions of a gear that were solved apart from others, or all of them.

    Parameters
    ----------
    ring : HoledRing
        Its rows are ports of the flank, then unknowns of the fillets.
    flank : ndarray of int, shape (n,)
        Which of the flank's ports.
    fillets : sequence of (ndarray, ndarray)
        Which unknowns of the fillets, and with which functions along the face.
    """

    ring: HoledRing
    flank: Index
    fillets: Sequence[tuple[Index, ...]]

    def added_to(self, response: Mapping[int, Array]) -> dict[int, Array]:
        """Motion of teeth under forces on the flank of tooth 0, with what holes add to it on average over all teeth."""
        return {k: u + self.ring.added_on_average(k, slice(self.flank.size)) for k, u in response.items()}


def holed_teeth(
    halves: Sequence[HoledHalf], size: int, shapes: Mapping[Side, tuple[int, int]],
    in_space: Callable[[Side, Array], Array],
) -> HoledTeeth:  # fmt: skip
    """Join what motions that were solved apart owe to holes.

    Parameters
    ----------
    halves : sequence of HoledHalf
    size : int
        Ports of the flank.
    shapes : mapping of side to (int, int)
        Unknowns of the section and functions of the fillets.
    in_space : callable
        From a fillet's unknowns to displacements.
    """
    from scipy.linalg import block_diag

    rings = [half.ring for half in halves]
    starts = np.cumsum([0, *(ring.orders.size for ring in rings)])
    count = int(starts[-1])
    flank, local = np.zeros((size, count)), {side: np.zeros((*shape, count)) for side, shape in shapes.items()}
    for half, start in zip(halves, starts, strict=False):
        columns, row = slice(start, start + half.ring.orders.size), half.flank.size
        flank[half.flank, columns] = half.ring.follow[:row]
        for side, (node, function) in zip(shapes, half.fillets, strict=True):
            local[side][node, function, columns] = half.ring.follow[row : row + node.size]
            row += node.size
    whole = replace(
        rings[0], follow=flank, lost=block_diag(*(ring.lost for ring in rings)),
        orders=np.concatenate([ring.orders for ring in rings]),
        partner=np.concatenate([ring.partner + start for ring, start in zip(rings, starts, strict=False)]),
    )  # fmt: skip
    return HoledTeeth(whole, {side: in_space(side, moved) for side, moved in local.items()})
