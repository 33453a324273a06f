"""The grinding table: every modification of a flank that is to be ground, as a row, whatever result designs it.

A row has the numbers of its kind; the others are nan, an empty cell of the file, and no column where no row has any.
A result that designs further kinds makes `Grinding` rows of them, and a table of them by `grinding_table`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.shown import shown
from fegear.design.ground_digits import ANGLE_STEP, LENGTH_STEP, amount_step, to_step
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.geometry.pair import Member
from fegear.results.relief.answer_numbers import ground_microns

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.tip_relief.tip_tolerance import TipTolerance
    from fegear.engine.sheet.seen import Seen, Text, Where
    from fegear.results.relief.ground_tips import GroundTip

#: Kinds of modifications.
TIP, SLOPE, CROWNING, END, BIAS = "tip relief", "helix slope", "crowning", "end relief", "flank twist"
#: Beginnings of the names of the tables, which the pair follows: of designs of both gears' flanks, and of the lead of
#: one gear on its shafts, which leaves all other modifications as they are.
OF_FLANKS, OF_LEADS = "grinding_", "lead_grinding_"
#: Columns behind those of the amount and the start.
_FURTHER = (
    "end_diameter", "start_roll_angle", "length", "length_tolerance", "face_length", "amount_from", "amount_to",
    "start_diameter_from", "start_diameter_to",
)  # fmt: skip
#: An amount below this is nothing [m].
NOTHING = 5e-9
#: Amount over its tolerance below which grinding cannot be told from not grinding.
_FAINT = 0.25
#: Numbers of a row with the digits of amounts, and with those of diameters and lengths.
_AMOUNTS = ("amount", "amount_tolerance", "amount_from", "amount_to")
_LENGTHS = (
    "start_diameter", "end_diameter", "length", "length_tolerance", "face_length", "start_diameter_from",
    "start_diameter_to",
)  # fmt: skip


@dataclass(frozen=True)
class Grinding:
    """A modification of one flank as a grinder is given it; lengths in [m], angles in [rad]."""

    gear: str = shown("", "gear")
    member: Member = shown("", "driver or driven", name="member")
    design: str = shown("", "design that the row belongs to; rows of the best design first")
    modification: str = shown("", "kind of modification")
    shape: str = shown("", "shape from the start of the modification")
    amount: float = shown("um", "amount; of a helix slope the value at +b/2 minus that at -b/2", default=math.nan)
    amount_error: float = math.nan
    amount_tolerance: float = shown("um", "tolerance of the amount, to either side", default=math.nan)
    start_diameter: float = shown("mm", "diameter at the start of tip relief", default=math.nan)
    start_diameter_error: float = math.nan
    end_diameter: float = shown("mm", "diameter at which the amount applies", default=math.nan)
    start_roll_angle: float = shown("deg", "roll angle at the start of tip relief", default=math.nan)
    length: float = shown("mm", "length of the tip relief on the line of action", name="length_on_path",
                          default=math.nan)  # fmt: skip
    length_tolerance: float = shown("mm", "tolerance of this length, to either side", default=math.nan)
    face_length: float = shown("mm", "length over the face width, from each end of the face", default=math.nan)
    amount_from: float = shown("um", "lower end of the near-optimum range (within 1 % of the minimum)",
                               default=math.nan)  # fmt: skip
    amount_to: float = shown("um", "upper end of the near-optimum range", default=math.nan)
    start_diameter_from: float = shown("mm", "lower end of the near-optimum range", default=math.nan)
    start_diameter_to: float = shown("mm", "upper end of the near-optimum range", default=math.nan)

    @property
    def is_faint(self) -> bool:
        """Whether the amount is so far below its tolerance that grinding it cannot be told from not grinding."""
        return abs(self.amount) < _FAINT * self.amount_tolerance

    @property
    def words(self) -> str:
        """As a sentence says it; empty for nothing."""
        if abs(self.amount) <= NOTHING:
            return ""
        amount = f"{ground_microns(self.amount)} µm"
        if self.modification == TIP:
            return f"{amount} from d {self.start_diameter * 1e3:.1f} mm on gear {self.gear}"
        return f"{amount} {self.modification} on gear {self.gear}"


def rounded_rows(rows: Sequence[Grinding]) -> tuple[Grinding, ...]:
    """The rows with digits that can be ground: 0.1 µm, 0.001 mm and 0.01 deg.

    Of a design whose largest amount is below 1 µm amounts have two digits.
    """
    largest: dict[str, float] = {}
    for row in rows:
        largest[row.design] = max(largest.get(row.design, 0.0), abs(row.amount))
    return tuple(_rounded(row, amount_step(largest[row.design])) for row in rows)


def _rounded(row: Grinding, step: float) -> Grinding:
    steps = dict.fromkeys(_AMOUNTS, step) | dict.fromkeys(_LENGTHS, LENGTH_STEP) | {"start_roll_angle": ANGLE_STEP}
    numbers: dict[str, Any] = {name: to_step(getattr(row, name), one) for name, one in steps.items()}
    errors: dict[str, Any] = {
        name: float(f"{getattr(row, name):.2g}") for name in ("amount_error", "start_diameter_error")
    }
    return replace(row, **numbers, **errors)


def grinding_table(name: Text, title: Text, of: Where, each: Where | None = None) -> Rows:
    """A table of `Grinding` rows with digits that can be ground; none where there are no rows.

    Parameters
    ----------
    name, title : text
    of : where
        The rows.
    each : where, optional
        Objects that have such a table each: too many to be printed.
    """

    def rows(seen: Seen) -> tuple[Grinding, ...]:
        return rounded_rows(seen.find(of))

    return Rows(
        name, title,
        (
            "gear", "member", "design", "modification", "shape", "amount",
            Off("amount", lambda seen: _given(seen, rows, "amount_error")), _cell("amount_tolerance", rows),
            _cell("start_diameter", rows),
            Off("start_diameter", lambda seen: _given(seen, rows, "start_diameter_error")),
            *(_cell(quantity, rows) for quantity in _FURTHER),
        ),
        of=rows, each=each, when=rows, printed=each is None,
    )  # fmt: skip


def _cell(quantity: str, of: Where) -> Cell:
    return Cell(quantity, lambda seen: _given(seen, of, quantity))


def _given(seen: Seen, of: Where, quantity: str) -> Array | None:
    """A number of every row; None where no row has it: no column."""
    found = np.array([getattr(row, quantity) for row in seen.find(of)])
    return None if np.isnan(found).all() else found


def tip_row(tip: GroundTip, gear: str, tolerance: TipTolerance) -> Grinding:
    """The row of a tip relief that was searched for; the amount only where none is as good.

    Parameters
    ----------
    tip : GroundTip
    gear : str
        Name of the gear.
    tolerance : TipTolerance
    """
    relief, (low, high) = tip.relief, tip.band
    of_gear = tip.gear
    if relief.amount <= NOTHING and high.amount <= NOTHING:  # nothing to set a machine to, and nothing to measure
        return Grinding(gear, tip.member, f"{tip.shape} tip relief", TIP, tip.shape, 0.0)

    def diameter(roll: float) -> float:
        return 2.0 * tip.base_radius * math.hypot(1.0, roll)

    return Grinding(
        gear, tip.member, f"{tip.shape} tip relief", TIP, tip.shape, relief.amount, float(tip.error[0]),
        tolerance.amount, diameter(relief.start), 2.0 * tip.start_radius_error, diameter(relief.end), tip.start,
        tip.base_radius * (relief.end - relief.start), tolerance.length_of(of_gear, relief), math.nan,
        *((low.amount, high.amount, diameter(high.start), diameter(low.start)) if tip.has_band else ()),
    )  # fmt: skip
