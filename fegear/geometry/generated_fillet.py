"""The fillet of a generated tooth: what the rack's tip rounding and its protuberance leave, and where the flank starts.

A rack without protuberance leaves a trochoid that meets the flank smoothly or, with undercut, in a corner. A rack with
protuberance (ISO 6336-3, 6.2, and ISO 53) cuts deeper than the finished flank by s_pr, its protuberance less the stock
that grinding takes; its protuberance flank, straight under an angle of its own, generates a second involute that goes
on where the trochoid ends. Whatever is deepest inside the tooth is its outline.
All of it is drawn in the section across the axis, where the rack of a helical gear is its normal section stretched
along the rack by one over the cosine of the helix angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Curve, Involute, Trochoid
from fegear.geometry.involute import inv, polar_angle
from fegear.geometry.rack import BasicRack, transverse_angle
from fegear.geometry.undercut import undercut_meeting

#: Profile shift by which a rack may lie below the undercut line and cut nothing: round-off of units and conversions.
NO_UNDERCUT = 1e-9
#: Roll angle by which the rack cuts past the base circle [rad] below which the cut's place is found in closed form.
_SLIGHT_UNDERCUT = 1e-4


#: A rack tip as sharp as this [modules] needs as much room below the pitch line to leave a fillet.
_SMALLEST_FILLET = 1e-6


class RoundedTip(Protocol):
    """The rounding of a rack's tip beside one of its flanks, in the normal section."""

    @property
    def tip_radius(self) -> float:
        """rho_fP [modules]."""

    @property
    def tip_centre_depth(self) -> float:
        """Depth of the rounding's centre below the reference line [modules]."""


def check_trochoid(fillet: Trochoid, tip: RoundedTip, profile_shift: float, key: str = "rack.tip_radius") -> None:
    """Refuse a rack whose tip rounding leaves a notch, or a loop, in place of a fillet.

    Parameters
    ----------
    fillet : Trochoid
        Of the whole rounding.
    tip : RoundedTip
    profile_shift : float
    key : str
        Of the tip radius, in messages.
    """
    if max(tip.tip_radius, abs(tip.tip_centre_depth - profile_shift)) < _SMALLEST_FILLET:
        raise GeometryError(
            key,
            tip.tip_radius,
            "is a sharp corner on the pitch line and would generate a notch instead of a fillet",
            "specify a tip radius of the rack, or a profile shift different from its dedendum",
        )
    if np.min(fillet.speed(np.linspace(fillet.start, fillet.end, 65))) < 0.0:
        raise GeometryError(
            "profile_shift",
            profile_shift,
            "is too large: the rack tip rounding crosses the pitch line",
            f"choose a profile shift below {tip.tip_centre_depth:.4f} or a larger rack tip radius",
        )


