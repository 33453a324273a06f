"""What a drawing says of the reliefs of a gear's flanks: amounts and places, which become curves in a pair.

Ends that are not given follow from the path of contact, so that a relief is made for one gear of a pair.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.given import given
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.plausible_flanks import refuse_deep_relief, refuse_relief_elsewhere
from fegear.geometry.relief import (
    CombinedRelief,
    Crowning,
    EndRelief,
    Relief,
    Shape,
    TabulatedRelief,
    crowning,
    normalised_tip_relief,
    roll_of_radius,
    root_relief,
    tip_relief,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.geometry.flank_modification import Bias
    from fegear.geometry.gear import Gear


@dataclass(frozen=True, kw_only=True)
class EndReliefSpec:
    """Relief toward one end of the profile; its amount in one of two ways, its start in one of four."""

    amount: float | None = given("length", "Amount of relief (C_a); alternatively `amount_over_delta`.", default=None)
    amount_over_delta: float | None = given(
        meaning="Amount in units of Welbourn's Delta (deflection at the driver's HPSTC plus twice the maximum "
        "pitch deviation).",
        default=None,
    )
    start_roll_angle: float | None = given(
        "angle", "Start of relief as roll angle; specify exactly one of the four start keys.", default=None
    )
    start_radius: float | None = given(
        "length", "Start of relief as radius; specify exactly one of the four start keys.", default=None, above=0.0
    )
    length: float | None = given(
        "length", "Length of the relief along the line of action; specify exactly one of the four start keys.",
        default=None, above=0.0,
    )  # fmt: skip
    #: Of tip reliefs only.
    normalised_length: float | None = given(
        meaning="Normalised length L_n of the tip relief (TM-89901): 1 from the tip to the HPSTC.",
        default=None, above=0.0,
    )  # fmt: skip
    shape: Shape = given(meaning="Shape of the relief from its start: linear or parabolic.", default="linear")

    def removed(self, delta: float) -> float:
        """Amount, Welbourn's Delta given [m]."""
        return self.amount if self.amount is not None else (self.amount_over_delta or 0.0) * delta


