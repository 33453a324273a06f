"""Taylor coefficients of the motion between two events, and the step that they allow."""

from __future__ import annotations

import math
from typing import Any

from fegear.dynamics.motion.kernel.polynomials import value_at


def _damping_series(meshes: Any, springs: Any, work: Any, status: Any) -> None:
    """Series of the damping coefficient of each gear pair: none apart, constant, or C sqrt(K(t) / mean K)."""
    rub, length = work.rub, work.rub.shape[1]
    for m in range(meshes.approach.shape[0]):
        touching = False
        for s in range(springs.mesh_of.shape[0]):
            if springs.mesh_of[s] == m and status[s] == 1:
                touching = True
        rub[m, 0] = meshes.damping[m] if touching else 0.0
        if meshes.momentary[m] == 0 or rub[m, 0] == 0.0:
            continue
        for k in range(length):
            rub[m, k] = 0.0
        for s in range(springs.mesh_of.shape[0]):
            if springs.mesh_of[s] == m and status[s] == 1:
                for k in range(min(length, work.local.shape[2])):
                    rub[m, k] += work.local[s, 0, k]
        if rub[m, 0] <= 0.0:
            rub[m, 0] = 0.0
            continue
        # the square root of the series, term by term in its place
        square = meshes.damping[m] ** 2 / meshes.stiffness[m]
        rub[m, 0] = math.sqrt(square * rub[m, 0])
        for k in range(1, length):
            value = square * rub[m, k]
            for q in range(1, k):
                value -= rub[m, q] * rub[m, k - q]
            rub[m, k] = value / (2.0 * rub[m, 0])


def damping_at(meshes: Any, springs: Any, work: Any, status: Any, m: int, t: float) -> float:
    """Damping coefficient of mesh m at time t of the step."""
    total, touching = 0.0, False
    for s in range(springs.mesh_of.shape[0]):
        if springs.mesh_of[s] == m and status[s] == 1:
            touching = True
            total += value_at(work.local[s, 0], t)
    if not touching:
        return 0.0
    if meshes.momentary[m] == 0:
        return meshes.damping[m]
    return meshes.damping[m] * math.sqrt(max(total, 0.0) / meshes.stiffness[m])


def swing_at(train: Any, i: int, t: float) -> float:
    """Fluctuating force on coordinate i at a time."""
    value = 0.0
    for line in range(train.swing_rate.shape[0]):
        value += train.swing[line, i] * math.cos(train.swing_rate[line] * t + train.swing_phase[line])
    return value


def _swing_series(train: Any, work: Any, t: float) -> None:
    """Series of the fluctuating forces about a time."""
    swing, order = work.swing, work.swing.shape[1] - 1
    for i in range(swing.shape[0]):
        for k in range(order + 1):
            swing[i, k] = 0.0
    for line in range(train.swing_rate.shape[0]):
        rate = train.swing_rate[line]
        at = rate * t + train.swing_phase[line]
        # one derivative after the other: cos, -sin, -cos, sin
        now, following, power = math.cos(at), -math.sin(at), 1.0
        for k in range(order + 1):
            for i in range(swing.shape[0]):
                swing[i, k] += train.swing[line, i] * now * power
            now, following = following, -now
            power *= rate / (k + 1.0)


