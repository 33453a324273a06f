"""What is interpolated: the dimensionless tables of one gear, module 1 and Young's modulus 1, in one row of numbers.

c_0 at the places where contact tabulates it, Chebyshev coefficients of the coupling to neighbours, and stress along
both fillets of the loaded tooth and its neighbours. Places are shares of the flank's roll length and of the fillet's
length, so that they mean the same on every gear; where the flank begins and how long the fillet is stand at the end.
The tip's wedge is a closed form of each gear and is not among them, nor is that contacts beside the flank's start are
narrower: tension of the loaded tooth is that under a force, which is smooth over the flank and from gear to gear, and
that under a pressure follows from three forces (`under_pressure`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.spline import spline
from fegear.fem.plane.contact_width import POINT, REFERENCE_HALF_WIDTH
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.root_stress import FORCES_OF_PRESSURE, contact_width
from fegear.geometry.curves import arc_length

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.plane.fe_compliance import SolvedTeeth
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Side
    from fegear.geometry.gear import Gear

#: Changes whenever a row means something else.
VERSION = 4
#: Contacts over the flank for which stress along fillets is kept, crowding to the fillet, and points along these,
#: crowding to both ends.
_LOADS, _POINTS = 27, 40
_CROWDING = 1.7
_OWN, _NEIGHBOUR = 95, 14
#: Half-width of a force, and how near it comes to the flank's ends [modules].
_FORCE = 1e-6
#: Where the stress under forces nearer to a corner is continued from, over `POINT`.
_CONTINUED = (1.0, 2.5, 6.0)

Kernel = tuple[int, "Side"]


@dataclass(frozen=True)
class Layout:
    """Where in a row what stands, with neighbours up to a reach."""

    reach: int

    @property
    def kernels(self) -> list[Kernel]:
        """Teeth and fillets whose stress is kept."""
        return [(k, side) for side in SIDES for k in range(-self.reach, self.reach + 1)]

    @property
    def size(self) -> int:
        """Numbers in a row."""
        return _OWN + self.reach * _NEIGHBOUR**2 + len(self.kernels) * _LOADS * _POINTS + 2

    @property
    def compliances(self) -> int:
        """Numbers of a row that are no stresses; the ends of flank and fillet stand behind these."""
        return _OWN + self.reach * _NEIGHBOUR**2

    def own(self, row: Array) -> Array:
        """c_0 at the nominal half-width, (95,)."""
        return row[..., :_OWN]

    def neighbour(self, row: Array, k: int) -> Array:
        """Chebyshev coefficients of c_k(p, q), k = 1 to the reach."""
        first = _OWN + (k - 1) * _NEIGHBOUR**2
        return row[..., first : first + _NEIGHBOUR**2].reshape(*row.shape[:-1], _NEIGHBOUR, _NEIGHBOUR)

    def stress(self, row: Array, kernel: Kernel) -> Array:
        """Stress by contacts and points along the fillet, (27, 40)."""
        first = _OWN + self.reach * _NEIGHBOUR**2 + self.kernels.index(kernel) * _LOADS * _POINTS
        return row[..., first : first + _LOADS * _POINTS].reshape(*row.shape[:-1], _LOADS, _POINTS)

    def stresses(self, row: Array) -> Array:
        """All stress: fillets (tension, compression), teeth -K to K, contacts, points, (2, 2 K + 1, 27, 40)."""
        return row[..., self.compliances : -2].reshape(*row.shape[:-1], 2, 2 * self.reach + 1, _LOADS, _POINTS)

    def ends(self, row: Array) -> Array:
        """Roll length where the flank begins and length of a fillet [modules], (2,)."""
        return row[..., -2:]

    def turned(self, row: Array, by: Array) -> None:
        """Add to all teeth what the body turns by, in place, by of shape (...)."""
        self.own(row)[...] += by[..., None]
        for k in range(1, self.reach + 1):
            self.neighbour(row, k)[..., 0, 0] += by

    @property
    def quantities(self) -> list[str]:
        """What errors are stated of: c_self, c_neighbour, and stress of each tooth and fillet."""
        return ["c_self", "c_neighbour", *(f"{side} {k}" for k, side in self.kernels)]

    def differences(self, row: Array, off: Array) -> Array:
        """Largest differences, over c_0, over the smallest c_0, and over the largest stress of the fillet itself."""
        own = self.own(row)
        found = [np.max(np.abs(self.own(off) / own))]
        at = np.polynomial.chebyshev.chebvander(np.linspace(-1.0, 1.0, _NEIGHBOUR), _NEIGHBOUR - 1)
        beside = [np.abs(at @ self.neighbour(off, k) @ at.T).max() for k in range(1, self.reach + 1)]
        found.append(max(beside, default=0.0) / own.min())
        for k, side in self.kernels:
            stress, other = self.stress(row, (0, side)), self.stress(off, (k, side))
            sign = 1.0 if side == "tension" else -1.0
            # Of a tooth's own stress counts what its largest value changes by, of a neighbour's all that may add to it.
            largest = np.argmax(sign * stress, axis=1)[:, None]
            apart = np.abs(other) if k else np.abs(np.take_along_axis(other, largest, axis=1))
            found.append(apart.max() / np.abs(stress).max())
        return np.array(found)


def shares_of_fillet() -> Array:
    """Places along a fillet as shares of its length."""
    return np.asarray(0.5 - 0.5 * np.cos(math.pi * (np.arange(_POINTS) + 0.5) / _POINTS))


def shares_of_flank() -> Array:
    """Contacts as shares of the flank's roll length."""
    return np.linspace(0.0, 1.0, _LOADS) ** _CROWDING


