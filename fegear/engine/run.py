"""Run a plan: every task once, in order, computed or recalled, with its seconds."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple, Protocol

from fegear.base.arrays import Alike
from fegear.base.cache_keys import Key
from fegear.base.errors import InputError
from fegear.base.notes import Note, NoteClass, class_of, ordered
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import Scene
from fegear.engine.executor import Executor
from fegear.engine.extras import require
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.inexact import inexact_values
from fegear.engine.named import Named
from fegear.engine.outcome import Outcome
from fegear.engine.plan import ON_REQUEST, Plan, Step
from fegear.engine.run_answer import RunAnswer, answer_of_run
from fegear.engine.sheet.load_words import loads_as_given
from fegear.engine.stage import Task, Work
from fegear.engine.table import Table
from fegear.engine.value import Value

NOTHING_FOR_A_CLUSTER = (
    "--scheduler has no effect: no result of this run can be distributed. Use it with sweeps, design-chart or "
    "robustness ([robustness])."
)


class Watcher(Protocol):
    """Who follows the progress of a run (a progress bar, a log)."""

    def begin(self, title: str, number: int, count: int) -> None:
        """Report that a task starts."""

    def advance(self, fraction: float) -> None:
        """Report how far the task is."""

    def end(self, seconds: float) -> None:
        """Report that the task is finished."""


class Silence:
    """A watcher that says nothing."""

    def begin(self, title: str, number: int, count: int) -> None:
        """Say nothing."""

    def advance(self, fraction: float) -> None:
        """Say nothing."""

    def end(self, seconds: float) -> None:
        """Say nothing."""


class Timing(NamedTuple):
    """What a task took now.

    Attributes
    ----------
    seconds : float
        From its inputs to its tables.
    recalled : bool
        Whether its result was known before and only presented now.
    when_computed : float
        Seconds that its result took when it was computed: now, or then.
    shapes : int
        Tooth shapes that it recalled on its way.
    from_disk : int
        Those of them that an earlier run had kept on disk.
    spared : float
        Seconds that the shapes recalled took when they were solved.
    processor : float
        CPU seconds of this process and of those that it started and waited for.
    """

    seconds: float
    recalled: bool = False
    when_computed: float = 0.0
    shapes: int = 0
    from_disk: int = 0
    spared: float = 0.0
    processor: float = 0.0

    @property
    def origin(self) -> str:
        """``computed`` or ``recalled``."""
        return "recalled" if self.recalled else "computed"


@dataclass(frozen=True)
class Results(Alike):
    """Everything that a run found; two are equal where they found the same of the same case, in whatever time.

    Attributes
    ----------
    scene : Scene
    plan : Plan
    outcomes : mapping of Task to Outcome
        In the order of the plan.
    timings : mapping of Task to Timing
    """

    scene: Scene
    plan: Plan
    outcomes: Mapping[Task, Outcome]
    timings: Mapping[Task, Timing] = field(compare=False)

    @property
    def seconds(self) -> Mapping[Task, float]:
        """What each task took now [s]."""
        return {task: timing.seconds for task, timing in self.timings.items()}

    @property
    def tables(self) -> Named[Table]:
        """All tables, in order and by name; behind them those that have a row for each of several subjects."""
        own = [table for outcome in self.outcomes.values() for table in outcome.tables]
        return Named([*own, *self.answer.overviews])

    @property
    def values(self) -> Named[Value]:
        """All single values, in order and by name."""
        return Named({value.name: value for outcome in self.outcomes.values() for value in outcome.values}.values())

    @property
    def figures(self) -> Named[Figure | DeferredFigure]:
        """All figures, in order and by name."""
        return Named(figure for outcome in self.outcomes.values() for figure in outcome.figures)

    @property
    def answer(self) -> RunAnswer:
        """What the wanted results come to: a few sentences, and the key of one figure."""
        return answer_of_run(self.plan, self.outcomes, self.scene.case.results)

    @property
    def remarks(self) -> tuple[str, ...]:
        """All remarks, each once."""
        said = [*self.plan.remarks]
        said += [remark for outcome in self.outcomes.values() for remark in outcome.remarks]
        return tuple(dict.fromkeys(said))

    @property
    def inexact(self) -> str:
        """Which values are known less well than the tolerance requires, of those that no result's own note names."""
        named = {value.name for outcome in self.outcomes.values() for value in outcome.rough}
        values = [value for value in self.values if value.name not in named]
        return inexact_values(values, self.scene.case.accuracy.tolerance)

    def notes(self, remarks: Iterable[str] | None = None, *, information: bool = True) -> tuple[Note, ...]:
        """What a reader should see first: repeats merged, the class to act on first.

        Parameters
        ----------
        remarks : iterable of str, optional
            What there is to say; by default the remarks of the run and which values are not exact enough.
        information : bool
            Whether what results say of themselves is among it; a page has it with each result.
        """
        if remarks is None:
            remarks = (*self.remarks, *((self.inexact,) if self.inexact else ()))
        own = set() if information else {one for task in self.outcomes for one in self.information(task)}
        return ordered(one for one in remarks if one not in own)

    def information(self, task: Task) -> tuple[str, ...]:
        """What a result says of itself that changes no number."""
        return tuple(one for one in self.outcomes[task].remarks if class_of(one) is NoteClass.INFORMATION)

    @property
    def cache_remarks(self) -> tuple[str, ...]:
        """What was recalled: the seconds of such tasks alone would be too few."""
        recalled = {task: timing for task, timing in self.timings.items() if timing.recalled}
        said = []
        if recalled:
            spared = sum(timing.when_computed for timing in recalled.values())
            said.append(f"From cache: {', '.join(map(str, recalled))} ({spared:.2f} s saved).")
        said += [
            f"{task}: {timing.from_disk} solution{'' if timing.from_disk == 1 else 's'} taken from the disk cache; "
            f"{timing.spared:.2f} s of computing are not included in the times reported here."
            for task, timing in self.timings.items()
            if timing.from_disk
        ]
        return tuple(said)


