"""Mesh stiffness and transmission error evenly spaced over one tooth of the driver, for programs that want them so.

Curves of a transmission error have their rows where they bend and jump. Programs that integrate a train read a table of
even steps and repeat it. What even steps lose is said: their means are compared with those of the curves.
"""

from __future__ import annotations

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.loaded_teeth import ErrorOverPitch
from fegear.engine.declared import column_of
from fegear.engine.table import Column, Table

#: What is tabulated.
_NAMES = ("te", "mesh_stiffness", "local_stiffness")


def mesh_table(name: str, e: ErrorOverPitch, count: int) -> tuple[Table, list[str]]:
    """The table of a pair at its nominal load, and what is to be said of it.

    Parameters
    ----------
    name : str
        Of the pair.
    e : ErrorOverPitch
    count : int
        Rows over the base pitch; the one that would repeat the first is not among them.
    """
    pitch = e.pair.base_pitch
    part = np.arange(count) / count
    angle = part * pitch / e.pair.driver.base_radius
    even = {key: over_pitch(e.x, getattr(e, key)[:, e.at], pitch, part) for key in _NAMES}
    columns = [Column("driver_angle", angle, "deg", "of the driver, from where the curve of the base pitch begins")]
    columns += [column_of(e, key, even[key]) for key in _NAMES]
    if e.te_error is not None:
        columns.append(column_of(e, "te_error", over_pitch(e.x, e.te_error, pitch, part)))
    slope = float(e.local_stiffness_mean[e.at])
    lost = {
        "transmission error": even["te"].mean() / float(e.te_mean[e.at]) - 1.0,
        "slope stiffness": even["local_stiffness"].mean() / slope - 1.0,
    }
    means = " and ".join(f"that of the {what} by {share:+.1e}" for what, share in lost.items())
    said = (
        f"Pair {name}: the table mesh_table_{name} has {count} even steps over one tooth of the driver, "
        f"{np.degrees(pitch / e.pair.driver.base_radius):.6g} degrees, and repeats from there. Its means differ from "
        f"those of the curves: {means}; more even_positions bring them nearer."
    )
    title = f"Mesh of {name} over one tooth of the driver, {e.load:.6g} N"
    return Table(f"mesh_table_{name}", tuple(columns), title, matlab=True), [said]


def over_pitch(x: Array, values: Array, pitch: float, part: Array) -> Array:
    """A curve straight between its rows and periodic, at parts of the base pitch counted from its first row."""
    inside = x < x[0] + pitch
    at, found = np.append(x[inside], x[0] + pitch), np.append(values[inside], values[0])
    return np.asarray(np.interp(x[0] + part * pitch, at, found))
