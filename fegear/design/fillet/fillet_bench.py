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
from fegear.design.fillet.shared_bottom import BothFillets
from fegear.fem.plane.settings import MeshSettings, settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.asymmetric_fillets import with_fillets
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.fillet_shapes import FilletShape
from fegear.geometry.flank_above import FlankAbove
from fegear.geometry.gear import Gear
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.pair import Member
from fegear.geometry.shaped_side import ShapedSide

if TYPE_CHECKING:
    from fegear.fem.plane.root_stress import FilletCurve

#: What is to be small: the largest tension, or half the range from it to the largest compression of the other fillet,
#: as teeth have it that are loaded on both flanks (idlers, planets).
Objective = Literal["tension", "alternating"]
#: Roll positions of a search, and points of a fillet that are looked at for room and curvature.
_POSITIONS, _LOOKED_AT, _CORNERS = 24, 193, 1201
#: Room that a fillet gains for each module below the deepest place of a mating tip: a jump there would stop searches.
_BELOW = 20.0
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
    stress : ndarray, shape (S,) or (2 S,)
        Along it, the largest over the mesh [Pa]; of both fillets, one behind the other.
    room : ndarray
        What is left of its limits.
    fillets : int
        1 or 2.
    """

    stress: Array
    room: Array
    fillets: int = 1

    @property
    def each(self) -> Array:
        """Largest stress of each fillet, shape (fillets,) [Pa]."""
        return self.stress.reshape(self.fillets, -1).max(axis=1)


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
    other : FilletBench, optional
        Of the same gear in the pair that loads its other flanks, as of a planet between sun and ring; by default that
        is loaded as this one. With asymmetric teeth, whose other fillet that pair pulls, both fillets are judged.
    """

    engagement: Engagement
    load: float
    member: Member
    limits: Limits = field(default_factory=Limits)
    objective: Objective = "tension"
    settings: MeshSettings = field(default_factory=search_settings)
    other: FilletBench | None = None
    tried: int = 0

    def __post_init__(self) -> None:
        """Share the loads, and follow the mating tip, once for all fillets."""
        e = self.engagement
        self.states: LoadedStates = loaded_states(e, (), (self.load,), roll_positions(e, _POSITIONS))
        self.gear: Gear = e.pair.gear(self.member)
        self.corner = mating_corner(e, self.member)

    @property
    def generated(self) -> InvoluteSide:
        """The tooth as its tool makes it."""
        tooth = self.gear.tooth
        return tooth.as_generated if isinstance(tooth, ShapedSide) else tooth

    @property
    def both(self) -> bool:
        """Whether two different fillets are judged."""
        return self.other is not None and self.gear.asymmetric

    @property
    def active_roll(self) -> float:
        """Roll angle at which a mating tip touches the flank [rad]: there it must have begun."""
        if self.other is not None and not self.both:
            return min(self._active_roll, self.other.active_roll, key=abs)
        return self._active_roll

    @property
    def _active_roll(self) -> float:
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

    def tooth(self, shape: FilletShape | BothFillets) -> InvoluteSide:
        """The gear's tooth with a fillet, of asymmetric teeth on this side or on both; raises `GeometryError`."""
        tooth = self.gear.tooth
        if not self.gear.asymmetric:
            return with_fillet(self.generated, shape)  # type: ignore[arg-type]  # a tooth that a tool generates
        flank = tooth.working_flank
        shapes = {flank: shape.own, tooth.back.working_flank: shape.back} if isinstance(shape, BothFillets) else {
            flank: shape
        }  # fmt: skip
        return with_fillets(tooth, **shapes)  # type: ignore[arg-type]  # an asymmetric one

    def judged(self, tooth: InvoluteSide) -> Judged:
        """Stress along the fillet and what is left of the limits."""
        return Judged(self.along(tooth), self.room(tooth), 1 + self.both)

    def largest(self, tooth: InvoluteSide) -> float:
        """Largest stress by the objective [Pa]."""
        return float(self.along(tooth).max())

    def along(self, tooth: InvoluteSide) -> Array:
        """Stress by the objective along the fillet, the largest over the mesh under the present loads, (S,) [Pa].

        Of both fillets (2 S,): the other one behind this one.
        """
        self.tried += 1
        known = [
            finite_element_compliance(
                solve_gear(replace(self.gear, tooth=side), self.settings, reach=self.reach, estimate_error=False)
            )
            for side in ((tooth, tooth.back) if self.both else (tooth,))
        ]
        return self.stress(*known)

    @property
    def reach(self) -> int:
        """Neighbours that a tooth is coupled to."""
        own = max(self.engagement.compliance.source(self.member).reach, 1)
        return own if self.other is None else max(own, self.other.reach)

    def stress(self, known: FiniteElementCompliance, of_back: FiniteElementCompliance | None = None) -> Array:
        """The same of a tooth that was solved, of asymmetric teeth in two meshes also as seen from its other flank.

        A fillet is pulled by loads on its flank and pressed by those on the other one: with another pair the larger of
        both fillets counts.
        """
        other = self.other
        tension = self._extreme(known, "tension").max(axis=0)
        beside = known if of_back is None else of_back
        pulled = tension if other is None else other._extreme(beside, "tension").max(axis=0)  # noqa: SLF001  (one class)
        if self.objective == "tension":
            return np.concatenate([tension, pulled]) if self.both else np.maximum(tension, pulled)
        pressed = self._extreme(known, "compression").min(axis=0)
        squeezed = pressed if other is None else other._extreme(beside, "compression").min(axis=0)  # noqa: SLF001  (one class)
        ranges = tension - squeezed, pulled - pressed
        return np.asarray(0.5 * (np.concatenate(ranges) if self.both else np.maximum(*ranges)))

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

    def room(self, tooth: InvoluteSide) -> Array:
        """What is left of the clearance [modules], of smallest radius and rise (relative), (2 P,); negative: broken.

        With `Limits.generated` also what is left of the tool's outline, relative, (P,). Of both fillets one behind the
        other.
        """
        if self.both and self.other is not None:
            back = self.other._room(tooth.back, [self.other.corner])  # noqa: SLF001  (one class)
            return np.concatenate([self._room(tooth, [self.corner]), back])
        corners = [self.corner] if self.other is None else [self.corner, self.other.corner]
        return self._room(tooth, corners)

    def _room(self, tooth: InvoluteSide, corners: list[tuple[Array, Array]]) -> Array:
        """The same of one fillet, below the flank that a tooth is seen from."""
        fillet = tooth.fillet
        u = np.linspace(fillet.start, fillet.end, _LOOKED_AT)
        x, y = fillet.points(u)
        radius, polar = np.hypot(x, y), np.arctan2(x, y)
        polar += self.gear.tooth.base_half_angle - tooth.base_half_angle  # as paths are seen
        share = (radius[-1] - radius) / (radius[-1] - radius[0])
        height = tooth.side * radius
        gaps = [
            (np.interp(height, *corner) - polar) * radius + _BELOW * np.maximum(corner[0][0] - height, 0.0)
            for corner in corners
        ]
        gap = np.minimum.reduce(gaps) - self.limits.clearance * share
        sharp = 1.0 - self.limits.smallest_radius * np.abs(fillet.curvatures(u))
        rise = np.gradient(height) / np.hypot(np.gradient(x), np.gradient(y))  # one that comes back is no fillet
        sharp = np.minimum(sharp, rise)
        made = [conjugate_rack(tooth).room(self.limits.smallest_tool_radius)] if self.limits.generated else []
        return np.concatenate([np.minimum(gap[:-1], 1.0), sharp, *made])

    def rack_room(self, tooth: InvoluteSide) -> float:
        """Least that is left of the outline of the rack that generates the fillet, or both, relative."""
        sides = (tooth, tooth.back) if self.both else (tooth,)
        return min(float(conjugate_rack(side).room(self.limits.smallest_tool_radius).min()) for side in sides)


