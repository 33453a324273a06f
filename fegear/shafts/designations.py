"""What a designation says of a bearing: kind, bore d, outside diameter D, width B, contact angle.

Dimensions are those of `boundary_dimensions`. Letters behind an angular contact ball bearing are its contact angle: C
15, AC or A5 25, A 30, B 40 degrees; without any of them 40 degrees are taken.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from difflib import get_close_matches

from fegear.base.errors import InputError
from fegear.shafts.boundary_dimensions import ANGLE_OF_LETTER, SERIES
from fegear.shafts.printed_bearing import Kind
from fegear.shafts.printed_ratings import printed_rating

#: Dimensions [m] and contact angles [rad] that differ by less are one.
_SAME, _SAME_ANGLE = 1e-6, 1e-6


@dataclass(frozen=True)
class Envelope:
    """Kind and boundary dimensions of a bearing.

    Parameters
    ----------
    kind : {"ball", "cylindrical", "tapered", "spherical"}
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
    return {
        f"{name}{number:02d}": Envelope(series.kind, _bore(number) * 1e-3, outside, width, angle)
        for name, series in SERIES.items()
        for number, (outside, width, angle) in series.sizes().items()
    }


#: All designations, without prefixes and suffixes.
KNOWN = _known()
#: Their series as messages name them.
_TABULATED = (
    "60, 62, 63, 64, 160, 72, 73, 302, 303, 313, 320, 322, 323, 222, 223 and N, NJ, NU, NUP 2, 3, 22, 23 up to bore "
    "number 20"
)
#: Series that makers have and the table has not: no typos.
_OTHER_SERIES = frozenset(
    ("12", "13", "22", "23", "32", "33", "70", "618", "619", "213", "230", "231", "232", "240", "241", "329", "330",
     "331", "332")
)  # fmt: skip
#: Letters of contact angles behind the bore number of angular contact ball bearings, the longer ones first.
_ANGLE_LETTERS = re.compile(rf"^[\s-]?({'|'.join(sorted(ANGLE_OF_LETTER, key=len, reverse=True))})(?![0-9])")
#: Letters, digits, then what a maker adds (cage, seals, clearance), set off by a letter, dash, slash or space.
_FORM = re.compile(r"^(?:(?:SKF|FAG|INA|NSK|NTN|SNR|NACHI|KOYO|TIMKEN)\s+)?([A-Z]{0,3})\s?(\d{3,5})(?=$|[\s\-/.A-Z])")


def plain_designation(designation: str) -> str:
    """A designation as `KNOWN` has it, if it has: without maker, spaces and what a maker adds."""
    plain = designation.strip().upper()
    form = _FORM.match(plain)
    return f"{form[1]}{form[2]}" if form else plain


def designation_of(kind: Kind, bore: float, outside_diameter: float, width: float, contact_angle: float = 0.0) -> str:
    """The first designation with this envelope; empty where none has it.

    Parameters
    ----------
    kind : {"ball", "cylindrical", "tapered", "spherical"}
    bore, outside_diameter, width : float
        [m].
    contact_angle : float
        Of ball bearings, which is part of their designation [rad].
    """
    found = (
        name for name, one in KNOWN.items()
        if one.kind == kind and one.has(bore, outside_diameter, width)
        and (kind != "ball" or abs(one.contact_angle - abs(contact_angle)) < _SAME_ANGLE)
    )  # fmt: skip
    return next(found, "")


def envelope_of(designation: str) -> Envelope:
    """Kind and dimensions of a designation: ``6206``, ``6206-2Z/C3``, ``NU 210 ECP``, ``FAG 30206-A``.

    Raises
    ------
    InputError
        If it is none that is known.
    """
    name = plain_designation(designation)
    form = _FORM.match(designation.strip().upper())
    if name in KNOWN:
        return _at_angle(KNOWN[name], designation.strip().upper()[form.end() :] if form else "")
    swapped = [one for one in KNOWN if sorted(one) == sorted(name) and name[:-2] not in _OTHER_SERIES]
    other = form is not None and not swapped and name[:-2] not in SERIES and re.fullmatch(r"[1-9][0-9]{3,4}", name)
    if other:
        raise InputError(
            "designation", f'"{designation}"', f"is of series {name[:-2]}, which is not in the table",
            "set catalogue with kind, bore, outside_diameter and width, and life.dynamic_rating with the C of the "
            f"catalogue; tabulated are series {_TABULATED}",
        )  # fmt: skip
    near = swapped or get_close_matches(name, KNOWN, 1)
    suggestion = f'did you mean "{near[0]}"? ' if near else ""
    raise InputError(
        "designation", f'"{designation}"', "is not a known designation",
        f"{suggestion}known are series {_TABULATED}; for others set catalogue with kind, bore, outside_diameter and "
        "width",
    )  # fmt: skip


def catalogue_rating(designation: str) -> float | None:
    """C that one maker prints of a designation [N]; None where none is known.

    Parameters
    ----------
    designation : str
        One that is known.
    """
    name = plain_designation(designation)
    if envelope_of(designation).contact_angle != KNOWN[name].contact_angle:
        return None
    return printed_rating(name[:-2], int(name[-2:]))


def _at_angle(known: Envelope, added: str) -> Envelope:
    """A bearing with the contact angle that letters behind its number say, if it is one of balls with one."""
    letters = _ANGLE_LETTERS.match(added)
    if letters is None or known.kind != "ball" or not known.contact_angle:
        return known
    return replace(known, contact_angle=ANGLE_OF_LETTER[letters[1]])
