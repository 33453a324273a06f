"""From loaded flanks of gears with a width to what their teeth do to the train: springs about the mean load.

Pair j bears W_j of the mean load W with the local stiffness K_Sj = dW_j/dzeta, both sums over its contact line. A
tooth pair lives while its line crosses the plane of action, for the total contact ratio in base pitches; its life is
cut into slots of one base pitch as that of plane teeth (`fegear.dynamics.train.excitation`). The train feels the
transverse line of action: what turns the gears is the transverse force, what shifts and tilts them is for rigid
bearings.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Mask
from fegear.base.errors import RangeError
from fegear.contact.fourier import Panels
from fegear.contact.wide.lines import life_of_contact
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.contact.wide.mesh_matrix import mesh_stiffness
from fegear.contact.wide.transmission_error import curve_through
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic

#: Accuracy of the fit relative to the largest value, and length of its shortest pieces [base pitches].
FIT, SHORTEST = 1e-7, 2e-4
#: A pair this much less stiff than the mesh is none, and its separation means nothing.
_NO_SPRING = 1e-6
#: Outermost roll positions this near to the ends of their piece stand on them [base pitches].
_ON_END = 1e-5


@dataclass(frozen=True)
class _Life:
    """Force and local stiffness of every tooth pair, and the transmission error, at the roll positions.

    Parameters
    ----------
    points : Panels
    first : int
        j of the first pair; they follow each other.
    stiffness, force : ndarray, shape (pairs, P)
    error : ndarray, shape (P,)
    direction : float
        -1 where the driven gear drives: it sees all from the other side, x with the other sign.
    """

    points: Panels
    first: int
    stiffness: Array
    force: Array
    error: Array
    direction: float

    def places(self, s: Array) -> tuple[Array, Array]:
        """Roll positions that belong to phases, in the base pitch of the points, and j of the pair in slot 0."""
        pitch, start = self.points.period, float(self.points.breaks[0])
        x = self.direction * s * pitch
        number = np.floor((x - start) / pitch)
        return x - number * pitch, number.astype(int)

    @cached_property
    def straight(self) -> Mask:
        """Pieces of the base pitch on which curves go straight from position to position, by number.

        Where a pair comes to bear or lets go between its positions, and where these do not reach the piece's ends.
        """
        points, found = self.points, np.ones(self.points.breaks.size + 1, dtype=bool)
        own = np.searchsorted(points.breaks, points.x)
        for piece in np.unique(own):
            bears = self.force[:, own == piece] > 0.0
            found[piece] = bool((bears.any(axis=1) & ~bears.all(axis=1)).any()) or not _fills(points, piece)
        return found

    def curve(self, row: int, values: Array, x: Array) -> Array:
        """What `values` (pairs, P) of a pair are at roll positions, shape (Q,)."""
        points = self.points
        # a base pitch later the pair ahead stands where this one stands now
        around = [values[r] if 0 <= r < len(values) else np.zeros(points.x.size) for r in (row - 1, row, row + 1)]
        smooth = curve_through(points, around[1], x)
        places = np.concatenate([points.x + turn * points.period for turn in (-1, 0, 1)])
        straight = np.interp(x, places, np.concatenate(around))
        return np.where(self.straight[np.searchsorted(points.breaks, x)], straight, smooth)

    def spring(self, slot: int, s: Array) -> tuple[Array, Array]:
        """K_Sj [N/m] and zeta - W_j / K_Sj [m] of the pair in a slot at phases of one piece."""
        x, number = self.places(s)
        error = self.curve(1, np.tile(self.error, (3, 1)), x)
        row = int(number[0] + self.direction * slot) - self.first
        if not -1 <= row <= len(self.force):
            return np.zeros(s.shape), error
        k, w = self.curve(row, self.stiffness, x), self.curve(row, self.force, x)
        bears = (k > _NO_SPRING * self.stiffness.sum(axis=0).max()) & (w > 0.0)
        return np.where(bears, k, 0.0), error - np.divide(w, k, out=np.zeros(s.shape), where=bears)

    @property
    def cuts(self) -> Array:
        """Phases at which the curves have corners."""
        points = self.points
        corners = points.x[self.straight[np.searchsorted(points.breaks, points.x)]]
        return np.mod(self.direction * np.concatenate([points.breaks, corners]) / points.period, 1.0)


def _fills(points: Panels, piece: int) -> bool:
    """Whether the roll positions of a piece reach its ends, so that the curve through them is known all over it."""
    if not 0 < piece < points.breaks.size:
        return False
    x = points.x[np.searchsorted(points.breaks, points.x) == piece]
    return bool(max(x[0] - points.breaks[piece - 1], points.breaks[piece] - x[-1]) < _ON_END * points.period)


def excitation_of_flanks(teeth: LoadedWidePair, force: float, *, forward: bool = True) -> MeshExcitation:
    """Springs of a pair with a width, linear about a mean force [N]; about its nominal load where it idles."""
    found = teeth.flanks.solve([force or teeth.nominal], teeth.gaps, teeth.known)
    return flank_excitation(teeth.flanks, found, forward=forward)


def flank_excitation(flanks: FlankPair, found: LoadedFlanks, *, forward: bool = True) -> MeshExcitation:
    """One-sided springs of a gear pair with a width, linear about the load that its flanks carry.

    Parameters
    ----------
    flanks : FlankPair
        For its roll positions.
    found : LoadedFlanks
        Its flanks under the mean mesh force, the first of their loads.
    forward : bool
        Whether the pair's driver drives in fact; else x counts toward the tip of its driven gear.

    Returns
    -------
    MeshExcitation

    Raises
    ------
    RangeError
        If a tooth pair carries less as the gears approach: no spring does.
    """
    stations = mesh_stiffness(found, flanks.points).stations[:, :, 0]
    lines, first = found.lines, int(found.pair_numbers[0])
    on = [(lines.pair == j) & lines.present for j in found.pair_numbers.tolist()]  # they follow each other
    stiffness = np.stack([(stations * here).sum(axis=1) for here in on])
    force = found.pair_load[:, :, 0]
    if np.any(stiffness[force > 0.0] <= 0.0):
        raise RangeError(
            "effects.neighbour_coupling", "true", "gives a tooth pair a negative tangent stiffness",
            "switch it off, or increase the rim thickness",
        )  # fmt: skip
    life = _Life(
        flanks.points, first, stiffness, force, found.transmission_error[:, 0], 1.0 if forward else -1.0
    )  # fmt: skip
    pitch = found.pair.base_pitch
    start, end = life_of_contact(found.pair if forward else found.pair.reversed())
    # straight lines between few roll positions carry a pair a step beyond its life
    slots = range(math.floor(start / pitch) - 1, math.ceil(end / pitch) + 1)
    deflection = float(life.error.max())

    def fit(quantity: int, slot: int) -> Periodic:
        scale = 0.0 if quantity == 0 else deflection
        return Periodic.fit(
            lambda s: life.spring(slot, s)[quantity], life.cuts, tolerance=FIT, shortest=SHORTEST, scale=scale
        )

    stiffness_of = {slot: fit(0, slot) for slot in slots}
    bears = [slot for slot, spring in stiffness_of.items() if np.any(spring.coefficients)]
    slots = range(bears[0], bears[-1] + 1)
    return MeshExcitation.about_load(
        tuple(stiffness_of[slot] for slot in slots), tuple(fit(1, slot) for slot in slots), slots.start
    )
