"""Transmission error of arrays of variants from the atlases that come with fegear, bare and with the best tip relief.

Spur gears of a rack, pressure angle and material that an atlas contains are loaded by arrays, some thousand pairs a
second; all others have NaN here and are solved by finite elements. Which helical ones are worth that is seen by thin
slices of such gears.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.atlas.many_pairs import known_pairs, spur_pairs
from fegear.atlas.shipped import SHIPPED, family_of, shipped_atlas
from fegear.atlas.thin_slices import sliced_errors
from fegear.contact.many import corners
from fegear.contact.many.arrays import ManyReliefs
from fegear.contact.many.many_load_sharing import transmission_errors
from fegear.contact.many.many_roots import root_stresses

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fegear.atlas.interpolation import Atlas
    from fegear.base.arrays import Array, Index, Mask
    from fegear.contact.many.arrays import ManyEngagements
    from fegear.design.sizing.space import SizingSpace
    from fegear.geometry.many_pairs import ManyGearPairs

#: Proportions that differ by no more than this are those of an atlas.
_SAME = 1e-9
#: Lengths of tip reliefs: from the tips to where one pair less is in contact, and to the middle of the path.
LENGTHS = ("short", "long")
#: Amounts of relief that are tried first, as shares of the mean transmission error at the largest torque.
_FIRST = np.array([0.0, 0.15, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 1.6, 2.0, 2.5])
#: Steps of the golden section about the best of these, and its share.
_STEPS, _GOLDEN = 7, 0.5 * (np.sqrt(5.0) - 1.0)
#: Amounts are whole tenths of a micrometre [m].
_WHOLE = 1e-7
#: Pairs whose root stress is looked up at once: their tables take 0.3 MB each.
_STRESSED = 256
#: Limits of a relief's length as shares of the flank.
_SHORTEST, _LONGEST = 0.02, 0.98
#: From which share of the largest amount tried on a relief is at its limit.
_AT_LIMIT = 0.98
#: Overlap ratios that count, as shares of the nominal one: at whole ones thin slices see no ripple.
_OVERLAPS = (0.9, 1.0, 1.1)
#: Accuracy of a search: harmonics, and samples between which changes of contact are looked for.
_WAVES, _SAMPLES = 3, 12


@dataclass(frozen=True)
class AtlasDuty:
    """Under what and of what all variants are.

    Parameters
    ----------
    torques : tuple of float
        On the pinion [N m]; the transmission error counts at its maximum over them.
    young_modulus, poisson_ratio : float
        [Pa].
    root_torque : float
        At which root stress is wanted [N m]; 0 where it is not, which saves most of the time.
    """

    torques: tuple[float, ...]
    young_modulus: float
    poisson_ratio: float
    root_torque: float = 0.0


class Bare(NamedTuple):
    """Transmission error and root stress of unmodified variants, shape (N,); NaN of those that no atlas contains.

    Attributes
    ----------
    te, error : ndarray
        Maximum of the peak-to-peak value over the torques and its estimated error [m].
    root, root_error : ndarray
        Maximum root stress of both gears and its estimated error [Pa]; NaN where it is not wanted.
    """

    te: Array
    error: Array
    root: Array
    root_error: Array

    @classmethod
    def unknown(cls, count: int) -> Bare:
        """Of so many variants."""
        return cls(*np.full((4, count), np.nan))


class Relieved(NamedTuple):
    """Transmission error of variants with equal tip reliefs on both gears, shape (N,); NaN as of `Bare`.

    Attributes
    ----------
    te : ndarray
        Of the best [m]; that of the unmodified pair where no relief is better.
    amount : ndarray
        [m].
    kind : ndarray of int
        Of the length: its place in `LENGTHS`.
    lengths : ndarray, shape (2, N)
        Along the line of action, of pinion and wheel [m].
    at_limit : ndarray of bool
        Whether the amount is the largest that was tried.
    """

    te: Array
    amount: Array
    kind: Index
    lengths: Array
    at_limit: Mask


def of_an_atlas(pairs: ManyGearPairs, poisson_ratio: float, *, helical: bool = False) -> Iterator[tuple[Atlas, Index]]:
    """Atlases, and which spur (or helical) pairs are of their families."""
    for rack in SHIPPED:
        atlas = shipped_atlas(rack)
        family = atlas.family
        if abs(poisson_ratio - family.poisson_ratio) > _SAME:
            continue
        same = ((pairs.helix_angle != 0.0) == helical) & (abs(pairs.pressure_angle - family.pressure_angle) <= _SAME)
        same &= abs(pairs.dedendum - family.dedendum) <= _SAME
        same &= abs(pairs.rack_tip_radius - family.rounding) <= _SAME
        if same.any():
            yield atlas, np.flatnonzero(same)


def may_hold(space: SizingSpace, poisson_ratio: float, *, helical: bool = False) -> bool:
    """Whether any spur (or helical) variant of a requirement is of the family of an atlas that comes with fegear."""
    return any(
        abs(poisson_ratio - one.poisson_ratio) <= _SAME
        and (any(space.betas) if helical else 0.0 in space.betas)
        and any(abs(alpha - one.pressure_angle) <= _SAME for alpha in space.alphas)
        and any(abs(height + space.root_clearance - one.dedendum) <= _SAME for height in space.heights)
        and abs(space.rack_tip_radius - one.rounding) <= _SAME
        for one in map(family_of, SHIPPED)
    )


def _loads(pairs: ManyGearPairs, duty: AtlasDuty) -> Array:
    """Along the line of action [N], shape (N, L)."""
    return np.asarray(duty.torques) / (0.5 * pairs.base_diameters[0])[:, None]


def bare_errors(pairs: ManyGearPairs, duty: AtlasDuty) -> Bare:
    """Transmission error and root stress of unmodified pairs.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    te, error, root, root_error = bare = Bare.unknown(len(pairs))
    stressed = duty.root_torque > 0.0
    for atlas, every in of_an_atlas(pairs, duty.poisson_ratio):
        size = _STRESSED if stressed else max(every.size, 1)
        for rows in (every[first : first + size] for first in range(0, every.size, size)):
            some = pairs.at(rows)
            known = known_pairs(atlas, spur_pairs(some, young_modulus=duty.young_modulus), root_stress=stressed)
            found = transmission_errors(known.engagements, _loads(some, duty))
            te[rows] = found.peak_to_peak.max(axis=1)
            # Both ends of the peak-to-peak value are deflections, each off by no more than its share of compliances.
            error[rows] = 2.0 * known.error.max(axis=0) * found.mean.max(axis=1)
            if known.fillets is not None:
                load = duty.root_torque / (0.5 * some.base_diameters[0])
                tension = root_stresses(known.engagements, known.fillets, load[:, None]).tension[:, :, 0]
                root[rows] = tension.max(axis=0)
                root_error[rows] = (known.stress_error[:, :, 0] * tension).max(axis=0)
    return bare


