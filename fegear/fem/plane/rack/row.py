"""A row of equal sectors with two ends: every tooth loaded, every other one looked at.

A sector is condensed onto its ports and its sides as a gear's is (`sector_sides`); what differs is that the row is not
closed. With a_s the motion of side s (0 to n, sector i lies between sides i and i + 1) the row's stiffness is block
tridiagonal. One sweep from either end says what all sectors on one side of a side are to it, and the motion of a side
under forces on itself follows; each neighbour's is one product farther away.

Sectors may differ in how their back is held (a rack on pins); their sides must not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.condensation import condense
from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.sector_sides import BetweenSides, between_sides

#: Nodes of both sides are as high to this [modules].
_SAME = 1e-9
#: Stiffnesses of what lies beyond a side that agree to this share are one: a tooth far from the ends is as the next.
_ALIKE = 1e-13


def upright_sides(mesh: SectorMesh, elasticity: SectorElasticity) -> tuple[Index, Index]:
    """Unknowns of both sides of a rack's sector, from the back upward.

    Raises
    ------
    InputError
        If the sides do not match node by node.
    """
    both, heights = [], []
    for name in ("side_a", "side_b"):
        edges, dofs = mesh.edges[name], elasticity.edge_dofs[name]
        y = mesh.points[1, edges[:2]]
        dofs = np.where(y[0] < y[1], dofs, dofs[:, ::-1])
        dofs = dofs[:, :, np.argsort(y.min(axis=0))]
        run = np.concatenate([dofs[:, :1, 0], dofs[:, 1:, :].transpose(0, 2, 1).reshape(2, -1)], axis=1)
        both.append(run.T.reshape(-1))
        heights.append(np.sort(y.min(axis=0)))
    if both[0].size != both[1].size or np.abs(heights[0] - heights[1]).max() > _SAME:
        raise InputError("mesh", "side_a, side_b", "have different nodes, so that sectors cannot be joined")
    return both[0], both[1]


def rack_sector_between(
    mesh: SectorMesh, elasticity: SectorElasticity, ports: Index, *, held: bool, whole: bool
) -> BetweenSides:
    """One sector between its sides.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    ports : ndarray of int
        Unknowns that are loaded or looked at.
    held : bool
        Whether its held edges (bore) are held, or free as well.
    whole : bool
        Whether all of the back is held in every sector, the sides' ends with it.
    """
    bore = np.unique(elasticity.edge_dofs["bore"])
    side_a, side_b = upright_sides(mesh, elasticity)
    if whole:
        side_a, side_b = (side[~np.isin(side, bore)] for side in (side_a, side_b))
    sides = np.concatenate([side_a, side_b])
    fast = bore if held else np.zeros(0, dtype=np.int64)
    inner = np.setdiff1d(ports, np.concatenate([bore if whole else fast, sides]))
    return between_sides(condense(elasticity, np.concatenate([sides, inner]), fast), side_a.size, None)


@dataclass(frozen=True)
class Row:
    """Sectors in a row, condensed.

    Parameters
    ----------
    kinds : tuple of BetweenSides
        Sectors that differ.
    order : tuple of int
        Which of them each sector is, from the first to the last.
    alike : float
        Stiffnesses of what lies beyond a side that agree to this share are one.
    """

    kinds: tuple[BetweenSides, ...]
    order: tuple[int, ...]
    alike: float = _ALIKE

    @property
    def count(self) -> int:
        """Number of sectors."""
        return len(self.order)

    @cached_property
    def _beyond(self) -> tuple[list[int], list[int], list[Array]]:
        """Which stiffness each side 0 to n has of all sectors on its left, on its right; and these."""
        m = self.kinds[0].held.shape[0] // 2
        stored: list[Array] = [np.zeros((m, m))]
        known: dict[tuple[int, int, bool], int] = {}

        def step(before: int, kind: int, rightward: bool) -> int:
            key = (before, kind, rightward)
            if key not in known:
                k = self.kinds[kind].held
                aa, ab, bb = k[:m, :m], k[:m, m:], k[m:, m:]
                rest = stored[before]
                if rightward:
                    new = bb - ab.T @ np.linalg.solve(aa + rest, ab)
                else:
                    new = aa - ab @ np.linalg.solve(bb + rest, ab.T)
                new = 0.5 * (new + new.T)
                size = np.abs(new).max()
                same = (i for i, old in enumerate(stored) if np.abs(old - new).max() <= self.alike * size)
                found = next(same, None)
                if found is None:
                    stored.append(new)
                    found = len(stored) - 1
                known[key] = found
            return known[key]

        left, right = [0], [0]
        for kind in self.order:
            left.append(step(left[-1], kind, True))
        for kind in reversed(self.order):
            right.append(step(right[-1], kind, False))
        return left, right[::-1], stored

    def place(self, i: int, reach: int) -> tuple[object, ...]:
        """What the answers of sector i and its neighbours up to a reach depend on; equal for those that are alike."""
        left, right, _ = self._beyond
        low, high = max(i - reach, 0), min(i + reach, self.count - 1)
        return i - low, high - i, left[low], right[high + 1], self.order[low : high + 1]

    def motion(self, i: int, drive: Array, reach: int) -> dict[int, Array]:
        """Motion of the sides of sectors i - reach .. i + reach, as far as there are any.

        Parameters
        ----------
        i : int
            The loaded sector.
        drive : ndarray, shape (2 m, n)
            Forces on its sides, A first, that do to them what loads inside do.
        reach : int

        Returns
        -------
        dict of int to ndarray, shape (2 m, n)
            Of both sides, by the number of the sector less i.
        """
        left, right, stored = self._beyond
        kind = self.kinds[self.order[i]]
        m = kind.held.shape[0] // 2
        # The two sides of the loaded sector, what lies beyond either added to the sector's own stiffness.
        own = kind.held.copy()
        own[:m, :m] += stored[left[i]]
        own[m:, m:] += stored[right[i + 1]]
        moved = np.linalg.solve(own, drive)
        side = {i: moved[:m], i + 1: moved[m:]}
        low, high = max(i - reach, 0), min(i + reach, self.count - 1)
        for j in range(i + 1, high + 1):
            k = self.kinds[self.order[j]].held
            side[j + 1] = -np.linalg.solve(k[m:, m:] + stored[right[j + 1]], k[:m, m:].T @ side[j])
        for j in range(i - 1, low - 1, -1):
            k = self.kinds[self.order[j]].held
            side[j] = -np.linalg.solve(k[:m, :m] + stored[left[j]], k[:m, m:] @ side[j + 1])
        return {j - i: np.vstack([side[j], side[j + 1]]) for j in range(low, high + 1)}


def row_of(kinds: Sequence[BetweenSides], order: Sequence[int], alike: float = _ALIKE) -> Row:
    """A row of sectors, at least one of them held.

    Parameters
    ----------
    kinds : sequence of BetweenSides
    order : sequence of int
        Which of them each sector is.
    alike : float
        As of `Row`.
    """
    return Row(tuple(kinds), tuple(order), alike)
