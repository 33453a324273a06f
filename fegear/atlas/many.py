"""Arrays of pairs whose gears an atlas knows: the tables that load sharing of many pairs reads.

The bridge from `fegear.formulas.many.pairs.ManyPairs`, or from plain arrays, to `fegear.contact.many`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.contact.many.arrays import ManyEngagements, ManyFlanks
from fegear.fem.plane.influence import log_slope

if TYPE_CHECKING:
    from fegear.atlas.atlas import Atlas
    from fegear.base.arrays import Array, Mask
    from fegear.contact.many.arrays import ManyReliefs
    from fegear.geometry.many_pairs import ManyGearPairs


@dataclass(frozen=True, eq=False)
class ManySpurPairs(ReadOnlyArrays):
    """External spur pairs of one rack; gears of shape (2, N), driver and driven, pairs (N,), lengths in metres.

    Parameters
    ----------
    teeth, generating_shift, tip_radius, bore_radius : ndarray, shape (2, N)
    module, centre_distance, face_width : ndarray, shape (N,)
    young_modulus : ndarray, shape (2, N)
        [Pa].
    """

    teeth: Array
    generating_shift: Array
    tip_radius: Array
    bore_radius: Array
    module: Array
    centre_distance: Array
    face_width: Array
    young_modulus: Array

    def places(self, atlas: Atlas, member: int) -> Array:
        """Where the gears lie in the family of an atlas, (4, N)."""
        z, x = self.teeth[member], self.generating_shift[member]
        pitch = 0.5 * z
        root = pitch + x - atlas.family.dedendum
        height = self.tip_radius[member] / self.module - pitch - x
        return np.stack([z, x, height, self.bore_radius[member] / self.module / root])


def spur_pairs(pairs: ManyGearPairs, bore_ratio: float | Array = 0.5, young_modulus: float = 2.06e11) -> ManySpurPairs:
    """Those that `fegear.geometry.many_pairs` describes, with bodies fixed at shares of their root radii.

    Parameters
    ----------
    pairs : ManyGearPairs
        Spur ones.
    bore_ratio : float or ndarray, shape (2, N)
        Radius at which a body is fixed over the root radius.
    young_modulus : float
        [Pa].
    """
    return ManySpurPairs(
        pairs.teeth, pairs.profile_shift, 0.5 * pairs.tip_diameters, 0.5 * pairs.root_diameters * bore_ratio,
        pairs.module, pairs.centre_distance, pairs.face_width, np.full(pairs.teeth.shape, young_modulus),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class KnownPairs(ReadOnlyArrays):
    """Pairs that an atlas has made ready to be loaded.

    Parameters
    ----------
    engagements : ManyEngagements
        Of all pairs; those that the atlas does not hold have NaN in their tables, and so in all that follows.
    held : ndarray of bool, shape (N,)
        Whether it holds both gears.
    error : ndarray, shape (2, N)
        Estimated relative errors of c_0.
    """

    engagements: ManyEngagements
    held: Mask
    error: Array


def known_pairs(
    atlas: Atlas, pairs: ManySpurPairs, *, corner_contact: bool = True, reliefs: ManyReliefs | None = None
) -> KnownPairs:
    """Look up both gears of each pair.

    Parameters
    ----------
    atlas : Atlas
        Of the rack by which all gears are cut, of their material's Poisson's ratio and plane assumption.
    pairs : ManySpurPairs
        Some 10,000 at a time: each takes 7 kB.
    corner_contact : bool
    reliefs : ManyReliefs, optional

    Raises
    ------
    InputError
        If the atlas is of gears with rounded tips.
    """
    family, layout, m = atlas.family, atlas.layout, pairs.module
    if family.tip_rounding != 0.0:
        raise InputError("tip_rounding", f"{family.tip_rounding:.6g}", "must be 0 for arrays of pairs (sharp tips)")
    cosine = math.cos(family.pressure_angle)
    own, beside, lowest, errors, held = [], [], [], [], np.ones(m.size, dtype=bool)
    for member in (0, 1):
        places = pairs.places(atlas, member)
        found, modulus = atlas.tables(places, stress=False), pairs.young_modulus[member]
        held &= np.isfinite(found.rows[:, 0])
        own.append(layout.own(found.rows) / modulus[:, None])
        beside.append(np.stack([layout.neighbour(found.rows, k) for k in range(1, atlas.reach + 1)], axis=1)
                      / modulus[:, None, None, None])  # fmt: skip
        lowest.append(m * np.where(places[1] < family.least_shift_of(places[0]), atlas.ends(places)[:, 0],
                                   family.lowest_roll_length(places[0], places[1])))  # fmt: skip
        errors.append(found.errors[:, 0])
    base = 0.5 * pairs.teeth * m * cosine
    slope = log_slope(family.poisson_ratio, family.plane) / pairs.young_modulus
    flanks = ManyFlanks(
        np.stack(own), np.stack(beside), np.stack(lowest),
        np.sqrt(np.maximum((pairs.tip_radius - base) * (pairs.tip_radius + base), 0.0)), base, slope,
        pairs.young_modulus / (1.0 - family.poisson_ratio**2 if family.plane == "strain" else 1.0),
    )  # fmt: skip
    engagements = ManyEngagements(
        flanks, m, math.pi * m * cosine, pairs.centre_distance, pairs.face_width, reliefs, corner_contact
    )
    return KnownPairs(engagements, held, np.stack(errors))
