"""Motion of a gear train in time: one-sided teeth, backlash, friction, from any start.

Contact follows the papers (TM-100180, Eqs. 19 to 24, repaired): teeth press while their approach exceeds their
separation, part without force, and meet on the back flanks once the backlash is used up; mesh damping acts on the
rate of approach of the bodies while any teeth touch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError, InputError
from fegear.base.interrupts import OF_SCRIPTS, REQUESTS_TO_STOP, deaf
from fegear.base.tally import note, tallied
from fegear.dynamics.motion import kernel
from fegear.dynamics.motion.motion_model import Moving
from fegear.dynamics.motion.packed_model import Packed, pack
from fegear.dynamics.motion.radau import radau

#: Order of the Taylor series; high, because a longer step costs less than a second one.
ORDER = 20


@dataclass(frozen=True)
class Passage:
    """What came of integrating over a while: end state, largest forces, time apart and on the back flanks.

    Forces [N], times in shares of the whole; `tooth_force` is the largest force on one tooth pair of each gear pair.
    `steps`: how many it took; `polynomials`: record of the Taylor polynomials, if asked for.
    """

    x: Array
    v: Array
    tangent: Array
    status: NDArray[np.int8]
    changes: int
    steps: int
    largest: Array
    smallest: Array
    tooth_force: Array
    apart: Array
    behind: Array
    times: Array
    polynomials: Array
    contact: NDArray[np.int8]


@tallied("passages")
def propagate(
    packed: Packed,
    x: Array,
    v: Array,
    duration: float,
    *,
    start: float = 0.0,
    tolerance: float = 1e-9,
    tangents: bool = False,
    peaks: bool = True,
    record: int = 0,
    order: int = ORDER,
    longest: float = math.inf,
    status: NDArray[np.int8] | None = None,
) -> Passage:
    """Integrate over a duration from a state, all in the units of `packed`.

    Parameters
    ----------
    packed : Packed
        The model.
    x, v : ndarray, shape (n,)
        Coordinates and velocities.
    duration, start : float
        Time to integrate over and where it begins, in time units.
    tolerance : float
        Largest truncated term of a step, relative to the static deflection.
    tangents : bool
        Whether to carry the monodromy matrix.
    peaks : bool
        Whether to look for the largest forces.
    record : int
        Room for this many steps of dense output.
    order, longest : int, float
        Taylor order and largest step (for studies of convergence).
    status : ndarray, optional
        Which springs push at the start; from the state by default.

    Raises
    ------
    ConvergenceError
        If steps or changes of contact are too many to go on.
    """
    n = packed.size
    columns = 1 + (2 * n if tangents else 0)
    X, V = np.zeros((n, columns)), np.zeros((n, columns))
    X[:, 0], V[:, 0] = x, v
    if tangents:
        X[:, 1 : n + 1], V[:, n + 1 :] = np.eye(n), np.eye(n)
    active = np.zeros(packed.springs, dtype=np.int8) if status is None else np.array(status, dtype=np.int8)
    friction = bool(packed.poly[:, 2:].any())
    rule = kernel.Rule(order, tolerance, longest, record or 20_000 + int(200 * duration), peaks, record, friction)
    try:
        # What is handed back is made by Python: raised there, a Ctrl-C is a segmentation fault with Python 3.12.
        with deaf((*REQUESTS_TO_STOP, *OF_SCRIPTS)):
            handed_back = kernel.compiled()(
                packed.train_arrays, packed.mesh_arrays, packed.spring_arrays, radau(), rule,
                X, V, start, start + duration, active, status is None,
            )  # fmt: skip
        found = kernel.Travelled(*handed_back)
    except SystemError as error:  # where signals cannot wait, a Ctrl-C is found as arrays are handed back
        cause: BaseException = error
        while isinstance(cause, SystemError) and cause.__cause__ is not None:
            cause = cause.__cause__
        raise cause from None
    if found.code != kernel.DONE:
        what = "time steps" if found.code == kernel.TOO_MANY_STEPS else "changes of contact"
        raise ConvergenceError(
            f"Motion at {packed.model.speed:.6g} rad/s stopped after {found.steps} steps: too many {what} in "
            f"{duration:.6g} units of time. Specify damping of the gear pair, reduce the stiffness of the "
            "non-working flanks, or increase the tolerance."
        )
    note("changes of contact", int(found.changes))
    note("ripple lines", packed.swing_rate.size)
    note("springs in time", sum(packed.varies(s) for s in range(packed.springs)))
    tangent = np.vstack([found.x[:, 1:], found.v[:, 1:]]) if tangents else np.zeros((0, 0))
    of_mesh = np.array([found.tooth[packed.mesh_of == m].max() for m in range(packed.damping.size)])
    unit, steps = packed.force_unit, found.steps
    return Passage(
        found.x[:, 0].copy(), found.v[:, 0].copy(), tangent, active, found.changes, int(found.steps),
        found.high * unit, found.low * unit, of_mesh * unit, found.apart / duration, found.behind / duration,
        found.times[: steps + 1], found.polynomials[:steps], found.contact[:steps],
    )  # fmt: skip


def _values(packed: Packed, q: int, time: float) -> Array:
    """Stiffness (q = 0) or separation (q = 1) of every spring at a time, in units."""
    u = packed.rate * time + packed.phase
    u = u + 1e-12 - np.floor(u + 1e-12)
    found = np.empty(packed.springs)
    for s in range(packed.springs):
        cuts = packed.cuts[packed.first[s] + s : packed.first[s + 1] + s + 1]
        p = min(int(np.searchsorted(cuts, u[s], side="right")) - 1, cuts.size - 2)
        v = ((u[s] - cuts[p]) - (cuts[p + 1] - u[s])) / (cuts[p + 1] - cuts[p])
        found[s] = np.polynomial.polynomial.polyval(v, packed.poly[packed.first[s] + p, q])
    return found


def static_state(packed: Packed, time: float = 0.0) -> tuple[Array, Array]:
    """Coordinates at rest under the torques with the teeth as they stand at a time, and zero velocities."""
    k, e = _values(packed, 0, time), _values(packed, 1, time)
    rows = packed.approach[packed.mesh_of][:, packed.free]
    K = packed.K[np.ix_(packed.free, packed.free)]
    active = (k > 0.0) & (packed.side >= 0.0)
    y: Array = np.zeros(int(packed.free.sum()))
    for _ in range(60):
        weight = np.where(active, k, 0.0)
        matrix = K + rows.T @ (weight[:, None] * rows)
        y = np.asarray(
            np.linalg.lstsq(matrix, packed.f[packed.free] + rows.T @ (weight * e), rcond=1e-13)[0], dtype=float
        )
        now = (k > 0.0) & ((packed.side * (rows @ y - e) > 0.0) | (packed.side == 0.0))
        if np.array_equal(now, active):
            break
        if not np.any(now):
            break
        active = now
    x = np.zeros(packed.size)
    x[packed.free] = y
    return x, np.zeros(packed.size)


@dataclass(frozen=True)
class Trajectory:
    """Motion over a while as polynomials between steps; evaluate it at any time [s]."""

    packed: Packed
    passage: Passage

    def _at(self, time: ArrayLike, derivative: int = 0) -> tuple[Array, NDArray[np.intp]]:
        t = np.asarray(time, dtype=float) / self.packed.time_unit
        knots = self.passage.times
        step = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, knots.size - 2)
        local = t - knots[step]
        rows = self.passage.polynomials[step]
        value = np.zeros((*t.shape, self.packed.size))
        for k in range(rows.shape[-2] - 1, derivative - 1, -1):
            factor = math.factorial(k) / math.factorial(k - derivative)
            value = value * local[..., None] + factor * rows[..., k, :]
        return value, step

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return float(self.passage.times[-1]) * self.packed.time_unit

    def angles(self, time: ArrayLike, derivative: int = 0) -> Array:
        """Rotation angles [rad] or time derivatives, shape (..., size), without the free turning of the train."""
        value, _ = self._at(time, derivative)
        return (value @ self.packed.shapes.T) / self.packed.time_unit**derivative

    def approach(self, time: ArrayLike, derivative: int = 0) -> Array:
        """Approach of each gear pair [m] (the dynamic transmission error) or time derivatives, (..., meshes)."""
        value, _ = self._at(time, derivative)
        return (value @ self.packed.approach.T) * (self.packed.length_unit / self.packed.time_unit**derivative)

    def _springs(self, time: ArrayLike) -> tuple[Array, Array]:
        """Elastic force of each spring [N], and its stiffness in units."""
        p = self.packed
        value, step = self._at(time)
        t = np.asarray(time, dtype=float) / p.time_unit
        # A step ends where a piece of a stiffness does. At such a moment both are those before it or those behind it:
        # its last digit must not choose the piece of one side for the contacts of the other.
        knots = self.passage.times
        middle = 0.5 * (knots[step] + knots[step + 1])
        k = np.empty((*t.shape, p.springs))
        e = np.empty((*t.shape, p.springs))
        for s in range(p.springs):
            inside = p.rate[s] * middle + p.phase[s]
            turns = np.floor(inside)
            cuts = p.cuts[p.first[s] + s : p.first[s + 1] + s + 1]
            piece = np.clip(np.searchsorted(cuts, inside - turns, side="right") - 1, 0, cuts.size - 2)
            u = p.rate[s] * t + p.phase[s] - turns
            v = ((u - cuts[piece]) - (cuts[piece + 1] - u)) / (cuts[piece + 1] - cuts[piece])
            rows = p.poly[p.first[s] + piece]
            k[..., s] = np.polynomial.polynomial.polyval(v, np.moveaxis(rows[..., 0, :], -1, 0), tensor=False)
            e[..., s] = np.polynomial.polynomial.polyval(v, np.moveaxis(rows[..., 1, :], -1, 0), tensor=False)
        strain = value @ p.approach[p.mesh_of].T - e
        return np.where(self.passage.contact[step] == 1, k * strain, 0.0) * p.force_unit, k

    def mesh_forces(self, time: ArrayLike) -> Array:
        """Force of each gear pair [N] with its damping, negative on the back flanks, shape (..., meshes)."""
        p = self.packed
        elastic, stiffness = self._springs(time)
        rate, step = self._at(time, 1)
        contact = self.passage.contact[step] == 1
        found = np.zeros((*np.shape(time), p.damping.size))
        for m in range(p.damping.size):
            of = p.mesh_of == m
            touching = contact[..., of].any(axis=-1)
            slide = p.damping[m] * (rate @ p.approach[m]) * p.force_unit
            if p.momentary[m]:
                slide = slide * np.sqrt(np.where(contact, stiffness, 0.0)[..., of].sum(axis=-1) / p.stiffness[m])
            found[..., m] = elastic[..., of].sum(axis=-1) + np.where(touching, slide, 0.0)
        return found


def simulate(
    model: Moving,
    duration: float,
    *,
    start: str | tuple[Array, Array] = "static",
    tolerance: float = 1e-9,
    max_steps: int = 200_000,
) -> Trajectory:
    """Integrate a model over a duration [s].

    Parameters
    ----------
    model : Moving
        What to integrate.
    duration : float
        How long [s].
    start : {"static", "rest"} or (x, v)
        From the static state under load, from rest without load (the torques then strike), or from a state in the
        coordinates of `pack`.
    tolerance : float
        Largest truncated term of a step, relative to the static deflection.
    max_steps : int
        Room for the record.
    """
    packed = pack(model)
    x, v = starting_state(packed, start)
    length = duration / packed.time_unit
    passage = propagate(packed, x, v, length, tolerance=tolerance, record=max_steps)
    return Trajectory(packed, passage)


def starting_state(packed: Packed, start: str | tuple[Array, Array]) -> tuple[Array, Array]:
    """The state that "static", "rest" or a given pair stands for, in units."""
    if isinstance(start, tuple):
        return start
    if start == "static":
        return static_state(packed)
    if start == "rest":
        return np.zeros(packed.size), np.zeros(packed.size)
    raise InputError("start", start, 'must be "static", "rest" or a state')
