"""What goes into the integration of a motion, and what comes out of it."""

from __future__ import annotations

from typing import Any, NamedTuple

#: What `run` reports: all well; too many steps; too many changes of contact (the teeth chatter).
DONE, TOO_MANY_STEPS, TOO_MANY_EVENTS = 0, 1, 2


class TrainArrays(NamedTuple):
    """The linear part of the train: K, C of shape (n, n), constant forces f (n,), free (n,) 1 where a place matters.

    Forces that fluctuate, line by line: swing (lines, n) cos(swing_rate t + swing_phase).
    """

    K: Any
    C: Any
    f: Any
    free: Any
    swing: Any
    swing_rate: Any
    swing_phase: Any


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
    """How to step: Taylor order, tolerance, longest step, most steps, whether to look for peaks, steps to record.

    `friction`: whether any spring has friction torques.
    """

    order: int
    tolerance: float
    longest: float
    max_steps: int
    want_peaks: bool
    keep: int
    friction: bool


class Travelled(NamedTuple):
    """What `travel` returns: end state, code, counts, extremes, times apart and behind, and the record."""

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
    springs exist; series of the forces that fluctuate (n, order + 1).
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
    swing: Any
