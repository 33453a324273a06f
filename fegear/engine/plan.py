"""The plan: which tasks the wanted results need, in order, why each runs and why the others do not.

A plan in words, for ``fegear plan``: what runs and why, with which settings, for how long, and what does not run.

Stages by name: what each is called stands in the catalogue, how it computes in a module that is imported at need.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any, NamedTuple, overload

from fegear.base.errors import GeometryError, InputError
from fegear.case.part import nearest
from fegear.case.reading import Scene
from fegear.case.trade_words import of_result
from fegear.engine.stage import Stage, Task


class Entry(NamedTuple):
    """What a stage is called.

    Attributes
    ----------
    name : str
        Unique; also the first half of its tasks' names.
    home : str
        Module and name of the `Stage` that computes it: ``"pair.load_sharing.LOAD_SHARING"``.
    title : str
        What it does, for the plan and the progress bar.
    results : tuple of str
        Names by which ``results = [...]`` asks for it; empty for stages that only serve others.
    about : str
        What its results say, in a line; empty for stages that only serve others.
    extra : str
        What of `fegear.engine.extras` it needs besides fegear itself; empty for most.
    formerly : str
        Name by which older cases ask for it; empty for most.
    effects : tuple of str
        Effects that change what it computes.
    """

    name: str
    home: str
    title: str
    results: tuple[str, ...] = ()
    about: str = ""
    extra: str = ""
    formerly: str = ""
    effects: tuple[str, ...] = ()


class Catalogue(Sequence[Stage]):
    """Stages in order; each is imported when it is first asked for.

    Parameters
    ----------
    entries : iterable of Entry
    package : str
        Where their homes are.
    """

    def __init__(self, entries: Iterable[Entry], package: str) -> None:
        self.entries = tuple(entries)
        self._package = package
        self._by_name = {entry.name: entry for entry in self.entries}
        self._loaded: dict[str, Stage] = {}

    @classmethod
    def of(cls, stages: Sequence[Stage]) -> Catalogue:
        """A catalogue, or one of stages that are at hand."""
        if isinstance(stages, cls):
            return stages
        made = cls(
            (
                Entry(stage.name, "", stage.title, stage.results, stage.about, stage.extra, effects=stage.effects)
                for stage in stages
            ),
            "",
        )
        made._loaded.update({stage.name: stage for stage in stages})
        return made

    def called(self, name: str) -> Stage:
        """A stage by its name.

        Raises
        ------
        KeyError
            If there is none.
        """
        if name not in self._loaded:
            entry = self._by_name[name]
            module, _, attribute = entry.home.rpartition(".")
            found: Stage = getattr(import_module(f"{self._package}.{module}"), attribute)
            named = replace(
                found, name=name, title=entry.title, results=entry.results, about=entry.about, extra=entry.extra,
                effects=entry.effects,
            )  # fmt: skip
            # Of two threads that get here at once, both go on with the same stage.
            self._loaded.setdefault(name, named)
        return self._loaded[name]

    def holds(self, stage: Stage) -> bool:
        """Whether it is one of these."""
        return self._loaded.get(stage.name) is stage

    def by_result(self) -> dict[str, list[str]]:
        """Names of the stages that every result asks for."""
        found: dict[str, list[str]] = {}
        for entry in self.entries:
            for result in entry.results:
                found.setdefault(result, []).append(entry.name)
        return found

    def former(self) -> dict[str, str]:
        """Names of results by the names that they had before."""
        return {entry.formerly: entry.results[0] for entry in self.entries if entry.formerly}

    def __len__(self) -> int:
        return len(self.entries)

    def __iter__(self) -> Iterator[Stage]:
        return (self.called(entry.name) for entry in self.entries)

    @overload
    def __getitem__(self, index: int) -> Stage: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Stage, ...]: ...

    def __getitem__(self, index: int | slice) -> Stage | tuple[Stage, ...]:
        if isinstance(index, slice):
            return tuple(self.called(entry.name) for entry in self.entries[index])
        return self.called(self.entries[index].name)


#: Why a task runs that no result of the case asks for.
ON_REQUEST = "shown on request"


@dataclass(frozen=True, slots=True)
class Step:
    """One task of the plan, the reasons for it, effects that change it, and the stages that read it."""

    task: Task
    stage: Stage
    reasons: tuple[str, ...]
    effects: tuple[str, ...]
    readers: tuple[Stage, ...] = ()

    def inputs(self, scene: Scene) -> Any:
        """All that its result reads of the case."""
        inputs, for_readers = self.stage.inputs(scene, self.task.subject), self.stage.for_readers
        return inputs if for_readers is None else for_readers(inputs, self.readers)


@dataclass(frozen=True, slots=True)
class Plan:
    """What will be computed, in order, and what not.

    Attributes
    ----------
    steps : tuple of Step
    skipped : tuple of (stage name, reason)
    idle_effects : tuple of str
        Effects that are on but that no step uses.
    remarks : tuple of str
        The same in words, with the results that would use them; before them the results that are asked for by a name
        that they had before.
    """

    steps: tuple[Step, ...]
    skipped: tuple[tuple[str, str], ...]
    idle_effects: tuple[str, ...]
    remarks: tuple[str, ...] = ()


def _straight(scene: Scene) -> str:
    """What a case of helical gears alone should know of results that are about spur gears."""
    alone = bool(scene.gears) and not scene.spur_gears
    return ": it may be about spur gears, and those of this case are helical" if alone else ""


def make_plan(scene: Scene, stages: Sequence[Stage], more: Sequence[Task] = ()) -> Plan:
    """Derive the tasks from the wanted results.

    Parameters
    ----------
    scene : Scene
    stages : sequence of Stage
    more : sequence of Task
        Wanted besides the case's results, after them: what a page shows on request.

    Raises
    ------
    InputError
        If a result is unknown, or the scene lacks what a stage needs: a part, or an effect.
    """
    known = Catalogue.of(stages)
    by_result, former = known.by_result(), known.former()
    wanted = list(dict.fromkeys(former.get(result, result) for result in scene.case.results))

    reasons: dict[Task, list[str]] = {}
    order: list[Task] = []
    under: dict[Task, dict[Task, None]] = {}

    def require(task: Task, reason: str, result: str = "") -> None:
        if task in reasons:
            if reason not in reasons[task]:
                reasons[task].append(reason)
            return
        stage = known.called(task.stage)
        _require_effects(scene, stage, wanted)
        _refuse_twice(stage, wanted)
        _refuse_internal(scene, stage, task.subject, result)
        _refuse_fouling(scene, stage, task.subject)
        stage.check(scene, task.subject)
        reasons[task], needs = [reason], stage.needs(scene, task.subject)
        for need in needs:
            require(need, f"needed by {task}", result)
        order.append(task)
        under[task] = dict.fromkeys((*(below for need in needs for below in under[need]), *needs))

    for result in wanted:
        if result not in by_result:
            rule, remedy = "is no result that fegear knows", nearest(result, by_result, '"fegear results"', of_result)
            raise InputError("results", f'"{result}"', rule, remedy)
        asked = [known.called(name) for name in by_result[result]]
        described = [(stage, subject) for stage in asked for subject in stage.subjects(scene)]
        if not described:
            raise InputError(
                "results",
                f'"{result}"',
                "asks for something that this case does not describe",
                "add the gear, pair or train that it is about" + _straight(scene),
            )
        for stage, subject in described:
            require(Task(stage.name, subject), f'requested by results = ["{result}"]', result)

    for task in more:
        require(task, ON_REQUEST)

    on = scene.case.effects.on()
    stages_of = {task: known.called(task.stage) for task in order}
    steps = tuple(
        Step(
            task, stage, tuple(reasons[task]), tuple(e for e in on if e in stage.effects_on(scene, task.subject)),
            tuple(reader for other, reader in stages_of.items() if task in under[other]),
        )
        for task, stage in stages_of.items()
    )  # fmt: skip
    for step in steps:
        step.inputs(scene)  # what a run would refuse as it begins a step, after others have taken their time
    running = {step.stage.name for step in steps}
    skipped = tuple((one.name, _why_not(one, wanted)) for one in known.entries if one.name not in running)
    used = {effect for step in steps for effect in step.effects}
    # What `fegear cost` studies in this case is wanted too, if not by a run.
    used |= {effect for entry in known.entries if entry.name in scene.case.cost.stages for effect in entry.effects}
    idle = tuple(effect for effect in on if effect not in used)
    said = [
        f'results: "{result}" is called "{former[result]}" now; fegear migrate writes it anew.'
        for result in scene.case.results if result in former
    ]  # fmt: skip
    # What the description calls for, and no wanted result uses, was not asked for.
    named = idle if scene.case.effects.start == "none" else scene.case.effects.named
    said += [_idle(effect, known.entries) for effect in idle if effect in named]
    return Plan(steps, skipped, idle, (*scene.renamed, *said))


def _idle(effect: str, stages: Sequence[Entry]) -> str:
    results = dict.fromkeys(f'"{result}"' for one in stages if effect in one.effects for result in one.results)
    who = f"ask for {' or '.join(results)}, or leave the effect out"
    return f"effects.{effect} is on, but no requested result uses it; {who}."


def _require_effects(scene: Scene, stage: Stage, results: Sequence[str]) -> None:
    for need in stage.requires:
        wanted = [result for result in results if result in (need.results or stage.results)]
        if (need.results and not wanted) or scene.case.effects.is_on(need.effect):
            continue
        who = f'"{wanted[0]}"' if wanted else f"stage {stage.name}"
        raise InputError(
            f"effects.{need.effect}",
            "(off)",
            f"is needed by {who}: {need.reason}",
            f"write {need.effect} = {scene.case.effects.example(need.effect)} under [effects], or do not ask for {who}",
        )


def _refuse_twice(stage: Stage, results: Sequence[str]) -> None:
    """Refuse results that another wanted one holds."""
    for other in stage.holds:
        if other in results:
            raise InputError(
                "results", f'"{other}"', f"and {stage.name} would write the same tables",
                f"ask for {stage.name} alone: it holds what {other} has",
            )  # fmt: skip


#: Stages that draw and measure gears, which need not run.
_DRAWN = ("geometry", "tooth-geometry-check", "measured-flanks")


def _refuse_fouling(scene: Scene, stage: Stage, subject: str) -> None:
    """Refuse internal pairs whose tips meet material where a stage lets them run."""
    if stage.name in _DRAWN or subject in scene.gears:
        return
    for name, pair in scene.pairs.items():
        if name == subject or subject not in scene.pairs:
            try:
                pair.refuse_fouling()
            except GeometryError as error:
                raise InputError(f"pair.{name}", error.value, error.rule, error.remedy) from None


def _refuse_internal(scene: Scene, stage: Stage, subject: str, result: str) -> None:
    """Refuse internal gears and pairs where a stage is made for external ones, by the name of what was asked for."""
    if stage.internal:
        return
    one = subject in scene.pairs or subject in scene.gears
    pairs = [name for name, pair in scene.pairs.items() if pair.internal and (name == subject or not one)]
    alone = subject == "" or (one and subject not in scene.pairs)
    gears = [name for name, gear in scene.gears.items() if gear.tooth.internal and alone and subject in (name, "")]
    for key in (*(f"pair.{name}" for name in pairs), *(f"gear.{name}" for name in gears)):
        named = result or (stage.results[0] if stage.results else stage.name)
        wide = " where gears are helical or have a width" if subject in scene.wide_pairs else ""
        why = f" ({stage.why_external})" if stage.why_external else ""
        raise InputError(
            key, "internal", f'is not taken by "{named}", which is computed for external gears alone{wide}{why}',
            "do not ask for it, or describe the external gears in a case of their own",
        )  # fmt: skip


def _why_not(stage: Entry, wanted: Sequence[str]) -> str:
    if not stage.results:
        return "needed by no requested result"
    if any(result in wanted for result in stage.results):
        return "no gear or pair of this case is computed this way"
    return f'not requested (results does not list "{stage.results[0]}")'


def forecast_seconds(scene: Scene, plan: Plan) -> list[float | None]:
    """Predicted seconds of each step [s], a gear shape counted where it is solved first; None where it is unknown."""
    solved: set[object] = set()
    found: list[float | None] = []
    for step in plan.steps:
        ahead = step.stage.forecast(scene, step.task.subject)
        anew = sum(seconds for key, seconds in ahead.shapes.items() if key not in solved)
        solved |= set(ahead.shapes)
        found.append(None if ahead.seconds is None else ahead.seconds + anew)
    return found


def plan_lines(scene: Scene, plan: Plan) -> list[str]:
    """Lines for the terminal."""
    lines, seconds = ["Will compute:"], forecast_seconds(scene, plan)
    for number, (step, predicted) in enumerate(zip(plan.steps, seconds, strict=True), start=1):
        effects = f"; effects: {', '.join(step.effects)}" if step.effects else ""
        lines.append(f"  {number}. {step.task}: {'; '.join(step.reasons)}{effects}")
        ahead = step.stage.forecast(scene, step.task.subject)
        if ahead.settings:
            lines.append("     settings: " + ", ".join(f"{key} = {_short(v)}" for key, v in ahead.settings.items()))
        lines.append("     run time unknown" if predicted is None else f"     about {predicted:.2g} s")
    if plan.skipped:
        lines.append("Will not compute:")
        lines += _folded(plan.skipped)
    unknown = [str(step.task) for step, predicted in zip(plan.steps, seconds, strict=True) if predicted is None]
    without = f", without {', '.join(unknown)}, whose run time is unknown" if unknown else ""
    total = sum(predicted or 0.0 for predicted in seconds)
    lines.append(
        f"Predicted: about {total:.2g} s of one core, measured on a usual machine{without}; tables, pictures and "
        "report come on top, some seconds."
    )
    return lines + [f"Note: {remark}" for remark in plan.remarks]


def _folded(skipped: Sequence[tuple[str, str]]) -> list[str]:
    """Stages that are not computed, those of one reason together: fifty lines would push the plan out of sight."""
    groups: dict[str, list[str]] = {}
    for name, reason in skipped:
        groups.setdefault(reason.partition(" (")[0], []).append(name)
    found = []
    for reason, names in groups.items():
        found += textwrap.wrap(
            f"{reason}: {', '.join(names)}",
            118,
            initial_indent="  - ",
            subsequent_indent="    ",
            break_on_hyphens=False,
        )
    return found


def plan_content(scene: Scene, plan: Plan) -> dict[str, object]:
    """The same as plain mappings and lists, for programs; ``seconds`` is None where the run time is unknown."""
    return {
        "case": scene.name,
        "steps": [
            {
                "task": str(step.task),
                "reasons": list(step.reasons),
                "effects": list(step.effects),
                "settings": dict(step.stage.forecast(scene, step.task.subject).settings),
                "seconds": predicted,
            }
            for step, predicted in zip(plan.steps, forecast_seconds(scene, plan), strict=True)
        ],
        "skipped": [{"stage": name, "reason": reason} for name, reason in plan.skipped],
        "remarks": list(plan.remarks),
    }


def _short(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
