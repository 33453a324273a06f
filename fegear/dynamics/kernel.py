"""The hot loop of motion: Taylor series of a train with periodic one-sided springs, event by event (numba).

Between changes of contact and break points of the periodic functions the accelerations are linear in the state with
coefficients that are analytic in time, so the Taylor coefficients of the motion follow from a recurrence, to any order
and without function evaluations; the step is as long as the tolerance allows, and the polynomial is the dense output
in which changes of contact and largest forces are found. Tangents (for the monodromy matrix) ride along as columns.

Where the vibration after an impact has died away and the motion only follows the slowly turning teeth, one step of
implicit collocation (Radau IIA) takes the place of thousands of Taylor steps: the time at low speed is that of
settling, not that of a turn.

The functions here are plain Python on arrays; `compiled` turns them into machine code at first use. They share one
file because numba keeps machine code by the age of the file of the caller alone: a helper in a file of its own could
change without its callers being compiled again.
"""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

#: What `run` reports: all well; too many steps; too many changes of contact (the teeth chatter).
DONE, TOO_MANY_STEPS, TOO_MANY_EVENTS = 0, 1, 2


#: Least length of a collocation step, and what a failed one waits for, both in Taylor steps; most that the wait grows.
WORTH, WAIT, LONGEST_WAIT = 40.0, 8, 8


class TrainArrays(NamedTuple):
    """The linear part of the train: K, C of shape (n, n), constant forces f (n,), free (n,) 1 where a place matters."""

    K: Any
    C: Any
    f: Any
    free: Any


class MeshArrays(NamedTuple):
    """The gear pairs: approach (meshes, n), friction levers (meshes, 2, n), and damping on the rate of approach.

    `damping` is C at the mean `stiffness`; where `momentary` is 1 it follows the stiffness of the teeth that touch,
    C sqrt(K(t) / stiffness).
    """

    approach: Any
    lever: Any
    damping: Any
    stiffness: Any
    momentary: Any


class SpringArrays(NamedTuple):
    """One-sided springs: their gear pair and side, periods per time and phase, and their polynomial pieces.

    `side`: 1 on the front flanks, -1 on the back flanks, 0 where teeth never part. Spring s has the pieces first[s] to
    first[s + 1]; poly (pieces, 4, degree + 1) holds stiffness, separation and both friction torques.
    """

    mesh_of: Any
    side: Any
    rate: Any
    phase: Any
    first: Any
    cuts: Any
    poly: Any


class Collocation(NamedTuple):
    """Tables of Radau IIA on (0, 1]; see `radau.radau`."""

    nodes: Any
    integrate: Any
    legendre: Any
    powers: Any


class Rule(NamedTuple):
    """How to step: Taylor order, tolerance, longest step, most steps, whether to look for peaks, steps to record."""

    order: int
    tolerance: float
    longest: float
    max_steps: int
    want_peaks: bool
    keep: int


class Travelled(NamedTuple):
    """What `_run` returns: end state, code, counts, extremes, times apart and behind, and the record."""

    x: Any
    v: Any
    code: int
    steps: int
    changes: int
    high: Any
    low: Any
    tooth: Any
    apart: Any
    behind: Any
    times: Any
    polynomials: Any
    contact: Any


class Work(NamedTuple):
    """Arrays of one run.

    Series in time of the motion X (order + 1, n, columns), of strains and loads of the springs, of damping force,
    damping coefficient and rate of approach of the gear pairs; local polynomials of the springs; accelerations; which
    springs exist.
    """

    X: Any
    strain: Any
    load: Any
    slide: Any
    rub: Any
    rate: Any
    local: Any
    acceleration: Any
    exists: Any


# The arrays of these functions are typed by numba from their arguments.
def _horner(row: Any, t: float) -> float:
    value = 0.0
    for k in range(row.shape[0] - 1, -1, -1):
        value = value * t + row[k]
    return value


def _shift(row: Any, v: float, scale: float, out: Any) -> None:
    """Coefficients in time from here on, of a polynomial in v whose v advances by `scale` per unit time."""
    n = row.shape[0]
    for k in range(n):
        out[k] = row[k]
    for j in range(n):
        for k in range(n - 2, j - 1, -1):
            out[k] += v * out[k + 1]
    power = 1.0
    for k in range(n):
        out[k] *= power
        power *= scale


