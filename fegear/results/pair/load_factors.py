"""Stage ``flank-load-factors``: K_Halpha, K_Fbeta, K_Falpha of solved flanks, compared with ISO 6336-1's factors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, error_column, value_of
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.load_distribution import flank_stage
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.pair.loaded_teeth import gears_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.wide.load_factors import RootFactors
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.geometry.pair import Member

#: Seconds of a roll position: both gears, both solutions, three loads.
_SECONDS = 0.015


@dataclass(frozen=True)
class FlankGears:
    """Names of a pair and of its gears by member."""

    name: str = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


@dataclass(frozen=True)
class FlankLoadFactorsData:
    """What the stage hands to its table.

    Parameters
    ----------
    loaded : LoadedWidePair
    transverse, transverse_error : ndarray, shape (L,)
        K_Halpha and its estimated error.
    root, coarse : mapping of Member to RootFactors
        At the nominal load, and by the coarser solution; None where there is none.
    by_iso : ndarray, shape (L,)
        K_Hbeta of ISO 6336-1; empty where the standard does not hold.
    why_not : str
        Why it does not; empty where it does.
    gap, exponent : float
        F_betay [m] and N_F.
    """

    loaded: LoadedWidePair
    transverse_error: Array
    root: Mapping[Member, RootFactors]
    coarse: Mapping[Member, RootFactors | None]
    by_iso: Array
    why_not: str
    gap: float
    exponent: float
    transverse: Array = shown("", "largest load on a tooth pair over that of perfect flanks", name="K_Halpha")


def _compute(inputs: FlankGears, upstream: Upstream, _work: Work) -> FlankLoadFactorsData:
    from fegear.contact.wide.load_factors import (
        iso_face_load_factor,
        iso_root_exponent,
        root_factors,
        straight_gap,
        transverse_load_factor,
    )
    from fegear.contact.wide.root_stress import rooted_lines

    loaded = loaded_flanks(upstream, inputs.name)
    found, coarse, i = loaded.found, loaded.error.coarse, loaded.at
    pair, coupling, z = found.pair, loaded.coupling, loaded.places_along
    # Perfect flanks on the same lines, each with its own compliances.
    perfect = loaded.flanks.solve(found.load, None, found.known)
    perfect_coarse = loaded.flanks.solve(found.load, None, coarse.known) if loaded.estimated else perfect
    root: dict[Member, RootFactors] = {}
    root_coarse: dict[Member, RootFactors | None] = {}
    for member, gear in inputs.gears.items():
        influence = solid_solution_of(upstream, gear)
        rooted = rooted_lines(pair, member, found.lines, influence.fine, coupling=coupling)
        root[member], root_coarse[member] = root_factors(found, perfect, rooted, z, i), None
        if loaded.estimated and influence.coarse is not None:
            again = rooted_lines(pair, member, coarse.lines, influence.coarse, coupling=coupling)
            root_coarse[member] = root_factors(coarse, perfect_coarse, again, z, i)
    transverse = transverse_load_factor(found, perfect)
    off = _apart(transverse, transverse_load_factor(coarse, perfect_coarse) if loaded.estimated else np.nan)
    by_iso, why_not = np.empty(0), ""
    try:
        by_iso = np.array([iso_face_load_factor(pair, loaded.gaps, load) for load in found.load.tolist()])
    except RangeError as error:
        why_not = str(error)
    return FlankLoadFactorsData(
        loaded, off, root, root_coarse,
        by_iso, why_not, straight_gap(pair, loaded.gaps.under(loaded.nominal)), iso_root_exponent(pair), transverse,
    )  # fmt: skip


def _apart(factor: Array, other: Array | float) -> Array:
    """Difference of two solutions; never zero, which means exact, where both agree to the last digit by chance."""
    return np.asarray(np.maximum(np.abs(other - factor), np.spacing(factor)))


def _table(name: str, data: FlankLoadFactorsData) -> Table:
    found, error, k = data.loaded.found, data.loaded.error, data.loaded.stated.face_load_factor
    columns = [
        column_of(ErrorOverPitch, "total_load", found.load, name="load"),
        both := column_of(error, "face_load_factor", k),
        error_column(both, error.face_load_factor, "estimated error"),
        along := column_of(data, "transverse"),
        error_column(along, data.transverse_error, "estimated error"),
        Column("K_Fbeta_iso", k**data.exponent, "", "K_Hbeta to the power N_F of ISO 6336-1"),
    ]
    if data.by_iso.size:
        columns.append(Column("K_Hbeta_iso", data.by_iso, "", "closed formula of ISO 6336-1, not run in"))
    return Table(f"load_factors_{name}", tuple(columns), f"Load factors of pair {name} under every load")


def _present(data: FlankLoadFactorsData, inputs: FlankGears) -> Outcome:
    name, i = inputs.name, data.loaded.at
    k = float(data.loaded.stated.face_load_factor[i])
    values = [
        value_of(data, "transverse", name, float(data.transverse_error[i]), si=data.transverse[i]),
        Value(f"{name}.K_Fbeta_iso", k**data.exponent, "", None,
              f"K_Hbeta to the power N_F = {data.exponent:.4g} of ISO 6336-1"),
    ]  # fmt: skip
    if data.by_iso.size:
        values.insert(
            1, Value(f"{name}.K_Hbeta_iso", float(data.by_iso[i]), "", None,
                     f"closed formula of ISO 6336-1, F_betay = {abs(data.gap) * 1e6:.4g} um, not run in"),
        )  # fmt: skip
    for member, root in data.root.items():
        again = data.coarse[member]
        for key, attribute, meaning in (
            ("K_Fbeta", "face", "largest root tension over that of each pair's share spread evenly along its line"),
            (
                "K_Falpha",
                "transverse",
                "largest root tension of shares spread evenly over that of perfect flanks",
            ),
        ):
            value = getattr(root, attribute)
            error = None if again is None else abs(getattr(again, attribute) - value)
            values.append(Value(f"{name}.{member}.{key}", value, "", error, meaning))
    remarks = [f"Pair {name}: no K_Hbeta of ISO 6336-1, for {data.why_not}"] if data.why_not else []
    return Outcome(data, (_table(name, data),), tuple(values), remarks=tuple(remarks))


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    part = scene.case.pair[name]
    return (*needs_flanks(scene, name), *needs_solid_solution(part.driver, part.driven))


def _forecast(scene: Scene, _name: str) -> Forecast:
    positions = scene.case.load_distribution.positions
    return Forecast({"positions": positions}, 0.05 + _SECONDS * positions)


FLANK_LOAD_FACTORS = flank_stage(
    inputs=lambda scene, name: FlankGears(name, gears_of(scene, name)),
    compute=_compute,
    present=_present,
    needs=_needs,
    cites=citing(*RING, Citation("iso-6336-1", "face and transverse load factors", "clauses 7 to 9")),
    forecast=_forecast,
)
