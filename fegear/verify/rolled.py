"""The smallest independent solvers of the rows: a gear rolled against its cutter, contact states tried one by one."""

from __future__ import annotations

import itertools
import math

import numpy as np

from fegear.base.arrays import Array
from fegear.geometry.internal_tooth import InternalTooth


def outside(tooth: InternalTooth, x: Array, y: Array) -> Array:
    """Distance of points from a tooth of the cutter on +y, from the definition of an involute alone [modules]."""
    cutter, alpha = tooth.cutter, tooth.pressure_angle
    pitch = cutter.teeth / 2 / math.cos(tooth.helix_angle)
    base, tip, rho = pitch * math.cos(alpha), pitch + cutter.profile_shift + cutter.addendum, cutter.tip_radius
    half = (math.pi / 2 + 2 * cutter.profile_shift * math.tan(tooth.normal_pressure_angle)) / cutter.teeth
    half += math.tan(alpha) - alpha
    string = math.sqrt((tip - rho) ** 2 - base**2) + rho  # of the flank's last point
    lean = half - string / base
    centre = np.array([math.cos(lean) * (string - rho) + base * math.sin(lean),
                       base * math.cos(lean) - math.sin(lean) * (string - rho)])  # fmt: skip
    x = np.abs(x)
    radius, angle = np.hypot(x, y), np.arctan2(x, y)
    length = np.sqrt(np.maximum(radius**2 - base**2, 0.0))
    from_flank = length - base * (half - angle + np.arctan2(length, base))
    from_flank = np.where(radius < base, np.inf, from_flank)
    beside = np.arctan2(x - centre[0], y - centre[1])
    from_rounding = np.hypot(x - centre[0], y - centre[1]) - rho
    tip_side = angle < math.atan2(*centre)
    return np.where(tip_side, radius - tip, np.where(beside <= math.pi / 2 + lean, from_rounding, from_flank))


def nearest(tooth: InternalTooth, points: Array, sweep: float = 1.3) -> Array:
    """Least distance of points (2, N) of a gear from a tooth of its cutter as both roll [modules]."""
    # the gear's tooth on +y; its space to the right is put on +y
    half = math.pi / tooth.teeth
    u, v = (
        points[0] * math.cos(half) - points[1] * math.sin(half),
        points[1] * math.cos(half) + points[0] * math.sin(half),
    )

    def at(turn: Array) -> Array:
        one, other = turn * tooth.cutter.teeth / tooth.teeth, turn
        x, y = u * np.cos(one) + v * np.sin(one), v * np.cos(one) - u * np.sin(one)
        y = y - tooth.generating_distance
        return outside(tooth, x * np.cos(other) - y * np.sin(other), y * np.cos(other) + x * np.sin(other))

    turns = np.linspace(-sweep, sweep, 2001)[:, None]
    step = 2.0 * sweep / 2000
    best = turns[np.argmin(at(turns), axis=0), 0]
    for _ in range(4):
        near = best + np.linspace(-1.0, 1.0, 41)[:, None] * step
        best = near[np.argmin(at(near), axis=0), np.arange(best.size)]
        step /= 15.0
    return at(best)


def enumerated(linear: Array, rows: Array, k: Array, gap: Array, load: Array) -> Array | None:
    """Equilibrium of one-sided springs by trying every state of contact; forces of the one that is consistent."""
    for state in itertools.product([True, False], repeat=len(rows)):
        on = np.array(state)
        matrix = linear + (rows[on].T * k[on]) @ rows[on]
        z, *_ = np.linalg.lstsq(matrix, load + rows[on].T @ (k[on] * gap[on]), rcond=1e-12)
        if np.max(np.abs(matrix @ z - load - rows[on].T @ (k[on] * gap[on]))) > 1e-9 * np.max(np.abs(load)):
            continue
        strain = rows @ z - gap
        if np.all(strain[on] >= -1e-18) and np.all(strain[~on] <= 1e-18):
            return np.where(on, k * strain, 0.0)
    return None
