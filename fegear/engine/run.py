"""Run a plan: every task once, in order, with its seconds."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, Protocol

from fegear.store import shape_keeper

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.engine.outcome import Outcome, Table, Value
    from fegear.engine.plan import Plan
    from fegear.engine.stage import Task


class Watcher(Protocol):
    """Who is told how a run goes on (a progress bar, a log)."""

    def begin(self, title: str, number: int, count: int) -> None:
        """Tell that a task starts."""

    def advance(self, fraction: float) -> None:
        """Tell how far the task is."""

    def end(self, seconds: float) -> None:
        """Tell that the task is finished."""


class Silence:
    """A watcher that says nothing."""

    def begin(self, title: str, number: int, count: int) -> None:
        """Say nothing."""

    def advance(self, fraction: float) -> None:
        """Say nothing."""

    def end(self, seconds: float) -> None:
        """Say nothing."""


class FromCache(NamedTuple):
    """Tooth shapes that a task read from the disk cache, and the seconds that they took when they were solved."""

    shapes: int
    seconds: float


@dataclass(frozen=True)
class Results:
    """Everything that a run found.

    Attributes
    ----------
    scene : Scene
    plan : Plan
    outcomes : mapping of Task to Outcome
        In the order of the plan.
    seconds : mapping of Task to float
        What each task took now.
    from_cache : mapping of Task to FromCache
        Tasks whose seconds leave out work that an earlier run did.
    """

    scene: Scene
    plan: Plan
    outcomes: Mapping[Task, Outcome]
    seconds: Mapping[Task, float]
    from_cache: Mapping[Task, FromCache] = field(default_factory=dict)

    @property
    def tables(self) -> tuple[Table, ...]:
        """All tables."""
        return tuple(table for outcome in self.outcomes.values() for table in outcome.tables)

    @property
    def values(self) -> tuple[Value, ...]:
        """All single values."""
        return tuple(value for outcome in self.outcomes.values() for value in outcome.values)

    @property
    def remarks(self) -> tuple[str, ...]:
        """All remarks, each once."""
        said = [*self.plan.remarks]
        said += [remark for outcome in self.outcomes.values() for remark in outcome.remarks]
        return tuple(dict.fromkeys(said))

    @property
    def cache_remarks(self) -> tuple[str, ...]:
        """What the disk cache spared each task: its seconds alone would tell too low a price."""
        return tuple(
            f"{task}: {found.shapes} solved tooth shapes came from the disk cache; solving them took "
            f"{found.seconds:.2f} s then, which the seconds told here leave out."
            for task, found in self.from_cache.items()
        )


def run_plan(scene: Scene, plan: Plan, watcher: Watcher | None = None, following: int = 0) -> Results:
    """Run every task of a plan.

    Parameters
    ----------
    scene : Scene
    plan : Plan
    watcher : Watcher, optional
    following : int
        Steps that the caller will do after the plan's, so that the watcher counts them.

    Returns
    -------
    Results
    """
    watcher = watcher or Silence()
    outcomes: dict[Task, Outcome] = {}
    seconds: dict[Task, float] = {}
    from_cache: dict[Task, FromCache] = {}
    for number, step in enumerate(plan.steps, start=1):
        title = f"{step.stage.title} ({step.task.subject})" if step.task.subject else step.stage.title
        watcher.begin(title, number, len(plan.steps) + following)
        keeper = shape_keeper()
        before = (keeper.read, keeper.spared) if keeper else (0, 0.0)
        start = time.perf_counter()
        outcomes[step.task] = step.stage.run(scene, step.task.subject, outcomes, watcher.advance)
        seconds[step.task] = time.perf_counter() - start
        watcher.end(seconds[step.task])
        if keeper and keeper.read > before[0]:
            from_cache[step.task] = FromCache(keeper.read - before[0], keeper.spared - before[1])
    return Results(scene, plan, outcomes, seconds, from_cache)
