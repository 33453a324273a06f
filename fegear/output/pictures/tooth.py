"""The tooth, the rack that generates it, and its mesh."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.outline import tooth_outline, turned
from fegear.output.pictures.style import BLUE, ORANGE, RED, SKY, Picture, figure, in_house_style, save

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fegear.fem.mesh import SectorMesh
    from fegear.geometry import Gear, Tooth

    Array = NDArray[np.float64]


def rack_tooth(tooth: Tooth) -> Array:
    """Outline of the tool's tooth [modules], shape (2, N): along the rack, and above the gear's pitch line."""
    rack, shift = tooth.rack, tooth.generating_shift
    alpha, rho = rack.pressure_angle, rack.tip_radius
    top = np.array([[math.pi / 4 + rack.addendum * math.tan(alpha)], [shift + rack.addendum]])
    beta = np.linspace(math.pi / 2 - alpha, 0.0, 25)
    centre = rack.tip_centre_offset, shift - rack.tip_centre_depth
    rounding = np.stack([centre[0] + rho * np.sin(beta), centre[1] - rho * np.cos(beta)])
    right = np.hstack([top, rounding])
    return np.hstack([right, right[:, ::-1] * np.array([[-1.0], [1.0]])])


def rack_in_gear(tooth: Tooth, rolled: float) -> Array:
    """The tool in the gear's frame after the gear has rolled by an angle [rad], in the space right of the tooth."""
    u, v = rack_tooth(tooth)
    placed = np.stack([u + tooth.pitch_radius * rolled, v + tooth.pitch_radius])
    return turned(placed, math.pi / tooth.teeth - rolled)


@in_house_style
def draw_tooth(gear: Gear, mesh: SectorMesh, path: Path, name: str) -> Picture:
    """Draw the tooth with the positions of its tool, and the mesh of its sector."""
    tooth, m = gear.tooth, gear.module * 1e3
    made, (left, right) = figure(1, 2, size=(9.6, 5.0))
    outline = tooth_outline(tooth, 1e-5) * m
    pitch = 2 * math.pi / tooth.teeth
    reach = 1.6 * math.pi / tooth.teeth + 0.6 / math.sqrt(tooth.teeth)
    for rolled in np.linspace(-reach, reach, 31):
        left.plot(*(rack_in_gear(tooth, rolled) * m), color=SKY, lw=0.6, alpha=0.55)
    left.plot(*(rack_in_gear(tooth, 0.0) * m), color=ORANGE, lw=1.8, label="tool (rack)")
    for k in (-1, 1):
        left.plot(*turned(outline, k * pitch), color=BLUE, lw=1.0, alpha=0.5)
    left.plot(*outline, color=BLUE, lw=2.0, label="tooth")
    for radius, style, label in (
        (gear.pitch_radius, "-.", "pitch circle"),
        (gear.base_radius, ":", "base circle"),
    ):
        angle = np.linspace(-1.6 * pitch, 1.6 * pitch, 121)
        left.plot(radius * 1e3 * np.sin(angle), radius * 1e3 * np.cos(angle), style, color="0.45", lw=1.0, label=label)
    height = outline[1].max() - outline[1].min()
    left.set_xlim(-0.62 * pitch * gear.pitch_radius * 1e3, 1.12 * pitch * gear.pitch_radius * 1e3)
    left.set_ylim(outline[1].min() - 0.25 * height, outline[1].max() + 0.55 * height)
    left.legend(loc="upper left", fontsize=8, ncols=2)
    left.set_title("Tooth and the tool that generates it")

    _draw_mesh(right, mesh, m)
    right.set_title(f"Sector mesh: {mesh.triangles.shape[1]} six-node triangles")
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.grid(visible=False)
        axes.set_xlabel("x [mm]")
        axes.set_ylabel("y [mm]")
    caption = (
        f"Gear {name}: {gear.teeth} teeth, module {m:.6g} mm. Left: the rack tool rolls through the space and leaves "
        "the tooth standing. Right: the one sector that is solved for the whole ring; loaded flank orange, fillets red."
    )
    return save(made, path, f"Tooth, tool and mesh of gear {name}", caption)


def _draw_mesh(axes: Axes, mesh: SectorMesh, scale: float) -> None:
    from matplotlib.collections import LineCollection

    t, points = mesh.triangles, mesh.points.T * scale
    edges = np.concatenate([points[t[[i, j, k]]] for i, j, k in ((0, 3, 1), (1, 4, 2), (2, 5, 0))], axis=1)
    axes.add_collection(LineCollection(list(edges.transpose(1, 0, 2)), colors=BLUE, linewidths=0.25))
    for name, colour in (("flank", ORANGE), ("fillet", RED), ("back_fillet", RED)):
        lines = points[mesh.edges[name][[0, 2, 1]]].transpose(1, 0, 2)
        axes.add_collection(LineCollection(list(lines), colors=colour, linewidths=2.0))
    radius = np.hypot(*mesh.points)
    root = float(np.hypot(*mesh.points[:, np.unique(mesh.edges["fillet"])]).min())
    height = float(radius.max()) - root
    axes.set_xlim(np.array([-1.05, 1.05]) * max(np.abs(mesh.points[0]).max(), height) * scale)
    axes.set_ylim((root - 1.2 * height) * scale, (radius.max() + 0.15 * height) * scale)
