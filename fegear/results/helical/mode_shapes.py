"""Mode shapes of a helical pair drawn: its motions as bars, and the base circles as they move across the axes."""

from __future__ import annotations

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.helical_pair.modal_indices import ModeTable
from fegear.dynamics.helical_pair.model import HelicalPairModel, P, ReducedPairModel
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.figure.panel import Panel

#: Coordinates of q as bars have them.
_NAMES = ("y", "z", "bθ_{x}", "aθ_{y}", "aθ_{z}")
#: Largest motion as drawn, in base radii of the smaller gear; distance of the base circles along the line of action.
_DRAWN, _APART = 0.35, 0.8
#: Motion along y and about z, over the largest, that can be seen.
_SEEN = 0.02
#: Points of a drawn circle.
_CHORDS = 181


def mode_shape_figures(
    name: str, model: HelicalPairModel | ReducedPairModel, modes: ModeTable
) -> tuple[Figure, Figure]:
    """All motions of every flexible mode as bars; and what of it is seen along the axes, as in a drawing.

    Parameters
    ----------
    name : str
        Of the pair.
    model : HelicalPairModel or ReducedPairModel
    modes : ModeTable
    """
    flexible = np.flatnonzero(modes.ratio > 0.0)
    shapes = [_both(model, modes.shapes[:, r]) for r in flexible]
    titles = [f"mode {r + 1}, Λ = {modes.ratio[r]:.5g}, Δ_{{η}} = {modes.normal[r]:.4g}" for r in flexible]
    radii = (1.0, 1.0) if isinstance(model, ReducedPairModel) else (
        model.driver.base_radius, model.driven.base_radius
    )  # fmt: skip
    across = [
        (shape, title) for shape, title in zip(shapes, titles, strict=True) if np.abs(shape[:, [0, 4]]).max() > _SEEN
    ]
    bars = Figure(
        f"mode_shapes_{name}",
        f"Mode shapes of pair {name}",
        f"Pair {name}: motion of both gears in every mode, over the largest; rotations as lengths, b half the face "
        "width, a the base radius.",
        tuple(_bars(shape, title) for shape, title in zip(shapes, titles, strict=True)),
        columns=2,
    )
    drawing = Figure(
        f"mesh_mode_shapes_{name}",
        f"Mesh mode shapes of pair {name}",
        f"Pair {name}, seen along the axes: base circles and their radii to the line of action (dotted), at rest "
        "(grey) and at one end of the swing. Motion along the axes and tilting do not show; modes of these alone are "
        "left out.",
        tuple(_drawing(shape, title, radii) for shape, title in across or list(zip(shapes, titles, strict=True))),
        columns=2,
    )
    return bars, drawing


def _both(model: HelicalPairModel | ReducedPairModel, shape: Array) -> Array:
    """Motion of driver and driven over q, shape (2, 5), over the largest."""
    gears = np.array([shape, P @ shape]) if isinstance(model, ReducedPairModel) else shape.reshape(2, 5)
    return np.asarray(gears / np.abs(gears).max())


def _bars(shape: Array, title: str) -> Panel:
    place = np.arange(5)
    return Panel(
        Axis(categories=_NAMES), Axis("motion over the largest", limits=(-1.1, 1.1)),
        (Bars(place, shape[0], "driver", "driver"), Bars(place, shape[1], "driven", "driven")), title=title,
    )  # fmt: skip


def _drawing(shape: Array, title: str, radii: tuple[float, float]) -> Panel:
    """Line of action upward: it touches the driver's base circle on the right, the driven gear's on the left."""
    size = _DRAWN * min(radii)
    around = np.linspace(0.0, 2.0 * np.pi, _CHORDS)
    line, apart = radii[0], _APART * sum(radii)
    items = [
        Curve(
            [line, line], [-radii[0], apart + radii[1]], "line of action", "grey", dash="dot", width=1.0, markers=False
        )
    ]
    gears = ((0.0, 0.0, 0.0, "driver"), (line + radii[1], apart, np.pi, "driven"))
    for motion, radius, (x, y, towards, role) in zip(shape, radii, gears, strict=True):
        for moved in (False, True):
            up = y + size * motion[0] * moved
            turn = towards + size * motion[4] / radius * moved
            arm = np.array([0.0, radius])
            drawn = (
                np.array([radius * np.cos(around), radius * np.sin(around)]),
                np.outer([np.cos(turn), np.sin(turn)], arm),
            )
            for along, across in drawn:
                items.append(Curve(
                    x + along, up + across, role if moved else "at rest", role if moved else "grey", dash="solid",
                    width=2.2 if moved else 1.0, markers=False,
                ))  # fmt: skip
    return Panel(Axis(hidden=True), Axis(hidden=True), tuple(items), title=title, equal=True)
