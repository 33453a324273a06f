"""Deviations of gears and housing drawn inside their tolerances: seeded, quasi-random, each kind in its own columns.

A row of points in the unit cube becomes one engagement of one pair of gears. Each kind of deviation keeps its columns
whether or not it is wanted, and rows follow each other in one sequence: what is added, left out or asked for in greater
number changes none of the others.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.geometry.flank_modification import FlankModification

Sequence = Literal["sobol", "halton", "random"]
Distribution = Literal["normal", "uniform"]
Seed = int | tuple[int, ...]
Kind = Literal["centre-distance", "profile-slope", "profile-form", "helix-slope", "pitch"]
KINDS: tuple[Kind, ...] = ("centre-distance", "profile-slope", "profile-form", "helix-slope", "pitch")
#: Tolerance over the standard deviation of a normal distribution, which ends there.
SIGMAS = 3.0
#: Waves of the profile form over the active profile: between these, evenly.
_WAVES = 1.0, 3.0
#: Columns before those of the pitches: centre distance, slopes, forms, helices, waves, phases of both gears.
_BEFORE_PITCH = 11


@dataclass(frozen=True)
class Limits:
    """Largest deviations of one pair [m]; zero for kinds that are not wanted. Pairs hold driver and driven.

    Parameters
    ----------
    centre_distance : float
    profile_slope, profile_form, helix_slope, pitch : (float, float)
        f_HalphaT, f_falphaT, f_HbetaT and f_pT cos(alpha_t): all along the line of action.
    """

    centre_distance: float
    profile_slope: tuple[float, float]
    profile_form: tuple[float, float]
    helix_slope: tuple[float, float]
    pitch: tuple[float, float]


#: Those of a perfect pair.
NO_LIMITS = Limits(0.0, *(((0.0, 0.0),) * 4))


@dataclass(frozen=True)
class ProfileDeviation:
    """Slope and form deviation of a profile, as a modification of its flank; held at its ends beyond them.

    Parameters
    ----------
    start, end : float
        Roll angles between which the profile is evaluated, from root to tip [rad].
    slope : float
        f_Halpha [m], positive where material stands out at the tip; zero in the middle.
    form : float
        Width of the band of the form deviation, f_falpha [m]: a cosine of half that amplitude.
    waves, phase : float
        Of the cosine over the evaluated length, and its phase at the start [rad].
    """

    start: float
    end: float
    slope: float
    form: float
    waves: float
    phase: float

    @property
    def kinks(self) -> tuple[float, ...]:
        """None."""
        return ()

    def removal(self, roll: ArrayLike) -> Array:
        """Of material, positive [m]."""
        t = np.clip((np.asarray(roll, dtype=float) - self.start) / (self.end - self.start), 0.0, 1.0)
        wave = np.cos(2.0 * math.pi * self.waves * t + self.phase)
        return np.asarray(-self.slope * (t - 0.5) - 0.5 * self.form * wave)


@dataclass(frozen=True)
class HelixDeviation(FlankModification):
    """Slope deviation of a helix over a gear's own face, nothing in its middle.

    Parameters
    ----------
    amount : float
        f_Hbeta [m]: removal at end II less that at end I.
    face_width : float
        [m].
    """

    amount: float
    face_width: float

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Of material, positive [m], at roll angles [rad] and heights from the middle of the face [m]."""
        share, _ = np.broadcast_arrays(np.asarray(z, dtype=float) / self.face_width, np.asarray(roll, dtype=float))
        return np.asarray(self.amount * share)


