"""Measure one configuration of a pair that is loaded over its face: solve its gears, load it, take the seconds."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.solid import solve_slices, solve_solid, solve_thin_slices
from fegear.geometry.pair import MEMBERS
from fegear.models.loaded_flanks import flanks_to_load
from fegear.models.solid_influence import solid_gear_to_solve
from fegear.results.loaded_flanks import load_flanks
from fegear.solution_cache import SolutionCache
from fegear.studies.cost.flank_ladder import FlankConfiguration
from fegear.studies.cost.quantities import miss
from fegear.studies.cost.result import Measured
from fegear.studies.cost.timing import timed

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.flank import LoadedFlanks
    from fegear.fem.solid import SolidSettings
    from fegear.fem.solid.flank_body import FlankBody
    from fegear.geometry.pair import Member
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.configuration import Configuration
    from fegear.studies.cost.ladder import Ladder
    from fegear.studies.cost.measure import Found

_SOLVERS: dict[str, Callable[..., FlankBody]] = {
    "thin-slices": solve_thin_slices, "coupled-slices": solve_slices, "solid": solve_solid,
}  # fmt: skip
#: Less is the round-off of the contact.
_ROUND_OFF = 1e-13


def solve_bodies(scene: Scene, pair: str, body: str, settings: SolidSettings) -> dict[Member, FlankBody]:
    """Both gears of a pair as one kind of body, past every cache."""
    part, found = scene.case.pair[pair], {}
    for member, name in zip(MEMBERS, (part.driver, part.driven), strict=True):
        wanted = solid_gear_to_solve(scene, name)
        gear = wanted.gear
        found[member] = _SOLVERS[body](
            gear.tooth, gear.twist * gear.module, gear.face_width / gear.module, gear.material.poisson_ratio,
            gear.bore_radius / gear.module, settings, reach=wanted.reach,
        )  # fmt: skip
    return found


def refer_flanks(found: Found, ladder: Ladder) -> None:
    """Solve the reference, and what shows its error: coarser gears and fewer panels, each alone and both.

    Their largest difference counts: of both together alone, one could make up for the other.
    """
    asked, best, check = found.asked, ladder.reference, ladder.check
    fine, coarse = _solve(asked, best), _solve(asked, check)
    values = _values(_load(asked, best, fine))
    others = [_values(_load(asked, one, bodies)) for one, bodies in ((check, fine), (best, coarse), (check, coarse))]
    for quantity in asked.quantities:
        name = quantity.name
        found.reference[name] = values[name]
        found.floors[name] = max(_ROUND_OFF, *(miss(name, other[name], values[name]).largest for other in others))


def measure_flanks(found: Found, group: tuple[Configuration, ...]) -> None:
    """Configurations of the same gears, which are solved once; each is charged for that."""
    bodies, solve = timed(partial(_solve, found.asked, group[0]), repeat=False)
    for one in group:
        loaded, own = timed(partial(_load, found.asked, one, bodies))
        for name, value in _values(loaded).items():
            if name in found.reference:
                off = miss(name, value, found.reference[name])
                found.rows.append(Measured(one, name, float(value[0]), off, solve, own))


def _flank(configuration: Configuration) -> FlankConfiguration:
    if not isinstance(configuration, FlankConfiguration):
        raise TypeError(f"{configuration.label} is no pair that is loaded over its face")
    return configuration


def _solve(asked: Asked, configuration: Configuration) -> dict[Member, FlankBody]:
    one = _flank(configuration)
    return solve_bodies(asked.scene, asked.pair, one.body, one.solid)


def _load(asked: Asked, configuration: Configuration, bodies: dict[Member, FlankBody]) -> LoadedFlanks:
    """The pair under its load as the case has it, but for panels and neighbours."""
    one, case = _flank(configuration), flanks_to_load(asked.scene, asked.pair)
    effects = case.effects.model_copy(update={"neighbour_coupling": one.neighbours})
    wanted = replace(case, panels=one.panels, effects=effects, loads=(case.nominal,))
    return load_flanks(wanted, bodies, SolutionCache())[2]


def _values(loaded: LoadedFlanks) -> dict[str, Array]:
    """Every quantity, shape (1,) each; SI."""
    return {
        "te-mean": loaded.mean_transmission_error,
        "te-peak-to-peak": np.ptp(loaded.transmission_error, axis=0),
        "face-load-factor": loaded.face_load_factor,
    }
