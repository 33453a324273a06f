"""One side of a tooth with involute flanks, with what lies behind it: all that mechanics of a loaded flank asks of it.

Whoever loads a flank takes an `InvoluteSide` and finds that flank on the right; the other half of the tooth is its
`back`, mirrored into the same position. A tooth with flanks alike is its own back (`InvoluteTooth`, which all that
holds for symmetric teeth only demands); an asymmetric tooth is no `InvoluteTooth`, it has two sides.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Arc, Curve, Involute, Line
from fegear.geometry.involute import polar_angle
from fegear.geometry.tooth_side import outline_of

#: Largest helix angle on the reference cylinder [rad].
LARGEST_HELIX_ANGLE = math.radians(60.0)

#: The flanks of a tooth: the one that drives, or is driven, in the usual direction, and the other one.
Flank = Literal["drive", "coast"]
FLANKS: tuple[Flank, Flank] = ("drive", "coast")


class GivenNumbers(Protocol):
    """What is given of any tooth, whatever its flanks."""

    @property
    def teeth(self) -> int: ...  # noqa: D102  (its name says it)
    @property
    def profile_shift(self) -> float: ...  # noqa: D102  (its name says it)
    @property
    def thickness_allowance(self) -> float: ...  # noqa: D102  (its name says it)
    @property
    def tip_radius(self) -> float: ...  # noqa: D102  (its name says it)
    @property
    def tip_rounding(self) -> float: ...  # noqa: D102  (its name says it)
    @property
    def tip_chamfer(self) -> float: ...  # noqa: D102  (its name says it)
    @property
    def helix_angle(self) -> float: ...  # noqa: D102  (its name says it)


def check_given(tooth: GivenNumbers) -> None:
    """Refuse numbers that no tooth has, and make the number of teeth an int."""
    z = tooth.teeth
    if isinstance(z, bool) or int(z) != z:
        raise GeometryError("teeth", z, "must be a whole number")
    if not 0.0 <= tooth.helix_angle <= LARGEST_HELIX_ANGLE:
        angle = f"{math.degrees(tooth.helix_angle):.6g} deg"
        raise GeometryError("helix_angle", angle, "must be between 0 and 60 deg", "the hand defines the sign")
    fewest = max(3, math.ceil(5.0 * math.cos(tooth.helix_angle) ** 3 - 1e-9))  # as many as five of a spur gear
    if not fewest <= z <= 1000:
        remedy = "a rack has a table of its own: [rack.NAME]"
        if z < 0.0:
            remedy = f"a ring gear has internal = true and teeth = {-int(z)}"
        raise GeometryError("teeth", z, f"must be between {fewest} and 1000", remedy)
    object.__setattr__(tooth, "teeth", int(z))
    for name in ("profile_shift", "thickness_allowance", "tip_rounding", "tip_chamfer"):
        if not math.isfinite(getattr(tooth, name)):
            raise GeometryError(name, getattr(tooth, name), "must be finite")
    if math.isinf(tooth.tip_radius):
        raise GeometryError("tip_radius", tooth.tip_radius, "must be finite")
    for name in ("tip_rounding", "tip_chamfer"):
        if getattr(tooth, name) < 0.0:
            raise GeometryError(name, getattr(tooth, name), "must not be negative")
    if tooth.tip_rounding > 0.0 and tooth.tip_chamfer > 0.0:
        raise GeometryError(
            "tip_chamfer",
            tooth.tip_chamfer,
            "contradicts a tip rounding",
            "specify either the rounding or the chamfer",
        )


class InvoluteSide(ABC):
    """A tooth seen from one of its flanks, whichever tool has cut it.

    The tooth's centre line is +y and the flank that it is seen from lies on the right. An external tooth points away
    from the gear's centre, an internal one toward it. Roll angles carry the sign of the flank's curvature, as tooth
    numbers do in ISO 21771: positive on an external flank, negative on an internal one. So they rise from the root to
    the tip on either, and one formula gives points, normals, angles and curvature of both.

    Every length is in normal modules; curves, radii and angles are those of the section across the axis.
    """

    #: 1 for an external tooth, -1 for an internal one.
    side: ClassVar[int] = 1
    #: Whether its fillets are other than its tool makes them (`fegear.geometry.custom_fillet_tooth`).
    shaped: ClassVar[bool] = False

    teeth: int
    profile_shift: float
    thickness_allowance: float
    tip_radius: float
    tip_rounding: float
    tip_chamfer: float
    helix_angle: float

    # ---- what the tool decides -------------------------------------------------------------------------------------
    @property
    @abstractmethod
    def back(self) -> InvoluteSide:
        """The tooth seen from its other flank."""

    @property
    @abstractmethod
    def normal_pressure_angle(self) -> float:
        """alpha_n of this flank [rad]."""

    @property
    @abstractmethod
    def pressure_angle(self) -> float:
        """alpha_t, the transverse pressure angle of this flank [rad]."""

    @property
    @abstractmethod
    def generating_shift(self) -> float:
        """x_E, generating profile shift coefficient: the shift less what the thickness allowance takes."""

    @property
    @abstractmethod
    def root_radius(self) -> float:
        """r_f [modules]."""

    @property
    @abstractmethod
    def base_half_angle(self) -> float:
        """psi_b, angle from the centre line at which the involute leaves the base circle [rad]."""

    @property
    def tip_middle(self) -> float:
        """Angle from the centre line to the middle of the tip land [rad], toward this flank: none of equal flanks."""
        return 0.0

    @property
    @abstractmethod
    def form_roll(self) -> float:
        """Roll angle of the involute where it starts on the flank [rad]."""

    @property
    @abstractmethod
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""

    @property
    @abstractmethod
    def undercut(self) -> bool:
        """Whether the tool cuts away part of the involute, so that it starts in a corner."""

    @property
    @abstractmethod
    def fillet(self) -> Curve:
        """The right fillet, from the root circle to the involute."""

    @property
    def working_flank(self) -> Flank | None:
        """Which flank of an asymmetric tooth it is seen from; None of equal flanks."""
        return None

    # ---- circles and angles -------------------------------------------------------------------------------------
    @property
    def internal(self) -> bool:
        """Whether the tooth points toward the gear's centre."""
        return self.side < 0

    @property
    def pitch_radius(self) -> float:
        """Pitch radius r = z / (2 cos(beta)) [modules]."""
        return self.teeth / 2 / math.cos(self.helix_angle)

    @property
    def base_helix_angle(self) -> float:
        """beta_b on the base cylinder [rad], without the sign of the hand."""
        return math.atan(math.tan(self.helix_angle) * math.cos(self.pressure_angle))

    @property
    def twist(self) -> float:
        """tan(beta) / r, turn of the section per height along the axis [rad/module], without the sign of the hand."""
        return math.tan(self.helix_angle) / self.pitch_radius

    @cached_property
    def base_radius(self) -> float:
        """r_b = r cos(alpha_t) [modules]."""
        return self.pitch_radius * math.cos(self.pressure_angle)

    @property
    def base_pitch(self) -> float:
        """p_bt = pi cos(alpha_t) / cos(beta), across the axis [modules]."""
        return math.pi * math.cos(self.pressure_angle) / math.cos(self.helix_angle)

    def roll(self, radius: ArrayLike) -> Array:
        """Roll angle [rad], in the section, of the involute at `radius` [modules] (>= base radius).

        tan(alpha_r) on an external flank, -tan(alpha_r) on an internal one.
        """
        r = np.asarray(radius, dtype=float)
        return np.asarray(self.side * np.sqrt((r - self.base_radius) * (r + self.base_radius)) / self.base_radius)

    def radius_of_roll(self, roll: ArrayLike) -> Array:
        """Radius [modules] of the involute at a roll angle [rad]."""
        return self.base_radius * np.hypot(1.0, np.asarray(roll, dtype=float))

    def flank_angle(self, radius: ArrayLike) -> Array:
        """Angle from the centre line [rad] of the involute at `radius` [modules]."""
        return self.base_half_angle - polar_angle(self.roll(radius))

    def thickness_angle(self, radius: ArrayLike) -> Array:
        """The tooth's angle [rad] between its two involutes at `radius` [modules], outside both base circles."""
        return np.asarray(self.flank_angle(radius) + self.back.flank_angle(radius))

    # ---- the usable flank ------------------------------------------------------------------------------------------
    @cached_property
    def form_radius(self) -> float:
        """r_Ff, where the involute starts on the flank [modules]."""
        return float(self.radius_of_roll(self.form_roll))

    @cached_property
    def involute(self) -> Involute:
        """The usable right flank, from form circle to tip (or its rounding, chamfer)."""
        end = float(self.roll(self.involute_tip_radius))
        return Involute(self.base_radius, self.base_half_angle, self.form_roll, end)

    # ---- the tip ---------------------------------------------------------------------------------------------------
    @property
    def _edge_key(self) -> str:
        return "tip_rounding" if self.tip_rounding > 0.0 else "tip_chamfer"

    def _involute_end(self, key: str, size: float) -> float:
        """Radius at which a rounding or chamfer of this size ends the involute; NaN where it ends on none."""
        inner = self.tip_radius - self.side * size
        if key == "tip_chamfer" or size == 0.0:
            return inner
        if inner <= self.base_radius:
            return math.nan
        # The rounding's centre lies on the parallel involute (same base circle, roll length less the rounding).
        length = size + self.side * math.sqrt((inner - self.base_radius) * (inner + self.base_radius))
        return math.hypot(self.base_radius, length)

    def _land_half_angle(self, key: str, size: float, end: float) -> float:
        """Angle from the centre line at which the tip land that an edge of this size leaves begins [rad]."""
        if key == "tip_chamfer":
            return float(self.flank_angle(end)) - size / self.tip_radius
        roll = float(self.roll(end))
        phi = self.base_half_angle - roll
        flank = Involute(self.base_radius, self.base_half_angle, 0.0, roll)
        x, y = flank.points(roll) - size * np.array([math.cos(phi), -math.sin(phi)])
        return math.atan2(x, y)

    @cached_property
    def involute_tip_radius(self) -> float:
        """Radius at which the involute ends: the tip circle, or where its rounding or chamfer starts [modules]."""
        return self._involute_end(self._edge_key, self.tip_rounding + self.tip_chamfer)

    @property
    def involute_radii(self) -> tuple[float, float]:
        """Least and largest radius of the usable involute [modules]."""
        low, high = sorted((self.form_radius, self.involute_tip_radius))
        return low, high

    @cached_property
    def tip_half_angle(self) -> float:
        """Angle from the centre line at which the tip land begins on this side [rad]."""
        return self._land_half_angle(self._edge_key, self.tip_rounding + self.tip_chamfer, self.involute_tip_radius)

    # ---- curves ----------------------------------------------------------------------------------------------------
    @cached_property
    def root_land(self) -> Arc | None:
        """The part of the root land up to the middle of the space, or None with a full fillet."""
        if self.root_land_half_angle <= 1e-12:
            return None
        middle = math.pi / self.teeth
        return Arc((0.0, 0.0), self.side * self.root_radius, middle, middle - self.root_land_half_angle)

    @property
    def root_land_length(self) -> float:
        """Length of that part [modules]."""
        return self.root_radius * self.root_land_half_angle

    @property
    def space_middle(self) -> tuple[float, float]:
        """Bottom of the middle of the tooth space on the right [modules]."""
        half = math.pi / self.teeth
        return self.root_radius * math.sin(half), self.root_radius * math.cos(half)

    @cached_property
    def tip_edge(self) -> Arc | Line | None:
        """Rounding or chamfer between flank and tip circle, or None."""
        t = self.involute.end
        if self.tip_rounding > 0.0:
            phi = self.base_half_angle - t
            x, y = self.involute.points(t) - self.tip_rounding * np.array([math.cos(phi), -math.sin(phi)])
            last = self.tip_half_angle + (math.pi if self.internal else 0.0)
            return Arc((float(x), float(y)), self.tip_rounding, math.pi / 2 + phi, last)
        if self.tip_chamfer > 0.0:
            a, b = (
                self.involute.points(t),
                self.tip_radius * np.array([math.sin(self.tip_half_angle), math.cos(self.tip_half_angle)]),
            )
            return Line((float(a[0]), float(a[1])), (float(b[0]), float(b[1])), self.side)
        return None

    @cached_property
    def tip_land(self) -> Arc:
        """Half of the tip circle's arc, on this side."""
        return Arc((0.0, 0.0), self.side * self.tip_radius, self.tip_half_angle, self.tip_middle)

    @property
    def outline(self) -> dict[str, Curve]:
        """Half of the outline from the middle of the tooth space to the middle of the tip land, by name."""
        return outline_of(self)


@dataclass(frozen=True)
class TakenOver:
    """What is given of any tooth, taken over from another one."""

    teeth: int = field(init=False, repr=False)
    profile_shift: float = field(init=False, repr=False)
    thickness_allowance: float = field(init=False, repr=False)
    tip_radius: float = field(init=False, repr=False)
    tip_rounding: float = field(init=False, repr=False)
    tip_chamfer: float = field(init=False, repr=False)
    helix_angle: float = field(init=False, repr=False)

    def take_over(self, tooth: GivenNumbers) -> None:
        """Have the given numbers of a tooth; while this one is made."""
        for given in fields(TakenOver):
            object.__setattr__(self, given.name, getattr(tooth, given.name))


@dataclass(frozen=True)
class SideOfTooth(TakenOver, InvoluteSide):
    """A side of which another tooth has the given numbers: the whole tooth, or the tooth as its tool makes it."""