def _root(row: Any, low: float, high: float, sign: float) -> float:
    """Where sign * polynomial falls through zero between low (above zero) and high (not above)."""
    x = 0.5 * (low + high)
    for _ in range(200):
        value, slope = 0.0, 0.0
        for k in range(row.shape[0] - 1, -1, -1):
            slope = slope * x + value
            value = value * x + row[k]
        if sign * value > 0.0:
            low = x
        else:
            high = x
        if high - low <= 4e-16 * high:
            break
        new = x - value / slope if slope != 0.0 else low
        if not (low < new < high):
            new = 0.5 * (low + high)
        if abs(new - x) <= 1e-16 * abs(x):
            x = new
            break
        x = new
    return high if sign * _horner(row, x) > 0.0 else x


def _first_crossing(row: Any, h: float, sign: float) -> float:
    """First time in (0, h] at which sign * polynomial is no longer positive, or -1."""
    reach = 0.0
    power = 1.0
    for k in range(1, row.shape[0]):
        power *= h
        reach += abs(row[k]) * power
    if sign * row[0] > reach:
        return -1.0
    samples = 16
    before, last = 1e-6 * h, sign * _horner(row, 1e-6 * h)
    if last <= 0.0:
        return 0.0
    older_t, older = before, last
    for j in range(1, samples + 1):
        t = h * j / samples
        value = sign * _horner(row, t)
        if value <= 0.0:
            return _root(row, before, t, sign)
        if j > 1 and last < older and last <= value:
            # a dip between samples: look at the bottom of the parabola through them
            d1, d2 = (last - older) / (before - older_t), (value - last) / (t - before)
            bend = (d2 - d1) / (t - older_t)
            if bend > 0.0:
                bottom = 0.5 * (older_t + before) - 0.5 * d1 / bend
                if older_t < bottom < t and sign * _horner(row, bottom) <= 0.0:
                    return _root(row, older_t, bottom, sign)
        older_t, older = before, last
        before, last = t, value
    return -1.0


def _load(force: Any, slide: Any, n_springs: int, mesh_of: Any, m: int, pick: int, t: float) -> float:
    """Force of mesh m at time t of the step, or, for pick >= 0, what spring `pick` carries of it."""
    elastic, own = 0.0, 0.0
    for s in range(n_springs):
        if mesh_of[s] == m:
            value = _horner(force[s], t)
            elastic += value
            if s == pick:
                own = value
    total = elastic + _horner(slide[m], t)
    if pick < 0:
        return total
    return own * total / elastic if elastic != 0.0 else 0.0


def _peak(force: Any, slide: Any, n_springs: int, mesh_of: Any, m: int, pick: int, h: float, sign: float) -> float:
    """Largest of sign * load over one step: samples, then golden section around the best."""
    samples = 12
    best_j, best = 0, -math.inf
    for j in range(samples + 1):
        value = sign * _load(force, slide, n_springs, mesh_of, m, pick, h * j / samples)
        if value > best:
            best_j, best = j, value
    low, high = h * max(best_j - 1, 0) / samples, h * min(best_j + 1, samples) / samples
    golden = 0.6180339887498949
    a, b = high - golden * (high - low), low + golden * (high - low)
    fa = sign * _load(force, slide, n_springs, mesh_of, m, pick, a)
    fb = sign * _load(force, slide, n_springs, mesh_of, m, pick, b)
    for _ in range(36):
        if fa > fb:
            high, b, fb = b, a, fa
            a = high - golden * (high - low)
            fa = sign * _load(force, slide, n_springs, mesh_of, m, pick, a)
        else:
            low, a, fa = a, b, fb
            b = low + golden * (high - low)
            fb = sign * _load(force, slide, n_springs, mesh_of, m, pick, b)
    return max(best, fa, fb)


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


def _rubbing(meshes: Any, springs: Any, work: Any, status: Any, m: int, t: float) -> float:
    """Damping coefficient of mesh m at time t of the step."""
    total, touching = 0.0, False
    for s in range(springs.mesh_of.shape[0]):
        if springs.mesh_of[s] == m and status[s] == 1:
            touching = True
            total += _horner(work.local[s, 0], t)
    if not touching:
        return 0.0
    if meshes.momentary[m] == 0:
        return meshes.damping[m]
    return meshes.damping[m] * math.sqrt(max(total, 0.0) / meshes.stiffness[m])