def run_plan(
    scene: Scene,
    plan: Plan,
    watcher: Watcher | None = None,
    following: int = 0,
    *,
    cache: SolutionCache | None = None,
    executor: Executor | None = None,
    found: Callable[[Task, Outcome], None] | None = None,
) -> Results:
    """Compute or recall every task of a plan, in order.

    Parameters
    ----------
    scene : Scene
    plan : Plan
    watcher : Watcher, optional
    following : int
        Steps that the caller will do after the plan's, so that the watcher counts them.
    cache : SolutionCache, optional
        Where results are recalled from and kept; by default one of this run's own.
    executor : Executor, optional
        Who computes points that do not depend on each other; by default processes on this machine.
    found : callable, optional
        Receives every task with its outcome as soon as it is finished; its time is not the task's.

    Returns
    -------
    Results

    Raises
    ------
    MissingLibraryError
        If a library is missing that a step computes with.
    """
    require(plan)
    watcher = watcher or Silence()
    work = Work(watcher.advance, SolutionCache() if cache is None else cache, executor or Executor())
    done: dict[Task, _Finished] = {}
    own: dict[Task, _Finished] = {}
    for number, step in enumerate(plan.steps, start=1):
        title = f"{step.stage.title} ({step.task.subject})" if step.task.subject else step.stage.title
        watcher.begin(title, number, len(plan.steps) + following)
        done[step.task] = _finish(scene, step, done, work)
        if step.reasons != (ON_REQUEST,):  # what is shown in addition may be a result of the case found in another way
            own[step.task] = done[step.task]
            _refuse_one_name_for_two(own, step.task)
        watcher.end(done[step.task].timing.seconds)
        if found is not None:
            found(step.task, done[step.task].outcome)
    if work.executor.scheduler is not None and not any(step.stage.in_points for step in plan.steps):
        plan = replace(plan, remarks=(*plan.remarks, NOTHING_FOR_A_CLUSTER))
    return Results(scene, plan, {t: one.outcome for t, one in done.items()}, {t: one.timing for t, one in done.items()})


class _Finished(NamedTuple):
    """A task's numerical result, its outcome, its key, and its timing."""

    data: object
    outcome: Outcome
    key: Key
    timing: Timing


def _refuse_one_name_for_two(done: Mapping[Task, _Finished], task: Task) -> None:
    """Pairs "I" and "harmonics_I" would write one file over the other's: names are joined to those of tables."""
    new = done[task].outcome
    for other, (_, outcome, *_) in done.items():
        for kind, here, there in (
            ("table", new.tables, outcome.tables),
            ("figure", new.figures, outcome.figures),
            ("value", new.values, outcome.values),
        ):
            same = {one.name for one in here} & {one.name for one in there}
            if kind == "value" and other.subject == task.subject:  # two results of one pair may state one number
                same -= {one.name for one in new.values for of in outcome.values if one.si == of.si}
            if other != task and same:
                raise InputError(
                    "gear, pair", f"{other.subject}, {task.subject}", f"both have a {kind} {min(same)}",
                    "rename one of them",
                )  # fmt: skip


def key_without_needs(scene: Scene, step: Step) -> Key:
    """Under which the result of a task that needs no other is known."""
    return Key.of(step.stage.name, step.inputs(scene), [])


def _processor() -> float:
    """CPU seconds of this process, and of those that it waited for."""
    children = os.times()
    return time.process_time() + children.children_user + children.children_system


def _finish(scene: Scene, step: Step, done: Mapping[Task, _Finished], work: Work) -> _Finished:
    started, before = time.perf_counter(), _processor()
    work.cache.begin()
    shapes = work.cache.shapes.state
    stage, subject = step.stage, step.task.subject
    inputs, needs = step.inputs(scene), stage.needs(scene, subject)
    # All that the result reads of the case, and the keys of what it builds on: nothing else changes its numbers.
    key = Key.of(stage.name, inputs, [done[need].key for need in needs])
    upstream = {need: done[need].data for need in needs}
    solution = work.cache.solve(key, partial(stage.compute, inputs, upstream, work))
    with loads_as_given(scene, subject):
        outcome = stage.present(solution.value, inputs)
    seconds = time.perf_counter() - started
    recalled = solution.source != "computed"
    used = work.cache.shapes.since(shapes)
    when = solution.seconds if recalled else seconds
    timing = Timing(seconds, recalled, when, used.recalled, used.from_disk, used.spared, _processor() - before)
    return _Finished(solution.value, outcome, key, timing)
