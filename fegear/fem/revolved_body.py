"""How the body of a gear resists what turns and bends its bore, and carries it to its teeth: waves round the axis.

The body between its seat on the shaft and the root circle is a body of revolution. Its seat moves with the sections of
the shaft, which stay plane and round: they turn about the axis by phi (the wave 0), or move across it by X and tilt by
theta (the wave 1; a second plane is alike). No other wave is moved by the shaft. Finite elements in r and z, condensed
to the seat with free teeth, give the forces S q that hold the seat in its motion q, and T q, how the ring under the
teeth moves with it; what forces at the teeth bring to the seat is T^T of them (reciprocity). How teeth and body give
way above a seat that stays is the solved gear's own, so nothing is counted twice.

The torsion of a body of revolution by one function of r and z is J. H. Michell's, The uniform torsion and flexure of
incomplete tores, Proceedings of the London Mathematical Society 31 (1899); waves round the axis are E. L. Wilson's,
Structural analysis of axisymmetric solids, AIAA Journal 3 (1965).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse.linalg

from fegear.base.arrays import Array, distinct
from fegear.geometry.body_along import BodyAlong, body_along

if TYPE_CHECKING:
    from skfem import Basis

    from fegear.base.arrays import Index

#: Layers of elements along the axis at least and at most, and how many over a radius of the seat.
_LAYERS, _MOST, _PER_RADIUS = 8, 32, 2.0
#: By what elements grow away from the seat and the teeth.
_GROWTH = 1.5
#: Places along the axis or the radius that are this near to each other, as a share of the width, are one.
_NEAR = 1e-6


@dataclass(frozen=True, slots=True)
class RevolvedBody:
    """A body round a shaft; places along the axis from the middle of the face [m].

    Parameters
    ----------
    outer : float
        Radius of the root circle [m].
    width : float
        Of the face [m].
    rings : tuple of (float, float, float)
        Inner radius of each ring, from the teeth inward, and the two ends that it fills; the last one is the seat's.
    held : (float, float)
        Ends of the part of the face on which it sits fast [m].
    poisson_ratio : float
    lean : float
        Tangent of the inclination of the second ring, the web, whose ends are those at the first: positive if it lies
        at greater places further inward.
    """

    outer: float
    width: float
    rings: tuple[tuple[float, float, float], ...]
    held: tuple[float, float]
    poisson_ratio: float = 0.3
    lean: float = 0.0

    @property
    def seat(self) -> float:
        """Radius at which the body sits on its shaft [m]."""
        return self.rings[-1][0]

    @property
    def along(self) -> BodyAlong | None:
        """Places that follow an inclined web inward; None of others."""
        if not self.lean:
            return None
        web = self.rings[1]
        shift = self.lean * (self.rings[0][0] - web[0])
        foot = web[1] + shift, web[2] + shift
        return body_along(web[1:], foot if len(self.rings) == 2 else self.rings[2][1:], shift, self.width)


@dataclass(frozen=True)
class CondensedBody:
    """What a body does to its shaft, of a Young's modulus of one; as `RevolvedBody` counts places.

    Parameters
    ----------
    seat, teeth : ndarray, shapes (n,), (k,)
        Places of the nodes on the seat and at the root circle, ascending [m].
    torsion : ndarray, shape (n, n - 1)
        A root B of the stiffness against turning about the axis, S = B B^T [m^3].
    bending : ndarray, shape (2 n, 2 n - 2)
        That against moving across the axis (first n) and tilting.
    turned : ndarray, shape (k, n)
        T of turning.
    moved : ndarray, shape (2 k, 2 n)
        T of moving and tilting.
    """

    seat: Array
    teeth: Array
    torsion: Array
    bending: Array
    turned: Array
    moved: Array


@lru_cache(maxsize=64)
def condensed(body: RevolvedBody, fineness: int = 1) -> CondensedBody:
    """Condense a body to its seat.

    Parameters
    ----------
    body : RevolvedBody
    fineness : int
        Elements in each direction over the usual number.
    """
    basis, seat, teeth = _basis(body, fineness)
    z, top = basis.doflocs[1, seat], basis.doflocs[1, teeth]
    n, r = z.size, body.seat
    none = np.zeros((n, n))
    turned, torsion = _held(basis, seat, r * np.eye(n), body.poisson_ratio, 0)
    motion = np.block([[np.eye(n), none], [-np.eye(n), none], [none, -r * np.eye(n)]])
    moved, bending = _held(basis, seat, motion, body.poisson_ratio, 1)
    across, tilted = 0.5 * (moved[0, teeth] - moved[1, teeth]), -moved[2, teeth] / body.outer
    turns, lines = [np.ones((one.size, 1)) for one in (z, top)], [_line(one) for one in (z, top)]
    return CondensedBody(
        z, top, _root(torsion, turns[0]), _root(bending, lines[0]), _rigidly(turned[0, teeth] / body.outer, *turns),
        _rigidly(np.vstack([across, tilted]), *lines),
    )  # fmt: skip


def _line(z: Array) -> Array:
    """Moving across the axis and tilting as a whole, shape (2 n, 2)."""
    return np.vstack([np.stack([np.ones_like(z), z], axis=1), np.stack([np.zeros_like(z), np.ones_like(z)], axis=1)])


def _rigidly(carried: Array, seat: Array, teeth: Array) -> Array:
    """T that carries motions of the whole body without the round-off of its solution."""
    whole = np.linalg.pinv(seat)
    return np.asarray(carried - carried @ seat @ whole + teeth @ whole)


def _basis(body: RevolvedBody, fineness: int) -> tuple[Basis, Index, Index]:
    """Elements of the body, and its nodes on the seat and under the teeth, along the axis."""
    from skfem import Basis, ElementQuad2, MeshQuad

    layers = min(max(_LAYERS, math.ceil(_PER_RADIUS * body.width / body.seat)), _MOST)
    half, size = 0.5 * body.width, body.width / (layers * fineness)
    along, spans, held = body.along, [one[1:] for one in body.rings], np.array(body.held)
    if along is not None:
        spans[2:], held = [along.hub] * (len(spans) - 2), along.of_hub(held)
    ends = distinct(np.array([-half, half]), held, *(np.array(one) for one in spans))
    ends = ends[np.append(True, np.diff(ends) > _NEAR * body.width)]
    radii = [body.outer, *(inner for inner, _, _ in body.rings)]
    z = [np.linspace(a, b, max(1, math.ceil((b - a) / size - 1e-9)) + 1) for a, b in pairwise(ends)]
    r = [_graded(inner, outer, 0.5 * size) for outer, inner in pairwise(radii)]
    mesh = MeshQuad.init_tensor(np.unique(np.concatenate(r)), np.unique(np.concatenate(z)))
    at = mesh.p[:, mesh.t].mean(axis=1)
    filled = np.zeros(at.shape[1], dtype=bool)
    for outer, inner, (low, high) in zip(radii, radii[1:], spans, strict=False):
        filled |= (at[0] < outer) & (at[0] > inner) & (at[1] > low) & (at[1] < high)
    mesh = mesh.restrict(np.flatnonzero(filled))
    if along is not None:
        r, own = mesh.p
        hub = r <= radii[2] + _NEAR * body.width
        leaning = np.where(hub, along.in_hub(own), own + body.lean * np.maximum(radii[1] - r, 0.0))
        mesh = MeshQuad(np.stack([r, leaning]), mesh.t)
    basis = Basis(mesh, ElementQuad2())
    place = basis.doflocs
    near = _NEAR * body.width
    on = [np.flatnonzero(np.abs(place[0] - radius) <= near) for radius in (body.seat, body.outer)]
    low, high = body.held
    on[0] = on[0][(place[1, on[0]] >= low - near) & (place[1, on[0]] <= high + near)]
    seat, teeth = (nodes[np.argsort(place[1, nodes])] for nodes in on)
    return basis, seat, teeth


def _graded(start: float, end: float, size: float) -> Array:
    """Points between two radii, `size` apart at both and farther in the middle; at least two elements."""
    steps = [size]
    while 2.0 * sum(steps) < end - start:
        steps.append(_GROWTH * steps[-1])
    both = np.cumsum([*steps, *steps[::-1]])
    return np.append(start, start + (end - start) * both / both[-1])


def _held(basis: Basis, seat: Index, motion: Array, nu: float, waves: int) -> tuple[Array, Array]:
    """Displacements of all nodes under unit motions of the seat, shape (c, N, q), and the forces that hold it there.

    Components c are V alone in the wave 0, else U, V and W.
    """
    from fegear.fem.forms import revolved_strains, stresses

    parts = (1,) if waves == 0 else (0, 1, 2)
    value = np.stack([np.asarray(one) for (one,) in basis.basis])  # (9, elements, quadrature)
    slope = np.stack([one.grad for (one,) in basis.basis], axis=1)
    unit = np.eye(3)[list(parts)]
    strain = revolved_strains(
        np.einsum("cd,j...->dcj...", unit, value), np.einsum("cd,kj...->dkcj...", unit, slope),
        basis.global_coordinates()[0], waves,
    )  # fmt: skip
    stress = stresses(strain, nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu))
    weight = basis.dx * basis.global_coordinates()[0] * (math.pi if waves else 2.0 * math.pi)
    own = np.einsum("scieq,sdjeq,eq->ecidj", strain, stress, weight, optimize=True)
    numbers = basis.element_dofs.T[:, None, :] + basis.N * np.arange(len(parts))[:, None]
    rows = np.broadcast_to(numbers[..., None, None], own.shape)
    columns = np.broadcast_to(numbers[:, None, None], own.shape)
    size = basis.N * len(parts)
    matrix = scipy.sparse.csr_array((own.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
    held = (seat + basis.N * np.arange(len(parts))[:, None]).ravel()
    free = np.setdiff1d(np.arange(size), held)
    found = np.zeros((size, motion.shape[1]))
    found[held] = motion
    found[free] = scipy.sparse.linalg.splu(matrix[free][:, free].tocsc()).solve(-(matrix[free][:, held] @ motion))
    return found.reshape(len(parts), basis.N, -1), np.asarray(motion.T @ (matrix[held] @ found))


def _root(stiffness: Array, rigid: Array) -> Array:
    """B of S = B B^T without the motions that need no force."""
    rigid, _ = np.linalg.qr(rigid)
    free = np.eye(len(stiffness)) - rigid @ rigid.T
    values, vectors = np.linalg.eigh(free @ (0.5 * (stiffness + stiffness.T)) @ free)
    kept = slice(rigid.shape[1], None)
    return np.asarray(vectors[:, kept] * np.sqrt(np.maximum(values[kept], 0.0)))
