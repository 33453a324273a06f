"""The whole gear at the cost of one tooth: condense a sector onto its sides and close the ring by Fourier harmonics.

One sector is condensed onto its ports: the unknowns that are loaded or looked at, and those of its sides. Without the
ports inside, what remains couples only the unknowns of side A and side B, in polar components; harmonic n of the ring
ties them by u_B = exp(i theta_n) u_A, theta_n = 2 pi n / z, and has the matrix

    K_n = (S_aa + S_bb) + e S_ab + conj(e) S_ba,   e = exp(i theta_n).

Loads act on sector 0 only, so the response of sector k follows from the real matrices
H_k = (1/z) sum_n exp(i k theta_n) / K_n; harmonics n and z - n are conjugate and share one inverse. For a few
neighbours of many teeth the same H_k come cheaper from joining sectors, two and two.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.chain import chain_coupling, chain_of, factored, joined
from fegear.fem.plane.condensation import Condensed, symmetric
from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.sector_sides import BetweenSides, between_sides, condensed_sector, ports_of

#: Motions of a side, shape (m,) or (m, d), in which a ring that nothing holds turns, and moves: harmonics 0 and 1.
RigidSides = tuple[NDArray[np.inexact], NDArray[np.inexact]]
#: Inverses of this many complex numbers are held at once while the harmonics are summed.
_BATCH = 2_000_000


@dataclass(frozen=True)
class Ring:
    """A condensed ring of z equal sectors, its bore held or nothing held (`rim`); E = 1, lengths in modules.

    With row matrices A, B (how a port follows the polar motion of its sector's sides A and B) and G (ports' motion
    under forces on ports with the sides held), the response of sector k to forces f on sector 0 is

        u_k = A (H_k A' + H_k-1 B') f + B (H_k+1 A' + H_k B') f + (k = 0) G f.

    A row of a few sectors with free sides is of the same form, but what side B does is not what side A does one
    sector on; hence the two mappings.

    Parameters
    ----------
    part : BetweenSides
        A sector, with A, B and G.
    from_a, from_b : dict of int to ndarray, shape (m, m)
        Motion of side A of sector k under forces on side A (H_k) and on side B (H_k-1) of sector 0, for
        k = -reach .. reach+1.
    teeth, reach : int
        z, the neighbours K that can be asked for.
    seconds : dict of str to float
    """

    part: BetweenSides
    from_a: dict[int, Array]
    from_b: dict[int, Array]
    teeth: int
    reach: int
    seconds: dict[str, float]

    @property
    def sector(self) -> Condensed:
        """Its `kept` are the ports, the sides first."""
        return self.part.sector

    @property
    def follow_a(self) -> Array:
        """A, shape (ports, m)."""
        return self.part.follow_a

    @property
    def follow_b(self) -> Array:
        """B, shape (ports, m)."""
        return self.part.follow_b

    @property
    def own(self) -> Array:
        """G, shape (ports, ports); symmetric, zero for the sides."""
        return self.part.own

    @property
    def size(self) -> int:
        """Number of unknowns of a sector."""
        return self.sector.size

    def respond(
        self, loaded: Index, watch: Index, forces: Array | None = None, sectors: Sequence[int] | None = None
    ) -> dict[int, Array]:
        """Displacements of watched ports on sectors -reach..reach under forces on sector 0.

        Parameters
        ----------
        loaded : ndarray of int, shape (n,)
            Unknowns that are loaded; ports.
        watch : ndarray of int, shape (q,)
            Unknowns of a sector whose displacement is wanted, in that sector's own frame; ports.
        forces : ndarray, shape (n, P), optional
            By default a unit force on each in turn.
        sectors : sequence of int, optional
            Some of those within the reach.

        Returns
        -------
        dict of int to ndarray, shape (q, P)
        """
        rows, columns = self._ports(watch), self._ports(loaded)
        drive_a, drive_b = self.follow_a[columns].T, self.follow_b[columns].T
        own = self.own[rows[:, None], columns]
        if forces is not None:
            drive_a, drive_b, own = drive_a @ forces, drive_b @ forces, own @ forces
        both = np.hstack([self.follow_a[rows], self.follow_b[rows]])
        answer, wanted = {}, list(range(-self.reach, self.reach + 1) if sectors is None else sectors)
        # Side A of each sector, and of the next one, which is side B.
        motion = {j: self.from_a[j] @ drive_a + self.from_b[j] @ drive_b for j in {*wanted, *(k + 1 for k in wanted)}}
        for k in wanted:
            answer[k] = both @ np.vstack([motion[k], motion[k + 1]])
            if k % self.teeth == 0:
                answer[k] += own
        return answer

    def _ports(self, unknowns: Index) -> Index:
        return ports_of(self.sector, unknowns)

    def field(self, loaded: Index, forces: Array, sectors: list[int]) -> dict[int, Array]:
        """Displacements of every unknown of chosen sectors (only within the reach), each in its own frame.

        The ring must have been closed with `expandable`.
        """
        response = self.respond(loaded, self.sector.kept, forces)
        every = self.sector.expand(np.hstack([response[k] for k in sectors]))  # at once: many small solves
        return dict(zip(sectors, np.split(every, len(sectors), axis=1), strict=True))


def close_ring(
    mesh: SectorMesh,
    elasticity: SectorElasticity,
    ports: Index,
    reach: int = 1,
    *,
    expandable: bool = False,
    sector_teeth: int = 0,
    motions: Array | None = None,
) -> Ring:
    """Condense a sector once and close the ring.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    ports : ndarray of int
        Unknowns that will be loaded or watched.
    reach : int
        K: neighbours -K..K can be asked for afterwards.
    expandable : bool
        Whether `Ring.field` will be asked for.
    sector_teeth : int
        Leave the ring open: so many sectors in a row with free sides, the middle one loaded. 0 for the ring.
    motions : ndarray, shape (size, 3), optional
        Rigid motions at unknowns on the boundary. If given the bore is not held: what round-off leaves of the sector's
        stiffness against them is taken out, for a thin ring bends with hardly more, and in the ring a stiffness is lent
        to them, for `rim` to take out.

    Returns
    -------
    Ring

    Raises
    ------
    InputError
        If the sides do not match node by node, or the row of sectors is too short for the reach.
    FegearError
        If the stiffness is singular.
    """
    if sector_teeth and not 2 * reach + 1 <= sector_teeth <= mesh.teeth:
        raise InputError(
            "sector_teeth", sector_teeth, f"must be between {2 * reach + 1} and {mesh.teeth}",
            "the requested neighbours must be in the sector",
        )  # fmt: skip

    started = time.perf_counter()
    sector, m, turn, radius = condensed_sector(mesh, elasticity, ports, expandable=expandable, motions=motions)
    rigid = None if motions is None else (np.kron(radius, (0.0, 1.0)), np.tile((1.0, 1.0j), radius.size))
    return closed_ring(sector, m, turn, mesh.teeth, reach, sector_teeth=sector_teeth, started=started, rigid=rigid)


def closed_ring(
    sector: Condensed,
    side: int,
    turn: Array | None,
    teeth: int,
    reach: int,
    *,
    sector_teeth: int = 0,
    started: float | None = None,
    rigid: RigidSides | None = None,
) -> Ring:
    """Close a ring of condensed sectors.

    Parameters
    ----------
    sector : Condensed
        Its first kept unknowns are those of side A, then those of side B, in the same order.
    side : int
        m, unknowns of one side.
    turn : ndarray, shape (2 m, 2 m), optional
        From components that agree between neighbours (polar ones) to the sector's own; None if these do.
    teeth, reach : int
        z and K.
    sector_teeth : int
        As for `close_ring`.
    started : float, optional
        Clock (`time.perf_counter`) when condensing began.
    rigid : RigidSides, optional
        Of a ring that nothing holds.

    Returns
    -------
    Ring
    """
    condensed = time.perf_counter()
    part = between_sides(sector, side, turn)
    if sector_teeth:
        from_a, from_b = chain_coupling(part.held, sector_teeth, reach)
    else:
        from_a = _coupling(part.held, teeth, reach + 1, rigid)
        from_b = {k: from_a[k - 1] for k in range(-reach, reach + 2)}
    return Ring(
        part=part,
        from_a=from_a,
        from_b=from_b,
        teeth=teeth,
        reach=reach,
        seconds={
            "condensation": condensed - (condensed if started is None else started),
            "ring": time.perf_counter() - condensed,
        },
    )


def _coupling(condensed: Array, z: int, reach: int, rigid: RigidSides | None) -> dict[int, Array]:
    """H_k for k = -reach..reach, by the cheaper way."""
    if 2 * reach + 1 < z and rigid is None:
        return coupling_by_doubling(condensed, z, reach)
    return coupling_by_harmonics(condensed, z, reach, rigid)


def coupling_by_harmonics(condensed: Array, z: int, reach: int, rigid: RigidSides | None = None) -> dict[int, Array]:
    """H_k = (1/z) sum_n exp(i k theta_n) / K_n for k = -reach..reach, shape (m, m) each.

    Parameters
    ----------
    condensed : ndarray, shape (2 m, 2 m)
        Stiffness of one sector between its sides A and B, in polar components.
    z, reach : int
    rigid : RigidSides, optional
        These motions are lent a stiffness.
    """
    m = condensed.shape[0] // 2
    diagonal = condensed[:m, :m] + condensed[m:, m:]
    ahead = condensed[:m, m:]
    harmonics = np.arange(z // 2 + 1)
    total = {k: np.zeros((m, m)) for k in range(reach + 1)}
    step = max(2, _BATCH // (m * m))
    for first in range(0, harmonics.size, step):
        n = harmonics[first : first + step]
        theta = 2.0 * np.pi * n / z
        e = np.exp(1j * theta)[:, None, None]
        stiffness = diagonal + e * ahead + np.conj(e) * ahead.T
        for i, motion in () if rigid is None or first else enumerate(rigid):
            stiffness[i] += _lent(motion, diagonal.trace() / m)
        inverse = np.linalg.inv(stiffness)
        # n = 0 and n = z/2 stand alone, every other harmonic stands for its conjugate as well
        weight = np.where((n == 0) | (2 * n == z), 1.0, 2.0) / z
        for k in total:
            phase = weight * np.exp(1j * k * theta)
            total[k] += np.tensordot(phase.real, inverse.real, 1) - np.tensordot(phase.imag, inverse.imag, 1)
    return {k: (total[k] if k >= 0 else total[-k].T) for k in range(-reach, reach + 1)}


def _lent(motion: NDArray[np.inexact], size: float) -> NDArray[np.inexact]:
    """A stiffness against rigid motions of a side, the same against each, shape (m, m)."""
    if motion.ndim == 1:
        lent = motion / np.linalg.norm(motion)
        return np.asarray(size * np.multiply.outer(lent, lent.conj()))
    q = np.linalg.qr(motion)[0]
    return np.asarray(size * (q @ q.conj().T))


def harmonic_stiffness(condensed: Array, n: int, z: int, rigid: RigidSides | None) -> NDArray[np.complex128]:
    """K_n of one harmonic, 0 and 1 with the stiffness that rigid motions are lent, shape (m, m)."""
    m, e = condensed.shape[0] // 2, np.exp(2.0j * np.pi * n / z)
    diagonal, ahead = condensed[:m, :m] + condensed[m:, m:], condensed[:m, m:]
    found = np.asarray(diagonal + e * ahead + np.conj(e) * ahead.T)
    return found if n > 1 or rigid is None else np.asarray(found + _lent(rigid[n], diagonal.trace() / m))


def coupling_by_doubling(condensed: Array, z: int, reach: int) -> dict[int, Array]:
    """Return the same for a few neighbours of a ring of many teeth, in some log2(z) real steps.

    Two chains of sectors joined, the side between them eliminated, are one longer chain; so all sectors but those
    between sides 0 and reach become one. They are joined to it one by one until it goes from side 0 to itself; then the
    sides between follow from side 0, one after the other, and what is to the other side by reciprocity.
    """
    from scipy.linalg import lapack

    m = condensed.shape[0] // 2
    rest, joins = cast("Array", chain_of(condensed, z - reach)), []
    for _ in range(reach):
        joins.append(joined(condensed, rest))
        rest = joins[-1].chain
    whole = symmetric(rest[:m, :m] + rest[m:, m:]) + rest[m:, :m] + rest[m:, :m].T
    found = [symmetric(np.asarray(lapack.dpotri(factored(whole), lower=1, overwrite_c=1)[0]))]
    for join in reversed(joins):
        found.append(join.between(np.vstack([found[-1], found[0]])))
    return {k: (found[k] if k >= 0 else found[-k].T) for k in range(-reach, reach + 1)}


def closed_stiffness(chains: Sequence[tuple[Array | None, int, int]], sides: int, side: int) -> Array:
    """Stiffness between the sides of a ring of chains, shape (sides, m, sides, m).

    Parameters
    ----------
    chains : sequence of (ndarray of shape (2 m, 2 m) or None, int, int)
        Stiffness between the ends of each, and the numbers of the sides that its ends are.
    sides, side : int
        Number of sides; m.
    """
    whole = np.zeros((sides, side, sides, side))
    for chain, first, last in chains:
        if chain is not None:
            block = chain.reshape(2, side, 2, side)
            ends = np.array([first, last])
            # One after the other: where both ends are one side, all four blocks are that side's.
            for i, j in np.ndindex(2, 2):
                whole[ends[i], :, ends[j]] += block[i, :, j]
    return whole
