"""What is computed of a case that a page asks for: its scene, and the plan of its results and of what is shown."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.window.designs import previewed
from fegear.window.glance import crack_tasks, field_tasks, glance_tasks, plan_with
from fegear.window.on_gears import wanted_on_gears
from fegear.window.order import Ordered, in_order

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.base.solution_cache import SolutionCache
    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.engine.stage import Task
    from fegear.window.job_queue import Asked


class Wanted(NamedTuple):
    """A case that is asked for, with what a page shows of it.

    Attributes
    ----------
    scene : Scene
        While a value moves with previews of gears that would have to be solved.
    plan : Plan
        Of all of it.
    beside : list of Task
        Of the small pictures and the numbers.
    on_gears : dict of str to float
        Tasks of what is switched on at the gears and follows a value that moves: stress inside, whose gears are solved,
        does not. No seconds are waited for: it is in sight.
    told : list of dict
        What can be said of things switched on at once.
    planned : callable
        Makes the plan of the same case with other gears from atlases.
    """

    scene: Scene
    plan: Plan
    beside: list[Task]
    on_gears: dict[str, float]
    told: list[dict[str, Any]]
    planned: Callable[[Scene], Plan]

    def in_order(self, asked: Asked, seconds: Mapping[str, float]) -> Ordered:
        """Its plan with what is waited for first; `seconds` are what tasks took before."""
        sight, taken = (*asked.sight, *self.on_gears), {**seconds, **self.on_gears}
        return in_order(self.plan, self.scene, sight, taken, self.beside)


def wanted_of(asked: Asked, cache: SolutionCache | None = None, before: frozenset[str] = frozenset()) -> Wanted:
    """Read a case and plan it.

    Parameters
    ----------
    asked : Asked
    cache : SolutionCache, optional
        With it gears that are not known there have previews, for a value that moves.
    before : frozenset of str
        Gears that had some at the place before.

    Raises
    ------
    FegearError
        If the case is refused.
    """
    scene = scene_of(asked)
    more, told = wanted_on_gears(scene, asked.shows)
    more += crack_tasks(scene) if asked.pictures is not None else []
    beside = glance_tasks(scene, asked.pictures) if asked.pictures is not None else []
    inside = field_tasks(scene) if asked.field else []
    planned = partial(plan_with, beside=[*beside, *inside], more=more)
    scene, plan = (scene, planned(scene)) if cache is None else previewed(scene, planned, cache, before)
    on_gears = dict.fromkeys(map(str, more if asked.moving else [*more, *inside]), 0.0)
    return Wanted(scene, plan, beside, on_gears, told, planned)


def scene_of(asked: Asked) -> Scene:
    """The scene of a case that is asked for, with its tolerance loosened or tightened where the page says so."""
    from fegear.case.reading import build_scene, parse_document

    document = parse_document(asked.text, f'"{asked.name}.toml"')
    scene = build_scene(document, asked.name, Path(asked.folder), within=asked.within)
    if asked.loosened != 1.0:
        tolerance = min(max(scene.case.accuracy.tolerance * asked.loosened, 1e-6), 0.5)
        accuracy = {**dict(document.get("accuracy", {})), "tolerance": tolerance}
        scene = build_scene({**document, "accuracy": accuracy}, asked.name, Path(asked.folder), within=asked.within)
    return replace(scene, text=asked.text, estimates=not asked.moving)
