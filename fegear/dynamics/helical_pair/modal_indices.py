"""Modes of a helical pair and the indices that say which of them matter for which excitation (Eqs. 16, 26 to 30)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.printed import percent
from fegear.dynamics.helical_pair.model import HelicalPairModel, P, ReducedPairModel
from fegear.dynamics.train.modes import same_way_up, undamped_modes

Model = HelicalPairModel | ReducedPairModel


#: Relative round-off beyond which fewer than half of the digits are left.
HALF_THE_DIGITS = 1e-8
#: A relative mesh displacement below this is none.
_NONE = 1e-13


@dataclass(frozen=True, eq=False)
class ModeTable:
    """Modes by falling frequency, arrays of shape (n,) unless said otherwise.

    Parameters
    ----------
    ratio : ndarray
        Lambda_r = frequency / omega; 0 for rigid-body motion.
    frequency : ndarray
        Natural frequency [rad/s].
    shapes : ndarray, shape (dof, n)
        Columns of unit Euclidean norm in q.
    normal, bending : ndarray
        Delta_eta and Delta_theta_x, magnitudes of the relative mesh displacement along the tooth normal and about x
        (26, 27), each divided by its largest over all modes.
    coupling : ndarray
        abs(U_eta,theta / (U_eta + U_theta)) of the modal strain energies (30); 0 where a mode leaves the mesh alone.
    normal_force, bending_moment : ndarray
        abs(Delta_eta + kappa Delta_theta) and abs(kappa Delta_eta + mu Delta_theta): what the mesh transmits in the
        mode, for unit-norm shapes.
    frequency_doubt, shape_doubt : ndarray
        Relative round-off of each frequency and shape as the eigenvalue problem leaves it: a soft mode among stiff
        ones loses digits of its frequency, a mode near another's frequency those of its shape (where they coincide
        the shapes, and the indices that follow from them, are one choice of many).
    """

    ratio: Array
    frequency: Array
    shapes: Array
    normal: Array
    bending: Array
    coupling: Array
    normal_force: Array
    bending_moment: Array
    frequency_doubt: Array
    shape_doubt: Array

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a reader should know of digits lost: where fewer than half of them are left."""
        remarks = []
        soft = np.flatnonzero((self.frequency > 0.0) & (self.frequency_doubt > HALF_THE_DIGITS)) + 1
        near = np.flatnonzero((self.frequency > 0.0) & (self.shape_doubt > HALF_THE_DIGITS)) + 1
        if soft.size:
            remarks.append(
                f"modes {_listed(soft)}: round-off error of the frequencies "
                f"{percent(float(self.frequency_doubt[soft - 1].max()))} (very soft compared with the stiffest mode)"
            )
        if near.size:
            remarks.append(
                f"modes {_listed(near)}: repeated natural frequencies (within round-off); mode shapes and indices "
                "are not unique, only sums over these modes are meaningful"
            )
        return tuple(remarks)


def _listed(numbers: NDArray[np.int64]) -> str:
    return ", ".join(str(n) for n in numbers)


def _doubts(frequency: Array) -> tuple[Array, Array]:
    """Relative round-off of natural frequencies and of their shapes (Wilkinson; Davis and Kahan)."""
    squared = frequency**2
    noise = np.finfo(float).eps * frequency.size * max(float(squared.max()), np.finfo(float).tiny)
    apart = np.abs(squared[:, None] - squared[None, :])
    apart[np.arange(squared.size), np.arange(squared.size)] = np.inf
    with np.errstate(divide="ignore"):
        of_frequency = np.where(squared > 0.0, 0.5 * noise / np.where(squared > 0.0, squared, 1.0), 0.0)
        of_shape = np.minimum(noise / apart.min(axis=1), 1.0)
    return of_frequency, np.where(squared > 0.0, of_shape, 0.0)


def relative_motion(model: Model, shapes: Array) -> Array:
    """Mesh displacement q_i + P q_j of mode shapes (28), shape (5, n)."""
    return shapes if isinstance(model, ReducedPairModel) else shapes[:5] + P @ shapes[5:]


