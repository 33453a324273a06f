"""Every value of a sweep over its points, and which of them are worth a look.

Figures of a sweep: every value as a map or as curves over the axes, and all points at a glance.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.family import few, ramp
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Curve, HeatMap, Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.processes import Failure
from fegear.studies.sweep import Axis as SweepAxis
from fegear.studies.sweep import Point, SweepResults

#: Values that vary by less than this share of their size do not vary.
_ROUND_OFF = 1e-12
#: Differences below this, in the unit of a value, are round-off of zero.
_NOTHING = 1e-12
#: By which values one point is chosen before another, by the end of their names, and whether the most is best.
_CHOSEN_BY = {
    "te_peak_to_peak": False, "unloaded_te_peak_to_peak": False, "largest_root_tension": False,
    "largest_hertz_pressure": False, "K_Hbeta": False, "S_F": True, "S_H": True,
}  # fmt: skip
#: Of one pair each of these is told, of many the first.
_MOST_TOLD = 8


def failures(results: SweepResults) -> NDArray[np.generic]:
    """Why each point failed; an empty text where it did not."""
    return np.array([f"{p.kind}: {p.reason}" if isinstance(p, Failure) else "" for p in results.points])


def shared_clauses(meanings: Iterable[str]) -> str:
    """Clauses that all meanings have in common: some name a place that differs from point to point."""
    first, *others = dict.fromkeys(meanings)
    return ", ".join(clause for clause in first.split(", ") if all(clause in other.split(", ") for other in others))


class Swept(NamedTuple):
    """One value of a run over all points of a sweep.

    Attributes
    ----------
    name, unit, meaning : str
    number : ndarray, shape (points,)
        In that unit; NaN where the point has no such value.
    error : ndarray, shape (points,), or None
        Estimated errors; None if no point has one.
    """

    name: str
    unit: str
    meaning: str
    number: Array
    error: Array | None

    @property
    def head(self) -> str:
        """Head of its column in the table of the sweep."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def error_head(self) -> str:
        """Head of the column of its errors."""
        return f"{self.name}_error [{self.unit}]" if self.unit else f"{self.name}_error"


def swept_values(results: SweepResults) -> Iterator[Swept]:
    """Every single value of the runs, over all points."""
    found = [(i, v) for i, point in enumerate(results.points) if isinstance(point, Point) for v in point.values]
    for name, unit in dict.fromkeys((v.name, v.unit) for _, v in found):
        number, error = np.full(len(results.points), np.nan), np.full(len(results.points), np.nan)
        same = [(i, v) for i, v in found if (v.name, v.unit) == (name, unit)]
        for i, v in same:
            number[i], error[i] = v.value, np.nan if v.error is None else v.error
        yield Swept(
            name, unit, shared_clauses(v.meaning for _, v in same), number, None if np.isnan(error).all() else error
        )


def axis_head(axis: SweepAxis) -> str:
    """Head of an axis's column in the table of the sweep."""
    return f"{axis.key} [{axis.unit}]" if axis.unit else axis.key


def is_geometric(axis: SweepAxis) -> bool:
    """Whether the values grow by a constant factor, so that a logarithmic scale spaces them evenly."""
    values = np.array(axis.numbers or ())
    if values.size < 3 or values.min() <= 0.0:
        return False
    steps, differences = np.diff(np.log(values)), np.diff(values)
    return bool(np.ptp(steps) < 1e-6 * abs(steps[0]) and np.ptp(differences) > 1e-6 * abs(differences[0]))


def varying(swept: Sequence[Swept]) -> list[Swept]:
    """The values that differ between points; the others need no picture."""

    def moves(number: Array) -> bool:
        found = number[np.isfinite(number)]
        return found.size > 1 and float(np.ptp(found)) > max(_ROUND_OFF * float(np.abs(found).max()), _NOTHING)

    return [one for one in swept if moves(one.number)]


