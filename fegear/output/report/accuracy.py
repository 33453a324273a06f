"""What accuracy was paid for, and what was got: seconds, errors beside the tolerance, settings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.output.report.blocks import Bars, Facts, Folded, Paragraph, Plot, relative_error
from fegear.output.report.figure import Figure
from fegear.output.report.numbers import plain_number

if TYPE_CHECKING:
    from fegear.engine.run import Results
    from fegear.output.report.page import Block


def _errors(results: Results) -> list[tuple[str, float]]:
    found = [(value.name, relative_error(value)) for value in results.values]
    return [(name, share) for name, share in found if share is not None]


def _figure(found: list[tuple[str, float]], tolerance: float) -> Figure:
    made = Figure(
        "estimated_errors", "Estimated errors beside the tolerance",
        "Estimated error of every value over the value; left of the line it is within the case's tolerance.",
    )  # fmt: skip
    found = sorted(found, key=lambda item: item[1])
    panel = made.panel("estimated relative error", "", log_x=True, height=max(0.5, 0.07 * len(found) + 0.25))
    for inside, name, colour in ((True, "within the tolerance", "@green"), (False, "over the tolerance", "@red")):
        here = [item for item in found if (item[1] <= tolerance) == inside]
        if here:
            panel.add(
                name, [share for _, share in here], [label for label, _ in here], mode="markers",
                marker={"color": colour, "size": 9, "symbol": "circle" if inside else "diamond"},
                hovertemplate="%{y}: %{x:.2~g}<extra></extra>",
            )  # fmt: skip
    panel.mark("x", tolerance, "tolerance")
    made.shared = False
    return made


def accuracy_blocks(results: Results) -> tuple[Block, ...]:
    """Blocks on accuracy and its price, from whatever the stages say of their settings."""
    tolerance = results.scene.case.accuracy.tolerance
    found = _errors(results)
    estimated = [value for value in results.values if value.error is not None]
    over = [name for name, share in found if share > tolerance]
    exact = sum(not value.error for value in estimated)
    kinds = (
        (len(estimated) - exact, "carry an estimated error"),
        (exact, "are exact" if exact != 1 else "is exact"),
        (len(results.values) - len(estimated), "have no estimate"),
    )
    told = f"The case asks for a relative error of {plain_number(tolerance)}. Of its {len(results.values)} values "
    told += ", ".join(f"{count} {words}" for count, words in kinds if count) + "."
    if over:
        told += f" Over the tolerance: {', '.join(over)}."
    elif found:
        told += " None of the estimates exceeds the tolerance."
    settings = tuple(
        Folded(f"Settings: {task}", (Facts(outcome.settings),))
        for task, outcome in results.outcomes.items()
        if outcome.settings
    )
    return (
        *((Paragraph(told),) if results.values else ()),
        *((Plot(_figure(found, tolerance)),) if len(found) > 1 else ()),
        Paragraph("Seconds of each task:", "table-title"),
        Bars({str(task): seconds for task, seconds in results.seconds.items()}, "s"),
        *settings,
    )
