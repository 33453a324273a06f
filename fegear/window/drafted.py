"""A first answer where a gear has to be solved anew: the same results from a coarser mesh of it, told as a draft."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from fegear.engine.run import key_without_needs
from fegear.window.order import ANSWERS, in_order

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.solution_cache import SolutionCache

#: How much coarser than the case a draft is, just over the square root of ten: edges of the next level. It is the
#: solution that the error of the case's own is estimated from, so that nothing is solved for the draft alone.
_COARSER = 3.2
#: A draft at 1e-3 takes a sixth of a second; a finer case gets the same one. One as coarse as this takes as long.
_FINEST, _COARSEST = 1e-3, 6e-3
_SOLVED = "gear-solution"


class Draft(NamedTuple):
    """What is computed before the case itself.

    Attributes
    ----------
    scene : Scene
        The case with drafts of the gears that are to be solved anew, without estimates of errors; gears that are known
        are taken as they are.
    plan : Plan
        Of the results that come first alone.
    told : str
        What a page says of them.
    """

    scene: Scene
    plan: Plan
    told: str


def draft_of(scene: Scene, plan: Plan, cache: SolutionCache) -> Draft | None:
    """The draft of a case; None where it has no answers, every gear is known, or nothing would be coarser.

    Parameters
    ----------
    scene : Scene
    plan : Plan
        Of the case.
    cache : SolutionCache
    """
    own = scene.case.accuracy.tolerance
    if own > _COARSEST or not any(step.task.stage in ANSWERS for step in plan.steps):
        return None  # without them everything comes first, and a robustness or a motion would be computed twice
    ordered = in_order(plan, scene, (), {})
    steps = ordered.plan.steps[: ordered.at_once]
    solved = [step for step in steps if step.task.stage == _SOLVED]
    anew = [step for step in solved if key_without_needs(scene, step) not in cache]
    tolerance = _COARSER * max(own, _FINEST)
    rough = replace(scene, estimates=False, drafts={step.task.subject: tolerance for step in anew})
    # A case that names its settings is solved with them.
    if not any(key_without_needs(scene, step) != key_without_needs(rough, step) for step in anew):
        return None
    told = f"Draft on a mesh for a tolerance of {tolerance:.2g}, errors not estimated; that at {own:.2g} follows."
    return Draft(rough, replace(plan, steps=steps), told)
