"""Figures of modes followed over a parameter, and of the response at values of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.resolved_response import broken
from fegear.engine.figure import Axis, Curve, Figure, Panel
from fegear.results.drawn_transmissibility import LAMBDA, ends

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.results.followed_modes import FollowedData

#: What a parameter is called in figures, and its unit in tables.
PARAMETERS = {
    "alpha_y": ("radial bearing stiffness ratio α_{y}", ""),
    "alpha_z": ("axial bearing stiffness ratio α_{z}", ""),
    "alpha_theta": ("bending bearing stiffness ratio α_{θ}", ""),
    "aspect_ratio": ("aspect ratio ν", ""),
    "bearing_stiffness": ("bearing stiffness over that of the case", ""),
    "base_helix_angle": ("base helix angle ψ_{b}", "deg"),
    "kappa": ("mesh coupling κ", ""),
    "mu": ("rotary mesh stiffness μ", ""),
    "mesh_stiffness": ("mesh stiffness K_{M}", "N/um"),
}
#: SI to these units.
UNITS = {"deg": 180.0 / math.pi, "N/um": 1e-6, "": 1.0}
#: Indices with their names in tables and figures.
INDICES = (
    ("normal", "Delta_normal", "Δ_{η}"),
    ("bending", "Delta_bending", "Δ_{θx}"),
    ("coupling", "coupling", "coupling ratio"),
)
_NONE = 1e-9
#: Steps of an even range differ by less than this share.
_EVEN = 1e-6


def modes_figure(name: str, one: FollowedData) -> Figure:
    """Frequencies and indices of the branches."""
    label, unit = PARAMETERS[one.parameter]
    x = one.modes.values * UNITS[unit]
    steps = np.diff(x)
    log = bool(x[0] > 0.0 and np.ptp(steps) > _EVEN * steps.max())
    axis = Axis(label, unit, log=log, limits=(float(x[0]), float(x[-1])))
    shown = np.flatnonzero(one.modes.ratio.max(axis=0) > 0.0)

    def panel(title: str, rows: Array) -> Panel:
        return Panel(axis, Axis(title, zero=True), tuple(
            Curve(x, rows[:, r], f"mode {r + 1}", f"series:{k}", markers=False, width=3.0 - 0.3 * min(k, 5))
            for k, r in enumerate(shown)
        ))  # fmt: skip

    panels = [panel("Λ_{r}", one.modes.ratio)]
    panels += [panel(title, one.indices[key]) for key, _, title in INDICES if one.indices[key].max() > _NONE]
    return Figure(
        f"modes_over_{one.parameter}_{name}",
        f"Modes of pair {name} over the {label}",
        f"Pair {name}: modes followed by the continuity of their shapes, numbered by falling frequency in the case "
        "itself. Crossings are passed straight; at veerings the shapes are exchanged. Mesh displacements along the "
        "tooth normal and about x are over the largest; the coupling ratio is |U_ηθx| / (U_η + U_θx).",
        tuple(panels), columns=2 if len(panels) > 1 else 1,
    )  # fmt: skip


def response_figure(name: str, one: FollowedData) -> Figure:
    """The conventional responses at values of the parameter."""
    label, unit = PARAMETERS[one.parameter]
    symbol = label.rsplit(" ", 1)[-1] if one.parameter != "bearing_stiffness" else "bearing stiffness"
    panels = []
    for key, title in (
        ("dynamic", "|G − a_{M}|_{θz,y} / K_{M}"), ("line_of_action", "|R_{y,y}|"), ("torsion", "|R_{θz,θz}|"),
    ):  # fmt: skip
        curves = []
        for k, row in enumerate(one.responses):
            x, y = broken(row.ratio, getattr(row, key), row.undamped)
            value = f"{symbol} = {row.value * UNITS[unit]:.6g} {unit}".rstrip()
            curves.append(Curve(x, np.where(y > 0.0, y, np.nan), value, f"series:{k}", markers=False))
        poles = any(row.undamped.size for row in one.responses)
        limits = ends([getattr(row, key) for row in one.responses]) if poles else None
        panels.append(Panel(LAMBDA, Axis(title, log=True, limits=limits), tuple(curves)))
    return Figure(
        f"response_over_{one.parameter}_{name}",
        f"Conventional frequency response of pair {name} by {label}",
        f"Pair {name}: torsional response to a transmission error along the line of action, and the mesh force "
        "transmissibility along the line of action and in torsion.",
        tuple(panels),
    )
