"""Teeth of another outline than the ordinary one: with another tip circle, or none at all; lengths in modules."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import GeometryError, InputError
from fegear.fem.plane.boundary import Chain, front_sizes, graded, sector_boundary
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.tooth_meshing import mesh_inside, mesh_sector
from fegear.geometry.external_tooth import Tooth

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.involute_tooth import InvoluteTooth

#: A tooth ends at least so far above its root form circle [modules]: a shorter flank has no room for a contact.
SHORTEST_FLANK = 0.05
#: Parts of the outline of a sector that a missing tooth leaves.
_LEFT = ("bore", "side_b", "root_land", "side_a")


@dataclass(frozen=True)
class OtherTip:
    """A tooth that ends at another radius [modules]: ground lower, or broken off."""

    radius: float

    def tooth(self, ordinary: InvoluteTooth) -> InvoluteTooth:
        """The tooth, its flanks and fillets those of the ordinary one.

        Raises
        ------
        InputError
            If its tip is above the ordinary one's, or too near to the start of the flank.
        """
        refuse_tip(ordinary, self.radius)
        if not isinstance(ordinary, Tooth):
            raise InputError("tip_radius", f"{self.radius:.6g} modules", "is possible for external teeth only")
        try:
            return replace(ordinary, tip_radius=self.radius)
        except GeometryError as error:
            raise InputError("tip_radius", f"{self.radius:.6g} modules", error.rule, error.remedy) from None

    def mesh(self, ordinary: InvoluteTooth, bore_radius: float, settings: MeshSettings) -> SectorMesh:
        """Of its sector."""
        return mesh_sector(self.tooth(ordinary), bore_radius, settings)


@dataclass(frozen=True)
class Missing:
    """No tooth: a sector that ends at the root circle."""

    def mesh(self, ordinary: InvoluteTooth, bore_radius: float, settings: MeshSettings) -> SectorMesh:
        """Of its sector."""
        started = time.perf_counter()
        chains = [chain for chain in sector_boundary(ordinary, bore_radius, settings) if chain.name in _LEFT]
        place = next(i for i, chain in enumerate(chains) if chain.name == "side_b") + 1
        place += chains[place].name == "root_land"
        start, end = chains[place - 1].vertices[:, -1], chains[place].vertices[:, 0]
        fillet = front_sizes(ordinary, settings)["fillet"]
        first, longest = float(fillet(np.zeros(1))[0]), settings.back_edge_length
        length = 2.0 * ordinary.root_radius * math.atan2(abs(start[0]), start[1])

        def size(s: Array) -> Array:
            return np.minimum(first + settings.growth * np.minimum(s, length - s), longest)

        chains.insert(place, _arc(start, end, graded(length, size, fewest=2) / length))
        mesh = mesh_inside(chains, ordinary.teeth, started, settings.side_growth)
        if settings.order > 2:
            check_cubic_edges(mesh)
        return mesh


def refuse_tip(ordinary: InvoluteTooth, radius: float) -> None:
    """Refuse a tip circle that a tooth cannot end at.

    Raises
    ------
    InputError
    """
    least, most = ordinary.form_radius + SHORTEST_FLANK, ordinary.tip_radius
    if not least <= radius <= most * (1.0 + 1e-12):
        raise InputError(
            "tip_radius", f"{radius:.6g} modules",
            f"must be a radius above the root form circle and up to the tip circle, {least:.6g} to {most:.6g} modules",
        )  # fmt: skip


def _arc(start: Array, end: Array, shares: Array) -> Chain:
    """Edges along the root circle between two points of it, at shares of the way."""
    radius, first, last = float(np.hypot(*start)), math.atan2(start[0], start[1]), math.atan2(end[0], end[1])
    angle = first + (last - first) * np.sort(np.concatenate([shares, 0.5 * (shares[1:] + shares[:-1])]))
    points = radius * np.stack([np.sin(angle), np.cos(angle)])
    points[:, 0], points[:, -1] = start, end
    turn = math.copysign(1.0, last - first)
    tangents = turn * np.stack([np.cos(angle), -np.sin(angle)])[:, ::2]
    return Chain("root_land", points[:, ::2], points[:, 1::2], tangents)
