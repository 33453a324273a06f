"""Transmission error of arrays of helical pairs by thin slices: quick enough for every variant of a requirement.

A slice is loaded as a spur pair of the transverse section whose teeth are as compliant as those of the virtual spur
gears of the normal section, from an atlas. Slices along the face are at other roll positions and do not support each
other, so the stiffness of the pair is that of its slices averaged over as many base pitches as the overlap ratio. What
neighbouring slices bear of each other, face ends and bodies is left out: for putting variants in order, not for numbers
(at whole overlap ratios the values are too small, see `spread` of the overlap ratio).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.contact.many.arrays import ManyEngagements, ManyFlanks
from fegear.contact.many.many_load_sharing import shares_at
from fegear.fem.plane.contact_width import log_slope

if TYPE_CHECKING:
    from fegear.atlas.interpolation import Atlas
    from fegear.base.arrays import Array
    from fegear.geometry.many_pairs import ManyGearPairs

#: Roll positions of a base pitch.
_POSITIONS = 64
#: Bodies are fixed at this share of their root radii.
_BORE = 0.5
#: By how much a gear beside a region is moved into it, as a share of the region's extent.
_INSIDE = 1e-6


class SlicedErrors(NamedTuple):
    """Transmission error by thin slices, shape (N, L).

    Attributes
    ----------
    mean, peak_to_peak : ndarray
        [m].
    """

    mean: Array
    peak_to_peak: Array


def sliced_errors(
    atlas: Atlas, pairs: ManyGearPairs, loads: Array, young_modulus: float, overlaps: tuple[float, ...] = (1.0,)
) -> SlicedErrors:
    """Transmission error of helical pairs without modifications, over a base pitch.

    Parameters
    ----------
    atlas : Atlas
        Of the rack by which all gears are cut; gears beside its regions are taken at their ends.
    pairs : ManyGearPairs
        Spur ones among them have slices that are all alike.
    loads : ndarray, shape (N, L)
        Along the transverse line of action [N].
    young_modulus : float
        [Pa].
    overlaps : tuple of float
        Factors of the overlap ratio: where a face is wider or narrower, or its ends bear less. Values are the maxima
        over them.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    spur = _slices(atlas, pairs, young_modulus)
    at = np.arange(_POSITIONS) / _POSITIONS
    mean, peak_to_peak = np.zeros(loads.shape), np.zeros(loads.shape)
    for column, load in enumerate(loads.T):
        waves = np.fft.rfft(load[:, None] / shares_at(spur, load, at).transmission_error, axis=1)
        for factor in overlaps:
            window = np.sinc(np.arange(waves.shape[1]) * factor * pairs.overlap_ratio[:, None])
            error = load[:, None] / np.fft.irfft(waves * window, _POSITIONS, axis=1)
            mean[:, column] = np.maximum(mean[:, column], error.mean(axis=1))
            peak_to_peak[:, column] = np.maximum(peak_to_peak[:, column], np.ptp(error, axis=1))
    return SlicedErrors(mean, peak_to_peak)


def _slices(atlas: Atlas, pairs: ManyGearPairs, young_modulus: float) -> ManyEngagements:
    """Pairs of the transverse section, loaded as if they were spur."""
    family, layout, lean = atlas.family, atlas.layout, np.cos(pairs.base_helix_angle)
    own, beside = [], []
    for teeth, shift in zip(pairs.teeth, pairs.profile_shift, strict=True):
        virtual = teeth / (lean**2 * np.cos(pairs.helix_angle))
        places = np.stack([virtual, shift, pairs.addendum + pairs.tip_alteration, np.full(teeth.size, _BORE)])
        # The load along the transverse line of action moves a flank that leans against it by more.
        rows = atlas.tables(_moved_inside(atlas, places), stress=False).rows / (young_modulus * lean[:, None])
        own.append(layout.own(rows))
        beside.append(np.stack([layout.neighbour(rows, k) for k in range(1, atlas.reach + 1)], axis=1))
    base = 0.5 * pairs.base_diameters
    strain = 1.0 - family.poisson_ratio**2 if family.plane == "strain" else 1.0
    flanks = ManyFlanks(
        np.stack(own), np.stack(beside), pairs.form_rolls, pairs.tip_rolls, base,
        np.broadcast_to(log_slope(family.poisson_ratio, family.plane) / (young_modulus * lean), base.shape),
        np.full(base.shape, young_modulus / strain),
    )  # fmt: skip
    return ManyEngagements(flanks, pairs.module, pairs.base_pitch, pairs.centre_distance, pairs.face_width)


def _moved_inside(atlas: Atlas, places: Array) -> Array:
    """Gears without undercut at the nearest places of the atlas."""
    whole = [domain for domain in atlas.domains if domain.side == "whole"]
    fewest, most = min(one.teeth[0] for one in whole), max(one.teeth[1] for one in whole)
    found = places.copy()
    found[0] = np.clip(places[0], fewest, most)
    for domain in whole:
        here = (found[0] >= domain.teeth[0]) & (found[0] <= domain.teeth[1])
        # between the last tooth number of a region and the first of the next
        here |= (found[0] > domain.teeth[1]) & (found[0] < domain.teeth[1] + 1.0)
        found[0, here] = np.minimum(found[0, here], domain.teeth[1])
        ends = [domain.tip_height, domain.bore]
        for number, (low, high) in zip((2, 3), ends, strict=True):
            found[number, here] = np.clip(found[number, here], low, high)
        for n in np.flatnonzero(here):
            low, high = domain.shift_ends(atlas.family, float(found[0, n]))
            slack = _INSIDE * (high - low)
            found[1, n] = min(max(found[1, n], low + slack), high - slack)
    return found
