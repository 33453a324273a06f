"""A case over a grid of values of some of its keys: every point a run of its own, kept as soon as it is finished.

``--over KEY=START:STOP:COUNT``: one axis of a sweep.
"""

from __future__ import annotations

import copy
import itertools
import math
import re
import time
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.unit_text import plain_number
from fegear.case.built.atlas_teeth import SOLVED_AFTER_ALL
from fegear.case.reading import build_scene, read_document, set_key, typed_value
from fegear.case.text_file import digest_of_file
from fegear.engine.executor import Executor, count_kept, map_points
from fegear.engine.plan import make_plan
from fegear.engine.processes import Failure
from fegear.engine.progress import Progress
from fegear.engine.run import run_plan
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.catalogue import STAGES

#: Keys of which a case has one: two measures of the same length.
_OTHER_KEYS = {"bore_radius": "bore_diameter", "bore_diameter": "bore_radius"}
#: Points of a sweep beyond which its results do not fit into memory: some 10 GB.
_MOST_POINTS = 100_000


_NUMBER = re.compile(r"[-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?")


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
    given = read_document(path, overrides)
    _check(axes, given)
    document = _by_atlas(axes, given)
    points = [
        {"document": changed, "name": path.stem, "folder": str(path.parent.absolute())}
        for changed in map(_neglecting, itertools.count(), _grid(document, axes))
    ]
    cache = SolutionCache() if cache is None else cache
    kept = count_kept(compute_point, points, cache, point_content)
    before = cache.shapes.state
    found = map_points(
        compute_point, points, executor or Executor(), cache, key=point_content, shares_cache=True, progress=progress
    )
    used = cache.shapes.since(before)
    shapes = (used.computed, used.recalled, used.spared)
    unasked = document is not given  # for an atlas: that one answers is said, not that none does
    results = tuple(item if isinstance(item, Failure) else _point(item, unasked=unasked) for item in found)
    title = str(document.get("title") or path.stem)
    return SweepResults(path.stem, title, tuple(axes), results, time.perf_counter() - started, kept, shapes)


def _check(axes: Sequence[Axis], document: Mapping[str, Any]) -> None:
    """Refuse axes that name a key twice or one that no case has."""
    if not axes:
        raise InputError("--over", "(not given)", "is required for a sweep", "for example --over gear.a.teeth=20:40:21")
    names = [axis.key for axis in axes]
    for name in names:
        if names.count(name) > 1:
            raise InputError("--over", f'"{name}"', "is specified twice", "combine its values in one --over")
    count = math.prod(len(axis) for axis in axes)
    if count > _MOST_POINTS:
        size = " x ".join(f"{len(axis):,}" for axis in axes) + f" = {count:,}"
        raise InputError("--over", size, "points exceed the maximum of a sweep", f"reduce to at most {_MOST_POINTS:,}")
    trial = copy.deepcopy(dict(document))
    for axis in axes:
        _refuse_contradicted(trial, axis)
        set_key(trial, axis.key, axis.values[0], "--over")


def _refuse_contradicted(document: Mapping[str, Any], axis: Axis) -> None:
    """Refuse an axis over one of two keys of the same length where the case has the other: no point would be one."""
    part, _, key = axis.key.rpartition(".")
    held: Any = document
    for name in part.split("."):
        held = held.get(name) if isinstance(held, dict) else None
    other = _OTHER_KEYS.get(key)
    if other is not None and isinstance(held, dict) and other in held:
        raise InputError(
            "--over", f'"{axis.key}"', f"contradicts {part}.{other} = {held[other]} of the case",
            f"sweep {part}.{other}, or remove it from the case",
        )  # fmt: skip


