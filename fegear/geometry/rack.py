"""The basic rack tooth profile that generates a gear (ISO 53), in modules."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.base.errors import GeometryError
from fegear.base.given import given

#: ISO 53:1998, Table 1: addendum, dedendum, root fillet radius (in modules) of the profiles A to D.
ISO_53 = {"A": (1.0, 1.25, 0.38), "B": (1.0, 1.25, 0.30), "C": (1.0, 1.25, 0.25), "D": (1.0, 1.40, 0.39)}


@dataclass(frozen=True, slots=True)
class BasicRack:
    """Basic rack tooth profile: what the tool that cuts the gear looks like, counted from the gear's side.

    For a helical gear this is the rack's normal section, and a module the normal module; see `Tooth`.

    Parameters
    ----------
    addendum : float
        h_aP, the gear tooth's addendum [modules].
    dedendum : float
        h_fP, the gear tooth's dedendum [modules]; the tool reaches this far below its reference line.
    tip_radius : float
        rho_fP, radius of the tool's tip rounding [modules]; it generates the trochoidal fillet.
    pressure_angle : float
        alpha_P [rad].
    protuberance : float
        pr, by which the tool's tip stands out of its flank, normal to it [modules].
    grinding_allowance : float
        q, stock that is ground off the flanks, but not out of the root [modules]; at most the protuberance.
    protuberance_angle : float
        Pressure angle of the protuberance's flank [rad], from 1 deg to 1 deg below the pressure angle.

    Raises
    ------
    GeometryError
        If a value lies outside its range or the tool's tip rounding is wider than the tool's tip.
    """

    addendum: float = given(meaning="Basic rack addendum h_aP* [modules].", default=1.0)
    dedendum: float = given(meaning="Basic rack dedendum h_fP* [modules].", default=1.25)
    tip_radius: float = 0.25
    pressure_angle: float = math.radians(20.0)
    protuberance: float = given(
        meaning="Protuberance pr [modules]; with grinding stock q (`grinding_allowance`) the undercut of the root is "
        "pr - q.",
        default=0.0,
    )
    grinding_allowance: float = given(meaning="Grinding stock (machining allowance) q [modules].", default=0.0)
    protuberance_angle: float = given("angle", "Angle of the protuberance flank.", default=math.radians(10.0))

    def __post_init__(self) -> None:
        """Refuse profiles that no tool can have."""
        for name in self.__slots__:
            if not math.isfinite(getattr(self, name)):
                raise GeometryError(f"rack.{name}", getattr(self, name), "must be finite")
        if not math.radians(5.0) <= self.pressure_angle <= math.radians(45.0):
            raise GeometryError(
                "rack.pressure_angle", f"{math.degrees(self.pressure_angle):.6g} deg", "must be between 5 and 45 deg"
            )
        if not self.addendum > 0.0:
            raise GeometryError("rack.addendum", self.addendum, "must be positive (in modules)", "1.0 is usual")
        if not self.dedendum > 0.0:
            raise GeometryError("rack.dedendum", self.dedendum, "must be positive (in modules)", "1.25 is usual")
        if self.tip_radius < 0.0:
            raise GeometryError("rack.tip_radius", self.tip_radius, "must not be negative", "0.25 or 0.38 is usual")
        self._check_protuberance()
        if self.tip_centre_offset < -1e-12:
            fits = self.full_fillet_radius
            if fits <= 0.0:
                raise GeometryError(
                    "rack.dedendum",
                    self.dedendum,
                    "gives a pointed rack tooth",
                    f"use at most {math.pi / 4 / math.tan(self.pressure_angle):.4f} modules",
                )
            fits = math.floor(fits * 1e6) * 1e-6  # never given as more than what is accepted
            raise GeometryError(
                "rack.tip_radius",
                self.tip_radius,
                f"exceeds the maximum of {fits:.6f} modules (full fillet)",
                f"choose a tip radius of at most {fits:.6f} or a smaller dedendum",
            )
        if self.tip_radius > self.dedendum:
            raise GeometryError("rack.tip_radius", self.tip_radius, "must not exceed the dedendum")

    def _check_protuberance(self) -> None:
        for name in ("protuberance", "grinding_allowance"):
            if getattr(self, name) < 0.0:
                raise GeometryError(f"rack.{name}", getattr(self, name), "must not be negative")
        if self.grinding_allowance > self.protuberance:
            raise GeometryError(
                "rack.grinding_allowance",
                self.grinding_allowance,
                f"exceeds the protuberance of {self.protuberance:.6g} modules (grinding step)",
                "specify a protuberance at least as large",
            )
        if self.protuberance == 0.0:
            return
        degrees = math.degrees(self.protuberance_angle)
        if not 1.0 - 1e-9 <= degrees <= math.degrees(self.pressure_angle) - 1.0 + 1e-9:
            raise GeometryError(
                "rack.protuberance_angle",
                f"{degrees:.6g} deg",
                "must be between 1 deg and 1 deg below the pressure angle",
                '"10 deg" is usual',
            )
        if self.residual_undercut >= self.tip_radius:
            raise GeometryError(
                "rack.protuberance", self.protuberance, f"exceeds the tip radius of {self.tip_radius:.6g}",
                "reduce the protuberance or increase the tip radius",
            )  # fmt: skip

    @classmethod
    def named(cls, name: str, pressure_angle: float = math.radians(20.0)) -> BasicRack:
        """Return the ISO 53 profile A, B, C or D (also "ISO 53 A")."""
        letter = name.upper().removeprefix("ISO").strip().removeprefix("53").strip(" .-_")
        if letter not in ISO_53:
            raise GeometryError("rack", f'"{name}"', "is not an ISO 53 profile", 'choose "A", "B", "C" or "D"')
        return cls(*ISO_53[letter], pressure_angle)

    @classmethod
    def full_fillet(
        cls,
        addendum: float = 1.0,
        dedendum: float = 1.25,
        pressure_angle: float = math.radians(20.0),
        protuberance: float = 0.0,
        grinding_allowance: float = 0.0,
        protuberance_angle: float = math.radians(10.0),
    ) -> BasicRack:
        """Return the rack whose tip is one arc: the largest tip radius that fits."""
        plain = cls(addendum, dedendum, 0.0, pressure_angle).full_fillet_radius
        cut = protuberance - grinding_allowance
        radius = plain + max(cut, 0.0) / (1.0 - math.sin(pressure_angle))
        return cls(addendum, dedendum, radius, pressure_angle, protuberance, grinding_allowance, protuberance_angle)

    @property
    def residual_undercut(self) -> float:
        """s_pr = pr - q, by which the root is cut deeper than the finished flank [modules] (ISO 6336-3, 6.2)."""
        return self.protuberance - self.grinding_allowance

    @property
    def full_fillet_radius(self) -> float:
        """Largest tip radius that fits between the rack's flanks [modules]."""
        a = self.pressure_angle
        room = math.pi / 4 - self.dedendum * math.tan(a) + self.residual_undercut / math.cos(a)
        return room * math.cos(a) / (1.0 - math.sin(a))

    @property
    def tip_centre_offset(self) -> float:
        """Distance of the tip rounding's centre from the rack tooth's centre line [modules], 0 for a full fillet."""
        a = self.pressure_angle
        flank = math.pi / 4 - self.dedendum * math.tan(a) + self.residual_undercut / math.cos(a)
        return flank - self.tip_radius * (1.0 - math.sin(a)) / math.cos(a)

    @property
    def tip_centre_depth(self) -> float:
        """Depth of the tip rounding's centre below the reference line [modules]."""
        return self.dedendum - self.tip_radius


def transverse_angle(normal_angle: float, helix_angle: float) -> float:
    """Angle of a straight rack flank in the transverse section [rad]: tan(alpha_t) = tan(alpha_n) / cos(beta).

    Parameters
    ----------
    normal_angle : float
        alpha_n [rad].
    helix_angle : float
        beta on the reference cylinder [rad]; zero gives the normal angle itself, to the last bit.
    """
    if helix_angle == 0.0:
        return normal_angle
    return math.atan(math.tan(normal_angle) / math.cos(helix_angle))
