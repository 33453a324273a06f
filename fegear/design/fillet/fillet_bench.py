"""What fillets of one gear of a loaded pair are judged by: root stress over the mesh under loads that stay, and room.

While fillets are tried, loads on the teeth are those of the present pair: another fillet changes compliance by percents
and shares by less. The final numbers are those of the pair with its new fillet, loaded anew.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.compliance import Side
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import FiniteElementCompliance, finite_element_compliance
from fegear.contact.plane.root_stress import RootStress
from fegear.contact.plane.root_stress_history import superposed_stress, touching_radius
from fegear.contact.plane.tooth_stress import LoadedStates, loaded_states
from fegear.design.fillet.fillet_limits import Limits
from fegear.fem.plane.settings import MeshSettings, settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.fillet_shapes import FilletShape, FlankAbove
from fegear.geometry.gear import Gear
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.pair import Member
from fegear.geometry.shaped_tooth import ShapedTooth, with_fillet

if TYPE_CHECKING:
    from fegear.fem.plane.root_stress import FilletCurve

#: What is to be small: the largest tension, or half the range from it to the largest compression of the other fillet,
#: as teeth have it that are loaded on both flanks (idlers, planets).
Objective = Literal["tension", "alternating"]
#: Roll positions of a search, and points of a fillet that are looked at for room and curvature.
_POSITIONS, _LOOKED_AT, _CORNERS = 24, 193, 1201
#: Shares of the fillet's length at which its stress is followed.
SHARES = np.linspace(0.02, 1.0, 65)
#: Levels of settings of a search: of the mesh as a whole, and of the fillet's edges. These must follow any fillet: with
#: coarse ones a search finds what the mesh does not see (6 % of root stress at level -5).
_LEVEL, _FILLET_LEVEL = -5.0, -1.0


def search_settings() -> MeshSettings:
    """Mesh of a search: stress of any fillet within 0.3 %, differences of neighbours far better."""
    fine = settings_at(_FILLET_LEVEL)
    return replace(settings_at(_LEVEL), root_edge_length=fine.root_edge_length, root_fraction=fine.root_fraction)


@dataclass(frozen=True)
class Judged:
    """What a fillet does.

    Parameters
    ----------
    stress : ndarray, shape (S,)
        Along it, the largest over the mesh [Pa].
    room : ndarray
        What is left of its limits.
    """

    stress: Array
    room: Array


@dataclass
class FilletBench:
    """Judges fillets of one gear in a loaded pair.

    Parameters
    ----------
    engagement : Engagement
        The present pair.
    load : float
        [N].
    member : {"driver", "driven"}
    limits : Limits
    objective : {"tension", "alternating"}
    settings : MeshSettings
    """

    engagement: Engagement
    load: float
    member: Member
    limits: Limits = field(default_factory=Limits)
    objective: Objective = "tension"
    settings: MeshSettings = field(default_factory=search_settings)
    tried: int = 0

    def __post_init__(self) -> None:
        """Share the loads, and follow the mating tip, once for all fillets."""
        e = self.engagement
        self.states: LoadedStates = loaded_states(e, (), (self.load,), roll_positions(e, _POSITIONS))
        self.gear: Gear = e.pair.gear(self.member)
        self.corner = mating_corner(e, self.member)

    @property
    def generated(self) -> InvoluteTooth:
        """The tooth as its tool makes it."""
        tooth = self.gear.symmetric_tooth
        return tooth.generated if isinstance(tooth, ShapedTooth) else tooth

    @property
    def active_roll(self) -> float:
        """Roll angle at which the mating tip touches the flank [rad]: there it must have begun."""
        pair = self.engagement.pair
        other: Member = "driven" if self.member == "driver" else "driver"
        x = pair.x_of_radius(pair.gear(other).involute_tip_radius, other)
        return float(pair.roll_angle(x, self.member))

    def flank(self, root_radius: float) -> FlankAbove:
        """What fillets are fitted below."""
        tooth = self.generated
        return FlankAbove(
            tooth.base_radius, tooth.base_half_angle, tooth.side, math.pi / tooth.teeth, root_radius, tooth.form_radius
        )

    def tooth(self, shape: FilletShape) -> InvoluteTooth:
        """The gear's tooth with a fillet; raises `GeometryError`."""
        return with_fillet(self.generated, shape)  # type: ignore[arg-type]  # a tooth that a tool generates

    def judged(self, tooth: InvoluteTooth) -> Judged:
        """Stress along the fillet and what is left of the limits."""
        return Judged(self.along(tooth), self.room(tooth))

    def largest(self, tooth: InvoluteTooth) -> float:
        """Largest stress by the objective [Pa]."""
        return float(self.along(tooth).max())

    def along(self, tooth: InvoluteTooth) -> Array:
        """Stress by the objective along the fillet, the largest over the mesh under the present loads, (S,) [Pa]."""
        self.tried += 1
        gear, source = replace(self.gear, tooth=tooth), self.engagement.compliance.source(self.member)
        solved = solve_gear(gear, self.settings, reach=max(source.reach, 1), estimate_error=False)
        return self.stress(finite_element_compliance(solved))

    def stress(self, known: FiniteElementCompliance) -> Array:
        """The same of a tooth that was solved."""
        tension = self._extreme(known, "tension").max(axis=0)
        if self.objective == "tension":
            return tension
        return np.asarray(0.5 * (tension - self._extreme(known, "compression").min(axis=0)))

    def _extreme(self, source: FiniteElementCompliance, side: Side) -> Array:
        """Stress at all positions of a tooth in the mesh, shape (positions, S) [Pa]."""
        roots, state = RootStress.of(self.engagement.compliance, self.member, side, source), self.states.rows[0]
        curve = cast("FilletCurve", roots.curve(0))
        touched = touching_radius(state, self.member, 1)
        found = [
            curve.along(stress[:, 0].T, SHARES, radius[:, 0]).T
            for stress, radius in zip(
                superposed_stress(self.engagement, state, self.member, side, 1, source), touched, strict=True
            )
        ]  # fmt: skip
        return np.concatenate(found)

    def room(self, tooth: InvoluteTooth) -> Array:
        """What is left of the clearance [modules] and of the smallest radius (relative), (2 P,); negative: broken.

        With `Limits.generated` also what is left of the tool's outline, relative, (P,).
        """
        fillet = tooth.fillet
        u = np.linspace(fillet.start, fillet.end, _LOOKED_AT)
        x, y = fillet.points(u)
        radius, polar = np.hypot(x, y), np.arctan2(x, y)
        share = (radius[-1] - radius) / (radius[-1] - radius[0])
        gap = (np.interp(radius, *self.corner, left=polar[0] + 1.0) - polar) * radius - self.limits.clearance * share
        sharp = 1.0 - self.limits.smallest_radius * np.abs(fillet.curvatures(u))
        made = [conjugate_rack(tooth).room(self.limits.smallest_tool_radius)] if self.limits.generated else []
        return np.concatenate([np.minimum(gap[:-1], 1.0), sharp, *made])


