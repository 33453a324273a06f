"""Which gears one atlas is for, and the four numbers by which they differ: a family and a gear's place in it."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import RangeError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack
from fegear.geometry.thickness import ToothNumbers

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.geometry.gear import Plane

#: Proportions that differ by no more than this are the same: decimal numbers that were converted from other units.
_SAME = 1e-9


class Place(NamedTuple):
    """Where a gear lies in its family; lengths in modules.

    A thickness allowance is a profile shift under a tip circle that stays, so it needs no number of its own.
    """

    teeth: int
    #: Generating profile shift coefficient x_E.
    shift: float
    #: Height of the tip circle above the reference circle shifted by x_E.
    tip_height: float
    #: Radius at which the body is fixed over the root radius.
    bore: float


@dataclass(frozen=True)
class Family:
    """Spur gears cut by one rack, of materials with one Poisson's ratio, under one plane assumption.

    Parameters
    ----------
    dedendum, rounding : float
        h_fP and rho_fP of the rack [modules]. Its addendum is not needed: the tip circle is a gear's own.
    pressure_angle : float
        [rad].
    plane : {"strain", "stress"}
    poisson_ratio : float
    tip_rounding : float
        Radius of the rounding between flank and tip circle [modules].
    """

    dedendum: float = 1.25
    rounding: float = 0.38
    pressure_angle: float = math.radians(20.0)
    plane: Plane = "strain"
    poisson_ratio: float = 0.3
    tip_rounding: float = 0.0

    @classmethod
    def of(cls, gear: Gear) -> Family:
        """The family of a gear.

        Raises
        ------
        RangeError
            If it is of no family: internal, asymmetric, helical, with a protuberance, a chamfer, or a body on supports.
        """
        tooth = gear.tooth
        if gear.asymmetric:
            angle = f"{math.degrees(tooth.back.normal_pressure_angle):.6g} deg"
            raise RangeError("coast_pressure_angle", angle, "is not in an atlas (equal flanks only)", "solve the gear")
        if not isinstance(tooth, Tooth):
            raise RangeError("internal", "true", "is not in an atlas (external gears only)", "solve the gear")
        if gear.support is not None:
            raise RangeError(
                "rim_support", "given", "is not in an atlas (bodies fixed at their bore)", "solve the gear"
            )
        rack = tooth.rack
        for key, value in (
            ("helix_angle", tooth.helix_angle),
            ("rack.protuberance", rack.residual_undercut),
            ("tip_chamfer", tooth.tip_chamfer),
        ):
            if value != 0.0:
                raise RangeError(key, f"{value:.6g}", "must be 0 for gears of an atlas", "solve the gear")
        return cls(
            rack.dedendum, rack.tip_radius, rack.pressure_angle, gear.plane_assumption, gear.material.poisson_ratio,
            tooth.tip_rounding,
        )  # fmt: skip

    def check(self, gear: Gear) -> None:
        """Refuse gears of other families, by the first proportion that differs.

        Raises
        ------
        RangeError
        """
        other = Family.of(gear)
        for one in fields(self):
            mine, its = getattr(self, one.name), getattr(other, one.name)
            same = mine == its if isinstance(mine, str) else abs(mine - its) <= _SAME
            if not same:
                raise RangeError(
                    _KEYS[one.name], _written(one.name, its), f"must be {_written(one.name, mine)} in this atlas",
                    "solve the gear",
                )  # fmt: skip

    def has(self, gear: Gear) -> bool:
        """Whether a gear is of the family."""
        try:
            self.check(gear)
        except RangeError:
            return False
        return True

    def least_shift(self, teeth: float) -> float:
        """x_E from which on the rack cuts nothing off the involute: the undercut line."""
        return ToothNumbers(teeth, self.pressure_angle, 0.0).least_shift(self._rack)  # type: ignore[arg-type]

    def least_shift_of(self, teeth: Array) -> Array:
        """The same of numbers of teeth, shape (N,)."""
        rack, alpha = self._rack, self.pressure_angle
        reach = rack.tip_centre_depth + rack.tip_radius * math.sin(alpha)
        return np.asarray(reach - 0.5 * teeth * math.cos(alpha) * math.sin(alpha) * math.tan(alpha))

    def lowest_roll_length(self, teeth: Array, shift: Array) -> Array:
        """Roll length where the flank of a gear without undercut begins [modules], (N,)."""
        return np.asarray((shift - self.least_shift_of(teeth)) / math.sin(self.pressure_angle))

    def turning(self, places: Array) -> Array:
        """Deflection of all teeth by how the body turns as a ring up to the root circle, per unit load and 1/E, (N,).

        It grows with the inverse square of the bore, as nothing else does.
        """
        teeth, shift, _, ratio = places
        root, base = 0.5 * teeth + shift - self.dedendum, 0.5 * teeth * math.cos(self.pressure_angle)
        shear = (1.0 + self.poisson_ratio) / (2.0 * math.pi)
        return np.asarray(shear * (base / root) ** 2 * (1.0 / ratio**2 - 1.0))

    def gear(self, place: Place) -> Gear:
        """The gear of pure numbers at a place: module 1, Young's modulus 1.

        Raises
        ------
        GeometryError
            If there is no such gear.
        """
        radius = 0.5 * place.teeth + place.shift + place.tip_height
        tooth = Tooth(place.teeth, self._rack, place.shift, tip_radius=radius, tip_rounding=self.tip_rounding)
        material = Material(1.0, self.poisson_ratio, 1.0)
        return Gear(tooth, 1.0, place.bore * tooth.root_radius, material=material, plane=self.plane)

    @property
    def _rack(self) -> BasicRack:
        return BasicRack(1.0, self.dedendum, self.rounding, self.pressure_angle)


#: The keys of a gear behind the proportions.
_KEYS = {
    "dedendum": "rack.dedendum",
    "rounding": "rack.tip_radius",
    "pressure_angle": "pressure_angle",
    "plane": "plane",
    "poisson_ratio": "material.poisson_ratio",
    "tip_rounding": "tip_rounding",
}


def _written(name: str, value: float | str) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    return f"{math.degrees(value):.6g} deg" if name == "pressure_angle" else f"{value:.6g}"


def place_of(gear: Gear) -> Place:
    """Where a gear lies in its family."""
    tooth = gear.symmetric_tooth
    shift = tooth.generating_shift
    height = tooth.tip_radius - tooth.pitch_radius - shift
    return Place(tooth.teeth, shift, height, gear.bore_radius / gear.root_radius)
