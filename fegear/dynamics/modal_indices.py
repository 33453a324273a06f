"""Modes of a helical pair and the indices that say which of them matter for which excitation (Eqs. 16, 26 to 30)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.helical_pair import HelicalPairModel, P, ReducedPairModel
from fegear.dynamics.natural_modes import undamped_modes
from fegear.errors import ConvergenceError, InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from fegear.arrays import Array

    Model = HelicalPairModel | ReducedPairModel

#: Relative round-off beyond which fewer than half of the digits are left.
HALF_THE_DIGITS = 1e-8


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
        Relative round-off of each frequency and shape as the eigenvalue problem leaves it: a soft mode beside stiff
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
                f"modes {_listed(soft)} are so soft beside the stiffest that round-off leaves their frequencies "
                f"{float(self.frequency_doubt[soft - 1].max()):.0e} of doubt"
            )
        if near.size:
            remarks.append(
                f"modes {_listed(near)} share a frequency with another to within round-off: their shapes and indices "
                "are one choice of many, and only sums over such modes mean something"
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
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    relative = relative_motion(model, shapes)
    c, s = np.cos(model.mesh.base_helix_angle), np.sin(model.mesh.base_helix_angle)
    kappa, mu = model.mesh.kappa, model.mesh.mu
    eta = c * relative[0] + s * relative[1] - s * relative[3] + c * relative[4]
    theta = relative[2]
    # Rigid motion leaves the mesh alone; what is left there is round-off.
    eta, theta = (np.where(frequency > 0.0, v, 0.0) for v in (eta, theta))
    small = 1e-13
    eta, theta = (np.where(np.abs(v) < small, 0.0, v) for v in (eta, theta))
    frequency_doubt, shape_doubt = _doubts(frequency)
    energy = 0.5 * eta**2 + 0.5 * mu * theta**2
    mixed = np.abs(kappa * eta * theta)
    coupling = np.divide(mixed, energy, out=np.zeros_like(mixed), where=energy > 0.0)
    return ModeTable(
        ratio=frequency / model.natural_frequency,
        frequency=frequency,
        shapes=shapes,
        normal=np.abs(eta) / max(np.abs(eta).max(), small),
        bending=np.abs(theta) / max(np.abs(theta).max(), small),
        coupling=coupling,
        normal_force=np.abs(eta + kappa * theta),
        bending_moment=np.abs(kappa * eta + mu * theta),
        frequency_doubt=frequency_doubt,
        shape_doubt=shape_doubt,
    )


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


@dataclass(frozen=True, eq=False)
class TrackedModes:
    """Modes followed over a parameter.

    Parameters
    ----------
    values : ndarray, shape (m,)
        Parameter values.
    ratio : ndarray, shape (m, n)
        Lambda of each branch, numbered by falling frequency at the first value.
    shapes : ndarray, shape (m, dof, n)
        Mass-normalised shapes, signs continuous.
    likeness : float
        Least modal assurance between neighbouring steps on any branch.
    """

    values: Array
    ratio: Array
    shapes: Array
    likeness: float


def track_modes(
    build: Callable[[float], Model], values: ArrayLike, *, least: float = 0.8, depth: int = 20
) -> TrackedModes:
    """Follow modes by their shape over a parameter such as helix angle or bearing stiffness.

    Steps between neighbouring values are halved until every mode resembles its successor. Branches that cross are
    followed through; a veering much narrower than the steps counts as a crossing, because the shapes pass through it.

    Parameters
    ----------
    build : callable
        Parameter -> model; masses may change, the number of coordinates may not.
    values : array_like, shape (m,)
        Parameter values in the order to follow.
    least : float
        Least modal assurance to accept for a step.
    depth : int
        Largest number of halvings.

    Raises
    ------
    ConvergenceError
        If modes still change abruptly after that many halvings.
    """
    from scipy.optimize import linear_sum_assignment

    grid = np.asarray(values, dtype=float)
    if grid.ndim != 1 or grid.size < 1:
        raise InputError("values", grid.shape, "must be at least one parameter value")

    def modes(value: float) -> tuple[Array, Array, Array]:
        model = build(value)
        frequency, shape = undamped_modes(model.mass, model.stiffness)
        return frequency / model.natural_frequency, shape, model.mass

    def match(old: tuple[Array, Array, Array], new: tuple[Array, Array, Array]) -> tuple[Array, Array, float]:
        likeness = _subspace_likeness(old, new)
        _, order = linear_sum_assignment(-likeness)
        chosen = new[1][:, order]
        sign = np.sign(np.einsum("ir,i,ir->r", old[1], new[2], chosen))
        return new[0][order], chosen * np.where(sign == 0.0, 1.0, sign), float(likeness[range(order.size), order].min())

    def follow(
        old: tuple[Array, Array, Array], start: float, stop: float, left: int
    ) -> tuple[tuple[Array, Array, Array], float]:
        new = modes(stop)
        ratio, shape, likeness = match(old, new)
        if likeness >= least:
            return (ratio, shape, new[2]), likeness
        if left == 0:
            raise ConvergenceError(
                f"Modes change abruptly between {start:.9g} and {stop:.9g} (likeness {likeness:.2g} after {depth} "
                "halvings). The branches meet there: choose values that avoid the point."
            )
        middle, first = follow(old, start, 0.5 * (start + stop), left - 1)
        state, second = follow(middle, 0.5 * (start + stop), stop, left - 1)
        return state, min(first, second)

    state, least_seen = modes(float(grid[0])), 1.0
    states = [state]
    for start, stop in pairwise(grid):
        state, seen = follow(state, float(start), float(stop), depth)
        least_seen = min(least_seen, seen)
        states.append(state)
    return TrackedModes(grid, np.array([s[0] for s in states]), np.array([s[1] for s in states]), least_seen)


def _subspace_likeness(old: tuple[Array, Array, Array], new: tuple[Array, Array, Array]) -> Array:
    """Modal assurance of all pairs; modes of one frequency count as one space, because their basis is arbitrary."""
    root = np.sqrt(new[2])[:, None]
    a, b = root * old[1], root * new[1]
    assurance = (a.T @ b) ** 2 / np.outer((a**2).sum(0), (b**2).sum(0))
    top = max(float(old[0].max()), 1e-300)
    for ratio, axis in ((new[0], 1), (old[0], 0)):
        alike = np.abs(ratio[:, None] - ratio[None, :]) <= 1e-7 * top
        if alike.sum() > ratio.size:
            shared = np.minimum(assurance @ alike if axis == 1 else alike @ assurance, 1.0)
            single = alike.sum(axis=0) == 1
            assurance = np.where(single[None, :] if axis == 1 else single[:, None], assurance, shared)
    return assurance
