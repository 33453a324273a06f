"""From ``[sizing]`` to its variants: what may vary, limits, and what every variant is rated for.

What a pair is rated for is read as that of any case, from a pair that stands for all variants: their ratings are those
of their own cases.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.case.built.rated_pair import pair_to_rate
from fegear.case.reading import build_scene
from fegear.design.sizing.limits import SizingLimits
from fegear.design.sizing.rated import DutyLevel, SizingDuty
from fegear.design.sizing.space import SizingSpace, Variant
from fegear.formulas.iso6336.conditions import Replacement
from fegear.geometry.involute import inv, pressure_angle_of_inv
from fegear.geometry.many_pairs import ManyGearPairs
from fegear.results.sizing.variant_case import GEARS, OF_GEARS, OF_PAIR, PAIR, case_of_variant

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.notes import Note
    from fegear.case.reading import Scene
    from fegear.case.sizing import PresentPart, SizingPart

#: By how much flanks without backlash may overlap, as a share of the centre distance.
_NO_ROOM = 1e-6
#: The pair that stands for all variants: teeth of its pinion, module, width [m].
_TEETH, _MODULE, _WIDTH = 25, 3e-3, 30e-3


def sizing_of(scene: Scene) -> SizingPart:
    """The requirement.

    Raises
    ------
    InputError
        Without one.
    """
    if scene.case.sizing is None:
        raise InputError("sizing", "(not given)", "is required for sizing", "add a table [sizing]")
    return scene.case.sizing


def requirement_of(part: SizingPart) -> dict[str, Any]:
    """What the cases of variants have from the requirement, as plain tables with numbers in SI."""
    keys = {*OF_PAIR, *OF_GEARS, "wheel_strength"}
    return part.model_dump(include=keys, exclude_none=True, exclude_defaults=True)


def space_of(part: SizingPart) -> SizingSpace:
    """What may vary."""
    limits = part.limits.shift_sum
    return SizingSpace(
        part.modules, part.chosen_pressure_angles, part.chosen_helix_angles,
        tuple(sorted(set(part.addenda))), part.widths, tuple(sorted(set(part.width_ratios or ()))),
        (part.pinion_teeth[0], part.pinion_teeth[1]), part.ratio, part.ratio_tolerance, part.hunting,
        part.chosen_shifts, part.chosen_sums, part.distances, (limits[0], limits[1]), part.root_clearance,
        part.rack_tip_radius, part.shorten_tips,
    )  # fmt: skip


def limits_of(part: SizingPart, density: float) -> SizingLimits:
    """What excludes variants."""
    own = part.limits
    return SizingLimits(
        own.tip_thickness, own.contact_ratio, own.overlap_ratio, own.tip_clearance, own.specific_sliding,
        own.width_ratio, own.tip_diameter, own.mass, (own.shift_sum[0], own.shift_sum[1]), part.distances, density,
    )  # fmt: skip


def duty_of(part: SizingPart, asked: Mapping[str, Any], folder: Path) -> tuple[SizingDuty, tuple[str, ...]]:
    """What every variant is rated for, and what had to be assumed of it.

    Raises
    ------
    InputError
        If something of the requirement breaks a rule; under the key of ``[sizing]``.
    """
    z = (_TEETH, max(round(_TEETH * part.ratio), _TEETH))
    tips = tuple((one + 2.0) * _MODULE for one in z)
    stands = Variant(
        z, (0.0, 0.0), (tips[0], tips[1]), _MODULE, math.radians(20.0), 0.0, 1.0, 1.25, 0.38,
        0.5 * sum(z) * _MODULE, _WIDTH,
    )  # fmt: skip
    try:
        scene = build_scene(case_of_variant(asked, stands, ["rating"]), "variant", folder, bare_si=True)
        rated = pair_to_rate(scene, PAIR)
    except InputError as error:
        raise type(error)(_of_sizing(error.key), error.value, error.rule, error.remedy) from None
    conditions, operation = rated.conditions, part.operation
    duty, (one, two) = conditions.duty, conditions.quality
    torque = part.torque if part.torque is not None else (part.power or math.nan) / part.speed
    across = rated.given.get("K_Halpha")
    levels = tuple(
        DutyLevel(level.tangential / duty.tangential, level.speed / duty.speed, level.cycles[0])
        for level in rated.levels
    )
    alignment = conditions.alignment
    if alignment.contact_pattern == "favourable":  # the slope of class 5 is each variant's own
        alignment = replace(alignment, helix_slope_5=0.0)
    said = tuple(one for one in rated.assumed if f"Gear {GEARS[1]}" not in one)
    return SizingDuty(
        torque, part.speed, duty.cycles[0],
        operation.life is None and operation.load_cycles is None and not levels, conditions.strength,
        scene.gears[GEARS[0]].material, one.grade, (one.flank_roughness, two.flank_roughness),
        (one.root_roughness, two.root_roughness), duty.viscosity, duty.application_factor, duty.mesh_load_factor,
        duty.meshes, rated.stress_ratio, rated.mean_stress, alignment, conditions.edition,
        conditions.dynamic_method, conditions.tip_relief_factor,
        Replacement(
            K_v=rated.given.get("K_v"), K_Halpha=across, K_Falpha=None if across is None else (across, across)
        ),
        conditions.required, levels, conditions.spectrum_line == "annex-c",
    ), said  # fmt: skip


def _of_sizing(key: str) -> str:
    for place in (f"pair.{PAIR}", *(f"gear.{name}" for name in GEARS)):
        if key.startswith(place):
            return f"sizing{key[len(place) :]}"
    return key


def said_of_present(part: SizingPart) -> tuple[Note, ...]:
    """Where the profile shifts of the present design want more room than the centre distance of the requirement."""
    if part.present is None or part.distances is None or part.distances[0] < part.distances[1]:
        return ()
    wanted, distance = float(present_pair(part, part.present).centre_distance[0]), part.distances[0]
    if wanted <= distance:
        return ()
    return (
        assuming(
            f"Present design: centre distance {wanted * 1e3:.7g} mm in place of {distance * 1e3:.7g} mm, without "
            "backlash at its profile shifts."
        ),
    )


def present_pair(part: SizingPart, present: PresentPart) -> ManyGearPairs:
    """The present design as an array of one."""
    alpha, beta, z = present.pressure_angle, present.helix_angle, present.teeth
    transverse = math.atan(math.tan(alpha) / math.cos(beta))
    pitch = 0.5 * present.normal_module * sum(z) / math.cos(beta)
    total = sum(present.profile_shift)
    space = space_of(part)
    value = float(inv(transverse)) + 2.0 * total * math.tan(alpha) / sum(z)
    distance = pitch * math.cos(transverse) / math.cos(float(pressure_angle_of_inv(max(value, 1e-12))))
    if space.fixed and space.distances is not None and distance <= space.distances[0] * (1.0 + _NO_ROOM):
        distance = space.distances[0]  # else shifts that were rounded up leave no backlash there
    moved = np.full((2, 1), min((distance - pitch) / present.normal_module - total, 0.0) if part.shorten_tips else 0.0)
    if present.tip_diameter is not None:
        for i, tip in enumerate(present.tip_diameter):
            usual = 2.0 * present.normal_module * (0.5 * z[i] / math.cos(beta) + present.addendum)
            moved[i] = (tip - usual) / (2.0 * present.normal_module) - present.profile_shift[i]

    def one(value: float) -> np.ndarray:
        return np.array([value])

    return ManyGearPairs(
        np.array([[float(z[0])], [float(z[1])]]), np.array(present.profile_shift).reshape(2, 1),
        one(present.normal_module), one(alpha), one(beta), one(present.addendum),
        one(present.addendum + part.root_clearance), one(part.rack_tip_radius), moved, one(distance),
        one(present.face_width),
    )  # fmt: skip
