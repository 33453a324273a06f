"""Random planetary sets that vibrate, from next to standstill through resonances: integrated step by step, exactly.

Between break points teeth are straight lines here, so that a matrix exponential takes every mode from step to step.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from fegear.dynamics.planetary.set_response import forced_response, linear_set
from fegear.dynamics.train.periodic import Periodic
from fegear.verify.planetary_sets import jumping, lin_parker, meshed


def random_teeth(rng):
    """Straight lines with a jump or two, and kinks."""
    s = np.sort(rng.uniform(0.05, 0.95, rng.integers(1, 4)))
    s = np.concatenate([[0.0], np.repeat(s, 2), [1.0]])
    values = rng.normal(size=s.size) * 3e-6
    if rng.integers(2):
        values[4:-1:2] = values[3:-2:2]  # only the first jumps
    values[-1] = values[0]
    found = Periodic.through_points(s, values)
    return found.plus(-found.mean)


def random_set(rng):
    planets = int(rng.choice([3, 4, 6]))
    model = lin_parker(planets)
    if planets == 3 and rng.integers(2):
        model = replace(model, found=replace(model.found, angles=np.array([0, 33, 77]) * math.tau / 108))
    bodies = {
        name: replace(getattr(model, name), mass=getattr(model, name).mass * float(rng.uniform(0.3, 3.0)),
                      bearing=float(10.0 ** rng.uniform(6.0, 9.0)))
        for name in ("sun", "ring", "carrier")
    }  # fmt: skip
    model = replace(model, **bodies, planet=replace(model.planet, pin=float(10.0 ** rng.uniform(7.0, 9.0))))
    how = {"sun_drives": bool(rng.integers(2)), "clockwise": bool(rng.integers(2))}
    low = rng.uniform(2e8, 5e8, 2)
    run = meshed(model, jumping(low[0], 1.3 * low[0], 0.6), jumping(low[1], 1.2 * low[1], 0.7), **how)
    linear = linear_set(run, float(10.0 ** rng.uniform(-2.0, -0.7)))
    return replace(linear, fluctuation=(random_teeth(rng), random_teeth(rng)))


def stepped(linear, frequency, places):
    """Forces of all meshes at places of the cycle, shape (meshes, places), by steps that are exact for lines."""
    model = linear.meshed.model
    flexible = linear.modes.frequency > 0.0
    natural, shapes = math.tau * linear.modes.frequency[flexible], linear.modes.shapes[:, flexible]
    rows, stiffness = (model.mesh_rows @ shapes).reshape(-1, natural.size), np.repeat(linear.stiffness, model.count)
    own = [(one, late) for one, lates in zip(linear.fluctuation, linear.delays, strict=True) for late in lates]
    breaks = np.concatenate([(one.breaks + late) % 1.0 for one, late in own])
    s = np.unique(np.concatenate([[0.0, 1.0], breaks, places]))
    widths = np.diff(s)

    def teeth(part):
        return np.array([one(s[:-1] + part * widths - late) for one, late in own])

    # a line through two places inside of each step
    early, late = teeth(0.25), teeth(0.75)
    slope = 2.0 * (late - early)
    start = early - 0.25 * slope
    moved = np.zeros((natural.size, s.size))
    for j, w in enumerate(natural):
        push, rise = (rows[:, j] * stiffness) @ start / w**2, (rows[:, j] * stiffness) @ slope / w**2
        # x, x'/w, force / w^2 and its rise over the step, in turns of the mode
        turn = w * widths / frequency
        generator = np.zeros((widths.size, 4, 4))
        generator[:, 0, 1] = turn
        generator[:, 1, :3] = np.stack([-turn, -2.0 * linear.damping_ratio * turn, turn], axis=1)
        generator[:, 2, 3] = 1.0
        step = expm(generator)
        state, once = np.zeros(2), np.eye(2)
        for k in range(widths.size):
            state = step[k, :2, :2] @ state + step[k, :2, 2] * push[k] + step[k, :2, 3] * rise[k]
            once = step[k, :2, :2] @ once
        state = np.linalg.solve(np.eye(2) - once, state)
        for k in range(widths.size):
            moved[j, k] = state[0]
            state = step[k, :2, :2] @ state + step[k, :2, 2] * push[k] + step[k, :2, 3] * rise[k]
        moved[j, -1] = state[0]
    gone = rows @ moved
    both = gone[:, :-1] - start, gone[:, 1:] - (start + slope)  # either side of every place
    return stiffness[:, None] * np.concatenate(both, axis=1)


@pytest.mark.dear
@pytest.mark.parametrize("seed", [*range(3), *(pytest.param(seed, marks=pytest.mark.long) for seed in range(3, 10))])
def test_random_sets_vibrate_as_when_integrated(seed):
    """No place of the cycle has more than the largest force and its estimate by numbers, from standstill on."""
    rng = np.random.default_rng(seed)
    linear = random_set(rng)
    modes = linear.modes.frequency[linear.modes.frequency > 0.0]
    found_at = [0.003 * modes[-1], modes[rng.integers(modes.size)] / rng.integers(1, 6), 0.37 * modes[-1]]
    for frequency in found_at:
        found = forced_response(linear, float(frequency))
        stated = found.others[-1].extremes[0] - found.extremes[0]
        even = np.linspace(0.0, 1.0, 8 * math.ceil(modes[-1] / frequency) + 40)
        asked = stepped(linear, frequency, even)
        most = np.abs(asked).max()
        for side, top in enumerate((asked.max(axis=1), -asked.min(axis=1))):
            sign = 1.0 - 2.0 * side
            here = sign * found.extremes[0, side].ravel()
            room = 1.5 * np.abs(stated[side]).ravel()
            assert (top <= here + room).all(), (frequency, top - here, room)  # no place has more
            assert (top >= here - 0.05 * most).all(), (frequency, here - top)
