"""Strain under a gauge on a tooth with a width on its way through the mesh, from the solved line loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.effects import NEIGHBOUR_COUPLING
from fegear.base.errors import InputError
from fegear.contact.gauge_strain import GaugeHistory, StrainWith, at_positions
from fegear.contact.wide.mesh_matrix import mesh_stiffness
from fegear.contact.wide.neglected_effects import effects_off, flanks_with
from fegear.contact.wide.root_stress import rooted_lines
from fegear.fem.solid.gauge import grid_on_face

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.contact.wide.root_stress import RootedLines
    from fegear.fem.plane.gauge import Grid
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.geometry.pair import Member

#: Steps between positions below this share of the usual one are the two sides of a jump.
_JUMP = 0.1


@dataclass(frozen=True)
class GaugeAboutLoad(ReadOnlyArrays):
    """What a gauge sees under one load, and how that changes as the gears approach; P positions of its tooth.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Of the tooth's contact at mid-face, ascending [m].
    strain : ndarray, shape (P, G)
        By displacement of the grid.
    slope : ndarray, shape (P, G)
        Change of the strain per change of the transmission error [1/m].
    error, slope_error : ndarray, shape (P,)
        Estimated, of the grid that is not displaced; NaN if unknown.
    """

    x: Array
    strain: Array
    slope: Array
    error: Array
    slope_error: Array


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
    seen, force = _Gauges(loaded, member, grid, z, influence), loaded.found.contact.force
    rooted = loaded.rooted(member, loaded.found, influence.fine)
    strain, stress = seen.means(rooted, side, middle + displacement, force)
    opposite = seen.means(rooted, other, np.array([middle]), force)[0][..., 0]
    off, off_stress = seen.errors(side, middle + displacement, at, (strain, stress), loaded.error.coarse.contact.force)
    sense = 1.0 if side == "tension" else -1.0
    if grid.strain_per_stress(loaded.pair.gear(member).material, "stress") < 0.0:
        sense = -sense
    return GaugeHistory(
        loaded.pair, member, side, sense, off, off_stress, strain, rooted.x, strain[..., at], opposite,
        stress[..., at], displacement,
    )  # fmt: skip


def gauge_about_load(
    loaded: LoadedWidePair,
    member: Member,
    side: Side,
    grid: Grid,
    middle: float,
    displacement: Array,
    z: float,
    influence: SolidInfluence,
    load: float,
) -> GaugeAboutLoad:
    """What a gauge sees while the gears vibrate about a load [N]: its strain there, and its tangent.

    As the transmission error grows by d, every station that touches carries more by its part of the tangent mesh
    stiffness times d (`fegear.contact.wide.mesh_matrix`). Errors are those at the nominal load. Parameters are those of
    `wide_gauge_history`.
    """
    at, arc = int(np.argmin(np.abs(displacement))), middle + displacement
    seen = _Gauges(loaded, member, grid, z, influence)
    rooted = loaded.rooted(member, loaded.found, influence.fine)

    def forces(found: LoadedFlanks, case: int) -> tuple[Array, Array]:
        """On the stations, and what they gain per approach, shape (P, M, 1) each."""
        each = slice(case, case + 1)
        return found.contact.force[:, :, each], mesh_stiffness(found, loaded.flanks.points).stations[:, :, each]

    about = loaded.flanks.solve([load], loaded.gaps, loaded.known)
    strain, slope = (seen.means(rooted, side, arc, force)[0] for force in forces(about, 0))
    fine, coarse = (forces(one, loaded.at) for one in (loaded.found, loaded.error.coarse))
    error, slope_error = (
        seen.errors(side, arc, at, (seen.means(rooted, side, arc, force)[0],), rough)[0][:, 0]
        for force, rough in zip(fine, coarse, strict=True)
    )
    return GaugeAboutLoad(rooted.x, strain[:, 0], slope[:, 0], error, slope_error)


def wide_gauge_neglects(
    loaded: LoadedWidePair, member: Member, side: Side, grid: Grid, middle: float, z: float, influence: SolidInfluence
) -> dict[str, StrainWith]:
    """Strain at the nominal load with each effect that is off, by its name.

    Contact along tip edges lets a tooth pair begin to carry sooner and go on for longer: the load on the others falls,
    and with it the peak. Data that are wrong while nothing uses them are passed over. Parameters are those of
    `wide_gauge_history`.
    """
    seen, arc = _Gauges(loaded, member, grid, z, influence), np.array([middle])
    at = loaded.over.found
    number = at.load.tolist().index(loaded.nominal)

    def strain(found: LoadedFlanks, case: int, *, coupling: bool) -> tuple[Array, Array, float]:
        rooted = rooted_lines(found.pair, member, found.lines, influence.fine, coupling=coupling)
        mean = seen.means(rooted, side, arc, found.contact.force[:, :, case : case + 1])[0][:, 0, 0]
        return rooted.x / found.pair.gear(member).base_radius, mean, float(mean[int(np.abs(mean).argmax())])

    before = strain(at, number, coupling=loaded.coupling)[2]
    strains: dict[str, StrainWith] = {}
    for effect in effects_off(loaded.spec):
        try:
            found = flanks_with(effect, loaded.spec, loaded.flanks, loaded.gaps, loaded.over)
        except InputError:
            continue
        angle, mean, peak = strain(found, 0, coupling=loaded.coupling or effect == NEIGHBOUR_COUPLING.name)
        strains[effect] = StrainWith(peak / before - 1.0, angle, mean)
    return strains


class _Gauges:
    """Grids of one kind at one place along the face."""

    def __init__(self, loaded: LoadedWidePair, member: Member, grid: Grid, z: float, influence: SolidInfluence):
        self._module, self._material = loaded.pair.driver.module, loaded.pair.gear(member).material
        self._grid, self._z, self._sliced = grid, z, bool(loaded.missed)
        self._loaded, self._member, self._influence = loaded, member, influence

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

    def errors(
        self, side: Side, arc: Array, at: int, fine: tuple[Array, ...], coarse_force: Array
    ) -> tuple[Array, ...]:
        """Estimated errors of the strain, and of the stress where it is given, of one of the grids, shape (T, L) each.

        Parameters
        ----------
        side : {"tension", "compression"}
        arc : ndarray, shape (G,)
        at : int
            Number of that grid.
        fine : tuple of ndarray, shape (T, L, G)
            Strain, or strain and stress.
        coarse_force : ndarray, shape (P, M, L)
            What the coarser solution has on its stations [N].
        """
        loaded, influence = self._loaded, self._influence
        x = loaded.rooted(self._member, loaded.found, influence.fine).x
        key = f"root_{side}"
        if not loaded.estimated:
            return tuple(np.full(one.shape[:2], np.nan) for one in fine)
        if influence.coarse is None:
            off = [influence.error.get(key, np.nan) * np.abs(one[..., at]) for one in fine]
        else:
            again = loaded.rooted(self._member, loaded.error.coarse, influence.coarse)
            rough = self.means(again, side, arc, coarse_force)
            share = influence.entry_shares[key]
            off = [
                share * np.abs(at_positions(x, again.x, other) - one).max(axis=-1)
                for one, other in zip(fine, rough, strict=False)
            ]
        return tuple(error + _between_positions(x, one[..., at]) for error, one in zip(off, fine, strict=True))


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
