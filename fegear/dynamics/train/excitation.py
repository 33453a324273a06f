"""What a gear pair does to its train: tooth-pair stiffness and separation, static transmission error.

The phase is the position of a tooth pair on the line of action in base pitches, zero at the pitch point. A tooth pair
lives longer than one base pitch; its life is cut into slots of one pitch, and every slot is a one-sided spring.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.contact.sign_changes import sign_changes
from fegear.dynamics.train.back_flanks import BackFlanks
from fegear.dynamics.train.periodic import Periodic, combine

#: Divisions of a cell in which a spring comes to bear or lets go: to the last digit.
_PASSES = 12


@dataclass(frozen=True)
class _Slot:
    """The part of a tooth pair's life that falls into base pitch j, zero off the path of contact."""

    function: Callable[[Array], Array]
    j: int
    base_pitch: float
    x_start: float
    x_end: float

    def __call__(self, s: Array) -> Array:
        x = (s + self.j) * self.base_pitch
        inside = (x >= self.x_start) & (x <= self.x_end)
        return np.where(inside, self.function(np.clip(x, self.x_start, self.x_end)), 0.0)


@dataclass(frozen=True)
class MeshExcitation:
    """The one-sided springs of a gear pair.

    Parameters
    ----------
    stiffness : tuple of Periodic
        Stiffness of each slot [N/m], zero where the slot is empty.
    separation : tuple of Periodic
        Approach at which each slot touches [m]: modification of both teeth, positive for material removed.
    friction : tuple of pairs of Periodic, or empty
        For each slot, the friction torque on bodies a and b per unit tooth force [m].
    phase : float
        Phase at time zero [base pitches].
    first_slot : int
        The first slot's positions run from this many base pitches past the pitch point.
    slotted : bool
        Whether every tooth pair stands alone, so that it is a spring whether it bears or not.
    parting : bool
        Whether teeth part where their spring would pull; otherwise the gear pair is linear.
    back : BackFlanks, optional
        Of asymmetric teeth; other teeth are as stiff behind as in front.
    """

    stiffness: tuple[Periodic, ...]
    separation: tuple[Periodic, ...]
    friction: tuple[tuple[Periodic, Periodic], ...] = ()
    phase: float = 0.0
    first_slot: int = 0
    slotted: bool = False
    parting: bool = True
    back: BackFlanks | None = None

    def __post_init__(self) -> None:
        if not self.stiffness or len(self.stiffness) != len(self.separation):
            raise InputError("excitation", len(self.separation), f"must have {len(self.stiffness)} separations")
        if self.friction and len(self.friction) != len(self.stiffness):
            raise InputError("excitation.friction", len(self.friction), f"must have {len(self.stiffness)} entries")

    @classmethod
    def from_tooth_pair(
        cls,
        stiffness: Callable[[Array], Array],
        separation: Callable[[Array], Array],
        x_start: float,
        x_end: float,
        base_pitch: float,
        *,
        breaks: Iterable[float] = (),
        tolerance: float = 1e-11,
    ) -> MeshExcitation:
        """Build the slots from one tooth pair's stiffness [N/m] and separation [m] over its path of contact x [m].

        `breaks` are positions [m] where either has a kink or a jump.

        Raises
        ------
        RangeError
            If the path of contact is shorter than the base pitch.
        """
        if not x_end - x_start >= base_pitch * (1.0 - 1e-12):
            raise RangeError(
                "path of contact",
                f"{x_end - x_start:.6g} m",
                f"must be at least one base pitch {base_pitch:.6g} m: contact ratio below 1",
            )
        first, last = math.floor(x_start / base_pitch), math.ceil(x_end / base_pitch) - 1
        points = np.array([x_start, x_end, *breaks])
        slots: list[Periodic] = []
        gaps: list[Periodic] = []
        for j in range(first, last + 1):
            cuts = points / base_pitch - j

            inner = cuts[(cuts > 0.0) & (cuts < 1.0)]
            for f, into in ((stiffness, slots), (separation, gaps)):
                slot = _Slot(f, j, base_pitch, x_start, x_end)
                into.append(Periodic.fit(slot, inner, tolerance=tolerance))
        return cls(tuple(slots), tuple(gaps), first_slot=first, slotted=True)

    @classmethod
    def from_mesh(cls, stiffness: Periodic, error: Periodic | None = None) -> MeshExcitation:
        """One spring for the whole gear pair: mesh stiffness [N/m] and unloaded transmission error [m]."""
        return cls((stiffness,), (error if error is not None else Periodic.constant(0.0),))

    @classmethod
    def at_mean_load(
        cls, stiffness: Periodic, error: Periodic, load: float, shares: tuple[Periodic, ...] = ()
    ) -> MeshExcitation:
        """A gear pair as one spring that is linear about its mean load, from any load sharing.

        Parameters
        ----------
        stiffness : Periodic
            Local mesh stiffness dW/dzeta at the mean load [N/m].
        error : Periodic
            Static transmission error under the mean load [m].
        load : float
            The mean load [N]; contact is lost where the mesh force falls to zero.
        shares : tuple of Periodic
            For teeth without modifications that deflect in proportion to their load: the share of the load that each
            tooth pair in reach carries; they sum to one. Any other teeth need their own tangents, see `about_load`.
        """
        # Of perfect flanks that deflect in proportion to the load nothing is left but round-off.
        deflection = float(np.abs(error(np.linspace(0.0, 1.0, 33))).max())
        separation = combine((error, stiffness), lambda z, k: z - load / k, tolerance=1e-10, scale=deflection)
        if not shares:
            return cls((stiffness,), (separation,))
        parts = tuple(combine((share, stiffness), lambda q, k: q * k, tolerance=1e-10) for share in shares)
        return cls(parts, (separation,) * len(parts))

    @classmethod
    def about_load(
        cls, stiffness: tuple[Periodic, ...], separation: tuple[Periodic, ...], first_slot: int
    ) -> MeshExcitation:
        """Tooth pairs that share one load, each linear about its part of it, from any load sharing.

        A pair of load W_j and local stiffness K_Sj = dW_j/dzeta at the transmission error zeta is the spring K_Sj that
        comes to bear at zeta - W_j / K_Sj: it carries W_j at rest, and K_Sj times what the gears approach beyond.

        Parameters
        ----------
        stiffness : tuple of Periodic
            K_Sj of each tooth pair in reach [N/m]; zero where it carries nothing.
        separation : tuple of Periodic
            zeta - W_j / K_Sj [m]; any value where it carries nothing.
        first_slot : int
            The first pair's positions run from this many base pitches past the pitch point.
        """
        return cls(stiffness, separation, first_slot=first_slot)

    def never_parting(self, load: float) -> MeshExcitation:
        """The same gear pair linear about a mean load [N]: springs that bear under it stay, the others are not there.

        The stiffness still varies with the phase. Without load all teeth bear; springs about a load bear under it.
        """
        if not self.slotted or not load > 0.0:
            return replace(self, parting=False)
        parts = (*self.stiffness, *self.separation)
        pitches = math.lcm(*(part.pitches for part in parts))
        cuts = np.concatenate([*(part.breaks_over(pitches) for part in parts), self.contact_changes(load)])

        def bearing(j: int) -> Periodic:
            k, m = self.stiffness[j], self.separation[j]

            def stiffness(s: Array) -> Array:  # of one piece, which bears as a whole or not at all
                middle = float(np.mean(s)) * pitches
                return k(s * pitches) * float(self.approach(load, middle) > m(middle))

            return Periodic.fit(stiffness, np.unique(cuts) / pitches, pitches=pitches)

        return replace(self, stiffness=tuple(bearing(j) for j in range(len(self.stiffness))), parting=False)

    def widened(self, ratio: float) -> MeshExcitation:
        """Teeth so many times as wide, under a load so many times as large."""
        return replace(self, stiffness=tuple(k.scaled(ratio) for k in self.stiffness))

    def total_stiffness(self) -> Periodic:
        """Stiffness of all slots in contact together [N/m]."""
        return self._total

    @cached_property
    def _total(self) -> Periodic:
        """Fitted once: mean compliance and back flanks, speed after speed, ask for it."""
        return combine(self.stiffness, lambda *k: np.sum(k, axis=0))

    def mean_compliance(self) -> float:
        """Mean of one over the total stiffness [m/N] (Mark's C of a mesh)."""
        return combine((self.total_stiffness(),), lambda k: 1.0 / k).mean

    def approach(self, load: ArrayLike, phase: ArrayLike, *, one_sided: bool = True) -> Array:
        """Static transmission error [m] under a mesh force [N]; teeth may part unless `one_sided` is off."""
        s, w = np.broadcast_arrays(np.asarray(phase, dtype=float), np.asarray(load, dtype=float))
        k = np.array([f(s) for f in self.stiffness])
        m = np.array([f(s) for f in self.separation])
        if not one_sided:
            return (w + (k * m).sum(axis=0)) / k.sum(axis=0)
        m = np.where(k > 0.0, m, np.inf)
        order = np.argsort(m, axis=0)
        k, m = np.take_along_axis(k, order, axis=0), np.take_along_axis(m, order, axis=0)
        finite = np.isfinite(m)
        stiff = np.cumsum(np.where(finite, k, 0.0), axis=0)
        held = np.cumsum(np.where(finite, k * np.where(finite, m, 0.0), 0.0), axis=0)
        if np.any(stiff[0] <= 0.0):
            raise RangeError("excitation", 0.0, "is the mesh stiffness at some mesh position: no tooth carries load")
        level = (w + held) / stiff
        following = np.concatenate([m[1:], np.full((1, *s.shape), np.inf)])
        enough = np.argmax(level <= following, axis=0)
        found: Array = np.take_along_axis(level, enough[None], axis=0)[0]
        return found

    def place(self, slot: int, phase: ArrayLike) -> Array:
        """Position of the tooth pair in a slot [base pitches from the pitch point]."""
        s = np.asarray(phase, dtype=float)
        return np.asarray(s - np.floor(s) + self.first_slot + slot)

    def tooth_force(self, slot: int, phase: ArrayLike, approach: ArrayLike) -> Array:
        """Force on the tooth pair in a slot [N] where the gears approach by so much [m]; never a pull."""
        return np.maximum(self.stiffness[slot](phase) * (np.asarray(approach) - self.separation[slot](phase)), 0.0)

    def transmission_error(self, load: float, *, one_sided: bool = True, tolerance: float = 1e-11) -> Periodic:
        """Static transmission error [m] under a constant load [N] as a periodic function, kinks found."""
        parts = (*self.stiffness, *self.separation)
        pitches = math.lcm(*(part.pitches for part in parts))
        kinks = self.contact_changes(load) if one_sided else ()
        cuts = np.unique(np.concatenate([*(part.breaks_over(pitches) for part in parts), np.array([*kinks])]))
        return Periodic.fit(
            lambda s: self.approach(load, s * pitches, one_sided=one_sided),
            cuts / pitches,
            tolerance=tolerance,
            pitches=pitches,
            pointwise=True,
        )

    def contact_changes(self, load: float) -> list[float]:
        """Phases at which a tooth pair comes to bear or lets go between break points, under a static load [N]."""
        parts = (*self.stiffness, *self.separation)
        pitches = math.lcm(*(part.pitches for part in parts))
        cuts = np.unique(np.concatenate([part.breaks_over(pitches) for part in parts]))
        cuts = cuts[np.append(True, np.diff(cuts) > 1e-12)]
        share = np.linspace(0.0, 1.0, 34)[1:-1]
        share = np.concatenate([[1e-9], share, [1.0 - 1e-9]])
        samples = np.concatenate([a + (b - a) * share for a, b in pairwise(cuts)])
        piece = np.repeat(np.arange(cuts.size - 1), share.size)

        def nearness(s: Array) -> Array:
            """How far the gears have approached beyond each separation [m]; nothing to say of springs without any."""
            approach = self.approach(load, s)
            slots = zip(self.stiffness, self.separation, strict=True)
            return np.array([np.where(k(s) > 0.0, approach - m(s), -np.inf) for k, m in slots])

        return sign_changes(nearness, samples, piece, _PASSES).tolist()

    def linearised(self, load: float, *, one_sided: bool = True) -> tuple[float, Periodic]:
        """Mean compliance [m/N] and fluctuating static transmission error [m]: the train of Mark's (2.9b)."""
        compliance = self.mean_compliance()
        return compliance, self.transmission_error(load, one_sided=one_sided).plus(-compliance * load)


def effective_error(error: Periodic, harmonics: int = 12) -> float:
    """Effective error A_1 + sqrt(sum A_i^2) [m] of the first 12 mesh harmonics (0-peak) (TM-89901)."""
    amplitudes = 2.0 * np.abs(error.fourier(error.pitches * np.arange(1, harmonics + 1)))
    return float(amplitudes[0] + math.sqrt(float(np.sum(amplitudes**2))))