def _series(  # noqa: C901  (one recurrence)
    train: Any, meshes: Any, springs: Any, work: Any, status: Any, x: Any, v: Any, friction: bool
) -> None:
    """Taylor coefficients of the motion, of loads and of damping forces from a state on."""
    X, strain, load, local, acceleration = work.X, work.strain, work.load, work.local, work.acceleration
    rub, rate, slide = work.rub, work.rate, work.slide
    K, C, f = train.K, train.C, train.f
    approach, lever, mesh_of = meshes.approach, meshes.lever, springs.mesh_of
    order, n, columns = X.shape[0] - 1, X.shape[1], X.shape[2]
    degree = local.shape[2] - 1
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


def _taylor_step(train: Any, rule: Any, X: Any, x: Any, v: Any) -> float:
    """Step length from the last two coefficients."""
    order, n, columns = X.shape[0] - 1, X.shape[1], X.shape[2]
    last, other = 1e-300, 1e-300
    for i in range(n):
        if train.free[i] == 1:
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


def _matrices_at(
    train: Any, meshes: Any, springs: Any, work: Any, status: Any, t: float, K: Any, C: Any, f: Any
) -> None:
    """Stiffness, damping and force of the whole train at time t of the step, teeth in contact included."""
    n = train.K.shape[0]
    for i in range(n):
        f[i] = train.f[i]
        for j in range(n):
            K[i, j], C[i, j] = train.K[i, j], train.C[i, j]
    for m in range(meshes.approach.shape[0]):
        rub = _rubbing(meshes, springs, work, status, m, t)
        for i in range(n):
            for j in range(n):
                C[i, j] += rub * meshes.approach[m, i] * meshes.approach[m, j]
    for s in range(springs.mesh_of.shape[0]):
        if status[s] == 0:
            continue
        m = springs.mesh_of[s]
        k, e = _horner(work.local[s, 0], t), _horner(work.local[s, 1], t)
        at_a, at_b = _horner(work.local[s, 2], t), _horner(work.local[s, 3], t)
        for i in range(n):
            push = meshes.approach[m, i] - at_a * meshes.lever[m, 0, i] - at_b * meshes.lever[m, 1, i]
            f[i] += push * k * e
            for j in range(n):
                K[i, j] += push * k * meshes.approach[m, j]


