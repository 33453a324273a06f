"""Lines of torque ripple in the spectrum of a mesh force: tables, values and what figures show of them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.declared import column_of
from fegear.engine.figure.items import Points, Stems
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.train.gear_train import RPM

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.torque_response import RippleSpectrum


def _names(found: RippleSpectrum) -> Array:
    return np.array([found.ripple[k].name for k in found.of], dtype=str)


def _sizes(mesh: int, found: RippleSpectrum) -> Array:
    """Amplitudes of the force in a mesh [N], shape (lines, speeds)."""
    return np.abs(found.forces[mesh])


def ripple_values(name: str, mesh: int, found: RippleSpectrum) -> tuple[Value, ...]:
    """Largest line and root mean square of each ripple in a mesh, at the one speed."""
    size, whose = _sizes(mesh, found)[:, 0], np.array(found.of)
    values = []
    for k, one in enumerate(found.ripple):
        own = size[whose == k]
        at = int(one.harmonics[int(np.argmax(own))])
        where = f"amplitude, torque ripple {one.name}" + (f", its harmonic {at}" if own.size > 1 else "")
        rms = math.sqrt(0.5 * float(np.sum(own**2)))
        values += [
            Value(f"{name}.largest_line_from_{one.name}", float(own.max()), "N", None, where),
            Value(f"{name}.rms_from_{one.name}", rms, "N", None, "root mean square of all spectral lines"),
        ]
    return tuple(values)


def ripple_table(name: str, mesh: int, found: RippleSpectrum) -> Table:
    """Every line at the one speed."""
    force = found.forces[mesh, :, 0]
    columns = (
        Column("ripple", _names(found), "", "exciting torque ripple"),
        column_of(found, "harmonics"),
        column_of(found, "frequencies", found.frequencies[:, 0]),
        Column("torque", np.abs(found.torques), "N.m", "0-peak"),
        Column("force", np.abs(force), "N", "0-peak"),
        Column("phase", np.angle(force), "deg", "phase of the force (cosine) at time zero"),
        column_of(found, "power_lines", found.power_lines[mesh, :, 0]),
    )
    return Table(f"torque_ripple_spectrum_{name}", columns, f"Lines of torque ripple in the force in mesh {name}")


def ripple_waterfall_table(name: str, mesh: int, found: RippleSpectrum, data: GearTrain) -> Table:
    """Every line at every speed."""
    speeds = found.speeds.size
    columns = (
        Column("speed", np.tile(found.speeds * data.speed_ratio, len(found.of)), "rpm", f"speed of {data.speed_of}"),
        Column("ripple", np.repeat(_names(found), speeds), "", "exciting torque ripple"),
        column_of(found, "harmonics", np.repeat(found.harmonics, speeds)),
        column_of(found, "frequencies", found.frequencies.ravel()),
        Column("force", _sizes(mesh, found).ravel(), "N", "0-peak"),
    )
    return Table(
        f"torque_ripple_waterfall_{name}", columns, f"Lines of torque ripple in the force in mesh {name} over speed"
    )


def ripple_stems(mesh: int, found: RippleSpectrum, first: int) -> list[Stems]:
    """Lines at the one speed, each ripple a series of its own after those of the meshes."""
    size, whose = _sizes(mesh, found)[:, 0], np.array(found.of)
    drawn = []
    for k, one in enumerate(found.ripple):
        own = (whose == k) & (size > 0.0)
        notes = tuple(f"harmonic {n}" for n in found.harmonics[own])
        x = found.frequencies[own, 0] * 1e-3
        drawn.append(Stems(x, size[own], f"from torque ripple {one.name}", f"series:{first + k}", notes))
    return drawn


def ripple_points(mesh: int, found: RippleSpectrum, data: GearTrain) -> list[Points]:
    """Lines over speed."""
    size, whose = _sizes(mesh, found), np.array(found.of)
    speed = np.broadcast_to(found.speeds * data.speed_ratio * RPM, size.shape)
    return [
        Points(
            found.frequencies[whose == k].ravel() * 1e-3, speed[whose == k].ravel(), f"torque ripple {one.name}",
            f"series:{len(data.names) + k}", "x", size=5.0,
            notes=tuple(f"{force:.4g} N" for force in size[whose == k].ravel()),
        )
        for k, one in enumerate(found.ripple)
    ]  # fmt: skip
