"""A rim on pins or in a spline: the ring that nothing holds, and the forces that its supports put on it.

The circle is the outer one of a ring gear, the bore of an external one.

Sectors' sides close to a ring as ever (`ring_closure`); only its rigid motions, harmonics 0 and 1, are left without a
stiffness. They get one, which gives a generalised inverse G of the whole ring's stiffness K. With R the rigid motions
and W the tractions that are as even as these motions over the outer circle,

    C = P G P',   P = 1 - R (W' R)^-1 W',

is the compliance of a ring whose force and torque leave by even tractions, and whose outer circle does not move on
average: a spline. It does not depend on the stiffness that was lent.

Pins hold the mean motion of parts of the circle, E' u = 0. Their forces x and the motion a of the ring as a body
follow from E' (C (f + E x) + R a) = 0 and R' (f + E x) = 0 (the force method), however teeth and pins stand to each
other. Rollers of a bearing hold that along the radius, and let the ring turn: of a and R' (f + E x) = 0 only the
shifts are left, and torque leaves by even tractions. All sums over the sectors are convolutions, and are made by
Fourier transforms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.trace import lagrange, lagrange_slope

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.ring_closure import Ring
    from fegear.geometry.rim_support import RimSupport

_GAUSS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class PinForces(ReadOnlyArrays):
    """What loads on a tooth make of pins' forces and the rigid motion, and what these make of a tooth.

    Parameters
    ----------
    by_tooth : ndarray, shape (T, d, ports)
        Motion of the pins and resultants under unit loads on the ports of tooth after tooth, from tooth -reach on, as
        many as stand differently to the pins and as many more; d is two for each pin and three (one for each roller and
        two).
    inverse : ndarray, shape (d, d)
        From these to forces and rigid motion.
    teeth, reach : int
        How many teeth stand differently to the pins; neighbours.
    """

    by_tooth: Array
    inverse: Array
    teeth: int
    reach: int

    def given(self, k: int, tooth: int, watched: slice, loaded: slice) -> Array:
        """What pins take from the motion of ports of the k-th tooth from `tooth` under loads on this one."""
        there, here = (self.by_tooth[self.reach + n] for n in (tooth % self.teeth + k, tooth % self.teeth))
        return np.asarray(there[:, watched].T @ (self.inverse @ here[:, loaded]))

    def mean(self, k: int, watched: slice, loaded: slice) -> Array:
        """The same, the mean over all teeth."""
        here = self.by_tooth[self.reach : self.reach + self.teeth]
        there = self.by_tooth[self.reach + k : self.reach + k + self.teeth]
        forces = self.inverse @ here[:, :, loaded]
        return np.asarray(np.tensordot(there[:, :, watched], forces, ((0, 1), (0, 1))) / self.teeth)


@dataclass(frozen=True)
class _Outer:
    """The outer circle of one sector: its unknowns, tractions as even as rigid motions, and edges."""

    dofs: Index
    motion: Array
    traction: Array
    edges: Index
    places: Array
    order: int

    def held(self, teeth: int, support: RimSupport, radius: float) -> Array:
        """Weights of the unknowns of every sector in the mean motion of each pin, shape (z, n, 2 pins).

        Of rollers, shape (z, n, pins).
        """
        pitch, half = 2.0 * math.pi / teeth, 0.5 * support.width / radius
        found = np.zeros((teeth, self.dofs.size, 2 * support.pins))
        ends = np.arctan2(*self.places[:, [0, -1]])  # clockwise from the tooth's centre line, (2, edges)
        for pin in range(support.pins):
            middle = support.angle + 2.0 * math.pi * pin / support.pins
            for sector in range(math.floor((middle - half) / pitch), math.ceil((middle + half) / pitch) + 1):
                at = middle - sector * pitch
                outward = np.array([[math.sin(at), math.cos(at)], [math.cos(at), -math.sin(at)]])
                for (start, end), dofs in zip(ends.T, np.moveaxis(self.edges, 2, 0), strict=True):
                    low, high = max(min(start, end), at - half), min(max(start, end), at + half)
                    if low >= high:
                        continue
                    angle = 0.5 * (low + high) + 0.5 * (high - low) * _GAUSS[0]
                    share = 0.5 * (high - low) * _GAUSS[1] / (2.0 * half)
                    weight = lagrange(self.order, (angle - start) / (end - start)) @ share
                    for c in range(2):
                        rows = np.searchsorted(self.dofs, dofs[c])
                        found[sector % teeth, rows, 2 * pin : 2 * pin + 2] += weight[:, None] * outward[:, c]
        return found[:, :, ::2] if support.rollers else found


def _outer(elasticity: SectorElasticity) -> _Outer:
    edges, places = elasticity.edge_dofs["bore"], elasticity.edge_places["bore"]
    dofs, p, curve = np.unique(edges), elasticity.order, places.shape[1] - 1
    xi, weight = 0.5 + 0.5 * _GAUSS[0], 0.5 * _GAUSS[1]
    speed = np.hypot(*np.einsum("cin,iq->cnq", places, lagrange_slope(curve, xi)))
    x, y = np.einsum("cin,iq->cnq", places, lagrange(curve, xi))
    moved = np.zeros((2, 3, *x.shape))
    moved[0, 0] = moved[1, 1] = 1.0
    moved[0, 2], moved[1, 2] = -y, x
    loads = np.einsum("iq,nq,q,crnq->cinr", lagrange(p, xi), speed, weight, moved)
    traction = np.zeros((dofs.size, 3))
    np.add.at(traction, np.searchsorted(dofs, edges), loads)
    return _Outer(dofs, rigid_motions(elasticity)[dofs], traction, edges, places, p)


def rigid_motions(elasticity: SectorElasticity) -> Array:
    """Two translations and the turn (counterclockwise) at unknowns on the boundary, shape (size, 3); NaN inside."""
    places = np.full((2, elasticity.size // 2), np.nan)
    at = np.linspace(0.0, 1.0, elasticity.order + 1)
    for name, dofs in elasticity.edge_dofs.items():
        curve = elasticity.edge_places[name]
        places[:, dofs[0] // 2] = np.einsum("cin,iq->cqn", curve, lagrange(curve.shape[1] - 1, at))
    found = np.zeros((elasticity.size, 3))
    found[::2, 0] = found[1::2, 1] = 1.0
    found[::2, 2], found[1::2, 2] = -places[1], places[0]
    return found


def supported_response(
    mesh: SectorMesh, elasticity: SectorElasticity, support: RimSupport, watch: Index, loaded: int, reach: int
) -> tuple[Mapping[int, Array], PinForces | None, Ring]:
    """Displacements of watched unknowns on sectors -reach..reach under forces on the first of them on sector 0.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    support : RimSupport
        Lengths in modules.
    watch : ndarray of int, shape (q,)
        On the boundary.
    loaded : int
        How many of them are loaded, the first ones.
    reach : int

    Returns
    -------
    response : mapping of int to ndarray, shape (q, loaded)
        On pins the mean over all teeth.
    pins : PinForces or None
        What differs from tooth to tooth.
    ring : Ring
        That nothing holds.
    """
    z, outer, motions = mesh.teeth, _outer(elasticity), rigid_motions(elasticity)
    ring = close_ring(mesh, elasticity, np.append(watch, outer.dofs), z // 2, motions=motions)
    angle = 2.0 * np.pi * np.arange(z) / z
    turn = np.zeros((z, 3, 3))  # from rigid motions of the ring to those in the frame of a sector
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 1, 0], turn[:, 2, 2] = np.sin(angle), 1.0
    turn[:, 0, 1] = -turn[:, 1, 0]
    every = [k if 2 * k <= z else k - z for k in range(z)]
    ports = np.concatenate([watch, outer.dofs])
    motion = np.vstack([motions[watch], outer.motion])
    far = ring.respond(ports, outer.dofs, sectors=every)
    lent = np.stack([far[k] for k in every])  # (z, outer, ports)
    mean = np.einsum("kab,oa,kop->bp", turn, outer.traction, lent, optimize=True)
    size = np.einsum("kab,ac,kcd->bd", turn, outer.motion.T @ outer.traction, turn)
    twice = np.einsum("kab,ac,kcd->bd", turn, mean[:, watch.size :] @ outer.traction, turn)
    inverse = np.linalg.inv(size)

    def free(k: int, response: Array, rows: slice, columns: slice) -> Array:
        there, here = motion[rows], motion[columns]
        out = response - there @ (turn[k] @ inverse @ mean[:, columns])
        out -= (mean[:, rows].T @ (turn[k] @ inverse)) @ here.T
        return np.asarray(out + there @ (turn[k] @ inverse @ twice @ inverse) @ here.T)

    seen, pressed, rim = slice(0, watch.size), slice(0, loaded), slice(watch.size, None)
    near = ring.respond(watch[:loaded], watch, sectors=list(range(-reach, reach + 1)))
    response = {k: free(k % z, u, seen, pressed) for k, u in near.items()}
    if support.pins == 0:
        return response, None, ring
    radius = float(np.hypot(*outer.places[:, 0, 0]))
    held = np.fft.fft(outer.held(z, support, radius), axis=0)
    answer = np.fft.fft(np.stack([free(k, lent[k], rim, slice(None)) for k in range(z)]), axis=0)
    work = held.conj().transpose(0, 2, 1) @ answer
    pins = np.real(work[:, :, watch.size :] @ held).sum(axis=0) / z
    ways = 2 if support.rollers else 3
    rigid = np.einsum("kon,oa,kab->nb", np.real(np.fft.ifft(held, axis=0)), outer.motion, turn, optimize=True)[:, :ways]
    saddle = np.block([[0.5 * (pins + pins.T), rigid], [rigid.T, np.zeros((ways, ways))]])
    by_pins = np.real(np.fft.fft(work[:, :, : watch.size], axis=0)) / z
    resultants = (motion[seen] @ turn).transpose(0, 2, 1)[:, :ways]
    teeth = support.different_teeth(z)
    row = np.arange(-reach, teeth + reach) % z
    found = PinForces(np.concatenate([by_pins, resultants], axis=1)[row], np.linalg.inv(saddle), teeth, reach)
    return {k: u - found.mean(k, seen, pressed) for k, u in response.items()}, found, ring
