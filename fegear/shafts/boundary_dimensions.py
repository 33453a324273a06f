"""Boundary dimensions of rolling bearings by series: ISO 15 and ISO 355, with contact angles.

D follows from the bore number and the diameter series, B from the dimension series (width and diameter series). B is
the width of the inner ring; designations of one dimension series share d and D.

Checked row by row against the text of catalogues. d, D, B: URB, General Catalogue 14/2017, NTN, Ball and Roller
Bearings, SKF, General Catalogue (60, 62, 63, 64, 160, 72, 73, 222, 223) and NSK, Rolling Bearings (313, 320, 222, 223).
Contact angles of tapered bearings are those of ISO 355, whose text was not at hand: e = 1.5 tan(alpha) of every row, as
printed by NTN and NSK, lies within 0.005. Those of spherical bearings, which no standard has, follow from the e that
NSK prints for each; SKF prints up to 0.03 more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.shafts.printed_bearing import Kind

#: First bore number and outside diameters D from there on by diameter series [mm].
OUTSIDE = {
    0: (0, (26, 28, 32, 35, 42, 47, 55, 62, 68, 75, 80, 90, 95, 100, 110, 115, 125, 130, 140, 145, 150)),
    2: (0, (30, 32, 35, 40, 47, 52, 62, 72, 80, 85, 90, 100, 110, 120, 125, 130, 140, 150, 160, 170, 180)),
    3: (0, (35, 37, 42, 47, 52, 62, 72, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180, 190, 200, 215)),
    4: (3, (62, 72, 80, 90, 100, 110, 120, 130, 140, 150, 160, 180, 190, 200, 210, 225)),
}
#: First bore number and widths B from there on by dimension series [mm].
WIDTHS = {
    "00": (2, (8, 8, 8, 8, 9, 9, 9, 10, 10, 11, 11, 11, 13, 13, 14, 14, 16, 16, 16)),
    "10": (0, (8, 8, 9, 10, 12, 12, 13, 14, 15, 16, 16, 18, 18, 18, 20, 20, 22, 22, 24, 24, 24)),
    "20": (4, (15, 15, 17, 18, 19, 20, 20, 23, 23, 23, 25, 25, 29, 29, 32, 32, 32)),
    "02": (0, (9, 10, 11, 12, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 28, 30, 32, 34)),
    "03": (0, (11, 12, 13, 14, 15, 17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 37, 39, 41, 43, 45, 47)),
    "13": (5, (17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 37, 39, 41, 43, 45, 51)),
    "22": (3, (16, 18, 18, 20, 23, 23, 23, 23, 25, 28, 31, 31, 31, 33, 36, 40, 43, 46)),
    "23": (3, (19, 21, 24, 27, 31, 33, 36, 40, 43, 46, 48, 51, 55, 58, 60, 64, 67, 73)),
    "04": (3, (17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 37, 42, 45, 48, 52, 54)),
}


def _angle(degrees: int, minutes: int = 0, seconds: int = 0) -> float:
    return math.radians(degrees + minutes / 60.0 + seconds / 3600.0)


def _of_limits(*limits: float) -> tuple[float, ...]:
    """Contact angles of spherical bearings by e = 1.5 tan(alpha) (ISO 281)."""
    return tuple(math.atan(e / 1.5) for e in limits)


#: Contact angles of ISO 355 that tapered bearings of 02, 22, 03, 13 and 23 have; three of 22 have their own.
_A1, _A2, _A3 = _angle(10, 45, 29), _angle(11, 18, 36), _angle(11, 51, 35)
_B1, _B2, _B3, _B4, _B5 = (
    _angle(12, 57, 10), _angle(14, 2, 10), _angle(15, 6, 34), _angle(15, 38, 32), _angle(16, 10, 20)
)  # fmt: skip
_STEEP = _angle(28, 48, 39)
#: For bore numbers 03 to 20.
_TAPERED_2 = (_B1, _B1, _B2, _B2, _B2, _B2, _B3, _B4, _B3, _B3, _B3, _B4, _B5, _B4, _B4, _B4, _B4, _B4)
_TAPERED_22 = (_angle(11, 45), _angle(12, 28), _angle(13, 30), *_TAPERED_2[3:])
_TAPERED_3 = (_A1, _A2, _A2, _A3, _A3, *(_B1,) * 13)
#: Of 320 for bore numbers 04 to 20.
_TAPERED_20 = (
    _angle(14), _angle(16), _angle(16), _angle(16, 50), _angle(14, 10), _angle(14, 40), _angle(15, 45), _angle(15, 10),
    _angle(16), _angle(17), _angle(16, 10), _angle(17), _angle(15, 45), _angle(16, 25), _angle(15, 45), _angle(16, 25),
    _angle(17),
)  # fmt: skip
#: Of 222 from bore number 05, of 223 from 08 on.
_SPHERICAL_22 = _of_limits(
    0.35, 0.33, 0.32, 0.28, 0.25, 0.24, 0.23, 0.23, 0.24, 0.23, 0.22, 0.22, 0.22, 0.24, 0.24, 0.24
)  # fmt: skip
_SPHERICAL_23 = _of_limits(0.35, 0.34, 0.35, 0.34, 0.34, 0.33, 0.33, 0.33, 0.33, 0.33, 0.33, 0.33, 0.33)


@dataclass(frozen=True, slots=True)
class Series:
    """Bearings of one type and dimension series.

    Parameters
    ----------
    kind : {"ball", "cylindrical", "tapered", "spherical"}
    dimension : str
        Dimension series, a key of `WIDTHS`; its last digit is the diameter series.
    first : int
        First bore number.
    angles : tuple of float
        Contact angles from the first bore number on, or one of all [rad].
    """

    kind: Kind
    dimension: str
    first: int = 0
    angles: tuple[float, ...] = (0.0,)

    def sizes(self) -> dict[int, tuple[float, float, float]]:
        """D and B [m] and the contact angle [rad] by bore number."""
        (first_outside, outside), (first_width, widths) = OUTSIDE[int(self.dimension[1])], WIDTHS[self.dimension]
        return {
            number: (
                outside[number - first_outside] * 1e-3, widths[number - first_width] * 1e-3,
                self.angles[number - self.first if len(self.angles) > 1 else 0],
            )
            for number in range(max(self.first, first_outside, first_width), first_width + len(widths))
        }  # fmt: skip


#: Contact angles that letters behind an angular contact ball bearing of 72 or 73 stand for [rad].
ANGLE_OF_LETTER = {"AC": _angle(25), "A5": _angle(25), "A": _angle(30), "B": _angle(40), "C": _angle(15)}
#: Series by what stands before the two digits of the bore number.
SERIES: dict[str, Series] = {
    "60": Series("ball", "10"),
    "62": Series("ball", "02"),
    "63": Series("ball", "03"),
    "64": Series("ball", "04", 3),
    "160": Series("ball", "00", 2),
    "72": Series("ball", "02", 0, (ANGLE_OF_LETTER["B"],)),
    "73": Series("ball", "03", 0, (ANGLE_OF_LETTER["B"],)),
    "302": Series("tapered", "02", 3, _TAPERED_2),
    "303": Series("tapered", "03", 3, _TAPERED_3),
    "313": Series("tapered", "13", 5, (_STEEP,)),
    "320": Series("tapered", "20", 4, _TAPERED_20),
    "322": Series("tapered", "22", 3, _TAPERED_22),
    "323": Series("tapered", "23", 3, _TAPERED_3),
    "222": Series("spherical", "22", 5, _SPHERICAL_22),
    "223": Series("spherical", "23", 8, _SPHERICAL_23),
    **{
        f"{letters}{series}": Series("cylindrical", dimension, 3)
        for letters in ("NU", "NJ", "NUP", "N")
        for series, dimension in (("2", "02"), ("3", "03"), ("22", "22"), ("23", "23"))
    },
}
