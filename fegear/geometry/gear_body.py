"""The body under the teeth of a gear: a rim as wide as the face, and web and hub that fill a part of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fegear.base.errors import GeometryError, shown
from fegear.geometry.body_along import BodyAlong, body_along

#: Thinnest web, hub and ring between two circles [modules]; thinner ones are shells, which want other elements.
_THINNEST = 0.2
#: Steepest web that was compared with other programs [rad].
STEEPEST = math.radians(30.0)
#: How long the rim is beside an inclined web's end at least, as a share of the hub there: both have polynomials of one
#: degree. The hub reaches beyond the web if by more than a share of the width.
_LEAST_RIM, _NEAR = 0.2, 1e-6
_ROUND_OFF = 1e-9
#: More holes than have room on any circle; Python divides by no whole number of hundreds of digits.
_MANY = 1_000_000
#: How near holes come to the root circle, as a share of its radius: a hundred waves round the gear feel them.
_NEAREST = 0.06
#: How far from rim and hub the part of a web that holes lie in begins: a share of the web's thickness, off the corners
#: that it makes with them, and at most a share of what is left beside a hole.
_OFF_CORNER, _OFF_HOLE = 0.3, 0.4


@dataclass(frozen=True, slots=True)
class WebHoles:
    """Round holes in a web, evenly spaced on a circle about the gear's axis.

    Parameters
    ----------
    count : int
    circle_radius : float
        Of the circle of their middles, in the unit of the gear.
    radius : float
        Of each hole.
    angle : float
        Of the first hole's middle from the centre line of tooth 0, positive the way that the loaded flank faces [rad].
    tooth : int, optional
        Clockwise from tooth 0, the tooth that is taken for all; without one the mean over all is.
    """

    count: int
    circle_radius: float
    radius: float
    angle: float = 0.0
    tooth: int | None = None

    def scaled(self, factor: float) -> WebHoles:
        """The same in other units."""
        return replace(self, circle_radius=self.circle_radius * factor, radius=self.radius * factor)

    def different_teeth(self, teeth: int) -> int:
        """How many teeth in a row stand differently to the holes before the first of them comes again."""
        return teeth // math.gcd(teeth, self.count)

    def check(self, body: GearBody, module: float, root_radius: float, teeth: int | None) -> None:
        """Refuse holes that have no room in a web; all lengths in the body's unit [m].

        Raises
        ------
        GeometryError
        """
        least, key = _THINNEST * module, "body.holes.diameter"
        size = f"{2e3 * self.radius:.6g} mm"
        if self.count < 1:
            raise GeometryError(
                "body.holes.count", self.count, "must be at least 1", "remove holes for a web without holes"
            )
        if body.lean:
            raise GeometryError(
                "body.holes", self.count, "are not supported in an inclined web", "remove web_inclination or holes"
            )
        if self.tooth is not None and teeth is not None and not 0 <= self.tooth < teeth:
            rule = f"must be between 0 and {teeth - 1}"
            raise GeometryError("body.holes.tooth", self.tooth, rule, "count clockwise from tooth 0")
        if not math.isfinite(self.angle):
            raise GeometryError("body.holes.angle", self.angle, "must be finite")
        if 2.0 * self.radius < least:
            raise GeometryError(
                key, size, f"must be at least {least * 1e3:.6g} mm ({_THINNEST:g} modules)",
                "smaller holes have no influence: remove them",
            )  # fmt: skip
        reach, least = self.radius + least, least * 1e3
        circle = (
            f"on their circle of {2e3 * self.circle_radius:.6g} mm, {least:.6g} mm away from it ({_THINNEST:g} modules)"
        )
        if self.circle_radius + reach > body.rim_radius * (1.0 + _ROUND_OFF):
            raise GeometryError(
                key, size, f"leaves no web to the inside of the rim, {2e3 * body.rim_radius:.6g} mm across, {circle}",
                "reduce hole diameter or circle_diameter",
            )  # fmt: skip
        if self.circle_radius - reach < body.hub_radius * (1.0 - _ROUND_OFF):
            raise GeometryError(
                key, size, f"leaves no web to the hub, {2e3 * body.hub_radius:.6g} mm across, {circle}",
                "reduce the hole diameter or increase circle_diameter",
            )  # fmt: skip
        apart = 2.0 * self.circle_radius * math.sin(math.pi / min(self.count, _MANY))
        if self.count > 1 and apart < 2.0 * self.radius + least * 1e-3:
            raise GeometryError(
                key, size, f"leaves no web between {shown(self.count)} holes "
                           f"spaced {apart * 1e3:.6g} mm {circle}", "reduce diameter or number of holes",
            )  # fmt: skip
        edge = self.circle_radius + self.radius
        if root_radius - edge < _NEAREST * root_radius:
            raise GeometryError(
                key, size, f"must stay {_NEAREST * root_radius * 1e3:.4g} mm ({100.0 * _NEAREST:g} % of its radius) "
                           f"below the root circle; these reach within {(root_radius - edge) * 1e3:.4g} mm",
                "holes this close to the teeth need too many circumferential harmonics",
            )  # fmt: skip


@dataclass(frozen=True, slots=True)
class GearBody:
    """Rim, web and hub, all of one length unit; places along the face from its middle, positive toward end II.

    Parameters
    ----------
    rim_radius : float
        Inside of the rim, where the web begins.
    hub_radius : float
        Outside of the hub, where the web ends; the bore's radius where there is no hub.
    web, hub : (float, float)
        The parts of the face that they fill, an inclined web where it meets the rim. The bore is held over the hub.
    lean : float
        Tangent of the web's inclination: positive if it meets the hub at greater places than the rim.
    holes : WebHoles, optional
        In the web.
    """

    rim_radius: float
    hub_radius: float
    web: tuple[float, float]
    hub: tuple[float, float]
    lean: float = 0.0
    holes: WebHoles | None = None

    @property
    def foot(self) -> tuple[float, float]:
        """Where the web meets the hub."""
        if not self.lean:
            return self.web
        shift = self.lean * (self.rim_radius - self.hub_radius)
        return self.web[0] + shift, self.web[1] + shift

    def along(self, width: float) -> BodyAlong:
        """Where web and hub lie in places that follow the web inward from the rim of a face so wide."""
        return body_along(self.web, self.hub, self.lean * (self.rim_radius - self.hub_radius), width)

    @property
    def even(self) -> bool:
        """Whether it is alike to both sides of the middle of the face."""
        middle = all(abs(low + high) <= _ROUND_OFF * (high - low) for low, high in (self.web, self.hub))
        return middle and not self.lean

    @property
    def holed_ring(self) -> tuple[float, float] | None:
        """Inside and outside of the part of the web that its holes lie in, off rim and hub; None without holes."""
        if self.holes is None:
            return None
        thickness, holes = self.web[1] - self.web[0], self.holes
        inner = holes.circle_radius - holes.radius - self.hub_radius
        outer = self.rim_radius - holes.circle_radius - holes.radius
        off = (min(_OFF_CORNER * thickness, _OFF_HOLE * room) for room in (inner, outer))
        return self.hub_radius + next(off), self.rim_radius - next(off)

    def is_disc(self, width: float) -> bool:
        """Whether web and hub fill a face and have no holes, so that the gear is a disc."""
        return self.holes is None and all(
            high - low >= (1.0 - _ROUND_OFF) * width for low, high in (self.web, self.hub)
        )

    def scaled(self, factor: float) -> GearBody:
        """The same in other units."""
        (a, b), (c, d) = self.web, self.hub
        return GearBody(
            self.rim_radius * factor, self.hub_radius * factor, (a * factor, b * factor), (c * factor, d * factor),
            self.lean, None if self.holes is None else self.holes.scaled(factor),
        )  # fmt: skip

    def section(self, outer_radius: float, bore_radius: float, width: float) -> tuple[tuple[float, float], ...]:
        """Half of the gear's section along its axis: corners by place along the face and radius.

        Clockwise from the outer radius at end I, which is at the left, and closed.
        """
        rim, hub, end = self.rim_radius, self.hub_radius, 0.5 * width
        (a, b), (c, d), (e, f) = self.web, self.foot, self.hub
        return (
            (-end, outer_radius), (end, outer_radius), (end, rim), (b, rim), (d, hub), (f, hub), (f, bore_radius),
            (e, bore_radius), (e, hub), (c, hub), (a, rim), (-end, rim), (-end, outer_radius),
        )  # fmt: skip

    def check(
        self, module: float, width: float, bore_radius: float, root_radius: float, teeth: int | None = None
    ) -> None:
        """Refuse bodies that do not fit their gear; all lengths in the body's unit [m].

        Raises
        ------
        GeometryError
        """
        near = _ROUND_OFF * width
        low, high = self.web
        if not -0.5 * width - near <= low < high <= 0.5 * width + near:
            raise GeometryError(
                "body.web", f"{low * 1e3:.6g} to {high * 1e3:.6g} mm",
                f"must be within the face width, {-500 * width:.6g} to {500 * width:.6g} mm",
                "reduce web_thickness or web_offset",
            )  # fmt: skip
        if high - low < min(_THINNEST * module, width) - near:
            raise GeometryError(
                "body.web_thickness", f"{(high - low) * 1e3:.6g} mm",
                f"must be at least {_THINNEST * module * 1e3:.6g} mm ({_THINNEST:g} modules)",
                "thinner webs (shells) are not supported",
            )  # fmt: skip
        if not abs(self.lean) <= math.tan(STEEPEST) * (1.0 + _ROUND_OFF):
            raise GeometryError(
                "body.web_inclination", f"{math.degrees(math.atan(self.lean)):.6g} deg",
                f"must be between {-math.degrees(STEEPEST):.6g} and {math.degrees(STEEPEST):.6g} deg (verified range)",
            )  # fmt: skip
        start, end = self.hub
        low, high = self.foot
        if self.lean and not -0.5 * width - near <= low < high <= 0.5 * width + near:
            raise GeometryError(
                "body.web_inclination", f"{math.degrees(math.atan(self.lean)):.6g} deg",
                f"places the web outside the face width, {-500 * width:.6g} to {500 * width:.6g} mm: it would extend "
                f"from {low * 1e3:.6g} to {high * 1e3:.6g} mm",
                "reduce web_inclination, or change web_offset",
            )  # fmt: skip
        if not -0.5 * width - near <= start <= low + near or not high - near <= end <= 0.5 * width + near:
            raise GeometryError(
                "body.hub", f"{start * 1e3:.6g} to {end * 1e3:.6g} mm",
                f"must cover the web, {'there ' if self.lean else ''}{low * 1e3:.6g} to {high * 1e3:.6g} mm, within "
                "the face width",
                f"change {'web_inclination, ' if self.lean else ''}hub_width or hub_offset",
            )  # fmt: skip
        thin = _THINNEST * module
        if not thin - _ROUND_OFF * root_radius <= root_radius - self.rim_radius <= root_radius - bore_radius - thin:
            raise GeometryError(
                "body.rim_thickness", f"{(root_radius - self.rim_radius) * 1e3:.6g} mm",
                f"must be at least {thin * 1e3:.6g} mm ({_THINNEST:g} modules) and leave at least as much for a web, "
                f"of {(root_radius - bore_radius) * 1e3:.6g} mm between bore and root circle",
            )  # fmt: skip
        hubless = abs(self.hub_radius - bore_radius) <= _ROUND_OFF * bore_radius
        if not (hubless or bore_radius + thin <= self.hub_radius) or not self.hub_radius <= self.rim_radius - thin:
            raise GeometryError(
                "body.hub_radius", f"{self.hub_radius * 1e3:.6g} mm",
                f"must be between the bore, {bore_radius * 1e3:.6g} mm, and the inside of the rim, "
                f"{self.rim_radius * 1e3:.6g} mm, at least {thin * 1e3:.6g} mm from both ({_THINNEST:g} modules)",
            )  # fmt: skip
        self._check_beside(width)
        if self.holes is not None:
            self.holes.check(self, module, root_radius, teeth)

    def _check_beside(self, width: float) -> None:
        """Refuse an inclined web beside whose end the hub goes on where the face does not."""
        (low, high), (start, end), half = self.web, self.foot, 0.5 * width
        for room, hub in ((low + half, start - self.hub[0]), (half - high, self.hub[1] - end)) if self.lean else ():
            if hub > _NEAR * width and room < _LEAST_RIM * hub:
                raise GeometryError(
                    "body.web_offset", f"with {room * 1e3:.6g} mm of face width next to the web",
                    f"is not supported if the hub extends {hub * 1e3:.6g} mm beyond an inclined web and the rim by "
                    f"less than {_LEAST_RIM * hub * 1e3:.6g} mm",
                    "change web_offset, or start the hub at the web (hub_width, hub_offset)",
                )  # fmt: skip
