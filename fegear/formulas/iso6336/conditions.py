"""A pair to be rated by ISO 6336: all that its formulas ask for, and the table in which they leave their factors.

What a rating by ISO 6336 says: safety factors of pinion and wheel with every factor on the way, and stand-ins.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fegear.base.errors import RangeError
from fegear.formulas.iso6336.part1_dynamic import running_in_relief
from fegear.formulas.iso6336.part1_face_load import Alignment
from fegear.formulas.symbols import ISO_6336

if TYPE_CHECKING:
    from fegear.base.shown import Shown
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.part2_pitting import TipRelief
    from fegear.formulas.iso6336.rated import Both, Duty, Edition, Quality, Strength
    from fegear.geometry.pair import Member


#: What a remark says of a value that stands in for a formula's.
COMPUTED = "FE value instead of the formula"


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

    def add(self, symbol: str, value: float | Both, clause: str, remark: str = "") -> None:
        """Append a factor; one value stands for both gears."""
        values = value if isinstance(value, tuple) else (value, value)
        self.rows.append(Factor(ISO_6336[symbol], values, clause, remark))


@dataclass(frozen=True, slots=True)
class Replacement:
    """Values computed by other means, used instead of those of the formulas; None leaves a formula in place.

    Parameters
    ----------
    K_v, K_Hbeta, K_Halpha : float, optional
    K_Fbeta, K_Falpha : (float, float), optional
    root_factor : (float, float), optional
        sigma_F0 b m_n / F_t of each gear: stands for Y_F Y_S Y_beta Y_B Y_DT together.
    """

    K_v: float | None = None
    K_Hbeta: float | None = None
    K_Halpha: float | None = None
    K_Fbeta: Both | None = None
    K_Falpha: Both | None = None
    root_factor: Both | None = None


@dataclass(frozen=True, slots=True)
class Factor:
    """One number on the way to a safety factor.

    Parameters
    ----------
    shown : Shown
        Its symbol as the standard writes it, ASCII: "K_Hbeta", "Z_NT"; unit and meaning (`fegear.formulas.symbols`).
    values : (float, float)
        Of pinion and wheel in SI; equal where the pair has one.
    clause : str
        Where the standard gives it: part, edition, clause and, where it is known, the equation's number.
    remark : str
        What lies outside the stated range, or that the value was computed by other means; empty otherwise.
    """

    shown: Shown
    values: Both
    clause: str
    remark: str = ""

    @property
    def symbol(self) -> str:
        """As the standard writes it, ASCII."""
        return self.shown.name

    @property
    def value(self) -> float:
        """The value of the pair, or the pinion's."""
        return self.values[0]


@dataclass(frozen=True, slots=True)
class PairRating:
    """A rating with every intermediate factor; pairs of values are those of pinion and wheel.

    Parameters
    ----------
    factors : tuple of Factor
        In the order in which the standard computes them.
    members : (Member, Member)
        Which of driver and driven is the pinion, which the wheel.
    contact_stress, contact_permissible, contact_safety : (float, float)
        sigma_H, sigma_HG (sigma_HP at a required safety of 1) [Pa], S_H.
    bending_stress, bending_permissible, bending_safety : (float, float)
        sigma_F, sigma_FG (sigma_FP at a required safety of 1) [Pa], S_F.
    """

    factors: tuple[Factor, ...]
    members: tuple[Member, Member]
    contact_stress: Both
    contact_permissible: Both
    contact_safety: Both
    bending_stress: Both
    bending_permissible: Both
    bending_safety: Both

    def __post_init__(self) -> None:
        """Refuse stresses and safety factors that no pair has, such as those of a length with the wrong sign."""
        for name in (
            "contact_stress", "contact_permissible", "contact_safety", "bending_stress", "bending_permissible",
            "bending_safety",
        ):  # fmt: skip
            if not all(value > 0.0 for value in getattr(self, name)):
                raise RangeError(name, getattr(self, name), "must be positive")

    def __getitem__(self, symbol: str) -> Factor:
        """Return a factor by its symbol; KeyError if there is none."""
        for factor in self.factors:
            if factor.symbol == symbol:
                return factor
        raise KeyError(symbol)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the factors remark, each once."""
        return tuple(dict.fromkeys(f.remark for f in self.factors if f.remark))
