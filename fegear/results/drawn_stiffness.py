"""Figures of a gear's compliance and root stress over the position of the load."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Scale

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.fem import StiffnessTable
    from fegear.geometry import Gear

_COMPLIANCE_AXIS = Axis("compliance", "um.mm/N")


def _roll_axis(gear: Gear, roll: Array) -> Axis:
    """Roll angle of the load, with the radius that belongs to it on the far side."""
    room = 0.05 * float(np.ptp(roll))
    shown = np.linspace(max(float(roll.min()) - room, 0.0), float(roll.max()) + room, 200)
    radius = gear.base_radius * 1e3 * np.hypot(1.0, np.deg2rad(shown))
    return Axis("roll angle of the load", "deg", second=Scale("load radius", "mm", shown, radius))


def _pitch_mark(gear: Gear, roll: Array) -> tuple[Mark, ...]:
    at = float(np.rad2deg(np.sqrt(max((gear.pitch_radius / gear.base_radius) ** 2 - 1.0, 0.0))))
    return (Mark("x", at, "pitch point"),) if roll.min() <= at <= roll.max() else ()


def stiffness_figures(name: str, t: StiffnessTable) -> tuple[Figure, ...]:
    """Compliances and root stresses of a gear over the roll angle of the load."""
    gear, order = t.influence.gear, np.argsort(t.roll_angle)
    roll = np.rad2deg(t.roll_angle[order])
    x, marks = _roll_axis(gear, roll), _pitch_mark(gear, roll)

    def curve(values: Array, error: str, label: str, role: str, scale: float) -> Curve:
        return Curve(roll, values[order] * scale, label, role, t.errors[error][order] * scale)

    compliance, stress = 1e9, 1e-3
    width = f"{t.half_width.min() * 1e3:.4g}"
    if t.half_width.max() > 1.0001 * t.half_width.min():
        width += f" to {t.half_width.max() * 1e3:.4g}"
    i = int(np.argmax(t.root_tension))
    worst = float(np.max(np.abs(t.errors["c_self"] / t.c_self)))
    return (
        Figure(
            f"compliance_{name}",
            f"Compliance of gear {name}",
            f"Gear {name}: deflection per line load of the loaded tooth and of its neighbours at the same radius, "
            f"whole ring, contact half-width {width} mm. Bands: estimated error, for c_0 at most {worst:.1e} of it.",
            (
                Panel(x, _COMPLIANCE_AXIS, (
                    curve(t.c_self, "c_self", "c_{0}, loaded tooth", "loaded tooth", compliance),
                ), marks),
                Panel(replace(x, second=None), _COMPLIANCE_AXIS, (
                    curve(t.c_next, "c_neighbour", "c_{+1}, next tooth", "next tooth", compliance),
                    curve(t.c_prev, "c_neighbour", "c_{−1}, previous tooth", "previous tooth", compliance),
                ), marks),
            ),
        ),
        Figure(
            f"root_stress_{name}",
            f"Root stress of gear {name}",
            f"Gear {name}: largest tangential fillet stress per line load. At its largest the tension sits at radius "
            f"{t.root_tension_radius[i] * 1e3:.5g} mm, where the fillet's tangent makes "
            f"{np.rad2deg(t.root_tension_angle[i]):.1f} deg with the tooth's centre line (ISO 6336-3 looks at 30 deg).",
            (
                Panel(x, Axis("largest root stress per line load", "MPa.mm/N", zero=True), (
                    curve(t.root_tension, "root_tension", "tension, fillet below the loaded flank", "tension", stress),
                    curve(-t.root_compression, "root_compression", "compression, other fillet (magnitude)",
                          "compression", stress),
                ), marks),
            ),
        ),
    )  # fmt: skip
