"""Figures of loaded flanks: line load over the plane of action with contact lines, and load over the face."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, HeatMap, Panel, few, ramp

if TYPE_CHECKING:
    from fegear.contact.flank import LoadedFlanks

#: Points of the maps along the line of action and along the face.
_ACROSS, _ALONG = 121, 81
#: Roll positions that are drawn.
_DRAWN = 4


def load_distribution_figures(name: str, found: LoadedFlanks, case: int) -> tuple[Figure, ...]:
    """Describe all figures of one pair under one of its loads."""
    return _over_plane(name, found, case), _over_face(name, found, case)


def _over_plane(name: str, found: LoadedFlanks, case: int) -> Figure:
    pair, lines = found.pair, found.lines
    x = np.linspace(pair.x_start, pair.x_end, _ACROSS)
    z = np.linspace(lines.low, lines.high, _ALONG)
    load = found.over_plane(x, z, case) * 1e-3
    items: list[HeatMap | Curve] = [HeatMap(x * 1e3, z * 1e3, load, "line load", "N/mm")]
    middle = lines.roll.size // 2
    for n, s in enumerate(lines.at(middle)):
        label = f"contact lines at roll {lines.roll[middle] * 1e3:.3g} mm" if n == 0 else ""
        items.append(
            Curve(lines.x[middle, s] * 1e3, lines.z[middle, s] * 1e3, label, "ink", dash="solid", markers=False)
        )
    return Figure(
        f"load_distribution_{name}",
        f"Line load over the plane of action of pair {name}",
        f"Pair {name}: line load as the contact line moves from the driver's root (left) to its tip (right); blank "
        "where none of the roll positions brings a line.",
        (Panel(Axis("position on the line of action", "mm"), Axis("face position z", "mm"), tuple(items), height=1.4),),
        under=f"{found.load[case]:.5g} N",
    )


def _over_face(name: str, found: LoadedFlanks, case: int) -> Figure:
    ends, whole = found.cells * 1e3, found.over_face[:, :, case] * 1e-3
    z = 0.5 * (ends[1:] + ends[:-1])
    mean = float(found.load[case] / (found.lines.high - found.lines.low)) * 1e-3
    chosen = few(len(whole), (), _DRAWN)
    curves = [
        Curve(z, whole[p], f"roll {found.lines.roll[p] * 1e3:.3g} mm", role, dash="solid", width=1.2, markers=False)
        for p, role in zip(chosen, ramp(len(chosen)), strict=True)
    ]
    curves.append(Curve(z, whole.mean(axis=0), "mean over a base pitch", "ink", dash="solid", width=2.4, markers=False))
    curves.append(Curve(z[[0, -1]], np.full(2, mean), "load / face width", "grey", dash="dash", markers=False))
    return Figure(
        f"load_over_face_{name}",
        f"Load over the face of pair {name}",
        f"Pair {name}: load of all contact lines together per face width; K_Hβ = {found.face_load_factor[case]:.4g}.",
        (Panel(Axis("face position z", "mm"), Axis("load per face width", "N/mm", zero=True), tuple(curves)),),
        under=f"{found.load[case]:.5g} N",
    )
