"""The whole gear at the price of one tooth: condense a sector onto its sides and close the ring by Fourier harmonics.

One sector is factored with its sides held. What remains couples only the unknowns of side A and side B, in polar
components; harmonic n of the ring ties them by u_B = exp(i theta_n) u_A, theta_n = 2 pi n / z, and has the matrix

    K_n = (S_aa + S_bb) + e S_ab + conj(e) S_ba,   e = exp(i theta_n).

Loads act on sector 0 only, so the response of sector k follows from the real matrices
H_k = (1/z) sum_n exp(i k theta_n) / K_n; harmonics n and z - n are conjugate and share one inverse.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.errors import FegearError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.fem.elasticity import SectorElasticity
    from fegear.fem.mesh import SectorMesh

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

#: Inverses of this many complex numbers are held at once while the harmonics are summed.
_BATCH = 2_000_000


@dataclass(frozen=True)
class Ring:
    """A factored ring of z equal sectors with the bore held; E = 1, lengths in modules.

    Parameters
    ----------
    factor : SuperLU
        Of the inner unknowns (neither bore nor sides).
    inner, side_a, side_b : ndarray of int
        Unknowns inside, and on the two sides in matching order (x and y of a node beside each other).
    polar : ndarray, shape (2, 2, nodes)
        Turns each side node's polar components (on side A, side B alike) into x and y: see `_polar`.
    side_response_a, side_response_b : ndarray, shape (inner, m)
        Y_a, Y_b: inner response to unit polar side displacements, with the sign of S_pp^-1 S_pa.
    coupling : dict of int to ndarray, shape (m, m)
        H_k for k = -reach-1 .. reach+1.
    teeth, reach, size : int
        z, the neighbours K that can be asked for, the number of unknowns of a sector.
    seconds : dict of str to float
    """

    factor: Any
    inner: Index
    side_a: Index
    side_b: Index
    turn_a: Array
    turn_b: Array
    side_response_a: Array
    side_response_b: Array
    coupling: dict[int, Array]
    teeth: int
    reach: int
    size: int
    seconds: dict[str, float]

    def respond(self, loads: Array, watch: Index, reach: int | None = None) -> dict[int, Array]:
        """Displacements of watched unknowns on sectors -reach..reach under loads on sector 0.

        Parameters
        ----------
        loads : ndarray, shape (size, P)
            Forces on the unknowns of sector 0, its sides included.
        watch : ndarray of int, shape (q,)
            Unknowns of a sector whose displacement is wanted, in that sector's own frame.
        reach : int, optional
            At most the ring's own.

        Returns
        -------
        dict of int to ndarray, shape (q, P)
        """
        reach = self.reach if reach is None else reach
        inside = self.factor.solve(np.ascontiguousarray(loads[self.inner]))
        drive_a, drive_b = self._drive(loads)
        row = np.full(self.size, -1, dtype=np.int64)
        row[self.inner] = np.arange(self.inner.size)
        rows = row[watch]
        ya = np.where(rows[:, None] >= 0, self.side_response_a[rows], 0.0)
        yb = np.where(rows[:, None] >= 0, self.side_response_b[rows], 0.0)
        own = np.where(rows[:, None] >= 0, inside[rows], 0.0)
        # Watched unknowns on the sides move with the sides themselves.
        ta, tb = self._side_rows(watch)
        answer = {}
        for k in range(-reach, reach + 1):
            a, b = self._side_motion(k, drive_a, drive_b), self._side_motion(k + 1, drive_a, drive_b)
            answer[k] = (ta - ya) @ a + (tb - yb) @ b + (own if k % self.teeth == 0 else 0.0)
        return answer

    def _drive(self, loads: Array) -> tuple[Array, Array]:
        f = loads[self.inner]
        return (
            self.turn_a.T @ loads[self.side_a] - self.side_response_a.T @ f,
            self.turn_b.T @ loads[self.side_b] - self.side_response_b.T @ f,
        )

    def _side_motion(self, k: int, drive_a: Array, drive_b: Array) -> Array:
        """Polar displacement of side A of sector k (which is side B of sector k - 1)."""
        return self.coupling[k] @ drive_a + self.coupling[k - 1] @ drive_b

    def _side_rows(self, watch: Index) -> tuple[Array, Array]:
        rows = []
        for side, turn in ((self.side_a, self.turn_a), (self.side_b, self.turn_b)):
            place = np.full(self.size, -1, dtype=np.int64)
            place[side] = np.arange(side.size)
            at = place[watch]
            rows.append(np.where(at[:, None] >= 0, turn[at], 0.0))
        return rows[0], rows[1]

    def field(self, loads: Array, sectors: list[int]) -> dict[int, Array]:
        """Displacements of every unknown of chosen sectors (only within the reach), each in its own frame."""
        everything = np.arange(self.size)
        response = self.respond(loads, everything, max(abs(k) for k in sectors))
        return {k: response[k] for k in sectors}


def close_ring(mesh: SectorMesh, elasticity: SectorElasticity, reach: int = 1) -> Ring:
    """Factor a sector once and close the ring.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    reach : int
        K: neighbours -K..K can be asked for afterwards.

    Returns
    -------
    Ring

    Raises
    ------
    InputError
        If the sides do not match node by node.
    FegearError
        If the stiffness is singular.
    """
    from scipy.sparse.linalg import splu

    started = time.perf_counter()
    z = mesh.teeth
    side_a, side_b, angle_a = _matching_sides(mesh, elasticity)
    bore = np.unique(elasticity.edge_dofs["bore"])
    free = ~np.isin(side_a, bore)
    side_a, side_b, angle_a = side_a[free], side_b[free], angle_a[free[::2]]
    size = elasticity.stiffness.shape[0]
    held = np.concatenate([bore, side_a, side_b])
    inner = np.setdiff1d(np.arange(size), held)
    K = elasticity.stiffness
    sides = np.concatenate([side_a, side_b])
    try:
        factor = splu(
            K[inner][:, inner].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            options={"SymmetricMode": True},
            diag_pivot_thresh=0.0,
        )
    except RuntimeError as problem:
        raise FegearError(f"the sector's stiffness cannot be factored: {problem}") from problem
    factored = time.perf_counter()
    turn_a, turn_b = _polar(angle_a), _polar(angle_a + 2.0 * np.pi / z)
    border = K[inner][:, sides]
    m = side_a.size
    y = factor.solve(border.toarray())
    condensed = K[sides][:, sides].toarray() - border.T @ y
    turn = np.zeros((2 * m, 2 * m))
    turn[:m, :m], turn[m:, m:] = turn_a, turn_b
    condensed = turn.T @ condensed @ turn
    condensed = 0.5 * (condensed + condensed.T)
    coupling = _ring_coupling(condensed, z, reach + 1)
    return Ring(
        factor=factor,
        inner=inner,
        side_a=side_a,
        side_b=side_b,
        turn_a=turn_a,
        turn_b=turn_b,
        side_response_a=y[:, :m] @ turn_a,
        side_response_b=y[:, m:] @ turn_b,
        coupling=coupling,
        teeth=z,
        reach=reach,
        size=size,
        seconds={"factorization": factored - started, "ring": time.perf_counter() - factored},
    )


def _ring_coupling(condensed: Array, z: int, reach: int) -> dict[int, Array]:
    """H_k = (1/z) sum_n exp(i k theta_n) / K_n for k = -reach..reach, shape (m, m) each."""
    m = condensed.shape[0] // 2
    diagonal = condensed[:m, :m] + condensed[m:, m:]
    ahead = condensed[:m, m:]
    harmonics = np.arange(z // 2 + 1)
    total = {k: np.zeros((m, m)) for k in range(reach + 1)}
    step = max(1, _BATCH // (m * m))
    for first in range(0, harmonics.size, step):
        n = harmonics[first : first + step]
        theta = 2.0 * np.pi * n / z
        e = np.exp(1j * theta)[:, None, None]
        inverse = np.linalg.inv(diagonal + e * ahead + np.conj(e) * ahead.T)
        # n = 0 and n = z/2 stand alone, every other harmonic stands for its conjugate as well
        weight = np.where((n == 0) | (2 * n == z), 1.0, 2.0) / z
        for k in total:
            phase = weight * np.exp(1j * k * theta)
            total[k] += np.tensordot(phase.real, inverse.real, 1) - np.tensordot(phase.imag, inverse.imag, 1)
    return {k: (total[k] if k >= 0 else total[-k].T) for k in range(-reach, reach + 1)}


def _polar(angle: Array) -> Array:
    """Matrix from polar components (radial, clockwise tangential) of nodes at clockwise angles to x and y, (2n, 2n)."""
    n = angle.size
    matrix = np.zeros((2 * n, 2 * n))
    i = 2 * np.arange(n)
    s, c = np.sin(angle), np.cos(angle)
    matrix[i, i], matrix[i, i + 1] = s, c
    matrix[i + 1, i], matrix[i + 1, i + 1] = c, -s
    return matrix


def _matching_sides(mesh: SectorMesh, elasticity: SectorElasticity) -> tuple[Index, Index, Array]:
    """Unknowns of both sides from the bore outward, and the clockwise angle of side A's nodes."""
    both = []
    for name in ("side_a", "side_b"):
        edges, dofs = mesh.edges[name], elasticity.edge_dofs[name]
        radius = np.hypot(*mesh.points[:, edges[:2]])
        outward = radius[0] < radius[1]
        dofs = np.where(outward, dofs, dofs[:, ::-1])
        lower = np.where(outward, radius[0], radius[1])
        sequence = np.argsort(lower)
        dofs = dofs[:, :, sequence]
        run = np.concatenate([dofs[:, :1, 0], dofs[:, 1:, :].transpose(0, 2, 1).reshape(2, -1)], axis=1)
        ends = np.sort(radius.min(axis=0)), np.sort(radius.max(axis=0))
        if not np.allclose(ends[0][1:], ends[1][:-1], rtol=1e-6):
            raise InputError("mesh", name, "is not one unbroken line from the bore to the outline")
        angles = np.arctan2(*mesh.points[:, edges[:2]])
        both.append((run.T.reshape(-1), ends, float(angles.mean())))
    (dofs_a, ends_a, angle_a), (dofs_b, ends_b, angle_b) = both
    if dofs_a.size != dofs_b.size or not np.allclose(ends_a, ends_b, rtol=1e-6):
        raise InputError(
            "mesh",
            "side_a, side_b",
            "do not carry the same nodes, so the sectors cannot be joined",
            "mesh side_b as side_a turned by one pitch",
        )
    pitch = 2.0 * np.pi / mesh.teeth
    if abs(angle_b - angle_a - pitch) > 1e-6:
        raise InputError(
            "mesh", f"{angle_b - angle_a:.8g} rad between the sides", f"must be one pitch, {pitch:.8g} rad"
        )
    return dofs_a, dofs_b, np.full(dofs_a.size // 2, angle_a)
