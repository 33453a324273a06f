"""Figures of one gear that are drawings: the tooth with its tool and mesh, and the whole gear under load."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Figure, MeshField, Panel, TriangleField, edges, outline, polylines
from fegear.geometry.outline import rack_in_gear, tool_in_space, tooth_outline, turned

if TYPE_CHECKING:
    from fegear.arrays import Array, Index
    from fegear.fem import GearInfluence
    from fegear.fem.mesh import SectorMesh
    from fegear.geometry import Gear


#: Positions of the tool in the picture of a tooth.
_TOOL_POSITIONS = 31
#: Largest displacement as drawn [modules].
_DRAWN = 0.15
#: The deformed gear's scale of colours ends where this share of the nodes near the loaded tooth lies below [%].
_TOP = 99.5
#: Chords of a drawn outline stay this close to it [modules].
_CHORD = 1e-5


def tooth_figure(name: str, gear: Gear, mesh: SectorMesh) -> Figure:
    """The tooth with the positions of its tool, and the mesh of its sector."""
    tooth, m = gear.tooth, gear.module * 1e3
    shape, pitch = tooth_outline(tooth, _CHORD) * m, 2.0 * math.pi / tooth.teeth
    height, radius = float(np.ptp(shape[1])), gear.pitch_radius * 1e3
    around = np.linspace(-1.6 * pitch, 1.6 * pitch, 121)

    def circle(r: float) -> Array:
        return np.stack([r * np.sin(around), r * np.cos(around)])

    lines = (
        outline(polylines(tool_in_space(tooth, _TOOL_POSITIONS) * m),
              "positions of the tool", "sky", width=0.6),
        outline(rack_in_gear(tooth, 0.0) * m, "tool (rack)", "tool"),
        outline(polylines(turned(shape, k * pitch) for k in (-1, 1)), "", "outline", width=1.0),
        outline(shape, "tooth", "outline", width=2.2),
        outline(circle(radius), "pitch circle", "grey", dash="dashdot", width=1.0),
        outline(circle(gear.base_radius * 1e3), "base circle", "grey", dash="dot", width=1.0),
    )  # fmt: skip
    points, t = mesh.points * m, mesh.triangles
    sides = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
    sides = sides[:, np.unique(sides[1], return_index=True)[1]]  # each side once, by its middle node
    fillets = np.hstack([mesh.edges[side][[0, 2, 1]] for side in ("fillet", "back_fillet")])
    root = float(np.hypot(*points[:, np.unique(mesh.edges["fillet"])]).min())
    top = float(np.hypot(*points).max())
    across = 1.05 * max(float(np.abs(points[0]).max()), top - root)
    sector = (
        outline(edges(points, sides), "element", "grey", width=0.4),
        outline(edges(points, mesh.edges["flank"][[0, 2, 1]]), "loaded flank", "orange", width=2.0),
        outline(edges(points, fillets), "fillets", "red", width=2.0),
    )
    space = (-0.62 * pitch * radius, 1.12 * pitch * radius)
    depth = (float(shape[1].min()) - 0.25 * height, float(shape[1].max()) + 0.55 * height)
    return Figure(
        f"tooth_{name}",
        f"Tooth, tool and mesh of gear {name}",
        f"Gear {name}: {gear.teeth} teeth, module {m:.6g} mm. The rack tool rolls through the space and leaves the "
        "tooth standing; the one sector of the mesh is solved for the whole ring.",
        (
            Panel(Axis("x", "mm", limits=space), Axis("y", "mm", limits=depth), lines,
                  title="Tooth and the tool that generates it", height=1.5, equal=True),
            Panel(Axis("x", "mm", limits=(-across, across)),
                  Axis("y", "mm", limits=(root - 1.2 * (top - root), top + 0.15 * (top - root))), sector,
                  title=f"Sector mesh: {mesh.triangles.shape[1]} six-node triangles", height=1.5, equal=True),
        ),
        columns=2,
    )  # fmt: skip


def deformed_figure(name: str, influence: GearInfluence, line_load: float) -> Figure:
    """The whole gear and the loaded tooth, deformed on a larger scale and coloured by von Mises stress."""
    from fegear.fem.loaded_gear import loaded_gear, nodal_fields
    from fegear.fem.mesh import GENERATED

    gear, mesh = influence.gear, influence.fine.mesh
    whole, field = loaded_gear(gear, influence.settings, None if mesh.origin == GENERATED else mesh)
    fields = nodal_fields(gear, whole, field, line_load)
    m, rest = gear.module * 1e3, whole.points * gear.module * 1e3
    moved = fields["displacement"][:, :2].T
    scale = _DRAWN * m / float(np.hypot(*moved).max())
    points = rest + scale * moved
    near = np.hypot(rest[0], rest[1] - gear.pitch_radius * 1e3) < 4.0 * m
    top = float(np.percentile(fields["von_mises"][near], _TOP))
    low, high = gear.root_radius * 1e3 - 1.8 * m, gear.tip_radius * 1e3 + 0.5 * m
    shown = whole.triangles[:, near[whole.triangles].any(axis=0)]
    finer = np.hstack([shown[[a, b, c]] for a, b, c in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))])
    undeformed = outline(edges(rest, whole.outline), "", "ink", 0.5)
    panels = [
        Panel(
            Axis("x", "mm", limits=(-half, half)), Axis("y", "mm", limits=(centre - half, centre + half)),
            (_stress(points, triangles, fields["von_mises"], top), undeformed),
            title=title, height=1.26, equal=True,
        )
        for half, centre, triangles, title in (
            (1.06 * gear.tip_radius * 1e3, 0.0, whole.triangles[:3], "Whole gear"),
            (0.5 * (high - low), 0.5 * (high + low), finer, "Loaded tooth"),
        )
    ]  # fmt: skip
    return Figure(
        f"deformed_{name}",
        f"Deformed gear {name}",
        f"Gear {name} under {line_load * 1e-3:.4g} N/mm on tooth 0, displacements {scale:.3g} times as large; thin "
        f"lines show the gear at rest. The colour scale ends at {top:.3g} MPa; under the contact the stress is higher.",
        tuple(panels),
        columns=2,
        field=MeshField(name, rest, whole.triangles, fields),
        under=f"{line_load * 1e-3:.4g} N/mm",
    )


def _stress(points: Array, triangles: Index, von_mises: Array, top: float) -> TriangleField:
    """Von Mises stress on some triangles, with their own corners alone: most nodes are not drawn."""
    nodes, corners = np.unique(triangles, return_inverse=True)
    return TriangleField(
        points[:, nodes], corners.reshape(triangles.shape), von_mises[nodes], top, "von Mises stress", "MPa"
    )
