"""Solving a gear: with given settings, or as cheaply as a tolerance allows.

Solved tooth shapes are kept in memory and on disk: where a cache is handed down, none is solved twice.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from fegear.base.errors import InputError
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import Codec, SolutionCache
from fegear.fem.plane.bore import check_bore
from fegear.fem.plane.edge_sizes import fillet_edges
from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.gear import GearInfluence, Round
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.rim import PinForces
from fegear.fem.plane.root_stress import FilletStrain
from fegear.fem.plane.settings import (
    FINEST_LEVEL,
    LEVEL_RATIO,
    MeshSettings,
    Solver,
    all_but_met_coarser,
    level_for,
    settings_at,
)
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.supported_section import supported_sector
from fegear.fem.plane.trace import LoadedFlank
from fegear.geometry.gear import Gear, Plane
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.rim_support import RimSupport

Progress = Callable[[str], None]

#: How many solutions are tried at most.
_MOST_ROUNDS = 4
#: Fillets of so many edges meet a tolerance of 1e-2 half a level coarser: none of 19 random gears missed it there, of
#: 19 with fewer 7 did; with more (undercut teeth) errors were stated too small there, by 1.8 times in one gear.
_FEWEST_EDGES, _MOST_EDGES = 4.9, 6.3
#: By what factor errors fall at least from one level to the next, and the farthest step.
_FALLS, _FARTHEST = 2.5, 2.0


def influence_of_shape(
    tooth: InvoluteSide,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    reach: int,
    cache: SolutionCache | None = None,
    *,
    two_orders: bool = False,
    support: RimSupport | None = None,
    lasting: bool = True,
) -> Influence:
    """Solve one gear shape (lengths in modules), or recall it from a cache; where it lasts, also from the disk's."""
    known = SolutionCache() if cache is None else cache
    shape = tooth, bore_radius, poisson_ratio, plane, settings, reach, two_orders, support
    if not lasting:
        return known.call(_solve_shape, *shape).value
    return known.call_kept(shape_codec(tooth), _solve_shape, *shape).value


def _solve_shape(
    tooth: InvoluteSide,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    reach: int,
    two_orders: bool,
    support: RimSupport | None,
) -> Influence:
    return solve_influence(
        tooth,
        supported_sector(tooth, bore_radius, settings, support),
        poisson_ratio,
        plane,
        order=settings.order,
        reach=reach,
        corner_distance=settings.corner_distance,
        two_orders=two_orders,
        support=support,
        solver=settings.solver,
    )


def solve_gear(
    gear: Gear,
    settings: MeshSettings | None = None,
    *,
    reach: int = 1,
    estimate_error: bool = True,
    coarser: MeshSettings | None = None,
    mesh: SectorMesh | None = None,
    progress: Progress | None = None,
    cache: SolutionCache | None = None,
    lasting: bool = True,
) -> GearInfluence:
    """Solve a gear for its influence functions.

    Of a helical gear this is its section across the axis as a plane problem: a thin slice, not the gear.

    Parameters
    ----------
    gear : Gear
    settings : MeshSettings, optional
    reach : int
        K: neighbours -K..K.
    estimate_error : bool
        Whether to spend some .4 of the time again on a second solution: the same mesh, elements one order lower.
    coarser : MeshSettings, optional
        Whose corner distance and pressures that one takes, by default of edges longer by the square root of two.
    mesh : SectorMesh, optional
        A user's own sector mesh (in modules) instead of the generated one.
    progress : callable, optional
        Called with the name of each stage as it starts.
    cache : SolutionCache, optional
        Where solved shapes are recalled from and kept.
    lasting : bool
        Whether they are also kept on the disk of the cache.

    Returns
    -------
    GearInfluence

    Raises
    ------
    InputError
        If it is not a gear of the geometry package.
    RangeError
        If the bore lies too near the centre or the outline to be meshed.
    """
    check_gear(gear)
    started = time.perf_counter()
    settings = settings or MeshSettings()
    cache = SolutionCache() if cache is None else cache
    say = progress or (lambda _stage: None)
    shape = _shape(gear)
    coarser = coarser or settings.refined(LEVEL_RATIO)
    if mesh is not None:
        say("influence functions on the user mesh")
        _, _, nu, plane = shape
        order, closest = settings.order, settings.corner_distance
        fine = cache.call_kept(
            shape_codec(gear.tooth), solve_influence, gear.tooth, mesh, nu, plane,
            order=order, reach=reach, corner_distance=closest, two_orders=estimate_error, solver=settings.solver,
        ).value  # fmt: skip
    else:
        check_bore(gear.tooth, gear.bore_radius / gear.module, gear.module)
        say("influence functions")
        fine = influence_of_shape(
            *shape, settings, reach, cache, two_orders=estimate_error, support=gear.support_in_modules, lasting=lasting
        )
    seconds = {**fine.seconds, "total": time.perf_counter() - started}
    estimate: Estimate | None = None
    if fine.lower is not None:
        # Recalled with the errors over the flank that have been looked for: neither size nor steel changes them, and
        # a sweep over loads asks again and again.
        estimate = cache.call(
            _estimate, fine, coarser.corner_distance, settings.patch_half_width, coarser.patch_half_width
        ).value
    return GearInfluence(gear, fine, estimate, replace(settings), seconds)


def check_gear(gear: object) -> None:
    """Refuse what is not a gear of the geometry package: gears of scripts have other attributes.

    Raises
    ------
    InputError
    """
    if not isinstance(gear, Gear):
        kind = type(gear)
        raise InputError(
            "gear",
            f"{kind.__module__.partition('.')[0]}.{kind.__qualname__}" if kind.__module__ != "builtins" else repr(gear),
            "must be a fegear.geometry.gear.Gear",
            "for a fegear.Gear use gear.geometry, or fegear.stiffness_table(gear)",
        )


