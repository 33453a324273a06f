"""Every value of a sweep over its points, and which of them are worth a look."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fegear.engine.point_job import Failure
from fegear.studies.sweep import Axis, Point, SweepResults

Array = NDArray[np.generic]


#: Values that vary by less than this share of their size do not vary.
_ROUND_OFF = 1e-12
#: Differences below this, in the unit of a value, are round-off of zero.
_NOTHING = 1e-12
#: By which values one point is chosen before another, by the end of their names, and whether the most is best.
_CHOSEN_BY = {
    "te_peak_to_peak": False, "largest_root_tension": False, "largest_hertz_pressure": False, "K_Hbeta": False,
    "S_F": True, "S_H": True,
}  # fmt: skip
#: Of one pair each of these is told, of many the first.
_MOST_TOLD = 8


def failures(results: SweepResults) -> Array:
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
    number: NDArray[np.float64]
    error: NDArray[np.float64] | None

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


def axis_head(axis: Axis) -> str:
    """Head of an axis's column in the table of the sweep."""
    return f"{axis.key} [{axis.unit}]" if axis.unit else axis.key


def is_geometric(axis: Axis) -> bool:
    """Whether the values grow by a constant factor, so that a logarithmic scale spaces them evenly."""
    values = np.array(axis.numbers or ())
    if values.size < 3 or values.min() <= 0.0:
        return False
    steps, differences = np.diff(np.log(values)), np.diff(values)
    return bool(np.ptp(steps) < 1e-6 * abs(steps[0]) and np.ptp(differences) > 1e-6 * abs(differences[0]))


def varying(swept: Sequence[Swept]) -> list[Swept]:
    """The values that differ between points; the others need no picture."""

    def moves(number: NDArray[np.float64]) -> bool:
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
        line = f"{'Largest' if most else 'Least'} {one.name}: {one.number[best]:.6g} {one.unit}".rstrip()
        line += f" at {results.place(best)}"
        if alike:
            line += (
                f"; {alike} other point{'s do' if alike > 1 else ' does'} not differ from it by more than the errors"
            )
        ends = [
            axis.key
            for axis, i in zip(results.axes, np.unravel_index(best, grid), strict=True)
            if axis.numbers is not None and len(axis) > 2 and i in (0, len(axis) - 1)
        ]
        if ends:
            line += f"; it lies at the end of {' and '.join(ends)}"
        lines.append(f"{line}.")
    return lines[:_MOST_TOLD]