def over_contacts(share: Array) -> Array:
    """Weights of the kept contacts at others, shares of the flank's roll length, (P, 27): a cubic spline's."""
    at, slopes = shares_of_flank(), _slopes()
    i = np.clip(np.searchsorted(at, share, side="right") - 1, 0, _LOADS - 2)
    h = at[i + 1] - at[i]
    s = (share - at[i]) / h
    rows, weights = np.arange(share.size), np.zeros((share.size, _LOADS))
    weights[rows, i] += (1.0 + 2.0 * s) * (1.0 - s) ** 2
    weights[rows, i + 1] += s * s * (3.0 - 2.0 * s)
    weights += (h * s * (1.0 - s) ** 2)[:, None] * slopes[i] - (h * s * s * (1.0 - s))[:, None] * slopes[i + 1]
    return weights


def under_pressure(gear: Gear, ends: tuple[float, float], length: Array) -> Array:
    """Weights of forces at the kept contacts for contacts under pressure, (P, 27).

    As wide as usual, and narrower beside the ends of the flank, as `Influence.fillet_loads` has them.

    Parameters
    ----------
    gear : Gear
    ends : tuple of float
        Roll lengths of the flank's ends [m].
    length : ndarray, shape (P,)
        Of the contacts [m].
    """
    (low, high), unit = ends, 2.0 * gear.base_radius * gear.module
    above, most = (length - low) * (length + low) / unit, (high - low) * (high + low) / unit
    above = np.maximum(above, nearest_to_start(gear))
    width = contact_width(REFERENCE_HALF_WIDTH, above, np.maximum(most - above, 0.0))
    found = np.zeros((length.size, _LOADS))
    for place, part in FORCES_OF_PRESSURE:
        at = np.sqrt(low * low + unit * np.clip(above + place * width, 0.0, most))
        found += part * over_contacts((at - low) / (high - low))
    return found


def nearest_to_start(gear: Gear) -> float:
    """How near to the flank's start contacts press [modules]: where it is a corner, they stay on the flank."""
    return POINT if gear.tooth.undercut else 0.0


@lru_cache(maxsize=1)
def _slopes() -> Array:
    """Slopes of the spline at its points by the values there."""
    return np.stack([spline(shares_of_flank(), one).slope for one in np.eye(_LOADS)], axis=1)


def compliances_of(known: SolvedTeeth) -> Array:
    """The first numbers of the row of a gear, those that are no stresses."""
    source, layout, modulus = finite_element_compliance(known), Layout(known.reach), known.gear.material.young_modulus
    row = np.empty(layout.compliances)
    layout.own(row)[:] = source.own_spline.y * modulus
    for k in range(1, known.reach + 1):
        layout.neighbour(row, k)[:] = source.neighbours[k] * modulus
    return row


def row_of(known: GearInfluence) -> Array:
    """The row of a gear."""
    gear, source, layout, m = known.gear, finite_element_compliance(known), Layout(known.reach), known.gear.module
    row = np.empty(layout.size)
    row[: layout.compliances] = compliances_of(known)
    lengths = source.lowest + shares_of_flank() * (source.highest - source.lowest)
    radii = np.clip(np.hypot(gear.base_radius, lengths), known.lowest_radius, known.highest_radius)
    for k, side in layout.kernels:
        if (k, side) == (0, "tension"):
            layout.stress(row, (k, side))[:] = m * _under_forces(known, lengths)
            continue
        stress = known.fillet_curve(side).along(known.fillet_stress(k, side, radii), shares_of_fillet())
        layout.stress(row, (k, side))[:] = m * stress.T
    layout.ends(row)[:] = source.lowest / m, float(arc_length(gear.tooth.fillet)[1][-1])
    return row


def _under_forces(known: GearInfluence, lengths: Array) -> Array:
    """Tension of the loaded tooth under forces at roll lengths, from the flank's start to its end, (P, 40) [1/m].

    Where the flank starts in a corner it is continued from the flank's side.
    """
    gear, curve, (low, high) = known.gear, known.fillet_curve("tension"), (lengths[0], lengths[-1])
    m, unit = gear.module, 2.0 * gear.base_radius * gear.module

    def under(above: Array) -> Array:
        radii = np.hypot(gear.base_radius, np.sqrt(low * low + unit * above))
        radii = np.clip(radii, known.lowest_radius, known.highest_radius)
        stress = known.fillet_stress(0, "tension", radii, _FORCE * m)
        return curve.along(stress, shares_of_fillet(), radii, _FORCE).T

    above, most = (lengths - low) * (lengths + low) / unit, (high - low) * (high + low) / unit
    nearest = max(nearest_to_start(gear), _FORCE)
    found = under(np.clip(above, nearest, most - _FORCE))
    if nearest == POINT:
        from_here = POINT * np.array(_CONTINUED)
        at, stress = np.sqrt(low * low + unit * from_here), under(from_here)
        nearer = above < POINT
        others = [np.delete(at, i) for i in range(at.size)]
        parts = [np.prod((lengths[nearer, None] - o) / (x - o), axis=1) for x, o in zip(at, others, strict=True)]
        found[nearer] = np.stack(parts, axis=1) @ stress
    return np.asarray(found)


def errors_of(known: GearInfluence) -> Array:
    """Estimated errors of a solved gear, in the order and the proportions of `Layout.quantities`."""
    layout, largest, m = Layout(known.reach), known.largest_errors(), known.gear.module
    found = [largest["c_self"], largest.get("c_neighbour", 0.0)]
    radii = np.linspace(known.lowest_radius, known.highest_radius, 9)
    own = {side: np.abs(m * known.largest_root_stress(0, side, radii)[0]).max() for side in SIDES}
    for k, side in layout.kernels:
        error = known.root_stress_error(k, side, radii)
        found.append(m * error.max() / own[side])
    return np.array(found)