def sliced_errors_of(pairs: ManyGearPairs, duty: AtlasDuty) -> Array:
    """Transmission error of helical variants by thin slices, its maximum over torques and overlaps, (N,) [m].

    NaN of spur ones and of other racks.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    te = np.full(len(pairs), np.nan)
    for atlas, rows in of_an_atlas(pairs, duty.poisson_ratio, helical=True):
        some = pairs.at(rows)
        found = sliced_errors(atlas, some, _loads(some, duty), duty.young_modulus, _OVERLAPS)
        te[rows] = found.peak_to_peak.max(axis=1)
    return te


def relieved_errors(pairs: ManyGearPairs, duty: AtlasDuty) -> Relieved:
    """Transmission error with the best of equal, linear, short or long tip reliefs of both gears.

    Amounts are tried from none to two and a half times the mean transmission error, then by the golden section.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    count = len(pairs)
    te, amount, lengths = np.full(count, np.nan), np.full(count, np.nan), np.full((2, count), np.nan)
    kind, at_limit = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=bool)
    for atlas, rows in of_an_atlas(pairs, duty.poisson_ratio):
        some = pairs.at(rows)
        known = known_pairs(atlas, spur_pairs(some, young_modulus=duty.young_modulus)).engagements
        found = _best(known, _loads(some, duty))
        te[rows], amount[rows], kind[rows], lengths[:, rows], at_limit[rows] = found
    return Relieved(te, amount, kind, lengths, at_limit)


