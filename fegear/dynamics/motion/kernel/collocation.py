"""One long step of implicit collocation (Radau IIA), for motion that only follows slowly turning teeth."""

from __future__ import annotations

from typing import Any

import numpy as np

from fegear.dynamics.motion.kernel.polynomials import value_at
from fegear.dynamics.motion.kernel.series import damping_at, swing_at


def _matrices_at(
    train: Any, meshes: Any, springs: Any, work: Any, status: Any, t: float, K: Any, C: Any, f: Any, start: float
) -> None:
    """Stiffness, damping and force of the whole train at time t of the step, teeth in contact included."""
    n = train.K.shape[0]
    swings = train.swing_rate.shape[0] > 0
    for i in range(n):
        f[i] = train.f[i]
        if swings:
            f[i] += swing_at(train, i, start + t)
        for j in range(n):
            K[i, j], C[i, j] = train.K[i, j], train.C[i, j]
    for m in range(meshes.approach.shape[0]):
        rub = damping_at(meshes, springs, work, status, m, t)
        for i in range(n):
            for j in range(n):
                C[i, j] += rub * meshes.approach[m, i] * meshes.approach[m, j]
    for s in range(springs.mesh_of.shape[0]):
        if status[s] == 0:
            continue
        m = springs.mesh_of[s]
        k, e = value_at(work.local[s, 0], t), value_at(work.local[s, 1], t)
        at_a, at_b = value_at(work.local[s, 2], t), value_at(work.local[s, 3], t)
        for i in range(n):
            push = meshes.approach[m, i] - at_a * meshes.lever[m, 0, i] - at_b * meshes.lever[m, 1, i]
            f[i] += push * k * e
            for j in range(n):
                K[i, j] += push * k * meshes.approach[m, j]


def collocate(  # noqa: C901  (loops over nodes, coordinates and tangents)
    train: Any, meshes: Any, springs: Any, rule: Any, radau: Any, work: Any, status: Any, x: Any, v: Any, h: float,
    start: float,
) -> bool:  # fmt: skip
    """One step of length h from time `start`, into the series of `work`; False where that misses the tolerance.

    The stage accelerations G solve G_i + C_i V_i + K_i X_i = f_i with V = v + h A G and X = x + h A V. A vibration
    that the step is too long for is damped at the nodes but not at its start, and shows in the polynomial's tail.
    """
    n, columns = x.shape
    S = radau.nodes.shape[0]
    A = radau.integrate
    K, C, f = np.zeros((n, n)), np.zeros((n, n)), np.zeros(n)
    matrix, right = np.zeros((S * n, S * n)), np.zeros((S * n, columns))
    row = np.zeros(S)  # of A squared
    for a in range(S):
        t = radau.nodes[a] * h
        _matrices_at(train, meshes, springs, work, status, t, K, C, f, start)
        for b in range(S):
            row[b] = 0.0
            for q in range(S):
                row[b] += A[a, q] * A[q, b]
        for i in range(n):
            for b in range(S):
                for j in range(n):
                    matrix[a * n + i, b * n + j] = h * h * row[b] * K[i, j] + h * A[a, b] * C[i, j]
            matrix[a * n + i, a * n + i] += 1.0
            for c in range(columns):
                value = f[i] if c == 0 else 0.0
                for j in range(n):
                    value -= K[i, j] * (x[j, c] + t * v[j, c]) + C[i, j] * v[j, c]
                right[a * n + i, c] = value
    if not _solve(matrix, right):
        return False
    G = right
    # values at zero and at the nodes, and the polynomial through them
    path, speed = np.zeros((S + 1, n, columns)), np.zeros((S + 1, n, columns))
    for i in range(n):
        for c in range(columns):
            path[0, i, c], speed[0, i, c] = x[i, c], v[i, c]
    for a in range(S):
        for i in range(n):
            for c in range(columns):
                value = v[i, c]
                for b in range(S):
                    value += h * A[a, b] * G[b * n + i, c]
                speed[a + 1, i, c] = value
    for a in range(S):
        for i in range(n):
            for c in range(columns):
                value = x[i, c]
                for b in range(S):
                    value += h * A[a, b] * speed[b + 1, i, c]
                path[a + 1, i, c] = value
    for c in range(columns):
        size = 1.0
        for i in range(n):
            if train.free[i] == 1 or c > 0:
                size = max(size, abs(x[i, c]), abs(v[i, c]))
        bound = max(rule.tolerance, 1e-14 * size) if c == 0 else 1e-10 * size
        for i in range(n):
            for p in (S - 1, S):
                off, slip = 0.0, 0.0
                for a in range(S + 1):
                    off += radau.legendre[p, a] * path[a, i, c]
                    slip += radau.legendre[p, a] * speed[a, i, c]
                if (train.free[i] == 1 and not abs(off) <= bound) or not abs(slip) <= bound:
                    return False
    if not _long_loads(meshes, springs, radau, work, status, path, speed, h, rule.tolerance):
        return False
    at, powers = np.zeros(S + 1), np.zeros(work.X.shape[0])
    for i in range(n):
        for c in range(columns):
            for a in range(S + 1):
                at[a] = path[a, i, c]
            _to_powers(radau, at, h, powers)
            for k in range(work.X.shape[0]):
                work.X[k, i, c] = powers[k]
    return True


