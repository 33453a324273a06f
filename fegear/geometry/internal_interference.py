"""Where an external gear inside a ring gear fouls it: tips in roots, tips that part, assembly, the cutter's feed.

Every check is geometry of the two teeth in the section across the axes, lengths in normal modules.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Arc, Curve
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, leaving_margin
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.involute_tooth import InvoluteTooth

#: Turns of a pair that are looked at for the least room, and how often more closely; points of a fillet, and of a
#: tip's chamfer or rounding.
_TURNS, _CLOSER, _FILLET, _EDGE = 257, 4, 1025, 9
#: Less than this is no interference [m]: what tips wear off, and circles printed with three digits leave.
MEETS = 1e-6
#: Halvings of a range of tip radii.
_HALVINGS = 40


@dataclass(frozen=True, slots=True)
class InternalCheck:
    """One way in which an external gear and a ring gear may foul each other.

    Parameters
    ----------
    name : str
    margin : float
        Room that is left [modules]; negative where material meets, infinite where nothing can meet.
    trouble : str
        What happens where it is negative.
    refused : bool
        Whether a pair without room cannot run; otherwise its path of contact is shorter, or it is made or put together
        in another way.
    """

    name: str
    margin: float
    trouble: str
    refused: bool

    def sentence(self, module: float) -> str:
        """What a designer should know of it, with the margin [m at `module`]."""
        if self.margin >= 0.0:
            return f"{self.name}: clearance {self.margin * module * 1e3:.4g} mm"
        return f"{self.name}: {self.trouble}, by {-self.margin * module * 1e3:.4g} mm"

    def fouls(self, module: float) -> bool:
        """Whether a pair of this module [m] cannot run: material meets by a micrometre or more."""
        return self.refused and self.margin * module <= -MEETS

    @property
    def of_pinion(self) -> InternalCheck:
        """The same with the external gear called pinion, which it is where no planetary set is meant."""
        return replace(
            self, name=self.name.replace("planet", "pinion"), trouble=self.trouble.replace("planet", "pinion")
        )


class TipCorner(NamedTuple):
    """The end of a tooth's flank at its tip: a point, or a rounding about one [modules, rad from the centre line]."""

    radius: float
    angle: float
    rounding: float


def internal_checks(planet: InvoluteSide, ring: InvoluteSide, distance: float) -> tuple[InternalCheck, ...]:
    """Every check of an external gear inside a ring gear.

    Parameters
    ----------
    planet : InvoluteSide
        The external gear, called planet here, seen from the flank that touches.
    ring : InvoluteSide
        Internal; the feed of its cutter is checked where it has one.
    distance : float
        Between the axes [modules].

    Raises
    ------
    GeometryError
        If the line of action does not touch both base circles.

    Notes
    -----
    Tips count as sharp where contact of an involute with a fillet and the parting of tips are checked, which is on the
    safe side of rounded ones; what passes a fillet is the tip as it is, with its chamfer or rounding. A tip that
    reaches below the start of an undercut flank may find room there. One that touches the
    mate on its involute alone may still cut its fillet on the way there: of a ring cut by few teeth the fillet stands
    further out than a planet of many teeth leaves room for.
    """
    base1, base3 = planet.base_radius, ring.base_radius
    if not 0.0 < base3 - base1 < distance:
        raise GeometryError(
            "centre_distance", f"{distance:.6g} modules", "must exceed "
                                                          f"{base3 - base1:.6g} "
                                                          "modules, and the "
                                                          "base circle of "
                                                          "the ring must "
                                                          "exceed that of "
                                                          "the planet", "increase it, or check the numbers of teeth",
        )  # fmt: skip
    along = math.sqrt((distance - base3 + base1) * (distance + base3 - base1))  # between the feet on the base circles
    tip1, tip3 = planet.tip_radius, ring.tip_radius
    rho1, rho3 = math.sqrt(tip1**2 - base1**2), math.sqrt(tip3**2 - base3**2)
    passed = leaving_margin((planet.teeth, tip1, base1), (ring.teeth, tip3, base3), distance)
    past_ring, past_planet = _past_fillets(planet, ring, distance)
    checks = (
        InternalCheck("tip clearance of the planet", ring.root_radius - distance - tip1,
                      "interference with the root circle of the ring", refused=True),
        InternalCheck("tip clearance of the ring", tip3 - distance - planet.root_radius,
                      "interference with the root circle of the planet", refused=True),
        InternalCheck("ring tip, planet root", rho3 - along - float(planet.base_radius * planet.involute.start),
                      "ring tip interferes with the planet fillet; path of contact shortened", refused=False),
        InternalCheck("planet tip in ring fillet", ring.form_radius - math.hypot(base3, along + rho1),
                      "planet tip interferes with the ring fillet; path of contact shortened", refused=False),
        InternalCheck("ring tip corner, planet fillet", past_planet,
            "interference with the fillet", refused=True),
        InternalCheck("planet tip corner, ring fillet", past_ring,
            "interference with the fillet", refused=True),
        InternalCheck("trochoidal tip interference", passed / ring.teeth * tip3,
                      "tips of planet and ring interfere outside the path of contact", refused=True),
    )  # fmt: skip
    if not isinstance(planet, InvoluteTooth) or not isinstance(ring, InvoluteTooth):
        return checks  # what stands in the middle of a space does so for equal flanks only
    radial = InternalCheck(
        "radial assembly", radial_room(_tip_corner(planet), planet.teeth, ring, distance),
        "radial assembly of the planet is not possible at every angle; assemble axially", refused=False,
    )  # fmt: skip
    return (*checks, radial, _infeed(ring)) if isinstance(ring, InternalTooth) else (*checks, radial)