def mating_corner(e: Engagement, member: Member) -> tuple[Array, Array]:
    """Nearest path of the mating tip's corner: ascending radii [modules], angles from the tooth's centre line [rad].

    The tooth's right flank is the one in contact; external gears.
    """
    pair = e.pair
    mate, own = pair.gear("driven" if member == "driver" else "driver"), pair.gear(member)
    a, base, tip = pair.centre_distance, mate.base_radius, mate.involute_tip_radius
    roll = math.sqrt((tip - base) * (tip + base)) / base
    working = pair.working_pressure_angle
    inv = math.tan(working) - working
    theta = np.linspace(-1.2, 1.2, _CORNERS) * 2.0 * math.pi / mate.teeth
    angle = (roll - math.atan(roll)) - inv - theta
    px, py = tip * np.sin(angle), a - tip * np.cos(angle)
    turn = theta * mate.teeth / own.teeth + own.symmetric_tooth.base_half_angle - inv
    c, s = np.cos(turn), np.sin(turn)
    x, y = c * px + s * py, c * py - s * px
    radius, polar = np.hypot(x, y) / own.module, np.arctan2(x, y)
    low = int(np.argmin(radius))
    grid = np.linspace(radius[low], min(radius[0], radius[-1]), _CORNERS)
    one = np.interp(grid, radius[low::-1], polar[low::-1])
    return grid, np.minimum(one, np.interp(grid, radius[low:], polar[low:]))
