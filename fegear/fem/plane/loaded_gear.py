"""The whole gear under one load on tooth 0: displacement and stress at every node, for pictures and other programs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.fem.plane.gear_field import GearField, gear_field
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.whole_gear import WholeGear, whole_gear
from fegear.geometry.gear import Gear
from fegear.geometry.outline import turned
from fegear.geometry.toothed_rack import Rack

_MM = 1e3

#: Six-node triangles are of this order, and want edges so much shorter than those of fourth order.
_FIELD_ORDER, _SIX_NODE_EDGES = 2, 0.7


def loaded_gear(
    gear: Gear, settings: MeshSettings, mesh: SectorMesh | None = None, radius: float | None = None
) -> tuple[WholeGear, GearField]:
    """Solve the whole gear under 1 N/mm on tooth 0.

    Parameters
    ----------
    gear : Gear
    settings : MeshSettings
        The field is solved on six-node triangles, which other programs read; edges meant for a higher order are
        shortened.
    mesh : SectorMesh, optional
        A user's own sector mesh.
    radius : float, optional
        Load radius [m]; by default the pitch radius, or the flank's end nearest to it.
    """
    if gear.support is not None:
        raise InputError(
            "rim_support", "pins or a spline", "is not available for fields of the full gear (rim fixed)",
            'set rim_support = { kind = "held" }',
        )  # fmt: skip
    if settings.order > _FIELD_ORDER:
        settings = replace(settings.scaled(_SIX_NODE_EDGES), order=_FIELD_ORDER)
    shape = mesh or mesh_sector(gear.tooth, gear.bore_radius / gear.module, settings)
    low, high = gear.involute_radii
    place = min(max(gear.pitch_radius if radius is None else radius, low), high)
    room = min(place - low, high - place) / gear.module
    half_width = max(min(settings.patch_half_width, room), settings.corner_distance)
    nu, plane = gear.material.poisson_ratio, gear.plane_assumption
    return whole_gear(shape), gear_field(gear.tooth, shape, nu, plane, place / gear.module, half_width)


def nodal_fields(gear: Gear | Rack, whole: WholeGear, field: GearField, line_load: float) -> dict[str, Array]:
    """Displacement [mm] and von Mises stress [MPa] at the nodes of the whole gear.

    Parameters
    ----------
    gear : Gear or Rack
        Of a rack the field is that of all of it.
    whole : WholeGear
    field : GearField
    line_load : float
        [N/m].

    Returns
    -------
    dict
        ``displacement`` of shape (N, 3) and ``von_mises`` of shape (N,); on the seam of two sectors their mean.
    """
    count = whole.points.shape[1]
    displacement, stress, times = np.zeros((count, 3)), np.zeros(count), np.zeros(count)
    pitch, von_mises = 2.0 * np.pi / gear.teeth, field.von_mises
    for k, nodes in enumerate(whole.sector_nodes):
        displacement[nodes, :2] = turned(field.displacement[k], k * pitch).T
        stress[nodes] += von_mises[k]
        times[nodes] += 1.0
    return {
        "displacement": displacement * line_load / gear.material.young_modulus * _MM,
        "von_mises": stress / times * line_load / gear.module * 1e-6,
    }