def _infeed(ring: InternalTooth) -> InternalCheck:
    """Whether the cutter of a ring gear can be fed straight across the axis."""
    count = ring.cutter.teeth
    return InternalCheck(
        "infeed of the cutter",
        radial_room(TipCorner(*ring.cutter_tip_corner), count, ring, ring.generating_distance),
        f"radial infeed of a cutter with {count} teeth trims the ring tips (infeed interference); use fewer cutter "
        "teeth or a different infeed", refused=False,
    )  # fmt: skip


class ClearingTips(NamedTuple):
    """Tip radii [modules] with which a pair runs; None where the tip stays as it is."""

    planet: float | None
    ring: float | None


def clearing_tips(planet: Tooth, ring: InternalTooth, distance: float) -> ClearingTips | None:
    """The shortest cut of one tip, or of both where one does not do, with which no material meets.

    Parameters
    ----------
    planet : Tooth
    ring : InternalTooth
    distance : float
        Between the axes [modules].

    Returns
    -------
    ClearingTips or None
        None where no tip circle that leaves an active flank does.
    """

    def room(one: Tooth, other: InternalTooth) -> float:
        return min(check.margin for check in internal_checks(one, other, distance) if check.refused)

    def cut_ring(one: Tooth) -> float | None:
        return _shortest_cut(lambda r: room(one, replace(ring, tip_radius=r)), ring.tip_radius, ring.form_radius)

    def cut_planet(other: InternalTooth) -> float | None:
        return _shortest_cut(lambda r: room(replace(planet, tip_radius=r), other), planet.tip_radius,
                             max(planet.form_radius, planet.base_radius))  # fmt: skip

    own, others = cut_planet(ring), cut_ring(planet)
    if own is not None and (others is None or planet.tip_radius - own <= others - ring.tip_radius):
        return ClearingTips(own, None)
    if others is not None:
        return ClearingTips(None, others)
    for share in (0.25, 0.5, 0.75):
        try:
            shorter = planet.tip_radius - share * (planet.tip_radius - max(planet.form_radius, planet.base_radius))
            rest = cut_ring(replace(planet, tip_radius=shorter))
        except GeometryError:
            continue
        if rest is not None:
            return ClearingTips(shorter, rest)
    return None


def _shortest_cut(room: Callable[[float], float], tip: float, limit: float) -> float | None:
    """Tip radius nearest to the present one with which there is room, by halves; None where there is none."""

    def clears(radius: float) -> bool:
        try:
            return room(radius) >= 0.0
        except GeometryError:
            return False

    far = next((r for r in (tip + share * (limit - tip) for share in (0.02, 0.1, 0.25, 0.5, 0.8)) if clears(r)), None)
    if far is None:
        return None
    near = tip
    for _ in range(_HALVINGS):
        middle = 0.5 * (near + far)
        near, far = (near, middle) if clears(middle) else (middle, far)
    return far


def largest_cutter(made: Callable[[int], InternalTooth], teeth: int) -> InternalTooth | None:
    """The ring gear as the largest cutter makes it that trims none of its tips, fed straight across the axis too.

    Parameters
    ----------
    made : callable
        The ring gear by the number of teeth of its cutter; raises `GeometryError` where that cannot make it.
    teeth : int
        Of the ring gear.

    Returns
    -------
    InternalTooth or None
        None where no cutter of five teeth or more does.
    """
    for count in range(teeth - 3, 4, -1):
        try:
            ring = made(count)
        except GeometryError:
            continue
        if radial_room(TipCorner(*ring.cutter_tip_corner), count, ring, ring.generating_distance) >= 0.0:
            return ring
    return None


