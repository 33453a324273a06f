"""What each effect needs, which stages know it and which kernels run only with it, as tables for the effects' page."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.case.effects import EffectsPart
from fegear.results.catalogue import STAGES
from fegear.studies.effect_study import felt_effects

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fegear.case.reading import Scene


@dataclass(frozen=True, slots=True)
class EffectFact:
    """What there is to know of an effect.

    Parameters
    ----------
    changes : str
        What it changes.
    needs : str
        What it needs.
    kernels : tuple of str
        Kernels of `fegear.tally.KERNELS` that run only with it, in scenes where nothing else calls for them.
    """

    changes: str
    needs: str
    kernels: tuple[str, ...]


FACTS: dict[str, EffectFact] = {
    "neighbour_coupling": EffectFact(
        "a loaded tooth deflects its neighbours and stresses their roots",
        'compliance source "fe" of plane teeth',
        ("neighbours",),
    ),
    "hertz": EffectFact(
        "contacts widen with their load (`linear`: as wide as under the nominal load)",
        "a source with a contact of its own: no table",
        ("nonlinear steps",),
    ),
    "relief": EffectFact(
        "flanks are modified",
        "`relief` on a gear; for pairs with a width also `lead`, `bias`, `topography`, and `modification` of the pair",
        ("reliefs",),
    ),
    "spacing_errors": EffectFact("teeth stand unevenly", "`spacing_errors` on a gear", ("spacing errors",)),
    "corner_contact": EffectFact(
        "tip corners touch before and after the path of contact",
        "no `friction`",
        ("corner searches", "corner contacts"),
    ),
    "contact_loss": EffectFact(
        "teeth part where they would be pulled, and meet off their turn", "results in time", ("changes of contact",)
    ),
    "friction": EffectFact(
        "teeth that slide put a torque on both gears",
        "`parametric` where it moves, no `neighbour_coupling`, no `corner_contact`",
        ("friction fits",),
    ),
    "parametric": EffectFact(
        "tooth pairs come and go: the stiffness varies in time", "results in time", ("springs in time",)
    ),
    "misalignment": EffectFact(
        "gears run with errors of axes, lead, profile and centre distance; a gap over the face counts",
        "`misalignment` of a helical pair or of one with a width, or `line_error` of one with a width",
        ("misaligned flanks",),
    ),
}


def _table(heads: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def felt_by(scenes: Iterable[Scene]) -> dict[str, set[str]]:
    """Results that each effect may change: those whose plan holds a stage that knows the effect.

    Parameters
    ----------
    scenes : iterable of Scene
        Cases that ask for the results, for which stages of others a stage needs depends on the scene.
    """
    found: dict[str, set[str]] = {effect: set() for effect in EffectsPart.model_fields}
    for scene in scenes:
        for result in scene.case.results:
            case = scene.case.model_copy(update={"results": [result]})
            for effect in felt_effects(replace(scene, case=case)):
                found[effect].add(result)
    return found


def stage_table(scenes: Iterable[Scene]) -> str:
    """Effects against the stages that know them, in Markdown, from the stages' own words."""
    rows, felt = [], felt_by(scenes)
    for effect in EffectsPart.model_fields:
        stages = [f"`{stage.name}`" for stage in STAGES if effect in stage.effects]
        fact = FACTS[effect]
        results = ", ".join(f"`{result}`" for result in sorted(felt[effect])) or "none"
        rows.append((f"`{effect}`", fact.changes, fact.needs, ", ".join(stages) or "none", results))
    return _table(("effect", "what it changes", "what it needs", "stages that know it", "results it may change"), rows)


def kernel_table() -> str:
    """Kernels that run only with an effect, in Markdown."""
    from fegear.tally import KERNELS

    rows = [
        (f"`{effect}`", "; ".join(f"{kernel} ({KERNELS[kernel]})" for kernel in fact.kernels) or "none")
        for effect, fact in FACTS.items()
    ]
    return _table(("effect", "kernels that run with it and not without it"), rows)
