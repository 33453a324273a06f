"""A case over a grid of values of some of its keys: every point a run of its own, kept as soon as it is finished."""

from __future__ import annotations

import copy
import hashlib
import itertools
import math
import re
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fegear.case.reading import build_scene, read_document, set_key
from fegear.engine.executor import Executor, count_kept, map_points
from fegear.engine.outcome import Column, Table, Value
from fegear.engine.plan import make_plan
from fegear.engine.point_job import Failure
from fegear.engine.run import run_plan
from fegear.errors import InputError
from fegear.results.catalogue import STAGES
from fegear.solution_cache import SolutionCache

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fegear.engine.stage import Progress
    from fegear.studies.axis import Axis

#: Points of a sweep beyond which its results do not fit into memory: some 10 GB.
_MOST_POINTS = 100_000
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


@dataclass(frozen=True)
class Point:
    """Results of one point of a sweep."""

    values: tuple[Value, ...]
    tables: tuple[Table, ...]
    remarks: tuple[str, ...]


class FailedAlike(NamedTuple):
    """Points that failed for the same reason but for its numbers.

    Attributes
    ----------
    kind : str
    reason : str
        Of the first of them.
    members : tuple of int
        Their places in the sweep's points.
    """

    kind: str
    reason: str
    members: tuple[int, ...]


@dataclass(frozen=True)
class SweepResults:
    """Everything that a sweep found.

    Attributes
    ----------
    name, title : str
    axes : tuple of Axis
    points : tuple of Point or Failure
        In the order of the grid, the last axis fastest.
    seconds : float
    kept : int
        Points that were finished by an earlier sweep.
    shapes : tuple of (int, int, float)
        Tooth shapes solved now, shapes recalled, and the seconds that those took when they were solved.
    """

    name: str
    title: str
    axes: tuple[Axis, ...]
    points: tuple[Point | Failure, ...]
    seconds: float
    kept: int
    shapes: tuple[int, int, float]

    @property
    def failures(self) -> tuple[tuple[int, Failure], ...]:
        """Points without a result, with their place in `points`."""
        return tuple((i, point) for i, point in enumerate(self.points) if isinstance(point, Failure))

    def place(self, index: int) -> str:
        """``gear.a.teeth = 20, gear.a.profile_shift = 0.1``."""
        where = np.unravel_index(index, [len(axis) for axis in self.axes])
        return ", ".join(axis.words(int(i)) for axis, i in zip(self.axes, where, strict=True))

    def failed(self) -> list[FailedAlike]:
        """Failures that differ in their numbers only, together; the largest group first."""
        groups: dict[tuple[str, str], list[tuple[int, Failure]]] = {}
        for i, failure in self.failures:
            groups.setdefault((failure.kind, _NUMBER.sub("#", failure.reason)), []).append((i, failure))
        return [
            FailedAlike(kind, found[0][1].reason, tuple(i for i, _ in found))
            for (kind, _), found in sorted(groups.items(), key=lambda group: -len(group[1]))
        ]

    def grouped_failures(self) -> list[str]:
        """One sentence for each kind of failure: how many points, where the first is, and what it says."""
        return [
            f"{len(group.members)} of {len(self.points)} points failed ({group.kind}), the first at "
            f"{self.place(group.members[0])}: {group.reason}"
            for group in self.failed()
        ]

    def remarks(self) -> list[str]:
        """Return what the points remark, alike ones as one sentence."""
        groups: dict[str, list[str]] = {}
        for point in self.points:
            for remark in point.remarks if isinstance(point, Point) else ():
                groups.setdefault(_NUMBER.sub("#", remark), []).append(remark)
        return [
            found[0] if len(found) == 1 else f"{len(found)} of {len(self.points)} points, the first of them: {found[0]}"
            for found in groups.values()
        ]


