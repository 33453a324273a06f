"""Mode shapes of a helical pair drawn: its motions as bars, and the base circles as they move across the axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shows
from fegear.dynamics.helical_pair.modal_indices import ModeTable
from fegear.dynamics.helical_pair.model import HelicalPairModel, P, ReducedPairModel
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.seen import Seen

#: Coordinates of q as bars have them.
_NAMES = ("y", "z", "bθ_{x}", "aθ_{y}", "aθ_{z}")
#: Largest motion as drawn, in base radii of the smaller gear; distance of the base circles along the line of action.
_DRAWN, _APART = 0.35, 0.8
#: Motion along y and about z, over the largest, that can be seen.
_SEEN = 0.02
#: Points of a drawn circle.
_CHORDS = 181


@dataclass(frozen=True)
class ModeMotion:
    """Motion of both gears in one mode over q = (y, z, b theta_x, a theta_y, a theta_z), over the largest."""

    title: str
    shape: Array

    @property
    @shows("", "number of the coordinate")
    def place(self) -> Array:
        """From 0."""
        return np.arange(5.0)

    @property
    @shows("", "motion relative to the maximum")
    def driver(self) -> Array:
        """Shape (5,)."""
        return np.asarray(self.shape[0])

    @property
    @shows("", "motion relative to the maximum")
    def driven(self) -> Array:
        """Shape (5,)."""
        return np.asarray(self.shape[1])


def mode_motions(model: HelicalPairModel | ReducedPairModel, modes: ModeTable) -> list[ModeMotion]:
    """Of every flexible mode."""
    return [
        ModeMotion(
            f"mode {r + 1}, Λ = {modes.ratio[r]:.5g}, Δ_{{η}} = {modes.normal[r]:.4g}", _both(model, modes.shapes[:, r])
        )
        for r in np.flatnonzero(modes.ratio > 0.0)
    ]


#: All motions of every mode as bars.
MODE_SHAPES = Chart(
    "mode_shapes_{name}", "Mode shapes of pair {name}",
    "Pair {name}: motion of both gears in every mode, relative to the maximum; rotations as lengths (b half the face "
    "width, a base radius).",
    (
        Over(
            Axis(categories=_NAMES),
            tuple(Line(gear, gear, gear, x="place", kind="bars") for gear in ("driver", "driven")),
            Axis("motion relative to the maximum", limits=(-1.1, 1.1)), title="{one.title}", each="motions",
        ),
    ),
    columns=2,
)  # fmt: skip


def mesh_mode_shapes(seen: Seen) -> tuple[Figure, ...]:
    """What of every mode is seen along the axes, as in a drawing."""
    name, model, motions = seen.name, seen.data.model, seen.data.motions
    radii = (1.0, 1.0) if isinstance(model, ReducedPairModel) else (
        model.driver.base_radius, model.driven.base_radius
    )  # fmt: skip
    across = [one for one in motions if np.abs(one.shape[:, [0, 4]]).max() > _SEEN]
    drawing = Figure(
        f"mesh_mode_shapes_{name}",
        f"Mesh mode shapes of pair {name}",
        f"Pair {name}, seen along the axes: base circles and their radii to the line of action (dotted), at rest "
        "(grey) and at maximum amplitude. Axial motion and tilting are not visible; purely axial or tilting modes "
        "are omitted.",
        tuple(_drawing(one.shape, one.title, radii) for one in across or motions),
        columns=2,
    )
    return (drawing,)


def _both(model: HelicalPairModel | ReducedPairModel, shape: Array) -> Array:
    """Motion of driver and driven over q, shape (2, 5), over the largest."""
    gears = np.array([shape, P @ shape]) if isinstance(model, ReducedPairModel) else shape.reshape(2, 5)
    return np.asarray(gears / np.abs(gears).max())


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
