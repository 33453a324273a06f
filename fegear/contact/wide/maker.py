"""Makes a loaded pair of teeth with a width, of its spec and its solved gears."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.solution_cache import SolutionCache
from fegear.contact.wide.error import flank_error, no_estimate, with_misses
from fegear.contact.wide.flanks import as_specified, open_gaps
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.loaded_pair import LoadedWidePair
from fegear.contact.wide.over_pitch import over_pitch
from fegear.contact.wide.rigid_flanks import beside_the_lines, unloaded_error
from fegear.contact.wide.tip_edges import usual_gap
from fegear.fem.solid.slice_laws import missed_by_slices
from fegear.geometry.pair import MEMBERS, Member

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.fem.solid.flank_body import FlankBody
    from fegear.fem.solid.influence import SolidInfluence

#: How often contact lines may be continued farther along tip edges that turn out to be loaded.
_LONGER_EDGES = 3
#: Times that flanks are loaded in all, about, for the progress.
_TIMES = 6


def load_wide(
    spec: PairSpec,
    gears: Sequence[SolidInfluence],
    *,
    cache: SolutionCache | None = None,
    progress: Callable[[float], None] | None = None,
    estimates: bool = True,
) -> LoadedWidePair:
    """Make a loaded pair of teeth with a width; see `fegear.contact.load.load`."""
    fine = {member: one.fine for member, one in zip(MEMBERS, gears, strict=True)}
    coarse = {member: one.coarse or one.fine for member, one in zip(MEMBERS, gears, strict=True)}
    report = None if progress is None else _Solves(progress)
    flanks, gaps, found = load_flanks(spec, fine, SolutionCache() if cache is None else cache, report)
    missed = missed_by_slices(spec.pair.driver.twist)["contact"] if spec.width == "slices" else 0.0
    over = over_pitch(flanks, found, gaps, spec.nominal, peaks=estimates)
    error = no_estimate(found)
    unloaded, beside = np.full(found.lines.roll.size, math.nan), 0.0
    if estimates:  # nothing else is found from these; while a value moves none is looked at
        error = with_misses(flank_error(flanks, found, coarse, gaps, over, spec.nominal), found, missed)
        rigid = gaps.under(spec.nominal)
        unloaded = unloaded_error(spec.placed, rigid, found.lines.roll)
        beside = beside_the_lines(spec.placed, rigid, found.lines)
    flanks = replace(flanks, progress=None)  # which goes no farther than this
    return LoadedWidePair(flanks, spec, found.known, gaps, found, over, error, unloaded, beside, missed)


def load_flanks(
    spec: PairSpec,
    bodies: Mapping[Member, FlankBody],
    cache: SolutionCache,
    progress: Callable[[float], None] | None = None,
) -> tuple[FlankPair, FlankGaps, LoadedFlanks]:
    """Load a pair of solved gears, along tip edges as far as these carry load.

    Parameters
    ----------
    spec : PairSpec
    bodies : mapping of {"driver", "driven"} to FlankBody
    cache : SolutionCache
        Of compliances.
    progress : callable, optional
        Of each solve.

    Returns
    -------
    flanks : FlankPair
    gaps : FlankGaps
        Of the effects that are on.
    found : LoadedFlanks
        Under all loads.
    """
    most_gap = usual_gap(spec.placed, max(spec.loads)) if spec.corner_contact else 0.0
    bare = FlankPair(
        spec.placed, bodies, panel=spec.panel, positions=spec.face.positions, most_gap=most_gap, cache=cache,
        progress=progress,
    )  # fmt: skip
    flanks = as_specified(spec, bare)
    gaps = open_gaps(spec)
    found = flanks.solve(spec.loads, gaps, flanks.compliance(spec.nominal))
    for _ in range(_LONGER_EDGES):
        if not found.reaches_the_last_edges:
            break
        flanks = replace(flanks, most_gap=2.0 * flanks.most_gap)
        found = flanks.solve(spec.loads, gaps, flanks.compliance(spec.nominal))
    return flanks, gaps, found


class _Solves:
    """Progress over several solves, each of which reports from its own beginning to its end."""

    def __init__(self, report: Callable[[float], None]) -> None:
        self._report, self._done, self._last = report, 0, 0.0

    def __call__(self, fraction: float) -> None:
        if fraction < self._last or self._last == 1.0:
            self._done += 1
        self._last = fraction
        self._report(min(0.99, (self._done + fraction) / _TIMES))