def _tip_corner(tooth: InvoluteTooth) -> TipCorner:
    edge = tooth.tip_edge
    if isinstance(edge, Arc):
        x, y = edge.centre
        return TipCorner(math.hypot(x, y), math.atan2(x, y), edge.radius)
    return TipCorner(tooth.tip_radius, float(tooth.half_thickness_angle(tooth.tip_radius)), 0.0)


def _edge(tooth: InvoluteSide) -> tuple[Array, Array]:
    """Radii [modules] and angles from the centre line [rad] of a tip's corner, (1, 1), or along its edge, (n, 1)."""
    edge = tooth.tip_edge
    if edge is None:
        return np.full((1, 1), tooth.tip_radius), np.full((1, 1), float(tooth.flank_angle(tooth.tip_radius)))
    x, y = edge.points(np.linspace(edge.start, edge.end, _EDGE)[:, None])
    return np.hypot(x, y), np.arctan2(x, y)


def radial_room(corner: TipCorner, teeth: int, ring: InvoluteTooth, distance: float) -> float:
    """Least room between a gear's tips and those of a ring when it leaves the mesh straight across the axis [modules].

    Parameters
    ----------
    corner : TipCorner
        Of the gear.
    teeth : int
        Of the gear.
    ring : InvoluteTooth
    distance : float
        Between the axes in mesh [modules].

    Returns
    -------
    float
        Over all angles at which the pair may stand, in the middle of its backlash; infinite where no tip of the gear
        stands behind one of the ring.

    Notes
    -----
    The gear moves along the line between the axes, so a tip passes if it stands nearer to that line than the ring's
    tip in front of it. At an inner least the two move alike, which is the condition sin^2 t_1 = (1 - (cos a_a1 / cos
    a_a3)^2) / (1 - (z_1/z_3)^2) of books on ring gears.
    """
    ratio, tip3 = teeth / ring.teeth, ring.tip_radius
    space = math.pi / ring.teeth - float(ring.half_thickness_angle(tip3))

    def room(turn: Array) -> Array:
        own, other = turn + corner.angle, turn * ratio + space
        behind = (distance + corner.radius * np.cos(own) > tip3 * np.cos(other)) & (own < 0.5 * math.pi)
        across = tip3 * np.sin(other) - corner.radius * np.sin(own) - corner.rounding
        return np.where(behind, across, np.inf)

    return _least(room, 0.0, 0.5 * math.pi)


def _least(room: Callable[[Array], Array], low: float, high: float) -> float:
    """Least value of a function of the turn between two turns, looked at more and more closely."""
    turns = np.linspace(low, high, _TURNS)
    for _ in range(_CLOSER):
        at, step = float(turns[int(np.argmin(room(turns)))]), float(turns[1] - turns[0])
        turns = np.linspace(max(at - step, low), min(at + step, high), _TURNS)
    return float(np.min(room(turns)))


def _past_fillets(planet: InvoluteSide, ring: InvoluteSide, distance: float) -> tuple[float, float]:
    """Least room between a tip's path and the mating fillet: planet's past the ring's, ring's past the planet's.

    The planet's tooth stands `turn` ahead of the line between the axes, its leading flank on the ring's.
    """
    inv_working = float(inv(math.acos((ring.base_radius - planet.base_radius) / distance)))
    ratio = planet.teeth / ring.teeth
    front, ahead = planet.base_half_angle - inv_working, ring.base_half_angle + inv_working
    (tip1, own), (tip3, other) = _edge(planet), _edge(ring)

    def of_planet(turn: Array) -> tuple[Array, Array]:
        x, y = distance + tip1 * np.cos(turn + own), tip1 * np.sin(turn + own)
        return np.hypot(x, y), (turn + front) * ratio + ahead - np.arctan2(y, x)

    def of_ring(turn: Array) -> tuple[Array, Array]:
        at = (turn + front) * ratio + ahead - other
        x, y = tip3 * np.cos(at) - distance, tip3 * np.sin(at)
        return np.hypot(x, y), np.arctan2(y, x) - turn

    def least(path: Callable[[Array], tuple[Array, Array]], fillet: Curve) -> float:
        x, y = fillet.points(np.linspace(fillet.start, fillet.end, _FILLET))
        radius, half = np.hypot(x, y), np.arctan2(x, y)
        order = np.argsort(radius)
        radius, half = radius[order], half[order]

        def room(turn: Array) -> Array:
            at, beside = path(turn)
            inside = (at > radius[0]) & (at < radius[-1])
            return np.where(inside, (beside - np.interp(at, radius, half)) * at, np.inf).min(axis=0)

        reach = 6.0 * math.pi / planet.teeth
        return _least(room, -reach, reach)

    return least(of_planet, ring.fillet), least(of_ring, planet.fillet)
