"""What ``fegear effects`` writes: ``tables/effects.csv``, a picture of each effect, report, summary."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import fegear
from fegear.case.reading import Scene
from fegear.engine.table import Column, Table
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report.effects import effects_page, stated_errors
from fegear.output.report.page import write_page
from fegear.output.tables import write_json, write_table
from fegear.studies.effects import Fixed, Switched, clearest_curve, effect_figure

Curve = tuple[Table, Table, str, str]


#: Name, unit and meaning of the columns.
_HEADS = (
    ("effect", "", "which effect"),
    ("in_the_case", "", "whether the case has it on"),
    ("result", "", "name of the value"),
    ("unit", "", "of the value"),
    ("without", "", "value without the effect"),
    ("with", "", "value with the effect"),
    ("change", "", "with less without"),
    ("share", "", "change over the larger of the two"),
    ("error_without", "", "estimated error of the value without the effect"),
    ("error_with", "", "estimated error of the value with the effect"),
    ("resolved", "", "whether the change exceeds the sum of both errors, or 1e-9 of a value without one"),
    ("processor_without", "s", "processor seconds without the effect"),
    ("processor_with", "s", "processor seconds with the effect"),
    ("kernels", "", "calls of the kernels without -> with"),
)


def effects_table(switched: Sequence[Switched]) -> Table:
    """One row for each effect and value: without and with the effect, seconds, and the kernels that it calls more."""
    rows = []
    for found in switched:
        kernels = kernel_changes(found)
        for pair in found.changes():
            a, b = pair.both
            errors = [math.nan if value.error is None else value.error for value in (a, b)]
            rows.append(
                (found.effect, "on" if found.named else "off", a.name, a.unit, a.value, b.value, pair.change,
                 pair.share, *errors, "yes" if pair.resolved else "no", found.without.seconds, found.with_it.seconds,
                 kernels)
            )  # fmt: skip
    columns = list(zip(*rows, strict=True)) if rows else [()] * len(_HEADS)
    made = [Column(h, np.array(c), unit, meaning) for (h, unit, meaning), c in zip(_HEADS, columns, strict=True)]
    return Table("effects", tuple(made), "What each effect changes and what it costs")


def kernel_changes(found: Switched) -> str:
    """Kernels whose number of calls the effect changes."""
    before, after = found.without.kernels, found.with_it.kernels
    names = [name for name in {**before, **after} if before.get(name, 0) != after.get(name, 0)]
    return "; ".join(f"{name} {before.get(name, 0)} -> {after.get(name, 0)}" for name in names)


def write_effects(scene: Scene, switched: Sequence[Switched], fixed: Sequence[Fixed], folder: Path) -> list[str]:
    """Write table, pictures, report and summary.

    Parameters
    ----------
    scene : Scene
    switched : sequence of Switched
    fixed : sequence of Fixed
    folder : Path
        An empty folder.

    Returns
    -------
    list of str
        One sentence for each effect.
    """
    from fegear.output.draw_png import draw_pictures

    (folder / "tables").mkdir()
    (folder / "plots").mkdir()
    table = effects_table(switched)
    write_table(folder / "tables", table)
    curves = {found.effect: clearest_curve(found) for found in switched}
    title = scene.case.title or scene.name
    figures = {found.effect: effect_figure(found, curves[found.effect], title) for found in switched}
    for figure in figures.values():
        for _ in draw_pictures(replace(figure, case=scene.name), folder / "plots"):
            pass
    sentences = {found.effect: sentence(found) for found in switched}
    write_page(folder / "report.html", effects_page(scene, switched, fixed, table, curves, figures, sentences))
    lines = list(sentences.values())
    lines += [f"{one.effect} cannot be switched in this case: {one.reason}" for one in fixed]
    write_json(
        folder / SUMMARY,
        {
            "title": scene.case.title,
            "case": scene.name,
            "effects": {
                found.effect: {
                    "in_the_case": found.named,
                    "processor_seconds": {
                        "without": round(found.without.seconds, 6), "with": round(found.with_it.seconds, 6)
                    },
                    "kernels": {"without": dict(found.without.kernels), "with": dict(found.with_it.kernels)},
                }
                for found in switched
            },
            "remarks": lines,
            "files": [*files_in(folder), SUMMARY],
            "version": fegear.__version__,
        },
    )  # fmt: skip
    return lines


def sentence(found: Switched) -> str:
    """The value that an effect changes most, of those by more than their errors, and what that costs."""
    cost = f"processor time {found.without.seconds:.2f} s without, {found.with_it.seconds:.2f} s with"
    most = found.largest_change()
    if most is not None:
        a, b = most.both
        return f"{found.effect} changes {a.name} most: {a.value:.5g} -> {b.value:.5g} {a.unit}; {cost}.".replace(
            " ;", ";"
        )
    unresolved = [pair for pair in found.changes() if pair.change != 0.0]
    if not unresolved:
        return f"{found.effect} changes no value; {cost}."
    most = max(unresolved, key=lambda pair: abs(pair.share))
    change = f"{most.change:+.3g} {most.both[0].unit}".rstrip()
    not_resolved = f"{most.name}: {change}, not resolved ({stated_errors(most)})"
    return f"{found.effect} changes no value by more than its error; {not_resolved}; {cost}."
