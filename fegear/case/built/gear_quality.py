"""How well a gear is made, for a rating by ISO 6336: class or own deviations, roughness, tip relief."""

from __future__ import annotations

from fegear.base.errors import InputError
from fegear.base.notes import assuming, neglecting
from fegear.case.built.gear_deviations import Deviation, gear_deviations
from fegear.case.gear import GearPart
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.formulas.iso6336.rated import Quality
from fegear.geometry.gear import Gear

#: What is taken where a case says nothing: Rz of flanks and fillets [m].
USUAL_FLANK, USUAL_ROOT = 4.8e-6, 20e-6

#: Deviations that a rating asks for.
_RATED: tuple[Deviation, ...] = ("base_pitch", "profile_form", "helix_slope")

#: What a gear outside the sizes of ISO 1328-1 has to say, as an example.
_OWN = 'deviations = { base_pitch = "5 um", profile_form = "4 um", helix_slope = "6 um" }'


def gear_quality(scene: Scene, name: str, gear: str, said: list[str]) -> Quality:
    """How well a gear is made; what had to be assumed goes to `said`."""
    part, made = scene.case.gear[gear], scene.gears[gear]
    grade = part.tolerance_class
    if grade is None:
        grade = max(scene.case.pair[name].iso_6336.accuracy_grade, 1)
        rest = "" if part.deviations is None else " for deviations not specified"
        said.append(
            assuming(
                f"Gear {gear}: tolerance class {grade} assumed{rest} (from iso_6336.accuracy_grade; specify "
                "tolerance_class)."
            )
        )
    pitch, form, slope = _deviations(part, made, grade, gear)
    rough = part.roughness
    flank, root = (None, None) if rough is None else (rough.flank_height, rough.root_height)
    if flank is None:
        said.append(assuming(f"Gear {gear}: flank roughness Rz = {USUAL_FLANK * 1e6:g} um assumed (roughness)."))
    if root is None:
        said.append(assuming(f"Gear {gear}: root fillet roughness Rz = {USUAL_ROOT * 1e6:g} um assumed (roughness)."))
    return Quality(
        grade, pitch, form, slope, flank or USUAL_FLANK, root or USUAL_ROOT, _tip_relief(scene, gear, part, said)
    )  # fmt: skip


def _deviations(part: GearPart, made: Gear, grade: int, gear: str) -> tuple[float, float, float]:
    """f_pb, f_falpha and f_Hbeta [m]: the gear's own, else by class."""
    try:
        found = gear_deviations(part, made, grade, _RATED, rounded=True)
    except InputError as error:
        remedy = f"specify gear.{gear}.{_OWN}: required for the rating, tolerance classes do not cover this gear"
        error = type(error)(error.key, error.value, error.rule, remedy)
        raise at(f"gear.{gear}", error, {"normal_module": "module"} if not part.is_helical else None) from None
    return found["base_pitch"], found["profile_form"], found["helix_slope"]


def _tip_relief(scene: Scene, gear: str, part: GearPart, said: list[str]) -> float:
    """C_a that the case gives [m]; 0 without, and where the effect is off."""
    amounts = [end.amount for end in part.relief.tip if end.amount] if part.relief else []
    if not amounts:
        return 0.0
    if not scene.case.effects.relief:
        said.append(neglecting(f"Gear {gear}: relief ignored in the rating because effects.relief is off."))
        return 0.0
    return float(max(amounts))
