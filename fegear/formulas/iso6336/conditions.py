"""A pair to be rated by ISO 6336: all that its formulas ask for, and the table in which they leave their factors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fegear.formulas.iso6336.alignment import Alignment
from fegear.formulas.iso6336.pair_rating import Factor
from fegear.formulas.iso6336.part1_dynamic import running_in_relief

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.part2_contact import TipRelief
    from fegear.formulas.iso6336.rated import Both, Duty, Edition, Quality, Strength

#: What a remark says of a value that stands in for a formula's.
COMPUTED = "computed in place of the formula"


@dataclass(frozen=True, slots=True)
class Conditions:
    """A pair to be rated; pairs of things are those of pinion and wheel.

    Parameters
    ----------
    geometry : PairGeometry
    strength : (Strength, Strength)
    quality : (Quality, Quality)
    duty : Duty
    alignment : Alignment
    edition : {2019, 2006}
    dynamic_method : {"B", "C"}
        Of K_v.
    tip_relief : TipRelief, optional
        For f_ZCa of helical gears; by default "experience" where both tips are relieved by more than running in takes
        off them, else "none".
    tip_relief_factor : float, optional
        f_ZCa itself, where it is given.
    required : (float, float)
        S_Hmin and S_Fmin, by which sigma_HP and sigma_FP lie below sigma_HG and sigma_FG.
    spectrum_line : {"part-2", "annex-c"}
        S-N line of the flanks under a load spectrum.
    """

    geometry: PairGeometry
    strength: tuple[Strength, Strength]
    quality: tuple[Quality, Quality]
    duty: Duty
    alignment: Alignment = field(default_factory=Alignment)
    edition: Edition = 2019
    dynamic_method: Literal["B", "C"] = "B"
    tip_relief: TipRelief | None = None
    tip_relief_factor: float | None = None
    required: Both = (1.0, 1.0)
    spectrum_line: Literal["part-2", "annex-c"] = "part-2"

    @property
    def relieved(self) -> TipRelief:
        """How tips count as relieved."""
        if self.tip_relief is not None:
            return self.tip_relief
        worn = running_in_relief((self.strength[0].contact, self.strength[1].contact))
        return "experience" if all(q.tip_relief > worn for q in self.quality) else "none"


class FactorTable:
    """Factors in the order in which they are found."""

    def __init__(self) -> None:
        self.rows: list[Factor] = []

    def add(self, symbol: str, value: float | Both, clause: str, unit: str = "", remark: str = "") -> None:
        """Append a factor; one value stands for both gears."""
        values = value if isinstance(value, tuple) else (value, value)
        self.rows.append(Factor(symbol, values, unit, clause, remark))
