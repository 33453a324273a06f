"""One kind of sector of a solid ring with odd teeth: how its flank and fillets follow its sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.fem.plane.sector_sides import BetweenSides, between_sides, ports_of
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.dissection import condense_solid
from fegear.fem.solid.fillet import SolidFillet

if TYPE_CHECKING:
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.sector import SolidSector
    from fegear.fem.solid.unknowns import Unknowns


@dataclass(frozen=True)
class KindOfMotion(ReadOnlyArrays):
    """Flank and fillets of a sector in motions that are solved apart from others, or in all of them.

    Parameters
    ----------
    flank : ndarray of int, shape (n,)
        Which of the flank's ports.
    flank_follows : ndarray, shape (n, 2 m)
        Their motion under that of sides A and B.
    flank_own : ndarray, shape (n, n)
        The same under forces on themselves, the sides held.
    fillets : mapping of {"tension", "compression"} to (ndarray of int, ndarray of int)
        Which unknowns of a fillet, and with which functions along the face.
    fillet_follows, fillet_own : mapping of side to ndarray, shape (., 2 m) and (., n)
        Their motion likewise.
    front_follows, front_own : ndarray, shape (rows, 2 m) and (rows, n)
        Stress intensity along the front of a crack likewise, by ring, mode, derivative and function along the face
        (`front_intensity`); no rows where it is not asked for.
    """

    flank: Index
    flank_follows: Array
    flank_own: Array
    fillets: Mapping[Side, tuple[Index, Index]]
    fillet_follows: Mapping[Side, Array]
    fillet_own: Mapping[Side, Array]
    front_follows: Array
    front_own: Array


@dataclass(frozen=True)
class SolidKind(ReadOnlyArrays):
    """What stands in sectors of one kind.

    Parameters
    ----------
    flank : LoadedFlank
    ports : int
        Of the flank.
    fillets : mapping of {"tension", "compression"} to SolidFillet
    axes : mapping of side to ndarray, shape (nodes, 3, 3)
        Of the fillets' nodes.
    motions : tuple of KindOfMotion
    """

    flank: LoadedFlank
    ports: int
    fillets: Mapping[Side, SolidFillet]
    axes: Mapping[Side, Array]
    motions: tuple[KindOfMotion, ...]


def between(sector: SolidSector, alone: Unknowns, *, expandable: bool = False) -> BetweenSides:
    """Condense a sector onto its sides and ports, in motions that are solved apart.

    `expandable`, it can be asked for what of its inside follows these.
    """
    sides = sector.sides
    inner = np.setdiff1d(np.concatenate([sector.ports, *sector.seen.values()]), np.concatenate(sides))
    condensed = condense_solid(
        sector.section, sector.joined, alone, np.concatenate([*sides, inner]), expandable=expandable
    )
    return between_sides(condensed, alone.of(sides[0]).size, None)


def motion(sector: SolidSector, alone: Unknowns, part: BetweenSides, front: Array | None = None) -> KindOfMotion:
    """Flank and fillets of a sector that is condensed between its sides, and the `front_rows` of its crack."""
    follow, ports = np.hstack([part.follow_a, part.follow_b]), sector.ports
    run = ports_of(part.sector, alone.of(ports))
    rows = {side: ports_of(part.sector, alone.of(seen)) for side, seen in sector.seen.items()}
    on_flank = sector.known.number[ports] >= 0
    forces = np.zeros((0, follow.shape[0])) if front is None else _collected(sector, alone, part, front)
    return KindOfMotion(
        np.flatnonzero((alone.number[ports] >= 0)[on_flank]), follow[run], part.own[np.ix_(run, run)],
        sector.fillet_unknowns(alone), {side: follow[row] for side, row in rows.items()},
        {side: part.own[np.ix_(row, run)] for side, row in rows.items()}, forces @ follow, forces @ part.own[:, run],
    )  # fmt: skip


def _collected(sector: SolidSector, alone: Unknowns, part: BetweenSides, front: Array) -> Array:
    """Functionals of the displacement as weights of a condensed sector's ports, shape (rows, ports).

    Parameters
    ----------
    sector, alone, part
        As of `motion`; expandable.
    front : ndarray, shape (rings, modes, derivatives, N, 3)
    """
    number, functions = alone.number[:, sector.columns], sector.face.count
    along_axes = np.einsum("ncd,rabnc->rabnd", sector.section.axes, front).reshape(-1, number.shape[0])
    weights = np.zeros((alone.size, along_axes.shape[0], functions))
    for function in range(functions):
        there = np.flatnonzero(number[:, function] >= 0)
        weights[number[there, function], :, function] = along_axes[:, there].T
    return np.asarray(part.sector.collect(weights.reshape(alone.size, -1)).T)


def solid_kind(
    sector: SolidSector, motions: tuple[KindOfMotion, ...], mouth: float = float("nan"), *, back: bool = False
) -> SolidKind:
    """The kind of a sector with a tooth.

    Parameters
    ----------
    sector : SolidSector
    motions : tuple of KindOfMotion
    mouth : float
        Where its crack starts, arc length up a fillet [modules]; NaN without a crack.
    back : bool
        Whether that is the fillet of the flank that is not loaded.
    """
    ports = int((sector.known.number[sector.ports] >= 0).sum())
    axes = {side: sector.section.axes[fillet.nodes] for side, fillet in sector.fillets.items()}
    cut: Side = "compression" if back else "tension"
    fillets = {**sector.fillets, cut: replace(sector.fillets[cut], mouth=mouth)}
    return SolidKind(sector.flank, ports, fillets, axes, motions)
