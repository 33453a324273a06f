"""Reliefs by theory for the case on the desk: those that leave no transmission error, and the nearest to grind.

A first answer where a gear has to be solved anew: the same results with its teeth from an atlas, or else from a coarser
mesh of it, reported as a draft.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.base.errors import FegearError, InputError
from fegear.case.changed_text import literal, value_at, with_values
from fegear.engine.plan import Step
from fegear.engine.run import key_without_needs
from fegear.engine.sheet.load_words import loads_as_given
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.results.relief.relief_in_case import relief_for_case, what_it_leaves
from fegear.window.order import ANSWERS, in_order

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

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
        "pair": pair, "reliefs": relief_for_case(results, pair, how), "told": _said_of(results, pair, how),
        "figures": [{"key": f"designed-{one.key}", "heading": one.heading, "caption": one.caption, **plotly_json(one)}
                    for one in figures],
        "darker": darker(figures),
    }  # fmt: skip


def _said_of(results: Results, pair: str, how: How) -> str:
    """What the reliefs leave, at the load as the case gives it."""
    with loads_as_given(results.scene, pair):
        return what_it_leaves(results, how)


#: How much coarser than the case a draft is, just over the square root of ten: edges of the next level, in less than
#: half the time for want of estimated errors.
_COARSER = 3.2


#: A draft at 1e-3 takes a sixth of a second; a finer case gets the same one. One as coarse as this takes as long.
_FINEST, _COARSEST = 1e-3, 6e-3


#: Tolerance of gears that no atlas has, while a value moves: 25 ms a gear, half of what a tenth of it takes.
#: Transmission error and root stress of ten such gears were off by 0.42 % at most.
_MOVED = 5e-2


_SOLVED, _SOLID = "gear-solution", "solid-solution"


#: A case must ask for something: what every case can have.
_CHEAP = "geometry"
#: What stands at one glance of them besides.
_OVER_FACE = ("load-distribution",)


class Draft(NamedTuple):
    """What is computed before the case itself.

    Attributes
    ----------
    scene : Scene
        The case with previews or drafts of the gears that are to be solved anew, without estimates of errors; gears
        that are known are taken as they are.
    plan : Plan
        Of the results that come first alone.
    told : str
        What a page says of them.
    """

    scene: Scene
    plan: Plan
    told: str


def anew_of(scene: Scene, plan: Plan, cache: SolutionCache) -> tuple[Step, ...]:
    """Gears of a plan that are to be solved, and that nobody knows yet."""
    solved = (step for step in plan.steps if step.task.stage == _SOLVED)
    return tuple(step for step in solved if key_without_needs(scene, step) not in cache)


def previews_again(scene: Scene, before: frozenset[str], cache: SolutionCache) -> Scene:
    """The case with previews of those gears that had some before, as far as an atlas answers and nobody knows them."""
    stage = STAGES.called(_SOLVED)
    again = (Step(Task(_SOLVED, gear), stage, (), ()) for gear in sorted(before) if gear in stage.subjects(scene))
    return with_previews(scene, [step for step in again if key_without_needs(scene, step) not in cache])


def with_previews(scene: Scene, anew: Iterable[Step]) -> Scene:
    """The case with gears from an atlas, of some that one answers about: for a first answer, before they are solved.

    An atlas's error counts as that of a draft does.
    """
    from fegear.results.gear.solved_gear import held_by_atlases

    enough = _COARSER * max(scene.case.accuracy.tolerance, _FINEST)
    held = held_by_atlases(scene, (step.task.subject for step in anew), enough)
    return replace(scene, previews=held) if held else scene


def previewed(
    scene: Scene, planned: Callable[[Scene], Plan], cache: SolutionCache, before: frozenset[str]
) -> tuple[Scene, Plan]:
    """A case with gears from an atlas in place of those to be solved, and its plan, while a value moves.

    Mostly these are the gears that had previews `before`: a plan with them proves it, and is the only one. Gears that
    no atlas has are solved on coarse meshes without an estimate of their errors.
    """
    from fegear.results.gear.solved_gear import ATLAS

    if before and (likely := previews_again(scene, before, cache)).previews == before:
        plan = planned(likely)
        solved = {step.task.subject for step in anew_of(scene, plan, cache)}
        if {step.task.subject for step in plan.steps if step.task.stage == ATLAS} == before >= solved:
            return likely, plan
    plan = planned(scene)
    anew = anew_of(scene, plan, cache)
    scene = with_previews(scene, anew)
    plan = planned(scene) if scene.previews else plan
    return with_drafts(scene, anew, max(scene.case.accuracy.tolerance, _MOVED)), plan


def with_drafts(scene: Scene, anew: Iterable[Step], tolerance: float) -> Scene:
    """The case with drafts of those gears to be solved that have no previews; without estimates of errors.

    A gear whose settings the case names is solved with them: it has no draft.
    """
    coarse = [step for step in anew if step.task.subject not in scene.previews]
    rough = replace(scene, drafts={step.task.subject: tolerance for step in coarse}, estimates=False)
    drafts = {
        step.task.subject: tolerance
        for step in coarse if key_without_needs(scene, step) != key_without_needs(rough, step)
    }  # fmt: skip
    return replace(scene, drafts=drafts, estimates=False) if drafts else scene


def draft_of(scene: Scene, plan: Plan, cache: SolutionCache, planned: Callable[[Scene], Plan]) -> Draft | None:
    """The draft of a case; None where it has no answers, every gear is known, or nothing would be faster.

    Parameters
    ----------
    scene : Scene
    plan : Plan
        Of the case.
    cache : SolutionCache
    planned : callable
        Makes the plan of the same case with previews.
    """
    return _sliced_draft(scene, plan, cache) or _coarse_draft(scene, plan, cache, planned)


def _sliced_draft(scene: Scene, plan: Plan, cache: SolutionCache) -> Draft | None:
    """Pairs with a width from coupled slices, which take a fraction of the time of solid gears."""
    from fegear.engine.plan import make_plan
    from fegear.studies.sliced_draft import can_be_sliced, sliced

    solved = [step for step in plan.steps if step.task.stage == _SOLID]
    if all(key_without_needs(scene, step) in cache for step in solved):
        return None
    pairs = [name for name in scene.wide_pairs if can_be_sliced(scene, name)]
    wanted = [
        step.task for step in plan.steps
        if step.task.stage in (*ANSWERS, *_OVER_FACE) and step.task.subject in (*pairs, *scene.plane_pairs)
    ]  # fmt: skip
    if not any(task.subject in pairs for task in wanted):
        return None
    try:
        rough = sliced(scene, [_CHEAP])
        drafted = make_plan(rough, STAGES, wanted)
    except FegearError:  # slices refuse what solids take: there is no draft
        return None
    told = "Preview by coupled slices (no error estimate); result with 3D gears follows."
    return Draft(rough, replace(drafted, steps=tuple(one for one in drafted.steps if one.task.stage != _CHEAP)), told)


def _coarse_draft(scene: Scene, plan: Plan, cache: SolutionCache, planned: Callable[[Scene], Plan]) -> Draft | None:
    """Plane pairs with those gears that are solved anew from an atlas, or from coarser meshes."""
    own = scene.case.accuracy.tolerance
    if own > _COARSEST or not any(step.task.stage in ANSWERS for step in plan.steps):
        return None  # without them everything comes first, and a robustness or a motion would be computed twice
    ordered = in_order(plan, scene, (), {})
    anew = anew_of(scene, replace(plan, steps=ordered.plan.steps[: ordered.at_once]), cache)
    rough = with_drafts(replace(with_previews(scene, anew), estimates=False), anew, _COARSER * max(own, _FINEST))
    if not (rough.previews or rough.drafts):
        return None
    first = in_order(planned(rough) if rough.previews else plan, rough, (), {})
    told = f"{preview_told(rough)} (no error estimate); result with {own:.2g} follows."
    return Draft(rough, replace(first.plan, steps=first.plan.steps[: first.at_once]), told)


def preview_told(scene: Scene) -> str:
    """What a page says of answers from an atlas or coarse meshes; empty where none are."""
    coarse = f"with tolerance {max(scene.drafts.values()):.2g}" if scene.drafts else ""
    if not scene.previews:
        return f"Preview {coarse}" if coarse else ""
    names = ", ".join(sorted(scene.previews))
    gears = f"gear {names}" if len(scene.previews) == 1 else f"gears {names}"
    return f"Preview: {gears} interpolated from an atlas{f', others {coarse}' if coarse else ''}"
