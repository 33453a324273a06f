"""Pictures of a sweep over one or two axes: a curve, a family of curves or a map for each value that varies."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.loaded_teeth import load_colours
from fegear.output.pictures.style import BLUE, DASHES, RED, Picture, figure, in_house_style, save
from fegear.output.report.numbers import pretty_unit
from fegear.output.report.swept import axis_title, is_geometric

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fegear.output.sweep_dataset import Swept
    from fegear.studies.axis import Axis

    Array = NDArray[np.float64]


def _title(one: Swept) -> str:
    return f"{one.name} [{pretty_unit(one.unit)}]" if one.unit else one.name


def picture_name(one: Swept) -> str:
    """Name of a value's picture file."""
    return f"sweep_{re.sub(r'[^A-Za-z0-9_.-]+', '_', one.name)}.png"


def _along(axes: Axes, axis: Axis) -> Array:
    """Places of an axis's values on the abscissa; names get whole numbers."""
    axes.set_xlabel(axis_title(axis))
    if axis.numbers is None:
        places = np.arange(len(axis), dtype=float)
        axes.set_xticks(places, [str(value) for value in axis.values])
        return places
    if is_geometric(axis):
        axes.set_xscale("log")
    return np.array(axis.numbers)


@in_house_style
def draw_curve(one: Swept, axis: Axis, path: Path) -> Picture:
    """Draw a value over the only axis, with its estimated error; crosses on the ground mark failed points."""
    made, axes = figure()
    x = _along(axes, axis)
    marker = "o" if x.size <= 40 or axis.numbers is None else ""
    line = "-" if axis.numbers is not None else ""
    axes.plot(x, one.number, line, color=BLUE, marker=marker, ms=4)
    if one.error is not None:
        low, high = one.number - one.error, one.number + one.error
        if axis.numbers is not None:
            axes.fill_between(x, low, high, color=BLUE, alpha=0.25, lw=0)
        else:
            axes.errorbar(x, one.number, one.error, fmt="none", ecolor=BLUE)
    failed = ~np.isfinite(one.number)
    if failed.any():
        axes.plot(
            x[failed], np.zeros(failed.sum()), "x", color=RED, ms=6, transform=axes.get_xaxis_transform(),
            clip_on=False, label="no result",
        )  # fmt: skip
        axes.legend(fontsize=9)
    axes.set_ylabel(_title(one))
    return save(made, path, one.name, f"{one.meaning or one.name} over {axis.key}.")


@in_house_style
def draw_family(one: Swept, along: Axis, other: Axis, values: Array, path: Path) -> Picture:
    """Draw a value over an axis of numbers, one curve for each name on the other axis; `values` over (along, other)."""
    made, axes = figure(size=(8.2, 4.4))
    x = _along(axes, along)
    line = "" if along.numbers is None else "-"
    for k, colour in enumerate(load_colours(len(other))):
        style = DASHES[k % len(DASHES)] if line else ""
        axes.plot(x, values[:, k], style, color=colour, marker="os^D"[k % 4], ms=4, label=str(other.values[k]))
    axes.set_ylabel(_title(one))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=9, title=other.key)
    return save(made, path, one.name, f"{one.meaning or one.name} over {along.key} and {other.key}.")


@in_house_style
def draw_map(one: Swept, across: Axis, up: Axis, values: Array, path: Path) -> Picture:
    """Draw a value over two axes of numbers as a map; grey points have no result; `values` over (across, up)."""
    made, axes = figure()
    x = _along(axes, across)
    y = np.array(up.numbers)
    axes.set_facecolor("0.75")
    shown = axes.pcolormesh(x, y, np.ma.masked_invalid(values).T, cmap="viridis", shading="nearest")
    axes.set_ylabel(axis_title(up))
    if is_geometric(up):
        axes.set_yscale("log")
    axes.grid(visible=False)
    made.colorbar(shown, ax=axes, label=_title(one))
    told = " Grey: no result." if not np.isfinite(values).all() else ""
    return save(made, path, one.name, f"{one.meaning or one.name} over {across.key} and {up.key}.{told}")


def draw_value(one: Swept, axes: tuple[Axis, ...], folder: Path) -> Picture:
    """Draw one value of a sweep over one or two axes of more than one value each."""
    path = folder / picture_name(one)
    if len(axes) == 1:
        return draw_curve(one, axes[0], path)
    first, second = axes
    values = one.number.reshape(len(first), len(second))
    if first.numbers is not None and second.numbers is not None:
        return draw_map(one, first, second, values, path)
    if first.numbers is not None:
        return draw_family(one, first, second, values, path)
    return draw_family(one, second, first, values.T, path)
