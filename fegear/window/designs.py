"""Reliefs by theory for the case on the desk: those that leave no transmission error, and the nearest to grind.

A first answer where a gear has to be solved anew: the same results from a coarser mesh of it, reported as a draft.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.base.errors import InputError
from fegear.case.changed_text import literal, value_at, with_values
from fegear.engine.run import key_without_needs
from fegear.results.relief.relief_in_case import relief_for_case, what_it_leaves
from fegear.window.order import ANSWERS, in_order

if TYPE_CHECKING:
    from fegear.base.solution_cache import SolutionCache
    from fegear.case.changed_text import Path
    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.engine.run import Results
    from fegear.results.relief.relief_in_case import How
    from fegear.window.job_queue import Asked


def design_asked(asked: Asked, pair: str, how: How) -> Asked:
    """The case that is computed for a design: its result is ``relief``, for that pair.

    Raises
    ------
    InputError
        If reliefs to grind are wanted and the case allows no shape of them, or both gears are one.
    """
    from fegear.case.reading import parse_document

    document = parse_document(asked.text, f'"{asked.name}.toml"')
    driver, driven = (value_at(document, ("pair", pair, member)) for member in ("driver", "driven"))
    if driver == driven:
        raise InputError(
            f"pair.{pair}.driven", f'"{driven}"', "is also the driver; the design needs separate gears",
            "use a separate name for the driven gear",
        )  # fmt: skip
    if how == "ground" and value_at(document, ("design", "grind")) == []:
        raise InputError(
            "design.grind", "[]", "contains no grindable shape of relief", 'set grind = ["linear", "parabolic"]'
        )
    changes: dict[Path, str | None] = {("results",): '["relief"]', ("design", "pair"): literal(pair)}
    if how == "exact":
        changes["design", "grind"] = "[]"
    return asked._replace(text=with_values(asked.text, changes))


def designed(results: Results, pair: str, how: How) -> dict[str, Any]:
    """Reliefs of both gears for the case, and what the page shows of them.

    Parameters
    ----------
    results : Results
        Of the case by `design_asked`.
    pair : str
    how : {"exact", "ground"}

    Returns
    -------
    dict
        ``reliefs`` by gear, as the case writes them (None: no relief); ``told``, what they leave, in a sentence;
        ``figures`` and ``darker`` for the page.
    """
    from fegear.engine.figure.figure import Figure
    from fegear.output.draw_plotly.layout import darker, plotly_json

    keys = (f"relief_candidates_{pair}", f"relief_{pair}")
    figures = [one for one in results.figures if isinstance(one, Figure) and one.key in keys]
    return {
        "pair": pair, "reliefs": relief_for_case(results, pair, how), "told": what_it_leaves(results, how),
        "figures": [{"key": f"designed-{one.key}", "heading": one.heading, "caption": one.caption, **plotly_json(one)}
                    for one in figures],
        "darker": darker(figures),
    }  # fmt: skip


#: How much coarser than the case a draft is, just over the square root of ten: edges of the next level, in less than
#: half the time for want of estimated errors.
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
    told = f"Preview with tolerance {tolerance:.2g} (no error estimate); result with {own:.2g} follows."
    return Draft(rough, replace(plan, steps=steps), told)
