"""What ``fegear effects`` writes: ``tables/effects.csv``, a picture of each effect, report, summary."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import fegear
from fegear.engine.outcome import Column, Table
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report.effects import effects_page
from fegear.output.report.page import write_page
from fegear.output.summary import write_json
from fegear.output.tables import write_table
from fegear.studies.effect_figures import clearest_curve, effect_figure

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.studies.effect_study import Fixed, Switched

    Array = NDArray[np.float64]
    Curve = tuple[Table, Table, str, str]


def effects_table(switched: Sequence[Switched]) -> Table:
    """One row for each effect and value: without and with the effect, seconds, and the kernels that it calls more."""
    rows = []
    for found in switched:
        kernels = kernel_changes(found)
        for a, b in found.values():
            change = b.value - a.value
            scale = max(abs(a.value), abs(b.value))
            rows.append(
                (found.effect, "on" if found.named else "off", a.name, a.unit, a.value, b.value, change,
                 change / scale if scale > 0.0 else 0.0, found.without.seconds, found.with_it.seconds, kernels)
            )  # fmt: skip
    columns = list(zip(*rows, strict=True)) if rows else [()] * 11
    heads = (
        ("effect", "", "which effect"),
        ("in_the_case", "", "whether the case has it on"),
        ("result", "", "name of the value"),
        ("unit", "", "of the value"),
        ("without", "", "value without the effect"),
        ("with", "", "value with the effect"),
        ("change", "", "with less without"),
        ("share", "", "change over the larger of the two"),
        ("processor_without", "s", "processor seconds without the effect"),
        ("processor_with", "s", "processor seconds with the effect"),
        ("kernels", "", "calls of the kernels without -> with"),
    )
    made = [Column(h, np.array(c), unit, meaning) for (h, unit, meaning), c in zip(heads, columns, strict=True)]
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
    """The value that an effect changes most, and what that costs."""
    a, b = found.without.seconds, found.with_it.seconds
    cost = f"processor time {a:.2f} s without, {b:.2f} s with"
    changes = [(abs(q.value - p.value) / max(abs(p.value), abs(q.value)), p, q) for p, q in found.values()
               if max(abs(p.value), abs(q.value)) > 0.0]  # fmt: skip
    if not changes or max(c for c, _, _ in changes) == 0.0:
        return f"{found.effect} changes no value; {cost}."
    _, p, q = max(changes, key=lambda c: c[0])
    return f"{found.effect} changes {p.name} most: {p.value:.5g} -> {q.value:.5g} {p.unit}; {cost}.".replace(" ;", ";")
