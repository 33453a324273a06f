"""Strain under a gauge on a tooth with a width on its way through the mesh, from the solved line loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.gauge_strain import GaugeHistory
from fegear.fem.solid.gauge import grid_on_face

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.contact.wide.root_stress import RootedLines
    from fegear.fem.plane.gauge import Grid
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.geometry.pair import Member

#: Steps between positions below this share of the usual one are the two sides of a jump.
_JUMP = 0.1


def wide_gauge_history(
    loaded: LoadedWidePair,
    member: Member,
    side: Side,
    grid: Grid,
    middle: float,
    displacement: Array,
    z: float,
    influence: SolidInfluence,
) -> GaugeHistory:
    """Follow a gauge over all positions of its tooth at which the pair is loaded.

    The estimated error is what the coarser solution changes of the strain at any place within the displacements (slices
    state a share), and what straight lines between the positions miss of the curve.

    Parameters
    ----------
    loaded : LoadedWidePair
    member : {"driver", "driven"}
        Gear that has the gauge.
    side : {"tension", "compression"}
        Its fillet.
    grid : Grid
    middle : float
        Place of the middle of the grid, up the fillet [m].
    displacement : ndarray, shape (G,)
        Of grids that are glued elsewhere up the fillet [m]; zero is among them.
    z : float
        Place along the face, from the middle of the common one towards end II [m].
    influence : SolidInfluence
        Of that gear.
    """
    other: Side = "compression" if side == "tension" else "tension"
    at = int(np.argmin(np.abs(displacement)))
    seen = _Gauges(loaded, member, grid, z, bool(loaded.missed))
    rooted = loaded.rooted(member, loaded.found, influence.fine)
    strain, stress = seen.means(rooted, side, middle + displacement, loaded.found.contact.force)
    opposite = seen.means(rooted, other, np.array([middle]), loaded.found.contact.force)[0][..., 0]
    coarse, key = loaded.error.coarse, f"root_{side}"
    if not loaded.estimated:
        off = off_stress = np.full(opposite.shape, np.nan)
    elif influence.coarse is None:
        share = influence.error.get(key, np.nan)
        off, off_stress = share * np.abs(strain[..., at]), share * np.abs(stress[..., at])
    else:
        again = loaded.rooted(member, coarse, influence.coarse)
        pair = seen.means(again, side, middle + displacement, coarse.contact.force)
        share = influence.entry_shares[key]
        off, off_stress = (
            share * np.abs(_between(rooted.x, again.x, other_one) - one).max(axis=-1)
            for one, other_one in zip((strain, stress), pair, strict=True)
        )
    off, off_stress = (
        error + _between_positions(rooted.x, one[..., at])
        for error, one in ((off, strain), (off_stress, stress))
    )  # fmt: skip
    sense = 1.0 if side == "tension" else -1.0
    if grid.strain_per_stress(loaded.pair.gear(member).material, "stress") < 0.0:
        sense = -sense
    return GaugeHistory(
        loaded.pair, member, side, sense, off, off_stress, strain, rooted.x, strain[..., at], opposite,
        stress[..., at], displacement,
    )  # fmt: skip


class _Gauges:
    """Grids of one kind at one place along the face."""

    def __init__(self, loaded: LoadedWidePair, member: Member, grid: Grid, z: float, sliced: bool):
        self._module, self._material = loaded.pair.driver.module, loaded.pair.gear(member).material
        self._grid, self._z, self._sliced = grid, z, sliced

    def means(self, rooted: RootedLines, side: Side, arc: Array, force: Array) -> tuple[Array, Array]:
        """Mean strain, and mean stress along the profile [Pa], under every load, shape (T, L, G) each.

        Parameters
        ----------
        rooted : RootedLines
        side : {"tension", "compression"}
        arc : ndarray, shape (G,)
            Middles of the grids [m].
        force : ndarray, shape (P, M, L)
            On the stations [N].
        """
        m = self._module
        grid = grid_on_face(rooted.solution, side, self._grid, arc, self._z, m)
        found = [
            grid.means(
                rooted.surface(side, force[:, :, i], grid.zeta * m) / m**2, self._material, plane_strain=self._sliced
            )
            for i in range(force.shape[2])
        ]
        strain, stress = (np.stack([one.T for one in each], axis=1) for each in zip(*found, strict=True))
        return strain, stress


def _between(x: Array, at: Array, values: Array) -> Array:
    """Values at other positions, shape (T, L, G)."""
    flat = values.reshape(at.size, -1)
    return np.stack([np.interp(x, at, one) for one in flat.T], axis=1).reshape(x.size, *values.shape[1:])


def _between_positions(x: Array, values: Array) -> Array:
    """What a straight line between two positions misses of a curve about each, shape (T, L).

    Of a parabola, a quarter of how far a point lies off the line through those beside it. Both sides of a jump are
    among the positions: a point there has what the one beside it has on its own side.
    """
    missed = np.zeros(values.shape)
    if x.size > 2:
        step = np.diff(x)
        share = (step[:-1] / np.maximum(step[:-1] + step[1:], np.finfo(float).tiny))[:, None]
        off = 0.25 * np.abs(values[1:-1] - (1.0 - share) * values[:-2] - share * values[2:])
        smooth = np.minimum(step[:-1], step[1:]) > _JUMP * np.median(step)
        missed[1:-1][smooth] = off[smooth]
        beside = np.zeros(values.shape)
        beside[1:] = missed[:-1]
        beside[:-1] = np.maximum(beside[:-1], missed[1:])
        inner = np.concatenate([[False], smooth, [False]])
        missed[~inner] = beside[~inner]
    return missed
