"""Two external gears with asymmetric teeth in mesh: the paths of contact of both flanks, and the backlash between them.

The drive flanks of both gears touch each other, or the coast flanks do. For each the mesh is that of an involute pair
of the flank's own base circles (ISO 21771, 5.4); the two have the same pitch circles, for both divide the centre
distance by the numbers of teeth. Lengths are in normal modules, in the section across the axes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from fegear.base.errors import GeometryError
from fegear.geometry.asymmetric_tooth import AsymmetricSide, AsymmetricTooth
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import FLANKS, Flank

#: Difference of base pitches that is none [modules].
_SAME = 1e-9
#: By how much a centre distance may fall short of the tight one [modules], as of `GearPair`.
_ROUNDED_JAM = 5e-4


@dataclass(frozen=True)
class AsymmetricPair:
    """Two external gears with asymmetric teeth on parallel axes.

    Parameters
    ----------
    driver, driven : AsymmetricTooth
        The drive flank of one touches the drive flank of the other.
    centre_distance : float
        [modules]; NaN, the default, is replaced by the one that the nominal profile shifts give without backlash.

    Raises
    ------
    GeometryError
        If base pitches differ, the teeth jam, or a pair of flanks never meets.
    """

    driver: AsymmetricTooth
    driven: AsymmetricTooth
    centre_distance: float = math.nan

    def __post_init__(self) -> None:
        """Fill in the centre distance and refuse pairs that cannot run."""
        for flank in FLANKS:
            a, b = (tooth.side(flank).base_pitch for tooth in (self.driver, self.driven))
            if abs(a - b) > _SAME:
                raise GeometryError(
                    "pair",
                    f"base pitches {a:.6g} and {b:.6g} modules of the {flank} flanks",
                    "must be equal for the gears to mesh",
                    "use the same pressure angles for both gears",
                )
        if math.isnan(self.centre_distance):
            nominal = self._distance(self.driver.profile_shift + self.driven.profile_shift)
            object.__setattr__(self, "centre_distance", nominal)
        distance = self.centre_distance
        if not (math.isfinite(distance) and distance > 0.0):
            raise GeometryError("centre_distance", distance, "must be positive and finite")
        tight = self.tight_centre_distance
        if distance < tight * (1.0 - 1e-9) - _ROUNDED_JAM:
            raise GeometryError(
                "centre_distance",
                f"{distance:.6g} modules",
                f"leaves no backlash: both flanks are in contact at {tight:.6g} modules",
                "increase the centre distance, reduce the profile shifts or specify a thickness allowance",
            )
        for flank in FLANKS:
            if not self.x_end(flank) > self.x_start(flank):
                rule = f"is too large: no contact of the {flank} flanks"
                raise GeometryError("centre_distance", f"{distance:.6g} modules", rule, "reduce it")

    def _base_radii(self, flank: Flank) -> float:
        return self.driver.side(flank).base_radius + self.driven.side(flank).base_radius

    def _distance(self, shifts: float) -> float:
        """Centre distance without backlash of a sum of profile shifts.

        The thickness of both teeth on the working pitch circles is the pitch there: the sum of inv(alpha_w) over both
        flanks exceeds that of inv(alpha) by 2 (x1 + x2) (tan alpha_drive + tan alpha_coast) / (z1 + z2).
        """
        from scipy.optimize import brentq

        rack = self.driver.rack
        tangents = math.tan(rack.drive.pressure_angle) + math.tan(rack.coast.pressure_angle)
        own = sum(float(inv(self.driver.side(flank).pressure_angle)) for flank in FLANKS)
        wanted = own + 2.0 * shifts * tangents / (self.driver.teeth + self.driven.teeth)

        def excess(distance: float) -> float:
            angles = (math.acos(min(self._base_radii(flank) / distance, 1.0)) for flank in FLANKS)
            return sum(float(inv(angle)) for angle in angles) - wanted

        least = max(self._base_radii(flank) for flank in FLANKS)
        if excess(least) > 0.0:
            rule = "is too negative: no working pressure angle"
            raise GeometryError("profile_shift", f"sum {shifts:.6g}", rule)
        return float(brentq(excess, least, 4.0 * least, xtol=1e-14, rtol=9e-16))

    @cached_property
    def tight_centre_distance(self) -> float:
        """Centre distance at which both pairs of flanks touch [modules]."""
        return self._distance(self.driver.generating_shift + self.driven.generating_shift)

    def working_pressure_angle(self, flank: Flank) -> float:
        """alpha_wt of a pair of flanks [rad]."""
        return math.acos(min(self._base_radii(flank) / self.centre_distance, 1.0))

    @property
    def circumferential_backlash(self) -> float:
        """j_wt, arc of the working pitch circles that is free [modules]; the same whichever flanks touch."""
        unit = self.centre_distance / (self.driver.teeth + self.driven.teeth)
        free = 2.0 * math.pi
        for tooth in (self.driver, self.driven):
            for flank in FLANKS:
                angle = tooth.side(flank).base_half_angle - float(inv(self.working_pressure_angle(flank)))
                free -= tooth.teeth * angle
        return unit * free

    def gap(self, flank: Flank) -> float:
        """Gap between a pair of flanks along their transverse line of action while the others touch [modules]."""
        return self.circumferential_backlash * math.cos(self.working_pressure_angle(flank))

    # ---- along the path of contact ---------------------------------------------------------------------------------
    def _ends(self, flank: Flank, low: AsymmetricSide, high: AsymmetricSide) -> float:
        """Distance from the pitch point at which contact of `high` ends at its tip, or at the other's form circle."""
        working = math.tan(self.working_pressure_angle(flank))
        tip = float(high.roll(high.involute_tip_radius)) * high.base_radius - high.base_radius * working
        form = low.base_radius * working - float(low.roll(low.form_radius)) * low.base_radius
        return min(tip, form)

    def x_start(self, flank: Flank) -> float:
        """Start of contact, from the pitch point along the line of action toward the driver's tip [modules]."""
        return -self._ends(flank, self.driver.side(flank), self.driven.side(flank))

    def x_end(self, flank: Flank) -> float:
        """End of contact [modules]."""
        return self._ends(flank, self.driven.side(flank), self.driver.side(flank))

    def contact_ratio(self, flank: Flank) -> float:
        """epsilon_alpha, transverse contact ratio of a pair of flanks."""
        return (self.x_end(flank) - self.x_start(flank)) / self.driver.side(flank).base_pitch

    @property
    def reversed(self) -> AsymmetricPair:
        """The pair with the flanks of both gears exchanged: it drives with what was the coast flank."""
        return AsymmetricPair(self.driver.reversed, self.driven.reversed, self.centre_distance)
