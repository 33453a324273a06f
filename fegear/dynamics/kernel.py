"""The hot loop of motion: Taylor series of a train with periodic one-sided springs, event by event (numba).

Between changes of contact and break points of the periodic functions the accelerations are linear in the state with
polynomial coefficients in time, so the Taylor coefficients of the motion follow from a recurrence, to any order and
without function evaluations; the step is as long as the tolerance allows, and the polynomial is the dense output in
which changes of contact and largest forces are found. Tangents (for the monodromy matrix) ride along as columns.

The functions here are plain Python on arrays; `compiled` turns them into machine code at first use.
"""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

#: What `run` reports: all well; too many steps; too many changes of contact (the teeth chatter).
DONE, TOO_MANY_STEPS, TOO_MANY_EVENTS = 0, 1, 2


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


def _run(  # noqa: C901  (one loop: splitting it would cost the array views their speed)
    x0: Any, v0: Any, t0: float, t1: float,
    K: Any, C: Any, f: Any, count: Any,
    approach: Any, damping: Any, lever: Any,
    mesh_of: Any, side: Any, rate: Any, phase: Any, first: Any, cuts: Any, poly: Any,
    status: Any, fresh: bool, order: int, tolerance: float, longest: float, max_steps: int, want_peaks: bool, keep: int,
) -> Any:  # fmt: skip
    """Integrate from t0 to t1; see `motion.Packed` for the arrays.

    x0, v0: (n, columns), column 0 the motion, the others tangents. `status`: 1 where a spring pushes (changed in
    place); `fresh`: set it from the state first. `side`: 1 on the front flanks, -1 on the back flanks, 0 where teeth
    never part. `keep`: number of steps to record (0 for none).
    """
    n, columns = x0.shape
    springs, meshes, degree = mesh_of.shape[0], approach.shape[0], poly.shape[2] - 1
    X = np.zeros((order + 1, n, columns))
    strain = np.zeros((springs, order + 1, columns))
    load = np.zeros((springs, order + 1, columns))
    acceleration = np.zeros((n, columns))
    local = np.zeros((springs, 4, degree + 1))
    strain0, load0 = np.zeros((springs, order + 1)), np.zeros((springs, order + 1))
    slide = np.zeros((meshes, order + 1))
    piece, turn = np.zeros(springs, np.int64), np.zeros(springs)
    exists = np.zeros(springs, np.int64)
    x, v = x0.copy(), v0.copy()
    high, low = np.full(meshes, -np.inf), np.full(meshes, np.inf)
    tooth = np.zeros(springs)
    apart, behind = np.zeros(meshes), np.zeros(meshes)
    record_t = np.zeros(keep + 1)
    record_x = np.zeros((keep, order + 1, n))
    record_status = np.zeros((keep, springs), np.int8)
    friction = False
    for s in range(springs):
        for p in range(first[s], first[s + 1]):
            for k in range(degree + 1):
                if poly[p, 2, k] != 0.0 or poly[p, 3, k] != 0.0:
                    friction = True
    t, steps, events, code = t0, 0, 0, DONE
    # which piece of its period each spring is in; a break point within round-off belongs to the piece after it
    for s in range(springs):
        u = rate[s] * t0 + phase[s]
        turn[s] = math.floor(u + 1e-12)
        u -= turn[s]
        p = first[s]
        while p < first[s + 1] - 1 and u >= cuts[p + s + 1] - 1e-12:
            p += 1
        piece[s] = p
    check = np.ones(springs, np.int64)
    if not fresh:
        check[:] = 0
    while t < t1:
        if steps >= max_steps:
            code = TOO_MANY_STEPS
            break
        limit = t1
        for s in range(springs):
            p = piece[s]
            start, end = cuts[p + s], cuts[p + s + 1]
            until = (turn[s] + end - phase[s]) / rate[s]
            limit = min(limit, until)
            u = rate[s] * t + phase[s] - turn[s]
            at = ((u - start) - (end - u)) / (end - start)
            for q in range(4):
                _shift(poly[p, q], at, 2.0 * rate[s] / (end - start), local[s, q])
            exists[s] = 0
            for k in range(degree + 1):
                if poly[p, 0, k] != 0.0:
                    exists[s] = 1
            if check[s] == 1:
                gap, slope = -local[s, 1, 0], -(local[s, 1, 1] if degree > 0 else 0.0)
                for i in range(n):
                    gap += approach[mesh_of[s], i] * x[i, 0]
                    slope += approach[mesh_of[s], i] * v[i, 0]
                pushes = side[s] == 0.0 or side[s] * gap > 0.0 or (gap == 0.0 and side[s] * slope > 0.0)
                status[s] = 1 if exists[s] == 1 and pushes else 0
            check[s] = 0
        # Taylor coefficients of the motion
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
            for m in range(meshes):
                touching = False
                for s in range(springs):
                    if mesh_of[s] == m and status[s] == 1:
                        touching = True
                if touching and damping[m] != 0.0:
                    for c in range(columns):
                        rateof = 0.0
                        for i in range(n):
                            rateof += approach[m, i] * X[k + 1, i, c]
                        rateof *= damping[m] * (k + 1)
                        for i in range(n):
                            acceleration[i, c] -= approach[m, i] * rateof
                        if c == 0:
                            slide[m, k] = rateof
                elif k < order + 1:
                    slide[m, k] = 0.0
            for s in range(springs):
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
        # step length from the last two coefficients
        last, other = 1e-300, 1e-300
        for i in range(n):
            if count[i] == 1:
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
        h = 0.9 * min(
            (tolerance / last) ** (1.0 / order),
            (tolerance / other) ** (1.0 / (order - 1)),
            longest / 0.9,
            longest_tangent,
        )
        to_limit = h >= limit - t
        if to_limit:
            h = limit - t
        # the first change of contact on the way
        changed = -1
        for s in range(springs):
            if exists[s] == 0 or h == 0.0 or side[s] == 0.0:
                continue
            for k in range(order + 1):
                value = 0.0
                for i in range(n):
                    value += approach[mesh_of[s], i] * X[k, i, 0]
                strain0[s, k] = value - (local[s, 1, k] if k <= degree else 0.0)
            sign = side[s] if status[s] == 1 else -side[s]
            when = _first_crossing(strain0[s], h, sign)
            if when >= 0.0:
                h, changed, to_limit = when, s, False
        # what happened on the step
        for m in range(meshes):
            front, back = False, False
            for s in range(springs):
                if mesh_of[s] == m and status[s] == 1:
                    if side[s] >= 0.0:
                        front = True
                    else:
                        back = True
            if not front and not back:
                apart[m] += h
                high[m], low[m] = max(high[m], 0.0), min(low[m], 0.0)
            elif back:
                behind[m] += h
        if want_peaks and h > 0.0:
            for s in range(springs):
                for k in range(order + 1):
                    load0[s, k] = load[s, k, 0] if status[s] == 1 and k < order - 1 else 0.0
            for m in range(meshes):
                high[m] = max(high[m], _peak(load0, slide[:, : order - 1], springs, mesh_of, m, -1, h, 1.0))
                low[m] = min(low[m], -_peak(load0, slide[:, : order - 1], springs, mesh_of, m, -1, h, -1.0))
            for s in range(springs):
                if status[s] == 1:
                    sign = -1.0 if side[s] < 0.0 else 1.0
                    value = _peak(load0, slide[:, : order - 1], springs, mesh_of, mesh_of[s], s, h, sign)
                    tooth[s] = max(tooth[s], value)
        if steps < keep:
            record_t[steps] = t
            for k in range(order + 1):
                for i in range(n):
                    record_x[steps, k, i] = X[k, i, 0]
            for s in range(springs):
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
            for s in range(springs):
                p = piece[s]
                until = (turn[s] + cuts[p + s + 1] - phase[s]) / rate[s]
                if until - t <= 1e-12 / rate[s]:
                    check[s] = 1
                    piece[s] += 1
                    if piece[s] == first[s + 1]:
                        piece[s] = first[s]
                        turn[s] += 1.0
        else:
            t += h
        if changed >= 0:
            events += 1
            if events > max_steps // 4:
                code = TOO_MANY_EVENTS
                break
            s = changed
            m = mesh_of[s]
            before, after = False, False
            for q in range(springs):
                if mesh_of[q] == m and status[q] == 1:
                    before = True
            status[s] = 1 - status[s]
            for q in range(springs):
                if mesh_of[q] == m and status[q] == 1:
                    after = True
            if columns > 1 and before != after and damping[m] != 0.0:
                # the damping force comes or goes at once: tangents jump with it
                slope = -_horner_slope(local[s, 1], h)
                rateof = 0.0
                for i in range(n):
                    rateof += approach[m, i] * v[i, 0]
                slope += rateof
                if slope != 0.0:
                    jump = damping[m] * rateof * (1.0 if before else -1.0)
                    for c in range(1, columns):
                        value = 0.0
                        for i in range(n):
                            value += approach[m, i] * x[i, c]
                        # a tangent ahead of the motion changes force earlier
                        for i in range(n):
                            v[i, c] -= approach[m, i] * jump * value / slope
    return x, v, code, steps, events, high, low, tooth, apart, behind, record_t, record_x, record_status


def _horner_slope(row: Any, t: float) -> float:
    value = 0.0
    for k in range(row.shape[0] - 1, 0, -1):
        value = value * t + k * row[k]
    return value


@cache
def compiled() -> Callable[..., Any]:
    """`_run` as machine code, compiled at first use and kept on disk for the next process."""
    import numba

    scope = globals()
    for name in ("_horner", "_shift", "_root", "_first_crossing", "_load", "_peak", "_horner_slope"):
        scope[name] = numba.njit(cache=True)(scope[name])
    run: Callable[..., Any] = numba.njit(cache=True)(_run)
    return run
