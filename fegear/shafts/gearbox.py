"""All shafts of a gearbox under all its meshes: from forces over the faces to gaps between the flanks, and by cause."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.shafts.carried import carry
from fegear.shafts.deflection import Deflection, deflect, response
from fegear.shafts.held import Held, LoadedShaft, groups_of, held_by
from fegear.shafts.mesh import MeshPlace, straight_slope

#: Misalignment of a mesh by cause, and its gap over the face.
MeshState = tuple["MeshMisalignment", "MeshGap"]
Cause = Literal["bearings", "housing", "bending", "torsion"]
#: What moves flanks apart: displacement of the rings in the bearings, of the seats in the housing; the shafts bend, and
#: twist.
CAUSES: tuple[Cause, ...] = ("bearings", "housing", "bending", "torsion")


#: Torques of a shaft's meshes are printed with few digits: a smaller share of them all is what rounding leaves.
ROUNDED = 5e-4
#: What a gap departs from a straight line by less than this share of the largest one is round-off.
_STRAIGHT = 1e-12


@dataclass(frozen=True)
class MeshMisalignment:
    """How far a mesh is misaligned: in all, then by `CAUSES`; arrays of shape (5,)."""

    in_plane: Array = shown(
        "arcsec", "misalignment in the plane of the axes (f_Sigma_delta), positive diverging towards end II"
    )
    out_of_plane: Array = shown(
        "arcsec",
        "misalignment perpendicular to that plane (f_Sigma_beta), positive if the driven gear leads towards end II",
    )
    over_face: Array = shown("um", "linear part of the gap: end II minus end I")
    curved: Array = shown("um", "non-linearity of the gap (peak to peak deviation from the straight line)")


@dataclass(frozen=True)
class MeshGap:
    """What shafts open between the flanks of a mesh; arrays of shape (n,), by cause (4, n)."""

    z: Array = shown(
        "mm", "face position from the middle of the common face width, towards end II", label="face position z"
    )
    gap: Array = shown("um", "gap caused by the shafts in the plane of action", label="gap of the flanks")
    by_cause: Array = shown("um", "contribution")
    line_load: Array = shown("N/mm", "line load, mean over a base pitch", label="line load")


@dataclass(frozen=True)
class _Acting:
    """Where a mesh acts on a shaft: its number, places there, and per unit force W and W x at its heights.

    Parameters
    ----------
    mesh : int
    places : ndarray, shape (p,)
        [m].
    ways : ndarray, shape (p, 6, 2, n)
        Forces and moments at the places.
    motion : ndarray, shape (n, 6, p, 6)
        How the gear moves at the heights with the places.
    """

    mesh: int
    places: Array
    ways: Array
    motion: Array


@dataclass(frozen=True)
class Gearbox:
    """Shafts of one housing with the meshes between them.

    Parameters
    ----------
    shafts : tuple of LoadedShaft
        Under the forces from outside alone.
    couplings : tuple of float or None
        Where the torque of a shaft that its gears leave enters [m]; None where nothing takes it, and its meshes share
        what rounding leaves.
    meshes : tuple of MeshPlace
    housing : ndarray, shape (5 b, 5 b)
        Compliance of the seats.
    names : tuple of str
        Of the shafts.
    """

    shafts: tuple[LoadedShaft, ...]
    couplings: tuple[float | None, ...]
    meshes: tuple[MeshPlace, ...]
    housing: Array
    names: tuple[str, ...]

    @cached_property
    def _on_shafts(self) -> list[list[_Acting]]:
        """Of every shaft, what meshes act on it."""
        found: list[list[_Acting]] = [[] for _ in self.shafts]
        for number, mesh in enumerate(self.meshes):
            where = [self.names.index(name) for name in mesh.shafts]
            lengths = (self.shafts[where[0]].shaft.length, self.shafts[where[1]].shaft.length)
            for shaft, acting in zip(where, mesh.ways(lengths), strict=True):
                found[shaft].append(_Acting(number, *acting))
        return found

    @property
    def even(self) -> tuple[Array, ...]:
        """Forces of all meshes spread evenly over their faces, shape (2, n) each."""
        return tuple(mesh.even for mesh in self.meshes)

    def loaded(self, forces: tuple[Array, ...], scale: float = 1.0) -> tuple[LoadedShaft, ...]:
        """Shafts under the forces W and W x of all meshes at their heights; what acts from outside times `scale`.

        Raises
        ------
        InputError
            If a torque is left that nothing takes.
        """
        found = []
        for one, coupling, on in zip(self.shafts, self.couplings, self._on_shafts, strict=True):
            at, loads = [one.loads_at], [scale * one.loads]
            for acting in on:
                at.append(acting.places)
                loads.append(np.einsum("pakn,kn->pa", acting.ways, forces[acting.mesh]))
            if coupling is not None:
                at.append(np.array([coupling]))
                loads.append(np.array([[0.0] * 5 + [-sum(part[:, 5].sum() for part in loads)]]))
            whole = np.vstack(loads)
            torques, most = whole[:, 5], np.abs(whole[:, 5])
            if coupling is None and on and 0.0 < abs(torques.sum()) <= ROUNDED * most.sum():
                torques -= torques.sum() * most / most.sum()
            found.append(replace(one, loads_at=np.concatenate(at), loads=whole))
        return tuple(found)

    def under(self, forces: tuple[Array, ...], scale: float = 1.0) -> tuple[Deflection, ...]:
        """Shafts in equilibrium, see `loaded` and `deflect`."""
        return deflect(self.loaded(forces, scale), self.housing)

    def gaps(self, moved: tuple[Array, ...]) -> tuple[Array, ...]:
        """Gaps that displacements open between the flanks of each mesh, at x = 0 and over x, shape (..., 2, n).

        Nothing in the middle of the face at x = 0: what all flanks share turns the gears, and loads none of them.

        Parameters
        ----------
        moved : tuple of ndarray, shape (..., k, 6)
            Displacements of each shaft at `places`.
        """
        found: list[Array] = [np.zeros(())] * len(self.meshes)
        for one, on in zip(moved, self._on_shafts, strict=True):
            first = 0
            for acting in on:
                here = one[..., first : first + acting.places.size, :]
                found[acting.mesh] = found[acting.mesh] + np.einsum("pakn,...pa->...kn", acting.ways, here)
                first += acting.places.size
        for gap in found:
            gap[..., 0, :] -= gap[..., 0, gap.shape[-1] // 2][..., None]
        return tuple(found)

    @property
    def places(self) -> tuple[Array, ...]:
        """Where the meshes act on each shaft, one mesh after the other [m]."""
        return tuple(np.concatenate([np.empty(0), *(acting.places for acting in on)]) for on in self._on_shafts)

    def compliance(self, bent: tuple[Deflection, ...]) -> Array:
        """How gaps of all meshes grow with their forces, W and W x at the heights of one mesh after the other.

        Shape (2 N, 2 N) of N heights in all; symmetric but for the middle of each face, which stays. The sum of the
        forces of a mesh is given, so that torques in couplings do not change.
        """
        places = self.places
        moved = response(bent, places, self.housing)
        sizes = [2 * mesh.heights.size for mesh in self.meshes]
        starts = np.cumsum([0, *sizes])
        ways = np.zeros((moved.shape[0], starts[-1]))
        row = 0
        for on in self._on_shafts:
            for acting in on:
                rows, columns = 6 * acting.places.size, slice(starts[acting.mesh], starts[acting.mesh + 1])
                ways[row : row + rows, columns] = acting.ways.reshape(rows, -1)
                row += rows
        found = ways.T @ moved @ ways
        for first, mesh in zip(starts, self.meshes, strict=False):
            n = mesh.heights.size
            found[first : first + n] -= found[first + n // 2]
        return np.asarray(found)

    def by_cause(self, bent: tuple[Deflection, ...]) -> tuple[Array, ...]:
        """Displacements of each shaft at `places` by `CAUSES`, which add up to all of it, shape (4, k, 6).

        The forces being known, rings, seats and bent shafts at the bearings leave a straight line to each shaft: it is
        that of least squares through them, exact for two bearings. Shafts that bearings join have theirs together.
        """
        loaded = tuple(one.loaded for one in bent)
        held = held_by(loaded)
        rings = np.concatenate([one.rings for one in bent])
        sag = np.zeros_like(rings)
        for one, on in zip(bent, held, strict=True):
            sag[on.bearings] += on.sign[:, None] * one.bent(on.at)[:, :5]
        pressed = (self.housing @ np.concatenate([one.bearing_forces.ravel() for one in bent])).reshape(-1, 5)
        left = np.stack([rings, -pressed, -sag])
        lines = np.zeros((len(bent), 3, 6))
        for group in groups_of(loaded):
            lines[list(group)] = _straight([loaded[n] for n in group], [held[n] for n in group], loaded, left)
        found = []
        for one, z, own in zip(bent, self.places, lines, strict=True):
            twisted, curved = one.bent(z), one.bent(z)
            twisted[:, :5], curved[:, 5] = 0.0, 0.0
            straight = np.einsum("nba,cb->cna", carry(z), own)
            found.append(np.stack([straight[0], straight[1], straight[2] + curved, twisted]))
        return tuple(found)

    def misalignment(self, bent: tuple[Deflection, ...], forces: tuple[Array, ...]) -> tuple[MeshState, ...]:
        """How far every mesh is misaligned, and what opens over its face under its forces."""
        causes = self.by_cause(bent)
        moved = tuple(np.concatenate([part.sum(axis=0)[None], part]) for part in causes)
        ends: dict[tuple[int, str], Array] = {}
        for name, one, on in zip(self.names, moved, self._on_shafts, strict=True):
            first = 0
            for acting in on:
                here = one[..., first : first + acting.places.size, :]
                ends[acting.mesh, name] = np.einsum("napb,...pb->...na", acting.motion, here)
                first += acting.places.size
        found = []
        for number, (mesh, both) in enumerate(zip(self.meshes, self.gaps(moved), strict=True)):
            gap, z = both[:, 0], mesh.heights
            tilt = mesh.tilt(ends[number, mesh.shafts[1]], ends[number, mesh.shafts[0]])
            slope = straight_slope(z, gap[..., None])
            left = gap - slope * z
            left[np.abs(left) < _STRAIGHT * np.abs(gap).max()] = 0.0
            shares = MeshMisalignment(tilt[:, 0], tilt[:, 1], slope[:, 0] * mesh.found.face_width, np.ptp(left, axis=1))
            width = np.gradient(z) * np.where(np.abs(z) == z[-1], 0.5, 1.0)
            found.append((shares, MeshGap(z, gap[0], gap[1:], forces[number][0] / width)))
        return tuple(found)


def _straight(group: list[LoadedShaft], held: list[Held], shafts: tuple[LoadedShaft, ...], left: Array) -> Array:
    """Motions of the left ends of joined shafts nearest to displacements (c, b, 5) of their rings, shape (g, c, 6)."""
    bearings = [seat.bearing for one in shafts for seat in one.seats]
    own = np.unique(np.concatenate([on.bearings for on in held]))
    firm = np.array([bearings[n].rigid | np.any(bearings[n].usual != 0.0, axis=1) for n in own])
    moved = np.zeros((len(own), 5, 5 * len(group)))  # (b, 5 of the ring, 5 of each left end)
    scale = np.ones((len(own), 5))
    for n, (one, on) in enumerate(zip(group, held, strict=True)):
        rows = np.searchsorted(own, on.bearings)
        columns = slice(5 * n, 5 * n + 5)
        moved[rows, :, columns] = on.sign[:, None, None] * np.swapaxes(carry(on.at)[:, :5, :5], 1, 2)
        scale[rows[on.sign > 0.0], 3:] = one.shaft.length
    turns = np.concatenate([[1.0, 1.0, 1.0, one.shaft.length, one.shaft.length] for one in group])
    across = firm & (np.arange(5) < 3)
    for kept in (across, firm):
        matrix = (moved * scale[..., None] / turns)[kept]
        if np.linalg.matrix_rank(matrix) == turns.size:
            break
    motion = np.linalg.lstsq(matrix, (left[:, own] * scale)[:, kept].T, rcond=None)[0].T / turns
    return np.pad(np.swapaxes(motion.reshape(-1, len(group), 5), 0, 1), ((0, 0), (0, 0), (0, 1)))
