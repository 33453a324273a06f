"""Allowable stress numbers of steel gears (ANSI/AGMA 2101-D04, clause 16), by treatment, grade and hardness.

Source: ANSI/AGMA 2101-D04, tables 3 (contact), 4 and 6 (bending), figures 8 to 11; the metric numbers of the tables.
Public texts that repeat them were at hand for the lines of through-hardened steel, the cores of 4140 and nitralloy and
the flanks of all cases (table 3 of 2001-D04, engineersedge.com, AGMA Allowable Contact Stress); the roots of carburized
and induction-hardened teeth and the lines of 2.5 % chrome steel are recalled: `RECALLED_ROOTS`.
They are for ten million cycles, one direction of load and a reliability of 99 %. For gears that are loaded both ways
(idlers, planets) the standard takes 70 % of the bending number: `reversed_bending`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fegear.errors import RangeError

if TYPE_CHECKING:
    from collections.abc import Collection

Grade = Literal[1, 2, 3]
Treatment = Literal[
    "through-hardened", "carburized", "induction-hardened", "nitrided-4140", "nitrided-nitralloy", "nitrided-chrome"
]


#: Treatments whose sigma_FP no public text at hand repeats.
RECALLED_ROOTS = frozenset({"carburized", "induction-hardened", "nitrided-chrome"})


@dataclass(frozen=True, slots=True)
class _Line:
    """slope x HB + start [MPa] between two hardnesses of the core or the through-hardened gear."""

    slope: float
    start: float
    softest: float
    hardest: float


#: sigma_HP and sigma_FP of through-hardened steel by grade [MPa], HB of the gear (figures 8 and 9).
_THROUGH: dict[int, tuple[_Line, _Line]] = {
    1: (_Line(2.22, 200.0, 180.0, 400.0), _Line(0.533, 88.3, 180.0, 400.0)),
    2: (_Line(2.41, 237.0, 180.0, 400.0), _Line(0.703, 113.0, 180.0, 400.0)),
}
#: sigma_HP, sigma_FP [MPa] of carburized and of flame or induction hardened cases (tables 3, 4: 54 HRC, pattern A).
_CASE: dict[str, dict[int, tuple[float, float]]] = {
    "carburized": {1: (1240.0, 380.0), 2: (1550.0, 450.0), 3: (1895.0, 515.0)},
    "induction-hardened": {1: (1205.0, 310.0), 2: (1345.0, 380.0)},
}
#: sigma_HP [MPa] of the nitrided case and the line of sigma_FP over the core's hardness (table 3; figures 10 and 11).
_NITRIDED: dict[str, dict[int, tuple[float, _Line]]] = {
    "nitrided-4140": {
        1: (1070.0, _Line(0.568, 83.8, 270.0, 350.0)),
        2: (1160.0, _Line(0.749, 110.0, 270.0, 350.0)),
    },
    "nitrided-nitralloy": {
        1: (1170.0, _Line(0.594, 87.76, 250.0, 350.0)),
        2: (1260.0, _Line(0.784, 114.81, 250.0, 350.0)),
    },
    "nitrided-chrome": {
        1: (1070.0, _Line(0.7255, 63.89, 290.0, 350.0)),
        2: (1185.0, _Line(0.7255, 153.63, 290.0, 350.0)),
        3: (1305.0, _Line(0.7255, 201.91, 290.0, 350.0)),
    },
}


@dataclass(frozen=True, slots=True)
class AllowableStress:
    """Allowable stress numbers of a gear.

    Parameters
    ----------
    contact, bending : float
        sigma_HP, sigma_FP [Pa].
    brinell : float
        Of the flank of a through-hardened gear, of the core of a case-hardened one; for Z_W and the cycle curves.
    treatment : str
        "given" where the numbers are the user's own.
    """

    contact: float
    bending: float
    brinell: float
    treatment: Treatment | Literal["given"] = "given"

    def __post_init__(self) -> None:
        """Refuse numbers that are no strengths."""
        for name, value in (("sigma_HP", self.contact), ("sigma_FP", self.bending), ("hardness", self.brinell)):
            if not value > 0.0:
                raise RangeError(name, value, "must be positive")

    @property
    def reversed_bending(self) -> AllowableStress:
        """The same of a gear that is loaded both ways: 70 % of sigma_FP (clause 16)."""
        return AllowableStress(self.contact, 0.7 * self.bending, self.brinell, self.treatment)


def _on_line(line: _Line, brinell: float, what: str) -> float:
    if not line.softest <= brinell <= line.hardest:
        rule = f"must be {line.softest:g} to {line.hardest:g} HB for {what} (ANSI/AGMA 2101-D04, 16)"
        raise RangeError("hardness", f"{brinell:g} HB", rule, "give sigma_HP and sigma_FP yourself")
    return (line.slope * brinell + line.start) * 1e6


def allowable_stress(treatment: Treatment, grade: Grade, brinell: float) -> AllowableStress:
    """Look up sigma_HP and sigma_FP (ANSI/AGMA 2101-D04, clause 16).

    Parameters
    ----------
    treatment : str
        "through-hardened", "carburized" (and hardened, 55 to 64 HRC), "induction-hardened" (or flame, 54 HRC, pattern A
        with hardened roots), "nitrided-4140" (also 4340), "nitrided-nitralloy", "nitrided-chrome" (2.5 % chrome).
    grade : {1, 2, 3}
    brinell : float
        HB: of the gear where through-hardened, else of the core.

    Raises
    ------
    RangeError
        If the standard has no such grade or hardness.
    """
    grades: dict[str, Collection[int]] = {"through-hardened": _THROUGH, **_CASE, **_NITRIDED}
    if treatment not in grades:
        raise RangeError("treatment", treatment, f"must be one of {', '.join(grades)}")
    if grade not in grades[treatment]:
        raise RangeError("grade", grade, f"has no allowable bending stress number for {treatment} steel in AGMA 2101")
    if treatment == "through-hardened":
        contact, bending = (_on_line(line, brinell, treatment) for line in _THROUGH[grade])
    elif treatment in _CASE:
        contact, bending = (1e6 * number for number in _CASE[treatment][grade])
    else:
        number, line = _NITRIDED[treatment][grade]
        contact, bending = 1e6 * number, _on_line(line, brinell, f"the core of {treatment} steel")
    return AllowableStress(contact, bending, brinell, treatment)
