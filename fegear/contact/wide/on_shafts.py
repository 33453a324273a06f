"""Loaded flanks of all meshes of a gearbox on shafts that they bend: one solution for all of them.

Unknown are the gaps v that the shafts open over the faces. Forces at the same heights follow from the loaded flanks,
f = F(v), averaged over a base pitch: shafts do not follow the passing of single teeth. The shafts answer with gaps
S(f), and v = S(F(v)) is wanted. F is the negative gradient of a convex energy (gaps and forces go together as
displacements and forces do, station by station) and S' is symmetric and positive, so there is one solution, and
Newton's method with I - S' F' finds it whether or not an iteration by hand, v <- S(F(v)), would converge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.base.cache_keys import Key
from fegear.base.errors import ConvergenceError, InputError
from fegear.contact.wide.load_sharing import growth_by_gaps, hat_averages
from fegear.contact.wide.shaft_gaps import ShaftGaps
from fegear.geometry.shaft_tilt import LARGEST_TILT
from fegear.shafts.rolling_bearing import RollingBearing

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.wide.compliance import FlankCompliance
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import FlankPair
    from fegear.shafts.deflection import Deflection
    from fegear.shafts.gearbox import Gearbox
    from fegear.shafts.held import Seat

#: Change of gaps over their largest at which the solution is found, and steps after which it is given up.
TOLERANCE, _STEPS = 1e-9, 30
#: Largest displacement of a shaft over its length for which all is linear in it.
_LARGEST_SHIFT = 0.01
#: Halvings of a step that does not help.
_HALVINGS = 6


class MeshForces(Protocol):
    """What a gearbox asks of one of its meshes."""

    def under(self, gap: Array, load: float) -> tuple[Array, Array]:
        """Forces W and W x at the heights, shape (2, n), and their growth with the gaps there, shape (2 n, 2 n)."""
        ...


@dataclass(frozen=True)
class EvenForces:
    """A mesh whose load stays as it is: teeth of a plane section, or flanks that are not loaded.

    Parameters
    ----------
    share : ndarray, shape (2, n)
        Forces of a unit load.
    """

    share: Array

    def under(self, gap: Array, load: float) -> tuple[Array, Array]:
        """See `MeshForces`."""
        return load * self.share, np.zeros((gap.size, gap.size))


@dataclass(frozen=True)
class FlankForces:
    """A mesh of loaded flanks.

    Parameters
    ----------
    flanks : FlankPair
    gaps : FlankGaps
        What keeps the flanks apart besides the shafts.
    known : FlankCompliance
        At all roll positions.
    heights : ndarray, shape (n,)
        At which forces are summed up and gaps are given, from the middle of the common face [m].
    """

    flanks: FlankPair
    gaps: FlankGaps
    known: FlankCompliance
    heights: Array

    @cached_property
    def _hats(self) -> Array:
        """Gap at the stations, averaged over their hats, by unit gaps at the heights, shape (2 n, P, M)."""
        lines, n = self.known.lines, self.heights.size
        found = []
        for one in np.eye(n):
            shape = np.where(lines.present, np.interp(lines.z, self.heights, one), 0.0)
            found.append((hat_averages(lines, shape), hat_averages(lines, shape * lines.x)))
        return np.array([part for k in range(2) for part in (one[k] for one in found)])

    def under(self, gap: Array, load: float) -> tuple[Array, Array]:
        """See `MeshForces`."""
        shafts = ShaftGaps(np.array([load]), self.heights, gap[None])
        found = self.flanks.solve([load], replace(self.gaps, shafts=shafts), self.known)
        force, lines, hats = found.contact.force[:, :, 0], self.known.lines, self._hats
        count = lines.roll.size
        weight = lines.weight if lines.weight.size else np.full(count, 1.0 / count)
        # Solved stations have only those of all forces whose lines exist: so has their mean, the load itself.
        mean = np.einsum("p,pm,kpm->k", weight, force, hats)
        _, moved = growth_by_gaps(found.known, force, hats)
        return mean.reshape(gap.shape), np.einsum("p,gpm,kpm->kg", weight, moved, hats)


@dataclass(frozen=True)
class GearboxState:
    """A gearbox in equilibrium.

    Parameters
    ----------
    scale : float
        All loads over the nominal ones.
    bent : tuple of Deflection
        Of every shaft.
    forces : tuple of ndarray, shape (2, n)
        W and W x of every mesh at its heights [N, N m].
    gaps : tuple of ndarray, shape (2, n)
        What the shafts open between its flanks [m] and its slope over x.
    steps : int
        Of Newton's method.
    left : float
        What the gaps of flanks and shafts differ by, over the largest.
    """

    scale: float
    bent: tuple[Deflection, ...]
    forces: tuple[Array, ...]
    gaps: tuple[Array, ...]
    steps: int
    left: float


def load_gearbox(gearbox: Gearbox, meshes: Sequence[MeshForces], scales: Sequence[float]) -> tuple[GearboxState, ...]:
    """Load all meshes of a gearbox together, in proportion.

    Parameters
    ----------
    gearbox : Gearbox
    meshes : sequence of MeshForces
        In the order of its meshes.
    scales : sequence of float
        Loads over the nominal ones, ascending; forces from outside go with them.

    Raises
    ------
    ConvergenceError
        If no state is found that shafts and flanks share.
    """
    found: list[GearboxState] = []
    for scale in scales:
        start = tuple(np.zeros((2, mesh.heights.size)) for mesh in gearbox.meshes)
        if found:
            start = tuple(gap * (scale / found[-1].scale) for gap in found[-1].gaps)
        found.append(_state(gearbox, meshes, scale, start))
    return tuple(found)


def _refuse_askew(gearbox: Gearbox, state: GearboxState) -> None:
    """Refuse shafts that lie so askew that gaps are no longer linear in their tilt."""
    for name, one, places in zip(gearbox.names, state.bent, gearbox.places, strict=True):
        moved = np.abs(one.at(places)).max(axis=0, initial=0.0)
        tilt, shift, length = float(moved[3:5].max()), float(moved[:3].max()), one.loaded.shaft.length
        if max(tilt / LARGEST_TILT, shift / (_LARGEST_SHIFT * length)) > 1.0 and _one_way(one.loaded.seats):
            raise InputError(
                f"shaft.{name}.bearings", "(contact angles of one direction)",
                "support the shaft axially in one direction only", "set reversed = true for one of them",
            )  # fmt: skip
        if tilt > LARGEST_TILT:
            raise InputError(
                f"shaft.{name}", f"tilt of {math.degrees(tilt):.4g} deg at its gears", "is not small",
                f"must stay within {math.degrees(LARGEST_TILT):g} deg: reduce clearance, use stiffer bearings or "
                "sections",
            )  # fmt: skip
        if shift > _LARGEST_SHIFT * length:
            raise InputError(
                f"shaft.{name}", f"displacement of {shift * 1e3:.4g} mm", "is not small",
                f"must stay within {100.0 * _LARGEST_SHIFT:g} % of the shaft length: reduce clearance, use stiffer "
                "bearings",
            )  # fmt: skip


def _one_way(seats: Sequence[Seat]) -> bool:
    """Whether all bearings that carry axial forces do so in the same direction."""
    along = [one.bearing for one in seats if one.bearing.rigid[2] or one.bearing.usual[2, 2] > 0.0]
    angles = [one.contact_angle if isinstance(one, RollingBearing) else 0.0 for one in along]
    return bool(angles) and (min(angles) > 0.0 or max(angles) < 0.0)


def _state(gearbox: Gearbox, meshes: Sequence[MeshForces], scale: float, start: tuple[Array, ...]) -> GearboxState:
    ends = np.cumsum([0, *(gap.size for gap in start)]).tolist()
    parts = [slice(first, last) for first, last in pairwise(ends)]  # of each mesh; there may be none

    def of_all(v: Array) -> tuple[GearboxState, Array, Array]:
        """State at gaps of all meshes one after the other, what its shafts open less `v`, and growth of the forces."""
        under = [
            one.under(v[part].reshape(gap.shape), scale * mesh.load)
            for one, part, gap, mesh in zip(meshes, parts, start, gearbox.meshes, strict=True)
        ]
        forces = tuple(force for force, _ in under)
        bent = gearbox.under(forces, scale)
        gaps = gearbox.gaps(tuple(one.at(z) for one, z in zip(bent, gearbox.places, strict=True)))
        growth = np.zeros((v.size, v.size))
        for (_, own), part in zip(under, parts, strict=True):
            growth[part, part] = own
        left = np.concatenate([gap.ravel() for gap in gaps]) - v if gaps else v
        return GearboxState(scale, bent, forces, gaps, 0, 0.0), left, growth

    heights = [np.stack([np.ones_like(mesh.heights), mesh.heights]) for mesh in gearbox.meshes]
    unit = np.concatenate([np.repeat([1.0, np.ptp(h[1])], h.shape[1]) for h in heights]) if heights else np.empty(0)
    v = np.concatenate([gap.ravel() for gap in start]) if start else np.empty(0)
    state, left, growth = of_all(v)
    for step in range(_STEPS):
        largest = max(float(np.abs((v + left) * unit).max(initial=0.0)), 1e-15)
        size = float(np.abs(left * unit).max(initial=0.0))
        if size <= TOLERANCE * largest:
            _refuse_askew(gearbox, state)
            return replace(state, steps=step, left=size / largest)
        compliance = gearbox.compliance(state.bent)
        move = np.linalg.solve(np.eye(v.size) - compliance @ growth, left)
        share = 1.0
        for _ in range(_HALVINGS):
            new = v + share * move
            state, found, growth = of_all(new)
            if float(np.abs(found * unit).max()) < (1.0 - 1e-3 * share) * size:
                break
            share *= 0.5
        v, left = new, found
    names = ", ".join(mesh.pair for mesh in gearbox.meshes)
    raise ConvergenceError(f"No equilibrium of shafts and flanks of {names} found; check bearing clearance.")


@dataclass(frozen=True)
class LoadedShafts:
    """A gearbox under every load that its pairs are loaded with.

    Parameters
    ----------
    gearbox : Gearbox
    states : tuple of GearboxState
        Ascending with their loads; the nominal one among them.
    feeding : tuple of bool
        Of every mesh, whether its load distribution moves the force on the shafts.
    """

    gearbox: Gearbox
    states: tuple[GearboxState, ...]
    feeding: tuple[bool, ...]

    @property
    def nominal(self) -> GearboxState:
        """Under the nominal loads."""
        return next(state for state in self.states if state.scale == 1.0)

    def gaps_of(self, pair: str) -> ShaftGaps:
        """What shafts open between the flanks of a pair, under all loads."""
        number = [mesh.pair for mesh in self.gearbox.meshes].index(pair)
        mesh = self.gearbox.meshes[number]
        loads = np.array([state.scale * mesh.load for state in self.states])
        return ShaftGaps(loads, mesh.heights, np.array([state.gaps[number] for state in self.states]))


def gaps_of_even_loads(gearbox: Gearbox, pair: str) -> ShaftGaps:
    """What shafts open between the flanks of a pair under nominal loads that stay spread evenly over all faces."""
    key = Key.of("shafts under uniform loads", gearbox)
    found = _UNDER_EVEN_LOADS.get(key)
    if found is None:
        even = [EvenForces(mesh.even / mesh.load) for mesh in gearbox.meshes]
        found = LoadedShafts(gearbox, load_gearbox(gearbox, even, [1.0]), (False,) * len(even))
        _UNDER_EVEN_LOADS.clear()
        _UNDER_EVEN_LOADS[key] = found
    return found.gaps_of(pair)


#: Shafts of the latest gearbox: all of its pairs ask for them while a case is checked and planned.
_UNDER_EVEN_LOADS: dict[Key, LoadedShafts] = {}
