"""Modes of a helical pair and its mesh force transmissibility over frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import (
    BLUE,
    DASHES,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    Picture,
    figure,
    in_house_style,
    save,
)

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.dynamics.mesh_parameters import MeshParameters
    from fegear.dynamics.modal_indices import ModeTable
    from fegear.dynamics.transmissibility import ReducedTransmissibility, Transmissibility

_SYMBOLS = ("y", "z", "\\theta_x", "\\theta_y", "\\theta_z")
_COLOURS = (BLUE, ORANGE, GREEN, RED, PURPLE)


@in_house_style
def draw_transmissibility(
    response: Transmissibility | ReducedTransmissibility, mesh: MeshParameters, path: Path, name: str
) -> Picture:
    """Draw the size of G over K_M and of R for transmission errors and forces along y, by component."""
    from fegear.dynamics.transmissibility import ReducedTransmissibility

    matrix = response.R if isinstance(response, ReducedTransmissibility) else response.R_ii
    made, (top, bottom) = figure(2, 1, size=(7.4, 6.4), sharex=True)
    tiny = 1e-12
    for axes, values, label in ((top, response.G / mesh.stiffness, "G"), (bottom, matrix, "R")):
        for i, symbol in enumerate(_SYMBOLS):
            size = np.abs(values[:, i, 0])
            if size.max() > 1e-9:
                style = DASHES[i % len(DASHES)]
                text = f"$|{label}_{{{symbol} y}}|$" + ("$/K_M$" if label == "G" else "")
                axes.semilogy(
                    response.ratio, np.maximum(size, tiny), style, color=_COLOURS[i], label=text, lw=4 - 0.7 * i
                )
        axes.legend(fontsize=9, ncols=3)
    top.set_ylabel("mesh force per transmission error")
    bottom.set_ylabel("mesh force per external force")
    bottom.set_xlabel("$\\Lambda = \\omega / \\sqrt{K_M/m_{eq}}$")
    caption = (
        f"Pair {name}: spectral mesh stiffness and mesh force transmissibility for a transmission error and an "
        "external force along the plane of action; components over q = (y, z, b theta_x, a theta_y, a theta_z)."
    )
    return save(made, path, f"Force transmissibility of pair {name}", caption)


@in_house_style
def draw_modes(modes: ModeTable, path: Path, name: str) -> Picture:
    """Draw the rating indices of all modes that move the mesh."""
    shown = np.flatnonzero(modes.ratio > 0.0)
    made, axes = figure(size=(7.2, 3.8))
    place = np.arange(shown.size)
    for offset, values, colour, label in (
        (-0.27, modes.normal, BLUE, "normal, $\\Delta_\\eta$"),
        (0.0, modes.bending, ORANGE, "bending, $\\Delta_{\\theta x}$"),
        (0.27, modes.coupling, GREEN, "coupling energy ratio"),
    ):
        axes.bar(place + offset, values[shown], width=0.25, color=colour, label=label)
    axes.set_xticks(place, [f"{r + 1}\n{modes.ratio[r]:.4g}" for r in shown])
    axes.set_xlabel("mode and its $\\Lambda_r$")
    axes.set_ylabel("modal index")
    axes.legend(fontsize=9)
    caption = f"Pair {name}: which modes a transmission error along the tooth normal or a bending one excites."
    return save(made, path, f"Modal indices of pair {name}", caption)
