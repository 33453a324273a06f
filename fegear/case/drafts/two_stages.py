"""Two helical stages on three parallel shafts: module, torque and speed of the second, places, shafts, bearings.

The wheel of the first stage and the pinion of the second turn together and have one hand, so that their axial forces
are against each other. Each shaft has a deep groove ball bearing that locates it, at the end with less radial force,
and a cylindrical roller bearing that lets it grow.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fegear.base.units import from_si
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.first_size import MODULES
from fegear.geometry.involute import pressure_angle_of_inv
from fegear.geometry.rack import BasicRack
from fegear.shafts.axial_factors import AxialFactors
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN
from fegear.shafts.life import LifeRating
from fegear.shafts.load_ratings import dynamic_rating

#: Gap between faces, and between a face and a bearing [modules of the second stage].
_GAP, _CLEAR = 3.0, 2.0
#: Shoulder of a shaft behind a bearing, in bores; hole of a gear at most, in root radii.
_SHOULDER, _HOLE = 1.15, 0.65
#: Shear stress of a shaft below its torque [Pa]: bends it little enough.
_SHEAR = 25e6
#: Life that bearings are chosen for [h], of the gearbox and some more: the load over the face moves their forces.
_LIFE, _MORE = 20e3, 1.25
_SERIES = {"ball": ("62", "63"), "roller": ("NU2", "NU3")}
_FIRST, _LAST = 4, 20


@dataclass(frozen=True)
class ChosenBearing:
    """A bearing by its designation.

    Parameters
    ----------
    designation : str
    rating : LifeRating
        With C to two digits, estimated from its dimensions.
    bore, width : float
        [m].
    """

    designation: str
    rating: LifeRating
    bore: float
    width: float


@dataclass(frozen=True)
class PlacedShaft:
    """One shaft with its bearings.

    Parameters
    ----------
    seat, thick : float
        Diameter below the bearings and between them [m].
    floating_first : bool
        Whether the locating bearing is the right one.
    locating, floating : ChosenBearing
    """

    seat: float
    thick: float
    floating_first: bool
    locating: ChosenBearing
    floating: ChosenBearing


@dataclass(frozen=True)
class TwoStages:
    """What the case has besides its gears; lengths from the left end of all three shafts [m].

    Parameters
    ----------
    stages : tuple of Answers
        Of each stage, as of a gearbox with one.
    holes : tuple of float
        Radius of the hole of each gear [m].
    distances : tuple of float
        Centre distances [m].
    middles : tuple of float
        Middle of both stages' faces.
    ends : tuple of float
        Middle of the bearings at the left and at the right.
    length : float
    shafts : tuple of PlacedShaft
    """

    stages: tuple[Answers, Answers]
    holes: tuple[float, ...]
    distances: tuple[float, float]
    middles: tuple[float, float]
    ends: tuple[float, float]
    length: float
    shafts: tuple[PlacedShaft, ...]


def two_stages(answers: Answers) -> TwoStages:
    """Lay out both stages.

    Parameters
    ----------
    answers : Answers
    """
    stages = _stages(answers)
    radii = [_radii(one) for one in stages]
    modules, faces = [one.si("module") for one in stages], [one.si("face_width") for one in stages]
    torques = [stages[0].si("torque"), stages[1].si("torque")]
    torques.append(torques[1] * _ratio(stages[1]))
    speeds = [stages[0].si("speed"), stages[1].si("speed")]
    speeds.append(speeds[1] / _ratio(stages[1]))
    clear, seats = _CLEAR * modules[1], [(16.0 * torque / (math.pi * _SHEAR)) ** (1.0 / 3.0) for torque in torques]
    width = 0.6 * max(seats)
    ends, length, middles = (0.0, 0.0), 0.0, (0.0, 0.0)
    shafts: tuple[PlacedShaft, ...] = ()
    for _ in range(3):  # forces follow the places, places the widths of bearings, and these the forces
        middles = (width + clear + 0.5 * faces[0], width + clear + faces[0] + _GAP * modules[1] + 0.5 * faces[1])
        length = middles[1] + 0.5 * faces[1] + clear + width
        ends = 0.5 * width, length - 0.5 * width
        forces = [_mesh_forces(one, torque) for one, torque in zip(stages, torques, strict=False)]
        on = (((0, 0),), ((0, 1), (1, 0)), ((1, 1),))  # stage and member of the gears of each shaft
        shafts = tuple(
            _shaft(
                seat, speed,
                [(middles[n] - ends[0], *forces[n], radii[n][member], -1.0 if member else 1.0) for n, member in gears],
                ends[1] - ends[0],
            )
            for seat, speed, gears in zip(seats, speeds, on, strict=True)
        )  # fmt: skip
        width = max(one.width for shaft in shafts for one in (shaft.locating, shaft.floating))
    thick = (shafts[0].thick, shafts[1].thick, shafts[1].thick, shafts[2].thick)
    roots = [root for one in stages for root in _roots(one)]
    holes = tuple(min(0.5 * d, _HOLE * root) for d, root in zip(thick, roots, strict=True))
    distances = [sum(one) for one in radii]
    return TwoStages(stages, holes, (distances[0], distances[1]), middles, ends, length, shafts)


def _stages(answers: Answers) -> tuple[Answers, Answers]:
    """Answers of both stages: the second has the torque of the first wheel, and a module and face that suit it."""
    teeth, shifts = answers.numbers("teeth"), answers.numbers("profile_shift")
    kept = {key: text for key, text in answers.given.items() if key not in ("teeth", "profile_shift")}
    known = {name: answers[name] for name in ("module", "torque", "speed", "face_width")}
    first = Answers("gearbox", {**kept, **known, "teeth": " ".join(teeth[:2]), "profile_shift": " ".join(shifts[:2])})
    ratio, module = _ratio(first), answers.si("module")
    grown = min(MODULES, key=lambda one: abs(math.log(one * 1e-3 / (module * ratio ** (1.0 / 3.0)))))
    grown = max(grown, module * 1e3)
    face = answers.si("face_width") * grown * 1e-3 / module
    second = {
        **kept, "teeth": " ".join(teeth[2:]), "profile_shift": " ".join(shifts[2:]), "module": f"{grown:.6g} mm",
        "face_width": f"{face * 1e3:.3g} mm", "torque": f"{first.si('torque') * ratio:.6g} N*m",
        "speed": f"{first.si('speed') / ratio * from_si('rpm'):.6g} rpm",
    }  # fmt: skip
    return first, Answers("gearbox", second)


def _ratio(stage: Answers) -> float:
    pinion, wheel = map(int, stage.numbers("teeth"))
    return wheel / pinion


def centre_distance(answers: Answers) -> float:
    """Of two gears without backlash [m] (ISO 21771, 5.4.4): inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) x/z."""
    turn = math.cos(answers.si("helix_angle")) if answers.helical else 1.0
    teeth, shifts = (sum(map(float, answers.numbers(name))) for name in ("teeth", "profile_shift"))
    normal = math.tan(answers.si("pressure_angle"))
    angle = math.atan(normal / turn)
    # Shifts that leave no involute are refused with the case.
    working = float(pressure_angle_of_inv(max(math.tan(angle) - angle + 2.0 * normal * shifts / teeth, 1e-12)))
    return 0.5 * answers.si("module") * teeth / turn * math.cos(angle) / math.cos(working)


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


def _mesh_forces(stage: Answers, torque: float) -> tuple[float, float, float]:
    """Tangential, radial and axial force of a mesh [N]."""
    tangential, helix = torque / _radii(stage)[0], stage.si("helix_angle")
    return tangential, tangential * math.tan(stage.si("pressure_angle")) / math.cos(helix), tangential * math.tan(helix)


def _shaft(
    seat: float, speed: float, meshes: Sequence[tuple[float, float, float, float, float, float]], span: float
) -> PlacedShaft:
    """The smallest shaft and bearings that carry the forces of its meshes."""
    tangent, apart, moment, axial = [0.0, 0.0], [0.0, 0.0], 0.0, 0.0
    for at, tangential, radial, along, radius, side in meshes:
        # On shafts in a row both meshes of the middle one push it up, and from both sides; axial forces of one hand
        # are against each other, with moments that add.
        for end, share in enumerate((1.0 - at / span, at / span)):
            tangent[end] += share * tangential
            apart[end] += share * side * radial
        moment += along * radius / span
        axial += side * along
    forces = [math.hypot(one, abs(other) + moment) for one, other in zip(tangent, apart, strict=True)]
    floating_first = forces[0] > forces[1]
    rolls = _LIFE * _MORE * 3600.0 * speed / (2.0 * math.pi)
    located, floats = min(forces), max(forces)
    locating = _bearing("ball", seat, located, abs(axial), rolls)
    floating = _bearing("roller", seat, floats, 0.0, rolls)
    bore = max(locating.bore, floating.bore)
    locating, floating = (
        one if one.bore == bore else _bearing(kind, bore, radial, along, rolls)
        for one, kind, radial, along in (
            (locating, "ball", located, abs(axial)), (floating, "roller", floats, 0.0)
        )
    )  # fmt: skip
    bore = max(locating.bore, floating.bore)
    return PlacedShaft(bore, math.ceil(_SHOULDER * bore * 1e3) * 1e-3, floating_first, locating, floating)


def _bearing(kind: str, seat: float, radial: float, axial: float, rolls: float) -> ChosenBearing:
    """The smallest bearing on a seat of this diameter, or a larger one, with the life; else the largest there is."""
    found: ChosenBearing | None = None
    for number in range(_FIRST, _LAST + 1):
        if 5e-3 * number < seat - 1e-9 and number < _LAST:
            continue
        for series in _SERIES[kind]:
            found = _known(f"{series}{number:02d}")
            if found.rating.revolutions(radial, axial) >= rolls:
                return found
    assert found is not None  # noqa: S101  (for mypy: there is a largest one)
    return found


def _known(designation: str) -> ChosenBearing:
    one = KNOWN[designation]
    inside = CatalogueBearing(one.kind, one.bore, one.outside_diameter, one.width, None, None, None, 0.0).inside
    rated = float(f"{dynamic_rating(inside):.2g}")
    factors = AxialFactors(inside.kind == "ball", inside.contact_angle, inside.count * inside.element_diameter**2)
    return ChosenBearing(designation, LifeRating(rated, inside.kind, axial=factors), one.bore, one.width)