def _by_atlas(axes: Sequence[Axis], document: dict[str, Any]) -> dict[str, Any]:
    """A document that takes teeth from an atlas where one answers, unless it says otherwise and where gears change."""
    accuracy = document.get("accuracy", {})
    said = not isinstance(accuracy, dict) or "source" in accuracy or any(one.key == _SOURCE for one in axes)
    if said or not any(one.key.startswith("gear.") for one in axes):
        return document
    return {**document, "accuracy": {**accuracy, "source": "auto"}}


_SOURCE = "accuracy.source"


def _grid(document: Mapping[str, Any], axes: Sequence[Axis]) -> Iterator[dict[str, Any]]:
    for values in itertools.product(*(axis.values for axis in axes)):
        changed = copy.deepcopy(dict(document))
        for axis, value in zip(axes, values, strict=True):
            set_key(changed, axis.key, value, "--over")
        yield changed


def _neglecting(index: int, document: dict[str, Any]) -> dict[str, Any]:
    """A point's document that says whether neglected effects are sized there: only where it is asked for."""
    given = document.get("neglected", False)
    return {**document, "neglected": index == 0 if given == "once" else given}


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

    digests = {text: digest_of_file(folder / text) for text in sorted(set(texts(document)))}
    return [document, {text: digest for text, digest in digests.items() if digest}]  # most texts name no files


def _point(found: Mapping[str, Any], *, unasked: bool) -> Point:
    return Point(
        tuple(Value(*value) for value in found["values"]),
        tuple(
            Table(name, tuple(Column(*column) for column in columns), title) for name, title, columns in found["tables"]
        ),
        tuple(one for one in found["remarks"] if not (unasked and SOLVED_AFTER_ALL in one)),
    )


_EXAMPLE = "for example --over gear.a.profile_shift=-0.4:0.8:25, =0.1,0.2,0.5 or =10:20:6:mm"


