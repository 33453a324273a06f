"""Shafts of a drafted gearbox with bearings by designation, chosen for the forces of their meshes and a life.

Each shaft has a deep groove ball bearing that locates it, at the end with less radial force, and a cylindrical roller
bearing that lets it grow; where these would need a shaft thicker than a root circle, two tapered roller bearings
against each other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from fegear.shafts.axial_factors import AxialFactors
from fegear.shafts.bearing_seat import SHOULDER
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN, catalogue_rating
from fegear.shafts.life import LifeRating
from fegear.shafts.load_ratings import dynamic_rating

#: Life that bearings are chosen for, over the required one: the load over the face moves their forces.
_MORE = 1.25
_SERIES = {"ball": ("62", "63"), "roller": ("NU2", "NU3"), "tapered": ("302", "322", "303", "323")}
_FIRST, _LAST = 4, 20
#: Bore of a bearing over its number [m]; times that the life is halved where no bearing lasts as long.
_STEP, _HALVES = 5e-3, 24


@dataclass(frozen=True)
class ChosenBearing:
    """A bearing by its designation.

    Parameters
    ----------
    designation : str
        Empty for one of which only a stiffness is assumed.
    rating : LifeRating or None
        With the C that is printed, else estimated from its dimensions.
    bore, width, outside : float
        [m].
    """

    designation: str
    rating: LifeRating | None
    bore: float
    width: float
    outside: float


@dataclass(frozen=True)
class PlacedShaft:
    """One shaft with its bearings.

    Parameters
    ----------
    seat, thick : float
        Diameter below the bearings and between them [m].
    bearings : mapping of str to ChosenBearing
        From left to right by what they do: "locating" and "floating", or "left" and "right" against each other.
    lasts : bool
        Whether the bearings have the life that they are chosen for; else they are the best for this root circle.
    """

    seat: float
    thick: float
    bearings: Mapping[str, ChosenBearing]
    lasts: bool = True

    @property
    def tapered(self) -> bool:
        """Whether two tapered bearings locate it together."""
        return "left" in self.bearings


class _Forces(NamedTuple):
    """Radial forces at the left and at the right end, axial force [N], turns within the life, largest shaft [m]."""

    left: float
    right: float
    axial: float
    rolls: float
    most: float


def placed_shaft(
    seat: float, speed: float, root: float, meshes: Sequence[tuple[float, float, float, float, float, float]],
    span: float, life: float,
) -> PlacedShaft:  # fmt: skip
    """The smallest shaft and bearings that carry the forces of its meshes for a life [s] within the smallest root."""
    tangent, apart, moment, axial = [0.0, 0.0], [0.0, 0.0], 0.0, 0.0
    for at, tangential, radial, along, radius, side in meshes:
        # On shafts in a row both meshes of the middle one push it up, and from both sides; axial forces of one hand
        # are against each other, with moments that add.
        for end, share in enumerate((1.0 - at / span, at / span)):
            tangent[end] += share * tangential
            apart[end] += share * side * radial
        moment += along * radius / span
        axial += side * along
    left, right = (math.hypot(one, abs(other) + moment) for one, other in zip(tangent, apart, strict=True))
    rolls = _MORE * life * speed / (2.0 * math.pi)
    forces = _Forces(left, right, abs(axial), rolls, root)
    seat = min(seat, _STEP * _LAST, _STEP * math.floor(root / SHOULDER / _STEP))
    for halved in range(_HALVES):  # where none lasts as long, one that lasts half of it, and so on
        forces = forces._replace(rolls=rolls * 0.5**halved)
        found = _located(seat, forces) or _adjusted(seat, forces)
        if found is not None:
            return replace(found, lasts=not halved)
    return _assumed(forces)


def _assumed(forces: _Forces) -> PlacedShaft:
    """A shaft on bearings of an assumed stiffness: its pinion is too small for those that are tabulated."""
    seat = 0.8 * forces.most
    made = ChosenBearing("", None, seat, 0.4 * seat, 2.0 * seat)
    return PlacedShaft(seat, forces.most, {"locating": made, "floating": made})


def _located(seat: float, forces: _Forces) -> PlacedShaft | None:
    """A shaft with a ball bearing that locates it, where the radial force is less, and a roller bearing that floats."""
    floating_first = forces.left > forces.right
    located, floats = sorted((forces.left, forces.right))
    bore = seat
    while True:  # both have one bore
        locating = _bearing("ball", bore, located, forces.axial, forces)
        floating = _bearing("roller", bore, floats, 0.0, forces)
        if locating is None or floating is None:
            return None
        bore = max(locating.bore, floating.bore)
        if locating.bore == floating.bore:
            break
    both = {"locating": locating, "floating": floating}
    if floating_first:
        both = {"floating": floating, "locating": locating}
    return PlacedShaft(bore, _thick(bore, forces.most), both)


def _adjusted(seat: float, forces: _Forces) -> PlacedShaft | None:
    """A shaft between two equal tapered bearings, one of which has the axial force and what the other induces."""
    radial = max(forces.left, forces.right)
    found = _bearing("tapered", seat, radial, forces.axial, forces)
    if found is None:
        return None
    return PlacedShaft(found.bore, _thick(found.bore, forces.most), {"left": found, "right": found})


def _thick(bore: float, most: float) -> float:
    """Diameter of the shaft between its bearings: a shoulder, within the root circle."""
    return min(math.ceil(SHOULDER * bore * 1e3) * 1e-3, most)


def _bearing(kind: str, seat: float, radial: float, axial: float, forces: _Forces) -> ChosenBearing | None:
    """The smallest bearing on this or a larger seat with the life, and with a shoulder within the root circle."""
    for number in range(_FIRST, _LAST + 1):
        bore = _STEP * number
        if bore < seat - 1e-9 or SHOULDER * bore > forces.most:
            continue
        for series in _SERIES[kind]:
            found = _known(f"{series}{number:02d}")
            rating = found.rating
            if rating is None:
                continue
            # half of F_r/Y of the other bearing (ISO 281), which has no more radial force
            induced = 0.5 * radial / rating.axial.at(0.0)[1] if kind == "tapered" and rating.axial else 0.0
            if rating.revolutions(radial, axial + induced) >= forces.rolls:
                return found
    return None


def _known(designation: str) -> ChosenBearing:
    one = KNOWN[designation]
    angle = one.contact_angle or None
    inside = CatalogueBearing(one.kind, one.bore, one.outside_diameter, one.width, None, None, angle, 0.0).inside
    rated = catalogue_rating(designation) or dynamic_rating(inside)
    factors = AxialFactors(inside.kind == "ball", inside.contact_angle, inside.count * inside.element_diameter**2)
    life = LifeRating(rated, inside.kind, axial=factors)
    return ChosenBearing(designation, life, one.bore, one.width, one.outside_diameter)