def _left(engagements: ManyEngagements, loads: Array, lengths: Array, amount: Array, **accuracy: int) -> Array:
    """Transmission error that a relief leaves, its maximum over the loads [m]."""
    reliefs = _reliefs(engagements, amount, lengths)
    return transmission_errors(replace(engagements, reliefs=reliefs), loads, **accuracy).peak_to_peak.max(axis=1)


def _best(engagements: ManyEngagements, loads: Array) -> Relieved:
    bare = transmission_errors(engagements, loads)
    unit, te = bare.mean.max(axis=1), bare.peak_to_peak.max(axis=1)
    none = np.zeros(te.shape)
    best = Relieved(te, none, none.astype(np.int64), np.zeros((2, te.size)), none.astype(bool))
    for kind, lengths in enumerate(_lengths(engagements)):
        quick = partial(_left, engagements, loads, lengths, waves=_WAVES, samples=_SAMPLES)
        tried = np.stack([quick(share * unit) for share in _FIRST])
        first = np.where(np.isfinite(tried), tried, np.inf).argmin(axis=0)
        low, high = _FIRST[np.maximum(first - 1, 0)] * unit, _FIRST[np.minimum(first + 1, _FIRST.size - 1)] * unit
        amount = np.maximum(np.round(_golden(quick, low, high) / _WHOLE), 1.0) * _WHOLE
        found = _left(engagements, loads, lengths, amount)
        better = found < best.te
        best = Relieved(
            np.where(better, found, best.te), np.where(better, amount, best.amount), np.where(better, kind, best.kind),
            np.where(better, lengths, best.lengths),
            np.where(better, amount > _AT_LIMIT * _FIRST[-1] * unit, best.at_limit),
        )  # fmt: skip
    return best


def _golden(of: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Where a function is least between two places, each by itself."""
    a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_a, at_b = of(a), of(b)
    for _ in range(_STEPS):
        left = at_a < at_b
        high, low = np.where(left, b, high), np.where(left, low, a)
        new = np.where(left, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
        at_new = of(new)
        a, b, at_a, at_b = (
            np.where(left, new, b), np.where(left, a, new), np.where(left, at_new, at_b), np.where(left, at_a, at_new)
        )  # fmt: skip
    return np.asarray(np.where(at_a < at_b, a, b))


def _lengths(engagements: ManyEngagements) -> tuple[Array, Array]:
    """Of short and long reliefs of both gears along the line of action, from the ends of their flanks [m]."""
    start, end, pitch = (engagements.numbers[:, k] for k in (corners.START, corners.END, corners.PITCH))
    whole = np.maximum(np.floor((end - start) / pitch), 1.0) * pitch
    middle = 0.5 * (start + end)
    tips = engagements.flanks.highest
    at_pitch = np.stack([engagements.numbers[:, corners.AT1], engagements.numbers[:, corners.AT2]])
    flank = tips - engagements.flanks.lowest
    short, long = (
        np.clip(tips - at_pitch + np.stack(place), _SHORTEST * flank, _LONGEST * flank)
        for place in ([-(start + whole), end - whole], [-middle, middle])
    )
    return short, long


def _reliefs(engagements: ManyEngagements, amount: Array, lengths: Array) -> ManyReliefs:
    flanks = engagements.flanks
    share = np.minimum(lengths / (flanks.highest - flanks.lowest), 1.0)
    both = np.broadcast_to(np.nan_to_num(amount), share.shape)
    return ManyReliefs(both, np.nan_to_num(1.0 - share, nan=0.5), np.ones(share.shape))
