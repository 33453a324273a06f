"""What the wanted results of a run come to: a few sentences with rounded numbers, and one figure.

The page of a run begins with it, the terminal ends with it, the window and Python show the same sentences. Every wanted
result has at least one, unless another wanted one sums it up; a result without an answer of its own says its first
single values. What describes the gears comes behind what follows from them, what
odd teeth change before what holds with identical ones. Of results that several pairs or gears
have, the one to act on comes first and says among how many it is.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.base.printed import in_words, rounded, unit_said
from fegear.base.spoken_names import spoken
from fegear.engine.answered import MOST, Answered, Deciding
from fegear.engine.declared import stacked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from fegear.engine.outcome import Outcome
    from fegear.engine.plan import Plan, Step
    from fegear.engine.stage import Task
    from fegear.engine.table import Table
    from fegear.engine.value import Value

#: Values that a result without an answer of its own says.
_FIRST = 2
#: Subjects from which on a table has them all.
_OVERVIEW = 3


class RunAnswer(NamedTuple):
    """What a run comes to: sentences in the order of the wanted results, the first's figure, and short tables.

    Attributes
    ----------
    sentences : tuple of str
    figure : str
    tables : tuple of str
        Keys.
    overviews : tuple of Table
        A row for each of at least three subjects of one result, the one to act on first; behind the first sentence.
    """

    sentences: tuple[str, ...]
    figure: str
    tables: tuple[str, ...] = ()
    overviews: tuple[Table, ...] = ()


def answer_of_run(plan: Plan, outcomes: Mapping[Task, Outcome], wanted: Sequence[str]) -> RunAnswer:
    """Put the answers of the wanted results together.

    Parameters
    ----------
    plan : Plan
    outcomes : mapping of Task to Outcome
    wanted : sequence of str
        Results that the case asks for, in its order.
    """
    steps = [step for step in plan.steps if step.wanted and step.task in outcomes]
    # a result that is asked for by the name it had before stands behind the others
    former = [step.stage.results[0] for step in steps if not set(step.stage.results) & set(wanted)]
    by_result = {result: _of_result(result, steps, outcomes) for result in dict.fromkeys((*wanted, *former))}
    covered = {result for one in by_result.values() for result in one.covers}
    found = [one for result, one in by_result.items() if result not in covered]
    found.sort(key=lambda one: (one.background, not one.leads))
    front = _within([_across(steps, outcomes), *_once([one.sentences for one in found if not one.background])])
    room = 1 if front else MOST  # what describes the gears says no more than that beside an answer
    described = tuple(sentence for one in found if one.background for sentence in one.sentences[:room])
    return RunAnswer(
        tuple(dict.fromkeys((*front, *described))), next((one.figure for one in found if one.figure), ""),
        tuple(dict.fromkeys(table for one in found for table in one.tables)),
        tuple(table for one in found for table in one.overviews if len(table.columns[0]) >= _OVERVIEW),
    )  # fmt: skip


def _across(steps: Sequence[Step], outcomes: Mapping[Task, Outcome]) -> list[str]:
    """Sentences from the facts of all results that have one in common."""
    facts: dict[Callable[[Sequence[Any]], str], list[Any]] = {}
    for step in steps:
        answer = outcomes[step.task].answer
        if answer is not None and answer.across is not None:
            facts.setdefault(answer.across, []).append(answer.fact)
    return [said for across, all_facts in facts.items() if (said := across(all_facts))]


def in_order(tasks: Iterable[Task], plan: Plan, outcomes: Mapping[Task, Outcome], wanted: Sequence[str]) -> list[Task]:
    """Tasks as a reader wants them: those of the wanted results in their order, what describes the gears behind.

    Parameters
    ----------
    tasks : iterable of Task
    plan : Plan
    outcomes : mapping of Task to Outcome
    wanted : sequence of str
        Results that the case asks for, in its order.
    """
    steps = {step.task: step for step in plan.steps if step.wanted}

    def place(task: Task) -> tuple[bool, bool, bool, int]:
        if (step := steps.get(task)) is None:
            return True, False, False, 0
        answer = outcomes[task].answer
        first = min((wanted.index(one) for one in step.stage.results if one in wanted), default=len(wanted))
        background, leads = (False, False) if answer is None else (answer.background, answer.leads)
        return False, background, not leads, first

    return sorted(tasks, key=place)


def _once(groups: Sequence[Sequence[str]]) -> list[tuple[str, ...]]:
    """The same without sentences that another one repeats of the same subject, with more about where it holds.

    "Pair I: transmission error 0.3 µm." beside "Pair I at 190 N m: transmission error 0.3 µm."
    """
    parts = [sentence.partition(": ") for group in groups for sentence in group]

    def repeated(sentence: str) -> bool:
        head, _, said = sentence.partition(": ")
        return any(other == said and more != head and more.startswith(f"{head} ") for more, _, other in parts if said)

    return [tuple(sentence for sentence in group if not repeated(sentence)) for group in groups]


def _within(groups: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """One sentence of each group and further ones as long as there is room, in the order of the groups.

    Of the further ones those that a reader decides by come first; one of these has room in any case.
    """
    kept = [set(range(min(1, len(group)))) for group in groups]
    further = [(row, k) for k, group in enumerate(groups) for row in range(1, len(group))]
    further.sort(key=lambda one: (not isinstance(groups[one[1]][one[0]], Deciding), *one))
    first = sum(map(len, kept))
    room = max(MOST - first, int(bool(further) and isinstance(groups[further[0][1]][further[0][0]], Deciding)))
    for row, k in further[:room]:
        kept[k].add(row)
    found = (group[row] for group, rows in zip(groups, kept, strict=True) for row in sorted(rows))
    return tuple(dict.fromkeys(found))


def _of_result(result: str, steps: Sequence[Step], outcomes: Mapping[Task, Outcome]) -> Answered:
    """Answer of one wanted result, which may be that of several stages, each for several pairs or gears."""
    by_stage: dict[str, list[Outcome]] = {}
    for step in steps:
        if result in step.stage.results:
            by_stage.setdefault(step.task.stage, []).append(outcomes[step.task])
    found = [joined([one.answer for one in of if one.answer is not None]) for of in by_stage.values()]
    found = [one for one in found if one.sentences or one.figure]
    if not found:
        every = [outcome for of in by_stage.values() for outcome in of]
        figure = next((one.figures[0].key for one in every if one.figures), "")
        return Answered(plain_sentences(value for one in every for value in one.values), figure)
    return Answered(
        _within([one.sentences for one in found])[:MOST], next((one.figure for one in found if one.figure), ""),
        covers=tuple(result for one in found for result in one.covers), background=all(o.background for o in found),
        tables=tuple(table for one in found for table in one.tables), leads=any(one.leads for one in found),
        overviews=tuple(table for one in found for table in one.overviews),
    )  # fmt: skip


def joined(answers: Sequence[Answered]) -> Answered:
    """Answers of one stage for several subjects as one: the first to act on before the others."""
    if len(answers) < 2:
        return answers[0] if answers else Answered(())
    ordered = sorted(answers, key=lambda one: math.inf if one.rank is None else one.rank)
    first = ordered[0]
    rows = [list(one.sentences) for one in ordered]
    if first.among and rows[0] and first.rank is not None:
        clause = first.among.format(count=in_words(len(answers)))
        rows[0][0] = f"{rows[0][0].removesuffix('.')}, {clause}."
    common = "" if first.common is None else first.common([one.fact for one in answers])
    return Answered(
        (*filter(None, [common]), *_within(rows))[:MOST], first.figure, covers=first.covers,
        background=first.background,
        tables=tuple(table for one in ordered for table in one.tables), leads=any(one.leads for one in ordered),
        overviews=_below_each_other([table for one in answers for table in one.overviews]),
    )  # fmt: skip


def _below_each_other(tables: Sequence[Table]) -> tuple[Table, ...]:
    """Tables of one kind as one."""
    if len(tables) < 2:
        return tuple(tables)
    return (replace(tables[0], columns=stacked([one.columns for one in tables])),)


def plain_sentences(values: Iterable[Value]) -> tuple[str, ...]:
    """The first values as sentences, estimated ones before exact ones."""
    known = [value for value in values if math.isfinite(value.value)]
    known.sort(key=lambda value: not value.error)
    return tuple(map(_plain_sentence, known[:_FIRST]))


def _plain_sentence(value: Value) -> str:
    """What a value is, in words of its identifier; a symbol with its meaning."""
    number = f"{rounded(value.value, value.error)} {unit_said(value.unit)}".rstrip()
    subject, dot, name = value.name.rpartition(".")
    if said := spoken(value.name):
        start = f"{value.name.partition('.')[0]}: " if dot else ""
        return f"{start}{said} {number}."
    meaning = value.meaning.partition(";")[0]
    start = f"{': '.join(subject.split('.'))}: " if dot else ""
    return f"{start}{name} {number}" + (f" ({meaning})." if meaning else ".")
