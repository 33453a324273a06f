"""Rigs of four inertias, and their motion by scipy: written from the equations of TM-100180 alone.

Equations 1 to 4 and 19 to 24, repaired: a list of springs, a right-hand side, events; it shares no code with the
integrator that it is compared with.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from fegear.base.arrays import Array
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import SteadyState, steady_state
from fegear.dynamics.train.charts import FourInertia
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic

R = 0.04177
JUMPS = (0.32, 0.68, 1.0)
STIFFNESS = (4.2e8, 2.6e8, 4.2e8)


def four_inertia(force: float, backlash: float, shaft_ratio: float) -> FourInertia:
    """Motor, two gears and load; SI."""
    j = 1.22e-3
    return FourInertia(10 * j, j, j, 10 * j, 2.18e4, 2.18e4, R, R, 28, 28, force, shaft_ratio, 0.08, backlash)


def excitation(amplitude: float = 0.0) -> MeshExcitation:
    """Stiffness that jumps twice per base pitch, and a transmission error of one harmonic."""
    k = Periodic.through_points([0, 0.32, 0.32, 0.68, 0.68, 1], [4.2e8, 4.2e8, 2.6e8, 2.6e8, 4.2e8, 4.2e8])
    if amplitude == 0.0:
        return MeshExcitation.from_mesh(k)
    e = Periodic.fit(lambda s: amplitude * np.cos(2 * np.pi * s), degree=10, tolerance=1e-13)
    return MeshExcitation.from_mesh(k, e)


@dataclass
class _Event:
    """Where scipy stops: a function that becomes zero, in one direction."""

    of: Callable[[float, Array], float]
    direction: float
    terminal: bool = True

    def __call__(self, t: float, y: Array, *_: Any) -> float:
        return self.of(t, y)


def reference(
    system: FourInertia, rpm: float, amplitude: float, periods: int, method: str, rtol: float,
    start: Array | None = None, mesh: tuple[tuple[float, ...], tuple[float, ...]] = (STIFFNESS, JUMPS), looked: int = 2,
    behind: float = 0.0,
) -> tuple[float, int, Array]:  # fmt: skip
    """By scipy: largest mesh force and contact changes over the last periods, and the state at the end.

    `behind` is a constant stiffness of the back flanks [N/m]; without it they are as stiff as the others.
    """
    stiffness, jumps = mesh
    mean = np.dot(stiffness, np.diff(jumps, prepend=0.0))
    j = np.array([system.motor, system.gear_1, system.gear_2, system.load])
    cs = 2 * system.shaft_ratio * math.sqrt(system.shaft_1 / (1 / j[0] + 1 / j[1]))
    cg = 2 * system.mesh_ratio * math.sqrt(mean * j[1] * j[2] / (R * R * (j[1] + j[2])))
    w, s, ks = system.force, system.backlash, system.shaft_1
    f = 28 * rpm / 60
    torque = np.array([w * R, 0.0, 0.0, -w * R])

    def e(t: float) -> float:
        return amplitude * math.cos(2 * math.pi * f * t)

    def force(t: float, y: Array, mode: int, k: float) -> float:
        rate = R * (y[5] - y[6])
        x = R * (y[1] - y[2])
        return (k * (x - e(t)) + cg * rate, 0.0, (behind or k) * (x + s) + cg * rate)[mode]

    def rhs(t: float, y: Array, mode: int, k: float) -> Array:
        a, b = ks * (y[0] - y[1]) + cs * (y[4] - y[5]), ks * (y[2] - y[3]) + cs * (y[6] - y[7])
        m = R * force(t, y, mode, k)
        return np.concatenate([y[4:], (torque + np.array([-a, a - m, m - b, b])) / j])

    # static state: the mesh carries w, the shafts w R
    x0 = w / stiffness[0] + amplitude
    angle = np.array([w * R / ks + x0 / R, x0 / R, 0.0, -w * R / ks])
    y = np.concatenate([angle, np.zeros(4)]) if start is None else start
    t, largest, changes = 0.0, -math.inf, 0
    mode = 0 if R * (y[1] - y[2]) > e(0.0) else (2 if R * (y[1] - y[2]) < -s else 1)
    for n in range(periods):
        for k, jump in zip(stiffness, jumps, strict=True):
            end = (n + jump) / f
            while t < end:
                front = _Event(lambda t, y: R * (y[1] - y[2]) - e(t), -1.0 if mode == 0 else 1.0)
                back = _Event(lambda _t, y: R * (y[1] - y[2]) + s, 1.0 if mode == 2 else -1.0)
                events = [[front], [front, back], [back]][mode] if math.isfinite(s) else [front]
                run = solve_ivp(rhs, (t, end), y, method, events=events, args=(mode, k), rtol=rtol,
                                atol=rtol * 1e-6, dense_output=n >= periods - looked)  # fmt: skip
                if n >= periods - looked and mode != 1:
                    fine = np.linspace(t, run.t[-1], 200)
                    values = [force(u, run.sol(u), mode, k) for u in fine]
                    i = int(np.argmax(values))
                    a, b = fine[max(i - 1, 0)], fine[min(i + 1, 199)]
                    best = minimize_scalar(lambda u, run=run, mode=mode, k=k: -force(u, run.sol(u), mode, k),
                                           bounds=(a, b), method="bounded", options={"xatol": 1e-14})  # fmt: skip
                    largest = max(largest, values[i], -best.fun)
                t, y = run.t[-1], run.y[:, -1]
                if run.status == 1:
                    changes += n >= periods - looked
                    mode = (0 if len(run.t_events[0]) else 2) if mode == 1 else 1
    return largest, changes, y


def shooting(system: FourInertia, rpm: float, amplitude: float, tolerance: float) -> SteadyState:
    """fegear's steady motion of a rig."""
    train = system.train(0.64 * 4.2e8 + 0.36 * 2.6e8)
    return steady_state(MotionModel(train, (excitation(amplitude),), rpm * math.pi / 30), tolerance=tolerance)


CASES = {
    # rpm, backlash, amplitude of the transmission error, mean force, damping ratio of the shafts
    "always in contact": (5000.0, math.inf, 0.0, 8890.0, 0.8),
    "loss of contact": (10500.0, math.inf, 0.0, 8890.0, 0.1),
    "loss of contact and back-side contact": (7500.0, 1.2e-5, 1.08e-5, 1000.0, 0.8),
}
