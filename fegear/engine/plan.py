"""The plan: which tasks the wanted results need, in order, why each runs and why the others do not."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from fegear.base.brief import Brief
from fegear.base.errors import GeometryError, InputError
from fegear.base.notes import neglecting
from fegear.case.measurements import unused_measurements
from fegear.case.nearest import nearest
from fegear.case.reading import Scene
from fegear.engine.catalogue import Catalogue, Entry
from fegear.engine.joined_names import refuse_joined
from fegear.engine.stage import Stage, Task

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair

#: Why a task runs that no result of the case asks for.
ON_REQUEST = "shown on request"
#: How many of the results that include an effect a note names.
_NAMED = 4


@dataclass(frozen=True, slots=True)
class Step:
    """One task of the plan, the reasons for it, effects that change it, and the stages that read it.

    `wanted`: whether a result of the case asks for it, and not only another task.
    """

    task: Task
    stage: Stage
    reasons: tuple[str, ...]
    effects: tuple[str, ...]
    readers: tuple[Stage, ...] = ()
    wanted: bool = False
    _read: list[tuple[Scene, Any]] = field(default_factory=list, init=False, repr=False, compare=False)

    def inputs(self, scene: Scene) -> Any:
        """All that its result reads of the case; of the scene that was asked about last it is known."""
        if not self._read or self._read[0][0] is not scene:
            inputs, for_readers = self.stage.inputs(scene, self.task.subject), self.stage.for_readers
            self._read[:] = [(scene, inputs if for_readers is None else for_readers(inputs, self.readers))]
        return self._read[0][1]


@dataclass(frozen=True, slots=True)
class Plan(Brief):
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
    """What a case of helical gears or of 3D pairs only should know of results that are about plane spur gears."""
    if scene.pairs and all(pair.asymmetric for pair in scene.pairs.values()):
        return " (possibly available for teeth with equal flanks only; those of this case are asymmetric)"
    if scene.gears and not scene.spur_gears:
        return " (possibly available for spur gears only; the gears of this case are helical)"
    wide = [name for name in scene.spur_pairs if name in scene.wide_pairs]
    if wide and not scene.plane_pairs:
        return f' (possibly available for the plane (2D) model only: set pair.{wide[0]}.width = "plane")'
    return ""


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
    if any(result not in by_result and result not in former for result in scene.case.results):
        known = known.with_added
        by_result = known.by_result()
    wanted = list(dict.fromkeys(former.get(result, result) for result in scene.case.results))

    reasons: dict[Task, list[str]] = {}
    order: list[Task] = []
    asked_for: set[Task] = set()
    under: dict[Task, dict[Task, None]] = {}

    def require(task: Task, reason: str, result: str = "") -> None:
        if task in reasons:
            _refuse_circle(task, reason, result, finished=under)
            if reason not in reasons[task]:
                reasons[task].append(reason)
            return
        stage = known.called(task.stage)
        _require_effects(scene, stage, wanted)
        _refuse_twice(stage, wanted)
        _refuse_internal(scene, stage, task.subject, result)
        _refuse_asymmetric(scene, stage, task.subject, result)
        _refuse_shaped(scene, stage, task.subject, result)
        _refuse_fouling(scene, stage, task.subject)
        stage.check(scene, task.subject)
        reasons[task], needs = [reason], stage.needs(scene, task.subject)
        for need in needs:
            require(need, f"required by {task}", result)
        order.append(task)
        under[task] = dict.fromkeys((*(below for need in needs for below in under[need]), *needs))

    for result in wanted:
        _refuse_unknown(known, result, by_result)
        asked = [known.called(name) for name in by_result[result]]
        described = [(stage, subject) for stage in asked for subject in stage.subjects(scene)]
        if not described:
            raise InputError(
                "results",
                f'"{result}"',
                "cannot be computed: the case does not define the required objects",
                _missing([known.table_of(stage.name) for stage in asked]) + _straight(scene),
            )
        for stage, subject in described:
            task = Task(stage.name, subject)
            require(task, f'requested by results = ["{result}"]', result)
            asked_for.add(task)

    for task in more:
        require(task, ON_REQUEST)

    refuse_joined(task.subject for task in order)
    _refuse_same_tables(known, order)
    on = scene.case.effects.on()
    stages_of = {task: known.called(task.stage) for task in order}
    steps = tuple(
        Step(
            task, stage, tuple(reasons[task]), tuple(e for e in on if e in stage.effects_on(scene, task.subject)),
            tuple(reader for other, reader in stages_of.items() if task in under[other]), task in asked_for,
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
        f'results: "{result}" was renamed "{former[result]}"; update the case with fegear migrate.'
        for result in scene.case.results if result in former
    ]  # fmt: skip
    # What the description calls for, and no wanted result uses, was not asked for.
    named = idle if scene.case.effects.start == "none" else scene.case.effects.named
    said += [neglecting(_idle(effect, known.entries)) for effect in idle if effect in named]
    said += unused_measurements(scene.case, {result for step in steps for result in step.stage.results})
    return Plan(steps, skipped, idle, (*scene.renamed, *scene.derived, *said))


def _refuse_unknown(known: Catalogue, result: str, by_result: Collection[str]) -> None:
    if result in known.broken:
        raise known.broken[result]
    if result not in by_result:
        from fegear.case.trade_words import of_result  # late: words of the trade, which only a refusal needs

        rule, remedy = "unknown result", nearest(result, by_result, '"fegear results"', lambda word, _: of_result(word))
        raise InputError("results", f'"{result}"', rule, remedy)


def _missing(tables: Sequence[str]) -> str:
    """What to add to a case in which none of these tables is, by which stages of one result are described."""
    named = [table if table.startswith("[") else f"[{table}]" for table in dict.fromkeys(tables) if table]
    return f"add {' or '.join(named)}" if named else "add the required gear or pair"


def _refuse_circle(task: Task, reason: str, result: str, finished: Collection[Task]) -> None:
    """Refuse a task that is needed before all that it needs is known: a slip of another distribution."""
    if task not in finished:
        rule = f"waits for itself: it is {reason}"
        raise InputError("results", f'"{result or task.stage}"', rule, "correct the needs of its stages")


def _idle(effect: str, stages: Sequence[Entry]) -> str:
    results = [*dict.fromkeys(f'"{result}"' for one in stages if effect in one.effects for result in one.results)]
    more = f" ({len(results)} results include it)" if len(results) > _NAMED else ""
    who = f"request {' or '.join(results[:_NAMED])}{more}, or switch the effect off"
    return f"effects.{effect} has no influence on the requested results; {who}."


def _require_effects(scene: Scene, stage: Stage, results: Sequence[str]) -> None:
    for need in stage.requires:
        wanted = [result for result in results if result in (need.results or stage.results)]
        if (need.results and not wanted) or scene.case.effects.is_on(need.effect):
            continue
        who = f'"{wanted[0]}"' if wanted else f"stage {stage.name}"
        raise InputError(
            f"effects.{need.effect}",
            "(off)",
            f"is required by {who}: {need.reason}",
            f"set {need.effect} = {scene.case.effects.example(need.effect)} under [effects], or remove {who} from "
            "results",
        )


def _refuse_twice(stage: Stage, results: Sequence[str]) -> None:
    """Refuse results that another wanted one holds."""
    for other in stage.holds:
        if other in results:
            raise InputError(
                "results", f'"{other}"', f"and {stage.name} would write the same tables",
                f"request {stage.name} only; it includes {other}",
            )  # fmt: skip


def _refuse_same_tables(known: Catalogue, tasks: Collection[Task]) -> None:
    """Refuse two stages that would write the same tables of one subject."""
    for task in tasks:
        for other in known.called(task.stage).instead_of:
            if Task(other, task.subject) in tasks:
                raise InputError(
                    "results", f'"{other}"', f"and {task} would write the same tables",
                    "request one of them, or compute them in two runs",
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
                if pair.driver.shaped or pair.driven.shaped:
                    from fegear.geometry.tip_interference import refuse_shaped

                    refuse_shaped(pair)
            except GeometryError as error:
                member, _, own = error.key.partition(".")
                key = f"gear.{getattr(scene.case.pair[name], member)}.{own}" if own else f"pair.{name}"
                raise InputError(key, error.value, error.rule, error.remedy) from None


def _refuse_internal(scene: Scene, stage: Stage, subject: str, result: str) -> None:
    """Refuse internal gears and pairs where a stage is made for external ones, by the name of what was asked for."""
    if stage.internal:
        return
    for key in _subjects(scene, subject, lambda pair: pair.internal, lambda gear: gear.tooth.internal):
        named = result or (stage.results[0] if stage.results else stage.name)
        wide = " for helical or 3D gears" if subject in scene.wide_pairs else ""
        why = f": {stage.why_external}" if stage.why_external else ""
        raise InputError(
            key, "internal", f'is not supported by "{named}" (external gears only{wide}{why})',
            "remove it from results, or use a separate case for the external gears",
        )  # fmt: skip


def _refuse_asymmetric(scene: Scene, stage: Stage, subject: str, result: str) -> None:
    """Refuse teeth with two different flanks where a stage is made for equal ones, by what was asked for."""
    if stage.asymmetric:
        return
    for key in _subjects(scene, subject, lambda pair: pair.asymmetric, lambda gear: gear.asymmetric):
        named = result or (stage.results[0] if stage.results else stage.name)
        raise InputError(
            key, "asymmetric teeth", f'is not supported by "{named}" (teeth with equal flanks only)',
            "remove it from results, or use a separate case for the other gears",
        )  # fmt: skip


def _refuse_shaped(scene: Scene, stage: Stage, subject: str, result: str) -> None:
    """Refuse fillets of their own where a stage needs those of a tool, by what was asked for."""
    if not stage.generated:
        return
    pair = scene.case.pair.get(subject)
    asked = (pair.driver, pair.driven) if pair is not None else (subject,) if subject in scene.gears else scene.gears
    for name in asked:
        if scene.gears[name].shaped:
            named = result or (stage.results[0] if stage.results else stage.name)
            raise InputError(
                f"gear.{name}.fillet", "given", f'is not supported by "{named}" (fillets generated by a tool only)',
                "remove it from results, or use a separate case for the other gears",
            )  # fmt: skip


def _subjects(
    scene: Scene, subject: str, of_pair: Callable[[GearPair], bool], of_gear: Callable[[Gear], bool]
) -> Iterator[str]:
    """Keys of the pairs and gears of one kind among those that a task is about."""
    one = subject in scene.pairs or subject in scene.gears
    for name, pair in scene.pairs.items():
        if of_pair(pair) and (name == subject or not one):
            yield f"pair.{name}"
    alone = subject == "" or (one and subject not in scene.pairs)
    for name, gear in scene.gears.items():
        if of_gear(gear) and alone and subject in (name, ""):
            yield f"gear.{name}"


def _why_not(stage: Entry, wanted: Sequence[str]) -> str:
    if not stage.results:
        return "not required by the requested results"
    if any(result in wanted for result in stage.results):
        return "not applicable to the gears and pairs of this case"
    return f'not requested ("{stage.results[0]}" is not in results)'
