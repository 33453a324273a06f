"""In which order the results of a case are found for somebody who watches: what a value is moved for, what is seen."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.engine.stage import Task

#: What a relief, a load or a tooth is changed for: the stages whose results come first, and come while it is changed.
ANSWERS = (
    "load-sharing", "transmission-error", "root-stress-history",
    "flank-load-sharing", "flank-transmission-error", "flank-root-stress",
)  # fmt: skip
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


def in_order(plan: Plan, scene: Scene, sight: Collection[str], seconds: Mapping[str, float]) -> Ordered:
    """Put the answers first, then what is in sight, then the rest.

    Parameters
    ----------
    plan : Plan
    scene : Scene
    sight : collection of str
        Tasks whose results are in sight on a page.
    seconds : mapping of str to float
        What tasks took before.

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
    answers = [task for task in steps if task.stage in ANSWERS]
    add(answers or seen or steps)
    add(task for task in seen if seconds.get(str(task), _QUICK + 1.0) <= _QUICK)
    at_once = len(order)
    add(seen)
    add(steps)
    return Ordered(replace(plan, steps=tuple(steps[task] for task in order)), at_once)
