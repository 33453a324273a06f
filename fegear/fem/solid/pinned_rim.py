"""A ring gear with its width on pins: the forces of pins that are held along the whole face.

A pin is parallel to the axis and as long as the face. At every height the rim's mean over the pin's arc moves neither
outward nor along the circle; along the axis it does not move on average over the face, which a shoulder or the head of
a bolt sees to. It may twist on the pin. "At every height" is: in all polynomials along the face that every node of the
outer circle has.

With E the weights of the unknowns in what each pin holds, x its forces, G a generalised inverse of the free ring's
stiffness (`rim`) and R a its motion as a body, as in the plane

    E' (G (f + E x) + R a) = 0,   R' (f + E x) = 0.

Teeth z and pins N have g = gcd(z, N) turns in common. In waves of s = 0 .. g - 1 over these, only the pins of one such
part are left, and they meet the ring's harmonics n = s, s + g, s + 2 g ..., one after the other:

    S_s = g/z sum_n E_n* G_n E_n,   G_n = (A + e B) / K_n (A + e B)* + own,   e = exp(2 pi i n / z).

So a handful of columns per harmonic is kept, and not the motion of all sectors. The section's axes turn with the helix:
a straight pin lies aslant there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index
from fegear.fem.plane.trace import lagrange

if TYPE_CHECKING:
    from fegear.fem.solid.face import FaceFunctions
    from fegear.fem.solid.rim import FreeRing
    from fegear.fem.solid.section import Section
    from fegear.fem.solid.unknowns import Unknowns
    from fegear.geometry.rim_support import RimSupport

_GAUSS = np.polynomial.legendre.leggauss(12)
#: Heights at which a pin's weights are summed, per function along the face and besides: its edges may lie aslant.
_HEIGHTS, _MORE_HEIGHTS = 8, 64
#: Conditions that unknowns take part in by less than this are round-off.
_NONE = 1e-12


@dataclass(frozen=True)
class Pins:
    """What the pins hold of which sector.

    Parameters
    ----------
    weights : dict of (int, int) to ndarray, shape (3 n, functions, c)
        Of the unknowns of the outer circle in what is held, by pin of the first part and sector.
    first : int
        N / g: pins before teeth and pins stand to each other as at the start.
    common : int
        g.
    different : int
        How many teeth stand differently to the pins.
    unknowns : ndarray of int, shape (3 n,)
        Of the section.
    """

    weights: dict[tuple[int, int], Array]
    first: int
    common: int
    different: int
    unknowns: Index


def pins_on(section: Section, face: FaceFunctions, counts: Index, support: RimSupport, teeth: int) -> Pins:
    """Weights of the outer circle's unknowns in what pins hold.

    Parameters
    ----------
    section : Section
    face : FaceFunctions
        One piece over the whole face.
    counts : ndarray of int, shape (N,)
        How many functions each node has.
    support : RimSupport
        Lengths in modules.
    teeth : int
    """
    nodes = section.nodes_of("bore")
    places, edges, p = section.edge_places["bore"], section.edge_nodes["bore"], section.order
    radius, pitch = float(np.hypot(*places[:, 0, 0])), 2.0 * math.pi / teeth
    full = int(counts[nodes].min())
    z, share = face.quadrature(least=_HEIGHTS * face.count + _MORE_HEIGHTS)
    share = share / face.width
    held = np.polynomial.legendre.legvander(2.0 * z / face.width, full - 1).T * share  # (full, q)
    along = np.einsum("kq,jq->kqj", face.values(z), held)
    whole = face.values(z) * share
    half, slant = 0.5 * support.width / radius, 0.5 * abs(section.tau) * face.width
    start, end = np.arctan2(*places[:, 0]), np.arctan2(*places[:, -1])  # clockwise from the tooth's centre line
    low, high = np.minimum(start, end), np.maximum(start, end)
    common = math.gcd(teeth, support.pins)
    found = {}
    for pin in range(support.pins // common):
        middle = support.angle + 2.0 * math.pi * pin / support.pins
        reach = half + slant
        for sector in range(math.floor((middle - reach) / pitch), math.ceil((middle + reach) / pitch) + 1):
            at = middle - sector * pitch + section.tau * z  # where the pin meets the section, (q,)
            near, far = np.maximum(low, at[:, None] - half), np.minimum(high, at[:, None] + half)
            length = np.maximum(far - near, 0.0)
            if not length.any():
                continue
            angle = 0.5 * (near + far)[..., None] + 0.5 * length[..., None] * _GAUSS[0]
            into = (angle - start[:, None]) / (end - start)[:, None]
            weight = lagrange(p, into.ravel()).reshape(p + 1, *into.shape) @ _GAUSS[1] * (0.25 * length / half)
            out = np.stack([np.sin(at), np.cos(at)])
            row = np.zeros((nodes.size, 3, face.count, 2 * full + 1))
            for edge in range(edges.shape[1]):
                own = np.searchsorted(nodes, edges[:, edge])
                of_edge = weight[:, :, edge]
                for c in range(2):
                    along_circle = out[1] if c == 0 else -out[0]
                    for first, way in ((0, out[c]), (full, along_circle)):
                        part = np.einsum("iq,kqj->ikj", of_edge * way, along)
                        row[own, c, :, first : first + full] += part  # an edge has each node once
                row[own, 2, :, 2 * full] += of_edge @ whole.T
            # Forces in a node's own axes.
            row = np.einsum("nce,nckj->nekj", section.axes[nodes], row)
            found[pin, sector] = row.reshape(-1, face.count, 2 * full + 1)
    dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
    return Pins(found, support.pins // common, common, support.different_teeth(teeth), dofs)


class _Waves:
    """What pins and loads do in the ring's harmonics (the module's words say what n, s and g are).

    Parameters
    ----------
    free : FreeRing
    pins : Pins
    known : Unknowns
    """

    def __init__(self, free: FreeRing, pins: Pins, known: Unknowns) -> None:
        self.free, self.common, self.teeth = free, pins.common, free.ring.teeth
        there = known.number[pins.unknowns] >= 0
        self.outer = free.place[known.number[pins.unknowns][there]]
        self._blocks = {key: block[there] for key, block in pins.weights.items()}
        self._some = []
        for pin in range(pins.first):
            part = [np.abs(block).sum(axis=0) for (one, _), block in self._blocks.items() if one == pin]
            self._some.append(np.flatnonzero(np.sum(part, axis=0) > _NONE))
        self._begin = np.cumsum([0, *(some.size for some in self._some)])
        self.size = int(self._begin[-1])
        self.rigid: dict[int, NDArray[np.complex128]] = {}
        if free.rim.which:
            zero, one = (np.asarray(free.moved @ wave, dtype=np.complex128) for wave in free.rim.waves)
            self.rigid = {0: zero, 1: one, self.teeth - 1: one.conj()}
        self.slots: dict[int, slice] = {}  # where the resultants of a harmonic stand, behind the pins of its class
        self.sizes = np.full(self.common, self.size)
        for n, shape in self.rigid.items():
            start = int(self.sizes[n % self.common])
            self.slots[n] = slice(start, start + shape.shape[1])
            self.sizes[n % self.common] += shape.shape[1]
        self.harmonics = range(self.teeth // 2 + 1)
        self._moves = [free.moves(n, self.outer, self.weights(n)) for n in self.harmonics]

    def both(self, n: int) -> tuple[int, ...]:
        """A harmonic and the one that is conjugate to it."""
        other = (self.teeth - n) % self.teeth
        return (n,) if other == n else (n, other)

    def weights(self, n: int) -> NDArray[np.complex128]:
        """E_n, shape (outer, size)."""
        found = np.zeros((self.outer.size, self.size), dtype=complex)
        for (pin, sector), block in self._blocks.items():
            phase = np.exp(-2.0j * math.pi * n * sector / self.teeth)
            found[:, self._begin[pin] : self._begin[pin + 1]] += phase * block[:, self._some[pin]]
        return found

    def inverses(self) -> list[NDArray[np.complex128]]:
        """From motion of pins and resultants to forces and rigid motion, class by class."""
        found = [np.zeros((size, size), dtype=complex) for size in self.sizes]
        own = self.free.ring.own[np.ix_(self.outer, self.outer)]
        for n in self.harmonics:
            held = self.weights(n)
            follow = self.free.followed(n, self.outer).conj().T @ held
            work = follow.conj().T @ self._moves[n] + held.conj().T @ (own @ held)
            work = (0.5 * self.common / self.teeth) * (work + work.conj().T)
            for m in self.both(n):
                part, weights = (work, held) if m == n else (work.conj(), held.conj())
                saddle = found[m % self.common]
                saddle[: self.size, : self.size] += part
                if m in self.slots:
                    link = weights.conj().T @ self.rigid[m][self.outer]
                    saddle[: self.size, self.slots[m]] = link
                    saddle[self.slots[m], : self.size] = link.conj().T
        return [np.asarray(np.linalg.inv(saddle)) for saddle in found]

    def under(self, m: int, ports: Index, load: Array | None = None) -> NDArray[np.complex128]:
        """Motion of the pins and resultants under loads on ports in the m-th harmonic, shape (size of m, loads)."""
        n = min(m, self.teeth - m)
        follow = self.free.followed(n, ports).conj().T
        own = self.free.ring.own[np.ix_(self.outer, ports)]
        if load is not None:
            follow, own = follow @ load, own @ load
        part = (self.common / self.teeth) * (self._moves[n].conj().T @ follow + self.weights(n).conj().T @ own)
        found = np.zeros((int(self.sizes[m % self.common]), part.shape[1]), dtype=complex)
        found[: self.size] = part if m == n else part.conj()
        if m in self.slots:
            shape = self.rigid[m][ports].conj().T
            found[self.slots[m]] = shape if load is None else shape @ load
        return found


def pinned_response(
    free: FreeRing, pins: Pins, known: Unknowns, loaded: Index, watch: Index, reference: Array
) -> tuple[dict[int, Array], Array]:
    """Displacements of watched ports of a ring on pins.

    Parameters
    ----------
    free : FreeRing
    pins : Pins
    known : Unknowns
        Of the ring, maybe a half of a split.
    loaded, watch : ndarray of int
        Unknowns.
    reference : ndarray, shape (loaded,)
        A load under which all teeth are compared.

    Returns
    -------
    response : dict of int to ndarray, shape (watch, loaded)
        On sectors -reach..reach under forces on sector 0, the mean over all teeth.
    each : ndarray, shape (T, watch)
        On the loaded tooth under the reference load, tooth after tooth, less the mean over all.
    """
    ring, g, z = free.ring, pins.common, free.ring.teeth
    rows, columns = free.place[watch], free.place[loaded]
    waves = _Waves(free, pins, known)
    inverses = waves.inverses()
    turn, teeth = np.exp(2.0j * math.pi * np.arange(z) / z), np.arange(pins.different)
    load = reference[:, None]
    forces = [np.zeros((size, teeth.size), dtype=complex) for size in waves.sizes]
    for n in waves.harmonics:
        for m in waves.both(n):
            forces[m % g] += waves.under(m, columns, load) * turn[(-m * teeth) % z]
    forces = [inverse @ motion for inverse, motion in zip(inverses, forces, strict=True)]
    each = np.zeros((teeth.size, rows.size))
    response = ring.respond(loaded, watch)
    for n in waves.harmonics:
        seen, factor = waves.under(n, rows).conj().T, len(waves.both(n)) / g  # what is conjugate doubles the real part
        product = seen @ (inverses[n % g] @ waves.under(n, columns))
        for k in response:
            response[k] -= factor * np.real(turn[(n * k) % z] * product)
        each += factor * np.real((seen @ forces[n % g]) * turn[(n * teeth) % z]).T
    return response, each.mean(axis=0) - each
