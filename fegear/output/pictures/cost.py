"""Error against time on logarithmic axes, and error against each knob."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    Picture,
    figure,
    in_house_style,
    save,
)

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from matplotlib.axes import Axes

    from fegear.studies.cost.quantities import Quantity
    from fegear.studies.cost.result import CostResults, Measured

#: How quantities are called in pictures.
NAMES = {
    "c_0": "$c_0$, self compliance",
    "c_1": "$c_1$, next tooth",
    "root-stress": "root stress",
    "te-peak-to-peak": "peak-to-peak transmission error",
    "tooth-force": "largest tooth force",
    "dynamic-factor": "dynamic factor",
    "te-harmonics": "harmonics of the transmission error",
    "stiffness-harmonics": "harmonics of the mesh stiffness",
}
_ORDERS = {2: (SKY, "o"), 3: (BLUE, "s"), 4: (GREEN, "D")}
#: Formulas answer so quickly that their seconds would stretch the axis; they stand no farther left than this [s].
_QUICKEST = 1e-4
#: Errors that a double cannot tell from none.
_ROUND_OFF = 1e-16


def _points(results: CostResults, rows: Sequence[Measured]) -> tuple[list[float], list[float]]:
    shown = [(max(r.seconds.cpu, _QUICKEST), _shown(results, r)) for r in rows]
    kept = [(t, e) for t, e in shown if math.isfinite(e)]
    return [t for t, _ in kept], [e for _, e in kept]


def _shown(results: CostResults, row: Measured) -> float:
    """Error in the picture: a formula that leaves positions out still shows what it misses at the others."""
    return results.error_where_answered(row)


def _draw(axes: Axes, results: CostResults, quantity: Quantity) -> None:
    rows = results.of(quantity.name)
    floor = results.floors[quantity.name]
    for order, (colour, marker) in _ORDERS.items():
        ring = [r for r in rows if r.rung.family == "ring" and r.rung.settings and r.rung.settings.order == order]
        axes.plot(*_points(results, ring), marker, color=colour, ms=4, mew=0, alpha=0.8, label=f"ring, order {order}")
    sectors = [r for r in rows if r.rung.family == "sector"]
    axes.plot(*_points(results, sectors), "^", color=ORANGE, ms=7, label="sector with free sides")
    formulas = [r for r in rows if r.rung.family.endswith("formula")]
    axes.plot(*_points(results, formulas), "X", color=RED, ms=7, mew=0.3, label="closed form")
    picked = [r for r in rows if r.rung.family == "tolerance"]
    label = "picked for accuracy.tolerance,\nits error estimate paid"
    axes.plot(*_points(results, picked), "*-", color=PURPLE, lw=0.8, ms=10, mew=0.3, label=label)
    front = results.front(quantity.name)
    if front.front.size:
        t, e = np.maximum(front.seconds[front.front], _QUICKEST), front.error[front.front]
        axes.step(t, e, where="post", color=BLACK, lw=1.0, zorder=1, label="Pareto front")
    axes.set_xscale("log")
    axes.set_yscale("log")
    if floor > 0.0:
        bottom = 0.3 * floor
        axes.axhspan(bottom, floor, color="0.85", zorder=0, lw=0)
        axes.set_ylim(bottom=bottom)
    _notes(axes, results, [*sectors, *formulas, *picked])
    axes.set_title(NAMES.get(quantity.name, quantity.name))


def _notes(axes: Axes, results: CostResults, rows: Sequence[Measured]) -> None:
    """Names beside the points; those that would lie on each other go to alternate sides."""
    left, right = axes.get_xlim()
    axes.set_xlim(left, right * 1.6)
    placed: list[tuple[float, float]] = []
    for row in sorted(rows, key=lambda r: -np.nan_to_num(_shown(results, r))):
        error = _shown(results, row)
        if not math.isfinite(error) or error <= 0.0:
            continue
        x, y = math.log10(max(row.seconds.cpu, _QUICKEST)), math.log10(error)
        crowd = sum(abs(x - a) < 0.9 and abs(y - b) < 0.13 for a, b in placed)
        placed.append((x, y))
        rung = row.rung
        text = f"{rung.teeth} teeth" if rung.teeth else rung.formula or f"{rung.tolerance:.0e}".replace("e-0", "e-")
        if row.miss.answered < 1.0:
            text += f" ({row.miss.answered:.0%} of the flank)"
        axes.annotate(
            text, (10.0**x, 10.0**y), xytext=(6, 3 - 8 * crowd), textcoords="offset points", fontsize=7, color="0.25",
            bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.6}, zorder=1.5,
        )  # fmt: skip


@in_house_style
def draw_quantity(results: CostResults, quantity: Quantity, path: Path) -> Picture:
    """Error against time of one quantity."""
    made, axes = figure(size=(8.4, 5.4))
    _draw(axes, results, quantity)
    axes.set_xlabel("processor seconds of one core, from nothing to the answer")
    axes.set_ylabel("largest relative error")
    axes.legend(loc="upper right", fontsize=8)
    floor = results.floors[quantity.name]
    caption = (
        f"{quantity.meaning[0].upper()}{quantity.meaning[1:]}: relative error against a converged solution over the "
        f"seconds it takes. The grey band is what the reference itself does not know (below {floor:.0e})."
    )
    return save(made, path, f"Cost of {NAMES.get(quantity.name, quantity.name)}", caption)


@in_house_style
def draw_together(results: CostResults, path: Path) -> Picture:
    """Error against time of every quantity."""
    count = len(results.quantities)
    columns = 1 if count == 1 else 2
    rows = math.ceil((count + (count > 1)) / columns)
    made, grid = figure(rows, columns, size=(5.6 * columns, 3.7 * rows), squeeze=False)
    places = list(grid.flat)
    for axes, quantity in zip(places, results.quantities, strict=False):
        _draw(axes, results, quantity)
        axes.set_xlabel("processor seconds of one core")
        axes.set_ylabel("largest relative error")
    handles, labels = places[0].get_legend_handles_labels()
    for axes in places[count:]:
        axes.set_axis_off()
    if places[count:]:
        places[-1].legend(handles, labels, loc="center", fontsize=10)
    else:
        places[0].legend(fontsize=8)
    return save(made, path, "What accuracy costs", "Every rung of the ladder; grey: what the reference does not know.")


@in_house_style
def draw_knobs(results: CostResults, path: Path) -> Picture:
    """Error against each knob, with the slopes that were found."""
    names = list(dict.fromkeys(k.name for k in results.knobs))
    columns = min(3, len(names))
    rows = math.ceil(len(names) / columns)
    # Many panels: three abreast and no larger than they must be.
    made, grid = figure(rows, columns, size=(4.0 * columns, 3.0 * rows), squeeze=False)
    colours = dict(zip(NAMES, (BLUE, ORANGE, RED, GREEN, PURPLE, BLACK, SKY, "0.5"), strict=True))
    for axes, name in zip(grid.flat, names, strict=False):
        for knob in (k for k in results.knobs if k.name == name):
            known = np.isfinite(knob.error)
            slope = "" if math.isnan(knob.order.slope) else f", order {knob.order.slope:.1f}"
            error = np.maximum(knob.error[known], _ROUND_OFF)
            axes.plot(knob.settings[known], error, "o-", ms=4, lw=1.0, color=colours[knob.quantity],
                      label=f"{knob.quantity}{slope}")  # fmt: skip
        ticks = sorted({float(s) for k in results.knobs if k.name == name for s in k.settings})
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks(ticks, [f"{s:.4g}" for s in ticks], rotation=45 if len(ticks) > 6 else 0, fontsize=8)
        axes.minorticks_off()
        axes.set_title(name + (" [modules]" if name.startswith(("edge", "patch")) else ""), fontsize=9)
        axes.legend(fontsize=7)
    for axes in list(grid.flat)[len(names) :]:
        axes.set_axis_off()
    for axes in grid[:, 0]:
        axes.set_ylabel("relative error")
    return save(made, path, "What each knob does", "One setting varied at a time, all others fine.")


def draw_cost(results: CostResults, folder: Path) -> list[Picture]:
    """Draw every picture of a study into a folder."""
    made = [draw_together(results, folder / "cost.png")]
    made += [draw_quantity(results, q, folder / f"cost_{q.name}.png") for q in results.quantities]
    if results.knobs:
        made.append(draw_knobs(results, folder / "cost_knobs.png"))
    return made
