"""Mesh and bearing force transmissibility of a helical pair (Blankenship and Singh, Eqs. 13 to 25, 37 to 39).

Rigid-body motion deflects neither mesh nor bearings. It is removed from every matrix here, exactly, so that forces
stay accurate down to frequency zero, where the compliance itself does not exist.
"""

from __future__ import annotations

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
        raise InputError("frequency", frequency, "must be finite frequencies, not negative")
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
        raise RangeError(
            "frequency", float(w[np.argmax(hit)]), "is a resonance without damping: the response is unbounded",
            "give damping or move the frequency",
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
        raise ConvergenceError(
            "Damping is critical for a mode: its two complex modes coincide and have no modal sum. "
            "Use the direct method."
        )
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
