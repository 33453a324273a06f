"""Profile shift from a tooth thickness, and from what a gauge reads: the other way round of `inspection`.

Every reading names one number, the generating profile shift coefficient x_E: the thickness of the tooth on its base
circle follows from it, and every reading from that thickness (ISO 21771, 5.6). Lengths are in normal modules.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.base.errors import GeometryError
from fegear.geometry.involute import inv
from fegear.geometry.rack import BasicRack, transverse_angle


@dataclass(frozen=True, slots=True)
class ToothNumbers:
    """What is known of a tooth before its thickness is.

    Parameters
    ----------
    teeth : int
    normal_pressure_angle : float
        alpha_n [rad].
    helix_angle : float
        beta on the reference cylinder [rad].
    internal : bool
    """

    teeth: int
    normal_pressure_angle: float
    helix_angle: float = 0.0
    internal: bool = False

    @property
    def side(self) -> int:
        """1 of an external tooth, -1 of an internal one."""
        return -1 if self.internal else 1

    @property
    def pitch_radius(self) -> float:
        """r [modules]."""
        return 0.5 * self.teeth / math.cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return transverse_angle(self.normal_pressure_angle, self.helix_angle)

    @property
    def base_radius(self) -> float:
        """r_b [modules]."""
        return self.pitch_radius * math.cos(self.transverse_pressure_angle)

    @property
    def base_helix_cosine(self) -> float:
        """cos(beta_b)."""
        return math.cos(math.atan(math.tan(self.helix_angle) * math.cos(self.transverse_pressure_angle)))

    def shift_of_thickness(self, thickness: float) -> float:
        """x_E of the normal tooth thickness on the reference cylinder [modules]."""
        return (thickness - 0.5 * math.pi) / (2.0 * math.tan(self.normal_pressure_angle))

    def shift_of_base_angle(self, half_angle: float) -> float:
        """x_E of half the tooth's angle on the base circle [rad]."""
        on_pitch = half_angle - self.side * float(inv(self.transverse_pressure_angle))
        return self.shift_of_thickness(on_pitch * self.teeth)

    def shift_of_span(self, span: float, spanned: int) -> float:
        """x_E of the base tangent length W_k over k teeth [modules]."""
        pitches = math.pi * math.cos(self.normal_pressure_angle) * (spanned - 1)
        return self.shift_of_base_angle((span - pitches) / self.base_helix_cosine / (2.0 * self.base_radius))

    def shift_over_balls(
        self, dimension: float, ball: float, *, opposite: bool = False, key: str = "over_balls"
    ) -> float:
        """x_E of a dimension over balls, of an internal gear between them [modules].

        Parameters
        ----------
        dimension : float
        ball : float
            D_M.
        opposite : bool
            Whether the balls stand opposite each other for odd numbers of teeth as well: pins in the spaces of a
            helical gear do, each where it reaches highest (M_dR).
        key : str
            Name of the dimension in messages.

        Raises
        ------
        GeometryError
            If the balls stand within the base circle, as no involute lets them.
        """
        centre = 0.5 * (dimension - self.side * ball)
        if self.teeth % 2 and not opposite:
            centre /= math.cos(0.5 * math.pi / self.teeth)
        if not centre > self.base_radius:
            between = math.cos(0.5 * math.pi / self.teeth) if self.teeth % 2 and not opposite else 1.0
            least = 2.0 * self.base_radius * between + self.side * ball
            raise GeometryError(
                key, f"{dimension:.6g}",
                f"puts the balls within the base circle: must exceed {least:.6g} modules",
                "check the dimension and the ball_diameter",
            )  # fmt: skip
        angle = math.acos(self.base_radius / centre)
        space = 0.5 * ball / self.base_helix_cosine / self.base_radius - self.side * float(inv(angle))
        return self.shift_of_base_angle(math.pi / self.teeth - space)

    def least_shift(self, rack: BasicRack) -> float:
        """x_E from which on the tip of a rack cuts nothing off the involute (ISO 21771, 5.2)."""
        alpha = self.transverse_pressure_angle
        reach = rack.tip_centre_depth + rack.tip_radius * math.sin(rack.pressure_angle)
        return reach - self.base_radius * math.sin(alpha) * math.tan(alpha)

    @property
    def virtual_radius(self) -> float:
        """Reference radius of the virtual spur gear in the normal section, r / cos(beta)^2 [modules]."""
        return self.pitch_radius / math.cos(self.helix_angle) ** 2

    def shift_of_chord(self, chord: float) -> float:
        """x_E of the chordal thickness on the reference cylinder, normal to the helix [modules]."""
        half = 0.5 * chord / self.virtual_radius
        if not 0.0 < half < 1.0:
            raise GeometryError(
                "chordal_thickness", f"{chord:.6g}",
                f"must be below the reference diameter, {2.0 * self.virtual_radius:.6g} modules",
            )  # fmt: skip
        return self.shift_of_thickness(2.0 * self.virtual_radius * math.asin(half))

    def shift_of_chord_at(self, chord: float, height: float, tip_radius: float) -> float:
        """x_E of a chordal thickness at a height below the tip circle [modules].

        The teeth of a helical gear are those of its virtual spur gear, as drawings have it.

        Parameters
        ----------
        chord, height, tip_radius : float
        """
        radius = self.virtual_radius
        along = radius + tip_radius - self.pitch_radius - height
        base = radius * math.cos(self.normal_pressure_angle)
        at = math.hypot(along, 0.5 * chord)
        if not (along > 0.0 and at > base):
            raise GeometryError(
                "chordal_height", f"{height:.6g}", "lies below the base circle, where no involute is",
                "check the height and the tip_diameter",
            )  # fmt: skip
        half = math.atan2(0.5 * chord, along) + float(inv(math.acos(base / at)))
        return self.shift_of_thickness(2.0 * radius * (half - float(inv(self.normal_pressure_angle))))

    def chord(self, generating_shift: float) -> tuple[float, float]:
        """Chordal thickness on the reference cylinder, and how far its middle lies below that cylinder [modules]."""
        thickness = 0.5 * math.pi + 2.0 * generating_shift * math.tan(self.normal_pressure_angle)
        half = 0.5 * thickness / self.virtual_radius
        return 2.0 * self.virtual_radius * math.sin(half), self.virtual_radius * (1.0 - math.cos(half))