_QUANTITY = re.compile(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([^\s0-9.,].*|1\s*/.*)?")


_MOST = 1_000_000


@dataclass(frozen=True, slots=True)
class Axis:
    """A key of the case and the values that it takes.

    Parameters
    ----------
    key : str
        ``gear.a.profile_shift``.
    values : tuple
        As a case file would hold them.
    numbers : tuple of float or None
        The same as numbers in `unit`; None where they are none.
    unit : str
    """

    key: str
    values: tuple[object, ...]
    numbers: tuple[float, ...] | None
    unit: str = ""

    def __len__(self) -> int:
        """Return how many values it has."""
        return len(self.values)

    def words(self, index: int) -> str:
        """``profile_shift = 0.25``."""
        return f"{self.key} = {self.values[index]}"


def read_axis(text: str) -> Axis:
    """Read an axis as the user writes it.

    Parameters
    ----------
    text : str
        ``KEY=START:STOP:COUNT`` for equally spaced values, with ``:log`` behind for values in geometric progression;
        ``KEY=V1,V2,...`` for a list. Quantities carry their unit: ``10 mm:20 mm:6`` or, once for all,
        ``10:20:6:mm`` and ``10,15,20:mm``. Whole numbers stay whole where the spacing allows it.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    key, equals, given = (part.strip() for part in text.partition("="))
    if not equals or not key or not given:
        raise InputError("--over", f'"{text}"', "must have the form KEY=START:STOP:COUNT or KEY=V1,V2,...", _EXAMPLE)
    parts = [part.strip() for part in given.split(":")]
    if len(parts) == 1 or given.startswith(("[", '"')):
        return _list(key, given)
    if len(parts) == 2 and "," in parts[0] and not any(map(_is_number, parts[1].split(","))):
        return _list(key, ",".join(f"{one.strip()} {parts[1]}" for one in parts[0].split(",")))
    if len(parts) not in (3, 4, 5):
        rule = "must have the form KEY=START:STOP:COUNT or KEY=V1,V2,..."
        raise InputError("--over", f'"{text}"', rule, _EXAMPLE)
    return _range(key, parts, text)


def _is_number(text: str) -> bool:
    return plain_number(text) is not None


def _range(key: str, parts: list[str], text: str) -> Axis:
    geometric = "log" in parts[3:]
    units = [part for part in parts[3:] if part != "log"]
    ends = [_QUANTITY.fullmatch(part) for part in parts[:2]]
    found = {match[2] for match in ends if match and match[2]} | set(units)
    if None in ends or len(found) > 1 or not re.fullmatch("[0-9]{1,9}", parts[2]):
        raise InputError(
            "--over", f'"{text}"', "must have the form KEY=START:STOP:COUNT with one unit for both ends", _EXAMPLE
        )
    start, stop = (float(match[1]) for match in ends if match)
    if not (math.isfinite(start) and math.isfinite(stop)):
        raise InputError("--over", f'"{text}"', "must have finite ends", _EXAMPLE)
    count, unit = int(parts[2]), next(iter(found), "")
    if not 1 <= count <= _MOST:
        raise InputError("--over", f'"{text}"', f"requests {count} values; must be 1 to {_MOST}", _EXAMPLE)
    if count == 1 and start != stop:
        raise InputError("--over", f'"{text}"', "has one value but two different ends", _EXAMPLE)
    if geometric and not (start > 0.0 and stop > 0.0):
        raise InputError("--over", f'"{text}"', "is logarithmic: both ends must be positive", _EXAMPLE)
    raw = np.geomspace(start, stop, count) if geometric else np.linspace(start, stop, count)
    # What the user would have written: 0.1, not 0.09999999999999998; and 0, not 5.6e-17.
    digits = 12 - math.ceil(math.log10(max(abs(start), abs(stop)) or 1.0))
    numbers = [float(f"{value:.12g}") if geometric else round(float(value), digits) + 0.0 for value in raw]
    whole = all(match is not None and match[1].lstrip("+-").isdigit() for match in ends)
    if whole and not unit and all(number.is_integer() for number in numbers):
        return Axis(key, tuple(int(number) for number in numbers), tuple(numbers))
    values = tuple(f"{number:.12g} {unit}" if unit else number for number in numbers)
    return Axis(key, values, tuple(numbers), unit)


def _list(key: str, given: str) -> Axis:
    glued = re.search(r"(?<![\w.])[-+]?[0-9]+,[0-9]+(?![\w.])", given)
    if glued and "." in given and '"' not in given:
        point, two = glued[0].replace(",", "."), glued[0].replace(",", ".0,") + ".0"
        raise InputError(
            "--over", f'"{key}={given}"', f"may contain a decimal comma ({glued[0]})",
            f"use {point}, or {two} for two numbers",
        )  # fmt: skip
    try:
        read = tomllib.loads(f"values = {given if given.startswith('[') else f'[{given}]'}")
    except (ValueError, RecursionError):
        read = {}
    values: list[Any] = read["values"] if set(read) == {"values"} else list(map(typed_value, given.split(",")))
    if not values or len({str(value) for value in values}) < len(values):
        raise InputError("--over", f'"{key}={given}"', "must list different values", _EXAMPLE)
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        if not all(math.isfinite(value) for value in values):
            raise InputError("--over", f'"{key}={given}"', "must list finite values", _EXAMPLE)
        return Axis(key, tuple(values), tuple(float(value) for value in values))
    # A number that TOML reads as one has no unit: 1,5 mm,2,6 mm are four values, not two.
    found = [_QUANTITY.fullmatch(value if isinstance(value, str) else repr(value)) for value in values]
    units = {match[2] for match in found if match}
    if len(units) > 1 and None in units:
        raise InputError(
            "--over", f'"{key}={given}"', "mixes numbers with and without units",
            "use decimal points, and a unit for each number",
        )  # fmt: skip
    if None not in found and len(units) == 1 and None not in units:
        return Axis(key, tuple(values), tuple(float(match[1]) for match in found if match), units.pop())
    return Axis(key, tuple(values), None)
