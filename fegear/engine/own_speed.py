"""How fast this machine is: CPU time that tasks took in its own runs beside what was predicted for them.

What a stage predicts was measured on one machine over the cases that come with fegear. What tasks took here scales it:
those of the same stage once there are some, else all that are known.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import fegear
from fegear.base.store import cache_folder

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fegear.engine.plan import Plan
    from fegear.engine.run import Results

#: The file beside what is kept of solutions.
_FILE = "speed.json"
#: Tasks of a stage that count: the last ones.
_LAST = 8
#: What no task is predicted to take [s], and how many times that it may take, beside a second, to count.
_LONGEST, _SLOWEST = 1e7, 30.0

#: Seconds predicted and seconds taken.
Task = tuple[float, float]


@dataclass(frozen=True)
class OwnSpeed:
    """What tasks took on this machine.

    Parameters
    ----------
    tasks : mapping of str to tuple
        Of each stage, seconds predicted and taken of its last tasks.
    """

    tasks: Mapping[str, tuple[Task, ...]] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Number of tasks that are known."""
        return sum(len(tasks) for tasks in self.tasks.values())

    def factor(self, stage: str) -> float:
        """Seconds taken over seconds predicted of a stage; 1 where nothing is known."""
        known = self.tasks.get(stage) or [task for tasks in self.tasks.values() for task in tasks]
        return sum(taken for _, taken in known) / sum(predicted for predicted, _ in known) if known else 1.0

    def scaled(self, plan: Plan, predicted: Sequence[float | None]) -> list[float | None]:
        """Seconds of the steps of a plan on this machine [s]; None where they are unknown."""
        return [
            None if seconds is None else seconds * self.factor(step.stage.name)
            for step, seconds in zip(plan.steps, predicted, strict=True)
        ]

    def after(self, tasks: Iterable[tuple[str, float, float]]) -> OwnSpeed:
        """The same after more tasks: name of the stage, seconds predicted and taken."""
        found = dict(self.tasks)
        for stage, predicted, taken in tasks:
            found[stage] = (*found.get(stage, ()), (predicted, taken))[-_LAST:]
        return OwnSpeed(found)


def own_speed(folder: Path | None = None) -> OwnSpeed:
    """What is known, by default in `fegear.base.store.cache_folder`: nothing where no run of this version was made."""
    try:
        kept = json.loads(((folder or cache_folder()) / _FILE).read_text(encoding="utf-8"))
        if kept["version"] != fegear.__version__:
            return OwnSpeed()
        found = {str(stage): tuple((float(p), float(t)) for p, t in tasks) for stage, tasks in kept["tasks"].items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
        return OwnSpeed()
    return OwnSpeed(found) if all(_credible(*task) for tasks in found.values() for task in tasks) else OwnSpeed()


def _credible(predicted: float, taken: float) -> bool:
    """Whether a task tells how fast a machine is: one that stood or swapped tells what no other will take."""
    return 0.0 < predicted < _LONGEST and 0.0 < taken < _SLOWEST * predicted + 1.0


def remember(results: Results, predicted: Sequence[float | None], folder: Path | None = None) -> None:
    """Add what the tasks of a run took that were not recalled; a folder that cannot be written stops nothing.

    Parameters
    ----------
    results : Results
    predicted : sequence of float
        Seconds of its steps on the reference machine [s].
    folder : Path, optional
        See `own_speed`.
    """
    place, tasks = folder or cache_folder(), []
    for step, seconds in zip(results.plan.steps, predicted, strict=True):
        timing = results.timings[step.task]
        if seconds and _credible(seconds, timing.processor) and not (timing.recalled or timing.from_disk):
            tasks.append((step.stage.name, seconds, timing.processor))
    if not tasks:
        return
    known = own_speed(place).after(tasks)
    beside = place / f".{_FILE}.{os.getpid()}"
    with contextlib.suppress(OSError):
        place.mkdir(parents=True, exist_ok=True)
        try:
            beside.write_text(json.dumps({"version": fegear.__version__, "tasks": known.tasks}), encoding="utf-8")
            beside.replace(place / _FILE)
        finally:
            beside.unlink(missing_ok=True)
