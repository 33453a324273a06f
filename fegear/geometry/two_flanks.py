"""What teeth with two different flanks have in common, external and internal: two sides, and a thickness by both."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, Self, TypeVar

from fegear.geometry.involute_side import Flank, SideOfTooth

S = TypeVar("S", bound=SideOfTooth)
T = TypeVar("T", bound="TwoFlanks[Any]")


class TwoFlanks(ABC, Generic[S]):
    """A tooth with a flank for driving and another one for coasting, normal module 1.

    It is no `InvoluteTooth`: what holds for teeth with equal flanks only is not given it. `drive` and `coast` are the
    tooth seen from either flank.
    """

    teeth: int
    profile_shift: float
    thickness_allowance: float
    tip_radius: float
    tip_rounding: float
    tip_chamfer: float
    helix_angle: float

    @abstractmethod
    def angle(self, flank: Flank) -> float:
        """Pressure angle of a flank, in the normal section [rad]."""

    @abstractmethod
    def _seen_from(self, flank: Flank) -> S:
        """Make one of its sides."""

    @cached_property
    def drive(self) -> S:
        """The tooth seen from its drive flank."""
        return self._seen_from("drive")

    @cached_property
    def coast(self) -> S:
        """The tooth seen from its coast flank."""
        return self._seen_from("coast")

    def side(self, flank: Flank) -> S:
        """The tooth seen from a flank."""
        return self.drive if flank == "drive" else self.coast

    @property
    def _tangents(self) -> float:
        return math.tan(self.angle("drive")) + math.tan(self.angle("coast"))

    @property
    def generating_shift(self) -> float:
        """x_E, generating profile shift coefficient: the shift less what the thickness allowance takes."""
        return self.profile_shift - self.thickness_allowance / self._tangents

    @property
    def thickness(self) -> float:
        """Normal thickness on the reference circle [modules]: pi / 2 + x_E (tan alpha_drive + tan alpha_coast)."""
        return math.pi / 2 + self.generating_shift * self._tangents


@dataclass(frozen=True)
class OneOfTwoFlanks(SideOfTooth, Generic[T]):
    """Such a tooth seen from one of its flanks.

    Parameters
    ----------
    tooth : TwoFlanks
    flank : {"drive", "coast"}
    """

    tooth: T
    flank: Flank

    def __post_init__(self) -> None:
        """Take over what both sides have in common."""
        self.take_over(self.tooth)

    @property
    def back(self) -> Self:
        """The tooth seen from its other flank."""
        other: Self = self.tooth.side("coast" if self.flank == "drive" else "drive")
        return other

    @property
    def working_flank(self) -> Flank:
        """The flank that it is seen from."""
        return self.flank

    @property
    def generating_shift(self) -> float:
        """x_E, of both flanks."""
        return self.tooth.generating_shift

    @property
    def normal_pressure_angle(self) -> float:
        """alpha_n of this flank [rad]."""
        return self.tooth.angle(self.flank)

    @cached_property
    def tip_middle(self) -> float:
        """Angle from the centre line to the middle of the tip land [rad], toward this flank."""
        return 0.5 * (self.tip_half_angle - self.back.tip_half_angle)
