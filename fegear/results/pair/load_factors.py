"""Stage ``flank-load-factors``: K_Halpha, K_Fbeta, K_Falpha of solved flanks, compared with ISO 6336-1's factors."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.shown import shown, shows
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.load_distribution import flank_stage
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.pair.loaded_teeth import gears_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.wide.load_factors import RootFactors
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.geometry.pair import Member

#: Seconds of a roll position: both gears, three solutions, three loads.
_SECONDS = 0.0022
#: Of what the load over the face may be off by, relatively, so much is error of K_Fbeta at least: where that is all but
#: one, both solutions agree by chance (of a spur pair they were 1e-5 apart where 7e-5 was true, K_Hbeta off by 4e-3).
_OF_LOAD = 0.05


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
    root : mapping of Member to RootFactors
        At the nominal load, at the roll positions of numbers of a whole base pitch.
    again : mapping of Member to tuple of RootFactors
        At those of the tables: as solved, on longer panels, and of coarser gears on these; without a coarser solution
        fewer.
    by_iso : ndarray, shape (L,), or None
        K_Hbeta of ISO 6336-1; None where the standard does not hold.
    why_not : str
        Why it does not; empty where it does.
    gap, exponent : float
        F_betay [m] and N_F.
    """

    loaded: LoadedWidePair
    transverse_error: Array
    root: Mapping[Member, RootFactors]
    again: Mapping[Member, tuple[RootFactors, ...]]
    why_not: str
    exponent: float
    gap: float = shown("um", "straight part of the gap over the face")
    by_iso: Array | None = shown("", "closed formula of ISO 6336-1", name="K_Hbeta_iso")
    transverse: Array = shown("", "maximum tooth pair load / value for ideal flanks", name="K_Halpha")

    @property
    @shows("", "K_Hbeta to the power N_F", name="K_Fbeta_iso")
    def root_by_iso(self) -> Array:
        """K_Fbeta of ISO 6336-1 from the computed K_Hbeta, shape (L,)."""
        return np.asarray(self.loaded.stated.face_load_factor**self.exponent)

    @property
    def members(self) -> dict[Member, ComparedRoot]:
        """Root factors of both gears at the nominal load."""
        return {member: ComparedRoot(root, self.off) for member, root in self.root.items()}

    def off(self, factor: str) -> float | None:
        """Estimated error of a factor: what solutions and roll positions change, of both gears the farther.

        One of them may agree by chance, for a factor is the ratio of two largest values, and both feel the same loads.
        Longer panels and coarser gears may change it in opposite directions: their changes add up, with what fewer
        roll positions change. K_Fbeta is off by a part of what the load over the face is off by, for that reaches
        the root smoothed.
        """
        apart = [
            sum(abs(getattr(two, factor) - getattr(one, factor)) for one, two in pairwise(solutions))
            for solutions in self.again.values() if len(solutions) > 1
        ]  # fmt: skip
        if not apart:
            return None
        left = max(getattr(root.left_by_positions, factor) for root in self.root.values())
        loaded = self.loaded
        by_load = loaded.error.face_load_factor[loaded.at] / loaded.stated.face_load_factor[loaded.at]
        return max(*apart, _OF_LOAD * float(by_load) if factor == "face" else 0.0) + float(left)


@dataclass(frozen=True)
class ComparedRoot:
    """Root factors of one gear at the nominal load, and the error of each."""

    fine: RootFactors
    off: Callable[[str], float | None]


