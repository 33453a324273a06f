"""The bearing to change to for a life: one that fits the seat and carries the axial force, the smallest that lasts.

On the present bore first, then on larger ones as far as the shoulder and the bodies around leave room; on each the same
kind in a heavier series, then a cylindrical roller bearing with ribs on both rings (NUP), then two tapered roller
bearings side by side. Bearings that float stay as they are (NU, N), tapered ones that are set against each other too.

C is the one that a maker prints (`printed_ratings`), else that of ISO 281 for what is estimated to roll inside
(`CatalogueBearing.estimated_rating`); X, Y and e are those of that inside: a life by the C of another maker may be
longer or shorter, by what `rating_error` says of C. Two tapered bearings side by side count as one of two rows (ISO
281:2007, Clauses 7 and 8): C of one times 2^(7/9). Face to face they hardly take moments of the bending shaft, which
that neglects; back to back they do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache

from fegear.shafts.axial_factors import MOST_ON_RIBS, AxialFactors, ribs_of
from fegear.shafts.bearing_seat import BearingSeat
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN, Envelope, catalogue_rating, envelope_of, plain_designation
from fegear.shafts.life import EXPONENT, LifeRating

#: C of two rows over that of one.
_TWO_ROWS = 2.0 ** (7.0 / 9.0)


@dataclass(frozen=True, slots=True)
class LargerBearing:
    """A bearing to take in place of another one.

    Parameters
    ----------
    designation : str
    bore, outside_diameter, width : float
        [m]; the width of both where there are two.
    same_bore : bool
    revolutions : float
        Basic rating life under the forces of the present one.
    count : int
        Two tapered bearings side by side, face to face, or one.
    """

    designation: str
    bore: float
    outside_diameter: float
    width: float
    same_bore: bool
    revolutions: float
    count: int = 1

    @property
    def said(self) -> str:
        """Its designation, with the number where there are two."""
        return self.designation if self.count == 1 else f"two {self.designation} face to face"


@dataclass(frozen=True, slots=True)
class BearingChange:
    """What the tables have for a life.

    Parameters
    ----------
    fitting : LargerBearing or None
        The first that lasts and fits.
    longest : LargerBearing or None
        Where none does, the one with the longest life of those that fit.
    thicker : LargerBearing or None
        Where none does, the first that lasts and has room, on a shaft that is thicker than its shoulder allows.
    """

    fitting: LargerBearing | None
    longest: LargerBearing | None = None
    thicker: LargerBearing | None = None


@cache
def rating_of(designation: str) -> LifeRating:
    """What the life of a tabulated bearing follows from: a printed C, else by its dimensions alone.

    Parameters
    ----------
    designation : str
        A key of `KNOWN`.
    """
    one = KNOWN[designation]
    angle = one.contact_angle or None
    made = CatalogueBearing(one.kind, one.bore, one.outside_diameter, one.width, None, None, angle, 0.0)
    inside = made.inside
    factors = AxialFactors(
        inside.kind == "ball", inside.contact_angle, inside.count * inside.element_diameter**2, ribs_of(designation),
        inside.rows,
    )  # fmt: skip
    return LifeRating(catalogue_rating(designation) or made.estimated_rating, inside.kind, axial=factors)


def larger_bearing(
    designation: str, radial: float, axial: float, revolutions: float, seat: BearingSeat
) -> BearingChange | None:
    """The smallest that lasts and fits, or what comes nearest; None of bearings that are not tabulated.

    Parameters
    ----------
    designation : str
        Of the present one, with what a maker adds.
    radial, axial : float
        Forces on it [N].
    revolutions : float
        Life that is asked for.
    seat : BearingSeat
    """
    name = plain_designation(designation)
    if name not in KNOWN or envelope_of(designation) != KNOWN[name]:  # of another contact angle
        return None
    present, least = KNOWN[name], rating_of(name).revolutions(radial, axial)
    longest: LargerBearing | None = None
    thicker: LargerBearing | None = None
    for bore in sorted({one.bore for one in KNOWN.values() if one.bore >= present.bore}):
        for kind in _kinds(name, radial, axial):
            found = [
                one for one in _of_kind(kind, bore, present.bore, radial, axial)
                if one.revolutions > least and seat.has_room(one.outside_diameter, one.width)
            ]  # fmt: skip
            lasting = min((one for one in found if one.revolutions >= revolutions), key=_size, default=None)
            if not seat.takes_bore(bore, present.bore):
                thicker = thicker or lasting
            elif lasting is not None:
                return BearingChange(lasting)
            else:
                longest = max((longest, *found), key=lambda one: one.revolutions if one else 0.0)
    return BearingChange(None, longest, thicker)


def _size(one: LargerBearing) -> tuple[float, float, str]:
    return one.outside_diameter, one.width, one.designation


def _kinds(name: str, radial: float, axial: float) -> Iterator[tuple[Callable[[str], bool], int]]:
    """Which designations carry what this one does, in order of preference, and how many side by side."""
    present, letters = KNOWN[name], _letters(name)

    def same_kind(other: str) -> bool:
        one = KNOWN[other]
        angular = present.kind == "ball" and bool(one.contact_angle) != bool(present.contact_angle)
        return one.kind == present.kind and _letters(other) == letters and not angular

    yield same_kind, 1
    if present.kind == "ball" and not present.contact_angle:  # locates its shaft in both directions
        if abs(axial) <= MOST_ON_RIBS * abs(radial):
            yield (lambda other: _letters(other) == "NUP"), 1
        yield (lambda other: KNOWN[other].kind == "tapered"), 2


def _letters(name: str) -> str:
    return name.rstrip("0123456789")


def _of_kind(
    kind: tuple[Callable[[str], bool], int], bore: float, present: float, radial: float, axial: float
) -> Iterator[LargerBearing]:
    """All of one kind with a bore, with their lives."""
    belongs, count = kind
    for name, one in KNOWN.items():
        if one.bore == bore and belongs(name):
            life = rating_of(name).revolutions(radial, axial) if count == 1 else _of_two(name, one, radial, axial)
            yield LargerBearing(name, bore, one.outside_diameter, count * one.width, bore == present, life, count)


def _of_two(name: str, one: Envelope, radial: float, axial: float) -> float:
    """L_10 in revolutions of two tapered bearings side by side; infinite without load."""
    load = AxialFactors(False, one.contact_angle, 0.0, rows=2).equivalent_load(abs(radial), abs(axial))
    rating = rating_of(name)
    return 1e6 * (_TWO_ROWS * rating.dynamic_rating / load) ** EXPONENT[rating.kind] if load > 0.0 else math.inf
