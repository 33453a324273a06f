"""What follows from the teeth of one stage: centre distance, radii, forces, and shifts for a preferred distance."""

from __future__ import annotations

import math
from collections.abc import Iterator

from fegear.case.drafts.answers import Answers
from fegear.geometry.involute import pressure_angle_of_inv
from fegear.geometry.rack import BasicRack

#: Least and largest sum of profile shifts, about, and what the difference of both follows from.
_SHIFTED, _MOST, _SHARE = 0.1, 0.7, 0.6
#: Normal backlash of a gearbox's mesh, assumed [modules].
BACKLASH = 0.04
#: Preferred numbers of the series R 20 (ISO 3), of which ISO 497 has the rounded ones, too.
_R20 = (100, 112, 125, 140, 160, 180, 200, 224, 250, 280, 315, 355, 400, 450, 500, 560, 630, 710, 800, 900)
#: Multiples that centre distances have where none of the series is near [mm].
_MULTIPLES = (5, 1)


def ratio_of(stage: Answers) -> float:
    """Teeth of the wheel over those of the pinion."""
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


def preferred_distance(least: float, most: float) -> float:
    """A centre distance [m] of the series R 20, else a multiple of 5 mm, else a whole millimetre, of at least `least`.

    Parameters
    ----------
    least, most : float
        Where the first two are looked for [m].
    """
    preferred = sorted(one * 10.0**power for one in _R20 for power in range(-2, 3))
    series = (one for one in preferred if 1e3 * least - 1e-9 <= one)
    nearest = [next(series), *(step * math.ceil(1e3 * least / step - 1e-9) for step in _MULTIPLES)]
    return next((one for one in nearest if one == round(one) and one <= 1e3 * most), nearest[-1]) * 1e-3


def shifts_for_distance(stage: Answers) -> tuple[float, float]:
    """Profile shifts with which a stage has a preferred centre distance.

    Pinions have the larger share: x_1 = 0.6 (u - 1)/(u + 1) + (x_1 + x_2)/(u + 1), about the rule of ISO/TR 4467 for
    speed reducing gears.
    """
    distance, module = centre_distance(stage), stage.si("module")
    whole = preferred_distance(distance + _SHIFTED * module, distance + _MOST * module)
    normal, turn = math.tan(stage.si("pressure_angle")), math.cos(stage.si("helix_angle"))
    angle = math.atan(normal / turn)
    working = math.acos(distance * math.cos(angle) / whole)
    teeth, ratio = sum(map(int, stage.numbers("teeth"))), ratio_of(stage)
    both = teeth * (math.tan(working) - working - math.tan(angle) + angle) / (2.0 * normal)
    first = round(_SHARE * (ratio - 1.0) / (ratio + 1.0) + both / (ratio + 1.0), 4)
    return first, both - first


def pitch_radii(stage: Answers) -> tuple[float, float]:
    """Working pitch radii of a mesh without backlash [m]."""
    z, other = map(int, stage.numbers("teeth"))
    distance = centre_distance(stage)
    return distance * z / (z + other), distance * other / (z + other)


def root_radii(stage: Answers) -> Iterator[float]:
    """Root radii, by the cutter that goes deeper for the backlash, half of it in each gear [m]."""
    turn, dedendum = math.cos(stage.si("helix_angle")), BasicRack.named(stage["rack"]).dedendum
    dedendum += 0.25 * BACKLASH / math.sin(stage.si("pressure_angle"))
    for z, x in zip(stage.numbers("teeth"), stage.numbers("profile_shift"), strict=True):
        yield stage.si("module") * (0.5 * int(z) / turn - dedendum + float(x))


def tip_radii(stage: Answers) -> tuple[float, ...]:
    """Tip radii without tip shortening [m]."""
    turn, addendum = math.cos(stage.si("helix_angle")), BasicRack.named(stage["rack"]).addendum
    both = zip(stage.numbers("teeth"), stage.numbers("profile_shift"), strict=True)
    return tuple(stage.si("module") * (0.5 * int(z) / turn + addendum + float(x)) for z, x in both)


def mesh_forces(stage: Answers, torque: float) -> tuple[float, float, float]:
    """Tangential, radial and axial force of a mesh [N]."""
    tangential, helix = torque / pitch_radii(stage)[0], stage.si("helix_angle")
    return tangential, tangential * math.tan(stage.si("pressure_angle")) / math.cos(helix), tangential * math.tan(helix)