@dataclass(frozen=True, slots=True)
class ProtuberanceFillet:
    """A trochoid and the involute that the protuberance flank generates, as one curve.

    The parameter is the trochoid's beta [rad] up to its end and goes on with the involute's roll angle.

    Parameters
    ----------
    trochoid : Trochoid
    involute : Involute
        Of the base circle that belongs to the protuberance angle.
    """

    trochoid: Trochoid
    involute: Involute

    @property
    def smooth_parts(self) -> tuple[Curve, ...]:
        """The trochoid and the involute: curvature jumps between them."""
        return self.trochoid, self.involute

    @property
    def start(self) -> float:
        """Zero, on the root circle."""
        return self.trochoid.start

    @property
    def end(self) -> float:
        """Where the fillet meets the flank."""
        return self.trochoid.end + self.involute.end - self.involute.start

    def _of_either(self, name: str, parameter: ArrayLike) -> Array:
        u = np.asarray(parameter, dtype=float)
        low = getattr(self.trochoid, name)(np.minimum(u, self.trochoid.end))
        roll = self.involute.start + np.maximum(u - self.trochoid.end, 0.0)
        return np.where(u <= self.trochoid.end, low, getattr(self.involute, name)(roll))

    def points(self, parameter: ArrayLike) -> Array:
        """Points [modules], shape (2, N)."""
        return self._of_either("points", parameter)

    def normals(self, parameter: ArrayLike) -> Array:
        """Unit normals out of the material, shape (2, N)."""
        return self._of_either("normals", parameter)

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Curvature [1/modules]; it jumps where the involute begins."""
        return self._of_either("curvatures", parameter)

    def speed(self, parameter: ArrayLike) -> Array:
        """Arc length per parameter [modules]."""
        return self._of_either("speed", parameter)


@dataclass(frozen=True, slots=True)
class RackFlankLine:
    """The involute that one straight flank of a rack generates on a gear, before anything else cuts it.

    All is in the section across the gear's axis.

    Parameters
    ----------
    pressure_angle : float
        alpha_t of the straight flank [rad].
    pitch_radius : float
        [modules].
    half_space : float
        Half the width of the rack's tooth on the reference line, along this flank [modules].
    half_pitch : float
        Half the rack's pitch [modules].
    shift : float
        Generating profile shift [modules].
    normal_angle : float
        alpha_n of the straight flank [rad]; alpha_t itself for a spur gear.
    """

    pressure_angle: float
    pitch_radius: float
    half_space: float
    half_pitch: float
    shift: float
    normal_angle: float

    @property
    def base_radius(self) -> float:
        """Of the involute [modules]."""
        return self.pitch_radius * math.cos(self.pressure_angle)

    @property
    def half_angle(self) -> float:
        """Half the tooth's angle between its two such involutes on their base circle [rad]."""
        half = self.half_pitch - self.half_space + self.shift * math.tan(self.pressure_angle)
        return half / self.pitch_radius + float(inv(self.pressure_angle))

    def tangent_roll(self, rack: RoundedTip) -> float:
        """Roll angle at which the flank ends on the line of action at the tip rounding; negative means undercut."""
        alpha = self.pressure_angle
        height = self.shift - rack.tip_centre_depth - rack.tip_radius * math.sin(self.normal_angle)
        return math.tan(alpha) + height / (self.base_radius * math.sin(alpha))

    def undercut_by(self, rack: RoundedTip) -> bool:
        """Whether the tip rounding cuts away part of the involute: more than round-off of a gear on the line itself."""
        shift = self.tangent_roll(rack) * self.base_radius * math.sin(self.pressure_angle)
        return shift < -NO_UNDERCUT

    def roll(self, radius: float) -> float:
        """Roll angle [rad] at a radius [modules], zero inside the base circle."""
        return math.sqrt(max((radius - self.base_radius) * (radius + self.base_radius), 0.0)) / self.base_radius

    def polar(self, radius: float) -> float:
        """Angle from the tooth's centre line [rad] at a radius [modules]."""
        return self.half_angle - float(polar_angle(self.roll(radius)))


def meeting(trochoid: Trochoid, flank: RackFlankLine, tangent_roll: float) -> tuple[float, float]:
    """Trochoid parameter and roll angle where a trochoid and the involute of the flank that it runs into meet.

    Parameters
    ----------
    trochoid : Trochoid
        Up to where the rounding of the rack's tip ends.
    flank : RackFlankLine
    tangent_roll : float
        See `RackFlankLine.tangent_roll`; without undercut the curves touch at the trochoid's end.
    """
    if tangent_roll >= 0.0:
        return trochoid.end, tangent_roll
    if trochoid.cos_helix == 1.0:
        before, at = undercut_meeting([-tangent_roll], trochoid.rounding / trochoid.pitch_radius, flank.pressure_angle)
        return trochoid.end - float(before[0]), float(at[0])
    from scipy.optimize import brentq  # late: a gear without undercut does without, and it takes a third of a second

    def radius(beta: float) -> float:
        return float(np.hypot(*trochoid.points(beta)))

    slight = -tangent_roll
    if slight < _SLIGHT_UNDERCUT:
        # The trochoid leaves the involute's other branch at the roll angle -slight along its tangent and meets this
        # branch where 2 x^3 + 3 x^2 = 1, x = roll / slight; the angles themselves, slight^3, drown in round-off.
        roll = 0.5 * slight
        target = flank.base_radius * math.hypot(1.0, roll)
        below = radius(trochoid.start) < target < radius(trochoid.end)
        return (brentq(lambda b: radius(b) - target, 0.0, trochoid.end) if below else trochoid.end), roll
    # The trochoid's radius grows with beta; below the base circle there is no involute to meet.
    low = trochoid.start
    if radius(low) < flank.base_radius:
        low = brentq(lambda b: radius(b) - flank.base_radius, low, trochoid.end, xtol=1e-15, rtol=1e-15)
    ends = [_outside(trochoid, flank, b) for b in (low, trochoid.end)]
    clear = ends[0] >= 0.0 or ends[1] < 0.0  # nowhere on this flank does the trochoid come out
    beta = (
        trochoid.end
        if clear
        else brentq(lambda b: _outside(trochoid, flank, b), low, trochoid.end, xtol=1e-15, rtol=9e-16)
    )
    return beta, flank.roll(radius(beta))