def _to_powers(radau: Any, values: Any, h: float, out: Any) -> float:
    """Powers of time of the polynomial through values at 0 and the nodes; the larger of its last two Legendre parts."""
    nodes = values.shape[0]
    out[:] = 0.0
    largest = 0.0
    for p in range(nodes):
        part = 0.0
        for a in range(nodes):
            part += radau.legendre[p, a] * values[a]
        if p >= nodes - 2:
            largest = max(largest, abs(part))
        for k in range(p + 1):
            out[k] += radau.powers[k, p] * part
    for k in range(nodes):
        out[k] /= h**k
    return largest


def _solve(matrix: Any, right: Any) -> bool:  # noqa: C901  (elimination)
    """Gaussian elimination with pivoting, the solution in place of `right`; False if the matrix is singular."""
    n, columns = right.shape
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if not abs(matrix[best, k]) > 0.0:
            return False
        if best != k:
            for j in range(k, n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
            for c in range(columns):
                right[k, c], right[best, c] = right[best, c], right[k, c]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    matrix[i, j] -= factor * matrix[k, j]
                for c in range(columns):
                    right[i, c] -= factor * right[k, c]
    for k in range(n - 1, -1, -1):
        for c in range(columns):
            value = right[k, c]
            for j in range(k + 1, n):
                value -= matrix[k, j] * right[j, c]
            right[k, c] = value / matrix[k, k]
    return True


def _long_loads(
    meshes: Any, springs: Any, radau: Any, work: Any, status: Any, path: Any, speed: Any, h: float, tolerance: float
) -> bool:
    """Series of spring loads and damping forces over a long step; False where they miss the tolerance."""
    n, nodes = path.shape[1], radau.nodes.shape[0] + 1
    at, powers = np.zeros(nodes), np.zeros(work.X.shape[0])
    for number in range(springs.mesh_of.shape[0] + meshes.approach.shape[0]):
        s = number
        m = springs.mesh_of[s] if s < springs.mesh_of.shape[0] else number - springs.mesh_of.shape[0]
        size = 1.0
        for a in range(nodes):
            t = radau.nodes[a - 1] * h if a > 0 else 0.0
            value = 0.0
            if s < springs.mesh_of.shape[0]:
                for i in range(n):
                    value += meshes.approach[m, i] * path[a, i, 0]
                value = (
                    value_at(work.local[s, 0], t) * (value - value_at(work.local[s, 1], t)) if status[s] == 1 else 0.0
                )
            else:
                for i in range(n):
                    value += meshes.approach[m, i] * speed[a, i, 0]
                value *= damping_at(meshes, springs, work, status, m, t)
            at[a] = value
            size = max(size, abs(value))
        if not _to_powers(radau, at, h, powers) <= max(tolerance, 1e-14 * size):
            return False
        for k in range(powers.shape[0]):
            if s < springs.mesh_of.shape[0]:
                work.load[s, k, 0] = powers[k]
            else:
                work.slide[m, k] = powers[k]
    return True