def mode_table(model: Model) -> ModeTable:
    """Modes of a pair with the paper's rating indices.

    Parameters
    ----------
    model : HelicalPairModel or ReducedPairModel
    """
    frequency, shapes = undamped_modes(model.mass, model.stiffness)
    shapes = same_way_up(shapes / np.linalg.norm(shapes, axis=0))
    eta, theta = mesh_displacements(model, frequency, shapes)
    frequency_doubt, shape_doubt = _doubts(frequency)
    kappa, mu = model.mesh.kappa, model.mesh.mu
    return ModeTable(
        ratio=frequency / model.natural_frequency,
        frequency=frequency,
        shapes=shapes,
        normal=over_largest(eta),
        bending=over_largest(theta),
        coupling=coupling(model, eta, theta),
        normal_force=np.abs(eta + kappa * theta),
        bending_moment=np.abs(kappa * eta + mu * theta),
        frequency_doubt=frequency_doubt,
        shape_doubt=shape_doubt,
    )


def mesh_displacements(model: Model, frequency: Array, shapes: Array) -> tuple[Array, Array]:
    """Delta_eta and Delta_theta_x of mode shapes with their signs (26, 27), shape (n,) each.

    Rigid-body motion leaves the mesh alone; what round-off leaves of it there is zero.

    Parameters
    ----------
    model : HelicalPairModel or ReducedPairModel
    frequency : ndarray, shape (n,)
        Natural frequencies; zero for rigid-body motion.
    shapes : ndarray, shape (dof, n)
        Of unit Euclidean norm in q.
    """
    relative = relative_motion(model, shapes)
    c, s = np.cos(model.mesh.base_helix_angle), np.sin(model.mesh.base_helix_angle)
    eta = c * relative[0] + s * relative[1] - s * relative[3] + c * relative[4]
    eta, theta = (np.where((frequency > 0.0) & (np.abs(v) >= _NONE), v, 0.0) for v in (eta, relative[2]))
    return eta, theta


def over_largest(index: Array) -> Array:
    """Sizes over the largest of all modes."""
    return np.asarray(np.abs(index) / max(float(np.abs(index).max()), _NONE))


def coupling(model: Model, eta: Array, theta: Array) -> Array:
    """abs(U_eta,theta / (U_eta + U_theta)) of mesh displacements (30); 0 where a mode leaves the mesh alone."""
    energy = 0.5 * eta**2 + 0.5 * model.mesh.mu * theta**2
    mixed = np.abs(model.mesh.kappa * eta * theta)
    return np.divide(mixed, energy, out=np.zeros_like(mixed), where=energy > 0.0)


@dataclass(frozen=True, slots=True)
class RankedMode:
    """One line of the ranking: mode r (1 = highest frequency) for an excitation.

    ``weight`` is the modal mesh force or moment that the excitation drives, relative to the strongest mode;
    ``resonance`` the amplitude of that mode's share of the transmitted force at its own resonance, per unit
    excitation displacement and relative to K_M (mass-normalised, over 2 zeta Lambda^2; infinite without damping).
    """

    excitation: str
    rank: int
    mode: int
    ratio: float
    weight: float
    resonance: float


def rank_modes(model: Model) -> list[RankedMode]:
    """Modes ranked for the two ways in which a mesh can be excited.

    "normal" stands for transmission errors delta_y, delta_z, delta_theta_y, delta_theta_z and forces and moments
    along them; "bending" for delta_theta_x and moments about x.
    """
    table = mode_table(model)
    _, shapes = undamped_modes(model.mass, model.stiffness)
    relative = relative_motion(model, shapes)
    K = model.mesh_stiffness_matrix
    c, s = np.cos(model.mesh.base_helix_angle), np.sin(model.mesh.base_helix_angle)
    directions = {"normal": np.array([c, s, 0.0, -s, c]) / 2.0, "bending": np.array([0.0, 0.0, 1.0, 0.0, 0.0])}
    # A displacement along a direction excites the mode through K_M; two equal gears are driven from both sides.
    sides = 2.0 if isinstance(model, ReducedPairModel) else 1.0
    zeta = np.einsum("ir,ij,jr->r", shapes, model.damping, shapes)
    rows = []
    for name, direction in directions.items():
        weight = table.normal_force if name == "normal" else table.bending_moment
        weight = weight / max(weight.max(), 1e-300)
        drive = np.abs(direction @ K @ relative)
        with np.errstate(divide="ignore", invalid="ignore"):
            peak = np.where(drive > 0.0, sides * drive**2 / (zeta * table.frequency), 0.0) / model.mesh.stiffness
        for rank, r in enumerate(np.argsort(-weight, kind="stable")):
            peak_r = 0.0 if table.frequency[r] == 0.0 else float(peak[r])
            rows.append(RankedMode(name, rank + 1, int(r) + 1, float(table.ratio[r]), float(weight[r]), peak_r))
    return rows
