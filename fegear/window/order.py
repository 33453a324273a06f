"""In which order the results of a case are found for somebody who watches: what a value is moved for, what is seen.

The Harris map beside the load slider: made when the case is at rest, its present load followed while it moves.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fegear.engine.sheet.load_words import loads_as_given
from fegear.output.draw_plotly.layout import darker, plotly_json
from fegear.results.pair.loaded_teeth import teeth_of
from fegear.results.relief.harris import NOW, half_and_full, load_now, slider_map

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.engine.run import Results
    from fegear.engine.stage import Task
    from fegear.results.pair.loaded_teeth import LoadedTeeth


#: What a relief, a load or a tooth is changed for: the stages whose results come first, and come while it is changed.
ANSWERS = ("load-sharing", "transmission-error", "root-stress-history")


#: What is in sight is found with them if that took no longer than this before [s].
_QUICK = 0.03


class Ordered(NamedTuple):
    """A plan in another order.

    Attributes
    ----------
    plan : Plan
        The same steps, each behind those that it needs.
    at_once : int
        So many of them are found while a value moves; the others when it stands still.
    """

    plan: Plan
    at_once: int


def in_order(
    plan: Plan, scene: Scene, sight: Collection[str], seconds: Mapping[str, float], beside: Collection[Task] = ()
) -> Ordered:
    """Put the answers first, then what is in sight, then the rest.

    Parameters
    ----------
    plan : Plan
    scene : Scene
    sight : collection of str
        Tasks whose results are in sight on a page.
    seconds : mapping of str to float
        What tasks took before.
    beside : collection of Task
        Those of the small pictures, which are always in sight: answers, too.

    Returns
    -------
    Ordered
        Without any of `ANSWERS` what is in sight is found at once; where nothing is, all is.
    """
    steps = {step.task: step for step in plan.steps}
    order: dict[Task, None] = {}

    def add(tasks: Iterable[Task]) -> None:
        for task in tasks:
            if task not in order:
                add(need for need in steps[task].stage.needs(scene, task.subject) if need in steps)
                order[task] = None

    seen = [task for task in steps if str(task) in sight]
    answers = [task for task in steps if task.stage in ANSWERS or task in beside]
    add(answers or seen or steps)
    add(task for task in seen if seconds.get(str(task), _QUICK + 1.0) <= _QUICK)
    at_once = len(order)
    add(seen)
    add(steps)
    return Ordered(replace(plan, steps=tuple(steps[task] for task in order)), at_once)


#: A slider goes to so many times the load that it began with, and stands there until the load is beyond or below.
_MOST, _LEAST = 2.0, 0.02


class HarrisMaps:
    """Maps of the pairs of one case, over the range of their sliders."""

    def __init__(self) -> None:
        self._begun: dict[str, float] = {}

    def at_rest(self, results: Results) -> dict[str, dict[str, Any]]:
        """The map of every pair that is loaded, by the pair's name."""
        found = {}
        for task, outcome in results.outcomes.items():
            teeth = teeth_of(task, outcome.data)
            if teeth is None:
                continue
            load = teeth.nominal
            begun = self._begun.get(task.subject, load)
            if not _LEAST * begun <= load <= _MOST * begun:
                begun = load
            self._begun[task.subject] = begun
            with loads_as_given(results.scene, task.subject):
                figure = slider_map(task.subject, teeth, _MOST * begun)
            half, full = half_and_full(teeth)
            drawn = {"key": figure.key, "heading": figure.heading, "caption": figure.caption, **plotly_json(figure)}
            found[task.subject] = {
                "figure": drawn, "darker": darker([figure]), "now": NOW, "half": half, "full": full,
            }  # fmt: skip
        return found


def load_now_of(pair: str, teeth: LoadedTeeth) -> dict[str, Any]:
    """The curve of the present load of a pair, for a map that is there."""
    load, x, te = load_now(teeth)
    return {"pair": pair, "load": load, "x": np.round(x, 6).tolist(), "te": np.round(te, 6).tolist()}
