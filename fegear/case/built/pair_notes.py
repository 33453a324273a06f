"""What a run says of a loaded pair of plane teeth: data that its effects neglect, values that are assumed, tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.notes import failing, neglecting
from fegear.case.built.members import gear_name
from fegear.case.built.table_ends import table_end_notes
from fegear.geometry.pair import MEMBERS
from fegear.geometry.plausible_flanks import heavy_load

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.pair_spec import PairSpec


def pair_notes(scene: Scene, spec: PairSpec) -> tuple[str, ...]:
    """All of them, of a pair of which a case made the spec."""
    notes = tuple(dict.fromkeys((*effect_notes(scene, spec.name), *table_end_notes(spec))))
    if spec.table is not None:
        from fegear.contact.plane.table_compliance import table_note

        if sentence := table_note(spec.pair, spec.table.x, spec.table.of):
            notes += (f"Pair {spec.name}: {sentence}",)
    return notes


def odd_teeth_notes(scene: Scene, name: str) -> tuple[str, ...]:
    """Where the odd teeth of a 3D pair count."""
    gears = dict.fromkeys(gear_name(scene, name, member) for member in MEMBERS)
    return tuple(note for gear in gears for note in _odd_teeth(scene, gear, wide=True))


def end_notes(scene: Scene, name: str) -> tuple[str, ...]:
    """That a pair of loaded coast flanks counts its ends from the other side than the keys of its gears."""
    gears = dict.fromkeys(gear_name(scene, name, member) for member in MEMBERS)
    seen = [gear for gear in gears if scene.gears[gear].tooth.working_flank == "coast"]
    given = {
        key
        for gear in seen
        for part, key in (scene.case.gear[gear].lead_of("coast"), scene.case.gear[gear].measured_of("coast"))
        if part is not None
    }
    if not (given and scene.case.effects.relief):
        return ()
    keys = " and ".join(sorted(given))
    seen_from = "coast flanks loaded, face position z from the other side"
    return (f"Pair {name}: {seen_from}; end I of {keys} is at positive z here.",)


def _odd_teeth(scene: Scene, gear: str, *, wide: bool) -> list[str]:
    if not scene.case.gear[gear].odd_tooth:
        return []
    if not scene.case.effects.odd_teeth:
        return [neglecting(f"Gear {gear}: odd_tooth ignored because effects.odd_teeth is off (identical teeth).")]
    where = (
        "results over a revolution only (mesh-stiffness-revolution)"
        if wide
        else "results over a revolution, of the train and of the gear only (mesh-stiffness-revolution, "
        "crosscheck, stress-intensity, odd-tooth-stiffness, planet-revolution, planet-vibration-revolution, FMU)"
    )
    return [neglecting(f"Gear {gear}: odd_tooth is included in {where}; here all teeth are identical.")]


def effect_notes(scene: Scene, name: str) -> tuple[str, ...]:
    """Data of the pair that its effects neglect, values assumed for what is not given, corners that cannot touch."""
    from fegear.case.built.rated_duty import bore_remarks, width_remarks
    from fegear.geometry.tip_interference import below_form_circle, below_form_sentence

    notes: list[str] = []
    effects = scene.case.effects
    for gear in dict.fromkeys(gear_name(scene, name, member) for member in MEMBERS):
        part = scene.case.gear[gear]
        if part.relieved and not effects.relief:
            notes.append(
                neglecting(f"Gear {gear}: relief ignored because effects.relief is off (unmodified involute flanks).")
            )
        if part.spacing_errors is not None and not effects.spacing_errors:
            notes.append(neglecting(f"Gear {gear}: spacing_errors ignored because the effect is off (uniform pitch)."))
        notes += _odd_teeth(scene, gear, wide=False)
        if part.over_face:
            notes.append(
                neglecting(
                    f"Gear {gear}: {' and '.join(part.over_face)} ignored in the plane (2D) model, which has no "
                    f'variation along the face; set width = "solid" for pair {name}.'
                )
            )
        notes += width_remarks(scene, gear)
        if scene.case.pair[name].compliance.source == "fe":
            notes += bore_remarks(scene, gear)
    given = [key for key in ("misalignment", "line_error", "modification") if getattr(scene.case.pair[name], key)]
    if given:
        notes.append(
            neglecting(
                f"Pair {name}: {' and '.join(given)} ignored in the plane (2D) model, which has no variation along the "
                'face; set width = "solid".'
            )
        )
    pair = scene.pairs[name]
    if sentence := heavy_load(pair, max(scene.case.pair[name].all_loads(pair), default=0.0)):
        notes.append(failing(f"Pair {name}: {sentence}"))
    if effects.corner_contact:
        notes += [
            failing(f"Pair {name}: {below_form_sentence(member)}.")
            for member in MEMBERS
            if below_form_circle(pair, member)
        ]
    return tuple(notes)