@dataclass(frozen=True)
class Deviations:
    """Rows of deviations; arrays of shape (D,), (D, 2) for driver and driven, (D, 2, 2 T) for the pitches.

    Waves and phase are those of the profile form, see `ProfileDeviation`. Single pitch deviations along the line of
    action between neighbouring teeth are of the gaps before and after tooth 0 in turn, from it outward, so that entry 0
    lies between teeth 0 and -1, entry 1 between 0 and 1, entry 2 between -1 and -2.
    """

    centre_distance: Array = shown("um", "deviation from nominal")
    profile_slope: Array = shown("um", "f_Halpha, positive: excess material at the tip")
    profile_form: Array = shown("um", "band of the profile form, f_falpha")
    helix_slope: Array = shown("um", "f_Hbeta, positive: less material at end II")
    waves: Array = shown("", "number of waves over the active profile")
    phase: Array = shown("deg", "phase of the waves at the start of contact")
    pitch: Array = shown("um", "f_p cos(alpha_t) between neighbouring teeth")

    def __len__(self) -> int:
        """D."""
        return self.centre_distance.size

    def rows(self, which: slice) -> Deviations:
        """Some of them."""
        return Deviations(*(np.ascontiguousarray(getattr(self, name)[which]) for name in self.__dataclass_fields__))

    def spacing(self, row: int, member: int, teeth: int) -> Array:
        """Position errors of a gear's teeth in the order of meshing [m]: accumulated from tooth 0, shape (teeth,).

        Positive lies back, as in a case's ``spacing_errors``; teeth that no engagement of tooth 0 reaches are zero.
        """
        found, gaps = np.zeros(teeth), self.pitch[row, member]
        for first, sign in ((0, -1), (1, 1)):
            place = 0.0
            for count, gap in enumerate(gaps[first::2], 1):
                if 2 * count >= teeth:
                    break  # the other side of a gear with very few teeth
                place += sign * float(gap)
                found[(sign * count) % teeth] = place
        return found


def unit_points(count: int, dimensions: int, seed: Seed, sequence: Sequence = "sobol") -> Array:
    """Points in the unit cube, shape (count, dimensions); the first ones stay what they are when more are asked for.

    Parameters
    ----------
    count, dimensions : int
    seed : int or tuple of int
    sequence : {"sobol", "halton", "random"}
        Scrambled with the seed; "random" is plain Monte Carlo.
    """
    from scipy.stats import qmc

    generator = np.random.default_rng(seed)
    if sequence == "random":
        return generator.random((count, dimensions))
    made = (qmc.Sobol if sequence == "sobol" else qmc.Halton)(dimensions, scramble=True, rng=generator)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a Sobol sequence is balanced best at powers of two
        return np.asarray(made.random(count))


def draw(
    limits: Limits,
    count: int,
    seed: Seed,
    teeth: int,
    sequence: Sequence = "sobol",
    distribution: Distribution = "normal",
) -> Deviations:
    """Draw deviations inside their limits.

    Parameters
    ----------
    limits : Limits
    count : int
    seed : int or tuple of int
        Several numbers are a seed of their own: draws that those of the first alone have nothing in common with.
    teeth : int
        T, teeth on either side of tooth 0 whose pitches count.
    sequence : {"sobol", "halton", "random"}
    distribution : {"normal", "uniform"}
        Normal with the tolerance at three standard deviations, cut there; or even over the tolerance.
    """
    cube = unit_points(count, _BEFORE_PITCH + 4 * teeth, seed, sequence)
    spread = _spread(cube, distribution)

    def both(first: int, limit: tuple[float, float]) -> Array:
        return spread[:, first : first + 2] * limit

    pitch = spread[:, _BEFORE_PITCH:].reshape(count, 2 * teeth, 2).transpose(0, 2, 1)
    low, high = _WAVES
    return Deviations(
        centre_distance=spread[:, 0] * limits.centre_distance,
        profile_slope=both(1, limits.profile_slope),
        profile_form=both(3, limits.profile_form),
        helix_slope=both(5, limits.helix_slope),
        waves=low + (high - low) * cube[:, 7:9],
        phase=2.0 * math.pi * cube[:, 9:11],
        pitch=pitch * np.array(limits.pitch)[None, :, None],
    )


def _spread(cube: Array, distribution: Distribution) -> Array:
    """Points of the unit cube as deviations over their limits, -1 to 1."""
    if distribution == "uniform":
        return 2.0 * cube - 1.0
    from scipy.special import ndtr, ndtri

    tail = float(ndtr(-SIGMAS))
    return np.asarray(np.clip(ndtri(tail + (1.0 - 2.0 * tail) * cube) / SIGMAS, -1.0, 1.0))