def best_lines(results: SweepResults, swept: Sequence[Swept]) -> list[str]:
    """Where the values by which one chooses are best: one line each, with how sure that is.

    A point whose value differs from the best by less than both errors may as well be the best; a best at the end of an
    axis may lie beyond it.
    """
    lines, grid = [], [len(axis) for axis in results.axes]
    for one in swept:
        most = _CHOSEN_BY.get(one.name.rpartition(".")[2])
        if most is None:
            continue
        best = int(np.nanargmax(one.number) if most else np.nanargmin(one.number))
        error = np.zeros(one.number.size) if one.error is None else np.nan_to_num(one.error)
        alike = int(np.sum(np.abs(one.number - one.number[best]) <= error + error[best])) - 1
        line = f"{'Maximum' if most else 'Minimum'} {one.name}: {one.number[best]:.6g} {one.unit}".rstrip()
        line += f" at {results.place(best)}"
        if alike:
            line += f"; {alike} other point{'s' if alike > 1 else ''} equal within the estimated errors"
        ends = [
            axis.key
            for axis, i in zip(results.axes, np.unravel_index(best, grid), strict=True)
            if axis.numbers is not None and len(axis) > 2 and i in (0, len(axis) - 1)
        ]
        if ends:
            line += f"; at the limit of the range of {' and '.join(ends)}"
        lines.append(f"{line}.")
    return lines[:_MOST_TOLD]


#: Curves with fewer points than this show them.
_FEW_ENOUGH = 40
#: Ranges of colour of the lines through all points.
_LEVELS = 6
#: More values than this cannot be read beside each other.
_MOST_COORDINATES = 8


def sweep_figures(results: SweepResults, swept: Sequence[Swept]) -> tuple[Figure, ...]:
    """Describe the values that vary, over the axes of more than one value.

    Parameters
    ----------
    results : SweepResults
    swept : sequence of Swept
        Those that vary.

    Returns
    -------
    tuple of Figure
        Each value is a view; of the first figure, where there are at most two axes, each is a picture of its own.
    """
    axes = tuple(axis for axis in results.axes if len(axis) > 1)
    if not swept or not axes:
        return ()
    made = []
    mapped = len(axes) == 2 and all(axis.numbers is not None for axis in axes)
    if mapped:
        made.append(_maps(axes, swept))
    if len(axes) <= 2:
        made.append(_curves(axes, swept, alone=not mapped))
    if len(axes) + len(swept) > 2:
        made.append(_coordinates(results, axes, swept))
    return tuple(made)


def picture_name(one: Swept) -> str:
    """Stem of a value's picture file."""
    return f"sweep_{re.sub(r'[^A-Za-z0-9_.-]+', '_', one.name)}"


def _axis(axis: SweepAxis) -> Axis:
    if axis.numbers is None:
        return Axis(axis.key, categories=tuple(str(value) for value in axis.values))
    return Axis(axis.key, axis.unit, log=is_geometric(axis))


def _places(axis: SweepAxis) -> Array:
    return np.arange(len(axis), dtype=float) if axis.numbers is None else np.array(axis.numbers)


def _maps(axes: tuple[SweepAxis, ...], swept: Sequence[Swept]) -> Figure:
    across, up = axes
    views = []
    for one in swept:
        values = one.number.reshape(len(across), len(up)).T
        tiles = HeatMap(_places(across), _places(up), values, one.name, one.unit)
        views.append(View(one.name, (Panel(_axis(across), _axis(up), (tiles,)),), picture_name(one)))
    return Figure(
        "sweep_map", f"Values over {across.key} and {up.key}", "Grey: no result.", views=tuple(views)
    )  # fmt: skip


def _curves(axes: tuple[SweepAxis, ...], swept: Sequence[Swept], *, alone: bool) -> Figure:
    """Every value over the longest numeric axis, one curve for each value of the other axis."""
    along = max(axes, key=lambda axis: (axis.numbers is not None, len(axis)))
    others = [axis for axis in axes if axis is not along]
    views = []
    for one in swept:
        items = _family(one, axes, along, others[0]) if others else (_single(one, along),)
        lost = ~np.isfinite(one.number) if not others else np.zeros(0, dtype=bool)
        marks = tuple(Mark("x", float(x), "no result") for x in _places(along)[lost]) if not others else ()
        panel = Panel(_axis(along), Axis(one.name, one.unit), items, marks)
        views.append(View(one.name, (panel,), picture_name(one) if alone else ""))
    return Figure("sweep_curves", f"Values over {along.key}", "Failed points are gaps.", views=tuple(views))


def _single(one: Swept, along: SweepAxis) -> Curve | Points:
    if along.numbers is None:
        return Points(_places(along), one.number, one.name, "blue", error=one.error, size=8.0)
    return Curve(_places(along), one.number, one.name, "blue", one.error, markers=len(along) < _FEW_ENOUGH)


