"""A solid rack solved: each tooth by its number, the ends of the rack and its pins included; module 1, E = 1.

One sector of the section, sheared along the rack with the helix, is condensed onto its sides and ports as a gear's is;
the row's recursion (`fegear.fem.plane.rack.row`) answers for the teeth that are asked for, and teeth that stand alike
are answered once. Sides and ends of the rack follow the helix.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.influence import Side
from fegear.fem.plane.rack.rack_mesh import rack_sector
from fegear.fem.plane.rack.row import Row, row_of
from fegear.fem.plane.rack.straight_flank import straight_flank
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.contact import PressedLines
from fegear.fem.solid.face import FaceFunctions, face_functions, solid_unknowns
from fegear.fem.solid.fillet import SolidFillet, solid_fillet
from fegear.fem.solid.odd.solid_kind import KindOfMotion, between, motion
from fegear.fem.solid.rack.rack_flank import SolidRackSpec, SolidRackTooth, StraightFlankOfRack
from fegear.fem.solid.section import Straight, make_section
from fegear.fem.solid.sector import FILLETS, PlaneUnknowns, SolidSector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.fem.solid.bands import Bands

#: Base pitches of a stroke beyond the teeth of the rack, at most: teeth that are in mesh at a time.
_BEYOND = 64
#: What lies beyond a side is as stiff as beyond another to this share: answers differ by as much, and no more.
_ALIKE = 1e-5


@dataclass(frozen=True)
class SolidRack(StraightFlankOfRack):
    """A solid rack, its teeth by their numbers from 0; all but its spec follows from that.

    Parameters
    ----------
    spec : SolidRackSpec
    face, flank, fillets
        As of `SolidRackTooth`.
    ports : int
        Of a flank: its nodes, function by function along the face.
    axes : mapping of side to ndarray, shape (nodes, 3, 3)
        Of the nodes of the fillets.
    rows : tuple of Row
        The row of sectors, in each of the motions along the face that are solved apart.
    motions : tuple of tuple of KindOfMotion
        Of each kind of sector, the same motions.
    unknowns : int
        Of one sector.
    seconds : float
    """

    spec: SolidRackSpec
    face: FaceFunctions = field(compare=False)
    flank: LoadedFlank = field(compare=False)
    fillets: dict[Side, SolidFillet] = field(compare=False)
    ports: int = field(compare=False)
    axes: dict[Side, Array] = field(compare=False)
    rows: tuple[Row, ...] = field(compare=False)
    motions: tuple[tuple[KindOfMotion, ...], ...] = field(compare=False)
    unknowns: int = field(compare=False)
    seconds: float = field(compare=False)

    @property
    def teeth(self) -> int:
        """Number of teeth."""
        return self.spec.teeth

    @property
    def period(self) -> int:  # type: ignore[override]  # its teeth are not all alike
        """Base pitches after which answers repeat: never before the pinion has left the rack."""
        return self.teeth + _BEYOND

    def exists(self, i: int) -> bool:
        """Whether the rack has a tooth of this number."""
        return 0 <= i < self.teeth

    @cached_property
    def alike(self) -> tuple[int, ...]:
        """For each tooth the first one that answers as it does, its neighbours included."""
        first: dict[object, int] = {}
        return tuple(
            first.setdefault(tuple(row.place(i, self.reach) for row in self.rows), i) for i in range(self.teeth)
        )

    def same_as(self, first: int, count: int) -> int:
        """First of so many successive teeth that answer as those from `first` on; beyond an end none are alike."""
        if not (self.exists(first) and self.exists(first + count - 1)):
            return first
        wanted = self.alike[first : first + count]
        return next(i for i in range(self.teeth) if self.alike[i : i + count] == wanted)

    @property
    def middle(self) -> int:
        """The tooth whose answers are those of the `usual` rack."""
        return self.alike[(self.teeth - 1) // 2]

    @cached_property
    def usual(self) -> SolidRackTooth:  # type: ignore[override]  # another kind of solution
        """As if all teeth were as the one in the middle."""
        return self.loaded(self.middle)

    def differ(self, i: int, j: int) -> bool:  # noqa: ARG002  (what tooth j is decides)
        """Whether forces on tooth j move tooth i otherwise than in the `usual` rack."""
        return self.alike[j] != self.middle

    @cached_property
    def _known(self) -> dict[int, SolidRackTooth]:
        """Teeth that have been asked for."""
        return {}

    def loaded(self, j: int) -> SolidRackTooth:
        """Tooth j under forces on its flank, and what these do to its neighbours.

        Raises
        ------
        RangeError
            If there is no such tooth.
        """
        if not self.exists(j):
            raise RangeError("tooth", j, f"must be between 0 and {self.teeth - 1}")
        j = self.alike[j]
        if j not in self._known:
            with one_thread():
                self._known[j] = self._solved(j)
        return self._known[j]

    def _solved(self, j: int) -> SolidRackTooth:
        every = range(-self.reach, self.reach + 1)
        compliance = {k: np.zeros((self.ports, self.ports)) for k in every}
        local = {(k, side): np.zeros((self.fillets[side].nodes.size * 3, self.face.count, self.ports))
                 for k in every for side in self.fillets}  # fmt: skip
        for n, row in enumerate(self.rows):
            here = self.motions[row.order[j]][n]
            mine = here.flank
            for k, moved in row.motion(j, here.flank_follows.T, self.reach).items():
                there = self.motions[row.order[j + k]][n]
                compliance[k][np.ix_(mine, mine)] = there.flank_follows @ moved + (here.flank_own if k == 0 else 0.0)
                for side, (node, function) in there.fillets.items():
                    felt = there.fillet_follows[side] @ moved + (here.fillet_own[side] if k == 0 else 0.0)
                    local[k, side][node[:, None], function[:, None], mine] = felt
        displacement = {key: self._in_space(key[1], one) for key, one in local.items()}
        return SolidRackTooth(
            self.spec, j, self.face, self.flank, compliance, self.fillets, displacement
        )  # fmt: skip

    def _in_space(self, side: Side, moved: Array) -> Array:
        of_nodes = moved.reshape(-1, 3, *moved.shape[1:])
        return np.asarray(np.einsum("ncd,ndkr->nckr", self.axes[side], of_nodes, optimize=True))

    @property
    def compliance(self) -> dict[int, Array]:  # type: ignore[override]  # read-only
        """Of the `usual` rack."""
        return dict(self.usual.compliance)

    @property
    def displacement(self) -> dict[tuple[int, Side], Array]:  # type: ignore[override]  # read-only
        """Of the `usual` rack."""
        return dict(self.usual.displacement)

    def coupling(self, i: int, j: int) -> Array:
        """Approach of the flank of tooth i under forces on that of tooth j, port by port, shape (n, n)."""
        return self.loaded(j).compliance[i - j]

    def pressed(self, line: Bands, spans: Sequence[slice], teeth: Sequence[int]) -> PressedLines:
        """Contact lines on the flanks of teeth, one after the other: see `contact.PressedLines`."""
        return PressedLines(self, line, spans, teeth)


@tallied("tooth shapes")
def solve_solid_rack(spec: SolidRackSpec) -> SolidRack:
    """Solve a solid rack.

    Raises
    ------
    InputError
        If the body cannot be meshed.
    """
    started, held = time.perf_counter(), spec.held
    with one_thread():
        sectors = [_sector(spec, bore_held=one) for one in ((True, False) if held else (True,))]
        alone = [sector.halves() for sector in sectors]
        parts = [[between(sector, half) for half in halves] for sector, halves in zip(sectors, alone, strict=True)]
        order = [0 if one else 1 for one in held] if held else [0] * spec.teeth
        rows = tuple(row_of([kinds[n] for kinds in parts], order, _ALIKE) for n in range(len(alone[0])))
        motions = tuple(
            tuple(motion(sector, half, part) for half, part in zip(halves, kinds, strict=True))
            for sector, halves, kinds in zip(sectors, alone, parts, strict=True)
        )
    first = sectors[0]
    return SolidRack(
        spec, first.face, first.flank, first.fillets, int((first.known.number[first.ports] >= 0).sum()),
        {side: first.section.axes[fillet.nodes] for side, fillet in first.fillets.items()},
        rows, motions, first.known.size, time.perf_counter() - started,
    )  # fmt: skip


def _sector(spec: SolidRackSpec, *, bore_held: bool) -> SolidSector:
    tooth, settings = spec.tooth, spec.settings
    mesh = rack_sector(tooth, spec.body, settings.section, spec.pin_width)
    straight = Straight(tooth.pressure_angle, spec.slide)
    section = make_section(mesh, settings.section.order, 0.0, spec.poisson_ratio, math.inf, straight=straight)
    face = face_functions(spec.width, settings.degree(spec.width))
    known = solid_unknowns(section, face, settings, plane_strain=spec.plane_strain, bore_held=bore_held)
    return SolidSector(
        section, face, face, face, known, straight_flank(mesh, PlaneUnknowns(section), tooth, margin=0.0),
        {side: solid_fillet(section, name) for side, name in FILLETS.items()}, spec.slide == 0.0, None,
    )  # fmt: skip
