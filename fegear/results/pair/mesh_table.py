"""Mesh stiffness and transmission error evenly spaced over one tooth of the driver, for programs that want them so.

Curves of a transmission error have their rows where they bend and jump. Programs that integrate a train read a table of
even steps and repeat it. What even steps lose is said: their means are compared with those of the curves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.contact.error_over_pitch import ErrorOverPitch, over_pitch
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark

#: What is tabulated.
_NAMES = ("te", "mesh_stiffness", "local_stiffness")


@dataclass(frozen=True)
class EvenMesh:
    """Curves of a transmission error at the nominal load, in even steps over one tooth of the driver.

    Parameters
    ----------
    te, mesh_stiffness, local_stiffness : ndarray, shape (N,)
        [m], [N/m], [N/m].
    te_error : ndarray, shape (N,), or None
        [m].
    te_0 : ndarray, shape (N,)
        [m].
    lost : mapping of str to float
        How far means over the rows are from those of the curves, as shares of these.
    driver_angle : ndarray, shape (N,)
        [rad]; the row that would repeat the first is not among them.
    from_pitch_point : ndarray, shape (N,)
        The same, counted as in all other tables [rad].
    """

    te: Array
    mesh_stiffness: Array
    local_stiffness: Array
    te_error: Array | None
    te_0: Array
    lost: dict[str, float]
    driver_angle: Array = shown("deg", "rotation of the driver, from the start of the curve over the base pitch")
    from_pitch_point: Array = shown(
        "deg", "rotation of the driver, zero with a tooth pair at the pitch point", name="driver_angle_from_pitch_point"
    )


def even_mesh(e: ErrorOverPitch, count: int) -> EvenMesh:
    """Curves of a pair at its nominal load at so many even steps."""
    pitch = e.pair.base_pitch
    part = np.arange(count) / count
    te, secant, local, start = (over_pitch(e.x, getattr(e, key)[:, e.at], pitch, part) for key in (*_NAMES, "te_0"))
    lost = {
        "transmission error": te.mean() / float(e.te_mean[e.at]) - 1.0,
        "tangent stiffness": local.mean() / float(e.local_stiffness_mean[e.at]) - 1.0,
    }
    error = None if e.te_error is None else over_pitch(e.x, e.te_error, pitch, part)
    angle = part * pitch / e.pair.driver.base_radius
    from_pitch_point = angle + e.x[0] / e.pair.driver.base_radius
    return EvenMesh(te, secant, local, error, start, lost, angle, from_pitch_point)


def _what_even_steps_lose(seen: Seen) -> str:
    mesh: EvenMesh = seen.data.even
    means = " and ".join(f"the {what} by {percent(share, signed=True)}" for what, share in mesh.lost.items())
    return (
        f"Pair {seen.name}: the table mesh_table_{seen.name} has {mesh.te.size} equal steps over one driver tooth "
        f"({np.degrees(seen.data.found.pair.base_pitch / seen.data.found.pair.driver.base_radius):.6g} deg, "
        f"periodic). Means differ from the curves: {means}; increase even_positions to reduce this."
    )


#: Of a result whose data have an `EvenMesh` as ``even``, None where none was asked for.
MESH_TABLE = Rows(
    "mesh_table_{name}",
    "Mesh of {name} over one tooth of the driver, {load:said}",
    (
        "driver_angle",
        *(Cell(key, si=f"even.{key}", of=lambda _: ErrorOverPitch) for key in (*_NAMES, "te_error")),
        "from_pitch_point",
        Cell("te_0", si="even.te_0", of=lambda _: ErrorOverPitch),
    ),
    of="even",
    matlab=True,
)
MESH_REMARK = Remark(_what_even_steps_lose, when="even")
