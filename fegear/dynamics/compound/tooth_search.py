"""Numbers of teeth of a planetary set described as data that give a wanted ratio, and can be built.

Every gear takes every number of its range. What stays has the ratio, coaxial meshes (up to what profile shifts take),
planets that can be assembled and clear each other, and enough room in internal gears.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.base.printed import percent
from fegear.dynamics.compound.assembly import clearances, clusters
from fegear.dynamics.compound.compound_set import CompoundSet, Planets, Shaft

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.dynamics.compound.compound_set import Toothed, Wheel
    from fegear.dynamics.compound.speeds_and_torques import Drive

#: Combinations of tooth numbers that are looked at.
MOST = 2_000_000
#: Combinations whose ratios are computed at once, and those with the ratio that are looked at more closely.
_AT_ONCE, _CLOSELY = 50_000, 20_000
#: An internal gear has at least so many teeth more than its planet: less fouls at the tips of common racks.
_ROOM_IN_RING = 10
#: Ratios closer than this share are one.
_ONE = 1e-11


@dataclass(frozen=True)
class Wanted:
    """What is searched for.

    Parameters
    ----------
    ratio : float
        Speed of the driving over that of the loaded shaft, with its sign.
    tolerance : float
        Relative.
    ranges : mapping of str to (int, int)
        Smallest and largest number of teeth of every gear, by name.
    modules : mapping of str to float
        Transverse module of every gear [m].
    coaxial : float
        By how much reference centre distances of one planet may differ [modules], to be taken by profile shifts.
    clearance : float
        Smallest distance of tip circles of planets [modules].
    """

    ratio: float
    tolerance: float
    ranges: Mapping[str, tuple[int, int]]
    modules: Mapping[str, float]
    coaxial: float = 0.5
    clearance: float = 1.0


@dataclass(frozen=True)
class Candidate:
    """One combination of numbers of teeth.

    Parameters
    ----------
    teeth : mapping of str to int
    ratio : float
    off : float
        Relative deviation from the wanted ratio.
    coaxial : float
        Largest difference of reference centre distances of one planet [modules].
    clearance : float
        Of tip circles of planets [m].
    size : float
        Largest pitch diameter of gears on shafts, or over planets [m].
    common : int
        Meshes whose numbers of teeth have a common factor: a tooth meets fewer ones.
    in_phase : str
        Meshes with shafts whose planets are all in phase: torque adds up, radial forces cancel.
    """

    teeth: Mapping[str, int]
    ratio: float
    off: float
    coaxial: float
    clearance: float
    size: float
    common: int
    in_phase: str


def gears_of(of: CompoundSet) -> dict[str, Wheel]:
    """Gears in mesh, by name; one that is used twice stands once."""
    found = {}
    for one in of.toothed:
        found[one.other_wheel.name] = one.other_wheel
        found[one.wheel.name] = one.wheel
    return found


def search(of: CompoundSet, drive: Drive, wanted: Wanted, most: int) -> tuple[Candidate, ...]:
    """Combinations that do: the nearest ratios first, of equal ones the smallest, then those with few common factors.

    Raises
    ------
    RangeError
        If there are too many combinations.
    InputError
        If there is none.
    """
    gears = gears_of(of)
    teeth = _coaxial(of, gears, wanted)
    count = next(iter(teeth.values())).size
    ratios = np.concatenate([
        _ratios(of, drive, {name: column[first : first + _AT_ONCE] for name, column in teeth.items()})
        for first in range(0, max(count, 1), _AT_ONCE)
    ])  # fmt: skip
    with np.errstate(invalid="ignore"):
        near = np.flatnonzero(np.abs(ratios / wanted.ratio - 1.0) <= wanted.tolerance * (1.0 + _ONE))
    order = near[np.argsort(np.abs(ratios[near] / wanted.ratio - 1.0), kind="stable")][:_CLOSELY]
    found: list[Candidate] = []
    for row in order:
        numbers = {name: int(column[row]) for name, column in teeth.items()}
        off = float(ratios[row] / wanted.ratio - 1.0)
        off = 0.0 if abs(off) < _ONE else off
        if len(found) >= most and abs(off) > abs(found[-1].off) * (1.0 + _ONE) + _ONE:
            break
        one = _candidate(of, numbers, float(ratios[row]), off, wanted)
        if one is not None:
            found.append(one)
    found.sort(key=lambda one: (round(abs(one.off), 9), round(one.size, 9), one.common, tuple(one.teeth.values())))
    if not found:
        within = f"within {percent(wanted.tolerance)} by any of {ratios.size} coaxial combinations of teeth"
        raise InputError(
            "ratio", f"{wanted.ratio:.6g}", f"is not reached {within}" if not near.size else
            f"is reached by {near.size} combinations of teeth, of which none can be assembled with clearance of its "
            "planets", "widen the ranges of teeth, tolerance or coaxial, or change the number of planets",
        )  # fmt: skip
    return tuple(found[:most])


def _coaxial(of: CompoundSet, gears: Mapping[str, Wheel], wanted: Wanted) -> dict[str, Array]:
    """Combinations of teeth whose meshes of one planet have one centre distance, each gear's as an array."""
    teeth: dict[str, Array] = {}
    count = 1
    for name in gears:
        low, high = wanted.ranges[name]
        values = np.arange(low, high + 1)
        count *= values.size
        if count > MOST:
            raise RangeError(
                f"teeth.{name}", f"[{low}, {high}]", f"makes {count:,} combinations of numbers of teeth, above "
                f"{MOST:,}", "narrow the ranges",
            )  # fmt: skip
        repeated: Array = np.tile(values, count // values.size).astype(float)
        teeth = {other: np.repeat(column, values.size) for other, column in teeth.items()} | {name: repeated}
        keep = np.ones(count, dtype=bool)
        for one in of.toothed:
            if one.other_wheel.internal and {one.wheel.name, one.other_wheel.name} <= teeth.keys():
                keep &= teeth[one.other_wheel.name] >= teeth[one.wheel.name] + _ROOM_IN_RING
        for difference in _differences(of, teeth, wanted.modules):
            keep &= np.abs(difference) <= wanted.coaxial + 1e-9
        teeth = {other: column[keep] for other, column in teeth.items()}
        count = int(keep.sum())
    return teeth


def _distance(one: Toothed, teeth: Mapping[str, Array], modules: Mapping[str, float]) -> Array:
    """Reference centre distance of a mesh [m]."""
    side = -1.0 if one.other_wheel.internal else 1.0
    return np.asarray(abs(0.5 * modules[one.wheel.name] * (teeth[one.wheel.name] + side * teeth[one.other_wheel.name])))


def _differences(of: CompoundSet, teeth: Mapping[str, Array], modules: Mapping[str, float]) -> Iterable[Array]:
    """Differences of centre distances of each planet's meshes with shafts from the first [modules]."""
    for group in of.planets:
        meshes = [
            one for one in of.toothed
            if one.planets.name == group.name and isinstance(one.other, Shaft)
            and {one.wheel.name, one.other_wheel.name} <= teeth.keys()
        ]  # fmt: skip
        for one in meshes[1:]:
            apart = _distance(one, teeth, modules) - _distance(meshes[0], teeth, modules)
            yield np.asarray(apart / modules[one.wheel.name])


def _ratios(of: CompoundSet, drive: Drive, teeth: Mapping[str, Array]) -> Array:
    """Speed of the driving over that of the loaded shaft for every combination; nan where it does not run."""
    names = of.names
    at = {name: k for k, name in enumerate(names)}
    count = next(iter(teeth.values())).size
    rows = np.zeros((count, len(names), len(names)))
    for k, one in enumerate(of.toothed):
        planet = teeth[one.wheel.name].astype(float)
        mate = teeth[one.other_wheel.name] * (-1.0 if one.other_wheel.internal else 1.0)
        rows[:, k, at[one.planets.name]] += planet
        rows[:, k, at[one.other.name]] += mate
        rows[:, k, at[one.planets.carrier]] -= planet + mate
    for k, shaft in enumerate((*drive.fixed, drive.driving), start=len(of.meshes)):
        rows[:, k, at[shaft]] = 1.0
    size = np.abs(rows).max(axis=2, keepdims=True)
    ok = np.abs(np.linalg.det(rows / size)) > 1e-9
    right = np.zeros((count, len(names), 1))
    right[:, -1] = 1.0
    ratios = np.full(count, math.nan)
    if ok.any():
        output = np.linalg.solve(rows[ok], right[ok])[:, at[drive.loaded], 0]
        with np.errstate(divide="ignore"):
            ratios[ok] = np.where(np.abs(output) > 1e-12, 1.0 / output, math.nan)
    return ratios


def _candidate(of: CompoundSet, teeth: Mapping[str, int], ratio: float, off: float, wanted: Wanted) -> Candidate | None:
    """A combination with its measures; None where it cannot be assembled or planets interfere."""
    made = _with_teeth(of, teeth, wanted.modules)
    if made is None:
        return None
    parts = clusters(made)
    if any(max(map(abs, one.misfit())) * max(one.step, 1) > 1e-6 for one in parts):
        return None
    gap = min((one.gap for one in clearances(made) if one.certain), default=math.inf)
    if gap < wanted.clearance * min(wanted.modules[one.wheel.name] for one in made.toothed):
        return None
    arrays = {name: np.array(number) for name, number in teeth.items()}
    differences = [float(abs(one)) for one in _differences(made, arrays, wanted.modules)]
    size = max(
        *(wanted.modules[wheel.name] * wheel.teeth for shaft in made.shafts for wheel in shaft.wheels),
        *(2.0 * group.radius + wanted.modules[wheel.name] * wheel.teeth
          for group in made.planets for wheel in group.wheels),
    )  # fmt: skip
    common = sum(math.gcd(one.wheel.teeth, one.other_wheel.teeth) > 1 for one in made.toothed)
    return Candidate(
        dict(teeth), ratio, off, max(differences, default=0.0), gap, size, common, ", ".join(_in_phase(made.toothed))
    )


def _in_phase(meshes: Sequence[Toothed]) -> list[str]:
    """Meshes with shafts all of whose planets are in phase."""
    found = []
    for one in meshes:
        first = one.planets.angles[0]
        turns = [one.other_wheel.teeth * (angle - first) / (2.0 * math.pi) for angle in one.planets.angles]
        if isinstance(one.other, Shaft) and all(abs(turn - round(turn)) < 1e-6 for turn in turns):
            found.append(one.mesh.name)
    return found


def _with_teeth(of: CompoundSet, teeth: Mapping[str, int], modules: Mapping[str, float]) -> CompoundSet | None:
    """The set with other numbers of teeth, planets at reference centre distances; None where none reach each other."""

    def changed(wheel: Wheel) -> Wheel:
        number = teeth.get(wheel.name, wheel.teeth)
        grown = 0.5 * modules[wheel.name] * (number - wheel.teeth) if wheel.name in modules else 0.0
        return replace(wheel, teeth=number, base_radius=wheel.base_radius * number / wheel.teeth,
                       tip_radius=wheel.tip_radius + grown)  # fmt: skip

    arrays = {name: np.array(number) for name, number in teeth.items()}
    known: dict[str, Planets] = {}
    for group in of.planets:
        own = next((one for one in of.toothed if one.planets.name == group.name and isinstance(one.other, Shaft)), None)
        radius = group.radius if own is None else float(_distance(own, arrays, modules))
        turn = group.angles[0]
        for one in of.toothed:
            names = one.planets.name, one.other.name
            mate = next((known[name] for name in names if name in known), None)
            if isinstance(one.other, Shaft) or group.name not in names or mate is None:
                continue
            distance = float(_distance(one, arrays, modules))
            share = (radius**2 + mate.radius**2 - distance**2) / (2.0 * radius * mate.radius)
            if not -1.0 < share < 1.0:
                return None
            turn = mate.angles[0] + math.acos(share)
            break
        angles = tuple(turn + angle - group.angles[0] for angle in group.angles)
        known[group.name] = replace(group, wheels=tuple(map(changed, group.wheels)), radius=radius, angles=angles)
    shafts = tuple(replace(one, wheels=tuple(map(changed, one.wheels))) for one in of.shafts)
    try:
        return CompoundSet(shafts, tuple(known.values()), of.meshes)
    except InputError:  # reference distances without a line of action
        return None
