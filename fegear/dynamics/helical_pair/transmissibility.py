"""Mesh and bearing force transmissibility of a helical pair (Blankenship and Singh, Eqs. 13 to 25, 37 to 39).

Rigid-body motion deflects neither mesh nor bearings. It is removed from every matrix here, exactly, so that forces
stay accurate down to frequency zero, where the compliance itself does not exist.

Mesh and bearing forces of a helical pair over speed (Blankenship and Singh, Eqs. 9 to 11, 17, 18 and 22).

The excitation is a set of lines: each follows the driver's speed (transmission error, a force of an order of a shaft)
or keeps its frequency, and carries complex amplitudes ``x(t) = Re(X exp(i w t))``, 0-peak. A transmission error delta
acts on both gears, ``K_M delta + C_M delta'`` on gear i (9); external forces and moments act on one, ``D^-1 F`` (10).
The mesh force on gear i is ``-K_M (q_i + P q_j - delta) - C_M (...)'`` (11), in body coordinates ``D`` times that.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import ConvergenceError, InputError, RangeError
from fegear.dynamics.helical_pair.model import HelicalPairModel, P, ReducedPairModel
from fegear.dynamics.train.modes import undamped_modes

Model = HelicalPairModel | ReducedPairModel


#: Twice a damping ratio, over the highest natural frequency, below which there is no damping.
_UNDAMPED = 1e-14

Method = Literal["direct", "modal", "state-space"]


@dataclass(frozen=True, eq=False)
class Transmissibility:
    """Frequency response of mesh and bearing forces of the general pair; matrices of shape (m, 5, 5) over q.

    With transmission error delta and external forces f on the gears, the force that the mesh exerts on gear i is
    ``G delta - R_ii f_i - R_ij f_j``, and the bearing's force on gear i is ``-(G_B delta + R_B_ii f_i + R_B_ij f_j)``:
    R is the share of an external force that passes on through the mesh. None of the R is symmetric.

    Parameters
    ----------
    ratio : ndarray, shape (m,)
        Lambda = frequency / omega.
    frequency : ndarray, shape (m,)
        Circular frequency [rad/s].
    G : ndarray
        Spectral mesh stiffness [N/m] (19).
    G_minus_a : ndarray
        G less the mesh's own dynamic stiffness a [N/m]: what the gears' motion adds, without cancellation.
    R_ii, R_ij : ndarray
        Mesh force transmissibility [1] (20).
    G_B_i, G_B_j : ndarray
        Spectral bearing stiffness [N/m] of both gears (23).
    R_B_ii, R_B_ij, R_B_ji, R_B_jj : ndarray
        Bearing force transmissibility [1] (24): first index the bearing's gear, second the loaded gear.
    """

    ratio: Array
    frequency: Array
    G: Complex
    G_minus_a: Complex
    R_ii: Complex
    R_ij: Complex
    G_B_i: Complex
    G_B_j: Complex
    R_B_ii: Complex
    R_B_ij: Complex
    R_B_ji: Complex
    R_B_jj: Complex


@dataclass(frozen=True, eq=False)
class ReducedTransmissibility:
    """Frequency response of the unity-ratio pair; matrices of shape (m, 5, 5) over q = q_i + P q_j.

    Parameters
    ----------
    ratio, frequency : ndarray, shape (m,)
        Lambda and circular frequency [rad/s].
    G : ndarray
        a - 2 a H a [N/m]: the 2 because delta drives both gears and H is built from (m, 2 K_M + k_B) (37a).
    G_minus_a : ndarray
        -2 a H a [N/m], without cancellation (Fig. 4).
    R : ndarray
        a H [1] (38a); not symmetric although a and H are.
    G_B : ndarray
        a_B H a [N/m]: force of one bearing on the transmission error (37b).
    R_B : ndarray
        a_B H [1]: sum of both bearings' forces, gear j's mirrored (38b).
    """

    ratio: Array
    frequency: Array
    G: Complex
    G_minus_a: Complex
    R: Complex
    G_B: Complex
    R_B: Complex


def compliance(model: Model, frequency: ArrayLike, method: Method = "direct") -> Complex:
    """Compliance of the flexible motion at circular frequencies, shape (m, n, n) [m/N].

    Parameters
    ----------
    model : HelicalPairModel or ReducedPairModel
    frequency : array_like, shape (m,)
        Circular frequencies [rad/s], not negative.
    method : {"direct", "modal", "state-space"}
        "direct" solves the equations at each frequency, in modal coordinates; "modal" sums undamped modes with the
        diagonal of the modal damping (16), exact for proportional damping; "state-space" sums the complex modes of
        (13) to (15), exact for any damping.

    Raises
    ------
    RangeError
        At an undamped resonance.
    """
    w = np.atleast_1d(np.asarray(frequency, dtype=float))
    if w.ndim != 1 or not np.all(np.isfinite(w)) or np.any(w < 0.0):
        raise InputError("frequency", frequency, "must be finite, non-negative frequencies")
    natural, shapes, damping = _flexible(model)
    if method == "modal":
        denominator = natural**2 - w[:, None] ** 2 + 1j * w[:, None] * np.diag(damping)
        _refuse_resonance(np.abs(denominator).min(axis=1), natural, w)
        return np.asarray(np.einsum("ir,mr,jr->mij", shapes, 1.0 / denominator, shapes))
    if method == "state-space":
        poles, vectors = complex_modes(model)
        denominator = 1j * w[:, None] - poles
        _refuse_resonance(np.abs(denominator).min(axis=1) * natural.max(), natural, w)
        return np.asarray(np.einsum("ir,mr,jr->mij", vectors, 1.0 / denominator, vectors))
    if method != "direct":
        raise InputError("method", method, 'must be "direct", "modal" or "state-space"')
    matrix = 1j * w[:, None, None] * damping
    n = natural.size
    matrix[:, range(n), range(n)] += natural**2 - w[:, None] ** 2
    bare = np.flatnonzero(_undamped(natural, damping))
    if bare.size:
        _refuse_resonance(np.abs(matrix[:, bare, bare]).min(axis=1), natural, w)
    return np.asarray(shapes @ np.linalg.solve(matrix, np.broadcast_to(shapes.T, (w.size, *shapes.T.shape))))


def _refuse_resonance(least: Array, natural: Array, w: Array) -> None:
    hit = least <= 1e-12 * natural.max() ** 2
    if hit.any():
        hertz = float(w[np.argmax(hit)]) / (2.0 * math.pi)
        raise RangeError(
            "frequency", f"{hertz:.9g} Hz", "is an undamped resonance: unbounded response",
            "specify damping or change the frequency",
        )  # fmt: skip


def _flexible(model: Model) -> tuple[Array, Array, Array]:
    """Frequencies and shapes of all motions that stiffness or damping resist, and their modal damping matrix.

    Modes without stiffness are turned so that damping acts on as few of them as possible; the others are rigid-body
    motion and removed.
    """
    natural, shapes = undamped_modes(model.mass, model.stiffness)
    rigid = natural == 0.0
    keep = shapes[:, ~rigid]
    if rigid.any() and model.damping.any():
        free = shapes[:, rigid]
        drag, turn = np.linalg.eigh(free.T @ model.damping @ free)
        everywhere = np.abs(np.einsum("ir,ij,jr->r", shapes, model.damping, shapes)).max()
        held = drag > 1e-12 * everywhere
        keep = np.hstack([keep, free @ turn[:, held]])
        natural = np.concatenate([natural[~rigid], np.zeros(int(held.sum()))])
    else:
        natural = natural[~rigid]
    return natural, keep, keep.T @ model.damping @ keep


def complex_modes(model: Model) -> tuple[Complex, Complex]:
    """Poles [rad/s] and displacement shapes of the damped motion, normalised so that their dyads sum to the compliance.

    The state-space form is that of (13) with both mass blocks positive, which makes its matrices symmetric; with
    the printed sign the normalisation (15) would not give (14). Rigid-body motion, a defective double pole at zero,
    is split off beforehand.

    Returns
    -------
    poles : ndarray of complex, shape (2 r,)
    shapes : ndarray of complex, shape (n, 2 r)

    Raises
    ------
    ConvergenceError
        If damping is critical for some mode: two eigenvectors then coincide and no modal sum exists.
    """
    natural, shapes, damping = _flexible(model)
    n = natural.size
    # Scaled by the highest frequency, q'/scale and q stand in the state with like weights.
    scale = natural.max()
    state = np.block([[-damping / scale, -np.diag((natural / scale) ** 2)], [np.eye(n), np.zeros((n, n))]])
    poles, vectors = np.linalg.eig(state)
    low = vectors[n:]
    norm = 2.0 * poles * (low * low).sum(0) + np.einsum("ir,ij,jr->r", low, damping / scale, low)
    if np.any(np.abs(norm) < 1e-7 * (np.abs(low) ** 2).sum(0) * np.maximum(np.abs(poles), 1e-3)):
        raise ConvergenceError("Critical damping of a mode: no modal superposition possible. Use the direct method.")
    return poles * scale, (shapes @ low) / np.sqrt(norm * scale)


def _at(model: Model, frequency: ArrayLike, method: Method) -> tuple[Array, Complex, Complex, Complex]:
    """Frequencies w (m,), i w, the mesh's dynamic stiffness and the compliance at each, (m, ., .)."""
    w = np.atleast_1d(np.asarray(frequency, dtype=float))
    s = 1j * w[:, None, None]
    return w, s, model.mesh_stiffness_matrix + s * model.mesh_damping_matrix, compliance(model, w, method)


