"""Bearings from what catalogues print: the envelope d, D, B and the ratings C_0 and C give an estimate of the inside.

The elements run on the mean of bore and outside diameter. How many fit follows from the filling: balls are put in
between eccentric rings, where their centres span some 187 degrees; rollers take some 0.83 of the pitch circle, tapered
ones 0.88. Their diameter is a share of the section (D - d)/2, their length a share of B. C_0 of ISO 76 replaces the
diameter of balls or the length of rollers, so that the inside has exactly that rating. A maker's C holds a factor b_m
of steel and finish: with C_0, b_m is what is left of ISO 281; without, C replaces what C_0 would, with an assumed b_m
(not of tapered bearings, where it says less than the envelope).

The error is that of the radial stiffness K without clearance, K ~ (Z c cos(alpha)^(n+1))^(1/n) for elements Q = c
delta^n: each assumed share is moved to the ends of its range; 1.5 times the root of the sum of squares of the larger
changes covers 99 of 100 bearings whose shares are spread evenly over their ranges.

Shares of cylindrical bearings follow the raceway diameters F_w and E_w, C_0 and C that NTN prints for NU 2, 22, 3, 23
up to a bore of 45 mm (32 bearings of two designs); those above 45 mm, and ball bearings by C_0 and f_0 of the same
catalogue, try the estimate: see the tests. Shares of angular contact, tapered and spherical bearings were set by C and
C_0 that SKF and NSK print. Grooves are printed nowhere; what rolls in tapered and spherical bearings was not found.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Literal

from fegear.base.errors import RangeError
from fegear.base.printed import percent
from fegear.shafts.load_ratings import RATING_FACTOR, dynamic_rating, rating_factor, static_rating
from fegear.shafts.printed_bearing import Kind, PrintedBearing
from fegear.shafts.rolling_bearing import RollingBearing


@dataclass(frozen=True)
class Shares:
    """What is assumed of the inside of a bearing, each relative to its envelope.

    Parameters
    ----------
    filling : float
        Of balls the angle that their centres span when put in [rad]; of rollers their share of the pitch circle.
    thickness : float
        Diameter of an element over the section (D - d)/2.
    length : float
        Length of a roller over the width of the inner ring along the roller.
    grooves : float
        Change of both groove radii from 0.52 and 0.53 of the ball's diameter.
    rating_factor : float
        b_m over that of ISO 281, where C is known and C_0 is not.
    angle : float
        Change of an assumed contact angle [rad].
    """

    filling: float
    thickness: float
    length: float
    grooves: float = 0.0
    rating_factor: float = 1.0
    angle: float = 0.0


#: What is assumed, and how far it may be off to either side: bearings of many makers lie within. Balls with a contact
#: angle are filled from the side, as rollers are.
_ASSUMED: dict[Kind | Literal["angular", "steep"], tuple[Shares, Shares]] = {
    "ball": (Shares(math.radians(187.0), 0.605, 0.0, 0.0, 1.05), Shares(math.radians(12.0), 0.05, 0.0, 0.007, 0.15)),
    "angular": (Shares(0.93, 0.62, 0.0, 0.0, 1.05), Shares(0.07, 0.05, 0.0, 0.007, 0.15)),
    "cylindrical": (Shares(0.83, 0.52, 0.55, 0.0, 1.15), Shares(0.07, 0.05, 0.16, 0.0, 0.15)),
    "tapered": (
        Shares(0.88, 0.45, 0.67, rating_factor=1.15),
        Shares(0.07, 0.1, 0.13, rating_factor=0.0, angle=math.radians(3.0)),
    ),
    "steep": (
        Shares(0.88, 0.45, 0.55, rating_factor=1.05),
        Shares(0.07, 0.1, 0.1, rating_factor=0.0, angle=math.radians(3.0)),
    ),
    "spherical": (
        Shares(0.86, 0.53, 0.38, rating_factor=1.05),
        Shares(0.07, 0.06, 0.06, rating_factor=0.0, angle=math.radians(2.0)),
    ),
}
#: How far C may be off that follows from the envelope, or that another maker prints: bearings of four makers lie within
#: (see the tests).
#: Cylindrical ones have two designs of one designation, with rollers of two sizes.
_RATING_ERROR: dict[Kind, float] = {"ball": 0.19, "cylindrical": 0.34, "tapered": 0.26, "spherical": 0.27}
#: A rating belongs to another bearing where it is off by more than this share of that error, up or down.
_BEYOND = 1.5
#: Contact angle of tapered and spherical bearings of which none is given [rad].
_ROLLER_ANGLE = {"tapered": math.radians(14.0), "spherical": math.radians(10.5)}
#: Contact angle of tapered bearings above which their rollers are shorter (313) [rad].
_STEEP = math.radians(20.0)
#: Widths that the section of balls counts at most: in narrow bearings (160) these are smaller.
_NARROW = 1.16
#: Elements are no smaller and no larger than these shares of the section, rollers no shorter and no longer than these
#: of the width: beyond, rings would have no thickness, or rating and envelope are of two bearings.
_THICKNESS, _LENGTH, _LENGTH_OF_TWO = (0.3, 0.85), (0.3, 1.0), (0.15, 0.5)
#: Error over the root of the sum of squares of the changes.
_COVERING = 1.5
#: b_m over that of ISO 281 within which C and C_0 can belong to one bearing.
_FACTORS = (0.6, 1.8)


@dataclass(frozen=True)
class CatalogueBearing(PrintedBearing):
    """A bearing of one row as a catalogue prints it, with what is estimated of its inside.

    Raises
    ------
    RangeError
        If the dimensions leave no bearing, or a rating does not belong to them.
    """

    @property
    def said(self) -> str:
        """What is assumed of its inside, and the error of the stiffness that comes of it."""
        made, rollers = self.inside, self.kind != "ball"
        size = f"{made.element_diameter * 1e3:.3g} mm" + (f" x {made.roller_length * 1e3:.3g} mm" if rollers else "")
        whence = {"static_rating": "C_0 and the envelope", "dynamic_rating": "C and the envelope", None: "the envelope"}
        angle = f" at {math.degrees(made.contact_angle):.3g} deg" if made.contact_angle else ""
        number = f"{'two rows of ' if made.aligning else ''}{made.count} {'rollers' if rollers else 'balls'}"
        return (
            f"{number} of {size} on {self._pitch * 1e3:.4g} mm{angle} assumed, "
            f"estimated from {whence[self._rating]}; error of its radial stiffness {percent(self.error)}, "
            f"at a clearance of {self.clearance * 1e6:.3g} um"
        )

    @property
    def estimated_rating(self) -> float:
        """C that makers print for such an inside: that of ISO 281 with what b_m is more than its value [N]."""
        made = self.inside
        return dynamic_rating(made, self._assumed[0].rating_factor * rating_factor(made))

    @property
    def rating_error(self) -> float:
        """Relative error of the estimated C."""
        return _RATING_ERROR[self.kind]

    def misfits(self, **given: float | None) -> tuple[tuple[str, float, float], ...]:
        """Ratings that other bearings than one of this envelope have.

        Parameters
        ----------
        **given : float, optional
            C or C_0 [N] by ``dynamic_rating``, ``static_rating``.

        Returns
        -------
        tuple of (str, float, float)
            Name of each rating that does not fit, the given value and the estimated one [N].
        """
        bare = replace(self, dynamic_rating=None, static_rating=None)
        typical = {"dynamic_rating": bare.estimated_rating, "static_rating": static_rating(bare.inside)}
        most = 1.0 + _BEYOND * self.rating_error
        return tuple(
            (key, one, typical[key])
            for key, one in given.items()
            if one is not None and not 1.0 / most <= one / typical[key] <= most
        )

    @property
    def _rating(self) -> Literal["static_rating", "dynamic_rating"] | None:
        """The rating that the inside is made to have."""
        if self.static_rating is not None:
            return "static_rating"
        return "dynamic_rating" if self.dynamic_rating is not None and self.kind not in _ROLLER_ANGLE else None

    @property
    def _section(self) -> float:
        return 0.5 * (self.outside_diameter - self.bore)

    @property
    def _pitch(self) -> float:
        return 0.5 * (self.outside_diameter + self.bore)

    @property
    def given_angle(self) -> float:
        """Contact angle, assumed for tapered and spherical bearings without one [rad]."""
        return _ROLLER_ANGLE.get(self.kind, 0.0) if self.contact_angle is None else self.contact_angle

    @property
    def _assumed(self) -> tuple[Shares, Shares]:
        """What is assumed of its inside, and how far that may be off."""
        if self.kind == "ball" and self.given_angle:
            return _ASSUMED["angular"]
        if self.kind == "tapered" and abs(self.given_angle) > _STEEP:
            return _ASSUMED["steep"]
        return _ASSUMED[self.kind]

    def _thickness(self, shares: Shares) -> float:
        """Diameter of an element by its share of the section, which counts no more than a multiple of the width [m]."""
        most = _NARROW * self.width if self.kind == "ball" else math.inf
        return shares.thickness * min(self._section, most)

    @cached_property
    def inside(self) -> RollingBearing:
        """What rolls in it, estimated.

        Raises
        ------
        RangeError
            If a rating is not possible within the envelope.
        """
        return _inside(self)

    def estimated(self) -> RollingBearing:
        """The inside, estimated anew."""
        made = self._with(self._assumed[0])
        self._refuse(made)
        return made

    @cached_property
    def error(self) -> float:
        """Estimated relative error of the radial stiffness at a load, without clearance."""
        assumed, ranges = self._assumed
        nominal = _stiffness(self.inside)
        squares = 0.0
        for name, width in vars(ranges).items():
            if name == "filling" or not width or (name == "angle" and self.contact_angle is not None):
                continue
            moved = (
                replace(assumed, **{name: getattr(assumed, name) + way * width}) for way in (-1.0, 1.0)
            )  # the count stays: its own range follows
            squares += max(abs(_stiffness(self._with(one, self.inside.count)) / nominal - 1.0) for one in moved) ** 2
        few = max(1, round(ranges.filling / assumed.filling * self.inside.count))
        counts = [n for n in (self.inside.count - few, self.inside.count + few) if n >= 3]
        squares += max(abs(_stiffness(self._with(assumed, n)) / nominal - 1.0) for n in counts) ** 2
        return _COVERING * math.sqrt(squares)

    @cached_property
    def rating_factor(self) -> float | None:
        """b_m with which the inside has the dynamic rating given; None without one."""
        if self.dynamic_rating is None:
            return None
        return self.dynamic_rating / dynamic_rating(self.inside, 1.0)

    def _with(self, shares: Shares, count: int | None = None) -> RollingBearing:
        """The inside with these shares, and so many elements; as many as fit without a number."""
        if count is None:
            # As many as the diameter leaves room for, which the rating makes of their number: settles at once or swings
            # by one, where the smaller number stays.
            count, found = 0, self._with(shares, self._fitting(shares, self._thickness(shares)))
            for _ in range(8):
                fits = self._fitting(shares, found.element_diameter)
                if fits == found.count or found.count == count:
                    break
                count, found = found.count, self._with(shares, fits)
            return found
        return self._ball(shares, count) if self.kind == "ball" else self._roller(shares, count)

    def _fitting(self, shares: Shares, diameter: float) -> int:
        half = math.asin(min(diameter / self._pitch, 0.9))
        eccentric = self.kind == "ball" and not self.given_angle
        room = 1.0 + 0.5 * shares.filling / half if eccentric else shares.filling * math.pi / half
        return max(3, round(room))

    def _ball(self, shares: Shares, count: int) -> RollingBearing:
        def made(diameter: float) -> RollingBearing:
            grooves = 0.52 + shares.grooves, 0.53 + shares.grooves
            return RollingBearing(
                "ball", count, diameter, self._pitch, self.given_angle + shares.angle, grooves, 0.0, self.clearance
            )

        most = 0.999 * self._pitch * math.sin(math.pi / count)
        if self.static_rating is not None:
            return made(_solved(lambda d: static_rating(made(d)), self.static_rating, most))
        if self.dynamic_rating is not None:
            factor = shares.rating_factor * RATING_FACTOR["ball"]
            return made(_solved(lambda d: dynamic_rating(made(d), factor), self.dynamic_rating, most))
        return made(min(self._thickness(shares), most))

    def _roller(self, shares: Shares, count: int) -> RollingBearing:
        angle = self.given_angle + shares.angle
        diameter = min(shares.thickness * self._section, 0.999 * self._pitch * math.sin(math.pi / count))
        whole = self.width / math.cos(angle)
        unit = RollingBearing(
            "roller", count, diameter, self._pitch, angle, roller_length=whole, clearance=self.clearance,
            aligning=self.kind == "spherical",
        )  # fmt: skip
        share = shares.length
        if self.static_rating is not None:
            share = self.static_rating / static_rating(unit)
        elif self.dynamic_rating is not None and self._rating:
            factor = shares.rating_factor * rating_factor(unit)
            share = (self.dynamic_rating / dynamic_rating(unit, factor)) ** (9.0 / 7.0)  # C ~ L^(7/9)
        return replace(unit, roller_length=share * whole)

    def _refuse(self, made: RollingBearing) -> None:
        """Refuse elements that have no room between the rings, and ratings that do not belong together."""
        key = self._rating
        if self.kind == "ball":
            share, (least, most) = made.element_diameter / self._section, _THICKNESS
            across = made.element_diameter <= self.width
            size = f"{made.count} balls of {made.element_diameter * 1e3:.3g} mm"
        else:
            share, (least, most) = made.roller_length * math.cos(made.contact_angle) / self.width, _LENGTH
            if made.aligning:
                least, most = _LENGTH_OF_TWO
            across = True
            size = f"{made.count} rollers of {made.element_diameter * 1e3:.3g} mm x {made.roller_length * 1e3:.3g} mm"
        envelope = f"{self.bore * 1e3:.6g} x {self.outside_diameter * 1e3:.6g} x {self.width * 1e3:.6g} mm"
        if not (least <= share <= most and across) and key is not None:
            raise RangeError(
                key, f"{getattr(self, key) * 1e-3:.6g} kN",
                f"is not possible within the envelope {envelope} (it requires {size})",
                "correct the rating or the dimensions",
            )  # fmt: skip
        if not (least <= share <= most and across):
            raise RangeError(
                "width", f"{self.width * 1e3:.6g} mm",
                f"is too small for the envelope {envelope} (typical are {size})", "specify static_rating",
            )  # fmt: skip
        if self.dynamic_rating is None or key == "dynamic_rating":
            return
        of_iso = dynamic_rating(made)
        if not _FACTORS[0] <= self.dynamic_rating / of_iso <= _FACTORS[1]:
            raise RangeError(
                "dynamic_rating", f"{self.dynamic_rating * 1e-3:.6g} kN",
                f"contradicts static_rating = {self.static_rating * 1e-3:.6g} kN: ISO 281 gives {of_iso * 1e-3:.3g} kN"
                if self.static_rating is not None
                else f"is not possible within the envelope {envelope} (ISO 281 gives about {of_iso * 1e-3:.3g} kN)",
                "correct one of them",
            )  # fmt: skip


@lru_cache(maxsize=256)
def _inside(bearing: CatalogueBearing) -> RollingBearing:
    """A case asks for it many times, each time of another object that says the same."""
    return bearing.estimated()


def _solved(rating: Callable[[float], float], wanted: float, most: float) -> float:
    """Diameter with which a bearing has a rating; the largest that fits where that is too small."""
    from scipy.optimize import brentq

    least = 1e-3 * most
    if rating(most) <= wanted:
        return most
    if rating(least) >= wanted:
        return least
    return float(brentq(lambda d: rating(d) - wanted, least, most, xtol=1e-18, rtol=1e-14))


def _stiffness(bearing: RollingBearing) -> float:
    """Radial stiffness at a load without clearance, up to a factor that depends on the load only."""
    n = bearing.exponent
    return float((bearing.count * bearing.constant * math.cos(bearing.contact_angle) ** (n + 1.0)) ** (1.0 / n))
