"""Arrays of pairs whose gears an atlas knows: the tables that load sharing of many pairs reads.

The bridge from `fegear.formulas.many.pairs.ManyPairs`, or from plain arrays, to `fegear.contact.many`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from fegear.atlas.tables import shares_of_fillet, shares_of_flank
from fegear.base.arrays import ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.contact.many.arrays import ManyEngagements, ManyFlanks, ManyReliefs
from fegear.contact.many.many_load_sharing import ManyErrors, transmission_errors
from fegear.contact.many.many_roots import ManyFillets, ManyRootStress, root_stresses
from fegear.fem.plane.contact_width import POINT, log_slope

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.atlas.interpolation import Atlas
    from fegear.base.arrays import Array, Mask
    from fegear.geometry.many_pairs import ManyGearPairs

#: Pairs whose tables are held at once: 0.3 MB each with those of root stress.
_AT_ONCE = 256


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


_Arrays = TypeVar("_Arrays", ManySpurPairs, ManyReliefs)


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
    stress_error : ndarray, shape (2, N, 2)
        Estimated relative errors of root stress, tension and compression.
    fillets : ManyFillets, optional
        Where root stress was asked for.
    """

    engagements: ManyEngagements
    held: Mask
    error: Array
    stress_error: Array
    fillets: ManyFillets | None = None


class ManyLoaded(NamedTuple):
    """What pairs do under their loads; NaN where an atlas does not hold them, or they are none.

    Attributes
    ----------
    held : ndarray of bool, shape (N,)
        Whether the atlas holds both gears.
    transmission_error : ManyErrors
    root_stress : ManyRootStress, optional
    error, stress_error : ndarray, shape (2, N), (2, N, 2)
        Estimated relative errors of c_0, and of root stress, tension and compression.
    """

    held: Mask
    transmission_error: ManyErrors
    root_stress: ManyRootStress | None
    error: Array
    stress_error: Array


def known_pairs(
    atlas: Atlas,
    pairs: ManySpurPairs,
    *,
    corner_contact: bool = True,
    reliefs: ManyReliefs | None = None,
    root_stress: bool = False,
) -> KnownPairs:
    """Look up both gears of each pair.

    Parameters
    ----------
    atlas : Atlas
        Of the rack by which all gears are cut, of their material's Poisson's ratio and plane assumption.
    pairs : ManySpurPairs
        Some 10,000 at a time: each takes 7 kB; with root stress some hundred, 0.3 MB each (`loaded_pairs`).
    corner_contact : bool
    reliefs : ManyReliefs, optional
    root_stress : bool
        Whether stress along the fillets is looked up.

    Raises
    ------
    InputError
        If the atlas is of gears with rounded tips.
    """
    family, layout, m = atlas.family, atlas.layout, pairs.module
    if family.tip_rounding != 0.0:
        raise InputError("tip_rounding", f"{family.tip_rounding:.6g}", "must be 0 for arrays of pairs (sharp tips)")
    cosine = math.cos(family.pressure_angle)
    own, beside, lowest, errors, stress, length, held = [], [], [], [], [], [], np.ones(m.size, dtype=bool)
    nearest = []
    for member in (0, 1):
        places = pairs.places(atlas, member)
        found, modulus = atlas.tables(places, stress=root_stress), pairs.young_modulus[member]
        held &= np.isfinite(found.rows[:, 0])
        own.append(layout.own(found.rows) / modulus[:, None])
        beside.append(np.stack([layout.neighbour(found.rows, k) for k in range(1, atlas.reach + 1)], axis=1)
                      / modulus[:, None, None, None])  # fmt: skip
        lowest.append(m * family.start_of_flank(places))
        errors.append(found.errors)
        nearest.append(np.where(family.undercut(places), POINT, 0.0))
        if root_stress:
            stress.append(layout.stresses(found.rows))
            length.append(layout.ends(found.rows)[:, 1])
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
    fillets = None
    if root_stress:
        fillets = ManyFillets(
            np.stack(stress), np.stack(length), np.stack(nearest), shares_of_flank(), shares_of_fillet()
        )
    known = np.stack(errors)
    roots = [layout.quantities.index(f"{side} 0") for side in ("tension", "compression")]
    return KnownPairs(engagements, held, known[..., 0], known[..., roots], fillets)


def loaded_pairs(
    atlas: Atlas,
    pairs: ManySpurPairs,
    loads: ArrayLike,
    *,
    corner_contact: bool = True,
    reliefs: ManyReliefs | None = None,
    root_stress: bool = True,
    at_once: int = _AT_ONCE,
) -> ManyLoaded:
    """Transmission error and root stress of any number of pairs, so many at once that memory stays bounded.

    Parameters
    ----------
    atlas, pairs, corner_contact, reliefs
        As of `known_pairs`.
    loads : array_like, shape (N, L) or (L,)
        Along the line of action [N].
    root_stress : bool
        Whether root stress is wanted, which takes most of the time.
    at_once : int
        Whose tables are held in memory.

    Raises
    ------
    InputError
        If the atlas is of gears with rounded tips.
    MissingLibraryError
        If numba is not installed.
    """
    count, given = pairs.module.size, np.asarray(loads, dtype=float)
    each = np.broadcast_to(given, (count, given.shape[-1]))
    parts: list[ManyLoaded] = []
    for first in range(0, max(count, 1), at_once):
        rows = slice(first, first + at_once)
        known = known_pairs(
            atlas, _part(pairs, rows), corner_contact=corner_contact, root_stress=root_stress,
            reliefs=None if reliefs is None else _part(reliefs, rows),
        )  # fmt: skip
        errors = transmission_errors(known.engagements, each[rows])
        roots = None if known.fillets is None else root_stresses(known.engagements, known.fillets, each[rows])
        parts.append(ManyLoaded(known.held, errors, roots, known.error, known.stress_error))
    stresses = [one.root_stress for one in parts if one.root_stress is not None]
    return ManyLoaded(
        np.concatenate([one.held for one in parts]),
        ManyErrors(*(np.concatenate(each) for each in zip(*(one.transmission_error for one in parts), strict=True))),
        ManyRootStress(*(np.concatenate(each, axis=1) for each in zip(*stresses, strict=True))) if stresses else None,
        np.concatenate([one.error for one in parts], axis=1),
        np.concatenate([one.stress_error for one in parts], axis=1),
    )


def _part(of: _Arrays, rows: slice) -> _Arrays:
    """Some of the pairs."""
    return type(of)(*(getattr(of, one.name)[..., rows] for one in fields(of)))
