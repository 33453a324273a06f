"""One effect: an answer with it and without it, and the processor seconds of both."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import BLUE, ORANGE, Picture, figure, in_house_style, save

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.engine.outcome import Column, Table
    from fegear.studies.effect_study import Switched

_TITLES = {
    "dynamic_factor": "dynamic factor",
    "te": "transmission error",
    "force": "force on one tooth pair",
    "load": "load on one tooth pair",
    "stress": "root stress",
    "relief": "relief",
}
_NAMES = {"hertz": "contacts that widen with load", "parametric": "stiffness that varies in time"}
_ABSCISSAE = {"x": "position on the line of action", "speed": "speed", "phi1": "pinion angle"}


def _column(table: Table, name: str) -> Column:
    return next(column for column in table.columns if column.name == name)


def _label(words: dict[str, str], column: Column) -> str:
    unit = f" [{column.unit}]" if column.unit else ""
    return f"{words.get(column.name, column.name)}{unit}"


def _drawn(table: Table, column: str) -> NDArray[np.float64]:
    return np.asarray(_column(table, column).shown, dtype=float)


@in_house_style
def draw_effect(found: Switched, curve: tuple[Table, Table, str, str] | None, path: Path, title: str) -> Picture:
    """Draw one effect: a curve without it and with it, the change, and the seconds."""
    name = _NAMES.get(found.effect, found.effect.replace("_", " "))
    made, axes = figure(2, 2, size=(8.2, 4.6), width_ratios=[4.2, 1.0], height_ratios=[2.6, 1.0], sharex="col")
    (left, upper), (below, lower) = axes
    upper.remove()
    lower.remove()
    right = made.add_subplot(left.get_gridspec()[:, 1])
    made.suptitle(f"{name[0].upper()}{name[1:]}", x=0.01, ha="left", fontsize=12, fontweight="bold")
    left.set_title(title)
    what = "no curve"
    if curve is None:
        for axes in (left, below):
            axes.set_axis_off()
        left.text(0.5, 0.5, "changes no curve of this case", ha="center", va="center", transform=left.transAxes)
    else:
        before, after, x, y = curve
        for table, colour, dash, word in ((before, ORANGE, "--", "without"), (after, BLUE, "-", "with")):
            left.plot(_drawn(table, x), _drawn(table, y), dash, color=colour, label=word)
        left.set_ylabel(_label(_TITLES, _column(after, y)))
        left.legend(loc="upper left", bbox_to_anchor=(0.0, 1.0), ncols=2)
        left.margins(y=0.2)
        at = _drawn(before, x)
        at = at[(at >= _drawn(after, x)[0]) & (at <= _drawn(after, x)[-1])]
        change = np.interp(at, _drawn(after, x), _drawn(after, y)) - np.interp(at, _drawn(before, x), _drawn(before, y))
        below.fill_between(at, change, color=BLUE, alpha=0.3, lw=0.0)
        below.plot(at, change, color=BLUE, lw=1.2)
        below.set_ylabel("change")
        below.set_xlabel(_label(_ABSCISSAE, _column(after, x)))
        what = _TITLES.get(y, y)
    seconds = [found.without.seconds, found.with_it.seconds]
    bars = right.bar(["without", "with"], seconds, color=[ORANGE, BLUE], width=0.6)
    right.bar_label(bars, [f"{s:.2g}" for s in seconds], padding=2)
    right.set_ylabel("processor time of the run [s]", fontsize=9)
    right.set_ylim(0.0, 1.15 * max(*seconds, 1e-3))
    right.set_axisbelow(True)
    right.grid(visible=False, axis="x")
    caption = f"{name}: {what} with it and without it, the change, and the processor seconds of the whole run."
    return save(made, path, f"Effect of {name}", caption)
