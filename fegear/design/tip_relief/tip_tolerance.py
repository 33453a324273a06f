"""What a drawing allows the tip relief of a gear to be off, and the band of a profile chart that follows from it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.design.preferred import CLASS_STEP, FINEST
from fegear.formulas.iso1328 import rounded
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.relief import EndRelief

#: Length of a tip relief without a tolerance of its own may be off by this part of it.
OF_LENGTH = 0.1
#: The shortest relief that is left, over the one of the drawing.
SHORTEST_LEFT = 0.02
#: Amounts below this are none [m].
NOTHING = 1e-9
#: What is left of the tolerance that is tightened: two classes of ISO 1328.
HALVED = 0.5
TipNumber = Literal["amount", "length"]
#: Numbers over the face, each with a tolerance of its own; that of crowning is the one of end relief, too.
LeadNumber = Literal["crowning", "slope", "twist"]
#: Numbers of a tip relief in the order of `TipTolerance.off`.
TIP_NUMBERS: tuple[TipNumber, ...] = ("amount", "length")


def finer_tolerance(size: float, unrounded: float | None, classes: int) -> tuple[float, float | None]:
    """A tolerance so many classes finer, and the same unrounded [m].

    Each class of ISO 1328-1 is rounded from its own unrounded tolerance (5.2.3): half of a rounded one may differ.

    Parameters
    ----------
    size : float
        As a drawing has it [m].
    unrounded : float or None
        By its class [m]; None where it does not follow one, and is not rounded.
    classes : int
    """
    step = CLASS_STEP**-classes
    return (size * step, None) if unrounded is None else (rounded(unrounded * step), unrounded * step)


@dataclass(frozen=True)
class TipTolerance:
    """By how much the tip relief of a gear may be off, to either side.

    Parameters
    ----------
    amount : float
        [m].
    length : float or None
        Along the line of action [m]; None: a tenth of the length.
    form : float
        What the profile may deviate besides, to the side of more removal [m].
    origin : str
        Where the amount's tolerance comes from, for sentences: "f_Hα of class 5"; empty where the case gives it.
    grade : int or None
        Class of ISO 1328 that the amount's tolerance follows; None where it does not follow one.
    unrounded : float or None
        Tolerance of the amount by that class before it is rounded [m]; None where it does not follow one.
    """

    amount: float
    length: float | None
    form: float
    origin: str = field(default="", compare=False)
    grade: int | None = None
    unrounded: float | None = None

    @property
    def finest(self) -> int:
        """By how many classes the tolerance of the amount can be finer."""
        return FINEST if self.grade is None else max(self.grade - 1, 0)

    def finer(self, classes: int) -> TipTolerance:
        """The same with an amount that is so many classes finer; the length has no class."""
        grade = None if self.grade is None else self.grade - classes
        origin = "" if grade is None else f"f_Hα of class {grade}"
        amount, unrounded = finer_tolerance(self.amount, self.unrounded, classes)
        return replace(self, amount=amount, origin=origin, grade=grade, unrounded=unrounded)

    def halved(self, number: TipNumber, gear: Gear, tip: EndRelief) -> TipTolerance:
        """The same with half the tolerance of one number of a tip relief."""
        if number == "amount":
            return replace(self, amount=HALVED * self.amount)
        return replace(self, length=HALVED * self.length_of(gear, tip))

    def length_of(self, gear: Gear, tip: EndRelief) -> float:
        """By how much the length of a relief may be off [m]."""
        return OF_LENGTH * gear.base_radius * (tip.end - tip.start) if self.length is None else self.length

    def off(self, gear: Gear, tip: EndRelief, amount: int, length: int) -> EndRelief:
        """The relief with amount and length at an end of their tolerances: -1, 0 or 1 each."""
        whole = tip.end - tip.start
        longer = max(whole + length * self.length_of(gear, tip) / gear.base_radius, SHORTEST_LEFT * whole)
        start = tip.end - longer
        if (
            tip.end > 0.0
        ):  # not past the base circle; of ring gears, whose roll angles are negative, it lies beyond the tip
            start = max(start, 0.0)
        return replace(tip, amount=max(tip.amount + amount * self.amount, 0.0), start=start)

    def limits(self, gear: Gear, tip: EndRelief, roll: ArrayLike) -> tuple[Array, Array]:
        """Least and largest removal that a profile chart allows at roll angles [m].

        Without a relief the profile slope is off: straight over these roll angles, to either side at the tip.
        """
        at = np.asarray(roll, dtype=float)
        if tip.amount <= NOTHING:
            from_tip = np.abs(at - tip.end)
            slope = self.amount * (1.0 - from_tip / from_tip.max())
            return -slope, slope + self.form
        ends = [self.off(gear, tip, *off).removal(at) for off in product((-1, 1), repeat=2)]
        return np.min(ends, axis=0), np.max(ends, axis=0) + self.form


def profile_slopes(pair: GearPair, member: Member, size: float) -> tuple[EndRelief, EndRelief]:
    """A flank without relief whose profile slope is off, straight over the path of contact, to either side.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    size : float
        By how much over the path [m].
    """
    ends = (pair.x_start, pair.x_end) if member == "driver" else (pair.x_end, pair.x_start)
    root, tip = (float(pair.roll_angle(x, member)) for x in ends)
    return EndRelief(size, root, tip, 1.0), EndRelief(size, tip, root, 1.0)


@dataclass(frozen=True)
class Decisive:
    """The tolerance by which, once halved, the largest transmission error falls most.

    Parameters
    ----------
    member : {"driver", "driven"}
        Whose flank has the number.
    number : {"amount", "length", "profile_slope", "crowning", "slope", "twist"}
        The first two of the member's tip relief, the third of its flank without one.
    most : float
        Largest peak-to-peak transmission error with half of this tolerance and all others as they are [m].
    given : float
        The tolerance as it is [m].
    """

    member: Member
    number: TipNumber | Literal["profile_slope"] | LeadNumber
    most: float
    given: float