def sweep_case(
    path: str | Path,
    axes: Sequence[Axis],
    overrides: Sequence[str] = (),
    *,
    cache: SolutionCache | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> SweepResults:
    """Run a case at every point of a grid.

    Parameters
    ----------
    path : path of a case file
    axes : sequence of Axis
    overrides : sequence of "dotted.key=value"
    cache : SolutionCache, optional
        Where it has a disk, finished points are kept and looked for there; a sweep that was killed goes on from them.
    executor, progress
        See `fegear.engine.executor.map_points`.

    Raises
    ------
    InputError
        If the case cannot be read or an axis names a key that does not exist. What goes wrong at a point only becomes
        that point's `Failure`.
    """
    started = time.perf_counter()
    path = Path(path)
    document = read_document(path, overrides)
    _check(axes, document)
    points = [
        {"document": changed, "name": path.stem, "folder": str(path.parent.absolute())}
        for changed in _grid(document, axes)
    ]
    cache = SolutionCache() if cache is None else cache
    kept = count_kept(compute_point, points, cache, point_content)
    before = cache.shapes.state
    found = map_points(
        compute_point, points, executor or Executor(), cache, key=point_content, shares_cache=True, progress=progress
    )
    used = cache.shapes.since(before)
    shapes = (used.computed, used.recalled, used.spared)
    results = tuple(item if isinstance(item, Failure) else _point(item) for item in found)
    title = str(document.get("title") or path.stem)
    return SweepResults(path.stem, title, tuple(axes), results, time.perf_counter() - started, kept, shapes)


def _check(axes: Sequence[Axis], document: Mapping[str, Any]) -> None:
    """Refuse axes that name a key twice or one that no case has."""
    if not axes:
        raise InputError("--over", "(not given)", "is what a sweep needs", "for example --over gear.a.teeth=20:40:21")
    names = [axis.key for axis in axes]
    for name in names:
        if names.count(name) > 1:
            raise InputError("--over", f'"{name}"', "is given twice", "merge its values into one --over")
    count = math.prod(len(axis) for axis in axes)
    if count > _MOST_POINTS:
        size = " x ".join(f"{len(axis):,}" for axis in axes) + f" = {count:,}"
        raise InputError("--over", size, "points are more than a sweep can hold", f"ask for {_MOST_POINTS:,} at most")
    trial = copy.deepcopy(dict(document))
    for axis in axes:
        set_key(trial, axis.key, axis.values[0], "--over")


def _grid(document: Mapping[str, Any], axes: Sequence[Axis]) -> Iterator[dict[str, Any]]:
    for values in itertools.product(*(axis.values for axis in axes)):
        changed = copy.deepcopy(dict(document))
        for axis, value in zip(axes, values, strict=True):
            set_key(changed, axis.key, value, "--over")
        yield changed


def compute_point(point: Mapping[str, Any], cache: SolutionCache) -> dict[str, object]:
    """Run one point: a case document with its name and folder; returns its values and tables as plain data."""
    scene = build_scene(point["document"], point["name"], Path(point["folder"]))
    results = run_plan(scene, make_plan(scene, STAGES), cache=cache, executor=Executor(here=True))
    return {
        "values": [(v.name, float(v.si), v.unit, v.si_error, v.meaning) for v in results.values],
        "tables": [
            (t.name, t.title, [(c.name, np.asarray(c.si), c.unit, c.meaning) for c in t.columns])
            for t in results.tables
        ],
        "remarks": list(results.remarks),
    }


def point_content(point: Mapping[str, Any]) -> object:
    """All that a point's result depends on: the case without its title, and what is in the files that it names."""
    document = {key: value for key, value in point["document"].items() if key != "title"}
    folder = Path(point["folder"])

    def texts(item: object) -> Iterator[str]:
        if isinstance(item, str):
            yield item
        elif isinstance(item, dict):
            for value in item.values():
                yield from texts(value)
        elif isinstance(item, list):
            for value in item:
                yield from texts(value)

    files = {}
    for text in sorted(set(texts(document))):
        try:
            files[text] = hashlib.sha256((folder / text).read_bytes()).hexdigest()
        except (OSError, ValueError):  # most texts are no names of files
            continue
    return [document, files]


def _point(found: Mapping[str, Any]) -> Point:
    return Point(
        tuple(Value(*value) for value in found["values"]),
        tuple(
            Table(name, tuple(Column(*column) for column in columns), title) for name, title, columns in found["tables"]
        ),
        tuple(found["remarks"]),
    )