def motion_series(  # noqa: C901  (one recurrence)
    train: Any, meshes: Any, springs: Any, work: Any, status: Any, x: Any, v: Any, friction: bool, t: float
) -> None:
    """Taylor coefficients of the motion, of loads and of damping forces from a state at time t on."""
    X, strain, load, local, acceleration = work.X, work.strain, work.load, work.local, work.acceleration
    rub, rate, slide = work.rub, work.rate, work.slide
    K, C, f = train.K, train.C, train.f
    approach, lever, mesh_of = meshes.approach, meshes.lever, springs.mesh_of
    order, n, columns = X.shape[0] - 1, X.shape[1], X.shape[2]
    degree = local.shape[2] - 1
    swings = train.swing_rate.shape[0] > 0
    if swings:
        _swing_series(train, work, t)
    _damping_series(meshes, springs, work, status)
    for i in range(n):
        for c in range(columns):
            X[0, i, c] = x[i, c]
            X[1, i, c] = v[i, c]
    for k in range(order - 1):
        for i in range(n):
            for c in range(columns):
                acceleration[i, c] = 0.0
            if k == 0:
                acceleration[i, 0] = f[i]
            if swings:
                acceleration[i, 0] += work.swing[i, k]
            for j in range(n):
                a, b = K[i, j], C[i, j] * (k + 1)
                if a != 0.0 or b != 0.0:
                    for c in range(columns):
                        acceleration[i, c] -= a * X[k, j, c] + b * X[k + 1, j, c]
        for m in range(approach.shape[0]):
            slide[m, k] = 0.0
            if rub[m, 0] == 0.0:
                continue
            reach = k if meshes.momentary[m] == 1 else 0
            for c in range(columns):
                value = 0.0
                for i in range(n):
                    value += approach[m, i] * X[k + 1, i, c]
                rate[m, k, c] = value * (k + 1)
                value = 0.0
                for q in range(reach + 1):
                    value += rub[m, q] * rate[m, k - q, c]
                for i in range(n):
                    acceleration[i, c] -= approach[m, i] * value
                if c == 0:
                    slide[m, k] = value
        for s in range(mesh_of.shape[0]):
            if status[s] == 0:
                continue
            m = mesh_of[s]
            for c in range(columns):
                value = 0.0
                for i in range(n):
                    value += approach[m, i] * X[k, i, c]
                if c == 0 and k <= degree:
                    value -= local[s, 1, k]
                strain[s, k, c] = value
                value = 0.0
                for q in range(min(k, degree) + 1):
                    value += local[s, 0, q] * strain[s, k - q, c]
                load[s, k, c] = value
                for i in range(n):
                    acceleration[i, c] -= approach[m, i] * value
                if friction:
                    at_a, at_b = 0.0, 0.0
                    for q in range(min(k, degree) + 1):
                        at_a += local[s, 2, q] * load[s, k - q, c]
                        at_b += local[s, 3, q] * load[s, k - q, c]
                    for i in range(n):
                        acceleration[i, c] += lever[m, 0, i] * at_a + lever[m, 1, i] * at_b
        for i in range(n):
            for c in range(columns):
                X[k + 2, i, c] = acceleration[i, c] / ((k + 1.0) * (k + 2.0))


def taylor_step(train: Any, rule: Any, X: Any, x: Any, v: Any) -> float:
    """Step length from the last two coefficients."""
    order, n, columns = X.shape[0] - 1, X.shape[1], X.shape[2]
    last, other = 1e-300, 1e-300
    swings = train.swing_rate.shape[0] > 0
    for i in range(n):
        if train.free[i] == 1 or swings:  # a torque may swing the whole train, whose angle has no place to miss
            last = max(last, abs(X[order, i, 0]))
            other = max(other, abs(X[order - 1, i, 0]))
    # tangents need fewer digits, but a stiff mode that the motion leaves alone must not blow them up
    worst = 1e-300
    for c in range(1, columns):
        size = 1.0
        for i in range(n):
            size = max(size, abs(x[i, c]), abs(v[i, c]))
        for i in range(n):
            worst = max(worst, abs(X[order, i, c]) / size, abs(X[order - 1, i, c] * 0.1) / size)
    longest_tangent = (1e-10 / worst) ** (1.0 / order) if columns > 1 else math.inf
    return 0.9 * min(
        (rule.tolerance / last) ** (1.0 / order),
        (rule.tolerance / other) ** (1.0 / (order - 1)),
        rule.longest / 0.9,
        longest_tangent,
    )