def _compute(inputs: FlankGears, upstream: Upstream, _work: Work) -> FlankLoadFactorsData:
    from fegear.contact.wide.load_factors import (
        iso_face_load_factor,
        iso_root_exponent,
        root_factors,
        straight_gap,
        transverse_left_by_positions,
        transverse_load_factor,
    )
    from fegear.contact.wide.root_stress import rooted_lines

    loaded = loaded_flanks(upstream, inputs.name)
    found, i = loaded.found, loaded.at
    pair, coupling, z = found.pair, loaded.coupling, loaded.places_along
    solutions = (found, *((loaded.error.longer, loaded.error.coarse) if loaded.estimated else ()))
    # Perfect flanks on the same lines, each with its own compliances.
    ideal = [loaded.flanks.solve(found.load, None, one.known) for one in solutions]
    many = loaded.over.found  # largest values stand between the positions of tables
    perfect = ideal[0]
    if many.lines.roll.size != found.lines.roll.size:
        perfect = replace(loaded.flanks, positions=many.lines.roll.size).solve(many.load, None, many.known)
    root: dict[Member, RootFactors] = {}
    again: dict[Member, tuple[RootFactors, ...]] = {}
    for member, gear in inputs.gears.items():
        influence = solid_solution_of(upstream, gear)
        root[member] = root_factors(many, perfect, loaded.rooted(member, many, influence.fine), z, i)
        bodies = [influence.fine, influence.fine, influence.coarse] if influence.coarse else [influence.fine]
        again[member] = tuple(
            root_factors(one, flanks, rooted_lines(pair, member, one.lines, body, coupling=coupling), z, i)
            for one, flanks, body in zip(solutions, ideal, bodies, strict=False)
        )
    transverse, off = transverse_load_factor(many, perfect), np.full(found.load.shape, np.nan)
    if loaded.estimated:
        factors = [transverse_load_factor(one, flanks) for one, flanks in zip(solutions, ideal, strict=True)]
        off = np.sum([_apart(one, two) for one, two in pairwise(factors)], axis=0)
        off = off + transverse_left_by_positions(many, perfect)
    by_iso, why_not = None, ""
    try:
        by_iso = np.array([iso_face_load_factor(pair, loaded.gaps, load) for load in found.load.tolist()])
    except RangeError as error:
        why_not = str(error)
    return FlankLoadFactorsData(
        loaded, off, root, again, why_not, iso_root_exponent(pair),
        straight_gap(pair, loaded.gaps.under(loaded.nominal)), by_iso, transverse,
    )  # fmt: skip


def _apart(factor: Array, other: Array) -> Array:
    """Difference of two solutions; never zero, which means exact, where both agree to the last digit by chance."""
    return np.asarray(np.maximum(np.abs(other - factor), np.spacing(factor)))


_SHEET = Sheet(
    loads="loaded.found.load",
    nominal="loaded.at",
    tables=(
        Rows(
            "load_factors_{name}", "Load factors of pair {name} for every load",
            (
                Cell("total_load", si="loaded.found.load", of=lambda _: ErrorOverPitch, name="load"),
                Cell("face_load_factor", si="loaded.stated.face_load_factor", of="loaded.error"),
                Off("face_load_factor", "loaded.error.face_load_factor", "estimated error", of="loaded.error"),
                "transverse", Off("transverse", "transverse_error", "estimated error"),
                Cell("root_by_iso", further=" of ISO 6336-1"), Cell("by_iso", further=", not run in"),
            ),
        ),
    ),
    values=(
        Number("transverse", lambda seen: seen.data.transverse_error[seen.nominal]),
        Number("by_iso", further=lambda seen: f", F_betay = {abs(seen.data.gap) * 1e6:.4g} um, not run in"),
        Number("root_by_iso", further=" = {d.exponent:.4g} of ISO 6336-1"),
        Each(
            "members",
            Number("face", lambda seen: seen.one.off("face"), "fine", owner="{name}.{key}"),
            Number("transverse", lambda seen: seen.one.off("transverse"), "fine", owner="{name}.{key}"),
        ),
    ),
    remarks=(Remark("Pair {name}: K_Hbeta of ISO 6336-1 not available: {d.why_not}", when="why_not"),),
)  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    part = scene.case.pair[name]
    return (*needs_flanks(scene, name), *needs_solid_solution(part.driver, part.driven))


def _forecast(scene: Scene, _name: str) -> Forecast:
    positions = scene.case.load_distribution.positions
    return Forecast({"positions": positions}, 0.05 + _SECONDS * positions)


FLANK_LOAD_FACTORS = flank_stage(
    inputs=lambda scene, name: FlankGears(name, gears_of(scene, name)),
    compute=_compute,
    present=_SHEET.present,
    needs=_needs,
    cites=citing(*RING, Citation("iso-6336-1", "face and transverse load factors", "clauses 7 to 9")),
    forecast=_forecast,
)
