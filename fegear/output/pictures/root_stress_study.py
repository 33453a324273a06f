"""One picture of the root-stress study: a tile for every gear, load position and formula."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import Picture, figure, in_house_style, save

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.engine.outcome import Table

#: Ratios beyond 1 -+ this have the full colour.
_FULL = 0.4
_INCH_A_ROW = 0.24
_COLUMNS = 3


@in_house_style
def draw_root_stress_study(table: Table, path: Path) -> Picture:
    """Draw formula over finite elements as numbered tiles: orange is high, blue is low, grey breaks down."""
    from matplotlib.colors import LinearSegmentedColormap

    names = list(dict.fromkeys(str(name) for name in table["formula"]))
    keys = [np.asarray(table[key], dtype=float) for key in ("teeth", "profile_shift", "rack_tip_radius")]
    gears = list(dict.fromkeys(zip(*keys, strict=True)))
    positions = list(dict.fromkeys(float(p) for p in table["load_position"]))
    ratio = np.asarray(table["ratio_to_fe"], dtype=float).reshape(len(gears), len(names), len(positions))
    scale = LinearSegmentedColormap.from_list("low to high", ["#0072B2", "#8FC1E3", "#FFFFFF", "#F2C46D", "#E69F00"])
    colours = scale.with_extremes(bad="0.72")
    columns = min(_COLUMNS, len(names))
    rows = -(-len(names) // columns)
    made, every = figure(
        rows, columns, size=(12.0, rows * (1.2 + _INCH_A_ROW * len(gears))), sharey=True, sharex=True, squeeze=False
    )
    image = None
    for i, axes in enumerate(every.flat):
        if i >= len(names):
            axes.set_visible(False)
            continue
        image = axes.imshow(
            np.ma.masked_invalid(ratio[:, i]), cmap=colours, vmin=1 - _FULL, vmax=1 + _FULL, aspect="auto"
        )
        axes.grid(visible=False)
        axes.set_title(names[i])
        axes.set_xticks(range(len(positions)), [f"{p:g}" for p in positions])
        axes.set_yticks(range(len(gears)), [f"{z:.0f} | {x:+.2g} | {r:.2g}" for z, x, r in gears], fontsize=9)
        for (row, column), value in np.ndenumerate(ratio[:, i]):
            text = f"{value:.2f}" if np.isfinite(value) else "×"
            strong = np.isfinite(value) and value < 1 - 0.75 * _FULL
            axes.text(column, row, text, ha="center", va="center", fontsize=8.5, color="white" if strong else "black")
        for edge in np.flatnonzero(np.diff([z for z, _, _ in gears])):
            axes.axhline(edge + 0.5, color="black", lw=0.8)
        if i + columns >= len(names):
            axes.set_xlabel("load: share of roll angle, start 0, end 1")
        if i % columns == 0:
            axes.set_ylabel("teeth | profile shift | rack tip radius in modules")
    if image is not None:
        bar = made.colorbar(image, ax=every, location="top", fraction=0.006, pad=0.004, aspect=60, extend="both")
        bar.set_label("root stress, formula / finite elements (× on grey: the formula breaks down)")
    caption = (
        "Root stress of one tooth under a load normal to the flank, formula over finite elements: white agrees, orange "
        "is high (safe), blue is low, grey breaks down (the table says why, point by point)."
    )
    return save(made, path, "Where each root-stress formula is high, low or breaks down", caption)
