"""A first answer where a gear has to be solved anew: the same results at a coarser tolerance, told as a draft."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from fegear.engine.plan import make_plan
from fegear.engine.run import key_without_needs
from fegear.results.catalogue import STAGES
from fegear.window.order import in_order

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.solution_cache import SolutionCache

#: Tolerance of a draft. Transmission errors and root stresses of the gallery's gears differ by 1e-4 to 1e-3 from those
#: at 1e-3, and a gear takes half the time or less.
TOLERANCE = 0.03
#: A case that is nearly as coarse itself has none.
_COARSER = 5.0
_SOLVED = "gear-solution"


class Draft(NamedTuple):
    """What is computed before the case itself.

    Attributes
    ----------
    scene : Scene
        The case at `tolerance`, without estimates of errors.
    plan : Plan
        Of the results that come first alone.
    told : str
        What a page says of them.
    """

    scene: Scene
    plan: Plan
    told: str


def wants_draft(scene: Scene, plan: Plan, cache: SolutionCache) -> bool:
    """Whether a gear has to be solved anew, and more finely than for a draft."""
    if scene.case.accuracy.tolerance * _COARSER > TOLERANCE:
        return False
    steps = [step for step in plan.steps if step.task.stage == _SOLVED]
    return any(key_without_needs(scene, step) not in cache for step in steps)


def draft_of(scene: Scene, rough: Scene, plan: Plan, cache: SolutionCache) -> Draft | None:
    """The draft of a case; None where nothing would be coarser, because the case names its settings.

    Parameters
    ----------
    scene, rough : Scene
        The case at its own tolerance, and at that of a draft.
    plan : Plan
        Of the case.
    cache : SolutionCache
    """
    found = in_order(make_plan(rough, STAGES), rough, (), {})
    steps = found.plan.steps[: found.at_once]
    keys = {step.task: key_without_needs(scene, step) for step in plan.steps if step.task.stage == _SOLVED}
    coarser = [step for step in steps if step.task in keys and keys[step.task] != key_without_needs(rough, step)]
    if not any(keys[step.task] not in cache for step in coarser):
        return None
    own = scene.case.accuracy.tolerance
    told = f"Draft at tolerance {rough.case.accuracy.tolerance:.2g}, errors not estimated; that at {own:.2g} follows."
    return Draft(rough, replace(found.plan, steps=steps), told)