def transmissibility(model: HelicalPairModel, frequency: ArrayLike, method: Method = "direct") -> Transmissibility:
    """Mesh and bearing force transmissibility of a general pair (18 to 25).

    Parameters
    ----------
    model : HelicalPairModel
    frequency : array_like, shape (m,)
        Circular frequencies [rad/s].
    method : {"direct", "modal", "state-space"}
        See `compliance`.
    """
    w, s, a, H = _at(model, frequency, method)
    i, j = model.driver, model.driven
    b_i = i.in_q(i.bearing_stiffness) + s * i.in_q(i.bearing_damping)
    b_j = j.in_q(j.bearing_stiffness) + s * j.in_q(j.bearing_damping)
    relative = H[:, :5] + P @ H[:, 5:]
    R = a @ relative
    drive = np.concatenate([a, P @ a], axis=1)
    driven, moved = H @ drive, -(R @ drive)
    return Transmissibility(
        ratio=w / model.natural_frequency,
        frequency=w,
        G=a + moved,
        G_minus_a=moved,
        R_ii=R[:, :, :5],
        R_ij=R[:, :, 5:],
        G_B_i=b_i @ driven[:, :5],
        G_B_j=b_j @ driven[:, 5:],
        R_B_ii=b_i @ H[:, :5, :5],
        R_B_ij=b_i @ H[:, :5, 5:],
        R_B_ji=b_j @ H[:, 5:, :5],
        R_B_jj=b_j @ H[:, 5:, 5:],
    )


