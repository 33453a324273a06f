"""The numbers of a gear, alone and in mesh, that stand in the corner of a drawing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from fegear.base.errors import GeometryError
from fegear.base.shown import shown, shows
from fegear.geometry.checks import tip_thickness
from fegear.geometry.gear import Gear
from fegear.geometry.inspection import chord, span, usual_span
from fegear.geometry.over_balls import OverBalls, over_balls, touching_ball, usual_ball
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.path_of_contact import ActiveProfile, active_profile, specific_sliding


def measured(gear: Gear, ball_diameter: float | None = None) -> OverBalls | None:
    """Dimension over the given balls, or over usual ones; None where no ball touches the flanks."""
    if ball_diameter is not None:
        return over_balls(gear, ball_diameter)
    for diameter in (usual_ball(gear), touching_ball(gear)):
        try:
            return over_balls(gear, diameter)
        except GeometryError:
            continue
    return None


@dataclass(frozen=True)
class GearData:
    """A gear as on its drawing; numbers that do not apply are nan, those that no gear beside it has are None.

    Parameters
    ----------
    gear : Gear
    helical : bool
        Whether it stands beside helical gears, or is one.
    ball_diameter_given : float or None
        [m].
    span_teeth_given : int or None
    amounts : mapping of str to float
        What is ground off the flanks [m], by the attributes below; zero where only gears beside it have some.
    name : str
    """

    gear: Gear
    helical: bool
    ball_diameter_given: float | None
    span_teeth_given: int | None
    amounts: Mapping[str, float]
    name: str = shown("", "name of the gear", name="gear")

    @property
    @shows("", "number of teeth z")
    def teeth(self) -> int:
        """Positive, of ring gears too."""
        return self.gear.teeth

    @property
    @shows("mm", "module m")
    def module(self) -> float:
        """Normal module [m]."""
        return self.gear.module

    @property
    @shows("deg", "pressure angle α")
    def pressure_angle(self) -> float:
        """Normal pressure angle [rad]."""
        return self.gear.normal_pressure_angle

    @property
    @shows("deg", "helix angle β")
    def helix_angle(self) -> float | None:
        """[rad]."""
        return self.gear.helix_angle if self.helical else None

    @property
    @shows("", "hand of the helix")
    def hand(self) -> str | None:
        """Right or left."""
        return self.gear.hand if self.helical else None

    @property
    @shows("mm", "lead p_z")
    def lead(self) -> float | None:
        """[m]."""
        return self.gear.lead if self.helical else None

    @property
    @shows("mm", "transverse module m_t")
    def transverse_module(self) -> float | None:
        """[m]."""
        return self.gear.transverse_module if self.helical else None

    @property
    @shows("deg", "transverse pressure angle α_t")
    def transverse_pressure_angle(self) -> float | None:
        """[rad]."""
        return self.gear.transverse_pressure_angle if self.helical else None

    @property
    @shows("deg", "base helix angle β_b")
    def base_helix_angle(self) -> float | None:
        """[rad]."""
        return self.gear.base_helix_angle if self.helical else None

    @property
    @shows("deg", "pressure angle of the non-working flank")
    def back_pressure_angle(self) -> float | None:
        """Of asymmetric teeth [rad]."""
        return self.gear.from_the_back.normal_pressure_angle if self.gear.asymmetric else None

    @property
    @shows("mm", "base diameter of the non-working flank")
    def back_base_diameter(self) -> float | None:
        """[m]."""
        return 2.0 * self.gear.from_the_back.base_radius if self.gear.asymmetric else None

    @property
    @shows("mm", "root form diameter of the non-working flank")
    def back_root_form_diameter(self) -> float | None:
        """[m]."""
        return 2.0 * self.gear.from_the_back.form_radius if self.gear.asymmetric else None

    @property
    @shows("", "profile shift coefficient x")
    def profile_shift(self) -> float:
        """x."""
        return self.gear.tooth.profile_shift

    @property
    @shows("mm", "face width b")
    def face_width(self) -> float:
        """[m]."""
        return self.gear.face_width

    @property
    @shows("mm", "reference diameter d")
    def reference_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.gear.pitch_radius

    @property
    @shows("mm", "base diameter d_b")
    def base_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.gear.base_radius

    @property
    @shows("mm", "tip diameter d_a")
    def tip_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.gear.tip_radius

    @property
    @shows("mm", "root diameter d_f")
    def root_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.gear.root_radius

    @property
    @shows("mm", "root form diameter d_Ff")
    def root_form_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.gear.form_radius

    @property
    @shows("mm", "tip form diameter d_Fa")
    def tip_form_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.gear.involute_tip_radius

    @property
    @shows("mm", "tooth thickness s at d")
    def tooth_thickness(self) -> float:
        """Normal to the helix [m]."""
        return float(self.gear.normal_thickness(self.gear.pitch_radius))

    @property
    @shows("mm", "tooth thickness at d_Fa")
    def tip_thickness(self) -> float:
        """Normal to the helix [m]."""
        return tip_thickness(self.gear)

    @property
    @shows("", "teeth in the span k")
    def span_teeth(self) -> float:
        """k."""
        return math.nan if self.spanned is None else self.spanned[0]

    @property
    @shows("mm", "span W_k")
    def span(self) -> float:
        """[m]."""
        return math.nan if self.spanned is None else self.spanned[1]

    @property
    @shows("mm", "ball or pin D_M")
    def ball_diameter(self) -> float:
        """[m]."""
        return math.nan if self.over is None else self.over.ball_diameter

    @property
    @shows("mm", "over balls or pins M_dK")
    def over_balls(self) -> float:
        """Over balls of external gears, between those of internal ones [m]."""
        return math.nan if self.over is None else self.over.dimension

    @property
    @shows("mm", "over pins M_dR")
    def over_pins(self) -> float | None:
        """Over pins, each where it stands highest [m]; not of spur gears, where it is M_dK."""
        return None if not self.helical else math.nan if self.over is None else self.over.over_pins

    @property
    @shows("mm", "chordal tooth thickness at d")
    def chordal_thickness(self) -> float:
        """Normal to the helix [m]; nan of internal gears."""
        return self.chord[0]

    @property
    @shows("mm", "height of that chord from d_a")
    def chordal_height(self) -> float:
        """[m]."""
        return self.chord[1]

    @property
    @shows("um", "tip relief C_αa")
    def tip_relief(self) -> float | None:
        """[m]."""
        return self.amounts.get("tip_relief")

    @property
    @shows("um", "root relief C_αf")
    def root_relief(self) -> float | None:
        """[m]."""
        return self.amounts.get("root_relief")

    @property
    @shows("um", "profile crowning C_α")
    def profile_crowning(self) -> float | None:
        """[m]."""
        return self.amounts.get("profile_crowning")

    @property
    @shows("um", "crowning of the lead C_β")
    def crowning(self) -> float | None:
        """[m]."""
        return self.amounts.get("crowning")

    @property
    @shows("um", "helix slope modification C_Hβ")
    def helix_slope(self) -> float | None:
        """[m]."""
        return self.amounts.get("helix_slope")

    @property
    @shows("um", "end relief at end I")
    def end_relief_I(self) -> float | None:
        """[m]."""
        return self.amounts.get("end_relief_I")

    @property
    @shows("um", "end relief at end II")
    def end_relief_II(self) -> float | None:
        """[m]."""
        return self.amounts.get("end_relief_II")

    @property
    @shows("um", "twist S_α")
    def bias(self) -> float | None:
        """[m]."""
        return self.amounts.get("bias")

    @cached_property
    def spanned(self) -> tuple[int, float] | None:
        """Teeth of the given or usual span, and its length [m]; None where no span can be measured."""
        if self.span_teeth_given is not None:
            return self.span_teeth_given, span(self.gear, self.span_teeth_given)
        return usual_span(self.gear)

    @cached_property
    def chord(self) -> tuple[float, float]:
        """Chordal thickness on the reference cylinder, and its height from the tip circle [m]."""
        return chord(self.gear)

    @cached_property
    def over(self) -> OverBalls | None:
        """Measured over the given balls, or over usual ones."""
        return measured(self.gear, self.ball_diameter_given)


#: Amounts that a drawing states, in its order.
MODIFICATIONS = (
    "tip_relief", "root_relief", "profile_crowning", "crowning", "helix_slope", "end_relief_I", "end_relief_II", "bias",
)  # fmt: skip


@dataclass(frozen=True)
class MeshData:
    """What a drawing says of one gear of a pair in mesh."""

    pair: GearPair
    member: Member

    @cached_property
    def profile(self) -> ActiveProfile:
        """Radii of its active profile [m]."""
        return active_profile(self.pair, self.member)

    @property
    @shows("mm", "start of active profile d_Nf")
    def active_root_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.profile.start

    @property
    @shows("mm", "lowest single contact (LPSTC)")
    def lpstc_diameter(self) -> float:
        """[m]; nan where no pair is alone in contact."""
        return 2.0 * self.profile.lowest_single

    @property
    @shows("mm", "highest single contact (HPSTC)")
    def hpstc_diameter(self) -> float:
        """[m]; nan where no pair is alone in contact."""
        return 2.0 * self.profile.highest_single

    @property
    @shows("mm", "end of active profile d_Na")
    def active_tip_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.profile.end

    @property
    @shows("mm", "tip clearance c")
    def tip_clearance(self) -> float:
        """[m]."""
        return self.pair.tip_clearance(self.member)

    @property
    @shows("", "specific sliding ζ at A")
    def specific_sliding_start(self) -> float:
        """At the start of the path of contact."""
        return float(specific_sliding(self.pair, self.pair.x_start, self.member))

    @property
    @shows("", "specific sliding ζ at E")
    def specific_sliding_end(self) -> float:
        """At the end of the path of contact."""
        return float(specific_sliding(self.pair, self.pair.x_end, self.member))
