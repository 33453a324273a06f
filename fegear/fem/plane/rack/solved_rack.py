"""Influence functions of a rack's teeth, each by its number; dimensionless (module 1, Young's modulus 1).

One sector is meshed and condensed; the row's recursion (`row`) answers for the teeth that are asked for, and teeth that
stand alike (far from both ends, or equally to the pins) are answered once.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.one_thread import one_thread
from fegear.fem.plane.elasticity import assemble_two_orders
from fegear.fem.plane.influence import MOSTLY_TURNED, Influence
from fegear.fem.plane.rack.rack_mesh import rack_sector
from fegear.fem.plane.rack.row import Row, rack_sector_between, row_of
from fegear.fem.plane.rack.straight_flank import StraightFilletCurve, StraightFlank, straight_flank
from fegear.fem.plane.root_stress import fillet_strain
from fegear.fem.plane.sector_sides import ports_of
from fegear.fem.plane.settings import MeshSettings

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.root_stress import FilletCurve, FilletStrain
    from fegear.fem.plane.sector_sides import BetweenSides
    from fegear.geometry.gear import Plane
    from fegear.geometry.rack_tooth import RackTooth

#: How far below the flank a pressure may reach into the root rounding [modules], as of gears.
_MARGIN = 0.15


@dataclass(frozen=True)
class RackInfluence(Influence):
    """One loaded tooth of a rack and its neighbours, as far as there are any; radii are heights on the rack."""

    tooth: RackTooth  # type: ignore[assignment]  # asked for its curves only; no gear's estimate takes this

    def fillet_curve(self, side: Side, module: float = 1.0) -> FilletCurve:
        """Where the largest stress of a rounding is looked for."""
        fillet, flank = self.fillets[side], self.flank
        assert isinstance(flank, StraightFlank)  # noqa: S101  (for mypy: racks have straight flanks)
        return StraightFilletCurve(
            side, fillet.arc, fillet.length, flank.base_radius, (0.0, 0.0), module, flank.heights, flank.pressure_angle
        )

    @cached_property
    def _far(self) -> Array | None:
        """As of a gear, by the neighbour that there is."""
        beside = self.compliance.get(1, self.compliance.get(-1))
        if beside is None:
            return None
        flank = self.flank
        middle = np.array([0.5 * (flank.flank_start + flank.flank_end)])
        load = flank.patches(middle, np.array([0.3 * (flank.flank_end - flank.flank_start)]))[:, 0]
        own, next_one = float(load @ self.compliance[0] @ load), float(load @ beside @ load)
        return 0.5 * (beside + beside.T) if next_one > MOSTLY_TURNED * own else None

    def _curvature(self, arc: Array) -> Array:
        """None."""
        return np.zeros(arc.shape)


class _Ports(NamedTuple):
    """How flank and root roundings of a sector follow its sides, and their own part with the sides held."""

    flank_follow: Array
    flank_own: Array
    stress_follow: Mapping[Side, Array]
    stress_own: Mapping[Side, Array]


@dataclass(frozen=True)
class SolvedRack:
    """A solved row of rack teeth, by one order of elements.

    Parameters
    ----------
    tooth : RackTooth
    poisson_ratio : float
    plane : {"strain", "stress"}
    mesh : SectorMesh
    flank : StraightFlank
    fillets : mapping of side to FilletStrain
    row : Row
    corner_distance : float
    reach : int
        Neighbours that are answered for.
    unknowns : int
        Of one sector.
    """

    tooth: RackTooth
    poisson_ratio: float
    plane: Plane
    mesh: SectorMesh
    flank: StraightFlank
    fillets: Mapping[Side, FilletStrain]
    row: Row
    corner_distance: float
    reach: int
    unknowns: int

    @property
    def teeth(self) -> int:
        """Of the rack."""
        return self.row.count

    @cached_property
    def alike(self) -> tuple[int, ...]:
        """For each tooth the first one that answers as it does, its neighbours included."""
        first: dict[object, int] = {}
        return tuple(first.setdefault(self.row.place(i, self.reach), i) for i in range(self.teeth))

    def loaded(self, i: int) -> RackInfluence:
        """Tooth i under loads on itself, and what these do to its neighbours."""
        i = self.alike[i]
        if i not in self._known:
            self._known[i] = self._solve(i)
        return self._known[i]

    @cached_property
    def _known(self) -> dict[int, RackInfluence]:
        """Teeth that have been asked for."""
        return {}

    @cached_property
    def _ports(self) -> tuple[_Ports, ...]:
        """Of each kind of sector."""
        return tuple(self._port(kind) for kind in self.row.kinds)

    def _port(self, kind: BetweenSides) -> _Ports:
        flank, modulus = ports_of(kind.sector, self.flank.dofs), 1.0
        if self.plane == "strain":
            modulus = 1.0 / (1.0 - self.poisson_ratio**2)
        follow = np.hstack([kind.follow_a, kind.follow_b])
        stress_follow: dict[Side, Array] = {}
        stress_own: dict[Side, Array] = {}
        for side, fillet in self.fillets.items():
            at = ports_of(kind.sector, fillet.dofs)
            stress_follow[side] = modulus * (fillet.strain @ follow[at])
            stress_own[side] = modulus * (fillet.strain @ kind.own[at[:, None], flank])
        return _Ports(follow[flank], kind.own[flank[:, None], flank], stress_follow, stress_own)

    def _solve(self, i: int) -> RackInfluence:
        here = self._ports[self.row.order[i]]
        compliance: dict[int, Array] = {}
        stress: dict[tuple[int, Side], Array] = {}
        with one_thread():
            for k, moved in self.row.motion(i, here.flank_follow.T, self.reach).items():
                there = self._ports[self.row.order[i + k]]
                compliance[k] = there.flank_follow @ moved
                for side in self.fillets:
                    stress[k, side] = there.stress_follow[side] @ moved
            compliance[0] += here.flank_own
            for side in self.fillets:
                stress[0, side] += here.stress_own[side]
        return RackInfluence(
            self.tooth, self.poisson_ratio, self.plane, self.mesh, self.flank, compliance, self.fillets, stress,
            self.corner_distance, self.reach, self.unknowns, {},
        )  # fmt: skip


def solve_rack_teeth(
    tooth: RackTooth,
    body: float,
    teeth: int,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    *,
    reach: int = 2,
    held: tuple[bool, ...] = (),
    pin_width: float = 0.0,
) -> tuple[SolvedRack, SolvedRack, float]:
    """Solve a rack.

    Parameters
    ----------
    tooth : RackTooth
    body : float
        From the back to the root [modules].
    teeth : int
    poisson_ratio : float
    plane : {"strain", "stress"}
    settings : MeshSettings
    reach : int
    held : tuple of bool, optional
        Below which teeth there is a pin; by default all of the back is held.
    pin_width : float
        [modules].

    Returns
    -------
    fine, coarse : SolvedRack
        By elements of the settings' order, and one order lower on the same mesh, which shows the error.
    seconds : float
    """
    started = time.perf_counter()
    mesh = rack_sector(tooth, body, settings, pin_width)
    with one_thread():
        fine, coarse = (
            _solved(tooth, mesh, elasticity, teeth, poisson_ratio, plane, settings.corner_distance, reach, held)
            for elasticity in assemble_two_orders(mesh, poisson_ratio, plane, settings.order, settings.solver)
        )
    return fine, coarse, time.perf_counter() - started


def _solved(
    tooth: RackTooth, mesh: SectorMesh, elasticity: SectorElasticity, teeth: int, poisson_ratio: float, plane: Plane,
    corner_distance: float, reach: int, held: tuple[bool, ...],
) -> SolvedRack:  # fmt: skip
    flank = straight_flank(mesh, elasticity, tooth, _MARGIN)
    fillets: dict[Side, FilletStrain] = {
        "tension": fillet_strain(mesh, elasticity, "fillet"),
        "compression": fillet_strain(mesh, elasticity, "back_fillet"),
    }
    ports = np.concatenate([flank.dofs, fillets["tension"].dofs, fillets["compression"].dofs])
    if held:
        kinds = [rack_sector_between(mesh, elasticity, ports, held=one, whole=False) for one in (True, False)]
        row = row_of(kinds, [0 if one else 1 for one in held])
    else:
        row = row_of([rack_sector_between(mesh, elasticity, ports, held=True, whole=True)], [0] * teeth)
    return SolvedRack(
        tooth, poisson_ratio, plane, mesh, flank, fillets, row, corner_distance, reach, elasticity.size
    )  # fmt: skip
