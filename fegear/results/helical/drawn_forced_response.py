"""Figures of an excited helical pair: forces over speed, and the spectrum at one speed."""

from __future__ import annotations

import math

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.helical_pair.transmissibility import Line, PairForces, rms
from fegear.dynamics.train.resolved_response import broken
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Stems, ramp
from fegear.engine.figure.panel import Panel
from fegear.results.helical.transmissibility import ends

#: Forces and moments with their keys and units in tables, and as figures write them.
COMPONENTS = (
    ("y", "F_{y}", "N"), ("z", "F_{z}", "N"),
    ("theta_x", "T_{x}", "N.m"), ("theta_y", "T_{y}", "N.m"), ("theta_z", "T_{z}", "N.m"),
)  # fmt: skip
_RPM = 30.0 / math.pi
#: Lines that are drawn over speed, the strongest ones; what is weaker than this share of the strongest is none.
_MOST_LINES, _NONE = 5, 1e-9


def forces_figure(name: str, forces: PairForces, undamped: Array, teeth: int) -> Figure:
    """Mesh force by lines, and forces of both bearings, over speed.

    Parameters
    ----------
    name : str
        Of the pair.
    forces : PairForces
        At speeds that show every peak.
    undamped : ndarray
        Speeds across which nothing is drawn [rad/s].
    teeth : int
        Of the driver; zero without transmission error.
    """
    speed, poles = forces.speed * _RPM, undamped * _RPM
    axis = Axis("speed of the driver", "rpm", limits=(float(speed[0]), float(speed[-1])))
    size = np.abs(forces.normal)
    strong = [k for k in np.argsort(-size.max(axis=1), kind="stable") if size[k].max() > _NONE * size.max()]
    strong = strong[:_MOST_LINES]
    rows = [
        (_line_name(forces.lines[k], teeth), size[k] / math.sqrt(2.0), role)
        for k, role in zip(strong, ramp(len(strong)), strict=True)
    ]
    if len(forces.lines) > 1:
        rows.append(("all lines", rms(forces.normal), "grey"))
    panels = [_over_speed(axis, Axis("normal mesh force, rms", "N", log=True), speed, rows, poles)]
    for where, word in (("bearing_driver", "driver's bearings"), ("bearing_driven", "driven gear's bearings")):
        found = getattr(forces, where)
        for unit, label in (("N", "force, rms"), ("N.m", "moment, rms")):
            rows = [
                (symbol, rms(found[:, :, k]), f"series:{k}")
                for k, (_, symbol, own) in enumerate(COMPONENTS)
                if own == unit
            ]
            panels.append(_over_speed(axis, Axis(label, unit, log=True), speed, rows, poles, f"On the {word}"))
    return Figure(
        f"pair_forces_{name}",
        f"Mesh and bearing forces of pair {name}",
        f"Pair {name}: root mean square over time of the force along the tooth normal, by its lines, and of what the "
        "bearings exert on both gears.",
        tuple(panels),
    )


def _line_name(line: Line, teeth: int) -> str:
    harmonic = line.order / teeth if teeth else 0.0
    if harmonic >= 1.0 and harmonic % 1.0 == 0.0:
        return f"harmonic {harmonic:.0f} of the mesh"
    return f"order {line.order:.4g}" if line.order else f"{line.frequency / (2.0 * math.pi):.4g} Hz"


def _over_speed(
    axis: Axis, force: Axis, speed: Array, rows: list[tuple[str, Array, str]], poles: Array, title: str = ""
) -> Panel:
    largest = max((float(row.max()) for _, row, _ in rows), default=0.0)
    curves, shown = [], []
    for label, row, role in rows:
        if row.max() > _NONE * largest:
            x, y = broken(speed, row, poles)
            width = 3.4 if role == "grey" else 1.8
            curves.append(Curve(x, np.where(y > 0.0, y, np.nan), label, role, markers=False, width=width))
            shown.append(row)
    limits = ends(shown) if poles.size else None
    return Panel(axis, Axis(force.label, force.unit, log=True, limits=limits), tuple(curves), title=title)


def spectrum_figure(name: str, forces: PairForces) -> Figure:
    """Lines of mesh force and bearing forces at one speed."""
    frequency = forces.frequency[:, 0] / (2.0e3 * math.pi)
    notes = tuple(line.source for line in forces.lines)
    panels = []
    for title, rows in (
        ("Mesh", (("along the tooth normal", forces.normal[:, 0]),)),
        ("Driver's bearings", tuple((COMPONENTS[k][1], forces.bearing_driver[:, 0, k]) for k in range(2))),
        ("Driven gear's bearings", tuple((COMPONENTS[k][1], forces.bearing_driven[:, 0, k]) for k in range(2))),
    ):
        largest = max(float(np.abs(row).max()) for _, row in rows)
        stems = []
        for k, (label, row) in enumerate(rows):
            size = np.abs(row)
            shown = size > _NONE * largest
            if shown.any():
                stems.append(Stems(frequency[shown], size[shown], label, f"series:{k + 1 if len(rows) > 1 else 0}",
                                   tuple(n for n, s in zip(notes, shown, strict=True) if s)))  # fmt: skip
        panels.append(Panel(
            Axis("frequency", "kHz", zero=True), Axis("force, 0-peak", "N", log=True), tuple(stems), title=title
        ))  # fmt: skip
    rpm = f"{float(forces.speed[0]) * _RPM:.6g} rpm"
    return Figure(
        f"pair_force_spectrum_{name}",
        f"Spectrum of the forces in pair {name}",
        f"Pair {name} at {rpm} of the driver: lines of the force along the tooth normal and of the bearing forces "
        "along the line of action and the axis.",
        tuple(panels), under=rpm,
    )  # fmt: skip
