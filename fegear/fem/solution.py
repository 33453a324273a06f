"""Solving a gear: with given settings, or as cheaply as a tolerance allows."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.boundary import check_bore
from fegear.fem.gear import GearInfluence
from fegear.fem.influence import Influence, solve_influence
from fegear.fem.sector import mesh_sector
from fegear.fem.settings import COARSEST_LEVEL, FINEST_LEVEL, LEVEL_RATIO, MeshSettings, settings_at
from fegear.fem.shape_cache import known_or_solved
from fegear.geometry.gear import Gear, Material
from fegear.plain import content_key, read_only
from fegear.solution_cache import SolutionCache

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.fem.mesh import SectorMesh
    from fegear.geometry.gear import Plane
    from fegear.geometry.tooth import Tooth

    Progress = Callable[[str], None]

_HIGHEST_ORDER = 4
#: Levels that hold a relative tolerance with their own estimate, from random gears (docs/numerics.md).
_LEVELS = ((1e-2, -3), (1e-3, -2), (1e-4, 0), (1e-5, 2), (1e-6, 4))
#: How many solutions are tried at most.
_MOST_ROUNDS = 4


@dataclass(frozen=True)
class Round:
    """One solution on the way to a tolerance.

    Attributes
    ----------
    settings : MeshSettings
    unknowns : int
        Of one sector.
    errors : mapping of str to float
        Largest estimated relative error over the flank of c_self, c_neighbour (over c_self), root_tension and
        root_compression.
    seconds : float
    """

    settings: MeshSettings
    unknowns: int
    errors: Mapping[str, float]
    seconds: float

    @property
    def error(self) -> float:
        """The largest of them."""
        return max(self.errors.values())


def influence_of_shape(
    tooth: Tooth,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    reach: int,
    cache: SolutionCache | None = None,
) -> Influence:
    """Solve one gear shape (lengths in modules), or recall it from a cache."""

    def solve() -> Influence:
        return solve_influence(
            tooth,
            mesh_sector(tooth, bore_radius, settings),
            poisson_ratio,
            plane,
            order=settings.order,
            reach=reach,
            corner_distance=settings.corner_distance,
        )

    what = (bore_radius, poisson_ratio, plane, settings, reach)
    return solve() if cache is None else known_or_solved(cache, tooth, what, solve)


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
        Whether to spend about half as much again on a second solution.
    coarser : MeshSettings, optional
        Settings of that one, by default edges longer by the square root of two.
    mesh : SectorMesh, optional
        A user's own sector mesh (in modules) instead of the generated one; its error is estimated with elements one
        order higher.
    progress : callable, optional
        Called with the name of each stage as it starts.
    cache : SolutionCache, optional
        Where solved shapes are recalled from and kept.

    Returns
    -------
    GearInfluence

    Raises
    ------
    RangeError
        If the bore lies too near the centre or the outline to be meshed.
    """
    started = time.perf_counter()
    settings = settings or MeshSettings()
    say = progress or (lambda _stage: None)
    shape = _shape(gear)
    coarse: Influence | None = None
    coarser = coarser or settings.refined(LEVEL_RATIO)
    if mesh is not None:
        say("influence functions on the given mesh")
        _, _, nu, plane = shape
        order, closest = settings.order, settings.corner_distance

        def solve(order: int) -> Influence:
            return known_or_solved(
                cache or SolutionCache(),
                gear.tooth,
                (mesh, nu, plane, order, reach, closest),
                lambda: solve_influence(gear.tooth, mesh, nu, plane, order=order, reach=reach, corner_distance=closest),
            )

        fine = solve(order)
        if estimate_error:
            coarse = solve(order + 1 if order < _HIGHEST_ORDER else order - 1)
    else:
        check_bore(gear.tooth, gear.bore_radius / gear.module, gear.module)
        say("influence functions")
        fine = influence_of_shape(*shape, settings, reach, cache)
        if estimate_error:
            say("influence functions on a coarser mesh, for the error")
            coarse = influence_of_shape(*shape, coarser, reach, cache)
    seconds = {**fine.seconds, "total": time.perf_counter() - started}
    return GearInfluence(gear, fine, coarse, replace(settings), coarser.patch_half_width, seconds)


def solve_to_tolerance(
    gear: Gear,
    tolerance: float,
    *,
    reach: int = 1,
    progress: Progress | None = None,
    cache: SolutionCache | None = None,
) -> GearInfluence:
    """Solve a gear as cheaply as a relative tolerance allows.

    The first settings are those that usually meet the tolerance (`level_for`). While the error estimate misses it,
    edges are shortened by the square root of two: the solution before serves as the coarser one of the next estimate.

    Parameters
    ----------
    gear : Gear
    tolerance : float
        For the largest error over the flank of c_0, of c_1 (over c_0), of root tension and of root compression.
    reach : int
        K: neighbours -K..K.
    progress : callable, optional

    Returns
    -------
    GearInfluence
        Its `rounds` list what was tried; the last one may miss the tolerance at the finest level or after the last
        round.
    """
    level, rounds = level_for(tolerance), []
    cache = SolutionCache() if cache is None else cache  # each round's solution is the coarser one of the next
    while True:
        started = time.perf_counter()
        settings, coarser = settings_at(level), settings_at(level - 1)
        known = solve_gear(gear, settings, reach=reach, coarser=coarser, progress=progress, cache=cache)
        errors = _errors_of_shape(_shape(gear), settings, coarser, reach, cache)
        rounds.append(Round(settings, known.fine.unknowns, errors, time.perf_counter() - started))
        if rounds[-1].error <= tolerance or level >= FINEST_LEVEL or len(rounds) == _MOST_ROUNDS:
            seconds = {**known.seconds, "total": sum(one.seconds for one in rounds)}
            return replace(known, rounds=tuple(rounds), seconds=seconds)
        level += 1


def _errors_of_shape(
    shape: tuple[Tooth, float, float, Plane],
    settings: MeshSettings,
    coarser: MeshSettings,
    reach: int,
    cache: SolutionCache,
) -> Mapping[str, float]:
    """`GearInfluence.largest_errors`, which neither size nor steel change: a sweep over loads asks again and again."""
    tooth, bore_radius, nu, plane = shape

    def largest() -> Mapping[str, float]:
        gear = Gear(tooth, 1.0, bore_radius, material=Material(1.0, nu), plane=plane)
        solved = solve_gear(gear, settings, reach=reach, coarser=coarser, cache=cache)
        return read_only(solved.largest_errors())

    return cache.solve(content_key("largest errors", shape, settings, coarser, reach), largest).value


def _shape(gear: Gear) -> tuple[Tooth, float, float, Plane]:
    return gear.tooth, gear.bore_radius / gear.module, gear.material.poisson_ratio, gear.plane_assumption


def level_for(tolerance: float) -> int:
    """Level of `settings_at` that usually meets a relative tolerance: -2 for 1e-3, 0 for 1e-4."""
    decades, levels = zip(*((-math.log10(known), level) for known, level in _LEVELS), strict=True)
    between = float(np.interp(-math.log10(tolerance), decades, levels))
    return min(max(math.ceil(between - 1e-9), COARSEST_LEVEL), FINEST_LEVEL)