@dataclass(frozen=True, kw_only=True)
class TipReliefSpec(EndReliefSpec):
    """Tip relief."""

    at_radius: float | None = given(
        "length", "Radius at which the amount applies. Default: end of the involute (tip form circle).",
        default=None, above=0.0,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class RootReliefSpec(EndReliefSpec):
    """Root relief."""

    end_radius: float | None = given(
        "length", "Radius at which the amount applies. Default: start of active profile.", default=None, above=0.0
    )


@dataclass(frozen=True)
class CrowningSpec:
    """Profile crowning: removal at both ends, which are those of the active profile by default."""

    amount: float = given("length", "Amount of profile crowning C_alpha at both ends of the crowned profile.")
    start_radius: float | None = given(
        "length", "Lower end of the crowned profile. Default: start of active profile.", default=None, above=0.0
    )
    end_radius: float | None = given(
        "length", "Upper end of the crowned profile. Default: end of active profile.", default=None, above=0.0
    )


@dataclass(frozen=True)
class BiasSpec:
    """Twist of a flank between two radii, by default those of the active profile."""

    amount: float = given(
        "length", "Flank twist S_alpha; positive removes material at the tip at end II and at the root at end I (a "
        "quarter of it at each corner).",
    )  # fmt: skip
    start_radius: float | None = given(
        "length", "Lower end of the twisted profile. Default: start of active profile.", default=None, above=0.0
    )
    end_radius: float | None = given(
        "length", "Upper end of the twisted profile. Default: end of active profile.", default=None, above=0.0
    )

    def built(self, pair: GearPair, member: Member) -> Bias:
        """The twist of one gear of a pair.

        Raises
        ------
        InputError
            If its ends do not ascend.
        """
        from fegear.geometry.flank_modification import Bias

        gear = pair.gear(member)
        ends = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
        for i, radius in enumerate((self.start_radius, self.end_radius)):
            if radius is not None:
                if radius < gear.base_radius:
                    raise InputError("bias", f"radius {radius * 1e3:.6g} mm", "lies inside the base circle")
                ends[i] = float(roll_of_radius(gear, np.array(radius)))
        start, end = ends
        if not end > start:
            raise InputError("bias", "start_radius and end_radius", "must ascend")
        return Bias(self.amount, start, end, gear.face_width)


@dataclass(frozen=True)
class ReliefSpec:
    """Profile modification of every tooth of a gear; all parts add up.

    Parameters
    ----------
    tip, root, crowning : tuple
    tables : tuple of TabulatedRelief
    """

    tip: tuple[TipReliefSpec, ...] = ()
    root: tuple[RootReliefSpec, ...] = ()
    crowning: tuple[CrowningSpec, ...] = ()
    tables: tuple[TabulatedRelief, ...] = ()

    @property
    def wants_delta(self) -> bool:
        """Whether an amount is given in Welbourn's Delta."""
        return any(end.amount_over_delta is not None for end in (*self.tip, *self.root))

    def built(self, pair: GearPair, member: Member, delta: float = math.nan) -> Relief:
        """The modification of one gear of a pair.

        Parameters
        ----------
        pair : GearPair
        member : {"driver", "driven"}
        delta : float
            Welbourn's Delta [m], the unit of amount_over_delta.

        Raises
        ------
        InputError
            If it lies elsewhere than the active profile, or takes more than the tooth has.
        """
        first, last = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))

        def normalised(tip: TipReliefSpec, amount: float) -> EndRelief:
            return normalised_tip_relief(pair, member, amount, tip.normalised_length or math.nan, tip.shape)

        return self.over(pair.gear(member), _active_ends(pair, member), (first, last), normalised, delta)

    def over(
        self,
        gear: Gear,
        radii: tuple[float, float],
        rolls: tuple[float, float],
        normalised: Callable[[TipReliefSpec, float], EndRelief],
        delta: float = math.nan,
    ) -> Relief:
        """The modification of a gear with a given active profile.

        Parameters
        ----------
        gear : Gear
        radii, rolls : (float, float)
            Of the ends of the active profile [m], that toward the root first, and their roll angles, rising [rad].
        normalised : callable
            Tip relief of a normalised length, by its spec and its amount.
        delta : float
            Welbourn's Delta [m].

        Raises
        ------
        InputError
            As `built`.
        """
        low, high = radii
        found: list[EndRelief | Crowning] = []
        for tip in self.tip:
            amount = tip.removed(delta)
            if tip.normalised_length is not None:
                found.append(normalised(tip, amount))
                continue
            found.append(
                tip_relief(
                    gear, amount, start_roll=tip.start_roll_angle, start_radius=tip.start_radius, length=tip.length,
                    shape=tip.shape, at_radius=tip.at_radius,
                )
            )  # fmt: skip
        found += [
            root_relief(
                gear, root.removed(delta), end_radius=root.end_radius or low, start_roll=root.start_roll_angle,
                start_radius=root.start_radius, length=root.length, shape=root.shape,
            )
            for root in self.root
        ]  # fmt: skip
        found += [
            crowning(gear, crown.amount, crown.start_radius or low, crown.end_radius or high) for crown in self.crowning
        ]
        whole = CombinedRelief((*found, *self.tables))
        for part in (*found, *self.tables):
            refuse_relief_elsewhere(part, *rolls)
        refuse_deep_relief(gear, whole, *rolls)
        return whole


def _active_ends(pair: GearPair, member: Member) -> tuple[float, float]:
    """Radii of the active profile's ends [m], that toward the root first."""
    a, b = sorted(float(r) for r in pair.radius(np.array([pair.x_start, pair.x_end]), member))
    return (b, a) if pair.gear(member).tooth.internal else (a, b)
