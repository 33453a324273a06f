"""Which single values of a run the terminal prints: as many as a person reads before the answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.engine.run_answer import in_order

if TYPE_CHECKING:
    from fegear.engine.run import Results
    from fegear.engine.value import Value

#: More values than a screen has lines are read in no order; the other ones are in files and in the report.
_MOST = 40


def spoken_values(results: Results) -> tuple[list[Value], int]:
    """Values for the terminal, in the order of the run, and how many others there are.

    All of them where they fit on a screen. Else those of the requested results only, of each its first ones, as
    many for one as for another.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Value, int
    """
    every = list(results.values)
    if len(every) <= _MOST:
        return every, 0
    wanted = {step.task for step in results.plan.steps if step.wanted}
    tasks = [
        task for task in in_order(results.outcomes, results.plan, results.outcomes, results.scene.case.results)
        if task in wanted and results.outcomes[task].values
    ]  # fmt: skip
    kept: set[str] = set()
    for number, task in enumerate(tasks):
        share = (_MOST - len(kept)) // (len(tasks) - number)  # what one leaves is for those behind it
        kept |= {value.name for value in results.outcomes[task].values[:share]}
    found = [value for value in every if value.name in kept]
    return found, len(every) - len(found)
