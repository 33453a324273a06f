"""What a case says of the errors of a pair over its face: shafts, the pinion's cutting, and whatever a table holds.

Deviations of a gear's flanks: its own, measured or agreed, and those of its tolerance class where it has none.

What a case says of the tolerances that deviations are drawn inside.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.arrays import Array, distinct
from fegear.base.errors import InputError
from fegear.case.built.pair_inputs import gear_name
from fegear.case.built.shafts import gearbox_of, on_shafts
from fegear.case.part import at
from fegear.case.text_file import read_columns
from fegear.contact.wide.gaps import RIGID, ShaftGaps
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.shaft_tilt import PARALLEL, ShaftTilt

if TYPE_CHECKING:
    from collections.abc import Collection

    from fegear.case.gear import GearPart
    from fegear.case.reading import Scene
    from fegear.case.studies import TolerancePart
    from fegear.design.robustness.tolerance_draws import Kind, Limits
    from fegear.geometry.flank_modification import FlankModification
    from fegear.geometry.gear import Gear


#: Points of a crowned line error: between them its chords are off by 2e-7 of the crowning, less than any spot is flat.
_POINTS = 1025


@dataclass(frozen=True)
class FlankErrors:
    """Errors of a pair that the effect `misalignment` counts.

    Parameters
    ----------
    face_position, line_gap : ndarray, shape (n,)
        `line_error` [m]; empty for none.
    tilt : ShaftTilt
        Deviation of the axes.
    cutting : tuple of FlankModification
        Errors of the pinion's profile and lead angle.
    apart : float
        Error of the centre distance [m].
    shafts : ShaftGaps
        What the shafts of the case open under loads that are spread evenly over the faces, where the effect
        `misalignment` is off.
    """

    face_position: Array = field(default_factory=lambda: np.empty(0))
    line_gap: Array = field(default_factory=lambda: np.empty(0))
    tilt: ShaftTilt = PARALLEL
    cutting: tuple[FlankModification, ...] = ()
    apart: float = 0.0
    shafts: ShaftGaps = RIGID

    @property
    def given(self) -> bool:
        """Whether there are any."""
        own = bool(self.line_gap.size or self.cutting or self.apart or self.tilt != PARALLEL)
        return own or self.shafts.given


def flank_errors(scene: Scene, name: str) -> FlankErrors:
    """Collect the errors of a pair.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for, or an error is no small one.
    """
    z, gap = _line_gap(scene, name)
    part, pair = scene.case.pair[name].misalignment, scene.pairs[name]
    # With the effect on, the shafts' gaps are solved together with the flanks; without it these say what it would do.
    apart = on_shafts(scene, name) and not scene.case.effects.misalignment
    shafts = RIGID
    if apart:
        from fegear.contact.wide.on_shafts import gaps_of_even_loads

        shafts = gaps_of_even_loads(gearbox_of(scene), name)
    if part is None:
        return FlankErrors(z, gap, shafts=shafts)
    prefix = f"pair.{name}.misalignment"
    try:
        tilt = ShaftTilt(*part.deviation(pair))
        angle = part.angle_of_lead(pair.driver)
        cutting: tuple[FlankModification, ...] = ()
        if part.profile_angle or angle:
            from fegear.contact.unloaded.manufacture import CutRemoval

            cutting = (CutRemoval(pair.driver, part.profile_angle, angle),)
            cutting[0].removal(0.5, 0.0)  # refuses a cut that leaves no flank
    except InputError as error:
        names = {"in_plane": "driven.in_plane", "out_of_plane": "driven.out_of_plane"}
        raise at(prefix, error, names if part.driver or part.driven else {"out_of_plane": "shaft_angle"}) from None
    return FlankErrors(z, gap, tilt, cutting, part.centre_distance, shafts)


def cutter_modification(scene: Scene, name: str) -> tuple[FlankModification, ...]:
    """What `modification` of a pair takes off the pinion: the cutter's parabola and the lengthwise crown.

    Raises
    ------
    InputError
        If it leaves no flank, or no crown can absorb what the pair's errors do.
    """
    part, pair = scene.case.pair[name].modification, scene.pairs[name]
    if part is None or not (part.parabola or part.crown or part.absorb):
        return ()
    from fegear.contact.unloaded.manufacture import CutRemoval
    from fegear.contact.unloaded.predesign import absorb_linear_error

    try:
        crown = part.crown_coefficient(pair.driver)
        if part.absorb:
            crown = absorb_linear_error(scene.case.pair[name].rigid(pair, scene.case.effects.misalignment)).crown
        found = CutRemoval(pair.driver, parabola=part.parabola, crown=crown)
        found.removal(0.5, 0.0)
    except InputError as error:
        raise at(f"pair.{name}.modification", error) from None
    return (found,)


def _line_gap(scene: Scene, name: str) -> tuple[Array, Array]:
    """Gap over the face of a pair, from its keys and its file."""
    part, half = scene.case.pair[name].line_error, 0.5 * scene.pairs[name].face_width
    if part is None:
        return np.empty(0), np.empty(0)
    z = np.linspace(-half, half, _POINTS if part.crowning or part.file else 2)
    gap = 0.5 * part.over_face * (1.0 + z / half) + part.crowning * (z / half) ** 2
    if part.file is not None:
        key = f"pair.{name}.line_error.file"
        columns = read_columns(scene.file(part.file, key), key, {"z": "length", "gap": "length"})
        if not {"z", "gap"} <= columns.keys() or not (np.diff(columns["z"]) > 0.0).all():
            raise InputError(key, f'"{part.file}"', "needs the columns z [mm], ascending, and gap [um]")
        if columns["z"][0] > -half * (1.0 - 1e-6) or columns["z"][-1] < half * (1.0 - 1e-6):
            raise InputError(
                key, f'"{part.file}"', f"must cover the face, from {-half * 1e3:.6g} to {half * 1e3:.6g} mm"
            )
        module, spread = scene.pairs[name].driver.module, float(np.ptp(columns["gap"]))
        if spread > module:
            raise InputError(
                key, f"gap {spread * 1e6:.6g} um", f"exceeds the module of {module * 1e3:.6g} mm",
                "check the unit in the head of the column",
            )  # fmt: skip
        z, old = distinct(z, columns["z"]), z
        gap = np.interp(z, old, gap) + np.interp(z, columns["z"], columns["gap"])
    return z, gap


#: f_pb along the line of action, f_Halpha, f_falpha and f_Hbeta, as ``deviations`` of a gear names them.
Deviation = Literal["base_pitch", "profile_slope", "profile_form", "helix_slope"]


def own_deviation(part: GearPart, kind: Deviation) -> float | None:
    """What the case itself says of a deviation [m]; None where it says nothing."""
    found: float | None = getattr(part.deviations, kind, None)
    return found


def gear_deviations(
    part: GearPart, made: Gear, grade: int | None, kinds: Collection[Deviation], *, rounded: bool = False
) -> dict[Deviation, float]:
    """Deviations of some kinds [m]: the gear's own, else by class; kinds that neither tells are left out.

    Parameters
    ----------
    part : GearPart
    made : Gear
    grade : int or None
        Flank tolerance class; None where the gear has none.
    kinds : collection of str
    rounded : bool
        Whether tolerances are rounded as ISO 1328-1:2013 prints them.

    Raises
    ------
    RangeError
        If a class is asked of a gear outside the sizes of the standard; a gear whose own deviations say all is not.
    """
    from fegear.formulas.iso1328 import tolerances_of

    own = {kind: value for kind in kinds if (value := own_deviation(part, kind)) is not None}
    if grade is None or len(own) == len(kinds):
        return own
    allowed = tolerances_of(made, grade)
    allowed = allowed.rounded if rounded else allowed
    by_class: dict[Deviation, float] = {
        "base_pitch": allowed.base_pitch(made.transverse_pressure_angle), "profile_slope": allowed.profile_slope,
        "profile_form": allowed.profile_form, "helix_slope": allowed.helix_slope,
    }  # fmt: skip
    return {kind: own.get(kind, by_class[kind]) for kind in kinds}


#: Deviations of a gear by the kinds that are drawn.
_NAMES: dict[Kind, Deviation] = {
    "profile-slope": "profile_slope", "profile-form": "profile_form", "helix-slope": "helix_slope",
    "pitch": "base_pitch",
}  # fmt: skip


def tolerance_part(scene: Scene) -> TolerancePart:
    """``[robustness]``, which the case must have."""
    if scene.case.robustness is None:
        raise InputError("robustness", "(not given)", "is needed to draw deviations", "write a table [robustness]")
    return scene.case.robustness


def chosen_pair(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[robustness]`` names, or the only one; none without the table."""
    part = scene.case.robustness
    if part is None:
        return ()
    if part.pair is not None:
        if part.pair not in scene.pairs:
            raise InputError("robustness.pair", f'"{part.pair}"', "is no pair of this case")
        return (part.pair,)
    if len(scene.pairs) != 1:
        raise InputError(
            "robustness.pair", "(not given)", f"is needed in a case of {len(scene.pairs)} pairs", "name one of them"
        )
    return tuple(scene.pairs)