def _family(one: Swept, axes: tuple[SweepAxis, ...], along: SweepAxis, other: SweepAxis) -> tuple[Curve | Points, ...]:
    values = one.number.reshape(len(axes[0]), len(axes[1]))
    values = values if along is axes[0] else values.T
    chosen = few(len(other))
    roles = ramp(len(chosen)) if other.numbers is not None else [f"series:{k}" for k in range(len(chosen))]
    items: list[Curve | Points] = []
    for k, role in zip(chosen, roles, strict=True):
        label = f"{other.key.rsplit('.', 1)[-1]} = {other.values[k]}"
        if along.numbers is None:
            items.append(Points(_places(along), values[:, k], label, role, size=8.0))
        else:
            items.append(Curve(_places(along), values[:, k], label, role, markers=len(along) < _FEW_ENOUGH))
    return tuple(items)


def _coordinates(results: SweepResults, axes: tuple[SweepAxis, ...], swept: Sequence[Swept]) -> Figure:
    """Every point as a line through its place and its values, coloured by the value that is chosen."""
    chosen = swept[:_MOST_COORDINATES]
    where = np.unravel_index(np.arange(len(results.points)), [len(axis) for axis in results.axes])
    index = {id(axis): i for axis, i in zip(results.axes, where, strict=True)}
    keys = [axis.key.rsplit(".", 1)[-1] for axis in axes]
    names = keys if len(set(keys)) == len(keys) else [axis.key for axis in axes]
    columns = [_places(axis)[index[id(axis)]] for axis in axes] + [one.number for one in chosen]
    texts = [[str(axis.values[i]) for i in index[id(axis)]] for axis in axes]
    texts += [[f"{v:.5g} {one.unit}".rstrip() if np.isfinite(v) else "none" for v in one.number] for one in chosen]
    ends = [(float(np.nanmin(column)), float(np.nanmax(column))) for column in columns]
    extremes = [(str(axis.values[0]), str(axis.values[-1])) if axis.numbers is None else None for axis in axes]
    extremes += [None] * len(chosen)
    labels = tuple(
        f"{name}\n{words[0]} to {words[1]}" if words else f"{name}\n{low:.4g} to {high:.4g}"
        for name, (low, high), words in zip([*names, *(one.name for one in chosen)], ends, extremes, strict=True)
    )
    spans = zip(columns, ends, strict=True)
    heights = np.array([(c - low) / (high - low) if high > low else np.full(c.size, 0.5) for c, (low, high) in spans])
    failed = ~np.isfinite(heights).any(axis=0) | _failed(results)
    views = tuple(View(one.name, (_lines(one, heights, texts, labels, failed),)) for one in chosen)
    return Figure(
        "sweep_coordinates",
        "Overview of all points",
        "Parallel coordinates: one line per sweep point, coloured by the selected value. Click a range in the legend "
        "to hide it.",
        views=views,
    )


def _failed(results: SweepResults) -> NDArray[np.bool_]:
    return np.array([bool(reason) for reason in failures(results)])


def _lines(
    one: Swept, heights: Array, texts: Sequence[Sequence[str]], labels: tuple[str, ...], failed: NDArray[np.bool_]
) -> Panel:
    found = one.number[np.isfinite(one.number)]
    edges = np.linspace(found.min(), found.max(), _LEVELS + 1)
    level = np.clip(np.searchsorted(edges, one.number, side="right") - 1, 0, _LEVELS - 1)
    place = np.append(np.arange(len(labels), dtype=float), np.nan)
    items = []
    for k, role in enumerate(ramp(_LEVELS)):
        members = np.flatnonzero((level == k) & np.isfinite(one.number) & ~failed)
        if members.size:
            up = np.vstack([heights[:, members], np.full((1, members.size), np.nan)])
            notes = tuple(
                "" if row is None else f"{labels[row].split(chr(10))[0]}: {texts[row][point]}"
                for point in members.tolist()
                for row in [*range(len(labels)), None]
            )
            name = f"{edges[k]:.3g} to {edges[k + 1]:.3g} {one.unit}".rstrip()
            x = np.tile(place, members.size)
            items.append(Curve(x, up.T.ravel(), name, role, width=1.3, markers=False, notes=notes))
    return Panel(Axis(categories=labels), Axis(hidden=True, limits=(-0.05, 1.05)), tuple(items), height=1.2)
