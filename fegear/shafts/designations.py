"""What a designation says of a bearing: kind, bore d, outside diameter D, width B, contact angle.

Sources: boundary dimensions of ISO 15 (diameter series 0, 2 and 3 with the width series of each type), of ISO 355 with
its contact angles for tapered roller bearings. B is the width of the inner ring; designations of one dimension series
share d and D.

Checked row by row against the text of two catalogues. d, D, B: URB, General Catalogue 14/2017 (all of 60, 62, 63, 302,
303, 322, 323, NU, NJ and NUP; N 22, N 23 and bore number 03 of NU 23, which it does not list, share their dimension
series with those), NTN, Ball and Roller Bearings (60, 62, 63, NU). Contact angles: e = 1.5 tan(alpha) of every row, as
printed by NTN, lies within 0.005; the standard's text was not at hand, and other catalogues differ by up to 0.02 in e.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from difflib import get_close_matches

from fegear.base.errors import InputError
from fegear.shafts.printed_bearing import Kind

#: Outside diameters D for bore numbers 00 to 20 by diameter series [mm].
_OUTSIDE = {
    0: (26, 28, 32, 35, 42, 47, 55, 62, 68, 75, 80, 90, 95, 100, 110, 115, 125, 130, 140, 145, 150),
    2: (30, 32, 35, 40, 47, 52, 62, 72, 80, 85, 90, 100, 110, 120, 125, 130, 140, 150, 160, 170, 180),
    3: (35, 37, 42, 47, 52, 62, 72, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180, 190, 200, 215),
}
#: Widths B by dimension series (width and diameter series); 0 where the series has none [mm].
_WIDTHS = {
    "10": (8, 8, 9, 10, 12, 12, 13, 14, 15, 16, 16, 18, 18, 18, 20, 20, 22, 22, 24, 24, 24),
    "02": (9, 10, 11, 12, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 28, 30, 32, 34),
    "03": (11, 12, 13, 14, 15, 17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 37, 39, 41, 43, 45, 47),
    "22": (0, 0, 0, 16, 18, 18, 20, 23, 23, 23, 23, 25, 28, 31, 31, 31, 33, 36, 40, 43, 46),
    "23": (0, 0, 0, 19, 21, 24, 27, 31, 33, 36, 40, 43, 46, 48, 51, 55, 58, 60, 64, 67, 73),
}
#: First bore number of a series of rollers: below it none are listed.
_FIRST_ROLLER = 3


def _angle(degrees: int, minutes: int, seconds: int) -> float:
    return math.radians(degrees + minutes / 60.0 + seconds / 3600.0)


#: Contact angles of ISO 355 that tapered bearings of 02, 22, 03 and 23 have; three of 22 have their own.
_A1, _A2, _A3 = _angle(10, 45, 29), _angle(11, 18, 36), _angle(11, 51, 35)
_B1, _B2, _B3, _B4, _B5 = (
    _angle(12, 57, 10), _angle(14, 2, 10), _angle(15, 6, 34), _angle(15, 38, 32), _angle(16, 10, 20)
)  # fmt: skip
_SMALL_22 = (_angle(11, 45, 0), _angle(12, 28, 0), _angle(13, 30, 0))
#: For bore numbers 03 to 20.
_TAPERED_2 = (_B1, _B1, _B2, _B2, _B2, _B2, _B3, _B4, _B3, _B3, _B3, _B4, _B5, _B4, _B4, _B4, _B4, _B4)
_TAPERED_22 = (*_SMALL_22, *_TAPERED_2[3:])
_TAPERED_3 = (_A1, _A2, _A2, _A3, _A3, *(_B1,) * 13)

#: Dimensions that differ by less are one [m].
_SAME = 1e-6

#: Series by what stands before the bore number: kind, diameter series, dimension series.
_SERIES: dict[str, tuple[Kind, int, str]] = {
    "60": ("ball", 0, "10"),
    "62": ("ball", 2, "02"),
    "63": ("ball", 3, "03"),
    "302": ("tapered", 2, "02"),
    "303": ("tapered", 3, "03"),
    "322": ("tapered", 2, "22"),
    "323": ("tapered", 3, "23"),
    **{
        f"{letters}{series}": ("cylindrical", diameter, dimension)
        for letters in ("NU", "NJ", "NUP", "N")
        for series, diameter, dimension in (("2", 2, "02"), ("3", 3, "03"), ("22", 2, "22"), ("23", 3, "23"))
    },
}


@dataclass(frozen=True)
class Envelope:
    """Kind and boundary dimensions of a bearing.

    Parameters
    ----------
    kind : {"ball", "cylindrical", "tapered"}
    bore, outside_diameter, width : float
        d, D and B [m].
    contact_angle : float
        [rad].
    """

    kind: Kind
    bore: float
    outside_diameter: float
    width: float
    contact_angle: float = 0.0

    def has(self, bore: float, outside_diameter: float, width: float) -> bool:
        """Whether its dimensions are these [m]."""
        own = self.bore, self.outside_diameter, self.width
        return all(abs(a - b) < _SAME for a, b in zip(own, (bore, outside_diameter, width), strict=True))


def _bore(number: int) -> float:
    return (10.0, 12.0, 15.0, 17.0)[number] if number < 4 else 5.0 * number


def _known() -> dict[str, Envelope]:
    found = {}
    for series, (kind, diameter, dimension) in _SERIES.items():
        for number, outside in enumerate(_OUTSIDE[diameter]):
            width = _WIDTHS[dimension][number]
            if not width or (kind != "ball" and number < _FIRST_ROLLER):
                continue
            angles = _TAPERED_3 if diameter == 3 else _TAPERED_22 if dimension == "22" else _TAPERED_2
            angle = angles[number - _FIRST_ROLLER] if kind == "tapered" else 0.0
            found[f"{series}{number:02d}"] = Envelope(kind, _bore(number) * 1e-3, outside * 1e-3, width * 1e-3, angle)
    return found


#: All designations, without prefixes and suffixes.
KNOWN = _known()
#: Their series, in front of the two digits of the bore.
_NAMED = frozenset(one[:-2] for one in KNOWN)
#: Letters, digits, then what a maker adds (cage, seals, clearance), set off by a letter, dash, slash or space.
_FORM = re.compile(r"^(?:(?:SKF|FAG|INA|NSK|NTN|SNR|NACHI|KOYO|TIMKEN)\s+)?([A-Z]{0,3})\s?(\d{3,5})(?=$|[\s\-/.A-Z])")


def plain_designation(designation: str) -> str:
    """A designation as `KNOWN` has it, if it has: without maker, spaces and what a maker adds."""
    plain = designation.strip().upper()
    form = _FORM.match(plain)
    return f"{form[1]}{form[2]}" if form else plain


def designation_of(kind: Kind, bore: float, outside_diameter: float, width: float) -> str:
    """The first designation with this envelope; empty where none has it.

    Parameters
    ----------
    kind : {"ball", "cylindrical", "tapered"}
    bore, outside_diameter, width : float
        [m].
    """
    found = (name for name, one in KNOWN.items() if one.kind == kind and one.has(bore, outside_diameter, width))
    return next(found, "")


def envelope_of(designation: str) -> Envelope:
    """Kind and dimensions of a designation: ``6206``, ``6206-2Z/C3``, ``NU 210 ECP``, ``FAG 30206-A``.

    Raises
    ------
    InputError
        If it is none that is known.
    """
    name = plain_designation(designation)
    if name in KNOWN:
        return KNOWN[name]
    form = _FORM.match(designation.strip().upper())
    swapped = [one for one in KNOWN if sorted(one) == sorted(name)]
    other = form is not None and not swapped and name[:-2] not in _NAMED and re.fullmatch(r"[1-9][0-9]{3,4}", name)
    if other:
        raise InputError(
            "designation", f'"{designation}"', f"is of series {name[:-2]}, which is not in the table",
            "set catalogue with kind, bore, outside_diameter and width, and life.dynamic_rating with the C of the "
            "catalogue; tabulated are series 60, 62, 63, 302, 303, 322, 323 and N, NJ, NU, NUP 2, 3, 22, 23 up to bore "
            "number 20",
        )  # fmt: skip
    near = swapped or get_close_matches(name, KNOWN, 1)
    suggestion = f'did you mean "{near[0]}"? ' if near else ""
    raise InputError(
        "designation", f'"{designation}"', "is not a known designation",
        f"{suggestion}known are series 60, 62, 63, 302, 303, 322, 323 and N, NJ, NU, NUP 2, 3, 22, 23 up to bore "
        "number 20; for others set catalogue with kind, bore, outside_diameter and width",
    )  # fmt: skip
