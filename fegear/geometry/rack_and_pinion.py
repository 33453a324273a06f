"""A pinion in mesh with a rack: path of contact, contact ratio, clearances, backlash (ISO 21771 with z -> infinity).

The pinion rolls with its reference circle r on a line of the rack, whatever the distance: the line of action stands
under the rack's pressure angle, and profile shift or distance move the rolling line on the rack, not the circle on the
pinion. With x along the line of action from the pitch point, positive toward the pinion's tip,

    rho(x) = r sin(alpha) + x   (the pinion's roll length),      y(x) = y_C - x sin(alpha)   (height on the rack),

y_C the height of the rolling line above the rack's reference line. While the pinion turns by phi the rack moves by
r phi and the contact by r_b phi: lengths along the rack are those along the line of action over cos(alpha), forces
along it those normal to the flank times cos(alpha).

Of helical teeth all of this is the transverse section, alpha its pressure angle; the teeth of the rack have the hand
that the pinion has not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError, InputError
from fegear.geometry.gear import Gear, Hand
from fegear.geometry.toothed_rack import Rack

#: Modules and angles of pinion and rack agree to this share.
_AGREE = 1e-9
#: A base pitch in which less than this share of it has a second pair still counts as covered, for round-off [pitches].
_ROUND_OFF = 1e-9
#: Hand of what meshes with a rack.
OTHER_HAND: dict[Hand, Hand] = {"spur": "spur", "left": "right", "right": "left"}


@dataclass(frozen=True)
class RackAndPinion:
    """A pinion and a rack at a distance, spur or helical.

    Parameters
    ----------
    pinion : Gear
    rack : Rack
    distance : float
        From the pinion's axis to the rack's reference line [m].

    Raises
    ------
    InputError, GeometryError
        If the two cannot mesh: unlike modules or angles, tips that meet roots, a contact ratio below one.
    """

    pinion: Gear
    rack: Rack
    distance: float

    def __post_init__(self) -> None:
        """Refuse what cannot mesh."""
        pinion, rack = self.pinion, self.rack
        if pinion.tooth.internal:
            raise InputError("pinion", "an internal gear", "cannot mesh with a rack", "name an external spur gear")
        if abs(pinion.helix_angle - rack.helix_angle) > _AGREE:
            raise InputError("helix_angle", f"{math.degrees(rack.helix_angle):.6g} deg",
                             "differs from that of the pinion, "
                             f"{math.degrees(pinion.helix_angle):.6g} deg")  # fmt: skip
        if pinion.hand != OTHER_HAND[rack.hand]:
            raise InputError("hand", f"{rack.hand} rack, {pinion.hand} pinion", "must be opposite",
                             "change the hand of the pinion")  # fmt: skip
        if pinion.asymmetric:
            raise InputError("pinion", "asymmetric teeth", "are not available with racks",
                             "use equal flanks")  # fmt: skip
        if abs(pinion.module - rack.module) > _AGREE * rack.module:
            raise InputError("module", f"{rack.module * 1e3:.6g} mm",
                             f"differs from the module of the pinion, {pinion.module * 1e3:.6g} mm")  # fmt: skip
        if abs(pinion.normal_pressure_angle - rack.tooth.rack.pressure_angle) > _AGREE:
            raise InputError("pressure_angle", f"{math.degrees(rack.tooth.rack.pressure_angle):.6g} deg",
                             "differs from that of the pinion")  # fmt: skip
        for clearance, tip, root in (
            (self.pinion_tip_clearance, "pinion", "rack"), (self.rack_tip_clearance, "rack", "pinion"),
        ):  # fmt: skip
            if not clearance > 0.0:
                raise GeometryError(
                    "distance", f"{self.distance * 1e3:.6g} mm",
                    f"places the tip of the {tip} {-clearance * 1e3:.4g} mm below the root of the {root}",
                    "increase distance, or reduce the addendum",
                )  # fmt: skip
        low, high = self.interference
        if max(low, high) > 1e-9 * rack.module:
            at = "pinion below its root form circle" if low >= high else "rack below the start of its flank"
            raise GeometryError(
                "distance", f"{self.distance * 1e3:.6g} mm", f"results in tip interference with the {at}",
                "increase distance or the profile shift of the pinion, or reduce the addendum",
            )  # fmt: skip
        if self.backlash < -1e-9 * rack.module:
            raise GeometryError(
                "distance", f"{self.distance * 1e3:.6g} mm",
                f"gives a negative backlash of {self.backlash * 1e6:.4g} um",
                f"set distance to at least {(self.distance - self.backlash / 2 / self._slope) * 1e3:.6g} mm",
            )  # fmt: skip
        if self.total_contact_ratio < 1.0:
            raise GeometryError(
                "distance", f"{self.distance * 1e3:.6g} mm",
                f"gives a contact ratio of {self.total_contact_ratio:.4g}, below 1: contact is interrupted",
                "reduce distance, or increase the addendum",
            )  # fmt: skip

    @property
    def _slope(self) -> float:
        return math.tan(self.rack.pressure_angle)

    @property
    def _undercut(self) -> bool:
        return self.pinion.tooth.undercut

    @property
    def face_width(self) -> float:
        """Common face width [m]."""
        return min(self.pinion.face_width, self.rack.face_width)

    @property
    def rolling_height(self) -> float:
        """y_C, height of the rolling line above the rack's reference line [m]."""
        return self.distance - self.pinion.pitch_radius

    @property
    def _at_pitch_point(self) -> float:
        """Roll length of the pinion at the pitch point [m]."""
        return self.pinion.pitch_radius * math.sin(self.rack.pressure_angle)

    def roll_length(self, x: ArrayLike) -> Array:
        """rho of the pinion at places x on the line of action [m]."""
        return np.asarray(self._at_pitch_point + np.asarray(x, dtype=float))

    def radius(self, x: ArrayLike) -> Array:
        """Contact radius on the pinion [m]."""
        return np.asarray(np.hypot(self.pinion.base_radius, self.roll_length(x)))

    def height(self, x: ArrayLike) -> Array:
        """Height of the contact above the rack's reference line [m]."""
        return np.asarray(self.rolling_height - np.asarray(x, dtype=float) * math.sin(self.rack.pressure_angle))

    def x_of_height(self, height: float) -> float:
        """Place of a contact by its height on the rack [m]."""
        return (self.rolling_height - height) / math.sin(self.rack.pressure_angle)

    def x_of_radius(self, radius: float) -> float:
        """Place of a contact by its radius on the pinion [m]."""
        return math.sqrt(max(radius**2 - self.pinion.base_radius**2, 0.0)) - self._at_pitch_point

    @property
    def _starts(self) -> tuple[float, float]:
        """Where the rack's tip touches first, and where the pinion's involute starts [m]."""
        tip = self.x_of_height(self.rack.tooth.flank_end * self.rack.module)
        return tip, self.x_of_radius(self.pinion.form_radius)

    @property
    def _ends(self) -> tuple[float, float]:
        """Where the pinion's tip touches last, and where the rack's flank starts [m]."""
        return (
            self.x_of_radius(self.pinion.involute_tip_radius),
            self.x_of_height(self.rack.tooth.form_height * self.rack.module),
        )

    @property
    def x_start(self) -> float:
        """Start of the path of contact [m]: the rack's tip, or what undercut leaves of the pinion's flank."""
        return max(self._starts) if self._undercut else self._starts[0]

    @property
    def x_end(self) -> float:
        """End of the path of contact [m]: the pinion's tip."""
        return self._ends[0]

    @property
    def interference(self) -> tuple[float, float]:
        """How far the rack's tip, and the pinion's, reach beyond the mate's flank along the path [m]; positive is bad.

        A pinion that a tool undercuts has been relieved there: contact starts where its flank does.
        """
        low = -math.inf if self._undercut else self._starts[1] - self._starts[0]
        return low, self._ends[0] - self._ends[1]

    @property
    def contact_ratio(self) -> float:
        """epsilon_alpha."""
        return (self.x_end - self.x_start) / self.rack.base_pitch

    @property
    def overlap_ratio(self) -> float:
        """epsilon_beta; zero of spur teeth."""
        return self.face_width * abs(self.rack.slide) / self.rack.pitch

    @property
    def total_contact_ratio(self) -> float:
        """epsilon_gamma."""
        return self.contact_ratio + self.overlap_ratio

    @property
    def pinion_tip_clearance(self) -> float:
        """From the pinion's tip to the rack's root [m]."""
        return self.distance - self.pinion.tip_radius - self.rack.tooth.root_height * self.rack.module

    @property
    def rack_tip_clearance(self) -> float:
        """From the rack's tip to the pinion's root [m]."""
        return self.distance - self.pinion.root_radius - self.rack.tooth.tip_height * self.rack.module

    @property
    def backlash(self) -> float:
        """j_t, travel of the rack between its flanks with the pinion fixed [m]."""
        y = self.rolling_height / self.rack.module
        space = self.rack.tooth.pitch - 2.0 * float(self.rack.tooth.half_thickness(y))
        tooth = (
            2.0 * float(self.pinion.tooth.flank_angle(self.pinion.tooth.pitch_radius)) * self.pinion.tooth.pitch_radius
        )
        return (space - tooth) * self.rack.module

    @property
    def travel_per_turn(self) -> float:
        """Travel of the rack in one turn of the pinion [m]."""
        return 2.0 * math.pi * self.pinion.pitch_radius

    @property
    def stroke(self) -> float:
        """Travel from the first contact of the first tooth to the last of the last; helical teeth: at mid-face [m]."""
        last = (self.rack.teeth - 1) * self.rack.base_pitch + self.x_end - self.x_start
        return last / math.cos(self.rack.pressure_angle)


def distance_of_backlash(pinion: Gear, rack: Rack, backlash: float) -> float:
    """Distance from the pinion's axis to the rack's reference line at which there is so much backlash [m]."""
    slope = 2.0 * math.tan(rack.pressure_angle)
    half = float(pinion.tooth.flank_angle(pinion.tooth.pitch_radius)) * pinion.tooth.pitch_radius
    tooth_shift = (2.0 * half - 0.5 * rack.tooth.pitch) / slope
    shifts = tooth_shift + rack.tooth.generating_shift
    return pinion.pitch_radius + shifts * rack.module + backlash / slope
