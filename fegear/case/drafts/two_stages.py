"""One or two helical stages on parallel shafts: module, torque and speed of the second, places, shafts, bearings.

The wheel of the first stage and the pinion of the second turn together and have one hand, so that their axial forces
are against each other. Each shaft has a deep groove ball bearing that locates it, at the end with less radial force,
and a cylindrical roller bearing that lets it grow; where these would need a shaft thicker than a root circle, two
tapered roller bearings against each other. Teeth of small pinions are cut into their shaft.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from fegear.base.units import from_si
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.first_size import MODULES, face_for, module_for
from fegear.case.drafts.kinds import TWO_STAGES
from fegear.geometry.involute import pressure_angle_of_inv
from fegear.geometry.rack import BasicRack
from fegear.shafts.axial_factors import AxialFactors
from fegear.shafts.bearing_seat import SHOULDER
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN, catalogue_rating
from fegear.shafts.life import LifeRating
from fegear.shafts.load_ratings import dynamic_rating

#: Gap between faces, and between a face and a bearing [modules of the second stage].
_GAP, _CLEAR = 3.0, 2.0
#: Gap between a gear and a shaft beside it, and between bearings of neighbours [modules of the second stage].
_APART = 1.0
#: Hole of a gear at most, in root radii.
_HOLE = 0.65
#: Shear stress of a shaft below its torque [Pa]: bends it little enough.
_SHEAR = 25e6
#: Least sum of profile shifts, about, and what the difference of both follows from.
_SHIFTED, _SHARE = 0.1, 0.6
#: Life that bearings are chosen for, over the required one: the load over the face moves their forces.
_MORE = 1.25
_SERIES = {"ball": ("62", "63"), "roller": ("NU2", "NU3"), "tapered": ("302", "322", "303", "323")}
_FIRST, _LAST = 4, 20
#: Bore of a bearing over its number [m]; times that the life is halved where no bearing lasts as long.
_STEP, _HALVES = 5e-3, 24


@dataclass(frozen=True)
class ChosenBearing:
    """A bearing by its designation.

    Parameters
    ----------
    designation : str
        Empty for one of which only a stiffness is assumed.
    rating : LifeRating or None
        With the C that is printed, else estimated from its dimensions.
    bore, width, outside : float
        [m].
    """

    designation: str
    rating: LifeRating | None
    bore: float
    width: float
    outside: float


@dataclass(frozen=True)
class PlacedShaft:
    """One shaft with its bearings.

    Parameters
    ----------
    seat, thick : float
        Diameter below the bearings and between them [m].
    bearings : mapping of str to ChosenBearing
        From left to right by what they do: "locating" and "floating", or "left" and "right" against each other.
    lasts : bool
        Whether the bearings have the life that they are chosen for; else they are the best for this root circle.
    """

    seat: float
    thick: float
    bearings: Mapping[str, ChosenBearing]
    lasts: bool = True

    @property
    def tapered(self) -> bool:
        """Whether two tapered bearings locate it together."""
        return "left" in self.bearings


class _Forces(NamedTuple):
    """Radial forces at the left and at the right end, axial force [N], turns within the life, largest shaft [m]."""

    left: float
    right: float
    axial: float
    rolls: float
    most: float


@dataclass(frozen=True)
class LaidOut:
    """What the case has besides its gears; lengths from the left end of all three shafts [m].

    Parameters
    ----------
    stages : tuple of Answers
        Of each of the one or two stages, as of a gearbox with one.
    holes : tuple of float
        Radius of the hole of each gear [m].
    cut : tuple of bool
        Whether the teeth of each gear are cut into its shaft, which is thicker than that hole.
    distances : tuple of float
        Centre distances [m].
    middles : tuple of float
        Middle of each stage's faces.
    ends : tuple of float
        Middle of the bearings at the left and at the right.
    length : float
    shafts : tuple of PlacedShaft
    """

    stages: tuple[Answers, ...]
    holes: tuple[float, ...]
    cut: tuple[bool, ...]
    distances: tuple[float, ...]
    middles: tuple[float, ...]
    ends: tuple[float, float]
    length: float
    shafts: tuple[PlacedShaft, ...]


def two_stages(answers: Answers) -> LaidOut:
    """Lay out both stages, the second with the least module that suits its torque and keeps all bodies apart.

    Parameters
    ----------
    answers : Answers
    """
    first = _first(answers)
    least: float | None = 0.0
    drafts: list[LaidOut] = []
    while least is not None:
        drafts.append(laid_out((first, _second(answers, first, least))))
        if _beside(drafts[-1], 1):
            return drafts[-1]
        tried = drafts[-1].stages[1].si("module")
        least = next((one for one in MODULES if one > 1.001e3 * tried), None)
    return drafts[0]


def with_room(answers: Answers) -> Answers:
    """Answers of a gearbox with the smallest module whose centre distances keep all bodies apart, if none is given.

    Bearings follow from forces and life: near a ratio of one they may need more than the gears do.

    Parameters
    ----------
    answers : Answers
    """
    if not answers.assumed("module"):
        return answers
    first = answers.si("module")
    if answers.sized and answers.assumed("profile_shift"):
        answers = with_whole_distances(answers)
    for module in MODULES:
        if module < 0.999e3 * first:
            continue
        suited = {"module": f"{module:.6g} mm", "torque": answers["torque"]}
        made = replace(answers, suited=suited) if module > 1.001e3 * first else answers
        if made is not answers and answers.sized and answers.assumed("profile_shift"):
            made = with_whole_distances(made)
        if _apart(two_stages(made) if made.kind == TWO_STAGES else laid_out((made,))):
            return made
    return answers


def with_whole_distances(answers: Answers) -> Answers:
    """Answers with profile shifts that make all centre distances whole millimetres.

    Sums of shifts are those of the next distances; pinions have the larger share: x_1 = 0.6 (u - 1)/(u + 1) + (x_1 +
    x_2)/(u + 1), about the rule of ISO/TR 4467 for speed reducing gears.

    Parameters
    ----------
    answers : Answers
    """
    bare = replace(answers, suited={**answers.suited, "profile_shift": "0"})
    stages = two_stages(bare).stages if bare.kind == TWO_STAGES else (bare,)
    shifts = [shift for stage in stages for shift in _whole(stage)]
    return replace(answers, suited={**answers.suited, "profile_shift": " ".join(f"{one:.4f}" for one in shifts)})


def _whole(stage: Answers) -> tuple[float, float]:
    """Profile shifts of a stage."""
    distance, module = centre_distance(stage), stage.si("module")
    whole = math.ceil(1e3 * (distance + _SHIFTED * module)) * 1e-3
    normal, turn = math.tan(stage.si("pressure_angle")), math.cos(stage.si("helix_angle"))
    angle = math.atan(normal / turn)
    working = math.acos(distance * math.cos(angle) / whole)
    teeth, ratio = sum(map(int, stage.numbers("teeth"))), _ratio(stage)
    both = teeth * (math.tan(working) - working - math.tan(angle) + angle) / (2.0 * normal)
    first = round(_SHARE * (ratio - 1.0) / (ratio + 1.0) + both / (ratio + 1.0), 4)
    return first, both - first


def _apart(laid: LaidOut) -> bool:
    return all(_beside(laid, stage) for stage in range(len(laid.stages)))


def _beside(laid: LaidOut, stage: int) -> bool:
    """Whether the shafts of a stage have room for their bearings, the last one also beside the wheel of the first."""
    ends = zip(laid.shafts[stage].bearings.values(), laid.shafts[stage + 1].bearings.values(), strict=True)
    needed = max(0.5 * (one.outside + other.outside) for one, other in ends)
    if stage:
        needed = max(needed, _tips(laid.stages[0])[1] + 0.5 * laid.shafts[stage + 1].thick)
    return laid.distances[stage] >= needed + _APART * laid.stages[stage].si("module")


def laid_out(stages: tuple[Answers, ...]) -> LaidOut:
    """Places, shafts and bearings of one stage or two.

    Parameters
    ----------
    stages : tuple of Answers
    """
    radii = [_radii(one) for one in stages]
    modules, faces = [one.si("module") for one in stages], [one.si("face_width") for one in stages]
    torques, speeds = [one.si("torque") for one in stages], [one.si("speed") for one in stages]
    torques.append(torques[-1] * _ratio(stages[-1]))
    speeds.append(speeds[-1] / _ratio(stages[-1]))
    clear, seats = _CLEAR * modules[-1], [(16.0 * torque / (math.pi * _SHEAR)) ** (1.0 / 3.0) for torque in torques]
    # stage and member of the gears of each shaft
    on: tuple[tuple[tuple[int, int], ...], ...] = (((0, 0),), ((0, 1),))
    if len(stages) > 1:
        on = (((0, 0),), ((0, 1), (1, 0)), ((1, 1),))
    roots = [list(_roots(one)) for one in stages]
    width = 0.6 * max(seats)
    ends, length = (0.0, 0.0), 0.0
    middles: tuple[float, ...] = ()
    shafts: tuple[PlacedShaft, ...] = ()
    for _ in range(3):  # forces follow the places, places the widths of bearings, and these the forces
        middles = (width + clear + 0.5 * faces[0],)
        if len(stages) > 1:
            middles = (*middles, width + clear + faces[0] + _GAP * modules[1] + 0.5 * faces[1])
        length = middles[-1] + 0.5 * faces[-1] + clear + width
        ends = 0.5 * width, length - 0.5 * width
        forces = [_mesh_forces(one, torque) for one, torque in zip(stages, torques, strict=False)]
        shafts = tuple(
            _shaft(
                seat, speed, 2.0 * min(roots[n][member] for n, member in gears),
                [(middles[n] - ends[0], *forces[n], radii[n][member], -1.0 if member else 1.0) for n, member in gears],
                ends[1] - ends[0], stages[0].si("life"),
            )
            for seat, speed, gears in zip(seats, speeds, on, strict=True)
        )  # fmt: skip
        width = max(one.width for shaft in shafts for one in shaft.bearings.values())
    thick = [shaft.thick for shaft, gears in zip(shafts, on, strict=True) for _ in gears]
    most = [_HOLE * one for own in roots for one in own]
    cut = tuple(root < 0.5 * d for d, root in zip(thick, most, strict=True))
    holes = tuple(min(0.5 * d, root) for d, root in zip(thick, most, strict=True))
    return LaidOut(stages, holes, cut, tuple(sum(one) for one in radii), middles, ends, length, shafts)


def _kept(answers: Answers) -> dict[str, str]:
    return {key: text for key, text in answers.given.items() if key not in ("teeth", "profile_shift")}


def _first(answers: Answers) -> Answers:
    """Answers of the first stage."""
    teeth, shifts = answers.numbers("teeth"), answers.numbers("profile_shift")
    known = {name: answers[name] for name in ("module", "torque", "speed", "face_width")}
    own = {"teeth": " ".join(teeth[:2]), "profile_shift": " ".join(shifts[:2])}
    return Answers("gearbox", {**_kept(answers), **known, **own})


def _second(answers: Answers, first: Answers, least: float) -> Answers:
    """Answers of the second stage: torque of the first wheel, a module of at least `least` [mm], a face."""
    teeth, shifts = answers.numbers("teeth"), answers.numbers("profile_shift")
    ratio, module = _ratio(first), answers.si("module")
    grown = min(MODULES, key=lambda one: abs(math.log(one * 1e-3 / (module * ratio ** (1.0 / 3.0)))))
    grown = max(grown, module * 1e3, least)
    face, torque = answers.si("face_width") * grown * 1e-3 / module, first.si("torque") * ratio
    if answers.sized:
        pinion = int(teeth[2])
        grown = max(module_for(torque, pinion, max(module, least * 1e-3)) * 1e3, least)
        if answers.assumed("face_width"):
            face = face_for(torque, pinion, grown * 1e-3)
    second = {
        **_kept(answers), "teeth": " ".join(teeth[2:]),
        "profile_shift": " ".join(shifts[2:]), "module": f"{grown:.6g} mm",
        "face_width": f"{face * 1e3:.3g} mm", "torque": f"{torque:.6g} N*m",
        "speed": f"{first.si('speed') / ratio * from_si('rpm'):.6g} rpm",
    }  # fmt: skip
    return Answers("gearbox", second)


def _ratio(stage: Answers) -> float:
    pinion, wheel = map(int, stage.numbers("teeth"))
    return wheel / pinion


def centre_distance(answers: Answers) -> float:
    """Of two gears without backlash [m] (ISO 21771, 5.4.4): inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) x/z.

    The number of teeth of a ring gear is negative.
    """
    turn = math.cos(answers.si("helix_angle")) if answers.helical else 1.0
    teeth, shifts = (sum(map(float, answers.numbers(name))) for name in ("teeth", "profile_shift"))
    normal = math.tan(answers.si("pressure_angle"))
    angle = math.atan(normal / turn)
    # Shifts that leave no involute are refused with the case.
    working = float(pressure_angle_of_inv(max(math.tan(angle) - angle + 2.0 * normal * shifts / teeth, 1e-12)))
    return 0.5 * answers.si("module") * abs(teeth) / turn * math.cos(angle) / math.cos(working)


def _radii(stage: Answers) -> tuple[float, float]:
    """Working pitch radii of a mesh without backlash [m]."""
    z, other = map(int, stage.numbers("teeth"))
    distance = centre_distance(stage)
    return distance * z / (z + other), distance * other / (z + other)


def _roots(stage: Answers) -> Iterator[float]:
    """Root radii [m]."""
    turn, dedendum = math.cos(stage.si("helix_angle")), BasicRack.named(stage["rack"]).dedendum
    for z, x in zip(stage.numbers("teeth"), stage.numbers("profile_shift"), strict=True):
        yield stage.si("module") * (0.5 * int(z) / turn - dedendum + float(x))


def _tips(stage: Answers) -> tuple[float, ...]:
    """Tip radii without tip shortening [m]."""
    turn, addendum = math.cos(stage.si("helix_angle")), BasicRack.named(stage["rack"]).addendum
    both = zip(stage.numbers("teeth"), stage.numbers("profile_shift"), strict=True)
    return tuple(stage.si("module") * (0.5 * int(z) / turn + addendum + float(x)) for z, x in both)


def _mesh_forces(stage: Answers, torque: float) -> tuple[float, float, float]:
    """Tangential, radial and axial force of a mesh [N]."""
    tangential, helix = torque / _radii(stage)[0], stage.si("helix_angle")
    return tangential, tangential * math.tan(stage.si("pressure_angle")) / math.cos(helix), tangential * math.tan(helix)


def _shaft(
    seat: float, speed: float, root: float, meshes: Sequence[tuple[float, float, float, float, float, float]],
    span: float, life: float,
) -> PlacedShaft:  # fmt: skip
    """The smallest shaft and bearings that carry the forces of its meshes for a life [s] within the smallest root."""
    tangent, apart, moment, axial = [0.0, 0.0], [0.0, 0.0], 0.0, 0.0
    for at, tangential, radial, along, radius, side in meshes:
        # On shafts in a row both meshes of the middle one push it up, and from both sides; axial forces of one hand
        # are against each other, with moments that add.
        for end, share in enumerate((1.0 - at / span, at / span)):
            tangent[end] += share * tangential
            apart[end] += share * side * radial
        moment += along * radius / span
        axial += side * along
    left, right = (math.hypot(one, abs(other) + moment) for one, other in zip(tangent, apart, strict=True))
    rolls = _MORE * life * speed / (2.0 * math.pi)
    forces = _Forces(left, right, abs(axial), rolls, root)
    seat = min(seat, _STEP * _LAST, _STEP * math.floor(root / SHOULDER / _STEP))
    for halved in range(_HALVES):  # where none lasts as long, one that lasts half of it, and so on
        forces = forces._replace(rolls=rolls * 0.5**halved)
        found = _located(seat, forces) or _adjusted(seat, forces)
        if found is not None:
            return replace(found, lasts=not halved)
    return _assumed(forces)


def _assumed(forces: _Forces) -> PlacedShaft:
    """A shaft on bearings of an assumed stiffness: its pinion is too small for those that are tabulated."""
    seat = 0.8 * forces.most
    made = ChosenBearing("", None, seat, 0.4 * seat, 2.0 * seat)
    return PlacedShaft(seat, forces.most, {"locating": made, "floating": made})


def _located(seat: float, forces: _Forces) -> PlacedShaft | None:
    """A shaft with a ball bearing that locates it, where the radial force is less, and a roller bearing that floats."""
    floating_first = forces.left > forces.right
    located, floats = sorted((forces.left, forces.right))
    bore = seat
    while True:  # both have one bore
        locating = _bearing("ball", bore, located, forces.axial, forces)
        floating = _bearing("roller", bore, floats, 0.0, forces)
        if locating is None or floating is None:
            return None
        bore = max(locating.bore, floating.bore)
        if locating.bore == floating.bore:
            break
    both = {"locating": locating, "floating": floating}
    if floating_first:
        both = {"floating": floating, "locating": locating}
    return PlacedShaft(bore, _thick(bore, forces.most), both)


def _adjusted(seat: float, forces: _Forces) -> PlacedShaft | None:
    """A shaft between two equal tapered bearings, one of which has the axial force and what the other induces."""
    radial = max(forces.left, forces.right)
    found = _bearing("tapered", seat, radial, forces.axial, forces)
    if found is None:
        return None
    return PlacedShaft(found.bore, _thick(found.bore, forces.most), {"left": found, "right": found})


def _thick(bore: float, most: float) -> float:
    """Diameter of the shaft between its bearings: a shoulder, within the root circle."""
    return min(math.ceil(SHOULDER * bore * 1e3) * 1e-3, most)


def _bearing(kind: str, seat: float, radial: float, axial: float, forces: _Forces) -> ChosenBearing | None:
    """The smallest bearing on this or a larger seat with the life, and with a shoulder within the root circle."""
    for number in range(_FIRST, _LAST + 1):
        bore = _STEP * number
        if bore < seat - 1e-9 or SHOULDER * bore > forces.most:
            continue
        for series in _SERIES[kind]:
            found = _known(f"{series}{number:02d}")
            rating = found.rating
            if rating is None:
                continue
            # half of F_r/Y of the other bearing (ISO 281), which has no more radial force
            induced = 0.5 * radial / rating.axial.at(0.0)[1] if kind == "tapered" and rating.axial else 0.0
            if rating.revolutions(radial, axial + induced) >= forces.rolls:
                return found
    return None


def _known(designation: str) -> ChosenBearing:
    one = KNOWN[designation]
    angle = one.contact_angle or None
    inside = CatalogueBearing(one.kind, one.bore, one.outside_diameter, one.width, None, None, angle, 0.0).inside
    rated = catalogue_rating(designation) or dynamic_rating(inside)
    factors = AxialFactors(inside.kind == "ball", inside.contact_angle, inside.count * inside.element_diameter**2)
    life = LifeRating(rated, inside.kind, axial=factors)
    return ChosenBearing(designation, life, one.bore, one.width, one.outside_diameter)