def _outside(trochoid: Trochoid, flank: RackFlankLine, beta: float) -> float:
    """Angle [rad] by which a point of the trochoid lies outside the flank; negative where it is cut into it."""
    x, y = trochoid.points(beta)
    return float(np.arctan2(x, y)) - flank.polar(math.hypot(float(x), float(y)))


def protuberance_fillet(
    trochoid: Trochoid, rack: BasicRack, flank: RackFlankLine, tip_radius: float, helix_angle: float
) -> tuple[Trochoid | ProtuberanceFillet, float]:
    """Fillet that a rack with protuberance leaves under the finished flank, and the flank's roll angle at its end.

    Parameters
    ----------
    trochoid : Trochoid
        Up to the protuberance flank.
    rack : BasicRack
    flank : RackFlankLine
        The finished flank.
    tip_radius : float
        The flank must be met below it [modules].
    helix_angle : float
        [rad].

    Raises
    ------
    GeometryError
        If the protuberance takes away the whole flank.
    """
    from scipy.optimize import brentq

    half_space = rack.tip_centre_offset + rack.tip_radius / math.cos(rack.protuberance_angle)
    half_space += rack.tip_centre_depth * math.tan(rack.protuberance_angle)
    half_space /= math.cos(helix_angle)
    angle = transverse_angle(rack.protuberance_angle, helix_angle)
    second = RackFlankLine(
        angle, flank.pitch_radius, half_space, flank.half_pitch, flank.shift, rack.protuberance_angle
    )
    beta, roll = meeting(trochoid, second, second.tangent_roll(rack))
    at = float(np.hypot(*trochoid.points(beta)))

    def spare(radius: float) -> float:
        """How far the protuberance's involute still lies inside the finished flank [rad]."""
        return flank.polar(radius) - second.polar(radius)

    if at >= flank.base_radius and _outside(trochoid, flank, beta) >= 0.0:
        # The rounding itself comes out of the flank: from where it is cut deepest, up to there.
        looked = np.append(np.linspace(0.0, beta, 400)[::-1], 0.5 * math.pi - flank.normal_angle)
        cut = max((b for b in looked if b < beta and _outside(trochoid, flank, b) < 0.0), default=None)
        if cut is None:  # a protuberance lost in round-off
            plain = replace(trochoid, end=0.5 * math.pi - flank.normal_angle)
            end, along = meeting(plain, flank, flank.tangent_roll(rack))
            return replace(trochoid, end=end), along
        end = brentq(lambda b: _outside(trochoid, flank, b), cut, beta, xtol=1e-15, rtol=9e-16)
        return replace(trochoid, end=end), flank.roll(float(np.hypot(*trochoid.points(end))))
    low = max(at, flank.base_radius, second.base_radius)
    if spare(tip_radius) >= 0.0 or spare(low) <= 0.0:
        raise GeometryError(
            "rack.protuberance",
            rack.protuberance,
            "removes the entire flank"
            if spare(tip_radius) >= 0.0
            else "does not reach the flank above its base circle",
            "reduce it, or increase the protuberance angle",
        )
    meets = brentq(spare, low, tip_radius, xtol=1e-15, rtol=9e-16)
    involute = Involute(second.base_radius, second.half_angle, roll, second.roll(meets))
    return ProtuberanceFillet(replace(trochoid, end=beta), involute), flank.roll(meets)
