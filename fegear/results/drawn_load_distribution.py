"""Figures of loaded flanks: line load over the plane of action with contact lines, and load over the face."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, DeferredFigure, Figure, HeatMap, Panel, few, ramp
from fegear.results.drawn_flank_pressure import flank_pressure_figure
from fegear.results.loaded_pair import drawn_loads

if TYPE_CHECKING:
    from fegear.contact.flank import LoadedFlanks

#: Points of the maps along the line of action and along the face.
_ACROSS, _ALONG = 121, 81
#: Roll positions that are drawn, and where the scale of colours ends: this share of the places bears less.
_DRAWN, _TOP = 4, 99.7


def load_distribution_figures(name: str, found: LoadedFlanks, case: int) -> tuple[Figure | DeferredFigure, ...]:
    """Describe all figures of one pair under one of its loads."""
    pressure = DeferredFigure(
        f"flank_pressure_{name}", f"Pressure on the flanks of pair {name}",
        partial(flank_pressure_figure, name, found, case),
    )  # fmt: skip
    several = (_over_face_loads(name, found, case),) if found.load.size > 1 else ()
    return _over_plane(name, found, case), _over_face(name, found, case), *several, pressure


def _over_plane(name: str, found: LoadedFlanks, case: int) -> Figure:
    pair, lines = found.pair, found.lines
    x = np.linspace(pair.x_start, pair.x_end, _ACROSS)
    z = np.linspace(lines.low, lines.high, _ALONG)
    load = found.over_plane(x, z, case) * 1e-3
    top = float(np.nanpercentile(load, _TOP))
    items: list[HeatMap | Curve] = [HeatMap(x * 1e3, z * 1e3, load, "line load", "N/mm", limits=(0.0, top))]
    start, pitch = float(lines.roll[0]), pair.base_pitch
    drawn = [int(np.abs(lines.roll - start - (k + 0.5) * pitch / _DRAWN).argmin()) for k in range(_DRAWN)]
    items += [
        Curve(lines.x[p, s] * 1e3, lines.z[p, s] * 1e3, "", "ink", dash="solid", width=0.8, markers=False)
        for p in sorted(set(drawn))
        for s in lines.at(p)
    ]
    return Figure(
        f"load_distribution_{name}",
        f"Line load over the plane of action of pair {name}",
        f"Pair {name}: line load as the contact line moves from the driver's root (left) to its tip (right), and "
        f"contact lines at {len(set(drawn))} roll positions. The scale of colours ends at {top:.4g} N/mm; tips and "
        "ends of the face may bear more.",
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
    curves.append(
        Curve(
            z,
            found.mean_over_face[:, case] * 1e-3,
            "mean over a base pitch",
            "ink",
            dash="solid",
            width=2.4,
            markers=False,
        )
    )
    curves.append(Curve(z[[0, -1]], np.full(2, mean), "load / face width", "grey", dash="dash", markers=False))
    return Figure(
        f"load_over_face_{name}",
        f"Load over the face of pair {name}",
        f"Pair {name}: load of all contact lines together per face width; K_Hβ = {found.face_load_factor[case]:.4g}.",
        (Panel(Axis("face position z", "mm"), Axis("load per face width", "N/mm", zero=True), tuple(curves)),),
        under=f"{found.load[case]:.5g} N",
    )


def _over_face_loads(name: str, found: LoadedFlanks, case: int) -> Figure:
    ends, loads = found.cells * 1e3, found.load.tolist()
    z = 0.5 * (ends[1:] + ends[:-1])
    relative = found.mean_over_face / (found.load / (found.lines.high - found.lines.low))
    curves = [
        Curve(z, relative[:, i], label, role, dash="solid", markers=False)
        for i, label, role in drawn_loads(loads, loads[case])
    ]
    curves.append(Curve(z[[0, -1]], np.ones(2), "even", "grey", dash="dash", markers=False))
    return Figure(
        f"load_over_face_loads_{name}",
        f"Load over the face of pair {name} under every load",
        f"Pair {name}: load per face width, averaged over a base pitch, over its mean; the largest of it is K_Hβ.",
        (Panel(Axis("face position z", "mm"), Axis("load per face width over its mean", zero=True), tuple(curves)),),
    )