def reduced_transmissibility(
    model: ReducedPairModel, frequency: ArrayLike, method: Method = "direct"
) -> ReducedTransmissibility:
    """Mesh and bearing force transmissibility of a unity-ratio pair (37 to 39).

    Parameters
    ----------
    model : ReducedPairModel
    frequency : array_like, shape (m,)
        Circular frequencies [rad/s].
    method : {"direct", "modal", "state-space"}
        See `compliance`.
    """
    w, s, a, H = _at(model, frequency, method)
    b = model.bearing_stiffness + s * model.bearing_damping
    R = a @ H
    moved = -2.0 * (R @ a)
    return ReducedTransmissibility(w / model.natural_frequency, w, a + moved, moved, R, b @ H @ a, b @ H)


def natural_frequencies(model: Model) -> tuple[Array, Array]:
    """Natural frequencies of the flexible motion [rad/s], and those of them that nothing damps, rising.

    Parameters
    ----------
    model : HelicalPairModel or ReducedPairModel
    """
    natural, _, damping = _flexible(model)
    return np.unique(natural[natural > 0.0]), np.unique(natural[_undamped(natural, damping)])


def _undamped(natural: Array, damping: Array) -> NDArray[np.bool_]:
    """Which flexible modes nothing damps: damping feeds in no energy, so a zero on the diagonal is a row of zeros."""
    return (natural > 0.0) & (np.diag(damping) <= _UNDAMPED * float(natural.max(initial=0.0)))


@dataclass(frozen=True)
class Line:
    """One harmonic excitation.

    Parameters
    ----------
    order : float
        Frequency over the driver's speed; zero where it does not depend on it.
    frequency : float
        Circular frequency [rad/s] besides.
    error : tuple of complex
        Transmission error over q = (y, z, b theta_x, a theta_y, a theta_z) [m].
    on_driver, on_driven : tuple of complex
        External forces along y, z [N] and moments about x, y, z [N m].
    source : str
        What it is, for tables.
    """

    order: float = 0.0
    frequency: float = 0.0
    error: tuple[complex, ...] = (0.0,) * 5
    on_driver: tuple[complex, ...] = (0.0,) * 5
    on_driven: tuple[complex, ...] = (0.0,) * 5
    source: str = ""

    def __post_init__(self) -> None:
        """Refuse what has no frequency."""
        good = math.isfinite(self.order) and math.isfinite(self.frequency) and min(self.order, self.frequency) >= 0.0
        if not good or self.order + self.frequency <= 0.0:
            raise InputError("line", (self.order, self.frequency), "must have a frequency greater than zero")
        if not np.all(np.isfinite([*self.error, *self.on_driver, *self.on_driven])):
            raise InputError("line", self.source, "must have finite amplitudes")


