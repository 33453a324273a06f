"""Tooth thickness allowances and tolerances of DIN 3967:1978, tables 1 and 2, by designations such as cd25.

The numbers are those of a transcription of the standard that anyone can read; its own example (27cd at d = 100 mm: -70
and -170 um) comes out, and every series rises from row to row.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from typing import NamedTuple

from fegear.base.errors import InputError

#: Series of allowances, from the largest; of tolerances, from the smallest.
_ALLOWANCES = ("a", "ab", "b", "bc", "c", "cd", "d", "e", "f", "g", "h")
_TOLERANCES = range(21, 31)
#: Upper ends of the rows, reference diameter [mm].
_UP_TO = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10000)
#: Table 1: upper allowance A_sne with the other sign [um].
_UPPER = (
    (100, 85, 70, 58, 48, 40, 33, 22, 10, 5, 0),
    (135, 110, 95, 75, 65, 54, 44, 30, 14, 7, 0),
    (180, 150, 125, 105, 85, 70, 60, 40, 19, 9, 0),
    (250, 200, 170, 140, 115, 95, 80, 56, 26, 12, 0),
    (330, 280, 230, 190, 155, 130, 110, 75, 35, 17, 0),
    (450, 370, 310, 260, 210, 175, 145, 100, 48, 22, 0),
    (600, 500, 420, 340, 290, 240, 200, 135, 64, 30, 0),
    (820, 680, 560, 460, 390, 320, 270, 180, 85, 41, 0),
    (1100, 920, 760, 620, 520, 430, 360, 250, 115, 56, 0),
    (1500, 1250, 1020, 840, 700, 580, 480, 330, 155, 75, 0),
    (2000, 1650, 1350, 1150, 940, 780, 640, 450, 210, 100, 0),
)
#: Table 2: tolerance T_sn [um].
_TOLERANCE = (
    (3, 5, 8, 12, 20, 30, 50, 80, 130, 200),
    (5, 8, 12, 20, 30, 50, 80, 130, 200, 300),
    (6, 10, 16, 25, 40, 60, 100, 160, 250, 400),
    (8, 12, 20, 30, 50, 80, 130, 200, 300, 500),
    (10, 16, 25, 40, 60, 100, 160, 250, 400, 600),
    (12, 20, 30, 50, 80, 130, 200, 300, 500, 800),
    (16, 25, 40, 60, 100, 160, 250, 400, 600, 1000),
    (20, 30, 50, 80, 130, 200, 300, 500, 800, 1300),
    (25, 40, 60, 100, 160, 250, 400, 600, 1000, 1600),
    (30, 50, 80, 130, 200, 300, 500, 800, 1300, 2000),
    (40, 60, 100, 160, 250, 400, 600, 1000, 1600, 2400),
)


class ThicknessLimits(NamedTuple):
    """Reductions of the normal tooth thickness [m], positive.

    Attributes
    ----------
    upper : float
        -A_sne, of the thickest permitted tooth.
    tolerance : float
        T_sn.
    """

    upper: float
    tolerance: float

    @property
    def mean(self) -> float:
        """Reduction of the tooth in the middle of its tolerance."""
        return self.upper + 0.5 * self.tolerance


def thickness_limits(designation: str, reference_diameter: float) -> ThicknessLimits:
    """Allowance and tolerance of a gear.

    Parameters
    ----------
    designation : str
        A series of allowances and one of tolerances: cd25, 25cd, DIN 3967 cd 25.
    reference_diameter : float
        d [m].

    Raises
    ------
    InputError
        If the diameter is beyond the tables.
    """
    millimetres = round(reference_diameter * 1e3, 9)
    if not millimetres <= _UP_TO[-1]:
        raise InputError(
            "thickness_allowance", f'"{designation}"',
            f"is defined up to a reference diameter of {_UP_TO[-1]:g} mm (DIN 3967)", "give the allowance as a length",
        )  # fmt: skip
    row = bisect_left(_UP_TO, millimetres)
    text = designation.removeprefix("DIN").replace("3967", "")
    letters, digits = re.findall(r"[a-h]+", text)[0], re.findall(r"\d+", text)[0]
    return ThicknessLimits(
        _UPPER[row][_ALLOWANCES.index(letters)] * 1e-6, _TOLERANCE[row][_TOLERANCES.index(int(digits))] * 1e-6
    )
