"""What a grinder can do to the flanks of a pair, in a few numbers: tip reliefs, crowning, end relief, slope, bias."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.shown import shown
from fegear.contact.wide.lines import ContactLines
from fegear.geometry.pair import MEMBERS, GearPair, Member

#: Of both gears' tip reliefs, or of each.
TipPower = float | tuple[float, float]


def powers_of(tip_power: TipPower) -> tuple[float, float]:
    """Of driver and driven gear."""
    return tip_power if isinstance(tip_power, tuple) else (tip_power, tip_power)


@dataclass(frozen=True, slots=True)
class GroundRelief:
    """Modification of both flanks together, the same along the face or along the profile but for the bias.

    Tip reliefs are straight lines, or parabolas where `tip_power` is 2, the driver's to the end of the path of contact
    and the driven gear's to its start. The crowning of the lead is a parabola, nothing in the middle of the face; the
    end relief grows as a straight line. Of the bias (twist of the flank) a quarter is taken from the driver's tip at
    +b/2 and from its root at -b/2, and left at the two other corners.
    """

    driver_tip: float = shown("um", "tip relief of the driver", default=0.0)
    driver_tip_length: float = shown("mm", "length of this relief along the line of action", default=0.0)
    driven_tip: float = shown("um", "tip relief of the driven gear", default=0.0)
    driven_tip_length: float = shown("mm", "length of this relief along the line of action", default=0.0)
    crowning: float = shown("um", "lead crowning, at both face ends", default=0.0)
    end_relief: float = shown("um", "end relief, at both face ends", default=0.0)
    end_relief_length: float = shown("mm", "length of the end relief along the face width", default=0.0)
    slope: float = shown("um", "helix slope modification, value at +b/2 minus value at -b/2", default=0.0)
    bias: float = shown("um", "flank twist of the driver: profile slope at +b/2 minus that at -b/2", default=0.0)
    tip_power: float = 1.0

    @property
    def numbers(self) -> Array:
        """All of them in the order of `NUMBERS`, shape (9,)."""
        return np.array([getattr(self, name) for name in NUMBERS])

    @classmethod
    def of(cls, numbers: Array, tip_power: float = 1.0) -> GroundRelief:
        """From numbers in the order of `NUMBERS`; a relief of no amount has no length."""
        given = dict(zip(NUMBERS, (float(v) for v in numbers), strict=True))
        for amount, length in LENGTHS.items():
            if given[amount] == 0.0:
                given[length] = 0.0
        return cls(**given, tip_power=tip_power)

    def removal(self, pair: GearPair, x: ArrayLike, z: ArrayLike) -> Array:
        """Removal at points of the plane of action, not negative on the flank [m]."""
        return np.asarray(FormsAt.over(pair, x, z, self.tip_power).removed(self.numbers) + self._base)

    def removal_on(self, pair: GearPair, lines: ContactLines) -> Array:
        """The same at the stations of contact lines, those along tip edges included, shape (P, M) [m]."""
        return np.asarray(FormsAt.on(pair, lines, self.tip_power).removed(self.numbers) + self._base)

    @property
    def _base(self) -> float:
        """What keeps slope and bias from being negative [m]."""
        return 0.5 * abs(self.slope) + 0.25 * abs(self.bias)


def lead_bearer(pair: GearPair) -> Member:
    """The gear that has the lead modifications of a pair: the first whose face is the common one, else the driver."""
    slack = 1e-9 * pair.face_width
    return next(
        (m for m in MEMBERS
         if abs(pair.gear(m).face_width - pair.face_width) <= slack and abs(pair.face_height(m)) <= slack),
        "driver",
    )  # fmt: skip


LENGTHS = {
    "driver_tip": "driver_tip_length", "driven_tip": "driven_tip_length", "end_relief": "end_relief_length",
}  # fmt: skip


@dataclass(frozen=True)
class FormsAt(ReadOnlyArrays):
    """Places of the plane of action, as the modifications count them; arrays of any one shape.

    Parameters
    ----------
    driver_depth, driven_depth : ndarray
        Distance along the path from where the driver's, and the driven gear's, tip leaves contact [m].
    end_depth : ndarray
        Distance from the nearer end of the face [m].
    across, along : ndarray
        -1 to 1 from the driver's root to its tip, and from one end of the face to the other.
    tip_power : float or tuple of float
        1 for straight tip reliefs, 2 for parabolas; one for each gear where they differ.
    """

    driver_depth: Array
    driven_depth: Array
    end_depth: Array
    across: Array
    along: Array
    tip_power: TipPower = 1.0

    @classmethod
    def over(cls, pair: GearPair, x: ArrayLike, z: ArrayLike, tip_power: TipPower = 1.0) -> FormsAt:
        """Places of a pair."""
        first, second = np.asarray(x, dtype=float), np.asarray(z, dtype=float)
        half = 0.5 * pair.face_width
        return cls(
            pair.x_end - first, first - pair.x_start, half - np.abs(second), _across(pair, first), second / half,
            tip_power,
        )  # fmt: skip

    @classmethod
    def on(cls, pair: GearPair, lines: ContactLines, tip_power: TipPower = 1.0) -> FormsAt:
        """Stations of contact lines; where these go on along tip edges, the points of both flanks that touch there."""
        found = cls.over(pair, lines.x, lines.z, tip_power)
        if lines.edges is None:
            return found
        driver, driven = (
            np.asarray(pair.flank_curvature_radius(tip, member) - lines.roll_length(pair, member))
            for member, tip in zip(MEMBERS, (pair.x_end, pair.x_start), strict=True)
        )
        bearer = lead_bearer(pair)  # its flank touches a mate's edge not at the station, but where the edge is
        across = _across(pair, pair.x_of_roll(lines.roll_angle(pair, bearer), bearer))
        return replace(found, driver_depth=driver, driven_depth=driven, across=across)

    def removed(self, numbers: Array) -> Array:
        """Removal by nine numbers, without the constant that keeps it from being negative, shape of the places [m]."""
        tip, tip_length, foot, foot_length, crowning, end, end_length, slope, bias = numbers.tolist()
        total = crowning * self.along**2 + 0.5 * slope * self.along + 0.25 * bias * self.across * self.along
        powers = powers_of(self.tip_power)
        ends = ((tip, tip_length, self.driver_depth, powers[0]), (foot, foot_length, self.driven_depth, powers[1]),
                (end, end_length, self.end_depth, 1.0))  # fmt: skip
        for amount, length, depth, of in ends:
            if amount != 0.0:
                total = total + amount * np.maximum(1.0 - depth / length, 0.0) ** of
        return np.asarray(total)

    def slopes(self, numbers: Array) -> Array:
        """Derivative by each of the nine numbers, shape (9, ...)."""
        found = np.zeros((len(NUMBERS), *self.across.shape))
        powers = powers_of(self.tip_power)
        ends = ((0, self.driver_depth, powers[0]), (2, self.driven_depth, powers[1]), (5, self.end_depth, 1.0))
        for i, depth, of in ends:
            amount, length = numbers[i], numbers[i + 1]
            if length > 0.0:
                share = np.maximum(1.0 - depth / length, 0.0)
                found[i] = share**of
                found[i + 1] = np.where(share > 0.0, amount * of * share ** (of - 1.0) * depth / length**2, 0.0)
        found[4], found[7], found[8] = self.along**2, 0.5 * self.along, 0.25 * self.across * self.along
        return found


def _across(pair: GearPair, x: Array) -> Array:
    """Places on the line of action [m] as -1 at the start of the path to 1 at its end."""
    return np.asarray(2.0 * (x - 0.5 * (pair.x_start + pair.x_end)) / pair.path_length)


#: The nine numbers, and the amounts that go with a length.
NUMBERS: tuple[str, ...] = tuple(f.name for f in fields(GroundRelief) if f.name != "tip_power")
