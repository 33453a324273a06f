"""The next larger bearing of the table with a life: of the same bore in a heavier series, else of the same series.

C is that of ISO 281 for what is estimated to roll inside (`CatalogueBearing.estimated_rating`), X, Y and e are those of
the same inside: a life by a catalogue's C may be longer or shorter, by what `rating_error` says of C.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from fegear.shafts.axial_factors import AxialFactors
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN, plain_designation
from fegear.shafts.life import LifeRating


@dataclass(frozen=True, slots=True)
class LargerBearing:
    """A bearing to take in place of another one.

    Parameters
    ----------
    designation : str
    bore, outside_diameter : float
        [m].
    same_bore : bool
    revolutions : float
        Basic rating life under the forces of the present one.
    """

    designation: str
    bore: float
    outside_diameter: float
    same_bore: bool
    revolutions: float


@cache
def rating_of(designation: str) -> LifeRating:
    """What the life of a tabulated bearing follows from, by its dimensions alone.

    Parameters
    ----------
    designation : str
        A key of `KNOWN`.
    """
    one = KNOWN[designation]
    angle = one.contact_angle or None
    made = CatalogueBearing(one.kind, one.bore, one.outside_diameter, one.width, None, None, angle, 0.0)
    inside = made.inside
    factors = AxialFactors(inside.kind == "ball", inside.contact_angle, inside.count * inside.element_diameter**2)
    return LifeRating(made.estimated_rating, inside.kind, axial=factors)


def larger_bearing(designation: str, radial: float, axial: float, revolutions: float) -> LargerBearing | None:
    """The smallest one that lasts, of the same bore if one does; None where none of the table does.

    Parameters
    ----------
    designation : str
        Of the present one, with what a maker adds.
    radial, axial : float
        Forces on it [N].
    revolutions : float
        Life that is asked for.
    """
    name = plain_designation(designation)
    if name not in KNOWN:
        return None
    present, own = KNOWN[name], rating_of(name).dynamic_rating
    letters, series = name[:-2].rstrip("0123456789"), name[:-2]
    of_bore, of_series = [], []
    for other, one in KNOWN.items():
        rating = rating_of(other) if one.kind == present.kind and one.bore >= present.bore else None
        if rating is None or rating.dynamic_rating <= own or other[:-2].rstrip("0123456789") != letters:
            continue
        life = rating.revolutions(radial, axial)
        if life < revolutions:
            continue
        same = one.bore == present.bore
        found = LargerBearing(other, one.bore, one.outside_diameter, same, life)
        if same:
            of_bore.append((rating.dynamic_rating, other, found))
        elif other[:-2] == series:
            of_series.append((one.bore, other, found))
    best = min(of_bore or of_series, default=None, key=lambda each: each[:2])
    return None if best is None else best[2]
