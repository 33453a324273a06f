"""Which values and tables of a run the terminal prints: as many as a person reads; and the answer itself."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.engine.run_answer import in_order
from fegear.output.tables import row_lines

if TYPE_CHECKING:
    from fegear.engine.run import Results
    from fegear.engine.run_answer import RunAnswer
    from fegear.engine.stage import Task
    from fegear.engine.table import Table
    from fegear.engine.value import Value

#: More values than a screen has lines are read in no order; the other ones are in files and in the report.
_MOST = 40
#: Two searches for the same optimum agree within this.
_SAME = 1e-6


def spoken_values(results: Results) -> tuple[list[Value], int]:
    """Values for the terminal, in the order of the run, and how many others there are.

    Those of results that the answer of another one sums up are left to the files: a gearbox has a hundred, and its
    answer names those to act on; beside an answer with tables those of results that describe what is given, too. All
    others where they fit on a screen. Else those of the requested results only, of
    each its first ones, as many for one as for another.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Value, int
    """
    wanted = {step.task for step in results.plan.steps if step.wanted}
    summed = _summed_up(results)
    every = [value for task, of in results.outcomes.items() if task not in summed for value in of.values]
    names, count = {value.name for value in every}, len(results.values)
    every = _once([value for value in results.values if value.name in names])
    if len(every) <= _MOST:
        return every, count - len(every)
    tasks = [
        task for task in in_order(results.outcomes, results.plan, results.outcomes, results.scene.case.results)
        if task in wanted and task not in summed and results.outcomes[task].values
    ]  # fmt: skip
    kept: set[str] = set()
    for number, task in enumerate(tasks):
        share = (_MOST - len(kept)) // (len(tasks) - number)  # what one leaves is for those behind it
        kept |= {value.name for value in results.outcomes[task].values[:share]}
    found = [value for value in every if value.name in kept]
    return found, count - len(found)


def _once(values: list[Value]) -> list[Value]:
    """Values without choices that an earlier result has found, too: the same number under another name."""
    kept: list[Value] = []
    for value in values:
        again = value.choice and any(
            one.choice and one.unit == value.unit and math.isclose(one.value, value.value, rel_tol=_SAME)
            for one in kept
        )
        kept += [] if again else [value]
    return kept


def answer_lines(answer: RunAnswer) -> list[str]:
    """Lines of an answer: its first sentence, tables of several subjects, the other sentences."""
    first = 1 if answer.overviews else len(answer.sentences)
    rows = [line for table in answer.overviews for line in row_lines(table.filled)]
    before, after = (
        [line for one in part for line in one.splitlines()]
        for part in (answer.sentences[:first], answer.sentences[first:])
    )
    return [*before, *rows, *after]


def spoken_tables(results: Results) -> tuple[list[Table], list[Table]]:
    """Tables for the terminal: those before the values, and those of the answer, behind it.

    Beside an answer with tables, those of results that it sums up or that describe what is given are left to the files.
    What consists of words is in the sentences of the answer.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Table, list of Table
    """
    order = {name: n for n, name in enumerate(results.answer.tables)}
    left = _summed_up(results) if order else set()
    printed = [
        table for task, outcome in results.outcomes.items() if task not in left
        for table in outcome.tables if table.printed
    ]  # fmt: skip
    named = [
        table for table in results.tables
        if table.name in order and any(column.values.dtype.kind == "f" for column in table.columns)
    ]  # fmt: skip
    return printed, sorted(named, key=lambda table: order[table.name])


def _summed_up(results: Results) -> set[Task]:
    """Tasks of results that the answer of a wanted one covers, or puts behind its tables."""
    steps = [step for step in results.plan.steps if step.wanted and step.task in results.outcomes]
    answers = [results.outcomes[step.task].answer for step in steps]
    covered = {result for answer in answers if answer is not None for result in answer.covers}
    tables = results.answer.tables
    behind = {
        step.task for step, answer in zip(steps, answers, strict=True)
        if tables and answer is not None and answer.background
    }  # fmt: skip
    return behind | {
        step.task for step in results.plan.steps if step.stage.results and set(step.stage.results) <= covered
    }  # fmt: skip
