"""A solid ring with odd teeth: what teeth around them answer, by their numbers from the middle one; E = 1, module 1.

The ring is that of plane teeth (`fegear.fem.plane.odd.odd_ring`): between the sides of a sector nothing tells a solid
from a plane one. Where motions that mirror themselves at the middle of the face are solved apart there are two.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.odd.odd_ring import OddRing
from fegear.fem.solid.odd.solid_kind import SolidKind

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side

#: Teeth on either side of the outermost odd ones that answer otherwise than ordinary ones, as of plane gears.
TOUCHED = 2


@dataclass(frozen=True)
class OddWindow:
    """Teeth around odd ones.

    Parameters
    ----------
    middle : int
        Number of tooth 0 among the gear's.
    teeth : int
        Of the gear.
    functions : int
        Along the face, of the fillets.
    usual : SolidKind
        Of ordinary teeth.
    odd : mapping of int to SolidKind
        By number, -R to R.
    missing : tuple of int
        Sectors without a tooth.
    rings : tuple of OddRing
        One for each of the motions that are solved apart.
    """

    middle: int
    teeth: int
    functions: int
    usual: SolidKind
    odd: Mapping[int, SolidKind]
    missing: tuple[int, ...]
    rings: tuple[OddRing, ...]

    @property
    def reach(self) -> int:
        """R."""
        return self.rings[0].reach

    @property
    def unlike(self) -> tuple[int, ...]:
        """Numbers of teeth that are not ordinary."""
        return tuple(sorted((*self.odd, *self.missing)))

    @property
    def touched(self) -> range:
        """Teeth that answer otherwise than ordinary ones: odd, between odd ones or next to one."""
        odd = self.unlike
        return range(max(odd[0] - TOUCHED, -self.reach), min(odd[-1] + TOUCHED, self.reach) + 1)

    def near(self, tooth: int) -> int:
        """Number from the middle one of a tooth of the gear, within half a turn to either side."""
        z = self.teeth
        return (tooth - self.middle + z // 2) % z - z // 2

    def known(self, near: int) -> bool:
        """Whether a tooth is known by its number from the middle one."""
        return abs(near) <= self.reach

    def kind(self, near: int) -> SolidKind:
        """Of what kind a tooth is; a missing one, which nothing loads, as the ordinary one."""
        return self.odd.get(near, self.usual)

    @cached_property
    def _couplings(self) -> dict[tuple[int, int], Array]:
        return {}

    def coupling(self, i: int, j: int) -> Array:
        """Approach of the flank of tooth i under forces on that of tooth j, port by port, shape (n_i, n_j)."""
        if (i, j) not in self._couplings:
            watched, loaded = self.kind(i), self.kind(j)
            found = np.zeros((watched.ports, loaded.ports))
            for ring, here, there in zip(self.rings, watched.motions, loaded.motions, strict=True):
                block = here.flank_follows @ ring.between(i, j) @ there.flank_follows.T
                found[np.ix_(here.flank, there.flank)] = block + here.flank_own if i == j else block
            # Reciprocity holds to round-off; as one matrix and its transpose it holds exactly.
            self._couplings[i, j] = 0.5 * (found + found.T) if i == j else found
            if i != j:
                self._couplings[j, i] = found.T
        return self._couplings[i, j]

    def moved(self, i: int, j: int, side: Side, loads: Array) -> Array:
        """Displacements x, y, z of a fillet of tooth i under loads on the flank of tooth j.

        Parameters
        ----------
        i, j : int
        side : {"tension", "compression"}
        loads : ndarray, shape (n_j, P)
            On the ports of its flank.

        Returns
        -------
        ndarray, shape (nodes, 3, functions, P)
            In the axes of tooth i.
        """
        watched, loaded = self.kind(i), self.kind(j)
        nodes = watched.fillets[side].nodes.size
        found = np.zeros((3 * nodes, self.functions, loads.shape[1]))
        for ring, here, there in zip(self.rings, watched.motions, loaded.motions, strict=True):
            on = loads[there.flank]
            felt = here.fillet_follows[side] @ (ring.between(i, j) @ (there.flank_follows.T @ on))
            found[here.fillets[side]] = felt + here.fillet_own[side] @ on if i == j else felt
        of_nodes = found.reshape(nodes, 3, *found.shape[1:])
        return np.asarray(np.einsum("ncd,ndkr->nckr", watched.axes[side], of_nodes, optimize=True))

    def front(self, i: int, j: int, loads: Array) -> Array:
        """Stress intensity of the crack of tooth i by functions along the face, under loads on the flank of tooth j.

        Parameters and errors as of `moved`.

        Returns
        -------
        ndarray, shape (rows, P)
            As of `KindOfMotion`; no rows where none were asked for.
        """
        watched, loaded = self.kind(i), self.kind(j)
        found = np.zeros((watched.motions[0].front_own.shape[0], loads.shape[1]))
        for ring, here, there in zip(self.rings, watched.motions, loaded.motions, strict=True):
            on = loads[there.flank]
            felt = here.front_follows @ (ring.between(i, j) @ (there.flank_follows.T @ on))
            found += felt + here.front_own @ on if i == j else felt
        return found
