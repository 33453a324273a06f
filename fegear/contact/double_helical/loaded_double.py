"""A double helical pair under all its loads: what its two halves in balance answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from fegear.contact.double_helical.balance import Balance
    from fegear.contact.double_helical.double_spec import DoubleHelicalSpec
    from fegear.contact.fourier import Panels
    from fegear.contact.wide.loaded import LoadedFlanks


@dataclass(frozen=True)
class DoubleError(ReadOnlyArrays):
    """Estimated errors; each solution's changes add up, with what slices are known to miss and positions leave open.

    Parameters
    ----------
    transmission_error, share, axial_motion : ndarray, shape (P, L)
        [m], of the half at end I, [m].
    mean, peak_to_peak : ndarray, shape (L,)
        Of the transmission error [m].
    load_factor : ndarray, shape (L,)
    face_load_factors : ndarray, shape (2, L)
    """

    transmission_error: Array
    share: Array
    axial_motion: Array
    mean: Array = shown("um", "mean transmission error of both halves", name="te_mean")
    peak_to_peak: Array = shown("um", "both halves, over the base pitch", name="te_peak_to_peak")
    load_factor: Array = shown("", "mean load of the half that carries more for its face width", name="K_gamma")
    face_load_factors: Array = shown("", "maximum / mean load per face width of each half", name="K_Hbeta")


@dataclass(frozen=True)
class LoadedDoublePair:
    """A double helical pair at P mesh positions of one base pitch, under L loads.

    Parameters
    ----------
    spec : DoubleHelicalSpec
    points : Panels
        Mesh positions: roll positions of the half at end I [m].
    halves : (LoadedFlanks, LoadedFlanks)
        Under what each carries; the `load` of either is the mean of that over the base pitch [N], and their roll
        positions are their own, ascending.
    balance : Balance
    error : DoubleError or None
        Estimated, if that was asked for.
    """

    spec: DoubleHelicalSpec
    points: Panels
    halves: tuple[LoadedFlanks, LoadedFlanks]
    balance: Balance
    error: DoubleError | None = None

    @property
    def load(self) -> Array:
        """Of both halves together, shape (L,) [N]."""
        return np.array(self.spec.loads)

    def mean(self, values: Array) -> Array:
        """Mean over the base pitch of what is known at the mesh positions, shape (P, ...)."""
        weights = self.points.weights
        return np.asarray(np.tensordot(weights / weights.sum(), values, axes=1))

    @property
    @shows("um", "loaded transmission error along the line of action", name="te")
    def transmission_error(self) -> Array:
        """zeta [m], shape (P, L)."""
        return self.balance.approach

    @property
    def mean_transmission_error(self) -> Array:
        """Mean over a base pitch [m], shape (L,)."""
        return self.mean(self.transmission_error)

    @property
    def peak_to_peak(self) -> Array:
        """Of the transmission error at the mesh positions [m], shape (L,)."""
        return np.asarray(np.ptp(self.transmission_error, axis=0))

    @property
    def share_of_first(self) -> Array:
        """Of the half at end I, shape (P, L)."""
        return self.balance.share

    @property
    @shows("", "load of each half over the total load")
    def share(self) -> Array:
        """Of the halves at end I and II, shape (2, P, L)."""
        return np.stack([self.balance.share, 1.0 - self.balance.share])

    @property
    @shows("um", "axial displacement of the floating member towards end II")
    def axial_motion(self) -> Array:
        """From the middle of its play, shape (P, L) [m]; 0 of located members."""
        if self.spec.floating is None:
            return np.zeros_like(self.balance.position)
        sign = 1.0 if self.spec.floating == "driver" else -1.0
        return np.asarray(sign * (self.balance.position - self.spec.apex_offset))

    @property
    @shows("N", "axial force of both halves on the driver towards end II")
    def axial_force(self) -> Array:
        """Shape (P, L) [N]; the driven feels the opposite."""
        share = self.share
        first, second = self.spec.seat.twist
        return np.asarray(0.0 - self.load * (share[0] * first + share[1] * second))

    @property
    @shows("", "mean load of each half over its part of the face width", name="K_gamma")
    def load_factors(self) -> Array:
        """Mean share over the base pitch over that of an even load, shape (2, L)."""
        return np.stack([self.mean(one) / part for one, part in zip(self.share, self.spec.nominal_parts, strict=True)])

    @property
    def load_factor(self) -> Array:
        """K_gamma, shape (L,): of the half that carries more for its width."""
        return np.asarray(self.load_factors.max(axis=0))

    @property
    def face_load_factors(self) -> Array:
        """K_Hbeta of either half with its own mean load, shape (2, L); NaN of one that carries nothing."""
        carried = [half.load > 0.0 for half in self.halves]
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.stack([
                np.where(some, half.face_load_factor, np.nan) for half, some in zip(self.halves, carried, strict=True)
            ])  # fmt: skip

    @property
    def touches_back(self) -> Mask:
        """Whether a half that carries nothing is farther apart than its backlash, shape (L,): no answer holds then.

        Its other flanks touch there and carry load, which is not counted.
        """
        room = [half.placed.free_backlash for half in self.spec.halves]
        return np.asarray((self.balance.separation > np.array(room)[:, None, None]).any(axis=(0, 1)))

    def answer(self, case: int = -1) -> str:
        """What the sharing comes to under one load, in a sentence."""
        ends, motion = self.share[:, :, case], self.axial_motion[:, case]
        most, way = int(np.argmax(self.load_factors[:, case])), round(float(np.ptp(motion)) * 1e6, 3)
        where = (
            f"the {self.spec.floating} moves {way:.3g} µm along its axis over the base pitch"
            if self.spec.floating
            else "both members located"
        )
        limits = (
            "" if self.balance.free[:, case].all() or self.spec.floating is None else ", touching a stop of its play"
        )
        idle = [f"the half at end {end} carries no load at some mesh positions" for end, half in
                zip(("I", "II"), ends, strict=True) if (half == 0.0).any()]  # fmt: skip
        back = "; its non-working flanks are in contact, which is not included" if self.touches_back[case] else ""
        alone = f" At this load {idle[0]}{back}." if idle else ""
        return (
            f"Double helical pair: the half at end {('I', 'II')[most]} carries "
            f"{float(self.mean(ends[most])) * 100.0:.3g} % of {self.load[case]:.5g} N "
            f"(K_gamma = {float(self.load_factor[case]):.3f}); {where}{limits}; transmission error "
            f"{float(self.peak_to_peak[case]) * 1e6:.3g} µm peak-to-peak.{alone}"
        )