def _collocate(  # noqa: C901  (loops over nodes, coordinates and tangents)
    train: Any, meshes: Any, springs: Any, rule: Any, radau: Any, work: Any, status: Any, x: Any, v: Any, h: float
) -> bool:
    """One collocation step of length h into the series of `work`; False where its polynomial misses the tolerance.

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
        _matrices_at(train, meshes, springs, work, status, t, K, C, f)
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
                value = _horner(work.local[s, 0], t) * (value - _horner(work.local[s, 1], t)) if status[s] == 1 else 0.0
            else:
                for i in range(n):
                    value += meshes.approach[m, i] * speed[a, i, 0]
                value *= _rubbing(meshes, springs, work, status, m, t)
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


def _run(  # noqa: C901  (one loop over steps: what it shares is its local variables)
    train: Any, meshes: Any, springs: Any, radau: Any, rule: Any,
    x0: Any, v0: Any, t0: float, t1: float, status: Any, fresh: bool,
) -> Any:  # fmt: skip
    """Integrate from t0 to t1; see `packing.Packed` for the arrays.

    x0, v0: (n, columns), column 0 the motion, the others tangents. `status`: 1 where a spring pushes (changed in
    place); `fresh`: set it from the state first.
    """
    n, columns = x0.shape
    order = rule.order
    count, pairs, degree = springs.mesh_of.shape[0], meshes.approach.shape[0], springs.poly.shape[2] - 1
    work = Work(
        np.zeros((order + 1, n, columns)),
        np.zeros((count, order + 1, columns)),
        np.zeros((count, order + 1, columns)),
        np.zeros((pairs, order + 1)),
        np.zeros((pairs, order + 1)),
        np.zeros((pairs, order + 1, columns)),
        np.zeros((count, 4, degree + 1)),
        np.zeros((n, columns)),
        np.zeros(count, np.int64),
    )
    X, local, exists = work.X, work.local, work.exists
    approach, mesh_of, sides = meshes.approach, springs.mesh_of, springs.side
    strain0, load0 = np.zeros((count, order + 1)), np.zeros((count, order + 1))
    piece, turn = np.zeros(count, np.int64), np.zeros(count)
    x, v = x0.copy(), v0.copy()
    high, low = np.full(pairs, -np.inf), np.full(pairs, np.inf)
    tooth = np.zeros(count)
    apart, behind = np.zeros(pairs), np.zeros(pairs)
    record_t = np.zeros(rule.keep + 1)
    record_x = np.zeros((rule.keep, order + 1, n))
    record_status = np.zeros((rule.keep, count), np.int8)
    friction = False
    for p in range(springs.poly.shape[0]):
        for k in range(degree + 1):
            if springs.poly[p, 2, k] != 0.0 or springs.poly[p, 3, k] != 0.0:
                friction = True
    long_steps = math.isinf(rule.longest) and radau.nodes.shape[0] <= order - 2
    t, steps, events, code = t0, 0, 0, DONE
    # what a collocation step costs in Taylor steps: a long train needs a longer stretch for it
    unknowns, taylor = float(radau.nodes.shape[0] * n), float(order * (n * n + 10 * n * columns))
    worth = max(WORTH, (unknowns**3 / 3.0 + unknowns**2 * columns) / taylor)
    shortest = max(WAIT, int(0.25 * worth))
    waited, wait, reach = shortest, shortest, 0.0
    # which piece of its period each spring is in; a break point within round-off belongs to the piece after it
    for s in range(count):
        u = springs.rate[s] * t0 + springs.phase[s]
        turn[s] = math.floor(u + 1e-12)
        u -= turn[s]
        p = springs.first[s]
        while p < springs.first[s + 1] - 1 and u >= springs.cuts[p + s + 1] - 1e-12:
            p += 1
        piece[s] = p
    check = np.ones(count, np.int64)
    if not fresh:
        check[:] = 0
    while t < t1:
        if steps >= rule.max_steps:
            code = TOO_MANY_STEPS
            break
        limit = t1
        for s in range(count):
            p, m = piece[s], mesh_of[s]
            start, end = springs.cuts[p + s], springs.cuts[p + s + 1]
            limit = min(limit, (turn[s] + end - springs.phase[s]) / springs.rate[s])
            u = springs.rate[s] * t + springs.phase[s] - turn[s]
            at = ((u - start) - (end - u)) / (end - start)
            for q in range(4):
                _shift(springs.poly[p, q], at, 2.0 * springs.rate[s] / (end - start), local[s, q])
            exists[s] = 0
            for k in range(degree + 1):
                if springs.poly[p, 0, k] != 0.0:
                    exists[s] = 1
            if check[s] == 1:
                gap, slope = -local[s, 1, 0], -(local[s, 1, 1] if degree > 0 else 0.0)
                for i in range(n):
                    gap += approach[m, i] * x[i, 0]
                    slope += approach[m, i] * v[i, 0]
                side = sides[s]
                pushes = side == 0.0 or side * gap > 0.0 or (gap == 0.0 and side * slope > 0.0)
                status[s] = 1 if exists[s] == 1 and pushes else 0
            check[s] = 0
        _series(train, meshes, springs, work, status, x, v, friction)
        h = _taylor_step(train, rule, X, x, v)
        waited += 1
        if long_steps and waited >= wait and limit - t > worth * h:
            far = min(max(reach, worth * h), limit - t)
            if _collocate(train, meshes, springs, rule, radau, work, status, x, v, far):
                h, reach, wait = far, 8.0 * far, shortest
            else:
                # too long for the teeth's change, or the vibration still lives: shorter next time, then wait
                shorter = 0.25 * far
                if shorter > worth * h:
                    reach = shorter
                else:
                    reach, wait, waited = 0.0, min(2 * wait, LONGEST_WAIT * shortest), 0
                _series(train, meshes, springs, work, status, x, v, friction)
        to_limit = h >= limit - t
        if to_limit:
            h = limit - t
        # the first change of contact on the way
        changed = -1
        for s in range(count):
            if exists[s] == 0 or h == 0.0 or sides[s] == 0.0:
                continue
            for k in range(order + 1):
                value = 0.0
                for i in range(n):
                    value += approach[mesh_of[s], i] * X[k, i, 0]
                strain0[s, k] = value - (local[s, 1, k] if k <= degree else 0.0)
            sign = sides[s] if status[s] == 1 else -sides[s]
            when = _first_crossing(strain0[s], h, sign)
            if when >= 0.0:
                h, changed, to_limit = when, s, False
        # what happened on the step
        for m in range(pairs):
            front, back = False, False
            for s in range(count):
                if mesh_of[s] == m and status[s] == 1:
                    if sides[s] >= 0.0:
                        front = True
                    else:
                        back = True
            if not front and not back:
                apart[m] += h
                high[m], low[m] = max(high[m], 0.0), min(low[m], 0.0)
            elif back:
                behind[m] += h
        if rule.want_peaks and h > 0.0:
            slide = work.slide[:, : order - 1]
            for s in range(count):
                for k in range(order + 1):
                    load0[s, k] = work.load[s, k, 0] if status[s] == 1 and k < order - 1 else 0.0
            for m in range(pairs):
                high[m] = max(high[m], _peak(load0, slide, count, mesh_of, m, -1, h, 1.0))
                low[m] = min(low[m], -_peak(load0, slide, count, mesh_of, m, -1, h, -1.0))
            for s in range(count):
                if status[s] == 1:
                    sign = -1.0 if sides[s] < 0.0 else 1.0
                    value = _peak(load0, slide, count, mesh_of, mesh_of[s], s, h, sign)
                    tooth[s] = max(tooth[s], value)
        if steps < rule.keep:
            record_t[steps] = t
            for k in range(order + 1):
                for i in range(n):
                    record_x[steps, k, i] = X[k, i, 0]
            for s in range(count):
                record_status[steps, s] = status[s]
            record_t[steps + 1] = t + h
        steps += 1
        for i in range(n):
            for c in range(columns):
                value, slope = 0.0, 0.0
                for k in range(order, -1, -1):
                    slope = slope * h + value
                    value = value * h + X[k, i, c]
                x[i, c], v[i, c] = value, slope
        if to_limit:
            t = limit
            for s in range(count):
                p = piece[s]
                until = (turn[s] + springs.cuts[p + s + 1] - springs.phase[s]) / springs.rate[s]
                if until - t <= 1e-12 / springs.rate[s]:
                    check[s] = 1
                    piece[s] += 1
                    if piece[s] == springs.first[s + 1]:
                        piece[s] = springs.first[s]
                        turn[s] += 1.0
        else:
            t += h
        if changed >= 0:
            events += 1
            if events > rule.max_steps // 4:
                code = TOO_MANY_EVENTS
                break
            s = changed
            m = mesh_of[s]
            before = _rubbing(meshes, springs, work, status, m, h)
            status[s] = 1 - status[s]
            after = _rubbing(meshes, springs, work, status, m, h)
            if columns > 1 and before != after:
                # the damping force jumps with the teeth that touch: tangents jump with it
                slope = -_horner_slope(local[s, 1], h)
                rateof = 0.0
                for i in range(n):
                    rateof += approach[m, i] * v[i, 0]
                slope += rateof
                if slope != 0.0:
                    jump = (before - after) * rateof
                    for c in range(1, columns):
                        value = 0.0
                        for i in range(n):
                            value += approach[m, i] * x[i, c]
                        # a tangent ahead of the motion changes force earlier
                        for i in range(n):
                            v[i, c] -= approach[m, i] * jump * value / slope
    return Travelled(x, v, code, steps, events, high, low, tooth, apart, behind, record_t, record_x, record_status)


def _horner_slope(row: Any, t: float) -> float:
    value = 0.0
    for k in range(row.shape[0] - 1, 0, -1):
        value = value * t + k * row[k]
    return value


@cache
def compiled() -> Callable[..., Any]:
    """`_run` as machine code, compiled at first use and kept on disk for the next process."""
    from fegear.dynamics.machine_code import machine_code

    scope = globals()
    for name in (
        "_horner", "_horner_slope", "_shift", "_root", "_first_crossing", "_load", "_peak",
        "_damping_series", "_rubbing", "_series", "_taylor_step", "_matrices_at", "_solve", "_to_powers",
        "_long_loads", "_collocate",
    ):  # fmt: skip
        scope[name] = machine_code(scope[name])
    return machine_code(_run)
