"""The motion itself: step by step from event to event."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fegear.dynamics.motion.kernel.arrays import DONE, TOO_MANY_EVENTS, TOO_MANY_STEPS, Work
from fegear.dynamics.motion.kernel.collocation import collocate
from fegear.dynamics.motion.kernel.polynomials import first_crossing, largest_force, shift_in_time, slope_at
from fegear.dynamics.motion.kernel.series import damping_at, motion_series, taylor_step

#: Least length of a collocation step, and what a failed one waits for, both in Taylor steps; most that the wait grows.
WORTH, WAIT, LONGEST_WAIT = 40.0, 8, 8
#: After this part of a Taylor step, or of a unit of time where the motion allows longer ones (teeth that fly freely), a
#: contact is looked at that has just changed.
MOMENT = 1e-6


def travel(  # noqa: C901  (one loop over steps: what it shares is its local variables)
    train: Any, meshes: Any, springs: Any, radau: Any, rule: Any,
    x0: Any, v0: Any, t0: float, t1: float, status: Any, fresh: bool,
) -> Any:  # fmt: skip
    """Integrate from t0 to t1; see `packing.Packed` for the arrays.

    x0, v0: (n, columns), column 0 the motion, the others tangents. `status`: 1 where a spring pushes (changed in
    place); `fresh`: set it from the state first. Returns the fields of `Travelled`.
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
        np.zeros((n, order + 1)),
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
                shift_in_time(springs.poly[p, q], at, 2.0 * springs.rate[s] / (end - start), local[s, q])
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
        motion_series(train, meshes, springs, work, status, x, v, rule.friction, t)
        h = taylor_step(train, rule, X, x, v)
        moment = MOMENT * min(h, 1.0)
        waited += 1
        if long_steps and waited >= wait and limit - t > worth * h:
            far = min(max(reach, worth * h), limit - t)
            if collocate(train, meshes, springs, rule, radau, work, status, x, v, far, t):
                h, reach, wait = far, 8.0 * far, shortest
            else:
                # too long for the teeth's change, or the vibration still lives: shorter next time, then wait
                shorter = 0.25 * far
                if shorter > worth * h:
                    reach = shorter
                else:
                    reach, wait, waited = 0.0, min(2 * wait, LONGEST_WAIT * shortest), 0
                motion_series(train, meshes, springs, work, status, x, v, rule.friction, t)
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
            when = first_crossing(strain0[s], h, sign, moment)
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
                high[m] = max(high[m], largest_force(load0, slide, count, mesh_of, m, -1, h, 1.0))
                low[m] = min(low[m], -largest_force(load0, slide, count, mesh_of, m, -1, h, -1.0))
            for s in range(count):
                if status[s] == 1:
                    sign = -1.0 if sides[s] < 0.0 else 1.0
                    value = largest_force(load0, slide, count, mesh_of, mesh_of[s], s, h, sign)
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
            before = damping_at(meshes, springs, work, status, m, h)
            status[s] = 1 - status[s]
            after = damping_at(meshes, springs, work, status, m, h)
            if columns > 1 and before != after:
                # the damping force jumps with the teeth that touch: tangents jump with it
                slope = -slope_at(local[s, 1], h)
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
                            v[i, c] += approach[m, i] * jump * value / slope
    # A plain tuple: making a named one runs code of Python, which raises a Ctrl-C that came on the way where numba does
    # not look for it: the process ended.
    return x, v, code, steps, events, high, low, tooth, apart, behind, record_t, record_x, record_status
