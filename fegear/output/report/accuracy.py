"""Accuracy and its cost: seconds, errors compared with the tolerance, settings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import NoteClass, class_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.output.numbers import plain_number
from fegear.output.report.blocks import (
    Bars,
    Block,
    Facts,
    Folded,
    Paragraph,
    Plot,
    relative_error,
)

if TYPE_CHECKING:
    from fegear.engine.run import Results


def _errors(results: Results) -> list[tuple[str, float]]:
    found = [(value.name, relative_error(value)) for value in results.values]
    return [(name, share) for name, share in found if share is not None]


def _figure(found: list[tuple[str, float]], tolerance: float) -> Figure:
    found = sorted(found, key=lambda item: item[1])
    names, share = tuple(name for name, _ in found), np.array([share for _, share in found])
    rows = np.arange(len(found))
    points = tuple(
        Points(share[here], rows[here], label, role, symbol, 9.0)
        for here, label, role, symbol in (
            (share <= tolerance, "within tolerance", "green", "circle"),
            (share > tolerance, "above tolerance", "red", "diamond"),
        )
        if here.any()
    )
    axes = Axis("estimated relative error", log=True), Axis(categories=names)
    return Figure(
        "estimated_errors", "Estimated errors and tolerance",
        "Estimated error of every value over the value; left of the line: within tolerance.",
        (Panel(*axes, points, (Mark("x", tolerance, "tolerance"),)),),
    )  # fmt: skip


def accuracy_blocks(results: Results) -> tuple[Block, ...]:
    """Blocks on accuracy and its cost, from whatever the stages say of their settings."""
    tolerance = results.scene.case.accuracy.tolerance
    found = _errors(results)
    estimated = [value for value in results.values if value.error is not None]
    over = [value.name for value in results.values if value.error and value.error > tolerance * abs(value.value) > 0.0]
    exact = sum(not value.error for value in estimated)
    kinds = (
        (len(estimated) - exact, "have an estimated error"),
        (exact, "are exact" if exact != 1 else "is exact"),
        (len(results.values) - len(estimated), "have no error estimate"),
    )
    summary = f"Relative tolerance of the case: {plain_number(100.0 * tolerance)} %. Of {len(results.values)} values, "
    summary += ", ".join(f"{count} {words}" for count, words in kinds if count) + "."
    if over:
        summary += f" Above tolerance: {', '.join(over)}."
    elif found and not any(class_of(one) is NoteClass.BEYOND_TOLERANCE for one in results.remarks):
        summary += " No estimated error exceeds the tolerance."
    settings = tuple(
        Folded(f"Settings: {task}", (Facts(outcome.settings),))
        for task, outcome in results.outcomes.items()
        if outcome.settings
    )
    return (
        *((Paragraph(summary),) if results.values else ()),
        *(Paragraph(sentence) for sentence in _libraries(results)),
        *((Plot(_figure(found, tolerance)),) if len(found) > 1 else ()),
        Paragraph("Elapsed time of each task:", "table-title"),
        Bars({str(task): seconds for task, seconds in results.seconds.items()}, "s"),
        *settings,
    )


def _libraries(results: Results) -> tuple[str, ...]:
    """Which library does what on the way to influence functions, where finite elements were solved."""
    if not any(_has_solver(outcome.settings) for outcome in results.outcomes.values()):
        return ()
    solver = results.scene.case.accuracy.solver
    first = "gmsh meshes one tooth; scikit-fem numbers its unknowns, maps and integrates its elements"
    if solver == "scikit-fem":
        rest = "assembles them and eliminates the inner unknowns; fegear couples the sectors to the full gear"
        return (f'{first}, {rest} (accuracy.solver = "scikit-fem").',)
    rest = "fegear's nested dissection assembles and eliminates, and closes the ring of all teeth"
    other = (
        'accuracy.solver = "scikit-fem" uses scikit-fem for this step as well: same results, several times the CPU time'
    )
    return (f"{first}; {rest}. {other} (fegear check measures both).",)


def _has_solver(settings: object) -> bool:
    """Whether settings, or some within them, are those of finite elements."""
    if not isinstance(settings, Mapping):
        return False
    return "solver" in settings or any(_has_solver(within) for within in settings.values())