def solve_to_tolerance(
    gear: Gear,
    tolerance: float,
    *,
    reach: int = 1,
    solver: Solver = "condensed",
    progress: Progress | None = None,
    cache: SolutionCache | None = None,
) -> GearInfluence:
    """Solve a gear as cheaply as a relative tolerance allows.

    The first settings are those that usually meet the tolerance (`first_level`). While the error estimate misses it,
    edges are shortened by as much as its excess asks for: by a sixth for errors up to half again as large, by half at
    most.

    Parameters
    ----------
    gear : Gear
    tolerance : float
        For the largest error over the flank of c_0, of c_1 (over c_0), of root tension and of root compression.
    reach : int
        K: neighbours -K..K.
    solver : {"condensed", "scikit-fem"}
        What assembles a sector and eliminates its inner unknowns.
    progress : callable, optional

    Returns
    -------
    GearInfluence
        Its `rounds` list what was tried; the last one may miss the tolerance at the finest level or after the last
        round.
    """
    check_gear(gear)
    level, rounds = first_level(gear.tooth, tolerance), []
    cache = SolutionCache() if cache is None else cache
    while True:
        started = time.perf_counter()
        settings = replace(settings_at(level), solver=solver)
        known = solve_gear(gear, settings, reach=reach, progress=progress, cache=cache)
        errors = known.largest_errors()
        rounds.append(Round(settings, known.fine.unknowns, errors, time.perf_counter() - started))
        if rounds[-1].error <= tolerance or level >= FINEST_LEVEL or len(rounds) == _MOST_ROUNDS:
            seconds = {**known.seconds, "total": sum(one.seconds for one in rounds)}
            return replace(known, rounds=tuple(rounds), seconds=seconds)
        level = min(level + levels_finer(rounds[-1].error / tolerance), FINEST_LEVEL)


def first_level(tooth: InvoluteSide, tolerance: float) -> float:
    """Level at which a tolerance starts: where most gears meet it half a level coarser, there if the fillet suits it.

    The largest error is that of root stress, and it goes with the number of edges along the fillet.
    """
    level = level_for(tolerance)
    if not all_but_met_coarser(tolerance):
        return level
    suits = _FEWEST_EDGES <= fillet_edges(tooth, settings_at(level - 0.5)) <= _MOST_EDGES
    return level - 0.5 if suits else level


def levels_finer(excess: float) -> float:
    """By how many levels, whole ones and halves, a solution that errs so many times too much is made finer."""
    most = _FALLS**_FARTHEST
    return 0.5 * math.ceil(2.0 * math.log(excess, _FALLS)) if excess < most else _FARTHEST


def _estimate(fine: Influence, corner_distance: float, patch: float, coarse_patch: float) -> Estimate:
    """By the elements one order lower of the same mesh, at the corner distance and pressures of a coarser one."""
    assert fine.lower is not None  # noqa: S101  (for mypy: two orders were solved)
    return Estimate(fine, replace(fine.lower, corner_distance=corner_distance), patch, coarse_patch)


def _shape(gear: Gear) -> tuple[InvoluteSide, float, float, Plane]:
    return gear.tooth, gear.bore_radius / gear.module, gear.material.poisson_ratio, gear.plane_assumption


#: Of a solution what is not kept on disk: whoever reads it knows the tooth, and can solve a sector again.
_NOT_KEPT = frozenset({"tooth", "rows"})
#: What a solved plane shape consists of.
_PLANE: tuple[type, ...] = (Influence, SectorMesh, LoadedFlank, FilletStrain, PinForces, RimSupport)


def shape_codec(tooth: InvoluteSide, kinds: tuple[type, ...] = _PLANE) -> Codec[Any]:
    """How the solution of a shape is kept on disk.

    Parameters
    ----------
    tooth : InvoluteSide
        Which whoever asks for the solution knows: it is not kept.
    kinds : tuple of type
        Dataclasses that the solution consists of, its own first; those with the tooth as a field are given it.
    """
    return Codec(lambda found: pack(_plain(found, kinds)), lambda data: _restored(data, tooth, kinds))


def _plain(item: object, kinds: tuple[type, ...]) -> object:
    """Dataclasses as dictionaries with their name; without what is `_NOT_KEPT`."""
    if dataclasses.is_dataclass(item) and isinstance(item, kinds):
        names = (f.name for f in dataclasses.fields(item) if f.name not in _NOT_KEPT)
        fields = {name: _plain(getattr(item, name), kinds) for name in names}
        return {"kind": type(item).__name__, "fields": fields}
    if isinstance(item, dict):
        return {key: _plain(value, kinds) for key, value in item.items()}
    if isinstance(item, tuple):
        return tuple(_plain(value, kinds) for value in item)
    return item


def _restored(data: bytes | memoryview, tooth: InvoluteSide, kinds: tuple[type, ...]) -> Any:
    """Rebuild a solution; None if the bytes do not fit."""
    names = {kind.__name__: kind for kind in kinds}
    of_tooth = {kind for kind in kinds if any(one.name == "tooth" for one in dataclasses.fields(kind))}

    def build(item: object) -> object:
        if isinstance(item, tuple):
            return tuple(build(value) for value in item)
        if not isinstance(item, dict):
            return item
        if set(item) == {"kind", "fields"}:
            kind = names[item["kind"]]
            given = {"tooth": tooth} if kind in of_tooth else {}
            return kind(**given, **{key: build(value) for key, value in item["fields"].items()})
        return {key: build(value) for key, value in item.items()}

    try:
        known = build(unpack(data))
    except (ValueError, KeyError, TypeError):
        return None
    return known if isinstance(known, kinds[0]) else None
