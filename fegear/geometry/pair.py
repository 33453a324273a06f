"""Two gears in mesh: working data, path of contact, contact ratio, interference (ISO 21771, 5.4)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.base.shown import shown, shows
from fegear.geometry.both_flanks import free_arc, touching_distance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute import inv, pressure_angle_of_inv

if TYPE_CHECKING:
    from fegear.geometry.internal_interference import InternalCheck


Member = Literal["driver", "driven"]


MEMBERS: tuple[Member, Member] = ("driver", "driven")


#: What a sentence calls them.
MEMBER_WORDS: dict[str, str] = {"driver": "driver", "driven": "driven gear"}


#: Difference of two involute angles that is none [rad].
_ROUND_OFF = 1e-14


#: By how much a centre distance may fall short of the tight one [modules]: profile shifts are printed with three or
#: four digits, and gears at such values jam by a fraction of a micrometre. The backlash is then reported as negative.
ROUNDED_JAM = 5e-4


@dataclass(frozen=True)
class GearPair:
    """Two gears on parallel axes, spur or helical, one of them internal or none, in the section across the axes.

    x runs along the transverse line of action from the pitch point toward the driver's tip. Lengths and angles without
    "normal" in their name are those of the section; those of spur gears are both. Roll angles and radii of curvature
    carry the sign of their flank: they are negative on the hollow flanks of an internal gear, as its number of teeth is
    in ISO 21771, so that one formula serves both kinds of pairs.

    Parameters
    ----------
    driver, driven : Gear
        The gear that pushes and the one that is pushed.
    centre_distance : float
        Working centre distance [m]; NaN, the default, is replaced by the one that the nominal profile shifts give
        without backlash.
    axial_offset : float
        Height of the driven gear's mid face above the driver's, toward the end from which the driver turns clockwise
        (a ring that drives: counter-clockwise) [m].

    Raises
    ------
    GeometryError
        If both gears are internal, a gear has no fewer teeth than its ring gear, hands, helix angles or base pitches do
        not go together, the teeth jam or never meet, or the faces stand beside each other. Tips of an internal pair
        that meet what they must not leave a pair that can be drawn, not run (`refuse_fouling`).
    """

    driver: Gear
    driven: Gear
    centre_distance: float = shown("mm", "working centre distance", default=math.nan)
    axial_offset: float = 0.0

    def __post_init__(self) -> None:
        """Fill in the centre distance and refuse pairs that cannot run."""
        a, b = self.driver, self.driven
        self._check_hands()
        if a.hand != "spur":
            self._check_helix()
        if abs(a.base_pitch - b.base_pitch) > 1e-9 * a.base_pitch:
            raise GeometryError(
                "pair",
                f"base pitches {a.base_pitch * 1e3:.6g} mm and {b.base_pitch * 1e3:.6g} mm",
                "must be equal for the gears to mesh",
                "use the same module and pressure angle for both gears",
            )
        self._check_back()
        self._check_room_in_ring()
        tight = self.tight_centre_distance
        if math.isnan(self.centre_distance):
            object.__setattr__(self, "centre_distance", self._touching_distance(allowance=False))
        distance = self.centre_distance
        if not (math.isfinite(distance) and distance > 0.0):
            raise GeometryError("centre_distance", distance, "must be positive and finite")
        if self.side * distance < self.side * tight * (1.0 - self.side * 1e-9) - ROUNDED_JAM * a.module:
            raise GeometryError(
                "centre_distance",
                f"{distance * 1e3:.6g} mm",
                f"leaves no backlash: both flanks are in contact at {tight * 1e3:.6g} mm",
                "reduce the centre distance or the profile shifts, or specify a thickness allowance"
                if self.internal
                else "increase the centre distance, reduce the profile shifts or specify a thickness allowance",
            )
        if distance < self._base_radii * (1.0 - 1e-12):
            raise GeometryError(
                "centre_distance",
                f"{distance * 1e3:.6g} mm",
                f"is below the difference of the base radii, {self._base_radii * 1e3:.6g} mm",
                "increase it (no line of action)",
            )
        if self.x_end <= self.x_start:
            raise GeometryError(
                "centre_distance", f"{distance * 1e3:.6g} mm", "is too large: no flank contact", "reduce it"
            )
        if not self.face_width > 1e-3 * min(a.face_width, b.face_width):
            raise GeometryError(
                "axial_offset", f"{self.axial_offset * 1e3:.6g} mm", "leaves no common face width",
                f"reduce it below {0.5e3 * (a.face_width + b.face_width):.6g} mm",
            )  # fmt: skip

    def _check_hands(self) -> None:
        """Refuse two ring gears, and hands that do not mesh on parallel axes."""
        a, b = self.driver, self.driven
        if a.tooth.internal and b.tooth.internal:
            raise GeometryError(
                "internal", "true of both gears", "not possible: an internal gear must mesh with an external gear"
            )
        opposite = {a.hand, b.hand} == {"left", "right"}
        if {a.hand, b.hand} != {"spur"} and opposite == self.internal:
            hands = "equal hands in an internal pair" if self.internal else "opposite hands"
            raise GeometryError(
                "hand",
                f"{a.hand} driver, {b.hand} driven",
                f"parallel axes require {hands}, or two spur gears",
                "change the hand of one gear",
            )

    def _check_back(self) -> None:
        """Refuse asymmetric teeth whose other flanks do not go together: they would jam, or wedge."""
        if not self.asymmetric:
            return
        a, b = self.driver.from_the_back, self.driven.from_the_back
        if abs(a.base_pitch - b.base_pitch) > 1e-9 * a.base_pitch:
            angles = [f"{math.degrees(gear.normal_pressure_angle):.6g} deg" for gear in (a, b)]
            raise GeometryError(
                "coast_pressure_angle", " and ".join(angles), "must be equal for the non-working flanks to mesh",
                "use the same pressure angles for both gears",
            )  # fmt: skip

    def _check_room_in_ring(self) -> None:
        """Refuse a gear that is as large as the ring gear in which it is to run."""
        planet, ring = sorted((self.driver.tooth, self.driven.tooth), key=lambda tooth: tooth.internal)
        if ring.internal and planet.teeth >= ring.teeth:
            raise GeometryError(
                "teeth", planet.teeth, f"must be below the {ring.teeth} of the ring gear in which the gear runs",
                "reduce it, or give the ring gear more teeth",
            )  # fmt: skip

    def refuse_fouling(self) -> None:
        """Refuse gears inside ring gears whose tips meet what they must not: they can be drawn, not run.

        Raises
        ------
        GeometryError
            With the tip diameter that clears.
        """
        for one in self.internal_checks:
            if one.fouls(self.driver.module):
                raise GeometryError(
                    "pair", one.of_pinion.name,
                    f"is not possible: {one.of_pinion.trouble}, by {-one.margin * self.driver.module * 1e3:.4g} mm",
                    self.clearing or "change profile shifts, centre distance or numbers of teeth",
                )  # fmt: skip

    @cached_property
    def clearing(self) -> str:
        """How tips of an internal pair are cut so that none meets material; empty where none does, or no cut helps."""
        if not any(one.fouls(self.driver.module) for one in self.internal_checks):
            return ""
        from fegear.geometry.internal_interference import clearing_tips

        planet, ring = sorted((self.driver, self.driven), key=lambda gear: gear.tooth.internal)
        if not isinstance(planet.tooth, Tooth) or not isinstance(ring.tooth, InternalTooth):
            return ""
        tips = clearing_tips(planet.tooth, ring.tooth, self.centre_distance / ring.module)
        if tips is None:
            return ""
        step, found = 1e5, []  # hundredths of a millimetre, to the safe side
        if tips.planet is not None:
            found.append(f"of the pinion to {math.floor(2.0 * tips.planet * planet.module * step) / step * 1e3:.2f} mm")
        if tips.ring is not None:
            found.append(f"of the ring gear to {math.ceil(2.0 * tips.ring * ring.module * step) / step * 1e3:.2f} mm")
        return f"set tip_diameter {' and '.join(found)}"

    def _check_helix(self) -> None:
        """Refuse helical gears that are cut by different racks."""
        for key in ("module", "normal_pressure_angle", "helix_angle"):
            mine, other = getattr(self.driver, key), getattr(self.driven, key)
            if abs(mine - other) > 1e-12 * max(abs(mine), abs(other)):
                raise GeometryError(
                    "normal_module" if key == "module" else key,
                    f"{mine:.9g} (driver), {other:.9g} (driven)",
                    "must be equal by design",
                    "use the same normal module, pressure angle and helix angle for both gears",
                )

    @property
    def side(self) -> int:
        """1 for an external pair, -1 for an internal one."""
        return self.driver.tooth.side * self.driven.tooth.side

    @property
    def internal(self) -> bool:
        """Whether one of the gears is internal: both then turn the same way."""
        return self.side < 0

    @cached_property
    def internal_checks(self) -> tuple[InternalCheck, ...]:
        """Where a gear inside a ring gear may foul it; none for an external pair."""
        planet, ring = sorted((self.driver, self.driven), key=lambda gear: gear.tooth.internal)
        if not ring.tooth.internal:
            return ()
        from fegear.geometry.internal_interference import internal_checks

        distance = self.centre_distance / ring.module
        found = internal_checks(planet.tooth, ring.tooth, distance)
        if not self.asymmetric:
            return found
        back = internal_checks(planet.tooth.back, ring.tooth.back, distance)
        return tuple(
            replace(one, name=f"{one.name} ({tooth.working_flank or 'other'} flanks)")
            for tooth, checks in ((planet.tooth, found), (planet.tooth.back, back)) for one in checks
        )  # fmt: skip

    @property
    def _base_radii(self) -> float:
        """Sum of the base radii, or their difference in an internal pair [m]."""
        return abs(self.driver.base_radius + self.side * self.driven.base_radius)

    def _working_angle(self, *, allowance: bool) -> float:
        a, b = self.driver.symmetric_tooth, self.driven.symmetric_tooth
        shifts = a.generating_shift + b.generating_shift if allowance else a.profile_shift + b.profile_shift
        teeth = a.side * a.teeth + b.side * b.teeth
        value = float(inv(a.pressure_angle)) + 2.0 * shifts * math.tan(a.normal_pressure_angle) / teeth
        if value <= 0.0:
            raise GeometryError(
                "profile_shift",
                f"sum {shifts:.6g}",
                f"is too {'large' if self.internal else 'negative'}: no working pressure angle",
            )
        return float(pressure_angle_of_inv(value))

    @cached_property
    def tight_centre_distance(self) -> float:
        """Centre distance at which both flanks touch [m] (ISO 21771, 5.4.4)."""
        return self._touching_distance(allowance=True)

    @property
    def asymmetric(self) -> bool:
        """Whether the two flanks of a gear's teeth differ."""
        return self.driver.asymmetric or self.driven.asymmetric

    @cached_property
    def from_the_back(self) -> GearPair:
        """The pair with its other flanks loaded, as it runs under reversed torque; itself, where they are equal."""
        if not self.asymmetric:
            return self
        return replace(self, driver=self.driver.from_the_back, driven=self.driven.from_the_back)

    def _touching_distance(self, *, allowance: bool) -> float:
        if self.asymmetric:
            return touching_distance(self.driver.tooth, self.driven.tooth, allowance=allowance) * self.driver.module
        return self._base_radii / math.cos(self._working_angle(allowance=allowance))

    @cached_property
    @shows("deg", "working pressure angle")
    def working_pressure_angle(self) -> float:
        """alpha_wt [rad]."""
        return math.acos(min(self._base_radii / self.centre_distance, 1.0))

    @cached_property
    @shows("deg", "working helix angle")
    def working_helix_angle(self) -> float:
        """beta_w on the working pitch cylinders [rad]: tan(beta_w) = tan(beta_b) / cos(alpha_wt)."""
        return math.atan(math.tan(self.driver.base_helix_angle) / math.cos(self.working_pressure_angle))

    @property
    @shows("mm", "backlash normal to the flanks")
    def normal_backlash(self) -> float:
        """j_bn, gap between the back flanks along their normal when the front flanks touch [m] (ISO 21771, 5.4.6)."""
        if self.asymmetric:
            one, other, back = self.driver.tooth, self.driven.tooth, self.from_the_back
            arc = free_arc(one, other, self.centre_distance / self.driver.module) * self.driver.module
            if abs(arc) < _ROUND_OFF * self.centre_distance:
                return 0.0
            return arc * math.cos(back.working_pressure_angle) * math.cos(back.driver.base_helix_angle)
        turn = float(inv(self.working_pressure_angle)) - float(inv(self._working_angle(allowance=True)))
        if abs(turn) < _ROUND_OFF:  # the centre distance that leaves none: no backlash, not -8e-15 mm
            return 0.0
        along = self.side * 2.0 * self._base_radii * turn  # the transverse line of action
        return along * math.cos(self.driver.base_helix_angle)

    @property
    def free_backlash(self) -> float:
        """Way of the driven gear back along the transverse line of action until back flanks touch [m].

        Zero for gears that jam by the rounding of their profile shifts (`ROUNDED_JAM`).
        """
        if self.asymmetric:
            return max(self.circumferential_backlash, 0.0) * math.cos(self.working_pressure_angle)
        return max(self.normal_backlash, 0.0) / math.cos(self.driver.base_helix_angle)

    @property
    @shows("mm", "backlash on the working pitch circle")
    def circumferential_backlash(self) -> float:
        """j_wt, the same as an arc of the working pitch circles [m]: j_bn / (cos(alpha_wt) cos(beta_b)) of the back."""
        back = self.from_the_back
        return self.normal_backlash / (math.cos(back.working_pressure_angle) * math.cos(back.driver.base_helix_angle))

    @property
    @shows("mm", "base pitch")
    def base_pitch(self) -> float:
        """p_bt [m], the distance of successive contacts along the line of action."""
        return self.driver.base_pitch

    @property
    def ratio(self) -> float:
        """Gear ratio u = z_driven / z_driver."""
        return self.driven.teeth / self.driver.teeth

    @property
    def pinion(self) -> Member:
        """The gear with fewer teeth; of equal ones that with more profile shift, and of equal shifts the driver."""
        sizes = [(gear.teeth, -gear.tooth.profile_shift) for gear in (self.driver, self.driven)]
        return "driver" if sizes[0] <= sizes[1] else "driven"

    def tangential_load(self, load: float) -> float:
        """F_t at the reference circles of a load F_bt along the transverse line of action, which loads are here [N].

        One torque is F_t r = F_bt r_b. Formulas of ISO 6336-1 to -3 take F_t, contact and deflection F_bt; the load
        normal to a helical flank is F_bt / cos(beta_b), and per length of contact line again F_bt / b.
        """
        return load * self.driver.base_radius / self.driver.pitch_radius

    def specific_load(self, load: float) -> float:
        """F_t / b of ISO 6336 [N/m] under a load F_bt along the transverse line of action [N]."""
        return self.tangential_load(load) / self.face_width

    def gear(self, member: Member) -> Gear:
        """Driver or driven."""
        return self.driver if member == "driver" else self.driven

    def mate(self, member: Member) -> Gear:
        """The gear that it meshes with."""
        return self.driven if member == "driver" else self.driver

    def _curvature_at_pitch(self, member: Member) -> float:
        gear = self.gear(member)
        return gear.tooth.side * gear.base_radius * math.tan(self.working_pressure_angle)

    def flank_curvature_radius(self, x: ArrayLike, member: Member) -> Array:
        """Radius of curvature rho = r_b tan(alpha_w) +- x of a flank at x [m]; linear in x, negative where hollow."""
        sign = 1.0 if member == "driver" else -1.0
        return self._curvature_at_pitch(member) + sign * np.asarray(x, dtype=float)

    def roll_angle(self, x: ArrayLike, member: Member) -> Array:
        """Roll angle [rad] of a gear's contact point at x [m]."""
        return self.flank_curvature_radius(x, member) / self.gear(member).base_radius

    def radius(self, x: ArrayLike, member: Member) -> Array:
        """Radius [m] of a gear's contact point at x [m]."""
        return self.place_of_length(self.flank_curvature_radius(x, member), member)

    def place_of_length(self, length: ArrayLike, member: Member) -> Array:
        """Radius [m] at which a gear has a roll length [m]."""
        return np.hypot(self.gear(member).base_radius, np.asarray(length, dtype=float))

    def x_of_radius(self, radius: ArrayLike, member: Member) -> Array:
        """Contact position x [m] at which a gear touches at `radius` [m]."""
        gear, sign = self.gear(member), 1.0 if member == "driver" else -1.0
        r, rb = np.asarray(radius, dtype=float), gear.base_radius
        return sign * (gear.tooth.side * np.sqrt((r - rb) * (r + rb)) - self._curvature_at_pitch(member))

    def x_of_roll(self, roll: ArrayLike, member: Member) -> Array:
        """Contact position x [m] at which a gear touches at a roll angle [rad]."""
        sign = 1.0 if member == "driver" else -1.0
        length = np.asarray(roll, dtype=float) * self.gear(member).base_radius
        return np.asarray(sign * (length - self._curvature_at_pitch(member)))

    @cached_property
    def x_start(self) -> float:
        """Start of the path of contact [m], negative: the driven tip, or the driver's form circle if higher."""
        by_tip = float(self.x_of_radius(self.driven.involute_tip_radius, "driven"))
        by_form = float(self.x_of_radius(self.driver.form_radius, "driver"))
        return max(by_tip, by_form)

    @cached_property
    def x_end(self) -> float:
        """End of the path of contact [m]: the driver's tip, or the driven gear's form circle where that ends first."""
        by_tip = float(self.x_of_radius(self.driver.involute_tip_radius, "driver"))
        by_form = float(self.x_of_radius(self.driven.form_radius, "driven"))
        return min(by_tip, by_form)

    @property
    @shows("mm", "length of the path of contact")
    def path_length(self) -> float:
        """g_alpha [m]."""
        return self.x_end - self.x_start

    @property
    @shows("", "transverse contact ratio")
    def contact_ratio(self) -> float:
        """Transverse contact ratio epsilon_alpha."""
        return self.path_length / self.base_pitch

    @property
    def face_width(self) -> float:
        """Common face width, where both faces overlap [m]."""
        low, high = self._common_face
        return high - low

    @property
    def _common_face(self) -> tuple[float, float]:
        """Its ends above the middle of the driver's face [m]."""
        one, other, up = 0.5 * self.driver.face_width, 0.5 * self.driven.face_width, self.axial_offset
        return max(-one, up - other), min(one, up + other)

    def face_height(self, member: Member) -> float:
        """Height of the middle of the common face above that of a gear's own face [m]."""
        low, high = self._common_face
        return 0.5 * (low + high) - (0.0 if member == "driver" else self.axial_offset)

    @property
    @shows("", "overlap ratio, faces centred")
    def overlap_ratio(self) -> float:
        """epsilon_beta: how many pitches the helix advances over the common face; zero for spur gears."""
        return self.face_width * abs(self.driver.twist) / self.driver.angular_pitch

    @property
    @shows("", "total contact ratio")
    def total_contact_ratio(self) -> float:
        """epsilon_gamma = epsilon_alpha + epsilon_beta."""
        return self.contact_ratio + self.overlap_ratio

    @property
    def x_lpstc(self) -> float:
        """Lowest point of single tooth contact of the driver [m] (contact ratio between 1 and 2)."""
        return self.x_end - self.base_pitch

    @property
    def x_hpstc(self) -> float:
        """Highest point of single tooth contact of the driver [m] (contact ratio between 1 and 2)."""
        return self.x_start + self.base_pitch

    def tip_clearance(self, member: Member) -> float:
        """Room between the tip circle of `member` and the root circle of its mate [m]."""
        mate = self.driven if member == "driver" else self.driver
        own = self.gear(member)
        tip, root = own.tooth.side * own.tip_radius, mate.tooth.side * mate.root_radius
        return self.side * self.centre_distance - tip - root

    def reversed(self) -> GearPair:
        """The same gears with driver and driven exchanged; x changes sign."""
        return GearPair(self.driven, self.driver, self.centre_distance, -self.axial_offset)