def mating_corner(e: Engagement, member: Member) -> tuple[Array, Array]:
    """Nearest path of the mating tip's corner: heights, ascending, and angles from the centre line of the tooth.

    The tooth's right flank is the one in contact.

    Returns
    -------
    heights : ndarray
        Radii, of an internal gear times -1 [modules].
    angles : ndarray
        [rad].

    Notes
    -----
    With e from a gear's centre to where the line of action touches its base circle and n out of its flank, the contact
    lies at r_b (e + t n), t its roll angle, and a flank's point of roll angle t' where it has turned on by t - t':

        r_b (e' + t' n'),   e' = e cos(t - t') + n sin(t - t'),   n' = n cos(t - t') - e sin(t - t').

    The mate's frame has -n for n, and for e the opposite direction, or the same one where a gear is internal.
    """
    pair = e.pair
    mate, own = pair.gear("driven" if member == "driver" else "driver"), pair.gear(member)
    side, inner = own.tooth.side, -1.0 if own.tooth.side * mate.tooth.side < 0 else 1.0
    along = inner * pair.centre_distance * math.sin(pair.working_pressure_angle)
    tip = mate.tooth.side * math.sqrt(
        (mate.involute_tip_radius - mate.base_radius) * (mate.involute_tip_radius + mate.base_radius)
    ) / mate.base_radius  # fmt: skip
    middle = float(pair.roll_angle(0.0, member))
    t = middle + np.linspace(-1.2, 1.2, _CORNERS) * 2.0 * math.pi / own.teeth
    turn = (along - own.base_radius * t) / mate.base_radius - tip
    # In the frame of e and n of the gear: the mate's centre, and its corner.
    mate_e, mate_n = -inner, -1.0
    at_e = own.base_radius - mate_e * mate.base_radius + mate.base_radius * mate_e * (np.cos(turn) - tip * np.sin(turn))
    at_n = along + mate.base_radius * mate_n * (np.sin(turn) + tip * np.cos(turn))
    phi = own.tooth.base_half_angle - t
    x, y = at_e * np.sin(phi) + at_n * np.cos(phi), at_e * np.cos(phi) - at_n * np.sin(phi)
    height, polar = side * np.hypot(x, y) / own.module, np.arctan2(x, y)
    low = int(np.argmin(height))
    grid = np.linspace(height[low], min(height[0], height[-1]), _CORNERS)
    one = np.interp(grid, height[low::-1], polar[low::-1])
    return grid, np.minimum(one, np.interp(grid, height[low:], polar[low:]))
