"""A ring gear with its width in a spline: the ring that nothing holds, and even tractions that carry its loads.

As in the plane (`fegear.fem.plane.rim`), with six rigid motions R in the place of three. W are the tractions that are
as even as these motions over the outer cylinder; force, torque, thrust and the moments that tilt the ring leave by
them, and the outer cylinder does not move on average. The ring is lent a stiffness against its rigid motions, harmonics
0 (thrust and turn) and 1 (translations and tilts), which gives a generalised inverse G; what it lent leaves again in

    C = P G P',   P = 1 - R (W' R)^-1 W'.

Only G W couples all sectors, and W has the harmonics 0 and 1 alone: two solutions of the sides give it.

Motions are in the axes of the section, which turn with the helix: a translation has sines and cosines along the face
there, which the functions along the face take to their own accuracy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index
from fegear.fem.plane.ring_closure import closed_ring, harmonic_stiffness
from fegear.fem.plane.trace import lagrange, lagrange_slope

if TYPE_CHECKING:
    from fegear.fem.plane.condensation import Condensed
    from fegear.fem.plane.ring_closure import RigidSides, Ring
    from fegear.fem.solid.face import FaceFunctions
    from fegear.fem.solid.section import Section
    from fegear.fem.solid.unknowns import Unknowns

#: Motions of which plane strain has only those in the plane: two translations and the turn.
_IN_PLANE = (0, 1, 5)
_ALL = tuple(range(6))
#: Motions that unknowns take part in by less than this share of the largest are round-off.
_NONE = 1e-9


@dataclass(frozen=True)
class SolidRim:
    """Rigid motions of a sector and even tractions on its part of the outer cylinder.

    Parameters
    ----------
    motions : ndarray, shape (size of the section, functions, d)
        Translations along x, y and z, then turns about them (right-handed), as far as there are any.
    tractions : ndarray, shape (size of the section, functions, d)
        Zero off the outer cylinder.
    which : tuple of int
        d of the six.
    """

    motions: Array
    tractions: Array
    which: tuple[int, ...]

    def of(self, known: Unknowns) -> SolidRim:
        """Those in which the unknowns take part; the others belong to the other half of a split."""
        there = known.number >= 0
        size = np.abs(self.motions[there]).max(axis=0)
        moves = [i for i in range(len(self.which)) if size[i] > _NONE * np.abs(self.motions[..., i]).max()]
        return SolidRim(self.motions[..., moves], self.tractions[..., moves], tuple(self.which[i] for i in moves))

    def turned(self, angle: float) -> Array:
        """From the ring's motions to those in the frame of a sector that lies so far clockwise, shape (d, d)."""
        c, s = math.cos(angle), math.sin(angle)
        turn = np.kron(np.eye(2), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
        return np.asarray(turn[np.ix_(self.which, self.which)])

    @property
    def waves(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Motions of harmonics 0 and 1, shape (d, 1 or 2) each: turned by one pitch they are exp(i n theta) times."""
        every = np.zeros((2, 6, 2), dtype=complex)
        every[0, [2, 5], [0, 1]] = 1.0
        every[1, [0, 3], [0, 1]] = 1.0
        every[1, [1, 4], [0, 1]] = -1.0j
        one, two = (wave[list(self.which)] for wave in every)
        return one[:, one.any(axis=0)], two[:, two.any(axis=0)]


def solid_rim(section: Section, face: FaceFunctions, counts: Index, *, plane_strain: bool = False) -> SolidRim:
    """Rigid motions and even tractions of a section.

    Parameters
    ----------
    section : Section
    face : FaceFunctions
        One piece over the whole face.
    counts : ndarray of int, shape (N,)
        How many functions each node has.
    plane_strain : bool
        Nothing moves along the axis.
    """
    z, weight = face.quadrature(least=2 * face.count)
    values = face.values(z)
    x, y = section.places
    c, s = np.cos(section.tau * z), np.sin(section.tau * z)
    one, none = np.ones_like(z), np.zeros_like(z)
    # Unit vectors along x, y, z in axes that turn with the helix.
    axis = np.array([[c, -s, none], [s, c, none], [none, none, one]])
    moved = np.zeros((x.size, 3, z.size, 6))
    moved[..., :3] = axis.transpose(1, 2, 0)
    place = np.stack(np.broadcast_arrays(x[:, None], y[:, None], z), axis=-1)
    for i in range(3):
        moved[..., 3 + i] = np.cross(axis[i].T, place).transpose(0, 2, 1)
    mass = (values * weight) @ values.T
    right = np.einsum("kq,ncqd->nckd", values * weight, moved, optimize=True)
    motion = np.zeros_like(right)
    for count in np.unique(counts):
        some, n = counts == count, int(count)
        motion[some, :, :n] = np.einsum("kl,ncld->nckd", np.linalg.inv(mass[:n, :n]), right[some, :, :n])
    nodes, edges, p = section.edge_nodes["bore"], section.edge_places["bore"], section.order
    xi, share = np.polynomial.legendre.leggauss(12)
    xi, share = 0.5 + 0.5 * xi, 0.5 * share
    speed = np.hypot(*np.einsum("cin,iq->cnq", edges, lagrange_slope(edges.shape[1] - 1, xi)))
    shape = lagrange(p, xi)
    line = np.einsum("iq,jq,q,nq->nij", shape, shape, share, speed)
    even = np.zeros_like(motion)
    for i in range(p + 1):
        for j in range(p + 1):
            np.add.at(even, nodes[i], np.einsum("n,kl,ncld->nckd", line[:, i, j], mass, motion[nodes[j]]))
    own = np.linalg.solve(section.axes[:, None, None], motion.transpose(0, 2, 3, 1)[..., None])[..., 0]
    work = np.einsum("nce,nckd->nekd", section.axes, even)
    which = _IN_PLANE if plane_strain else _ALL
    size = (section.size, face.count, 6)
    motions = own.transpose(0, 3, 1, 2).reshape(size)[..., which]
    return SolidRim(motions, work.reshape(size)[..., which], which)


@dataclass(frozen=True)
class FreeRing:
    """A ring that nothing holds, with the stiffness that it was lent against its rigid motions.

    Parameters
    ----------
    ring : Ring
    moved, pressed : ndarray, shape (ports, d)
        Rigid motions and even tractions at the ports of a sector.
    rim : SolidRim
        What of the motions there is.
    rigid : RigidSides or None
        Of the sides; None if there is no motion.
    sides : ndarray, shape (2 m, 2 m)
        Stiffness between the sides, nothing inside held.
    place : ndarray of int, shape (size,)
        Where unknowns stand among the ports; -1 for others.
    """

    ring: Ring
    moved: Array
    pressed: Array
    rim: SolidRim
    rigid: RigidSides | None
    sides: Array
    place: Index

    def moves(self, n: int, ports: Index | slice, forces: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """Motion of side A in the n-th harmonic under harmonic forces on ports, shape (m, P)."""
        return np.asarray(np.linalg.solve(self.stiffness(n), self.followed(n, ports).conj().T @ forces))

    def stiffness(self, n: int) -> NDArray[np.complex128]:
        """K_n, shape (m, m)."""
        return harmonic_stiffness(self.sides, n, self.ring.teeth, self.rigid)

    def followed(self, n: int, ports: Index | slice) -> NDArray[np.complex128]:
        """How ports follow side A in the n-th harmonic, shape (ports, m)."""
        turn = np.exp(2.0j * math.pi * n / self.ring.teeth)
        return np.asarray(self.ring.follow_a[ports] + turn * self.ring.follow_b[ports])


def free_ring(
    sector: Condensed, side: int, rim: SolidRim, known: Unknowns, teeth: int, reach: int, started: float
) -> FreeRing:
    """Close the ring of a sector of which nothing is held.

    Parameters
    ----------
    sector : Condensed
        Its ports are the sides, the outer cylinder, and what is loaded or watched.
    side : int
        Unknowns of one side.
    rim : SolidRim
    known : Unknowns
    teeth, reach : int
    started : float
        Clock when condensing began.
    """
    rim, there = rim.of(known), known.number >= 0
    motion, traction = np.zeros((2, known.size, len(rim.which)))
    motion[known.number[there]], traction[known.number[there]] = rim.motions[there], rim.tractions[there]
    moved, pressed = motion[sector.kept], traction[sector.kept]
    # What round-off leaves of the sector's stiffness against rigid motions is as much as a thin ring bends with.
    rigid: RigidSides | None = None
    if rim.which:
        q = np.linalg.qr(moved)[0]
        off = sector.stiffness @ q
        stiffness = sector.stiffness - off @ q.T - q @ off.T + q @ (q.T @ off) @ q.T
        sector = replace(sector, stiffness=0.5 * (stiffness + stiffness.T))
        waves = rim.waves
        rigid = (moved[:side] @ waves[0].real, moved[:side] @ waves[1])
    ring = closed_ring(sector, side, None, teeth, reach, started=started, rigid=rigid)
    sides = sector.stiffness[: 2 * side] @ np.hstack([ring.follow_a, ring.follow_b])
    place = np.full(known.size, -1)
    place[sector.kept] = np.arange(sector.kept.size)
    return FreeRing(ring, moved, pressed, rim, rigid, sides, place)


def splined_response(free: FreeRing, loaded: Index, watch: Index) -> dict[int, Array]:
    """Displacements of watched ports on sectors -reach..reach of a splined ring under forces on sector 0.

    Parameters
    ----------
    free : FreeRing
    loaded, watch : ndarray of int
        Unknowns.

    Returns
    -------
    dict of int to ndarray, shape (watch, loaded)
    """
    ring, rim, moved, pressed = free.ring, free.rim, free.moved, free.pressed
    if not rim.which:
        return ring.respond(loaded, watch)
    teeth = ring.teeth
    # G W, on all ports: sector 0's share of what even tractions on all sectors do.
    mean = np.zeros_like(pressed)
    for n, wave in enumerate(rim.waves):
        if wave.size:
            load = pressed @ wave
            answer = free.followed(n, slice(None)) @ free.moves(n, slice(None), load) + ring.own @ load
            mean += np.real(answer @ np.linalg.pinv(wave)) * (1.0 if n == 0 else 2.0)
    pitch = 2.0 * math.pi / teeth
    turns = np.stack([rim.turned(k * pitch) for k in range(teeth)])
    inverse = np.linalg.inv(np.einsum("kab,ac,kcd->bd", turns, moved.T @ pressed, turns))
    twice = np.einsum("kab,ac,kcd->bd", turns, mean.T @ pressed, turns)
    rows, columns = free.place[watch], free.place[loaded]
    response = {}
    for k, lent in ring.respond(loaded, watch).items():
        to, away, here = rim.turned(k * pitch) @ inverse, moved[rows], moved[columns]
        taken = away @ (to @ mean[columns].T) + (mean[rows] @ to) @ here.T
        response[k] = lent - taken + away @ (to @ twice @ inverse) @ here.T
    return response
