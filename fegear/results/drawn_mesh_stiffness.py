"""Figures of the mesh stiffness matrix: its three numbers over the mesh cycle, and its mean as a map."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, HeatMap, Mark, Panel

if TYPE_CHECKING:
    from fegear.results.mesh_stiffness_matrix import MeshStiffnessData

#: Coordinates of a gear as the map names them: driver 1, driven gear 2.
_COORDINATES = ("y", "z", "bθx", "rθy", "rθz")


def mesh_stiffness_figures(name: str, data: MeshStiffnessData) -> tuple[Figure, ...]:
    """Describe both figures of one pair under its nominal load."""
    return _over_roll(name, data), _as_map(name, data)


def _over_roll(name: str, data: MeshStiffnessData) -> Figure:
    i, roll = data.flanks.nominal, data.flanks.found.lines.roll * 1e3
    found, mean, even = data.found.parameters[:, :, i], data.mean, data.even
    doubt = np.abs(data.other.parameters[:, :, i] - found)
    lever = math.cos(data.found.pair.driver.base_helix_angle) * data.found.lever[:, i] / data.found.half_width
    x = Axis("roll position over one base pitch", "mm")

    def curve(k: int, label: str, scale: float = 1.0) -> Curve:
        return Curve(roll, found[k] * scale, label, "series:0", doubt[k] * scale)

    def level(value: float, label: str, role: str) -> Curve:
        return Curve(roll[[0, -1]], np.full(2, value), label, role, dash="dash", markers=False)

    return Figure(
        f"mesh_stiffness_matrix_{name}",
        f"Mesh stiffness of pair {name} over a base pitch",
        f"Pair {name}: stiffness along the tooth normal K_M, its lever kappa and rotary stiffness mu in halves of the "
        "face width b; bands are estimated errors, grey what contact lines would have that are everywhere equally "
        "stiff. The lever of the force wanders though the load is constant.",
        (
            Panel(x, Axis("K_M", "N/um", zero=True), (curve(0, "these teeth", 1e-6),
                  level(float(mean[0]) * 1e-6, "mean", "ink"))),
            Panel(x, Axis("kappa"), (curve(1, "these teeth"), level(float(mean[1]), "mean", "ink"),
                  level(float(even[1]), "lines equally stiff", "grey"),
                  Curve(roll, lever, "lever of the force over b", "orange", dash="dot")), (Mark("y", 0.0),)),
            Panel(x, Axis("mu", zero=True), (curve(2, "these teeth"), level(float(mean[2]), "mean", "ink"),
                  level(float(even[2]), "lines equally stiff", "grey"))),
        ),
        under=f"{data.flanks.asked.nominal:.5g} N",
    )  # fmt: skip


def _as_map(name: str, data: MeshStiffnessData) -> Figure:
    matrix = data.mean_over_q * 1e-6
    places = np.arange(10.0)
    names = tuple(f"{c} {gear}" for gear in (1, 2) for c in _COORDINATES)
    size = float(np.abs(matrix).max())
    field = HeatMap(places, places, matrix, "stiffness", "N/um", (0.0, size), numbers=True)
    return Figure(
        f"mesh_stiffness_mean_{name}",
        f"Mean stiffness matrix of the mesh of pair {name}",
        f"Pair {name}: force on the coordinate of the row by motion along that of the column; 1 is the driver, 2 the "
        "driven gear, each turning about right-handed axes through its own. Rotations are arcs at half the face width "
        "b and at the base radius r.",
        (Panel(Axis("motion", categories=names), Axis("force", categories=names), (field,), height=2.2),),
        under=f"{data.flanks.asked.nominal:.5g} N",
    )