def refuse_no_tolerance(scene: Scene, name: str, limits: Limits) -> None:
    """Refuse a pair none of whose wanted deviations has a tolerance."""
    pairs = (limits.profile_slope, limits.profile_form, limits.helix_slope, limits.pitch)
    if not limits.centre_distance and not any(any(pair) for pair in pairs):
        raise InputError(
            "robustness", "no tolerance", "leaves nothing to draw",
            f"give gear.{gear_name(scene, name, 'driver')}.tolerance_class or deviations",
        )  # fmt: skip


def refuse_jammed(pair: GearPair, name: str, limits: Limits) -> None:
    """Refuse deviations of the centre distance at which the teeth of the drawing touch on both flanks."""
    room = pair.side * (pair.centre_distance - pair.tight_centre_distance)
    other = "smaller" if pair.internal else "larger"
    if limits.centre_distance > room * (1.0 + 1e-9) + 1e-12:
        raise InputError(
            "robustness.centre_distance", f"{limits.centre_distance * 1e3:.6g} mm",
            f"jams the teeth: pair {name} has {room * 1e3:.4g} mm until they touch on both flanks",
            f"give a gear of pair {name} a thickness_allowance, or the pair a {other} centre_distance",
        )  # fmt: skip


def limits_of(scene: Scene, name: str, usual: tuple[Kind, ...]) -> Limits:
    """Largest deviations of a pair, of the kinds that the case names or else of the usual ones.

    A gear's own deviations take the place of those of its class. f_pT is an arc of the reference circle; flanks meet
    that deviation along the line of action, where it is shorter.

    Raises
    ------
    InputError
        If a class is asked of a gear outside the sizes of ISO 1328-1.
    """
    from fegear.design.robustness.tolerance_draws import Limits
    # DROP

    part = tolerance_part(scene)
    kinds = _of_flanks(part, usual)
    found: list[dict[Deviation, float]] = []
    for member in MEMBERS:
        gear = gear_name(scene, name, member)
        drawn = scene.case.gear[gear]
        try:
            found.append(gear_deviations(drawn, scene.gears[gear], drawn.tolerance_class, kinds))
        except InputError as error:
            missing = ", ".join(one for one in kinds if own_deviation(drawn, one) is None)
            remedy = f"give {missing} of gear.{gear}.deviations, or name other robustness.deviations"
            error = type(error)(error.key, error.value, error.rule, remedy)
            raise at(f"gear.{gear}", error, None if drawn.is_helical else {"normal_module": "module"}) from None

    def both(kind: Deviation) -> tuple[float, float]:
        return found[0].get(kind, 0.0), found[1].get(kind, 0.0)

    wanted = "centre-distance" in (part.deviations or usual)
    return Limits(
        part.centre_distance if wanted else 0.0, both("profile_slope"), both("profile_form"), both("helix_slope"),
        both("base_pitch"),
    )  # fmt: skip


def untold(scene: Scene, gears: tuple[str, str], usual: tuple[Kind, ...]) -> tuple[str, ...]:
    """Sentences on deviations that are not drawn, for the case says nothing of them."""
    kinds, told = _of_flanks(tolerance_part(scene), usual), []
    for gear in dict.fromkeys(gears):
        part = scene.case.gear[gear]
        if part.tolerance_class is not None:
            continue
        missing = [kind for kind in kinds if own_deviation(part, kind) is None]
        if len(missing) == len(kinds):
            told.append(f"Gear {gear} has no tolerance_class: its flanks are taken as the drawing's in every draw.")
        elif missing:
            told.append(
                f"Gear {gear} has no tolerance_class, and no {', '.join(missing)} among its own deviations: those are "
                "taken as the drawing's in every draw."
            )
    return tuple(told)


def _of_flanks(part: TolerancePart, usual: tuple[Kind, ...]) -> tuple[Deviation, ...]:
    """Kinds that a gear's tolerances tell."""
    return tuple(_NAMES[kind] for kind in (part.deviations or usual) if kind != "centre-distance")
