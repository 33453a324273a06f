"""Tooth contact analysis: transmission error and contact of the gear set over a pitch (NASA TM-107451).

Contact of one tooth pair at given pinion angles: where, what bounds it, and how fast the gear runs ahead.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.contact.unloaded.contact_ellipse import parting, pinion_normal
from fegear.contact.unloaded.extremes import Extreme, extremes
from fegear.contact.unloaded.pair import HelicalPair
from fegear.contact.unloaded.reach import Bound
from fegear.contact.unloaded.separation import Earliest, Placement, earliest_contact

#: Difference of transmission errors that counts as none [rad].
_TOGETHER = 1e-13


@dataclass(frozen=True, slots=True)
class MeshCycle(ReadOnlyArrays):
    """Transmission error of a helical drive over one cycle of meshing, and the contact that leads at each angle.

    Parameters
    ----------
    pair : HelicalPair
        The drive, with its errors and modification.
    phi_1 : ndarray, shape (n,)
        Pinion angles over one pitch [rad].
    error : ndarray, shape (n,)
        Transmission error of the gear set [rad]: that of the tooth pair that touches first.
    leader : ndarray of int, shape (n,)
        Number of that pair; pair k meets k pitches after pair 0.
    mesh : PairContact
        Contact of the leading pair at each angle (its phi_1 is the pair's own).
    """

    pair: HelicalPair
    phi_1: Array
    error: Array
    leader: NDArray[np.int_]
    mesh: PairContact

    def pieces(self) -> list[tuple[float, float, int, str, float]]:
        """Pieces of the cycle with one leading pair and one kind of contact.

        Returns
        -------
        list of (first phi_1, last phi_1, pair, kind, mean slope)
            Angles in rad, at grid points; the slope is the mean of the exact slopes.
        """
        kind, leader = self.mesh.kind, self.leader
        cuts = np.flatnonzero((kind[1:] != kind[:-1]) | (leader[1:] != leader[:-1])) + 1
        return [
            (
                float(self.phi_1[part[0]]), float(self.phi_1[part[-1]]), int(leader[part[0]]), str(kind[part[0]]),
                float(self.mesh.slope[part].mean()),
            )
            for part in np.split(np.arange(self.phi_1.size), cuts)
        ]  # fmt: skip


@dataclass(frozen=True, slots=True)
class ToothContact(MeshCycle):
    """A cycle of meshing with its extremes, and one tooth pair followed alone.

    Parameters
    ----------
    single : PairContact
        Contact of one pair alone, over the whole angle in which it can be in contact in the aligned drive.
    maximum, minimum : Extreme
        Extremes of the gear set's transmission error over the cycle, located independently of the grid.
    seconds : float
        Wall-clock time of the analysis.
    """

    single: PairContact
    maximum: Extreme
    minimum: Extreme
    seconds: float

    @property
    def peak_to_peak(self) -> float:
        """Variation of the gear set's transmission error over a cycle [rad]."""
        return self.maximum.value - self.minimum.value


def mesh_cycle(pair: HelicalPair, positions: int = 400, start: float | None = None) -> MeshCycle:
    """Transmission error at angles over one cycle of meshing: all tooth pairs in reach, the earliest contact wins.

    Parameters
    ----------
    pair : HelicalPair
    positions : int
        Pinion angles per cycle, at least 2.
    start : float, optional
        First pinion angle [rad]; by default the cycle is centred on the engagement of pair 0.

    Returns
    -------
    MeshCycle
    """
    if int(positions) != positions or positions < 2:
        raise InputError("positions", positions, "must be a whole number of at least 2")
    p = Placement.of(pair)
    pitch = pair.pinion.angular_pitch
    first = 0.5 * (sum(pair.engagement) - pitch) if start is None else float(start)
    phi_1 = first + pitch * np.arange(positions) / positions
    error, _, leader, found = _gear_set(pair, p, phi_1)
    return MeshCycle(pair, phi_1, error, leader, describe(pair, p, phi_1 - leader * pitch, found))


def tooth_contact(pair: HelicalPair, positions: int = 400, start: float | None = None) -> ToothContact:
    """Tooth contact analysis: `mesh_cycle`, its extremes, on which the positions have no influence, and one pair alone.

    Parameters
    ----------
    pair, positions, start
        As of `mesh_cycle`.

    Returns
    -------
    ToothContact
    """
    began = time.perf_counter()
    cycle = mesh_cycle(pair, positions, start)
    p, pitch = Placement.of(pair), pair.pinion.angular_pitch

    def evaluate(angle: Array) -> tuple[Array, ...]:
        value, slope, number, contact = _gear_set(pair, p, angle)
        first, second = contact.bounds.astype(float)
        return value, slope, (number * len(Bound) + first) * len(Bound) + second

    lowest, highest = extremes(evaluate, 0.5 * (sum(pair.engagement) - pitch), pitch)
    lo, hi = pair.engagement
    single = pair_contact(pair, np.linspace(lo, hi, positions))
    seconds = time.perf_counter() - began
    return ToothContact(
        pair, cycle.phi_1, cycle.error, cycle.leader, cycle.mesh, single, highest, lowest, seconds
    )  # fmt: skip


def _gear_set(pair: HelicalPair, p: Placement, phi_1: Array) -> tuple[Array, Array, NDArray[np.int_], Earliest]:
    """Transmission error, its slope, number of the leading pair and its contact at each angle."""
    pitch = pair.pinion.angular_pitch
    lo, hi = pair.engagement
    # Misalignment and modification let a pair touch somewhat before and after its nominal engagement.
    margin = 0.5 * pitch
    last = np.floor((phi_1 - lo + margin) / pitch).astype(int)
    count = math.floor((hi - lo + 2.0 * margin) / pitch) + 1
    numbers = last[None, :] - np.arange(count)[:, None]
    own = (phi_1[None, :] - numbers * pitch).ravel()
    found = earliest_contact(p, pair.flank, own)
    error = (found.phi_2 - p.ratio * own).reshape(numbers.shape)
    # Pairs that touch together (aligned drives) differ by round-off only: name the one that is furthest from its ends.
    middle = np.abs(own.reshape(numbers.shape) - 0.5 * (lo + hi))
    best = np.argmin(np.where(error >= error.max(axis=0) - _TOGETHER, middle, np.inf), axis=0)
    column = np.arange(phi_1.size)
    index = best * phi_1.size + column
    chosen = Earliest(found.phi_2[index], found.s[index], found.z[index], found.bounds[:, index])
    slope = slope_of_error(p, pair, own[index], chosen)
    return error[best, column], slope, numbers[best, column], chosen


#: Gap that counts as touching when the length of an ill-defined contact is reported [m].
TOUCHING = 1e-9


_NAMES = {
    Bound.NONE: "surface",
    Bound.PINION_FACE_LOW: "pinion face end",
    Bound.PINION_FACE_HIGH: "pinion face end",
    Bound.GEAR_FACE_LOW: "gear face end",
    Bound.GEAR_FACE_HIGH: "gear face end",
    Bound.GEAR_TIP: "gear tip",
    Bound.GEAR_FORM: "gear form circle",
    Bound.BASE_TANGENT: "base tangent point",
    Bound.PINION_TIP: "pinion tip",
    Bound.PINION_FORM: "pinion form circle",
}


@dataclass(frozen=True, slots=True)
class PairContact(ReadOnlyArrays):
    """Contact of one tooth pair at given pinion angles, all arrays of shape (n,) and read-only.

    Parameters
    ----------
    phi_1 : ndarray
        Pinion angle [rad] of this tooth pair.
    error : ndarray
        Transmission error phi_2 - (N_1/N_2) phi_1 [rad], positive where the gear runs ahead; -inf where the flanks
        do not face each other.
    slope : ndarray
        Its derivative by phi_1, from the velocities at the contact point.
    bounds : ndarray of int8, shape (2, n)
        What bounds the contact point (`Bound`).
    kind : ndarray of str
        "surface", "pinion tip", "gear tip", "pinion face end", "gear face end", "corner" (two edges), or a flank
        limit ("pinion form circle", "gear form circle", "base tangent point") where contact would leave the involute.
    s : ndarray
        Contact point on the pinion's profile [m] (see `RackFlank`).
    r1, z1, r2, z2 : ndarray
        Radius and height of the contact point in both gears' frames [m].
    point : ndarray, shape (3, n)
        Contact point in the fixed frame [m].
    spread : ndarray
        Length [m] over which the flanks are within a nanometre of each other around a surface contact point (at most
        the face width); zero for edge contact.
    ill_defined : ndarray of bool
        Where `spread` exceeds a quarter of the face width: line contact, or nearly so. The transmission error is
        accurate there, the place of the contact point means little.
    """

    phi_1: Array
    error: Array
    slope: Array
    bounds: NDArray[np.int8]
    kind: NDArray[np.str_]
    s: Array
    r1: Array
    z1: Array
    r2: Array
    z2: Array
    point: Array
    spread: Array
    ill_defined: NDArray[np.bool_]


def pair_contact(pair: HelicalPair, phi_1: ArrayLike) -> PairContact:
    """Contact of one tooth pair alone at given pinion angles.

    Parameters
    ----------
    pair : HelicalPair
    phi_1 : array_like
        Pinion angles [rad].
    """
    angles = np.atleast_1d(np.asarray(phi_1, dtype=float)).ravel()
    if not np.all(np.isfinite(angles)):
        raise InputError("phi_1", phi_1, "must be finite")
    p = Placement.of(pair)
    return describe(pair, p, angles.copy(), earliest_contact(p, pair.flank, angles))


def slope_of_error(p: Placement, pair: HelicalPair, phi_1: Array, e: Earliest) -> Array:
    """d(phi_2)/d(phi_1) - N_1/N_2 from the velocities along the normal that belongs to the kind of contact."""
    w, dw = pair.flank.profile(e.s)
    turn = np.exp(1j * phi_1)
    q, qs = p.turned(w * turn, e.z), p.turned(dw * turn, e.z)
    qz = 1j * p.rate(e.z) * q
    x2, y2, _ = p.in_gear_frame(q, e.z)
    A, B, _ = p.gradient(x2, y2)

    def to_gear(v: Array) -> Array:
        return np.stack([-v[0], -v[1] * p.cos - v[2] * p.sin, v[2] * p.cos - v[1] * p.sin])

    zero, one = np.zeros_like(e.z), np.ones_like(e.z)
    of_gear = np.stack([A, B, p.twist_2 * one])
    of_pinion = to_gear(pinion_normal(p, w * turn, dw * turn, e.z))
    first, second = e.bounds
    gear_edge = _is_gear(first) | _is_gear(second)
    pinion_edge = _is_pinion(first) | _is_pinion(second)
    tip = (first == Bound.PINION_TIP) | (second == Bound.PINION_TIP)
    edge_1 = to_gear(np.where(tip, np.stack([qz.real, qz.imag, one]), np.stack([qs.real, qs.imag, zero])))
    around = (first == Bound.GEAR_TIP) | (second == Bound.GEAR_TIP)
    edge_2 = np.where(around, np.stack([-p.twist_2 * y2, p.twist_2 * x2, one]), np.stack([-B, A, zero]))
    of_edges = np.cross(edge_1, edge_2, axis=0)
    normal = np.where(gear_edge & pinion_edge, of_edges, np.where(gear_edge, of_pinion, of_gear))
    velocity_1 = to_gear(np.stack([-q.imag, q.real, zero]))
    along_2 = normal[0] * y2 - normal[1] * x2
    # Edges that cross at a vanishing angle have no normal of their own; the gear's is then as good.
    weak = np.abs(along_2) < 1e-6 * np.linalg.norm(normal, axis=0) * np.hypot(x2, y2)
    normal = np.where(weak, of_gear, normal)
    along_2 = normal[0] * y2 - normal[1] * x2
    return (normal * velocity_1).sum(axis=0) / along_2 - p.ratio


def _is_gear(bound: NDArray[np.int8]) -> NDArray[np.bool_]:
    return (bound >= Bound.GEAR_FACE_LOW) & (bound <= Bound.GEAR_FORM)


def _is_pinion(bound: NDArray[np.int8]) -> NDArray[np.bool_]:
    return np.isin(bound, (Bound.PINION_FACE_LOW, Bound.PINION_FACE_HIGH, Bound.PINION_TIP, Bound.PINION_FORM))


def describe(pair: HelicalPair, p: Placement, phi_1: Array, e: Earliest) -> PairContact:
    """Name what touches at each angle, and where."""
    w, _ = pair.flank.profile(e.s)
    q = p.turned(w * np.exp(1j * phi_1), e.z)
    x2, y2, z2 = p.in_gear_frame(q, e.z)
    touching = np.isfinite(e.phi_2)
    names = np.array([_NAMES[Bound(code)] for code in sorted(_NAMES)])
    kind = np.where(e.bounds[0] == Bound.NONE, names[e.bounds[1]], names[e.bounds[0]]).astype("<U18")
    kind[(e.bounds != Bound.NONE).all(axis=0)] = "corner"
    kind[~touching] = "none"
    spread = np.zeros(phi_1.size)
    inside = np.flatnonzero(kind == "surface")
    width = pair.overlap[1] - pair.overlap[0]
    if inside.size:
        small = parting(p, pair.flank, phi_1[inside], e.s[inside], e.z[inside]).small
        # The gap reaches the limit at +-sqrt(2 gap / curvature).
        spread[inside] = np.minimum(np.sqrt(8.0 * TOUCHING / np.maximum(small, 8.0 * TOUCHING / width**2)), width)
    return PairContact(
        phi_1=phi_1,
        error=e.phi_2 - p.ratio * phi_1,
        slope=slope_of_error(p, pair, phi_1, e),
        bounds=e.bounds,
        kind=kind,
        s=e.s,
        r1=np.abs(w),
        z1=e.z,
        r2=np.hypot(x2, y2),
        z2=z2,
        point=np.stack([q.real, q.imag, e.z]),
        spread=spread,
        ill_defined=spread > 0.25 * width,
    )