@dataclass(frozen=True, eq=False)
class PairForces:
    """Forces of every line at every speed, complex 0-peak amplitudes.

    Components are forces along y, z [N] and moments about x, y, z [N m].

    Parameters
    ----------
    speed : ndarray, shape (S,)
        Of the driver [rad/s].
    lines : tuple of Line
        Lines of one frequency are one.
    frequency : ndarray, shape (L, S)
        Circular [rad/s].
    mesh : ndarray, shape (L, S, 5)
        What the mesh exerts on the driver (11).
    normal : ndarray, shape (L, S)
        Its force along the tooth normal [N].
    bearing_driver, bearing_driven : ndarray, shape (L, S, 5)
        What the bearings exert on their gears (22).
    """

    speed: Array
    lines: tuple[Line, ...]
    frequency: Array
    mesh: Complex
    normal: Complex
    bearing_driver: Complex
    bearing_driven: Complex


def joined_lines(lines: Sequence[Line]) -> tuple[Line, ...]:
    """Lines of one frequency added up, by rising order and frequency."""
    groups: dict[tuple[float, float], list[Line]] = defaultdict(list)
    for line in lines:
        groups[float(f"{line.order:.12g}"), float(f"{line.frequency:.12g}")].append(line)

    def total(group: list[Line], key: str) -> tuple[complex, ...]:
        return tuple(complex(v) for v in np.sum([getattr(line, key) for line in group], axis=0))

    return tuple(
        Line(order, frequency, total(group, "error"), total(group, "on_driver"), total(group, "on_driven"),
             " + ".join(dict.fromkeys(line.source for line in group)))
        for (order, frequency), group in sorted(groups.items())
    )  # fmt: skip


def pair_forces(model: HelicalPairModel, lines: Sequence[Line], speed: ArrayLike) -> PairForces:
    """Forces in the mesh and in the bearings of a pair that is excited by lines.

    Parameters
    ----------
    model : HelicalPairModel
    lines : sequence of Line
    speed : array_like, shape (S,)
        Of the driver [rad/s].

    Raises
    ------
    RangeError
        Where a line meets a resonance without damping.
    """
    omega, found = np.atleast_1d(np.asarray(speed, dtype=float)), joined_lines(lines)
    if omega.ndim != 1 or not omega.size or not np.all(np.isfinite(omega)) or np.any(omega <= 0.0):
        raise InputError("speed", speed, "must be finite speeds greater than zero")
    if not found:
        raise InputError("lines", "none", "must be at least one")
    i, j = model.driver, model.driven
    frequency = np.array([line.order * omega + line.frequency for line in found])
    parts = [_of_line(model, line, w) for line, w in zip(found, frequency, strict=True)]
    mesh, at_i, at_j = (np.array(part, dtype=complex) for part in zip(*parts, strict=True))
    c, s = math.cos(model.mesh.base_helix_angle), math.sin(model.mesh.base_helix_angle)
    normal = np.asarray(0.5 * mesh @ np.array([c, s, 0.0, -s, c], dtype=complex))
    size_i, size_j = (1.0 / i.scale).astype(complex), (1.0 / j.scale).astype(complex)
    return PairForces(omega, found, frequency, mesh * size_i, normal, at_i * size_i, at_j * size_j)


def _of_line(model: HelicalPairModel, line: Line, w: Array) -> tuple[Complex, Complex, Complex]:
    """Forces over q of the mesh on the driver and of both bearings, (S, 5) each; over all speeds at once."""
    steady = line.order == 0.0  # one frequency for all speeds
    t = transmissibility(model, w[:1] if steady else w)
    delta = np.array(line.error)
    f_i, f_j = model.driver.scale * np.array(line.on_driver), model.driven.scale * np.array(line.on_driven)
    parts = (
        t.G @ delta - t.R_ii @ f_i - t.R_ij @ f_j,
        -(t.G_B_i @ delta + t.R_B_ii @ f_i + t.R_B_ij @ f_j),
        -(t.G_B_j @ delta + t.R_B_ji @ f_i + t.R_B_jj @ f_j),
    )
    a, b, c = (np.broadcast_to(part, (w.size, 5)) for part in parts)
    return a, b, c


def resonant_speeds(model: HelicalPairModel, lines: Sequence[Line]) -> tuple[Array, Array]:
    """Driver's speeds [rad/s] at which a line meets a natural frequency, and those where nothing damps it, rising."""

    def speeds(natural: Array) -> Array:
        found = [(natural - line.frequency) / line.order for line in joined_lines(lines) if line.order > 0.0]
        met = np.unique(np.concatenate([np.empty(0), *found]))
        return np.asarray(met[met > 0.0])

    every, undamped = natural_frequencies(model)
    return speeds(every), speeds(undamped)


def rms(lines: Complex) -> Array:
    """Root mean square over time of lines of different frequencies, shape (L, ...) -> (...)."""
    return np.asarray(np.sqrt(0.5 * (np.abs(lines) ** 2).sum(axis=0)))
